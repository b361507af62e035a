//! A rule: a clause that can end a sentence.

use glam::Vec3;

/// `Ok`, or the rule that is broken.
pub type Rule = Result<(), String>;

/// `Ok` if the rule is kept.
pub(super) fn must(kept: bool, rule: impl FnOnce() -> String) -> Rule {
    if kept { Ok(()) } else { Err(rule()) }
}

/// A direction of a light or the observer. It need not have length 1.
pub fn direction(direction: Vec3) -> Rule {
    must(direction != Vec3::ZERO, || "a direction must not be zero".to_owned())?;
    must(direction.is_finite() && direction.try_normalize().is_some(), || {
        "this is too long or too short to be a direction; write it with a length near 1".to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_directions_are_refused_because_they_cannot_be_normalised() {
        assert_eq!(direction(Vec3::new(0.0, -3.0, 0.0)), Ok(()));
        for d in [Vec3::splat(1e-30), Vec3::splat(1e30), Vec3::splat(f32::INFINITY), Vec3::NAN] {
            assert!(direction(d).is_err_and(|rule| rule.contains("too long or too short")), "{d}");
        }
    }
}
