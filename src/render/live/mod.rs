//! The shaders in use: composed when first needed, exchanged when one of their files changes, and kept when
//! the change is invalid.
//!
//! Each reflection model in each shading model has a separate shader: a change of a shared file that breaks
//! one model does not affect the others. A shader is exchanged only after it was tried
//! ([`trial`]). The asset stays the same, so cameras, materials and objects are not affected. The files are
//! managed by the [`Library`].
//!
//! Until a shader is ready, an object keeps its old one ([`AwaitsShader`](super::swap::AwaitsShader)); a broken custom
//! model is drawn as grey Lambert (see [`custom`](crate::custom)).

mod arriving;
mod needed;
mod ready;
mod report;
mod trying;

use std::{
    collections::{BTreeMap, BTreeSet, HashMap, HashSet},
    path::Path,
};

use bevy::{prelude::*, render::error_handler::RenderErrorHandler};
use web_time::Instant;

use super::{
    drawn::Drawn,
    entities::CurrentScene,
    overrides::Overrides,
    schedule::{LabFrame, LabSystems},
    shown::Shown,
    trial::{self, Bench},
};
use crate::{
    library::{
        Library,
        problem::Problem,
        status::{Reloaded, ShaderStatus},
    },
    reflection::{ModelEntry, Passage},
    registry::{LightSet, Registry, compose::compose},
    shader::{
        check::ShaderProblem,
        compose::{Composed, SEEN, Sources},
    },
    shading::ShadingEntry,
};

pub use needed::NeededShaders;
pub use ready::SPARE;
pub use trying::RendererFailed;

/// Exchanges shaders while they are in use.
pub(super) fn plugin(app: &mut App) {
    app.add_plugins(trial::plugin)
        .init_resource::<LiveShaders>()
        .insert_resource(RenderErrorHandler(trying::take_back))
        .add_systems(LabFrame, exchange.in_set(LabSystems::Swap));
}

/// The identity of a shader: model, shading model, light types, and how light passes through surfaces.
type Key = (&'static str, &'static str, LightSet, Passage);

/// The parts that a shader is composed of.
pub(super) type Parts<'a> = (&'a ModelEntry, Passage, &'a ShadingEntry, LightSet);

fn key((model, passage, shading, lights): Parts) -> Key {
    (model.declaration.id, shading.declaration.id, lights, passage)
}

fn composed(sources: &Sources, (model, passage, shading, lights): Parts, registry: &Registry) -> Composed {
    compose(sources, (model, passage), shading, &registry.lights_in(lights))
}

/// The light types in the scene; without a scene, all that have no extent, which compile quickly.
fn lights_of(world: &World, registry: &Registry) -> LightSet {
    let shown = world.get_resource::<Shown>();
    let without = || registry.lights().iter().filter(|light| !light.declaration.extent).collect();
    shown.map_or_else(without, |shown| shown.types)
}

/// One shader.
struct Live {
    handle: Handle<Shader>,
    /// The declaration for which it was made, see [`ModelEntry::declared`].
    declared: u64,
    /// The source in use.
    shown: Composed,
    /// The paths of the files that fallbacks replace in it, see [`stand_in`](crate::library::stand_in).
    replaced: Vec<&'static str>,
    /// The previous source, and until when it is kept: the renderer may still refuse the one that replaced
    /// it.
    before: Option<(Composed, Instant)>,
    /// The source that was last tried and refused.
    refused: Option<Refused>,
    /// True if one of its files changed.
    due: bool,
    /// Number of the check in which it was last in the picture, see [`LiveShaders::rest`].
    seen: u64,
}

struct Refused {
    composed: Composed,
    problem: Problem<Box<ShaderProblem>>,
}

/// The shaders by model and shading model.
#[derive(Default, Resource)]
pub struct LiveShaders {
    library: Library,
    shaders: HashMap<Key, Live>,
    /// Assets of shaders that are rebuilt when they are needed again.
    resting: HashMap<Key, Handle<Shader>>,
    /// The number of times that shaders were looked through for some that may rest.
    rounds: u64,
    /// True if an object waits for a shader that is tried for the first time.
    awaited: bool,
    /// True if a frame says that a shader is awaited before the next one makes it.
    announces: bool,
    /// Composed texts that were tried successfully in this frame.
    approved: HashSet<String>,
    /// Changed files that no shader uses: they are tried separately.
    unused: BTreeSet<String>,
    /// The problems of those files.
    unused_problems: BTreeMap<String, Problem<Box<ShaderProblem>>>,
    /// The last change that took effect.
    last: Option<Reloaded>,
    status: ShaderStatus,
    /// True if the status must be updated.
    stale_status: bool,
}

impl LiveShaders {
    /// Tries all shaders again, since texts and folders of the registry have changed.
    pub fn start(&mut self) {
        self.shaders.values_mut().for_each(|live| live.due = true);
        self.stale_status = true;
    }

    /// The folders of the shaders and their problems.
    #[must_use]
    pub fn status(&self) -> &ShaderStatus {
        &self.status
    }

    /// True if there is more to try or report, so that frames must continue.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.stale_status || self.library.has_news() || self.is_trying()
    }

    /// True if there is more to try, so that the next picture may differ.
    #[must_use]
    pub fn is_trying(&self) -> bool {
        self.awaited
            || self.library.is_busy()
            || !self.unused.is_empty()
            || self.shaders.values().any(|live| live.due)
    }

    /// The first problem that keeps a shader from matching its files.
    #[must_use]
    pub fn refused(&self) -> Option<&ShaderProblem> {
        self.shaders.values().find_map(|live| live.refused.as_ref().map(|refused| &*refused.problem.what))
    }

    /// The texts with which lights themselves are drawn: the valid ones, since light types light objects too.
    pub(super) fn sources_of_seen(&self, registry: &Registry) -> Sources {
        let mut sources = self.library.good().clone();
        sources.copy_from(registry.sources(), SEEN.path);
        sources
    }

    /// The number of shaders ready for use.
    #[must_use]
    pub fn ready(&self) -> usize {
        self.shaders.len()
    }

    /// True if the whole picture matches the files.
    #[must_use]
    pub fn is_up_to_date(&self) -> bool {
        !self.is_trying()
            && self.shaders.values().all(|live| live.refused.is_none())
            && self.library.unusable().next().is_none()
            && self.unused_problems.is_empty()
    }

    /// Makes no shader for an object that shows another one before the frame after it was asked for: a window stands
    /// still while the driver compiles it, and says so first.
    pub fn announce(&mut self) {
        self.announces = true;
    }

    /// True if a shader is not made yet, and is announced before it is.
    pub(super) fn is_announced(&self, parts: Parts) -> bool {
        let is_made = |live: &Live| live.declared == parts.0.declared();
        self.announces && !self.shaders.get(&key(parts)).is_some_and(is_made)
    }

    /// Moves the reading of custom models to a separate thread, which calls `wake`.
    pub fn read_apart(&mut self, wake: impl Fn() + Send + 'static) {
        self.library.read_apart(wake);
    }

    /// True while a thread reads custom models, and will call `wake`.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.library.is_reading()
    }

    /// Reads a file that may have changed, see [`Library::reread`]. Custom models go into the registry once they were
    /// tried.
    pub fn reread(&mut self, file: &Path, registry: &mut Registry) {
        let Self { library, shaders, .. } = self;
        let drawn = |id: &str| shaders.keys().any(|key| key.0 == id);
        let Some(changed) = library.reread(file, registry, drawn) else { return };
        if self.mark_due(&changed) {
            self.unused_problems.remove(&changed);
        } else {
            self.unused.insert(changed);
        }
    }

    /// Schedules the shaders that contain a file to be tried. True if there are any.
    fn mark_due(&mut self, source: &str) -> bool {
        let mut used = false;
        for live in self.shaders.values_mut() {
            let candidate = live.refused.as_ref().is_some_and(|r| r.composed.depends_on(source));
            if candidate || live.shown.depends_on(source) {
                live.due = true;
                used = true;
            }
        }
        used
    }
}

/// The models and shading models in the picture, with the light types of their shaders, and how light passes.
struct Visible(Vec<(String, String, LightSet, Passage)>);

impl Visible {
    fn of(world: &mut World) -> Self {
        let mut query = world.query::<&Drawn>();
        let mut pairs: Vec<_> = query
            .iter(world)
            .map(|d| (d.model().to_owned(), d.shading().to_owned(), d.lights, d.passage))
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        Self(pairs)
    }

    fn shows(&self, model: &str, shading: &ShadingEntry) -> bool {
        self.0.iter().any(|(m, s, ..)| m == model && s == shading.declaration.id)
    }

    fn has(&self, key: &Key) -> bool {
        self.0.iter().any(|(model, shading, lights, passage)| {
            model == key.0 && shading == key.1 && (*lights, *passage) == (key.2, key.3)
        })
    }
}

/// Exchanges the shaders whose files changed.
pub(super) fn exchange(world: &mut World) {
    let mut overrides = world.query_filtered::<(), Changed<Overrides>>();
    let other_scene = world.is_resource_changed::<CurrentScene>();
    if other_scene || overrides.iter(world).next().is_some() {
        world.resource_scope(|world, mut live: Mut<LiveShaders>| live.read_wanted(world));
    }
    if !world.resource::<LiveShaders>().status.troubles.is_empty() {
        // Objects with a faulty shader may have entered or left the picture; they are swapped after this.
        let mut drawn = world.query_filtered::<(), Changed<Drawn>>();
        if other_scene || drawn.iter(world).next().is_some() {
            world.resource_mut::<LiveShaders>().stale_status = true;
        }
    }
    if !world.resource::<LiveShaders>().is_busy() {
        return;
    }
    let visible = Visible::of(world);
    world.resource_scope(|world, mut live: Mut<LiveShaders>| {
        live.library.take_finished(world.resource_mut::<Registry>().bypass_change_detection());
        live.approved.clear();
        live.awaited = false;
        world.resource::<Bench>().begin_frame();
        live.adopt(world, &visible);
        let registry = world.resource::<Registry>().clone();
        live.work(world, &registry, &visible);
        if live.shaders.iter().any(|(key, shader)| shader.due && visible.has(key)) {
            // Problems are reported when all of them are known.
            live.stale_status = true;
            return;
        }
        live.forget_gone(world, &visible);
        live.rest(world, &visible);
        live.library.take_news();
        // Problems that are too recent are reported later.
        live.stale_status = live.has_young_problems();
        live.report(&registry, &visible);
    });
}
