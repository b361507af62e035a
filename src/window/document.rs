//! The document of the window: files, history, and synchronisation with the displayed scene in both directions.

use std::{collections::BTreeSet, path::Path};

use bevy::prelude::*;

use super::{
    ViewOptions,
    editor::Editors,
    effects::{Unattended, carry_out},
    exports::Exports,
    files::DiskFiles,
    finite::report_light_that_is_not_finite,
    laws::LawChecks,
    lessons::follow_lesson,
    manual::Manuals,
    matching::Matches,
    order::Loading,
    plots::PlotFiles,
    sheets::SheetFiles,
    solids::report_glass,
    views::ShownChannels,
    watching::{FileWatch, FilesChanged, complain},
};
use crate::{
    custom::folder::declare_folder,
    library::assets::Folders,
    panel::{
        effects,
        files::Files as _,
        follow::follow_registry,
        progress, settings,
        state::{Action, Effect, LessonCommand, Session, Severity},
    },
    registry::Registry,
    render::{
        absorb::absorb,
        entities::{CurrentScene, SceneEntities},
        exchange::Changes,
        illumination::ShownTerms,
        meshes::ShapeMeshes,
        schedule::{LabFrame, LabSystems},
        typed::know_types,
    },
    scene::{
        error::LoadError,
        load::{self, Defaults},
    },
    text::sentence,
};

/// The document: [`Session`], its files, and the synchronisation with the scene. The scene may use everything
/// registered with the app before it starts.
#[derive(Clone, Debug, Default)]
pub struct DocumentPlugin {
    /// The scene and further start options.
    pub options: ViewOptions,
    /// True if there is a user, with settings and custom models.
    pub for_user: bool,
}

impl Plugin for DocumentPlugin {
    fn build(&self, app: &mut App) {
        let options = &self.options;
        let mut session = Session::new(options.scene.clone());
        session.path.clone_from(&options.file);
        session.outside.clone_from(&options.outside);
        session.disk.use_defaults = options.use_defaults;
        session.view.examples_open = options.examples;
        if self.for_user {
            restore(&mut session);
        } else {
            app.insert_resource(Unattended);
        }
        options.warnings.iter().for_each(|warning| session.say(Severity::Warning, warning.as_str()));
        let steps = (
            Loading::Watch,
            Loading::Shaders,
            Loading::Follow,
            Loading::Effects,
            Loading::Recovery,
            Loading::Pick,
            Loading::Publish,
        );
        app.insert_resource(session)
            .insert_resource(CurrentScene(options.scene.clone()))
            .insert_resource(DiskFiles::new(options.file.clone(), options.stamp))
            .init_resource::<Exports>()
            .init_resource::<ShownChannels>()
            .init_resource::<Matches>()
            .init_resource::<PlotFiles>()
            .init_resource::<SheetFiles>()
            .insert_resource(LawChecks::by(options.trial_program.clone()))
            .init_resource::<Editors>()
            .init_resource::<Manuals>()
            .add_message::<Effect>()
            .add_message::<FilesChanged>()
            .configure_sets(LabFrame, steps.chain().in_set(LabSystems::Load))
            .add_systems(
                LabFrame,
                (
                    follow_parameters
                        .after(Loading::Shaders)
                        .before(Loading::Follow)
                        .in_set(LabSystems::Load),
                    follow_lesson
                        .after(Loading::Follow)
                        .before(Loading::Effects)
                        .in_set(LabSystems::Load)
                        .run_if(resource_exists::<FileWatch>),
                    carry_out.in_set(Loading::Effects),
                    publish.in_set(Loading::Publish).run_if(resource_changed::<Session>),
                    (report_light_that_is_not_finite, report_glass)
                        .chain()
                        .after(Loading::Publish)
                        .in_set(LabSystems::Load)
                        .run_if(resource_changed::<Session>.or_else(resource_changed::<Registry>)),
                    take_over.in_set(LabSystems::Edit).after(absorb),
                ),
            );
    }

    fn finish(&self, app: &mut App) {
        let world = app.world_mut();
        world.resource_scope(|world, mut session: Mut<Session>| {
            let mut registry = world.get_resource_or_init::<Registry>();
            match self.options.registry.clone() {
                Some(mut known) => {
                    known.add_missing(&registry);
                    *registry = known;
                }
                None if self.for_user => {
                    let declared = declare_custom(&mut registry);
                    declared.err().into_iter().for_each(|why| session.say(Severity::Error, why));
                }
                None => {}
            }
            session.model_slots.fill(&registry);
            let mut effects = Vec::new();
            if let Some(file) = &self.options.open {
                let registry = registry.clone();
                effects = open(
                    file,
                    &mut session,
                    &registry,
                    &mut world.resource_mut::<DiskFiles>(),
                    self.for_user,
                );
            }
            if let Some(source) = &self.options.lesson {
                let registry = world.resource::<Registry>().clone();
                let mut files = world.resource_mut::<DiskFiles>();
                let open = LessonCommand::Open(source.clone());
                let go = self.options.step.map(LessonCommand::GoTo);
                for command in [Some(open), go].into_iter().flatten() {
                    for effect in session.apply(Action::Lesson(command), &registry) {
                        effects.extend(effects::run(&mut session, &registry, effect, &mut *files));
                    }
                }
            }
            world.write_message_batch(effects);
        });
        // Systems may spawn parts before the first frame.
        know_types(world);
    }
}

/// Restores the settings of the last session, and the progress in lessons.
fn restore(session: &mut Session) {
    let (settings, unread) = settings::load_own();
    session.adopt(settings);
    let (progress, unknown) = progress::load_own();
    session.progress = progress;
    [unread, unknown].into_iter().flatten().for_each(|why| session.say(Severity::Warning, why));
}

/// Declares the custom models in the user's folder.
fn declare_custom(registry: &mut Registry) -> Result<(), String> {
    let folders = Folders::find(None, None).map_err(|why| why.to_string())?;
    folders.shaders.iter().for_each(|folder| registry.set_shader_folder(folder));
    // Their problems are reported when the models are checked.
    folders.models.iter().for_each(|folder| drop(declare_folder(folder, registry)));
    Ok(())
}

/// Opens a file with everything registered with the app in addition to `known`. With [`Defaults::Ask`], the window asks
/// about missing parts.
///
/// # Errors
/// Returns an error if the scene cannot be read, or has problems.
pub fn open_late(
    app: &mut App,
    file: &Path,
    defaults: Defaults,
    mut known: Registry,
) -> Result<(), LoadError> {
    let world = app.world_mut();
    known.add_missing(world.get_resource_or_init::<Registry>().as_ref());
    let outside = &world.resource::<Session>().outside;
    let loaded = load::file(file, &known, defaults.allowing(outside))?;
    if defaults == Defaults::Ask && !loaded.missing.is_empty() {
        let effects = world.resource_scope(|world, mut session: Mut<Session>| {
            open(file, &mut session, &known, &mut world.resource_mut::<DiskFiles>(), true)
        });
        world.write_message_batch(effects);
        return Ok(());
    }
    world.resource_mut::<DiskFiles>().expect(file, Some(loaded.stamp));
    world.insert_resource(CurrentScene(loaded.scene.clone()));
    world.resource_mut::<Session>().opened(file.to_owned(), loaded.scene);
    Ok(())
}

/// Opens a file at the start. Without a user, applies defaults instead of asking.
fn open(
    file: &Path,
    session: &mut Session,
    registry: &Registry,
    files: &mut DiskFiles,
    for_user: bool,
) -> Vec<Effect> {
    if for_user {
        return effects::run(session, registry, Effect::OpenFile(file.to_owned()), files);
    }
    match load::file(file, registry, Defaults::Use.allowing(&session.outside)) {
        Ok(loaded) => {
            files.expect(file, Some(loaded.stamp));
            session.opened(file.to_owned(), loaded.scene);
        }
        Err(why) => {
            complain(&why.to_string());
            session.say(Severity::Error, why.to_string());
        }
    }
    Vec::new()
}

/// Adapts the document to changed models: stashes values that no model accepts any more.
fn follow_parameters(registry: Res<Registry>, session: ResMut<Session>) {
    if registry.is_changed() {
        follow_registry(session, &registry);
    }
}

/// Copies the document to the displayed scene.
fn publish(
    session: Res<Session>,
    scene: ResMut<CurrentScene>,
    mut entities: ResMut<SceneEntities>,
    mut terms: ResMut<ShownTerms>,
    mut channels: ResMut<ShownChannels>,
) {
    entities.show(&session.document, scene);
    terms.set_if_neq(ShownTerms(session.view.terms));
    let (by_view, light) = (session.view.channels, session.channel_light());
    channels.set_if_neq(ShownChannels { by_view, light });
}

/// Submits changes of the entities to the document, and reverts those that it refuses. Reports, once, shapes that do
/// not fit on the GPU.
fn take_over(
    meshes: Res<ShapeMeshes>,
    mut reported: Local<Option<String>>,
    mut known: Local<(u64, u64, bool)>,
    mut scene: ResMut<CurrentScene>,
    mut entities: ResMut<SceneEntities>,
    registry: Res<Registry>,
    mut session: ResMut<Session>,
) {
    let problem = meshes.problem();
    let now = (meshes.omissions(), entities.lists(), problem.is_some());
    if std::mem::replace(&mut *known, now) != now {
        let left_out = meshes.left_out().filter(|_| problem.is_some());
        let left_out: BTreeSet<_> = left_out.filter_map(|object| entities.place_of(object)).collect();
        session.bypass_change_detection().facts.not_drawn = left_out.into_iter().collect();
    }
    if *reported != problem {
        if let Some(problem) = &problem {
            let text = format!("{} {}", sentence(problem), session.names_not_drawn(&registry));
            session.say(Severity::Error, text.trim_end());
        }
        *reported = problem;
    }
    for refused in entities.refused() {
        session.say(Severity::Warning, refused.clone());
    }
    let Some(changes) = entities.changed_by_others(&session.document, &mut scene) else { return };
    let answer = match &changes {
        Changes::Values(parts) => session.submit(&scene.0, parts, &registry),
        Changes::Lists(removed) => session.submit_lists(&scene.0, removed, &registry),
    };
    entities.settle(&changes, answer.is_ok(), &session.document, &mut scene);
    if let Err(why) = answer {
        session.say(Severity::Warning, why);
    }
}
