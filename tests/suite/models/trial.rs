//! Shaders are tried in another process: its messages are reported here, and however it ends, the picture and
//! the program survive.

use std::{
    fs,
    os::unix::fs::PermissionsExt as _,
    path::{Path, PathBuf},
    process::Command,
    thread,
    time::{Duration, Instant},
};

use lights_camera_models::{
    render::trial::{
        Bench, Verdict,
        process::{Budget, TrialProcess},
    },
    shader::compose::Composed,
};

use crate::renderers::reload::{BREAKAGES, Breakage, Lab, original, phong_scene};

/// The lab, with shaders tried by a program.
fn apart(program: &Path, budget: Budget) -> Lab {
    let mut lab = Lab::new(phong_scene("phong"));
    let process = TrialProcess::new(program.to_owned(), budget, || {});
    lab.renderer.app().world_mut().resource_mut::<Bench>().try_in(process);
    lab
}

fn lcm() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_lcm"))
}

/// Runs frames until everything is tried and reported.
fn settled(lab: &mut Lab) -> Vec<u8> {
    let start = Instant::now();
    while lab.live().is_trying() {
        lab.renderer.step();
        assert!(start.elapsed() < Duration::from_secs(60), "it goes on trying");
        thread::sleep(Duration::from_millis(2));
    }
    lab.settled()
}

#[test]
fn another_process_says_what_this_one_would() {
    let mut lab = apart(lcm(), Budget::default());
    let before = lab.frame();
    for Breakage { name, file, change, said, line } in BREAKAGES {
        lab.save(file, change(original(file)));
        assert!(settled(&mut lab) == before, "{name}: the picture changed");
        let troubles = lab.troubles();
        let [trouble] = &troubles[..] else { panic!("{name}: {troubles:?}") };
        assert!(trouble.problem.message.contains(said), "{name}: {}", trouble.problem);
        if !line.is_empty() {
            assert_eq!(trouble.problem.file, *file, "{name}: {}", trouble.problem);
        }
        lab.save(file, original(file));
        assert!(settled(&mut lab) == before, "{name}");
        assert_eq!(lab.troubles(), [], "{name}");
    }
    // The twin: a valid shader is used.
    lab.save("loop.wgsl", original("loop.wgsl").replace("* light.colour;", "* light.colour * 0.5;"));
    assert!(settled(&mut lab) != before);
    assert_eq!(lab.troubles(), []);
}

#[test]
fn a_model_that_is_tried_for_the_first_time_takes_no_object_away() {
    let mut lab = apart(lcm(), Budget::default());
    let before = lab.frame();
    lab.save("reflection/lambert.wgsl", format!("{}\n// mine\n", original("reflection/lambert.wgsl")));
    let mut scene = phong_scene("phong");
    scene.reflection_model = "lambert".to_owned();
    lab.renderer.set_scene(scene.clone());
    let expected = Lab::new(scene).frame();
    assert!(before != expected);
    let mut frames = 0;
    let start = Instant::now();
    loop {
        let frame = lab.frame();
        if frame == expected {
            break;
        }
        frames += 1;
        assert!(frame == before, "frame {frames} is neither the old nor the new one");
        assert!(start.elapsed() < Duration::from_secs(60), "the new one does not come");
    }
    assert!(frames > 0, "it was not tried in another process");
}

#[test]
fn a_shader_that_draws_for_ever_is_refused() {
    let mut lab = apart(lcm(), Budget::default());
    let before = lab.frame();
    let slow = original("reflection/phong.wgsl").replacen(
        "var specular = vec3(0.0);",
        "var specular = vec3(0.0);\n    for (var i = 0u; i < 40000u; i++) { specular += vec3(sin(f32(i) * m.k_s)); }\n    specular *= 1e-30;",
        1,
    );
    assert_ne!(slow, original("reflection/phong.wgsl"));
    lab.save("reflection/phong.wgsl", &slow);
    assert!(settled(&mut lab) == before);
    let troubles = lab.troubles();
    let [trouble] = &troubles[..] else { panic!("{troubles:?}") };
    assert!(trouble.problem.message.contains("loop with very many iterations"), "{}", trouble.problem);
    lab.save("reflection/phong.wgsl", original("reflection/phong.wgsl"));
    assert!(settled(&mut lab) == before);
    assert_eq!(lab.troubles(), []);
}

/// A program that does something other than trying shaders.
fn program(folder: &Path, does: &str) -> PathBuf {
    let path = folder.join("program");
    fs::write(&path, format!("#!/bin/sh\n{does}\n")).expect("writable");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("possible");
    path
}

#[test]
fn whatever_becomes_of_the_process_is_told_and_the_picture_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let ready = r#"echo '"Ready"'"#;
    for (does, said) in [
        ("read line; kill -SEGV $$", "crashes"),
        ("read line; exit 0", "crashes"),
        ("read line; sleep 100", "within 2 s"),
        ("read line; x=$(head -c 300000000 /dev/zero | tr '\\0' a); sleep 100", "more than 100 MiB"),
    ] {
        let path = program(folder.path(), &format!("{ready}\n{does}"));
        // A busy machine needs its time for the others.
        let time = Duration::from_secs(if said == "within 2 s" { 2 } else { 50 });
        let budget = Budget { time, memory: 100 << 20 };
        let mut lab = apart(&path, budget);
        let before = lab.frame();
        lab.save("reflection/phong.wgsl", format!("{}\n", original("reflection/phong.wgsl")));
        assert!(settled(&mut lab) == before, "{does}");
        let troubles = lab.troubles();
        let [trouble] = &troubles[..] else { panic!("{does}: {troubles:?}") };
        assert!(trouble.problem.message.contains(said), "{does}: {}", trouble.problem);
        assert_eq!(trouble.stale, ["Phong"]);
    }
}

#[test]
fn a_shader_that_took_too_long_is_tried_again_in_a_later_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let slow = folder.path().join("slow");
    fs::write(&slow, "").expect("writable");
    let does = format!(
        "echo '\"Ready\"'; read line; if [ -e {0} ]; then rm {0}; sleep 100; fi; echo '\"Good\"'; read line",
        slow.display()
    );
    let budget = Budget { time: Duration::from_secs(2), ..Budget::default() };
    let process = TrialProcess::new(program(folder.path(), &does), budget, || {});
    let composed = Composed { text: "fn response() {}\n".to_owned(), ..Composed::default() };
    let ask = || process.ask(&composed, false, Vec::new);
    let answer = || {
        let start = Instant::now();
        loop {
            process.begin_frame();
            match ask() {
                Verdict::NotYet => thread::sleep(Duration::from_millis(5)),
                answer => break answer,
            }
            assert!(start.elapsed() < Duration::from_secs(60), "no answer comes");
        }
    };
    let first = answer();
    let Verdict::Bad(problem) = &first else { panic!("{first:?}") };
    let said = "The computer may also be busy; save the file again to retry";
    assert!(problem.message.contains("within 2 s") && problem.message.ends_with(said), "{problem}");
    assert!(ask() == first, "all requests of a frame have one answer");
    assert!(answer() == Verdict::Good);
}

#[test]
fn what_cannot_be_tried_is_refused_and_tried_again_with_the_next_save() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("program");
    let mut lab = apart(&path, Budget::default());
    let before = lab.frame();
    let dark = original("loop.wgsl").replace("* light.colour;", "* light.colour * 0.5;");
    for does in [None, Some("exit 3")] {
        if let Some(does) = does {
            program(folder.path(), does);
        }
        lab.save("loop.wgsl", format!("{dark}// {does:?}\n"));
        assert!(settled(&mut lab) == before, "{does:?}: it was not tried, and is shown");
        let troubles = lab.troubles();
        let [trouble] = &troubles[..] else { panic!("{does:?}: {troubles:?}") };
        assert!(trouble.problem.message.contains("could not be tested"), "{}", trouble.problem);
    }
    // The program exists again.
    std::fs::remove_file(&path).expect("removed");
    std::os::unix::fs::symlink(lcm(), &path).expect("linked");
    lab.save("loop.wgsl", &dark);
    assert!(settled(&mut lab) != before);
    assert_eq!(lab.troubles(), []);
}

#[test]
fn a_new_model_is_fast_enough_under_light_with_extent() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = r#"{
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "reflection_model": "velvet",
        "shading_model": "phong",
        "lights": [{ "type": "rectangle", "position": [7, 8, 9], "direction": [-2, -3, -4], "intensity": 20 }],
        "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1] },
        "objects": [{ "type": "sphere", "position": [5, 5, 5], "size": 4 }]
    }"#;
    fs::write(folder.path().join("softbox.json"), scene).expect("written");
    let size = ["--renderer", "gpu", "--size", "32x18", "-o", "p.png"];
    for arguments in [&["models", "new", "velvet"][..], &[&["render", "softbox.json"], &size[..]].concat()] {
        let run = Command::new(lcm())
            .args(arguments)
            .args(["--models", "models"])
            .current_dir(folder.path())
            .output()
            .expect("it starts");
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    }
}
