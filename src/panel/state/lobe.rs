//! The choices of the lobe in the picture. They belong to the session, not to the scene.

/// The lengths of the lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LobeScale {
    /// There is no lobe: it would hide the surface that is explained.
    #[default]
    Off,
    /// In proportion to the BRDF.
    Linear,
    /// In proportion to its logarithm.
    Logarithmic,
}

impl LobeScale {
    /// Every choice, in the order of the key.
    pub const ALL: [Self; 3] = [Self::Off, Self::Linear, Self::Logarithmic];

    /// The name for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "Off",
            Self::Linear => "Linear",
            Self::Logarithmic => "Logarithmic",
        }
    }

    /// What it is for.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Off => "No lobe is drawn.",
            Self::Linear => "The length in each direction is the BRDF f towards a viewer there.",
            Self::Logarithmic => {
                "Equal steps are equal factors: the diffuse part is seen beside a narrow highlight."
            }
        }
    }
}

/// The lobe of the model at the point that is explained.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobeChoice {
    /// Its lengths.
    pub scale: LobeScale,
    /// True for a lobe for each light that reaches the point, false for that of the light that is unfolded.
    pub all: bool,
}

impl LobeChoice {
    /// The choice with the scale after this one; after the last comes the first.
    #[must_use]
    pub fn next(self) -> Self {
        let scale = match self.scale {
            LobeScale::Off => LobeScale::Linear,
            LobeScale::Linear => LobeScale::Logarithmic,
            LobeScale::Logarithmic => LobeScale::Off,
        };
        Self { scale, ..self }
    }
}
