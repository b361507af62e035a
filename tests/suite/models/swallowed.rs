//! Errors that swallow the following text in the composed shader are reported in their own file, by every
//! command.

use std::{fs, path::Path};

use crate::helpers::support::{Run, lcm_in, root};

/// A custom model with text after its declaration, and text at its end.
fn model(before: &str, body: &str, behind: &str) -> String {
    format!(
        "/* lcm\n{{ \"name\": \"Mine\", \"parameters\": [\"base_colour\"] }}\n*/\n{before}\
         fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    \
         let cos_l = max(dot(frame.n, l), 0.0);\n    {body}\n}}\n{behind}"
    )
}

const RIGHT: &str = "return Terms(vec3(0.0), m.base_colour * cos_l, vec3(0.0));";

fn run(at: &Path, command: &str) -> Run {
    lcm_in(at, &command.split(' ').collect::<Vec<_>>(), b"")
}

#[test]
fn a_custom_model_is_told_of_with_its_own_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    fs::create_dir(at.join("models")).expect("writable");
    let bare = RIGHT.trim_end_matches(");");
    for (text, place, said) in [
        (model("/* hidden\n", RIGHT, ""), "mine.wgsl:4:1", "the comment is not closed; its */ is missing"),
        (model("", RIGHT, "\n  /* open\n"), "mine.wgsl:9:3", "the comment is not closed"),
        (model("", "{", ""), "mine.wgsl:6:5", "this { is not closed; its } is missing"),
        (model("", bare, ""), "mine.wgsl:6:17", "this ( is not closed; its ) is missing"),
        (model("", RIGHT, "const half = 0.5\n"), "mine.wgsl:8:14", "a ; is missing"),
        (
            model("", &RIGHT.replace("base_colour", "base_color"), ""),
            "mine.wgsl:6:31",
            "no parameter base_color; did you mean base_colour?",
        ),
    ] {
        fs::write(at.join("models/mine.wgsl"), &text).expect("writable");
        for command in ["models check mine", "render --reflection mine --size 16x16 -o x.png"] {
            let run = run(at, &format!("{command} --models models"));
            assert!(run.status.is_some_and(|s| s != 0), "{command}: {text}");
            assert!(run.err.contains(place) && run.err.contains(said), "{command}: {text}\n{}", run.err);
        }
    }
}

#[test]
fn a_shared_file_and_a_built_in_one_are_told_of_with_their_own_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    assert_eq!(run(at, "assets export a").status, Some(0));
    let mine = model("#import \"shared.wgsl\"\n", RIGHT, "");
    fs::write(at.join("a/models/mine.wgsl"), mine).expect("writable");
    let shared = |text: &str| fs::write(at.join("a/models/shared.wgsl"), text).expect("writable");
    for (text, place, said) in [
        ("fn half() -> f32 { return 0.5; }\n/* open\n", "shared.wgsl:2:1", "the comment is not closed"),
        ("// ok\nfn half() -> f32 { return (0.5; }\n", "shared.wgsl:2:27", "this ( is not closed"),
        ("fn half() -> f32 {\n    return 0.5;\n", "shared.wgsl:1:18", "this { is not closed"),
    ] {
        shared(text);
        for command in ["models check mine", "render --reflection mine --size 16x16 -o x.png"] {
            let run = run(at, &format!("{command} --assets a"));
            assert!(run.status.is_some_and(|s| s != 0), "{command}: {text}");
            assert!(run.err.contains(place) && run.err.contains(said), "{command}: {text}\n{}", run.err);
        }
    }
    shared("fn half() -> f32 { return 0.5; }\n");
    assert_eq!(run(at, "render --reflection mine --size 16x16 -o x.png --assets a").status, Some(0));

    let text = fs::read_to_string(root().join("assets/shaders/loop.wgsl")).expect("there");
    let lines = text.lines().count();
    fs::write(at.join("a/shaders/loop.wgsl"), format!("{text}/* open\n")).expect("writable");
    let run = run(at, "render --renderer gpu --size 16x16 -o x.png --assets a");
    let place = format!("loop.wgsl:{}:1", lines + 1);
    assert!(run.err.contains(&place) && run.err.contains("not closed"), "{}", run.err);
    assert!(run.status.is_some_and(|s| s != 0));
}
