//! The way of the pointer that turns the camera: that of the cursor, which every pointer has. Of how far a device was
//! moved, tablets, remote desktops and virtual machines say nothing, or send places in its stead.
//!
//! Only where the cursor stands still, as at the edge of the screen, does the way of the device count. The two do not
//! always come in the same frame, so it counts one frame later.

use bevy::{
    app::{App, Plugin, PreUpdate},
    ecs::{
        message::{MessageCursor, Messages},
        prelude::*,
    },
    input::{
        ButtonInput, InputSystems,
        mouse::{MouseButton, MouseMotion},
    },
    window::{CursorMoved, RequestRedraw},
};
use glam::Vec2;

pub(super) struct PointerPlugin;

impl Plugin for PointerPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(PreUpdate, follow_cursor.after(InputSystems).before(super::camera::gate));
    }
}

/// The state of the pointer.
#[derive(Default)]
struct Pointer {
    /// The way of the device for which no cursor has moved so far.
    pending: Option<Vec2>,
    /// The cursor moved in the frame before.
    moved: bool,
}

impl Pointer {
    /// The way that counts, from those of the device and of the cursor in a frame; a button is `held` in a drag.
    fn frame(&mut self, device: Option<Vec2>, cursor: Option<Vec2>, held: bool) -> Option<Vec2> {
        let before = self.pending.take();
        let moved = std::mem::replace(&mut self.moved, cursor.is_some());
        if cursor.is_some() {
            return cursor;
        }
        self.pending = device.filter(|_| held && !moved);
        before
    }
}

fn follow_cursor(
    mut motion: ResMut<Messages<MouseMotion>>,
    mut read: Local<MessageCursor<MouseMotion>>,
    mut cursor: MessageReader<CursorMoved>,
    buttons: Res<ButtonInput<MouseButton>>,
    mut pointer: Local<Pointer>,
    mut requests: MessageWriter<RequestRedraw>,
) {
    let sum = |ways: &mut dyn Iterator<Item = Vec2>| {
        let way: Vec2 = ways.sum();
        Some(way).filter(|way| *way != Vec2::ZERO)
    };
    let device = sum(&mut read.read(&motion).map(|m| m.delta));
    let moved = sum(&mut cursor.read().filter_map(|c| c.delta));
    let held = buttons.get_pressed().next().is_some();
    motion.clear();
    if let Some(delta) = pointer.frame(device, moved, held) {
        motion.write(MouseMotion { delta });
    }
    // What is written here is not news here.
    read.clear(&motion);
    if pointer.pending.is_some() {
        // The next frame decides.
        requests.write(RequestRedraw);
    }
}

#[cfg(test)]
mod tests {
    use bevy::{
        MinimalPlugins,
        camera::Projection,
        input::{ButtonState, InputPlugin, mouse::MouseButtonInput},
        transform::components::Transform,
    };
    use bevy_panorbit_camera::{ActiveCameraData, PanOrbitCamera, PanOrbitCameraPlugin};
    use glam::Vec3;

    use super::*;
    use crate::window::camera::orbit;

    /// The messages of a device in a frame: its own way, and that of the cursor.
    type Sent = (Option<Vec2>, Option<Vec2>);

    /// The camera after a drag with this button.
    fn drag(button: MouseButton, frames: &[Sent]) -> Transform {
        drag_after(None, button, frames)
    }

    /// The same after the cursor came into the picture.
    fn drag_after(hover: Option<Vec2>, button: MouseButton, frames: &[Sent]) -> Transform {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, PanOrbitCameraPlugin))
            .add_message::<CursorMoved>()
            .add_message::<RequestRedraw>()
            .add_systems(PreUpdate, follow_cursor.after(InputSystems));
        let window = app.world_mut().spawn_empty().id();
        let place = Transform::from_xyz(0.0, 0.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y);
        let controls = PanOrbitCamera { enabled: true, ..orbit() };
        let camera = app.world_mut().spawn((controls, place, Projection::default())).id();
        app.insert_resource(ActiveCameraData {
            entity: Some(camera),
            viewport_size: Some(Vec2::new(800.0, 600.0)),
            window_size: Some(Vec2::new(800.0, 600.0)),
            manual: true,
        });
        app.update();
        let moved = |delta| CursorMoved { window, position: Vec2::ZERO, delta };
        if hover.is_some() {
            app.world_mut().write_message(moved(hover));
            app.update();
        }
        let state = ButtonState::Pressed;
        app.world_mut().write_message(MouseButtonInput { button, state, window });
        app.update();
        for (told, cursor) in frames {
            if let Some(delta) = *told {
                app.world_mut().write_message(MouseMotion { delta });
            }
            if cursor.is_some() {
                app.world_mut().write_message(moved(*cursor));
            }
            app.update();
        }
        // Frames go on for a moment.
        (0..3).for_each(|_| app.update());
        *app.world().get::<Transform>(camera).unwrap_or(&place)
    }

    fn near(a: Transform, b: Transform) -> bool {
        a.translation.distance(b.translation) < 1e-4 && a.rotation.angle_between(b.rotation) < 1e-3
    }

    #[test]
    fn the_camera_turns_alike_whatever_the_pointer_tells() {
        let way = Vec2::new(30.0, -12.0);
        let (told, moved) = (Some(way), Some(way));
        for button in [MouseButton::Left, MouseButton::Right] {
            let still = drag(button, &[(None, None); 3]);
            let mouse = drag(button, &[(told, moved); 3]);
            assert!(!near(still, mouse), "{button:?}");
            let place = Some(Vec2::new(31_000.0, 17_000.0));
            let cases: [(&str, Vec<Sent>); 7] = [
                ("a tablet that sends places", vec![(place, moved); 3]),
                ("a captured mouse", vec![(told, None); 3]),
                ("a tablet", vec![(None, moved); 3]),
                ("a tablet that jumps", vec![(None, Some(3.0 * way))]),
                ("a tablet that pauses", vec![(None, moved), (None, None), (None, moved), (None, moved)]),
                (
                    "a mouse whose cursor is late",
                    vec![(told, None), (told, moved), (told, moved), (None, moved)],
                ),
                (
                    "a mouse whose cursor is early",
                    vec![(None, moved), (told, moved), (told, moved), (told, None)],
                ),
            ];
            for (what, frames) in cases {
                let there = drag(button, &frames);
                assert!(near(there, mouse), "{button:?}, {what}: {there:?} and {mouse:?}");
            }
        }
    }

    #[test]
    fn what_the_cursor_went_before_the_drag_turns_nothing() {
        let way = Some(Vec2::new(15.0, 0.0));
        for frames in [[(None, way); 3], [(way, way); 3]] {
            let there = drag_after(Some(Vec2::new(200.0, 100.0)), MouseButton::Left, &frames);
            let mouse = drag(MouseButton::Left, &[(way, way); 3]);
            assert!(near(there, mouse), "{there:?} and {mouse:?}");
        }
    }

    #[test]
    fn a_mouse_after_a_tablet_moves_at_its_own_speed() {
        let way = Some(Vec2::new(20.0, 0.0));
        let both = drag(MouseButton::Left, &[(None, way), (None, way), (way, way), (way, way)]);
        let mouse = drag(MouseButton::Left, &[(way, way); 4]);
        assert!(near(both, mouse), "{both:?} and {mouse:?}");
    }
}
