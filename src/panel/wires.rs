//! Lines and dots of meshes over the picture of a view: debug channels that the window draws without shaders.
//!
//! A thread finds the visible ones when scene, camera or view have changed. Their positions are in the scene: they move
//! correctly with the camera, while occlusion follows a moment later.

use std::{
    collections::BTreeMap,
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, RecvTimeoutError},
    },
    thread,
    time::Duration,
};

use bevy_egui::egui::{Color32, Context, Id, Mesh, Pos2, Rect, Shape, Ui, Vec2};
use glam::Vec3;

use super::{marks::Lens, state::Session};
use crate::{
    channel::DebugChannel,
    document::Revision,
    library::status::Reloaded,
    optics::TermSelection,
    reference::{Settings, WireDrawer, Wires},
    registry::Registry,
    scene::{Observer, Scene},
};

/// Maximum time that a frame waits for lines.
const PATIENCE: Duration = Duration::from_millis(4);
/// Maximum number of lines; more would slow down the window.
const LINES: usize = 60_000;
/// Maximum number of dots, for the same reason.
const DOTS: usize = 8_000;
/// Half the width of a line with soft edges, in points.
const HALF: f32 = 1.25;
/// Rings of a dot, from the centre: radius in points, and opacity, positive for the dot's colour, otherwise for the
/// rim's.
const RINGS: [(f32, f32); 3] = [(2.3, 1.0), (2.9, -0.9), (3.9, 0.0)];
/// Number of corners of a dot.
const CORNERS: usize = 12;

/// Inputs of the visible lines and dots.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    revision: Revision,
    channel: DebugChannel,
    size: [u32; 2],
    observer: Observer,
    terms: TermSelection,
    reloaded: Option<Reloaded>,
}

/// Inputs of a drawn mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sight {
    rect: Rect,
    eye: Vec3,
    axes: [Vec3; 3],
    field_of_view: f32,
}

#[derive(Default)]
struct OfView {
    /// Scene of the view, without the camera of the window.
    scene: Option<(Revision, Arc<Scene>)>,
    drawer: Option<WireDrawer>,
    running: Option<(Question, Receiver<(WireDrawer, Wires)>)>,
    shown: Option<(Question, Arc<Wires>)>,
    /// The latest drawn mesh.
    drawn: Option<(Arc<Wires>, Sight, Arc<Mesh>)>,
    calculations: u64,
}

type Shared = Arc<Mutex<BTreeMap<usize, OfView>>>;

fn shared(ctx: &Context) -> Shared {
    ctx.data_mut(|d| d.get_temp_mut_or_default::<Shared>(Id::new("lines of meshes")).clone())
}

fn with<T>(ctx: &Context, of: impl FnOnce(&mut BTreeMap<usize, OfView>) -> T) -> T {
    of(&mut shared(ctx).lock().unwrap_or_else(PoisonError::into_inner))
}

/// The lines and dots over the picture of a view, and the number of calculations so far.
#[must_use]
pub fn shown(ctx: &Context, view: usize) -> Option<(Arc<Wires>, u64)> {
    with(ctx, |all| {
        let of = all.get(&view)?;
        Some((of.shown.as_ref()?.1.clone(), of.calculations))
    })
}

/// A note about objects left out in a view.
pub(super) fn remark(ctx: &Context, view: usize) -> Option<String> {
    shown(ctx, view).and_then(|(wires, _)| wires.remark())
}

/// Paints the lines and dots of a view into its rectangle, clipped to `part`, if its channel has any.
pub(super) fn paint(ui: &Ui, rect: Rect, part: Rect, view: usize, session: &Session, registry: &Registry) {
    let channel = session.channel_of(view).filter(|channel| channel.has_wires());
    let Some(channel) = channel else {
        with(ui.ctx(), |all| all.remove(&view));
        return;
    };
    if !(rect.is_finite() && part.is_positive()) {
        return;
    }
    let fov = session.document.observer.field_of_view;
    let size = rect.size() * ui.ctx().pixels_per_point();
    let size = [size.x, size.y].map(|side| (side.round() as u32).max(1));
    let here = session.facts.observer(session.document.observer);
    let question = Question {
        revision: session.document.revision(),
        channel,
        size,
        observer: here.fitting(size, session.document.view_angle()),
        terms: session.terms_of(view),
        reloaded: session.shaders.last.clone(),
    };
    let lens = Lens::of(session, rect);
    let sight = Sight { rect, eye: lens.eye(), axes: lens.axes(), field_of_view: fov };
    let mesh = with(ui.ctx(), |all| {
        let of = all.entry(view).or_default();
        let wires = of.answer(ui.ctx(), &question, view, session, registry)?;
        let same =
            |(known, from, _): &&(Arc<Wires>, Sight, Arc<Mesh>)| Arc::ptr_eq(known, &wires) && *from == sight;
        if let Some((.., mesh)) = of.drawn.as_ref().filter(same) {
            return Some(mesh.clone());
        }
        let mesh = Arc::new(mesh(&wires, &lens));
        of.drawn = Some((wires, sight, mesh.clone()));
        Some(mesh)
    });
    if let Some(mesh) = mesh {
        ui.painter_at(part).add(Shape::Mesh(mesh));
    }
}

impl OfView {
    /// The lines or, while they are calculated, the previous ones of the same channel.
    fn answer(
        &mut self,
        ctx: &Context,
        question: &Question,
        view: usize,
        session: &Session,
        registry: &Registry,
    ) -> Option<Arc<Wires>> {
        // A running calculation may answer an older question.
        for _ in 0..2 {
            if self.shown.as_ref().is_some_and(|(asked, _)| asked == question) {
                break;
            }
            let new = self.running.is_none();
            if new {
                let scene = self.scene(question.revision, view, session, registry)?;
                let drawer = self.drawer.take().unwrap_or_default();
                let receiver = start(ctx, question.clone(), scene, registry.clone(), drawer);
                self.running = Some((question.clone(), receiver));
                self.calculations += 1;
            }
            let (asked, receiver) = self.running.as_ref()?;
            match receiver.recv_timeout(if new { PATIENCE } else { Duration::ZERO }) {
                Ok((drawer, wires)) => {
                    self.shown = Some((asked.clone(), Arc::new(wires)));
                    self.drawer = Some(drawer);
                }
                Err(RecvTimeoutError::Timeout) => break,
                // A bug, for example in a shape of another crate: show nothing until something changes.
                Err(RecvTimeoutError::Disconnected) => {
                    self.shown = Some((asked.clone(), Arc::default()));
                }
            }
            self.running = None;
        }
        let fits = |(asked, _): &&(Question, Arc<Wires>)| asked.channel == question.channel;
        self.shown.as_ref().filter(fits).map(|(_, wires)| wires.clone())
    }

    fn scene(
        &mut self,
        revision: Revision,
        view: usize,
        session: &Session,
        registry: &Registry,
    ) -> Option<Arc<Scene>> {
        if !matches!(&self.scene, Some((known, _)) if *known == revision) {
            self.scene = Some((revision, Arc::new(session.document.seen(view, registry)?.0)));
        }
        self.scene.as_ref().map(|(_, scene)| scene.clone())
    }
}

fn start(
    ctx: &Context,
    question: Question,
    scene: Arc<Scene>,
    registry: Registry,
    mut drawer: WireDrawer,
) -> Receiver<(WireDrawer, Wires)> {
    let (sender, receiver) = mpsc::channel();
    let ctx = ctx.clone();
    thread::spawn(move || {
        let Question { channel, size: [width, height], observer, terms, .. } = question;
        let scene = Scene { observer, ..(*scene).clone() };
        let settings = Settings { width, height, samples: 1, terms };
        let most = if channel.has_dots() { DOTS } else { LINES };
        let wires = drawer.wires(&scene, &registry, &settings, channel, most);
        // The receiver is gone once the channel has changed.
        drop(sender.send((drawer, wires)));
        ctx.request_repaint();
    });
    receiver
}

/// Lines and dots as projected by the camera.
fn mesh(wires: &Wires, lens: &Lens) -> Mesh {
    let mut mesh = Mesh::default();
    let colour = |[r, g, b]: [u8; 3]| Color32::from_rgb(r, g, b);
    for line in &wires.lines {
        let [Some(a), Some(b)] = line.ends.map(|p| lens.project(p)) else { continue };
        let side = (b - a).normalized().rot90() * HALF;
        let first = mesh.vertices.len() as u32;
        for at in [a, b] {
            mesh.colored_vertex(at - side, Color32::TRANSPARENT);
            mesh.colored_vertex(at, colour(line.colour).gamma_multiply(line.opacity));
            mesh.colored_vertex(at + side, Color32::TRANSPARENT);
        }
        for corner in [first, first + 1] {
            mesh.add_triangle(corner, corner + 1, corner + 3);
            mesh.add_triangle(corner + 1, corner + 3, corner + 4);
        }
    }
    for dot in &wires.dots {
        if let Some(at) = lens.project(dot.at) {
            add_dot(&mut mesh, at, colour(dot.colour), colour(dot.rim()));
        }
    }
    mesh
}

fn add_dot(mesh: &mut Mesh, at: Pos2, colour: Color32, rim: Color32) {
    let first = mesh.vertices.len() as u32;
    mesh.colored_vertex(at, colour);
    for (radius, opacity) in RINGS {
        let shown = if opacity > 0.5 { colour } else { rim.gamma_multiply(opacity.abs()) };
        for k in 0..CORNERS {
            let turn = k as f32 / CORNERS as f32 * std::f32::consts::TAU;
            mesh.colored_vertex(at + radius * Vec2::angled(turn), shown);
        }
    }
    let corner = |ring: usize, k: usize| first + 1 + (ring * CORNERS + k % CORNERS) as u32;
    for k in 0..CORNERS {
        mesh.add_triangle(first, corner(0, k), corner(0, k + 1));
        for ring in 1..RINGS.len() {
            mesh.add_triangle(corner(ring - 1, k), corner(ring, k), corner(ring - 1, k + 1));
            mesh.add_triangle(corner(ring - 1, k + 1), corner(ring, k), corner(ring, k + 1));
        }
    }
}
