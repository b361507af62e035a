//! Views drawn by the CPU renderer: with their codes alone, as a debug channel, or with their light, as a picture needs it.

use std::{borrow::Cow, sync::atomic::AtomicBool};

use thiserror::Error;

use super::Shown;
use crate::{
    channel::Setting,
    linear::MAX_PIXELS,
    progress::{Cancelled, Progress},
    reference::{
        LightSamples, Reached, Settings, Until, render_channel_by, render_rgb8_noting, render_until,
    },
    registry::Registry,
    scene::Scene,
};

/// A view to draw.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The scene of the view.
    pub scene: &'a Scene,
    /// The known models and types.
    pub registry: &'a Registry,
    /// The size and the terms.
    pub settings: Settings,
    /// The debug channel that it shows instead of the picture.
    pub channel: Option<Setting>,
    /// The samples of lights with extent.
    pub until: Until,
    /// True if its light and its coverage are needed as well.
    pub lit: bool,
}

/// Why a view was not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Undrawn {
    /// The user cancelled.
    #[error("cancelled")]
    Cancelled,
    /// The light of the view does not fit into memory.
    #[error(
        "{}×{} are too many pixels for a view whose light is calculated, as that of lights with extent and of comparisons: \
         at most {} are possible", .0[0], .0[1], MAX_PIXELS
    )]
    TooLarge([u32; 2]),
    /// The system does not give so much memory, MiB; without it, the process would end.
    #[error("{}×{} pixels need {} MiB of memory, which are not free; choose a smaller size", .0[0], .0[1], .1)]
    NoRoom([u32; 2], usize),
}

/// Bytes for each pixel of display codes, and of a picture whose light is calculated.
const CODES: usize = 3;
const LIGHT: usize = 40;
/// Bytes beside the pixels, at most: parts of the picture at work, and the file.
const BESIDE: usize = 256 << 20;

impl Undrawn {
    /// Finds out whether there is memory for a picture with its light, and more bytes for each of its pixels.
    ///
    /// # Errors
    /// Returns [`NoRoom`](Self::NoRoom) if not.
    pub fn check_light(size: [u32; 2], more: usize) -> Result<(), Self> {
        Self::check_room(size, LIGHT + more)
    }

    fn check_room(size: [u32; 2], each: usize) -> Result<(), Self> {
        let [width, height] = size.map(|side| side as usize);
        let pixels = width.saturating_mul(height).saturating_mul(each);
        let bytes = pixels.saturating_add(pixels.min(BESIDE));
        // Memory that is not written to is not taken.
        let mut room = Vec::<u8>::new();
        let reserved = room.try_reserve_exact(bytes);
        // The compiler must not leave out what is never used.
        std::hint::black_box(&room);
        reserved.map_err(|_| Self::NoRoom(size, bytes.div_ceil(1 << 20)))
    }
}

impl From<Cancelled> for Undrawn {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl View<'_> {
    /// Draws the view. Returns also how lights with extent were sampled, if it shows their light. Sets `odd` if light was
    /// not finite; channels do not notice.
    ///
    /// Display codes alone take 3 bytes of memory for each pixel, light up to 40, so that there is a limit.
    ///
    /// # Errors
    /// Returns an error if the user cancels, if the view is too large, or if there is no memory for it.
    pub fn draw(&self, odd: &AtomicBool, progress: &Progress) -> Result<(Shown, Option<Reached>), Undrawn> {
        let Self { registry, settings, until, .. } = *self;
        let (scene, channel) = self.shown();
        let Settings { width, height, .. } = settings;
        let converged = || {
            let fits = width as usize * height as usize <= MAX_PIXELS;
            let fits = fits.then_some(()).ok_or(Undrawn::TooLarge([width, height]));
            let fits = fits.and_then(|()| Undrawn::check_room([width, height], LIGHT));
            fits.and_then(|()| Ok(render_until(&scene, registry, &settings, until, odd, progress)?))
        };
        let converges =
            channel.is_none_or(|own| own.channel.rests_on_samples()) && scene.rests_on_samples(registry);
        if let Some(setting) = channel {
            // A channel is not a mean of others, so it takes all samples at once: as many as the picture takes, or may take.
            let reached = match until {
                _ if !converges => None,
                Until { noise: Some(_), .. } => Some(converged()?.1),
                Until { samples, noise: None } => Some(Reached { samples, noise: None }),
            };
            let samples =
                reached.map_or_else(LightSamples::default, |reached| LightSamples::of(reached.samples));
            Undrawn::check_room([width, height], CODES)?;
            let rgb8 = render_channel_by(&scene, registry, &settings, &setting, samples);
            return Ok((Shown::with_codes([width, height], rgb8), reached));
        }
        if self.lit || converges {
            let (light, reached) = converged()?;
            let reached = Some(reached).filter(|reached| reached.samples > 0);
            return Ok((Shown::of_light(light, &scene.display), reached));
        }
        Undrawn::check_room([width, height], CODES)?;
        let rgb8 = render_rgb8_noting(&scene, registry, &settings, odd);
        Ok((Shown::with_codes([width, height], rgb8), None))
    }

    /// The scene that is drawn, and its channel, unless that is a picture like any other.
    fn shown(&self) -> (Cow<'_, Scene>, Option<Setting>) {
        match self.channel {
            Some(setting) if setting.channel.is_picture() => (Cow::Owned(setting.lit(self.scene)), None),
            channel => (Cow::Borrowed(self.scene), channel),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{channel::DebugChannel, optics::TermSelection, reference, scene::Light};

    const SMALL: Settings = Settings { width: 48, height: 32, samples: 1, terms: TermSelection::All };

    fn lamp(registry: &Registry) -> Scene {
        let mut scene = Scene::default();
        let mut light = Light { position: Some(Vec3::new(7.0, 8.0, 7.0)), ..scene.lights[0].clone() };
        light.set_type(registry.light("rectangle").expect("built in"), registry, scene.scene_size);
        scene.lights = vec![light];
        scene
    }

    #[test]
    fn a_view_is_drawn_as_its_picture_needs_it() {
        let registry = Registry::builtin();
        let (plain, lamp) = (Scene::default(), lamp(&registry));
        let until = Until { samples: 16, noise: None };
        let view =
            View { scene: &plain, registry: &registry, settings: SMALL, channel: None, until, lit: false };
        let drawn = |view: View| view.draw(&AtomicBool::default(), &Progress::NONE).expect("drawn");
        let codes = reference::render_rgb8(&plain, &registry, &SMALL);
        let (shown, reached) = drawn(view);
        assert!(shown.rgb8() == codes && shown.light().is_none() && reached.is_none());
        let (shown, reached) = drawn(View { lit: true, ..view });
        assert!(shown.rgb8() == codes && shown.light().is_some() && reached.is_none());
        let view = View { scene: &lamp, ..view };
        let (shown, reached) = drawn(view);
        assert_eq!(reached.map(|reached| reached.samples), Some(16));
        assert!(shown.light().is_some(), "it converges");
        // Channels of light rest on as many samples, and those of geometry on none.
        for channel in DebugChannel::ALL {
            let setting = Setting::new(channel, &lamp, &registry, lamp.observer.position, None);
            let (shown, reached) = drawn(View { channel: Some(setting), ..view });
            assert_eq!(reached.is_some(), channel.rests_on_samples(), "{}", channel.id());
            if !channel.is_picture() {
                let samples = reached.map_or_else(LightSamples::default, |_| LightSamples::of(16));
                let expected = render_channel_by(&lamp, &registry, &SMALL, &setting, samples);
                assert!(shown.rgb8() == expected, "{}", channel.id());
            }
        }
    }

    #[test]
    fn light_that_would_not_fit_into_memory_is_refused_before_it_is_drawn() {
        let (registry, scene) = (Registry::builtin(), Scene::default());
        let settings = Settings { width: 16_384, height: 16_384, ..SMALL };
        let view = View {
            scene: &scene,
            registry: &registry,
            settings,
            channel: None,
            until: Until::default(),
            lit: true,
        };
        let said = view.draw(&AtomicBool::default(), &Progress::NONE).expect_err("10 GiB");
        assert!(said.to_string().starts_with("16384×16384 are too many pixels"), "{said}");
        let endless = Undrawn::check_light([u32::MAX; 2], 0).expect_err("more than there is").to_string();
        assert!(endless.contains("MiB of memory, which are not free; choose a smaller size"), "{endless}");
        assert_eq!(Undrawn::check_light([48, 32], 100), Ok(()));
        let cancelled = Progress { tell: &|_, _| (), cancelled: &|| true };
        let lamp = lamp(&registry);
        let view = View { scene: &lamp, settings: SMALL, ..view };
        assert_eq!(view.draw(&AtomicBool::default(), &cancelled), Err(Undrawn::Cancelled));
    }
}
