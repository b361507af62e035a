//! A whole scene with another reflection model.

use super::Scene;
use crate::{
    parameter::Values,
    reflection::{ModelEntry, carry::journey},
    registry::Registry,
};

impl Scene {
    /// Gives all objects and variants this reflection model. Values of their materials go along where the models declare
    /// [what corresponds](crate::reflection::carry), and by name otherwise.
    ///
    /// Copies of a row stay as their row says: of them, what differs from copy to copy does not go along.
    pub fn show_with(&mut self, id: &str, registry: &Registry) {
        let to = registry.model(id);
        let carry = |from: &str, material: &mut Values| {
            let from: Option<&ModelEntry> = registry.model(from).filter(|_| from != id);
            let Some((from, to)) = from.zip(to) else { return };
            let carried = journey(&[from], to, material).carried;
            carried.into_iter().for_each(|one| material.set(one.to.name, one.value));
        };
        let scene_model = std::mem::replace(&mut self.reflection_model, id.to_owned());
        let before: Vec<_> = self.objects.iter().map(|object| object.material.clone()).collect();
        for object in &mut self.objects {
            let own = object.reflection_model.take();
            carry(own.as_deref().unwrap_or(&scene_model), &mut object.material);
        }
        let rows: Vec<_> = self.rows().map(|row| row.range()).collect();
        let has_rows = !rows.is_empty();
        for row in rows {
            let Some(first) = self.objects.get(row.start).map(|object| object.material.clone()) else {
                continue;
            };
            let is_same = |name: &str| {
                self.objects[row.clone()].iter().all(|copy| copy.material.0.get(name) == first.0.get(name))
            };
            let differing: Vec<_> = self.objects[row.clone()]
                .iter()
                .flat_map(|copy| copy.material.0.keys())
                .filter(|name| !is_same(name))
                .cloned()
                .collect();
            for i in row {
                let Values(material) = &mut self.objects[i].material;
                // What the row itself varies was there before.
                for name in &differing {
                    match before[i].0.get(name) {
                        Some(value) => drop(material.insert(name.clone(), value.clone())),
                        None => drop(material.remove(name)),
                    }
                }
            }
        }
        if has_rows {
            self.follow_copies(registry);
        }
        for variant in &mut self.variants {
            let own = variant.reflection_model.take();
            carry(own.as_deref().unwrap_or(&scene_model), &mut variant.material);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::Value, scene::Variant};

    fn number(v: f32) -> Value {
        Value::Number(v)
    }

    #[test]
    fn materials_go_along_and_the_rest_stays_by_name() {
        let registry = Registry::builtin();
        let mut scene = Scene { reflection_model: "lambert".to_owned(), ..Scene::default() };
        scene.objects.push(scene.objects[0].clone());
        let object = &mut scene.objects[0];
        object.reflection_model = Some("disney".to_owned());
        object.material.set("clearcoat", number(0.5));
        object.material.set("roughness", number(0.3));
        // Of a model that the object does not have.
        scene.objects[1].material.set("clearcoat", number(0.5));
        let mut view = Variant { reflection_model: Some("disney".to_owned()), ..Variant::default() };
        view.material.set("clearcoat", number(1.0));
        scene.variants.push(view);
        scene.show_with("openpbr", &registry);
        let coat = |values: &Values| values.0.get("coat_weight").cloned();
        assert_eq!(scene.reflection_model, "openpbr");
        assert!(scene.objects.iter().all(|object| object.reflection_model.is_none()));
        assert_eq!(coat(&scene.objects[0].material), Some(number(0.125)));
        assert_eq!(scene.objects[0].material.0.get("roughness"), Some(&number(0.3)));
        assert_eq!(coat(&scene.objects[1].material), None);
        assert_eq!(scene.variants[0].reflection_model, None);
        assert_eq!(coat(&scene.variants[0].material), Some(number(0.25)));
        // A metal by n and k becomes one by its colour, which replaces that of the body.
        let mut gold = Scene { reflection_model: "cook_torrance".to_owned(), ..Scene::default() };
        gold.objects[0].material = Values::default();
        for (name, value) in [
            ("ior", Value::Triple([0.188_36, 0.543_86, 1.331_85])),
            ("extinction", Value::Triple([3.4034, 2.2309, 1.8693])),
            ("base_colour", Value::Colour([255; 3])),
        ] {
            gold.objects[0].material.set(name, value);
        }
        gold.show_with("disney", &registry);
        let has = |name: &str| gold.objects[0].material.0.get(name).cloned();
        assert_eq!(has("base_colour"), Some(Value::Colour([248, 218, 170])));
        assert_eq!(has("metallic"), Some(number(1.0)));
        // The same model changes nothing.
        let before = scene.clone();
        scene.show_with("openpbr", &registry);
        assert!(scene == before);
    }
}
