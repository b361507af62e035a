//! Variants: the scene with some things changed, to be compared with the scene as it is.
//!
//! The scene itself is view A; its variants are the views B, C and D. A variant inherits everything and overrides what
//! it gives.

use std::{collections::BTreeSet, iter};

pub use super::views::{LETTERS, MAX_VARIANTS};
use super::{
    Comparison, Display, Field, Object, Scene,
    display::EXPOSURE,
    field::{Ids, Kind},
    held::Word as _,
    part::{Fields as _, Key, Structure as _, part},
};
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::Values,
    registry::Registry,
    text::{did_you_mean, listed, quoted},
};

part! {
    /// The scene with some things changed. What is absent is inherited.
    pub struct Variant("a variant") {
        /// Name of the variant.
        name: Option<String> = Field::of("the name", Kind::Text(None)), None;
        /// Name of another variant from which it inherits, instead of the scene.
        based_on: Option<String> =
            Field::of("the base", Kind::Text(Some("this must be the name of another variant"))), None;
        /// Reflection model of every object.
        reflection_model: Option<String> = Field::of("the reflection model", Kind::Id(Ids::ReflectionModel)), None;
        /// Shading model of every object.
        shading_model: Option<String> = Field::of("the shading model", Kind::Id(Ids::ShadingModel)), None;
        /// Parameters of the material of every object.
        material: Values = Field::of("the material", Kind::Material), Values::default();
        /// Terms of the equation that are shown.
        terms: Option<TermSelection> = Field::of("the terms", Kind::Choice(TermSelection::words)), None;
        /// Tone mapping: the curve from light to display.
        tone_mapping: Option<ToneMapping> = Field::of("the tone mapping", Kind::Choice(ToneMapping::words)), None;
        /// Exposure in EV: each step up doubles the light.
        exposure: Option<f32> = EXPOSURE, None;
        /// `srgb`: colours are decoded before and encoded after the calculation. `off`: neither; deliberately wrong, for
        /// comparison.
        encoding: Option<Encoding> = Field::of("the encoding", Kind::Choice(Encoding::words)), None;
        /// Tessellation of every object, as far as the object's type allows it.
        tessellation: Option<u32> =
            Field::of("the tessellation of a variant", Kind::Count(1)).called("tessellation"), None;
    }
}

impl Variant {
    /// The display settings, where `inherited` are those of the scene.
    #[must_use]
    pub fn display(&self, inherited: Display) -> Display {
        let mut display = inherited;
        for key in Display::keys().into_iter().map(Key::Own) {
            if let Some(value) = self.value(key) {
                display.put(key, Some(value));
            }
        }
        display
    }

    /// The scene as the variant shows it: numbers that another model does not allow are replaced by the
    /// nearest that it allows. The terms are not included.
    #[must_use]
    pub fn applied(&self, scene: &Scene, registry: &Registry) -> Scene {
        let mut shown = self.laid_over(scene, registry);
        if self.chooses_models() {
            shown.bring_into_range(registry);
        }
        shown
    }

    /// True if another model may judge materials.
    fn chooses_models(&self) -> bool {
        self.reflection_model.is_some() || self.shading_model.is_some()
    }

    /// True if objects look the same with another variant, whatever else differs.
    #[must_use]
    pub fn shows_objects_like(&self, other: &Self) -> bool {
        let objects = |variant: &Self| Self {
            reflection_model: variant.reflection_model.clone(),
            shading_model: variant.shading_model.clone(),
            material: variant.material.clone(),
            tessellation: variant.tessellation,
            ..Self::default()
        };
        objects(self) == objects(other)
    }

    /// Shows one object of a scene as [`applied`](Self::applied) does.
    pub fn apply_to_object(&self, shown: &mut Scene, i: usize, registry: &Registry) {
        self.lay_over_object(&mut shown.objects[i], registry);
        if self.chooses_models() {
            shown.bring_object_into_range(i, registry);
        }
    }

    /// The scene as the variant shows it, with every number as written.
    pub(super) fn laid_over(&self, scene: &Scene, registry: &Registry) -> Scene {
        let mut shown = scene.clone();
        self.lay_over_rest(&mut shown);
        shown.objects.iter_mut().for_each(|object| self.lay_over_object(object, registry));
        shown
    }

    /// Sets everything but the objects of a scene.
    pub fn lay_over_rest(&self, shown: &mut Scene) {
        shown.display = self.display(shown.display);
        if let Some(id) = &self.reflection_model {
            shown.reflection_model.clone_from(id);
        }
        if let Some(id) = &self.shading_model {
            shown.shading_model.clone_from(id);
        }
    }

    fn lay_over_object(&self, object: &mut Object, registry: &Registry) {
        if self.reflection_model.is_some() {
            object.reflection_model = None;
        }
        if self.shading_model.is_some() {
            object.shading_model = None;
        }
        if let (Some(count), Some(shape)) = (self.tessellation, registry.shape(&object.object_type)) {
            object.tessellation = Some(shape.tessellation(Some(count)));
        }
        object.material.0.extend(self.material.0.clone());
    }

    /// These overrides, supplemented by those of `base`.
    #[must_use]
    pub fn over(self, base: &Self) -> Self {
        let mut all = Self { name: None, ..base.clone() };
        self.each(&mut |field, held, _| {
            if let Some(value) = held.value().filter(|_| field.key != Self::based_on.key) {
                all.put(Key::Own(field.key), Some(value));
            }
        });
        all.material.0.extend(self.material.0);
        all
    }
}

impl Scene {
    /// The variant with a name.
    #[must_use]
    pub fn variant(&self, name: &str) -> Option<&Variant> {
        self.variants.iter().find(|variant| variant.name.as_deref() == Some(name))
    }

    /// Everything that a view overrides, including the overrides of the variants on which its variant is based; none
    /// for view 0, the scene itself.
    #[must_use]
    pub fn overrides(&self, view: usize) -> Option<Variant> {
        let mut chain = self.chain(view);
        let own = chain.next()?.clone();
        Some(Variant { based_on: None, ..chain.fold(own, Variant::over) })
    }

    /// The variant of a view and those on which it is based, each before its base; none for view 0, the scene itself.
    fn chain(&self, view: usize) -> impl Iterator<Item = &Variant> {
        let own = view.checked_sub(1).and_then(|i| self.variants.get(i));
        let all = iter::successors(own, move |variant| self.variant(variant.based_on.as_deref()?));
        // Each variant in a cycle is visited at most once.
        all.take(self.variants.len())
    }

    /// The reflection model that a view shows instead of those of the objects, if it does.
    fn model_over(&self, view: usize) -> Option<&str> {
        self.chain(view).find_map(|variant| variant.reflection_model.as_deref())
    }

    /// The ids of the reflection models of the objects that a view shows, each once.
    #[must_use]
    pub fn models_shown(&self, view: usize) -> BTreeSet<&str> {
        let over = self.model_over(view);
        self.shown().map(|object| over.unwrap_or_else(|| self.model_of(object))).collect()
    }

    /// The scene shown by a view, and its terms; view 0 is the scene itself. `None` if the view does not
    /// exist.
    #[must_use]
    pub fn seen(&self, view: usize, registry: &Registry) -> Option<(Self, TermSelection)> {
        if view == 0 {
            return Some((self.clone(), TermSelection::All));
        }
        let variant = self.overrides(view)?;
        Some((variant.applied(self, registry), variant.terms.unwrap_or_default()))
    }

    /// The scene without its variants and their comparison.
    #[must_use]
    pub fn alone(self) -> Self {
        Self { variants: Vec::new(), comparison: Comparison::default(), ..self }
    }

    /// True if two scenes with the same lights and objects differ at most in variants and comparison: then view A shows
    /// the same.
    #[must_use]
    pub fn shows_the_same(&self, other: &Self) -> bool {
        let words = self.name == other.name && self.description == other.description;
        let models = (&self.reflection_model, &self.shading_model);
        words
            && models == (&other.reflection_model, &other.shading_model)
            && (self.scene_size, self.observer, self.display)
                == (other.scene_size, other.observer, other.display)
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

    /// The view with a letter, or with the name of its variant.
    ///
    /// # Errors
    /// Returns an error that names the views.
    pub fn view_named(&self, name: &str) -> Result<usize, String> {
        let letters = &LETTERS[..=self.variants.len().min(LETTERS.len() - 1)];
        let letter = letters.iter().position(|letter| letter.eq_ignore_ascii_case(name));
        let named = || self.variants.iter().position(|v| v.name.as_deref() == Some(name)).map(|i| i + 1);
        letter.or_else(named).ok_or_else(|| {
            let names = self.variants.iter().filter_map(|variant| variant.name.as_deref());
            let hint = did_you_mean(name, names.map(|n| (n, n)));
            let known =
                |(i, letter): (usize, &&str)| match i.checked_sub(1).and_then(|i| self.variants.get(i)) {
                    Some(variant) => match &variant.name {
                        Some(name) => format!("{letter} ({name})"),
                        None => (*letter).to_owned(),
                    },
                    None => (*letter).to_owned(),
                };
            let known: Vec<_> = letters.iter().enumerate().map(known).collect();
            format!("there is no view {}; it must be {}{hint}", quoted(name), listed(&known, "or"))
        })
    }

    /// The name of a view: that of its variant, of the scene, or its letter.
    #[must_use]
    pub fn view_name(&self, view: usize) -> &str {
        let name = view.checked_sub(1).and_then(|i| self.variants.get(i)?.name.as_deref());
        name.unwrap_or(LETTERS.get(view).copied().unwrap_or("?"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{custom, parameter::Value, scene::check};

    fn scene(variants: Vec<Variant>) -> Scene {
        Scene { variants, ..Scene::default() }
    }

    fn named(name: &str, based_on: Option<&str>) -> Variant {
        Variant { name: Some(name.to_owned()), based_on: based_on.map(str::to_owned), ..Variant::default() }
    }

    #[test]
    fn a_view_shows_the_models_of_visible_objects_unless_its_variant_gives_another() {
        let with = |model: &str, visible: bool| Object {
            reflection_model: Some(model.to_owned()),
            visible,
            ..Object::default()
        };
        let mut phong = named("phong", None);
        phong.reflection_model = Some("phong".to_owned());
        let based = named("based", Some("phong"));
        let plain = named("plain", None);
        let cycles = named("cycles", Some("cycles"));
        let mut scene = scene(vec![phong, based, plain, cycles]);
        scene.objects = vec![with("ward", true), with("ward", true), with("gooch", false), Object::default()];
        let own: BTreeSet<&str> = ["ward", scene.reflection_model.as_str()].into();
        assert_eq!(own.len(), 2);
        for (view, expected) in
            [(0, own.clone()), (1, ["phong"].into()), (2, ["phong"].into()), (3, own.clone()), (4, own)]
        {
            assert_eq!(scene.models_shown(view), expected, "{view}");
            let seen = scene.seen(view, &Registry::builtin()).expect("there is one").0;
            assert_eq!(seen.models_shown(0), expected, "{view}");
        }
    }

    #[test]
    fn a_variant_inherits_what_it_does_not_override() {
        let mut base = named("base", None);
        base.reflection_model = Some("phong".to_owned());
        base.exposure = Some(1.0);
        base.material.set("alpha", Value::Integer(20));
        base.material.set("k_s", Value::Number(0.3));
        let mut top = named("top", Some("base"));
        top.exposure = Some(-1.0);
        top.terms = Some(TermSelection::Specular);
        top.material.set("alpha", Value::Integer(5));
        top.tessellation = Some(1000);
        let mut scene = scene(vec![base, top]);
        scene.objects.push(Object { reflection_model: Some("eon".to_owned()), ..Object::default() });
        let registry = Registry::builtin();
        let (seen, terms) = scene.seen(2, &registry).expect("there is a view C");
        assert_eq!(terms, TermSelection::Specular);
        assert_eq!(seen.display.exposure, -1.0);
        assert_eq!(seen.display.tone_mapping, scene.display.tone_mapping);
        for object in &seen.objects {
            assert_eq!(seen.model_of(object), "phong");
            assert_eq!(seen.shading_model_of(object), "gouraud");
            assert_eq!(object.material.0["alpha"], Value::Integer(5));
            assert_eq!(object.material.0["k_s"], Value::Number(0.3));
            // The type of the object allows no more.
            assert_eq!(object.tessellation, Some(256));
        }
        assert_eq!(scene.seen(0, &registry), Some((scene.clone(), TermSelection::All)));
        assert_eq!(scene.seen(3, &registry), None);
        assert_eq!([0, 1, 2, 3].map(|view| scene.view_name(view).to_owned()), ["A", "base", "top", "D"]);
    }

    #[test]
    fn variants_in_a_circle_are_refused_and_end() {
        let scene = scene(vec![named("a", Some("b")), named("b", Some("c")), named("c", Some("a"))]);
        assert!(scene.overrides(1).is_some());
        let found = check::scene(&scene, &Registry::builtin());
        let found: Vec<_> = found.iter().map(ToString::to_string).collect();
        let expected =
            "variants[0].based_on is \"b\", but a variant must not be based on itself: a → b → c → a";
        assert!(found.iter().any(|f| f == expected), "{found:?}");
    }

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
