//! Equations in the panel: their sizes and colours, and pictures of all of them to be looked at
//! (`scripts/pictures`).

use bevy_egui::egui::{Color32, Event, FontFamily, Modifiers, PointerButton, Pos2, Shape, vec2};
use lights_camera_models::{
    document::{Edit, Selection},
    panel::{
        state::{Action, ThemeChoice, ViewChange},
        theme,
    },
    parameter::Value as Setting,
    reflection::Term,
    registry::Registry,
    scene::Part,
    text::{
        expression::{Expression, Scope, Value},
        mathematics::{parse, write},
    },
};

use crate::window::panels::Bench;

/// The text runs of the frame, with their sizes and colours.
fn texts(bench: &mut Bench) -> Vec<(String, f32, Color32)> {
    let run = |shape: &Shape| match shape {
        Shape::Text(text) => {
            let format = &text.galley.job.sections.first()?.format;
            Some((text.galley.text().to_owned(), format.font_id.size, format.color))
        }
        _ => None,
    };
    bench.shapes().iter().filter_map(run).collect()
}

#[test]
fn definitions_are_smaller_and_neutral_beside_terms_in_their_colours() {
    let mut bench = Bench::with_model("cook_torrance");
    for (choice, palette) in [(ThemeChoice::Dark, theme::DARK), (ThemeChoice::Light, theme::LIGHT)] {
        bench.apply(Action::View(ViewChange::Theme(choice)));
        let texts = texts(&mut bench);
        let of = |what: &str| -> Vec<_> { texts.iter().filter(|(t, ..)| t == what).collect() };
        let specular = palette.term_text(Term::Specular);
        // Subscripts are smaller.
        let term =
            of("s").into_iter().filter(|(.., colour)| *colour == specular).map(|t| t.1).fold(0.0, f32::max);
        // "exp" appears only in the definition of D.
        let exp = of("exp");
        let [(_, size, colour)] = exp.as_slice() else { panic!("{exp:?}") };
        assert!(*size < 0.9 * term, "{size} beside {term}");
        assert!(colour.r() == colour.g() && colour.g() == colour.b(), "{colour:?}");
    }
}

#[test]
fn no_dashes_stand_before_equations() {
    let mut bench = Bench::with_model("phong");
    let colours = [Term::Ambient, Term::Diffuse, Term::Specular].map(|t| theme::DARK.term(t));
    let lines = bench
        .shapes()
        .iter()
        .filter(|s| matches!(s, Shape::LineSegment { stroke, .. } if colours.contains(&stroke.color)))
        .count();
    assert_eq!(lines, 0);
}

/// The font families of a letter in an equation, and its positions.
fn letters(bench: &mut Bench, letter: &str) -> Vec<(FontFamily, Pos2)> {
    let run = |shape: &Shape| match shape {
        Shape::Text(t) if t.galley.text() == letter => {
            let format = &t.galley.job.sections.first()?.format;
            Some((format.font_id.family.clone(), t.pos + 0.5 * t.galley.size()))
        }
        _ => None,
    };
    bench.shapes().iter().filter_map(run).collect()
}

/// Lets light pass through the first object, or not.
fn pass(bench: &mut Bench, weight: f32) {
    let value = Setting::Number(weight);
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "transmission_weight", value)));
}

#[test]
fn an_opaque_surface_has_no_transmitted_term() {
    let mut bench = Bench::with_model("openpbr");
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Select(Selection::Object(0)));
    for presenting in [false, true] {
        bench.apply(Action::View(ViewChange::Presenting(presenting)));
        for weight in [0.0, 0.5, 0.0] {
            pass(&mut bench, weight);
            assert!(bench.says("I = I_d + I_s"), "{presenting}, {weight}");
            for words in ["I_s + I_t", "I_t = |N·L|", "I_t = π"] {
                assert_eq!(bench.says(words), weight > 0.0, "{presenting}, {weight}: {words}");
            }
        }
    }
}

#[test]
fn an_equation_keeps_its_terms_while_the_pointer_holds_a_knob() {
    let mut bench = Bench::with_model("openpbr");
    bench.apply(Action::Select(Selection::Object(0)));
    let pos = bench.area.rect.center();
    let button = |pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    bench.hover(pos);
    bench.frame(vec![button(true)]);
    pass(&mut bench, 0.5);
    assert!(bench.says("I = I_d + I_s") && !bench.says("I_s + I_t"), "no knob moves under the hand");
    bench.frame(vec![button(false)]);
    bench.settle();
    assert!(bench.says("I_s + I_t"));
}

#[test]
fn variables_are_slanted_wherever_they_stand() {
    // In a power, next to the imaginary unit, in a power with a fraction; and as often as they are written.
    for (model, letter, least) in [
        ("minnaert", "k", 3),
        ("cook_torrance", "k", 1),
        ("torrance_sparrow", "k", 1),
        ("strauss", "s", 5),
        ("blinn_phong_normalised", "α", 5),
    ] {
        let found = letters(&mut Bench::with_model(model), letter);
        assert!(found.len() >= least, "{model}: {letter} is a word of its own {} times", found.len());
        for (family, _) in found {
            assert_eq!(family, theme::maths_italic(), "{model}: {letter}");
        }
    }
}

#[test]
fn symbols_are_explained_on_hover() {
    for (model, letter, meaning) in [
        ("eon", "E", "albedo"),
        ("strauss", "F", "defined here: F(x) ="),
        ("strauss", "G", "defined here: G(x) ="),
        ("strauss", "γ", "defined here: γ = 2"),
        ("strauss", "α", "defined here: α = 2"),
        ("oren_nayar", "α", "defined here: α = max"),
        ("hapke", "H", "defined here: H(μ) ="),
        ("microfacet", "D", "distribution: "),
        ("microfacet", "G", "masking"),
        ("microfacet", "F", "Fresnel"),
        ("microfacet", "f", "diffuse base"),
    ] {
        let mut bench = Bench::with_model(model);
        let (_, at) = letters(&mut bench, letter)[0].clone();
        bench.hover(at);
        assert!(bench.says(meaning), "{model}: {letter} does not say “{meaning}”");
    }
}

#[test]
fn tooltips_have_no_raw_symbols_and_no_names_of_drafts() {
    for model in Registry::builtin().models() {
        let d = model.declaration;
        let parameters = model.parameters.iter().flat_map(|p| [p.label, p.help]);
        for text in [d.summary, d.source, d.author, d.name].into_iter().chain(parameters) {
            assert!(!text.contains('_') && !text.contains("CA IM"), "{}: {text}", d.id);
        }
    }
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_all_equations() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    for (name, choice, ground) in
        [("dark", ThemeChoice::Dark, theme::DARK), ("light", ThemeChoice::Light, theme::LIGHT)]
    {
        for model in Registry::builtin().models() {
            let mut bench = Bench::with_model(model.declaration.id);
            bench.size = vec2(1280.0, 720.0);
            bench.apply(Action::View(ViewChange::Theme(choice)));
            bench.picture(
                &folder.join(format!("equation-{name}-{}.png", model.declaration.id)),
                ground.surround,
            )?;
        }
    }
    Ok(())
}

/// Nothing has a value.
struct Nothing;

impl Scope for Nothing {
    fn value(&mut self, symbol: &str) -> Result<Value, String> {
        Err(symbol.to_owned())
    }

    fn call(&mut self, name: &str, _: &[String]) -> Result<Value, String> {
        Err(name.to_owned())
    }
}

#[test]
fn a_power_of_a_power_loses_no_letter() {
    for (text, expected) in [("x^y^z", "x^{y^z}"), ("x_a_b", "x_{a_b}"), ("x^{a + b}^2", "x^{(a + b)^2}")] {
        assert_eq!(write(&parse(text)), expected, "{text}");
        assert_eq!(write(&parse(expected)), expected);
    }
    let value = |text: &str| Expression::read(text).and_then(|read| read.value(&mut Nothing));
    assert_eq!(value("2^3^2"), Ok(Value::number(512.0)));
    assert_eq!(value("2^y^2"), Err("y".to_owned()), "it is asked for");
    assert!(value(&format!("2{}", "^1".repeat(25))).is_err_and(|why| why.contains("more than 24 deep")));
}
