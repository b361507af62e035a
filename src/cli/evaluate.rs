//! `lcm evaluate`: the BRDF of a model at given angles, for plots and comparisons.

use std::{
    io::{self, BufWriter, Write as _},
    str::FromStr,
    sync::Arc,
};

use clap::{Args, ValueEnum};
use glam::Vec3;

use super::{
    Outcome,
    angles::{self, Column},
    workshop::{Workshop, not_on_cpu, valid},
};
use crate::{
    failure::Failure,
    optics::{Frame, colour::Encoding, geometry::direction},
    parameter::{Value, Values},
    reflection::{ModelEntry, Surface, brdf, brdf_of},
    registry::Registry,
    render::capture::evaluate::Evaluator,
    scene::field::Ids,
    text::{nearest, quoted},
};

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
    #[arg(long = "set", value_name = "NAME=VALUE")]
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

/// A device ready to evaluate a model with its parameters.
pub(super) enum Started<'a> {
    /// The CPU, with the surface to evaluate.
    Cpu(Arc<dyn Surface>),
    /// The GPU, with everything needed to start it.
    Gpu(Box<Gpu<'a>>),
}

/// A GPU that starts at the first evaluation.
pub(super) struct Gpu<'a> {
    registry: &'a Registry,
    model: &'a ModelEntry,
    values: &'a Values,
    evaluator: Option<Evaluator>,
}

impl Gpu<'_> {
    pub(super) fn evaluator(&mut self) -> Result<&Evaluator, Failure> {
        let evaluator = match self.evaluator.take() {
            Some(evaluator) => evaluator,
            None => {
                let mut evaluator = Evaluator::new(self.registry.sources(), self.model)?;
                evaluator.set(self.values, Encoding::Srgb);
                evaluator
            }
        };
        Ok(self.evaluator.insert(evaluator))
    }
}

impl Machine {
    /// Prepares the device.
    pub(super) fn start<'a>(
        self,
        registry: &'a Registry,
        model: &'a ModelEntry,
        values: &'a Values,
    ) -> Started<'a> {
        match self {
            Self::Cpu => Started::Cpu(model.instantiate(values, Encoding::Srgb)),
            Self::Gpu => Started::Gpu(Box::new(Gpu { registry, model, values, evaluator: None })),
        }
    }
}

/// One `NAME=VALUE`.
#[derive(Clone, Debug)]
pub(super) struct Setting {
    pub name: String,
    pub value: String,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("it must be NAME=VALUE, e.g. k_d=0.7")?;
        Ok(Self { name: name.trim().to_owned(), value: value.trim().to_owned() })
    }
}

/// The input columns. Angles beyond 90° are below the surface, where the BRDF is 0.
const COLUMNS: [Column; 4] = [
    Column { name: "theta_i", range: Some((0.0, 180.0)) },
    Column { name: "phi_i", range: None },
    Column { name: "theta_o", range: Some((0.0, 180.0)) },
    Column { name: "phi_o", range: None },
];

pub(super) fn run(arguments: &Arguments, workshop: &mut Workshop) -> Outcome {
    workshop.need(&arguments.model);
    let registry = &workshop.registry;
    let model = find(registry, &arguments.model)?;
    let values = arguments.set.values(model)?;
    valid(registry, model)?;
    arguments.on.can_run(model)?;
    let frame = Frame::LOCAL;
    let mut answers = Answers::new("theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b");
    let mut machine = arguments.on.start(registry, model, &values);
    angles::stream(io::stdin().lock(), &COLUMNS, |rows| {
        let pairs: Vec<_> = rows
            .iter()
            .map(|row| {
                let [theta_i, phi_i, theta_o, phi_o] = row.numbers;
                (direction(theta_i, phi_i), direction(theta_o, phi_o))
            })
            .collect();
        let brdfs: Vec<Vec3> = match &mut machine {
            Started::Cpu(surface) => {
                pairs.iter().map(|(l, v)| brdf(surface.as_ref(), *l, *v, &frame)).collect()
            }
            Started::Gpu(gpu) if !rows.is_empty() => {
                let terms = gpu.evaluator()?.evaluate(&pairs)?;
                terms.into_iter().zip(&pairs).map(|(terms, (l, v))| brdf_of(terms, *l, *v, &frame)).collect()
            }
            Started::Gpu(_) => Vec::new(),
        };
        arguments.on.can_run(model)?;
        answers.write(rows.iter().map(|row| row.text.join(",")).zip(brdfs))
    })?;
    answers.finish()
}

/// The results as CSV on standard output, with a header before the first.
pub(super) struct Answers {
    out: BufWriter<io::StdoutLock<'static>>,
    header: Option<&'static str>,
}

impl Answers {
    pub(super) fn new(header: &'static str) -> Self {
        Self { out: BufWriter::new(io::stdout().lock()), header: Some(header) }
    }

    /// Adds rows: input and result.
    pub(super) fn write(&mut self, rows: impl Iterator<Item = (String, Vec3)>) -> Outcome {
        if let Some(header) = self.header.take() {
            writeln!(self.out, "{header}")?;
        }
        for (asked, answer) in rows {
            writeln!(self.out, "{asked},{},{},{}", answer.x, answer.y, answer.z)?;
        }
        // A reader may be waiting for the batch.
        Ok(self.out.flush()?)
    }

    /// Finishes the output.
    pub(super) fn finish(mut self) -> Outcome {
        self.write(std::iter::empty())
    }
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

impl Settings {
    /// The values for a model.
    pub(super) fn values(&self, model: &ModelEntry) -> Result<Values, Failure> {
        let mut values = Values::default();
        let mut problems = Vec::new();
        for Setting { name, value } in &self.settings {
            match setting(model, name, value) {
                Ok((name, value)) => values.set(name, value),
                Err(problem) => problems.push(format!("--set {name}={value}: {problem}")),
            }
        }
        if problems.is_empty() { Ok(values) } else { Err(Failure::Usage(problems.join("\nerror: "))) }
    }
}

/// A parameter of a model, checked.
pub(super) fn setting(
    model: &ModelEntry,
    name: &str,
    written: &str,
) -> Result<(&'static str, Value), String> {
    let spelling = name.replace("color", "colour");
    let Some(parameter) = model.parameter(&spelling) else {
        let names: Vec<_> = model.parameters.iter().map(|p| p.name).collect();
        let known = model.parameters.iter().flat_map(|p| [p.name, p.label, p.symbol].map(|s| (s, p.name)));
        let hint = nearest(&spelling, known).map_or_else(
            || format!("it has {}", crate::text::listed(&names, "and")),
            |n| format!("did you mean {n}?"),
        );
        return Err(format!("{} has no parameter {name}; {hint}", model.declaration.id));
    };
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
