//! Places of what is written over a picture, one after the other.

use super::prelude::*;

/// Distance of plates from the edges of their picture, in points.
pub(super) const EDGE: f32 = 8.0;
/// Distance between plates, in points.
pub(super) const GAP: f32 = 4.0;

/// Gives plates over a picture their places: below each other from a corner on, or in rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placer {
    /// The rectangle for the plates.
    pub(super) room: Rect,
    side: Align2,
    at: Pos2,
    /// Top of the next row; `None` for a column.
    next_row: Option<f32>,
    /// The sizes of the plates so far.
    pub(super) sizes: Vec<Vec2>,
}

impl Placer {
    /// A column at the left or right side, from `top` on.
    pub(super) fn column(room: Rect, side: Align2, top: f32) -> Self {
        let at = pos2(side.pos_in_rect(&room.shrink(EDGE)).x, top);
        let side = Align2([side.x(), Align::TOP]);
        Self { room, side, at, next_row: None, sizes: Vec::new() }
    }

    /// Rows from the top on.
    pub(super) fn rows(room: Rect) -> Self {
        let at = room.left_top() + vec2(EDGE, GAP);
        Self { room, side: Align2::LEFT_TOP, at, next_row: Some(at.y), sizes: Vec::new() }
    }

    /// The place of the next plate.
    pub(super) fn place(&mut self, size: Vec2) -> Rect {
        self.sizes.push(size);
        if let Some(next) = self.next_row
            && self.at.x > self.room.left() + EDGE
            && self.at.x + size.x > self.room.right() - EDGE
        {
            self.at = pos2(self.room.left() + EDGE, next);
        }
        let place = self.side.anchor_size(self.at, size);
        match &mut self.next_row {
            Some(next) => {
                *next = next.max(place.bottom() + GAP);
                self.at.x = place.right() + GAP;
            }
            None => self.at.y = place.bottom() + GAP,
        }
        place
    }

    /// Top of the free space below the plates.
    pub(super) fn below(&self) -> f32 {
        self.next_row.unwrap_or(self.at.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plates_lie_below_each_other_or_in_rows_and_never_over_each_other() {
        let room = Rect::from_min_size(pos2(10.0, 20.0), vec2(200.0, 300.0));
        let sizes = [vec2(90.0, 20.0), vec2(80.0, 40.0), vec2(60.0, 10.0), vec2(190.0, 10.0)];
        for mut placer in [
            Placer::column(room, Align2::RIGHT_BOTTOM, 28.0),
            Placer::column(room, Align2::LEFT_TOP, 28.0),
            Placer::rows(room),
        ] {
            let places = sizes.map(|size| placer.place(size));
            for (i, place) in places.iter().enumerate() {
                assert!(places[..i].iter().all(|other| !other.intersects(*place)), "{places:?}");
                assert!(place.bottom() < placer.below());
            }
        }
        let mut rows = Placer::rows(room);
        let places = sizes.map(|size| rows.place(size));
        assert_eq!(places[0].top(), places[1].top(), "beside each other while there is room");
        assert!(places[2].top() > places[1].bottom());
    }
}
