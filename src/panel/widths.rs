//! The widths of the panels beside the picture: if there is little room, panels that the user has not resized give way
//! to the picture. So does the strip below it.

use bevy_egui::egui::Rangef;

use super::{prelude::*, state::Settings};

/// Fraction of the window that the picture keeps, unless the user makes the panels wider.
const PICTURE: f32 = 0.45;
/// Fraction of the window that the picture keeps even if the panels become narrower than they should be.
const LEAST: f32 = 0.4;

/// Width of a panel, in points.
pub(super) struct Width {
    pub(super) default: f32,
    pub(super) range: Rangef,
}

/// The widths of the panels beside the picture.
pub(super) struct Widths {
    pub(super) left: Width,
    pub(super) right: Width,
    /// True if the user has given the strip at the bottom a height, or is dragging.
    pub(super) is_height_given: bool,
}

/// A panel beside the picture.
struct Side {
    open: bool,
    /// The width set by the user.
    own: Option<f32>,
    usual: f32,
    least: f32,
    /// The minimum width where the picture would become too narrow.
    floor: f32,
    most: f32,
}

impl Side {
    /// The panels that are open, left and right, in a window of this width.
    fn both([left, right]: [bool; 2], own: &Settings, lesson: bool, whole: f32) -> [Self; 2] {
        let usual = Settings::default();
        let side = |open, wanted: f32, usual: f32, [floor, least]: [f32; 2], most| Self {
            open,
            own: (wanted != usual).then_some(wanted.min(most)),
            usual: usual.min(most),
            least: least.min(most),
            floor,
            most,
        };
        // Beside a lesson, every knob must remain usable.
        let least = if lesson { 294.0 } else { 280.0 };
        [
            if lesson {
                side(left, own.lesson_width, usual.lesson_width, [184.0, 264.0], 0.45 * whole)
            } else {
                side(left, own.left_width, usual.left_width, [96.0, 120.0], 0.26 * whole)
            },
            side(right, own.right_width, usual.right_width, [264.0, least], 0.45 * whole),
        ]
    }

    /// The widths of panels that the user has not resized, in a window of this width: where they would leave the picture
    /// too little, they are narrower than they should be, the left one first.
    fn widths(sides: &[Self; 2], whole: f32) -> [f32; 2] {
        let taken = |widths: [f32; 2]| -> f32 {
            sides.iter().zip(widths).filter(|(side, _)| side.open).map(|(_, width)| width).sum()
        };
        let usual = taken(sides.each_ref().map(|side| side.usual));
        let share = ((1.0 - PICTURE) * whole / usual.max(1.0)).min(1.0);
        let mut widths = sides.each_ref().map(|side| (share * side.usual).max(side.least));
        let mut over = (taken(widths) - (1.0 - LEAST) * whole).max(0.0);
        for (side, width) in sides.iter().zip(&mut widths).filter(|(side, _)| side.open) {
            let cut = over.min((*width - side.floor).max(0.0));
            *width -= cut;
            over -= cut;
        }
        widths
    }
}

/// The current zoom, in per cent.
pub(super) fn zoom_percent(ctx: &Context) -> u32 {
    (100.0 * ctx.zoom_factor()).round() as u32
}

/// Key of the flag that the user is dragging the edge of a panel.
fn dragging() -> Id {
    Id::new("panel dragged")
}

impl Widths {
    /// The widths in a window that is `whole` points wide.
    pub(super) fn of(ctx: &Context, session: &Session, whole: f32) -> Self {
        let (view, own) = (&session.view, &session.settings);
        let sides = Side::both([view.left_open, view.right_open], own, session.lesson.is_some(), whole);
        // Resizing one panel does not change the other.
        let [of_left, of_right] = Side::widths(&sides, whole);
        let dragged = ctx.data(|d| d.get_temp(dragging())).unwrap_or(false)
            || ctx.input(|i| i.pointer.any_down()) && ctx.dragged_id().is_some();
        let width = |Side { own, least, most, .. }: Side, usual: f32| {
            let default = own.unwrap_or(usual);
            let range = match own.is_some() || dragged {
                true => Rangef::new(least.min(usual), most),
                false => Rangef::point(default),
            };
            Width { default, range }
        };
        let [left, right] = sides;
        let (left, right) = (width(left, of_left), width(right, of_right));
        let height = |settings: &Settings| settings.strip_height(&view.bottom_tab);
        let is_height_given = dragged || height(own) != height(&Settings::default());
        Self { left, right, is_height_given }
    }

    /// The action that stores the widths and the height of the bottom strip after dragging; `sizes` are those on
    /// screen.
    pub(super) fn dragged(&self, ctx: &Context, session: &Session, sizes: (f32, f32, f32)) -> Option<Action> {
        let own = &session.settings;
        let kept = |size: f32, given: f32, known: f32| if (size - given).abs() > 1.0 { size } else { known };
        let known = if session.lesson.is_some() { own.lesson_width } else { own.left_width };
        let left = kept(sizes.0, self.left.default, known);
        let right = kept(sizes.1, self.right.default, own.right_width);
        let strip = own.strip_height(&session.view.bottom_tab);
        let bottom = kept(sizes.2, strip, strip);
        let moved = (left, right, bottom) != (known, own.right_width, strip);
        let down = ctx.input(|i| i.pointer.any_down());
        if down && ctx.dragged_id().is_some() && moved {
            ctx.data_mut(|d| d.insert_temp(dragging(), true));
            return None;
        }
        let over = !down && ctx.data_mut(|d| d.remove_temp::<bool>(dragging())).unwrap_or(false);
        (over && moved).then_some(Action::View(ViewChange::Sizes { left, right, bottom }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::state::SCALES;

    #[test]
    fn panels_and_the_least_picture_fit_into_every_window_at_every_scale() {
        let wide =
            Settings { lesson_width: 900.0, left_width: 900.0, right_width: 900.0, ..Settings::default() };
        for pixels in [640.0, 800.0, 1000.0, 1280.0, 1920.0] {
            for (scale, lesson) in SCALES.into_iter().flat_map(|scale| [(scale, false), (scale, true)]) {
                let whole = pixels * 100.0 / f32::from(scale);
                let here = format!("{pixels} pixels, {scale} %, lesson: {lesson}");
                let sides = Side::both([true, true], &Settings::default(), lesson, whole);
                let picture = whole - Side::widths(&sides, whole).iter().sum::<f32>();
                let least = if pixels < 1280.0 { 0.099 } else { 0.29 };
                assert!(picture >= least * whole, "{here}: {picture} of {whole}");
                // What the user drags leaves some of it too.
                let own =
                    Side::both([true, true], &wide, lesson, whole).map(|side| side.own.unwrap_or(side.usual));
                assert!(whole - own.iter().sum::<f32>() >= 0.099 * whole, "{here}: {own:?} of {whole}");
            }
        }
    }

    #[test]
    fn panels_leave_the_picture_its_part_and_the_left_one_gives_way_first() {
        let widths = |left: [f32; 3], right: [f32; 2], open: bool, whole: f32| {
            let side = |open, [floor, least, usual]: [f32; 3]| {
                let most = 0.45 * whole;
                let [least, usual] = [least, usual].map(|width| f32::min(width, most));
                Side { open, own: None, usual, least, floor, most }
            };
            let sides = [side(true, left), side(open, [264.0, right[0], right[1]])];
            Side::widths(&sides, whole).map(f32::round)
        };
        let (lesson, right) = ([184.0, 264.0, 340.0], [294.0, 340.0]);
        assert_eq!(widths(lesson, right, true, 1280.0), [340.0, 340.0], "there is room");
        assert_eq!(widths(lesson, right, true, 1000.0), [275.0, 294.0]);
        assert_eq!(widths(lesson, right, true, 900.0), [246.0, 294.0]);
        // Type at 200 % in a window of 1280 pixels.
        assert_eq!(widths(lesson, right, true, 640.0), [184.0, 264.0]);
        assert_eq!(widths([96.0, 120.0, 200.0], [280.0, 340.0], true, 640.0), [104.0, 280.0]);
        assert_eq!(widths(lesson, right, true, 500.0), [184.0, 225.0], "not narrower than that");
        assert_eq!(widths(lesson, right, false, 640.0)[0], 288.0, "a closed one takes nothing");
    }
}
