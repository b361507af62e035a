//! Figures drawn into the window.

use bevy_egui::egui::{ColorImage, Painter, TextureHandle, TextureOptions};

use crate::{
    curves::draw::{Anchor, Ink, Pen},
    panel::prelude::*,
};

/// Points of the window per unit of a figure: text has the size of that in panels.
pub(super) const SCALE: f32 = 0.75;
/// Points of a line nearer to each other than this are one, points.
const NEAR: f32 = 0.35;

/// Draws figures into a place of the window.
pub(super) struct Screen<'a> {
    painter: Painter,
    at: Pos2,
    palette: Palette,
    textures: &'a mut Textures,
    pictures: usize,
    /// The series that stands out from the others, by its number.
    pub(super) lit: Option<usize>,
    /// The series that is being drawn.
    series: Option<usize>,
}

/// A line that stands out is so many times as wide.
const WIDER: f32 = 2.2;
/// The part of their opacity that the others keep.
const DIM: f32 = 0.5;

/// The pictures of a figure on the GPU, in its order.
#[derive(Default)]
pub(super) struct Textures {
    all: Vec<TextureHandle>,
    /// They are those of the figure before.
    pub(super) stale: bool,
}

impl<'a> Screen<'a> {
    pub(super) fn new(ui: &Ui, place: Rect, textures: &'a mut Textures) -> Self {
        if std::mem::take(&mut textures.stale) {
            textures.all.clear();
        }
        Self {
            painter: ui.painter_at(place),
            at: place.min,
            palette: Palette::here(ui),
            textures,
            pictures: 0,
            lit: None,
            series: None,
        }
    }

    pub(super) fn place(&self, [x, y]: [f64; 2]) -> Pos2 {
        self.at + SCALE * vec2(x as f32, y as f32)
    }

    pub(super) fn colour(&self, ink: Ink) -> Color32 {
        match (ink, ink.colour()) {
            (_, Some([r, g, b])) => Color32::from_rgb(r, g, b),
            (Ink::Grid, None) => self.palette.line.gamma_multiply(0.7),
            (_, None) => self.palette.text,
        }
    }

    fn laid(&self, px: f64, text: &str) -> Arc<Galley> {
        let font = FontId::proportional(SCALE * px as f32);
        self.painter.layout_no_wrap(text.to_owned(), font, self.palette.text)
    }
}

impl Pen for Screen<'_> {
    fn stroke(&mut self, path: &[[f64; 2]], ink: Ink, width: f64, dash: &[f64]) {
        let mut points: Vec<Pos2> = Vec::with_capacity(path.len());
        for (i, point) in path.iter().enumerate() {
            let point = self.place(*point);
            let near = points.last().is_some_and(|last| last.distance(point) < NEAR);
            if !near || i + 1 == path.len() {
                points.push(point);
            }
        }
        let (width, colour) = ((width as f32 * SCALE).max(1.0), self.colour(ink));
        let stroke = match (self.lit, self.series) {
            (Some(lit), Some(series)) if lit == series => Stroke::new(width * WIDER, colour),
            (Some(_), Some(_)) => Stroke::new(width, colour.gamma_multiply(DIM)),
            _ => Stroke::new(width, colour),
        };
        if dash.is_empty() {
            self.painter.add(Shape::line(points, stroke));
            return;
        }
        let lengths: Vec<f32> = dash.iter().map(|length| SCALE * *length as f32).collect();
        let of = |part: usize| lengths.iter().skip(part).step_by(2).copied().collect::<Vec<_>>();
        self.painter.extend(Shape::dashed_line_with_offset(&points, stroke, &of(0), &of(1), 0.0));
    }

    fn fill(&mut self, path: &[[f64; 2]], ink: Ink) {
        let points = path.iter().map(|point| self.place(*point)).collect();
        self.painter.add(Shape::convex_polygon(points, self.colour(ink), Stroke::NONE));
    }

    fn text(&mut self, at: [f64; 2], anchor: Anchor, px: f64, text: &str) {
        let galley = self.laid(px, text);
        let first = galley.rows.first().and_then(|row| row.glyphs.first());
        let rise = first.map_or(0.8 * galley.size().y, |glyph| glyph.pos.y);
        let align = match anchor {
            Anchor::Start => Align2::LEFT_TOP,
            Anchor::Middle => Align2::CENTER_TOP,
            Anchor::End => Align2::RIGHT_TOP,
        };
        let place = align.anchor_size(self.place(at) - vec2(0.0, rise), galley.size());
        self.painter.galley(place.min, galley, self.palette.text);
    }

    fn picture(&mut self, [x, y, width, height]: [f64; 4], size: [u32; 2], rgb8: &[u8]) {
        if self.textures.all.len() <= self.pictures {
            let image = ColorImage::from_rgb(size.map(|n| n as usize), rgb8);
            let texture = self.painter.ctx().load_texture("slice", image, TextureOptions::LINEAR);
            self.textures.all.push(texture);
        }
        let Some(texture) = self.textures.all.get(self.pictures) else { return };
        self.pictures += 1;
        let place = Rect::from_min_max(self.place([x, y]), self.place([x + width, y + height]));
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        self.painter.image(texture.id(), place, whole, Color32::WHITE);
    }

    fn series(&mut self, series: Option<usize>) {
        self.series = series;
    }

    fn width(&self, px: f64, text: &str) -> f64 {
        f64::from(self.laid(px, text).size().x / SCALE)
    }
}
