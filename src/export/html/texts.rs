//! Texts that have much in common: each part is stored once.

use std::collections::HashMap;

use serde_json::{Value as Json, json};

/// The parts of all texts.
#[derive(Debug, Default)]
pub struct Texts {
    parts: Vec<String>,
    known: HashMap<String, usize>,
}

impl Texts {
    /// Adds a text, and returns the indices of the parts that it consists of. Shaders that differ in a model
    /// or a shading model share most of their functions, and a function ends with a brace on its own line.
    pub fn add(&mut self, text: &str) -> Vec<usize> {
        let mut parts = Vec::new();
        let mut rest = text;
        while !rest.is_empty() {
            let end = ["\n}\n", "\n};\n"].iter().filter_map(|end| Some(rest.find(end)? + end.len())).min();
            let (part, after) = rest.split_at(end.unwrap_or(rest.len()));
            parts.push(self.part(part));
            rest = after;
        }
        parts
    }

    fn part(&mut self, part: &str) -> usize {
        if let Some(known) = self.known.get(part) {
            return *known;
        }
        self.parts.push(part.to_owned());
        self.known.insert(part.to_owned(), self.parts.len() - 1);
        self.parts.len() - 1
    }

    /// The parts.
    #[must_use]
    pub fn json(&self) -> Json {
        json!(self.parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_come_back_and_common_parts_are_kept_once() {
        let mut texts = Texts::default();
        let all = ["a\n{\n}\nb\n{\n}\nend", "a\n{\n}\nc\n{\n};\n", "", "end"];
        let indices = all.map(|text| texts.add(text));
        for (text, indices) in all.iter().zip(&indices) {
            assert_eq!(&indices.iter().map(|i| texts.parts[*i].as_str()).collect::<String>(), text);
        }
        assert_eq!(texts.parts.len(), 4);
    }
}
