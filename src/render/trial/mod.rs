//! Tries shaders before they are used.
//!
//! Bevy uses a changed shader unconditionally: if it cannot be compiled, the mesh or the whole frame is lost.
//! Each shader is therefore first composed as Bevy would compose it, in a [`ShaderCache`] of our own that
//! validates in release builds too, and then compiled into a pipeline that is not drawn, inside an error
//! scope of the graphics driver. Shaders that pass both steps are valid.
//!
//! A driver may also crash, or never finish. The window therefore does all this, and also draws something, in
//! a separate process ([`process`]), and continues meanwhile. Where there are no processes, `risk` remembers what has ended
//! the program.

use std::sync::{Arc, Mutex};

use bevy::{
    prelude::*,
    render::{
        Render, RenderApp, RenderSystems,
        render_resource::{CachedPipelineState, PipelineCache, PipelineDescriptor},
        renderer::RenderQueue,
    },
    shader::ShaderCache,
};
use naga::Module;

use crate::{
    caught::{catch_silently, lock},
    platform,
    shader::{compose::Composed, limits},
};

mod attempt;
mod explain;
pub mod process;
mod risk;
mod tools;
mod verdict;

pub(crate) use explain::refused;
pub use tools::{COMPOSED, MARK, Tools};
pub use verdict::Verdict;

use attempt::attempt;
use explain::without_place;
use process::TrialProcess;
use risk::Risks;
use tools::Example;

/// The example, filled by the renderer as soon as one exists.
#[derive(Clone, Default, Resource)]
struct SharedExample(Arc<Mutex<Option<Example>>>);

impl SharedExample {
    fn lock(&self) -> std::sync::MutexGuard<'_, Option<Example>> {
        lock(&self.0)
    }
}

/// Enables trials of shaders: makes [`Bench`] a resource.
pub(super) fn plugin(app: &mut App) {
    let example = SharedExample::default();
    let risks = Risks::new(platform::fatal_trials());
    app.insert_resource(Bench { example: example.clone(), cache: None, process: None, risks: risks.clone() });
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .insert_resource(example)
        .insert_resource(risks)
        .add_systems(Render, (find_example, count_frames).in_set(RenderSystems::Cleanup));
}

/// Counts the frames since shaders were tried, until the driver has drawn with them.
fn count_frames(risks: Res<Risks>, queue: Res<RenderQueue>) {
    let names = risks.frame();
    if !names.is_empty() {
        let risks = risks.clone();
        queue.on_submitted_work_done(move || risks.drawn(&names));
    }
}

/// Keeps the first of our pipelines that works.
fn find_example(example: Res<SharedExample>, cache: Res<PipelineCache>) {
    let mut example = example.lock();
    if example.is_some() {
        return;
    }
    let found = cache.pipelines().find_map(|pipeline| {
        let PipelineDescriptor::RenderPipelineDescriptor(d) = &pipeline.descriptor else { return None };
        let works = matches!(pipeline.state, CachedPipelineState::Ok(_));
        (works && d.vertex.shader_defs.contains(&MARK.into())).then_some(d)
    });
    if let Some(descriptor) = found {
        let layouts = descriptor.layout.iter().map(|l| cache.get_bind_group_layout(l)).collect();
        *example = Some(Example { descriptor: (**descriptor).clone(), layouts });
    }
}

/// The resource that tries shaders.
#[derive(Resource)]
pub struct Bench {
    example: SharedExample,
    /// Contains Bevy's own shaders, which ours import.
    cache: Option<ShaderCache<Module, ()>>,
    /// The process that runs the trials instead, if any.
    process: Option<TrialProcess>,
    /// What may end the program where there are no processes.
    risks: Risks,
}

impl Bench {
    /// Runs all trials in another process from now on, and none here.
    pub fn try_in(&mut self, process: TrialProcess) {
        self.process = Some(process);
    }

    /// Begins a new frame: pending trials that are not requested again are dropped.
    pub fn begin_frame(&self) {
        if let Some(process) = &self.process {
            process.begin_frame();
        }
    }

    /// True while another process tries something, and will call `wake`.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        self.process.as_ref().is_some_and(TrialProcess::is_busy)
    }

    /// True if the next frames draw for the first time with something that may end the program.
    #[must_use]
    pub fn is_drawing_first(&self) -> bool {
        self.risks.wants_frames()
    }

    /// True if the renderer can draw with a composed source, on meshes with or without data of their
    /// polygons. `row` is an object's row in the parameter table.
    pub fn try_out(
        &mut self,
        composed: &Composed,
        faces: bool,
        row: impl FnOnce() -> Vec<u8>,
        tools: Tools,
    ) -> Verdict {
        if let Some(problem) = &composed.problem {
            return Verdict::Bad(problem.clone());
        }
        if let Err(problem) = limits::check_text(composed) {
            return Verdict::Bad(problem);
        }
        if let Some(process) = &self.process {
            return process.ask(composed, faces, row);
        }
        if platform::HAS_PROGRAMS {
            return self.try_here(composed, faces, tools);
        }
        if let Some(problem) = self.risks.refused(composed, faces) {
            return Verdict::Bad(problem);
        }
        let verdict = self.try_here(composed, faces, tools);
        if verdict == Verdict::Good {
            self.risks.begin(composed, faces);
        }
        verdict
    }

    /// Like [`try_out`](Self::try_out), in this process.
    pub fn try_here(&mut self, composed: &Composed, faces: bool, tools: Tools) -> Verdict {
        let example = self.example.clone();
        let example = example.lock();
        let Some(example) = example.as_ref() else { return Verdict::NotYet };
        // The shader composer calls unwrap in places.
        match catch_silently(|| attempt(&mut self.cache, composed, faces, example, tools)) {
            Ok(outcome) => outcome.err().unwrap_or(Verdict::Good),
            Err(_) => {
                // The cache may be left in an inconsistent state.
                self.cache = None;
                Verdict::Bad(without_place(composed))
            }
        }
    }
}
