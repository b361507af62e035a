//! Pages: small, self-contained, and with the pictures of the program's renderers, drawn by Chromium with WebGPU and
//! with WebGL 2.

#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use lights_camera_models::{
    custom,
    export::{Export, ExportError, Progress, Request, html},
    optics::TermSelection,
    reference::Settings,
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Scene, has_extent,
        load::{self, Defaults},
    },
};
use serde_json::{Value, json};

use crate::{
    helpers::browser::Browser,
    helpers::pages::PAGES,
    helpers::pictures::sampled,
    helpers::support::{lcm, root},
};

const WIDTH: u32 = 384;
const HEIGHT: u32 = 216;

fn export(scene: &Scene, registry: &Registry) -> Result<Export, ExportError> {
    let request = Request { scene, registry, stem: "scene", size: (WIDTH, HEIGHT), object: 0, point: None };
    (html::HTML.make)(&request, &Progress::NONE)
}

/// The page of a scene.
pub(super) fn page(scene: &Scene) -> Result<Vec<u8>, ExportError> {
    let export = export(scene, &Registry::builtin())?;
    assert!(export.files.len() == 1 && export.files[0].path.is_empty());
    Ok(export.files[0].bytes.clone())
}

pub(super) fn scene(path: &Path) -> Scene {
    load::file(path, &Registry::builtin(), Defaults::Refuse).expect("valid").scene
}

fn shipped(name: &str) -> PathBuf {
    root().join("scenes").join(name)
}

#[test]
fn every_shipped_scene_is_a_page_within_the_limit() {
    for (path, export) in PAGES.iter() {
        let page = &export.files[0].bytes;
        assert!(page.len() <= html::LIMIT, "{}: {}", path.display(), page.len());
        let page = str::from_utf8(page).expect("UTF-8");
        // Nothing is loaded from anywhere.
        assert!(page.contains("Content-Security-Policy\" content=\"default-src 'none';"));
        for reference in ["http:", "https:", "src=", "href=", "url(", "@import", "import ", "fetch("] {
            assert!(!page.contains(reference), "{}: {reference}", path.display());
        }
        assert!(!page.contains("{{"), "a place is empty");
    }
}

/// Translation to GLSL ES 3.00 is part of making a page.
#[test]
fn every_model_can_be_drawn_with_every_shading_model_under_every_light() {
    let registry = Registry::builtin();
    let mut scene = scene(&shipped("default.json"));
    let object = scene.objects[0].clone();
    scene.objects.clear();
    for model in registry.models().iter().filter(|model| model.file().is_none()) {
        let mut object = object.clone();
        object.reflection_model = Some(model.declaration.id.to_owned());
        scene.objects.push(object);
    }
    let light = scene.lights[0].clone();
    let mut all = Vec::new();
    for entry in registry.lights() {
        let mut light = light.clone();
        light.set_type(entry, &registry, scene.scene_size);
        scene.lights = vec![light.clone()];
        all.push(light);
        // All models exceed a page,
        for some in scene.objects.chunks(9) {
            let part = Scene { objects: some.to_vec(), ..scene.clone() };
            page(&part).unwrap_or_else(|e| panic!("{}: {e}", entry.declaration.id));
        }
    }
    scene.lights = all;
    // and more so under all lights at once.
    for some in scene.objects.clone().chunks(4) {
        scene.objects = some.to_vec();
        page(&scene).expect("all lights at once");
    }
}

#[test]
fn what_users_write_is_no_markup() {
    let mut scene = scene(&shipped("default.json"));
    scene.name = Some("<script>alert(1)</script>".to_owned());
    scene.description = Some("{{script}} & \"quoted\"".to_owned());
    scene.objects[0].name = Some("</script><b>".to_owned());
    let page = String::from_utf8(page(&scene).expect("a page")).expect("UTF-8");
    assert!(page.contains("<title>&lt;script&gt;alert(1)&lt;/script&gt;</title>"));
    assert!(page.contains("{{script}} &amp; &quot;quoted&quot;"));
    assert_eq!(page.matches("</script>").count(), 4);
}

#[test]
fn scenes_that_no_page_can_hold_are_refused_with_the_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("page.html");
    let place = place.to_str().expect("Unicode");
    let refused = |change: &dyn Fn(&mut Value)| {
        let text = fs::read_to_string(shipped("white_furnace.json")).expect("readable");
        let mut scene: Value = serde_json::from_str(&text).expect("JSON");
        change(&mut scene);
        let run = lcm(&["export", "-", "--as", "html", "-o", place, "-q"], &scene.to_string());
        assert_eq!(run.status, Some(1), "{}", run.err);
        assert!(!Path::new(place).exists());
        run.err
    };
    let table = refused(&|scene| scene["display"] = json!({ "tone_mapping": "agx" }));
    assert!(table.contains("cannot be exported as html: display.tone_mapping: agx is a table"), "{table}");
    let large = refused(&|scene| {
        for (i, object) in scene["objects"].as_array_mut().expect("objects").iter_mut().enumerate() {
            object["type"] = "superellipsoid".into();
            object["vertical_exponent"] = (0.3 + 0.1 * i as f64).into();
        }
    });
    assert!(large.contains("and 300 kB is the limit") && large.contains("kB are meshes"), "{large}");
    let named = refused(&|scene| {
        // Letters that hardly compress.
        let mut state = 1_u32;
        let mut letter = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            char::from(b'a' + (state >> 24) as u8 % 26)
        };
        scene["objects"][0]["name"] = (0..400_000).map(|_| letter()).collect::<String>().into();
    });
    assert!(
        named.contains("kB are the names of objects and views") && named.contains("shorter names"),
        "{named}"
    );
    let hidden = refused(&|scene| {
        for object in scene["objects"].as_array_mut().expect("objects") {
            object["visible"] = false.into();
        }
    });
    assert!(hidden.contains("all objects are hidden; make one visible"), "{hidden}");
}

/// The mean difference of two pictures in levels, and the fraction of values that differ by more than 2.
#[derive(Clone, Copy, Debug)]
pub(super) struct Difference {
    pub(super) mean: f64,
    pub(super) beyond: f64,
}

pub(super) fn difference(a: &[u8], b: &[u8]) -> Difference {
    assert_eq!(a.len(), b.len());
    let off = || a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
    let count = a.len() as f64;
    Difference {
        mean: off().map(f64::from).sum::<f64>() / count,
        beyond: off().filter(|d| *d > 2).count() as f64 / count,
    }
}

/// One sample per pixel, so that no edge is smoothed: the page smooths display colours, and the program
/// light. The page snaps corners to a grid, which moves a few pixels of silhouettes; no others may differ.
pub(super) const MEAN: f64 = 0.15;
pub(super) const BEYOND: f64 = 0.004;

/// The size of pictures. Software draws frames of 64 samples in seconds; larger ones would outlast the patience of the
/// browser on a busy machine.
fn size_of(scene: &Scene) -> [u32; 2] {
    let share = if has_extent(scene.shining(), &Registry::builtin()) { 2 } else { 1 };
    [WIDTH / share, HEIGHT / share]
}

/// The renderers of `lcm render`, without a start of the program and its driver for each picture.
struct Program(GpuRenderer);

impl Program {
    fn new() -> Self {
        Self(GpuRenderer::new(WIDTH, HEIGHT, 1, Output::Display).expect("software Vulkan is installed"))
    }

    /// The picture of a view, with one sample per pixel.
    fn rendered(&mut self, scene: &Scene, view: usize) -> Vec<u8> {
        let registry = Registry::builtin();
        let (seen, terms) = scene.seen(view, &registry).expect("it has this view");
        assert_eq!(terms, TermSelection::All);
        if has_extent(scene.shining(), &registry) {
            // A page takes 64 samples of light with extent, and only the CPU renderer can be set to that.
            return sampled_on_cpu(&seen, &registry, 64);
        }
        self.0.set_scene(seen);
        self.0.settle().expect("the GPU draws");
        self.0.read_rgb8().expect("the picture can be read")
    }
}

/// The picture of a scene by the CPU renderer, with one sample per pixel and so many of light with extent.
fn sampled_on_cpu(scene: &Scene, registry: &Registry, count: u32) -> Vec<u8> {
    let [width, height] = size_of(scene);
    let settings = Settings { width, height, samples: 1, terms: TermSelection::All };
    sampled(scene, registry, &settings, count)
}

/// Sets a control of the panel as a user does, and waits until the picture has followed.
pub(super) fn set(browser: &Browser, selector: &str, value: &str) {
    browser.run(&format!(
        "const control = document.querySelector({selector:?});
        if (control.type === 'radio') control.click();
        else {{
            control.value = {value:?};
            control.dispatchEvent(new Event('input', {{ bubbles: true }}));
            control.dispatchEvent(new Event('change', {{ bubbles: true }}));
        }}"
    ));
    browser.settle();
}

/// A scene, and controls that are changed in its page.
struct Case {
    scene: &'static str,
    shading: Option<&'static str>,
    /// Parameter, value in the scene, value in the control.
    knob: Option<(&'static str, Value, &'static str)>,
}

const fn case(scene: &'static str) -> Case {
    Case { scene, shading: None, knob: None }
}

#[test]
fn pages_show_the_pictures_of_the_program_with_webgpu_and_webgl() {
    let Some(browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let knob =
        |scene, name, value: Value, control| Case { knob: Some((name, value, control)), ..case(scene) };
    let shaded = |scene, shading| Case { shading: Some(shading), ..case(scene) };
    let cases = [
        case("default.json"),
        case("shapes_and_lights.json"),
        case("photometric_lamps.json"),
        case("fresnel_effect.json"),
        shaded("gouraud_misses_highlight.json", "flat"),
        shaded("gouraud_misses_highlight.json", "gouraud"),
        shaded("superellipsoids.json", "derivative"),
        case("portrait.json"),
        // Under uniform light, the albedo curve must follow the control.
        knob("portrait.json", "alpha_x", json!(0.6), "0.6"),
        // And here the lobe's as well.
        knob("white_furnace.json", "alpha_y", json!(0.7), "0.7"),
        knob("white_furnace.json", "k_d", json!(0.6), "0.6"),
        // OpenPBR's curves, each layer: the page calculates them as the program does.
        knob("openpbr_car_paint.json", "coat_roughness", json!(0.5), "0.5"),
        knob("openpbr_car_paint.json", "coat_ior", json!(2.2), "2.2"),
        knob("openpbr_velvet.json", "fuzz_roughness", json!(0.9), "0.9"),
        knob("openpbr_brushed_steel.json", "roughness", json!(0.9), "0.9"),
        knob("openpbr_anodised_titanium.json", "thin_film_thickness", json!(0.3), "0.3"),
        knob("openpbr_satin.json", "specular_ior", json!(2.5), "2.5"),
    ];
    // Lamps name it.
    fs::copy(shipped("wall_washer.ies"), folder.path().join("wall_washer.ies")).expect("copied");
    let page_file = folder.path().join("page.html");
    let lamps = scene(&shipped("gouraud_misses_highlight.json"));
    let mut program = Program::new();
    let mut seen = 0;
    for (i, case) in cases.iter().enumerate() {
        let mut text: Value =
            serde_json::from_str(&fs::read_to_string(shipped(case.scene)).expect("readable")).expect("JSON");
        let mut original = scene(&shipped(case.scene));
        let registry = Registry::builtin();
        // The effect of controls is also visible without noise: under two lamps and uniform light.
        if case.knob.is_some() && has_extent(original.shining(), &registry) {
            original.lights.clone_from(&lamps.lights);
            text["lights"] = json!(lamps.lights);
        }
        fs::write(&page_file, page(&original).expect("a page")).expect("written");
        let object = case.knob.as_ref().and_then(|(name, ..)| {
            original.objects.iter().position(|o| {
                registry.model(original.model_of(o)).is_some_and(|m| m.parameter(name).is_some())
            })
        });
        if let (Some((name, value, _)), Some(object)) = (&case.knob, object) {
            text["objects"][object]["material"][name] = value.clone();
        }
        let changed = folder.path().join("changed.json");
        fs::write(&changed, text.to_string()).expect("written");
        let mut changed = scene(&changed);
        if let Some(shading) = case.shading {
            shading.clone_into(&mut changed.shading_model);
            changed.objects.iter_mut().for_each(|object| object.shading_model = None);
        }
        let expected = program.rendered(&changed, 0);
        let [across, down] = size_of(&original);
        browser.resize(across, down);
        // What a control changes, the page calculates before either draws: one of them shows it.
        let renderers = match case.knob {
            Some(_) => &["webgpu", "webgl"][i % 2..][..1],
            None => &["webgpu", "webgl"][..],
        };
        for renderer in renderers {
            let what = format!("{} {:?} {:?} {renderer}", case.scene, case.shading, case.knob);
            browser.open(&page_file, &format!("renderer={renderer}&picture={across}x{down}&samples=1"));
            if let Some(shading) = case.shading {
                set(&browser, &format!("input[value={shading}]"), "");
            }
            if let (Some((name, _, control)), Some(object)) = (&case.knob, object) {
                browser.run(&format!(
                    "const list = document.getElementById('object');
                    list.value = {object};
                    list.dispatchEvent(new Event('change'));"
                ));
                set(&browser, &format!("[data-name={name}] input[type=number]"), control);
            }
            let (shown, width) = browser.look();
            assert_eq!(width, across as usize, "{what}");
            let off = difference(&shown, &expected);
            println!("{what}: {off:?}");
            assert!(off.mean < MEAN && off.beyond < BEYOND, "{what}: {off:?}");
            seen += 1;
        }
        if case.shading.is_some() || case.knob.is_some() {
            continue;
        }
        // A wrong twin would be detected.
        let mut wrong = scene(&shipped(case.scene));
        wrong.display.exposure = 0.1;
        let off = difference(&program.rendered(&wrong, 0), &expected);
        assert!(off.mean > MEAN || off.beyond > BEYOND, "{}: {off:?}", case.scene);
    }
    assert_eq!(seen, 2 * cases.len() - cases.iter().filter(|case| case.knob.is_some()).count());
}

/// The page takes the first samples of those taken by the program, so that even the noise is equal. The light
/// itself is left out of the picture: pages do not show it.
#[test]
fn pages_have_light_with_extent() {
    let Some(browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.json");
    let text = json!({
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "observer": { "position": [5, 5, 9.9], "direction": [0, 0, -1], "field_of_view": 60 },
        "reflection_model": "microfacet", "shading_model": "phong",
        "lights": [
            { "type": "rectangle", "position": [7, 8, 9], "direction": [-1, -1, -2], "intensity": 20, "visible": false },
            { "type": "point", "position": [1, 9, 9], "intensity": 20 },
            { "type": "environment", "source": "studio", "visible": false }
        ],
        "objects": [{ "type": "sphere", "position": [5, 5, 5], "size": 4, "material": { "alpha_x": 0.3, "alpha_y": 0.3 } }]
    });
    fs::write(&file, text.to_string()).expect("written");
    let registry = Registry::builtin();
    let read = scene(&file);
    let [width, height] = size_of(&read);
    browser.resize(width, height);
    let rendered = |count: u32, scene: &Scene| sampled_on_cpu(scene, &registry, count);
    let expected = rendered(64, &read);
    let page_file = folder.path().join("page.html");
    fs::write(&page_file, page(&read).expect("a page")).expect("written");
    for renderer in ["webgpu", "webgl"] {
        browser.open(&page_file, &format!("renderer={renderer}&picture={width}x{height}&samples=1"));
        let (shown, _) = browser.look();
        let off = difference(&shown, &expected);
        println!("{renderer}: {off:?}");
        assert!(off.mean < MEAN && off.beyond < BEYOND, "{renderer}: {off:?}");
    }
    // The wrong twins: without the light, and with other samples.
    let mut dark = read.clone();
    dark.lights.remove(0);
    for wrong in [rendered(64, &dark), rendered(8, &read)] {
        let off = difference(&wrong, &expected);
        assert!(off.beyond > BEYOND, "{off:?}");
    }
}

/// The program paints a gradient itself, and on a page the browser does.
#[test]
fn pages_have_the_background_of_the_scene() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let (file, page_file) = (folder.path().join("scene.json"), folder.path().join("page.html"));
    let text = fs::read_to_string(shipped("default.json")).expect("readable");
    let (mut pictures, mut program) = (Vec::new(), Program::new());
    for (background, tone_mapping) in [("colour", "none"), ("colour", "aces"), ("gradient", "reinhard")] {
        let mut json: Value = serde_json::from_str(&text).expect("JSON");
        json["display"] = json!({
            "background": background, "background_colour": [250, 200, 40], "background_bottom": [20, 60, 160],
            "tone_mapping": tone_mapping,
        });
        fs::write(&file, json.to_string()).expect("written");
        let shown = scene(&file);
        let expected = program.rendered(&shown, 0);
        fs::write(&page_file, page(&shown).expect("a page")).expect("written");
        for renderer in ["webgpu", "webgl"] {
            browser.open(&page_file, &format!("renderer={renderer}&picture={WIDTH}x{HEIGHT}&samples=1"));
            let (shown, _) = browser.look();
            let off = difference(&shown, &expected);
            // Browsers may round a gradient by a level.
            let mean = if background == "gradient" { 1.0 } else { MEAN };
            assert!(
                off.mean < mean && off.beyond < BEYOND,
                "{background} {tone_mapping} {renderer}: {off:?}"
            );
        }
        pictures.push(expected);
    }
    // The wrong twin: another background.
    let off = difference(&pictures[0], &pictures[2]);
    assert!(off.mean > 1.0 && off.beyond > BEYOND, "{off:?}");
}

#[test]
fn a_page_holds_every_view_with_a_switch() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene(&shipped("compare_diffuse_models.json"));
    let page_file = folder.path().join("page.html");
    fs::write(&page_file, page(&scene).expect("a page")).expect("written");
    let text = |what: &str| browser.run(what).as_str().unwrap_or_default().to_owned();
    let mut program = Program::new();
    let expected = [0, 1, 2].map(|view| program.rendered(&scene, view));
    for renderer in ["webgpu", "webgl"] {
        browser.open(&page_file, &format!("renderer={renderer}&picture={WIDTH}x{HEIGHT}&samples=1"));
        for view in [0, 2, 1, 0] {
            let letter = ["A", "B", "C"][view];
            set(&browser, &format!("#views input[value={letter}]"), "");
            let (shown, _) = browser.look();
            let off = difference(&shown, &expected[view]);
            assert!(off.mean < MEAN && off.beyond < BEYOND, "{renderer} {letter}: {off:?}");
        }
        // Another view is another picture.
        let off = difference(&expected[0], &expected[1]);
        assert!(off.mean > MEAN || off.beyond > BEYOND, "{off:?}");
        // The panel follows: the model, its controls, the exposure.
        let model = "return document.querySelector('#model h2').textContent";
        let of_a = text(model);
        set(&browser, "#views input[value=B]", "");
        assert_ne!(text(model), of_a);
        assert_eq!(browser.run("return document.querySelectorAll('#shadings label').length"), json!(4));
    }
}

#[test]
fn a_page_cuts_and_breaks_no_name_and_offers_the_first_view_only_once_it_shows_another() {
    let Some(browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    for name in ["compare_tone_mappings.json", "compare_phong_blinn_phong.json"] {
        fs::write(&file, page(&scene(&shipped(name))).expect("a page")).expect("written");
        for (width, height) in [(1280, 720), (390, 844)] {
            browser.resize(width, height);
            browser.open(&file, "renderer=webgl");
            let what = format!("{name} in {width} × {height}");
            let cut = "return [...document.querySelectorAll('#views span')]
                .filter((e) => e.scrollWidth > e.clientWidth).map((e) => e.textContent)";
            assert_eq!(browser.run(cut), json!([]), "{what}");
            let words = "const all = [...document.querySelectorAll('h1 .whole, #model .whole')];
                const high = (e) => e.getBoundingClientRect().height > 1.5 * parseFloat(getComputedStyle(e).lineHeight);
                return [all.length > 0, all.filter(high).map((e) => e.textContent)]";
            assert_eq!(browser.run(words), json!([true, []]), "{what}");
            let is_hidden = || browser.run("return document.getElementById('view').offsetParent === null");
            assert_eq!(is_hidden(), json!(true), "{what}");
            browser.run(
                "document.getElementById('picture').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }))",
            );
            assert_eq!(is_hidden(), json!(false), "{what}");
            browser.run("document.getElementById('view').click()");
            assert_eq!(is_hidden(), json!(true), "{what}");
            browser.settle();
        }
    }
}

#[test]
fn a_view_that_no_page_can_hold_is_left_out_and_that_is_said() {
    let scene = scene(&shipped("compare_tone_mappings.json"));
    let export = export(&scene, &Registry::builtin()).expect("a page of the others");
    let left_out: Vec<_> = export.notes.iter().filter(|note| note.contains("is left out")).collect();
    assert!(left_out.len() == 1 && left_out[0].starts_with("view C (AgX) is left out: "), "{left_out:?}");
}

/// A model with a lobe that only the program can calculate.
const BORROWED: &str = "/* lcm { \"lobe\": \"microfacet\", \"parameters\": [\"alpha_x\", \"k_s\"] } */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(0.0), vec3(m.k_s * lobe_albedo(dot(frame.n, v)) * max(dot(frame.n, l), 0.0)));
}
";

#[test]
fn knobs_that_a_page_cannot_follow_are_told_at_export_once() {
    let mut registry = Registry::builtin();
    let model = custom::read(Path::new("models/borrowed.wgsl"), BORROWED, &registry).expect("valid");
    registry.put_custom_model(model);
    let notes_of = |id: &str| {
        let mut scene = scene(&shipped("openpbr_car_paint.json"));
        scene.reflection_model = id.to_owned();
        scene.objects.iter_mut().for_each(|o| o.reflection_model = None);
        export(&scene, &registry).expect("a page").notes
    };
    let about = |notes: &[String]| notes.iter().filter(|n| n.contains("knobs are fixed")).count();
    assert_eq!(about(&notes_of("borrowed")), 1);
    for id in ["openpbr", "microfacet", "phong"] {
        assert_eq!(about(&notes_of(id)), 0, "{id}");
    }
    let opaque = |id: &str| -> Vec<_> {
        notes_of(id)
            .into_iter()
            .filter(|note| note.contains("opaque on the page, without knobs for"))
            .collect()
    };
    let left_out = opaque("openpbr");
    assert_eq!(left_out.len(), 1, "{left_out:?}");
    let model = registry.model("openpbr").expect("built in");
    let group = model.groups.iter().find(|group| group.name == "Transmission").expect("a group");
    for p in model.parameters.iter().filter(|p| group.parameters.contains(&p.name)) {
        assert!(left_out[0].contains(p.label), "{}: {left_out:?}", p.name);
    }
    assert!(opaque("phong").is_empty());
}

#[test]
fn a_page_reacts_to_fingers_keys_and_taps() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(900, 600);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    fs::write(&file, page(&scene(&shipped("gold_three_lights.json"))).expect("a page")).expect("written");
    browser.open(&file, "renderer=webgl");
    let (first, _) = browser.look();
    let key = |key: &str| {
        browser.run(&format!(
            "document.getElementById('picture').dispatchEvent(new KeyboardEvent('keydown', {{ key: {key:?} }}))"
        ));
        browser.settle();
        browser.look().0
    };
    let turned = key("ArrowLeft");
    assert!(difference(&first, &turned).mean > 0.5);
    let back = key("0");
    assert!(difference(&first, &back).mean < 0.01, "{:?}", difference(&first, &back));
    // Nothing is drawn while nothing changes.
    let drawn = browser.run("return document.body.dataset.drawn");
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(browser.run("return document.body.dataset.drawn"), drawn);
    // A picture discarded by the system is restored.
    browser.run(
        "const canvas = document.querySelector('canvas');
        document.body.dataset.state = 'busy';
        canvas.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()",
    );
    browser.settle();
    let again = browser.look().0;
    assert!(difference(&first, &again).mean < 0.01, "{:?}", difference(&first, &again));
    // A tap on the teapot on the right selects it.
    let tap = "const picture = document.getElementById('picture');
        const at = { pointerId: 1, isPrimary: true, clientX: 0.8 * picture.clientWidth, clientY: 0.5 * picture.clientHeight };
        picture.setPointerCapture = () => {};
        picture.dispatchEvent(new PointerEvent('pointerdown', at));
        picture.dispatchEvent(new PointerEvent('pointerup', at));
        return document.getElementById('object').value";
    assert_ne!(browser.run(tap), "0");
    // All touch targets are large enough, and have names.
    let small = browser.run(
        "return [...document.querySelectorAll('button, select, input, summary')]
            .filter((e) => e.offsetParent && e.getBoundingClientRect().height < 40 && e.type !== 'radio')
            .map((e) => e.outerHTML)",
    );
    assert_eq!(small, json!([]));
    let nameless = browser.run(
        "return [...document.querySelectorAll('select, input')]
            .filter((e) => !e.ariaLabel && e.labels.length === 0).map((e) => e.outerHTML)",
    );
    assert_eq!(nameless, json!([]));
}

/// Larger than the number of function arguments that a browser accepts.
#[test]
fn pages_with_large_meshes_draw_with_webgpu_and_webgl() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    let registry = Registry::builtin();
    let most = *registry.shape("sphere").expect("built in").declaration.tessellation.end();
    let mut pages = Vec::new();
    for tessellation in [252, 256, most] {
        let mut scene = scene(&shipped("default.json"));
        scene.objects[0].tessellation = Some(tessellation);
        pages.push((format!("sphere {tessellation}"), page(&scene).expect("a page")));
    }
    // A regular surface takes few bytes: 302 500 squares that face the observer.
    let grid = folder.path().join("grid.obj");
    let side = 550;
    let mut text = String::new();
    for y in 0..=side {
        (0..=side).for_each(|x| text.push_str(&format!("v {x} {y} 0\n")));
    }
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let at = y * (side + 1) + x + 1;
        text.push_str(&format!("f {at} {} {} {}\n", at + 1, at + side + 2, at + side + 1));
    }
    fs::write(&grid, text).expect("written");
    let mut json: Value =
        serde_json::from_str(&fs::read_to_string(shipped("default.json")).expect("readable")).expect("JSON");
    json["objects"][0]["type"] = "mesh".into();
    json["objects"][0]["path"] = "grid.obj".into();
    json["objects"][0].as_object_mut().expect("an object").remove("tessellation");
    let place = folder.path().join("grid.json");
    fs::write(&place, json.to_string()).expect("written");
    pages.push(("grid".to_owned(), page(&scene(&place)).expect("a page")));
    for (what, page) in pages {
        fs::write(&file, page).expect("written");
        for renderer in ["webgpu", "webgl"] {
            browser.open(&file, &format!("renderer={renderer}&picture={WIDTH}x{HEIGHT}&samples=1"));
            for shading in ["flat", "phong"] {
                set(&browser, &format!("input[value={shading}]"), "");
                assert_eq!(browser.run("return document.body.dataset.state"), "ready", "{what} {renderer}");
                let (shown, _) = browser.look();
                let middle = 3 * (HEIGHT / 2 * WIDTH + WIDTH / 2) as usize;
                let corner = &shown[..3];
                assert_ne!(
                    &shown[middle..middle + 3],
                    corner,
                    "{what} {renderer} {shading}: nothing is drawn"
                );
            }
        }
    }
}

#[test]
fn a_page_says_what_it_does_until_its_first_picture_is_there() {
    let Some(browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    fs::write(&file, page(&scene(&shipped("default.json"))).expect("a page")).expect("written");
    browser.run_first(
        "window.said = [];
        new MutationObserver(() => window.said.push(document.getElementById('renderer')?.textContent ?? ''))
            .observe(document, { subtree: true, childList: true, characterData: true });",
    );
    browser.open(&file, "");
    let said = browser.run("return window.said.filter((text, i, all) => text && text !== all[i - 1])");
    let said: Vec<_> = said.as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    assert!(said.first() == Some(&"Compiling the shader…") && said.contains(&"Drawing…"), "{said:?}");
    assert!(said.last().is_some_and(|last| last.starts_with("Web")), "{said:?}");
}

/// As if by the system: the device is lost, there is no adapter, nothing answers, work on the GPU ends in errors,
/// nothing reaches the screen.
#[test]
fn a_page_goes_on_with_webgl_when_webgpu_fails() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    fs::write(&file, page(&scene(&shipped("default.json"))).expect("a page")).expect("written");
    // Pages without WebGPU have none of its classes.
    browser.run_first(
        "const asks = (what) => window.GPU && location.hash.includes(what);
        const gone = async () => { throw new Error('A valid external Instance reference no longer exists.'); };
        if (asks('broken')) GPU.prototype.requestAdapter = gone;
        const silent = () => new Promise(() => {});
        if (asks('mute')) GPU.prototype.requestAdapter = silent;
        if (asks('silent')) {
            // So that the test need not wait as long.
            const after = window.setTimeout;
            window.setTimeout = (what, ms, ...all) => after(what, ms === 10000 ? 300 : ms, ...all);
        }
        if (asks('late')) GPUQueue.prototype.onSubmittedWorkDone = gone;
        if (asks('blank')) GPUQueue.prototype.submit = () => {};
        if (asks('unread')) GPUBuffer.prototype.mapAsync = gone;
        if (asks('neither')) {
            GPU.prototype.requestAdapter = gone;
            HTMLCanvasElement.prototype.getContext = () => null;
        }
        if (window.GPU) {
            const made = GPUAdapter.prototype.requestDevice;
            GPUAdapter.prototype.requestDevice = async function (...all) {
                if (asks('deaf')) return silent();
                return (window.device = await made.apply(this, all));
            };
        }",
    );
    let size = format!("picture={WIDTH}x{HEIGHT}&samples=1");
    let text = |what: &str| {
        let said = browser.run(&format!("return document.getElementById({what:?}).textContent"));
        said.as_str().unwrap_or_default().to_owned()
    };
    browser.open(&file, &format!("renderer=webgl&{size}"));
    assert_eq!(text("renderer"), "WebGL 2");
    let expected = browser.look().0;
    let follows = |what: &str| {
        assert_eq!(text("failure"), "", "{what}");
        assert_eq!(text("renderer"), "WebGPU failed, so WebGL 2 draws", "{what}");
        let off = difference(&browser.look().0, &expected);
        assert!(off.mean < 0.01, "{what}: {off:?}");
    };
    for what in ["broken", "late", "blank", "silent-mute", "silent-deaf"] {
        browser.open(&file, &format!("{what}&{size}"));
        follows(what);
    }
    browser.open(&file, &size);
    assert_eq!(text("renderer"), "WebGPU");
    browser.run("document.body.dataset.state = 'busy'; window.device.destroy()");
    browser.settle();
    follows("destroyed");
    // It stays usable: knobs and views follow.
    set(&browser, "input[value=flat]", "");
    assert!(difference(&browser.look().0, &expected).mean > 0.01);
    // The curve of a model is read from the GPU.
    fs::write(&file, page(&scene(&shipped("white_furnace.json"))).expect("a page")).expect("written");
    let mut curves = Vec::new();
    for way in ["renderer=webgl", "unread"] {
        browser.open(&file, &format!("{way}&{size}"));
        set(&browser, "#object", "2");
        set(&browser, "[data-name=alpha_y] input[type=number]", "0.7");
        assert_eq!(text("failure"), "", "{way}");
        curves.push(browser.look().0);
    }
    assert_eq!(text("renderer"), "WebGPU failed, so WebGL 2 draws");
    assert!(difference(&curves[0], &curves[1]).mean < 0.01);
    // Without either, a sentence says what to do. Another file, since another fragment alone would not load the page anew.
    let other = folder.path().join("other.html");
    fs::copy(&file, &other).expect("copied");
    browser.visit(&format!("{}#neither&{size}", other.display()));
    browser.settle();
    let said = text("failure");
    assert!(said.contains("refuses WebGL 2. Switch on hardware acceleration"), "{said}");
}

#[test]
fn a_browser_that_cannot_read_the_program_says_so() {
    let Some(browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    let page = String::from_utf8(page(&scene(&shipped("default.json"))).expect("a page")).expect("UTF-8");
    // As in a browser that does not support a part of the language.
    fs::write(&file, page.replacen("class Uniform {", "class Uniform { #?", 1)).expect("written");
    browser.visit(file.to_str().expect("Unicode"));
    browser.settle();
    let said = browser.run("return document.getElementById('failure').textContent");
    assert!(said.as_str().is_some_and(|said| said.contains("This browser cannot run the page")), "{said}");
}
