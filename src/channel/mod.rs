//! Debug channels: the values that lead to the colour of a pixel, drawn as colours instead of the picture.
//!
//! A channel belongs to a view, not to the scene. It is drawn without exposure and tone mapping, so that its legend
//! is valid; only [`DebugChannel::Light`] is a picture like any other, under one light. The shaders have the channels in
//! `assets/shaders/channels.wgsl`, the CPU renderer in `src/reference/channel.rs`.
//!
//! ```
//! use lights_camera_models::{
//!     channel::{DebugChannel, Setting},
//!     reference::{Settings, render_channel},
//!     registry::Registry,
//!     scene::Scene,
//! };
//! let (scene, registry) = (Scene::default(), Registry::builtin());
//! let setting = Setting::new(DebugChannel::NDotL, &scene, &registry, scene.observer.position, None);
//! let settings = Settings { width: 64, height: 36, ..Settings::default() };
//! assert_eq!(render_channel(&scene, &registry, &settings, &setting).len(), 64 * 36 * 3);
//! assert!(setting.legend(&scene, &registry).title.starts_with("N·L"));
//! ```

use glam::Vec3;

use crate::{
    light::{Emitter, Incident, LightRecord},
    optics::{colour::luminance, sequence::Sequence},
    registry::Registry,
    scene::{Light, Scene, emitter},
};

pub mod colours;

mod legend;

pub use legend::Legend;

/// A debug channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DebugChannel {
    /// The vertex normals, interpolated.
    Normals,
    /// The normals of the triangles.
    FaceNormals,
    /// The normals of the vertices, as lines.
    VertexNormals,
    /// The edges of the polygons.
    Wireframe,
    /// The vertices, as dots.
    Vertices,
    /// The cosine between normal and light.
    NDotL,
    /// The cosine between normal and observer.
    NDotV,
    /// The cosine between normal and half vector.
    NDotH,
    /// The side of the interpolated normal on which the observer is.
    Facing,
    /// The distance from the eye.
    Depth,
    /// The luminance before exposure.
    Luminance,
    /// The pixels that the display cuts off.
    Clipped,
    /// Light that is not a number, infinite or below 0.
    NotANumber,
    /// The picture under one light.
    Light,
}

impl DebugChannel {
    /// Every channel, in the order of presentation.
    pub const ALL: [Self; 14] = [
        Self::Normals,
        Self::FaceNormals,
        Self::VertexNormals,
        Self::Wireframe,
        Self::Vertices,
        Self::NDotL,
        Self::NDotV,
        Self::NDotH,
        Self::Facing,
        Self::Depth,
        Self::Luminance,
        Self::Clipped,
        Self::NotANumber,
        Self::Light,
    ];

    /// The name on the command line.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::Normals => "normals",
            Self::FaceNormals => "face_normals",
            Self::VertexNormals => "vertex_normals",
            Self::Wireframe => "wireframe",
            Self::Vertices => "vertices",
            Self::NDotL => "n_dot_l",
            Self::NDotV => "n_dot_v",
            Self::NDotH => "n_dot_h",
            Self::Facing => "facing",
            Self::Depth => "depth",
            Self::Luminance => "luminance",
            Self::Clipped => "clipped",
            Self::NotANumber => "not_a_number",
            Self::Light => "one_light",
        }
    }

    /// The display name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normals => "Interpolated normals",
            Self::FaceNormals => "Face normals",
            Self::VertexNormals => "Vertex normals",
            Self::Wireframe => "Wireframe",
            Self::Vertices => "Vertices",
            Self::NDotL => "N·L",
            Self::NDotV => "N·V",
            Self::NDotH => "N·H",
            Self::Facing => "Facing",
            Self::Depth => "Depth",
            Self::Luminance => "Luminance",
            Self::Clipped => "Clipped pixels",
            Self::NotANumber => "Not a number",
            Self::Light => "One light alone",
        }
    }

    /// The values of the channel, and what to look for.
    #[must_use]
    pub const fn explanation(self) -> &'static str {
        match self {
            Self::Normals => {
                "The unit normals of the vertices, interpolated across each triangle and renormalised: (1 + N)/2 as \
                 display codes. Phong shading calculates with them. Where they change smoothly, so does the shading, \
                 whatever the triangles are."
            }
            Self::FaceNormals => {
                "The normal of the triangle in each pixel: (1 + N)/2 as display codes. Derivative shading calculates \
                 with it, flat shading with that of the whole polygon. The true shape of the mesh shows."
            }
            Self::VertexNormals => {
                "A line at each visible vertex along its normal, which is the mean of those of its polygons or comes \
                 from the file of the mesh; its colour is (1 + N)/2 as display codes. The surface is dim and grey. \
                 Where the lines stand askew on the polygons, smooth shading and true shape differ."
            }
            Self::Wireframe => {
                "The visible edges of the polygons over the dim grey surface; the diagonals along which quadrangles \
                 are cut into triangles are left out. The tessellation shows, and with it where Gouraud shading can \
                 miss a highlight."
            }
            Self::Vertices => {
                "A dot at each visible vertex over the dim grey surface: with Gouraud shading in the colour that is \
                 calculated there, between which the picture interpolates; otherwise in that of its normal, \
                 (1 + N)/2 as display codes."
            }
            Self::NDotL => {
                "The cosine of the angle between the interpolated normal and the direction to the light, pixel by \
                 pixel, whatever the shading model: the factor of Lambert’s law. Below 0 the light is behind the surface."
            }
            Self::NDotV => {
                "The cosine of the angle between the interpolated normal and the direction to the observer. It is 1 \
                 where the surface is seen head-on and 0 at the silhouette, where Fresnel reflectance is highest."
            }
            Self::NDotH => {
                "The cosine of the angle between the interpolated normal and the half vector, which is midway between \
                 light and observer. Highlights of Blinn–Phong and of microfacet models are where it is nearly 1."
            }
            Self::Facing => {
                "Every triangle in the picture faces the observer, but an interpolated normal need not: where it \
                 looks away, the light loop mirrors the observer in the surface. Brighter is more direct."
            }
            Self::Depth => {
                "The straight distance from the eye to the surface. The scale reaches from the nearest to the \
                 farthest object of the scene, apart from those around the eye, such as a floor; what is nearer or \
                 farther has the colour of the end."
            }
            Self::Luminance => {
                "Y = 0.2126 R + 0.7152 G + 0.0722 B of the light that leaves the surface, before exposure and tone \
                 mapping, on a logarithmic scale of four decades. 1 is white at 0 EV."
            }
            Self::Clipped => {
                "Stripes where red, green or blue is above 1 after exposure: the display cuts that off. Tone mapping, \
                 which this channel leaves out, may bring it back."
            }
            Self::NotANumber => {
                "Light that is no light: not a number (0/0, the root of a negative number), infinite (1/0) or below \
                 0. The picture hides what it cannot show; here nothing is hidden. All else is dim and grey."
            }
            Self::Light => {
                "The picture as if only this light shone: the light that is selected, otherwise the one that is \
                 brightest at the objects. The picture is the sum of such pictures, before tone mapping."
            }
        }
    }

    /// The channel with this id.
    #[must_use]
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.id() == id)
    }

    /// The number in shaders (`CHANNEL_…` in `channels.wgsl`); 0 draws the picture. Lines and dots are drawn
    /// over the dim grey surface of [`NotANumber`](Self::NotANumber).
    #[must_use]
    pub const fn code(self) -> u32 {
        match self {
            Self::Light => 0,
            Self::Luminance => 1,
            Self::Clipped => 2,
            Self::NotANumber | Self::VertexNormals | Self::Wireframe | Self::Vertices => 3,
            Self::FaceNormals => 4,
            Self::Normals => 5,
            Self::NDotL => 6,
            Self::NDotV => 7,
            Self::NDotH => 8,
            Self::Facing => 9,
            Self::Depth => 10,
        }
    }

    /// True if the channel is a picture like any other, with exposure and tone mapping.
    #[must_use]
    pub const fn is_picture(self) -> bool {
        matches!(self, Self::Light)
    }

    /// True if the channel shows the light that leaves the surface, not geometry; lines and dots are drawn
    /// over such a picture.
    #[must_use]
    pub const fn is_of_light(self) -> bool {
        matches!(self, Self::Light | Self::Luminance | Self::Clipped | Self::NotANumber) || self.has_wires()
    }

    /// True if lines or dots of the meshes are drawn over the channel's picture.
    #[must_use]
    pub const fn has_wires(self) -> bool {
        matches!(self, Self::VertexNormals | Self::Wireframe | Self::Vertices)
    }

    /// True if the channel is about one light.
    #[must_use]
    pub const fn has_light(self) -> bool {
        matches!(self, Self::Light | Self::NDotL | Self::NDotH)
    }

    /// The next channel after this one, or after `None`: cycles through all channels, then `None`.
    #[must_use]
    pub fn next(channel: Option<Self>) -> Option<Self> {
        let at = channel.and_then(|channel| Self::ALL.iter().position(|c| *c == channel));
        Self::ALL.get(at.map_or(0, |at| at + 1)).copied()
    }
}

/// A channel with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The channel.
    pub channel: DebugChannel,
    /// The channel's light, as an index among the active lights; `None` if there is no suitable one.
    pub light: Option<usize>,
    /// The values at the ends of the scale; for depth in metres.
    pub range: [f32; 2],
    /// True if the light shines from its position, false if along its direction.
    pub from_position: bool,
}

impl Setting {
    /// A channel of a scene seen from an eye. It refers to the `chosen` light of the scene if that is active
    /// and has a direction where one is needed; otherwise to the light that is brightest at the objects.
    #[must_use]
    pub fn new(
        channel: DebugChannel,
        scene: &Scene,
        registry: &Registry,
        eye: Vec3,
        chosen: Option<usize>,
    ) -> Self {
        let light = channel.has_light().then(|| light(channel, scene, registry, chosen)).flatten();
        let range = if channel == DebugChannel::Depth { depths(scene, registry, eye) } else { [0.0, 1.0] };
        let mut shining = scene.lights.iter().filter(|light| light.enabled);
        let shown = light.and_then(|place| shining.nth(place));
        let declared = shown.and_then(|light| registry.light(&light.light_type));
        Self { channel, light, range, from_position: declared.is_some_and(|l| l.declaration.has_position) }
    }

    /// True if the light with this index among the active ones takes part in the picture.
    #[must_use]
    pub fn shines(&self, light: usize) -> bool {
        !self.channel.is_picture() || self.light.is_none_or(|alone| alone == light)
    }

    /// The scene with the lights that take part in the picture.
    #[must_use]
    pub fn lit(&self, scene: &Scene) -> Scene {
        let mut lit = scene.clone();
        for (place, light) in lit.lights.iter_mut().filter(|light| light.enabled).enumerate() {
            light.enabled = self.shines(place);
        }
        lit
    }
}

/// See [`Setting::new`].
fn light(channel: DebugChannel, scene: &Scene, registry: &Registry, chosen: Option<usize>) -> Option<usize> {
    let (sum, count) =
        scene.shown().fold((Vec3::ZERO, 0.0), |(sum, n), object| (sum + object.position, n + 1.0));
    let middle = sum / f32::max(count, 1.0);
    let encoding = scene.display.encoding;
    // The luminance of what arrives there, if it counts.
    let arriving = |light: &Light| {
        let (entry, emitter, record) = emitter(light, registry, encoding)?;
        if entry.declaration.extent {
            // It has no single direction.
            return channel
                .is_picture()
                .then(|| luminance(from_all(&*emitter, &record, middle) * record.colour));
        }
        let intensity = match emitter.incident(&record, middle) {
            Incident::From { intensity, .. } => intensity,
            Incident::Uniform { intensity } if channel.is_picture() => intensity,
            Incident::Uniform { .. } => return None,
        };
        Some(luminance(intensity * record.colour))
    };
    let shining = scene.lights.iter().enumerate().filter(|(_, light)| light.enabled);
    let known: Vec<_> = shining
        .enumerate()
        .filter_map(|(place, (index, light))| Some((place, index, arriving(light)?)))
        .collect();
    let brightest = || known.iter().max_by(|a, b| a.2.total_cmp(&b.2));
    known.iter().find(|(_, index, _)| Some(*index) == chosen).or_else(brightest).map(|(place, ..)| *place)
}

/// The radiance of a light with extent, summed over the directions from a point.
fn from_all(emitter: &dyn Emitter, record: &LightRecord, p: Vec3) -> Vec3 {
    /// The number of samples, enough to compare brightness.
    const SAMPLES: u32 = 64;
    let sequence = Sequence::new(0, 0);
    let sum = (0..SAMPLES).map(|i| emitter.sample(record, p, sequence.point(i)));
    let sum: Vec3 = sum.filter(|sample| sample.pdf > 0.0).map(|sample| sample.radiance / sample.pdf).sum();
    sum / SAMPLES as f32
}

/// A number rounded by a function to its two leading digits.
fn two_digits(x: f32, round: fn(f64) -> f64) -> f32 {
    if x <= 0.0 || !x.is_finite() {
        return 0.0;
    }
    let x = f64::from(x);
    let digits = 1 - x.log10().floor() as i32;
    (round(x * 10f64.powi(digits)) / 10f64.powi(digits)) as f32
}

/// The distances from the eye between which the objects are, rounded outwards so that a moving eye changes them rarely.
/// Objects that reach around the eye, such as a floor, count only if there are no others: they would leave those no colours.
fn depths(scene: &Scene, registry: &Registry, eye: Vec3) -> [f32; 2] {
    let apart = |[low, high]: [f32; 2], [near, far]: [f32; 2]| [low.min(near), high.max(far)];
    let (mut before, mut around) = ([f32::INFINITY, 0.0], [f32::INFINITY, 0.0]);
    for object in scene.shown() {
        let Some(shape) = registry.shape(&object.object_type) else { continue };
        let radius = shape.bounds(&object.shape).radius * object.size;
        let distance = eye.distance(object.position);
        let reach = [distance - radius, distance + radius];
        let of = if reach[0] > 0.0 { &mut before } else { &mut around };
        *of = apart(*of, reach);
    }
    let [near, far] = if before[1] > 0.0 { before } else { around };
    let (near, far) = (two_digits(near, f64::floor), two_digits(far, f64::ceil));
    if near < far { [near, far] } else { [0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;

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

    fn lights(types: &[(&str, f32)]) -> Scene {
        let light = |(id, intensity): &(&str, f32)| Light {
            light_type: (*id).to_owned(),
            position: Some(Vec3::new(0.0, 3.0, 0.0)),
            direction: Some(Vec3::NEG_Y),
            intensity: *intensity,
            ..Light::default()
        };
        let objects = vec![Object { position: Vec3::ZERO, ..Object::default() }];
        Scene { lights: types.iter().map(light).collect(), objects, ..Scene::default() }
    }

    #[test]
    fn the_light_is_the_chosen_one_or_the_brightest_that_fits() {
        let mut scene = lights(&[("ambient", 50.0), ("point", 1.0), ("point", 9.0), ("directional", 0.01)]);
        let registry = Registry::builtin();
        let light =
            |scene: &Scene, channel, chosen| Setting::new(channel, scene, &registry, Vec3::Z, chosen).light;
        assert_eq!(light(&scene, DebugChannel::NDotL, None), Some(2));
        assert_eq!(light(&scene, DebugChannel::NDotL, Some(1)), Some(1));
        assert_eq!(light(&scene, DebugChannel::NDotL, Some(0)), Some(2), "it has no direction");
        assert_eq!(light(&scene, DebugChannel::Light, Some(0)), Some(0));
        assert_eq!(light(&scene, DebugChannel::Light, None), Some(0), "it is brightest");
        assert_eq!(light(&scene, DebugChannel::NDotV, Some(1)), None, "it is about none");
        scene.lights[0].enabled = false;
        assert_eq!(light(&scene, DebugChannel::NDotL, Some(2)), Some(1), "places are of those that shine");
        assert_eq!(light(&scene, DebugChannel::NDotL, Some(0)), Some(1), "switched off");
        assert_eq!(light(&lights(&[("ambient", 1.0)]), DebugChannel::NDotL, None), None);
        let alone = Setting::new(DebugChannel::Light, &scene, &registry, Vec3::Z, Some(3)).lit(&scene);
        assert_eq!(alone.lights.iter().map(|l| l.enabled).collect::<Vec<_>>(), [false, false, false, true]);
    }

    #[test]
    fn a_light_with_extent_has_no_one_direction_but_a_picture_of_its_own() {
        let registry = Registry::builtin();
        let light =
            |scene: &Scene, channel, chosen| Setting::new(channel, scene, &registry, Vec3::Z, chosen).light;
        // 100 cd/m² of a square metre, 3 m above: 11 lx.
        let scene = lights(&[("point", 1.0), ("rectangle", 100.0), ("point", 9.0)]);
        assert_eq!(light(&scene, DebugChannel::NDotL, Some(1)), Some(2), "the brightest with a direction");
        assert_eq!(light(&scene, DebugChannel::Light, None), Some(1), "it is brightest");
        assert_eq!(light(&lights(&[("rectangle", 100.0)]), DebugChannel::NDotH, None), None);
        let scene = lights(&[("rectangle", 1.0), ("point", 9.0)]);
        assert_eq!(light(&scene, DebugChannel::Light, None), Some(1), "0.1 lx against 1");
    }

    #[test]
    fn the_scale_of_depths_holds_all_objects_in_two_digits() {
        assert_eq!([two_digits(0.123, f64::floor), two_digits(12.3, f64::ceil)], [0.12, 13.0]);
        assert_eq!([two_digits(-1.0, f64::floor), two_digits(f32::NAN, f64::ceil)], [0.0, 0.0]);
        let mut scene = lights(&[]);
        scene.objects[0] = Object { object_type: "sphere".to_owned(), size: 2.0, ..scene.objects[0].clone() };
        let of = |eye| Setting::new(DebugChannel::Depth, &scene, &Registry::builtin(), eye, None).range;
        assert_eq!(of(Vec3::Z * 5.0), [4.0, 6.0]);
        assert_eq!(of(Vec3::ZERO), [0.0, 1.0], "from within");
        assert_eq!(of(Vec3::X * 0.5), [0.0, 1.5]);
        scene.objects.push(Object { size: 100.0, ..scene.objects[0].clone() });
        let of = |eye| Setting::new(DebugChannel::Depth, &scene, &Registry::builtin(), eye, None).range;
        assert_eq!(of(Vec3::Z * 5.0), [4.0, 6.0], "what is around the eye does not count");
        assert_eq!(
            depths(&Scene { objects: Vec::new(), ..scene.clone() }, &Registry::builtin(), Vec3::Z),
            [0.0, 1.0]
        );
    }
}
