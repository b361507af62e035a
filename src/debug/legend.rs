//! Legends of channels, for the window and for pictures.

use super::colours::BELOW;

/// The facts that a legend may mention.
pub struct About<'a> {
    /// The ends of the scale.
    pub range: [f32; 2],
    /// The light for people; `None` if there is none of the kind that the channel needs.
    pub light: &'a dyn Fn() -> Option<String>,
    /// True if some vertices have a colour of their own, and true if some have none.
    pub vertices: &'a dyn Fn() -> [bool; 2],
}

/// The meaning of a channel's colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Legend {
    /// The quantity shown, with its unit.
    pub title: String,
    /// The numbers at the left, in the middle and at the right of a bar with the colours of
    /// [viridis](crate::optics::viridis).
    pub scale: Option<[String; 3]>,
    /// Additional colours, with their meanings.
    pub colours: Vec<([u8; 3], String)>,
}

/// The colours of directions along the axes.
pub(super) const AXES: [([u8; 3], &str); 3] =
    [([255, 128, 128], "right (+x)"), ([128, 255, 128], "up (+y)"), ([128, 128, 255], "out (+z)")];

impl Legend {
    /// A legend without colours.
    #[must_use]
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), scale: None, colours: Vec::new() }
    }

    /// The legend of a cosine.
    #[must_use]
    pub fn cosine(title: impl Into<String>) -> Self {
        Self::new(title).scale(["0", "0.5", "1"]).colours(&[(BELOW, "below 0")])
    }

    /// The legend of a cosine with the direction of a light.
    #[must_use]
    pub fn lit_cosine(name: &str, about: &About<'_>) -> Self {
        let light = (about.light)().unwrap_or_else(|| "no light has a direction".to_owned());
        Self::cosine(format!("{name}: {light}"))
    }

    /// Returns the legend with the numbers of a scale.
    #[must_use]
    pub fn scale(self, numbers: [&str; 3]) -> Self {
        Self { scale: Some(numbers.map(str::to_owned)), ..self }
    }

    /// Returns the legend with further colours.
    #[must_use]
    pub fn colours(self, colours: &[([u8; 3], &str)]) -> Self {
        Self { colours: colours.iter().map(|(colour, text)| (*colour, (*text).to_owned())).collect(), ..self }
    }
}
