//! What a presentation says of compared views: the same facts of each, those in which they differ first.

use std::{cmp::Reverse, collections::BTreeSet};

use crate::{
    caption::{Part, exposure, merged, terms_alone},
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    panel::{
        caption::{MOST_VALUES, model_part, shading_parts, values_of},
        prelude::*,
    },
    parameter::Parameter,
};

/// What a fact is about, in the order in which facts are said. A value has the position of its parameter.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
enum About {
    Model,
    Shading,
    Stage,
    Value(usize),
    Terms,
    ToneMapping,
    Exposure,
    Encoding,
}

impl About {
    /// Importance among facts that differ or not, the most important first.
    fn class(self, differs: bool) -> u8 {
        match self {
            Self::Model => 0,
            Self::Shading => 1,
            Self::Stage if differs => 2,
            Self::Terms | Self::ToneMapping | Self::Exposure | Self::Encoding => 3,
            Self::Value(_) => 4,
            // The shading model implies it.
            Self::Stage => 5,
        }
    }
}

/// A fact about a view; a usual one need not be said.
struct Fact {
    about: About,
    part: Part,
    usual: bool,
}

/// The values of a view, each with its parameter.
type Values = Vec<(&'static Parameter, Part)>;

/// The values of the only object of a scene, in the order in which its model declares them.
fn values_said(scene: &Scene, registry: &Registry) -> Values {
    let mut objects = scene.shown();
    match (objects.next(), objects.next()) {
        (Some(object), None) => values_of(object, scene.model_of(object), registry),
        _ => Vec::new(),
    }
}

/// The names of the values of all views, in the order in which their models declare them.
fn order_of_values(views: &[Values]) -> Vec<&'static str> {
    let names = |values: &Values| values.iter().map(|(parameter, _)| parameter.name).collect();
    merged(views.iter().map(names).collect())
}

/// All facts about a view with these values, which have this order.
fn facts(
    (scene, terms): (&Scene, TermSelection),
    (values, order): (Values, &[&str]),
    registry: &Registry,
) -> Vec<Fact> {
    let mut facts = Vec::new();
    let mut say = |about, part, usual| facts.push(Fact { about, part, usual });
    say(About::Model, model_part(scene, registry), false);
    for (about, part) in [About::Shading, About::Stage].into_iter().zip(shading_parts(scene, registry)) {
        say(about, part, false);
    }
    if let Some(object) = scene.shown().next() {
        for (parameter, part) in values {
            let at = order.iter().position(|name| *name == parameter.name);
            let usual = object.material.get(parameter) == parameter.default_value();
            say(About::Value(at.unwrap_or(usize::MAX)), part, usual);
        }
    }
    let all = terms == TermSelection::All;
    say(About::Terms, terms_alone(terms).unwrap_or_else(|| Part::new(0, "all terms")), all);
    let display = scene.display;
    let none = display.tone_mapping == ToneMapping::None;
    let mapping = if none { "no tone mapping" } else { display.tone_mapping.name() };
    say(About::ToneMapping, Part::new(0, mapping), none);
    say(About::Exposure, Part::new(0, exposure(display.exposure)), display.exposure == 0.0);
    let naive = display.encoding == Encoding::Off;
    say(About::Encoding, Part::new(0, if naive { "gamma-naive" } else { "gamma-correct" }), !naive);
    facts
}

/// The captions of views that show these scenes and terms. Parts about the same have the same rank in all.
pub(super) fn alike(views: &[(&Scene, TermSelection)], registry: &Registry) -> Vec<Vec<Part>> {
    let values: Vec<_> = views.iter().map(|(scene, _)| values_said(scene, registry)).collect();
    let order = order_of_values(&values);
    let facts_of = |(view, values)| facts(view, (values, &order), registry);
    let all: Vec<_> = views.iter().copied().zip(values).map(facts_of).collect();
    let of = |facts: &[Fact], about: About| {
        facts.iter().find(|fact| fact.about == about).map(|fact| fact.part.clone())
    };
    let differs = |about: &About| all.windows(2).any(|pair| of(&pair[0], *about) != of(&pair[1], *about));
    let usual = |about: &About| all.iter().flatten().all(|fact| fact.usual || fact.about != *about);
    let known: BTreeSet<About> = all.iter().flatten().map(|fact| fact.about).collect();
    let weight = |about: &About| {
        let differs = differs(about);
        // Coefficients are declared before exponents and roughness, which say more.
        (!differs, about.class(differs), usual(about), Reverse(*about))
    };
    let (mut values, others): (Vec<_>, Vec<_>) =
        known.into_iter().partition(|about| matches!(about, About::Value(_)));
    values.sort_by_key(weight);
    values.truncate(MOST_VALUES);
    let mut said: Vec<_> = others.into_iter().filter(|about| !usual(about)).chain(values).collect();
    said.sort_by_key(weight);
    let mut ranked: Vec<_> = (0..=u8::MAX).zip(said).collect();
    ranked.sort_by_key(|(_, about)| (!differs(about), *about));
    let caption = |facts: &Vec<Fact>| {
        let part = |(rank, about): &(u8, About)| of(facts, *about).map(|part| Part { rank: *rank, ..part });
        ranked.iter().filter_map(part).collect()
    };
    all.iter().map(caption).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{caption::line, parameter::Value};

    fn scene(model: &str) -> Scene {
        Scene { reflection_model: model.to_owned(), ..Scene::default() }
    }

    fn said(views: &[(&Scene, TermSelection)]) -> Vec<String> {
        alike(views, &Registry::builtin()).iter().map(|parts| line(parts)).collect()
    }

    #[test]
    fn both_captions_say_the_same_and_first_what_differs() {
        let mut a = scene("blinn_phong");
        a.objects[0].material.set("k_a", Value::Number(0.1));
        let mut b = a.clone();
        b.shading_model = "phong".to_owned();
        b.display.tone_mapping = ToneMapping::Reinhard;
        let both = said(&[(&a, TermSelection::All), (&b, TermSelection::Diffuse)]);
        let (a_says, b_says) = (&both[0], &both[1]);
        let head = "Gouraud shading · computed per vertex · all terms · no tone mapping · Blinn–Phong";
        assert!(a_says.starts_with(head), "{a_says}");
        let head = "Phong shading · computed per pixel · diffuse term alone · Reinhard · Blinn–Phong";
        assert!(b_says.starts_with(head), "{b_says}");
        assert!(a_says.contains("k_a 0.1") && b_says.contains("k_a 0.1"), "{a_says}; {b_says}");
        assert!(!a_says.contains("EV") && !a_says.contains("gamma"), "usual in both: {a_says}");
        let ranks = alike(&[(&a, TermSelection::All), (&b, TermSelection::Diffuse)], &Registry::builtin());
        let ranks: Vec<Vec<u8>> =
            ranks.iter().map(|parts| parts.iter().map(|part| part.rank).collect()).collect();
        assert_eq!(ranks[0], ranks[1], "so that both leave out the same");
    }

    #[test]
    fn values_have_the_order_in_which_the_model_declares_them() {
        let a = scene("blinn_phong");
        let b = Scene { shading_model: "phong".to_owned(), ..a.clone() };
        let lambert = scene("lambert");
        let declared = values_said(&a, &Registry::builtin());
        let declared: Vec<_> = declared.iter().map(|(_, part)| line(std::slice::from_ref(part))).collect();
        for views in [[&a, &b], [&lambert, &a]] {
            let views = views.map(|scene| (scene, TermSelection::All));
            let captions = said(&views);
            let at: Vec<_> = declared.iter().filter_map(|value| captions[1].find(value.as_str())).collect();
            assert!(at.len() > 2 && at.is_sorted(), "{declared:?}: {captions:?}");
        }
    }

    #[test]
    fn a_value_that_only_one_model_has_is_said_of_that_one() {
        let (a, b) = (scene("lambert"), scene("phong"));
        let both = said(&[(&a, TermSelection::All), (&b, TermSelection::All)]);
        assert!(both[0].starts_with("Lambert · ") && both[1].starts_with("Phong · "), "{both:?}");
        assert!(both[1].contains('α') && !both[0].contains('α'), "{both:?}");
    }
}
