//! Reading back textures from the GPU, and the views in them.

use std::sync::{Arc, OnceLock};

use bevy::{
    prelude::*,
    render::gpu_readback::{Readback, ReadbackComplete},
};

use crate::{
    compare::Shown,
    optics::TermSelection,
    panel::state::Session,
    reference::{self, Settings},
    registry::Registry,
    scene::{Observer, Scene},
};

/// Textures being read back: the entities that read them, and the results.
#[derive(Debug)]
pub(super) struct Reading(Vec<(Entity, Arc<OnceLock<Vec<u8>>>)>);

impl Reading {
    /// Starts to read back textures.
    pub(super) fn begin(textures: &[Handle<Image>], commands: &mut Commands) -> Self {
        let read = textures.iter().map(|texture| {
            let bytes = Arc::<OnceLock<Vec<u8>>>::default();
            let heard = bytes.clone();
            let hear = move |answer: On<ReadbackComplete>| _ = heard.get_or_init(|| answer.data.clone());
            (commands.spawn(Readback::texture(texture.clone())).observe(hear).id(), bytes)
        });
        Self(read.collect())
    }

    /// The bytes of the textures, once all are complete, which ends the reading: see [`codes`].
    pub(super) fn end(reading: &mut Option<Self>, commands: &mut Commands) -> Option<Vec<Vec<u8>>> {
        let all = |reading: &mut Self| reading.0.iter().all(|(_, bytes)| bytes.get().is_some());
        let done = reading.take_if(all)?;
        let bytes = done.0.iter().filter_map(|(_, bytes)| bytes.get().cloned()).collect();
        done.abandon(commands);
        Some(bytes)
    }

    /// Stops reading.
    pub(super) fn abandon(self, commands: &mut Commands) {
        self.0.into_iter().for_each(|(entity, _)| commands.entity(entity).despawn());
    }
}

/// Views of a scene as the window shows them.
#[derive(Debug)]
pub(super) struct SeenViews {
    pub(super) scene: Scene,
    pub(super) registry: Registry,
    /// The views, with their visible terms.
    pub(super) shown: Vec<(usize, TermSelection)>,
    /// Size of each view.
    pub(super) size: UVec2,
    pub(super) camera: Observer,
}

impl SeenViews {
    /// Views of the scene of the window, with the comparison as on screen.
    pub(super) fn of(session: &Session, views: &[usize], size: UVec2, registry: &Registry) -> Self {
        let mut scene = session.document.named(registry);
        scene.comparison.with = session.compared_with();
        Self {
            scene,
            registry: registry.clone(),
            shown: views.iter().map(|view| (*view, session.terms_of(*view))).collect(),
            size,
            camera: session.facts.observer(session.document.observer),
        }
    }

    /// The scene of a view, seen by the camera of the window.
    pub(super) fn seen(&self, view: usize) -> Option<Scene> {
        let (seen, _) = self.scene.seen(view, &self.registry)?;
        let observer = self.camera.fitting(self.size.to_array(), self.scene.view_angle());
        Some(Scene { observer, ..seen })
    }

    /// The pictures that were read back, lit if their light is needed; for a map, with the outlines of the objects of
    /// the first view.
    pub(super) fn pictures(&self, read: &[Vec<u8>], lit: bool, map: bool) -> Result<Vec<Shown>, String> {
        let unread = || "The picture was not taken: the GPU returned no pixels.".to_owned();
        let [width, height] = self.size.to_array();
        let mut pictures = Vec::new();
        for ((view, terms), bytes) in self.shown.iter().zip(read) {
            let seen = self.seen(*view).ok_or_else(unread)?;
            let codes = codes(bytes, self.size).ok_or_else(unread)?;
            let mut picture = Shown::of_codes(width, height, codes).map_err(|e| e.to_string())?;
            if lit {
                let settings = Settings { width, height, samples: 1, terms: *terms };
                let light = reference::render(&seen, &self.registry, &settings);
                picture = picture.with_light(light).map_err(|e| e.to_string())?;
            }
            if map && pictures.is_empty() {
                picture = picture.outlined(&seen, &self.registry);
            }
            pictures.push(picture);
        }
        if pictures.is_empty() { Err(unread()) } else { Ok(pictures) }
    }
}

/// Display codes of a texture that was read back, whose rows start at multiples of 256 bytes.
fn codes(bytes: &[u8], size: UVec2) -> Option<Vec<u8>> {
    let row = 4 * size.x as usize;
    let stride = if size.y > 1 { row.next_multiple_of(256) } else { row };
    let mut out = Vec::with_capacity(3 * size.x as usize * size.y as usize);
    for y in 0..size.y as usize {
        let row = bytes.get(y * stride..y * stride + row)?;
        out.extend(row.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]));
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_textures_are_read_without_what_fills_them_up() {
        let size = UVec2::new(3, 2);
        let mut bytes = vec![0; 256 + 12];
        bytes[..12].copy_from_slice(&[1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255]);
        bytes[256..].copy_from_slice(&[10, 11, 12, 255, 13, 14, 15, 255, 16, 17, 18, 255]);
        assert_eq!(codes(&bytes, size), Some((1..=18).collect()));
        assert_eq!(codes(&bytes[..260], size), None);
    }
}
