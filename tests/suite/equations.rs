//! Equations in the panel: their sizes and colours, and pictures of all of them to be looked at
//! (`LCM_PANEL_PICTURES=folder`).

use std::path::PathBuf;

use bevy_egui::egui::{Color32, Shape, vec2};
use lights_camera_models::{
    panel::{
        state::{Action, ThemeChoice, ViewChange},
        theme,
    },
    reflection::Term,
    registry::Registry,
};

use crate::panels::Bench;

/// The runs of text of the frame, with their sizes and colours.
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
        // Indices are smaller.
        let term =
            of("s").into_iter().filter(|(.., colour)| *colour == specular).map(|t| t.1).fold(0.0, f32::max);
        // "exp" stands in the definition of D only.
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

#[test]
fn pictures_of_all_equations() -> Result<(), Box<dyn std::error::Error>> {
    let Some(folder) = std::env::var_os("LCM_PANEL_PICTURES").map(PathBuf::from) else { return Ok(()) };
    std::fs::create_dir_all(&folder)?;
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
