//! Tests of conditions.

use super::*;
use crate::{
    channel::DebugChannel,
    curves::Kind as Plot,
    document::Selection,
    explain,
    lesson::WindowFacts,
    optics::{TermSelection, colour::Encoding},
    parameter::Value as Given,
    reference::Settings,
    registry::Registry,
    scene::Scene,
};

/// The default scene with Blinn–Phong and this exponent.
fn scene(alpha: i64) -> Scene {
    let mut scene = Scene { reflection_model: "blinn_phong".to_owned(), ..Scene::default() };
    scene.objects[0].material.set("alpha", Given::Integer(alpha));
    scene
}

fn situation<'a>(scene: &'a Scene, registry: &'a Registry) -> Situation<'a> {
    let window = WindowFacts {
        views: 2,
        active: 1,
        channel: Some(DebugChannel::NDotL),
        terms: TermSelection::Specular,
        plots: Some(Plot::Albedo),
        explain: true,
        presenting: false,
        code: true,
        errors: 2,
    };
    Situation { scene, registry, selection: Selection::Object(0), window, probe: None, pinned: false }
}

fn condition(text: &str) -> Condition {
    Condition::parse(text).unwrap_or_else(|(at, what)| panic!("{text}: {at}: {what}"))
}

#[test]
fn every_quantity_of_scene_and_window_has_its_value() {
    let registry = Registry::builtin();
    let scene = scene(20);
    let situation = situation(&scene, &registry);
    for (text, holds) in [
        ("scene.objects[0].size = 2", true),
        ("scene.objects[0].size = 2.1", false),
        ("scene.objects[0].material.k_d = 0.8", true),
        ("scene.objects[0].material.k_d <= 0.8", true),
        ("scene.objects[0].material.k_d > 0.8", false),
        ("scene.objects[0].reflection_model = \"blinn_phong\"", true),
        ("scene.objects[0].rotation[2] = 0", true),
        ("scene.objects[0].visible", true),
        ("code.open and code.errors = 2 and not code.custom", true),
        ("code.declares.alpha and not code.declares.no_such", true),
        ("code.declares.no_such or code.errors > 2", false),
        ("scene.objects.count = 1 and scene.lights.count = 1", true),
        ("scene.variants.count > 0", false),
        ("scene.lights[0].intensity ≥ 20", true),
        ("scene.lights[0].position[1] = 8", true),
        ("scene.display.exposure = 0", true),
        ("scene.display.encoding != \"off\"", true),
        ("scene.observer.field_of_view = 45°", true),
        ("scene.scene_size.width = 1000%", true),
        ("scene.shading_model = \"gouraud\"", true),
        ("scene.comparison.layout = \"single\"", true),
        ("window.selected = \"object\" and window.selected_index = 1", true),
        ("window.channel = \"n_dot_l\"", true),
        ("window.channel = \"none\"", false),
        ("window.terms = \"specular\" and window.shows_term_alone", true),
        ("window.views = 2 and window.active = \"B\"", true),
        ("window.plots = \"albedo\"", true),
        ("window.explain and not window.presenting", true),
        ("window.reflection_model = \"blinn_phong\"", true),
        ("window.shading_model = \"phong\"", false),
        ("knob.alpha = 20", true),
        ("knob.alpha > 20", false),
        ("knob.size ≤ 2 and knob.exposure = 0", true),
        ("20 = knob.alpha", true),
        ("knob.alpha = 19 or knob.alpha = 20", true),
        ("not (knob.alpha = 19 or knob.alpha = 20)", false),
        // `and` binds closer.
        ("knob.alpha = 20 or knob.alpha = 19 and knob.alpha = 18", true),
        ("(knob.alpha = 20 or knob.alpha = 19) and knob.alpha = 18", false),
        ("knob.alpha = 2e1", true),
        ("knob.alpha > -1", true),
    ] {
        assert_eq!(condition(text).holds(&situation), holds, "{text}");
        assert_eq!(condition(text).missing(&situation), None, "{text}");
    }
}

#[test]
fn curves_follow_the_parameters_of_the_selected_object() {
    let registry = Registry::builtin();
    let width = |alpha: i64| {
        let scene = scene(alpha);
        let quantity = quantity::asked("curve.highlight_width").expect("known");
        match quantity.value(&situation(&scene, &registry)) {
            Ok(Value::Number(width)) => width,
            other => panic!("{other:?}"),
        }
    };
    // cos^α = ½ about the normal by the half vector, so twice as far for the viewer, on both sides.
    for alpha in [100, 1000] {
        let expected = 4.0 * 0.5f64.powf(1.0 / alpha as f64).acos().to_degrees();
        assert!((width(alpha) / expected - 1.0).abs() < 0.01, "{alpha}: {} {expected}", width(alpha));
    }
    let mut matte = Scene::default();
    matte.objects[0].material.set("base_colour", Given::Colour([90, 200, 40]));
    let matte = situation(&matte, &registry);
    // Lambert reflects the same colour at every angle.
    let object = &matte.scene.objects[0];
    let entry = registry.model("lambert").expect("built in");
    let colour = object.material.colour(entry.parameter("base_colour").expect("has one"), Encoding::Srgb);
    let expected = f64::from(colour.max_element());
    for text in ["curve.albedo(30)", "curve.albedo(80)", "curve.largest_albedo"] {
        let asked = quantity::asked(text).expect("known");
        let Ok(Value::Number(found)) = asked.value(&matte) else { panic!("{text}") };
        assert!((found - expected).abs() < 1e-4, "{text}: {found} {expected}");
    }
    // A smooth pane mirrors light without spreading it, which counts too.
    let pane = Scene { reflection_model: "thin_glass".to_owned(), ..Scene::default() };
    let pane = situation(&pane, &registry);
    let asked = quantity::asked("curve.albedo(0)").expect("known");
    let Ok(Value::Number(found)) = asked.value(&pane) else { panic!("the albedo of a pane") };
    assert!((0.05..0.1).contains(&found), "{found}");
    assert!(condition("curve.peak = 0").holds(&matte));
    assert_eq!(
        condition("curve.highlight_width < 5").missing(&matte).as_deref(),
        Some("Lambert has no highlight")
    );
    assert!(!condition("curve.highlight_width < 5").holds(&matte));
    assert!(!condition("not curve.highlight_width < 5").holds(&matte), "undecided");
    let room = Situation { selection: Selection::Room, ..matte };
    assert_eq!(condition("curve.peak > 0").missing(&room).as_deref(), Some("no object is selected"));
}

#[test]
fn the_pinned_pixel_is_that_of_the_explanation() {
    let registry = Registry::builtin();
    let mut scene = scene(20);
    scene.objects[0].tessellation = Some(3);
    let settings = Settings { width: 320, height: 180, ..Settings::default() };
    let explained = |at| explain::pixel(&scene, &registry, &settings, at).expect("inside");
    let middle = explained([160, 90]);
    let nothing = situation(&scene, &registry);
    assert_eq!(condition("probe.red > 0").missing(&nothing).as_deref(), Some("nothing is pinned"));
    assert!(condition("not probe.pinned").holds(&nothing));
    let at = |probe| Situation { probe: Some(probe), pinned: true, ..situation(&scene, &registry) };
    let pinned = at(&middle);
    let [red, green, blue] = middle.code();
    let spot = middle.seen.as_ref().and_then(|seen| seen.per_pixel.as_ref()).expect("Gouraud");
    let lit = spot.brightest()[0];
    let cosine = lit.geometry.expect("a point light").cosine("N·L");
    for text in [
        format!("probe.red = {red} and probe.green = {green} and probe.blue = {blue}"),
        "probe.pinned and not probe.background and probe.object = \"object 1\"".to_owned(),
        format!("probe.n_dot_l = {cosine} and probe.angle_n_l = {}", cosine.acos().to_degrees()),
        format!("probe.light_distance = {}", lit.distance.expect("a point light")),
        "probe.luminance > 0 and not probe.clipped".to_owned(),
        "probe.n_dot_v > 0.9 and probe.angle_n_v < 26 and probe.n_dot_h > probe.n_dot_l".to_owned(),
    ] {
        assert!(condition(&text).holds(&pinned), "{text}: {:?}", condition(&text).missing(&pinned));
    }
    let corner = explained([0, 0]);
    assert!(condition("probe.background").holds(&at(&corner)));
    assert_eq!(
        condition("probe.n_dot_l > 0").missing(&at(&corner)).as_deref(),
        Some("there is no object at the pinned pixel")
    );
}

#[test]
fn the_brightest_vertex_is_found_where_it_is_and_nowhere_else() {
    let registry = Registry::builtin();
    let mut scene = scene(20);
    scene.objects[0].tessellation = Some(3);
    let settings = Settings { width: 160, height: 90, ..Settings::default() };
    let find = condition("probe.brightest_vertex");
    let mut explainer = explain::Explainer::default();
    let (mut found, mut brightest_found, mut brightest) = (0, 0.0f32, 0.0f32);
    for y in (0..90).step_by(1) {
        for x in (40..120).step_by(1) {
            let explained = explainer.pixel(&scene, &registry, &settings, [x, y]).expect("inside");
            let Some(seen) = &explained.seen else { continue };
            let light = crate::optics::colour::luminance(seen.light);
            brightest = brightest.max(light);
            let here = Situation { probe: Some(&explained), pinned: true, ..situation(&scene, &registry) };
            if find.holds(&here) {
                found += 1;
                brightest_found = brightest_found.max(light);
            }
        }
    }
    assert!(found > 0 && found < 400, "{found}");
    assert_eq!(brightest_found, brightest, "the brightest pixel is beside the brightest vertex");
    scene.shading_model = "phong".to_owned();
    let explained = explain::pixel(&scene, &registry, &settings, [80, 45]).expect("inside");
    let here = Situation { probe: Some(&explained), pinned: true, ..situation(&scene, &registry) };
    assert!(!find.holds(&here) && find.missing(&here).is_some());
}

#[test]
fn a_highlight_is_where_the_specular_term_wins() {
    let registry = Registry::builtin();
    let mut scene = scene(50);
    scene.shading_model = "phong".to_owned();
    scene.objects[0].material.set("k_s", Given::Number(0.5));
    scene.objects[0].material.set("base_colour", Given::Colour([20; 3]));
    let settings = Settings { width: 160, height: 90, ..Settings::default() };
    let text = condition("probe.is_highlight");
    let mut angles: [f32; 2] = [0.0, 180.0];
    let mut explainer = explain::Explainer::default();
    for y in 0..90 {
        for x in 40..120 {
            let explained = explainer.pixel(&scene, &registry, &settings, [x, y]).expect("inside");
            let Some(seen) = &explained.seen else { continue };
            let angle =
                explain::angle(seen.spots[0].lights[0].geometry.expect("a point light").cosine("N·H"));
            let here = Situation { probe: Some(&explained), pinned: true, ..situation(&scene, &registry) };
            if text.holds(&here) {
                angles[0] = angles[0].max(angle);
            } else {
                angles[1] = angles[1].min(angle);
            }
        }
    }
    // Only near the half vector.
    assert!(angles[0] > 3.0 && angles[0] < 30.0 && angles[1] > 3.0, "{angles:?}");
}

/// Conditions that cannot be parsed: the condition, the byte, and the beginning of the sentence.
const BROKEN: &[(&str, usize, &str)] = &[
    ("", 0, "expected a quantity or a value, not the end"),
    ("knob.alpha <", 12, "expected a quantity or a value, not the end"),
    ("knob.alpha < < 3", 13, "expected a quantity or a value, not \"<\""),
    ("knob.alpha 3", 11, "expected “and”, “or” or the end of the condition, not \"3\""),
    ("(knob.alpha < 3", 0, "this bracket is never closed"),
    ("knob.alpha < 3)", 14, "there is no opening bracket"),
    ("1 < knob.alpha < 3", 15, "a comparison has two sides"),
    ("knob.alpha < 3 && probe.pinned", 15, "conditions are joined with the word “and”"),
    ("knob.alpha < 3 || probe.pinned", 15, "conditions are joined with the word “or”"),
    ("!probe.pinned", 0, "a condition is negated with the word “not”"),
    ("knob.alpha < 3x", 13, "\"3x\" is not a number"),
    ("knob.alpha < 1e999", 13, "\"1e999\" is not a number"),
    ("knob.alpha < NaN", 13, "there is no quantity \"NaN\""),
    ("window.terms = \"all", 15, "this text is never closed"),
    ("window.terms = 'all'", 15, "text needs straight double quotes"),
    ("window.terms = all", 15, "there is no quantity \"all\"; text needs double quotes"),
    ("probe.pined", 0, "there is no quantity \"probe.pined\"; did you mean \"probe.pinned\"?"),
    ("curve.albedo < 1", 0, "the angle of the viewer is missing"),
    ("curve.albedo(90) < 1", 13, "the angle is \"90\", but it must be at least 0° and less than 90°"),
    ("curve.albedo(NaN) < 1", 13, "the angle is \"NaN\""),
    ("probe.angle_n_l < 20 degrees", 21, "degrees are written °: write 20°"),
    ("probe.angle_n_l < 20 Degree and probe.pinned", 21, "degrees are written °: write 20°"),
    ("probe.angle_n_l < 2.5deg", 21, "degrees are written °: write 2.5°"),
    ("curve.albedo(30) < 50 percent", 22, "per cent are written %: write 50%"),
    ("knob.alpha < 3 metres", 15, "expected “and”, “or” or the end of the condition, not \"metres\""),
    ("curve.peak(3) < 1", 0, "there is no quantity \"curve.peak(3)\""),
    ("scene.objects[1 = 2", 13, "this bracket is never closed"),
    ("scene.objects[-1].size = 2", 14, "\"-1\" is not an index"),
    ("scene. = 2", 0, "the path is missing"),
    ("§", 0, "\"§\" has no meaning in a condition"),
];

#[test]
fn broken_conditions_say_where_and_why() {
    for (text, at, expected) in BROKEN {
        match Condition::parse(text) {
            Ok(read) => panic!("{read:?}"),
            Err((found, what)) => {
                assert!(what.starts_with(expected), "{text}: {what}");
                assert_eq!(found, *at, "{text}: {what}");
            }
        }
    }
    for deep in ["(".repeat(5000), "not ".repeat(5000)] {
        assert!(Condition::parse(&deep).is_err_and(|(_, what)| what.contains("24 levels")));
    }
    // Long is not deep, but every comparison takes time.
    let long = |n: usize| Condition::parse(&vec!["knob.alpha < 3"; n].join(" and "));
    assert!(long(16).is_ok());
    assert!(long(17).is_err_and(|(at, what)| at == 16 * 19 && what.contains("at most 16 comparisons")));
    let named = |n: usize| Condition::parse(&format!("window.selected = \"{}\"", "x".repeat(n)));
    assert!(named(900).is_ok());
    assert!(named(1000).is_err_and(|(at, what)| at == 1000 && what.contains("more than 1000 characters")));
}

/// Conditions that make no sense in the default scene with its object selected.
const SENSELESS: &[(&str, usize, &str)] = &[
    ("scene.objects[3].size > 1", 0, "there is no objects[3]: the scene has 1 object"),
    ("scene.objects[0].sise > 1", 0, "objects[0] has no \"sise\"; did you mean \"size\"?"),
    ("scene.objekts[0].size > 1", 0, "a scene has no \"objekts\"; did you mean \"objects\"?"),
    ("scene.objects > 1", 0, "objects is a list"),
    ("scene.objects[0].position > 1", 0, "objects[0].position is a list"),
    ("scene.display > 1", 0, "display is not a single value"),
    ("scene.objects[0].size.x > 1", 0, "objects[0].size is a single value"),
    (
        "scene.objects[0].material.alhpa > 1",
        0,
        "objects[0].material has no \"alhpa\"; did you mean \"alpha\"?",
    ),
    ("knob.alhpa > 1", 0, "there is no parameter \"alhpa\"; did you mean \"alpha\"?"),
    ("knob.base_colour = 1", 0, "base_colour is three numbers"),
    ("knob.cone_angle > 1", 0, "the part that the step selects has no knob \"cone_angle\""),
    ("window.terms < \"all\"", 0, "this is a text, which cannot be greater or less"),
    ("probe.pinned > false", 0, "this is true or false, which cannot be greater or less"),
    ("probe.red = \"red\"", 12, "this is a text, but the other side is a number"),
    ("probe.pinned = 1", 15, "this is a number, but the other side is true or false"),
    ("probe.red", 0, "this is a number, which alone is neither true nor false"),
    ("window.terms", 0, "this is a text, which alone is neither true nor false"),
    ("window.channel = \"n_dot_q\"", 17, "window.channel is never \"n_dot_q\""),
    (
        "window.reflection_model = \"fong\"",
        26,
        "window.reflection_model is never \"fong\"; did you mean \"phong\"?",
    ),
    ("scene.shading_model = \"goraud\"", 22, "scene.shading_model is never \"goraud\""),
    ("1 = 2", 0, "the condition asks for no quantity"),
    // Never true.
    ("probe.n_dot_l > 2", 16, "probe.n_dot_l is never more than 2; it ranges from -1 to 1"),
    ("2 < probe.n_dot_l", 0, "probe.n_dot_l is never more than 2; it ranges from -1 to 1"),
    ("probe.n_dot_l > 1", 16, "probe.n_dot_l is never more than 1"),
    ("probe.red >= 300", 13, "probe.red is never at least 300; it ranges from 0 to 255"),
    ("probe.red = 256", 12, "probe.red is never 256"),
    ("not probe.red < 256", 16, "probe.red is never at least 256"),
    ("probe.luminance < 0", 18, "probe.luminance is never less than 0; its smallest value is 0"),
    ("window.views > 4", 15, "window.views is never more than 4; it ranges from 1 to 4"),
    ("curve.largest_albedo <= -1", 24, "curve.largest_albedo is never at most -1"),
    ("knob.k_d < 0.5", 11, "knob.k_d is never less than 0.5; it ranges from 0.5 to 1"),
    (
        "scene.objects[0].material.base_colour[1] > 255",
        43,
        "scene.objects[0].material.base_colour[1] is never more than 255",
    ),
    ("scene.lights.count < 0", 21, "scene.lights.count is never less than 0"),
    (
        "probe.pinned and probe.object = \"tomatoe\"",
        32,
        "probe.object is never \"tomatoe\"; it is tomato; did you mean \"tomato\"?",
    ),
];

#[test]
fn senseless_conditions_say_where_and_why() {
    let registry = Registry::builtin();
    let mut scene = Scene::default();
    scene.objects[0].name = Some("tomato".to_owned());
    for (text, at, expected) in SENSELESS {
        let found = condition(text).problems(&scene, Some(Selection::Object(0)), &registry);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert!(found[0].1.starts_with(expected), "{text}: {}", found[0].1);
        assert_eq!(found[0].0, *at, "{text}");
    }
    // A curve needs an object.
    let room = condition("curve.peak > 1").problems(&scene, Some(Selection::Room), &registry);
    assert_eq!(room.len(), 1);
    assert!(condition("curve.peak > 1").problems(&scene, None, &registry).is_empty());
    // The ends of ranges can be reached, a learner may add objects, and impossible values may be excluded.
    for sound in [
        "probe.red = 255 and probe.n_dot_l <= -1 and probe.luminance = 0 and knob.k_d >= 1 and knob.alpha > 9e9",
        "probe.object = \"tomato\" or probe.object = \"object 2\"",
        "not probe.red > 300 and probe.green != 300 and scene.lights[0].colour[0] >= 255",
    ] {
        assert_eq!(condition(sound).problems(&scene, Some(Selection::Object(0)), &registry), [], "{sound}");
    }
    // The path of a variant may have no value yet.
    let sound = "scene.comparison.layout = \"wipe\" and knob.alpha > 5 and probe.red < 5 or window.views > 1";
    assert_eq!(condition(sound).problems(&scene, Some(Selection::Object(0)), &registry), []);
}

#[test]
fn every_quantity_is_reachable_by_its_name() {
    for quantity in QUANTITIES.iter() {
        let name =
            quantity.name.replace("PATH", "name").replace("PARAMETER", "alpha").replace("DEGREES", "30");
        let asked = quantity::asked(&name).unwrap_or_else(|(_, what)| panic!("{what}"));
        assert_eq!(asked.quantity.name, quantity.name);
        assert!(!quantity.meaning.is_empty() && !quantity.meaning.ends_with('.'), "{name}");
    }
}

#[test]
fn the_part_that_fails_is_said_with_its_value() {
    let registry = Registry::builtin();
    let mut scene = scene(15);
    scene.objects[0].material.set("base_colour", Given::Colour([230, 68, 30]));
    let situation = situation(&scene, &registry);
    for (text, said) in [
        // Numbers, with their units and the digits needed to distinguish them from their limit.
        ("knob.alpha > 50", "the shininess α is 15; it must be above 50"),
        ("50 < knob.alpha", "the shininess α is 15; it must be above 50"),
        ("not knob.alpha <= 50", "the shininess α is 15; it must be above 50"),
        ("knob.alpha <= 14.9999", "the shininess α is 15; it must be at most 14.9999"),
        ("knob.k_d > 0.8", "the diffuse coefficient k_d is 0.8; it must be above 0.8"),
        ("scene.display.exposure >= 1", "the exposure is 0 EV; it must be at least 1 EV"),
        (
            "knob.alpha < knob.k_d",
            "the shininess α is 15; it must be below the diffuse coefficient k_d, which is 0.8",
        ),
        (
            "scene.objects[0].material.base_colour[0] > 200 and scene.objects[0].material.base_colour[1] < 60",
            "green of the base colour is 68; it must be below 60",
        ),
        ("scene.lights[0].position[2] < 0", "z of the position is 9 m; it must be below 0 m"),
        ("scene.objects[0].rotation[1] > 10", "y of the rotation is 0°; it must be above 10°"),
        ("scene.lights[0].colour[2] < 10", "blue of the colour is 255; it must be below 10"),
        ("scene.objects.count = 2", "the number of objects is 1; it must be higher"),
        // A number that must be met exactly is the solution.
        ("knob.k_s = 0", "the specular coefficient k_s is 0.5; it must be lower"),
        ("knob.alpha != 15", "the shininess α is 15; it must be another number"),
        // Names, without the required one.
        ("window.reflection_model = \"phong\"", "the reflection model is Blinn–Phong"),
        ("scene.objects[0].shading_model = \"flat\"", "the shading model is Gouraud"),
        (
            "window.reflection_model != \"blinn_phong\"",
            "the reflection model is Blinn–Phong; it must be another",
        ),
        ("window.terms = \"all\"", "the specular term alone is shown"),
        ("window.channel = \"none\"", "the picture shows the debug channel N·L"),
        ("window.active = \"A\" and knob.alpha > 50", "view B is active"),
        ("window.selected = \"light\"", "an object is selected"),
        ("window.selected_index = 2", "object 1 is selected"),
        ("window.plots = \"off\"", "the plot that is shown is that of the directional albedo E"),
        ("scene.display.encoding = \"off\"", "the encoding is sRGB"),
        ("scene.display.tone_mapping = \"reinhard\"", "the tone mapping is None (clip)"),
        // True and false.
        ("window.presenting", "the picture is not presented"),
        ("not window.explain", "the panel Explain is open"),
        ("window.explain = false", "the panel Explain is open"),
        ("scene.objects[0].visible = false", "visible is true"),
        ("probe.pinned", "nothing is pinned"),
        ("probe.n_dot_l > 0.5", "nothing is pinned"),
        // The first part that fails, and all alternatives.
        ("probe.n_dot_l > 0.5 and window.active = \"A\"", "nothing is pinned"),
        (
            "knob.alpha > 50 or knob.k_s < 0.1",
            "the shininess α is 15; it must be above 50. Or: the specular coefficient k_s is 0.5; it must be below 0.1",
        ),
        ("window.terms = \"all\" or window.terms = \"diffuse\"", "the specular term alone is shown"),
        ("not (knob.alpha < 20 or knob.k_s < 1)", "the shininess α is 15; it must be at least 20"),
        (
            "not (knob.alpha < 20 and knob.k_s < 1)",
            "the shininess α is 15; it must be at least 20. Or: the specular coefficient k_s is 0.5; it must be at least 1",
        ),
    ] {
        assert_eq!(condition(text).unmet(&situation).as_deref(), Some(said), "{text}");
    }
    assert_eq!(condition("knob.alpha = 15").unmet(&situation), None);
    let albedo = condition("curve.albedo(30) > 10").unmet(&situation).unwrap_or_default();
    assert!(
        albedo.starts_with("the albedo at 30° is ") && albedo.ends_with("; it must be above 10"),
        "{albedo}"
    );
    let width = condition("curve.highlight_width < 20°").unmet(&situation).unwrap_or_default();
    assert!(
        width.starts_with("the width of the highlight is ") && width.ends_with("°; it must be below 20°"),
        "{width}"
    );
    // Only one of several parts is named.
    let mut two = scene.clone();
    two.objects.push(two.objects[0].clone());
    two.objects[1].name = Some("ball".to_owned());
    let two = Situation { scene: &two, ..situation };
    assert_eq!(
        condition("scene.objects[1].size > 3 or scene.objects[0].size > 3").unmet(&two).as_deref(),
        Some(
            "the size of “ball” is 2 m; it must be above 3 m. Or: the size of object 1 is 2 m; it must be above 3 m"
        )
    );
}

#[test]
fn a_numbered_choice_is_said_with_the_number_that_it_must_be() {
    let registry = Registry::builtin();
    let mut scene = scene(15);
    scene.lights[0].light_type = "environment".to_owned();
    scene.lights[0].parameters.set("sky_type", Given::Choice("5".into()));
    let situation = situation(&scene, &registry);
    for (text, said) in [
        ("scene.lights[0].sky_type = \"12\"", "the type of sky is 5 uniform; it must be 12 clear"),
        ("\"12\" = scene.lights[0].sky_type", "the type of sky is 5 uniform; it must be 12 clear"),
        ("not scene.lights[0].sky_type != \"12\"", "the type of sky is 5 uniform; it must be 12 clear"),
        ("scene.lights[0].sky_type != \"5\"", "the type of sky is 5 uniform; it must be another"),
        // A name is not given away.
        ("scene.lights[0].source = \"sky\"", "the source is studio"),
    ] {
        assert_eq!(condition(text).unmet(&situation).as_deref(), Some(said), "{text}");
    }
}

#[test]
fn the_pinned_pixel_says_how_near_it_is() {
    let registry = Registry::builtin();
    let scene = scene(20);
    let settings = Settings { width: 160, height: 90, ..Settings::default() };
    let explained = explain::pixel(&scene, &registry, &settings, [80, 45]).expect("inside");
    let here = Situation { probe: Some(&explained), pinned: true, ..situation(&scene, &registry) };
    let said = |text: &str| condition(text).unmet(&here).unwrap_or_default();
    let spot = explained.seen.as_ref().and_then(|seen| seen.per_pixel.as_ref()).expect("Gouraud");
    let cosine = f64::from(spot.brightest()[0].geometry.expect("a point light").cosine("N·L"));
    assert!(cosine > 0.5 && cosine < 0.98);
    assert_eq!(
        said("probe.n_dot_l > 0.98"),
        format!("N·L is {}; it must be above 0.98", (cosine * 1e3).round() / 1e3)
    );
    // A limit so close that three digits cannot distinguish it.
    let near = cosine + 1e-6;
    let close = said(&format!("probe.n_dot_l > {near}"));
    let shown: f64 =
        close.split(' ').nth(2).and_then(|word| word.trim_end_matches(';').parse().ok()).expect("a number");
    assert!(shown < near, "{close}");
    assert_eq!(said("probe.object = \"x\""), "the pinned pixel is on “object 1”");
    assert_eq!(said("probe.background"), "the pinned pixel shows an object");
    assert!(
        said("probe.angle_n_l > 90°").starts_with("the angle between N and L is "),
        "{}",
        said("probe.angle_n_l > 90°")
    );
    assert_eq!(
        said("probe.is_highlight"),
        "the specular term is not brighter than the diffuse one at the pinned pixel"
    );
    assert!(said("probe.brightest_vertex").contains("vertex"));
}
