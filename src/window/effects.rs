//! Carries out effects that need files, entities or the operating system.

use bevy::{ecs::system::SystemParam, prelude::*, winit::EventLoopProxyWrapper};

use super::{
    authoring, camera, editor, exports, files, laws, manual, matching, plots, recovery, shaders, sheets,
    watching,
};
use crate::{
    panel::{
        effects::run as run_files,
        state::{Effect, Session, Severity},
    },
    platform,
    registry::Registry,
};

/// Present if nobody uses the window, so that there are no settings to keep.
#[derive(Resource)]
pub(super) struct Unattended;

/// Work in the background, and the way to wake the idle window.
#[derive(SystemParam)]
pub(super) struct Work<'w> {
    editors: Res<'w, editor::Editors>,
    manuals: Res<'w, manual::Manuals>,
    laws: Res<'w, laws::LawChecks>,
    exports: Res<'w, exports::Exports>,
    matches: Res<'w, matching::Matches>,
    plots: Res<'w, plots::PlotFiles>,
    sheets: Res<'w, sheets::SheetFiles>,
    proxy: Option<Res<'w, EventLoopProxyWrapper>>,
}

impl Work<'_> {
    /// Reports the tasks that have ended. Shows the folder of an export to the user, if there is one.
    fn report(&self, session: &mut ResMut<Session>, registry: &Registry, unattended: bool) {
        for complaint in self.editors.take() {
            session.say(Severity::Error, complaint);
        }
        for outcome in self.manuals.take() {
            match outcome {
                Ok(said) => session.say(Severity::Info, said),
                Err(why) => session.say(Severity::Warning, why),
            }
        }
        if let Some((model, outcome)) = self.laws.take() {
            session.authoring.laws_checked(&model, outcome);
        }
        if let Some(path) = self.exports.report(session)
            && !unattended
        {
            session.warn(exports::reveal(&path));
        }
        self.matches.report(session, registry);
        self.plots.report(session);
        self.sheets.report(session);
    }

    /// Begins or stops the task that an effect asks for. Returns any other effect.
    fn begin(&self, effect: Effect, session: &mut ResMut<Session>, registry: &Registry) -> Option<Effect> {
        let wake = watching::wake(self.proxy.as_deref());
        match effect {
            Effect::OpenInEditor { path, line } => {
                let variable = std::env::var(editor::EDITOR_VARIABLE).ok();
                self.editors.open(variable.as_deref(), &path, line, wake);
            }
            Effect::OpenManual => self.manuals.open(wake),
            Effect::Export { form, path, overwrite } => {
                self.exports.begin(form, path, overwrite, session, registry, wake);
            }
            Effect::CancelExport => self.exports.0.cancel(),
            Effect::Match { view, measure, parameters } => {
                self.matches.begin((view, measure, parameters), session, registry, wake);
            }
            Effect::MatchEvery { view, measure } => {
                self.matches.begin_every((view, measure), session, registry, wake);
            }
            Effect::CancelMatch => self.matches.cancel(),
            Effect::WritePlot(path) => self.plots.begin(path, session, registry, wake),
            Effect::WriteSheet { subject, path } => {
                self.sheets.begin((subject, path), session, registry, wake)
            }
            Effect::CancelSheet => self.sheets.0.cancel(),
            Effect::SaveMaterial { material, overwrite } => {
                authoring::save_material(session, registry, *material, overwrite);
            }
            Effect::CheckLaws(model) => self.laws.begin(&model, registry.folders(), wake),
            other => return Some(other),
        }
        None
    }
}

/// Carries out the effects of the panels.
pub(super) fn carry_out(
    mut effects: MessageReader<Effect>,
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut files: ResMut<files::DiskFiles>,
    mut camera: camera::CameraControl,
    watch: Option<Res<watching::FileWatch>>,
    mut exit: MessageWriter<AppExit>,
    work: Work,
    mut recovery: Option<ResMut<recovery::Recovery>>,
    unattended: Option<Res<Unattended>>,
    mut commands: Commands,
) {
    work.report(&mut session, &registry, unattended.is_some());
    let mut pending: Vec<_> = effects.read().cloned().collect();
    pending.reverse();
    while let Some(effect) = pending.pop() {
        let Some(effect) = work.begin(effect, &mut session, &registry) else { continue };
        match effect {
            Effect::HomeView => camera.home(),
            Effect::FocusSelection => camera.focus(&session, &registry),
            Effect::Steer(steer) => camera.steer(steer),
            Effect::Camera(change) => camera.change(change),
            Effect::ObserverFromView => camera.place_observer(&mut session, &registry),
            Effect::DocumentChanged => {
                files.document_changed(session.path.as_deref());
                camera.home();
            }
            Effect::Quit if !platform::OUTLIVES_WINDOW => {
                session.say(Severity::Info, "Close the tab of the browser to quit.");
            }
            Effect::Quit => {
                recovery.iter().for_each(|recovery| recovery.farewell.close());
                exit.write(AppExit::Success);
            }
            Effect::Recovery(choice) => {
                if let Some(recovery) = &mut recovery {
                    recovery.answer(choice, &mut session, &mut files, &registry);
                }
            }
            Effect::LookAgain(path) => {
                watch.iter().for_each(|watch| watch.0.report_later(&path, watching::GRACE));
            }
            Effect::SaveSettings | Effect::SaveProgress(_) if unattended.is_some() => {}
            Effect::Complain(text) => watching::complain(&text),
            // The panels handle the clipboard. Pictures are taken elsewhere, since the views must be read back first.
            Effect::CopyText(_) | Effect::Picture { .. } | Effect::CancelPicture => {}
            Effect::Reveal(folder) => session.warn(exports::reveal(&folder)),
            dialog @ Effect::Pick(_) => session.wanted_dialog = Some(dialog),
            model @ (Effect::NewModel { .. } | Effect::AdoptModel(_) | Effect::ExportShaders(_)) => {
                if let Some(folder) = authoring::write(&model, &mut session, &registry) {
                    commands.queue(move |world: &mut World| shaders::move_to(world, &folder));
                }
            }
            other => {
                let more = run_files(&mut session, &registry, other.clone(), &mut *files);
                // An effect that is returned unchanged has no handler.
                pending.extend(more.into_iter().rev().filter(|e| *e != other));
            }
        }
    }
}
