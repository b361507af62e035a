//! The declarations in a WGSL text, and the ones that a program uses.

use std::collections::{BTreeMap, BTreeSet};

use crate::shader::definitions::{block_comment, comment};

/// A top-level declaration in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// The declared name.
    pub name: String,
    /// The text, with the comments directly above it.
    pub text: String,
}

impl Item {
    /// The names in it that may refer to other items. A name after a dot is a field.
    fn uses(&self) -> BTreeSet<&str> {
        words(&self.text).into_iter().filter(|(_, field)| !field).map(|(word, _)| word).collect()
    }
}

/// The declarations in a text, in order. Free-standing comments are dropped, and so is anything that is not a
/// declaration.
#[must_use]
pub fn items(text: &str) -> Vec<Item> {
    let bytes = text.as_bytes();
    let mut items = Vec::new();
    let mut at = 0;
    // The start of the comments directly above the next declaration.
    let mut begin = None;
    while at < bytes.len() {
        let rest = &text[at..];
        if rest.starts_with("/*") {
            // Declarations of custom models are such comments.
            at = block_comment(text, at).unwrap_or(text.len());
            begin = None;
        } else if rest.starts_with("//") {
            begin.get_or_insert(at);
            at += rest.find('\n').map_or(rest.len(), |i| i + 1);
        } else if rest.starts_with('\n') {
            begin = None;
            at += 1;
        } else if bytes[at].is_ascii_whitespace() {
            at += 1;
        } else {
            let end = at + end_of(rest);
            let own = &text[begin.take().unwrap_or(at)..end];
            if let Some(name) = declared(&text[at..end]) {
                items.push(Item { name: name.to_owned(), text: own.trim_end().to_owned() });
            }
            at = end;
            // The end of its line does not separate it from comments below.
            at += text[at..].find(|c: char| c != ' ').unwrap_or(0);
            at += usize::from(text[at..].starts_with('\n'));
        }
    }
    items
}

/// The end of the declaration at the start of a text: its semicolon, or its closing brace.
fn end_of(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if let Some(end) = comment(text, at) {
            at = end;
            continue;
        }
        if rest.starts_with("#{") {
            // A name replaced by Bevy's preprocessor.
            at += rest.find('}').map_or(rest.len(), |i| i + 1);
            continue;
        }
        at += c.len_utf8();
        match c {
            '{' => depth += 1,
            '}' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    let more = text[at..].trim_start();
                    return if more.starts_with(';') { text.len() - more.len() + 1 } else { at };
                }
            }
            ';' if depth == 0 => return at,
            _ => {}
        }
    }
    text.len()
}

/// The name declared by a declaration.
fn declared(text: &str) -> Option<&str> {
    let mut all = words(text).into_iter().map(|(word, _)| word);
    let keyword = all.find(|word| ["fn", "struct", "const", "var", "alias", "override"].contains(word))?;
    if keyword == "var" {
        // `var<uniform> name`, `var<storage, read> name`.
        return all.find(|word| !["uniform", "storage", "read", "read_write", "private"].contains(word));
    }
    all.next()
}

/// The words of a text without its comments, and true for those after a dot.
fn words(text: &str) -> Vec<(&str, bool)> {
    let mut found = Vec::new();
    let mut at = 0;
    let mut field = false;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        if let Some(end) = comment(text, at) {
            at = end;
        } else if c.is_alphanumeric() || c == '_' {
            let length = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
            found.push((&rest[..length], field));
            field = false;
            at += length;
        } else {
            field = c == '.';
            at += c.len_utf8();
        }
    }
    found
}

/// The names of fields that any of the texts reads or writes.
#[must_use]
pub fn fields<'a>(texts: impl IntoIterator<Item = &'a str>) -> BTreeSet<&'a str> {
    texts.into_iter().flat_map(words).filter(|(_, field)| *field).map(|(word, _)| word).collect()
}

/// Drops everything that the roots do not need, directly or indirectly.
pub fn retain_used(sections: &mut [Vec<Item>], roots: &[&str]) {
    let mut needed: BTreeSet<String> = BTreeSet::new();
    {
        let by_name: BTreeMap<&str, &Item> =
            sections.iter().flatten().map(|item| (item.name.as_str(), item)).collect();
        let mut open: Vec<&str> = roots.to_vec();
        while let Some(name) = open.pop() {
            if let Some(item) = by_name.get(name)
                && needed.insert(name.to_owned())
            {
                open.extend(item.uses());
            }
        }
    }
    sections.iter_mut().for_each(|section| section.retain(|item| needed.contains(&item.name)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compose::{LIGHTS, OPTICS, TRANSMISSION};

    #[test]
    fn a_text_is_cut_into_its_declarations() {
        let text = "// Header.\n\n// Pi.\nconst PI: f32 = 3.0; // end\n/* lcm {} */\nstruct S {\n    a: f32,\n}\n\
                    @group(#{G}) @binding(0) var<uniform> u: S;\n@vertex\nfn f(a: S) -> @location(0) f32 {\n    // };\n    return u.PI;\n}\nalias V = vec3<f32>;\n";
        let found = items(text);
        let names: Vec<_> = found.iter().map(|item| item.name.as_str()).collect();
        assert_eq!(names, ["PI", "S", "u", "f", "V"]);
        assert_eq!(found[0].text, "// Pi.\nconst PI: f32 = 3.0;");
        assert!(found[3].text.starts_with("@vertex\nfn f") && found[3].text.ends_with('}'));
        assert!(!found[3].uses().contains("PI"), "a field");
    }

    #[test]
    fn only_what_is_needed_stays() {
        let mut sections = [
            items("fn root() { a(); }\nfn b() {}\n"),
            items("fn a() { c(); }\nfn c() {}\nfn d() { b(); }\n"),
        ];
        retain_used(&mut sections, &["root"]);
        let names: Vec<_> = sections.iter().flatten().map(|item| item.name.as_str()).collect();
        assert_eq!(names, ["root", "a", "c"]);
        assert_eq!(fields(["a.b + c .d(e)[1].f"]).into_iter().collect::<Vec<_>>(), ["b", "d", "f"]);
    }

    #[test]
    fn shipped_files_lose_nothing_but_their_headers() {
        for source in OPTICS.iter().chain(TRANSMISSION).chain([&LIGHTS]) {
            let whole: String = items(source.text).into_iter().map(|item| item.text + "\n\n").collect();
            let count = |text: &str| text.matches("\nfn ").count() + text.matches("\nstruct ").count();
            assert_eq!(count(&format!("\n{whole}")), count(&format!("\n{}", source.text)), "{}", source.path);
        }
    }
}
