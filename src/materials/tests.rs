use std::fs;

use super::*;
use crate::parameter::Value;

fn registry() -> Registry {
    Registry::builtin()
}

fn velvet() -> Material {
    let mut material = Values::default();
    material.set("roughness", Value::Number(0.35));
    material.set("base_colour", Value::Colour([120, 10, 40]));
    Material {
        name: "Mira's velvet".to_owned(),
        description: Some("Dark red, \"soft\".".to_owned()),
        source: Some("Mira".to_owned()),
        reflection_model: "metallic_roughness".to_owned(),
        material,
        origin: Origin::Preset,
    }
}

#[test]
fn the_materials_of_the_program_are_legal_and_named_once() {
    let registry = registry();
    let all = built_in(&registry);
    assert_eq!(all.len(), looks().len() + preset::all().len());
    for (i, material) in all.iter().enumerate() {
        let model = registry.model(&material.reflection_model).expect("built in");
        assert!(!material.material.0.is_empty(), "{}", material.name);
        for (name, value) in &material.material.0 {
            let parameter = model.parameter(name).unwrap_or_else(|| panic!("{}: {name}", material.name));
            assert!(parameter.allows(value), "{}: {name} {value}", material.name);
        }
        assert!(!all[..i].iter().any(|other| other.name == material.name), "{}", material.name);
        let read = from_bytes(to_json(material, &registry).as_bytes(), &registry).expect(&material.name);
        assert_eq!((read.material, read.source), (material.material.clone(), material.source.clone()));
    }
}

#[test]
fn a_saved_material_is_read_back_and_nothing_is_overwritten() {
    let (registry, root) = (registry(), tempfile::tempdir().expect("a folder"));
    let folder = beside(&root.path().join("models"));
    assert_eq!(folder, root.path().join("materials"));
    let path = save(&velvet(), &folder, &registry).expect("saved");
    assert_eq!(path, folder.join("mira_s_velvet.json"));
    let library = Library::read(Some(&folder), &registry);
    assert_eq!(library.broken, []);
    assert_eq!(library.materials[0], Material { origin: Origin::File(path.clone()), ..velvet() });
    assert_eq!(library.materials.len(), 1 + built_in(&registry).len());
    let before = fs::read(&path).expect("there");
    let other = Material { description: None, ..velvet() };
    assert!(matches!(save(&other, &folder, &registry), Err(NotSaved::Taken(taken)) if taken == path));
    assert_eq!(fs::read(&path).expect("there"), before);
    for name in ["../out", "", "a/b", "é"] {
        let named = Material { name: name.to_owned(), ..velvet() };
        assert!(matches!(save(&named, &folder, &registry), Err(NotSaved::Name(_))), "{name}");
    }
    let unknown = Material { name: "New".to_owned(), reflection_model: "fong".to_owned(), ..velvet() };
    assert!(matches!(save(&unknown, &folder, &registry), Err(NotSaved::Model(_))));
    let long =
        Material { name: "Long".to_owned(), description: Some("a".repeat(MAX_BYTES as usize)), ..velvet() };
    assert!(matches!(save(&long, &folder, &registry), Err(NotSaved::TooLarge)));
    assert_eq!(fs::read_dir(&folder).expect("there").count(), 1);
}

/// What is said about a text.
fn said(bytes: &[u8]) -> String {
    from_bytes(bytes, &registry()).expect_err("a mistake").join("\n")
}

#[test]
fn each_mistake_is_told_with_its_place_and_key() {
    let good = r#"{"name": "A", "reflection_model": "phong", "material": {"alpha": 20}}"#;
    assert!(from_bytes(good.as_bytes(), &registry()).is_ok());
    for (old, new, expected) in [
        (r#""A""#, "7", "1:10: name is 7, but a material must have a name"),
        (r#""A""#, r#"" ""#, "1:10: name is \" \", but a material must have a name"),
        (r#""name": "A", "#, "", "1:1: name is missing; a material must have a name"),
        ("\"phong\"", "\"fong\"", "did you mean \"phong\"?"),
        ("\"phong\"", "[]", "reflection_model is [], but a material must name its reflection model"),
        ("{\"alpha\": 20}", "3", "material is 3, but the material of this model must be an object"),
        (r#", "material": {"alpha": 20}"#, "", "1:1: material is missing"),
        ("20", "\"20\"", "1:66: material.alpha is \"20\", but it must be a whole number, without quotes"),
        ("20", "-1", "material.alpha is -1, but the"),
        (
            "\"alpha\"",
            "\"alhpa\"",
            "material.alhpa is not a key of the material of this model; did you mean \"alpha\"?",
        ),
        ("\"alpha\"", "\"metallic\"", "material.metallic is not a key of the material of this model"),
        ("\"name\"", "\"nmae\"", "1:2: nmae is not a key of a material; did you mean \"name\"?"),
        (
            "{\"alpha\": 20}",
            "{\"alpha\": 20, \"alpha\": 3}",
            "material.alpha is given twice; first given at 1:57",
        ),
        ("20}}", "20}", "not JSON: the file ends within an object"),
    ] {
        let text = good.replacen(old, new, 1);
        assert_ne!(text, good);
        let said = said(text.as_bytes());
        assert!(said.contains(expected), "{said:?} should contain {expected:?}");
    }
    assert_eq!(said(b"{\"name\": \"caf\xe9\"}"), "1:14: the byte 0xe9 is not UTF-8; save the file as UTF-8");
    assert!(said(b" \n").starts_with("the file is empty"));
    assert!(said(&b"[".repeat(60_000)).contains("not JSON"));
    let deep = ["[".repeat(70), "]".repeat(70)].concat().into_bytes();
    assert!(said(&deep).contains("nested more than 64 levels deep"), "{}", said(&deep));
    let many = format!("{{{}}}", (0..5000).map(|i| format!("\"k{i}\": 1")).collect::<Vec<_>>().join(","));
    assert!(from_bytes(many.as_bytes(), &registry()).expect_err("unknown keys").len() <= MAX_PROBLEMS + 1);
}

#[test]
fn texts_without_words_are_left_out() {
    let text =
        r#"{"name": "A", "description": "", "source": " ", "reflection_model": "phong", "material": {}}"#;
    let material = from_bytes(text.as_bytes(), &registry()).expect("no mistake");
    assert_eq!((material.description, material.source), (None, None));
    assert_eq!(
        from_bytes(text.replace(r#"" ""#, "\"me\"").as_bytes(), &registry()).expect("none").source.as_deref(),
        Some("me")
    );
}

#[test]
fn broken_files_hide_no_others_and_files_outside_are_not_read() {
    let (registry, root) = (registry(), tempfile::tempdir().expect("a folder"));
    let folder = root.path().join("materials");
    save(&velvet(), &folder, &registry).expect("saved");
    fs::write(folder.join("a.json"), "{}").expect("written");
    fs::write(folder.join("b.json"), vec![b' '; 10 << 20]).expect("written");
    fs::create_dir(folder.join("c.json")).expect("made");
    fs::write(folder.join(".hidden.json"), "{}").expect("written");
    fs::write(folder.join("notes.txt"), "{}").expect("written");
    let mut expected = vec![
        "a.json:1:1: name is missing",
        "b.json: the file is larger than 64 KiB",
        "c.json: this is a folder",
    ];
    #[cfg(unix)]
    {
        fs::write(root.path().join("secret.json"), to_json(&velvet(), &registry)).expect("written");
        std::os::unix::fs::symlink("../secret.json", folder.join("d.json")).expect("linked");
        expected.push("d.json: the file could not be read: it is outside the folder");
    }
    let library = Library::read(Some(&folder), &registry);
    assert_eq!(library.materials[0].name, "Mira's velvet");
    let broken: Vec<_> = library.broken.iter().map(ToString::to_string).collect();
    assert_eq!(broken.len(), expected.len(), "{broken:?}");
    for (said, expected) in broken.iter().zip(expected) {
        assert!(said.contains(expected), "{said:?} should contain {expected:?}");
    }
    assert_eq!(Library::read(Some(&root.path().join("none")), &registry).broken, []);
}

#[test]
fn words_find_materials_and_their_pictures_differ() {
    let registry = registry();
    let all = built_in(&registry);
    let found =
        |words: &str| all.iter().filter(|m| m.matches(words)).map(|m| m.name.as_str()).collect::<Vec<_>>();
    assert_eq!(found("car PAINT openpbr"), ["Car paint"]);
    assert!(found("gold").contains(&"Gold") && found("no such words").is_empty());
    assert_eq!(found("").len(), all.len());
    // The scene is valid, and not the one that replaces it if it were not.
    let gold = all.iter().find(|m| m.name == "Gold").expect("measured");
    let scene = gold.scene(&registry);
    assert_eq!(scene.name.as_deref(), Some("Sphere of a material"));
    assert_eq!(crate::scene::check::scene(&scene, &registry), []);
    let end = || Instant::now() + std::time::Duration::from_secs(60);
    let draw = |m: &Material| m.picture(24, &registry, end()).expect("in time");
    let silver = all.iter().find(|m| m.name == "Silver").expect("measured");
    assert!(draw(gold) == draw(gold) && draw(gold) != draw(silver));
    assert_eq!(gold.picture(24, &registry, Instant::now()), None);
}
