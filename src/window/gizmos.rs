//! The outline of the room, occluded by whatever is in front of it. Other marks are painted over the picture: see
//! [`marks`](crate::panel::marks).

use bevy::{camera::visibility::RenderLayers, prelude::*};

use crate::{
    panel::state::{Session, ThemeChoice},
    render::{
        entities::CurrentScene,
        schedule::{LabFrame, LabSystems},
        stage::GIZMO_LAYER,
    },
};

/// Lines that are occluded by objects.
#[derive(Default, Reflect, GizmoConfigGroup)]
struct InRoom;

/// Draws the outline of the room.
#[derive(Clone, Copy, Debug, Default)]
pub struct GizmosPlugin;

impl Plugin for GizmosPlugin {
    fn build(&self, app: &mut App) {
        let mut config = GizmoConfig::default();
        config.line.width = 1.0;
        config.render_layers = RenderLayers::layer(GIZMO_LAYER);
        app.insert_gizmo_config(InRoom, config).add_systems(LabFrame, draw.in_set(LabSystems::Capture));
    }
}

/// Neutral grey, three times as bright or dark as the surround.
const fn outline(theme: ThemeChoice) -> u8 {
    match theme {
        ThemeChoice::Dark => 122,
        ThemeChoice::Light => 92,
    }
}

fn draw(session: Res<Session>, scene: Res<CurrentScene>, mut room: Gizmos<InRoom>) {
    if !session.view.show_room {
        return;
    }
    let grey = outline(session.settings.theme);
    let colour = Color::srgb_u8(grey, grey, grey);
    let corner = scene.0.scene_size.corner();
    room.primitive_3d(&Cuboid::from_size(corner), Isometry3d::from_translation(corner * 0.5), colour);
    draw_floor(&mut room, corner, colour.with_alpha(0.25));
}

/// Draws lines on the floor, one per metre, or in large rooms one per ten metres.
fn draw_floor(gizmos: &mut Gizmos<InRoom>, corner: Vec3, faint: Color) {
    let step = if corner.x.max(corner.z) > 20.0 { 10.0 } else { 1.0 };
    for i in 1..=(corner.x / step) as u32 {
        let x = i as f32 * step;
        gizmos.line(Vec3::new(x, 0.0, 0.0), Vec3::new(x, 0.0, corner.z), faint);
    }
    for i in 1..=(corner.z / step) as u32 {
        let z = i as f32 * step;
        gizmos.line(Vec3::new(0.0, 0.0, z), Vec3::new(corner.x, 0.0, z), faint);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::colour::srgb_decode,
        panel::theme::{DARK, LIGHT},
    };

    #[test]
    fn the_outline_of_the_room_stands_out_of_the_surround() {
        let light = |grey: u8| srgb_decode(f32::from(grey) / 255.0) + 0.05;
        for (theme, palette) in [(ThemeChoice::Dark, DARK), (ThemeChoice::Light, LIGHT)] {
            let (a, b) = (light(outline(theme)), light(palette.surround.r()));
            assert!(a.max(b) / a.min(b) >= 3.0, "{theme:?}: {}", a.max(b) / a.min(b));
        }
    }
}
