//! The layout of a legend: the places of its parts on a plate, in whatever it is drawn.

/// Distances between the parts of a legend, in pixels or points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacing {
    /// Space around all parts, at the sides, and above and below.
    pub padding: [f32; 2],
    /// Height of the bar, and side of the square that shows a colour.
    pub bar: f32,
    /// Minimum width of the bar.
    pub least: f32,
    /// Gaps above the bar, below it, and below its numbers.
    pub gaps: [f32; 3],
    /// Gap between a square or the bar and what stands beside it.
    pub beside: f32,
    /// Gap below the line of a colour.
    pub line: f32,
}

/// The places of the parts of a legend below each other: a title, a bar, and further colours with their meanings. All
/// are in the units of the [`Spacing`], from the upper left corner of the plate.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Width and height.
    pub size: [f32; 2],
    /// Place of the title.
    pub title: [f32; 2],
    /// Left, top, width and height of the bar.
    pub bar: Option<[f32; 4]>,
    /// Places of the numbers.
    pub numbers: Vec<[f32; 2]>,
    /// Places of the squares with the colours, and of their texts.
    pub colours: Vec<[[f32; 2]; 2]>,
}

impl Plate {
    /// Lays out a legend whose texts have these sizes. Three numbers stand below a bar, at its ends and its middle; two
    /// beside it, at its ends; without numbers there is no bar.
    #[must_use]
    pub fn new(spacing: &Spacing, title: [f32; 2], numbers: &[[f32; 2]], texts: &[[f32; 2]]) -> Self {
        let Spacing { padding: [left, top], bar, least, gaps, beside, line } = *spacing;
        let of_numbers: f32 = numbers.iter().map(|n| n[0] + beside).sum();
        let of_scale = match numbers {
            [] => 0.0,
            [_, _] => least + of_numbers,
            _ => least,
        };
        let rows = texts.iter().map(|text| bar + beside + text[0]);
        let width = rows.fold(title[0].max(of_scale), f32::max);
        let mut all =
            Self { size: [0.0; 2], title: [left, top], bar: None, numbers: Vec::new(), colours: Vec::new() };
        let mut y = top + title[1];
        let high = numbers.iter().map(|n| n[1]).fold(0.0, f32::max);
        match numbers {
            [] => (),
            [from, to] => {
                let high = high.max(bar);
                y += gaps[0];
                all.bar = Some([left + from[0] + beside, y + 0.5 * (high - bar), width - of_numbers, bar]);
                let places = [(left, from), (left + width - to[0], to)];
                all.numbers = places.map(|(x, n)| [x, y + 0.5 * (high - n[1])]).into();
                y += high;
            }
            _ => {
                y += gaps[0];
                all.bar = Some([left, y, width, bar]);
                y += bar + gaps[1];
                let places = numbers.iter().zip([0.0, 0.5, 1.0]);
                all.numbers = places.map(|(n, part)| [left + part * (width - n[0]), y]).collect();
                y += high + gaps[2];
            }
        }
        for text in texts {
            let high = text[1].max(bar) + line;
            let [square, words] = [bar, text[1]].map(|own| y + 0.5 * (high - own));
            all.colours.push([[left, square], [left + bar + beside, words]]);
            y += high;
        }
        all.size = [width + 2.0 * left, y + top];
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: Spacing = Spacing {
        padding: [10.0, 6.0],
        bar: 12.0,
        least: 60.0,
        gaps: [4.0, 2.0, 2.0],
        beside: 8.0,
        line: 2.0,
    };

    #[test]
    fn three_numbers_stand_below_the_bar_and_two_beside_it() {
        let title = [100.0, 16.0];
        let below = Plate::new(&SPACING, title, &[[8.0, 14.0], [20.0, 14.0], [10.0, 14.0]], &[]);
        assert_eq!(below.bar, Some([10.0, 26.0, 100.0, 12.0]));
        assert_eq!(below.numbers, [[10.0, 40.0], [50.0, 40.0], [100.0, 40.0]]);
        assert_eq!(below.size, [120.0, 62.0]);
        let beside = Plate::new(&SPACING, title, &[[8.0, 14.0], [10.0, 14.0]], &[]);
        assert_eq!(beside.bar, Some([26.0, 27.0, 66.0, 12.0]));
        assert_eq!(beside.numbers, [[10.0, 26.0], [100.0, 26.0]]);
        assert_eq!(beside.size, [120.0, 46.0]);
        let narrow = Plate::new(&SPACING, [5.0, 16.0], &[[8.0, 14.0], [10.0, 14.0]], &[]);
        assert_eq!(narrow.bar.map(|bar| bar[2]), Some(60.0), "it keeps a width of its own");
    }

    #[test]
    fn each_colour_has_a_line_below() {
        let plate = Plate::new(&SPACING, [30.0, 16.0], &[], &[[50.0, 14.0], [20.0, 14.0]]);
        assert_eq!(plate.bar, None);
        assert_eq!(plate.colours, [[[10.0, 24.0], [30.0, 23.0]], [[10.0, 40.0], [30.0, 39.0]]]);
        assert_eq!(plate.size, [90.0, 60.0]);
    }
}
