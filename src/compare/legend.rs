//! The legend of a map of differences, and the mark at the largest difference.

use super::{
    canvas::{BRIGHT, Canvas, DARK, Rect, in_corner},
    colours::Colours,
    pair::Largest,
};
use crate::{
    channel::{Legend, Plate, Spacing},
    lettering::Lettering,
    scene::{
        comparison::{Channel, Compared, Comparison, Sign},
        variant::LETTERS,
    },
    text::trimmed,
};

/// Size of the letters of a legend at scale 1.
const LETTERS_PX: f32 = 16.0;

/// The value at full scale.
pub(super) fn full(values: Compared) -> f32 {
    match values {
        Compared::Codes => 255.0,
        Compared::Light => 1.0,
    }
}

/// The texts of the legend of a map of views.
fn legend_of(comparison: &Comparison, amplification: f32) -> Legend {
    let other = LETTERS.get(comparison.with).copied().unwrap_or("B");
    legend_between(comparison, amplification, [other, "A"])
}

/// The texts of the legend of a map of the first of two pictures minus the second.
fn legend_between(comparison: &Comparison, amplification: f32, [other, a]: [&str; 2]) -> Legend {
    let Comparison { sign, channel, values, .. } = *comparison;
    let difference = match (sign, amplification == 1.0) {
        (Sign::Absolute, _) => format!("|{other} − {a}|"),
        (Sign::Signed, true) => format!("{other} − {a}"),
        (Sign::Signed, false) => format!("({other} − {a})"),
    };
    let factor = if amplification == 1.0 { String::new() } else { format!("{} × ", short(amplification)) };
    let channel = match channel {
        Channel::Largest => "largest channel",
        channel => channel.name(),
    };
    let title = format!("{factor}{difference}: {channel}, {}", values.name());
    let end = short(full(values) / amplification);
    // As many decimals as the end has.
    let digits = end.split_once('.').map_or(0, |(_, digits)| digits.len());
    let middle = format!("{:.digits$}", 0.5 * full(values) / amplification);
    let numbers = match sign {
        Sign::Absolute => ["0".to_owned(), middle, end],
        Sign::Signed => [format!("−{end}"), "0".to_owned(), format!("+{end}")],
    };
    Legend { title, scale: Some(numbers), colours: Vec::new() }
}

/// The amplification at which a difference has nearly the last colour of a map: 1, 2, 5, 10, …, or 100.
#[must_use]
pub fn fitting_amplification(values: Compared, largest: f32) -> f32 {
    let fits = |factor: &f32| factor * largest <= full(values);
    [100.0, 50.0, 20.0, 10.0, 5.0, 2.0].into_iter().find(fits).unwrap_or(1.0)
}

/// A number with three significant digits.
#[must_use]
pub fn short(number: f32) -> String {
    let digits = 2 - (number.abs().max(1e-9).log10().floor() as i32).min(2);
    trimmed(format!("{number:.*}", usize::try_from(digits).unwrap_or_default()))
}

/// A legend laid out in letters of a picture.
pub(super) struct Lettered<'a> {
    legend: &'a Legend,
    title: Vec<String>,
    px: f32,
    /// Height of a line, and side of a square with a colour.
    line: u32,
    side: u32,
    plate: Plate,
    /// The distance of the parts from the sides of the plate, and of the plate from those of the picture.
    pub(super) margin: u32,
    pub(super) size: [u32; 2],
}

impl<'a> Lettered<'a> {
    /// Lays out a legend at a scale, with so many gaps above the bar and below its numbers; a title that is too wide is
    /// broken into lines. `None` without room.
    pub(super) fn new(scale: f32, room: [u32; 2], legend: &'a Legend, gaps: u32) -> Option<Self> {
        Self::in_lines(scale, room, legend, gaps, 1)
    }

    /// The same with a title that is broken into so many lines of about the same width.
    fn in_lines(
        scale: f32,
        [across, down]: [u32; 2],
        legend: &'a Legend,
        gaps: u32,
        lines: u32,
    ) -> Option<Self> {
        let Legend { title, scale: numbers, colours } = legend;
        let (px, style) = (LETTERS_PX * scale, Lettering::Regular);
        let [margin, gap, bar] = [10.0, 4.0, 14.0].map(|v| (v * scale).round());
        let line = style.height(px);
        let size = |text: &String| [style.width(px, text) as f32, line as f32];
        let numbers: Vec<_> = numbers.iter().flatten().map(size).collect();
        let texts: Vec<_> = colours.iter().map(|(_, text)| size(text)).collect();
        let least =
            if numbers.is_empty() { 0.0 } else { numbers.iter().map(|n| n[0]).sum::<f32>() + 4.0 * gap };
        let below = if gaps > 1 { gap } else { 0.0 };
        let spacing = Spacing {
            padding: [margin; 2],
            bar,
            least,
            gaps: [gap, 0.0, below],
            beside: 2.0 * gap,
            line: 0.0,
        };
        let room = across.saturating_sub(4 * margin as u32);
        let all = |width: u32, lines: usize| {
            let title = [width as f32, (line as usize * lines) as f32];
            Plate::new(&spacing, title, &numbers, &texts)
        };
        let least = all(0, 0).size[0] as u32 - 2 * margin as u32;
        // Words are not broken, so lines are of different widths.
        let longest = title.split(' ').map(|word| style.width(px, word)).max().unwrap_or(0);
        let even = style.width(px, title) / lines + if lines > 1 { longest / 2 } else { 0 };
        let width = even.max(least).min(room);
        let title = style.lines(px, title, width, 3);
        let is_wide = title.iter().any(|text| style.width(px, text) > width)
            || lines > 1 && title.iter().any(|text| text.ends_with('…'));
        let plate = all(width, title.len());
        let (size, margin) = (plate.size.map(|v| v as u32), margin as u32);
        let fits = width > 0 && width >= least && !is_wide && size[1] + 2 * margin <= down;
        fits.then_some(Self { legend, title, px, line, side: bar as u32, plate, margin, size })
    }

    /// Draws the legend in a rectangle of its size, with the colours of the bar from 0 to 1.
    pub(super) fn draw(&self, canvas: &mut Canvas, place: Rect, colour: impl Fn(f32) -> [u8; 3]) {
        let (px, style, plate) = (self.px, Lettering::Regular, &self.plate);
        let at = |[x, y]: [f32; 2]| [place[0] + x as u32, place[1] + y as u32];
        canvas.fill(place, DARK, 0.88);
        let [left, mut top] = at(plate.title);
        for text in &self.title {
            canvas.text(style, [left, top], px, text);
            top += self.line;
        }
        if let Some([x, y, width, height]) = plate.bar {
            let ([left, top], [width, height]) = (at([x, y]), [width, height].map(|v| v as u32));
            canvas.fill([left - 1, top - 1, width + 2, height + 2], BRIGHT, 0.5);
            for x in 0..width {
                canvas.fill([left + x, top, 1, height], colour((x as f32 + 0.5) / width as f32), 1.0);
            }
        }
        for (number, place) in self.legend.scale.iter().flatten().zip(&plate.numbers) {
            canvas.text(style, at(*place), px, number);
        }
        for ((colour, text), [square, words]) in self.legend.colours.iter().zip(&plate.colours) {
            let ([left, top], side) = (at(*square), self.side);
            canvas.fill([left - 1, top - 1, side + 2, side + 2], BRIGHT, 0.5);
            canvas.fill([left, top, side, side], *colour, 1.0);
            canvas.text(style, at(*words), px, text);
        }
    }
}

/// A picture with nothing but the legend of a map, in its middle, as far as there is room. `names` are those of the picture
/// and of the one subtracted from it.
#[must_use]
pub fn legend_alone(
    size: [u32; 2],
    ground: [u8; 3],
    comparison: &Comparison,
    amplification: f32,
    names: &[String; 2],
) -> Vec<u8> {
    let mut canvas = Canvas { size, rgb8: ground.repeat(size[0] as usize * size[1] as usize) };
    let legend = legend_between(comparison, amplification, names.each_ref().map(String::as_str));
    if let Some(plate) = Lettered::new(canvas.scale(), size, &legend, 1) {
        let [width, height] = plate.size;
        let place = [(size[0] - width) / 2, (size[1] - height) / 2, width, height];
        plate.draw(&mut canvas, place, |at| Colours::of(comparison.sign).at(at));
    }
    canvas.rgb8
}

/// Factors by which letters of a given size become smaller where the legend would hide objects even with its title in
/// several lines: not by much, since they are to be read.
const SMALLER: [f32; 3] = [1.0, 0.85, 0.7];
/// The numbers of lines of a title, the best first.
const LINES: [u32; 3] = [1, 2, 3];

/// Draws the legend in a lower corner where it does not cover the largest difference, if there is room. In letters of
/// `px` pixels, if there is room for them; they become smaller where the legend would hide objects with these outlines.
pub(super) fn draw(
    canvas: &mut Canvas,
    comparison: &Comparison,
    factor: f32,
    largest: Option<&Largest>,
    (px, outlines): (Option<f32>, Option<&[bool]>),
) {
    let legend = legend_of(comparison, factor);
    let (size, usual) = (canvas.size, canvas.scale());
    let scaled = |scale: f32| Lettered::new(scale, size, &legend, 1);
    let wanted = px.into_iter().flat_map(|px| SMALLER.map(|part| part * px / LETTERS_PX));
    let wanted = wanted.flat_map(|scale| LINES.map(|lines| (scale, lines)));
    let mut plates: Vec<_> =
        wanted.filter_map(|(scale, lines)| Lettered::in_lines(scale, size, &legend, 1, lines)).collect();
    if plates.is_empty() {
        plates.extend(scaled(usual));
    }
    let place = |plate: &Lettered<'_>, at_right: bool| {
        in_corner([0, 0, size[0], size[1]], [at_right, true], plate.size, plate.margin)
    };
    let hides_mark = |place: Rect| largest.is_some_and(|mark| hides(place, mark, usual));
    let outlines = outlines.filter(|_| px.is_some());
    let cuts = |place: Rect| outlines.is_some_and(|outlines| any_within(outlines, size[0], place));
    let mut all =
        plates.iter().flat_map(|plate| [false, true].map(|at_right| (plate, place(plate, at_right))));
    let free = all.find(|(_, place)| !hides_mark(*place) && !cuts(*place));
    // Where all places hide something, the smallest plate hides least.
    let otherwise = || {
        let plate = plates.iter().min_by_key(|plate| plate.size[0] * plate.size[1])?;
        Some((plate, place(plate, hides_mark(place(plate, false)))))
    };
    let Some((plate, place)) = free.or_else(otherwise) else { return };
    plate.draw(canvas, place, |at| Colours::of(comparison.sign).at(at));
}

/// True if a plate hides the mark at the largest difference.
fn hides([left, top, width, height]: Rect, mark: &Largest, scale: f32) -> bool {
    let margin = 2 * mark_radius(scale) as u32;
    mark.x + margin >= left
        && mark.x <= left + width + margin
        && mark.y + margin >= top
        && mark.y <= top + height + margin
}

/// True if any flag of a picture so many pixels wide is set within a rectangle.
fn any_within(flags: &[bool], across: u32, [left, top, width, height]: Rect) -> bool {
    let row = |y: u32| flags.iter().skip((y * across + left) as usize).take(width as usize);
    (top..top + height).any(|y| row(y).any(|on| *on))
}

fn mark_radius(scale: f32) -> f32 {
    (14.0 * scale).round()
}

/// Draws a circle around the largest difference, dark and bright, so that it is visible on every background.
pub(super) fn mark(canvas: &mut Canvas, largest: &Largest) {
    let scale = canvas.scale();
    let radius = mark_radius(scale);
    let at = [largest.x, largest.y];
    canvas.ring(at, radius, (6.0 * scale).max(5.0), [0, 0, 0]);
    canvas.ring(at, radius, (2.5 * scale).max(2.0), [255, 255, 255]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_says_what_is_shown_in_which_unit() {
        let plain = legend_of(&Comparison::default(), 1.0);
        assert_eq!(plain.title, "|B − A|: largest channel, display codes");
        assert_eq!(plain.scale, Some(["0", "128", "255"].map(str::to_owned)));
        let light = Comparison {
            sign: Sign::Signed,
            channel: Channel::Luminance,
            values: Compared::Light,
            with: 2,
            ..Comparison::default()
        };
        let amplified = legend_of(&light, 8.0);
        assert_eq!(amplified.title, "8 × (C − A): luminance, linear light");
        assert_eq!(amplified.scale, Some(["−0.125", "0", "+0.125"].map(str::to_owned)));
        let codes = legend_of(&Comparison::default(), 10.0);
        assert_eq!(codes.scale, Some(["0", "12.8", "25.5"].map(str::to_owned)));
    }

    #[test]
    fn a_large_legend_keeps_clear_of_objects_and_of_the_largest_difference() {
        let size = [640, 360];
        // A box from here to the right, down to the lower edge.
        let drawn = |left: u32, mark: Option<u32>| {
            let at = |i: u32| i / 640 > 20 && (i % 640 == left || i % 640 == 639);
            let outlines: Vec<bool> = (0..640 * 360).map(at).collect();
            let mut canvas = Canvas { size, rgb8: vec![255; 3 * 640 * 360] };
            let largest = mark.map(|x| Largest { x, y: 340, difference: 1.0, a: [0; 3], b: [1; 3] });
            let letters = (Some(32.0), Some(outlines.as_slice()));
            draw(&mut canvas, &Comparison::default(), 1.0, largest.as_ref(), letters);
            let dark = |x: u32| (0..360).any(|y| canvas.rgb8[(3 * (y * 640 + x)) as usize] < 100);
            (0..640).filter(|x| dark(*x)).collect::<Vec<_>>()
        };
        let whole = drawn(639, None);
        let beside = drawn(380, None);
        assert!(whole.last().is_some_and(|x| *x > 380), "it would hide the box: {whole:?}");
        assert!(beside.len() > 100 && beside.iter().all(|x| *x < 380), "{beside:?}");
        assert!(drawn(639, Some(30)).iter().all(|x| *x > 40), "it hides the mark");
    }

    #[test]
    fn a_legend_beside_an_object_breaks_its_title_before_its_letters_become_small() {
        let legend = legend_of(&Comparison::default(), 1.0);
        let of = |lines| Lettered::in_lines(2.0, [640, 360], &legend, 1, lines).expect("there is room");
        let [one, two] = [1, 2].map(of);
        assert_eq!((one.px, two.px), (32.0, 32.0));
        assert!(two.title.len() > 1 && two.size[0] < one.size[0], "{:?}: {:?}", two.title, two.size);
    }

    #[test]
    fn numbers_have_three_digits_that_count() {
        for (number, text) in [(255.0, "255"), (25.5, "25.5"), (2.55, "2.55"), (0.01, "0.01"), (1.0, "1")] {
            assert_eq!(short(number), text);
        }
        assert_eq!(short(0.123_456), "0.123");
        assert_eq!(short(100.0), "100");
    }
}
