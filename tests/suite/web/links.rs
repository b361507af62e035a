//! Links: scenes in the address, scenes of the site, steps of lessons.

use serde_json::json;

use super::laboratory::{ALT, CONTROL, Laboratory, RIGHT, SIZE};

#[test]
fn a_link_holds_the_edited_scene() {
    let Some(lab) = Laboratory::open() else { return };
    let plain = lab.link();
    lab.press(&['p']);
    lab.wait_for_unsaved(true);
    let link = lab.link();
    assert!(link.starts_with(&format!("{}#scene=1.", lab.site)) && link != plain, "{link}");
    lab.press(&[CONTROL, 'z']);
    lab.wait_for_unsaved(false);
    lab.visit_at(&link);
    assert_eq!(lab.title(), "Default scene – Lights, Camera, Models!");
    assert_eq!(lab.link(), link);
    // A part is missing.
    lab.load(&link[..link.len() - 20]);
    let said = "return document.getElementById('said').textContent";
    lab.browser.wait(said, |said| said.as_str().is_some_and(|said| said.contains("damaged")));
    assert_eq!(lab.browser.run("return document.getElementById('before').hidden"), false);
}

#[test]
fn an_address_opens_a_scene_of_the_site() {
    let Some(lab) = Laboratory::start(SIZE) else { return };
    lab.visit("?scene=scenes/half_lambert.json");
    assert!(lab.title().starts_with("Lambert and its wraps –"), "{}", lab.title());
    lab.load(&format!("{}?scene=scenes/none.json", lab.site));
    let said = "return document.getElementById('said').textContent";
    lab.browser.wait(said, |said| said.as_str().is_some_and(|said| said.contains("404")));
}

#[test]
fn an_address_opens_a_step_of_a_lesson_which_is_taken() {
    const LESSON: &str = "03_where_shading_is_computed";
    let Some(lab) = Laboratory::start(SIZE) else { return };
    lab.visit(&format!("?lesson={LESSON}&step=2"));
    assert!(lab.title().starts_with("Where shading is computed –"), "{}", lab.title());
    let link = lab.copied_by(|| lab.find("copy link step"));
    assert_eq!(link, format!("{}?lesson={LESSON}&step=2", lab.site));
    // The task: flat shading.
    lab.press(&['f']);
    let taken = |files: &serde_json::Value| -> serde_json::Value {
        let progress = files["/Data/lessons.json"].as_str().unwrap_or("null");
        let progress: serde_json::Value = serde_json::from_str(progress).expect("JSON");
        progress["lessons"][LESSON].clone()
    };
    lab.wait_for_files(|files| taken(files)["done"] == json!([1]));
    lab.press(&[ALT, RIGHT]);
    lab.wait_for_files(|files| taken(files)["step"] == 2);
}
