//! The process that tries shaders for another one ([`crate::render::trial::process`]): each is compiled into
//! a pipeline, and a small picture is drawn with it.

use std::{
    io::{self, BufRead, Write},
    sync::{Arc, Mutex},
    thread,
    time::Duration,
};

use bevy::{
    asset::RenderAssetUsages,
    mesh::MeshTag,
    prelude::*,
    render::{
        error_handler::{RenderErrorHandler, RenderErrorPolicy},
        renderer::{RenderAdapter, RenderDevice},
        storage::ShaderBuffer,
    },
    shader::ValidateShader,
};
use web_time::Instant;

use super::gpu::{GpuError, GpuRenderer, Output};
use crate::{
    caught::lock,
    parameter::Values,
    registry::Registry,
    render::{
        illumination::IlluminationBuffer,
        material::{MaterialInputs, attach},
        meshes::{face_mesh, shared_mesh},
        trial::{
            Bench, COMPOSED, Tools, Verdict,
            process::{Answer, Budget, Request, refused_whole},
        },
    },
    scene::{Light, Scene},
    shader::{check::ShaderProblem, compose::Composed, slim::slim, whole::judged},
};

/// Width and height of the small picture, in pixels.
const SIDE: u32 = 32;
/// Size of the parameter table, in bytes: larger than any row.
const ROW: usize = 1 << 16;
/// Maximum time for drawing it again: a picture in the window has a thousand times its pixels, and the
/// shipped models take a hundredth of this.
const SLOWEST: Duration = Duration::from_millis(150);
/// Minimum number of further pictures drawn to find one that is fast enough, and the time during which more are: a machine
/// that compiles something else, too, is slow for some seconds.
const PATIENCE: usize = 5;
const LONGEST: Duration = Duration::from_secs(4);

/// Answers requests until there are no more, or until the renderer fails: then a new process is better.
///
/// # Errors
/// Returns a [`GpuError`] if nothing can be drawn at all.
pub fn serve(input: impl BufRead, mut output: impl Write) -> Result<(), GpuError> {
    let mut stage = Stage::new()?;
    let deadline = Deadline::watched(2 * Budget::default().time);
    let mut say = |answer: &Answer| {
        let line = serde_json::to_string(answer).unwrap_or_default();
        writeln!(output, "{line}").and_then(|()| output.flush())
    };
    let gone = |e: io::Error| GpuError::Copy(e.to_string());
    say(&Answer::Ready).map_err(gone)?;
    for line in input.lines() {
        let Ok(request) = serde_json::from_str::<Request>(&line.map_err(gone)?) else { continue };
        deadline.set(Some(Instant::now()));
        let (answer, more) = stage.try_out(&request);
        deadline.set(None);
        say(&answer).map_err(gone)?;
        if !more {
            break;
        }
    }
    Ok(())
}

/// Ends this process if a trial does not end, since the requesting process may be gone.
#[derive(Clone)]
struct Deadline(Arc<Mutex<Option<Instant>>>);

impl Deadline {
    fn watched(limit: Duration) -> Self {
        let deadline = Self(Arc::new(Mutex::new(None)));
        let since = deadline.0.clone();
        thread::spawn(move || {
            loop {
                thread::sleep(limit / 4);
                let since = *lock(&since);
                if since.is_some_and(|since| since.elapsed() > limit) {
                    std::process::exit(3);
                }
            }
        });
        deadline
    }

    fn set(&self, since: Option<Instant>) {
        *lock(&self.0) = since;
    }
}

/// The small picture: one sphere for each kind of mesh, one of which is visible.
struct Stage {
    renderer: GpuRenderer,
    /// For meshes with shared vertices, and for those with data of their polygons.
    actors: [Actor; 2],
    /// Index of the visible one.
    shown: usize,
    /// The renderer's error about the last picture.
    failure: Failure,
}

struct Actor {
    entity: Entity,
    shader: Handle<Shader>,
    parameters: Handle<ShaderBuffer>,
}

/// The renderer's error, if any.
#[derive(Clone, Default, Resource)]
struct Failure(Arc<Mutex<Option<String>>>);

impl Failure {
    fn take(&self) -> Option<String> {
        lock(&self.0).take()
    }
}

impl Stage {
    fn new() -> Result<Self, GpuError> {
        let failure = Failure::default();
        let mut renderer = GpuRenderer::extended(SIDE, SIDE, 1, Output::Display, |app| {
            app.insert_resource(failure.clone()).insert_resource(RenderErrorHandler(|error, main, _| {
                if let Some(failure) = main.get_resource::<Failure>() {
                    let text = error.description.lines().map(str::trim).collect::<Vec<_>>().join(" ");
                    *lock(&failure.0) = Some(text);
                }
                RenderErrorPolicy::Ignore
            }));
        })?;
        // A shader for light with extent takes its samples whatever lights there are. The window waits for one.
        renderer.set_light_samples(1);
        renderer.set_scene(scene());
        renderer.settle()?;
        let actors = [false, true].map(|faces| Actor::new(renderer.app().world_mut(), faces));
        Ok(Self { renderer, actors, shown: usize::MAX, failure })
    }

    /// Tries a shader; false if nothing more can be tried after it.
    fn try_out(&mut self, request: &Request) -> (Answer, bool) {
        let composed =
            Composed { text: request.text.clone(), map: request.map.clone(), ..Composed::default() };
        let judged = judged(&composed, request.faces);
        if judged != Some(Ok(())) {
            // The composer reports positions in more cases.
            let problem = self.explained(&composed, request.faces).or(judged.and_then(Result::err));
            if let Some(problem) = problem {
                return (Answer::Bad(problem), true);
            }
        }
        match self.draw(request) {
            Ok(time) if time <= SLOWEST => (Answer::Good, true),
            Ok(time) => {
                let message = format!(
                    "drawing {SIDE} × {SIDE} pixels with it takes {} ms, but at most {} ms are allowed; is there a loop with very many iterations?",
                    time.as_millis(),
                    SLOWEST.as_millis()
                );
                (Answer::Bad(refused_whole(request, message)), true)
            }
            Err(what) => {
                let message = format!("the graphics driver failed while drawing with it: {what}");
                let problem = self.explained(&composed, request.faces);
                (Answer::Bad(problem.unwrap_or_else(|| refused_whole(request, message))), false)
            }
        }
    }

    /// The error of a shader, found by creating a pipeline without drawing.
    fn explained(&mut self, composed: &Composed, faces: bool) -> Option<Box<ShaderProblem>> {
        let world = self.renderer.app().world_mut();
        let device = world.get_resource::<RenderDevice>()?.clone();
        let adapter = world.get_resource::<RenderAdapter>()?.clone();
        let verdict = world.resource_scope(|world, mut bench: Mut<Bench>| {
            let shaders = world.resource::<Assets<Shader>>();
            bench.try_here(composed, faces, Tools { device: &device, adapter: &adapter, shaders })
        });
        match verdict {
            Verdict::Bad(problem) => Some(problem),
            Verdict::Good | Verdict::NotYet => None,
        }
    }

    /// Draws a picture and returns its duration.
    fn picture(&mut self) -> Duration {
        let start = Instant::now();
        self.renderer.step();
        self.renderer.wait();
        start.elapsed()
    }

    /// Draws with a shader; returns the time for a picture once everything is compiled.
    fn draw(&mut self, request: &Request) -> Result<Duration, String> {
        self.failure.take();
        let chosen = usize::from(request.faces);
        let world = self.renderer.app().world_mut();
        for (i, actor) in self.actors.iter().enumerate() {
            let shown = if i == chosen { Visibility::Visible } else { Visibility::Hidden };
            world.entity_mut(actor.entity).insert(shown);
        }
        self.actors[chosen].dress(world, request);
        // The driver compiles for the first picture; if that takes long, the next ones show how much of it is
        // drawing. A busy machine makes any of them slow, but not all. An actor that has just become visible
        // may still be missing.
        let mut time = self.picture();
        if chosen != std::mem::replace(&mut self.shown, chosen) {
            time = self.picture();
        }
        let start = Instant::now();
        for i in 0.. {
            if is_settled(time, i, start.elapsed()) {
                break;
            }
            time = time.min(self.picture());
        }
        if self.renderer.is_waiting().map_err(|e| e.to_string())? {
            return Err("one of its imports is missing".to_owned());
        }
        match self.failure.take() {
            Some(what) => Err(what),
            None => Ok(time),
        }
    }
}

/// True if the least of some times decides: it is fast enough, or there were enough further pictures for long enough. Far
/// slower ones are not a matter of the machine.
fn is_settled(least: Duration, further: usize, elapsed: Duration) -> bool {
    let hopeless = least > 10 * SLOWEST;
    least <= SLOWEST || further >= PATIENCE && (hopeless || elapsed >= LONGEST)
}

/// Every light type without extent is active, so that the whole light loop is used. Light with extent calls
/// the same functions of a model, hundreds of times.
fn scene() -> Scene {
    let mut scene = Scene::default();
    let registry = Registry::builtin();
    let (corner, lamp) = (scene.scene_size.corner(), scene.lights.first().cloned().unwrap_or_default());
    scene.lights = registry
        .lights()
        .iter()
        .filter(|entry| !entry.declaration.extent)
        .map(|entry| {
            let mut light = Light { position: Some(corner * 0.8), ..lamp.clone() };
            light.direction = Some(-corner);
            light.set_type(entry, &registry, scene.scene_size);
            light
        })
        .collect();
    scene
}

impl Actor {
    fn new(world: &mut World, faces: bool) -> Self {
        let mesh = world.resource::<Registry>().shape("sphere").map(|shape| {
            let mesh = shape.mesh(&Values::default(), shape.tessellation(None));
            if faces { face_mesh(&mesh) } else { shared_mesh(&mesh) }
        });
        let mesh = mesh.map(|mesh| world.resource_mut::<Assets<Mesh>>().add(mesh));
        let shader = world.resource_mut::<Assets<Shader>>().reserve_handle();
        let at = Transform::from_translation(Scene::default().scene_size.corner() / 2.0)
            .with_scale(glam::Vec3::splat(3.0));
        let mut entity = world.spawn((MeshTag(0), at, Visibility::Hidden));
        if let Some(mesh) = mesh {
            entity.insert(Mesh3d(mesh));
        }
        let entity = entity.id();
        let empty = ShaderBuffer::new(&[0; ROW], RenderAssetUsages::default());
        let parameters = world.resource_mut::<Assets<ShaderBuffer>>().add(empty);
        let illumination = world.resource::<IlluminationBuffer>().buffers.clone();
        let inputs = MaterialInputs {
            parameters: parameters.clone(),
            solid: parameters.clone(),
            illumination,
            shader: shader.clone(),
            faces,
            gamma_naive: false,
        };
        attach(&mut world.entity_mut(entity), inputs);
        Self { entity, shader, parameters }
    }

    /// Sets the shader and the parameters of a request.
    fn dress(&self, world: &mut World, request: &Request) {
        let mut shader = Shader::from_wgsl(slim(&request.text), format!("{COMPOSED}trial.wgsl"));
        shader.validate_shader = ValidateShader::Enabled;
        // The asset exists as long as its handle.
        let _ = world.resource_mut::<Assets<Shader>>().insert(self.shader.id(), shader);
        let mut row = request.row.clone();
        row.resize(ROW, 0);
        if let Some(mut buffer) = world.resource_mut::<Assets<ShaderBuffer>>().get_mut(&self.parameters) {
            buffer.data = Some(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_busy_machine_gets_more_tries_than_a_slow_shader() {
        let ms = Duration::from_millis;
        assert!(is_settled(ms(150), 0, ms(0)) && is_settled(ms(20), 40, ms(3000)));
        // Just too slow: tried for seconds, and refused in the end.
        assert!(!is_settled(ms(152), PATIENCE, ms(900)) && !is_settled(ms(152), 20, ms(3900)));
        assert!(is_settled(ms(152), 26, ms(4000)));
        // Far too slow: no longer than before.
        assert!(!is_settled(ms(2000), PATIENCE - 1, ms(8000)) && is_settled(ms(2000), PATIENCE, ms(500)));
    }
}
