//! Rows and grids: one entry of a scene file that stands for several objects.
//!
//! In a file an object with [`repeat`](Object::repeat) is one entry. A scene in memory has the copies, each a complete
//! object that knows its entry and its number: renderers, picking, explanations and exports treat them as any others.
//! [`Scene::expanded`] leads from entries to copies, [`Scene::gathered`] back.

use std::{borrow::Cow, ops::Range, sync::Arc};

use glam::Vec3;

use super::{
    Field, MAX_OBJECTS, Object, Part, Repeat, Repetition, Scene, SceneSize, Varied,
    declaration::Declared,
    error::{Path, Problem, Segment},
    field::Kind,
    part::{Fields, Key, Structure as _},
    range::significant,
    repeat::{Along, Lists, MAX_VARIED, Scale},
    used::{Idle, idle},
};
use crate::{
    parameter::{Parameter, Value},
    registry::Registry,
    text::{did_you_mean, plural, quoted},
};

/// Maximum number of problems of rows in a file; more would take too long, since each names the nearest path.
const MOST_PROBLEMS: usize = 200;

/// A value of an object that may differ from copy to copy.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// The key within the object.
    pub key: Key,
    /// The declaration.
    pub declared: Declared,
}

impl Variable {
    /// All of an object of a type.
    pub fn all(object_type: &str, registry: &Registry) -> impl Iterator<Item = Self> {
        // The copies have places by their spacing, and names by their numbers.
        let may_vary = |field: &&&Field| {
            matches!(
                field.kind,
                Kind::Number { .. } | Kind::Count(_) | Kind::Flag(_) | Kind::Rotation | Kind::Id(_)
            )
        };
        let shape = registry.shape(object_type).map_or(&[][..], |shape| shape.parameters);
        let own = |p: &'static Parameter| Self { key: Key::Own(p.name), declared: Declared::Parameter(p) };
        let fields = Object::FIELDS
            .iter()
            .filter(may_vary)
            .map(|field| Self { key: Key::Own(field.key), declared: Declared::Field(field) });
        fields.chain(shape.iter().map(own)).chain(registry.material_parameters().map(Self::of_material))
    }

    /// A parameter of the material.
    #[must_use]
    pub fn of_material(parameter: &'static Parameter) -> Self {
        Self { key: Key::Material(parameter.name), declared: Declared::Parameter(parameter) }
    }

    /// The one with a path within the object, if there is one.
    #[must_use]
    pub fn with_path(path: &str, object_type: &str, registry: &Registry) -> Option<Self> {
        let of_material = path.strip_prefix(Object::material.key).and_then(|rest| rest.strip_prefix('.'));
        Self::all(object_type, registry).find(|known| match known.key {
            Key::Material(name) => of_material == Some(name),
            Key::Own(name) => name == path,
        })
    }

    /// The one with a path within the object: `material.roughness`.
    ///
    /// # Errors
    /// Returns the rule, with the nearest path.
    pub fn of(path: &str, object_type: &str, registry: &Registry) -> Result<Self, String> {
        if let Some(found) = Self::with_path(path, object_type, registry) {
            return Ok(found);
        }
        let known: Vec<_> = Self::all(object_type, registry).map(|one| (one.path(), one)).collect();
        // A path is nearer than a name, and a name than what it is called.
        let paths = known.iter().map(|(path, _)| (&**path, &**path));
        let names = known.iter().map(|(path, one)| (one.key.name(), &**path));
        let labels = known.iter().map(|(path, one)| (one.declared.label(), &**path));
        let spellings = paths.chain(names).chain(labels);
        let rule = "it must be the path of a value of the object that can differ, such as \"size\" or \
                    \"material.roughness\"";
        Err(rule.to_owned() + &did_you_mean(&path.replace("color", "colour"), spellings))
    }

    /// The path within the object.
    #[must_use]
    pub fn path(self) -> Cow<'static, str> {
        match self.key {
            Key::Own(name) => name.into(),
            Key::Material(name) => format!("{}.{name}", Object::material.key).into(),
        }
    }

    /// A number that varies from near one end of its range to near the other; `None` if it is not a number, or its range
    /// has no ends.
    #[must_use]
    pub fn over_its_range(self) -> Option<Varied> {
        let limits = self.declared.limits()?;
        let (low, high) = (limits.slider_min, limits.slider_max.min(limits.top()));
        let at = |part: f64| {
            let wanted = significant(low + part * (high - low), 2);
            if limits.whole { wanted.round() } else { wanted }
        };
        let ends = [at(0.1), at(0.9)];
        let usable = ends.iter().all(|end| limits.allows(*end) && end.abs() < 1e6);
        let [from, to] = ends.map(|end| Some(end as f32));
        usable.then(|| Varied { parameter: self.path().into_owned(), from, to, ..Varied::default() })
    }

    /// The words that it can be, if it is a choice: ids with their names.
    #[must_use]
    pub fn words(self, registry: &Registry) -> Vec<(&'static str, &'static str)> {
        match self.declared {
            Declared::Field(Field { kind: Kind::Id(ids), .. }) => {
                ids.all(registry).map(|listed| (listed.id, listed.name)).collect()
            }
            Declared::Field(Field { kind: Kind::Flag(_), .. }) => vec![("true", "yes"), ("false", "no")],
            Declared::Field(_) => Vec::new(),
            Declared::Parameter(p) => p.kind.options().to_vec(),
        }
    }

    /// A list of so many values, to be changed one by one: choices in their order from the value of now on, and otherwise that
    /// value.
    #[must_use]
    pub fn listed(self, now: Value, count: usize, registry: &Registry) -> Varied {
        let words = self.words(registry);
        let first = words.iter().position(|(id, _)| matches!(&now, Value::Choice(word) if word == id));
        // Not every type has the parameters of another: a mesh needs a file. Yes and no take no turns.
        let first = first.filter(|_| self.key != Object::object_type.into() && words.len() > 2);
        let value = |i: usize| match first {
            Some(first) => Value::Choice(words[(first + i) % words.len()].0.into()),
            None => now.clone(),
        };
        let values = (0..count).map(value).collect();
        Varied { parameter: self.path().into_owned(), values, ..Varied::default() }
    }

    /// The value that follows listed ones in equal steps; `None` if their steps differ, or it would not be legal.
    #[must_use]
    pub fn next_after(self, values: &[Value]) -> Option<Value> {
        let limits = self.declared.limits()?;
        let number = |value: &Value| match value {
            Value::Number(v) => Some(decimal(*v)),
            Value::Integer(n) => Some(*n as f64),
            _ => None,
        };
        let numbers: Vec<f64> = values.iter().map(number).collect::<Option<_>>()?;
        let steps: Vec<f64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (last, step) = (numbers.last()?, steps.last()?);
        let even = steps.iter().all(|other| (other - step).abs() <= 1e-4 * step.abs());
        let next = significant(last + step, 6);
        (even && limits.allows(next)).then(|| self.declared.of_number(next)).flatten()
    }

    /// The reason why an object makes no use of it; `None` if it does.
    #[must_use]
    pub fn idle(self, scene: &Scene, object: usize, registry: &Registry) -> Option<Idle> {
        let Declared::Parameter(parameter) = self.declared else { return None };
        idle((Part::Object(object), self.key), parameter, scene, registry)
    }

    /// The value that an object has, given or default, if it has one.
    #[must_use]
    pub fn of_object(self, object: &Object) -> Option<Value> {
        match (self.declared, self.key) {
            (Declared::Field(_), key) => object.value(key),
            (Declared::Parameter(p), Key::Own(_)) => Some(object.shape.get(p)),
            (Declared::Parameter(p), Key::Material(_)) => Some(object.material.get(p)),
        }
    }
}

/// A number of 32 bits as people write it, so that steps between 0.1 and 0.9 end in 0.3, 0.5 and 0.7.
fn decimal(v: f32) -> f64 {
    v.to_string().parse().unwrap_or_else(|_| v.into())
}

/// The value of each step of a varied value, and which it is. Problems have paths from `at`.
fn series(
    varied: &Varied,
    (object_type, steps): (&str, u64),
    at: &Path,
    registry: &Registry,
) -> Result<(Variable, Vec<Value>), Problem> {
    let path = |field: Field| at.key(field.key);
    let variable = Variable::of(&varied.parameter, object_type, registry)
        .map_err(|rule| Problem::value(path(Varied::parameter), quoted(&varied.parameter), rule))?;
    let steps = usize::try_from(steps).unwrap_or(usize::MAX);
    if !varied.values.is_empty() {
        if varied.from.or(varied.to).is_some() {
            let why = "conflicts with from and to; a varied value has a range or a list of values";
            return Err(Problem::about(path(Varied::values), why));
        }
        let count = varied.values.len();
        if count != steps {
            let what = match varied.along {
                Along::Columns => "column",
                Along::Rows => "row",
                Along::All => "copy",
            };
            let rule = format!("there must be one for each {what}: {steps}");
            return Err(Problem::value(path(Varied::values), format!("a list of {count}"), rule));
        }
        return Ok((variable, varied.values.clone()));
    }
    let (Some(from), Some(to)) = (varied.from, varied.to) else {
        let missing = if varied.from.is_none() { Varied::from } else { Varied::to };
        let why = "is missing; a varied value needs from and to, or values";
        return Err(Problem::about(path(missing), why));
    };
    // In 64 bits, since the product of small numbers is 0 in 32.
    if varied.scale == Scale::Logarithmic && f64::from(from) * f64::from(to) <= 0.0 {
        let rule =
            format!("factors lead from {from} to {to} only if both have the same sign and neither is 0");
        return Err(Problem::value(path(Varied::scale), quoted(varied.scale.id()), rule));
    }
    let numbers = varied.scale.between([from, to].map(decimal), steps);
    let values: Option<Vec<_>> = numbers.map(|v| variable.declared.of_number(v)).collect();
    let values = values.ok_or_else(|| {
        let label = variable.declared.label();
        let rule = format!("the {label} is not a number; give its values one by one");
        Problem::value(path(Varied::from), from, rule)
    })?;
    Ok((variable, values))
}

/// The problems of the fields of a part by themselves.
fn of_fields(part: &dyn Fields, at: &Path, registry: &Registry, problems: &mut Vec<Problem>) {
    part.each(&mut |field, held, _| {
        if let Some(value) = held.value()
            && let Err(rule) = field.check(&value, registry)
        {
            problems.push(Problem::value(at.key(field.key), value.written(), rule));
        }
    });
}

/// The copies for which an entry stands. An object without a row is its only one.
///
/// # Errors
/// Returns the problems of the row, with their paths from the object on. The values of the copies are not checked.
pub fn copies(entry: &Object, registry: &Registry) -> Result<Vec<Object>, Vec<Problem>> {
    copies_of(&Arc::new(entry.clone()), registry)
}

/// The copies of an entry, which they share.
fn copies_of(entry: &Arc<Object>, registry: &Registry) -> Result<Vec<Object>, Vec<Problem>> {
    let Repetition::Entry(repeat) = &entry.repeat else { return Ok(vec![(**entry).clone()]) };
    let at = Path::root().key(Object::repeat.key);
    let mut problems = Vec::new();
    of_fields(&**repeat, &at, registry, &mut problems);
    if let Err(problem) = room(repeat, 0) {
        problems.push(problem);
    }
    let vary = at.key(Repeat::vary.key);
    if repeat.vary.len() > MAX_VARIED {
        let rule = format!("a row has at most {MAX_VARIED} varied values");
        problems.push(Problem::value(vary.clone(), format!("a list of {}", repeat.vary.len()), rule));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut all = Vec::with_capacity(repeat.vary.len());
    for (j, varied) in repeat.vary.iter().enumerate() {
        let at = vary.index(j);
        let before = problems.len();
        of_fields(varied, &at, registry, &mut problems);
        let of_type = (&*entry.object_type, repeat.steps(varied.along));
        if problems.len() == before {
            match series(varied, of_type, &at, registry) {
                Ok((variable, values)) => all.push((j, varied.along, variable, values)),
                Err(problem) => problems.push(problem),
            }
        }
        if repeat.vary[..j].iter().any(|other| other.parameter == varied.parameter) {
            let rule = "it varies already; each value varies once";
            problems.push(Problem::value(at.key(Varied::parameter.key), quoted(&varied.parameter), rule));
        }
    }
    // A type brings the values that it allows.
    all.sort_by_key(|(_, _, variable, _)| variable.key != Object::object_type.into());
    // Without the row, whose lists may be as long as the row itself.
    let plain = Object { repeat: Repetition::None, ..(**entry).clone() };
    let total = repeat.total() as u32;
    let mut objects = Vec::with_capacity(total as usize);
    for number in 0..total {
        let mut copy = Object {
            name: entry.name.as_ref().map(|name| name_of(name, number)),
            position: position(entry.position, repeat, number),
            repeat: Repetition::Copy { entry: entry.clone(), number },
            ..plain.clone()
        };
        for (j, along, variable, values) in &all {
            let place = repeat.place(number, *along);
            let Some(value) = values.get(place) else { continue };
            if !copy.set(variable.key, Some(value.clone()), registry) {
                let path = vary.index(*j).key(Varied::values.key).index(place);
                problems.push(Problem::value(
                    path,
                    value.written(),
                    format!("it is no {}", variable.declared.label()),
                ));
            }
        }
        objects.push(copy);
        if !problems.is_empty() {
            break;
        }
    }
    if problems.is_empty() { Ok(objects) } else { Err(problems) }
}

/// The name of a copy: "ball 3".
fn name_of(name: &str, number: u32) -> String {
    format!("{name} {}", u64::from(number) + 1)
}

/// The name of the entry from a new name of one of its copies.
#[must_use]
pub fn entry_name(copy: &str, number: u32) -> &str {
    copy.strip_suffix(&format!(" {}", u64::from(number) + 1)).unwrap_or(copy)
}

/// The position of a copy.
fn position(first: Vec3, repeat: &Repeat, number: u32) -> Vec3 {
    at(first, repeat, [Along::Columns, Along::Rows].map(|along| repeat.place(number, along)))
}

/// The position of the copy in a column and a row. The coordinates are the numbers that a person would calculate.
fn at(first: Vec3, repeat: &Repeat, place: [usize; 2]) -> Vec3 {
    let [column, row] = place.map(|steps| steps as f64);
    let along = |axis: usize| {
        let [at, across, down] = [first, repeat.spacing, repeat.row_spacing].map(|v| decimal(v[axis]));
        (at + column * across + row * down) as f32
    };
    Vec3::new(along(0), along(1), along(2))
}

/// Checks that a row has room beside so many other objects.
fn room(repeat: &Repeat, others: usize) -> Result<(), Problem> {
    let total = repeat.total();
    if total + others as u64 <= MAX_OBJECTS as u64 {
        return Ok(());
    }
    let path = Path::root().key(Object::repeat.key);
    let all = match repeat.rows {
        0 | 1 => format!("{total} copies"),
        rows => format!("{} × {rows} copies", repeat.columns),
    };
    let beside = match others {
        0 => String::new(),
        n => format!(" beside {} before it", plural(n, "object")),
    };
    Err(Problem::about(
        path,
        format!("has {all}{beside}, but a scene must have at most {MAX_OBJECTS} objects"),
    ))
}

/// A row of a scene: objects that follow each other, and the entry from which they come.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// The index of the first copy.
    pub first: usize,
    /// The number of copies.
    pub count: usize,
    /// The object as in a file.
    pub entry: &'a Object,
    /// The row of the entry.
    pub repeat: &'a Repeat,
}

impl Row<'_> {
    /// The indices of the copies.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// The positions of the copies at the corners, between which all others are.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 4] {
        let [across, down] =
            [self.repeat.columns, self.repeat.rows].map(|count| count.saturating_sub(1) as usize);
        let corners = [[0, 0], [across, 0], [0, down], [across, down]];
        corners.map(|place| at(self.entry.position, self.repeat, place))
    }

    /// The distances that the copies reach below 0 and above it along each axis.
    fn reach(&self) -> [Vec3; 2] {
        let corners = self.corners();
        let most = |sign: f32| corners.iter().fold(Vec3::MIN, |most, at| most.max(sign * *at));
        [most(-1.0), most(1.0)]
    }

    /// The point in the middle of the copies.
    #[must_use]
    pub fn middle(&self) -> Vec3 {
        let [first, .., last] = self.corners();
        0.5 * (first + last)
    }

    /// The position of the first copy of a row in its place, with other numbers or steps, whose middle is the same, or as near to
    /// it as all copies have place in a room.
    #[must_use]
    pub fn position_of(&self, repeat: &Repeat, room: SceneSize) -> Vec3 {
        let beside = Object { position: Vec3::ZERO, ..self.entry.clone() };
        let other = Row { entry: &beside, repeat, ..*self };
        // Without the noise of differences.
        let wanted = ((self.middle() - other.middle()) * 1e4).round() / 1e4;
        let [below, above] = other.reach();
        // Whole copies, if that is so now and there is place.
        let [low, high] = self.reach();
        let clear = (-low).min(room.corner() - high).min(Vec3::splat(0.5 * self.entry.size));
        let margin = clear.min(0.5 * (room.corner() - above - below)).max(Vec3::splat(1e-4));
        wanted.min(room.corner() - above - margin).max(below + margin)
    }

    /// The largest number of columns, or of rows, with which all copies are in the room of a scene, if their
    /// [middle](Self::position_of) stays where it can, and which it can hold.
    #[must_use]
    pub fn most(&self, along: Along, scene: &Scene) -> u32 {
        let others = scene.objects.len().saturating_sub(self.count);
        let across = if along == Along::Rows { self.repeat.columns } else { self.repeat.rows };
        let room = MAX_OBJECTS.saturating_sub(others) / across.max(1) as usize;
        let fits = |count: usize| {
            let mut repeat = self.repeat.clone();
            let changed = if along == Along::Rows { &mut repeat.rows } else { &mut repeat.columns };
            *changed = u32::try_from(count).unwrap_or(u32::MAX);
            let position = self.position_of(&repeat, scene.scene_size);
            let entry = Object { position, ..self.entry.clone() };
            let row = Row { entry: &entry, repeat: &repeat, ..*self };
            row.corners().into_iter().all(|p| scene.scene_size.contains(p))
        };
        // Further copies are further away.
        let (mut good, mut bad) = (1, room + 1);
        while bad - good > 1 {
            let middle = good.midpoint(bad);
            if fits(middle) { good = middle } else { bad = middle }
        }
        good as u32
    }

    /// The ends of an axis of the step from column to column, or from row to row, with which all copies are in a room, to
    /// four decimals; `None` if there is no such step.
    #[must_use]
    pub fn ends_of_step(&self, along: Along, axis: usize, room: SceneSize) -> Option<[f64; 2]> {
        let mut repeat = self.repeat.clone();
        let (count, step) = match along {
            Along::Rows => (repeat.rows, &mut repeat.row_spacing),
            _ => (repeat.columns, &mut repeat.spacing),
        };
        step[axis] = 0.0;
        let steps = f64::from(count.checked_sub(1).filter(|steps| *steps > 0)?);
        let without = Row { repeat: &repeat, ..*self }.corners().map(|p| f64::from(p[axis]));
        let [first, last] = [f64::min, f64::max].map(|of| without.into_iter().reduce(of).unwrap_or_default());
        // Coordinates are greater than 0.
        let low = (-first / steps * 1e4).floor() + 1.0;
        let high = ((f64::from(room.corner()[axis]) - last) / steps * 1e4).floor();
        Some([low, high].map(|end| end / 1e4))
    }

    /// Gives the lists of values of another row of the same object as many values as there are steps: see
    /// [`Repeat::fit_lists`].
    pub fn fit_lists(&self, repeat: &mut Repeat, known: &mut Lists, registry: &Registry) {
        repeat.fit_lists(known, |varied| {
            let variable = Variable::with_path(&varied.parameter, &self.entry.object_type, registry)?;
            variable.next_after(&varied.values)
        });
    }

    /// The values of a varied value one by one, in its direction; `None` if they have none.
    #[must_use]
    pub fn values(&self, varied: &Varied, registry: &Registry) -> Option<Vec<Value>> {
        let of_type = (&*self.entry.object_type, self.repeat.steps(varied.along));
        series(varied, of_type, &Path::root(), registry).ok().map(|(_, values)| values)
    }

    /// The values that vary.
    pub fn variables(&self, registry: &Registry) -> impl Iterator<Item = Variable> {
        let known =
            |varied: &Varied| Variable::with_path(&varied.parameter, &self.entry.object_type, registry);
        self.repeat.vary.iter().filter_map(known)
    }
}

impl Scene {
    /// The row to which an object belongs. A copy that was changed alone, or one of which a neighbour is missing, belongs
    /// to none.
    #[must_use]
    pub fn row(&self, object: usize) -> Option<Row<'_>> {
        let Repetition::Copy { entry, number } = &self.objects.get(object)?.repeat else { return None };
        let Repetition::Entry(repeat) = &entry.repeat else { return None };
        let first = object.checked_sub(*number as usize)?;
        let count = usize::try_from(repeat.total()).ok()?;
        let copies = self.objects.get(first..first.checked_add(count)?)?;
        let is_next = |(i, copy): (usize, &Object)| match &copy.repeat {
            Repetition::Copy { entry: of, number } => {
                *number as usize == i && (Arc::ptr_eq(of, entry) || of == entry)
            }
            _ => false,
        };
        copies.iter().enumerate().all(is_next).then_some(Row { first, count, entry, repeat })
    }

    /// The rows of the scene, in the order of their objects.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.stretches().filter_map(|(_, row)| row)
    }

    /// All objects in their order: each row, and stretches of objects between rows. Each object is looked at once, even if
    /// rows are incomplete.
    fn stretches(&self) -> impl Iterator<Item = (Range<usize>, Option<Row<'_>>)> {
        let mut next = 0;
        std::iter::from_fn(move || {
            let first = next;
            next += 1;
            let Repetition::Copy { entry, number } = &self.objects.get(first)?.repeat else {
                return Some((first..next, None));
            };
            let Repetition::Entry(repeat) = &entry.repeat else { return Some((first..next, None)) };
            let follows = |(copy, number): (&Object, u64)| match &copy.repeat {
                Repetition::Copy { entry: of, number: own } => {
                    u64::from(*own) == number && (Arc::ptr_eq(of, entry) || of == entry)
                }
                _ => false,
            };
            let numbers = u64::from(*number)..repeat.total();
            let count = self.objects[first..].iter().zip(numbers).take_while(|one| follows(*one)).count();
            next = first + count.max(1);
            let is_whole = *number == 0 && count > 0 && count as u64 == repeat.total();
            Some((first..next, is_whole.then_some(Row { first, count, entry, repeat })))
        })
    }

    /// The index in a file of each object, and if it is in a row, the row and the number of its copy.
    fn places(&self) -> Vec<(usize, Option<(Row<'_>, usize)>)> {
        let (mut places, mut entries) = (Vec::with_capacity(self.objects.len()), 0);
        for (range, row) in self.stretches() {
            match row {
                Some(row) => places.extend((0..row.count).map(|copy| (entries, Some((row, copy))))),
                None => places.extend((0..range.len()).map(|i| (entries + i, None))),
            }
            entries += row.map_or(range.len(), |_| 1);
        }
        places
    }

    /// The index in a file of each object.
    pub(super) fn places_in_file(&self) -> Vec<usize> {
        self.places().into_iter().map(|(entry, _)| entry).collect()
    }

    /// The scene with the copies of its rows in the places of their entries.
    ///
    /// # Errors
    /// Returns the problems of rows.
    pub fn expanded(self, registry: &Registry) -> Result<Self, Vec<Problem>> {
        let (scene, problems) = self.expanded_as_far(registry);
        if problems.is_empty() { Ok(scene) } else { Err(problems) }
    }

    /// As [`expanded`](Self::expanded), but an entry whose row has problems stays a single object.
    pub(super) fn expanded_as_far(mut self, registry: &Registry) -> (Self, Vec<Problem>) {
        if !self.objects.iter().any(|object| matches!(object.repeat, Repetition::Entry(_))) {
            return (self, Vec::new());
        }
        let (mut objects, mut problems) = (Vec::new(), Vec::new());
        for (i, entry) in std::mem::take(&mut self.objects).into_iter().enumerate() {
            let Repetition::Entry(repeat) = &entry.repeat else {
                objects.push(entry);
                continue;
            };
            if problems.len() >= MOST_PROBLEMS {
                objects.push(Object { repeat: Repetition::None, ..entry });
                continue;
            }
            // A hostile file asks for millions.
            let made = room(repeat, objects.len()).map_err(|problem| vec![problem]);
            match made.and_then(|()| copies(&entry, registry)) {
                Ok(all) => objects.extend(all),
                Err(found) => {
                    let at = Path::root().key(Self::objects.key).index(i);
                    problems.extend(found.into_iter().map(|p| Problem { path: p.path.within(&at), ..p }));
                    objects.push(Object { repeat: Repetition::None, ..entry });
                }
            }
        }
        self.objects = objects;
        (self, problems)
    }

    /// The scene as in a file: with entries in the places of their copies. Copies that are no longer those of their entry
    /// are single objects.
    #[must_use]
    pub fn gathered(&self, registry: &Registry) -> Cow<'_, Self> {
        if !self.objects.iter().any(|object| matches!(object.repeat, Repetition::Copy { .. })) {
            return Cow::Borrowed(self);
        }
        let single = |object: &Object| match object.repeat {
            Repetition::Entry(_) => object.clone(),
            _ => Object { repeat: Repetition::None, ..object.clone() },
        };
        let mut objects = Vec::new();
        for (range, row) in self.stretches() {
            match row.filter(|row| self.is_as_its_entry(row, registry)) {
                Some(row) => objects.push(row.entry.clone()),
                None => objects.extend(self.objects[range].iter().map(single)),
            }
        }
        Cow::Owned(Self {
            objects,
            name: self.name.clone(),
            description: self.description.clone(),
            reflection_model: self.reflection_model.clone(),
            shading_model: self.shading_model.clone(),
            lights: self.lights.clone(),
            variants: self.variants.clone(),
            ..*self
        })
    }

    /// True if the copies of a row are those of its entry.
    fn is_as_its_entry(&self, row: &Row, registry: &Registry) -> bool {
        let copies_now = &self.objects[row.range()];
        let Some(Object { repeat: Repetition::Copy { entry, .. }, .. }) = copies_now.first() else {
            return false;
        };
        copies_of(entry, registry).is_ok_and(|all| all == copies_now)
    }

    /// Lets the entries of rows follow copies that were given other values of materials, as when another model allows others.
    /// Rows whose copies no entry describes stay as they are.
    pub(crate) fn follow_copies(&mut self, registry: &Registry) {
        let changed = self.rows().filter(|row| !self.is_as_its_entry(row, registry));
        let followed: Vec<_> =
            changed.filter_map(|row| Some((row.first, self.copies_as_now(&row, registry)?))).collect();
        for (first, copies) in followed {
            self.objects.splice(first..first + copies.len(), copies);
        }
    }

    /// The copies of a row as they are now, with an entry that describes them, if there is one.
    fn copies_as_now(&self, row: &Row, registry: &Registry) -> Option<Vec<Object>> {
        let now = &self.objects[row.range()];
        let alone = |object: &Object| Object { repeat: Repetition::None, ..object.clone() };
        let described = |entry: &Object| {
            let all = copies(entry, registry).ok()?;
            let alike = |(a, b): (&Object, &Object)| alone(a) == alone(b);
            (all.len() == now.len() && all.iter().zip(now).all(alike)).then_some(all)
        };
        let varies = |name: &str| {
            row.variables(registry).any(|one| matches!(one.key, Key::Material(own) if own == name))
        };
        let mut entry = row.entry.clone();
        entry.material.0.retain(|name, _| varies(name));
        let shared = now.first()?.material.0.iter().filter(|(name, _)| !varies(name));
        entry.material.0.extend(shared.map(|(name, value)| (name.clone(), value.clone())));
        described(&entry).or_else(|| {
            // Numbers that were limited are listed one by one.
            let Repetition::Entry(repeat) = &mut entry.repeat else { return None };
            for varied in &mut repeat.vary {
                let variable = Variable::with_path(&varied.parameter, &row.entry.object_type, registry);
                let Some(Key::Material(name)) = variable.map(|variable| variable.key) else { continue };
                let along = varied.along;
                let of_step = |step: u64| {
                    let copy = if along == Along::Rows { step * u64::from(row.repeat.columns) } else { step };
                    now.get(usize::try_from(copy).ok()?)?.material.0.get(name).cloned()
                };
                let values: Option<Vec<_>> = (0..row.repeat.steps(along)).map(of_step).collect();
                if let Some(values) = values {
                    (varied.values, varied.from, varied.to) = (values, None, None);
                    varied.scale = Scale::default();
                }
            }
            described(&entry)
        })
    }

    /// The index in a file of an object, and the number of its copy if it is in a row.
    #[must_use]
    pub fn place_in_file(&self, object: usize) -> (usize, Option<usize>) {
        let places = self.places();
        let place = places.get(object).map(|(entry, copy)| (*entry, copy.map(|(_, copy)| copy)));
        place.unwrap_or_else(|| {
            let entries = places.last().map_or(0, |(entry, _)| entry + 1);
            (entries + object.saturating_sub(places.len()), None)
        })
    }

    /// Problems of objects, with the paths that they have in a file. Those that all copies of a row have are listed once.
    pub(super) fn as_in_file(&self, problems: Vec<Problem>, registry: &Registry) -> Vec<Problem> {
        if problems.is_empty() || !self.objects.iter().any(|o| matches!(o.repeat, Repetition::Copy { .. })) {
            return problems;
        }
        let places = self.places();
        let mut found: Vec<Problem> = Vec::with_capacity(problems.len());
        for problem in problems {
            let place = problem.path.index_in(Self::objects.key).and_then(|i| places.get(i));
            let Some((entry, copy)) = place else {
                found.push(problem);
                continue;
            };
            let at = Path::root().key(Self::objects.key).index(*entry);
            let rest = Path::of(problem.path.segments()[2..].to_vec());
            let problem = match copy {
                Some((row, copy)) => of_copy(problem, &rest, row, *copy, &at, registry),
                None => Problem { path: rest.within(&at), ..problem },
            };
            // Another copy with the same problem says nothing new.
            let same = |known: &Problem| {
                let alike = known.rule == problem.rule || known.found.is_none() && problem.found.is_none();
                alike && known.path == problem.path
            };
            if copy.is_none() || !found.iter().rev().take_while(|known| known.path.starts_with(&at)).any(same)
            {
                found.push(problem);
            }
        }
        found
    }
}

/// A problem of a copy, at the place of the file that caused it.
fn of_copy(problem: Problem, rest: &Path, row: &Row, copy: usize, at: &Path, registry: &Registry) -> Problem {
    let repeat = at.key(Object::repeat.key);
    let found = problem.found.clone().unwrap_or_default();
    let is_position = matches!(rest.segments(), [Segment::Key(key)] if key == Object::position.key);
    if is_position && copy > 0 {
        return Problem::about(repeat, format!("puts copy {} at {found}, but {}", copy + 1, problem.rule));
    }
    let name = rest.to_string();
    match row.variables(registry).position(|variable| variable.path() == name) {
        Some(j) => Problem::about(
            repeat.key(Repeat::vary.key).index(j),
            format!("gives copy {} the value {found}, but {}", copy + 1, problem.rule),
        ),
        None => Problem { path: rest.within(at), ..problem },
    }
}
