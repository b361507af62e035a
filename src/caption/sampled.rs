//! The sampling of a picture in words: samples of lights with extent, and their noise.

use super::Part;
use crate::scene::limits::{number, significant};

/// The rank of these parts, equal to that of the display.
const RANK: u8 = 1;

/// The sampling of a view that is lit by lights with extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled {
    /// Number of samples taken of each light; 0 without light with extent.
    pub samples: u32,
    /// Noise reached, as a fraction of the mean luminance, if known.
    pub noise: Option<f32>,
}

/// "256 samples of each light", followed by "noise 0.41 %" if the noise of all views is known; empty if no
/// view was sampled.
#[must_use]
pub fn sampled(views: &[Sampled]) -> Vec<Part> {
    let samples = || views.iter().map(|view| view.samples);
    let (Some(least), Some(most)) = (samples().min(), samples().max()) else { return Vec::new() };
    let words = if most == 1 { "sample" } else { "samples" };
    let mut parts = vec![Part::new(
        RANK,
        format!("{} {words} of each light", range([least.to_string(), most.to_string()])),
    )];
    let noise: Option<Vec<f32>> = views.iter().map(|view| view.noise).collect();
    if let Some(noise) = noise {
        let ends =
            [noise.iter().copied().fold(f32::INFINITY, f32::min), noise.into_iter().fold(0.0, f32::max)];
        parts.push(Part::new(RANK, format!("noise {} %", range(ends.map(per_cent)))).continued());
    }
    parts
}

/// "0.4", or "0.4 to 0.5".
fn range([least, most]: [String; 2]) -> String {
    if least == most { least } else { format!("{least} to {most}") }
}

/// A fraction in per cent with two significant digits: noise is itself an estimate.
fn per_cent(fraction: f32) -> String {
    let percent = 100.0 * f64::from(fraction);
    if percent < 0.01 {
        return "below 0.01".to_owned();
    }
    number(significant(percent, 2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caption::Ground;
    use crate::caption::{Caption, line};

    fn said(views: &[(u32, Option<f32>)]) -> String {
        let views: Vec<_> =
            views.iter().map(|(samples, noise)| Sampled { samples: *samples, noise: *noise }).collect();
        line(&sampled(&views))
    }

    #[test]
    fn samples_and_noise_are_said_as_reached() {
        assert_eq!(said(&[]), "");
        assert_eq!(said(&[(256, Some(0.004_06))]), "256 samples of each light, noise 0.41 %");
        assert_eq!(said(&[(1, None)]), "1 sample of each light");
        assert_eq!(said(&[(64, Some(0.123)), (64, Some(0.123))]), "64 samples of each light, noise 12 %");
        assert_eq!(
            said(&[(96, Some(0.0095)), (1024, Some(0.01))]),
            "96 to 1024 samples of each light, noise 0.95 to 1 %"
        );
        // The noise of one view alone would be mistaken for that of all.
        assert_eq!(said(&[(16, None), (64, Some(0.1))]), "16 to 64 samples of each light");
        assert_eq!(said(&[(256, Some(0.0))]), "256 samples of each light, noise below 0.01 %");
    }

    #[test]
    fn they_stand_before_what_each_view_has_of_its_own() {
        let facts = ["Phong", "A:", "α 20", "B:", "α 80"].map(|text| Part::new(0, text)).to_vec();
        let caption = Caption { title: String::new(), facts, program: "", ground: Ground::DARK };
        let views = [Sampled { samples: 256, noise: None }; 2];
        let told = line(&caption.clone().resting_on(&views).facts);
        assert_eq!(told, "Phong · 256 samples of each light · A: α 20 · B: α 80");
        assert_eq!(caption.clone().resting_on(&[]), caption);
    }
}
