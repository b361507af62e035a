//! Corrects the input that bevy_egui passes on.

use bevy::{
    ecs::prelude::*,
    input::keyboard::{Key, KeyboardInput},
    window::RequestRedraw,
};
use bevy_egui::{EguiContext, EguiInput, egui, input::EguiContextPointerPosition};

/// bevy_egui 0.42 reports the held modifier keys to egui in every frame, and egui redraws after every event: the window
/// would never be idle. Only changes are passed on.
///
/// It also gives every key of a frame the modifiers at the end of the frame, so that a quick Ctrl+D in a slow frame
/// would become D: here each key has the modifiers held when it was pressed.
pub(super) fn mend_input(
    mut contexts: Query<&mut EguiInput>,
    mut keyboard: MessageReader<KeyboardInput>,
    mut held: Local<egui::Modifiers>,
    mut running: Local<egui::Modifiers>,
) {
    let mut keys = Vec::new();
    for message in keyboard.read() {
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
            .or_else(|| bevy_egui::helpers::bevy_to_egui_physical_key(&message.key_code));
        keys.extend(key.map(|key| (key, pressed, *running)));
    }
    for mut input in &mut contexts {
        let mut in_order = keys.iter();
        for event in &mut input.events {
            if let egui::Event::Key { key, pressed, modifiers, .. } = event
                && let Some(known) = in_order.by_ref().find(|k| k.0 == *key && k.1 == *pressed)
            {
                *modifiers = known.2;
            }
            if let egui::Event::WindowFocused(false) = event {
                *running = egui::Modifiers::NONE;
            }
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
    use bevy::app::{App, Last};
    use bevy_egui::egui::{Event, RawInput, pos2};

    use super::*;

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
