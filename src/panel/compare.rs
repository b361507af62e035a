//! The views of a comparison in the picture: their arrangement, headers, and the edge of a wipe.

use std::collections::BTreeSet;

use bevy_egui::egui::{Layout as Direction, epaint::text::PlacedRow};

mod bar;
mod place;

mod blink;
mod difference;
mod side_by_side;
mod single;
mod wipe;

use bar::{NARROW, ROW, bar};
use place::{Arranging, Frame, HEADER, NARROW_HEADER, TWO_LINES};

pub use place::Arrangement;

use super::{
    caption::{Lines, compiling},
    keys, knob, matching,
    prelude::*,
    presentation::CAPTION,
    state::{Cell, MatchCommand},
};
use crate::{
    caption::{MODEL_RANK, Part, line, view_parts},
    scene::comparison::Layout,
};

/// Height of a header in a presentation, as a fraction of the screen, and the size of its letters as one of its height:
/// they are as large as those of captions, whatever the size of everything is.
const PRESENTED: f32 = 0.055;
const PRESENTED_LETTERS: f32 = CAPTION / PRESENTED;

/// A layout in the window.
fn arranging(layout: Layout) -> &'static Arranging {
    match layout {
        Layout::Single => &single::ARRANGING,
        Layout::SideBySide => &side_by_side::ARRANGING,
        Layout::Wipe => &wipe::ARRANGING,
        Layout::Difference => &difference::ARRANGING,
        Layout::Blink => &blink::ARRANGING,
    }
}

/// Arranges the views of a session in the space between the panels. A presentation has no bar, but a footer and a band
/// above each view of the given heights.
#[must_use]
pub fn arrange(session: &Session, whole: Rect, footer: f32, band: f32) -> Arrangement {
    let variants = session.document.variants.len();
    if variants == 0 {
        let cells = vec![Cell { view: 0, rect: whole, part: whole }];
        return Arrangement { cells, ..Arrangement::new(whole) };
    }
    let comparison = &session.document.comparison;
    let arranging = arranging(comparison.layout);
    let rows = match whole.width() < NARROW {
        _ if session.view.presenting => 0.0,
        // The numbers have a row of their own.
        true => 2.0 + arranging.rows[1] as f32,
        false => 1.0 + arranging.rows[0] as f32,
    };
    // The rest of the bar goes where it would leave nothing to the picture, or little above a panel.
    let share = if session.view.bottom_open || session.view.narrow { 0.25 } else { 0.5 };
    let rows = rows.min((share * whole.height() / ROW).floor().max(0.0));
    let bar = Rect::from_min_max(pos2(whole.left(), whole.bottom() - rows * ROW), whole.max);
    let picture = Rect::from_min_max(whole.min, pos2(whole.right(), bar.top() - footer));
    // Readable from the back row.
    let high = if session.view.presenting { PRESENTED * whole.height() } else { HEADER };
    let arranged = |high: f32| {
        let mut all = Arrangement { bar: (rows > 0.0).then_some(bar), ..Arrangement::new(picture) };
        let views = comparison.views(variants);
        (arranging.arrange)(&mut all, &Frame { session, picture, views, high, band });
        all
    };
    let mut all = arranged(high);
    let is_narrow = all.headers.len() > 1 && all.headers.iter().any(|(_, at)| at.width() < NARROW_HEADER);
    if is_narrow && !session.view.presenting {
        all = arranged(TWO_LINES);
    }
    let first = all.cells.iter().map(|cell| cell.rect);
    all.picture = first.reduce(Rect::union).unwrap_or(picture);
    all
}

/// Shows headers, edge and bar. Returns the rectangles that cover the picture.
pub fn show(ui: &mut Ui, arrangement: &Arrangement, context: &mut PanelContext<'_>) -> Vec<Rect> {
    let session = context.session();
    let mut places = Vec::new();
    let held = keys::of(ui.ctx(), "blink").is_some_and(|blink| ui.input(|i| i.key_down(blink.key)));
    if session.view.blinking && !held {
        context.act(Action::Compare(CompareCommand::Blink(false)));
    }
    let palette = Palette::here(ui);
    let several = arrangement.cells.len() > 1;
    let headers = arrangement.headers.iter();
    let mut said: Vec<_> = headers.map(|(view, _)| in_parts(session, *view, context.registry())).collect();
    rank_by_difference(&mut said);
    for (i, (view, rect)) in arrangement.headers.iter().enumerate() {
        places.push(*rect);
        header(ui, (*view, *rect), (&said, i), several, context);
    }
    let comparison = &session.document.comparison;
    if several && comparison.layout.is_beside() && !session.view.presenting {
        for cell in arrangement.cells.iter().filter(|cell| cell.view == session.active()) {
            let stroke = Stroke::new(1.5, palette.accent);
            ui.painter().rect_stroke(cell.rect, 0.0, stroke, StrokeKind::Inside);
        }
    }
    if let Some(rect) = arrangement.vacant {
        ui.painter().rect_filled(rect, 0.0, palette.panel);
        if !session.view.presenting {
            let font = TextStyle::Body.resolve(ui.style());
            let words = format!("{} adds a view", keys::word(ui.ctx(), "add_view"));
            let galley = ui.painter().layout(words, font, palette.weak, rect.width() - 16.0);
            ui.painter().galley(rect.center() - galley.size() / 2.0, galley, palette.weak);
        }
        places.push(rect);
    }
    if several && !session.view.presenting {
        places.extend((arranging(comparison.layout).over)(ui, arrangement.picture, context));
    }
    if let Some(rect) = arrangement.bar {
        places.push(rect);
        bar(ui, rect, arranging, context);
    }
    places
}

/// Header of a view: its letter, its difference from A, and its menu. `said` is what all headers say, and its place in it.
fn header(
    ui: &mut Ui,
    (view, rect): (usize, Rect),
    said: (&[Vec<Part>], usize),
    several: bool,
    context: &mut PanelContext<'_>,
) {
    let session = context.session();
    let palette = Palette::here(ui);
    let active = session.active() == view;
    ui.painter().rect_filled(rect, 0.0, palette.panel);
    let rule = if active && several { palette.accent } else { palette.line };
    let stroke = Stroke::new(if active { 2.0 } else { 1.0 }, rule);
    ui.painter().hline(rect.x_range(), rect.bottom() - 1.0, stroke);
    let letter = LETTERS[view.min(MAX_VARIANTS)];
    let text = line(&said.0[said.1]);
    let click = ui.interact(rect, Id::new(("view header", view)), Sense::click());
    theme::says_chosen(&click, WidgetType::RadioButton, active, format!("View {letter}: {text}"));
    context.on_click(&click, || Action::Compare(CompareCommand::Activate(view)));
    let inner = UiBuilder::new().max_rect(rect.shrink2(vec2(6.0, 2.0)));
    ui.scope_builder(inner.layout(Direction::right_to_left(Align::Center)), |ui| {
        if !session.view.presenting {
            menu(ui, view, context);
        }
        if !several {
            switches(ui, view, context);
        }
        ui.with_layout(Direction::left_to_right(Align::Center), |ui| {
            title(ui, (view, rect), said, session);
        });
    });
    theme::tip(click, 320.0, |ui| {
        ui.label(theme::strong(ui, format!("View {letter}")));
        if view == 0 {
            ui.label("The scene itself.");
        }
        ui.label(text);
        ui.label(theme::small(ui, "Click: the panels show and change this view."));
    });
}

/// A button for each view, where one is shown at a time.
fn switches(ui: &mut Ui, view: usize, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let palette = Palette::here(ui);
    for other in (0..=session.document.variants.len()).rev() {
        let name = LETTERS[other];
        let on = other == view;
        let text = RichText::new(name).small().color(if on { palette.text } else { palette.weak });
        let button = ui.add(Button::new(text).selected(on).min_size(vec2(22.0, 20.0)));
        theme::says_chosen(&button, WidgetType::RadioButton, on, format!("Show view {name}"));
        context.on_click(&button, || Action::Compare(CompareCommand::Activate(other)));
        button.on_hover_text(format!("View {name}: {}", line(&in_parts(session, other, registry))));
    }
}

/// The letter of a view, and how it differs from A.
fn title(ui: &mut Ui, (view, header): (usize, Rect), (said, at): (&[Vec<Part>], usize), session: &Session) {
    let palette = Palette::here(ui);
    let comparison = &session.document.comparison;
    // When views alternate, the visible one stands out.
    let in_turn = comparison.layout.is_in_turn();
    let hidden = in_turn && view != if session.view.blinking { comparison.with } else { 0 };
    let lit = if in_turn { !hidden } else { session.active() == view };
    let ink = if hidden { palette.weak } else { palette.text };
    let presenting = session.view.presenting;
    let scale = if presenting { header.height() / HEADER } else { 1.0 };
    let rows = if !presenting && header.height() > HEADER { 2 } else { 1 };
    let body = TextStyle::Body.resolve(ui.style()).size;
    let size = if presenting { PRESENTED_LETTERS * header.height() } else { body };
    let centre = pos2(ui.max_rect().left() + 10.0 * scale, header.center().y);
    let badge = Rect::from_center_size(centre, vec2(20.0, 20.0) * scale);
    let (fill, on) = if lit { (palette.accent, palette.panel) } else { (palette.field, ink) };
    ui.painter().rect(badge, 4.0, fill, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    let font = FontId::new(scale * body, theme::semibold());
    let letter = LETTERS[view.min(MAX_VARIANTS)];
    ui.painter().text(badge.center(), Align2::CENTER_CENTER, letter, font, on);
    let room = (ui.max_rect().width() - 30.0 * scale).max(0.0);
    let left = badge.right_center() + vec2(8.0, 0.0) * scale;
    // With symbols as in the equation, if there is room. A presentation says the rest below.
    let dots = theme::elided(ui, ", …", FontId::proportional(size), ink, room);
    let lines = |parts: Vec<Part>, all: &[Part], dotted: bool| {
        let room = room - if dotted && parts.len() < all.len() { dots.size().x } else { 0.0 };
        let lines = Lines::within(ui, parts, size, ink, room, rows);
        let is_low = lines.size.y < (0.55 + 1.35 * rows as f32) * size;
        (is_low && lines.size.x <= room && !lines.is_elided()).then_some(lines)
    };
    let ranks = |dotted: bool| ranks_that_fit(said, |parts, all| lines(parts, all, dotted).is_some());
    // A fact beside the first one is worth more than dots, for which there is no room then.
    let (ranks, dots_too) = ([true, false].map(ranks), !presenting && rows == 1);
    let dotted =
        dots_too && (ranks[0] == ranks[1] || said.iter().any(|all| of_ranks(all, &ranks[0]).len() > 1));
    let parts = of_ranks(&said[at], &ranks[usize::from(!dotted)]);
    let cut = dotted && parts.len() < said[at].len();
    if let Some(lines) = lines(parts.clone(), &said[at], dotted) {
        let place = Align2::LEFT_CENTER.anchor_size(left, lines.size);
        if cut {
            ui.painter().galley(place.right_top(), dots, ink);
        }
        lines.paint(ui, place.min, ink);
    } else {
        let galley = cut_title(ui, &line(&parts), (size, ink), (room, rows));
        let at = Align2::LEFT_CENTER.anchor_size(left, galley.size());
        ui.painter().galley(at.min, galley, ink);
    }
}

/// What a header says at least, where that does not fit: broken after a dash or smaller, and only then cut.
fn cut_title(ui: &Ui, text: &str, (size, ink): (f32, Color32), (room, rows): (f32, usize)) -> Arc<Galley> {
    let small = size * theme::SMALL / TextStyle::Body.resolve(ui.style()).size;
    let set = |(text, size, room): (&str, f32, f32)| match rows {
        1 => theme::elided(ui, text, FontId::proportional(size), ink, room),
        _ => theme::lines(ui, text, FontId::proportional(size), ink, (room, rows)),
    };
    let last = (text, small, room);
    // A row ends after the dash if there is no room for the letter behind it.
    let tight = |size: f32| {
        let (head, tail) = text.split_once('–').filter(|_| rows > 1)?;
        let row = format!("{head}–{}", tail.chars().next()?);
        let width = theme::width_in(ui, &row, &FontId::proportional(size)) - 0.5;
        (width <= room).then_some((text, size, width))
    };
    let broken = text.replace('–', "–\n");
    let apart = [size, small].map(|size| (broken.as_str(), size, room));
    let apart = apart.into_iter().filter(|_| rows > 1);
    let ends_well = |row: &PlacedRow| row.glyphs.last().is_some_and(|glyph| " –".contains(glyph.chr));
    let is_whole = |galley: &Arc<Galley>| {
        let before_last = galley.rows.split_last().map_or(&[][..], |(_, before)| before);
        !galley.elided && before_last.iter().all(ends_well)
    };
    let ways = [(text, size, room)].into_iter().chain([tight(size), tight(small)].into_iter().flatten());
    let whole = ways.chain(apart).chain([last]).map(set).find(is_whole);
    whole.unwrap_or_else(|| set(last))
}

/// Puts what all headers say alike behind what differs, except names and models: where there is no room, it is dropped
/// first.
fn rank_by_difference(said: &mut [Vec<Part>]) {
    let of = |parts: &[Part], rank: u8| {
        parts.iter().filter(|p| p.rank == rank).map(Part::words).collect::<Vec<_>>()
    };
    let is_same =
        |rank: u8| rank > MODEL_RANK && said.windows(2).all(|pair| of(&pair[0], rank) == of(&pair[1], rank));
    let ranks: BTreeSet<_> = said.iter().flatten().map(|part| part.rank).collect();
    let mut order: Vec<_> = ranks.into_iter().map(|rank| (is_same(rank), rank)).collect();
    order.sort_unstable();
    let place = |rank: u8| order.iter().position(|(_, known)| *known == rank).unwrap_or_default();
    for parts in said.iter_mut() {
        parts.sort_by_key(|part| place(part.rank));
        // Parts of rank 0 are never dropped.
        for (i, part) in parts.iter_mut().filter(|part| part.rank > 0).enumerate() {
            part.continues = i > 0;
            part.rank = u8::try_from(place(part.rank) + 1).unwrap_or(u8::MAX);
        }
    }
}

/// The ranks of which the parts of every header fit, the first ones first, so that all headers say the same things; each
/// keeps its first part.
fn ranks_that_fit(said: &[Vec<Part>], fits: impl Fn(Vec<Part>, &[Part]) -> bool) -> BTreeSet<u8> {
    let least = said.iter().filter_map(|parts| Some(parts.first()?.rank)).max().unwrap_or_default();
    let ranks: BTreeSet<_> = said.iter().flatten().map(|part| part.rank).collect();
    let all_fit = |ranks: &BTreeSet<u8>| said.iter().all(|parts| fits(of_ranks(parts, ranks), parts));
    if all_fit(&ranks) {
        return ranks;
    }
    let (mut kept, more): (BTreeSet<_>, BTreeSet<_>) = ranks.into_iter().partition(|rank| *rank <= least);
    for rank in more {
        kept.insert(rank);
        if !all_fit(&kept) {
            kept.remove(&rank);
        }
    }
    kept
}

/// The parts with these ranks, none of which may be dropped.
fn of_ranks(parts: &[Part], ranks: &BTreeSet<u8>) -> Vec<Part> {
    let within = parts.iter().filter(|part| ranks.contains(&part.rank));
    within.map(|part| Part { rank: 0, ..part.clone() }).collect()
}

/// A view in words: that its picture is behind, its name, unless the description already contains it, and its
/// description.
fn in_parts(session: &Session, view: usize, registry: &Registry) -> Vec<Part> {
    let shown = view_parts(&session.document, (view, session.terms_of(view)), registry);
    let said = line(&shown).to_lowercase();
    let name = view.checked_sub(1).and_then(|i| session.document.variants.get(i)?.name.as_deref());
    let name = name.filter(|name| !said.contains(&name.to_lowercase()));
    let name = name.map(|name| Part::new(0, name));
    compiling(session, view).into_iter().chain(name).chain(shown).collect()
}

/// The menu of actions for a view.
fn menu(ui: &mut Ui, view: usize, context: &mut PanelContext<'_>) {
    let letter = LETTERS[view.min(MAX_VARIANTS)];
    let button = icon::button(ui, Icon::Down, &format!("Menu of view {letter}"));
    let id = ui.make_persistent_id(("view menu", view));
    let chosen = knob::drop_down(&button, id, 176.0, |ui, _| {
        let mut chosen = None;
        let mut item = |ui: &mut Ui, text: String, command: CompareCommand| {
            if ui.add(Button::new(text).frame(false)).clicked() {
                chosen = Some(command);
                Popup::close_id(ui.ctx(), id);
            }
        };
        if view > 0 {
            item(ui, format!("Make {letter} like A"), CompareCommand::LikeA(view));
            item(ui, format!("Swap A and {letter}"), CompareCommand::Swap(view));
            if matching::entry(ui, view) {
                context.act(Action::Match(MatchCommand::Ask(view)));
                Popup::close_id(ui.ctx(), id);
            }
            item(ui, format!("Remove view {letter}"), CompareCommand::Remove(view));
            ui.separator();
        }
        if context.session().document.variants.len() < MAX_VARIANTS {
            item(ui, "Add a view".to_owned(), CompareCommand::Add);
        } else {
            ui.label(theme::small(ui, "A scene has at most four views."));
        }
        chosen
    });
    context.actions.extend(chosen.map(Action::Compare));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Comparison, Scene, Variant};

    #[test]
    fn headers_drop_first_what_they_say_alike_and_use_all_of_the_room() {
        let part = |rank: u8, text: &str| Part { continues: rank > 1, ..Part::new(rank, text) };
        let mut said = ["Phong 15 1.0 all 0", "Blinn 60 1.0 diffuse +3"]
            .map(|words| words.split(' ').zip(1..).map(|(word, rank)| part(rank, word)).collect::<Vec<_>>());
        rank_by_difference(&mut said);
        assert_eq!(line(&said[0]), "Phong, 15, all, 0, 1.0", "that of both is last");
        let mut alike = ["15 0", "15 +3"]
            .map(|words| words.split(' ').zip(2..).map(|(word, rank)| part(rank, word)).collect::<Vec<_>>());
        rank_by_difference(&mut alike);
        assert_eq!(line(&alike[1]), "+3, 15", "only names and models stay where they are");
        let within = |room: usize| {
            let ranks = ranks_that_fit(&said, |parts, _| line(&parts).len() <= room);
            [0, 1].map(|i| line(&of_ranks(&said[i], &ranks)))
        };
        assert_eq!(within(40)[1], "Blinn, 60, diffuse, +3, 1.0");
        assert_eq!(within(18)[1], "Blinn, 60, diffuse");
        assert_eq!(within(16), ["Phong, 15, 0", "Blinn, 60, +3"].map(str::to_owned), "a later one has room");
        assert_eq!(within(2)[1], "Blinn", "the first part stays");
    }

    #[test]
    fn the_bar_leaves_a_low_window_half_of_its_height() {
        for layout in Layout::ALL {
            let scene = Scene {
                variants: vec![Variant::default()],
                comparison: Comparison { layout: *layout, ..Comparison::default() },
                ..Scene::default()
            };
            let session = Session::new(scene);
            for (width, height) in
                [(400.0, 40.0), (400.0, 90.0), (400.0, 400.0), (900.0, 60.0), (900.0, 500.0)]
            {
                let whole = Rect::from_min_size(pos2(100.0, 50.0), vec2(width, height));
                let all = arrange(&session, whole, 0.0, 0.0);
                assert!(!all.is_single(), "{layout:?}");
                let bar = all.bar.map_or(0.0, |bar| bar.height());
                assert!(bar <= 0.5 * height, "{layout:?} in {width} × {height}: {bar}");
                assert!(height < 400.0 || bar >= ROW, "{layout:?}: all of it where there is room");
            }
        }
    }
}
