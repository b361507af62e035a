//! Checks whether the task of the current step is done, whenever something relevant has changed.

use crate::{
    document::Revision,
    lesson::{Situation, Task, WindowFacts},
    library::status::Reloaded,
    panel::{
        explain,
        prelude::*,
        state::{CODE_TAB, EXPLAIN_TAB, PLOTS_TAB, Plots, View},
    },
};

/// Inputs of a condition.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    entry: u64,
    revision: Revision,
    selection: Selection,
    view: View,
    plots: Plots,
    /// Number of explanations calculated so far.
    explained: u64,
    /// The shaders, and whether a text is open in the editor.
    code: (Option<Reloaded>, usize, bool),
}

/// The checks so far, and the result of the latest.
#[derive(Clone, Debug, Default)]
struct Checks(u64, Option<Checked>);

/// The result of a check.
#[derive(Clone, Debug)]
struct Checked {
    question: Question,
    /// The inputs on entering the step, before the learner has done anything.
    entered: Question,
    unmet: Option<String>,
}

/// Number of checks so far.
#[must_use]
pub fn evaluations(ctx: &Context) -> u64 {
    kept::with(ctx, |checks: &mut Checks| checks.0)
}

/// Why the task is not done, once the learner has done something; immediately if the condition cannot be evaluated.
pub(super) fn unmet(ctx: &Context) -> Option<String> {
    kept::get::<Checks>(ctx).1?.unmet
}

/// Checks the condition. Returns the action that completes the task if it holds.
pub(in crate::panel) fn update(ctx: &Context, session: &Session, registry: &Registry) -> Option<Action> {
    let open = session.lesson.as_ref()?;
    let Some(goal) = session.open_task().and_then(Task::goal) else {
        kept::with(ctx, |checks: &mut Checks| checks.1 = None);
        return None;
    };
    let question = Question {
        entry: open.entries,
        revision: session.document.revision(),
        selection: session.selection,
        view: session.view.clone(),
        plots: session.plots.clone(),
        explained: explain::calculations(ctx),
        code: (
            session.shaders.last.clone(),
            session.shaders.troubles.len(),
            session.code.visible().is_some(),
        ),
    };
    let Checks(count, known) = kept::get(ctx);
    let entered = match known {
        Some(known) if known.question == question => return None,
        Some(known) if known.question.entry == question.entry => known.entered,
        _ => question.clone(),
    };
    let explained = explain::explained(ctx);
    let situation = situation(session, registry, explained.as_deref());
    let holds = goal.until.holds(&situation);
    // Explanations, which follow by themselves, are no deed of the learner.
    let idle = question == Question { explained: question.explained, ..entered.clone() };
    let unmet = if idle { goal.until.missing(&situation) } else { goal.until.unmet(&situation) };
    kept::set(ctx, Checks(count + 1, Some(Checked { question, entered, unmet })));
    holds.then_some(Action::Lesson(LessonCommand::Solved(open.step)))
}

/// The window as seen by conditions.
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
            code: shown(CODE_TAB) && session.code.visible().is_some(),
            errors: session.shaders.troubles.len(),
        },
        probe: explained.map(|explained| &explained.explanation).filter(|_| pinned),
        pinned,
    }
}
