//! The entry points of an exported shader: the twins of `assets/shaders/wrapper.wgsl` for one object at a time.

use super::{Host, Lights};
use crate::{
    optics::{colour::Encoding, tone::ToneMapping},
    reflection::Passage,
    text::template::{chosen, filled},
};

/// The text before everything else.
pub(super) fn prelude(host: Host) -> &'static str {
    match host {
        Host::Alone { .. } => "",
        Host::Bevy { .. } => include_str!("imports.wgsl"),
    }
}

/// The bind group of the material and the lights.
pub(super) fn group(host: Host) -> &'static str {
    match host {
        Host::Alone { .. } => "0",
        Host::Bevy { .. } => "#{MATERIAL_BIND_GROUP}",
    }
}

/// The entry points and the bindings used only by them; with `faces`, vertices contain data of their polygon.
/// With samples, pixels have a seed, and bodies know their place.
pub(super) fn text(host: Host, faces: bool, lights: &Lights, passage: Passage) -> String {
    let (name, tone, exposure) = match host {
        Host::Alone { tone, .. } => ("alone", format!("tone_{}", tone.id()), 1.0),
        Host::Bevy { exposure, .. } => ("bevy", String::new(), exposure),
    };
    // From light to the colour of the pixel.
    let display = match host {
        Host::Alone { tone: ToneMapping::None, encoding: Encoding::Off } => "clip",
        Host::Alone { encoding: Encoding::Off, .. } => "decode",
        Host::Alone { encoding: Encoding::Srgb, .. } => "map",
        Host::Bevy { encoding: Encoding::Srgb, .. } => "light",
        Host::Bevy { encoding: Encoding::Off, .. } => "undo",
    };
    let wanted = |part: &str| match part {
        "faces" => faces,
        "samples" => lights.has_extent() || passage.solid,
        "place" => passage.solid && name == "alone",
        "instance" => passage.solid && name == "bevy",
        part => part == name || part == display,
    };
    let text = chosen(include_str!("wrapper.wgsl"), wanted);
    filled(&text, &[("tone", &tone), ("exposure", &format!("{exposure:?}"))])
}
