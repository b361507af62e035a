//! New files for custom models: a commented template, and copies of existing models.

use std::fmt::Write as _;

use serde_json::{Value as Json, json};

use super::{
    declaration::written,
    source_path,
    text::{LONGEST_ID, MARKER, comment, humanised, identifier},
};
use crate::{
    parameter::{Parameter, json as json_of},
    reflection::{Ambient, ModelEntry},
    registry::Registry,
    shader::compose::Sources,
};

/// The reason why a model could not be copied to a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotDuplicated {
    /// The id of the copy is invalid.
    #[error("{id} cannot be the id of a model: it {rule}")]
    Id {
        /// The id.
        id: String,
        /// The rule that it breaks.
        rule: String,
    },
    /// The model has a parameter that names a file, which those of custom models cannot.
    #[error("{id} reads a file, which custom models cannot; write one that has its equation instead")]
    File {
        /// The id of the model.
        id: &'static str,
    },
}

/// A name without a valid identifier.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a name must begin with a letter and have only letters a–z, digits and spaces, at most {LONGEST_ID}{}",
    .instead.as_ref().map_or_else(String::new, |id| format!("; for example {id}"))
)]
pub struct BadName {
    /// A similar, valid identifier.
    pub instead: Option<String>,
}

/// The identifier for a model's name: `Student toon (2)` becomes `student_toon_2`. Spaces and punctuation
/// become underscores. Letters beyond a–z, dots and slashes are errors, with a suggestion.
///
/// # Errors
/// Returns the rule that the name breaks, and a suggestion.
pub fn id_of_name(name: &str) -> Result<String, BadName> {
    let name = name.trim();
    if identifier(name).is_ok() {
        return Ok(name.to_owned());
    }
    let id = joined(name);
    let plain =
        |c: char| c.is_ascii_alphanumeric() || c == ' ' || c.is_ascii_punctuation() && !"./\\".contains(c);
    if identifier(&id).is_ok() && name.chars().all(plain) {
        return Ok(id);
    }
    let near: String = joined(&latin(name)).chars().skip_while(|c| !c.is_ascii_lowercase()).collect();
    let near: String = near.chars().take(LONGEST_ID).collect();
    let near = near.trim_end_matches('_');
    Err(BadName { instead: identifier(near).is_ok().then(|| near.to_owned()) })
}

/// A name in the letters a–z: umlauts in German transliteration, other letters by sound.
fn latin(name: &str) -> String {
    let umlauts = [('ä', "ae"), ('ö', "oe"), ('ü', "ue"), ('Ä', "Ae"), ('Ö', "Oe"), ('Ü', "Ue")];
    let name = umlauts.iter().fold(name.to_owned(), |name, (letter, two)| name.replace(*letter, two));
    deunicode::deunicode(&name)
}

/// Lower case, with one underscore for anything between letters and digits.
fn joined(name: &str) -> String {
    let lower = name.to_lowercase();
    let words = lower.split(|c: char| !c.is_ascii_alphanumeric());
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join("_")
}

/// A commented template, valid as it is: a matte base under a soft gloss, obeying all laws.
#[must_use]
pub fn template(id: &str, name: &str) -> String {
    let name = if name == id { humanised(id) } else { name.to_owned() };
    include_str!("template.wgsl").replace("NAME", &text(&name)).replace("FILE", &source_path(id))
}

/// A copy of a model as the text of a file with this id: same picture, same parameters. `name` is the display
/// name of the copy; if it equals the id, a name is derived from it.
///
/// # Errors
/// Returns an error if the id is invalid, or if the model reads a file.
pub fn duplicate(
    entry: &ModelEntry,
    sources: &Sources,
    id: &str,
    name: &str,
) -> Result<String, NotDuplicated> {
    identifier(id).map_err(|rule| NotDuplicated::Id { id: id.to_owned(), rule })?;
    let d = entry.declaration;
    if entry.file().is_some() {
        return Err(NotDuplicated::File { id: d.id });
    }
    let source = sources.text(&d.wgsl);
    // Everything in a file is copied except the declaration, which is rewritten.
    let body = comment(source).map_or(source, |c| &source[c.end..]).trim_start();
    let name = match name {
        name if name != id => name.to_owned(),
        _ if id == format!("{}_copy", d.id) => format!("{} (copy)", d.name),
        _ => humanised(id),
    };
    // Writing to a String cannot fail, here and below.
    let mut out = format!("/* {MARKER}\n{{\n");
    for (key, value) in
        [("name", name.as_str()), ("author", d.author), ("source", d.source), ("summary", d.summary)]
    {
        let _ = writeln!(out, "    \"{key}\": {},", text(value));
    }
    out.push_str("    \"equation\": [\n");
    if d.solid {
        out.push_str(
            "    // A model in a file is a surface: the path inside the body is not part of the copy.\n",
        );
    }
    for part in d.equation.iter().filter(|part| !part.along_path) {
        let (term, text) = (part.term.id(), text(part.text));
        let _ = writeln!(out, "        {{ \"term\": \"{term}\", \"text\": {text} }},");
    }
    out.push_str("    ],\n");
    let laws: Vec<_> = d.laws.list().into_iter().filter(|(_, kept)| *kept).map(|(name, _)| name).collect();
    let _ = writeln!(out, "    \"laws\": {},", spaced(&json!(laws)));
    let _ = writeln!(out, "    \"anisotropic\": {},", d.anisotropic);
    if d.transmits {
        let _ = writeln!(out, "    \"transmits\": true,");
    }
    if d.lit_from_below {
        let _ = writeln!(out, "    \"lit_from_below\": true,");
    }
    if d.boundary {
        let _ = writeln!(out, "    \"boundary\": true,");
    }
    if let Some(lobe) = entry.lobe_of() {
        let _ =
            writeln!(out, "    // The shader reads the albedo of the lobe, or the curves, of this model.");
        let _ = writeln!(out, "    \"lobe\": \"{lobe}\",");
    }
    // Only for models from files: the declaration does not keep the source text of their settings.
    let in_file = comment(source).ok();
    for key in ["lobes", "curves"] {
        if let Some(text) = in_file.as_ref().and_then(|c| written(c.json, key)) {
            let _ = writeln!(out, "    \"{key}\": {text},");
        }
    }
    if Registry::builtin().model(d.id).is_some() {
        out.push_str("    // Light with extent is sampled as for this model.\n");
        let _ = writeln!(out, "    \"lobes\": \"{}\",", d.id);
    }
    out.push_str("    \"parameters\": [\n");
    let built_in = Registry::builtin();
    for p in entry.parameters {
        let users = built_in.models().iter().filter(|m| m.parameter(p.name).is_some()).count();
        let same = |shared: &Parameter| Parameter { used_when: None, ..shared.clone() } == *p;
        if users > 1 && built_in.material_parameter(p.name).is_some_and(same) {
            let _ = writeln!(out, "        \"{}\",", p.name);
        } else {
            declare(&mut out, p);
        }
    }
    out.push_str("    ],\n");
    if !entry.groups.is_empty() {
        out.push_str("    \"groups\": {\n");
        for group in entry.groups {
            let _ = writeln!(out, "        {}: {},", text(group.name), spaced(&json!(group.parameters)));
        }
        out.push_str("    },\n");
    }
    out.push_str("}\n*/\n\n");
    if d.ambient == Ambient::Albedo {
        out.push_str(
            "// The model answers uniform light by its directional albedo, which is calculated.\n\n",
        );
    }
    out.push_str(body);
    if !out.ends_with('\n') {
        out.push('\n');
    }
    Ok(out)
}

/// A text in JSON, without anything that begins or ends a comment.
fn text(text: &str) -> String {
    Json::from(text).to_string().replace("*/", "*\\/").replace("/*", "\\/*")
}

/// JSON on one line, with spaces in the usual places.
fn spaced(json: &Json) -> String {
    match json {
        Json::Array(list) => {
            let items: Vec<_> = list.iter().map(spaced).collect();
            format!("[{}]", items.join(", "))
        }
        other => other.to_string(),
    }
}

/// A parameter with its complete declaration.
fn declare(out: &mut String, p: &Parameter) {
    let [symbol, label, unit] = [p.symbol, p.label, p.unit].map(text);
    let named = format!("\"name\": \"{}\", \"symbol\": {symbol}, \"label\": {label}", p.name);
    let kind = p.kind.name();
    let _ = writeln!(out, "        {{\n            {named}, \"unit\": {unit}, \"type\": \"{kind}\",");
    let mut range = String::new();
    for (key, value) in p.kind.keys() {
        match key {
            "choices" => {
                let options = p.kind.options().iter();
                let lines: String = options
                    .map(|(id, name)| format!("                \"{id}\": {},\n", text(name)))
                    .collect();
                let _ = write!(range, "\"{key}\": {{\n{lines}            }},\n            ");
            }
            _ if value.is_null() => {}
            _ => _ = write!(range, "\"{key}\": {value}, "),
        }
    }
    if let Some(condition) = p.used_when {
        let choices = spaced(&json!(condition.choices));
        let _ = writeln!(out, "            \"used_when\": {{ \"{}\": {choices} }},", condition.parameter);
    }
    if let Some(meaning) = p.stands_for {
        let _ = writeln!(out, "            \"stands_for\": \"{}\",", meaning.id);
    }
    let _ = writeln!(out, "            {range}\"default\": {},", spaced(&json_of(&p.default_value())));
    let _ = writeln!(out, "            \"help\": {},\n        }},", text(p.help));
}
