//! Looks whether the condition of the step's task holds, when something that it may depend on has changed.

use bevy_egui::egui::{Context, Id};

use crate::{
    document::{Revision, Selection},
    lesson::{Situation, Task, WindowFacts},
    panel::{
        explain,
        state::{Action, EXPLAIN_TAB, LessonCommand, PLOTS_TAB, Plots, Session, View},
    },
    registry::Registry,
};

/// Everything that a condition may depend on.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    entry: u64,
    revision: Revision,
    selection: Selection,
    view: View,
    plots: Plots,
    /// The number of explanations calculated so far.
    explained: u64,
}

/// The answer.
#[derive(Clone, Debug)]
struct Checked {
    question: Question,
    missing: Option<String>,
}

fn memory() -> Id {
    Id::new("condition of the lesson")
}

/// The number of times that a condition was looked at so far.
#[must_use]
pub fn evaluations(ctx: &Context) -> u64 {
    ctx.data(|d| d.get_temp(memory().with("count"))).unwrap_or(0)
}

/// The reason why the condition cannot be told now, if there is one.
pub(super) fn missing(ctx: &Context) -> Option<String> {
    ctx.data(|d| d.get_temp::<Checked>(memory()))?.missing
}

/// Looks; the step's task is done as soon as its condition holds.
pub(in crate::panel) fn look(ctx: &Context, session: &Session, registry: &Registry) -> Option<Action> {
    let open = session.lesson.as_ref()?;
    let Some(goal) = session.open_task().and_then(Task::goal) else {
        ctx.data_mut(|d| d.remove::<Checked>(memory()));
        return None;
    };
    let question = Question {
        entry: open.entries,
        revision: session.document.revision(),
        selection: session.selection,
        view: session.view.clone(),
        plots: session.plots.clone(),
        explained: explain::calculations(ctx),
    };
    if ctx.data(|d| d.get_temp::<Checked>(memory())).is_some_and(|known| known.question == question) {
        return None;
    }
    ctx.data_mut(|d| *d.get_temp_mut_or_default::<u64>(memory().with("count")) += 1);
    let explained = explain::explained(ctx);
    let situation = situation(session, registry, explained.as_deref());
    let holds = goal.until.holds(&situation);
    let missing = if holds { None } else { goal.until.missing(&situation) };
    ctx.data_mut(|d| d.insert_temp(memory(), Checked { question, missing }));
    holds.then_some(Action::Lesson(LessonCommand::Solved(open.step)))
}

/// The window as conditions see it.
fn situation<'a>(
    session: &'a Session,
    registry: &'a Registry,
    explained: Option<&'a explain::Explained>,
) -> Situation<'a> {
    let (view, pinned) = (&session.view, session.view.pinned.is_some());
    let shown = |tab: &str| view.bottom_open && view.bottom_tab == tab;
    Situation {
        scene: session.scene(),
        registry,
        selection: session.selection,
        window: WindowFacts {
            views: session.document.variants.len() + 1,
            active: session.active(),
            channel: session.channel_of(session.active()),
            terms: session.terms(),
            plots: shown(PLOTS_TAB).then_some(session.plots.kind),
            explain: shown(EXPLAIN_TAB),
            presenting: view.presenting,
        },
        probe: explained.map(|explained| &explained.explanation).filter(|_| pinned),
        pinned,
    }
}
