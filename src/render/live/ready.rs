//! The shaders that are ready to be drawn with: composed when first needed, and let rest when they are not.

use std::collections::HashSet;

use bevy::{
    asset::{Assets, Handle},
    ecs::prelude::*,
    shader::{Shader, ValidateShader},
};

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

/// The number of shaders that stay ready for a change back while nothing is drawn with them; each keeps some megabytes.
pub const SPARE: usize = 32;
/// The content of the assets of the others: the least that a pipeline can be made of.
const RESTING: &str = "
@vertex fn vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> { return vec4(position, 1.0); }
@fragment fn fragment() -> @location(0) vec4<f32> { return vec4(0.0); }
";

/// The path by which Bevy knows the asset of a shader.
pub(super) fn path_of_asset(key: Key) -> String {
    format!("{COMPOSED}{}/{}/{:x}.wgsl", key.0, key.1, key.2.bits())
}

impl LiveShaders {
    /// The shader of a model, a shading model and light types; none yet while another process tries it.
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
        // From here on these files are used.
        for path in wanted.map.files() {
            self.unused.remove(path);
            self.unused_problems.remove(path);
        }
        let mut refused = None;
        let mut due = false;
        let mut shown = None;
        if self.library.is_built_in(&wanted, registry) {
            shown = Some(wanted);
        } else {
            match self.try_out(world, &wanted, parts) {
                Verdict::Good => {
                    self.library.note_good(&wanted, registry);
                    shown = Some(wanted);
                }
                Verdict::Bad(problem) => {
                    let problem = self.blamed(problem, &wanted, parts, registry);
                    refused = Some(Refused { composed: wanted, problem: Problem::new(problem) });
                }
                Verdict::NotYet if world.resource::<Bench>().is_waiting() => {
                    self.awaited = true;
                    return None;
                }
                Verdict::NotYet => due = true,
            }
        }
        let (shown, replaced) = match shown {
            Some(shown) => (shown, Vec::new()),
            None => self.last_good(world, parts, registry)?,
        };
        let asset = self.asset(&shown, key, registry);
        let taken_over = self.taken_over(key, registry);
        let mut assets = world.resource_mut::<Assets<Shader>>();
        let handle = match taken_over {
            Some(handle) => {
                // The asset is there as long as its handle.
                let _ = assets.insert(handle.id(), asset);
                handle
            }
            None => assets.add(asset),
        };
        self.stale_status = true;
        let seen = self.looks;
        let live =
            Live { handle: handle.clone(), declared, shown, replaced, before: None, refused, due, seen };
        self.shaders.insert(key, live);
        Some(handle)
    }

    /// The asset that a shader takes over: that of the same model as it was declared before or as it rested, or of a
    /// custom model that is gone. Bevy never lets go of a pipeline, but makes it anew when its shader changes; with an
    /// asset for each declaration, each would keep megabytes.
    fn taken_over(&mut self, key: Key, registry: &Registry) -> Option<Handle<Shader>> {
        if let Some(live) = self.shaders.remove(&key) {
            return Some(live.handle);
        }
        if let Some(handle) = self.resting.remove(&key) {
            return Some(handle);
        }
        // Materials of custom models are of one type, so any of them may take it.
        registry.custom_file(key.0)?;
        let gone = |known: &&Key| known.1 == key.1 && registry.model(known.0).is_none();
        let known = *self.shaders.keys().chain(self.resting.keys()).find(gone)?;
        self.shaders.remove(&known).map(|live| live.handle).or_else(|| self.resting.remove(&known))
    }

    /// Lets shaders rest that were not on the picture for longest, if there are many: their pipelines stay, since Bevy
    /// keeps those, but are made of next to nothing.
    pub(super) fn rest(&mut self, world: &mut World, visible: &Visible) {
        self.looks += 1;
        for (_, live) in self.shaders.iter_mut().filter(|(key, _)| visible.has(key)) {
            live.seen = self.looks;
        }
        let idle = |(key, live): &(&Key, &Live)| !visible.has(key) && !live.due && live.refused.is_none();
        let mut idle: Vec<_> =
            self.shaders.iter().filter(idle).map(|(key, live)| (live.seen, *key)).collect();
        idle.sort_unstable();
        // Those of other light types rest at once, or each set of these would have its own spare ones.
        let lights: HashSet<_> = visible.0.iter().map(|(.., lights)| *lights).collect();
        let (spare, other): (Vec<_>, Vec<_>) =
            idle.into_iter().partition(|(_, key)| lights.is_empty() || lights.contains(&key.2));
        let many = spare.len().saturating_sub(SPARE);
        for (_, key) in other.into_iter().chain(spare.into_iter().take(many)) {
            let Some(live) = self.shaders.remove(&key) else { continue };
            let asset = Shader::from_wgsl(RESTING, path_of_asset(key));
            // The asset is there as long as its handle.
            let _ = world.resource_mut::<Assets<Shader>>().insert(live.handle.id(), asset);
            self.resting.insert(key, live.handle);
        }
    }

    /// The latest that can be drawn with: the file of the model with the others as they last came through, else all
    /// as they last came through, else what is compiled in. Of the last, stand-ins replace the files of other crates
    /// that cannot be drawn with; their paths are returned with it. None yet while another process tries one of them.
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
        let (model, shading, lights) = parts;
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

    /// True if a source can be drawn with; none yet while another process tries it.
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
            // Users' shaders may read outside of arrays.
            shader.validate_shader = ValidateShader::Enabled;
        }
        shader
    }
}
