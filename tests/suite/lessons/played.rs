//! Every shipped lesson from start to end: each task can be solved as its text asks, is not solved before,
//! and is not solved by a plausible mistake.

use std::{path::Path, sync::atomic::AtomicBool};

use lights_camera_models::{
    custom,
    document::Selection,
    explain::{Explainer, Explanation},
    lesson::{Goal, Lesson, Situation, WindowFacts, shipped::LESSONS},
    optics::TermSelection,
    reference::{self, LightSamples, Settings},
    registry::Registry,
    scene::{Scene, SceneIn, SceneOf},
};
use serde::de::DeserializeSeed as _;
use serde_json::{Value, json};

use crate::helpers::support::builtin;

/// Width and height of the picture seen by the learner.
const SIZE: [u32; 2] = [320, 180];
const SETTINGS: Settings =
    Settings { width: SIZE[0], height: SIZE[1], samples: 1, terms: TermSelection::All };

/// An action of a learner.
enum Deed {
    /// Changes values of the scene, given by JSON pointers.
    Set(&'static [(&'static str, fn() -> Value)]),
    /// Finds a pixel on an object, and pins it: one that completes the task or, for a mistake, one that does
    /// not.
    Pin,
    /// Shows a single term.
    Terms(TermSelection),
    /// Opens a text in the editor.
    OpenCode,
    /// Saves a model of one's own, with this change of the template, and shows it.
    Write(&'static [(&'static str, &'static str)]),
}

/// The learner at a step.
struct Learner {
    registry: Registry,
    explainer: Explainer,
    scene: Scene,
    selection: Selection,
    window: WindowFacts,
    pin: Option<[u32; 2]>,
}

impl Learner {
    fn new() -> Self {
        Self {
            registry: builtin(),
            explainer: Explainer::default(),
            scene: Scene::default(),
            selection: Selection::Object(0),
            window: WindowFacts::default(),
            pin: None,
        }
    }

    /// Enters a step, as the window does: its scene, selection, pin and terms.
    fn enter(&mut self, lesson: &Lesson, step: usize) {
        self.scene = lesson.state(step, &self.registry).expect(&lesson.id);
        let window = &lesson.steps[step].window;
        if let Some(part) = window.select.as_ref().and_then(|part| part.find(&self.scene)) {
            self.selection = part;
        }
        self.window.active = window.active.unwrap_or(self.window.active);
        self.window.terms = window.terms.unwrap_or(self.window.terms);
        self.window.views = 1 + self.scene.variants.len();
        let pixel = |[x, y]: [f32; 2]| [(x * SIZE[0] as f32) as u32, (y * SIZE[1] as f32) as u32];
        if let Some(pin) = window.pin {
            self.pin = pin.map(pixel);
        }
    }

    /// The scene shown by the active view.
    fn seen(&self) -> Scene {
        let (scene, _) = self.scene.seen(self.window.active, &self.registry).expect("the view is there");
        scene
    }

    fn explained(&mut self, scene: &Scene, pixel: [u32; 2]) -> Explanation {
        self.explainer.pixel(scene, &self.registry, &SETTINGS, pixel).expect("within the picture")
    }

    fn asks<T>(&mut self, of: impl FnOnce(&Situation) -> T) -> T {
        let scene = self.seen();
        let probe = self.pin.map(|pixel| self.explained(&scene, pixel));
        self.asks_about(&scene, probe.as_ref(), of)
    }

    /// Asks about the scene that is seen, and the explanation of its pinned pixel.
    fn asks_about<T>(
        &self,
        scene: &Scene,
        probe: Option<&Explanation>,
        of: impl FnOnce(&Situation) -> T,
    ) -> T {
        of(&Situation {
            scene,
            registry: &self.registry,
            selection: self.selection,
            window: self.window,
            probe,
            pinned: probe.is_some(),
        })
    }

    fn holds(&mut self, goal: &Goal) -> bool {
        self.asks(|situation| goal.until.holds(situation))
    }

    /// The window's message about a task that is not done.
    fn unmet(&mut self, goal: &Goal) -> Option<String> {
        self.asks(|situation| goal.until.unmet(situation))
    }

    /// Performs an action; true if it reaches the goal.
    fn does(&mut self, deed: &Deed, goal: &Goal, wanted: bool) -> bool {
        match deed {
            Deed::Set(values) => {
                let mut file = serde_json::to_value(SceneIn(&self.scene, &self.registry)).expect("JSON");
                for (place, value) in *values {
                    let (parent, key) = place.rsplit_once('/').expect("a pointer");
                    let parent = file.pointer_mut(parent).unwrap_or_else(|| panic!("no {place}"));
                    parent[key] = value();
                }
                self.scene = SceneOf(&self.registry).deserialize(file).expect("a legal scene");
                self.holds(goal)
            }
            Deed::Terms(terms) => {
                self.window.terms = *terms;
                self.holds(goal)
            }
            Deed::OpenCode => {
                self.window.code = true;
                self.holds(goal)
            }
            Deed::Write(changes) => {
                let mut text = custom::template("own", "Own");
                for (from, to) in *changes {
                    assert!(text.contains(from), "{from}");
                    text = text.replace(from, to);
                }
                let read = custom::read(Path::new("models/own.wgsl"), &text, &self.registry);
                let model = read.unwrap_or_else(|problems| panic!("{problems:?}"));
                self.registry.put_custom_model(model);
                self.scene.reflection_model = "own".to_owned();
                self.holds(goal)
            }
            Deed::Pin => {
                let scene = self.seen();
                // Pixels of the background need no explanation.
                let (samples, odd) = (LightSamples::of(1), AtomicBool::default());
                let picture = reference::render_samples(&scene, &self.registry, &SETTINGS, samples, &odd);
                // The coarse grid first: most tasks have many solutions.
                for stride in [9, 5, 2] {
                    for y in (stride / 2..SIZE[1]).step_by(stride as usize) {
                        for x in (stride / 2..SIZE[0]).step_by(stride as usize) {
                            if picture.pixel(x, y).w == 0.0 {
                                continue;
                            }
                            let explained = self.explained(&scene, [x, y]);
                            if explained.seen.is_none() {
                                continue;
                            }
                            self.pin = Some([x, y]);
                            let probe = Some(&explained);
                            if self.asks_about(&scene, probe, |at| goal.until.holds(at)) == wanted {
                                return wanted;
                            }
                        }
                    }
                }
                !wanted
            }
        }
    }
}

/// The tasks with a condition, in the order of the lessons: the step, the solution, and a mistake.
const TASKS: &[(&str, &str, Deed, Deed)] = &[
    ("01", "Which way a surface faces", Deed::Pin, Deed::Pin),
    ("01", "See the cosine", Deed::Pin, Deed::Pin),
    (
        "01",
        "Colour of the surface",
        Deed::Set(&[("/objects/0/material", || json!({ "base_colour": [238, 68, 68] }))]),
        Deed::Set(&[("/objects/0/material", || json!({ "base_colour": [30, 30, 30] }))]),
    ),
    (
        "01",
        "A shiny ball",
        Deed::Set(&[("/reflection_model", || json!("phong"))]),
        Deed::Set(&[("/reflection_model", || json!("blinn_phong"))]),
    ),
    ("02", "One term alone", Deed::Terms(TermSelection::Specular), Deed::Terms(TermSelection::Diffuse)),
    ("02", "The diffuse term", Deed::Pin, Deed::Pin),
    (
        "02",
        "The specular term",
        Deed::Set(&[("/objects/0/material/k_s", || json!(0))]),
        Deed::Set(&[("/objects/0/material/alpha", || json!(0))]),
    ),
    (
        "02",
        "The sum",
        Deed::Set(&[("/objects/0/material/alpha", || json!(8))]),
        Deed::Set(&[("/objects/0/material/alpha", || json!(100))]),
    ),
    (
        "03",
        "One colour per polygon",
        Deed::Set(&[("/shading_model", || json!("flat"))]),
        Deed::Set(&[("/shading_model", || json!("derivative"))]),
    ),
    ("03", "Between the vertices", Deed::Pin, Deed::Pin),
    (
        "03",
        "Per pixel: Phong",
        Deed::Set(&[("/shading_model", || json!("phong"))]),
        Deed::Set(&[("/shading_model", || json!("derivative"))]),
    ),
    ("04", "The angle to N", Deed::Pin, Deed::Pin),
    (
        "04",
        "The exponent",
        Deed::Set(&[("/objects/0/material/alpha", || json!(60))]),
        Deed::Set(&[("/objects/0/material/alpha", || json!(30))]),
    ),
    (
        "04",
        "Try it",
        Deed::Set(&[
            ("/reflection_model", || json!("blinn_phong")),
            ("/objects/0/material/alpha", || json!(60)),
        ]),
        Deed::Set(&[("/reflection_model", || json!("blinn_phong"))]),
    ),
    (
        "05",
        "The inverse-square law",
        Deed::Set(&[("/lights/0/position", || json!([5, 5, 9]))]),
        Deed::Set(&[("/lights/0/intensity", || json!(0.5625))]),
    ),
    (
        "05",
        "Candela and lux",
        Deed::Set(&[("/lights/0/intensity", || json!(9))]),
        Deed::Set(&[("/lights/0/intensity", || json!(4.5))]),
    ),
    (
        "05",
        "By how much",
        Deed::Set(&[("/display", || json!({ "exposure": 2 }))]),
        Deed::Set(&[("/lights/0/intensity", || json!(9))]),
    ),
    ("06", "Find the code 128", Deed::Pin, Deed::Pin),
    (
        "06",
        "Leaving it out",
        Deed::Set(&[("/display", || json!({ "encoding": "off" }))]),
        Deed::Set(&[("/display", || json!({ "exposure": -2 }))]),
    ),
    (
        "06",
        "Do it right",
        Deed::Set(&[("/display", || json!({ "encoding": "srgb" }))]),
        Deed::Set(&[("/display", || json!({ "encoding": "off", "exposure": 2 }))]),
    ),
    ("07", "Schlick's approximation", Deed::Pin, Deed::Pin),
    (
        "07",
        "Two families",
        Deed::Set(&[("/objects/0/material/metallic", || json!(1))]),
        Deed::Set(&[("/objects/0/material/metallic", || json!(0.5))]),
    ),
    (
        "07",
        "Change the roughness",
        Deed::Set(&[("/objects/0/material/roughness", || json!(0.15))]),
        Deed::Set(&[("/objects/0/material/roughness", || json!(0.6))]),
    ),
    ("08", "Directional albedo", Deed::Pin, Deed::Pin),
    (
        "08",
        "Giving it back",
        Deed::Set(&[("/objects/3/material/multiple_scattering", || json!("kulla_conty"))]),
        Deed::Set(&[
            ("/objects/3/material/alpha_x", || json!(0.1)),
            ("/objects/3/material/alpha_y", || json!(0.1)),
        ]),
    ),
    (
        "08",
        "A model that gains",
        Deed::Set(&[("/objects/4/material/k_d", || json!(0.5)), ("/objects/4/material/k_s", || json!(0.4))]),
        Deed::Set(&[("/objects/4/material/k_d", || json!(0.5))]),
    ),
    (
        "09",
        "A larger lamp",
        Deed::Set(&[("/lights/0/width", || json!(5.2)), ("/lights/0/height", || json!(3.6))]),
        Deed::Set(&[("/lights/0/width", || json!(10.4))]),
    ),
    (
        "09",
        "Roughness blurs the image",
        Deed::Set(&[
            ("/objects/0/material/alpha_x", || json!(0.03)),
            ("/objects/0/material/alpha_y", || json!(0.03)),
        ]),
        Deed::Set(&[("/objects/0/material/alpha_x", || json!(0.03))]),
    ),
    (
        "10",
        "Turn the sky",
        Deed::Set(&[("/lights/0/rotation", || json!(-120))]),
        Deed::Set(&[("/lights/0/rotation", || json!(30))]),
    ),
    (
        "10",
        "Back to a clear sky",
        Deed::Set(&[("/lights/0/sky_type", || json!("12"))]),
        Deed::Set(&[("/lights/0/sky_type", || json!("11"))]),
    ),
    (
        "11",
        "Snell's law",
        Deed::Set(&[("/objects/0/material/refractive_index", || json!(1))]),
        Deed::Set(&[("/objects/0/material/refractive_index", || json!(1.2))]),
    ),
    ("11", "Read the angles", Deed::Pin, Deed::Pin),
    ("11", "Both faces reflect", Deed::Pin, Deed::Pin),
    (
        "11",
        "Total reflection",
        Deed::Set(&[("/objects/1/material/refractive_index", || json!(2.4))]),
        Deed::Set(&[("/objects/0/material/refractive_index", || json!(2.5))]),
    ),
    ("11", "Two lamps behind a ball", Deed::Pin, Deed::Pin),
    ("12", "Paper", Deed::Terms(TermSelection::Transmitted), Deed::Terms(TermSelection::Diffuse)),
    (
        "12",
        "A leaf",
        Deed::Set(&[("/objects/0/material/transmittance_colour", || json!([120, 190, 40]))]),
        Deed::Set(&[("/objects/0/material/base_colour", || json!([120, 190, 40]))]),
    ),
    (
        "12",
        "Frosted glass",
        Deed::Set(&[("/objects/1/material", || json!({ "roughness": 0.45 }))]),
        Deed::Set(&[("/objects/2/material", || json!({ "roughness": 0.45 }))]),
    ),
    ("12", "The invisible ball", Deed::Pin, Deed::Pin),
    (
        "12",
        "How to see glass",
        Deed::Set(&[("/lights/0/source", || json!("studio"))]),
        Deed::Set(&[("/lights/0/intensity", || json!(0.1))]),
    ),
    (
        "13",
        "Begin with one that works",
        Deed::Write(&[]),
        Deed::Set(&[("/reflection_model", || json!("phong"))]),
    ),
    ("13", "Its code", Deed::OpenCode, Deed::Terms(TermSelection::Diffuse)),
    (
        "13",
        "A new knob",
        Deed::Write(&[RIM]),
        Deed::Write(&[("\"polish\"", "\"rims\""), ("m.polish", "m.rims")]),
    ),
    ("13", "The rim", Deed::Write(&[RIM, ADDED]), Deed::Write(&[RIM])),
];

/// The parameter that the last lesson declares, and the line in which the model uses it.
const RIM: (&str, &str) = (
    "    ],\n}\n*/",
    "        { \"name\": \"rim\", \"min\": 0, \"max\": 1, \"default\": 0.5, \"help\": \"The light at the edge.\" },\n    ],\n}\n*/",
);
const ADDED: (&str, &str) = (
    "let diffuse = (1.0 - m.gloss) * m.base_colour * cos_l;",
    "let diffuse = ((1.0 - m.gloss) * m.base_colour + m.rim * power(1.0 - cos_v, 3.0)) * cos_l;",
);

#[test]
fn every_task_of_every_lesson_can_be_solved_and_a_mistake_does_not_solve_it() {
    let mut tasks = TASKS.iter();
    for lesson in LESSONS.iter() {
        let mut learner = Learner::new();
        for (i, step) in lesson.steps.iter().enumerate() {
            learner.enter(lesson, i);
            let Some(goal) = step.task.as_ref().and_then(|task| task.goal()) else { continue };
            let (id, title, solution, mistake) = tasks.next().expect("a solution for each task");
            assert!(lesson.id.starts_with(id) && step.title == *title, "{}: {}", lesson.id, step.title);
            let at = format!("{}, step {}: {}", lesson.id, i + 1, goal.until.text());
            assert!(!learner.holds(goal), "{at}: done before it begins");
            let terms = learner.window.terms;
            assert!(!learner.does(mistake, goal, false), "{at}: a mistake is taken for the solution");
            let why = learner.unmet(goal);
            assert!(why.is_some_and(|why| !why.contains("scene.") && why.len() > 10), "{at}: no reason");
            learner.enter(lesson, i);
            learner.window.terms = terms;
            assert!(learner.does(solution, goal, true), "{at}: the solution is not taken");
        }
    }
    assert_eq!(tasks.count(), 0, "solutions without a task");
}

#[test]
fn the_lessons_are_of_a_length_for_one_sitting() {
    // Each lesson states its duration, and none takes a whole lecture.
    for lesson in LESSONS.iter() {
        assert!(lesson.minutes.is_some_and(|minutes| (5..=20).contains(&minutes)), "{}", lesson.id);
        assert!(lesson.summary.ends_with('.') && (5..=9).contains(&lesson.steps.len()), "{}", lesson.id);
    }
    assert_eq!(LESSONS.len(), 13);
}
