//! Sentences with symbols and code.

use bevy_egui::egui::text::{LayoutJob, TextFormat};

use crate::panel::prelude::*;

/// A sentence that sets `k_d` with a subscript, and text between backticks as code.
#[must_use]
pub fn prose(ui: &Ui, text: &str, style: TextStyle) -> LayoutJob {
    let font = style.resolve(ui.style());
    let plain = TextFormat::simple(font.clone(), Palette::here(ui).text);
    let code = TextFormat { font_id: FontId::monospace(font.size), ..plain.clone() };
    let base = TextFormat { italics: true, ..plain.clone() };
    let index = TextFormat {
        font_id: FontId { size: 0.75 * font.size, ..font },
        valign: Align::BOTTOM,
        ..base.clone()
    };
    let mut job = LayoutJob::default();
    for (i, part) in text.split('`').enumerate() {
        if i % 2 == 1 {
            job.append(part, 0.0, code.clone());
            continue;
        }
        for (i, word) in part.split(' ').enumerate() {
            if i > 0 {
                job.append(" ", 0.0, plain.clone());
            }
            let bare = word.trim_start_matches('(');
            match bare.split_once('_').filter(|(letter, _)| letter.chars().count() == 1) {
                Some((letter, rest)) => {
                    let end = rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len());
                    job.append(&word[..word.len() - bare.len()], 0.0, plain.clone());
                    job.append(letter, 0.0, base.clone());
                    job.append(&rest[..end], 0.0, index.clone());
                    job.append(&rest[end..], 0.0, plain.clone());
                }
                None => job.append(word, 0.0, plain.clone()),
            }
        }
    }
    job
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
            let job =
                prose(ui, "half-Lambert (k_d 0.5, squared), as `lcm models` has it; a_b_c", TextStyle::Body);
            let of = |s: &egui::text::LayoutSection| {
                (job.text[s.byte_range.start.0..s.byte_range.end.0].to_owned(), s.format.clone())
            };
            seen = job.sections.iter().map(of).collect();
        });
        let text: String = seen.iter().map(|(text, _)| text.as_str()).collect();
        assert_eq!(text, "half-Lambert (kd 0.5, squared), as lcm models has it; ab_c");
        let find = |word: &str| seen.iter().find(|(text, _)| text.contains(word)).map(|(_, format)| format);
        let size = find("squared),").expect("there").font_id.size;
        assert!(seen[1].0 == "k" && seen[1].1.italics && seen[2].0 == "d" && seen[2].1.font_id.size < size);
        assert_eq!(find("lcm models").expect("there").font_id.family, egui::FontFamily::Monospace);
    }
}
