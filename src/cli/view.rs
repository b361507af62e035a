//! `lcm view`: the window.

use std::path::{Path, PathBuf};

use bevy::app::App;
use clap::{Args, CommandFactory as _};

use super::{Options, Outcome, above_zero, outputs, render::sides, scenes::Source, workshop::Places};
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
    text::{did_you_mean, listed, nearest, quoted},
    window::ViewOptions,
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file; `-` is standard input; without one, the default scene
    scene: Option<PathBuf>,
    /// Open a lesson: the name of one that comes with the program, or a file
    #[arg(long, value_name = "NAME_OR_FILE")]
    lesson: Option<PathBuf>,
    /// Begin at this step of the lesson
    #[arg(long, value_name = "NUMBER", requires = "lesson", value_parser = above_zero)]
    step: Option<u32>,
    /// Close the window after this many frames
    #[arg(long, value_name = "FRAMES", value_parser = above_zero)]
    exit_after: Option<u32>,
    /// Write the whole window, panels included, to a PNG file before it closes
    #[arg(long, value_name = "FILE", requires = "exit_after", value_parser = outputs::place())]
    capture: Option<PathBuf>,
    /// Leave the scene out of that file: lcm cannot open it then
    #[arg(long, requires = "capture")]
    no_scene: bool,
    /// Size of the window in pixels
    #[arg(long, value_name = "WxH", value_parser = sides)]
    size: Option<[u32; 2]>,
}

impl Arguments {
    /// The first argument given, for messages.
    pub(super) fn given(&self) -> Option<String> {
        let scene = self.scene.as_ref().map(|s| s.shown().to_string());
        scene
            .or_else(|| self.exit_after.map(|_| "--exit-after".to_owned()))
            .or_else(|| self.capture.as_ref().map(|_| "--capture".to_owned()))
    }
}

pub(super) fn run(
    arguments: Arguments,
    options: Options,
    places: &Places,
    known: Registry,
    window: impl FnOnce(&mut App),
) -> Outcome {
    let mut workshop = places.open_for_window(options, known)?;
    let source = Source::of(arguments.scene.as_deref(), &workshop);
    let Arguments { exit_after, capture, no_scene, size, lesson, step, .. } = arguments;
    if let Some(capture) = &capture {
        outputs::picture(capture, &inputs(source.path(), [], &workshop.registry))?;
        let _ = files::tidy(files::folder_of(capture));
    }
    let warnings = match &source {
        // Interrupted writes of a killed process are finished before the file is read.
        Source::File(path) => {
            let target = files::follow(path).unwrap_or_else(|_| path.clone());
            files::tidy(files::folder_of(&target)).iter().map(ToString::to_string).collect()
        }
        Source::Default | Source::Inside(_) | Source::Stdin => Vec::new(),
    };
    let wanted = match &source {
        Source::Inside(inside) => inside.about.size,
        _ => None,
    };
    let Options { verbose, quiet, .. } = options;
    let mut view = ViewOptions {
        lesson: lesson
            .as_deref()
            .map(|lesson| lesson_source(lesson, options, &workshop.registry))
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

/// `lcm rendr room.json` is a misspelt command, not a scene called rendr.
fn meant_command(path: &Path) -> Outcome {
    let Some(word) = path.to_str().filter(|w| !w.contains(['.', '/', '\\'])) else { return Ok(()) };
    if path.exists() {
        return Ok(());
    }
    let program = super::Cli::command();
    let commands =
        program.get_subcommands().filter(|c| !c.is_hide_set()).map(|c| (c.get_name(), c.get_name()));
    match nearest(word, commands) {
        Some(command) if command == word => {
            Err(Failure::Usage(format!("there is no scene file {word}; the command is lcm {word}")))
        }
        Some(command) => Err(Failure::Usage(format!(
            "there is no command {word}, and no scene file of that name; did you mean lcm {command}?"
        ))),
        None => Ok(()),
    }
}

/// The shipped lesson with this name, or else the file.
fn lesson_source(lesson: &Path, options: Options, registry: &Registry) -> Result<LessonSource, Failure> {
    let shipped = lesson.to_str().and_then(|name| LESSONS.iter().position(|lesson| lesson.id == name));
    if let Some(i) = shipped {
        return Ok(LessonSource::Shipped(i));
    }
    let name = lesson.shown().to_string();
    if !lesson.exists() {
        let known: Vec<_> = LESSONS.iter().map(|lesson| lesson.id.as_str()).collect();
        let near = did_you_mean(&name, known.iter().map(|id| (*id, *id)));
        let all = format!("; the lessons are {}", listed(&known, "and"));
        let shipped = if known.is_empty() { "" } else { &all };
        let none = format!("there is no lesson {}, and no file of that name", quoted(&name));
        return Err(Failure::Invalid(format!("{none}{shipped}{near}")));
    }
    Lesson::read(lesson, registry, options.outside()).map_err(|problems| {
        let all: Vec<_> = problems.iter().map(|problem| problem.annotated(&name)).collect();
        Failure::Invalid(all.join("\n"))
    })?;
    Ok(LessonSource::File(lesson.to_owned()))
}
