//! Values of materials that must change with the model, since models may give a parameter different ranges.

use super::{Part, Scene, check::Declared, variant::LETTERS};
use crate::registry::Registry;

impl Scene {
    /// Replaces every number of a material that its object's model does not allow by the nearest one that it
    /// allows. Returns one sentence for each.
    pub fn bring_into_range(&mut self, registry: &Registry) -> Vec<String> {
        (0..self.objects.len()).flat_map(|i| self.bring_object_into_range(i, registry)).collect()
    }

    /// The same for one object.
    pub(super) fn bring_object_into_range(&mut self, i: usize, registry: &Registry) -> Vec<String> {
        let (mut said, mut changes) = (Vec::new(), Vec::new());
        let object = &self.objects[i];
        for (name, value) in &object.material.0 {
            let declared = Declared::of(registry, self, object, name);
            let Err(Some(rule)) = declared.refusing(value) else { continue };
            let Some(nearest) = declared.nearest(value) else { continue };
            let place = Part::Object(i).path().key("material").key(name.clone());
            let (model, rule) = (self.model_of(object), rule.rule());
            said.push(format!("{place} is {value}, but for {model} it must be {rule}: {nearest} is used"));
            changes.push((name.clone(), nearest));
        }
        self.objects[i].material.0.extend(changes);
        said
    }

    /// The sentences for a valid scene, about views that override a model.
    #[must_use]
    pub fn beyond_the_range_of_views(&self, registry: &Registry) -> Vec<String> {
        let view = |view: usize| {
            let said = self
                .overrides(view)
                .map(|variant| variant.laid_over(self, registry).bring_into_range(registry));
            said.unwrap_or_default().into_iter().map(move |said| format!("view {}: {said}", LETTERS[view]))
        };
        (1..=self.variants.len()).flat_map(view).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{custom, parameter::Value, scene::Variant};

    #[test]
    fn a_view_takes_the_nearest_value_and_says_so() {
        let mut registry = Registry::builtin();
        for (id, most) in [("first", 90), ("second", 1)] {
            let text = format!(
                "/* lcm {{ \"parameters\": [{{ \"name\": \"tilt\", \"max\": {most} }}] }} */\nfn response(l: vec3<f32>, v: \
                 vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    return Terms(vec3(0.0), vec3(m.tilt), \
                 vec3(0.0));\n}}\n"
            );
            let model = custom::read(format!("models/{id}.wgsl").as_ref(), &text, &registry).expect("valid");
            registry.put_custom_model(model);
        }
        let mut scene = Scene { reflection_model: "first".to_owned(), ..Scene::default() };
        scene.objects[0].material.set("tilt", Value::Number(80.0));
        scene.variants = vec![Variant { reflection_model: Some("second".to_owned()), ..Variant::default() }];
        assert_eq!(scene.clone().bring_into_range(&registry), Vec::<String>::new());
        let expected = "objects[0].material.tilt is 80, but for second it must be between 0 and 1: 1 is used";
        assert_eq!(scene.beyond_the_range_of_views(&registry), [format!("view B: {expected}")]);
        let (seen, _) = scene.seen(1, &registry).expect("there is a view B");
        assert_eq!(seen.objects[0].material.0["tilt"], Value::Number(1.0), "the nearest, not the default");
        scene.reflection_model = "second".to_owned();
        assert_eq!(scene.bring_into_range(&registry), [expected]);
    }
}
