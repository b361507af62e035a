//! Turns about the vertical, with suggestions where one leaves the room.

use glam::{Quat, Vec3};

use super::{Axis, Sweep, axis::called};
use crate::{
    caption::Part as Words,
    parameter::Value,
    registry::Registry,
    scene::{
        Part, Scene,
        at::Place,
        rotation::{rotation, turned},
    },
    text::{listed, quoted},
};

/// Maximum number of places of all parts that turn, in all pictures together: they are in memory at once.
const MAX_PLACES: usize = 1_000_000;
/// The thing that turns by default.
const OBSERVER: &str = "observer";
/// The angles that are tried in place of one that is too large, degrees.
const SMALLER: [f32; 9] = [180.0, 120.0, 90.0, 60.0, 45.0, 30.0, 20.0, 10.0, 5.0];

impl Axis {
    /// A turn about the vertical through the middle of the visible objects: `360:24`, or with the thing that turns,
    /// `objects[0]=360:24`; without it, the observer. Objects by number turn about themselves. Whole turns leave out their
    /// end, which is their beginning.
    ///
    /// # Errors
    /// Returns the mistake.
    pub fn turn(text: &str, scene: &Scene, registry: &Registry) -> Result<Self, String> {
        Turn::read(text)?.axis(scene, registry).map_err(|why| format!("{}: {why}", quoted(text)))
    }
}

/// A turn as written: the turning things, the angle, and the number of pictures.
#[derive(Clone, Copy, Debug)]
struct Turn<'a> {
    what: &'a str,
    degrees: f32,
    count: usize,
}

impl<'a> Turn<'a> {
    fn read(text: &'a str) -> Result<Self, String> {
        let (what, amount) = text.split_once('=').unwrap_or((OBSERVER, text));
        let form = "write DEGREES:COUNT, as in 360:24, or objects[0]=360:24";
        let (degrees, count) = amount.split_once(':').ok_or_else(|| format!("{}: {form}", quoted(text)))?;
        let degrees: Option<f32> = degrees.trim().parse().ok();
        let degrees = degrees.filter(|v| v.is_finite() && *v != 0.0 && v.abs() <= 36_000.0);
        let degrees = degrees.ok_or_else(|| {
            format!(
                "{}: the angle must be a number of degrees other than 0, at most 36000; {form}",
                quoted(text)
            )
        })?;
        let count = super::count(count).map_err(|why| format!("{}: {why}; {form}", quoted(text)))?;
        Ok(Self { what: what.trim(), degrees, count })
    }

    /// The turn as it would be written.
    fn written(self) -> String {
        let Self { what, degrees, count } = self;
        let what = if what == OBSERVER { String::new() } else { format!("{what}=") };
        format!("--turn {what}{degrees}:{count}")
    }

    fn axis(self, scene: &Scene, registry: &Registry) -> Result<Axis, String> {
        let Self { what, degrees, count } = self;
        let steps = if degrees % 360.0 == 0.0 { count } else { count - 1 };
        let angles: Vec<f32> = (0..count).map(|i| degrees * i as f32 / steps as f32).collect();
        let parts = turning(what, scene).ok_or_else(|| {
            format!(
                "{} cannot turn; it must be observer, lights, lights[0], objects, objects[0], …",
                quoted(what)
            )
        })?;
        if parts.len().saturating_mul(count) > MAX_PLACES {
            let parts = parts.len();
            let most = MAX_PLACES / parts;
            return Err(format!(
                "{count} pictures are too many for {parts} parts that turn; at most {most} are possible"
            ));
        }
        let sets = sets(what, &parts, &angles, scene, registry);
        if sets.is_empty() {
            return Err(format!("{what} cannot turn: no position, direction or rotation is there"));
        }
        let written: Vec<_> =
            angles.iter().map(|angle| (angle * 100.0).round() / 100.0).map(|v| v.to_string()).collect();
        let label = |angle: &String| vec![Words::new(0, format!("{}°", angle.replace('-', "−")))];
        let labels = written.iter().map(label).collect();
        let name = match parts.as_slice() {
            [one] if what.ends_with(']') => called(*one, scene, registry),
            _ => what.to_owned(),
        };
        Ok(Axis {
            name: format!("{name} turned"),
            labels,
            moves: true,
            word: "turn".to_owned(),
            written,
            sets,
            views: Vec::new(),
        })
    }

    /// True if every picture of the turn is a valid scene.
    fn works(&self, scene: &Scene, registry: &Registry) -> bool {
        let axis = self.axis(scene, registry);
        axis.is_ok_and(|axis| Sweep::new(scene, 0, vec![axis], registry).is_ok())
    }
}

/// The suggestion in place of a turn that leaves the room, or breaks another rule of scenes; `None` if the turn itself
/// is not to blame.
#[must_use]
pub fn instead_of_turn(text: &str, scene: &Scene, registry: &Registry) -> Option<String> {
    let turn = Turn::read(text).ok().filter(|turn| !turn.works(scene, registry))?;
    let works = |turn: &Turn| turn.works(scene, registry);
    let others = ["objects", "lights", OBSERVER].into_iter().filter(|what| *what != turn.what);
    let others = others.map(|what| Turn { what, ..turn }).filter(works);
    let less = SMALLER.into_iter().filter(|degrees| *degrees < turn.degrees.abs());
    let less = less.map(|degrees| Turn { degrees: degrees.copysign(turn.degrees), ..turn }).find(works);
    let known: Vec<_> = less.into_iter().chain(others).map(Turn::written).collect();
    Some(match known.is_empty() {
        true => "no turn is possible: make the room larger, with scene_size, or move things to its middle"
            .to_owned(),
        false => format!("possible: {}", listed(&known, "or")),
    })
}

/// The values of the parts in each picture.
fn sets(
    what: &str,
    parts: &[Part],
    angles: &[f32],
    scene: &Scene,
    registry: &Registry,
) -> Vec<(Place, Vec<Value>)> {
    let centre = middle(scene);
    let mut sets = Vec::new();
    for part in parts {
        for key in ["position", "direction", "rotation"] {
            if key == "position" && what.starts_with("objects[") {
                continue;
            }
            // Not every part has all of them.
            let Ok(place) = Place::find(&part.path().key(key).to_string(), scene, registry) else {
                continue;
            };
            let Some(Value::Triple(from)) = place.value(scene) else { continue };
            let turned = |angle: &f32| Value::Triple(turn(key, from.into(), *angle, centre).into());
            sets.push((place, angles.iter().map(turned).collect()));
        }
    }
    sets
}

/// The parts that turn, by their path.
fn turning(what: &str, scene: &Scene) -> Option<Vec<Part>> {
    let (lights, objects) = (0..scene.lights.len(), 0..scene.objects.len());
    match what {
        "observer" => return Some(vec![Part::Observer]),
        "lights" => return Some(lights.map(Part::Light).collect()),
        "objects" => return Some(objects.map(Part::Object).collect()),
        _ => {}
    }
    let all = lights.map(Part::Light).chain(objects.map(Part::Object));
    all.into_iter().find(|part| part.path().to_string() == what).map(|part| vec![part])
}

/// The middle of the visible objects.
fn middle(scene: &Scene) -> Vec3 {
    let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for object in scene.shown() {
        least = least.min(object.position - 0.5 * object.size);
        most = most.max(object.position + 0.5 * object.size);
    }
    if least.is_finite() { 0.5 * (least + most) } else { 0.5 * scene.scene_size.corner() }
}

/// A value of a part after a turn.
fn turn(key: &str, from: Vec3, degrees: f32, centre: Vec3) -> Vec3 {
    if degrees % 360.0 == 0.0 {
        return from;
    }
    let radians = degrees.to_radians();
    let turn = Quat::from_rotation_y(radians);
    match key {
        "position" => centre + turn * (from - centre),
        "direction" => turn * from,
        _ => turned(rotation(from), Vec3::Y, radians),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Object;

    fn turned_to(text: &str, i: usize) -> Scene {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let axis = Axis::turn(text, &scene, &registry).unwrap_or_else(|e| panic!("{text}: {e}"));
        let values = axis.sets.iter().map(|(place, values)| (place, &values[i]));
        scene.with(values, &registry).expect("in the room")
    }

    #[test]
    fn the_observer_turns_about_the_objects_and_looks_at_them() {
        let quarter = turned_to("360:4", 1);
        assert!((quarter.observer.position - Vec3::new(9.5, 5.0, 5.0)).length() < 1e-4);
        assert!((quarter.observer.direction - Vec3::NEG_X).length() < 1e-6);
        assert_eq!(turned_to("360:4", 0), Scene::default());
        // Part of a turn has both ends.
        assert!((turned_to("90:2", 1).observer.position - quarter.observer.position).length() < 1e-4);
    }

    #[test]
    fn lights_and_objects_turn_too() {
        let light = turned_to("lights[0]=180:2", 1).lights[0].position.expect("has one");
        assert!((light - Vec3::new(2.5, 8.0, 1.0)).length() < 1e-4, "{light}");
        let object = &turned_to("objects[0]=360:8", 1).objects[0];
        assert_eq!((object.rotation, object.position), (Vec3::new(0.0, 45.0, 0.0), Vec3::splat(5.0)));
    }

    #[test]
    fn mistakes_are_named() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        for (text, expected) in [
            ("360", "write DEGREES:COUNT"),
            ("0:4", "other than 0"),
            ("nan:4", "a number of degrees"),
            ("360:1", "at least 2"),
            ("lamp=360:4", "\"lamp\" cannot turn"),
            ("objects[3]=360:4", "\"objects[3]\" cannot turn"),
        ] {
            let said = Axis::turn(text, &scene, &registry).expect_err(text);
            assert!(said.contains(expected), "{text}: {said}");
        }
        let many = Scene { objects: vec![Object::default(); 2000], ..Scene::default() };
        let said = Axis::turn("objects=360:1000", &many, &registry).expect_err("too much memory");
        assert!(said.contains("1000 pictures are too many for 2000 parts that turn; at most 500"), "{said}");
    }

    #[test]
    fn a_turn_that_leaves_the_room_says_what_is_possible() {
        let registry = Registry::builtin();
        let mut scene = Scene::default();
        assert_eq!(instead_of_turn("360:24", &scene, &registry), None, "it stays in the room");
        assert_eq!(instead_of_turn("360", &scene, &registry), None, "that is another mistake");
        scene.scene_size.width = 8.0;
        let said = instead_of_turn("-360:8", &scene, &registry).expect("it is too near to the wall");
        let written: Vec<_> = said.split(['"', ' ', ',']).filter(|word| word.ends_with(":8")).collect();
        assert!(said.starts_with("possible: --turn -") && said.contains("--turn objects=-360:8"), "{said}");
        for turn in written {
            let axis = Axis::turn(turn, &scene, &registry).expect(turn);
            assert!(Sweep::new(&scene, 0, vec![axis], &registry).is_ok(), "{turn}");
        }
        let said = instead_of_turn("lights[0]=360:8", &scene, &registry).expect("so is the light");
        assert!(said.contains("--turn objects=360:8") && !said.contains("--turn 360:8"), "{said}");
    }
}
