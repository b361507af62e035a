//! `lcm models`: the reflection models, shading models, light types and object types.

use super::{Options, Outcome, custom, print_json, print_text, workshop::Places};
use crate::files::Shown as _;
use crate::{
    failure::Failure,
    parameter::{ABOVE_ZERO, Parameter, ParameterKind, UsedWhen, json as value},
    reflection::ModelEntry,
    registry::Registry,
    text::number,
};
use std::fmt::Write as _;

use serde_json::{Value as Json, json};

use clap::{Args, Subcommand};

#[derive(Args, Debug)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Write a commented file as a start for a custom model
    New {
        /// Name of the model; its id and file name follow from it
        name: String,
    },
    /// Copy an existing model to a file: same picture, same parameters
    Duplicate {
        /// ID of the model, as listed by `lcm models`
        id: String,
        /// Name of the copy; by default, the id with _copy appended
        name: Option<String>,
    },
    /// Search for violations of the laws that a model claims to keep, on the GPU; software Vulkan suffices
    Check {
        /// ID of the model, as listed by `lcm models`
        id: String,
        /// Print the result as JSON
        #[arg(long)]
        json: bool,
    },
}

#[cfg(target_os = "linux")]
impl Arguments {
    /// True if the command loads a graphics driver.
    pub(super) fn loads_driver(&self) -> bool {
        matches!(self.command, Some(Command::Check { .. }))
    }
}

pub(super) fn run(arguments: Arguments, options: Options, places: &Places, known: Registry) -> Outcome {
    match arguments.command {
        Some(Command::New { name }) => custom::new(&name, options, places, &known),
        Some(Command::Duplicate { id, name }) => {
            custom::duplicate(&id, name.as_deref(), options, places, &known)
        }
        Some(Command::Check { id, json }) => {
            custom::check(&id, json, options, &mut places.open(options, known)?)
        }
        None => {
            let mut workshop = places.open(options, known)?;
            let undeclared = workshop.declare_all();
            list(arguments.json, &workshop.registry)?;
            // A model with a valid declaration is listed, and its other problems follow the list.
            let broken = workshop.read_all();
            if undeclared || broken { Err(Failure::Invalid(String::new())) } else { Ok(()) }
        }
    }
}

fn list(as_json: bool, registry: &Registry) -> Outcome {
    if as_json {
        let models = registry.models().iter().map(|m| model(m, registry));
        let others = others(registry).map(|other| other.to_json());
        return print_json(&format!("{:#}\n", models.chain(others).collect::<Json>()));
    }
    print_text(&table(registry))
}

/// A type other than a reflection model.
struct Other {
    kind: &'static str,
    /// Heading in lists.
    heading: &'static str,
    id: &'static str,
    name: &'static str,
    summary: &'static str,
    parameters: &'static [Parameter],
    /// Additional information specific to this kind, for people and for programs.
    note: String,
    more: Vec<(&'static str, Json)>,
}

impl Other {
    fn to_json(&self) -> Json {
        let mut json = json!({
            "kind": self.kind,
            "id": self.id,
            "name": self.name,
            "summary": self.summary,
            "parameters": self.parameters.iter().map(parameter).collect::<Vec<_>>(),
        });
        for (key, value) in &self.more {
            json[*key] = value.clone();
        }
        json
    }
}

/// Shading models, light types and object types.
fn others(registry: &Registry) -> impl Iterator<Item = Other> {
    let shading = registry.shading_models().iter().map(|entry| {
        let d = entry.declaration;
        Other {
            kind: "shading model",
            heading: "Shading models",
            id: d.id,
            name: d.name,
            summary: d.summary,
            parameters: entry.parameters,
            note: d.author.to_owned(),
            more: vec![("author", d.author.into()), ("source", d.source.into())],
        }
    });
    let lights = registry.lights().iter().map(|entry| {
        let d = entry.declaration;
        Other {
            kind: "light type",
            heading: "Light types",
            id: d.id,
            name: d.name,
            summary: d.summary,
            parameters: entry.parameters,
            note: format!("intensity in {}", d.unit),
            more: vec![
                ("unit", d.unit.into()),
                ("equation", d.equation.into()),
                ("has_position", d.has_position.into()),
                ("has_direction", d.has_direction.into()),
            ],
        }
    });
    let shapes = registry.shapes().iter().map(|entry| {
        let d = entry.declaration;
        let (least, most) = (*d.tessellation.start(), *d.tessellation.end());
        Other {
            kind: "object type",
            heading: "Object types",
            id: d.id,
            name: d.name,
            summary: d.summary,
            parameters: entry.parameters,
            note: match most {
                _ if least == most => String::new(),
                _ => format!("tessellation {least} to {most}"),
            },
            more: vec![(
                "tessellation",
                json!({ "min": least, "max": most, "default": d.default_tessellation }),
            )],
        }
    });
    shading.chain(lights).chain(shapes)
}

/// A model as JSON.
fn model(entry: &ModelEntry, registry: &Registry) -> Json {
    let d = entry.declaration;
    let laws = |kept: bool| -> Vec<_> {
        d.laws.list().into_iter().filter(|(_, k)| *k == kept).map(|(name, _)| name).collect()
    };
    let equation: Vec<_> =
        d.equation.iter().map(|part| json!({ "term": part.term.id(), "text": part.text })).collect();
    let mut json = json!({
        "kind": "reflection model",
        "id": d.id,
        "name": d.name,
        "family": d.family.name(),
        "author": d.author,
        "source": d.source,
        "summary": d.summary,
        "equation": equation,
        "laws": { "kept": laws(true), "broken": laws(false) },
        "parameters": entry.parameters.iter().map(parameter).collect::<Vec<_>>(),
    });
    if let Some(file) = registry.custom_file(d.id) {
        json["file"] = file.display().to_string().into();
    }
    json
}

/// A parameter as JSON.
fn parameter(p: &Parameter) -> Json {
    let mut json = json!({
        "name": p.name,
        "symbol": p.symbol,
        "label": p.label,
        "unit": p.unit,
        "help": p.help,
        "default": value(&p.default_value()),
        "range": p.rule(),
    });
    if let Some(UsedWhen { parameter, choices }) = p.used_when {
        json["used_when"] = json!({ parameter: choices });
    }
    match &p.kind {
        ParameterKind::Number { min, max, .. } => {
            json["type"] = "number".into();
            if *min == ABOVE_ZERO {
                json["above"] = 0.into();
            } else {
                json["min"] = number(*min);
            }
            json["max"] = number(*max);
        }
        ParameterKind::Integer { min, max, .. } => {
            json["type"] = "integer".into();
            json["min"] = (*min).into();
            json["max"] = (*max).into();
        }
        ParameterKind::Colour { .. } => json["type"] = "colour".into(),
        ParameterKind::Triple { min, max, .. } => {
            json["type"] = "triple".into();
            json["min"] = number(*min);
            json["max"] = number(*max);
        }
        ParameterKind::Choice { .. } if p.is_flag() => json["type"] = "flag".into(),
        ParameterKind::Choice { options, .. } => {
            json["type"] = "choice".into();
            json["choices"] = options.iter().map(|(id, _)| *id).collect::<Vec<_>>().into();
        }
        ParameterKind::File { .. } => json["type"] = "file".into(),
    }
    json
}

/// All types as text.
fn table(registry: &Registry) -> String {
    let mut text = String::new();
    let longest = |of: fn(&ModelEntry) -> &str| {
        registry.models().iter().map(|m| of(m).chars().count()).max().unwrap_or_default()
    };
    let ids = longest(|m| m.declaration.id);
    let names = longest(|m| m.declaration.name);
    let mut family = None;
    for m in registry.models() {
        let d = m.declaration;
        if family.replace(d.family) != Some(d.family) {
            let gap = if text.is_empty() { "" } else { "\n" };
            // Writing to a String cannot fail, here and below.
            let _ = writeln!(text, "{gap}{}", d.family.name());
        }
        let _ = writeln!(text, "  {:ids$}  {:names$}  {}", d.id, d.name, d.author);
        let laws =
            d.laws.list().map(|(name, kept)| if kept { name.to_owned() } else { format!("not {name}") });
        let _ = writeln!(text, "  {:ids$}  {}", "", laws.join(", "));
        if let Some(file) = registry.custom_file(d.id) {
            let _ = writeln!(text, "  {:ids$}  {}", "", file.shown());
        }
        parameters(&mut text, ids, m.parameters);
    }
    let mut heading = "";
    for other in others(registry) {
        if std::mem::replace(&mut heading, other.heading) != other.heading {
            let _ = writeln!(text, "\n{heading}");
        }
        let line = format!("  {:ids$}  {:names$}  {}", other.id, other.name, other.note);
        let _ = writeln!(text, "{}\n  {:ids$}  {}", line.trim_end(), "", other.summary);
        parameters(&mut text, ids, other.parameters);
    }
    text
}

/// Writes parameters below the line of their type; `ids` is the width of the id column.
fn parameters(text: &mut String, ids: usize, all: &[Parameter]) {
    for p in all {
        let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
        let used = p
            .used_when
            .map_or_else(String::new, |u| format!("; used with {} {}", u.parameter, u.choices.join(", ")));
        let _ = writeln!(
            text,
            "  {:ids$}    {} ({}){unit}: {}, default {}{used}",
            "",
            p.name,
            p.label,
            p.rule(),
            p.default_value()
        );
    }
}
