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
    views::{DifferenceMap, ShownView, ShownViews, show_views},
};
use crate::{
    compare::{
        Measured, Pair, Shown,
        metric::{self, InWindow},
        short,
    },
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
            .add_systems(PostUpdate, compare.after(ViewSystems).before(show_views));
    }
}

/// Inputs of a comparison: while they are the same, so are the pictures.
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
    /// The inputs of a comparison of views as they are on screen; `None` while one of them changes or converges.
    fn of(views: &ShownViews, [a, b]: [ShownView<'_>; 2], session: &Session) -> Option<Self> {
        // Objects that wait for a shader still have their previous appearance.
        let compiles = [0, session.compared_with()].into_iter().any(|view| session.compiles(view));
        let rest = a.drawing.rests() && b.drawing.rests() && !compiles;
        let textures = [a.texture()?.clone(), b.texture()?.clone()];
        let letters = |area| letters_of_map(area, a.view.size.y as f32);
        rest.then(|| Self {
            // The edge of a wipe does not affect the statistics.
            comparison: Comparison { split: 0.0, ..session.document.comparison },
            with: session.compared_with(),
            size: a.view.size,
            letters: views.area().and_then(letters),
            drawn: [a.drawing.drawn(), b.drawing.drawn()],
            textures,
        })
    }

    /// Begins to compare the views, which were read back. An obsolete result is dropped.
    fn begin(
        self,
        read: Vec<Vec<u8>>,
        work: &Background<(), Answer>,
        session: &Session,
        registry: &Registry,
    ) {
        let views = SeenViews::of(session, &[0, self.with], self.size, registry);
        let job = move |_: &Progress| self.answer(&views, &read).unwrap_or_default();
        work.begin((), || {}, Answer::default(), job);
    }

    /// Compares the views that were read back.
    fn answer(&self, views: &SeenViews, read: &[Vec<u8>]) -> Option<Answer> {
        let is_map = self.comparison.layout.is_map();
        let is_of_light = self.comparison.values == Compared::Light;
        let [a, b] = <[Shown; 2]>::try_from(views.pictures(read, is_of_light, is_map).ok()?).ok()?;
        // Without their light, which takes long, the coverage is not known yet.
        let (seen_a, seen_b) = (views.seen(0)?, views.seen(self.with)?);
        let a = a.covering_objects(&seen_a, &views.registry, 1);
        let b = b.covering_objects(&seen_b, &views.registry, 1);
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

/// The result for the window.
struct Finding {
    numbers: Numbers,
    map: Option<(Handle<Image>, UVec2)>,
}

/// The running comparison, and the finished one.
#[derive(Default, Resource)]
struct Comparing {
    asked: Option<Question>,
    known: Option<(Question, Finding)>,
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
    let comparable = views.cells().len() > 1 && session.incomparable().is_none();
    let both = comparable.then(|| views.find(0).zip(views.find(session.compared_with()))).flatten();
    let Some((a, b)) = both else {
        session.bypass_change_detection().facts.comparison = None;
        map.0 = None;
        return forget(&mut comparing, &mut commands);
    };
    let present = Question::of(&views, [a, b], &session);
    comparing.end(&session, &mut images);
    comparing.ask(present.as_ref(), &mut commands);
    if let Some(question) = comparing.asked.clone() {
        requests.write(RequestRedraw);
        if comparing.work.running().is_none()
            && let Some(codes) = Reading::end(&mut comparing.read, &mut commands)
        {
            question.begin(codes, &comparing.work, &session, &registry);
        }
    }
    let facts = &mut session.bypass_change_detection().facts;
    if comparing.show(present.as_ref(), &mut facts.comparison, &mut map) {
        settling.draw(SETTLING_FRAMES);
        requests.write(RequestRedraw);
    }
}

impl Comparing {
    /// Keeps the result of the thread, if it has just ended.
    fn end(&mut self, session: &Session, images: &mut ResMut<Assets<Image>>) {
        let Some(answer) = self.work.take() else { return };
        let Some(asked) = self.asked.take() else { return };
        let several = session.document.variants.len() > 1;
        let numbers = numbers(&answer, asked.with, several, asked.comparison.values);
        let map = answer.map.map(|colours| (images.add(image(&colours, asked.size)), asked.size));
        self.known = Some((asked, Finding { numbers, map }));
    }

    /// Begins to read back the views, unless their comparison is known or under way. Gives up reading views that have
    /// changed since.
    fn ask(&mut self, present: Option<&Question>, commands: &mut Commands) {
        if self.asked.as_ref() != present
            && let Some(reading) = self.read.take()
        {
            reading.abandon(commands);
            self.asked = None;
        }
        let Some(question) = present else { return };
        let is_known = self.known.as_ref().is_some_and(|(known, _)| known == question);
        if self.asked.is_none() && !is_known {
            self.read = Some(Reading::begin(&question.textures, commands));
            self.asked = Some(question.clone());
        }
    }

    /// Shows the result if it was made of the pictures on screen, and nothing otherwise. True if that is news.
    fn show(
        &self,
        present: Option<&Question>,
        numbers: &mut Option<Numbers>,
        map: &mut DifferenceMap,
    ) -> bool {
        let known = self.known.as_ref().filter(|(made_of, _)| Some(made_of) == present);
        let now = known.map(|(_, finding)| finding.numbers.clone());
        let now = (now, DifferenceMap(known.and_then(|(_, finding)| finding.map.clone())));
        let is_news = *numbers != now.0 || *map != now.1;
        (*numbers, *map) = now;
        is_news
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
    Numbers { all, largest: answer.largest.map(|(difference, _)| difference) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_shown_only_while_the_pictures_are_those_that_it_was_made_of() {
        let question = Question {
            comparison: Comparison::default(),
            with: 1,
            size: UVec2::new(4, 3),
            letters: None,
            drawn: [258, 258],
            textures: Default::default(),
        };
        let found = Numbers { all: vec![["RMSE", "0.000", "help"].map(str::to_owned)], largest: None };
        let map = Some((Handle::default(), question.size));
        let finding = Finding { numbers: found.clone(), map: map.clone() };
        let comparing = Comparing { known: Some((question.clone(), finding)), ..Comparing::default() };
        let (mut numbers, mut shown) = (None, DifferenceMap::default());
        let mut show = |present: Option<&Question>| {
            let is_news = comparing.show(present, &mut numbers, &mut shown);
            (is_news, numbers.clone(), shown.0.clone())
        };
        assert_eq!(show(Some(&question)), (true, Some(found.clone()), map.clone()));
        assert_eq!(show(Some(&question)), (false, Some(found.clone()), map.clone()));
        assert_eq!(show(None), (true, None, None), "a view changes, or converges");
        let mut of_b = question.clone();
        of_b.drawn[1] += 258;
        assert_eq!(show(Some(&of_b)), (false, None, None), "B has converged to something else");
        assert_eq!(show(Some(&question)), (true, Some(found), map));
    }

    #[test]
    fn views_that_have_changed_are_not_compared_once_they_are_read() {
        let question = |drawn| Question {
            comparison: Comparison::default(),
            with: 1,
            size: UVec2::new(4, 3),
            letters: None,
            drawn,
            textures: Default::default(),
        };
        let mut world = World::new();
        let mut comparing = Comparing::default();
        let mut ask = |present: Option<Question>| {
            comparing.ask(present.as_ref(), &mut world.commands());
            world.flush();
            (comparing.asked.as_ref().map(|asked| asked.drawn), comparing.read.is_some())
        };
        assert_eq!(ask(Some(question([2, 2]))), (Some([2, 2]), true));
        assert_eq!(ask(None), (None, false), "a view is drawn anew");
        assert_eq!(ask(Some(question([2, 4]))), (Some([2, 4]), true));
        assert_eq!(ask(Some(question([4, 4]))), (Some([4, 4]), true));
    }
}
