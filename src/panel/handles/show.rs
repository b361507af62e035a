//! The handles in a view: which are shown, which is grasped, and what a drag asks for.

use bevy_egui::egui::{CursorIcon, Id, Key, Order, Pos2, Rect, Sense, Ui, Vec2, WidgetInfo, WidgetType};

use glam::Vec3;

use super::{
    Handle,
    grasp::{Dragged, Grasp},
    paint::{self, State},
    shape::{Placed, Target, placed},
};
use crate::{
    document::{Edit, Selection},
    panel::{
        kept,
        marks::{self, Asked, Lens, Sight},
        notice::Wait,
        state::{Action, HandleMode, Session},
        theme,
        together::together,
    },
    parameter::Value,
    scene::{Field, Light, Object, SceneSize, rotation::rotation},
};

/// Minimum picture size for handles, in points.
const SMALLEST: f32 = 120.0;
/// Time after which the pointer counts as resting, in seconds.
const REST: f64 = 2.0;
/// Duration of fading in and out, in seconds.
const FADE: f32 = 0.15;
/// Drag threshold, in points.
const SLACK: f32 = 1.5;

/// The handle being dragged.
#[derive(Clone, Debug)]
struct Hold {
    /// The view of the drag.
    view: Id,
    grasp: Grasp,
    /// The original value, which Escape restores.
    before: Dragged,
    /// The value that was asked for last, of several parts.
    asked: Option<Dragged>,
    /// The value that the scene has got by the next frame, which the label then says.
    given: Option<Dragged>,
    /// True once the pointer has moved.
    moved: bool,
}

/// Shows the handles of the selection in a view.
pub(in crate::panel) fn handles(ui: &Ui, sight: Sight<'_>) -> Asked {
    let Sight { rect, written, session, registry } = sight;
    let (mut actions, mut places) = (Vec::new(), Vec::new());
    let view = ui.id().with("handles");
    let hold: Option<Hold> = kept::get(ui.ctx());
    let lens = Lens::of(session, rect);
    let seen = || marks::places_shown(ui.ctx(), sight, &lens);
    let target = Target::of(session, registry, together(ui.ctx(), session, registry), seen)
        .filter(|_| session.view.show_handles && rect.size().min_elem() >= SMALLEST);
    let Some(target) = target else {
        release(ui);
        return (actions, places);
    };
    let hold = hold.filter(|hold| hold.grasp.part == target.part);
    let held = hold.as_ref().map(|hold| hold.grasp.handle);
    let all = placed(&target, session.view.handles, session, (&lens, held));
    let under = free_pointer(ui, rect, written, session).and_then(|at| under(&all, at));
    let mine = hold.as_ref().filter(|hold| hold.view == view);
    let is_down = ui.input(|i| i.pointer.any_down());
    let hot = match &hold {
        Some(_) => mine.map(|hold| hold.grasp.handle),
        None => under.filter(|_| !is_down || ui.input(|i| i.pointer.primary_pressed())).map(|p| p.handle),
    };
    let state = |handle: Handle| match hot {
        Some(hot) if hot == handle => State::Hot,
        _ if hold.is_some() => State::Dim,
        _ => State::Free,
    };
    let in_use = hot.is_some() || hold.is_some();
    let opacity = opacity(ui, view, rect, (target.part, session.view.handles), in_use);
    if opacity > 0.0 {
        paint::handles(ui, lens, &all, opacity, state);
    }
    nodes(ui, view, rect, &all, &target, &target.words(session, registry));
    places.extend(all.iter().flat_map(|placed| {
        let side = Vec2::splat(2.0 * placed.half());
        placed.points().filter(|p| rect.contains(*p)).map(move |p| Rect::from_center_size(p, side))
    }));
    if hot.is_some() {
        ui.ctx().set_cursor_icon(if hold.is_some() { CursorIcon::Grabbing } else { CursorIcon::Grab });
    }
    if let Some(mine) = mine {
        actions.extend(drag(ui, sight, &lens, mine.clone(), &target));
    } else if hold.is_none()
        && let Some(placed) = under
        && ui.input(|i| i.pointer.primary_pressed())
        && let Some(pointer) = ui.input(|i| i.pointer.press_origin())
    {
        let room = session.document.scene_size;
        actions.extend(take(ui, view, placed, &target, Grasp::of(placed, &target, &lens, pointer), room));
    }
    (actions, places)
}

/// Takes hold of a handle, if its value can be edited.
fn take(
    ui: &Ui,
    view: Id,
    placed: &Placed,
    target: &Target,
    grasp: Grasp,
    room: SceneSize,
) -> Option<Action> {
    let before = value(&grasp, target).filter(|value| grasp.edit(*value, room).is_some())?;
    if let (Selection::Light(i), None) = (target.part, target.group()) {
        marks::hold(ui.ctx(), Some((i, target.at)));
    }
    kept::set(ui.ctx(), Some(Hold { view, grasp, before, asked: None, given: None, moved: false }));
    ui.ctx().set_dragged_id(view.with(placed.handle));
    Some(Action::BeginDrag)
}

/// The latest reason to show the handles.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Woken {
    /// The selection, and the kind of handles.
    what: (Selection, HandleMode),
    /// True if another part or another kind of handles was chosen, which shows them wherever the pointer is.
    chosen: bool,
    /// The time until they fade.
    stays: Wait,
}

/// Opacity of the handles of a view: they fade when the pointer rests or leaves the picture, so that nothing covers it.
fn opacity(ui: &Ui, view: Id, rect: Rect, what: (Selection, HandleMode), in_use: bool) -> f32 {
    let (now, over, moved) = ui.input(|i| {
        let over = i.pointer.latest_pos().is_some_and(|at| rect.contains(at));
        (i.time, over, i.pointer.delta() != Vec2::ZERO || i.pointer.any_pressed())
    });
    let key = view.with("woken");
    let known: Option<Woken> = ui.data(|data| data.get_temp(key));
    // A newly opened window shows the picture without handles.
    let mut woken = known.unwrap_or(Woken { what, chosen: false, stays: Wait::default() });
    let chosen = woken.what != what;
    if chosen || over && moved || in_use {
        (woken.what, woken.chosen) = (what, chosen);
        woken.stays.begin(now, REST);
    }
    let shown = in_use || (woken.stays.lasts(now) && (over || woken.chosen));
    if shown && !in_use {
        woken.stays.wake(ui.ctx(), now);
    }
    if known != Some(woken) {
        ui.data_mut(|data| data.insert_temp(key, woken));
    }
    ui.ctx().animate_bool_with_time(view.with("opacity"), shown, FADE)
}

/// Ends the drag once the button is up.
fn release(ui: &Ui) {
    if !ui.input(|i| i.pointer.primary_down()) {
        kept::set(ui.ctx(), None::<Hold>);
        marks::hold(ui.ctx(), None);
    }
}

/// Position of the pointer, if the picture is uncovered there and nothing else uses the pointer.
fn free_pointer(ui: &Ui, rect: Rect, written: &[Rect], session: &Session) -> Option<Pos2> {
    let ctx = ui.ctx();
    let busy = session.questions.open.is_some()
        || bevy_egui::egui::Popup::is_any_open(ctx)
        || session.view.chooser_open
        || ctx.egui_is_using_pointer();
    let at = ui.input(|i| i.pointer.press_origin().or(i.pointer.latest_pos()))?;
    let open = ctx.layer_id_at(at).is_none_or(|layer| layer.order == Order::Background);
    let covered = written.iter().any(|place| place.contains(at));
    (!busy && open && !covered && rect.contains(at)).then_some(at)
}

/// The handle at a position.
fn under(all: &[Placed], at: Pos2) -> Option<&Placed> {
    let near = all.iter().filter_map(|placed| Some((placed.distance(at)?, placed)));
    // The handle painted last is on top.
    near.rev().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, placed)| placed)
}

/// Describes the handles for screen readers.
fn nodes(ui: &Ui, view: Id, rect: Rect, all: &[Placed], target: &Target, part: &str) {
    for placed in all {
        let place = Rect::from_center_size(placed.end, Vec2::splat(2.0 * placed.radius)).intersect(rect);
        let response = ui.interact(place, view.with(placed.handle), Sense::hover());
        let name = target.name(placed.handle, part);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Other, true, &name));
    }
}

/// The current value of a part, of the kind that a handle sets.
fn value(grasp: &Grasp, target: &Target) -> Option<Dragged> {
    (grasp.handle.sort.value)(target, grasp.handle)
}

/// True if an edit leaves the scene as it is.
fn is_same(edit: &Edit, now: Option<Edit>) -> bool {
    let vector = |edit: &Edit, field: Field| match edit.one() {
        Some((_, key, Some(Value::Triple(v)))) if key == field.into() => Some(Vec3::from(*v)),
        _ => None,
    };
    let both = |field| Some((vector(edit, field)?, now.as_ref().and_then(|now| vector(now, field))?));
    // Different angles can describe the same rotation.
    if let Some((a, b)) = both(Object::rotation) {
        return rotation(a).angle_between(rotation(b)) < 1e-4;
    }
    if let Some((a, b)) = both(Light::direction) {
        return a.normalize_or_zero() == b.normalize_or_zero();
    }
    now.as_ref() == Some(edit)
}

/// Continues a drag, and paints its numbers.
fn drag(ui: &Ui, sight: Sight<'_>, lens: &Lens, mut hold: Hold, target: &Target) -> Option<Action> {
    let Sight { session, registry, .. } = sight;
    let (pointer, snap) = ui.input(|i| (i.pointer.latest_pos(), i.modifiers.command));
    // The start, of several parts: their value is how far they have come since.
    let now = hold.asked.or_else(|| value(&hold.grasp, target));
    let room = session.document.scene_size;
    if ui.input(|i| i.key_pressed(Key::Escape)) {
        let changed = now.is_some_and(|now| now != hold.before);
        let undone = hold.grasp.edit(hold.before, room).filter(|_| changed).map(Action::Edit);
        kept::set(ui.ctx(), None::<Hold>);
        marks::hold(ui.ctx(), None);
        return undone;
    }
    let pointer = pointer?;
    hold.moved |= pointer.distance(hold.grasp.pointer) >= SLACK;
    hold.grasp.follow(lens, pointer);
    let grasp = &hold.grasp;
    let wanted = grasp.drag(lens, pointer, snap, room).filter(|_| hold.moved);
    let edit = wanted.and_then(|wanted| grasp.edit(wanted, room));
    // Where another part is in the way, keep the last valid value. Several parts are checked once, when they are changed.
    let several = target.group().is_some();
    let legal = edit.filter(|edit| several || session.document.allows(edit, registry));
    if hold.moved {
        // Like outline and handles: this frame paints the scene before the edit.
        let shown = hold.given.or_else(|| grasp.drag(lens, grasp.pointer, false, room)).or(now);
        let Handle { sort, which } = grasp.handle;
        (sort.guide)(ui, *lens, which, target.at, [grasp.pointer, pointer], room);
        if let Some(shown) = shown {
            let words = grasp.words(shown, lens.metres(grasp.at, 1.0));
            theme::beside(ui, &ui.painter_at(lens.rect), pointer, words);
        }
    }
    hold.given = wanted.filter(|_| legal.is_some()).or(hold.given);
    let changed = legal.filter(|edit| match wanted {
        wanted if several => wanted != now,
        _ => !is_same(edit, now.and_then(|now| hold.grasp.edit(now, room))),
    });
    hold.asked = wanted.filter(|_| several && changed.is_some()).or(hold.asked);
    kept::set(ui.ctx(), Some(hold));
    release(ui);
    changed.map(Action::Edit)
}
