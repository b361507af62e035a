//! The explained pixel, and its explanation, which is calculated only while it is visible and something has changed.

use std::collections::{HashMap, HashSet};

use super::{
    held::{Held, Holding},
    rows,
};
use crate::{
    document::Revision,
    explain::{Explainer, Explanation, Influence, Knob, Line, Lit, Model, Seen, Sight, Spot},
    library::status::Reloaded,
    optics::TermSelection,
    panel::{is_in_sight, keys, marks::Lens, prelude::*, state::Pin},
    reference::{LightSamples, Settings, ignored_edits},
    scene::Observer,
};

/// Tolerance for the centre of the pinned pixel to show the held point, in metres.
const SAME: f32 = 1e-4;
/// Distance of a click from the pinned point that unpins it, in points.
const NEAR: f32 = 6.0;

/// The explanation of a pixel of the window.
#[derive(Debug)]
pub struct Explained {
    /// The view: 0 is the scene itself, 1 view B.
    pub view: usize,
    /// The explanation.
    pub explanation: Explanation,
    /// Visibility of the pinned point; `None` if the point is at the centre of the pixel.
    pub sight: Option<Sight>,
    /// Paths of edited shaders that affect the picture but not the explanation.
    pub ignored: Vec<String>,
    /// True if the light is that for an earlier place of the observer, whose ray is looked at from the side.
    pub aside: bool,
}

/// The light whose block is unfolded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Unfolded {
    /// The light that contributes most.
    #[default]
    Brightest,
    /// The light with this index in the scene.
    Light(usize),
    /// No light.
    None,
}

/// The level of detail of an explanation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Level {
    /// A sentence that reports the event.
    Sentence,
    /// The equation with numbers.
    #[default]
    Equation,
    /// Each factor with its own equation, plot and source.
    Factors,
}

impl Level {
    pub(super) const ALL: [Self; 3] = [Self::Sentence, Self::Equation, Self::Factors];
}

/// Display options of an explanation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Choice {
    /// The level of detail.
    pub(super) level: Level,
    /// True if another view is explained beside it.
    pub(super) beside: bool,
    /// Index of the point among [`spots`]; by default the one with the largest weight.
    pub(super) spot: Option<usize>,
    pub(super) light: Unfolded,
    /// Index of the number of samples of lights with extent among [`SAMPLES`].
    pub(super) samples: usize,
}

/// The choice of samples of lights with extent: those of the picture first.
pub(super) const SAMPLES: [u32; 4] = [LightSamples::DEFAULT, 1024, 4096, 16_384];

/// Inputs of an explanation.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    revision: Revision,
    /// The line of sight.
    pin: Pin,
    /// The point held by the pin, even if the line of sight misses it.
    held: Option<Held>,
    /// The view of the pin, and other views in which the point is shown too.
    views: Vec<Shown>,
    /// True if another view is explained beside it.
    beside: bool,
    /// Samples of lights with extent.
    samples: u32,
    /// The camera, or where it was before the ray was looked at from the side.
    observer: Observer,
    /// True if it was.
    aside: bool,
    /// The latest successful shader reload.
    reloaded: Option<Reloaded>,
}

/// A picture of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    view: usize,
    size: [u32; 2],
    terms: TermSelection,
}

#[derive(Default)]
struct Probe {
    /// Latest position of the pointer.
    pointed: Option<Pin>,
    /// The explained pin.
    pin: Option<Pin>,
    /// True if the pointer is at the pin.
    hovered: bool,
    asked: Option<Question>,
    answer: Option<Arc<Explained>>,
    /// Explanations of the same point in the other views.
    beside: Vec<Arc<Explained>>,
    holding: Holding,
    /// The number of a pin within a body and the observer whose ray it holds while it is looked at from the side.
    seen_from: Option<(u64, Observer)>,
    calculations: u64,
    explainer: Explainer,
    /// Scenes of views, without the camera of the window.
    scenes: Vec<(Revision, usize, Scene)>,
    choice: Choice,
    /// Number of the frame of the latest toggle, counted from 1.
    turned: u64,
    /// The unfolded quantities.
    unfolded: HashSet<String>,
    /// The quantity to scroll to.
    sought: Option<String>,
    /// The pixel before its numbers were changed in the panel: its pin and display code.
    before: Option<(Pin, [u8; 3])>,
    /// Equation lines of the lights of one explanation, by address.
    lines: (u64, HashMap<usize, Arc<Vec<Line>>>),
    /// The listed numbers, in their order at the time when the pixel was chosen.
    ranking: Option<(Pin, Vec<Knob>)>,
    /// The numbers that change the pixel, for one explanation.
    influences: Option<(u64, Arc<Vec<Influence>>)>,
}

fn with<R>(ctx: &Context, of: impl FnOnce(&mut Probe) -> R) -> R {
    kept::shared(ctx, of)
}

/// The current explanation; `None` if there is none or the panel is closed.
#[must_use]
pub fn explained(ctx: &Context) -> Option<Arc<Explained>> {
    with(ctx, |probe| probe.answer.clone())
}

/// The explanation of the same point in another view, if both are shown side by side.
pub(super) fn other(ctx: &Context) -> Option<Arc<Explained>> {
    with(ctx, |probe| {
        let own = probe.answer.as_ref()?.view;
        probe.beside.iter().find(|e| probe.choice.beside && e.view == beside_of(own)).cloned()
    })
}

/// The view that is explained beside the given one.
fn beside_of(view: usize) -> usize {
    if view == 0 { 1 } else { 0 }
}

/// The current explanation for a view: of the explained pixel, or of the same point if the view is beside it.
pub(super) fn explained_in(ctx: &Context, view: usize) -> Option<Arc<Explained>> {
    with(ctx, |probe| probe.answer.iter().chain(&probe.beside).find(|e| e.view == view).cloned())
}

/// Number of explanations calculated so far.
#[must_use]
pub fn calculations(ctx: &Context) -> u64 {
    with(ctx, |probe| probe.calculations)
}

/// True while the pointer is at the explained pixel.
pub(super) fn is_hovered(ctx: &Context) -> bool {
    with(ctx, |probe| probe.hovered)
}

pub(super) fn choice(ctx: &Context) -> Choice {
    with(ctx, |probe| probe.choice)
}

/// True once per frame. Guards toggles, since egui may lay out a frame twice with the same click.
pub(super) fn once(ctx: &Context) -> bool {
    let frame = ctx.cumulative_frame_nr() + 1;
    with(ctx, |probe| std::mem::replace(&mut probe.turned, frame)) != frame
}

pub(super) fn choose(ctx: &Context, choice: Choice) {
    with(ctx, |probe| probe.choice = choice);
    ctx.request_repaint();
}

/// Equation lines for a light of the current explanation, calculated once per explanation.
pub(super) fn lines(ctx: &Context, lit: &Lit, model: &Model) -> Arc<Vec<Line>> {
    with(ctx, |probe| {
        if probe.lines.0 != probe.calculations {
            probe.lines = (probe.calculations, HashMap::new());
        }
        // An explanation keeps its address for as long as it is shown.
        let lines = || Arc::new(lit.rounded_lines(model, rows::DIGITS));
        probe.lines.1.entry(std::ptr::from_ref(lit).addr()).or_insert_with(lines).clone()
    })
}

/// True if a quantity is unfolded.
pub(super) fn unfolds(ctx: &Context, quantity: &str) -> bool {
    with(ctx, |probe| probe.unfolded.contains(quantity))
}

/// Unfolds a quantity, or folds it.
pub(super) fn turn(ctx: &Context, quantity: &str) {
    with(ctx, |probe| probe.unfolded.remove(quantity) || probe.unfolded.insert(quantity.to_owned()));
    ctx.request_repaint();
}

/// Shows all factors, unfolds a quantity, and scrolls to it.
pub(super) fn seek(ctx: &Context, quantity: &str) {
    with(ctx, |probe| {
        probe.unfolded.insert(quantity.to_owned());
        probe.sought = Some(quantity.to_owned());
        probe.choice.level = Level::Factors;
    });
    ctx.request_repaint();
}

/// True once for the quantity to scroll to.
pub(super) fn is_sought(ctx: &Context, quantity: &str) -> bool {
    with(ctx, |probe| probe.sought.take_if(|sought| *sought == quantity)).is_some()
}

/// Display code of the pixel before its numbers were changed in the panel.
pub(super) fn before(ctx: &Context) -> Option<[u8; 3]> {
    with(ctx, |probe| probe.before.filter(|(of, _)| Some(*of) == probe.pin).map(|(_, code)| code))
}

/// Keeps the current display code of the pixel before a change, unless an earlier one is kept.
pub(super) fn keep_before(ctx: &Context) {
    with(ctx, |probe| {
        let now = probe.pin.zip(probe.answer.as_ref().map(|answer| answer.explanation.code()));
        probe.before = probe.before.filter(|(of, _)| now.is_none_or(|(pin, _)| *of == pin)).or(now);
    });
}

/// Forgets the display code from before the changes.
pub(super) fn forget_before(ctx: &Context) {
    with(ctx, |probe| probe.before = None);
}

/// The listed numbers of a pixel: those that changed it most when it was chosen, so that a number keeps its row while
/// it is changed.
pub(super) fn ranking(ctx: &Context, all: &[Influence], most: usize) -> Vec<Knob> {
    with(ctx, |probe| {
        let Some(pin) = probe.pin else { return Vec::new() };
        let there = |knob: &Knob| all.iter().any(|influence| influence.knob == *knob);
        let known = probe.ranking.take().filter(|(of, known)| *of == pin && known.iter().all(there));
        let (_, order) = probe.ranking.insert(known.unwrap_or_else(|| {
            let moves = all.iter().filter(|influence| influence.derivative() != glam::Vec3::ZERO);
            (pin, moves.take(most).map(|influence| influence.knob.clone()).collect())
        }));
        order.clone()
    })
}

/// The numbers of the scene that change the pixel most, calculated once per explanation.
pub(super) fn influences(ctx: &Context, registry: &Registry) -> Arc<Vec<Influence>> {
    with(ctx, |probe| {
        if let Some((_, known)) = probe.influences.as_ref().filter(|(of, _)| *of == probe.calculations) {
            return known.clone();
        }
        // A hidden point has no pixel that could be redrawn with other numbers.
        let answer = probe.answer.as_ref().filter(|a| a.sight.is_none_or(|sight| sight == Sight::Clear));
        let found = answer.and_then(|answer| {
            let (.., scene) = probe.scenes.iter().find(|(_, view, _)| *view == answer.view)?;
            let Explanation { pixel, size: [width, height], terms, .. } = answer.explanation;
            let settings = Settings { width, height, samples: 1, terms };
            probe.explainer.influences(scene, registry, &settings, pixel).ok()
        });
        let found = Arc::new(found.unwrap_or_default());
        probe.influences = Some((probe.calculations, found.clone()));
        found
    })
}

/// Applies a function to the scene of an explained view.
pub(super) fn with_scene<T>(ctx: &Context, view: usize, of: impl FnOnce(&Scene) -> T) -> Option<T> {
    with(ctx, |probe| probe.scenes.iter().find(|(_, known, _)| *known == view).map(|(.., scene)| of(scene)))
}

/// Rectangle of a view, in points.
fn rect_of(area: &PictureArea, view: usize) -> Option<Rect> {
    let cell = area.cells.iter().find(|cell| cell.view == view).or(area.cells.first());
    Some(cell.map_or(area.rect, |cell| cell.rect)).filter(|rect| rect.is_finite() && rect.is_positive())
}

/// Size of a picture in pixels, as the window draws it, and its top left corner.
fn pixels(ctx: &Context, rect: Rect) -> ([u32; 2], Pos2) {
    let pixel = |points: f32| (points * ctx.pixels_per_point()).round().max(0.0);
    let corner = pos2(pixel(rect.min.x), pixel(rect.min.y));
    let size = [pixel(rect.max.x) - corner.x, pixel(rect.max.y) - corner.y];
    (size.map(|side| (side as u32).max(1)), corner)
}

/// The pixel under the pointer, if the pointer is over a picture and nothing covers it.
fn pointed(ctx: &Context, session: &Session, area: &PictureArea) -> Option<Pin> {
    let at = ctx.input(|i| i.pointer.latest_pos()).filter(|at| is_in_sight(ctx, area.frame, *at))?;
    if area.written.iter().any(|place| place.contains(at)) {
        return None;
    }
    let view = match area.cells.as_slice() {
        [] => 0,
        _ => area.cell_at(at)?.view,
    };
    let (size, corner) = pixels(ctx, rect_of(area, view)?);
    let place = (at.to_vec2() * ctx.pixels_per_point() - corner.to_vec2()).floor();
    let inside = |v: f32, side: u32| v >= 0.0 && v < side as f32;
    (inside(place.x, size[0]) && inside(place.y, size[1]))
        .then(|| Pin::of_pixel(view, [place.x as u32, place.y as u32], size, session.document.view_angle()))
}

/// Position of the explained point in the rectangle of a picture, possibly outside it; `None` behind the camera.
pub(super) fn place(session: &Session, rect: Rect, explained: &Explained) -> Option<Pos2> {
    let explanation = &explained.explanation;
    if let (Some(_), Some(seen)) = (explained.sight, &explanation.seen) {
        return Lens::of(session, rect).project(seen.position);
    }
    let part = |i: usize| (explanation.pixel[i] as f32 + 0.5) / explanation.size[i] as f32;
    Some(rect.lerp_inside(vec2(part(0), part(1))))
}

/// Completes the pin action with the pixel under the pointer, unless that is the one that is pinned.
pub fn aimed(ctx: &Context, session: &Session, area: &PictureArea, action: Action) -> Action {
    let aims = |pin: &Pin| action == Action::Pin && !is_pinned_at(ctx, session, area, pin);
    let pin = pointed(ctx, session, area).filter(aims);
    pin.map_or(action, |pin| Action::View(ViewChange::Pin(Some(pin))))
}

/// Pins the pixel clicked with Alt held, or unpins it.
pub fn clicked(ctx: &Context, session: &Session, area: &PictureArea) -> Option<Action> {
    let (clicked, alt) = ctx.input(|i| (i.pointer.primary_clicked(), i.modifiers.alt));
    if clicked && !alt && session.seeks_pixel() {
        // While a lesson asks for a pixel, a click only answers the lesson.
        return pointed(ctx, session, area).map(|pin| Action::Lesson(LessonCommand::Point(pin)));
    }
    let pin = pointed(ctx, session, area).filter(|_| clicked && alt && !session.view.presenting)?;
    let same = is_pinned_at(ctx, session, area, &pin) && session.explains();
    Some(Action::View(ViewChange::Pin(Some(pin).filter(|_| !same))))
}

/// True if the pinned point is at a pixel, or as near as a hand can point.
fn is_pinned_at(ctx: &Context, session: &Session, area: &PictureArea, pin: &Pin) -> bool {
    let Some(pinned) = session.view.pinned.filter(|pinned| pinned.view == pin.view) else { return false };
    let Some(rect) = rect_of(area, pin.view) else { return false };
    let (size, _) = pixels(ctx, rect);
    let pixel = |pin: &Pin| pin.pixel(size, session.document.view_angle());
    let now = match explained(ctx).filter(|answer| answer.sight.is_some()) {
        Some(answer) if answer.sight == Some(Sight::Outside) => return false,
        Some(answer) => answer.explanation.pixel,
        None => pixel(&pinned),
    };
    let off = Vec2::from(now.map(|c| c as f32)) - Vec2::from(pixel(pin).map(|c| c as f32));
    off.length() <= NEAR * ctx.pixels_per_point()
}

/// Unpins on Escape, unless something else handles the key.
pub fn on_escape(ctx: &Context, session: &Session, area: &PictureArea) -> Option<Action> {
    let pinned = session.view.pinned.is_some() && session.explains() && !session.view.examples_open;
    let unpins = pinned && ctx.dragged_id().is_none() && keys::escapes(ctx, session, area);
    unpins.then_some(Action::View(ViewChange::Pin(None)))
}

/// Explains the pinned pixel, or else the one under the latest pointer position, if the panel is open and something has
/// changed. A pin holds the point of the object that it has hit; if that object is gone, returns the action that unpins
/// it.
pub fn update(ctx: &Context, session: &Session, area: &PictureArea, registry: &Registry) -> Option<Action> {
    let wanted = session.shows_vectors() || session.needs_probe();
    let pointed = if wanted && session.explains() { pointed(ctx, session, area) } else { None };
    with(ctx, |probe| {
        probe.hovered = pointed.is_some();
        probe.pointed = pointed.or(probe.pointed);
        let beside = probe.choice.beside && !session.document.variants.is_empty();
        let question = if wanted { probe.question(ctx, session, area, beside) } else { None };
        let Some(mut question) = question else {
            probe.forget();
            return None;
        };
        probe.pin = Some(question.pin);
        if probe.asked.as_ref() == Some(&question) {
            return None;
        }
        // The kept code is for changed numbers, not for a changed camera.
        if probe.asked.as_ref().is_some_and(|asked| asked.observer != question.observer) {
            probe.before = None;
        }
        let gone = |held: Held| {
            let object = session.document.object(held.object);
            !object.is_some_and(|i| session.document.objects[i].visible)
        };
        if question.held.is_some_and(gone) {
            probe.forget();
            return Some(Action::View(ViewChange::Pin(None)));
        }
        probe.answer = probe.explain(&question, question.views[0], session, registry).map(Arc::new);
        let seen = probe.answer.as_ref().and_then(|answer| answer.explanation.seen.as_ref());
        if let Some(seen) = seen.filter(|_| question.held.is_none())
            && let Some(()) = probe.holding.hold(session, seen)
        {
            question.held = probe.holding.now(session);
        }
        probe.beside.clear();
        let others = if question.held.is_some() || question.beside { &question.views[1..] } else { &[] };
        for shown in others {
            let explained = probe.explain(&question, *shown, session, registry);
            probe.beside.extend(explained.map(Arc::new));
        }
        probe.asked = Some(question);
        None
    })
}

impl Probe {
    /// The question about the pinned pixel, or else about the latest one under the pointer. `beside` asks for the view
    /// beside it too.
    fn question(
        &self,
        ctx: &Context,
        session: &Session,
        area: &PictureArea,
        beside: bool,
    ) -> Option<Question> {
        let pin = session.view.pinned.or(self.pointed);
        let pin = pin.filter(|pin| pin.view <= session.document.variants.len())?;
        let shown = |view: usize| {
            let (size, _) = pixels(ctx, rect_of(area, view)?);
            Some(Shown { view, size, terms: session.terms_of(view) })
        };
        let own = shown(pin.view)?;
        let mut views = vec![own];
        if session.view.pinned.is_some() && session.document.comparison.layout.is_beside() {
            let others = area.cells.iter().map(|cell| cell.view).filter(|view| *view != pin.view);
            views.extend(others.filter_map(shown));
        }
        let view = beside_of(pin.view);
        if beside && !views.iter().any(|shown| shown.view == view) {
            // A view outside the picture takes the size of the visible one.
            views.push(Shown { view, terms: session.terms_of(view), ..own });
        }
        let camera = session.facts.observer(session.document.observer);
        let is_pinned =
            |of: &(u64, Observer)| session.view.pinned.is_some() && of.0 == session.view.pin_number;
        let observer = self.seen_from.filter(is_pinned).map_or(camera, |(_, observer)| observer);
        let moved =
            observer.position.distance(camera.position).max(observer.direction.distance(camera.direction));
        Some(Question {
            revision: session.document.revision(),
            pin,
            held: self.holding.now(session),
            views,
            beside,
            samples: SAMPLES[self.choice.samples.min(SAMPLES.len() - 1)],
            observer,
            aside: moved > SAME,
            reloaded: session.shaders.last.clone(),
        })
    }

    /// Clears the explanation.
    fn forget(&mut self) {
        (self.asked, self.answer) = (None, None);
        self.beside.clear();
    }

    fn explain(
        &mut self,
        question: &Question,
        Shown { view, size, terms }: Shown,
        session: &Session,
        registry: &Registry,
    ) -> Option<Explained> {
        self.calculations += 1;
        let Self { scenes, explainer, .. } = self;
        explainer.set_light_samples(question.samples);
        // The scene of the view, from the camera of the window.
        scenes.retain(|(revision, ..)| *revision == question.revision);
        if !scenes.iter().any(|(_, of, _)| *of == view) {
            let (scene, _) = session.document.seen(view, registry)?;
            scenes.push((question.revision, view, scene));
        }
        let (.., scene) = scenes.iter_mut().find(|(_, of, _)| *of == view)?;
        scene.observer = question.observer.fitting(size, session.document.view_angle());
        let scene = &*scene;
        let settings = Settings { width: size[0], height: size[1], samples: 1, terms };
        let aside = question.aside;
        let of = |explanation, sight| {
            let ignored = ignored_edits(registry, scene).into_iter().collect();
            Explained { view, explanation, sight, ignored, aside }
        };
        let pixel = question.pin.pixel(size, session.document.view_angle());
        let mut of_pixel = || explainer.pixel(scene, registry, &settings, pixel).ok();
        let Some(Held { object, anchor, .. }) = question.held else {
            return Some(of(of_pixel()?, None));
        };
        let object = session.document.object(object)?;
        // Where the line of sight still hits the point, use the numbers of the picture.
        let place = anchor.place(scene.objects.get(object)?);
        let is_there = |explanation: &Explanation| {
            let seen = explanation.seen.as_ref();
            seen.is_some_and(|seen| seen.object.index == object && seen.position.distance(place) < SAME)
        };
        let aims = question.pin.aims_at(session.facts.camera.inverse() * (place - session.facts.eye));
        if let Some(explanation) = (aims && !aside).then(of_pixel).flatten().filter(is_there) {
            return Some(of(explanation, None));
        }
        let (explanation, sight) = explainer.point(scene, registry, &settings, object, &anchor)?;
        Some(of(explanation, Some(sight)))
    }
}

/// Keeps the ray of the observer to the pinned point while the camera looks at it from the side.
pub(super) fn keep_ray(ctx: &Context, session: &Session) {
    let (pin, observer) = (session.view.pin_number, session.facts.observer(session.document.observer));
    with(ctx, |probe| {
        if probe.seen_from.is_none_or(|(of, _)| of != pin) {
            probe.seen_from = Some((pin, observer));
        }
    });
}

/// Points that can be shown: those that produced the colour, and that of per-pixel shading for comparison.
pub(super) fn spots(seen: &Seen) -> Vec<&Spot> {
    seen.spots.iter().chain(&seen.per_pixel).collect()
}

/// The shown point and its index: the chosen one, otherwise the one with the largest weight.
pub(super) fn shown_spot<'s>(ctx: &Context, seen: &'s Seen) -> Option<(usize, &'s Spot)> {
    let spots = spots(seen);
    let i = choice(ctx).spot.filter(|i| *i < spots.len()).or(seen.main_spot()).unwrap_or(0);
    Some((i, *spots.get(i)?))
}

/// The light whose block is unfolded, at a point.
pub(super) fn shown_light<'s>(ctx: &Context, spot: &'s Spot) -> Option<&'s Lit> {
    match choice(ctx).light {
        Unfolded::None => None,
        Unfolded::Light(i) => spot.lights.iter().find(|lit| lit.light.index == i),
        Unfolded::Brightest => spot.brightest().first().copied(),
    }
}
