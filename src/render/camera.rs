//! The camera of the picture: it stays at the observer until someone moves it.

use super::{
    entities::CurrentScene,
    overrides::Overrides,
    shown::Shown,
    stage::{GIZMO_LAYER, SCENE_LAYER},
    view::View,
};
use crate::{
    optics::{colour::BACKGROUND, tone::ToneMapping},
    scene::{
        Observer,
        observer::{NEAR, ViewAngle, rotation},
    },
};
use bevy::{
    camera::{Hdr, visibility::RenderLayers},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    light::cluster::ClusterConfig,
    prelude::*,
};

/// The camera that draws the picture.
#[derive(Component, Debug, Clone, Copy)]
pub struct PictureCamera {
    /// True if the camera is at the scene's observer; false once a user has moved it.
    pub follows_observer: bool,
    /// True if a narrow picture shows more above and below, so that less is cut off at the sides, as in
    /// [`Scene::view_angle`](crate::scene::Scene::view_angle): for windows, whose panels take up width.
    pub fits_width: bool,
}

/// Marks a picture for display, which was spawned with [`Hdr`]. The component is added or removed as the
/// display settings require half floats.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct ForDisplay {
    /// True if the picture is drawn [straight](super::straight::Straight) into its texture.
    pub(super) straight: bool,
}

/// The components of a camera for the picture. For a picture to be displayed, add [`Hdr`]: it is tone mapped
/// and encoded, from half floats where this takes separate passes. Without it, the target receives the linear
/// values.
#[must_use]
pub fn picture_camera(samples: u8) -> impl Bundle {
    let ([r, g, b], fov) = (BACKGROUND, Observer::default().field_of_view.to_radians());
    (
        PictureCamera { follows_observer: true, fits_width: false },
        Camera3d::default(),
        Camera { clear_color: ClearColorConfig::Custom(Color::srgb_u8(r, g, b)), ..default() },
        Projection::Perspective(PerspectiveProjection { fov, near: NEAR, ..default() }),
        Tonemapping::None,
        // Bevy's lights are not used.
        ClusterConfig::Single,
        // Dithering would make pictures differ between runs and renderers.
        DebandDither::Disabled,
        RenderLayers::from_layers(&[SCENE_LAYER, GIZMO_LAYER]),
        if samples == 4 { Msaa::Sample4 } else { Msaa::Off },
    )
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

/// Gives the lens of every picture camera its angle, for the size of the picture that is about to be drawn.
pub(super) fn aim(
    scene: Res<CurrentScene>,
    shown: Res<Shown>,
    mut cameras: Query<(&PictureCamera, Option<&View>, &mut Projection)>,
) {
    for (camera, view, mut lens) in &mut cameras {
        let Projection::Perspective(perspective) = &*lens else { continue };
        // The camera knows its size only after the first picture of that size.
        let size = view.map(|view| view.inset.map_or(view.size, |inset| inset.size()).as_vec2());
        let size = size.filter(|size| size.min_element() > 0.0);
        let aspect = size.map_or(perspective.aspect_ratio, |size| size.x / size.y);
        let keeps = if camera.fits_width { scene.0.view_angle().keeps } else { 0.0 };
        let fov = ViewAngle { degrees: shown.observer.field_of_view, keeps }.vertical(aspect);
        if perspective.fov != fov
            && let Projection::Perspective(perspective) = &mut *lens
        {
            perspective.fov = fov;
        }
    }
}

/// Keeps cameras that follow the observer at the observer's position, and updates the tone mapping of every picture
/// camera.
pub fn follow_scene(
    scene: Res<CurrentScene>,
    shown: Res<Shown>,
    mut cameras: Query<(
        &PictureCamera,
        Option<&Overrides>,
        &mut Transform,
        &mut Tonemapping,
        (Has<Hdr>, Has<ForDisplay>),
    )>,
) {
    let observer = &shown.observer;
    for (camera, overrides, mut transform, mut tone, (hdr, display)) in &mut cameras {
        if camera.follows_observer {
            let wanted =
                Transform::from_translation(observer.position).with_rotation(rotation(observer.direction));
            transform.set_if_neq(wanted);
        }
        let seen = hdr || display;
        let display = overrides.map_or(scene.0.display, |o| o.seen_through(&scene.0));
        let wanted = if seen { tonemapping(display.tone_mapping) } else { Tonemapping::None };
        tone.set_if_neq(wanted);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, Variant, comparison::Layout};

    #[test]
    fn the_first_picture_of_a_size_has_its_angle() {
        let mut scene = Scene { variants: vec![Variant::default()], ..Scene::default() };
        scene.comparison.layout = Layout::SideBySide;
        let wanted = scene.view_angle().vertical(0.5);
        let mut app = App::new();
        app.insert_resource(Shown { observer: scene.observer, ..Shown::default() })
            .insert_resource(CurrentScene(scene))
            .add_systems(Update, aim);
        let camera = PictureCamera { follows_observer: true, fits_width: true };
        let view = View::for_display(UVec2::new(300, 600));
        let camera = app.world_mut().spawn((view, picture_camera(1))).insert(camera).id();
        app.update();
        let Some(Projection::Perspective(lens)) = app.world().get(camera) else { panic!("it has a lens") };
        assert!((lens.fov - wanted).abs() < 1e-6 && lens.fov > 1.0, "{}", lens.fov);
    }
}
