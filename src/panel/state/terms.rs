//! The terms of the equation in a picture: isolating a term that is 0 would show nothing.

use std::{
    collections::HashMap,
    f32::consts::TAU,
    sync::{Arc, Mutex},
};

use glam::Vec3;

use crate::{
    caught::lock,
    optics::{Frame, TERMS, TermSelection, Terms},
    parameter::Values,
    reflection::ModelEntry,
    registry::Registry,
    scene::{Scene, shines_from_everywhere},
};

/// Maximum number of objects examined; in most scenes the first one has all terms.
const OBJECTS: usize = 256;
/// Maximum number of cached results: dragging a slider adds one per value.
const KEPT: usize = 256;

/// True for each term that is not 0: ambient, diffuse, specular, transmitted.
type Present = [bool; TERMS];

/// Cached results by model and material.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownTerms(Arc<Mutex<HashMap<String, Present>>>);

impl KnownTerms {
    /// The terms that the picture of a scene can show: all together, and each non-zero one if there are several.
    pub(super) fn offered(&self, scene: &Scene, registry: &Registry) -> Vec<TermSelection> {
        let there = self.present(scene, registry);
        let several = there.len() > 1;
        [TermSelection::All].into_iter().chain(there.into_iter().filter(|_| several)).collect()
    }

    /// The terms that are not 0 everywhere in the picture of a scene.
    pub(super) fn present(&self, scene: &Scene, registry: &Registry) -> Vec<TermSelection> {
        let mut present = [false; TERMS];
        let everywhere = shines_from_everywhere(scene.shining(), scene.display.encoding, registry);
        let mut last = None;
        for object in scene.shown().take(OBJECTS) {
            let key = (scene.model_of(object), &object.material);
            if last.replace(key) == Some(key) {
                continue;
            }
            let Some(model) = registry.model(key.0) else { continue };
            for (all, this) in present.iter_mut().zip(self.of(model, &object.material, scene, everywhere)) {
                *all |= this;
            }
            if present == [true; TERMS] {
                break;
            }
        }
        TermSelection::ALL.into_iter().skip(1).zip(present).filter(|(_, p)| *p).map(|(t, _)| t).collect()
    }

    fn of(&self, model: &ModelEntry, material: &Values, scene: &Scene, everywhere: bool) -> Present {
        let encoding = scene.display.encoding;
        let version = model.version();
        let key = format!("{} {version} {encoding:?} {everywhere} {material:?}", model.declaration.id);
        let mut known = lock(&self.0);
        if let Some(present) = known.get(&key) {
            return *present;
        }
        let surface = model.instantiate(material, encoding);
        let mut present = [false; TERMS];
        for (l, v) in directions() {
            let below = Vec3::new(l.x, l.y, -l.z);
            let through = surface.response(below, v, &Frame::LOCAL).transmitted;
            let terms = Terms { transmitted: through, ..surface.response(l, v, &Frame::LOCAL) };
            for (present, value) in present.iter_mut().zip(terms.each()) {
                *present |= value != Vec3::ZERO;
            }
        }
        let view = Vec3::new(0.6, 0.0, 0.8);
        for sharp in surface.sharp(view, &Frame::LOCAL) {
            let values = sharp.terms().each();
            present.iter_mut().zip(values).for_each(|(present, value)| *present |= value != Vec3::ZERO);
        }
        present[3] |= surface.interior().is_some();
        present[0] |= everywhere && surface.ambient_response(view, &Frame::LOCAL) != Vec3::ZERO;
        if known.len() >= KEPT {
            known.clear();
        }
        known.insert(key, present);
        present
    }
}

/// Directions of light and view above the surface, near the mirror direction and far from it.
fn directions() -> impl Iterator<Item = (Vec3, Vec3)> {
    let at = |tilt: f32, turn: f32| {
        let (s, c) = tilt.to_radians().sin_cos();
        Vec3::new(s * turn.cos(), s * turn.sin(), c)
    };
    [5.0, 35.0, 65.0].into_iter().flat_map(move |tilt| {
        (0..6).flat_map(move |i| {
            let turn = i as f32 / 6.0 * TAU + 0.1;
            [(at(tilt, 0.0), at(tilt, turn)), (at(tilt, 0.0), at(40.0, turn))]
        })
    })
}
