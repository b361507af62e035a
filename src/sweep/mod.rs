//! Sweeps: pictures of one scene with some of its values varied, for a folder, a sheet or a film.
//!
//! A sweep is deterministic: its pictures depend only on the scene, the axes and the settings, and are those of the CPU
//! renderer for each scene alone.
//!
//! ```
//! use lights_camera_models::{
//!     progress::Progress,
//!     registry::Registry,
//!     scene::Scene,
//!     sweep::{Axis, Settings, Sweep, pictures},
//! };
//! let (scene, registry) = (Scene::default(), Registry::builtin());
//! let axis = Axis::vary("reflection_model=lambert,phong,minnaert", &scene, &registry).expect("known models");
//! let sweep = Sweep::new(&scene, 0, vec![axis], &registry).expect("three pictures");
//! let settings = Settings { size: [64, 36], ..Settings::default() };
//! let all = pictures(&sweep, &settings, None, &|_| Ok(()), &Progress::NONE).expect("drawn");
//! assert_eq!(all.pictures.len(), 3);
//! assert_ne!(all.pictures[0], all.pictures[1]);
//! ```

mod axis;
mod draw;
mod film;
mod parts;
mod sheet;
mod turn;
mod unused;
mod values;
mod write;

use std::{collections::HashSet, ffi::OsString, path::Path};

use rayon::prelude::*;

pub use axis::Axis;
pub use draw::{Check, Drawn, Settings, Written, files, pictures};
pub use film::{GIF, MAX_RATE, gif};
pub use parts::Parts;
pub use sheet::{Against, Grid, Page, maps};
pub use turn::instead_of_turn;
pub use write::{Format, Look, Plan};

use crate::{
    caption::{self, Caption, Ground, Part as Words},
    optics::TermSelection,
    registry::Registry,
    scene::{Scene, at::Idle, check, error::Problem},
    text::listed,
};
use unused::Unused;

/// Maximum number of pictures in a sweep.
pub const MAX_PICTURES: usize = 10_000;
/// Maximum number of pixels of all pictures of a sheet or a film together: they are in memory at once.
pub const MAX_PIXELS: u64 = 1 << 28;
/// Maximum number of names in a folder among which pictures of others are looked for.
const MOST_ENTRIES: usize = 100_000;
/// Maximum number of problems named for a picture.
const MAX_NAMED: usize = 3;

/// A scene with its axes of variation.
#[derive(Clone, Debug)]
pub struct Sweep<'a> {
    /// The scene as it is.
    pub scene: &'a Scene,
    /// The view that is shown; 0 is the scene itself.
    pub view: usize,
    /// The axes. The first one varies from picture to picture, the last one slowest.
    pub axes: Vec<Axis>,
    /// The known models and types.
    pub registry: &'a Registry,
    remarks: Vec<String>,
}

impl<'a> Sweep<'a> {
    /// A sweep, all of whose scenes are valid. Labels of steps with which a parameter has no effect say so.
    ///
    /// # Errors
    /// Returns an error if there is nothing to vary, if two axes set the same value, if there are more than [`MAX_PICTURES`]
    /// pictures, if no picture uses a parameter that varies, or if a value breaks a rule of scenes: then the first such
    /// picture and its problems.
    pub fn new(
        scene: &'a Scene,
        view: usize,
        axes: Vec<Axis>,
        registry: &'a Registry,
    ) -> Result<Self, String> {
        possible(&axes)?;
        let mut sweep = Self { scene, view, axes, registry, remarks: Vec::new() };
        let checked: Vec<_> = (0..sweep.count()).into_par_iter().map(|i| sweep.checked(i)).collect();
        let unused = Unused(checked.into_iter().collect::<Result<_, _>>()?);
        sweep.remarks = unused.remarks(&sweep)?;
        for (axis, step, mark) in unused.marks(&sweep) {
            if let Some(last) = sweep.axes[axis].labels[step].last_mut() {
                last.text = format!("{} ({mark})", last.text);
            }
        }
        Ok(sweep)
    }

    /// Remarks on the pictures for the user, a sentence each.
    #[must_use]
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// The axes along which pictures differ: a single value is the same everywhere.
    pub fn varied(&self) -> impl Iterator<Item = &Axis> {
        self.axes.iter().filter(|axis| axis.count() > 1)
    }

    /// Number of pictures.
    #[must_use]
    pub fn count(&self) -> usize {
        self.axes.iter().map(Axis::count).product()
    }

    /// The step of each axis in a picture.
    fn steps(&self, mut picture: usize) -> Vec<usize> {
        let step = |axis: &Axis| {
            let step = picture % axis.count();
            picture /= axis.count();
            step
        };
        self.axes.iter().map(step).collect()
    }

    /// The label of each axis in a picture.
    #[must_use]
    pub fn labels(&self, picture: usize) -> Vec<&[Words]> {
        self.axes.iter().zip(self.steps(picture)).map(|(axis, step)| &*axis.labels[step]).collect()
    }

    /// The scene that a picture shows, and its terms; `None` if there is no such view. The rules of the scene were
    /// checked before.
    #[must_use]
    pub fn seen(&self, picture: usize) -> Option<(Scene, TermSelection)> {
        let (scene, view, _) = self.set(picture);
        scene.seen(view, self.registry)
    }

    /// The scene with the values of a picture, the view that it shows, and the problems of values without a place.
    fn set(&self, picture: usize) -> (Scene, usize, Vec<Problem>) {
        let steps = self.steps(picture);
        let sets = self.axes.iter().zip(&steps);
        let values =
            sets.flat_map(|(axis, step)| axis.sets.iter().map(|(place, values)| (place, &values[*step])));
        let (scene, problems) = self.scene.with_unchecked(values, self.registry);
        (scene, sets_view(&self.axes, &steps).unwrap_or(self.view), problems)
    }

    /// Checks the scene of a picture. Returns for each axis why it has no effect there, if so.
    fn checked(&self, picture: usize) -> Result<Vec<Option<Idle>>, String> {
        let (scene, view, mut problems) = self.set(picture);
        // Views alone leave the scene as it is.
        if self.axes.iter().any(|axis| !axis.sets.is_empty()) {
            problems.extend(check::scene(&scene, self.registry));
        }
        if !problems.is_empty() {
            let named: Vec<_> = problems.iter().take(MAX_NAMED).map(ToString::to_string).collect();
            return Err(named.join("\n"));
        }
        let (seen, _) = scene.seen(view, self.registry).ok_or("there is no such view")?;
        // No reason is less than any: one value with an effect is enough.
        let idle =
            |axis: &Axis| axis.sets.iter().map(|(place, _)| place.idle(&seen, self.registry)).min().flatten();
        Ok(self.axes.iter().map(idle).collect())
    }

    /// The name of the file of a picture: its number, which keeps names apart, and its values.
    #[must_use]
    pub fn file(&self, picture: usize) -> String {
        let digits = self.count().to_string().len();
        let mut name = format!("{:0digits$}", picture + 1);
        for (axis, step) in self.axes.iter().zip(self.steps(picture)) {
            name.push_str(&format!("_{}_{}", plain(&axis.word), plain(&axis.written[step])));
        }
        // Far below the limits of file systems.
        name.truncate(120);
        name + ".png"
    }

    /// The number of pictures among the names in a folder that are none of the sweep.
    #[must_use]
    pub fn strangers(&self, names: impl IntoIterator<Item = OsString>) -> usize {
        let own: HashSet<OsString> = (0..self.count()).map(|i| self.file(i).into()).collect();
        let is_picture = |name: &OsString| Path::new(name).extension().is_some_and(|end| end == "png");
        let names = names.into_iter().take(MOST_ENTRIES);
        names.filter(|name| is_picture(name) && !own.contains(name)).count()
    }

    /// The ground of words around the pictures: that of the first.
    #[must_use]
    pub fn ground(&self) -> Ground {
        self.seen(0).map_or(Ground::DARK, |(seen, _)| Ground::of(&seen.display))
    }

    /// The caption of all pictures together: the common facts, and the axes.
    #[must_use]
    pub fn caption(&self) -> Caption {
        let of = |i: usize| {
            let (seen, terms) = self.seen(i)?;
            Some(caption::of_scene(&seen, terms, self.registry))
        };
        let all: Vec<_> = (0..self.count()).into_par_iter().filter_map(of).collect();
        let mut caption = all
            .first()
            .cloned()
            .unwrap_or_else(|| caption::of_scene(self.scene, TermSelection::All, self.registry));
        caption.facts.retain(|fact| all.iter().all(|other| other.facts.contains(fact)));
        // A part that continued one that varies begins now.
        if let Some(first) = caption.facts.first_mut() {
            first.continues = false;
        }
        caption.facts.extend(self.axes.iter().flat_map(Axis::summary));
        caption
    }

    /// The names of the axes, in one line.
    #[must_use]
    pub fn summary(&self) -> String {
        listed(&self.axes.iter().map(|axis| axis.name.as_str()).collect::<Vec<_>>(), "and")
    }
}

/// Fails if there is nothing to vary, too much, or a value twice.
fn possible(axes: &[Axis]) -> Result<(), String> {
    if axes.is_empty() {
        return Err("nothing varies; name a value, as in --vary objects[0].size=1..3:5".to_owned());
    }
    let mut paths: Vec<_> =
        axes.iter().flat_map(|axis| &axis.sets).map(|(place, _)| place.path.to_string()).collect();
    paths.extend(axes.iter().filter(|axis| !axis.views.is_empty()).map(|axis| axis.name.clone()));
    paths.sort();
    if let Some(pair) = paths.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(format!("{} is varied twice; vary it once, with all its values", pair[0]));
    }
    let count = axes.iter().fold(1_usize, |count, axis| count.saturating_mul(axis.count()));
    if count > MAX_PICTURES {
        let factors: Vec<_> = axes.iter().map(|axis| axis.count().to_string()).collect();
        return Err(format!(
            "{} are {count} pictures, but a sweep has at most {MAX_PICTURES}; vary less",
            factors.join(" × ")
        ));
    }
    Ok(())
}

/// The view in a picture, if views vary.
fn sets_view(axes: &[Axis], steps: &[usize]) -> Option<usize> {
    axes.iter().zip(steps).find_map(|(axis, step)| axis.views.get(*step).copied())
}

/// A text with only letters, digits, dots and signs that no shell and no file system minds.
fn plain(text: &str) -> String {
    let text: String =
        text.chars().map(|c| if c.is_ascii_alphanumeric() || ".-".contains(c) { c } else { '-' }).collect();
    text.trim_end_matches('-').to_owned()
}

/// The number of steps in a text.
fn count(text: &str) -> Result<usize, String> {
    match text.trim().parse::<usize>() {
        Ok(count) if (2..=MAX_PICTURES).contains(&count) => Ok(count),
        _ => Err(format!("the count must be a whole number, at least 2 and at most {MAX_PICTURES}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Variant;

    fn sweep<'a>(scene: &'a Scene, registry: &'a Registry, texts: &[&str]) -> Result<Sweep<'a>, String> {
        let axes =
            texts.iter().map(|text| Axis::vary(text, scene, registry)).collect::<Result<Vec<_>, _>>()?;
        Sweep::new(scene, 0, axes, registry)
    }

    #[test]
    fn the_first_axis_varies_fastest_and_files_are_named_after_values() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let made = sweep(&scene, &registry, &["objects[0].size=1,2,3", "reflection_model=lambert,phong"])
            .expect("valid");
        assert_eq!(made.count(), 6);
        let seen =
            |i: usize| made.seen(i).map(|(s, _)| (s.objects[0].size, s.reflection_model)).expect("valid");
        assert_eq!(seen(1), (2.0, "lambert".to_owned()));
        assert_eq!(seen(4), (2.0, "phong".to_owned()));
        assert_eq!(made.file(4), "5_size_2_reflection-model_phong.png");
        let words: Vec<_> = made.labels(4).into_iter().map(caption::line).collect();
        assert_eq!(words, ["size 2 m", "Phong"]);
        let facts = caption::line(&made.caption().facts);
        assert!(facts.contains("size 1 m to size 3 m, 3 values"), "{facts}");
        assert!(
            !facts.starts_with("Lambert") && facts.contains("Gouraud"),
            "what varies is not shared: {facts}"
        );
    }

    #[test]
    fn what_no_model_uses_is_refused_and_what_some_do_not_use_is_marked() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let roughness = "objects[0].material.roughness=0.1..0.9:3";
        for texts in
            [&[roughness][..], &[roughness, "objects[0].size=1,2"], &[roughness, "reflection_model=phong"]]
        {
            let said = sweep(&scene, &registry, texts).expect_err("no model has it");
            let model = if texts.len() > 1 && texts[1].contains("phong") { "Phong" } else { "Lambert" };
            let start = format!(
                "objects[0].material.roughness has no effect: {model} has no roughness; it belongs to "
            );
            assert!(said.starts_with(&start) && said.contains("eon"), "{said}");
        }
        let made =
            sweep(&scene, &registry, &[roughness, "reflection_model=lambert,eon,phong"]).expect("EON has it");
        let words = |axis: usize| made.axes[axis].labels.iter().map(|l| caption::line(l)).collect::<Vec<_>>();
        assert_eq!(words(0), ["r 0.1", "r 0.5", "r 0.9"]);
        assert_eq!(words(1), ["Lambert (no roughness)", "EON", "Phong (no roughness)"]);
        let expected = "objects[0].material.roughness has no effect in 6 of 9 pictures: Lambert has no roughness; \
                        Phong has no roughness";
        assert_eq!(made.remarks(), [expected]);
        assert!(made.file(0).ends_with("reflection-model_lambert.png"), "{}", made.file(0));
        // A view may choose the model.
        let eon = Variant { reflection_model: Some("eon".to_owned()), ..Variant::default() };
        let scene = Scene { variants: vec![eon], ..scene };
        let axis = Axis::vary(roughness, &scene, &registry).expect("numbers");
        assert!(
            Sweep::new(&scene, 1, vec![axis.clone()], &registry).is_ok_and(|made| made.remarks().is_empty())
        );
        assert!(Sweep::new(&scene, 0, vec![axis], &registry).is_err());
    }

    #[test]
    fn scenes_are_checked_once() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let made = sweep(&scene, &registry, &["objects[0].size=1,2"]).expect("valid");
        let mut broken = scene.clone();
        broken.lights.clear();
        assert!(sweep(&broken, &registry, &["objects[0].size=1,2"]).is_err(), "it is checked");
        let later = Sweep { scene: &broken, ..made };
        assert!(later.seen(1).is_some_and(|(seen, _)| seen.objects[0].size == 2.0), "but not again");
    }

    #[test]
    fn too_much_and_twice_and_out_of_range_are_refused() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let cases: [(&[&str], &str); 4] = [
            (
                &["objects[0].size=1..2:1000", "lights[0].intensity=1..2:1000"],
                "1000 × 1000 are 1000000 pictures, but a sweep has at most 10000",
            ),
            (&["objects[0].size=1,2", "objects[0].size=3,4"], "objects[0].size is varied twice"),
            (&["observer.position[0]=5..15:3"], "a position must be inside the room"),
            (&[], "nothing varies"),
        ];
        for (texts, expected) in cases {
            let said = sweep(&scene, &registry, texts).expect_err(expected);
            assert!(said.contains(expected), "{said}");
        }
    }
}
