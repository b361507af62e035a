//! Debug channels: the values that lead to the colour of a pixel, drawn as colours instead of the picture. Each is
//! declared in a file of its own, with its formula for both renderers, and named in [`DebugChannel`].
//!
//! [`wgsl`] joins the formulas for the shaders; `assets/shaders/channels.wgsl` has their common code.

pub mod colours;
mod declaration;
mod legend;

mod clipped;
mod depth;
mod face_normals;
mod facing;
mod luminance;
mod n_dot_h;
mod n_dot_l;
mod n_dot_v;
mod normals;
mod not_a_number;
mod one_light;
mod remaining_light;
mod vertex_normals;
mod vertices;
mod wireframe;

use std::fmt::Write as _;

use crate::declared::declared;
use legend::AXES;

pub use declaration::{Declaration, Leaving, Made, Point, Shows, Vertex};
pub use legend::{About, Legend};

declared! {
    /// A debug channel.
    DebugChannel: Declaration {
        Normals = normals::CHANNEL,
        FaceNormals = face_normals::CHANNEL,
        VertexNormals = vertex_normals::CHANNEL,
        Wireframe = wireframe::CHANNEL,
        Vertices = vertices::CHANNEL,
        NDotL = n_dot_l::CHANNEL,
        NDotV = n_dot_v::CHANNEL,
        NDotH = n_dot_h::CHANNEL,
        Facing = facing::CHANNEL,
        Depth = depth::CHANNEL,
        Luminance = luminance::CHANNEL,
        Clipped = clipped::CHANNEL,
        NotANumber = not_a_number::CHANNEL,
        RemainingLight = remaining_light::CHANNEL,
        Light = one_light::CHANNEL,
    }
}

/// The number in shaders from which on channels are of geometry: `CHANNEL_OF_GEOMETRY` in `channels.wgsl`.
const OF_GEOMETRY: u32 = 64;

/// The number that shaders have instead of that of a term where they draw the light that remains inside bodies:
/// `TERM_REMAINING` in `lights.wgsl`.
pub const REMAINING: u32 = 5;

impl DebugChannel {
    /// The display name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.declaration().name
    }

    /// The values of the channel, and what to look for.
    #[must_use]
    pub const fn explanation(self) -> &'static str {
        self.declaration().explanation
    }

    /// The channel over whose picture lines and dots are drawn; of others, the channel itself.
    #[must_use]
    pub const fn ground(self) -> Self {
        if self.has_wires() { Self::NotANumber } else { self }
    }

    /// The number in shaders; 0 draws the picture.
    #[must_use]
    pub const fn code(self) -> u32 {
        let ground = self.ground();
        match ground.declaration().shows {
            Shows::Geometry(..) => OF_GEOMETRY + ground as u32,
            Shows::Light(..) => 1 + ground as u32,
            _ => 0,
        }
    }

    /// True if the channel is a picture like any other, with exposure and tone mapping.
    #[must_use]
    pub const fn is_picture(self) -> bool {
        matches!(self.declaration().shows, Shows::Picture)
    }

    /// True if the channel shows the light that leaves the surface, not geometry; lines and dots are drawn
    /// over such a picture.
    #[must_use]
    pub const fn is_of_light(self) -> bool {
        !matches!(self.declaration().shows, Shows::Geometry(..))
    }

    /// True if lines or dots of the meshes are drawn over the channel's picture.
    #[must_use]
    pub const fn has_wires(self) -> bool {
        matches!(self.declaration().shows, Shows::Edges | Shows::Normals(_) | Shows::Dots(_))
    }

    /// True if its values derive from the light that leaves the surface, so that they depend on samples of lights with
    /// extent.
    #[must_use]
    pub const fn rests_on_samples(self) -> bool {
        self.is_of_light() && !self.has_wires()
    }

    /// True if it marks every vertex by a dot.
    #[must_use]
    pub const fn has_dots(self) -> bool {
        matches!(self.declaration().shows, Shows::Dots(_))
    }

    /// True if the channel is about one light.
    #[must_use]
    pub const fn has_light(self) -> bool {
        self.declaration().has_light
    }

    /// True if the channel shows the part of the light that remains inside solid bodies.
    #[must_use]
    pub const fn is_of_remaining(self) -> bool {
        self.declaration().of_remaining
    }

    /// The next channel after this one, or after `None`: cycles through all channels, then `None`.
    #[must_use]
    pub fn next(channel: Option<Self>) -> Option<Self> {
        let at = channel.and_then(|channel| Self::ALL.iter().position(|c| *c == channel));
        Self::ALL.get(at.map_or(0, |at| at + 1)).copied()
    }
}

/// The functions of all channels for the shaders.
#[must_use]
pub fn wgsl() -> String {
    let (mut of_light, mut of_geometry) = (String::new(), String::new());
    for channel in DebugChannel::ALL {
        let (cases, body) = match channel.declaration().shows {
            Shows::Light(_, body) => (&mut of_light, body),
            Shows::Geometry(_, body) => (&mut of_geometry, body),
            _ => continue,
        };
        let body = body.trim().replace('\n', "\n        ");
        let _ = write!(cases, "        case {}u: {{\n            {body}\n        }}\n", channel.code());
    }
    let function = |inputs: &str, cases: &str| {
        format!(
            "fn channel_of_{inputs} -> vec4<f32> {{\n    switch illumination.channel {{\n{cases}        default: {{ \
             return vec4(0.0); }}\n    }}\n}}\n"
        )
    };
    function("light(light: vec3<f32>, luminance: f32, exposed: vec3<f32>, pixel: vec2<f32>)", &of_light)
        + &function(
            "geometry(position: vec3<f32>, normal: vec3<f32>, face_normal: vec3<f32>, to_eye: vec3<f32>, v: vec3<f32>)",
            &of_geometry,
        )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::TermSelection;

    #[test]
    fn ids_and_codes_tell_channels_apart_and_the_key_goes_through_all() {
        let (mut shown, mut seen) = (None, Vec::new());
        while let Some(channel) = DebugChannel::next(shown) {
            seen.push(channel);
            shown = Some(channel);
            assert!(seen.len() <= DebugChannel::ALL.len(), "it never ends");
        }
        assert_eq!(seen, DebugChannel::ALL);
        for (i, channel) in DebugChannel::ALL.into_iter().enumerate() {
            assert_eq!(DebugChannel::from_id(channel.id()), Some(channel));
            assert!(channel.explanation().ends_with('.') && !channel.name().is_empty());
            // Lines and dots have no numbers of their own.
            let before = || DebugChannel::ALL[..i].iter().filter(|other| !other.has_wires());
            assert!(
                channel.has_wires() || before().all(|other| other.code() != channel.code()),
                "{channel:?}"
            );
            assert!(!channel.has_wires() || channel.code() == DebugChannel::NotANumber.code());
        }
        assert_eq!(DebugChannel::from_id("normal"), None);
    }

    #[test]
    fn what_remains_has_a_number_that_no_term_has() {
        let shared = include_str!("../../assets/shaders/lights.wgsl");
        assert!(shared.contains(&format!("const TERM_REMAINING: u32 = {REMAINING}u;")));
        assert!(TermSelection::ALL.iter().all(|term| *term as u32 != REMAINING));
    }

    #[test]
    fn shaders_tell_light_from_geometry_by_the_number() {
        let shared = include_str!("../../assets/shaders/channels.wgsl");
        assert!(shared.contains(&format!("const CHANNEL_OF_GEOMETRY: u32 = {OF_GEOMETRY}u;")));
        for channel in DebugChannel::ALL {
            assert_eq!(channel.code() < OF_GEOMETRY, channel.is_of_light(), "{channel:?}");
        }
    }
}
