//! Questions that must be answered: only they block the window.

use std::path;

use bevy_egui::egui::Modal;

use super::{
    narrow,
    prelude::*,
    state::{Answer, Offer, Question},
};
use crate::{platform::fs, text::listed};

/// The open question. Enter gives the first answer, which loses nothing; Escape the last.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let Some(question) = &session.questions.open else { return };
    let (title, text, details, answers) = words(session, question);
    let asked = Id::new((title, &text, &details));
    let is_new = kept::set(ui.ctx(), Asked(Some(asked))).0 != Some(asked);
    let mut out = None;
    Modal::new(Id::new("question")).show(ui.ctx(), |ui: &mut Ui| {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - AROUND));
        egui::Frame::new().inner_margin(8.0).show(ui, |ui| {
            ui.label(RichText::new(title).heading());
            ui.add_space(8.0);
            ui.add(Label::new(text).wrap());
            for (what, more) in details {
                ui.add_space(4.0);
                ui.horizontal_wrapped(|ui| {
                    ui.label(theme::strong(ui, what));
                    ui.label(RichText::new(more).color(Palette::here(ui).weak));
                });
            }
            ui.add_space(16.0);
            if narrow::is(ui.ctx()) {
                let size = vec2(ui.available_width(), narrow::THUMB);
                out = answered(ui, &answers, is_new, size);
                return;
            }
            // One line high: all of the rest would be the height of the question before.
            let line = vec2(ui.available_width(), BUTTON.y);
            let layout = Layout::right_to_left(Align::Center);
            ui.allocate_ui_with_layout(line, layout, |ui| out = answered(ui, &answers, is_new, BUTTON));
        });
    });
    let escape = ui.input(|i| i.key_pressed(Key::Escape)).then_some(Answer::Cancel);
    context.actions.extend(escape.or(out).map(Action::Answer));
}

/// Width of a question, in points, and what a narrow window keeps for its frame and around it.
const WIDTH: f32 = 420.0;
const AROUND: f32 = 56.0;
/// Smallest size of a button, in points.
const BUTTON: Vec2 = vec2(80.0, 28.0);

/// The question of the pass before, which may be another one in the same place.
#[derive(Clone, Copy, Default)]
struct Asked(Option<Id>);

/// The buttons for the answers, at least of this size, of which the first stands out. Returns the chosen one.
fn answered(ui: &mut Ui, answers: &[(&str, Answer)], is_new: bool, size: Vec2) -> Option<Answer> {
    let mut out = None;
    for (i, (label, answer)) in answers.iter().enumerate() {
        let button = match i {
            0 => theme::action_button(ui, label, true, size),
            _ => Button::new(*label).min_size(size),
        };
        let response = ui.add(button);
        // The keyboard focus starts here, neither in the window below nor where it was in the question before.
        if i == 0 && (is_new || ui.memory(|m| m.focused()).is_none()) {
            response.request_focus();
        }
        out = response.clicked().then_some(*answer).or(out);
    }
    out
}

/// Title, text, details (text and addition), answers.
type Words = (&'static str, String, Vec<(String, String)>, Vec<(&'static str, Answer)>);

fn words(session: &Session, question: &Question) -> Words {
    match question {
        Question::Recover(offer) => recovery(session, offer),
        Question::Unsaved(_) => unsaved(session),
        Question::UnsavedTexts(then) => unsaved_texts(session, then),
        Question::MissingParts { path, parts, .. } => {
            let what = if parts.len() == 1 { "a part" } else { "parts" };
            (
                "Use the defaults?",
                format!("{} lacks {what} that every scene needs. Use the defaults?", path.shown()),
                parts.iter().map(|p| (p.name.clone(), format!("default: {}", p.default))).collect(),
                vec![("Use the defaults", Answer::UseDefaults), ("Do not open", Answer::Cancel)],
            )
        }
        Question::EmptyFile(path) => (
            "Load the default scene?",
            format!("{} is empty.", path.shown()),
            Vec::new(),
            vec![("Load the default scene", Answer::UseDefaults), ("Cancel", Answer::Cancel)],
        ),
        Question::ChangedOnDisk(path) => (
            "The file has changed",
            format!(
                "{} was changed by another program since it was read. Replace it with your version, or reload it and lose your version?",
                path.shown()
            ),
            Vec::new(),
            vec![
                ("Cancel", Answer::Cancel),
                ("Reload from disk", Answer::Reload),
                ("Replace", Answer::Overwrite),
            ],
        ),
        Question::ReplaceExport { path, .. } => replace(path, "the export"),
        Question::ReplaceScene(path) => replace(path, "a copy of this scene"),
        Question::ReplaceMaterial { path, .. } => replace(path, "the new material"),
        Question::ReplacePicture { path, .. } => replace(path, "the new picture"),
        Question::NewerOnDisk { path, .. } => (
            "Reload from disk?",
            format!(
                "{} was changed by another program, and you have unsaved changes. Reload it and lose your changes, or keep them? If you keep them, saving overwrites the file.",
                path.shown()
            ),
            Vec::new(),
            vec![
                ("Keep mine", Answer::Keep),
                ("Reload from disk", Answer::Reload),
                ("Decide when saving", Answer::Cancel),
            ],
        ),
    }
}

/// The question about unsaved changes of the scene.
fn unsaved(session: &Session) -> Words {
    (
        "Save the changes?",
        format!("“{}” has unsaved changes.", session.title()),
        Vec::new(),
        vec![("Save", Answer::Save), ("Don't save", Answer::Discard), ("Cancel", Answer::Cancel)],
    )
}

/// The question about unsaved changes of texts in the editor.
fn unsaved_texts(session: &Session, then: &Action) -> Words {
    let names = session.names_at_risk(then);
    (
        "Lose the changes?",
        format!("The panel Code has unsaved changes in {}.", listed(&names, "and")),
        Vec::new(),
        vec![("Show the text", Answer::Keep), ("Don't save", Answer::Discard), ("Cancel", Answer::Cancel)],
    )
}

/// The question whether a file that exists is to be replaced.
fn replace(path: &path::Path, with: &str) -> Words {
    (
        "Replace it?",
        format!("{} exists. Replace it with {with}?", path.shown()),
        Vec::new(),
        vec![("Cancel", Answer::Cancel), ("Replace", Answer::Overwrite)],
    )
}

/// The question about unsaved work of an earlier window.
fn recovery(session: &Session, offer: &Offer) -> Words {
    let Offer { title, path: at, file, when, scene } = offer;
    let mut text = format!("“{title}” had unsaved changes when its window closed unexpectedly {when}.");
    let mut details = Vec::new();
    if let Err(problem) = scene {
        text += " The recovery copy can't be read.";
        // The file name is followed by line and column, unless the problem is of the file itself.
        let problem = match problem.strip_prefix(&format!("{}:", file.shown())) {
            Some(at) if at.starts_with(|c: char| c.is_ascii_digit()) => format!("line {at}"),
            Some(said) => said.trim_start().to_owned(),
            None => problem.clone(),
        };
        details.push(("Problem".to_owned(), problem));
        details.push(("Copy".to_owned(), file.display().to_string()));
        let answers = vec![("Keep the copy", Answer::Cancel), ("Delete it", Answer::Discard)];
        return ("Keep the recovery copy?", text, details, answers);
    }
    let shown = session.path.as_ref().and_then(|shown| fs::absolute(shown).ok());
    if shown.is_some() && shown != *at {
        text += &format!(" Recovering them closes “{}”.", session.title());
    }
    let place = at.as_ref().map_or_else(|| "never saved".to_owned(), |at| at.shown().to_string());
    details.push(("File".to_owned(), place));
    let answers = vec![("Recover", Answer::Recover), ("Discard", Answer::Discard), ("Later", Answer::Cancel)];
    ("Recover unsaved changes?", text, details, answers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn offer(scene: Result<Scene, String>) -> Offer {
        Offer {
            title: "Room".to_owned(),
            path: Some("/scenes/room.json".into()),
            file: "/data/recovery/1-2/scene.json".into(),
            when: "5 minutes ago".to_owned(),
            scene,
        }
    }

    #[test]
    fn the_question_names_the_scene_its_file_and_what_is_wrong() {
        let session = Session::default();
        let all = |offer: Offer| {
            let (title, text, details, answers) = recovery(&session, &offer);
            let details: Vec<_> = details.into_iter().map(|(what, more)| format!("{what}: {more}")).collect();
            (format!("{title}\n{text}\n{}", details.join("\n")), answers)
        };
        let (text, answers) = all(offer(Ok(Scene::default())));
        for part in ["“Room”", "/scenes/room.json", "5 minutes ago"] {
            assert!(text.contains(part), "{text}");
        }
        // Enter loses nothing, and neither does Escape.
        assert_eq!(answers[0].1, Answer::Recover);
        let copy = "/data/recovery/1-2/scene.json";
        let (text, answers) = all(offer(Err(format!("{copy}:3:1: what is odd"))));
        assert!(
            text.contains("Problem: line 3:1: what is odd") && text.contains(&format!("Copy: {copy}")),
            "{text}"
        );
        assert_eq!(answers[0].1, Answer::Cancel);
        let (text, _) = all(offer(Err(format!("{copy}: it is a folder, but it must be a file"))));
        assert!(text.contains("Problem: it is a folder, but it must be a file"), "{text}");
        let (text, _) = all(Offer { path: None, ..offer(Ok(Scene::default())) });
        assert!(text.contains("never saved"), "{text}");
    }
}
