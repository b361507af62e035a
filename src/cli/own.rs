//! `lcm models new`, `duplicate` and `check`: own models, from the first line to their laws.

use std::{fmt::Write as _, io, path::PathBuf};

use glam::Vec3;

use super::{
    Failure, Options, Outcome, complain,
    evaluate::find,
    print_paths, print_text,
    workshop::{Places, Workshop, valid},
};
use crate::{
    assets::write_new,
    capture::evaluate::Evaluator,
    optics::colour::Encoding,
    reflection::{
        ModelEntry,
        laws::{self, Case, Effort, Findings},
        own,
        parameter::Values,
    },
    registry::Registry,
    scene::error::quoted,
};

/// `lcm models new NAME`.
pub(super) fn new(name: &str, options: Options, places: &Places) -> Outcome {
    let id = id_of(name)?;
    write(&id, &own::template(&id, name.trim()), options, places)
}

/// `lcm models duplicate ID [NAME]`.
pub(super) fn duplicate(id: &str, name: Option<&str>, options: Options, places: &Places) -> Outcome {
    let mut workshop = places.open_for_writing(options)?;
    workshop.need(id);
    let registry = &workshop.registry;
    let model = find(registry, id)?;
    let copy = match name {
        Some(name) => id_of(name)?,
        None => format!("{id}_copy"),
    };
    let text = own::duplicate(model, registry.sources(), &copy).map_err(|e| Failure::Usage(e.to_string()))?;
    write(&copy, &text, options, places)
}

/// The id of a model that is to be called by a name.
fn id_of(name: &str) -> Result<String, Failure> {
    own::id_of_name(name).map_err(|rule| Failure::Usage(format!("NAME is {}, but {rule}", quoted(name))))
}

/// Writes a new file for an own model, and says what to do with it.
fn write(id: &str, text: &str, options: Options, places: &Places) -> Outcome {
    if Registry::builtin().model(id).is_some() {
        return Err(Failure::Usage(format!("{id} is the id of a built-in model; choose another name")));
    }
    let Some(folder) = places.folders()?.models else {
        return Err(Failure::Usage(
            "there is no folder for custom models; name one: --models FOLDER".to_owned(),
        ));
    };
    let path: PathBuf = folder.join(format!("{id}.{}", own::EXTENSION));
    write_new(&path, text).map_err(|e| match e.kind() {
        io::ErrorKind::AlreadyExists => {
            Failure::Write(format!("{} is there already; it was left alone", path.display()))
        }
        _ => Failure::Write(format!("{} could not be written: {e}", path.display())),
    })?;
    print_paths([path.as_path()])?;
    let flags = places.flags();
    options.tell(format_args!(
        "Edit this file; scenes name the model \"{id}\". `lcm render --reflection {id}{flags}` shows it, \
         `lcm models check {id}{flags}` tests the laws that it claims."
    ));
    Ok(())
}

/// `lcm models check ID`.
pub(super) fn check(id: &str, options: Options, workshop: &mut Workshop) -> Outcome {
    workshop.need(id);
    let registry = &workshop.registry;
    if registry.broken_model(id).is_some() {
        // What is wrong with it is told already.
        return Err(Failure::Invalid(format!("{id} was not checked: its file has a mistake")));
    }
    let model = find(registry, id)?;
    valid(registry, model)?;
    let mut evaluator = Evaluator::new(registry.sources(), model)?;
    let mut last = None;
    let effort = Effort::default();
    let bar = super::progress(effort.sets as u64, options);
    let findings = laws::examine(model, effort, |values, pairs| {
        if last.as_ref() != Some(values) {
            evaluator.set(values, Encoding::Srgb);
            last = Some(values.clone());
            bar.inc(1);
        }
        evaluator.evaluate(pairs)
    })?;
    bar.finish_and_clear();
    print_text(&report(model, &findings))?;
    let broken: Vec<_> = claims(model, &findings).filter(|c| c.claimed && !c.kept).map(|c| c.law).collect();
    if findings.not_finite > 0 {
        complain(format_args!("{id} gives values that are no numbers"));
    }
    match broken.as_slice() {
        [] if findings.not_finite == 0 => Ok(()),
        [] => Err(Failure::Invalid(String::new())),
        laws => Err(Failure::Invalid(format!(
            "{id} claims to be {}, but is not",
            crate::scene::check::listed(laws, "and")
        ))),
    }
}

/// A law, and what became of it.
struct Claim {
    law: &'static str,
    claimed: bool,
    kept: bool,
}

impl Claim {
    /// What is said of it. Where some values are no numbers nothing is kept, but what is broken is broken.
    fn verdict(&self, finite: bool) -> &'static str {
        match (self.claimed, self.kept) {
            (_, true) if !finite => "cannot be judged: some values are no numbers",
            (true, true) => "claimed and kept",
            (true, false) => "claimed and BROKEN",
            (false, true) => "not claimed and not found broken: claim it?",
            (false, false) => "not claimed and broken",
        }
    }
}

fn claims(model: &ModelEntry, findings: &Findings) -> impl Iterator<Item = Claim> + use<> {
    let kept = findings.kept().list();
    let claimed = model.declaration.laws.list();
    claimed.into_iter().zip(kept).map(|((law, claimed), (_, kept))| Claim { law, claimed, kept })
}

/// What was found, for people.
fn report(model: &ModelEntry, findings: &Findings) -> String {
    let Effort { sets, .. } = Effort::default();
    let mut text = format!(
        "{}: {} responses with {sets} sets of parameters, and 6 directional albedos with each\n",
        model.declaration.id, findings.responses
    );
    let evidence = [
        ("largest relative difference of f(l, v) and f(v, l)", &findings.reciprocity),
        ("largest directional albedo", &findings.albedo),
        ("smallest value", &findings.smallest),
    ];
    for (claim, (what, extreme)) in claims(model, findings).zip(evidence) {
        let verdict = claim.verdict(findings.not_finite == 0);
        // Writing to a String cannot fail; here and below.
        let _ = writeln!(text, "{}: {verdict}", claim.law);
        let _ = writeln!(text, "  {what}: {}{}", number(extreme.size), place(model, extreme.case.as_ref()));
    }
    let verdict = if findings.not_finite == 0 { "everywhere" } else { "NOT everywhere" };
    let _ = writeln!(text, "finite: {verdict}");
    let _ = writeln!(
        text,
        "  NaN or infinite: {} of {} responses{}",
        findings.not_finite,
        findings.responses,
        place(model, findings.first_not_finite.as_ref())
    );
    text
}

/// A number with as many digits as say something.
fn number(v: f32) -> String {
    if v == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e4).contains(&v.abs()) {
        format!("{v:.4}")
    } else {
        format!("{v:.2e}")
    }
}

/// Where something was found: directions in degrees, and the parameters as `--set` takes them.
fn place(model: &ModelEntry, case: Option<&Case>) -> String {
    let Some(case) = case else { return String::new() };
    let angles = |d: Vec3| {
        let theta = d.z.clamp(-1.0, 1.0).acos().to_degrees();
        let phi = d.y.atan2(d.x).to_degrees();
        format!("θ {theta:.2}°, φ {phi:.1}°")
    };
    let l = case.l.map_or_else(String::new, |l| format!("l ({}), ", angles(l)));
    format!("\n  at {l}v ({}){}", angles(case.v), settings(model, &case.values))
}

/// Parameters as `--set` takes them.
fn settings(model: &ModelEntry, values: &Values) -> String {
    let set: Vec<_> = model.parameters.iter().map(|p| format!("{}={}", p.name, values.get(p))).collect();
    if set.is_empty() { String::new() } else { format!("\n  {}", set.join(" ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_law_is_said_to_be_kept_where_values_are_no_numbers() {
        let registry = Registry::builtin();
        let lambert = registry.model("lambert").expect("built in");
        let mut findings = Findings { responses: 4, ..Findings::default() };
        assert_eq!(report(lambert, &findings).matches("claimed and kept").count(), 3);
        findings.not_finite = 1;
        findings.albedo.size = 2.0;
        let text = report(lambert, &findings);
        assert!(!text.contains("kept"), "{text}");
        assert_eq!(text.matches("cannot be judged: some values are no numbers").count(), 2, "{text}");
        assert!(text.contains("energy conserving: claimed and BROKEN"), "{text}");
    }
}
