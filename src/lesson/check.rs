//! Checks the steps in order, with the scenes in which they begin: parts, views and conditions that do not
//! fit.

use super::{
    Block, Situation, Task, WindowFacts, blocks, condition::Knowledge, controls, draft::Draft,
    limits::MAX_PARTS, problem::Problems,
};
use crate::{registry::Registry, scene::Scene, scene::variant::LETTERS, text::plural};

/// Checks all steps, starting with the initial scene.
pub(super) fn steps(start: &Scene, drafts: &[Draft], registry: &Registry, problems: &mut Problems) {
    let mut scene = start.clone();
    let mut window = WindowFacts::default();
    let mut known = Knowledge::at_the_beginning();
    let mut parts = 0;
    for draft in drafts {
        // Without the intended scene, everything after it would seem wrong.
        if draft.is_lost {
            return;
        }
        if let Some(change) = &draft.step.scene {
            match change.applied(&scene, registry) {
                Ok(changed) => scene = changed,
                Err(found) => return found.into_iter().for_each(|(at, what)| problems.at(at, what)),
            }
            parts += scene.objects.len() + scene.lights.len();
            if parts > MAX_PARTS {
                let what = format!(
                    "the scenes of the steps up to here have {parts} objects and lights together; at most {MAX_PARTS} are \
                     allowed: use smaller scenes, or change them in fewer steps"
                );
                return problems.at(draft.at, what);
            }
            if change.opens() {
                known.scene_opened();
            }
            change.paths().for_each(|path| known.scene_set(path));
        }
        step(draft, &scene, &mut window, &mut known, registry, problems);
        if let Some(task) = &draft.step.task
            && let Some(goal) = task.goal()
        {
            known.done(&goal.until, matches!(task, Task::Find(_)));
        } else if draft.step.task.is_none() && draft.step.blocks.contains(&Block::Task) {
            // A task that could not be read may have been about anything.
            known = Knowledge::lost();
        }
    }
}

fn step(
    draft: &Draft,
    scene: &Scene,
    window: &mut WindowFacts,
    known: &mut Knowledge,
    registry: &Registry,
    problems: &mut Problems,
) {
    let place = |setting: &str| {
        draft.settings.iter().find(|(known, _)| *known == setting).map_or(draft.at, |(_, at)| *at)
    };
    // The names in the scene were not known where the part was read.
    for (at, written) in &draft.misnamed {
        if let Some(near) = controls::nearest_part(written, scene) {
            problems.add(*at, &format!("; did you mean {near}?"));
        }
    }
    let change = &draft.step.window;
    window.views = scene.variants.len() + 1;
    if let Some(active) = change.active {
        if active >= window.views {
            let (letter, views) = (LETTERS[active], plural(window.views, "view"));
            problems.at(place("active"), format!("there is no view {letter}: the scene has {views}"));
        } else {
            (window.active, known.active) = (active, true);
        }
    }
    window.active = window.active.min(window.views - 1);
    macro_rules! set {
        ($($what:ident)+) => {
            $(if let Some(given) = change.$what { (window.$what, known.$what) = (given, true) })+
        };
    }
    set! { channel terms explain plots }
    if let Some(part) = &change.select {
        known.selection = part.find(scene);
        if known.selection.is_none() {
            problems.at(place("select"), format!("there is no such part: {}", part.known(scene)));
        }
    }
    for (control, at) in draft.step.points.iter().zip(&draft.points) {
        if let Some(part) = blocks::part(control).filter(|part| part.find(scene).is_none()) {
            problems.at(*at, format!("there is no such part: {}", part.known(scene)));
        }
    }
    let goal = draft.step.task.as_ref().and_then(|task| task.goal());
    let (Some(goal), Some(at)) = (goal, draft.until) else { return };
    let Some((seen, _)) = scene.seen(window.active, registry) else { return };
    let mistakes = goal.until.problems(&seen, known.selection, registry);
    let is_sound = mistakes.is_empty();
    for (inside, what) in mistakes {
        problems.at(at + inside, what);
    }
    let situation = Situation {
        scene: &seen,
        registry,
        selection: known.selection.unwrap_or_default(),
        window: *window,
        probe: None,
        pinned: false,
    };
    if is_sound && goal.until.holds_at_once(&situation, known) {
        let remedy = "change the condition, or the scene before it";
        problems.at(at, format!("the task is already done when the step begins; {remedy}"));
    }
}
