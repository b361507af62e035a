//! Remarks on pixels whose light is not finite.

use super::views::Part;
use crate::{
    channel::{DebugChannel, Setting},
    explain::finite::{NotFinite, Scope, Tried, marked, probe, traced},
    reference::{self, Settings},
    registry::Registry,
    scene::Scene,
};

/// True if something is drawn that this crate's tests do not cover.
pub(super) fn has_untested(registry: &Registry) -> bool {
    registry.sources().edited().next().is_some() || registry.has_foreign()
}

/// The setting of the debug channel that shows such pixels.
pub(super) fn channel(scene: &Scene, registry: &Registry) -> Setting {
    Setting::new(DebugChannel::NotANumber, scene, registry, scene.observer.position, None)
}

/// The remark on a view, from its picture in that channel; `None` if all its light is finite.
pub(super) fn remark(part: &Part, registry: &Registry, rgb8: &[u8]) -> Option<String> {
    let settings = settings(part);
    let pixels = marked(rgb8, settings.width);
    if pixels.is_empty() {
        return None;
    }
    let whose = listed(&traced(&part.scene, registry, &settings, &pixels));
    let (count, are) = match pixels.len() {
        1 => ("1 pixel".to_owned(), "is"),
        n => (format!("{n} pixels"), "are"),
    };
    Some(format!(
        "{count} of {}×{} {are} not finite, and drawn black or white; --channel not_a_number shows where:{whose}",
        settings.width, settings.height,
    ))
}

/// The remark on a picture from the GPU. Drivers may assume that no number is infinite, and draw 1/0 as
/// black: in that case, the CPU tries everything that this crate's tests do not cover.
pub(super) fn remark_on_gpu(
    part: &Part,
    registry: &Registry,
    rgb8: &[u8],
    tried: &mut Tried,
) -> Option<String> {
    remark(part, registry, rgb8).or_else(|| {
        let found = probe(&part.scene, registry, Scope::Untested, tried);
        (!found.is_empty()).then(|| {
            format!(
                "the picture of the GPU is finite, but on the CPU some light is not, here or seen from elsewhere:{}",
                listed(&found)
            )
        })
    })
}

/// The remark on a picture from the CPU renderer.
pub(super) fn remark_on_cpu(part: &Part, registry: &Registry) -> Option<String> {
    let setting = channel(&part.scene, registry);
    remark(part, registry, &reference::render_channel(&part.scene, registry, &settings(part), &setting))
}

/// The remark on a scene of which no picture says where its light is not finite: of that which this crate's tests do not cover.
pub(super) fn remark_on_scene(scene: &Scene, registry: &Registry, tried: &mut Tried) -> Option<String> {
    let found =
        if has_untested(registry) { probe(scene, registry, Scope::Untested, tried) } else { Vec::new() };
    (!found.is_empty())
        .then(|| format!("some light is not finite, and drawn black or white:{}", listed(&found)))
}

fn settings(part: &Part) -> Settings {
    Settings { width: part.cell.width, height: part.cell.height, samples: 1, terms: part.terms }
}

fn listed(found: &[NotFinite]) -> String {
    found.iter().flat_map(|odd| ["\n  ".to_owned(), odd.to_string()]).collect()
}
