//! Rows of an explanation: numbers rounded to three digits, with all digits in the tooltip, and colours with samples.

use super::pairs;
use crate::{
    explain::{
        self, Model, number, rounded, rounded_number_or_triple, rounded_triple, triple, triple_within,
    },
    panel::{
        linked::{self, linked},
        maths::{self, Sizes},
        prelude::*,
    },
    reflection::Term,
    text::superscript,
};

/// Number of digits shown.
pub(super) const DIGITS: usize = 3;
/// What a number with its standard error is.
const MEASURED: &str = "The integral and its standard error, from sixteen parts of the samples";
/// Number of digits in a tooltip.
const ALL: usize = 8;
/// Font size of a symbol in a row.
const SYMBOL: f32 = 14.0;
/// Width of a vector with its symbol, in points.
const VECTOR: f32 = 192.0;
/// Gap between a name, a sample and a value, in points.
const BETWEEN: f32 = 6.0;
/// Indentation of a line that follows from the one above, in points.
pub(super) const INDENT: f32 = 14.0;

/// A number rounded to three digits.
pub(super) fn short(v: f32) -> String {
    raised(&rounded(v, DIGITS))
}

/// A number rounded to `digits` digits, at most three.
pub(super) fn of_digits(v: f32, digits: usize) -> String {
    raised(&rounded(v, digits.min(DIGITS)))
}

/// Three numbers rounded to three digits.
pub(super) fn short_triple(v: Vec3) -> String {
    raised(&rounded_triple(v, DIGITS))
}

/// One number, or three if they differ.
pub(super) fn short_or_triple(v: Vec3) -> String {
    raised(&formula(v))
}

/// Powers of ten with superscript digits.
pub(in crate::panel) fn raised(text: &str) -> String {
    let mut power = false;
    let raise = |c: char| {
        power = c == '^' || power && !",) ".contains(c);
        (c != '^').then(|| if power { superscript(c) } else { c })
    };
    text.chars().filter_map(raise).collect()
}

/// One number, or three if they differ, in the notation of equations.
pub(super) fn formula(v: Vec3) -> String {
    rounded_number_or_triple(v, DIGITS)
}

/// Puts braces around exponents that begin with a minus sign.
fn braced(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("^−") {
        let end = rest[at + "^−".len()..]
            .find(|c: char| !c.is_ascii_digit())
            .map_or(rest.len(), |n| at + "^−".len() + n);
        out += &format!("{}^{{{}}}", &rest[..at], &rest[at + 1..end]);
        rest = &rest[end..];
    }
    out + rest
}

/// The title of a column or a block.
pub(super) fn heading(ui: &mut Ui, text: &str) {
    ui.add(Label::new(theme::strong(ui, text)).wrap());
}

/// A colour sample for the given display code.
pub(super) fn chip(ui: &mut Ui, [r, g, b]: [u8; 3], size: Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let stroke = Stroke::new(1.0, Palette::here(ui).weak);
    ui.painter().rect(rect, 3.0, Color32::from_rgb(r, g, b), stroke, StrokeKind::Inside);
    theme::says(&response, WidgetType::Label, format!("colour {r}, {g}, {b}"));
    response
}

/// A sample of linear light, clamped to the range of the display, and crossed out if it is not a number.
pub(super) fn sample(ui: &mut Ui, light: Vec3) {
    let side = SYMBOL * theme::scale_here(ui);
    let colour = theme::swatch(light.clamp(Vec3::ZERO, Vec3::ONE));
    let [r, g, b, _] = colour.to_array();
    let rect = chip(ui, [r, g, b], vec2(side, side)).rect.shrink(3.0);
    if !light.is_finite() {
        let stroke = Stroke::new(1.5, Palette::here(ui).error);
        ui.painter().line_segment([rect.left_top(), rect.right_bottom()], stroke);
        ui.painter().line_segment([rect.right_top(), rect.left_bottom()], stroke);
    }
}

fn text(ui: &Ui, text: impl Into<String>) -> RichText {
    let text: String = text.into();
    RichText::new(unbroken(ui, &text)).color(Palette::here(ui).text)
}

/// The text without breaks within triples of numbers, as far as the width of a line has room for each.
pub(super) fn unbroken(ui: &Ui, text: &str) -> String {
    let bound = bound(text);
    let font = theme::bold(ui);
    let fits = |word: &str| theme::width_in(ui, word, &font) <= ui.available_width();
    if bound == text || !bound.split(' ').all(fits) { text.to_owned() } else { bound }
}

/// A space at which no line ends.
const BOUND: &str = "\u{a0}";

/// The text with spaces at which no line ends within triples of numbers, and between `±` and what follows it.
fn bound(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, (inside, after))) =
        rest.split_once('(').and_then(|(before, tail)| Some((before, tail.split_once(')')?)))
    {
        let parts: Vec<_> = inside.split(", ").collect();
        let is_triple = parts.len() == 3 && parts.iter().all(|part| !part.contains([' ', '(']));
        let inside = if is_triple { parts.join(&format!(",{BOUND}")) } else { inside.to_owned() };
        out += &format!("{before}({inside})");
        rest = after;
    }
    (out + rest).replace("± ", &format!("±{BOUND}"))
}

/// The text without spaces at which a line could end.
pub(super) fn together(text: &str) -> String {
    text.replace(' ', BOUND)
}

/// The three numbers of a code, between which no line ends.
pub(super) fn codes([r, g, b]: [u8; 3]) -> String {
    together(&format!("{r}, {g}, {b}"))
}

/// A symbol, an equals sign and a value, with all digits in the tooltip.
pub(super) fn value(ui: &mut Ui, symbol: &str, shown: &str, all: &str) -> Response {
    linked_value(ui, symbol, &[symbol], |ctx| linked::is_lit(ctx, symbol), shown, all)
}

/// A value linked to symbols, and highlighted with them.
fn linked_value(
    ui: &mut Ui,
    symbol: &str,
    symbols: &[&str],
    lit: impl FnOnce(&Context) -> bool,
    shown: &str,
    all: &str,
) -> Response {
    let row = linked(ui, symbols, lit, |ui| {
        let row = ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            maths::symbol(ui, symbol, SYMBOL * theme::scale_here(ui));
            ui.add(Label::new(text(ui, format!("= {shown}"))).selectable(true));
        });
        row.response
    });
    let help = maths::meaning(symbol).map_or_else(String::new, |meaning| format!("\n{symbol}: {meaning}"));
    maths::tip(row, &format!("{all}{help}"))
}

/// Vectors with their symbols, as many per line as fit.
pub(super) fn vectors(ui: &mut Ui, model: &Model, all: &[(&str, Vec3)]) {
    let width = VECTOR * theme::scale_here(ui);
    let in_line = ((ui.available_width() / width) as usize).max(1);
    for line in all.chunks(in_line) {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            for (symbol, v) in line {
                let left = ui.cursor().left();
                let symbols = pairs::symbols(model, &[symbol]);
                let lit = |ctx: &Context| pairs::lit(ctx, model).contains(symbol);
                linked_value(ui, symbol, &symbols, lit, &short_triple(*v), &rounded_triple(*v, ALL));
                ui.add_space((left + width - ui.cursor().left()).max(8.0));
            }
        });
    }
}

/// A line of a name, a sample of light and a value, each as far as there is one. The sample stays beside its numbers.
fn line(ui: &mut Ui, name: RichText, light: Option<Vec3>, shown: RichText) -> Response {
    let row = ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = BETWEEN;
        let is_alone = name.is_empty();
        if !is_alone {
            ui.label(name);
        }
        if let Some(light) = light {
            let first = shown.text().split(' ').next().unwrap_or_default();
            if !is_alone && width_beside_sample(ui, first) > ui.available_size_before_wrap().x {
                ui.end_row();
            }
            sample(ui, light);
        }
        ui.add(Label::new(shown).selectable(true));
    });
    row.response
}

/// Width of a sample of light with numbers beside it, in bold at most.
fn width_beside_sample(ui: &Ui, shown: &str) -> f32 {
    SYMBOL * theme::scale_here(ui) + BETWEEN + theme::width_in(ui, shown, &theme::bold(ui))
}

/// Width of a colour with its sample in one line, rounded to the digits that a standard error justifies.
pub(super) fn width_of_estimate(ui: &Ui, v: Vec3, error: Option<Vec3>) -> f32 {
    width_beside_sample(ui, &short_within(v, error))
}

/// A name and a value.
pub(super) fn named(ui: &mut Ui, name: &str, shown: &str, all: &str) -> Response {
    let (name, shown) = (theme::small(ui, name), text(ui, shown));
    line(ui, name, None, shown).on_hover_text(all)
}

/// A name and three numbers.
pub(super) fn named_triple(ui: &mut Ui, name: &str, v: Vec3, unit: &str) -> Response {
    let shown = format!("{}{}", short_triple(v), together(unit));
    named(ui, name, &shown, &rounded_triple(v, ALL))
}

/// A name and three numbers, rounded to the digits that their standard errors justify.
pub(super) fn named_within(ui: &mut Ui, name: &str, v: Vec3, error: Option<Vec3>) -> Response {
    named(ui, name, &short_within(v, error), &all_within(v, error))
}

/// Three numbers rounded to three digits, or to those that their standard errors justify.
fn short_within(v: Vec3, error: Option<Vec3>) -> String {
    raised(&triple_within(v, error, DIGITS))
}

/// Three numbers with all digits, and their standard errors.
fn all_within(v: Vec3, error: Option<Vec3>) -> String {
    explain::told(v, error, ALL)
}

/// A step of the conversion to the display code, with its result and the standard error, if any.
pub(super) fn step(ui: &mut Ui, what: &str, v: Vec3, error: Option<Vec3>) {
    let (name, shown) = (theme::small(ui, format!("{what}:")), text(ui, short_within(v, error)));
    line(ui, name, Some(v), shown).on_hover_text(all_within(v, error));
}

/// A step whose standard error, if any, stands beside it.
pub(super) fn measured_step(ui: &mut Ui, what: &str, v: Vec3, error: Option<Vec3>) {
    let Some(error) = error else { return step(ui, what, v, None) };
    let (name, shown) = (theme::small(ui, format!("{what}:")), raised(&explain::measured(v, error)));
    line(ui, name, Some(v), text(ui, shown)).on_hover_text(MEASURED);
}

/// Sets a line spacing smaller than that of widgets.
pub(super) fn close(ui: &mut Ui) {
    ui.spacing_mut().item_spacing.y = 3.0;
    ui.spacing_mut().interact_size.y = 16.0 * theme::scale_here(ui);
}

/// A label and a colour: sample and numbers.
pub(super) fn light(ui: &mut Ui, before: &str, v: Vec3, bold: bool) -> Response {
    estimate(ui, before, v, None, bold)
}

/// A label and a colour, rounded to the digits that a standard error justifies.
pub(super) fn estimate(ui: &mut Ui, before: &str, v: Vec3, error: Option<Vec3>, bold: bool) -> Response {
    let (name, shown) = (text(ui, before), value_text(ui, short_within(v, error), bold));
    line(ui, name, Some(v), shown).on_hover_text(all_within(v, error))
}

/// A label and a colour, with its standard error if it has one.
pub(super) fn told(ui: &mut Ui, before: &str, v: Vec3, error: Option<Vec3>, bold: bool) {
    match error {
        Some(error) => measured(ui, before, v, error, bold),
        None => drop(light(ui, before, v, bold)),
    }
}

/// A label and a colour with its standard error, rounded to the digits that the error justifies.
pub(super) fn measured(ui: &mut Ui, before: &str, v: Vec3, error: Vec3, bold: bool) {
    let (name, shown) = (text(ui, before), value_text(ui, raised(&explain::measured(v, error)), bold));
    line(ui, name, Some(v), shown).on_hover_text(MEASURED);
}

fn value_text(ui: &Ui, shown: String, bold: bool) -> RichText {
    if bold { theme::strong(ui, unbroken(ui, &shown)) } else { text(ui, shown) }
}

/// Looks up the meaning of a symbol.
pub(super) type Name<'a> = &'a dyn Fn(&str) -> Option<String>;

/// An equation, symbolic or with numbers, over the remaining width.
pub(super) fn equation(ui: &mut Ui, term: Term, line: &str, indent: bool, name: Name<'_>) {
    let sizes = Sizes { column: true, even: true, level: false };
    let line = &braced(line);
    indented(ui, if indent { INDENT } else { 0.0 }, |ui| {
        maths::equation_of(ui, &[(term, line)], sizes, name)
    });
}

/// An equation with numbers, each of which shows its origin. Returns the symbol of a clicked number.
pub(super) fn calculation(
    ui: &mut Ui,
    numbers: &str,
    symbols: &[Option<String>],
    name: Name<'_>,
) -> Option<String> {
    indented(ui, INDENT, |ui| maths::calculation(ui, &format!("= {numbers}"), symbols, name))
}

/// Indents what follows from the line above.
pub(super) fn inset(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    indented(ui, INDENT, |ui| {
        ui.spacing_mut().item_spacing.x = 8.0;
        add(ui);
    });
}

fn indented<R>(ui: &mut Ui, by: f32, add: impl FnOnce(&mut Ui) -> R) -> R {
    let row = ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        if by > 0.0 {
            ui.add_space(by);
        }
        ui.vertical(add).inner
    });
    row.inner
}

/// A number with all digits.
pub(super) fn all(v: f32) -> String {
    rounded(v, ALL)
}

/// Text for screen readers: four digits are enough.
pub(super) fn spoken(v: Vec3) -> String {
    if v.x == v.y && v.y == v.z { number(v.x) } else { triple(v) }
}

/// The background and the triangle of a clickable row that unfolds.
pub(super) fn fold_row(ui: &mut Ui, rect: Rect, id: Id, says: &str, open: bool) -> Response {
    let under = ui.painter().add(Shape::Noop);
    let response = icon::fold(ui, rect, id, says, open);
    if theme::is_hot(&response) {
        ui.painter().set(under, Shape::rect_filled(rect, 3.0, Palette::here(ui).hovered));
    }
    response
}

/// A clickable row, with a triangle that shows if it is unfolded.
pub(super) fn fold(
    ui: &mut Ui,
    id: Id,
    (name, kind): (&str, &str),
    open: bool,
    (v, error): (Vec3, Option<Vec3>),
) -> Response {
    let palette = Palette::here(ui);
    let height = 24.0 * theme::scale_here(ui).max(1.0);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let response = fold_row(ui, rect, id, &format!("{name}: {}", spoken(v)), open);
    let inside = UiBuilder::new().max_rect(rect.with_min_x(rect.left() + 20.0));
    let mut inner = ui.new_child(inside.layout(Layout::right_to_left(Align::Center)));
    inner.spacing_mut().item_spacing.x = 6.0;
    inner.label(theme::strong(&inner, short_within(v, error)));
    sample(&mut inner, v);
    let room = (inner.available_width() - 4.0).max(0.0);
    let title = theme::elided(ui, name, theme::bold(ui), palette.text, room);
    let at = pos2(rect.left() + 20.0, rect.center().y - 0.5 * title.size().y);
    let end = at.x + title.size().x + 6.0;
    ui.painter().galley(at, title, palette.text);
    let kind = theme::elided(ui, kind, TextStyle::Small, palette.weak, rect.left() + 20.0 + room - end);
    let at = pos2(end, rect.center().y - 0.5 * kind.size().y);
    ui.painter().galley(at, kind, palette.weak);
    response.on_hover_text(all_within(v, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_ends_within_a_triple_or_after_a_sign_of_an_error() {
        let spaced = |text: &str| bound(text).replace(BOUND, "_");
        for (text, expected) in [
            ("(0.1, 2·10⁻⁷, −3)", "(0.1,_2·10⁻⁷,_−3)"),
            (
                "= (1, 2, 3) × 0.5 = (0.5, 1, 1.5) ± (0.1, 0.2, 0.3)",
                "= (1,_2,_3) × 0.5 = (0.5,_1,_1.5) ±_(0.1,_0.2,_0.3)",
            ),
            ("0.5 ± 0.1", "0.5 ±_0.1"),
            ("light (the brighter, of two, is meant)", "light (the brighter, of two, is meant)"),
            ("max(0, (1, 2, 3)) and (", "max(0, (1, 2, 3)) and ("),
            ("none", "none"),
        ] {
            assert_eq!(spaced(text), expected);
        }
        assert_eq!(codes([1, 22, 255]).replace(BOUND, "_"), "1,_22,_255");
    }

    #[test]
    fn powers_are_raised() {
        assert_eq!(short(1.234e-7), "1.23·10⁻⁷");
        assert_eq!(short_triple(Vec3::new(2e30, -1e-9, 0.5)), "(2·10³⁰, −1·10⁻⁹, 0.5)");
        assert_eq!(short_or_triple(Vec3::splat(0.333_333)), "0.333");
        assert_eq!(short(f32::NAN), "NaN");
        assert_eq!(braced("a^2 × (1·10^−7, 2·10^−12) b^α"), "a^2 × (1·10^{−7}, 2·10^{−12}) b^α");
        assert_eq!(braced("x^−"), "x^{−}");
        assert_eq!(formula(Vec3::splat(1e-7)), "1·10^−7");
    }
}
