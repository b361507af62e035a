//! A scene.

use std::{
    path::Path,
    sync::{Arc, atomic::AtomicBool},
};

use lights_camera_models::{
    channel::{DebugChannel, Setting},
    compare::{Shown, Undrawn, View},
    explain,
    matching::{self, MatchError, Measure, Metric, Request, What, match_view},
    optics::TermSelection,
    progress::Progress,
    reference::{self, Settings, Until},
    registry::Registry,
    scene::{
        SceneIn,
        at::{Declared, Place},
        field::Kind,
        load::{Defaults, in_folder},
        variant::LETTERS,
    },
    text::{did_you_mean, shortened},
};
use numpy::PyArray1;
use pyo3::{
    exceptions::{PyMemoryError, PyValueError},
    prelude::*,
};

use crate::{errors, known, work};

/// Bytes of memory for each pixel of a picture, without its light and with it.
const SHOWN: usize = 3;
const LIT: usize = 60;

/// A checked scene, with what was known when it was read.
#[pyclass(frozen, module = "lights_camera_models._lcm")]
pub struct Scene {
    scene: lights_camera_models::scene::Scene,
    pub(crate) registry: Arc<Registry>,
}

/// A view with a size, and what is shown of it.
pub struct Wanted<'a> {
    pub size: [u32; 2],
    pub samples: u32,
    pub view: &'a str,
    pub terms: &'a str,
    pub channel: Option<&'a str>,
    pub until: Until,
}

#[pymethods]
impl Scene {
    /// Reads a scene from JSON. The files that it names are in the folder; its name is empty if it is not a file. Texts stand
    /// for custom models in place of the known ones.
    #[new]
    #[pyo3(signature = (json, name, folder, use_defaults, custom = Vec::new()))]
    fn new(
        py: Python<'_>,
        json: &str,
        name: &str,
        folder: &str,
        use_defaults: bool,
        custom: Vec<(String, String)>,
    ) -> PyResult<Self> {
        let registry = known::with(py, &custom)?;
        let defaults = if use_defaults { Defaults::Use } else { Defaults::Refuse };
        let read = || in_folder(json.as_bytes(), (name, Path::new(folder)), &registry, defaults);
        let scene =
            work::long(py, |_| read())?.map_err(|error| errors::scene(&error, !name.is_empty()))?.scene;
        Ok(Self { scene, registry })
    }

    /// The default scene.
    #[staticmethod]
    fn default() -> Self {
        Self { scene: lights_camera_models::scene::Scene::default(), registry: known::registry() }
    }

    /// True if the scene names files.
    fn names_files(&self) -> bool {
        self.scene.files().next().is_some()
    }

    /// The custom models of the scene, with their texts.
    fn custom(&self) -> Vec<(String, String)> {
        let text = |id: &str| Some((id.to_owned(), known::text_of(&self.registry, id)?));
        self.scene.models().into_iter().filter_map(text).collect()
    }

    /// The scene as JSON.
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&SceneIn(&self.scene, &self.registry)).map_err(|e| crate::bug(&e.to_string()))
    }

    /// The value at a path, as JSON.
    fn value(&self, path: &str) -> PyResult<String> {
        let place =
            Place::find(path, &self.scene, &self.registry).map_err(|why| errors::value(path, &why))?;
        let value = place.value(&self.scene);
        Ok(value.map_or(serde_json::Value::Null, |value| value.json()).to_string())
    }

    /// The scene with other values at some paths, as JSON.
    fn with_values(&self, values: Vec<(String, String)>) -> PyResult<Self> {
        let (mut all, mut problems) = (Vec::new(), Vec::new());
        for (path, written) in &values {
            let json: serde_json::Value = serde_json::from_str(written).unwrap_or_default();
            let read = Place::find(path, &self.scene, &self.registry).and_then(|place| {
                let text = text_of(&place, &json)?;
                Ok((place.read(&text, &self.registry)?, place))
            });
            match read {
                Ok(one) => all.push(one),
                Err(why) => problems.push((path.as_str(), why)),
            }
        }
        if !problems.is_empty() {
            return Err(errors::each(&problems));
        }
        let scene = self.scene.with(all.iter().map(|(value, place)| (place, value)), &self.registry);
        Ok(Self { scene: scene.map_err(errors::values)?, registry: self.registry.clone() })
    }

    /// The number of views.
    fn views(&self) -> usize {
        1 + self.scene.variants.len()
    }

    /// Display codes: red, green, blue, row by row.
    #[pyo3(signature = (size, samples, view, terms, channel, light_samples, noise))]
    fn codes<'py>(
        &self,
        py: Python<'py>,
        size: [u32; 2],
        samples: u32,
        view: &str,
        terms: &str,
        channel: Option<&str>,
        light_samples: u32,
        noise: Option<f32>,
    ) -> PyResult<Bound<'py, PyArray1<u8>>> {
        let until = Until { samples: light_samples, noise };
        let wanted = Wanted { size, samples, view, terms, channel, until };
        Ok(PyArray1::from_vec(py, self.draw(py, &wanted, false)?.into_rgb8()))
    }

    /// Light, linear, before exposure, with coverage: four numbers for each pixel, row by row.
    #[pyo3(signature = (size, samples, view, terms, light_samples, noise))]
    fn light<'py>(
        &self,
        py: Python<'py>,
        size: [u32; 2],
        samples: u32,
        view: &str,
        terms: &str,
        light_samples: u32,
        noise: Option<f32>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let until = Until { samples: light_samples, noise };
        let wanted = Wanted { size, samples, view, terms, channel: None, until };
        let shown = self.draw(py, &wanted, true)?;
        let numbers = || {
            let light =
                shown.light().map(|light| light.pixels.iter().map(|p| p.to_array()).collect::<Vec<_>>());
            light.unwrap_or_default().into_flattened()
        };
        Ok(PyArray1::from_vec(py, work::short(py, numbers)?))
    }

    /// The explanation of a pixel, as JSON and as text.
    fn explain(
        &self,
        py: Python<'_>,
        pixel: [u32; 2],
        size: [u32; 2],
        view: &str,
        terms: &str,
        markdown: bool,
    ) -> PyResult<(String, String)> {
        let (scene, terms) = self.seen(view, terms)?;
        self.runs(&scene)?;
        let settings = Settings { width: size[0], height: size[1], samples: 1, terms };
        let explained = work::long(py, |_| explain::pixel(&scene, &self.registry, &settings, pixel))?;
        let explained = explained.map_err(|e| PyValueError::new_err(e.to_string()))?;
        self.runs(&scene)?;
        let text = if markdown { explained.to_markdown() } else { explained.to_text() };
        Ok((explained.to_json().to_string(), text))
    }

    /// The parameters of a view that come nearest to view A: what was found as JSON, and the scene with them.
    #[pyo3(signature = (view, what, free, metric))]
    fn matched(
        &self,
        py: Python<'_>,
        view: &str,
        what: &str,
        free: Option<Vec<String>>,
        metric: &str,
    ) -> PyResult<(String, Self)> {
        let number = self.number(view)?;
        let what = What::from_id(what).ok_or_else(|| one_of("on", what, &What::ALL.map(What::id)))?;
        let metric =
            Metric::from_id(metric).ok_or_else(|| one_of("metric", metric, &Metric::ALL.map(Metric::id)))?;
        let measure = Measure { what, metric };
        let free = free.unwrap_or_else(|| {
            let all = matching::parameters(&self.scene, number, &self.registry);
            all.into_iter()
                .filter(|(_, usual)| *usual)
                .map(|(parameter, _)| parameter.name.to_owned())
                .collect()
        });
        let parameters: Vec<_> = free.iter().map(String::as_str).collect();
        let request = Request { scene: &self.scene, view: number, measure, parameters: &parameters };
        let found = work::long(py, |progress: &Progress| match_view(&request, &self.registry, progress))?;
        let found = found.map_err(|e: MatchError| PyValueError::new_err(e.to_string()))?;
        let values: serde_json::Map<_, _> =
            found.values.iter().map(|(name, v)| ((*name).to_owned(), v.json())).collect();
        let said = serde_json::json!({
            "view": LETTERS[number], "on": what.id(), "metric": measure.metric().map(Metric::id), "unit": measure.unit(), "before": found.before, "after": found.after,
            "values": values, "unchanged": found.kept, "without_effect": found.without_effect,
            "ambiguous": found.ambiguous,
            "evaluations": found.evaluations, "ended": found.ended.id(),
        });
        let mut scene = self.scene.clone();
        found
            .values
            .iter()
            .for_each(|(name, value)| scene.variants[number - 1].material.set(*name, value.clone()));
        Ok((said.to_string(), Self { scene, registry: self.registry.clone() }))
    }
}

impl Scene {
    /// The number of a view, from its letter or its name.
    fn number(&self, view: &str) -> PyResult<usize> {
        self.scene.view_named(view).map_err(|why| PyValueError::new_err(format!("view: {why}")))
    }

    /// The scene of a view, and its terms.
    fn seen(&self, view: &str, terms: &str) -> PyResult<(lights_camera_models::scene::Scene, TermSelection)> {
        let terms = TermSelection::from_id(terms)
            .ok_or_else(|| one_of("terms", terms, &TermSelection::ALL.map(TermSelection::id)))?;
        let number = self.number(view)?;
        let (scene, own) =
            self.scene.seen(number, &self.registry).ok_or_else(|| crate::bug("a view is missing"))?;
        Ok((scene, if terms == TermSelection::All { own } else { terms }))
    }

    /// Fails if a model of the scene cannot be run.
    fn runs(&self, scene: &lights_camera_models::scene::Scene) -> PyResult<()> {
        let missing = reference::not_on_cpu(scene, &self.registry);
        missing.map_or(Ok(()), |(model, why)| Err(errors::cannot_run(model, &why)))
    }

    /// Draws a view, with its light if that is needed.
    pub fn draw(&self, py: Python<'_>, wanted: &Wanted, lit: bool) -> PyResult<Shown> {
        let (scene, terms) = self.seen(wanted.view, wanted.terms)?;
        self.runs(&scene)?;
        let channel = wanted.channel.map(|id| {
            let channel = DebugChannel::from_id(id)
                .ok_or_else(|| one_of("channel", id, &DebugChannel::ALL.map(DebugChannel::id)))?;
            Ok::<_, PyErr>(Setting::new(channel, &scene, &self.registry, scene.observer.position, None))
        });
        let channel = channel.transpose()?;
        let [width, height] = wanted.size;
        work::room(width as usize * height as usize * if lit { LIT } else { SHOWN })?;
        let settings = Settings { width, height, samples: wanted.samples, terms };
        let view =
            View { scene: &scene, registry: &self.registry, settings, channel, until: wanted.until, lit };
        let drawn = work::long(py, |progress| view.draw(&AtomicBool::default(), progress))?;
        self.runs(&scene)?;
        match drawn {
            Ok((shown, _)) => Ok(shown),
            Err(Undrawn::Cancelled) => Err(crate::bug("cancelled without a signal")),
            Err(error @ (Undrawn::TooLarge(_) | Undrawn::NoRoom(..))) => {
                Err(PyMemoryError::new_err(error.to_string()))
            }
        }
    }
}

/// The error for a word that is not one of several.
pub fn one_of(what: &str, given: &str, known: &[&str]) -> PyErr {
    let given = shortened(given);
    PyValueError::new_err(match known {
        [one] => format!("{what} is {given:?}, but it must be {one:?}"),
        _ => {
            let near = did_you_mean(&given, known.iter().map(|k| (*k, *k)));
            format!("{what} is {given:?}, but it must be one of {}{near}", known.join(", "))
        }
    })
}

/// A value of JSON as [`Place::read`] takes it: words only where words are declared, numbers only where numbers are.
fn text_of(place: &Place, json: &serde_json::Value) -> Result<String, String> {
    let is_word = match place.declared {
        Declared::Parameter(parameter) => parameter.kind.is_text(),
        Declared::Field(field) => matches!(field.kind, Kind::Text(_) | Kind::Id(_) | Kind::Choice(_)),
    };
    match json {
        serde_json::Value::String(text) if is_word => Ok(text.clone()),
        serde_json::Value::String(text) if place.declared.is_colour() && text.starts_with('#') => {
            Ok(text.clone())
        }
        serde_json::Value::Bool(_) | serde_json::Value::Number(_) | serde_json::Value::Array(_)
            if !is_word =>
        {
            Ok(json.to_string())
        }
        _ => {
            let needs =
                if is_word { "a word" } else { "a number, a list of numbers, or true or false, as declared" };
            Err(format!("{} is {}, but it must be {needs}", place.path, shortened(&json.to_string())))
        }
    }
}
