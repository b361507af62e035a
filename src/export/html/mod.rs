//! The form `html`: a page that shows the scene in a browser, in a single self-contained file.
//!
//! The page draws with WebGPU and the scene's own WGSL, or with WebGL 2 and the WGSL translated to GLSL. The
//! texts of the page are `page.html`, `page.css` and `js/`; this module inserts the scene.

use std::{cmp::Reverse, io::Write as _};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use flate2::{Compression, write::ZlibEncoder};
use serde_json::Value as Json;

use self::equation::escaped;
use super::{Export, ExportError, Form, Makes, Progress, Request};
use crate::text::template::filled;

mod blocks;
mod data;
mod equation;
mod explained;
mod limits;
mod mesh;
mod programs;
mod texts;

/// A page for browsers.
pub const HTML: Form = Form {
    id: "html",
    name: "Web page",
    summary: "a page that shows the scene in a browser, with its knobs, in one file for students to open",
    makes: Makes::File("html"),
    of_object: false,
    of_view: false,
    make,
};

/// Maximum size of a page, in bytes: it is sent by mail, and opened on a phone.
pub const LIMIT: usize = 300_000;

/// The page, with placeholders for the scene.
const PAGE: &str = include_str!("page.html");
/// The style sheet of the page.
const STYLE: &str = include_str!("page.css");
/// The scripts of the page; each uses those before it.
const SCRIPT: &[&str] = &[
    include_str!("js/unpack.js"),
    include_str!("js/vector.js"),
    include_str!("js/mesh.js"),
    include_str!("js/hierarchy.js"),
    include_str!("js/camera.js"),
    include_str!("js/uniform.js"),
    include_str!("js/scene.js"),
    include_str!("js/curve.js"),
    include_str!("js/interior.js"),
    include_str!("js/work.js"),
    include_str!("js/webgpu.js"),
    include_str!("js/webgl.js"),
    include_str!("js/gestures.js"),
    include_str!("js/pick.js"),
    include_str!("js/knob.js"),
    include_str!("js/panel.js"),
    include_str!("js/main.js"),
];
/// The end of the script, after the curves of the models.
const START: &str = "start();\n";

fn make(request: &Request, progress: &Progress) -> Result<Export, ExportError> {
    let data = data::data(request, progress)?;
    progress.step(0.9, "writing the page")?;
    let name = request.scene.name.as_deref().unwrap_or(request.stem);
    let description = request.scene.description.as_deref().unwrap_or_default();
    let (scene, meshes) = (packed(data.scene.to_string().as_bytes())?, packed(&data.meshes)?);
    let explained = explained::parts(&data.points)?;
    let [own, curves] = [&SCRIPT.concat(), &data.script].map(|script| compact(script));
    let script = [&*own, explained.script, &curves, START].concat();
    let page = filled(
        PAGE,
        &[
            ("name", &escaped(name)),
            ("description", &escaped(description)),
            ("style", &[STYLE, explained.style].concat()),
            ("section", &explained.section),
            ("script", &script),
            ("scene", &scene),
            ("meshes", &meshes),
            ("explained", &explained.data),
        ],
    );
    if page.len() > LIMIT {
        let names = scene.len().saturating_sub(packed(nameless(data.scene).to_string().as_bytes())?.len());
        let words = 3 * escaped(name).len() + escaped(description).len();
        let values = scene.len() - names + explained.data.len();
        let several = !request.scene.variants.is_empty();
        let sizes = [meshes.len(), values, words, names];
        return Err(ExportError::refused(too_large(page.len(), sizes, several)));
    }
    Ok(Export { notes: data.notes, ..Export::file(page) })
}

/// A script without the lines that are comments, which would take a tenth of the scripts' room, and indented half as far.
fn compact(script: &str) -> String {
    let lines = script.split_inclusive('\n').filter(|line| !line.trim_start().starts_with("//"));
    lines.map(|line| &line[(line.len() - line.trim_start_matches(' ').len()).div_ceil(2)..]).collect()
}

/// The scene without the names of its objects and views, which may be of any length.
fn nameless(mut scene: Json) -> Json {
    for view in scene["views"].as_array_mut().into_iter().flatten() {
        view["name"] = Json::Null;
        for object in view["objects"].as_array_mut().into_iter().flatten() {
            object["name"] = Json::Null;
        }
    }
    scene
}

/// The size of a page, those of its meshes, of its shaders and values, of the scene's name and description, and of the
/// other names, the largest first, and what makes that one smaller.
fn too_large(page: usize, [meshes, values, words, names]: [usize; 4], several_views: bool) -> String {
    let drawn = if several_views {
        "one view alone (--view A), or lower tessellations, make it smaller"
    } else {
        "lower tessellations, or fewer different reflection models, make it smaller"
    };
    let mut parts = [
        (meshes, "meshes", drawn),
        (values, "shaders and values", drawn),
        (
            words,
            "the name and the description of the scene",
            "a shorter name or description makes it smaller",
        ),
        (names, "the names of objects and views", "shorter names make it smaller"),
    ];
    parts.sort_by_key(|part| Reverse(part.0));
    let kb = |bytes: usize| bytes.div_ceil(1000);
    let [(largest, what, remedy), others @ ..] = parts;
    let others = others.map(|(bytes, what, _)| format!("{} kB {what}", kb(bytes))).join(", ");
    let (page, most, largest) = (kb(page), kb(LIMIT), kb(largest));
    format!(
        "the page would have {page} kB, and {most} kB is the limit: {largest} kB are {what}, {others}; {remedy}"
    )
}

/// Bytes as text, compressed in zlib format.
fn packed(bytes: &[u8]) -> Result<String, ExportError> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    let compressed = encoder.write_all(bytes).and_then(|()| encoder.finish());
    compressed
        .map(|c| STANDARD.encode(c))
        .map_err(|e| ExportError::refused(format!("it cannot be compressed: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_a_place_for_everything_and_no_end_of_its_script_within() {
        for place in ["name", "description", "style", "section", "script", "scene", "meshes", "explained"] {
            assert!(PAGE.contains(&format!("{{{{{place}}}}}")), "{place}");
        }
        assert!(!SCRIPT.concat().contains("</") && !STYLE.contains("</"));
    }

    #[test]
    fn scripts_lose_their_lines_of_comments_and_half_of_their_indentation() {
        let script = "// A.\nconst a = 1; // one\n  // B\n{\n    const b = 'http://b';\n}\n";
        assert_eq!(compact(script), "const a = 1; // one\n{\n  const b = 'http://b';\n}\n");
        // A line of a text that begins so would be lost.
        let texts = SCRIPT.iter().filter(|script| script.matches('`').count() % 2 == 1);
        assert_eq!(texts.count(), 0);
        let within = |script: &str| script.split('`').skip(1).step_by(2).any(|text| text.contains('\n'));
        assert!(!SCRIPT.iter().any(|script| within(script)));
    }

    #[test]
    fn a_page_that_is_too_large_is_refused_with_its_sizes() {
        let said = too_large(512_345, [380_000, 90_000, 100, 50], false);
        assert!(said.contains("513 kB") && said.contains("300 kB is the limit"), "{said}");
        assert!(said.contains("380 kB are meshes") && said.contains("90 kB shaders"), "{said}");
        assert!(said.contains("lower tessellations"), "{said}");
        let said = too_large(512_345, [10_000, 90_000, 400_000, 50], false);
        assert!(said.contains("a shorter name or description") && !said.contains("lower"), "{said}");
        let said = too_large(512_345, [10_000, 90_000, 100, 400_000], true);
        assert!(said.contains(": 400 kB are the names of objects and views, 90 kB shaders"), "{said}");
        assert!(said.ends_with("; shorter names make it smaller"), "{said}");
    }
}
