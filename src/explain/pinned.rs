//! A pinned point of a surface, explained wherever the observer and the object are.

use glam::{Vec3, Vec4Swizzles};

use super::{Explainer, Explanation, explanation};
use crate::{
    reference::{
        Settings, Shot,
        probe::{probe_point, towards},
    },
    registry::Registry,
    scene::{Object, Observer, Scene, observer::clip_from_room, rotation::rotation},
};

/// Tolerance of visibility: a hit that is nearer than the point by less than this fraction of the object's
/// size, or of the distance, is the surface of the point itself.
const SURFACE: f32 = 1e-3;

/// A point on the surface of an object, in the object's own coordinates: it moves, turns and scales with the
/// object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Position.
    pub position: Vec3,
    /// Surface normal at the position.
    pub normal: Vec3,
}

impl Anchor {
    /// The anchor of a point in the room, with its surface normal, for the object in its present position.
    #[must_use]
    pub fn of(object: &Object, position: Vec3, normal: Vec3) -> Self {
        let back = rotation(object.rotation).inverse();
        Self { position: back * (position - object.position) / object.size, normal: back * normal }
    }

    /// Position in the room.
    #[must_use]
    pub fn place(&self, object: &Object) -> Vec3 {
        rotation(object.rotation) * (self.position * object.size) + object.position
    }
}

/// The visibility of a point on a surface to the observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// Visible in the picture.
    Clear,
    /// Outside the picture, or behind the observer.
    Outside,
    /// On a surface that faces away.
    Away,
    /// Hidden behind the object with this index.
    Behind(usize),
}

/// The pixel that contains a point and true, or the nearest pixel and false.
fn pixel_of(observer: &Observer, size: [u32; 2], point: Vec3) -> ([u32; 2], bool) {
    let [width, height] = size.map(|side| side.max(1) as f32);
    let clip = clip_from_room(observer, width / height) * point.extend(1.0);
    let ahead = clip.z <= clip.w && clip.w > 0.0;
    let part = clip.xy() / clip.w.abs().max(f32::MIN_POSITIVE);
    let at = [(0.5 + 0.5 * part.x) * width, (0.5 - 0.5 * part.y) * height];
    let inside = ahead && at[0] >= 0.0 && at[1] >= 0.0 && at[0] < width && at[1] < height;
    ([0, 1].map(|i| (at[i].max(0.0) as u32).min(size[i].saturating_sub(1))), inside)
}

impl Explainer {
    /// Explains the surface point of an object that is nearest to an anchor, as if a pixel showed it, and
    /// reports its visibility. The numbers are those of the point itself, not of the centre of the pixel that
    /// contains it. `None` if the object does not exist or has no surface.
    pub fn point(
        &mut self,
        scene: &Scene,
        registry: &Registry,
        settings: &Settings,
        object: usize,
        anchor: &Anchor,
    ) -> Option<(Explanation, Sight)> {
        let wanted = [anchor.position, anchor.normal];
        let shot = Shot { samples: self.samples, ..Shot::new(scene, registry, settings) };
        let found = probe_point(&mut self.meshes, shot, object, wanted)?;
        let (point, normal) = (found.varying.position, found.face_normal);
        let (pixel, inside) = pixel_of(&scene.observer, [settings.width, settings.height], point);
        let eye = scene.observer.position;
        let nearer = SURFACE * (scene.objects.get(object)?.size + eye.distance(point));
        let sight = if !inside {
            Sight::Outside
        } else if normal.dot(eye - point) <= 0.0 {
            Sight::Away
        } else {
            let front = towards(&mut self.meshes, scene, registry, [eye, point])
                .filter(|(_, place)| eye.distance(*place) + nearer < eye.distance(point));
            front.map_or(Sight::Clear, |(other, _)| Sight::Behind(other))
        };
        Some((explanation(shot, pixel, Some(found), None), sight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_anchor_goes_with_its_object() {
        let mut object = Object { position: Vec3::new(1.0, 2.0, 3.0), size: 2.0, ..Object::default() };
        object.rotation = Vec3::new(10.0, 20.0, 30.0);
        let anchor = Anchor::of(&object, Vec3::new(1.5, 2.5, 2.0), Vec3::Y);
        assert!(anchor.place(&object).abs_diff_eq(Vec3::new(1.5, 2.5, 2.0), 1e-5));
        object.position += Vec3::X;
        assert!(anchor.place(&object).abs_diff_eq(Vec3::new(2.5, 2.5, 2.0), 1e-5));
        object.size = 4.0;
        assert!(anchor.place(&object).abs_diff_eq(Vec3::new(3.0, 3.0, 1.0), 1e-5));
    }

    #[test]
    fn a_point_behind_the_observer_is_in_no_pixel() {
        let observer = Observer { position: Vec3::ZERO, field_of_view: 90.0, ..Observer::default() };
        assert_eq!(pixel_of(&observer, [8, 4], Vec3::new(0.1, 0.1, -1.0)), ([4, 1], true));
        assert_eq!(pixel_of(&observer, [8, 4], Vec3::new(9.0, -9.0, -1.0)), ([7, 3], false));
        assert!(!pixel_of(&observer, [8, 4], Vec3::new(0.1, 0.1, 1.0)).1);
        assert!(!pixel_of(&observer, [8, 4], Vec3::ZERO).1);
    }
}
