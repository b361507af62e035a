//! The subject of a curve.

use std::sync::Arc;

use glam::Vec3;

use super::{
    CurveError,
    data::{self, PAINTS, Sgd},
};
use crate::{
    caption,
    optics::{Frame, Terms, albedo::directional, colour::Encoding},
    parameter::{Parameter, Value, Values},
    reflection::{Factor, ModelEntry, Surface, bsdf, usage},
    text::did_you_mean,
};

/// A model with its parameters, a measured paint, or the fit to a measured material.
#[derive(Clone)]
pub struct Subject {
    /// The name in the legend.
    pub name: String,
    source: Source,
}

#[derive(Clone)]
enum Source {
    Model { surface: Arc<dyn Surface>, entry: ModelEntry },
    Fit(Box<Sgd>),
    Paint(&'static str),
}

/// A parameter with its value, in words; `None` if it cannot be put in words.
fn setting(parameter: &'static Parameter, value: &Value) -> Option<String> {
    if let Value::File(file) = value {
        return Some(file.short_name().into_owned());
    }
    let (symbol, text) = caption::value(parameter, value)?;
    if !parameter.kind.options().is_empty() {
        return Some(text);
    }
    // A subscript would be lost.
    let name = if symbol.is_empty() || symbol.contains('_') { parameter.label } else { symbol };
    Some(format!("{name} = {text}{}", parameter.suffix()))
}

/// The suffix of the names of measured paints.
pub(super) const MEASURED: &str = " (measured)";

impl Subject {
    /// A model with parameters. The name lists those that differ from their defaults.
    #[must_use]
    pub fn model(entry: &ModelEntry, values: &Values, encoding: Encoding) -> Self {
        let changed = entry.parameters.iter().filter_map(|parameter| {
            let value = values.get(parameter);
            let used = usage::unused(entry.parameters, parameter, values).is_none();
            (used && value != parameter.default_value()).then(|| setting(parameter, &value)).flatten()
        });
        let name = [entry.declaration.name.to_owned()].into_iter().chain(changed).collect::<Vec<_>>();
        let surface = entry.instantiate(values, encoding);
        Self { name: name.join(", "), source: Source::Model { surface, entry: entry.clone() } }
    }

    /// Measured data by name: a paint of [`PAINTS`], or a material of the MERL database, as fitted.
    ///
    /// # Errors
    /// Returns the existing names.
    pub fn measured(id: &str) -> Result<Self, String> {
        if let Some((id, name)) = PAINTS.iter().find(|(known, _)| *known == id) {
            return Ok(Self { name: format!("{name}{MEASURED}"), source: Source::Paint(id) });
        }
        let all = Sgd::all();
        let names: Vec<_> = all.iter().map(|m| m.name).collect();
        if let Some(fit) = all.into_iter().find(|m| m.name == id) {
            let name = format!("{} (fit to MERL)", fit.name.replace('-', " "));
            return Ok(Self { name, source: Source::Fit(Box::new(fit)) });
        }
        let paints = PAINTS.map(|(id, _)| id);
        let known = paints.iter().chain(&names).map(|n| (*n, *n));
        let (count, first) = (names.len(), names.first().copied().unwrap_or_default());
        let merl = format!("one of {count} materials of the MERL database, such as {first}");
        let (paints, near) = (crate::text::listed(&paints, "and"), did_you_mean(id, known));
        Err(format!("measured data must be one of the paints {paints}, or {merl}{near}"))
    }

    /// The id of a measured paint.
    pub(super) fn paint(&self) -> Option<&'static str> {
        match self.source {
            Source::Paint(id) => Some(id),
            _ => None,
        }
    }

    /// Returns an error if the CPU cannot run the model, or could not at the last attempt.
    pub(super) fn runs(&self) -> Result<(), CurveError> {
        match &self.source {
            Source::Model { entry, .. } => entry.not_on_cpu().map_or(Ok(()), |why| {
                Err(CurveError::NotOnCpu { name: entry.declaration.name.to_owned(), why })
            }),
            _ => Ok(()),
        }
    }

    /// True if light passes through the surface.
    pub(super) fn transmits(&self) -> bool {
        matches!(&self.source, Source::Model { surface, .. } if surface.transmits())
    }

    /// The refractive index behind the surface, for models that bend light.
    pub(super) fn refractive_index(&self) -> Option<f32> {
        match &self.source {
            Source::Model { surface, .. } => surface.refractive_index(),
            _ => None,
        }
    }

    /// `f` in sr⁻¹, for light above the surface.
    pub(super) fn brdf(&self, l: Vec3, v: Vec3) -> Vec3 {
        match &self.source {
            Source::Model { surface, .. } => bsdf(surface.as_ref(), l, v, &Frame::LOCAL),
            Source::Fit(fit) => Vec3::from(fit.brdf(l, v).map(|f| f as f32)),
            Source::Paint(_) => Vec3::NAN,
        }
    }

    /// The standard uncertainty of `f` in sr⁻¹, of measured surfaces that know it.
    pub(super) fn uncertainty(&self, l: Vec3, v: Vec3) -> Option<f32> {
        match &self.source {
            Source::Model { surface, .. } => surface.uncertainty(l, v, &Frame::LOCAL),
            _ => None,
        }
    }

    /// The directional albedo for a viewer.
    pub(super) fn directional_albedo(&self, v: Vec3) -> Vec3 {
        let albedo = match &self.source {
            Source::Model { surface, .. } => surface.directional_albedo(v),
            _ => {
                let specular = |l: Vec3| std::f32::consts::PI * l.z * self.brdf(l, v);
                directional(|l| Terms { specular: specular(l), ..Terms::default() }, v, &Frame::LOCAL)
            }
        };
        albedo.as_vec3()
    }

    /// True if a part of the light leaves in a single direction, which a function of directions leaves out.
    pub(super) fn is_sharp(&self) -> bool {
        matches!(&self.source, Source::Model { surface, .. } if !surface.sharp(Vec3::Z, &Frame::LOCAL).is_empty())
    }

    /// A single factor of the model.
    pub(super) fn factor(&self, factor: Factor) -> Option<Vec3> {
        match &self.source {
            Source::Model { surface, .. } => surface.factor(factor),
            _ => None,
        }
    }
}

/// The measured values of a paint in the plane of incidence, by increasing angle of the viewer, for this
/// angle of the light. The error is the angles of the light at which the paint was measured.
pub(super) fn in_plane(id: &str, theta_i: f64) -> Result<Vec<(f64, Vec3)>, Vec<f32>> {
    let all = data::paint(id);
    let mut points: Vec<_> = all
        .iter()
        .filter(|m| (f64::from(m.theta_i) - theta_i).abs() < 0.5)
        .filter_map(|m| Some((f64::from(m.in_plane()?), Vec3::from(m.f.map(|f| f as f32)))))
        .collect();
    if points.is_empty() {
        let mut known: Vec<_> = all.iter().map(|m| m.theta_i).collect();
        known.sort_by(f32::total_cmp);
        known.dedup();
        return Err(known);
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(points)
}
