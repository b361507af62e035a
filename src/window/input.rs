//! Mends the input that bevy_egui passes on.

use bevy::{
    ecs::prelude::*,
    input::keyboard::{Key, KeyboardInput},
};
use bevy_egui::{EguiInput, egui};

/// bevy_egui 0.42 tells egui in every frame which modifier keys are held, and egui draws again after
/// every event: the window would never rest. Only changes are news.
///
/// It also gives every key of a frame the modifiers as they are at the frame's end, so that a quick
/// Ctrl+D in a slow frame would be a D: here each key gets those that were held when it was pressed.
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
