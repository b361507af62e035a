//! A scene for Mitsuba 3, a path tracer: a reference for pictures, and an independent check of ours.
//!
//! Only what has the same equation there is exported; the rest is refused, all parts at once. Our lights multiply a
//! response π f_r cos θ, and Mitsuba's multiply f_r cos θ, so lights from one direction are π times as strong there.
//! `tests/suite/exports/mitsuba.rs` compares the pictures.

use std::collections::{BTreeSet, HashMap};

use glam::Vec3;

use self::{
    bsdf::{Bsdf, Material},
    emitter::{Emitter, Lamp},
    mesh::{Surface, ply},
    through::{DEPTH, Through},
    xml::{Xml, look_at, to_world},
};
use super::{
    Export, ExportError, File, Form, Makes, Progress, Request, refusals::Refusals, view::without_labels,
};
use crate::{
    light::Incident,
    optics::{colour::Encoding, tone::ToneMapping},
    registry::compose,
    scene::{
        Object, emitter, has_extent,
        observer::{NEAR, orientation},
        record,
    },
    shape::MeshKey,
    text::listed,
};

mod bsdf;
mod emitter;
mod mesh;
mod through;
mod xml;

/// The form.
pub const FORM: Form = Form {
    id: "mitsuba",
    name: "Mitsuba scene",
    summary: "a folder with a scene for Mitsuba 3: mitsuba -m scalar_rgb FOLDER/scene.xml",
    makes: Makes::Folder,
    of_object: false,
    of_view: true,
    make,
};

/// Shading models: true for those that interpolate, false for those that show polygons.
const SHADING: &[(&str, bool)] =
    &[("gouraud", true), ("phong", true), ("flat", false), ("derivative", false)];

/// Samples per pixel.
const SAMPLES: &str = "64";

fn make(request: &Request, progress: &Progress) -> Result<Export, ExportError> {
    let scene = request.scene;
    progress.step(0.0, "looking for counterparts")?;
    let mut refused = Refusals::default();
    let lights = lights(request, &mut refused);
    let objects = objects(request, &mut refused);
    let objects = refused.or(objects)?;
    if objects.is_empty() {
        return Err(ExportError::refused("no object is visible"));
    }

    let within = objects.iter().any(|object| object.bsdf.through == Through::Body);
    let (said, integrator) = integrator(within);
    let mut file = Xml::element("scene version=\"3.5.0\"").says(said).with(integrator).with(sensor(request));
    let mut files = Vec::new();
    let unlike = of_lights(request, &lights);
    for (name, Emitter { xml, file: texture, .. }) in lights {
        file = xml.into_iter().fold(file.says(&name), Xml::with);
        files.extend(texture);
    }
    let mut meshes: HashMap<(MeshKey, Surface), String> = HashMap::new();
    let mut notes = BTreeSet::new();
    let total = objects.len();
    for (done, Counterpart { name, object, bsdf, smooth }) in objects.into_iter().enumerate() {
        progress.step(done as f32 / total as f32, "making meshes")?;
        let Some(shape) = request.registry.shape(&object.object_type) else { continue };
        let surface = Surface { smooth, brushed: bsdf.brushed };
        let key = (shape.key(&object.shape, object.tessellation), surface);
        let count = meshes.len();
        let path = meshes.entry(key).or_insert_with(|| {
            let path = format!("meshes/{}_{count}.ply", object.object_type);
            let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
            files.push(File::new(&path, ply(&mesh, surface)));
            path
        });
        notes.extend(bsdf.note.map(str::to_owned));
        let known = |file: &File| files.iter().any(|known: &File| known.path == file.path);
        let new = bsdf.file.filter(|file| !known(file));
        files.extend(new);
        let shape = Xml::plugin("shape", "ply").set("string", "filename", path);
        let shape = if smooth { shape } else { shape.set("boolean", "face_normals", "true") };
        file = file.says(&name).with(shape.with(to_world(object.room_from_object())).with(bsdf.xml));
    }
    notes.extend(differences(request));
    notes.extend(unlike);
    notes.extend(without_labels(request.scene));
    let title = scene.name.as_deref().unwrap_or(request.stem);
    let about = format!(
        "{title}, by Lights, Camera, Models! {}, for Mitsuba 3: mitsuba -m scalar_rgb scene.xml writes scene.exr, in linear light.",
        env!("CARGO_PKG_VERSION")
    );
    let about = match &scene.description {
        Some(description) => format!("{about} {description}"),
        None => about,
    };
    files.insert(0, File::new("scene.xml", file.file(&about)));
    Ok(Export { files, notes: notes.into_iter().collect() })
}

/// The active lights, each with its name.
fn lights(request: &Request, refused: &mut Refusals) -> Vec<(String, Emitter)> {
    let Request { scene, registry, .. } = request;
    let mut emitters: Vec<(String, Emitter)> = Vec::new();
    for (i, light) in scene.lights.iter().enumerate().filter(|(_, light)| light.enabled) {
        let Some(entry) = registry.light(&light.light_type) else { continue };
        let name = scene.light_path(i);
        let record = record(light, registry, scene.display.encoding);
        let lamp = Lamp { entry, record, values: &light.parameters, number: i };
        let shader = entry.declaration.wgsl.path;
        let emitter = match registry.sources().get(shader) {
            Some(_) => Err(format!("the edited {shader} has no counterpart in Mitsuba")),
            None => lamp.emitter(),
        };
        let first = emitters.iter().find(|(_, known)| known.around).map(|(first, _)| first);
        match emitter {
            Ok(Emitter { around: true, .. }) if let Some(first) = first => refused.add(
                name,
                format!("Mitsuba allows only one light from all around, and {first} is one already; switch off one of them"),
            ),
            Ok(emitter) => emitters.push((name, emitter)),
            Err(why) => refused.add(name, why),
        }
    }
    emitters
}

/// An object and its counterpart.
struct Counterpart<'a> {
    name: String,
    object: &'a Object,
    bsdf: Bsdf,
    smooth: bool,
}

/// The visible objects.
fn objects<'a>(request: &'a Request, refused: &mut Refusals) -> Vec<Counterpart<'a>> {
    let Request { scene, registry, .. } = request;
    let encoding = scene.display.encoding;
    let emitters = scene.shining().filter_map(|light| emitter(light, registry, encoding));
    let ambient = emitters
        .map(|(_, emitter, record)| emitter.incident(&record, Vec3::ZERO))
        .any(|incident| matches!(incident, Incident::Uniform { intensity } if intensity != Vec3::ZERO));
    let shown = scene.objects.iter().filter(|object| object.visible).count();
    let mut found = Vec::new();
    for (i, object) in scene.objects.iter().enumerate().filter(|(_, object)| object.visible) {
        let (model, shading) = (scene.model_of(object), scene.shading_model_of(object));
        let (Some(model), Some(shading)) = (registry.model(model), registry.shading_model(shading)) else {
            continue;
        };
        let name = scene.object_path(i);
        let mut wrong = Vec::new();
        let drawn = (model, model.passage(&object.material));
        let changed = compose::files(registry.sources(), drawn, shading, &[]);
        let changed: Vec<_> = changed.into_iter().filter(|file| file.edited).map(|file| file.path).collect();
        if !changed.is_empty() {
            wrong.push(format!("the edited {} has no counterpart in Mitsuba", listed(&changed, "and")));
        }
        let bsdf = Material { model, values: &object.material, encoding, ambient }.bsdf();
        let bsdf = bsdf.and_then(|bsdf| {
            through::check(bsdf.through, object, registry, shown - 1)?;
            Ok(bsdf)
        });
        let id = shading.declaration.id;
        let smooth = SHADING.iter().find(|(known, _)| *known == id).map(|(_, smooth)| *smooth);
        if smooth.is_none() {
            wrong.push(format!("Mitsuba has no counterpart of the shading model {id}"));
        }
        match (bsdf, smooth) {
            (Ok(bsdf), Some(smooth)) if wrong.is_empty() => {
                found.push(Counterpart { name, object, bsdf, smooth });
            }
            (bsdf, _) => {
                wrong.extend(bsdf.err());
                wrong.into_iter().for_each(|why| refused.add(name.clone(), why));
            }
        }
    }
    found
}

/// The light transport, in words and as a Mitsuba integrator: from the lamps to the observer, or through the inside of
/// a body.
fn integrator(within: bool) -> (&'static str, Xml) {
    let (said, xml) = if within {
        let xml = Xml::plugin("integrator", "path").set("integer", "max_depth", &DEPTH.to_string());
        // Nothing ends by chance before.
        (
            "Light goes through the body, with up to 16 reflections inside.",
            xml.set("integer", "rr_depth", "1000"),
        )
    } else {
        let said = "Light that arrives straight from a lamp, as in the lab, but with shadows. With type=\"path\", light goes on from surface to surface.";
        (said, Xml::plugin("integrator", "direct"))
    };
    (said, xml.set("boolean", "hide_emitters", "true"))
}

fn sensor(request: &Request) -> Xml {
    let observer = &request.scene.observer;
    let (width, height) = request.size;
    let ahead = observer.direction.normalize_or(Vec3::NEG_Z);
    Xml::plugin("sensor", "perspective")
        .set("string", "fov_axis", "y")
        .float("fov", observer.field_of_view)
        .float("near_clip", NEAR)
        .with(look_at(observer.position, ahead, orientation(observer.direction).y_axis))
        .with(Xml::plugin("sampler", "multijitter").set("integer", "sample_count", SAMPLES))
        .with(
            Xml::plugin("film", "hdrfilm")
                .set("integer", "width", &width.to_string())
                .set("integer", "height", &height.to_string())
                .set("string", "pixel_format", "rgb")
                .set("string", "component_format", "float32")
                .with(Xml::plugin("rfilter", "box")),
        )
}

/// The difference of light with extent from the lab, if there is any.
fn of_lights(request: &Request, lights: &[(String, Emitter)]) -> Option<String> {
    let hides = lights.len() > 1 && lights.iter().any(|(_, emitter)| emitter.hides);
    let doubled = lights.iter().any(|(_, emitter)| emitter.xml.len() > 1);
    let unlike = [
        Some("Mitsuba does not show the lights themselves"),
        hides.then_some("nearer ones hide farther ones"),
        doubled.then_some("two-sided ones become two, a millimetre apart"),
    ];
    let unlike: Vec<_> = unlike.into_iter().flatten().collect();
    has_extent(request.scene.shining(), request.registry).then(|| unlike.join("; "))
}

/// The differences from the picture in the lab.
fn differences(request: &Request) -> Vec<String> {
    let scene = request.scene;
    let shown = |id: &str| scene.shown().any(|object| scene.shading_model_of(object) == id);
    let display = &scene.display;
    let mut notes = vec!["Mitsuba casts shadows, the lab does not; its background is black".to_owned()];
    if display.backdrop().is_some() {
        notes.push(format!(
            "display.background, {}, is left out: in Mitsuba all that is seen is light, and would light the objects",
            display.background.id()
        ));
    }
    if shown("gouraud") || shown("flat") {
        notes.push(
            "Mitsuba shades every pixel: gouraud becomes phong, and flat becomes derivative".to_owned(),
        );
    }
    if display.exposure != 0.0 || display.tone_mapping != ToneMapping::None {
        let (exposure, curve) = (display.exposure, display.tone_mapping.id());
        let before = format!("the exposure of {exposure} EV and the tone mapping {curve}");
        notes.push(format!("the picture is linear light, before {before}"));
    }
    if display.encoding == Encoding::Off {
        notes.push("colours are taken as linear light, as the scene's display does".to_owned());
    }
    notes
}
