//! STUB
#![allow(missing_docs)]
use std::{path::Path, sync::Arc};
use crate::{scene::Scene, registry::Registry, document::Selection, channel::DebugChannel, optics::TermSelection, curves::Kind, explain::Explanation};
#[derive(Clone, Debug, PartialEq)]
pub struct Lesson { pub id: String, pub title: String, pub summary: String, pub minutes: Option<u32>, pub start: Arc<Scene>, pub steps: Vec<Step> }
#[derive(Clone, Debug, PartialEq)]
pub struct Step { pub title: String, pub blocks: Vec<Block>, pub scene: Option<SceneChange>, pub window: WindowChange, pub points: Vec<Control>, pub task: Option<Task> }
#[derive(Clone, Debug, PartialEq)]
pub enum Block { Paragraph(Vec<Run>), Item { number: Option<u64>, depth: usize, runs: Vec<Run> }, Equation(String), Task }
#[derive(Clone, Debug, PartialEq)]
pub struct Run { pub text: String, pub style: RunStyle }
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunStyle { Plain, Emphasis, Strong, Code }
#[derive(Clone, Debug, PartialEq)]
pub enum Task { Predict { question: Vec<Run>, answers: Vec<AnswerChoice> }, Do(Goal), Find(Goal) }
#[derive(Clone, Debug, PartialEq)]
pub struct AnswerChoice { pub text: Vec<Run>, pub right: bool, pub feedback: Vec<Run> }
#[derive(Clone, Debug, PartialEq)]
pub struct Goal { pub text: Vec<Run>, pub until: Condition, pub hint: Option<Vec<Run>> }
#[derive(Clone, Debug, PartialEq)]
pub struct PartName(pub String);
impl PartName { pub fn find(&self, _d: &Scene) -> Option<Selection> { None } }
#[derive(Clone, Debug, PartialEq)]
pub enum Control { Knob(String), Menu(String), Button(String), Tab(String), Part(PartName) }
#[derive(Clone, Debug, PartialEq, Default)]
pub struct WindowChange { pub channel: Option<Option<DebugChannel>>, pub terms: Option<TermSelection>, pub explain: Option<bool>, pub plots: Option<Option<Kind>>, pub active: Option<usize>, pub select: Option<PartName>, pub pin: Option<Option<[f32; 2]>> }
#[derive(Clone, Debug, PartialEq)]
pub struct SceneChange;
impl SceneChange { pub fn apply(&self, s: &Scene, _r: &Registry) -> Result<Scene, String> { Ok(s.clone()) } }
#[derive(Clone, Debug, PartialEq)]
pub struct Problem(pub String);
impl std::fmt::Display for Problem { fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result { f.write_str(&self.0) } }
#[derive(Clone, Debug, PartialEq)]
pub struct Condition(pub String);
pub struct WindowFacts<'a> { pub a: &'a str }
pub struct Situation<'a> { pub scene: &'a Scene, pub registry: &'a Registry, pub selection: Selection, pub window: WindowFacts<'a>, pub probe: Option<&'a Explanation>, pub pinned: bool }
impl Condition { pub fn holds(&self, s: &Situation<'_>) -> bool { s.pinned && s.window.a == self.0 } pub fn missing(&self, _s: &Situation<'_>) -> Option<String> { None } pub fn uses_probe(&self) -> bool { self.0.contains("probe.") } }
impl Task { pub fn goal(&self) -> Option<&Goal> { match self { Self::Predict { .. } => None, Self::Do(g) | Self::Find(g) => Some(g) } } }
impl Lesson { pub fn read(_p: &Path, _r: &Registry) -> Result<Lesson, Vec<Problem>> { Err(vec![]) }
 pub fn state(&self, _s: usize, _r: &Registry) -> Result<Scene, String> { Ok((*self.start).clone()) } }
pub mod shipped { use super::*; use std::sync::LazyLock; pub static LESSONS: LazyLock<Vec<Lesson>> = LazyLock::new(|| {
 let r = |t: &str, style| Run { text: t.into(), style };
 let p = |t: &str| Block::Paragraph(vec![r(t, RunStyle::Plain)]);
 let step = |title: &str, blocks, points, task| Step { title: title.into(), blocks, scene: None, window: WindowChange::default(), points, task };
 let steps = || vec![
  step("Light that hits a surface", vec![p("A surface that faces a light is bright; one that turns away is dark. The cosine of the angle between the normal `x` and the light says how bright: with k_d for the share that is scattered, the diffuse term is"), Block::Equation("I_d = k_d max(0, N·L)\nI = k_a + k_d max(0, N·L) + k_s max(0, N·H)^α".into()), Block::Paragraph(vec![r("Press ", RunStyle::Plain), r("F7", RunStyle::Strong), r(" to see the curve, and turn α up. The ", RunStyle::Plain), r("half vector", RunStyle::Emphasis), r(" is ", RunStyle::Plain), r("normalize(L + V)", RunStyle::Code), r(", halfway between k_s and N·L.", RunStyle::Plain)]), Block::Item { number: None, depth: 0, runs: vec![r("First, a point that does not face the light at all: it gets nothing.", RunStyle::Plain)] }, Block::Item { number: Some(2), depth: 0, runs: vec![r("Second.", RunStyle::Plain)] }, Block::Task], vec![Control::Knob("shininess".into()), Control::Menu("Help".into()), Control::Button("shading".into())], Some(Task::Predict { question: vec![r("The sphere turns. Which part of it stays the brightest?", RunStyle::Plain)], answers: vec![AnswerChoice { text: vec![r("The part that turns with the surface.", RunStyle::Plain)], right: false, feedback: vec![r("No: the light does not move with the surface.", RunStyle::Plain)] }, AnswerChoice { text: vec![r("The part that faces the light, whatever is there: N·L is largest where N = L.", RunStyle::Plain)], right: true, feedback: vec![r("Right. Only the direction of the normal counts.", RunStyle::Plain)] }] })),
  step("Find the brightest vertex", vec![p("Gouraud shading computes light at the corners of triangles."), Block::Task], vec![Control::Knob("tessellation".into())], Some(Task::Find(Goal { text: vec![r("Click the vertex that is brightest.", RunStyle::Plain)], until: Condition("probe.x".into()), hint: Some(vec![r("It is near the light.", RunStyle::Plain)]) }))),
  step("The end", vec![p("That is all.")], vec![], None)];
 let lesson = |id: &str, title: &str| Lesson { id: id.into(), title: title.into(), summary: "How the normal, the light and the observer make a colour, with k_d and k_s.".into(), minutes: Some(10), start: Arc::new(Scene::default()), steps: steps() };
 vec![lesson("model", "What a reflection model is"), lesson("terms", "The three terms"), lesson("where", "Where shading is computed"), lesson("half", "Half vectors and highlights")]
}); }
