//! Display options of the lobe in the picture. They belong to the session rather than to the scene.

use crate::declared::choice;

choice! {
    /// Scale of the lobe's lengths, in the order of the key. Off is the default: a lobe covers the explained surface.
    LobeScale {
        #[default]
        Off "off" "Off" "No lobe is drawn.",
        Linear "linear" "Linear" "The length in each direction is the BRDF f towards a viewer there.",
        Logarithmic "logarithmic" "Logarithmic"
            "Equal steps are equal factors: the diffuse part is seen beside a narrow highlight.",
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
        Self { scale: self.scale.next(), ..self }
    }
}
