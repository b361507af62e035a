//! Edits, what is kept of them, and custom models.

use super::laboratory::{BACKSPACE, CONTROL, ENTER, F8, Laboratory, SHIFT, SIZE, copies, list, text};

#[test]
fn the_laboratory_starts_and_an_edit_is_undone_and_kept_over_a_reload() {
    let Some(lab) = Laboratory::start(SIZE) else { return };
    // One that takes its time to leave.
    lab.visit("?scene=five_spheres");
    assert_eq!(lab.title(), "Five spheres – Lights, Camera, Models!");
    assert!(copies(&lab.files()).is_empty());
    let flat = |copy: &String| copy.contains("\"shading_model\": \"flat\"");
    lab.press(&['f']);
    lab.wait_for_unsaved(true);
    lab.wait_for_files(|files| copies(files).iter().any(flat));
    lab.press(&[CONTROL, 'z']);
    lab.wait_for_unsaved(false);
    lab.wait_for_files(|files| copies(files).is_empty());
    lab.press(&[CONTROL, 'y']);
    lab.wait_for_unsaved(true);
    lab.wait_for_files(|files| copies(files).iter().any(flat));
    // Another page in the same place is no other tab, and may have the copy.
    lab.browser.go(&format!("{}?scene=half_lambert", lab.site));
    lab.wait_for_picture();
    assert_eq!(lab.title(), "Lambert and its wraps – Lights, Camera, Models!");
    lab.press(&[ENTER]);
    lab.wait_for_title(|title| title.starts_with("Five spheres •"));
    lab.wait_for_files(|files| copies(files).iter().any(flat));
    lab.press(&[F8]);
    // A page that takes itself for one of two says so before this message.
    lab.link();
    let said = lab.messages();
    assert!(said.contains("Copied the link") && !said.contains("another tab"), "{said}");
}

#[test]
fn an_error_in_a_model_is_said_and_gone_when_it_is_mended() {
    const FILE: &str = "/Data/models/my_lambert.wgsl";
    let Some(lab) = Laboratory::open() else { return };
    lab.press(&[CONTROL, SHIFT, 'd']);
    lab.press(&[ENTER]);
    let files = lab.wait_for_files(|files| files[FILE].is_string());
    let good = text(&files[FILE]);
    assert!(good.starts_with("/* lcm"), "{good}");
    lab.wait_for_unsaved(true);
    lab.press(&[CONTROL, SHIFT, 'e']);
    lab.write("/");
    lab.press(&[CONTROL, 's']);
    lab.wait_for_files(|files| files[FILE] == format!("/{good}"));
    let told = |said: &'static str| {
        move |told: &serde_json::Value| list(told).iter().any(|line| text(line).contains(said))
    };
    lab.browser.wait("return seen.told", told("The picture shows the last good version of My lambert."));
    assert!(told("the declaration is missing")(&lab.seen("told")));
    assert!(!told("up to date again")(&lab.seen("told")));
    lab.press(&[BACKSPACE]);
    lab.press(&[CONTROL, 's']);
    lab.wait_for_files(|files| files[FILE] == good);
    lab.browser.wait("return seen.told", told("All shaders are up to date again."));
}

#[test]
fn a_lost_graphics_card_loses_no_work() {
    let Some(lab) = Laboratory::open() else { return };
    lab.press(&['f']);
    lab.wait_for_unsaved(true);
    lab.browser.run("seen.device.destroy()");
    lab.browser.wait("return document.getElementById('said').textContent", |said| {
        text(said).contains("The graphics card was lost") && text(said).contains("The unsaved work is kept")
    });
    lab.browser.run("document.getElementById('again').click()");
    // The old page has its canvas behind what it says; a new one has told nobody anything yet.
    lab.browser.wait("return !document.querySelector('.over')", |fresh| fresh == true);
    lab.wait_for_picture();
    lab.press(&[ENTER]);
    lab.wait_for_unsaved(true);
}

#[test]
fn what_the_browser_does_not_copy_is_not_said_to_be_copied() {
    let Some(lab) = Laboratory::open() else { return };
    lab.browser.run("seen.refused = 'the page is not in front'");
    lab.find("copy link scene");
    lab.press(&[F8]);
    lab.browser.run("seen.refused = null");
    let said = lab.messages();
    assert!(said.contains("Nothing was copied: the page is not in front."), "{said}");
    assert!(!said.contains("Copied the link"), "{said}");
    lab.link();
    let said = lab.messages();
    assert!(said.contains("Copied the link to this scene."), "{said}");
}

#[test]
fn a_second_visit_loads_no_program() {
    let Some(laboratory) = Laboratory::open() else { return };
    let kept = "return caches.match('lab.wasm').then((known) => known?.headers.get('Content-Type') ?? null)";
    laboratory.browser.wait(kept, |kind| kind == "application/wasm");
    let loaded =
        "return performance.getEntriesByType('resource').some(({ name }) => name.endsWith('lab.bin'))";
    assert_eq!(laboratory.browser.run(loaded), true, "the first one does");
    laboratory.visit("");
    assert_eq!(laboratory.browser.run(loaded), false);
}
