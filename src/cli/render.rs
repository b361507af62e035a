//! `lcm render`: scenes to PNG files.

use std::{
    borrow::Cow,
    collections::{BTreeSet, HashMap},
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Duration,
};

use bevy::app::App;
use clap::{Args, ValueEnum};

use super::{
    FINE, Options, Outcome, collected, finite, gauged,
    light_samples::{self, Sampling},
    one_of, outputs, progress,
    scenes::Source,
    style,
    views::{self, Part, Plan, word},
    workshop::{Workshop, drawable, invalid, not_on_cpu},
};
use crate::files::Shown as _;
use crate::{
    caption::{self, Sampled},
    channel::{DebugChannel, Legend, Setting},
    compare::{Cell, Shown, compose, with_legends},
    explain::finite::Tried,
    export::write::inputs,
    failure::Failure,
    files::{Kind, is_descriptor, kind, printable},
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    progress::Progress,
    reference::{self, LightSamples, Reached, Until},
    reflection::ends::check_that_it_ends,
    registry::Registry,
    render::{
        capture::{
            gpu::{self, GpuError, GpuRenderer, find_adapter, may_have_hardware},
            png::About,
        },
        trial::{
            Bench,
            process::{Budget, TrialProcess},
        },
    },
    scene::{Comparison, Display, Scene, comparison::Layout, field::Ids, has_extent, variant::LETTERS},
    text::{listed, quoted},
};

/// Maximum number of objects whose models are tried on the CPU before the GPU draws them.
const MOST_TRIED: usize = 64;
/// Maximum number of lights listed one by one.
const MOST_LISTED: usize = 16;
/// Interval between updates of the progress bar for several pictures.
const TICK: Duration = Duration::from_millis(200);
/// Default folder for pictures (CA `RENDERS_DIR`).
const RENDERS_DIR: &str = "renders";

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene files; `-` is standard input; without any, the default scene
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// PNG file, or folder for the pictures of several scenes; by default the folder renders
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
    /// Use this reflection model for every object
    #[arg(long, value_name = "ID")]
    reflection: Option<String>,
    /// Use this shading model for every object
    #[arg(long, value_name = "ID")]
    shading: Option<String>,
    #[arg(long, value_name = "NAME", help = format!(
        "Use this tone mapping instead of the scene's: {}", listed(&ToneMapping::ALL.map(ToneMapping::id), "or")
    ))]
    tone_mapping: Option<String>,
    /// Use this exposure in EV instead of the scene's; each step up doubles the light
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = exposure)]
    exposure: Option<f32>,
    /// Show only one term of the reflection model's equation
    #[arg(long, value_parser = term, default_value = "all", value_name = "all|ambient|diffuse|specular")]
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
    /// Add a strip below the picture that says what it shows; the height of the strip is added to that of --size
    #[arg(long)]
    caption: bool,
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

#[cfg(target_os = "linux")]
impl Arguments {
    /// True if the command loads a graphics driver, to draw with it or to query it.
    pub(super) fn loads_driver(&self) -> bool {
        match self.renderer {
            Renderer::Auto => may_have_hardware(),
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

/// Maximum width and height of a picture, in pixels: the usual limit of GPUs.
pub(super) const MAX_SIDE: u32 = 16_384;

/// Parser of sizes: width and height.
pub(super) fn sides(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.trim().parse().ok().filter(|n| (1..=MAX_SIDE).contains(n));
    let both = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
    both.ok_or_else(|| format!("it must be WIDTHxHEIGHT in pixels, each from 1 to {MAX_SIDE}, e.g. 800x600"))
}

/// Parser of the exposure; its range is checked with those of all changes.
fn exposure(text: &str) -> Result<f32, String> {
    text.trim().parse().map_err(|_| "it must be a number of EV, e.g. -1.5".to_owned())
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
    /// True if what is shown of a scene depends on samples of lights with extent.
    fn converges(&self, scene: &Scene, registry: &Registry) -> bool {
        self.channel.is_none_or(|setting| rests_on_samples(setting.channel))
            && has_extent(scene.shining(), registry)
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
    if let Some(id) = &arguments.reflection {
        workshop.need(id);
    }
    let changes = Changes::new(arguments, &workshop.registry)?;
    let files = files(&sources, arguments.output.as_deref())?;
    let renderer = renderer(arguments)?;

    // All scenes are read before the first is rendered, so that errors in the last one appear at once.
    let scenes = collected(sources.iter().map(|source| {
        let mut scene = changes.apply(source.open(workshop, options)?);
        let mut beyond = scene.bring_into_range(&workshop.registry);
        beyond.extend(scene.beyond_the_range_of_views(&workshop.registry));
        beyond.iter().for_each(|said| options.tell(format_args!("{}: {said}", source.name())));
        Ok(scene)
    }))?;

    let registry = &workshop.registry;
    let size = arguments.size;
    let plans = collected(scenes.iter().zip(&sources).map(|(scene, source)| {
        plan(scene, arguments, size, registry).map_err(|failure| match failure {
            Failure::Invalid(why) => Failure::Invalid(format!("{}: {why}", source.name())),
            other => other,
        })
    }))?;
    // By now the registry knows the files of models and shaders.
    let read = inputs(sources.iter().filter_map(Source::path), &scenes, registry);
    files.iter().try_for_each(|file| outputs::picture(file, &read))?;
    for part in plans.iter().flat_map(|plan| &plan.parts) {
        drawable(registry, &part.scene)?;
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
        bar.set_style(style("{bar:30} {percent} % {msg}{left}"));
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
        options.tell(format!("the CPU renderer ignores the edited {passed}; --renderer gpu uses the edits"));
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
            let what = printable(&format!("{} of {count}, {}", done + 1, source.name())).into_owned();
            let begin = done * FINE;
            let tell = |done: f32, step: &str| {
                bar.set_message(if step.is_empty() { what.clone() } else { format!("{what}, {step}") });
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

/// The requested renderer. Samples of lights with extent are counted on the CPU.
fn renderer(arguments: &Arguments) -> Result<Renderer, Failure> {
    let Some(given) = arguments.sampling.given() else { return Ok(arguments.renderer) };
    if let Some(channel) = arguments.channel.filter(|channel| !rests_on_samples(*channel)) {
        let known = DebugChannel::ALL.into_iter().filter(|known| rests_on_samples(*known));
        let known: Vec<_> = known.map(DebugChannel::id).collect();
        let said = format!("{given} cannot be used with --channel {}", channel.id());
        let rule = format!("channels that do are {}", listed(&known, "and"));
        return Err(Failure::Usage(format!("{said}, which does not depend on light samples; {rule}")));
    }
    match arguments.renderer {
        Renderer::Gpu => Err(Failure::Usage(format!(
            "{given} cannot be used with --renderer gpu, which always takes {} samples; use --renderer cpu",
            LightSamples::DEFAULT
        ))),
        Renderer::Auto | Renderer::Cpu => Ok(Renderer::Cpu),
    }
}

/// True for channels whose values derive from the light that leaves the surface.
fn rests_on_samples(channel: DebugChannel) -> bool {
    channel.is_of_light() && !channel.has_wires()
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
    /// The renderer of the last picture, with its size and samples: the next picture likely has the same.
    last: Option<((u32, u32, u32), GpuRenderer)>,
    /// The results on the CPU of models that tests do not cover.
    tried: Tried,
}

impl Painter {
    fn new(renderer: Renderer, trial_program: Option<PathBuf>) -> Result<Self, Failure> {
        let gpu = match renderer {
            Renderer::Cpu => false,
            Renderer::Gpu => {
                find_adapter().map_err(|e| Failure::NoRenderer(e.to_string()))?;
                true
            }
            // Querying the driver takes longer than rendering a picture; the device nodes reveal at once that
            // there is no GPU.
            Renderer::Auto => may_have_hardware() && find_adapter().is_ok_and(|a| !a.software),
        };
        Ok(Self { renderer, gpu, trial_program, last: None, tried: Tried::default() })
    }

    /// True if the GPU renders the views of a picture.
    fn takes_gpu(&self, plan: &Plan, registry: &Registry) -> bool {
        match self.renderer {
            Renderer::Auto => {
                let cpu = plan.parts.iter().all(|part| cpu_can_draw(&part.scene, registry).is_ok());
                !cpu || self.gpu && !plan.needs_light()
            }
            Renderer::Gpu | Renderer::Cpu => self.gpu,
        }
    }

    /// Renders one picture.
    fn draw(&mut self, job: &Job, registry: &Registry, progress: &Progress) -> Result<Painted, Failure> {
        let gpu = self.takes_gpu(job.plan, registry);
        if gpu && job.plan.needs_light() {
            return Err(Failure::NoRenderer(format!(
                "{}: the GPU renderer cannot draw the difference in linear light; use --renderer cpu, or compare display codes",
                job.source.name()
            )));
        }
        let count = job.plan.parts.len();
        let mut all = Vec::with_capacity(count);
        let (mut remarks, mut rests_on) = (Vec::new(), Vec::new());
        for (i, part) in job.plan.parts.iter().enumerate() {
            let name = |step: &str| {
                let letter = LETTERS.get(part.cell.view).filter(|_| count > 1);
                letter.map_or_else(|| step.to_owned(), |letter| format!("view {letter}, {step}"))
            };
            let Drawn { shown, reached, remarks: of_part } = match gpu {
                true => self.on_gpu(job, part, registry)?,
                false => progress.part((i, count), name, |progress| on_cpu(job, part, registry, progress))?,
            };
            let outlined = all.is_empty() && job.plan.is_map();
            all.push(if outlined { shown.outlined(&part.scene, registry) } else { shown });
            remarks.extend(of_part);
            rests_on.extend(reached);
        }
        let mut shown = all;
        let light = caption::line(&caption::sampled(&rests_on));
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
        let renderer = if gpu { "GPU" } else { "CPU" };
        let about = About::scene(&pictured(job), registry)
            .with("Source", job.source.name())
            .with("Renderer", renderer);
        let about = job.channel.into_iter().fold(about, |about, s| about.with("Channel", s.channel.id()));
        let about = light_samples::noted(about, &light);
        let about = if job.arguments.no_scene { about.without_scene() } else { about };
        let (rgb8, size) = captioned(job, registry, rgb8, &rests_on);
        outputs::write_picture(job.file, size, &rgb8, &about)?;
        Ok(Painted { remarks, light })
    }

    fn on_gpu(&mut self, job: &Job, part: &Part, registry: &Registry) -> Result<Drawn, Failure> {
        let Cell { width, height, .. } = part.cell;
        let key = (width, height, job.arguments.samples);
        let failed = |e: GpuError| match e {
            GpuError::Invalid(_) | GpuError::Endless(_) => e.into(),
            e => Failure::NoRenderer(format!("{}: {e}", job.file.shown())),
        };
        // An endless loop on a GPU cannot be stopped.
        for object in part.scene.objects.iter().take(MOST_TRIED) {
            if let Some(model) = registry.model(part.scene.model_of(object)) {
                check_that_it_ends(model, &object.material, Encoding::Srgb).map_err(|e| failed(e.into()))?;
            }
        }
        let renderer = match &mut self.last {
            Some((last, renderer)) if *last == key => renderer,
            slot => {
                let samples = if job.arguments.samples == 4 { 4 } else { 1 };
                let renderer = GpuRenderer::extended(width, height, samples, gpu::Output::Display, |app| {
                    try_apart(app, registry, self.trial_program.clone());
                    app.insert_resource(registry.clone());
                })
                .map_err(failed)?;
                &mut slot.insert((key, renderer)).1
            }
        };
        renderer.set_scene(part.scene.clone());
        renderer.set_terms(part.terms);
        renderer.set_channel(job.channel);
        renderer.settle().map_err(failed)?;
        if let Some(problem) = renderer.shader_problem() {
            return Err(invalid(registry, &problem));
        }
        let rgb8 = renderer.read_rgb8().map_err(failed)?;
        let shown =
            Shown::of_codes(width, height, rgb8).map_err(|e| failed(GpuError::Copy(e.to_string())))?;
        let reached = job
            .converges(&part.scene, registry)
            .then_some(Reached { samples: LightSamples::DEFAULT, noise: None });
        // Everything shipped with the program is finite.
        if !has_untested(registry) {
            return Ok(Drawn { shown, reached, remarks: Vec::new() });
        }
        renderer.set_channel(Some(finite::channel(&part.scene, registry)));
        renderer.settle().map_err(failed)?;
        let channel = renderer.read_rgb8().map_err(failed)?;
        let remark = finite::remark_on_gpu(part, registry, &channel, &mut self.tried);
        Ok(Drawn { shown, reached, remarks: remark.into_iter().collect() })
    }
}

/// The legends of a channel in the views of a picture; if there are several, with the letters of their views.
fn legends(plan: &Plan, channel: Setting, registry: &Registry) -> Vec<Legend> {
    let several = plan.parts.len() > 1;
    let of_part = |part: &Part| {
        let mut legend = channel.legend(&part.scene, registry);
        if let Some(letter) = LETTERS.get(part.cell.view).filter(|_| several) {
            legend.title = format!("{letter} · {}", legend.title);
        }
        legend
    };
    plan.parts.iter().map(of_part).collect()
}

/// The picture and its size, with a caption if requested.
fn captioned(job: &Job, registry: &Registry, rgb8: Vec<u8>, rests_on: &[Sampled]) -> (Vec<u8>, [u32; 2]) {
    if !job.arguments.caption {
        return (rgb8, job.arguments.size);
    }
    let shown: Vec<_> = job.plan.parts.iter().map(|part| (part.cell.view, &part.scene, part.terms)).collect();
    let caption = caption::of_picture(job.scene, &shown, registry).resting_on(rests_on);
    caption::draw(&caption, rgb8, job.arguments.size)
}

/// True if something is drawn that this crate's tests do not cover.
fn has_untested(registry: &Registry) -> bool {
    registry.sources().edited().next().is_some() || registry.has_foreign()
}

/// Tries the shaders of users and of other crates in another process, since they may crash a driver.
fn try_apart(app: &mut App, registry: &Registry, program: Option<PathBuf>) {
    if has_untested(registry)
        && let Some(program) = program
        && let Some(mut bench) = app.world_mut().get_resource_mut::<Bench>()
    {
        bench.try_in(TrialProcess::new(program, Budget::default(), || {}));
    }
}

fn on_cpu(job: &Job, part: &Part, registry: &Registry, progress: &Progress) -> Result<Drawn, Failure> {
    let can_draw = || {
        let without =
            job.arguments.sampling.given().map_or_else(String::new, |given| format!(" without {given}"));
        cpu_can_draw_or(&part.scene, registry, &format!("--renderer gpu{without}"))
    };
    can_draw()?;
    let Cell { width, height, .. } = part.cell;
    let settings = reference::Settings { width, height, samples: job.arguments.samples, terms: part.terms };
    // A channel does not record non-finite light.
    let odd = AtomicBool::new(job.channel.is_some() && has_untested(registry));
    let of_codes = |rgb8| Shown::of_codes(width, height, rgb8).map_err(|e| Failure::Invalid(e.to_string()));
    let alone = job.channel.filter(|setting| setting.channel.is_picture());
    let lit =
        alone.map_or_else(|| Cow::Borrowed(&part.scene), |setting| Cow::Owned(setting.lit(&part.scene)));
    let until = job.arguments.sampling.until();
    let converged = || {
        reference::render_until(&lit, registry, &settings, until, &odd, progress)
            .map_err(|cancelled| Failure::Invalid(cancelled.to_string()))
    };
    let mut reached = None;
    let shown = if let Some(setting) = job.channel.filter(|_| alone.is_none()) {
        if job.converges(&lit, registry) {
            // A channel is not a mean of others, so it takes all samples at once: as many as the picture
            // takes.
            reached = Some(match until {
                Until { noise: Some(_), .. } => converged()?.1,
                Until { samples, noise: None } => Reached { samples, noise: None },
            });
        }
        let samples = reached.map_or_else(LightSamples::default, |reached| LightSamples::of(reached.samples));
        of_codes(reference::render_channel_by(&lit, registry, &settings, &setting, samples))?
    } else if job.converges(&lit, registry) {
        let (picture, end) = converged()?;
        reached = Some(end);
        Shown::of_light(picture, &lit.display)
    } else if job.plan.needs_light() {
        let picture = reference::render_samples(&lit, registry, &settings, LightSamples::default(), &odd);
        Shown::of_light(picture, &lit.display)
    } else {
        of_codes(reference::render_rgb8_noting(&lit, registry, &settings, &odd))?
    };
    // An endless function is detected only when it runs.
    can_draw()?;
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
    for model in scene.objects.iter().filter_map(|o| registry.model(scene.model_of(o))) {
        if let Some(why) = model.not_on_cpu() {
            return Err(not_on_cpu(model, &why, instead));
        }
    }
    Ok(())
}

/// Changes from the command line, applied to every scene.
struct Changes<'a> {
    arguments: &'a Arguments,
    tone_mapping: Option<ToneMapping>,
}

impl<'a> Changes<'a> {
    fn new(arguments: &'a Arguments, registry: &Registry) -> Result<Self, Failure> {
        let usage = |flag: &str, value: &str, rule: String| {
            Failure::Usage(format!("--{flag} is {}, but {rule}", quoted(value)))
        };
        if let Some(id) = &arguments.reflection {
            Ids::ReflectionModel.check(registry, id).map_err(|rule| {
                super::evaluate::unknown(registry, id, format!("--reflection is {}, but {rule}", quoted(id)))
            })?;
        }
        if let Some(id) = &arguments.shading {
            Ids::ShadingModel.check(registry, id).map_err(|rule| usage("shading", id, rule))?;
        }
        if let Some(ev) = arguments.exposure {
            Display::exposure.check_number(ev).map_err(|rule| usage("exposure", &ev.to_string(), rule))?;
        }
        if let Some(id) = &arguments.tone_mapping {
            Display::tone_mapping.check_text(id).map_err(|rule| usage("tone-mapping", id, rule))?;
        }
        Ok(Self { arguments, tone_mapping: arguments.tone_mapping.as_deref().and_then(ToneMapping::from_id) })
    }

    /// The scene with the changes. A model from the command line also replaces the overrides of objects and
    /// views: the purpose is to see the whole scene with it.
    fn apply(&self, mut scene: Scene) -> Scene {
        let Arguments { reflection, shading, exposure, .. } = self.arguments;
        if let Some(id) = reflection {
            scene.reflection_model.clone_from(id);
            scene.objects.iter_mut().for_each(|o| o.reflection_model = None);
        }
        if let Some(id) = shading {
            scene.shading_model.clone_from(id);
            scene.objects.iter_mut().for_each(|o| o.shading_model = None);
        }
        scene.display.tone_mapping = self.tone_mapping.unwrap_or(scene.display.tone_mapping);
        scene.display.exposure = exposure.unwrap_or(scene.display.exposure);
        for variant in &mut scene.variants {
            variant.reflection_model.take_if(|_| reflection.is_some());
            variant.shading_model.take_if(|_| shading.is_some());
            variant.tone_mapping.take_if(|_| self.tone_mapping.is_some());
            variant.exposure.take_if(|_| exposure.is_some());
        }
        scene
    }
}

/// The file for each scene.
fn files(sources: &[Source], output: Option<&Path>) -> Result<Vec<PathBuf>, Failure> {
    let folder = match output {
        None => Path::new(RENDERS_DIR),
        Some(path) => match (is_file(path)?, sources) {
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

/// Fails unless `-o` is a single picture, next to the numbers on standard output.
pub(super) fn one_picture(path: &Path) -> Outcome {
    let usage = |why: &str| Failure::Usage(format!("-o {}: {why}", path.shown()));
    let stdout = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];
    if stdout.iter().any(|name| path == Path::new(name)) {
        return Err(usage("standard output is for the numbers; name a PNG file"));
    }
    if is_file(path)? { Ok(()) } else { Err(usage("name a PNG file")) }
}

/// True if `-o` is a file, and not a folder. A path that ends in `.png` is one, unless it is an existing folder; so
/// is a device or a pipe. Other picture formats are refused; anything else is a folder.
fn is_file(path: &Path) -> Result<bool, Failure> {
    match kind(path) {
        Ok(Kind::Folder) => return Ok(false),
        Ok(Kind::Device | Kind::Pipe) => return Ok(true),
        Ok(Kind::Socket | Kind::Unknown) => {
            return Err(Failure::Write(format!("-o {} is neither a file nor a folder", path.shown())));
        }
        Ok(Kind::File) if is_descriptor(path) => return Ok(true),
        Ok(Kind::File) | Err(_) => {}
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "png" => Ok(true),
        "jpg" | "jpeg" | "gif" | "bmp" | "tif" | "tiff" | "webp" | "exr" | "hdr" | "ppm" | "tga" | "svg"
        | "pdf" => {
            let (file, png) = (path.shown(), path.with_extension("png"));
            let hint = format!("did you mean {}?", png.shown());
            Err(Failure::Usage(format!("-o {file}: only PNG files can be written; {hint}")))
        }
        _ if path.is_file() => {
            Err(Failure::Write(format!("-o {} is not a PNG file; name a PNG file or a folder", path.shown())))
        }
        _ => Ok(false),
    }
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
        assert_eq!(named(&["a/room.json"], Some("x/y.PNG")), Ok(vec!["x/y.PNG".to_owned()]));
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
    }

    #[test]
    fn sizes_have_two_sides() {
        assert_eq!(sides("800x600"), Ok([800, 600]));
        for wrong in ["800", "0x5", "5x-1", "x", "axb", "99999x1", ""] {
            assert!(sides(wrong).is_err(), "{wrong}");
        }
    }
}
