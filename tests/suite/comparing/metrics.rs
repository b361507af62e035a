//! Comparing views: numbers against those of other programs, maps, layouts, and `lcm compare`.

use std::{fs, io::Write as _, path::Path};

use flate2::{Compression, Crc, write::ZlibEncoder};
use glam::Vec4;
use lights_camera_models::{
    compare::{Cell, Measured, Pair, Shown, Unequal, cells, compose, size_around},
    linear::{Channels, Format, Notes},
    parameter::Value,
    picture::png::{self, About},
    reference::{Picture, Settings},
    registry::Registry,
    scene::{
        Comparison, Scene, Variant,
        comparison::{Channel, Compared, Edge, Layout, Sign},
    },
};
use serde_json::{Value as Json, json};

use crate::{
    helpers::support::{Run, changed, check_wording, full_scene, lcm_in, root, written},
    renderers::golden::{SAME_RENDERER, read_png, updating},
};

const WIDTH: u32 = 150;
const HEIGHT: u32 = 94;

type Pixel = fn(i64, i64, i64) -> i64;

/// Slanted ramps, cut by a chequerboard.
fn left(x: i64, y: i64, c: i64) -> i64 {
    (x * 3 + y * 5 * (c + 1) + 40 * ((x / 16 + y / 16) % 2)) % 256
}

/// The first picture shifted on the left, noisy in the middle, equal on the right.
fn right(x: i64, y: i64, c: i64) -> i64 {
    match x {
        ..60 => left(x + 1, y, c),
        60..110 => (left(x, y, c) + (x * 7 + y * 13 + c * 29) % 31 - 15).clamp(0, 255),
        _ => left(x, y, c),
    }
}

/// The first picture shifted cyclically by one pixel to the right.
fn shifted(x: i64, y: i64, c: i64) -> i64 {
    left((x + i64::from(WIDTH) - 1) % i64::from(WIDTH), y, c)
}

/// A picture whose covered pixels are a disc.
fn picture(pixel: Pixel) -> Shown {
    let places = || (0..i64::from(HEIGHT)).flat_map(|y| (0..i64::from(WIDTH)).map(move |x| (x, y)));
    let codes = places().flat_map(|(x, y)| [0, 1, 2].map(|c| pixel(x, y, c) as u8));
    let disc = places().map(|(x, y)| (x - 75).pow(2) + (y - 47).pow(2) < 900);
    let shown = Shown::of_codes(WIDTH, HEIGHT, codes.collect()).expect("as many as pixels");
    shown.covering(disc.collect()).expect("as many as pixels")
}

#[path = "../../../examples/metric.rs"]
#[allow(dead_code)]
mod metric;

#[test]
fn a_metric_of_another_crate_is_calculated_from_the_pixels() {
    // Larger than a tile, and nowhere equal to itself but at the left.
    let plain = |from: usize| {
        let pixel = |i: usize| if i % 100 < from { [9; 3] } else { [200, 9, (i % 7) as u8] };
        Shown::of_codes(100, 70, (0..7000).flat_map(pixel).collect()).expect("as many as pixels")
    };
    let (a, b) = (plain(25), plain(75));
    let changed = |a: &Shown, b: &Shown| {
        let pair = Pair::new(a, b).expect("of one size");
        pair.measure_by(&[&metric::CHANGED]).expect("has pixels").all.numbers
    };
    assert_eq!(changed(&a, &b), [("changed", Some(0.5))]);
    assert_eq!(changed(&a, &a), [("changed", Some(0.0))]);
}

fn measured(a: &Shown, b: &Shown) -> Measured {
    Pair::new(a, b).expect("of one size").measure().expect("has pixels")
}

/// RMSE, PSNR, SSIM and ꟻLIP.
type Four = [f64; 4];

fn four(measured: &Measured) -> [Four; 2] {
    let covered = measured.covered.as_ref().expect("some are covered");
    [&measured.all, covered]
        .map(|m| ["rmse", "psnr", "ssim", "flip"].map(|id| m.of(id).expect("codes are known")))
}

/// Maximum differences: both calculate in 32 bits in places.
const TOLERANCE: Four = [1e-9, 1e-6, 2e-6, 2e-5];

fn agree(found: [Four; 2], expected: [Four; 2]) -> bool {
    let each = found.iter().flatten().zip(expected.iter().flatten());
    each.zip(TOLERANCE.iter().cycle()).all(|((a, b), tolerance)| (a - b).abs() <= *tolerance)
}

#[test]
fn metrics_are_those_of_other_programs() {
    // NumPy 2.4.6, scikit-image 0.26.0 (`structural_similarity` of luma, `gaussian_weights`, σ 1.5, population
    // covariance, the edges repeated) and NVIDIA's flip-evaluator 1.7 (LDR, 67 pixels per degree).
    let noisy = [
        [0.084_949_208_086_341_21, 21.416_813_307_137_14, 0.895_455_333_384_257_3, 0.090_330_795_127],
        [0.051_316_436_209_840_034, 25.794_870_236_956_57, 0.913_914_851_844_268, 0.065_844_863_492],
    ];
    let further = [
        [0.140_397_812_483_922_39, 17.052_793_176_540_604, 0.784_303_763_666_755_7, 0.203_373_360_451],
        [0.138_995_734_276_696, 17.139_970_557_294_994, 0.812_890_893_627_971_3, 0.192_886_101_514],
    ];
    let a = picture(left);
    for (other, expected) in [(right as Pixel, noisy), (shifted, further)] {
        let found = measured(&a, &picture(other));
        assert_eq!((found.all.pixels, found.covered.as_ref().map(|m| m.pixels)), (14_100, Some(2809)));
        assert!(agree(four(&found), expected), "{found:?}\n{expected:?}");
        assert_eq!(found.all.of("light_rmse"), None);
    }
    // The wrong twin: the other pair.
    assert!(!agree(four(&measured(&a, &picture(shifted))), noisy));
}

#[test]
fn metrics_do_not_depend_on_which_is_first_and_equal_pictures_have_no_difference() {
    let (a, b) = (picture(left), picture(right));
    let [there, back] = [four(&measured(&a, &b)), four(&measured(&b, &a))];
    assert!(agree(there, back), "{there:?}, {back:?}");
    assert_eq!(four(&measured(&a, &a)), [[0.0, f64::INFINITY, 1.0, 0.0]; 2]);
    let differences = Pair::new(&a, &a).expect("of one size").differences(&Comparison::default());
    assert_eq!(differences.expect("codes are known").largest, None);
}

#[test]
fn black_and_white_are_as_different_as_can_be() {
    let plain = |code| Shown::of_codes(20, 10, vec![code; 600]).expect("as many as pixels");
    let all = measured(&plain(0), &plain(255)).all;
    let found = |id| all.of(id).expect("codes are known");
    assert_eq!((found("rmse"), found("psnr")), (1.0, 0.0));
    // By hand: C₁ / (1 + C₁). From flip-evaluator 1.7.
    assert!((found("ssim") - 1e-4 / 1.0001).abs() < 1e-6, "{all:?}");
    assert!((found("flip") - 0.967_390_656).abs() < 1e-5, "{all:?}");
}

/// Two pixels of light, the second covered by half of its samples.
fn light(first: Vec4) -> Shown {
    let pixels = vec![first, Vec4::new(0.1, 0.2, 0.3, 0.5), Vec4::ZERO];
    Shown::of_light(Picture { width: 3, height: 1, pixels }, &Scene::default().display)
}

#[test]
fn light_is_measured_where_it_is_known() {
    let (a, b) = (light(Vec4::new(0.5, 0.5, 0.5, 1.0)), light(Vec4::new(0.5, 0.9, 0.2, 1.0)));
    let found = measured(&a, &b);
    // √((0.4² + 0.3²) / 9) over three pixels, two of which are covered.
    let near = |x: Option<f64>, y: f64| (x.expect("light is known") - y).abs() < 1e-7;
    assert!(near(found.all.of("light_rmse"), 0.25_f64.sqrt() / 3.0), "{found:?}");
    assert!(
        near(found.covered.as_ref().expect("covered").of("light_rmse"), (0.25_f64 / 6.0).sqrt()),
        "{found:?}"
    );
    let pair = Pair::new(&a, &b).expect("of one size");
    let in_light = |channel| {
        let comparison = Comparison { values: Compared::Light, channel, ..Comparison::default() };
        let found = pair.differences(&comparison).expect("light is known").largest;
        assert!(found.is_none_or(|found| (found.x, found.y) == (0, 0)));
        found.map(|found| found.difference)
    };
    for (channel, expected) in [
        (Channel::Largest, 0.4),
        (Channel::Green, 0.4),
        (Channel::Blue, -0.3),
        (Channel::Luminance, 0.7152 * 0.4 - 0.0722 * 0.3),
    ] {
        assert!((in_light(channel).expect("one differs") - expected).abs() < 1e-6, "{channel:?}");
    }
    assert_eq!(in_light(Channel::Red), None);
    // The light of a picture of codes is not known.
    let codes = Shown::of_codes(3, 1, vec![0; 9]).expect("as many as pixels");
    let comparison = Comparison { values: Compared::Light, ..Comparison::default() };
    let pair = Pair::new(&a, &codes).expect("of one size");
    assert_eq!(pair.differences(&comparison), Err(Unequal::NoLight));
}

#[test]
fn pictures_of_different_sizes_are_not_compared() {
    let [a, b] = [(3, 1), (1, 3)].map(|(w, h)| Shown::of_codes(w, h, vec![0; 9]).expect("right"));
    let error = Pair::new(&a, &b).map(drop).expect_err("different");
    assert_eq!(error.to_string(), "one picture has 3×1 pixels, the other 1×3; they must have the same size");
    assert!(Shown::of_codes(3, 2, vec![0; 9]).is_err());
    assert!(Shown::of_codes(3, 1, vec![0; 9]).and_then(|s| s.covering(vec![true; 2])).is_err());
    assert!(Shown::of_codes(0, 0, vec![]).is_ok_and(|empty| {
        Pair::new(&empty, &empty)
            .is_ok_and(|pair| pair.measure().is_none() && pair.map(&Comparison::default()).is_ok())
    }));
}

#[test]
fn maps_show_sign_and_amplification() {
    // A difference of 51 codes up, and one of 25 down.
    let a = Shown::of_codes(2, 1, vec![100, 100, 100, 200, 200, 200]).expect("right");
    let b = Shown::of_codes(2, 1, vec![151, 100, 100, 200, 175, 200]).expect("right");
    let pair = Pair::new(&a, &b).expect("of one size");
    let map = |sign, amplification| {
        let comparison = Comparison { sign, amplification: Some(amplification), ..Comparison::default() };
        let map = pair.differences(&comparison).expect("known").colours(&comparison);
        [[map[0], map[1], map[2]], [map[3], map[4], map[5]]]
    };
    // Viridis at 0.2 and at 1; at 25/255 and at 125/255.
    assert_eq!(map(Sign::Absolute, 1.0)[0], [65, 68, 135]);
    assert_eq!(map(Sign::Absolute, 5.0), [[253, 231, 37], [34, 142, 141]]);
    assert_eq!(map(Sign::Absolute, 100.0), [[253, 231, 37]; 2]);
    // Brighter is orange, darker is blue.
    let [[r, _, b], [s, _, c]] = map(Sign::Signed, 3.0);
    assert!(r > b && s < c, "{:?}", map(Sign::Signed, 3.0));
    // No difference is the middle.
    let comparison = Comparison { sign: Sign::Signed, ..Comparison::default() };
    let none = Pair::new(&a, &a).expect("of one size").differences(&comparison).expect("known");
    assert_eq!(none.colours(&comparison), [236; 6]);
}

/// A scene with three variants.
fn scene() -> Scene {
    let mut phong = Variant {
        name: Some("Phong".to_owned()),
        reflection_model: Some("phong".to_owned()),
        shading_model: Some("phong".to_owned()),
        ..Variant::default()
    };
    phong.material.set("alpha", Value::Integer(20));
    let flat = Variant { shading_model: Some("flat".to_owned()), tessellation: Some(8), ..phong.clone() };
    let variants = vec![
        phong,
        Variant { name: None, ..flat },
        Variant { name: Some("dark".to_owned()), exposure: Some(-2.0), ..Variant::default() },
    ];
    let mut scene = Scene { variants, ..Scene::default() };
    scene.objects[0].size = 2.6;
    scene
}

fn composed(scene: &Scene, comparison: &Comparison, size: [u32; 2]) -> Vec<u8> {
    let registry = Registry::builtin();
    let cells = cells(comparison, scene.variants.len(), size).expect("there is room");
    let shown: Vec<_> = cells
        .iter()
        .map(|cell| {
            let settings = Settings { width: cell.width, height: cell.height, ..Settings::default() };
            let shown = Shown::of_view(scene, cell.view, &registry, &settings).expect("there is such a view");
            if comparison.layout == Layout::Difference { shown.outlined(scene, &registry) } else { shown }
        })
        .collect();
    compose(comparison, size, &shown).expect("sizes match")
}

/// The layouts with stored pictures.
fn layouts() -> Vec<(&'static str, usize, Comparison)> {
    let plain = Comparison::default();
    let difference = Comparison { layout: Layout::Difference, ..plain };
    vec![
        ("side_by_side", 1, Comparison { layout: Layout::SideBySide, ..plain }),
        ("four", 3, Comparison { layout: Layout::SideBySide, ..plain }),
        ("three", 2, Comparison { layout: Layout::SideBySide, ..plain }),
        ("wipe", 3, Comparison { layout: Layout::Wipe, ..plain }),
        (
            "wipe_across",
            3,
            Comparison { layout: Layout::Wipe, edge: Edge::Horizontal, split: 0.4, with: 3, ..plain },
        ),
        ("difference", 1, Comparison { amplification: Some(2.0), ..difference }),
        (
            "signed_light",
            3,
            Comparison {
                sign: Sign::Signed,
                channel: Channel::Luminance,
                values: Compared::Light,
                amplification: Some(4.0),
                with: 2,
                ..difference
            },
        ),
    ]
}

#[test]
fn layouts_look_as_accepted() {
    let size = [320, 180];
    for (name, variants, comparison) in layouts() {
        let mut scene = scene();
        scene.variants.truncate(variants);
        let picture = composed(&scene, &comparison, size);
        let path = root().join(format!("tests/golden/comparison/{name}.png"));
        let agrees = |picture: &[u8]| {
            read_png(&path)
                .is_ok_and(|(w, h, old)| [w, h] == size && SAME_RENDERER.broken(picture, &old).is_none())
        };
        if updating() && !agrees(&picture) {
            png::write(&path, size[0], size[1], &picture, &About::default()).expect("can be written");
        }
        assert!(agrees(&picture), "{name} looks otherwise; look at it, and accept it with LCM_UPDATE=1");
        // The wrong twin: other light.
        scene.lights.iter_mut().for_each(|light| light.intensity *= 1.5);
        assert!(!agrees(&composed(&scene, &comparison, size)), "{name}");
    }
}

#[test]
fn cells_are_equal_and_fill_the_picture() {
    let beside = Comparison { layout: Layout::SideBySide, ..Comparison::default() };
    for size in [[320, 180], [321, 181], [1280, 720], [1921, 1081], [90, 160], [5, 5]] {
        for variants in 1..=3 {
            let cells = cells(&beside, variants, size).expect("there is room");
            assert_eq!(cells.len(), variants + 1);
            let Cell { width, height, .. } = cells[0];
            for (i, cell) in cells.iter().enumerate() {
                assert_eq!((cell.view, cell.width, cell.height), (i, width, height));
                assert!(cell.left + width <= size[0] && cell.top + height <= size[1]);
            }
            assert_eq!(cells[1].left + width, size[0]);
            let around = size_around(&beside, variants, [width, height]);
            let again =
                lights_camera_models::compare::cells(&beside, variants, around).expect("there is room");
            assert!(again.iter().all(|cell| (cell.width, cell.height) == (width, height)), "{size:?}");
            assert!(cells[1].left > width, "there is a gap");
        }
    }
    assert_eq!(cells(&beside, 1, [3, 3]), None);
    // On top of each other, each has the whole area.
    for layout in [Layout::Wipe, Layout::Difference, Layout::Blink] {
        let comparison = Comparison { layout, with: 2, ..Comparison::default() };
        let cells = cells(&comparison, 3, [20, 10]).expect("there is room");
        let place = |view| Cell { view, left: 0, top: 0, width: 20, height: 10 };
        assert_eq!(cells, [place(0), place(2)]);
    }
}

#[test]
fn legend_and_mark_give_way_to_each_other_and_to_small_pictures() {
    // One pixel differs, at the lower left, where the legend would be.
    let (width, height) = (640u32, 360u32);
    let black = vec![0; (width * height * 3) as usize];
    let with_dot = |x: u32, y: u32| {
        let mut codes = black.clone();
        codes[3 * (y * width + x) as usize] = 255;
        Shown::of_codes(width, height, codes).expect("right")
    };
    let a = Shown::of_codes(width, height, black.clone()).expect("right");
    let ground = [68, 1, 84];
    let at = |map: &[u8], x: u32, y: u32| {
        let i = 3 * (y * width + x) as usize;
        [map[i], map[i + 1], map[i + 2]]
    };
    for (x, legend) in [(20, width - 30), (620, 30)] {
        let b = with_dot(x, 340);
        let pair = Pair::new(&a, &b).expect("of one size");
        let map = pair.map(&Comparison::default()).expect("known");
        assert_ne!(at(&map, legend, 350), ground, "there is a legend at {legend}");
        assert_eq!(at(&map, x, 340), [253, 231, 37], "the difference at {x} shows");
        let ring = (1..40).filter(|d| at(&map, x, 340 - d) == [255, 255, 255]).count();
        let dark = (1..40).filter(|d| at(&map, x, 340 - d).iter().all(|code| *code < 30)).count();
        assert!(ring > 0 && dark > 0, "a bright and a dark ring: {ring}, {dark}");
    }
    // Larger letters make a larger plate, as far as there is room.
    let b = with_dot(20, 340);
    let pair = Pair::new(&a, &b).expect("of one size");
    let rows = |px: Option<f32>| {
        let map = pair.map_in_letters(&Comparison::default(), px).expect("known");
        (50..height).filter(|y| at(&map, width - 30, *y) != ground).count()
    };
    assert!(rows(Some(30.0)) > 2 * rows(None) && rows(None) > 0, "{} and {}", rows(Some(30.0)), rows(None));
    assert_eq!(rows(Some(1000.0)), rows(None));
    let pair = Pair::new(&a, &a).expect("of one size");
    let map = pair.map(&Comparison::default()).expect("known");
    assert_eq!(at(&map, 320, 100), ground);
    for (w, h) in [(1, 1), (40, 20), (3, 200), (200, 3)] {
        let [a, b] = [0, 9].map(|c| Shown::of_codes(w, h, vec![c; (3 * w * h) as usize]).expect("right"));
        assert!(Pair::new(&a, &b).is_ok_and(|pair| pair.map(&Comparison::default()).is_ok()), "{w}×{h}");
        let both = [a, b];
        for edge in [Edge::Vertical, Edge::Horizontal] {
            let wipe = Comparison { layout: Layout::Wipe, edge, ..Comparison::default() };
            assert!(compose(&wipe, [w, h], &both).is_ok(), "{w}×{h}");
        }
    }
}

/// A folder with scenes and pictures to compare.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).expect("written");
    write("all.json", written(&scene()));
    let mut one = scene();
    one.variants.truncate(1);
    one.comparison = Comparison { layout: Layout::Wipe, ..Comparison::default() };
    write("one.json", written(&one));
    write("plain.json", written(&Scene { variants: vec![], ..scene() }));
    let (seen, _) = scene().seen(1, &Registry::builtin()).expect("there is B");
    write("phong.json", written(&Scene { variants: vec![], ..seen }));
    write("broken.json", "{".to_owned());
    write("not_a.png", "{}".to_owned());
    for (name, w, h, code) in
        [("grey.png", 96, 54, 50), ("white.png", 96, 54, 255), ("small.png", 20, 10, 50)]
    {
        let codes = vec![code; (3 * w * h) as usize];
        png::write(&folder.path().join(name), w, h, &codes, &About::default()).expect("written");
    }
    folder
}

/// Runs the program with small pictures.
fn run(folder: &Path, arguments: &[&str]) -> Run {
    let run = lcm_in(folder, arguments, b"");
    check_wording(&run.err.replace("e.g. ", ""));
    run
}

fn numbers(run: &Run) -> Json {
    serde_json::from_str(&run.out).unwrap_or_else(|e| panic!("{e}: {}{}", run.out, run.err))
}

#[test]
fn the_command_prints_numbers() {
    let folder = folder();
    let small = ["--size", "96x54"];
    let with = |arguments: &[&str]| {
        let all: Vec<_> = ["compare"].iter().chain(arguments).chain(&small).copied().collect();
        let run = run(folder.path(), &all);
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{arguments:?}");
        let keys = ["a", "b", "width", "height", "values", "channel", "all", "covered", "largest"];
        let places = keys.map(|key| run.out.find(&format!("\n  \"{key}\": ")));
        assert!(places.is_sorted() && places[0].is_some(), "{}", run.out);
        numbers(&run)
    };
    let own = with(&["all.json"]);
    assert_eq!(own["a"], json!({ "file": "all.json", "view": "A", "name": scene().name }));
    assert_eq!(own["b"], json!({ "file": "all.json", "view": "B", "name": "Phong" }));
    assert_eq!((&own["width"], &own["all"]["pixels"]), (&json!(96), &json!(96 * 54)));
    let number = |at: &str| own.pointer(at).and_then(Json::as_f64).unwrap_or_else(|| panic!("{at}"));
    assert!(number("/all/rmse") > 0.001 && number("/covered/rmse") > number("/all/rmse"), "{own}");
    assert!(number("/all/psnr") > number("/covered/psnr"));
    assert!(number("/all/ssim") < 1.0 && number("/all/flip") > 0.0 && number("/all/light_rmse") > 0.0);
    assert!(number("/covered/pixels") < number("/all/pixels"));
    assert!(number("/largest/difference").abs() > 5.0);

    // The library returns the same.
    let registry = Registry::builtin();
    let settings = Settings { width: 96, height: 54, ..Settings::default() };
    let shown = [0, 1].map(|view| Shown::of_view(&scene(), view, &registry, &settings).expect("there"));
    assert_eq!(Some(number("/all/flip")), measured(&shown[0], &shown[1]).all.of("flip"));

    // Two files: view A of each.
    let two = with(&["plain.json", "phong.json"]);
    assert_eq!(two["all"], own["all"]);
    assert_eq!(two["b"], json!({ "file": "phong.json", "view": "A", "name": scene().name }));
    // Another view, by letter or name.
    assert_eq!(with(&["all.json", "--with", "D"])["b"]["name"], "dark");
    assert_eq!(with(&["all.json", "--with", "dark"])["b"]["view"], "D");
    assert_eq!(with(&["all.json", "--with", "c"])["b"]["view"], "C");
    // Equal views.
    let equal = with(&["plain.json", "plain.json"]);
    let all = &equal["all"];
    assert_eq!(
        [&all["rmse"], &all["psnr"], &all["ssim"], &all["flip"]],
        [&json!(0.0), &Json::Null, &json!(1.0), &json!(0.0)]
    );
    assert_eq!(equal["largest"], Json::Null);
    // Light.
    let light = with(&["all.json", "--values", "light", "--channel", "green"]);
    assert_eq!((&light["values"], &light["channel"]), (&json!("light"), &json!("green")));
    assert!(light["largest"]["difference"].as_f64().is_some_and(|d| d.abs() < 2.0));
}

#[test]
fn the_command_compares_pictures() {
    let folder = folder();
    let two = run(folder.path(), &["compare", "grey.png", "white.png"]);
    assert_eq!((two.status, two.err.as_str()), (Some(0), ""));
    let two = numbers(&two);
    assert_eq!(two["a"], json!({ "file": "grey.png", "view": null, "name": null }));
    assert_eq!((&two["width"], &two["height"], &two["covered"]), (&json!(96), &json!(54), &Json::Null));
    assert!(two["all"]["rmse"].as_f64().is_some_and(|rmse| (rmse - 205.0 / 255.0).abs() < 1e-9));
    assert_eq!(two["all"]["light_rmse"], Json::Null);
    assert_eq!(
        two["largest"],
        json!({ "x": 0, "y": 0, "difference": 205.0, "a": [50, 50, 50], "b": [255, 255, 255] })
    );
    // A scene takes the size of the picture.
    let mixed = run(folder.path(), &["compare", "plain.json", "grey.png"]);
    assert_eq!(mixed.status, Some(0), "{}", mixed.err);
    assert!(numbers(&mixed)["covered"]["pixels"].as_u64().is_some_and(|pixels| pixels > 100));
    // Side by side, pictures keep their size.
    let beside = run(folder.path(), &["compare", "grey.png", "white.png", "-o", "beside.png", "-q"]);
    assert_eq!((beside.status, beside.err.as_str()), (Some(0), ""));
    let (width, height, codes) = read_png(&folder.path().join("beside.png")).expect("a picture");
    assert_eq!((width, height), (194, 54));
    assert_eq!((codes[3 * 90], codes[3 * 96], codes[3 * 193]), (50, 22, 255));
}

/// Asserts that two pictures with a width of 160 pixels are equal.
fn same(found: &[u8], expected: &[u8], what: &str) {
    let off = found.iter().zip(expected).position(|(a, b)| a != b).map(|i| (i / 3 % 160, i / 480));
    assert_eq!((off, found.len()), (None, expected.len()), "{what}");
}

#[test]
fn the_command_draws_the_comparison() {
    let folder = folder();
    let drawn = |arguments: &[&str]| {
        let all: Vec<_> = arguments.iter().chain(&["--size", "160x90", "-o", "x.png"]).copied().collect();
        let run = run(folder.path(), &all);
        assert_eq!((run.status, run.err.as_str()), (Some(0), "wrote x.png\n"), "{arguments:?}");
        read_png(&folder.path().join("x.png")).expect("a picture").2
    };
    let scene = scene();
    let layout = |layout| Comparison { layout, ..Comparison::default() };
    for id in ["single", "side_by_side", "wipe", "difference", "blink"] {
        let expected = composed(&scene, &layout(Layout::from_id(id).expect("known")), [160, 90]);
        same(&drawn(&["compare", "all.json", "--layout", id]), &expected, id);
        same(&drawn(&["render", "all.json", "--renderer", "cpu", "--layout", id]), &expected, id);
    }
    // The picture contains the comparison, and opens as it.
    let wiped = drawn(&["compare", "all.json", "--layout", "wipe", "--with", "dark"]);
    fs::rename(folder.path().join("x.png"), folder.path().join("wiped.png")).expect("writable");
    same(&drawn(&["render", "wiped.png", "--renderer", "cpu"]), &wiped, "opened again");
    // The GPU uses the same arrangement.
    for id in ["single", "side_by_side", "wipe", "difference", "blink"] {
        drawn(&["render", "all.json", "--renderer", "cpu", "--layout", id]);
        fs::rename(folder.path().join("x.png"), folder.path().join("cpu.png")).expect("writable");
        drawn(&["render", "all.json", "--renderer", "gpu", "--layout", id]);
        let flip = |other: &str| {
            let run = run(folder.path(), &["compare", other, "x.png"]);
            numbers(&run)["all"]["flip"].as_f64().expect("a number")
        };
        let (same, other) = (flip("cpu.png"), flip("wiped.png"));
        assert!(same < 0.005 && (id == "wipe" || other > 4.0 * same.max(0.001)), "{id}: {same} and {other}");
    }
    // Without a layout: that of the scene, or side by side.
    assert!(drawn(&["compare", "all.json"]) == drawn(&["compare", "all.json", "--layout", "side_by_side"]));
    assert!(drawn(&["compare", "one.json"]) == drawn(&["compare", "one.json", "--layout", "wipe"]));
    assert!(drawn(&["render", "one.json", "--renderer", "cpu"]) == drawn(&["compare", "one.json"]));
    // One view alone.
    let phong = drawn(&["render", "phong.json", "--renderer", "cpu"]);
    for view in ["B", "b", "Phong"] {
        assert!(drawn(&["render", "all.json", "--renderer", "cpu", "--view", view]) == phong, "{view}");
    }
    assert!(drawn(&["render", "all.json", "--renderer", "cpu", "--view", "A"]) != phong);
    // Every option changes the picture.
    let wipe = drawn(&["compare", "all.json", "--layout", "wipe"]);
    for option in [["--split", "0.8"], ["--edge", "horizontal"], ["--with", "dark"]] {
        let other = drawn(&[&["compare", "all.json", "--layout", "wipe"][..], &option].concat());
        assert!(other != wipe, "{option:?}");
    }
    let map = drawn(&["compare", "all.json", "--layout", "difference"]);
    for option in [
        ["--sign", "signed"],
        ["--channel", "blue"],
        ["--values", "light"],
        ["--amplification", "30"],
        ["--with", "D"],
    ] {
        let other = drawn(&[&["compare", "all.json", "--layout", "difference"][..], &option].concat());
        assert!(other != map, "{option:?}");
    }
}

#[test]
fn a_picture_of_one_view_opens_as_that_view() {
    let folder = folder();
    let arguments =
        ["render", "all.json", "--renderer", "cpu", "--size", "96x54", "-o", "b.png", "--view", "B"];
    assert_eq!(run(folder.path(), &arguments).status, Some(0));
    let again = run(folder.path(), &["compare", "phong.json", "b.png"]);
    assert_eq!(numbers(&again)["all"]["rmse"], 0.0, "{}", again.err);
    let checked =
        run(folder.path(), &["render", "b.png", "--renderer", "cpu", "--size", "96x54", "-o", "c.png"]);
    assert_eq!(checked.status, Some(0), "{}", checked.err);
    let same = numbers(&run(folder.path(), &["compare", "b.png", "c.png"]));
    assert_eq!(same["all"]["rmse"], 0.0);
}

#[test]
fn limits_set_the_exit_status() {
    let folder = folder();
    let compare = |limits: &[&str]| {
        let all: Vec<_> = ["compare", "grey.png", "white.png"].iter().chain(limits).copied().collect();
        let run = run(folder.path(), &all);
        // The numbers are printed anyway.
        assert_eq!(numbers(&run)["width"], 96, "{limits:?}");
        (run.status, run.err)
    };
    let kept = ["--fail-above", "rmse=0.9", "--fail-above", "largest=205", "--fail-below", "psnr=1.5"];
    assert_eq!(compare(&kept), (Some(0), String::new()));
    let (status, said) =
        compare(&["--fail-above", "rmse=0.5", "--fail-above", "largest=204", "--fail-below", "ssim=0.99"]);
    assert_eq!(status, Some(1));
    let lines: Vec<_> = said.lines().collect();
    assert_eq!(lines.len(), 3, "{said}");
    assert!(lines[0].starts_with("rmse is 0.803") && lines[0].ends_with(", above the limit 0.5"), "{said}");
    assert_eq!(lines[1], "largest is 205, above the limit 204");
    assert!(lines[2].starts_with("ssim is ") && lines[2].ends_with(", below the limit 0.99"), "{said}");
    assert_eq!(compare(&["--fail-above", "flip=0.99"]).0, Some(0));
    assert_eq!(compare(&["--fail-above", "flip=0.1"]).0, Some(1));
    for limit in ["covered.rmse=1", "light_rmse=1"] {
        let (status, said) = compare(&["--fail-above", limit]);
        assert_eq!(status, Some(1));
        assert!(said.contains(" cannot be determined: "), "{said}");
    }
    let scenes = ["compare", "all.json", "--size", "96x54", "--fail-above", "covered.flip=0.00001"];
    let covered = run(folder.path(), &scenes);
    assert_eq!(covered.status, Some(1));
    assert!(covered.err.starts_with("covered.flip is "), "{}", covered.err);
}

#[test]
fn linear_pictures_are_compared_by_their_light() {
    let folder = folder();
    let draw = |scene: &str, file: &str| {
        let drawn = ["render", scene, "--renderer", "cpu", "--size", "96x54", "-o", file, "--view", "A"];
        let drawn = run(folder.path(), &drawn);
        assert_eq!(drawn.status, Some(0), "{}", drawn.err);
    };
    for (scene, file) in [
        ("all.json", "a.exr"),
        ("all.json", "a.hdr"),
        ("phong.json", "b.exr"),
        ("phong.json", "b.hdr"),
        ("all.json", "a.png"),
    ] {
        draw(scene, file);
    }
    let compared = |arguments: &[&str]| {
        let run = run(folder.path(), &[&["compare"], arguments].concat());
        assert_eq!(run.status, Some(0), "{arguments:?}: {}", run.err);
        numbers(&run)
    };
    // The numbers are those of the scenes' light.
    let scenes = compared(&["all.json", "phong.json", "--size", "96x54", "--values", "light"]);
    let files = compared(&["a.exr", "b.exr"]);
    let light = |numbers: &Json, of: &str| numbers[of]["light_rmse"].as_f64().expect("a number");
    assert!(light(&scenes, "all") > 1e-3);
    for of in ["all", "covered"] {
        assert_eq!(files[of]["light_rmse"], scenes[of]["light_rmse"], "{of}");
        assert_eq!(files[of]["pixels"], scenes[of]["pixels"], "{of}");
    }
    assert_eq!((&files["values"], &files["width"]), (&json!("light"), &json!(96)));
    assert_eq!(files["largest"]["difference"], scenes["largest"]["difference"]);
    let [a, b] = ["a", "b"].map(|side| {
        [0, 1, 2].map(|c| files["largest"][side][c].as_f64().expect("the light there, not its codes"))
    });
    let most = (0..3).map(|c| (b[c] - a[c]).abs()).fold(0.0, f64::max);
    let difference = files["largest"]["difference"].as_f64().expect("a number").abs();
    assert!((most / difference - 1.0).abs() < 1e-3, "{a:?} {b:?} {difference}");
    // There are no display codes.
    for metric in ["rmse", "psnr", "ssim", "flip"] {
        assert_eq!(files["all"][metric], Json::Null, "{metric}");
    }
    assert!(scenes["all"]["rmse"].as_f64() > Some(0.0));
    // A scene against its own light, and formats against each other.
    assert_eq!(light(&compared(&["all.json", "a.exr"]), "all"), 0.0);
    assert_eq!(compared(&["all.json", "a.exr"])["largest"], Json::Null);
    let step = light(&compared(&["a.exr", "a.hdr"]), "all");
    assert!(step > 0.0 && step < 0.01, "{step}");
    let radiance = compared(&["a.hdr", "b.hdr"]);
    assert_eq!(radiance["covered"], Json::Null, "Radiance has no coverage");
    assert!((light(&radiance, "all") / light(&files, "all") - 1.0).abs() < 0.1);
    // Limits and pictures.
    let limited = |limit: &str| run(folder.path(), &["compare", "a.exr", "b.exr", "--fail-above", limit]);
    assert_eq!(limited("light_rmse=1000").status, Some(0));
    let broken = limited("covered.light_rmse=1e-6");
    assert!(broken.status == Some(1) && broken.err.starts_with("covered.light_rmse is "), "{}", broken.err);
    assert!(limited("largest=1e-6").err.starts_with("largest is "));
    for layout in ["difference", "side_by_side", "wipe"] {
        let drawn = compared(&["a.exr", "b.exr", "--layout", layout, "-o", "map.png"]);
        assert_eq!(drawn["values"], "light");
        assert!(read_png(&folder.path().join("map.png")).is_ok(), "{layout}");
    }
    for (arguments, status, expected) in [
        (
            &["a.exr", "a.png"][..],
            1,
            "a.exr and a.png: linear light and display codes cannot be compared; give two linear pictures, or two PNG",
        ),
        (&["a.png", "a.hdr"], 1, "a.hdr and a.png: linear light and display codes cannot be compared"),
        (
            &["a.exr", "b.exr", "--values", "codes"],
            2,
            "--values codes compares display codes, but a.exr holds",
        ),
        (
            &["a.exr", "b.exr", "--fail-above", "flip=0.1"],
            2,
            "flip compares display codes, but a.exr holds linear",
        ),
        (
            &["a.exr", "b.exr", "--fail-below", "psnr=30"],
            2,
            "limits can be on light_rmse, covered.light_rmse and",
        ),
        (&["a.exr"], 2, "a.exr is a picture; name another file to compare it with"),
        (&["a.exr", "b.exr", "--size", "20x10"], 1, "pictures must have the same size"),
        (&["a.exr", "b.exr", "-o", "x.exr"], 2, "only PNG files can be written; did you mean x.png?"),
    ] {
        let run = run(folder.path(), &[&["compare"], arguments].concat());
        assert!(run.status == Some(status) && run.err.contains(expected), "{arguments:?}: {}", run.err);
        check_wording(&run.err);
    }
}

#[test]
fn linear_pictures_that_are_wrong_are_refused() {
    let folder = folder();
    let mut channels = Channels::new(4, 2);
    let mut pixels = vec![Vec4::ONE; 8];
    channels.add("", &["R", "G", "B"], &pixels);
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("written");
    let whole = channels.encode(Format::Exr, &Notes::default()).expect("written");
    put("good.exr", &whole);
    put("short.exr", &whole[..whole.len() - 3]);
    ["nothing.exr", "nothing.hdr", "nothing.png"].iter().for_each(|name| put(name, b""));
    put("not_a.exr", b"{}");
    put("not_a.hdr", b"{}");
    put("huge.hdr", b"#?RADIANCE\n\n-Y 16384 +X 16384\naaaa");
    let mut header = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x08\x02\0\0\0".to_vec();
    header.extend(b"\x26\xaa\x87\xd3\0\0\0\x09IDATnothing__CRC!");
    put("huge.png", &header);
    put("wide.hdr", b"#?RADIANCE\n\n-Y 1 +X 20000\naaaa");
    put("empty.hdr", b"#?RADIANCE\n\n-Y 8192 +X 8192\naaaa");
    put("endless.hdr", &[b"#?RADIANCE\n".to_vec(), b"# a\n".repeat(1 << 20)].concat());
    pixels[5].y = f32::NAN;
    let mut odd = Channels::new(4, 2);
    odd.add("", &["R", "G", "B"], &pixels);
    put("odd.exr", &odd.encode(Format::Exr, &Notes::default()).expect("written"));
    let mut depth = Channels::new(4, 2);
    depth.add("depth", &["Z"], &pixels);
    put("depth.exr", &depth.encode(Format::Exr, &Notes::default()).expect("written"));
    for (name, expected) in [
        (
            "short.exr",
            "short.exr: the OpenEXR picture is damaged: it ends too early; copy it again from its source",
        ),
        (
            "not_a.exr",
            "not_a.exr: it does not begin like a Radiance picture (#?RADIANCE) or an OpenEXR picture",
        ),
        ("not_a.hdr", "not_a.hdr: it does not begin like a Radiance picture"),
        (
            "huge.hdr",
            "huge.hdr: the picture has 16384×16384 pixels, but each side must have 1 to 16384, and both",
        ),
        (
            "huge.png",
            "huge.png: the picture has 16384×16384 pixels, but each side must have 1 to 16384, and both",
        ),
        ("wide.hdr", "wide.hdr: the picture has 20000×1 pixels"),
        ("empty.hdr", "empty.hdr: the file ends before its last pixel"),
        ("endless.hdr", "endless.hdr: the header of a Radiance picture must end with an empty line"),
        ("odd.exr", "odd.exr: the pixel in column 2, row 2 has NaN; light must be finite"),
        ("depth.exr", "depth.exr: no layer has the channels R, G and B; the channels are depth.Z"),
        ("nothing.exr", "nothing.exr: the file is empty"),
        ("nothing.hdr", "nothing.hdr: the file is empty"),
        ("nothing.png", "nothing.png: the file is empty"),
        ("none.exr", "none.exr could not be read"),
    ] {
        let run = run(folder.path(), &["compare", "good.exr", name]);
        assert!(run.status == Some(1) && run.err.contains(expected), "{name}: {}", run.err);
    }
    // Without coverage, every pixel counts alike.
    let same = numbers(&run(folder.path(), &["compare", "good.exr", "good.exr"]));
    assert_eq!((&same["all"]["light_rmse"], &same["covered"]), (&json!(0.0), &Json::Null));
}

#[test]
fn the_command_says_what_is_wrong() {
    let folder = folder();
    let too_many = changed(|scene| scene["variants"] = json!([{}, {}, {}, {}]));
    fs::write(folder.path().join("many.json"), too_many).expect("written");
    fs::write(folder.path().join("full.json"), full_scene().to_string()).expect("written");
    for (arguments, status, expected) in [
        (&["compare"][..], 2, "required"),
        (&["compare", "-", "-"], 2, "- can be given only once"),
        (&["compare", "grey.png"], 2, "grey.png is a picture; name another file to compare it with"),
        (&["compare", "plain.json"], 1, "plain.json has no variants to compare with; add one, or name"),
        (
            &["compare", "all.json", "--with", "Pong"],
            1,
            "all.json: there is no view \"Pong\"; it must be A, B (Phong), C or D (dark); did you mean \"Phong\"?",
        ),
        (&["compare", "all.json", "--with", "A"], 2, "--with must be a view other than A"),
        (&["compare", "all.json", "plain.json", "--with", "B"], 2, "view A of each is compared; omit --with"),
        (&["compare", "nothing.json", "broken.json"], 1, "nothing.json: file not found"),
        (&["compare", "nothing.json", "broken.json"], 1, "broken.json:1:2: not JSON"),
        (&["compare", "many.json"], 1, "at most 3 variants"),
        (&["compare", "grey.png", "nothing.png"], 1, "nothing.png could not be read"),
        (
            &["compare", "grey.png", "not_a.png"],
            1,
            "not_a.png: this is not a PNG picture, though its name ends in .png",
        ),
        (
            &["compare", "grey.png", "small.png"],
            1,
            "grey.png is 96x54 pixels, but small.png is 20x10; pictures must have the same size",
        ),
        (
            &["compare", "plain.json", "grey.png", "--size", "20x10"],
            1,
            "--size is 20x10 pixels, but grey.png is 96x54; pictures must have the same size",
        ),
        (
            &["compare", "plain.json", "grey.png", "--values", "light"],
            1,
            "grey.png: the linear light of a picture file is unknown; --values codes compares the display codes",
        ),
        (&["compare", "all.json", "--layout", "sideways"], 2, "the layout must be"),
        (&["compare", "all.json", "--layout", "diference"], 2, "did you mean \"difference\"?"),
        (&["compare", "all.json", "--sign", "plus"], 2, "the sign of a difference must be"),
        (&["compare", "all.json", "--channel", "alpha"], 2, "the channel of a difference must be"),
        (&["compare", "all.json", "--values", "x"], 2, "the values of a difference must be"),
        (&["compare", "all.json", "--edge", "x"], 2, "the edge of a wipe must be"),
        (&["compare", "all.json", "--amplification", "0"], 2, "the amplification must be between 1 and 100"),
        (
            &["compare", "all.json", "--amplification", "much"],
            2,
            "the amplification must be between 1 and 100",
        ),
        (&["compare", "all.json", "--split", "2"], 2, "the place of the edge must be between 0 and 1"),
        (&["compare", "all.json", "--fail-above", "rms=1"], 2, "did you mean rmse?"),
        (&["compare", "all.json", "--fail-below", "rmse=1"], 2, "use --fail-above rmse=1"),
        (
            &["compare", "all.json", "--size", "3x3", "-o", "x.png"],
            2,
            "are too few for the views side by side",
        ),
        (&["compare", "all.json", "-o", "x.jpg"], 2, "only PNG files can be written; did you mean x.png?"),
        (&["compare", "all.json", "-o", "folder"], 2, "-o folder: name a PNG file"),
        (&["compare", "all.json", "-o", "/dev/stdout"], 2, "standard output is for the numbers"),
        (&["compare", "grey.png", "white.png", "-o", "grey.png"], 4, "grey.png"),
        (
            &["render", "plain.json", "--layout", "wipe"],
            1,
            "plain.json: the scene has no variants for --layout wipe",
        ),
        (
            &["render", "all.json", "--view", "E"],
            1,
            "all.json: there is no view \"E\"; it must be A, B (Phong), C or D",
        ),
        (&["render", "plain.json", "--view", "B"], 1, "plain.json: there is no view \"B\"; it must be A"),
        (&["render", "all.json", "--view", "B", "--layout", "wipe"], 2, "cannot be used with"),
        (&["render", "all.json", "--size", "3x3"], 0, ""),
        (
            &["render", "all.json", "--size", "3x3", "--layout", "side_by_side"],
            2,
            "is too small for the views",
        ),
    ] {
        let run = lcm_in(folder.path(), arguments, b"");
        assert_eq!(run.status, Some(status), "{arguments:?}: {}", run.err);
        assert!(run.err.contains(expected), "{arguments:?}: {}\nnot: {expected}", run.err);
        assert_eq!(run.out, "", "{arguments:?}");
    }
    // Damaged pictures: cut off, and with a changed byte in the checksum of their pixels.
    let bytes = fs::read(folder.path().join("grey.png")).expect("there");
    let pixels = bytes.windows(4).position(|kind| kind == b"IDAT").expect("a picture");
    let length = u32::from_be_bytes(*bytes[pixels - 4..].first_chunk().expect("four")) as usize;
    let mut changed = bytes.clone();
    changed[pixels + 4 + length] ^= 1;
    for (bytes, expected) in [
        (&bytes[..pixels + 4 + length / 2], "it ends too early; copy it again from its source"),
        (&changed, "a checksum is wrong, so some of its bytes were changed; copy it again"),
    ] {
        fs::write(folder.path().join("half.png"), bytes).expect("written");
        let half = run(folder.path(), &["compare", "grey.png", "half.png"]);
        assert_eq!(half.status, Some(1));
        assert!(half.err.starts_with("half.png: the picture is damaged: "), "{}", half.err);
        assert!(half.err.contains(expected) && !half.err.contains("ChunkType"), "{}", half.err);
    }
}

/// A part of a PNG file with its checksum.
fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let checked = [&kind[..], content].concat();
    let mut crc = Crc::new();
    crc.update(&checked);
    [&(content.len() as u32).to_be_bytes()[..], &checked, &crc.sum().to_be_bytes()].concat()
}

#[test]
fn the_damage_of_a_picture_is_told_in_plain_words() {
    let folder = folder();
    let whole = fs::read(folder.path().join("grey.png")).expect("there");
    let pixels = whole.windows(4).position(|kind| kind == b"IDAT").expect("a picture");
    let flipped = |at: usize, bits: u8| {
        let mut bytes = whole.clone();
        bytes[at] ^= bits;
        bytes
    };
    // One grey pixel; the first byte of its row is the filter.
    let made = |kind: &[u8; 4], header: [u8; 13], row: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(row).expect("in memory");
        let packed = encoder.finish().expect("in memory");
        let begins = b"\x89PNG\r\n\x1a\n".to_vec();
        [begins, chunk(b"IHDR", &header), chunk(kind, &packed), chunk(b"IEND", &[])].concat()
    };
    let header = |depth: u8, colours: u8| [0, 0, 0, 1, 0, 0, 0, 1, depth, colours, 0, 0, 0];
    for (bytes, expected) in [
        (flipped(12, 0x20), "its first part is not a header"),
        // The method of compression, before any checksum.
        (flipped(pixels + 4, 0x0f), "its compressed data cannot be read"),
        (made(b"IDAT", header(8, 0), &[255, 0]), "its pixels have a filter that PNG does not define"),
        (made(b"IDAT", header(8, 0), &[0]), "it has fewer pixels than its header says"),
        (made(b"IDAT", header(8, 3), &[0, 0]), "it has no palette for its colours"),
        (made(b"IDAT", header(7, 0), &[0, 0]), "its header is wrong"),
        (made(b"tEXt", header(8, 0), &[0, 0]), "it has no pixels"),
        // A chunk that readers must know.
        (made(b"XDAT", header(8, 0), &[0, 0]), "one of its parts is not valid"),
    ] {
        fs::write(folder.path().join("half.png"), bytes).expect("written");
        let half = run(folder.path(), &["compare", "grey.png", "half.png"]);
        let expected =
            format!("half.png: the picture is damaged: {expected}; copy it again from its source\n");
        assert_eq!((half.status, half.err), (Some(1), expected));
    }
    // Whatever is flipped, the decoder's own messages do not reach people.
    for at in (8..whole.len()).step_by(7) {
        fs::write(folder.path().join("half.png"), flipped(at, 0x41)).expect("written");
        let half = run(folder.path(), &["compare", "grey.png", "half.png"]);
        assert!(matches!(half.status, Some(0 | 1)), "{at}: {}", half.err);
        for theirs in ["Type", "{", "chunk", "Invalid", "Unknown", "stream", "IDAT", "IHDR"] {
            assert!(!half.err.contains(theirs), "{at}: {}", half.err);
        }
    }
}
