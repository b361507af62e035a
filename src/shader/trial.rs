//! Trying out a shader before it is drawn with.
//!
//! Bevy puts a changed shader on the picture whatever it is: when it cannot be compiled, the mesh or the whole
//! frame is lost. So each one is first composed as Bevy would compose it, in a [`ShaderCache`] of our own that
//! validates in release builds too, and then made into a pipeline that nothing is drawn with, inside an error
//! scope of the graphics driver. What comes through both can be drawn with.

use std::{
    borrow::Cow,
    cell::Cell,
    panic::{self, AssertUnwindSafe},
    sync::{Arc, Mutex, Once, PoisonError},
};

use bevy::{
    app::{App, Plugin},
    asset::{AssetId, Assets, uuid::Uuid},
    ecs::prelude::*,
    mesh::VertexBufferLayout,
    render::{
        Render, RenderApp, RenderSystems,
        render_resource::{
            BindGroupLayout, CachedPipelineState, PipelineCache, PipelineDescriptor,
            PipelineLayoutDescriptor, RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource,
            VertexAttribute, VertexFormat,
        },
        renderer::{RenderAdapter, RenderDevice},
    },
    shader::{Shader, ShaderCache, ShaderCacheError, ShaderCacheSource, ShaderDefVal, ShaderImport},
    tasks::block_on,
};
use naga::{Module, Span, front::wgsl::ParseError};
use naga_oil::compose::{ComposerError, ComposerErrorInner, ErrSource};

use super::{
    check::{self, ShaderProblem, locate, reason},
    compose::Composed,
    limits, pitfall,
};

/// The mark in the pipelines of our materials, by which one is found as an example.
pub const MARK: &str = "LAB_SURFACE";
/// As naga_oil packs the number of a module into positions in the text.
const POSITION: usize = (1 << 21) - 1;

/// What became of trying.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It can be drawn with.
    Good,
    /// It cannot, and this is why.
    Bad(Box<ShaderProblem>),
    /// Nothing has been drawn yet, so there is nothing to compare with. Ask again after the next frame.
    NotYet,
}

/// A pipeline of our materials as Bevy made it, to be made again with another shader.
struct Example {
    descriptor: RenderPipelineDescriptor,
    layouts: Vec<BindGroupLayout>,
}

/// The example, filled by the renderer as soon as there is one.
#[derive(Clone, Default, Resource)]
struct SharedExample(Arc<Mutex<Option<Example>>>);

impl SharedExample {
    fn lock(&self) -> std::sync::MutexGuard<'_, Option<Example>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Lets shaders be tried: makes [`Bench`] a resource.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrialPlugin;

impl Plugin for TrialPlugin {
    fn build(&self, app: &mut App) {
        let example = SharedExample::default();
        app.insert_resource(Bench { example: example.clone(), cache: None });
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app
                .insert_resource(example)
                .add_systems(Render, find_example.in_set(RenderSystems::Cleanup));
        }
    }
}

/// Keeps the first of our pipelines that works.
fn find_example(example: Res<SharedExample>, cache: Res<PipelineCache>) {
    let mut example = example.lock();
    if example.is_some() {
        return;
    }
    let found = cache.pipelines().find_map(|pipeline| match (&pipeline.descriptor, &pipeline.state) {
        (PipelineDescriptor::RenderPipelineDescriptor(d), CachedPipelineState::Ok(_))
            if d.vertex.shader_defs.iter().any(|def| *def == MARK.into()) =>
        {
            Some(d)
        }
        _ => None,
    });
    if let Some(descriptor) = found {
        let layouts = descriptor.layout.iter().map(|l| cache.get_bind_group_layout(l)).collect();
        *example = Some(Example { descriptor: (**descriptor).clone(), layouts });
    }
}

/// Where shaders are tried.
#[derive(Resource)]
pub struct Bench {
    example: SharedExample,
    /// With Bevy's own shaders in it, which ours import.
    cache: Option<ShaderCache<Module, ()>>,
}

impl std::fmt::Debug for Bench {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bench").finish_non_exhaustive()
    }
}

/// What the renderer lends for a trial.
#[derive(Clone, Copy)]
pub struct Tools<'a> {
    /// The graphics device.
    pub device: &'a RenderDevice,
    /// Where it comes from.
    pub adapter: &'a RenderAdapter,
    /// All shaders that are loaded, Bevy's own among them.
    pub shaders: &'a Assets<Shader>,
}

impl Bench {
    /// Whether the renderer can draw with a composed source, on meshes that know their polygons or not.
    pub fn try_out(&mut self, composed: &Composed, faces: bool, tools: Tools) -> Verdict {
        if let Some(problem) = &composed.problem {
            return Verdict::Bad(problem.clone());
        }
        if let Err(problem) = limits::check_text(composed) {
            return Verdict::Bad(problem);
        }
        let example = self.example.clone();
        let example = example.lock();
        let Some(example) = example.as_ref() else { return Verdict::NotYet };
        // What composes shaders unwraps here and there.
        match quietly(|| self.attempt(composed, faces, example, tools)) {
            Some(Ok(())) => Verdict::Good,
            Some(Err(Refusal::NotYet)) => Verdict::NotYet,
            Some(Err(Refusal::Problem(problem))) => Verdict::Bad(problem),
            None => {
                // The cache may be left half changed.
                self.cache = None;
                Verdict::Bad(without_place(composed))
            }
        }
    }

    fn attempt(
        &mut self,
        composed: &Composed,
        faces: bool,
        example: &Example,
        tools: Tools,
    ) -> Result<(), Refusal> {
        let cache = self.cache.get_or_insert_with(|| library(tools));
        let mut descriptor = example.descriptor.clone();
        if faces != has_faces(&descriptor.vertex.shader_defs) {
            change_faces(&mut descriptor, faces);
        }
        let mut modules = Vec::new();
        let fragment_defs = descriptor.fragment.iter().map(|f| &f.shader_defs);
        for defs in [&descriptor.vertex.shader_defs].into_iter().chain(fragment_defs) {
            if modules.iter().any(|(known, _)| *known == defs) {
                continue;
            }
            let module = compose(cache, composed, defs, tools)?;
            if let Some((span, message)) = limits::check_module(&module).or_else(|| pitfall::find(&module)) {
                let offset = offset(&module, &composed.text);
                return Err(located(composed, offset, [span].into_iter(), message));
            }
            modules.push((defs, module));
        }
        let module_of = |defs: &Vec<ShaderDefVal>| {
            modules
                .iter()
                .find(|(known, _)| *known == defs)
                .map(|(_, module)| module.clone())
                .unwrap_or_default()
        };
        let vertex = module_of(&descriptor.vertex.shader_defs);
        let fragment = descriptor.fragment.as_ref().map(|f| module_of(&f.shader_defs)).unwrap_or_default();
        build(&descriptor, &example.layouts, vertex, fragment, tools.device)
            .map_err(|error| Refusal::Problem(refused(composed, &error)))
    }
}

thread_local! {
    /// Whether a panic of this thread is expected, and nobody's business.
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Calls a function that may panic; none if it did, and nothing is printed.
fn quietly<T>(call: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !EXPECTED.get() {
                usual(info);
            }
        }));
    });
    EXPECTED.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(call));
    EXPECTED.set(false);
    result.ok()
}

/// Why a trial did not succeed.
enum Refusal {
    NotYet,
    Problem(Box<ShaderProblem>),
}

/// A cache that knows Bevy's shaders.
fn library(tools: Tools) -> ShaderCache<Module, ()> {
    let downlevel = tools.adapter.get_downlevel_capabilities().flags;
    let mut cache = ShaderCache::new((), tools.device.features(), downlevel, |(), source, _| match source {
        ShaderCacheSource::Naga(module) => Ok(module),
        _ => Err(ShaderCacheError::CreateShaderModule("only WGSL is expected".to_owned())),
    });
    // Off in release builds otherwise.
    cache.composer.validate = true;
    for (id, shader) in tools.shaders.iter() {
        if !shader.path.starts_with(COMPOSED) {
            cache.set_shader(id, with_limits(shader.clone(), tools.device));
        }
    }
    cache
}

/// How the paths of our own composed shaders begin.
pub const COMPOSED: &str = "composed/";

/// The asset that candidates have in the cache.
const CANDIDATE: AssetId<Shader> = AssetId::Uuid { uuid: Uuid::from_u128(0x4c43_4d05) };

/// What Bevy tells every shader about the device.
fn with_limits(mut shader: Shader, device: &RenderDevice) -> Shader {
    let buffers = device.limits().max_storage_buffers_per_shader_stage;
    shader.shader_defs.push(ShaderDefVal::UInt("AVAILABLE_STORAGE_BUFFER_BINDINGS".to_owned(), buffers));
    shader
}

fn compose(
    cache: &mut ShaderCache<Module, ()>,
    composed: &Composed,
    defs: &[ShaderDefVal],
    tools: Tools,
) -> Result<Module, Refusal> {
    let shader = Shader::from_wgsl(composed.text.clone(), format!("{COMPOSED}candidate.wgsl"));
    let imports = shader.imports.clone();
    cache.set_shader(CANDIDATE, with_limits(shader, tools.device));
    match cache.get(0, CANDIDATE, defs) {
        Ok(module) => Ok((*module).clone()),
        Err(ShaderCacheError::ProcessShaderError(error)) => Err(refusal(composed, &error)),
        Err(ShaderCacheError::ShaderImportNotYetAvailable | ShaderCacheError::ShaderNotLoaded(_)) => {
            let known = |import: &ShaderImport| tools.shaders.iter().any(|(_, s)| s.import_path == *import);
            match imports.iter().find(|import| !known(import)) {
                Some(missing) => {
                    Err(Refusal::Problem(unknown_import(composed, &missing.module_name(), tools)))
                }
                None => Err(Refusal::NotYet),
            }
        }
        Err(error) => Err(Refusal::Problem(locate(composed, None, error.to_string()))),
    }
}

/// That a module of Bevy is asked for that there is not: by the line that imports it, or by the line that uses a
/// name that nothing imports.
fn unknown_import(composed: &Composed, name: &str, tools: Tools) -> Box<ShaderProblem> {
    let modules: Vec<_> =
        tools.shaders.iter().map(|(_, s)| s.import_path.module_name().into_owned()).collect();
    let exists = |path: &str| modules.iter().any(|m| path == m || path.starts_with(&format!("{m}::")));
    let lines = || composed.text.lines().enumerate();
    let wrong = lines().find_map(|(i, line)| {
        let rest = line.trim_start().strip_prefix("#import")?.trim_start();
        let path = rest.split([' ', '{', ',']).next()?.trim_end_matches(':');
        (!exists(path)).then_some((i + 1, path))
    });
    if let Some((line, path)) = wrong {
        let message = format!(
            "there is no module `{path}` to import; files of your own are imported by name: `#import \"file.wgsl\"`"
        );
        return locate(composed, Some((line, 1)), message);
    }
    let used = lines().find_map(|(i, line)| Some((i + 1, line.find(&format!("{name}::"))? + 1)));
    locate(composed, used, format!("`{name}` is used, but no `#import` brings it"))
}

/// What the composer says, in terms of the author's file.
fn refusal(composed: &Composed, error: &ComposerError) -> Refusal {
    let offset = match &error.source {
        ErrSource::Constructing { offset, .. } => *offset,
        // In one of Bevy's own modules: what imports it stands in the wrapper.
        ErrSource::Module { name, .. } => {
            let line = composed.text.lines().position(|l| l.contains(name.as_str())).map(|l| (l + 1, 1));
            return Refusal::Problem(locate(composed, line, error.inner.to_string()));
        }
    };
    let parse = |e: &ParseError| located(composed, offset, e.labels().map(|l| l.0), e.message().to_owned());
    match &error.inner {
        ComposerErrorInner::WgslParseError(e) => parse(e),
        ComposerErrorInner::HeaderValidationError(e) | ComposerErrorInner::ShaderValidationError(e) => {
            located(composed, offset, e.spans().map(|s| s.0), reason(e.as_inner()))
        }
        ComposerErrorInner::InvalidIdentifier { at, .. } => {
            located(composed, offset, [*at].into_iter(), error.inner.to_string())
        }
        ComposerErrorInner::ImportParseError(_, at)
        | ComposerErrorInner::ImportNotFound(_, at)
        | ComposerErrorInner::NotEnoughEndIfs(at)
        | ComposerErrorInner::TooManyEndIfs(at)
        | ComposerErrorInner::ElseWithoutCondition(at)
        | ComposerErrorInner::UnknownShaderDef { pos: at, .. }
        | ComposerErrorInner::UnknownShaderDefOperator { pos: at, .. }
        | ComposerErrorInner::InvalidShaderDefComparisonValue { pos: at, .. }
        | ComposerErrorInner::OverrideNotVirtual { pos: at, .. }
        | ComposerErrorInner::DefineInModule(at)
        | ComposerErrorInner::InvalidShaderDefDefinitionValue { pos: at, .. } => {
            let span = Span::new(*at as u32, *at as u32 + 1);
            located(composed, 0, [span].into_iter(), error.inner.to_string())
        }
        ComposerErrorInner::DecorationInSource(range) => {
            let span = Span::new(range.start as u32, range.end as u32);
            located(composed, 0, [span].into_iter(), error.inner.to_string())
        }
        other => Refusal::Problem(locate(composed, None, other.to_string())),
    }
}

/// A problem at the first of some places that are one. The composer puts `offset` bytes before our text, and
/// replaces what it handles by as many spaces, so that lines and columns stay.
fn located(
    composed: &Composed,
    offset: usize,
    spans: impl Iterator<Item = Span>,
    message: String,
) -> Refusal {
    let text = &composed.text;
    let place = spans
        .filter_map(|span| span.to_range())
        .filter_map(|range| (range.start & POSITION).checked_sub(offset))
        .find(|at| *at < text.len() && text.is_char_boundary(*at))
        .map(|at| {
            let before = &text[..at];
            let line_start = before.rfind('\n').map_or(0, |i| i + 1);
            (before.matches('\n').count() + 1, text[line_start..at].chars().count() + 1)
        });
    Refusal::Problem(locate(composed, place, message))
}

/// How far positions in a composed module are behind those in our text: what most functions say.
fn offset(module: &Module, text: &str) -> usize {
    let mut offsets: Vec<usize> = module
        .functions
        .iter()
        .filter_map(|(handle, function)| {
            let start = module.functions.get_span(handle).to_range()?.start & POSITION;
            start.checked_sub(text.find(&format!("fn {}(", function.name.as_deref()?))?)
        })
        .collect();
    offsets.sort_unstable();
    let runs = offsets.chunk_by(|a, b| a == b);
    runs.max_by_key(|run| run.len()).and_then(|run| run.first()).copied().unwrap_or(0)
}

fn has_faces(defs: &[ShaderDefVal]) -> bool {
    defs.iter().any(|def| *def == "FACES".into())
}

/// Turns the example into one for meshes that know their polygons, or back.
fn change_faces(descriptor: &mut RenderPipelineDescriptor, faces: bool) {
    let change = |defs: &mut Vec<ShaderDefVal>| {
        defs.retain(|def| *def != "FACES".into());
        if faces {
            defs.push("FACES".into());
        }
    };
    change(&mut descriptor.vertex.shader_defs);
    if let Some(fragment) = descriptor.fragment.as_mut() {
        change(&mut fragment.shader_defs);
    }
    let count = if faces { 6 } else { 3 };
    let attributes = (0..count)
        .map(|i| VertexAttribute {
            format: VertexFormat::Float32x3,
            offset: 12 * i,
            shader_location: i as u32,
        })
        .collect();
    if let Some(buffer) = descriptor.vertex.buffers.first_mut() {
        *buffer = VertexBufferLayout { array_stride: 12 * count, attributes, ..buffer.clone() };
    }
}

/// Makes a pipeline that nothing is drawn with; what the driver says against it.
fn build(
    descriptor: &RenderPipelineDescriptor,
    layouts: &[BindGroupLayout],
    vertex: Module,
    fragment: Module,
    device: &RenderDevice,
) -> Result<(), wgpu::Error> {
    let wgpu_device = device.wgpu_device();
    // Scopes belong to the thread, so all of this happens here and now.
    let internal = wgpu_device.push_error_scope(wgpu::ErrorFilter::Internal);
    let validation = wgpu_device.push_error_scope(wgpu::ErrorFilter::Validation);
    let module = |module: Module| {
        device.create_and_validate_shader_module(ShaderModuleDescriptor {
            label: None,
            source: ShaderSource::Naga(Cow::Owned(module)),
        })
    };
    let (vertex, fragment) = (module(vertex), module(fragment));
    let layouts: Vec<_> = layouts.iter().map(|layout| Some(&**layout)).collect();
    let layout = wgpu_device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: descriptor.immediate_size,
    });
    let buffers: Vec<_> = descriptor
        .vertex
        .buffers
        .iter()
        .map(|b| wgpu::VertexBufferLayout {
            array_stride: b.array_stride,
            step_mode: b.step_mode,
            attributes: &b.attributes,
        })
        .collect();
    let _ = wgpu_device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &vertex,
            entry_point: descriptor.vertex.entry_point.as_deref(),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &buffers,
        },
        primitive: descriptor.primitive,
        depth_stencil: descriptor.depth_stencil.clone(),
        multisample: descriptor.multisample,
        fragment: descriptor.fragment.as_ref().map(|f| wgpu::FragmentState {
            module: &fragment,
            entry_point: f.entry_point.as_deref(),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &f.targets,
        }),
        multiview_mask: None,
        cache: None,
    });
    let errors = [block_on(validation.pop()), block_on(internal.pop())];
    match errors.into_iter().flatten().next() {
        Some(error) => Err(error),
        None => Ok(()),
    }
}

/// What the driver has against a composed source, in terms of the author's file.
pub(crate) fn refused(composed: &Composed, error: &wgpu::Error) -> Box<ShaderProblem> {
    let (place, message) = explain(composed, &deepest(error));
    locate(composed, place, message)
}

/// The last two links of a chain of errors: what does not fit, and why.
fn deepest(error: &dyn std::error::Error) -> String {
    let links: Vec<_> =
        std::iter::successors(error.source(), |e| e.source()).map(ToString::to_string).collect();
    match &links[..] {
        [] => error.to_string(),
        links => links[links.len().saturating_sub(2)..].join(": "),
    }
}

/// What the driver says, and the line of the composed text that it means: it names numbers of bindings,
/// locations and entry points, but no lines.
fn explain(composed: &Composed, complaint: &str) -> (Option<(usize, usize)>, String) {
    let line_of = |what: &str| {
        let lines: Vec<_> = composed.text.lines().collect();
        lines.iter().rposition(|line| line.contains(what)).map(|line| (line + 1, 1))
    };
    let number = |after: &str| {
        let digits: String =
            complaint.split(after).nth(1)?.chars().take_while(char::is_ascii_digit).collect();
        (!digits.is_empty()).then_some(digits)
    };
    let message = complaint.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ");
    let binding = number("binding: ").map(|n| {
        let message = format!(
            "@binding({n}) is not there: the renderer provides 0, the parameters, and 1, the lights ({message})"
        );
        (line_of(&format!("@binding({n})")), message)
    });
    let location = || {
        let n = number("ocation[").or_else(|| number("@location("))?;
        let message =
            format!("@location({n}) is not the same in the vertex and the fragment stage ({message})");
        Some((line_of(&format!("@location({n})")), message))
    };
    let entry = || {
        let name = complaint.split("entry point '").nth(1)?.split('\'').next()?;
        let message = format!("the function `{name}` with @{name} is missing: the renderer begins there");
        Some((line_of(&format!("@{name}")), message))
    };
    let wrapper = || {
        let lines = 1..=composed.text.lines().count();
        lines
            .into_iter()
            .find(|l| composed.map.locate(*l).is_some_and(|(f, _)| f == super::compose::WRAPPER.path))
            .map(|l| (l, 1))
    };
    binding
        .or_else(location)
        .or_else(entry)
        .unwrap_or_else(|| (wrapper(), format!("the graphics driver refuses it: {message}")))
}

/// The problem of a text on which the composer itself fails.
fn without_place(composed: &Composed) -> Box<ShaderProblem> {
    // Plain parsing may find what it fails on.
    match check::validate(composed) {
        Err(problem) if problem.file != super::compose::WRAPPER.path => problem,
        _ => locate(
            composed,
            None,
            "the shader cannot be put together; the last change is the cause".to_owned(),
        ),
    }
}
