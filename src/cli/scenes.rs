//! The sources of scenes: a file, a link, standard input, or the default scene if none is given; and questions that
//! reading may raise.

use std::{
    io,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use super::{
    Options, ask, attended, progress,
    workshop::{Workshop, files_inside},
};
use crate::files::Shown as _;
use crate::{
    export::payload::{Payload, unpacking},
    failure::Failure,
    parameter::files_read,
    platform,
    scene::{
        Scene,
        error::LoadError,
        examples::{EXAMPLES, Example},
        link,
        load::{self, Defaults, Loaded, Missing, Stamp},
    },
    text::listed,
};

/// Name of the scene inside this program, in messages.
const INSIDE: &str = "the scene inside this program";
/// Name of a link with a scene in it, in messages.
const LINK: &str = "link";

/// The source of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// No scene on the command line.
    Default,
    /// One of [`EXAMPLES`].
    Example(usize),
    /// No scene on the command line of a program that carries one.
    Inside(Arc<Payload>),
    /// `-`.
    Stdin,
    /// A link with a scene in it, or a scene of the site that the address of the page names: its name, and its text or what
    /// is wrong.
    Address(String, Result<Vec<u8>, String>),
    /// A file.
    File(PathBuf),
}

impl Source {
    /// The source given by an argument; without one, the scene inside this program, or the default scene.
    pub(super) fn of(argument: Option<&Path>, workshop: &Workshop) -> Self {
        match (argument, &workshop.inside) {
            (Some(path), _) => Self::shipped(path).unwrap_or_else(|| Self::named(path)),
            (None, Some(inside)) => Self::Inside(inside.clone()),
            (None, None) => Self::Default,
        }
    }

    /// The shipped scene with this name, with or without the ending of its file, where there are no files; or else the scene
    /// that the page has loaded under this name.
    fn shipped(name: &Path) -> Option<Self> {
        let is = |example: &Example| {
            let file = Path::new(example.file);
            file == name || file.file_stem() == Some(name.as_os_str())
        };
        if platform::SHARES_FILES {
            return None;
        }
        EXAMPLES.iter().position(is).map(Self::Example).or_else(|| {
            let name = name.to_str()?;
            Some(Self::Address(name.to_owned(), platform::loaded(name)?))
        })
    }

    /// The source with this name.
    pub(super) fn named(path: &Path) -> Self {
        match path.to_str().and_then(link::found) {
            Some(link) => Self::Address(LINK.to_owned(), link::unpacked(link).map(String::into_bytes)),
            None if path == Path::new("-") => Self::Stdin,
            None => Self::File(path.to_owned()),
        }
    }

    /// The path of the source, which no result may replace.
    pub(super) fn path(&self) -> Option<&Path> {
        match self {
            Self::Default | Self::Inside(_) | Self::Example(_) | Self::Address(..) => None,
            // A shell may have connected it to a file.
            Self::Stdin => Some(Path::new("/dev/stdin")),
            Self::File(path) => Some(path),
        }
    }

    /// The name for pictures of the scene.
    pub(super) fn stem(&self) -> String {
        match self {
            Self::Default | Self::Example(_) => "default".to_owned(),
            Self::Inside(inside) => inside.about.stem.clone(),
            Self::Stdin => "stdin".to_owned(),
            Self::Address(name, _) => stem(Path::new(name)),
            Self::File(path) => stem(path),
        }
    }

    /// The name in messages.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Default => "the default scene".to_owned(),
            Self::Example(i) => EXAMPLES[*i].file.to_owned(),
            Self::Inside(_) => INSIDE.to_owned(),
            Self::Stdin => load::STDIN.to_owned(),
            Self::Address(name, _) => name.clone(),
            Self::File(path) => path.shown().to_string(),
        }
    }

    /// The name in JSON.
    pub(super) fn plain_name(&self) -> String {
        match self {
            Self::File(path) => path.to_string_lossy().into_owned(),
            _ => self.name(),
        }
    }

    /// Reads the scene without questions.
    pub(super) fn read(&self, workshop: &mut Workshop, defaults: Defaults) -> Result<Loaded, LoadError> {
        match self {
            Self::Default => {
                Ok(Loaded { scene: Scene::default(), missing: Vec::new(), stamp: Stamp::of(&[]) })
            }
            Self::Example(i) => {
                let Example { text, file, .. } = &EXAMPLES[*i];
                load::from_text(text, file, &workshop.registry, defaults)
            }
            Self::Inside(inside) => {
                // Failure to unpack them was reported when the folders were looked up.
                let folder = files_inside(inside).ok().flatten().unwrap_or_default();
                workshop.load_in(&inside.scene, (INSIDE, &folder), defaults)
            }
            Self::Stdin => {
                workshop.load(&load::all_of(io::stdin().lock(), load::STDIN)?, load::STDIN, defaults)
            }
            Self::Address(name, Ok(bytes)) => workshop.load(bytes, name, defaults),
            Self::Address(name, Err(what)) => {
                Err(LoadError::Address { name: name.clone(), what: what.clone() })
            }
            Self::File(path) => {
                let bytes = load::input_bytes(path, &workshop.registry)?;
                let options = workshop.options;
                watched(options, || workshop.load(&bytes, &path.shown().to_string(), defaults))
            }
        }
    }

    /// Reads the scene, with questions where needed.
    pub(super) fn open(&self, workshop: &mut Workshop, options: Options) -> Result<Scene, Failure> {
        match self.read(workshop, options.defaults()) {
            Ok(Loaded { scene, missing, .. }) if missing.is_empty() => Ok(scene),
            Ok(Loaded { scene, missing, .. }) => {
                let name = self.name();
                let said = format!("{name}: missing: {}", parts(&missing));
                let refused = LoadError::Missing { name, missing };
                self.agreed(options, &format!("{said}. Use the defaults?"), &refused)?;
                options.detail(format_args!("{said}; defaults used"));
                Ok(scene)
            }
            Err(error @ LoadError::Empty { .. }) => {
                let question = format!("{} is empty. Load the default scene?", self.name());
                self.agreed(options, &question, &error).map(|()| Scene::default())
            }
            Err(error) => Err(self.invalid(&error)),
        }
    }

    /// Fails unless the flags or the user agree; with an error if there is nobody to ask, or the flags refuse.
    fn agreed(&self, options: Options, question: &str, error: &LoadError) -> Result<(), Failure> {
        let answer = match options.defaults() {
            Defaults::Use => Some(true),
            Defaults::Refuse => None,
            Defaults::Ask => ask(question),
        };
        match answer {
            Some(true) => Ok(()),
            Some(false) => Err(Failure::Invalid(format!("{} was not loaded", self.name()))),
            None => Err(self.invalid(error)),
        }
    }

    /// The failure for an error, with a remedy if it concerns a file unpacked by this program.
    fn invalid(&self, error: &LoadError) -> Failure {
        let message = error.to_string();
        let folder = match self {
            Self::Inside(inside) => files_inside(inside).ok().flatten(),
            _ => None,
        };
        let folder = folder.filter(|folder| message.contains(&*folder.to_string_lossy()));
        Failure::Invalid(match folder {
            Some(folder) => format!("{message}; {}", unpacking(&folder)),
            None => message,
        })
    }
}

/// The name of a file without its ending.
fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Shows the number of files read if reading them takes long.
fn watched<T>(options: Options, work: impl FnOnce() -> T) -> T {
    let [before, _] = files_read();
    let watch = move |goes_on: &dyn Fn() -> bool| {
        let bar = progress((files_read()[1] - before) as u64, options);
        bar.set_message("files");
        while goes_on() {
            let [done, all] = files_read();
            bar.set_length((all - before) as u64);
            bar.set_position((done - before) as u64);
        }
        bar.finish_and_clear();
    };
    attended(options, Duration::from_millis(500), watch, work)
}

/// The missing parts on one line.
fn parts(missing: &[Missing]) -> String {
    listed(&missing.iter().map(ToString::to_string).collect::<Vec<_>>(), "and")
}
