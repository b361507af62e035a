//! The window with a scene or a lesson from the command line.

use std::path::Path;

use super::{
    super::{
        Options, Outcome, outputs,
        scenes::Source,
        view::{Arguments, meant_command},
        workshop::Places,
    },
    Additions,
};
use crate::files::Shown as _;
use crate::{
    export::write::inputs,
    failure::Failure,
    files,
    lesson::{Lesson, shipped::LESSONS},
    panel::state::LessonSource,
    program,
    registry::Registry,
    scene::{error::LoadError, load::Defaults},
    text::{did_you_mean, listed, plural, quoted},
    window::ViewOptions,
};

/// `lcm view`.
pub(super) fn open(
    arguments: Arguments,
    options: Options,
    places: &Places,
    known: Registry,
    window: Additions,
) -> Outcome {
    let mut workshop = places.open_for_window(options, known)?;
    let source = Source::of(arguments.scene.as_deref(), &workshop);
    let Arguments { exit_after, capture, no_scene, size, lesson, step, .. } = arguments;
    if let Some(capture) = &capture {
        outputs::picture(capture, &inputs(source.path(), [], &workshop.registry))?;
        outputs::one_picture("--capture", capture)?;
        let _ = files::tidy(files::folder_of(capture));
    }
    let warnings = match &source {
        // Interrupted writes of a killed process are finished before the file is read.
        Source::File(path) => {
            let target = files::follow(path).unwrap_or_else(|_| path.clone());
            files::tidy(files::folder_of(&target)).iter().map(ToString::to_string).collect()
        }
        _ => Vec::new(),
    };
    let wanted = match &source {
        Source::Inside(inside) => inside.about.size,
        _ => None,
    };
    let Options { verbose, quiet, .. } = options;
    let mut view = ViewOptions {
        lesson: lesson
            .as_deref()
            .map(|lesson| lesson_source(lesson, step, options, &workshop.registry))
            .transpose()?,
        outside: options.outside().clone(),
        step: step.map(|step| step as usize - 1),
        examples: source == Source::Default,
        use_defaults: options.defaults() == Defaults::Use,
        size: size.or(wanted),
        exit_after,
        capture,
        no_scene,
        trial_program: options.trial_program(),
        warnings,
        verbose,
        quiet,
        ..ViewOptions::default()
    };
    let file = match &source {
        // Input that can be read only once cannot be followed or saved to.
        Source::File(path) if !files::is_stream(path) => Some(path.clone()),
        _ => None,
    };
    match file {
        None => view.scene = source.open(&mut workshop, options)?,
        Some(path) => {
            meant_command(&path)?;
            match source.read(&mut workshop, options.defaults()) {
                // The window asks in a dialog.
                Ok(loaded) if !loaded.missing.is_empty() && options.defaults() == Defaults::Ask => {
                    view.open = Some(path);
                }
                Err(error @ LoadError::Empty { .. }) => match options.defaults() {
                    Defaults::Ask => view.open = Some(path),
                    Defaults::Use => {}
                    Defaults::Refuse => return Err(Failure::Invalid(error.to_string())),
                },
                Ok(loaded) => {
                    (view.scene, view.stamp, view.file) = (loaded.scene, Some(loaded.stamp), Some(path));
                }
                // In an extended program, the window may know types that the command line does not.
                Err(_) if program::name() != program::LAB => view.late = Some((path, options.defaults())),
                Err(error) => return Err(Failure::Invalid(error.to_string())),
            }
        }
    }
    // The scene determines how much of it is read.
    view.registry = Some(workshop.registry);
    crate::window::view(view, window)
}

/// The shipped lesson with this name, or else the file, if it has the step at which it begins.
fn lesson_source(
    lesson: &Path,
    step: Option<u32>,
    options: Options,
    registry: &Registry,
) -> Result<LessonSource, Failure> {
    let beginning = |lesson: &Lesson| {
        let count = lesson.steps.len();
        let beyond = step.filter(|step| *step as usize > count);
        let said = |step| format!("--step is {step}, but the lesson has {}", plural(count, "step"));
        beyond.map_or(Ok(()), |step| Err(Failure::Usage(said(step))))
    };
    let shipped = LESSONS.iter().position(|known| lesson.to_str() == Some(known.id.as_str()));
    if let Some(i) = shipped {
        beginning(&LESSONS[i])?;
        return Ok(LessonSource::Shipped(i));
    }
    let name = lesson.shown().to_string();
    if !crate::platform::fs::is_there(lesson) {
        let known: Vec<_> = LESSONS.iter().map(|lesson| lesson.id.as_str()).collect();
        let near = did_you_mean(&name, known.iter().map(|id| (*id, *id)));
        let all = format!("; the lessons are {}", listed(&known, "and"));
        let shipped = if known.is_empty() { "" } else { &all };
        let none = format!("there is no lesson {}, and no file of that name", quoted(&name));
        return Err(Failure::Invalid(format!("{none}{shipped}{near}")));
    }
    let read = Lesson::read(lesson, registry, options.outside()).map_err(|problems| {
        let all: Vec<_> = problems.iter().map(|problem| problem.annotated(&name)).collect();
        Failure::Invalid(all.join("\n"))
    })?;
    beginning(&read)?;
    Ok(LessonSource::File(lesson.to_owned()))
}
