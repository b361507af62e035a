//! Saving: all or nothing, and never over somebody else's changes.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use lights_camera_models::{
    registry::Registry,
    scene::{
        Object, Scene,
        load::{self, Defaults, Stamp},
        save::{self, Expected, SaveError, Unwritten},
    },
};

use crate::helpers::support::{full_scene, names, read};

fn write(path: &Path, scene: &Scene, expected: Expected) -> Result<Stamp, SaveError> {
    save::write(path, scene, &Registry::builtin(), expected)
}

fn load(path: &Path) -> load::Loaded {
    load::file(path, &Registry::builtin(), Defaults::Refuse).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_new_file_is_written_and_an_existing_one_is_not_overwritten() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.json");
    let stamp = write(&file, &Scene::default(), Expected::Nothing).expect("written");
    assert_eq!(load(&file).scene, Scene::default());
    assert_eq!(load(&file).stamp, stamp);
    let error = write(&file, &Scene::default(), Expected::Nothing).expect_err("exists");
    assert_eq!(error.to_string(), format!("{} already exists; it was not overwritten", file.display()));
    assert_eq!(names(folder.path()), ["a.json"]);
}

#[test]
fn a_file_that_changed_on_disk_is_not_overwritten_unless_the_user_says_so() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.json");
    let stamp = write(&file, &Scene::default(), Expected::Nothing).expect("written");
    let stamp = write(&file, &Scene::default(), Expected::Unchanged(stamp)).expect("unchanged");
    let other = full_scene().to_string();
    fs::write(&file, &other).expect("written");
    let error = write(&file, &Scene::default(), Expected::Unchanged(stamp)).expect_err("changed");
    assert!(matches!(error, SaveError { why: Unwritten::Changed, .. }), "{error}");
    assert!(error.to_string().ends_with("changed on disk since it was read; it was not overwritten"));
    assert_eq!(fs::read_to_string(&file).expect("readable"), other);
    write(&file, &Scene::default(), Expected::Anything).expect("forced");
    assert_eq!(load(&file).scene, Scene::default());
    fs::remove_file(&file).expect("removed");
    let error = write(&file, &Scene::default(), Expected::Unchanged(stamp)).expect_err("gone");
    assert!(matches!(error, SaveError { why: Unwritten::Gone, .. }), "{error}");
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn what_cannot_be_written_says_why_and_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = folder.path();
    let said = |path: &Path, scene: &Scene| {
        write(path, scene, Expected::Anything).expect_err("cannot be written").to_string()
    };
    assert!(said(at, &Scene::default()).ends_with("is a folder; choose a file name"));
    #[cfg(target_os = "linux")]
    for place in ["/proc/a.json", "/proc/none/a.json"] {
        let why = said(Path::new(place), &Scene::default());
        let expected = "was not written: /proc is a folder of the system in which no files can be created";
        assert!(why.ends_with(expected), "{why}");
    }
    let mut invalid = Scene::default();
    invalid.objects[0].size = f32::NAN;
    let invalid = said(&at.join("new/a.json"), &invalid);
    assert!(invalid.contains("objects[0].size is NaN, but a size must be greater than 0"), "{invalid}");
    let protected = at.join("protected.json");
    fs::write(&protected, "old").expect("written");
    let mut permissions = fs::metadata(&protected).expect("there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&protected, permissions).expect("set");
    assert!(said(&protected, &Scene::default()).ends_with("is read-only; it was not overwritten"));
    assert_eq!(fs::read_to_string(&protected).expect("readable"), "old");
    assert_eq!(names(at), ["protected.json"]);
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_permissions_kept() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = folder.path();
    fs::create_dir(at.join("real")).expect("created");
    let real = at.join("real/a.json");
    write(&real, &Scene::default(), Expected::Nothing).expect("written");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("set");
    symlink("real/a.json", at.join("link.json")).expect("linked");
    symlink("link.json", at.join("link to link.json")).expect("linked");
    let scene = read(&full_scene().to_string());
    write(&at.join("link to link.json"), &scene, Expected::Anything).expect("written");
    assert!(fs::symlink_metadata(at.join("link.json")).expect("there").is_symlink());
    assert_eq!(load(&real).scene, scene);
    assert_eq!(fs::metadata(&real).expect("there").permissions().mode() & 0o777, 0o640);
    symlink("loop.json", at.join("loop.json")).expect("linked");
    let error = write(&at.join("loop.json"), &scene, Expected::Anything).expect_err("a loop");
    assert!(error.to_string().contains("too many links"), "{error}");
    symlink("real/new.json", at.join("dangling.json")).expect("linked");
    write(&at.join("dangling.json"), &scene, Expected::Nothing).expect("written");
    assert_eq!(load(&at.join("real/new.json")).scene, scene);
}

#[test]
fn the_reference_to_the_schema_is_kept_or_made_where_the_schema_is() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.json");
    write(&file, &Scene::default(), Expected::Nothing).expect("written");
    assert!(!fs::read_to_string(&file).expect("readable").contains("$schema"));
    let text =
        fs::read_to_string(&file).expect("readable").replacen('{', "{ \"$schema\": \"../my.json\",", 1);
    fs::write(&file, text).expect("written");
    write(&file, &Scene::default(), Expected::Anything).expect("written");
    assert!(fs::read_to_string(&file).expect("readable").contains("\"$schema\": \"../my.json\""));
    fs::write(folder.path().join("scene.schema.json"), "{}").expect("written");
    let file = folder.path().join("b.json");
    write(&file, &Scene::default(), Expected::Nothing).expect("written");
    assert!(fs::read_to_string(&file).expect("readable").contains("\"$schema\": \"./scene.schema.json\""));
}

/// The file written by the child process of the next test; only set there.
const LOOP_FILE: &str = "LCM_TEST_SAVE_LOOP";

/// Two scenes of very different lengths, so that half of one is not the other.
fn large(n: usize) -> Scene {
    Scene {
        objects: vec![Object { name: Some("x".repeat(200)), ..Object::default() }; n],
        ..Scene::default()
    }
}

/// Not a test by itself: saves forever, in a process that the next test kills.
#[test]
fn save_in_a_loop_if_asked_to() {
    let Some(file) = std::env::var_os(LOOP_FILE) else { return };
    let scenes = [large(1), large(500)];
    for scene in scenes.iter().cycle() {
        write(Path::new(&file), scene, Expected::Anything).expect("written");
    }
}

#[test]
fn a_process_killed_while_it_saves_leaves_a_valid_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.json");
    let scenes = [large(1), large(500)];
    write(&file, &scenes[0], Expected::Nothing).expect("written");
    let changed = || fs::metadata(&file).and_then(|about| about.modified()).ok();
    for round in 0..25 {
        let before = changed();
        let mut child = Command::new(std::env::current_exe().expect("this binary"))
            .args(["--exact", "scenes::saving::save_in_a_loop_if_asked_to", "--nocapture"])
            .env(LOOP_FILE, &file)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        // A busy machine takes a while to start it.
        let begin = Instant::now();
        while changed() == before && begin.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(2));
        }
        std::thread::sleep(Duration::from_millis(7 * round % 41));
        assert!(child.try_wait().expect("asked").is_none(), "it was still saving");
        child.kill().expect("killed");
        child.wait().expect("ended");
        let scene = load(&file).scene;
        assert!(scenes.contains(&scene), "round {round}");
    }
}
