//! The name of the program, and folders named after it: other programs are made with this library, and none
//! touches the files of another one.

use std::{borrow::Cow, env, path::PathBuf, sync::OnceLock};

/// The name of the lab itself, and of its folders.
pub const LAB: &str = "lights-camera-models";
/// The lab's name for people.
pub const LAB_TITLE: &str = "Lights, Camera, Models!";
/// The lab's name on the command line.
const COMMAND: &str = "lcm";
/// The hidden command that tries shaders in a process of its own, lest they end this one.
pub const TRY_SHADERS: &str = "try-shaders";
/// True if the program was built with the window, and with it the GPU renderer.
pub const HAS_WINDOW: bool = cfg!(feature = "window");
/// The folder that contains the folders of other programs.
const OTHERS: &str = "programs";

static NAME: OnceLock<String> = OnceLock::new();

/// Names this program, once, before anything else in this library is called. Without it, the name is that of
/// the executable file. Letters, digits, `-` and `_` are kept, anything else becomes `_`. Returns false if
/// the program already has a name.
///
/// ```
/// lights_camera_models::program::set_name("my-lab");
/// assert_eq!(lights_camera_models::program::name(), "my-lab");
/// ```
pub fn set_name(name: &str) -> bool {
    NAME.set(fit(name)).is_ok()
}

/// The name of this program.
#[must_use]
pub fn name() -> &'static str {
    NAME.get_or_init(|| {
        let file = env::current_exe().ok();
        let stem = file.as_ref().and_then(|file| file.file_stem()).map(|stem| stem.to_string_lossy());
        fit(&stem.unwrap_or_default())
    })
}

/// A name as a folder name.
fn fit(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' };
    let name: String = name.chars().take(100).map(plain).collect();
    if name.is_empty() { "program".to_owned() } else { name }
}

/// The name of this program for people: in the titles of its window and its manual.
#[must_use]
pub fn title() -> &'static str {
    if name() == LAB { LAB_TITLE } else { name() }
}

/// The name of the program on the command line.
#[must_use]
pub fn command() -> &'static str {
    if name() == LAB { COMMAND } else { name() }
}

/// The answer to a request that needs the window or the GPU in a program without them, with what to do instead.
#[must_use]
pub fn without_window(remedy: &str) -> String {
    format!("{} was built without the window: {remedy}", command())
}

/// The folder of this program within one shared by all programs, for files that it alone writes: settings,
/// copies of unsaved work, progress in lessons.
#[must_use]
pub fn own(shared: PathBuf) -> PathBuf {
    if name() == LAB { shared } else { shared.join(OTHERS).join(name()) }
}

/// A text in which the lab names itself and its commands, with the names of this program inserted.
#[must_use]
pub fn in_own_name(text: &str) -> String {
    in_own_words(text).replace(LAB_TITLE, title())
}

/// A text in which the lab names its commands, with the name of this program inserted.
#[must_use]
pub fn in_own_words(text: &str) -> Cow<'_, str> {
    replaced(text, command())
}

fn replaced<'a>(text: &'a str, name: &str) -> Cow<'a, str> {
    if name == COMMAND || !text.contains(COMMAND) {
        return Cow::Borrowed(text);
    }
    let mut own = String::with_capacity(text.len() + 32);
    let mut rest = text;
    while let Some(at) = rest.find(COMMAND) {
        let (before, from) = rest.split_at(at);
        let after = &from[COMMAND.len()..];
        // A command with arguments or alone; neither a part of a name, nor the comment of a custom model, `/*
        // lcm {`.
        let mut next = after.chars();
        let begins =
            !before.ends_with(|c: char| c.is_alphanumeric() || "/_-.".contains(c)) && !before.ends_with("* ");
        let ends = match next.next() {
            Some(' ') => next.next().is_none_or(|c| c.is_ascii_lowercase() || "-[< ".contains(c)),
            Some('`') => true,
            _ => false,
        };
        own.push_str(before);
        own.push_str(if begins && ends { name } else { COMMAND });
        rest = after;
    }
    own.push_str(rest);
    Cow::Owned(own)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_that_of_a_folder() {
        assert_eq!(fit("my lab/../../x"), "my_lab_______x");
        assert_eq!(fit(".."), "__");
        assert_eq!(fit(""), "program");
        assert_eq!(fit("größe-2"), "größe-2");
        assert_eq!(fit(&"x".repeat(1000)).len(), 100);
        // The name of the tests is that of their executable.
        assert!(name().starts_with("lights_camera_models"), "{}", name());
        let own = own(PathBuf::from("/data"));
        assert!(own.starts_with("/data/programs/") && own.ends_with(name()), "{own:?}");
    }

    #[test]
    fn commands_have_the_name_of_the_program() {
        let lab =
            "`lcm render` makes pictures, `lcm` shows; lcm models check ID; Usage: lcm [OPTIONS]; lcm  # a";
        let own = "`velvet render` makes pictures, `velvet` shows; velvet models check ID; \
                   Usage: velvet [OPTIONS]; velvet  # a";
        assert_eq!(replaced(lab, "velvet"), own);
        assert!(matches!(replaced(lab, COMMAND), Cow::Borrowed(_)));
        assert_eq!(in_own_name("*Lights, Camera, Models!* is here"), format!("*{}* is here", name()));
        let others = "/* lcm { \"name\": 1 } */ /tmp/lcm x.lcm my-lcm render lcm_screen.png";
        assert_eq!(replaced(others, "velvet"), others);
    }
}
