//! The findings about the laws of a model, as text and as data.

use std::fmt;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{
    ModelEntry,
    laws::{Case, Effort, Extreme, Findings, RECIPROCITY_TOLERANCE, SAMPLES, SAMPLING_TOLERANCE},
};
use crate::parameter::Values;

/// The findings about a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawReport {
    /// Id of the model.
    pub model: String,
    /// True if it is measured: laws that it does not claim depend on its file.
    #[serde(default)]
    pub measured: bool,
    /// True if the user gave some parameters: what is found is true of these alone.
    #[serde(default)]
    pub given: bool,
    /// Number of responses examined.
    pub responses: usize,
    /// Number of non-finite ones among them.
    pub not_finite: usize,
    /// Location of the first of those.
    pub first_not_finite: Vec<String>,
    /// The laws.
    pub laws: Vec<LawVerdict>,
    /// The response to light from below the surface and its location, if the model is opaque and does not declare it.
    #[serde(default)]
    pub from_below: Vec<String>,
    /// Quality of sampling with the model's lobes.
    pub sampling: Sampling,
}

/// The quality of sampling with a model's lobes, for light with extent. Not a law: with any lobes pictures
/// become correct, with bad ones more slowly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sampling {
    /// True if the error is small.
    pub fits: bool,
    /// Maximum relative error of a directional albedo from samples.
    pub error: String,
    /// Location of that error, in the format of laws.
    pub at: Vec<String>,
}

impl Sampling {
    /// The criterion.
    #[must_use]
    pub fn measure() -> String {
        format!("largest relative error of a directional albedo by {SAMPLES} samples")
    }

    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        if self.fits {
            "they fit"
        } else {
            "they miss highlights; under light with extent, noise takes long to fade"
        }
    }
}

/// The findings about a law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawVerdict {
    /// Name of the law.
    pub law: String,
    /// True if the model claims to obey it.
    pub claimed: bool,
    /// True if no violation was found.
    pub kept: bool,
    /// The quantity that decides: `largest directional albedo`.
    pub measure: String,
    /// Value of that quantity.
    pub size: String,
    /// Location of that value: directions in degrees, and the parameters in the syntax of `--set`.
    pub at: Vec<String>,
}

/// The name of reciprocity of light that passes, which models claim with that of light that is reflected.
const IN_TRANSMISSION: &str = "reciprocal in transmission";
/// What a model lacks that answers to light from below.
pub const UNDECLARED: &str = "light from below the surface: answered, but lights with extent shine there only on models with \
                              \"lit_from_below\": true";
/// The verdict on what some values that are not finite may spoil.
const NOT_JUDGED: &str = "cannot be judged: some values are NaN or infinite";

impl LawReport {
    /// The findings of an examination, in which these parameters were given.
    #[must_use]
    pub fn new(model: &ModelEntry, given: &Values, findings: &Findings) -> Self {
        let [difference, albedo] = if model.declaration.transmits {
            [
                "largest relative difference of f(l, v) and f(v, l), reflected",
                "largest directional albedo, both sides",
            ]
        } else {
            ["largest relative difference of f(l, v) and f(v, l)", "largest directional albedo"]
        };
        let evidence = [
            (difference, &findings.reciprocity),
            (albedo, &findings.albedo),
            ("smallest value", &findings.smallest),
        ];
        let kept = findings.kept().list();
        let claimed = model.declaration.laws.list();
        let verdict = |((law, claimed), (_, kept)): ((&str, bool), (&str, bool)),
                       (measure, extreme): (&str, &Extreme)| LawVerdict {
            law: law.to_owned(),
            claimed,
            kept,
            measure: measure.to_owned(),
            size: number(extreme.size),
            at: place(model, extreme.case.as_ref()),
        };
        let passing = &findings.transmission;
        let through = passing.case.is_some().then(|| {
            let (claimed, kept) = (model.declaration.laws.reciprocal, passing.size <= RECIPROCITY_TOLERANCE);
            let measure = "largest relative difference of f_t(l, v)/n_v² and f_t(v, l)/n_l²";
            verdict(((IN_TRANSMISSION, claimed), (IN_TRANSMISSION, kept)), (measure, passing))
        });
        Self {
            model: model.declaration.id.to_owned(),
            measured: model.declaration.measured,
            given: model.parameters.iter().any(|p| p.kind.format().is_none() && given.0.contains_key(p.name)),
            responses: findings.responses,
            not_finite: findings.not_finite,
            first_not_finite: place(model, findings.first_not_finite.as_ref()),
            laws: claimed
                .into_iter()
                .zip(kept)
                .zip(evidence)
                .map(|(law, found)| verdict(law, found))
                .chain(through)
                .collect(),
            from_below: if model.declaration.transmits || model.declaration.lit_from_below {
                Vec::new()
            } else {
                place(model, findings.from_below.case.as_ref())
            },
            sampling: Sampling {
                fits: findings.sampling.size <= SAMPLING_TOLERANCE,
                error: number(findings.sampling.size),
                at: place(model, findings.sampling.case.as_ref()),
            },
        }
    }

    /// True if all responses are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.not_finite == 0
    }

    /// The claimed laws that are violated.
    #[must_use]
    pub fn broken(&self) -> Vec<&str> {
        self.laws.iter().filter(|law| law.claimed && !law.kept).map(|law| law.law.as_str()).collect()
    }

    /// The verdict on a law. If some responses are not finite, no law counts as obeyed, but a violation remains a
    /// violation.
    #[must_use]
    pub fn verdict(&self, law: &LawVerdict) -> &'static str {
        match (law.claimed, law.kept) {
            (_, true) if !self.is_finite() => NOT_JUDGED,
            (false, true) if self.measured => "depends on the file; with this one, no violation was found",
            (false, false) if self.measured => "depends on the file; this one breaks it",
            (true, true) if self.given => "claimed for all parameters, and kept with these",
            (false, true) if self.given => {
                "not claimed for all parameters; with these, no violation was found"
            }
            (false, false) if self.given => "not claimed for all parameters, and broken with these",
            (true, true) => "claimed and kept",
            (true, false) => "claimed and BROKEN",
            // Claimed by the claim for light that is reflected, which may be broken.
            (false, true) if law.law == IN_TRANSMISSION => "not claimed, but no violation found",
            (false, true) => "not claimed, but no violation found: claim it?",
            (false, false) => "not claimed and broken",
        }
    }

    /// The verdict on the lobes. As for laws, they are not said to fit if some responses are not finite.
    #[must_use]
    pub fn sampling_verdict(&self) -> &'static str {
        if self.sampling.fits && !self.is_finite() { NOT_JUDGED } else { self.sampling.verdict() }
    }
}

impl fmt::Display for LawReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Effort { sets, .. } = Effort::default();
        writeln!(
            f,
            "{}: {} responses with {sets} sets of parameters, and 6 directional albedos with each",
            self.model, self.responses
        )?;
        let places = |at: &[String]| at.iter().map(|line| format!("\n  {line}")).collect::<String>();
        for law in &self.laws {
            writeln!(f, "{}: {}", law.law, self.verdict(law))?;
            writeln!(f, "  {}: {}{}", law.measure, law.size, places(&law.at))?;
        }
        writeln!(f, "lobes for sampling: {}", self.sampling_verdict())?;
        let Sampling { error, at, .. } = &self.sampling;
        writeln!(f, "  {}: {error}{}", Sampling::measure(), places(at))?;
        if !self.from_below.is_empty() {
            writeln!(f, "{UNDECLARED}{}", places(&self.from_below))?;
        }
        let verdict = if self.is_finite() { "everywhere" } else { "NOT everywhere" };
        writeln!(f, "finite: {verdict}")?;
        writeln!(
            f,
            "  NaN or infinite: {} of {} responses{}",
            self.not_finite,
            self.responses,
            places(&self.first_not_finite)
        )
    }
}

/// A number with its significant digits.
fn number(v: f32) -> String {
    if v == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e4).contains(&v.abs()) {
        format!("{v:.4}")
    } else {
        format!("{v:.2e}")
    }
}

/// A location: directions in degrees, and the parameters in the syntax of `--set`.
fn place(model: &ModelEntry, case: Option<&Case>) -> Vec<String> {
    let Some(case) = case else { return Vec::new() };
    let angles = |d: Vec3| {
        let theta = d.z.clamp(-1.0, 1.0).acos().to_degrees();
        let phi = d.y.atan2(d.x).to_degrees();
        format!("θ {theta:.2}°, φ {phi:.1}°")
    };
    let l = case.l.map_or_else(String::new, |l| format!("l ({}), ", angles(l)));
    let set: Vec<_> = model.parameters.iter().map(|p| format!("{}={}", p.name, case.values.get(p))).collect();
    let settings = (!set.is_empty()).then(|| set.join(" "));
    [format!("at {l}v ({})", angles(case.v))].into_iter().chain(settings).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn no_law_is_said_to_be_kept_where_values_are_no_numbers() {
        let registry = Registry::builtin();
        let lambert = registry.model("lambert").expect("built in");
        let mut findings = Findings { responses: 4, ..Findings::default() };
        let report = |findings: &Findings| LawReport::new(lambert, &Values::default(), findings).to_string();
        assert_eq!(report(&findings).matches("claimed and kept").count(), 3);
        findings.not_finite = 1;
        findings.albedo.size = 2.0;
        let text = report(&findings);
        assert!(!text.contains("kept"), "{text}");
        assert_eq!(text.matches("cannot be judged: some values are NaN or infinite").count(), 3, "{text}");
        assert!(
            text.contains("lobes for sampling: cannot be judged") && !text.contains("they fit"),
            "{text}"
        );
        assert!(text.contains("energy conserving: claimed and BROKEN"), "{text}");
        assert_eq!(LawReport::new(lambert, &Values::default(), &findings).broken(), ["energy conserving"]);
    }

    #[test]
    fn lobes_that_miss_highlights_are_said_and_break_no_law() {
        let registry = Registry::builtin();
        let lambert = registry.model("lambert").expect("built in");
        let mut findings = Findings::default();
        assert!(
            LawReport::new(lambert, &Values::default(), &findings)
                .to_string()
                .contains("lobes for sampling: they fit\n")
        );
        findings.sampling.size = 0.5;
        let report = LawReport::new(lambert, &Values::default(), &findings);
        assert!(report.to_string().contains("lobes for sampling: they miss highlights"), "{report}");
        assert!(report.broken().is_empty());
    }

    #[test]
    fn of_models_that_transmit_it_says_which_side_is_meant() {
        let registry = Registry::builtin();
        let text = |id: &str| {
            let model = registry.model(id).expect("built in");
            LawReport::new(model, &Values::default(), &Findings::default()).to_string()
        };
        for words in ["of f(l, v) and f(v, l), reflected: ", "largest directional albedo, both sides: "] {
            assert!(text("thin_glass").contains(words), "{words}");
            assert!(!text("lambert").contains(words), "{words}");
        }
    }
}
