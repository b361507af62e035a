//! An hour of work: random edits of every kind, undone and redone, are restored exactly.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

use glam::Vec3;
use lights_camera_models::{
    document::{Edit, Extent, PartId, Selection},
    optics::{colour::Encoding, tone::ToneMapping},
    panel::{
        effects,
        state::{Action, Answer, Effect, Question, Session},
    },
    parameter::Value,
    recovery::{About, Keeper, Settled, Store},
    registry::Registry,
    scene::{
        Background, Display, Light, Object, Observer, Part, Scene, SceneSize, check,
        load::{self, Defaults},
        save,
    },
    testing::random_values,
    window::files::DiskFiles,
};

use crate::renderers::reload::random::Random;

/// Number of steps that a history keeps.
const MOST_STEPS: usize = 500;

/// The state restored by a step.
#[derive(Clone, Debug, PartialEq)]
struct State {
    scene: Scene,
    lights: Vec<Option<PartId>>,
    objects: Vec<Option<PartId>>,
}

/// A window's document with a file, and its known history.
struct Desk {
    session: Session,
    files: DiskFiles,
    registry: Registry,
    random: Random,
    path: PathBuf,
    /// Keeps recovery copies.
    keeper: Keeper,
    shared: Arc<Registry>,
    /// The state after each step.
    states: Vec<State>,
    /// The selection before and after each step.
    selections: Vec<[Selection; 2]>,
}

impl Desk {
    fn new(seed: u64, folder: &Path) -> Self {
        let registry = Registry::builtin();
        let path = folder.join("room.json");
        let session = Session::default();
        fs::write(&path, save::to_json(&session.document, None, &registry)).unwrap();
        let files = DiskFiles::new(None, None);
        let keeper = Keeper::start(Some(Store::new(folder.join("copies"))), || {});
        let shared = Arc::new(registry.clone());
        let (states, selections) = (vec![], vec![]);
        let mut desk =
            Self { session, files, registry, random: Random(seed), path, keeper, shared, states, selections };
        let open = Effect::OpenFile(desk.path.clone());
        desk.carry_out(vec![open]);
        desk.states.push(desk.state());
        desk.check("opening");
        desk
    }

    fn state(&self) -> State {
        let scene = self.session.document.scene().clone();
        State { scene, lights: self.lights().collect(), objects: self.objects().collect() }
    }

    /// The ids of the lights.
    fn lights(&self) -> impl Iterator<Item = Option<PartId>> + '_ {
        let document = &self.session.document;
        (0..document.lights.len()).map(move |i| document.light_id(i))
    }

    /// The ids of the objects.
    fn objects(&self) -> impl Iterator<Item = Option<PartId>> + '_ {
        let document = &self.session.document;
        (0..document.objects.len()).map(move |i| document.object_id(i))
    }

    /// True if this is the state, which is compared without a copy of the scene.
    fn is_in(&self, state: &State) -> bool {
        *self.session.document.scene() == state.scene
            && self.lights().eq(state.lights.iter().copied())
            && self.objects().eq(state.objects.iter().copied())
    }

    /// Carries out the effects on the document's file.
    fn carry_out(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            if effect == Effect::DocumentChanged {
                self.files.document_changed(self.session.path.as_deref());
            }
            if let Effect::OpenFile(_)
            | Effect::SaveFile { .. }
            | Effect::CheckFile { .. }
            | Effect::ExpectFile { .. } = effect
            {
                let more = effects::run(&mut self.session, &self.registry, effect, &mut self.files);
                self.carry_out(more);
            }
        }
    }

    fn act(&mut self, action: Action) {
        let effects = self.session.apply(action, &self.registry);
        self.carry_out(effects);
    }

    fn below(&mut self, end: usize) -> usize {
        self.random.below(end)
    }

    fn number(&mut self, from: f32, to: f32) -> f32 {
        from + (to - from) * self.below(1 << 16) as f32 / 65536.0
    }

    /// A position in the room, or sometimes outside.
    fn place(&mut self) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.number(-0.5, 10.0)))
    }

    fn colour(&mut self) -> [u8; 3] {
        [0; 3].map(|_| self.below(256) as u8)
    }

    fn name(&mut self) -> String {
        ["", "  ", "lamp", "ball 2", "Sphere 1", "Point light 1", "Grün"][self.below(7)].to_owned()
    }

    fn model(&mut self) -> String {
        let models = self.registry.models().len();
        self.registry.models()[self.random.below(models)].declaration.id.to_owned()
    }

    fn shading(&mut self) -> String {
        let models = self.registry.shading_models().len();
        self.registry.shading_models()[self.random.below(models)].declaration.id.to_owned()
    }

    fn shape(&mut self) -> String {
        let shapes = self.registry.shapes().len();
        self.registry.shapes()[self.random.below(shapes)].declaration.id.to_owned()
    }

    fn light_type(&mut self) -> String {
        let lights = self.registry.lights().len();
        self.registry.lights()[self.random.below(lights)].declaration.id.to_owned()
    }

    /// Parameters of any model.
    fn parameters(&mut self) -> Vec<(&'static str, Value)> {
        let models = self.registry.models().len();
        let model = &self.registry.models()[self.random.below(models)];
        let mut seed = self.random.0;
        self.random.below(1);
        let values = random_values(model, &mut seed);
        model.parameters.iter().filter_map(|p| Some((p.name, values.0.get(p.name)?.clone()))).collect()
    }

    fn light_edit(&mut self, i: usize) -> Edit {
        match self.below(10) {
            0 => Edit::set(Part::Light(i), Light::name, self.name()),
            1 => Edit::set(Part::Light(i), Light::enabled, self.below(2) == 0),
            2 => Edit::set(Part::Light(i), Light::light_type, self.light_type()),
            3 => Edit::set(Part::Light(i), Light::position, self.place()),
            4 => Edit::set(Part::Light(i), Light::direction, self.place() - 5.0),
            5 => Edit::set(Part::Light(i), Light::colour, self.colour()),
            6 => Edit::set(Part::Light(i), Light::colour_temperature, self.number(500.0, 30_000.0)),
            7 => Edit::set(Part::Light(i), Light::intensity, self.number(-1.0, 200.0)),
            8 => Edit::set(Part::Light(i), Light::luminous_flux, self.number(-1.0, 2000.0)),
            _ => {
                let entry =
                    self.session.document.lights.get(i).and_then(|l| self.registry.light(&l.light_type));
                let parameters = entry.map_or(&[][..], |entry| entry.parameters);
                match parameters.len() {
                    0 => Edit::parameter(Part::Light(i), "none", Value::Number(1.0)),
                    n => {
                        let id = parameters[self.random.below(n)].name;
                        Edit::parameter(Part::Light(i), id, Value::Number(self.number(-10.0, 100.0)))
                    }
                }
            }
        }
    }

    fn object_edit(&mut self, i: usize) -> Edit {
        match self.below(12) {
            0 => Edit::set(Part::Object(i), Object::name, self.name()),
            1 => Edit::set(Part::Object(i), Object::visible, self.below(2) == 0),
            2 => Edit::set(Part::Object(i), Object::object_type, self.shape()),
            3 => Edit::set(Part::Object(i), Object::position, self.place()),
            4 => Edit::set(Part::Object(i), Object::size, self.number(-0.2, 3.0)),
            5 => Edit::set(Part::Object(i), Object::rotation, self.place() * 40.0),
            6 => Edit::put(
                Part::Object(i),
                Object::tessellation,
                [None, Some(0), Some(12), Some(33)][self.below(4)],
            ),
            7 => Edit::put(
                Part::Object(i),
                Object::reflection_model,
                (self.below(3) > 0).then(|| self.model()),
            ),
            8 => {
                Edit::put(Part::Object(i), Object::shading_model, (self.below(3) > 0).then(|| self.shading()))
            }
            9 => match self.parameters().pop() {
                Some((id, value)) => Edit::material(Part::Object(i), id, value),
                None => Edit::material(Part::Object(i), "none", Value::Number(0.0)),
            },
            10 => Edit::materials(Part::Object(i), self.parameters(), "Measured material"),
            // Of this type or of another.
            _ => {
                let shapes = self.registry.shapes().iter();
                let parameters: Vec<_> = shapes.flat_map(|s| s.parameters).map(|p| p.name).collect();
                let id = parameters[self.below(parameters.len())];
                Edit::parameter(Part::Object(i), id, Value::Number(self.number(-0.5, 3.5)))
            }
        }
    }

    fn light(&mut self) -> usize {
        self.random.below(self.session.document.lights.len())
    }

    fn object(&mut self) -> usize {
        self.random.below(self.session.document.objects.len())
    }

    fn part(&mut self) -> Selection {
        match self.below(8) {
            0 => Selection::Room,
            1 => Selection::Observer,
            2 | 3 => Selection::Light(self.light()),
            _ => Selection::Object(self.object()),
        }
    }

    fn edit(&mut self) -> Edit {
        match self.below(24) {
            0 => Edit::set(Part::Scene, Scene::name, self.name()),
            1 => Edit::set(Part::Scene, Scene::description, self.name()),
            2 => Edit::from(SceneSize {
                width: self.number(8.0, 20.0),
                height: self.number(8.0, 20.0),
                depth: self.number(8.0, 120.0),
            }),
            3 => Edit::from(Display {
                exposure: self.number(-4.0, 4.0),
                tone_mapping: [ToneMapping::AgX, ToneMapping::Aces, ToneMapping::default()][self.below(3)],
                encoding: [Encoding::Off, Encoding::default()][self.below(2)],
                background: Background::ALL[self.below(Background::ALL.len())],
                ..Display::default()
            }),
            4 => Edit::set(
                Part::Scene,
                Scene::reflection_model,
                if self.below(5) == 0 { "nobody's".to_owned() } else { self.model() },
            ),
            5 => Edit::set(Part::Scene, Scene::shading_model, self.shading()),
            6 => Edit::from(Observer {
                field_of_view: self.number(-5.0, 190.0),
                ..Observer::at(self.place(), self.place() - 5.0)
            }),
            7..15 => {
                // A nonexistent one too.
                let i = self.light() + usize::from(self.below(20) == 0);
                self.light_edit(i)
            }
            _ => {
                let i = self.object() + usize::from(self.below(20) == 0);
                self.object_edit(i)
            }
        }
    }

    /// A system moves, resizes and dims some parts, or breaks a rule.
    fn submit(&mut self) {
        let mut scene = self.session.document.scene().clone();
        let mut parts = Vec::new();
        for _ in 0..=self.below(3) {
            match self.below(5) {
                0 => {
                    scene.observer.position = self.place();
                    parts.push(Extent::Rest);
                }
                1 => {
                    let i = self.light();
                    scene.lights[i].intensity = self.number(-1.0, 60.0);
                    parts.push(Extent::Light(i));
                }
                2 => {
                    let i = self.object();
                    scene.objects[i].position = self.place();
                    parts.push(Extent::Object(i));
                }
                3 => {
                    let i = self.object();
                    scene.objects[i].size = self.number(0.0, 2.0);
                    parts.push(Extent::Object(i));
                }
                _ => {
                    let [i, j] = [self.object(), self.object()];
                    scene.objects.swap(i, j);
                    parts.push(Extent::All);
                }
            }
        }
        let before = self.state();
        let selection = self.session.selection;
        match self.session.submit(&scene, &parts, &self.registry) {
            Ok(()) => assert!(self.session.document == scene, "all that was submitted is there"),
            Err(_) => assert_eq!((self.state(), self.session.selection), (before, selection)),
        }
    }

    /// Another program writes the file.
    fn file_changes(&mut self) {
        let mut scene = match self.below(3) {
            0 => self.session.document.saved().clone(),
            _ => self.session.document.scene().clone(),
        };
        for _ in 0..=self.below(2) {
            let (objects, lights) = (scene.objects.len(), scene.lights.len());
            match self.below(6) {
                0 if objects > 1 => drop(scene.objects.remove(self.random.below(objects))),
                1 => scene.objects.push(scene.objects[self.random.below(objects)].clone()),
                2 => scene.objects.swap(self.random.below(objects), self.random.below(objects)),
                3 => scene.lights.insert(0, scene.lights[self.random.below(lights)].clone()),
                4 => scene.objects[self.random.below(objects)].size = self.number(0.1, 2.0),
                _ => scene.display.exposure = self.number(-2.0, 2.0),
            }
        }
        fs::write(&self.path, save::to_json(&scene, None, &self.registry)).unwrap();
        self.carry_out(vec![Effect::CheckFile { discard: false }]);
    }

    /// Changes something as a user, a system or another program would. Returns what was removed.
    fn anything(&mut self) -> Option<Selection> {
        let mut removed = None;
        match self.below(40) {
            0..3 => self.submit(),
            3 => self.file_changes(),
            4 => {
                self.act(Action::Save);
                if self.session.questions.open.is_none() {
                    assert!(!self.session.is_dirty(), "{:?}", self.session.messages);
                    let read = load::file(&self.path, &self.registry, Defaults::Use).unwrap();
                    // If the luminous flux is set, the intensity is not written.
                    let text = |scene: &Scene| save::to_json(scene, None, &self.registry);
                    assert_eq!(
                        text(&read.scene),
                        text(&self.session.document.named(&self.registry)),
                        "what is saved is what is read"
                    );
                }
            }
            5..8 => {
                let part = self.part();
                self.act(Action::Select(part));
            }
            8 => self.act(Action::SelectNext),
            9 if self.session.document.objects.len() < 40 => {
                let shape = self.shape();
                self.act(Action::AddObject(shape));
            }
            10 if self.session.document.lights.len() < 12 => {
                let light = self.light_type();
                self.act(Action::AddLight(light));
            }
            11 | 12 if self.session.document.objects.len() < 40 => {
                let part = self.part();
                self.act(Action::Duplicate(part));
            }
            13..16 => {
                let part = self.part();
                removed = Some(part);
                self.act(Action::Remove(part));
            }
            16 => {
                let part = self.part();
                self.act(Action::Toggle(part));
            }
            17 => {
                let ev = self.number(-1.0, 1.0);
                self.act(Action::Expose(ev));
            }
            _ => {
                let edit = self.edit();
                // As from a slider: several values within a gesture.
                for _ in 0..self.below(3) {
                    self.act(Action::Edit(edit.clone()));
                }
                self.act(Action::Edit(edit));
            }
        }
        let answers: &[Answer] = match &self.session.questions.open {
            None => return removed,
            Some(Question::NewerOnDisk { .. }) => &[Answer::Reload, Answer::Keep, Answer::Cancel],
            _ => &[Answer::Overwrite, Answer::Cancel],
        };
        let answer = answers[self.below(answers.len())];
        self.act(Action::Answer(answer));
        removed
    }

    /// Performs an edit, and records the resulting document.
    fn record(&mut self) {
        if self.below(3) > 0 {
            self.session.document.end_gesture();
        }
        let done = self.session.document.done();
        let selection = self.session.selection;
        let before: Vec<_> = self
            .unnamed()
            .into_iter()
            .map(|((id, part_type), name)| (id, part_type.to_owned(), name))
            .collect();
        let removed = self.anything();
        let now = self.state();
        self.check("an edit");
        let unnamed = self.unnamed();
        for (id, part_type, name) in &before {
            // Until it is named, or changes its type.
            let now = unnamed.get(&(*id, part_type.as_str()));
            assert!(now.is_none_or(|now| now == name), "{name} is {now:?}");
        }
        let steps = self.session.document.done();
        if now == self.states[done] && steps == done {
            return;
        }
        assert_eq!(steps, self.session.document.steps().len(), "what was undone is gone");
        assert!(steps.abs_diff(done) <= 1, "{done} steps, then {steps}");
        self.states.truncate(steps.min(done) + 1);
        self.selections.truncate(steps.min(done));
        if steps > done {
            // Undoing a removal selects what is restored.
            self.states.push(now);
            self.selections.push([removed.unwrap_or(selection), self.session.selection]);
        } else {
            // Merged with the last step, or cancelled out by it.
            assert!(steps == done || now == self.states[steps], "a step that leads back is none");
            if let Some(state) = self.states.last_mut() {
                *state = now;
            }
            if let Some([_, after]) = self.selections.last_mut().filter(|_| steps == done) {
                *after = self.session.selection;
            }
        }
    }

    /// The automatic names of parts, by id and type.
    fn unnamed(&self) -> BTreeMap<(Option<PartId>, &str), String> {
        let document = &self.session.document;
        let name = |part| document.name_of(part, &self.registry);
        let lights = document.lights.iter().enumerate().filter(|(_, light)| light.name.is_none());
        let lights = lights.map(|(i, l)| ((document.light_id(i), &*l.light_type), name(Selection::Light(i))));
        let objects = document.objects.iter().enumerate().filter(|(_, object)| object.name.is_none());
        let objects =
            objects.map(|(i, o)| ((document.object_id(i), &*o.object_type), name(Selection::Object(i))));
        lights.chain(objects).collect()
    }

    /// Checks the invariants.
    fn check(&self, after: &str) {
        let problems = check::scene(&self.session.document, &self.registry);
        assert!(problems.is_empty(), "after {after}: {problems:?}");
        self.check_known(after);
    }

    /// Checks the invariants where the scene equals one that was checked.
    fn check_known(&self, after: &str) {
        let document = &self.session.document;
        assert_eq!(document.differs(), document.scene() != document.saved(), "after {after}");
        let mut ids: Vec<_> = self.lights().chain(self.objects()).collect();
        ids.sort_unstable();
        assert!(ids.iter().all(Option::is_some) && ids.windows(2).all(|pair| pair[0] != pair[1]));
        for i in 0..document.lights.len() {
            assert_eq!(document.light_id(i).and_then(|id| document.light(id)), Some(i), "after {after}");
        }
        for i in 0..document.objects.len() {
            assert_eq!(document.object_id(i).and_then(|id| document.object(id)), Some(i), "after {after}");
        }
        let unnamed = self.unnamed();
        let names: BTreeSet<_> = unnamed.values().collect();
        assert_eq!(names.len(), unnamed.len(), "after {after}: {names:?}");
        let exists = match self.session.selection {
            Selection::Light(i) => i < document.lights.len(),
            Selection::Object(i) => i < document.objects.len(),
            Selection::Room | Selection::Observer => true,
        };
        assert!(exists, "after {after}: {:?} is selected", self.session.selection);
        assert!(document.steps().len() <= MOST_STEPS);
        self.keeper.keep(document, About::default(), &self.shared);
    }

    /// Checks that the recovery copy equals the document.
    fn check_copy(&self) {
        let Settled::Kept { file, .. } = self.keeper.settle(Duration::from_secs(60)) else {
            panic!("there is a copy");
        };
        let text = save::to_json(&self.session.document.named(&self.registry), None, &self.registry);
        assert_eq!(fs::read_to_string(file).unwrap(), text);
    }

    /// Undoes everything and redoes it all.
    fn back_and_forth(&mut self) {
        self.act(Action::GoToStep(self.states.len() - 1));
        for step in (0..self.selections.len()).rev() {
            let name = self.session.document.steps().nth(step).map(str::to_owned);
            self.act(Action::Undo);
            let expected = &self.states[step];
            assert!(self.is_in(expected), "undoing {step}: {name:?}: {:?}\n{expected:?}", self.state());
            assert_eq!(self.session.selection, self.selections[step][0], "undoing {step}: {name:?}");
            self.check_known("undoing");
        }
        assert_eq!(self.session.document.done(), 0);
        self.check_copy();
        for step in 0..self.selections.len() {
            self.act(Action::Redo);
            let name = self.session.document.steps().nth(step).map(str::to_owned);
            let expected = &self.states[step + 1];
            assert!(self.is_in(expected), "redoing {step}: {name:?}: {:?}\n{expected:?}", self.state());
            assert_eq!(self.session.selection, self.selections[step][1], "redoing {step}: {name:?}");
            self.check_known("redoing");
        }
        assert_eq!(self.session.document.done(), self.session.document.steps().len());
    }
}

#[test]
fn an_hour_of_editing_is_undone_and_redone_exactly() {
    /// The number of hours; `LCM_FUZZ_ROUNDS` overrides it.
    const HOURS: u64 = 4;
    let hours = std::env::var("LCM_FUZZ_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(HOURS);
    for hour in 0..hours {
        println!("seed {hour}");
        let folder = tempfile::tempdir().unwrap();
        let mut desk = Desk::new(hour, folder.path());
        for round in 0..1000 {
            if desk.session.document.steps().len() + 1 >= MOST_STEPS || round % 331 == 330 {
                desk.back_and_forth();
                // From somewhere in the middle, other edits replace what was undone.
                let step = desk.below(desk.states.len());
                desk.act(Action::GoToStep(step));
                assert_eq!(desk.state(), desk.states[step]);
            }
            desk.record();
            if round % 97 == 0 {
                desk.check_copy();
            }
        }
        desk.back_and_forth();
        // Beyond the limit, the oldest steps are dropped.
        for _ in 0..MOST_STEPS * 3 {
            desk.session.document.end_gesture();
            desk.anything();
            desk.check("an edit");
        }
        let latest = desk.state();
        let steps = desk.session.document.steps().len();
        assert_eq!(steps, MOST_STEPS);
        desk.act(Action::GoToStep(0));
        desk.check("undoing all");
        desk.act(Action::GoToStep(steps));
        assert_eq!(desk.state(), latest);
    }
}
