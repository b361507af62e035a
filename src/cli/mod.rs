//! The command line: what `lcm` understands, and how it answers.
//!
//! Results go to standard output, errors to standard error, one line each. The exit status says what
//! kind of error it was: see [`Failure`]. Nothing heavy happens here: a renderer or a window is started
//! by the command that needs it.

use crate::{failure::Failure, files::printable, registry::Registry, scene::load::Defaults};
use std::{
    fmt,
    io::{self, IsTerminal as _, Write},
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::{Args, Parser, Subcommand, error::ErrorKind};
use indicatif::{ProgressBar, ProgressStyle};

use workshop::Places;

mod albedo;
mod angles;
mod assets;
mod check;
mod custom;
mod evaluate;
mod models;
mod new;
mod outputs;
mod render;
#[cfg(target_os = "linux")]
mod runtime_folder;
mod scenes;
mod study;
mod trial;
mod view;
mod workshop;

/// A laboratory for the equations that light a surface: see, compare, edit and trust reflection models.
///
/// Without a command, opens the window; without a scene, the default scene.
#[derive(Parser, Debug)]
#[command(name = "lcm", version, override_usage = USAGE, after_help = EXIT_STATUS)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    view: view::Arguments,
    #[command(flatten)]
    options: Options,
    #[command(flatten)]
    places: Places,
}

#[cfg(target_os = "linux")]
impl Cli {
    /// True for commands that may ask for a GPU or a window.
    fn may_draw(&self) -> bool {
        use Command::{Albedo, Evaluate, Models, Render, View};
        matches!(self.command, None | Some(View(_) | Render(_) | Evaluate(_) | Albedo(_) | Models(_)))
    }
}

/// With or without a command.
const USAGE: &str = "lcm [OPTIONS] [SCENE]\n       lcm [OPTIONS] <COMMAND>";
/// Explained below the help.
const EXIT_STATUS: &str = "Exit status: 0 done; 1 a scene or an input is invalid; 2 wrong usage; \
                           3 no renderer or no display; 4 could not write; 128 + n ended by signal n (Ctrl+C: 130).";

/// What holds for every command.
#[derive(Args, Clone, Copy, Debug)]
struct Options {
    /// Use the defaults when a scene lacks scene size, reflection model or shading model
    #[arg(long, global = true, conflicts_with = "no_defaults")]
    use_defaults: bool,
    /// Refuse a scene that lacks scene size, reflection model or shading model
    #[arg(long, global = true)]
    no_defaults: bool,
    /// Say nothing but results and errors
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say more of what is done
    #[arg(long, short, global = true)]
    verbose: bool,
}

impl Options {
    /// The answer to missing parts, as far as the flags give one.
    fn defaults(self) -> Defaults {
        match (self.use_defaults, self.no_defaults) {
            (true, _) => Defaults::Use,
            (_, true) => Defaults::Refuse,
            _ => Defaults::Ask,
        }
    }

    /// Tells of something that was done, unless the user wants quiet.
    fn tell(self, what: impl fmt::Display) {
        if !self.quiet {
            complain(what);
        }
    }

    /// Tells of a detail, if the user wants details.
    fn detail(self, what: impl fmt::Display) {
        if self.verbose {
            complain(what);
        }
    }
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Open the window (what `lcm` alone does too)
    View(view::Arguments),
    /// Render scenes to PNG files
    Render(render::Arguments),
    /// Check scenes and print everything that is wrong with them
    Check(check::Arguments),
    /// Write the default scene to a new file
    New {
        /// The file to write
        file: PathBuf,
    },
    /// List the reflection models with their laws and parameters, or write and check own ones
    Models(models::Arguments),
    /// Copy the built-in shaders and the example models to a folder, to edit them there
    #[command(subcommand)]
    Assets(assets::Command),
    /// Evaluate the BRDF of a model: angles from standard input, values to standard output, as CSV
    ///
    /// Reads the columns theta_i, phi_i, theta_o, phi_o: degrees from the normal and around it from the tangent, to
    /// the light (i) and to the observer (o). Writes them with f_r, f_g, f_b: the BRDF in 1/sr without the cosine,
    /// diffuse and specular; 0 beyond 90°.
    Evaluate(evaluate::Arguments),
    /// Compare Blinn–Phong with physically based models: four phenomena as a report with numbers
    Study(study::Arguments),
    /// Integrate a model: cosines of the view, `mu`, above 0 up to 1, from standard input, its directional
    /// albedos to standard output, as CSV; of an anisotropic model as seen along the tangent
    Albedo(evaluate::Arguments),
    /// Print the JSON Schema of scene files
    Schema,
    /// Try shaders for a window
    #[command(hide = true, name = crate::render::trial::process::COMMAND)]
    TryShaders,
}

/// What a command does.
type Outcome = Result<(), Failure>;

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            return match error.kind() {
                // Help and version are results; clap sends them to standard output.
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                    ended(error.print().and_then(|()| io::stdout().flush()).map_err(Failure::from))
                }
                _ => {
                    misunderstood(&error);
                    ExitCode::from(2)
                }
            };
        }
    };
    #[cfg(target_os = "linux")]
    if cli.may_draw() {
        runtime_folder::provide();
    }
    ended(run(cli))
}

/// Tells of a failure, and gives the exit status.
fn ended(outcome: Outcome) -> ExitCode {
    let Err(failure) = outcome else { return ExitCode::SUCCESS };
    match &failure {
        Failure::Closed => {}
        Failure::Usage(what) => complain(format_args!("error: {what}")),
        // The problems are told already, as a result.
        Failure::Invalid(what) if what.is_empty() => {}
        Failure::Invalid(what) | Failure::NoRenderer(what) | Failure::Write(what) => complain(what),
    }
    ExitCode::from(failure.status())
}

/// Tells of a mistake that clap found, in its colours unless it repeats what a terminal would obey.
fn misunderstood(error: &clap::Error) {
    let odd = std::env::args_os().any(|word| printable(&word.to_string_lossy()) != word.to_string_lossy());
    if odd {
        complain(error.render().to_string().trim_end());
    } else {
        // Nobody is left to tell if this fails.
        let _ = error.print();
    }
}

fn run(cli: Cli) -> Outcome {
    let options = cli.options;
    if let Some(stray) = cli.view.given().filter(|_| cli.command.is_some()) {
        return Err(Failure::Usage(format!("{stray} stands before the command; write it behind")));
    }
    let places = &cli.places;
    match cli.command {
        None => view::run(cli.view, options, places),
        Some(Command::View(arguments)) => view::run(arguments, options, places),
        Some(Command::Render(arguments)) => render::run(&arguments, options, &mut places.open(options)?),
        Some(Command::Check(arguments)) => check::run(&arguments, options, &mut places.open(options)?),
        Some(Command::New { file }) => new::run(&file, options, &Registry::builtin()),
        Some(Command::Models(arguments)) => models::run(arguments, options, places),
        Some(Command::Assets(command)) => assets::run(&command, options, &Registry::builtin()),
        Some(Command::Evaluate(arguments)) => evaluate::run(&arguments, &mut places.open(options)?),
        Some(Command::Study(arguments)) => study::run(&arguments, options, &Registry::builtin()),
        Some(Command::Albedo(arguments)) => albedo::run(&arguments, &mut places.open(options)?),
        Some(Command::TryShaders) => trial::run(),
        Some(Command::Schema) => print(&crate::scene::schema::text(places.open(options)?.list())),
    }
}

/// Writes a result for people to standard output, without what a terminal would obey.
fn print_text(text: &str) -> Outcome {
    print(&printable(text))
}

/// Writes paths to standard output, a line each: as they are for programs, fit to be shown for people.
fn print_paths<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Outcome {
    let lines: String = paths.into_iter().map(|path| format!("{}\n", path.display())).collect();
    if io::stdout().is_terminal() { print_text(&lines) } else { print(&lines) }
}

/// Writes a result for programs to standard output.
fn print(text: &str) -> Outcome {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    Ok(out.flush()?)
}

/// Writes a line to standard error, without what a terminal would obey. That nobody reads it is no reason to panic.
fn complain(what: impl fmt::Display) {
    let _ = writeln!(io::stderr().lock(), "{}", printable(&what.to_string()));
}

/// A bar of so many steps where it helps: several of them, a terminal, and nobody who wants quiet.
fn progress(steps: u64, options: Options) -> ProgressBar {
    if steps < 2 || options.quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    bar
}

/// Asks a yes-or-no question on the terminal; no terminal, no yes. Anything but y or yes is a no.
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
    fn the_declaration_of_the_command_line_is_sound() {
        Cli::command().debug_assert();
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
            assert!(cli.options.use_defaults && matches!(cli.command, Some(Command::Render(_))));
            assert_eq!(cli.view.given(), None);
        }
    }
}
