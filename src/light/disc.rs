use glam::{Vec2, Vec3};

use super::{
    Declaration, LightRecord, LightType, Size,
    extent::{self, Cone, SMALLEST, Sample, Seen, TWO_SIDED, UNTURNED, VISIBLE},
};
use crate::{
    optics::sampling::{area_pdf, disc},
    parameter::Parameter,
    parameters,
    shader::wgsl,
};

pub(super) const RADIUS: Parameter =
    Parameter::number("radius", SMALLEST..=100.0, 0.5).symbol("r").unit("m").help("Half its diameter.");

parameters! {
    /// **Disc**: a round lamp; the same luminance L, cd/m², from every point of it in every direction to its front. The
    /// luminous flux is `Φ = π² r² L` lumen, twice that if both sides shine.
    pub struct Disc {
        /// The radius, metres.
        radius: number = RADIUS,
        /// True if it shines to both sides.
        two_sided: flag = TWO_SIDED,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    }
}

impl Disc {
    fn area(&self) -> f32 {
        std::f32::consts::PI * self.radius * self.radius
    }
}

impl LightType for Disc {
    const DECLARATION: Declaration = Declaration::new("disc", "Disc light", wgsl!("light/disc.wgsl"))
        .summary("A round lamp: a disc that is equally bright everywhere and in every direction.")
        .glyph("◐")
        .at_position()
        .with_direction()
        .luminance(10.0, 100.0)
        .sizes(&[Size::Radius(RADIUS.name)])
        .equation("L(p, l) = L");

    fn sample(&self, light: &LightRecord, p: Vec3, u: Vec2) -> Sample {
        let [x, y] = extent::sides(light.direction, UNTURNED);
        let on = disc(u) * self.radius;
        let at = light.position + x * on.x + y * on.y - p;
        let l = at.normalize_or_zero();
        if !extent::shines(-l.dot(light.direction), self.two_sided) {
            return Sample::default();
        }
        let pdf = area_pdf(at, light.direction, self.area());
        Sample { l, radiance: Vec3::splat(light.intensity), pdf }
    }

    fn seen(&self, light: &LightRecord, p: Vec3, l: Vec3) -> Seen {
        let hit = extent::on_plane(light, p, l, self.two_sided);
        let within = |beside: Vec3| beside.length_squared() <= self.radius * self.radius;
        let Some((distance, _)) = hit.filter(|(_, beside)| within(*beside)) else { return Seen::NOTHING };
        let pdf = area_pdf(l * distance, light.direction, self.area());
        Seen { radiance: Vec3::splat(light.intensity), pdf, distance }
    }

    fn bounds(&self, light: &LightRecord, p: Vec3) -> Option<Cone> {
        Cone::of_ball(light.position - p, self.radius)
    }

    fn solid_angle(&self) -> Option<f64> {
        let radius = f64::from(self.radius);
        Some(extent::flux(std::f64::consts::PI * radius * radius, self.two_sided))
    }
}
