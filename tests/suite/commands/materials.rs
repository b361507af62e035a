//! `lcm materials`: the list, JSON, the sheet, and broken files, which hide no others.

use std::{fs, path::Path};

use serde_json::Value;

use crate::{
    helpers::support::{Run, lcm_in, names},
    renderers::golden::read_png,
};

const OWN: &str = r#"{"name": "Mira's velvet", "description": "Dark red.", "reflection_model": "phong", "material": {"alpha": 7}}"#;

/// A folder whose custom models are in `models`, and materials beside them.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["models", "materials"] {
        fs::create_dir(folder.path().join(name)).expect("made");
    }
    fs::write(folder.path().join("materials/velvet.json"), OWN).expect("written");
    folder
}

fn materials(folder: &Path, arguments: &[&str]) -> Run {
    lcm_in(folder, &[&["materials", "--models", "models"], arguments].concat(), b"")
}

#[test]
fn the_list_has_names_models_and_values() {
    let folder = folder();
    let run = materials(folder.path(), &[]);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    for part in [
        "Your materials",
        "Mira's velvet",
        "phong: alpha 7",
        "Presets",
        "Car paint",
        "Measured materials",
        "Gold",
    ] {
        assert!(run.out.contains(part), "{part}: {}", run.out);
    }
    assert_eq!(run.err, "");
    let run = materials(folder.path(), &["gold johnson", "--json"]);
    let found: Value = serde_json::from_str(&run.out).expect("JSON");
    let [gold] = found.as_array().expect("a list").as_slice() else { panic!("{found}") };
    assert_eq!((&gold["name"], &gold["kind"]), (&"Gold".into(), &"measured".into()));
    assert_eq!(gold["reflection_model"], "microfacet");
    assert!(gold["material"]["ior"].is_array() && gold["material"]["alpha_x"].is_number(), "{gold}");
    let run = materials(folder.path(), &["no", "such words"]);
    assert_eq!(run.status, Some(2));
    assert!(run.err.contains("no material has the words \"no such words\""), "{}", run.err);
}

#[test]
fn names_and_descriptions_forge_no_lines() {
    let folder = folder();
    let odd = r#"{"name": "Mira\u001b[31m\nerror: a", "description": "Dark\nerror: b", "reflection_model": "lambert", "material": {}}"#;
    fs::write(folder.path().join("materials/odd.json"), odd).expect("written");
    let run = materials(folder.path(), &["error"]);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let lines: Vec<_> = run.out.lines().collect();
    assert!(lines[1].starts_with(r"  Mira\u{1b}[31m\nerror: a  lambert"), "{}", run.out);
    assert!(lines[1..].iter().all(|line| line.starts_with("  ")), "{}", run.out);
}

#[test]
fn a_broken_file_is_named_and_hides_no_other() {
    let folder = folder();
    let at = |name: &str| folder.path().join("materials").join(name);
    fs::write(at("a.json"), OWN.replace("\"alpha\"", "\"alhpa\"")).expect("written");
    fs::write(at("b.json"), vec![b'['; 10 << 20]).expect("written");
    fs::write(at("c.json"), OWN.replace("phong", "velour")).expect("written");
    let run = materials(folder.path(), &["mira"]);
    assert_eq!(run.status, Some(1));
    assert!(run.out.contains("Mira's velvet"), "{}", run.out);
    let lines: Vec<_> = run.err.lines().collect();
    for (line, expected) in lines.iter().zip([
        "a.json:1:97: material.alhpa is not a key of the material of this model; did you mean \"alpha\"?",
        "b.json: the file is larger than 64 KiB",
        "c.json:1:75: reflection_model is \"velour\", but the reflection model must be",
    ]) {
        assert!(line.contains(expected), "{line:?} should contain {expected:?}");
    }
    assert_eq!(lines.len(), 3, "{}", run.err);
}

#[test]
fn the_sheet_has_a_picture_for_each_and_replaces_no_other_file() {
    let folder = folder();
    let drawn = |words: &str, output: &str| materials(folder.path(), &[words, "-o", output, "--size", "32"]);
    let run = drawn("mira", "one.png");
    assert_eq!((run.status, run.out.as_str(), run.err.trim()), (Some(0), "", "wrote one.png: 1 material"));
    let run = drawn("gold", "gold.png");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let size = |name: &str| {
        let (width, height, _) = read_png(&folder.path().join(name)).expect("a picture");
        [width, height]
    };
    let ([one, high], [two, _]) = (size("one.png"), size("gold.png"));
    assert!(two >= one + 32 && high > 32, "{one} {two} {high}");
    let again = drawn("gold", "again.png");
    assert_eq!(again.status, Some(0));
    let bytes = |name: &str| fs::read(folder.path().join(name)).expect("there");
    assert!(bytes("gold.png") == bytes("again.png") && bytes("gold.png") != bytes("one.png"));
    let before = bytes("materials/velvet.json");
    assert_eq!(drawn("mira", "materials/velvet.json").status, Some(4));
    for size in ["x", "15", "1025", "-1", "16.5", ""] {
        let run = materials(folder.path(), &["mira", "-o", "x.png", &format!("--size={size}")]);
        assert!(
            run.status == Some(2) && run.err.contains("it must be a whole number of pixels from 16 to 1024"),
            "{}",
            run.err
        );
    }
    assert_eq!(bytes("materials/velvet.json"), before);
    assert_eq!(names(&folder.path().join("materials")), ["velvet.json"]);
}
