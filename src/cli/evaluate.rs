//! `lcm evaluate`: the BRDF of a model at given angles, for plots and comparisons.

use std::{
    io::{self, BufWriter, Write as _},
    path::Path,
};

use clap::{Args, ValueEnum};
use glam::Vec3;

use super::{
    Outcome,
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
    pub set: Settings,
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
pub(super) struct Settings {
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
}

impl<const N: usize, I> Quantity<N, I> {
    /// Answers the rows on standard input: each as it was, with the results behind it.
    pub(super) fn print(&self, arguments: &Arguments, workshop: &mut Workshop) -> Outcome {
        let (registry, model, values) = arguments.open(workshop)?;
        let surface = model.instantiate(&values, Encoding::Srgb);
        // The GPU starts at the first row.
        let mut gpu: Option<Box<dyn Evaluator>> = None;
        let mut header = Some(self.header);
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
};

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

impl Settings {
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
