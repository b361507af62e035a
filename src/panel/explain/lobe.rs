//! The lobe of the reflection model at the explained point: the BRDF towards all viewers as a surface over the point,
//! for the unfolded light or for every light that reaches the point.
//!
//! It is calculated in a thread when the explanation, the point or the lights have changed. Most lobes are ready within
//! a millisecond and appear in the same frame; an interpreted model takes longer, and frames do not wait for it.

use std::{collections::BTreeMap, time::Duration};

use bevy_egui::egui::containers::menu::MenuButton;

use super::{
    probe::{self, Explained},
    room::Room,
    rows,
    surface::{self, LightLobe, tint},
};
use crate::{
    caught::catch,
    channel::Legend,
    curves::{
        Lobe,
        draw::{Axis, COLOURS},
        lobe::steady,
    },
    explain::{Lit, Seen, Spot},
    optics::TermSelection,
    panel::{
        channels, command,
        kept::{Answers, Same},
        keys,
        placer::EDGE,
        prelude::*,
        segmented,
        state::{LobeChoice, LobeScale, Pin},
    },
    progress::Progress,
};

/// Distance below which lobes belong to the same point, in metres.
const SAME: f32 = 1e-4;
/// Maximum time that a frame waits for a lobe.
const PATIENCE: Duration = Duration::from_millis(2);
/// Maximum number of lobes: as many as there are distinct colours.
const MOST: usize = COLOURS.len();
/// Minimum width of a picture for a legend, and minimum height for one with a scale, in points.
const ROOM: f32 = 240.0;
/// Maximum width of the legend, in points.
const LEGEND: f32 = 320.0;

/// Lobes as drawn.
#[derive(Debug)]
pub struct Lobes {
    /// The explained point.
    pub position: Vec3,
    /// The lobes, the brightest light first; or why there are none.
    pub lobes: Result<Vec<LightLobe>, String>,
}

/// Inputs of the lobes: the explanation, the point and the lights. A change of any other input produces a new
/// explanation.
type Question = (Same<Explained>, usize, Vec<usize>);

/// Lobes of one view, and their calculation.
type Work = Answers<Question, Arc<Lobes>>;

#[derive(Default)]
struct Works {
    views: BTreeMap<usize, Work>,
    /// End of the scale, shared by all views and kept while a pixel is pinned.
    kept: Option<(Pin, LobeScale, f64)>,
}

/// Looks up the name of a light as in the scene list.
type Name<'a> = &'a dyn Fn(usize) -> String;

fn with<R>(ctx: &Context, of: impl FnOnce(&mut Works) -> R) -> R {
    kept::shared(ctx, of)
}

/// Number of lobe calculations so far.
#[must_use]
pub fn lobe_calculations(ctx: &Context) -> u64 {
    with(ctx, |works| works.views.values().map(|work| work.calculations).sum())
}

/// True while lobes are being calculated; meanwhile the previous ones stay visible.
#[must_use]
pub fn lobes_are_due(ctx: &Context) -> bool {
    with(ctx, |works| works.views.values().any(Work::is_busy))
}

/// The most recently drawn lobes of the explained view.
#[must_use]
pub fn lobes_shown(ctx: &Context) -> Option<Arc<Lobes>> {
    let view = probe::explained(ctx).map(|explained| explained.view);
    with(ctx, |works| {
        let work = view.and_then(|view| works.views.get(&view)).or(works.views.values().next());
        Some(work?.shown.as_ref()?.1.clone())
    })
}

/// The most recently drawn lobes of the given view.
#[must_use]
pub fn lobes_shown_in(ctx: &Context, view: usize) -> Option<Arc<Lobes>> {
    with(ctx, |works| Some(works.views.get(&view)?.shown.as_ref()?.1.clone()))
}

/// The lights whose lobes are shown, the brightest first, and the number of lobes without the limit [`MOST`].
fn lights<'s>(
    ctx: &Context,
    seen: &Seen,
    spot: &'s Spot,
    all: bool,
) -> Result<(Vec<&'s Lit>, usize), String> {
    let transmits = seen.model.declaration.transmits;
    let reason = |lit: &Lit| match () {
        () if lit.leading().is_none() => Some("Ambient light has no direction, and so no lobe.".to_owned()),
        () if lit.is_behind() && !transmits => {
            Some("The surface faces away from the light: f is 0, and there is no lobe.".to_owned())
        }
        () => None,
    };
    if !all {
        let lit = probe::shown_light(ctx, spot).ok_or("Unfold a light to see its lobe.")?;
        return reason(lit).map_or(Ok((vec![lit], 1)), Err);
    }
    let mut found = spot.brightest();
    found.retain(|lit| reason(lit).is_none() && !lit.is_dark());
    let count = found.len();
    found.truncate(MOST);
    if found.is_empty() {
        Err("No light with a direction reaches the point: there is no lobe.".to_owned())
    } else {
        Ok((found, count))
    }
}

impl Works {
    /// Scale of the lobes, which never shrinks while the same pixel is pinned.
    fn scale(&mut self, lobes: &[LightLobe], wanted: LobeScale, pinned: Option<Pin>) -> Axis {
        let kept = self.kept.filter(|(pin, of, _)| Some(*pin) == pinned && *of == wanted);
        let each: Vec<_> = lobes.iter().map(|light| &light.lobe).collect();
        let scale = steady(&each, wanted == LobeScale::Logarithmic, kept.map(|(.., to)| to));
        self.kept = pinned.map(|pin| (pin, wanted, scale.to));
        scale
    }
}

/// The lobes or, while they are calculated, the previous lobes if they belong to the same point.
fn answer(
    work: &mut Work,
    ctx: &Context,
    question: &Question,
    seen: &Seen,
    spot: &Spot,
    name: Name<'_>,
) -> Option<Arc<Lobes>> {
    let (Same(explained), _, lights) = question;
    work.ask(ctx, question, PATIENCE, || {
        let terms = explained.explanation.terms;
        let (surface, frame, position) = (seen.model.surface.0.clone(), spot.frame, spot.position);
        let of = |index: &usize| {
            let lit = spot.lights.iter().find(|lit| lit.light.index == *index)?;
            Some((*index, name(*index), lit.leading()?.l, lit.integral.is_some()))
        };
        let lights: Vec<_> = lights.iter().filter_map(of).collect();
        let lobe = move |(light, name, l, extends)| {
            let lobe = Lobe::new(&*surface, l, &frame, terms, &Progress::NONE).ok()?;
            Some(LightLobe { light, name, l, extends, rims: surface::rims(&lobe), lobe })
        };
        Some(move || {
            let lobes = catch(|| lights.into_iter().filter_map(lobe).collect());
            let lobes = lobes.map_err(|_| "No lobe: an internal error while the model was asked.".to_owned());
            Arc::new(Lobes { position, lobes })
        })
    });
    let (asked, shown) = work.shown.as_ref()?;
    (asked == question || shown.position.distance(spot.position) < SAME).then(|| shown.clone())
}

/// Paints the lobes of an explained point into the picture, marking their area as occupied, and their legend clear of
/// the plates that are `taken`. Returns the legend's rectangle.
pub(super) fn paint(
    ui: &Ui,
    (rect, taken): (Rect, &[Rect]),
    explained: &Arc<Explained>,
    session: &Session,
    room: &mut Room,
    name: Name<'_>,
) -> Option<Rect> {
    let LobeChoice { scale: wanted, all } = session.view.lobe;
    if wanted == LobeScale::Off {
        with(ui.ctx(), |works| works.kept = None);
        return None;
    }
    let seen = explained.explanation.seen.as_ref()?;
    let (number, spot) = probe::shown_spot(ui.ctx(), seen)?;
    let terms = explained.explanation.terms;
    let found = match &seen.model.trouble {
        Some(_) => Err("The CPU cannot run this model: there is no lobe.".to_owned()),
        None if terms == TermSelection::Ambient => {
            Err("The ambient term has no lobe: it answers light from all directions.".to_owned())
        }
        None => lights(ui.ctx(), seen, spot, all),
    };
    let (lights, count) = match found {
        Ok(found) => found,
        Err(why) => return plate(ui, rect, taken, sentence(&why)),
    };
    let lights = lights.iter().map(|lit| lit.light.index).collect();
    let question = (Same(explained.clone()), number, lights);
    let (shown, scale) = with(ui.ctx(), |works| {
        // Drops the lobes of views that no longer show the point.
        works.views.retain(|view, _| probe::explained_in(ui.ctx(), *view).is_some());
        let work = works.views.entry(explained.view).or_default();
        let shown = answer(work, ui.ctx(), &question, seen, spot, name);
        let lobes = shown.as_ref().and_then(|shown| shown.lobes.as_ref().ok());
        let before = works.kept;
        let scale = lobes.map(|lobes| works.scale(lobes, wanted, session.view.pinned));
        if works.views.len() > 1 && works.kept != before {
            // The other views adopt the new scale in the next frame.
            ui.ctx().request_repaint();
        }
        (shown, scale)
    });
    let Some(shown) = shown else { return plate(ui, rect, taken, sentence("Lobe: calculating…")) };
    match (&shown.lobes, scale) {
        (Err(why), _) => plate(ui, rect, taken, sentence(why)),
        (Ok(_), None) => None,
        (Ok(lobes), Some(scale)) => {
            surface::paint(ui, rect, session, shown.position, lobes, &scale, room);
            plate(ui, rect, taken, legend(lobes, count, &scale, terms))
        }
    }
}

/// A legend that only says something.
fn sentence(text: &str) -> Legend {
    Legend { title: text.to_owned(), scale: None, colours: Vec::new() }
}

/// Addition to the legend of a light with extent.
const OF_EXTENT: &str = "Light with extent: from the direction\nthat gives most";

/// Legend of the lobes.
fn legend(lobes: &[LightLobe], count: usize, scale: &Axis, terms: TermSelection) -> Legend {
    let number = |v: f64| rows::short(v as f32);
    let what = match terms {
        TermSelection::All => "BRDF f".to_owned(),
        terms => format!("{} term of f", terms.id()),
    };
    let mut lines = vec![format!("Lobe: {what} in sr⁻¹{}", if scale.log { ", logarithmic" } else { "" })];
    let white = (scale.to - std::f64::consts::FRAC_1_PI).abs() < 1e-9;
    lines.push(match scale.log {
        false if white => {
            format!("Length of the vectors: {}:\na white matte surface", number(scale.to))
        }
        false => format!("Length of the vectors: {}", number(scale.to)),
        true => format!("Centre: {}; length of the vectors: {}", number(scale.from), number(scale.to)),
    });
    if lobes.iter().any(|light| light.extends) {
        lines.push(OF_EXTENT.to_owned());
    }
    if count > lobes.len() {
        lines.push(format!("The {} brightest of {count} lights", lobes.len()));
    }
    let empty = lobes.iter().all(|light| light.lobe.triangles.is_empty());
    if empty {
        lines.push("No value is a finite number: there is no surface.".to_owned());
    } else if lobes.iter().any(|light| light.lobe.has_gaps()) {
        lines.push("Some values are not finite numbers: the surface has a gap.".to_owned());
    }
    if lobes.iter().any(|light| light.lobe.is_negative()) {
        lines.push("Some values are below 0, and drawn as 0.".to_owned());
    } else if !empty && lobes.iter().all(|light| light.lobe.largest() == 0.0) {
        lines.push("Every value is 0.".to_owned());
    }
    let middle = if scale.log { (scale.from * scale.to).sqrt() } else { 0.5 * scale.to };
    let one = lobes.len() == 1;
    Legend {
        title: lines.join("\n"),
        scale: one.then(|| [scale.from, middle, scale.to].map(number)),
        colours: if one {
            Vec::new()
        } else {
            lobes.iter().enumerate().map(|(i, light)| (tint(i), light.name.clone())).collect()
        },
    }
}

/// Paints a legend if there is room.
fn plate(ui: &Ui, rect: Rect, taken: &[Rect], legend: Legend) -> Option<Rect> {
    // In a low picture the scale would cover the middle; a sentence does not.
    if rect.width() < ROOM || legend.scale.is_some() && rect.height() < ROOM {
        return None;
    }
    let left = (rect.right() - LEGEND * theme::scale_here(ui)).max(rect.left());
    let side = Rect::from_min_max(pos2(left, rect.top()), rect.max);
    let plate = channels::LaidOut::new(ui, side, &legend, usize::MAX);
    let place = place_of(rect, plate.size, taken)?;
    plate.paint(ui, rect, place);
    Some(place)
}

/// The place of a legend of this size: the upper right corner of a picture or, where plates have taken that, another
/// one, above or below the plates there.
fn place_of(rect: Rect, size: Vec2, taken: &[Rect]) -> Option<Rect> {
    let room = rect.shrink(EDGE);
    let is_free = |place: &Rect| !taken.iter().any(|other| other.intersects(*place));
    let first = Align2::RIGHT_TOP.align_size_within_rect(size, room);
    if is_free(&first) {
        return Some(first);
    }
    let clear = |corner: Align2| {
        let place = corner.align_size_within_rect(size, room);
        let there = taken.iter().filter(|other| other.intersects(place));
        let way = if corner.y() == Align::Min {
            there.map(|other| other.bottom() + EDGE - place.top()).fold(0.0, f32::max)
        } else {
            there.map(|other| other.top() - EDGE - place.bottom()).fold(0.0, f32::min)
        };
        place.translate(vec2(0.0, way))
    };
    let corners = [Align2::RIGHT_TOP, Align2::RIGHT_BOTTOM, Align2::LEFT_TOP, Align2::LEFT_BOTTOM];
    corners.into_iter().map(clear).find(|place| room.contains_rect(*place) && is_free(place))
}

/// The button of the choices.
pub(super) fn button(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry, actions) = (context.session(), context.registry(), &mut context.actions);
    let now = session.view.lobe;
    let shown = format!("Lobe: {}", now.scale.id());
    let width = segmented::segment_width(ui, "Lobe: logarithmic");
    let button = Button::new(&shown).min_size(vec2(width, 0.0));
    let (response, _) = MenuButton::from_button(button)
        .ui(ui, |ui| command::show::entries(ui, command::LOBE, session, registry, actions));
    let key = keys::word(ui.ctx(), "next_lobe");
    let help = "The lobe of the reflection model in the picture: as a surface over the point, f towards all viewers.";
    response.on_hover_text(format!("{help} {key} goes on to the next."));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_keeps_its_distance_from_the_edge_and_covers_no_plate() {
        let picture = Rect::from_min_size(pos2(10.0, 20.0), vec2(600.0, 400.0));
        let size = vec2(300.0, 120.0);
        let usual = Rect::from_min_size(pos2(302.0, 28.0), size);
        assert_eq!(place_of(picture, size, &[]), Some(usual));
        let (left, lower) = (picture.with_max_x(250.0), picture.with_min_y(380.0));
        assert_eq!(place_of(picture, size, &[left, lower]), Some(usual), "they are elsewhere");
        let half = picture.with_min_x(250.0);
        let cases = [
            [picture.with_max_y(80.0), lower],
            [half.with_max_y(200.0), lower],
            [half, lower],
            [half.with_max_y(380.0), left.with_max_y(80.0)],
        ];
        for taken in cases {
            let Some(place) = place_of(picture, size.min(vec2(200.0, 120.0)), &taken) else {
                panic!("there is room beside {taken:?}")
            };
            assert!(picture.shrink(EDGE).contains_rect(place), "{place:?}");
            assert!(taken.iter().all(|other| !other.intersects(place)), "{place:?} {taken:?}");
        }
        assert_eq!(place_of(picture, size, &[picture]), None, "there is no room");
    }
}
