//! Every reader of external text and files against one table of hostile inputs: deep nesting, a mebibyte of
//! one character or one phrase, files cut off, with a zero byte and with bytes that are not UTF-8. Each is
//! read or refused, on a small stack, without a panic and long before a quadratic reader would finish.

use std::{
    ffi::OsString,
    fs, iter,
    path::Path,
    sync::{
        LazyLock,
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};

use glam::DVec3;
use lights_camera_models::{
    custom,
    lesson::{Condition, Lesson},
    light::{ies, panorama},
    linear::{self, Limits, MAX_PIXELS, Pixels},
    materials,
    panel::{
        code::{
            difference, find,
            tokens::{self, Language},
            words::{self, Vocabulary},
        },
        command::{Menu, declared, own},
        progress, settings,
        state::{MOST_CODE, Session},
    },
    parameter::Outside,
    recovery::Store,
    reflection::{merl, rgl, samples},
    registry::Registry,
    scene::{
        Scene, link,
        load::{self, Defaults},
    },
    shape::mesh_file,
    sweep::{Axis, Sweep},
};

use crate::helpers::support::{command_in, root};

/// The stack size of a Bevy thread.
const STACK: usize = 2 << 20;
/// Maximum time for one input. A task of two seconds takes ten times as long without optimisation on a busy
/// machine; a quadratic reader takes minutes, and an endless one forever.
const PATIENCE: Duration = Duration::from_secs(60);
/// The size of the inputs.
const SIZE: usize = 1 << 20;

static REGISTRY: LazyLock<Registry> = LazyLock::new(Registry::builtin);

/// A reader, and the text that must surround hostile text for it to be read at all.
struct Reader {
    name: &'static str,
    around: [String; 2],
    /// Brackets of the language.
    pairs: &'static [(&'static str, &'static str)],
    /// Phrases of the language, to be repeated.
    phrases: &'static [&'static str],
    read: fn(&[u8]) -> Result<(), String>,
}

/// Characters with a meaning in one language or another.
const SIGNS: &[&str] = &[
    "[", "]", "(", ")", "{", "}", "<", ">", "\"", "'", "*", "_", "`", "~", "#", "\\", "/", "|", "=", ":",
    ",", ";", "-", "+", ".", "!", "&", "^", "@", "0", "a", "é", " ", "\n", "\r", "\t", "\0",
];

fn lesson(bytes: &[u8]) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let file = folder.path().join("a.md");
    fs::write(&file, bytes).map_err(|e| e.to_string())?;
    let read = Lesson::read(&file, &REGISTRY, Outside::NONE);
    read.map(|lesson| drop(lesson.to_text())).map_err(|problems| {
        assert!(problems.len() <= 200, "{} problems", problems.len());
        problems.iter().map(|p| p.annotated("a.md")).collect()
    })
}

fn condition(bytes: &[u8]) -> Result<(), String> {
    Condition::parse(&String::from_utf8_lossy(bytes)).map(drop).map_err(|(_, what)| what)
}

fn scene(bytes: &[u8], name: &str) -> Result<(), String> {
    load::from_bytes(bytes, name, &REGISTRY, Defaults::Use).map(drop).map_err(|e| e.to_string())
}

/// A linear picture, with the limits of pictures that are compared.
fn linear_picture(bytes: &[u8]) -> Result<(), String> {
    /// Counts pixels.
    struct Count(usize);
    impl Pixels for Count {
        fn check(width: usize, height: usize) -> Result<(), String> {
            (width.saturating_mul(height) <= MAX_PIXELS).then_some(()).ok_or_else(|| "too large".to_owned())
        }

        fn new(_: usize, _: usize, _: DVec3) -> Self {
            Self(0)
        }

        fn add(&mut self, _: usize, _: usize, _: [f32; 4]) {
            self.0 += 1;
        }
    }
    let limits = Limits { head: 128 << 20, channels: 1024, size: [16_384; 2], surroundings: false };
    linear::read::<Count>(bytes, &limits).map(|count| assert!(count.0 <= MAX_PIXELS))
}

fn model(bytes: &[u8]) -> Result<(), String> {
    let text = String::from_utf8_lossy(bytes);
    let read = custom::declare(Path::new("somewhere/a.wgsl"), &text, &REGISTRY);
    read.map(drop).map_err(|problems| format!("{problems:?}"))
}

fn material(bytes: &[u8]) -> Result<(), String> {
    materials::from_bytes(bytes, &REGISTRY).map(drop).map_err(|problems| {
        assert!(problems.len() <= materials::MAX_PROBLEMS + 1, "{} problems", problems.len());
        problems.join("\n")
    })
}

/// A file in a folder of the user's data.
fn in_folder(name: &str, bytes: &[u8], read: impl Fn(&Path) -> Option<String>) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    fs::write(folder.path().join(name), bytes).map_err(|e| e.to_string())?;
    read(folder.path()).map_or(Ok(()), Err)
}

/// The keys of the user's own in a folder with settings.
fn own_keys(folder: &Path) -> Option<String> {
    static COMMANDS: LazyLock<Menu> = LazyLock::new(|| declared(&Session::default(), &REGISTRY, true, true));
    let (settings, complaint) = settings::load(folder);
    complaint.or_else(|| own::check(&settings.keys, &COMMANDS).1.into_iter().next())
}

/// A copy of unsaved work left by another window: the file about it.
fn recovery(bytes: &[u8]) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let store = Store::new(folder.path().to_owned());
    let journal = folder.path().join("1700000000-17");
    fs::create_dir(&journal).map_err(|e| e.to_string())?;
    for (name, content) in [("about.json", bytes), ("scene.json", b"{}".as_slice()), ("lock", b"")] {
        fs::write(journal.join(name), content).map_err(|e| e.to_string())?;
    }
    assert_eq!(store.abandoned().len(), 1, "the copy counts whatever the file about it holds");
    Ok(())
}

/// The editor: colours, words, places, differences.
fn code(bytes: &[u8]) -> Result<(), String> {
    static WORDS: LazyLock<Vocabulary> = LazyLock::new(|| Vocabulary::of(&REGISTRY));
    let text = String::from_utf8_lossy(bytes);
    let text = &text[..text.floor_char_boundary(MOST_CODE)];
    for language in [Language::Wgsl, Language::Json] {
        for (range, _) in tokens::tokens(text, language) {
            assert!(text.get(range).is_some());
        }
        for at in [text.len(), text.len() / 2] {
            let offer = WORDS.offer(text, at, language, &[]);
            assert!(text.get(offer.place).is_some() && offer.words.len() <= words::MOST_OFFERED);
            let _ = WORDS.help(text, at, language, &[]);
        }
    }
    assert!(find::find(text, "a", false).len() <= find::MOST_FOUND);
    assert!(difference::difference(text, "a\nb\n").len() >= text.lines().count());
    Ok(())
}

const BRACKETS: &[(&str, &str)] = &[("(", ")"), ("[", "]"), ("{", "}")];

fn readers() -> Vec<Reader> {
    let text = |path: &str| fs::read_to_string(root().join(path)).expect("readable");
    let split = |whole: &str, at: &str| -> [String; 2] {
        let (before, after) = whole.split_once(at).expect("there");
        [before.to_owned(), after.to_owned()]
    };
    let front = "---\ntitle: T\nsummary: S.\n---\n\n## S\n\n";
    let of_lesson = |name, before: &str, after: &str, pairs, phrases| Reader {
        name,
        around: [format!("{front}{before}"), after.to_owned()],
        pairs,
        phrases,
        read: lesson,
    };
    let scene_json = text("scenes/default.json");
    let table = "part,name,type,size,position,direction\nscene,a\nlight,b,point,,1 1 1\n\
        observer,,,,5 5 9,0 0 -1\nobject,c,sphere,1,5 5 5\n";
    vec![
        Reader {
            name: "lesson",
            around: [String::new(), String::new()],
            pairs: &[],
            phrases: &["---\n", "a: b\n", "title: a\n", "## a\n"],
            read: lesson,
        },
        of_lesson("steps", "", "\n", BRACKETS, &[
            "## a\n\nb\n\n",
            "a\n\n",
            "- a\n",
            "- ",
            "1. ",
            "> ",
            "![",
            "[a](",
            "[a]: b\n",
            "[^a]: b\n\n",
            "a|b\n-|-\n",
            "*a **b ",
            "**a*b",
            "a_",
            "~~a",
            "<a",
            "<!--",
            "<?",
            "&amp;",
            "`a``b",
            "```\n",
            "```scene\nexposure = 1\n```\n\n## a\n\n",
            "\\*",
            "* *",
            "a **",
        ]),
        of_lesson("equation", "```equation\n", "\n```\n", &[("(", ")"), ("√(", ")"), ("|(", ")|"), ("⟨", "⟩"), ("{", "}")], &[
            "x_{", "x\n", "a/", "x^", "a b ",
        ]),
        of_lesson("scene block", "```scene\n", "\n```\n", &[("exposure = [", "]")], &[
            "exposure = 1\n",
            "objects[0].size = 1\n",
            "open: default.json\n",
            "a: b\n",
            "a\n",
        ]),
        of_lesson("path", "```scene\nobjects", " = 1\n```\n", &[], &["[0]", ".a", "[0].a", "[1"]),
        of_lesson("value", "```scene\nobjects[0].size = ", "\n```\n", &[("[", "]"), ("{\"a\":", "}")], &[
            "[1],", "\"a\",", "1,", "{}", "1e",
        ]),
        of_lesson("view block", "```view\n", "\n```\n", &[], &["active: A\n", "select: object 1\n", "pin: 0, 0\n", "a: b\n"]),
        of_lesson("point block", "```point\n", "\n```\n", &[], &["knob: exposure\n", "part: object 1\n", "knob: alpha7\n", "part: sphere\n"]),
        of_lesson("question", "```predict\na?\n", "\n```\n", &[], &["[ ] a | b\n", "[x] a\n", "a | ", "[ ]"]),
        of_lesson("task", "```do\na\nuntil: ", "\n```\n", &[("(", ")"), ("not (", ")"), ("not ", "")], &[
            "probe.red > 1 and ",
            "until: a\n",
            "hint: a\n",
            "a ",
            "scene.objects[0]",
            "\"",
        ]),
        Reader {
            name: "condition",
            around: ["".into(), "probe.pinned".into()],
            pairs: &[("(", ")"), ("not (", ")"), ("not ", "")],
            phrases: &["probe.red > 1 and ", "probe.red > 1 or ", "a.b(", "scene.a[0]", "1 degrees ", "1", "- "],
            read: condition,
        },
        Reader {
            name: "scene",
            around: split(&scene_json, "\"lights\""),
            pairs: &[("[", "]"), ("{\"a\":", "}"), ("{\"objects\":[", "]}")],
            phrases: &["\"a\":1,", "\"objects\":[],", "[],", "{},", "\\u0000", "//\n", "1e", "\"\","],
            read: |bytes| scene(bytes, "a.json"),
        },
        Reader {
            name: "list in a scene",
            around: split(&scene_json.replacen("\"lights\": [", "\"lights\": [HERE", 1), "HERE"),
            pairs: &[("[", "]")],
            phrases: &["{},", "1,", "{\"type\":\"pint\"},", "{\"a\":1,\"b\":2},", "{\"type\":\"point\",\"name\":\"a\"},"],
            read: |bytes| scene(bytes, "a.json"),
        },
        Reader {
            name: "table",
            around: [table.into(), String::new()],
            pairs: &[],
            phrases: &["object,a,sphere,1,1 1 1\n", "a\n", "#\n", ",", ",\n", "\"\"\n", "object\n", "scene\n", "light\n", "x,"],
            read: |bytes| scene(bytes, "a.csv"),
        },
        Reader {
            name: "heading of a table",
            around: ["part,".into(), "\nobject\n".into()],
            pairs: &[],
            phrases: &["name,", "a,", "position.x,", "\"a\","],
            read: |bytes| scene(bytes, "a.csv"),
        },
        Reader {
            name: "cell of a table",
            around: ["part;type;size\nobject;sphere;".into(), "\n".into()],
            pairs: &[("[", "]")],
            phrases: &["1,5 ", "1 ", "\"\"", "1,", "a ", "#"],
            read: |bytes| scene(bytes, "a.csv"),
        },
        Reader {
            name: "picture",
            around: ["\u{0}".into(), String::new()],
            pairs: &[],
            phrases: &["\0\0\0\0iTXt\0\0\0\0", "\0\0\0\0tEXt\0\0\0\0", "iTXtlights-camera-models scene\0"],
            read: |bytes| scene(&[b"\x89PNG\r\n\x1a\n", bytes].concat(), "a.png"),
        },
        Reader {
            name: "scene in an OpenEXR picture",
            around: ["v/1\u{1}\u{2}\0\0\0".into(), String::new()],
            pairs: &[],
            phrases: &[
                "a\0string\0\u{1}\0\0\0a",
                "a\0float\0\0\0\0\0",
                "lights-camera-models scene\0string\0\u{2}\0\0\0{}",
            ],
            read: |bytes| scene(bytes, "a.exr"),
        },
        Reader {
            name: "scene in a Radiance picture",
            around: split(
                "#?RADIANCE\n# lights-camera-models scene begins\nHERE# lights-camera-models scene ends\n\n-Y 1 +X 1\naaaa",
                "HERE",
            ),
            pairs: &[("# [\n", "# ]\n"), ("# {\"a\":\n", "# }\n")],
            phrases: &["# []\n", "# \"a\": 1,\n", "# \n", "#\n", "# lights-camera-models scene begins\n"],
            read: |bytes| scene(bytes, "a.hdr"),
        },
        Reader {
            name: "linear picture to compare",
            around: ["#?RADIANCE\n\n-Y 8192 +X 8192\n".into(), String::new()],
            pairs: &[],
            phrases: &["\u{1}\u{1}\u{1}\u{1}", "\u{2}\u{2} \0", "aaaa"],
            read: linear_picture,
        },
        Reader {
            name: "layers of a linear picture to compare",
            around: ["v/1\u{1}\u{2}\0\0\0".into(), String::new()],
            pairs: &[],
            phrases: &["channels\0chlist\0\u{1}\0\0\0\0", "R\0\u{2}\0\0\0\0\0\0\0\u{1}\0\0\0\u{1}\0\0\0", "a\0"],
            read: linear_picture,
        },
        Reader {
            name: "declaration",
            around: ["/* lcm { \"name\": \"a\", ".into(), " } */\nfn response() {}\n".into()],
            pairs: &[("\"equation\": [", "]"), ("[", "]"), ("{\"a\":", "}")],
            phrases: &["\"name\": \"a\",", "\"parameters\": [],", "/*", "//\n", "\"a\":1,"],
            read: model,
        },
        Reader {
            name: "equation of a model",
            around: ["/* lcm { \"equation\": \"".into(), "\" } */\nfn response() {}\n".into()],
            pairs: &[("(", ")"), ("√(", ")"), ("|(", ")|")],
            phrases: &["x_{", "a/"],
            read: model,
        },
        Reader {
            name: "photometric file",
            around: split(&format!("{}HERE", text("scenes/wall_washer.ies")), "HERE"),
            pairs: &[],
            phrases: &["1 ", "1\n", "[A] a\n", "1e", "1,"],
            read: |bytes| (ies::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "head of a photometric file",
            around: ["IESNA:LM-63-2002\n".into(), "\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n1 1\n".into()],
            pairs: &[],
            phrases: &["[A] a\n", "TILT=INCLUDE\n", "1 "],
            read: |bytes| (ies::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "head of a picture of surroundings",
            around: ["#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n".into(), "\n-Y 1 +X 2\n12341234".into()],
            pairs: &[],
            phrases: &["#a\n", "EXPOSURE=1\n", "COLORCORR=1 1 1\n", "a=b\n", "1 "],
            read: |bytes| (panorama::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "primaries of a picture of surroundings",
            around: ["#?RADIANCE\nPRIMARIES=".into(), "\n\n-Y 1 +X 2\n12341234".into()],
            pairs: &[],
            phrases: &[".64 .33 .3 .6 .15 .06 .3127 .329 ", "1e999 ", "nan ", "inf ", "-1 ", "0 "],
            read: |bytes| (panorama::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "primaries of a linear picture to compare",
            around: ["#?RADIANCE\nPRIMARIES=".into(), "\n\n-Y 1 +X 2\n12341234".into()],
            pairs: &[],
            phrases: &[".64 .33 .3 .6 .15 .06 .3127 .329 ", "1e999 ", "nan ", "inf ", "-1 ", "0 "],
            read: linear_picture,
        },
        Reader {
            name: "size of a picture of surroundings",
            around: ["#?RADIANCE\n\n-Y 1 ".into(), "+X 2\n12341234".into()],
            pairs: &[],
            phrases: &["-Y 1 ", "1 ", "+X 2\n"],
            read: |bytes| (panorama::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "pixels of a picture of surroundings",
            around: ["#?RADIANCE\n\n-Y 128 +X 256\n".into(), String::new()],
            pairs: &[],
            phrases: &["\u{1}\u{1}\u{1}\u{1}", "\u{2}\u{2}\u{4}\0", "aaaa"],
            read: |bytes| (panorama::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "OpenEXR picture",
            around: ["v/1\u{1}\u{2}\0\0\0".into(), String::new()],
            pairs: &[],
            phrases: &["a\0string\0\u{1}\0\0\0a", "channels\0chlist\0\u{1}\0\0\0\0", "a\0"],
            read: |bytes| (panorama::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "table of measurements",
            around: ["theta_i,phi_i,theta_o,phi_o,value\n1,2,3,4,1\n".into(), String::new()],
            pairs: &[],
            phrases: &["1,2,3,4,1\n", "1,", "-1,1,1,1,1\n", "#\n", "1,2,3,4,-1\n"],
            read: |bytes| (samples::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "head of a table of measurements",
            around: [String::new(), ",value\n1,2,3,4,1\n".into()],
            pairs: &[],
            phrases: &["theta_i,", "sigma;", "value\t", "\""],
            read: |bytes| (samples::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "measured material",
            around: [String::new(), String::new()],
            pairs: &[],
            phrases: &["Z\0\0\0", "Z\0\0\0Z\0\0\0", "\u{7f}"],
            read: |bytes| (merl::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "entries of a measured material",
            around: [String::new(), String::new()],
            pairs: &[],
            phrases: &["\u{1}\u{2}", "aaaaaaaa"],
            read: |bytes| {
                let counts = merl::COUNTS.iter().flat_map(|count| (*count as i32).to_le_bytes());
                let whole: Vec<u8> = counts.chain(bytes.iter().copied()).collect();
                (merl::FORMAT.read)(&whole).map(drop).map_err(|p| p.message)
            },
        },
        Reader {
            name: "tensor file",
            around: [String::new(), String::new()],
            pairs: &[],
            phrases: &["tensor_file\0\u{1}\0", "\u{1}\0\0\0", "\u{5}\0phi_i", "\u{7f}\u{7f}\u{7f}\u{7f}"],
            read: |bytes| (rgl::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "fields of a tensor file",
            around: ["tensor_file\0\u{1}\0\u{40}\0\0\0".into(), String::new()],
            pairs: &[],
            phrases: &["\u{5}\0phi_i\u{1}\0\u{a}\0\0\0\0\0\0\0\0\u{1}\0\0\0\0\0\0\0", "\0\0\0\0\u{1}\0\0\0\0\0\0\0\0"],
            read: |bytes| (rgl::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "OBJ file",
            around: ["v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n".into(), "\n".into()],
            pairs: &[],
            phrases: &["v 0 0 0\n", "f 1 2 3\n", "\\\n", "g a\n", "usemtl a\n", "f ", "1 ", "f 9 9 9\n", "f 1/1/1 2/1/1 3/1/1\n"],
            read: |bytes| (mesh_file::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "vertex of an OBJ file",
            around: ["v 0 0 0\nv 1 0 0\nv 0 ".into(), "\nf 1 2 3\n".into()],
            pairs: &[],
            phrases: &["1e30 ", "-1e-30 ", "1e308 ", "1e-320 ", "nan ", "inf "],
            read: |bytes| (mesh_file::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "polygon of an OBJ file",
            around: ["v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 ".into(), "\n".into()],
            pairs: &[],
            phrases: &["1 ", "1/1 ", "-1 "],
            read: |bytes| (mesh_file::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "head of a PLY file",
            around: ["ply\nformat ascii 1.0\n".into(), "\nelement vertex 1\nproperty float x\nproperty float y\n\
                property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0\n".into()],
            pairs: &[],
            phrases: &["comment a\n", "element a 1\n", "property float a\n", "property list uchar int a\n"],
            read: |bytes| (mesh_file::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "body of a PLY file",
            around: ["ply\nformat ascii 1.0\nelement vertex 100000\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n".into(), "\n".into()],
            pairs: &[],
            phrases: &["0 0 0\n", "1 ", "4 1 1 1 1\n"],
            read: |bytes| (mesh_file::FORMAT.read)(bytes).map(drop).map_err(|p| p.message),
        },
        Reader {
            name: "glTF file",
            around: [String::new(), String::new()],
            pairs: &[("[", "]"), ("{\"a\":", "}")],
            phrases: &["{},", "\"meshes\":[],"],
            read: |json| {
                let sizes = [json.len() + 20, json.len()].map(|n| (n as u32).to_le_bytes());
                let whole = [b"glTF\x02\0\0\0", &sizes[0][..], &sizes[1], b"JSON", json].concat();
                (mesh_file::FORMAT.read)(&whole).map(drop).map_err(|p| p.message)
            },
        },
        Reader {
            name: "values of a sweep",
            around: ["objects[0].size=".into(), String::new()],
            pairs: &[("[", "]")],
            phrases: &["1,", "1..", "1..2:3", ":log", "[1, 2, 3],", "1..2:10000,"],
            read: |text| sweep_of(text, Axis::vary),
        },
        Reader {
            name: "way of a sweep",
            around: ["lights[0]=[1, 8, 9]..".into(), "[9, 8, 9]:24".into()],
            pairs: &[("[", "]")],
            phrases: &["[1, 2, 3]..", "..", "1, ", ":3"],
            read: |text| sweep_of(text, |text, scene, registry| Axis::path(text, None, scene, registry)),
        },
        Reader {
            name: "material",
            around: ["{\"name\": \"a\", \"reflection_model\": \"phong\", ".into(), "\"material\": {\"alpha\": 20}}".into()],
            pairs: &[("\"source\": [", "],"), ("\"source\": {\"a\":", "},")],
            phrases: &["\"name\": \"a\",", "\"a\": 1,", "\"material\": {},"],
            read: material,
        },
        Reader {
            name: "values of a material",
            around: ["{\"name\": \"a\", \"reflection_model\": \"phong\", \"material\": {".into(), "\"alpha\": 20}}".into()],
            pairs: &[("\"k_d\": [", "],"), ("\"k_d\": {\"a\":", "},")],
            phrases: &["\"k_d\": 0.5,", "\"k_d\": 9,", "\"kd\": 1,", "\"base_colour\": [1, 2, \"a\"],"],
            read: material,
        },
        Reader {
            name: "settings",
            around: ["{\"recent_files\": ".into(), "}".into()],
            pairs: &[("[", "]"), ("{\"a\":", "}")],
            phrases: &["\"a\",", "[],"],
            read: |bytes| in_folder("settings.json", bytes, |folder| settings::load(folder).1),
        },
        Reader {
            name: "own keys",
            around: ["{\"keys\": {".into(), "}}".into()],
            pairs: &[("\"save\":[", "]"), ("\"save\":{\"a\":", "}")],
            phrases: &["\"save\":\"F4\",", "\"example.x\":\"Ctrl+A\",", "\"home\":[\"+++\",\"\"],"],
            read: |bytes| in_folder("settings.json", bytes, own_keys),
        },
        Reader {
            name: "progress",
            around: ["{\"lessons\": ".into(), "}".into()],
            pairs: &[("[", "]"), ("{\"a\":", "}")],
            phrases: &["\"a\":", "[],"],
            read: |bytes| in_folder("lessons.json", bytes, |folder| progress::load(folder).1),
        },
        Reader {
            name: "code",
            around: ["/* lcm {\"name\": ".into(), "} */ fn f() {}".into()],
            pairs: &[("{\"a\":", "}"), ("[", "]"), ("/*", "*/"), ("f(", ")")],
            phrases: &["m.", "frame.", "let a = 1.0;\n", "\"a\": ", "// a\n", "0x1p-", "*/", "#import "],
            read: code,
        },
        Reader {
            name: "link",
            around: ["#scene=1.".into(), String::new()],
            pairs: &[],
            phrases: &["eNqrVspLzE1VslJQSlTSUVDKyUzPKCkGcqNjgbz8pKzUZAjXUEfBSEfBOLYWAGCIDcQ"],
            read: |bytes| link::unpacked(&String::from_utf8_lossy(bytes)).map(drop),
        },
        Reader {
            name: "scene in a link",
            around: ["{\"name\": \"a\", \"lights\": [".into(), "]}".into()],
            pairs: &[("[", "]"), ("{\"a\":", "}")],
            phrases: &["\"a\",", "[],", "{\"type\": \"point\", \"position\": [1, 1, 1]}, "],
            read: |bytes| {
                let json = link::unpacked(&link::packed(&String::from_utf8_lossy(bytes)))?;
                scene(json.as_bytes(), "link")
            },
        },
        Reader {
            name: "recovery",
            around: ["{\"title\": ".into(), "}".into()],
            pairs: &[("[", "]"), ("{\"a\":", "}")],
            phrases: &["\"a\",", "[],"],
            read: recovery,
        },
    ]
}

/// Reads an axis of a sweep of the default scene.
fn sweep_of(
    text: &[u8],
    read: impl Fn(&str, &Scene, &Registry) -> Result<Axis, String>,
) -> Result<(), String> {
    let text = std::str::from_utf8(text).map_err(|error| error.to_string())?;
    read(text, &Scene::default(), &REGISTRY).map(drop)
}

/// The hostile inputs of a reader, with their names.
fn inputs(reader: &Reader) -> Vec<(String, Vec<u8>)> {
    let mut inputs = Vec::new();
    let [before, after] = &reader.around;
    let mut add = |name: String, text: &str| inputs.push((name, [before, text, after].concat().into_bytes()));
    let room = SIZE - before.len() - after.len();
    let shown = |text: &str| text.escape_debug().to_string();
    for (open, close) in reader.pairs {
        // The deepest nesting, and slightly beyond the limits of libraries.
        for count in [room / (open.len() + close.len()), 300] {
            add(
                format!("{count} × {} and back", shown(open)),
                &[open.repeat(count), close.repeat(count)].concat(),
            );
        }
        add(format!("{} never closed", shown(open)), &open.repeat(room / open.len()));
    }
    for piece in SIGNS.iter().chain(reader.phrases) {
        add(format!("{} again and again", shown(piece)), &piece.repeat(room / piece.len()));
    }
    // Something well-formed, then cut off or with a wrong byte.
    let phrase = reader.phrases.concat();
    let whole = format!("{before}{phrase}{after}").into_bytes();
    let step = (whole.len() / 40).max(1);
    for at in (0..whole.len()).step_by(step) {
        inputs.push((format!("cut off at {at}"), whole[..at].to_vec()));
        for byte in [0, 0xff, 0xc3] {
            let changed = [&whole[..at], &[byte], &whole[at..]].concat();
            inputs.push((format!("with {byte:#x} at {at}"), changed));
        }
    }
    inputs
}

/// Reads all inputs of a reader, one after the other, and returns the names of those that fail.
fn failures(reader: &Reader) -> Vec<String> {
    let mut failures = Vec::new();
    for (name, input) in inputs(reader) {
        let name = format!("{}: {name}", reader.name);
        let (send, answer) = mpsc::channel();
        let (read, start) = (reader.read, Instant::now());
        let thread = thread::Builder::new().stack_size(STACK).spawn(move || {
            let _ = read(&input);
            let _ = send.send(());
        });
        match answer.recv_timeout(PATIENCE) {
            Ok(()) => {}
            Err(mpsc::RecvTimeoutError::Timeout) => {
                // A thread cannot be ended: the next ones would be slow too.
                failures.push(format!("{name} takes more than {PATIENCE:?}"));
                return failures;
            }
            Err(mpsc::RecvTimeoutError::Disconnected) => failures.push(format!("{name} panics")),
        }
        drop(thread);
        if start.elapsed() > Duration::from_secs(2) {
            eprintln!("{name}: {:?}", start.elapsed());
        }
    }
    failures
}

#[test]
fn every_reader_answers_every_hostile_input() {
    // Threads that wait, and none of those on which readers share their work: all of these could wait for each other.
    let (readers, next) = (readers(), AtomicUsize::new(0));
    let work = || {
        let taken = iter::from_fn(|| readers.get(next.fetch_add(1, Ordering::Relaxed)));
        taken.flat_map(failures).collect::<Vec<_>>()
    };
    let failures: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..2).map(|_| scope.spawn(work)).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("it does not panic")).collect()
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn what_is_put_around_hostile_text_is_read() {
    // Otherwise the table would test only the first line of each file.
    for reader in readers() {
        let good = match reader.name {
            "steps" | "question" => "a\n",
            "equation" => "x = (1 + y)/2",
            "value" => "1",
            "own keys" => "\"save\": \"F4\"",
            "view block" => "active: A",
            "point block" => "knob: exposure",
            "task" => "probe.pinned",
            "photometric file"
            | "OBJ file"
            | "head of a photometric file"
            | "head of a picture of surroundings"
            | "size of a picture of surroundings"
            | "material"
            | "values of a material" => "",
            "primaries of a picture of surroundings" | "primaries of a linear picture to compare" => {
                ".64 .33 .3 .6 .15 .06 .3127 .329"
            }
            "vertex of an OBJ file" => "1 0",
            "condition" => "not ",
            "table" => "object,d,sphere,1,2 2 2\n",
            "list in a scene" => "{\"type\": \"point\", \"position\": [1, 1, 1]}, ",
            _ => continue,
        };
        let text = [reader.around[0].as_str(), good, &reader.around[1]].concat();
        let said = (reader.read)(text.as_bytes());
        let expected = match reader.name {
            // Without its answers; the reader reached them.
            "question" => "a question needs at least two answers",
            _ => "",
        };
        match said {
            Ok(()) => {}
            Err(what) => assert!(!expected.is_empty() && what.contains(expected), "{}: {what}", reader.name),
        }
    }
}

#[test]
fn meshes_that_are_far_away_huge_or_tiny_are_finite_or_refused() {
    const PLACES: [&str; 12] =
        ["0", "1", "-1", "1e30", "-1e30", "1e-30", "-1e-30", "1e38", "-3.4e38", "1e-45", "1e300", "1e-310"];
    let (mut state, mut drawn) = (1_u32, 0);
    let mut place = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        PLACES[(state >> 16) as usize % PLACES.len()]
    };
    let vertices = |text: [&str; 12]| -> String {
        text.chunks(3).map(|corner| format!("v {}\n", corner.join(" "))).collect()
    };
    for _ in 0..2000 {
        let text =
            vertices(std::array::from_fn(|_| place())) + "f 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\nf 1 2 3 4\n";
        match (mesh_file::FORMAT.read)(text.as_bytes()) {
            Ok(numbers) => {
                assert!(numbers.iter().all(|number| number.is_finite()), "{text}");
                drawn += 1;
            }
            Err(problem) => assert!(!problem.message.is_empty(), "{text}"),
        }
    }
    assert!(drawn > 100, "{drawn}");
    // Shapes of such sizes are the same shape.
    let tent = |unit: &str| {
        let text = format!(
            "v 0 0 0\nv {unit} 0 0\nv 0 {unit} 0\nv 0 0 {unit}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        );
        (mesh_file::FORMAT.read)(text.as_bytes()).map_err(|problem| problem.message)
    };
    for unit in ["1e30", "1e-30", "3e38", "1e-45"] {
        assert_eq!(tent(unit), tent("1"), "{unit}");
    }
}

/// Files that claim more than there is memory for, and pictures that need more.
#[cfg(target_os = "linux")]
#[test]
fn no_command_dies_of_a_lack_of_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("a.hdr", "#?RADIANCE\n\n-Y 8192 +X 8192\n");
    write(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 2000000\nproperty float x\nproperty float y\nproperty float z\n\
         element face 500000\nproperty list uchar int vertex_indices\nend_header\n",
    );
    let text = fs::read_to_string(root().join("scenes/default.json")).expect("readable");
    let mut room: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    room["objects"] = serde_json::json!([{ "type": "mesh", "path": "a.ply", "position": [5, 5, 5] }]);
    write("mesh.json", &room.to_string());
    for (arguments, expected) in [
        ("compare a.hdr a.hdr", "MiB of memory, which are not free"),
        ("check mesh.json", "the file ends before all 2000000"),
        ("render --renderer cpu --size 16384x16384 -o a.png", "MiB of memory, which are not free"),
        ("render --renderer cpu --size 8192x8192 -o a.exr", "MiB of memory, which are not free"),
    ] {
        let lcm = command_in(folder.path(), arguments.split(' '));
        let mut shell = std::process::Command::new("sh");
        shell
            .args(["-c", "ulimit -v 600000; exec \"$@\"", "sh"])
            .arg(lcm.get_program())
            .args(lcm.get_args())
            .current_dir(folder.path())
            .env("LCM_DATA_DIR", folder.path().join("none"));
        let ended = shell.output().expect("it runs");
        let said = String::from_utf8_lossy(&ended.stderr);
        assert!(ended.status.code() == Some(1) && said.contains(expected), "{arguments}: {said}");
    }
}

#[test]
fn a_folder_without_end_is_looked_through_up_to_a_limit() {
    let scene = Scene::default();
    let axis = Axis::vary("objects[0].size=1,2", &scene, &REGISTRY).expect("two values");
    let sweep = Sweep::new(&scene, 0, vec![axis], &REGISTRY).expect("valid");
    let endless = iter::repeat_with(|| OsString::from("another.png"));
    assert_eq!(sweep.strangers(endless), 100_000);
    let names = ["1_size_1.png", "3_size_3.png", "notes.txt"].map(OsString::from);
    assert_eq!(sweep.strangers(names), 1);
}
