//! Legends of channels, for the window and for pictures.

use super::{
    DebugChannel, Setting,
    colours::{AWAY, BELOW, CLIPPED, EDGE, INFINITE, NAN, NEGATIVE, TOWARDS},
};
use crate::{registry::Registry, scene::Scene, shading::Stage};

/// The meaning of a channel's colours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Legend {
    /// The quantity shown, with its unit.
    pub title: String,
    /// The numbers at the left, in the middle and at the right of a bar with the colours of
    /// [viridis](crate::optics::viridis).
    pub scale: Option<[String; 3]>,
    /// Additional colours, with their meanings.
    pub colours: Vec<([u8; 3], String)>,
}

impl Setting {
    /// The legend of the channel in a picture of a scene.
    #[must_use]
    pub fn legend(&self, scene: &Scene, registry: &Registry) -> Legend {
        // Vertices with separate colours, and those whose normals are shown.
        let mut vertices = [false; 2];
        for object in scene.shown().filter(|_| self.channel == DebugChannel::Vertices) {
            let shading = registry.shading_model(scene.shading_model_of(object));
            let own = shading.is_some_and(|shading| shading.declaration.stage == Stage::Vertex);
            vertices[usize::from(!own)] = true;
        }
        let title = match self.channel {
            DebugChannel::Normals => "Interpolated normals: x, y, z as red, green, blue".to_owned(),
            DebugChannel::FaceNormals => "Face normals: x, y, z as red, green, blue".to_owned(),
            DebugChannel::VertexNormals => "Vertex normals".to_owned(),
            DebugChannel::Wireframe => "Wireframe: visible edges of polygons".to_owned(),
            DebugChannel::Vertices => match vertices {
                [true, false] => "Vertices: the colour calculated there (Gouraud)",
                [true, true] => "Vertices: Gouraud colour; where there is none, the normal",
                _ => "Vertices: normals, x, y, z as red, green, blue",
            }
            .to_owned(),
            DebugChannel::NDotL | DebugChannel::NDotH => {
                let light = self.light_name(scene, registry);
                let light = light.unwrap_or_else(|| "no light has a direction".to_owned());
                format!("{}: {light}", self.channel.name())
            }
            DebugChannel::NDotV => "N·V: cosine towards the observer".to_owned(),
            DebugChannel::Facing => "Facing, by the interpolated normal".to_owned(),
            DebugChannel::Depth => "Depth: distance from the eye, m".to_owned(),
            DebugChannel::Luminance => "Luminance, relative cd/m², before exposure".to_owned(),
            DebugChannel::Clipped => "Clipped pixels, before tone mapping".to_owned(),
            DebugChannel::NotANumber => "Light that is not a number".to_owned(),
            DebugChannel::Light => match self.light_name(scene, registry) {
                Some(light) => format!("One light alone: {light}"),
                None => "One light alone: no light shines".to_owned(),
            },
        };
        let scale = |numbers: [&str; 3]| Some(numbers.map(str::to_owned));
        let [low, high] = self.range;
        let scale = match self.channel {
            DebugChannel::NDotL | DebugChannel::NDotH | DebugChannel::NDotV => scale(["0", "0.5", "1"]),
            DebugChannel::Luminance => scale(["0.001", "0.1", "10"]),
            DebugChannel::Depth => Some([low, rounded(0.5 * (low + high)), high].map(|x| x.to_string())),
            _ => None,
        };
        let axes: &[_] =
            &[([255, 128, 128], "right (+x)"), ([128, 255, 128], "up (+y)"), ([128, 128, 255], "out (+z)")];
        let colours = match self.channel {
            DebugChannel::Vertices if vertices == [true, false] => &[],
            DebugChannel::Normals
            | DebugChannel::FaceNormals
            | DebugChannel::VertexNormals
            | DebugChannel::Vertices => axes,
            DebugChannel::Wireframe => &[(EDGE, "edge"), (NAN, "not a number")],
            DebugChannel::NDotL | DebugChannel::NDotH | DebugChannel::NDotV => &[(BELOW, "below 0")],
            DebugChannel::Facing => &[(TOWARDS, "towards the observer"), (AWAY, "away")],
            DebugChannel::Luminance => &[([0; 3], "none"), (NAN, "not a number")],
            DebugChannel::Clipped => &[(CLIPPED, "striped: above 1"), (NAN, "not a number")],
            DebugChannel::NotANumber => {
                &[(NAN, "not a number"), (INFINITE, "infinite"), (NEGATIVE, "below 0")]
            }
            DebugChannel::Depth | DebugChannel::Light => &[],
        };
        let colours = colours.iter().map(|(colour, text)| (*colour, (*text).to_owned())).collect();
        Legend { title, scale, colours }
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
}

/// A number rounded to three digits.
fn rounded(x: f32) -> f32 {
    let digits = 2 - x.abs().max(1e-9).log10().floor() as i32;
    ((f64::from(x) * 10f64.powi(digits)).round() / 10f64.powi(digits)) as f32
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::scene::Light;

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
        let depth =
            Setting { channel: DebugChannel::Depth, light: None, range: [0.12, 13.0], from_position: false };
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
