//! Debug channels in the CPU renderer: the twin of `assets/shaders/channels.wgsl`.

use std::sync::Arc;

use glam::{Mat4, Vec3};

use super::{Shot, object::Draw};
use crate::{
    channel::{Setting, colours::NAN},
    debug::{Leaving, Made, Point, Shows},
    light::{Emitter, Incident, LightRecord},
    optics::{
        colour::{Encoding, luminance},
        tone::exposure_factor,
    },
    scene::{emitter, observer::clip_from_room},
    shading::{Corner, Lighting, PhongShading, Shading, Stage, Varying},
};

/// Everything from which a channel is calculated, apart from the point.
#[derive(Clone)]
pub(super) struct ChannelSight(Arc<Parts>);

struct Parts {
    setting: Setting,
    eye: Vec3,
    light: Option<(Box<dyn Emitter>, LightRecord)>,
    clip_from_room: Mat4,
    size: [f32; 2],
    exposure: f32,
    encoding: Encoding,
}

impl ChannelSight {
    pub(super) fn new(Shot { scene, registry, settings, .. }: Shot, setting: Setting) -> Self {
        let encoding = scene.display.encoding;
        let size = [settings.width as f32, settings.height as f32];
        let light = setting.light.and_then(|i| scene.shining().nth(i)).and_then(|light| {
            emitter(light, registry, encoding).map(|(_, emitter, record)| (emitter, record))
        });
        Self(Arc::new(Parts {
            setting,
            eye: scene.observer.position,
            light,
            clip_from_room: clip_from_room(&scene.observer, size[0] / size[1]),
            size,
            exposure: exposure_factor(scene.display.exposure),
            encoding,
        }))
    }

    /// The object as drawn by the channel.
    pub(super) fn seen<'a>(&self, draw: Draw<'a>) -> Draw<'a> {
        let of_light = self.0.setting.channel.is_of_light();
        // The geometry is that of the mesh, independent of the shading model.
        let (stage, inner) = if of_light {
            (draw.stage, draw.shading)
        } else {
            (Stage::Pixel, Box::new(PhongShading::default()) as Box<dyn Shading>)
        };
        Draw { stage, shading: Box::new(Channelled { inner, parts: self.0.clone() }), ..draw }
    }
}

/// A shading model, and the quantity of it that a channel shows.
struct Channelled {
    inner: Box<dyn Shading>,
    parts: Arc<Parts>,
}

impl Shading for Channelled {
    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        self.inner.vertex(lighting, corner)
    }

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
        match self.parts.setting.channel.declaration().shows {
            Shows::Light(formula, _) => {
                let light = self.inner.pixel(lighting, varying, face_normal);
                self.parts.of_light(formula, light, varying.position)
            }
            Shows::Geometry(formula, _) => self.parts.of_geometry(formula, varying, face_normal),
            // They are no channel of a single point.
            _ => self.inner.pixel(lighting, varying, face_normal),
        }
    }
}

impl Parts {
    /// The light that shows the light that leaves a point.
    fn of_light(&self, formula: fn(&Leaving<'_>) -> Made, light: Vec3, position: Vec3) -> Vec3 {
        if light.is_nan() {
            return Made::colour(NAN).shown();
        }
        let leaving = Leaving {
            light,
            bright: luminance(light.clamp(Vec3::splat(-1e30), Vec3::splat(1e30))),
            exposed: light * self.exposure,
            exposure: self.exposure,
            pixel: &|| self.pixel(position),
            unencoded: self.encoding == Encoding::Off,
        };
        formula(&leaving).shown()
    }

    /// The pixel that shows a point.
    fn pixel(&self, position: Vec3) -> [u32; 2] {
        let at = self.clip_from_room.project_point3(position);
        let [width, height] = self.size;
        [((0.5 + 0.5 * at.x) * width) as u32, ((0.5 - 0.5 * at.y) * height) as u32]
    }

    /// The light that shows the geometry at a point.
    fn of_geometry(&self, formula: fn(&Point<'_>) -> Made, varying: &Varying, face_normal: Vec3) -> Vec3 {
        let Varying { position, normal, .. } = *varying;
        let (normal, to_eye) = (normal.normalize_or_zero(), self.eye - position);
        let l = || {
            let (emitter, record) = self.light.as_ref()?;
            match emitter.incident(record, position) {
                Incident::From { l, .. } => Some(l),
                Incident::Uniform { .. } => None,
            }
        };
        let v = to_eye.normalize_or_zero();
        let Setting { range, numbers, .. } = self.setting;
        let made = formula(&Point { normal, face_normal, to_eye, v, l: &l, range });
        if numbers { made.numbers() } else { made.shown() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        channel::{
            DebugChannel,
            colours::{CLIPPED, INFINITE, NEGATIVE, codes},
        },
        optics::{colour::srgb_decode, viridis::viridis},
        reference::Settings,
        registry::Registry,
        scene::Scene,
    };

    fn parts(channel: DebugChannel, exposure: f32) -> Parts {
        let (mut scene, registry) = (Scene::default(), Registry::builtin());
        scene.display.exposure = exposure;
        let setting = Setting::new(channel, &scene, &registry, scene.observer.position, None);
        let sight = ChannelSight::new(Shot::new(&scene, &registry, &Settings::default()), setting);
        Arc::into_inner(sight.0).expect("no one else has it")
    }

    impl Parts {
        fn light(&self, light: Vec3) -> Vec3 {
            let Shows::Light(formula, _) = self.setting.channel.declaration().shows else {
                panic!("it is of light");
            };
            self.of_light(formula, light, Vec3::ZERO)
        }
    }

    #[test]
    fn light_that_is_no_light_has_a_colour_of_its_own() {
        let parts = parts(DebugChannel::NotANumber, 1.0);
        let shown = |light: [f32; 3]| parts.light(light.into());
        let colour = |c| codes(c).map(srgb_decode);
        assert_eq!(shown([0.5, f32::NAN, f32::INFINITY]), colour(NAN));
        assert_eq!(shown([0.5, f32::INFINITY, -1.0]), colour(INFINITE));
        assert_eq!(shown([0.5, f32::NEG_INFINITY, 0.0]), colour(INFINITE));
        assert_eq!(shown([0.5, -1e-6, 0.0]), colour(NEGATIVE));
        assert_eq!(shown([0.25, 0.25, 0.25]), Vec3::splat(0.125));
    }

    #[test]
    fn luminance_is_logarithmic_and_knows_no_exposure() {
        for exposure in [0.0, 3.0] {
            let parts = parts(DebugChannel::Luminance, exposure);
            let shown = |light: f32| parts.light(Vec3::splat(light));
            for (light, place) in [(0.001, 0.0), (0.1, 0.5), (1.0, 0.75), (10.0, 1.0), (1e9, 1.0)] {
                let right = viridis(place).map(srgb_decode);
                assert!((shown(light) - right).abs().max_element() < 1e-3, "{light}");
            }
            assert_eq!(shown(0.0), Vec3::ZERO);
        }
    }

    #[test]
    fn light_is_cut_off_after_exposure() {
        let at = |exposure, light: f32| parts(DebugChannel::Clipped, exposure).light(Vec3::splat(light));
        assert_eq!(at(0.0, 0.5), Vec3::splat(0.5));
        assert_eq!(at(1.0, 0.5), Vec3::ONE, "white is not cut off");
        assert!([Vec3::ZERO, codes(CLIPPED).map(srgb_decode)].contains(&at(1.0, 0.51)));
    }
}
