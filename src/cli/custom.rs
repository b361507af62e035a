//! `lcm models new`, `duplicate` and `check`: custom models, from the first line to their laws.

use std::{io, path::PathBuf};

use super::{
    Options, Outcome, complain,
    engine::ENGINE,
    evaluate::{Machine, SetParameters, find},
    print_json, print_paths, print_text,
    workshop::{Places, Workshop, valid},
};
use crate::files::{Shown as _, words};
use crate::{
    custom,
    explain::finite::{Scope, Tried, probe},
    failure::Failure,
    library::assets::write_new,
    optics::colour::Encoding,
    parameter::Values,
    progress::Progress,
    reflection::{
        law_report::LawReport,
        laws::{self, Effort},
    },
    registry::Registry,
    scene::{Light, Object, Scene},
    text::{listed, quoted},
};

/// `lcm models new NAME`.
pub(super) fn new(name: &str, options: Options, places: &Places, known: &Registry) -> Outcome {
    let id = id_of(name)?;
    write(&id, &custom::template(&id, name.trim()), options, places, known)
}

/// `lcm models duplicate ID [NAME]`.
pub(super) fn duplicate(
    id: &str,
    name: Option<&str>,
    options: Options,
    places: &Places,
    known: &Registry,
) -> Outcome {
    let mut workshop = places.open_for_writing(options, known.clone())?;
    workshop.need(id);
    let registry = &workshop.registry;
    let model = find(registry, id)?;
    let copy = match name {
        Some(name) => id_of(name)?,
        None => format!("{id}_copy"),
    };
    let name = name.map_or(copy.as_str(), str::trim);
    let text = custom::duplicate(model, registry.sources(), &copy, name)
        .map_err(|e| Failure::Usage(e.to_string()))?;
    write(&copy, &text, options, places, known)
}

/// The model id for a given name.
fn id_of(name: &str) -> Result<String, Failure> {
    custom::id_of_name(name).map_err(|bad| Failure::Usage(format!("NAME is {}, but {bad}", quoted(name))))
}

/// Writes a new file for a custom model, and suggests the next steps.
fn write(id: &str, text: &str, options: Options, places: &Places, known: &Registry) -> Outcome {
    if known.model(id).is_some() {
        return Err(Failure::Usage(format!("{id} is the id of a built-in model; choose another name")));
    }
    let Some(folder) = places.folders()?.models else {
        return Err(Failure::Usage("there is no folder for custom models; use --models FOLDER".to_owned()));
    };
    let path: PathBuf = folder.join(format!("{id}.{}", custom::EXTENSION));
    write_new(&path, text).map_err(|e| match e.kind() {
        io::ErrorKind::AlreadyExists => {
            Failure::Write(format!("{} already exists and was kept", path.shown()))
        }
        _ => Failure::Write(format!("{} could not be written: {}", path.shown(), words(&e))),
    })?;
    print_paths([path.as_path()])?;
    let flags = places.flags();
    options.tell(format_args!(
        "Edit this file; its id in scenes is \"{id}\". `lcm render --reflection {id}{flags}` shows it, \
         `lcm models check {id}{flags}` tests the laws that it claims to keep."
    ));
    Ok(())
}

/// Tells of values of a model that are not finite on the CPU.
fn on_cpu(id: &str, material: Values, registry: &Registry) -> Option<String> {
    let object = Object { material, ..Object::default() };
    // So that light from everywhere is tried too.
    let light =
        Light { light_type: "ambient".to_owned(), position: None, direction: None, ..Light::default() };
    let scene = Scene {
        reflection_model: id.to_owned(),
        objects: vec![object],
        lights: vec![light],
        ..Scene::default()
    };
    let found = probe(&scene, registry, Scope::Untested, &mut Tried::default());
    found.first().map(|odd| odd.what.clone())
}

/// `lcm models check ID`: for all values of parameters, except for those that are set.
pub(super) fn check(
    id: &str,
    set: &SetParameters,
    as_json: bool,
    options: Options,
    workshop: &mut Workshop,
) -> Outcome {
    workshop.need(id);
    let registry = &workshop.registry;
    if registry.broken_model(id).is_some() {
        // Its problems have been printed already.
        return Err(Failure::Invalid(format!("{id} was not checked: its file has errors")));
    }
    let model = find(registry, id)?;
    valid(registry, model)?;
    let given = set.values(model)?;
    let effort = Effort::default();
    let bar = super::progress(effort.sets as u64, options);
    let findings = match ENGINE {
        Some(engine) => {
            let mut evaluator = (engine.evaluator)(registry.sources(), model)?;
            let mut last = None;
            laws::examine(model, &given, effort, |values, pairs| {
                if last.as_ref() != Some(values) {
                    evaluator.set(values, Encoding::Srgb);
                    last = Some(values.clone());
                    bar.inc(1);
                }
                evaluator.evaluate(pairs)
            })?
        }
        None => {
            Machine::Cpu.can_run(model)?;
            let tell = |done: f32, _: &str| bar.set_position((done * effort.sets as f32) as u64);
            let progress = Progress { tell: &tell, cancelled: &|| false };
            let findings = laws::examine_on_cpu(model, &given, effort, &progress).unwrap_or_default();
            Machine::Cpu.can_run(model)?;
            findings
        }
    };
    bar.finish_and_clear();
    let report = LawReport::new(model, &given, &findings);
    if as_json {
        print_json(&report)?;
    } else {
        print_text(&report.to_string())?;
    }
    let mut is_finite = report.is_finite();
    if !is_finite {
        complain(format_args!("{id} returns values that are not numbers"));
    } else if ENGINE.is_some()
        && let Some(found) = on_cpu(id, given, registry)
    {
        is_finite = false;
        // Drivers may assume that no number is infinite.
        complain(format_args!(
            "{id} is finite on the GPU, which was given light from single directions and no ambient light; on the CPU, an object {found}"
        ));
    }
    match report.broken().as_slice() {
        [] if is_finite => Ok(()),
        [] => Err(Failure::Invalid(String::new())),
        laws => Err(Failure::Invalid(format!("{id} claims to be {}, but is not", listed(laws, "and")))),
    }
}
