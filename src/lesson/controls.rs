//! The controls that a lesson can highlight, and the parts of a scene that it can name.

use super::{problem::Problems, words::Piece};
use crate::{
    document::Selection,
    parameter::Parameter,
    registry::Registry,
    scene::{Display, Field, Light, Object, Observer, Scene, part::Structure as _},
    text::{did_you_mean, listed, nearest, plural, quoted},
};

/// A control of the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Control {
    /// The control of a parameter, by its name in scene files; also `exposure` and the other display
    /// settings.
    Knob(String),
    /// A menu of the window: one of [`MENUS`].
    Menu(String),
    /// Buttons of the window: one of [`BUTTONS`].
    Button(String),
    /// A tab of the strip below the picture: one of [`TABS`].
    Tab(String),
    /// A part in the list at the left.
    Part(PartName),
    /// A line of *Explain*, by the value that it gives: one of [`VALUES`].
    Line(String),
}

/// The menus of the window.
pub const MENUS: &[&str] = &["File", "Edit", "View", "Help"];
/// The buttons above the picture.
pub const BUTTONS: &[&str] = &["reflection", "shading", "terms"];
/// The tabs below the picture, by id.
pub const TABS: &[&str] = &["explain", "plots", "messages", "code"];
/// The values that lines of *Explain* give under *Through the surface*.
pub const VALUES: &[&str] = &["θ_r", "θ_t", "θ_c", "F", "w_1"];
/// Controls that do not belong to a declared parameter.
pub const KNOBS: &[&str] = &[
    "exposure",
    "tone_mapping",
    "encoding",
    "background",
    "background_colour",
    "background_bottom",
    "intensity",
    "luminous_flux",
    "colour",
    "colour_temperature",
    "size",
    "tessellation",
    "field_of_view",
];

/// A part of a scene as a lesson names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PartName {
    /// The room.
    Room,
    /// The observer.
    Observer,
    /// A light.
    Light(Which),
    /// An object.
    Object(Which),
}

/// One of several parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Which {
    /// By position in the list, from 1.
    Number(usize),
    /// By its name.
    Name(String),
}

impl Which {
    fn find(&self, names: &[Option<&str>]) -> Option<usize> {
        match self {
            Self::Number(number) => number.checked_sub(1).filter(|index| *index < names.len()),
            Self::Name(name) => names.iter().position(|known| *known == Some(name)),
        }
    }
}

/// The names of the lights of a scene, or of its objects.
fn names(scene: &Scene, of_lights: bool) -> Vec<Option<&str>> {
    if of_lights {
        scene.lights.iter().map(|light| light.name.as_deref()).collect()
    } else {
        scene.objects.iter().map(|object| object.name.as_deref()).collect()
    }
}

impl PartName {
    /// The part in a scene, if it exists.
    #[must_use]
    pub fn find(&self, scene: &Scene) -> Option<Selection> {
        match self {
            Self::Room => Some(Selection::Room),
            Self::Observer => Some(Selection::Observer),
            Self::Light(which) => which.find(&names(scene, true)).map(Selection::Light),
            Self::Object(which) => which.find(&names(scene, false)).map(Selection::Object),
        }
    }

    /// The parts of this kind in a scene, for messages.
    pub(super) fn known(&self, scene: &Scene) -> String {
        let of_lights = matches!(self, Self::Light(_));
        let all = names(scene, of_lights);
        let called: Vec<_> = all.iter().flatten().take(6).map(|name| quoted(name)).collect();
        let called = if called.is_empty() { String::new() } else { format!(", {}", listed(&called, "and")) };
        format!("the scene has {}{called}", plural(all.len(), if of_lights { "light" } else { "object" }))
    }

    /// Reads `room`, `observer`, `object 1`, `light "key light"`.
    pub(super) fn parse(piece: Piece) -> Result<Self, String> {
        let rule = "a part must be room, observer, object N or light N, with its number from 1 or its name in quotes";
        let (kind, which) = piece.text.split_once(char::is_whitespace).unwrap_or((piece.text, ""));
        let which = which.trim();
        let of = |make: fn(Which) -> Self| {
            let name = which.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
            match (name, which.parse()) {
                (Some(name), _) => Ok(make(Which::Name(name.to_owned()))),
                (None, Ok(number)) if number > 0 => Ok(make(Which::Number(number))),
                _ => Err(format!("this is {}, but {rule}", quoted(piece.text))),
            }
        };
        match kind {
            "room" if which.is_empty() => Ok(Self::Room),
            "observer" if which.is_empty() => Ok(Self::Observer),
            "light" => of(Self::Light),
            "object" => of(Self::Object),
            _ => Err(format!("this is {}, but {rule}", quoted(piece.text))),
        }
    }
}

/// The part of a scene with the most similar name to an unknown one, as it must be written.
pub(super) fn nearest_part(written: &str, scene: &Scene) -> Option<String> {
    let bare = match written.split_once(char::is_whitespace) {
        Some(("object" | "light", name)) => name.trim(),
        _ => written,
    };
    let bare = bare.trim_matches(['"', '“', '”', '\'', '‘', '’']);
    let parts = |kind: &'static str, of_lights: bool| {
        let names = names(scene, of_lights).into_iter().flatten();
        names.map(move |name| (name, format!("{kind} {}", quoted(name))))
    };
    let all: Vec<_> = parts("object", false).chain(parts("light", true)).collect();
    nearest(bare, all.iter().map(|(name, part)| (*name, part.as_str()))).map(str::to_owned)
}

/// All parameters: of materials, lights and shapes.
pub(super) fn parameters(registry: &Registry) -> impl Iterator<Item = &'static Parameter> {
    let lights = registry.lights().iter().flat_map(|entry| entry.parameters);
    let shapes = registry.shapes().iter().flat_map(|entry| entry.parameters);
    registry.material_parameters().chain(lights).chain(shapes)
}

/// The field of the display, the observer, a light or an object with a key.
pub(super) fn field(key: &str) -> Option<&'static Field> {
    let parts = [Display::FIELDS, Observer::FIELDS, Light::FIELDS, Object::FIELDS];
    parts.into_iter().flatten().copied().find(|field| field.key == key)
}

/// True for the knobs of the display, which exist whatever is selected.
pub(super) fn is_of_display(knob: &str) -> bool {
    Display::keys().contains(&knob)
}

/// The names of all knobs.
pub(super) fn knobs(registry: &Registry) -> Vec<&'static str> {
    parameters(registry).map(|p| p.name).chain(KNOBS.iter().copied()).collect()
}

/// Reads a line of a `point` block; a part is returned with its byte, to be looked up in the scene.
pub(super) fn control(
    key: Piece,
    value: Piece,
    registry: &Registry,
    problems: &mut Problems,
) -> Option<Control> {
    let mut one_of = |what: &str, known: &[&'static str]| {
        let found = known.iter().find(|known| **known == value.text).map(|known| (*known).to_owned());
        if found.is_none() {
            let near = did_you_mean(value.text, known.iter().map(|k| (*k, *k)));
            // There are too many parameters to name.
            let few = known.len() <= 12;
            let all = if few { format!("; it must be {}", listed(known, "or")) } else { String::new() };
            problems.at(value.at, format!("there is no {what} {}{all}{near}", quoted(value.text)));
        }
        found
    };
    match key.text {
        "knob" => one_of("knob", &knobs(registry)).map(Control::Knob),
        "menu" => one_of("menu", MENUS).map(Control::Menu),
        "button" => one_of("button", BUTTONS).map(Control::Button),
        "tab" => one_of("tab", TABS).map(Control::Tab),
        "line" => one_of("line", VALUES).map(Control::Line),
        "part" => match PartName::parse(value) {
            Ok(part) => Some(Control::Part(part)),
            Err(what) => {
                problems.at(value.at, what);
                None
            }
        },
        other => {
            let known = ["knob", "menu", "button", "tab", "part", "line"];
            let near = did_you_mean(other, known.iter().map(|k| (*k, *k)));
            let (other, known) = (quoted(other), listed(&known, "or"));
            problems.at(key.at, format!("a lesson cannot point at a {other}; it can point at {known}{near}"));
            None
        }
    }
}
