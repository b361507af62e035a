//! The legend of a map of differences, and the mark at the largest difference.

use super::{
    canvas::{BRIGHT, Canvas, DARK, Rect},
    colours::Colours,
    pair::Largest,
};
use crate::{
    lettering::Lettering,
    scene::{
        comparison::{Channel, Compared, Comparison, Sign},
        variant::LETTERS,
    },
};

/// The texts of a legend.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Texts {
    /// The quantity shown, and its unit.
    pub(super) title: String,
    /// The numbers at the left, in the middle and at the right of the bar.
    pub(super) numbers: [String; 3],
}

/// The value at full scale.
pub(super) fn full(values: Compared) -> f32 {
    match values {
        Compared::Codes => 255.0,
        Compared::Light => 1.0,
    }
}

impl Texts {
    pub(super) fn new(comparison: &Comparison, amplification: f32) -> Self {
        let Comparison { sign, channel, values, with, .. } = *comparison;
        let other = LETTERS.get(with).copied().unwrap_or("B");
        let difference = match (sign, amplification == 1.0) {
            (Sign::Absolute, _) => format!("|{other} − A|"),
            (Sign::Signed, true) => format!("{other} − A"),
            (Sign::Signed, false) => format!("({other} − A)"),
        };
        let factor =
            if amplification == 1.0 { String::new() } else { format!("{} × ", short(amplification)) };
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
        Self { title, numbers }
    }
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
    let text = format!("{number:.*}", usize::try_from(digits).unwrap_or_default());
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Draws the legend in a lower corner where it does not cover the largest difference: the bar, and the texts as far as
/// there is room.
pub(super) fn draw(canvas: &mut Canvas, comparison: &Comparison, factor: f32, largest: Option<&Largest>) {
    let texts = Texts::new(comparison, factor);
    let scale = canvas.scale();
    let px = 16.0 * scale;
    let style = Lettering::Regular;
    let [pad, gap, bar] = [10.0, 4.0, 14.0].map(|v| (v * scale).round() as u32);
    let line = style.height(px);
    let wanted = style.width(px, &texts.title);
    let room = canvas.size[0].saturating_sub(4 * pad);
    let least = texts.numbers.iter().map(|n| style.width(px, n)).sum::<u32>() + 4 * gap;
    // A title that is too wide is broken into lines; without room for the numbers, no legend is drawn.
    let width = wanted.min(room);
    let lines = style.lines(px, &texts.title, width, 3);
    let height = line * lines.len() as u32 + gap + bar + line;
    if width < least || height + 4 * pad > canvas.size[1] {
        return;
    }
    let plate_size = [width + 2 * pad, height + 2 * pad];
    let top = canvas.size[1] - plate_size[1] - pad;
    let at_left = [pad, top, plate_size[0], plate_size[1]];
    let right = canvas.size[0] - plate_size[0] - pad;
    let hides = |[left, top, width, height]: Rect| {
        let margin = 2 * mark_radius(scale) as u32;
        largest.is_some_and(|mark| {
            mark.x + margin >= left
                && mark.x <= left + width + margin
                && mark.y + margin >= top
                && mark.y <= top + height + margin
        })
    };
    let left = if hides(at_left) { right } else { pad };
    canvas.fill([left, top, plate_size[0], plate_size[1]], DARK, 0.88);
    let left = left + pad;
    let mut y = top + pad;
    for text in &lines {
        canvas.text(style, [left, y], px, text);
        y += line;
    }
    y += gap;
    canvas.fill([left - 1, y - 1, width + 2, bar + 2], BRIGHT, 0.5);
    let colours = Colours::of(comparison.sign);
    for x in 0..width {
        let at = (x as f32 + 0.5) / width as f32;
        canvas.fill([left + x, y, 1, bar], colours.at(at), 1.0);
    }
    y += bar;
    for (number, at) in texts.numbers.iter().zip([0.0, 0.5, 1.0]) {
        let free = width.saturating_sub(style.width(px, number));
        canvas.text(style, [left + (at * free as f32) as u32, y], px, number);
    }
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
        let plain = Texts::new(&Comparison::default(), 1.0);
        assert_eq!(plain.title, "|B − A|: largest channel, display codes");
        assert_eq!(plain.numbers, ["0", "128", "255"]);
        let light = Comparison {
            sign: Sign::Signed,
            channel: Channel::Luminance,
            values: Compared::Light,
            with: 2,
            ..Comparison::default()
        };
        let amplified = Texts::new(&light, 8.0);
        assert_eq!(amplified.title, "8 × (C − A): luminance, linear light");
        assert_eq!(amplified.numbers, ["−0.125", "0", "+0.125"]);
        let codes = Texts::new(&Comparison::default(), 10.0);
        assert_eq!(codes.numbers, ["0", "12.8", "25.5"]);
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
