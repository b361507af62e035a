//! Why this pixel has this colour: a worked example for the pixel under the pointer or the pinned one, with the vectors
//! of the point in the picture.
//!
//! The numbers are those of [`explain`](crate::explain), which traces the CPU renderer. They are recalculated when the
//! pixel, the scene, the camera or the view changes, and only while the panel is open.

use std::cell::Cell;

use super::{
    keys, knob,
    prelude::*,
    segmented::segmented,
    state::{Effect, Pin, ThemeChoice},
};
use crate::{
    explain::{Explanation, Lamp, Seen, Sight, sentence},
    optics::TermSelection,
    scene::limits::Limits,
    text::{facts, listed},
};

mod beside;
mod display;
mod factors;
mod held;
mod hemisphere;
mod lights;
mod lobe;
mod pairs;
mod point;
mod probe;
mod refraction;
mod room;
mod rows;
mod side;
mod surface;
mod vectors;
mod what_if;

pub use lobe::{Lobes, lobe_calculations, lobes_are_due, lobes_shown, lobes_shown_in};
use probe::Level;
pub use probe::{Explained, aimed, calculations, clicked, explained, on_escape, update};
pub(super) use rows::raised;
pub use side::{has_sides, placed};
pub use surface::LightLobe;
pub(super) use vectors::vectors;

/// Minimum width of a column, in points; a narrower panel has fewer columns.
const COLUMN: f32 = 272.0;
/// Font size of a sentence that stands alone, in points.
const SENTENCE: f32 = 20.0;
/// Relative widths of four columns: even, so that they fit into a window of 1280 points.
const FOUR: [f32; 4] = [0.265, 0.3, 0.3, 0.265];
/// Gap between columns, in points.
const GAP: f32 = 24.0;
/// Gap between the parts of the first line, in points.
const BETWEEN: f32 = 6.0;

/// The *Explain* panel; see the module.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let Some(explained) = probe::explained(ui.ctx()) else {
        ui.add_space(8.0);
        let key = keys::word(ui.ctx(), "explain");
        let text = format!(
            "Point at the picture: this panel says why the pixel has its colour, number by number. {key} pins the \
             pixel under the pointer, or the middle of the picture.",
        );
        ui.add(Label::new(RichText::new(text).color(Palette::here(ui).weak)).wrap());
        return;
    };
    header(ui, &explained, context);
    let name = |light: usize| session.name_of(Selection::Light(light), registry);
    // A hidden point has no pixel.
    let subject = match explained.sight {
        None | Some(Sight::Clear) if !explained.aside => "This pixel is",
        _ => "The pinned point would be",
    };
    let text = sentence(&explained.explanation, subject, &name);
    let level = probe::choice(ui.ctx()).level;
    let mut text = theme::strong(ui, text);
    if level == Level::Sentence {
        // Readable from the back of the room.
        text = text.size(SENTENCE * theme::scale_here(ui));
    }
    ui.add(Label::new(text).wrap().selectable(true));
    let other = probe::other(ui.ctx());
    for (severity, text) in remarks(&explained, other.as_deref(), session, registry) {
        icon::remark(ui, [16.0, 18.0], severity, Label::new(text).wrap().selectable(true));
    }
    if level == Level::Sentence {
        return;
    }
    ui.add_space(2.0);
    match other {
        Some(other) => {
            let mut sides = [&*explained, &*other];
            sides.sort_by_key(|side| side.view);
            beside::beside(ui, sides, session, registry);
        }
        None => columns(ui, &explained, context),
    }
}

/// The pixel, its code, and the buttons, which have a line of their own if one is too short for both.
fn header(ui: &mut Ui, explained: &Explained, context: &mut PanelContext<'_>) {
    let memory = Id::new("width of the buttons of an explanation");
    // Known from the last frame; until then they stand alone.
    let known: f32 = ui.data(|d| d.get_temp(memory)).unwrap_or(f32::INFINITY);
    let mut buttons = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = BETWEEN;
        place(ui, explained, context);
        let room = ui.available_width() - known;
        let fits = room >= 0.0;
        code(ui, explained, context.session(), if fits { room } else { ui.available_width() });
        buttons = fits.then(|| self::buttons(ui, explained, context));
    });
    let width = buttons.unwrap_or_else(|| {
        let row = ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = BETWEEN;
            self::buttons(ui, explained, context)
        });
        row.inner
    });
    if width != known {
        ui.data_mut(|d| d.insert_temp(memory, width));
        ui.ctx().request_repaint();
    }
}

/// The colour and the place of the pixel.
fn place(ui: &mut Ui, explained: &Explained, context: &mut PanelContext<'_>) {
    let Explanation { pixel, size, .. } = explained.explanation;
    let fov = context.session().document.view_angle();
    rows::chip(ui, explained.explanation.code(), vec2(40.0, 24.0));
    ui.label(theme::strong(ui, "Pixel"));
    for (i, name) in ["column of the pixel", "row of the pixel"].into_iter().enumerate() {
        let limits = Limits { whole: true, ..Limits::between(0.0, f64::from(size[i].saturating_sub(1))) };
        let id = Id::new(("explained pixel", i));
        let field = knob::field(ui, id, name, f64::from(pixel[i]), &limits, 52.0);
        if let Some(value) = field.value {
            let mut other = pixel;
            other[i] = value as u32;
            let pin = Pin::of_pixel(explained.view, other, size, fov);
            context.act(Action::View(ViewChange::Pin(Some(pin))));
        }
    }
}

/// The picture and the code of the pixel, as far as there is room. The sentence below says the code, too.
fn code(ui: &mut Ui, explained: &Explained, session: &Session, room: f32) {
    let [width, height] = explained.explanation.size;
    let view = match session.document.variants.len() {
        0 => String::new(),
        _ => format!("view {}", LETTERS.get(explained.view).copied().unwrap_or("?")),
    };
    let between = if view.is_empty() { "" } else { " · " };
    let picture = format!("of {width}×{height}{between}{view}");
    let [r, g, b] = explained.explanation.code();
    let code = format!("red {r}, green {g}, blue {b}");
    let room = room - BETWEEN - theme::small_width(ui, &picture);
    if room < 0.0 {
        if theme::small_width(ui, &view) <= room + theme::small_width(ui, &picture) {
            ui.label(theme::small(ui, view)).on_hover_text(picture);
        }
        return;
    }
    ui.label(theme::small(ui, picture));
    let whole = ui.painter().layout_no_wrap(code.clone(), theme::bold(ui), Color32::WHITE);
    if whole.size().x + BETWEEN <= room {
        ui.label(theme::strong(ui, code));
    }
}

/// The buttons, from the right end of the line. Returns their width.
fn buttons(ui: &mut Ui, explained: &Explained, context: &mut PanelContext<'_>) -> f32 {
    let session = context.session();
    let Explanation { pixel, size, .. } = explained.explanation;
    let (pinned, fov) = (session.view.pinned.is_some(), session.document.view_angle());
    let row = ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let button = ui.button("Copy").on_hover_text("Copy the explanation as text, with all digits");
        context.on_click(&button, || Action::Do(Effect::CopyText(explained.explanation.to_text())));
        let key = keys::word(ui.ctx(), "explain");
        let pin = ui.add(Button::selectable(pinned, "Pin")).on_hover_text(if pinned {
            format!("Let go of the point ({key} or Esc): the pointer is followed again")
        } else {
            format!(
                "Keep this point explained wherever the pointer is, and where the camera and the object go. At the \
                 pointer: {key}, or Alt and a click"
            )
        });
        if pin.clicked() {
            let this = Pin::of_pixel(explained.view, pixel, size, fov);
            context.act(Action::View(ViewChange::Pin(Some(this).filter(|_| !pinned))));
        }
        lobe::button(ui, context);
        levels(ui);
        if !session.document.variants.is_empty() {
            beside_button(ui, explained.view);
        }
    });
    row.response.rect.width()
}

/// The button that explains another view beside this one.
fn beside_button(ui: &mut Ui, view: usize) {
    let choice = probe::choice(ui.ctx());
    let other = if view == 0 { LETTERS[1] } else { LETTERS[0] };
    let tip = format!("Explain the same point in view {other} beside it, with marks where the lines differ");
    let button = ui.add(Button::selectable(choice.beside, format!("Beside {other}"))).on_hover_text(tip);
    if button.clicked() && probe::once(ui.ctx()) {
        probe::choose(ui.ctx(), probe::Choice { beside: !choice.beside, ..choice });
    }
}

/// Chooses the level of detail.
fn levels(ui: &mut Ui) {
    let choice = probe::choice(ui.ctx());
    // From right to left, as the row is laid out.
    let names = ["Every factor", "Equation", "Sentence"];
    let tips = [
        "Each factor too, with its own equation, its plot and its source",
        "The equation of the model with the numbers put in, light by light",
        "What happened, in a sentence",
    ];
    let chosen = Level::ALL.iter().rev().position(|level| *level == choice.level);
    let tip = |ui: &mut Ui, i: usize| drop(ui.label(tips[i]));
    if let Some(i) = segmented(ui, "Level", &names, chosen, tip) {
        probe::choose(ui.ctx(), probe::Choice { level: Level::ALL[names.len() - 1 - i], ..choice });
    }
}

/// Remarks shown before the numbers, which may be those of two views.
fn remarks(
    explained: &Explained,
    other: Option<&Explained>,
    session: &Session,
    registry: &Registry,
) -> Vec<(Severity, String)> {
    let explanation = &explained.explanation;
    let unseen = unseen(explained, session, registry);
    let mut all: Vec<_> = unseen.into_iter().map(|text| (Severity::Info, text)).collect();
    let mut say = |severity, text: &str| all.push((severity, text.to_owned()));
    if [Some(explained), other].into_iter().flatten().any(|side| session.compiles(side.view)) {
        let text = "Compiling: until the shader is ready, the picture shows what was there before. The numbers are those of \
                    the model that is chosen.";
        say(Severity::Info, text);
    }
    let not = "This is not the explanation of the picture:";
    if !explained.ignored.is_empty() {
        let files: Vec<_> = explained.ignored.iter().map(String::as_str).collect();
        let files = listed(&files, "and");
        let why = format!("{not} it is that of the CPU renderer, which ignores the edited {files}.");
        say(Severity::Warning, &why);
    }
    if let Some(trouble) = explanation.seen.as_ref().and_then(|seen| seen.model.trouble.as_ref()) {
        let why = format!("{not} the CPU cannot run this model, so the numbers are not its own: {trouble}.");
        say(Severity::Warning, &why);
    }
    if let Some(channel) = session.channel_of(explained.view) {
        let text =
            format!("The picture shows a channel, {}; the numbers are those of the light.", channel.name());
        say(Severity::Info, &text);
    }
    let is_neutral = explanation.seen.is_none() && !explanation.shows_backdrop();
    if is_neutral && session.settings.theme == ThemeChoice::Light {
        let text = "The window with the light theme has a light surround here; pictures that are rendered have this background.";
        say(Severity::Info, text);
    }
    if explanation.terms != TermSelection::All {
        say(Severity::Info, &format!("Only the {} term is shown.", explanation.terms.id()));
    }
    let mut spots = explanation.seen.iter().flat_map(|seen| &seen.spots);
    if explanation.steps.light.is_nan() || spots.any(|spot| spot.is_replaced()) {
        let text = "Some light here is not a number, or infinite; it counts as 0, or as ±10³⁰.";
        say(Severity::Warning, text);
    }
    all
}

/// Why the pinned point cannot be seen, or not as it is explained, if so.
fn unseen(explained: &Explained, session: &Session, registry: &Registry) -> Option<String> {
    if explained.aside {
        let why = "From the side: V and the light are still those of the observer before. Pin the point anew to explain it \
                   from here.";
        return Some(why.to_owned());
    }
    let so = match explained.sight? {
        Sight::Clear => return None,
        Sight::Outside => "is outside the picture".to_owned(),
        Sight::Away => {
            let why = "The pinned point faces away from here: this is its light all the same, for a V that is mirrored in \
                       the surface.";
            return Some(why.to_owned());
        }
        Sight::Behind(i) => {
            let own = explained.explanation.seen.as_ref().is_some_and(|seen| seen.object.index == i);
            let name = match own {
                true => "its own object".to_owned(),
                false => session.name_of(Selection::Object(i), registry),
            };
            format!("is hidden here by {name}")
        }
    };
    Some(format!("The pinned point {so}: this is its light all the same."))
}

/// A part of the explanation: relative width, and the function that shows it.
type Part<'a> = (f32, Box<dyn FnOnce(&mut Ui) + 'a>);

/// The explanation in columns that follow the light: from the surface and the lights to the display.
fn columns(ui: &mut Ui, explained: &Arc<Explained>, context: &mut PanelContext<'_>) {
    let (session, registry, explanation) = (context.session(), context.registry(), &explained.explanation);
    let name = |light: usize| session.name_of(Selection::Light(light), registry);
    let aside = Cell::new(false);
    let end = |ui: &mut Ui| {
        display::display(ui, explanation);
        if explanation.seen.is_some() {
            ui.add_space(8.0);
            what_if::what_if(ui, explained, context);
        }
    };
    let end: Part = (0.28, Box::new(end));
    let parts: Vec<Part> = match (&explanation.seen, &explanation.lamp) {
        (Some(seen), _) => {
            let surface = |ui: &mut Ui| aside.set(surface(ui, seen, explained.sight, session, registry));
            let lights = move |ui: &mut Ui| lights::lights(ui, explanation, seen, &name);
            let mut parts: Vec<Part> = vec![(0.3, Box::new(surface)), (0.42, Box::new(lights)), end];
            if hemisphere::has(ui.ctx(), seen) {
                let above = move |ui: &mut Ui| hemisphere::hemisphere(ui, explained, seen, registry);
                // Before the list, which is long.
                parts.insert(1, (0.42, Box::new(above)));
            }
            parts
        }
        (None, Some(lamp)) => vec![(0.36, Box::new(|ui| seen_light(ui, lamp, &name))), end],
        (None, None) => vec![(0.36, Box::new(|ui| background(ui, explanation))), end],
    };
    side_by_side(ui, parts);
    if aside.get() {
        context.act(Action::LookFromSide);
    }
}

/// Parts in columns. With less width, the parts in the middle stand beside the two others; with little width, they are
/// stacked.
fn side_by_side(ui: &mut Ui, parts: Vec<Part>) {
    let room = ui.available_rect_before_wrap();
    let shares: Vec<_> = parts.iter().map(|(share, _)| *share).collect();
    let places = places(&shares, room.width());
    let mut columns: Vec<Vec<_>> = places.iter().map(|_| Vec::new()).collect();
    for (part, column) in parts.into_iter().zip(column_of(places.len(), shares.len())) {
        columns[column].push(part.1);
    }
    for (i, (parts, [left, width])) in columns.into_iter().zip(places).enumerate() {
        let left = room.left() + left;
        let place = Rect::from_min_max(pos2(left, room.top()), pos2(left + width, room.bottom()));
        if i > 0 {
            let line = Stroke::new(1.0, Palette::here(ui).line);
            ui.painter().vline(left - 0.5 * GAP, room.y_range(), line);
        }
        let mut column = ui.new_child(UiBuilder::new().max_rect(place).id_salt(("column", i)));
        column.set_clip_rect(column.clip_rect().intersect(place.expand2(vec2(4.0, 0.0))));
        let scroll = ScrollArea::vertical().id_salt(("explain", i)).auto_shrink(false);
        scroll.show(&mut column, |ui| {
            ui.set_max_width(ui.available_width() - 10.0);
            for (k, part) in parts.into_iter().enumerate() {
                if k > 0 {
                    ui.add_space(10.0);
                }
                // Parts set their own line spacing.
                ui.scope(part);
            }
            ui.add_space(8.0);
        });
    }
    ui.advance_cursor_after_rect(room);
}

/// Column of each part. In fewer columns than parts, those in the middle have the second column to themselves.
fn column_of(columns: usize, parts: usize) -> Vec<usize> {
    match (columns, parts) {
        (2, 3) => vec![0, 1, 0],
        (2, 4) => vec![0, 1, 1, 0],
        (3, 4) => vec![0, 1, 1, 2],
        (columns, parts) => (0..parts).map(|part| part.min(columns - 1)).collect(),
    }
}

/// Left edge and width of each column, for parts with the given relative widths: as many columns as fit.
fn places(shares: &[f32], width: f32) -> Vec<[f32; 2]> {
    let of = |count: usize| {
        let shares = if count == FOUR.len() { &FOUR[..] } else { shares };
        let mut wanted = vec![0.0; count];
        for (share, column) in shares.iter().zip(column_of(count, shares.len())) {
            // Of stacked parts, the wider one counts.
            wanted[column] = f32::max(wanted[column], *share);
        }
        let whole: f32 = wanted.iter().sum();
        let rest = width - GAP * (count - 1) as f32;
        let mut left = 0.0;
        let place = |share: f32| {
            let at = [left, rest * share / whole];
            left += at[1] + GAP;
            at
        };
        wanted.into_iter().map(place).collect::<Vec<_>>()
    };
    let fits = |all: &Vec<[f32; 2]>| all.len() == 1 || all.iter().all(|[_, width]| *width >= COLUMN);
    (1..=shares.len()).rev().map(of).find(fits).unwrap_or_default()
}

/// Shows the object, the point on it, and how its light is calculated. Returns true if the point is to be seen from the
/// side.
fn surface(ui: &mut Ui, seen: &Seen, sight: Option<Sight>, session: &Session, registry: &Registry) -> bool {
    rows::heading(ui, &session.name_of(Selection::Object(seen.object.index), registry));
    let d = seen.model.declaration;
    theme::note(ui, facts([d.name, d.author]));
    if seen.model.interpreted {
        theme::note(ui, "The CPU interprets the WGSL of this model.");
    }
    // First where there is any: it is what such a model is about.
    let aside = refraction::refraction(ui, seen, session);
    ui.add_space(2.0);
    if let Some(shading) = registry.shading_model(seen.shading.id) {
        super::inspector::model::stage(ui, shading);
    }
    point::point(ui, seen, sight.is_some());
    aside
}

fn seen_light(ui: &mut Ui, lamp: &Lamp, name: &dyn Fn(usize) -> String) {
    for light in &lamp.lights {
        rows::heading(ui, &name(light.index));
    }
    let text = "No object is at the centre of this pixel: the light itself is seen there.";
    ui.add(Label::new(text).wrap());
    rows::step(ui, "L, cd/m²", lamp.radiance, None);
    rows::step(ui, "light = π L", lamp.light, None);
}

fn background(ui: &mut Ui, explanation: &Explanation) {
    rows::heading(ui, "Background");
    ui.add(Label::new(explanation.about_background()).wrap());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_columns_as_have_room() {
        let count = |shares: &[f32], width| places(shares, width).len();
        let three = [0.3, 0.42, 0.28];
        assert_eq!([1200.0, 1019.0, 1000.0, 800.0, 500.0].map(|w| count(&three, w)), [3, 2, 2, 2, 1]);
        assert_eq!([1000.0, 700.0, 560.0].map(|w| count(&[0.36, 0.28], w)), [2, 2, 1]);
        let four = [0.3, 0.42, 0.42, 0.28];
        assert_eq!([1256.0, 1200.0, 1000.0, 500.0].map(|w| count(&four, w)), [4, 3, 2, 1]);
        for (shares, width) in
            [(&three[..], 300.0), (&three[..], 700.0), (&three[..], 1300.0), (&four[..], 1256.0)]
        {
            let places = places(shares, width);
            let [left, last] = places[places.len() - 1];
            assert!((left + last - width).abs() < 0.01, "{places:?} in {width}");
            assert!(places.windows(2).all(|two| (two[0][0] + two[0][1] + GAP - two[1][0]).abs() < 0.01));
        }
        assert_eq!(
            (column_of(2, 3), column_of(3, 3), column_of(1, 3)),
            (vec![0, 1, 0], vec![0, 1, 2], vec![0, 0, 0])
        );
        assert_eq!((column_of(2, 4), column_of(3, 4)), (vec![0, 1, 1, 0], vec![0, 1, 1, 2]));
    }
}
