//! The changes that can be made to a scene, and their names in the history.

use std::{f64::consts::GOLDEN_RATIO, iter};

use glam::Vec3;

use super::{
    Document, Extent, Selection,
    history::Patch,
    names::{light_type, object_type},
};
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::Value,
    registry::Registry,
    scene::{
        Comparison, Display, Light, Object, Observer, Scene, SceneSize, Variant, check, variant::LETTERS,
    },
    text::capitalised,
};

/// A change of the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// The name of the scene; empty for none.
    SceneName(String),
    /// The description of the scene; empty for none.
    SceneDescription(String),
    /// The extent of the room.
    SceneSize(SceneSize),
    /// Tone mapping, exposure and encoding.
    Display(Display),
    /// The reflection model of the scene.
    Model(String),
    /// The shading model of the scene.
    ShadingModel(String),
    /// The observer.
    Observer(Observer),
    /// A field of a light.
    Light(usize, LightField),
    /// A field of an object.
    Object(usize, ObjectField),
    /// A field of a variant.
    Variant(usize, VariantField),
    /// All variants, if some are added, removed or reordered, together with the resulting comparison of the
    /// views.
    Views {
        /// The variants.
        variants: Vec<Variant>,
        /// The comparison.
        comparison: Comparison,
        /// The name of the step.
        step: &'static str,
    },
    /// The way in which views are compared.
    Comparison(Comparison),
}

/// A field of a variant with its new value; `None` if it is inherited.
#[derive(Clone, Debug, PartialEq)]
pub enum VariantField {
    /// The name; empty for none.
    Name(String),
    /// The reflection model of every object.
    Model(Option<String>),
    /// The shading model of every object.
    ShadingModel(Option<String>),
    /// A parameter of the material of every object.
    Material(&'static str, Option<Value>),
    /// Several parameters at once: those of a match, or of a measured material.
    Materials(Vec<(&'static str, Value)>, &'static str),
    /// The displayed terms.
    Terms(Option<TermSelection>),
    /// The tone mapping.
    ToneMapping(Option<ToneMapping>),
    /// The exposure.
    Exposure(Option<f32>),
    /// The encoding.
    Encoding(Option<Encoding>),
    /// The tessellation of every object.
    Tessellation(Option<u32>),
}

impl VariantField {
    /// The name of the field within the name of a step.
    fn label(&self, registry: &Registry) -> String {
        match self {
            Self::Name(_) => "Name",
            Self::Model(_) => "Reflection model",
            Self::ShadingModel(_) => "Shading model",
            Self::Material(id, _) => registry.material_parameter(id).map_or(*id, |p| p.label),
            Self::Materials(_, what) => what,
            Self::Terms(_) => "Terms",
            Self::ToneMapping(_) => "Tone mapping",
            Self::Exposure(_) => "Exposure",
            Self::Encoding(_) => "Encoding",
            Self::Tessellation(_) => "Tessellation",
        }
        .to_owned()
    }

    /// Sets this field of a variant.
    pub(super) fn put(self, variant: &mut Variant) {
        match self {
            Self::Name(name) => variant.name = named(&name),
            Self::Model(id) => variant.reflection_model = id,
            Self::ShadingModel(id) => variant.shading_model = id,
            Self::Material(name, Some(value)) => variant.material.set(name, value),
            Self::Material(name, None) => _ = variant.material.0.remove(name),
            Self::Materials(all, _) => {
                all.into_iter().for_each(|(name, value)| variant.material.set(name, value));
            }
            Self::Terms(terms) => variant.terms = terms,
            Self::ToneMapping(tone) => variant.tone_mapping = tone,
            Self::Exposure(ev) => variant.exposure = ev,
            Self::Encoding(encoding) => variant.encoding = encoding,
            Self::Tessellation(count) => variant.tessellation = count,
        }
    }
}

/// A field of a light with its new value.
#[derive(Clone, Debug, PartialEq)]
pub enum LightField {
    /// The name; empty for none.
    Name(String),
    /// False if the light is switched off.
    Enabled(bool),
    /// The type.
    Type(String),
    /// The position.
    Position(Vec3),
    /// The direction in which the light shines.
    Direction(Vec3),
    /// The colour, instead of a colour temperature.
    Colour([u8; 3]),
    /// The colour temperature in kelvin, instead of a colour.
    ColourTemperature(f32),
    /// The intensity, instead of a luminous flux.
    Intensity(f32),
    /// The luminous flux in lumen, instead of an intensity.
    LuminousFlux(f32),
    /// A parameter of the type.
    Parameter(&'static str, Value),
}

/// A field of an object with its new value.
#[derive(Clone, Debug, PartialEq)]
pub enum ObjectField {
    /// The name; empty for none.
    Name(String),
    /// False if the object is hidden.
    Visible(bool),
    /// The type.
    Type(String),
    /// The position of the centre.
    Position(Vec3),
    /// The largest extent.
    Size(f32),
    /// Euler angles XYZ, degrees.
    Rotation(Vec3),
    /// The tessellation; `None` for the default of the type.
    Tessellation(Option<u32>),
    /// The override of the reflection model; `None` for the scene's.
    Model(Option<String>),
    /// The override of the shading model; `None` for the scene's.
    ShadingModel(Option<String>),
    /// A parameter of the type.
    Shape(&'static str, Value),
    /// A parameter of the material.
    Material(&'static str, Value),
    /// Several parameters of the material at once: a measured material.
    Preset(Vec<(&'static str, Value)>),
}

/// A text as a name; `None` if it is blank.
fn named(text: &str) -> Option<String> {
    Some(text.trim().to_owned()).filter(|text| !text.is_empty())
}

impl LightField {
    /// The name of the field within the name of a step.
    fn label(&self, light: &Light, registry: &Registry) -> String {
        match self {
            Self::Name(_) => "Name",
            Self::Enabled(true) => "Switch on",
            Self::Enabled(false) => "Switch off",
            Self::Type(_) => "Type",
            Self::Position(_) => "Position",
            Self::Direction(_) => "Direction",
            Self::Colour(_) => "Colour",
            Self::ColourTemperature(_) => "Colour temperature",
            Self::Intensity(_) => "Intensity",
            Self::LuminousFlux(_) => "Luminous flux",
            Self::Parameter(id, _) => {
                let declared = registry.light(&light.light_type).and_then(|entry| entry.parameter(id));
                return declared.map_or(*id, |p| p.label).to_owned();
            }
        }
        .to_owned()
    }

    fn put(self, light: &mut Light, registry: &Registry, room: SceneSize) {
        // A missing field gets the value that it has when the file is reloaded.
        match self {
            Self::Name(name) => light.name = named(&name),
            Self::Enabled(on) => light.enabled = on,
            Self::Type(id) => {
                registry.light(&id).into_iter().for_each(|entry| light.set_type(entry, registry, room));
            }
            Self::Position(p) => light.position = Some(p),
            Self::Direction(d) => light.direction = Some(d),
            Self::Colour(c) => (light.colour, light.colour_temperature) = (c, None),
            Self::ColourTemperature(kelvin) => {
                (light.colour, light.colour_temperature) = (Light::default().colour, Some(kelvin));
            }
            Self::Intensity(v) => (light.intensity, light.luminous_flux) = (v, None),
            Self::LuminousFlux(v) => {
                let entry = registry.light(&light.light_type);
                light.intensity = entry.map_or(light.intensity, |e| e.declaration.default_intensity);
                light.luminous_flux = Some(v);
            }
            Self::Parameter(name, value) => light.parameters.set(name, value),
        }
    }
}

impl ObjectField {
    /// The name of the field within the name of a step.
    fn label(&self, object: &Object, registry: &Registry) -> String {
        match self {
            Self::Name(_) => "Name",
            Self::Visible(true) => "Show",
            Self::Visible(false) => "Hide",
            Self::Type(_) => "Type",
            Self::Position(_) => "Position",
            Self::Size(_) => "Size",
            Self::Rotation(_) => "Rotation",
            Self::Tessellation(_) => "Tessellation",
            Self::Model(_) => "Reflection model",
            Self::ShadingModel(_) => "Shading model",
            Self::Shape(id, _) => {
                let declared = registry.shape(&object.object_type).and_then(|shape| shape.parameter(id));
                declared.map_or(*id, |p| p.label)
            }
            Self::Material(id, _) => registry.material_parameter(id).map_or(*id, |p| p.label),
            Self::Preset(_) => "Measured material",
        }
        .to_owned()
    }

    fn put(self, o: &mut Object, registry: &Registry) {
        match self {
            Self::Name(name) => o.name = named(&name),
            Self::Visible(on) => o.visible = on,
            Self::Type(id) => registry.shape(&id).into_iter().for_each(|entry| o.set_type(entry)),
            Self::Position(p) => o.position = p,
            Self::Size(v) => o.size = v,
            Self::Rotation(r) => o.rotation = r,
            Self::Tessellation(n) => o.tessellation = n,
            Self::Model(id) => o.reflection_model = id,
            Self::ShadingModel(id) => o.shading_model = id,
            Self::Shape(name, value) => o.shape.set(name, value),
            Self::Material(name, value) => o.material.set(name, value),
            Self::Preset(all) => all.into_iter().for_each(|(name, value)| o.material.set(name, value)),
        }
    }
}

/// Sets a field of a variant of a scene. Variants based on it follow a change of its name.
pub(super) fn put_in_variant(scene: &mut Scene, i: usize, field: VariantField) {
    let Some(variant) = scene.variants.get_mut(i) else { return };
    let before = variant.name.clone();
    field.put(variant);
    let after = variant.name.clone();
    if before != after && before.is_some() {
        for other in scene.variants.iter_mut().filter(|other| other.based_on == before) {
            other.based_on.clone_from(&after);
        }
    }
}

/// The name of a step: "Hide Sphere 1", "Size of Sphere 1".
fn step(label: &str, part: &str) -> String {
    match label {
        "Show" | "Hide" | "Switch on" | "Switch off" => format!("{label} {part}"),
        _ => format!("{} of {part}", capitalised(label)),
    }
}

impl Document {
    /// Makes a change, if the rules of scenes allow it. `selection` is the current selection.
    ///
    /// # Errors
    /// Returns the reason for a refusal; the scene then stays unchanged.
    pub fn edit(&mut self, edit: Edit, selection: Selection, registry: &Registry) -> Result<(), String> {
        self.check(&edit, registry)?;
        let rest = |document: &mut Self, name: &str, change: &mut dyn FnMut(&mut Scene)| {
            document.change(name, Extent::Rest, selection, change);
        };
        match edit {
            Edit::SceneName(name) => rest(self, "Name of the scene", &mut |s| s.name = named(&name)),
            Edit::SceneDescription(text) => {
                rest(self, "Description of the scene", &mut |s| s.description = named(&text));
            }
            Edit::SceneSize(size) => rest(self, "Size of the room", &mut |s| s.scene_size = size),
            Edit::Display(display) => {
                let now = self.scene.display;
                let name = if now.exposure != display.exposure {
                    "Exposure"
                } else if now.tone_mapping != display.tone_mapping {
                    "Tone mapping"
                } else {
                    "Display"
                };
                rest(self, name, &mut |s| s.display = display);
            }
            Edit::Model(id) => {
                let name = registry.model(&id).map_or(&*id, |m| m.declaration.name);
                let step = format!("Reflection model: {name}");
                rest(self, &step, &mut |s| s.reflection_model.clone_from(&id));
            }
            Edit::ShadingModel(id) => {
                let name = registry.shading_model(&id).map_or(&*id, |m| m.declaration.name);
                let step = format!("Shading model: {name}");
                rest(self, &step, &mut |s| s.shading_model.clone_from(&id));
            }
            Edit::Observer(observer) => rest(self, "Observer", &mut |s| s.observer = observer),
            Edit::Variant(i, field) => {
                let name = step(&field.label(registry), &format!("view {}", LETTERS[i + 1]));
                rest(self, &name, &mut |s| put_in_variant(s, i, field.clone()));
            }
            Edit::Views { variants, comparison, step } => rest(self, step, &mut |s| {
                s.variants.clone_from(&variants);
                s.comparison = comparison;
            }),
            Edit::Comparison(comparison) => rest(self, "Comparison", &mut |s| s.comparison = comparison),
            Edit::Light(i, LightField::Type(id)) => {
                self.change_light_type(i, &id, None, selection, registry)?;
            }
            Edit::Light(i, field) => {
                let label = field.label(&self.scene.lights[i], registry);
                let name = step(&label, &self.name_of(Selection::Light(i), registry));
                self.step(name, Extent::Light(i), selection, Some(registry), |document| {
                    let room = document.scene_size;
                    let before = document.scene.lights[i].name.clone();
                    field.put(&mut document.scene.lights[i], registry, room);
                    if document.scene.lights[i].name != before {
                        document.number_again(Selection::Light(i), registry);
                    }
                });
            }
            Edit::Object(i, field) => {
                let mut name = step(
                    &field.label(&self.scene.objects[i], registry),
                    &self.name_of(Selection::Object(i), registry),
                );
                if let ObjectField::Type(id) = &field {
                    name += &format!(": {}", object_type(id, registry));
                }
                self.step(name, Extent::Object(i), selection, Some(registry), |document| {
                    let before = document.scene.objects[i].name.clone();
                    field.put(&mut document.scene.objects[i], registry);
                    if document.scene.objects[i].name != before {
                        document.number_again(Selection::Object(i), registry);
                    }
                });
            }
        }
        Ok(())
    }

    /// Changes the type of a light and adds everything that the new type requires. `place` is the position
    /// and direction for a light without them; by default, the light is in the middle of the room and shines
    /// down.
    ///
    /// # Errors
    /// Returns the reason for a refusal; the scene then stays unchanged.
    pub fn change_light_type(
        &mut self,
        i: usize,
        id: &str,
        place: Option<(Vec3, Vec3)>,
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        let field = LightField::Type(id.to_owned());
        self.check(&Edit::Light(i, field.clone()), registry)?;
        let part = self.name_of(Selection::Light(i), registry);
        let name = format!("{}: {}", step("Type", &part), light_type(id, registry));
        self.step(name, Extent::Light(i), selection, Some(registry), |document| {
            let room = document.scene.scene_size;
            let light = &mut document.scene.lights[i];
            let has_place = light.position.is_some();
            if let Some((position, direction)) = place.filter(|(_, d)| check::direction(*d).is_ok()) {
                light.position.get_or_insert(position);
                light.direction.get_or_insert(direction);
            }
            field.put(light, registry, room);
            if let Some(position) = light.position.filter(|_| !has_place) {
                // Distinct heights, however many other lights are in the way.
                let height = |k: usize| (k as f64 * GOLDEN_RATIO).fract() as f32 * room.height;
                let column =
                    (1..document.scene.objects.len() + 3).map(|k| (0.5 * room.corner()).with_y(height(k)));
                let is_free =
                    |p: &Vec3| document.check(&Edit::Light(i, LightField::Position(*p)), registry).is_ok();
                let free = iter::once(position).chain(column).find(is_free);
                document.scene.lights[i].position = free;
            }
        });
        Ok(())
    }

    /// Inserts a light into the list. `verb` begins the name of the step: "Add", "Duplicate".
    pub fn insert_light(
        &mut self,
        i: usize,
        light: Light,
        verb: &str,
        selection: Selection,
        registry: &Registry,
    ) {
        let label = self.next_label();
        self.labels.lights.insert(i, label);
        self.scene.lights.insert(i, light.clone());
        self.number_parts(Some(registry));
        let patch = Patch::of_lights(i, Vec::new(), vec![(self.labels.lights[i], light)]);
        let name = format!("{verb} {}", self.name_of(Selection::Light(i), registry));
        self.came_or_went(patch, name, selection);
    }

    /// Inserts an object into the list.
    pub fn insert_object(
        &mut self,
        i: usize,
        object: Object,
        verb: &str,
        selection: Selection,
        registry: &Registry,
    ) {
        let label = self.next_label();
        self.labels.objects.insert(i, label);
        self.scene.objects.insert(i, object.clone());
        self.number_parts(Some(registry));
        let patch = Patch::of_objects(i, Vec::new(), vec![(self.labels.objects[i], object)]);
        let name = format!("{verb} {}", self.name_of(Selection::Object(i), registry));
        self.came_or_went(patch, name, selection);
    }

    /// Removes a light or an object.
    pub fn remove(&mut self, part: Selection, registry: &Registry) {
        let name = self.name_of(part, registry);
        let patch = match part {
            Selection::Light(i) if i < self.scene.lights.len() => {
                let gone = (self.labels.lights.remove(i), self.scene.lights.remove(i));
                Patch::of_lights(i, vec![gone], Vec::new())
            }
            Selection::Object(i) if i < self.scene.objects.len() => {
                let gone = (self.labels.objects.remove(i), self.scene.objects.remove(i));
                Patch::of_objects(i, vec![gone], Vec::new())
            }
            _ => return,
        };
        self.came_or_went(patch, format!("Delete {name}"), part);
    }

    /// Records that a part was added or removed, as a separate step.
    fn came_or_went(&mut self, patch: Patch, name: String, selection: Selection) {
        self.end_gesture();
        self.touch(Extent::All, true);
        self.history.record(name, self.gesture, patch, selection);
    }
}
