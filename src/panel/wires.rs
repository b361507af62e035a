//! Lines and dots of meshes over the picture of a view: debug channels that the window draws without shaders.
//!
//! A thread finds the visible ones when scene, camera or view have changed. The positions are in the scene: they move
//! correctly with the camera, while occlusion follows a moment later.

use std::{collections::BTreeMap, sync::Mutex, time::Duration};

use bevy_egui::egui::Mesh;

use super::{kept::Answers, marks::Lens, prelude::*};
use crate::{
    caught::{catch, lock},
    channel::DebugChannel,
    document::Revision,
    library::status::Reloaded,
    optics::TermSelection,
    reference::{Settings, WireDrawer, Wires},
    scene::Observer,
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
    drawer: Arc<Mutex<WireDrawer>>,
    lines: Answers<Question, Arc<Wires>>,
    /// The latest drawn mesh.
    drawn: Option<(Arc<Wires>, Sight, Arc<Mesh>)>,
}

type Views = BTreeMap<usize, OfView>;

/// The lines and dots over the picture of a view, and the number of calculations so far.
#[must_use]
pub fn shown(ctx: &Context, view: usize) -> Option<(Arc<Wires>, u64)> {
    kept::shared(ctx, |all: &mut Views| {
        let lines = &all.get(&view)?.lines;
        Some((lines.shown.as_ref()?.1.clone(), lines.calculations))
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
        kept::shared(ui.ctx(), |all: &mut Views| all.remove(&view));
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
    let sight = Sight { rect, eye: lens.eye, axes: lens.axes(), field_of_view: fov };
    let mesh = kept::shared(ui.ctx(), |all: &mut Views| {
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
        let Self { scene, drawer, lines, .. } = self;
        lines.ask(ctx, question, PATIENCE, || {
            if !matches!(scene, Some((known, _)) if *known == question.revision) {
                *scene = Some((question.revision, Arc::new(session.document.seen(view, registry)?.0)));
            }
            let (scene, question) = (scene.as_ref()?.1.clone(), question.clone());
            let (drawer, registry) = (drawer.clone(), registry.clone());
            // A bug, for example in a shape of another crate: show nothing until something changes.
            Some(move || catch(|| wires(question, &scene, &registry, &drawer)).unwrap_or_default())
        });
        let (asked, wires) = lines.shown.as_ref()?;
        (asked.channel == question.channel).then(|| wires.clone())
    }
}

fn wires(question: Question, scene: &Scene, registry: &Registry, drawer: &Mutex<WireDrawer>) -> Arc<Wires> {
    let Question { channel, size: [width, height], observer, terms, .. } = question;
    let scene = Scene { observer, ..scene.clone() };
    let settings = Settings { width, height, samples: 1, terms };
    let most = if channel.has_dots() { DOTS } else { LINES };
    let mut drawer = lock(drawer);
    // After a panic it begins anew.
    let mut taken = std::mem::take(&mut *drawer);
    let wires = taken.wires(&scene, registry, &settings, channel, most);
    *drawer = taken;
    Arc::new(wires)
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
