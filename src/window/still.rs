//! The picture stays where it is while only the panels are drawn anew: thousands of objects take seconds where
//! the graphics card is a program, and a pointer that moves over the panels must not cost them.
//!
//! The camera of the picture has a texture of its own, which nothing else draws into. In a frame in which
//! nothing of the picture changed, the camera sees no object and clears nothing, so the texture is shown again.

use bevy::{
    app::{App, Plugin, PostUpdate},
    asset::AssetEvent,
    camera::{
        Camera, CameraMainTextureUsages, ClearColorConfig, Projection,
        visibility::{RenderLayers, VisibilitySystems},
    },
    core_pipeline::tonemapping::Tonemapping,
    ecs::{prelude::*, system::SystemParam},
    mesh::Mesh,
    prelude::Shader,
    render::{render_resource::TextureUsages, storage::ShaderBuffer, view::Msaa},
    transform::components::Transform,
    window::{PrimaryWindow, Window, WindowOccluded, WindowResized},
};
use glam::UVec2;

use crate::{
    app::ShownTerms,
    observer::camera::PictureCamera,
    panel::state::{Lab, Selection, View},
    reflection::swap::Drawn,
    registry::Registry,
    scene::spawn::CurrentScene,
    shader::live::LiveShaders,
};

/// Scenes of fewer objects are drawn in every frame.
const MANY: usize = 256;
/// So many frames are drawn after a change.
const FRAMES: u32 = 2;

pub(super) struct StillPlugin;

impl Plugin for StillPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Stillness>().add_systems(
            PostUpdate,
            keep.after(super::fit_viewport).before(VisibilitySystems::CheckVisibility),
        );
    }
}

/// The usages of the textures of the picture's camera. Cameras with equal ones share their textures; no other
/// has these.
pub(super) fn own_texture() -> CameraMainTextureUsages {
    CameraMainTextureUsages::default().with(TextureUsages::COPY_DST)
}

/// The rest of what the picture shows, beside the scene.
#[derive(Clone, PartialEq)]
struct Look {
    view: View,
    selection: Selection,
    transform: Transform,
    /// Field of view and aspect of the lens.
    lens: Option<[f32; 2]>,
    viewport: Option<[UVec2; 2]>,
    window: UVec2,
    scale: f32,
    focused: bool,
}

#[derive(Default, Resource)]
pub(super) struct Stillness {
    last: Option<Look>,
    /// How many frames are still to be drawn.
    frames: u32,
}

impl Stillness {
    /// True once the picture has been drawn as it is.
    pub(super) fn is_at_rest(&self) -> bool {
        self.frames == 0
    }
}

/// The sources of changes that say so themselves.
#[derive(SystemParam)]
pub(super) struct Changes<'w, 's> {
    scene: Res<'w, CurrentScene>,
    terms: Res<'w, ShownTerms>,
    registry: Res<'w, Registry>,
    live: Res<'w, LiveShaders>,
    drawn: Query<'w, 's, (), Changed<Drawn>>,
    shaders: MessageReader<'w, 's, AssetEvent<Shader>>,
    meshes: MessageReader<'w, 's, AssetEvent<Mesh>>,
    buffers: MessageReader<'w, 's, AssetEvent<ShaderBuffer>>,
    occluded: MessageReader<'w, 's, WindowOccluded>,
    resized: MessageReader<'w, 's, WindowResized>,
}

impl Changes<'_, '_> {
    fn any(&mut self) -> bool {
        // All are read, so that none is left over for the next frame.
        let told = [
            self.shaders.read().count(),
            self.meshes.read().count(),
            self.buffers.read().count(),
            self.occluded.read().count(),
            self.resized.read().count(),
        ];
        told.iter().any(|count| *count > 0)
            || self.scene.is_changed()
            || self.terms.is_changed()
            || self.registry.is_changed()
            || self.live.is_busy()
            || !self.drawn.is_empty()
    }
}

type Picture = (
    Entity,
    &'static mut Camera,
    &'static mut Tonemapping,
    &'static Transform,
    &'static Projection,
    &'static Msaa,
    Option<&'static RenderLayers>,
);

pub(super) fn keep(
    lab: Res<Lab>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut changes: Changes,
    mut stillness: ResMut<Stillness>,
    mut cameras: Query<Picture, With<PictureCamera>>,
    mut commands: Commands,
) {
    let changed = changes.any();
    let Ok((entity, mut camera, mut tone, transform, projection, msaa, layers)) = cameras.single_mut() else {
        return;
    };
    let look = Look {
        view: lab.view.clone(),
        selection: lab.selection,
        transform: *transform,
        lens: match projection {
            Projection::Perspective(lens) => Some([lens.fov, lens.aspect_ratio]),
            _ => None,
        },
        viewport: camera.viewport.as_ref().map(|v| [v.physical_position, v.physical_size]),
        window: window.physical_size(),
        scale: window.scale_factor(),
        focused: window.focused,
    };
    if changed || stillness.last.as_ref() != Some(&look) {
        stillness.last = Some(look);
        stillness.frames = FRAMES;
    }
    // With several samples per pixel, the texture that is kept is not the one that is shown.
    let still = stillness.frames == 0 && *msaa == Msaa::Off && changes.scene.0.objects.len() >= MANY;
    stillness.frames = stillness.frames.saturating_sub(1);
    if still {
        camera.clear_color = ClearColorConfig::None;
        // What is kept was tone mapped already.
        *tone = Tonemapping::None;
        if layers.is_none() {
            commands.entity(entity).insert(RenderLayers::none());
        }
    } else if layers.is_some() {
        commands.entity(entity).remove::<RenderLayers>();
    }
}

#[cfg(test)]
mod tests {
    use bevy::{app::Update, color::Color};

    use super::*;
    use crate::scene::{Object, Scene};

    /// An app with a window and a scene of so many objects, without a renderer.
    fn app(objects: usize, msaa: Msaa) -> App {
        let mut app = App::new();
        let scene = Scene { objects: vec![Object::default(); objects], ..Scene::default() };
        app.insert_resource(Lab::new(scene.clone()))
            .insert_resource(CurrentScene(scene))
            .insert_resource(Registry::builtin())
            .init_resource::<ShownTerms>()
            .init_resource::<LiveShaders>()
            .init_resource::<Stillness>()
            .add_message::<AssetEvent<Shader>>()
            .add_message::<AssetEvent<Mesh>>()
            .add_message::<AssetEvent<ShaderBuffer>>()
            .add_message::<WindowOccluded>()
            .add_message::<WindowResized>()
            .add_systems(Update, keep);
        app.world_mut().spawn((Window::default(), PrimaryWindow));
        app.world_mut().spawn((
            Camera::default(),
            PictureCamera { follows_observer: true, fits_width: true },
            Tonemapping::AgX,
            Transform::default(),
            Projection::default(),
            msaa,
        ));
        app
    }

    /// True if the next frame draws the objects.
    fn draws(app: &mut App) -> bool {
        let world = app.world_mut();
        let mut cameras = world.query::<(&mut Camera, &mut Tonemapping)>();
        for (mut camera, mut tone) in cameras.iter_mut(world) {
            // As the systems before it do in every frame.
            camera.clear_color = ClearColorConfig::Custom(Color::BLACK);
            *tone = Tonemapping::AgX;
        }
        app.update();
        let world = app.world_mut();
        let mut cameras = world.query::<(&Camera, &Tonemapping, Option<&RenderLayers>)>();
        let (camera, tone, layers) = cameras.single(world).expect("there is one camera");
        let facts = [
            !matches!(camera.clear_color, ClearColorConfig::None),
            *tone != Tonemapping::None,
            layers.is_none(),
        ];
        assert!(facts.iter().all(|fact| *fact == facts[0]), "{facts:?}");
        facts[0]
    }

    /// Lets the picture come to rest.
    fn rest(app: &mut App) {
        for _ in 0..2 * FRAMES {
            draws(app);
        }
        assert!(!draws(app));
    }

    #[test]
    fn a_picture_of_many_objects_is_drawn_when_it_changes_and_then_stands_still() {
        let mut app = app(MANY, Msaa::Off);
        assert!(draws(&mut app) && draws(&mut app));
        rest(&mut app);
        let changes: [(&str, fn(&mut World)); 7] = [
            ("an object", |w| w.resource_mut::<CurrentScene>().0.objects[3].size = 1.0),
            ("the terms", |w| w.resource_mut::<ShownTerms>().set_changed()),
            ("the models", |w| w.resource_mut::<Registry>().set_changed()),
            ("the selection", |w| w.resource_mut::<Lab>().selection = Selection::Observer),
            ("what is shown", |w| w.resource_mut::<Lab>().view.show_room ^= true),
            ("the camera", |w| {
                let mut cameras = w.query_filtered::<&mut Transform, With<PictureCamera>>();
                cameras.single_mut(w).expect("there is one camera").translation.x += 1.0;
            }),
            ("a table", |w| {
                let id = bevy::asset::AssetId::default();
                w.write_message(AssetEvent::<ShaderBuffer>::Modified { id });
            }),
        ];
        for (what, change) in changes {
            change(app.world_mut());
            assert!(draws(&mut app), "{what}");
            rest(&mut app);
        }
    }

    #[test]
    fn few_objects_and_several_samples_are_drawn_in_every_frame() {
        for mut app in [app(MANY - 1, Msaa::Off), app(MANY, Msaa::Sample4)] {
            assert!((0..10).all(|_| draws(&mut app)));
        }
    }
}
