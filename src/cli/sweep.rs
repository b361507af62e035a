//! `lcm sweep`: pictures of a scene with some of its values varied, in a folder, on a sheet or in a film.

use std::path::{Path, PathBuf};

use clap::Args;
use glam::Vec3;

use super::{
    Options, Outcome, gauged,
    light_samples::{self, Sampling},
    outputs,
    render::{Size, cpu_can_draw, samples},
    scenes::Source,
    views::{self, Maps},
    workshop::{Workshop, drawable},
};
use crate::files::Shown as _;
use crate::{
    caption::{self, Sampled},
    export::write::inputs,
    failure::Failure,
    files::{self, Output},
    registry::Registry,
    render::capture::png::{self, About},
    scene::{Comparison, Scene},
    sweep::{self, Against, Axis, GIF, Grid, MAX_PIXELS, MAX_RATE, MAX_SIDE, Page, Parts, Settings, Sweep},
    text::{items, plural},
};

/// The usual size of a picture among others on a sheet.
const SMALL: Size = Size { width: 320, height: 180 };
/// The usual size of the pictures of a film.
const MIDDLE: Size = Size { width: 640, height: 360 };
/// The usual size of a picture in a folder.
const LARGE: Size = Size { width: 1280, height: 720 };

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file; `-` is standard input; without one, the default scene
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Vary a value of the scene: objects[0].material.roughness=0.1..0.9:5, lights[0].intensity=1..100:5:log,
    /// reflection_model=lambert,phong; can be repeated: the first makes the columns of a sheet, the second its rows
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
    #[arg(long, value_name = "RATE", default_value = "12", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_RATE)))]
    fps: u32,
    /// Size of each picture in pixels; by default 1280x720 in a folder, 640x360 in a film, and 320x180 among others
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Samples per pixel: 1, or 4 for smooth edges
    #[arg(long, default_value = "4", value_parser = samples)]
    samples: u32,
    #[command(flatten)]
    sampling: Sampling,
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
}

fn point(text: &str) -> Result<Vec3, String> {
    let all: Option<Vec<f32>> = items(text).into_iter().map(|(_, item)| item.parse().ok()).collect();
    let point = all.and_then(|all| <[f32; 3]>::try_from(all).ok()).map(Vec3::from);
    point.filter(|point| point.is_finite()).ok_or_else(|| "it must be three numbers, e.g. 5,5,5".to_owned())
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Folder,
    Sheet,
    Gif,
    Apng,
}

impl Form {
    /// The form of a result, by its name.
    fn of(output: &Path, film: bool) -> Result<Self, Failure> {
        let usage = |why: &str| Err(Failure::Usage(format!("-o {}: {why}", output.shown())));
        let extension = output.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let form = match extension.as_str() {
            _ if output.is_dir() => Self::Folder,
            "png" if film => Self::Apng,
            "png" => Self::Sheet,
            "apng" => Self::Apng,
            "gif" => Self::Gif,
            "webm" | "mp4" | "mkv" | "avi" | "mov" => {
                return usage(
                    "videos cannot be written; name a folder, and let a video encoder join its pictures",
                );
            }
            "jpg" | "jpeg" | "bmp" | "tif" | "tiff" | "webp" | "exr" | "hdr" | "svg" | "pdf" | "json" => {
                return usage("sheets are .png files, films .gif, .apng or .png files");
            }
            _ if output.exists() => return usage("this is a file, but pictures need a folder"),
            _ => Self::Folder,
        };
        match form {
            Self::Folder if film => usage("a film is one file: name a .png, .apng or .gif file"),
            form => Ok(form),
        }
    }

    fn is_film(self) -> bool {
        matches!(self, Self::Gif | Self::Apng)
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
    let source = Source::of(arguments.scene.as_deref(), workshop);
    let scene = source.open(workshop, options)?;
    let registry = &workshop.registry;
    let view =
        views::find(&scene, &arguments.view).map_err(|why| Failure::Usage(format!("--view: {why}")))?;
    let axes = axes(arguments, &scene, registry)?;
    let sweep = Sweep::new(&scene, view, axes, registry).map_err(Failure::Usage)?;
    let read = inputs(source.path(), [&scene], registry);
    let idle = arguments.sampling.idle(&scene, registry);
    idle.iter().for_each(|idle| options.tell(format_args!("{}: {idle}", source.name())));
    let job = Job { arguments, form, sweep: &sweep, source: &source, options };
    match form {
        Form::Folder => job.folder(&read),
        _ => job.file(&read),
    }
}

/// Options that do not suit what is written.
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
            arguments.against.is_none() && arguments.maps.is_given(),
            "--sign, --channel, --amplification",
            "need --against",
        ),
    ];
    match given.into_iter().find(|(wrong, ..)| *wrong) {
        Some((_, flag, why)) => Err(Failure::Usage(format!("{flag} {why}"))),
        None => Ok(()),
    }
}

/// What varies: values in their order, and then the motion.
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
    form: Form,
    sweep: &'a Sweep<'a>,
    source: &'a Source,
    options: Options,
}

impl Job<'_> {
    fn settings(&self, usual: Size) -> Settings {
        let Size { width, height } = self.arguments.size.unwrap_or(usual);
        Settings {
            size: [width, height],
            samples: self.arguments.samples,
            until: self.arguments.sampling.until(),
        }
    }

    /// Fails if a scene cannot be drawn by the CPU renderer.
    fn check(&self) -> impl Fn(&Scene) -> Outcome + Sync + use<'_> {
        let registry = self.sweep.registry;
        move |scene| drawable(registry, scene).and_then(|()| cpu_can_draw(scene, registry))
    }

    fn what(&self) -> String {
        format!("drawing {}", self.source.name())
    }

    fn folder(&self, read: &[PathBuf]) -> Outcome {
        let folder = &self.arguments.output;
        (0..self.sweep.count()).try_for_each(|i| outputs::picture(&folder.join(self.sweep.file(i)), read))?;
        files::tidy(folder).iter().for_each(super::complain);
        let (settings, check) = (self.settings(LARGE), self.check());
        let written = gauged(&self.what(), self.options, |progress| {
            sweep::files(self.sweep, &settings, folder, &check, progress)
        })?;
        let kept = kept(written.kept);
        self.options.tell(format_args!(
            "wrote {} into {}{kept}",
            plural(written.drawn, "picture"),
            folder.shown()
        ));
        Ok(())
    }

    /// Writes a sheet, or a film of sheets.
    fn file(&self, read: &[PathBuf]) -> Outcome {
        let Self { arguments, sweep, form, .. } = self;
        let output = &arguments.output;
        let format = if *form == Form::Gif { GIF } else { files::PNG };
        outputs::of_format(output, format, read)?;
        // Of a film, the last one is time.
        let beside = sweep.axes.len() - usize::from(form.is_film());
        let axes: Vec<&Axis> = sweep.axes[..beside].iter().collect();
        let counts: Vec<_> = axes.iter().map(|axis| axis.count()).collect();
        let columns = arguments.columns.map(|columns| columns as usize);
        let grid = Grid::of(&counts, columns).map_err(Failure::Usage)?;
        let each: usize = counts.iter().product();
        let settings = self.settings(if each > 1 { SMALL } else { MIDDLE });
        let against = self.against(&counts)?;
        let page = Page::new(&axes, grid, settings.size, against.is_some());
        let page = if arguments.no_labels { page.silent() } else { page };
        let time = sweep.axes.get(beside).filter(|time| !time.moves && !arguments.no_labels);
        let page = if time.is_some() { page.dated() } else { page };
        room(&page, settings.size, sweep.count())?;

        let parts = Parts::beside(output);
        let check = self.check();
        outputs::tidy_beside(output);
        let drawn = gauged(&self.what(), self.options, |progress| {
            sweep::pictures(sweep, &settings, Some(&parts), &check, progress)
        })
        .inspect_err(|_| self.tell_of_parts(&parts))?;
        let maps = match &against {
            Some(comparison) => {
                let column = arguments.against.unwrap_or(1) as usize - 1;
                let against = Against { column, comparison };
                sweep::maps(sweep, &drawn.pictures, settings.size, against)
                    .map_err(|error| Failure::Invalid(error.to_string()))?
            }
            None => Vec::new(),
        };
        let sheets: Vec<_> = drawn
            .pictures
            .chunks(each)
            .enumerate()
            .map(|(i, pictures)| {
                let maps = maps.get(i * each..(i + 1) * each).unwrap_or_default();
                page.compose(pictures, maps, time.map(|time| &time.labels[i]))
            })
            .collect();
        self.write(sheets, page.size(), &drawn.sampled).inspect_err(|_| self.tell_of_parts(&parts))?;
        parts.remove();
        let kept = kept(drawn.kept);
        self.options.tell(format_args!(
            "wrote {}: {}{kept}",
            output.shown(),
            plural(sweep.count(), "picture")
        ));
        Ok(())
    }

    /// Says where finished pictures are, if some are kept.
    fn tell_of_parts(&self, parts: &Parts) {
        if parts.folder().is_dir() {
            let folder = parts.folder().shown();
            self.options.tell(format_args!(
                "finished pictures are kept in {folder}; the same command goes on from them"
            ));
        }
    }

    /// How pictures are compared, if they are.
    fn against(&self, counts: &[usize]) -> Result<Option<Comparison>, Failure> {
        let Some(column) = self.arguments.against else { return Ok(None) };
        let columns = counts.first().copied().unwrap_or(1);
        if columns < 2 {
            let why =
                "there is only one column; vary one more value, before the one that a film shows in time";
            return Err(Failure::Usage(format!("--against: {why}")));
        }
        if column as usize > columns {
            return Err(Failure::Usage(format!(
                "--against is {column}, but it must be a column from 1 to {columns}"
            )));
        }
        Ok(Some(self.arguments.maps.applied(Comparison::default())))
    }

    /// Writes the pictures of a film, or the one of a sheet, with their caption.
    fn write(&self, sheets: Vec<Vec<u8>>, size: [u32; 2], sampled: &[Sampled]) -> Outcome {
        let Self { arguments, sweep, .. } = self;
        let output = &arguments.output;
        let caption = sweep.caption().resting_on(sampled);
        let (mut whole, mut all) = (size, Vec::with_capacity(sheets.len()));
        for sheet in sheets {
            if arguments.no_labels {
                all.push(sheet);
                continue;
            }
            let (sheet, size) = caption::draw(&caption, sheet, size);
            whole = size;
            all.push(sheet);
        }
        let about = About::scene(&sweep.scene.clone().alone(), sweep.registry)
            .with("Description", caption::line(&caption.facts))
            .with("Source", self.source.name())
            .with("Renderer", "CPU");
        let about = light_samples::noted(about, &caption::line(&caption::sampled(sampled)));
        let failed = |error: std::io::Error| {
            Failure::Write(format!("{} could not be written: {}", output.shown(), files::words(&error)))
        };
        match (self.form, all.as_slice()) {
            (Form::Gif, all) => {
                let bytes = sweep::gif(all, whole, arguments.fps).map_err(failed)?;
                files::in_folder(files::folder_of(output), || {
                    let mut to = Output::open(output)?;
                    std::io::Write::write_all(&mut to, &bytes)?;
                    Ok(to.finish()?)
                })
                .map_err(failed)
            }
            (Form::Apng, all) => png::write_film(output, whole, all, arguments.fps, &about).map_err(failed),
            (_, [sheet, ..]) => outputs::write_picture(output, whole, sheet, &about),
            (_, []) => Ok(()),
        }
    }
}

/// Fails if a sheet is too large for programs that show pictures, or all of them for memory.
fn room(page: &Page, [width, height]: [u32; 2], count: usize) -> Outcome {
    let [across, down] = page.size();
    if across.max(down) > MAX_SIDE {
        let said = format!(
            "the sheet would have {across}×{down} pixels, but each side must have at most {MAX_SIDE}"
        );
        return Err(Failure::Usage(format!("{said}; choose a smaller --size, or other --columns")));
    }
    let pixels = u64::from(width) * u64::from(height) * count as u64;
    if pixels > MAX_PIXELS {
        let said = format!("{count} pictures of {width}×{height} have {pixels} pixels");
        let rule = format!("those of a sheet or a film must have at most {MAX_PIXELS} together");
        return Err(Failure::Usage(format!("{said}, but {rule}; choose a smaller --size, or a folder")));
    }
    Ok(())
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
        assert_eq!(of("a/sheet.PNG", false), Ok(Form::Sheet));
        assert_eq!(
            (of("x.png", true), of("x.apng", false), of("x.gif", false)),
            (Ok(Form::Apng), Ok(Form::Apng), Ok(Form::Gif))
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
