//! The lines of the controls: visible without scrolling, or with a sign that there are more.

use bevy_egui::egui::{
    Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Rect, Shape, TouchPhase, accesskit::Role,
    vec2,
};
use lights_camera_models::{
    document::{Edit, Selection},
    panel::{
        state::{Action, CompareCommand, Session, ThemeChoice, ViewChange},
        theme,
    },
    parameter::{Value, Values},
    registry::Registry,
    scene::{Background, Display, Light, Part, Scene, examples::EXAMPLES},
};

use crate::window::panels::{Bench, Seen};

/// A laptop's window with the only object of the default scene selected.
fn laptop(model: &str) -> Bench {
    let mut bench = Bench::with_model(model);
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Select(Selection::Object(0)));
    bench
}

fn widget(bench: &Bench, role: Role, label: &str) -> Seen {
    let found = bench.tree.iter().find(|s| s.role == role && s.label.starts_with(label));
    found.unwrap_or_else(|| panic!("no {role:?} “{label}”")).clone()
}

#[test]
fn every_knob_of_phong_is_seen_at_1280_by_720_without_scrolling() {
    for theme in [ThemeChoice::Dark, ThemeChoice::Light] {
        for model in ["phong", "blinn_phong"] {
            let mut bench = laptop(model);
            bench.apply(Action::View(ViewChange::Theme(theme)));
            // The panel spans from the bar at the top to the line at the bottom, like the picture.
            let seen = bench.area.rect.y_range();
            let labels = ["ambient coefficient", "diffuse coefficient", "specular coefficient", "shininess"];
            for label in labels {
                let field = bench.field(label).rect;
                let slider = widget(&bench, Role::Slider, label).rect;
                for rect in [field, slider] {
                    assert!(
                        seen.contains(rect.top()) && seen.contains(rect.bottom()),
                        "{model}: {label} is at {rect:?}, beyond {seen:?}"
                    );
                }
                assert!((field.center().y - slider.center().y).abs() < 1.0, "{label}: on two lines");
                assert!(slider.right() <= field.left() && slider.width() >= 64.0, "{label}: {slider:?}");
                assert!(field.right() < 1280.0);
            }
        }
    }
}

#[test]
fn sliders_and_fields_stand_in_line() {
    let bench = Bench::with_model("phong");
    let lefts = |role: Role| -> Vec<i32> {
        let labels = ["ambient coefficient", "diffuse coefficient", "shininess", "size", "tessellation"];
        labels.map(|label| widget(&bench, role, label).rect.left().round() as i32).to_vec()
    };
    for role in [Role::Slider, Role::TextInput] {
        let lefts = lefts(role);
        assert!(lefts.iter().all(|x| *x == lefts[0]), "{role:?}: {lefts:?}");
    }
}

#[test]
fn the_material_stands_above_the_shape() {
    let bench = Bench::with_model("phong");
    let lowest = bench.field("shininess").rect.bottom();
    for label in ["size", "position x", "rotation x", "tessellation"] {
        assert!(bench.field(label).rect.top() > lowest, "{label}");
    }
}

#[test]
fn the_tooltip_says_where_range_and_slider_end() {
    let mut bench = Bench::with_model("phong");
    let at = widget(&bench, Role::Slider, "diffuse coefficient").rect.center();
    bench.hover(at);
    assert!(bench.says("Between 0.5 and 1") && bench.says("Default 0.8"));
    for role in [Role::Slider, Role::TextInput] {
        let at = widget(&bench, role, "shininess").rect.center();
        bench.hover(at);
        assert!(bench.says("Slider: 0 to 512. Larger values can be typed"), "{role:?}");
    }
}

/// The bars at the right edge of the window: narrow and long, in a different colour than the panel.
fn scroll_bars(bench: &mut Bench) -> Vec<Rect> {
    let right = bench.size.x;
    let bar = |shape: &Shape| match shape {
        Shape::Rect(r) => {
            let thin = r.rect.width() <= 10.0 && r.rect.height() >= 40.0 && r.rect.left() > right - 24.0;
            (thin && r.fill.a() > 100).then_some(r.rect)
        }
        _ => None,
    };
    bench.shapes().iter().filter_map(bar).collect()
}

#[test]
fn the_properties_begin_at_the_top_for_another_document_or_part() {
    let mut bench = laptop("disney");
    bench.size.y = 500.0;
    bench.settle();
    let top = |bench: &Bench| bench.field("Name").rect.top();
    let scroll = |bench: &mut Bench| {
        let at = bench.ctx.content_rect().lerp_inside(vec2(0.86, 0.55));
        let (unit, phase, modifiers) = (MouseWheelUnit::Point, TouchPhase::Move, Modifiers::NONE);
        bench.frame(vec![Event::PointerMoved(at)]);
        bench.frame(vec![Event::MouseWheel { unit, delta: vec2(0.0, -120.0), phase, modifiers }]);
        (0..10).for_each(|_| bench.settle());
        top(bench)
    };
    let first = top(&bench);
    let scrolled = scroll(&mut bench);
    assert!(scrolled < first - 60.0, "{scrolled} after {first}");
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "clearcoat", Value::Number(0.25))));
    assert!((top(&bench) - scrolled).abs() < 1.0, "after an edit");
    bench.apply(Action::Undo);
    assert!((top(&bench) - scrolled).abs() < 1.0, "after undo");
    bench.apply(Action::Select(Selection::Object(0)));
    assert!((top(&bench) - scrolled).abs() < 1.0, "the same part");
    bench.apply(Action::Select(Selection::Observer));
    bench.apply(Action::Select(Selection::Object(0)));
    assert!((top(&bench) - first).abs() < 1.0, "another part: {}", top(&bench));
    assert!(scroll(&mut bench) < first - 60.0);
    let other = EXAMPLES.iter().position(|example| example.name == "Default scene").expect("shipped");
    bench.apply(Action::OpenExample(other));
    assert_ne!(bench.session.document.reflection_model, "disney");
    assert!((top(&bench) - first).abs() < 1.0, "another document: {}", top(&bench));
}

#[test]
fn a_scroll_bar_is_there_whenever_there_is_more() {
    let mut bench = laptop("disney");
    assert!(!scroll_bars(&mut bench).is_empty(), "nothing says that there are more knobs");
    let mut tall = Bench::with_model("lambert");
    assert!(scroll_bars(&mut tall).is_empty(), "nothing is hidden");
}

#[test]
fn model_and_shading_of_one_object_are_overridden_beside_the_name_of_the_model() {
    let mut bench = laptop("phong");
    let control = "Override model and shading: none";
    let at = bench.find(control).expect("there").rect;
    let terms = bench.find("Terms: all").expect("below").rect;
    assert!(at.bottom() < terms.top() && at.height() < 30.0);
    bench.click(control);
    bench.click("Shading of this object: Flat");
    assert_eq!(bench.session.document.objects[0].shading_model.as_deref(), Some("flat"));
    assert!(bench.says("Override model and shading: Flat shading"));
    bench.click("Lambert");
    assert_eq!(bench.session.document.objects[0].reflection_model.as_deref(), Some("lambert"));
    assert_eq!(bench.session.document.reflection_model, "phong");
    assert!(bench.find("Shading of this object: Flat").is_none(), "choosing a model closes the list");
    bench.click("Override model and shading: Lambert, Flat shading");
    bench.click("Shading of this object: Scene default");
    bench.click("Scene default (Phong)");
    let object = &bench.session.document.objects[0];
    assert_eq!((&object.reflection_model, &object.shading_model), (&None, &None));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "lambert")));
    bench.click_at(bench.area.rect.center(), PointerButton::Primary);
    assert!(bench.find(control).is_some());
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_the_knobs() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    for (name, theme, ground) in
        [("dark", ThemeChoice::Dark, theme::DARK), ("light", ThemeChoice::Light, theme::LIGHT)]
    {
        let shot = |bench: &mut Bench, what: &str| {
            bench.picture(&folder.join(format!("knobs-{name}-{what}.png")), ground.surround)
        };
        let with = |model: &str| {
            let mut bench = laptop(model);
            bench.apply(Action::View(ViewChange::Theme(theme)));
            bench
        };
        let mut bench = with("phong");
        bench.click("Override model and shading: none");
        bench.click("Shading of this object: Flat");
        shot(&mut bench, "override")?;
        let mut bench = with("phong");
        let at = widget(&bench, Role::Slider, "shininess").rect.center();
        bench.hover(at);
        shot(&mut bench, "tooltip")?;
        let mut bench = with("microfacet");
        bench.size.y = 1080.0;
        bench.settle();
        let at = bench.field("exponent of GTR").rect.center();
        bench.hover(at);
        shot(&mut bench, "unused")?;
        shot(&mut with("disney"), "disney")?;
    }
    Ok(())
}

/// The painted texts, each with its position and true if some of it is cut.
fn painted(bench: &mut Bench) -> Vec<(String, Pos2, bool)> {
    let text = |shape| match shape {
        Shape::Text(t) => Some((t.galley.text().to_owned(), t.pos, t.galley.elided)),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(text).collect()
}

#[test]
fn knobs_and_authors_are_named_in_full() {
    for (size, scale) in [((1280.0, 4000.0), 100), ((1920.0, 4000.0), 100), ((1280.0, 4000.0), 150)] {
        for model in Registry::builtin().models() {
            let d = model.declaration;
            let mut bench = Bench::with_model(d.id);
            bench.size = size.into();
            bench.apply(Action::View(ViewChange::Scale(scale)));
            let panel = bench.area.rect.right();
            let texts: Vec<_> = painted(&mut bench).into_iter().filter(|(_, at, _)| at.x > panel).collect();
            let labels = model.parameters.iter().filter(|p| p.symbol != p.label).map(|p| p.label);
            for label in labels.chain([d.author]) {
                let whole = texts.iter().any(|(text, _, cut)| text == label && !cut);
                assert!(whole, "{}, {scale} %: “{label}” is not there in full", d.id);
            }
        }
    }
}

#[test]
fn the_background_has_a_choice_and_its_colours_and_is_undone() {
    let mut bench = laptop("phong");
    bench.size = vec2(1280.0, 900.0);
    bench.apply(Action::Select(Selection::Room));
    let choose = |bench: &mut Bench, from: &str, to: &str| {
        bench.click(&format!("background: {from}"));
        bench.click(to);
    };
    let labels = |bench: &Bench| {
        ["colour in", "colour at the top in", "colour at the bottom in"].map(|label| has_knob(bench, label))
    };
    assert_eq!(labels(&bench), [false; 3]);
    choose(&mut bench, "environment", "colour");
    assert_eq!(labels(&bench), [true, false, false]);
    choose(&mut bench, "colour", "gradient");
    assert_eq!(labels(&bench), [false, true, true]);
    let bottom = [10, 20, 30];
    bench.apply(Action::Edit(Edit::set(Part::Display, Display::background_bottom, bottom)));
    let backdrop = |bench: &Bench| bench.session.document.display.backdrop();
    assert_eq!(backdrop(&bench), Some([[255; 3], bottom]));
    for expected in [Some([[255; 3], [184; 3]]), Some([[255; 3]; 2]), None] {
        bench.apply(Action::Undo);
        assert_eq!(backdrop(&bench), expected);
    }
    assert_eq!(labels(&bench), [false; 3]);
    // In a view of a comparison it is that of the scene, since views do not have their own.
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Edit(Edit::from(Display { exposure: 1.0, ..Display::default() })));
    bench.apply(Action::Edit(Edit::set(Part::Display, Display::background, Background::Colour)));
    let document = &bench.session.document;
    assert_eq!((document.display.exposure, document.variants[0].exposure), (0.0, Some(1.0)));
    assert_eq!(document.display.background, Background::Colour);
}

#[test]
fn another_source_of_an_environment_keeps_its_mean_luminance_and_has_its_unit() {
    let registry = Registry::builtin();
    let entry = registry.light("environment").expect("built in");
    let environment = Light { light_type: "environment".to_owned(), intensity: 1.0, ..Light::default() };
    let scene = Scene { lights: vec![environment], ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1280.0, 900.0);
    bench.apply(Action::Select(Selection::Light(0)));
    let mean = |light: &Light| {
        f64::from(light.intensity) * entry.mean_luminance(&light.parameters).expect("it is all around")
    };
    let light = |bench: &Bench| bench.session.document.lights[0].clone();
    let first = mean(&light(&bench));
    for (from, to, unit) in [
        ("studio", "uniform", "cd/m²"),
        ("uniform", "sky", "×"),
        ("sky", "file", "×"),
        ("file", "studio", "×"),
    ] {
        let before = light(&bench);
        bench.click(&format!("source: {from}"));
        bench.click(to);
        bench.settle();
        let after = light(&bench);
        assert_eq!(
            after.parameters.get(entry.parameter("source").expect("declared")),
            Value::Choice(to.into())
        );
        assert!((mean(&after) / first - 1.0).abs() < 0.02, "{to}: {} instead of {first}", mean(&after));
        // The wrong twin: the same factor of another source.
        let wrong = mean(&Light { intensity: before.intensity, ..after.clone() });
        assert!((wrong / first - 1.0).abs() > 0.05, "{from} to {to}: {wrong} and {first}");
        assert_eq!(entry.unit(&after.parameters), unit);
        let line = bench.field("intensity").rect.center().y;
        let units = |texts: &[(String, Pos2, bool)]| -> Vec<String> {
            let near = |at: Pos2| (at.y - line).abs() < 14.0;
            let is_unit = |text: &str| ["cd/m²", "×"].contains(&text);
            texts
                .iter()
                .filter(|(text, at, _)| near(*at) && is_unit(text))
                .map(|(text, ..)| text.clone())
                .collect()
        };
        assert_eq!(units(&painted(&mut bench)), [unit], "{to}");
    }
    // One step for each.
    bench.apply(Action::Undo);
    assert_eq!(
        light(&bench).parameters.get(entry.parameter("source").expect("declared")),
        Value::Choice("file".into())
    );
    assert!((mean(&light(&bench)) / first - 1.0).abs() < 0.02);
    // Other parameters leave the intensity alone.
    let sky = entry.parameter("ground_reflectance").expect("declared");
    assert_eq!(light(&bench).setting(entry, sky, Value::Number(0.5)).len(), 1);
    let path = entry.parameter("path").expect("declared");
    let known = light(&bench).parameters.get(path);
    assert_eq!(light(&bench).setting(entry, path, known).len(), 1, "the same picture");
    // A lamp has no luminance that is the same everywhere.
    for id in ["point", "sphere", "sun"] {
        assert_eq!(registry.light(id).expect(id).mean_luminance(&Values::default()), None, "{id}");
    }
}

#[test]
fn derived_values_stand_in_line() {
    let mut bench = Bench::with_model("blinn_phong");
    let texts = painted(&mut bench);
    let left = |word: &str| texts.iter().find(|(text, ..)| text == word).map(|(_, at, _)| at.x);
    assert!(left("equivalent GGX α").is_some());
    assert_eq!(left("equivalent GGX α"), left("equivalent roughness"));
}

/// True if a control with this name exists.
fn has_knob(bench: &Bench, label: &str) -> bool {
    bench.tree.iter().any(|s| s.role == Role::TextInput && s.label.starts_with(label))
}

#[test]
fn the_groups_of_a_model_fold_and_say_how_much_is_changed() {
    let mut bench = Bench::with_model("disney");
    let order = ["Base", "metallic", "Specular", "roughness", "Sheen", "Clear coat", "clear coat"];
    let tops: Vec<_> = order
        .map(|label| {
            let found = bench.tree.iter().find(|s| s.label.starts_with(label));
            found.unwrap_or_else(|| panic!("no “{label}”")).rect.top()
        })
        .to_vec();
    assert!(tops.is_sorted(), "each knob below the heading of its group: {tops:?}");
    assert!(!bench.tree.iter().any(|s| s.label.starts_with("Sheen") && s.label.contains("changed")));
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "sheen", Value::Number(0.25))));
    bench.settle();
    let heading = bench.tree.iter().find(|s| s.label.starts_with("Sheen") && s.label.contains("1 changed"));
    let at = heading.expect("the heading counts").rect.center();
    assert!(has_knob(&bench, "sheen tint"));
    bench.click_at(at, PointerButton::Primary);
    for _ in 0..20 {
        bench.frame(Vec::new());
    }
    assert!(!has_knob(&bench, "sheen tint") && has_knob(&bench, "roughness"), "folded");
    // A model without groups has neither headings nor a filter.
    let bench = Bench::with_model("phong");
    assert!(bench.find("Only changed").is_none());
}

#[test]
fn the_filter_shows_what_differs_and_keeps_what_is_being_changed() {
    let mut bench = Bench::with_model("disney");
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "sheen", Value::Number(0.25))));
    bench.settle();
    bench.click("Only changed");
    bench.settle();
    assert!(has_knob(&bench, "sheen") && !has_knob(&bench, "sheen tint") && !has_knob(&bench, "roughness"));
    // Dragged to its default, the control stays until it is released.
    let slider = widget(&bench, Role::Slider, "sheen").rect;
    let press = |pressed, pos| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::default(),
    };
    let end = slider.left_center() - vec2(30.0, 0.0);
    bench.frame(vec![Event::PointerMoved(slider.center()), press(true, slider.center())]);
    bench.frame(vec![Event::PointerMoved(end)]);
    bench.frame(Vec::new());
    assert!(has_knob(&bench, "sheen"), "it is being dragged");
    bench.frame(vec![press(false, end)]);
    bench.key(Key::Escape, Modifiers::default());
    bench.frame(vec![Event::PointerMoved(Pos2::new(2.0, 2.0))]);
    bench.settle();
    assert!(!has_knob(&bench, "sheen"), "it has its default");
    assert!(bench.says("Every parameter has its default."));
    bench.click("Only changed");
    bench.settle();
    assert!(has_knob(&bench, "sheen") && has_knob(&bench, "roughness"));
}
