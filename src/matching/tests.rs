use super::*;
use crate::{
    document::{Document, Edit, Selection},
    scene::{Object, Part, Scene},
    testing::shared::{PHONG, matched, two_views as scene},
};

fn number(value: f32) -> Value {
    Value::Number(value)
}

fn error(scene: &Scene, what: What, parameters: &[&str]) -> String {
    matched(scene, what, parameters).expect_err("refused").to_string()
}

/// The matched value of a number.
fn found(found: &Match, name: &str) -> f64 {
    let value = found.values.iter().find(|(n, _)| *n == name);
    value.unwrap_or_else(|| panic!("{name} is not in {found:?}")).1.numbers()[0]
}

/// Blinn–Phong's exponent is four times Phong's: E. Lafortune and Y. Willems (1994), F. Fisher and A. Woo (1994).
#[test]
fn equal_highlights_of_phong_and_blinn_have_exponents_of_one_to_four() {
    for alpha in [8, 32, 200, 2000] {
        let scene = scene(("phong", &[("alpha", Value::Integer(alpha))]), ("blinn_phong", &[]));
        let all = ["k_a", "k_d", "k_s", "alpha"];
        let highlight = matched(&scene, What::Highlight, &all).expect("a match");
        // The brightness does not matter.
        assert_eq!(highlight.values.len(), 1, "{highlight:?}");
        let ratio = found(&highlight, "alpha") / alpha as f64;
        assert!((ratio - 4.0).abs() < 0.2, "{alpha}: {ratio}");
        // The cosines of very narrow highlights have few digits left in 32 bits.
        let rest = if alpha > 1000 { 0.03 } else { 0.01 };
        assert!(highlight.after < rest && highlight.before > 0.6, "{highlight:?}");
        // The other way round.
        let mut back = scene.clone();
        back.reflection_model = "blinn_phong".to_owned();
        back.objects[0].material.set("alpha", Value::Integer(4 * alpha));
        back.variants[0].reflection_model = Some("phong".to_owned());
        let highlight = matched(&back, What::Highlight, &["alpha"]).expect("a match");
        let ratio = found(&highlight, "alpha") / alpha as f64;
        assert!((ratio - 1.0).abs() < 0.05, "{alpha}: {ratio}");
    }
    // An anisotropic highlight has two widths.
    let brushed = [("alpha_x", number(0.05)), ("alpha_y", number(0.25))];
    let ward = scene(("ward", &brushed), ("ward", &[("alpha_x", number(0.3)), ("alpha_y", number(0.3))]));
    let highlight = matched(&ward, What::Highlight, &["k_s", "alpha_x", "alpha_y"]).expect("a match");
    for (name, value) in brushed {
        let expected = value.numbers()[0];
        assert!((found(&highlight, name) / expected - 1.0).abs() < 0.02, "{highlight:?}");
    }
    // Over all directions the lobes differ in shape: Blinn's is narrower across the plane of incidence, so that a smaller
    // exponent is nearest, but still a larger one than Phong's.
    let scene = scene(("phong", &[("alpha", Value::Integer(32))]), ("blinn_phong", &[]));
    let lobe = matched(&scene, What::Lobe, &["k_s", "alpha"]).expect("a match");
    let ratio = found(&lobe, "alpha") / 32.0;
    assert!((2.0..4.5).contains(&ratio), "{ratio}");
    assert!(lobe.after < 0.5 * lobe.before, "{lobe:?}");
}

/// The root mean square of the differences between the present views.
fn rest(target: &mut impl Target) -> f64 {
    let mut all = vec![0.0; target.count()];
    target.differences(&Vec::new(), &mut all);
    (all.iter().map(|d| d * d).sum::<f64>() / all.len() as f64).sqrt()
}

#[test]
fn the_match_is_the_best_of_all_values_of_a_parameter() {
    let registry = Registry::builtin();
    let ggx = [("alpha_x", number(0.2)), ("alpha_y", number(0.2))];
    let mut scene = scene(("microfacet", &ggx), ("blinn_phong", &[]));
    let best = What::ALL.map(|what| matched(&scene, what, &["alpha"]).expect("a match").after);
    let mut least = [f64::INFINITY; 3];
    for step in 0..100 {
        let alpha = 1.08f64.powi(step).round() as i64;
        scene.variants[0].material.set("alpha", Value::Integer(alpha));
        let [a, b] = [0, 1].map(|view| Side::seen(&scene, view, &registry).expect("there is one"));
        let sides = [&a, &b];
        let there = [
            rest(&mut Lobe::new(sides, Metric::Cosine, &registry)),
            rest(&mut Picture::new(sides, &registry).expect("it is in the picture")),
            rest(&mut Highlight::new(sides, &registry).unwrap_or_else(|_| panic!("it has one"))),
        ];
        least = std::array::from_fn(|i| least[i].min(there[i]));
    }
    for (i, what) in What::ALL.into_iter().enumerate() {
        assert!(best[i] <= least[i] * 1.002, "{what:?}: {} but {} was seen", best[i], least[i]);
    }
}

#[test]
fn a_match_is_one_step_that_undo_brings_back() {
    let registry = Registry::builtin();
    let mut document = Document::new(scene(("phong", &PHONG), ("blinn_phong", &[])));
    let before = document.variants.clone();
    let found = matched(&document, What::Highlight, &["alpha", "k_s"]).expect("a match");
    let edit = Edit::materials(Part::Variant(0), found.values.clone(), "Match");
    document.edit(edit, Selection::default(), &registry).expect("legal");
    assert_eq!(document.steps().collect::<Vec<_>>(), ["Match of view B"]);
    let after = matched(&document, What::Highlight, &["alpha", "k_s"]).expect("a match");
    assert_eq!(after.before, found.after, "what was promised is what there is");
    document.undo();
    assert_eq!(document.variants, before);
}

#[test]
fn several_materials_are_matched_together() {
    let mut scene = scene(("phong", &[("alpha", Value::Integer(10))]), ("phong", &[]));
    let mut other = Object { position: glam::Vec3::new(3.0, 3.0, 3.0), ..scene.objects[0].clone() };
    other.material.set("alpha", Value::Integer(80));
    scene.objects.push(other);
    // Without an override, each object keeps its own model.
    let none = matched(&scene, What::Lobe, &["alpha"]).expect("a match");
    assert_eq!((none.values, none.before, none.after), (Vec::new(), 0.0, 0.0));
    scene.variants[0].material.set("alpha", Value::Integer(1000));
    let both = matched(&scene, What::Lobe, &["alpha"]).expect("a match");
    assert!((10.0..80.0).contains(&found(&both, "alpha")), "{both:?}");
}

#[test]
fn what_cannot_be_matched_is_said() {
    let lambert = scene(("phong", &[]), ("lambert", &[]));
    assert_eq!(error(&lambert, What::Lobe, &[]), "no parameter is free; free some of base_colour");
    assert_eq!(
        error(&lambert, What::Lobe, &["alpha"]),
        "\"alpha\" is free, but view B has no such parameter; free some of base_colour"
    );
    assert_eq!(
        error(&lambert, What::Highlight, &["base_colour"]),
        "view B has no highlight of measurable width: Lambert does not fall to half its brightness"
    );
    let back = scene(("lambert", &[]), ("phong", &[]));
    assert!(
        error(&back, What::Highlight, &["alpha"])
            .starts_with("view A has no highlight of measurable width: Lambert")
    );
    let phong = scene(("lambert", &[]), ("phong", &[]));
    assert_eq!(
        error(&phong, What::Lobe, &["alhpa"]),
        "\"alhpa\" is free, but view B has no such parameter; free some of base_colour, specular_colour, k_a, k_d, k_s and alpha; did you mean \"alpha\"?"
    );
    let microfacet = scene(("lambert", &[]), ("microfacet", &[]));
    assert_eq!(
        error(&microfacet, What::Lobe, &["masking"]),
        "masking is free, but it is a choice: only numbers and colours can be searched"
    );
    assert_eq!(
        error(&microfacet, What::Lobe, &["gamma"]),
        "gamma is free, but it has no effect: Not used with GGX: only GTR has γ"
    );
    let view = |view: usize| {
        let request = Request { scene: &phong, view, measure: What::Lobe.into(), parameters: &["alpha"] };
        match_view(&request, &Registry::builtin(), &Progress::NONE).expect_err("refused").to_string()
    };
    assert_eq!(view(2), "there is no view C to match; the scene has 2 views: A and B");
    assert_eq!(view(0), "there is no view A to match; the scene has 2 views: A and B");
    let mut hidden = phong.clone();
    hidden.objects[0].visible = false;
    assert_eq!(
        error(&hidden, What::Lobe, &["alpha"]),
        "no object is visible, so there is nothing to compare"
    );
    let mut away = phong.clone();
    away.observer.direction = glam::Vec3::Z;
    assert_eq!(
        error(&away, What::Picture, &["alpha"]),
        "no object is visible, so there is nothing to compare"
    );
    let alone = Scene { variants: Vec::new(), ..phong };
    assert_eq!(
        error(&alone, What::Lobe, &["alpha"]),
        "there is no view B to match; the scene has only view A"
    );
    let cancelled = Progress { tell: &|_, _| (), cancelled: &|| true };
    let scene = scene(("phong", &[]), ("blinn_phong", &[]));
    let request = Request { scene: &scene, view: 1, measure: What::Picture.into(), parameters: &["alpha"] };
    assert_eq!(match_view(&request, &Registry::builtin(), &cancelled), Err(MatchError::Cancelled));
}

#[test]
fn numbers_are_free_unless_it_is_said_otherwise() {
    let registry = Registry::builtin();
    let names = |scene: &Scene, usual: bool| -> Vec<&str> {
        let all = parameters(scene, 1, &registry);
        all.into_iter().filter(|(_, free)| *free == usual).map(|(parameter, _)| parameter.name).collect()
    };
    let phong = scene(("lambert", &[]), ("phong", &[]));
    assert_eq!(names(&phong, true), ["k_a", "k_d", "k_s", "alpha"]);
    assert_eq!(names(&phong, false), ["base_colour", "specular_colour"]);
    // γ has no effect with GGX, and neither has the extinction of a dielectric.
    let microfacet = scene(("lambert", &[]), ("microfacet", &[]));
    assert_eq!(names(&microfacet, true), ["alpha_x", "alpha_y"]);
    assert!(!names(&microfacet, false).contains(&"extinction"));
    assert!(parameters(&phong, 2, &registry).is_empty());
}

#[test]
fn beside_a_measurement_every_parameter_is_free() {
    let registry = Registry::builtin();
    let free = |of: &str| {
        let all = parameters(&scene((of, &[]), ("phong", &[])), 1, &registry);
        all.into_iter().map(|(parameter, free)| (parameter.name, free)).collect::<Vec<_>>()
    };
    let [modelled, measured] = ["lambert", "measured_merl"].map(free);
    assert!(measured.contains(&("base_colour", true)) && measured.iter().all(|(_, free)| *free));
    assert!(modelled.contains(&("base_colour", false)), "{modelled:?}");
    assert_eq!(modelled.len(), measured.len());
}

#[test]
fn beside_a_measurement_that_turns_two_azimuths_do() {
    let registry = Registry::builtin();
    let count = |a: &str, b: &str| {
        let scene = scene((a, &[]), (b, &[]));
        let [a, b] = [0, 1].map(|view| Side::seen(&scene, view, &registry).expect("both exist"));
        Lobe::new([&a, &b], Metric::Cosine, &registry).count()
    };
    let [one, four] = ["phong", "ward"].map(|model| count("phong", model));
    assert_eq!(four, 4 * one);
    // Rounding at the ends of bins leaves out a few others.
    let [one, two] = ["phong", "ward"].map(|model| count("measured_merl", model));
    assert!(one > 1000 && (18 * one..=22 * one).contains(&(10 * two)), "{one} {two}");
}

fn by(scene: &Scene, metric: Metric, parameters: &[&str]) -> Match {
    let measure = Measure { what: What::Lobe, metric };
    let request = Request { scene, view: 1, measure, parameters };
    match_view(&request, &Registry::builtin(), &Progress::NONE).expect("a match")
}

#[test]
fn the_metrics_of_a_white_and_a_black_matte_surface_have_closed_values() {
    let colour = |value: u8| [("base_colour", Value::Colour([value; 3]))];
    let scene = scene(("lambert", &colour(255)), ("lambert", &colour(0)));
    // f cos θ is cos θ/π for white, and 0 for black.
    let cosines: Vec<f64> = directions(0.0, 80.0).iter().map(|(l, _)| f64::from(l.z)).collect();
    let mean = |of: &dyn Fn(f64) -> f64| cosines.iter().map(|c| of(*c)).sum::<f64>() / cosines.len() as f64;
    let pi = std::f64::consts::PI;
    let expected = [
        (Metric::Cosine, mean(&|c| c * c).sqrt()),
        (Metric::Log, mean(&|c| (1.0 + c / pi).ln().powi(2)).sqrt()),
        (Metric::CubeRoot, mean(&|c| (c / pi).powf(2.0 / 3.0)).sqrt()),
    ];
    for (metric, value) in expected {
        let found = by(&scene, metric, &["base_colour"]);
        assert!((found.before / value - 1.0).abs() < 1e-5, "{metric:?}: {found:?}, {value}");
        assert_eq!(found.values, colour(255), "{metric:?}");
        // The wrong twins: no metric has the value of another.
        let others = expected.iter().filter(|(other, _)| *other != metric);
        assert!(others.clone().count() == 2 && others.clone().all(|(_, v)| (v / value - 1.0).abs() > 0.1));
    }
    // Pictures and highlights have no choice.
    let picture = Measure { what: What::Picture, metric: Metric::Log };
    assert_eq!((picture.unit(), picture.to_string()), (What::Picture.unit(), "picture".to_owned()));
    let log = Measure { what: What::Lobe, metric: Metric::Log };
    assert_eq!((log.unit(), log.to_string()), (Metric::Log.unit(), "lobe (log)".to_owned()));
    assert_eq!(Measure::from(What::Lobe).unit(), What::Lobe.unit());
}

#[test]
fn a_metric_that_sees_less_of_highlights_ends_nearer_to_the_body() {
    let white = ("base_colour", Value::Colour([255; 3]));
    let glossy = [
        white,
        ("k_a", number(0.0)),
        ("k_d", number(0.5)),
        ("k_s", number(0.5)),
        ("alpha", Value::Integer(20)),
    ];
    let scene = scene(("phong", &glossy), ("lambert", &[]));
    let [cosine, log, root] =
        Metric::ALL.map(|metric| found(&by(&scene, metric, &["base_colour"]), "base_colour"));
    assert!(cosine > log && log > root, "{cosine} {log} {root}");
}

#[test]
fn every_opaque_model_is_matched_and_stays_opaque() {
    let registry = Registry::builtin();
    let ids: Vec<_> = each::candidates(&registry).map(|model| model.declaration.id).collect();
    assert!(ids.contains(&"openpbr") && ids.contains(&"lambert"), "{ids:?}");
    for other in ["thin_glass", "glass", "diffuse_transmission", "measured_merl"] {
        assert!(registry.model(other).is_some() && !ids.contains(&other), "{ids:?}");
    }
    let model = registry.model("openpbr").expect("built in");
    let opens = model.parameters.iter().filter(|p| !each::keeps_opaque(model, p)).map(|p| p.name);
    assert_eq!(opens.collect::<Vec<_>>(), ["transmission_weight"]);
}

#[test]
fn what_ended_a_search_has_a_name_and_a_sentence() {
    let all = [Ended::Itself, Ended::Evaluations, Ended::Time, Ended::Interrupted];
    assert_eq!(all.map(Ended::id), ["search", "evaluations", "time", "interrupted"]);
    assert_eq!(all.map(|ended| ended.note().is_some()), [false, true, true, true]);
}
