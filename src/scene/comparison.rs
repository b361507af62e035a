//! The layout in which the views of a scene are compared.

use super::variant::MAX_VARIANTS;

/// The smallest and the largest amplification of a difference.
pub const AMPLIFICATIONS: std::ops::RangeInclusive<f32> = 1.0..=100.0;

/// A choice with an id for files, a name for people, and one sentence.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident { $($(#[$default:ident])? $variant:ident $id:literal $label:literal $help:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum $name {
            $(#[doc = $help] $(#[$default])? $variant,)+
        }

        impl $name {
            /// Every choice, in the order of presentation.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// The id in scene files and on the command line.
            #[must_use]
            pub const fn id(self) -> &'static str {
                match self { $(Self::$variant => $id,)+ }
            }

            /// The name for people.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $label,)+ }
            }

            /// One sentence of explanation.
            #[must_use]
            pub const fn summary(self) -> &'static str {
                match self { $(Self::$variant => $help,)+ }
            }

            /// The choice with this id.
            #[must_use]
            pub fn from_id(id: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|choice| choice.id() == id)
            }
        }
    };
}

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

/// The way in which views are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The arrangement.
    pub layout: Layout,
    /// The view compared with view A in layouts of two views: 1 for B.
    pub with: usize,
    /// The position of the edge of a wipe: 0 at the left or top, 1 at the right or bottom.
    pub split: f32,
    /// The direction of the edge.
    pub edge: Edge,
    /// The sign of differences.
    pub sign: Sign,
    /// The value of a pixel that is compared.
    pub channel: Channel,
    /// The values that are compared.
    pub values: Compared,
    /// The factor by which a difference is multiplied before it is mapped to a colour, 1 to 100; `None` for
    /// the one that fits the largest difference.
    pub amplification: Option<f32>,
}

impl Default for Comparison {
    fn default() -> Self {
        Self {
            layout: Layout::default(),
            with: 1,
            split: 0.5,
            edge: Edge::default(),
            sign: Sign::default(),
            channel: Channel::default(),
            values: Compared::default(),
            amplification: None,
        }
    }
}

impl Comparison {
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
