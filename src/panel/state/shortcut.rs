//! Keys as people write them: `Ctrl+Shift+S`.

use std::fmt::{self, Display};

use bevy_egui::egui::{Key, Modifiers};

use crate::text::{nearest, quoted};

/// A key with the modifiers that are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shortcut {
    /// Ctrl (⌘ on a Mac) must be held.
    pub ctrl: bool,
    /// Shift must be held.
    pub shift: bool,
    /// Alt must be held.
    pub alt: bool,
    /// The key.
    pub key: Key,
}

/// Spellings of keys beside those of egui.
const OTHER_NAMES: [(&str, Key); 12] = [
    ("←", Key::ArrowLeft),
    ("→", Key::ArrowRight),
    ("↑", Key::ArrowUp),
    ("↓", Key::ArrowDown),
    ("del", Key::Delete),
    ("ins", Key::Insert),
    ("pgup", Key::PageUp),
    ("pgdn", Key::PageDown),
    ("bksp", Key::Backspace),
    ("return", Key::Enter),
    ("esc", Key::Escape),
    ("spacebar", Key::Space),
];

/// Keys that are pressed with others or belong to the system.
fn is_command_key(key: Key) -> bool {
    const HELD: [&str; 4] = ["Alt", "Control", "Shift", "Super"];
    let name = key.name();
    !["Copy", "Cut", "Paste"].contains(&name) && !HELD.iter().any(|held| name.starts_with(held))
}

/// The key of a name, however it is spelled.
fn key_named(name: &str) -> Option<Key> {
    let plain = name.to_lowercase().replace([' ', '_', '-'], "");
    let other = || OTHER_NAMES.iter().find(|(other, _)| *other == plain).map(|(_, key)| *key);
    let named = || Key::ALL.iter().find(|key| key.name().to_lowercase() == plain).copied();
    Key::from_name(name).or_else(other).or_else(named).filter(|key| is_command_key(*key))
}

/// `+` needs Shift on many keyboards and none on others; some have it together with `=`.
fn is_plus(key: Key) -> bool {
    matches!(key, Key::Plus | Key::Equals)
}

impl Shortcut {
    /// Reads the usual spelling, such as `Ctrl+Shift+S`, `F4`, `Alt+Right` or `Ctrl++`.
    ///
    /// # Errors
    /// The part that is not a key or modifier, and the possible ones.
    pub fn read(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let plus = text.strip_suffix('+').map(str::trim_end);
        let (held, name) = match plus.filter(|held| held.is_empty() || held.ends_with('+')) {
            Some(held) => (held, "+"),
            None => text.rsplit_once('+').unwrap_or(("", text)),
        };
        let key = key_named(name.trim()).ok_or_else(|| unknown_key(name.trim()))?;
        let mut shortcut = Self { ctrl: false, shift: false, alt: false, key };
        for word in held.split('+').map(str::trim).filter(|word| !word.is_empty()) {
            match word.to_lowercase().as_str() {
                "ctrl" | "control" | "cmd" | "command" => shortcut.ctrl = true,
                "shift" => shortcut.shift = true,
                "alt" | "option" => shortcut.alt = true,
                _ => {
                    return Err(format!("{} is not a modifier; use Ctrl, Shift or Alt", quoted(word)));
                }
            }
        }
        Ok(shortcut)
    }

    /// True if this shortcut was pressed.
    #[must_use]
    pub fn matches(self, key: Key, modifiers: Modifiers) -> bool {
        let Modifiers { alt, shift, command, .. } = modifiers;
        self.clashes(Self { ctrl: command, shift, alt, key })
    }

    /// True if one press would be both.
    #[must_use]
    pub fn clashes(self, other: Self) -> bool {
        let plus = is_plus(self.key) && is_plus(other.key);
        (self.ctrl, self.alt) == (other.ctrl, other.alt)
            && (plus || (self.key, self.shift) == (other.key, other.shift))
    }

    /// The keys with arrows as signs, for sentences: `Alt+→`.
    #[must_use]
    pub fn with_signs(self) -> String {
        let sign = OTHER_NAMES[..4].iter().find(|(_, key)| *key == self.key);
        let name = self.to_string();
        sign.map_or_else(|| name.clone(), |(sign, key)| name.replace(key.name(), sign))
    }
}

fn unknown_key(name: &str) -> String {
    let names = Key::ALL.iter().filter(|key| is_command_key(**key)).map(|key| (key.name(), key.name()));
    match nearest(name, names) {
        _ if name.is_empty() => "it has no key".to_owned(),
        Some(near) => format!("{} is not a key; did you mean {}?", quoted(name), quoted(near)),
        None => format!(
            "{} is not a key; keys are, for example, S, 7, F4, Left, PageUp, Space and Comma",
            quoted(name)
        ),
    }
}

impl Display for Shortcut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ctrl = if cfg!(target_os = "macos") { "Cmd+" } else { "Ctrl+" };
        let held = [(self.ctrl, ctrl), (self.alt, "Alt+"), (self.shift, "Shift+")];
        for (_, word) in held.into_iter().filter(|(held, _)| *held) {
            f.write_str(word)?;
        }
        f.write_str(match self.key {
            key if is_plus(key) => "+",
            Key::Minus => "−",
            key => key.name(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_as_they_are_written_and_in_other_spellings() {
        for key in Key::ALL.iter().filter(|key| is_command_key(**key)) {
            for [ctrl, shift, alt] in [[false; 3], [true, false, false], [true, true, true]] {
                let shortcut = Shortcut { ctrl, shift, alt, key: *key };
                let read = Shortcut::read(&shortcut.to_string());
                assert!(read.is_ok_and(|read| read.clashes(shortcut)), "{shortcut}");
            }
        }
        for (written, read) in [
            ("ctrl + shift + s", "Ctrl+Shift+S"),
            ("Cmd+Page Up", "Ctrl+PageUp"),
            ("Alt+→", "Alt+Right"),
            ("Ctrl++", "Ctrl++"),
            ("+", "+"),
            ("Ctrl+Plus", "Ctrl++"),
            ("Ctrl+-", "Ctrl+−"),
            ("del", "Delete"),
            (",", "Comma"),
        ] {
            assert_eq!(Shortcut::read(written).map(|s| s.to_string()), Ok(read.to_owned()), "{written}");
        }
        assert_eq!(Shortcut::read("Alt+Right").map(Shortcut::with_signs), Ok("Alt+→".to_owned()));
    }

    #[test]
    fn what_is_no_key_is_refused_with_what_would_be_one() {
        for (written, part) in [
            ("Strg+S", "\"Strg\" is not a modifier; use Ctrl, Shift or Alt"),
            ("Ctrl+Spcae", "did you mean \"Space\"?"),
            ("Ctrl+", "it has no key"),
            ("", "it has no key"),
            ("Ctrl+Shift", "\"Shift\" is not a key"),
            ("ShiftLeft", "is not a key"),
            ("Ctrl+S Ctrl+T", "\"S Ctrl\" is not a modifier"),
        ] {
            let why = Shortcut::read(written).map(|s| s.to_string()).unwrap_or_else(|why| why);
            assert!(why.contains(part), "{written}: {why}");
        }
    }

    #[test]
    fn shift_counts_except_with_plus() {
        let read = |text| Shortcut::read(text).expect("a key");
        assert!(!read("S").clashes(read("Shift+S")) && !read("S").clashes(read("Ctrl+S")));
        assert!(read("Ctrl++").clashes(read("Ctrl+Shift+Equals")));
        assert!(!read("Ctrl++").clashes(read("+")));
    }
}
