//! Saving and copying pictures of the window: views are read back once they are idle; the rest happens in a separate
//! thread.

use std::{
    borrow::Cow,
    collections::VecDeque,
    path::{Path, PathBuf},
    sync::Mutex,
    time::{Duration, Instant},
};

use arboard::{Clipboard, ImageData};
use bevy::{prelude::*, window::RequestRedraw};

use super::{
    background::Background,
    readback::{Reading, SeenViews},
    views::ShownViews,
};
use crate::{
    caption,
    caught::lock,
    compare::{compose, size_around},
    export::write::inputs,
    files::{self, Shown as _, words},
    optics::TermSelection,
    panel::state::{Effect, PictureEnd, Question, Session},
    registry::Registry,
    render::{
        capture::png::{self, About},
        view::{Drawing, ViewSystems},
    },
    scene::{
        Scene,
        comparison::{Compared, Layout},
        variant::LETTERS,
    },
};

/// Saves and copies pictures.
#[derive(Clone, Copy, Debug, Default)]
pub struct PicturesPlugin;

impl Plugin for PicturesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Pictures>().add_systems(PostUpdate, take.after(ViewSystems));
    }
}

/// The requested pictures, and the one being written.
#[derive(Debug, Default, Resource)]
struct Pictures {
    /// Requests in their order of arrival.
    wanted: VecDeque<Wanted>,
    reading: Option<Reading>,
    /// The job for the picture that is being read back.
    job: Option<Job>,
    work: Background<(), PictureEnd>,
}

/// A requested picture: of a single view or of all, to a file or to the clipboard.
#[derive(Clone, Debug)]
struct Wanted {
    view: Option<usize>,
    file: Option<PathBuf>,
    since: Instant,
}

/// Maximum time to wait for views: those of a scene that a system moves are never idle.
const PATIENCE: Duration = Duration::from_secs(5);

fn take(
    views: ShownViews,
    registry: Res<Registry>,
    mut effects: MessageReader<Effect>,
    mut session: ResMut<Session>,
    mut pictures: ResMut<Pictures>,
    mut requests: MessageWriter<RequestRedraw>,
    mut commands: Commands,
) {
    for effect in effects.read() {
        let Effect::Picture { view, file, overwrite } = effect.clone() else { continue };
        // The user need not type the extension of pictures.
        let file =
            file.map(|file| if file.extension().is_none() { file.with_extension("png") } else { file });
        match file.as_deref().map_or(Ok(true), |file| may_write(file, overwrite, &session, &registry)) {
            Ok(true) => pictures.wanted.push_back(Wanted { view, file, since: Instant::now() }),
            Ok(false) => {
                let path = file.unwrap_or_default();
                session.questions.ask(Question::ReplacePicture { view, path });
            }
            Err(why) => session.pictured(PictureEnd::Failed(why)),
        }
    }
    if let Some(end) = pictures.work.take() {
        session.pictured(end);
    }
    if let Err(why) = pictures.begin(&views, &session, &registry, &mut commands) {
        return session.pictured(PictureEnd::Failed(why));
    }
    let Pictures { reading, job, work, wanted } = &mut *pictures;
    if let Some(read) = job.as_ref().and_then(|_| Reading::end(reading, &mut commands))
        && let Some(job) = job.take()
    {
        let broken = PictureEnd::Failed("The picture was not taken: an internal error.".to_owned());
        work.begin((), || {}, broken, move |_| job.run(&read));
    }
    if !wanted.is_empty() || job.is_some() || work.running().is_some() {
        requests.write(RequestRedraw);
    }
}

impl Pictures {
    /// Begins to read back the views of the first picture that is wanted, once they are idle. Returns why there cannot be
    /// such a picture.
    fn begin(
        &mut self,
        views: &ShownViews,
        session: &Session,
        registry: &Registry,
        commands: &mut Commands,
    ) -> Result<(), String> {
        let busy = self.job.is_some() || self.work.running().is_some();
        let wanted = self.wanted.front().cloned().filter(|_| !busy);
        let Some(Wanted { view, file, since }) = wanted else { return Ok(()) };
        let numbers = shown(session, views.cells().iter().map(|cell| cell.view).collect(), view);
        let found: Option<Vec<_>> = numbers.iter().map(|number| views.find(*number)).collect();
        let Some(found) = found else {
            self.wanted.pop_front();
            let letter = view.and_then(|view| LETTERS.get(view)).copied().unwrap_or_default();
            return Err(format!(
                "No picture was taken: view {letter} is not on screen. Choose a layout with it."
            ));
        };
        // A converging view becomes idle eventually; one that keeps restarting does not.
        let converges = |drawing: &Drawing| drawing.converged().done > 1 && !drawing.is_done();
        let waits = found.iter().any(|view| converges(view.drawing));
        let rest = found.iter().all(|view| view.drawing.rests()) || !waits && since.elapsed() > PATIENCE;
        let textures: Option<Vec<_>> =
            found.iter().map(|view| view.texture().filter(|_| rest).cloned()).collect();
        if let (Some(textures), Some(first)) = (textures, found.first()) {
            self.reading = Some(Reading::begin(&textures, commands));
            self.job = Some(Job {
                views: SeenViews::of(session, &numbers, first.view.size, registry),
                camera_is_free: session.facts.camera_is_free,
                caption: session.settings.picture_caption,
                // A layout that shows a single view also means that view alone.
                alone: view.is_some() || matches!(numbers.as_slice(), [shown] if *shown > 0),
                file,
            });
            self.wanted.pop_front();
        }
        Ok(())
    }
}

/// The views of the picture, in the order of the layout: those on screen; of alternating views, only the visible one.
fn shown(session: &Session, cells: Vec<usize>, alone: Option<usize>) -> Vec<usize> {
    let blinks = session.document.comparison.layout.is_in_turn();
    match (alone, cells.as_slice()) {
        (Some(view), _) => vec![view],
        (None, []) => vec![0],
        (None, [first, second, ..]) if blinks => {
            vec![if session.view.blinking { *second } else { *first }]
        }
        (None, _) => cells,
    }
}

/// Returns false if the file exists, so that the user must be asked.
fn may_write(file: &Path, overwrite: bool, session: &Session, registry: &Registry) -> Result<bool, String> {
    if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        let png = file.with_extension("png");
        return Err(format!(
            "The picture was not saved to {}: only PNG files can be written; name it {}.",
            file.shown(),
            png.file_name().unwrap_or_default().to_string_lossy()
        ));
    }
    let inputs = inputs(session.path.as_deref(), [session.document.scene()], registry);
    files::may_overwrite(file, files::PNG, inputs.iter().map(PathBuf::as_path))
        .map_err(|refused| format!("The picture was not saved: {refused}."))?;
    Ok(overwrite || !file.exists())
}

/// A picture with all its inputs.
#[derive(Debug)]
struct Job {
    views: SeenViews,
    /// True if the camera is not at the observer of the scene.
    camera_is_free: bool,
    caption: bool,
    /// True for a picture of a single view, even if the scene has others.
    alone: bool,
    file: Option<PathBuf>,
}

impl Job {
    fn run(self, read: &[Vec<u8>]) -> PictureEnd {
        let drawn = self.draw(read);
        let end = drawn.and_then(|(rgb8, size)| match &self.file {
            Some(file) => self.save(file, &rgb8, size).map(|()| PictureEnd::Saved(file.clone())),
            None => copy(&rgb8, size).map(|()| PictureEnd::Copied(size)),
        });
        end.unwrap_or_else(PictureEnd::Failed)
    }

    /// The RGB pixels of the picture, and its size.
    fn draw(&self, read: &[Vec<u8>]) -> Result<(Vec<u8>, [u32; 2]), String> {
        let SeenViews { scene, registry, shown, size, .. } = &self.views;
        let mut comparison = scene.comparison;
        if shown.len() < 2 {
            comparison.layout = Layout::Single;
        }
        let is_map = comparison.layout.is_map();
        let pictures = self.views.pictures(read, is_map && comparison.values == Compared::Light, is_map)?;
        let size = match comparison.layout {
            Layout::Single => size.to_array(),
            _ => size_around(&comparison, scene.variants.len(), size.to_array()),
        };
        let rgb8 = compose(&comparison, size, &pictures).map_err(|e| e.to_string())?;
        if !self.caption {
            return Ok((rgb8, size));
        }
        let seen = |(view, terms): &(usize, TermSelection)| Some((*view, self.views.seen(*view)?, *terms));
        let seen: Vec<_> = shown.iter().filter_map(seen).collect();
        let shown: Vec<_> = seen.iter().map(|(view, seen, terms)| (*view, seen, *terms)).collect();
        Ok(caption::draw(&caption::of_picture(scene, &shown, registry), rgb8, size))
    }

    fn save(&self, file: &Path, rgb8: &[u8], [width, height]: [u32; 2]) -> Result<(), String> {
        let about = About::scene(&self.pictured(), &self.views.registry).with("Renderer", "GPU");
        png::write(file, width, height, rgb8, &about)
            .map_err(|error| format!("{} could not be written: {}.", file.shown(), words(&error)))
    }

    /// The scene of the picture, with the observer at the camera, so that opening the picture shows the same view.
    fn pictured(&self) -> Scene {
        let SeenViews { scene, registry, shown, camera, .. } = &self.views;
        let alone = shown.first().filter(|_| self.alone);
        let alone = alone.and_then(|(view, _)| scene.seen(*view, registry));
        let mut scene = alone.map_or_else(|| scene.clone(), |(seen, _)| seen.alone());
        if self.camera_is_free {
            scene.observer = *camera;
        }
        scene
    }
}

/// Copies a picture to the clipboard. Under X11, it stays there while this program runs.
fn copy(rgb8: &[u8], [width, height]: [u32; 2]) -> Result<(), String> {
    static CLIPBOARD: Mutex<Option<Clipboard>> = Mutex::new(None);
    let rgba: Vec<u8> = rgb8.as_chunks::<3>().0.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
    let picture = ImageData { width: width as usize, height: height as usize, bytes: Cow::Owned(rgba) };
    let mut clipboard = lock(&CLIPBOARD);
    let set = match &mut *clipboard {
        Some(clipboard) => clipboard.set_image(picture),
        none => Clipboard::new().and_then(|new| none.insert(new).set_image(picture)),
    };
    set.map_err(|error| format!("The picture was not copied: {error}. Save it instead."))
}
