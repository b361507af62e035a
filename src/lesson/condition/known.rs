//! The facts known when a step begins, to find tasks that are already done.
//!
//! The learner is assumed to change only values named in the conditions of earlier tasks.

use super::{
    Condition, Term,
    evaluate::{self, operands},
    quantity::{Argument, Asked},
};
use crate::{
    document::Selection,
    lesson::{Situation, controls},
    text::path::{Path, Segment},
};

/// The facts that are known when a step begins.
#[derive(Clone, Debug, Default)]
pub struct Knowledge {
    pub selection: Option<Selection>,
    pub channel: bool,
    pub terms: bool,
    pub plots: bool,
    pub explain: bool,
    pub active: bool,
    /// Values of the scene that the learner may have changed.
    changed: Vec<Changed>,
}

/// A value of the scene that the learner may have changed.
#[derive(Clone, Debug)]
enum Changed {
    /// The value at this path.
    At(Path),
    /// Values whose path ends with this key.
    Key(String),
    /// Any value.
    All,
}

impl Changed {
    /// True if the value at a path may have changed.
    fn concerns(&self, path: &Path) -> bool {
        match self {
            Self::All => true,
            Self::At(at) => overlap(at, path),
            Self::Key(name) => names(path, name),
        }
    }
}

/// True if one path contains the other, or if both count or change the same list.
fn overlap(a: &Path, b: &Path) -> bool {
    let (a, b) = (a.segments(), b.segments());
    a.iter().zip(b).all(|(a, b)| a == b) || (a.first() == b.first() && is_count(a) != is_count(b))
}

/// True for the path to the number of entries of a list.
fn is_count(path: &[Segment]) -> bool {
    matches!(path, [_, Segment::Key(count)] if count == "count")
}

/// True if a path ends with this key, or has it before an index.
fn names(path: &Path, name: &str) -> bool {
    path.segments().iter().any(|segment| matches!(segment, Segment::Key(key) if key == name))
}

impl Knowledge {
    /// The facts known on entering a lesson.
    pub(in crate::lesson) fn at_the_beginning() -> Self {
        Self { channel: true, terms: true, active: true, ..Self::default() }
    }

    /// No known facts.
    pub(in crate::lesson) fn lost() -> Self {
        Self { changed: vec![Changed::All], ..Self::default() }
    }

    /// Records that the lesson opened a scene: all its values are known.
    pub(in crate::lesson) fn scene_opened(&mut self) {
        self.changed.clear();
    }

    /// Records that the lesson set the values at and below a path.
    pub(in crate::lesson) fn scene_set(&mut self, path: &Path) {
        let set = path.segments();
        self.changed.retain(|changed| match changed {
            Changed::At(at) => !at.segments().starts_with(set),
            Changed::Key(_) | Changed::All => true,
        });
    }

    /// Records that the learner has done the task of a step.
    pub(in crate::lesson) fn done(&mut self, until: &Condition, is_find: bool) {
        // Clicks select.
        self.selection = None;
        self.explain = false;
        self.plots = false;
        for operand in operands(&until.expression) {
            let Term::Quantity(asked) = &operand.what else { continue };
            match (asked.quantity.name, &asked.argument) {
                (_, Argument::Path(path)) => self.changed.push(Changed::At(path.clone())),
                (_, Argument::Name(name)) => self.changed.push(Changed::Key(name.clone())),
                ("window.channel", _) => self.channel = false,
                ("window.terms" | "window.shows_term_alone", _) => self.terms = false,
                ("window.active", _) => self.active = false,
                ("window.views", _) => {
                    self.changed.push(Changed::At(Path::root().key("variants")));
                    self.active = false;
                }
                ("window.reflection_model", _) => {
                    self.changed.push(Changed::Key("reflection_model".to_owned()))
                }
                ("window.shading_model", _) => self.changed.push(Changed::Key("shading_model".to_owned())),
                // Finding something changes nothing; doing something may change anything.
                (name, _) if !is_find && !name.starts_with("window.") => self.changed.push(Changed::All),
                _ => {}
            }
        }
    }

    fn of(&self, asked: &Asked) -> bool {
        let unchanged = |path: &Path| !self.changed.iter().any(|changed| changed.concerns(path));
        let as_it_was = self.changed.is_empty();
        match (asked.quantity.name, &asked.argument) {
            ("window.selected" | "window.selected_index", _) => self.selection.is_some(),
            ("window.channel", _) => self.channel,
            ("window.terms" | "window.shows_term_alone", _) => self.terms,
            ("window.plots", _) => self.plots,
            ("window.explain", _) => self.explain,
            ("window.active", _) => self.active,
            ("window.views", _) => unchanged(&Path::root().key("variants").key("count")),
            ("window.presenting", _) => false,
            // Files are the learner's own.
            (name, _) if name.starts_with("code.") => false,
            (_, Argument::Path(path)) => self.active && unchanged(path),
            (_, Argument::Name(name)) => {
                let path = match self.selection {
                    _ if controls::is_of_display(name) => Path::root().key("display"),
                    Some(Selection::Object(i)) => Path::root().key("objects").index(i),
                    Some(Selection::Light(i)) => Path::root().key("lights").index(i),
                    Some(Selection::Observer) => Path::root().key("observer"),
                    Some(Selection::Room) | None => return false,
                };
                let within = |at: &Path| at.segments().starts_with(path.segments()) && names(at, name);
                self.active
                    && !self.changed.iter().any(|changed| match changed {
                        Changed::All => true,
                        Changed::Key(key) => key == name,
                        Changed::At(at) => within(at) || path.segments().starts_with(at.segments()),
                    })
            }
            _ => asked.group() != "probe" && as_it_was && self.active && self.selection.is_some(),
        }
    }
}

impl Condition {
    /// True if the condition certainly holds when the step begins.
    pub(in crate::lesson) fn holds_at_once(&self, situation: &Situation, known: &Knowledge) -> bool {
        let ask = |asked: &Asked| {
            if known.of(asked) { asked.value(situation) } else { Err(String::new()) }
        };
        evaluate::holds(&self.expression, &ask) == Some(true)
    }
}
