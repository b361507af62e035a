//! The row of an object: how many copies, how far apart, and what differs between them.

use crate::{
    document::Document,
    panel::{
        chooser,
        knob::{self, Amount, Caption},
        prelude::*,
    },
    parameter::Value,
    scene::{
        Declared, Field, Key, Object, Repeat, Repetition, Varied,
        held::Word,
        limits::Limits,
        repeat::{Along, MAX_VARIED, Scale},
        rows::{Row, Variable},
    },
};

/// Maximum number of values that are listed.
const MOST_LISTED: usize = 50;
/// The end of the slider for a number of copies.
const SLIDER: f64 = 20.0;

/// Says which copy of which row is shown. Nothing for single objects.
pub(super) fn which(ui: &mut Ui, i: usize, context: &PanelContext<'_>) {
    let Some(row) = context.document().row(i) else { return };
    let name = context.document().name_to_edit(i, context.registry());
    let text = format!("Copy {} of {} of {name}. All are edited as one.", i - row.first + 1, row.count);
    ui.add(Label::new(theme::small(ui, text)).wrap());
    ui.add_space(4.0);
}

/// The knobs of a row, or the button that makes one.
pub(super) fn row(ui: &mut Ui, i: usize, context: &mut PanelContext<'_>) {
    let Some(row) = context.document().row(i) else {
        let button = ui.button("Make a row…").on_hover_text("Copies beside each other, edited as one");
        return context.on_click(&button, || Action::MakeRow(Selection::Object(i)));
    };
    let (session, document) = (context.session(), context.document());
    let models = (document.model_of(row.entry), document.shading_model_of(row.entry));
    let shown = Shown { i, row, session, document, registry: context.registry(), models };
    context.edits(shown.counts(ui));
    context.edits(shown.steps(ui));
    for j in 0..row.repeat.vary.len() {
        context.edits(ui.push_id(j, |ui| shown.varied(ui, j)).inner);
    }
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        let full = row.repeat.vary.len() >= MAX_VARIED;
        if let Some(varied) = shown.free().filter(|_| !full)
            && ui.button("Vary a value").clicked()
        {
            context.edit(shown.with("Varied value", |row| row.vary.push(varied)));
        }
        if ui.button("Make single objects").clicked() {
            context.edit(Edit::Row { object: i, entry: None, what: "Single objects" });
        }
    });
    ui.add_space(4.0);
}

/// A row, and the copy that is shown.
struct Shown<'a> {
    i: usize,
    row: Row<'a>,
    session: &'a Session,
    document: &'a Document,
    registry: &'a Registry,
    /// The reflection model and the shading model of the row.
    models: (&'a str, &'a str),
}

impl Shown<'_> {
    /// The edit that changes the row.
    fn with(&self, what: &'static str, change: impl FnOnce(&mut Repeat)) -> Edit {
        let mut repeat = self.row.repeat.clone();
        change(&mut repeat);
        let repeat = Repetition::Entry(Box::new(repeat));
        Edit::Row { object: self.i, entry: Some(Box::new(Object { repeat, ..self.row.entry.clone() })), what }
    }

    /// The edit that changes how many copies there are, or from which to which values vary. Copies that come back have their
    /// listed values again.
    fn counting(&self, ui: &Ui, what: &'static str, change: impl FnOnce(&mut Repeat)) -> Edit {
        let id = Id::new(("lists of a row", self.document.object_id(self.row.first)));
        self.with(what, |row| {
            change(row);
            ui.data_mut(|data| self.row.fit_lists(row, data.get_temp_mut_or_default(id), self.registry));
        })
    }

    /// An edit of the numbers that lets the row grow on all sides instead of away from its first copy.
    fn in_place(&self, mut edit: Edit) -> Edit {
        if let Edit::Row { entry: Some(entry), .. } = &mut edit
            && let Repetition::Entry(repeat) = &entry.repeat
        {
            entry.position = self.row.position_of(repeat, self.document.scene_size);
        }
        edit
    }

    /// The edit that changes a varied value.
    fn varying(&self, what: &'static str, j: usize, change: impl FnOnce(&mut Varied)) -> Edit {
        self.with(what, |row| {
            if let Some(varied) = row.vary.get_mut(j) {
                change(varied);
            }
        })
    }

    /// The numbers of columns and rows.
    fn counts(&self, ui: &mut Ui) -> Option<Edit> {
        let repeat = self.row.repeat;
        let count = |ui: &mut Ui, field: Field, value: u32, along: Along| {
            // The step that leaves room for labels becomes as small as more rows need.
            let usual = Repeat { row_spacing: Repeat::default().row_spacing, ..repeat.clone() };
            let steps = self.session.step_for_labels(&self.row, repeat.rows);
            let repeat = if steps.is_some() && along == Along::Rows { &usual } else { repeat };
            let most = f64::from(Row { repeat, ..self.row }.most(along, self.document));
            let limits = Limits::between(1.0, most).whole().slider(1.0, SLIDER.min(most.max(2.0)));
            let limits = Limits { because: Some("there is room for no more".to_owned()), ..limits };
            let caption = Caption { salt: field.key, ..Caption::of(&field) };
            knob::number_knob(ui, &caption, Amount::new(value.into(), None, &limits)).map(|v| v as u32)
        };
        let columns = count(ui, Repeat::columns, repeat.columns, Along::Columns);
        let rows = count(ui, Repeat::rows, repeat.rows, Along::Rows);
        (columns.or(rows)).map(|_| {
            let [columns, rows] = [columns.unwrap_or(repeat.columns), rows.unwrap_or(repeat.rows)];
            let step = self.session.step_for_labels(&self.row, rows).filter(|_| rows > 1);
            let edit = self.counting(ui, "Number", |row| {
                (row.columns, row.rows) = (columns, rows);
                row.row_spacing = step.unwrap_or(row.row_spacing);
            });
            self.in_place(edit)
        })
    }

    /// The steps between columns and rows, and the labels.
    fn steps(&self, ui: &mut Ui) -> Option<Edit> {
        let repeat = self.row.repeat;
        let step = |ui: &mut Ui, field: Field, value: Vec3, along: Along| {
            let limits = [0, 1, 2].map(|axis| self.limits_of_step(along, axis, value[axis].into(), field));
            let caption = Caption { salt: field.key, ..Caption::of(&field) };
            knob::vector_knob(ui, &caption, value, &limits)
        };
        let mut edit = step(ui, Repeat::spacing, repeat.spacing, Along::Columns)
            .map(|way| self.with("Spacing", |row| row.spacing = way));
        if repeat.rows > 1 {
            let changed = step(ui, Repeat::row_spacing, repeat.row_spacing, Along::Rows);
            edit = edit.or(changed.map(|way| self.with("Spacing of rows", |row| row.row_spacing = way)));
        }
        let caption = Caption::new("labels", "", Repeat::labels.help.trim());
        let labels = knob::flag_knob(ui, &caption, repeat.labels);
        edit.or(labels.map(|on| self.with("Labels", |row| row.labels = on)))
    }

    /// The limits of an axis of a step: all copies stay in the room.
    fn limits_of_step(&self, along: Along, axis: usize, now: f64, field: Field) -> Limits {
        match self.row.ends_of_step(along, axis, self.document.scene_size) {
            Some([low, high]) => Limits {
                because: Some("all copies must be in the room".to_owned()),
                ..Limits::between(low.min(now), high.max(now))
            },
            None => field.limits(),
        }
    }

    /// The values that may vary, of the object and of its model: numbers first, which have ranges.
    fn variables(&self) -> Vec<Variable> {
        let entry = self.row.entry;
        let model = self.registry.model(self.models.0);
        let shading = self.registry.shading_model(self.models.1);
        let used = |variable: &Variable| match variable.key {
            Key::Material(name) => {
                let of_model = model.and_then(|model| model.parameter(name));
                of_model.or(shading.and_then(|shading| shading.parameter(name))).is_some()
            }
            Key::Own(_) => true,
        };
        // Files are named in scene files.
        let is_file = |one: &Variable| matches!(one.declared, Declared::Parameter(parameter) if parameter.kind.format().is_some());
        let all = Variable::all(&entry.object_type, self.registry).filter(used);
        let mut all: Vec<_> = all.filter(|one| !is_file(one)).collect();
        // Those of the material are asked for most.
        let is_own = |one: &Variable| !matches!(one.key, Key::Material(_));
        all.sort_by_key(|one| (one.declared.limits().is_none(), is_own(one)));
        all
    }

    /// The value of the shown copy.
    fn value(&self, one: Variable) -> Option<Value> {
        let inherited = [
            (Key::from(Object::reflection_model), self.models.0),
            (Key::from(Object::shading_model), self.models.1),
        ];
        let own = self.document.objects.get(self.i).and_then(|object| one.of_object(object));
        let model = inherited.into_iter().find(|(key, _)| *key == one.key);
        own.or_else(|| model.map(|(_, id)| Value::Choice(id.to_owned().into())))
    }

    /// Lets a value vary: over its range, or, if it is not a number, in a list.
    fn start(&self, one: Variable, along: Along) -> Option<Varied> {
        let listed = || {
            let steps = usize::try_from(self.row.repeat.steps(along)).ok()?;
            Some(one.listed(self.value(one)?, steps, self.registry))
        };
        one.over_its_range().or_else(listed).map(|varied| Varied { along, ..varied })
    }

    /// A value that could vary, too.
    fn free(&self) -> Option<Varied> {
        let varies = |one: &Variable| self.row.repeat.vary.iter().any(|v| v.parameter == one.path());
        let free: Vec<_> = self.variables().into_iter().filter(|one| !varies(one)).collect();
        let ranges = || free.iter().find_map(|one| one.over_its_range());
        // A model without numbers has colours.
        let of_material = || free.iter().find(|one| matches!(one.key, Key::Material(_)));
        let listed = || self.start(*of_material().or(free.first())?, Along::Columns);
        ranges().or_else(listed)
    }

    /// The knobs of a varied value.
    fn varied(&self, ui: &mut Ui, j: usize) -> Option<Edit> {
        let varied = &self.row.repeat.vary[j];
        ui.add_space(6.0);
        let chosen = self.which_value(ui, j, varied);
        let range =
            if varied.values.is_empty() { self.range(ui, j, varied) } else { self.list(ui, j, varied) };
        let is_grid = self.row.repeat.rows > 1;
        let along = is_grid.then(|| choice(ui, Varied::along, varied.along, Along::ALL)).flatten();
        let along = along.map(|along| {
            self.counting(ui, "Direction", |row| {
                if let Some(varied) = row.vary.get_mut(j) {
                    varied.along = along;
                }
            })
        });
        chosen.or(range).or(along)
    }

    /// The value that varies, and a button that lets it be the same everywhere.
    fn which_value(&self, ui: &mut Ui, j: usize, varied: &Varied) -> Option<Edit> {
        let taken = |one: &Variable| {
            let path = one.path();
            path != varied.parameter && self.row.repeat.vary.iter().any(|v| v.parameter == path)
        };
        let all: Vec<_> = self.variables().into_iter().filter(|one| !taken(one)).collect();
        let now = all.iter().position(|one| one.path() == varied.parameter);
        let mut names: Vec<_> = all.iter().map(|one| one.declared.label()).collect();
        let other = now.is_none().then(|| self.name_of_other(varied));
        names.extend(other.as_deref());
        let caption = Caption::new("varies", "", Varied::parameter.help.trim());
        let line = ui.scope(|ui| knob::choice_knob(ui, &caption, now.unwrap_or(all.len()), &names));
        let new = line.inner.and_then(|k| all.get(k)).and_then(|one| self.start(*one, varied.along));
        let chosen = new.map(|new| self.varying("Varied value", j, |known| *known = new));
        // In the column of the units, so that the choice is in line with those below.
        let place = Rect::from_min_size(
            line.response.rect.right_top() + vec2(-icon::SIZE, 2.0),
            Vec2::splat(icon::SIZE),
        );
        let mut unit = ui.new_child(UiBuilder::new().max_rect(place));
        let same = icon::button(&mut unit, Icon::Bin, "The same for all copies").clicked();
        let same = same.then(|| self.with("Varied value", |row| drop(row.vary.remove(j))));
        chosen.or(same)
    }

    /// The name of a varied value that cannot be chosen: the model does not use it.
    fn name_of_other(&self, varied: &Varied) -> String {
        self.known(varied).map_or_else(
            || varied.parameter.clone(),
            |one| match one.key {
                Key::Material(_) => format!("{} (not used)", one.declared.label()),
                Key::Own(_) => one.declared.label().to_owned(),
            },
        )
    }

    /// The ends of a range, and its scale.
    fn range(&self, ui: &mut Ui, j: usize, varied: &Varied) -> Option<Edit> {
        let limits = self.known(varied).and_then(|one| one.declared.limits());
        let limits = limits.unwrap_or_else(|| Varied::from.limits());
        let end = |ui: &mut Ui, field: Field, value: Option<f32>| {
            let caption = Caption { salt: field.key, ..Caption::of(&field) };
            let value = f64::from(value.unwrap_or_default());
            knob::number_knob(ui, &caption, Amount::new(value, None, &limits)).map(|v| v as f32)
        };
        let from = end(ui, Varied::from, varied.from)
            .map(|v| self.varying("First value", j, |varied| varied.from = Some(v)));
        let to = end(ui, Varied::to, varied.to)
            .map(|v| self.varying("Last value", j, |varied| varied.to = Some(v)));
        let scale = choice(ui, Varied::scale, varied.scale, Scale::ALL)
            .map(|scale| self.varying("Scale", j, |varied| varied.scale = scale));
        let help = "The values one by one, to be changed each by itself";
        let listed = ui.button("List instead").on_hover_text(help).clicked();
        let values = listed.then(|| self.row.values(varied, self.registry)).flatten();
        let list = values.map(|values| {
            self.varying("Varied value", j, |varied| {
                (varied.values, varied.from, varied.to) = (values, None, None);
                varied.scale = Scale::default();
            })
        });
        from.or(to).or(scale).or(list)
    }

    /// The listed values, each with a knob, and a button that makes a range of numbers.
    fn list(&self, ui: &mut Ui, j: usize, varied: &Varied) -> Option<Edit> {
        let known = self.known(varied);
        let mut changed = None;
        for (k, value) in varied.values.iter().take(MOST_LISTED).enumerate() {
            let name = format!("value {}", k + 1);
            let new = ui.push_id(k, |ui| match known {
                Some(one) => self.listed(ui, one, &name, value),
                None => {
                    ui.label(theme::small(ui, format!("{name}: {value}")));
                    None
                }
            });
            if let Some(new) = new.inner {
                changed = Some(self.varying("Listed value", j, |varied| varied.values[k] = new));
            }
        }
        if varied.values.len() > MOST_LISTED {
            let rest = format!("… ({} values in all; a file can change the others)", varied.values.len());
            ui.add(Label::new(theme::small(ui, rest)).wrap());
        }
        changed.or_else(|| self.range_instead(ui, j, varied))
    }

    /// The knob of a listed value. Returns another one.
    fn listed(&self, ui: &mut Ui, one: Variable, name: &str, value: &Value) -> Option<Value> {
        let caption = Caption::new(name, "", one.declared.label());
        if let Some(limits) = one.declared.limits() {
            let new = knob::number_knob(ui, &caption, Amount::new(value.numbers()[0], None, &limits))?;
            return one.declared.of_number(new);
        }
        match (value, one.declared) {
            (Value::Colour(rgb), _) => knob::colour_knob(ui, &caption, *rgb, None).map(Value::Colour),
            (Value::Triple(v), Declared::Parameter(parameter)) => {
                let new = knob::triple_knob(ui, &caption, *v, *v, &parameter.kind.limits()?);
                new.map(Value::Triple)
            }
            (Value::Triple(v), Declared::Field(field)) => {
                let limits = [(); 3].map(|()| field.limits());
                knob::vector_knob(ui, &caption, (*v).into(), &limits).map(|v| Value::Triple(v.into()))
            }
            (Value::Choice(id), _) if one.key == Object::reflection_model.into() => {
                self.model(ui, &caption, id)
            }
            (Value::Choice(word), _) => {
                let words = one.words(self.registry);
                let names: Vec<_> = words.iter().map(|(_, name)| *name).collect();
                let now = words.iter().position(|(id, _)| **id == **word).unwrap_or(words.len());
                let new = knob::choice_knob(ui, &caption, now, &names)?;
                words.get(new).map(|(id, _)| Value::Choice((*id).into()))
            }
            _ => {
                let shown = one.declared.shown(value, self.registry);
                ui.add(Label::new(theme::small(ui, format!("{name}: {shown}"))).wrap());
                None
            }
        }
    }

    /// The choice of a listed reflection model, with a search. Returns another one.
    fn model(&self, ui: &mut Ui, caption: &Caption, now: &str) -> Option<Value> {
        let shown = self.registry.model(now).map_or(now, |model| model.declaration.name);
        let model = knob::list_knob(ui, caption, shown, |ui, list| {
            let height = 0.45 * ui.ctx().content_rect().height();
            chooser::models(ui, list, height, self.session, self.registry, Some(now), None)
        });
        let id = model.flatten()?.declaration.id;
        (id != now).then(|| Value::Choice(id.into()))
    }

    /// The declaration of a varied value, if there is one.
    fn known(&self, varied: &Varied) -> Option<Variable> {
        Variable::with_path(&varied.parameter, &self.row.entry.object_type, self.registry)
    }

    /// The button that makes a range of listed values.
    fn range_instead(&self, ui: &mut Ui, j: usize, varied: &Varied) -> Option<Edit> {
        self.known(varied)?.declared.limits()?;
        let [from, to] = [varied.values.first()?, varied.values.last()?].map(|end| end.numbers()[0] as f32);
        let help = "From the first of these values to the last, in equal steps";
        let range = ui.button("Range instead").on_hover_text(help).clicked();
        range.then(|| {
            self.varying("Varied value", j, |varied| {
                (varied.values, varied.from, varied.to) = (Vec::new(), Some(from), Some(to));
            })
        })
    }
}

/// The knob of a choice. Returns another one.
fn choice<T: Word + PartialEq>(ui: &mut Ui, field: Field, now: T, all: &[T]) -> Option<T> {
    let options: Vec<_> = all.iter().map(|one| one.about()).map(|[_, name, help]| [name, "", help]).collect();
    let chosen = all.iter().position(|one| *one == now).unwrap_or(0);
    let caption = Caption { salt: field.key, ..Caption::of(&field) };
    knob::choice_with_help(ui, &caption, chosen, &options).and_then(|k| all.get(k)).copied()
}
