//! A corpus of hostile models: short files that would crash or freeze their readers. Each is refused with its
//! position and the limit, within bounds on time and memory, and the rest of the folder keeps working.

use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
    process::{Child, Stdio},
    thread,
    time::{Duration, Instant},
};

use lights_camera_models::{
    custom,
    registry::{
        Registry,
        compose::{compose, compose_evaluation},
    },
    shader::{
        check::{ShaderProblem, validate},
        compose::Sources,
        limits,
    },
};

use crate::helpers::support::{command_in, lcm_in, root};

/// The stack size of a Bevy thread.
const STACK: usize = 2 << 20;
/// Maximum duration of a single case, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// A model whose response is `y`; `items` come before the function, `body` is in it.
fn model(items: &str, body: &str) -> String {
    format!(
        "/* lcm {{}} */\n{items}\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    \
         let x = dot(l, v);\n    {body}\n    return Terms(vec3(0.0), vec3(y), vec3(0.0));\n}}\n"
    )
}

/// Something repeated, with its index.
fn repeated(count: usize, each: impl Fn(usize) -> String) -> String {
    (0..count).map(each).collect()
}

/// `count` functions, each of which calls the previous one twice.
fn doubling(count: usize) -> String {
    let functions =
        repeated(count, |i| format!("fn g{}(x: f32) -> f32 {{ return g{i}(x) + g{i}(x + 1.0); }}\n", i + 1));
    model(
        &format!("fn g0(x: f32) -> f32 {{ return sin(x); }}\n{functions}"),
        &format!("let y = g{count}(x);"),
    )
}

fn switch(cases: usize) -> String {
    let cases = repeated(cases, |i| format!("        case {i}u: {{ y = sin(y + {i}.0); }}\n"));
    model("", &format!("var y = x;\n    switch u32(x * 1000.0) {{\n{cases}        default: {{}}\n    }}"))
}

/// A hostile model: its name, its text, and the expected message.
struct Case {
    id: &'static str,
    text: String,
    said: &'static str,
}

fn corpus() -> Vec<Case> {
    let nested = |count: usize, open: &str| {
        let close = ")".repeat(count);
        model("", &format!("let y = {}x{close};", open.repeat(count)))
    };
    let chain = |count: usize, each: &str| model("", &format!("let y = x{};", each.repeat(count)));
    let constants = |count, forward: bool| {
        let mut lines: Vec<_> = (1..=count).map(|i| format!("const C{i} = C{} + 1.0;\n", i - 1)).collect();
        if !forward {
            lines.reverse();
        }
        model(&format!("const C0 = 1.0;\n{}", lines.concat()), &format!("let y = C{count};"))
    };
    let types = |count: usize| {
        let ty = format!("{}f32{}", "array<".repeat(count), ", 1>".repeat(count));
        model("", &format!("var a: {ty};\n    let y = x;"))
    };
    let file = |name: &str| {
        let path = root().join("tests/hostile").join(name);
        fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    };
    let case = |id, text, said| Case { id, text, said };
    vec![
        case("workgroup", file("workgroup.wgsl"), ":7:1: workgroup memory is not available"),
        case("workgroup_array", file("workgroup_array.wgsl"), "workgroup memory"),
        case("workgroup_atomic", file("workgroup_atomic.wgsl"), "workgroup memory"),
        case("workgroup_hidden", file("workgroup_hidden.wgsl"), "workgroup memory"),
        case("buffer", file("buffer.wgsl"), "@binding(0) is not available to a model"),
        case("texture", file("texture.wgsl"), "@binding(4) is not available to a model"),
        case("barrier", file("barrier.wgsl"), "barriers are not available"),
        case(
            "hidden_brackets",
            file("hidden_brackets.wgsl"),
            "closes a bracket from before an open condition",
        ),
        case("hidden_comment", file("hidden_comment.wgsl"), "ends the comment in WGSL although"),
        case("quotation", file("quotation.wgsl"), "this quotation mark is not closed"),
        case("array_of_arrays", file("array_of_arrays.wgsl"), "bytes; at most 4096 are allowed"),
        case("values_in_loop", file("values_in_loop.wgsl"), "this loop ends in its first iteration or never"),
        case("parentheses_800", nested(800, "(-"), "this is nested more than 100 brackets deep"),
        case("parentheses_3000", nested(3000, "("), "this is nested more than 100 brackets deep"),
        case("calls_3000", nested(3000, "sin("), "this is nested more than 100 brackets deep"),
        case("summands_3000", chain(3000, " + x"), "has 257 operators and brackets on one path"),
        case("summands_20000", chain(20_000, " + x"), "has 257 operators and brackets"),
        case("factors_3000", chain(3000, " * x"), "has 257 operators and brackets"),
        case("members_5000", model("", &format!("let y = v{}.x;", ".xyz".repeat(5000))), "has 257 operators"),
        case("templates_5000", chain(5000, " + vec2<f32>(x, x).x"), "has 257 operators"),
        case("minus_20000", model("", &format!("let y = {}x;", "- ".repeat(20_000))), "has 257 operators"),
        case(
            "not_20000",
            model("", &format!("let y = f32({}(x > 0.0));", "!".repeat(20_000))),
            "has 257 operators",
        ),
        case(
            "else_if_1600",
            model(
                "",
                &format!(
                    "var y = 0.0;\n    if x > 2.0 {{ y = 2.0; }}{}",
                    repeated(1600, |i| format!(" else if x > {i}.0 {{ y = {i}.0; }}\n"))
                ),
            ),
            "`else if` is 65 blocks deep",
        ),
        case(
            "blocks_1000",
            model("", &format!("let y = x;\n    {}{}", "{".repeat(1000), "}".repeat(1000))),
            "this block is nested 65 deep; at most 64",
        ),
        case("types_1000", types(1000), "this is nested more than 100 brackets deep"),
        case("constants_3000", constants(900, true), "this is part of a chain of"),
        case("constants_backwards", constants(900, false), "this is part of a chain of"),
        case(
            "constants_doubling",
            model(
                &format!(
                    "const A0 = array(1.0, 2.0);\n{}",
                    repeated(26, |i| format!("const A{} = array(A{i}, A{i});\n", i + 1))
                ),
                "let y = x;",
            ),
            "this expands to",
        ),
        case(
            "pointers_300",
            model(
                &format!(
                    "fn p0(q: ptr<function, f32>) {{ *q += 1.0; }}\n{}",
                    repeated(300, |i| format!("fn p{}(q: ptr<function, f32>) {{ p{i}(q); }}\n", i + 1))
                ),
                "var y = x;\n    p300(&y);",
            ),
            "this is part of a chain of",
        ),
        case(
            "lets_3000",
            model(
                "",
                &format!(
                    "let a0 = x;\n{}    let y = a3000;",
                    repeated(3000, |i| format!("    let a{} = a{i} * 0.5 + a{i};\n", i + 1))
                ),
            ),
            "values, each calculated from the one before",
        ),
        case(
            "local_array",
            model("", "var a: array<f32, 1000000>;\n    a[u32(x)] = x;\n    let y = a[u32(x + 1.0)];"),
            "this array has up to 1000000 elements; at most 4096",
        ),
        case(
            "private_array",
            model("const N = 1000;\nvar<private> a: array<f32, N * N>;", "let y = a[u32(x)];"),
            "elements; at most 4096",
        ),
        case(
            "constant_array",
            model("const A = array<f32, 1 << 20>();", "let y = A[u32(x)];"),
            "the length of this array cannot be determined",
        ),
        case(
            "nested_array",
            model("", "var a: array<array<array<f32, 1000>, 1000>, 1000>;\n    let y = x;"),
            ":5:12: this expands to 1000000000 words; at most 98304",
        ),
        case(
            "nested_private_array",
            model("var<private> a: array<array<array<f32, 1000>, 1000>, 1000>;", "let y = x;"),
            ":2:17: this expands to 1000000000 words; at most 98304",
        ),
        case(
            "nested_alias",
            model("alias A = array<array<f32, 100>, 20>;", "var b: array<A, 300>;\n    let y = x;"),
            ":5:12: this expands to",
        ),
        case(
            "nested_arrays",
            model(
                "",
                &format!(
                    "let y = x;\n{}",
                    repeated(8, |i| format!("    var a{i}: array<array<f32, 150>, 150>;\n"))
                ),
            ),
            ":3:4: constants and types are expanded where they are used",
        ),
        case(
            "nested_arrays_of_functions",
            model(
                &repeated(60, |i| format!("fn g{i}() {{ var a: array<array<f32, 85>, 85>; }}\n")),
                "let y = x;",
            ),
            "constants and types are expanded where they are used",
        ),
        case(
            "many_variables",
            model(
                &format!(
                    "var<private> a: array<vec4<f32>, 250>;\n{}",
                    repeated(9, |i| { format!("var<private> a{i}: array<vec4<f32>, 250>;\n") })
                ),
                "let y = x;",
            ),
            "bytes of variables of the module; at most 32768",
        ),
        case(
            "constants_powers",
            model(
                "",
                &format!(
                    "const n0 = 0;\n{}    var a: array<f32, n7>;\n    let y = a[0] + x;",
                    repeated(7, |i| format!(
                        "    const n{} = {};\n",
                        i + 1,
                        vec![format!("n{i}"); 30].join(" * ")
                    ))
                ),
            ),
            "this array has up to",
        ),
        case(
            "discard",
            model("", "if x > 2.0 {\n    discard;\n    }\n    let y = x;"),
            "`discard` is not available",
        ),
        case("override", model("override N: f32 = 1.0;", "let y = x * N;"), "`override` is not available"),
        case("functions_20", doubling(20), "steps with all calls inlined"),
        case("functions_26", doubling(26), "steps with all calls inlined"),
        case("switch_5000", switch(5000), "this switch has more than 256 cases"),
        case(
            "statements_100000",
            model("", &format!("var y = x;\n{}", "    y += 1.0;\n".repeat(20_000))),
            "statements; at most",
        ),
        case(
            "loops_20",
            {
                let (open, close) =
                    (repeated(20, |i| format!("for (var i{i} = 0; i{i} < 2; i{i}++) {{ ")), "}".repeat(20));
                model("", &format!("var y = x;\n    {open} y += 1.0; {close}"))
            },
            "this loop is within 16 others",
        ),
        case(
            "long_name",
            model(&format!("const {} = 1;", "a".repeat(100_000)), "let y = x;"),
            "this word has 100000 bytes",
        ),
        case("open_1mib", file_of("("), "words and symbols"),
        case("less_1mib", file_of("a < "), "words and symbols"),
        case("blocks_1mib", file_of("{"), "words and symbols"),
        case("semicolons_1mib", file_of("a;"), "words and symbols"),
        case("minus_1mib", file_of("-"), "words and symbols"),
        case("attributes_1mib", file_of("@"), "words and symbols"),
        case("hash_1mib", file_of("#if A\n"), "words and symbols"),
        case("numbers_1mib", file_of("1,"), "words and symbols"),
    ]
}

/// A function nearly as long as a file may be.
fn file_of(piece: &str) -> String {
    model("", &format!("let y = x;\n    {}", piece.repeat((1_000_000) / piece.len())))
}

/// The messages of reading a model, on a thread like Bevy's.
fn said(id: &str, text: &str) -> Result<(), Vec<ShaderProblem>> {
    let path = Path::new("somewhere").join(format!("{id}.wgsl"));
    thread::scope(|scope| {
        let read = || custom::read(&path, text, &Registry::builtin()).map(drop);
        let thread = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, read);
        thread.expect("a thread").join().expect("no panic")
    })
}

#[test]
fn every_hostile_model_is_refused_with_its_place_and_the_limit() {
    let mut wrong = Vec::new();
    for Case { id, text, said: expected } in corpus() {
        let start = Instant::now();
        let Err(problems) = said(id, &text) else {
            wrong.push(format!("{id} is not refused"));
            continue;
        };
        let elapsed = start.elapsed();
        let [problem] = &problems[..] else { panic!("{id}: {problems:?}") };
        let told = problem.to_string();
        let line = text.lines().nth(problem.line - 1).unwrap_or_default();
        let placed = problem.file == format!("models/{id}.wgsl") && problem.source == line;
        if !told.contains(expected) || !placed || elapsed > PATIENCE {
            wrong.push(format!("{id}, {elapsed:?}: {told}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Models at the limits, in every way in which something recurses; in other respects, up to what software
/// Vulkan handles within a second.
fn at_the_limit() -> Vec<(&'static str, String)> {
    let most = limits::LIMITS;
    let nested = |count: usize, open: &str, close: &str| {
        model("", &format!("let y = {}x{};", open.repeat(count), close.repeat(count)))
    };
    let n = most.nesting - 2;
    let ifs = |inner: &str| {
        let count = most.blocks - 3;
        let open = repeated(count, |i| format!("if y > -{i}.0 {{ "));
        model("", &format!("var y = x;\n    {open}{inner}{}", "}".repeat(count)))
    };
    let deep = format!("y = {}x{};", "(-".repeat(n), ")".repeat(n));
    vec![
        ("parentheses", nested(n, "(-", ")")),
        ("calls", nested(n, "abs(", ")")),
        ("summands", model("", &format!("let y = x{};", " + x".repeat(most.depth - 2)))),
        ("indices", {
            let count = n - 1;
            let open = "a[u32(".repeat(count / 2);
            let close = ")]".repeat(count / 2);
            model("", &format!("var a = array<f32, 2>(x, 1.0);\n    let y = {open}x{close};"))
        }),
        ("blocks", ifs("y += 1.0;")),
        ("deep_in_blocks", ifs(&deep)),
        (
            "else_if",
            model(
                "",
                &format!(
                    "var y = x;\n    if x > 2.0 {{ y = 2.0; }}{}",
                    repeated(most.blocks - 4, |i| format!(" else if x > {i}.5 {{ {deep} }}\n"))
                ),
            ),
        ),
        ("types", {
            let count = n;
            let ty = format!("{}f32{}", "array<".repeat(count), ", 1>".repeat(count));
            let index = "[0]".repeat(count);
            model("", &format!("var a: {ty};\n    a{index} = x;\n    let y = a{index};"))
        }),
        (
            "constants",
            model(
                &format!(
                    "const C0 = 1.0;\n{}",
                    repeated(most.chain - 20, |i| format!("const C{} = C{i} + 1.0;\n", i + 1))
                ),
                &format!("let y = C{};", most.chain - 20),
            ),
        ),
        (
            "functions",
            model(
                &format!(
                    "fn g0(x: f32) -> f32 {{ return x; }}\n{}",
                    repeated(most.chain - 20, |i| {
                        format!("fn g{}(x: f32) -> f32 {{ return g{i}(x) + 1.0; }}\n", i + 1)
                    })
                ),
                &format!("let y = g{}(x);", most.chain - 20),
            ),
        ),
        (
            "lets",
            model(
                "",
                &format!(
                    "let a0 = x;\n{}    let y = a1000;",
                    repeated(1000, |i| format!("    let a{} = a{i} * x;\n", i + 1))
                ),
            ),
        ),
        (
            "pointers",
            model(
                "",
                &format!(
                    "var y = x;\n    let p0 = &y;\n{}    *p1000 += 1.0;",
                    repeated(1000, |i| format!("    let p{} = &(*p{i});\n", i + 1))
                ),
            ),
        ),
        ("switch", switch(most.cases - 1)),
        ("doubling", doubling(11)),
        ("comments", model(&format!("{}{}", "/*".repeat(100_000), "*/".repeat(100_000)), "let y = x;")),
        ("statements", model("", &format!("var y = x;\n{}", "    y += sin(y) * x;\n".repeat(200)))),
        (
            "variables",
            model(
                "var<private> a: array<vec4<f32>, 16>;\nvar<private> b: array<vec4<f32>, 16>;",
                "a[u32(abs(x) * 15.0)] = v.xyzx;\n    b[u32(abs(v.x) * 15.0)] = l.xyzx;\n    \
                 let y = a[u32(abs(x) * 14.0)].x + b[7].y;",
            ),
        ),
        (
            "table",
            model(
                &format!("const T = array<f32, 256>({});", repeated(256, |i| format!("{i}.5, "))),
                "let y = T[u32(abs(x) * 1000.0) % 256u];",
            ),
        ),
    ]
}

#[test]
fn what_is_within_the_limits_needs_a_quarter_of_the_stack() {
    // A stack overflow here ends the process: there is nothing gentler.
    for (id, text) in at_the_limit() {
        let registry = Registry::builtin();
        let path = Path::new("somewhere").join(format!("{id}.wgsl"));
        let read = custom::read(&path, &text, &registry).unwrap_or_else(|p| panic!("{id}: {p:?}"));
        let mut sources = Sources::default();
        sources.edit(read.entry.declaration.wgsl.path, text.clone());
        let composed = compose_evaluation(&sources, &read.entry);
        let of = (&read.entry, read.entry.declaration.passage());
        let drawn = compose(&sources, of, &registry.shading_models()[0], registry.lights());
        assert!(limits::check_text(&drawn).is_ok(), "{id}");
        thread::scope(|scope| {
            let small = thread::Builder::new().stack_size(STACK / 4);
            let call = || {
                let module = naga::front::wgsl::parse_str(&composed.text).expect("valid");
                let mut validator = naga::valid::Validator::new(
                    naga::valid::ValidationFlags::all(),
                    naga::valid::Capabilities::all(),
                );
                let info = validator.validate(&module).expect("valid");
                assert!(lights_camera_models::shader::pitfall::find(&module).is_none());
                composes(&composed.text);
                #[cfg(target_os = "linux")]
                drop(
                    naga::back::spv::write_vec(&module, &info, &naga::back::spv::Options::default(), None)
                        .expect("written"),
                );
                #[cfg(not(target_os = "linux"))]
                drop(info);
            };
            small.spawn_scoped(scope, call).expect("a thread").join().expect("no panic");
        });
        // Our checks need almost none of the caller's stack.
        thread::scope(|scope| {
            let tiny = thread::Builder::new().stack_size(STACK / 16);
            let call = || assert!(validate(&composed).is_ok(), "{id}");
            tiny.spawn_scoped(scope, call).expect("a thread").join().expect("no panic");
        });
    }
}

/// Composes a text as Bevy does.
fn composes(text: &str) {
    use naga_oil::compose::{Composer, NagaModuleDescriptor};
    let descriptor =
        NagaModuleDescriptor { source: text, file_path: "composed.wgsl", ..NagaModuleDescriptor::default() };
    let composed = Composer::default().make_naga_module(descriptor);
    assert!(composed.is_ok(), "{:?}", composed.err().map(|e| e.inner));
}

/// The result of a run of the program, and its cost.
struct Watched {
    status: Option<i32>,
    out: String,
    err: String,
    /// Maximum memory, in bytes; 0 if the system does not report it.
    memory: u64,
}

/// Runs the program in a folder, with a time limit.
fn watched(folder: &Path, arguments: &[&str], patience: Duration) -> Watched {
    let mut child = command_in(folder, arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let readers = [pump(child.stdout.take()), pump(child.stderr.take())];
    let start = Instant::now();
    let mut memory = 0;
    let status = loop {
        memory = memory.max(peak(&child));
        if let Some(status) = child.try_wait().expect("it can be waited for") {
            break status;
        }
        if start.elapsed() > patience {
            let _ = child.kill();
            let _ = child.wait();
            panic!("{arguments:?} did not end within {patience:?}");
        }
        thread::sleep(Duration::from_millis(5));
    };
    let [out, err] = readers.map(|r| r.join().expect("no panic"));
    Watched { status: status.code(), out, err, memory }
}

fn pump(from: Option<impl Read + Send + 'static>) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut from) = from {
            let _ = from.read_to_end(&mut bytes);
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// The maximum memory used by a process.
fn peak(child: &Child) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).unwrap_or_default();
    line.trim().trim_end_matches("kB").trim().parse::<u64>().unwrap_or(0) << 10
}

const GIB: u64 = 1 << 30;

/// A folder with all hostile models, a good one, and a scene that uses it.
fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("writable");
    for Case { id, text, .. } in corpus() {
        fs::write(models.join(format!("{id}.wgsl")), text).expect("writable");
    }
    fs::write(models.join("good.wgsl"), model("", "let y = max(x, 0.0);")).expect("writable");
    let scene = fs::read_to_string(root().join("scenes/default.json")).unwrap_or_default();
    let mut scene: serde_json::Value = serde_json::from_str(&scene).expect("a scene");
    scene["reflection_model"] = "good".into();
    fs::write(folder.path().join("good.json"), scene.to_string()).expect("writable");
    let at = folder.path().to_owned();
    (folder, at)
}

#[test]
fn no_command_dies_of_a_hostile_model_and_the_others_go_on_working() {
    let (_folder, at) = folder();
    let run = |arguments: &str| {
        let arguments: Vec<_> = arguments.split(' ').chain(["--models", "models"]).collect();
        let run = watched(&at, &arguments, Duration::from_secs(120));
        assert!(run.memory < 2 * GIB, "{arguments:?}: {} MiB", run.memory >> 20);
        assert!(run.status.is_some(), "{arguments:?} ended by a signal\n{}", run.err);
        assert!(!run.err.contains("panicked"), "{arguments:?}: {}", run.err);
        run
    };
    let list = run("models");
    // Valid ones are listed; the others are errors.
    assert_eq!(list.status, Some(1), "{}", list.err);
    assert!(list.out.contains("good"), "{}", list.out);
    assert_eq!(run("check good.json").status, Some(0));
    for renderer in ["cpu", "gpu"] {
        let drawn = run(&format!("render good.json -o {renderer}.png --size 64x64 --renderer {renderer}"));
        assert_eq!(drawn.status, Some(0), "{}", drawn.err);
        assert!(at.join(format!("{renderer}.png")).is_file());
    }
    for id in ["workgroup", "summands_3000", "functions_26", "constant_array", "switch_5000"] {
        let expected = corpus().into_iter().find(|c| c.id == id).expect("there").said;
        let checked = run(&format!("models check {id}"));
        assert_eq!(checked.status, Some(1), "{id}: {}", checked.err);
        assert!(checked.err.contains(expected.trim_start_matches(":7:1: ")), "{id}: {}", checked.err);
        for renderer in ["cpu", "gpu"] {
            let refused =
                run(&format!("render -o x.png --size 64x64 --renderer {renderer} --reflection {id}"));
            assert!(matches!(refused.status, Some(1 | 2)), "{id}: {:?} {}", refused.status, refused.err);
            assert!(refused.err.contains(&format!("{id}.wgsl:")), "{id}: {}", refused.err);
        }
    }
}

#[test]
fn models_at_the_limits_are_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("writable");
    for (id, text) in at_the_limit() {
        fs::write(models.join(format!("{id}.wgsl")), text).expect("writable");
    }
    for (id, _) in at_the_limit() {
        for renderer in ["cpu", "gpu"] {
            let start = Instant::now();
            let command = format!(
                "render -o {id}.png --size 32x32 --samples 1 --renderer {renderer} --reflection {id} --models models"
            );
            let arguments: Vec<_> = command.split(' ').collect();
            let drawn = watched(folder.path(), &arguments, Duration::from_secs(120));
            assert_eq!(drawn.status, Some(0), "{id} on the {renderer}: {}", drawn.err);
            assert!(drawn.memory < 2 * GIB, "{id}: {} MiB", drawn.memory >> 20);
            eprintln!("{id} on the {renderer}: {:?}, {} MiB", start.elapsed(), drawn.memory >> 20);
        }
    }
}

/// The message about a function stopped by the interpreter.
const TOO_LONG: &str = "a function runs too long: more than 131072 instructions in its loops for one direction; a loop may be endless";

/// Endless where the light is above the surface, which the text does not reveal.
fn endless() -> String {
    model("", "var y = 0.0;\n    while y >= 0.0 { y += f32(frame.n.z >= 0.0); }")
}

#[test]
fn a_loop_that_only_data_make_endless_is_not_given_to_the_graphics_card() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("writable");
    fs::write(models.join("endless.wgsl"), endless()).expect("writable");
    for command in [
        "models check endless",
        "render -o x.png --size 64x64 --renderer gpu --reflection endless",
        "render -o x.png --size 64x64 --renderer cpu --reflection endless",
    ] {
        let arguments: Vec<_> = command.split(' ').chain(["--models", "models"]).collect();
        let run = watched(folder.path(), &arguments, Duration::from_secs(60));
        assert!(matches!(run.status, Some(1 | 3)), "{command}: {:?} {}", run.status, run.err);
        assert!(run.err.contains(TOO_LONG), "{command}: {}", run.err);
    }
}

#[test]
fn a_check_tells_of_models_that_no_renderer_runs_or_the_gpu_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("models")).expect("writable");
    let text = fs::read_to_string(root().join("scenes/default.json")).expect("readable");
    let put = |name: &str, id: &str, wgsl: &str, material: serde_json::Value| {
        fs::write(folder.path().join(format!("models/{id}.wgsl")), wgsl).expect("writable");
        let mut scene: serde_json::Value = serde_json::from_str(&text).expect("a scene");
        scene["reflection_model"] = id.into();
        scene["objects"][0]["material"] = material;
        fs::write(folder.path().join(format!("{name}.json")), scene.to_string()).expect("writable");
    };
    let run = |scenes: &[&str]| {
        let arguments = [&["check"][..], scenes, &["--models", "models"]].concat();
        lcm_in(folder.path(), &arguments, b"")
    };
    let too_long = |name: &str, id: &str| {
        format!(
            "{name}.json: objects[0] has the reflection model {id} of models/{id}.wgsl, which cannot be run: {TOO_LONG}"
        )
    };
    let none = serde_json::json!({});
    let long = "var y = 0.0;\n    for (var i = 0u; i < 20000u; i++) { y += 1e-6; }";
    let sometimes = "var y = 0.0;\n    loop { y += 1.0; if y > 10.0 && l.y < 0.9 { break; } }";
    for (id, wgsl) in [("endless", endless()), ("long", model("", long)), ("sometimes", model("", sometimes))]
    {
        put(id, id, &wgsl, none.clone());
        let checked = run(&[&format!("{id}.json")]);
        assert_eq!((checked.status, checked.out.as_str()), (Some(1), ""), "{}", checked.err);
        assert_eq!(checked.err.trim_end(), too_long(id, id));
    }
    // The values of another scene may be valid for the same model.
    let rounds = model("", &long.replace("20000u", "u32(m.rounds)")).replace(
        "lcm {}",
        r#"lcm { "parameters": [{ "name": "rounds", "min": 0, "max": 20000, "default": 5 }] }"#,
    );
    put("many", "rounds", &rounds, serde_json::json!({ "rounds": 20000 }));
    put("few", "rounds", &rounds, serde_json::json!({ "rounds": 100 }));
    let checked = run(&["many.json", "few.json"]);
    assert_eq!(checked.status, Some(1), "{}", checked.err);
    assert!(checked.out.starts_with("few.json: valid"), "{}", checked.out);
    assert!(checked.err.contains(&too_long("many", "rounds")), "{}", checked.err);

    // Its picture by the GPU is right.
    put("packed", "packed", &model("", "let y = unpack4x8unorm(pack4x8unorm(vec4(x))).x;"), none);
    let checked = run(&["packed.json"]);
    assert_eq!(checked.status, Some(0), "{}", checked.err);
    assert!(checked.out.starts_with("packed.json: valid"), "{}", checked.out);
    let begin =
        "packed.json: objects[0] has the reflection model packed, which the CPU renderer cannot run (it ";
    assert!(checked.err.starts_with(begin) && checked.err.lines().count() == 1, "{}", checked.err);
    assert!(checked.err.contains("only the GPU renderer draws it"), "{}", checked.err);
}
