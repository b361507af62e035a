//! The parts of a scene, each read from its JSON object. Unreadable values are replaced by defaults.

use glam::Vec3;

use super::{
    Reader,
    keys::{
        COMPARISON_KEYS, DISPLAY_KEYS, LIGHT_ALTERNATIVES, OBSERVER_KEYS, SCENE_KEYS, SIZE_KEYS, VARIANT_KEYS,
    },
    values::{COLOUR_RULE, rule_of},
};
use crate::{
    light::LightEntry,
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::Values,
    scene::{
        DEFAULT_DIMENSION, DEFAULT_REFLECTION_MODEL, DEFAULT_SHADING_MODEL, Display, Light, MAX_DIMENSION,
        Object, Observer, Scene, SceneSize, Variant, check,
        comparison::{Channel, Compared, Comparison, Edge, Layout, Sign},
        variant::LETTERS,
    },
    text::json::{Cursor, Fields, Reader as _},
};

impl Reader<'_> {
    pub(super) fn scene(&mut self, root: Cursor) -> Scene {
        let mut scene = Scene { name: None, description: None, ..Scene::default() };
        let Some(fields) = self.fields(root, SCENE_KEYS, "a scene") else { return scene };

        scene.name = self.text_field(&fields, "name", "the name must be text");
        scene.description = self.text_field(&fields, "description", "the description must be text");
        self.text_field(&fields, "$schema", "the address of the schema must be text");
        scene.scene_size = self.scene_size(&fields);
        for (key, default, to) in [
            ("reflection_model", DEFAULT_REFLECTION_MODEL, &mut scene.reflection_model),
            ("shading_model", DEFAULT_SHADING_MODEL, &mut scene.shading_model),
        ] {
            match fields.get(key) {
                None => self.missing(fields.path(key), fields.of.start(), default.to_owned()),
                Some(value) => *to = self.id(value, key).unwrap_or_else(|| default.to_owned()),
            }
        }
        scene.lights = self.list(&fields, "lights", check::light_count, Self::light);
        match fields.get("observer") {
            None => self.lacking(&fields, "observer", "a scene needs one observer"),
            Some(value) => match value.list() {
                Some(list) => {
                    let count = list.len();
                    let predicate = format!("is a list of {count}, but a scene has exactly one observer");
                    self.report(value.start(), value.path(), None, &predicate);
                }
                None => scene.observer = self.observer(value),
            },
        }
        scene.objects = self.list(&fields, "objects", check::object_count, Self::object);
        if let Some(value) = fields.get("display") {
            scene.display = self.display(value);
        }
        if fields.get("variants").is_some() {
            scene.variants = self.list(&fields, "variants", check::variant_count, Self::variant);
        }
        if let Some(value) = fields.get("comparison") {
            scene.comparison = self.comparison(value);
        }
        scene
    }

    fn variant(&mut self, value: Cursor) -> Variant {
        let mut variant = Variant::default();
        let Some(fields) = self.fields(value, VARIANT_KEYS, "a variant") else { return variant };
        variant.name = self.text_field(&fields, "name", "the name must be text");
        variant.based_on = self.text_field(&fields, "based_on", "this must be the name of another variant");
        let mut id = |key| self.id(fields.get(key)?, key);
        (variant.reflection_model, variant.shading_model) = (id("reflection_model"), id("shading_model"));
        if let Some(value) = fields.get("material") {
            variant.material = self.material(value);
        }
        variant.terms =
            self.choice(&fields, "terms", check::terms).and_then(|id| TermSelection::from_id(&id));
        variant.tone_mapping = self
            .choice(&fields, "tone_mapping", check::tone_mapping)
            .and_then(|id| ToneMapping::from_id(&id));
        variant.encoding =
            self.choice(&fields, "encoding", check::encoding).and_then(|id| Encoding::from_id(&id));
        variant.exposure = self.number_field(&fields, "exposure", check::exposure);
        if let Some(value) = fields.get("tessellation") {
            variant.tessellation = self.count(value, check::ANY_TESSELLATION);
        }
        variant
    }

    fn comparison(&mut self, value: Cursor) -> Comparison {
        let mut comparison = Comparison::default();
        let Some(fields) = self.fields(value, COMPARISON_KEYS, "comparison") else { return comparison };
        macro_rules! choose {
            ($($key:literal $field:ident $type:ident $rule:path,)+) => {
                $(if let Some(id) = self.choice(&fields, $key, $rule) {
                    comparison.$field = $type::from_id(&id).unwrap_or_default();
                })+
            };
        }
        choose! {
            "layout" layout Layout check::layout,
            "edge" edge Edge check::edge,
            "sign" sign Sign check::sign,
            "channel" channel Channel check::channel,
            "values" values Compared check::compared,
        }
        if let Some(letter) = self.choice(&fields, "with", check::view_letter) {
            comparison.with = LETTERS.iter().position(|known| *known == letter).unwrap_or(comparison.with);
        }
        comparison.split = self.number_field(&fields, "split", check::split).unwrap_or(comparison.split);
        comparison.amplification = self.number_field(&fields, "amplification", check::amplification);
        comparison
    }

    fn scene_size(&mut self, scene: &Fields) -> SceneSize {
        let Some(value) = scene.get("scene_size") else {
            let d = DEFAULT_DIMENSION;
            self.missing(scene.path("scene_size"), scene.of.start(), format!("{d} × {d} × {d} m"));
            return SceneSize::default();
        };
        self.size(value)
    }

    /// The size of the room.
    pub(in crate::scene) fn size(&mut self, value: Cursor) -> SceneSize {
        let mut size = SceneSize::default();
        // While its size is unknown, the room counts as large as possible, so that positions do not seem to be outside.
        let unknown = SceneSize { height: MAX_DIMENSION, width: MAX_DIMENSION, depth: MAX_DIMENSION };
        let Some(fields) = self.fields(value, SIZE_KEYS, "scene_size") else { return unknown };
        let extents = [("height", &mut size.height), ("width", &mut size.width), ("depth", &mut size.depth)];
        for (axis, to) in extents {
            match fields.get(axis) {
                None => self.missing(fields.path(axis), fields.of.start(), format!("{DEFAULT_DIMENSION} m")),
                Some(value) => {
                    let rule = rule_of(check::dimension(axis, f32::NAN));
                    *to = self.number(value, &rule).unwrap_or(MAX_DIMENSION);
                }
            }
        }
        size
    }

    pub(in crate::scene) fn light(&mut self, value: Cursor) -> Light {
        let mut light = Light { position: None, ..Light::default() };
        let keys = self.light_keys.clone();
        let Some(fields) = self.fields(value, &keys, "a light") else { return light };
        match fields.get("type") {
            None => self.lacking(&fields, "type", &self.id_rule("light type")),
            Some(value) => light.light_type = self.id(value, "light type").unwrap_or_default(),
        }
        let entry = self.registry.light(&light.light_type);
        light.name = self.text_field(&fields, "name", "the name must be text");
        light.enabled = self.flag(&fields, "enabled", true, "enabled must be true or false");
        light.position = fields.get("position").map(|value| self.vector(value, "a position"));
        light.direction = fields.get("direction").map(|value| self.vector(value, "a direction"));
        if let Some(value) = fields.get("colour") {
            light.colour = self.colour(value, COLOUR_RULE).unwrap_or(light.colour);
        }
        light.intensity = entry.map_or(light.intensity, |e| e.declaration.default_intensity);
        let intensity = self.number_field(&fields, "intensity", check::intensity);
        light.intensity = intensity.unwrap_or(light.intensity);
        light.luminous_flux = self.number_field(&fields, "luminous_flux", check::luminous_flux);
        light.colour_temperature =
            self.number_field(&fields, "colour_temperature", check::colour_temperature);
        for [one, other] in LIGHT_ALTERNATIVES {
            // The check reports that the type has no flux, which is enough.
            let possible = other != "luminous_flux" || entry.is_none_or(LightEntry::has_flux);
            if let (Some(_), Some(value), true) = (fields.get(one), fields.get(other), possible) {
                let predicate = format!("conflicts with {one}; a light has one or the other");
                self.report(value.start(), value.path(), None, &predicate);
            }
        }
        for (key, value) in fields.iter() {
            let own = entry.and_then(|e| e.parameter(key));
            let of_any = || self.registry.lights().iter().flat_map(|l| l.parameters);
            if let Some(parameter) = own.or_else(|| of_any().find(|p| p.name == key))
                && let Some(value) = self.parameter(value, parameter)
            {
                light.parameters.set(parameter.name, value);
            }
        }
        light
    }

    pub(in crate::scene) fn observer(&mut self, value: Cursor) -> Observer {
        let mut observer = Observer { position: Vec3::NAN, ..Observer::default() };
        let Some(fields) = self.fields(value, OBSERVER_KEYS, "the observer") else { return observer };
        for (key, what, to) in [
            ("position", "a position", &mut observer.position),
            ("direction", "a direction", &mut observer.direction),
        ] {
            match fields.get(key) {
                None => self.lacking(&fields, key, "the observer needs one"),
                Some(value) => *to = self.vector(value, what),
            }
        }
        let degrees = self.number_field(&fields, "field_of_view", check::field_of_view);
        observer.field_of_view = degrees.unwrap_or(observer.field_of_view);
        observer
    }

    pub(in crate::scene) fn object(&mut self, value: Cursor) -> Object {
        let mut object = Object { position: Vec3::NAN, ..Object::default() };
        let keys = std::mem::take(&mut self.object_keys);
        let fields = self.fields(value, &keys, "an object");
        self.object_keys = keys;
        let Some(fields) = fields else { return object };
        match fields.get("type") {
            None => self.lacking(&fields, "type", &self.id_rule("object type")),
            Some(value) => object.object_type = self.id(value, "object type").unwrap_or(object.object_type),
        }
        object.name = self.text_field(&fields, "name", "the name must be text");
        object.visible = self.flag(&fields, "visible", true, "visible must be true or false");
        match fields.get("position") {
            None => self.lacking(&fields, "position", "an object needs one"),
            Some(value) => object.position = self.vector(value, "a position"),
        }
        object.size = self.number_field(&fields, "size", check::size).unwrap_or(object.size);
        if let Some(value) = fields.get("rotation") {
            object.rotation = self.vector(value, "a rotation");
        }
        if let Some(value) = fields.get("tessellation") {
            let rule = match self.registry.shape(&object.object_type) {
                Some(shape) => check::tessellation_rule(shape),
                None => "the tessellation must be a whole number".to_owned(),
            };
            object.tessellation = self.count(value, &rule);
        }
        let mut id = |key| self.id(fields.get(key)?, key);
        (object.reflection_model, object.shading_model) = (id("reflection_model"), id("shading_model"));
        if let Some(value) = fields.get("material") {
            object.material = self.material(value);
        }
        let own = self.registry.shape(&object.object_type).map_or(&[][..], |shape| shape.parameters);
        let of_any = || self.registry.shapes().iter().flat_map(|shape| shape.parameters);
        let declared = |key| own.iter().chain(of_any()).find(|p| p.name == key);
        let given: Vec<_> = fields.iter().filter_map(|(key, value)| Some((declared(key)?, value))).collect();
        for (parameter, value) in given {
            if let Some(value) = self.parameter(value, parameter) {
                object.shape.set(parameter.name, value);
            }
        }
        object
    }

    /// A non-negative whole number.
    fn count(&mut self, value: Cursor, rule: &str) -> Option<u32> {
        let count = self.integer(value, rule)?;
        u32::try_from(count).map_err(|_| self.wrong(value, rule)).ok()
    }

    fn material(&mut self, value: Cursor) -> Values {
        let mut values = Values::default();
        let keys = std::mem::take(&mut self.material_keys);
        let fields = self.fields(value, &keys, "a material");
        self.material_keys = keys;
        for (key, value) in fields.iter().flat_map(Fields::iter) {
            if let Some(parameter) = self.registry.material_parameter(key)
                && let Some(value) = self.parameter(value, parameter)
            {
                values.set(parameter.name, value);
            }
        }
        values
    }

    pub(in crate::scene) fn display(&mut self, value: Cursor) -> Display {
        let mut display = Display::default();
        let Some(fields) = self.fields(value, DISPLAY_KEYS, "display") else { return display };
        if let Some(id) = self.choice(&fields, "tone_mapping", check::tone_mapping) {
            display.tone_mapping = ToneMapping::from_id(&id).unwrap_or_default();
        }
        if let Some(id) = self.choice(&fields, "encoding", check::encoding) {
            display.encoding = Encoding::from_id(&id).unwrap_or_default();
        }
        display.exposure = self.number_field(&fields, "exposure", check::exposure).unwrap_or_default();
        display
    }
}
