//! The parts of a picture that show one of several views, and their letters.

use crate::{
    compare::canvas::{Canvas, DARK, Rect, in_corner},
    lettering::Lettering,
    scene::variant::LETTERS,
};

/// A part of a picture that shows one of several views, with the view's letter.
#[derive(Clone, Copy, Debug)]
pub(in crate::compare) struct Area {
    /// The index of the view among those of the layout.
    pub(in crate::compare) place: usize,
    pub(super) view: usize,
    pub(super) rect: Rect,
    /// The corner of the letter; the flags select right and bottom.
    pub(in crate::compare) corner: [bool; 2],
}

/// The size of view letters at a scale of 1, pixels.
const LETTER: f32 = 20.0;

impl Area {
    /// The rectangle of the letter's plate in the corner; `None` without room.
    fn plate(&self, canvas: &Canvas) -> Option<Rect> {
        let letter = LETTERS.get(self.view)?;
        let [_, _, width, height] = self.rect;
        let (scale, style) = (canvas.scale(), Lettering::Semibold);
        let px = LETTER * scale;
        let line = style.height(px);
        let margin = (8.0 * scale).round() as u32;
        let plate = [line.max(style.width(px, letter) + margin), line];
        if width < plate[0] + 2 * margin || height < plate[1] + 2 * margin {
            return None;
        }
        Some(in_corner(self.rect, self.corner, plate, margin))
    }

    /// The part of the area below the letter, or above it.
    pub(in crate::compare) fn clear_of_letter(&self, canvas: &Canvas) -> Rect {
        let [left, top, width, height] = self.rect;
        let Some([_, y, _, line]) = self.plate(canvas) else { return self.rect };
        if self.corner[1] {
            [left, top, width, y - top]
        } else {
            let below = y + line;
            [left, below, width, top + height - below]
        }
    }
}

/// Draws the letter of a view on its plate.
pub(super) fn letter(canvas: &mut Canvas, area: &Area) {
    let (Some(letter), Some(plate)) = (LETTERS.get(area.view), area.plate(canvas)) else { return };
    let (px, style) = (LETTER * canvas.scale(), Lettering::Semibold);
    let [x, y, width, _] = plate;
    canvas.fill(plate, DARK, 0.88);
    canvas.text(style, [x + (width - style.width(px, letter)) / 2, y], px, letter);
}
