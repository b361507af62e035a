//! Two views over each other, and the edge between them.

use super::place::{Arranging, over_each_other};
use crate::{
    panel::{focus, prelude::*, segmented::values},
    scene::{Comparison, comparison::Edge},
};

/// Width of the grab area of a wipe's edge, in points.
const GRASP: f32 = 14.0;
/// Step of the edge per key press, as a fraction of the picture.
const STEP: f32 = 0.02;

pub(super) static ARRANGING: Arranging = Arranging {
    arrange: |all, frame| {
        over_each_other(all, frame, parts(frame.below_header(frame.picture), frame.comparison()));
    },
    rows: [1, 1],
    choices: |ui, _, now, _, _| {
        let tip = |ui: &mut Ui, edge: Edge| _ = ui.label(edge.summary());
        ui.label(theme::small(ui, "edge"));
        if let Some(edge) = values(ui, "Edge", Edge::ALL, now.edge, Edge::name, tip) {
            now.edge = edge;
        }
    },
    over: |ui, rect, context| Some(wipe(ui, rect, context)),
    ..Arranging::PLAIN
};

/// Parts of a rectangle on both sides of the edge of a wipe.
fn parts(rect: Rect, comparison: &Comparison) -> [Rect; 2] {
    let edge = edge_of(rect, comparison);
    match comparison.edge {
        Edge::Vertical => [rect.with_max_x(edge.x), rect.with_min_x(edge.x)],
        Edge::Horizontal => [rect.with_max_y(edge.y), rect.with_min_y(edge.y)],
    }
}

/// Midpoint of the edge of a wipe.
fn edge_of(rect: Rect, comparison: &Comparison) -> Pos2 {
    match comparison.edge {
        Edge::Vertical => pos2(rect.left() + comparison.split * rect.width(), rect.center().y),
        Edge::Horizontal => pos2(rect.center().x, rect.top() + comparison.split * rect.height()),
    }
}

/// The edge of a wipe, with a handle. Returns the rectangle that it takes from the picture.
fn wipe(ui: &mut Ui, rect: Rect, context: &mut PanelContext<'_>) -> Rect {
    let comparison = &context.session().document.comparison;
    let at = edge_of(rect, comparison);
    let upright = comparison.edge == Edge::Vertical;
    let (size, cursor) = if upright {
        (vec2(GRASP, rect.height()), CursorIcon::ResizeHorizontal)
    } else {
        (vec2(rect.width(), GRASP), CursorIcon::ResizeVertical)
    };
    let place = Rect::from_center_size(at, size);
    let response = ui.interact(place, Id::new("edge of the wipe"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(true, f64::from(comparison.split), "Edge between the views"));
    paint(ui, rect, at, upright, &response);
    let mut split = comparison.split;
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        let t = (pointer - rect.min) / rect.size();
        split = if upright { t.x } else { t.y };
    }
    if response.double_clicked() {
        split = Comparison::default().split;
    }
    let steps = focus::steps(ui, &response, [upright, !upright])[usize::from(!upright)];
    split += STEP * steps.clamp(-1.0, 1.0) as f32;
    if split != comparison.split {
        let moved = comparison.with_split(split);
        let split = (moved.split * 1000.0).round() / 1000.0;
        context.act(Action::Compare(CompareCommand::Set(Comparison { split, ..moved })));
    }
    response.on_hover_cursor(cursor).on_hover_text(
        "Drag the edge between the views. With the focus, arrow keys move it; double-click: the middle.",
    );
    place
}

/// The edge through a point, with a grip that points to both sides.
fn paint(ui: &Ui, rect: Rect, at: Pos2, upright: bool, response: &Response) {
    let painter = ui.painter_at(rect);
    let (ends, along, across) = if upright {
        ([pos2(at.x, rect.top()), pos2(at.x, rect.bottom())], vec2(4.0, 0.0), vec2(0.0, 3.0))
    } else {
        ([pos2(rect.left(), at.y), pos2(rect.right(), at.y)], vec2(0.0, 4.0), vec2(3.0, 0.0))
    };
    let on = response.hovered() || response.dragged() || response.has_focus();
    let core = if on { Color32::from_rgb(0x7c, 0xc8, 0xff) } else { Color32::WHITE };
    painter.line_segment(ends, Stroke::new(3.5, Color32::from_black_alpha(160)));
    painter.line_segment(ends, Stroke::new(1.5, core));
    painter.circle(at, 9.0, Color32::from_black_alpha(190), Stroke::new(1.5, core));
    for side in [-1.0, 1.0] {
        let tip = at + side * 1.5 * along;
        let back = at + side * 0.6 * along;
        painter.line(vec![back + across, tip, back - across], Stroke::new(1.5, core));
    }
}
