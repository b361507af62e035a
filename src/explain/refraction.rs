//! Refraction where the view meets a clear body: Snell's angle, the critical angle, and the ways of light through a solid
//! one.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;

use super::{angle, number, rounded, triple};
use crate::{
    optics::{
        Frame,
        fresnel::dielectric,
        refraction::{critical_angle, is_matched, refracted},
    },
    reference::probe::{Body, Inside, Turn},
    reflection::Surface,
    text::plural,
};

/// Part of the light below which a way out is not listed, and the maximum number of boundaries that are.
const LEAST: f32 = 1e-3;
const LISTED: usize = 8;
/// Cosine of the angle to the direction of view below which light comes from straight ahead.
const STRAIGHT: f32 = 0.999_99;
/// Change of the height of a direction below which a ray is bent to the side only, degrees.
const LEVEL: f32 = 0.05;

/// Refraction at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Refraction {
    /// The direction to the observer.
    pub view: Vec3,
    /// Refractive index of the body relative to the room.
    pub index: f32,
    /// The angle of the view to the normal outside, degrees.
    pub incidence: f32,
    /// The angle of the ray to the normal inside, degrees; `None` where everything is reflected.
    pub refracted: Option<f32>,
    /// The direction of that ray.
    pub enters: Option<Vec3>,
    /// The angle inside a dense body, or outside a thin one, beyond which everything is reflected, degrees.
    pub critical: f32,
    /// The part of the light that the boundary reflects where the view meets it.
    pub reflectance: f32,
    /// The inside of the body, for solid bodies.
    pub inside: Option<Inside>,
    /// The parts of the light that both faces of a smooth pane together reflect and let through, in red, green and blue.
    pub pane: Option<[Vec3; 2]>,
}

impl Refraction {
    /// The refraction at a point of a surface; `None` for models that do not bend light.
    pub(super) fn of(
        surface: &dyn Surface,
        body: Option<&Body>,
        at: Vec3,
        view: Vec3,
        frame: &Frame,
    ) -> Option<Self> {
        let given = surface.refractive_index()?;
        let index = if is_matched(given) { 1.0 } else { given };
        let ray = refracted(view, frame.n, index);
        Some(Self {
            view,
            index,
            incidence: angle(frame.n.dot(view)),
            refracted: ray.map(|ray| angle(-frame.n.dot(ray))),
            enters: ray,
            critical: critical_angle(index).to_degrees(),
            reflectance: dielectric(index, frame.n.dot(view)),
            inside: body.map(|body| body.inside(at, view, frame.n).seen_by(surface.entering(view, frame))),
            pane: body.is_none().then(|| pane(surface, view, frame)).flatten(),
        })
    }

    /// The explanation, a sentence or an equation each. First what the ray does: where it is seen to come from, the angle of
    /// refraction, and the boundaries that it meets inside; then the critical angle and the reflectance.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let mut lines: Vec<_> = self.crossing().into_iter().collect();
        lines.push(self.bent());
        let remaining = match &self.inside {
            Some(Inside::Ways(turns, remaining)) => {
                ways(turns, &mut lines);
                Some(*remaining)
            }
            _ => None,
        };
        if self.index != 1.0 {
            lines.extend(self.limits());
        }
        match &self.inside {
            None | Some(Inside::Ways(..)) => {}
            Some(Inside::Pane(why)) => lines.push(format!(
                "The mesh is not a solid, so it has no inside: what is seen is a pane, through which light goes straight. The \
                 reason: {why}."
            )),
            Some(Inside::Chance) => lines.push(
                "The body is rough: each ray takes a way of its own, by chance, and the picture is their mean.".to_owned(),
            ),
        }
        lines.extend(
            remaining.map(|light| format!("remains inside, not followed any further: {}", part(light))),
        );
        lines
    }

    /// Of light through a smooth body: the boundary at which most of it comes in, and the direction from which it does.
    #[must_use]
    pub fn main_way(&self) -> Option<(usize, Vec3)> {
        let Some(Inside::Ways(turns, _)) = &self.inside else { return None };
        let leaving = turns.iter().enumerate().filter_map(|(i, turn)| Some((i, turn.leaves?)));
        let most = leaving.max_by(|(_, (_, a)), (_, (_, b))| a.max_element().total_cmp(&b.max_element()));
        most.map(|(i, (way, _))| (i, way))
    }

    /// The direction of view and that from which most of the light through a body comes: why its picture may be upside
    /// down.
    fn crossing(&self) -> Option<String> {
        let (last, from) = self.main_way().filter(|_| self.index != 1.0)?;
        let look = -self.view;
        if look.dot(from) > STRAIGHT {
            return Some(
                "The light comes from straight ahead: what one face bends, the other bends back.".to_owned(),
            );
        }
        let bent = match (last, self.enters) {
            (0, Some(enters)) => twice(look, enters, from),
            _ => format!(
                "the ray is bent where it enters, is reflected inside {} and bent where it leaves.",
                plural(last, "time")
            ),
        };
        Some(format!("You look {}, and what you see there is {}: {bent}", elevation(look), elevation(from)))
    }

    /// The angles outside and inside.
    fn bent(&self) -> String {
        let [n, theta] = [self.index, self.incidence].map(number);
        match self.refracted {
            _ if self.index == 1.0 => "n = 1: the boundary neither bends nor reflects light.".to_owned(),
            Some(angle) => format!(
                "sin θ_r = n sin θ_t: θ_r = {theta}° outside, θ_t = {}° inside, n = {n}",
                number(angle)
            ),
            None => format!("θ_r = {theta}° is beyond the critical angle: everything is reflected, n = {n}"),
        }
    }

    /// The critical angle, and the part of the light that is reflected.
    fn limits(&self) -> [String; 2] {
        let Self { index, critical, reflectance, pane, .. } = self;
        let reflected = number(*reflectance);
        let side = if *index > 1.0 { "inside" } else { "outside" };
        let quotient = if *index > 1.0 { "1/n" } else { "n" };
        let critical = format!(
            "θ_c = asin {quotient} = {}°: light that meets the boundary from {side} at a larger angle is reflected completely",
            number(*critical)
        );
        let reflected = match pane {
            Some([back, through]) => format!(
                "F = {reflected}: the part of the light that one face reflects; both together reflect {} and let {} through",
                part(*back),
                part(*through)
            ),
            None if matches!(self.inside, Some(Inside::Ways(..) | Inside::Chance)) => format!(
                "F = {reflected}: the part of the light that is reflected here; the rest is seen through the surface"
            ),
            None => format!("F = {reflected}: the part of the light that one smooth face reflects"),
        };
        [critical, reflected]
    }
}

/// The two bends of a ray that goes straight through a body, and what follows if both are up or both down, past the horizon.
fn twice(look: Vec3, enters: Vec3, from: Vec3) -> String {
    let [bend, again] = [[look, enters], [enters, from]].map(|[before, after]| {
        let turn = height(after) - height(before);
        if turn.abs() < LEVEL {
            "aside"
        } else if turn < 0.0 {
            "down"
        } else {
            "up"
        }
    });
    if bend != again {
        return format!("the ray is bent {bend} where it enters and {again} where it leaves.");
    }
    let seen = match bend {
        "down" if look.y > 0.0 && from.y < 0.0 => {
            " So what is below is seen above: the picture is upside down."
        }
        "up" if look.y < 0.0 && from.y > 0.0 => {
            " So what is above is seen below: the picture is upside down."
        }
        _ => "",
    };
    format!("the ray is bent {bend} where it enters, and {bend} again where it leaves.{seen}")
}

/// The parts of the light that a smooth pane reflects and transmits, all orders together; `None` for other surfaces.
fn pane(surface: &dyn Surface, view: Vec3, frame: &Frame) -> Option<[Vec3; 2]> {
    let sharps = surface.sharp(view, frame);
    let of =
        |transmitted: bool| sharps.iter().find(|sharp| sharp.transmitted == transmitted).map(|s| s.share);
    Some([of(false)?, of(true)?])
}

/// The boundaries from inside, one by one.
fn ways(turns: &[Turn], lines: &mut Vec<String>) {
    let counts = |turn: &Turn| turn.leaves.is_none_or(|(_, part)| part.max_element() >= LEAST);
    let last =
        turns.iter().rposition(|turn| turn.leaves.is_some() && counts(turn)).map_or(0, |last| last + 1);
    let shown = last.clamp(1, LISTED).min(turns.len());
    for (i, turn) in turns[..shown].iter().enumerate() {
        lines.push(format!("{}: {}", i + 1, met(turn, i + 1)));
    }
    let rest = turns.len() - shown;
    if rest > 0 {
        let further: Vec3 = turns[shown..].iter().filter_map(|turn| Some(turn.leaves?.1)).sum();
        lines.push(format!("at {} more: {} in all", plural(rest, "turn"), part(further)));
    }
}

/// A part of the light: one number if red, green and blue are equal.
fn part(part: Vec3) -> String {
    let [r, g, b] = part.to_array().map(|c| rounded(c, 3));
    if r == g && g == b { r } else { format!("({r}, {g}, {b})") }
}

/// The events at a boundary, in words.
fn met(turn: &Turn, k: usize) -> String {
    let after = format!(
        "after {} m, at {}° from the normal inside, ",
        rounded(turn.length, 3),
        rounded(angle(turn.cosine), 3)
    );
    match turn.leaves {
        None => format!("{after}everything is reflected"),
        Some((direction, through)) => {
            let (part, from) = (part(through), triple(direction));
            format!("{after}w_{k} = {part} of the light from d_{k} = {from}, {}", elevation(direction))
        }
    }
}

/// The height of a direction above the horizon, degrees.
fn height(direction: Vec3) -> f32 {
    FRAC_PI_2.to_degrees() - angle(direction.y)
}

/// The height of a direction: `12.3° above the horizon`.
fn elevation(direction: Vec3) -> String {
    let height = height(direction);
    let side = if height < 0.0 { "below" } else { "above" };
    format!("{}° {side} the horizon", rounded(height.abs(), 3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        explain,
        parameter::Value,
        reference::Settings,
        registry::Registry,
        scene::{Object, Observer, Scene},
    };

    const SIZE: [u32; 2] = [101, 101];

    /// The refraction at a pixel of an object in front of the observer.
    fn refraction(
        object_type: &str,
        model: &str,
        values: &[(&'static str, f32)],
        pixel: [u32; 2],
    ) -> Option<Refraction> {
        let mut object = Object {
            object_type: object_type.to_owned(),
            position: Vec3::splat(5.0),
            size: 2.0,
            tessellation: Some(64),
            ..Object::default()
        };
        values.iter().for_each(|(name, value)| object.material.set(*name, Value::Number(*value)));
        let scene = Scene {
            reflection_model: model.to_owned(),
            shading_model: "phong".to_owned(),
            objects: vec![object],
            observer: Observer {
                field_of_view: 30.0,
                ..Observer::at(Vec3::new(5.0, 5.0, 10.0), Vec3::NEG_Z)
            },
            ..Scene::default()
        };
        let settings = Settings { width: SIZE[0], height: SIZE[1], ..Settings::default() };
        let explained =
            explain::pixel(&scene, &Registry::builtin(), &settings, pixel).expect("in the picture");
        explained.seen.expect("the object").spots[0].refraction.clone()
    }

    #[test]
    fn snells_angle_and_the_critical_angle_are_those_of_the_index() {
        for (model, n) in [("glass", 1.5f32), ("rough_dielectric", 1.33), ("thin_glass", 2.4)] {
            let found =
                refraction("sphere", model, &[("refractive_index", n)], [70, 40]).expect("it bends light");
            let sine = |degrees: f32| degrees.to_radians().sin();
            let inside = found.refracted.expect("from outside");
            assert!(
                found.incidence > 30.0 && (sine(found.incidence) - n * sine(inside)).abs() < 1e-5,
                "{found:?}"
            );
            assert!((n * sine(found.critical) - 1.0).abs() < 1e-5, "{found:?}");
            let lines = found.lines();
            let at = |start: &str| lines.iter().position(|line| line.starts_with(start)).expect("a line");
            let [bent, limit] = ["sin θ_r = n sin θ_t: θ_r = ", "θ_c = asin 1/n = "].map(at);
            assert!(lines[bent].contains("° inside, n = ") && bent < limit, "{lines:?}");
            assert!(
                lines[limit].contains("from inside at a larger angle is reflected completely"),
                "{lines:?}"
            );
        }
        assert_eq!(refraction("sphere", "phong", &[], [50, 50]), None);
        assert_eq!(refraction("sphere", "diffuse_transmission", &[], [50, 50]), None, "it scatters");
        let air = refraction("sphere", "glass", &[("refractive_index", 1.0)], [50, 50]).expect("it could");
        assert_eq!(air.lines()[0], "n = 1: the boundary neither bends nor reflects light.");
    }

    #[test]
    fn a_ball_shows_above_what_is_below_and_a_cube_face_what_is_behind_it() {
        let way = |object_type: &str, pixel| {
            let found = refraction(object_type, "glass", &[], pixel).expect("glass");
            let lines = found.lines();
            match found.inside {
                Some(Inside::Ways(turns, remaining)) => (turns, remaining, lines),
                other => panic!("{other:?}"),
            }
        };
        let (turns, remaining, lines) = way("sphere", [50, 30]);
        let (direction, through) = turns[0].leaves.expect("never totally reflected");
        assert!(direction.y < -0.1 && through.x > 0.85, "{turns:?}");
        // What answers why the picture is upside down comes first.
        assert!(
            lines[0].starts_with("You look ")
                && lines[0].contains("° above the horizon, and what you see there is ")
                && lines[0].ends_with(
                    "° below the horizon: the ray is bent down where it enters, and down again where it leaves. So what is \
                     below is seen above: the picture is upside down."
                ),
            "{lines:?}"
        );
        let (.., lower) = way("sphere", [50, 70]);
        assert!(
            lower[0].ends_with(
                "bent up where it enters, and up again where it leaves. So what is above is seen below: the picture is upside \
                 down."
            ),
            "{lower:?}"
        );
        // The wrong twin: a bubble, in which the picture is upright.
        let bubble = [("transmission_weight", 1.0), ("specular_ior", 1.0 / 1.5), ("roughness", 0.0)];
        let bubble = refraction("sphere", "openpbr", &bubble, [50, 40]).expect("a body").lines();
        assert!(
            bubble[0].ends_with("the ray is bent up where it enters, and up again where it leaves."),
            "{bubble:?}"
        );
        assert!(lines[2].starts_with("1: after ") && lines[2].ends_with("° below the horizon"), "{lines:?}");
        let limit = lines.iter().position(|line| line.starts_with("θ_c")).expect("a line");
        assert!(limit > 2 && lines[limit + 1].starts_with("F = "), "{lines:?}");
        assert!(way("sphere", [50, 70]).2[2].ends_with("° above the horizon"));
        assert!(
            remaining.x < 1e-6 && lines.last().is_some_and(|last| last.starts_with("remains inside")),
            "{lines:?}"
        );
        // Straight through the faces of a cube the line of sight goes on.
        let (turns, _, lines) = way("cube", [50, 45]);
        assert!(lines[0].starts_with("The light comes from straight ahead"), "{lines:?}");
        let (direction, _) = turns[0].leaves.expect("the back");
        assert!(direction.y > 0.0 && direction.z < -0.99, "{turns:?}");
    }

    #[test]
    fn open_and_rough_bodies_say_why_there_is_no_single_way() {
        let said = |object_type: &str, roughness: f32| {
            let found =
                refraction(object_type, "glass", &[("roughness", roughness)], [50, 50]).expect("glass");
            (found.inside.clone(), found.lines().pop().expect("lines"))
        };
        let (inside, line) = said("teapot", 0.0);
        assert!(matches!(inside, Some(Inside::Pane(_))), "{inside:?}");
        assert!(
            line.starts_with("The mesh is not a solid") && line.contains("The reason: it is open: "),
            "{line}"
        );
        let (inside, line) = said("sphere", 0.5);
        assert!(inside == Some(Inside::Chance) && line.starts_with("The body is rough"), "{line}");
    }
}
