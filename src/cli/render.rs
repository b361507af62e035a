//! `lcm render`: scenes to PNG files, and to OpenEXR and Radiance files with linear light.

use std::{
    collections::{BTreeSet, HashMap},
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Duration,
};

use clap::{Args, ValueEnum};

use super::{
    FINE, Options, Outcome,
    changes::Changes,
    check::of_glass,
    collected,
    engine::{ENGINE, Order, Pictures, engine},
    finite::{self, has_untested},
    gauged,
    light_samples::{self, Sampling},
    linear::{self, Kinds},
    name_step, one_of, outputs, progress,
    scenes::Source,
    sides, style,
    views::{self, Part, Plan, word},
    workshop::{Workshop, drawable, not_on_cpu},
};
use crate::files::Shown as _;
use crate::{
    caption::{self, Sampled},
    channel::{DebugChannel, Layer, LayerKind, Legend, Setting, layers, too_large},
    compare::{self, Cell, Shown, View, compose, metric, with_legends, with_row_labels},
    export::write::inputs,
    failure::Failure,
    files::{PNG, printable},
    linear::{Channels, Format, MAX_PIXELS},
    optics::TermSelection,
    picture::png::About,
    program::HAS_WINDOW,
    progress::{Progress, named},
    reference::{self, MAX_SIDE, Reached},
    registry::Registry,
    scene::{Comparison, Scene, comparison::Layout, variant::LETTERS},
    text::{listed, quoted},
};

/// Maximum number of lights listed one by one.
const MOST_LISTED: usize = 16;
/// Interval between updates of the progress bar for several pictures.
const TICK: Duration = Duration::from_millis(200);
/// Default folder for pictures (CA `RENDERS_DIR`).
const RENDERS_DIR: &str = "renders";
/// The hint given without the GPU renderer.
const WITH_CPU: &str = "there is no GPU renderer; use --renderer cpu";

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene files; `-` is standard input; without any, the default scene
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// PNG file, OpenEXR file (.exr) or Radiance file (.hdr) with linear light, or folder for the pictures of several
    /// scenes; by default the folder renders
    #[arg(long, short, value_name = "FILE|FOLDER", value_parser = outputs::place())]
    output: Option<PathBuf>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = sides, default_value = "1280x720")]
    size: [u32; 2],
    /// Render on the GPU or on the CPU
    #[arg(long, value_enum, default_value_t = Renderer::Auto)]
    renderer: Renderer,
    /// Samples per pixel: 1, or 4 for smooth edges
    #[arg(long, default_value = "4", value_parser = samples)]
    samples: u32,
    #[command(flatten)]
    sampling: Sampling,
    #[command(flatten)]
    changes: Changes,
    /// Show only one term of the reflection model's equation
    #[arg(long, value_parser = term, default_value = "all", value_name = "all|ambient|diffuse|specular|transmitted")]
    term: TermSelection,
    #[arg(long, value_parser = channel, value_name = "NAME", help = format!(
        "Show a debug channel with its legend instead of the picture: {}",
        listed(&DebugChannel::ALL.map(DebugChannel::id), "or")
    ))]
    channel: Option<DebugChannel>,
    /// The light of the channel, by its name or its number in the scene; by default the brightest one
    #[arg(long, value_name = "LIGHT", requires = "channel")]
    light: Option<String>,
    /// Leave the legend of the channel out
    #[arg(long, requires = "channel")]
    no_legend: bool,
    #[arg(long, value_name = "LAYERS", value_parser = linear::kinds, help = linear::help())]
    layers: Option<Kinds>,
    /// Add a strip below the picture that says what it shows; the height of the strip is added to that of --size
    #[arg(long)]
    caption: bool,
    #[arg(long, requires = "caption", help = format!(
        "Add the numbers of the difference between view A and the others to the caption: {}",
        metric::names_in_window().join(", "),
    ))]
    numbers: bool,
    /// Draw this view alone: A, B, C or D, or the name of a variant
    #[arg(long, value_name = "VIEW", conflicts_with = "layout")]
    view: Option<String>,
    /// Arrange the views so, instead of as the scene says: single, side_by_side, wipe, difference or blink
    #[arg(long, value_parser = |text: &str| word::<Layout>(text, Comparison::layout))]
    layout: Option<Layout>,
    /// Leave the scene out of the picture's file: lcm cannot open the picture then
    #[arg(long)]
    no_scene: bool,
}

impl Arguments {
    /// The kinds of layers beside the picture.
    fn kinds(&self) -> &[LayerKind] {
        self.layers.as_ref().map_or(&[][..], |kinds| &kinds.0)
    }
}

#[cfg(target_os = "linux")]
impl Arguments {
    /// True if the command loads a graphics driver, to draw with it or to query it.
    pub(super) fn loads_driver(&self) -> bool {
        match self.renderer {
            Renderer::Auto => ENGINE.is_some_and(|engine| (engine.may_have_gpu)()),
            Renderer::Gpu => true,
            Renderer::Cpu => false,
        }
    }
}

/// The choice of renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Renderer {
    /// A hardware GPU if there is one, otherwise the CPU
    Auto,
    /// The GPU, software Vulkan included
    Gpu,
    /// The program's own CPU renderer; needs no driver
    Cpu,
}

pub(super) fn samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err("it must be 1 or 4".to_owned()),
    }
}

pub(super) fn term(text: &str) -> Result<TermSelection, String> {
    TermSelection::from_id(text).ok_or_else(|| one_of("it", text, &TermSelection::ALL.map(TermSelection::id)))
}

fn channel(text: &str) -> Result<DebugChannel, String> {
    DebugChannel::from_id(text).ok_or_else(|| one_of("it", text, &DebugChannel::ALL.map(DebugChannel::id)))
}

/// The index of a light in a scene, from its name or number.
fn light(scene: &Scene, name: &str) -> Result<usize, String> {
    let named = scene.lights.iter().position(|light| light.name.as_deref() == Some(name));
    let numbered =
        || name.parse().ok().filter(|n| (1..=scene.lights.len()).contains(n)).map(|n: usize| n - 1);
    let Some(place) = named.or_else(numbered) else {
        let known = scene.lights.iter().enumerate().map(|(i, light)| match &light.name {
            Some(name) => format!("{} ({})", i + 1, quoted(name)),
            None => (i + 1).to_string(),
        });
        let known: Vec<_> = known.take(MOST_LISTED).collect();
        let rule = match scene.lights.len() {
            0 => "the scene has no lights".to_owned(),
            count if count > MOST_LISTED => format!("it must be a name or a number from 1 to {count}"),
            _ => format!("it must be {}", listed(&known, "or")),
        };
        return Err(format!("there is no light {}; {rule}", quoted(name)));
    };
    if !scene.lights[place].enabled {
        return Err(format!("the light {} is switched off", quoted(name)));
    }
    Ok(place)
}

/// One picture to render.
struct Job<'a> {
    arguments: &'a Arguments,
    /// The scene in the picture.
    scene: &'a Scene,
    plan: &'a Plan,
    source: &'a Source,
    file: &'a Path,
    /// The debug channel shown instead of the picture.
    channel: Option<Setting>,
}

impl Job<'_> {
    /// The layers of a linear picture.
    fn layers(&self, part: &Part, registry: &Registry) -> Vec<Layer> {
        layers(&part.scene, part.terms, self.arguments.kinds(), registry)
    }

    /// The metadata of the picture.
    fn about(&self, renderer: &str, light: &str, registry: &Registry) -> About {
        let about = About::scene(&pictured(self), registry)
            .with("Source", self.source.name())
            .with("Renderer", renderer);
        let about = self.channel.into_iter().fold(about, |about, s| about.with("Channel", s.channel.id()));
        let about = light_samples::noted(about, light);
        if self.arguments.no_scene { about.without_scene() } else { about }
    }

    /// A view of the picture, for the GPU.
    fn order<'a>(&'a self, part: &'a Part, registry: &'a Registry) -> Order<'a> {
        let Arguments { samples, sampling, .. } = *self.arguments;
        Order { part, samples, until: sampling.until(), registry, file: self.file }
    }

    /// True if what is shown of a scene depends on samples of lights with extent.
    fn converges(&self, scene: &Scene, registry: &Registry) -> bool {
        self.channel.is_none_or(|setting| setting.channel.rests_on_samples())
            && scene.rests_on_samples(registry)
    }
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let sources: Vec<_> = match arguments.scenes.as_slice() {
        [] => vec![Source::of(None, workshop)],
        scenes => scenes.iter().map(|s| Source::named(s)).collect(),
    };
    if sources.iter().filter(|s| **s == Source::Stdin).count() > 1 {
        return Err(Failure::Usage("- can be given only once: standard input holds one scene".to_owned()));
    }
    arguments.changes.check(workshop)?;
    let files = files(&sources, arguments.output.as_deref())?;
    files.iter().try_for_each(|file| fits(arguments, file))?;
    let linear = files.iter().any(|file| Format::of(file).is_some());
    let renderer = renderer(arguments, linear)?;

    // All scenes are read before the first is rendered, so that errors in the last one appear at once.
    let scenes = collected(sources.iter().map(|source| arguments.changes.open(source, workshop, options)))?;

    let registry = &workshop.registry;
    let size = arguments.size;
    let plans = collected(scenes.iter().zip(&sources).map(|(scene, source)| {
        plan(scene, arguments, size, registry).map_err(|failure| match failure {
            Failure::Invalid(why) => Failure::Invalid(format!("{}: {why}", source.name())),
            other => other,
        })
    }))?;
    for ((plan, source), file) in plans.iter().zip(&sources).zip(&files) {
        holds(arguments, plan, file, registry)
            .and_then(|()| compares(arguments, plan))
            .map_err(|why| Failure::Invalid(format!("{}: {why}", source.name())))?;
    }
    // By now the registry knows the files of models and shaders.
    let read = inputs(sources.iter().filter_map(Source::path), &scenes, registry);
    for file in &files {
        let format = Format::of(file).map_or(PNG, Format::signature);
        outputs::of_format(file, format, &read)?;
    }
    for part in plans.iter().flat_map(|plan| &plan.parts) {
        drawable(registry, &part.scene)?;
    }
    for (scene, source) in scenes.iter().zip(&sources) {
        of_glass(scene, &source.name(), registry).into_iter().for_each(|line| options.tell(line));
    }
    // All files are in a single folder.
    files.first().into_iter().for_each(|file| outputs::tidy_beside(file));
    if arguments.sampling.given().is_some() {
        for (source, plan) in sources.iter().zip(&plans) {
            // Views have the lights of their scene.
            let idle = plan.parts.first().and_then(|part| arguments.sampling.idle(&part.scene, registry));
            idle.iter().for_each(|idle| options.tell(format_args!("{}: {idle}", source.name())));
        }
    }
    let count = scenes.len() as u64;
    let bar = progress(if count > 1 { count * FINE } else { 0 }, options);
    if !bar.is_hidden() {
        bar.set_style(style("{bar:30} {percent} % {msg}, {time}"));
        bar.enable_steady_tick(TICK);
    }
    let mut painter = Painter::new(renderer, options.trial_program())?;
    // A model that only a GPU can draw needs a driver after all. A scene from standard input cannot be read
    // twice.
    #[cfg(target_os = "linux")]
    if !sources.contains(&Source::Stdin) && plans.iter().any(|plan| painter.takes_gpu(plan, registry)) {
        super::runtime_folder::provide();
    }
    let by_cpu = plans.iter().filter(|plan| !painter.takes_gpu(plan, registry));
    let passed: BTreeSet<_> = by_cpu
        .flat_map(|plan| &plan.parts)
        .flat_map(|part| reference::ignored_edits(registry, &part.scene))
        .collect();
    if !passed.is_empty() {
        let passed = listed(&passed.iter().map(String::as_str).collect::<Vec<_>>(), "and");
        let remedy =
            if HAS_WINDOW { "--renderer gpu uses the edits" } else { "a program with the window uses them" };
        options.tell(format!("the CPU renderer ignores the edited {passed}; {remedy}"));
    }
    let channels = collected(scenes.iter().zip(&plans).zip(&sources).map(|((scene, plan), source)| {
        let invalid = |why| Failure::Invalid(format!("{}: {why}", source.name()));
        setting(scene, plan, arguments, registry).map_err(invalid)
    }))?;
    let jobs = scenes.iter().zip(&plans).zip(channels).zip(&sources).zip(&files);
    for (done, ((((scene, plan), channel), source), file)) in (0u64..).zip(jobs) {
        let job = Job { arguments, scene, plan, source, file, channel };
        let Painted { remarks, light } = if bar.is_hidden() {
            let what = format!("drawing {}", source.name());
            gauged(&what, options, |progress| painter.draw(&job, registry, progress))?
        } else {
            let what = format!("{} of {count}, {}", done + 1, source.name());
            let begin = done * FINE;
            let tell = |done: f32, step: &str| {
                name_step(&bar, &what, step);
                bar.set_position(begin + (done * FINE as f32) as u64);
            };
            tell(0.0, "");
            painter.draw(&job, registry, &Progress { tell: &tell, cancelled: &|| false })?
        };
        remarks.iter().for_each(|remark| options.tell(format_args!("{}: {remark}", source.name())));
        let light = if light.is_empty() { light } else { format!(": {light}") };
        let wrote = format!("wrote {}{light}", file.shown());
        if bar.is_hidden() {
            options.tell(wrote);
        } else {
            bar.println(printable(&wrote));
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// Fails if an option does not suit the format of the picture.
fn fits(arguments: &Arguments, file: &Path) -> Outcome {
    let usage = |why: String| Err(Failure::Usage(why));
    let (name, png) = (file.shown(), file.with_extension("png"));
    let [width, height] = arguments.size;
    let Some(format) = Format::of(file) else {
        if arguments.layers.is_some() {
            return usage("--layers needs an OpenEXR file, e.g. -o room.exr".to_owned());
        }
        let rows = if arguments.caption { caption::most_rows(arguments.size) } else { 0 };
        return match height + rows > MAX_SIDE {
            true => usage(format!(
                "{width}x{height} with a caption of up to {rows} rows is too high: a picture has at most {MAX_SIDE} rows; \
                 choose a smaller --size"
            )),
            false => Ok(()),
        };
    };
    if format == Format::Hdr && arguments.layers.is_some() {
        let exr = file.with_extension(Format::Exr.extension());
        return usage(format!("{name} cannot hold --layers; -o {} can", exr.shown()));
    }
    let png = png.shown();
    if arguments.channel.is_some() {
        let layers = "--layers normals, face_normals or depth adds numbers to an OpenEXR file";
        return usage(format!(
            "--channel draws display codes, but {name} holds light; use -o {png}, or {layers}"
        ));
    }
    if arguments.caption {
        return usage(format!("--caption draws display codes, but {name} holds light; use -o {png}"));
    }
    if width as usize * height as usize > MAX_PIXELS {
        return usage(format!(
            "{width}x{height} are more pixels than {name} can hold; at most {MAX_PIXELS} are possible"
        ));
    }
    Ok(())
}

/// The reason why a linear picture cannot hold the requested content.
fn holds(arguments: &Arguments, plan: &Plan, file: &Path, registry: &Registry) -> Result<(), String> {
    let Some(format) = Format::of(file) else { return Ok(()) };
    let [part] = plan.parts.as_slice() else {
        let count = plan.parts.len();
        let name = file.shown();
        return Err(format!(
            "{name} holds the light of one view, but the scene shows {count}; --view A draws one alone"
        ));
    };
    let [width, height] = arguments.size;
    let layers = layers(&part.scene, part.terms, arguments.kinds(), registry);
    match too_large(&layers, format, [width, height]) {
        Some(why) => Err(format!("{}: {why}; choose fewer --layers or a smaller --size", file.shown())),
        None => Ok(()),
    }
}

/// The reason why there are no numbers for the caption.
fn compares(arguments: &Arguments, plan: &Plan) -> Result<(), String> {
    if !arguments.numbers || plan.parts.len() > 1 {
        return Ok(());
    }
    let rule = "it needs a scene with variants, and --layout side_by_side, wipe or difference";
    Err(format!("--numbers compares views, but the picture shows one; {rule}"))
}

/// The requested renderer of pictures, linear or not. With a number of samples or a noise it is the CPU's, unless the GPU's is
/// asked for.
fn renderer(arguments: &Arguments, linear: bool) -> Result<Renderer, Failure> {
    let Some(given) = arguments.sampling.given() else { return Ok(arguments.renderer) };
    if let Some(channel) = arguments.channel.filter(|channel| !channel.rests_on_samples()) {
        let known = DebugChannel::ALL.into_iter().filter(|known| known.rests_on_samples());
        let known: Vec<_> = known.map(DebugChannel::id).collect();
        let said = format!("{given} cannot be used with --channel {}", channel.id());
        let rule = format!("channels that do are {}", listed(&known, "and"));
        return Err(Failure::Usage(format!("{said}, which does not depend on light samples; {rule}")));
    }
    match arguments.renderer {
        Renderer::Gpu => arguments.sampling.fits_gpu(linear).map(|()| Renderer::Gpu).map_err(Failure::Usage),
        Renderer::Auto | Renderer::Cpu => Ok(Renderer::Cpu),
    }
}

/// The result of drawing a picture.
struct Painted {
    /// Remarks on light that is not finite, or noisier than requested.
    remarks: Vec<String>,
    /// A description of the sampling of lights with extent; often empty.
    light: String,
}

/// A view as drawn.
struct Drawn {
    shown: Shown,
    /// The convergence of lights with extent; `None` without them.
    reached: Option<Reached>,
    /// Remarks on light that is not finite, or noisier than was asked for.
    remarks: Vec<String>,
}

/// Renders pictures, one after the other, with the chosen renderer.
struct Painter {
    renderer: Renderer,
    gpu: bool,
    /// The program that tries shaders in a separate process.
    trial_program: Option<PathBuf>,
    /// The GPU renderer, once it has drawn.
    pictures: Option<Box<dyn Pictures>>,
}

impl Painter {
    fn new(renderer: Renderer, trial_program: Option<PathBuf>) -> Result<Self, Failure> {
        let gpu = match renderer {
            Renderer::Cpu => false,
            Renderer::Gpu => {
                (engine(WITH_CPU)?.find_adapter)()?;
                true
            }
            // Querying the driver takes longer than rendering a picture; the device nodes reveal at once that
            // there is no GPU.
            Renderer::Auto => ENGINE.is_some_and(|engine| {
                (engine.may_have_gpu)() && (engine.find_adapter)().is_ok_and(|hardware| hardware)
            }),
        };
        Ok(Self { renderer, gpu, trial_program, pictures: None })
    }

    /// The GPU renderer.
    fn pictures(&mut self) -> Result<&mut dyn Pictures, Failure> {
        let pictures = match self.pictures.take() {
            Some(known) => known,
            None => (engine(WITH_CPU)?.pictures)(self.trial_program.clone()),
        };
        Ok(self.pictures.insert(pictures).as_mut())
    }

    /// True if the GPU renders the views of a picture.
    fn takes_gpu(&self, plan: &Plan, registry: &Registry) -> bool {
        match self.renderer {
            Renderer::Auto if ENGINE.is_none() => false,
            Renderer::Auto => {
                let cpu = plan.parts.iter().all(|part| cpu_can_draw(&part.scene, registry).is_ok());
                !cpu || self.gpu && !plan.needs_light()
            }
            Renderer::Gpu | Renderer::Cpu => self.gpu,
        }
    }

    /// Renders one picture.
    fn draw(&mut self, job: &Job, registry: &Registry, progress: &Progress) -> Result<Painted, Failure> {
        if let (Some(format), [part]) = (Format::of(job.file), job.plan.parts.as_slice()) {
            return self.draw_linear(job, (part, format), registry, progress);
        }
        let gpu = self.takes_gpu(job.plan, registry);
        if gpu && job.plan.needs_light() {
            return Err(Failure::NoRenderer(format!(
                "{}: the GPU renderer cannot draw the difference in linear light; use --renderer cpu, or compare display codes",
                job.source.name()
            )));
        }
        let count = job.plan.parts.len();
        let mut all: Vec<Shown> = Vec::with_capacity(count);
        let (mut remarks, mut rests_on) = (Vec::new(), Vec::new());
        for (i, part) in job.plan.parts.iter().enumerate() {
            let name = |step: &str| {
                let letter = LETTERS.get(part.cell.view).filter(|_| count > 1);
                letter.map_or_else(|| step.to_owned(), |letter| named(&format!("view {letter}"), step))
            };
            let Drawn { shown, reached, remarks: of_part } = match gpu {
                true => {
                    progress.part((i, count), name, |progress| self.on_gpu(job, part, registry, progress))?
                }
                false => progress.part((i, count), name, |progress| on_cpu(job, part, registry, progress))?,
            };
            let shown = match job.arguments.numbers {
                true => {
                    let alike =
                        |(_, other): &(&Shown, &Part)| reference::covers_alike(&other.scene, &part.scene);
                    let known = all.iter().zip(&job.plan.parts).find(alike);
                    let shown = match known {
                        Some((known, _)) => shown.covering_like(known),
                        None => shown,
                    };
                    shown.covering_objects(&part.scene, registry, job.arguments.samples)
                }
                false => shown,
            };
            let outlined = all.is_empty() && job.plan.is_map();
            all.push(if outlined { shown.outlined(&part.scene, registry) } else { shown });
            remarks.extend(of_part);
            rests_on.extend(reached);
        }
        let mut shown = all;
        let light = caption::line(&caption::sampled(&rests_on));
        let views: Vec<_> = job.plan.parts.iter().map(|part| part.cell.view).collect();
        let numbers = if job.arguments.numbers { compare::numbers(&views, &shown) } else { Vec::new() };
        let rgb8 = match shown.pop() {
            Some(only) if shown.is_empty() => only.into_rgb8(),
            last => {
                shown.extend(last);
                compose(&job.plan.comparison, job.arguments.size, &shown)
                    .map_err(|error| Failure::Invalid(format!("{}: {error}", job.source.name())))?
            }
        };
        let rgb8 = match job.channel.filter(|_| !job.arguments.no_legend) {
            Some(channel) => with_legends(
                &job.plan.comparison,
                rgb8,
                job.arguments.size,
                &legends(job.plan, channel, registry),
            ),
            None => rgb8,
        };
        let views = job.plan.parts.iter().map(|part| (part.cell, &part.scene));
        let rgb8 = with_row_labels(rgb8, job.arguments.size, views, registry);
        let about = job.about(renderer_name(gpu), &light, registry);
        let (rgb8, size) = captioned(job, registry, rgb8, (&rests_on, numbers));
        outputs::write_picture(job.file, size, &rgb8, &about)?;
        Ok(Painted { remarks, light })
    }

    fn on_gpu(
        &mut self,
        job: &Job,
        part: &Part,
        registry: &Registry,
        progress: &Progress,
    ) -> Result<Drawn, Failure> {
        let order = job.order(part, registry);
        let (shown, reached, odd) = self.pictures()?.draw(&order, job.channel, progress)?;
        let reached = job.converges(&part.scene, registry).then_some(reached);
        let noisy = reached.and_then(|reached| job.arguments.sampling.remark(reached));
        Ok(Drawn { shown, reached, remarks: odd.into_iter().chain(noisy).collect() })
    }

    fn layers_on_gpu(
        &mut self,
        job: &Job,
        part: &Part,
        layers: &[Layer],
        registry: &Registry,
        progress: &Progress,
    ) -> Result<(Channels, Option<Reached>, Vec<String>), Failure> {
        let (channels, remark) = self.pictures()?.layers(&job.order(part, registry), layers, progress)?;
        let reached = part
            .scene
            .rests_on_samples(registry)
            .then_some(Reached { samples: job.arguments.sampling.until().samples, noise: None });
        Ok((channels, reached, remark.into_iter().collect()))
    }

    /// Renders a linear picture with its layers.
    fn draw_linear(
        &mut self,
        job: &Job,
        (part, format): (&Part, Format),
        registry: &Registry,
        progress: &Progress,
    ) -> Result<Painted, Failure> {
        let gpu = self.takes_gpu(job.plan, registry);
        let layers = job.layers(part, registry);
        let (channels, reached, remarks) = match gpu {
            true => self.layers_on_gpu(job, part, &layers, registry, progress)?,
            false => layers_on_cpu(job, part, &layers, registry, progress)?,
        };
        let light = caption::line(&caption::sampled(reached.as_slice()));
        let about = job.about(renderer_name(gpu), &light, registry);
        outputs::write_linear(job.file, format, &channels, &about)?;
        Ok(Painted { remarks, light })
    }
}

/// The name of a renderer in the metadata of pictures.
fn renderer_name(gpu: bool) -> &'static str {
    if gpu { "GPU" } else { "CPU" }
}

/// Fails if the CPU renderer cannot draw a part of a picture.
fn can_draw(job: &Job, part: &Part, registry: &Registry) -> Outcome {
    let sampling = job.arguments.sampling;
    let fits = sampling.fits_gpu(Format::of(job.file).is_some()).is_ok();
    let without =
        sampling.given().filter(|_| !fits).map_or_else(String::new, |given| format!(" without {given}"));
    cpu_can_draw_or(&part.scene, registry, &format!("--renderer gpu{without}"))
}

fn layers_on_cpu(
    job: &Job,
    part: &Part,
    layers: &[Layer],
    registry: &Registry,
    progress: &Progress,
) -> Result<(Channels, Option<Reached>, Vec<String>), Failure> {
    can_draw(job, part, registry)?;
    let Cell { width, height, .. } = part.cell;
    let settings = reference::Settings { width, height, samples: job.arguments.samples, terms: part.terms };
    // Each layer has a channel for each of its colours.
    compare::Undrawn::check_light([width, height], 12 * layers.len())
        .map_err(|undrawn| Failure::Invalid(undrawn.to_string()))?;
    let odd = AtomicBool::new(false);
    let until = job.arguments.sampling.until();
    let (channels, end) =
        reference::render_layers(layers, &part.scene, registry, &settings, until, &odd, progress)
            .map_err(|cancelled| Failure::Invalid(cancelled.to_string()))?;
    // An endless function is detected only when it runs.
    can_draw(job, part, registry)?;
    let odd = odd.into_inner().then(|| finite::remark_on_cpu(part, registry)).flatten();
    let reached = Some(end).filter(|end| end.samples > 0);
    let noisy = reached.and_then(|reached| job.arguments.sampling.remark(reached));
    Ok((channels, reached, odd.into_iter().chain(noisy).collect()))
}

/// The legends of a channel in the views of a picture; if there are several, with the letters of their views.
fn legends(plan: &Plan, channel: Setting, registry: &Registry) -> Vec<Option<Legend>> {
    let several = plan.parts.len() > 1;
    let of_part = |part: &Part| {
        let mut legend = channel.legend(&part.scene, registry);
        if let Some(letter) = LETTERS.get(part.cell.view).filter(|_| several) {
            legend.title = format!("{letter} · {}", legend.title);
        }
        Some(legend)
    };
    plan.parts.iter().map(of_part).collect()
}

/// The picture and its size, with a caption if requested.
fn captioned(
    job: &Job,
    registry: &Registry,
    rgb8: Vec<u8>,
    (rests_on, numbers): (&[Sampled], Vec<caption::Part>),
) -> (Vec<u8>, [u32; 2]) {
    if !job.arguments.caption {
        return (rgb8, job.arguments.size);
    }
    let shown: Vec<_> = job.plan.parts.iter().map(|part| (part.cell.view, &part.scene, part.terms)).collect();
    let mut caption = caption::of_picture(job.scene, &shown, registry).resting_on(rests_on);
    caption.facts.extend(numbers);
    caption::draw(&caption, rgb8, job.arguments.size)
}

fn on_cpu(job: &Job, part: &Part, registry: &Registry, progress: &Progress) -> Result<Drawn, Failure> {
    can_draw(job, part, registry)?;
    let Cell { width, height, .. } = part.cell;
    let view = View {
        scene: &part.scene,
        registry,
        settings: reference::Settings { width, height, samples: job.arguments.samples, terms: part.terms },
        channel: job.channel,
        until: job.arguments.sampling.until(),
        lit: job.plan.needs_light() || job.arguments.numbers,
    };
    // A channel does not record non-finite light.
    let odd = AtomicBool::new(job.channel.is_some() && has_untested(registry));
    let (shown, reached) =
        view.draw(&odd, progress).map_err(|undrawn| Failure::Invalid(undrawn.to_string()))?;
    // An endless function is detected only when it runs.
    can_draw(job, part, registry)?;
    let odd = odd.into_inner().then(|| finite::remark_on_cpu(part, registry)).flatten();
    let noisy = reached.and_then(|reached| job.arguments.sampling.remark(reached));
    Ok(Drawn { shown, reached, remarks: odd.into_iter().chain(noisy).collect() })
}

/// The views shown in the picture of a scene.
fn plan(scene: &Scene, arguments: &Arguments, size: [u32; 2], registry: &Registry) -> Result<Plan, Failure> {
    if let Some(name) = &arguments.view {
        let view = views::find(scene, name).map_err(Failure::Invalid)?;
        return Ok(Plan::of_view(scene, view, size, arguments.term, registry));
    }
    let mut comparison = scene.comparison;
    if let Some(layout) = arguments.layout {
        if layout != Layout::Single && scene.variants.is_empty() {
            return Err(Failure::Invalid(format!("the scene has no variants for --layout {}", layout.id())));
        }
        comparison.layout = layout;
    }
    Plan::new(scene, comparison, size, arguments.term, registry)
}

/// The scene stored in a picture: command-line options for views are included.
fn pictured(job: &Job) -> Scene {
    match job.plan.parts.as_slice() {
        [part] if job.arguments.view.is_some() => part.scene.clone().alone(),
        _ => Scene { comparison: job.plan.comparison, ..job.scene.clone() },
    }
}

/// The debug channel shown instead of the picture of a scene.
fn setting(
    scene: &Scene,
    plan: &Plan,
    arguments: &Arguments,
    registry: &Registry,
) -> Result<Option<Setting>, String> {
    let Some(channel) = arguments.channel else { return Ok(None) };
    if plan.needs_light() {
        let remedy = "use another --layout, or compare display codes";
        return Err(format!("the difference in linear light has no channels; {remedy}"));
    }
    let chosen = arguments.light.as_deref().map(|name| light(scene, name)).transpose()?;
    let setting = Setting::new(channel, scene, registry, scene.observer.position, chosen);
    let place = chosen.map(|chosen| scene.lights[..chosen].iter().filter(|light| light.enabled).count());
    if place.is_some() && channel.has_light() && setting.light != place {
        let (light, channel) = (quoted(arguments.light.as_deref().unwrap_or_default()), channel.name());
        return Err(format!("--light is {light}, which has no direction, but {channel} needs one"));
    }
    if place.is_some() && !channel.has_light() {
        return Err(format!("--light is for channels of one light, and {} is not one", channel.id()));
    }
    Ok(Some(setting))
}

/// Fails if the CPU renderer is known to lack something that a scene's models need.
pub(super) fn cpu_can_draw(scene: &Scene, registry: &Registry) -> Outcome {
    cpu_can_draw_or(scene, registry, "--renderer gpu")
}

/// Like [`cpu_can_draw`], with a suggestion of an alternative.
fn cpu_can_draw_or(scene: &Scene, registry: &Registry, instead: &str) -> Outcome {
    match reference::not_on_cpu(scene, registry) {
        Some((model, why)) => Err(not_on_cpu(model, &why, instead)),
        None => Ok(()),
    }
}

/// The file for each scene.
fn files(sources: &[Source], output: Option<&Path>) -> Result<Vec<PathBuf>, Failure> {
    let folder = match output {
        None => Path::new(RENDERS_DIR),
        Some(path) => match (outputs::is_file("-o", path, true)?, sources) {
            (true, [_]) => return Ok(vec![path.to_owned()]),
            (true, _) => {
                let (file, count) = (path.shown(), sources.len());
                let said = format!("-o {file} is one file, but there are {count} scenes; name a folder");
                return Err(Failure::Usage(said));
            }
            (false, _) => path,
        },
    };
    let mut files = Vec::with_capacity(sources.len());
    let mut taken: HashMap<PathBuf, String> = HashMap::new();
    for source in sources {
        let file = folder.join(format!("{}.png", source.stem()));
        if let Some(other) = taken.insert(file.clone(), source.name()) {
            let both = format!("{other} and {} would both be written to {}", source.name(), file.shown());
            return Err(Failure::Usage(format!("{both}; render them one by one with -o FILE")));
        }
        files.push(file);
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(names: &[&str], output: Option<&str>) -> Result<Vec<String>, String> {
        let sources: Vec<_> = names.iter().map(|n| Source::named(Path::new(n))).collect();
        match files(&sources, output.map(Path::new)) {
            Ok(files) => Ok(files.iter().map(|f| f.display().to_string()).collect()),
            Err(Failure::Usage(what)) => Err(what),
            Err(other) => Err(format!("{other:?}")),
        }
    }

    #[test]
    fn pictures_are_named_after_their_scenes() {
        assert_eq!(named(&["scenes/room.json"], None), Ok(vec!["renders/room.png".to_owned()]));
        assert_eq!(named(&["-"], None), Ok(vec!["renders/stdin.png".to_owned()]));
        for file in ["x/y.PNG", "x/y.exr", "x/y.HDR"] {
            assert_eq!(named(&["a/room.json"], Some(file)), Ok(vec![file.to_owned()]));
        }
        assert_eq!(
            named(&["a.json", "b.json"], Some("out")),
            Ok(vec!["out/a.png".to_owned(), "out/b.png".to_owned()])
        );
        assert_eq!(files(&[Source::Default], None).ok(), Some(vec![PathBuf::from("renders/default.png")]));
    }

    #[test]
    fn ambiguous_names_are_refused() {
        let said = |names: &[&str], output| named(names, output).err().unwrap_or_default();
        assert!(said(&["a.json", "b.json"], Some("x.png")).contains("is one file, but there are 2 scenes"));
        assert!(said(&["a/x.json", "b/x.json"], None).contains("would both be written to renders/x.png"));
        assert!(said(&["a.json"], Some("x.jpg")).contains("did you mean x.png?"));
        assert!(
            outputs::one_picture("-o", Path::new("x.exr")).is_err(),
            "numbers have no linear picture beside them"
        );
    }
}
