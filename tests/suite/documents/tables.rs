//! The documents: their tables match the registry, their examples match the program, and the tour of the
//! README is right.

use std::{fs, io, sync::atomic::AtomicBool};

use glam::Vec3;
use lights_camera_models::{
    caption::{self, Sampled},
    channel::DebugChannel,
    compare::metric::{self, Metric},
    curves::Kind,
    explain,
    lesson::{self, Lesson},
    light::{MAX_LIGHTS, ies, panorama},
    matching::{Metric as LobeMetric, What},
    optics::{Frame, colour::Encoding},
    panel::{Panels, command::declared, state::Session},
    parameter::{MAX_FILES_BYTES, MAX_FILES_NUMBERS, Meaning, Outside, Parameter, Side, Value, Values},
    picture::png,
    progress::Progress,
    reference::{self, Settings, Until},
    reflection::ModelEntry,
    registry::Registry,
    render::capture::evaluate::evaluate,
    scene::{
        MAX_OBJECTS, Scene,
        comparison::{Channel, Compared, Layout, Sign},
        examples::EXAMPLES,
        formats::{Csv, column_table},
        load::{self, Defaults},
        save, schema,
    },
    shader::{
        compose::Sources,
        limits::{LIMITS, LONGEST_WORD},
    },
    shape::mesh_file,
    text::mathematics,
};
use serde_json::Value as Json;

use crate::{
    helpers::pictures::sampled,
    helpers::support::root,
    library::plugins::window::toon as example,
    renderers::golden::{SAME_RENDERER, read_png, updating},
};

#[test]
fn gouraud_shading_loses_the_highlight_as_the_tour_says() {
    let readme = fs::read_to_string(root().join("README.md")).expect("there");
    let number = |after: &str| {
        let digits: String = readme.split(after).nth(1)?.chars().take_while(char::is_ascii_digit).collect();
        digits.parse::<u32>().ok()
    };
    let tessellation = number("set the tessellation to ").expect("says it");
    let alpha = number("and α to ").expect("says it");
    // The brightest pixel of the sphere of the default scene.
    let brightest = |shading: &str| {
        let mut scene = Scene {
            reflection_model: "blinn_phong".to_owned(),
            shading_model: shading.to_owned(),
            ..Scene::default()
        };
        scene.objects[0].tessellation = Some(tessellation);
        scene.objects[0].material.set("alpha", Value::Integer(alpha.into()));
        let settings = Settings { width: 640, height: 360, ..Settings::default() };
        let picture = reference::render_rgb8(&scene, &Registry::builtin(), &settings);
        picture.into_iter().max().expect("has pixels")
    };
    assert_eq!(brightest("phong"), 255, "there is a highlight");
    assert!(brightest("gouraud") < 240, "it is lost");
}

#[test]
fn the_glossary_names_all_light_types_object_types_and_terms() {
    let text = fs::read_to_string(root().join("docs/README.md")).expect("there");
    let row = |word: &str| {
        let start = format!("| {word} |");
        text.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("no {word}"))
    };
    let registry = Registry::builtin();
    for light in registry.lights() {
        assert!(row("light type").contains(light.declaration.id), "{}", light.declaration.id);
    }
    for shape in registry.shapes() {
        assert!(row("object type").contains(shape.declaration.id), "{}", shape.declaration.id);
    }
    for term in ["ambient", "diffuse", "specular", "transmitted"] {
        assert!(row("term").contains(term), "{term}");
    }
    assert!(!row("response").contains('_'), "it is set as mathematics");
}

/// Number of portraits side by side in the gallery.
const GALLERY_COLUMNS: usize = 4;

/// Rows of a table, with a heading.
fn table(heading: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let heading: Vec<_> = heading.iter().map(|h| (*h).to_owned()).collect();
    let rule = format!("|{}\n", "---|".repeat(heading.len()));
    std::iter::once(line(&heading)).chain([rule]).chain(rows.map(|r| line(&r))).collect()
}

fn code(id: &str) -> String {
    format!("`{id}`")
}

/// The tables and examples generated from the program, by page and name of their position.
fn sections() -> Vec<(&'static str, Vec<(&'static str, String)>)> {
    let registry = Registry::builtin();
    let example = |file: &str, language: &str| {
        let text = fs::read_to_string(root().join("examples").join(file)).expect("the example is there");
        format!("```{language}\n{text}```\n")
    };
    let default = save::to_json(&Scene::default(), None, &registry);
    vec![
        (
            "docs/scenes.md",
            vec![
                ("default.json", format!("```json\n{}\n```\n", default.trim_end())),
                ("fields", fields(&schema::schema(&registry))),
                ("colour_wheel.csv", {
                    let text = fs::read_to_string(root().join("scenes/colour_wheel.csv")).expect("there");
                    format!("```csv\n{text}```\n")
                }),
                ("columns", column_table(&registry)),
                ("limits", scene_limits()),
                ("tone mapping", tone_mapping(&schema::schema(&registry))),
                ("scenes", scenes()),
            ],
        ),
        (
            "docs/reflection-models.md",
            vec![
                ("gallery", gallery(&registry)),
                ("models", models(&registry)),
                ("parameters", parameters(&registry)),
                ("meanings", meanings(&registry)),
            ],
        ),
        (
            "docs/shading-and-lights.md",
            vec![
                ("shading models", shading_models(&registry)),
                ("lights", lights(&registry)),
                ("shapes", shapes(&registry)),
            ],
        ),
        ("docs/window.md", vec![("channels", channels()), ("quantities", quantities_of_plots())]),
        ("docs/keys.md", vec![("commands", commands(&registry))]),
        (
            "docs/comparing.md",
            vec![
                ("layouts", layouts()),
                ("differences", differences()),
                ("metrics", metrics()),
                ("match", matches()),
                ("lobe metrics", lobe_metrics()),
            ],
        ),
        (
            "docs/command-line.md",
            vec![
                ("noise", noise()),
                ("channels", ids_of_channels()),
                ("explain", explained()),
                ("kinds of plots", kinds_of_plots()),
            ],
        ),
        ("docs/worked-examples.md", worked_examples(&registry)),
        (
            "docs/lessons.md",
            vec![
                ("lesson.md", {
                    let text = fs::read_to_string(root().join("examples/lesson.md")).expect("there");
                    format!("````markdown\n{text}````\n")
                }),
                ("view settings", view_settings()),
                ("controls", lesson_controls()),
                ("quantities", quantities()),
                ("limits", lesson_limits()),
            ],
        ),
        ("docs/custom-models.md", vec![("limits", limits())]),
        (
            "docs/extending/reflection-model.md",
            vec![("toon.wgsl", example("toon.wgsl", "wgsl")), ("toon.rs", example("toon.rs", "rust"))],
        ),
        (
            "docs/extending/light-type.md",
            vec![
                ("light.rs", example("light.rs", "rust")),
                ("light.wgsl", example("light.wgsl", "wgsl")),
                ("lamp.rs", example("lamp.rs", "rust")),
                ("lamp.wgsl", example("lamp.wgsl", "wgsl")),
            ],
        ),
        ("docs/extending/object-type.md", vec![("shape.rs", example("shape.rs", "rust"))]),
        (
            "docs/extending/shading-model.md",
            vec![
                ("shading_model.rs", example("shading_model.rs", "rust")),
                ("shading_model.wgsl", example("shading_model.wgsl", "wgsl")),
            ],
        ),
        ("docs/extending/panel.md", vec![("panel.rs", example("panel.rs", "rust"))]),
        ("docs/extending/systems.md", vec![("animate.rs", example("animate.rs", "rust")), ("sets", sets())]),
        ("docs/extending/scene-format.md", vec![("format.rs", example("format.rs", "rust"))]),
        ("docs/extending/metric.md", vec![("metric.rs", example("metric.rs", "rust"))]),
        (
            "docs/extending/another-crate.md",
            vec![
                ("extension", extension()),
                ("extension/src/main.rs", example("extension/src/main.rs", "rust")),
                ("parts", parts()),
            ],
        ),
        ("README.md", vec![("window.rs", example("window.rs", "rust"))]),
        ("docs/extending.md", vec![("window.rs", example("window.rs", "rust"))]),
        ("docs/architecture.md", vec![("modules", modules())]),
    ]
}

/// The quantities of plots.
fn kinds_of_plots() -> String {
    let row = |kind: Kind| vec![code(kind.id()), kind.declaration().row.to_owned()];
    table(&["`--kind`", "curve"], Kind::ALL.into_iter().map(row))
}

/// The quantities of plots as the window calls them.
fn quantities_of_plots() -> String {
    let row = |kind: Kind| kind.declaration().choice.map(str::to_owned).to_vec();
    table(&["quantity", "curve"], Kind::ALL.into_iter().map(row))
}

/// The commands, with their usual keys and their places in menus.
fn commands(registry: &Registry) -> String {
    let mut session = Session::default();
    session.panels = Panels::builtin().infos().collect();
    let root = declared(&session, registry, true, false);
    let named = root.commands().into_iter().filter(|(_, command)| !command.id.starts_with("recent_model."));
    let rows = named.map(|(path, command)| {
        let keys: Vec<_> = command.keys.iter().map(ToString::to_string).collect();
        vec![code(&command.id), command.title(&path), keys.join(", "), path.join(" › ")]
    });
    table(&["id", "command", "keys", "menu"], rows)
}

/// The noise of a scene by the number of samples.
fn noise() -> String {
    let (path, registry) = (root().join("scenes/softbox_and_lamps.json"), Registry::builtin());
    let scene = load::file(&path, &registry, Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let settings = Settings { width: 80, height: 45, samples: 4, ..Settings::default() };
    let row = |samples: u32| {
        let (odd, until) = (AtomicBool::default(), Until { samples, noise: None });
        let reached = reference::render_until(&scene, &registry, &settings, until, &odd, &Progress::NONE)
            .expect("nobody cancels")
            .1;
        let words = caption::line(&caption::sampled(&[Sampled { samples, noise: reached.noise }]));
        let noise = words.split_once("noise ").expect("it is known").1.to_owned();
        vec![samples.to_string(), noise]
    };
    table(&["`--light-samples`", "noise"], [64, 128, 256, 512, 1024].into_iter().map(row))
}

/// The worked example of a pixel.
fn explained() -> String {
    let (path, registry) = (root().join("scenes/compare_phong_blinn_phong.json"), Registry::builtin());
    let scene = load::file(&path, &registry, Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let explained = explain::pixel(&scene, &registry, &Settings::default(), [780, 220]);
    format!("```text\n{}```\n", explained.expect("in the picture").to_text())
}

/// One pixel for each family of models.
fn worked_examples(registry: &Registry) -> Vec<(&'static str, String)> {
    let settings = Settings { width: 1280, height: 720, ..Settings::default() };
    let example = |id: &'static str| {
        let mut scene = Scene { reflection_model: id.to_owned(), ..Scene::default() };
        scene.shading_model = "phong".to_owned();
        let material = &mut scene.objects[0].material;
        material.set("base_colour", Value::Colour([200, 120, 60]));
        if id == "microfacet" {
            for (name, choice) in [("fresnel", "conductor"), ("diffuse", "none")] {
                material.set(name, Value::Choice(choice.into()));
            }
            material.set("ior", Value::Triple([0.16, 0.42, 1.43]));
            material.set("extinction", Value::Triple([3.9, 2.4, 1.9]));
        }
        let explained = explain::pixel(&scene, registry, &settings, [600, 330]).expect("in the picture");
        (id, format!("```text\n{}```\n", explained.to_text()))
    };
    let mut all =
        ["blinn_phong", "ashikhmin_shirley", "oren_nayar", "microfacet", "openpbr"].map(example).to_vec();
    // Light through a body comes from what is around it.
    let file = root().join("scenes/glass_ball.json");
    let scene = load::file(&file, registry, Defaults::Refuse).expect("shipped").scene;
    let explained = explain::pixel(&scene, registry, &settings, [600, 300]).expect("in the picture");
    all.push(("glass", format!("```text\n{}```\n", explained.to_text())));
    all
}

/// The numbers for the difference between two pictures.
fn metrics() -> String {
    let row = |metric: &&Metric| {
        let cells = metric.row?.map(str::to_owned);
        Some([code(metric.id)].into_iter().chain(cells).collect())
    };
    table(&["key", "metric", "range", "equal pictures"], metric::ALL.iter().filter_map(row))
}

/// The quantities compared by a match.
fn matches() -> String {
    let row = |what: &What| vec![code(what.id()), what.summary().to_owned(), what.unit().to_owned()];
    table(&["`--on`", "what is compared", "error"], What::ALL.iter().map(row))
}

/// The metrics of lobes.
fn lobe_metrics() -> String {
    let row = |metric: &LobeMetric| {
        [code(metric.id()), metric.summary().to_owned(), metric.unit().to_owned(), metric.source().to_owned()]
            .to_vec()
    };
    table(&["`--metric`", "what the difference is of", "error", "source"], LobeMetric::ALL.iter().map(row))
}

/// The additions of the example crate, with their files.
fn extension() -> String {
    let row = |(what, files): (&str, &[&str])| {
        let lines = |file: &&str| {
            let path = root().join("examples/extension").join(file);
            fs::read_to_string(path).expect("the example is there").lines().count()
        };
        let names: Vec<_> =
            files.iter().map(|file| format!("[{file}](../../examples/extension/{file})")).collect();
        vec![what.to_owned(), names.join(", "), files.iter().map(lines).sum::<usize>().to_string()]
    };
    let rows = [
        ("a reflection model", &["src/sheen.rs", "src/sheen.wgsl"][..]),
        ("a shading model with a parameter", &["src/lazy.rs", "src/lazy.wgsl"]),
        ("a light type with a colour and a number", &["src/beacon.rs", "src/beacon.wgsl"]),
        ("an object type with two parameters", &["src/blossom.rs"]),
        ("a panel with state", &["src/meter.rs"]),
        ("the program, a system that swings spotlights, tests", &["src/main.rs"]),
        ("the rest", &["Cargo.toml", "scene.json"]),
    ];
    table(&["addition", "files", "lines"], rows.into_iter().map(row))
}

/// The parts of the window, from the documentation of the plugin group.
fn parts() -> String {
    let text = fs::read_to_string(root().join("src/window/plugins.rs")).expect("there");
    let plain = |line: &str| line.replace("[`", "`").replace("`]", "`");
    text.lines()
        .filter_map(|line| line.strip_prefix("/// |"))
        .map(|line| format!("|{}\n", plain(line)))
        .collect()
}

/// The sets by which systems can be ordered, from their documentation.
fn sets() -> String {
    let text = fs::read_to_string(root().join("src/render/schedule.rs")).expect("there");
    let body =
        text.split("pub enum LabSystems {").nth(1).and_then(|t| t.split("\n}").next()).expect("an enum");
    let lines: Vec<_> = body.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    let rows = lines.chunks(2).map(|pair| {
        let [help, name] = pair else { panic!("each set has one sentence: {pair:?}") };
        let help = help.strip_prefix("/// ").unwrap_or_else(|| panic!("{name} has one sentence: {help}"));
        vec![code(&format!("LabSystems::{}", name.trim_end_matches(','))), help.to_owned()]
    });
    table(&["set", "work"], rows)
}

fn models(registry: &Registry) -> String {
    let rows = registry.models().iter().map(|m| {
        let d = m.declaration;
        let parameter = |p: &Parameter| match p.used_when {
            Some(u) => format!(
                "{} (with {})",
                code(p.name),
                u.choices.iter().map(|c| code(c)).collect::<Vec<_>>().join("/")
            ),
            None => code(p.name),
        };
        let parameters: Vec<_> = m.parameters.iter().map(parameter).collect();
        let kept: Vec<_> = d.laws.list().iter().filter(|(_, kept)| *kept).map(|(law, _)| *law).collect();
        vec![
            code(d.id),
            d.name.into(),
            d.author.into(),
            d.summary.into(),
            parameters.join(", "),
            kept.join(", "),
        ]
    });
    table(&["id", "name", "author", "description", "parameters", "laws kept"], rows)
}

fn parameters(registry: &Registry) -> String {
    let rows = registry.material_parameters().map(|p| {
        let symbol = p.symbol.replace('|', "\\|");
        let unit = if p.unit.is_empty() { String::new() } else { format!(" ({})", p.unit) };
        vec![
            code(p.name),
            symbol,
            format!("{}{unit}", p.label),
            p.rule(),
            code(&p.default_value().to_string()),
        ]
    });
    table(&["name", "symbol", "meaning", "values", "default"], rows)
}

/// What parameters stand for: the common quantity, the scale, its source, and the parameters that have it.
fn meanings(registry: &Registry) -> String {
    let rows = Meaning::ALL.iter().map(|one| {
        let mut names: Vec<&str> = registry
            .models()
            .iter()
            .flat_map(|m| m.parameters)
            .filter(|p| p.stands_for == Some(one))
            .map(|p| p.name)
            .collect();
        names.sort_unstable();
        names.dedup();
        let side = match one.side {
            Side::Both => "",
            Side::Along => ", along the tangent",
            Side::Across => ", across the tangent",
        };
        vec![
            code(one.id),
            names.into_iter().map(code).collect::<Vec<_>>().join(", "),
            format!("{}{side}", one.quantity),
            one.formula.to_owned(),
            one.source.to_owned(),
        ]
    });
    table(&["id", "parameters", "quantity", "its value", "source"], rows)
}

fn shading_models(registry: &Registry) -> String {
    let rows = registry.shading_models().iter().map(|m| {
        let d = m.declaration;
        vec![code(d.id), d.name.into(), d.author.into(), d.stage.phrase().into(), d.summary.into()]
    });
    table(&["id", "name", "author", "calculates", "what to look for"], rows)
}

fn lights(registry: &Registry) -> String {
    let rows = registry.lights().iter().map(|l| {
        let d = l.declaration;
        let mut fields = vec![];
        fields.extend(d.has_position.then(|| code("position")));
        fields.extend(d.has_direction.then(|| code("direction")));
        fields.extend(l.parameters.iter().map(|p| code(p.name)));
        vec![code(d.id), d.summary.into(), format!("`{}`", d.equation), d.unit.into(), fields.join(", ")]
    });
    table(&["id", "description", "light at a point", "unit", "fields"], rows)
}

fn shapes(registry: &Registry) -> String {
    let rows = registry.shapes().iter().map(|s| {
        let d = s.declaration;
        let (from, to) = (d.tessellation.start(), d.tessellation.end());
        let tessellation = format!("{from}–{to}, default {}", d.default_tessellation);
        let parameters: Vec<_> = s.parameters.iter().map(|p| code(p.name)).collect();
        vec![code(d.id), d.summary.into(), parameters.join(", "), tessellation, d.tessellation_help.into()]
    });
    table(&["id", "description", "parameters", "tessellation", "meaning"], rows)
}

fn gallery(registry: &Registry) -> String {
    let rows = registry.models().chunks(GALLERY_COLUMNS).flat_map(|models| {
        let pictures = models
            .iter()
            .map(|m| format!("![{0}](images/models/{1}.png)", m.declaration.name, m.declaration.id));
        let names = models.iter().map(|m| code(m.declaration.id));
        [pictures.collect::<Vec<_>>(), names.collect()]
    });
    let whole = |mut row: Vec<String>| {
        row.resize(GALLERY_COLUMNS, String::new());
        row
    };
    table(&[""; GALLERY_COLUMNS], rows.map(whole))
}

/// The fields of scene files, from the schema.
fn fields(schema: &Json) -> String {
    let mut rows = Vec::new();
    let object = &schema["properties"]["objects"]["items"];
    let row = &object["properties"]["repeat"];
    for (prefix, part) in [
        ("", schema),
        ("scene_size.", &schema["properties"]["scene_size"]),
        ("lights[].", &schema["properties"]["lights"]["items"]),
        ("observer.", &schema["properties"]["observer"]),
        ("objects[].", object),
        ("objects[].repeat.", row),
        ("objects[].repeat.vary[].", &row["properties"]["vary"]["items"]),
        ("display.", &schema["properties"]["display"]),
    ] {
        let required: Vec<_> = part["required"].as_array().into_iter().flatten().collect();
        let is_required = |name: &str| required.iter().any(|r| *r == name);
        let known = part["properties"].as_object().expect("an object");
        let (needed, free): (Vec<_>, Vec<_>) = known.iter().partition(|(name, _)| is_required(name));
        for (name, field) in needed.into_iter().chain(free) {
            let default = &field["default"];
            let without = match (is_required(name), default) {
                (true, Json::Null) if name == "scene_size" => "after asking".to_owned(),
                (true, Json::Null) => "required".to_owned(),
                (true, _) => format!("{}, after asking", code(&default.to_string())),
                (false, Json::Null) => String::new(),
                (false, _) => code(&default.to_string()),
            };
            let meaning = field["description"].as_str().expect("every field is described");
            rows.push(vec![code(&format!("{prefix}{name}")), meaning.to_owned(), range(field), without]);
        }
    }
    table(&["field", "meaning", "range", "default"], rows.into_iter())
}

/// The range of a numeric field.
fn range(field: &Json) -> String {
    let number = |key: &str| field[key].as_number().map(ToString::to_string);
    match (number("minimum"), number("exclusiveMinimum"), number("maximum")) {
        (Some(min), _, Some(max)) => format!("{min} to {max}"),
        (Some(min), _, None) => format!("{min} or more"),
        (None, Some(above), Some(max)) => format!("above {above}, up to {max}"),
        _ => String::new(),
    }
}

/// The layouts of comparisons.
fn layouts() -> String {
    let rows = Layout::ALL.iter().map(|layout| vec![code(layout.id()), layout.summary().to_owned()]);
    table(&["layout", "picture"], rows)
}

/// The choices for differences.
fn differences() -> String {
    let mut rows = Vec::new();
    macro_rules! list {
        ($($option:literal $of:ident,)+) => {
            $(for choice in $of::ALL {
                rows.push([$option, choice.id(), choice.summary()]);
            })+
        };
    }
    list! { "--sign" Sign, "--channel" Channel, "--values" Compared, }
    let rows =
        rows.into_iter().map(|[option, id, help]| vec![code(&format!("{option} {id}")), help.to_owned()]);
    table(&["option", "number of a pixel"], rows)
}

fn tone_mapping(schema: &Json) -> String {
    let field = &schema["properties"]["display"]["properties"]["tone_mapping"];
    let texts = |key: &str| {
        let list = field[key].as_array().expect("a list").iter();
        list.map(|text| text.as_str().expect("a text").to_owned()).collect::<Vec<_>>()
    };
    let rows = texts("enum").into_iter().zip(texts("enumDescriptions")).map(|(id, help)| {
        let (name, help) = help.split_once(": ").expect("a name");
        vec![code(&id), name.to_owned(), help.to_owned()]
    });
    table(&["`tone_mapping`", "name", "effect"], rows)
}

fn scenes() -> String {
    let rows = EXAMPLES.iter().map(|e| {
        let (name, _) = e.file.split_once('.').expect("an extension");
        let link = format!("[{name}](../scenes/{})", e.file);
        vec![link, e.description.clone()]
    });
    table(&["scene", "description"], rows)
}

/// The limits of a shader.
fn limits() -> String {
    let l = LIMITS;
    let kib = |bytes: u64| format!("{} KiB", bytes >> 10);
    let rows = [
        ("composed text, imports included", format!("{} MiB", l.bytes >> 20)),
        ("words and symbols of that text", l.tokens.to_string()),
        ("a name or a number", format!("{LONGEST_WORD} bytes")),
        ("statements", l.statements.to_string()),
        ("functions, constants, types and module variables", l.declarations.to_string()),
        ("a chain of these, each of which uses the next", l.chain.to_string()),
        ("words of one of these, with the constants and types in it written out", l.expansion.to_string()),
        ("words of all of these, likewise", (4 * l.expansion).to_string()),
        ("brackets within brackets", l.nesting.to_string()),
        ("operators and calls on one path through an expression", l.depth.to_string()),
        ("blocks within blocks (each `else if` counts as one)", l.blocks.to_string()),
        ("loops within loops", l.loops.to_string()),
        ("cases of a `switch`", l.cases.to_string()),
        ("elements of an array", l.elements.to_string()),
        ("a value", kib(l.value_bytes.into())),
        ("all variables of a function and the functions that it calls", kib(l.variable_bytes)),
        ("all module variables; all constants", kib(l.variable_bytes)),
        ("expressions of a function", l.expressions.to_string()),
        ("a chain of values, each calculated from the one before", l.values.to_string()),
        ("steps of a function, with all calls inlined", l.steps.to_string()),
    ];
    table(&["limit of", "at most"], rows.into_iter().map(|(what, most)| vec![what.to_owned(), most]))
}

/// The limits of a lesson.
fn lesson_limits() -> String {
    use lesson::limits::{
        DEEPEST_CONDITION, LONGEST_CONDITION, LONGEST_STEP, LONGEST_TITLE, MAX_COMPARISONS, MAX_FILE_BYTES,
        MAX_LINES, MAX_PARTS, MAX_PROBLEMS, MAX_STEPS,
    };
    let rows = [
        ("the file", format!("{} MiB", MAX_FILE_BYTES >> 20)),
        ("steps", MAX_STEPS.to_string()),
        ("a title, the summary", format!("{LONGEST_TITLE} characters")),
        ("the text of a step, with equations and its task", format!("{LONGEST_STEP} characters")),
        ("a line of an equation", format!("{} characters", mathematics::LONGEST_LINE)),
        ("brackets within brackets of an equation", mathematics::MAX_DEPTH.to_string()),
        ("values that a `scene` block sets, lines of `view` and `point`", MAX_LINES.to_string()),
        ("steps of a path in a `scene` block, lists within lists of a value", load::MAX_DEPTH.to_string()),
        ("objects and lights in the scenes of all steps that change theirs, together", MAX_PARTS.to_string()),
        ("a condition", format!("{LONGEST_CONDITION} characters, {MAX_COMPARISONS} comparisons")),
        ("brackets and negations within each other in a condition", DEEPEST_CONDITION.to_string()),
        ("problems that the check prints", MAX_PROBLEMS.to_string()),
    ];
    table(&["limit of", "at most"], rows.into_iter().map(|(what, most)| vec![what.to_owned(), most]))
}

/// The limits of scenes and of the files that they name.
fn scene_limits() -> String {
    let mib = |bytes: u64| format!("{} MiB", bytes >> 20);
    let rows = [
        ("a scene file", mib(load::MAX_FILE_BYTES)),
        (
            "a picture with a scene in it",
            format!("{}; the scene in it {}", mib(load::MAX_PICTURE_BYTES), mib(load::MAX_FILE_BYTES)),
        ),
        ("lists and objects within each other in JSON", load::MAX_DEPTH.to_string()),
        ("values in JSON", load::MAX_VALUES.to_string()),
        ("rows of a table", format!("{}, not counting remarks", Csv::MAX_ROWS)),
        ("columns of a table", Csv::MAX_COLUMNS.to_string()),
        ("cells and remarks of a table", Csv::MAX_CELLS.to_string()),
        ("objects, lights", format!("{MAX_OBJECTS}, {MAX_LIGHTS}")),
        (
            "all files that a scene names",
            format!("{}, {} numbers in them", mib(MAX_FILES_BYTES), MAX_FILES_NUMBERS),
        ),
        ("the file of a mesh", mib(mesh_file::FORMAT.max_bytes)),
        (
            "vertices, polygons, corners of a polygon of a mesh",
            format!("{}, {}, {}", mesh_file::MAX_VERTICES, mesh_file::MAX_POLYGONS, mesh_file::MAX_CORNERS),
        ),
        (
            "a photometric file",
            format!("{}, {} candela values", mib(ies::FORMAT.max_bytes), ies::MAX_CANDELAS),
        ),
        (
            "a picture of surroundings",
            format!(
                "{}, {} × {} pixels",
                mib(panorama::FORMAT.max_bytes),
                panorama::MAX_FILE_COLUMNS,
                panorama::MAX_FILE_COLUMNS / 2
            ),
        ),
    ];
    table(&["limit of", "at most"], rows.into_iter().map(|(what, most)| vec![what.to_owned(), most]))
}

/// The kind of picture that a channel shows.
fn shows(channel: DebugChannel) -> String {
    let what = match channel {
        wires if wires.has_wires() => "lines and dots",
        light if light.is_of_light() => "light",
        _ => "geometry",
    };
    if channel.has_light() { format!("{what}, one light") } else { what.to_owned() }
}

/// The debug channels.
fn channels() -> String {
    let row = |c: DebugChannel| vec![c.name().to_owned(), shows(c), c.explanation().to_owned()];
    table(&["channel", "shows", "picture"], DebugChannel::ALL.into_iter().map(row))
}

/// The debug channels by their ids.
fn ids_of_channels() -> String {
    let row = |c: DebugChannel| vec![code(c.id()), c.name().to_owned(), shows(c)];
    table(&["`--channel`", "channel", "shows"], DebugChannel::ALL.into_iter().map(row))
}

/// The modules as `lib.rs` lists them.
fn modules() -> String {
    let lib = fs::read_to_string(root().join("src/lib.rs")).expect("there");
    let text: Vec<_> = lib.lines().map_while(|l| l.strip_prefix("//!")).map(str::trim).collect();
    let joined = text.join("\n").replace("\n- ", "\n\n- ");
    let items = joined.split("\n\n").filter_map(|item| item.trim().strip_prefix("- "));
    let rows = items.map(|item| {
        let (names, job) = item.split_once(": ").expect("a module and its job");
        let names = names.replace("[`mod@", "`").replace("[`", "`").replace("`]", "`");
        vec![names, job.trim().trim_end_matches('.').replace('\n', " ")]
    });
    let table = table(&["module", "job"], rows);
    for module in lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')) {
        assert!(table.contains(&code(module)), "the documentation of lib.rs lacks {module}");
    }
    table
}

/// The settings of a lesson's `view` block.
fn view_settings() -> String {
    let rows = lesson::SETTINGS
        .iter()
        .map(|(key, values, meaning)| vec![code(key), (*values).to_owned(), (*meaning).to_owned()]);
    table(&["setting", "values", "meaning"], rows)
}

/// The controls that a lesson can highlight.
fn lesson_controls() -> String {
    let all = |names: &[&str]| names.iter().map(|name| code(name)).collect::<Vec<_>>().join(", ");
    let rows = [
        (
            "knob",
            "the name of a parameter in scene files, or one of ".to_owned() + &all(lesson::KNOBS),
            "its knob at the right",
        ),
        ("menu", all(lesson::MENUS), "a menu at the top"),
        ("button", all(lesson::BUTTONS), "the buttons above the picture"),
        ("tab", all(lesson::TABS), "a tab below the picture"),
        (
            "part",
            "`room`, `observer`, `object 1`, `light \"key light\"`, …".to_owned(),
            "its line in the list at the left",
        ),
        (
            "line",
            all(lesson::VALUES),
            "the line of *Explain* that gives this value, under *Through the surface*",
        ),
    ];
    let rows = rows.map(|(kind, names, what)| vec![code(kind), names, what.to_owned()]);
    table(&["control", "names", "what is highlighted"], rows.into_iter())
}

/// The quantities of conditions.
fn quantities() -> String {
    let rows =
        lesson::QUANTITIES.iter().map(|q| vec![code(q.name), q.kind.name().to_owned(), q.meaning.to_owned()]);
    table(&["quantity", "type", "value"], rows)
}

#[test]
fn the_lesson_of_the_manual_is_sound() {
    let registry = Registry::builtin();
    let lesson = Lesson::read(&root().join("examples/lesson.md"), &registry, Outside::NONE).expect("sound");
    assert!(lesson.steps.len() > 2 && lesson.steps.iter().filter(|step| step.task.is_some()).count() > 1);
    // The manual has every kind of block.
    let manual = fs::read_to_string(root().join("docs/lessons.md")).expect("there");
    for block in ["equation", "scene", "view", "point", "predict", "do", "find"] {
        assert!(manual.contains(&format!("```{block}\n")), "{block}");
    }
}

#[test]
fn the_tables_and_examples_of_the_documents_are_up_to_date() {
    for (document, sections) in sections() {
        let path = root().join(document);
        let old = fs::read_to_string(&path).expect("the document is there");
        let mut text = old.clone();
        for (name, content) in sections {
            let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
            let start = text.find(&open).unwrap_or_else(|| panic!("{document} lacks {open}")) + open.len();
            let end =
                text[start..].find(&close).unwrap_or_else(|| panic!("{document} lacks {close}")) + start;
            text.replace_range(start..end, &format!("\n{content}\n"));
        }
        if updating() {
            fs::write(&path, &text).expect("the document can be written");
        } else {
            assert!(text == old, "{document} is not up to date; run the tests once with LCM_UPDATE=1");
        }
    }
}

#[test]
fn the_readme_is_short_and_counts_right() {
    let readme = fs::read_to_string(root().join("README.md")).expect("there");
    assert!(readme.lines().count() <= 150);
    let registry = Registry::builtin();
    for said in [
        format!("{} reflection models", registry.models().len()),
        format!("{} shading\n  models", registry.shading_models().len()),
        format!("{} light types", registry.lights().len()),
    ] {
        assert!(readme.contains(&said), "{said}");
    }
}

#[test]
fn the_gallery_shows_every_model_as_it_is() {
    let registry = Registry::builtin();
    let path = root().join("scenes/portrait.json");
    let mut scene = load::file(&path, &registry, Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let settings = reference::Settings { width: 240, height: 180, ..reference::Settings::default() };
    let mut portraits = Vec::new();
    for model in registry.models() {
        scene.reflection_model = model.declaration.id.to_owned();
        let picture = sampled(&scene, &registry, &settings, 64);
        let path = root().join(format!("docs/images/models/{}.png", model.declaration.id));
        let agrees = || {
            read_png(&path).is_ok_and(|(width, height, old)| {
                (width, height) == (settings.width, settings.height)
                    && SAME_RENDERER.broken(&picture, &old).is_none()
            })
        };
        if updating() && !agrees() {
            fs::create_dir_all(root().join("docs/images/models")).expect("the folder can be made");
            png::write(&path, settings.width, settings.height, &picture, &png::About::default())
                .expect("the picture can be written");
        }
        assert!(agrees(), "{} is not what the model looks like; accept with LCM_UPDATE=1", path.display());
        portraits.push((model.declaration.id, picture));
    }
    for (i, (a, one)) in portraits.iter().enumerate() {
        for (b, other) in &portraits[i + 1..] {
            assert!(SAME_RENDERER.broken(one, other).is_some(), "{a} and {b} look the same");
        }
    }
}

#[test]
fn pictures_of_scenes_are_called_as_their_scenes() {
    let folder = root().join("docs/images");
    let mut found = 0;
    for entry in fs::read_dir(folder).expect("there") {
        let path = entry.expect("readable").path();
        if path.extension().is_none_or(|extension| extension != "png") {
            continue;
        }
        let file = io::BufReader::new(fs::File::open(&path).expect("readable"));
        let picture = ::png::Decoder::new(file).read_info().expect("a PNG file");
        let texts = &picture.info().uncompressed_latin1_text;
        let text = |keyword: &str| texts.iter().find(|t| t.keyword == keyword).map(|t| t.text.as_str());
        let Some(source) = text("Source") else { continue };
        let scene =
            load::file(&root().join(source), &Registry::builtin(), Defaults::Use).expect("valid").scene;
        assert_eq!(text("Title"), scene.name.as_deref(), "{}: render it again", path.display());
        found += 1;
    }
    assert!(found >= 3, "{found} pictures");
}

#[test]
fn the_model_of_the_example_is_the_same_in_rust_and_in_wgsl() {
    let model = ModelEntry::of::<example::Toon>();
    let values = Values::default();
    let frame = Frame::LOCAL;
    // Away from the edges of the tones, where the last bit decides.
    let directions = (0..4).map(|i| 0.125 + 0.25 * i as f32);
    let pairs: Vec<_> = directions.map(|z: f32| (Vec3::new((1.0 - z * z).sqrt(), 0.0, z), Vec3::Z)).collect();
    let answers = evaluate(&Sources::default(), &model, &values, Encoding::Srgb, &pairs)
        .expect("software Vulkan is installed");
    let surface = model.instantiate(&values, Encoding::Srgb);
    for (i, ((l, v), gpu)) in pairs.iter().zip(answers).enumerate() {
        let cpu = surface.response(*l, *v, &frame).diffuse;
        assert!((cpu - 0.25 * (i as f32 + 1.0)).abs().max_element() < 1e-6, "{l}: {cpu}");
        assert!((gpu.diffuse - cpu).abs().max_element() < 1e-6, "{l}: GPU {}, CPU {cpu}", gpu.diffuse);
    }
}
