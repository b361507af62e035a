//! The outline of a light with extent, as the camera sees it.

use super::{SELECTED, ink::Ink};
use crate::{
    registry::Registry,
    scene::{Light, Scene, record},
};

/// Draws the outline of a light, whether it is to be seen in the picture or not.
pub(super) fn outline(ink: &mut Ink, light: &Light, scene: &Scene, registry: &Registry) {
    let Some(entry) = registry.light(&light.light_type) else { return };
    let record = record(light, registry, scene.display.encoding);
    for points in entry.outlines(&light.parameters, &record, ink.lens.eye) {
        let hull = ink.lens.hull(&points);
        ink.ring(hull, SELECTED);
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Pos2, Rect, pos2, vec2};
    use glam::{Quat, Vec3};

    use crate::{
        light::LightRecord,
        optics::colour::Encoding,
        panel::{marks::Lens, state::Session},
        parameter::{Value, Values},
        registry::Registry,
        scene::Scene,
    };

    fn lens(turn: Quat) -> Lens {
        let mut session = Session::new(Scene::default());
        session.facts.camera = turn;
        session.facts.eye = Vec3::splat(5.0) + turn * Vec3::new(0.3, -0.2, 4.0);
        Lens::of(&session, Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 600.0)))
    }

    /// Distance of a point from the edges of a convex polygon, in points; negative outside.
    fn depth(hull: &[Pos2], at: Pos2) -> f32 {
        let side = |k: usize| {
            let (way, to) = ((hull[(k + 1) % hull.len()] - hull[k]).normalized(), at - hull[k]);
            way.x * to.y - way.y * to.x
        };
        (0..hull.len()).map(side).fold(f32::INFINITY, f32::min)
    }

    /// Places at which the outline and the light itself say different things, of those that are not at its edge; and those
    /// at which there is light. The outline is that of other values.
    fn differ(light_type: &str, turn: Quat, values: &Values, outlined: &Values) -> (usize, usize) {
        let registry = Registry::builtin();
        let entry = registry.light(light_type).expect("built in");
        let record = LightRecord {
            position: if entry.declaration.has_position { Vec3::new(5.2, 5.3, 4.6) } else { Vec3::ZERO },
            direction: Vec3::new(-0.6, -0.3, 0.75).normalize(),
            intensity: 1.0,
            ..LightRecord::default()
        };
        let lens = lens(turn);
        let outlines = entry.outlines(outlined, &record, lens.eye);
        assert_eq!(outlines.len(), 1, "{light_type}");
        let hull = lens.hull(&outlines[0]);
        let mut solid = vec![((entry.instantiate)(values, Encoding::default()), record)];
        if light_type == "cylinder" {
            // Its ends are dark, and closed by discs.
            let disc = registry.light("disc").expect("built in");
            let half = 0.5 * values.number(entry.parameter("length").expect("it has one"));
            solid.extend([-half, half].map(|along| {
                let position = record.position + along * record.direction;
                ((disc.instantiate)(values, Encoding::default()), LightRecord { position, ..record })
            }));
        }
        let (mut different, mut lit) = (0, 0);
        for at in
            (0..60).flat_map(|y| (0..80).map(move |x| pos2(105.0 + 10.0 * x as f32, 55.0 + 10.0 * y as f32)))
        {
            let way = lens.ray(at).way;
            let shines = solid.iter().any(|(one, record)| one.seen(record, lens.eye, way).distance > 0.0);
            let depth = depth(&hull, at);
            lit += usize::from(shines);
            different += usize::from(depth.abs() > 1.0 && shines != (depth > 0.0));
        }
        (different, lit)
    }

    #[test]
    fn the_outline_is_that_of_what_is_seen() {
        for light_type in ["rectangle", "disc", "sphere", "cylinder", "sun"] {
            let mut values = Values::default();
            let mut other = Values::default();
            for (values, factor) in [(&mut values, 1.0), (&mut other, 1.15)] {
                values.set("width", Value::Number(1.4 * factor));
                values.set("height", Value::Number(0.8 * factor));
                values.set("length", Value::Number(2.0 * factor));
                values.set("radius", Value::Number(0.6 * factor));
                values.set("diameter", Value::Number(30.0 * factor));
                values.set("roll", Value::Number(25.0));
                values.set("two_sided", Value::flag(true));
            }
            let looks: &[Quat] = match light_type {
                // It is where the light comes from.
                "sun" => {
                    &[Quat::from_rotation_y(-0.55), Quat::from_rotation_y(-0.8) * Quat::from_rotation_x(0.2)]
                }
                _ => &[Quat::IDENTITY, Quat::from_rotation_y(-1.3) * Quat::from_rotation_x(-0.4)],
            };
            for turn in looks {
                let (different, lit) = differ(light_type, *turn, &values, &values);
                assert!(lit > 50, "{light_type}: {lit} places are lit");
                assert_eq!(different, 0, "{light_type} at {turn}");
                // The wrong twin: another size.
                assert!(differ(light_type, *turn, &values, &other).0 > 5, "{light_type} at {turn}");
            }
        }
    }

    #[test]
    fn a_light_spans_all_of_its_sizes() {
        let registry = Registry::builtin();
        let mut values = Values::default();
        for (name, metres) in [("width", 0.6), ("height", 0.8), ("length", 2.4), ("radius", 0.5)] {
            values.set(name, Value::Number(metres));
        }
        let spans = [("rectangle", 1.0), ("disc", 1.0), ("sphere", 1.0), ("cylinder", 2.6), ("point", 0.0)];
        for (light_type, span) in spans {
            let found = registry.light(light_type).expect("built in").span(&values);
            assert!((found - span).abs() < 1e-6, "{light_type}: {found}");
        }
    }

    #[test]
    fn light_without_end_and_light_of_a_point_have_no_outline() {
        let registry = Registry::builtin();
        for light_type in ["point", "spot", "ambient", "environment"] {
            let entry = registry.light(light_type).expect("built in");
            let none = entry.outlines(&Values::default(), &LightRecord::default(), Vec3::ONE);
            assert!(none.is_empty(), "{light_type}");
        }
        // From within a ball there is no edge.
        let within = registry.light("sphere").expect("built in").outlines(
            &Values::default(),
            &LightRecord::default(),
            Vec3::splat(0.1),
        );
        assert!(lens(Quat::IDENTITY).hull(&within[0]).is_empty());
    }
}
