//! Fixed colours of debug channels; data colours of M. Okabe, K. Ito (2008), *Color Universal Design*.

use glam::Vec3;

/// Negative cosine: grey, a colour that viridis does not contain.
pub const BELOW: [u8; 3] = [120; 3];
/// Light that is not a number.
pub const NAN: [u8; 3] = [255, 0, 200];
/// Infinite light.
pub const INFINITE: [u8; 3] = [240, 228, 66];
/// Light below 0.
pub const NEGATIVE: [u8; 3] = [86, 180, 233];
/// A normal that faces the observer.
pub const TOWARDS: [u8; 3] = [86, 180, 233];
/// A normal that faces away from the observer.
pub const AWAY: [u8; 3] = [213, 94, 0];
/// The colour of stripes on clipped values; the others are black.
pub const CLIPPED: [u8; 3] = [240, 228, 66];

/// The colour of polygon edges.
pub const EDGE: [u8; 3] = [240; 3];

/// A colour as display codes from 0 to 1.
#[must_use]
pub fn codes(colour: [u8; 3]) -> Vec3 {
    Vec3::from(colour.map(f32::from)) / 255.0
}
