//! The order in which shapes get their meshes if they do not all fit into memory, and in which objects are drawn if they are
//! too many for one frame: those in the pictures first, the nearest before the others.

use bevy::{
    camera::{
        CameraProjection as _,
        primitives::{Frustum, Sphere},
    },
    prelude::*,
};

use super::{camera::PictureCamera, entities::CurrentScene, meshes::Need, shown::Shown};
use crate::{
    registry::Registry,
    scene::{
        Object,
        observer::{ViewAngle, rotation},
    },
};

/// The view of a window's camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    pub(super) place: Transform,
    sees: Frustum,
}

impl Eye {
    /// The priority of a shape within a sphere.
    fn need(&self, centre: Vec3, radius: f32) -> Need {
        let sphere = Sphere { center: centre.into(), radius };
        let distance = centre.distance(self.place.translation);
        Need { hidden: !self.sees.intersects_sphere(&sphere, false), distance }
    }
}

/// The cameras of windows. Cameras of single pictures, which draw everything eventually, do not count.
pub(super) fn eyes(world: &mut World) -> Vec<Eye> {
    eyes_of(world, |camera| camera.fits_width)
}

/// The cameras of windows and of single pictures.
pub(super) fn all_eyes(world: &mut World) -> Vec<Eye> {
    eyes_of(world, |_| true)
}

fn eyes_of(world: &mut World, counts: impl Fn(&PictureCamera) -> bool) -> Vec<Eye> {
    let observer = world.resource::<Shown>().observer;
    let keeps = world.resource::<CurrentScene>().0.view_angle().keeps;
    let angle = ViewAngle { degrees: observer.field_of_view, keeps };
    let mut cameras = world.query::<(&PictureCamera, &Transform, &Projection)>();
    let eye = |(camera, place, lens): (&PictureCamera, &Transform, &Projection)| {
        let Projection::Perspective(lens) = lens else { return None };
        // Cameras get their transforms and angles later in the frame.
        let place = if camera.follows_observer {
            Transform::from_translation(observer.position).with_rotation(rotation(observer.direction))
        } else {
            *place
        };
        let lens = PerspectiveProjection { fov: angle.vertical(lens.aspect_ratio), ..lens.clone() };
        let sees = || lens.compute_frustum(&place.into());
        counts(camera).then(|| Eye { place, sees: sees() })
    };
    cameras.iter(world).filter_map(eye).collect()
}

/// The priority of an object's shape.
pub(super) fn need(
    eyes: &[Eye],
    world: &World,
    registry: &Registry,
    entity: Entity,
    object: &Object,
) -> Need {
    let (Some(place), Some(shape)) = (world.get::<Transform>(entity), registry.shape(&object.object_type))
    else {
        return Need::default();
    };
    if eyes.is_empty() {
        return Need::default();
    }
    let radius = shape.bounds(&object.shape).radius * place.scale.max_element();
    let needs = eyes.iter().map(|eye| eye.need(place.translation, radius));
    needs.min_by(Need::order).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use glam::Quat;

    use super::*;
    use crate::scene::{Observer, Scene};

    #[test]
    fn what_the_window_shows_comes_first_and_the_nearest_before_the_others() {
        let mut world = World::new();
        let scene = Scene::default();
        world.insert_resource(Shown { observer: scene.observer, ..Shown::default() });
        world.insert_resource(CurrentScene(scene));
        let registry = Registry::builtin();
        let single = PictureCamera { follows_observer: true, fits_width: false };
        world.spawn((single, Transform::IDENTITY, Projection::default()));
        assert!(eyes(&mut world).is_empty(), "single pictures have everything");
        assert_eq!(all_eyes(&mut world).len(), 1);
        let window = PictureCamera { follows_observer: true, fits_width: true };
        let camera = world.spawn((window, Transform::IDENTITY, Projection::default())).id();
        let Observer { position: eye, .. } = world.resource::<Shown>().observer;
        let object = Object::default();
        let places = [
            // Behind, far to the side, far ahead, near, and near with only a part in the picture.
            eye + Vec3::new(0.0, 0.0, 3.0),
            eye + Vec3::new(6.0, 0.0, -3.0),
            eye + Vec3::new(0.0, 0.0, -8.0),
            eye + Vec3::new(0.0, 0.0, -3.0),
            eye + Vec3::new(0.0, -3.3, -4.0),
        ];
        let entities = places.map(|place| world.spawn(Transform::from_translation(place)).id());
        let order = |world: &mut World| {
            let eyes = eyes(world);
            let mut order: Vec<_> = (0..places.len()).collect();
            let need = |i: usize| need(&eyes, world, &registry, entities[i], &object);
            order.sort_by(|a, b| need(*a).order(&need(*b)));
            order
        };
        assert_eq!(order(&mut world), [3, 4, 2, 0, 1]);
        // A camera moved by the user, looking back.
        let back = Transform::from_translation(eye).with_rotation(Quat::from_rotation_y(2.0 * FRAC_PI_2));
        let free = PictureCamera { follows_observer: false, fits_width: true };
        world.entity_mut(camera).insert((free, back));
        assert_eq!(order(&mut world)[0], 0);
    }
}
