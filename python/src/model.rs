//! A model with its parameters set.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use glam::{DVec3, Vec3};
use lights_camera_models::{
    curves::{Detail, Form, Kind, Setup, Subject, curve},
    optics::{Frame, colour::Encoding},
    parameter::{Value, Values, json},
    progress::Cancelled,
    reflection::{
        ModelEntry, Surface,
        law_report::LawReport,
        laws::{Effort, examine_on_cpu},
    },
};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::{exceptions::PyValueError, prelude::*};
use rayon::prelude::*;
use serde::de::DeserializeSeed as _;

use crate::{errors, known, scene::one_of, work};

/// The number of pairs of directions after which Ctrl+C is noticed.
const AT_ONCE: usize = 1 << 12;
/// The largest deviation of a direction's squared length from 1.
const UNIT: f32 = 2e-3;

/// A model with its parameters.
#[pyclass(frozen, module = "lights_camera_models._lcm")]
pub struct Model {
    pub(crate) entry: ModelEntry,
    pub(crate) values: Values,
    surface: Arc<dyn Surface>,
    /// The WGSL of a custom model.
    text: Option<String>,
}

/// Flat numbers, as arrays arrive.
type Numbers<'py> = PyReadonlyArray2<'py, f32>;

#[pymethods]
impl Model {
    /// The model with an id, and parameters as a JSON object. A text stands for a custom model in place of the known one.
    #[new]
    #[pyo3(signature = (id, parameters, text = None))]
    fn new(py: Python<'_>, id: &str, parameters: &str, text: Option<String>) -> PyResult<Self> {
        let registry = known::with(py, text.map(|text| (id.to_owned(), text)).as_slice())?;
        let entry = known::find(&registry, id)?;
        let values = values(&entry, parameters)?;
        let text = known::text_of(&registry, id);
        let surface = entry.instantiate(&values, Encoding::Srgb);
        let model = Self { entry, values, surface, text };
        model.runs()?;
        Ok(model)
    }

    /// The declaration of the model, as JSON.
    fn describe(&self) -> String {
        known::described(&self.entry)
    }

    /// The WGSL of a custom model.
    fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }

    /// All parameters as a JSON object.
    fn parameters(&self) -> String {
        let each = self.entry.parameters.iter();
        let all: serde_json::Map<_, _> =
            each.map(|p| (p.name.to_owned(), json(&self.values.get(p)))).collect();
        serde_json::Value::Object(all).to_string()
    }

    /// The BSDF in sr⁻¹ for pairs of directions.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        l: Numbers<'py>,
        v: Numbers<'py>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f32>>>> {
        self.pairs(py, &l, &v, |surface, l, v, out| surface.bsdfs(l, v, out))
    }

    /// The terms of the response for pairs of directions.
    fn terms<'py>(
        &self,
        py: Python<'py>,
        l: Numbers<'py>,
        v: Numbers<'py>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f32>>>> {
        self.pairs(py, &l, &v, |surface, l, v, out: &mut [[f32; 12]]| {
            for ((l, v), out) in l.iter().zip(v).zip(out) {
                let terms = surface.response(Vec3::from_array(*l), Vec3::from_array(*v), &Frame::LOCAL);
                out.as_chunks_mut::<3>()
                    .0
                    .iter_mut()
                    .zip(terms.each())
                    .for_each(|(out, term)| *out = term.to_array());
            }
        })
    }

    /// The directional albedo, of reflected light alone, for cosines of the viewer's angle, at an azimuth in radians.
    fn albedo<'py>(
        &self,
        py: Python<'py>,
        mu: PyReadonlyArray1<'py, f64>,
        phi: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mu = mu.as_slice()?;
        let of = |mu: f64| {
            let sine = (1.0 - mu * mu).max(0.0).sqrt();
            let v = DVec3::new(sine * phi.cos(), sine * phi.sin(), mu).as_vec3();
            self.surface.directional_albedo(v).to_array()
        };
        let all = work::long(py, |progress| {
            let mut all = Vec::with_capacity(3 * mu.len());
            for some in mu.chunks(64) {
                progress.step(0.0, "")?;
                let found: Vec<[f64; 3]> = some.par_iter().map(|mu| of(*mu)).collect();
                all.extend_from_slice(found.as_flattened());
            }
            Ok::<_, Cancelled>(all)
        })?;
        self.runs()?;
        Ok(PyArray1::from_vec(py, all.unwrap_or_default()))
    }

    /// The laws, examined: the report as JSON.
    fn laws(&self, py: Python<'_>) -> PyResult<String> {
        let examined = work::long(py, |progress| {
            // Of all values, but of the file that it has.
            let is_file = |value: &Value| matches!(value, Value::File(_));
            let own = self.values.0.iter().filter(|(_, value)| is_file(value));
            let given = Values(own.map(|(name, value)| (name.clone(), value.clone())).collect());
            let findings = examine_on_cpu(&self.entry, &given, Effort::default(), progress);
            findings.map(|findings| LawReport::new(&self.entry, &given, &findings))
        })?;
        self.runs()?;
        let examined = examined.map_err(|_| crate::bug("cancelled without a signal"))?;
        serde_json::to_string(&examined).map_err(|e| crate::bug(&e.to_string()))
    }

    /// A curve: its angles in degrees, and its values.
    fn curve<'py>(
        &self,
        py: Python<'py>,
        kind: &str,
        theta_i: f64,
        phi_i: f64,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f32>>)> {
        let kind = kind_of(kind)?;
        if kind.declaration().form == Form::Slices {
            return Err(PyValueError::new_err(format!(
                "{} is a picture, not a curve; plot draws it",
                kind.id()
            )));
        }
        let setup = Setup::new(kind, theta_i, phi_i).map_err(|e| PyValueError::new_err(e.to_string()))?;
        let subject = Subject::model(&self.entry, &self.values, Encoding::Srgb);
        let found = work::long(py, |progress| curve(&subject, &setup, Detail::Fine, progress))?;
        let points = found.map_err(|e| PyValueError::new_err(e.to_string()))?.points;
        let angles = points.iter().map(|p| p.angle).collect();
        let values = points.iter().flat_map(|p| p.rgb.to_array()).collect();
        Ok((PyArray1::from_vec(py, angles), PyArray1::from_vec(py, values)))
    }
}

impl Model {
    /// `N` numbers for each pair of directions; `None` if a direction is not of unit length.
    fn pairs<'py, const N: usize>(
        &self,
        py: Python<'py>,
        l: &Numbers<'py>,
        v: &Numbers<'py>,
        of: impl Fn(&dyn Surface, &[[f32; 3]], &[[f32; 3]], &mut [[f32; N]]) + Sync,
    ) -> PyResult<Option<Bound<'py, PyArray1<f32>>>> {
        let [l, v] = [l.as_slice()?, v.as_slice()?].map(|all| all.as_chunks::<3>().0);
        work::room(size_of_val(l) / 3 * N)?;
        let is_unit = |d: &[f32; 3]| (Vec3::from_array(*d).length_squared() - 1.0).abs() <= UNIT;
        let wrong = AtomicBool::new(false);
        let part = |((out, l), v): ((&mut [[f32; N]], &[[f32; 3]]), &[[f32; 3]])| {
            if l.iter().chain(v).all(is_unit) {
                of(&*self.surface, l, v, out);
            } else {
                wrong.store(true, Ordering::Relaxed);
            }
        };
        let mut all = vec![[0.0; N]; l.len()];
        if l.len() <= AT_ONCE && !self.entry.is_interpreted() {
            work::short(py, || part(((&mut all, l), v)))?;
        } else {
            work::until_stopped(py, |stop| {
                let each = all.par_chunks_mut(AT_ONCE).zip(l.par_chunks(AT_ONCE)).zip(v.par_chunks(AT_ONCE));
                each.for_each(|chunk| {
                    if !stop.load(Ordering::Relaxed) {
                        part(chunk);
                    }
                });
            })?;
        }
        self.runs()?;
        Ok((!wrong.into_inner()).then(|| PyArray1::from_vec(py, all.into_flattened())))
    }

    /// Fails if the CPU cannot run a custom model, or one of its functions ran too long.
    fn runs(&self) -> PyResult<()> {
        self.entry.not_on_cpu().map_or(Ok(()), |why| Err(errors::cannot_run(&self.entry, &why)))
    }
}

/// The kind of curve with an id.
pub fn kind_of(id: &str) -> PyResult<Kind> {
    Kind::from_id(id).ok_or_else(|| one_of("kind", id, &Kind::ALL.map(Kind::id)))
}

/// Parameters from a JSON object.
pub fn values(entry: &ModelEntry, written: &str) -> PyResult<Values> {
    let given: serde_json::Map<String, serde_json::Value> = serde_json::from_str(written).map_err(|_| {
        errors::model("a parameter is a number that is too large, or text that is not Unicode", None)
    })?;
    let mut values = Values::default();
    let mut problems = Vec::new();
    for (name, value) in given {
        let refused = match entry.named(&name) {
            Err(why) => Some(why),
            Ok(parameter) => match parameter.deserialize(&value) {
                Ok(value) => {
                    values.set(parameter.name, value);
                    None
                }
                Err(why) => Some(why.to_string()),
            },
        };
        if let Some(why) = refused {
            let value = value.to_string();
            problems.push(serde_json::json!({ "path": name, "line": null, "column": null, "value": value, "message": why }));
        }
    }
    if problems.is_empty() {
        return Ok(values);
    }
    let texts: Vec<_> = problems.iter().filter_map(|p| p["message"].as_str()).collect();
    Err(errors::model(&texts.join("\n"), Some(problems.clone().into())))
}
