//! The shaders on the picture: composed when first needed, exchanged when a file they are made of changes, and
//! kept when the change cannot be drawn with.
//!
//! Each reflection model in each shading model has one shader, and each of those goes its own way: what a change of a shared
//! file breaks for one model does not disturb the others. A shader is exchanged only after it was tried
//! ([`trial`](super::trial)). Its asset stays the same, so cameras, materials and objects know nothing of it.

use std::{
    collections::{BTreeMap, BTreeSet, HashMap, HashSet},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use bevy::{
    app::{App, Plugin},
    asset::{Assets, Handle},
    ecs::prelude::*,
    render::{
        error_handler::{ErrorType, RenderError, RenderErrorHandler, RenderErrorPolicy},
        renderer::{RenderAdapter, RenderDevice},
    },
    shader::{Shader, ValidateShader},
};

use super::{
    entities::CurrentScene,
    overrides::Overrides,
    plugin::{LabFrame, LabSystems},
    swap::Drawn,
    trial::{Bench, COMPOSED, Tools, TrialPlugin, Verdict},
};
use crate::{
    custom,
    library::{
        assets::{Folders, built_in_sources},
        reading::{Done, Job, Reader},
        status::{Reloaded, ShaderStatus, Trouble},
    },
    optics::colour::Encoding,
    parameter::Values,
    reflection::{Ambient, ModelEntry},
    registry::{
        CustomModel, Registry,
        compose::{compose, compose_evaluation},
    },
    shader::{
        check::ShaderProblem,
        compose::{Composed, Sources, WRAPPER},
        limits,
        slim::slim,
    },
    shading::{ShadingEntry, Stage},
};

/// A broken file is not complained of so soon after it changed: many editors empty a file before they write it.
pub const GRACE: Duration = Duration::from_millis(150);
/// So long a frame may try shaders before it is drawn: with many on the picture, the window goes on answering.
const SLICE: Duration = Duration::from_millis(200);
/// As many custom models that were read are tried at the same time.
const ARRIVING: usize = 16;
/// How the paths of custom models begin.
const MODELS: &str = "models/";
/// A failure of the renderer so soon after an exchange is blamed on it.
const PROBATION: Duration = Duration::from_secs(5);
/// As many shaders that nothing is drawn with stay ready for a change back; each keeps some megabytes.
pub const SPARE: usize = 32;
/// The content of the others' assets: the least that a pipeline can be made of.
const RESTING: &str = "
@vertex fn vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> { return vec4(position, 1.0); }
@fragment fn fragment() -> @location(0) vec4<f32> { return vec4(0.0); }
";

/// Exchanges shaders while they are on the picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct LiveShadersPlugin;

impl Plugin for LiveShadersPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(TrialPlugin)
            .init_resource::<LiveShaders>()
            .insert_resource(RenderErrorHandler(take_back))
            .add_systems(LabFrame, exchange.in_set(LabSystems::Swap).before(crate::render::swap::swap));
    }
}

/// What tells shaders apart: model, shading model, and the number of light types that were known.
type Key = (&'static str, &'static str, usize);

fn key(model: &ModelEntry, shading: &ShadingEntry, registry: &Registry) -> Key {
    (model.declaration.id, shading.declaration.id, registry.lights().len())
}

/// What tells the layouts of rows of one model apart: equal declarations are one, as are equal parameters.
fn layout_of(model: &ModelEntry) -> [usize; 2] {
    [std::ptr::from_ref(model.declaration) as usize, model.parameters.as_ptr() as usize]
}

/// The path by which Bevy knows the asset of a shader.
fn path_of_asset(key: Key) -> String {
    format!("{COMPOSED}{}/{}.wgsl", key.0, key.1)
}

/// One shader.
struct Live {
    handle: Handle<Shader>,
    /// The declaration that it was made for.
    layout: [usize; 2],
    /// What is drawn with.
    shown: Composed,
    /// What was drawn with before, and until when: the renderer may still refuse what came after.
    before: Option<(Composed, Instant)>,
    /// What was tried last and refused, and why.
    refused: Option<Refused>,
    /// A file it is made of changed.
    due: bool,
    /// When it was last on the picture, in numbers of [`LiveShaders::rest`].
    seen: u64,
}

struct Refused {
    composed: Composed,
    problem: Box<ShaderProblem>,
    at: Instant,
}

/// The shaders by model and shading model, and the texts that they are made of.
#[derive(Default, Resource)]
pub struct LiveShaders {
    /// The texts of the files as they are.
    current: Sources,
    /// The text of each file as it last came through.
    good: Sources,
    shaders: HashMap<Key, Live>,
    /// The assets of shaders that are made anew when something is drawn with them again.
    resting: HashMap<Key, Handle<Shader>>,
    /// How often shaders were looked through for some that may rest.
    looks: u64,
    /// The files of custom models and their texts, whatever these are worth.
    own: BTreeMap<String, (PathBuf, String)>,
    /// Reads custom models.
    reader: Reader,
    /// Custom models that were read and are still to be tried.
    arriving: Vec<CustomModel>,
    /// An object waits for a shader that is tried for the first time.
    awaited: bool,
    /// The composed texts that were tried with success in this frame.
    approved: HashSet<String>,
    /// Files that cannot be read and custom models with mistakes, and since when.
    unusable: BTreeMap<String, (Vec<ShaderProblem>, Instant)>,
    /// Changed files that no shader is made of: whether they are right is tried on the side.
    unused: BTreeSet<String>,
    /// What is wrong with those.
    unused_problems: BTreeMap<String, (Box<ShaderProblem>, Instant)>,
    folders: Folders,
    /// True if there are texts to begin with.
    started: bool,
    /// The file that changed last, and when that became known.
    change: Option<(String, Instant)>,
    last: Option<Reloaded>,
    status: ShaderStatus,
    /// True if the status has to be made anew.
    stale_status: bool,
}

impl LiveShaders {
    /// Begins with these texts instead of the built-in ones, from these folders.
    pub fn start(&mut self, sources: Sources, folders: Folders) {
        self.current = sources;
        self.folders = folders;
        self.started = true;
        self.shaders.values_mut().for_each(|live| live.due = true);
        self.stale_status = true;
    }

    /// Where the shaders come from and what is wrong with them.
    #[must_use]
    pub fn status(&self) -> &ShaderStatus {
        &self.status
    }

    /// The texts of the files as they are.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.current
    }

    /// True if something is still to be tried or told, so that frames must go on.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.stale_status || self.is_trying()
    }

    /// True if something is still to be tried, so that the next picture may be another one.
    #[must_use]
    pub fn is_trying(&self) -> bool {
        self.awaited
            || self.reader.is_busy()
            || !self.unused.is_empty()
            || !self.arriving.is_empty()
            || self.shaders.values().any(|live| live.due)
    }

    /// The first problem that keeps a shader from being what its files say.
    #[must_use]
    pub fn refused(&self) -> Option<&ShaderProblem> {
        self.shaders.values().find_map(|live| live.refused.as_ref().map(|refused| &*refused.problem))
    }

    /// How many shaders are ready to be drawn with.
    #[must_use]
    pub fn ready(&self) -> usize {
        self.shaders.len()
    }

    /// True if what is drawn with is what the files say, all of it.
    #[must_use]
    pub fn is_up_to_date(&self) -> bool {
        !self.is_trying()
            && self.shaders.values().all(|live| live.refused.is_none())
            && self.unusable.is_empty()
            && self.unused_problems.is_empty()
    }

    /// The problems that are too young to be told.
    fn fresh_problems(&self) -> impl Iterator<Item = Instant> {
        let refused = self.shaders.values().filter_map(|live| live.refused.as_ref().map(|r| r.at));
        let unusable = self.unusable.values().map(|(_, at)| *at);
        let unused = self.unused_problems.values().map(|(_, at)| *at);
        refused.chain(unusable).chain(unused).filter(|at| at.elapsed() < GRACE)
    }

    /// The path by which a file on disk is known, if it is one of ours.
    #[must_use]
    pub fn path_of(&self, file: &Path) -> Option<String> {
        if file.extension().is_none_or(|e| e != "wgsl") {
            return None;
        }
        let below = |folder: &Option<PathBuf>, prefix: &str| {
            let rest = file.strip_prefix(folder.as_ref()?).ok()?;
            let parts: Option<Vec<_>> = rest.iter().map(|p| p.to_str()).collect();
            Some(format!("{prefix}{}", parts?.join("/")))
        };
        let shader = || below(&self.folders.shaders, "").filter(|path| !path.starts_with(MODELS));
        below(&self.folders.models, MODELS).or_else(shader)
    }

    /// The file on disk behind a path.
    #[must_use]
    pub fn file_of(&self, path: &str) -> Option<PathBuf> {
        if path.starts_with('(') {
            return None;
        }
        match path.strip_prefix(MODELS) {
            Some(name) => Some(self.folders.models.as_ref()?.join(name)),
            None => Some(self.folders.shaders.as_ref()?.join(path)),
        }
    }

    /// Reads a file that may have changed. Files that are none of ours are passed over; custom models go into the
    /// registry once they were tried.
    pub fn look_at(&mut self, file: &Path, registry: &mut Registry) {
        let Some(path) = self.path_of(file) else { return };
        let id =
            custom::id_of(file).filter(|_| path.strip_prefix(MODELS).is_some_and(|name| !name.contains('/')));
        match custom::file::read(file, &path) {
            Ok(text) if id.is_some() && custom::is_model(&text) => {
                let known = self.own.insert(path.clone(), (file.to_owned(), text.clone()));
                let first = known.is_none_or(|(_, known)| known != text) || self.unusable.contains_key(&path);
                let in_use = self.current.get(&path) == Some(&text);
                let registered = id.is_some_and(|id| registry.custom_file(id).is_some());
                if first && !(in_use && registered && !self.unusable.contains_key(&path)) {
                    self.read_model(&path, registry);
                }
            }
            Ok(text) => {
                self.own.remove(&path);
                self.change(&path, &text, registry);
            }
            Err(problem) => {
                self.own.remove(&path);
                let registered = id.is_some_and(|id| registry.custom_file(id).is_some());
                if registered || built_in(registry, &path).is_some() || self.current.get(&path).is_some() {
                    self.cannot_use(&path, vec![problem]);
                } else {
                    // Nothing was made of it, so nothing is missed.
                    self.stale_status |= self.unusable.remove(&path).is_some();
                }
            }
        }
    }

    /// Reads a custom model anew. One with a mistake leaves what is known of it as it was.
    fn read_model(&mut self, path: &str, registry: &mut Registry) {
        let Some((file, text)) = self.own.get(path).cloned() else { return };
        self.arriving.retain(|model| model.path != file);
        let job =
            Job { source: path.to_owned(), file, text, registry: registry.clone(), lenient: self.lenient() };
        if let Some(done) = self.reader.read(job) {
            self.take_read(done, registry);
        }
    }

    /// Takes what became of reading a custom model, unless its file has another text by now.
    fn take_read(&mut self, done: Done, registry: &mut Registry) {
        if self.own.get(&done.source).is_none_or(|(_, text)| *text != done.text) {
            return;
        }
        match done.result {
            Ok(model) => {
                self.change = Some((done.source, Instant::now()));
                self.arriving.push(model);
            }
            Err(problems) => self.refuse_model(&done.source, problems, registry),
        }
    }

    /// Reads the models that a scene uses and of which only the declaration is known.
    fn read_wanted(&mut self, world: &mut World) {
        let Some(scene) = world.get_resource::<CurrentScene>() else { return };
        let registry = world.resource::<Registry>();
        let overridden = world.try_query::<&Overrides>();
        let overridden = overridden.iter().flat_map(|query| query.iter_manual(world));
        let models = overridden.filter_map(|o| o.reflection_model.as_deref()).chain(scene.0.models());
        let wanted: Vec<_> = registry.wants_reading(models).map(Path::to_owned).collect();
        for file in wanted {
            // One that is known has a mistake.
            if self.path_of(&file).is_some_and(|path| !self.own.contains_key(&path)) {
                let mut registry = world.resource_mut::<Registry>();
                self.look_at(&file, registry.bypass_change_detection());
            }
        }
    }

    /// True while a model is read or tried for the first time.
    fn is_arriving(&self, model: &ModelEntry, registry: &Registry) -> bool {
        let source = model.declaration.wgsl.path;
        registry.unread_file(model.declaration.id).is_some()
            && !self.unusable.contains_key(source)
            && (self.reader.has(source)
                || self.arriving.iter().any(|m| m.entry.declaration.id == model.declaration.id))
    }

    /// Has custom models read on a thread of its own, which calls `wake`.
    pub fn read_apart(&mut self, wake: impl Fn() + Send + 'static) {
        self.reader = Reader::apart(wake);
    }

    /// True while a thread reads custom models; it wakes who waits.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.reader.is_reading()
    }

    /// A custom model has mistakes. A new one whose declaration is right can be chosen all the same, and is drawn as
    /// a stand-in.
    fn refuse_model(&mut self, path: &str, problems: Vec<ShaderProblem>, registry: &mut Registry) {
        if let Some((file, text)) = self.own.get(path)
            && custom::id_of(file).is_some_and(|id| registry.custom_file(id).is_none())
            && let Ok(model) = custom::declare(file, text, registry)
        {
            registry.put_stand_in(model);
        }
        self.cannot_use(path, problems);
    }

    /// The texts as they are, but of the files that all models share as they last came through.
    fn lenient(&self) -> Sources {
        let mut sources = self.current.clone();
        for path in self.current.edited().filter(|path| !path.starts_with(MODELS)) {
            sources.copy_from(&self.good, path);
        }
        sources
    }

    /// Tries the custom models that were read, and makes those known that can be drawn with: parameters, text and
    /// shader are exchanged together or not at all.
    fn adopt(&mut self, world: &mut World, visible: &Visible) {
        let mut arriving = std::mem::take(&mut self.arriving);
        self.arriving = arriving.split_off(arriving.len().min(ARRIVING));
        for model in arriving {
            let registry = world.resource::<Registry>().clone();
            let path = model.entry.declaration.wgsl.path;
            let shadings: Vec<_> = registry
                .shading_models()
                .iter()
                .filter(|m| visible.shows(model.entry.declaration.id, m))
                .collect();
            let shadings = if shadings.is_empty() {
                registry.shading_models().iter().take(1).collect()
            } else {
                shadings
            };
            let mut current = self.current.clone();
            current.edit(path, model.text.clone());
            let mut lenient = self.lenient();
            lenient.edit(path, model.text.clone());
            let verdict = shadings.into_iter().map(|shading| {
                let wanted = compose(&current, &model.entry, shading, registry.lights());
                match self.try_out(world, &wanted, &model.entry, shading) {
                    Verdict::Bad(_) => {
                        let wanted = compose(&lenient, &model.entry, shading, registry.lights());
                        self.try_out(world, &wanted, &model.entry, shading)
                    }
                    verdict => verdict,
                }
            });
            match verdict
                .collect::<Vec<_>>()
                .into_iter()
                .find(|v| *v != Verdict::Good)
                .unwrap_or(Verdict::Good)
            {
                Verdict::Good => {
                    self.current = current;
                    self.stale_status |= self.unusable.remove(path).is_some();
                    self.mark_due(path);
                    world.resource_mut::<Registry>().put_custom_model(model);
                }
                Verdict::Bad(problem) => {
                    let problem = self.blamed(problem, &Composed::default());
                    let mut registry = world.resource_mut::<Registry>();
                    self.refuse_model(path, vec![*problem], &mut registry);
                }
                Verdict::NotYet => self.arriving.push(model),
            }
        }
    }

    /// Tries a composed source, once.
    fn try_out(
        &mut self,
        world: &mut World,
        composed: &Composed,
        model: &ModelEntry,
        shading: &ShadingEntry,
    ) -> Verdict {
        if composed.problem.is_none() && self.approved.contains(&composed.text) {
            return Verdict::Good;
        }
        let verdict = try_out(world, composed, model, shading);
        if verdict == Verdict::Good {
            self.approved.insert(composed.text.clone());
        }
        verdict
    }

    /// Lets go of files that are gone and that nothing is made of.
    fn forget_gone(&mut self, world: &mut World, visible: &Visible) {
        let gone: Vec<_> = self
            .unusable
            .keys()
            .filter(|path| self.file_of(path).is_some_and(|file| !file.exists()))
            .filter(|path| !self.shaders.iter().any(|(k, l)| visible.has(k) && l.shown.depends_on(path)))
            .cloned()
            .collect();
        for path in gone {
            let id = custom::id_of(Path::new(&path)).filter(|_| path.starts_with(MODELS)).unwrap_or_default();
            let scene = world.get_resource::<CurrentScene>();
            if scene.is_some_and(|scene| {
                scene.0.reflection_model == id || scene.0.objects.iter().any(|o| scene.0.model_of(o) == id)
            }) {
                continue;
            }
            let mut registry = world.resource_mut::<Registry>();
            if built_in(&registry, &path).is_some() {
                continue;
            }
            registry.remove_model(id);
            registry.sources_mut().forget(&path);
            self.current.forget(&path);
            self.unusable.remove(&path);
        }
    }

    fn cannot_use(&mut self, path: &str, problems: Vec<ShaderProblem>) {
        if self.unusable.get(path).is_none_or(|(known, _)| *known != problems) {
            self.unusable.insert(path.to_owned(), (problems, Instant::now()));
            self.stale_status = true;
        }
    }

    /// A file has another text. Nothing happens when it is the one that is known.
    fn change(&mut self, path: &str, text: &str, registry: &mut Registry) {
        self.stale_status |= self.unusable.remove(path).is_some();
        let built_in = built_in(registry, path);
        let known = self.current.get(path).or(built_in);
        if known == Some(text) {
            return;
        }
        match built_in {
            Some(original) if original == text => self.current.forget(path),
            _ => self.current.edit(path, text),
        }
        registry.sources_mut().copy_from(&self.current, path);
        self.read_again(path, registry);
        self.change = Some((path.to_owned(), Instant::now()));
        if self.mark_due(path) {
            self.unused_problems.remove(path);
        } else {
            self.unused.insert(path.to_owned());
        }
    }

    /// The shaders that a file is part of are to be tried; whether there is one.
    fn mark_due(&mut self, path: &str) -> bool {
        let mut used = false;
        for live in self.shaders.values_mut() {
            let candidate = live.refused.as_ref().is_some_and(|r| r.composed.depends_on(path));
            if candidate || live.shown.depends_on(path) {
                live.due = true;
                used = true;
            }
        }
        used
    }

    /// Reads the custom models again that a change of another file may mend or change. Those that only share its
    /// functions need it if the CPU calculates their answer to uniform light, and they were drawn.
    fn read_again(&mut self, path: &str, registry: &mut Registry) {
        let concerned = |own_path: &str| {
            let Some(model) = registry.models().iter().find(|m| m.declaration.wgsl.path == own_path) else {
                return false;
            };
            let composed = compose_evaluation(&self.current, model);
            let drawn = || self.shaders.keys().any(|key| key.0 == model.declaration.id);
            composed.imports.contains(path)
                || (model.declaration.ambient == Ambient::Albedo && composed.depends_on(path) && drawn())
        };
        let again: Vec<_> = self
            .own
            .keys()
            .filter(|own| *own != path && (self.unusable.contains_key(*own) || concerned(own)))
            .cloned()
            .collect();
        again.iter().for_each(|own| self.read_model(own, registry));
    }

    /// The shader of a model and a shading model; none yet while another process tries it.
    pub(crate) fn get(
        &mut self,
        world: &mut World,
        model: &ModelEntry,
        shading: &ShadingEntry,
        registry: &Registry,
    ) -> Option<Handle<Shader>> {
        let key = key(model, shading, registry);
        let layout = layout_of(model);
        if let Some(live) = self.shaders.get(&key).filter(|live| live.layout == layout) {
            return Some(live.handle.clone());
        }
        if !self.started {
            self.started = true;
            self.current = registry.sources().clone();
        }
        if self.is_arriving(model, registry) {
            self.awaited = true;
            return None;
        }
        let wanted = compose(&self.current, model, shading, registry.lights());
        // From here on these files are used.
        for path in wanted.map.files() {
            self.unused.remove(path);
            self.unused_problems.remove(path);
        }
        let mut refused = None;
        let mut due = false;
        let mut shown = None;
        if self.is_built_in(&wanted) {
            shown = Some(wanted);
        } else {
            match self.try_out(world, &wanted, model, shading) {
                Verdict::Good => {
                    self.note_good(&wanted);
                    shown = Some(wanted);
                }
                Verdict::Bad(problem) => {
                    refused = Some(Refused { composed: wanted, problem, at: Instant::now() })
                }
                Verdict::NotYet if world.resource::<Bench>().is_waiting() => {
                    self.awaited = true;
                    return None;
                }
                Verdict::NotYet => due = true,
            }
        }
        let shown = match shown {
            Some(shown) => shown,
            None => self.last_good(world, model, shading, registry)?,
        };
        let asset = self.asset(&shown, key);
        let replaced = self.replaced(key, registry);
        let mut assets = world.resource_mut::<Assets<Shader>>();
        let handle = match replaced {
            Some(handle) => {
                // The asset is there as long as its handle.
                let _ = assets.insert(handle.id(), asset);
                handle
            }
            None => assets.add(asset),
        };
        self.stale_status = true;
        let seen = self.looks;
        let live = Live { handle: handle.clone(), layout, shown, before: None, refused, due, seen };
        self.shaders.insert(key, live);
        Some(handle)
    }

    /// The asset that a shader takes over: that of the same model as it was declared before or as it rested, or of an
    /// custom model that is gone. Bevy never lets go of a pipeline, but makes it anew when its shader changes; with an
    /// asset for each declaration, each would keep megabytes.
    fn replaced(&mut self, key: Key, registry: &Registry) -> Option<Handle<Shader>> {
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
    fn rest(&mut self, world: &mut World, visible: &Visible) {
        self.looks += 1;
        for (_, live) in self.shaders.iter_mut().filter(|(key, _)| visible.has(key)) {
            live.seen = self.looks;
        }
        let idle = |(key, live): &(&Key, &Live)| !visible.has(key) && !live.due && live.refused.is_none();
        let mut idle: Vec<_> =
            self.shaders.iter().filter(idle).map(|(key, live)| (live.seen, *key)).collect();
        idle.sort_unstable();
        let many = idle.len().saturating_sub(SPARE);
        for (_, key) in idle.into_iter().take(many) {
            let Some(live) = self.shaders.remove(&key) else { continue };
            let asset = Shader::from_wgsl(RESTING, path_of_asset(key));
            // The asset is there as long as its handle.
            let _ = world.resource_mut::<Assets<Shader>>().insert(live.handle.id(), asset);
            self.resting.insert(key, live.handle);
        }
    }

    /// The latest that can be drawn with: the file of the model with the others as they last came through, else all
    /// as they last came through, else what is built in. None yet while another process tries one of them.
    fn last_good(
        &mut self,
        world: &mut World,
        model: &ModelEntry,
        shading: &ShadingEntry,
        registry: &Registry,
    ) -> Option<Composed> {
        for sources in [self.lenient(), self.good.clone()] {
            let composed = compose(&sources, model, shading, registry.lights());
            if self.is_built_in(&composed) {
                return Some(composed);
            }
            match self.try_out(world, &composed, model, shading) {
                Verdict::Good => return Some(composed),
                Verdict::NotYet if world.resource::<Bench>().is_waiting() => {
                    self.awaited = true;
                    return None;
                }
                Verdict::Bad(_) | Verdict::NotYet => {}
            }
        }
        Some(compose(&Sources::default(), model, shading, registry.lights()))
    }

    /// True if a composed source holds nothing but what was built in, which tests have tried.
    fn is_built_in(&self, composed: &Composed) -> bool {
        let edited = |path: &str| self.current.get(path).is_some() || self.good.get(path).is_some();
        !composed.map.files().any(edited) && composed.problem.is_none()
    }

    fn asset(&self, composed: &Composed, key: Key) -> Shader {
        let mut shader = Shader::from_wgsl(slim(&composed.text), path_of_asset(key));
        if !self.is_built_in(composed) {
            // What users write may read outside of arrays.
            shader.validate_shader = ValidateShader::Enabled;
        }
        shader
    }

    fn note_good(&mut self, composed: &Composed) {
        let Self { good, current, .. } = self;
        composed.map.files().for_each(|path| good.copy_from(current, path));
    }

    /// Tries what is due, for as long as a frame may take: first what is on the picture; then, one in a frame, what
    /// is not.
    fn work(&mut self, world: &mut World, registry: &Registry, visible: &Visible) {
        let begin = Instant::now();
        // Shaders of older declarations are made anew when something is drawn with them.
        for (key, live) in &mut self.shaders {
            if registry.model(key.0).is_some_and(|model| layout_of(model) != live.layout) {
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

    /// Exchanges a shader for what its files say now, if that can be drawn with.
    fn refresh(&mut self, world: &mut World, registry: &Registry, key: Key) {
        let entries = registry.model(key.0).zip(registry.shading_model(key.1));
        let Some((model, shading)) =
            entries.filter(|(model, shading)| self::key(model, shading, registry) == key)
        else {
            // Other light types were known then; nothing is drawn with it any more.
            if let Some(live) = self.shaders.get_mut(&key) {
                live.due = false;
            }
            return;
        };
        let wanted = compose(&self.current, model, shading, registry.lights());
        let shown_already = self.shaders.get(&key).is_some_and(|live| live.shown == wanted);
        let verdict = if shown_already || self.is_built_in(&wanted) {
            Verdict::Good
        } else {
            self.try_out(world, &wanted, model, shading)
        };
        if verdict == Verdict::Good {
            self.note_good(&wanted);
        }
        let asset = self.asset(&wanted, key);
        let Some(live) = self.shaders.get_mut(&key) else { return };
        live.due = verdict == Verdict::NotYet;
        match verdict {
            Verdict::Good if shown_already => live.refused = None,
            Verdict::Good => {
                let id = live.handle.id();
                // The asset is there as long as its handle.
                let _ = world.resource_mut::<Assets<Shader>>().insert(id, asset);
                live.before = Some((std::mem::replace(&mut live.shown, wanted), Instant::now()));
                live.refused = None;
                if let Some((file, since)) = &self.change {
                    let milliseconds = since.elapsed().as_secs_f32() * 1e3;
                    self.last = Some(Reloaded { file: file.clone(), milliseconds });
                }
            }
            Verdict::Bad(problem) => {
                let problem = self.blamed(problem, &wanted);
                let Some(live) = self.shaders.get_mut(&key) else { return };
                // The same problem again keeps its age.
                let at = live
                    .refused
                    .as_ref()
                    .filter(|r| r.problem == problem)
                    .map_or_else(Instant::now, |r| r.at);
                live.refused = Some(Refused { composed: wanted, problem, at });
            }
            Verdict::NotYet => {}
        }
        self.stale_status = true;
    }

    /// Names the file that was edited where a problem shows in another one: one that is empty, or where something is
    /// used that is not there any more.
    fn blamed(&self, mut problem: Box<ShaderProblem>, composed: &Composed) -> Box<ShaderProblem> {
        if self.current.get(&problem.file).is_some() {
            return problem;
        }
        let changed = self.change.as_ref().map(|(file, _)| file.as_str());
        let text = |path: &str| self.current.get(path).or_else(|| Some(&*self.own.get(path)?.1));
        let edited = || composed.map.files().filter(|path| text(path).is_some());
        let empty = || edited().find(|path| text(path).is_some_and(limits::is_empty));
        let Some(cause) =
            empty().or_else(|| changed.filter(|path| composed.depends_on(path))).or_else(|| edited().next())
        else {
            return problem;
        };
        let text = text(cause).unwrap_or_default();
        let generated = problem.file.starts_with('(');
        if !generated && !limits::is_empty(text) {
            problem.message.push_str(&format!("; introduced by the change in {cause}"));
            return problem;
        }
        let last = text.trim_end().lines().last().unwrap_or_default();
        Box::new(ShaderProblem {
            file: cause.to_owned(),
            line: text.trim_end().lines().count().max(1),
            column: last.chars().count().max(1),
            source: last.to_owned(),
            message: match text.trim().is_empty() {
                true => format!("the file is empty; {}", problem.message),
                false => format!("behind the end of the file: {}", problem.message),
            },
        })
    }

    /// Tries a file that nothing on the picture is made of, with a model or shading model that it belongs to.
    fn try_unused(&mut self, world: &mut World, registry: &Registry, visible: &Visible, path: &str) {
        let shadings = registry.shading_models();
        let models = registry.models();
        let shading = shadings.iter().find(|m| m.declaration.wgsl.path == path);
        let model = models.iter().find(|m| m.declaration.wgsl.path == path);
        if shading.is_none() && model.is_none() {
            return;
        }
        let shown_shading =
            || shadings.iter().find(|m| visible.0.iter().any(|(_, id)| id == m.declaration.id));
        let Some((model, shading)) =
            model.or(models.first()).zip(shading.or_else(shown_shading).or(shadings.first()))
        else {
            return;
        };
        let composed = compose(&self.current, model, shading, registry.lights());
        match self.try_out(world, &composed, model, shading) {
            Verdict::Good => {
                self.unused_problems.remove(path);
                self.note_good(&composed);
            }
            Verdict::Bad(problem) => {
                let problem = self.blamed(problem, &composed);
                self.unused_problems.insert(path.to_owned(), (problem, Instant::now()));
            }
            Verdict::NotYet => {
                self.unused.insert(path.to_owned());
            }
        }
        self.stale_status = true;
    }

    /// Writes down what people are told.
    fn tell(&mut self, registry: &Registry, visible: &Visible) {
        let mut troubles: Vec<Trouble> = Vec::new();
        let mut add = |problem: &ShaderProblem, stale: Option<String>| {
            let i = troubles.iter().position(|t| t.problem == *problem).unwrap_or_else(|| {
                let path = self.file_of(&problem.file);
                troubles.push(Trouble { problem: problem.clone(), path, stale: Vec::new() });
                troubles.len() - 1
            });
            if let Some(name) = stale
                && !troubles[i].stale.contains(&name)
            {
                troubles[i].stale.push(name);
            }
        };
        let name = |key: &Key| match registry.model(key.0) {
            // A file that was never right.
            Some(m)
                if registry.custom_file(key.0).is_some()
                    && self.current.get(m.declaration.wgsl.path).is_none() =>
            {
                format!("{} (a grey stand-in)", m.declaration.name)
            }
            Some(model) => model.declaration.name.to_owned(),
            None => key.0.to_owned(),
        };
        let old = |at: &Instant| at.elapsed() >= GRACE;
        let mut keys: Vec<_> = self.shaders.keys().collect();
        keys.sort_unstable();
        for (path, (problems, _)) in self.unusable.iter().filter(|(_, (_, at))| old(at)) {
            for problem in problems {
                add(problem, None);
                for key in keys.iter().filter(|k| visible.has(k) && self.shaders[**k].shown.depends_on(path))
                {
                    add(problem, Some(name(key)));
                }
            }
        }
        for key in keys {
            if let Some(refused) = self.shaders[key].refused.as_ref().filter(|r| old(&r.at)) {
                add(&refused.problem, visible.has(key).then(|| name(key)));
            }
        }
        for (problem, _) in self.unused_problems.values().filter(|(_, at)| old(at)) {
            add(problem, None);
        }
        let Folders { shaders, models } = self.folders.clone();
        let status = ShaderStatus { shaders, models, troubles, last: self.last.clone() };
        if self.status != status {
            self.status = status;
        }
    }
}

/// The models and shading models on the picture.
struct Visible(Vec<(String, String)>);

impl Visible {
    fn of(world: &mut World) -> Self {
        let mut query = world.query::<&Drawn>();
        let mut pairs: Vec<_> =
            query.iter(world).map(|d| (d.model().to_owned(), d.shading().to_owned())).collect();
        pairs.sort_unstable();
        pairs.dedup();
        Self(pairs)
    }

    fn shows(&self, model: &str, shading: &ShadingEntry) -> bool {
        self.0.iter().any(|(m, s)| m == model && s == shading.declaration.id)
    }

    fn has(&self, key: &Key) -> bool {
        self.0.iter().any(|(model, shading)| model == key.0 && shading == key.1)
    }
}

/// Exchanges the shaders whose files changed.
fn exchange(world: &mut World) {
    let mut overrides = world.query_filtered::<(), Changed<Overrides>>();
    if world.is_resource_changed::<CurrentScene>() || overrides.iter(world).next().is_some() {
        world.resource_scope(|world, mut live: Mut<LiveShaders>| live.read_wanted(world));
    }
    if !world.resource::<LiveShaders>().is_busy() {
        return;
    }
    let visible = Visible::of(world);
    world.resource_scope(|world, mut live: Mut<LiveShaders>| {
        for done in live.reader.finished() {
            let mut registry = world.resource_mut::<Registry>();
            live.take_read(done, registry.bypass_change_detection());
        }
        live.approved.clear();
        live.awaited = false;
        world.resource::<Bench>().begin_frame();
        live.adopt(world, &visible);
        let registry = world.resource::<Registry>().clone();
        live.work(world, &registry, &visible);
        if live.shaders.iter().any(|(key, shader)| shader.due && visible.has(key)) {
            // What is wrong is told when all of it is known.
            live.stale_status = true;
            return;
        }
        live.forget_gone(world, &visible);
        live.rest(world, &visible);
        // Problems that are too young now are told later.
        let young = live.fresh_problems().next().is_some();
        live.stale_status = young;
        live.tell(&registry, &visible);
    });
}

fn try_out(world: &mut World, composed: &Composed, model: &ModelEntry, shading: &ShadingEntry) -> Verdict {
    let (Some(device), Some(adapter)) =
        (world.get_resource::<RenderDevice>().cloned(), world.get_resource::<RenderAdapter>().cloned())
    else {
        return Verdict::NotYet;
    };
    world.resource_scope(|world, mut bench: Mut<Bench>| {
        let tools = Tools { device: &device, adapter: &adapter, shaders: world.resource::<Assets<Shader>>() };
        let row = || model.row(&Values::default(), Encoding::Srgb, false);
        bench.try_out(composed, shading.declaration.stage == Stage::Polygon, row, tools)
    })
}

/// The renderer failed all the same: goes back to what was drawn with before. Where nothing was exchanged, the
/// cause is another, and the program ends as Bevy has it.
fn take_back(error: &RenderError, main: &mut World, render: &mut World) -> RenderErrorPolicy {
    let usual = RenderErrorHandler::default().0;
    if !matches!(error.ty, ErrorType::Validation | ErrorType::Internal) {
        return usual(error, main, render);
    }
    let what = error.description.lines().map(str::trim).collect::<Vec<_>>().join(" ");
    let mut taken_back = false;
    main.resource_scope(|main, mut live: Mut<LiveShaders>| {
        let live = &mut *live;
        let file = live.change.as_ref().map_or_else(|| WRAPPER.path.to_owned(), |(file, _)| file.clone());
        let mut shaders = main.resource_mut::<Assets<Shader>>();
        for (key, entry) in &mut live.shaders {
            let Some((before, _)) = entry.before.take_if(|(_, at)| at.elapsed() < PROBATION) else {
                continue;
            };
            let refused = std::mem::replace(&mut entry.shown, before);
            let asset = Shader::from_wgsl(entry.shown.text.clone(), path_of_asset(*key));
            let _ = shaders.insert(entry.handle.id(), asset);
            let problem = Box::new(ShaderProblem {
                file: file.clone(),
                line: 1,
                column: 1,
                source: String::new(),
                message: format!("the graphics driver failed while drawing with it: {what}"),
            });
            entry.refused = Some(Refused { composed: refused, problem, at: Instant::now() });
            taken_back = true;
        }
        live.stale_status |= taken_back;
    });
    if taken_back { RenderErrorPolicy::Ignore } else { usual(error, main, render) }
}

/// The built-in text of a path.
fn built_in(registry: &Registry, path: &str) -> Option<&'static str> {
    built_in_sources(registry).into_iter().find(|s| s.path == path).map(|s| s.text)
}
