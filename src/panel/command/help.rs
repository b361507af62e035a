//! The menu of help.

use super::{Group, List, Menu, command};
use crate::panel::state::{Action, Effect, LessonCommand, LinkTo, Pick, ViewChange};

pub(super) fn help(to: &mut List) {
    to.menu(Menu::new("Help").group(Group::Window).width(super::show::WIDTH), |to| {
        to.add(command("manual", "Manual", Action::Do(Effect::OpenManual)));
        let keys = Action::View(ViewChange::Keys(!to.session.view.keys_open));
        to.add(command("keys", "Keys and mouse", keys).row("This list").keys("F1").anywhere());
        to.menu(Menu::new(super::LESSONS).group(Group::Lessons), |to| {
            let open = command("open_lesson", "Open a lesson…", Action::Do(Effect::Pick(Pick::Lesson)));
            to.add(open.says("Open a lesson…").tip("A lesson of your own: a Markdown file"));
            let leave = command("leave_lesson", "Leave the lesson", Action::Lesson(LessonCommand::Leave));
            let none = to.session.lesson.is_none();
            to.add(leave.says("Leave the lesson").unless(none, "No lesson is open"));
            let link = command("copy_step_link", "Copy link to this step", Action::CopyLink(LinkTo::Step));
            let tip = "Put an address on the clipboard that opens this step in a browser with the laboratory";
            to.add(link.says("Copy link to this step").tip(tip).unless(none, "No lesson is open"));
        });
        let finder = Action::View(ViewChange::Finder(!to.session.view.finder_open));
        to.add(command(super::FINDER, "Find a command…", finder).keys("Ctrl+F"));
        to.add(command("about", "About", Action::View(ViewChange::About(true))));
    });
}
