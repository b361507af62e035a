//! The quantities of conditions: one entry each, with the meaning and the calculation.

use std::sync::{Arc, LazyLock};

use super::{Value, probe, scene};
use crate::{
    channel::DebugChannel,
    curves::Kind as Plot,
    document::Selection,
    lesson::{Situation, controls, kind_of, state},
    matching::highlight_width,
    optics::{Frame, TermSelection, colour::luminance, geometry::direction},
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
    /// The name of a parameter that a model may declare.
    Declared(String),
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
    /// Minimum and maximum of numbers.
    pub(super) range: Option<[f64; 2]>,
    /// The unit of numbers and their name in a sentence, or the sentences for false and for true.
    pub(super) words: [&'static str; 2],
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

    /// The quantity as in a condition.
    pub(super) fn written(&self) -> String {
        match &self.argument {
            Argument::Path(path) => format!("scene.{path}"),
            Argument::Name(name) => format!("knob.{name}"),
            Argument::Angle(angle) => format!("curve.albedo({angle})"),
            Argument::Declared(name) => format!("code.declares.{name}"),
            Argument::None => self.quantity.name.to_owned(),
        }
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

/// The texts that a quantity may be, and its value in a situation.
type Answer = (fn(&Registry) -> Vec<&'static str>, fn(&Situation, &Argument) -> Result<Value, String>);

macro_rules! answers {
    ($($name:literal, $texts:expr, $value:expr;)*) => {
        const ANSWERS: &[(&str, Answer)] = &[$(($name, ($texts, $value))),*];
    };
}

answers! {
    "scene.PATH", free, |s, a| match a {
        Argument::Path(path) => scene::value(s.scene, path, s.registry),
        _ => Err("no path is given".to_owned()),
    };
    "window.selected", |_| vec!["room", "observer", "light", "object"], |s, _| text(kind_of(s.selection));
    "window.selected_index", free, |s, _| match s.selection {
        Selection::Light(i) | Selection::Object(i) => number((i + 1) as u32),
        _ => Err("no light and no object is selected".to_owned()),
    };
    "window.channel", |_| DebugChannel::ALL.map(DebugChannel::id).into_iter().chain(["none"]).collect(),
    |s, _| text(s.window.channel.map_or("none", DebugChannel::id));
    "window.terms", |_| TermSelection::ALL.map(TermSelection::id).to_vec(), |s, _| text(s.window.terms.id());
    "window.shows_term_alone", free, |s, _| Ok(Value::Truth(s.window.terms != TermSelection::All));
    "window.views", free, |s, _| number(s.window.views as u32);
    "window.active", |_| LETTERS.to_vec(),
    |s, _| text(LETTERS.get(s.window.active).copied().unwrap_or_default());
    "window.plots", |_| Plot::ALL.map(Plot::id).into_iter().chain(["off"]).collect(),
    |s, _| text(s.window.plots.map_or("off", Plot::id));
    "window.explain", free, |s, _| Ok(Value::Truth(s.window.explain));
    "window.presenting", free, |s, _| Ok(Value::Truth(s.window.presenting));
    "window.reflection_model", |r| r.models().iter().map(|m| m.declaration.id).collect(),
    |s, _| object(s).and_then(|object| text(s.scene.model_of(object)));
    "window.shading_model", |r| r.shading_models().iter().map(|m| m.declaration.id).collect(),
    |s, _| object(s).and_then(|object| text(s.scene.shading_model_of(object)));
    "knob.PARAMETER", free, |s, a| match a {
        Argument::Name(name) => knob(s, name),
        _ => Err("no parameter is given".to_owned()),
    };
    "code.open", free, |s, _| Ok(Value::Truth(s.window.code));
    "code.errors", free, |s, _| number(s.window.errors as u32);
    "code.custom", free, |s, _| model(s).map(|m| Value::Truth(s.registry.custom_file(m.declaration.id).is_some()));
    "code.declares.PARAMETER", free, |s, a| match a {
        Argument::Declared(name) => {
            model(s).map(|m| Value::Truth(m.parameters.iter().any(|p| p.name == *name)))
        }
        _ => Err("no parameter is given".to_owned()),
    };
    "probe.pinned", free, |s, _| Ok(Value::Truth(s.pinned));
    "probe.background", free, |s, _| probe::pinned(s).map(|e| Value::Truth(e.seen.is_none()));
    "probe.object", free, |s, _| probe::object(s).map(Value::Text);
    "probe.red", free, |s, _| probe::pinned(s).map(|e| Value::Number(e.code()[0].into()));
    "probe.green", free, |s, _| probe::pinned(s).map(|e| Value::Number(e.code()[1].into()));
    "probe.blue", free, |s, _| probe::pinned(s).map(|e| Value::Number(e.code()[2].into()));
    "probe.luminance", free, |s, _| probe::seen(s).and_then(|seen| number(luminance(seen.light)));
    "probe.n_dot_l", free, |s, _| probe::cosine(s, "N·L").map(Value::Number);
    "probe.n_dot_v", free, |s, _| probe::cosine(s, "N·V").map(Value::Number);
    "probe.n_dot_h", free, |s, _| probe::cosine(s, "N·H").map(Value::Number);
    "probe.angle_n_l", free, |s, _| probe::angle(s, "N·L").map(Value::Number);
    "probe.angle_n_v", free, |s, _| probe::angle(s, "N·V").map(Value::Number);
    "probe.angle_n_h", free, |s, _| probe::angle(s, "N·H").map(Value::Number);
    "probe.light_distance", free, |s, _| probe::light_distance(s).map(Value::Number);
    "probe.brightest_vertex", free, |s, _| probe::brightest_vertex(s).map(Value::Truth);
    "probe.is_highlight", free, |s, _| probe::is_highlight(s).map(Value::Truth);
    "probe.clipped", free, |s, _| probe::pinned(s).map(|e| Value::Truth(e.steps.mapped.max_element() > 1.0));
    "curve.highlight_width", free, |s, _| with_surface(s, |surface, _, name| {
        highlight_width(surface, INCIDENCE).ok_or_else(|| format!("{name} has no highlight"))
    });
    "curve.peak", free, |s, _| with_surface(s, |surface, _, _| Ok(peak(surface)));
    "curve.albedo(DEGREES)", free, |s, a| with_surface(s, |surface, _, _| match a {
        Argument::Angle(angle) => Ok(albedo(surface, &[*angle])),
        _ => Err("no angle is given".to_owned()),
    });
    "curve.largest_albedo", free, |s, _| with_surface(s, |surface, _, _| Ok(albedo(surface, &ANGLES)));
}

/// All quantities, in the order of the documentation.
pub static QUANTITIES: LazyLock<Vec<Quantity>> =
    LazyLock::new(|| include_str!("quantities.txt").lines().filter_map(Quantity::read).collect());

impl Quantity {
    /// A line of the table: the name and the type; for numbers the range, the unit and the words of a sentence; for
    /// what is true or false two sentences; and the meaning.
    fn read(line: &'static str) -> Option<Self> {
        let mut cells = line.split('|');
        let [name, kind, least, most, first, second, meaning] =
            std::array::from_fn(|_| cells.next().unwrap_or_default());
        let (_, (texts, value)) = *ANSWERS.iter().find(|(known, _)| *known == name)?;
        let kind = match kind {
            "number" => Kind::Number,
            "text" => Kind::Text,
            "truth" => Kind::Truth,
            _ => Kind::Various,
        };
        let range = least.parse().ok().zip(most.parse().ok()).map(|(least, most)| [least, most]);
        Some(Self { name, kind, meaning, range, words: [first, second], texts, value })
    }
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

/// The reflection model of the selected object.
fn model<'a>(s: &Situation<'a>) -> Result<&'a ModelEntry, String> {
    let id = s.scene.model_of(object(s)?);
    s.registry.model(id).ok_or_else(|| format!("the model {id} is not known"))
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
    let albedos = angles.iter().map(|angle| surface.directional_albedo(direction(*angle, 0.0)));
    albedos.map(|albedo| albedo.max_element()).fold(f64::NEG_INFINITY, f64::max)
}

/// The value of a parameter of the selected part.
fn knob(s: &Situation, name: &str) -> Result<Value, String> {
    if controls::is_of_display(name) {
        return scene::value(s.scene, &Path::root().key("display").key(name.to_owned()), s.registry);
    }
    let entry = |list: &'static str, i: usize| Path::root().key(list).index(i);
    let paths = match s.selection {
        Selection::Object(i) => vec![entry("objects", i), entry("objects", i).key("material")],
        Selection::Light(i) => vec![entry("lights", i)],
        Selection::Observer => vec![Path::root().key("observer")],
        Selection::Room => return Err("no object and no light is selected".to_owned()),
    };
    let held = |path: Path| scene::value(s.scene, &path.key(name.to_owned()), s.registry).ok();
    paths.into_iter().find_map(held).ok_or_else(|| format!("the selected part has no {name}"))
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
    if let Some(name) = word.strip_prefix("code.declares.") {
        return of("code.declares.PARAMETER", Argument::Declared(name.to_owned())).ok_or_else(unknown);
    }
    if let Some((name, angle)) = word.split_once('(') {
        if name != "curve.albedo" {
            return Err(unknown());
        }
        let written = angle.trim_end_matches(')').trim().trim_end_matches('°').trim();
        return match written.parse::<f64>() {
            Ok(angle) if (0.0..90.0).contains(&angle) => {
                of("curve.albedo(DEGREES)", Argument::Angle(angle)).ok_or_else(unknown)
            }
            _ => {
                let rule = "it must be at least 0° and less than 90°";
                Err((name.len() + 1, format!("the angle is {}, but {rule}", quoted(written))))
            }
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

/// The type for comparisons of a value whose numbers have these names if it has several; `None` for those.
pub(super) fn type_of(entries: &[&str], is_text: bool, is_flag: bool) -> Option<Kind> {
    match (entries, is_text, is_flag) {
        ([], true, _) => Some(Kind::Text),
        ([], _, true) => Some(Kind::Truth),
        ([], ..) => Some(Kind::Number),
        _ => None,
    }
}
