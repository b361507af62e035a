//! The laws of every registered model, over random directions and parameters: asserted if the model declares
//! them, and found violated otherwise.

use glam::Vec3;
use lights_camera_models::{
    optics::{
        Frame, TermSelection, Terms,
        colour::Encoding,
        interface::{Facets, Interface},
        lobes::Lobes,
        radiometry::Arriving,
    },
    parameter::{Parameter, Value, Values},
    parameters,
    progress::Progress,
    reflection::{
        self, ModelEntry, ReflectionModel,
        law_report::LawReport,
        laws::{Effort, RECIPROCITY_TOLERANCE, Random, examine_on_cpu},
    },
    registry::{Register as _, Registry},
    shader::Source,
    testing::{self, laws::albedo},
};

/// Checks a law for every model.
fn hold(law: fn(&ModelEntry) -> testing::Outcome) {
    for model in Registry::builtin().models() {
        assert_eq!(law(model), Ok(()), "{}", model.declaration.id);
    }
}

#[test]
fn responses_are_finite_for_all_directions_and_legal_parameters() {
    hold(testing::laws::finite);
}

#[test]
fn no_light_is_negative_where_that_is_declared_and_somewhere_it_is_where_not() {
    hold(testing::laws::non_negative);
}

#[test]
fn light_may_go_backwards_where_that_is_declared_and_somewhere_it_may_not_where_not() {
    hold(testing::laws::reciprocal);
}

#[test]
fn no_light_is_made_where_that_is_declared_and_somewhere_it_is_where_not() {
    hold(testing::laws::energy_conserving);
}

const SHARE: Parameter =
    Parameter::number("share", 0.0..=1.0, 0.5).label("share").help("Of the light from behind.");

parameters! {
    /// A sheet that reflects 0.3 of the light and lets through as much as it says.
    pub struct Sheet {
        /// The fraction that is let through.
        share: number = SHARE,
    }
}

impl ReflectionModel for Sheet {
    const DECLARATION: reflection::Declaration =
        reflection::Declaration::new("sheet", "Sheet", Source::new("reflection/sheet.wgsl", ""))
            .transmitting()
            .energy_conserving();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (l, v) = (frame.n.dot(l), frame.n.dot(v));
        match (l > 0.0, v > 0.0) {
            (true, true) => Terms::of(Vec3::splat(0.3 * l), Vec3::ZERO),
            (false, true) => Terms::through(Vec3::splat(-self.share * l)),
            _ => Terms::default(),
        }
    }

    fn lobes(&self) -> Lobes {
        Lobes::cosine()
    }
}

#[test]
fn light_that_a_sheet_lets_through_is_counted_too() {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Sheet>();
    let model = registry.model("sheet").expect("added");
    // Up to 1.3 of the light.
    let said = testing::laws::energy_conserving(model).expect_err("it makes light");
    assert!(said.contains("declares that it conserves energy, but reflects 1."), "{said}");
    let mut values = Values::default();
    for share in [0.0, 0.5, 0.7] {
        values.set("share", Value::Number(share));
        let surface = model.instantiate(&values, Encoding::Srgb);
        let frame = Frame::from_normal(Vec3::new(0.3, -0.5, 0.7).normalize());
        let found = albedo(&*surface, (frame.n + frame.t).normalize(), &frame, 64);
        assert!((found - 0.3 - share).abs() < 5e-3, "{share}: {found}");
    }
    // A clear pane reflects and lets through all light, without spreading any.
    let pane =
        registry.model("thin_glass").expect("built in").instantiate(&Values::default(), Encoding::Srgb);
    let whole = albedo(&*pane, Vec3::new(0.6, 0.0, 0.8), &Frame::LOCAL, 48);
    assert!((whole - 1.0).abs() < 1e-5, "{whole}");
}

/// A model that claims reciprocity and lets light through, with this transmission for light from behind, and for a viewer
/// there.
macro_rules! passage {
    ($name:ident, $declared:ident, $there:expr, $back:expr) => {
        parameters! {
            struct $name {}
        }
        impl ReflectionModel for $name {
            const DECLARATION: reflection::Declaration = $declared;

            fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
                let (l, v) = (frame.to_local(l), frame.to_local(v));
                if l.z >= 0.0 || v.z <= 0.0 {
                    return Terms::default();
                }
                let there: fn(Vec3, Vec3) -> f32 = $there;
                Terms::through(Vec3::splat(-std::f32::consts::PI * l.z * there(l, v)))
            }

            fn behind(&self, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
                let back: fn(Vec3, Vec3) -> f32 = $back;
                Vec3::splat(back(frame.to_local(l), frame.to_local(v)))
            }

            fn refractive_index(&self) -> Option<f32> {
                Some(1.5)
            }

            fn lobes(&self) -> Lobes {
                Lobes::cosine()
            }
        }
    };
}

const CURTAIN: reflection::Declaration =
    reflection::Declaration::new("passage", "Passage", Source::new("reflection/passage.wgsl", ""))
        .transmitting()
        .reciprocal();
const WATER: reflection::Declaration = CURTAIN.boundary();

/// Ground glass of index 1.5.
fn through_ground_glass(l: Vec3, v: Vec3) -> f32 {
    Interface::new(Facets::Ggx, glam::Vec2::splat(0.4), 1.5).transmitted(l, v)
}

passage!(Even, CURTAIN, |l, v| 0.1 * (v.z - l.z), |_, _| 0.0);
passage!(Askew, CURTAIN, |_, v| 0.2 * v.z, |_, _| 0.0);
passage!(Ground, WATER, through_ground_glass, through_ground_glass);
// The wrong twin: flux, which is not scaled, instead of radiance.
passage!(OfFlux, WATER, through_ground_glass, |l, v| through_ground_glass(l, v) / 2.25);

#[test]
fn light_that_passes_may_go_backwards_too_or_that_is_found() {
    let effort = Effort { sets: 3, pairs: 300 };
    let examined = |model: &ModelEntry| {
        let found = examine_on_cpu(model, &Values::default(), effort, &Progress::NONE).expect("to the end");
        assert!(found.reciprocity.size <= RECIPROCITY_TOLERANCE, "{found:?}");
        let report = LawReport::new(model, &Values::default(), &found);
        (found, report)
    };
    for (model, keeps) in [
        (ModelEntry::of::<Even>(), true),
        (ModelEntry::of::<Askew>(), false),
        (ModelEntry::of::<Ground>(), true),
        (ModelEntry::of::<OfFlux>(), false),
    ] {
        let (found, report) = examined(&model);
        assert!(found.transmission.case.is_some());
        assert_eq!(found.transmission.size <= RECIPROCITY_TOLERANCE, keeps, "{:?}", found.transmission);
        let named = report.laws.iter().find(|law| law.law == "reciprocal in transmission").expect("a law");
        assert_eq!((named.claimed, named.kept, named.at.is_empty()), (true, keeps, false));
        assert_eq!(report.broken().contains(&"reciprocal in transmission"), !keeps);
        assert_eq!(testing::laws::reciprocal(&model).is_ok(), keeps, "{report}");
    }
    let registry = Registry::builtin();
    for (id, judged) in [
        ("thin_glass", true),
        ("diffuse_transmission", true),
        ("rough_dielectric", true),
        // Light follows the mesh of a solid, and none passes Lambert's.
        ("glass", false),
        ("lambert", false),
    ] {
        let (found, report) = examined(registry.model(id).expect("built in"));
        assert_eq!(found.transmission.case.is_some(), judged, "{id}");
        assert_eq!(report.laws.len(), if judged { 4 } else { 3 }, "{id}");
        assert!(!report.broken().contains(&"reciprocal in transmission"), "{id}: {report}");
    }
}

#[test]
fn samples_by_the_lobes_of_a_model_give_its_albedo() {
    hold(testing::laws::sampled);
}

parameters! {
    /// The wrong twin of models that answer to all lights: it forgets those after the fourth.
    pub struct Forgetful {}
}

impl ReflectionModel for Forgetful {
    const DECLARATION: reflection::Declaration =
        reflection::Declaration::new("forgetful", "Forgetful", Source::new("reflection/forgetful.wgsl", ""));

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        Terms::of(Vec3::splat(frame.n.dot(l).max(0.0)), Vec3::ZERO)
    }

    fn lit_together(
        &self,
        lights: &[Arriving],
        v: Vec3,
        frame: &Frame,
        terms: TermSelection,
    ) -> Option<Vec3> {
        let one = |at: &Arriving| ReflectionModel::response(self, at.l, v, frame).select(terms) * at.light;
        Some(lights.iter().take(4).map(one).sum())
    }
}

#[test]
fn several_lights_at_once_give_what_each_gives_alone() {
    hold(testing::laws::together);
    let said = testing::laws::together(&ModelEntry::of::<Forgetful>()).expect_err("it forgets lights");
    assert!(said.contains("11 lights give"), "{said}");
}

/// The wrong twin of models that say where light counts: lit all around, without a word.
#[test]
fn models_answer_to_light_from_below_if_they_say_so() {
    hold(testing::laws::from_below);
    let said = testing::laws::from_below(&ModelEntry::of::<Everywhere>()).expect_err("it does not say so");
    assert!(said.contains("does not declare `lit_from_below`"), "{said}");
}

parameters! {
    /// Lit all around.
    pub struct Everywhere {}
}

impl ReflectionModel for Everywhere {
    const DECLARATION: reflection::Declaration = reflection::Declaration::new(
        "everywhere",
        "Everywhere",
        Source::new("reflection/everywhere.wgsl", ""),
    );

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        Terms::of(Vec3::splat(1.0 + frame.n.dot(l)), Vec3::ZERO)
    }
}

#[test]
fn the_quadrature_of_the_albedo_is_right() {
    // Lambert reflects its base colour in every direction; half of it fails.
    let registry = Registry::builtin();
    let mut values = Values::default();
    values.set("base_colour", Value::Colour([188; 3]));
    let lambert = registry.model("lambert").unwrap().instantiate(&values, Encoding::Srgb);
    let frame = Frame::from_normal(Vec3::new(0.3, -0.5, 0.7).normalize());
    let expected = Encoding::Srgb.decode([188; 3]).x;
    for v in [frame.n, (frame.n + 3.0 * frame.t).normalize()] {
        assert!((albedo(&*lambert, v, &frame, 48) - expected).abs() < 3e-3);
        assert!((albedo(&*lambert, v, &frame, 160) - expected).abs() < 3e-4);
    }
    // Phong's lobe at normal view: E = k_d + 2 k_s / (α + 2), since its response is cos^α without the
    // further cosine: ∫ cos^α dω / π = 2 / (α + 1).
    let mut values = Values::default();
    values.set("alpha", Value::Integer(100));
    let phong = registry.model("phong").unwrap().instantiate(&values, Encoding::Srgb);
    let expected = 0.8 + 0.5 * 2.0 / 101.0;
    assert!((albedo(&*phong, frame.n, &frame, 160) - expected).abs() < 1e-3);
}

/// The angles of a pair of directions, for formulas in a different form than the models'.
struct Angles {
    /// Polar angle of light and view, and the azimuth between them.
    l: f64,
    v: f64,
    phi: f64,
}

impl Angles {
    fn of(l: Vec3, v: Vec3, frame: &Frame) -> Self {
        let polar = |d: Vec3| {
            let across = f64::from(d.dot(frame.t)).hypot(f64::from(d.dot(frame.b)));
            across.atan2(f64::from(d.dot(frame.n)))
        };
        let azimuth = |d: Vec3| f64::from(d.dot(frame.b)).atan2(f64::from(d.dot(frame.t)));
        Self { l: polar(l), v: polar(v), phi: azimuth(l) - azimuth(v) }
    }

    /// Cosine between the mirror direction of the light and the view, by spherical trigonometry: the
    /// mirror direction has the light's polar angle and the opposite azimuth.
    fn mirror(&self) -> f64 {
        self.l.cos() * self.v.cos() - self.l.sin() * self.v.sin() * self.phi.cos()
    }

    /// Cosine between the normal and the half vector: the mean of the two cosines over half the length
    /// of the sum, which is the cosine of half the angle between light and view.
    fn half(&self) -> f64 {
        let between = self.l.cos() * self.v.cos() + self.l.sin() * self.v.sin() * self.phi.cos();
        0.5 * (self.l.cos() + self.v.cos()) / (0.5 * (1.0 + between)).sqrt()
    }
}

/// Compares a model with a formula for one channel of white colours; `wrong` must differ somewhere.
fn against(
    id: &str,
    settings: &[(&'static str, Value)],
    formula: impl Fn(&Angles) -> [f64; 3],
    wrong: impl Fn(&Angles) -> [f64; 3],
) {
    let registry = Registry::builtin();
    let mut values = Values::default();
    for (name, value) in settings {
        values.set(*name, value.clone());
    }
    let surface = registry.model(id).unwrap().instantiate(&values, Encoding::Srgb);
    let mut random = Random(11);
    let mut told_apart = false;
    for i in 0..4000 {
        let frame = Frame::from_normal(random.direction());
        let (mut l, mut v) = (random.direction(), random.direction());
        // Normal incidence, the mirror direction, grazing light.
        match i {
            0 => l = frame.n,
            1 => (l, v) = (frame.n, frame.n),
            2..20 => v = 2.0 * frame.n.dot(l) * frame.n - l,
            20..30 => l = (frame.t + 1e-3 * frame.n).normalize(),
            _ => {}
        }
        if (l + v).length() < 0.05 {
            continue;
        }
        let terms = surface.response(l, v, &frame);
        let got = [terms.ambient.x, terms.diffuse.x, terms.specular.x].map(f64::from);
        let angles = Angles::of(l, v, &frame);
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 2e-5 * (1.0 + b[i].abs()));
        let expected = formula(&angles);
        assert!(near(got, expected), "{id}: {got:?} is not {expected:?}");
        told_apart |= !near(got, wrong(&angles));
    }
    assert!(told_apart, "{id}: the wrong twin passes");
}

#[test]
fn lambert_is_the_cosine_of_the_incident_angle() {
    against("lambert", &[], |a| [0.0, a.l.cos().max(0.0), 0.0], |a| [0.0, a.l.cos().abs(), 0.0]);
}

#[test]
fn modified_lambert_is_a_power_of_the_wrapped_cosine() {
    for (k, p) in [(0.5, 2.0), (0.8, 2.0), (0.65, 3.0), (1.0, 1.0)] {
        let settings = [("k_d", Value::Number(k as f32)), ("wrap_exponent", Value::Number(p as f32))];
        // 1 − k (1 − cos θ), by the half angle: 1 − 2k sin²(θ/2).
        let wrapped = |a: &Angles| (1.0 - 2.0 * f64::from(k as f32) * (a.l / 2.0).sin().powi(2)).max(0.0);
        against(
            "mod_lambert",
            &settings,
            |a| [0.0, wrapped(a).powf(p), 0.0],
            |a| {
                // N·L clamped before it is wrapped.
                [
                    0.0,
                    (k * a.l.cos().max(0.0) + 1.0 - k).max(0.0).powf(p) * if k < 1.0 { 1.0 } else { 0.5 },
                    0.0,
                ]
            },
        );
    }
}

#[test]
fn modified_lambert_without_wrap_and_power_is_lambert() {
    let registry = Registry::builtin();
    let model = registry.model("mod_lambert").unwrap();
    let at = |k: f32, p: f32| {
        let mut values = Values::default();
        values.set("k_d", Value::Number(k));
        values.set("wrap_exponent", Value::Number(p));
        model.instantiate(&values, Encoding::Srgb)
    };
    let lambert = registry.model("lambert").unwrap().instantiate(&Values::default(), Encoding::Srgb);
    let mut random = Random(5);
    let mut squared_differs = false;
    for _ in 0..1000 {
        let frame = Frame::from_normal(random.direction());
        let (l, v) = (random.direction(), random.direction());
        let (a, b) = (at(1.0, 1.0).response(l, v, &frame), lambert.response(l, v, &frame));
        assert!((a.diffuse - b.diffuse).abs().max_element() < 1e-6);
        squared_differs |= (at(1.0, 2.0).response(l, v, &frame).diffuse.x - b.diffuse.x).abs() > 0.1;
    }
    assert!(squared_differs, "with the square as written it is not Lambert");
}

/// Coefficients with f32 values that the formulas use directly.
const K_A: f32 = 0.25;
const K_D: f32 = 0.75;
const K_S: f32 = 0.5;

fn coefficients(alpha: i64) -> [(&'static str, Value); 4] {
    [
        ("k_a", Value::Number(K_A)),
        ("k_d", Value::Number(K_D)),
        ("k_s", Value::Number(K_S)),
        ("alpha", Value::Integer(alpha)),
    ]
}

fn three_terms(a: &Angles, cosine: f64, alpha: i64, lit: bool) -> [f64; 3] {
    let specular = if lit { f64::from(K_S) * cosine.max(0.0).powf(alpha as f64) } else { 0.0 };
    [f64::from(K_A), f64::from(K_D) * a.l.cos().max(0.0), specular]
}

#[test]
fn phong_is_a_power_of_the_cosine_to_the_mirror_direction() {
    for alpha in [0, 1, 5, 32] {
        against(
            "phong",
            &coefficients(alpha),
            |a| three_terms(a, a.mirror(), alpha, a.l.cos() > 0.0),
            // Without the test for the side of the light; and the other highlight.
            |a| three_terms(a, a.half(), alpha, true),
        );
    }
}

#[test]
fn blinn_phong_is_a_power_of_the_cosine_to_the_half_vector() {
    for alpha in [0, 1, 5, 32] {
        against(
            "blinn_phong",
            &coefficients(alpha),
            |a| three_terms(a, a.half(), alpha, a.l.cos() > 0.0),
            |a| three_terms(a, a.mirror(), alpha, true),
        );
    }
}

#[test]
fn the_largest_exponent_leaves_a_highlight_in_the_mirror_direction_alone() {
    let registry = Registry::builtin();
    for id in ["phong", "blinn_phong"] {
        let mut values = Values::default();
        values.set("alpha", Value::Integer(1_000_000));
        values.set("k_s", Value::Number(1.0));
        let surface = registry.model(id).unwrap().instantiate(&values, Encoding::Srgb);
        let frame = Frame::from_normal(Vec3::Z);
        assert_eq!(surface.response(Vec3::Z, Vec3::Z, &frame).specular, Vec3::ONE, "{id}");
        let aside = Vec3::new(0.02, 0.0, 1.0).normalize();
        assert!(surface.response(aside, Vec3::Z, &frame).specular.x < 1e-6, "{id}");
    }
}
