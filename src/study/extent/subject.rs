//! The models of the chapter, the data that approximations use of them, and the resulting light.

use std::{f32::consts::PI, sync::Arc};

use glam::{Vec2, Vec3};

use super::{
    super::{Lab, StudyError, alpha, set},
    ltc::{self, Fitted},
    split_sum::Filter,
};
use crate::{
    light::{Emitter, LightRecord, extent::sides},
    optics::{Frame, Terms, albedo::AlbedoCurve, equivalence::alpha_of_exponent},
    reference::Leaving,
    reflection::Surface,
    registry::Registry,
    scene::{Light, Scene, emitter},
};

/// Gold by its optical constants at 630, 532 and 465 nm, as in the chapter on gold.
const GOLD: &str =
    "fresnel=conductor diffuse=none ior=0.18836,0.54386,1.33185 extinction=3.4034,2.2309,1.8693";
/// The roughness of gold, that of the brushed metal on its model's scale, and the exponent of the plastic.
pub(super) const GOLD_ALPHA: f64 = 0.12;
pub(super) const BRUSHED: f64 = 0.45;
pub(super) const ANISOTROPY: f64 = 0.8;
pub(super) const EXPONENT: i64 = 120;

/// A model with settings.
pub(super) struct Subject {
    pub(super) name: &'static str,
    /// Name in sentences.
    pub(super) short: &'static str,
    model: &'static str,
    settings: String,
    /// The roughness α of the isotropic GGX lobe with which approximations replace the model's own.
    pub(super) alpha: f64,
}

/// The three subjects: GGX as used by approximations, GGX that is wider in one direction, and a model without
/// microfacets.
pub(super) fn all() -> [Subject; 3] {
    [
        Subject {
            name: "Gold: microfacet model, GGX",
            short: "gold (GGX)",
            model: "microfacet",
            settings: format!("{GOLD} {}", alpha(GOLD_ALPHA)),
            alpha: GOLD_ALPHA,
        },
        Subject {
            name: "Brushed metal: Disney’s model, anisotropic GGX",
            short: "brushed metal (Disney)",
            model: "disney",
            settings: format!(
                "base_colour=200,206,214 metallic=1 roughness={BRUSHED} anisotropic={ANISOTROPY}"
            ),
            alpha: BRUSHED * BRUSHED,
        },
        Subject {
            name: "Plastic: normalised Blinn–Phong",
            short: "plastic (Blinn–Phong)",
            model: "blinn_phong_normalised",
            settings: format!("base_colour=196,58,44 k_s=0.3 alpha={EXPONENT}"),
            alpha: f64::from(alpha_of_exponent(EXPONENT as f32)),
        },
    ]
}

impl Subject {
    pub(super) fn surface(&self, lab: &Lab) -> Result<Arc<dyn Surface>, StudyError> {
        lab.surface(self.model, &self.settings)
    }

    /// A scene with this model for every object.
    pub(super) fn put(&self, scene: &Scene, registry: &Registry) -> Result<Scene, StudyError> {
        let (_, values) = set(registry, self.model, &self.settings)?;
        let mut scene = scene.clone();
        for object in &mut scene.objects {
            object.reflection_model = Some(self.model.to_owned());
            object.material.0.extend(values.0.clone());
        }
        Ok(scene)
    }

    /// The data that approximations use, with this many samples of the light for each of their means.
    pub(super) fn known(&self, lab: &Lab, samples: u32) -> Result<Known, StudyError> {
        let ggx = format!("fresnel=none distribution=ggx {}", alpha(self.alpha));
        let ggx = lab.surface("microfacet", &ggx)?;
        let anisotropic = lab.registry.model(self.model).is_some_and(|m| m.declaration.anisotropic);
        let filter = Filter::ggx(self.alpha as f32, samples);
        Ok(Known {
            body: Body::new(&*self.surface(lab)?, anisotropic, samples),
            filter,
            ltc: Fitted::new(&*ggx, self.alpha),
        })
    }
}

/// The parts of a model that approximations reproduce exactly.
struct Body {
    /// The directional albedo of the highlight.
    specular: AlbedoCurve,
    /// The directional albedo of the diffuse part, and the cosine filter for light, if there is one.
    diffuse: Option<(AlbedoCurve, Filter)>,
}

impl Body {
    fn new(surface: &dyn Surface, anisotropic: bool, samples: u32) -> Self {
        let curve = |part: fn(Terms) -> Terms| {
            AlbedoCurve::new(|l, v| part(surface.response(l, v, &Frame::LOCAL)), anisotropic)
        };
        let specular = curve(|terms| Terms { specular: terms.specular, ..Terms::default() });
        let diffuse = curve(|terms| Terms { diffuse: terms.diffuse, ..Terms::default() });
        let is_dark = diffuse.harmonics[0].iter().all(|albedo| *albedo == Vec3::ZERO);
        Self { specular, diffuse: (!is_dark).then(|| (diffuse, Filter::cosine(samples))) }
    }

    /// The light that leaves towards v, from the mean radiance received by the highlight and the diffuse
    /// part.
    fn lit(&self, v: Vec3, frame: &Frame, mean: Vec3, diffuse: impl Fn(&Filter) -> Vec3) -> Vec3 {
        let mut sum = self.specular.at(v, frame) * mean;
        if let Some((albedo, filter)) = &self.diffuse {
            sum += albedo.at(v, frame) * diffuse(filter);
        }
        PI * sum
    }
}

/// The data that approximations use of a model.
pub(super) struct Known {
    body: Body,
    filter: Filter,
    pub(super) ltc: Fitted,
}

#[cfg(test)]
impl Known {
    pub(super) fn filter_mut(&mut self) -> &mut Filter {
        &mut self.filter
    }
}

/// A light with extent for approximations.
pub(super) struct Lamp {
    emitter: Box<dyn Emitter>,
    record: LightRecord,
    /// Corners of a rectangle.
    corners: Option<[Vec3; 4]>,
}

impl Lamp {
    pub(super) fn new(light: &Light, registry: &Registry, scene: &Scene) -> Option<Self> {
        let (entry, emitter, record) = emitter(light, registry, scene.display.encoding)?;
        let half = |name| entry.parameter(name).map(|p| 0.5 * light.parameters.number(p));
        let corners = half("width").zip(half("height")).map(|(x, y)| {
            let [across, up] = sides(record.direction, Vec2::Y);
            [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(a, b)| record.position + across * a + up * b)
        });
        Some(Self { emitter, record, corners })
    }

    #[cfg(test)]
    pub(super) fn corners(&self) -> Option<[Vec3; 4]> {
        self.corners
    }

    /// The mean radiance about an axis.
    fn mean(&self, filter: &Filter, p: Vec3, axis: Vec3) -> Vec3 {
        filter.mean((&*self.emitter, &self.record), p, axis)
    }
}

/// An approximation of the integral over a light with extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Linearly transformed cosines, for rectangles.
    Ltc,
    SplitSum,
}

impl Way {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ltc => "LTC",
            Self::SplitSum => "split sum",
        }
    }

    /// The light that leaves points of an object for an observer.
    pub(super) fn leaving(self, known: &Arc<Known>, lamp: &Arc<Lamp>, observer: Vec3) -> Arc<Leaving> {
        let (known, lamp) = (known.clone(), lamp.clone());
        Arc::new(move |p, n, tangent| {
            let eye = (observer - p).normalize_or_zero();
            // As in the light loop: normals between vertices may face away.
            let v = eye - 2.0 * n.dot(eye).min(0.0) * n;
            let frame = Frame::new(n, tangent);
            match self {
                Self::Ltc => {
                    let radiance = lamp.record.intensity * lamp.record.colour;
                    let corners = lamp.corners.unwrap_or_default().map(|c| c - p);
                    // The back of the light is dark.
                    if (p - lamp.record.position).dot(lamp.record.direction) <= 0.0 {
                        return Vec3::ZERO;
                    }
                    let mean = radiance * known.ltc.share(&corners, n, v) as f32;
                    known.body.lit(v, &frame, mean, |_| radiance * ltc::diffuse_share(&corners, n) as f32)
                }
                Self::SplitSum => {
                    let mean = lamp.mean(&known.filter, p, 2.0 * n.dot(v) * n - v);
                    known.body.lit(v, &frame, mean, |cosine| lamp.mean(cosine, p, n))
                }
            }
        })
    }
}
