//! The camera of the picture: it stands where the observer stands until someone moves it.

use bevy::{
    camera::{Camera, Camera3d, ClearColorConfig, Hdr, PerspectiveProjection, Projection},
    color::Color,
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    ecs::prelude::*,
    render::view::Msaa,
    transform::components::Transform,
};

use super::{NEAR, rotation};
use crate::{
    optics::{colour::BACKGROUND, tone::ToneMapping},
    scene::{Observer, spawn::CurrentScene},
};

/// The camera that draws the picture.
#[derive(Component, Debug, Clone, Copy)]
pub struct PictureCamera {
    /// Whether it stands at the scene's observer; free once a user has moved it.
    pub follows_observer: bool,
    /// Whether a picture that is narrower than [`WIDE`] shows more above and below, so that what a
    /// wide picture shows at the sides is not cut off: for windows, whose panels take width.
    pub fits_width: bool,
}

/// Width/height of the pictures that scenes are composed for.
pub const WIDE: f32 = 16.0 / 9.0;

/// The vertical field of view in radians of a picture of the given width/height.
#[must_use]
pub fn vertical_field_of_view(degrees: f32, aspect: f32, fits_width: bool) -> f32 {
    let radians = degrees.to_radians();
    if !fits_width || aspect >= WIDE || aspect <= 0.0 {
        return radians;
    }
    2.0 * ((radians * 0.5).tan() * WIDE / aspect).atan()
}

/// The parts of a camera for the picture. For a picture that people see, add [`Hdr`]: it is drawn into
/// half floats and tone mapped in a pass of its own; without, the target gets the linear values.
#[must_use]
pub fn picture_camera(samples: u8) -> impl Bundle {
    (
        PictureCamera { follows_observer: true, fits_width: false },
        Camera3d::default(),
        Camera {
            clear_color: ClearColorConfig::Custom(Color::srgb_u8(
                BACKGROUND[0],
                BACKGROUND[1],
                BACKGROUND[2],
            )),
            ..Camera::default()
        },
        projection(&Observer::default()),
        Tonemapping::None,
        // Dithering would make pictures differ between runs and renderers.
        DebandDither::Disabled,
        if samples == 4 { Msaa::Sample4 } else { Msaa::Off },
    )
}

fn projection(observer: &Observer) -> Projection {
    Projection::Perspective(PerspectiveProjection {
        fov: observer.field_of_view.to_radians(),
        near: NEAR,
        ..PerspectiveProjection::default()
    })
}

/// The renderer's pass for a tone mapping.
#[must_use]
pub fn tonemapping(tone: ToneMapping) -> Tonemapping {
    match tone {
        ToneMapping::None => Tonemapping::None,
        ToneMapping::Reinhard => Tonemapping::Reinhard,
        ToneMapping::ReinhardLuminance => Tonemapping::ReinhardLuminance,
        ToneMapping::Aces => Tonemapping::AcesFitted,
        ToneMapping::AgX => Tonemapping::AgX,
        ToneMapping::TonyMcMapface => Tonemapping::TonyMcMapface,
        ToneMapping::BlenderFilmic => Tonemapping::BlenderFilmic,
        ToneMapping::KhronosPbrNeutral => Tonemapping::KhronosPbrNeutral,
    }
}

/// Keeps cameras that follow the observer at its place, and every picture camera's field of view and
/// tone mapping at the scene's.
pub fn follow_scene(
    scene: Res<CurrentScene>,
    mut cameras: Query<(&PictureCamera, &mut Transform, &mut Projection, &mut Tonemapping, Has<Hdr>)>,
) {
    let observer = &scene.0.observer;
    for (camera, mut transform, mut lens, mut tone, hdr) in &mut cameras {
        if camera.follows_observer {
            let wanted =
                Transform::from_translation(observer.position).with_rotation(rotation(observer.direction));
            if *transform != wanted {
                *transform = wanted;
            }
        }
        let Projection::Perspective(perspective) = &*lens else { continue };
        let fov = vertical_field_of_view(observer.field_of_view, perspective.aspect_ratio, camera.fits_width);
        if perspective.fov != fov
            && let Projection::Perspective(perspective) = &mut *lens
        {
            perspective.fov = fov;
        }
        let wanted = if hdr { tonemapping(scene.0.display.tone_mapping) } else { Tonemapping::None };
        if *tone != wanted {
            *tone = wanted;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_window_shows_what_a_wide_picture_shows_at_the_sides() {
        let half_width = |aspect: f32| (vertical_field_of_view(45.0, aspect, true) * 0.5).tan() * aspect;
        assert!((half_width(1.1) - half_width(WIDE)).abs() < 1e-6);
        assert!((half_width(0.5) - half_width(WIDE)).abs() < 1e-6);
        assert_eq!(vertical_field_of_view(45.0, 2.5, true), 45f32.to_radians());
        assert_eq!(vertical_field_of_view(45.0, 1.1, false), 45f32.to_radians());
    }
}
