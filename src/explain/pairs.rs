//! Two explanations of one point side by side: matching lines, and their differences.

use glam::DVec3;

use super::{Line, agrees, numbers::DIGITS};

/// Number of standard errors beyond which two integrals differ.
const SURE: f64 = 2.0;

/// A line of one explanation, the line of the other with the same definition, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The line of the first explanation.
    pub a: Option<Line>,
    /// The line of the second explanation.
    pub b: Option<Line>,
}

impl Pair {
    /// True if one line is missing, or if equations or values differ.
    #[must_use]
    pub fn differs(&self) -> bool {
        let (Some(a), Some(b)) = (&self.a, &self.b) else { return true };
        let same = match (&a.value, &b.value) {
            (Some(x), Some(y)) => {
                // A difference within the noise of the samples does not count.
                let [of_a, of_b] = [a, b].map(|line| line.error.unwrap_or_default().as_dvec3());
                let reach = SURE * (of_a * of_a + of_b * of_b).map(f64::sqrt);
                let apart = DVec3::from_array(x.rgb) - DVec3::from_array(y.rgb);
                agrees(x, y, DIGITS) || apart.abs().cmple(reach).all()
            }
            (a, b) => a.is_none() && b.is_none(),
        };
        a.text != b.text || !same
    }

    /// The symbol that the lines define.
    #[must_use]
    pub fn defines(&self) -> &str {
        self.a.as_ref().or(self.b.as_ref()).map_or("", Line::defines)
    }
}

/// The lines of two explanations for one light, in pairs: in the order of the first explanation, with each
/// line found only in the second inserted after the line that it follows there.
#[must_use]
pub fn pairs(a: &[Line], b: &[Line]) -> Vec<Pair> {
    let is = |a: &Line, b: &Line| a.defines() == b.defines() && a.term == b.term;
    let mut out: Vec<Pair> = Vec::new();
    let mut taken = vec![false; b.len()];
    for line in a {
        let other = b.iter().enumerate().position(|(i, other)| !taken[i] && is(line, other));
        if let Some(i) = other {
            taken[i] = true;
        }
        out.push(Pair { a: Some(line.clone()), b: other.map(|i| b[i].clone()) });
    }
    for (i, line) in b.iter().enumerate().filter(|(i, _)| !taken[*i]) {
        let before = b[..i].last();
        let at =
            before.and_then(|before| out.iter().position(|p| p.b.as_ref().is_some_and(|b| is(b, before))));
        out.insert(at.map_or(out.len(), |at| at + 1), Pair { a: None, b: Some(line.clone()) });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{reflection::Term, text::expression::Value};

    fn line(text: &str, value: f64) -> Line {
        Line {
            term: Term::Diffuse,
            text: text.to_owned(),
            numbers: None,
            symbols: Vec::new(),
            value: Some(Value::number(value)),
            error: None,
            quantity: None,
        }
    }

    #[test]
    fn the_noise_of_integrals_is_no_difference() {
        let pair = |a: f64, b: f64, error: f32| {
            let of = |v: f64| Line {
                error: Some(glam::Vec3::splat(error)),
                ..line("I_d = ∫ I_d(l) L(l) dω", v)
            };
            Pair { a: Some(of(a)), b: Some(of(b)) }.differs()
        };
        assert_eq!([pair(1.0, 1.01, 0.01), pair(1.0, 1.05, 0.01), pair(1.0, 1.01, 0.0)], [false, true, true]);
    }

    #[test]
    fn lines_that_define_the_same_stand_beside_each_other() {
        let a = [line("I_d = k", 1.0), line("k = 2 x", 1.0), line("x = 3", 3.0)];
        let b = [line("I_d = k", 1.0), line("k = 3 x", 1.0), line("y = 1", 1.0), line("x = 3", 3.000_01)];
        let all = pairs(&a, &b);
        let names: Vec<_> = all.iter().map(|pair| (pair.defines(), pair.differs())).collect();
        assert_eq!(names, [("I_d", false), ("k", true), ("y", true), ("x", false)]);
        assert!(all[2].a.is_none() && all[2].b.is_some());
        assert_eq!(pairs(&a, &[]).iter().filter(|pair| pair.differs()).count(), 3);
    }
}
