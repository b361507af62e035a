//! The axes of a sweep: values by path, views, copies of a row, and ways through the room.

use glam::Vec3;

use super::values;
use crate::{
    caption::{self, Part as Words, header_parts},
    document::{Selection, names::name_in},
    parameter::Value,
    registry::Registry,
    scene::{Object, Part, Scene, at::Place, variant::LETTERS},
    text::{listed, quoted},
};

/// Maximum number of words that a summary lists.
const NAMED: usize = 6;

/// The word for views in place of a path.
const VIEW: &str = "view";
/// The word for copies of a row.
const COPY: &str = "copy";
/// Maximum number of copies of which each has a picture.
const MAX_COPIES: usize = 256;

/// One direction of a sweep: values that are set together, step by step.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The name of the varied quantity: "roughness".
    pub name: String,
    /// The value of each step, in words.
    pub labels: Vec<Vec<Words>>,
    /// True if something moves: films then need no values in the picture.
    pub moves: bool,
    /// The word for the axis in file names, and the values there.
    pub(super) word: String,
    pub(super) written: Vec<String>,
    pub(super) sets: Vec<(Place, Vec<Value>)>,
    /// The view of each step, if views vary.
    pub(super) views: Vec<usize>,
}

impl Axis {
    /// Values by path: `objects[0].material.roughness=0.1..0.9:5`, `reflection_model=lambert,phong`; or
    /// [views](Self::views): `view=A,B`.
    ///
    /// # Errors
    /// Returns the mistake: an unknown path with the nearest known, or values that are not of its kind.
    pub fn vary(text: &str, scene: &Scene, registry: &Registry) -> Result<Self, String> {
        let form = "write PATH=VALUES, as in objects[0].material.roughness=0.1..0.9:5";
        let (path, given) =
            text.split_once('=').ok_or_else(|| format!("{} has no =; {form}", quoted(text)))?;
        if path.trim() == VIEW {
            let views = given.split(',').map(|name| scene.view_named(name.trim()));
            return Self::views(&views.collect::<Result<Vec<_>, _>>()?, scene, registry);
        }
        let place = Place::find(path.trim(), scene, registry)?;
        let values = values::read_distinct(given.trim(), &place, registry)?;
        let label =
            |value: &Value| vec![caption::said(&place.label(), place.symbol(), place.shown(value, registry))];
        let labels = values.iter().map(label).collect();
        let is_one_of_several = match place.part {
            Part::Object(_) => scene.objects.len() > 1,
            part => matches!(part, Part::Light(_)),
        };
        let name = match is_one_of_several {
            true => format!("{} of {}", place.label(), called(place.part, scene, registry)),
            false => place.label(),
        };
        let word = path.trim().rsplit('.').next().unwrap_or_default().to_owned();
        let written = values.iter().map(ToString::to_string).collect();
        Ok(Self { name, labels, moves: false, word, written, sets: vec![(place, values)], views: Vec::new() })
    }

    /// Views of the scene, side by side: `view=A,B`, with their headings as labels.
    ///
    /// # Errors
    /// Returns an error if a view is there twice.
    pub fn views(views: &[usize], scene: &Scene, registry: &Registry) -> Result<Self, String> {
        let letter = |view: &usize| LETTERS.get(*view).copied().unwrap_or_default().to_owned();
        if let Some(i) = (1..views.len()).find(|i| views[..*i].contains(&views[*i])) {
            return Err(format!("view {} is there twice; each makes one picture", letter(&views[i])));
        }
        Ok(Self {
            name: VIEW.to_owned(),
            labels: views.iter().map(|view| header_parts(scene, *view, registry)).collect(),
            moves: false,
            word: VIEW.to_owned(),
            written: views.iter().map(letter).collect(),
            sets: Vec::new(),
            views: views.to_vec(),
        })
    }

    /// The copies of the row to which an object belongs, each alone in the place of the one in the middle, under the same
    /// light, with their values as labels.
    ///
    /// # Errors
    /// Returns an error if the object is in no row, or if the row has too many copies.
    pub fn copies(object: usize, scene: &Scene, registry: &Registry) -> Result<Self, String> {
        let row = scene.row(object).ok_or_else(|| format!("objects[{object}] is in no row"))?;
        if row.count > MAX_COPIES {
            let count = row.count;
            return Err(format!("the row has {count} copies, but a sheet shows at most {MAX_COPIES}"));
        }
        let label = |(i, parts): (usize, Vec<Words>)| {
            let name =
                || scene.objects[i].name.clone().unwrap_or_else(|| format!("copy {}", i + 1 - row.first));
            if parts.is_empty() { vec![Words::new(0, name())] } else { parts }
        };
        let place = |i: usize, key: &'static str| {
            Place::find(&Part::Object(i).path().key(key).to_string(), scene, registry)
        };
        let middle = Value::from(scene.objects[row.first + row.count / 2].position);
        let sets = |i: usize| {
            let own = scene.objects[i].visible;
            let visible = row.range().map(|shown| Value::from(own && shown == i)).collect();
            [
                place(i, Object::visible.key).map(|place| (place, visible)),
                place(i, Object::position.key).map(|place| (place, vec![middle.clone(); row.count])),
            ]
        };
        Ok(Self {
            name: COPY.to_owned(),
            labels: row.range().zip(caption::of_row(scene, &row, registry)).map(label).collect(),
            moves: false,
            word: COPY.to_owned(),
            written: (1..=row.count).map(|number| number.to_string()).collect(),
            sets: row.range().flat_map(sets).collect::<Result<_, String>>()?,
            views: Vec::new(),
        })
    }

    /// A way through the room at constant speed: `lights[0]=[1, 8, 9]..[9, 8, 9]:12`. A part with a direction looks at
    /// `aim` all the way, if that is given. A closed way leaves out its end, which is its beginning.
    ///
    /// # Errors
    /// Returns the mistake.
    pub fn path(text: &str, aim: Option<Vec3>, scene: &Scene, registry: &Registry) -> Result<Self, String> {
        let form = "write WHAT=[x, y, z]..[x, y, z]:COUNT, as in lights[0]=[1, 8, 9]..[9, 8, 9]:12";
        let (what, way) = text.split_once('=').ok_or_else(|| format!("{} has no =; {form}", quoted(text)))?;
        let what = what.trim();
        if !way.contains("..") {
            return Err(format!("{}: a way has two points or more; {form}", quoted(text)));
        }
        let position = Place::find(&format!("{what}.position"), scene, registry)?;
        let values = values::read(way.trim(), &position, registry)?;
        let mut sets = Vec::new();
        if let Some(aim) = aim {
            let place = Place::find(&format!("{what}.direction"), scene, registry)?;
            if place.value(scene).is_none() {
                return Err(format!("{what} has no direction, so it cannot look at a point"));
            }
            let towards = |value: &Value| match value {
                Value::Triple(from) => Value::from((aim - Vec3::from(*from)).normalize_or_zero()),
                other => other.clone(),
            };
            sets.push((place, values.iter().map(towards).collect()));
        }
        let labels =
            values.iter().map(|value| vec![Words::new(0, position.shown(value, registry))]).collect();
        let written = values.iter().map(ToString::to_string).collect();
        let name = format!("{} moved", called(position.part, scene, registry));
        sets.push((position, values));
        Ok(Self { name, labels, moves: true, word: "path".to_owned(), written, sets, views: Vec::new() })
    }

    /// The axis with its range: "roughness: r 0.1 to 0.9, 5 values"; a few words one by one: "model: Phong,
    /// Blinn–Phong and Ward".
    pub(super) fn summary(&self) -> Vec<Words> {
        let single: Option<Vec<&Words>> =
            self.labels.iter().map(|label| <&[Words; 1]>::try_from(&**label).ok().map(|[one]| one)).collect();
        let parts = single.map_or_else(|| self.of_several_parts(), |all| vec![range(&all)]);
        let is_named = parts.first().is_some_and(|part| part.words().starts_with(&self.name));
        let heading = (!is_named).then(|| Words::new(0, format!("{}:", self.name)));
        heading.into_iter().chain(parts).map(|part| Words { rank: 0, ..part }).collect()
    }

    /// The labels one after the other, or the first and the last of many.
    fn of_several_parts(&self) -> Vec<Words> {
        // The parts of one label are held together, so that it is seen where the next begins.
        let whole = |label: &Vec<Words>| -> Vec<Words> {
            let parts = label.iter().enumerate();
            parts.map(|(i, part)| Words { continues: i > 0 || part.continues, ..part.clone() }).collect()
        };
        match self.labels.as_slice() {
            [first, .., last] if self.count() > NAMED => {
                let others = vec![Words::new(0, "…")];
                let count = vec![Words::new(0, format!("{} in all", self.count()))];
                [whole(first), others, whole(last), count].concat()
            }
            few => few.iter().flat_map(whole).collect(),
        }
    }

    /// The value of a step in plain words, with its name instead of a symbol; of several values the first.
    pub(super) fn spoken(&self, step: usize) -> String {
        let first = self.labels.get(step).and_then(|label| label.first());
        match (first, self.sets.first()) {
            (Some(part), Some((place, _))) if !part.symbol.is_empty() => {
                format!("{} {}", place.label(), part.text)
            }
            (part, _) => part.map(Words::words).unwrap_or_default(),
        }
    }

    /// Number of steps.
    #[must_use]
    pub fn count(&self) -> usize {
        self.labels.len()
    }
}

/// The name of a part, as the window shows it: "Point 1".
pub(super) fn called(part: Part, scene: &Scene, registry: &Registry) -> String {
    let selection = match part {
        Part::Light(i) => Selection::Light(i),
        Part::Object(i) => Selection::Object(i),
        part => return part.path().to_string(),
    };
    name_in(scene, selection, registry)
}

/// Values with the symbol that they share: the first and the last, or a few words one by one.
fn range(all: &[&Words]) -> Words {
    let symbol = all.first().map_or("", |one| one.symbol);
    let is_shared = all.iter().all(|one| one.symbol == symbol);
    let texts: Vec<_> =
        all.iter().map(|one| if is_shared { one.text.clone() } else { one.words() }).collect();
    let has_digit = |text: &str| text.contains(|c: char| c.is_ascii_digit());
    let text = match texts.as_slice() {
        [first, .., last] if texts.len() > NAMED || texts.len() > 2 && has_digit(first) => {
            format!("{first} to {last}, {} values", texts.len())
        }
        few => listed(few, "and"),
    };
    Words { symbol: if is_shared { symbol } else { "" }, ..Words::new(0, text) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Repeat, Repetition, Variant, Varied};

    #[test]
    fn a_way_may_look_at_a_point() {
        let (mut scene, registry) = (Scene::default(), Registry::builtin());
        let way = "observer=[2, 5, 9]..[8, 5, 9]:2";
        let axis = Axis::path(way, Some(Vec3::splat(5.0)), &scene, &registry).expect("a way");
        let direction = axis.sets.iter().find(|(place, _)| place.label() == "direction").expect("it looks");
        let expected = Vec3::new(3.0, 0.0, -4.0) / 5.0;
        let found = direction.1[0].numbers().map(|v| v as f32);
        assert!((Vec3::from(found) - expected).length() < 1e-6, "{found:?}");
        scene.lights[0].direction = None;
        let said = Axis::path("lights[0]=[1, 8, 9]..[9, 8, 9]:2", Some(Vec3::ONE), &scene, &registry);
        assert!(said.is_err_and(|e| e.contains("lights[0] has no direction")));
    }

    #[test]
    fn views_stand_beside_each_other() {
        let registry = Registry::builtin();
        let phong = Variant {
            reflection_model: Some("phong".to_owned()),
            name: Some("shiny".to_owned()),
            ..Variant::default()
        };
        let scene = Scene { variants: vec![phong], ..Scene::default() };
        let axis = Axis::vary("view=A,shiny", &scene, &registry).expect("two views");
        assert_eq!((axis.views.as_slice(), axis.written.join(" ")), (&[0, 1][..], "A B".to_owned()));
        assert!(caption::line(&axis.labels[1]).starts_with("B · shiny"), "{:?}", axis.labels);
        let sweep = crate::sweep::Sweep::new(&scene, 0, vec![axis], &registry).expect("valid");
        assert_eq!(sweep.seen(1).expect("valid").0.reflection_model, "phong");
        for (text, expected) in
            [("view=A,C", "there is no view \"C\""), ("view=B,b", "view B is there twice")]
        {
            let said = Axis::vary(text, &scene, &registry).expect_err(text);
            assert!(said.contains(expected), "{said}");
        }
    }

    #[test]
    fn copies_of_a_row_are_shown_one_by_one() {
        let registry = Registry::builtin();
        let repeat = Repeat {
            columns: 3,
            spacing: Vec3::X,
            vary: vec![Varied {
                parameter: "size".to_owned(),
                from: Some(0.5),
                to: Some(1.5),
                ..Varied::default()
            }],
            ..Repeat::default()
        };
        let entry = Object { repeat: Repetition::Entry(Box::new(repeat)), ..Object::default() };
        let scene = Scene { objects: vec![entry, Object::default()], ..Scene::default() };
        let scene = scene.expanded(&registry).expect("a row");
        let axis = Axis::copies(1, &scene, &registry).expect("a row");
        let labels: Vec<_> = axis.labels.iter().map(|label| caption::line(label)).collect();
        assert_eq!(labels, ["size 0.5 m", "size 1 m", "size 1.5 m"]);
        let sweep = crate::sweep::Sweep::new(&scene, 0, vec![axis], &registry).expect("valid");
        for i in 0..3 {
            let (seen, _) = sweep.seen(i).expect("valid");
            let shown: Vec<_> = seen.objects.iter().map(|object| object.visible).collect();
            assert_eq!(shown, [i == 0, i == 1, i == 2, true]);
            assert_eq!(seen.objects[i].position, scene.objects[1].position);
        }
        let said = Axis::copies(3, &scene, &registry).expect_err("it is alone");
        assert_eq!(said, "objects[3] is in no row");
    }

    #[test]
    fn the_values_of_one_copy_stand_together_in_a_caption() {
        let registry = Registry::builtin();
        let varied = |parameter: &str, from, to| Varied {
            parameter: parameter.to_owned(),
            from: Some(from),
            to: Some(to),
            ..Varied::default()
        };
        let vary = vec![varied("size", 0.5, 1.0), varied("material.k_s", 0.25, 0.75)];
        let repeat = Repeat { columns: 2, spacing: Vec3::X, vary, ..Repeat::default() };
        let entry = Object { repeat: Repetition::Entry(Box::new(repeat)), ..Object::default() };
        let scene = Scene { reflection_model: "phong".to_owned(), objects: vec![entry], ..Scene::default() };
        let scene = scene.expanded(&registry).expect("a row");
        let axis = Axis::copies(0, &scene, &registry).expect("a row");
        assert_eq!(caption::line(&axis.summary()), "copy: size 0.5 m, k_s 0.25 · size 1 m, k_s 0.75");
    }

    #[test]
    fn a_hidden_copy_stays_hidden() {
        let registry = Registry::builtin();
        let values = [true, false, true].map(Value::from).to_vec();
        let vary = vec![Varied { parameter: "visible".to_owned(), values, ..Varied::default() }];
        let repeat = Repeat { columns: 3, spacing: Vec3::X, vary, ..Repeat::default() };
        let entry = Object { repeat: Repetition::Entry(Box::new(repeat)), ..Object::default() };
        let scene = Scene { objects: vec![entry], ..Scene::default() };
        let scene = scene.expanded(&registry).expect("a row");
        let axis = Axis::copies(0, &scene, &registry).expect("a row");
        let sweep = crate::sweep::Sweep::new(&scene, 0, vec![axis], &registry).expect("valid");
        let shown = |i: usize| {
            let (seen, _) = sweep.seen(i).expect("valid");
            seen.objects.iter().filter(|object| object.visible).count()
        };
        assert_eq!([shown(0), shown(1), shown(2)], [1, 0, 1]);
    }

    #[test]
    fn captions_have_symbols_to_typeset_and_parts_have_the_names_of_the_window() {
        let registry = Registry::builtin();
        let scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        let axis = Axis::vary("objects[0].material.k_s=0.1..0.9:3", &scene, &registry).expect("numbers");
        let expected = [
            Words::new(0, "specular coefficient:"),
            Words { symbol: "k_s", ..Words::new(0, "0.1 to 0.9, 3 values") },
        ];
        assert_eq!(
            (axis.summary(), axis.spoken(2)),
            (expected.into(), "specular coefficient 0.9".to_owned())
        );
        let of = |axis: Result<Axis, String>| caption::line(&axis.expect("valid").summary());
        let moved = Axis::path("lights[0]=[1, 8, 9]..[9, 8, 9]:3", None, &scene, &registry);
        assert_eq!(of(moved), "Point 1 moved: (1, 8, 9) m to (9, 8, 9) m, 3 values");
        assert!(of(Axis::turn("lights[0]=90:3", &scene, &registry)).starts_with("Point 1 turned: "));
        let intensity = of(Axis::vary("lights[0].intensity=1,2", &scene, &registry));
        assert!(intensity.starts_with("intensity of Point 1: "), "{intensity}");
        // The symbols of headings, too.
        let mut shiny = Variant::default();
        shiny.material.set("k_s", Value::Number(0.9));
        let scene = Scene { variants: vec![shiny], ..scene };
        let axis = Axis::vary("view=A,B", &scene, &registry).expect("two views");
        assert_eq!(axis.summary().iter().filter(|part| part.symbol == "k_s").count(), 2, "{axis:?}");
        assert_eq!(axis.spoken(1), "B");
    }

    #[test]
    fn mistakes_in_ways_are_named() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        for (text, expected) in [
            ("lights[0]", "has no ="),
            ("lights[0]=[1, 2, 3]", "two points or more"),
            ("lights[4]=[1, 2, 3]..[4, 5, 6]:3", "there is no lights[4]"),
        ] {
            let said = Axis::path(text, None, &scene, &registry).expect_err(text);
            assert!(said.contains(expected), "{text}: {said}");
        }
    }
}
