//! Linear pictures with their layers, by the CPU renderer.

use std::sync::atomic::AtomicBool;

use super::{Drawing, Picture, Reached, Settings, Shot, Until, channel::ChannelSight, render_until};
use crate::{
    channel::{Layer, Setting, settle},
    linear::Channels,
    progress::{Cancelled, Progress},
    registry::Registry,
    scene::Scene,
};

/// Renders the numbers of a channel of geometry: x, y and z of a direction, or a distance in x. Both are 0 where no
/// object is; w is the coverage.
#[must_use]
pub fn render_numbers(scene: &Scene, registry: &Registry, settings: &Settings, setting: &Setting) -> Picture {
    let shot = Shot::new(scene, registry, settings);
    let sight = ChannelSight::new(shot, *setting);
    Drawing { sight: Some(&|draw| sight.seen(draw)), ..shot.drawing() }.light()
}

/// Renders layers of a scene one after the other. The first is a picture; the others take as many samples of lights with extent
/// as it took, which is the second result. Sets `odd` as [`render_samples`](super::render_samples) does.
///
/// # Errors
/// Returns [`Cancelled`] if the user cancels.
pub fn render_layers(
    layers: &[Layer],
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    until: Until,
    odd: &AtomicBool,
    progress: &Progress,
) -> Result<(Channels, Reached), Cancelled> {
    let mut channels = Channels::new(settings.width, settings.height);
    let mut reached = Reached { samples: 0, noise: None };
    for (i, layer) in layers.iter().enumerate() {
        let name = |step: &str| if i == 0 { step.to_owned() } else { format!("{}, {step}", layer.name) };
        let picture = progress.part((i, layers.len()), name, |progress| -> Result<_, Cancelled> {
            progress.step(0.0, "drawing")?;
            let scene = layer.scene(scene);
            if layer.is_of_geometry() {
                let settings = Settings { samples: 1, ..*settings };
                return Ok(render_numbers(&scene, registry, &settings, &layer.setting));
            }
            let until = match i {
                0 => until,
                _ if layer.is_plain() => Until { samples: 1, noise: None },
                _ => Until { samples: reached.samples, noise: None },
            };
            let settings = Settings { terms: layer.terms, ..*settings };
            let (picture, end) = render_until(&scene, registry, &settings, until, odd, progress)?;
            if i == 0 {
                reached = end;
            }
            Ok(picture)
        })?;
        channels.add(&layer.name, layer.channels, &picture.pixels);
    }
    settle(&mut channels, layers);
    Ok((channels, reached))
}
