//! The layout in which the views of a scene are compared.

use super::{
    Field,
    field::Kind,
    held::{Word, word},
    part::part,
    views::{LETTERS, MAX_VARIANTS},
};
use crate::declared::choice;

choice! {
    /// The arrangement of the views.
    Layout {
        #[default]
        Single "single" "single" "One view.",
        SideBySide "side_by_side" "side by side" "All views beside each other: two, or two rows of two.",
        Wipe "wipe" "wipe" "Two views over each other, with an edge between them that moves.",
        Difference "difference" "difference" "The difference between two views, as a map.",
        Blink "blink" "blink" "View A; while the key is held, the other.",
    }
}

choice! {
    /// The direction of the edge of a wipe.
    Edge {
        #[default]
        Vertical "vertical" "vertical" "View A at the left of the edge, the other at its right.",
        Horizontal "horizontal" "horizontal" "View A above the edge, the other below.",
    }
}

choice! {
    /// The sign of differences.
    Sign {
        #[default]
        Absolute "absolute" "absolute" "The size of the difference.",
        Signed "signed" "signed" "The difference with its sign: the other view minus view A.",
    }
}

choice! {
    /// The number of a pixel that is compared.
    Channel {
        #[default]
        Largest "largest" "largest" "The channel, red, green or blue, in which the difference is largest.",
        Luminance "luminance" "luminance" "Luminance: the channels weighted as the eye does (Rec. 709).",
        Red "red" "red" "The red channel.",
        Green "green" "green" "The green channel.",
        Blue "blue" "blue" "The blue channel.",
    }
}

choice! {
    /// The values that are compared.
    Compared {
        #[default]
        Codes "codes" "display codes" "The picture as displayed, 0 to 255: after exposure, tone mapping and encoding.",
        Light "light" "linear light" "The light of the picture, before exposure, tone mapping and encoding.",
    }
}

word! {
    Layout: |layout| layout.name(), layout.summary();
    Edge: |edge| edge.name(), edge.summary();
    Sign: |sign| sign.name(), sign.summary();
    Channel: |channel| channel.name(), channel.summary();
    Compared: |compared| compared.name(), compared.summary();
}

/// The views of a layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Views {
    /// One.
    One,
    /// All, beside each other.
    All,
    /// View A and another, in one place.
    Two,
    /// The difference between these two.
    Difference,
    /// These two, one after the other.
    InTurn,
}

impl Layout {
    /// The views that it shows.
    #[must_use]
    pub const fn shows(self) -> Views {
        match self {
            Self::Single => Views::One,
            Self::SideBySide => Views::All,
            Self::Wipe => Views::Two,
            Self::Difference => Views::Difference,
            Self::Blink => Views::InTurn,
        }
    }

    /// True if it shows view A and one other.
    #[must_use]
    pub const fn shows_two(self) -> bool {
        matches!(self.shows(), Views::Two | Views::Difference | Views::InTurn)
    }

    /// True if views stand beside each other.
    #[must_use]
    pub const fn is_beside(self) -> bool {
        matches!(self.shows(), Views::All)
    }

    /// True if it has an edge between the views that moves.
    #[must_use]
    pub const fn has_edge(self) -> bool {
        matches!(self.shows(), Views::Two)
    }

    /// True if it is a map of differences.
    #[must_use]
    pub const fn is_map(self) -> bool {
        matches!(self.shows(), Views::Difference)
    }

    /// True if it shows two views one after the other.
    #[must_use]
    pub const fn is_in_turn(self) -> bool {
        matches!(self.shows(), Views::InTurn)
    }
}

part! {
    /// The way in which the views of a scene are shown.
    #[derive(Copy)]
    pub struct Comparison("comparison") {
        /// Arrangement of the views.
        layout: Layout = Field::of("the layout", Kind::Choice(Layout::words)), Layout::Single;
        /// Letter of the view that is compared with view A where two are.
        with: usize = Field::of("the other view", Kind::Choice(letters)), 1;
        /// Place of the edge of a wipe: 0 at the left or top, 1 at the right or bottom.
        split: f32 = Field::number("the place of the edge", 0.0..=1.0), 0.5;
        /// Direction of the edge of a wipe.
        edge: Edge = Field::of("the edge of a wipe", Kind::Choice(Edge::words)), Edge::Vertical;
        /// Sign of differences.
        sign: Sign = Field::of("the sign of a difference", Kind::Choice(Sign::words)), Sign::Absolute;
        /// The number of a pixel that is compared.
        channel: Channel = Field::of("the channel of a difference", Kind::Choice(Channel::words)), Channel::Largest;
        /// The values that are compared.
        values: Compared = Field::of("the values of a difference", Kind::Choice(Compared::words)), Compared::Codes;
        /// Factor by which a difference is multiplied before it becomes a colour. Default: the one that fits the largest
        /// difference.
        amplification: Option<f32> = Field::number("the amplification", 1.0..=100.0), None;
    }
}

/// The letters of the views that may be compared with view A.
fn letters() -> Vec<[&'static str; 3]> {
    LETTERS[1..].iter().map(|letter| [*letter, "", ""]).collect()
}

impl Comparison {
    /// Moves the edge of a wipe to a place, or to the nearest legal one.
    #[must_use]
    pub fn with_split(self, split: f32) -> Self {
        let limits = Self::split.limits();
        Self { split: f64::from(split).clamp(limits.min, limits.max) as f32, ..self }
    }

    /// The views that the layout shows for a scene with this number of variants, in the order of their
    /// positions.
    #[must_use]
    pub fn views(&self, variants: usize) -> Vec<usize> {
        let count = variants.min(MAX_VARIANTS);
        if count == 0 {
            return vec![0];
        }
        match self.layout.shows() {
            Views::One => vec![0],
            Views::All => (0..=count).collect(),
            Views::Two | Views::Difference | Views::InTurn => vec![0, self.with.clamp(1, count)],
        }
    }
}
