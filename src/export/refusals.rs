//! The reasons why a scene cannot be exported.

use super::ExportError;
use crate::text::listed;

/// Reasons with the affected parts of the scene.
#[derive(Default)]
pub(super) struct Refusals(Vec<(String, Vec<String>)>);

impl Refusals {
    /// Adds a reason for a part.
    pub(super) fn add(&mut self, part: String, reason: String) {
        match self.0.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, parts)) => parts.push(part),
            None => self.0.push((reason, vec![part])),
        }
    }

    /// The result, if there are no reasons against it.
    ///
    /// # Errors
    /// Returns one line for each reason.
    pub(super) fn or<T>(self, made: T) -> Result<T, ExportError> {
        if self.0.is_empty() {
            return Ok(made);
        }
        Err(ExportError::Refused(self.0.into_iter().map(line).collect()))
    }
}

/// `objects[0] and objects[2]: a reason`; only the first of many parts.
fn line((reason, mut parts): (String, Vec<String>)) -> String {
    /// Maximum number of parts named.
    const NAMED: usize = 4;
    if parts.len() > NAMED + 1 {
        let others = parts.len() - NAMED;
        parts.truncate(NAMED);
        parts.push(format!("{others} more"));
    }
    format!("{}: {reason}", listed(&parts, "and"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_given_once_with_the_parts_that_it_is_about() {
        let lines = |count: usize| {
            let mut refusals = Refusals::default();
            for i in 0..count {
                refusals.add(format!("objects[{i}]"), "no".to_owned());
            }
            refusals.add("lights[0]".to_owned(), "never".to_owned());
            match refusals.or(()) {
                Err(ExportError::Refused(lines)) => lines,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(lines(1), ["objects[0]: no", "lights[0]: never"]);
        assert_eq!(lines(2), ["objects[0] and objects[1]: no", "lights[0]: never"]);
        assert!(lines(5)[0].ends_with("objects[3] and objects[4]: no"));
        assert!(lines(100)[0].ends_with("objects[3] and 96 more: no"), "{:?}", lines(100));
        assert_eq!(Refusals::default().or(7), Ok(7));
    }
}
