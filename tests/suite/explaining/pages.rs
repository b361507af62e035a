//! The explanation of a point's colour on a page: the sentence and the numbers of `lcm explain`, escaped,
//! visible on a phone, and with a remark when they no longer match the picture.

use std::{
    fs,
    io::Read as _,
    path::{Path, PathBuf},
};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use flate2::read::ZlibDecoder;
use lights_camera_models::{
    explain,
    export::{Progress, Request, html},
    reference::Settings,
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
        save,
    },
};
use serde_json::{Value, json};

use crate::helpers::{
    pages::PAGES,
    support::{check_wording, lcm, lcm_in, root},
};

const SIZE: (u32, u32) = (1280, 720);
const MIDDLE: [u32; 2] = [640, 360];
/// A pixel of an object with Gouraud shading in `gouraud_misses_highlight`.
const GOURAUD: [u32; 2] = [480, 360];

fn shipped(name: &str) -> PathBuf {
    root().join("scenes").join(name)
}

fn scene(path: &Path) -> Scene {
    load::file(path, &Registry::builtin(), Defaults::Refuse).expect("valid").scene
}

fn made(scene: &Scene, point: Option<[u32; 2]>) -> (String, Vec<String>) {
    let registry = Registry::builtin();
    let request = Request { scene, registry: &registry, stem: "scene", size: SIZE, object: 0, point };
    let export = (html::HTML.make)(&request, &Progress::NONE).expect("a page");
    (String::from_utf8(export.files[0].bytes.clone()).expect("UTF-8"), export.notes)
}

/// The page of a scene with an explained pixel.
fn page(scene: &Scene, point: [u32; 2]) -> String {
    made(scene, Some(point)).0
}

const OPENING: &str = "<script type=\"application/octet-stream\" id=\"explained-data\">";

/// The explanations on a page, by the letters of its views.
fn points(page: &str) -> Value {
    let (_, after) = page.split_once(OPENING).expect("it explains");
    let (data, _) = after.split_once("</script>").expect("it ends");
    let mut text = String::new();
    let packed = STANDARD.decode(data).expect("base64");
    ZlibDecoder::new(packed.as_slice()).read_to_string(&mut text).expect("a text");
    serde_json::from_str(&text).expect("JSON")
}

/// The text of a view.
fn html_of(page: &str, view: &str) -> String {
    points(page)[view]["html"].as_str().expect("a text").to_owned()
}

/// The text of some HTML, with spaces instead of tags.
fn read(html: &str) -> String {
    let mut text = String::new();
    for part in html.split('<') {
        let shown = part.split_once('>').map_or(part, |(_, shown)| shown);
        text.push(' ');
        text.push_str(shown);
    }
    text.trim().replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

/// The numbers of a text, in order.
fn numbers(text: &str) -> Vec<String> {
    let all = text.split(|c: char| !c.is_ascii_digit() && c != '.').map(|n| n.trim_matches('.').to_owned());
    all.filter(|n| !n.is_empty()).collect()
}

#[test]
fn a_page_has_the_sentence_and_the_numbers_that_the_command_prints() {
    let registry = Registry::builtin();
    for (name, at) in [
        ("compare_phong_blinn_phong.json", [780, 220]),
        ("gouraud_misses_highlight.json", GOURAUD),
        ("openpbr_car_paint.json", MIDDLE),
        ("photometric_lamps.json", [640, 500]),
    ] {
        let path = shipped(name);
        let place = format!("{},{}", at[0], at[1]);
        let run = lcm(&["explain", path.to_str().expect("Unicode"), "--at", &place], "");
        assert_eq!(run.status, Some(0), "{}", run.err);
        let scene = scene(&path);
        let html = html_of(&page(&scene, at), "A");
        let code = numbers(run.out.lines().next().expect("a title").split_once(": ").expect("a colour").1);
        assert!(html.contains(&format!("This pixel is ({}): ", code.join(", "))), "{name}: {code:?} {html}");
        let settings = Settings { width: SIZE.0, height: SIZE.1, ..Settings::default() };
        let seen_scene = scene.seen(0, &registry).expect("view A").0;
        let explained = explain::pixel(&seen_scene, &registry, &settings, at).expect("in the picture");
        let seen = explained.seen.as_ref().unwrap_or_else(|| panic!("{name}: an object"));
        let spot = &seen.spots[seen.main_spot().expect("the equation was evaluated")];
        // Every line with numbers is there, and equals the command's output.
        let put: Vec<_> = html.split("<div class=\"put\">").skip(1).collect();
        let put: Vec<_> = put.iter().map(|p| read(p.split("</div>").next().unwrap_or_default())).collect();
        let mut found = 0;
        for lit in spot.brightest().into_iter().take(8).filter(|lit| !lit.is_dark()) {
            for line in lit.lines(&seen.model).iter().filter(|line| line.is_equation()) {
                let Some(right) = line.right() else { continue };
                assert!(run.out.contains(right), "{name}: {right}");
                let known = |p: &String| numbers(p) == numbers(right);
                assert!(put.iter().any(known), "{name}: {right} is not in {put:?}");
                found += 1;
            }
            // Uniform light is answered by one term, which has a line even without an equation.
            if lit.geometry.is_none() && lit.integral.is_none() {
                let ambient = explain::triple(lit.response.ambient);
                assert!(html.contains(&format!("title=\"{ambient}\"")), "{name}: I_a = {ambient}");
            }
            // All digits of the command appear under the pointer.
            let error = lit.error();
            let all = match error {
                Some(error) => explain::measured(lit.contribution, error),
                None => explain::triple(lit.contribution),
            };
            assert!(run.out.contains(&all) && html.contains(&format!("title=\"{all}\"")), "{name}: {all}");
            // An integral has no equation with numbers, but its samples.
            if let Some(integral) = &lit.integral {
                assert!(html.contains(&integral.basis()), "{name}: {}", integral.basis());
                found += 1;
            }
            let short = explain::triple_within(lit.contribution, error, 3);
            let shown = numbers(&read(&html)).join(" ");
            assert!(shown.contains(&numbers(&short).join(" ")), "{name}: {short}");
        }
        assert!(found > 0, "{name}");
        // Numbers of another pixel are detected.
        let other = html_of(&page(&scene, [at[0] + 20, at[1] + 10]), "A");
        assert_ne!(html, other);
    }
}

#[test]
fn the_command_writes_the_page_that_explains_and_without_the_option_the_same_as_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = shipped("gold_three_lights.json");
    let path = path.to_str().expect("Unicode");
    let export = |name: &str, more: &[&str]| {
        let arguments = [&["export", path, "--as", "html", "-o", name, "-q"], more].concat();
        let run = lcm_in(folder.path(), &arguments, b"");
        assert_eq!(run.status, Some(0), "{}", run.err);
        fs::read_to_string(folder.path().join(name)).expect("UTF-8")
    };
    let (without, with) = (export("a.html", &[]), export("b.html", &["--explain", "640,300"]));
    assert_eq!(with, page(&scene(Path::new(path)), [640, 300]));
    assert_eq!(without, made(&scene(Path::new(path)), None).0);
    // The additional parts of the page are in four places; without them it equals the page without the
    // option, byte for byte.
    let (before, after) = with.split_once(&format!("\n{OPENING}")).expect("it explains");
    let (_, after) = after.split_once("</script>").expect("it ends");
    let mut rest = format!("{before}{after}");
    for part in [
        include_str!("../../../src/export/html/explained.html"),
        include_str!("../../../src/export/html/explained.css"),
        include_str!("../../../src/export/html/js/explained.js"),
    ] {
        assert_eq!(rest.matches(part).count(), 1);
        rest = rest.replace(part, "");
    }
    assert!(rest == without, "the page without the option has changed");
    assert!(!without.contains("id=\"why\"") && !without.contains("Explained") && !without.contains("{{"));
}

#[test]
fn what_is_no_pixel_of_the_picture_or_no_page_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |arguments: &[&str]| {
        let run = lcm_in(folder.path(), &[&["export", "-o", "out"], arguments].concat(), b"");
        assert_eq!((run.status, run.out.as_str()), (Some(2), ""), "{}", run.err);
        assert!(!folder.path().join("out").exists());
        check_wording(&run.err);
        run.err
    };
    for (size, at) in [("1280x720", "1280,0"), ("64x36", "3,36")] {
        let said = run(&["--as", "html", "--size", size, "--explain", at]);
        let explained = lcm(&["explain", "--size", size, "--at", at], "");
        assert_eq!(said, explained.err.replace("--at: ", "--explain: "));
        assert!(said.contains(&format!("the pixel {at} is outside the picture of {size} pixels")), "{said}");
    }
    for wrong in ["640", "-1,5", "a,b"] {
        let said = run(&["--as", "html", "--explain", wrong]);
        assert!(said.contains("it must be X,Y: two whole numbers, 0 or more"), "{said}");
    }
    for form in ["bevy", "glsl", "mitsuba", "executable"] {
        let said = run(&["--as", form, "--explain", "640,360"]);
        assert!(
            said.contains(&format!("{form} does not explain pixels, only html does; omit --explain")),
            "{said}"
        );
    }
}

#[test]
fn names_of_lights_and_objects_are_no_markup() {
    let hostile = "</script><img src=x onerror=alert(1)>\"&' {{script}}";
    let mut scene = scene(&shipped("compare_phong_blinn_phong.json"));
    scene.lights.iter_mut().for_each(|light| light.name = Some(hostile.to_owned()));
    scene.objects.iter_mut().for_each(|object| object.name = Some(hostile.to_owned()));
    let page = page(&scene, [780, 220]);
    assert_eq!(page.matches("</script>").count(), 5);
    let escaped = "&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&quot;&amp;' {{script}}";
    for view in ["A", "B"] {
        let html = html_of(&page, view);
        assert!(!html.contains("<img") && !html.contains("</script"), "{html}");
        // The sentence, the object, the light.
        assert!(html.matches(escaped).count() >= 3, "{html}");
    }
}

#[test]
fn each_view_is_explained_and_what_has_no_equation_has_none() {
    let comparing = scene(&shipped("compare_phong_blinn_phong.json"));
    let all = points(&page(&comparing, [780, 220]));
    let html = |view: &str| all[view]["html"].as_str().expect("a text").to_owned();
    assert_eq!(all.as_object().expect("views").len(), 1 + comparing.variants.len());
    assert_ne!(html("A"), html("B"));
    assert_eq!(all["A"]["at"], all["B"]["at"]);
    // Gouraud shading: the most important vertex.
    let gouraud = html_of(&page(&scene(&shipped("gouraud_misses_highlight.json")), GOURAUD), "A");
    assert!(gouraud.contains("which counts most here") && gouraud.contains("Mixed from the vertices"));
    // The background has a sentence, and no lights.
    let background = html_of(&page(&Scene::default(), [2, 2]), "A");
    assert!(background.contains("the background shows.") && !background.contains("<details"), "{background}");
    // If there are many lights, eight are worked out, the brightest expanded; the others are summed up.
    let many = scene(&shipped("many_lights.json"));
    let lights = many.lights.len();
    assert!(lights > 9);
    let html = html_of(&page(&many, MIDDLE), "A");
    assert_eq!(html.matches("<details").count(), 8, "{html}");
    assert_eq!(html.matches("<details open>").count(), 1);
    assert!(
        html.contains(" more lights, none brighter:") && html.contains(&format!("Sum over {lights} lights:"))
    );
}

#[test]
fn an_explanation_makes_a_page_little_larger() {
    for (path, without) in PAGES.iter() {
        let with = made(&scene(path), Some(MIDDLE));
        let more = with.0.len() - without.files[0].bytes.len();
        println!("{}: {more} bytes more", path.display());
        assert!(more <= 30_000, "{}: {more} bytes more", path.display());
        assert_eq!(with.1, without.notes, "no doubts about shipped scenes");
    }
}

#[cfg(target_os = "linux")]
mod seen {
    use lights_camera_models::scene::has_extent;

    use super::*;
    use crate::helpers::browser::Browser;

    fn opened(browser: &Browser, folder: &Path, scene: &Scene, at: [u32; 2]) {
        let file = folder.join("page.html");
        fs::write(&file, page(scene, at)).expect("written");
        // Light with extent takes long in a large picture, and none of this waits for it.
        match has_extent(scene.shining(), &Registry::builtin()) {
            true => browser.begin(&file, "renderer=webgl"),
            false => browser.open(&file, "renderer=webgl"),
        }
        let hidden = "return document.getElementById('why')?.hidden ?? true";
        browser.wait(hidden, |hidden| *hidden == json!(false));
        assert_eq!(browser.run("return document.getElementById('failure').textContent"), "");
    }

    fn hidden(browser: &Browser, id: &str) -> bool {
        browser.run(&format!("return document.getElementById({id:?}).hidden")).as_bool().expect("a truth")
    }

    fn key(browser: &Browser, key: &str) {
        browser.run(&format!(
            "document.getElementById('picture').dispatchEvent(new KeyboardEvent('keydown', {{ key: {key:?} }}))"
        ));
        browser.settle();
    }

    fn turn(browser: &Browser, selector: &str, value: &str) {
        browser.run(&format!(
            "const control = document.querySelector({selector:?});
            control.value = {value:?};
            control.dispatchEvent(new Event('input', {{ bubbles: true }}));
            control.dispatchEvent(new Event('change', {{ bubbles: true }}));"
        ));
        browser.settle();
    }

    #[test]
    fn on_a_phone_it_is_in_sight_and_no_wider_than_the_window() {
        let Some(browser) = Browser::start() else { return };
        browser.resize(390, 844);
        let folder = tempfile::tempdir().expect("a folder");
        let mut long = scene(&shipped("compare_phong_blinn_phong.json"));
        long.lights[0].name = Some("Lamp".repeat(60));
        let scenes = [
            (long, [780, 220]),
            (scene(&shipped("openpbr_car_paint.json")), MIDDLE),
            (scene(&shipped("many_lights.json")), MIDDLE),
        ];
        for (scene, at) in &scenes {
            opened(&browser, folder.path(), scene, *at);
            let widths = browser.run(
                "document.querySelectorAll('#why details').forEach((d) => (d.open = true));
                const beyond = [...document.querySelectorAll('#why *')].filter((e) => !e.closest('.equation') || e.matches('.equation'));
                const edge = Math.max(...beyond.map((e) => e.getBoundingClientRect().right));
                const frame = document.getElementById('why').getBoundingClientRect();
                return [document.documentElement.scrollWidth, frame.left, frame.right, edge, frame.height, innerWidth]",
            );
            let widths: Vec<f64> = serde_json::from_value(widths).expect("numbers");
            let [page, left, right, edge, height, window] = widths[..] else { panic!("{widths:?}") };
            assert!((window, page) == (390.0, 390.0), "{widths:?}");
            assert!(left >= 0.0 && right <= 390.0 && edge <= 390.0 && height > 100.0, "{widths:?}");
            // The equation itself needs no scrolling.
            let wide = browser.run(
                "return [...document.querySelectorAll('#why .equation')].filter((e) => e.scrollWidth > e.clientWidth).length",
            );
            assert_eq!(wide, json!(0));
            let small = browser.run(
                "return [...document.querySelectorAll('#why button, #why summary')]
                    .filter((e) => e.offsetParent && e.getBoundingClientRect().height < 40).map((e) => e.outerHTML)",
            );
            assert_eq!(small, json!([]));
        }
    }

    #[test]
    fn the_cross_and_the_remark_follow_the_camera_and_the_knobs() {
        let Some(browser) = Browser::start() else { return };
        // The picture next to the panel is 960 × 540.
        browser.resize(1344, 540);
        let folder = tempfile::tempdir().expect("a folder");
        opened(&browser, folder.path(), &scene(&shipped("compare_phong_blinn_phong.json")), [780, 220]);
        let state = |what: &str, cross: bool, remark: bool| {
            assert_eq!((!hidden(&browser, "cross"), !hidden(&browser, "why-now")), (cross, remark), "{what}");
        };
        browser.wait("return document.getElementById('cross').hidden", |hidden| *hidden == json!(false));
        state("as exported", true, false);
        let place = browser.run(
            "const frame = document.getElementById('cross').getBoundingClientRect();
            const picture = document.getElementById('picture').getBoundingClientRect();
            return [picture.width, frame.left + frame.width / 2 - picture.left, frame.top + frame.height / 2 - picture.top]",
        );
        let place: Vec<f64> = serde_json::from_value(place).expect("numbers");
        assert_eq!(place[0], 960.0);
        assert!((place[1] - 0.75 * 780.5).abs() < 0.5 && (place[2] - 0.75 * 220.5).abs() < 0.5, "{place:?}");
        key(&browser, "ArrowLeft");
        state("the camera has moved", false, false);
        key(&browser, "0");
        state("the camera is back", true, false);
        let sentence = "return document.querySelector('#why .said').textContent";
        let of_a = browser.run(sentence);
        // A parameter, the exposure, the shading model: each changes the picture, and the button resets
        // everything.
        let knob = "[data-name=k_d] input[type=number]";
        let value = format!("return document.querySelector({knob:?}).value");
        let before = browser.run(&value);
        turn(&browser, knob, "0.123");
        state("a knob was turned", false, true);
        let said = browser.run("return document.querySelector('#why-now p').textContent");
        assert_eq!(said, "Numbers of the scene as exported");
        let back = || {
            browser.run("document.getElementById('why-back').click()");
            browser.settle();
        };
        back();
        state("the knob was set back", true, false);
        assert_eq!(browser.run(&value), before);
        turn(&browser, "#exposure input[type=number]", "2");
        browser.run("document.querySelector('input[value=flat]').click()");
        browser.settle();
        state("exposure and shading", false, true);
        back();
        state("exposure and shading are back", true, false);
        assert_eq!(browser.run("return document.querySelector('#exposure input[type=number]').value"), "0");
        // Each view has a separate explanation.
        browser.run("document.querySelector('#views input[value=B]').click()");
        browser.settle();
        assert_ne!(browser.run(sentence), of_a);
        state("view B as exported", true, false);
        // The picture alone has no cross: it may be compared.
        let file = folder.path().join("page.html");
        browser.open(&file, "renderer=webgl&picture=384x216");
        browser.wait("return document.getElementById('why').hidden", |hidden| *hidden == json!(false));
        assert!(hidden(&browser, "cross"));
    }

    #[test]
    fn hostile_names_are_text_in_the_browser() {
        let Some(browser) = Browser::start() else { return };
        let folder = tempfile::tempdir().expect("a folder");
        let mut scene = scene(&shipped("default.json"));
        let hostile = "<img src=x onerror=\"document.title='caught'\"></b></summary>";
        scene.lights[0].name = Some(hostile.to_owned());
        opened(&browser, folder.path(), &scene, MIDDLE);
        assert_eq!(browser.run("return document.querySelectorAll('#why img').length"), json!(0));
        assert_eq!(browser.run("return document.querySelector('#why summary b').textContent"), hostile);
        assert_ne!(browser.run("return document.title"), "caught");
    }
}

#[test]
fn the_page_of_the_window_explains_what_is_pinned() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.json");
    fs::write(&path, save::to_json(&Scene::default(), None, &Registry::builtin())).expect("written");
    let mut window = crate::exports::window::Opened::new(&path);
    let plain = window.page("plain.html");
    window.pin([700, 320]);
    let explained = window.page("explained.html");
    assert_eq!(plain, made(&Scene::default(), None).0);
    assert_eq!(explained, page(&Scene::default(), [700, 320]));
}
