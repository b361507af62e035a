//! Fingers on the picture: one is the left button of a mouse, which turns the camera and selects; two move and zoom.
//!
//! The crate of the camera controls reads the fingers itself: what is decided here is whether they are the picture's.

use bevy::{input::touch::Touch, prelude::*};
use bevy_egui::{EguiContext, PrimaryEguiContext};

use super::pointer::{OverPicture, PointerPlugin, follow_cursor, is_over};
use crate::panel::state::PictureArea;

/// Follows the pointer and the fingers.
pub(super) struct TouchPlugin;

impl TouchPlugin {
    /// Adds the plugin, unless it is already present.
    pub(super) fn add_to(app: &mut App) {
        if !app.is_plugin_added::<Self>() {
            app.add_plugins(Self);
        }
    }
}

impl Plugin for TouchPlugin {
    fn build(&self, app: &mut App) {
        PointerPlugin::add_to(app);
        app.add_systems(PreUpdate, follow_fingers.after(follow_cursor));
    }
}

/// The fingers that are down.
#[derive(Debug, Default)]
pub(super) struct Hand {
    /// True if they came down on the picture.
    is_over: bool,
    /// The one that stands for the left button.
    first: Option<u64>,
}

/// Follows the fingers. A second one takes back the button: two select nothing.
pub(super) fn follow_fingers(
    touches: Res<Touches>,
    area: Option<Res<PictureArea>>,
    mut contexts: Query<&mut EguiContext, With<PrimaryEguiContext>>,
    mut buttons: ResMut<ButtonInput<MouseButton>>,
    mut over: ResMut<OverPicture>,
    mut hand: Local<Hand>,
) {
    let new: Vec<&Touch> = touches.iter_just_pressed().collect();
    // Further fingers belong where the first ones do.
    if !new.is_empty() && touches.iter().all(|touch| touches.just_pressed(touch.id())) {
        let context = contexts.iter_mut().next().map(|mut context| context.get_mut().clone());
        let (context, area) = (context.as_ref(), area.as_deref());
        hand.is_over = new.iter().all(|touch| is_over(context, area, Some(touch.position())));
        if let ([touch], true) = (new.as_slice(), hand.is_over) {
            buttons.press(MouseButton::Left);
            over.pressed = Some(touch.position());
            hand.first = Some(touch.id());
        }
    }
    let count = touches.iter().count();
    (over.touched, over.fingers) = (count > 0, count > 0 && hand.is_over);
    over.finger = None;
    let Some(first) = hand.first else { return };
    let touch = touches.get_pressed(first).or_else(|| touches.get_released(first));
    if let (Some(touch), true) = (touch, count < 2) {
        over.finger = Some(touch.position());
        if touches.just_released(first) {
            buttons.release(MouseButton::Left);
            hand.first = None;
        }
    } else {
        buttons.reset(MouseButton::Left);
        hand.first = None;
    }
}

#[cfg(test)]
mod tests {
    use bevy::{
        MinimalPlugins,
        input::{
            InputPlugin,
            touch::{TouchInput, TouchPhase},
        },
        window::WindowEvent,
    };

    use super::*;

    /// Fingers on a picture that fills the window, since there are no panels.
    fn app() -> (App, Entity) {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin))
            .add_message::<WindowEvent>()
            .init_resource::<OverPicture>()
            .add_systems(Update, follow_fingers);
        let window = app.world_mut().spawn_empty().id();
        (app, window)
    }

    /// A frame in which fingers, by their numbers, do this at a place.
    fn frame((app, window): &mut (App, Entity), events: &[(u64, TouchPhase, Vec2)]) {
        for (id, phase, position) in events {
            let (id, phase, position, window) = (*id, *phase, *position, *window);
            app.world_mut().write_message(TouchInput { phase, position, window, force: None, id });
        }
        app.update();
    }

    fn left(app: &App) -> [bool; 3] {
        let buttons = app.world().resource::<ButtonInput<MouseButton>>();
        let left = MouseButton::Left;
        [buttons.just_pressed(left), buttons.pressed(left), buttons.just_released(left)]
    }

    const AT: Vec2 = Vec2::new(50.0, 60.0);
    const BESIDE: Vec2 = Vec2::new(90.0, 60.0);

    #[test]
    fn one_finger_is_the_left_button() {
        let mut all = app();
        frame(&mut all, &[(7, TouchPhase::Started, AT)]);
        assert_eq!(left(&all.0), [true, true, false]);
        let over = *all.0.world().resource::<OverPicture>();
        assert!(over.fingers && over.pressed == Some(AT) && over.finger == Some(AT));
        frame(&mut all, &[(7, TouchPhase::Moved, BESIDE)]);
        assert_eq!(left(&all.0), [false, true, false]);
        frame(&mut all, &[(7, TouchPhase::Ended, BESIDE)]);
        assert_eq!(left(&all.0), [false, false, true]);
        assert_eq!(all.0.world().resource::<OverPicture>().finger, Some(BESIDE));
        frame(&mut all, &[]);
        let over = *all.0.world().resource::<OverPicture>();
        assert!(!over.touched && !over.fingers && over.finger.is_none());
    }

    #[test]
    fn a_quick_tap_is_a_click() {
        let mut all = app();
        frame(&mut all, &[(1, TouchPhase::Started, AT), (1, TouchPhase::Ended, AT)]);
        assert_eq!(left(&all.0), [true, false, true]);
        assert_eq!(all.0.world().resource::<OverPicture>().finger, Some(AT));
    }

    #[test]
    fn a_second_finger_takes_back_the_click_and_goes_on_with_the_gesture() {
        let mut all = app();
        frame(&mut all, &[(1, TouchPhase::Started, AT)]);
        frame(&mut all, &[(2, TouchPhase::Started, BESIDE)]);
        assert_eq!(left(&all.0), [false; 3]);
        assert!(all.0.world().resource::<OverPicture>().fingers);
        frame(&mut all, &[(2, TouchPhase::Ended, BESIDE)]);
        frame(&mut all, &[(1, TouchPhase::Ended, AT)]);
        assert_eq!(left(&all.0), [false; 3], "nothing is clicked");
        assert!(!all.0.world().resource::<OverPicture>().fingers);
    }
}
