//! Highlights: their widths at half maximum, in the plane of incidence.

use glam::Vec3;

use super::{
    search::{Given, Target},
    sides::{Pair, Side},
};
use crate::{
    optics::{Frame, colour::luminance, geometry::direction},
    reflection::Surface,
    registry::Registry,
};

/// Angles of the light from the normal, in degrees.
const ANGLES: [f64; 4] = [0.0, 20.0, 40.0, 60.0];
/// Planes of incidence: along the tangent, and for anisotropic surfaces also across it, in degrees.
const AZIMUTHS: [f64; 2] = [0.0, 90.0];
/// Largest angle of the viewer, in degrees.
const HORIZON: f64 = 89.9;
/// Number of viewers tried on each side of the mirror direction.
const TRIED: i32 = 60;
/// Brightness below which a highlight does not count.
const DARK: f32 = 1e-6;

/// The plane of incidence, and the angle of the light from the normal, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Light {
    azimuth: f64,
    angle: f64,
}

/// The specular term towards a viewer at an angle from the normal, positive on the side of the mirror direction.
fn specular(surface: &dyn Surface, light: Light, viewer: f64) -> f32 {
    let behind = light.azimuth + 180.0;
    let l = direction(light.angle, behind);
    let v = direction(viewer.abs(), if viewer < 0.0 { behind } else { light.azimuth });
    luminance(surface.response(l, v, &Frame::LOCAL).specular.max(Vec3::ZERO))
}

/// The angles, in degrees, from the peak of the highlight to half its height, towards the normal and away
/// from it; an inner `None` if it does not fall that far above the surface. `None` without a highlight.
fn half_widths(surface: &dyn Surface, light: Light) -> Option<[Option<f64>; 2]> {
    peak_and_sides(surface, light).map(|(_, sides)| sides)
}

/// The angle of the viewer at the peak, and the half widths.
fn peak_and_sides(surface: &dyn Surface, light: Light) -> Option<(f64, [Option<f64>; 2])> {
    // Dense around the mirror direction.
    let offset = |i: i32| 90.0 * f64::from(i.signum()) * (f64::from(i) / f64::from(TRIED)).powi(2);
    let inside = |viewer: &f64| viewer.abs() <= HORIZON;
    let tried: Vec<(f64, f32)> = (-2 * TRIED..=2 * TRIED)
        .map(|i| light.angle + offset(i))
        .filter(inside)
        .map(|viewer| (viewer, specular(surface, light, viewer)))
        .collect();
    let peak = (0..tried.len()).max_by(|i, j| tried[*i].1.total_cmp(&tried[*j].1))?;
    let (at, height) = tried[peak];
    if height <= DARK {
        return None;
    }
    let side = |all: &mut dyn Iterator<Item = &(f64, f32)>| {
        let mut last = at;
        for &(viewer, value) in all {
            if value < 0.5 * height {
                let (mut bright, mut dark) = (last, viewer);
                for _ in 0..40 {
                    let middle = 0.5 * (bright + dark);
                    if specular(surface, light, middle) < 0.5 * height {
                        dark = middle;
                    } else {
                        bright = middle;
                    }
                }
                return Some((0.5 * (bright + dark) - at).abs());
            }
            last = viewer;
        }
        None
    };
    Some((at, [side(&mut tried[..peak].iter().rev()), side(&mut tried[peak..].iter())]))
}

/// The full width of the specular term at half maximum, in degrees, over the angle of the viewer in the plane
/// of incidence along the tangent, for light at this angle from the normal. A side on which the term does not
/// fall to a half ends at the horizon. `None` without a highlight.
#[must_use]
pub fn highlight_width(surface: &dyn Surface, light: f64) -> Option<f64> {
    let light = Light { azimuth: 0.0, angle: light };
    let (at, sides) = peak_and_sides(surface, light)?;
    let horizons = [HORIZON + at, HORIZON - at];
    Some(sides.iter().zip(horizons).map(|(side, horizon)| side.unwrap_or(horizon)).sum())
}

/// The highlights of the objects' materials.
pub(super) struct Highlight {
    /// Each with the angle of the light, the side, and the wanted width.
    widths: Vec<(Pair, Vec<(Light, usize, f64)>)>,
}

impl Highlight {
    /// The highlights of the visible objects, or the index of the view without any.
    pub(super) fn new([a, b]: [&Side; 2], registry: &Registry) -> Result<Self, usize> {
        let mut widths = Vec::new();
        for pair in Pair::all([a, b], registry) {
            let azimuths = &AZIMUTHS[..if pair.anisotropic { 2 } else { 1 }];
            let lights: Vec<_> = azimuths
                .iter()
                .flat_map(|azimuth| ANGLES.map(|angle| Light { azimuth: *azimuth, angle }))
                .collect();
            let of = |light: &Light| {
                let light = *light;
                let both = half_widths(&*pair.wanted, light).unwrap_or_default();
                (0..2).filter_map(move |side| Some((light, side, both[side]?)))
            };
            let wanted: Vec<_> = lights.iter().flat_map(of).collect();
            if wanted.is_empty() {
                continue;
            }
            let own = pair.with(&Given::new());
            if lights.iter().all(|light| half_widths(&*own, *light).is_none()) {
                return Err(1);
            }
            widths.push((pair, wanted));
        }
        if widths.is_empty() { Err(0) } else { Ok(Self { widths }) }
    }
}

impl Target for Highlight {
    fn count(&self) -> usize {
        self.widths.iter().map(|(_, wanted)| wanted.len()).sum()
    }

    /// The logarithms of the ratios of widths.
    fn differences(&mut self, values: &Given, to: &mut [f64]) {
        let mut to = to.iter_mut();
        for (pair, wanted) in &self.widths {
            let surface = pair.with(values);
            let mut last = None;
            for (light, side, width) in wanted {
                let widths = match last {
                    Some((of, widths)) if of == *light => widths,
                    _ => half_widths(&*surface, *light),
                };
                last = Some((*light, widths));
                // A highlight that extends beyond the horizon, or is missing, counts as the widest possible.
                let found = widths.and_then(|both| both[*side]).unwrap_or(90.0);
                to.by_ref().take(1).for_each(|to| *to = (found / width).ln());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::colour::Encoding,
        parameter::{Value, Values},
    };

    #[test]
    fn the_width_of_a_highlight_is_that_of_its_formula() {
        let registry = Registry::builtin();
        let of = |id: &str, alpha: i64, angle: f64| {
            let mut values = Values::default();
            values.set("alpha", Value::Integer(alpha));
            let model = registry.model(id).expect("built in");
            half_widths(&*model.instantiate(&values, Encoding::Srgb), Light { azimuth: 0.0, angle })
        };
        for alpha in [8, 50, 500] {
            // cos^α = 1/2, about the mirror direction, and about the normal for the half vector: twice as far
            // for the viewer.
            let angle = 0.5f64.powf(1.0 / alpha as f64).acos().to_degrees();
            for light in [0.0, 20.0] {
                for (id, expected) in [("phong", angle), ("blinn_phong", 2.0 * angle)] {
                    for side in of(id, alpha, light).expect("it has one") {
                        let Some(found) = side else { continue };
                        assert!((found / expected - 1.0).abs() < 0.01, "{id} {alpha} {light}: {found}");
                    }
                }
            }
        }
        assert_eq!(of("phong", 0, 0.0), Some([None, None]), "it is bright everywhere");
        assert_eq!(of("lambert", 0, 0.0), None);
    }

    #[test]
    fn the_full_width_is_that_of_both_sides_and_ends_at_the_horizon() {
        let registry = Registry::builtin();
        let of = |id: &str, alpha: i64| {
            let mut values = Values::default();
            values.set("alpha", Value::Integer(alpha));
            let surface = registry.model(id).expect("built in").instantiate(&values, Encoding::Srgb);
            highlight_width(&*surface, 30.0)
        };
        // cos^α = 1/2 on both sides of the mirror direction.
        let expected = 2.0 * 0.5f64.powf(0.01).acos().to_degrees();
        let found = of("phong", 100).expect("it has one");
        assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
        assert_eq!(of("phong", 0).map(f64::round), Some(180.0), "it is bright everywhere");
        assert_eq!(of("lambert", 0), None);
    }
}
