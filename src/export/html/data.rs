//! The scene in the form that the page reads.

use std::collections::{BTreeMap, HashMap, hash_map::Entry};

use serde_json::{Map, Value as Json, json};

use super::{
    blocks::Blocks,
    equation::{equation, symbol},
    explained, limits, mesh,
    programs::program,
    texts::Texts,
};
use crate::{
    caption::view_parts,
    export::{
        ExportError, Progress, Request,
        bodies::Body,
        lit::{Lit, Program},
        shader::LIGHT_SAMPLES,
        shaders::alone,
        view::{called, without_labels},
    },
    optics::{TermSelection, colour::srgb_encode},
    parameter::{Parameter, Value, json as value, layout, stride},
    reflection::{Ambient, ModelEntry, OnPages, Passage},
    registry::Registry,
    scene::{Scene, variant::LETTERS},
    shading::ShadingEntry,
    shape::{MeshKey, PolygonMesh},
    text::listed,
};

/// The scene, and its meshes.
#[derive(Debug)]
pub struct Data {
    /// Everything except the meshes.
    pub scene: Json,
    /// The bytes of the meshes, concatenated.
    pub meshes: Vec<u8>,
    /// Explanations of a point's colour, by the letters of the views; empty unless requested.
    pub points: Map<String, Json>,
    /// The script that recalculates curves and the inside of solid bodies when a parameter changes.
    pub script: String,
    /// Sentences about differences from the picture in the lab.
    pub notes: Vec<String>,
}

/// A sentence for each object whose normals come from its file: the page calculates all normals.
fn normals<'a>(lit: &'a Lit) -> impl Iterator<Item = String> + 'a {
    let Request { scene, registry, .. } = lit.request;
    lit.objects.iter().filter_map(move |drawn| {
        let object = &scene.objects[drawn.index];
        let shape = registry.shape(&object.object_type)?;
        // Of the built-in shapes, only files have explicit normals; rebuilding all meshes would take a while.
        shape.parameters.iter().any(|p| p.kind.format().is_some()).then_some(())?;
        let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
        mesh.has_own_normals().then(|| {
            let path = scene.object_path(drawn.index);
            format!("{path}: the page calculates the normals of its mesh and does not use those of the file.")
        })
    })
}

/// Data shared by the views of a page.
#[derive(Default)]
struct Shared {
    texts: Texts,
    blocks: Blocks,
    meshes: Meshes,
    /// By the list of functions and the model.
    scripts: BTreeMap<(&'static str, &'static str), &'static str>,
    /// Each note once, in the order of the views.
    notes: Vec<String>,
}

impl Shared {
    fn note(&mut self, notes: impl IntoIterator<Item = String>) {
        for note in notes {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }
}

/// Takes a scene apart for a page, with all its views.
///
/// # Errors
/// Returns an error for parts that a page cannot contain.
pub fn data(request: &Request, progress: &Progress) -> Result<Data, ExportError> {
    let Request { scene, registry, .. } = *request;
    let mut shared = Shared::default();
    let (mut views, mut points) = (Vec::new(), Map::new());
    let all: Vec<_> = (0..=scene.variants.len()).filter_map(|i| scene.seen(i, registry)).collect();
    for (i, (seen, terms)) in all.iter().enumerate() {
        let part = |done: f32| (i as f32 + done) / all.len() as f32;
        let named = called(scene, i);
        let of_view = Request { scene: seen, ..*request };
        let made = view(&of_view, &mut shared, &|done, step| Ok(progress.step(0.9 * part(done), step)?));
        let mut json = match made {
            // The other views are useful without it.
            Err(ExportError::Refused(reasons)) if i > 0 => {
                shared.note([format!("{named} is left out: {}.", reasons.join("; "))]);
                continue;
            }
            made => made?,
        };
        json["name"] = json!(name_of(scene, (i, *terms), registry));
        json["letter"] = json!(LETTERS.get(i));
        if let (Some(pixel), Some(letter)) = (request.point, LETTERS.get(i)) {
            let (point, note) = explained::point(&of_view, pixel)?;
            points.insert((*letter).to_owned(), point);
            shared.note(note.map(|note| format!("{note}.")));
        }
        views.push(json);
        if *terms != TermSelection::All {
            shared.note([format!("{named} shows some terms of the equation only; the page shows all.")]);
        }
    }
    let shadings = registry.shading_models().iter().map(|s| {
        json!({
            "id": s.declaration.id,
            "name": s.declaration.name,
            "source": s.declaration.source,
            "summary": s.declaration.summary,
            "parameters": parameters(s.parameters),
            "size": stride(s.parameters),
        })
    });
    let data = json!({
        "shadings": shadings.collect::<Vec<_>>(),
        "views": views,
        "meshes": shared.meshes.all,
        "texts": shared.texts.json(),
        "blocks": shared.blocks.json(),
    });
    let script =
        |((list, id), script): (&(&str, &str), &&str)| format!("{list}[{}] = {script};\n", json!(id));
    let script = shared.scripts.iter().map(script).collect();
    Ok(Data { scene: data, meshes: shared.meshes.bytes, notes: shared.notes, points, script })
}

/// The name of a view: its own, or the first words that the window has for it, such as its model.
fn name_of(scene: &Scene, (view, terms): (usize, TermSelection), registry: &Registry) -> String {
    let own = view.checked_sub(1).and_then(|i| scene.variants.get(i)?.name.clone());
    let first = || Some(view_parts(scene, (view, terms), registry).first()?.words());
    own.or_else(first).unwrap_or_default()
}

/// Takes one view of a scene apart.
fn view(
    request: &Request,
    shared: &mut Shared,
    step: &dyn Fn(f32, &'static str) -> Result<(), ExportError>,
) -> Result<Json, ExportError> {
    let Request { scene, registry, .. } = *request;
    let host = alone(request)?;
    let shadings = registry.shading_models();
    let variants: Vec<Scene> = shadings.iter().map(|shading| shaded(scene, shading)).collect();
    let mut lits = Vec::new();
    for (i, variant) in variants.iter().enumerate() {
        step(0.4 * i as f32 / variants.len() as f32, "taking the scene apart")?;
        lits.push(Lit::of(Request { scene: variant, ..*request }, host, |_| true)?);
    }
    let Some(lit) = lits.first().filter(|lit| !lit.objects.is_empty()) else {
        return Err(ExportError::refused("all objects are hidden; make one visible"));
    };

    let mut models = Vec::new();
    for (m, of_model) in lit.programs.iter().enumerate() {
        step(0.4 + 0.4 * m as f32 / lit.programs.len() as f32, "translating its shaders")?;
        // Each shading model has separate materials, but the objects are the same.
        let at = lit.objects.iter().position(|drawn| lit.materials[drawn.material].program == m);
        let Some(at) = at else { continue };
        let mut programs = Vec::new();
        for lit in &lits {
            programs.push(program(lit, &lit.objects[at], &mut shared.texts, &mut shared.blocks)?);
        }
        models.push(model((of_model, registry), lit, &programs, &mut shared.blocks));
        shared
            .scripts
            .extend(twin(of_model.model, registry).map(|(id, _, twin)| (("CURVES", id), twin.script)));
        let inside = of_model.model.interior_on_pages().filter(|_| of_model.shader.reads_body);
        shared.scripts.extend(inside.map(|script| (("INTERIORS", of_model.model.declaration.id), script)));
        let fixed = fixed(of_model, registry);
        shared.note(fixed.map(|why| format!("{}: {why}.", of_model.model.declaration.name)));
        shared.note(without_knobs_note(of_model, scene));
    }

    step(0.8, "packing its meshes")?;
    let tangents = lit.programs.iter().any(|p| p.model.declaration.anisotropic);
    let (mesh_of, open) = shared.meshes.of(lit, tangents)?;
    let objects: Vec<_> = lit
        .objects
        .iter()
        .zip(mesh_of)
        .map(|(drawn, mesh)| {
            let object = &scene.objects[drawn.index];
            let material = &lit.materials[drawn.material];
            let shading = scene.shading_model_of(object);
            let values: Map<_, _> =
                object.material.0.iter().map(|(name, v)| (name.to_string(), value(v))).collect();
            json!({
                "name": object.name.clone().unwrap_or_else(|| format!("{} {}", object.object_type, drawn.index + 1)),
                "model": material.program,
                "shading": shadings.iter().position(|s| s.declaration.id == shading),
                "mesh": mesh,
                "matrix": drawn.room_from_object(request).to_cols_array(),
                "values": values,
                // As exported: parameters change the material, and the mean is right for any lobes.
                "lobes": (!material.lobes.is_empty()).then(|| shared.blocks.add(&material.lobes)),
                "curve": (!material.curve.is_empty()).then(|| shared.blocks.add(&material.curve)),
                "interior": (!material.interior.is_empty()).then(|| shared.blocks.add(&material.interior)),
            })
        })
        .collect();
    shared.note(lit.notes());
    shared.note(without_labels(lit.request.scene));
    shared.note(normals(lit));
    shared.note(open);
    let observer = &scene.observer;
    Ok(json!({
        "models": models,
        "objects": objects,
        "observer": {
            "position": observer.position.to_array(),
            "direction": observer.direction.to_array(),
            "fieldOfView": observer.field_of_view,
        },
        "lightSamples": lit.lights.has_extent().then_some(LIGHT_SAMPLES),
        // Much work, which is drawn in steps.
        "slow": lit.lights.has_extent() || lit.programs.iter().any(|p| p.shader.reads_body),
        "exposure": scene.display.exposure,
        "encoding": scene.display.encoding.id(),
        "background": lit.background().map(|v| srgb_encode(v.clamp(0.0, 1.0))).to_array(),
        "gradient": lit.gradient().map(|colours| {
            let [top, bottom] = colours.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
            format!("linear-gradient({top}, {bottom})")
        }),
    }))
}

/// The scene with one shading model for all objects.
fn shaded(scene: &Scene, shading: &ShadingEntry) -> Scene {
    let mut scene = scene.clone();
    for object in &mut scene.objects {
        object.shading_model = Some(shading.declaration.id.to_owned());
    }
    scene
}

/// The meshes, and their bytes.
#[derive(Default)]
struct Meshes {
    all: Vec<Json>,
    bytes: Vec<u8>,
    known: HashMap<(MeshKey, bool), usize>,
    /// Those of solid bodies, by index.
    bodies: HashMap<usize, Body>,
}

impl Meshes {
    /// The index of the mesh of each object, and a sentence for each body whose mesh is not closed.
    fn of(&mut self, lit: &Lit, tangents: bool) -> Result<(Vec<usize>, Vec<String>), ExportError> {
        let Request { scene, registry, .. } = lit.request;
        let (mut of_objects, mut open) = (Vec::new(), Vec::new());
        for drawn in &lit.objects {
            let object = &scene.objects[drawn.index];
            // Known, since the scene could be taken apart.
            let Some(shape) = registry.shape(&object.object_type) else { continue };
            let key = (shape.key(&object.shape, object.tessellation), tangents);
            let polygons = || shape.mesh(&object.shape, shape.tessellation(object.tessellation));
            let index = match self.known.get(&key) {
                Some(index) => *index,
                None => {
                    let index = self.add(&polygons(), tangents)?;
                    self.known.insert(key, index);
                    index
                }
            };
            of_objects.push(index);
            if lit.programs[lit.materials[drawn.material].program].shader.reads_body {
                if let Entry::Vacant(place) = self.bodies.entry(index) {
                    let body = Body::of(&polygons());
                    body.fits(limits::TEXTURE)?;
                    self.all[index]["closed"] = json!(body.is_closed());
                    place.insert(body);
                }
                let note =
                    self.bodies.get(&index).and_then(|body| body.note(&scene.object_path(drawn.index)));
                open.extend(note);
            }
        }
        Ok((of_objects, open))
    }

    fn add(&mut self, polygons: &PolygonMesh, tangents: bool) -> Result<usize, ExportError> {
        limits::mesh(polygons)?;
        let packed = mesh::pack(polygons, tangents);
        self.all.push(json!({
            "vertices": packed.vertices,
            "polygons": packed.polygons,
            "step": packed.step,
            "tangents": packed.tangents,
            "at": self.bytes.len(),
        }));
        self.bytes.extend(packed.bytes);
        Ok(self.all.len() - 1)
    }
}

fn model(
    (of_model, registry): (&Program, &Registry),
    lit: &Lit,
    programs: &[Json],
    blocks: &mut Blocks,
) -> Json {
    let entry = of_model.model;
    let what = entry.declaration;
    let uniform = lit.lights.uniform;
    let curves = entry.curves().iter().map(|curve| json!({ "name": curve.name, "length": curve.length() }));
    let twin = twin(entry, registry).map(|(id, of, twin)| {
        let table: Vec<u8> = (twin.table)().iter().flat_map(|number| number.to_le_bytes()).collect();
        let default = |p: &Parameter| {
            let value = match p.default_value() {
                Value::Colour(rgb) => json!(lit.request.scene.display.encoding.decode(rgb).to_array()),
                other => value(&other),
            };
            (p.name.to_owned(), value)
        };
        let defaults: Map<_, _> = of.parameters.iter().map(default).collect();
        json!({ "of": id, "defaults": defaults, "table": blocks.add(&table) })
    });
    json!({
        "id": what.id,
        "name": what.name,
        "author": what.author,
        "source": what.source,
        "summary": what.summary,
        "equation": parts(of_model),
        "parameters": without_knobs(parameters(entry.parameters), &deciding(of_model, lit.request.scene)),
        "size": stride(entry.parameters),
        "harmonics": entry.harmonics(),
        // The parts of the curve that the shaders read.
        "albedo": uniform && what.ambient == Ambient::Albedo,
        "lobe": lobe(entry),
        "curves": curves.collect::<Vec<_>>(),
        "twin": twin,
        "fixed": fixed(of_model, registry),
        "programs": programs,
    })
}

/// The parts of the equation of a model. A surface that stays opaque has no knobs for transmission.
fn parts(of_model: &Program) -> Vec<Json> {
    let all = of_model.model.declaration.equation_of(of_model.passage).into_iter();
    all.map(|part| json!({ "term": part.term.id(), "html": equation(part.text) })).collect()
}

/// The settings under which the specular response of a model is its lobe alone, with F = 1 and without
/// multiple scattering: null for models without such settings.
fn lobe(entry: &ModelEntry) -> Json {
    let own = entry.lobe_of() == Some("microfacet") && entry.has_lobe();
    if own { json!({ "fresnel": "none", "multiple_scattering": "none" }) } else { Json::Null }
}

/// The model with the same curves that a page can calculate instead of this one, and the twin of its curves.
fn twin<'a>(entry: &ModelEntry, registry: &'a Registry) -> Option<(&'static str, &'a ModelEntry, OnPages)> {
    let id = entry.lobe_of()?;
    let of = registry.model(id)?;
    (of.curves() == entry.curves()).then_some((id, of, of.on_pages()?))
}

/// The reason why a page cannot change any parameter of a model; `None` if it can.
fn fixed(of_model: &Program, registry: &Registry) -> Option<&'static str> {
    let entry = of_model.model;
    let none = entry.lobe_of().is_none() && entry.curves().is_empty();
    let follows = none || twin(entry, registry).is_some() || lobe(entry) != Json::Null;
    if !follows {
        return Some(
            "its knobs are fixed on the page, since only the program calculates its multiple scattering",
        );
    }
    let inside = of_model.passage.solid && entry.interior_on_pages().is_none();
    inside.then_some(
        "its knobs are fixed on the page, since only the program calculates the inside of its body",
    )
}

/// The parameters of a model that may change how light passes, which the shaders of a page cannot follow. If no light
/// passes, the other parameters of their group have no effect either.
fn deciding(of_model: &Program, scene: &Scene) -> Vec<&'static str> {
    let (entry, passage) = (of_model.model, of_model.passage);
    if !entry.passage_varies() {
        return Vec::new();
    }
    let own = || {
        let of_model = scene.objects.iter().filter(|object| scene.model_of(object) == entry.declaration.id);
        of_model.filter(|object| entry.passage(&object.material).solid == passage.solid)
    };
    let decides = |p: &&Parameter| {
        own().any(|object| {
            p.ends().into_iter().any(|end| {
                let mut values = object.material.clone();
                values.set(p.name, end);
                passage | entry.passage(&values) != passage
            })
        })
    };
    let mut names: Vec<_> = entry.parameters.iter().filter(decides).map(|p| p.name).collect();
    if passage == Passage::NONE {
        let groups = entry.groups.iter().filter(|group| group.parameters.iter().any(|p| names.contains(p)));
        let others: Vec<_> = groups.flat_map(|group| group.parameters.iter().copied()).collect();
        names.extend(others);
    }
    names
}

/// A sentence about the knobs that `deciding` takes from the page, if any.
fn without_knobs_note(of_model: &Program, scene: &Scene) -> Option<String> {
    let entry = of_model.model;
    let names = deciding(of_model, scene);
    let labels: Vec<_> =
        entry.parameters.iter().filter(|p| names.contains(&p.name)).map(|p| p.label).collect();
    let name = entry.declaration.name;
    match labels.as_slice() {
        [] => None,
        labels if of_model.passage == Passage::NONE => Some(format!(
            "{name}: opaque on the page, without knobs for {}, as light that passes takes another shader.",
            listed(labels, "and"),
        )),
        _ => {
            let walls = if of_model.passage.solid { "bodies stay solid" } else { "walls stay thin" };
            Some(format!("{name}: its {walls} on the page, as anything else takes another shader."))
        }
    }
}

/// Parameters, those with these names without a knob.
fn without_knobs(mut all: Vec<Json>, names: &[&str]) -> Vec<Json> {
    for p in all.iter_mut().filter(|p| names.iter().any(|name| p["name"] == *name)) {
        p["hidden"] = json!(true);
    }
    all
}

fn parameters(all: &[Parameter]) -> Vec<Json> {
    all.iter().zip(layout(all)).map(|(p, (_, _, at))| parameter(p, at)).collect()
}

fn parameter(p: &Parameter, at: usize) -> Json {
    let mut json = json!({
        "name": p.name,
        "symbol": symbol(p.symbol),
        "label": p.label,
        "unit": p.unit,
        "help": p.help,
        "kind": p.kind.name(),
        "default": value(&p.default_value()),
        "at": at,
        "usedWhen": p.used_when.map(|used| json!({ "parameter": used.parameter, "choices": used.choices })),
    });
    if let Some(range) = p.kind.limits().filter(|_| p.kind.is_measured()) {
        let end = |v: f64| if range.whole { json!(v as i64) } else { json!(v) };
        (json["min"], json["max"]) = (end(range.min), end(range.top()));
        if range.whole {
            json["open"] = json!(range.max.is_infinite());
        }
    }
    if !p.kind.options().is_empty() {
        json["options"] = json!(p.kind.options());
    }
    json
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{caption::header, scene::Variant};

    /// The views of a scene in the form that the page reads.
    fn views(scene: &Scene) -> Json {
        let registry = &Registry::builtin();
        let request = Request { scene, registry, stem: "scene", size: (64, 36), object: 0, point: None };
        let data = data(&request, &Progress::NONE).unwrap_or_else(|error| panic!("{error:?}"));
        data.scene["views"].clone()
    }

    #[test]
    fn every_view_has_its_own_name_or_that_of_the_window() {
        let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        let other = Variant { reflection_model: Some("blinn_phong".to_owned()), ..Variant::default() };
        scene.variants = vec![other.clone(), Variant { name: Some("Mine".to_owned()), ..other }];
        let made = views(&scene);
        let names = [0_usize, 1, 2].map(|i| made[i]["name"].as_str().unwrap_or_default());
        assert_eq!(names, ["Phong", "Blinn–Phong", "Mine"]);
        for (view, name) in names.into_iter().enumerate() {
            let heading = header(&scene, view, &Registry::builtin());
            assert!(heading.starts_with(&format!("{} · {name}", LETTERS[view])), "{heading}");
        }
    }

    #[test]
    fn the_equation_has_no_term_without_knobs() {
        let equation = |weight: f32| {
            let mut scene = Scene { reflection_model: "openpbr".to_owned(), ..Scene::default() };
            scene.objects[0].material.set("transmission_weight", Value::Number(weight));
            views(&scene)[0]["models"][0]["equation"].to_string()
        };
        let (opaque, clear) = (equation(0.0), equation(1.0));
        assert!(
            !opaque.contains("<i>I</i><sub><i>t</i></sub>") && !opaque.contains("transmitted"),
            "{opaque}"
        );
        assert!(opaque.contains("specular") && clear.contains("transmitted"), "{clear}");
    }
}
