use glam::{Vec2, Vec3};

use super::{
    Declaration, LightRecord, LightType, Size,
    extent::{self, Cone, SMALLEST, Sample, Seen, VISIBLE},
};
use crate::{
    optics::sampling::{arc_cosine, area_pdf},
    parameter::Parameter,
    parameters,
    shader::wgsl,
};

const LENGTH: Parameter = Parameter::number("length", SMALLEST..=100.0, 2.0)
    .symbol("a")
    .unit("m")
    .help("Its length along its axis.");

const RADIUS: Parameter =
    Parameter::number("radius", SMALLEST..=100.0, 0.05).symbol("r").unit("m").help("Half its diameter.");

parameters! {
    /// **Cylinder**: a fluorescent tube; the same luminance L, cd/m², from every point of its side. The ends are dark.
    /// The luminous flux is `Φ = 2π² r a L` lumen. A point within it gets no light.
    pub struct Cylinder {
        /// The length, metres.
        length: number = LENGTH,
        /// The radius, metres.
        radius: number = RADIUS,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    }
}

/// A cylinder as seen from a point.
struct View {
    /// From the centre to the point.
    to_point: Vec3,
    /// Unit vectors: from the axis to the point, and along the tangent.
    out: Vec3,
    along: Vec3,
    /// Distance of the point from the axis.
    away: f32,
    /// Half the angle of the part of the side that faces the point, in radians, and the area of that part.
    half_angle: f32,
    area: f32,
}

impl Cylinder {
    /// `None` inside the cylinder, extended to infinite length.
    fn from(&self, light: &LightRecord, p: Vec3) -> Option<View> {
        let to_point = p - light.position;
        let across = to_point - to_point.dot(light.direction) * light.direction;
        let away = across.length();
        if away.is_nan() || away <= self.radius {
            return None;
        }
        let out = across / away;
        let half_angle = arc_cosine(self.radius / away);
        let area = 2.0 * half_angle * self.radius * self.length;
        Some(View { to_point, out, along: light.direction.cross(out), away, half_angle, area })
    }
}

impl LightType for Cylinder {
    const DECLARATION: Declaration = Declaration::new(
        "cylinder",
        "Cylinder light",
        wgsl!("light/cylinder.wgsl"),
    )
    .summary(
        "A fluorescent tube: a cylinder whose side is equally bright everywhere, and whose ends are dark.",
    )
    .glyph("▮")
    .at_position()
    .with_direction()
    .luminance(10.0, 100.0)
    .sizes(&[Size::Length(LENGTH.name), Size::Radius(RADIUS.name)])
    .equation("L(p, l) = L");

    fn sample(&self, light: &LightRecord, p: Vec3, u: Vec2) -> Sample {
        let Some(view) = self.from(light, p) else { return Sample::default() };
        let angle = (2.0 * u.x - 1.0) * view.half_angle;
        let normal = view.out * angle.cos() + view.along * angle.sin();
        let at = normal * self.radius + light.direction * ((u.y - 0.5) * self.length) - view.to_point;
        let pdf = area_pdf(at, normal, view.area);
        Sample { l: at.normalize_or_zero(), radiance: Vec3::splat(light.intensity), pdf }
    }

    fn seen(&self, light: &LightRecord, p: Vec3, l: Vec3) -> Seen {
        let Some(view) = self.from(light, p) else { return Seen::NOTHING };
        // In the plane across the axis, from the point at (away, 0).
        let [x, y] = [l.dot(view.out), l.dot(view.along)];
        let squared = x * x + y * y;
        let passes = view.away * y;
        let rest = self.radius * self.radius * squared - passes * passes;
        if rest.is_nan() || rest < 0.0 || x >= 0.0 {
            return Seen::NOTHING;
        }
        // On the side itself the difference is rounded to either sign.
        let distance = ((-view.away * x - rest.sqrt()) / squared).max(0.0);
        let at = l * distance;
        let from_middle = view.to_point + at;
        let along = from_middle.dot(light.direction).abs();
        if along.is_nan() || along > 0.5 * self.length {
            return Seen::NOTHING;
        }
        let normal = (from_middle - from_middle.dot(light.direction) * light.direction) / self.radius;
        Seen { radiance: Vec3::splat(light.intensity), pdf: area_pdf(at, normal, view.area), distance }
    }

    fn bounds(&self, light: &LightRecord, p: Vec3) -> Option<Cone> {
        Cone::of_ball(light.position - p, self.radius.hypot(0.5 * self.length))
    }

    fn solid_angle(&self) -> Option<f64> {
        let area = 2.0 * std::f64::consts::PI * f64::from(self.radius) * f64::from(self.length);
        Some(extent::flux(area, false))
    }
}
