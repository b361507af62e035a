//! The symbol under the pointer is highlighted in the equation, at its control, in the picture, in Explain
//! and in the plots.
//!
//! `scripts/pictures` writes pictures, to be looked at.

use std::{thread, time::Duration};

use bevy_egui::egui::{
    Color32, Event, Key, Modifiers, PointerButton, Pos2, Rect, Shape, accesskit::Role, epaint::ColorMode,
    vec2,
};
use lights_camera_models::{
    curves::Kind,
    document::{Edit, Selection},
    optics::colour::Encoding,
    panel::{
        explain::explained,
        state::{Action, EXPLAIN_TAB, Of, PLOTS_TAB, PlotCommand, Session, ThemeChoice, ViewChange},
        theme::{self, DARK},
    },
    parameter::Values,
    scene::{Light, Part, Scene},
};

use crate::window::panels::{Bench, Seen};

/// A window with a scene and a model, with the bottom panel that has this id.
fn bench(model: &str, tab: &str) -> Bench {
    let scene =
        Scene { reflection_model: model.to_owned(), shading_model: "phong".to_owned(), ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1600.0, 1200.0);
    bench.session.settings.bottom_height = 420.0;
    bench.apply(Action::Select(Selection::Object(0)));
    bench.apply(Action::View(ViewChange::BottomTab(tab.to_owned())));
    bench.settle();
    bench
}

/// The window with the middle of the sphere pinned.
fn explaining(model: &str) -> Bench {
    let mut bench = bench(model, EXPLAIN_TAB);
    // Everything about a light is visible, including its angles.
    bench.size = vec2(1600.0, 2000.0);
    bench.session.settings.bottom_height = 1000.0;
    bench.settle();
    let at = bench.area.rect.center() + vec2(13.0, 7.0);
    bench.frame(vec![Event::PointerMoved(at)]);
    bench.frame(Vec::new());
    bench.letter(Key::E, "e");
    assert!(bench.session.view.pinned.is_some());
    bench
}

/// Moves the pointer, and lets the highlight appear.
fn point(bench: &mut Bench, at: Pos2) {
    bench.frame(vec![Event::PointerMoved(at)]);
    (0..3).for_each(|_| bench.frame(Vec::new()));
}

/// The highlighted positions: backgrounds in the selection colour. Pressed buttons are taller than a line.
fn lit(bench: &mut Bench) -> Vec<Rect> {
    let is_lit = |shape| match shape {
        Shape::Rect(rect) if rect.fill == DARK.chosen && rect.rect.is_positive() => Some(rect.rect),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(is_lit).collect()
}

/// The painted texts, each with its position.
fn texts(bench: &mut Bench) -> Vec<(String, Rect)> {
    let text = |shape| match shape {
        Shape::Text(text) => Some((text.galley.job.text.clone(), text.visual_bounding_rect())),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(text).collect()
}

/// The positions of a text in a part of the window.
fn all(bench: &mut Bench, text: &str, within: Rect) -> Vec<Rect> {
    let is =
        |(said, place): (String, Rect)| (said == text && within.contains(place.center())).then_some(place);
    texts(bench).into_iter().filter_map(is).collect()
}

fn first(bench: &mut Bench, text: &str, within: Rect) -> Rect {
    *all(bench, text, within).first().unwrap_or_else(|| panic!("no {text} in {within:?}"))
}

/// The inspector and the strip at the bottom.
fn inspector(bench: &Bench) -> Rect {
    let picture = bench.area.rect;
    Rect::from_min_max(Pos2::new(picture.right(), picture.top()), Pos2::new(1600.0, picture.bottom()))
}

fn strip(bench: &Bench) -> Rect {
    Rect::from_min_max(Pos2::new(0.0, bench.area.rect.bottom()), bench.size.to_pos2())
}

/// The slider of a parameter, by name.
fn slider(bench: &Bench, name: &str) -> Rect {
    let is = |seen: &&Seen| seen.label == name && seen.role == Role::Slider;
    bench.tree.iter().find(is).unwrap_or_else(|| panic!("no slider {name}")).rect
}

/// The row of a parameter, at its name.
fn row(bench: &mut Bench, name: &str) -> Rect {
    let panel = inspector(bench);
    first(bench, name, panel)
}

fn is_lit(lit: &[Rect], place: Rect) -> bool {
    lit.iter().any(|ground| ground.contains(place.center()))
}

/// The widest line of a colour in a part of the window, and true if it is dimmed.
fn widest(bench: &mut Bench, [r, g, b]: [u8; 3], within: Rect) -> (f32, bool) {
    let colour = Color32::from_rgb(r, g, b);
    let line = |shape| {
        let Shape::Path(path) = shape else { return None };
        let ColorMode::Solid(ink) = path.stroke.color else { return None };
        let same = ink == colour || ink == colour.gamma_multiply(0.5);
        let inside = path.points.iter().all(|p| within.expand(1.0).contains(*p));
        (same && inside && !path.closed && path.points.len() > 1)
            .then_some((path.stroke.width, ink != colour))
    };
    let lines = bench.shapes().into_iter().filter_map(line);
    lines.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_else(|| panic!("no line in {r}, {g}, {b}"))
}

/// The colours of N, L and H, and of the first curve.
const N: [u8; 3] = [0xf6, 0xf6, 0xf6];
const L: [u8; 3] = [0xf0, 0xe4, 0x42];
const H: [u8; 3] = [0x2e, 0xd0, 0x9c];
const CURVE: [u8; 3] = [0, 114, 178];
/// The width of a highlighted vector, and of one next to it.
const WIDE: (f32, bool) = (4.5, false);
const DIM: (f32, bool) = (2.25, true);
const PLAIN: (f32, bool) = (2.25, false);

fn vectors(bench: &mut Bench) -> [(f32, bool); 3] {
    let picture = bench.area.rect;
    [N, L, H].map(|colour| widest(bench, colour, picture))
}

#[test]
fn a_symbol_of_the_equation_lights_its_knob_and_no_other() {
    let mut bench = bench("blinn_phong", "history");
    let panel = inspector(&bench);
    let [shininess, specular] = ["shininess", "specular coefficient"].map(|name| row(&mut bench, name));
    let alpha = first(&mut bench, "α", panel);
    assert!(alpha.bottom() < shininess.top(), "the equation stands above the knobs");
    point(&mut bench, alpha.center());
    let found = lit(&mut bench);
    assert!(is_lit(&found, shininess) && is_lit(&found, alpha) && !is_lit(&found, specular), "{found:?}");
    // A frame with a line is visible without the tint.
    let framed = |shape| matches!(shape, Shape::Rect(r) if r.stroke.width > 0.5 && r.rect.contains(shininess.center()) && r.rect.height() < 40.0);
    assert!(bench.shapes().into_iter().any(framed));
    let away = bench.area.rect.center();
    point(&mut bench, away);
    let found = lit(&mut bench);
    assert!(!is_lit(&found, shininess) && !is_lit(&found, alpha), "the pointer left");
}

#[test]
fn a_knob_lights_its_symbol_by_pointer_and_by_focus() {
    let mut bench = bench("blinn_phong", "history");
    let panel = inspector(&bench);
    let alpha = first(&mut bench, "α", panel);
    let dot = first(&mut bench, "H", panel);
    let knob = slider(&bench, "shininess");
    for at in [knob.center(), row(&mut bench, "shininess").center(), bench.field("shininess").rect.center()] {
        point(&mut bench, at);
        let found = lit(&mut bench);
        assert!(is_lit(&found, alpha) && !is_lit(&found, dot), "{found:?}");
    }
    let other = slider(&bench, "specular coefficient");
    point(&mut bench, other.center());
    assert!(!is_lit(&lit(&mut bench), alpha));

    // The focus of the control highlights too, until the pointer is at something else.
    bench.click_at(knob.center(), PointerButton::Primary);
    bench.frame(vec![Event::PointerGone]);
    bench.settle();
    assert!(is_lit(&lit(&mut bench), alpha), "it has the focus");
    point(&mut bench, other.center());
    assert!(!is_lit(&lit(&mut bench), alpha), "the pointer counts more");
    bench.frame(vec![Event::PointerGone]);
    bench.key(Key::Tab, Modifiers::NONE);
    bench.key(Key::Tab, Modifiers::NONE);
    assert!(!is_lit(&lit(&mut bench), alpha), "another knob has the focus");
}

#[test]
fn a_knob_that_is_dragged_keeps_the_light() {
    let mut bench = bench("blinn_phong", "history");
    let panel = inspector(&bench);
    let alpha = first(&mut bench, "α", panel);
    let (knob, other) = (slider(&bench, "shininess"), slider(&bench, "specular coefficient"));
    let press = |pos, pressed| {
        let modifiers = Modifiers::NONE;
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers }
    };
    bench.frame(vec![Event::PointerMoved(knob.center())]);
    bench.frame(vec![press(knob.center(), true)]);
    bench.frame(vec![Event::PointerMoved(knob.center() + vec2(12.0, 0.0))]);
    point(&mut bench, other.center());
    assert!(is_lit(&lit(&mut bench), alpha));
    bench.frame(vec![press(other.center(), false)]);
    point(&mut bench, other.center());
    assert!(!is_lit(&lit(&mut bench), alpha));
}

#[test]
fn a_symbol_lights_its_vector_and_dims_the_others() {
    let mut bench = explaining("blinn_phong");
    let panel = inspector(&bench);
    assert_eq!(vectors(&mut bench), [PLAIN; 3]);
    let [n, h, alpha] = ["N", "H", "α"].map(|symbol| first(&mut bench, symbol, panel));
    point(&mut bench, n.center());
    assert_eq!(vectors(&mut bench), [WIDE, DIM, DIM]);
    point(&mut bench, h.center());
    assert_eq!(vectors(&mut bench), [DIM, DIM, WIDE]);
    point(&mut bench, alpha.center());
    assert_eq!(vectors(&mut bench), [PLAIN; 3], "α is no vector");
}

#[test]
fn a_number_of_explain_lights_its_vector_and_the_other_way_round() {
    let mut bench = explaining("blinn_phong");
    let (panel, strip, picture) = (inspector(&bench), strip(&bench), bench.area.rect);
    let equals: Vec<_> = texts(&mut bench)
        .into_iter()
        .filter(|(text, place)| text.starts_with("= (") && strip.contains(place.center()))
        .collect();
    // The symbol precedes its numbers.
    let n = all(&mut bench, "N", strip).into_iter().find(|n| {
        equals.iter().any(|(_, v)| (v.center().y - n.center().y).abs() < 6.0 && v.left() - n.right() < 12.0)
    });
    let n = n.expect("the row of the normal");
    point(&mut bench, n.center());
    assert_eq!(vectors(&mut bench), [WIDE, DIM, DIM]);
    let symbol = first(&mut bench, "N", panel);
    assert!(is_lit(&lit(&mut bench), symbol), "and the equation");

    let cosine = texts(&mut bench).into_iter().find(|(text, _)| text.starts_with("N·H = ")).expect("there").1;
    let other = texts(&mut bench).into_iter().find(|(text, _)| text.starts_with("N·L = ")).expect("there").1;
    point(&mut bench, cosine.center());
    assert_eq!(vectors(&mut bench), [WIDE, DIM, WIDE]);
    let found = lit(&mut bench);
    assert!(is_lit(&found, cosine) && !is_lit(&found, other));

    // From the picture: the letter, and the line.
    let letter = first(&mut bench, "N", picture);
    let cross = explained(&bench.ctx).expect("pinned").explanation.clone();
    let part = |i: usize| (cross.pixel[i] as f32 + 0.5) / cross.size[i] as f32;
    let origin = picture.lerp_inside(vec2(part(0), part(1)));
    for at in [letter.center(), origin + 0.6 * (letter.center() - origin)] {
        point(&mut bench, at);
        assert_eq!(vectors(&mut bench), [WIDE, DIM, DIM]);
        let found = lit(&mut bench);
        assert!(is_lit(&found, symbol) && is_lit(&found, n) && !is_lit(&found, cosine), "{found:?}");
    }
    let free = picture.right_bottom() - vec2(140.0, 140.0);
    point(&mut bench, free);
    assert_eq!(vectors(&mut bench), [PLAIN; 3]);
}

#[test]
fn a_letter_that_an_equation_uses_for_something_else_is_no_vector() {
    // H(μ) is one of Hapke's functions.
    let mut bench = explaining("hapke");
    let (panel, picture) = (inspector(&bench), bench.area.rect);
    let h = first(&mut bench, "H", panel);
    point(&mut bench, h.center());
    assert!(is_lit(&lit(&mut bench), h));
    assert_eq!(vectors(&mut bench), [PLAIN; 3]);
    let letter = first(&mut bench, "H", picture);
    point(&mut bench, letter.center());
    assert!(!is_lit(&lit(&mut bench), h));
}

/// Draws frames until the curve is there.
fn wait(bench: &mut Bench) {
    let is_there = |bench: &Bench| {
        let image = bench.tree.iter().find(|seen| seen.role == Role::Image);
        image.is_some_and(|seen| !seen.label.trim_end().ends_with(':'))
    };
    // Fine curves come a moment after coarse ones.
    let mut rest = 60;
    for _ in 0..8000 {
        bench.frame(Vec::new());
        rest -= i32::from(is_there(bench));
        if rest == 0 {
            return;
        }
        thread::sleep(Duration::from_millis(8));
    }
    panic!("the curve does not come");
}

fn plotting(model: &str, kind: Kind) -> Bench {
    let mut bench = bench(model, PLOTS_TAB);
    bench.apply(Action::Plot(PlotCommand::Kind(kind)));
    wait(&mut bench);
    bench
}

/// Width of the list next to a plot.
const LIST: f32 = 372.0;

/// True if the curve of the model stands out.
fn stands_out(bench: &mut Bench) -> bool {
    let strip = strip(bench);
    let plot = strip.with_max_x(strip.right() - LIST);
    let (width, dimmed) = widest(bench, CURVE, plot);
    assert!(!dimmed);
    width > 3.0
}

#[test]
fn a_symbol_lights_the_curve_that_it_is_and_no_other() {
    let mut bench = plotting("cook_torrance", Kind::Distribution);
    let panel = inspector(&bench);
    let [d, f] = ["D", "F"].map(|symbol| first(&mut bench, symbol, panel));
    assert!(!stands_out(&mut bench));
    point(&mut bench, d.center());
    assert!(stands_out(&mut bench));
    point(&mut bench, f.center());
    assert!(!stands_out(&mut bench), "F is another curve");
    bench.apply(Action::Plot(PlotCommand::Kind(Kind::Fresnel)));
    wait(&mut bench);
    point(&mut bench, f.center());
    assert!(stands_out(&mut bench));
}

#[test]
fn a_parameter_lights_the_curve_whose_shape_it_changes() {
    let mut bench = plotting("metallic_roughness", Kind::Distribution);
    let (roughness, metallic) = (slider(&bench, "roughness"), slider(&bench, "metallic"));
    point(&mut bench, roughness.center());
    assert!(stands_out(&mut bench));
    point(&mut bench, metallic.center());
    assert!(!stands_out(&mut bench), "D is that of any metal");
    bench.apply(Action::Plot(PlotCommand::Kind(Kind::Fresnel)));
    wait(&mut bench);
    point(&mut bench, metallic.center());
    assert!(stands_out(&mut bench));
    point(&mut bench, roughness.center());
    assert!(!stands_out(&mut bench));
}

#[test]
fn a_curve_and_its_row_light_its_symbol() {
    let mut bench = plotting("cook_torrance", Kind::Distribution);
    let (panel, strip) = (inspector(&bench), strip(&bench));
    let [d, f] = ["D", "F"].map(|symbol| first(&mut bench, symbol, panel));
    let row = texts(&mut bench).into_iter().find(|(text, place)| {
        text.starts_with("Cook") && strip.contains(place.center()) && place.left() > strip.right() - LIST
    });
    let row = row.expect("the row of the curve").1;
    point(&mut bench, row.center());
    let found = lit(&mut bench);
    assert!(is_lit(&found, d) && is_lit(&found, row) && !is_lit(&found, f));
    assert!(stands_out(&mut bench));

    // On the curve itself: its highest point, at the left.
    let points = bench.shapes().into_iter().find_map(|shape| {
        let Shape::Path(path) = shape else { return None };
        (path.stroke.color == ColorMode::Solid(Color32::from_rgb(0, 114, 178)) && path.points.len() > 20)
            .then_some(path.points)
    });
    let points = points.expect("the curve");
    point(&mut bench, points[points.len() / 2]);
    assert!(is_lit(&lit(&mut bench), d) && stands_out(&mut bench));
    point(&mut bench, Pos2::new(points[points.len() / 2].x, points[0].y));
    assert!(!is_lit(&lit(&mut bench), d) && !stands_out(&mut bench), "beside the curve");
}

#[test]
fn of_several_curves_the_one_under_the_pointer_stands_out() {
    let mut bench = plotting("phong", Kind::Response);
    let of = Of::Model { id: "lambert".to_owned(), values: Values::default(), encoding: Encoding::Srgb };
    bench.apply(Action::Plot(PlotCommand::Add(of)));
    wait(&mut bench);
    let (panel, strip) = (inspector(&bench), strip(&bench));
    let whole = first(&mut bench, "I", panel);
    let rows = |bench: &mut Bench, name: &str| {
        let all = texts(bench).into_iter();
        all.filter(|(text, place)| text.starts_with(name) && strip.contains(place.center()))
            .map(|(_, place)| place)
            .next_back()
            .expect("the row")
    };
    let [phong, lambert] = ["Phong", "Lambert"].map(|name| rows(&mut bench, name));
    let plot = strip.with_max_x(strip.right() - LIST);
    point(&mut bench, phong.center());
    let found = lit(&mut bench);
    assert!(is_lit(&found, phong) && is_lit(&found, whole) && !is_lit(&found, lambert));
    point(&mut bench, lambert.center());
    let (_, dimmed) = widest(&mut bench, CURVE, plot);
    let found = lit(&mut bench);
    assert!(dimmed && is_lit(&found, lambert) && !is_lit(&found, phong));
    assert!(!is_lit(&found, whole), "the equation is not that of Lambert");
}

#[test]
fn the_symbols_of_a_light_are_its_own() {
    let mut bench = explaining("blinn_phong");
    bench.apply(Action::Select(Selection::Light(0)));
    let (panel, strip) = (inspector(&bench), strip(&bench));
    let intensity = row(&mut bench, "intensity");
    let symbol = first(&mut bench, "I", panel);
    let numbers = all(&mut bench, "I", strip);
    let arriving = first(&mut bench, "p", strip);
    let of_light: Vec<_> =
        numbers.iter().filter(|i| (i.center().y - arriving.center().y).abs() < 24.0).collect();
    let of_surface: Vec<_> =
        numbers.iter().filter(|i| (i.center().y - arriving.center().y).abs() >= 40.0).collect();
    assert!(!of_light.is_empty() && !of_surface.is_empty(), "{numbers:?}, {arriving:?}");
    point(&mut bench, symbol.center());
    let found = lit(&mut bench);
    assert!(is_lit(&found, intensity));
    assert!(of_light.iter().any(|i| is_lit(&found, **i)), "Explain has the equation of the light, too");
    assert!(of_surface.iter().all(|i| !is_lit(&found, **i)), "the light that leaves is not that of the lamp");
    let knob = slider(&bench, "intensity");
    point(&mut bench, knob.center());
    assert!(is_lit(&lit(&mut bench), symbol));
}

#[test]
fn the_knobs_of_a_spotlight_light_in_its_equation() {
    let mut bench = explaining("lambert");
    bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::light_type, "spot")));
    bench.apply(Action::Select(Selection::Light(0)));
    let panel = inspector(&bench);
    // θ_c is the angle of the cone, θ that of the ray, p the point.
    let angle = first(&mut bench, "c", panel);
    let [ray, softness, point_lit] = ["θ", "s", "p"].map(|symbol| first(&mut bench, symbol, panel));
    for (knob, there) in [("cone angle", angle), ("penumbra", softness)] {
        let knob = slider(&bench, knob);
        point(&mut bench, knob.center());
        let found = lit(&mut bench);
        assert!(is_lit(&found, there), "{found:?} without {there:?}");
        assert!(!is_lit(&found, ray) && !is_lit(&found, point_lit));
    }
    point(&mut bench, softness.center());
    let knob = row(&mut bench, "penumbra");
    assert!(is_lit(&lit(&mut bench), knob));
}

#[test]
fn presentations_light_a_symbol_wherever_it_stands() {
    let mut bench = bench("cook_torrance", "history");
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Presenting(true)));
    bench.settle();
    let whole = bench.area.rect;
    let [d, f] = ["D", "F"].map(|symbol| all(&mut bench, symbol, whole));
    assert!(d.len() > 1 && f.len() > 1, "in the term, and where it is defined: {d:?}, {f:?}");
    point(&mut bench, d[0].center());
    let found = lit(&mut bench);
    assert!(d.iter().all(|place| is_lit(&found, *place)), "{found:?}");
    assert!(f.iter().all(|place| !is_lit(&found, *place)), "{found:?}");
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_what_lights() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    for (name, theme) in [("dark", ThemeChoice::Dark), ("light", ThemeChoice::Light)] {
        let ground = if theme == ThemeChoice::Dark { theme::DARK } else { theme::LIGHT };
        for (what, tab) in
            [("vector", EXPLAIN_TAB), ("angle", EXPLAIN_TAB), ("curve", PLOTS_TAB), ("factor", PLOTS_TAB)]
        {
            let mut bench = if tab == EXPLAIN_TAB {
                explaining("blinn_phong")
            } else {
                let (model, kind) = match what {
                    "factor" => ("cook_torrance", Kind::Distribution),
                    _ => ("blinn_phong", Kind::Polar),
                };
                plotting(model, kind)
            };
            bench.size = vec2(1600.0, 1000.0);
            bench.session.settings.theme = theme;
            if what == "curve" {
                let of =
                    Of::Model { id: "phong".to_owned(), values: Values::default(), encoding: Encoding::Srgb };
                bench.apply(Action::Plot(PlotCommand::Add(of)));
            }
            if tab == PLOTS_TAB {
                wait(&mut bench);
            }
            bench.settle();
            let panel = inspector(&bench);
            let strip =
                Rect::from_min_max(bench.area.rect.left_bottom(), Pos2::new(1600.0, 1000.0)).with_min_x(0.0);
            let at = match what {
                "vector" => first(&mut bench, "H", panel),
                "angle" => {
                    let text = texts(&mut bench).into_iter().find(|(text, _)| text.starts_with("N·H = "));
                    text.map_or(strip, |(_, place)| place)
                }
                "factor" => first(&mut bench, "D", panel),
                _ => first(&mut bench, "base colour", panel),
            };
            point(&mut bench, at.center());
            bench.picture(&folder.join(format!("linked-{what}-{name}.png")), ground.surround)?;
        }
    }
    Ok(())
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_explain() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    let sizes = [
        (1280.0, 720.0, 100, ThemeChoice::Dark),
        (1280.0, 720.0, 150, ThemeChoice::Light),
        (1920.0, 1080.0, 100, ThemeChoice::Light),
        (1920.0, 1080.0, 150, ThemeChoice::Dark),
        (1920.0, 1080.0, 200, ThemeChoice::Dark),
    ];
    for (width, height, scale, theme) in sizes {
        let ground = if theme == ThemeChoice::Dark { theme::DARK } else { theme::LIGHT };
        for shading in ["flat", "gouraud", "phong", "derivative", "background"] {
            let id = if shading == "background" { "phong" } else { shading };
            let scene = Scene {
                reflection_model: "blinn_phong".to_owned(),
                shading_model: id.to_owned(),
                ..Scene::default()
            };
            let mut bench = Bench::new(Session::new(scene));
            bench.size = vec2(width, height);
            bench.session.settings.theme = theme;
            bench.session.settings.scale = scale;
            bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
            bench.settle();
            let middle = bench.area.rect.center() + vec2(23.0, -17.0);
            let corner = bench.area.rect.left_top() + vec2(24.0, 70.0);
            bench.frame(vec![Event::PointerMoved(if shading == "background" { corner } else { middle })]);
            bench.frame(Vec::new());
            bench.letter(Key::E, "e");
            bench.frame(vec![Event::PointerGone]);
            bench.settle();
            let name = format!("explain-{width}x{height}-{scale}-{shading}.png");
            bench.picture(&folder.join(name), ground.surround)?;
        }
    }
    Ok(())
}

#[test]
fn explain_has_the_columns_that_have_room() {
    for (size, scale, columns) in [
        (vec2(1280.0, 720.0), 100, 3),
        (vec2(1280.0, 720.0), 150, 2),
        (vec2(1920.0, 1080.0), 150, 3),
        (vec2(1920.0, 1080.0), 200, 2),
        (vec2(1280.0, 720.0), 200, 1),
    ] {
        let scene = Scene { shading_model: "gouraud".to_owned(), ..Scene::default() };
        let mut bench = Bench::new(Session::new(scene));
        bench.size = size;
        bench.session.settings.scale = scale;
        bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
        bench.settle();
        // The middle of the picture, even if something is written over it.
        bench.letter(Key::E, "e");
        // Also where it is scrolled out of view. The inspector, above, shows some of it too.
        let place = |label: &str| {
            let all = bench.tree.iter().filter(|seen| seen.label.starts_with(label)).map(|seen| seen.rect);
            let lowest = all.max_by(|a, b| a.top().total_cmp(&b.top()));
            lowest.unwrap_or_else(|| panic!("no {label} in {size:?}, {scale} %"))
        };
        let lefts =
            ["computed per vertex", "Point 1: ", "From light to the code"].map(|label| place(label).left());
        let [surface, lights, display] = lefts;
        let found = match () {
            () if display > lights && lights > surface => 3,
            () if lights > surface => 2,
            () => 1,
        };
        assert_eq!(found, columns, "{size:?}, {scale} %: {lefts:?}");
        // The choice of the point stays in its column, clear of the scroll bar.
        let edge = if columns == 3 { display - 24.0 } else { place("Copy").right() };
        let last = place("Point: per pixel");
        assert!(last.right() <= edge - 10.0, "{size:?}, {scale} %: {last:?} beyond {edge}");
    }
}
