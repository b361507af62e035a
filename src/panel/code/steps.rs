//! Steps of undoing, as in other editors: what is typed in one go is one step, and a new line, a paste, a move of the
//! cursor, a rest and a change from typing to deleting each begin another. egui's own steps end at a rest alone.

use std::{collections::VecDeque, sync::Arc};

/// Rest after which what is typed is another step, seconds.
const REST: f64 = 1.0;
/// Most bytes that the steps of one text keep.
const MOST_BYTES: usize = 16 << 20;

/// A text with its cursor, and the other end of the selection, in bytes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    pub(super) text: Arc<str>,
    pub(super) cursor: [usize; 2],
}

/// The steps of one text.
#[derive(Debug, Default)]
pub(super) struct Steps {
    /// The texts before each step, and the bytes that they take.
    done: VecDeque<State>,
    bytes: usize,
    /// The texts that were undone, the latest at the end.
    undone: Vec<State>,
    /// The step that typing continues: true if it inserts, and the time of its last change in seconds.
    open: Option<(bool, f64)>,
}

impl Steps {
    /// Records that a text becomes another. `typed` is the time if it was typed; anything else is a step of its own.
    pub(super) fn record(&mut self, before: State, now: &str, typed: Option<f64>) {
        let lines = |text: &str| text.matches('\n').count();
        let inserts = now.len() > before.text.len();
        let continues = self.open.zip(typed).is_some_and(|((inserted, last), time)| {
            inserted == inserts && time - last < REST && lines(now) <= lines(&before.text)
        });
        self.undone.clear();
        if !continues {
            self.keep(before);
        }
        self.open = typed.map(|time| (inserts, time));
    }

    /// Ends the step that typing would continue.
    pub(super) fn end(&mut self) {
        self.open = None;
    }

    /// Keeps a text that undoing brings back.
    pub(super) fn keep(&mut self, state: State) {
        self.end();
        if self.done.back().is_some_and(|last| last.text == state.text) {
            return;
        }
        self.bytes += state.text.len();
        self.done.push_back(state);
        while self.bytes > MOST_BYTES
            && let Some(first) = self.done.pop_front()
        {
            self.bytes -= first.text.len();
        }
    }

    /// The text before the last step.
    pub(super) fn undo(&mut self, now: State) -> Option<State> {
        self.end();
        while let Some(before) = self.done.pop_back() {
            self.bytes -= before.text.len();
            if before.text != now.text {
                self.undone.push(now);
                return Some(before);
            }
        }
        None
    }

    /// The text before the last step was undone.
    pub(super) fn redo(&mut self, now: State) -> Option<State> {
        let after = self.undone.pop()?;
        self.keep(now);
        Some(after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(text: &str) -> State {
        State { text: text.into(), cursor: [text.len(); 2] }
    }

    /// Types texts, each in place of the one before, a tenth of a second apart. Returns the last.
    fn typed(steps: &mut Steps, texts: &[&str]) -> State {
        for (i, pair) in texts.windows(2).enumerate() {
            steps.record(state(pair[0]), pair[1], Some(0.1 * i as f64));
        }
        state(texts.last().expect("a text"))
    }

    fn undone(steps: &mut Steps, mut now: State) -> Vec<String> {
        let mut all = Vec::new();
        while let Some(before) = steps.undo(now) {
            all.push(before.text.to_string());
            now = before;
        }
        all
    }

    #[test]
    fn what_is_typed_in_one_go_is_one_step_and_a_line_begins_another() {
        let mut steps = Steps::default();
        let now = typed(&mut steps, &["", "a", "ab", "ab\n", "ab\nc", "ab\ncd", "ab\nc", "ab\n"]);
        assert_eq!(undone(&mut steps, now), ["ab\ncd", "ab", ""]);
    }

    #[test]
    fn a_rest_a_move_and_a_paste_end_a_step() {
        let mut steps = Steps::default();
        steps.record(state(""), "a", Some(0.0));
        steps.record(state("a"), "ab", Some(REST));
        steps.end();
        steps.record(state("ab"), "abc", Some(REST));
        steps.record(state("abc"), "abcd", None);
        steps.record(state("abcd"), "abcde", Some(REST));
        assert_eq!(undone(&mut steps, state("abcde")), ["abcd", "abc", "ab", "a", ""]);
    }

    #[test]
    fn what_was_undone_comes_back_until_something_is_typed() {
        let mut steps = Steps::default();
        let now = typed(&mut steps, &["", "a", "a\n"]);
        let before = steps.undo(now.clone()).expect("a step");
        assert_eq!(&*before.text, "a");
        let first = steps.undo(before.clone()).expect("a step");
        assert_eq!(steps.redo(first), Some(before.clone()));
        assert_eq!(steps.redo(before.clone()), Some(now));
        steps.undo(state("a\n"));
        steps.record(before, "ab", Some(9.0));
        assert_eq!(steps.redo(state("ab")), None);
    }

    #[test]
    fn the_oldest_steps_go_when_texts_are_long() {
        let mut steps = Steps::default();
        let text = |i: usize| format!("{i:03}{}", " ".repeat(1 << 20));
        for i in 0..40 {
            steps.record(state(&text(i)), &text(i + 1), None);
        }
        assert!(steps.bytes <= MOST_BYTES && steps.done.len() < 16);
        assert!(undone(&mut steps, state(&text(40)))[0].starts_with("039"));
        assert_eq!(steps.bytes, 0);
    }
}
