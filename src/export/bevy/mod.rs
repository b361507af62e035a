//! The form `bevy`: a Cargo project with one `main.rs`, the shaders and the meshes of the scene.
//!
//! `program` writes `main.rs`, `words` converts values and names to Rust, `bodies` has the meshes that light is followed
//! through.

use self::bodies::Bodies;
use super::{
    Export, ExportError, File, Form, Makes, Progress, Request, lit::Lit, shader::Host, view::without_labels,
};
use crate::{
    optics::tone::{ToneMapping, exposure_factor},
    text::template::filled,
};

mod bodies;
mod program;
mod words;

/// The form.
pub const BEVY: Form = Form {
    id: "bevy",
    name: "Bevy project",
    summary: "a Cargo project with one readable main.rs and the WGSL in use; cargo run opens a window",
    makes: Makes::Folder,
    of_object: false,
    of_view: true,
    make,
};

/// `Cargo.toml`, with the Bevy features that the project needs. Sound, gamepads and Wayland would need system packages to
/// build; with X11 alone the window also opens on Wayland, through XWayland.
const MANIFEST: &str = include_str!("template/Cargo.toml.txt");

fn make(request: &Request, progress: &Progress) -> Result<Export, ExportError> {
    progress.step(0.0, "composing the shaders")?;
    let display = request.scene.display;
    let host = Host::Bevy { exposure: exposure_factor(display.exposure), encoding: display.encoding };
    let lit = Lit::of(*request, host, |_| true)?;
    if lit.objects.is_empty() {
        return Err(ExportError::refused("every object is hidden; make one visible"));
    }
    if lit.programs.iter().any(|program| program.shader.reads_header) {
        return Err(ExportError::refused(
            "the edited loop.wgsl reads the exposure or the encoding, which the light loop of an export does not have",
        ));
    }
    let bodies = Bodies::of(&lit)?;
    progress.step(0.5, "writing the program")?;
    let name = words::package(request.stem);
    let manifest = filled(MANIFEST, &[("name", &name)]);
    let mut files = vec![
        File::new("Cargo.toml", manifest),
        File::new("src/main.rs", program::text(&lit, &bodies, &name)),
    ];
    for program in &lit.programs {
        let path = format!("assets/shaders/{}.wgsl", program.name());
        files.push(File::new(path, program.shader.text.as_str()));
    }
    progress.step(0.8, "packing the meshes")?;
    for mesh in &lit.meshes {
        let counts = [mesh.vertices() as u32, mesh.attributes.len() as u32];
        let mut bytes: Vec<u8> = counts.into_iter().flat_map(u32::to_le_bytes).collect();
        bytes.extend(mesh.interleaved());
        bytes.extend(mesh.indices.iter().flat_map(|i| i.to_le_bytes()));
        files.push(File::new(format!("assets/meshes/{}.bin", mesh.name), bytes));
    }
    for (name, bytes) in bodies.all {
        files.push(File::new(format!("assets/meshes/{name}_body.bin"), bytes));
    }
    let mut notes = lit.notes();
    notes.extend(bodies.notes);
    notes.extend(without_labels(request.scene));
    if display.backdrop().is_some() && display.tone_mapping != ToneMapping::None {
        let tone = display.tone_mapping.id();
        notes.push(format!(
            "Bevy maps the background as well: with the tone mapping {tone} its colours are not quite those of the scene."
        ));
    }
    Ok(Export { files, notes })
}
