//! The choice of the editor in which a file is opened.

use std::{
    fs,
    path::{Path, PathBuf},
};

use lights_camera_models::window::editor::{Application, Surroundings};

/// A folder with programs with these names.
fn programs(names: &[&str]) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().expect("a folder");
    for name in names {
        fs::write(folder.path().join(name), "").expect("writable");
    }
    let path = vec![folder.path().to_owned()];
    (folder, path)
}

/// The command for line 12 of a file, in words.
fn command(surroundings: &Surroundings) -> Option<String> {
    let (program, arguments) = surroundings.editor(Path::new("/m/x.wgsl"), 12)?;
    Some([vec![program], arguments].concat().join(" "))
}

#[cfg(not(target_os = "macos"))]
#[test]
fn an_editor_with_a_window_comes_before_one_in_a_terminal() {
    let application = |exec: &str, terminal| Some(Application { exec: exec.to_owned(), terminal });
    let (_folder, path) = programs(&["vim", "nano", "gedit", "code", "notes", "xterm"]);
    let all = Surroundings {
        named: Some("ed {file}".to_owned()),
        usual: vec!["vim".to_owned()],
        default: application("notes --new %U", false),
        path: path.clone(),
    };
    assert_eq!(command(&all).as_deref(), Some("ed /m/x.wgsl"), "the one that is named");
    let all = Surroundings { named: None, ..all };
    assert_eq!(command(&all).as_deref(), Some("notes --new /m/x.wgsl"), "that of the desktop");
    for (exec, expected) in [
        ("gedit %U", "gedit +12 /m/x.wgsl"),
        ("\"code\" --unity-launch %F", "code --goto /m/x.wgsl:12"),
        ("notes", "notes /m/x.wgsl"),
        ("notes %i -c %c %f", "notes -c /m/x.wgsl"),
    ] {
        let other = Surroundings { default: application(exec, false), ..all.clone() };
        assert_eq!(command(&other).as_deref(), Some(expected), "{exec}");
    }
    let in_terminal = Surroundings { default: application("vim %F", true), ..all.clone() };
    assert_eq!(command(&in_terminal).as_deref(), Some("code --goto /m/x.wgsl:12"), "a known one");
    let gone = Surroundings { default: application("gone %F", false), ..all.clone() };
    assert_eq!(command(&gone).as_deref(), Some("code --goto /m/x.wgsl:12"));
    let chosen = Surroundings { default: None, usual: vec!["gedit --wait".to_owned()], ..all };
    assert_eq!(command(&chosen).as_deref(), Some("gedit --wait +12 /m/x.wgsl"), "the user's, with a window");

    let (_folder, path) = programs(&["vim", "xterm"]);
    let bare = Surroundings { path: path.clone(), ..Surroundings::default() };
    assert_eq!(command(&bare), None, "nobody asked for vim");
    let asked = Surroundings { usual: vec!["gone".to_owned(), "vim -R".to_owned()], ..bare };
    assert_eq!(command(&asked).as_deref(), Some("xterm -e vim -R +12 /m/x.wgsl"), "in a window of its own");
    let (_folder, path) = programs(&["vim"]);
    assert_eq!(command(&Surroundings { path, ..asked }), None, "there is no terminal");
}

#[test]
fn desktop_entries_are_read() {
    let text = "[Other]\nExec=wrong\n[Desktop Entry]\nName=Vim\nExec = vim %F\nTerminal=true\n[Desktop Action new]\nExec=no\n";
    assert_eq!(Application::read(text), Some(Application { exec: "vim %F".to_owned(), terminal: true }));
    assert_eq!(Application::read("[Desktop Entry]\nName=x\n"), None);
    assert_eq!(Application::read(""), None);
}
