//! Files that packages install beside the program: shell completions, manual pages.

use std::fs;

use crate::helpers::support::{lcm, lcm_in, names};

/// The commands that the help lists.
fn commands() -> Vec<String> {
    let help = lcm(&["--help"], "").out;
    let list = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list");
    let named = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let all = named.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
    all.map(str::to_owned).collect()
}

#[test]
fn every_shell_completes_every_command() {
    let commands = commands();
    assert!(commands.len() > 15 && commands.iter().any(|name| name == "render"), "{commands:?}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = lcm(&["completions", shell], "");
        assert_eq!((script.status, script.err.as_str()), (Some(0), ""));
        for word in commands.iter().map(String::as_str).chain(["light-samples"]) {
            assert!(script.out.contains(word), "{shell}: {word}");
        }
        assert!(!script.out.contains("try-shaders"), "{shell} completes what is hidden");
    }
    let wrong = lcm(&["completions", "bahs"], "");
    assert!(wrong.status == Some(2) && wrong.err.contains("bash, elvish, fish"), "{}", wrong.err);
}

#[cfg(target_os = "linux")]
#[test]
fn bash_reads_the_completions() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("lcm"), lcm(&["completions", "bash"], "").out).expect("written");
    let typed =
        "source ./lcm; COMP_WORDS=(lcm ren); COMP_CWORD=1; _lcm lcm ren lcm; echo \"${COMPREPLY[*]}\"";
    let output = std::process::Command::new("bash").args(["-c", typed]).current_dir(folder.path()).output();
    let output = output.expect("bash starts");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "render\n", "{output:?}");
}

#[test]
fn every_command_has_a_manual_page_and_other_files_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = lcm_in(folder.path(), &["manual", "pages"], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let pages = names(&folder.path().join("pages"));
    assert_eq!(run.out.lines().count(), pages.len());
    assert!(run.err.starts_with(&format!("wrote {} pages", pages.len())), "{}", run.err);
    for page in commands().iter().map(|name| format!("lcm-{name}.1")).chain(["lcm-models-new.1".to_owned()]) {
        assert!(pages.contains(&page), "{page} is none of {pages:?}");
    }
    assert!(!pages.iter().any(|page| page.contains("help") || page.contains("try")), "{pages:?}");
    let read = |page: &str| fs::read_to_string(folder.path().join("pages").join(page)).expect("text");
    assert!(read("lcm.1").contains(".SH NAME\nlcm \\- A laboratory for the equations that light a surface"));
    assert!(
        read("lcm-render.1")
            .lines()
            .any(|line| line.starts_with(".TH lcm-render 1") && line.contains("0.1.0"))
    );
    assert!(read("lcm-render.1").contains("light\\-samples"), "{}", read("lcm-render.1"));
    // Once more: pages are replaced, other files are not.
    let again = lcm_in(folder.path(), &["manual", "pages", "--quiet"], b"");
    assert_eq!((again.status, again.err.as_str()), (Some(0), ""));
    fs::write(folder.path().join("pages/lcm-view.1"), "mine").expect("written");
    fs::remove_file(folder.path().join("pages/lcm.1")).expect("there");
    let refused = lcm_in(folder.path(), &["manual", "pages"], b"");
    assert_eq!(refused.status, Some(4), "{}", refused.err);
    assert!(refused.err.contains("lcm-view.1") && refused.err.contains("a manual page"), "{}", refused.err);
    assert_eq!(read("lcm-view.1"), "mine");
    assert!(!names(&folder.path().join("pages")).contains(&"lcm.1".to_owned()), "nothing half written");
}
