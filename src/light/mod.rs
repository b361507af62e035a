//! Light types: the amount and direction of the light that arrives at a point.
//!
//! **To add one**: write `light/x.rs` and `assets/shaders/light/x.wgsl`, and add its name to
//! [`register_builtin`].

use std::fmt;

use bevy::ecs::component::Component;
use glam::Vec3;

use crate::{
    parameter::{Parameter, Values},
    shader::Source,
};

mod ambient;
mod builder;
mod directional;
mod point;
mod spot;

pub use ambient::Ambient;
pub use directional::Directional;
pub use point::Point;
pub use spot::Spot;

/// Receives light types one after the other.
pub trait Take {
    /// Receives the next one.
    fn take<T: LightType>(&mut self);
}

/// The built-in light types, in the order of all lists: the one list.
pub fn register_builtin(to: &mut impl Take) {
    to.take::<Point>();
    to.take::<Spot>();
    to.take::<Directional>();
    to.take::<Ambient>();
}

/// The most lights that a scene may have; the capacity of the light buffer.
pub const MAX_LIGHTS: usize = 256;

/// The most parameters that a light type may declare beside those common to all lights.
pub const MAX_LIGHT_PARAMETERS: usize = 4;

/// The name and properties of a light type.
#[derive(Debug)]
#[non_exhaustive]
pub struct Declaration {
    /// The name in scene files.
    pub id: &'static str,
    /// The name shown to people.
    pub name: &'static str,
    /// One sentence: its behaviour.
    pub summary: &'static str,
    /// A glyph for lists.
    pub glyph: &'static str,
    /// True if it has a position.
    pub has_position: bool,
    /// True if it has a direction.
    pub has_direction: bool,
    /// The unit of its intensity: `cd` or `lx`. For a type in `cd`, [`LightType::solid_angle`] converts it to lumen.
    pub unit: &'static str,
    /// Its intensity if the scene gives none.
    pub default_intensity: f32,
    /// The upper end of a slider for the intensity.
    pub slider_max: f32,
    /// Further numbers, at most [`MAX_LIGHT_PARAMETERS`].
    pub parameters: &'static [Parameter],
    /// The half angle in degrees of the cone that a gizmo should draw: the index in `parameters`.
    pub cone_parameter: Option<usize>,
    /// The equation of the light that arrives at a point, as readable mathematics.
    pub equation: &'static str,
    /// The twin in WGSL: `fn incident_<id>(light: Light, p: vec3<f32>) -> Incident`.
    pub wgsl: Source,
}

/// A light for calculation: decoded colour, unit direction, numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightRecord {
    /// Index of the type in the registry.
    pub light_type: u32,
    /// Its position, metres; zero if the type has none.
    pub position: Vec3,
    /// The direction in which it shines, unit vector; zero if the type has none.
    pub direction: Vec3,
    /// Linear colour.
    pub colour: Vec3,
    /// In the unit of the type.
    pub intensity: f32,
    /// The declared parameters in order.
    pub parameters: [f32; MAX_LIGHT_PARAMETERS],
}

/// The light that arrives at a point from one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Incident {
    /// From one direction: `l`, the unit vector to the light, and the intensity `I(p)`.
    From {
        /// Unit vector from the point to the light.
        l: Vec3,
        /// `I(p)`.
        intensity: f32,
    },
    /// Equal from all directions.
    Uniform {
        /// `I(p)`.
        intensity: f32,
    },
}

/// A light type. The implementing struct is the marker component of entities of the type.
pub trait LightType: Component + Default {
    /// Name, properties, shader.
    const DECLARATION: Declaration;

    /// The light that arrives at `p` (room coordinates).
    fn incident(light: &LightRecord, p: Vec3) -> Incident;

    /// The integral of its profile over all directions, sr, given the declared parameters in order: luminous flux (lm)
    /// over intensity (cd), `Φ = I Ω`. `None` for types without flux, such as light from infinitely far away.
    fn solid_angle(_parameters: &[f32; MAX_LIGHT_PARAMETERS]) -> Option<f64> {
        None
    }
}

/// A registered light type.
#[derive(Clone, Copy)]
pub struct LightEntry {
    /// Name, properties, shader.
    pub declaration: &'static Declaration,
    /// Its number in the registry, by which shaders know the type.
    pub index: u32,
    /// See [`LightType::incident`].
    pub incident: fn(&LightRecord, Vec3) -> Incident,
    /// See [`LightType::solid_angle`].
    solid_angle: fn(&[f32; MAX_LIGHT_PARAMETERS]) -> Option<f64>,
    /// Adds the marker component to an entity.
    pub mark: fn(&mut bevy::ecs::system::EntityCommands),
    /// Removes the marker component from an entity.
    pub unmark: fn(&mut bevy::ecs::system::EntityCommands),
}

impl LightEntry {
    /// The entry of a light type.
    #[must_use]
    pub fn of<L: LightType>() -> Self {
        Self {
            declaration: const { &L::DECLARATION },
            index: 0,
            incident: L::incident,
            solid_angle: L::solid_angle,
            mark: |entity| {
                entity.insert(L::default());
            },
            unmark: |entity| {
                entity.remove::<L>();
            },
        }
    }

    /// Luminous flux over intensity of a light with these parameters, sr; `None` if the type has no flux.
    #[must_use]
    pub fn solid_angle(&self, values: &Values) -> Option<f64> {
        (self.solid_angle)(&self.numbers(values))
    }

    /// True if lights of the type have a luminous flux.
    #[must_use]
    pub fn has_flux(&self) -> bool {
        self.solid_angle(&Values::default()).is_some()
    }

    /// The declared parameters of a light as numbers, in order.
    #[must_use]
    pub fn numbers(&self, values: &Values) -> [f32; MAX_LIGHT_PARAMETERS] {
        let mut numbers = [0.0; MAX_LIGHT_PARAMETERS];
        for (number, parameter) in numbers.iter_mut().zip(self.declaration.parameters) {
            *number = values.number(parameter);
        }
        numbers
    }
}

impl fmt::Debug for LightEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("LightEntry").field(&self.declaration.id).finish()
    }
}
