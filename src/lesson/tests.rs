//! Tests of lessons.

use std::fs;

use super::*;
use crate::lesson::shipped::{LESSONS, TEXTS};

fn read(text: &str) -> Result<Lesson, Vec<Problem>> {
    Lesson::from_text(text, "test", None, &Registry::builtin())
}

/// A lesson with these steps.
fn with(steps: &str) -> String {
    format!("---\ntitle: T\nsummary: S.\n---\n\n{steps}")
}

/// The problems as lines.
fn problems(text: &str) -> Vec<String> {
    read(text).err().unwrap_or_default().iter().map(ToString::to_string).collect()
}

#[test]
fn every_file_of_the_folder_is_shipped_and_without_a_problem() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/lessons");
    let mut files: Vec<_> = fs::read_dir(folder)
        .map(|entries| {
            let names =
                entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned());
            names.filter_map(|name| name.strip_suffix(".md").map(str::to_owned)).collect()
        })
        .unwrap_or_default();
    let mut known: Vec<_> = TEXTS.iter().map(|(name, _)| (*name).to_owned()).collect();
    files.sort();
    known.sort();
    assert_eq!(known, files);
    let registry = Registry::builtin();
    for (name, text) in TEXTS {
        let found = Lesson::from_text(text, name, None, &registry);
        let lines: Vec<_> = found.err().unwrap_or_default().iter().map(|p| p.annotated(name)).collect();
        assert!(lines.is_empty(), "{}", lines.join("\n"));
    }
    assert_eq!(LESSONS.len(), TEXTS.len());
    for lesson in LESSONS.iter() {
        for step in 0..lesson.steps.len() {
            lesson.state(step, &registry).expect(&lesson.id);
        }
    }
}

const WHOLE: &str = r#"---
title: Highlights
summary: How wide they are.
minutes: 7
scene: gouraud_misses_highlight.json
---

## Look

A *matte* and a **shiny** body with `alpha` and k_d, where N·L
goes on.

1. One.
2. Two
   - within

```equation
I = k_d max(0, N·L)
```

## Narrow it

```scene
objects[0].material.alpha = 20
shading_model = "phong"
```

```view
channel: n_dot_h
terms: specular
explain: on
markers: off
plots: albedo
active: A
select: object 1
pin: 0.25, 0.5
```

```point
knob: alpha
part: light "key light"
line: θ_t
```

```do
Raise α until the highlight is
narrower than 5°.
until: curve.highlight_width < 5°
hint: The knob **α**.
```

## Guess

```predict
Which is *brighter*?
[ ] The left. | No: far away.
[x] The right,
that is near. | Yes.
```
"#;

#[test]
fn a_lesson_is_read_with_all_its_parts() {
    let registry = Registry::builtin();
    let lesson = read(WHOLE).expect("sound");
    assert_eq!((lesson.title.as_str(), lesson.minutes), ("Highlights", Some(7)));
    assert_eq!(lesson.start.name.as_deref(), Some("Gouraud misses a highlight"));
    let [look, narrow, guess] = &lesson.steps[..] else { panic!("{} steps", lesson.steps.len()) };
    let run = |text: &str, style| Run { text: text.to_owned(), style };
    let Block::Paragraph(runs) = &look.blocks[0] else { panic!("{:?}", look.blocks) };
    assert_eq!(runs[1], run("matte", RunStyle::Emphasis));
    assert_eq!(runs[3], run("shiny", RunStyle::Strong));
    assert_eq!(runs[5], run("alpha", RunStyle::Code));
    assert_eq!(runs[6], run(" and k_d, where N·L goes on.", RunStyle::Plain));
    let items: Vec<_> = look
        .blocks
        .iter()
        .filter_map(|block| match block {
            Block::Item { number, depth, runs } => Some((*number, *depth, plain(runs))),
            _ => None,
        })
        .collect();
    let text = |text: &str| text.to_owned();
    assert_eq!(items, [(Some(1), 0, text("One.")), (Some(2), 0, text("Two")), (None, 1, text("within"))]);
    assert_eq!(look.blocks.last(), Some(&Block::Equation("I = k_d max(0, N·L)".to_owned())));
    assert_eq!(narrow.window.channel, Some(Some(DebugChannel::NDotH)));
    assert_eq!(narrow.window.terms, Some(TermSelection::Specular));
    assert_eq!((narrow.window.explain, narrow.window.active), (Some(true), Some(0)));
    assert_eq!((narrow.window.markers, narrow.window.plots), (Some(false), Some(Some(Kind::Albedo))));
    assert_eq!(narrow.window.pin, Some(Some([0.25, 0.5])));
    assert_eq!(narrow.window.select, Some(PartName::Object(Which::Number(1))));
    let light = PartName::Light(Which::Name("key light".to_owned()));
    let line = Control::Line("θ_t".to_owned());
    assert_eq!(narrow.points, [Control::Knob("alpha".to_owned()), Control::Part(light.clone()), line]);
    assert_eq!(light.find(&lesson.start), Some(Selection::Light(0)));
    let goal = narrow.task.as_ref().and_then(Task::goal).expect("a task");
    assert_eq!(plain(&goal.text), "Raise α until the highlight is narrower than 5°.");
    assert_eq!(goal.until.text(), "curve.highlight_width < 5°");
    assert_eq!(goal.hint.as_deref().map(plain).as_deref(), Some("The knob α."));
    let Some(Task::Predict { question, answers }) = &guess.task else { panic!("{:?}", guess.task) };
    assert_eq!(plain(question), "Which is brighter?");
    assert_eq!(answers.iter().map(|a| a.right).collect::<Vec<_>>(), [false, true]);
    assert_eq!(plain(&answers[1].text), "The right, that is near.");
    assert_eq!(plain(&answers[1].feedback), "Yes.");
    // The scene of a step is the previous one with changes.
    let [first, second, third] = [0, 1, 2].map(|step| lesson.state(step, &registry).expect("legal"));
    assert_eq!(first, *lesson.start);
    assert_eq!(second.objects[0].material.0["alpha"], crate::parameter::Value::Integer(20));
    assert_eq!((second.shading_model.as_str(), &third), ("phong", &second));
    assert!(lesson.state(3, &registry).is_err());
}

/// A mistake in a lesson: the steps, and the beginning of the only problem.
const MISTAKES: &[(&str, &str)] = &[
    // Markdown that is not shown.
    ("text\n\n## S\n\nt\n", "6:1: there is text before the first step"),
    ("## S\n\n# T\n\nt\n", "8:1: headings of steps begin with ##"),
    ("## S\n\n### T\n\nt\n", "8:1: headings of steps begin with ##"),
    ("## S\n\nText\n---\n", "8:1: a line of - or = below text makes it a heading"),
    ("## S\n\nt\n\n##\n\nu\n", "10:1: the step has no name"),
    ("## S\n\n## T\n\nt\n", "6:1: the step is empty"),
    ("## S\n\nSee ![p](q.png).\n", "8:5: images are not shown"),
    ("## S\n\nSee [p](q).\n", "8:5: links and footnotes are not shown"),
    ("## S\n\nt\n\n[p]: q\n", "10:1: links and footnotes are not shown"),
    ("## S\n\nA <b> c\n", "8:3: HTML is not shown"),
    ("## S\n\n<div>\nx\n</div>\n", "8:1: HTML is not shown"),
    ("## S\n\n| a |\n|---|\n| b |\n", "8:1: tables are not shown"),
    ("## S\n\n> a\n", "8:1: quotations are not shown"),
    ("## S\n\nt\n\n---\n\nu\n", "10:1: rules are not shown"),
    ("## S\n\nA ~~b~~.\n", "8:3: struck text is not shown"),
    ("## S\n\n    indented\n", "8:5: text indented by four spaces"),
    ("## S\n\n- a\n\n  b\n", "10:3: an item of a list is one paragraph"),
    ("## S\n\n- a\n  - b\n    - c\n      - d\n", "11:7: lists within lists are at most 3 deep"),
    ("## S\n\n-\n- b\n", "8:1: this item of a list is empty"),
    ("## S\n\n- a\n  ```view\n  terms: all\n  ```\n", "9:3: a block cannot be in a list"),
    // Blocks.
    ("## S\n\n```\nx\n```\n", "8:1: this is a block without a kind; a block is equation"),
    (
        "## S\n\n```sceen\nx\n```\n",
        "8:1: this is a block \"sceen\"; a block is equation, scene, view, point, predict, do or find; did you mean \"scene\"?",
    ),
    ("## S\n\n```view\n\n```\n", "8:1: the view block is empty"),
    ("## S\n\n```view\nterms: all\n", "8:1: this block is never closed; end it with a line ```"),
    ("## S\n\n```view\nterms: all\n```\n\n```view\nactive: A\n```\n", "12:1: the step has two view blocks"),
    (
        "## S\n\n```do\nX.\nuntil: probe.pinned\n```\n\n```find\nX.\nuntil: probe.pinned\n```\n",
        "13:1: the step has two tasks",
    ),
    // The window.
    ("## S\n\n```view\nchanel: n_dot_l\n```\n", "9:1: a view block has no setting \"chanel\""),
    ("## S\n\n```view\nchannel: n_dot_q\n```\n", "9:10: channel is \"n_dot_q\", but it must be"),
    ("## S\n\n```view\nnonsense\n```\n", "9:1: each line of a view block must be SETTING: VALUE"),
    ("## S\n\n```view\nterms: all\nterms: all\n```\n", "10:1: terms is given twice"),
    (
        "## S\n\n```view\npin: NaN, 0\n```\n",
        "9:6: this is \"NaN, 0\", but pin must be none, or two numbers from 0 to 1",
    ),
    ("## S\n\n```view\npin: 0.5, 1.5\n```\n", "9:6: this is \"0.5, 1.5\", but pin must be"),
    ("## S\n\n```view\nactive: B\n```\n", "9:9: there is no view B: the scene has 1 view"),
    ("## S\n\n```view\nselect: object 2\n```\n", "9:9: there is no such part: the scene has 1 object"),
    ("## S\n\n```view\nselect: object 0\n```\n", "9:9: this is \"object 0\", but a part must be"),
    ("## S\n\n```point\nknob: alhpa\n```\n", "9:7: there is no knob \"alhpa\"; did you mean \"alpha\"?"),
    (
        "## S\n\n```point\nmenu: Windows\n```\n",
        "9:7: there is no menu \"Windows\"; it must be File, Edit, View or Help",
    ),
    ("## S\n\n```point\ntab: plot\n```\n", "9:6: there is no tab \"plot\""),
    ("## S\n\n```point\nline: n\n```\n", "9:7: there is no line \"n\"; it must be θ_r, θ_t, θ_c, F or w_1"),
    ("## S\n\n```view\nmarkers: no\n```\n", "9:10: markers is \"no\", but it must be on or off"),
    ("## S\n\n```point\nlamp: x\n```\n", "9:1: a lesson cannot point at a \"lamp\""),
    ("## S\n\n```point\npart: light \"sun\"\n```\n", "9:7: there is no such part: the scene has 1 light"),
    // Near misses.
    (
        "## S\n\n```scene\nobjects[0].size = 3\nshading_model: \"phong\"\n```\n",
        "10:14: a scene block sets values with =; write shading_model = \"phong\"",
    ),
    (
        "## S\n\n```scene\nshading_model:\n```\n",
        "9:14: a scene block sets values with =; write shading_model = VALUE",
    ),
    (
        "## S\n\n```do\nX.\nuntil: probe.pinned\ntip: Press **E**.\n```\n",
        "11:1: a task has no key \"tip\"; its keys are until and hint; did you mean hint:?",
    ),
    (
        "## S\n\n```do\nX.\nuntil: probe.pinned\nfoo: Press **E**.\n```\n",
        "11:1: a task has no key \"foo\"; its keys are until and hint",
    ),
    (
        "## S\n\n```do\nX.\nuntill: probe.pinned\n```\n",
        "10:1: a task has no \"untill\"; did you mean until:?",
    ),
    (
        "## S\n\n```scene\nobjects[0].name = \"tomato\"\n```\n\n```view\nselect: tomato\n```\n",
        "13:9: this is \"tomato\", but a part must be room, observer, object N or light N, with its number from 1 or its name in quotes; did you mean object \"tomato\"?",
    ),
    (
        "## S\n\n```point\npart: light Key-Light\n```\n",
        "9:7: this is \"light Key-Light\", but a part must be",
    ),
    ("## S\n\n```view\nchannel: ndotl\n```\n", "9:10: channel is \"ndotl\", but it must be"),
    (
        "## S\n\n```do\nX.\nuntil: probe.pinned\n```\n\n### Try it\n\n```do\nX.\nuntil: probe.pinned\n```\n",
        "13:1: headings of steps begin with ##",
    ),
    // Brackets and emphasis.
    ("## S\n\n```equation\nI = max(0, N·L I(p)\n```\n", "9:8: this bracket is never closed"),
    ("## S\n\n```equation\nI = k_d\n  + a) b\n```\n", "10:6: there is no opening bracket for this one"),
    ("## S\n\n```equation\nI = {a]\n```\n", "9:7: there is no opening bracket for this one"),
    ("## S\n\nA **bold* word.\n", "8:3: this * is not paired"),
    ("## S\n\nA **bold word.\n", "8:3: this * is not paired"),
    ("## S\n\nA word* here.\n", "8:7: this * is not paired"),
    ("## S\n\nA `word here.\n", "8:3: this ` is not paired: code is `word`; write \\` for the sign itself"),
    ("## S\n\n```do\nPress **E*.\nuntil: probe.pinned\n```\n", "9:7: this * is not paired"),
    // Scenes.
    (
        "## S\n\n```scene\nnonsense\n```\n",
        "9:1: each line of a scene block must be PATH = VALUE or open: FILE",
    ),
    (
        "## S\n\n```scene\nopen: nowhere.json\n```\n",
        "9:7: the scene \"nowhere.json\" is not among the shipped scenes",
    ),
    (
        "## S\n\n```scene\nopen: defalt.json\n```\n",
        "9:7: the scene \"defalt.json\" is not among the shipped scenes; did you mean \"default.json\"?",
    ),
    ("## S\n\n```scene\nopen: ../x.json\n```\n", "9:7: \"../x.json\" is outside the folder"),
    ("## S\n\n```scene\nshading_model = phong\n```\n", "9:17: "),
    ("## S\n\n```scene\nobjects[0].size = NaN\n```\n", "9:19: NaN is not a number in JSON"),
    ("## S\n\n```scene\nobjects[0].size =\n```\n", "9:18: the value is missing"),
    ("## S\n\n```scene\nobjects[0].size = [1,\n```\n", "9:22: the value ends too early"),
    ("## S\n\n```scene\nobjects[x].size = 1\n```\n", "9:9: \"x\" is not an index"),
    (
        "## S\n\n```scene\nobjects[5].size = 1\n```\n",
        "9:1: objects[5].size does not exist: the list has 1 entries",
    ),
    ("## S\n\n```scene\nobjects[0].size = -1\n```\n", "9:1: objects[0].size is -1, but"),
    ("## S\n\n```scene\nobjects[0].sise = 1\n```\n", "9:1: objects[0].sise "),
    ("## S\n\n```scene\nobjects[0].material.shininess = 1\n```\n", "9:1: objects[0].material.shininess "),
    // Questions.
    ("## S\n\n```predict\nQ?\n[ ] a | b\n[ ] c | d\n```\n", "8:1: the question has no right answer"),
    ("## S\n\n```predict\nQ?\n[x] a | b\n[x] c | d\n```\n", "8:1: the question has no wrong answer"),
    ("## S\n\n```predict\nQ?\n[x] a | b\n```\n", "8:1: a question needs at least two answers"),
    ("## S\n\n```predict\n[x] a | b\n[ ] c | d\n```\n", "8:1: the question is missing"),
    ("## S\n\n```predict\nQ?\n[x] a\n[ ] c | d\n```\n", "10:1: this answer has no feedback"),
    ("## S\n\n```predict\nQ?\n[x] a | b\n[ ] | d\n```\n", "11:1: this answer is empty"),
    ("## S\n\n```predict\nQ?\n[x] a | b\n[ ] c | ![d](e)\n```\n", "11:9: images are not shown"),
    // Tasks.
    ("## S\n\n```do\nX.\n```\n", "8:1: the task has no condition"),
    ("## S\n\n```do\nuntil: probe.pinned\n```\n", "8:1: the task is missing"),
    ("## S\n\n```do\nX.\nuntil: probe.pinned\nhint:\n```\n", "11:6: the hint is empty"),
    ("## S\n\n```do\nX.\nuntil: probe.pinned\nuntil: probe.pinned\n```\n", "11:1: until is given twice"),
    (
        "## S\n\n```do\nX.\nuntil: scene.objects[0].size = 2\n```\n",
        "10:8: the task is already done when the step begins",
    ),
    (
        "## S\n\n```view\nterms: specular\n```\n\n```do\nX.\nuntil: window.terms = \"specular\"\n```\n",
        "14:8: the task is already done",
    ),
];

#[test]
fn every_mistake_is_said_at_its_place() {
    let mut wrong = Vec::new();
    for (steps, expected) in MISTAKES {
        let found = problems(&with(steps));
        if found.len() != 1 || !found[0].starts_with(expected) {
            wrong.push(format!("{steps}{found:#?}\nis not\n{expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn what_looks_like_a_mistake_and_is_none_is_taken() {
    for steps in [
        "## S\n\n2 * 3, 2*3, \\*, \\**, \\`, ***both***, **a** *b* `c*`.\n",
        "## S\n\n```equation\nx ∈ [0, 1), |f(x)| = {a}\n```\n",
        "## S\n\n```scene\nvariants[0] = {\n  \"name\": \"B\",\n  \"exposure\":\n   1\n}\n```\n",
        "## S\n\n```do\nNote: X: y.\nuntil: probe.pinned\nhint: tip: z\nnote: more\n```\n",
    ] {
        assert_eq!(problems(&with(steps)), [""; 0], "{steps}");
    }
}

#[test]
fn names_that_are_near_are_offered() {
    for (line, near) in [
        ("select: Tomato", "object \"tomato\""),
        ("select: object tomatoe", "object \"tomato\""),
        ("select: key light", "light \"key light\""),
        ("select: light key light", "light \"key light\""),
        ("channel: ndotl", "\"n_dot_l\""),
    ] {
        let scene = "objects[0].name = \"tomato\"\nlights[0].name = \"key light\"";
        let found = problems(&with(&format!("## S\n\n```scene\n{scene}\n```\n\n```view\n{line}\n```\n")));
        assert!(found.len() == 1 && found[0].ends_with(&format!("; did you mean {near}?")), "{found:?}");
    }
    let far = problems(&with("## S\n\n```view\nselect: elephant\n```\n"));
    assert!(far.len() == 1 && far[0].ends_with("its name in quotes"), "{far:?}");
}

/// The learner is assumed to change only values named in tasks.
#[test]
fn a_task_that_is_done_before_it_begins_is_found_in_later_steps_too() {
    let task = |kind: &str, until: &str| format!("```{kind}\nX.\nuntil: {until}\n```\n");
    let two = |first: &str, extra: &str, second: &str| {
        let done = |line: &String| line.contains("already done");
        let found = problems(&with(&format!("## A\n\n{first}\n## B\n\n{extra}{second}")));
        assert!(found.iter().all(done) && found.len() < 2, "{found:?}");
        !found.is_empty()
    };
    let select = "```view\nselect: object 1\nactive: A\n```\n";
    for (kind, first, then, is_done) in [
        ("do", "scene.objects[0].size > 3", "scene.lights.count >= 1", true),
        ("do", "scene.objects[0].size > 3", "scene.lights[0].intensity > 1", true),
        ("do", "scene.objects[0].size > 3", "window.views >= 1", true),
        ("do", "scene.objects[0].size > 3", "scene.objects[0].size > 1", false),
        ("do", "scene.objects.count = 2", "scene.objects[0].size = 2", false),
        ("do", "scene.objects[0].size > 3", "scene.objects.count = 1", false),
        ("do", "window.terms = \"specular\"", "scene.lights.count = 1 and window.channel = \"none\"", true),
        ("do", "window.terms = \"specular\"", "window.terms = \"all\"", false),
        ("do", "window.terms = \"specular\"", "window.shows_term_alone", false),
        ("do", "window.channel = \"n_dot_l\"", "window.channel = \"none\"", false),
        ("do", "window.views = 2", "window.views = 1", false),
        ("do", "window.views = 2", "scene.variants.count = 0", false),
        ("do", "window.active = \"B\" or window.terms = \"diffuse\"", "scene.lights.count = 1", false),
        // The luminance can be changed by anything, but finding it changes nothing.
        ("do", "probe.luminance > 3", "scene.lights.count = 1", false),
        ("find", "probe.luminance > 3", "scene.lights.count = 1", true),
        ("find", "probe.luminance > 3", "window.explain", false),
        ("do", "knob.alpha > 300", "scene.objects[0].material.alpha = 32", false),
        ("do", "knob.alpha > 300", "scene.objects[0].material.k_s = 0.5", true),
        ("do", "window.reflection_model = \"phong\"", "scene.reflection_model = \"lambert\"", false),
        ("do", "window.shading_model = \"phong\"", "scene.objects[0].shading_model = \"gouraud\"", false),
        ("do", "curve.peak > 1", "scene.objects[0].size = 2", false),
    ] {
        let first_task = format!("{select}\n{}", task(kind, first));
        assert_eq!(two(&first_task, "", &task("do", then)), is_done, "{first}; {then}");
    }
    // Parameters and curves depend on the selection, which a click may have changed.
    let first = format!("{select}\n{}", task("do", "knob.alpha > 300"));
    assert!(!two(&first, "", &task("do", "knob.k_s = 0.5")));
    assert!(two(&first, &format!("{select}\n"), &task("do", "knob.k_s = 0.5")));
    assert!(!two(&first, &format!("{select}\n"), &task("do", "knob.alpha = 32")));
    assert!(!two(&first, &format!("{select}\n"), &task("do", "curve.peak >= 0")));
    // Values set by a step are known again.
    let size = task("do", "scene.objects[0].size > 3");
    let set = "```scene\nobjects[0].size = 4\n```\n\n";
    assert!(two(&size, set, &task("do", "scene.objects[0].size = 4")));
    let open = "```scene\nopen: default.json\n```\n\n";
    assert!(two(&size, open, &task("do", "scene.objects[0].size > 1")));
    // A task that cannot be read may have been about anything.
    let broken = problems(&with(&format!(
        "## A\n\n{}\n## B\n\n{}",
        task("do", "probe.pined"),
        task("do", "scene.lights.count = 1")
    )));
    assert!(broken.len() == 1 && broken[0].contains("probe.pined"), "{broken:?}");
}

#[test]
fn mistakes_of_the_whole_text_are_said_too() {
    let step = "## S\n\nt\n";
    let deep = format!("## S\n\n{}\n", ">".repeat(20_000));
    let cases: &[(&str, &[&str])] = &[
        ("", &["1:1: the lesson is empty", "1:1: the lesson has no step"]),
        (step, &["1:1: the front matter is missing"]),
        ("---\ntitle: T\nsummary: S.\n---\n", &["5:1: the lesson has no step"]),
        (&format!("---\ntitle: T\n---\n{step}"), &["1:1: the front matter has no summary"]),
        (&format!("---\ntitle: T\nsummary: S.\n{step}"), &["1:1: the front matter is never closed"]),
        (&format!("---\ntitle: T\nsummary: S.\ntitle: U\n---\n{step}"), &["4:1: title is given twice"]),
        (&format!("---\ntitle: T\nsummary:\n---\n{step}"), &["3:9: summary is empty"]),
        (
            &format!("---\ntitle: T\nsummary: S.\nminutes: NaN\n---\n{step}"),
            &["4:10: minutes is \"NaN\", but"],
        ),
        (&format!("---\ntitle: T\nsummary: S.\nminutes: 0\n---\n{step}"), &["4:10: minutes is \"0\", but"]),
        (
            &format!("---\ntitle: T\nsummary: S.\nsumary: 0\n---\n{step}"),
            &["4:1: the front matter has no key \"sumary\""],
        ),
        (
            &format!("---\ntitle: T\nsummary: S.\nnonsense\n---\n{step}"),
            &["4:1: each line of the front matter must be KEY: VALUE"],
        ),
        (
            &format!("---\ntitle: T\nsummary: S.\nscene: x.json\n---\n{step}"),
            &["4:8: the scene \"x.json\" is not among"],
        ),
        // Twice: the second is a heading because of its line.
        (
            &format!("---\ntitle: T\nsummary: S.\n---\n\n---\ntitle: T\n---\n\n{step}"),
            &["6:1: rules are not shown", "7:1: a line of - or = below text"],
        ),
        (&with(&deep), &["8:1: quotations are not shown"]),
    ];
    let mut wrong = Vec::new();
    for (text, expected) in cases {
        let found = problems(text);
        if found.len() != expected.len() || found.iter().zip(*expected).any(|(f, e)| !f.starts_with(e)) {
            wrong.push(format!("{found:#?}\nis not\n{expected:#?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    // With any line ends, and with a byte order mark.
    let lines = WHOLE.replace('\n', "\r\n");
    let other = read(&format!("\u{feff}{lines}")).expect("sound");
    let one = read(WHOLE).expect("sound");
    for (a, b) in one.steps.iter().zip(&other.steps) {
        assert_eq!(a.blocks, b.blocks);
    }
    let broken = with("## S\n\n```view\nterms: al\n```\n").replace('\n', "\r\n");
    assert!(problems(&broken)[0].starts_with("9:8: terms is \"al\""), "{:?}", problems(&broken));
}

#[test]
fn all_mistakes_are_said_at_once_and_with_their_lines() {
    let text = with("## S\n\n![a](b)\n\n```view\nterms: al\n```\n\n```do\nX.\nuntil: probe.pined\n```\n");
    let found = read(&text).expect_err("broken");
    assert_eq!(found.len(), 3, "{found:#?}");
    let shown = found[2].annotated("l.md");
    assert!(
        shown.contains("there is no quantity \"probe.pined\"; did you mean \"probe.pinned\"?"),
        "{shown}"
    );
    assert!(shown.contains("l.md:16:8") && shown.contains("until: probe.pined"), "{shown}");
    let column = |sign| shown.lines().find_map(|line| line.find(sign));
    assert_eq!(
        column('^'),
        shown.lines().find_map(|line| line.find("probe.pined").filter(|_| line.contains("until")))
    );
}

#[test]
fn mistakes_in_long_lines_have_their_column() {
    let equation =
        |line: &str| read(&with(&format!("## S\n\nt\n\n```equation\n{line}\n```\n"))).expect_err("long");
    let found = equation(&"x + ".repeat(600));
    assert!(found[0].message.contains("more than 2000 characters"), "{found:#?}");
    let shown = found[0].annotated("l.md");
    assert!(shown.contains("l.md:11:2001") && shown.contains('^'), "{shown}");
    let far = Problem {
        place: Some(crate::text::place::Place { line: 3, column: 90_000 }),
        source: "x".repeat(4000),
        ..found[0].clone()
    };
    let shown = far.annotated("l.md");
    assert!(shown.contains("l.md:3:90000") && !shown.contains('^') && shown.contains("error: "), "{shown}");
}

#[test]
fn files_that_are_no_lessons_are_refused_in_words() {
    let folder = tempfile::tempdir().expect("writable");
    let at = |name: &str| folder.path().join(name);
    let registry = Registry::builtin();
    let said = |path: &std::path::Path| {
        let problems = Lesson::read(path, &registry, Outside::NONE).expect_err("no lesson");
        assert_eq!(problems.len(), 1);
        problems[0].to_string()
    };
    assert_eq!(said(&at("none.md")), "file not found");
    assert!(said(folder.path()).starts_with("the folder has no lesson.md"));
    let file = fs::File::create(at("large.md")).expect("writable");
    file.set_len(limits::MAX_FILE_BYTES + 1).expect("writable");
    assert_eq!(said(&at("large.md")), "the file is larger than 1 MiB, the most allowed for a lesson");
    fs::write(at("latin.md"), b"---\ntitle: L\xFCcke\n").expect("writable");
    assert!(
        said(&at("latin.md")).starts_with("2:9: not UTF-8 text: unexpected byte 0xFC"),
        "{}",
        said(&at("latin.md"))
    );
    fs::write(at("zero.md"), b"---\n\0").expect("writable");
    assert!(said(&at("zero.md")).starts_with("2:1: not UTF-8 text: there is a zero byte"));
    // A folder with its own scene, which takes precedence over a shipped scene of the same name.
    let own = crate::scene::save::to_json(
        &Scene { name: Some("Own".to_owned()), ..Scene::default() },
        None,
        &registry,
    );
    fs::write(at("default.json"), own).expect("writable");
    fs::write(at("lesson.md"), "\u{feff}---\ntitle: T\nsummary: S.\nscene: default.json\n---\n## S\n\nt\n")
        .expect("writable");
    let lesson = Lesson::read(folder.path(), &registry, Outside::NONE).expect("sound");
    assert_eq!(lesson.start.name.as_deref(), Some("Own"));
    assert_eq!(Some(lesson.id.as_str()), folder.path().file_name().and_then(|name| name.to_str()));
    fs::write(at("default.json"), "{").expect("writable");
    assert!(said(folder.path()).starts_with("4:8: "), "{}", said(folder.path()));
}

#[test]
fn scenes_of_many_parts_may_change_in_few_steps_only() {
    let object = r#"{ "type": "sphere", "position": [5, 5, 5] }"#;
    let step = |change: &str| format!("## S\n\nt\n\n```scene\n{change}\n```\n\n");
    let first = step(&format!("objects = [{}]", vec![object; 9_000].join(",")));
    let change = step("display.exposure = 1");
    let found = problems(&with(&(first.clone() + &change.repeat(40))));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("objects and lights together; at most 250000 are allowed"), "{found:?}");
    // The 28th step, of eight lines each.
    assert!(found[0].starts_with(&format!("{}:1: ", 6 + 8 * 27)), "{found:?}");
    assert!(read(&with(&(first + &change.repeat(3)))).is_ok());
}

#[test]
fn the_scene_of_a_step_takes_values_of_all_kinds() {
    let text = with(
        "## S\n\n```scene\nopen: shapes_and_lights.json\nlights[0].enabled = false\nvariants[0] = {\n  \"name\": \"B\",\n  \"exposure\": 1\n}\ndisplay.exposure = -1\n```\n\n```view\nactive: B\n```\n",
    );
    let lesson = read(&text).expect("sound");
    let scene = lesson.state(0, &Registry::builtin()).expect("legal");
    assert!(!scene.lights[0].enabled && scene.objects.len() > 1);
    assert_eq!((scene.variants[0].exposure, scene.display.exposure), (Some(1.0), -1.0));
    let removed = with("## S\n\n```scene\nopen: shapes_and_lights.json\nlights[0] = null\n```\n");
    let without = read(&removed).expect("sound").state(0, &Registry::builtin()).expect("legal");
    assert_eq!(without.lights[..], scene.lights[1..]);
}

#[test]
fn a_lesson_can_be_read_as_text() {
    let text = read(WHOLE).expect("sound").to_text();
    for line in [
        "Highlights\n====",
        "1. Look\n----",
        "  - within",
        "    I = k_d max(0, N·L)",
        "  Until: curve.highlight_width < 5°",
        "  [x] The right, that is near.",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

/// Pieces of lessons are removed, doubled and mixed: nothing panics, and every problem has a position in the
/// text.
#[test]
fn broken_lessons_never_panic() {
    let mut texts: Vec<String> = TEXTS.iter().map(|(_, text)| (*text).to_owned()).collect();
    texts.push(WHOLE.to_owned());
    let signs = [
        "`",
        "```",
        "\n",
        "#",
        "|",
        "[",
        "]",
        "(",
        ")",
        "*",
        "\"",
        "=",
        "é",
        "\0",
        "<",
        "&",
        "-",
        "  ",
        "NaN",
        "9".repeat(400).leak(),
    ];
    let mut state = 1u64;
    let mut random = |below: usize| {
        // SplitMix64, G. Steele et al. (2014).
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % below.max(1) as u64) as usize
    };
    for round in 0..400 {
        let mut letters: Vec<char> = texts[round % texts.len()].chars().collect();
        for _ in 0..=random(4) {
            let at = random(letters.len());
            match random(3) {
                0 => {
                    let end = (at + random(60)).min(letters.len());
                    letters.drain(at..end);
                }
                1 => {
                    let end = (at + random(60)).min(letters.len());
                    let copy: Vec<_> = letters[at..end].to_vec();
                    let to = random(letters.len());
                    letters.splice(to..to, copy);
                }
                _ => {
                    letters.splice(at..at, signs[random(signs.len())].chars());
                }
            }
        }
        let text: String = letters.into_iter().collect();
        let lines = text.lines().count() + 1;
        for problem in read(&text).err().unwrap_or_default() {
            assert!(problem.place.is_some_and(|place| place.line <= lines), "{problem}\n{text}");
            assert!(problem.annotated("l.md").contains("error"));
        }
    }
}
