//! Pages on graphics drivers that are slow, and on those that give up.

#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde_json::json;

use super::pages::{difference, page, scene, set};
use crate::helpers::browser::Browser;

const WIDTH: u32 = 96;
const HEIGHT: u32 = 54;

/// A driver of which every step takes no time.
const FAST: &str = "performance.now = () => 0;";

/// A driver that takes 0.2 ms, by the clock of the page, for each pixel of a tile or, with Gouraud shading, for each corner of
/// a triangle. The points of its steps are in `steps`.
const SLOW: &str = "
window.steps = [];
let [clock, tile, corners] = [0, 0, 0];
performance.now = () => clock;
const before = (kind, name, note) => {
  const method = kind?.prototype[name];
  if (method) kind.prototype[name] = function (...given) {
    note(...given);
    return method.apply(this, given);
  };
};
const end = () => {
  const points = document.querySelector('input[value=gouraud]').checked ? corners : tile;
  steps.push(points);
  clock += 0.2 * points;
  [tile, corners] = [0, 0];
};
before(window.WebGL2RenderingContext, 'scissor', (x, y, w, h) => (tile = w * h));
before(window.WebGL2RenderingContext, 'drawElements', (kind, count) => (corners += count));
before(window.WebGL2RenderingContext, 'fenceSync', end);
before(window.GPURenderPassEncoder, 'setScissorRect', (x, y, w, h) => (tile = w * h));
before(window.GPURenderPassEncoder, 'drawIndexed', (count) => (corners += count));
before(window.GPUQueue, 'onSubmittedWorkDone', end);
";

/// The page of a sphere under four lamps with extent.
fn four_lamps(folder: &Path) -> PathBuf {
    let lamp = |kind: &str, x: f64| {
        let mut lamp = json!({ "type": kind, "position": [x, 8, 9], "intensity": 10, "visible": false });
        if kind != "sphere" {
            lamp["direction"] = json!([5.0 - x, -3, -4]);
        }
        lamp
    };
    let text = json!({
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "observer": { "position": [5, 5, 9.9], "direction": [0, 0, -1], "field_of_view": 60 },
        "reflection_model": "microfacet", "shading_model": "phong",
        "lights": [lamp("rectangle", 2.0), lamp("disc", 4.0), lamp("sphere", 6.0), lamp("cylinder", 8.0)],
        "objects": [{ "type": "sphere", "position": [5, 5, 5], "size": 4, "tessellation": 32 }]
    });
    let (file, page_file) = (folder.join("lamps.json"), folder.join("lamps.html"));
    fs::write(&file, text.to_string()).expect("written");
    fs::write(&page_file, page(&scene(&file)).expect("a page")).expect("written");
    page_file
}

/// A browser whose graphics driver is as a script makes it.
fn browser(driver: &str) -> Option<Browser> {
    let browser = Browser::start()?;
    browser.resize(WIDTH, HEIGHT);
    browser.run_first(driver);
    Some(browser)
}

fn fragment(renderer: &str) -> String {
    format!("renderer={renderer}&picture={WIDTH}x{HEIGHT}&samples=1")
}

/// The number of steps since the last call, and the points of the largest.
fn steps(browser: &Browser) -> (u64, u64) {
    let said = browser.run("return [steps.length, Math.max(...steps.splice(0))]");
    let number = |i: usize| said[i].as_u64().expect("a number");
    (number(0), number(1))
}

#[test]
fn a_slow_driver_has_short_steps_and_draws_the_same_picture() {
    let Some((fast, slow)) = browser(FAST).zip(browser(SLOW)) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = four_lamps(folder.path());
    for renderer in ["webgpu", "webgl"] {
        for of in [&fast, &slow] {
            of.open(&file, &fragment(renderer));
        }
        for shading in ["phong", "gouraud"] {
            for of in [&fast, &slow] {
                set(of, &format!("input[value={shading}]"), "");
            }
            let off = difference(&fast.look().0, &slow.look().0);
            assert!(off.mean == 0.0, "{renderer} {shading}: {off:?}");
            // A step takes 50 ms.
            let (count, most) = steps(&slow);
            println!("{renderer} {shading}: {count} steps of up to {most} points");
            assert!(count > 5 && (150..=250).contains(&most), "{renderer} {shading}: {count}, {most}");
        }
    }
}

/// Takes the graphics away from the page, as a system does when a step takes too long.
const LOSE: &str = "const canvas = document.querySelector('canvas');
    document.body.dataset.state = 'busy';
    canvas.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext();";

#[test]
fn a_driver_that_gave_up_has_shorter_steps() {
    let Some(browser) = browser(SLOW) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    browser.open(&four_lamps(folder.path()), &fragment("webgl"));
    let first = browser.look().0;
    let (_, before) = steps(&browser);
    browser.run(LOSE);
    browser.settle();
    assert_eq!(browser.run("return document.body.dataset.state"), "ready");
    let (_, most) = steps(&browser);
    assert!(most <= before / 2 + 1, "{most} after {before}");
    assert!(difference(&first, &browser.look().0).mean == 0.0);
}

#[test]
fn the_page_says_truly_why_there_is_no_picture() {
    let Some(browser) = browser("") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = four_lamps(folder.path());
    let said = || {
        browser.settle();
        let said = browser.run("return document.getElementById('failure').textContent");
        said.as_str().expect("a text").to_owned()
    };
    let refuse = "HTMLCanvasElement.prototype.getContext = () => null;";
    // A browser that did draw is not too old.
    browser.open(&file, &fragment("webgl"));
    browser.run(&format!("{LOSE} {refuse}"));
    let lost = said();
    assert!(lost.starts_with("The graphics driver gave up") && lost.contains("smaller"), "{lost}");
    assert!(!lost.contains("newer"), "{lost}");
    browser.run_first(refuse);
    // Another fragment alone would not load the page anew.
    browser.visit(folder.path().to_str().expect("Unicode"));
    browser.visit(&format!("{}#renderer=webgl", file.display()));
    let none = said();
    assert!(none.starts_with("This browser refuses WebGL 2") && !none.contains("newer"), "{none}");
    browser.run_first("delete window.WebGL2RenderingContext;");
    browser.visit(folder.path().to_str().expect("Unicode"));
    browser.visit(&format!("{}#renderer=webgl", file.display()));
    let none = said();
    assert!(none.starts_with("This browser has neither WebGPU nor WebGL 2"), "{none}");
}
