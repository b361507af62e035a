//! Scenes as tables: every scene survives a round trip, every error has its line and column, and a table that
//! is written again keeps its author's additions.

use std::{
    fs,
    path::Path,
    time::{Duration, Instant},
};

use lights_camera_models::{
    parameter::Value,
    registry::{Register as _, Registry},
    scene::{
        Scene,
        error::MOST_LISTED,
        formats::{Csv, SceneFormat as _, Target},
        load::{self, Defaults},
        save::{self, Expected},
    },
};
use proptest::prelude::*;

use crate::{
    helpers::support::{check_wording, full_scene, lcm_in, read, root},
    library::plugins::shading_model,
    scenes::roundtrip::scene,
};

/// The table of a scene, in the style of an old one.
fn table(scene: &Scene, old: Option<&str>) -> String {
    let target = Target::new(Path::new(""), old.map(str::as_bytes));
    let bytes = Csv.writer().expect("it writes").write(scene, &target, &Registry::builtin());
    String::from_utf8(bytes.expect("written")).expect("text")
}

/// The scene in a table.
fn from_table(text: &str) -> Scene {
    match load::from_text(text, "room.csv", &Registry::builtin(), Defaults::Refuse) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// The messages of a table; empty if it is a valid scene.
fn said(text: &str) -> String {
    let read = load::from_text(text, "room.csv", &Registry::builtin(), Defaults::Refuse);
    read.err().map_or_else(String::new, |error| error.to_string())
}

/// A small table as a person would write it.
const ROOM: &str = "\
# My first table
part,type,name,position.x,position.y,position.z,intensity,colour,size,material.k_d,reflection_model,shading_model,direction,scene_size.height,scene_size.width,scene_size.depth
scene,,Room,,,,,,,,lambert,phong,,10,10,10
# lamps, from left to right
light,point,,2,8,9,20,255 0 0,,,,,,,,
light,point,Blue,8,8,9,20,\"0, 0, 255\",,,,,,,,
observer,,,5,5,9.5,,,,,,,0 0 -1,,,
object,sphere,\"A \"\"ball\"\", red\",5,5,5,,,2,0.8,,,,,,
# the end
";

#[test]
fn a_table_says_what_json_says() {
    let json = r#"{
  "name": "Room",
  "scene_size": { "height": 10, "width": 10, "depth": 10 },
  "reflection_model": "lambert", "shading_model": "phong",
  "lights": [
    { "type": "point", "position": [2, 8, 9], "intensity": 20, "colour": [255, 0, 0] },
    { "type": "point", "name": "Blue", "position": [8, 8, 9], "intensity": 20, "colour": [0, 0, 255] }
  ],
  "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1] },
  "objects": [
    { "type": "sphere", "name": "A \"ball\", red", "position": [5, 5, 5], "size": 2, "material": { "k_d": 0.8 } }
  ]
}"#;
    assert_eq!(from_table(ROOM), read(json));
    // The wrong twin: one cell differs.
    assert_ne!(from_table(&ROOM.replace("255 0 0", "255 1 0")), read(json));
}

#[test]
fn the_full_scene_comes_back_from_a_table() {
    // A table cannot store variants.
    let whole = read(&full_scene().to_string());
    let scene = whole.clone().alone();
    assert_eq!(from_table(&table(&scene, None)), scene);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.csv");
    let refused =
        save::write(&file, &whole, &Registry::builtin(), Expected::Nothing).map(|_| ()).unwrap_err();
    assert!(refused.to_string().contains("its format would lose comparison"), "{refused}");
    assert!(!file.exists());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_valid_scene_comes_back_from_a_table_in_every_manner(mut scene in scene(), manner in 0..4usize) {
        // An empty cell is not text, and no table contains the null character.
        let clean = |text: &mut Option<String>| {
            *text = text.take().map(|t| t.replace('\0', "")).filter(|t| !t.is_empty());
        };
        [&mut scene.name, &mut scene.description].into_iter().for_each(clean);
        scene.lights.iter_mut().for_each(|light| clean(&mut light.name));
        scene.objects.iter_mut().for_each(|object| clean(&mut object.name));
        let old = [
            None,
            Some("part;type;position;colour.r\nlight;point;0,5 1 1;5\n"),
            Some("part\ttype\trotation.z\trotation.x\n"),
            Some("\u{FEFF}part,material.ior.g,direction\r\n"),
        ][manner];
        prop_assert_eq!(from_table(&table(&scene, old)), scene);
    }
}

#[test]
fn every_mistake_has_its_line_and_column() {
    let row = "object,sphere,\"A \"\"ball\"\", red\",5,5,5,,,2,0.8,,,,,,";
    let with = |from: &str, to: &str| {
        assert!(ROOM.contains(from), "{from}");
        said(&ROOM.replacen(from, to, 1))
    };
    let cases = [
        // Values, by the rules of every format.
        (
            with(",0.8,", ",0.2,"),
            "room.csv:8:43: objects[0].material.k_d is 0.2, but the diffuse coefficient must be between 0.5 and 1",
        ),
        (
            with(",0.8,", ",much,"),
            "room.csv:8:43: objects[0].material.k_d is much, but it must be a number: the diffuse",
        ),
        (
            with("light,point,,2,8,9", "light,point,,2,-8,9"),
            "room.csv:5:14: lights[0].position is [2, -8, 9], but a position must be inside the room",
        ),
        (
            with("light,point,,2,8,9", "light,point,,2,x,9"),
            "room.csv:5:16: lights[0].position[1] is x, but a position must be three numbers: [x, y, z]",
        ),
        (
            with("light,point,,2,8,9", "light,point,,2,,9"),
            "room.csv:5:14: lights[0].position is [2, 9], but a position must be three numbers",
        ),
        (
            with("255 0 0", "255 0"),
            "room.csv:5:23: lights[0].colour is [255, 0], but a colour must be three whole numbers from 0 to 255",
        ),
        (
            with("255 0 0", "#ff0000"),
            "lights[0].colour is #ff0000, but a colour must be three whole numbers from 0 to 255: [red, green, blue]; write [255, 0, 0]",
        ),
        (
            with("object,sphere", "object,spere"),
            "room.csv:8:8: objects[0].type is spere, but the object type must be",
        ),
        (
            with("object,sphere", "object,"),
            "room.csv:8:1: objects[0].type is missing; the object type must be",
        ),
        (with(",lambert,", ",lambart,"), "room.csv:3:20: reflection_model is lambart"),
        (
            with(",lambert,", ",,"),
            "room.csv:2:1: reflection_model (default: lambert) is missing; --use-defaults accepts",
        ),
        // A cell in the row of another part.
        (
            with(row, "object,sphere,,5,5,5,20,,2,0.8,,,,,,"),
            "room.csv:8:22: objects[0].intensity is not a key of an object",
        ),
        // Rows.
        (
            with("object,sphere", "objekt,sphere"),
            "room.csv:8:1: part is \"objekt\", but the part of the scene in a row must be \"scene\", \"light\", \"observer\" or \"object\"; did you mean \"object\"?",
        ),
        (
            with("observer,,", ",,Eye"),
            "room.csv:7:1: part is missing; the part of the scene in a row must be",
        ),
        (
            with("# the end", "scene,,Again"),
            "room.csv:9:1: part is \"scene\", but there is a row for the scene above; a table has only one",
        ),
        (
            with("# the end", "observer,,,5,5,9,,,,,,,0 0 1"),
            "observer is a list of 2, but a scene has exactly one observer",
        ),
        (with(row, ""), "room.csv:2:1: objects is missing; a scene must have a list of objects"),
        (with(",0 0 -1,,,", ",0 0 -1,,,,5"), "room.csv:7:36: row has 17 cells, but the header has 16"),
        // The header.
        (with(",size,", ",siez,"), "room.csv:2:66: siez is not a column; did you mean \"size\"?"),
        (
            with("material.k_d", "material.k_dd"),
            "material.k_dd is not a column; did you mean \"material.k_d\"?",
        ),
        (
            with(",size,", ",,"),
            "room.csv:8:41: row has \"2\" in a column without a name; name it in the header, or empty the cell",
        ),
        (with("material.k_d", "k_d"), "k_d is not a column; did you mean \"material.k_d\"?"),
        (with(",size,", ",sizes,"), "sizes is not a column; did you mean \"size\"?"),
        (
            with(",size,", ",intensity,"),
            "room.csv:2:66: intensity is given twice: there is another column intensity",
        ),
        (
            with("part,type", "type,part"),
            "room.csv:2:1: not CSV: the first line must name the columns, the first of them part",
        ),
        (said("# only a remark\n"), "room.csv:1:1: not CSV: the first line must name the columns"),
        // Quotation marks.
        (
            with("red\"", "red"),
            "room.csv:8:15: not CSV: the quotation mark that opens here (\") is not closed",
        ),
        (
            with("red\"", "red\"x"),
            "room.csv:8:32: not CSV: expected the next column after the closing quotation mark",
        ),
        (said(" \n"), "room.csv is empty"),
    ];
    let other: Vec<_> = cases.iter().filter(|(said, expected)| !said.contains(expected)).collect();
    assert!(other.is_empty(), "{other:#?}");
    cases.iter().for_each(|(said, _)| check_wording(said));
    assert_eq!(said(ROOM), "");
}

#[test]
fn tables_are_read_as_spreadsheets_write_them() {
    let plain = from_table(ROOM);
    let german: String = ROOM
        .lines()
        .map(|line| match line.chars().next() {
            Some('#') => format!("\"{line}\";;;;\r\n"),
            _ => {
                let line =
                    line.replace("\"0, 0, 255\"", "0 0 255").replace("\"A \"\"ball\"\", red\"", "\u{1}");
                let line = line.replace(',', ";").replace("9.5", "9,5").replace("0.8", "0,8");
                line.replace('\u{1}', "\"A \"\"ball\"\", red\"") + "\r\n"
            }
        })
        .collect();
    let excel = format!("\u{FEFF}{german};;;;\r\n");
    assert_eq!(from_table(&excel), plain);
    assert!(from_table(&excel.replace("9,5", "9,25")).observer.position.z == 9.25);
    // Where commas separate columns, they are not decimal commas.
    assert!(said(&ROOM.replace(",0.8,", ",\"0,8\",")).contains("material.k_d is [0, 8]"));
    assert_eq!(
        from_table(
            &ROOM
                .replace("light,point", "light , point ")
                .replace(",", "\t")
                .replace("\"A \"\"ball\"\"\t red\"", "\"A \"\"ball\"\", red\"")
        ),
        plain
    );
    // Numbers and flags as typed.
    let shown = ROOM.replacen("part,type", "part,enabled,type", 1).replace("\nlight,", "\nlight,TRUE,");
    let shown = shown
        .replace("\nscene,", "\nscene,,")
        .replace("\nobserver,", "\nobserver,,")
        .replace("\nobject,", "\nobject,,");
    assert_eq!(from_table(&shown), plain);
    let off = from_table(&shown.replacen("TRUE", "false", 1));
    assert!(!off.lights[0].enabled && off.lights[1].enabled);
}

#[test]
fn a_table_that_is_written_again_keeps_its_columns_its_separators_and_its_remarks() {
    let scene = from_table(ROOM);
    let again = table(&scene, Some(ROOM));
    assert_eq!(from_table(&again), scene);
    let lines: Vec<_> = again.lines().collect();
    assert_eq!(lines[0], "# My first table");
    assert!(lines[1].starts_with("part,type,name,position.x,position.y,position.z,intensity,colour,size,"));
    assert!(lines[1].contains(",direction,") && !lines[1].contains("direction.x"), "{}", lines[1]);
    assert_eq!(lines[3], "# lamps, from left to right");
    assert!(lines[4].starts_with("light,point,,2,8,9,20,255 0 0,"));
    assert_eq!(lines.last(), Some(&"# the end"));
    // Required parts that the table did not have are appended.
    let mut more = scene.clone();
    more.objects[0].rotation.y = 30.5;
    let wide = table(&more, Some(ROOM));
    assert!(
        wide.lines().nth(1).is_some_and(|l| l.contains("scene_size.depth,") && l.ends_with("rotation.z")),
        "{wide}"
    );
    assert_eq!(from_table(&wide), more);
    // Writing it again changes nothing.
    assert_eq!(table(&more, Some(&wide)), wide);
    // A comment stays, even if its row is gone.
    let mut fewer = scene.clone();
    fewer.lights.truncate(1);
    let old = ROOM.replace("light,point,Blue", "# a second one\nlight,point,Blue");
    assert!(table(&fewer, Some(&old)).contains("# a second one\n"));
    // Semicolons, decimal commas, line ends and the mark of a spreadsheet.
    let old = "\u{FEFF}part;type;size\r\nobject;sphere;2,5\r\n";
    let german = table(&more, Some(old));
    assert!(
        german.starts_with("\u{FEFF}part;type;size;") && german.contains("\r\nobject;sphere;2;"),
        "{german}"
    );
    assert!(german.contains(";30,5;") && german.contains("9,5"), "{german}");
    assert_eq!(from_table(&german), more);
}

#[test]
fn the_shipped_table_is_complete_and_written_as_the_program_writes_it() {
    let path = root().join("scenes/colour_wheel.csv");
    let scene =
        load::file(&path, &Registry::builtin(), Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let text = fs::read_to_string(&path).expect("there");
    let expected = table(&scene, Some(&text));
    if crate::renderers::golden::updating() && text != expected {
        fs::write(&path, &expected).expect("written");
    } else {
        assert!(
            text == expected,
            "{} is laid out otherwise; run the tests once with LCM_UPDATE=1",
            path.display()
        );
    }
    assert!(text.starts_with('#') && scene.objects.len() == 12);
}

#[test]
fn the_command_line_reads_and_writes_tables() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let run = |arguments: &[&str], input: &str| lcm_in(at, arguments, input.as_bytes());
    assert_eq!(run(&["new", "room.csv"], "").status, Some(0));
    assert!(
        fs::read_to_string(at.join("room.csv")).expect("written").starts_with("part,type,name,position.x,")
    );
    assert_eq!(run(&["new", "room.json"], "").status, Some(0));
    let checked = run(&["check", "room.csv", "room.json"], "");
    assert!(checked.out.contains("room.csv: valid: 1 light, 1 object"), "{}{}", checked.out, checked.err);
    for (scene, picture) in [("room.csv", "a.png"), ("room.json", "b.png")] {
        let run = run(&["render", scene, "-o", picture, "--renderer", "cpu", "--size", "64x36"], "");
        assert_eq!(run.status, Some(0), "{}", run.err);
    }
    let pixels = |name: &str| crate::renderers::golden::read_png(&at.join(name)).expect("a picture");
    assert_eq!(pixels("a.png"), pixels("b.png"));
    // From a pipe, by its first line; anything else is JSON.
    let piped = run(&["check", "-"], ROOM);
    assert!(piped.out.contains("standard input: valid: 2 lights, 1 object"), "{}{}", piped.out, piped.err);
    let piped = run(&["check", "-"], "a, b\n");
    assert!(piped.err.contains("standard input:1:1: not JSON"), "{}", piped.err);
    // Errors, for people and for programs.
    fs::write(at.join("bad.csv"), ROOM.replace(",0.8,", ",0.2,")).expect("written");
    let bad = run(&["check", "bad.csv"], "");
    assert!(
        bad.status == Some(1) && bad.err.starts_with("bad.csv:8:43: objects[0].material.k_d is 0.2"),
        "{}",
        bad.err
    );
    let bad = run(&["check", "--json", "bad.csv"], "");
    let report: serde_json::Value = serde_json::from_str(&bad.out).expect("JSON");
    assert_eq!(
        (&report[0]["problems"][0]["line"], &report[0]["problems"][0]["column"]),
        (&8.into(), &43.into())
    );
    // A folder lists its tables.
    let listed = run(&["check", "."], "");
    assert!(listed.err.contains("this one holds bad.csv, room.csv, room.json"), "{}", listed.err);
    // A file is overwritten only with consent.
    let new = run(&["new", "room.csv"], "");
    assert!(new.status == Some(4) && new.err.contains("already exists"), "{}", new.err);
}

#[test]
fn a_text_that_no_table_can_hold_is_refused_and_the_file_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.csv");
    fs::write(&path, ROOM).expect("written");
    let mut scene = from_table(ROOM);
    let registry = Registry::builtin();
    scene.name = Some("zero \0".to_owned());
    let error = save::write(&path, &scene, &registry, Expected::Anything).expect_err("refused").to_string();
    assert!(
        error.contains("zero character")
            && error.contains("save the scene as JSON")
            && error.contains("room.json"),
        "{error}"
    );
    assert_eq!(fs::read_to_string(&path).expect("there"), ROOM);
    scene.name = Some("fine".to_owned());
    save::write(&path, &scene, &registry, Expected::Anything).expect("written");
    assert_eq!(load::file(&path, &registry, Defaults::Refuse).expect("valid").scene, scene);
}

#[test]
fn a_cell_is_read_as_the_command_line_reads_a_value() {
    let registry = Registry::builtin();
    let mut cells = 0;
    for p in registry.material_parameters() {
        for value in p.ends() {
            let text = ROOM.replace("material.k_d", &format!("material.{}", p.name));
            let scene = from_table(&text.replace(",0.8,", &format!(",\"{value}\",")));
            assert_eq!(scene.objects[0].material.0.get(p.name), Some(&value), "{}", p.name);
            assert_eq!(p.parse(&value.to_string()), Ok(value));
            cells += 1;
        }
    }
    assert!(cells > 80, "{cells}");
}

#[test]
fn a_heap_of_mistakes_is_told_in_part_and_counted() {
    let rows = 10_000;
    let table = format!("{ROOM}{}", "x\n".repeat(rows));
    let said = said(&table);
    assert!(said.contains("part is \"x\", but the part of the scene in a row must be"), "{}", &said[..200]);
    assert_eq!(said.lines().count(), MOST_LISTED + 1);
    assert!(said.ends_with("more problems, which are not listed"), "{said}");
    let heading = format!("part,{}\n", "nothing_of_the_kind,".repeat(20_000));
    let begin = Instant::now();
    assert_eq!(self::said(&heading).lines().count(), MOST_LISTED + 1);
    // A suggestion for each would take a minute.
    assert!(begin.elapsed() < Duration::from_secs(10), "{:?}", begin.elapsed());
}

#[test]
fn parameters_of_shading_models_have_columns_and_come_back() {
    let mut registry = Registry::builtin();
    registry.add_shading_model::<shading_model::Banded>();
    let read = |text: &str| load::from_text(text, "room.csv", &registry, Defaults::Refuse).map(|l| l.scene);
    let mut scene = from_table(ROOM);
    scene.objects[0].material.set("steps", Value::Integer(9));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.csv");
    save::write(&file, &scene, &registry, Expected::Nothing).expect("saved");
    let text = fs::read_to_string(&file).expect("there");
    assert!(text.contains("material.steps"), "{text}");
    assert_eq!(read(&text).ok(), Some(scene));
}

#[test]
fn the_rows_of_a_table_are_counted_while_it_is_read() {
    // 50 MB: the header, a comment, and rows of minimum size.
    for (row, expected) in [
        (
            "object\n",
            "10263:1: not CSV: the table has more than 10259 rows; a scene has at most 256 lights and 10000 objects",
        ),
        ("a,b\n", "10263:1: not CSV: the table has more than 10259 rows"),
        ("#\n", "the table has more than 4000000 cells and remarks"),
        (",", "the row has more than 32768 columns"),
    ] {
        let table = format!("{ROOM}{}", row.repeat(50_000_000 / row.len()));
        let begin = Instant::now();
        let said = said(&table);
        assert!(said.contains(expected), "{}", &said[..said.len().min(300)]);
        assert!(begin.elapsed() < Duration::from_secs(10), "{:?} for {row:?}", begin.elapsed());
        check_wording(&said);
    }
}

#[test]
fn a_table_of_an_old_macintosh_is_read_and_its_mistakes_have_their_rows() {
    let old = ROOM.replace('\n', "\r");
    assert_eq!(from_table(&old), from_table(ROOM));
    let wrong = old.replace("light,point,Blue", "light,pint,Blue");
    assert!(said(&wrong).contains(":6:7: lights[1].type is pint"), "{}", said(&wrong));
    // With decimal commas as well, and without its extension.
    let commas =
        ROOM.replace(',', ";").replace("0; 0; 255", "0 0 255").replace("9.5", "9,5").replace('\n', "\r");
    assert_eq!(from_table(&commas).observer, from_table(ROOM).observer);
    let stream = load::from_bytes(old.as_bytes(), load::STDIN, &Registry::builtin(), Defaults::Refuse);
    assert_eq!(stream.expect("a table").scene, from_table(ROOM));
    // Written again, it has modern line ends and keeps its comments.
    let again = table(&from_table(&old), Some(&old));
    assert!(again.starts_with("# My first table\npart,") && again.contains("\n# the end"), "{again}");
}
