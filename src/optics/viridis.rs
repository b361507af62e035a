//! Viridis: colours for numbers, from dark to bright.

use glam::Vec3;

/// Equidistant colours of viridis: S. van der Walt, N. Smith (2015), *mpl-colormaps*, CC0. Lightness
/// increases evenly, also in greyscale and with every kind of colour vision.
pub const VIRIDIS: [[u8; 3]; 33] = [
    [68, 1, 84],
    [71, 13, 96],
    [72, 24, 106],
    [72, 35, 116],
    [71, 45, 123],
    [69, 54, 129],
    [66, 64, 134],
    [63, 73, 137],
    [59, 82, 139],
    [55, 90, 141],
    [51, 99, 141],
    [47, 106, 142],
    [44, 114, 142],
    [41, 122, 142],
    [38, 129, 142],
    [35, 137, 142],
    [33, 144, 140],
    [31, 152, 139],
    [31, 159, 136],
    [33, 166, 133],
    [40, 174, 128],
    [49, 181, 123],
    [62, 188, 116],
    [76, 194, 108],
    [93, 201, 99],
    [110, 206, 88],
    [130, 211, 76],
    [150, 216, 63],
    [171, 220, 50],
    [192, 223, 36],
    [213, 226, 26],
    [234, 229, 26],
    [253, 231, 37],
];

/// The colour at a position from 0 to 1, as display codes from 0 to 1; positions beyond are clamped.
#[must_use]
pub fn viridis(place: f32) -> Vec3 {
    let at = place.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f32;
    let first = (at as usize).min(VIRIDIS.len() - 2);
    let [from, to] = [first, first + 1].map(|i| Vec3::from(VIRIDIS[i].map(f32::from)) / 255.0);
    from.lerp(to, at - first as f32)
}
