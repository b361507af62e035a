//! A scene as read by a format, and the checks that follow.

use std::collections::HashSet;

use crate::{
    parameter::read_all,
    registry::Registry,
    scene::{
        Object, Repetition, Scene, beyond_room, check,
        error::{LoadError, Path, Problem, Segment},
        problem::{MAX_PROBLEMS, MOST_LISTED},
        reading::{Defaults, Missing},
    },
    text::{place::Place, plural},
};

/// A scene before its values are checked.
#[non_exhaustive]
pub struct Parsed<'a> {
    /// The scene, with placeholders for values that could not be read.
    pub scene: Scene,
    /// Missing parts that have defaults, which the scene already contains.
    pub missing: Vec<Missing>,
    /// Problems found while reading.
    pub(in crate::scene) problems: Vec<Problem>,
    /// Paths of values that could not be read and are therefore not checked.
    pub(in crate::scene) unread: HashSet<Path>,
    /// The number of problems that are not listed.
    pub(in crate::scene) unlisted: usize,
    /// The end of the file.
    pub(in crate::scene) end: Option<Place>,
    locate: Box<dyn Fn(&Path) -> Located + 'a>,
}

/// The position of a value, and the value as written.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct Located {
    /// The position of the value; if it is missing, that of the part that lacks it.
    pub(in crate::scene) place: Option<Place>,
    /// The value as written.
    pub(in crate::scene) found: Option<String>,
}

impl<'a> Parsed<'a> {
    /// A scene without positions and problems.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        Self {
            scene,
            missing: Vec::new(),
            problems: Vec::new(),
            unread: HashSet::new(),
            unlisted: 0,
            end: None,
            locate: Box::new(|_| Located::default()),
        }
    }

    /// Adds the positions of values: `places` returns that of a path such as `objects[0].material.k_d`. If it
    /// returns `None`, the enclosing part is used: `objects[0].material`, then `objects[0]`.
    #[must_use]
    pub fn with_places(self, places: impl Fn(&Path) -> Option<Place> + 'a) -> Self {
        self.located(move |path| {
            let around: Vec<_> = path.ancestors().collect();
            Located { place: around.iter().rev().find_map(&places), found: None }
        })
    }

    /// Adds problems found while reading. Values at their paths are not checked again.
    #[must_use]
    pub fn with_problems(mut self, problems: Vec<Problem>) -> Self {
        self.unread = problems.iter().map(|problem| problem.path.clone()).collect();
        self.problems = problems;
        self
    }

    /// Adds missing parts.
    #[must_use]
    pub fn with_missing(mut self, missing: Vec<Missing>) -> Self {
        self.missing = missing;
        self
    }

    /// Removes the positions, which are useless if nobody sees the text.
    pub(in crate::scene) fn without_places(self) -> Self {
        let Self { locate, mut problems, mut missing, .. } = self;
        problems.iter_mut().for_each(|problem| problem.place = None);
        missing.iter_mut().for_each(|missing| missing.place = None);
        let locate = move |path: &Path| Located { place: None, ..locate(path) };
        Self { locate: Box::new(locate), problems, missing, end: None, ..self }
    }

    /// Adds the positions of values, and the values as written.
    pub(in crate::scene) fn located(mut self, locate: impl Fn(&Path) -> Located + 'a) -> Self {
        self.locate = Box::new(locate);
        self
    }
}

/// Checks a scene that was read, and returns it or its problems.
pub(in crate::scene) fn checked(
    parsed: Parsed,
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<(Scene, Vec<Missing>), LoadError> {
    let Parsed { mut scene, missing, problems, unread, mut unlisted, end, locate } = parsed;
    // Each with the place in whose order it is listed.
    let mut all: Vec<_> = Vec::with_capacity(problems.len());
    // Without a place the copies of a row have none either.
    for path in &unread {
        let within = path.segments().get(2);
        if matches!(within, Some(Segment::Key(key)) if key == Object::position.key)
            && let Some(object) = path.index_in(Scene::objects.key).and_then(|i| scene.objects.get_mut(i))
        {
            object.repeat = Repetition::None;
        }
    }
    let has_rows = scene.objects.iter().any(|object| object.repeat != Repetition::None);
    let written = has_rows.then(|| scene.clone());
    let (scene, of_rows) = scene.expanded_as_far(registry);
    if let Err(what) = read_all(scene.files()) {
        let problems = vec![Problem::about(Path::root(), what)];
        return Err(LoadError::Invalid { name: name.to_owned(), problems });
    }
    let mut found = check::scene(&scene, registry);
    found.extend(of_rows);
    if !unread.is_empty() {
        found.retain(|problem| !problem.path.ancestors().any(|path| unread.contains(&path)));
    }
    let found = beyond_room::explain(found, written.as_ref().unwrap_or(&scene), &missing);
    all.extend(problems.into_iter().map(|problem| (problem.place, problem)));
    for mut problem in found {
        if all.len() >= MAX_PROBLEMS {
            unlisted += 1;
            continue;
        }
        let located = locate(&problem.path);
        if let (Some(written), Some(found)) = (located.found, &mut problem.found) {
            *found = written;
        }
        problem.place = problem.place.or(located.place);
        all.push((located.place, problem));
    }
    if all.is_empty() {
        return Ok((scene, missing));
    }
    if defaults == Defaults::Refuse {
        // A missing size may be reported already.
        let reported = |m: &&Missing| all.iter().any(|(_, p)| p.path == m.path);
        let start = Some(Place { line: 1, column: 1 });
        let more: Vec<_> = missing.iter().filter(|m| !reported(m)).map(|m| (start, m.problem())).collect();
        all.extend(more);
    }
    all.sort_by_key(|(place, _)| *place);
    let mut problems: Vec<_> = all.into_iter().map(|(_, problem)| problem).collect();
    unlisted += problems.len().saturating_sub(MOST_LISTED);
    problems.truncate(MOST_LISTED);
    if unlisted > 0 {
        let verb = if unlisted == 1 { "is" } else { "are" };
        let more = format!("has {}, which {verb} not listed", plural(unlisted, "more problem"));
        problems.push(Problem { place: end, ..Problem::about(Path::root(), more) });
    }
    Err(LoadError::Invalid { name: name.to_owned(), problems })
}
