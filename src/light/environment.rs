use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    Declaration, LightRecord, LightType,
    extent::{Sample, Seen, VISIBLE, number},
    panorama::{self, Panorama},
    sky::{self, Sky},
    studio,
};
use crate::{
    optics::{radiometry::SPHERE, sampling},
    parameter::Parameter,
    parameters,
    shader::wgsl,
};

const SOURCE: Parameter = Parameter::choice(
    "source",
    &[("uniform", "uniform"), ("studio", "studio"), ("sky", "sky"), ("file", "file")],
    1,
)
.help(
    "Uniform: the same luminance from everywhere. Studio: three softboxes in a dark room. Sky: the CIE general sky. File: a picture \
     of surroundings.",
);

const UNIFORM: u32 = 0;
const STUDIO: u32 = 1;
const SKY: u32 = 2;
const FILE: u32 = 3;

const PATH: Parameter = Parameter::file("path", &panorama::FORMAT, "room.hdr")
    .label("picture file")
    .help(
        "A picture of surroundings, twice as wide as it is high, in Radiance's .hdr or OpenEXR's .exr, by its name from the folder of \
         the scene. Its values are cd/m². −z is in its middle.",
    )
    .used_when("source", &["file"]);

const ROTATION: Parameter = Parameter::number("rotation", -360.0..=360.0, 0.0)
    .symbol("ψ")
    .unit("°")
    .help("Turns it about the vertical, anticlockwise as seen from above.")
    .used_when("source", &["studio", "sky", "file"]);

const SKY_TYPE: Parameter = Parameter::choice("sky_type", &sky::TYPES, 11)
    .label("type of sky")
    .help("One of the fifteen types of CIE S 011 / ISO 15469, from overcast to clear and turbid.")
    .used_when("source", &["sky"]);

const SUN_ELEVATION: Parameter = Parameter::number("sun_elevation", 0.0..=90.0, 35.0)
    .symbol("γ_s")
    .label("sun's elevation")
    .unit("°")
    .help("The height of the sun above the horizon. The sun itself is another light; the sky is brighter around it.")
    .used_when("sky_type", &sky::BRIGHTER_AT_SUN);

const SUN_AZIMUTH: Parameter = Parameter::number("sun_azimuth", -360.0..=360.0, 140.0)
    .symbol("α_s")
    .label("sun's azimuth")
    .unit("°")
    .help("The direction of the sun, clockwise from −z as seen from above: 90° is +x.")
    .used_when("sky_type", &sky::BRIGHTER_AT_SUN);

const ZENITH_LUMINANCE: Parameter = Parameter::number("zenith_luminance", 0.0..=20_000.0, 0.1)
    .slider_to(1.0)
    .symbol("L_z")
    .label("zenith luminance")
    .unit("cd/m²")
    .help("The luminance of the sky straight above; the luminance of the rest follows from the type.")
    .used_when("source", &["sky"]);

const GROUND_REFLECTANCE: Parameter = Parameter::number("ground_reflectance", 0.0..=1.0, 0.2)
    .symbol("ρ_g")
    .label("ground reflectance")
    .help("The part of the skylight that the ground scatters back, evenly.")
    .used_when("source", &["sky"]);

parameters! {
    /// **Environment**: light from all around, infinitely far away; its intensity is a factor of the luminance of its source
    /// (uniform: 1 cd/m²).
    pub struct Environment {
        /// Index of the source.
        source: choice = SOURCE,
        /// The picture.
        path: file = PATH,
        /// The turn about the vertical, degrees.
        rotation: number = ROTATION,
        /// Index of the type of the sky.
        sky_type: choice = SKY_TYPE,
        /// The height of the sun above the horizon, degrees.
        sun_elevation: number = SUN_ELEVATION,
        /// The direction of the sun, degrees.
        sun_azimuth: number = SUN_AZIMUTH,
        /// The luminance of the zenith, cd/m².
        zenith_luminance: number = ZENITH_LUMINANCE,
        /// The reflectance of the ground.
        ground_reflectance: number = GROUND_REFLECTANCE,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    } derived {
        /// Sine and cosine of the turn.
        turn: Vec2 = |this: &Self| Vec2::from(this.rotation.to_radians().sin_cos()),
        /// The sky, if it is the source.
        sky: Sky = |this: &Self| match this.source {
            SKY => Sky::new(
                this.sky_type as usize,
                [this.sun_elevation, this.sun_azimuth],
                this.zenith_luminance,
                this.ground_reflectance,
            ),
            _ => Sky::default(),
        },
    }
}

impl Environment {
    /// A direction in the room, rotated back into the environment.
    #[inline]
    fn turned_back(&self, d: Vec3) -> Vec3 {
        let [sine, cosine] = self.turn.to_array();
        Vec3::new(d.x * cosine - d.z * sine, d.y, d.x * sine + d.z * cosine)
    }

    /// A direction in the environment, rotated into the room.
    fn turned(&self, d: Vec3) -> Vec3 {
        let [sine, cosine] = self.turn.to_array();
        Vec3::new(d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine)
    }

    /// The luminance from a direction, and its sampling density.
    #[inline]
    fn at(&self, d: Vec3) -> (Vec3, f32) {
        let (luminance, pdf) = match (self.source, self.picture()) {
            (STUDIO, _) => studio::seen(d),
            (SKY, _) => self.sky.seen(d),
            (FILE, Some(picture)) => return picture.seen(d),
            _ => (1.0, 1.0 / (4.0 * PI)),
        };
        (Vec3::splat(luminance), pdf)
    }

    /// The picture, if it is the source.
    fn picture(&self) -> Option<Panorama<'_>> {
        (self.source == FILE).then(|| Panorama::new(&self.path.numbers))?
    }
}

impl LightType for Environment {
    const DECLARATION: Declaration =
        Declaration::new("environment", "Environment", wgsl!("light/environment.wgsl"))
            .summary("Light from all around: the same everywhere, a studio, a sky, or a picture.")
            .glyph("◎")
            .factor(1.0, 10.0)
            .with_extent()
            .equation("L(p, l) = I L_s(l)");

    const DERIVED: &'static [Parameter] = &[
        number("turn_sine"),
        number("turn_cosine"),
        number("sky_a"),
        number("sky_b"),
        number("sky_c"),
        number("sky_d"),
        number("sky_e"),
        number("sun_x"),
        number("sun_y"),
        number("sun_z"),
        number("sky_scale"),
        number("ground"),
    ];

    fn derived(&self) -> Vec<f32> {
        let mut all = self.turn.to_array().to_vec();
        all.extend(self.sky.coefficients);
        all.extend(self.sky.sun.to_array());
        all.extend([self.sky.scale, self.sky.ground]);
        all
    }

    fn unit(&self) -> &'static str {
        if self.source == UNIFORM { "cd/m²" } else { Self::DECLARATION.unit }
    }

    fn sample(&self, light: &LightRecord, _p: Vec3, u: Vec2) -> Sample {
        let at = |d| {
            let (luminance, pdf) = self.at(d);
            (d, luminance, pdf)
        };
        let (d, luminance, pdf) = match (self.source, self.picture()) {
            (STUDIO, _) => at(studio::sample(u)),
            (SKY, _) => at(self.sky.sample(u)),
            (FILE, Some(picture)) => picture.sample(u),
            _ => at(sampling::sphere(u)),
        };
        Sample { l: self.turned(d), radiance: light.intensity * luminance, pdf }
    }

    #[inline]
    fn seen(&self, light: &LightRecord, _p: Vec3, l: Vec3) -> Seen {
        let (luminance, pdf) = self.at(self.turned_back(l));
        Seen { radiance: light.intensity * luminance, pdf, distance: f32::INFINITY }
    }

    fn fills(&self, _light: &LightRecord, _p: Vec3) -> Option<f64> {
        Some(SPHERE)
    }

    fn same_between(&self, light: &LightRecord, corners: &[Vec3; 4]) -> Option<Vec3> {
        let luminance = match self.source {
            UNIFORM => Some(1.0),
            STUDIO => studio::same_between(&corners.map(|corner| self.turned_back(corner))),
            _ => None,
        };
        luminance.map(|luminance| light.intensity * Vec3::splat(luminance))
    }
}
