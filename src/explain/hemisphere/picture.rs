//! The hemisphere above a point as a picture: three discs with their scales.

use glam::{Vec2, Vec3};

use super::{Above, DISCS, Disc, Hemisphere};
use crate::{
    explain::rounded,
    lettering::{Lettering, pixel},
    optics::colour::srgb_encode8,
};

/// A picture with its description.
#[derive(Clone, Debug)]
pub struct HemispherePicture {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Colours, row by row from the top.
    pub rgb8: Vec<u8>,
    /// Description in words.
    pub about: String,
}

const GROUND: [u8; 3] = [24, 26, 30];
const TEXT: [u8; 3] = [230, 232, 236];
const WEAK: [u8; 3] = [160, 166, 174];
const RIM: [u8; 3] = [96, 102, 112];
/// The colours of V and R, as in the window.
const BLUE: [u8; 3] = [86, 180, 233];
const VERMILION: [u8; 3] = [230, 110, 40];
const YELLOW: [u8; 3] = [240, 228, 66];

/// Pixels between and around the discs.
const GAP: u32 = 28;
/// Space above and below the discs, in pixels.
const HEAD: u32 = 44;
const FOOT: u32 = 122;
/// Further space for a remark on light that does not spread.
const REMARK: u32 = 36;
/// Sizes of text.
const TITLE: f32 = 17.0;
const SMALL: f32 = 13.0;

impl Hemisphere {
    /// The values in the disc at a position with a radius of at most 1.
    #[must_use]
    pub fn at(&self, place: Vec2) -> Option<Above> {
        let [x, y] = [place.x, -place.y].map(|v| (0.5 * (v + 1.0) * self.side as f32).floor());
        let inside = |v: f32| v >= 0.0 && v < self.side as f32;
        if !inside(x) || !inside(y) {
            return None;
        }
        self.pixels[y as usize * self.side + x as usize]
    }

    /// The value drawn as white in one of the discs: the 99th percentile of the values that are not dark.
    #[must_use]
    pub fn white(&self, of: fn(&Above) -> Vec3) -> f32 {
        let mut all: Vec<_> = self.pixels.iter().flatten().map(|above| of(above).max_element()).collect();
        all.retain(|v| v.is_finite() && *v > 0.0);
        all.sort_by(f32::total_cmp);
        all.get((all.len().saturating_sub(1)) * 99 / 100).copied().unwrap_or(1.0)
    }

    /// The number that is drawn white in a disc, and the largest where that is brighter; `None` where all is black.
    #[must_use]
    pub fn numbers_of_scale(&self, disc: &Disc) -> Option<(String, Option<String>)> {
        if self.pixels.iter().flatten().all(|above| (disc.of)(above) == Vec3::ZERO) {
            return None;
        }
        let white = self.white(disc.of);
        let largest = (disc.of)(&self.brightest).max_element().max(white);
        let [white, largest] = [white, largest].map(|v| rounded(v, 3));
        let brighter = (largest != white).then_some(largest);
        Some((white, brighter))
    }

    /// The value that is drawn white in a disc, and the largest where that is brighter.
    #[must_use]
    pub fn end_of_scale(&self, disc: &Disc) -> String {
        let Some((white, brighter)) = self.numbers_of_scale(disc) else {
            return "none, all is black".to_owned();
        };
        let end = format!("{white} {}", disc.unit).trim_end().to_owned();
        brighter.map_or_else(|| end.clone(), |largest| format!("{end}; brightest: {largest}"))
    }

    /// The three discs beside each other with their names, scales and marks.
    #[must_use]
    pub fn picture(&self) -> HemispherePicture {
        let side = self.side as u32;
        let foot = if self.sharp { FOOT + REMARK } else { FOOT };
        let size = [GAP + 3 * (side + GAP), HEAD + side + foot];
        let rgb8 = GROUND.repeat((size[0] * size[1]) as usize);
        let mut canvas = Canvas { rgb8, size };
        let mut whites = Vec::new();
        for (i, disc) in DISCS.iter().enumerate() {
            let left = GAP + i as u32 * (side + GAP);
            canvas.text(Lettering::Semibold, [left, 12], TITLE, TEXT, disc.name);
            self.draw(&mut canvas, [left, HEAD], disc.of);
            let scale = self.end_of_scale(disc);
            canvas.scale([left, HEAD + side + 14], side, &scale);
            whites.push(format!("white in “{}”: {scale}", disc.name));
        }
        let ground = "From straight above the surface: area is projected solid angle, N is the middle, the rim is the horizon, the tangent \
             points right. V: to the observer; R: its mirror direction.";
        let lines: Vec<_> = [ground.to_owned()].into_iter().chain(self.said()).collect();
        let mut y = HEAD + side + 52;
        for line in lines.iter().flat_map(|line| Lettering::Regular.lines(SMALL, line, size[0] - 2 * GAP, 3))
        {
            canvas.text(Lettering::Regular, [GAP, y], SMALL, WEAK, &line);
            y += 18;
        }
        let about = format!("{}; {}", lines.join(" "), whites.join(", "));
        HemispherePicture { size, rgb8: canvas.rgb8, about }
    }

    /// One of the discs: red, green, blue and opacity, row by row from the top, with white at
    /// [`white`](Self::white).
    #[must_use]
    pub fn disc(&self, of: fn(&Above) -> Vec3) -> Vec<[u8; 4]> {
        let (white, middle) = (self.white(of), 0.5 * self.side as f32);
        let code = |(i, above): (usize, &Option<Above>)| {
            let Some(above) = above else { return [0; 4] };
            let from = [i % self.side, i / self.side].map(|c| c as f32 + 0.5 - middle);
            let [r, g, b] = (of(above) / white).to_array().map(srgb_encode8);
            // Soft at the rim, where a pixel is only partly inside the disc.
            let inside = (middle - Vec2::from(from).length() + 0.5).clamp(0.0, 1.0);
            [r, g, b, (255.0 * inside).round() as u8]
        };
        self.pixels.iter().enumerate().map(code).collect()
    }

    fn draw(&self, canvas: &mut Canvas, [left, top]: [u32; 2], of: fn(&Above) -> Vec3) {
        let middle = 0.5 * self.side as f32;
        for (i, [r, g, b, inside]) in self.disc(of).into_iter().enumerate() {
            let part = f32::from(inside) / 255.0;
            let ground = GROUND.map(f32::from);
            let mixed = [r, g, b].map(f32::from);
            let mixed = std::array::from_fn(|c| (mixed[c] * part + ground[c] * (1.0 - part)).round() as u8);
            canvas.dot([left + (i % self.side) as u32, top + (i / self.side) as u32], mixed);
        }
        let place = |p: Vec2| [left as f32 + middle * (1.0 + p.x), top as f32 + middle * (1.0 - p.y)];
        canvas.ring(place(Vec2::ZERO), middle, 1.0, RIM);
        for point in &self.points {
            canvas.ring(place(point.place), 2.0, 3.0, YELLOW);
        }
        for (name, at, colour) in [("V", self.view, BLUE), ("R", self.mirror, VERMILION)] {
            let [x, y] = place(at);
            canvas.ring([x, y], 5.0, 4.0, [0; 3]);
            canvas.ring([x, y], 5.0, 2.0, colour);
            let corner = [(x + 8.0) as u32, (y - 9.0).max(0.0) as u32];
            for shadow in [[corner[0] + 1, corner[1] + 1], [corner[0] - 1, corner[1]]] {
                canvas.text(Lettering::Semibold, shadow, SMALL, [0; 3], name);
            }
            canvas.text(Lettering::Semibold, corner, SMALL, colour, name);
        }
    }
}

struct Canvas {
    rgb8: Vec<u8>,
    size: [u32; 2],
}

impl Canvas {
    fn dot(&mut self, [x, y]: [u32; 2], colour: [u8; 3]) {
        if let Some(pixel) = pixel(&mut self.rgb8, self.size, [x, y].map(i64::from)) {
            *pixel = colour;
        }
    }

    /// A ring with soft edges.
    fn ring(&mut self, [x, y]: [f32; 2], radius: f32, width: f32, colour: [u8; 3]) {
        let reach = radius + width + 1.0;
        let range =
            |v: f32, most: u32| ((v - reach).max(0.0) as u32)..((v + reach).max(0.0) as u32 + 1).min(most);
        for row in range(y, self.size[1]) {
            for column in range(x, self.size[0]) {
                let from = Vec2::new(column as f32 + 0.5 - x, row as f32 + 0.5 - y).length();
                let part = (0.5 * width + 0.5 - (from - radius).abs()).clamp(0.0, 1.0);
                let pixel = pixel(&mut self.rgb8, self.size, [column, row].map(i64::from));
                for (old, new) in pixel.into_iter().flatten().zip(colour) {
                    *old = (f32::from(*old) * (1.0 - part) + f32::from(new) * part).round() as u8;
                }
            }
        }
    }

    /// A bar from black to white, labelled with the values at its ends.
    fn scale(&mut self, [left, top]: [u32; 2], width: u32, white: &str) {
        for x in 0..width {
            let code = srgb_encode8(x as f32 / (width - 1).max(1) as f32);
            (0..8).for_each(|y| self.dot([left + x, top + y], [code; 3]));
        }
        self.text(Lettering::Regular, [left, top + 12], SMALL, TEXT, "0");
        let end = left + width - Lettering::Regular.width(SMALL, white).min(width);
        self.text(Lettering::Regular, [end, top + 12], SMALL, TEXT, white);
    }

    fn text(&mut self, style: Lettering, at: [u32; 2], px: f32, colour: [u8; 3], text: &str) {
        style.draw(&mut self.rgb8, self.size, at.map(|v| v as i32), px, colour, text);
    }
}
