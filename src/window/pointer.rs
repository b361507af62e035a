//! The pointer motion that turns the camera: taken from the cursor, which every pointer has. Tablets, remote desktops
//! and virtual machines report no device motion, or report positions instead.
//!
//! Device motion counts only while the cursor is stuck, as at the edge of the screen. The two do not always arrive in
//! the same frame, so device motion takes effect one frame later.
//!
//! Pens, fingers and remote desktops send a move and a press at once: the position of the press decides where the press
//! belongs, and earlier motion turns nothing.

use bevy::{
    input::{InputSystems, mouse::MouseMotion},
    prelude::*,
    window::{RequestRedraw, WindowEvent},
};
use bevy_egui::{
    EguiContext, PrimaryEguiContext,
    egui::{Context, pos2},
};

use crate::panel::{is_over_picture, state::PictureArea};

/// Tracks whether the pointer is over the picture.
pub(super) struct PointerPlugin;

impl PointerPlugin {
    /// Adds the plugin, unless it is already present.
    pub(super) fn add_to(app: &mut App) {
        if !app.is_plugin_added::<Self>() {
            app.add_plugins(Self);
        }
    }
}

impl Plugin for PointerPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<OverPicture>().add_systems(PreUpdate, follow_cursor.after(InputSystems));
    }
}

/// The relation of the pointer to the picture, based on the input of this frame.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(super) struct OverPicture {
    /// True if the pointer is over the picture.
    pub(super) now: bool,
    /// Position in the window of the latest button press, if it was over the picture.
    pub(super) pressed: Option<Vec2>,
    /// True if a finger is on the screen.
    pub(super) touched: bool,
    /// True if fingers are on the screen that came down on the picture.
    pub(super) fingers: bool,
    /// Position in the window of the only one of them, also in the frame in which it goes.
    pub(super) finger: Option<Vec2>,
}

/// True if a position in the window is over the picture.
pub(super) fn is_over(context: Option<&Context>, area: Option<&PictureArea>, place: Option<Vec2>) -> bool {
    let (Some(context), Some(area), Some(place)) = (context, area, place) else {
        // Without panels, the picture fills the window.
        return area.is_none() && place.is_some();
    };
    let place = place / area.zoom;
    is_over_picture(context, area.frame, pos2(place.x, place.y))
}

/// The state of the pointer.
#[derive(Default)]
pub(super) struct Pointer {
    /// Position in the window.
    place: Option<Vec2>,
    /// True if a button is held.
    held: bool,
    /// Device motion without corresponding cursor motion so far.
    pending: Option<Vec2>,
    /// True if the cursor moved in the previous frame.
    moved: bool,
}

impl Pointer {
    /// The effective motion, given those of the device and of the cursor in a frame, and whether the cursor `moved` at
    /// all; a button is `held` during a drag.
    fn frame(&mut self, device: Option<Vec2>, cursor: Option<Vec2>, moved: bool, held: bool) -> Option<Vec2> {
        let before = self.pending.take();
        let earlier = std::mem::replace(&mut self.moved, moved);
        if moved {
            return cursor;
        }
        self.pending = device.filter(|_| held && !earlier);
        before
    }
}

pub(super) fn follow_cursor(
    mut events: MessageReader<WindowEvent>,
    mut motion: ResMut<Messages<MouseMotion>>,
    buttons: Res<ButtonInput<MouseButton>>,
    area: Option<Res<PictureArea>>,
    mut contexts: Query<&mut EguiContext, With<PrimaryEguiContext>>,
    mut pointer: Local<Pointer>,
    mut over: ResMut<OverPicture>,
    mut requests: MessageWriter<RequestRedraw>,
) {
    let context = contexts.iter_mut().next().map(|mut context| context.get_mut().clone());
    let is_over = |place: Option<Vec2>| is_over(context.as_ref(), area.as_deref(), place);
    let (mut device, mut cursor, mut moved) = (Vec2::ZERO, Vec2::ZERO, false);
    for event in events.read() {
        match event {
            WindowEvent::MouseMotion(way) if pointer.held => device += way.delta,
            WindowEvent::CursorMoved(to) => {
                let way = to.delta.unwrap_or_default();
                moved |= way != Vec2::ZERO;
                if pointer.held {
                    cursor += way;
                }
                pointer.place = Some(to.position);
            }
            WindowEvent::CursorLeft(_) if !pointer.held => pointer.place = None,
            WindowEvent::MouseButtonInput(button) if button.state.is_pressed() => {
                pointer.held = true;
                // Alt+click explains the pixel.
                let explains = context.as_ref().is_some_and(|context| context.input(|i| i.modifiers.alt));
                over.pressed = pointer.place.filter(|place| !explains && is_over(Some(*place)));
            }
            _ => {}
        }
    }
    // A button that was released within the frame has turned nothing.
    pointer.held = buttons.get_pressed().next().is_some();
    over.now = is_over(pointer.place);
    let some = |way: Vec2| Some(way).filter(|way| *way != Vec2::ZERO);
    let held = pointer.held;
    motion.clear();
    if let Some(delta) = pointer.frame(some(device), some(cursor), moved, held) {
        motion.write(MouseMotion { delta });
    }
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
        window::CursorMoved,
    };
    use bevy_panorbit_camera::{ActiveCameraData, PanOrbitCamera, PanOrbitCameraPlugin};
    use glam::Vec3;

    use super::*;
    use crate::window::camera::orbit;

    /// Messages of a device in a frame: device motion and cursor motion.
    type Sent = (Option<Vec2>, Option<Vec2>);

    /// The camera after a drag with this button.
    fn drag(button: MouseButton, frames: &[Sent]) -> Transform {
        drag_after(None, false, button, frames)
    }

    /// The camera after a drag that starts with the cursor entering the picture, in the frame of the press if
    /// `at_once`.
    fn drag_after(hover: Option<Vec2>, at_once: bool, button: MouseButton, frames: &[Sent]) -> Transform {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, PanOrbitCameraPlugin))
            .add_message::<WindowEvent>()
            .add_message::<RequestRedraw>()
            .init_resource::<OverPicture>()
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
            app.world_mut().write_message(WindowEvent::from(moved(hover)));
            if !at_once {
                app.update();
            }
        }
        let press = MouseButtonInput { button, state: ButtonState::Pressed, window };
        app.world_mut().write_message(press);
        app.world_mut().write_message(WindowEvent::from(press));
        app.update();
        for (told, cursor) in frames {
            if let Some(delta) = *told {
                app.world_mut().write_message(MouseMotion { delta });
                app.world_mut().write_message(WindowEvent::from(MouseMotion { delta }));
            }
            if cursor.is_some() {
                app.world_mut().write_message(WindowEvent::from(moved(*cursor)));
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
            let mouse = drag(MouseButton::Left, &[(way, way); 3]);
            for at_once in [false, true] {
                let there = drag_after(Some(Vec2::new(200.0, 100.0)), at_once, MouseButton::Left, &frames);
                assert!(near(there, mouse), "{there:?} and {mouse:?}");
            }
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
