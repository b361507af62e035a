//! The picture reports where it clips, counted in what the renderer draws.

use bevy_egui::egui::{Color32, PointerButton, vec2};
use glam::Vec3;
use lights_camera_models::{
    channel::DebugChannel,
    document::Selection,
    optics::TermSelection,
    panel::{
        marks::Lens,
        state::{Action, Clipping, NoNumber, Session, ViewChange},
    },
    scene::Scene,
};

use crate::{helpers::screen::Picture, window::panels::Bench};

/// A window that does not have a badge yet.
fn bench_without(badge: &str) -> Bench {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    assert!(!bench.says(badge));
    bench
}

#[test]
fn the_sign_tells_the_share_and_the_view_shows_where() {
    let mut bench = bench_without("Clipped");
    // The fields of a quarter of the picture, at the upper left.
    let rect = bench.area.rect;
    let [across, down] = Clipping::GRID;
    let field = (rect.area() / (across * down) as f32) as u32;
    let corner = |i: usize| i % across < across / 2 && i / across < down / 2;
    let counts = (0..across * down).map(|i| if corner(i) { field } else { 0 }).collect();
    bench.session.facts.clipping[0] = Clipping::new(counts);
    bench.settle();
    let folder = tempfile::tempdir().unwrap();
    let shown = |bench: &mut Bench| {
        let file = folder.path().join("window.png");
        bench.picture(&file, Color32::from_gray(119)).unwrap();
        let picture = Picture::read(&file);
        let marked = |p: [u8; 3]| p[0] > 200 && p[1] < 60 && p[2] > 150;
        let (x, y) = (rect.center().x as u32, rect.center().y as u32);
        [(x - 100, y - 100), (x + 4, y + 4)].map(|(x, y)| picture.count(x..x + 90, y..y + 90, marked))
    };
    assert_eq!(shown(&mut bench), [0, 0], "not before it is asked for");
    bench.apply(Action::View(ViewChange::Clipping(true)));
    let selected = bench.session.selection;
    let [there, elsewhere] = shown(&mut bench);
    // The badge itself toggles them.
    let sign = bench.tree.iter().find(|s| s.label.starts_with("Clipped")).map(|s| s.rect.center()).unwrap();
    bench.click_at(sign, PointerButton::Primary);
    assert!(!bench.session.view.show_clipping);
    bench.click_at(sign, PointerButton::Primary);
    assert!(bench.session.view.show_clipping && bench.session.selection == selected);
    // A chequered pattern, minus the part covered by the object's marks.
    assert!((3200..4900).contains(&there) && elsewhere == 0, "{there} and {elsewhere} of 8100");
}

#[test]
fn what_gives_no_number_has_a_badge_that_shows_where() {
    let mut bench = bench_without("Not a number:");
    let odd = |part| NoNumber { part, what: "has the reflection model torn, which gives NaN".to_owned() };
    bench.session.facts.not_finite[0] = vec![odd(Selection::Object(0))];
    bench.settle();
    let sign = bench.find("Not a number: Sphere 1").expect("a badge").rect.center();
    bench.click_at(sign, PointerButton::Primary);
    assert_eq!(bench.session.view.channels[0], Some(DebugChannel::NotANumber));
    let sign = bench.find("Not a number: Sphere 1").expect("still there").rect.center();
    bench.click_at(sign, PointerButton::Primary);
    assert_eq!(bench.session.view.channels[0], None);
    // Many are counted.
    bench.session.facts.not_finite[0] = (0..4).map(|_| odd(Selection::Object(0))).collect();
    bench.settle();
    assert!(bench.find("Not a number: Sphere 1, Sphere 1, 2 more").is_some());
}

#[test]
fn badges_keep_their_words_while_the_camera_moves_and_choose_them_once_it_rests() {
    let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
    scene.objects[0].size = 0.3;
    let mut bench = Bench::new(Session::new(scene));
    bench.size = vec2(1280.0, 720.0);
    let clipped = |each: u32| Clipping::new(vec![each; Clipping::GRID[0] * Clipping::GRID[1]]);
    bench.session.facts.clipping[0] = clipped(5);
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    let badge = bench.find("Only the diffuse term · Show all").cloned();
    let badge = badge.expect("a badge");
    let is_whole = |bench: &Bench| bench.texts_just_painted().contains(&badge.label);
    assert!(is_whole(&bench), "it covers nothing: {:?}", bench.texts_just_painted());
    // The camera moves until the object is behind the badge. It looks straight ahead.
    let home = bench.session.facts.eye;
    let object = bench.session.document.objects[0].position;
    let lens = Lens::of(&bench.session, bench.area.frame);
    let place = |p: Vec3| lens.project(p).expect("before the camera");
    let metre = place(object + Vec3::X).x - place(object).x;
    let by = (badge.rect.center() - place(object)) / metre;
    let there = home + Vec3::new(-by.x, by.y, 0.0);
    for i in 1..=10u8 {
        bench.session.facts.eye = home.lerp(there, f32::from(i) / 10.0);
        bench.session.facts.clipping[0] = clipped(5 + u32::from(i));
        bench.frame(Vec::new());
        assert!(is_whole(&bench), "step {i}: {:?}", bench.texts_just_painted());
    }
    let rest = |bench: &mut Bench| (0..12).for_each(|_| bench.frame(Vec::new()));
    rest(&mut bench);
    assert!(!is_whole(&bench), "the object is behind it");
    bench.session.facts.eye = home;
    bench.frame(Vec::new());
    assert!(!is_whole(&bench), "at once");
    rest(&mut bench);
    assert!(is_whole(&bench), "it covers nothing again");
    // A change of the scene counts at once.
    bench.session.facts.eye = there;
    bench.apply(Action::Expose(1.0));
    assert!(!is_whole(&bench), "another scene");
}

#[cfg(target_os = "linux")]
#[test]
fn the_window_has_a_sign_only_where_the_picture_clips() {
    use crate::helpers::screen::Screen;

    let screen = Screen::new(1280, 720);
    let folder = tempfile::tempdir().unwrap();
    let point = |intensity: f32| {
        format!(r#"{{ "type": "point", "position": [7.5, 8, 9], "intensity": {intensity} }}"#)
    };
    let sign_under = |name: &str, lights: &str, code: u8, display: &str| {
        let scene = folder.path().join(format!("{name}.json"));
        let text = format!(
            r#"{{
  "scene_size": {{ "height": 10, "width": 10, "depth": 10 }},
  "reflection_model": "lambert",
  "shading_model": "phong",
  "lights": [{lights}],
  "observer": {{ "position": [5, 5, 9.5], "direction": [0, 0, -1], "field_of_view": 45 }},
  "objects": [{{ "type": "sphere", "position": [5, 5, 5], "size": 2,
                  "material": {{ "base_colour": [{code}, {code}, {code}] }} }}],
  "display": {display}
}}"#
        );
        std::fs::write(&scene, text).unwrap();
        let file = folder.path().join(format!("{name}.png"));
        let (scene, file_name) = (scene.to_string_lossy(), file.to_string_lossy());
        let arguments = ["view", &*scene, "--exit-after", "30", "--capture", &*file_name];
        let output = screen.lcm(&arguments, folder.path());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        // The rim of the badge, which nothing else there has.
        let warning = |p: [u8; 3]| p == [0xf0, 0xc0, 0x50];
        Picture::read(&file).count(212..480, 40..76, warning) > 100
    };
    let sign = |name: &str, intensity: f32, display: &str| sign_under(name, &point(intensity), 255, display);
    let plain = r#"{ "exposure": 0 }"#;
    assert!(sign("bright", 60.0, plain));
    assert!(!sign("dim", 10.0, plain));
    assert!(sign("exposed", 10.0, r#"{ "exposure": 3 }"#));
    assert!(!sign("mapped", 60.0, r#"{ "tone_mapping": "reinhard" }"#));
    // A white background is no light.
    assert!(!sign("white", 10.0, r#"{ "background": "colour" }"#));
    assert!(!sign("white_mapped", 10.0, r#"{ "background": "colour", "tone_mapping": "reinhard" }"#));
    // Lights in sight are brighter than white, which is no fault of the surface: a lamp, and what is behind all.
    let lamp = r#", { "type": "sphere", "position": [7.5, 6, 4], "radius": 0.6, "intensity": 1 }"#;
    let world = r#", { "type": "environment", "source": "uniform", "intensity": 0.33 }"#;
    let mapped = r#"{ "tone_mapping": "aces", "exposure": 2 }"#;
    for (name, more, intensity, code, display, clips) in [
        ("lamp", lamp, 10.0, 255, plain, false),
        ("lamp_and_bright", lamp, 60.0, 255, plain, true),
        // A white surface under it would be as bright.
        ("world", world, 5.0, 128, plain, false),
        ("lamp_mapped", lamp, 1.0, 255, mapped, false),
    ] {
        assert_eq!(sign_under(name, &(point(intensity) + more), code, display), clips, "{name}");
    }
    // Of two views, the one that clips has the badge.
    let views = |a: i32, b: i32| {
        let variants =
            format!(r#""variants": [{{ "exposure": {b} }}], "comparison": {{ "layout": "side_by_side" }}"#);
        let file = format!("views_{a}_{b}");
        sign(&file, 10.0, &format!(r#"{{ "exposure": {a} }}, {variants}"#));
        let picture = Picture::read(&folder.path().join(format!("{file}.png")));
        let warning = |p: [u8; 3]| p == [0xf0, 0xc0, 0x50];
        [208..566, 574..936].map(|x| picture.count(x, 66..106, warning) > 100)
    };
    assert_eq!(views(0, 3), [false, true]);
    assert_eq!(views(3, 0), [true, false]);
}
