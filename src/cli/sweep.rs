//! `lcm sweep`: pictures of a scene with some of its values varied, in a folder, on a sheet or in a film.

use std::{
    path::{Path, PathBuf},
    sync::Mutex,
};

use clap::Args;
use glam::Vec3;

use super::{
    Options, Outcome,
    changes::Changes,
    finite, gauged,
    light_samples::Sampling,
    outputs,
    render::{cpu_can_draw, samples},
    scenes::Source,
    sides,
    views::{self, Maps},
    workshop::{Workshop, drawable},
};
use crate::files::Shown as _;
use crate::{
    caught::lock,
    explain::finite::Tried,
    export::write::inputs,
    failure::Failure,
    files,
    registry::Registry,
    scene::{Comparison, Scene},
    sweep::{self, Axis, Format, Look, MAX_RATE, Parts, Plan, Settings, Sweep},
    text::{numbers, plural},
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file; `-` is standard input; without one, the default scene
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Vary a value of the scene, or its view: objects[0].material.roughness=0.1..0.9:5, lights[0].intensity=1..100:5:log,
    /// reflection_model=lambert,phong, view=A,B; can be repeated: the first makes the columns of a sheet, the second its rows;
    /// a single value is the same in all pictures
    #[arg(long, value_name = "PATH=VALUES")]
    vary: Vec<String>,
    /// Turn the observer about the middle of the objects, 360:24, or something else: lights[0]=360:24, objects[0]=360:24,
    /// lights=90:7, objects=360:24
    #[arg(long, value_name = "[WHAT=]DEGREES:COUNT", allow_hyphen_values = true)]
    turn: Option<String>,
    /// Move something through the room, at constant speed: lights[0]=[1,8,9]..[9,8,9]:12, with as many points as needed
    #[arg(long, value_name = "WHAT=POINT..POINT:COUNT", conflicts_with = "turn")]
    path: Option<String>,
    /// Let what --path moves look at this point all the way
    #[arg(long, value_name = "X,Y,Z", requires = "path", value_parser = point, allow_hyphen_values = true)]
    aim: Option<Vec3>,
    /// Where to write: x.png is a sheet; x.gif, x.apng, and x.png with --film are films; other names are folders of pictures
    #[arg(long, short, value_name = "FILE|FOLDER", required = true, value_parser = outputs::place())]
    output: PathBuf,
    /// Write an animated PNG: what varies last varies from picture to picture, and the rest makes columns and rows
    #[arg(long)]
    film: bool,
    /// Pictures of a film per second, 1 to 50
    #[arg(long, value_name = "RATE", default_value = "12", value_parser = rate)]
    fps: u32,
    /// Size of each picture in pixels; by default 1280x720 in a folder, 640x360 in a film, and 320x180 among others
    #[arg(long, value_name = "WxH", value_parser = sides)]
    size: Option<[u32; 2]>,
    /// Samples per pixel: 1, or 4 for smooth edges
    #[arg(long, default_value = "4", value_parser = samples)]
    samples: u32,
    #[command(flatten)]
    sampling: Sampling,
    #[command(flatten)]
    changes: Changes,
    /// Draw this view: A, B, C or D, or the name of a variant
    #[arg(long, value_name = "VIEW", default_value = "A")]
    view: String,
    /// Break the pictures of a single varied value into rows with so many
    #[arg(long, value_name = "COUNT", value_parser = super::above_zero)]
    columns: Option<u32>,
    /// Add the differences from the pictures of this column, as maps with numbers below the pictures; the first is 1
    #[arg(long, value_name = "COLUMN", value_parser = super::above_zero)]
    against: Option<u32>,
    #[command(flatten)]
    maps: Maps,
    /// Leave labels and caption out
    #[arg(long)]
    no_labels: bool,
    /// Replace pictures in the folder that this sweep did not write
    #[arg(long)]
    overwrite: bool,
}

fn point(text: &str) -> Result<Vec3, String> {
    let point = numbers(text).and_then(|all| <[f32; 3]>::try_from(all).ok()).map(Vec3::from);
    point.filter(|point| point.is_finite()).ok_or_else(|| "it must be three numbers, e.g. 5,5,5".to_owned())
}

fn rate(text: &str) -> Result<u32, String> {
    let rate = text.trim().parse().ok().filter(|rate| (1..=MAX_RATE).contains(rate));
    rate.ok_or_else(|| format!("it must be a whole number from 1 to {MAX_RATE}"))
}

/// The form of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Folder,
    File(Format),
}

impl Form {
    /// The form of a result, by its name.
    fn of(output: &Path, film: bool) -> Result<Self, Failure> {
        let usage = |why: &str| Err(Failure::Usage(format!("-o {}: {why}", output.shown())));
        let extension = output.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let form = match (Format::of(output), extension.as_str()) {
            _ if output.is_dir() => Self::Folder,
            (Some(Format::Sheet), _) if film => Self::File(Format::Apng),
            (Some(format), _) => Self::File(format),
            (_, "webm" | "mp4" | "mkv" | "avi" | "mov") => {
                return usage(
                    "videos cannot be written; name a folder, and let a video encoder join its pictures",
                );
            }
            (
                _,
                "jpg" | "jpeg" | "bmp" | "tif" | "tiff" | "webp" | "exr" | "hdr" | "svg" | "pdf" | "json",
            ) => return usage("sheets are .png files, films .gif, .apng or .png files"),
            _ if output.exists() => return usage("this is a file, but pictures need a folder"),
            _ => Self::Folder,
        };
        match form {
            Self::Folder if film => usage("a film is one file: name a .png, .apng or .gif file"),
            form => Ok(form),
        }
    }
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let form = Form::of(&arguments.output, arguments.film)?;
    fits(arguments, form)?;
    // Custom models are read when they are named.
    for (path, values) in arguments.vary.iter().filter_map(|vary| vary.split_once('=')) {
        if path.trim().ends_with("reflection_model") {
            values.split(',').for_each(|id| workshop.need(id.trim()));
        }
    }
    arguments.changes.check(workshop)?;
    let source = Source::of(arguments.scene.as_deref(), workshop);
    let scene = arguments.changes.open(&source, workshop, options)?;
    let registry = &workshop.registry;
    let view =
        views::find(&scene, &arguments.view).map_err(|why| Failure::Usage(format!("--view: {why}")))?;
    let axes = axes(arguments, &scene, registry)?;
    let sweep = Sweep::new(&scene, view, axes, registry).map_err(|why| {
        let turn = arguments.turn.as_deref();
        let instead = turn.and_then(|turn| sweep::instead_of_turn(turn, &scene, registry));
        Failure::Usage([Some(why), instead].into_iter().flatten().collect::<Vec<_>>().join("\n"))
    })?;
    sweep.remarks().iter().for_each(|remark| options.tell(format_args!("{}: {remark}", source.name())));
    let read = inputs(source.path(), [&scene], registry);
    let idle = arguments.sampling.idle(&scene, registry);
    idle.iter().for_each(|idle| options.tell(format_args!("{}: {idle}", source.name())));
    let job = Job { arguments, sweep: &sweep, source: &source, options, odd: Mutex::default() };
    match form {
        Form::Folder => job.folder(&read),
        Form::File(format) => job.file(format, &read),
    }
}

/// Options that do not suit the form of the output.
fn fits(arguments: &Arguments, form: Form) -> Outcome {
    let folder = form == Form::Folder;
    let given = [
        (folder && arguments.against.is_some(), "--against", "compares pictures on a sheet or in a film"),
        (folder && arguments.columns.is_some(), "--columns", "arranges pictures on a sheet or in a film"),
        (
            folder && arguments.no_labels,
            "--no-labels",
            "is for sheets and films; pictures in a folder have no labels",
        ),
        (
            !folder && arguments.overwrite,
            "--overwrite",
            "is for folders; a sheet or a film replaces a file of its format anyway",
        ),
        (
            arguments.against.is_none() && arguments.maps.is_given(),
            "--sign, --channel, --amplification",
            "need --against",
        ),
    ];
    if let Some((_, flag, why)) = given.into_iter().find(|(wrong, ..)| *wrong) {
        return Err(Failure::Usage(format!("{flag} {why}")));
    }
    let varied: Vec<_> = arguments.vary.iter().filter_map(|vary| vary.split_once('=')).collect();
    let both = |path: &str| varied.iter().any(|(varied, _)| varied.trim() == path);
    match arguments.changes.given().find(|(_, path)| both(path)) {
        Some((flag, path)) => Err(Failure::Usage(format!(
            "{flag} sets {path}, but --vary {path}=… does so, too; leave one out"
        ))),
        None => Ok(()),
    }
}

/// The axes: values in their order, and then the motion.
fn axes(arguments: &Arguments, scene: &Scene, registry: &Registry) -> Result<Vec<Axis>, Failure> {
    let usage = |flag: &'static str| move |why: String| Failure::Usage(format!("--{flag}: {why}"));
    let vary = arguments.vary.iter().map(|text| Axis::vary(text, scene, registry).map_err(usage("vary")));
    let mut axes = vary.collect::<Result<Vec<_>, _>>()?;
    if let Some(text) = &arguments.turn {
        axes.push(Axis::turn(text, scene, registry).map_err(usage("turn"))?);
    }
    if let Some(text) = &arguments.path {
        axes.push(Axis::path(text, arguments.aim, scene, registry).map_err(usage("path"))?);
    }
    Ok(axes)
}

/// A sweep to write.
struct Job<'a> {
    arguments: &'a Arguments,
    sweep: &'a Sweep<'a>,
    source: &'a Source,
    options: Options,
    odd: Mutex<Odd>,
}

/// What was found of light that is not finite: the surfaces that were tried, and the first remark.
#[derive(Default)]
struct Odd(Tried, Option<String>);

impl Job<'_> {
    fn settings(&self) -> Settings {
        let Arguments { size, samples, sampling, .. } = self.arguments;
        let usual = Settings::default();
        Settings { size: size.unwrap_or(usual.size), samples: *samples, until: sampling.until() }
    }

    /// Fails if a scene cannot be drawn by the CPU renderer.
    fn check(&self) -> impl Fn(&Scene) -> Outcome + Sync + use<'_> {
        let registry = self.sweep.registry;
        move |scene| {
            drawable(registry, scene).and_then(|()| cpu_can_draw(scene, registry))?;
            let Odd(tried, first) = &mut *lock(&self.odd);
            if first.is_none() {
                *first = finite::remark_on_scene(scene, registry, tried);
            }
            Ok(())
        }
    }

    /// Says that the light of a picture is not finite.
    fn say_odd(&self) {
        if let Odd(_, Some(remark)) = &*lock(&self.odd) {
            self.options.tell(format_args!("{}: {remark}", self.source.name()));
        }
    }

    fn what(&self) -> String {
        format!("drawing {}", self.source.name())
    }

    fn folder(&self, read: &[PathBuf]) -> Outcome {
        let folder = &self.arguments.output;
        let file = |i| folder.join(self.sweep.file(i));
        (0..self.sweep.count()).try_for_each(|i| outputs::replaces_nothing(&file(i), files::PNG, read))?;
        outputs::can_begin(&file(0))?;
        let (settings, check) = (self.settings(), self.check());
        files::tidy(folder).iter().for_each(super::complain);
        let written = gauged(&self.what(), self.options, |progress| {
            let into = (folder.as_path(), self.arguments.overwrite);
            sweep::files(self.sweep, &settings, into, &check, progress)
        })?;
        self.say_odd();
        let kept = kept(written.kept);
        self.options.tell(format_args!(
            "wrote {} into {}{kept}",
            plural(written.drawn, "picture"),
            folder.shown()
        ));
        self.strangers(folder);
        Ok(())
    }

    /// Says that the folder has pictures of something else, such as of another sweep, which nobody should take for these.
    fn strangers(&self, folder: &Path) {
        let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
        match self.sweep.strangers(names) {
            0 => {}
            n => self.options.tell(format_args!(
                "{} has {} that this sweep did not write",
                folder.shown(),
                plural(n, "more picture")
            )),
        }
    }

    /// Writes a sheet, or a film of sheets.
    fn file(&self, format: Format, read: &[PathBuf]) -> Outcome {
        let Self { arguments, sweep, options, .. } = self;
        let output = &arguments.output;
        outputs::of_format(output, format.signature(), read)?;
        let compared = arguments.maps.applied(Comparison::default());
        let look = Look {
            format,
            size: arguments.size,
            columns: arguments.columns.map(|columns| columns as usize),
            against: arguments.against.map(|column| (column as usize - 1, compared)),
            words: !arguments.no_labels,
            rate: arguments.fps,
        };
        let plan = Plan::new(sweep, look, self.settings()).map_err(Failure::Usage)?;
        outputs::tidy_beside(output);
        let check = self.check();
        let written = gauged(&self.what(), *options, |progress| {
            plan.write(output, &self.source.name(), &check, progress)
        });
        self.say_odd();
        let parts = Parts::beside(output);
        if written.is_err() && parts.folder().is_dir() {
            let folder = parts.folder().shown();
            options.tell(format_args!(
                "finished pictures are kept in {folder}; the same command goes on from them"
            ));
        }
        let kept = kept(written?);
        options.tell(format_args!("wrote {}: {}{kept}", output.shown(), plural(sweep.count(), "picture")));
        Ok(())
    }
}

/// The end of a message about pictures that were there already.
fn kept(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => "; 1 was there already".to_owned(),
        n => format!("; {n} were there already"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_says_what_is_written() {
        let of = |name: &str, film| match Form::of(Path::new(name), film) {
            Ok(form) => Ok(form),
            Err(Failure::Usage(why)) => Err(why),
            Err(other) => panic!("{other}"),
        };
        assert_eq!(of("a/sheet.PNG", false), Ok(Form::File(Format::Sheet)));
        assert_eq!(
            (of("x.png", true), of("x.apng", false), of("x.gif", false)),
            (Ok(Form::File(Format::Apng)), Ok(Form::File(Format::Apng)), Ok(Form::File(Format::Gif)))
        );
        assert_eq!((of("pictures", false), of("v1.2", false)), (Ok(Form::Folder), Ok(Form::Folder)));
        assert!(of("x.webm", false).is_err_and(|why| why.contains("name a folder, and let a video encoder")));
        assert!(of("x.jpg", false).is_err_and(|why| why.contains("sheets are .png files")));
        assert!(of("pictures", true).is_err_and(|why| why.contains("a film is one file")));
        assert!(of("Cargo", false).is_ok());
    }

    #[test]
    fn a_point_is_three_numbers() {
        assert_eq!(point("1, 2.5,-3"), Ok(Vec3::new(1.0, 2.5, -3.0)));
        assert!(point("1,2").is_err() && point("1,2,x").is_err() && point("1,2,inf").is_err());
    }
}
