//! Saving and copying pictures of the window. Those as the window shows them are read back once the views are idle; others
//! are drawn off screen. The rest happens in a separate thread.

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Duration,
};

use bevy::{prelude::*, window::RequestRedraw, winit::EventLoopProxyWrapper};
use web_time::Instant;

use super::{
    background::Background as Work,
    offscreen::{OffScreen, Undrawn},
    readback::{Reading, SeenViews},
    views::ShownViews,
    watching,
};
use crate::{
    caption::{self, Sampled},
    channel::{DebugChannel, Legend, Setting, layers, too_large},
    compare::{self, Pair, Shown, Unequal, cells, compose, size_around, with_legends, with_row_labels},
    export::write::inputs,
    files::{self, Refused, Shown as _, Signature, words},
    linear::{Format, MAX_PIXELS},
    optics::TermSelection,
    panel::state::{Effect, PictureEnd, PictureOptions, Question, Session, Severity},
    picture::{
        linear,
        png::{self, About},
    },
    platform,
    progress::{Progress, named},
    reference::{Settings, Until, not_on_cpu, render_layers},
    registry::Registry,
    render::view::{Drawing, ViewSystems},
    scene::{
        Background, Comparison, Observer, Scene,
        comparison::{Compared, Layout},
        variant::LETTERS,
    },
};

/// Saves and copies pictures.
#[derive(Clone, Copy, Debug, Default)]
pub struct PicturesPlugin;

impl Plugin for PicturesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Pictures>().add_systems(PostUpdate, take.after(ViewSystems));
    }
}

/// The requested pictures, and the one being written.
#[derive(Debug, Default, Resource)]
struct Pictures {
    /// Requests in their order of arrival.
    wanted: VecDeque<Wanted>,
    reading: Option<Reading>,
    /// The job for the picture that is being read back.
    job: Option<Job>,
    work: Work<(), PictureEnd>,
}

/// A requested picture: of a single view or of all, to a file or to the clipboard.
#[derive(Clone, Debug)]
struct Wanted {
    view: Option<usize>,
    file: Option<PathBuf>,
    since: Instant,
}

/// Maximum time to wait for views: those of a scene that a system moves are never idle.
const PATIENCE: Duration = Duration::from_secs(5);

fn take(
    views: ShownViews,
    registry: Res<Registry>,
    mut effects: MessageReader<Effect>,
    mut session: ResMut<Session>,
    mut pictures: ResMut<Pictures>,
    (mut requests, proxy): (MessageWriter<RequestRedraw>, Option<Res<EventLoopProxyWrapper>>),
    mut commands: Commands,
) {
    for effect in effects.read() {
        if *effect == Effect::CancelPicture {
            pictures.work.cancel();
        }
        let Effect::Picture { view, file, overwrite } = effect.clone() else { continue };
        let meant = file.as_deref().map(|typed| files::meant(typed, "png", |file| signature(file).is_some()));
        // The dialog asked only about the exact name that was typed.
        let (overwrite, file) = (overwrite && file == meant, meant);
        match file.as_deref().map_or(Ok(true), |file| may_write(file, overwrite, &session, &registry)) {
            Ok(true) => {
                let said = file.as_deref().and_then(|file| announcement(file, &session.document, &registry));
                said.into_iter().for_each(|text| session.say(Severity::Info, text));
                pictures.wanted.push_back(Wanted { view, file, since: Instant::now() });
            }
            Ok(false) => {
                let path = file.unwrap_or_default();
                session.questions.ask(Question::ReplacePicture { view, path });
            }
            Err(why) => session.pictured(PictureEnd::Failed(why)),
        }
    }
    if let Some(end) = pictures.work.take() {
        session.pictured(end);
    }
    let wake = || watching::wake(proxy.as_deref());
    match pictures.begin(&views, &session, &registry, &mut commands) {
        Ok(Some(job)) => pictures.start(job, Vec::new(), wake()),
        Ok(None) => {}
        Err(why) => return session.pictured(PictureEnd::Failed(why)),
    }
    let Pictures { reading, job, .. } = &mut *pictures;
    if let Some(read) = job.as_ref().and_then(|_| Reading::end(reading, &mut commands))
        && let Some(job) = job.take()
    {
        pictures.start(job, read, wake());
    }
    if !pictures.wanted.is_empty() || pictures.job.is_some() {
        requests.write(RequestRedraw);
    }
    // What the window shows already is written at once.
    let running = pictures.work.running();
    session.bypass_change_detection().facts.picture = running.filter(|running| !running.step.is_empty());
}

impl Pictures {
    /// Begins the first picture that is wanted. Returns one that is drawn off screen at once; otherwise reads the views back
    /// once they are idle.
    ///
    /// # Errors
    /// Returns why there cannot be such a picture.
    fn begin(
        &mut self,
        views: &ShownViews,
        session: &Session,
        registry: &Registry,
        commands: &mut Commands,
    ) -> Result<Option<Job>, String> {
        let busy = self.job.is_some() || self.work.running().is_some();
        let wanted = self.wanted.front().cloned().filter(|_| !busy);
        let Some(wanted) = wanted else { return Ok(None) };
        let numbers = shown(session, views.cells().iter().map(|cell| cell.view).collect(), wanted.view);
        let found: Option<Vec<_>> = numbers.iter().map(|number| views.find(*number)).collect();
        let begun = Begun { wanted: &wanted, numbers: &numbers, session, registry };
        let whole = wanted.options(session).pixels();
        let of_view = found.as_ref().and_then(|found| found.first()).map(|view| view.view.size);
        let size = match whole {
            Some(whole) => cell_of(&session.document, &numbers, whole),
            None => of_view.ok_or_else(|| not_on_screen(wanted.view)),
        };
        if begun.is_off_screen() || size.is_err() {
            self.wanted.pop_front();
        }
        let size = size?;
        if begun.is_off_screen() {
            return Ok(Some(begun.job(whole, size)));
        }
        let found = found.unwrap_or_default();
        // A converging view becomes idle eventually; one that keeps restarting does not.
        let converges = |drawing: &Drawing| drawing.converged().done > 1 && !drawing.is_done();
        let waits = found.iter().any(|view| converges(view.drawing));
        let late = wanted.since.elapsed() > PATIENCE;
        let rest = found.iter().all(|view| view.drawing.rests()) || !waits && late;
        let textures: Option<Vec<_>> =
            found.iter().map(|view| view.texture().filter(|_| rest).cloned()).collect();
        if let Some(textures) = textures {
            self.reading = Some(Reading::begin(&textures, commands));
            self.job = Some(begun.job(whole, size));
            self.wanted.pop_front();
        }
        Ok(None)
    }

    /// Starts to draw and write a picture, with the pixels that were read back.
    fn start(&self, job: Job, read: Vec<Vec<u8>>, wake: impl Fn() + Send + 'static) {
        let broken = PictureEnd::Failed("The picture was not taken: an internal error.".to_owned());
        self.work.begin((), wake, broken, move |progress| job.run(&read, progress));
    }
}

impl Wanted {
    /// The options of the picture; the clipboard gets it as shown.
    fn options(&self, session: &Session) -> PictureOptions {
        let kept = &session.settings.picture;
        if self.file.is_some() { kept.clone() } else { kept.as_shown() }
    }
}

/// A picture that begins.
struct Begun<'a> {
    wanted: &'a Wanted,
    numbers: &'a [usize],
    session: &'a Session,
    registry: &'a Registry,
}

impl Begun<'_> {
    /// True if it is not what the window shows, so that its views are drawn off screen. Lines over a channel are drawn
    /// by the panels, and do not belong to the views.
    fn is_off_screen(&self) -> bool {
        let Self { wanted, numbers, session, .. } = self;
        let options = wanted.options(session);
        let channels = numbers.iter().filter_map(|view| session.channel_of(*view));
        let is_linear = wanted.file.as_deref().is_some_and(|file| Format::of(file).is_some());
        let is_other = options.pixels().is_some() || options.background.is_some();
        is_other || is_linear || channels.into_iter().any(DebugChannel::has_wires)
    }

    /// The picture with all its inputs; `whole` is its size, if not that of the views, and `size` that of each view.
    fn job(&self, whole: Option<[u32; 2]>, size: UVec2) -> Job {
        let Self { wanted, numbers, session, registry } = *self;
        Job {
            views: SeenViews::of(session, numbers, size, registry),
            channels: numbers.iter().map(|view| session.channel_of(*view)).collect(),
            light: session.channel_light(),
            is_off_screen: self.is_off_screen(),
            whole,
            observer: session.observer_in_file(),
            caption: session.settings.picture_caption,
            options: PictureOptions {
                // Different channels are not compared.
                numbers: session.settings.picture.numbers && session.incomparable().is_none(),
                ..wanted.options(session)
            },
            // A layout that shows a single view also means that view alone.
            alone: wanted.view.is_some() || matches!(*numbers, [shown] if shown > 0),
            file: wanted.file.clone(),
        }
    }
}

/// The reason why a view cannot be taken as it is shown.
fn not_on_screen(view: Option<usize>) -> String {
    let letter = view.and_then(|view| LETTERS.get(view)).copied().unwrap_or_default();
    format!(
        "No picture was taken: view {letter} is not on screen. Choose a layout with it, or a size for the picture."
    )
}

/// The size of each view in a picture of a size.
fn cell_of(scene: &Scene, numbers: &[usize], whole: [u32; 2]) -> Result<UVec2, String> {
    if numbers.len() < 2 {
        return Ok(whole.into());
    }
    let all = cells(&scene.comparison, scene.variants.len(), whole);
    let cell = all.as_deref().and_then(|cells| cells.first());
    let [width, height] = whole;
    cell.map(|cell| UVec2::new(cell.width, cell.height)).ok_or_else(|| {
        format!("No picture was taken: {width}×{height} pixels are too few for the views side by side.")
    })
}

/// The views of the picture, in the order of the layout: those on screen; of alternating views, only the visible one.
fn shown(session: &Session, cells: Vec<usize>, alone: Option<usize>) -> Vec<usize> {
    let blinks = session.document.comparison.layout.is_in_turn();
    match (alone, cells.as_slice()) {
        (Some(view), _) => vec![view],
        (None, []) => vec![0],
        (None, [first, second, ..]) if blinks => {
            vec![if session.view.blinking { *second } else { *first }]
        }
        (None, _) => cells,
    }
}

/// The format of a picture with this name.
fn signature(file: &Path) -> Option<Signature> {
    let is_png = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    Format::of(file).map(Format::signature).or(is_png.then_some(files::PNG))
}

/// Returns false if the file exists, so that the user must be asked.
fn may_write(file: &Path, overwrite: bool, session: &Session, registry: &Registry) -> Result<bool, String> {
    let Some(format) = signature(file) else {
        let png = file.with_extension("png");
        return Err(format!(
            "The picture was not saved to {}: only PNG, OpenEXR (.exr) and Radiance (.hdr) files can be written; name it {}.",
            file.shown(),
            png.file_name().unwrap_or_default().to_string_lossy()
        ));
    };
    let inputs = inputs(session.path.as_deref(), [session.document.scene()], registry);
    match files::may_replace(file, format, overwrite, &inputs) {
        Ok(()) => Ok(true),
        Err(Refused::Exists { .. }) => Ok(false),
        Err(refused) => Err(format!("The picture was not saved: {refused}.")),
    }
}

/// The message that a linear picture takes long, if it does.
fn announcement(file: &Path, scene: &Scene, registry: &Registry) -> Option<String> {
    let takes_long = Format::of(file).is_some() && scene.rests_on_samples(registry);
    takes_long.then(|| format!("{} is drawn on the CPU with its layers, which takes a while.", file.shown()))
}

/// A picture with all its inputs.
#[derive(Debug)]
struct Job {
    views: SeenViews,
    /// The debug channel of each view.
    channels: Vec<Option<DebugChannel>>,
    /// The light of channels, if one is chosen.
    light: Option<usize>,
    /// True if its views are drawn off screen.
    is_off_screen: bool,
    /// The size of the picture, if not that of the views.
    whole: Option<[u32; 2]>,
    /// The observer of the scene in the file, and why it is not at the camera.
    observer: (Observer, Option<&'static str>),
    caption: bool,
    options: PictureOptions,
    /// True for a picture of a single view, even if the scene has others.
    alone: bool,
    file: Option<PathBuf>,
}

/// A picture as drawn.
struct Drawn {
    /// The RGB pixels.
    rgb8: Vec<u8>,
    size: [u32; 2],
    /// The sampling of lights with extent, in words; empty without them.
    light: String,
    renderer: &'static str,
}

/// The pictures of the views, and how they were drawn.
struct Views {
    pictures: Vec<Shown>,
    sampled: Vec<Sampled>,
    renderer: &'static str,
}

/// A view of a picture: its number, its scene, and its visible terms.
type Seen = (usize, Scene, TermSelection);

impl Job {
    fn run(self, read: &[Vec<u8>], progress: &Progress) -> PictureEnd {
        match self.end(read, progress) {
            Ok(end) => end,
            Err(Undrawn::Cancelled) => PictureEnd::Cancelled,
            Err(Undrawn::Failed(why)) => PictureEnd::Failed(why),
        }
    }

    fn end(&self, read: &[Vec<u8>], progress: &Progress) -> Result<PictureEnd, Undrawn> {
        let Some(file) = &self.file else {
            let Drawn { rgb8, size, .. } = self.draw(read, progress)?;
            return copy(&rgb8, size).map(|()| PictureEnd::Copied(size)).map_err(Undrawn::Failed);
        };
        let unsaved = |why| match why {
            Undrawn::Failed(why) => {
                Undrawn::Failed(format!("The picture was not saved to {}: {why}.", file.shown()))
            }
            cancelled => cancelled,
        };
        match Format::of(file) {
            Some(format) => self.save_linear(file, format, progress).map_err(unsaved)?,
            None => {
                let drawn = self.draw(read, progress).map_err(unsaved)?;
                self.save(file, &drawn).map_err(Undrawn::Failed)?;
            }
        }
        Ok(PictureEnd::Saved { path: file.clone(), elsewhere: self.observer.1 })
    }

    /// The arrangement of the views.
    fn comparison(&self) -> Comparison {
        let comparison = self.views.scene.comparison;
        if self.views.shown.len() > 1 {
            comparison
        } else {
            Comparison { layout: Layout::Single, ..comparison }
        }
    }

    /// A scene with the background of the picture.
    fn with_background(&self, mut scene: Scene) -> Scene {
        if let Some(colour) = self.options.background {
            (scene.display.background, scene.display.background_colour) = (Background::Colour, colour);
        }
        scene
    }

    /// The setting of the channel of a view, by its place in the picture: that with which the window draws it.
    fn setting(&self, place: usize) -> Option<Setting> {
        let SeenViews { scene, registry, camera, .. } = &self.views;
        let channel = self.channels.get(place).copied().flatten()?;
        Some(Setting::new(channel, scene, registry, camera.position, self.light))
    }

    fn draw(&self, read: &[Vec<u8>], progress: &Progress) -> Result<Drawn, Undrawn> {
        let SeenViews { scene, registry, shown, size, .. } = &self.views;
        let comparison = self.comparison();
        let has_numbers = self.caption && self.options.numbers && shown.len() > 1;
        let is_map = comparison.layout.is_map();
        let lit = is_map && comparison.values == Compared::Light || has_numbers;
        let seen = |(view, terms): &(usize, TermSelection)| {
            Some((*view, self.with_background(self.views.seen(*view)?), *terms))
        };
        let seen: Vec<Seen> = shown.iter().filter_map(seen).collect();
        let Views { pictures, sampled, renderer } = match self.is_off_screen {
            true => self.off_screen(&seen, (lit, is_map), progress)?,
            false => {
                let pictures = self.views.pictures(read, lit, is_map).map_err(Undrawn::Failed)?;
                Views { pictures, sampled: Vec::new(), renderer: "GPU" }
            }
        };
        let size = match (self.whole, comparison.layout) {
            (Some(whole), _) => whole,
            (None, Layout::Single) => size.to_array(),
            (None, _) => size_around(&comparison, scene.variants.len(), size.to_array()),
        };
        let rgb8 = self.composed(&comparison, size, &pictures, &seen)?;
        let light = caption::line(&caption::sampled(&sampled));
        if !self.caption {
            return Ok(Drawn { rgb8, size, light, renderer });
        }
        let of_views: Vec<_> = seen.iter().map(|(view, seen, terms)| (*view, seen, *terms)).collect();
        let mut caption = caption::of_picture(scene, &of_views, registry).resting_on(&sampled);
        if has_numbers {
            progress.step(1.0, "comparing the views")?;
            let views: Vec<_> = shown.iter().map(|(view, _)| *view).collect();
            caption.facts.extend(compare::numbers(&views, &pictures));
        }
        let (rgb8, size) = caption::draw(&caption, rgb8, size);
        Ok(Drawn { rgb8, size, light, renderer })
    }

    /// The views, drawn off screen: lit, and for a map with the outlines of the objects of the first.
    fn off_screen(
        &self,
        seen: &[Seen],
        (lit, is_map): (bool, bool),
        progress: &Progress,
    ) -> Result<Views, Undrawn> {
        let SeenViews { registry, size, .. } = &self.views;
        let mut all = Views { pictures: Vec::new(), sampled: Vec::new(), renderer: "CPU" };
        for (place, (view, scene, terms)) in seen.iter().enumerate() {
            let letter = LETTERS.get(*view).filter(|_| seen.len() > 1);
            let name =
                |step: &str| letter.map_or(step.to_owned(), |letter| named(&format!("view {letter}"), step));
            let view = OffScreen {
                seen: scene,
                registry,
                size: size.to_array(),
                samples: self.options.samples(),
                terms: *terms,
                channel: self.setting(place),
                lit,
            };
            let (picture, sampled) = progress.part((place, seen.len()), name, |part| view.draw(part))?;
            let outlined = is_map && all.pictures.is_empty();
            all.pictures.push(if outlined { picture.outlined(scene, registry) } else { picture });
            all.sampled.extend(sampled);
            if view.needs_gpu() {
                all.renderer = "GPU";
            }
        }
        Ok(all)
    }

    /// The picture of a size, of those of its views, with the labels of rows and with legends.
    fn composed(
        &self,
        comparison: &Comparison,
        size: [u32; 2],
        pictures: &[Shown],
        seen: &[Seen],
    ) -> Result<Vec<u8>, Undrawn> {
        let (variants, registry) = (self.views.scene.variants.len(), &self.views.registry);
        let failed = |error: Unequal| Undrawn::Failed(error.to_string());
        let rgb8 = match pictures {
            [] => return Err(Undrawn::Failed("there are no views".to_owned())),
            [a, b, ..] if comparison.layout.is_map() && !self.options.legend => {
                Pair::new(a, b).and_then(|pair| pair.bare_map(comparison)).map_err(failed)?
            }
            all => compose(comparison, size, all).map_err(failed)?,
        };
        let legends = self.options.legend && !comparison.layout.is_map();
        let legends: Vec<_> =
            seen.iter().enumerate().filter(|_| legends).map(|(i, seen)| self.legend(i, seen)).collect();
        let rgb8 = if legends.iter().any(Option::is_some) {
            with_legends(comparison, rgb8, size, &legends)
        } else {
            rgb8
        };
        let cells = cells(comparison, variants, size).unwrap_or_default();
        let places = cells.into_iter().zip(seen.iter().map(|(_, seen, _)| seen));
        Ok(with_row_labels(rgb8, size, places, registry))
    }

    /// The legend of a view's channel, if it shows one; with the letter of the view if there are several.
    fn legend(&self, place: usize, (view, seen, _): &Seen) -> Option<Legend> {
        let mut legend = self.setting(place)?.legend(seen, &self.views.registry);
        if let Some(letter) = LETTERS.get(*view).filter(|_| self.views.shown.len() > 1) {
            legend.title = format!("{letter} · {}", legend.title);
        }
        Some(legend)
    }

    fn save(&self, file: &Path, drawn: &Drawn) -> Result<(), String> {
        let Drawn { rgb8, size: [width, height], light, renderer } = drawn;
        let about = About::scene(&self.pictured(), &self.views.registry).with("Renderer", *renderer);
        let about = if light.is_empty() { about } else { about.with("Light", light.as_str()) };
        png::write(file, *width, *height, rgb8, &about)
            .map_err(|error| format!("{} could not be written: {}.", file.shown(), words(&error)))
    }

    /// Writes the light of the view as the CPU renderer draws it; to an OpenEXR file with the chosen layers.
    fn save_linear(&self, file: &Path, format: Format, progress: &Progress) -> Result<(), Undrawn> {
        let failed = |why: &str| Undrawn::Failed(why.to_owned());
        let SeenViews { registry, shown, size, .. } = &self.views;
        let [(view, terms)] = shown[..] else {
            return Err(failed("it holds the light of one view; save the view alone"));
        };
        let seen = self.views.seen(view).ok_or_else(|| failed("the view is no longer there"))?;
        if let Some((model, why)) = not_on_cpu(&seen, registry) {
            let command = "lcm render --renderer gpu -o FILE.exr draws it";
            let id = model.declaration.id;
            return Err(Undrawn::Failed(format!("the CPU cannot run {id}: {why}; {command}")));
        }
        let kinds = if format == Format::Exr { self.options.kinds() } else { Vec::new() };
        let layers = layers(&seen, terms, &kinds, registry);
        let [width, height] = size.to_array();
        if width as usize * height as usize > MAX_PIXELS {
            let said = format!("{width}×{height} are more pixels than it can hold; at most {MAX_PIXELS} are");
            return Err(Undrawn::Failed(said));
        }
        if let Some(why) = too_large(&layers, format, [width, height]) {
            return Err(Undrawn::Failed(format!("{why}; choose fewer layers or a smaller size")));
        }
        let samples = self.options.samples();
        let settings = Settings { width, height, terms, samples };
        let odd = AtomicBool::default();
        let (channels, _) =
            render_layers(&layers, &seen, registry, &settings, Until::default(), &odd, progress)?;
        let about = About::scene(&self.pictured(), registry).with("Renderer", "CPU");
        linear::write(file, format, &channels, &about).map_err(|error| Undrawn::Failed(words(&error)))
    }

    /// The scene of the picture, with the observer at the camera if it can be there, so that opening the picture shows the
    /// same view.
    fn pictured(&self) -> Scene {
        let SeenViews { scene, registry, shown, .. } = &self.views;
        let alone = shown.first().filter(|_| self.alone);
        let alone = alone.and_then(|(view, _)| scene.seen(*view, registry));
        let mut scene = alone.map_or_else(|| scene.clone(), |(seen, _)| seen.alone());
        scene.observer = self.observer.0;
        self.with_background(scene)
    }
}

/// Copies a picture to the clipboard.
fn copy(rgb8: &[u8], size: [u32; 2]) -> Result<(), String> {
    let rgba: Vec<u8> = rgb8.as_chunks::<3>().0.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let copied = platform::copy_picture(rgba, size);
    copied.map_err(|error| format!("The picture was not copied: {error}. Save it instead."))
}
