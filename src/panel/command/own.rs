//! The keys that the settings give to commands, checked against all commands. Mistakes are reported, and the usual keys
//! stay.

use std::collections::{BTreeMap, BTreeSet};

use bevy_egui::egui::Key;
use serde_json::Value as Json;

use super::{Command, Menu};
use crate::{
    panel::state::{GivenKeys, Replaced, Shortcut},
    text::{did_you_mean, listed, quoted, sentence, shortened},
};

/// Maximum number of problems that are described; further ones are counted.
const MOST: usize = 12;
/// Maximum number of custom keys of a command.
const MOST_KEYS: usize = 8;

/// Keys that belong to no command, with their effects.
fn reserved(shortcut: Shortcut) -> Option<&'static str> {
    let Shortcut { ctrl, shift, alt, key } = shortcut;
    match key {
        Key::Escape => Some("closes what is open"),
        Key::Enter => Some("presses what has the focus"),
        // Ctrl+A is a command's, too: in a field, it selects the text there.
        Key::C | Key::V | Key::X if ctrl && !shift && !alt => Some("copies, pastes or cuts text"),
        _ => None,
    }
}

/// The keys of a value: one, a list, or none.
fn keys_of(value: &Json) -> Result<Vec<Shortcut>, String> {
    const FORM: &str = "a key such as \"Ctrl+S\", a list of keys, or null for no key";
    let texts: Vec<&str> = match value {
        Json::Null => Vec::new(),
        Json::String(text) => vec![text],
        Json::Array(list) if list.len() <= MOST_KEYS => match list.iter().map(Json::as_str).collect() {
            Some(texts) => texts,
            None => return Err(format!("must be {FORM}")),
        },
        Json::Array(_) => return Err(format!("must have at most {MOST_KEYS} keys")),
        _ => return Err(format!("must be {FORM}")),
    };
    let read = |text: &str| {
        let key = Shortcut::read(text).map_err(|why| format!("must be {FORM}: {why}"))?;
        match reserved(key) {
            Some(does) => Err(format!("cannot be used, since {key} {does}; choose another key")),
            None => Ok(key),
        }
    };
    texts.into_iter().map(read).collect()
}

/// A value as messages show it.
fn shown(value: &Json) -> String {
    match value {
        Json::Object(_) => "an object".to_owned(),
        value => shortened(&value.to_string()),
    }
}

fn spelled(keys: &[Shortcut]) -> String {
    match keys {
        [] => "it stays without a key".to_owned(),
        [key] => format!("the default {key} stays"),
        keys => {
            let all: Vec<_> = keys.iter().map(ToString::to_string).collect();
            format!("the defaults {} stay", listed(&all, "and"))
        }
    }
}

/// The keys of the settings that are in force, and sentences about the others. `root` has all commands with their usual
/// keys.
#[must_use]
pub fn check(given: &GivenKeys, root: &Menu) -> (Replaced, Vec<String>) {
    let pairs = match given {
        GivenKeys::List(pairs) => &pairs.0,
        GivenKeys::Other(value) => {
            let rule = "must be an object with commands and their keys, such as { \"save\": \"Ctrl+S\" }";
            let why = format!("keys is {}, but {rule}; the default keys stay.", shown(value));
            return (Replaced::new(), vec![why]);
        }
    };
    let commands: BTreeMap<&str, &Command> =
        root.commands().into_iter().map(|(_, command)| (&*command.id, command)).collect();
    let mut problems = Vec::new();
    let mut own = Vec::new();
    let mut seen = BTreeSet::new();
    for (id, value) in pairs {
        match read(id, value, &commands, &mut seen, problems.len() < MOST) {
            Ok(keys) => own.push((&**id, keys)),
            Err(why) => problems.push(why),
        }
    }
    refuse_clashes(&mut own, &commands, &mut problems);
    let more = problems.len().saturating_sub(MOST);
    problems.truncate(MOST);
    if more > 0 {
        problems.push(format!("There are {more} more problems with keys."));
    }
    (own.into_iter().map(|(id, keys)| (id.to_owned(), keys)).collect(), problems)
}

/// The keys of one member of the settings. Only a few problems are described.
fn read<'a>(
    id: &'a str,
    value: &Json,
    commands: &BTreeMap<&str, &Command>,
    seen: &mut BTreeSet<&'a str>,
    describe: bool,
) -> Result<Vec<Shortcut>, String> {
    if !describe && !commands.contains_key(id) {
        return Err(String::new());
    }
    let Some(command) = commands.get(id) else {
        let near = did_you_mean(id, commands.values().map(|c| (&*c.id, &*c.id)));
        let hint = if near.is_empty() { "; the documentation lists all commands".to_owned() } else { near };
        return Err(sentence(&format!("keys has {}, which is not a command{hint}", quoted(id))));
    };
    if !seen.insert(id) {
        return Err(format!("keys.{id} is given twice; the first counts."));
    }
    keys_of(value).map_err(|rule| {
        let (why, stays) = (format!("keys.{id} is {}, but {rule}", shown(value)), spelled(&command.keys));
        match why.ends_with('?') {
            true => format!("{why} For now, {stays}."),
            false => format!("{why}; {stays}."),
        }
    })
}

/// Takes back those keys that would do two things, the later ones first; the usual keys of a command may then be another's
/// in turn.
fn refuse_clashes(
    own: &mut Vec<(&str, Vec<Shortcut>)>,
    commands: &BTreeMap<&str, &Command>,
    problems: &mut Vec<String>,
) {
    while let Some((at, key, other)) = clash(own, commands) {
        let (id, _) = own.remove(at);
        let usual = commands.get(id).map(|c| spelled(&c.keys)).unwrap_or_default();
        problems.push(format!(
            "keys.{id} has {key}, which is the key of {}; give that another key, or null for none; {usual}.",
            quoted(other)
        ));
    }
}

/// The last of the given commands that has a key of another, with that key and the other.
fn clash<'a>(
    own: &[(&'a str, Vec<Shortcut>)],
    commands: &BTreeMap<&str, &'a Command>,
) -> Option<(usize, Shortcut, &'a str)> {
    let given: BTreeMap<&str, usize> = own.iter().enumerate().map(|(at, (id, _))| (*id, at)).collect();
    let usual = commands.values().filter(|command| !given.contains_key(&*command.id));
    let usual: Vec<(&str, &[Shortcut])> = usual.map(|c| (&*c.id, &*c.keys)).collect();
    (0..own.len()).rev().find_map(|at| {
        let before = own[..at].iter().map(|(id, keys)| (*id, &**keys));
        let (others, mine) = (usual.iter().copied().chain(before), &own[at].1);
        others.into_iter().find_map(|(other, theirs)| {
            let key = mine.iter().find(|key| theirs.iter().any(|their| key.clashes(*their)))?;
            Some((at, *key, other))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        panel::{Panels, command, state::Session},
        registry::Registry,
    };

    /// All commands with their default keys.
    fn root() -> Menu {
        let mut session = Session::default();
        session.panels = Panels::builtin().infos().collect();
        command::declared(&session, &Registry::builtin(), true, true)
    }

    /// The keys in force for some settings, and the problems to be reported.
    fn checked(json: &str) -> (Vec<(String, String)>, Vec<String>) {
        let given: GivenKeys = serde_json::from_str(json).expect("JSON");
        let (replaced, problems) = check(&given, &root());
        let spelled =
            |keys: Vec<Shortcut>| keys.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        (replaced.into_iter().map(|(id, keys)| (id, spelled(keys))).collect(), problems)
    }

    fn pairs(all: &[(&str, &str)]) -> Vec<(String, String)> {
        all.iter().map(|(id, keys)| ((*id).to_owned(), (*keys).to_owned())).collect()
    }

    #[test]
    fn every_default_key_can_be_read_and_belongs_to_no_one_else() {
        let root = root();
        let commands = root.commands();
        assert!(commands.iter().filter(|(_, command)| !command.keys.is_empty()).count() > 60);
        for (_, command) in commands {
            assert_eq!(command.unreadable, Vec::<String>::new());
            for key in &command.keys {
                assert_eq!(reserved(*key), None, "{key} of {}", command.id);
            }
        }
    }

    #[test]
    fn own_keys_replace_the_usual_ones_and_may_be_exchanged() {
        let (own, problems) = checked(
            r#"{ "save": "Ctrl+O", "open": "ctrl+s", "redo": ["Ctrl+Y", "F12"], "delete": null, "model.lambert": "L" }"#,
        );
        assert_eq!(problems, Vec::<String>::new());
        let wanted = [
            ("delete", ""),
            ("model.lambert", "L"),
            ("open", "Ctrl+S"),
            ("redo", "Ctrl+Y F12"),
            ("save", "Ctrl+O"),
        ];
        assert_eq!(own, pairs(&wanted));
        assert_eq!(checked("{}"), (Vec::new(), Vec::new()));
    }

    #[test]
    fn each_problem_says_what_where_and_what_would_be_right() {
        for (json, expected) in [
            (
                "5",
                "keys is 5, but must be an object with commands and their keys, such as { \"save\": \"Ctrl+S\" }",
            ),
            ("[\"Ctrl+S\"]", "but must be an object"),
            (r#"{ "sav": "F4" }"#, "keys has \"sav\", which is not a command; did you mean \"save\"?"),
            (r#"{ "zzzzzzzzzzzz": "F4" }"#, "which is not a command; the documentation lists all commands."),
            (r#"{ "save": "Strg+S" }"#, "keys.save is \"Strg+S\", but must be a key such as \"Ctrl+S\""),
            (
                r#"{ "save": "Strg+S" }"#,
                "\"Strg\" is not a modifier; use Ctrl, Shift or Alt; the default Ctrl+S stays.",
            ),
            (r#"{ "save": "Ctrl+Entr" }"#, "\"Entr\" is not a key; did you mean \"Enter\"?"),
            (
                r#"{ "redo": 7 }"#,
                "keys.redo is 7, but must be a key such as \"Ctrl+S\", a list of keys, or null for no key; the defaults Ctrl+Shift+Z and Ctrl+Y stay.",
            ),
            (r#"{ "manual": {} }"#, "keys.manual is an object, but must be a key"),
            (r#"{ "manual": "" }"#, "it has no key; it stays without a key."),
            (r#"{ "save": ["F4", 3] }"#, "a list of keys"),
            (r#"{ "save": ["F4","F4","F4","F4","F4","F4","F4","F4","F4"] }"#, "must have at most 8 keys"),
            (
                r#"{ "save": "Enter" }"#,
                "cannot be used, since Enter presses what has the focus; choose another key",
            ),
            (r#"{ "save": "F6" }"#, "keys.save has F6, which is the key of \"next_panel\""),
            (r#"{ "save": "F10" }"#, "keys.save has F10, which is the key of \"menu_bar\""),
            (r#"{ "save": "Alt+F" }"#, "keys.save has Alt+F, which is the key of \"menu.file\""),
            (r#"{ "save": "Ctrl+V" }"#, "since Ctrl+V copies, pastes or cuts text"),
            (r#"{ "save": "F4", "save": "F12" }"#, "keys.save is given twice; the first counts."),
            (
                r#"{ "save": "Ctrl+O" }"#,
                "keys.save has Ctrl+O, which is the key of \"open\"; give that another key, or null for none; the default Ctrl+S stays.",
            ),
            (r#"{ "save": "F4", "open": "F4" }"#, "keys.open has F4, which is the key of \"save\""),
            (r#"{ "full_screen": "Ctrl+=" }"#, "which is the key of \"larger\""),
        ] {
            let (_, problems) = checked(json);
            assert_eq!(problems.len(), 1, "{json}: {problems:?}");
            assert!(problems[0].contains(expected), "{json}: {problems:?}");
        }
    }

    #[test]
    fn whatever_is_refused_no_key_does_two_things() {
        // “open” is unreadable, so Ctrl+O is still its key, so “save” keeps Ctrl+S, so “quit” cannot have that.
        let (own, problems) = checked(r#"{ "quit": "Ctrl+S", "save": "Ctrl+O", "open": "Strg+S" }"#);
        assert_eq!((own, problems.len()), (Vec::new(), 3), "{problems:?}");
        let (own, problems) = checked(r#"{ "quit": "F4", "save": "Ctrl+Q", "new": "Ctrl+S" }"#);
        assert_eq!(own, pairs(&[("new", "Ctrl+S"), ("quit", "F4"), ("save", "Ctrl+Q")]));
        assert_eq!(problems, Vec::<String>::new());
    }

    #[test]
    fn many_problems_are_counted_and_take_no_time() {
        let many: Vec<_> = (0..20_000).map(|i| format!("\"command{i}\": \"F4\"")).collect();
        let begun = std::time::Instant::now();
        let (own, problems) = checked(&format!("{{ {} }}", many.join(", ")));
        assert!(own.is_empty() && problems.len() == MOST + 1, "{problems:?}");
        assert_eq!(problems[MOST], format!("There are {} more problems with keys.", 20_000 - MOST));
        assert!(begun.elapsed().as_secs() < 5, "{:?}", begun.elapsed());
        let long = format!("{{ \"{0}\": \"{0}\" }}", "x".repeat(100_000));
        assert!(checked(&long).1[0].len() < 400);
    }
}
