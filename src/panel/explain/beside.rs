//! Two views of one point side by side: the lines of each equation, with a mark where they differ.

use super::{
    lights,
    probe::{self, Explained},
    rows,
};
use crate::{
    explain::{Explanation, Line, Lit, Pair, Seen, pairs},
    panel::prelude::*,
};

/// Gap between the two sides, in points.
const GAP: f32 = 20.0;

/// Shows the current explanation next to that of the other view.
pub(super) fn beside(ui: &mut Ui, sides: [&Explained; 2], session: &Session, registry: &Registry) {
    ScrollArea::vertical().id_salt("beside").auto_shrink(false).show(ui, |ui| {
        ui.set_max_width(ui.available_width() - 10.0);
        rows::close(ui);
        halves(ui, false, |ui, i| head(ui, sides[i], session, registry));
        let (a, b) = match sides.map(|side| side.explanation.seen.as_ref()) {
            [Some(a), Some(b)] => (a, b),
            [None, None] => return drop(theme::note(ui, "Neither view shows an object here.")),
            _ => return drop(theme::note(ui, "Only one of the views shows an object here.")),
        };
        if a.object.index != b.object.index {
            theme::note(ui, "The views show different objects here.");
        }
        // The same light on both sides: the brightest light may differ between views.
        let first = shown(ui.ctx(), a);
        let index = first.map(|lit| lit.light.index);
        let spot = probe::shown_spot(ui.ctx(), b).map(|(_, spot)| spot);
        let other = spot.and_then(|spot| spot.lights.iter().find(|l| Some(l.light.index) == index));
        let lit = [first, other];
        let [Some(first), Some(second)] = lit else {
            theme::note(ui, "No light is switched on here.");
            return;
        };
        let name = session.name_of(Selection::Light(first.light.index), registry);
        rows::heading(ui, &format!("Light of {name}"));
        let lines = [probe::lines(ui.ctx(), first, &a.model), probe::lines(ui.ctx(), second, &b.model)];
        let factors = probe::choice(ui.ctx()).level == probe::Level::Factors;
        let all = pairs(&lines[0], &lines[1]);
        let shown = |pair: &&Pair| {
            let line = pair.a.as_ref().or(pair.b.as_ref());
            factors || line.is_some_and(Line::is_equation)
        };
        for pair in all.iter().filter(shown) {
            halves(ui, pair.differs(), |ui, i| match [&pair.a, &pair.b][i] {
                Some(line) => {
                    let model = &[a, b][i].model;
                    drop(lights::written(ui, line, &|symbol| lights::meaning(model, symbol)));
                }
                None => drop(theme::note(ui, format!("no line for {} here", pair.defines()))),
            });
        }
        halves(ui, first.contribution != second.contribution, |ui, i| {
            theme::note(ui, "light to the observer");
            match lit[i].and_then(|lit| Some((lit.contribution, lit.error()?))) {
                Some((light, error)) => rows::measured(ui, "=", light, error, true),
                None => {
                    drop(rows::light(ui, "=", lit[i].map_or(glam::Vec3::ZERO, |lit| lit.contribution), true))
                }
            }
        });
        let count = all.iter().filter(|pair| pair.differs()).count();
        theme::note(ui, format!("≠ marks what differs: {count} of {} lines.", all.len()));
    });
}

/// The light whose block is unfolded, at the point with the largest weight.
fn shown<'s>(ctx: &Context, seen: &'s Seen) -> Option<&'s Lit> {
    let (_, spot) = probe::shown_spot(ctx, seen)?;
    probe::shown_light(ctx, spot).or_else(|| spot.brightest().first().copied())
}

/// Shows the name of a view, its models or what else is seen, and its display code.
fn head(ui: &mut Ui, explained: &Explained, session: &Session, registry: &Registry) {
    let letter = LETTERS.get(explained.view).copied().unwrap_or("?");
    let [r, g, b] = explained.explanation.code();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        rows::chip(ui, [r, g, b], vec2(28.0, 16.0));
        let code = rows::together(&format!("red {r}, green {g}, blue {b}"));
        ui.label(theme::strong(ui, format!("View {letter}: {code}")));
        let what = match &explained.explanation {
            Explanation { seen: Some(seen), .. } => {
                format!("{}, {}", seen.model.declaration.name, seen.shading.name)
            }
            Explanation { lamp: Some(lamp), .. } => {
                let lights = lamp.lights.iter().map(|light| Selection::Light(light.index));
                lights.map(|light| session.name_of(light, registry)).collect::<Vec<_>>().join(" with ")
            }
            _ => "background".to_owned(),
        };
        ui.label(theme::small(ui, what));
        let named = explained.view.checked_sub(1).and_then(|i| session.document.variants.get(i));
        if let Some(name) = named.and_then(|variant| variant.name.as_deref()) {
            ui.label(theme::small(ui, name));
        }
    });
}

/// Two columns, with a mark between them if they differ.
fn halves(ui: &mut Ui, differ: bool, mut add: impl FnMut(&mut Ui, usize)) {
    let room = ui.available_rect_before_wrap();
    let width = 0.5 * (room.width() - GAP);
    let mut bottom = room.top();
    for i in 0..2 {
        let left = room.left() + i as f32 * (width + GAP);
        let place = Rect::from_min_max(pos2(left, room.top()), pos2(left + width, f32::INFINITY));
        let mut half = ui.new_child(UiBuilder::new().max_rect(place).id_salt(("half", i)));
        half.set_max_width(width);
        add(&mut half, i);
        bottom = bottom.max(half.min_rect().bottom());
    }
    let palette = Palette::here(ui);
    let middle = room.left() + width + 0.5 * GAP;
    if differ {
        let colour: Color32 = palette.accent;
        let font = TextStyle::Body.resolve(ui.style());
        let at = pos2(middle, 0.5 * (room.top() + bottom));
        ui.painter().text(at, Align2::CENTER_CENTER, "≠", font, colour);
    } else {
        ui.painter().vline(middle, room.top()..=bottom, Stroke::new(1.0, palette.line));
    }
    ui.advance_cursor_after_rect(Rect::from_min_max(room.min, pos2(room.right(), bottom + 2.0)));
}
