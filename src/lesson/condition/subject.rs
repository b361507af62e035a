//! The wording for quantities of conditions: names in a sentence, units, ranges.

use super::quantity::{Argument, Asked, Kind};
use crate::{
    lesson::{Situation, controls},
    parameter::{Parameter, limits::Limits},
    registry::Registry,
    scene::{Field, Scene},
    text::path::Segment,
};

/// The subject of a sentence about a quantity.
#[derive(Debug)]
pub(super) struct Subject {
    pub(super) name: String,
    /// Unit written after the numbers.
    pub(super) unit: &'static str,
}

/// The sentence for a Boolean quantity with this value, if it has a special one.
pub(super) fn truth(asked: &Asked, value: bool) -> Option<&'static str> {
    let said = asked.quantity.words[usize::from(value)];
    (asked.quantity.kind == Kind::Truth).then_some(said)
}

/// The minimum and maximum of a numeric quantity, if known.
pub(super) fn range(asked: &Asked, registry: &Registry) -> Option<[f64; 2]> {
    match &asked.argument {
        Argument::None | Argument::Angle(_) | Argument::Declared(_) => asked.quantity.range,
        Argument::Name(name) => parameter(name, registry).and_then(|p| p.kind.limits()).map(ends),
        Argument::Path(path) => match path.segments() {
            [Segment::Key(_), Segment::Key(count)] if count == "count" => Some([0.0, f64::INFINITY]),
            [.., Segment::Key(key), Segment::Index(_)] => {
                let parameter = || parameter(key, registry).and_then(|p| p.kind.limits());
                list_field(key).map(Field::limits).or_else(parameter).map(ends)
            }
            [.., Segment::Key(key)] => parameter(key, registry).and_then(|p| p.kind.limits()).map(ends),
            _ => None,
        },
    }
}

/// The ends of a range as people write them.
fn ends(range: Limits) -> [f64; 2] {
    let decimal = |v: f64| if range.whole { v } else { (v as f32).to_string().parse().unwrap_or(v) };
    [range.min, range.max].map(decimal)
}

/// The parameter with this name, of a material, a light or a shape.
pub(super) fn parameter(name: &str, registry: &Registry) -> Option<&'static Parameter> {
    controls::parameters(registry).find(|p| p.name == name)
}

/// The field of a part of a scene that has several numbers.
fn list_field(key: &str) -> Option<&'static Field> {
    controls::field(key).filter(|field| !field.kind.entries().is_empty())
}

/// The subject for sentences about a quantity.
pub(super) fn of(asked: &Asked, situation: &Situation) -> Subject {
    let registry = situation.registry;
    match &asked.argument {
        Argument::None | Argument::Angle(_) | Argument::Declared(_) => {
            let (mut name, unit) = match (asked.quantity.kind, asked.quantity.words) {
                (Kind::Number, [unit, name]) => (name.to_owned(), unit),
                _ => (asked.quantity.name.to_owned(), ""),
            };
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
            let of_parameter = || parameter(name, registry).map_or(&[][..], |p| p.kind.entries());
            let names = list_field(name).map_or_else(of_parameter, |field| field.kind.entries());
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
            "objects" => ("object", scene.objects.get(*i).map(|part| &part.name), scene.objects.len()),
            "lights" => ("light", scene.lights.get(*i).map(|part| &part.name), scene.lights.len()),
            _ => ("view", scene.variants.get(*i).map(|part| &part.name), 2),
        };
        let name = name.and_then(Option::as_deref);
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
            let unit = if p.kind.is_measured() { p.unit } else { "" };
            let name = match p.label {
                "" => plain(),
                label if label.replace(' ', "_") == p.name => format!("the {label}"),
                label if p.kind.is_number() && !p.symbol.is_empty() => format!("the {label} {}", p.symbol),
                label => format!("the {label}"),
            };
            Subject { name, unit }
        }
        None => {
            let field = controls::field(name).filter(|field| field.kind.is_measured());
            Subject { name: format!("the {}", plain()), unit: field.map_or("", |field| field.unit) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::condition::quantity::QUANTITIES;

    #[test]
    fn every_number_and_every_truth_has_words_of_its_own() {
        for quantity in QUANTITIES.iter() {
            let known = match quantity.kind {
                Kind::Number => {
                    quantity.range.is_some_and(|[least, most]| least < most) && !quantity.words[1].is_empty()
                }
                Kind::Truth => quantity.words.iter().all(|sentence| !sentence.is_empty()),
                Kind::Text | Kind::Various => true,
            };
            assert!(known, "{}", quantity.name);
        }
    }
}
