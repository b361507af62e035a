//! The statistics and the map of a comparison: two views are read back once they are idle, and compared in a separate
//! thread.
//!
//! The display codes are those on screen. Light and object coverage come from the CPU renderer, since the screen does
//! not contain them.

use bevy::{
    app::{App, Plugin, PostUpdate},
    asset::{Assets, Handle, RenderAssetUsages},
    ecs::prelude::*,
    image::Image,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages},
    window::RequestRedraw,
};
use glam::UVec2;

use super::{
    background::Background,
    readback::{Reading, codes},
    redraw::{SETTLING_FRAMES, Settling},
    views::{DifferenceMap, ShownViews},
};
use crate::{
    compare::{
        Measured, Pair, Shown,
        metric::{self, InWindow},
        short,
    },
    optics::TermSelection,
    panel::state::{LARGEST, Numbers, Session},
    reference::{self, Picture, Settings},
    registry::Registry,
    render::view::ViewSystems,
    scene::{Comparison, Observer, Scene, comparison::Compared, variant::LETTERS},
};

/// Compares the views of a comparison.
#[derive(Clone, Copy, Debug, Default)]
pub struct DifferencePlugin;

impl Plugin for DifferencePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Comparing>()
            .init_resource::<DifferenceMap>()
            .init_resource::<Settling>()
            .add_systems(PostUpdate, compare.after(ViewSystems));
    }
}

/// Inputs of a comparison.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    comparison: Comparison,
    /// The view compared with A.
    with: usize,
    size: UVec2,
    /// Number of pictures drawn of each view.
    drawn: [u64; 2],
    textures: [Handle<Image>; 2],
}

/// The result of the thread.
struct Answer {
    measured: Option<Measured>,
    largest: Option<(f32, [u32; 2])>,
    map: Option<Vec<u8>>,
}

/// The running comparison, and the finished one.
#[derive(Default, Resource)]
struct Comparing {
    asked: Option<Question>,
    known: Option<Question>,
    read: Option<Reading>,
    /// The result is `None` if the comparison crashed.
    work: Background<(), Option<Answer>>,
}

fn compare(
    views: ShownViews,
    registry: Res<Registry>,
    mut session: ResMut<Session>,
    mut comparing: ResMut<Comparing>,
    mut map: ResMut<DifferenceMap>,
    mut images: ResMut<Assets<Image>>,
    mut settling: ResMut<Settling>,
    mut requests: MessageWriter<RequestRedraw>,
    mut commands: Commands,
) {
    let comparison = session.document.comparison;
    let with = session.compared_with();
    let comparable = views.cells().len() > 1 && session.incomparable().is_none();
    let both = comparable.then(|| views.find(0).zip(views.find(with))).flatten();
    let Some((a, b)) = both else {
        session.bypass_change_detection().facts.comparison = None;
        map.0 = None;
        return forget(&mut comparing, &mut commands);
    };
    let rest = a.drawing.rests() && b.drawing.rests();
    if rest && let (Some(texture_a), Some(texture_b)) = (a.texture(), b.texture()) {
        comparing.ask(
            Question {
                // The edge of a wipe does not affect the statistics.
                comparison: Comparison { split: 0.0, ..comparison },
                with,
                size: a.view.size,
                drawn: [a.drawing.drawn(), b.drawing.drawn()],
                textures: [texture_a.clone(), texture_b.clone()],
            },
            &mut commands,
        );
    }
    if comparing.asked.is_some() {
        requests.write(RequestRedraw);
    }
    if comparing.work.running().is_none()
        && let Some(question) = comparing.asked.clone()
        && let Some(codes) = Reading::end(&mut comparing.read, &mut commands)
    {
        let job = Job::of(question, codes, &session, &registry);
        // An obsolete result is dropped.
        comparing.work.begin((), || {}, || None, move |_| Some(job.run()));
    }
    let Some(answer) = comparing.work.take() else { return };
    comparing.known = comparing.asked.take();
    let (Some(answer), Some(known)) = (answer, &comparing.known) else { return };
    let several = session.document.variants.len() > 1;
    let size = known.size;
    let numbers = numbers(&answer, known.with, several, known.comparison.values);
    session.bypass_change_detection().facts.comparison = Some(numbers);
    if let Some(colours) = answer.map {
        map.0 = Some((images.add(image(&colours, size)), size));
    }
    settling.draw(SETTLING_FRAMES);
    requests.write(RequestRedraw);
}

impl Comparing {
    /// Begins to read back views, unless the answer is known or another question is under way.
    fn ask(&mut self, question: Question, commands: &mut Commands) {
        if self.asked.is_none() && self.known.as_ref() != Some(&question) {
            self.read = Some(Reading::begin(&question.textures, commands));
            self.asked = Some(question);
        }
    }
}

/// The image of a map of colours.
fn image(colours: &[u8], size: UVec2) -> Image {
    let rgba = colours.as_chunks::<3>().0.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let mut image = Image::new(
        Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
        TextureDimension::D2,
        rgba,
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    image
}

/// Ends the comparison and forgets its result.
fn forget(comparing: &mut ResMut<Comparing>, commands: &mut Commands) {
    if comparing.asked.is_none() && comparing.known.is_none() {
        return;
    }
    if let Some(reading) = comparing.read.take() {
        reading.abandon(commands);
    }
    **comparing = Comparing::default();
}

/// Inputs of the thread.
struct Job {
    question: Question,
    codes: Vec<Vec<u8>>,
    scene: Scene,
    /// The visible terms of view A and of the other view.
    terms: [TermSelection; 2],
    camera: Observer,
    registry: Registry,
}

impl Job {
    fn of(question: Question, codes: Vec<Vec<u8>>, session: &Session, registry: &Registry) -> Self {
        Self {
            terms: [0, question.with].map(|view| session.terms_of(view)),
            question,
            codes,
            scene: (*session.document).clone(),
            camera: session.facts.observer(session.document.observer),
            registry: registry.clone(),
        }
    }

    fn run(self) -> Answer {
        let size = self.question.size;
        let shown: Vec<Shown> = [0, self.question.with]
            .into_iter()
            .zip(self.terms)
            .zip(&self.codes)
            .filter_map(|((view, terms), bytes)| {
                let codes = codes(bytes, size)?;
                Shown::of_codes(size.x, size.y, codes).ok()?.with_light(self.light(view, terms)?).ok()
            })
            .collect();
        let nothing = Answer { measured: None, largest: None, map: None };
        let Ok([a, b]) = <[Shown; 2]>::try_from(shown) else { return nothing };
        let is_map = self.question.comparison.layout.is_map();
        let a = if is_map { self.outlined(a) } else { a };
        let comparison = Comparison { with: self.question.with, ..self.question.comparison };
        let Ok(pair) = Pair::new(&a, &b) else { return nothing };
        let largest = pair.differences(&Comparison { sign: Default::default(), ..comparison }).ok();
        let largest = largest.and_then(|d| d.largest).map(|l| (l.difference.abs(), [l.x, l.y]));
        let map = is_map.then(|| pair.map(&comparison).ok()).flatten();
        Answer { measured: pair.measure(), largest, map }
    }

    /// View A with the outlines of its objects.
    fn outlined(&self, shown: Shown) -> Shown {
        let Some((seen, _)) = self.scene.seen(0, &self.registry) else { return shown };
        let observer = self.camera.fitting(self.question.size.to_array(), self.scene.view_angle());
        shown.outlined(&Scene { observer, ..seen }, &self.registry)
    }

    /// The light of a view, as seen by the camera of the window.
    fn light(&self, view: usize, terms: TermSelection) -> Option<Picture> {
        let (seen, _) = self.scene.seen(view, &self.registry)?;
        // The cheapest term also shows the coverage.
        let terms =
            if self.question.comparison.values == Compared::Light { terms } else { TermSelection::Ambient };
        let size = self.question.size;
        let camera = self.camera.fitting(size.to_array(), self.scene.view_angle());
        Some(light(seen, camera, size, terms, &self.registry))
    }
}

/// The light of a scene, as seen by a camera.
pub(super) fn light(
    seen: Scene,
    camera: Observer,
    size: UVec2,
    terms: TermSelection,
    registry: &Registry,
) -> Picture {
    let seen = Scene { observer: camera, ..seen };
    let settings = Settings { width: size.x, height: size.y, samples: 1, terms };
    reference::render(&seen, registry, &settings)
}

/// The statistics for display, over the pixels covered by objects; names the views if there are `several` beside A.
fn numbers(answer: &Answer, with: usize, several: bool, values: Compared) -> Numbers {
    let Some(measured) = &answer.measured else { return Numbers::default() };
    let shown = measured.covered.as_ref().unwrap_or(&measured.all);
    let letter = LETTERS.get(with).copied().unwrap_or("B");
    let mut known: Vec<_> = metric::ALL.iter().filter_map(|m| Some((m.id, m.shown.as_ref()?))).collect();
    known.sort_by_key(|(_, metric)| metric.place);
    let row = |(id, metric): (&str, &InWindow)| {
        let help = (metric.help)(letter, measured.all.of(id)?);
        Some([metric.name.to_owned(), (metric.text)(shown.of(id)?), help])
    };
    let mut all: Vec<_> = known.into_iter().filter_map(row).collect();
    if several {
        let help = format!("The numbers are about views {letter} and A. Click another view to compare it.");
        all.insert(0, [format!("{letter} to A"), String::new(), help]);
    }
    if let Some((difference, [x, y])) = answer.largest {
        let unit = if values == Compared::Codes { " of 255" } else { "" };
        let help = format!(
            "The largest difference, in the channel and the values that are chosen: at pixel {x}, {y}."
        );
        all.push([LARGEST.to_owned(), format!("{}{unit}", short(difference)), help]);
    }
    Numbers { all, largest: answer.largest.map(|(difference, _)| difference) }
}
