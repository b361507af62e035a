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
    /// The room for plates that have these sizes below each other, and these in rows of this width.
    pub(in crate::panel) fn of([below, beside]: [&[Vec2]; 2], width: f32) -> Self {
        if below.is_empty() {
            return Self::default();
        }
        let room = Rect::from_min_size(Pos2::ZERO, vec2(width, 0.0));
        let mut column = Placer::column(room, Align2::LEFT_TOP, 0.0);
        below.iter().for_each(|size| _ = column.place(*size));
        let widest = below.iter().map(|size| size.x).fold(0.0, f32::max);
        let rows = height_of_rows(beside.iter().copied(), width);
        Self { column: vec2(widest, column.below() - GAP), rows }
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

/// The height of rows of this width with plates of these sizes.
pub(in crate::panel) fn height_of_rows(sizes: impl Iterator<Item = Vec2>, width: f32) -> f32 {
    let mut rows = Placer::rows(Rect::from_min_size(Pos2::ZERO, vec2(width, 0.0)));
    sizes.for_each(|size| _ = rows.place(size));
    rows.below()
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
pub(in crate::panel) enum PlatePlace {
    /// A corner, for a column of this height.
    Corner(Align2, f32),
    /// A band of this height above the picture.
    Band(f32),
}

impl PlatePlace {
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
        let found = free(discs, picture, column, taken, &corners);
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

    /// The rectangle of a column of plates over a picture; nothing if they are in a band.
    pub(in crate::panel) fn column(self, picture: Rect, needed: Needed) -> Rect {
        match self {
            Self::Corner(corner, _) => corner.align_size_within_rect(needed.column, picture.shrink(EDGE)),
            Self::Band(_) => Rect::NOTHING,
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

/// The first of some corners or edges of a picture at which a plate of this size hides no object and lies over none of these
/// rectangles, and the place of the plate.
fn free(
    discs: &[(Pos2, f32)],
    picture: Rect,
    size: Vec2,
    taken: &[Rect],
    corners: &[Align2],
) -> Option<(Align2, Rect)> {
    let place = |corner: Align2| corner.align_size_within_rect(size, picture.shrink(EDGE));
    let is_free = |place: &Rect| {
        picture.contains_rect(*place)
            && hidden(discs, &[*place]) <= 0.0
            && !taken.iter().any(|other| other.intersects(*place))
    };
    corners.iter().map(|corner| (*corner, place(*corner))).find(|(_, place)| is_free(place))
}

/// Places of a message in a picture, the best first.
const PLACES: [Align2; 8] = [
    Align2::RIGHT_BOTTOM,
    Align2::LEFT_BOTTOM,
    Align2::RIGHT_TOP,
    Align2::LEFT_TOP,
    Align2::CENTER_BOTTOM,
    Align2::CENTER_TOP,
    Align2::RIGHT_CENTER,
    Align2::LEFT_CENTER,
];

/// The place of a message of this size where it covers no object of the pictures, each of which comes with its own, and none of
/// these texts if that is possible.
fn place_of_message(size: Vec2, whole: Rect, pictures: &[(Rect, Vec<(Pos2, f32)>)], texts: &[Rect]) -> Rect {
    let all = pictures.iter().fold(Rect::NOTHING, |all, (picture, _)| all.union(*picture));
    let discs: Vec<_> = pictures.iter().flat_map(|(_, discs)| discs.iter().copied()).collect();
    let alone = pictures.iter().find_map(|(picture, discs)| free(discs, *picture, size, texts, &PLACES));
    // It may be wider than each of several pictures.
    let found = alone.or_else(|| free(&discs, all, size, texts, &PLACES)).map(|(_, place)| place);
    found.unwrap_or_else(|| Align2::RIGHT_BOTTOM.align_size_within_rect(size, whole.shrink(EDGE)))
}

/// Shows the message of the moment over pictures, clear of these texts and of objects, or else over the texts at the lower end
/// of the screen.
pub(in crate::panel) fn message(ui: &Ui, whole: Rect, pictures: &[Rect], texts: &[Rect], session: &Session) {
    let place = |size: Vec2| {
        // It stays where it is while the camera turns.
        let (key, id) =
            (format!("{size:?} {whole:?} {pictures:?} {texts:?}"), Id::new("place of the notice"));
        kept::of_key(ui.ctx(), id, key, || {
            let seen: Vec<_> = pictures.iter().rev().map(|r| (*r, discs(session, *r))).collect();
            place_of_message(size, whole, &seen, texts)
        })
    };
    notice::show(ui, (whole, CAPTION * whole.height()), since(ui), &session.messages, place);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_covers_no_object_and_no_text_if_that_is_possible() {
        let rect = |x: [f32; 2], y: [f32; 2]| Rect::from_x_y_ranges(x[0]..=x[1], y[0]..=y[1]);
        let (whole, size) = (rect([0.0, 400.0], [0.0, 300.0]), vec2(150.0, 30.0));
        let footer = rect([0.0, 400.0], [240.0, 300.0]);
        let picture = |x: f32, discs: &[(Pos2, f32)]| (rect([x, x + 100.0], [0.0, 240.0]), discs.to_vec());
        let place = |pictures: &[_], texts: &[Rect]| place_of_message(size, whole, pictures, texts);
        // Wider than each of four pictures.
        let four = [0.0, 100.0, 200.0, 300.0].map(|x| picture(x, &[(pos2(x + 50.0, 200.0), 20.0)]));
        let found = place(&four, &[footer]);
        assert!(!found.intersects(footer) && found.bottom() < 180.0, "{found:?}");
        // Objects everywhere: texts are covered.
        let full = [0.0, 100.0, 200.0, 300.0].map(|x| picture(x, &[(pos2(x + 50.0, 120.0), 130.0)]));
        let found = place(&full, &[footer]);
        assert!(footer.contains_rect(found), "{found:?}");
    }
}
