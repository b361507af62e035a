//! Pictures in words: captions, the headings of views, and the strip below a picture.

mod ground;
mod heading;
mod order;
mod part;
mod rows;
mod said;
mod sampled;
mod strip;
mod words;

pub use ground::Ground;
pub use heading::{MODEL_RANK, header, header_parts, view_parts};
pub(crate) use order::merged;
pub(crate) use part::closing;
pub use part::{Part, line};
pub use rows::{label_of, of_copy, of_row, row_labels};
pub use sampled::{Sampled, sampled};
pub use strip::{draw, draw_line, line_width, most_rows, type_size};
pub(crate) use words::{display, exposure, said, single, terms_alone, value};

use crate::{
    optics::TermSelection,
    registry::Registry,
    scene::{
        Display, Key, Scene,
        part::{Fields as _, Structure as _},
        variant::LETTERS,
    },
};
use said::Said;

/// The caption of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Caption {
    /// The name of the scene, and of the view if there are several; often empty.
    pub title: String,
    /// Reflection models, shading models, non-default values, terms and display.
    pub facts: Vec<Part>,
    /// The name and the version of the program.
    pub program: &'static str,
    /// The ground of the strip, which suits the picture.
    pub ground: Ground,
}

impl Caption {
    /// Adds how the light of the views was sampled, before the facts of single views.
    #[must_use]
    pub fn resting_on(mut self, views: &[Sampled]) -> Self {
        let own = self.facts.iter().position(Part::leads).unwrap_or(self.facts.len());
        self.facts.splice(own..own, sampled(views));
        self
    }
}

/// The caption of a scene as it is, with these terms of its equations shown.
#[must_use]
pub fn of_scene(scene: &Scene, terms: TermSelection, registry: &Registry) -> Caption {
    let mut facts = words::surfaces(scene, &Said::default(), registry);
    facts.extend(terms_alone(terms));
    facts.extend(display(scene.display));
    let program = concat!("Lights, Camera, Models! ", env!("CARGO_PKG_VERSION"));
    let (title, ground) = (scene.name.clone().unwrap_or_default(), Ground::of(&scene.display));
    Caption { title, facts, program, ground }
}

/// The caption of a view of a scene; `None` if the view does not exist.
#[must_use]
pub fn of_view(scene: &Scene, view: usize, registry: &Registry) -> Option<Caption> {
    let (seen, terms) = scene.seen(view, registry)?;
    Some(of_seen(scene, (view, &seen, terms), registry))
}

/// The caption of a view, from its scene and terms.
fn of_seen(
    scene: &Scene,
    (view, seen, terms): (usize, &Scene, TermSelection),
    registry: &Registry,
) -> Caption {
    let mut caption = of_scene(seen, terms, registry);
    let tessellation = scene.overrides(view).and_then(|variant| variant.tessellation);
    caption.facts.extend(tessellation.map(|count| Part::new(1, format!("tessellation {count}"))));
    Caption { title: title(scene, view), ..caption }
}

/// The caption of a picture with several views, each with the terms that it shows: first the common facts, then
/// the differences of each.
#[must_use]
pub fn of_views(scene: &Scene, views: &[(usize, TermSelection)], registry: &Registry) -> Caption {
    let said = Said::of(scene, 0);
    let terms = views.first().map(|(_, terms)| *terms);
    let terms = terms.filter(|terms| views.iter().all(|(_, own)| own == terms));
    let mut facts = words::surfaces(scene, &said, registry);
    facts.extend(terms.and_then(terms_alone));
    let (mut shared, usual) = (scene.display, Display::default());
    let overridden = |key: &Key| said.over.value(*key).is_some();
    for key in Display::keys().into_iter().map(Key::Own).filter(overridden) {
        shared.put(key, usual.value(key));
    }
    facts.extend(display(shared));
    for view in views {
        let mut of_view = Said::of(scene, view.0);
        of_view.over.terms.take_if(|_| terms.is_some());
        // The values are given nowhere else.
        (of_view.values, of_view.colours) = (said.over.reflection_model.is_some(), true);
        let parts = heading::parts_of(scene, *view, &of_view, registry);
        let letter = LETTERS.get(view.0).copied().unwrap_or_default();
        facts.push(Part::new(0, format!("{letter}:")));
        facts.extend(parts.into_iter().map(|part| Part { rank: 0, ..part.continued() }));
    }
    Caption { facts, ..of_scene(scene, TermSelection::All, registry) }
}

/// The caption of a picture of a scene: of a single view, or of several, each with its scene and terms.
#[must_use]
pub fn of_picture(scene: &Scene, shown: &[(usize, &Scene, TermSelection)], registry: &Registry) -> Caption {
    match shown {
        [one] => of_seen(scene, *one, registry),
        all => {
            let views: Vec<_> = all.iter().map(|(view, _, terms)| (*view, *terms)).collect();
            let caption = of_views(scene, &views, registry);
            // The background may be of the picture alone.
            let ground = all.first().map_or(caption.ground, |(_, seen, _)| Ground::of(&seen.display));
            Caption { ground, ..caption }
        }
    }
}

fn title(scene: &Scene, view: usize) -> String {
    let scene_name = scene.name.iter().cloned();
    let letter = LETTERS.get(view).copied().unwrap_or_default();
    let variant = view.checked_sub(1).and_then(|i| scene.variants.get(i)?.name.as_deref());
    let view = match variant {
        _ if scene.variants.is_empty() => None,
        Some(name) => Some(format!("{letter}: {name}")),
        None => Some(letter.to_owned()),
    };
    scene_name.chain(view).collect::<Vec<_>>().join(" · ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::{colour::Encoding, tone::ToneMapping},
        parameter::Value,
        scene::{Object, Variant},
    };

    fn facts(scene: &Scene, view: usize) -> String {
        line(&of_view(scene, view, &Registry::builtin()).expect("there is such a view").facts)
    }

    fn object(name: &str, model: Option<&str>, values: &[(&'static str, Value)]) -> Object {
        let mut object = Object { reflection_model: model.map(str::to_owned), ..Object::default() };
        object.name = (!name.is_empty()).then(|| name.to_owned());
        for (name, value) in values {
            object.material.set(*name, value.clone());
        }
        object
    }

    #[test]
    fn a_caption_says_what_differs_from_the_defaults() {
        let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        scene.objects = vec![object("", None, &[])];
        assert_eq!(facts(&scene, 0), "Phong · Gouraud shading");
        scene.objects[0].material.set("alpha", Value::Integer(27));
        scene.objects[0].material.set("k_s", Value::Number(0.25));
        scene.objects[0].material.set("base_colour", Value::Colour([200, 100, 50]));
        // A setting that the model ignores is not part of the picture.
        scene.objects[0].material.set("roughness", Value::Number(0.9));
        scene.display.tone_mapping = ToneMapping::AgX;
        scene.display.exposure = -1.5;
        scene.display.encoding = Encoding::Off;
        assert_eq!(
            facts(&scene, 0),
            "Phong · Gouraud shading · C_b = (200, 100, 50), k_s = 0.25, α = 27 · AgX · −1.5 EV · gamma-naive"
        );
        // Hidden objects are not in the picture.
        scene.objects.push(Object { visible: false, ..object("", Some("eon"), &[]) });
        assert!(!facts(&scene, 0).contains("EON"));
        scene.objects[0].visible = false;
        assert!(facts(&scene, 0).starts_with("nothing visible · AgX · −1.5 EV"));
    }

    #[test]
    fn each_model_is_named_once_with_its_objects_and_values() {
        let mut scene = Scene { reflection_model: "oren_nayar".to_owned(), ..Scene::default() };
        let alpha = |n| ("alpha", Value::Integer(n));
        scene.objects = vec![
            object("Ball", Some("phong"), &[alpha(20)]),
            object("Floor", None, &[]),
            object("Wall", None, &[("sigma", Value::Number(0.0))]),
            object("Cube", Some("phong"), &[alpha(80), ("base_colour", Value::Colour([1, 2, 3]))]),
        ];
        assert_eq!(
            facts(&scene, 0),
            "Phong (Ball, Cube), α = 20 to 80 · Oren–Nayar (Floor, Wall), σ = 0 to 20° · Gouraud shading"
        );
        // Facts shared by all views are given once.
        let mut red = scene.clone();
        red.objects
            .iter_mut()
            .for_each(|object| object.material.set("base_colour", Value::Colour([200, 0, 0])));
        let end = "Oren–Nayar (Floor, Wall), σ = 0 to 20° · Gouraud shading · C_b = (200, 0, 0)";
        assert_eq!(facts(&red, 0), format!("Phong (Ball, Cube), α = 20 to 80 · {end}"));
        // Names that repeat the model's add nothing.
        scene.objects[0].name = Some("Phong 1".to_owned());
        assert!(
            facts(&scene, 0).starts_with("Phong, α = 20 to 80 · Oren–Nayar (Floor"),
            "{}",
            facts(&scene, 0)
        );
        // Long names, or parts without a name, would make this a list.
        scene.objects[0].name = Some("The first of the balls on the table".to_owned());
        scene.objects[1].name = None;
        scene.objects[1].shading_model = Some("flat".to_owned());
        assert_eq!(
            facts(&scene, 0),
            "Phong, α = 20 to 80 · Oren–Nayar, σ = 0 to 20° · Gouraud and Flat shading"
        );
    }

    #[test]
    fn a_measurement_is_named_by_its_file() {
        let registry = Registry::builtin();
        // A file that is not there would be no value: this is the shipped one under other names.
        let file = |name: &'static str| {
            let parameter = registry.material_parameter("merl_file").expect("declared");
            let Value::File(shipped) = parameter.default_value() else { panic!("no file") };
            Value::File(shipped.renamed(name))
        };
        let mut scene = Scene { reflection_model: "measured_merl".to_owned(), ..Scene::default() };
        scene.objects = vec![object("", None, &[("merl_file", file("merl/alum-bronze.binary"))])];
        assert_eq!(facts(&scene, 0), "Measured (MERL) · Gouraud shading · alum-bronze.binary");
        // A view that has another one says so in its heading, as does A.
        let mut other = Variant::default();
        other.material.set("merl_file", file("paint, red.binary"));
        scene.variants = vec![other];
        let headings = [0, 1].map(|view| header(&scene, view, &registry));
        assert_eq!(headings, ["A · alum-bronze.binary", "B · “paint, red.binary”"]);
    }

    #[test]
    fn several_views_share_what_is_the_same_in_all() {
        let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        scene.objects =
            vec![object("", None, &[("alpha", Value::Integer(20)), ("k_s", Value::Number(0.25))])];
        scene.display.exposure = 1.0;
        let mut sharp = Variant { tone_mapping: Some(ToneMapping::AgX), ..Variant::default() };
        sharp.material.set("alpha", Value::Integer(80));
        let terms = Variant {
            name: Some("Highlight".to_owned()),
            terms: Some(TermSelection::Specular),
            ..Variant::default()
        };
        scene.variants = vec![sharp, terms];
        let said = |scene: &Scene, views: &[(usize, TermSelection)]| {
            line(&of_views(scene, views, &Registry::builtin()).facts)
        };
        let [all, highlight] = [TermSelection::All, TermSelection::Specular];
        let common = "Phong · Gouraud shading · k_s = 0.25";
        let [a, b] = ["A: α 20, all terms, no tone mapping", "B: α 80, AgX"];
        assert_eq!(
            said(&scene, &[(0, all), (1, all), (2, highlight)]),
            format!("{common} · +1 EV · {a} · {b} · C: Highlight, specular term alone")
        );
        // Terms shared by all views are given once.
        let diffuse = TermSelection::Diffuse;
        assert_eq!(
            said(&scene, &[(0, diffuse), (1, diffuse)]),
            format!("{common} · diffuse term alone · +1 EV · A: α 20, no tone mapping · B: α 80, AgX")
        );
        // Those of A are the window's.
        let both = said(&scene, &[(0, diffuse), (2, highlight)]);
        assert!(both.contains("A: α 20, diffuse term alone, no tone mapping"), "{both}");
        // Different models have only the display and the shading in common.
        scene.variants[1].reflection_model = Some("blinn_phong".to_owned());
        let all = said(&scene, &[(0, all), (2, highlight)]);
        assert!(all.contains("+1 EV · A: Phong, α 20, all terms, no tone mapping, k_s 0.25 · "), "{all}");
        assert!(all.ends_with(" · C: Highlight, Blinn–Phong, specular term alone, k_s 0.25, α 20"), "{all}");
    }

    #[test]
    fn the_title_names_scene_and_view() {
        let mut scene = Scene { name: Some("Gold".to_owned()), ..Scene::default() };
        let title = |scene: &Scene, view| of_view(scene, view, &Registry::builtin()).map(|c| c.title);
        assert_eq!(title(&scene, 0).as_deref(), Some("Gold"));
        assert_eq!(title(&scene, 1), None);
        let variant = Variant {
            name: Some("Matched".to_owned()),
            terms: Some(TermSelection::Specular),
            ..Variant::default()
        };
        scene.variants = vec![variant, Variant { tessellation: Some(12), ..Variant::default() }];
        assert_eq!(title(&scene, 0).as_deref(), Some("Gold · A"));
        assert_eq!(title(&scene, 1).as_deref(), Some("Gold · B: Matched"));
        scene.name = None;
        assert_eq!(title(&scene, 2).as_deref(), Some("C"));
        assert_eq!(facts(&scene, 1), "Lambert · Gouraud shading · specular term alone");
        assert_eq!(facts(&scene, 2), "Lambert · Gouraud shading · tessellation 12");
    }
}
