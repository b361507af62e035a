//! `lcm models`: the reflection models, shading models, light types and object types.

use super::{Options, Outcome, custom, evaluate::SetParameters, print_json, print_text, workshop::Places};
use crate::files::Shown as _;
use crate::{
    failure::Failure,
    parameter::{Parameter, UsedWhen, json as value},
    reflection::ModelEntry,
    registry::Registry,
    scene::field::{Ids, Listed},
    text::capitalised,
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
        #[command(flatten)]
        set: SetParameters,
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
        Some(Command::Check { id, set, json }) => {
            custom::check(&id, &set, json, options, &mut places.open(options, known)?)
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
        return print_json(&models.chain(others).collect::<Json>());
    }
    print_text(&table(registry))
}

/// A type other than a reflection model.
struct Other {
    ids: Ids,
    listed: Listed,
    /// Additional information specific to this kind, for people and for programs.
    note: String,
    more: Json,
}

impl Other {
    fn to_json(&self) -> Json {
        let mut json = json!({
            "kind": self.ids.name(),
            "id": self.listed.id,
            "name": self.listed.name,
            "summary": self.listed.summary,
            "parameters": self.listed.parameters.iter().map(parameter).collect::<Vec<_>>(),
        });
        for (key, value) in self.more.as_object().into_iter().flatten() {
            json[key] = value.clone();
        }
        json
    }
}

/// Shading models, light types and object types.
fn others(registry: &Registry) -> impl Iterator<Item = Other> {
    let of = |ids: Ids, about: Vec<(String, Json)>| {
        let all = ids.all(registry).zip(about);
        all.map(move |(listed, (note, more))| Other { ids, listed, note, more })
    };
    let shading = registry.shading_models().iter().map(|entry| {
        let d = entry.declaration;
        (d.author.to_owned(), json!({ "author": d.author, "source": d.source }))
    });
    let lights = registry.lights().iter().map(|entry| {
        let d = entry.declaration;
        let more = json!({
            "unit": d.unit,
            "equation": d.equation,
            "has_position": d.has_position,
            "has_direction": d.has_direction,
        });
        (format!("intensity in {}", d.unit), more)
    });
    let shapes = registry.shapes().iter().map(|entry| {
        let d = entry.declaration;
        let (least, most) = (*d.tessellation.start(), *d.tessellation.end());
        let note = if least == most { String::new() } else { format!("tessellation {least} to {most}") };
        let tessellation = json!({ "min": least, "max": most, "default": d.default_tessellation });
        (note, json!({ "tessellation": tessellation }))
    });
    let shading = of(Ids::ShadingModel, shading.collect());
    let lights = of(Ids::LightType, lights.collect());
    shading.chain(lights).chain(of(Ids::ObjectType, shapes.collect()))
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
    if let Some(meaning) = p.stands_for {
        json["stands_for"] =
            json!({ "id": meaning.id, "quantity": meaning.quantity, "formula": meaning.formula });
    }
    json["type"] = p.kind.name().into();
    for (key, value) in p.kind.keys() {
        if key != "slider_max" {
            json[key] = value;
        }
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
    let mut kind = None;
    for Other { ids: of, listed, note, .. } in others(registry) {
        if kind.replace(of) != Some(of) {
            let _ = writeln!(text, "\n{}s", capitalised(of.name()));
        }
        let line = format!("  {:ids$}  {:names$}  {note}", listed.id, listed.name);
        let _ = writeln!(text, "{}\n  {:ids$}  {}", line.trim_end(), "", listed.summary);
        parameters(&mut text, ids, listed.parameters);
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
        let (Parameter { name, label, .. }, rule, default) = (p, p.rule(), p.default_value());
        let _ = writeln!(text, "  {:ids$}    {name} ({label}){unit}: {rule}, default {default}{used}", "");
    }
}
