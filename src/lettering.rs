//! Text in pictures, with the fonts of the window.

use std::sync::{Arc, LazyLock, Mutex};

use epaint::{
    Color32, FontColorTransferFunction, FontFamily, FontId,
    text::{FontData, FontDefinitions, Fonts, Galley, LayoutJob, PlacedRow, TextOptions},
};

use crate::{
    caught::lock,
    text::mathematics::{is_variable, parse_symbol},
};

/// Minimum and maximum text size, in pixels. Larger glyphs would exceed their memory.
const SIZES: std::ops::RangeInclusive<f32> = 4.0..=200.0;

/// The family of the semibold text font.
#[must_use]
pub fn semibold() -> FontFamily {
    FontFamily::Name("semibold".into())
}
/// The family of upright mathematics.
#[must_use]
pub fn maths() -> FontFamily {
    FontFamily::Name("maths".into())
}
/// The family of variables in mathematics.
#[must_use]
pub fn maths_italic() -> FontFamily {
    FontFamily::Name("maths italic".into())
}

/// The fonts of the program, by family.
#[must_use]
pub fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let bundled: [(&str, &'static [u8]); 4] = [
        ("lab text", include_bytes!("../assets/fonts/text-regular.otf")),
        ("lab semibold", include_bytes!("../assets/fonts/text-semibold.otf")),
        ("lab maths", include_bytes!("../assets/fonts/maths-regular.otf")),
        ("lab maths italic", include_bytes!("../assets/fonts/maths-italic.otf")),
    ];
    for (name, bytes) in bundled {
        fonts.font_data.insert(name.to_owned(), Arc::new(FontData::from_static(bytes)));
    }
    // egui's own fonts come last: they have pictograms that ours lack.
    let builtin = fonts.families.get(&FontFamily::Proportional).cloned().unwrap_or_default();
    let family = |first: &[&str]| -> Vec<String> {
        first.iter().map(|s| (*s).to_owned()).chain(builtin.iter().cloned()).collect()
    };
    fonts.families.insert(FontFamily::Proportional, family(&["lab text", "lab maths"]));
    fonts.families.insert(semibold(), family(&["lab semibold", "lab maths"]));
    fonts.families.insert(maths(), family(&["lab maths", "lab text"]));
    fonts.families.insert(maths_italic(), family(&["lab maths italic", "lab maths", "lab text"]));
    fonts
}

/// Glyph shapes, created once.
static GLYPHS: LazyLock<Mutex<Fonts>> = LazyLock::new(|| Mutex::new(Fonts::new(OPTIONS, fonts())));

/// Glyphs contain plain coverage, since the background is not known until they are drawn.
const OPTIONS: TextOptions = TextOptions {
    max_texture_side: 4096,
    color_transfer_function: FontColorTransferFunction::Off,
    font_hinting: true,
    subpixel_binning: true,
};

/// A style of lettering; the size is that of the em in pixels, from 4 to 200.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lettering {
    /// For text.
    #[default]
    Regular,
    /// For headings.
    Semibold,
    /// For the symbol of a parameter, such as `k_d`: the part after `_` is a subscript.
    Symbol,
}

/// Characters of one font and size in a line.
struct Run {
    text: String,
    font: FontId,
    /// Offset of the baseline below that of the line, in pixels.
    lower: f32,
}

impl Lettering {
    /// Draws a line of text into a picture of RGB bytes, row by row from the top; `size` is its width and
    /// height, `at` the upper left corner of the line, `px` the size of the text. Parts outside the picture
    /// are clipped.
    pub fn draw(
        self,
        picture: &mut [u8],
        size: [u32; 2],
        at: [i32; 2],
        px: f32,
        colour: [u8; 3],
        text: &str,
    ) {
        let foot = self.foot(px);
        let mut x = i64::from(at[0]);
        for run in self.runs(px, text) {
            let lower = run.lower;
            x += laid_out(run.job(), |galley, glyphs| {
                let y = i64::from(at[1]) + (foot - foot_of(galley, glyphs) + lower).round() as i64;
                ink(picture, size, [x, y], colour, galley, glyphs);
                galley.size().x.ceil() as i64
            });
        }
    }

    /// The width of a line of text, in pixels.
    #[must_use]
    pub fn width(self, px: f32, text: &str) -> u32 {
        let width = |run: Run| laid_out(run.job(), |galley, _| galley.size().x.ceil() as u32);
        self.runs(px, text).into_iter().map(width).sum()
    }

    /// The height of a line of text, in pixels, which is the same in every style.
    #[must_use]
    pub fn height(self, px: f32) -> u32 {
        laid_out(Run::plain("x", px).job(), |galley, _| galley.size().y.ceil() as u32)
    }

    /// The text in lines no wider than `width`, broken between words; text beyond this many lines is replaced
    /// by "…".
    #[must_use]
    pub fn lines(self, px: f32, text: &str, width: u32, most: usize) -> Vec<String> {
        let mut room = width as f32;
        loop {
            let lines: Vec<_> =
                self.runs(px, text).into_iter().flat_map(|run| run.broken(room, most)).collect();
            let widest = lines.iter().map(|line| self.width(px, line)).max().unwrap_or(0);
            // Letters that are no longer adjacent, since some were removed, can be wider than before.
            if widest <= width || room < 1.0 {
                return lines;
            }
            room -= 1.0;
        }
    }

    /// The distance of the baseline from the top of the line, in pixels.
    #[must_use]
    pub fn foot(self, px: f32) -> f32 {
        laid_out(Run::plain("x", px).job(), foot_of)
    }

    fn runs(self, px: f32, text: &str) -> Vec<Run> {
        let plain = Run::plain(text, px);
        match self {
            Self::Regular => vec![plain],
            Self::Semibold => vec![Run { font: FontId::new(plain.font.size, semibold()), ..plain }],
            Self::Symbol => {
                // As large as in the window; next to text, letters of this font look small.
                let size = 1.1 * plain.font.size;
                let atom = parse_symbol(&plain.text);
                let base = Run {
                    text: atom.base().to_owned(),
                    font: FontId::new(size, letter(atom.base())),
                    lower: 0.0,
                };
                let index = Run {
                    text: atom.sub().to_owned(),
                    font: FontId::new(0.7 * size, letter(atom.sub())),
                    lower: 0.22 * size,
                };
                [base, index].into_iter().filter(|run| !run.text.is_empty()).collect()
            }
        }
    }
}

/// The font of an italic variable, or of a word as a subscript. Capital Greek letters are upright by
/// convention.
fn letter(text: &str) -> FontFamily {
    let greek = text.starts_with(|c| ('Α'..='Ω').contains(&c));
    if is_variable(text) && !greek { maths_italic() } else { maths() }
}

impl Run {
    fn plain(text: &str, px: f32) -> Self {
        let px = if px.is_nan() { *SIZES.start() } else { px.clamp(*SIZES.start(), *SIZES.end()) };
        // A line contains neither line ends nor tabs.
        let text = text.replace(char::is_control, " ");
        Self { text, font: FontId::new(px, FontFamily::Proportional), lower: 0.0 }
    }

    fn broken(self, width: f32, most: usize) -> Vec<String> {
        let mut job = self.job();
        job.wrap.max_width = width;
        job.wrap.max_rows = most;
        job.wrap.break_anywhere = most == 1;
        let row = |row: &PlacedRow| row.row.glyphs.iter().map(|glyph| glyph.chr).collect::<String>();
        // No space at the end, nor before the ellipsis.
        let tidy = |row: String| match row.strip_suffix('…') {
            Some(start) => format!("{}…", start.trim_end()),
            None => row.trim_end().to_owned(),
        };
        laid_out(job, |galley, _| galley.rows.iter().map(|r| tidy(row(r))).collect())
    }

    fn job(self) -> LayoutJob {
        LayoutJob::simple_singleline(self.text, self.font, Color32::WHITE)
    }
}

/// The distance of the baseline from the top of a line.
fn foot_of(galley: &Galley, _: &Fonts) -> f32 {
    galley.rows.first().and_then(|row| row.row.glyphs.first()).map_or(0.0, |glyph| glyph.pos.y)
}

/// Draws the glyphs of a line.
fn ink(picture: &mut [u8], size: [u32; 2], at: [i64; 2], colour: [u8; 3], galley: &Galley, glyphs: &Fonts) {
    let atlas = glyphs.texture_atlas().image();
    for row in &galley.rows {
        for glyph in row.row.glyphs.iter().filter(|glyph| !glyph.uv_rect.is_nothing()) {
            let uv = &glyph.uv_rect;
            let corner = glyph.pos + uv.offset;
            let left = at[0] + (row.pos.x + corner.x.round()) as i64;
            let top = at[1] + (row.pos.y + corner.y.round()) as i64;
            for (y, v) in (top..).zip(uv.min[1]..uv.max[1]) {
                for (x, u) in (left..).zip(uv.min[0]..uv.max[0]) {
                    let Some(pixel) = pixel(picture, size, [x, y]) else { continue };
                    blend(pixel, colour, atlas[(usize::from(u), usize::from(v))]);
                }
            }
        }
    }
}

fn laid_out<T>(job: LayoutJob, then: impl FnOnce(&Galley, &Fonts) -> T) -> T {
    let mut glyphs = lock(&GLYPHS);
    // Clears the cache when it holds too many glyphs.
    glyphs.begin_pass(OPTIONS);
    let galley = glyphs.with_pixels_per_point(1.0).layout_job(job);
    then(&galley, &glyphs)
}

/// The pixel at a position, if it is in the picture.
pub(crate) fn pixel(picture: &mut [u8], size: [u32; 2], at: [i64; 2]) -> Option<&mut [u8; 3]> {
    let [x, y] = [u32::try_from(at[0]).ok()?, u32::try_from(at[1]).ok()?];
    if x >= size[0] || y >= size[1] {
        return None;
    }
    picture.as_chunks_mut().0.get_mut(y as usize * size[0] as usize + x as usize)
}

/// Puts a pixel of a glyph over a pixel of the picture.
fn blend(pixel: &mut [u8; 3], colour: [u8; 3], glyph: Color32) {
    let coverage = f32::from(glyph.a()) / 255.0;
    // Display codes are not linear light: light text would look thin, as egui notes for its dark mode.
    let light = colour.iter().map(|c| u32::from(*c)).sum::<u32>() > 3 * 127;
    let alpha = if light { coverage * (2.0 - coverage) } else { coverage };
    for (under, over) in pixel.iter_mut().zip(colour) {
        let mixed = f32::from(*under) * (1.0 - alpha) + f32::from(over) * alpha;
        *under = mixed.round() as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [240, 40];

    fn drawn(with: Lettering, at: [i32; 2], px: f32, text: &str) -> Vec<u8> {
        let mut picture = vec![0; (SIZE[0] * SIZE[1] * 3) as usize];
        with.draw(&mut picture, SIZE, at, px, [255, 255, 255], text);
        picture
    }

    /// The first and the last column with ink.
    fn extent(picture: &[u8]) -> Option<(u32, u32)> {
        let inked = |(i, byte): (usize, &u8)| (*byte > 0).then_some(i as u32 / 3 % SIZE[0]);
        let columns: Vec<_> = picture.iter().enumerate().filter_map(inked).collect();
        Some((*columns.iter().min()?, *columns.iter().max()?))
    }

    #[test]
    fn text_is_as_wide_as_measured() {
        for with in [Lettering::Regular, Lettering::Semibold] {
            for text in ["B · Phong, α 27", "Oren–Nayar", "H"] {
                let (left, right) = extent(&drawn(with, [10, 5], 20.0, text)).expect("has ink");
                let width = with.width(20.0, text);
                assert!((9..14).contains(&left), "{text}: {left}");
                assert!(right <= 10 + width && right + 4 >= 10 + width, "{text}: {right}, {width}");
            }
        }
        assert!(Lettering::Semibold.width(20.0, "Phong") > Lettering::Regular.width(20.0, "Phong"));
        assert_eq!(Lettering::Regular.width(20.0, ""), 0);
        assert!((20..30).contains(&Lettering::Regular.height(20.0)));
    }

    #[test]
    fn symbols_are_slanted_and_their_indices_small_and_low() {
        let rows = |picture: &[u8]| {
            let inked = |(i, byte): (usize, &u8)| (*byte > 127).then_some(i as u32 / 3 / SIZE[0]);
            let rows: Vec<_> = picture.iter().enumerate().filter_map(inked).collect();
            (*rows.iter().min().expect("has ink"), *rows.iter().max().expect("has ink"))
        };
        let drawn = |with, text| drawn(with, [10, 2], 24.0, text);
        let (k, k_d) = (drawn(Lettering::Symbol, "k"), drawn(Lettering::Symbol, "k_d"));
        assert_ne!(k, drawn(Lettering::Regular, "k"));
        // Letters share a baseline, and the subscript is below it.
        let foot = rows(&drawn(Lettering::Regular, "k")).1;
        assert!(rows(&k).1.abs_diff(foot) <= 1, "{:?}, {foot}", rows(&k));
        assert!(rows(&k_d).1 >= foot + 3 && rows(&k_d).0 == rows(&k).0, "{:?}", rows(&k_d));
        let width = |text| Lettering::Symbol.width(24.0, text);
        assert!(width("k_d") < width("k") + width("d"));
        assert_eq!(width("f_{ms}"), width("f_ms"), "braces group");
    }

    #[test]
    fn letters_stand_closer_where_the_font_says_so() {
        let width = |text| Lettering::Regular.width(100.0, text);
        assert!(width("AV") + 3 < width("A") + width("V"));
    }

    #[test]
    fn the_signs_of_our_texts_have_shapes_of_their_own() {
        let signs = "αβγδεθκλμρσφωΔθ–—·×²³₀₁≤≥≈−°±…“”→éüß";
        let unknown = drawn(Lettering::Regular, [10, 5], 20.0, "\u{10FFFF}");
        for sign in signs.chars() {
            let shape = drawn(Lettering::Regular, [10, 5], 20.0, &sign.to_string());
            assert!(extent(&shape).is_some(), "{sign}");
            assert_ne!(shape, unknown, "{sign}");
        }
    }

    #[test]
    fn what_lies_outside_is_not_drawn() {
        let whole = drawn(Lettering::Regular, [0, 5], 20.0, "Phong");
        let mut shifted = drawn(Lettering::Regular, [-20, 5], 20.0, "Phong");
        // The rest is drawn where it would be.
        for y in 0..SIZE[1] as usize {
            let row = y * SIZE[0] as usize * 3;
            shifted[row..row + SIZE[0] as usize * 3].rotate_right(60);
            assert_eq!(shifted[row + 60..row + 300], whole[row + 60..row + 300]);
        }
        for at in [[i32::MIN, 0], [i32::MAX, i32::MAX], [0, -100], [0, 100]] {
            assert_eq!(extent(&drawn(Lettering::Regular, at, 20.0, "Phong")), None, "{at:?}");
        }
        // A picture with fewer bytes than its size requires.
        Lettering::Regular.draw(&mut [0; 10], SIZE, [0, 0], 20.0, [255; 3], "Phong");
        for px in [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e9] {
            assert!(Lettering::Regular.width(px, "Phong") < 1000);
            let _ = drawn(Lettering::Regular, [0, 0], px, "Phong\n\t\u{1b}中🙂");
        }
    }

    #[test]
    fn colours_cover_what_is_below() {
        let mut picture = vec![200; (SIZE[0] * SIZE[1] * 3) as usize];
        Lettering::Semibold.draw(&mut picture, SIZE, [4, 4], 28.0, [10, 20, 30], "█ Hl");
        assert!(picture.as_chunks::<3>().0.contains(&[10, 20, 30]), "full ink is its colour");
        assert!(picture.iter().all(|byte| (10..=200).contains(byte)));
    }

    #[test]
    fn long_text_is_broken_between_words_and_ends_in_an_ellipsis() {
        let with = Lettering::Regular;
        let text = "Blinn–Phong (normalised), α = 27, k_s = 0.4, k_d = 0.6, exposure −1 EV";
        let one = with.lines(16.0, text, 200, 1);
        assert!(
            one.len() == 1 && one[0].ends_with('…') && text.starts_with(one[0].trim_end_matches('…')),
            "{one:?}"
        );
        let two = with.lines(16.0, text, 300, 2);
        assert!(two.len() == 2 && two[0] != two[1], "{two:?}");
        for line in one.iter().chain(&two) {
            assert!(with.width(16.0, line) <= 300, "{line}");
        }
        for width in 20..200 {
            let line = &with.lines(16.0, text, width, 1)[0];
            assert!(with.width(16.0, line) <= width && !line.contains(" …"), "{width}: {line}");
        }
        assert_eq!(with.lines(16.0, text, 2000, 2), [text]);
        assert!(with.lines(16.0, text, 0, 1).len() <= 1);
    }
}
