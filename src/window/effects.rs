//! Carries out effects that need files, entities or the operating system.

use bevy::{
    app::AppExit,
    ecs::prelude::*,
    winit::{EventLoopProxyWrapper, WinitUserEvent},
};

use super::{
    authoring, camera, editor, exports, files, laws, manual, matching, plots, recovery, shaders, watching,
};
use crate::{
    panel::{
        effects::run as run_files,
        state::{Effect, LabEffect, Session, Severity},
    },
    registry::Registry,
};

/// Present if nobody uses the window, so that there are no settings to keep.
#[derive(Resource)]
pub(super) struct Unattended;

/// Wakes the idle window; if it is gone, there is nobody to notify.
fn wake(proxy: Option<&EventLoopProxyWrapper>) -> impl Fn() + Send + 'static + use<> {
    let proxy = proxy.map(|proxy| (**proxy).clone());
    move || {
        proxy.as_ref().map(|proxy| proxy.send_event(WinitUserEvent::WakeUp));
    }
}

/// Carries out the effects of the panels.
pub(super) fn carry_out(
    mut effects: MessageReader<LabEffect>,
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut files: ResMut<files::DiskFiles>,
    mut camera: camera::CameraControl,
    watch: Option<Res<watching::FileWatch>>,
    mut exit: MessageWriter<AppExit>,
    editors: Res<editor::Editors>,
    laws: Res<laws::LawChecks>,
    exports: Res<exports::Exports>,
    matches: Res<matching::Matches>,
    plot_files: Res<plots::PlotFiles>,
    proxy: Option<Res<EventLoopProxyWrapper>>,
    mut recovery: Option<ResMut<recovery::Recovery>>,
    unattended: Option<Res<Unattended>>,
    mut commands: Commands,
) {
    for complaint in editors.take() {
        session.say(Severity::Error, complaint);
    }
    if let Some((model, outcome)) = laws.take() {
        session.laws_checked(&model, outcome);
    }
    if let Some(path) = exports.report(&mut session)
        && unattended.is_none()
    {
        exports::reveal(&path, &mut session);
    }
    matches.report(&mut session, &registry);
    plot_files.report(&mut session);
    let mut pending: Vec<_> = effects.read().map(|e| e.0.clone()).collect();
    pending.reverse();
    while let Some(effect) = pending.pop() {
        match effect {
            Effect::HomeView => camera.home(),
            Effect::FocusSelection => camera.focus(&session),
            Effect::Steer(steer) => camera.steer(steer),
            Effect::Camera(change) => camera.change(change),
            Effect::ObserverFromView => camera.place_observer(&mut session, &registry),
            Effect::DocumentChanged => {
                files.document_changed(session.path.as_deref());
                camera.home();
            }
            Effect::Quit => {
                if let Some(recovery) = &recovery {
                    recovery.farewell.close();
                }
                exit.write(AppExit::Success);
            }
            Effect::Recovery(choice) => {
                if let Some(recovery) = &mut recovery {
                    recovery.answer(choice, &mut session, &mut files, &registry);
                }
            }
            Effect::LookAgain(path) => {
                if let Some(watch) = &watch {
                    watch.0.report_later(&path, watching::GRACE);
                }
            }
            Effect::SaveSettings | Effect::SaveProgress(_) if unattended.is_some() => {}
            Effect::Complain(text) => watching::complain(&text),
            // The panels handle the clipboard and the dialogs.
            Effect::CopyText(_) => {}
            // Handled elsewhere, since the views must be read back first.
            Effect::Picture { .. } => {}
            dialog @ (Effect::PickOpen
            | Effect::PickSave
            | Effect::PickFile(..)
            | Effect::PickExport(_)
            | Effect::PickPicture(_)
            | Effect::PickPlot
            | Effect::PickLesson
            | Effect::PickShaderFolder) => {
                session.wanted_dialog = Some(dialog);
            }
            Effect::OpenManual => manual::show(&mut session),
            Effect::NewModel { .. }
            | Effect::DuplicateModel { .. }
            | Effect::AdoptModel(_)
            | Effect::ExportShaders(_) => {
                if let Some(folder) = authoring::write(&effect, &mut session, &registry) {
                    commands.queue(move |world: &mut World| shaders::move_to(world, &folder));
                }
            }
            Effect::OpenInEditor { path, line } => {
                let variable = std::env::var(editor::EDITOR_VARIABLE).ok();
                editors.open(variable.as_deref(), &path, line, wake(proxy.as_deref()));
            }
            Effect::Export { form, path, overwrite } => {
                exports.begin(form, path, overwrite, &mut session, &registry, wake(proxy.as_deref()));
            }
            Effect::CancelExport => exports.cancel(),
            Effect::Match { view, what, parameters } => {
                matches.begin((view, what, parameters), &session, &registry, wake(proxy.as_deref()));
            }
            Effect::CancelMatch => matches.cancel(),
            Effect::WritePlot(path) => {
                plot_files.begin(path, &mut session, &registry, wake(proxy.as_deref()));
            }
            Effect::Reveal(folder) => exports::reveal(&folder, &mut session),
            Effect::CheckLaws(model) => {
                laws.begin(&model, registry.folders(), wake(proxy.as_deref()));
            }
            other => {
                let more = run_files(&mut session, &registry, other.clone(), &mut *files);
                // An effect that is returned unchanged has no handler.
                pending.extend(more.into_iter().rev().filter(|e| *e != other));
            }
        }
    }
}
