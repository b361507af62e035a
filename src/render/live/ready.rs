//! The shaders ready for use: composed when first needed, and put to rest when unused.

use std::collections::HashSet;

use bevy::{prelude::*, shader::ValidateShader};

use super::{
    super::trial::{Bench, COMPOSED, Verdict},
    Key, Live, LiveShaders, Parts, Refused, Registry, Visible, composed, key,
};
use crate::{
    library::{problem::Problem, stand_in},
    shader::{
        compose::{Composed, Sources},
        slim::slim,
    },
};

/// Number of unused shaders that stay ready in case they are needed again; each takes several megabytes.
pub const SPARE: usize = 32;
/// The content of the assets of resting shaders: the smallest valid pipeline.
const RESTING: &str = "
@vertex fn vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> { return vec4(position, 1.0); }
@fragment fn fragment() -> @location(0) vec4<f32> { return vec4(0.0); }
";

/// The path by which Bevy identifies the asset of a shader.
pub(super) fn path_of_asset(key: Key) -> String {
    format!("{COMPOSED}{}/{}/{:x}/{}.wgsl", key.0, key.1, key.2.bits(), key.3.bits())
}

impl LiveShaders {
    /// The shader of a model, a shading model and light types; `None` while another process tries it.
    pub(crate) fn get(
        &mut self,
        world: &mut World,
        parts: Parts,
        registry: &Registry,
    ) -> Option<Handle<Shader>> {
        let (key, model) = (key(parts), parts.0);
        let declared = model.declared();
        if let Some(live) = self.shaders.get(&key).filter(|live| live.declared == declared) {
            return Some(live.handle.clone());
        }
        if self.library.is_arriving(model, registry) {
            self.awaited = true;
            return None;
        }
        let wanted = composed(registry.sources(), parts, registry);
        // From here on these files are in use.
        for path in wanted.map.files() {
            self.unused.remove(path);
            self.unused_problems.remove(path);
        }
        let (shown, refused, due) = match self.judge(world, &wanted, parts, registry) {
            Verdict::Good => (Some(wanted), None, false),
            Verdict::Bad(problem) => {
                let problem = Problem::new(problem);
                (None, Some(Refused { composed: wanted, problem }), false)
            }
            Verdict::NotYet if world.resource::<Bench>().is_waiting() => {
                self.awaited = true;
                return None;
            }
            Verdict::NotYet => (None, None, true),
        };
        let (shown, replaced) = match shown {
            Some(shown) => (shown, Vec::new()),
            None => self.last_good(world, parts, registry)?,
        };
        let asset = self.asset(&shown, key, registry);
        let taken_over = self.taken_over(key, registry);
        let mut assets = world.resource_mut::<Assets<Shader>>();
        let handle = match taken_over {
            Some(handle) => {
                // The asset exists as long as its handle.
                let _ = assets.insert(handle.id(), asset);
                handle
            }
            None => assets.add(asset),
        };
        self.stale_status = true;
        let seen = self.rounds;
        let live =
            Live { handle: handle.clone(), declared, shown, replaced, before: None, refused, due, seen };
        self.shaders.insert(key, live);
        Some(handle)
    }

    /// The asset that a shader takes over: that of the same model with an earlier declaration, of the same
    /// shader at rest, or of a removed custom model. Bevy never releases a pipeline, but rebuilds it when its
    /// shader changes; with an asset for each declaration, each would keep megabytes.
    fn taken_over(&mut self, key: Key, registry: &Registry) -> Option<Handle<Shader>> {
        if let Some(handle) = self.take(&key) {
            return Some(handle);
        }
        // Only custom models are ever removed.
        registry.custom_file(key.0)?;
        let gone = |known: &&Key| known.1 == key.1 && registry.model(known.0).is_none();
        let known = *self.shaders.keys().chain(self.resting.keys()).find(gone)?;
        self.take(&known)
    }

    /// The asset of a shader, which no longer has one.
    fn take(&mut self, key: &Key) -> Option<Handle<Shader>> {
        self.shaders.remove(key).map(|live| live.handle).or_else(|| self.resting.remove(key))
    }

    /// Puts the shaders to rest that were out of the picture for longest, if there are many: their pipelines
    /// stay, since Bevy keeps them, but with minimal content.
    pub(super) fn rest(&mut self, world: &mut World, visible: &Visible) {
        self.rounds += 1;
        for (_, live) in self.shaders.iter_mut().filter(|(key, _)| visible.has(key)) {
            live.seen = self.rounds;
        }
        let idle = |(key, live): &(&Key, &Live)| !visible.has(key) && !live.due && live.refused.is_none();
        let mut idle: Vec<_> =
            self.shaders.iter().filter(idle).map(|(key, live)| (live.seen, *key)).collect();
        idle.sort_unstable();
        // Those of other light types rest at once, or each set of light types would have separate spare ones.
        let lights: HashSet<_> = visible.0.iter().map(|(_, _, lights, _)| *lights).collect();
        let (spare, other): (Vec<_>, Vec<_>) =
            idle.into_iter().partition(|(_, key)| lights.is_empty() || lights.contains(&key.2));
        let many = spare.len().saturating_sub(SPARE);
        for (_, key) in other.into_iter().chain(spare.into_iter().take(many)) {
            let Some(live) = self.shaders.remove(&key) else { continue };
            let asset = Shader::from_wgsl(RESTING, path_of_asset(key));
            // The asset exists as long as its handle.
            let _ = world.resource_mut::<Assets<Shader>>().insert(live.handle.id(), asset);
            self.resting.insert(key, live.handle);
        }
    }

    /// The latest valid source: the file of the model with the last valid versions of the others; otherwise
    /// the last valid version of all; otherwise the compiled-in texts. In the last case, fallbacks replace
    /// invalid files of other crates, whose paths are returned too. `None` while another process tries one of
    /// these.
    fn last_good(
        &mut self,
        world: &mut World,
        parts: Parts,
        registry: &Registry,
    ) -> Option<(Composed, Vec<&'static str>)> {
        for sources in [self.library.lenient(registry), self.library.good().clone()] {
            let composed = composed(&sources, parts, registry);
            if self.library.is_built_in(&composed, registry) || self.passes(world, &composed, parts)? {
                return Some((composed, Vec::new()));
            }
        }
        let (model, _, shading, lights) = parts;
        let mut foreign = stand_in::of(model, shading, &registry.lights_in(lights));
        foreign.retain(|(path, _)| registry.is_foreign(path));
        let mut sources = Sources::default();
        foreign.iter().for_each(|(path, text)| sources.edit(*path, text.as_str()));
        let mut replaced = Vec::new();
        for (path, text) in &foreign {
            sources.forget(path);
            if !self.passes(world, &composed(&sources, parts, registry), parts)? {
                sources.edit(*path, text.as_str());
                replaced.push(*path);
            }
        }
        Some((composed(&sources, parts, registry), replaced))
    }

    /// True if a source is valid; `None` while another process tries it.
    fn passes(&mut self, world: &mut World, composed: &Composed, parts: Parts) -> Option<bool> {
        match self.try_out(world, composed, parts) {
            Verdict::Good => Some(true),
            Verdict::NotYet if world.resource::<Bench>().is_waiting() => {
                self.awaited = true;
                None
            }
            Verdict::Bad(_) | Verdict::NotYet => Some(false),
        }
    }

    /// The asset of a composed source.
    pub(super) fn asset(&self, composed: &Composed, key: Key, registry: &Registry) -> Shader {
        let mut shader = Shader::from_wgsl(slim(&composed.text), path_of_asset(key));
        if !self.library.is_built_in(composed, registry) {
            // Users' shaders may read beyond the bounds of arrays.
            shader.validate_shader = ValidateShader::Enabled;
        }
        shader
    }
}
