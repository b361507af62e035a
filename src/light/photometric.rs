use glam::Vec3;

use super::{
    Declaration, Factor, Incident, LightRecord, LightType,
    ies::{self, Web},
};
use crate::{optics::radiometry::inverse_square, parameter::Parameter, parameters, shader::wgsl};

const FILE: Parameter = Parameter::file("file", &ies::FORMAT, "wall_washer.ies")
    .symbol("w")
    .label("photometric file")
    .help("The IES file that says how many candelas the lamp sends into each direction, as its maker measured it; \
           relative to the folder of the scene.");

const ROTATION: Parameter = Parameter::number("rotation", -360.0..=360.0, 0.0)
    .symbol("ψ")
    .unit("°")
    .help("Turns the lamp about its axis, anticlockwise as seen from behind the lamp.");

parameters! {
    /// **Photometric lamp**: shines as measured by its maker; `I(p) = I w(γ, C) / |p − p₀|²`. `w` is the distribution
    /// in an IES file ([`FORMAT`](ies::FORMAT)): its candelas × its multiplier × its ballast factors, interpolated
    /// linearly in both angles. `I` has no unit: 1 is the lamp of the file, 0.5 is the lamp dimmed to half. The
    /// luminous flux is `Φ = I ∫ w dω` lumen.
    ///
    /// The direction of the light is the axis `γ = 0`. The half plane `C = 0` of a lamp that points down looks along x;
    /// seen from above, `C` grows anticlockwise. A lamp that points elsewhere is tilted by the shortest turn.
    pub struct Photometric {
        /// The distribution.
        file: file = FILE,
        /// The turn about the axis, degrees.
        rotation: number = ROTATION,
    }
}

impl Photometric {
    /// The angles γ and C of a direction from a lamp with this axis, in degrees.
    fn angles(&self, axis: Vec3, d: Vec3) -> (f32, f32) {
        let zero = if axis.y < 0.999999 {
            let tilt = axis.z / (1.0 - axis.y);
            Vec3::new(-axis.y + axis.z * tilt, axis.x, -axis.x * tilt)
        } else {
            Vec3::X
        };
        let (x, y) = (d.dot(zero), d.dot(zero.cross(axis)));
        let gamma = x.hypot(y).atan2(d.dot(axis)).to_degrees();
        let c = y.atan2(x).to_degrees() - self.rotation;
        (gamma.clamp(0.0, 180.0), c.rem_euclid(360.0).clamp(0.0, 360.0))
    }

    /// The candelas of the file in the direction of a point, and the angles γ and C of that direction.
    fn candela(&self, light: &LightRecord, l: Vec3) -> (f32, [f32; 2]) {
        let (gamma, c) = self.angles(light.direction, -l);
        (Web::new(&self.file.numbers).map_or(0.0, |web| web.candela(gamma, c)), [gamma, c])
    }
}

impl LightType for Photometric {
    const DECLARATION: Declaration =
        Declaration::new("photometric", "Photometric lamp", wgsl!("light/photometric.wgsl"))
            .summary(
                "Shines as its maker measured it, by an IES file; falls off with the square of the distance.",
            )
            .glyph("◭")
            .at_position()
            .with_direction()
            .factor(1.0, 10.0)
            .equation("I(p) = I w / d^2");

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let to_light = light.position - p;
        let l = to_light.normalize_or_zero();
        let (candela, _) = self.candela(light, l);
        Incident::From { l, intensity: Vec3::splat(light.intensity * candela * inverse_square(to_light)) }
    }

    fn factors(&self, light: &LightRecord, p: Vec3) -> Vec<Factor> {
        let to_light = light.position - p;
        let (candela, [gamma, c]) = self.candela(light, to_light.normalize_or_zero());
        vec![
            Factor::intensity(light, Self::DECLARATION.unit),
            Factor::new("w", "the distribution in the photometric file, in this direction", candela)
                .unit("cd")
                .given("γ", gamma, "°")
                .given("C", c, "°"),
            Factor::inverse_square(inverse_square(to_light), to_light.length()),
        ]
    }

    fn solid_angle(&self) -> Option<f64> {
        Some(Web::new(&self.file.numbers).map_or(0.0, |web| web.flux()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::colour::Encoding,
        parameter::{ParameterSet as _, Value, Values},
    };

    /// By hand: for a lamp at (5, 9, 5), a point 4 m below and 4 m to the side is at `γ = 45°` and `d² = 32
    /// m²`.
    #[test]
    fn a_point_gets_the_candelas_of_its_direction_over_the_squared_distance() {
        let values = Values([("rotation".into(), Value::Number(0.0))].into());
        let lamp = Photometric::from_values(&values, Encoding::Srgb);
        let web = Web::new(&lamp.file.numbers).expect("the shipped file");
        let at = |lamp: &Photometric, axis: Vec3, d: Vec3| {
            let light = LightRecord {
                position: Vec3::new(5.0, 9.0, 5.0),
                direction: axis.normalize(),
                intensity: 2.0,
                ..LightRecord::default()
            };
            match lamp.incident(&light, light.position + d) {
                Incident::From { l, intensity } => {
                    assert!((l + d.normalize()).length() < 1e-6);
                    assert!(intensity.x == intensity.y && intensity.y == intensity.z);
                    intensity.x
                }
                Incident::Uniform { .. } => panic!("it has a place"),
            }
        };
        let near = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-4;
        let down = Vec3::NEG_Y;
        // In the shipped file, 1232.9 cd at γ = 45°, C = 0; 120.8 cd at C = 90°.
        let [along_x, along_minus_z] = [Vec3::new(4.0, -4.0, 0.0), Vec3::new(0.0, -4.0, -4.0)];
        assert!(near(at(&lamp, down, along_x), 2.0 * 1232.9 / 32.0));
        assert!(near(at(&lamp, down, along_minus_z), 2.0 * 120.8 / 32.0));
        // Rotated by 90° anticlockwise as seen from above, C = 0 looks along −z. Clockwise would be the wrong
        // twin: C would be 180°, 113.2 cd.
        let turned = Photometric { rotation: 90.0, ..lamp.clone() };
        assert!(near(at(&turned, down, along_minus_z), 2.0 * 1232.9 / 32.0));
        assert!(near(at(&turned, down, Vec3::new(0.0, -4.0, 4.0)), 2.0 * 113.2 / 32.0));
        // Tilted to look along x, C = 0 looks up, and C = 90° still along −z.
        assert!(near(at(&lamp, Vec3::X, Vec3::new(4.0, 4.0, 0.0)), 2.0 * 1232.9 / 32.0));
        assert!(near(at(&lamp, Vec3::X, Vec3::new(4.0, 0.0, -4.0)), 2.0 * 120.8 / 32.0));
        // It is dark above the lamp; angles exist straight above too.
        assert_eq!(at(&lamp, down, Vec3::new(1.0, 1.0, 0.0)), 0.0);
        assert!(near(at(&lamp, Vec3::Y, Vec3::new(0.0, 4.0, 0.0)), 2.0 * web.candela(0.0, 0.0) / 16.0));
        // Every axis has an orthogonal frame.
        for axis in [Vec3::new(0.3, 0.8, -0.5), Vec3::new(1e-3, 1.0, 0.0), Vec3::new(-0.4, -0.1, 0.9)] {
            let axis = axis.normalize();
            let (gamma, _) = lamp.angles(axis, axis);
            assert!(gamma < 0.1, "{axis}: {gamma}");
            let across = axis.any_orthonormal_vector();
            assert!((lamp.angles(axis, across).0 - 90.0).abs() < 1e-3, "{axis}");
            let [a, b] = [across, axis.cross(across)].map(|d| lamp.angles(axis, d).1);
            assert!(((a - b).rem_euclid(360.0) - 90.0).abs() < 0.1, "{axis}: {a} {b}");
        }
    }

    #[test]
    fn the_file_survives_the_way_through_the_struct() {
        let lamp = Photometric { rotation: 30.0, ..Photometric::default() };
        let values = lamp.to_values(Encoding::Srgb);
        assert_eq!(values.get(&FILE), FILE.default_value());
        assert_eq!(Photometric::from_values(&values, Encoding::Srgb), lamp);
        assert_ne!(Photometric { file: Default::default(), ..lamp.clone() }, lamp);
    }

    #[test]
    fn the_luminous_flux_is_that_of_the_file() {
        let lamp = Photometric::default();
        let sum = |weight: fn(f32) -> f64| {
            // The sum over squares of half a degree, independent of the closed form.
            let web = Web::new(&lamp.file.numbers).expect("the shipped file");
            let mut sum = 0.0;
            for i in 0..360 {
                for j in 0..720 {
                    let (gamma, c) = (0.5 * i as f32 + 0.25, 0.5 * j as f32 + 0.25);
                    sum += f64::from(web.candela(gamma, c)) * weight(gamma);
                }
            }
            sum * 0.5_f64.to_radians().powi(2)
        };
        let right = sum(|gamma| f64::from(gamma).to_radians().sin());
        let flux = lamp.solid_angle().expect("it has one");
        assert!((flux / right - 1.0).abs() < 1e-4, "{flux} {right}");
        // The wrong twin: squares near the axis count as much as those at the side.
        let wrong = sum(|_| 1.0);
        assert!((flux / wrong - 1.0).abs() > 0.1, "{flux} {wrong}");
    }
}
