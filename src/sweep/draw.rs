//! The pictures of a sweep, drawn side by side: each core has a picture of its own, and helps with the others' when there
//! are too few left.

use std::{
    path::Path,
    sync::{
        atomic::{AtomicBool, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    time::Duration,
};

use rayon::prelude::*;

use super::{
    Sweep,
    parts::{self, Parts, unwritten},
};
use crate::{
    caption::Sampled,
    compare::{Cell, View, with_row_labels},
    failure::Failure,
    files::Shown as _,
    picture::png::{self, About},
    platform,
    progress::{Cancelled, Progress},
    reference::{self, Until},
    registry::Registry,
    scene::Scene,
    text::plural,
};

/// The time after which it is asked again whether the user has cancelled.
const PULSE: Duration = Duration::from_millis(50);

/// The settings of all pictures of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The width and height of each picture, pixels.
    pub size: [u32; 2],
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
    /// The samples of lights with extent.
    pub until: Until,
}

impl Default for Settings {
    fn default() -> Self {
        let reference::Settings { width, height, samples, .. } = reference::Settings::default();
        Self { size: [width, height], samples, until: Until::default() }
    }
}

/// The pictures of a sweep.
#[derive(Clone, Debug, Default)]
pub struct Drawn {
    /// Red, green, blue, row by row from the top: a picture for each combination, the first axis varying fastest.
    pub pictures: Vec<Vec<u8>>,
    /// The sampling of lights with extent, for pictures with such lights.
    pub sampled: Vec<Sampled>,
    /// Number of pictures that were there already.
    pub kept: usize,
}

/// The files of a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Number of files drawn and written.
    pub drawn: usize,
    /// Number of files that were there already, from an earlier run.
    pub kept: usize,
}

/// Fails if a scene cannot be drawn.
pub type Check<'a> = &'a (dyn Fn(&Scene) -> Result<(), Failure> + Sync);

/// Draws the pictures of a sweep. `parts` keeps finished ones for another run, if this one is interrupted.
///
/// # Errors
/// Returns an error if the user cancels, if a scene cannot be drawn, or if a part cannot be written.
pub fn pictures(
    sweep: &Sweep,
    settings: &Settings,
    parts: Option<&Parts>,
    check: Check,
    progress: &Progress,
) -> Result<Drawn, Failure> {
    let all = each(sweep.count(), progress, |i, cancelled| {
        let one = One::new(sweep, settings, i)?;
        if let Some(rgb8) = parts.and_then(|parts| parts.find(i, &one.stamp, settings.size)) {
            return Ok((rgb8, None, true));
        }
        let (rgb8, sampled) = one.draw(check, cancelled)?;
        if let Some(parts) = parts {
            parts.keep(i, &one.stamp, settings.size, &rgb8)?;
        }
        Ok((rgb8, sampled, false))
    })?;
    let mut drawn = Drawn::default();
    for (rgb8, sampled, was_there) in all {
        drawn.pictures.push(rgb8);
        drawn.sampled.extend(sampled);
        drawn.kept += usize::from(was_there);
    }
    Ok(drawn)
}

/// Draws the pictures of a sweep into a folder, each [named](Sweep::file) after its values, with its scene. Files that an
/// earlier run of the same sweep wrote are kept. Files in their places that are none of them, drawn with another scene, other
/// settings or by another program, are replaced only if that is asked for.
///
/// # Errors
/// Returns an error if there are such other files, if the user cancels, if a scene cannot be drawn, or if a file cannot be
/// written. Files finished by then stay.
pub fn files(
    sweep: &Sweep,
    settings: &Settings,
    (folder, overwrite): (&Path, bool),
    check: Check,
    progress: &Progress,
) -> Result<Written, Failure> {
    let [width, height] = settings.size;
    // Quick beside drawing, so its progress is not told.
    let silent = Progress { tell: &|_, _| (), cancelled: progress.cancelled };
    let places = each(sweep.count(), &silent, |i, _| place(sweep, settings, folder, i))?;
    if !overwrite {
        spare_others(sweep, folder, &places)?;
    }
    let all = each(sweep.count(), progress, |i, cancelled| {
        if places[i] == Place::Done {
            return Ok(true);
        }
        let one = One::new(sweep, settings, i)?;
        let file = folder.join(sweep.file(i));
        let (rgb8, _) = one.draw(check, cancelled)?;
        let rgb8 = labelled(rgb8, settings.size, &one.scene, sweep.registry);
        let about = About::scene(&one.scene.clone().alone(), sweep.registry).with("Renderer", "CPU");
        let about = about.with(parts::KEYWORD, one.stamp);
        png::write(&file, width, height, &rgb8, &about).map_err(|error| unwritten(&file, &error))?;
        Ok(false)
    })?;
    let kept = all.iter().filter(|kept| **kept).count();
    Ok(Written { drawn: all.len() - kept, kept })
}

/// The state of the place of a picture in a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Nothing, or a picture that an earlier run did not finish.
    Free,
    /// The finished picture.
    Done,
    /// Something else.
    Other,
}

fn place(sweep: &Sweep, settings: &Settings, folder: &Path, i: usize) -> Result<Place, Failure> {
    let file = folder.join(sweep.file(i));
    if !platform::fs::is_file(&file) {
        return Ok(Place::Free);
    }
    let stamp = One::new(sweep, settings, i)?.stamp;
    if parts::is_done(&file, &stamp, settings.size) {
        return Ok(Place::Done);
    }
    let begun = !stamp.is_empty() && png::text(&file, parts::KEYWORD).is_some_and(|own| own == stamp);
    Ok(if begun { Place::Free } else { Place::Other })
}

/// Refuses to replace pictures of something else, which have the same names.
fn spare_others(sweep: &Sweep, folder: &Path, places: &[Place]) -> Result<(), Failure> {
    let others = || (0..places.len()).filter(|i| places[*i] == Place::Other);
    let Some(first) = others().next() else { return Ok(()) };
    Err(Failure::Write(format!(
        "{} has {} in the place of this sweep's, such as {}: drawn with another scene, other files, settings or version; \
         --overwrite replaces them, -o FOLDER writes elsewhere",
        folder.shown(),
        plural(others().count(), "picture"),
        Path::new(&sweep.file(first)).shown()
    )))
}

/// A picture with the labels of its rows, as in that of `lcm render`.
fn labelled(rgb8: Vec<u8>, size: [u32; 2], scene: &Scene, registry: &Registry) -> Vec<u8> {
    let [width, height] = size;
    with_row_labels(rgb8, size, [(Cell { view: 0, left: 0, top: 0, width, height }, scene)], registry)
}

impl Drawn {
    /// The pictures with the labels of their rows, which differences do without.
    #[must_use]
    pub fn labelled(self, sweep: &Sweep, size: [u32; 2]) -> Vec<Vec<u8>> {
        // Making each scene once more takes as long as a small picture.
        if !sweep.scene.rows().any(|row| row.repeat.labels) {
            return self.pictures;
        }
        let with_labels = |(i, rgb8)| match sweep.seen(i) {
            Some((scene, _)) => labelled(rgb8, size, &scene, sweep.registry),
            None => rgb8,
        };
        self.pictures.into_iter().enumerate().map(with_labels).collect()
    }
}

/// A picture of a sweep.
struct One<'a> {
    scene: Scene,
    settings: reference::Settings,
    until: Until,
    stamp: String,
    registry: &'a Registry,
}

impl<'a> One<'a> {
    fn new(sweep: &Sweep<'a>, settings: &Settings, i: usize) -> Result<Self, Failure> {
        let none = || Failure::Invalid("there is no such view".to_owned());
        let (scene, terms) = sweep.seen(i).ok_or_else(none)?;
        let Settings { size: [width, height], samples, until } = *settings;
        let settings = reference::Settings { width, height, samples, terms };
        let stamp = parts::stamp(&scene, &settings, until, sweep.registry);
        Ok(Self { scene, settings, until, stamp, registry: sweep.registry })
    }

    /// Draws the picture as `lcm render` does, without the labels of rows.
    fn draw(&self, check: Check, cancelled: &AtomicBool) -> Result<(Vec<u8>, Option<Sampled>), Failure> {
        let Self { scene, settings, registry, .. } = self;
        check(scene)?;
        let view =
            View { scene, registry, settings: *settings, channel: None, until: self.until, lit: false };
        let ends = || cancelled.load(Ordering::Relaxed);
        let progress = Progress { tell: &|_, _| (), cancelled: &ends };
        let (shown, sampled) = view
            .draw(&AtomicBool::default(), &progress)
            .map_err(|undrawn| Failure::Invalid(undrawn.to_string()))?;
        // An endless function of a custom model is detected only when it runs.
        check(scene)?;
        Ok((shown.into_rgb8(), sampled))
    }
}

fn ended(cancelled: Cancelled) -> Failure {
    Failure::Invalid(cancelled.to_string())
}

/// Does some work for each number, on all cores, and collects the results in order. The calling thread reports the
/// progress.
fn each<T: Send>(
    count: usize,
    progress: &Progress,
    work: impl Fn(usize, &AtomicBool) -> Result<T, Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    let cancelled = AtomicBool::default();
    let (tell, told) = mpsc::channel::<()>();
    let (cancelled, work) = (&cancelled, &work);
    platform::beside(
        move || {
            let one = |tell: &mut mpsc::Sender<()>, i: usize| {
                if cancelled.load(Ordering::Relaxed) {
                    return Err(ended(Cancelled));
                }
                let done = work(i, cancelled)?;
                // Nobody listens any more only if the caller has ended.
                let _ = tell.send(());
                Ok(done)
            };
            // One by one, so that no core waits for a block of another.
            (0..count)
                .into_par_iter()
                .with_max_len(1)
                .map_with(tell, one)
                .collect::<Result<Vec<T>, Failure>>()
        },
        || {
            let said = |done: usize| format!("{done} of {count} pictures");
            let mut going = progress.step(0.0, &said(0)).is_ok();
            let mut done = 0;
            loop {
                match platform::receive(&told, PULSE) {
                    Ok(()) => {
                        done += 1;
                        going &= progress.step(done as f32 / count.max(1) as f32, &said(done)).is_ok();
                    }
                    // A picture may take minutes.
                    Err(RecvTimeoutError::Timeout) => going &= !(progress.cancelled)(),
                    Err(RecvTimeoutError::Disconnected) => break,
                }
                cancelled.fetch_or(!going, Ordering::Relaxed);
            }
        },
    )
}

#[cfg(test)]
mod tests {
    use std::{fs, path::PathBuf, thread};
    use web_time::Instant;

    use super::*;
    use crate::{
        parameter::{NamedFile, Value},
        sweep::Axis,
    };

    const SMALL: Settings =
        Settings { size: [32, 18], samples: 1, until: Until { samples: 16, noise: None } };

    fn sweep<'a>(scene: &'a Scene, registry: &'a Registry) -> Sweep<'a> {
        let axis = Axis::vary("objects[0].size=0.5..3:6", scene, registry).expect("numbers");
        Sweep::new(scene, 0, vec![axis], registry).expect("valid")
    }

    #[test]
    fn pictures_are_those_of_each_scene_alone_in_order() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let sweep = sweep(&scene, &registry);
        let all = pictures(&sweep, &SMALL, None, &|_| Ok(()), &Progress::NONE).expect("drawn");
        let [width, height] = SMALL.size;
        let settings = reference::Settings { width, height, samples: 1, ..reference::Settings::default() };
        for (i, picture) in all.pictures.iter().enumerate() {
            let (seen, _) = sweep.seen(i).expect("valid");
            assert!(*picture == reference::render_rgb8(&seen, &registry, &settings), "{i}");
        }
        assert_ne!(all.pictures[0], all.pictures[5]);
    }

    #[test]
    fn progress_is_told_and_cancelling_ends_it() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let sweep = sweep(&scene, &registry);
        let told = std::cell::RefCell::new(Vec::new());
        let tell = |done: f32, what: &str| told.borrow_mut().push((done, what.to_owned()));
        let progress = Progress { tell: &tell, cancelled: &|| false };
        pictures(&sweep, &SMALL, None, &|_| Ok(()), &progress).expect("drawn");
        assert_eq!(told.borrow().len(), 7);
        assert_eq!(told.borrow()[6], (1.0, "6 of 6 pictures".to_owned()));
        let cancelled = Progress { tell: &tell, cancelled: &|| true };
        let ended = pictures(&sweep, &SMALL, None, &|_| Ok(()), &cancelled);
        // With so little work, it may be done before it hears of it.
        assert!(ended.is_ok() || matches!(ended, Err(Failure::Invalid(what)) if what == "cancelled"));
    }

    #[test]
    fn cancelling_ends_a_picture_that_takes_long() {
        let cancelled = Progress { tell: &|_, _| (), cancelled: &|| true };
        let begun = Instant::now();
        let ended = each(1, &cancelled, |_, cancelled| -> Result<(), Failure> {
            while !cancelled.load(Ordering::Relaxed) && begun.elapsed() < Duration::from_secs(60) {
                thread::sleep(Duration::from_millis(1));
            }
            if cancelled.load(Ordering::Relaxed) { Err(ended(Cancelled)) } else { Ok(()) }
        });
        assert!(ended.is_err(), "nobody asked while the picture was drawn");
    }

    #[test]
    fn finished_files_are_kept_and_others_drawn_again() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let sweep = sweep(&scene, &registry);
        let folder = tempfile::tempdir().expect("a folder");
        let all = |settings: &Settings| {
            files(&sweep, settings, (folder.path(), true), &|_| Ok(()), &Progress::NONE).expect("written")
        };
        let sparing = |settings: &Settings| {
            files(&sweep, settings, (folder.path(), false), &|_| Ok(()), &Progress::NONE)
        };
        assert_eq!(all(&SMALL), Written { drawn: 6, kept: 0 });
        assert!(matches!(sparing(&SMALL), Ok(Written { drawn: 0, kept: 6 })));
        let refused = sparing(&Settings { samples: 4, ..SMALL });
        assert!(
            matches!(refused, Err(Failure::Write(why)) if why.contains("has 6 pictures in the place of"))
        );
        let file = folder.path().join(sweep.file(2));
        let before = fs::read(&file).expect("there");
        fs::remove_file(&file).expect("removed");
        assert_eq!(all(&SMALL), Written { drawn: 1, kept: 5 });
        assert!(fs::read(&file).expect("there") == before, "the same bytes");
        // Other pictures, and files of others.
        assert_eq!(all(&Settings { samples: 4, ..SMALL }), Written { drawn: 6, kept: 0 });
        fs::write(&file, &before[..before.len() / 2]).expect("written");
        assert_eq!(all(&Settings { samples: 4, ..SMALL }), Written { drawn: 1, kept: 5 });
        // A picture of its own that is broken is no other.
        let after = fs::read(&file).expect("there");
        fs::write(&file, &after[..after.len() - 20]).expect("written");
        assert!(matches!(sparing(&Settings { samples: 4, ..SMALL }), Ok(Written { drawn: 1, kept: 5 })));
    }

    #[test]
    fn a_stamp_has_the_content_of_files_and_of_models_from_files() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |z: f32| {
            let text = format!("v 0 0 {z}\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
            fs::write(folder.path().join("mesh.obj"), text).expect("written");
        };
        let mut registry = Registry::builtin();
        let stamp = |registry: &Registry| {
            let mut scene = Scene::default();
            scene.objects[0].object_type = "mesh".to_owned();
            let shape = registry.shape("mesh").expect("built in");
            let parameter =
                shape.parameters.iter().find(|p| p.kind.format().is_some()).expect("names a file");
            let format = parameter.kind.format().expect("a file");
            let file = NamedFile::named("mesh.obj", folder.path(), format);
            assert_eq!(file.problem(), None);
            scene.objects[0].shape.set(parameter.name, Value::File(file));
            let settings = reference::Settings::default();
            parts::stamp(&scene, &settings, Until::default(), registry)
        };
        write(0.0);
        let flat = stamp(&registry);
        assert_eq!((flat.is_empty(), &stamp(&registry)), (false, &flat));
        write(0.5);
        let bent = stamp(&registry);
        assert_ne!(bent, flat);
        registry.sources_mut().edit("models/velvet.wgsl", "// one");
        let one = stamp(&registry);
        registry.sources_mut().edit("models/velvet.wgsl", "// two");
        assert!(one != bent && one != stamp(&registry));
    }

    #[test]
    fn what_cannot_be_drawn_or_written_fails_whole() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let sweep = sweep(&scene, &registry);
        let refuse = |_: &Scene| -> Result<(), Failure> { Err(Failure::Invalid("no".to_owned())) };
        let failed = pictures(&sweep, &SMALL, None, &refuse, &Progress::NONE);
        assert!(matches!(failed, Err(Failure::Invalid(what)) if what == "no"));
        let folder = tempfile::tempdir().expect("a folder");
        let taken = folder.path().join("taken");
        fs::write(&taken, "").expect("written");
        let failed = files(&sweep, &SMALL, (&taken, false), &|_| Ok(()), &Progress::NONE);
        assert!(matches!(failed, Err(Failure::Write(what)) if what.contains("could not be written")));
    }

    #[test]
    fn parts_are_kept_for_another_run_and_removed_at_the_end() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let sweep = sweep(&scene, &registry);
        let around = tempfile::tempdir().expect("a folder");
        let output: PathBuf = around.path().join("sheet.png");
        let run = || {
            let parts = Parts::beside(&output).at_once();
            let drawn = pictures(&sweep, &SMALL, Some(&parts), &|_| Ok(()), &Progress::NONE).expect("drawn");
            (parts, drawn)
        };
        let (_, first) = run();
        let (parts, again) = run();
        assert_eq!((first.kept, again.kept), (0, 6));
        assert!(first.pictures == again.pictures);
        fs::write(around.path().join("sheet.png.parts/mine"), "").expect("written");
        parts.remove();
        let left: Vec<_> =
            fs::read_dir(around.path().join("sheet.png.parts")).expect("there").flatten().collect();
        assert_eq!(left.len(), 1, "what somebody else put there stays");
    }
}
