//! A scene taken apart for export: its shaders, materials and meshes, and the objects drawn with them.

use std::collections::HashMap;

use glam::{Mat4, Vec3};

use super::{
    ExportError, Request,
    lights::Lights,
    names::Names,
    refusals::Refusals,
    shader::{Host, LIGHT_SAMPLES, Shader, compose},
};
use crate::{
    optics::{
        colour::{BACKGROUND, Encoding},
        interior::Interior,
        tone::exposure_factor,
    },
    parameter::{Parameter, Values, pack},
    reflection::{ModelEntry, Passage},
    scene::{Background, Object, Scene},
    shader::compose::WRAPPER,
    shading::{ShadingEntry, Stage},
    shape::{MeshKey, Says, Vertices},
};

/// A scene taken apart.
pub struct Lit<'a> {
    /// The scene, and the purpose for which it was taken apart.
    pub request: Request<'a>,
    /// The active lights.
    pub lights: Lights<'a>,
    /// One for each pair of reflection and shading models in use.
    pub programs: Vec<Program<'a>>,
    /// The different materials.
    pub materials: Vec<Material>,
    /// The different meshes.
    pub meshes: Vec<MeshData>,
    /// The visible objects, in the order of the scene.
    pub objects: Vec<Drawn>,
}

/// Known parts, for lookup.
#[derive(Default)]
struct Known {
    meshes: HashMap<(MeshKey, bool), usize>,
    /// Names of the meshes.
    names: Names,
    /// By program and values, and the mesh of a solid body.
    materials: HashMap<(usize, String, Option<MeshKey>), usize>,
}

/// A shader, and the models that it consists of.
pub struct Program<'a> {
    /// The reflection model.
    pub model: &'a ModelEntry,
    /// The passage of light through the objects with the shader.
    pub passage: Passage,
    /// The shading model.
    pub shading: &'a ShadingEntry,
    /// The shader.
    pub shader: Shader,
}

impl Program<'_> {
    /// True if vertices contain data of their polygon.
    #[must_use]
    pub fn faces(&self) -> bool {
        self.shading.declaration.stage == Stage::Polygon
    }

    /// A name for files: `microfacet_phong`, `openpbr_phong_body`.
    #[must_use]
    pub fn name(&self) -> String {
        let body = if self.passage.solid && self.model.passage_varies() { "_body" } else { "" };
        format!("{}_{}{body}", self.model.declaration.id, self.shading.declaration.id)
    }
}

/// A material: the parameters of objects with the same appearance.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Index of the shader.
    pub program: usize,
    /// The values given in the scene.
    pub values: Values,
    /// The bytes of `Parameters`.
    pub parameters: Vec<u8>,
    /// The bytes of `AlbedoCurve`; empty for shaders that do not read it.
    pub curve: Vec<u8>,
    /// The bytes of `material_lobes`; empty for shaders that do not read it.
    pub lobes: Vec<u8>,
    /// The bytes of `interior`; empty for shaders that do not read it.
    pub interior: Vec<u8>,
    /// The bytes of `ShadingParameters`; empty for shaders that do not read it.
    pub shading: Vec<u8>,
}

/// A mesh in the layout of the shaders.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshData {
    /// A name for files: `sphere_32`.
    pub name: String,
    /// The attributes of the vertices, in the order of their locations.
    pub attributes: Vec<Attribute>,
    /// Three vertices for each triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
}

/// A vertex attribute: three numbers for each vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Name in the shader.
    pub name: &'static str,
    /// Values of the vertices.
    pub values: Vec<[f32; 3]>,
}

impl MeshData {
    /// The number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.attributes.first().map_or(0, |a| a.values.len())
    }

    /// The vertices one after the other, each with its attributes in order, three floats each.
    #[must_use]
    pub fn interleaved(&self) -> Vec<u8> {
        let vertex = |i: usize| self.attributes.iter().flat_map(move |a| a.values[i]);
        (0..self.vertices()).flat_map(vertex).flat_map(f32::to_le_bytes).collect()
    }
}

/// An object of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// Index in the scene.
    pub index: usize,
    /// Index of the material.
    pub material: usize,
    /// Index of the mesh.
    pub mesh: usize,
}

impl Drawn {
    /// Transformation from the object's own coordinates to the room.
    #[must_use]
    pub fn room_from_object(&self, request: &Request) -> Mat4 {
        request.scene.objects[self.index].room_from_object()
    }
}

impl<'a> Lit<'a> {
    /// Takes a scene apart; `wanted` selects objects by index.
    ///
    /// # Errors
    /// Returns an error for parts that no form can contain: unknown models and shapes.
    pub fn of(request: Request<'a>, host: Host, wanted: impl Fn(usize) -> bool) -> Result<Self, ExportError> {
        let Request { scene, registry, .. } = request;
        let lights = Lights::of(scene, registry);
        let mut lit = Self {
            request,
            lights,
            programs: Vec::new(),
            materials: Vec::new(),
            meshes: Vec::new(),
            objects: Vec::new(),
        };
        let mut refused = Refusals::default();
        let mut known = Known::default();
        for (index, object) in scene.objects.iter().enumerate().filter(|(i, o)| o.visible && wanted(*i)) {
            match lit.add(index, object, host, &mut known) {
                Ok(()) => {}
                Err(ExportError::Refused(reasons)) => {
                    reasons.into_iter().for_each(|reason| refused.add(scene.object_path(index), reason));
                }
                Err(other) => return Err(other),
            }
        }
        refused.or(lit)
    }

    fn add(
        &mut self,
        index: usize,
        object: &Object,
        host: Host,
        known: &mut Known,
    ) -> Result<(), ExportError> {
        let Request { scene, registry, .. } = self.request;
        let (model, shading) = (scene.model_of(object), scene.shading_model_of(object));
        let unknown = |what: &str, id: &str| ExportError::refused(format!("there is no {what} {id}"));
        let model = registry.model(model).ok_or_else(|| unknown("reflection model", model))?;
        let shading = registry.shading_model(shading).ok_or_else(|| unknown("shading model", shading))?;
        let shape =
            registry.shape(&object.object_type).ok_or_else(|| unknown("object type", &object.object_type))?;
        let solid = model.passage(&object.material).solid;
        let same = |p: &Program| {
            p.model.declaration.id == model.declaration.id
                && p.shading.declaration.id == shading.declaration.id
                && p.passage.solid == solid
        };
        let program = match self.programs.iter().position(same) {
            Some(program) => program,
            None => {
                let passage = passage_of(scene, model, solid);
                let shader = compose(&self.lights, registry, (model, passage), shading, host)?;
                self.programs.push(Program { model, passage, shading, shader });
                self.programs.len() - 1
            }
        };
        let values = self.values(program, object);
        let key = shape.key(&object.shape, object.tessellation);
        // Debug distinguishes all numbers.
        let look = (program, format!("{values:?}"), solid.then(|| key.clone()));
        let material = *known.materials.entry(look).or_insert_with(|| {
            let material = self.material(program, values);
            self.materials.push(material);
            self.materials.len() - 1
        });
        let faces = self.programs[program].faces();
        let mesh = *known.meshes.entry((key, faces)).or_insert_with(|| {
            let tessellation = shape.tessellation(object.tessellation);
            let polygons = shape.mesh(&object.shape, tessellation);
            let mesh = if faces { Vertices::apart(&polygons) } else { Vertices::shared(&polygons) };
            let suffix = if faces { "_polygons" } else { "" };
            let base = format!("{}_{tessellation}{suffix}", shape.declaration.id);
            self.meshes.push(data(known.names.unique(base), mesh));
            self.meshes.len() - 1
        });
        self.objects.push(Drawn { index, material, mesh });
        Ok(())
    }

    /// The values of an object that its models use.
    fn values(&self, program: usize, object: &Object) -> Values {
        let Program { model, shading, .. } = &self.programs[program];
        let used: Vec<Parameter> = model.parameters.iter().chain(shading.parameters).cloned().collect();
        object.material.legal(&used)
    }

    fn material(&self, program: usize, values: Values) -> Material {
        let Program { model, shading, shader, .. } = &self.programs[program];
        let encoding = self.request.scene.display.encoding;
        let parameters = pack(model.parameters, &values, encoding);
        let curve = if shader.reads_curve {
            let row = model.row(&values, encoding, self.lights.uniform);
            row[parameters.len().next_multiple_of(16)..].to_vec()
        } else {
            Vec::new()
        };
        let lobes = if shader.reads_lobes {
            model.instantiate(&values, encoding).lobes().bytes()
        } else {
            Vec::new()
        };
        let interior = if shader.reads_body {
            let inside = model.instantiate(&values, encoding).interior().unwrap_or(Interior::AIR);
            let rows = inside.rows(self.programs[program].shading.declaration.faceted);
            rows.into_iter().flat_map(|row| row.to_array()).flat_map(f32::to_le_bytes).collect()
        } else {
            Vec::new()
        };
        let own = if shader.reads_shading { pack(shading.parameters, &values, encoding) } else { Vec::new() };
        Material { program, values, parameters, curve, lobes, interior, shading: own }
    }

    /// Sentences about differences from the picture in the lab.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let edited =
            self.request.registry.sources().get(WRAPPER.path).is_some_and(|text| text != WRAPPER.text);
        let note = "The edited wrapper.wgsl is not exported: the export has its own entry points.";
        let mut notes: Vec<_> = edited.then(|| note.to_owned()).into_iter().collect();
        if self.lights.has_extent() {
            notes.push(format!(
                "Lights with extent are sampled {LIGHT_SAMPLES} times per pixel, which leaves some noise; the lights themselves are not \
                 visible."
            ));
        }
        notes.extend(self.lights.notes.iter().cloned());
        notes
    }

    /// The factor of the exposure.
    #[must_use]
    pub fn exposure(&self) -> f32 {
        exposure_factor(self.request.scene.display.exposure)
    }

    /// The background as the display shows it, at its upper edge: the colour that the scene gives, or the neutral grey,
    /// which is changed by tone mapping, but not by exposure.
    #[must_use]
    pub fn background(&self) -> Vec3 {
        let display = &self.request.scene.display;
        display.behind(0.0).unwrap_or_else(|| display.tone_mapping.map(Encoding::Srgb.decode(BACKGROUND)))
    }

    /// The colours of a gradient in the background, sRGB-encoded: at the upper and at the lower edge of the picture.
    #[must_use]
    pub fn gradient(&self) -> Option<[[u8; 3]; 2]> {
        let display = &self.request.scene.display;
        display.backdrop().filter(|_| display.background == Background::Gradient)
    }
}

/// The passage of light through the objects that share a shader: all solid bodies of a model, or all others.
#[must_use]
pub fn passage_of(scene: &Scene, model: &ModelEntry, solid: bool) -> Passage {
    let own = scene.objects.iter().filter(|object| scene.model_of(object) == model.declaration.id);
    let passages = own.map(|object| model.passage(&object.material)).filter(|passage| passage.solid == solid);
    passages.fold(Passage { solid, ..Passage::NONE }, |all, one| all | one)
}

fn data(name: String, mesh: Vertices) -> MeshData {
    let attribute = |(says, values): (Says, _)| Attribute { name: says.name(), values };
    MeshData { name, attributes: mesh.attributes.into_iter().map(attribute).collect(), indices: mesh.indices }
}
