//! Typeset atoms: base, index and power.

use crate::{
    panel::prelude::*,
    text::mathematics::{Atom, is_variable, parse},
};

/// A run of characters with its offset.
#[derive(Clone)]
pub(in crate::panel) struct Piece {
    pub(in crate::panel) galley: std::sync::Arc<Galley>,
    pub(in crate::panel) offset: Vec2,
}

/// A typeset atom.
#[derive(Clone)]
pub(in crate::panel) struct Laid {
    pub(in crate::panel) pieces: Vec<Piece>,
    pub(in crate::panel) width: f32,
}

/// Lays out an atom with its baseline at y = 0.
pub(in crate::panel) fn lay_out(ui: &Ui, atom: &Atom, size: f32, colour: Color32) -> Laid {
    let (base, sub, sup, family) = match atom {
        Atom::Symbol { base, sub, sup } => (base, sub, sup, variable(base)),
        Atom::Upright { base, sub, sup } => (base, sub, sup, theme::maths()),
        Atom::Space => return Laid { pieces: Vec::new(), width: 0.28 * size },
    };
    let baseline = |galley: &Galley| {
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
    let mut width = x;
    for (script, shift) in [(sub, 0.22 * size), (sup, -0.38 * size)] {
        let mut x = x + 0.04 * size;
        // An exponent may have an exponent.
        let nested = if script.contains(['^', '_']) { parse(script) } else { Vec::new() };
        for atom in &nested {
            let inner = lay_out(ui, atom, script_size, colour);
            let place = vec2(x, shift);
            pieces.extend(
                inner.pieces.into_iter().map(|piece| Piece { offset: place + piece.offset, ..piece }),
            );
            x += inner.width;
            width = width.max(x);
        }
        for run in runs(if nested.is_empty() { script } else { "" }) {
            // A single letter is a variable, as on the baseline; several are a word.
            let family = if is_variable(run) { variable(run) } else { theme::maths() };
            let galley = text(run, family, script_size);
            let y = shift - baseline(&galley);
            let advance = galley.size().x;
            width = width.max(x + advance);
            pieces.push(Piece { galley, offset: vec2(x, y) });
            x += advance;
        }
    }
    Laid { pieces, width: width + padding }
}

/// The font of a variable: slanted, except for capital Greek letters, which are upright by convention.
fn variable(letter: &str) -> egui::FontFamily {
    let capital = letter.starts_with(|c| ('Α'..='Ω').contains(&c));
    if capital { theme::maths() } else { theme::maths_italic() }
}

/// The runs of an index or an exponent: words, and the text between them.
fn runs(script: &str) -> impl Iterator<Item = &str> {
    let mut rest = script;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        // Adjacent Greek letters are separate variables.
        let end = if first.is_alphabetic() && !first.is_ascii() {
            first.len_utf8()
        } else {
            let same = |c: char| c.is_ascii_alphabetic() == first.is_ascii_alphabetic();
            rest.find(|c: char| !same(c) || c.is_alphabetic() && !c.is_ascii()).unwrap_or(rest.len())
        };
        let (run, after) = rest.split_at(end);
        rest = after;
        Some(run)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_may_have_a_power() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        for _ in 0..2 {
            let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
                let atoms = parse("e^{-x^2}");
                let laid = lay_out(ui, &atoms[0], 20.0, Color32::WHITE);
                let texts: Vec<_> = laid.pieces.iter().map(|p| p.galley.text().to_owned()).collect();
                assert_eq!(texts, ["e", "−", "x", "2"], "each in its place, and no mark among them");
                let heights: Vec<_> = laid.pieces.iter().map(|p| p.galley.size().y).collect();
                assert!(heights[0] > heights[2] && heights[2] > heights[3], "{heights:?}");
                let end = laid.pieces[3].offset.x + laid.pieces[3].galley.size().x;
                assert!((laid.width - end).abs() < 2.0, "{} {end}", laid.width);
                // Also without braces.
                let laid = lay_out(ui, &parse("x^y^z")[0], 40.0, Color32::WHITE);
                let texts: Vec<_> = laid.pieces.iter().map(|p| p.galley.text().to_owned()).collect();
                assert_eq!(texts, ["x", "y", "z"]);
                let heights: Vec<_> = laid.pieces.iter().map(|p| p.galley.size().y).collect();
                assert!(heights[0] > heights[1] && heights[1] > heights[2], "{heights:?}");
            });
        }
    }
}
