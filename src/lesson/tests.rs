//! Tests of lessons.

use std::fs;

use super::*;
use crate::lesson::shipped::{LESSONS, TEXTS};

fn read(text: &str) -> Result<Lesson, Vec<Problem>> {
    Lesson::from_text(text, "test", None, &Registry::builtin())
}

/// A lesson of these steps.
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
plots: albedo
active: A
select: object 1
pin: 0.25, 0.5
```

```point
knob: alpha
part: light "key light"
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
    assert_eq!(narrow.window.plots, Some(Some(Kind::Albedo)));
    assert_eq!(narrow.window.pin, Some(Some([0.25, 0.5])));
    assert_eq!(narrow.window.select, Some(PartName::Object(Which::Number(1))));
    let light = PartName::Light(Which::Name("key light".to_owned()));
    assert_eq!(narrow.points, [Control::Knob("alpha".to_owned()), Control::Part(light.clone())]);
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
    // The scene of a step is that of the one before, changed.
    let [first, second, third] = [0, 1, 2].map(|step| lesson.state(step, &registry).expect("legal"));
    assert_eq!(first, *lesson.start);
    assert_eq!(second.objects[0].material.0["alpha"], crate::parameter::Value::Integer(20));
    assert_eq!((second.shading_model.as_str(), &third), ("phong", &second));
    assert!(lesson.state(3, &registry).is_err());
}
