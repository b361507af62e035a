//! The editor that opens a file: the configured one, otherwise the default of the desktop for text, otherwise a known
//! editor with a window. Terminal editors are only used if the user has configured one, since others do not know how to
//! leave them.

use std::{
    env,
    ffi::OsString,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::{Arc, Mutex},
    time::Duration,
};

use bevy::ecs::prelude::*;
use web_time::Instant;

use crate::{
    caught::lock,
    files::{self, Shown as _},
    platform,
};

/// Environment variable with the editor command, split at spaces. `{file}` and `{line}` are replaced by file and line;
/// without `{file}`, the file is appended.
pub const EDITOR_VARIABLE: &str = "LCM_EDITOR";
/// A command that fails within this time is reported.
const PATIENCE: Duration = Duration::from_secs(5);
/// Maximum size of a desktop entry, in bytes.
const MAX_ENTRY_BYTES: u64 = 1 << 20;

/// Editors with their own window, the best for beginners first, and their arguments.
const KNOWN: &str = include_str!("editors.txt");

/// Terminals, and the arguments in front of a command.
const TERMINALS: &str = include_str!("terminals.txt");

/// Terminal editors that accept the line as `+12`.
const TAKE_A_PLUS: [&str; 8] = ["vi", "vim", "nvim", "nano", "pico", "emacs", "joe", "micro"];

/// A command: program and arguments.
type Called = (String, Vec<String>);

/// The lines of a table: a program, and the arguments that go with it.
fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    table.lines().map(|line| line.split_once(' ').unwrap_or((line, "")))
}

/// The command of a variable that opens a file at a line; `None` if the variable is unset or empty.
#[must_use]
pub fn editor_command(variable: Option<&str>, file: &Path, line: usize) -> Option<Called> {
    let variable = variable?;
    let (program, mut arguments) = called(filled(variable, file, line))?;
    if !variable.contains("{file}") {
        arguments.push(file.to_string_lossy().into_owned());
    }
    Some((program, arguments))
}

/// The words of a command, of which the first is the program.
fn called(mut words: Vec<String>) -> Option<Called> {
    (!words.is_empty()).then(|| (words.remove(0), words))
}

/// A desktop application.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Application {
    /// The command, with the field codes of the specification.
    pub exec: String,
    /// True if the application runs in a terminal.
    pub terminal: bool,
}

impl Application {
    /// Parses a desktop entry.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let entry = text.lines().skip_while(|l| l.trim() != "[Desktop Entry]").skip(1);
        let mut entry = entry.take_while(|line| !line.starts_with('[')).filter_map(|l| l.split_once('='));
        let mut found = Self::default();
        for (key, value) in entry.by_ref() {
            match key.trim() {
                "Exec" => value.trim().clone_into(&mut found.exec),
                "Terminal" => found.terminal = value.trim() == "true",
                _ => {}
            }
        }
        (!found.exec.is_empty()).then_some(found)
    }

    /// The command that opens a file.
    fn opens(&self, file: &Path, line: usize) -> Option<Called> {
        let (program, words) = called(unquoted(&self.exec))?;
        if let Some(known) = known(&program) {
            return Some((program, filled(known, file, line)));
        }
        let name = file.to_string_lossy().into_owned();
        let mut arguments: Vec<String> = Vec::new();
        let mut named = false;
        for word in words {
            match &*word {
                "%f" | "%F" | "%u" | "%U" => {
                    named = true;
                    arguments.push(name.clone());
                }
                field if field.len() == 2 && field.starts_with('%') => {}
                _ => arguments.push(word.replace("%%", "%")),
            }
        }
        if !named {
            arguments.push(name);
        }
        Some((program, arguments))
    }
}

/// The words of the command in a desktop entry, with quotes resolved.
fn unquoted(exec: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    let mut characters = exec.chars();
    while let Some(c) = characters.next() {
        let last = words.len() - 1;
        match c {
            '"' => quoted = !quoted,
            '\\' if quoted => words[last].extend(characters.next()),
            c if c.is_whitespace() && !quoted => words.push(String::new()),
            c => words[last].push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The arguments for a known editor, by its name or path.
fn known(program: &str) -> Option<&'static str> {
    let name = Path::new(program).file_name()?.to_str()?;
    rows(KNOWN).find(|(known, _)| *known == name).map(|(_, how)| how)
}

/// The words of a command for a file and a line. It is split first: a file name may contain spaces.
fn filled(how: &str, file: &Path, line: usize) -> Vec<String> {
    let (name, line) = (file.to_string_lossy(), line.to_string());
    how.split_whitespace().map(|word| word.replace("{line}", &line).replace("{file}", &name)).collect()
}

/// The available editors.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// The value of [`EDITOR_VARIABLE`].
    pub named: Option<String>,
    /// Values of `VISUAL` and `EDITOR`, if set.
    pub usual: Vec<String>,
    /// The desktop's default application for text files.
    pub default: Option<Application>,
    /// Folders searched for programs.
    pub path: Vec<PathBuf>,
}

impl Surroundings {
    /// The editors available to this process; `named` is the value of [`EDITOR_VARIABLE`]. Queries the desktop, which
    /// may take a moment.
    #[must_use]
    pub fn of_process(named: Option<String>) -> Self {
        let given = |name: &str| env::var(name).ok().filter(|value| !value.trim().is_empty());
        let path = env::var_os("PATH").unwrap_or_default();
        Self {
            default: if named.is_some() { None } else { default_application() },
            named,
            usual: ["VISUAL", "EDITOR"].into_iter().filter_map(given).collect(),
            path: env::split_paths(&path).collect(),
        }
    }

    fn has(&self, program: &str) -> bool {
        Path::new(program).is_absolute() && Path::new(program).is_file()
            || self.path.iter().any(|folder| folder.join(program).is_file())
    }

    /// The command that opens a file at a line.
    #[must_use]
    pub fn editor(&self, file: &Path, line: usize) -> Option<Called> {
        editor_command(self.named.as_deref(), file, line)
            .or_else(|| self.of_system(file))
            .or_else(|| {
                let default = self.default.as_ref().filter(|default| !default.terminal)?;
                default.opens(file, line).filter(|(program, _)| self.has(program))
            })
            .or_else(|| self.usual.iter().find_map(|usual| self.with_window(usual, file, line)))
            .or_else(|| rows(KNOWN).find_map(|(name, _)| self.with_window(name, file, line)))
            .or_else(|| self.usual.iter().find_map(|usual| self.in_terminal(usual, file, line)))
    }

    /// The command that opens text on a system with a standard command for it.
    fn of_system(&self, file: &Path) -> Option<Called> {
        let arguments = || vec!["-t".to_owned(), file.to_string_lossy().into_owned()];
        cfg!(target_os = "macos").then(|| ("open".to_owned(), arguments()))
    }

    /// The command if it runs a known editor with a window, and the program exists.
    fn with_window(&self, command: &str, file: &Path, line: usize) -> Option<Called> {
        let mut words = command.split_whitespace().map(str::to_owned);
        let program = words.next().filter(|program| self.has(program))?;
        let how = known(&program)?;
        Some((program, words.chain(filled(how, file, line)).collect()))
    }

    /// The command in a terminal, if both exist.
    fn in_terminal(&self, command: &str, file: &Path, line: usize) -> Option<Called> {
        let words: Vec<_> = command.split_whitespace().map(str::to_owned).collect();
        let program = words.first().filter(|program| self.has(program))?;
        let (terminal, between) = rows(TERMINALS).find(|(terminal, _)| self.has(terminal))?;
        let mut arguments: Vec<_> = between.split_whitespace().map(str::to_owned).collect();
        let name = Path::new(program).file_name().unwrap_or_default();
        let plus = TAKE_A_PLUS.iter().any(|known| name == *known);
        arguments.extend(words.iter().cloned());
        arguments.extend(plus.then(|| format!("+{line}")));
        arguments.push(file.to_string_lossy().into_owned());
        Some((terminal.to_owned(), arguments))
    }
}

/// The desktop's default application for plain text.
fn default_application() -> Option<Application> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    let asked = Command::new("xdg-mime")
        .args(["query", "default", "text/plain"])
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let id = String::from_utf8(asked.stdout).ok()?;
    let id = id.trim().split(';').next().filter(|id| !id.is_empty() && !id.contains('/'))?.to_owned();
    let own = directories::BaseDirs::new().map(|dirs| dirs.data_dir().to_owned());
    let shared = env::var_os("XDG_DATA_DIRS").filter(|dirs| !dirs.is_empty());
    let shared = shared.unwrap_or_else(|| OsString::from("/usr/local/share:/usr/share"));
    let folders: Vec<_> = own.into_iter().chain(env::split_paths(&shared)).collect();
    // A dash may represent a subfolder.
    [id.clone(), id.replacen('-', "/", 1)].iter().find_map(|id| {
        folders.iter().find_map(|folder| {
            let bytes = files::read(&folder.join("applications").join(id), MAX_ENTRY_BYTES).ok()?;
            Application::read(&String::from_utf8_lossy(&bytes))
        })
    })
}

/// Problems of started editors, collected from the threads that wait for them.
#[derive(Clone, Debug, Default, Resource)]
pub struct Editors {
    complaints: Arc<Mutex<Vec<String>>>,
}

impl Editors {
    /// Opens a file in an editor and returns at once; `variable` is the value of [`EDITOR_VARIABLE`]. Calls `wake` if
    /// there is a problem.
    pub fn open(
        &self,
        variable: Option<&str>,
        file: &Path,
        line: usize,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let named = variable.filter(|variable| !variable.trim().is_empty()).map(str::to_owned);
        let complaints = self.complaints.clone();
        let file = file.to_owned();
        platform::once(move || {
            let Err(why) = start(named, &file, line) else { return };
            let text = format!(
                "{} could not be opened in an editor: {why}. Open it by hand, or name an editor in the environment \
                 variable {EDITOR_VARIABLE}, such as \"code --goto {{file}}:{{line}}\".",
                file.shown()
            );
            lock(&complaints).push(text);
            wake();
        });
    }

    /// The problems since the last call.
    #[must_use]
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut *lock(&self.complaints))
    }
}

/// Starts the editor and waits for it, since many programs report by their exit status that they cannot open a file.
fn start(named: Option<String>, file: &Path, line: usize) -> Result<(), String> {
    if !platform::HAS_PROGRAMS {
        return Err("a page in a browser cannot start one".to_owned());
    }
    let of = if named.is_some() { format!(" of {EDITOR_VARIABLE}") } else { String::new() };
    let Some((program, arguments)) = Surroundings::of_process(named).editor(file, line) else {
        return otherwise(file);
    };
    let mut child = Command::new(&program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|e| format!("the command {program}{of} could not be started ({})", files::words(&e)))?;
    let started = Instant::now();
    match child.wait() {
        Ok(status) if !status.success() && started.elapsed() < PATIENCE => {
            Err(format!("the command {program}{of} ended with {status}"))
        }
        _ => Ok(()),
    }
}

/// The fallback if no editor is found.
fn otherwise(file: &Path) -> Result<(), String> {
    if cfg!(target_os = "linux") {
        return Err("no editor with a window was found".to_owned());
    }
    platform::open(file).map_err(|e| files::words(&e))
}
