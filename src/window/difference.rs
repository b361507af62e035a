//! The statistics and the map of a comparison: two views are read back once they are idle, and compared in a separate
//! thread.
//!
//! The display codes are those on screen. Light and object coverage come from the CPU renderer, since the screen does
//! not contain them.

use bevy::{
    asset::RenderAssetUsages,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages},
    window::RequestRedraw,
};

use super::{
    background::Background,
    readback::{Reading, SeenViews},
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
    panel::{
        picture::letters_of_map,
        state::{LARGEST, Numbers, Session},
    },
    progress::Progress,
    registry::Registry,
    render::view::ViewSystems,
    scene::{Comparison, comparison::Compared, variant::LETTERS},
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
    /// Size of the letters of the legend, in pixels.
    letters: Option<f32>,
    /// Number of pictures drawn of each view.
    drawn: [u64; 2],
    textures: [Handle<Image>; 2],
}

impl Question {
    /// Begins to compare the views, which were read back. An obsolete result is dropped.
    fn begin(
        self,
        read: Vec<Vec<u8>>,
        work: &Background<(), Answer>,
        session: &Session,
        registry: &Registry,
    ) {
        let mut views = SeenViews::of(session, &[0, self.with], self.size, registry);
        if self.comparison.values != Compared::Light {
            // The cheapest term also shows the coverage.
            views.shown.iter_mut().for_each(|(_, terms)| *terms = TermSelection::Ambient);
        }
        let job = move |_: &Progress| self.answer(&views, &read).unwrap_or_default();
        work.begin((), || {}, Answer::default(), job);
    }

    /// Compares the views that were read back.
    fn answer(&self, views: &SeenViews, read: &[Vec<u8>]) -> Option<Answer> {
        let is_map = self.comparison.layout.is_map();
        let [a, b] = <[Shown; 2]>::try_from(views.pictures(read, true, is_map).ok()?).ok()?;
        let comparison = Comparison { with: self.with, ..self.comparison };
        let pair = Pair::new(&a, &b).ok()?;
        let largest = pair.differences(&Comparison { sign: Default::default(), ..comparison }).ok();
        let largest = largest.and_then(|d| d.largest).map(|l| (l.difference.abs(), [l.x, l.y]));
        let map = is_map.then(|| pair.map_in_letters(&comparison, self.letters).ok()).flatten();
        Some(Answer { measured: pair.measure(), largest, map })
    }
}

/// The result of the thread.
#[derive(Default)]
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
    work: Background<(), Answer>,
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
    let presenting = session.view.presenting;
    let rest = a.drawing.rests() && b.drawing.rests();
    let mut outdated = true;
    if rest && let (Some(texture_a), Some(texture_b)) = (a.texture(), b.texture()) {
        outdated = !comparing.ask(
            Question {
                // The edge of a wipe does not affect the statistics.
                comparison: Comparison { split: 0.0, ..comparison },
                with,
                size: a.view.size,
                letters: views.area().and_then(|area| letters_of_map(area, a.view.size.y as f32, presenting)),
                drawn: [a.drawing.drawn(), b.drawing.drawn()],
                textures: [texture_a.clone(), texture_b.clone()],
            },
            &mut commands,
        );
    }
    if outdate(&mut session, outdated) {
        settling.draw(SETTLING_FRAMES);
    }
    if comparing.asked.is_some() {
        requests.write(RequestRedraw);
    }
    if comparing.work.running().is_none()
        && let Some(question) = comparing.asked.clone()
        && let Some(codes) = Reading::end(&mut comparing.read, &mut commands)
    {
        question.begin(codes, &comparing.work, &session, &registry);
    }
    let Some(answer) = comparing.work.take() else { return };
    comparing.known = comparing.asked.take();
    let Some(known) = &comparing.known else { return };
    let several = session.document.variants.len() > 1;
    let numbers = numbers(&answer, known.with, several, known.comparison.values);
    session.bypass_change_detection().facts.comparison = Some(numbers);
    if let Some(colours) = answer.map {
        map.0 = Some((images.add(image(&colours, known.size)), known.size));
    }
    settling.draw(SETTLING_FRAMES);
    requests.write(RequestRedraw);
}

/// Marks the numbers as those of pictures before a change, or as those of the present ones. True if that is news.
fn outdate(session: &mut ResMut<Session>, outdated: bool) -> bool {
    let numbers = session.bypass_change_detection().facts.comparison.as_mut();
    numbers.is_some_and(|numbers| std::mem::replace(&mut numbers.outdated, outdated) != outdated)
}

impl Comparing {
    /// Begins to read back views, unless the answer is known or another question is under way. True if it is known.
    fn ask(&mut self, question: Question, commands: &mut Commands) -> bool {
        let known = self.known.as_ref() == Some(&question);
        if self.asked.is_none() && !known {
            self.read = Some(Reading::begin(&question.textures, commands));
            self.asked = Some(question);
        }
        known
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

/// The statistics for display, over the pixels covered by objects; names the views if there are `several` beside A.
fn numbers(answer: &Answer, with: usize, several: bool, values: Compared) -> Numbers {
    let Some(measured) = &answer.measured else { return Numbers::default() };
    let shown = measured.covered.as_ref().unwrap_or(&measured.all);
    let letter = LETTERS.get(with).copied().unwrap_or("B");
    let row = |(id, metric): (&str, &InWindow)| {
        let help = (metric.help)(letter, measured.all.of(id)?);
        Some([metric.name.to_owned(), (metric.text)(shown.of(id)?), help])
    };
    let mut all: Vec<_> = metric::in_window().into_iter().filter_map(row).collect();
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
    Numbers { all, largest: answer.largest.map(|(difference, _)| difference), outdated: false }
}
