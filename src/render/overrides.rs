//! The differences between a view and the scene: another reflection model, other parameters, another exposure.

use bevy::ecs::component::Component;

use crate::{
    channel::Setting,
    optics::TermSelection,
    parameter::Values,
    reflection::{ModelEntry, Passage},
    registry::Registry,
    scene::{Background, Display, Object, Scene},
};

/// The differences between a view and the scene. A component of the view's camera.
#[derive(Clone, Component, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The reflection model of every object.
    pub reflection_model: Option<String>,
    /// The shading model of every object.
    pub shading_model: Option<String>,
    /// Parameters of every object; other parameters are unchanged.
    pub parameters: Values,
    /// The displayed terms of the equation.
    pub terms: Option<TermSelection>,
    /// Exposure, tone mapping and encoding.
    pub display: Option<Display>,
    /// The tessellation of every object, within the limits of its type.
    pub tessellation: Option<u32>,
    /// The debug channel shown instead of the picture.
    pub channel: Option<Setting>,
}

impl Overrides {
    /// The differences between a view of a scene and the scene itself; `None` for view 0 and for views that
    /// do not exist.
    #[must_use]
    pub fn of_view(scene: &Scene, view: usize) -> Option<Self> {
        let variant = scene.overrides(view)?;
        Some(Self {
            display: Some(variant.display(scene.display)),
            reflection_model: variant.reflection_model,
            shading_model: variant.shading_model,
            parameters: variant.material,
            terms: variant.terms,
            tessellation: variant.tessellation,
            channel: None,
        })
    }

    /// True if objects need the same shaders with both.
    #[must_use]
    pub fn has_shaders_of(&self, other: &Self) -> bool {
        (&self.reflection_model, &self.shading_model, &self.parameters)
            == (&other.reflection_model, &other.shading_model, &other.parameters)
    }

    /// The scene as the view shows it, except for the terms.
    #[must_use]
    pub fn applied(&self, scene: &Scene, registry: &Registry) -> Scene {
        let mut shown = Scene { display: self.display_of(scene), ..scene.clone() };
        shown.objects.iter_mut().for_each(|object| self.dress(object, registry));
        shown
    }

    /// Applies the overrides to an object.
    pub(super) fn dress(&self, object: &mut Object, registry: &Registry) {
        if self.reflection_model.is_some() {
            object.reflection_model.clone_from(&self.reflection_model);
        }
        if self.shading_model.is_some() {
            object.shading_model.clone_from(&self.shading_model);
        }
        if let (Some(count), Some(shape)) = (self.tessellation, registry.shape(&object.object_type)) {
            object.tessellation = Some(shape.tessellation(Some(count)));
        }
        object.material.0.extend(self.parameters.0.clone());
    }

    /// The reflection model and the shading model of an object in a view with these overrides, or without any.
    pub(super) fn models_of<'a>(of: Option<&'a Self>, scene: &'a Scene, object: &'a Object) -> [&'a str; 2] {
        match of {
            Some(of) => [of.model_of(scene, object), of.shading_model_of(scene, object)],
            None => [scene.model_of(object), scene.shading_model_of(object)],
        }
    }

    /// The passage of light through an object with a model in a view with these overrides, or without any.
    pub(super) fn passage_of(of: Option<&Self>, model: &ModelEntry, object: &Object) -> Passage {
        match of.filter(|of| model.passage_varies() && !of.parameters.0.is_empty()) {
            Some(of) => {
                let mut material = object.material.clone();
                material.0.extend(of.parameters.0.clone());
                model.passage(&material)
            }
            None => model.passage(&object.material),
        }
    }

    fn model_of<'a>(&'a self, scene: &'a Scene, object: &'a Object) -> &'a str {
        self.reflection_model.as_deref().unwrap_or_else(|| scene.model_of(object))
    }

    fn shading_model_of<'a>(&'a self, scene: &'a Scene, object: &'a Object) -> &'a str {
        self.shading_model.as_deref().unwrap_or_else(|| scene.shading_model_of(object))
    }

    /// The display settings applied to the picture. A debug channel is drawn as in its legend.
    #[must_use]
    pub fn seen_through(&self, scene: &Scene) -> Display {
        match &self.channel {
            Some(setting) if !setting.channel.is_picture() => Display::default(),
            // Numbers have no background.
            Some(setting) if setting.numbers => {
                Display { background: Background::default(), ..self.display_of(scene) }
            }
            _ => self.display_of(scene),
        }
    }

    pub(super) fn display_of(&self, scene: &Scene) -> Display {
        self.display.unwrap_or(scene.display)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Value;

    #[test]
    fn models_and_passage_are_those_of_an_object_with_the_overrides() {
        let registry = Registry::builtin();
        let scene = Scene::default();
        let own = Object { reflection_model: Some("openpbr".to_owned()), ..Object::default() };
        let mut glass = Overrides { shading_model: Some("flat".to_owned()), ..Overrides::default() };
        glass.parameters.set("transmission_weight", Value::Number(1.0));
        let phong = Overrides { reflection_model: Some("phong".to_owned()), ..glass.clone() };
        let mut passages = Vec::new();
        for overrides in [None, Some(&Overrides::default()), Some(&glass), Some(&phong)] {
            let mut dressed = own.clone();
            overrides.into_iter().for_each(|overrides| overrides.dress(&mut dressed, &registry));
            let models = Overrides::models_of(overrides, &scene, &own);
            assert_eq!(models, [scene.model_of(&dressed), scene.shading_model_of(&dressed)]);
            let model = registry.model(models[0]).expect("built in");
            let passage = Overrides::passage_of(overrides, model, &own);
            assert_eq!(passage, model.passage(&dressed.material));
            passages.push(passage);
        }
        assert!(passages[0] == passages[1] && passages[1] != passages[2], "the weight lets light through");
    }
}
