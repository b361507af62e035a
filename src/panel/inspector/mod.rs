//! The properties of what is selected, at the right.

use super::{lesson::point, prelude::*};
use crate::document::{PartId, Revision};
use {light::light, many::many, object::object, observer::observer, room::room};

mod light;
mod many;
mod material;
mod measured;
pub(super) mod model;
mod object;
mod observer;
mod part;
mod room;
mod row;
mod variant;

/// Minimum width of the content, in points: in a narrower panel, it is scrolled sideways too.
const LEAST: f32 = 244.0;

/// What the panel shows: the document by its first revision, the selected part, and the number of parts selected besides.
type Subject = (Revision, Selection, Option<PartId>, usize);

/// What the panel showed in its latest frame.
#[derive(Clone, Debug, Default)]
struct Latest(Option<Subject>);

/// True in the first frame with another document or another selection.
fn is_new(ui: &Ui, session: &Session) -> bool {
    let (document, part) = (&session.document, session.selection);
    let now = Some((document.origin(), part, document.id_of(part), document.others().len()));
    kept::set(ui.ctx(), Latest(now)).0 != now
}

/// See the module.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let part = context.session().selection;
    // Each selection has fields of its own: what is typed about one must not turn up in another.
    ui.push_id((part, context.document().others().len()), |ui| {
        // The scroll bar floats over a margin, so that nothing moves when it comes.
        ui.spacing_mut().scroll.floating_allocated_width = 0.0;
        let width = ui.available_width();
        let mut scroll =
            ScrollArea::new([width < LEAST, true]).auto_shrink(false).animated(!point::jumps(ui));
        if is_new(ui, context.session()) {
            // It begins with the name.
            scroll = scroll.vertical_scroll_offset(0.0);
        }
        scroll.show(ui, |ui| {
            ui.set_max_width(width.max(LEAST) - 8.0);
            variant::variant(ui, context);
            match part {
                _ if context.session().has_group() => many(ui, context),
                Selection::Room => room(ui, context),
                Selection::Observer => observer(ui, context),
                Selection::Light(i) => light(ui, i, context),
                Selection::Object(i) => object(ui, i, context),
            }
            ui.add_space(16.0);
        });
    });
}
