//! The program without the window: it does the same as the whole one, and says what it lacks. `scripts/test` builds it.

use std::{env, fs, path::PathBuf};

use crate::helpers::{
    skipped::skip,
    support::{command_of, lcm_in, names, root, run},
};

/// Variable with the path of the program.
const VARIABLE: &str = "LCM_WITHOUT_WINDOW";

/// The program; the test is skipped without it.
fn program() -> Option<PathBuf> {
    let program = env::var_os(VARIABLE).map(PathBuf::from);
    if program.is_none() {
        skip(&format!(
            "{VARIABLE} is not set to a program built with --no-default-features; scripts/test sets it"
        ));
    }
    program
}

#[test]
fn what_needs_no_window_is_the_same_without_it() {
    let Some(program) = program() else { return };
    let at = |path: &str| root().join(path).to_str().expect("Unicode").to_owned();
    let scene = at("scenes/compare_phong_blinn_phong.json");
    let scene = scene.as_str();
    let pairs = "theta_i,phi_i,theta_o,phi_o\n30,0,30,180\n80,10,60,200\n";
    let [lesson, glass] = [at("lessons/02_three_terms.md"), at("scenes/glass_ball.json")];
    let all: &[(&[&str], &str)] = &[
        (&["check", scene], ""),
        (&["evaluate", "microfacet", "--set", "alpha_x=0.2"], pairs),
        (&["albedo", "disney"], "mu\n0.1\n1\n"),
        (&["render", scene, "--renderer", "cpu", "--size", "160x90", "--caption", "-o", "a.png"], ""),
        (&["render", scene, "--renderer", "cpu", "--view", "A", "--size", "64x36", "-o", "a.exr"], ""),
        (&["explain", scene, "--at", "80,45", "--size", "160x90"], ""),
        (&["compare", scene, "--size", "64x36"], ""),
        (&["plot", "phong", "disney", "-o", "plot.svg"], ""),
        (&["sweep", scene, "--vary", "display.exposure=-1,0,1", "--size", "64x36", "-o", "sweep.png"], ""),
        (&["export", scene, "--as", "html", "-o", "page.html"], ""),
        (&["export", scene, "--as", "bevy", "-o", "project"], ""),
        (&["export", &glass, "--as", "mitsuba", "-o", "mitsuba"], ""),
        (&["lesson", "list"], ""),
        (&["lesson", "check", &lesson], ""),
        (&["models", "--json"], ""),
        (&["materials", "gold", "-o", "materials.png"], ""),
        (&["schema"], ""),
        (&["new", "room.json"], ""),
        (&["completions", "fish"], ""),
        (&["manual", "pages"], ""),
    ];
    let [here, there] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    for (arguments, input) in all {
        let whole = lcm_in(here.path(), arguments, input.as_bytes());
        assert_eq!(whole.status, Some(0), "{arguments:?}: {}", whole.err);
        let small = run(command_of(&program, there.path(), *arguments), input.as_bytes());
        assert_eq!(
            (small.status, small.out, small.err),
            (whole.status, whole.out, whole.err),
            "{arguments:?}"
        );
    }
    let files = names(here.path());
    assert_eq!(files.len(), 10, "{files:?}");
    assert_eq!(names(there.path()), files);
    for name in files.iter().filter(|name| here.path().join(name).is_file()) {
        let [whole, small] =
            [&here, &there].map(|folder| fs::read(folder.path().join(name)).expect("a file"));
        assert!(whole == small, "{name} differs");
    }
}

#[test]
fn what_is_missing_without_the_window_says_so() {
    let Some(program) = program() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let pairs = b"theta_i,phi_i,theta_o,phi_o\n30,0,30,180\n";
    // A model that the CPU cannot interpret, and an edit that it ignores.
    let models = tempfile::tempdir().expect("a folder");
    let shaders = models.path().join("assets/shaders/reflection");
    fs::create_dir_all(&shaders).expect("a folder");
    let lambert = fs::read_to_string(root().join("assets/shaders/reflection/lambert.wgsl")).expect("text");
    fs::write(shaders.join("lambert.wgsl"), lambert + "\n// mine\nconst MINE = 1.0;\n").expect("written");
    let [of_mine, of_assets] =
        ["", "assets"].map(|name| models.path().join(name).to_str().expect("Unicode").to_owned());
    let text = "/* lcm {} */\nfn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n    let x = \
                unpack4x8snorm(1u).x;\n    return Terms(vec3(0.0), vec3(x + l.z), vec3(0.0));\n}\n";
    fs::write(models.path().join("mine.wgsl"), text).expect("written");
    for (arguments, status) in [
        (&["evaluate", "mine", "--models", &of_mine][..], 3),
        (&["render", "--reflection", "mine", "--models", &of_mine, "-o", "mine.png"], 3),
        (&["models", "check", "mine", "--models", &of_mine], 3),
        (&["render", "--assets", &of_assets, "--size", "8x8", "-o", "/dev/null"], 0),
    ] {
        let said = run(command_of(&program, folder.path(), arguments), pairs);
        assert_eq!(said.status, Some(status), "{arguments:?}: {}", said.err);
        let circular =
            ["use --renderer", "use --on", "--renderer gpu uses"].iter().any(|way| said.err.contains(way));
        assert!(!circular && said.err.contains("window"), "{arguments:?}: {}", said.err);
    }
    for (arguments, status, remedy) in [
        (&["view"][..], 3, "`lcm render` draws scenes"),
        (&[], 3, "`lcm render` draws scenes"),
        (&["render", "--renderer", "gpu"], 3, "use --renderer cpu"),
        (&["evaluate", "phong", "--on", "gpu"], 3, "use --on cpu"),
        (&["export", "--as", "executable", "-o", "room"], 3, "--as html"),
        (&["export", "--as", "executable", "-o", "."], 3, "--as html"),
    ] {
        let said = run(command_of(&program, folder.path(), arguments), pairs);
        assert_eq!((said.status, said.out.as_str()), (Some(status), ""), "{arguments:?}: {}", said.err);
        let expected = "lcm was built without the window: ";
        assert!(said.err.contains(expected) && said.err.contains(remedy), "{arguments:?}: {}", said.err);
        assert_eq!(said.err.lines().count(), 1, "{}", said.err);
    }
    assert!(names(folder.path()).is_empty(), "nothing was written");
    let help = run(command_of(&program, folder.path(), ["--help"]), b"");
    assert!(help.out.contains("lcm was built without the window"), "{}", help.out);
    // Without a request for the GPU, the CPU draws, and searches for violations of laws.
    let laws = run(command_of(&program, folder.path(), ["models", "check", "lambert"]), b"");
    assert!(
        laws.status == Some(0) && laws.out.contains("reciprocal: claimed and kept"),
        "{}{}",
        laws.out,
        laws.err
    );
    let drawn = run(command_of(&program, folder.path(), ["render", "--size", "16x9", "-o", "a.png"]), b"");
    assert_eq!(drawn.status, Some(0), "{}", drawn.err);
}
