//! From JSON to a [`Material`].

use std::path::Path as FilePath;

use super::{MAX_PROBLEMS, Material, Origin};
use crate::{
    parameter::{Outside, Parameter, Values},
    registry::Registry,
    scene::{
        error::{Path, Problem},
        field::Ids,
        syntax::check_syntax,
    },
    text::{
        after_mark,
        json::{self, Cursor, Fields, ObjectProp, Reader as _, STRICT},
        place::Lines,
        plural,
    },
};
use jsonc_parser::common::Ranged as _;

/// The keys of a file.
const KEYS: [&str; 5] = ["name", "description", "source", "reflection_model", "material"];

/// A material from the content of a file; linear in its length.
///
/// # Errors
/// Returns every mistake, at most [`MAX_PROBLEMS`] of them: line and column, the key, the value and the rule.
pub fn from_bytes(bytes: &[u8], registry: &Registry) -> Result<Material, Vec<String>> {
    let bytes = after_mark(bytes);
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let before = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
        let place = Lines::new(&before).place(before.len());
        let byte = bytes.get(error.valid_up_to()).copied().unwrap_or_default();
        vec![format!("{place}: the byte 0x{byte:02x} is not UTF-8; save the file as UTF-8")]
    })?;
    if text.trim().is_empty() {
        return Err(vec![format!("the file is empty; a material has the keys {}", KEYS.join(", "))]);
    }
    let lines = Lines::new(text);
    let not_json = |(at, what): (usize, String)| vec![format!("{}: not JSON: {what}", lines.place(at))];
    check_syntax(text).map_err(not_json)?;
    let root = json::parse(text, &STRICT).map_err(not_json)?;
    let mut reader = Reader { text, lines: Lines::new(text), known: &[], problems: Vec::new(), unlisted: 0 };
    let material = root.as_ref().and_then(|root| reader.material(Cursor::root(root), registry));
    if reader.unlisted > 0 {
        reader.problems.push(format!("and {}", plural(reader.unlisted, "more problem")));
    }
    match material {
        Some(material) if reader.problems.is_empty() => Ok(material),
        _ => Err(reader.problems),
    }
}

/// The state of reading.
struct Reader<'a> {
    text: &'a str,
    lines: Lines<'a>,
    /// The parameters of the model, for suggestions.
    known: &'static [Parameter],
    problems: Vec<String>,
    /// The number of problems beyond [`MAX_PROBLEMS`].
    unlisted: usize,
}

impl Reader<'_> {
    fn material(&mut self, root: Cursor, registry: &Registry) -> Option<Material> {
        let fields = self.fields(root, &KEYS, "a material")?;
        let name = self.required(&fields, "name", "a material must have a name, a text that is not empty");
        let [description, source] = ["description", "source"].map(|key| {
            let value = fields.get(key)?;
            let text = self.string(value, &format!("the {key} must be text"))?;
            (!text.trim().is_empty()).then(|| text.to_owned())
        });
        let id = self.required(&fields, "reflection_model", "a material must name its reflection model")?;
        let model = registry.model(&id);
        if let (Err(rule), Some(value)) =
            (Ids::ReflectionModel.check(registry, &id), fields.get("reflection_model"))
        {
            self.wrong(value, &rule);
        }
        let Some(given) = fields.get("material") else {
            self.lacking(&fields, "material", "a material must have an object with values of parameters");
            return None;
        };
        // Without the model nothing is known about the parameters.
        let model = model?;
        let material = self.values(given, model.parameters);
        Some(Material {
            name: name?,
            description,
            source,
            reflection_model: id,
            material,
            origin: Origin::Preset,
        })
    }

    /// A text that must be there.
    fn required(&mut self, fields: &Fields, key: &'static str, rule: &str) -> Option<String> {
        let Some(value) = fields.get(key) else {
            self.lacking(fields, key, rule);
            return None;
        };
        let text = self.string(value, rule)?;
        if text.trim().is_empty() {
            self.wrong(value, rule);
            return None;
        }
        Some(text.to_owned())
    }

    /// The values of a model's parameters.
    fn values(&mut self, given: Cursor, parameters: &'static [Parameter]) -> Values {
        self.known = parameters;
        let names: Vec<_> = parameters.iter().map(|p| p.name).collect();
        let fields = self.fields(given, &names, "the material of this model");
        let mut values = Values::default();
        for (key, value) in fields.iter().flat_map(Fields::iter) {
            let Some(parameter) = parameters.iter().find(|p| p.name == key) else { continue };
            // No parameter of a model is a file; if one were, it would be in no folder.
            let place = (FilePath::new(""), Outside::NONE);
            let Some(read) = parameter.kind.read(self, value, &parameter.clause(), place) else { continue };
            if parameter.allows(&read) {
                values.set(parameter.name, read);
            } else {
                self.wrong(value, &parameter.clause());
            }
        }
        values
    }
}

impl json::Reader for Reader<'_> {
    fn text(&self) -> &str {
        self.text
    }

    fn report(&mut self, at: usize, path: Path, found: Option<String>, rule: &str) {
        if self.has_enough() {
            self.unlisted += 1;
            return;
        }
        let what = if path.segments().is_empty() { "the file".to_owned() } else { path.to_string() };
        let message = Problem { place: None, path, found, rule: rule.to_owned() }.message();
        self.problems.push(format!("{}: {what} {message}", self.lines.place(at)));
    }

    fn has_enough(&self) -> bool {
        self.problems.len() >= MAX_PROBLEMS
    }

    fn twice(&self, first: &ObjectProp, _again: &ObjectProp) -> String {
        format!("; first given at {}", self.lines.place(first.start()))
    }

    fn hint(&mut self, written: &str, known: &[&'static str], what: &str) -> String {
        let labels = self.known.iter().flat_map(|p| [(p.label, p.name), (p.symbol, p.name)]);
        json::nearest_key(written, known, labels, what)
    }
}
