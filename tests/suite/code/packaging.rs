//! The files beside the program in a package say what the program is.

use std::{fs, process::Command};

use lights_camera_models::program;

use crate::helpers::{
    skipped::skip,
    support::{lcm, root},
};

fn text(path: &str) -> String {
    fs::read_to_string(root().join(path)).expect("text")
}

/// The value of a key in a file with a key per line.
fn value<'a>(file: &'a str, key: &str) -> &'a str {
    let line = file.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(['=', ':']));
    line.unwrap_or_else(|| panic!("no {key}")).trim()
}

#[test]
fn the_desktop_opens_the_file_type_of_scenes_with_the_program() {
    let entry = text("packaging/lights-camera-models.desktop");
    let types = text("packaging/lights-camera-models.xml");
    let scene =
        types.split("<mime-type type=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a type");
    assert!(value(&entry, "MimeType").split(';').any(|known| known == scene), "{scene}");
    assert!(
        types.contains("<glob pattern=\"*.lcm.json\"/>")
            && text("docs/installing.md").contains("`*.lcm.json`")
    );
    assert_eq!(value(&entry, "Exec"), "lcm view %f");
    assert!(lcm(&["view", "--help"], "").out.contains("[SCENE]"));
    // The icon of a running window is found by the name of the window.
    assert_eq!(value(&entry, "StartupWMClass"), program::LAB);
    assert!(text("src/window/plugins.rs").contains("name: Some(program::name().to_owned())"));
    let icon = format!("packaging/{}.svg", value(&entry, "Icon"));
    assert!(text(&icon).starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
}

#[test]
fn the_package_requires_the_libraries_that_the_scripts_install() {
    let control = text("packaging/control").replace(" (>= @GLIBC@)", "");
    let needs = text("scripts/lib/requirements.bash");
    let graphics = needs.split("look_for_graphics() {").nth(1).and_then(|rest| rest.split("\n}").next());
    let wanted: Vec<_> = graphics
        .expect("a function")
        .split("need ")
        .skip(1)
        .map(|rest| rest.split_whitespace().next().expect("a package"))
        .collect();
    assert!(wanted.len() > 4 && wanted.contains(&"libvulkan1"), "{wanted:?}");
    let named = [value(&control, "Depends"), value(&control, "Recommends")].join(", ");
    for package in wanted {
        assert!(named.split(", ").any(|one| one == package), "{package} is missing");
    }
    // scripts/dist fills them in.
    for key in ["Version", "Architecture", "Installed-Size"] {
        assert!(value(&control, key).starts_with('@') && value(&control, key).ends_with('@'), "{key}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn the_desktop_entry_is_valid() {
    let file = root().join("packaging/lights-camera-models.desktop");
    let Ok(said) = Command::new("desktop-file-validate").arg(file).output() else {
        skip("desktop-file-validate is not installed (apt install desktop-file-utils)");
        return;
    };
    assert!(said.status.success() && said.stdout.is_empty(), "{}", String::from_utf8_lossy(&said.stdout));
}
