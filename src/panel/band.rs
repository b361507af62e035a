//! The frame that a drag with Ctrl draws in the picture. It selects the lights and objects whose middles are in it.

use super::{
    cover::is_over_picture,
    marks::{self, Lens},
    prelude::*,
};

/// Movement of the pointer below which a press is a click, in points.
const SLACK: f32 = 4.0;

/// Where a frame was begun, and the rectangle of the view that it is in.
#[derive(Clone, Copy, Debug, Default)]
struct Begun(Option<(Pos2, Rect)>);

/// Begins, paints and ends the frame. Returns the selection of what is in it.
pub(super) fn band(ui: &Ui, area: &PictureArea, session: &Session, registry: &Registry) -> Option<Action> {
    let ctx = ui.ctx();
    let (pressed, down, modifiers, at, stop) = ui.input(|i| {
        let at = i.pointer.latest_pos();
        (i.pointer.primary_pressed(), i.pointer.primary_down(), i.modifiers, at, i.key_pressed(Key::Escape))
    });
    let Begun(begun) = kept::get(ctx);
    let at = at?;
    if pressed {
        let begins = modifiers.command
            && !modifiers.alt
            && !session.seeks_pixel()
            && !Popup::is_any_open(ctx)
            && is_over_picture(ctx, area.frame, at);
        let rect = area.cell_at(at).map_or(area.frame, |cell| cell.rect);
        kept::set(ctx, Begun(begins.then_some((at, rect))));
        return None;
    }
    let (start, view) = begun?;
    if stop || !down {
        kept::set(ctx, Begun::default());
    }
    if stop || start.distance(at) < SLACK {
        return None;
    }
    let frame = Rect::from_two_pos(start, at).intersect(view);
    if down {
        let accent = Palette::here(ui).accent;
        let stroke = Stroke::new(1.0, accent);
        ui.painter_at(view).rect(frame, 0.0, accent.gamma_multiply(0.15), stroke, StrokeKind::Inside);
        ctx.set_cursor_icon(CursorIcon::Crosshair);
        return None;
    }
    let found = within(frame, &Lens::of(session, view), area, session, registry);
    Some(Action::SelectEach(found, modifiers.shift))
}

/// The lights and objects that are shown with their middles in a rectangle of a view.
fn within(
    frame: Rect,
    lens: &Lens,
    area: &PictureArea,
    session: &Session,
    registry: &Registry,
) -> Vec<Selection> {
    let scene = &session.document;
    let is_in = |p: Vec3| lens.project(p).is_some_and(|at| frame.contains(at));
    let objects = scene.objects.iter().enumerate();
    let objects = objects.filter(|(_, object)| object.visible && is_in(object.position));
    let mut found: Vec<_> = objects.map(|(i, _)| Selection::Object(i)).collect();
    if session.view.show_markers && !session.view.presenting {
        let places = marks::places(scene, registry, lens, &area.written);
        let lights = places.into_iter().enumerate().filter(|(_, at)| at.is_some_and(is_in));
        found.extend(lights.map(|(i, _)| Selection::Light(i)));
    }
    found
}
