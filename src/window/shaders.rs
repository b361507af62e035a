//! Shaders and custom models of the window: reads them at the start and after changes, and reports their problems.

use std::{
    io::{self, IsTerminal as _},
    path::{Path, PathBuf},
};

use bevy::{prelude::*, window::PrimaryWindow};

use super::{
    order::Loading,
    redraw::{SETTLING_FRAMES, Settling},
    views::ShownViews,
    watching::{FileWatch, FilesChanged, complain, complain_in_colour, waker},
};
use crate::files::Shown as _;
use crate::{
    custom,
    library::{
        assets::{self, Folders},
        status::{Trouble, shown_instead},
    },
    panel::state::{Session, Severity},
    registry::Registry,
    render::{
        live::{LiveShaders, NeededShaders},
        overrides::Overrides,
        schedule::{LabFrame, LabSystems},
        stage::ViewCopy,
        swap::AwaitsShader,
        trial::{
            Bench,
            process::{Budget, TrialProcess},
        },
    },
    shader::report::{annotated, coloured},
};

/// Reads the shaders and custom models in the registry's folders, watches them, and reports their problems.
#[derive(Clone, Debug, Default)]
pub struct ShaderFilesPlugin {
    /// The program that tests shaders when called with [`COMMAND`](crate::render::trial::process::COMMAND); `None` to
    /// test them in this program, between frames.
    pub trial_program: Option<PathBuf>,
}

/// Reports to the panels which pictures lag behind the scene because a shader is not ready.
fn feed_compiling(
    waiting: Query<Option<&ViewCopy>, With<AwaitsShader>>,
    views: ShownViews,
    needed: NeededShaders,
    mut session: ResMut<Session>,
    settling: Option<ResMut<Settling>>,
) {
    let shown = session.views_shown();
    let is_behind = |view: usize| {
        let wanted = Overrides::of_view(needed.scene(), view);
        match views.find(view) {
            Some(now) if now.has_shaders_of(wanted.as_ref()) => waiting.iter().any(|copy| now.shows(copy)),
            // Its camera gets the overrides later in this frame, and the objects their shaders in the next one.
            _ => needed.lacks_one(wanted.as_ref()),
        }
    };
    let compiling = std::array::from_fn(|view| shown.contains(&view) && is_behind(view));
    let known = &mut session.bypass_change_detection().facts.compiling;
    if std::mem::replace(known, compiling) != compiling
        && let Some(mut settling) = settling
    {
        settling.draw(SETTLING_FRAMES);
    }
}

impl Plugin for ShaderFilesPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            LabFrame,
            (follow.in_set(Loading::Shaders), (tell, feed_compiling).chain().in_set(LabSystems::Upload)),
        );
    }

    fn finish(&self, app: &mut App) {
        let world = app.world_mut();
        if let Some(program) = &self.trial_program {
            let process = TrialProcess::new(program.clone(), Budget::default(), waker(world));
            world.resource_mut::<Bench>().try_in(process);
        }
        let wake = waker(world);
        let has_window = world.query_filtered::<(), With<PrimaryWindow>>().iter(world).next().is_some();
        let mut live = world.resource_mut::<LiveShaders>();
        live.read_apart(wake);
        if has_window {
            live.announce();
        }
        open(world);
    }
}

/// Reads the shaders of the registry's folders and watches them. Custom models are registered already; invalid shaders
/// are replaced by the built-in ones and reported.
fn open(world: &mut World) {
    let mut registry = world.resource_mut::<Registry>();
    let folders = registry.folders().clone();
    let unreadable = match &folders.shaders {
        Some(folder) => assets::read_shaders(folder, &mut registry).err().unwrap_or_default(),
        None => Vec::new(),
    };
    let of_extensions = assets::read_extensions(&mut registry).err().unwrap_or_default();
    // Their problems are found when they are read. Models with a valid declaration are read when the scene uses them.
    let declared = |path: &PathBuf| custom::id_of(path).is_some_and(|id| registry.unread_file(id).is_some());
    let broken: Vec<_> = folders
        .models
        .iter()
        .flat_map(|folder| custom::folder::files_in(folder).unwrap_or_default())
        .filter(|path| !declared(path))
        .chain(unreadable.into_iter().chain(of_extensions).map(|(path, _)| path))
        .collect();
    world.resource_mut::<LiveShaders>().start();
    reread(world, &broken);
    let Some(mut watch) = world.get_resource_mut::<FileWatch>() else { return };
    for folder in folders.shaders.iter().chain(&folders.models).chain(&folders.extensions) {
        watch.0.watch_folder(folder);
    }
}

/// Switches to shaders from another folder, and to custom models from there unless the current folder of custom models
/// exists.
pub(super) fn move_to(world: &mut World, folder: &Path) {
    let folders = match Folders::find(Some(folder), None) {
        Ok(folders) => folders,
        Err(why) => return world.resource_mut::<Session>().say(Severity::Error, why.to_string()),
    };
    let mut registry = world.resource_mut::<Registry>();
    if let Some(shaders) = &folders.shaders {
        registry.set_shader_folder(shaders);
    }
    if !registry.custom_folder().is_some_and(Path::is_dir)
        && let Some(models) = &folders.models
    {
        // Their problems are reported when the models are checked.
        let _ = custom::folder::declare_folder(models, &mut registry);
    }
    open(world);
}

/// Checks changed files.
fn follow(world: &mut World, mut last: Local<bevy::ecs::message::MessageCursor<FilesChanged>>) {
    let changed: Vec<_> = {
        let messages = world.resource::<Messages<FilesChanged>>();
        last.read(messages).flat_map(|files| files.0.clone()).collect()
    };
    reread(world, &changed);
}

fn reread(world: &mut World, files: &[PathBuf]) {
    if files.is_empty() {
        return;
    }
    world.resource_scope(|world, mut live: Mut<LiveShaders>| {
        let mut registry = world.resource_mut::<Registry>();
        // Systems waiting for another model are notified once it was tested.
        files.iter().for_each(|file| live.reread(file, registry.bypass_change_detection()));
    });
}

/// Reports the state of the shaders to the panels and to standard error.
fn tell(live: Res<LiveShaders>, mut session: ResMut<Session>, mut troubled: Local<bool>) {
    let status = live.status();
    // A problem may have been replaced by one that is too recent to be reported.
    if *troubled && status.troubles.is_empty() && live.is_up_to_date() {
        *troubled = false;
        complain("All shaders are up to date again.");
    }
    *troubled |= !status.troubles.is_empty();
    if session.shaders == *status {
        return;
    }
    let known =
        |troubles: &[Trouble], trouble: &Trouble| troubles.iter().any(|t| t.problem == trouble.problem);
    for trouble in status.troubles.iter().filter(|t| !known(&session.shaders.troubles, t)) {
        let file =
            trouble.path.as_ref().map_or_else(|| trouble.problem.file.clone(), |p| p.shown().to_string());
        if io::stderr().is_terminal() {
            complain_in_colour(&coloured(&trouble.problem, &file));
        } else {
            complain(&annotated(&trouble.problem, &file));
        }
        if !trouble.stale.is_empty() {
            complain(&format!("The picture shows {}.", shown_instead(&trouble.stale)));
        }
    }
    session.shaders = status.clone();
}

#[cfg(test)]
mod tests {
    use bevy::{camera::RenderTarget, ecs::system::RunSystemOnce as _};

    use super::*;
    use crate::{
        render::{entities::CurrentScene, shown::Shown, view::View},
        scene::{Comparison, Scene, Variant, comparison::Layout},
        window::{WindowView, views::OtherView},
    };

    #[test]
    fn a_view_is_behind_until_its_camera_has_the_overrides_and_its_objects_have_their_shaders() {
        let scene = |model: &str| Scene {
            variants: vec![Variant { reflection_model: Some(model.to_owned()), ..Variant::default() }],
            comparison: Comparison { layout: Layout::SideBySide, ..Comparison::default() },
            ..Scene::default()
        };
        let mut live = LiveShaders::default();
        live.announce();
        let mut world = World::new();
        world.insert_resource(Registry::builtin());
        world.insert_resource(CurrentScene(scene("openpbr")));
        world.insert_resource(Session::new(scene("openpbr")));
        world.insert_resource(live);
        world.init_resource::<Shown>();
        let behind = |world: &mut World| {
            world.run_system_once(feed_compiling).expect("it runs");
            world.resource::<Session>().facts.compiling
        };
        let view = || (View::for_display(UVec2::ONE), RenderTarget::None { size: UVec2::ONE });
        world.spawn((WindowView, view()));
        assert_eq!(behind(&mut world), [false, true, false, false], "B has no camera yet");
        let overrides = Overrides::of_view(&scene("openpbr"), 1).expect("it is a variant");
        let b = world.spawn((OtherView(1), view(), overrides)).id();
        assert_eq!(behind(&mut world), [false; 4]);
        let copy = world.spawn((AwaitsShader, ViewCopy { view: b })).id();
        assert_eq!(behind(&mut world), [false, true, false, false], "an object waits in B");
        world.despawn(copy);
        let object = world.spawn(AwaitsShader).id();
        assert_eq!(behind(&mut world), [true, false, false, false], "an object waits in A");
        world.despawn(object);
        world.insert_resource(CurrentScene(scene("glass")));
        assert_eq!(behind(&mut world), [false, true, false, false], "the camera has the model of before");
    }
}
