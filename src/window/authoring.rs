//! Files of one's own: writing new models, writing the shaders out, opening files in an editor. Nothing
//! here waits for another program.

use std::{
    fs,
    io::{self, Write as _},
    path::Path,
    process::{Command, Stdio},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};

use bevy::ecs::prelude::*;

/// The environment variable that names the editor: a command, split at spaces. `{file}` and `{line}` stand
/// for the file and the line; without `{file}` the file comes last.
pub const EDITOR_VARIABLE: &str = "LCM_EDITOR";
/// A command that fails within this time is told of.
const PATIENCE: Duration = Duration::from_secs(5);

/// The command that opens a file at a line, program and arguments. None when the variable says nothing: then
/// the operating system chooses.
#[must_use]
pub fn editor_command(variable: Option<&str>, file: &Path, line: usize) -> Option<(String, Vec<String>)> {
    let variable = variable?;
    let named = variable.contains("{file}");
    let name = file.to_string_lossy();
    // Split first: a file name may hold spaces.
    let mut words = variable
        .split_whitespace()
        .map(|word| word.replace("{line}", &line.to_string()).replace("{file}", &name))
        .collect::<Vec<_>>();
    if words.is_empty() {
        return None;
    }
    if !named {
        words.push(name.into_owned());
    }
    let program = words.remove(0);
    Some((program, words))
}

/// What went wrong with editors that were started, told by the threads that wait for them.
#[derive(Clone, Debug, Default, Resource)]
pub struct Editors {
    complaints: Arc<Mutex<Vec<String>>>,
}

impl Editors {
    /// Opens a file in an editor, as `variable` (the value of [`EDITOR_VARIABLE`]) says, and comes back at
    /// once. `wake` is called when there is a complaint.
    pub fn open(
        &self,
        variable: Option<&str>,
        file: &Path,
        line: usize,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let command = editor_command(variable, file, line);
        let complaints = self.complaints.clone();
        let file = file.to_owned();
        thread::spawn(move || {
            let Err(why) = start(command, &file) else { return };
            let text = format!(
                "{} could not be opened in an editor: {why}. Open it by hand, or name an editor in the environment \
                 variable {EDITOR_VARIABLE}, such as \"code --goto {{file}}:{{line}}\".",
                file.display()
            );
            complaints.lock().unwrap_or_else(PoisonError::into_inner).push(text);
            wake();
        });
    }

    /// The complaints since the last call.
    #[must_use]
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.complaints.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Starts the editor. Waits a little, since many programs that cannot open a file say so by their exit status.
fn start(command: Option<(String, Vec<String>)>, file: &Path) -> Result<(), String> {
    let Some((program, arguments)) = command else {
        return open::that_detached(file).map_err(|e| e.to_string());
    };
    let mut child = Command::new(&program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|e| format!("the command {program} of {EDITOR_VARIABLE} does not start ({e})"))?;
    let started = Instant::now();
    match child.wait() {
        Ok(status) if !status.success() && started.elapsed() < PATIENCE => {
            Err(format!("the command {program} of {EDITOR_VARIABLE} ended with {status}"))
        }
        _ => Ok(()),
    }
}

/// Writes a file that does not exist yet, all or nothing; makes its folder where there is none.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] when there is such a file, which is left alone.
pub fn write_new(path: &Path, text: &str) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    // The name begins with a dot, so that whoever watches the folder knows it for what it is.
    let mut builder = tempfile::Builder::new();
    builder.prefix(".lcm-").suffix(".tmp");
    #[cfg(unix)]
    let mode = {
        use std::os::unix::fs::PermissionsExt as _;
        // As any program makes a new file; the umask of the user takes away from it.
        fs::Permissions::from_mode(0o666)
    };
    #[cfg(unix)]
    builder.permissions(mode);
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(text.as_bytes())?;
    file.as_file().sync_all()?;
    file.persist_noclobber(path).map_err(|e| e.error)?;
    Ok(())
}
