//! `lcm lesson`: the list, the check with its exit status, the text of a lesson.

use std::fs;

use lights_camera_models::lesson::shipped::LESSONS;
use serde_json::Value;

use crate::helpers::support::{check_wording, lcm, lcm_in};

const BROKEN: &str = "---\ntitle: T\nsummary: S.\n---\n\n## One\n\nSee ![this](a.png).\n\n```do\nRaise α.\nuntil: knob.alhpa > 5\n```\n\n## Two\n\n```view\nchannel: n_dot_q\n```\n";

#[test]
fn the_list_has_every_shipped_lesson() {
    let run = lcm(&["lesson", "list"], "");
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_eq!(run.out.lines().count(), LESSONS.len());
    for (lesson, line) in LESSONS.iter().zip(run.out.lines()) {
        assert!(line.starts_with(&lesson.id) && line.contains(&lesson.summary), "{line}");
        let shown = lcm(&["lesson", "show", &lesson.id], "");
        assert_eq!((shown.status, shown.out), (Some(0), lesson.to_text()));
    }
}

#[test]
fn a_sound_lesson_is_counted_and_printed() {
    let run = lcm(&["lesson", "check", "examples/lesson.md"], "");
    assert_eq!((run.status, run.out.as_str()), (Some(0), "examples/lesson.md: valid: 3 steps, 3 tasks\n"));
    assert_eq!(run.err, "");
    let quiet = lcm(&["lesson", "check", "-q", "examples/lesson.md"], "");
    assert_eq!((quiet.status, quiet.out.as_str()), (Some(0), ""));
    let shown = lcm(&["lesson", "show", "examples/lesson.md"], "");
    assert_eq!(shown.status, Some(0), "{}", shown.err);
    assert!(
        shown.out.starts_with("A narrow highlight\n====")
            && shown.out.contains("Until: curve.highlight_width < 10°")
    );
}

#[test]
fn all_problems_are_printed_with_file_line_and_caret() {
    let folder = tempfile::tempdir().expect("writable");
    fs::write(folder.path().join("l.md"), BROKEN).expect("writable");
    let run = lcm_in(folder.path(), &["lesson", "check", "l.md"], b"");
    assert_eq!((run.status, run.out.as_str()), (Some(1), ""));
    for part in ["l.md:8:5", "l.md:12:8", "l.md:18:10", "images are not shown", "channel: n_dot_q", "n_dot_l"]
    {
        assert!(run.err.contains(part), "{part}\n{}", run.err);
    }
    assert_eq!(run.err.matches("error:").count(), 3, "{}", run.err);
    assert_eq!(run.err.matches('^').count(), 3, "{}", run.err);
    let json = lcm_in(folder.path(), &["lesson", "check", "--json", "l.md", "none.md"], b"");
    assert_eq!(json.status, Some(1), "{}", json.err);
    let reports: Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(reports[0]["valid"], false);
    assert_eq!(
        (&reports[0]["problems"][1]["line"], &reports[0]["problems"][1]["column"]),
        (&12.into(), &8.into())
    );
    let said = reports[0]["problems"][1]["message"].as_str().expect("text");
    assert_eq!(said, "there is no parameter \"alhpa\"; did you mean \"alpha\"?");
    assert_eq!(reports[1]["problems"][0]["message"], "file not found");
    for problem in reports[0]["problems"].as_array().expect("a list") {
        check_wording(problem["message"].as_str().expect("text"));
    }
    // Several: the last line counts them.
    fs::write(folder.path().join("m.md"), "---\ntitle: T\nsummary: S.\n---\n\n## A\n\nb\n")
        .expect("writable");
    let both = lcm_in(folder.path(), &["lesson", "check", "l.md", "m.md"], b"");
    assert_eq!((both.status, both.out.as_str()), (Some(1), "m.md: valid: 1 step, 0 tasks\n"));
    assert!(both.err.ends_with("1 of 2 lessons is invalid\n"), "{}", both.err);
    let shown = lcm_in(folder.path(), &["lesson", "show", "l.md"], b"");
    assert_eq!((shown.status, shown.out.as_str()), (Some(1), ""));
    assert!(shown.err.contains("l.md:8:5"), "{}", shown.err);
    let none = lcm_in(folder.path(), &["lesson", "check"], b"");
    assert_eq!(none.status, Some(2));
}

#[test]
fn many_problems_are_counted_and_the_first_are_printed() {
    let folder = tempfile::tempdir().expect("writable");
    let check = |count: usize| {
        fs::write(folder.path().join("l.md"), lesson_with("", &"![a](b.png)\n\n".repeat(count)))
            .expect("writable");
        lcm_in(folder.path(), &["lesson", "check", "l.md"], b"").err
    };
    let few = check(3);
    assert!(few.matches("error:").count() == 3 && few.ends_with("l.md: 3 problems\n"), "{few}");
    let many = check(60);
    assert_eq!(many.matches("error:").count(), 40, "{many}");
    let said = "l.md: 60 problems: the first 40 are printed, and --json has 20 more\n";
    assert!(many.ends_with(said), "{many}");
    let said = "l.md: at least 200 problems: the first 40 are printed, and --json has 160 more\n";
    assert!(check(300).ends_with(said));
}

/// A lesson with a single step.
fn lesson_with(front: &str, step: &str) -> String {
    format!("---\ntitle: T\nsummary: S.\n{front}---\n\n## One\n\nText.\n\n{step}\n")
}

#[cfg(unix)]
#[test]
fn a_lesson_reads_no_file_outside_its_folder() {
    use std::os::unix::fs::symlink;
    let root = tempfile::tempdir().expect("writable");
    let folder = root.path().join("lesson");
    fs::create_dir_all(folder.join("below")).expect("writable");
    fs::write(root.path().join("secret.json"), "password = hunter2\n").expect("writable");
    fs::write(folder.join("own.json"), "password = hunter3\n").expect("writable");
    symlink("../secret.json", folder.join("link.json")).expect("made");
    symlink("../..", folder.join("below/up")).expect("made");
    symlink("own.json", folder.join("here.json")).expect("made");
    let secret = root.path().join("secret.json").display().to_string();
    for name in ["link.json", "below/up/secret.json", "../secret.json", &secret] {
        for text in [
            lesson_with(&format!("scene: {name}\n"), ""),
            lesson_with("", &format!("```scene\nopen: {name}\n```")),
        ] {
            fs::write(folder.join("lesson.md"), text).expect("writable");
            for path in [folder.clone(), folder.join("lesson.md")] {
                let run = lcm(&["lesson", "check", &path.display().to_string()], "");
                assert_eq!(run.status, Some(1), "{name}: {}", run.out);
                assert!(run.err.contains("is outside the folder of the lesson"), "{name}: {}", run.err);
                assert!(!run.err.contains("hunter"), "{name}: {}", run.err);
            }
        }
    }
    // The user may allow it.
    let scene = include_str!("../../../scenes/default.json");
    fs::write(root.path().join("secret.json"), scene).expect("writable");
    for name in ["link.json", "below/up/secret.json", "../secret.json", &secret] {
        for text in [
            lesson_with(&format!("scene: {name}\n"), ""),
            lesson_with("", &format!("```scene\nopen: {name}\n```")),
        ] {
            fs::write(folder.join("lesson.md"), text).expect("writable");
            let path = folder.display().to_string();
            let check = ["lesson", "check", &path];
            let refused = lcm(&check, "");
            assert!(refused.status == Some(1) && refused.err.contains("--allow-outside"), "{}", refused.err);
            let run = lcm(&[&check[..], &["--allow-outside"]].concat(), "");
            assert_eq!(run.status, Some(0), "{name}: {}", run.err);
        }
    }
    fs::write(root.path().join("secret.json"), "password = hunter2\n").expect("writable");
    // A path that stays inside is read, and its problem reported.
    fs::write(folder.join("lesson.md"), lesson_with("scene: here.json\n", "")).expect("writable");
    let run = lcm(&["lesson", "check", &folder.display().to_string()], "");
    assert!(run.status == Some(1) && run.err.contains("here.json"), "{}", run.err);
    // The text of a folder is in the folder too.
    fs::remove_file(folder.join("lesson.md")).expect("there");
    symlink("../secret.json", folder.join("lesson.md")).expect("made");
    let run = lcm(&["lesson", "check", &folder.display().to_string()], "");
    assert_eq!(run.status, Some(1), "{}", run.out);
    assert!(run.err.contains("outside the folder") && !run.err.contains("hunter"), "{}", run.err);
}

#[test]
fn a_lesson_beyond_its_limits_is_refused_with_the_place_and_the_limit() {
    let nested = |n: usize| format!("```equation\nI = {}x{}\n```", "(".repeat(n), ")".repeat(n));
    let steps = |n: usize| "## S\n\nText.\n\n".repeat(n);
    for (step, expected) in [
        (nested(24), ""),
        (nested(25), "11:29: this is nested more than 24 brackets deep, the most allowed"),
        (nested(5000), "11:29: this is nested more than 24 brackets deep"),
        (nested(20_000), "11:29: this is nested more than 24 brackets deep"),
        (format!("```equation\n{}\n```", "x ".repeat(1001)), "this line of the equation has more than 2000"),
        (format!("```scene\nobjects{} = 1\n```", "[0]".repeat(100_000)), "a path has at most 64 steps"),
        (format!("```scene\n{}```", "exposure = 1\n".repeat(101)), "a scene block sets at most 100 values"),
        ("```scene\nopen: default.json\nopen: portrait.json\n```".to_owned(), "opens two scenes"),
        ("word ".repeat(4001), "characters of text; at most 20000 are allowed"),
        (steps(99), ""),
        (steps(100), "a lesson has at most 100 steps"),
        (format!("```do\nGo.\nuntil: {}\n```", "(".repeat(1000)), "the condition is nested more than 24"),
        (
            format!("```do\nGo.\nuntil: window.selected = \"{}\"\n```", "x".repeat(1001)),
            "more than 1000 characters",
        ),
        (
            format!("```do\nGo.\nuntil: probe.red > 1{}\n```", " and probe.red > 1".repeat(16)),
            "a condition has at most 16 comparisons",
        ),
    ] {
        let folder = tempfile::tempdir().expect("writable");
        fs::write(folder.path().join("l.md"), lesson_with("", &step)).expect("writable");
        let run = lcm_in(folder.path(), &["lesson", "check", "l.md"], b"");
        let shown = &step[..step.len().min(80)];
        if expected.is_empty() {
            assert_eq!(run.status, Some(0), "{shown}: {}", run.err);
        } else {
            assert_eq!(run.status, Some(1), "{shown}: {}", run.out);
            let json = lcm_in(folder.path(), &["lesson", "check", "--json", "l.md"], b"");
            let reports: Value = serde_json::from_str(&json.out).expect("JSON");
            let problem = &reports[0]["problems"][0];
            let said = format!(
                "{}:{}: {}",
                problem["line"],
                problem["column"],
                problem["message"].as_str().unwrap_or_default()
            );
            assert!(said.contains(expected), "{shown}: {said}");
            check_wording(problem["message"].as_str().expect("text"));
        }
    }
}
