//! The command line: parsing, and the commands themselves.
//!
//! Results go to standard output, errors to standard error, one line each. The exit status indicates the kind
//! of error: see [`Failure`]. No heavy work happens here: a command starts the renderer or window that it
//! needs.

use crate::{
    export::payload,
    failure::Failure,
    files::{self, printable, printable_json, printable_line},
    parameter::Outside,
    platform,
    program::{self, HAS_WINDOW, in_own_words, without_window},
    progress::{Progress, named, time_left},
    reference::MAX_SIDE,
    registry::Registry,
    scene::load::Defaults,
    signals::Interrupt,
    text::{listed, nearest},
};
use std::{
    any::TypeId,
    ffi::OsString,
    fmt,
    io::{self, IsTerminal as _, Write},
    path::{Path, PathBuf},
    process::ExitCode,
    sync::mpsc,
    thread,
    time::Duration,
};

use clap::{Arg, Args, CommandFactory as _, FromArgMatches as _, Parser, Subcommand, error::ErrorKind};
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

pub use engine::App;
use engine::{Additions, engine};
use serde::Serialize;
use workshop::Places;

mod albedo;
mod angles;
mod assets;
mod changes;
mod check;
mod compare;
mod custom;
mod engine;
mod evaluate;
mod explain;
mod export;
mod finite;
mod installed;
mod lesson;
mod light_samples;
mod linear;
mod matching;
mod materials;
mod models;
mod new;
mod outputs;
mod pictures;
mod plot;
mod render;
#[cfg(target_os = "linux")]
mod runtime_folder;
mod scenes;
mod study;
mod sweep;
mod view;
mod views;
mod workshop;

/// A laboratory for the equations that light a surface: see, compare, edit and trust reflection models.
///
/// Without a command, opens the window; without a scene, shows the default scene.
#[derive(Parser, Debug)]
#[command(name = "lcm", version, override_usage = USAGE, after_help = after_help())]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    view: view::Arguments,
    #[command(flatten)]
    scenes: SceneOptions,
    #[command(flatten)]
    options: Options,
    #[command(flatten)]
    places: Places,
}

impl Cli {
    /// True if the command answers Ctrl+C itself: the window, and work of which a part is worth having.
    fn handles_signals(&self) -> bool {
        matches!(&self.command, None | Some(Command::View(_) | Command::TryShaders | Command::Match(_)))
    }
}

#[cfg(target_os = "linux")]
impl Cli {
    /// True if the command loads a graphics driver.
    fn loads_driver(&self) -> bool {
        match &self.command {
            None | Some(Command::View(_)) => true,
            Some(Command::Render(arguments)) => arguments.own.loads_driver(),
            Some(Command::Evaluate(arguments) | Command::Albedo(arguments)) => arguments.loads_driver(),
            Some(Command::Models(arguments)) => arguments.loads_driver(),
            Some(_) => false,
        }
    }
}

/// Usage with or without a command.
const USAGE: &str = "lcm [OPTIONS] [SCENE]\n       lcm [OPTIONS] <COMMAND>";
/// Printed below the help.
const EXIT_STATUS: &str = "Exit status: 0 success; 1 a scene or an input is invalid; 2 wrong usage; \
                           3 no renderer or no display; 4 a result could not be written; \
                           128 + n ended by signal n (130 for Ctrl+C).";

/// The end of the help.
fn after_help() -> String {
    let missing = if HAS_WINDOW {
        String::new()
    } else {
        format!("{}\n\n", without_window("`lcm view` and the GPU are missing"))
    };
    missing + EXIT_STATUS
}

/// Options of every command.
#[derive(Args, Clone, Copy, Debug)]
struct Options {
    /// Print only results and errors
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Print details of what is done
    #[arg(long, short, global = true)]
    verbose: bool,
    /// Those of the command, if it reads scenes.
    #[arg(skip)]
    scenes: SceneOptions,
    /// True if this program reads such arguments when it is started again.
    #[arg(skip)]
    restarts: bool,
}

/// Options of commands that read files which scenes name.
#[derive(Args, Clone, Copy, Debug, Default)]
struct Reach {
    /// Let scenes read files outside their folders
    #[arg(long)]
    allow_outside: bool,
}

/// Options of commands that read scenes. They may stand before the command, too.
#[derive(Args, Clone, Copy, Debug, Default)]
struct SceneOptions {
    /// Use defaults for a missing scene size, reflection model or shading model, without asking
    #[arg(long, conflicts_with = "no_defaults")]
    use_defaults: bool,
    /// Reject scenes without scene size, reflection model or shading model, without asking
    #[arg(long)]
    no_defaults: bool,
    #[command(flatten)]
    reach: Reach,
}

/// The arguments of a command that reads scenes.
#[derive(Args, Debug)]
struct OfScenes<T: Args> {
    #[command(flatten)]
    own: T,
    #[command(flatten)]
    scenes: SceneOptions,
}

impl SceneOptions {
    /// The first option that is given, for messages.
    fn given(self) -> Option<&'static str> {
        let all = [
            (self.use_defaults, "--use-defaults"),
            (self.no_defaults, "--no-defaults"),
            (self.reach.allow_outside, "--allow-outside"),
        ];
        all.into_iter().find_map(|(given, name)| given.then_some(name))
    }
}

impl Cli {
    /// The options of scenes before or after the command.
    fn scene_options(&self) -> Result<SceneOptions, Failure> {
        use Command::{Check, Compare, Explain, Export, Lesson, Match, Render, Sweep, View};
        let before = self.scenes;
        let own = match &self.command {
            None => Some(SceneOptions::default()),
            Some(View(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Render(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Sweep(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Compare(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Check(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Export(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Explain(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Match(OfScenes { scenes, .. })) => Some(*scenes),
            Some(Lesson(command)) if !before.use_defaults && !before.no_defaults => {
                command.reach().map(|reach| SceneOptions { reach, ..SceneOptions::default() })
            }
            Some(_) => None,
        };
        let Some(own) = own else {
            return match before.given() {
                None => Ok(before),
                Some(flag) => Err(Failure::Usage(format!("{flag} is not an option of this command"))),
            };
        };
        let merged = SceneOptions {
            use_defaults: before.use_defaults || own.use_defaults,
            no_defaults: before.no_defaults || own.no_defaults,
            reach: Reach { allow_outside: before.reach.allow_outside || own.reach.allow_outside },
        };
        if merged.use_defaults && merged.no_defaults {
            return Err(Failure::Usage("--use-defaults cannot be used with --no-defaults".to_owned()));
        }
        Ok(merged)
    }
}

impl Options {
    /// The program that tries shaders in a separate process: this one. `None` if the arguments are not those
    /// of the process, since such a program may not parse them when it is started again.
    fn trial_program(self) -> Option<PathBuf> {
        files::program().filter(|_| self.restarts)
    }

    /// The files outside their folders that scenes may name.
    fn outside(self) -> &'static Outside {
        if self.scenes.reach.allow_outside { Outside::ALL } else { Outside::NONE }
    }

    /// The answer given by flags to questions about missing parts, if any.
    fn defaults(self) -> Defaults {
        match (self.scenes.use_defaults, self.scenes.no_defaults) {
            (true, _) => Defaults::Use,
            (_, true) => Defaults::Refuse,
            _ => Defaults::Ask,
        }
    }

    /// Reports a step, unless `--quiet` is given.
    fn tell(self, what: impl fmt::Display) {
        if !self.quiet {
            complain(what);
        }
    }

    /// Reports a detail, if `--verbose` is given.
    fn detail(self, what: impl fmt::Display) {
        if self.verbose {
            complain(what);
        }
    }
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Open the window (same as `lcm` alone)
    View(OfScenes<view::Arguments>),
    /// Render scenes to PNG files, or to OpenEXR and Radiance files with linear light
    Render(OfScenes<render::Arguments>),
    /// Draw a scene with some of its values varied: a sheet with labels, a film, or a folder of pictures
    ///
    /// The CPU renderer draws the pictures, several at once. A sweep that was interrupted goes on with the same command.
    Sweep(OfScenes<sweep::Arguments>),
    /// Compare two views of a scene, two scenes or two pictures: numbers as JSON, and a picture
    ///
    /// Without B, the scene is compared with its own variant. Prints RMSE, PSNR, SSIM, FLIP and the largest difference.
    Compare(OfScenes<compare::Arguments>),
    /// Check scenes and print every problem
    Check(OfScenes<check::Arguments>),
    /// Write the default scene to a new file
    New {
        /// File to write; it must not exist yet
        #[arg(value_parser = outputs::place())]
        file: PathBuf,
    },
    /// Write a scene as code: a project, shaders, a page, a program, a scene for another renderer
    Export(OfScenes<export::Arguments>),
    /// Explain the colour of a pixel: the equation with its numbers, light by light, and the way to the display
    ///
    /// Prints a worked example: where the equation was evaluated, directions and cosines, the intensity of each light, each
    /// term, their sum, exposure, tone mapping, encoding and code. One sample, at the pixel's centre, by the CPU renderer.
    Explain(OfScenes<explain::Arguments>),
    /// List, check and print lessons
    #[command(subcommand)]
    Lesson(lesson::Command),
    /// Find the parameters of a view that come nearest to view A
    Match(OfScenes<matching::Arguments>),
    /// List reflection models, shading models, light types and object types; write and check custom models
    Models(models::Arguments),
    /// List the library of materials, or draw each on a sphere: measured ones, presets and your own
    ///
    /// Your own are JSON files in the folder materials beside that of custom models.
    Materials(materials::Arguments),
    /// Copy the built-in shaders and example models to a folder for editing
    #[command(subcommand)]
    Assets(assets::Command),
    /// Print the BRDF (the reflectance by direction) of a model at given angles, as CSV
    ///
    /// Reads CSV from standard input, with the columns theta_i, phi_i, theta_o, phi_o: the directions to the light (i)
    /// and to the observer (o) in degrees, theta from the normal and phi around it from the tangent. Adds the columns
    /// f_r, f_g, f_b: the red, green and blue BRDF in 1/sr, diffuse and specular without the cosine. A light or an
    /// observer below the surface (theta beyond 90°) gives what the model transmits, 0 for most; with --on gpu,
    /// observers there see 0.
    Evaluate(evaluate::Arguments),
    /// Compare Blinn–Phong with physically based models and take OpenPBR apart: a report with numbers
    Study(study::Arguments),
    /// Print the directional albedo of a model at given viewing angles, as CSV
    ///
    /// Reads CSV from standard input, with the column mu: the cosine of the angle between the normal and the view,
    /// above 0 and at most 1. Adds the columns e_r, e_g, e_b: the directional albedo, the fraction of uniform light
    /// from above that the surface reflects to the observer; light that passes through is not counted. Anisotropic
    /// models are seen along the tangent.
    Albedo(evaluate::Arguments),
    /// Plot models: BRDF, albedo, Fresnel factor, distribution, masking, image slice; as SVG, PNG or CSV
    ///
    /// Without -o, prints CSV: a line per point, angles in degrees, the BRDF in 1/sr. Several curves of one model differ
    /// in their parameters, such as phong:alpha=20 phong:alpha=80.
    Plot(plot::Arguments),
    /// Print the JSON Schema of scene files
    Schema,
    /// Print a completion script for a shell
    ///
    /// For bash, for example: lcm completions bash > ~/.local/share/bash-completion/completions/lcm
    Completions {
        /// The shell that reads it
        shell: clap_complete::Shell,
    },
    /// Write manual pages for man: one about the program, and one about each command
    Manual {
        /// Destination folder; created if it does not exist
        #[arg(value_parser = outputs::place())]
        folder: PathBuf,
    },
    /// Try shaders for a window
    #[command(hide = true, name = program::TRY_SHADERS)]
    TryShaders,
}

/// The rule that a word must be one of these, with the nearest.
fn one_of(what: &str, word: &str, known: &[&str]) -> String {
    let near = nearest(word, known.iter().map(|k| (*k, *k)));
    let hint = near.map_or_else(String::new, |k| format!("; did you mean {k}?"));
    format!("{what} must be {}{hint}", listed(known, "or"))
}

/// Parser of positive counts.
fn above_zero(text: &str) -> Result<u32, String> {
    let parsed = text.trim().parse::<u32>().ok().filter(|number| *number > 0);
    parsed.ok_or_else(|| format!("it must be a whole number from 1 to {}", u32::MAX))
}

/// Parser of sizes: width and height.
fn sides(text: &str) -> Result<[u32; 2], String> {
    sides_up_to(MAX_SIDE, text)
}

/// The size of a window.
fn window_sides(text: &str) -> Result<[u32; 2], String> {
    /// A window of 16384×16384 takes 5 GB, and software Vulkan does not draw it within the time that a driver gets.
    const MAX_WINDOW: u32 = 8192;
    sides_up_to(MAX_WINDOW, text)
}

fn sides_up_to(most: u32, text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.trim().parse().ok().filter(|n| (1..=most).contains(n));
    let both = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
    both.ok_or_else(|| format!("it must be WIDTHxHEIGHT in pixels, each from 1 to {most}, e.g. 800x600"))
}

/// The result of a command.
type Outcome = Result<(), Failure>;

/// Everything, or all problems of the invalid files; any other failure at once.
fn collected<T>(all: impl Iterator<Item = Result<T, Failure>>) -> Result<Vec<T>, Failure> {
    let (mut good, mut problems) = (Vec::new(), Vec::new());
    for one in all {
        match one {
            Ok(one) => good.push(one),
            Err(Failure::Invalid(problem)) => problems.push(problem),
            Err(other) => return Err(other),
        }
    }
    if problems.is_empty() { Ok(good) } else { Err(Failure::Invalid(problems.join("\n"))) }
}

/// The results of checking some files.
struct Checked<P> {
    reports: Vec<Report<P>>,
    /// The text about the valid files.
    listed: String,
}

/// The result for one file, as JSON.
#[derive(Serialize)]
struct Report<P> {
    file: String,
    valid: bool,
    problems: Vec<P>,
}

impl<P: Serialize> Checked<P> {
    fn new() -> Self {
        Self { reports: Vec::new(), listed: String::new() }
    }

    fn add(&mut self, file: String, problems: Vec<P>) {
        self.reports.push(Report { file, valid: problems.is_empty(), problems });
    }

    /// Prints the results. `what` is the plural of what was checked.
    fn print(&self, json: bool, options: Options, what: &str) -> Outcome {
        if json {
            print_json(&self.reports)?;
        } else if !options.quiet {
            print_text(&self.listed)?;
        }
        match (self.reports.iter().filter(|report| !report.valid).count(), self.reports.len()) {
            (0, _) => Ok(()),
            (_, all) if json || all == 1 => Err(Failure::Invalid(String::new())),
            (n, all) => {
                let are = if n == 1 { "is" } else { "are" };
                Err(Failure::Invalid(format!("{n} of {all} {what} {are} invalid")))
            }
        }
    }
}

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    platform::report_panics();
    run_as(Some(program::LAB), platform::arguments(), |_| (), |_| ())
}

/// Runs the command line of this process with additional types, known to every command, and with additions to
/// the window: panels, systems, plugins. Types belong in the first function: those registered by the second
/// one are known only to the window, including its scene, and do not replace known types with the same id.
///
/// In its help and messages, the program has the name of its file, or that of [`program::set_name`], and
/// stores settings and copies of unsaved work [under that name](program::own).
///
/// ```no_run
/// use lights_camera_models::{bevy::prelude::*, cli, prelude::*};
/// # use lights_camera_models::reflection::Lambert as Velvet;
///
/// fn main() -> std::process::ExitCode {
///     cli::main_with(
///         |registry| {
///             registry.add_reflection_model::<Velvet>();
///         },
///         |app| {
///             app.add_systems(Update, || info!("a frame"));
///         },
///     )
/// }
/// ```
#[must_use]
pub fn main_with(types: impl FnOnce(&mut Registry), window: impl FnOnce(&mut App)) -> ExitCode {
    run_with(platform::arguments(), types, window)
}

/// [`clap`]'s command with the name of the program.
fn command() -> clap::Command {
    taking_negative_numbers(Cli::command())
        .name(program::command())
        .bin_name(program::command())
        .override_usage(in_own_words(USAGE).into_owned())
}

/// A command whose options take negative numbers, so that each refuses them by its own rule. Otherwise, clap takes them for
/// options that do not exist.
fn taking_negative_numbers(command: clap::Command) -> clap::Command {
    let taking = |arg: Arg| {
        let value = arg.get_value_parser().type_id();
        if arg.is_positional() || !arg.get_action().takes_values() || value == TypeId::of::<PathBuf>() {
            return arg;
        }
        // Two numbers, as in -8x8 or -1,0, are none for clap.
        if value == TypeId::of::<[u32; 2]>() {
            return arg.allow_hyphen_values(true);
        }
        arg.allow_negative_numbers(true)
    };
    command.mut_args(taking).mut_subcommands(taking_negative_numbers)
}

/// Like [`main_with`], with these arguments, of which the first is the name of the program.
#[must_use]
pub fn run_with(
    arguments: impl IntoIterator<Item = OsString>,
    types: impl FnOnce(&mut Registry),
    window: impl FnOnce(&mut App),
) -> ExitCode {
    run_as(None, arguments, types, window)
}

fn run_as(
    name: Option<&str>,
    arguments: impl IntoIterator<Item = OsString>,
    types: impl FnOnce(&mut Registry),
    window: impl FnOnce(&mut App),
) -> ExitCode {
    let inside = payload::inside();
    // An exported program is independent.
    if let (Some(name), Ok(None)) = (name, &inside) {
        program::set_name(name);
    }
    let mut arguments: Vec<_> = arguments.into_iter().collect();
    // `lcm help render --help` asks for one thing twice, which clap does not understand.
    if arguments.get(1).is_some_and(|word| word == "help") {
        arguments.retain(|word| word != "--help" && word != "-h");
    }
    let parsed = command().try_get_matches_from(&arguments).and_then(|found| Cli::from_arg_matches(&found));
    let mut cli = match parsed {
        Ok(cli) => cli,
        Err(error) => {
            return match error.kind() {
                // Help and version are results; clap sends them to standard output.
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion if program::name() == program::LAB => {
                    ended(error.print().and_then(|()| io::stdout().flush()).map_err(Failure::from))
                }
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                    ended(print(&in_own_words(&error.render().to_string())))
                }
                _ => {
                    misunderstood(&error, &arguments);
                    ExitCode::from(2)
                }
            };
        }
    };
    cli.options.restarts = arguments.iter().eq(&std::env::args_os().collect::<Vec<_>>());
    match inside {
        Ok(inside) => cli.places = cli.places.with(inside),
        Err(error) => return ended(Err(Failure::Invalid(error.to_string()))),
    }
    #[cfg(target_os = "linux")]
    if engine::ENGINE.is_some() && cli.loads_driver() {
        runtime_folder::provide();
    }
    match cli.scene_options() {
        Ok(scenes) => cli.options.scenes = scenes,
        Err(failure) => return ended(Err(failure)),
    }
    if !cli.handles_signals() {
        // Without it, temporary files may remain until the next tidying after a signal.
        let _ = Interrupt::end_tidily();
    }
    let mut registry = Registry::builtin();
    types(&mut registry);
    ended(run(cli, registry, Box::new(window)))
}

/// Prints a failure, and returns the exit status.
fn ended(outcome: Outcome) -> ExitCode {
    let Err(failure) = outcome else { return ExitCode::SUCCESS };
    match &failure {
        Failure::Closed => {}
        Failure::Usage(what) => complain(format_args!("error: {what}")),
        // The problems have already been printed as a result.
        Failure::Invalid(what) if what.is_empty() => {}
        Failure::Invalid(what) | Failure::NoRenderer(what) | Failure::Write(what) => complain(what),
    }
    ExitCode::from(failure.status())
}

/// Prints a usage error found by clap, in its colours unless it repeats control characters.
fn misunderstood(error: &clap::Error, arguments: &[OsString]) {
    let odd = arguments.iter().any(|word| printable(&word.to_string_lossy()) != word.to_string_lossy());
    if odd || program::name() != program::LAB {
        complain(error.render().to_string().trim_end());
    } else {
        // If this fails, there is nobody left to inform.
        let _ = error.print();
    }
}

/// Runs a command with all known types except custom models.
fn run(cli: Cli, known: Registry, window: Additions) -> Outcome {
    use Command::*;
    let options = cli.options;
    if let Some(stray) = cli.view.given().filter(|_| cli.command.is_some()) {
        return Err(Failure::Usage(format!("{stray} must come after the command")));
    }
    let places = &cli.places;
    match cli.command {
        None => view(cli.view, options, places, known, window),
        Some(View(given)) => view(given.own, options, places, known, window),
        Some(Render(given)) => render::run(&given.own, options, &mut places.open(options, known)?),
        Some(Sweep(given)) => sweep::run(&given.own, options, &mut places.open(options, known)?),
        Some(Compare(given)) => compare::run(&given.own, options, &mut places.open(options, known)?),
        Some(Check(given)) => check::run(&given.own, options, &mut places.open(options, known)?),
        Some(New { file }) => new::run(&file, options, &known),
        Some(Export(given)) => export::run(&given.own, options, &mut places.open(options, known)?),
        Some(Explain(given)) => explain::run(&given.own, options, &mut places.open(options, known)?),
        Some(Lesson(command)) => lesson::run(&command, options, places.open(options, known)?.list()),
        Some(Match(given)) => matching::run(&given.own, options, &mut places.open(options, known)?),
        Some(Models(given)) => models::run(given, options, places, known),
        Some(Materials(given)) => materials::run(&given, options, &mut places.open(options, known)?),
        Some(Assets(command)) => assets::run(&command, options, &known),
        Some(Evaluate(given)) => evaluate::BRDF.print(&given, options, &mut places.open(options, known)?),
        Some(Study(given)) => study::run(&given, options, &known),
        Some(Albedo(given)) => albedo::ALBEDO.print(&given, options, &mut places.open(options, known)?),
        Some(Plot(given)) => plot::run(&given, options, &mut places.open(options, known)?),
        Some(Completions { shell }) => installed::completions(shell),
        Some(Manual { folder }) => installed::manual(&folder, options),
        Some(TryShaders) => (engine("there are no shaders to try")?.try_shaders)(),
        Some(Schema) => print(&crate::scene::schema::text(places.open(options, known)?.list())),
    }
}

/// Opens the window.
fn view(
    arguments: view::Arguments,
    options: Options,
    places: &Places,
    known: Registry,
    window: Additions,
) -> Outcome {
    let engine = engine("`lcm render` draws scenes, and `lcm --help` lists all commands");
    // A misspelt command is no scene.
    let meant = |scene| view::meant_command(scene);
    let engine =
        engine.or_else(|missing| arguments.scene.as_deref().map_or(Ok(()), meant).and(Err(missing)))?;
    (engine.view)(arguments, options, places, known, window)
}

/// Prints a result for people to standard output, with control characters escaped.
fn print_text(text: &str) -> Outcome {
    print(&printable(&in_own_words(text)))
}

/// Prints paths to standard output, a line each: unchanged for programs, printable for people.
fn print_paths<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Outcome {
    let lines: String = paths.into_iter().map(|path| format!("{}\n", path.display())).collect();
    if io::stdout().is_terminal() { print_text(&lines) } else { print(&lines) }
}

/// Prints a value as JSON to standard output.
fn print_json(value: &impl Serialize) -> Outcome {
    let json = serde_json::to_string_pretty(value).unwrap_or_default();
    print(&printable_json(&format!("{json}\n")))
}

/// Prints a result for programs to standard output.
fn print(text: &str) -> Outcome {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

/// Prints a line to standard error, with control characters escaped.
fn complain(what: impl fmt::Display) {
    platform::tell(&printable(&in_own_words(&what.to_string())));
}

/// Number of steps of a progress bar for a single piece of work.
const FINE: u64 = 1_000_000;

/// A progress bar if it helps: several steps, a terminal, and no `--quiet`.
fn progress(steps: u64, options: Options) -> ProgressBar {
    if steps < 2 || options.quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps);
    bar.set_style(style("{bar:30} {pos}/{len} {msg}"));
    bar
}

/// The style of a progress bar; `{time}` is the remaining time, if known, and otherwise the time so far.
fn style(template: &str) -> ProgressStyle {
    let told = |state: &ProgressState, text: &mut dyn fmt::Write| {
        // Writing to a String cannot fail.
        let _ = text.write_str(&time(state.fraction(), state.elapsed()));
    };
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    style.with_key("time", told)
}

/// The remaining time of some work in words, or the time so far.
fn time(done: f32, elapsed: Duration) -> String {
    match time_left(done, elapsed) {
        Some(left) => format!("{:#} left", HumanDuration(left)),
        None => format!("{:#} so far", HumanDuration(elapsed)),
    }
}

/// Runs some work and, if it takes longer than a given time and there is a terminal, calls `watch` in
/// parallel, with a function that waits a moment and returns true as long as the work continues.
fn attended<T>(
    options: Options,
    patience: Duration,
    watch: impl FnOnce(&dyn Fn() -> bool) + Send,
    work: impl FnOnce() -> T,
) -> T {
    const PAUSE: Duration = Duration::from_millis(50);
    if options.quiet || !io::stderr().is_terminal() {
        return work();
    }
    let (ends, ended) = mpsc::channel::<()>();
    thread::scope(|scope| {
        scope.spawn(move || {
            let goes_on = |time| ended.recv_timeout(time) == Err(mpsc::RecvTimeoutError::Timeout);
            if goes_on(patience) {
                watch(&|| goes_on(PAUSE));
            }
        });
        let result = work();
        drop(ends);
        result
    })
}

/// Names a step of some work beside its bar.
fn name_step(bar: &ProgressBar, work: &str, step: &str) {
    bar.set_message(printable_line(&named(work, step)).into_owned());
}

/// Runs some work and, if it takes long, shows its name on a terminal, with a progress bar if the work
/// reports its progress.
fn gauged<T>(what: &str, options: Options, work: impl FnOnce(&Progress) -> T) -> T {
    gauged_until(what, options, &|| false, work)
}

/// Like [`gauged`], for work that ends early, with what it has, once it is cancelled.
fn gauged_until<T>(
    what: &str,
    options: Options,
    cancelled: &dyn Fn() -> bool,
    work: impl FnOnce(&Progress) -> T,
) -> T {
    let bar = ProgressBar::with_draw_target(Some(FINE), ProgressDrawTarget::hidden());
    name_step(&bar, what, "");
    let tell = |done: f32, step: &str| {
        name_step(&bar, what, step);
        bar.set_position((done * FINE as f32) as u64);
    };
    let watch = |goes_on: &dyn Fn() -> bool| {
        bar.set_style(style("{spinner} {msg}, {time}; Ctrl+C ends it"));
        bar.set_draw_target(ProgressDrawTarget::stderr());
        let mut known = false;
        while goes_on() {
            if !known && bar.position() > 0 {
                known = true;
                bar.set_style(style("{bar:30} {percent} % {msg}, {time}; Ctrl+C ends it"));
            }
            bar.tick();
        }
        bar.finish_and_clear();
    };
    let progress = Progress { tell: &tell, cancelled };
    attended(options, Duration::from_secs(1), watch, || work(&progress))
}

/// Asks a yes-or-no question on the terminal; `None` without a terminal. Anything except y or yes is a no.
fn ask(question: &str) -> Option<bool> {
    if !io::stdin().is_terminal() || !io::stderr().is_terminal() {
        return None;
    }
    let mut err = io::stderr().lock();
    write!(err, "{} [y/N] ", printable(question)).and_then(|()| err.flush()).ok()?;
    let mut answer = String::new();
    io::stdin().read_line(&mut answer).ok()?;
    Some(matches!(answer.trim().to_lowercase().as_str(), "y" | "yes"))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn names_beside_a_bar_obey_no_terminal() {
        let bar = ProgressBar::hidden();
        name_step(&bar, "drawing", "Gold\u{1b}[31m\nerror");
        assert_eq!(bar.message(), r"drawing, Gold\u{1b}[31m\nerror");
    }

    #[test]
    fn the_declaration_of_the_command_line_is_sound() {
        command().debug_assert();
    }

    #[test]
    fn a_scene_alone_opens_the_window() {
        let cli = Cli::try_parse_from(["lcm", "room.json", "--exit-after", "3"]).expect("valid");
        assert!(cli.command.is_none());
        for arguments in [
            ["lcm", "render", "room.json", "--use-defaults"],
            ["lcm", "--use-defaults", "render", "room.json"],
        ] {
            let cli = Cli::try_parse_from(arguments).expect("valid");
            assert!(cli.scene_options().expect("valid").use_defaults);
            assert!(matches!(cli.command, Some(Command::Render(_))));
            assert_eq!(cli.view.given(), None);
        }
    }

    #[test]
    fn options_of_scenes_are_those_of_commands_that_read_scenes_alone() {
        let all = ["--use-defaults", "--no-defaults", "--allow-outside"];
        let mut shown = Vec::new();
        for mut command in Cli::command().get_subcommands().cloned() {
            let help = command.render_long_help().to_string();
            match all.iter().filter(|flag| help.contains(**flag)).count() {
                0 => {}
                3 => shown.push(command.get_name().to_owned()),
                _ => panic!("{help}"),
            }
        }
        assert_eq!(shown, ["view", "render", "sweep", "compare", "check", "export", "explain", "match"]);
        let said = |arguments: &[&str]| {
            let cli = Cli::try_parse_from([&["lcm"], arguments].concat());
            cli.map_err(|e| e.to_string()).and_then(|cli| cli.scene_options().map_err(|e| e.to_string()))
        };
        for command in
            ["schema", "models", "study", "new x.json", "evaluate phong", "plot phong", "lesson list"]
        {
            let words: Vec<_> = command.split(' ').collect();
            for flag in all {
                let behind = said(&[&words[..], &[flag]].concat()).expect_err(command);
                assert!(behind.contains(&format!("unexpected argument '{flag}'")), "{behind}");
                let before = said(&[&[flag], &words[..]].concat()).expect_err(command);
                assert_eq!(before, format!("{flag} is not an option of this command"));
            }
        }
        let outside = said(&["lesson", "check", "l.md", "--allow-outside"]).expect("lessons have scenes");
        assert!(outside.reach.allow_outside);
        let both = said(&["--use-defaults", "check", "x", "--no-defaults"]).expect_err("both");
        assert_eq!(both, "--use-defaults cannot be used with --no-defaults");
    }

    #[test]
    fn the_time_of_a_bar_is_what_is_left_once_that_is_known() {
        assert_eq!(time(0.01, Duration::from_secs(20)), "20s so far");
        assert_eq!(time(0.5, Duration::from_secs(20)), "20s left");
    }

    #[test]
    fn sizes_have_two_sides() {
        assert_eq!(sides("800x600"), Ok([800, 600]));
        for wrong in ["800", "0x5", "5x-1", "x", "axb", "99999x1", ""] {
            assert!(sides(wrong).is_err(), "{wrong}");
        }
        assert!(sides("16384x1").is_ok() && window_sides("8192x8192").is_ok());
        assert!(window_sides("8193x1").is_err_and(|why| why.contains("each from 1 to 8192")));
    }
}
