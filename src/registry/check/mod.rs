//! Checks of registered types. Each names the error and the remedy; the caller adds the type and its id.

pub mod mesh;
pub(crate) mod wgsl;

use std::collections::HashSet;

use super::{LIGHT_KEYS, MODELS, OBJECT_KEYS, Registry, WINDOW_KEYS, light_set::MAX_LIGHT_TYPES};
use crate::{
    light::LightEntry,
    optics::colour::Encoding,
    parameter::{BLOCK_BYTES, Parameter, ParameterKind, Values, layout},
    reflection::{Group, ModelEntry, usage},
    shader::{
        Source,
        compose::{OPTICS, TRANSMISSION},
        definitions::allowed_in_wgsl,
    },
    shading::{PARAMETER_WORDS, ShadingEntry},
    shape::ShapeEntry,
    text::{
        identifier::{as_identifier, identifier},
        with_article,
    },
};

type Check = Result<(), String>;

/// The units of light types.
const UNITS: [&str; 4] = ["cd", "lx", "cd/m²", "×"];
/// Names of a light and an object of a scene file in messages.
const LIGHT: &str = "a light";
const OBJECT: &str = "an object";
/// JSON's literals.
const JSON_WORDS: [&str; 3] = ["true", "false", "null"];

fn ensure(right: bool, otherwise: impl FnOnce() -> String) -> Check {
    if right { Ok(()) } else { Err(otherwise()) }
}

/// Checks an id or the name of a parameter.
fn name(name: &str) -> Check {
    identifier(name).map_err(|rule| match as_identifier(name) {
        Some(meant) => format!("{rule}; for example {meant}"),
        None => rule,
    })?;
    ensure(allowed_in_wgsl(name) && !JSON_WORDS.contains(&name), || {
        "is a reserved word in WGSL or JSON; choose another".to_owned()
    })
}

/// Checks an id and a display name.
pub(super) fn identity(id: &str, shown: &str) -> Check {
    name(id).map_err(|what| format!("the id {what}"))?;
    ensure(!shown.trim().is_empty(), || "the name is empty; it is what people read in lists".to_owned())
}

/// Checks a number of a declaration.
fn positive(what: &str, number: f32) -> Check {
    ensure(number.is_finite() && number > 0.0, || format!("{what} is {number}, but must be greater than 0"))
}

/// Checks declarations of parameters; `reserved` are the other keys of their part of the scene, and `files`
/// is true if they may be files.
pub(super) fn parameters(all: &[Parameter], reserved: &[&str], part: &str, files: bool) -> Check {
    let mut known = HashSet::new();
    for p in all {
        let of = |what: String| format!("parameter `{}`: {what}", p.name);
        name(p.name).map_err(|what| of(format!("the name {what}")))?;
        ensure(known.insert(p.name), || of("is declared twice; names must differ".to_owned()))?;
        ensure(!reserved.contains(&p.name), || {
            of(format!("the name is that of another key of {part} in scene files; choose another"))
        })?;
        ensure(files || p.kind.format().is_none(), || {
            of("is a file, which shading models may not have".to_owned())
        })?;
        kind(p).map_err(of)?;
        if let Some(problem) = usage::problem(all, p) {
            return Err(of(format!("used_when: {problem}")));
        }
    }
    Ok(())
}

/// Checks the range and the default of a parameter.
fn kind(p: &Parameter) -> Check {
    p.kind.check()?;
    // The numbers of a file are checked by `shipped_files`, since reading takes time.
    let default = p.default_value();
    ensure(p.kind.format().is_some() || p.allows(&default), || {
        format!("its default is {default}, but must be {}", p.rule())
    })
}

/// Checks that the files that are defaults of parameters can be read.
pub(super) fn shipped_files(all: &[Parameter]) -> Check {
    all.iter().filter(|p| p.kind.format().is_some()).try_for_each(|p| {
        let default = p.default_value();
        ensure(p.allows(&default), || {
            format!("parameter `{}`: its default is {default}, but must be {}", p.name, p.rule())
        })
    })
}

/// Checks the path of a shader: it names one text.
fn path(registry: &Registry, source: &Source, replaced: Option<&str>) -> Check {
    let is = |what: &str| format!("the path of its shader is \"{}\", {what}", source.path);
    let plain = source.path.ends_with(".wgsl")
        && !source.path.starts_with(MODELS)
        && source.path.split('/').all(|part| !matches!(part, "" | "." | "..") && !part.starts_with('('));
    ensure(plain, || is("but must be a path below the folder of shaders such as \"light/lamp.wgsl\""))?;
    let others = OPTICS.iter().chain(TRANSMISSION).copied().chain(super::compose::SHARED);
    let of_parts = registry.parts().filter(|(id, _)| replaced != Some(*id)).map(|(_, source)| source);
    let differs = |other: Source| other.path == source.path && other.text != source.text;
    ensure(!others.chain(of_parts).any(differs), || {
        is("which is that of another shader; each needs a path of its own")
    })
}

/// Checks that each parameter has a label: raw names are for files.
fn labels(all: &[Parameter]) -> Check {
    all.iter().try_for_each(|p| {
        ensure(!p.label.trim().is_empty() && (p.label != p.name || !p.name.contains('_')), || {
            let words = p.name.replace('_', " ");
            format!("parameter `{}`: has no label for people to read; add .label(\"{words}\")", p.name)
        })
    })
}

/// Checks the parameters of a reflection or shading model: in materials, parameters with the same name are
/// shared.
fn of_material(
    all: &[Parameter],
    others: impl Iterator<Item = (&'static str, &'static [Parameter])> + Clone,
) -> Check {
    shared(all, "models", others.clone())?;
    for p in all {
        let clash = |(id, all): (&'static str, &'static [Parameter])| {
            all.iter().filter(|other| other.name == p.name).find_map(|other| Some((id, p.clash(other)?)))
        };
        if let Some((id, (own, theirs))) = others.clone().find_map(clash) {
            return Err(format!(
                "parameter `{}`: is {own}, but that of `{id}` is {theirs}; models share parameters by name, so they must \
                 have one unit: use that, or another name",
                p.name
            ));
        }
    }
    labels(all)
}

/// Checks parameters, and that their types equal those of parameters with the same names in similar parts.
fn shared(
    all: &[Parameter],
    sort: &str,
    others: impl Iterator<Item = (&'static str, &'static [Parameter])> + Clone,
) -> Check {
    let end = layout(all).last().map_or(0, |f| f.2 + 12);
    ensure(end <= BLOCK_BYTES, || format!("its parameters take {end} bytes, but at most {BLOCK_BYTES} fit"))?;
    for p in all {
        let differs = |other: &&Parameter| other.name == p.name && other.kind.name() != p.kind.name();
        let other = others.clone().find_map(|(id, all)| Some((id, all.iter().find(differs)?)));
        if let Some((id, other)) = other {
            return Err(format!(
                "parameter `{}`: is {}, but that of `{id}` is {}; {sort} share parameters by name, so they must have \
                 one type: use that, or another name",
                p.name,
                with_article(p.kind.name()),
                with_article(other.kind.name())
            ));
        }
    }
    Ok(())
}

/// Checks that a model has one buffer besides its parameters: the numbers of a file, or the mesh of a solid body.
fn one_file(entry: &ModelEntry) -> Check {
    let files: Vec<_> = entry.parameters.iter().filter(|p| p.kind.format().is_some()).collect();
    let [first, rest @ ..] = &files[..] else { return Ok(()) };
    let is = |why: &str| format!("parameter `{}`: is a file, but {why}", rest.first().unwrap_or(first).name);
    ensure(rest.is_empty(), || is("a reflection model may have only one"))?;
    ensure(!entry.passages().iter().any(|passage| passage.solid), || {
        is("a model of a solid body may not have any")
    })
}

/// Checks a reflection model.
pub(super) fn reflection_model(registry: &Registry, entry: &ModelEntry) -> Check {
    let d = entry.declaration;
    identity(d.id, d.name)?;
    parameters(entry.parameters, OBJECT_KEYS, OBJECT, true)?;
    one_file(entry)?;
    if let Some((_, problem)) = Group::problem(entry.groups, entry.parameters) {
        return Err(problem);
    }
    let models = registry.models().iter().filter(|m| m.declaration.id != d.id);
    let shadings = registry.shading_models().iter().map(|s| (s.declaration.id, s.parameters));
    of_material(entry.parameters, models.map(|m| (m.declaration.id, m.parameters)).chain(shadings))?;
    path(registry, &d.wgsl, registry.model(d.id).map(|m| m.declaration.id))
}

/// Checks a shading model.
pub(super) fn shading_model(registry: &Registry, entry: &ShadingEntry) -> Check {
    let d = entry.declaration;
    identity(d.id, d.name)?;
    parameters(entry.parameters, OBJECT_KEYS, OBJECT, false)?;
    let models = registry.models().iter().map(|m| (m.declaration.id, m.parameters));
    let shadings = registry.shading_models().iter().filter(|s| s.declaration.id != d.id);
    of_material(entry.parameters, models.chain(shadings.map(|s| (s.declaration.id, s.parameters))))?;
    let words = crate::parameter::words(entry.parameters, &Values::default(), Encoding::default()).len();
    ensure(words <= PARAMETER_WORDS, || {
        format!(
            "its parameters take {words} numbers, but at most {PARAMETER_WORDS} fit; a colour takes three"
        )
    })?;
    let is = |what: String| format!("its key is '{}', {what}", d.key);
    ensure(d.key.is_ascii_uppercase(), || is("but must be a letter from A to Z".to_owned()))?;
    ensure(!WINDOW_KEYS.contains(&d.key), || {
        let others = registry.shading_models().iter().map(|s| s.declaration.key);
        let taken: HashSet<_> = WINDOW_KEYS.iter().copied().chain(others).collect();
        let free: String = ('A'..='Z').filter(|key| !taken.contains(key)).collect();
        is(format!("which the window uses already; available are {free}"))
    })?;
    let mut others = registry.shading_models().iter().filter(|s| s.declaration.id != d.id);
    if let Some(other) = others.find(|s| s.declaration.key == d.key) {
        return Err(is(format!("which is that of `{}`; choose another", other.declaration.id)));
    }
    path(registry, &d.wgsl, registry.shading_model(d.id).map(|s| s.declaration.id))
}

/// Checks a light type.
pub(super) fn light_type(registry: &Registry, entry: &LightEntry) -> Check {
    let d = entry.declaration;
    identity(d.id, d.name)?;
    parameters(entry.parameters, LIGHT_KEYS, LIGHT, true)?;
    let others = registry.lights().iter().filter(|l| l.declaration.id != d.id);
    shared(entry.parameters, "light types", others.map(|l| (l.declaration.id, l.parameters)))?;
    labels(entry.parameters)?;
    ensure(UNITS.contains(&d.unit), || {
        format!(
            "its unit is \"{}\", but must be cd or lx, for lights with a position and without, cd/m² for lights with \
             extent, or × for a factor",
            d.unit
        )
    })?;
    positive("its default intensity", d.default_intensity)?;
    positive("the end of the slider for its intensity", d.slider_max)?;
    let sizes = d.sizes.iter().map(|size| ("size", size.parameter()));
    let others = [("cone", d.cone_parameter), ("roll", d.roll_parameter)];
    for (what, name) in others.into_iter().filter_map(|(what, name)| Some((what, name?))).chain(sizes) {
        let number = |p: &Parameter| matches!(p.kind, ParameterKind::Number(_));
        ensure(entry.parameter(name).is_some_and(number), || {
            format!("its {what} is parameter `{name}`, but must be a parameter of type number")
        })?;
    }
    ensure(d.sizes.is_empty() || d.has_position, || {
        "it has sizes, but no position around which they lie; `.at_position()` gives it one".to_owned()
    })?;
    let directed = d.sizes.iter().find(|size| size.needs_direction()).map(|size| size.parameter());
    if let Some(name) = directed.or(d.roll_parameter).filter(|_| !d.has_direction) {
        return Err(format!(
            "`{name}` is measured by its direction, but it has none; `.with_direction()` gives it one"
        ));
    }
    let known = registry.light(d.id).is_some();
    ensure(known || registry.lights().len() < MAX_LIGHT_TYPES, || {
        format!("there are already {MAX_LIGHT_TYPES} light types, the most allowed")
    })?;
    path(registry, &d.wgsl, registry.light(d.id).map(|l| l.declaration.id))
}

/// Checks the declaration of an object type.
pub(super) fn object_type(registry: &Registry, entry: &ShapeEntry) -> Check {
    let d = entry.declaration;
    identity(d.id, d.name)?;
    parameters(entry.parameters, OBJECT_KEYS, OBJECT, true)?;
    let others = registry.shapes().iter().filter(|s| s.declaration.id != d.id);
    shared(entry.parameters, "object types", others.map(|s| (s.declaration.id, s.parameters)))?;
    labels(entry.parameters)?;
    let (least, most) = (*d.tessellation.start(), *d.tessellation.end());
    ensure(1 <= least && least <= most, || {
        format!("its tessellations are {least} to {most}, but must be at least 1, the smaller one first")
    })?;
    ensure(d.tessellation.contains(&d.default_tessellation), || {
        format!("its default tessellation is {}, but must be from {least} to {most}", d.default_tessellation)
    })
}

/// Checks the meshes of an object type: at both ends of its tessellations and at the default, and with each
/// parameter at both ends of its range.
pub(super) fn meshes(entry: &ShapeEntry) -> Check {
    let d = entry.declaration;
    let check = |values: &Values, tessellation: u32| {
        mesh::check(&entry.mesh(values, tessellation)).map_err(|what| {
            let set: Vec<_> = values.0.iter().map(|(name, value)| format!(" with {name} {value}")).collect();
            format!("the mesh of tessellation {tessellation}{}: {what}", set.concat())
        })
    };
    let mut all = vec![d.default_tessellation, *d.tessellation.start(), *d.tessellation.end()];
    all.dedup();
    all.into_iter().try_for_each(|tessellation| check(&Values::default(), tessellation))?;
    let ends = entry.parameters.iter().flat_map(|p| p.ends().into_iter().map(move |end| (p.name, end)));
    ends.into_iter()
        .try_for_each(|(name, end)| check(&Values([(name.into(), end)].into()), d.default_tessellation))
}
