//! The words that the editor offers and explains: WGSL, the program's vocabulary, declared parameters, names in the
//! text; for JSON the keys and values of the schema.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
};

use serde_json::Value as Json;

use super::tokens::{Language, Sort, is_of_word, tokens};
use crate::{
    parameter::{Parameter, ParameterKind},
    registry::Registry,
    scene::schema,
    shader::compose::{OPTICS, TRANSMISSION},
};

/// Words of WGSL and keys of declarations: the sort, the word, its use, and a sentence.
const TABLE: &str = include_str!("../../../assets/text/wgsl.tsv");
/// Greatest size of a text whose own names are offered, bytes: they are collected while one types.
const MOST_NAMED: usize = 64 << 10;
/// Most words that are offered.
pub const MOST_OFFERED: usize = 200;
/// Greatest depth of JSON in which keys are found.
const DEEPEST: usize = 64;

/// A word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub name: String,
    /// The text that it is in the file.
    pub insert: String,
    /// How it is used.
    pub usage: String,
    /// A sentence about it.
    pub help: String,
}

impl Word {
    fn new(name: &str, usage: &str, help: &str) -> Self {
        Self {
            name: name.to_owned(),
            insert: name.to_owned(),
            usage: usage.to_owned(),
            help: help.to_owned(),
        }
    }

    fn json(name: &str, usage: &str, help: &str) -> Self {
        Self { insert: format!("\"{name}\""), ..Self::new(name, usage, help) }
    }
}

/// All words that do not depend on the text.
#[derive(Debug)]
pub struct Vocabulary {
    functions: Vec<Word>,
    frame: Vec<Word>,
    keys: Vec<Word>,
    schema: Json,
}

/// A place in a text, with the words that fit there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    /// The bytes that a word replaces.
    pub place: Range<usize>,
    /// The words, the likeliest first.
    pub words: Vec<Word>,
}

impl Vocabulary {
    /// The words with these models.
    #[must_use]
    pub fn of(registry: &Registry) -> Self {
        let rows = |sort: &'static str| {
            TABLE.lines().filter_map(move |line| {
                let mut cells = line.split('\t');
                let [of, name, usage, help] = std::array::from_fn(|_| cells.next().unwrap_or_default());
                (of == sort).then_some((name, usage, help))
            })
        };
        let word = |(name, usage, help): (&str, &str, &str)| Word::new(name, usage, help);
        let mut functions: Vec<_> = rows("call").chain(rows("word")).map(word).collect();
        for source in OPTICS.iter().chain(TRANSMISSION) {
            functions.extend(defined(registry.sources().text(source)));
        }
        functions.sort_by(|a, b| a.name.cmp(&b.name));
        functions.dedup_by(|a, b| a.name == b.name);
        Self {
            functions,
            frame: rows("frame").map(word).collect(),
            keys: rows("key").map(|(name, usage, help)| Word::json(name, usage, help)).collect(),
            schema: schema::schema(registry),
        }
    }

    /// The words that fit at a byte of a text. `parameters` are those that the model declares.
    #[must_use]
    pub fn offer(&self, text: &str, at: usize, language: Language, parameters: &[Parameter]) -> Offer {
        let at = text.floor_char_boundary(at);
        let declares = language == Language::Wgsl && in_declaration(text, at);
        if language == Language::Json || declares {
            return self.offer_json(text, at, declares);
        }
        let start = text[..at].len()
            - text[..at].chars().rev().take_while(|c| is_of_word(*c)).map(char::len_utf8).sum::<usize>();
        let (begun, place) = (&text[start..at], start..at);
        let before = &text[..start];
        let words = match owner(before) {
            Some("m") => fitting(parameters.iter().map(described), begun),
            Some("frame") => fitting(self.frame.iter().cloned(), begun),
            Some(_) => Vec::new(),
            None => {
                let known: BTreeSet<_> = self.functions.iter().map(|word| word.name.as_str()).collect();
                let own = names(text, start, &known);
                fitting(self.functions.iter().cloned().chain(own), begun)
            }
        };
        Offer { place, words }
    }

    fn offer_json(&self, text: &str, at: usize, declares: bool) -> Offer {
        let word = text[..at].len()
            - text[..at]
                .chars()
                .rev()
                .take_while(|c| is_of_word(*c) || *c == '$')
                .map(char::len_utf8)
                .sum::<usize>();
        let quoted = text[..word].ends_with('"');
        let start = if quoted { word - 1 } else { word };
        let end = if quoted && text[at..].starts_with('"') { at + 1 } else { at };
        let begun = &text[word..at];
        if declares {
            return Offer { place: start..end, words: fitting(self.keys.iter().cloned(), begun) };
        }
        let here = place_in(text, &(start..end));
        let parts = self.parts(&here);
        let words: Vec<_> = match here.is_key {
            true => {
                let follows = text[end..].trim_start().starts_with(':');
                let key = |(key, node): (&str, Json)| Word {
                    insert: if follows { format!("\"{key}\"") } else { format!("\"{key}\": ") },
                    ..Word::json(key, &usage(&node), text_of(&node, "description"))
                };
                let free = keys(&parts).into_iter().filter(|(key, _)| !here.taken.contains(key));
                free.map(key).collect()
            }
            false => parts.iter().flat_map(|part| values(part.node)).collect(),
        };
        let mut words = fitting(words.into_iter(), begun);
        words.dedup_by(|a, b| a.name == b.name);
        Offer { place: start..end, words }
    }

    /// The word at a byte of a text, if anything is known about it.
    #[must_use]
    pub fn help(&self, text: &str, at: usize, language: Language, parameters: &[Parameter]) -> Option<Word> {
        let at = text.floor_char_boundary(at);
        let before: usize = text[..at].chars().rev().take_while(|c| is_of_word(*c)).map(char::len_utf8).sum();
        let after: usize = text[at..].chars().take_while(|c| is_of_word(*c)).map(char::len_utf8).sum();
        let word = &text[at - before..at + after];
        if word.is_empty() {
            return None;
        }
        let known = |known: &Word| known.name == word && !known.help.is_empty();
        let declares = language == Language::Wgsl && in_declaration(text, at);
        if language == Language::Json || declares {
            return self.offer_json(text, at + after, declares).words.into_iter().find(known);
        }
        match owner(&text[..at - before]) {
            Some("m") => parameters.iter().map(described).find(known),
            Some("frame") => self.frame.iter().find(|word| known(word)).cloned(),
            Some(_) => None,
            None => self.functions.iter().find(|word| known(word)).cloned(),
        }
    }

    /// The parts of the schema that apply to a place.
    fn parts(&self, here: &Here<'_>) -> Vec<Part<'_>> {
        let none = Members::new();
        let members = |depth: usize| here.members.get(depth).unwrap_or(&none);
        let mut now = applying(Part { node: &self.schema, is_sure: true }, members(0));
        for (i, step) in here.path.iter().enumerate() {
            let next = now.iter().filter_map(|part| {
                let inner = match step {
                    Step::Key(key) => {
                        let other = || object_of(part.node.get("additionalProperties"));
                        part.node["properties"].get(key).or_else(other)
                    }
                    Step::Item => part.node.get("items"),
                };
                Some(Part { node: inner?, ..*part })
            });
            now = next.flat_map(|part| applying(part, members(i + 1))).collect();
        }
        now
    }
}

/// The name before the dot at the end of a text.
fn owner(before: &str) -> Option<&str> {
    let rest = before.strip_suffix('.')?;
    let length: usize = rest.chars().rev().take_while(|c| is_of_word(*c)).map(char::len_utf8).sum();
    Some(&rest[rest.len() - length..])
}

fn object_of(node: Option<&Json>) -> Option<&Json> {
    node.filter(|node| node.is_object())
}

/// Members of an object that are texts: `type` and the ids of models decide on the other ones.
type Members<'a> = BTreeMap<&'a str, &'a str>;

/// A part of a schema.
#[derive(Clone, Copy)]
struct Part<'a> {
    node: &'a Json,
    /// False for one of several alternatives, and where a condition cannot be decided.
    is_sure: bool,
}

/// A part of a schema and what is in it that applies to a value, or may, the general first.
fn applying<'a>(part: Part<'a>, members: &Members<'_>) -> Vec<Part<'a>> {
    let Part { node, is_sure } = part;
    let mut all = vec![part];
    for (list, is_sure) in [("oneOf", false), ("anyOf", false), ("allOf", is_sure)] {
        for node in node[list].as_array().into_iter().flatten() {
            all.extend(applying(Part { node, is_sure }, members));
        }
    }
    let holds = node.get("if").and_then(|condition| holds(condition, members));
    for (branch, needs) in [("then", true), ("else", false)] {
        if let Some(node) = node.get(branch).filter(|_| holds != Some(!needs)) {
            all.extend(applying(Part { node, is_sure: is_sure && holds.is_some() }, members));
        }
    }
    all
}

/// True if an object meets a condition on its members, if it says.
fn holds(condition: &Json, members: &Members<'_>) -> Option<bool> {
    let mut all = condition["properties"].as_object()?.iter();
    all.try_fold(true, |all, (key, node)| {
        let is = members.get(key.as_str())?;
        Some(all && node["const"].as_str() == Some(*is))
    })
}

/// The keys that may stand in an object, each with all that applies to it.
fn keys<'a>(parts: &[Part<'a>]) -> BTreeMap<&'a str, Json> {
    let mut all: BTreeMap<&str, Json> = BTreeMap::new();
    for part in parts {
        for (key, node) in part.node["properties"].as_object().into_iter().flatten() {
            match all.get_mut(key.as_str()) {
                Some(known) if part.is_sure => narrow(known, node),
                None if node.is_object() => _ = all.insert(key, node.clone()),
                _ => {}
            }
        }
    }
    all.retain(|_, node| node.is_object());
    all
}

/// Adds what a more special part of a schema says; `false` is a key that may not stand there.
fn narrow(known: &mut Json, node: &Json) {
    match (known, node.as_object()) {
        (Json::Object(known), Some(more)) => known.extend(more.clone()),
        (known, None) => *known = node.clone(),
        _ => {}
    }
}

fn text_of<'a>(node: &'a Json, key: &str) -> &'a str {
    node[key].as_str().unwrap_or_default()
}

/// The values that a part of a schema names.
fn values(node: &Json) -> Vec<Word> {
    let word = |value: &Json, help: &str| {
        let shown = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        Word { insert: value.to_string(), ..Word::new(&shown, text_of(node, "title"), help) }
    };
    let general = text_of(node, "description");
    let listed = node["enum"].as_array().into_iter().flatten().enumerate();
    let listed =
        listed.map(|(i, value)| word(value, node["enumDescriptions"][i].as_str().unwrap_or(general)));
    let mut all: Vec<_> =
        node.get("const").map(|value| word(value, general)).into_iter().chain(listed).collect();
    if node["type"] == "boolean" {
        all.extend([Json::Bool(true), Json::Bool(false)].iter().map(|value| word(value, general)));
    }
    all
}

/// The type and the range of a key.
fn usage(node: &Json) -> String {
    let kind = text_of(node, "type");
    let number = |keys: [&str; 2]| keys.iter().find_map(|key| node.get(*key)).map(Json::to_string);
    match (number(["minimum", "exclusiveMinimum"]), number(["maximum", "exclusiveMaximum"])) {
        (Some(least), Some(most)) => format!("{kind}, {least} to {most}"),
        (Some(least), None) => format!("{kind}, from {least}"),
        _ => kind.to_owned(),
    }
}

fn described(parameter: &Parameter) -> Word {
    // That of a colour is of its codes.
    let unit = Some(parameter.unit).filter(|unit| !unit.is_empty());
    let unit = unit.filter(|_| !matches!(parameter.kind, ParameterKind::Colour(_)));
    let unit = unit.map_or_else(String::new, |unit| format!(", {unit}"));
    let usage = format!("{}{unit}", in_wgsl(&parameter.kind, &parameter.rule()));
    Word::new(parameter.name, &usage, parameter.help)
}

/// What a shader sees of a parameter with this rule: its type, and the values that it has there.
fn in_wgsl(kind: &ParameterKind, rule: &str) -> String {
    let all = kind.options().iter().enumerate().map(|(i, (id, _))| format!("{i} is {id}"));
    match (kind, kind.wgsl()) {
        (ParameterKind::Colour(_), wgsl) => format!("{wgsl}, linear"),
        (ParameterKind::Choice(_), wgsl) => format!("{wgsl}: {}", all.collect::<Vec<_>>().join(", ")),
        (_, wgsl) => format!("{wgsl}, {rule}"),
    }
}

/// The words that begin as the typed one does, then those that contain it.
fn fitting(words: impl Iterator<Item = Word>, begun: &str) -> Vec<Word> {
    let begun = begun.to_ascii_lowercase();
    let mut all: Vec<_> = words
        .filter_map(|word| {
            let at = word.name.to_ascii_lowercase().find(&begun)?;
            Some((at > 0, word))
        })
        .collect();
    all.sort_by(|a, b| (a.0, &a.1.name).cmp(&(b.0, &b.1.name)));
    all.truncate(MOST_OFFERED);
    all.into_iter().map(|(_, word)| word).collect()
}

/// The names in a text, but for that at a byte.
fn names(text: &str, but: usize, known: &BTreeSet<&str>) -> Vec<Word> {
    if text.len() > MOST_NAMED {
        return Vec::new();
    }
    let mut coloured = tokens(text, Language::Wgsl).into_iter().peekable();
    let (mut at, mut found) = (0, BTreeSet::new());
    while at < text.len() {
        while coloured.peek().is_some_and(|(range, _)| range.end <= at) {
            coloured.next();
        }
        if let Some((range, sort)) = coloured.peek().filter(|(range, _)| range.start <= at)
            && *sort != Sort::Function
        {
            at = range.end;
            continue;
        }
        let length: usize = text[at..].chars().take_while(|c| is_of_word(*c)).map(char::len_utf8).sum();
        if length > 2 && at != but && !known.contains(&text[at..at + length]) {
            found.insert(&text[at..at + length]);
        }
        at += length.max(text[at..].chars().next().map_or(1, char::len_utf8));
    }
    found.into_iter().map(|name| Word::new(name, "in this text", "")).collect()
}

/// The functions that a text defines, with the comments above them.
fn defined(text: &str) -> Vec<Word> {
    let lines: Vec<_> = text.lines().collect();
    let each = lines.iter().enumerate().filter_map(|(i, line)| {
        let name = line.strip_prefix("fn ")?.split('(').next()?;
        let above = lines[..i].iter().rev().take_while(|line| line.starts_with("//"));
        let mut help: Vec<_> = above.map(|line| line.trim_start_matches('/').trim()).collect();
        help.reverse();
        let usage = line.trim_end_matches(['{', ' ']);
        Some(Word::new(name, usage, &help.join(" ")))
    });
    each.collect()
}

/// True if a byte is within the declaration of a model.
fn in_declaration(text: &str, at: usize) -> bool {
    crate::custom::declaration_place(text).is_some_and(|place| place.start <= at && at <= place.end)
}

/// A step from a value of JSON to one in it.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Step {
    Key(String),
    Item,
}

/// A place in JSON.
struct Here<'a> {
    /// The way to it.
    path: Vec<Step>,
    /// True if a key is expected.
    is_key: bool,
    /// The members of the objects around it, the outermost first, with those that follow; none for lists.
    members: Vec<Members<'a>>,
    /// The other keys of the innermost object.
    taken: Vec<&'a str>,
}

/// An object or a list that is open: in an object the key that is being given a value, and the members so far.
struct Open<'a> {
    key: Option<&'a str>,
    members: Members<'a>,
    keys: Vec<&'a str>,
}

/// A walk through JSON.
#[derive(Default)]
struct Walk<'a> {
    open: Vec<Open<'a>>,
    is_key: bool,
    last: &'a str,
    /// Number of those open that are around the place, and the members of those that have been closed since.
    around: usize,
    closed: Vec<Open<'a>>,
}

impl<'a> Walk<'a> {
    fn over(&mut self, text: &'a str) {
        let mut words = tokens(text, Language::Json).into_iter().peekable();
        let mut at = 0;
        while at < text.len() {
            if let Some((range, sort)) = words.next_if(|(range, _)| range.start <= at) {
                if sort == Sort::Key || sort == Sort::Text {
                    self.word(text[range.clone()].trim_matches('"'), sort);
                }
                at = range.end.max(at + 1);
                continue;
            }
            self.sign(text.as_bytes()[at]);
            at += 1;
        }
    }

    fn word(&mut self, word: &'a str, sort: Sort) {
        self.last = word;
        if let Some(Open { key: Some(key), members, .. }) = self.open.last_mut()
            && sort == Sort::Text
            && !self.is_key
        {
            members.insert(*key, word);
        }
    }

    fn sign(&mut self, sign: u8) {
        let is_object = sign == b'{';
        match sign {
            b'{' | b'[' if self.open.len() < DEEPEST => {
                let key = is_object.then_some("");
                self.open.push(Open { key, members: Members::new(), keys: Vec::new() });
                self.is_key = is_object;
            }
            b'}' | b']' => {
                let closed = self.open.pop();
                self.is_key = false;
                if self.open.len() < self.around {
                    self.around = self.open.len();
                    self.closed.extend(closed);
                }
            }
            b':' => {
                if let Some(Open { key: Some(key), keys, .. }) = self.open.last_mut() {
                    *key = self.last;
                    keys.push(self.last);
                }
                self.is_key = false;
            }
            b',' => self.is_key = self.open.last().is_some_and(|open| open.key.is_some()),
            _ => {}
        }
    }
}

/// The place in a JSON text that a word takes up, which may be incomplete.
fn place_in<'a>(text: &'a str, word: &Range<usize>) -> Here<'a> {
    let mut walk = Walk::default();
    walk.over(&text[..word.start]);
    let is_key = walk.is_key;
    let step = |open: &Open<'_>| open.key.map_or(Step::Item, |key| Step::Key(key.to_owned()));
    let mut path: Vec<_> = walk.open.iter().map(step).collect();
    if is_key {
        path.pop();
    }
    (walk.around, walk.last) = (walk.open.len(), "");
    walk.over(&text[word.end..]);
    let Walk { mut open, around, closed, .. } = walk;
    open.truncate(around);
    open.extend(closed.into_iter().rev());
    let taken = open.last_mut().map(|open| std::mem::take(&mut open.keys)).unwrap_or_default();
    let members = open.into_iter().map(|open| open.members).collect();
    Here { path, is_key, members, taken }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offered(before: &str, after: &str, language: Language, parameters: &[Parameter]) -> Vec<String> {
        let vocabulary = Vocabulary::of(&Registry::builtin());
        let text = format!("{before}{after}");
        let offer = vocabulary.offer(&text, before.len(), language, parameters);
        offer.words.into_iter().map(|word| word.name).collect()
    }

    #[test]
    fn every_word_of_the_table_has_its_use_and_a_sentence() {
        for line in TABLE.lines() {
            let cells: Vec<_> = line.split('\t').collect();
            assert_eq!(cells.len(), 4, "{line}");
            assert!(cells[3].ends_with('.') && cells[2].contains(cells[1]), "{line}");
        }
    }

    #[test]
    fn functions_of_the_vocabulary_are_offered_with_their_comments() {
        let vocabulary = Vocabulary::of(&Registry::builtin());
        let text = "let f = schl";
        let offer = vocabulary.offer(text, text.len(), Language::Wgsl, &[]);
        assert_eq!(&text[offer.place.clone()], "schl");
        let names: Vec<_> = offer.words.iter().map(|word| word.name.as_str()).collect();
        assert_eq!(names[..3], ["schlick", "schlick_smith", "schlick_weight"]);
        assert!(
            offer.words[0].usage.starts_with("fn schlick(f0")
                && offer.words[0].help.contains("Schlick (1994)")
        );
        // Names of the text, but not the one that is being typed.
        assert_eq!(offered("let my_gloss = 1.0;\nlet y = my_g", ";", Language::Wgsl, &[]), ["my_gloss"]);
        assert!(offered("// my_comment\nlet y = my_c", "", Language::Wgsl, &[]).is_empty());
    }

    #[test]
    fn after_m_and_frame_their_members_are_offered() {
        let registry = Registry::builtin();
        let phong = registry.model("phong").expect("built in").parameters;
        let all = offered("let x = m.", ";", Language::Wgsl, phong);
        let mut expected: Vec<_> = phong.iter().map(|p| p.name.to_owned()).collect();
        expected.sort();
        assert_eq!(all, expected);
        assert_eq!(offered("frame.", "", Language::Wgsl, phong), ["b", "n", "t"]);
        assert!(offered("v.", "", Language::Wgsl, phong).is_empty());
        assert!(offered("lemm.", "", Language::Wgsl, phong).is_empty());
    }

    #[test]
    fn parameters_are_described_as_the_shader_sees_them() {
        const FORM: Parameter = Parameter::choice("form", &[("flat", "Flat"), ("round", "Round")], 1);
        let usage = |parameter: &Parameter| described(parameter).usage;
        assert_eq!(usage(&crate::parameter::BASE_COLOUR), "vec3<f32>, linear");
        assert_eq!(usage(&Parameter::flag("two_sided", true)), "u32: 0 is false, 1 is true");
        assert_eq!(usage(&FORM), "u32: 0 is flat, 1 is round");
        for model in Registry::builtin().models() {
            for p in model.parameters {
                assert!(usage(p).starts_with(p.kind.wgsl()), "{}", usage(p));
            }
        }
    }

    #[test]
    fn keys_of_a_declaration_are_offered_in_it_alone() {
        let text = "/* lcm { \"na";
        assert!(offered(text, "\" } */ fn f() {}", Language::Wgsl, &[]).contains(&"name".to_owned()));
        assert!(!offered("/* lcm {} */ fn f() { na", " }", Language::Wgsl, &[]).contains(&"name".to_owned()));
    }

    #[test]
    fn json_has_the_keys_and_the_values_of_the_schema_at_its_place() {
        let of = |before: &str, after: &str| offered(before, after, Language::Json, &[]);
        assert!(of("{ \"", "\" }").contains(&"lights".to_owned()));
        assert!(!of("{ \"lights\": [ { \"", "\" } ] }").contains(&"lights".to_owned()));
        assert!(of("{ \"lights\": [ { \"pos", "\" } ] }").contains(&"position".to_owned()));
        assert!(
            of("{ \"objects\": [ {}, { \"material\": { \"rough", "\" } } ] }")
                .contains(&"roughness".to_owned())
        );
        assert!(of("{ \"reflection_model\": \"pho", "\" }").contains(&"phong".to_owned()));
        let vocabulary = Vocabulary::of(&Registry::builtin());
        let text = "{ \"ligh\" }";
        let offer = vocabulary.offer(text, 7, Language::Json, &[]);
        assert_eq!((&text[offer.place], offer.words[0].insert.as_str()), ("\"ligh\"", "\"lights\": "));
    }

    #[test]
    fn keys_that_the_object_has_are_not_offered_again_and_a_value_ends_with_its_quote() {
        let of = |before: &str, after: &str| offered(before, after, Language::Json, &[]);
        let (before, after) = ("{ \"lights\": [ { \"position\": [0, 1, 2], \"", "\", \"intensity\": 1 } ] }");
        let all = of(before, after);
        let has = |key: &str| all.iter().any(|name| name == key);
        assert!(has("type") && has("name") && !has("position") && !has("intensity"), "{all:?}");
        // Of other objects, and the key that is typed itself.
        assert!(
            of("{ \"name\": \"a\", \"lights\": [ { \"na", "\": \"b\" } ] }").contains(&"name".to_owned())
        );
        let vocabulary = Vocabulary::of(&Registry::builtin());
        for after in ["", "\n}", "\" }"] {
            let before = "{ \"reflection_model\": \"pho";
            let offer = vocabulary.offer(&format!("{before}{after}"), before.len(), Language::Json, &[]);
            let quoted = usize::from(after.starts_with('"'));
            assert_eq!(offer.place, before.len() - 4..before.len() + quoted);
            assert_eq!(offer.words[0].insert, "\"phong\"");
        }
    }

    #[test]
    fn keys_are_those_of_the_type_whether_it_stands_before_or_behind() {
        let of = |before: &str, after: &str| offered(before, after, Language::Json, &[]);
        for (list, kind, has, lacks) in [
            ("lights", "point", "position", "cone_angle"),
            ("lights", "spot", "cone_angle", "width"),
            ("lights", "ambient", "intensity", "position"),
            ("objects", "torus", "tube_radius", "vertical_exponent"),
            ("objects", "sphere", "tessellation", "tube_radius"),
        ] {
            let kind = format!("\"type\": \"{kind}\"");
            let other = "{ \"type\": \"mesh\", \"a\": [{}] }";
            for (before, after) in [
                (format!("{{ \"{list}\": [ {other}, {{ {kind}, \""), "\" } ] }".to_owned()),
                (
                    format!("{{ \"{list}\": [ {{ \"size\": 1, \""),
                    format!("\", \"a\": {other}, {kind} }}, {other} ] }}"),
                ),
                (format!("{{ \"{list}\": [ {{ \""), format!("\n {kind} }} ] }}")),
            ] {
                let all = of(&before, &after);
                let count = |key: &str| all.iter().filter(|name| *name == key).count();
                assert_eq!((count(has), count(lacks), count("name")), (1, 0, 1), "{before}|{after}: {all:?}");
            }
        }
        // Without a type, all may follow.
        let all = of("{ \"lights\": [ { \"", "\" } ] }");
        assert!(["cone_angle", "width", "position"].iter().all(|key| all.iter().any(|name| name == key)));
    }

    #[test]
    fn the_help_for_a_key_is_that_of_the_type_with_the_range_of_all() {
        let vocabulary = Vocabulary::of(&Registry::builtin());
        let text = "{ \"objects\": [ { \"type\": \"cube\", \"tessellation\": 3 } ] }";
        let at = text.find("lation").expect("there");
        let word = vocabulary.help(text, at, Language::Json, &[]).expect("known");
        assert_eq!(
            (word.usage.as_str(), word.help.as_str()),
            ("integer, 1 to 64", "Squares along each edge.")
        );
    }

    #[test]
    fn each_id_is_explained_by_its_own_summary() {
        let registry = Registry::builtin();
        let text = "{ \"objects\": [ { \"reflection_model\": \"\" } ] }";
        let offer = Vocabulary::of(&registry).offer(text, text.len() - 7, Language::Json, &[]);
        let mut count = 0;
        for model in registry.models() {
            let of = |word: &&Word| word.name == model.declaration.id;
            let word = offer.words.iter().find(of).expect("offered");
            assert!(word.help.ends_with(model.declaration.summary), "{word:?}");
            count += 1;
        }
        assert_eq!(offer.words.len(), count);
    }

    #[test]
    fn the_word_under_the_cursor_is_explained() {
        let vocabulary = Vocabulary::of(&Registry::builtin());
        let help = |text: &str, language| {
            let at = text.find('|').expect("a cursor");
            vocabulary.help(&text.replace('|', ""), at, language, &[])
        };
        assert!(
            help("let c = do|t(a, b);", Language::Wgsl)
                .is_some_and(|word| word.help.contains("scalar product"))
        );
        assert!(help("let c = |schlick(f0, x);", Language::Wgsl).is_some());
        assert!(help("let c = nothing|;", Language::Wgsl).is_none());
        assert!(help("let c| = 1;", Language::Wgsl).is_none());
        assert!(help("{ \"li|ghts\": [] }", Language::Json).is_some_and(|word| !word.help.is_empty()));
    }

    #[test]
    fn whatever_the_text_a_place_is_found_in_it() {
        let vocabulary = Vocabulary::of(&Registry::builtin());
        let deep = "[{\"a\":".repeat(20_000);
        for text in [&deep, "é漢\"", "{\"é", "m.é", "/* lcm \"", "\"\\", "}}}]]]:::,,,"] {
            for language in [Language::Wgsl, Language::Json] {
                for at in [0, 1, 2, 3, text.len(), text.len() + 9] {
                    let offer = vocabulary.offer(text, at, language, &[]);
                    assert!(text.get(offer.place.clone()).is_some(), "{text:?} {at}");
                    let _ = vocabulary.help(text, at, language, &[]);
                }
            }
        }
    }
}
