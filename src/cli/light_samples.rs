//! The options of commands that sample lights with extent.

use clap::Args;

use crate::{
    picture::png::About,
    reference::{Reached, Until},
    registry::Registry,
    scene::Scene,
};

/// Maximum number of samples of lights with extent.
const MOST: u32 = 1 << 20;

/// Maximum number of samples on the GPU unless noise ends them: some pictures take all in each frame.
const MOST_ON_GPU: u32 = 4096;

/// Default maximum number of samples if the noise decides.
const MOST_FOR_NOISE: u32 = 1 << 16;

/// The samples of lights with extent, as given on the command line.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(super) struct Sampling {
    /// Samples of each light with extent, and as many of the directions in which objects reflect most: 1 to 1048576, on the GPU
    /// to 4096 without --noise; by default 256, with --noise 65536
    #[arg(long, value_name = "N", value_parser = count, allow_hyphen_values = true)]
    light_samples: Option<u32>,
    /// Take samples of lights with extent until the noise is this low: the standard error of pixels over their mean luminance, in
    /// per cent, e.g. 1 or 0.5%
    #[arg(long, value_name = "PERCENT", value_parser = noise, allow_hyphen_values = true)]
    noise: Option<f32>,
}

impl Sampling {
    /// This many samples, if given.
    pub(super) fn of(light_samples: Option<u32>) -> Self {
        Self { light_samples, noise: None }
    }

    /// The termination conditions of sampling.
    pub(super) fn until(self) -> Until {
        let default = if self.noise.is_some() { MOST_FOR_NOISE } else { Until::default().samples };
        Until { samples: self.light_samples.unwrap_or(default), noise: self.noise }
    }

    /// The reason why the GPU renderer cannot take these samples for a picture, which is linear or for display.
    pub(super) fn fits_gpu(self, linear: bool) -> Result<(), String> {
        if self.noise.is_some() && linear {
            let way = "use --light-samples, or --renderer cpu";
            return Err(format!(
                "--noise cannot be used with --renderer gpu for linear pictures, whose noise it does not measure; {way}"
            ));
        }
        match self.light_samples {
            Some(many) if many > MOST_ON_GPU && self.noise.is_none() => Err(format!(
                "--light-samples is {many}, but with --renderer gpu it must be at most {MOST_ON_GPU}; use --renderer cpu"
            )),
            _ => Ok(()),
        }
    }

    /// The given options, for messages.
    pub(super) fn given(self) -> Option<&'static str> {
        match (self.light_samples, self.noise) {
            (None, None) => None,
            (Some(_), None) => Some("--light-samples"),
            (None, Some(_)) => Some("--noise"),
            (Some(_), Some(_)) => Some("--light-samples and --noise"),
        }
    }

    /// The options that are given and change nothing, in words.
    fn nothing(self) -> Option<String> {
        let verb = if self.light_samples.is_some() && self.noise.is_some() { "change" } else { "changes" };
        Some(format!("{} {verb} nothing", self.given()?))
    }

    /// A remark on options that change nothing in a scene.
    pub(super) fn idle(self, scene: &Scene, registry: &Registry) -> Option<String> {
        let nothing = self.nothing().filter(|_| !scene.rests_on_samples(registry))?;
        Some(format!("no light has extent and no body is rough, so the picture has no noise, and {nothing}"))
    }

    /// A remark on options that change nothing, as pictures are compared as they are.
    pub(super) fn idle_for_pictures(self) -> Option<String> {
        self.nothing().map(|nothing| format!("both files are pictures, already rendered: {nothing}"))
    }

    /// A remark on a picture that is, or may be, noisier than requested.
    pub(super) fn remark(self, Reached { samples, noise }: Reached) -> Option<String> {
        let wanted = self.noise?;
        match noise {
            Some(noise) if noise > wanted => Some(format!(
                "after {samples} samples the noise is {:.2} %; more --light-samples lower it",
                100.0 * noise
            )),
            Some(_) => None,
            None => Some(format!(
                "the noise is not known with fewer than {} --light-samples, so --noise changes nothing",
                Until::FEWEST_FOR_NOISE
            )),
        }
    }
}

/// The metadata of a picture, with a description of the light that it rests on, if there is one.
pub(super) fn noted(about: About, light: &str) -> About {
    if light.is_empty() { about } else { about.with("Light", light) }
}

/// Parser of a number of samples.
pub(super) fn count(text: &str) -> Result<u32, String> {
    text.trim()
        .parse()
        .ok()
        .filter(|n| (1..=MOST).contains(n))
        .ok_or_else(|| format!("it must be a whole number from 1 to {MOST}, e.g. 1000"))
}

/// Noise as a fraction, from per cent.
fn noise(text: &str) -> Result<f32, String> {
    let text = text.trim();
    let number = text.strip_suffix('%').unwrap_or(text).trim_end();
    number
        .parse()
        .ok()
        .filter(|percent: &f32| (0.01..=100.0).contains(percent))
        .map(|percent| percent / 100.0)
        .ok_or_else(|| "it must be a percentage from 0.01 to 100, e.g. 1 or 0.5%".to_owned())
}
