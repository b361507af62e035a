//! Tries shaders, and exchanges the valid ones.

use std::time::Duration;

use bevy::{
    prelude::*,
    render::{
        error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy},
        renderer::{RenderAdapter, RenderDevice},
    },
};
use web_time::Instant;

use super::{
    super::{
        tables::row,
        trial::{Bench, Tools, Verdict},
    },
    Key, LiveShaders, ModelEntry, Parts, Refused, Registry, ShadingEntry, Visible, composed, lights_of,
    ready::path_of_asset,
};
use crate::{
    library::problem::Problem,
    optics::colour::Encoding,
    parameter::Values,
    platform,
    reflection::Passage,
    registry::{LightSet, check::wgsl},
    shader::{
        check::ShaderProblem,
        compose::{Composed, WRAPPER},
    },
    shading::Stage,
};

/// Time that a frame may spend trying shaders before it is drawn: with many in the picture, the window stays
/// responsive.
const SLICE: Duration = Duration::from_millis(200);
/// Time after an exchange in which an error of the renderer is attributed to it.
const PROBATION: Duration = Duration::from_secs(5);

impl LiveShaders {
    /// Tries a composed source, once.
    pub(super) fn try_out(
        &mut self,
        world: &mut World,
        composed: &Composed,
        (model, passage, shading, _): Parts,
    ) -> Verdict {
        if composed.problem.is_none() && self.approved.contains(&composed.text) {
            return Verdict::Good;
        }
        let verdict = try_out(world, composed, (model, passage), shading);
        if verdict == Verdict::Good {
            self.approved.insert(composed.text.clone());
        }
        verdict
    }

    /// The verdict on a composed source; one that holds only what ships with this crate is not tried. Remembers the files
    /// of a valid one, and names the author's file if a problem appears in another one.
    pub(super) fn judge(
        &mut self,
        world: &mut World,
        composed: &Composed,
        parts: Parts,
        registry: &Registry,
    ) -> Verdict {
        let built_in = self.library.is_built_in(composed, registry);
        let verdict = if built_in { Verdict::Good } else { self.try_out(world, composed, parts) };
        if verdict == Verdict::Good {
            self.library.note_good(composed, registry);
        }
        let Verdict::Bad(problem) = verdict else { return verdict };
        let (model, _, shading, lights) = parts;
        let problem = self.library.blamed(problem, composed, registry);
        Verdict::Bad(wgsl::blamed(problem, registry, model, shading, &registry.lights_in(lights)))
    }

    /// Tries pending shaders for as long as a frame may take: first those in the picture; then, one per
    /// frame, others.
    pub(super) fn work(&mut self, world: &mut World, registry: &Registry, visible: &Visible) {
        let begin = Instant::now();
        // Shaders of older declarations are rebuilt when they are needed again.
        for (key, live) in &mut self.shaders {
            if registry.model(key.0).is_some_and(|model| model.declared() != live.declared) {
                (live.due, live.refused) = (false, None);
            }
        }
        let mut due: Vec<Key> = self.shaders.iter().filter(|(_, live)| live.due).map(|(k, _)| *k).collect();
        due.sort_unstable();
        let (on_picture, off_picture): (Vec<_>, Vec<_>) = due.into_iter().partition(|k| visible.has(k));
        if !on_picture.is_empty() {
            for key in on_picture {
                self.refresh(world, registry, key);
                if begin.elapsed() > SLICE {
                    break;
                }
            }
            return;
        }
        if let Some(key) = off_picture.first() {
            self.refresh(world, registry, *key);
        }
        if let Some(path) = self.unused.pop_first() {
            self.try_unused(world, registry, visible, &path);
        }
    }

    /// Exchanges a shader for the present content of its files, if that is valid.
    fn refresh(&mut self, world: &mut World, registry: &Registry, key: Key) {
        let Some((model, shading)) = registry.model(key.0).zip(registry.shading_model(key.1)) else {
            // No object uses it any more.
            if let Some(live) = self.shaders.get_mut(&key) {
                live.due = false;
            }
            return;
        };
        let parts = (model, key.3, shading, key.2);
        let wanted = composed(registry.sources(), parts, registry);
        let shown_already = self.shaders.get(&key).is_some_and(|live| live.shown == wanted);
        let verdict = if shown_already {
            self.library.note_good(&wanted, registry);
            Verdict::Good
        } else {
            self.judge(world, &wanted, parts, registry)
        };
        let asset = self.asset(&wanted, key, registry);
        let Some(live) = self.shaders.get_mut(&key) else { return };
        live.due = verdict == Verdict::NotYet;
        match verdict {
            Verdict::Good if shown_already => live.refused = None,
            Verdict::Good => {
                let id = live.handle.id();
                // The asset exists as long as its handle.
                let _ = world.resource_mut::<Assets<Shader>>().insert(id, asset);
                live.before = Some((std::mem::replace(&mut live.shown, wanted), Instant::now()));
                live.replaced.clear();
                live.refused = None;
                if let Some(reloaded) = self.library.reloaded() {
                    self.last = Some(reloaded);
                }
            }
            Verdict::Bad(problem) => {
                let problem = Problem::after(live.refused.as_ref().map(|r| &r.problem), problem);
                live.refused = Some(Refused { composed: wanted, problem });
            }
            Verdict::NotYet => {}
        }
        self.stale_status = true;
    }

    /// Tries a file that nothing in the picture uses: a model, a shading model or a light type, together with
    /// others that are in use.
    fn try_unused(&mut self, world: &mut World, registry: &Registry, visible: &Visible, path: &str) {
        let shadings = registry.shading_models();
        let models = registry.models();
        let shading = shadings.iter().find(|m| m.declaration.wgsl.path == path);
        let model = models.iter().find(|m| m.declaration.wgsl.path == path);
        let light = registry.lights().iter().find(|l| l.declaration.wgsl.path == path);
        if shading.is_none() && model.is_none() && light.is_none() {
            return;
        }
        let lights: LightSet = registry.lights_in(lights_of(world, registry)).iter().chain(light).collect();
        let shown_shading =
            || shadings.iter().find(|m| visible.0.iter().any(|(_, id, ..)| id == m.declaration.id));
        let Some((model, shading)) =
            model.or(models.first()).zip(shading.or_else(shown_shading).or(shadings.first()))
        else {
            return;
        };
        let parts = (model, model.passage(&Values::default()), shading, lights);
        let composed = composed(registry.sources(), parts, registry);
        match self.judge(world, &composed, parts, registry) {
            Verdict::Good => _ = self.unused_problems.remove(path),
            Verdict::Bad(problem) => {
                self.unused_problems.insert(path.to_owned(), Problem::new(problem));
            }
            Verdict::NotYet => _ = self.unused.insert(path.to_owned()),
        }
        self.stale_status = true;
    }
}

fn try_out(
    world: &mut World,
    composed: &Composed,
    of: (&ModelEntry, Passage),
    shading: &ShadingEntry,
) -> Verdict {
    let (Some(device), Some(adapter)) =
        (world.get_resource::<RenderDevice>().cloned(), world.get_resource::<RenderAdapter>().cloned())
    else {
        return Verdict::NotYet;
    };
    world.resource_scope(|world, mut bench: Mut<Bench>| {
        let tools = Tools { device: &device, adapter: &adapter, shaders: world.resource::<Assets<Shader>>() };
        let row = || sample(of, shading);
        bench.try_out(composed, shading.declaration.stage == Stage::Polygon, row, tools)
    })
}

/// The row of the object with which a shader is tried: its parameters are the defaults.
fn sample(of: (&ModelEntry, Passage), shading: &ShadingEntry) -> Vec<u8> {
    row(of, shading, &Values::default(), Encoding::Srgb, false, true)
}

/// The renderer has failed, and draws no more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Event)]
pub struct RendererFailed {
    /// True if the graphics card is lost: another program or the driver has taken it away.
    pub device_lost: bool,
}

/// Ends the program in Bevy's way, where it can end; elsewhere it stays, without pictures.
fn give_up(error: &RenderError, main: &mut World, render: &mut World) -> RenderErrorPolicy {
    main.trigger(RendererFailed { device_lost: error.ty == ErrorType::DeviceLost });
    if platform::OUTLIVES_WINDOW {
        RenderErrorHandler::default().0(error, main, render)
    } else {
        RenderErrorPolicy::StopRendering
    }
}

/// Restores the previous shaders if the renderer failed nevertheless. If nothing was exchanged, the cause is
/// another, and the renderer gives up.
pub(super) fn take_back(error: &RenderError, main: &mut World, render: &mut World) -> RenderErrorPolicy {
    if !matches!(error.ty, ErrorType::Validation | ErrorType::Internal) {
        return give_up(error, main, render);
    }
    let what = error.description.lines().map(str::trim).collect::<Vec<_>>().join(" ");
    let mut taken_back = false;
    main.resource_scope(|main, mut live: Mut<LiveShaders>| {
        let live = &mut *live;
        let file = live.library.changed().unwrap_or(WRAPPER.path).to_owned();
        let mut shaders = main.resource_mut::<Assets<Shader>>();
        for (key, entry) in &mut live.shaders {
            let Some((before, _)) = entry.before.take_if(|(_, at)| at.elapsed() < PROBATION) else {
                continue;
            };
            let refused = std::mem::replace(&mut entry.shown, before);
            let asset = Shader::from_wgsl(entry.shown.text.clone(), path_of_asset(*key));
            let _ = shaders.insert(entry.handle.id(), asset);
            let message = format!("the graphics driver failed while drawing with it: {what}");
            let problem = Problem::new(Box::new(ShaderProblem::at(&file, "", 0, message)));
            entry.refused = Some(Refused { composed: refused, problem });
            taken_back = true;
        }
        live.stale_status |= taken_back;
    });
    if taken_back { RenderErrorPolicy::Ignore } else { give_up(error, main, render) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_device_is_announced_before_the_program_ends() {
        #[derive(Default, Resource)]
        struct Heard(Vec<RendererFailed>);
        let (mut main, mut render) = (World::new(), World::new());
        main.init_resource::<Heard>();
        main.init_resource::<Messages<AppExit>>();
        main.add_observer(|failed: On<RendererFailed>, mut heard: ResMut<Heard>| heard.0.push(*failed));
        let error = RenderError { ty: ErrorType::DeviceLost, description: String::new(), source: None };
        let policy = take_back(&error, &mut main, &mut render);
        assert!(matches!(policy, RenderErrorPolicy::StopRendering));
        assert_eq!(main.resource::<Heard>().0, [RendererFailed { device_lost: true }]);
        assert_eq!(main.resource::<Messages<AppExit>>().len(), 1);
    }

    #[test]
    fn shaders_are_tried_with_the_defaults_of_model_and_shading_model() {
        let registry = Registry::builtin();
        for (model, shading) in registry.models().iter().zip(registry.shading_models().iter().cycle()) {
            let row = sample((model, model.passage(&Values::default())), shading);
            let (values, encoding) = (Values::default(), Encoding::Srgb);
            let (of_model, of_shading) =
                (model.row(&values, encoding, false), shading.row(&values, encoding));
            let place = of_model.len().next_multiple_of(16);
            assert_eq!(row[..of_model.len()], of_model);
            assert_eq!(row[place..place + of_shading.len()], of_shading, "{}", shading.declaration.id);
        }
    }
}
