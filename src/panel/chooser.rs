//! The chooser of reflection models: a searchable list with name, author and year, grouped by family.

use std::{cell::RefCell, collections::HashMap};

use bevy_egui::egui::{
    Margin, Modifiers, PopupCloseBehavior, RectAlign, TextEdit, Tooltip, text_edit::TextEditState,
};

use super::{author, keys, narrow, prelude::*};
use crate::{
    optics::distribution::GGX,
    parameter::Parameter,
    reflection::{Family, ModelEntry},
    text::facts,
};

/// True if every word of a search begins a word of a text, in any order.
#[must_use]
pub fn matches(text: &str, search: &str) -> bool {
    let plain = |s: &str| s.to_lowercase().replace(['–', '-', '_', ',', '&', '(', ')'], " ");
    let text = plain(text);
    plain(search).split_whitespace().all(|word| text.split_whitespace().any(|found| found.starts_with(word)))
}

/// Other names of a model: those that it declares, and of GGX both.
fn synonyms(model: &ModelEntry) -> impl Iterator<Item = &'static str> {
    let [declared, other] = GGX;
    let all = model.declaration.synonyms;
    all.iter().copied().chain(all.contains(&declared).then_some(other))
}

/// The short names of parameters, by their labels: `ior` finds each model with a refractive index, whatever its name there.
pub(super) type ShortNames = HashMap<&'static str, Vec<&'static str>>;

/// The short names in a registry.
pub(super) fn short_names(registry: &Registry) -> ShortNames {
    let mut all = ShortNames::new();
    for p in registry.material_parameters().filter(|p| !p.name.contains('_') && p.name != p.label) {
        all.entry(p.label).or_default().push(p.name);
    }
    all
}

/// Everything by which a model is found beside its [`words`]: synonyms, then its parameters and their choices. Each with
/// what people call it.
pub(super) fn further(model: &ModelEntry, short: &ShortNames) -> Vec<(String, String)> {
    let of = |parameter: &'static Parameter| {
        let label = parameter.label;
        let names = short.get(label).map(|names| names.join(" ")).unwrap_or_default();
        let own = (format!("{label} {} {} {names}", parameter.symbol, parameter.name), label.to_owned());
        let choices = if parameter.kind.is_flag() { &[][..] } else { parameter.kind.options() };
        let choice = move |(id, name): &(&str, &str)| (format!("{name} {id}"), format!("{label}: {name}"));
        std::iter::once(own).chain(choices.iter().map(choice))
    };
    let synonyms = synonyms(model).map(|synonym| (synonym.to_owned(), synonym.to_owned()));
    synonyms.chain(model.parameters.iter().flat_map(of)).collect()
}

/// The author of a model, after its id if another has the same name.
pub(super) fn author_of(model: &ModelEntry, registry: &Registry) -> String {
    let d = model.declaration;
    let is_shared =
        registry.models().iter().any(|m| m.declaration.name == d.name && m.declaration.id != d.id);
    facts([if is_shared { d.id } else { "" }, d.author])
}

/// The reason that a search finds a text which only the tooltip shows.
pub(super) const DESCRIPTION: &str = "in the description";

/// The words by which a model is found first, each with what people call it; besides its name.
pub(super) fn words(model: &ModelEntry) -> [(String, String); 4] {
    let d = model.declaration;
    let all =
        [(d.author, d.author), (d.family.name(), d.family.name()), (d.summary, DESCRIPTION), (d.id, d.id)];
    all.map(|(text, name)| (text.to_owned(), name.to_owned()))
}

/// The name of what matches a search though nobody sees it, such as a synonym, a parameter or a choice; `None` if the
/// row already shows why the search matches.
pub(super) fn reason<'a>(
    shown: &str,
    unseen: impl Iterator<Item = &'a (String, String)> + Clone,
    search: &str,
) -> Option<String> {
    let lower = shown.to_lowercase();
    let is_seen = |word: &str| matches(shown, word) || lower.contains(&word.to_lowercase());
    let name = |word| unseen.clone().find(|(text, _)| matches(text, word)).map(|(_, name)| name.clone());
    search.split_whitespace().filter(|word| !is_seen(word)).find_map(name)
}

/// Models that match a search, in the order of the chooser: the model of that very name first, then matching names, then
/// matching synonyms, then by family and registration order; the other models of a family follow its first. Every word of the
/// search must begin a word of the name, id, author, family, summary, a synonym, a parameter or one of its choices.
#[must_use]
pub fn find<'a>(registry: &'a Registry, search: &str) -> Vec<&'a ModelEntry> {
    let mut families = Vec::new();
    for model in registry.models() {
        if !families.contains(&model.declaration.family) {
            families.push(model.declaration.family);
        }
    }
    let short = short_names(registry);
    let hit = |m: &&ModelEntry| {
        let all: Vec<_> = words(m).into_iter().chain(further(m, &short)).map(|(text, _)| text).collect();
        matches(&format!("{} {}", m.declaration.name, all.join(" ")), search)
    };
    let mut found: Vec<_> = families
        .iter()
        .flat_map(|f| registry.models().iter().filter(move |m| m.declaration.family == *f))
        .filter(hit)
        .collect();
    let whole = search.trim().to_lowercase();
    found.sort_by_key(|m| {
        let d = m.declaration;
        let names = [d.name, d.id].join(" ");
        let with_synonyms = synonyms(m).fold(names.clone(), |all, synonym| all + " " + synonym);
        match (matches(&names, search), matches(&with_synonyms, search)) {
            _ if [d.name, d.id].iter().any(|name| name.to_lowercase() == whole) => 0,
            (true, _) => 1,
            (_, true) => 2,
            _ => 3,
        }
    });
    let mut headings = Vec::new();
    for family in found.iter().map(|m| m.declaration.family) {
        if !headings.contains(&family) {
            headings.push(family);
        }
    }
    found.sort_by_key(|m| headings.iter().position(|family| *family == m.declaration.family));
    found
}

/// One line of a [`list`].
#[derive(Clone, Debug, Default)]
pub struct Entry<'a> {
    /// Name of the group, shown as a heading where it changes; empty for no group.
    pub heading: &'a str,
    /// Name of the entry.
    pub name: &'a str,
    /// Additional information, at the right.
    pub note: String,
    /// The number key that chooses the entry.
    pub number: Option<usize>,
    /// Colour of the entry's swatch.
    pub swatch: Option<Color32>,
    /// True if this is the current choice.
    pub current: bool,
    /// The key, in a column at the right end; `None` where entries have none.
    pub key: Option<String>,
    /// True if it is switched on, as a check mark says.
    pub on: bool,
    /// True if it cannot be chosen.
    pub off: bool,
}

/// The words of a [`list`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Words {
    /// Name of the search field for screen readers, such as "Search reflection models".
    pub label: &'static str,
    /// Hint in the empty search field.
    pub hint: &'static str,
    /// Text shown when nothing matches.
    pub none: &'static str,
    /// Footer of the list.
    pub foot: &'static str,
    /// True if the search is the first thing to see.
    pub roomy: bool,
}

/// Forgets the search text of a [`list`], so that the list opens fresh.
pub fn forget(ctx: &Context, id: Id) {
    ctx.data_mut(|d| {
        d.remove::<String>(id.with("search"));
        d.remove::<usize>(id.with("row"));
    });
}

/// Sets the search text of a [`list`], with the cursor behind it.
pub(super) fn begin(ctx: &Context, id: Id, text: String) {
    ctx.data_mut(|d| d.insert_temp(id.with("search"), text));
    TextEditState::default().store(ctx, id.with("text"));
}

/// Width of the text beside a list, in points.
const TIP: f32 = 320.0;

/// A list with a search field and arrow-key navigation, at most `height` points high. Returns the chosen item. Call
/// [`forget`] while the list is hidden.
pub fn list<'e, T>(
    ui: &mut Ui,
    id: Id,
    words: Words,
    height: f32,
    find: impl Fn(&str) -> Vec<T>,
    entry: impl Fn(&T) -> Entry<'e>,
    tip: impl Fn(&mut Ui, &T),
) -> Option<T> {
    let (search_id, row_id) = (id.with("search"), id.with("row"));
    let mut search: String = ui.data(|d| d.get_temp(search_id)).unwrap_or_default();
    let mut found = find(&search);
    let before: Option<usize> = ui.data(|d| d.get_temp(row_id));
    let start = found.iter().position(|t| entry(t).current).unwrap_or(0);
    let at = before.unwrap_or(start).min(found.len().saturating_sub(1));
    let (mut row, mut chosen) = walked(ui, id, at, found.len());
    let moved = before.is_none() || row != at;
    let edit = search_field(ui, id, words, &mut search);
    if before.is_none() {
        edit.request_focus();
    }
    ui.add_space(4.0);
    ScrollArea::vertical().max_height(height).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        ui.spacing_mut().item_spacing.y = 2.0;
        if found.is_empty() {
            ui.weak(words.none);
        }
        let mut heading = "";
        for (i, item) in found.iter().enumerate() {
            let entry = entry(item);
            if heading != entry.heading {
                heading = entry.heading;
                ui.add_space(if i == 0 { 0.0 } else { 6.0 });
                ui.label(theme::strong(ui, heading).small());
            }
            let response = list_row(ui, &entry, i == row);
            if i == row && moved {
                response.scroll_to_me(None);
            }
            if response.hovered() && ui.input(|i| i.pointer.delta() != Vec2::ZERO) {
                row = i;
            }
            if response.clicked() {
                chosen = Some(i);
            }
            beside(ui, &response, |ui| tip(ui, item));
        }
    });
    ui.separator();
    theme::note(ui, words.foot);
    if edit.changed() {
        row = 0;
    }
    ui.data_mut(|d| {
        d.insert_temp(row_id, row);
        d.insert_temp(search_id, search);
    });
    chosen.filter(|i| !entry(&found[*i]).off).map(|i| found.swap_remove(i))
}

/// The row that the arrow keys reach from another, and the one that Enter chooses. The keys are consumed before the
/// search field sees them.
fn walked(ui: &Ui, id: Id, mut row: usize, count: usize) -> (usize, Option<usize>) {
    // If Tab has reached a button below, Enter presses that button.
    let elsewhere = ui.memory(|m| m.focused()).is_some_and(|focus| focus != id.with("text"));
    ui.input_mut(|i| {
        if i.consume_key(Modifiers::NONE, Key::ArrowDown) && row + 1 < count {
            row += 1;
        }
        if i.consume_key(Modifiers::NONE, Key::ArrowUp) && row > 0 {
            row -= 1;
        }
        let enters = !elsewhere && i.consume_key(Modifiers::NONE, Key::Enter) && row < count;
        (row, enters.then_some(row))
    })
}

fn search_field(ui: &mut Ui, id: Id, words: Words, search: &mut String) -> Response {
    let edit = TextEdit::singleline(search)
        .id(id.with("text"))
        .hint_text(words.hint)
        .margin(if words.roomy { Margin::symmetric(10, 7) } else { Margin::symmetric(4, 2) })
        .desired_width(f32::INFINITY);
    let edit = ui.add(edit);
    theme::names_field(&edit, words.label, ["", &*search, words.hint]);
    edit
}

/// The tooltip of an entry, beside the list: anywhere else it would hide the next entries.
fn beside(ui: &Ui, entry: &Response, tip: impl FnOnce(&mut Ui)) {
    let screen = ui.ctx().content_rect();
    let room = (screen.right() - entry.rect.right()).max(entry.rect.left() - screen.left());
    if room < TIP + 32.0 {
        return;
    }
    let mut tooltip = Tooltip::for_enabled(entry);
    let popup = tooltip.popup.align(RectAlign::RIGHT_START);
    tooltip.popup = popup.align_alternatives(&[RectAlign::LEFT_START]).gap(16.0);
    tooltip.show(|ui| {
        ui.set_max_width(TIP);
        tip(ui);
    });
}

/// The width of the column of keys, points.
const KEYS: f32 = 96.0;

fn list_row(ui: &mut Ui, entry: &Entry, marked: bool) -> Response {
    let palette = Palette::here(ui);
    let size = vec2(ui.available_width(), narrow::high(ui.ctx(), 24.0));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let info = || WidgetInfo::selected(WidgetType::SelectableLabel, !entry.off, entry.current, entry.name);
    response.widget_info(info);
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let painter = ui.painter_at(rect);
    if marked {
        painter.rect_filled(rect, 4.0, palette.chosen);
    }
    if entry.current {
        let bar = Rect::from_min_size(rect.min, vec2(3.0, rect.height()));
        painter.rect_filled(bar, 1.0, palette.accent);
    }
    let y = rect.center().y;
    if let Some(number) = entry.number {
        let small = TextStyle::Small.resolve(ui.style());
        let at = pos2(rect.left() + 16.0, y);
        painter.text(at, Align2::CENTER_CENTER, number, small, palette.weak);
    }
    let mut left = rect.left() + 30.0;
    if let Some(colour) = entry.swatch {
        left = rect.left() + 10.0;
        let sample = Rect::from_min_size(pos2(left, y - 7.0), vec2(22.0, 14.0));
        painter.rect(sample, 3.0, colour, Stroke::new(1.0, palette.weak), StrokeKind::Inside);
        left += 30.0;
    }
    let mut right = rect.right() - 6.0;
    if let Some(key) = &entry.key {
        left = rect.left() + 26.0;
        if entry.on {
            let sign = Rect::from_center_size(pos2(rect.left() + 13.0, y), vec2(11.0, 11.0));
            icon::paint(&painter, sign, Icon::Check, palette.accent);
        }
        // A phone has no keys.
        if !narrow::is(ui.ctx()) {
            let key = theme::elided(ui, key, TextStyle::Body, palette.weak, KEYS);
            painter.galley(pos2(right - key.size().x, y - key.size().y / 2.0), key, palette.weak);
            right -= KEYS;
        }
    }
    let ink = if entry.off { palette.weak } else { palette.text };
    let name = theme::elided(ui, entry.name, TextStyle::Body, ink, right - left);
    let room = right - left - name.size().x - 12.0;
    painter.galley(pos2(left, y - name.size().y / 2.0), name, ink);
    let note = theme::elided(ui, &entry.note, TextStyle::Small, palette.weak, room);
    painter.galley(pos2(right - note.size().x, y - note.size().y / 2.0), note, palette.weak);
    response
}

const MODELS: Words = Words {
    label: "Search reflection models",
    hint: "Search: name, author, year, GGX, metalness…",
    none: "No model has that in its name, author, year, description, parameters or choices.",
    foot: "↑ ↓ Enter choose · Esc closes · 1–9 without this list",
    roomy: false,
};

/// The reason why a search finds a model, if its row and the heading above do not show it.
fn why(model: &ModelEntry, short: &ShortNames, search: &str) -> Option<String> {
    let d = model.declaration;
    let unseen: Vec<_> = further(model, short).into_iter().chain(words(model)).collect();
    reason(&[d.name, d.author, d.family.name()].join(" "), unseen.iter(), search)
}

/// The list of models. `current` is the id of the selected model. `first` labels an entry before all models that stands
/// for none of them; choosing it returns `Some(None)`.
pub fn models<'a>(
    ui: &mut Ui,
    id: Id,
    height: f32,
    session: &Session,
    registry: &'a Registry,
    current: Option<&str>,
    first: Option<&'a str>,
) -> Option<Option<&'a ModelEntry>> {
    // Each row shows why it matches.
    let search = RefCell::new(String::new());
    let short = short_names(registry);
    let found = |typed: &str| {
        typed.clone_into(&mut search.borrow_mut());
        let plain = first.filter(|_| typed.trim().is_empty()).map(|_| None);
        plain.into_iter().chain(find(registry, typed).into_iter().map(Some)).collect()
    };
    let entry = |model: &Option<&'a ModelEntry>| -> Entry<'a> {
        let Some(model) = *model else {
            let current = current.is_none();
            return Entry { name: first.unwrap_or_default(), current, ..Entry::default() };
        };
        let (d, author) = (model.declaration, author_of(model, registry));
        Entry {
            heading: d.family.name(),
            name: d.name,
            note: match why(model, &short, &search.borrow()) {
                Some(reason) => facts([&reason, &author]),
                None => author,
            },
            number: session.model_slots.iter().position(|m| m == d.id).map(|slot| slot + 1),
            current: current == Some(d.id),
            ..Entry::default()
        }
    };
    list(ui, id, MODELS, height, found, entry, |ui, model| {
        if let Some(model) = model {
            about(ui, model);
        }
    })
}

/// The tooltip of a model.
pub fn about(ui: &mut Ui, model: &ModelEntry) {
    let d = model.declaration;
    let palette = Palette::here(ui);
    ui.label(theme::strong(ui, d.name));
    if !d.summary.is_empty() {
        ui.label(d.summary);
    }
    // For a custom model, an unclaimed law is unknown rather than violated.
    let own = d.family == Family::Custom;
    for (law, holds) in d.laws.list().into_iter().filter(|(_, holds)| *holds || !own) {
        let text = if holds { format!("✓ {law}") } else { format!("✗ not {law}") };
        ui.label(RichText::new(text).small().color(if holds { palette.text } else { palette.weak }));
    }
    if !d.source.is_empty() {
        ui.label(theme::small(ui, d.source));
    }
}

/// Width of the button, in points.
pub const WIDTH: f32 = 160.0;

/// Id of the list at the top of the window.
const CHOOSER: &str = "reflection chooser";

/// Shows the button and, if open, the list. They refer to the selected object's model override if there is one,
/// otherwise to the model of the scene.
pub fn show(ui: &mut Ui, width: f32, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let palette = Palette::here(ui);
    let shown = session.model_shown();
    let current = registry.model(shown);
    let name = current.map_or(shown, |m| m.declaration.name);
    let size = vec2(width, narrow::high(ui.ctx(), 24.0));
    let button = Button::new(theme::strong(ui, name))
        .right_text(RichText::new("▾").color(palette.weak))
        .min_size(size - vec2(28.0, 0.0))
        .truncate();
    // Marks the button even where the bar has no room to say that this is the model of one object.
    let of = session.model_of(registry);
    let button = if of.is_some() { button.stroke(Stroke::new(1.5, palette.accent)) } else { button };
    let response = ui.add_sized(size, button);
    theme::says(&response, WidgetType::ComboBox, format!("Reflection model: {name}"));
    context.on_click(&response, || Action::View(ViewChange::Chooser(!session.view.chooser_open)));
    if session.view.chooser_open {
        let height = ui.ctx().content_rect().bottom() - response.rect.bottom() - 156.0;
        opened(Popup::from_response(&response), height, context);
    } else if let Some(model) = current {
        theme::tip(response, 320.0, |ui| {
            if let Some(name) = &of {
                ui.label(format!("The model of {name} alone, in place of the scene’s."));
            }
            about(ui, model);
            let key = keys::word(ui.ctx(), "choose_model");
            ui.label(theme::small(ui, format!("key {key} chooses another")));
        });
    }
}

/// The list alone, in a corner of a presentation, which has no bar; the equation is in the opposite corner.
pub(super) fn alone(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    if !session.view.chooser_open {
        forget(ui.ctx(), Id::new(CHOOSER));
    } else if session.view.presenting {
        let screen = ui.ctx().content_rect();
        let at = screen.right_top() + vec2(-theme::UNIT, theme::UNIT);
        let popup = Popup::new(Id::new(CHOOSER), ui.ctx().clone(), at, egui::LayerId::background());
        opened(popup.align(RectAlign::BOTTOM_END), screen.height() - 172.0, context);
    }
}

/// Shows the list in its popup, at most `height` points high.
fn opened(popup: Popup, height: f32, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let ctx = popup.ctx().clone();
    let around = ctx.global_style().spacing.menu_margin.sum().x;
    let (id, width) = (Id::new(CHOOSER), narrow::wide(&ctx, 460.0, around));
    let (mut open, mut chosen) = (true, None);
    let asked = context.actions.len();
    let popup = popup.id(id).open_bool(&mut open).width(width);
    popup.close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.set_width(width);
        chosen = models(ui, id, height, session, registry, Some(session.model_shown()), None).flatten();
        ui.separator();
        author::buttons(ui, context);
    });
    // A clicked button closes the list: the dialog that follows stands alone.
    open &= asked == context.actions.len() && chosen.is_none();
    context.edits(chosen.map(|model| session.edit_model(model.declaration.id)));
    if !open {
        context.act(Action::View(ViewChange::Chooser(false)));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::shader::{
        compose::{OPTICS, TRANSMISSION},
        definitions::functions,
    };

    #[test]
    fn every_model_is_listed_and_words_in_any_order_find_it() {
        let registry = Registry::builtin();
        assert_eq!(find(&registry, "").len(), registry.models().len());
        let ids = |s: &str| find(&registry, s).iter().map(|m| m.declaration.id).collect::<Vec<_>>();
        assert_eq!(ids("1977 blinn phong"), ["blinn_phong", "blinn_phong_normalised"]);
        assert_eq!(ids("hill eon"), ["eon"]);
        for (search, first) in [("ward", "ward"), ("torrance", "torrance_sparrow"), ("disney", "disney")] {
            assert_eq!(ids(search).first(), Some(&first), "{search}");
        }
        assert!(ids("no such model").is_empty());
    }

    #[test]
    fn the_model_of_that_very_name_comes_first() {
        let registry = Registry::builtin();
        for model in registry.models() {
            let d = model.declaration;
            for search in [d.name.to_owned(), d.id.to_owned(), format!(" {} ", d.name.to_uppercase())] {
                let first = find(&registry, &search).first().map(|m| m.declaration.id);
                assert_eq!(first, Some(d.id), "{search}");
            }
        }
    }

    #[test]
    fn models_are_found_by_synonyms_parameters_and_choices() {
        let registry = Registry::builtin();
        let ids = |s: &str| find(&registry, s).iter().map(|m| m.declaration.id).collect::<Vec<_>>();
        for search in ["ggx", "GGX", "Trowbridge–Reitz", "trowbridge reitz", "PBR"] {
            for id in ["microfacet", "metallic_roughness", "disney", "openpbr"] {
                assert!(ids(search).contains(&id), "{search}: {:?}", ids(search));
            }
            assert!(!ids(search).contains(&"lambert"), "{search}");
        }
        for (search, id) in [
            ("metalness", "metallic_roughness"),
            ("plastic", "phong"),
            ("clearcoat", "openpbr"),
            // A parameter by its label, its name and its symbol.
            ("shininess", "blinn_phong"),
            ("sheen_tint", "disney"),
            ("alpha_x", "ward"),
            ("α", "phong"),
            // A choice.
            ("beckmann", "microfacet"),
            // All of these together, with the year.
            ("ggx 2012 clearcoat", "disney"),
        ] {
            assert!(ids(search).contains(&id), "{search}: {:?}", ids(search));
        }
        // A name comes before everything else, and a synonym before a parameter.
        assert_eq!(ids("disney").first(), Some(&"disney"));
        assert_eq!(ids("ggx").first(), Some(&"microfacet"));
        let microfacet = registry.model("microfacet").expect("built in");
        let short = short_names(&registry);
        let why_of = |model: &ModelEntry, search: &str| why(model, &short, search).unwrap_or_default();
        assert_eq!(why_of(microfacet, "microfacet ggx"), "GGX");
        assert_eq!(
            why_of(microfacet, "masking"),
            "masking",
            "a parameter: the row does not show the summary"
        );
        let disney = registry.model("disney").expect("built in");
        assert_eq!(
            (why_of(disney, "sheen").as_str(), why_of(disney, "cloth").as_str()),
            ("sheen", DESCRIPTION)
        );
        let shown = ["disney", "isney"].map(|search| why(disney, &short, search));
        assert_eq!(shown, [None, None], "the name shows it");
        assert!(why_of(microfacet, "kelemen").ends_with(": Kelemen"), "a choice, after its parameter");
        assert_eq!(why_of(registry.model("disney").expect("built in"), "sheen_tint"), "sheen tint");
        assert_eq!(why_of(registry.model("openpbr").expect("built in"), "sheen"), "sheen");
    }

    #[test]
    fn a_short_name_finds_all_parameters_of_that_label() {
        let registry = Registry::builtin();
        let short = short_names(&registry);
        let found = find(&registry, "ior");
        for id in ["microfacet", "openpbr", "glass", "thin_glass", "rough_dielectric"] {
            let model =
                found.iter().find(|m| m.declaration.id == id).unwrap_or_else(|| panic!("{id} is found"));
            assert_eq!(why(model, &short, "ior").as_deref(), Some("refractive index"), "{id}");
        }
        assert!(found.iter().all(|m| m.declaration.id != "lambert"));
    }

    #[test]
    fn each_heading_stands_once() {
        let registry = Registry::builtin();
        for search in ["", "beckmann", "roughness", "ggx", "a", "phong"] {
            let mut headings: Vec<_> = find(&registry, search).iter().map(|m| m.declaration.family).collect();
            headings.dedup();
            let twice = headings.iter().enumerate().find(|(i, family)| headings[..*i].contains(family));
            assert!(twice.is_none(), "{search}: {headings:?}");
        }
    }

    /// WGSL without comments.
    fn code(text: &str) -> String {
        text.lines().filter_map(|line| line.split("//").next()).collect::<Vec<_>>().join("\n")
    }

    /// The names of the functions that a WGSL text calls.
    fn calls(text: &str) -> Vec<&str> {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let named = text.match_indices('(').map(|(at, _)| {
            let before = text[..at].trim_end();
            &before[before.trim_end_matches(word).len()..]
        });
        named.filter(|name| !name.is_empty()).collect()
    }

    /// True if a model calls the distribution, itself or by functions of the vocabulary of the models.
    fn calls_ggx(model: &ModelEntry) -> bool {
        let vocabulary: Vec<_> = OPTICS.iter().chain(TRANSMISSION).map(|source| code(source.text)).collect();
        let mut bodies = HashMap::new();
        for text in &vocabulary {
            let all = functions(text);
            for (i, (at, name)) in all.iter().enumerate() {
                let end = all.get(i + 1).map_or(text.len(), |(next, _)| *next);
                bodies.insert(*name, &text[at + name.len()..end]);
            }
        }
        let text = code(model.declaration.wgsl.text);
        for (_, own) in functions(&text) {
            bodies.remove(own);
        }
        let mut open = vec![&*text];
        while let Some(text) = open.pop() {
            for name in calls(text) {
                if name == "ggx" {
                    return true;
                }
                // Each is followed once.
                open.extend(bodies.remove(name));
            }
        }
        false
    }

    #[test]
    fn every_model_with_ggx_is_found_by_both_of_its_names() {
        let registry = Registry::builtin();
        let has_ggx = |model: &&ModelEntry| {
            let mut options = model.parameters.iter().flat_map(|p| p.kind.options());
            // One writes it out, and says so.
            let names_it = model.declaration.wgsl.text.to_lowercase().contains("ggx");
            names_it || calls_ggx(model) || options.any(|(id, _)| *id == "ggx")
        };
        let with: Vec<_> = registry.models().iter().filter(has_ggx).map(|m| m.declaration.id).collect();
        for (id, has_it) in [
            ("microfacet", true),
            ("metallic_roughness", true),
            ("disney", true),
            ("openpbr", true),
            ("rough_dielectric", true),
            ("thin_glass", true),
            ("glass", true),
            ("cook_torrance", false),
            ("ward", false),
        ] {
            assert_eq!(with.contains(&id), has_it, "{id}: {with:?}");
        }
        let short = short_names(&registry);
        for search in ["ggx", "trowbridge", "Reitz"] {
            let found = find(&registry, search);
            for id in &with {
                let model = found.iter().find(|m| m.declaration.id == *id);
                assert!(model.is_some_and(|m| why(m, &short, search).is_some()), "{id} by {search}");
            }
        }
    }
}
