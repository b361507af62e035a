//! Scenes and calls that unit tests and the integration tests of this crate share.

use std::sync::atomic::AtomicBool;

use glam::Vec3;

use crate::{
    matching::{Match, MatchError, Request, What, match_view},
    optics::TermSelection,
    parameter::Value,
    progress::Progress,
    reference::{Picture, Reached, Settings, Until, render_until},
    registry::Registry,
    scene::{Light, Scene, Variant},
};

/// A view's reflection model, and values of its material.
type Of<'a> = (&'a str, &'a [(&'static str, Value)]);

/// A sphere with one model and some values in view A, and another model in view B.
pub fn two_views(a: Of, b: Of) -> Scene {
    let mut scene = Scene { reflection_model: a.0.to_owned(), ..Scene::default() };
    a.1.iter().for_each(|(name, value)| scene.objects[0].material.set(*name, value.clone()));
    let mut variant = Variant { reflection_model: Some(b.0.to_owned()), ..Variant::default() };
    b.1.iter().for_each(|(name, value)| variant.material.set(*name, value.clone()));
    scene.variants = vec![variant];
    scene
}

/// Matches view B with the built-in models.
///
/// # Errors
/// Returns the errors of [`match_view`].
pub fn matched(scene: &Scene, what: What, parameters: &[&str]) -> Result<Match, MatchError> {
    match_view(
        &Request { scene, view: 1, measure: what.into(), parameters },
        &Registry::builtin(),
        &Progress::NONE,
    )
}

/// Values of Phong's model that differ from the defaults.
pub const PHONG: [(&str, Value); 4] = [
    ("k_a", Value::Number(0.25)),
    ("k_d", Value::Number(0.6)),
    ("k_s", Value::Number(0.35)),
    ("alpha", Value::Integer(50)),
];

/// A small picture.
pub const SMALL: Settings = Settings { width: 48, height: 32, samples: 1, terms: TermSelection::All };

/// The default scene under a rectangle of light that is not to be seen itself.
pub fn lit(registry: &Registry) -> Scene {
    let mut scene = Scene::default();
    let mut light = Light { position: Some(Vec3::new(7.0, 8.0, 7.0)), ..scene.lights[0].clone() };
    light.set_type(registry.light("rectangle").expect("built in"), registry, scene.scene_size);
    light.direction = Some(Vec3::new(-2.0, -3.0, -2.0));
    light.parameters.set("visible", Value::Choice("false".into()));
    scene.lights = vec![light];
    scene
}

/// Renders a small picture without reporting progress.
pub fn until(scene: &Scene, registry: &Registry, samples: u32, noise: Option<f32>) -> (Picture, Reached) {
    let (odd, until) = (AtomicBool::default(), Until { samples, noise });
    render_until(scene, registry, &SMALL, until, &odd, &Progress::NONE).expect("nobody cancels")
}
