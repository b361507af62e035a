use glam::Vec3;

use super::{Declaration, Factor, Incident, LightRecord, LightType, extent::number};
use crate::{
    optics::radiometry::{cone, cone_edges, cone_solid_angle, inverse_square},
    parameter::{ABOVE_ZERO, Parameter},
    parameters,
    shader::wgsl,
};

const CONE_ANGLE: Parameter = Parameter::number("cone_angle", ABOVE_ZERO..=90.0, 30.0)
    .symbol("θ_c")
    .label("cone angle")
    .unit("°")
    .help("Half the opening of the cone: the angle between its axis and its edge.");

const PENUMBRA: Parameter = Parameter::number("penumbra", 0.0..=1.0, 0.1).symbol("s").help(
    "The fraction of the cone taken by the soft edge: 0 is a hard edge, 1 fades from the axis outwards.",
);

parameters! {
    /// **Spotlight**: a point light within a cone; `I(p) = I · cone(θ, θ_c, s) / |p − p₀|²`
    /// ([`cone`]), I in candela, on the axis. The luminous flux is `Φ = I ∫ cone dω` lumen
    /// ([`cone_solid_angle`]).
    pub struct Spot {
        /// Half the opening of the cone, degrees.
        cone_angle: number = CONE_ANGLE,
        /// The fraction of the cone taken by the soft edge.
        penumbra: number = PENUMBRA,
    }
}

impl Spot {
    /// The profile of the cone towards a point; `l` is the direction from there to the light.
    fn profile(&self, light: &LightRecord, l: Vec3) -> f32 {
        cone(light.direction, -l, cone_edges(self.cone_angle, self.penumbra))
    }
}

impl LightType for Spot {
    const DECLARATION: Declaration = Declaration::new("spot", "Spot", wgsl!("light/spot.wgsl"))
        .summary("A point light within a cone; falls off with the square of the distance and fades at the cone's edge.")
        .glyph("▼")
        .at_position()
        .with_direction()
        .candela(20.0, 200.0)
        .cone(CONE_ANGLE.name)
        .equation("I(p) = I cone(θ, θ_c, s) / d^2");

    // The edges of the cone: a driver's cosine would be too coarse for a narrow one.
    const DERIVED: &'static [Parameter] = &[number("outer_rise"), number("inner_rise")];

    fn derived(&self) -> Vec<f32> {
        cone_edges(self.cone_angle, self.penumbra).to_array().to_vec()
    }

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let to_light = light.position - p;
        let l = to_light.normalize_or_zero();
        let profile = self.profile(light, l);
        Incident::From { l, intensity: Vec3::splat(light.intensity * profile * inverse_square(to_light)) }
    }

    fn factors(&self, light: &LightRecord, p: Vec3) -> Vec<Factor> {
        let to_light = light.position - p;
        let l = to_light.normalize_or_zero();
        // By the chord, since cosines near 1 have too few bits.
        let angle = 2.0 * (0.5 * (l + light.direction).length()).min(1.0).asin();
        vec![
            Factor::intensity(light, Self::DECLARATION.unit),
            Factor::new(
                "cone(θ, θ_c, s)",
                "1 inside the cone, 0 outside, smooth in its soft edge",
                self.profile(light, l),
            )
            .given("θ", angle.to_degrees(), "°")
            .given("θ_c", self.cone_angle, "°")
            .given("s", self.penumbra, "")
            .equation("x^2 (3 − 2 x), x = clamp((cos θ − cos θ_c)/(cos((1 − s) θ_c) − cos θ_c), 0, 1)"),
            Factor::inverse_square(inverse_square(to_light), to_light.length()),
        ]
    }

    fn solid_angle(&self) -> Option<f64> {
        Some(cone_solid_angle(self.cone_angle, self.penumbra))
    }
}
