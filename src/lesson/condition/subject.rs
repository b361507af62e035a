//! The wording for quantities of conditions: names in a sentence, units, ranges.

use super::quantity::{Argument, Asked};
use crate::{
    lesson::Situation,
    parameter::{Parameter, ParameterKind},
    registry::Registry,
    scene::Scene,
    text::path::Segment,
};

/// The subject of a sentence about a quantity.
#[derive(Debug)]
pub(super) struct Subject {
    pub(super) name: String,
    /// Unit written after the numbers.
    pub(super) unit: &'static str,
}

/// The names of the entries of colours and of positions.
const RGB: [&str; 3] = ["red", "green", "blue"];
const XYZ: [&str; 3] = ["x", "y", "z"];

/// Name in a sentence, unit, minimum and maximum of the numeric quantities.
const NUMBERS: &[(&str, &str, &str, [f64; 2])] = &[
    ("window.selected_index", "the number of the selected part", "", [1.0, f64::INFINITY]),
    ("window.views", "the number of views", "", [1.0, 4.0]),
    ("probe.red", "the code of red", "", [0.0, 255.0]),
    ("probe.green", "the code of green", "", [0.0, 255.0]),
    ("probe.blue", "the code of blue", "", [0.0, 255.0]),
    ("probe.luminance", "the luminance", "", [0.0, f64::INFINITY]),
    ("probe.n_dot_l", "N·L", "", [-1.0, 1.0]),
    ("probe.n_dot_v", "N·V", "", [-1.0, 1.0]),
    ("probe.n_dot_h", "N·H", "", [-1.0, 1.0]),
    ("probe.angle_n_l", "the angle between N and L", "°", [0.0, 180.0]),
    ("probe.angle_n_v", "the angle between N and V", "°", [0.0, 180.0]),
    ("probe.angle_n_h", "the angle between N and H", "°", [0.0, 180.0]),
    ("probe.light_distance", "the distance to the light", "m", [0.0, f64::INFINITY]),
    ("curve.highlight_width", "the width of the highlight", "°", [0.0, 180.0]),
    ("curve.peak", "the peak of the specular response", "", [0.0, f64::INFINITY]),
    ("curve.albedo(DEGREES)", "the albedo", "", [0.0, f64::INFINITY]),
    ("curve.largest_albedo", "the largest albedo", "", [0.0, f64::INFINITY]),
];

/// Sentences for Boolean quantities: one for false, one for true.
const TRUTHS: &[(&str, &str, &str)] = &[
    ("window.shows_term_alone", "all terms are shown", "one term is shown alone"),
    ("window.explain", "the panel Explain is closed", "the panel Explain is open"),
    ("window.presenting", "the picture is not presented", "the picture is presented"),
    ("probe.pinned", "nothing is pinned", "a pixel is pinned"),
    ("probe.background", "the pinned pixel shows an object", "there is no object at the pinned pixel"),
    (
        "probe.brightest_vertex",
        "the pinned pixel is not near the brightest vertex",
        "the pinned pixel is near the brightest vertex",
    ),
    (
        "probe.is_highlight",
        "the specular term is not brighter than the diffuse one at the pinned pixel",
        "the specular term is brighter than the diffuse one at the pinned pixel",
    ),
    ("probe.clipped", "the pinned pixel is not clipped", "the pinned pixel is clipped"),
];

/// The sentence for a Boolean quantity with this value, if it has a special one.
pub(super) fn truth(asked: &Asked, value: bool) -> Option<&'static str> {
    let found = TRUTHS.iter().find(|(name, ..)| *name == asked.quantity.name);
    found.map(|(_, not, is)| if value { *is } else { *not })
}

/// The minimum and maximum of a numeric quantity, if known.
pub(super) fn range(asked: &Asked, registry: &Registry) -> Option<[f64; 2]> {
    match &asked.argument {
        Argument::None | Argument::Angle(_) => {
            NUMBERS.iter().find(|(name, ..)| *name == asked.quantity.name).map(|(.., range)| *range)
        }
        Argument::Name(name) => parameter(name, registry).and_then(|p| of_kind(&p.kind)),
        Argument::Path(path) => match path.segments() {
            [Segment::Key(_), Segment::Key(count)] if count == "count" => Some([0.0, f64::INFINITY]),
            [.., Segment::Key(key), Segment::Index(0..3)] if key == "colour" => Some([0.0, 255.0]),
            [.., Segment::Key(key)] | [.., Segment::Key(key), Segment::Index(0..3)] => {
                parameter(key, registry).and_then(|p| of_kind(&p.kind))
            }
            _ => None,
        },
    }
}

/// The range of a parameter's numbers.
fn of_kind(kind: &ParameterKind) -> Option<[f64; 2]> {
    let decimal = |v: f32| v.to_string().parse().unwrap_or_else(|_| f64::from(v));
    match kind {
        ParameterKind::Number { min, max, .. } | ParameterKind::Triple { min, max, .. } => {
            Some([decimal(*min), decimal(*max)])
        }
        ParameterKind::Integer { min, max, .. } => {
            Some([*min as f64, max.map_or(f64::INFINITY, |max| max as f64)])
        }
        ParameterKind::Colour { .. } => Some([0.0, 255.0]),
        ParameterKind::Choice { .. } | ParameterKind::File { .. } => None,
    }
}

/// The parameter with this name, of a material, a light or a shape.
fn parameter<'r>(name: &str, registry: &'r Registry) -> Option<&'r Parameter> {
    let lights = registry.lights().iter().flat_map(|entry| entry.parameters);
    let shapes = registry.shapes().iter().flat_map(|entry| entry.parameters);
    registry.material_parameters().chain(lights).chain(shapes).find(|p| p.name == name)
}

/// The subject for sentences about a quantity.
pub(super) fn of(asked: &Asked, situation: &Situation) -> Subject {
    let registry = situation.registry;
    match &asked.argument {
        Argument::None | Argument::Angle(_) => {
            let known = NUMBERS.iter().find(|(name, ..)| *name == asked.quantity.name);
            let (mut name, unit) = known
                .map_or((asked.quantity.name.to_owned(), ""), |(_, name, unit, _)| {
                    ((*name).to_owned(), *unit)
                });
            if let Argument::Angle(angle) = asked.argument {
                name = format!("{name} at {angle}°");
            }
            Subject { name, unit }
        }
        Argument::Name(name) => key(name, registry),
        Argument::Path(path) => of_path(path.segments(), situation.scene, registry),
    }
}

/// A value of the scene by the last words of its path, and its part of the scene if there are several.
fn of_path(path: &[Segment], scene: &Scene, registry: &Registry) -> Subject {
    let mut subject = match path {
        [Segment::Key(list), Segment::Key(count)] if count == "count" => {
            Subject { name: format!("the number of {list}"), unit: "" }
        }
        [.., Segment::Key(name), Segment::Index(i)] => {
            let is_colour = name == "colour"
                || parameter(name, registry).is_some_and(|p| {
                    matches!(p.kind, ParameterKind::Colour { .. } | ParameterKind::Triple { .. })
                });
            let names = if is_colour { RGB } else { XYZ };
            let whole = key(name, registry);
            let whole_name =
                if whole.name.starts_with("the ") { whole.name } else { format!("the {}", whole.name) };
            match names.get(*i) {
                Some(entry) => Subject { name: format!("{entry} of {whole_name}"), ..whole },
                None => Subject { name: format!("entry {i} of {whole_name}"), ..whole },
            }
        }
        [.., Segment::Key(name)] => key(name, registry),
        _ => Subject { name: "the value".to_owned(), unit: "" },
    };
    if let [Segment::Key(list), Segment::Index(i), _, ..] = path {
        let (word, name, count) = match list.as_ref() {
            "objects" => {
                ("object", scene.objects.get(*i).and_then(|part| part.name.as_deref()), scene.objects.len())
            }
            "lights" => {
                ("light", scene.lights.get(*i).and_then(|part| part.name.as_deref()), scene.lights.len())
            }
            _ => ("view", scene.variants.get(*i).and_then(|part| part.name.as_deref()), 2),
        };
        if count > 1 {
            let part = name.map_or_else(|| format!("{word} {}", i + 1), |name| format!("“{name}”"));
            subject.name = format!("{} of {part}", subject.name);
        }
    }
    subject
}

/// A key of scene files, or a parameter name.
fn key(name: &str, registry: &Registry) -> Subject {
    let plain = || name.replace('_', " ");
    match parameter(name, registry) {
        Some(p) => {
            // Codes of a colour have no unit, and a word that is its own label needs no symbol.
            let unit = if p.unit == "sRGB" { "" } else { p.unit };
            let is_number = matches!(p.kind, ParameterKind::Number { .. } | ParameterKind::Integer { .. });
            let name = match p.label {
                "" => plain(),
                label if label.replace(' ', "_") == p.name => format!("the {label}"),
                label if is_number && !p.symbol.is_empty() => format!("the {label} {}", p.symbol),
                label => format!("the {label}"),
            };
            Subject { name, unit }
        }
        None => {
            let unit = match name {
                "exposure" => "EV",
                "colour_temperature" => "K",
                "luminous_flux" => "lm",
                "field_of_view" => "°",
                _ => "",
            };
            Subject { name: format!("the {}", plain()), unit }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::condition::quantity::{Kind, QUANTITIES};

    #[test]
    fn every_number_and_every_truth_has_words_of_its_own() {
        for quantity in QUANTITIES {
            let known = match quantity.kind {
                Kind::Number => NUMBERS.iter().any(|(name, ..)| *name == quantity.name),
                Kind::Truth => TRUTHS.iter().any(|(name, ..)| *name == quantity.name),
                Kind::Text | Kind::Various => true,
            };
            assert!(known, "{}", quantity.name);
        }
        for (name, .., [least, most]) in NUMBERS {
            assert!(least < most && QUANTITIES.iter().any(|q| q.name == *name), "{name}");
        }
    }
}
