//! `lcm materials`: the library of materials as a list, as JSON, and as a sheet of pictures.

use std::{fmt::Write as _, path::PathBuf, time::Duration};

use clap::Args;
use serde_json::{Value as Json, json};
use web_time::Instant;

use super::{
    Options, Outcome, complain, gauged, outputs, print_json, print_text,
    render::cpu_can_draw,
    workshop::{Workshop, drawable},
};
use crate::files::{Shown as _, printable_line};
use crate::{
    caption::Part as Words,
    failure::Failure,
    materials::{Library, Material, Origin, beside},
    parameter::json as value,
    picture::png::About,
    registry::Registry,
    sweep::{MAX_PIXELS, Page},
    text::{plural, quoted},
};

/// Maximum time for one picture; the slowest of the program takes a small part of it.
const PATIENCE: Duration = Duration::from_secs(600);

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Only materials with all of these words in their name, description, source or model
    #[arg(value_name = "WORDS")]
    words: Vec<String>,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
    /// PNG file for a sheet of pictures: a sphere of each material, under one light for all
    #[arg(long, short, value_name = "FILE", value_parser = outputs::place())]
    output: Option<PathBuf>,
    /// Width and height of each picture, in pixels
    #[arg(long, value_name = "PIXELS", default_value = "160", value_parser = side)]
    size: u32,
}

/// Parser of the size of the pictures.
fn side(text: &str) -> Result<u32, String> {
    let side = text.trim().parse().ok().filter(|side| (16..=1024).contains(side));
    side.ok_or_else(|| "it must be a whole number of pixels from 16 to 1024".to_owned())
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let folder = workshop.registry.custom_folder().map(beside);
    workshop.list();
    let mut library = Library::read(folder.as_deref(), &workshop.registry);
    if arguments.output.is_some() {
        // Pictures need the whole models.
        for material in library.materials.iter().filter(|m| matches!(m.origin, Origin::File(_))) {
            workshop.need(&material.reflection_model);
        }
        library = Library::read(folder.as_deref(), &workshop.registry);
    }
    library.broken.iter().for_each(complain);
    let words = arguments.words.join(" ");
    let materials: Vec<_> = library.materials.iter().filter(|m| m.matches(&words)).collect();
    if materials.is_empty() {
        return Err(Failure::Usage(format!("no material has the words {}", quoted(&words))));
    }
    let registry = &workshop.registry;
    let undrawn = match &arguments.output {
        Some(_) => sheet(arguments, &materials, options, registry)?,
        None => 0,
    };
    if arguments.json {
        print_json(&materials.iter().map(|material| as_json(material, registry)).collect::<Json>())?;
    } else if arguments.output.is_none() {
        print_text(&table(&materials, registry))?;
    }
    if library.broken.is_empty() && undrawn == 0 { Ok(()) } else { Err(Failure::Invalid(String::new())) }
}

/// Draws the sheet. Returns the number of materials that cannot be drawn, which are reported.
fn sheet(
    arguments: &Arguments,
    materials: &[&Material],
    options: Options,
    registry: &Registry,
) -> Result<usize, Failure> {
    let Some(output) = &arguments.output else { return Ok(0) };
    let files: Vec<_> = materials.iter().filter_map(|m| file(m).cloned()).collect();
    outputs::picture(output, &files)?;
    let pixels = u64::from(arguments.size).pow(2) * materials.len() as u64;
    if pixels > MAX_PIXELS {
        let count = plural(materials.len(), "picture");
        return Err(Failure::Usage(format!(
            "{count} of that size are too many for a sheet; choose a smaller --size, or words"
        )));
    }
    outputs::tidy_beside(output);
    let (mut labels, mut pictures) = (Vec::new(), Vec::new());
    gauged("drawing materials", options, |progress| {
        for (i, material) in materials.iter().enumerate() {
            (progress.tell)(i as f32 / materials.len() as f32, &material.name);
            let scene = material.scene(registry);
            let possible = drawable(registry, &scene).and_then(|()| cpu_can_draw(&scene, registry));
            let drawn = match possible {
                Ok(()) => material
                    .picture(arguments.size, registry, Instant::now() + PATIENCE)
                    .ok_or_else(|| format!("it takes more than {} minutes", PATIENCE.as_secs() / 60)),
                Err(failure) => Err(failure.to_string()),
            };
            match drawn {
                Ok(picture) => {
                    labels.push(vec![Words::new(0, material.name.as_str())]);
                    pictures.push(picture);
                }
                Err(why) => complain(format_args!("{} was not drawn: {why}", quoted(&material.name))),
            }
        }
    });
    if pictures.is_empty() {
        return Err(Failure::Invalid(String::new()));
    }
    let page = Page::labelled(&labels, [arguments.size; 2]);
    let sheet = page.compose(&pictures, &[], None);
    outputs::write_picture(output, page.size(), &sheet, &About::program().with("Title", "Materials"))?;
    options.tell(format_args!("wrote {}: {}", output.shown(), plural(pictures.len(), "material")));
    Ok(materials.len() - pictures.len())
}

/// The file of a material of the user.
fn file(material: &Material) -> Option<&PathBuf> {
    match &material.origin {
        Origin::File(path) => Some(path),
        Origin::Preset | Origin::Measured => None,
    }
}

/// A material as JSON, with a value for every parameter of its model.
fn as_json(material: &Material, registry: &Registry) -> Json {
    let values = material.values(registry);
    let values: serde_json::Map<_, _> =
        values.0.iter().map(|(name, given)| (name.to_string(), value(given))).collect();
    let mut json = json!({
        "name": material.name,
        "kind": match material.origin {
            Origin::File(_) => "own",
            Origin::Preset => "preset",
            Origin::Measured => "measured",
        },
        "description": material.description,
        "source": material.source,
        "reflection_model": material.reflection_model,
        "material": values,
    });
    if let Some(path) = file(material) {
        json["file"] = path.display().to_string().into();
    }
    json
}

/// Materials as text: those given values that differ from the defaults of the model.
fn table(materials: &[&Material], registry: &Registry) -> String {
    let names: Vec<_> = materials.iter().map(|m| printable_line(&m.name)).collect();
    let width = names.iter().map(|name| name.chars().count()).max().unwrap_or_default();
    let (mut text, mut heading) = (String::new(), "");
    for (material, name) in materials.iter().zip(&names) {
        let next = material.origin.heading();
        if heading != next {
            let gap = if text.is_empty() { "" } else { "\n" };
            // Writing to a String cannot fail, here and below.
            let _ = writeln!(text, "{gap}{next}");
            heading = next;
        }
        let model = &material.reflection_model;
        let parameters = registry.model(model).map_or(&[][..], |model| model.parameters);
        let values: Vec<_> = parameters
            .iter()
            .map(|p| (p.name, material.material.get(p), p.default_value()))
            .filter(|(_, value, default)| value != default)
            .map(|(name, value, _)| format!("{name} {value}"))
            .collect();
        let values = if values.is_empty() { "defaults".to_owned() } else { values.join(", ") };
        let _ = writeln!(text, "  {name:width$}  {model}: {values}");
        let about = [&material.description, &material.source].into_iter().flatten();
        let about = about.flat_map(|text| text.lines()).map(str::to_owned);
        for line in about.chain(file(material).map(|path| path.shown().to_string())) {
            let _ = writeln!(text, "  {:width$}  {line}", "");
        }
    }
    text
}
