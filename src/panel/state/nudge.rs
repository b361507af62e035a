//! Keyboard steps that move, turn and resize the selection.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::{Quat, Vec3};

use super::{HandleMode, Session, Together, arrange::tidy};
use crate::{
    document::{Edit, Selection},
    light::LightEntry,
    parameter::Value,
    registry::Registry,
    scene::{
        Light, Object, Part, limits,
        rotation::{rotation, turned},
    },
};

/// Step of a position or a size, in metres.
const METRES: f32 = 0.1;
/// Step of an angle, in degrees.
const DEGREES: f32 = 5.0;

/// The roll of a light after one step about an axis, if the light's direction is closer to parallel than to
/// perpendicular to that axis.
fn rolled(part: Part, light: &Light, entry: &LightEntry, axis: Vec3) -> Option<Edit> {
    let parameter = entry.roll_parameter()?;
    let along = light.direction?.normalize_or_zero().dot(axis);
    let degrees = light.parameters.number(parameter) + DEGREES * along.signum();
    let roll = parameter.nearest_angle(degrees).filter(|_| along.abs() > FRAC_1_SQRT_2)?;
    Some(Edit::parameter(part, parameter.name, roll))
}

/// The cone or a size of a light, enlarged or reduced by one step. A sideways direction stands for the first size,
/// other directions for the second.
fn resized(part: Part, light: &Light, entry: &LightEntry, way: Vec3, sign: f32) -> Option<Edit> {
    let sizes = entry.declaration.sizes;
    let size = sizes.get(if way.x == 0.0 { 1 } else { 0 }).or(sizes.last());
    let parameter = size.map_or(entry.cone_parameter(), |size| entry.parameter(size.parameter()))?;
    let before = light.parameters.number(parameter);
    let wanted = match size {
        None => before + DEGREES * sign,
        Some(_) => {
            // Small sizes change in small steps; the smallest stay unchanged.
            let step = if before + 0.001 * sign > 2.0 * METRES { METRES } else { 0.1 * METRES };
            (before + step * sign).max(before.min(step))
        }
    };
    let nearest = parameter.nearest(&Value::Number(tidy(Vec3::splat(wanted)).x))?;
    Some(Edit::parameter(part, parameter.name, nearest))
}

impl Session {
    /// Moves, turns or resizes the selection by one step in a world direction, as a step of the history.
    pub(super) fn nudge(&mut self, way: Vec3, registry: &Registry) {
        let edit = match Together::of(self, registry) {
            Some(all) => self.nudged_together(&all, way, registry),
            None => self.nudged(self.selection, way, registry),
        };
        self.alone(edit, registry);
    }

    /// The edit for one step of several parts, or why it is impossible.
    fn nudged_together(&self, all: &Together, way: Vec3, registry: &Registry) -> Result<Edit, String> {
        let room = self.document.scene_size;
        match self.view.handles {
            HandleMode::Move => Ok(all.moved(METRES * way, room)),
            HandleMode::Turn => all
                .turned(way, DEGREES.to_radians(), room)
                .ok_or_else(|| format!("The room has no place to turn {}.", all.name())),
            HandleMode::Size => {
                let resized = self.entries().into_iter().map(|part| self.nudged(part, way, registry));
                // Some lights have no size.
                let edits: Vec<_> = resized.filter_map(Result::ok).collect();
                let none = || format!("None of {} has a size.", all.name());
                if edits.is_empty() {
                    return Err(none());
                }
                Ok(Edit::Each { edits, step: format!("Size of {}", all.name()) })
            }
        }
    }

    /// The edit for one step of a part, or why it is impossible.
    fn nudged(&self, selection: Selection, way: Vec3, registry: &Registry) -> Result<Edit, String> {
        let name = || self.name_of(selection, registry);
        let has_no = |what: &str| Err(format!("{} has no {what}.", name()));
        let turn = Quat::from_axis_angle(way, DEGREES.to_radians());
        // Right, up and backwards enlarge.
        let sign = (way.x + way.y - way.z).signum();
        let room = self.document.scene_size;
        let part = Part::from(selection);
        match selection {
            Selection::Object(i) if self.exists(selection) => {
                let object = &self.document.objects[i];
                Ok(match self.view.handles {
                    HandleMode::Move => {
                        Edit::set(part, Object::position, room.nearest(tidy(object.position + METRES * way)))
                    }
                    HandleMode::Turn => Edit::set(
                        part,
                        Object::rotation,
                        turned(rotation(object.rotation), way, DEGREES.to_radians()),
                    ),
                    HandleMode::Size => {
                        let most = limits::object_size(room).max as f32;
                        let size = tidy(Vec3::splat(object.size + METRES * sign)).x;
                        // Small objects stay as they are.
                        let least = object.size.min(METRES);
                        Edit::set(part, Object::size, size.max(least).min(most))
                    }
                })
            }
            Selection::Light(i) if self.exists(selection) => {
                let light = &self.document.lights[i];
                let entry = registry.light(&light.light_type);
                Ok(match (self.view.handles, light.position, light.direction) {
                    (HandleMode::Move, Some(at), _) => {
                        Edit::set(part, Light::position, room.nearest(tidy(at + METRES * way)))
                    }
                    (HandleMode::Move, None, _) => return has_no("position"),
                    (HandleMode::Turn, _, Some(direction)) => entry
                        .and_then(|e| rolled(part, light, e, way))
                        .unwrap_or_else(|| Edit::set(part, Light::direction, tidy(turn * direction))),
                    (HandleMode::Turn, _, None) => return has_no("direction"),
                    (HandleMode::Size, ..) => match entry.and_then(|e| resized(part, light, e, way, sign)) {
                        Some(field) => field,
                        None => return has_no("size"),
                    },
                })
            }
            _ => Err("Select an object or a light to move it.".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        panel::state::{Action, HandleChange, ViewChange},
        scene::Scene,
    };

    fn session() -> (Session, Registry) {
        let registry = Registry::builtin();
        let mut scene = Scene::default();
        scene.lights[0] = Light {
            light_type: "spot".to_owned(),
            position: Some(Vec3::new(2.0, 3.0, 4.0)),
            direction: Some(Vec3::NEG_Y),
            ..Light::default()
        };
        (Session::new(scene), registry)
    }

    fn mode(mode: HandleMode) -> Action {
        Action::View(ViewChange::Handles(HandleChange::Mode(mode)))
    }

    #[test]
    fn each_nudge_is_one_step_along_its_axis() {
        let (mut session, registry) = session();
        for _ in 0..2 {
            session.apply(Action::Nudge(Vec3::X), &registry);
        }
        session.apply(Action::Nudge(Vec3::NEG_Z), &registry);
        assert_eq!(session.document.objects[0].position, Vec3::new(5.2, 5.0, 4.9));
        assert_eq!(session.document.done(), 3);
        session.apply(mode(HandleMode::Turn), &registry);
        session.apply(Action::Nudge(Vec3::Y), &registry);
        assert_eq!(session.document.objects[0].rotation, Vec3::new(0.0, 5.0, 0.0));
        session.apply(mode(HandleMode::Size), &registry);
        let size = session.document.objects[0].size;
        session.apply(Action::Nudge(Vec3::NEG_X), &registry);
        assert!((session.document.objects[0].size - size + 0.1).abs() < 1e-4);
        assert_eq!(session.document.done(), 5);
    }

    #[test]
    fn a_nudge_stays_legal_without_a_message() {
        let (mut session, registry) = session();
        let messages = session.messages.iter().count();
        (0..80).for_each(|_| drop(session.apply(Action::Nudge(Vec3::NEG_X), &registry)));
        assert!(session.document.scene_size.contains(session.document.objects[0].position));
        session.apply(mode(HandleMode::Size), &registry);
        (0..80).for_each(|_| drop(session.apply(Action::Nudge(Vec3::NEG_X), &registry)));
        assert_eq!(session.document.objects[0].size, 0.1);
        assert_eq!(session.messages.iter().count(), messages);
    }

    #[test]
    fn a_light_turns_opens_and_says_what_it_lacks() {
        let (mut session, registry) = session();
        session.apply(Action::Select(Selection::Light(0)), &registry);
        session.apply(mode(HandleMode::Turn), &registry);
        (0..18).for_each(|_| drop(session.apply(Action::Nudge(Vec3::X), &registry)));
        let direction = session.document.lights[0].direction.unwrap_or_default();
        assert!(direction.distance(Vec3::NEG_Z) < 1e-3, "{direction}");
        session.apply(mode(HandleMode::Size), &registry);
        let angle = |session: &Session| {
            registry.light("spot").and_then(|spot| spot.cone_angle(&session.document.lights[0].parameters))
        };
        let before = angle(&session).unwrap_or_default();
        session.apply(Action::Nudge(Vec3::Y), &registry);
        assert_eq!(angle(&session), Some(before + 5.0));
        session.document.amend(|scene| scene.lights[0] = Light::default());
        session.apply(Action::Nudge(Vec3::Y), &registry);
        let said = session.messages.iter().last().map(|note| note.text.clone()).unwrap_or_default();
        assert!(said.ends_with("has no size."), "{said}");
    }

    #[test]
    fn a_lamp_grows_by_each_of_its_sizes_and_rolls_about_its_direction() {
        let (mut session, registry) = session();
        let light = |light_type: &str| Light {
            light_type: light_type.to_owned(),
            position: Some(Vec3::new(2.0, 3.0, 4.0)),
            direction: (light_type != "sphere").then_some(Vec3::new(0.1, 0.0, -1.0)),
            ..Light::default()
        };
        session.apply(Action::Select(Selection::Light(0)), &registry);
        let mut after = |light_type: &str, mode_of: HandleMode, ways: &[Vec3], name: &str| {
            session.document.amend(|scene| scene.lights[0] = light(light_type));
            session.apply(mode(mode_of), &registry);
            ways.iter().for_each(|way| drop(session.apply(Action::Nudge(*way), &registry)));
            let light = &session.document.lights[0];
            let parameter = registry.light(light_type).and_then(|entry| entry.parameter(name));
            (parameter.map_or(f32::NAN, |p| light.parameters.number(p)), light.direction)
        };
        let size = HandleMode::Size;
        assert_eq!(after("rectangle", size, &[Vec3::X], "width").0, 2.1);
        assert_eq!(after("rectangle", size, &[Vec3::X], "height").0, 1.0);
        assert_eq!(after("rectangle", size, &[Vec3::NEG_Y], "height").0, 0.9);
        assert_eq!(after("cylinder", size, &[Vec3::NEG_X], "length").0, 1.9);
        assert_eq!(after("cylinder", size, &[Vec3::Y], "radius").0, 0.06);
        assert_eq!(after("sphere", size, &[Vec3::X, Vec3::Y], "radius").0, 0.7);
        // In small steps, and never to zero.
        assert_eq!(after("disc", size, &[Vec3::NEG_X; 60], "radius").0, 0.01);
        let turn = HandleMode::Turn;
        let start = light("rectangle").direction;
        assert_eq!(after("rectangle", turn, &[Vec3::Z], "roll"), (-5.0, start));
        assert_eq!(after("rectangle", turn, &[Vec3::NEG_Z; 73], "roll"), (5.0, start));
        let (roll, direction) = after("rectangle", turn, &[Vec3::Y], "roll");
        assert!(roll == 0.0 && direction != start);
    }
}
