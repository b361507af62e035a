use glam::{Vec2, Vec3};

use super::{
    Declaration, LightRecord, LightType, Size,
    extent::{self, Cone, ROLL, SMALLEST, Sample, Seen, TWO_SIDED, VISIBLE},
};
use crate::{optics::sampling::SphericalRectangle, parameter::Parameter, parameters, shader::wgsl};

const WIDTH: Parameter = Parameter::number("width", SMALLEST..=100.0, 2.0)
    .symbol("w")
    .unit("m")
    .help("The length of its horizontal sides, as long as it is not turned.");

const HEIGHT: Parameter = Parameter::number("height", SMALLEST..=100.0, 1.0)
    .symbol("h")
    .unit("m")
    .help("The length of its other sides, which point up as nearly as its direction allows.");

parameters! {
    /// **Rectangle**: a window, a softbox; the same luminance L, cd/m², from every point of it in every direction to
    /// its front. The luminous flux is `Φ = π w h L` lumen, twice that if both sides shine.
    pub struct Rectangle {
        /// The width, metres.
        width: number = WIDTH,
        /// The height, metres.
        height: number = HEIGHT,
        /// The turn about its direction, degrees.
        roll: number = ROLL,
        /// True if it shines to both sides.
        two_sided: flag = TWO_SIDED,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    } derived {
        /// Sine and cosine of the turn.
        turn: Vec2 = |this: &Self| Vec2::from(this.roll.to_radians().sin_cos()),
    }
}

impl Rectangle {
    fn half(&self) -> Vec2 {
        0.5 * Vec2::new(self.width, self.height)
    }

    /// The rectangle as seen from a point.
    fn from(&self, light: &LightRecord, p: Vec3) -> SphericalRectangle {
        SphericalRectangle::new(light.position - p, extent::sides(light.direction, self.turn), self.half())
    }

    /// A sample of the rectangle in this view.
    fn towards(&self, light: &LightRecord, seen: &SphericalRectangle, u: Vec2) -> Sample {
        let at = seen.sample(u);
        let l = at.normalize_or_zero();
        if !extent::shines(-l.dot(light.direction), self.two_sided) {
            return Sample::default();
        }
        Sample { l, radiance: Vec3::splat(light.intensity), pdf: seen.pdf(at) }
    }
}

impl LightType for Rectangle {
    const DECLARATION: Declaration = Declaration::new(
        "rectangle",
        "Rectangle light",
        wgsl!("light/rectangle.wgsl"),
    )
    .summary("A window or a softbox: a rectangle that is equally bright everywhere and in every direction.")
    .glyph("▭")
    .at_position()
    .with_direction()
    .luminance(10.0, 100.0)
    .sizes(&[Size::Width(WIDTH.name), Size::Height(HEIGHT.name)])
    .roll(ROLL.name)
    .equation("L(p, l) = L");

    const DERIVED: &'static [Parameter] = &[extent::number("roll_sine"), extent::number("roll_cosine")];

    fn derived(&self) -> Vec<f32> {
        self.turn.to_array().to_vec()
    }

    fn sample(&self, light: &LightRecord, p: Vec3, u: Vec2) -> Sample {
        self.towards(light, &self.from(light, p), u)
    }

    fn samples(&self, light: &LightRecord, p: Vec3, points: &[Vec2], to: &mut [Sample]) {
        let seen = self.from(light, p);
        for (to, u) in to.iter_mut().zip(points) {
            *to = self.towards(light, &seen, *u);
        }
    }

    fn seen(&self, light: &LightRecord, p: Vec3, l: Vec3) -> Seen {
        let hit = extent::on_plane(light, p, l, self.two_sided);
        let [x, y] = extent::sides(light.direction, self.turn);
        let within = |beside: Vec3| Vec2::new(beside.dot(x), beside.dot(y)).abs().cmple(self.half()).all();
        let Some((distance, _)) = hit.filter(|(_, beside)| within(*beside)) else { return Seen::NOTHING };
        let pdf = self.from(light, p).pdf(l * distance);
        Seen { radiance: Vec3::splat(light.intensity), pdf, distance }
    }

    fn bounds(&self, light: &LightRecord, p: Vec3) -> Option<Cone> {
        Cone::of_ball(light.position - p, self.half().length())
    }

    /// The sum of `± atan(x y / (h √(x² + y² + h²)))` over the corners, with h the height of the point above the plane.
    fn fills(&self, light: &LightRecord, p: Vec3) -> Option<f64> {
        let middle = (light.position - p).as_dvec3();
        let facing = -middle.dot(light.direction.as_dvec3());
        if !extent::shines(facing as f32, self.two_sided) {
            return Some(0.0);
        }
        let height = facing.abs();
        let [x, y] = extent::sides(light.direction, self.turn).map(|side| middle.dot(side.as_dvec3()));
        let half = self.half().as_dvec2();
        let part = |x: f64, y: f64| (x * y).atan2(height * (x * x + y * y + height * height).sqrt());
        let [left, right, low, high] = [x - half.x, x + half.x, y - half.y, y + half.y];
        Some(part(right, high) - part(left, high) - part(right, low) + part(left, low))
    }

    fn solid_angle(&self) -> Option<f64> {
        Some(extent::flux(f64::from(self.width) * f64::from(self.height), self.two_sided))
    }
}
