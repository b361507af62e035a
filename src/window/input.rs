//! Corrects the input that bevy_egui passes on.

use bevy::{
    ecs::prelude::*,
    input::{
        ButtonInput,
        keyboard::{Key, KeyboardInput},
        mouse::MouseButton,
    },
    window::{RequestRedraw, WindowEvent},
};
use bevy_egui::{EguiClipboard, EguiContext, EguiInput, egui, input::EguiContextPointerPosition};

/// A key as the keyboard reported it, with the modifiers held then.
struct Struck {
    key: egui::Key,
    pressed: bool,
    /// What it types.
    text: Option<String>,
    modifiers: egui::Modifiers,
}

/// bevy_egui 0.42 reports the held modifier keys to egui in every frame, and egui redraws after every event: the window
/// would never be idle. Only changes are passed on.
///
/// It also gives every key of a frame the modifiers at the end of the frame, so that a quick Ctrl+D in a slow frame
/// would become D and type a letter: here each key has the modifiers held when it was pressed.
pub(super) fn mend_input(
    mut contexts: Query<&mut EguiInput>,
    mut keyboard: MessageReader<KeyboardInput>,
    mut clipboard: Option<ResMut<EguiClipboard>>,
    mut held: Local<egui::Modifiers>,
    mut running: Local<egui::Modifiers>,
) {
    let struck: Vec<_> = keyboard.read().filter_map(|message| follow(message, &mut running)).collect();
    for mut input in &mut contexts {
        if !struck.is_empty() {
            mend(&mut input.events, &struck, || clipboard.as_mut()?.get_text());
        }
        if input.events.contains(&egui::Event::WindowFocused(false)) {
            *running = egui::Modifiers::NONE;
        }
        let mut changed = false;
        let known = *held;
        input.events.retain(|event| match event {
            egui::Event::ModifiersChanged(now) => {
                changed |= *now != known;
                *held = *now;
                changed
            }
            _ => true,
        });
    }
}

/// Follows the modifiers, and returns the key if egui knows it.
fn follow(message: &KeyboardInput, running: &mut egui::Modifiers) -> Option<Struck> {
    let pressed = message.state.is_pressed();
    match message.logical_key {
        Key::Shift => running.shift = pressed,
        Key::Alt => running.alt = pressed,
        Key::Control => {
            running.ctrl = pressed;
            running.command = pressed && !cfg!(target_os = "macos");
        }
        Key::Super | Key::Meta if cfg!(target_os = "macos") => {
            running.mac_cmd = pressed;
            running.command = pressed;
        }
        _ => {}
    }
    let key = bevy_egui::helpers::bevy_to_egui_key(&message.logical_key)
        .or_else(|| bevy_egui::helpers::bevy_to_egui_physical_key(&message.key_code))?;
    let text = match &message.logical_key {
        Key::Character(text) if !text.contains(char::is_control) => Some(text.to_string()),
        Key::Space => Some(" ".to_owned()),
        _ => None,
    };
    Some(Struck { key, pressed, text: text.filter(|_| pressed), modifiers: *running })
}

/// Gives the keys among some events the modifiers that they were struck with, and what follows from these: the letter
/// before a key, and copy, cut or paste after it.
fn mend(events: &mut Vec<egui::Event>, struck: &[Struck], mut paste: impl FnMut() -> Option<String>) {
    use egui::Event;
    // AltGr, which types, is Ctrl and Alt.
    let types = |m: egui::Modifiers| !m.ctrl && !m.mac_cmd || m.ctrl && m.alt && !cfg!(target_os = "macos");
    let mut at = 0;
    for Struck { key, pressed, text, modifiers: right } in struck {
        let is_it = |event: &Event| matches!(event, Event::Key { key: k, pressed: p, .. } if k == key && p == pressed);
        let Some(place) = events.iter().skip(at).position(is_it).map(|i| at + i) else { continue };
        at = place + 1;
        let Event::Key { modifiers, .. } = &mut events[place] else { continue };
        let given = std::mem::replace(modifiers, *right);
        if *pressed && given.command != right.command {
            let follows = events.get(at).is_some_and(|event| match key {
                egui::Key::C => *event == Event::Copy,
                egui::Key::X => *event == Event::Cut,
                egui::Key::V => matches!(event, Event::Text(_)),
                _ => false,
            });
            if given.command && follows {
                events.remove(at);
            } else if right.command {
                let event = match key {
                    egui::Key::C => Some(Event::Copy),
                    egui::Key::X => Some(Event::Cut),
                    egui::Key::V => paste().map(Event::Text),
                    _ => None,
                };
                at += usize::from(event.is_some());
                event.into_iter().for_each(|event| events.insert(place + 1, event));
            }
        }
        let Some(text) = text else { continue };
        match (types(given), types(*right)) {
            (true, false) if place > 0 && events[place - 1] == Event::Text(text.clone()) => {
                events.remove(place - 1);
                at -= 1;
            }
            (false, true) => {
                events.insert(place, Event::Text(text.clone()));
                at += 1;
            }
            _ => {}
        }
    }
}

/// Reports to egui that the pointer has left the window, which bevy_egui does not: after a jump out of it, tooltips
/// would stay.
pub(super) fn report_leaving(
    mut events: MessageReader<WindowEvent>,
    buttons: Res<ButtonInput<MouseButton>>,
    mut contexts: Query<&mut EguiInput>,
) {
    let mut is_gone = false;
    for event in events.read() {
        match event {
            WindowEvent::CursorLeft(_) => is_gone = true,
            WindowEvent::CursorEntered(_) | WindowEvent::CursorMoved(_) => is_gone = false,
            _ => {}
        }
    }
    // A drag goes on outside.
    if is_gone && buttons.get_pressed().next().is_none() {
        contexts.iter_mut().for_each(|mut input| input.events.push(egui::Event::PointerGone));
    }
}

/// Reports the pointer's position to egui when the scale of the window has changed: neither bevy_egui nor egui converts
/// the position of an idle pointer, and the next click would miss.
pub(super) fn rescale_pointer(
    mut contexts: Query<(&mut EguiContext, &mut EguiInput, &mut EguiContextPointerPosition)>,
    mut scale: Local<Option<f32>>,
    mut requests: MessageWriter<RequestRedraw>,
) {
    for (mut context, mut input, mut pointer) in &mut contexts {
        let context = context.get_mut();
        let now = context.zoom_factor();
        let Some(before) = scale.replace(now).filter(|before| *before != now) else { continue };
        pointer.position = (pointer.position.to_vec2() * before / now).to_pos2();
        if context.input(|i| i.pointer.latest_pos().is_some()) {
            input.events.push(egui::Event::PointerMoved(pointer.position));
            requests.write(RequestRedraw);
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::{
        app::{App, Last, Update},
        math::Vec2,
        window::{CursorLeft, CursorMoved},
    };
    use bevy_egui::egui::{Event, RawInput, pos2};

    use super::*;

    const CTRL: egui::Modifiers = egui::Modifiers { ctrl: true, command: true, ..egui::Modifiers::NONE };

    fn key(key: egui::Key, modifiers: egui::Modifiers) -> Event {
        Event::Key { key, pressed: true, repeat: false, modifiers, physical_key: None }
    }

    fn struck(key: egui::Key, text: &str, modifiers: egui::Modifiers) -> Struck {
        Struck { key, pressed: true, text: Some(text.to_owned()), modifiers }
    }

    #[test]
    fn keys_have_the_modifiers_that_they_were_struck_with() {
        use egui::{Key, Modifiers};
        let none = Modifiers::NONE;
        let text = |text: &str| Event::Text(text.to_owned());
        let mended = |mut events: Vec<Event>, all: &[Struck]| {
            mend(&mut events, all, || Some("kept".to_owned()));
            events
        };
        // Ctrl is released in the frame in which it was pressed.
        let quick = [struck(Key::A, "a", none), struck(Key::S, "s", CTRL), struck(Key::B, "b", none)];
        let all =
            vec![text("a"), key(Key::A, none), text("s"), key(Key::S, none), text("b"), key(Key::B, none)];
        let right = [text("a"), key(Key::A, none), key(Key::S, CTRL), text("b"), key(Key::B, none)];
        assert_eq!(mended(all, &quick), right);
        for (name, letter, follows) in
            [(Key::C, "c", Event::Copy), (Key::X, "x", Event::Cut), (Key::V, "v", text("kept"))]
        {
            let all = vec![text(letter), key(name, none), text("b"), key(Key::B, none)];
            let with = [struck(name, letter, CTRL), struck(Key::B, "b", none)];
            assert_eq!(mended(all, &with), [key(name, CTRL), follows.clone(), text("b"), key(Key::B, none)]);
            // And the other way round: typed before Ctrl was pressed.
            let all = vec![key(name, CTRL), follows, key(Key::B, CTRL)];
            let with = [struck(name, letter, none), struck(Key::B, "b", CTRL)];
            assert_eq!(mended(all, &with), [text(letter), key(name, none), key(Key::B, CTRL)]);
        }
        // AltGr types.
        let alt_gr = Modifiers { alt: true, ..CTRL };
        let at = vec![text("@"), key(Key::Q, alt_gr)];
        assert_eq!(mended(at.clone(), &[struck(Key::Q, "@", alt_gr)]), at);
    }

    #[test]
    fn a_pointer_that_leaves_the_window_in_one_jump_is_gone() {
        let mut app = App::new();
        app.add_message::<WindowEvent>()
            .init_resource::<ButtonInput<MouseButton>>()
            .add_systems(Update, report_leaving);
        let window = app.world_mut().spawn(EguiInput::default()).id();
        let left = || WindowEvent::from(CursorLeft { window });
        let moved = || WindowEvent::from(CursorMoved { window, position: Vec2::ZERO, delta: None });
        let mut frame = |events: Vec<WindowEvent>, held: bool| {
            for event in events {
                app.world_mut().write_message(event);
            }
            if held {
                app.world_mut().resource_mut::<ButtonInput<MouseButton>>().press(MouseButton::Left);
            }
            app.update();
            std::mem::take(
                &mut app.world_mut().entity_mut(window).get_mut::<EguiInput>().expect("spawned").events,
            )
        };
        assert_eq!(frame(vec![moved(), left()], false), [Event::PointerGone]);
        assert_eq!(frame(Vec::new(), false), [], "once");
        assert_eq!(frame(vec![left(), moved()], false), [], "it came back");
        assert_eq!(frame(vec![left()], true), [], "a drag goes on outside");
    }

    #[test]
    fn a_pointer_at_rest_stays_where_it_is_when_the_scale_changes() {
        let mut app = App::new();
        app.add_message::<RequestRedraw>().add_systems(Last, rescale_pointer);
        let mut context = EguiContext::default();
        let egui = context.get_mut().clone();
        let place = EguiContextPointerPosition { position: pos2(300.0, 210.0) };
        let window = app.world_mut().spawn((context, EguiInput::default(), place)).id();
        let mut frame = |events: Vec<Event>, scale: f32| {
            let _ = egui.run_ui(RawInput { events, ..RawInput::default() }, |_| ());
            app.update();
            egui.set_zoom_factor(scale);
            std::mem::take(
                &mut app.world_mut().entity_mut(window).get_mut::<EguiInput>().expect("spawned").events,
            )
        };
        assert_eq!(frame(vec![Event::PointerMoved(pos2(300.0, 210.0))], 1.0), []);
        assert_eq!(frame(Vec::new(), 1.5), []);
        assert_eq!(frame(Vec::new(), 1.5), [Event::PointerMoved(pos2(200.0, 140.0))]);
        assert_eq!(frame(vec![Event::PointerGone], 1.0), []);
        assert_eq!(frame(Vec::new(), 1.0), [], "there is no pointer");
        let place = app.world().get::<EguiContextPointerPosition>(window).expect("spawned");
        assert_eq!(place.position, pos2(300.0, 210.0), "where it would click");
    }
}
