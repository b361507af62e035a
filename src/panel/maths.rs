//! Equations in readable mathematics: variables slanted, words upright, subscripts and superscripts
//! in their places. [`typeset`](super::typeset) sets fractions and breaks lines.
//!
//! The source is that of [`EquationPart`]: `_x` is a subscript, `^x` a superscript, braces group.

use bevy_egui::egui::{
    self, Color32, FontId, Id, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, WidgetInfo, WidgetType, pos2,
    vec2,
};

use super::{
    formula,
    theme::{self, Palette},
    typeset::{Set, Setter},
};
use crate::reflection::{EquationPart, Term};

/// A piece of an equation that is not broken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Atom {
    /// A variable, perhaps with an index and a power: `k_d`, `d^2`.
    Symbol {
        /// The letter.
        base: String,
        /// Below the line.
        sub: String,
        /// Above the line.
        sup: String,
    },
    /// A function's name, a number, an operator or a bracket, perhaps with an index and a power.
    Upright {
        /// The characters.
        base: String,
        /// Below the line.
        sub: String,
        /// Above the line.
        sup: String,
    },
    /// A space: where a line may be broken.
    Space,
}

impl Atom {
    /// The symbol as declarations write it (`k_d`), if the atom is one.
    #[must_use]
    pub fn symbol(&self) -> Option<String> {
        match self {
            Self::Symbol { base, sub, .. } if sub.is_empty() => Some(base.clone()),
            Self::Symbol { base, sub, .. } => Some(format!("{base}_{sub}")),
            _ => None,
        }
    }

    /// The letter, the word or the sign; empty for a space.
    #[must_use]
    pub fn base(&self) -> &str {
        match self {
            Self::Symbol { base, .. } | Self::Upright { base, .. } => base,
            Self::Space => "",
        }
    }

    /// The index; often empty.
    #[must_use]
    pub fn sub(&self) -> &str {
        match self {
            Self::Symbol { sub, .. } | Self::Upright { sub, .. } => sub,
            Self::Space => "",
        }
    }

    /// The power; often empty.
    #[must_use]
    pub fn sup(&self) -> &str {
        match self {
            Self::Symbol { sup, .. } | Self::Upright { sup, .. } => sup,
            Self::Space => "",
        }
    }

    /// The symbol that is the power of the atom, if the power is one: the `α` of `(N·H)^α`.
    #[must_use]
    pub fn power(&self) -> Option<String> {
        match self {
            Self::Symbol { sup, .. } | Self::Upright { sup, .. } if sup.chars().all(char::is_alphabetic) => {
                Some(sup.clone()).filter(|s| s.chars().count() == 1)
            }
            _ => None,
        }
    }
}

/// Splits an equation into atoms.
#[must_use]
pub fn parse(text: &str) -> Vec<Atom> {
    let chars: Vec<char> = text.chars().collect();
    let mut atoms = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let c = chars[i];
        if c.is_whitespace() {
            if atoms.last() != Some(&Atom::Space) {
                atoms.push(Atom::Space);
            }
            i += 1;
            continue;
        }
        let start = i;
        let ascii_word = |c: &char| c.is_ascii_alphabetic();
        if c.is_ascii_alphabetic() {
            i += chars[i..].iter().take_while(|c| ascii_word(c)).count();
        } else if c.is_ascii_digit() {
            i += chars[i..].iter().take_while(|c| c.is_ascii_digit() || **c == '.').count();
        } else {
            i += 1;
        }
        let base: String = chars[start..i].iter().collect();
        let (mut sub, mut sup) = (String::new(), String::new());
        while let Some(mark @ ('_' | '^')) = chars.get(i).copied() {
            let (script, next) = script(&chars, i + 1);
            i = next;
            if mark == '_' { sub = script } else { sup = script }
        }
        // One letter is a variable; several are a word, such as `max`.
        let variable = c.is_alphabetic() && base.chars().count() == 1;
        atoms.push(if variable { Atom::Symbol { base, sub, sup } } else { Atom::Upright { base, sub, sup } });
    }
    atoms
}

/// What is raised or lowered: a group in braces, a number, or one character.
fn script(chars: &[char], start: usize) -> (String, usize) {
    match chars.get(start) {
        Some('{') => {
            let end = chars[start..].iter().position(|c| *c == '}').map_or(chars.len(), |n| start + n);
            (chars[start + 1..end].iter().collect(), (end + 1).min(chars.len()))
        }
        Some(c) if c.is_ascii_digit() => {
            let n = chars[start..].iter().take_while(|c| c.is_ascii_digit()).count();
            (chars[start..start + n].iter().collect(), start + n)
        }
        Some(c) => (c.to_string(), start + 1),
        None => (String::new(), start),
    }
}

/// The symbol of a parameter, which is all one symbol: what follows `_` is its index, however long.
#[must_use]
pub fn parse_symbol(symbol: &str) -> Atom {
    let (base, sub) = symbol.split_once('_').unwrap_or((symbol, ""));
    let sub = sub.trim_matches(['{', '}']).to_owned();
    Atom::Symbol { base: base.to_owned(), sub, sup: String::new() }
}

/// The same symbol, however it is written.
#[must_use]
pub fn same_symbol(a: &str, b: &str) -> bool {
    let plain = |s: &str| s.replace(['{', '}'], "");
    plain(a) == plain(b)
}

/// What the symbols mean that every equation uses.
#[must_use]
pub fn meaning(symbol: &str) -> Option<&'static str> {
    const MEANINGS: &[(&str, &str)] = &[
        ("I", "the light that leaves the surface towards the observer, per unit of light intensity"),
        ("I_a", "the ambient term: light without direction"),
        ("I_d", "the diffuse term: light scattered in all directions"),
        ("I_s", "the specular term: light gathered into a highlight"),
        ("N", "the unit normal: the direction in which the surface faces"),
        ("L", "the unit vector from the surface to the light"),
        ("V", "the unit vector from the surface to the observer"),
        ("H", "the half vector: the unit vector halfway between L and V"),
        ("R", "the mirror direction of L: 2(N·L)N − L"),
        ("T", "the unit tangent: the direction along which the surface is brushed"),
        ("B", "the unit bitangent: across the surface at right angles to the tangent"),
        ("D", "the distribution of the normals of the microfacets: how many face along H"),
        ("G", "masking and shadowing: the fraction of the microfacets that both light and observer see"),
        ("G_1", "masking: the fraction of the microfacets that is seen from one direction"),
        ("G_2", "masking and shadowing: the fraction of the microfacets that both light and observer see"),
        ("Λ", "Smith's function: hidden area of microfacets per visible area"),
        ("F", "the Fresnel reflectance: how much a smooth surface mirrors at this angle"),
        ("F_0", "the Fresnel reflectance when looking straight at the surface"),
        ("F_90", "the Fresnel reflectance at grazing incidence"),
        ("F_L", "Schlick's weight for the light: (1 − N·L)⁵, 0 straight on and 1 at grazing incidence"),
        ("F_V", "Schlick's weight for the observer: (1 − N·V)⁵"),
        ("F_H", "Schlick's weight at the half vector: (1 − L·H)⁵"),
        ("C_0", "the colour of the reflection when looking straight at the surface"),
        ("C_h", "the colour of the sheen: white, or the hue of the base colour"),
        ("D_r", "the distribution of the clear coat"),
        ("F_r", "the Fresnel reflectance of the clear coat"),
        ("G_r", "masking of the clear coat"),
        ("G_s", "masking of the base"),
        ("S", "shadowing of steep slopes by others"),
        ("f_s", "a flat diffuse term that stands for light that travels below the surface"),
        ("f_r", "the BRDF: reflected light per incoming light, in 1/sr"),
        ("E", "the directional albedo: how much of the light from one direction is reflected in all"),
        ("E_L", "the directional albedo for the direction of the light"),
        ("E_V", "the directional albedo for the direction of the observer"),
        ("E_m", "the mean directional albedo over all directions"),
        ("ρ", "the albedo: how much of the light is reflected, by colour"),
        ("α", "the width of the distribution of the microfacets: small for a mirror, 1 for a matt surface"),
        ("σ", "the spread of the slopes of the facets"),
        ("γ", "the exponent of the tail of the distribution"),
        ("μ", "the cosine of the angle between the normal and the direction"),
        ("μ_l", "the cosine of the angle between the normal and the light, N·L"),
        ("μ_v", "the cosine of the angle between the normal and the observer, N·V"),
        ("μ_i", "the cosine of the angle between the normal and the light, N·L"),
        ("μ_0", "the cosine of the angle between the normal and the light, N·L"),
        ("μ_o", "the cosine of the angle between the normal and the observer, N·V"),
        ("n", "the refractive index"),
        ("k", "the extinction coefficient: how fast light dies away inside"),
        ("g", "the phase angle between light and observer"),
        ("ω", "a direction"),
        ("d", "the distance from the light to the point"),
        ("p", "the point that is lit"),
        ("e", "2.71828…, the base of natural logarithms"),
        ("π", "3.14159…"),
        ("θ", "the angle between the axis and the ray"),
        ("θ_i", "the angle between the normal and the light"),
        ("θ_r", "the angle between the normal and the observer"),
        ("θ_o", "the angle between the normal and the observer"),
        ("θ_h", "the angle between the normal and the half vector"),
        ("θ_d", "the angle between the half vector and the light"),
        ("α_x", "the width of the distribution along the tangent"),
        ("α_y", "the width of the distribution across the tangent"),
        ("θ_X", "the angle to the normal of L or V, or between L and H"),
        ("β", "the smaller of the angles of light and observer to the normal"),
        ("φ", "the angle about the normal, between light and observer"),
        ("φ_h", "the angle of the half vector about the normal, from the tangent"),
    ];
    MEANINGS.iter().find(|(s, _)| same_symbol(s, symbol)).map(|(_, m)| *m)
}

/// Where an equation says itself what a symbol is: the part that begins with it and an equals sign, or
/// has it after a comma.
#[must_use]
pub fn definition(parts: &[EquationPart], symbol: &str) -> Option<&'static str> {
    let defines = |part: &&EquationPart| {
        let atoms: Vec<_> = parse(part.text).into_iter().filter(|a| *a != Atom::Space).collect();
        let here = |i: usize| atoms[i].symbol().is_some_and(|s| same_symbol(&s, symbol));
        let sign = |a: &Atom, text: &str| matches!(a, Atom::Upright { base, .. } if base == text);
        (0..atoms.len()).any(|i| {
            here(i) && atoms.get(i + 1).is_some_and(|a| sign(a, "=")) && (i == 0 || sign(&atoms[i - 1], ","))
        })
    };
    parts.iter().find(defines).map(|p| p.text)
}

/// A run of characters, and where it stands.
#[derive(Clone)]
pub(super) struct Piece {
    pub(super) galley: std::sync::Arc<egui::Galley>,
    pub(super) offset: Vec2,
}

/// An atom as it is set.
#[derive(Clone)]
pub(super) struct Laid {
    pub(super) pieces: Vec<Piece>,
    pub(super) width: f32,
}

/// Lays an atom out with its baseline at y = 0.
pub(super) fn lay_out(ui: &Ui, atom: &Atom, size: f32, colour: Color32) -> Laid {
    let (base, sub, sup, family) = match atom {
        // Capital Greek letters are upright by custom; N·L and the like are slanted.
        Atom::Symbol { base, sub, sup } if base.starts_with(|c| ('Α'..='Ω').contains(&c)) => {
            (base, sub, sup, theme::maths())
        }
        Atom::Symbol { base, sub, sup } => (base, sub, sup, theme::maths_italic()),
        Atom::Upright { base, sub, sup } => (base, sub, sup, theme::maths()),
        Atom::Space => return Laid { pieces: Vec::new(), width: 0.28 * size },
    };
    let baseline = |galley: &egui::Galley| {
        galley.rows.first().map_or(0.0, |row| row.row.glyphs.first().map_or(0.0, |g| g.pos.y))
    };
    let text = |text: &str, family: egui::FontFamily, size: f32| {
        ui.painter().layout_no_wrap(text.to_owned(), FontId::new(size, family), colour)
    };
    let padding = match base.as_str() {
        "·" | "/" => 0.08 * size,
        _ => 0.0,
    };
    let galley = text(base, family, size);
    let mut pieces = Vec::new();
    let mut x = padding;
    let y = -baseline(&galley);
    let advance = galley.size().x;
    pieces.push(Piece { galley, offset: vec2(x, y) });
    x += advance;
    let script_size = (0.7 * size).max(9.0);
    let script_family = |s: &str| {
        if s.chars().count() == 1 && s.chars().all(char::is_alphabetic) {
            theme::maths_italic()
        } else {
            theme::maths()
        }
    };
    let mut width = x;
    for (script, shift) in [(sub, 0.22 * size), (sup, -0.38 * size)] {
        if !script.is_empty() {
            let galley = text(script, script_family(script), script_size);
            let y = shift - baseline(&galley);
            width = width.max(x + 0.04 * size + galley.size().x);
            pieces.push(Piece { galley, offset: vec2(x + 0.04 * size, y) });
        }
    }
    Laid { pieces, width: width + padding }
}

/// One symbol in the colour of text, at a place; returns its width. `baseline` is where it stands.
pub fn paint_symbol(ui: &Ui, left_baseline: Pos2, symbol: &str, size: f32, colour: Color32) -> f32 {
    let laid = lay_out(ui, &parse_symbol(symbol), size, colour);
    for piece in laid.pieces {
        ui.painter().galley(left_baseline + piece.offset, piece.galley, colour);
    }
    laid.width
}

/// One symbol among other widgets.
pub fn symbol(ui: &mut Ui, symbol: &str, size: f32) -> Response {
    let width = symbol_width(ui, symbol, size);
    let (rect, response) = ui.allocate_exact_size(vec2(width, 1.3 * size), Sense::hover());
    let at = pos2(rect.left(), rect.top() + 0.95 * size);
    paint_symbol(ui, at, symbol, size, Palette::here(ui).text);
    response
}

/// The width of a symbol.
#[must_use]
pub fn symbol_width(ui: &Ui, symbol: &str, size: f32) -> f32 {
    lay_out(ui, &parse_symbol(symbol), size, Color32::WHITE).width
}

/// Says that the pointer is on something that has this symbol, until the next pass is over.
pub fn highlight(ctx: &egui::Context, symbol: &str) {
    let now = ctx.cumulative_pass_nr();
    ctx.data_mut(|d| d.insert_temp(Id::new("highlighted symbol"), (now, symbol.to_owned())));
}

/// The symbol that [`highlight`] named last, if that is not long ago.
#[must_use]
pub fn highlighted(ctx: &egui::Context) -> Option<String> {
    let now = ctx.cumulative_pass_nr();
    let stored: Option<(u64, String)> = ctx.data(|d| d.get_temp(Id::new("highlighted symbol")));
    stored.filter(|(pass, _)| now.saturating_sub(*pass) <= 1).map(|(_, symbol)| symbol)
}

/// An equation, a line for each part, coloured by term. `name` says what a symbol means; it is the
/// tooltip. Hovering a symbol highlights it; so does [`highlight`].
pub fn equation(ui: &mut Ui, parts: &[EquationPart], name: impl Fn(&str) -> Option<String>) -> Response {
    let parts: Vec<_> = parts.iter().map(|p| (p.term, p.text)).collect();
    equation_of(ui, &parts, name)
}

/// The same for text that is made while the program runs.
pub fn equation_of(ui: &mut Ui, parts: &[(Term, &str)], name: impl Fn(&str) -> Option<String>) -> Response {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let width = ui.available_width();
    let marked = highlighted(ui.ctx());
    let mut lines: Vec<(Set, f32, Color32)> = Vec::new();
    let mut height = 0.0;
    for (term, text) in parts {
        let size = if parts.len() > 1 { size_of(*term, text) } else { SIZE };
        let helper = size < SIZE;
        let leading = if helper { 6.0 } else { 8.0 };
        let colour = if helper { palette.text } else { palette.term_text(*term) };
        // A presentation must be read from the last row.
        let setter = Setter { ui, size: size * scale, colour, stacked: true, shrinks: scale <= 1.0 };
        for line in setter.lines(&formula::tree(text), width) {
            let baseline = height + line.ascent + 0.5 * leading * scale;
            height = baseline + line.descent + 0.5 * leading * scale;
            lines.push((line, baseline, colour));
        }
    }

    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let spoken: Vec<_> = parts.iter().map(|(_, text)| *text).collect();
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, spoken.join("; ")));
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
                highlight(ui.ctx(), symbol);
            }
            here.on_hover_text(meaning);
            if marked.as_ref().is_some_and(|m| same_symbol(m, symbol)) {
                ui.painter().rect_filled(cell, 3.0, palette.chosen);
                ui.painter().hline(cell.x_range(), cell.bottom() - 1.0, Stroke::new(1.5, palette.accent));
            }
        }
        line.paint(ui, at, *colour);
    }
    response
}

/// The size of letters in the terms of an equation.
pub(super) const SIZE: f32 = 17.0;

/// The size of letters in a part of an equation: smaller where it defines what another part uses.
pub(super) fn size_of(term: Term, text: &str) -> f32 {
    let first = parse(text).first().and_then(Atom::symbol);
    let helper = term != Term::Total && first.is_none_or(|s| s != "I" && !s.starts_with("I_"));
    if helper { 14.5 } else { SIZE }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbol(base: &str, sub: &str, sup: &str) -> Atom {
        Atom::Symbol { base: base.to_owned(), sub: sub.to_owned(), sup: sup.to_owned() }
    }

    #[test]
    fn subscripts_superscripts_and_words_are_told_apart() {
        let atoms = parse("I_d = max(0, N·L)^{p+1} d^2");
        assert_eq!(atoms[0], symbol("I", "d", ""));
        assert_eq!(atoms[0].symbol().as_deref(), Some("I_d"));
        assert!(atoms.contains(&Atom::Upright {
            base: "max".to_owned(),
            sub: String::new(),
            sup: String::new()
        }));
        assert!(atoms.contains(&Atom::Upright {
            base: ")".to_owned(),
            sub: String::new(),
            sup: "p+1".to_owned()
        }));
        assert_eq!(atoms.last(), Some(&symbol("d", "", "2")));
    }

    #[test]
    fn the_index_of_a_symbol_alone_may_be_long() {
        assert_eq!(parse_symbol("α_GGX"), symbol("α", "GGX", ""));
        assert!(same_symbol("F_{90}", "F_90"));
    }

    /// What the equations of physically based models need, and more.
    const HARD: &[&str] = &[
        "I_s = π D(H) G(L, V) F(V·H) / (4 (N·L)(N·V)) N·L",
        "D = α^2 / (π ((N·H)^2 (α^2 − 1) + 1)^2)",
        "f_r = ρ/π, E(μ_i) = ∫ f_r cos θ dω ≤ 1",
        "Λ = (√(1 + α² tan² θ) − 1)/2, F_{90} = 1/2 + 2 r (H·L)^2",
        "⟨N·H⟩ = max(0, N·H), α_{GGX} = √(2/(n + 2)), e^{−tan²θ/α²}, k_{spec}, φ_h ∈ [0, 2π), γ, Δ, ∞, ≈, ×, σ, μ, ω",
    ];

    #[test]
    fn every_sign_of_every_equation_is_in_the_fonts() {
        let ctx = egui::Context::default();
        theme::install_fonts(&ctx);
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
                // Where a character is drawn on the texture: the same place for all that are missing.
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
        let ctx = egui::Context::default();
        theme::install_fonts(&ctx);
        for width in [120.0, 270.0] {
            for text in HARD {
                let parts = [EquationPart { term: Term::Total, text }];
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
                    if let egui::Shape::Text(text) = &clipped.shape {
                        let right = text.pos.x + text.galley.size().x;
                        assert!(right < clipped.clip_rect.right() + 1.0, "{width}: {:?}", text.galley.text());
                    }
                }
                assert!(lines >= 26.0 && shapes.len() > 5);
            }
        }
    }

    #[test]
    fn every_symbol_of_every_equation_is_explained() {
        let registry = crate::registry::Registry::builtin();
        let mut unexplained = Vec::new();
        for model in registry.models() {
            let d = model.declaration;
            for symbol in d.equation.iter().flat_map(|p| parse(p.text)).filter_map(|a| a.symbol()) {
                let known = model.parameters.iter().any(|p| same_symbol(p.symbol, &symbol))
                    || meaning(&symbol).is_some()
                    || definition(d.equation, &symbol).is_some();
                if !known {
                    unexplained.push(format!("{}: {symbol}", d.id));
                }
            }
        }
        assert_eq!(unexplained, [""; 0], "neither a parameter nor explained in `meaning`");
        let parts = [EquationPart { term: Term::Diffuse, text: "x = H·T / H·N , y_{ab} = x + z" }];
        assert!(definition(&parts, "x").is_some() && definition(&parts, "y_ab").is_some());
        assert!(definition(&parts, "z").is_none() && definition(&parts, "H").is_none());
    }

    #[test]
    fn unfinished_mathematics_is_no_reason_to_stop() {
        for text in ["", "_", "a_", "a^{", "{}", "x__y", "∑_{i=1}^n"] {
            let _ = parse(text);
        }
    }
}
