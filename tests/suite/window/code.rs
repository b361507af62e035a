//! The editor in the window, by keyboard alone.

use bevy_egui::egui::{self, Color32, Event, Key, Modifiers, PointerButton, Shape, accesskit::Role};
use lights_camera_models::{
    panel::{
        command::{all, with_keys},
        state::{Action, CodeCommand, CodeOf, KeptCode, ModelCommand, OpenCode, Session, Theirs, ViewChange},
        theme::Palette,
    },
    recovery::texts::OF_SCENE,
    scene::Scene,
};

use crate::window::panels::{Bench, Seen};

/// The modifiers that Ctrl has.
const CTRL: Modifiers = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };

fn open(bench: &Bench) -> &OpenCode {
    bench.session.code.visible().expect("a text is open")
}

fn types(bench: &mut Bench, text: &str) {
    bench.frame(vec![Event::Text(text.to_owned())]);
    bench.settle();
}

/// A window with the scene as JSON, and the cursor at its start.
fn with_scene() -> Bench {
    let mut bench = Bench::new(Session::default());
    bench.key(Key::J, CTRL | Modifiers::SHIFT);
    bench.key(Key::Home, CTRL);
    bench
}

#[test]
fn keys_in_the_text_are_those_of_the_editor() {
    let mut bench = with_scene();
    assert_eq!((bench.session.view.bottom_tab.as_str(), &open(&bench).of), ("code", &CodeOf::Scene));
    let (before, scene) = (open(&bench).text.clone(), bench.session.document.scene().clone());
    types(&mut bench, "x");
    assert_eq!(*open(&bench).text, *format!("x{before}"));
    // An error is applied nowhere, and the document is not saved.
    bench.effects.clear();
    bench.key(Key::S, CTRL);
    assert!(bench.effects.is_empty(), "{:?}", bench.effects);
    assert_eq!(*bench.session.document.scene(), scene);
    assert!(open(&bench).is_unsaved());
    bench.key(Key::Z, CTRL);
    assert_eq!(open(&bench).text, before);
    assert!(!open(&bench).is_unsaved());
    // Tab indents; letters of commands are text.
    bench.key(Key::Tab, Modifiers::NONE);
    bench.letter(Key::H, "h");
    assert!(open(&bench).text.contains("    ") && open(&bench).text.contains('h'));
    assert_ne!(open(&bench).text, before);
}

#[test]
fn esc_closes_the_list_of_words_and_what_is_typed_next_is_text() {
    const LIST: &str = "Esc closes the list";
    let mut bench = with_scene();
    let scene = bench.session.document.scene().clone();
    let before = open(&bench).text.clone();
    // Behind the first brace, where a key is expected.
    bench.key(Key::ArrowRight, Modifiers::NONE);
    types(&mut bench, "\"va");
    assert!(bench.says(LIST), "{:?}", bench.tree);
    let focused = bench.ctx.memory(|memory| memory.focused());
    assert!(focused.is_some());
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(!bench.says(LIST));
    assert_eq!(bench.ctx.memory(|memory| memory.focused()), focused);
    types(&mut bench, "x");
    assert_eq!(*open(&bench).text, *before.replacen('{', "{\"vax", 1));
    // The text takes what it undoes.
    bench.key(Key::Z, CTRL);
    assert_eq!(open(&bench).text, before);
    assert_eq!(*bench.session.document.scene(), scene);
    // Without a list, Esc leaves the text.
    bench.key(Key::Escape, Modifiers::NONE);
    assert_eq!(bench.ctx.memory(|memory| memory.focused()), None);
}

#[test]
fn esc_closes_the_bar_to_find_from_each_of_its_parts() {
    let mut bench = with_scene();
    let text = bench.ctx.memory(|memory| memory.focused());
    for part in ["", "Next", "Aa"] {
        bench.key(Key::F, CTRL);
        types(&mut bench, "position");
        if !part.is_empty() {
            bench.click(part);
        }
        assert!(bench.find("Previous").is_some());
        bench.key(Key::Escape, Modifiers::NONE);
        assert!(bench.find("Previous").is_none(), "“{part}”");
        assert_eq!(bench.ctx.memory(|memory| memory.focused()), text, "“{part}”");
    }
}

#[test]
fn what_is_typed_after_finding_again_replaces_what_was_looked_for_and_tab_goes_to_what_replaces_it() {
    let mut bench = with_scene();
    bench.key(Key::H, CTRL);
    types(&mut bench, "position");
    bench.key(Key::H, CTRL);
    types(&mut bench, "size");
    let count = open(&bench).text.matches("size").count();
    assert!(bench.says(&format!("{count} place")), "{:?}", bench.words());
    bench.key(Key::Tab, Modifiers::NONE);
    let before = open(&bench).text.matches("extent").count();
    types(&mut bench, "extent");
    bench.click("Replace all");
    let text = &open(&bench).text;
    assert_eq!((text.matches("size").count(), text.matches("extent").count()), (0, before + count));
    bench.settle();
    assert!(bench.says(&format!("{count} replaced")) && !bench.says("not found"), "{:?}", bench.words());
}

#[test]
fn undoing_in_the_text_brings_back_what_that_of_an_earlier_window_replaced() {
    for opened in [true, false] {
        let mut bench = if opened { with_scene() } else { Bench::new(Session::default()) };
        if opened {
            types(&mut bench, "x");
            bench.key(Key::Escape, Modifiers::NONE);
            assert_eq!(bench.ctx.memory(|memory| memory.focused()), None);
        }
        let before = bench.session.code.visible().map(|open| open.text.clone());
        let kept = KeptCode { path: OF_SCENE.into(), text: "kept".into(), when: "5 minutes ago".to_owned() };
        bench.session.offer_code(vec![kept]);
        bench.apply(Action::Code(CodeCommand::Recover(OF_SCENE.into())));
        assert_eq!(&*open(&bench).text, "kept");
        let base = open(&bench).base.clone();
        bench.key(Key::Z, CTRL);
        assert_eq!(open(&bench).text, before.unwrap_or(base), "open before: {opened}");
    }
}

#[test]
fn the_button_that_continues_with_unsaved_text_says_what_it_does_and_has_a_key() {
    let mut bench = Bench::new(Session::default());
    let has_key = |bench: &Bench| {
        let root = all(&bench.session, &bench.registry, false);
        with_keys(&root).iter().any(|(_, command)| command.id == "continue_text")
    };
    assert!(!has_key(&bench), "there is nothing to continue");
    let kept = KeptCode { path: OF_SCENE.into(), text: "kept".into(), when: "5 minutes ago".to_owned() };
    bench.session.offer_code(vec![kept]);
    bench.settle();
    assert!(has_key(&bench));
    let button = bench.find("Continue").expect("in the status line").rect.center();
    bench.hover(button);
    let texts = bench.texts();
    let tip = texts.iter().find(|text| text.starts_with("Opens the text in the panel Code"));
    assert!(tip.is_some_and(|tip| tip.ends_with("(Ctrl+Shift+R)")), "{texts:?}");
    bench.key(Key::R, CTRL | Modifiers::SHIFT);
    assert_eq!(&*open(&bench).text, "kept");
    assert!(!has_key(&bench) && bench.find("Continue").is_none());
}

#[test]
fn what_is_typed_is_applied_as_one_step_that_the_scene_undoes() {
    let mut bench = with_scene();
    let (number, text) = (open(&bench).number, open(&bench).text.to_string());
    let name = bench.session.document.scene().name.clone().expect("the default scene has one");
    let edited = text.replacen(&name, "Typed", 1);
    assert_ne!(edited, text);
    bench.apply(Action::Code(CodeCommand::Type(number, edited.as_str().into())));
    bench.key(Key::Enter, CTRL);
    assert_eq!(bench.session.document.scene().name.as_deref(), Some("Typed"));
    assert_eq!(bench.session.document.done(), 1);
    bench.apply(Action::Undo);
    assert_eq!(bench.session.document.scene().name, Some(name));
}

#[test]
fn places_are_found_and_replaced_from_the_keyboard() {
    let mut bench = with_scene();
    bench.key(Key::H, CTRL);
    types(&mut bench, "position");
    let count = open(&bench).text.matches("position").count();
    let before = open(&bench).text.matches("place").count();
    assert!(count > 1);
    assert!(bench.says(&format!("{count} places")), "{:?}", bench.words());
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.says(&format!("1 of {count}")));
    bench.type_into("Replace by", "place");
    bench.click("Replace all");
    assert!(!open(&bench).text.contains("position"));
    assert_eq!(open(&bench).text.matches("place").count(), before + count);
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(bench.find("Replace all").is_none());
    assert!(bench.session.has_unsaved_code());
}

/// Numbers of the first and the last line in sight, once the text has come to rest.
fn lines_in_sight(bench: &mut Bench) -> [u32; 2] {
    (0..60).for_each(|_| bench.frame(Vec::new()));
    let text = bench.tree.iter().find(|seen| seen.role == Role::MultilineTextInput);
    let left = text.expect("the text is shown").rect.left();
    let beside = |place: &egui::Rect| place.right() < left + 1.0 && place.left() > left - 60.0;
    let texts = bench.texts_in_sight();
    let numbers = texts.iter().filter(|(_, place)| beside(place)).filter_map(|(text, _)| text.parse().ok());
    let numbers: Vec<u32> = numbers.collect();
    let ends = numbers.iter().min().zip(numbers.iter().max());
    let (first, last) = ends.unwrap_or_else(|| panic!("no numbers beside {left}: {texts:?}"));
    [*first, *last]
}

#[test]
fn a_text_opens_at_its_start() {
    let mut scene = Scene::default();
    scene.lights = vec![scene.lights[0].clone(); 40];
    let mut bench = Bench::new(Session::new(scene));
    bench.key(Key::J, CTRL | Modifiers::SHIFT);
    assert_eq!(lines_in_sight(&mut bench)[0], 1);
}

#[test]
fn two_lines_stay_in_sight_below_the_cursor() {
    let mut scene = Scene::default();
    scene.lights = vec![scene.lights[0].clone(); 90];
    let mut bench = Bench::new(Session::new(scene));
    bench.key(Key::J, CTRL | Modifiers::SHIFT);
    let down = 60;
    (0..down).for_each(|_| bench.key(Key::ArrowDown, Modifiers::NONE));
    let [first, last] = lines_in_sight(&mut bench);
    assert!(first > 1 && last >= down + 3, "{first} to {last}, with the cursor in line {}", down + 1);
}

#[test]
fn enter_indents_and_a_bracket_goes_back() {
    let mut bench = with_scene();
    bench.key(Key::ArrowRight, Modifiers::NONE);
    let before = open(&bench).text.clone();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(*open(&bench).text, *before.replacen('{', "{\n  ", 1));
    types(&mut bench, "}");
    assert_eq!(*open(&bench).text, *before.replacen('{', "{\n}", 1));
    types(&mut bench, "\"a");
    types(&mut bench, "\"");
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    types(&mut bench, "\"");
    types(&mut bench, ":");
    assert_eq!(*open(&bench).text, *before.replacen('{', "{\n}\"a\":", 1), "it steps over the quote");
}

#[test]
fn keys_that_come_in_one_frame_do_what_they_do_one_by_one() {
    let press =
        |key, modifiers| Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
    let letters = |text: &str| Event::Text(text.to_owned());
    let sequences = [
        vec![letters("{"), press(Key::Enter, Modifiers::NONE), letters("a")],
        vec![letters("\"va"), press(Key::Tab, Modifiers::NONE), letters("1")],
        vec![letters("x"), press(Key::Z, CTRL), letters("y")],
        vec![letters("a"), press(Key::Backspace, Modifiers::NONE), letters("{"), letters("]")],
    ];
    for events in sequences {
        let [slow, fast] = [true, false].map(|slow| {
            let mut bench = with_scene();
            bench.key(Key::ArrowRight, Modifiers::NONE);
            let frames: Vec<_> = if slow {
                events.iter().map(|event| vec![event.clone()]).collect()
            } else {
                vec![events.clone()]
            };
            for frame in frames {
                bench.frame(frame);
                bench.settle();
            }
            open(&bench).text.clone()
        });
        assert_eq!(fast, slow, "{events:?}");
    }
}

#[test]
fn keys_that_open_texts_and_new_models_work_within_a_text() {
    let mut bench = Bench::new(Session::default());
    bench.session.code.open.push(OpenCode {
        of: CodeOf::File("/lab/models/a.wgsl".into()),
        name: "a.wgsl".to_owned(),
        text: "// a".into(),
        base: "// a".into(),
        crlf: false,
        theirs: None,
        shows_difference: false,
        replaced: None,
        closing: false,
        number: 99,
    });
    bench.session.code.goto = Some((99, 1));
    bench.apply(Action::View(ViewChange::BottomTab("code".to_owned())));
    types(&mut bench, "x");
    assert_eq!(&*open(&bench).text, "x// a");
    bench.key(Key::J, CTRL | Modifiers::SHIFT);
    assert_eq!(open(&bench).of, CodeOf::Scene);
    types(&mut bench, "x");
    assert!(open(&bench).is_unsaved(), "the text has the focus");
    bench.key(Key::N, CTRL | Modifiers::SHIFT);
    assert!(bench.session.authoring.draft.is_some());
}

#[test]
fn after_a_choice_about_another_version_keys_are_for_the_text() {
    let mut bench = with_scene();
    types(&mut bench, "x");
    let text = bench.ctx.memory(|memory| memory.focused());
    // Once the text has followed the document.
    (0..3).for_each(|_| bench.settle());
    bench.session.code.open[0].theirs = Some(Theirs::Changed("{}".into()));
    bench.settle();
    bench.click("Keep mine");
    bench.settle();
    assert!(text.is_some() && bench.find("Keep mine").is_none());
    assert_eq!(bench.ctx.memory(|memory| memory.focused()), text);
}

#[test]
fn the_question_about_another_version_says_whether_there_are_changes_here() {
    let mut bench = with_scene();
    types(&mut bench, "x");
    // Once the text has followed the document.
    (0..3).for_each(|_| bench.settle());
    bench.session.code.open[0].theirs = Some(Theirs::Changed("{}".into()));
    bench.settle();
    assert!(bench.says("and you have changed scene.json"), "{:?}", bench.tree);
    bench.key(Key::Z, CTRL);
    assert!(bench.says("scene.json is as it was before") && bench.find("Take theirs").is_some());
    assert!(!bench.says("you have changed"));
}

#[test]
fn words_are_offered_one_in_a_line_within_the_editor_and_the_window() {
    for size in [egui::vec2(1280.0, 720.0), egui::vec2(700.0, 480.0)] {
        let mut bench = Bench::new(Session::default());
        bench.size = size;
        let text = format!("{}let x = schl", "// a line\n".repeat(30));
        bench.session.code.open.push(OpenCode {
            of: CodeOf::File("/lab/models/a.wgsl".into()),
            name: "a.wgsl".to_owned(),
            text: text.as_str().into(),
            base: text.as_str().into(),
            crlf: false,
            theirs: None,
            shows_difference: false,
            replaced: None,
            closing: false,
            number: 1,
        });
        bench.session.code.goto = Some((1, 1));
        bench.apply(Action::View(ViewChange::BottomTab("code".to_owned())));
        bench.key(Key::End, CTRL);
        bench.key(Key::Space, CTRL);
        bench.settle();
        let list = bench.ctx.memory(|memory| memory.area_rect(egui::Id::new("offered words")));
        let list = list.expect("words are offered");
        let is_row = |seen: &&Seen| seen.role == Role::Button && seen.label.starts_with("schlick");
        let rows: Vec<_> = bench.tree.iter().filter(is_row).map(|seen| seen.rect).collect();
        assert!(rows.len() > 2, "{size}: {:?}", bench.tree);
        for row in &rows {
            assert!(row.height() < 40.0 && (row.right() - rows[0].right()).abs() < 0.5, "{size}: {rows:?}");
        }
        assert!(bench.ctx.content_rect().expand(0.5).contains_rect(list), "{size}: {list}");
    }
}

#[test]
fn undoing_goes_by_lines_moves_of_the_cursor_pastes_and_rests() {
    let mut bench = with_scene();
    let before = open(&bench).text.clone();
    let is = |bench: &Bench, typed: &str| assert_eq!(*open(bench).text, *format!("{typed}{before}"));
    types(&mut bench, "1");
    types(&mut bench, "2");
    bench.key(Key::Enter, Modifiers::NONE);
    types(&mut bench, "3");
    bench.key(Key::Enter, Modifiers::NONE);
    bench.frame(vec![Event::Paste("45".to_owned())]);
    bench.settle();
    types(&mut bench, "6");
    bench.key(Key::ArrowLeft, Modifiers::NONE);
    bench.key(Key::ArrowRight, Modifiers::NONE);
    types(&mut bench, "7");
    (0..6).for_each(|_| bench.settle());
    types(&mut bench, "8");
    let steps = ["12\n3\n45678", "12\n3\n4567", "12\n3\n456", "12\n3\n45", "12\n3\n", "12\n3", "12", ""];
    is(&bench, steps[0]);
    for &step in &steps[1..] {
        bench.key(Key::Z, CTRL);
        is(&bench, step);
    }
    bench.key(Key::Z, CTRL);
    is(&bench, "");
    for &step in steps[..7].iter().rev() {
        bench.key(Key::Y, CTRL);
        is(&bench, step);
    }
    // Where the cursor was.
    types(&mut bench, "9");
    is(&bench, "12\n3\n456789");
}

#[test]
fn the_place_found_that_is_selected_stands_out() {
    /// The places in sight, and those that are filled.
    fn places(bench: &mut Bench) -> [usize; 2] {
        let warning = Palette::of(&bench.session.settings).warning;
        let all = bench.shapes();
        let places = all.iter().filter_map(|shape| match shape {
            Shape::Rect(rect) if rect.stroke.color == warning => Some(rect.fill != Color32::TRANSPARENT),
            _ => None,
        });
        let places: Vec<_> = places.collect();
        [places.len(), places.iter().filter(|filled| **filled).count()]
    }
    let mut bench = with_scene();
    bench.key(Key::F, CTRL);
    types(&mut bench, "\"");
    let count = open(&bench).text.matches('"').count();
    let [all, filled] = places(&mut bench);
    assert!(all > 2 && filled == 0, "{all} {filled}");
    for number in 1..3 {
        bench.key(Key::Enter, Modifiers::NONE);
        assert!(bench.says(&format!("{number} of {count}")), "{:?}", bench.tree);
        let [all, filled] = places(&mut bench);
        assert!(all > 2 && filled == 1, "{all} {filled}");
    }
}

#[test]
fn the_list_of_models_offers_to_copy_a_built_in_one_whose_code_is_to_be_edited() {
    let mut bench = Bench::with_model("phong");
    bench.apply(Action::View(ViewChange::Chooser(true)));
    bench.settle();
    let above = bench.find("New model…").expect("below the list").rect;
    let in_list = |seen: &&Seen| seen.label == "Edit code" && (seen.rect.top() - above.top()).abs() < 1.0;
    let button = bench.tree.iter().find(in_list).expect("beside the others");
    assert!(!button.disabled, "{button:?}");
    let at = button.rect.center();
    bench.click_at(at, PointerButton::Primary);
    assert!(!bench.session.view.chooser_open);
    let note = bench.session.messages.last().expect("a message").clone();
    assert!(note.text.contains("copy the model as a file"), "{}", note.text);
    let (label, action) = note.offer.expect("a button beside it");
    assert_eq!(label, "Duplicate as a file…");
    bench.apply(*action);
    assert_eq!(bench.session.authoring.draft.as_ref().and_then(|draft| draft.of.as_deref()), Some("phong"));
}

#[test]
fn the_button_beside_a_model_edits_its_code_and_copies_a_built_in_one() {
    let mut bench = Bench::with_model("phong");
    bench.click("Edit code");
    let said = bench.session.messages.last().map(|note| note.text.clone()).unwrap_or_default();
    assert!(said.contains("copy the model as a file"), "{said}");
    assert!(bench.session.authoring.draft.is_none());
    bench.apply(Action::Model(ModelCommand::DuplicateOf("phong".to_owned())));
    assert_eq!(bench.session.authoring.draft.as_ref().and_then(|draft| draft.of.as_deref()), Some("phong"));
}
