//! Debug channels of scenes: the light and the scale of a channel, and its legend. [`debug`](crate::debug)
//! declares what each shows.
//!
//! A channel belongs to a view, not to the scene. It is drawn without exposure and tone mapping, so that its legend
//! is valid; only [`DebugChannel::Light`] is a picture like any other, under one light.
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
    debug::About,
    light::{Emitter, Incident, LightRecord},
    optics::{colour::luminance, sequence::Sequence},
    registry::Registry,
    scene::{Light, Scene, emitter},
    shading::Stage,
};

pub use crate::debug::{DebugChannel, Legend, colours};
pub use layer::{Layer, LayerKind, layers, settle, too_large};
pub use plate::{Plate, Spacing};

mod layer;
mod plate;

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
    /// True for the numbers themselves instead of colours that show them: light before exposure and without bounds,
    /// x, y and z of directions, distances in metres.
    pub numbers: bool,
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
        let range =
            channel.declaration().range.map_or([0.0, 1.0], |of| of(&mut reaches(scene, registry, eye)));
        let mut shining = scene.lights.iter().filter(|light| light.enabled);
        let shown = light.and_then(|place| shining.nth(place));
        let declared = shown.and_then(|light| registry.light(&light.light_type));
        let from_position = declared.is_some_and(|l| l.declaration.has_position);
        Self { channel, light, range, from_position, numbers: false }
    }

    /// The numbers of a channel, for linear pictures; of [`DebugChannel::Light`], the light of all lights.
    #[must_use]
    pub const fn numbers(channel: DebugChannel) -> Self {
        // A place on this scale is the number.
        Self { channel, light: None, range: [0.0, 1.0], from_position: false, numbers: true }
    }

    /// True if the light with this index among the active ones takes part in the picture.
    #[must_use]
    pub fn shines(&self, light: usize) -> bool {
        !self.channel.is_picture() || self.light.is_none_or(|alone| alone == light)
    }

    /// The legend of the channel in a picture of a scene.
    #[must_use]
    pub fn legend(&self, scene: &Scene, registry: &Registry) -> Legend {
        let vertices = || {
            let mut vertices = [false; 2];
            for object in scene.shown() {
                let shading = registry.shading_model(scene.shading_model_of(object));
                let own = shading.is_some_and(|shading| shading.declaration.stage == Stage::Vertex);
                vertices[usize::from(!own)] = true;
            }
            vertices
        };
        let light = || self.light_name(scene, registry);
        (self.channel.declaration().legend)(&About { range: self.range, light: &light, vertices: &vertices })
    }

    /// The name of the channel's light, or its type and its index among the lights of the scene.
    fn light_name(&self, scene: &Scene, registry: &Registry) -> Option<String> {
        let mut shining = scene.lights.iter().enumerate().filter(|(_, light)| light.enabled);
        let (index, light) = shining.nth(self.light?)?;
        Some(light.name.clone().unwrap_or_else(|| {
            let kind = registry.light(&light.light_type).map_or("light", |entry| entry.declaration.name);
            format!("{kind} (light {})", index + 1)
        }))
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

/// The distances from the eye to the near and the far side of each object.
fn reaches(scene: &Scene, registry: &Registry, eye: Vec3) -> impl Iterator<Item = [f32; 2]> {
    scene.shown().filter_map(move |object| {
        let shape = registry.shape(&object.object_type)?;
        let radius = shape.bounds(&object.shape).radius * object.size;
        let distance = eye.distance(object.position);
        Some([distance - radius, distance + radius])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;

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
        let mut scene = lights(&[]);
        scene.objects[0] = Object { object_type: "sphere".to_owned(), size: 2.0, ..scene.objects[0].clone() };
        let of = |eye| Setting::new(DebugChannel::Depth, &scene, &Registry::builtin(), eye, None).range;
        assert_eq!(of(Vec3::Z * 5.0), [4.0, 6.0]);
        assert_eq!(of(Vec3::ZERO), [0.0, 1.0], "from within");
        assert_eq!(of(Vec3::X * 0.5), [0.0, 1.5]);
        scene.objects.push(Object { size: 100.0, ..scene.objects[0].clone() });
        let of = |eye| Setting::new(DebugChannel::Depth, &scene, &Registry::builtin(), eye, None).range;
        assert_eq!(of(Vec3::Z * 5.0), [4.0, 6.0], "what is around the eye does not count");
        let nothing = Scene { objects: Vec::new(), ..scene.clone() };
        let of = |eye| Setting::new(DebugChannel::Depth, &nothing, &Registry::builtin(), eye, None).range;
        assert_eq!(of(Vec3::Z), [0.0, 1.0]);
    }

    fn legend(channel: DebugChannel, scene: &Scene) -> Legend {
        let registry = Registry::builtin();
        Setting::new(channel, scene, &registry, Vec3::Z, None).legend(scene, &registry)
    }

    #[test]
    fn the_legend_of_vertices_explains_normals_only_where_there_are_some() {
        let mut scene = Scene { shading_model: "gouraud".to_owned(), ..Scene::default() };
        let gouraud = legend(DebugChannel::Vertices, &scene);
        assert!(gouraud.title.contains("colour calculated there") && gouraud.colours.is_empty());
        scene.objects.push(scene.objects[0].clone());
        scene.objects[1].shading_model = Some("phong".to_owned());
        let both = legend(DebugChannel::Vertices, &scene);
        assert!(both.title.contains("Gouraud colour") && both.colours.len() == 3);
        scene.shading_model = "flat".to_owned();
        let normals = legend(DebugChannel::Vertices, &scene);
        assert!(!normals.title.contains("Gouraud") && normals.colours.len() == 3);
    }

    #[test]
    fn legends_name_values_units_and_the_light() {
        let mut scene = Scene { lights: vec![Light::default(), Light::default()], ..Scene::default() };
        scene.lights[0].enabled = false;
        scene.lights[1].name = Some("Key".to_owned());
        assert_eq!(legend(DebugChannel::NDotL, &scene).title, "N·L: Key");
        scene.lights[1].name = None;
        assert!(legend(DebugChannel::NDotH, &scene).title.ends_with("(light 2)"));
        scene.lights.clear();
        assert_eq!(legend(DebugChannel::NDotL, &scene).title, "N·L: no light has a direction");
        assert_eq!(legend(DebugChannel::Light, &scene).title, "One light alone: no light shines");
        let depth = Setting { range: [0.12, 13.0], ..Setting::numbers(DebugChannel::Depth) };
        let depth = depth.legend(&scene, &Registry::builtin());
        assert_eq!(depth.scale, Some(["0.12", "6.56", "13"].map(str::to_owned)));
        assert!(depth.title.ends_with(", m"));
        for channel in DebugChannel::ALL.into_iter().filter(|c| !c.is_picture()) {
            let legend = legend(channel, &scene);
            let own = channel == DebugChannel::Vertices && legend.title.contains("Gouraud");
            assert!(own || legend.scale.is_some() || !legend.colours.is_empty(), "{channel:?}");
        }
    }
}
