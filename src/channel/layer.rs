//! The layers of linear pictures: geometry as numbers, the terms of the model, and each light alone.
//!
//! The sum of the lights is the picture, except where one hides what is behind it, and up to the noise of light with
//! extent. The sum of the terms, and of `emission`, is the picture.

use super::{DebugChannel, Setting};
use crate::{
    declared::choice,
    linear::{Channels, Format},
    optics::{TermSelection, tone::ToneMapping},
    parameter::Value,
    registry::Registry,
    scene::{Display, Light, Scene, load::MAX_PICTURE_BYTES},
    text::identifier::as_identifier,
};

choice! {
    /// A kind of layers.
    LayerKind {
        #[default]
        Normals "normals" "Normals" "The interpolated unit normals: X, Y and Z in the room.",
        FaceNormals "face_normals" "Face normals" "The unit normals of the triangles: X, Y and Z in the room.",
        Depth "depth" "Depth" "The straight distance from the eye to the surface, in metres: Z.",
        Terms "terms" "Terms" "The light of each term of the model's equation, and that of lights in sight.",
        Lights "lights" "Lights" "The light of each light alone.",
    }
}

/// The name of the layer of lights in sight.
const EMISSION: &str = "emission";

/// Maximum length of a layer's name: with a dot and a channel, names of up to 31 bytes are read by every program.
const LONGEST: usize = 29;

/// A layer of a linear picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The name before those of its channels; empty for the picture.
    pub name: String,
    /// The names of its channels.
    pub channels: &'static [&'static str],
    /// The terms that it shows.
    pub terms: TermSelection,
    /// The numbers that are drawn.
    pub setting: Setting,
    shows: Shows,
}

/// The part of a scene that a layer shows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shows {
    /// All of it.
    All,
    /// Objects as far as no light in sight hides them: drawn with these lights, which [`settle`] takes out.
    Objects,
    /// Lights in sight, in front of and behind black objects.
    Lights,
    /// One of the active lights.
    Light(usize),
}

impl Layer {
    /// True if the layer is one of geometry. It then has one sample for each pixel, at its centre: a mean of
    /// distances or of directions is meaningless.
    #[must_use]
    pub fn is_of_geometry(&self) -> bool {
        !self.setting.channel.is_picture()
    }

    /// True if one sample of lights with extent suffices, since nothing reflects their light.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.shows == Shows::Lights
    }

    /// The scene that it shows, without exposure and tone mapping.
    #[must_use]
    pub fn scene(&self, scene: &Scene) -> Scene {
        let display = Display { exposure: 0.0, tone_mapping: ToneMapping::None, ..scene.display };
        let mut shown = Scene { display, ..scene.clone() }.alone();
        match self.shows {
            Shows::All | Shows::Objects => {}
            Shows::Lights => {
                for object in &mut shown.objects {
                    object.reflection_model = Some("lambert".to_owned());
                    object.material.set("base_colour", Value::Colour([0; 3]));
                }
            }
            Shows::Light(place) => return Setting { light: Some(place), ..self.setting }.lit(&shown),
        }
        shown
    }
}

/// The layers of a linear picture of a scene: the picture with these terms, and those of some kinds.
#[must_use]
pub fn layers(scene: &Scene, terms: TermSelection, kinds: &[LayerKind], registry: &Registry) -> Vec<Layer> {
    let light = |name: String, terms, shows| Layer {
        name,
        channels: &["R", "G", "B"],
        terms,
        setting: Setting::numbers(DebugChannel::Light),
        shows,
    };
    let geometry = |channel: DebugChannel, channels: &'static [&'static str]| {
        let setting = Setting::numbers(channel);
        Layer { channels, setting, ..light(channel.id().to_owned(), terms, Shows::All) }
    };
    let mut all = vec![Layer { channels: &["R", "G", "B", "A"], ..light(String::new(), terms, Shows::All) }];
    for kind in LayerKind::ALL.iter().filter(|kind| kinds.contains(kind)) {
        match kind {
            LayerKind::Normals => all.push(geometry(DebugChannel::Normals, &["X", "Y", "Z"])),
            LayerKind::FaceNormals => all.push(geometry(DebugChannel::FaceNormals, &["X", "Y", "Z"])),
            LayerKind::Depth => all.push(geometry(DebugChannel::Depth, &["Z"])),
            LayerKind::Terms => {
                let shown = TermSelection::ALL.into_iter().skip(1);
                let through = scene.shown().any(|object| {
                    registry
                        .model(scene.model_of(object))
                        .is_some_and(|model| model.passage(&object.material).transmits)
                });
                let shown = shown.filter(|one| *one != TermSelection::Transmitted || through);
                let shown = shown.filter(|one| terms == TermSelection::All || terms == *one);
                all.extend(shown.map(|one| light(one.id().to_owned(), one, Shows::Objects)));
                if scene.shining().any(|lamp| can_be_hidden(lamp, registry)) {
                    all.push(light(EMISSION.to_owned(), terms, Shows::Lights));
                }
            }
            LayerKind::Lights => {
                let shining = scene.lights.iter().enumerate().filter(|(_, lamp)| lamp.enabled).enumerate();
                let alone = |(place, (index, lamp))| light(name(index, lamp), terms, Shows::Light(place));
                all.extend(shining.map(alone));
            }
        }
    }
    all
}

/// Takes the lights in sight, with which the terms were drawn, out of their layers.
pub fn settle(channels: &mut Channels, layers: &[Layer]) {
    if layers.iter().any(|layer| layer.name == EMISSION) {
        for layer in layers.iter().filter(|layer| layer.shows == Shows::Objects) {
            layer.channels.iter().for_each(|channel| {
                channels.subtract(&format!("{}.{channel}", layer.name), &format!("{EMISSION}.{channel}"));
            });
        }
    }
}

/// The reason why layers cannot be in one file; `None` if they can.
#[must_use]
pub fn too_large(layers: &[Layer], format: Format, [width, height]: [u32; 2]) -> Option<String> {
    let channels: usize = layers.iter().map(|layer| layer.channels.len()).sum();
    let bytes = format.bytes(width as usize * height as usize, channels);
    (bytes > MAX_PICTURE_BYTES).then(|| {
        let [bytes, most] = [bytes, MAX_PICTURE_BYTES].map(|bytes| bytes >> 20);
        format!("{channels} channels of {width}×{height} pixels take {bytes} MiB, but a file has at most {most} MiB")
    })
}

/// True if a light is in sight, and can be hidden.
fn can_be_hidden(light: &Light, registry: &Registry) -> bool {
    let entry = registry.light(&light.light_type);
    light.enabled
        && entry.is_some_and(|e| e.is_visible(&light.parameters) && e.parameter("visible").is_some())
}

/// The name of the layer of a light, from its index in the scene.
fn name(index: usize, light: &Light) -> String {
    let own = light.name.as_deref().and_then(as_identifier).map_or_else(String::new, |own| format!("_{own}"));
    let mut name = format!("light_{}{own}", index + 1);
    name.truncate(LONGEST);
    name
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;

    fn names(scene: &Scene, terms: TermSelection, kinds: &[LayerKind]) -> Vec<String> {
        layers(scene, terms, kinds, &Registry::builtin()).into_iter().map(|layer| layer.name).collect()
    }

    fn lit() -> Scene {
        let lamp = |name: Option<&str>, enabled| Light {
            name: name.map(str::to_owned),
            enabled,
            ..Light::default()
        };
        let lights = vec![
            lamp(Some("Key light, warm"), true),
            lamp(Some("off"), false),
            lamp(None, true),
            lamp(Some("größe"), true),
            lamp(Some(&"long ".repeat(7)), true),
        ];
        Scene { lights, ..Scene::default() }
    }

    #[test]
    fn layers_have_an_order_and_names_that_every_program_reads() {
        let all = names(&lit(), TermSelection::All, LayerKind::ALL);
        assert_eq!(
            all,
            [
                "",
                "normals",
                "face_normals",
                "depth",
                "ambient",
                "diffuse",
                "specular",
                "light_1_key_light_warm",
                "light_3",
                "light_4_gr_e",
                "light_5_long_long_long_long_l",
            ]
        );
        assert!(all.iter().all(|name| name.len() <= LONGEST));
        let mixed = [LayerKind::Depth, LayerKind::Normals, LayerKind::Depth];
        assert_eq!(names(&lit(), TermSelection::All, &mixed), ["", "normals", "depth"]);
        assert_eq!(names(&lit(), TermSelection::Diffuse, &[LayerKind::Terms]), ["", "diffuse"]);
    }

    #[test]
    fn a_light_alone_is_the_only_one_and_no_layer_has_exposure() {
        let mut scene = lit();
        scene.display = Display { exposure: 3.0, tone_mapping: ToneMapping::AgX, ..scene.display };
        let registry = Registry::builtin();
        let all = layers(&scene, TermSelection::All, LayerKind::ALL, &registry);
        for layer in &all {
            let Display { exposure, tone_mapping, .. } = layer.scene(&scene).display;
            assert_eq!((exposure, tone_mapping), (0.0, ToneMapping::None));
            assert!(layer.setting.numbers);
            assert_eq!(layer.is_of_geometry(), layer.setting.channel.code() != 0, "{}", layer.name);
        }
        for (layer, index) in all[7..].iter().zip([0, 2, 3, 4]) {
            let shown = layer.scene(&scene);
            let shining: Vec<_> = (0..5).filter(|i| shown.lights[*i].enabled).collect();
            assert_eq!(shining, [index], "{}", layer.name);
        }
    }

    #[test]
    fn what_does_not_fit_into_a_file_is_told() {
        let layers = layers(&lit(), TermSelection::All, LayerKind::ALL, &Registry::builtin());
        assert_eq!(too_large(&layers, Format::Exr, [1280, 720]), None);
        let said = too_large(&layers, Format::Exr, [8192, 4096]).expect("too large");
        assert_eq!(said, "32 channels of 8192×4096 pixels take 4096 MiB, but a file has at most 1024 MiB");
        assert_eq!(too_large(&layers, Format::Hdr, [8192, 8192]), None, "it has no layers");
    }

    #[test]
    fn lights_in_sight_are_a_layer_beside_the_terms() {
        let registry = Registry::builtin();
        let mut scene = lit();
        scene.lights[0].set_type(registry.light("rectangle").expect("built in"), &registry, scene.scene_size);
        let all = layers(&scene, TermSelection::All, &[LayerKind::Terms], &registry);
        let names: Vec<_> = all.iter().map(|layer| layer.name.as_str()).collect();
        assert_eq!(names, ["", "ambient", "diffuse", "specular", "emission"]);
        // They are drawn with the terms, since they hide objects, and taken out of their layers afterwards.
        let mut channels = Channels::new(1, 1);
        for (layer, light) in all.iter().zip([9.0, 6.0, 7.0, 6.0, 5.0]) {
            channels.add(&layer.name, layer.channels, &[Vec4::splat(light)]);
        }
        settle(&mut channels, &all);
        let blue = ["B", "ambient.B", "diffuse.B", "specular.B", "emission.B"].map(|name| channels.get(name));
        assert_eq!(blue.map(|numbers| numbers.map_or(0.0, |numbers| numbers[0])), [9.0, 1.0, 2.0, 1.0, 5.0]);
        let black = all[4].scene(&scene);
        assert!(all[4].is_plain() && black.objects[0].reflection_model.as_deref() == Some("lambert"));
        scene.lights[0].parameters.set("visible", Value::flag(false));
        assert_eq!(layers(&scene, TermSelection::All, &[LayerKind::Terms], &registry).len(), 4);
    }
}
