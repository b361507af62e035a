//! Sentences with symbols and code.

use bevy_egui::egui::text::{LayoutJob, TextFormat};

use crate::panel::prelude::*;

/// A sentence that sets `k_d` with a subscript, `10^−8` with a power, and text between backticks as code.
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

    /// Adds words, with spaces between them.
    fn words(&self, part: &str, job: &mut LayoutJob) {
        for (i, word) in part.split(' ').enumerate() {
            if i > 0 {
                job.append(" ", 0.0, self.plain.clone());
            }
            for (text, format) in self.pieces(word).into_iter().filter(|(text, _)| !text.is_empty()) {
                job.append(text, 0.0, format.clone());
            }
        }
    }

    /// The pieces of a word, some of which may be empty: around an index, or around a power.
    fn pieces<'a>(&'a self, word: &'a str) -> [(&'a str, &'a TextFormat); 4] {
        let bare = word.trim_start_matches('(');
        let symbol = bare.split_once('_').filter(|(letter, _)| letter.chars().count() == 1);
        if let Some((letter, rest)) = symbol {
            let end = rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len());
            let before = &word[..word.len() - bare.len()];
            let (index, after) = rest.split_at(end);
            return [
                (before, &self.plain),
                (letter, &self.letter),
                (index, &self.index),
                (after, &self.plain),
            ];
        }
        let (before, rest) = word.find("10^").map_or((word, ""), |at| (&word[..at + 2], &word[at + 3..]));
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '−').unwrap_or(rest.len());
        let (power, after) = rest.split_at(end);
        [(before, &self.plain), ("", &self.plain), (power, &self.power), (after, &self.plain)]
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui;

    use super::*;

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
}
