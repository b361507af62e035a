//! Links to the scene and to the step of a lesson, for the clipboard.

use super::{LessonSource, LinkTo, Note, Session, Severity};
use crate::{platform, registry::Registry, scene::link};

impl Session {
    /// Copies a link, or says why there is none.
    pub(super) fn copy_link(&mut self, to: LinkTo, registry: &Registry) {
        let (what, made) = match to {
            LinkTo::Scene => ("scene", link::made(&self.document.named(registry), registry)),
            LinkTo::Step => ("step", self.step_in_address()),
        };
        let end = match made {
            Ok(end) => end,
            Err(why) => {
                return self
                    .say(Severity::Warning, format!("The link to this {what} was not copied: {why}."));
            }
        };
        let page = platform::page_address().or_else(|| self.settings.page().map(str::to_owned));
        let mut note = Note::new(Severity::Info, format!("Copied the link to this {what}."));
        if page.is_none() {
            note.text = format!(
                "Copied the end of a link to this {what}: put the address of a page with the laboratory in front of it, \
                 or that address into the settings as web_address."
            );
        }
        if to == LinkTo::Scene {
            note = self.with_view(note, "link");
        }
        self.copy(page.unwrap_or_default() + &end, note);
    }

    /// The end of an address that opens the step of the open lesson.
    fn step_in_address(&self) -> Result<String, String> {
        let open = self.lesson.as_ref().ok_or("no lesson is open")?;
        match &open.source {
            LessonSource::Shipped(_) => Ok(format!("?lesson={}&step={}", open.source.name(), open.step + 1)),
            LessonSource::File(_) => {
                Err("a link leads to lessons that come with the program; send the file of this one"
                    .to_owned())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        panel::state::{Action, Effect, LessonCommand},
        parameter::Value,
        scene::{
            Scene,
            load::{self, Defaults},
        },
    };

    /// The texts that a command copies, and the last message.
    fn copied(session: &mut Session, to: LinkTo) -> (Vec<String>, String) {
        let effects = session.apply(Action::CopyLink(to), &Registry::builtin());
        let texts = effects.into_iter().filter_map(|effect| match effect {
            Effect::CopyText(text) => Some(text),
            _ => None,
        });
        (texts.collect(), session.messages.last().map_or_else(String::new, |note| note.text.clone()))
    }

    #[test]
    fn a_link_holds_the_scene_with_what_was_changed() {
        let registry = Registry::builtin();
        let mut scene = Scene { reflection_model: "blinn_phong".to_owned(), ..Scene::default() };
        scene.objects[0].material.set("alpha", Value::Integer(77));
        let mut session = Session::new(scene.clone());
        let (texts, said) = copied(&mut session, LinkTo::Scene);
        let [end] = &texts[..] else { panic!("{texts:?}") };
        assert!(end.starts_with("#scene=1.") && said.contains("the end of a link"), "{end}: {said}");
        session.settings.web_address = Some("https://lab.example.org/a/?x".to_owned());
        let (texts, said) = copied(&mut session, LinkTo::Scene);
        assert_eq!(texts, [format!("https://lab.example.org/a/{end}")]);
        assert_eq!(said, "Copied the link to this scene.");
        let json = link::found(&texts[0]).map(link::unpacked).expect("a link").expect("a scene");
        let read = load::from_text(&json, "link", &registry, Defaults::Refuse).expect("valid").scene;
        assert_eq!(read.objects[0].material, scene.objects[0].material);
        // The wrong twin.
        assert_ne!(read.objects[0].material, Scene::default().objects[0].material);
        session.facts.camera_is_free = true;
        assert!(copied(&mut session, LinkTo::Scene).1.contains("The link keeps the observer’s view"));
    }

    #[test]
    fn a_link_to_a_step_names_lesson_and_step() {
        let registry = Registry::builtin();
        let mut session = Session::default();
        let (texts, said) = copied(&mut session, LinkTo::Step);
        assert_eq!(texts, Vec::<String>::new());
        assert_eq!(said, "The link to this step was not copied: no lesson is open.");
        session.settings.web_address = Some("https://lab.example.org/".to_owned());
        session.apply(Action::Lesson(LessonCommand::Open(LessonSource::Shipped(0))), &registry);
        session.apply(Action::Lesson(LessonCommand::GoTo(1)), &registry);
        let name = LessonSource::Shipped(0).name();
        let (texts, _) = copied(&mut session, LinkTo::Step);
        assert_eq!(texts, [format!("https://lab.example.org/?lesson={name}&step=2")]);
        if let Some(open) = &mut session.lesson {
            open.source = LessonSource::File("mine.md".into());
        }
        let (texts, said) = copied(&mut session, LinkTo::Step);
        assert!(texts.is_empty() && said.contains("send the file"), "{said}");
    }
}
