//! `lcm lesson`: the list, the check with its exit status, the text of a lesson.

use std::fs;

use lights_camera_models::lesson::shipped::LESSONS;
use serde_json::Value;

use crate::support::{check_wording, lcm, lcm_in};

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
