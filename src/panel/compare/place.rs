//! The declaration of a layout in the window, and the places that it gives to views.

use crate::{
    panel::{prelude::*, state::Cell},
    scene::Comparison,
};

/// Height of a header, in points.
pub(super) const HEADER: f32 = 28.0;
/// Width below which the header of one of several views has two lines, and its height then, in points.
pub(super) const NARROW_HEADER: f32 = 180.0;
pub(super) const TWO_LINES: f32 = 38.0;
/// Gap between views, in points.
pub(super) const GAP: f32 = 2.0;

/// Arrangement of everything that belongs to a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrangement {
    /// The views, all of the same size.
    pub cells: Vec<Cell>,
    /// The headers, by view.
    pub(in crate::panel) headers: Vec<(usize, Rect)>,
    /// The bar below.
    pub(super) bar: Option<Rect>,
    /// The picture without headers and bar.
    pub picture: Rect,
    /// The difference map.
    pub map: Option<Rect>,
    /// Space of the missing fourth view when there are three.
    pub(super) vacant: Option<Rect>,
}

impl Arrangement {
    pub(super) fn new(picture: Rect) -> Self {
        let (cells, headers, bar, map, vacant) = Default::default();
        Self { cells, headers, bar, picture, map, vacant }
    }

    /// True if the scene has no variants and the picture stands alone.
    #[must_use]
    pub fn is_single(&self) -> bool {
        self.headers.is_empty()
    }
}

/// A layout in the window.
pub(super) struct Arranging {
    /// A sentence below its tooltip.
    pub(super) hint: Option<fn(&Context) -> String>,
    /// Puts the views in their places.
    pub(super) arrange: fn(&mut Arrangement, &Frame),
    /// The number of rows with its choices: in a wide bar, and in a narrow one.
    pub(super) rows: [usize; 2],
    /// Shows a row of its choices; true in a wide bar.
    pub(super) choices: fn(&mut Ui, &Session, &mut Comparison, usize, bool),
    /// True if the largest difference stands in the row of the choices.
    pub(super) largest_apart: bool,
    /// Shows what lies over the picture, and says where.
    pub(super) over: fn(&mut Ui, Rect, &mut PanelContext<'_>) -> Option<Rect>,
}

impl Arranging {
    /// A layout without choices.
    pub(super) const PLAIN: Self = Self {
        hint: None,
        arrange: |_, _| (),
        rows: [0, 0],
        choices: |_, _, _, _, _| (),
        largest_apart: false,
        over: |_, _, _| None,
    };
}

/// The place for views.
pub(super) struct Frame<'a> {
    pub(super) session: &'a Session,
    pub(super) picture: Rect,
    /// The views that the layout shows.
    pub(super) views: Vec<usize>,
    /// Height of a header.
    pub(super) high: f32,
    /// Height of the space between a header and its view.
    pub(super) band: f32,
}

impl Frame<'_> {
    pub(super) fn comparison(&self) -> &Comparison {
        &self.session.document.comparison
    }

    pub(super) fn below_header(&self, rect: Rect) -> Rect {
        Rect::from_min_max(rect.min + vec2(0.0, self.high + self.band), rect.max)
    }

    pub(super) fn header(&self, rect: Rect) -> Rect {
        Rect::from_min_size(rect.min, vec2(rect.width(), self.high))
    }
}

/// A rectangle's left and right half.
fn halves(rect: Rect) -> [Rect; 2] {
    let middle = rect.center().x;
    [rect.with_max_x(middle - 0.5 * GAP), rect.with_min_x(middle + 0.5 * GAP)]
}

/// Puts two views over each other, of which these parts are seen.
pub(super) fn over_each_other(all: &mut Arrangement, frame: &Frame, parts: [Rect; 2]) {
    let rect = frame.below_header(frame.picture);
    all.headers.extend(frame.views.iter().copied().zip(halves(frame.header(frame.picture))));
    all.cells.extend(frame.views.iter().zip(parts).map(|(view, part)| Cell { view: *view, rect, part }));
}
