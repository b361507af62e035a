//! Display options of the lobe in the picture. They belong to the session rather than to the scene.

/// Scale of the lobe's lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LobeScale {
    /// Hide the lobe, which would cover the explained surface.
    #[default]
    Off,
    /// Proportional to the BRDF.
    Linear,
    /// Proportional to the logarithm of the BRDF.
    Logarithmic,
}

impl LobeScale {
    /// All options, in the order of the key.
    pub const ALL: [Self; 3] = [Self::Off, Self::Linear, Self::Logarithmic];

    /// Display name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "Off",
            Self::Linear => "Linear",
            Self::Logarithmic => "Logarithmic",
        }
    }

    /// Description of the option.
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

/// Display options of the lobe at the explained point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LobeChoice {
    /// Scale of the lengths.
    pub scale: LobeScale,
    /// True to show a lobe for each light that reaches the point, false for the unfolded light only.
    pub all: bool,
}

impl LobeChoice {
    /// The option with the next scale, in a cycle.
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
