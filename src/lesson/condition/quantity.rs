//! The quantities of conditions: one entry each, with the meaning and the calculation.

use std::sync::Arc;

use super::{Value, probe, scene};
use crate::{
    channel::DebugChannel,
    curves::Kind as Plot,
    document::Selection,
    lesson::{Situation, kind_of, state},
    matching::highlight_width,
    optics::{Frame, TermSelection, albedo::directional_in_batches, colour::luminance, geometry::direction},
    parameter::ParameterKind,
    reflection::{ModelEntry, Surface},
    registry::Registry,
    scene::{Scene, error::Path, variant::LETTERS},
    text::{did_you_mean, quoted},
};

/// The type of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A number.
    Number,
    /// A text.
    Text,
    /// True or false.
    Truth,
    /// The type of the value in the scene, or of the parameter.
    Various,
}

impl Kind {
    /// The display name of the type.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Text => "text",
            Self::Truth => "true or false",
            Self::Various => "its own",
        }
    }
}

/// The argument of a quantity.
#[derive(Debug, PartialEq)]
pub(super) enum Argument {
    None,
    /// A path in the scene.
    Path(Path),
    /// The name of a parameter.
    Name(String),
    /// An angle in degrees.
    Angle(f64),
}

/// A quantity that conditions compare.
#[derive(Debug)]
pub struct Quantity {
    /// Name; words in capitals are placeholders.
    pub name: &'static str,
    /// Type of the value.
    pub kind: Kind,
    /// Meaning, with its unit.
    pub meaning: &'static str,
    /// Possible texts, if there are few.
    pub(super) texts: fn(&Registry) -> Vec<&'static str>,
    value: fn(&Situation, &Argument) -> Result<Value, String>,
}

/// A quantity in a condition.
#[derive(Debug)]
pub(super) struct Asked {
    pub(super) quantity: &'static Quantity,
    pub(super) argument: Argument,
}

impl Asked {
    /// The value of the quantity, or the reason why it has none.
    pub(super) fn value(&self, situation: &Situation) -> Result<Value, String> {
        (self.quantity.value)(situation, &self.argument)
    }

    /// The part of the name before the first dot.
    pub(super) fn group(&self) -> &'static str {
        self.quantity.name.split('.').next().unwrap_or_default()
    }
}

fn free(_: &Registry) -> Vec<&'static str> {
    Vec::new()
}

fn text(text: &str) -> Result<Value, String> {
    Ok(Value::Text(text.to_owned()))
}

fn number(number: impl Into<f64>) -> Result<Value, String> {
    Ok(Value::Number(number.into()))
}

macro_rules! quantities {
    ($($name:literal, $kind:ident, $texts:expr, $meaning:literal, $value:expr;)*) => {
        /// All quantities, in the order of the documentation.
        pub const QUANTITIES: &[Quantity] = &[$(Quantity {
            name: $name,
            kind: Kind::$kind,
            meaning: $meaning,
            texts: $texts,
            value: $value,
        }),*];
    };
}

quantities! {
    "scene.PATH", Various, free,
    "the value in the scene, by its path in the scene file; defaults are filled in, and overrides of the active view; `scene.lights.count`, `scene.objects.count` and `scene.variants.count` are numbers of parts",
    |s, a| match a {
        Argument::Path(path) => scene::value(s.scene, path, s.registry),
        _ => Err("no path is given".to_owned()),
    };
    "window.selected", Text, |_| vec!["room", "observer", "light", "object"],
    "the kind of the selected part: `\"room\"`, `\"observer\"`, `\"light\"` or `\"object\"`",
    |s, _| text(kind_of(s.selection));
    "window.selected_index", Number, free, "the number of the selected light or object, from 1",
    |s, _| match s.selection {
        Selection::Light(i) | Selection::Object(i) => number((i + 1) as u32),
        _ => Err("no light and no object is selected".to_owned()),
    };
    "window.channel", Text, |_| DebugChannel::ALL.map(DebugChannel::id).into_iter().chain(["none"]).collect(),
    "the debug channel of the active view by its id, or `\"none\"`",
    |s, _| text(s.window.channel.map_or("none", DebugChannel::id));
    "window.terms", Text, |_| TermSelection::ALL.map(TermSelection::id).to_vec(),
    "the terms that are shown: `\"all\"`, `\"ambient\"`, `\"diffuse\"` or `\"specular\"`",
    |s, _| text(s.window.terms.id());
    "window.shows_term_alone", Truth, free, "true if one term is shown alone",
    |s, _| Ok(Value::Truth(s.window.terms != TermSelection::All));
    "window.views", Number, free, "the number of views, 1 to 4", |s, _| number(s.window.views as u32);
    "window.active", Text, |_| LETTERS.to_vec(), "the letter of the active view: `\"A\"` to `\"D\"`",
    |s, _| text(LETTERS.get(s.window.active).copied().unwrap_or_default());
    "window.plots", Text, |_| Plot::ALL.map(Plot::id).into_iter().chain(["off"]).collect(),
    "the plot that is shown by its id, or `\"off\"`",
    |s, _| text(s.window.plots.map_or("off", Plot::id));
    "window.explain", Truth, free, "true if the panel *Explain* is open", |s, _| Ok(Value::Truth(s.window.explain));
    "window.presenting", Truth, free, "true while the picture is presented",
    |s, _| Ok(Value::Truth(s.window.presenting));
    "window.reflection_model", Text, |r| r.models().iter().map(|m| m.declaration.id).collect(),
    "the id of the reflection model of the selected object in the active view",
    |s, _| object(s).and_then(|object| text(s.scene.model_of(object)));
    "window.shading_model", Text, |r| r.shading_models().iter().map(|m| m.declaration.id).collect(),
    "the id of the shading model of the selected object in the active view",
    |s, _| object(s).and_then(|object| text(s.scene.shading_model_of(object)));
    "knob.PARAMETER", Various, free,
    "the parameter of the selected object or light, by its name in scene files; `knob.exposure` is that of the picture, in EV",
    |s, a| match a {
        Argument::Name(name) => knob(s, name),
        _ => Err("no parameter is given".to_owned()),
    };
    "probe.pinned", Truth, free, "true if a pixel is pinned", |s, _| Ok(Value::Truth(s.pinned));
    "probe.background", Truth, free, "true if there is no object at the pinned pixel",
    |s, _| probe::pinned(s).map(|e| Value::Truth(e.seen.is_none()));
    "probe.object", Text, free, "the name of the object at the pinned pixel; `\"object 2\"` for one without a name",
    |s, _| probe::object(s).map(Value::Text);
    "probe.red", Number, free, "the code of red of the pinned pixel, 0 to 255",
    |s, _| probe::pinned(s).map(|e| Value::Number(e.code()[0].into()));
    "probe.green", Number, free, "the code of green", |s, _| probe::pinned(s).map(|e| Value::Number(e.code()[1].into()));
    "probe.blue", Number, free, "the code of blue", |s, _| probe::pinned(s).map(|e| Value::Number(e.code()[2].into()));
    "probe.luminance", Number, free, "the luminance of the light at the pinned pixel before exposure",
    |s, _| probe::seen(s).and_then(|seen| number(luminance(seen.light)));
    "probe.n_dot_l", Number, free, "N·L at the point seen at the pinned pixel, for the light that is brightest there",
    |s, _| probe::cosine(s, "N·L").map(Value::Number);
    "probe.n_dot_v", Number, free, "N·V there", |s, _| probe::cosine(s, "N·V").map(Value::Number);
    "probe.n_dot_h", Number, free, "N·H there, for the light that is brightest there",
    |s, _| probe::cosine(s, "N·H").map(Value::Number);
    "probe.angle_n_l", Number, free, "the angle between N and L there, degrees",
    |s, _| probe::angle(s, "N·L").map(Value::Number);
    "probe.angle_n_v", Number, free, "the angle between N and V there, degrees",
    |s, _| probe::angle(s, "N·V").map(Value::Number);
    "probe.angle_n_h", Number, free, "the angle between N and H there, degrees",
    |s, _| probe::angle(s, "N·H").map(Value::Number);
    "probe.light_distance", Number, free, "the distance to the light that is brightest there, metres",
    |s, _| probe::light_distance(s).map(Value::Number);
    "probe.brightest_vertex", Truth, free,
    "Gouraud shading: true if the pinned pixel is near the brightest of the vertices that face the observer (its weight in the pixel is 0.6 or more)",
    |s, _| probe::brightest_vertex(s).map(Value::Truth);
    "probe.is_highlight", Truth, free, "true if the specular term is brighter than the diffuse one at the pinned pixel",
    |s, _| probe::is_highlight(s).map(Value::Truth);
    "probe.clipped", Truth, free, "true if the display cuts off red, green or blue of the pinned pixel at its upper end",
    |s, _| probe::pinned(s).map(|e| Value::Truth(e.steps.mapped.max_element() > 1.0));
    "curve.highlight_width", Number, free,
    "degrees: the full width of the specular term at half its maximum, over the angle θ_o of the viewer in the plane of incidence, for light at θ_i = 30°; a side that does not fall to half ends at the horizon",
    |s, _| with_surface(s, |surface, _, name| {
        highlight_width(surface, INCIDENCE).ok_or_else(|| format!("{name} has no highlight"))
    });
    "curve.peak", Number, free, "the largest specular response π f cos θ_i in the plane of incidence, for light at θ_i = 30°",
    |s, _| with_surface(s, |surface, _, _| Ok(peak(surface)));
    "curve.albedo(DEGREES)", Number, free,
    "the directional albedo for a viewer at that angle from the normal: the largest of red, green and blue",
    |s, a| with_surface(s, |surface, _, _| match a {
        Argument::Angle(angle) => Ok(albedo(surface, &[*angle])),
        _ => Err("no angle is given".to_owned()),
    });
    "curve.largest_albedo", Number, free,
    "the largest directional albedo of red, green and blue for viewers at 0°, 15°, 30°, 45°, 60°, 70°, 80° and 85° from the normal",
    |s, _| with_surface(s, |surface, _, _| Ok(albedo(surface, &ANGLES)));
}

/// Angle of the light in the curves of conditions, in degrees.
const INCIDENCE: f64 = 30.0;
/// Angles of the viewer for the largest albedo, in degrees.
const ANGLES: [f64; 8] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0];

/// The selected object.
fn object<'a>(s: &Situation<'a>) -> Result<&'a crate::scene::Object, String> {
    let scene: &'a Scene = s.scene;
    match s.selection {
        Selection::Object(i) => scene.objects.get(i).ok_or_else(|| "no object is selected".to_owned()),
        _ => Err("no object is selected".to_owned()),
    }
}

fn with_surface(
    s: &Situation,
    value: impl FnOnce(&dyn Surface, &ModelEntry, &str) -> Result<f64, String>,
) -> Result<Value, String> {
    let object = object(s)?;
    let id = s.scene.model_of(object);
    let entry = s.registry.model(id).ok_or_else(|| format!("the model {id} is not known"))?;
    let name = entry.declaration.name;
    if let Some(why) = entry.not_on_cpu() {
        return Err(format!("the CPU cannot run {name}: {why}"));
    }
    let surface: Arc<dyn Surface> = entry.instantiate(&object.material, s.scene.display.encoding);
    value(&*surface, entry, name).and_then(|value| {
        if value.is_finite() { number(value) } else { Err(format!("the curve of {name} is not a number")) }
    })
}

/// The largest specular response in the plane of incidence.
fn peak(surface: &dyn Surface) -> f64 {
    let l = direction(INCIDENCE, 180.0);
    (-899..=899)
        .map(|tenth| {
            let angle = f64::from(tenth) / 10.0;
            let v = direction(angle.abs(), if angle < 0.0 { 180.0 } else { 0.0 });
            f64::from(luminance(surface.response(l, v, &Frame::LOCAL).specular))
        })
        .fold(0.0, f64::max)
}

/// The largest directional albedo over the colour channels and these viewing angles.
fn albedo(surface: &dyn Surface, angles: &[f64]) -> f64 {
    let views: Vec<_> = angles.iter().map(|angle| direction(*angle, 0.0)).collect();
    let integrated = directional_in_batches(&views, |pairs| {
        Ok::<_, std::convert::Infallible>(
            pairs.iter().map(|(l, v)| surface.response(*l, *v, &Frame::LOCAL)).collect(),
        )
    });
    let Ok(albedos) = integrated;
    albedos.iter().map(|albedo| albedo.max_element()).fold(f64::NEG_INFINITY, f64::max)
}

/// Parameters of the display, which exist whatever is selected.
pub(super) const DISPLAY: [&str; 3] = ["exposure", "tone_mapping", "encoding"];

/// The value of a parameter of the selected part.
fn knob(s: &Situation, name: &str) -> Result<Value, String> {
    if DISPLAY.contains(&name) {
        return scene::value(s.scene, &Path::root().key("display").key(name.to_owned()), s.registry);
    }
    let path = |list: &'static str, i: usize| Path::root().key(list).index(i);
    let found = match s.selection {
        Selection::Object(i) => {
            let own = scene::value(s.scene, &path("objects", i).key(name.to_owned()), s.registry);
            own.or_else(|_| {
                scene::value(s.scene, &path("objects", i).key("material").key(name.to_owned()), s.registry)
            })
        }
        Selection::Light(i) => scene::value(s.scene, &path("lights", i).key(name.to_owned()), s.registry),
        Selection::Observer => {
            scene::value(s.scene, &Path::root().key("observer").key(name.to_owned()), s.registry)
        }
        Selection::Room => return Err("no object and no light is selected".to_owned()),
    };
    found.map_err(|_| format!("the selected part has no {name}"))
}

/// The quantity of a word in a condition, or the byte of a mistake in the word, and a sentence.
pub(super) fn asked(word: &str) -> Result<Asked, (usize, String)> {
    let find = |name: &str| QUANTITIES.iter().find(|q| q.name == name);
    let of = |name: &str, argument| find(name).map(|quantity| Asked { quantity, argument });
    let unknown = || {
        let names = QUANTITIES.iter().map(|q| q.name).filter(|name| !name.contains(char::is_uppercase));
        let near = did_you_mean(word, names.chain(["curve.albedo(30)"]).map(|n| (n, n)));
        let quote = if word.contains('.') { "" } else { "; text needs double quotes, as in \"phong\"" };
        (0, format!("there is no quantity {}{quote}{near}", quoted(word)))
    };
    if let Some(path) = word.strip_prefix("scene.") {
        let path = state::path(path).map_err(|(at, what)| ("scene.".len() + at, what))?;
        if path.segments().is_empty() {
            return Err((0, "the path is missing, as in scene.objects[0].size".to_owned()));
        }
        return of("scene.PATH", Argument::Path(path)).ok_or_else(unknown);
    }
    if let Some(name) = word.strip_prefix("knob.") {
        return of("knob.PARAMETER", Argument::Name(name.to_owned())).ok_or_else(unknown);
    }
    if let Some((name, angle)) = word.split_once('(') {
        if name != "curve.albedo" {
            return Err(unknown());
        }
        let written = angle.trim_end_matches(')').trim().trim_end_matches('°').trim();
        let at = name.len() + 1;
        return match written.parse::<f64>() {
            Ok(angle) if (0.0..90.0).contains(&angle) => {
                of("curve.albedo(DEGREES)", Argument::Angle(angle)).ok_or_else(unknown)
            }
            _ => Err((
                at,
                format!("the angle is {}, but it must be at least 0° and less than 90°", quoted(written)),
            )),
        };
    }
    if word == "curve.albedo" {
        return Err((0, "the angle of the viewer is missing, as in curve.albedo(30)".to_owned()));
    }
    match find(word) {
        Some(_) => of(word, Argument::None).ok_or_else(unknown),
        None => Err(unknown()),
    }
}

/// The type of a parameter for comparisons; `None` for those with several numbers.
pub(super) fn kind_of_parameter(kind: &ParameterKind) -> Option<Kind> {
    match kind {
        ParameterKind::Number { .. } | ParameterKind::Integer { .. } => Some(Kind::Number),
        ParameterKind::Choice { .. } if kind.is_flag() => Some(Kind::Truth),
        ParameterKind::Choice { .. } | ParameterKind::File { .. } => Some(Kind::Text),
        ParameterKind::Colour { .. } | ParameterKind::Triple { .. } => None,
    }
}
