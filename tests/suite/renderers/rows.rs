//! The copies of a row are drawn as single objects are, by both renderers, and belong to a row as long as nothing
//! changes one of them alone.

use std::fs;

use bevy::prelude::*;
use lights_camera_models::{
    export::{FORMS, Progress, Request},
    reference::{self, Settings},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, SceneEntities},
        parts::SceneObject,
    },
    scene::{
        Object, Repetition, Scene,
        examples::EXAMPLES,
        load::{self, Defaults},
    },
};

use crate::helpers::support::{lcm_in, read, written};

/// The shipped row.
fn five() -> Scene {
    let example = EXAMPLES.iter().find(|example| example.file == "five_spheres.json").expect("it is shipped");
    read(example.text)
}

/// The scene with single objects in place of rows.
fn singles(scene: &Scene) -> Scene {
    let single = |object: &Object| Object { repeat: Repetition::None, ..object.clone() };
    Scene { objects: scene.objects.iter().map(single).collect(), ..scene.clone() }
}

#[test]
fn both_renderers_draw_a_row_as_the_same_scene_of_single_objects_bit_for_bit() {
    let (row, apart) = (five(), singles(&five()));
    assert_eq!(row.objects.len(), 5);
    // What a file of single objects gives.
    assert_eq!(read(&written(&apart)), apart);
    let registry = Registry::builtin();
    let settings = Settings { width: 96, height: 54, samples: 4, ..Settings::default() };
    let cpu =
        [&row, &apart].map(|scene| reference::render(scene, &registry, &settings).to_rgb8(&scene.display));
    assert!(cpu[0] == cpu[1], "the CPU draws them differently");
    assert!(cpu[0].iter().any(|v| *v > 150), "the row is lit");
    let gpu = [&row, &apart].map(|scene| {
        let mut renderer =
            GpuRenderer::new(96, 54, 1, Output::Display).expect("software Vulkan is installed");
        renderer.set_scene(scene.clone());
        renderer.settle().expect("the GPU draws");
        renderer.read_rgb8().expect("the picture can be read")
    });
    assert!(gpu[0] == gpu[1], "the GPU draws them differently");
}

#[test]
fn a_row_is_explained_and_compared_as_the_same_scene_of_single_objects() {
    let folder = tempfile::tempdir().expect("a folder");
    let registry = Registry::builtin();
    let put = |name: &str, scene: &Scene| {
        let file = folder.path().join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        fs::write(file, written(scene)).expect("written");
    };
    let matt = |scene: Scene| Scene { reflection_model: "lambert".to_owned(), ..scene };
    for (place, scene) in [("row", five()), ("singles", singles(&five()))] {
        put(&format!("{place}/a.json"), &scene);
        put(&format!("{place}/b.json"), &matt(scene));
    }
    let row =
        load::file(&folder.path().join("row/a.json"), &registry, Defaults::Refuse).expect("valid").scene;
    assert!(row.row(2).is_some_and(|row| row.count == 5));
    let of = |place: &str, arguments: &[&str]| {
        let run = lcm_in(&folder.path().join(place), arguments, b"");
        assert_eq!(run.status, Some(0), "{arguments:?}: {}", run.err);
        run.out
    };
    let both = |arguments: &[&str]| ["row", "singles"].map(|place| of(place, arguments));
    for form in [&[][..], &["--json"]] {
        let [row, apart] =
            both(&[&["explain", "a.json", "--at", "160,90", "--size", "320x180"], form].concat());
        // A copy of a row has a label, a single object none: nothing else differs.
        let is_label = |line: &&str| line.trim_start().trim_start_matches('"').starts_with("label");
        let [without, plain] =
            [&row, &apart].map(|text| text.lines().filter(|l| !is_label(l)).collect::<Vec<_>>());
        assert!(
            row.contains("ball 3") && row.contains("r 0.5") && !apart.contains("r 0.5"),
            "{row}\nand\n{apart}"
        );
        assert!(without == plain, "{row}\nnot\n{apart}");
    }
    let [row, apart] = both(&["compare", "a.json", "b.json", "--size", "160x90"]);
    assert!(row.contains("\"rmse\"") && row == apart, "{row}\nnot\n{apart}");
    let same = ["compare", "row/a.json", "singles/a.json", "--size", "160x90", "--fail-above", "rmse=0"];
    assert!(of("", &same).contains("\"rmse\": 0.0"));
}

#[test]
fn a_row_is_exported_as_the_same_scene_of_single_objects() {
    let registry = Registry::builtin();
    // Every form has a matt surface.
    let row = Scene { reflection_model: "lambert".to_owned(), ..five() };
    let apart = singles(&row);
    for form in FORMS.iter().filter(|form| form.id != "executable") {
        let [of_row, of_singles] = [&row, &apart].map(|scene| {
            let request =
                Request { scene, registry: &registry, stem: "room", size: (64, 36), object: 2, point: None };
            (form.make)(&request, &Progress::NONE).unwrap_or_else(|error| panic!("{}: {error}", form.id))
        });
        assert!(of_row.files == of_singles.files, "{} differs", form.id);
        let more: Vec<_> = of_row.notes.iter().filter(|note| !of_singles.notes.contains(note)).collect();
        assert!(more.iter().all(|note| note.contains("labels of rows")), "{}: {more:?}", form.id);
    }
}

#[test]
fn a_copy_that_a_system_changes_leaves_its_row() {
    let mut renderer = GpuRenderer::new(48, 27, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_scene(five());
    renderer.settle().expect("the GPU draws");
    let world = renderer.app().world_mut();
    let third = world.resource::<SceneEntities>().objects[2];
    assert!(world.get::<SceneObject>(third).is_some());
    world.get_mut::<Transform>(third).expect("it has a place").translation.y += 0.5;
    (0..3).for_each(|_| renderer.step());
    let scene = renderer.app().world().resource::<CurrentScene>().0.clone();
    assert_eq!(scene.objects[2].position.y, 5.5);
    assert_eq!(scene.objects[2].repeat, Repetition::None);
    assert!((0..5).all(|i| scene.row(i).is_none()), "a row needs all of its copies");
    assert_eq!(read(&written(&scene)), singles(&scene), "a file has what is seen");
}
