//! Looks whether the condition of the step's task holds, when something that it may depend on has changed.

use bevy_egui::egui::{Context, Id};

use crate::{
    document::{Revision, Selection},
    lesson::{Goal, Situation, Task},
    panel::{
        explain,
        state::{Action, LessonCommand, Plots, Session, View},
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

/// The reason why the condition cannot be told now, if there is one.
pub(super) fn missing(ctx: &Context) -> Option<String> {
    ctx.data(|d| d.get_temp::<Checked>(memory()))?.missing
}

/// The goal of the step that is shown.
fn goal(session: &Session) -> Option<&Goal> {
    match session.lesson.as_ref()?.now()?.task.as_ref()? {
        Task::Do(goal) | Task::Find(goal) => Some(goal),
        Task::Predict { .. } => None,
    }
}

/// Looks; the step's task is done as soon as its condition holds.
pub(in crate::panel) fn look(ctx: &Context, session: &Session, registry: &Registry) -> Option<Action> {
    let open = session.lesson.as_ref()?;
    let Some(goal) = goal(session).filter(|_| !open.is_done()) else {
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
    let explained = explain::explained(ctx);
    let situation = situation(session, registry, explained.as_deref());
    let holds = goal.until.holds(&situation);
    let missing = if holds { None } else { goal.until.missing(&situation) };
    ctx.data_mut(|d| d.insert_temp(memory(), Checked { question, missing }));
    holds.then(|| Action::Lesson(LessonCommand::Solved(open.step)))
}

fn situation<'a>(
    session: &'a Session,
    registry: &'a Registry,
    explained: Option<&'a explain::Explained>,
) -> Situation<'a> {
    let pinned = session.view.pinned.is_some();
    Situation {
        scene: session.scene(),
        registry,
        selection: session.selection,
        window: crate::lesson::WindowFacts { a: "" },
        probe: explained.filter(|_| pinned).map(|explained| &explained.explanation),
        pinned,
    }
}
