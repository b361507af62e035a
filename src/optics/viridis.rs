//! Viridis: colours for numbers, from dark to bright.

use glam::Vec3;

/// Equidistant colours of viridis: S. van der Walt, N. Smith (2015), *mpl-colormaps*, CC0. Lightness
/// increases evenly, also in greyscale and with every kind of colour vision.
pub const VIRIDIS: [[u8; 3]; 33] = {
    let text = include_bytes!("viridis.csv");
    let mut all = [[0; 3]; 33];
    let (mut at, mut number) = (0, 0);
    while at < text.len() {
        match text[at] {
            digit @ b'0'..=b'9' => {
                all[number / 3][number % 3] = 10 * all[number / 3][number % 3] + (digit - b'0');
            }
            _ => number += 1,
        }
        at += 1;
    }
    all
};

/// The colour at a position from 0 to 1, as display codes from 0 to 1; positions beyond are clamped.
#[must_use]
pub fn viridis(place: f32) -> Vec3 {
    let at = place.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f32;
    let first = (at as usize).min(VIRIDIS.len() - 2);
    let [from, to] = [first, first + 1].map(|i| Vec3::from(VIRIDIS[i].map(f32::from)) / 255.0);
    from.lerp(to, at - first as f32)
}
