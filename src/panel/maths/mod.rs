//! Equations in mathematical notation: slanted variables, upright words, subscripts and superscripts.
//! [`typeset`](super::typeset) sets fractions and breaks lines.
//!
//! The source format is that of [`EquationPart`]: `_x` is a subscript, `^x` a superscript, braces group.

use super::{
    formula, linked,
    prelude::*,
    typeset::{Break, Set, Setter},
};
use crate::reflection::{EquationPart, Term};

mod laid;
mod meaning;
mod prose;

pub use crate::text::mathematics::{Atom, parse, parse_symbol, same_symbol};
pub(super) use laid::{Laid, lay_out};
pub use meaning::{definition, definitions, has_symbol, meaning};
pub use prose::prose;
pub(super) use prose::tip;

/// Paints one symbol in the colour of text; returns its width. `left_baseline` is the left end of the baseline.
pub fn paint_symbol(ui: &Ui, left_baseline: Pos2, symbol: &str, size: f32, colour: Color32) -> f32 {
    let laid = lay_out(ui, &parse_symbol(symbol), size, colour);
    for piece in laid.pieces {
        ui.painter().galley(left_baseline + piece.offset, piece.galley, colour);
    }
    laid.width
}

/// One symbol as a widget.
pub fn symbol(ui: &mut Ui, symbol: &str, size: f32) -> Response {
    let width = symbol_width(ui, symbol, size);
    let (rect, response) = ui.allocate_exact_size(vec2(width, 1.3 * size), Sense::hover());
    paint_symbol(ui, pos2(rect.left(), rect.top() + 0.95 * size), symbol, size, Palette::here(ui).text);
    response
}

/// Width of a symbol.
#[must_use]
pub fn symbol_width(ui: &Ui, symbol: &str, size: f32) -> f32 {
    lay_out(ui, &parse_symbol(symbol), size, Color32::WHITE).width
}

/// Sizes of a typeset equation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sizes {
    /// True in a column of an equation: long parts do not become smaller.
    pub column: bool,
    /// True if terms are as small as definitions.
    pub even: bool,
    /// True if lines are equally high with and without scripts, so that those of two columns share their baselines.
    pub level: bool,
}

/// An equation, one line per definition, coloured by term. `name` gives the meaning of a symbol for its tooltip. The
/// symbol under the pointer is highlighted, with everything that represents it.
pub fn equation(ui: &mut Ui, parts: &[EquationPart], name: impl Fn(&str) -> Option<String>) -> Response {
    equation_of(ui, &definitions(parts), Sizes::default(), name)
}

/// An equation that is already split into parts, in other sizes.
pub fn equation_of(
    ui: &mut Ui,
    parts: &[(Term, &str)],
    sizes: Sizes,
    name: impl Fn(&str) -> Option<String>,
) -> Response {
    let width = ui.available_width();
    let (lines, height) = set(ui, parts, sizes, width);

    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let spoken: Vec<_> = parts.iter().map(|(_, text)| *text).collect();
    theme::says(&response, WidgetType::Label, spoken.join("; "));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    for (i, (line, baseline, colour)) in lines.iter().enumerate() {
        let at = pos2(rect.left(), rect.top() + baseline);
        for (k, (symbol, corner, size)) in line.symbols().enumerate() {
            let Some(meaning) = name(symbol) else { continue };
            let cell = Rect::from_min_size(at + corner, size);
            let here = ui.interact(cell, response.id.with((i, k)), Sense::hover());
            if here.hovered() {
                linked::point(ui.ctx(), &[symbol]);
            }
            tip(here, &meaning);
            if linked::is_lit(ui.ctx(), symbol) {
                ui.painter().add(linked::ground(cell, &Palette::here(ui)));
            }
        }
        line.paint(ui, at, *colour);
    }
    response
}

/// A calculation: numbers in place of symbols, each with its symbol; `name` gives the meaning of a symbol. A number
/// highlights everything that represents its symbol. Returns the symbol of a clicked number.
pub(super) fn calculation(
    ui: &mut Ui,
    text: &str,
    symbols: &[Option<String>],
    name: impl Fn(&str) -> Option<String>,
) -> Option<String> {
    let palette = Palette::here(ui);
    let width = ui.available_width();
    let (lines, height) =
        set(ui, &[(Term::Total, text)], Sizes { column: true, even: true, level: false }, width);
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    theme::says(&response, WidgetType::Label, text);
    let mut clicked = None;
    let mut symbols = symbols.iter();
    for (line, baseline, colour) in &lines {
        let at = pos2(rect.left(), rect.top() + baseline);
        for (corner, size) in line.numbers() {
            let Some(symbol) = symbols.next().and_then(Option::as_ref) else { continue };
            let cell = Rect::from_min_size(at + corner, size);
            let id = response.id.with(("number", corner.x as i32, corner.y as i32, symbol));
            let here = ui.interact(cell, id, Sense::click());
            theme::says(&here, WidgetType::Button, format!("where {symbol} comes from"));
            let ends: Vec<&str> = symbol.split('·').collect();
            if here.hovered() {
                linked::point(ui.ctx(), &ends);
                ui.painter().hline(cell.x_range(), cell.bottom(), Stroke::new(1.0, palette.accent));
            }
            if let [symbol] = ends[..]
                && linked::is_lit(ui.ctx(), symbol)
            {
                ui.painter().add(linked::ground(cell, &palette));
            }
            if here.clicked() {
                clicked = Some(symbol.clone());
            }
            let meaning = name(symbol).map_or_else(String::new, |meaning| format!(": {meaning}"));
            tip(here, &format!("{symbol}{meaning}\nClick to see where it comes from."));
        }
        line.paint(ui, at, *colour);
    }
    clicked
}

/// Paints one line of an equation in the colour of text; returns its width. `left_baseline` is the left end of the
/// baseline.
pub(super) fn paint_line(ui: &Ui, left_baseline: Pos2, text: &str, size: f32, colour: Color32) -> f32 {
    let setter = Setter { ui, size, colour, stacked: false, shrinks: false };
    let line = setter.row(&formula::tree(text));
    line.paint(ui, left_baseline, colour);
    line.width
}

/// Typeset lines, each with its baseline and colour, and their total height.
type Lines = (Vec<(Set, f32, Color32)>, f32);

/// Typesets parts of an equation in lines of at most this width.
fn set(ui: &Ui, parts: &[(Term, &str)], sizes: Sizes, width: f32) -> Lines {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let mut lines = Vec::new();
    let mut height = 0.0;
    for (term, text) in parts {
        let alone = parts.len() == 1 && !sizes.column;
        let size = if alone { SIZE } else { size_of(*term, text) };
        let helper = size < SIZE;
        let size = if sizes.even { HELPER } else { size };
        let leading = if helper || sizes.level { 6.0 } else { 8.0 };
        let colour = if helper { palette.text } else { palette.term_text(*term) };
        let setter = Setter { ui, size: size * scale, colour, stacked: true, shrinks: !sizes.column };
        let scripts = setter.row(&formula::tree("x_x^x"));
        for mut line in setter.lines(&formula::tree(text), width) {
            if sizes.level {
                line.ascent = line.ascent.max(scripts.ascent);
                line.descent = line.descent.max(scripts.descent);
            }
            let baseline = height + line.ascent + 0.5 * leading * scale;
            height = baseline + line.descent + 0.5 * leading * scale;
            lines.push((line, baseline, colour));
        }
    }
    (lines, height)
}

/// Size of the typeset parts of an equation, and their worst line break.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Width of the longest line.
    pub width: f32,
    /// Height of all lines.
    pub height: f32,
    /// Distance from the top to the baseline of the first line.
    pub baseline: f32,
    /// The worst line break.
    pub broken: Break,
}

/// Measures parts of an equation in lines of at most this width.
#[must_use]
pub fn measured(ui: &Ui, parts: &[(Term, &str)], sizes: Sizes, most: f32) -> Measured {
    let (lines, height) = set(ui, parts, sizes, most);
    let width = lines.iter().map(|(line, ..)| line.width).fold(0.0, f32::max);
    let broken = lines.iter().map(|(line, ..)| line.broken).max().unwrap_or_default();
    let baseline = lines.first().map_or(0.0, |(_, baseline, _)| *baseline);
    Measured { width, height, baseline, broken: if width > most { Break::Anywhere } else { broken } }
}

/// Font size of the terms of an equation.
pub(super) const SIZE: f32 = 17.0;
/// Font size of the definitions beside them.
const HELPER: f32 = 14.5;

/// Font size of a part of an equation: smaller if it defines what another part uses.
pub(super) fn size_of(term: Term, text: &str) -> f32 {
    let first = parse(text).first().and_then(Atom::symbol);
    let helper = term != Term::Total && first.is_none_or(|s| s != "I" && !s.starts_with("I_"));
    if helper { HELPER } else { SIZE }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui;

    use super::*;

    /// The notation of physically based models, and more.
    const HARD: &[&str] = &[
        "I_s = π D(H) G(L, V) F(V·H) / (4 (N·L)(N·V)) N·L",
        "D = α^2 / (π ((N·H)^2 (α^2 − 1) + 1)^2)",
        "f_r = ρ/π, E(μ_i) = ∫ f_r cos θ dω ≤ 1",
        "Λ = (√(1 + α² tan² θ) − 1)/2, F_{90} = 1/2 + 2 r (H·L)^2",
        "⟨N·H⟩ = max(0, N·H), α_{GGX} = √(2/(n + 2)), e^{−tan²θ/α²}, k_{spec}, φ_h ∈ [0, 2π), γ, Δ, ∞, ≈, ×, σ, μ, ω",
    ];

    #[test]
    fn every_sign_of_every_equation_is_in_the_fonts() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        let _ = ctx.run_ui(egui::RawInput::default(), |_| ());
        let registry = crate::registry::Registry::builtin();
        let mut texts: Vec<&str> = HARD.to_vec();
        for model in registry.models() {
            texts.extend(model.declaration.equation.iter().map(|p| p.text));
            texts.extend(model.parameters.iter().flat_map(|p| [p.symbol, p.label, p.unit, p.help]));
            texts.extend([model.declaration.name, model.declaration.author, model.declaration.source]);
        }
        for m in crate::reflection::preset::all() {
            texts.extend([m.name, m.source]);
        }
        ctx.fonts_mut(|fonts| {
            for family in [theme::maths(), theme::maths_italic(), egui::FontFamily::Proportional] {
                let font = FontId::new(17.0, family);
                // Position of the character in the font texture, which is the same for all missing characters.
                let mut place = |c: char| {
                    let galley = fonts.layout_no_wrap(c.to_string(), font.clone(), Color32::WHITE);
                    galley.rows[0].row.glyphs[0].uv_rect
                };
                let missing = place('\u{fffe}');
                assert!(place('\u{e123}') == missing && missing.size[0] > 0.0);
                for text in &texts {
                    for c in text.chars().filter(|c| !c.is_whitespace()) {
                        assert!(place(c) != missing, "{c} of “{text}” is missing in {font:?}");
                    }
                }
            }
        });
    }

    #[test]
    fn equations_stay_inside_the_panel() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        for width in [120.0, 270.0] {
            for text in HARD {
                let parts = [EquationPart::new(Term::Total, text)];
                let mut lines = 0.0;
                let mut shapes = Vec::new();
                for _ in 0..2 {
                    let output = ctx.run_ui(egui::RawInput::default(), |ui| {
                        ui.set_max_width(width);
                        let rect = equation(ui, &parts, |_| None).rect;
                        lines = rect.height();
                        assert!(rect.width() <= width);
                    });
                    shapes = output.shapes;
                }
                for clipped in &shapes {
                    if let Shape::Text(text) = &clipped.shape {
                        let right = text.pos.x + text.galley.size().x;
                        assert!(right < clipped.clip_rect.right() + 1.0, "{width}: {:?}", text.galley.text());
                    }
                }
                assert!(lines >= 26.0 && shapes.len() > 5);
            }
        }
    }
}
