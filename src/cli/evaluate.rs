//! `lcm evaluate`: the BRDF of a model at given angles, for plots and comparisons.

use std::{
    io::{self, BufWriter, Write as _},
    path::Path,
};

use clap::{Args, ValueEnum};
use glam::Vec3;

use super::{
    Options, Outcome,
    angles::{self, Column},
    engine::{Evaluator, engine},
    workshop::{Workshop, not_on_cpu, valid},
};
use crate::{
    failure::Failure,
    optics::{Frame, Terms, colour::Encoding, geometry::direction},
    parameter::{NamedFile, Value, Values},
    reflection::{ModelEntry, Surface, brdf_of, bsdf},
    registry::Registry,
    scene::field::Ids,
    text::quoted,
};

/// The hint given without a GPU.
const WITH_CPU: &str = "no model can be evaluated on the GPU; use --on cpu";

/// A model with its parameters, and the machine that evaluates it.
#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// ID of the model, as listed by `lcm models`
    pub model: String,
    #[command(flatten)]
    pub set: SetParameters,
    /// Evaluate on the CPU or on the GPU
    #[arg(long, value_enum, default_value_t = Machine::Cpu)]
    pub on: Machine,
}

impl Arguments {
    /// The model and the values of its parameters, if the machine can run it.
    pub(super) fn open<'a>(
        &self,
        workshop: &'a mut Workshop,
    ) -> Result<(&'a Registry, &'a ModelEntry, Values), Failure> {
        workshop.need(&self.model);
        let registry = &workshop.registry;
        let model = find(registry, &self.model)?;
        let values = self.set.values(model)?;
        valid(registry, model)?;
        self.on.can_run(model)?;
        Ok((registry, model, values))
    }
}

#[cfg(target_os = "linux")]
impl Arguments {
    /// True if the command loads a graphics driver.
    pub(super) fn loads_driver(&self) -> bool {
        matches!(self.on, Machine::Gpu)
    }
}

/// Parameters of a model on the command line.
#[derive(Args, Debug)]
pub(super) struct SetParameters {
    /// Set a parameter of the model, such as k_d=0.7 or base_colour=255,128,0; can be repeated
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = Setting::read)]
    pub settings: Vec<Setting>,
}

/// The machine that evaluates a model.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum Machine {
    /// Rust functions, or the interpreted WGSL of a custom model
    Cpu,
    /// WGSL functions in a compute shader; software Vulkan suffices
    Gpu,
}

impl Machine {
    /// Fails if the device cannot run a model, or could not at the last attempt.
    pub(super) fn can_run(self, model: &ModelEntry) -> Outcome {
        match (self, model.not_on_cpu()) {
            (Self::Cpu, Some(why)) => Err(not_on_cpu(model, &why, "--on gpu")),
            _ => Ok(()),
        }
    }
}

/// One `NAME=VALUE`.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    pub name: String,
    pub value: String,
}

/// A quantity of models that is printed for each row of a table.
pub(super) struct Quantity<const N: usize, I> {
    pub columns: [Column; N],
    /// The columns and those of the results.
    pub header: &'static str,
    pub input: fn([f64; N]) -> I,
    pub on_cpu: fn(&dyn Surface, &[I]) -> Vec<Vec3>,
    pub on_gpu: fn(&dyn Evaluator, &[I]) -> Result<Vec<Vec3>, Failure>,
    /// Remarks on rows of a model whose result on the machine is 0 because they are not evaluated.
    pub left_out: fn(&dyn Surface, Machine, &[I]) -> Vec<&'static str>,
}

impl<const N: usize, I> Quantity<N, I> {
    /// Answers the rows on standard input: each as it was, with the results behind it.
    pub(super) fn print(&self, arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
        let (registry, model, values) = arguments.open(workshop)?;
        let surface = model.instantiate(&values, Encoding::Srgb);
        // The GPU starts at the first row.
        let mut gpu: Option<Box<dyn Evaluator>> = None;
        let mut header = Some(self.header);
        let mut told = Vec::new();
        let mut out = BufWriter::new(io::stdout().lock());
        angles::stream(io::stdin().lock(), &self.columns, |rows| {
            let inputs: Vec<_> = rows.iter().map(|row| (self.input)(row.numbers)).collect();
            let results = match (arguments.on, &mut gpu) {
                (Machine::Cpu, _) => (self.on_cpu)(surface.as_ref(), &inputs),
                (Machine::Gpu, _) if rows.is_empty() => Vec::new(),
                (Machine::Gpu, Some(gpu)) => (self.on_gpu)(gpu.as_ref(), &inputs)?,
                (Machine::Gpu, none) => {
                    let gpu = none.insert((engine(WITH_CPU)?.evaluator)(registry.sources(), model)?);
                    gpu.set(&values, Encoding::Srgb);
                    (self.on_gpu)(gpu.as_ref(), &inputs)?
                }
            };
            arguments.on.can_run(model)?;
            for remark in (self.left_out)(surface.as_ref(), arguments.on, &inputs) {
                if !told.contains(&remark) {
                    options.tell(format_args!("{}: {remark}", model.declaration.id));
                    told.push(remark);
                }
            }
            if let Some(header) = header.take() {
                writeln!(out, "{header}")?;
            }
            for (row, result) in rows.iter().zip(results) {
                writeln!(out, "{},{},{},{}", row.text.join(","), result.x, result.y, result.z)?;
            }
            // A reader may be waiting for the batch.
            Ok(out.flush()?)
        })
    }
}

/// The BSDF for pairs of directions. Beyond 90° is below the surface: some models transmit light from there, and what they
/// transmit to observers there is known on the CPU.
pub(super) const BRDF: Quantity<4, (Vec3, Vec3)> = Quantity {
    columns: [
        Column { name: "theta_i", range: Some((0.0, 180.0)) },
        Column { name: "phi_i", range: None },
        Column { name: "theta_o", range: Some((0.0, 180.0)) },
        Column { name: "phi_o", range: None },
    ],
    header: "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b",
    input: |[theta_i, phi_i, theta_o, phi_o]| (direction(theta_i, phi_i), direction(theta_o, phi_o)),
    on_cpu: |surface, pairs| pairs.iter().map(|(l, v)| bsdf(surface, *l, *v, &Frame::LOCAL)).collect(),
    on_gpu: |gpu, pairs| {
        let of = |(terms, (l, v)): (Terms, &(Vec3, Vec3))| brdf_of(terms, *l, *v, &Frame::LOCAL);
        Ok(gpu.evaluate(pairs)?.into_iter().zip(pairs).map(of).collect())
    },
    left_out,
};

/// The remark on light from within a solid body, which leaves it elsewhere.
const FROM_WITHIN: &str = "rows with light from inside the body (theta_i beyond 90°) are 0: such light follows the mesh of \
                           the object, which no function of two directions knows; rows with the observer inside give what \
                           enters a rough body";
/// The remark on observers behind a surface, whom the WGSL of models does not know.
const ON_GPU: &str = "rows with the observer behind the surface (theta_o beyond 90°) are 0: the GPU does not evaluate them; \
                      --on cpu does";

/// Remarks on pairs of directions that are not evaluated.
fn left_out(surface: &dyn Surface, on: Machine, pairs: &[(Vec3, Vec3)]) -> Vec<&'static str> {
    let any = |wanted: fn(Vec3, Vec3) -> bool| pairs.iter().any(|(l, v)| wanted(*l, *v));
    let from_within = surface.interior().is_some() && any(|l, v| l.z < 0.0 && v.z > 0.0);
    let on_gpu = matches!(on, Machine::Gpu) && surface.transmits() && any(|l, v| l.z > 0.0 && v.z < 0.0);
    [(from_within, FROM_WITHIN), (on_gpu, ON_GPU)]
        .into_iter()
        .filter_map(|(is, why)| is.then_some(why))
        .collect()
}

/// The model with this id.
pub(super) fn find<'a>(registry: &'a Registry, id: &str) -> Result<&'a ModelEntry, Failure> {
    Ids::ReflectionModel
        .check(registry, id)
        .map_err(|rule| unknown(registry, id, format!("MODEL is {}, but {rule}", quoted(id))))?;
    registry.model(id).ok_or_else(|| Failure::Usage(format!("there is no model {}", quoted(id))))
}

/// The failure of a command that names an unknown model: an error in the model's file is not an error of the
/// command line.
pub(super) fn unknown(registry: &Registry, id: &str, what: String) -> Failure {
    match registry.broken_model(id) {
        Some(_) => Failure::Invalid(format!("error: {what}")),
        None => Failure::Usage(what),
    }
}

impl SetParameters {
    /// The values for a model.
    pub(super) fn values(&self, model: &ModelEntry) -> Result<Values, Failure> {
        let mut values = Values::default();
        let mut problems = Vec::new();
        self.settings.iter().for_each(|given| given.put(model, &mut values, &mut problems));
        if problems.is_empty() { Ok(values) } else { Err(Failure::Usage(problems.join("\nerror: "))) }
    }
}

impl Setting {
    fn read(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("it must be NAME=VALUE, e.g. k_d=0.7")?;
        Ok(Self { name: name.trim().to_owned(), value: value.trim().to_owned() })
    }

    /// Sets the value for a model, or adds a problem.
    pub(super) fn put(&self, model: &ModelEntry, values: &mut Values, problems: &mut Vec<String>) {
        let Self { name, value } = self;
        match setting(model, name, value) {
            Ok((name, value)) => values.set(name, value),
            Err(problem) => problems.push(format!("--set {name}={value}: {problem}")),
        }
    }
}

/// A parameter of a model, checked.
pub(super) fn setting(
    model: &ModelEntry,
    name: &str,
    written: &str,
) -> Result<(&'static str, Value), String> {
    let parameter = model.named(name)?;
    if let Some(format) = parameter.kind.format() {
        // Whoever types a command may read any file, unlike a scene.
        let file = Value::File(NamedFile::chosen(written, Path::new(""), format));
        let checked = parameter.check(&file).map_err(|rule| format!("{name} is {written}, but {rule}"));
        return checked.map(|()| (parameter.name, file));
    }
    match parameter.parse(written) {
        Ok(value) => Ok((parameter.name, value)),
        Err(error) => Err(format!("{name} {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_not_evaluated_are_remarked_on() {
        let registry = Registry::builtin();
        let said = |id: &str, set: &[(&'static str, f32)], on: Machine, [theta_i, theta_o]: [f64; 2]| {
            let mut values = Values::default();
            set.iter().for_each(|(name, value)| values.set(*name, Value::Number(*value)));
            let surface = find(&registry, id).expect("built in").instantiate(&values, Encoding::Srgb);
            let pair = (direction(theta_i, 0.0), direction(theta_o, 180.0));
            left_out(surface.as_ref(), on, &[pair])
        };
        let (within, inwards) = ([150.0, 45.0], [45.0, 151.9]);
        let body = [("transmission_weight", 1.0), ("roughness", 0.4)];
        for (id, set) in [("glass", &body[1..]), ("openpbr", &body[..])] {
            assert_eq!(said(id, set, Machine::Cpu, within), [FROM_WITHIN], "{id}");
            assert_eq!(said(id, set, Machine::Cpu, inwards), [""; 0], "{id}");
            assert_eq!(said(id, set, Machine::Gpu, inwards), [ON_GPU], "{id}");
            assert_eq!(said(id, set, Machine::Gpu, [45.0, 30.0]), [""; 0], "{id}");
        }
        assert_eq!(said("rough_dielectric", &[], Machine::Cpu, within), [""; 0], "one boundary has it");
        assert_eq!(said("rough_dielectric", &[], Machine::Gpu, inwards), [ON_GPU]);
        for (id, set) in [("lambert", &body[..0]), ("openpbr", &body[1..])] {
            for on in [Machine::Cpu, Machine::Gpu] {
                assert_eq!(said(id, set, on, within), [""; 0], "{id} is opaque");
                assert_eq!(said(id, set, on, inwards), [""; 0], "{id} is opaque");
            }
        }
    }

    #[test]
    fn settings_are_checked_like_scene_files() {
        let registry = Registry::builtin();
        let phong = find(&registry, "phong").expect("built in");
        assert_eq!(
            setting(phong, "base_color", "255,128,0"),
            Ok(("base_colour", Value::Colour([255, 128, 0])))
        );
        assert_eq!(setting(phong, "alpha", "8"), Ok(("alpha", Value::Integer(8))));
        for (name, value, expected) in [
            ("k_d", "0.2", "k_d is 0.2, but the diffuse coefficient must be between 0.5 and 1"),
            ("k_d", "nan", "must be between 0.5 and 1"),
            ("kd", "0.7", "did you mean k_d?"),
            ("shininess", "3", "did you mean alpha?"),
            ("base_colour", "1,2", "three whole numbers from 0 to 255"),
            ("base_colour", "1,2,256", "three whole numbers from 0 to 255"),
            ("banana", "1", "it has base_colour, specular_colour"),
        ] {
            let said = setting(phong, name, value).err().unwrap_or_default();
            assert!(said.contains(expected), "{name}={value}: {said}");
        }
    }
}
