//! `lcm compare`: the difference between two views, or two files, as numbers and as a picture.

use std::{
    borrow::Cow,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use clap::Args;
use serde::{Serialize, Serializer, ser::SerializeMap};

use super::{
    Options, Outcome, collected, finite, gauged,
    light_samples::{self, Sampling},
    one_of, outputs, pictures, print_json,
    render::{cpu_can_draw, samples},
    scenes::Source,
    sides,
    views::{Choice, find},
    workshop::{Workshop, drawable},
};
use crate::files::Shown as _;
use crate::{
    caption::{self, Sampled},
    compare::{Largest, Measured, Metric, Metrics, Pair, Shown, cells, compose, metric::Way, size_around},
    explain::finite::Tried,
    export::write::inputs,
    failure::Failure,
    picture::png::About,
    progress::Progress,
    reference::{self, Reached, Settings},
    registry::Registry,
    scene::{Comparison, Scene, comparison::Compared, variant::LETTERS},
    text::listed,
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file, PNG picture, or OpenEXR or Radiance picture with linear light; `-` is a scene on standard input
    #[arg(value_name = "A")]
    a: PathBuf,
    /// The other scene file or picture; without one, the scene is compared with its own variant
    #[arg(value_name = "B")]
    b: Option<PathBuf>,
    /// PNG file for the picture of the comparison
    #[arg(long, short, value_name = "FILE", value_parser = outputs::place())]
    output: Option<PathBuf>,
    /// Size of the picture in pixels; by default that of a picture, or 1280x720
    #[arg(long, value_name = "WxH", value_parser = sides)]
    size: Option<[u32; 2]>,
    /// Samples per pixel: 1, or 4 for smooth edges
    #[arg(long, default_value = "4", value_parser = samples)]
    samples: u32,
    #[command(flatten)]
    sampling: Sampling,
    #[command(flatten)]
    choice: Choice,
    #[arg(long, value_name = "METRIC=VALUE", value_parser = above, help = help("larger", false))]
    fail_above: Vec<Limit>,
    #[arg(long, value_name = "METRIC=VALUE", value_parser = below, help = help("smaller", true))]
    fail_below: Vec<Limit>,
}

/// The help of an option for metrics that are larger where pictures are more alike, or for the others.
fn help(side: &str, of_likeness: bool) -> String {
    let known = Metric::ids(of_likeness).collect::<Vec<_>>().join(", ");
    format!("Fail if a metric is {side}: {known}; with covered. before it, over covered pixels only")
}

/// A limit on a metric.
#[derive(Clone, Copy, Debug)]
struct Limit {
    metric: &'static Metric,
    covered: bool,
    value: f64,
}

fn above(text: &str) -> Result<Limit, String> {
    limit(text, false)
}

fn below(text: &str) -> Result<Limit, String> {
    limit(text, true)
}

fn limit(text: &str, of_likeness: bool) -> Result<Limit, String> {
    let example = if of_likeness { "ssim=0.99" } else { "rmse=0.01" };
    let (name, value) =
        text.split_once('=').ok_or_else(|| format!("it must be METRIC=VALUE, e.g. {example}"))?;
    let (covered, id) = match name.trim().strip_prefix("covered.") {
        Some(id) => (true, id),
        None => (false, name.trim()),
    };
    let metric = Metric::from_id(id).ok_or_else(|| {
        let known: Vec<_> = Metric::ids(false).chain(Metric::ids(true)).collect();
        one_of("the metric", id, &known)
    })?;
    if metric.of_likeness != of_likeness {
        let flag = if of_likeness { "above" } else { "below" };
        let moves = if of_likeness { "grows" } else { "falls" };
        return Err(format!("{id} {moves} as pictures differ more; use --fail-{flag} {text}"));
    }
    if matches!(metric.way, Way::Largest(_)) && covered {
        return Err(format!("{id} is always that of all pixels; omit covered."));
    }
    match value.trim().parse() {
        Ok(value) if f64::is_finite(value) => Ok(Limit { metric, covered, value }),
        _ => Err(format!("the limit must be a number, e.g. {example}")),
    }
}

/// An input of the comparison.
enum Input {
    Scene(Source, Box<Scene>),
    Picture(String, Shown),
}

impl Input {
    fn read(path: &Path, workshop: &mut Workshop, options: Options) -> Result<Self, Failure> {
        let source = Source::named(path);
        if matches!(source, Source::File(_)) && pictures::is_picture(path) {
            return Ok(Self::Picture(source.name(), pictures::read(path)?));
        }
        let scene = Box::new(source.open(workshop, options)?);
        Ok(Self::Scene(source, scene))
    }

    fn name(&self) -> String {
        match self {
            Self::Scene(source, _) => source.name(),
            Self::Picture(name, _) => name.clone(),
        }
    }

    fn scene(&self) -> Option<&Scene> {
        if let Self::Scene(_, scene) = self { Some(scene) } else { None }
    }

    /// True for a picture of linear light.
    fn is_linear(&self) -> bool {
        matches!(self, Self::Picture(_, shown) if !shown.has_codes())
    }

    fn size(&self) -> Option<[u32; 2]> {
        if let Self::Picture(_, shown) = self { Some(shown.size()) } else { None }
    }
}

/// The way in which views are drawn.
struct Drawing<'a> {
    /// Samples per pixel.
    samples: u32,
    sampling: Sampling,
    registry: &'a Registry,
    /// Number of pictures.
    count: usize,
}

/// A view to compare: one of a scene, or a picture.
#[derive(Clone, Copy)]
struct View<'a> {
    input: &'a Input,
    view: usize,
}

impl<'a> View<'a> {
    /// Fails if the view cannot be drawn.
    fn check(&self, registry: &Registry) -> Outcome {
        match self.input.scene().and_then(|scene| scene.seen(self.view, registry)) {
            Some((seen, _)) => drawable(registry, &seen).and_then(|()| cpu_can_draw(&seen, registry)),
            None => Ok(()),
        }
    }

    /// The picture of the view, and the convergence of lights with extent. Pictures keep their size. `number`
    /// counts the pictures that are drawn.
    fn shown(
        &self,
        [width, height]: [u32; 2],
        drawing: &Drawing,
        (number, whole): (usize, &Progress),
    ) -> Result<(Cow<'a, Shown>, Option<Reached>), Failure> {
        let scene = match self.input {
            Input::Picture(_, shown) => return Ok((Cow::Borrowed(shown), None)),
            Input::Scene(_, scene) => scene,
        };
        let registry = drawing.registry;
        let none = || Failure::Invalid(format!("{}: there is no such view", self.input.name()));
        let (seen, terms) = scene.seen(self.view, registry).ok_or_else(none)?;
        let settings = Settings { width, height, samples: drawing.samples, terms };
        let odd = AtomicBool::default();
        let until = drawing.sampling.until();
        let drawn = whole.part((number, drawing.count), str::to_owned, |progress| {
            reference::render_until(&seen, registry, &settings, until, &odd, progress)
        });
        let (light, reached) = drawn.map_err(|cancelled| Failure::Invalid(cancelled.to_string()))?;
        // An endless function of a custom model is detected only when it runs.
        self.check(registry)?;
        let shown = Shown::of_light(light, &seen.display);
        Ok((Cow::Owned(shown), Some(reached).filter(|reached| reached.samples > 0)))
    }

    /// The picture of the view, with the outlines of its objects if it is a view of a scene.
    fn outlined(&self, shown: Cow<'a, Shown>, registry: &Registry) -> Cow<'a, Shown> {
        match self.input.scene().and_then(|scene| scene.seen(self.view, registry)) {
            Some((seen, _)) => Cow::Owned(shown.into_owned().outlined(&seen, registry)),
            None => shown,
        }
    }

    fn report(&self, reached: Option<Reached>) -> Side {
        let light_samples = reached.map(|reached| reached.samples);
        let noise = reached.and_then(|reached| reached.noise);
        let (file, view, name) = match self.input {
            Input::Picture(name, _) => (name.clone(), None, None),
            Input::Scene(source, scene) => {
                let name = match self.view.checked_sub(1) {
                    None => scene.name.clone(),
                    Some(i) => scene.variants.get(i).and_then(|variant| variant.name.clone()),
                };
                (source.plain_name(), LETTERS.get(self.view).copied(), name)
            }
        };
        Side { file, view, name, light_samples, noise }
    }
}

/// The result, as JSON.
#[derive(Serialize)]
struct Report {
    a: Side,
    b: Side,
    width: u32,
    height: u32,
    values: &'static str,
    channel: &'static str,
    all: Numbers,
    covered: Option<Numbers>,
    largest: Option<Most>,
}

/// The largest difference, with the display codes of both pictures there, or with their light if one has no codes.
#[derive(Serialize)]
#[serde(untagged)]
enum Most {
    Codes(Largest),
    Light { x: u32, y: u32, difference: f32, a: [f32; 3], b: [f32; 3] },
}

impl Most {
    fn of(largest: Largest, shown: &[Cow<Shown>; 2]) -> Self {
        let Largest { x, y, difference, .. } = largest;
        let light = |shown: &Cow<Shown>| Some(shown.light()?.pixel(x, y).truncate().to_array());
        match [&shown[0], &shown[1]].map(light) {
            [Some(a), Some(b)] if shown.iter().any(|shown| !shown.has_codes()) => {
                Self::Light { x, y, difference, a, b }
            }
            _ => Self::Codes(largest),
        }
    }
}

/// One side of the comparison.
#[derive(Serialize)]
struct Side {
    file: String,
    view: Option<&'static str>,
    name: Option<String>,
    /// The samples of each light with extent, and the noise of the picture; `None` without such lights.
    #[serde(skip_serializing_if = "Option::is_none")]
    light_samples: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    noise: Option<f32>,
}

/// The metrics by id; null where one is infinite, or not known.
struct Numbers(Metrics);

impl Serialize for Numbers {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(None)?;
        map.serialize_entry("pixels", &self.0.pixels)?;
        for (id, number) in &self.0.numbers {
            map.serialize_entry(id, &number.filter(|number| number.is_finite()))?;
        }
        map.end()
    }
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let paths: Vec<_> = [Some(&arguments.a), arguments.b.as_ref()].into_iter().flatten().collect();
    if paths.iter().filter(|path| path.as_path() == Path::new("-")).count() > 1 {
        return Err(Failure::Usage("- can be given only once: standard input holds one scene".to_owned()));
    }
    if arguments.b.is_some() && arguments.choice.with.is_some() {
        return Err(Failure::Usage("with two files, view A of each is compared; omit --with".to_owned()));
    }
    if let Some(output) = &arguments.output {
        outputs::one_picture("-o", output)?;
    }
    let mut read = collected(paths.iter().map(|path| Input::read(path, workshop, options)))?;
    // A linear picture beside a scene is shown like the scene.
    if let Some(display) = read.iter().find_map(|input| Some(input.scene()?.display)) {
        let shown = |input: Input| match input {
            Input::Picture(name, shown) => Input::Picture(name, shown.shown_by(&display)),
            scene => scene,
        };
        read = read.into_iter().map(shown).collect();
    }
    let registry = &workshop.registry;
    if let Some(output) = &arguments.output {
        let named = paths.iter().map(|path| Source::named(path)).collect::<Vec<_>>();
        let scenes = read.iter().filter_map(Input::scene);
        outputs::picture(output, &inputs(named.iter().filter_map(Source::path), scenes, registry))?;
    }

    let (comparison, views) = views(arguments, &read)?;
    let size = size(arguments.size, &read)?;
    views.iter().try_for_each(|view| view.check(registry))?;
    let [a, b] = [views[0], other(&comparison, &views)];
    let beside = arguments.output.is_some() && comparison.layout.is_beside();
    let drawing = Drawing {
        samples: arguments.samples,
        sampling: arguments.sampling,
        registry,
        count: if beside { 2 + views.len() } else { 2 },
    };
    if let Some(input) = read.iter().find(|input| input.scene().is_some()) {
        let scenes = read.iter().filter_map(Input::scene);
        let idle = scenes.map(|scene| arguments.sampling.idle(scene, registry)).collect::<Option<Vec<_>>>();
        let idle = idle.and_then(|idle| idle.into_iter().next());
        idle.iter().for_each(|idle| options.tell(format_args!("{}: {idle}", input.name())));
    } else if let Some(idle) = arguments.sampling.idle_for_pictures() {
        options.tell(idle);
    }
    let drawn = gauged("drawing the views", options, |progress| {
        let [first, second] = [(a, 0), (b, 1)].map(|(view, i)| view.shown(size, &drawing, (i, progress)));
        let shown = [first?, second?];
        let beside = match beside {
            true => Some(side_by_side(&comparison, size, &views, &drawing, progress)?),
            false => None,
        };
        Ok::<_, Failure>((shown, beside))
    });
    let ([(shown_a, reached_a), (shown_b, reached_b)], beside) = drawn?;
    for (view, reached) in [(a, reached_a), (b, reached_b)] {
        let remark = reached.and_then(|reached| arguments.sampling.remark(reached));
        let seen = view.input.scene().and_then(|scene| scene.seen(view.view, registry));
        let odd = seen.and_then(|(seen, _)| finite::remark_on_scene(&seen, registry, &mut Tried::default()));
        remark
            .iter()
            .chain(&odd)
            .for_each(|remark| options.tell(format_args!("{}: {remark}", view.input.name())));
    }
    let mut shown = [shown_a, shown_b];
    if arguments.output.is_some() && comparison.layout.is_map() {
        let [shown_a, shown_b] = shown;
        shown = [a.outlined(shown_a, registry), b.outlined(shown_b, registry)];
    }
    let invalid = |error: crate::compare::Unequal| {
        Failure::Invalid(format!("{} and {}: {error}", a.input.name(), b.input.name()))
    };
    let pair = Pair::new(&shown[0], &shown[1]).map_err(invalid)?;
    let differences = pair.differences(&comparison).map_err(invalid)?;
    let measured =
        pair.measure().ok_or_else(|| Failure::Invalid("the pictures have no pixels".to_owned()))?;
    let largest = differences.largest.map(|largest| Most::of(largest, &shown));

    let drawn = match &arguments.output {
        Some(_) if beside.is_some() => beside,
        Some(_) => {
            let shown = shown.map(Cow::into_owned);
            Some((size, compose(&comparison, size, &shown).map_err(invalid)?))
        }
        None => None,
    };
    let report = Report {
        a: a.report(reached_a),
        b: b.report(reached_b),
        width: size[0],
        height: size[1],
        values: comparison.values.id(),
        channel: comparison.channel.id(),
        all: Numbers(measured.all.clone()),
        covered: measured.covered.clone().map(Numbers),
        largest,
    };
    let printed = print_json(&report);
    let broken = broken(arguments, &measured, differences.largest)?;
    // The numbers matter even if the picture cannot be written.
    if let (Some(output), Some((size, rgb8))) = (&arguments.output, drawn) {
        let about = about(&read, comparison, registry);
        let rests_on: Vec<Sampled> = [reached_a, reached_b].into_iter().flatten().collect();
        let light = caption::line(&caption::sampled(&rests_on));
        let about = light_samples::noted(about, &light);
        outputs::tidy_beside(output);
        outputs::write_picture(output, size, &rgb8, &about)?;
        options.tell(format_args!("wrote {}", output.shown()));
    }
    // Limits matter even if nobody reads the numbers.
    if broken.is_empty() { printed } else { Err(Failure::Invalid(broken.join("\n"))) }
}

/// The metadata of the picture, including its scene if it shows one.
fn about(read: &[Input], comparison: Comparison, registry: &Registry) -> About {
    let about = match read {
        [Input::Scene(_, scene)] => About::scene(&Scene { comparison, ..(**scene).clone() }, registry),
        _ => About::program(),
    };
    about.with("Source", listed(&read.iter().map(Input::name).collect::<Vec<_>>(), "and"))
}

/// The comparison, and the views that it shows: those of a scene, or view A of each input.
fn views<'a>(arguments: &Arguments, read: &'a [Input]) -> Result<(Comparison, Vec<View<'a>>), Failure> {
    let of_file = read.iter().find_map(Input::scene).map(|scene| scene.comparison).unwrap_or_default();
    let mut comparison = arguments.choice.applied(of_file);
    if let Some(linear) = read.iter().find(|input| input.is_linear()) {
        comparison.values = Compared::Light;
        of_light_alone(arguments, linear, read)?;
    }
    let of_light = comparison.values == Compared::Light;
    if let Some(picture) = read.iter().find(|input| of_light && input.scene().is_none() && !input.is_linear())
    {
        let why = "the linear light of a picture file is unknown; --values codes compares the display codes";
        return Err(Failure::Invalid(format!("{}: {why}", picture.name())));
    }
    let [input] = read else {
        comparison.with = 1;
        return Ok((comparison, read.iter().map(|input| View { input, view: 0 }).collect()));
    };
    let file = input.name();
    let Some(scene) = input.scene() else {
        return Err(Failure::Usage(format!("{file} is a picture; name another file to compare it with")));
    };
    if scene.variants.is_empty() {
        let rule = "add one, or name another file";
        return Err(Failure::Invalid(format!("{file} has no variants to compare with; {rule}")));
    }
    if let Some(name) = &arguments.choice.with {
        let view = find(scene, name).map_err(|why| Failure::Invalid(format!("{file}: {why}")))?;
        if view == 0 {
            let rule = "--with must be a view other than A, which it is compared with";
            return Err(Failure::Usage(rule.to_owned()));
        }
        comparison.with = view;
    }
    let views = comparison.views(scene.variants.len()).into_iter().map(|view| View { input, view }).collect();
    Ok((comparison, views))
}

/// Fails if anything but light is to be compared, which is all that a linear picture has.
fn of_light_alone(arguments: &Arguments, linear: &Input, read: &[Input]) -> Outcome {
    let name = linear.name();
    if arguments.choice.values == Some(Compared::Codes) {
        let why = format!("--values codes compares display codes, but {name} holds linear light; omit it");
        return Err(Failure::Usage(why));
    }
    if let Some(codes) = read.iter().find(|input| input.scene().is_none() && !input.is_linear()) {
        let why =
            "linear light and display codes cannot be compared; give two linear pictures, or two PNG files";
        return Err(Failure::Invalid(format!("{name} and {}: {why}", codes.name())));
    }
    let of_codes = |limit: &&Limit| match limit.metric.way {
        Way::Pixels(of, _) => of.where_equal.is_some(),
        Way::Largest(_) => false,
    };
    if let Some(limit) = arguments.fail_above.iter().chain(&arguments.fail_below).find(of_codes) {
        let known = "limits can be on light_rmse, covered.light_rmse and largest";
        let id = limit.metric.id;
        return Err(Failure::Usage(format!(
            "{id} compares display codes, but {name} holds linear light; {known}"
        )));
    }
    Ok(())
}

/// The view with which A is compared.
fn other<'a>(comparison: &Comparison, views: &[View<'a>]) -> View<'a> {
    match views {
        [_, b] => *b,
        // For a layout with a single view, or for view A of two files, or for more views.
        [a, ..] => View { input: a.input, view: comparison.with },
        [] => unreachable!("there is always view A"),
    }
}

/// The size of the compared pictures.
fn size(asked: Option<[u32; 2]>, read: &[Input]) -> Result<[u32; 2], Failure> {
    let mut found: Option<(String, [u32; 2])> = asked.map(|size| ("--size".to_owned(), size));
    for input in read {
        let Some(size) = input.size() else { continue };
        match &found {
            Some((name, other)) if *other != size => {
                let ([w, h], [width, height], input) = (*other, size, input.name());
                let sizes = format!("{name} is {w}x{h} pixels, but {input} is {width}x{height}");
                return Err(Failure::Invalid(format!("{sizes}; pictures must have the same size")));
            }
            _ => found = Some((input.name(), size)),
        }
    }
    let usual = Settings::default();
    Ok(found.map_or([usual.width, usual.height], |(_, size)| size))
}

/// The picture of views side by side. Scenes are drawn at the size of their areas; pictures keep theirs, so
/// that the whole is larger.
fn side_by_side(
    comparison: &Comparison,
    size: [u32; 2],
    views: &[View],
    drawing: &Drawing,
    progress: &Progress,
) -> Result<([u32; 2], Vec<u8>), Failure> {
    let variants = views.len() - 1;
    let is_picture = |view: &View| view.input.scene().is_none();
    let whole = if views.iter().any(is_picture) { size_around(comparison, variants, size) } else { size };
    let no_room =
        || Failure::Usage(format!("{}x{} pixels are too few for the views side by side", size[0], size[1]));
    let places = cells(comparison, variants, whole).ok_or_else(no_room)?;
    let shown = views.iter().zip(&places).enumerate().map(|(i, (view, cell))| {
        Ok::<_, Failure>(view.shown([cell.width, cell.height], drawing, (2 + i, progress))?.0.into_owned())
    });
    let shown = shown.collect::<Result<Vec<_>, _>>()?;
    let rgb8 = compose(comparison, whole, &shown).map_err(|error| Failure::Invalid(error.to_string()))?;
    Ok((whole, rgb8))
}

/// The limits exceeded by the numbers, in words.
fn broken(
    arguments: &Arguments,
    measured: &Measured,
    largest: Option<Largest>,
) -> Result<Vec<String>, Failure> {
    let mut broken = Vec::new();
    for limit in arguments.fail_above.iter().chain(&arguments.fail_below) {
        let Limit { metric, covered, value } = *limit;
        let name = format!("{}{}", if covered { "covered." } else { "" }, metric.id);
        let unknown = |why: &str| Failure::Invalid(format!("{name} cannot be determined: {why}"));
        let metrics = match (covered, &measured.covered) {
            (false, _) => &measured.all,
            (true, Some(covered)) => covered,
            (true, None) => return Err(unknown("no pixel is known to be covered by an object")),
        };
        let found = match metric.way {
            Way::Largest(of) => largest.as_ref().map_or(0.0, of),
            Way::Pixels(..) => metrics
                .of(metric.id)
                .ok_or_else(|| unknown("the linear light of a picture file is unknown"))?,
        };
        let likeness = metric.of_likeness;
        // NaN satisfies no limit.
        let kept = if likeness { found >= value } else { found <= value };
        if !kept {
            let side = if likeness { "below" } else { "above" };
            broken.push(format!("{name} is {found}, {side} the limit {value}"));
        }
    }
    Ok(broken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_name_a_metric_and_its_side() {
        let parts = |limit: Limit| (limit.metric.id, limit.covered, limit.value);
        assert_eq!(above("rmse=0.01").map(parts), Ok(("rmse", false, 0.01)));
        assert_eq!(below("covered.ssim= 0.9").map(parts), Ok(("ssim", true, 0.9)));
        for (said, expected) in [
            (above("rmse"), "it must be METRIC=VALUE, e.g. rmse=0.01"),
            (below("ssim"), "it must be METRIC=VALUE, e.g. ssim=0.99"),
            (
                above("rsme=1"),
                "the metric must be rmse, flip, largest, light_rmse, psnr or ssim; did you mean rmse?",
            ),
            (above("psnr=40"), "psnr falls as pictures differ more; use --fail-below psnr=40"),
            (below("flip=0.1"), "flip grows as pictures differ more; use --fail-above flip=0.1"),
            (above("rmse=small"), "the limit must be a number, e.g. rmse=0.01"),
            (above("rmse=nan"), "the limit must be a number, e.g. rmse=0.01"),
            (above("rmse=inf"), "the limit must be a number, e.g. rmse=0.01"),
            (above("covered.largest=1"), "largest is always that of all pixels; omit covered."),
        ] {
            assert_eq!(said.map(parts), Err(expected.to_owned()));
        }
    }
}
