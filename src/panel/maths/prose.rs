//! Sentences with symbols and code.

use bevy_egui::egui::text::{LayoutJob, TextFormat};

use crate::panel::prelude::*;

/// A tooltip whose symbols have subscripts and powers, as those of equations.
pub(in crate::panel) fn tip(response: Response, text: &str) -> Response {
    response.on_hover_ui(|ui| {
        // As egui's own: a tooltip must not become narrower as its text changes.
        ui.set_max_width(ui.spacing().tooltip_width);
        ui.add(Label::new(prose(ui, text, TextStyle::Body)));
    })
}

/// A sentence that sets `k_d` or `F_{90}` with a subscript, `10^−8`, `r^2` or `e^{−x}` with a power, and text between
/// backticks as code.
#[must_use]
pub fn prose(ui: &Ui, text: &str, style: TextStyle) -> LayoutJob {
    let formats = Formats::new(ui, style);
    let mut job = LayoutJob::default();
    for (i, part) in text.split('`').enumerate() {
        if i % 2 == 1 {
            job.append(part, 0.0, formats.code.clone());
        } else {
            formats.words(part, &mut job);
        }
    }
    job
}

/// Space between a slanted index and what touches it, relative to the font size: egui slants letters beyond their width.
const LEAN: f32 = 0.12;

/// The formats of a sentence.
struct Formats {
    plain: TextFormat,
    code: TextFormat,
    /// A letter with an index, and that index.
    letter: TextFormat,
    index: TextFormat,
    power: TextFormat,
}

impl Formats {
    fn new(ui: &Ui, style: TextStyle) -> Self {
        let font = style.resolve(ui.style());
        let plain = TextFormat::simple(font.clone(), Palette::here(ui).text);
        let code = TextFormat { font_id: FontId::monospace(font.size), ..plain.clone() };
        let letter = TextFormat { italics: true, ..plain.clone() };
        let index = TextFormat {
            font_id: FontId { size: 0.75 * font.size, ..font },
            valign: Align::BOTTOM,
            ..letter.clone()
        };
        let power = TextFormat { valign: Align::TOP, font_id: index.font_id.clone(), ..plain.clone() };
        Self { plain, code, letter, index, power }
    }

    /// Adds words with their symbols.
    fn words(&self, mut text: &str, job: &mut LayoutJob) {
        let start = |marked: &Option<[&str; 4]>| marked.map_or(usize::MAX, |[before, ..]| before.len());
        loop {
            let (index, power) = (indexed(text), raised(text));
            let format = if start(&power) < start(&index) { &self.power } else { &self.index };
            let Some([before, letter, script, after]) =
                index.into_iter().chain(power).min_by_key(|m| m[0].len())
            else {
                break;
            };
            self.plainly(before, job);
            if !letter.is_empty() {
                job.append(letter, 0.0, self.letter.clone());
            }
            // A script within a script stands beside it.
            job.append(&script.replace(['_', '^', '{', '}'], ""), 0.0, format.clone());
            text = after;
        }
        self.plainly(text, job);
    }

    fn plainly(&self, text: &str, job: &mut LayoutJob) {
        // A slanted index leans over what follows it.
        let leans = job.sections.last().is_some_and(|last| last.format.italics);
        let touches = leans && text.starts_with(|c: char| !c.is_whitespace());
        let space = if touches { LEAN * self.plain.font_id.size } else { 0.0 };
        if !text.is_empty() {
            job.append(text, space, self.plain.clone());
        }
    }
}

/// The first letter with an index, that index, and what is around them. Names of several letters, such as `base_colour`, are
/// none.
fn indexed(text: &str) -> Option<[&str; 4]> {
    let at = text.match_indices('_').map(|(at, _)| at).find(|at| {
        let mut back = text[..*at].chars().rev();
        back.next().is_some_and(|c| c.is_alphabetic() || c == '∑')
            && !back.next().is_some_and(|c| c.is_alphanumeric() || c == '_')
    })?;
    let start = text[..at].char_indices().next_back()?.0;
    let rest = &text[at + 1..];
    let braced = rest.strip_prefix('{').and_then(|rest| rest.split_once('}'));
    let (index, after) = braced
        .unwrap_or_else(|| rest.split_at(rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len())));
    Some([&text[..start], &text[start..at], index, after])
}

/// The first power: what is before it, its base if that is a single letter, the exponent, and the rest. Other bases, such as
/// 10 or a bracket, belong to what is before.
fn raised(text: &str) -> Option<[&str; 4]> {
    text.match_indices('^').find_map(|(at, _)| {
        let mut back = text[..at].char_indices().rev();
        let base = back.next();
        // At the start, it is the power of a letter with an index.
        if base.is_some_and(|(_, c)| !c.is_alphanumeric() && c != ')') {
            return None;
        }
        let is_word = back.next().is_some_and(|(_, c)| c.is_alphanumeric());
        let start = base.filter(|(_, c)| c.is_alphabetic() && !is_word).map_or(at, |(start, _)| start);
        let rest = &text[at + 1..];
        let (exponent, after) = match rest.strip_prefix('{') {
            Some(braced) => braced.split_once('}')?,
            None => rest.split_at(exponent(rest)?),
        };
        Some([&text[..start], &text[start..at], exponent, after])
    })
}

/// The length of an exponent without braces: a number, or one letter.
fn exponent(text: &str) -> Option<usize> {
    let sign = text.strip_prefix(['−', '-']).map_or(0, |rest| text.len() - rest.len());
    let digits = text[sign..].find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len() - sign);
    let letter = text.chars().next().filter(|c| c.is_alphabetic()).map(char::len_utf8);
    if digits > 0 { Some(sign + digits) } else { letter }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui;

    use super::*;

    #[test]
    fn tooltips_have_no_raw_underscores() {
        let ctx = Context::default();
        let mut text = String::new();
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            let raw = "w_k: part from d_k,\nand F_{90} of α_{cx}, −ln(C_t)/d, base_colour";
            text = prose(ui, raw, TextStyle::Body).text;
        });
        assert_eq!(text, "wk: part from dk,\nand F90 of αcx, −ln(Ct)/d, base_colour");
    }

    #[test]
    fn indices_stand_below_and_code_has_its_letters() {
        let ctx = Context::default();
        let mut seen = Vec::new();
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            let job = prose(
                ui,
                "half-Lambert (k_d 0.5, squared), as `lcm models` has it; a_b_c of 2·10^−8.",
                TextStyle::Body,
            );
            let of = |s: &egui::text::LayoutSection| {
                (job.text[s.byte_range.start.0..s.byte_range.end.0].to_owned(), s.format.clone())
            };
            seen = job.sections.iter().map(of).collect();
        });
        let text: String = seen.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(text, "half-Lambert (kd 0.5, squared), as lcm models has it; ab_c of 2·10−8.");
        let find = |word: &str| seen.iter().find(|(text, _)| text.contains(word)).map(|(_, format)| format);
        let size = find("squared),").expect("there").font_id.size;
        assert!(seen[1].0 == "k" && seen[1].1.italics && seen[2].0 == "d" && seen[2].1.font_id.size < size);
        let power = find("−8").expect("there");
        assert!(power.valign == Align::TOP && !power.italics && power.font_id.size < size);
        assert_eq!(find("lcm models").expect("there").font_id.family, egui::FontFamily::Monospace);
    }

    #[test]
    fn a_stop_keeps_clear_of_the_index_before_it() {
        let ctx = Context::default();
        let mut seen = Vec::new();
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            let job = prose(ui, "read θ_t. Below θ_c: so (k_d) is", TextStyle::Body);
            let of = |s: &egui::text::LayoutSection| {
                (job.text[s.byte_range.start.0..s.byte_range.end.0].to_owned(), s.leading_space > 0.0)
            };
            seen = job.sections.iter().map(of).collect();
        });
        let apart: Vec<_> = seen.iter().filter(|(_, space)| *space).map(|(text, _)| text.as_str()).collect();
        assert_eq!(apart, [". Below ", ": so (", ") is"]);
    }

    #[test]
    fn powers_stand_above_without_carets() {
        let ctx = Context::default();
        let mut seen = Vec::new();
        let raw = "α = r^2, α_x^2 cos^2 θ_h of (N·H)^n; e^{−σ s_k}, 2·10^−8 and ½^½, but C^ or a ^2 are none";
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            let job = prose(ui, raw, TextStyle::Body);
            seen = job
                .sections
                .iter()
                .map(|s| (job.text[s.byte_range.start.0..s.byte_range.end.0].to_owned(), s.format.valign))
                .collect();
        });
        let text: String = seen.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(text, "α = r2, αx2 cos2 θh of (N·H)n; e−σ sk, 2·10−8 and ½^½, but C^ or a ^2 are none");
        let powers: Vec<_> =
            seen.iter().filter(|(_, align)| *align == Align::TOP).map(|(text, _)| text.as_str()).collect();
        assert_eq!(powers, ["2", "2", "2", "n", "−σ sk", "−8"]);
    }
}
