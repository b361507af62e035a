//! The panels without a window: synthetic keys and clicks in, actions and effects out; what is on
//! screen is read from the accessibility tree, as a screen reader would.
//!
//! `scripts/pictures` writes pictures of the window in many states, drawn in software,
//! to be looked at.

use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    thread::sleep,
    time::Duration,
};

use bevy::ecs::world::World;
use bevy_egui::egui::{
    self, Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, TextureId, accesskit, epaint, pos2,
    vec2,
};
use lights_camera_models::{
    document::{Edit, Selection},
    optics::{Frame, TermSelection, Terms, colour::Encoding, fresnel, tone::ToneMapping},
    panel::{
        self, Dialogs, Panels,
        explain::lobes_are_due,
        state::{
            Action, Answer, Effect, MissingPart, ModelCommand, PictureArea, Question, Session, Severity,
            ThemeChoice, ViewChange,
        },
    },
    parameter::{
        BASE_COLOUR, EXTINCTION, IOR, METALLIC, Parameter, ParameterSet as _, REFLECTANCE, ROUGHNESS, Value,
        Values,
    },
    parameters,
    reflection::{
        self, EquationPart, Family, Measured, OpenPbr, Readout, ReadoutValue, ReflectionModel, Term, preset,
        usage,
    },
    registry::{Register, Registry},
    scene::{Display, Light, Object, Part, Scene, examples::looks, load::Stamp},
    shader::Source,
};

use crate::helpers::support::builtin;

// ── a model with everything that a panel can be asked for, and many more ──

const DISTRIBUTION: Parameter =
    Parameter::choice("distribution", &[("beckmann", "Beckmann"), ("ggx", "GGX (Trowbridge–Reitz)")], 1)
        .symbol("D")
        .help("How the normals of the microfacets are spread.");

const fn fraction(name: &'static str, label: &'static str) -> Parameter {
    Parameter::number(name, 0.0..=1.0, 0.0).symbol("").label(label).help("A fraction.")
}

parameters! {
    /// A model of many parameters, two of which are optical constants.
    pub struct Everything {
        /// See there.
        base_colour: colour = BASE_COLOUR,
        /// See there.
        ior: triple = IOR,
        /// See there.
        extinction: triple = EXTINCTION,
        /// See there.
        roughness: number = ROUGHNESS,
        /// See there.
        metallic: number = METALLIC,
        /// See there.
        reflectance: number = REFLECTANCE,
        /// See there.
        distribution: choice = DISTRIBUTION,
        /// See there.
        anisotropic: number = fraction("anisotropic", "anisotropic"),
        /// See there.
        subsurface: number = fraction("subsurface", "subsurface"),
        /// See there.
        specular_tint: number = fraction("specular_tint", "specular tint"),
        /// See there.
        sheen: number = fraction("sheen", "sheen"),
        /// See there.
        sheen_tint: number = fraction("sheen_tint", "sheen tint"),
        /// See there.
        clearcoat: number = fraction("clearcoat", "clearcoat"),
        /// See there.
        clearcoat_gloss: number = fraction("clearcoat_gloss", "gloss of the clearcoat"),
        /// See there.
        base_weight: number = fraction("base_weight", "weight of the base, which has a name that is far too long"),
    }
}

impl ReflectionModel for Everything {
    const DECLARATION: reflection::Declaration =
        reflection::Declaration::new("everything", "Everything", Source::new("everything.wgsl", ""))
            .family(Family::Microfacet)
            .published("K. E. Torrance, E. M. Sparrow 1967", "a test")
            .summary("A model of many parameters.")
            .equation(&[
                EquationPart::new(Term::Total, "I = I_d + I_s"),
                EquationPart::new(
                    Term::Diffuse,
                    "I_d = (1 − m) (1 − F) ρ/π N·L (1 + (F_{90} − 1)(1 − N·L)^5)",
                ),
                EquationPart::new(Term::Specular, "I_s = π D(H) G(L, V) F(V·H) / (4 (N·L) (N·V)) N·L"),
                EquationPart::new(
                    Term::Specular,
                    "D = α^2 / (π ((N·H)^2 (α^2 − 1) + 1)^2), α = r^2, Λ = (√(1 + α² tan² θ_h) − 1)/2",
                ),
                EquationPart::new(Term::Specular, "E(μ) = ∫ f_r ⟨N·L⟩ dω ≤ 1, α_{GGX} = √(2/(n + 2))"),
            ])
            .reciprocal()
            .energy_conserving()
            .non_negative()
            .ambient_by_albedo()
            .anisotropic();

    fn response(&self, _l: glam::Vec3, _v: glam::Vec3, _frame: &Frame) -> Terms {
        Terms::default()
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![
            Readout {
                symbol: "F_0",
                label: "reflectance at normal incidence",
                help: "What is reflected when the surface is seen straight on.",
                value: ReadoutValue::Reflectance(fresnel::conductor_rgb(self.ior, self.extinction, 1.0)),
            },
            Readout {
                symbol: "α_GGX",
                label: "width",
                help: "The square of the roughness.",
                value: ReadoutValue::Number(self.roughness * self.roughness),
            },
        ]
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        preset::conductor(material)
    }
}

/// The built-in models and one with every kind of parameter.
fn crowd() -> Registry {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Everything>();
    registry
}

/// A window that exists only in memory.
pub struct Bench {
    pub ctx: egui::Context,
    pub session: Session,
    pub area: PictureArea,
    pub registry: Registry,
    pub panels: Panels,
    pub dialogs: Dialogs,
    /// The world that panels read, and that their commands change.
    pub world: World,
    pub size: egui::Vec2,
    time: f64,
    pub tree: Vec<Seen>,
    pub effects: Vec<Effect>,
    /// The text last put on the clipboard.
    pub copied: Option<String>,
    shapes: Vec<egui::Shape>,
    /// What may be seen of each of them.
    clips: Vec<Rect>,
    painter: Painter,
}

/// A widget as seen by a screen reader.
#[derive(Clone, Debug)]
pub struct Seen {
    pub role: accesskit::Role,
    pub label: String,
    pub disabled: bool,
    pub rect: Rect,
}

impl Bench {
    pub fn new(session: Session) -> Self {
        Self::with_registry(session, builtin())
    }

    /// A window with a sphere and the model [`Everything`], among many models.
    pub fn with_everything() -> Self {
        let scene = Scene { reflection_model: "everything".to_owned(), ..Scene::default() };
        Self::with_registry(Session::new(scene), crowd())
    }

    pub fn with_registry(session: Session, registry: Registry) -> Self {
        let ctx = egui::Context::default();
        ctx.enable_accesskit();
        let mut bench = Self {
            ctx,
            session,
            area: PictureArea::default(),
            registry,
            panels: Panels::builtin(),
            dialogs: Dialogs::default(),
            world: World::new(),
            size: vec2(1280.0, 1600.0),
            time: 0.0,
            tree: Vec::new(),
            effects: Vec::new(),
            copied: None,
            shapes: Vec::new(),
            clips: Vec::new(),
            painter: Painter::default(),
        };
        bench.settle();
        bench
    }

    pub fn with_model(model: &str) -> Self {
        Self::new(Session::new(Scene { reflection_model: model.to_owned(), ..Scene::default() }))
    }

    /// Runs one frame with the given events.
    pub fn frame(&mut self, events: Vec<Event>) {
        self.time += 1.0 / 30.0;
        let input = RawInput {
            // As in bevy_egui: a window of this many points has this many pixels.
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, self.size / self.ctx.zoom_factor())),
            time: Some(self.time),
            focused: true,
            events,
            ..RawInput::default()
        };
        let mut effects = Vec::new();
        let (session, area, registry) = (&mut self.session, &mut self.area, &self.registry);
        let (panels, dialogs, world) = (&mut self.panels, &mut self.dialogs, &self.world);
        let mut output = self.ctx.run_ui(input, |ui| {
            effects.extend(panel::show(ui, &mut *session, area, registry, panels, dialogs, world));
        });
        // As the camera of the window does.
        self.session.facts.aspect = self.area.aspect();
        self.panels.take_queued().into_iter().for_each(|command| command(&mut self.world));
        self.effects.extend(effects);
        if let Some(update) = output.platform_output.accesskit_update.take() {
            self.tree = update
                .nodes
                .iter()
                .filter_map(|(_, node)| {
                    let bounds = node.bounds()?;
                    let rect = Rect::from_min_max(
                        pos2(bounds.x0 as f32, bounds.y0 as f32),
                        pos2(bounds.x1 as f32, bounds.y1 as f32),
                    );
                    let label = node.label().or(node.value()).unwrap_or_default().to_owned();
                    Some(Seen { role: node.role(), label, disabled: node.is_disabled(), rect })
                })
                .collect();
        }
        for command in &output.platform_output.commands {
            if let egui::OutputCommand::CopyText(text) = command {
                self.copied = Some(text.clone());
            }
        }
        self.painter.take(&mut output.textures_delta);
        (self.shapes, self.clips) =
            output.shapes.into_iter().map(|shown| (shown.shape, shown.clip_rect)).unzip();
    }

    /// What the last frame painted, as triangles: only pictures need them.
    fn triangles(&self) -> Vec<epaint::ClippedPrimitive> {
        let shown = self.shapes.iter().zip(&self.clips);
        let shown =
            shown.map(|(shape, clip)| epaint::ClippedShape { clip_rect: *clip, shape: shape.clone() });
        self.ctx.tessellate(shown.collect(), self.ctx.pixels_per_point())
    }

    pub fn settle(&mut self) {
        for _ in 0..6 {
            self.frame(Vec::new());
        }
    }

    /// The first widget with this label.
    pub fn find(&self, label: &str) -> Option<&Seen> {
        self.tree.iter().find(|s| s.label == label)
    }

    pub fn field(&self, label: &str) -> Seen {
        let text = |s: &&Seen| matches!(s.role, accesskit::Role::TextInput);
        let Some(seen) = self.tree.iter().filter(text).find(|s| s.label == label) else {
            panic!(
                "no field “{label}” among {:?}",
                self.tree.iter().filter(text).map(|s| &s.label).collect::<Vec<_>>()
            )
        };
        seen.clone()
    }

    pub fn click_at(&mut self, at: Pos2, button: PointerButton) {
        let press = |pressed| Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE };
        self.frame(vec![Event::PointerMoved(at)]);
        self.frame(vec![press(true)]);
        self.frame(vec![press(false)]);
        self.settle();
    }

    pub fn click(&mut self, label: &str) {
        let Some(seen) = self.find(label) else {
            panic!(
                "nothing is called “{label}”; there are {:?}",
                self.tree.iter().map(|s| &s.label).collect::<Vec<_>>()
            )
        };
        let at = seen.rect.center();
        self.click_at(at, PointerButton::Primary);
    }

    pub fn key(&mut self, key: Key, modifiers: Modifiers) {
        let event = |pressed| Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
        self.frame(vec![Event::ModifiersChanged(modifiers), event(true)]);
        self.frame(vec![event(false), Event::ModifiersChanged(Modifiers::NONE)]);
        self.settle();
    }

    /// Presses a letter as a keyboard does: a key and a text.
    pub fn letter(&mut self, key: Key, text: &str) {
        let modifiers = Modifiers::NONE;
        let event = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
        self.frame(vec![event, Event::Text(text.to_owned())]);
        self.settle();
    }

    /// Rests the pointer somewhere until the tooltip appears.
    pub fn hover(&mut self, at: Pos2) {
        self.frame(vec![Event::PointerMoved(at)]);
        (0..30).for_each(|_| self.frame(Vec::new()));
    }

    pub fn type_into(&mut self, label: &str, text: &str) {
        let at = self.field(label).rect.center();
        self.click_at(at, PointerButton::Primary);
        self.key(Key::A, Modifiers::COMMAND | Modifiers::CTRL);
        if text.is_empty() {
            self.key(Key::Backspace, Modifiers::NONE);
        } else {
            self.frame(vec![Event::Text(text.to_owned())]);
        }
        self.settle();
    }

    pub fn apply(&mut self, action: Action) {
        let effects = self.session.apply(action, &self.registry);
        self.effects.extend(effects);
        self.settle();
    }

    pub fn says(&self, words: &str) -> bool {
        self.tree.iter().any(|s| s.label.contains(words))
    }

    /// The shapes painted by the last frame.
    pub fn shapes(&mut self) -> Vec<egui::Shape> {
        self.frame(Vec::new());
        fn flat(shape: egui::Shape, all: &mut Vec<egui::Shape>) {
            match shape {
                egui::Shape::Vec(shapes) => shapes.into_iter().for_each(|s| flat(s, all)),
                shape => all.push(shape),
            }
        }
        let mut all = Vec::new();
        std::mem::take(&mut self.shapes).into_iter().for_each(|s| flat(s, &mut all));
        all
    }

    /// The texts painted by the last frame.
    pub fn texts(&mut self) -> Vec<String> {
        self.texts_within(Rect::EVERYTHING)
    }

    /// The texts of the last frame that are in sight, each with the place that it takes up.
    pub fn texts_in_sight(&mut self) -> Vec<(String, Rect)> {
        self.frame(Vec::new());
        let in_sight = |(shape, clip): (&egui::Shape, &Rect)| match shape {
            egui::Shape::Text(text) if clip.intersects(text.visual_bounding_rect()) => {
                Some((text.galley.text().to_owned(), text.visual_bounding_rect()))
            }
            _ => None,
        };
        self.shapes.iter().zip(&self.clips).filter_map(in_sight).collect()
    }

    /// The texts of the last frame, without another one.
    pub fn texts_just_painted(&self) -> Vec<String> {
        let text = |shape: &egui::Shape| match shape {
            egui::Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        };
        self.shapes.iter().filter_map(text).collect()
    }

    /// The texts over the picture.
    pub fn words(&mut self) -> Vec<String> {
        self.texts_within(self.area.rect)
    }

    fn texts_within(&mut self, rect: Rect) -> Vec<String> {
        let text = |shape| match shape {
            egui::Shape::Text(text) if rect.contains(text.pos) => Some(text.galley.job.text.clone()),
            _ => None,
        };
        self.shapes().into_iter().filter_map(text).collect()
    }

    /// Waits until lobes are finished.
    pub fn wait_for_lobes(&mut self) {
        for _ in 0..6000 {
            self.settle();
            if !lobes_are_due(&self.ctx) {
                return;
            }
            sleep(Duration::from_millis(10));
        }
        panic!("the lobe is never finished");
    }

    /// Renders the window in software and writes it to a file, with this colour instead of the picture.
    pub fn picture(&mut self, file: &Path, ground: egui::Color32) -> Result<(), Box<dyn std::error::Error>> {
        // Tooltips wait for the pointer to rest.
        for _ in 0..31 {
            self.frame(Vec::new());
        }
        let mut primitives = self.triangles();
        let zoom = self.ctx.zoom_factor();
        for primitive in &mut primitives {
            primitive.clip_rect = primitive.clip_rect * zoom;
            if let epaint::Primitive::Mesh(mesh) = &mut primitive.primitive {
                mesh.vertices.iter_mut().for_each(|v| v.pos *= zoom);
            }
        }
        let size = (self.size.x as usize, self.size.y as usize);
        let picture = self.painter.draw(&primitives, size, ground);
        let file = std::fs::File::create(file)?;
        let mut encoder = png::Encoder::new(file, size.0 as u32, size.1 as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&picture)?;
        Ok(())
    }
}

// ── knobs ──

#[test]
fn every_parameter_of_every_model_has_a_knob() {
    for model in Registry::builtin().models() {
        let bench = Bench::with_model(model.declaration.id);
        for p in model.parameters {
            let knobs: Vec<_> = bench.tree.iter().filter(|s| s.label.contains(p.label)).collect();
            assert!(!knobs.is_empty(), "{}: no knob for {}", model.declaration.id, p.name);
            let unused = usage::unused(model.parameters, p, &Values::default()).is_some();
            assert!(knobs.iter().any(|k| k.disabled) == unused, "{}: {}", model.declaration.id, p.name);
        }
    }
}

#[test]
fn parameters_that_the_model_does_not_use_are_disabled_and_kept() {
    let mut scene = Scene::default();
    scene.objects[0].material.set("alpha", Value::Integer(64));
    let mut bench = Bench::new(Session::new(scene));
    assert!(bench.field("shininess").disabled);
    assert!(bench.says("Not used by Lambert"));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
    assert!(!bench.field("shininess").disabled);
    assert_eq!(bench.session.document.objects[0].material.0.get("alpha"), Some(&Value::Integer(64)));
}

#[test]
fn typing_a_legal_value_changes_the_scene_at_once() {
    let mut bench = Bench::with_model("phong");
    bench.type_into("diffuse coefficient", "0,65");
    assert_eq!(bench.session.document.objects[0].material.0.get("k_d"), Some(&Value::Number(0.65)));
    assert!(bench.session.is_dirty());
    bench.key(Key::Escape, Modifiers::NONE);
    assert_eq!(
        bench.session.document.objects[0].material.0.get("k_d"),
        Some(&Value::Number(0.8)),
        "Escape goes back"
    );
}

#[test]
fn typing_an_illegal_value_shows_the_rule_and_leaves_the_scene_alone() {
    for text in ["0.2", "7", "abc", ""] {
        let mut bench = Bench::with_model("phong");
        let before = bench.session.document.scene().clone();
        bench.type_into("diffuse coefficient", text);
        assert_eq!(*bench.session.document, before, "{text:?}");
        assert!(bench.says("between 0.5 and 1"), "{text:?}: the rule is not shown");
        assert!(bench.says("the picture keeps 0.8"), "{text:?}");
    }
}

#[test]
fn positions_stay_in_the_room() {
    let mut bench = Bench::new(Session::default());
    let before = bench.session.document.scene().clone();
    bench.type_into("position x", "11");
    assert_eq!(*bench.session.document, before);
    assert!(bench.says("greater than 0 and at most 10"));
    bench.type_into("position x", "3.5");
    assert_eq!(bench.session.document.objects[0].position.x, 3.5);
}

#[test]
fn arrow_keys_turn_the_value_of_a_field() {
    let mut bench = Bench::with_model("phong");
    let at = bench.field("shininess").rect.center();
    bench.click_at(at, PointerButton::Primary);
    bench.key(Key::ArrowUp, Modifiers::NONE);
    assert_eq!(bench.session.document.objects[0].material.0.get("alpha"), Some(&Value::Integer(33)));
}

#[test]
fn sliders_are_dragged_and_a_double_click_sets_the_default() {
    let mut bench = Bench::with_model("phong");
    let slider = |b: &Bench| {
        b.tree
            .iter()
            .find(|s| s.role == accesskit::Role::Slider && s.label == "specular coefficient")
            .cloned()
    };
    let Some(seen) = slider(&bench) else { panic!("no slider") };
    let at = pos2(seen.rect.left() + 0.9 * seen.rect.width(), seen.rect.center().y);
    bench.click_at(at, PointerButton::Primary);
    let value = |b: &Bench| match b.session.document.objects[0].material.0.get("k_s") {
        Some(Value::Number(v)) => *v,
        other => panic!("{other:?}"),
    };
    assert!(value(&bench) > 0.85, "{}", value(&bench));
    let press = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    // Long enough that the previous click does not count.
    (0..6).for_each(|_| bench.settle());
    for _ in 0..2 {
        bench.frame(vec![press(true)]);
        bench.frame(vec![press(false)]);
    }
    bench.settle();
    assert_eq!(value(&bench), 0.5);
}

#[test]
fn a_complaint_moves_nothing() {
    let mut bench = Bench::with_model("phong");
    let place = |b: &Bench| b.field("shininess").rect;
    let before = place(&bench);
    bench.type_into("diffuse coefficient", "0.2");
    assert!(bench.says("between 0.5 and 1"));
    assert_eq!(place(&bench), before);
    // Elsewhere it is no longer in the way.
    let at = bench.field("shininess").rect.center();
    bench.click_at(at, PointerButton::Primary);
    assert!(!bench.says("between 0.5 and 1"));
}

#[test]
fn a_slider_that_ends_before_the_range_does_says_that_more_can_be_typed() {
    let mut bench = Bench::with_model("phong");
    let Some(slider) =
        bench.tree.iter().find(|s| s.role == accesskit::Role::Slider && s.label == "shininess").cloned()
    else {
        panic!("no slider")
    };
    bench.hover(slider.rect.center());
    assert!(bench.says("Larger values can be typed"));
}

#[test]
fn three_numbers_are_typed_one_by_one_or_at_once() {
    let mut bench = Bench::with_everything();
    let value = |b: &Bench| b.session.document.objects[0].material.get(&IOR);
    bench.type_into("refractive index: all three", "1.33");
    assert_eq!(value(&bench), Value::Triple([1.33; 3]));
    bench.type_into("refractive index G", "2");
    assert_eq!(value(&bench), Value::Triple([1.33, 2.0, 1.33]));
    // The end of the range is legal, values beyond it are not.
    bench.type_into("refractive index B", "0.01");
    assert_eq!(value(&bench), Value::Triple([1.33, 2.0, 0.01]));
    for field in ["refractive index B", "refractive index: all three"] {
        bench.key(Key::Enter, Modifiers::NONE);
        bench.type_into(field, "7");
        assert_eq!(value(&bench), Value::Triple([1.33, 2.0, 0.01]));
        assert!(bench.says("between 0.01 and 6"), "{field}");
    }
}

#[test]
fn a_measured_material_sets_what_was_measured_in_one_edit() {
    let mut bench = Bench::with_everything();
    assert!(bench.says("measured material: none"));
    bench.click("measured material: none");
    assert!(bench.says("Metals and semiconductors"));
    bench.frame(vec![Event::Text("johnson gold".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    let material = bench.session.document.objects[0].material.clone();
    let gold = preset::by_id("gold").unwrap();
    assert_eq!(material.get(&IOR), Value::Triple(gold.n));
    assert_eq!(material.get(&EXTINCTION), Value::Triple(gold.k));
    assert!(bench.says("measured material: Gold"));
    assert!(bench.says("reflectance at normal incidence: 0.942"), "the read-out follows");
    // With values other than the measured ones, it is no longer that material.
    bench.type_into("extinction coefficient R", "3");
    assert!(bench.says("measured material: none"));
    // No illegal value gets in this way, not even in part.
    let before = bench.session.document.scene().clone();
    let bad = vec![("ior", Value::Triple([2.0; 3])), ("extinction", Value::Triple([99.0; 3]))];
    bench.apply(Action::Edit(Edit::materials(Part::Object(0), bad, "Measured material")));
    assert_eq!(*bench.session.document, before);
    // A model that cannot represent measured materials has no such control.
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
    assert!(!bench.says("measured material"));
    assert!(bench.says("equivalent roughness: 0.352"));
}

#[test]
fn a_material_of_artists_sets_every_parameter_of_its_model_in_one_edit() {
    let mut bench = Bench::with_model("openpbr");
    bench.click("material preset: none");
    assert!(bench.says("For artists") && bench.says("Metals and semiconductors"));
    bench.frame(vec![Event::Text("velvet".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.says("material preset: Velvet"));
    let velvet = looks().iter().find(|look| look.name == "Velvet").expect("shipped");
    let has = |bench: &Bench, want: bool| {
        let material = &bench.session.document.objects[0].material;
        let all = OpenPbr::PARAMETERS.iter().all(|p| material.get(p) == velvet.material.get(p));
        assert_eq!(all, want);
    };
    has(&bench, true);
    bench.type_into("metallic", "0.5");
    assert!(bench.says("material preset: none"));
    has(&bench, false);
    for _ in 0..2 {
        bench.apply(Action::Undo);
    }
    assert!(bench.session.document.objects[0].material.0.is_empty(), "one step");
}

#[test]
fn the_tooltip_of_a_measured_material_names_its_numbers_and_who_measured_them() {
    let mut bench = Bench::with_everything();
    bench.click("measured material: none");
    let Some(row) = bench.find("Aluminium").map(|s| s.rect.center()) else { panic!("not listed") };
    bench.hover(row);
    for words in ["630 nm", "7.508", "0.907", "A. D. Rakić (1995)"] {
        assert!(bench.says(words), "{words}");
    }
}

#[test]
fn presets_of_every_model_are_legal_and_recognised() {
    for model in crowd().models() {
        for m in preset::all() {
            for (name, value) in (model.preset)(m) {
                let Some(p) = model.parameter(name) else {
                    panic!("{}: no parameter {name}", model.declaration.id)
                };
                assert!(p.allows(&value), "{}: {} sets {name} to {value}", model.declaration.id, m.name);
            }
        }
    }
}

#[test]
fn what_the_top_shows_is_what_the_selected_object_has() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::AddObject("cube".to_owned()));
    bench.apply(Action::Edit(Edit::set(Part::Object(1), Object::reflection_model, "phong")));
    assert!(bench.says("Reflection model: Phong") && bench.says("“Cube 1” overrides reflection"));
    bench.key(Key::R, Modifiers::NONE);
    bench.frame(vec![Event::Text("1977".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.objects[1].reflection_model.as_deref(), Some("blinn_phong"));
    assert_eq!(bench.session.document.reflection_model, "lambert", "the scene keeps its own");
    bench.key(Key::F, Modifiers::NONE);
    assert_eq!(bench.session.document.shading_model, "flat", "the shading of the cube is that of the scene");
    bench.apply(Action::Select(Selection::Object(0)));
    assert!(bench.says("Reflection model: Lambert") && !bench.says("overrides reflection"));
}

#[test]
fn panels_have_the_widths_of_before_when_everything_is_as_large_as_before() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    let before = bench.area.rect;
    bench.apply(Action::View(ViewChange::Scale(200)));
    assert_ne!(bench.area.rect, before);
    bench.apply(Action::View(ViewChange::Scale(100)));
    assert_eq!(bench.area.rect, before);
}

#[test]
fn a_click_that_closes_a_menu_does_nothing_else() {
    let mut bench = Bench::new(Session::default());
    assert!(!bench.area.popup_open);
    bench.click("Edit");
    assert!(bench.area.popup_open, "the picture is told so");
    let at = bench.area.rect.center();
    bench.click_at(at, PointerButton::Primary);
    assert!(!bench.area.popup_open && !bench.says("New reflection model…"));
    bench.apply(Action::View(ViewChange::Chooser(true)));
    assert!(bench.area.popup_open);
}

#[test]
fn a_name_that_is_taken_comes_with_a_button_for_one_that_is_free() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Model(ModelCommand::New));
    for (typed, said, free) in [
        ("Lambert", "There is already a model “lambert”; “lambert_2” is free.", "lambert_2"),
        ("Größe 2", "for example “groesse_2”", "groesse_2"),
    ] {
        bench.apply(Action::Model(ModelCommand::Type(typed.to_owned())));
        assert!(bench.says(said), "{typed}");
        bench.click(&format!("Use “{free}”"));
        assert_eq!(bench.session.authoring.draft.as_ref().map(|draft| draft.name.as_str()), Some(free));
        assert!(bench.says(&format!("Identifier (also the file name): {free}")));
    }
}

// ── the document ──

#[test]
fn a_change_shows_the_mark_of_unsaved_changes_and_saving_removes_it() {
    let mut bench = Bench::new(Session::default());
    assert!(bench.says("has no unsaved changes"));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
    assert!(bench.says("has unsaved changes"));
    let path = PathBuf::from("a.json");
    let effects = bench.session.saved(path.clone(), &bench.registry);
    assert_eq!(effects, [Effect::SaveSettings]);
    bench.settle();
    assert!(bench.says("has no unsaved changes"));
    let path = std::path::absolute(path).expect("there is a current folder");
    assert_eq!(bench.session.settings.recent_files, [path], "the next start may be in another folder");
}

#[test]
fn nothing_is_lost_without_a_question() {
    for action in [Action::New, Action::Quit, Action::Open(PathBuf::from("b.json"))] {
        let mut bench = Bench::new(Session::default());
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
        bench.effects.clear();
        bench.apply(action.clone());
        assert!(bench.effects.is_empty(), "{action:?}");
        assert!(bench.says("Save the changes?"), "{action:?}");
        bench.key(Key::Escape, Modifiers::NONE);
        assert_eq!(bench.session.questions.open, None);
        assert_eq!(bench.session.document.shading_model, "flat", "cancelling keeps everything");
        assert!(bench.effects.is_empty(), "{action:?}");
    }
}

#[test]
fn saving_first_carries_on_with_what_was_asked_for() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
    bench.session.path = Some(PathBuf::from("a.json"));
    bench.apply(Action::Quit);
    bench.effects.clear();
    bench.click("Save");
    assert_eq!(bench.effects, [Effect::SaveFile { path: PathBuf::from("a.json"), overwrite: false }]);
    let effects = bench.session.saved(PathBuf::from("a.json"), &bench.registry);
    assert!(effects.contains(&Effect::Quit));
}

#[test]
fn missing_parts_are_named_and_defaults_used_on_yes_only() {
    let ask = |bench: &mut Bench| {
        let scene = Box::new(Scene { shading_model: "phong".to_owned(), ..Scene::default() });
        let parts =
            vec![MissingPart { name: "the scene size".to_owned(), default: "10 × 10 × 10 m".to_owned() }];
        bench.session.questions.ask(Question::MissingParts { path: PathBuf::from("c.json"), scene, parts });
        bench.settle();
    };
    let mut bench = Bench::new(Session::default());
    ask(&mut bench);
    assert!(bench.says("the scene size") && bench.says("10 × 10 × 10 m"));
    bench.click("Do not open");
    assert_eq!(bench.session.document.shading_model, "gouraud");
    assert!(bench.session.messages.iter().any(|m| m.text.contains("the scene size")));
    ask(&mut bench);
    bench.click("Use the defaults");
    assert_eq!(bench.session.document.shading_model, "phong");
    assert_eq!(bench.session.path, Some(PathBuf::from("c.json")));
}

#[test]
fn a_file_that_changed_beside_unsaved_changes_is_a_question_of_three_answers() {
    let ask = || {
        let mut bench = Bench::new(Session::default());
        bench.session.path = Some(PathBuf::from("room.json"));
        bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
        let scene = Box::new(Scene { shading_model: "phong".to_owned(), ..Scene::default() });
        let version = Stamp::of(b"another content");
        bench.session.questions.ask(Question::NewerOnDisk {
            path: PathBuf::from("room.json"),
            scene,
            version,
        });
        bench.settle();
        bench.effects.clear();
        assert!(bench.says("room.json was changed by another program"));
        (bench, version)
    };
    let keep = |version| [Effect::ExpectFile { path: PathBuf::from("room.json"), version }];
    let (mut bench, version) = ask();
    bench.click("Keep mine");
    assert_eq!(bench.effects, keep(version));
    // The first answer, which loses nothing, has the keyboard focus.
    let (mut bench, version) = ask();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.effects, keep(version));
    let (mut bench, _) = ask();
    bench.click("Reload from disk");
    assert_eq!(bench.effects, [Effect::CheckFile { discard: true }]);
    // To leave the question is to decide later, and the picture says that there is something to decide.
    let (mut bench, _) = ask();
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(bench.effects.is_empty() && bench.session.questions.open.is_none());
    assert_eq!(bench.session.document.shading_model, "flat");
    assert!(bench.session.disk.badge.as_ref().is_some_and(|b| b.text.contains("room.json changed on disk")));
}

#[test]
fn messages_stay_until_dismissed() {
    let mut bench = Bench::new(Session::default());
    bench.session.say(Severity::Error, "room.json:14:20: k_d is 0.2");
    bench.settle();
    assert!(bench.session.view.bottom_open, "an error unfolds the strip");
    assert!(bench.says("room.json:14:20"));
    bench.click("Dismiss the message");
    assert!(bench.session.messages.is_empty());
}

// ── lights and objects ──

#[test]
fn every_registered_kind_can_be_added() {
    let mut bench = Bench::new(Session::default());
    let registry = Registry::builtin();
    for light in registry.lights() {
        bench.apply(Action::AddLight(light.declaration.id.to_owned()));
        let Some(added) = bench.session.document.lights.last() else { panic!("none") };
        assert_eq!(added.light_type, light.declaration.id);
        assert_eq!(added.position.is_some(), light.declaration.has_position);
        assert_eq!(added.direction.is_some(), light.declaration.has_direction);
        assert!(added.position.is_none_or(|p| bench.session.document.scene_size.contains(p)));
    }
    for shape in registry.shapes() {
        bench.apply(Action::AddObject(shape.declaration.id.to_owned()));
        assert_eq!(
            bench.session.document.objects.last().map(|o| o.object_type.as_str()),
            Some(shape.declaration.id)
        );
    }
    let mut places: Vec<_> =
        bench.session.document.objects.iter().map(|o| o.position.to_array().map(f32::to_bits)).collect();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), bench.session.document.objects.len(), "each stands in a place of its own");
}

#[test]
fn the_last_light_and_the_last_object_stay_and_say_why() {
    let mut bench = Bench::new(Session::default());
    for (part, words) in [
        (Selection::Light(0), "last light"),
        (Selection::Object(0), "last object"),
        (Selection::Observer, "exactly one"),
    ] {
        bench.apply(Action::Remove(part));
        assert!(bench.session.messages.iter().any(|m| m.text.contains(words)));
    }
    assert_eq!((bench.session.document.lights.len(), bench.session.document.objects.len()), (1, 1));
}

#[test]
fn removing_and_duplicating_keep_the_selection_on_something_that_exists() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Duplicate(Selection::Object(0)));
    assert_eq!(bench.session.selection, Selection::Object(1));
    bench.apply(Action::Remove(Selection::Object(1)));
    assert_eq!(bench.session.selection, Selection::Object(0));
    bench.apply(Action::Duplicate(Selection::Light(0)));
    bench.apply(Action::Remove(Selection::Light(0)));
    assert_eq!(bench.session.selection, Selection::Light(0));
}

#[test]
fn illegal_edits_are_refused_with_the_reason() {
    let mut bench = Bench::new(Session::default());
    let before = bench.session.document.scene().clone();
    let observer = bench.session.document.observer.position;
    for edit in [
        Edit::set(Part::Scene, Scene::reflection_model, "nonsense"),
        Edit::set(Part::Light(0), Light::position, observer),
        Edit::set(Part::Light(0), Light::intensity, -1.0),
        Edit::set(Part::Light(0), Light::luminous_flux, -1.0),
        Edit::set(Part::Light(0), Light::colour_temperature, 999.0),
        Edit::from(Display { exposure: 17.0, ..Display::default() }),
        Edit::set(Part::Object(0), Object::position, glam::Vec3::splat(20.0)),
        Edit::material(Part::Object(0), "k_d", Value::Number(0.1)),
        Edit::parameter(Part::Object(0), "tube_radius", Value::Number(0.1)),
        Edit::set(Part::Object(7), Object::size, 1.0),
    ] {
        let messages = bench.session.messages.len();
        bench.apply(Action::Edit(edit.clone()));
        assert_eq!(*bench.session.document, before, "{edit:?}");
        assert_eq!(bench.session.messages.len(), messages + 1, "{edit:?}");
    }
}

#[test]
fn another_type_of_light_has_what_the_type_needs() {
    let mut bench = Bench::new(Session::default());
    for light in Registry::builtin().lights() {
        bench.apply(Action::Edit(Edit::set(
            Part::Light(0),
            Light::light_type,
            light.declaration.id.to_owned(),
        )));
        let now = &bench.session.document.lights[0];
        assert_eq!(now.position.is_some(), light.declaration.has_position);
        assert_eq!(now.direction.is_some(), light.declaration.has_direction);
        assert_eq!(now.intensity, light.declaration.default_intensity);
    }
}

#[test]
fn a_parameter_of_a_shape_has_its_knob_its_step_and_its_place_in_the_file() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Object(0)));
    let object = |b: &Bench| b.session.document.objects[0].clone();
    let tube = |b: &Bench| object(b).shape.0.get("tube_radius").cloned();
    assert!(!bench.says("tube radius"), "a sphere has none");
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::object_type, "torus")));
    assert_eq!(tube(&bench), None, "the default is not written down");
    bench.type_into("tube radius", "0.2");
    assert_eq!(tube(&bench), Some(Value::Number(0.2)));
    assert_eq!(bench.session.document.steps().last(), Some("Tube radius of Torus 1"));
    let text = crate::helpers::support::written(&bench.session.document);
    assert!(text.contains("\"tube_radius\": 0.2"), "{text}");
    assert_eq!(crate::helpers::support::read(&text), *bench.session.document);
    // What is illegal is refused.
    bench.apply(Action::Edit(Edit::parameter(Part::Object(0), "tube_radius", Value::Number(0.5))));
    assert_eq!(tube(&bench), Some(Value::Number(0.2)));
    assert!(bench.says("tube radius is 0.5, but must be between 0.02 and 0.24."));
    bench.apply(Action::Undo);
    assert_eq!(tube(&bench), None);
    bench.apply(Action::Redo);
    // As with lights, another type keeps only its own parameters.
    bench.apply(Action::Edit(Edit::set(Part::Object(0), Object::object_type, "superellipsoid")));
    assert_eq!(tube(&bench), None);
    for label in ["vertical exponent", "horizontal exponent"] {
        bench.type_into(label, "1.25");
    }
    let exponents = |b: &Bench| object(b).shape.0.values().cloned().collect::<Vec<_>>();
    assert_eq!(exponents(&bench), [Value::Number(1.25), Value::Number(1.25)]);
    for _ in 0..3 {
        bench.apply(Action::Undo);
    }
    assert_eq!(tube(&bench), Some(Value::Number(0.2)), "undoing brings it back");
}

#[test]
fn brightness_is_read_and_typed_in_candela_or_lumen() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Light(0)));
    assert!(bench.says("= 251.3 lm"), "20 cd are 80π lm");
    bench.click("unit: candela");
    bench.click("lm  lumen");
    let light = |b: &Bench| b.session.document.lights[0].clone();
    assert_eq!(light(&bench).luminous_flux, Some(251.327));
    bench.type_into("luminous flux", "800");
    assert_eq!(light(&bench).luminous_flux, Some(800.0));
    assert!(bench.says("= 63.66 cd"));
    // The number is saved as it was typed, and reading it gives the same light.
    let text = crate::helpers::support::written(&bench.session.document);
    assert!(text.contains("\"luminous_flux\": 800") && !text.contains("intensity"), "{text}");
    assert_eq!(crate::helpers::support::read(&text), *bench.session.document);
    bench.click("unit: lumen");
    bench.click("cd  candela");
    assert_eq!((light(&bench).luminous_flux, light(&bench).intensity), (None, 63.662));
    // Lights without a flux offer no choice.
    bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::light_type, "directional")));
    assert!(!bench.says("unit: ") && !bench.says(" lm"));
    let refused = bench.session.messages.len() + 1;
    bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::luminous_flux, 800.0)));
    assert_eq!(bench.session.messages.len(), refused);
}

#[test]
fn a_lamp_with_extent_is_as_bright_as_its_luminance_or_lumen_say_and_its_unit_has_room() {
    for scale in [100, 150] {
        let mut bench = Bench::new(Session::default());
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::light_type, "disc")));
        bench.apply(Action::Edit(Edit::set(Part::Light(0), Light::intensity, 100.0)));
        bench.apply(Action::Select(Selection::Light(0)));
        bench.settle();
        // π times the area of a disc with the radius 0.5 m.
        assert!(bench.says("= 246.7 lm"), "{scale}");
        let unit = bench.find("unit: candela per square metre").expect("it has one").rect;
        assert!(
            unit.left() >= bench.field("intensity").rect.right() && unit.width() > 25.0,
            "{scale}: {unit}"
        );
        let sign = bench
            .texts_in_sight()
            .into_iter()
            .find(|(text, place)| text == "cd/m²" && unit.intersects(*place));
        let sign = sign.expect("the sign").1;
        assert!(unit.shrink2(vec2(0.5, 0.0)).x_range().contains(sign.right()), "{scale}: {sign} in {unit}");
        let before = bench.field("intensity").rect;
        bench.click("unit: candela per square metre");
        bench.click("lm  lumen");
        let after = bench.field("luminous flux").rect;
        assert!((after.min - before.min).length() < 0.5, "{scale}: from {before} to {after}");
        assert_eq!(bench.session.document.lights[0].luminous_flux, Some(246.74));
        assert!(bench.says(" cd/m²"), "{scale}");
    }
}

#[test]
fn a_lamp_keeps_its_lumen_while_it_is_point_or_spot() {
    let mut bench = Bench::new(Session::default());
    let mut now = |edit: Edit| {
        bench.apply(Action::Edit(edit));
        let light = bench.session.document.lights[0].clone();
        (light.luminous_flux, light.intensity)
    };
    assert_eq!(now(Edit::set(Part::Light(0), Light::luminous_flux, 800.0)), (Some(800.0), 20.0));
    assert_eq!(now(Edit::set(Part::Light(0), Light::light_type, "spot")), (Some(800.0), 20.0));
    assert_eq!(now(Edit::set(Part::Light(0), Light::light_type, "ambient")), (None, 1.0));
    assert_eq!(now(Edit::set(Part::Light(0), Light::light_type, "point")), (None, 20.0));
}

#[test]
fn a_light_is_coloured_by_temperature_and_back() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Light(0)));
    bench.click("Colour by: temperature");
    let light = |b: &Bench| b.session.document.lights[0].clone();
    let kelvin = light(&bench).colour_temperature;
    assert!(kelvin.is_some_and(|k| (6200.0..=6800.0).contains(&k)), "white is about 6500 K: {kelvin:?}");
    bench.type_into("colour temperature", "2700");
    assert_eq!(light(&bench).colour_temperature, Some(2700.0));
    bench.type_into("colour temperature", "900");
    assert!(bench.says("between 1000 and 40000"));
    let shown = light(&bench).rgb8();
    let rgb = bench.find("Colour by: RGB").expect("a choice").rect.center();
    bench.hover(rgb);
    let warned = |text: &String| text.contains("keeps the colour that it shows and becomes darker");
    assert!(bench.texts().iter().any(warned), "{:?}", bench.texts());
    bench.click("Colour by: RGB");
    assert_eq!((light(&bench).colour_temperature, light(&bench).colour), (None, shown));
}

#[test]
fn exposure_and_every_tone_mapping_can_be_chosen() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Select(Selection::Room));
    bench.type_into("exposure", "1.5");
    assert_eq!(bench.session.document.display.exposure, 1.5);
    let mut shown = ToneMapping::None;
    for tone in ToneMapping::ALL.into_iter().skip(1) {
        bench.click(&format!("tone mapping: {}", shown.name()));
        bench.click(tone.name());
        assert_eq!(bench.session.document.display.tone_mapping, tone);
        shown = tone;
    }
}

// ── keys ──

#[test]
fn keys_choose_the_shading_but_not_while_typing() {
    let mut bench = Bench::new(Session::default());
    for (key, text, shading) in
        [(Key::F, "f", "flat"), (Key::P, "p", "phong"), (Key::D, "d", "derivative"), (Key::G, "g", "gouraud")]
    {
        bench.letter(key, text);
        assert_eq!(bench.session.document.shading_model, shading);
    }
    let at = bench.field("Name").rect.center();
    bench.click_at(at, PointerButton::Primary);
    bench.letter(Key::F, "f");
    bench.key(Key::Delete, Modifiers::NONE);
    assert_eq!(bench.session.document.shading_model, "gouraud");
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.objects[0].name.as_deref(), Some("f"));
}

#[test]
fn delete_removes_the_selection_but_not_from_within_a_knob() {
    let mut bench = Bench::with_model("phong");
    bench.apply(Action::AddObject("cube".to_owned()));
    let slider = bench.tree.iter().find(|s| s.role == accesskit::Role::Slider).map(|s| s.rect.center());
    bench.click_at(slider.unwrap_or_default(), PointerButton::Primary);
    bench.key(Key::Delete, Modifiers::NONE);
    assert_eq!(bench.session.document.objects.len(), 2);
    bench.key(Key::Escape, Modifiers::NONE);
    bench.key(Key::Delete, Modifiers::NONE);
    assert_eq!(bench.session.document.objects.len(), 1);
}

#[test]
fn tab_goes_through_the_objects_and_takes_no_focus() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::AddObject("cube".to_owned()));
    bench.apply(Action::AddObject("torus".to_owned()));
    bench.key(Key::Tab, Modifiers::NONE);
    assert_eq!(bench.session.selection, Selection::Object(0));
    bench.key(Key::Tab, Modifiers::SHIFT);
    assert_eq!(bench.session.selection, Selection::Object(2));
    assert_eq!(bench.ctx.memory(|m| m.focused()), None);
    bench.key(Key::F6, Modifiers::NONE);
    assert!(bench.ctx.memory(|m| m.focused()).is_some(), "F6 goes into the panels");
}

#[test]
fn numbers_choose_recent_models_and_keep_their_places() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
    for (key, model) in
        [(Key::Num2, "phong"), (Key::Num1, "lambert"), (Key::Num3, "blinn_phong"), (Key::Num2, "phong")]
    {
        bench.key(key, Modifiers::NONE);
        assert_eq!(bench.session.document.reflection_model, model);
    }
}

#[test]
fn the_chooser_finds_by_typing_and_chooses_with_enter() {
    let mut bench = Bench::new(Session::default());
    bench.key(Key::R, Modifiers::NONE);
    assert!(bench.session.view.chooser_open);
    bench.frame(vec![Event::Text("1977".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.reflection_model, "blinn_phong");
    assert!(!bench.session.view.chooser_open);
}

#[test]
fn many_models_are_listed_by_family_within_the_window() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "disney")));
    bench.key(Key::R, Modifiers::NONE);
    for family in ["Basic", "Classical", "Rough diffuse", "Microfacet", "Standard"] {
        assert!(bench.find(family).is_some(), "{family}");
    }
    let inside = |b: &Bench, name: &str| {
        let Some(seen) = b.find(name) else { panic!("{name} is not listed") };
        seen.rect.top() > 0.0 && seen.rect.bottom() < 690.0
    };
    assert!(inside(&bench, "Disney"), "the chosen one is scrolled to");
    (0..20).for_each(|_| bench.key(Key::ArrowUp, Modifiers::NONE));
    assert!(inside(&bench, "Lambert"));
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.reflection_model, "lambert");
}

#[test]
fn nothing_but_the_question_can_be_used_while_it_is_open() {
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
    bench.apply(Action::New);
    bench.letter(Key::P, "p");
    assert_eq!(bench.session.document.shading_model, "flat");
    assert!(!bench.area.has_pointer);
    bench.apply(Action::Answer(Answer::Discard));
    assert_eq!(*bench.session.document, Scene::default());
}

// ── the window ──

#[test]
fn the_pointer_belongs_to_the_picture_only_over_the_picture() {
    let mut bench = Bench::new(Session::default());
    let rect = bench.area.rect;
    assert!(rect.width() > 500.0 && rect.height() > 500.0);
    for (at, expected) in [
        (rect.center(), true),
        (pos2(4.0, 4.0), false),
        (pos2(1270.0, 400.0), false),
        (pos2(40.0, 400.0), false),
    ] {
        bench.frame(vec![Event::PointerMoved(at)]);
        bench.frame(Vec::new());
        assert_eq!(bench.area.has_pointer, expected, "{at:?}");
    }
    bench.apply(Action::View(ViewChange::Chooser(true)));
    let Some(search) = bench.find("Search reflection models") else { panic!("not open") };
    let inside = search.rect.center() + vec2(0.0, 60.0);
    bench.frame(vec![Event::PointerMoved(inside)]);
    bench.frame(Vec::new());
    assert!(!bench.area.has_pointer, "a popup over the picture is not the picture");
}

#[test]
fn everything_that_can_be_operated_has_a_name() {
    use accesskit::Role;
    let mut bench = Bench::with_model("phong");
    bench.session.say(Severity::Error, "an error");
    for selection in [Selection::Room, Selection::Observer, Selection::Light(0), Selection::Object(0)] {
        bench.apply(Action::Select(selection));
        for seen in &bench.tree {
            let operated = matches!(
                seen.role,
                Role::Button
                    | Role::TextInput
                    | Role::Slider
                    | Role::CheckBox
                    | Role::ComboBox
                    | Role::SpinButton
                    | Role::RadioButton
            );
            assert!(!operated || !seen.label.trim().is_empty(), "{selection:?}: {seen:?}");
        }
    }
}

#[test]
fn ten_thousand_objects_are_listed_without_drawing_them_all() {
    let mut scene = Scene::default();
    for i in 0..9_999u16 {
        let mut object = Object::default();
        object.position.x = 0.1 + f32::from(i) * 9e-4;
        scene.objects.push(object);
    }
    let mut bench = Bench::new(Session::new(scene));
    assert!(bench.tree.len() < 400);
    bench.apply(Action::SelectPrevious);
    assert!(bench.says("Sphere 10000"), "the selection comes into view");
}

#[test]
fn a_panel_from_outside_gets_a_tab() {
    struct Extra;
    impl panel::Panel for Extra {
        fn id(&self) -> &'static str {
            "extra"
        }
        fn title(&self) -> &'static str {
            "Extra"
        }
        fn place(&self) -> panel::Place {
            panel::Place::Bottom
        }
        fn show(&mut self, ui: &mut egui::Ui, _context: &mut panel::PanelContext<'_>) {
            ui.label("from outside");
        }
    }
    let mut bench = Bench::new(Session::default());
    bench.panels.add(Extra);
    bench.apply(Action::View(ViewChange::BottomTab("extra".to_owned())));
    assert!(bench.says("from outside"));
    bench.click("Messages");
    assert!(!bench.says("from outside"));
}

// ── pictures ──

/// A spotlight as specified on its box.
fn lamp(bench: &mut Bench) {
    bench.apply(Action::AddLight("spot".to_owned()));
    let light = bench.session.document.lights.len() - 1;
    for edit in [
        Edit::set(Part::Light(light), Light::luminous_flux, 800.0),
        Edit::set(Part::Light(light), Light::colour_temperature, 2700.0),
    ] {
        bench.apply(Action::Edit(edit));
    }
}

#[test]
#[ignore = "draws pictures to look at: scripts/pictures"]
fn pictures_of_the_window() -> Result<(), Box<dyn std::error::Error>> {
    let folder = crate::helpers::pictures::picture_folder()?;
    type Setup = fn(&mut Bench);
    let states: &[(&str, (f32, f32), Setup)] = &[
        ("start", (1280.0, 720.0), |_| {}),
        ("match", (1280.0, 720.0), |b| crate::comparing::matching::ask(b, "blinn_phong")),
        ("match-light", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            b.apply(Action::View(ViewChange::Scale(150)));
            crate::comparing::matching::ask(b, "disney");
        }),
        ("match-runs", (1280.0, 720.0), |b| {
            crate::comparing::matching::ask(b, "phong");
            crate::comparing::matching::run(b);
        }),
        ("phong", (1280.0, 720.0), |b| {
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")))
        }),
        ("blinn", (1920.0, 1080.0), |b| {
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
            let rect = b
                .tree
                .iter()
                .find(|s| s.role == accesskit::Role::Slider && s.label == "shininess")
                .map(|s| s.rect);
            b.frame(vec![Event::PointerMoved(rect.map_or(Pos2::ZERO, |r| r.center()))]);
            b.settle();
        }),
        ("light", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
            b.apply(Action::AddLight("spot".to_owned()));
        }),
        ("large", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            b.apply(Action::View(ViewChange::Scale(150)));
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
        }),
        ("large-dark", (1920.0, 1080.0), |b| {
            b.apply(Action::View(ViewChange::Scale(150)));
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
        }),
        ("error", (1280.0, 720.0), |b| {
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
            b.apply(Action::Edit(Edit::material(Part::Object(0), "alpha", Value::Integer(64))));
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "mod_lambert")));
            b.session.say(Severity::Info, "Can’t delete the last light: a scene needs at least one.");
            b.session.say(
                Severity::Warning,
                "The settings cannot be written to /home/x/.config: no space left on device.",
            );
            b.session.say(Severity::Error, "scenes/room.json:14:20: objects[0].material.k_d is 0.2, but the diffuse coefficient must be between 0.5 and 1. This one is long, so that it has to be broken into two lines at the least, and must not push the buttons out of the window.");
            b.type_into("position x", "12");
        }),
        ("knob-error", (1280.0, 900.0), |b| {
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")));
            b.type_into("diffuse coefficient", "0.2");
        }),
        ("many", (1280.0, 720.0), |b| {
            for i in 0..40 {
                b.apply(Action::AddObject(["cube", "torus", "teapot", "sphere"][i % 4].to_owned()));
            }
            let name = "A very long name for a very small thing".to_owned();
            b.apply(Action::Edit(Edit::set(Part::Object(2), Object::name, name)));
            b.apply(Action::Select(Selection::Object(2)));
        }),
        ("copies", (1280.0, 720.0), |b| {
            b.click("Copies");
            scroll(b, -2000.0);
        }),
        ("row", (1280.0, 720.0), row),
        ("row-large", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Scale(150)));
            row(b);
        }),
        ("row-large-end", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Scale(150)));
            row(b);
            scroll(b, -380.0);
        }),
        ("row-error", (1280.0, 720.0), |b| {
            row(b);
            b.type_into("columns", "40");
        }),
        ("room", (1280.0, 720.0), |b| b.apply(Action::Select(Selection::Room))),
        ("observer", (1280.0, 720.0), |b| b.apply(Action::Select(Selection::Observer))),
        ("candela", (1280.0, 720.0), |b| b.apply(Action::Select(Selection::Light(0)))),
        ("units", (1280.0, 720.0), |b| {
            b.apply(Action::Select(Selection::Light(0)));
            b.click("unit: candela");
        }),
        ("lumen", (1280.0, 720.0), lamp),
        ("lumen-wide", (1920.0, 1080.0), lamp),
        ("lumen-large", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            b.apply(Action::View(ViewChange::Scale(150)));
            lamp(b);
        }),
        ("caption", (1280.0, 720.0), |b| {
            b.apply(Action::View(ViewChange::Scale(150)));
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong")));
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "derivative")));
            b.apply(Action::View(ViewChange::Terms(TermSelection::Specular)));
            let display = Display {
                tone_mapping: ToneMapping::KhronosPbrNeutral,
                exposure: 1.5,
                encoding: Encoding::Off,
                ..Display::default()
            };
            b.apply(Action::Edit(Edit::from(display)));
        }),
        ("tones", (1280.0, 720.0), |b| {
            b.apply(Action::Select(Selection::Room));
            b.click("tone mapping: None (clip)");
            let row = b.find("Khronos PBR Neutral").map(|s| s.rect.center());
            b.frame(vec![Event::PointerMoved(row.unwrap_or_default())]);
        }),
        ("chooser", (1280.0, 720.0), |b| b.key(Key::R, Modifiers::NONE)),
        ("menu", (1280.0, 720.0), |b| b.click("View")),
        ("file-menu", (1280.0, 720.0), |b| b.click("File")),
        ("keys", (1280.0, 720.0), |b| b.key(Key::F1, Modifiers::NONE)),
        ("about", (1280.0, 720.0), |b| b.apply(Action::View(ViewChange::About(true)))),
        ("question", (1280.0, 720.0), |b| {
            b.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
            b.apply(Action::Quit);
        }),
        ("missing", (1280.0, 720.0), |b| {
            let part = |name: &str, default: &str| MissingPart {
                name: name.to_owned(),
                default: default.to_owned(),
            };
            let parts = vec![part("the scene size", "10 × 10 × 10 m"), part("the shading model", "Gouraud")];
            b.session.questions.ask(Question::MissingParts {
                path: PathBuf::from("scenes/room.json"),
                scene: Box::default(),
                parts,
            });
        }),
        ("colour", (1280.0, 900.0), |b| b.click("base colour: choose a colour")),
        ("open-dialog", (1280.0, 720.0), |b| b.key(Key::O, Modifiers::COMMAND | Modifiers::CTRL)),
        ("rename", (1280.0, 720.0), |b| b.key(Key::F2, Modifiers::NONE)),
        ("models", (1280.0, 720.0), |b| {
            everything(b);
            b.key(Key::R, Modifiers::NONE);
        }),
        ("models-large", (1280.0, 720.0), |b| {
            everything(b);
            b.apply(Action::View(ViewChange::Scale(150)));
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            b.key(Key::R, Modifiers::NONE);
        }),
        ("everything", (1280.0, 720.0), everything),
        ("everything-tall", (1920.0, 1080.0), |b| {
            everything(b);
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            let gold = preset::conductor(preset::by_id("gold").unwrap());
            b.apply(Action::Edit(Edit::materials(Part::Object(0), gold, "Measured material")));
        }),
        ("everything-scrolled", (1280.0, 720.0), |b| {
            everything(b);
            scroll(b, -420.0);
        }),
        ("everything-end", (1280.0, 720.0), |b| {
            everything(b);
            scroll(b, -2000.0);
        }),
        ("measured", (1280.0, 720.0), |b| {
            everything(b);
            scroll(b, -330.0);
            b.click("measured material: none");
            let row = b.find("Brass (Cu70 Zn30)").map(|s| s.rect.center());
            b.frame(vec![Event::PointerMoved(row.unwrap_or_default())]);
        }),
        ("measured-light", (1920.0, 1080.0), |b| {
            everything(b);
            b.apply(Action::View(ViewChange::Theme(ThemeChoice::Light)));
            b.click("measured material: none");
            b.frame(vec![Event::Text("glass".to_owned())]);
            let row = b.find("N-BK7 glass").map(|s| s.rect.center());
            b.settle();
            b.frame(vec![Event::PointerMoved(row.unwrap_or_default())]);
        }),
        ("triple-error", (1280.0, 900.0), |b| {
            everything(b);
            b.type_into("refractive index G", "7");
        }),
        ("own", (1280.0, 720.0), |b| {
            b.apply(Action::Edit(Edit::set(Part::Object(0), Object::reflection_model, "phong")));
            b.apply(Action::Edit(Edit::set(Part::Object(0), Object::shading_model, "flat")));
        }),
    ];
    fn everything(b: &mut Bench) {
        b.registry = crowd();
        b.session.model_slots.fill(&b.registry);
        b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "everything")));
    }
    fn row(b: &mut Bench) {
        b.session.facts.camera = glam::Quat::IDENTITY;
        b.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "metallic_roughness")));
        b.apply(Action::MakeRow(Selection::Object(0)));
        b.type_into("rows", "2");
        b.click("Vary a value");
    }
    fn scroll(b: &mut Bench, by: f32) {
        let all = b.ctx.content_rect();
        b.frame(vec![Event::PointerMoved(all.lerp_inside(vec2(0.86, 0.55)))]);
        let delta = vec2(0.0, by);
        b.frame(vec![Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta,
            phase: egui::TouchPhase::Move,
            modifiers: Modifiers::NONE,
        }]);
        (0..20).for_each(|_| b.settle());
    }
    let only = std::env::var("LCM_PANEL_ONLY").ok().filter(|o| !o.is_empty());
    for (name, (width, height), setup) in states {
        if only.as_ref().is_some_and(|o| !o.split(',').any(|o| o == *name)) {
            continue;
        }
        let mut scene = Scene::default();
        scene.lights.push(Light {
            light_type: "ambient".to_owned(),
            name: Some("sky".to_owned()),
            position: None,
            intensity: 0.2,
            ..Light::default()
        });
        scene.objects[0].material.set("base_colour", Value::Colour([204, 96, 64]));
        let mut session = Session::new(scene);
        session.facts.frame_ms = 16.6;
        session.facts.backend = "Vulkan".to_owned();
        session.facts.adapter = "llvmpipe (LLVM 15.0.6, 256 bits)".to_owned();
        session.facts.camera = glam::Quat::from_euler(glam::EulerRot::YXZ, 0.5, -0.4, 0.0);
        let mut bench = Bench::new(session);
        bench.size = vec2(*width, *height);
        bench.settle();
        setup(&mut bench);
        let surround = panel::theme::Palette::of(&bench.session.settings).surround;
        bench.picture(&folder.join(format!("{name}.png")), surround)?;
    }
    Ok(())
}

/// Renders egui's output in software: slow, and without dependencies.
#[derive(Default)]
struct Painter {
    textures: HashMap<TextureId, egui::ColorImage>,
}

impl Painter {
    fn take(&mut self, delta: &mut epaint::textures::TexturesDelta) {
        for (id, deltas) in &delta.set {
            for delta in deltas {
                let epaint::ImageData::Color(image) = &delta.image;
                match (delta.pos, self.textures.get_mut(id)) {
                    (Some([x, y]), Some(whole)) => {
                        for row in 0..image.size[1] {
                            for column in 0..image.size[0] {
                                whole.pixels[(y + row) * whole.size[0] + x + column] =
                                    image.pixels[row * image.size[0] + column];
                            }
                        }
                    }
                    _ => drop(self.textures.insert(*id, (**image).clone())),
                }
            }
        }
        for id in &delta.free {
            self.textures.remove(id);
        }
        delta.clear();
    }

    fn draw(
        &self,
        primitives: &[epaint::ClippedPrimitive],
        size: (usize, usize),
        ground: egui::Color32,
    ) -> Vec<u8> {
        let mut pixels =
            vec![[f32::from(ground.r()), f32::from(ground.g()), f32::from(ground.b())]; size.0 * size.1];
        for primitive in primitives {
            let epaint::Primitive::Mesh(mesh) = &primitive.primitive else { continue };
            let Some(texture) = self.textures.get(&mesh.texture_id) else { continue };
            let clip = primitive.clip_rect;
            for triangle in mesh.indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|k| mesh.vertices[triangle[k] as usize]);
                self.triangle(&mut pixels, size, texture, clip, [a, b, c]);
            }
        }
        pixels.iter().flat_map(|p| p.map(|v| v.clamp(0.0, 255.0).round() as u8)).collect()
    }

    fn triangle(
        &self,
        pixels: &mut [[f32; 3]],
        size: (usize, usize),
        texture: &egui::ColorImage,
        clip: Rect,
        v: [epaint::Vertex; 3],
    ) {
        let edge = |a: Pos2, b: Pos2, p: Pos2| (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        let area = edge(v[0].pos, v[1].pos, v[2].pos);
        if area == 0.0 {
            return;
        }
        let bound = Rect::from_points(&[v[0].pos, v[1].pos, v[2].pos]).intersect(clip);
        let first = |x: f32| (x - 0.5).ceil().max(0.0) as usize;
        for y in first(bound.top())..first(bound.bottom()).min(size.1) {
            for x in first(bound.left())..first(bound.right()).min(size.0) {
                let p = pos2(x as f32 + 0.5, y as f32 + 0.5);
                let w =
                    [edge(v[1].pos, v[2].pos, p), edge(v[2].pos, v[0].pos, p), edge(v[0].pos, v[1].pos, p)]
                        .map(|e| e / area);
                // An edge shared by two triangles belongs to one of them.
                let owned = |k: usize| {
                    let (a, b) = (v[(k + 1) % 3].pos, v[(k + 2) % 3].pos);
                    let d = if area > 0.0 { b - a } else { a - b };
                    d.y < 0.0 || (d.y == 0.0 && d.x > 0.0)
                };
                if (0..3).any(|k| w[k] < 0.0 || (w[k] == 0.0 && !owned(k))) {
                    continue;
                }
                let mix = |f: fn(&epaint::Vertex) -> [f32; 4]| -> [f32; 4] {
                    let all = v.map(|v| f(&v));
                    std::array::from_fn(|i| (0..3).map(|k| w[k] * all[k][i]).sum())
                };
                let colour = mix(|v| v.color.to_array().map(f32::from));
                let uv = mix(|v| [v.uv.x, v.uv.y, 0.0, 0.0]);
                let texel = sample(texture, uv[0], uv[1]);
                let source: [f32; 4] = std::array::from_fn(|i| colour[i] * texel[i] / 255.0);
                let target = &mut pixels[y * size.0 + x];
                for (i, t) in target.iter_mut().enumerate() {
                    *t = source[i] + *t * (1.0 - source[3] / 255.0);
                }
            }
        }
    }
}

fn sample(texture: &egui::ColorImage, u: f32, v: f32) -> [f32; 4] {
    let [width, height] = texture.size;
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let at = |x: f32, y: f32| {
        let x = (x.max(0.0) as usize).min(width - 1);
        let y = (y.max(0.0) as usize).min(height - 1);
        texture.pixels[y * width + x].to_array().map(f32::from)
    };
    let (fx, fy) = (x - x.floor(), y - y.floor());
    let [a, b, c, d] = [
        at(x.floor(), y.floor()),
        at(x.floor() + 1.0, y.floor()),
        at(x.floor(), y.floor() + 1.0),
        at(x.floor() + 1.0, y.floor() + 1.0),
    ];
    std::array::from_fn(|i| {
        (a[i] * (1.0 - fx) + b[i] * fx) * (1.0 - fy) + (c[i] * (1.0 - fx) + d[i] * fx) * fy
    })
}

// ── changes ──

/// Runs frames of a bench with these events, and returns the number of those that changed its state.
fn changes(bench: &mut Bench, frames: impl IntoIterator<Item = Vec<Event>>) -> usize {
    let mut world = World::new();
    world.insert_resource(std::mem::take(&mut bench.session));
    let mut count = 0;
    for events in frames {
        world.clear_trackers();
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, bench.size)),
            focused: true,
            events,
            ..RawInput::default()
        };
        let (registry, panels, area) = (&bench.registry, &mut bench.panels, &mut bench.area);
        let (dialogs, others) = (&mut bench.dialogs, &bench.world);
        let mut session = world.resource_mut::<Session>();
        let _ = bench.ctx.run_ui(input, |ui| {
            assert_eq!(panel::show(ui, session.reborrow(), area, registry, panels, dialogs, others), []);
        });
        count += usize::from(world.is_resource_changed::<Session>());
    }
    bench.session = world.remove_resource().expect("it is there");
    count
}

#[test]
fn the_state_changes_only_when_something_does() {
    let mut bench = Bench::with_everything();
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::BottomTab("messages".to_owned())));
    bench.session.say(Severity::Warning, "A message.");
    bench.settle();
    assert_eq!(changes(&mut bench, (0..30).map(|_| Vec::new())), 0, "at rest");
    let places = (0..24).flat_map(|k| [(60, k), (1100, k), (300 + 30 * k, 23), (600, k)]);
    let places: Vec<_> = places.map(|(x, y)| pos2(x as f32, 30.0 * y as f32)).collect();
    let moves = places.into_iter().map(|at| vec![Event::PointerMoved(at)]);
    assert_eq!(changes(&mut bench, moves), 0, "under a pointer");
    let before = bench.session.document.scene().clone();
    let key = |pressed| Event::Key {
        key: Key::Num2,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    bench.session.model_slots.fill(&bench.registry);
    let pressed = changes(&mut bench, [vec![key(true)], vec![key(false)], Vec::new(), Vec::new()]);
    assert!((1..=2).contains(&pressed), "a step, and the end of a gesture: {pressed}");
    assert_ne!(bench.session.document, before);
}
