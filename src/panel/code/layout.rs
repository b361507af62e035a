//! The text with its colours, laid out line by line. Lines are laid out again only if they have changed, so that
//! typing into a long text costs no more than into a short one.

use std::{
    collections::HashMap,
    hash::{DefaultHasher, Hash as _, Hasher as _},
    ops::Range,
};

use bevy_egui::egui::text::{LayoutJob, TextFormat, TextWrapping};

use super::tokens::{Language, Sort, tokens};
use crate::{panel::prelude::*, reflection::Term};

/// The colour of a sort of words.
pub(super) fn colour(sort: Sort, palette: &Palette) -> Color32 {
    match sort {
        Sort::Plain => palette.text,
        Sort::Comment => palette.weak,
        Sort::Keyword | Sort::Key => palette.accent,
        Sort::Type => palette.term_text(Term::Ambient),
        Sort::Function => palette.term_text(Term::Transmitted),
        Sort::Number => palette.term_text(Term::Diffuse),
        Sort::Text => palette.term_text(Term::Specular),
    }
}

/// What the layout of a line depends on, besides the line.
#[derive(Clone, Debug, PartialEq)]
struct Style {
    font: FontId,
    dark: bool,
    pixels_per_point: f32,
    language: Language,
}

/// The lines laid out so far.
#[derive(Default)]
pub(super) struct Layouts {
    style: Option<Style>,
    /// How full the texture of the letters was, and in which pass: layouts refer to it, and it is made anew when it overflows
    /// or the theme changes, which is not seen while the text is not shown.
    filled: f32,
    pass: u64,
    lines: HashMap<u64, Arc<Galley>>,
    last: Option<(String, Arc<Galley>)>,
    /// Number of lines laid out, for tests.
    pub(super) laid: usize,
}

impl Layouts {
    /// The layout of a text, without line breaks of its own.
    pub(super) fn lay(&mut self, ui: &Ui, text: &str, language: Language) -> Arc<Galley> {
        let palette = Palette::here(ui);
        let style = Style {
            font: TextStyle::Monospace.resolve(ui.style()),
            dark: palette.dark,
            pixels_per_point: ui.ctx().pixels_per_point(),
            language,
        };
        let filled = ui.fonts_mut(|fonts| fonts.font_atlas_fill_ratio());
        let pass = ui.ctx().cumulative_pass_nr();
        if self.style.as_ref() != Some(&style) || filled < self.filled || pass > self.pass + 1 {
            self.lines.clear();
            self.last = None;
        }
        (self.filled, self.pass) = (filled, pass);
        if let Some((_, galley)) = self.last.as_ref().filter(|(known, _)| known == text) {
            return galley.clone();
        }
        let font = style.font.clone();
        let height = ui.fonts_mut(|fonts| fonts.row_height(&font)) + BELOW;
        self.style = Some(style);
        let words = tokens(text, language);
        let mut known = std::mem::take(&mut self.lines);
        let (mut galleys, mut first) = (Vec::new(), 0);
        for line in lines(text) {
            while words.get(first).is_some_and(|(range, _)| range.end <= line.start) {
                first += 1;
            }
            let within = words[first..].iter().take_while(|(range, _)| range.start < line.end);
            let within: Vec<_> = within
                .map(|(range, sort)| {
                    let (start, end) = (range.start.max(line.start), range.end.min(line.end));
                    (start - line.start..end - line.start, *sort)
                })
                .collect();
            let content = &text[line];
            let mut hasher = DefaultHasher::new();
            (content, &within).hash(&mut hasher);
            let key = hasher.finish();
            let galley = self.lines.get(&key).cloned().or_else(|| known.remove(&key)).unwrap_or_else(|| {
                self.laid += 1;
                let job = job(content, &within, (&font, height), &palette);
                ui.fonts_mut(|fonts| fonts.layout_job(job))
            });
            self.lines.insert(key, galley.clone());
            galleys.push(galley);
        }
        let whole = LayoutJob::simple(text.to_owned(), font, palette.text, f32::INFINITY);
        let galley = match &galleys[..] {
            [one] => one.clone(),
            all => Arc::new(Galley::concat(Arc::new(whole), all, ui.ctx().pixels_per_point())),
        };
        self.last = Some((text.to_owned(), galley.clone()));
        galley
    }
}

/// The lines of a text as egui joins them: without their ends, but for that of the text, which belongs to the last.
fn lines(text: &str) -> Vec<Range<usize>> {
    let (mut all, mut start) = (Vec::new(), 0);
    loop {
        let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        if end + 1 >= text.len() {
            all.push(start..text.len());
            return all;
        }
        all.push(start..end);
        start = end + 1;
    }
}

/// Room below the letters of a row for the line that marks an error, in points.
const BELOW: f32 = 3.0;

/// The layout of a line in a font, in rows of a height.
fn job(
    text: &str,
    words: &[(Range<usize>, Sort)],
    (font, height): (&FontId, f32),
    palette: &Palette,
) -> LayoutJob {
    let mut job = LayoutJob {
        wrap: TextWrapping::no_max_width(),
        keep_trailing_whitespace: true,
        ..LayoutJob::default()
    };
    let format = |sort| TextFormat {
        line_height: Some(height),
        ..TextFormat::simple(font.clone(), colour(sort, palette))
    };
    let mut at = 0;
    for (range, sort) in words {
        if at < range.start {
            job.append(&text[at..range.start], 0.0, format(Sort::Plain));
        }
        job.append(&text[range.clone()], 0.0, format(*sort));
        at = range.end;
    }
    if at < text.len() || text.is_empty() {
        job.append(&text[at..], 0.0, format(Sort::Plain));
    }
    job
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laid(layouts: &mut Layouts, text: &str) -> (Arc<Galley>, usize) {
        let (ctx, before) = (Context::default(), layouts.laid);
        laid_in(&ctx, layouts, text, before)
    }

    fn laid_in(ctx: &Context, layouts: &mut Layouts, text: &str, before: usize) -> (Arc<Galley>, usize) {
        let mut galley = None;
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            galley = Some(layouts.lay(ui, text, Language::Wgsl));
        });
        (galley.expect("shown"), layouts.laid - before)
    }

    #[test]
    fn a_row_is_a_line_and_the_text_is_the_text() {
        for text in ["", "\n", "a", "a\n", "a\n\n", "\n\na\n\nb", "fn f() {\n\tlet é = 1.0;\n}\n"] {
            let (galley, _) = laid(&mut Layouts::default(), text);
            assert_eq!(galley.text(), text);
            assert_eq!(galley.rows.len(), text.split('\n').count(), "{text:?}");
            let end = galley.end().index.0;
            assert_eq!(end, text.chars().count(), "{text:?}");
        }
    }

    #[test]
    fn only_lines_that_change_are_laid_out_again() {
        let text: String = (0..2000).map(|i| format!("let x{i} = {i}.0;\n")).collect();
        let (ctx, mut layouts) = (Context::default(), Layouts::default());
        // The texture of the letters grows with the first one.
        laid_in(&ctx, &mut layouts, &text, 0);
        let before = layouts.laid;
        let (_, again) = laid_in(&ctx, &mut layouts, &text, before);
        assert_eq!(again, 0);
        let edited = text.replace("let x1000 =", "let y1000 =");
        let (galley, changed) = laid_in(&ctx, &mut layouts, &edited, before);
        assert_eq!(changed, 1);
        assert_eq!(galley.text(), edited);
        // A comment that is opened changes the colours of all below it.
        let before = layouts.laid;
        let (_, all) = laid_in(&ctx, &mut layouts, &format!("/*{text}"), before);
        assert!(all >= 1999, "{all}");
    }

    #[test]
    fn a_text_that_was_out_of_sight_is_laid_out_again() {
        let (ctx, mut layouts) = (Context::default(), Layouts::default());
        let mut shown = || {
            let before = layouts.laid;
            laid_in(&ctx, &mut layouts, "let a = 1.0;\nlet b = 2.0;\n", before).1
        };
        shown();
        assert_eq!((shown(), shown()), (0, 0), "nothing has changed");
        // The letters may have other places in their texture, such as after other themes.
        let _ = ctx.run_ui(egui::RawInput::default(), |_| ());
        assert_eq!((shown(), shown()), (2, 0));
    }
}
