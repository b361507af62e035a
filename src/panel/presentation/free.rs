//! Free places of a presentation, where badges, legends and messages hide no object.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::{CAPTION, discs, hidden, since};
use crate::panel::{
    notice,
    placer::{EDGE, GAP, Placer},
    prelude::*,
};

/// Maximum height of a band above a picture, as a fraction of the picture.
const HIGHEST: f32 = 0.45;

/// The room for the plates over a picture: badges, the legend of a channel, the message about an error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::panel) struct Needed {
    /// Below each other.
    column: Vec2,
    /// Height in rows as wide as the picture.
    rows: f32,
}

impl Needed {
    /// The room for plates of these sizes, in rows of this width.
    pub(in crate::panel) fn of(sizes: &[Vec2], width: f32) -> Self {
        if sizes.is_empty() {
            return Self::default();
        }
        let room = Rect::from_min_size(Pos2::ZERO, vec2(width, 0.0));
        let (mut column, mut rows) = (Placer::column(room, Align2::LEFT_TOP, 0.0), Placer::rows(room));
        for size in sizes {
            column.place(*size);
            rows.place(*size);
        }
        let widest = sizes.iter().map(|size| size.x).fold(0.0, f32::max);
        Self { column: vec2(widest, column.below() - GAP), rows: rows.below() }
    }

    /// The room for either.
    pub(in crate::panel) fn or(self, other: Self) -> Self {
        Self { column: self.column.max(other.column), rows: self.rows.max(other.rows) }
    }

    /// The room that plates took so far. As long as the presentation shows the same things, it does not shrink: a picture
    /// that became larger again could clip again, and so on.
    pub(in crate::panel) fn so_far(ui: &Ui, whole: Rect, session: &Session) -> Self {
        let known: Known = kept::get(ui.ctx());
        if known.key == key(ui, whole, session) { known.needed } else { Self::default() }
    }

    /// Keeps the room that plates took. If that is more than before, the frame is laid out once more.
    pub(in crate::panel) fn keep(self, ui: &Ui, whole: Rect, session: &Session) {
        let before = Self::so_far(ui, whole, session);
        let needed = self.or(before);
        if needed != before {
            kept::set(ui.ctx(), Known { key: key(ui, whole, session), needed });
            ui.ctx().request_discard("plates need more room");
            // There is a limit to how often that is done in a frame.
            ui.ctx().request_repaint();
        }
    }
}

/// The room that plates took so far, and what they were about.
#[derive(Clone, Copy, Debug, Default)]
struct Known {
    key: u64,
    needed: Needed,
}

/// Everything that changes plates, except clipping.
fn key(ui: &Ui, whole: Rect, session: &Session) -> u64 {
    let mut hasher = DefaultHasher::new();
    let views = (0..=session.document.variants.len())
        .map(|view| (session.channel_of(view), session.terms_of(view).id()))
        .collect::<Vec<_>>();
    let layout = session.document.comparison.layout;
    let stale = session.shaders.stale();
    format!("{whole:?} {layout:?} {} {views:?} {stale:?} {}", session.active(), since(ui)).hash(&mut hasher);
    hasher.finish()
}

/// The place of the plates over a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::panel) enum Spot {
    /// A corner, for a column of this height.
    Corner(Align2, f32),
    /// A band of this height above the picture.
    Band(f32),
}

impl Spot {
    /// The spot that is free in every one of several pictures of the same size.
    pub(in crate::panel) fn of_pictures(ui: &Ui, picture: Rect, session: &Session, needed: Needed) -> Self {
        // A turning camera must not move the layout.
        let mut hasher = DefaultHasher::new();
        let objects: Vec<_> = session.scene().shown().map(|o| (o.position, o.size)).collect();
        format!("{picture:?} {needed:?} {objects:?} {}", since(ui)).hash(&mut hasher);
        kept::of_key(ui.ctx(), Id::new("spot of the presentation"), hasher.finish(), || {
            Self::corner(&discs(session, picture), picture, needed, &[])
                .unwrap_or_else(|| Self::band(needed, picture))
        })
    }

    /// The first free corner of a picture.
    pub(super) fn corner(
        discs: &[(Pos2, f32)],
        picture: Rect,
        needed: Needed,
        taken: &[Rect],
    ) -> Option<Self> {
        let corners = [Align2::LEFT_TOP, Align2::RIGHT_TOP, Align2::LEFT_BOTTOM, Align2::RIGHT_BOTTOM];
        let column = needed.column;
        let found = free(discs, picture, column, taken, corners);
        found.map(|(corner, _)| Self::Corner(corner, column.y))
    }

    /// The band above a picture.
    pub(super) fn band(needed: Needed, picture: Rect) -> Self {
        Self::Band(needed.rows.min(HIGHEST * picture.height()))
    }

    /// Height of the band above the picture.
    pub(in crate::panel) fn above(self) -> f32 {
        match self {
            Self::Corner(..) => 0.0,
            Self::Band(height) => height,
        }
    }

    /// The places over a picture, or in the band above it.
    pub(in crate::panel) fn placer(self, picture: Rect) -> Placer {
        match self {
            Self::Corner(corner, height) => {
                let place = corner.align_size_within_rect(vec2(0.0, height), picture.shrink(EDGE));
                Placer::column(picture, corner, place.top())
            }
            Self::Band(height) => Placer::rows(picture.with_min_y(picture.top() - height)),
        }
    }
}

/// The first of some corners of a picture in which a plate of this size hides no object and lies over none of these
/// rectangles, and the place of the plate.
fn free(
    discs: &[(Pos2, f32)],
    picture: Rect,
    size: Vec2,
    taken: &[Rect],
    corners: [Align2; 4],
) -> Option<(Align2, Rect)> {
    let place = |corner: Align2| corner.align_size_within_rect(size, picture.shrink(EDGE));
    let is_free = |place: &Rect| {
        picture.contains_rect(*place)
            && hidden(discs, &[*place]) <= 0.0
            && !taken.iter().any(|other| other.intersects(*place))
    };
    corners.into_iter().map(|corner| (corner, place(corner))).find(|(_, place)| is_free(place))
}

/// Shows the message of the moment in a corner of a picture where it hides nothing, or else over the texts at the lower
/// end of the screen.
pub(in crate::panel) fn message(
    ui: &Ui,
    whole: Rect,
    pictures: &[Rect],
    written: &[Rect],
    session: &Session,
) {
    let corners = [Align2::RIGHT_BOTTOM, Align2::LEFT_BOTTOM, Align2::RIGHT_TOP, Align2::LEFT_TOP];
    let place = |size: Vec2| {
        // It stays where it is while the camera turns.
        let (key, id) = (format!("{size:?} {pictures:?} {written:?}"), Id::new("place of the notice"));
        let found = kept::of_key(ui.ctx(), id, key, || {
            let in_picture = |r: &Rect| free(&discs(session, *r), *r, size, written, corners);
            pictures.iter().rev().find_map(in_picture).map(|(_, place)| place)
        });
        found.unwrap_or_else(|| Align2::RIGHT_BOTTOM.align_size_within_rect(size, whole.shrink(EDGE)))
    };
    notice::show(ui, (whole, CAPTION * whole.height()), since(ui), &session.messages, place);
}
