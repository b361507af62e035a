//! Light types: the amount and direction of the light that arrives at a point.
//!
//! **To add one**: write `light/x.rs` and `assets/shaders/light/x.wgsl`, and add its name to
//! [`register_builtin`].

use bevy_ecs::component::Component;
use bevy_reflect::Reflectable;
use glam::{Vec2, Vec3};

use crate::{
    declared::{entry, forwards, take_each},
    optics::{
        colour::{Encoding, luminance},
        radiometry::{Arriving, SPHERE},
        sampling::power_heuristic,
        sequence::Sequence,
    },
    parameter::{Parameter, ParameterSet, Table, TypeComponent, Value, Values, words},
    shader::Source,
    text::capitalised,
};

mod ambient;
mod builder;
mod cylinder;
mod directional;
mod disc;
mod environment;
pub mod extent;
mod factor;
mod fields;
pub mod ies;
mod outline;
pub mod panorama;
mod photometric;
mod point;
mod rectangle;
mod size;
mod sky;
mod sphere;
mod spot;
mod studio;
mod sun;
mod twin;
mod words;

pub use self::{
    ambient::Ambient, cylinder::Cylinder, directional::Directional, disc::Disc, environment::Environment,
    factor::Factor, photometric::Photometric, point::Point, rectangle::Rectangle, size::Size, sphere::Sphere,
    spot::Spot, sun::Sun, twin::Twin,
};
use extent::{BLOCK, Cone, Directions, Sample, Seen};
pub(crate) use fields::fields;

/// Receives light types one after the other.
pub trait Take {
    /// Receives the next one.
    fn take<T: LightType>(&mut self);
}

/// Registers the built-in light types, in the order of all lists.
pub fn register_builtin(to: &mut impl Take) {
    take_each! {
        to: Point Spot Photometric Directional Ambient Rectangle Disc Sphere Cylinder Sun Environment
    }
}

/// Maximum number of lights in a scene; the capacity of the light buffer.
pub const MAX_LIGHTS: usize = 256;

/// The name and properties of a light type.
#[derive(Debug)]
#[non_exhaustive]
pub struct Declaration {
    /// Name in scene files.
    pub id: &'static str,
    /// Display name.
    pub name: &'static str,
    /// One sentence: the behaviour.
    pub summary: &'static str,
    /// A glyph for lists.
    pub glyph: &'static str,
    /// True if the type has a position.
    pub has_position: bool,
    /// True if the type has a direction.
    pub has_direction: bool,
    /// Unit of the intensity: `cd` or `lx`, or `×` for a factor of the light's own output.
    /// [`LightType::solid_angle`], if there is one, converts the intensity to lumen.
    pub unit: &'static str,
    /// Default intensity.
    pub default_intensity: f32,
    /// Maximum of the intensity slider.
    pub slider_max: f32,
    /// The name of the parameter with the half angle, in degrees, of the cone drawn as a gizmo.
    pub cone_parameter: Option<&'static str>,
    /// Sizes, which have handles in the picture and determine the outline.
    pub sizes: &'static [Size],
    /// The name of the parameter with the rotation about the direction, right-handed, in degrees, which has a
    /// handle in the picture.
    pub roll_parameter: Option<&'static str>,
    /// The equation of the light that arrives at a point, as readable mathematics.
    pub equation: &'static str,
    /// True if the light has extent, covering a range of directions from a point: it then has
    /// [`LightType::sample`] and [`LightType::seen`] instead of [`LightType::incident`].
    pub extent: bool,
    /// The twin in WGSL: `fn incident_<id>(light: Light, m: <Id>Parameters, p: vec3<f32>) -> Incident`, where
    /// the struct contains the parameters by name (see [`parameter_struct`](LightEntry::parameter_struct)); a
    /// type without parameters has no `m`. A type with extent has `sample_<id>(light, m, p, u: vec2<f32>) ->
    /// LightSample` and `seen_<id>(light, m, p, l: vec3<f32>) -> LightSeen` instead.
    pub wgsl: Source,
}

/// The fields shared by lights of all types, ready for calculation: decoded colour, unit direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightRecord {
    /// Index of the type in the registry.
    pub light_type: u32,
    /// Position, in metres; zero if the type has none.
    pub position: Vec3,
    /// Direction in which the light shines, a unit vector; zero if the type has none.
    pub direction: Vec3,
    /// Linear colour.
    pub colour: Vec3,
    /// Intensity, in the unit of the type.
    pub intensity: f32,
}

/// The light that arrives at a point from one light, for red, green and blue; the light loop multiplies it by
/// the colour of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Incident {
    /// From one direction: `l`, the unit vector to the light, and the intensity `I(p)`.
    From {
        /// Unit vector from the point to the light.
        l: Vec3,
        /// `I(p)`.
        intensity: Vec3,
    },
    /// Uniform from all directions.
    Uniform {
        /// `I(p)`.
        intensity: Vec3,
    },
}

/// A light type. The implementing struct contains its parameters (see [`parameters!`](crate::parameters)),
/// and is a component of the entities of the type.
pub trait LightType: ParameterSet + Component + Reflectable {
    /// Name, properties, shader.
    const DECLARATION: Declaration;

    /// Numbers calculated in advance for the twin in WGSL: additional fields of its parameters there, with
    /// the values of [`derived`](Self::derived).
    const DERIVED: &'static [Parameter] = &[];

    /// The values of [`DERIVED`](Self::DERIVED).
    fn derived(&self) -> Vec<f32> {
        Vec::new()
    }

    /// The light arriving at `p` (room coordinates); none for a type with extent, which has
    /// [`sample`](Self::sample) and [`seen`](Self::seen) instead.
    fn incident(&self, _light: &LightRecord, _p: Vec3) -> Incident {
        Incident::From { l: Vec3::Y, intensity: Vec3::ZERO }
    }

    /// A direction from `p` to a light with extent, for a point of the unit square. Any density is valid that
    /// equals that of [`seen`](Self::seen) in this direction, and is nonzero wherever the light shines; the
    /// closer it is to the radiance, the less noise.
    fn sample(&self, _light: &LightRecord, _p: Vec3, _u: Vec2) -> Sample {
        Sample::default()
    }

    /// Calls [`sample`](Self::sample) for several points. A type may calculate shared quantities once.
    fn samples(&self, light: &LightRecord, p: Vec3, points: &[Vec2], to: &mut [Sample]) {
        for (to, u) in to.iter_mut().zip(points) {
            *to = self.sample(light, p, *u);
        }
    }

    /// A light with extent, seen in a direction from `p`. Inside, on and behind a light: nothing, or finite
    /// numbers.
    fn seen(&self, _light: &LightRecord, _p: Vec3, _l: Vec3) -> Seen {
        Seen::NOTHING
    }

    /// A cone of directions from `p` outside which nothing of a light with extent is [`seen`](Self::seen), to
    /// speed up pictures. By default `None`: the light may be anywhere.
    fn bounds(&self, _light: &LightRecord, _p: Vec3) -> Option<Cone> {
        None
    }

    /// The radiance of an infinitely distant light, if it is the same in all directions between these four,
    /// which are the corners of a convex part of the picture. By default `None`: the light is evaluated in each
    /// direction.
    fn same_between(&self, _light: &LightRecord, _corners: &[Vec3; 4]) -> Option<Vec3> {
        None
    }

    /// The solid angle that a light with extent fills as seen from `p`, sr, if a formula gives it. By default `None`: it is
    /// estimated by samples.
    fn fills(&self, _light: &LightRecord, _p: Vec3) -> Option<f64> {
        None
    }

    /// The factors of the intensity at `p`, as in the [equation](Declaration::equation), for explanations:
    /// their product is the intensity of [`incident`](Self::incident). By default, the intensity of the
    /// light, and the rest.
    fn factors(&self, light: &LightRecord, p: Vec3) -> Vec<Factor> {
        factor::whole(self.incident(light, p), light, Self::DECLARATION.unit)
    }

    /// The integral of the light's profile over all directions, sr: luminous flux (lm) divided by intensity
    /// (cd), `Φ = I Ω`. `None` for types without flux, such as infinitely distant light.
    fn solid_angle(&self) -> Option<f64> {
        None
    }

    /// The unit of the intensity with these parameters, by default that of the declaration.
    fn unit(&self) -> &'static str {
        Self::DECLARATION.unit
    }
}

/// A light type with its parameters set: the object-safe half of [`LightType`].
pub trait Emitter: Send + Sync {
    /// See [`LightType::incident`].
    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident;

    /// See [`LightType::sample`].
    fn sample(&self, light: &LightRecord, p: Vec3, u: Vec2) -> Sample;

    /// See [`LightType::seen`].
    fn seen(&self, light: &LightRecord, p: Vec3, l: Vec3) -> Seen;

    /// Radiance and distance in each direction, as of [`seen`](Self::seen): the type is dispatched once for all of
    /// them, and densities are not calculated.
    fn seen_along(&self, light: &LightRecord, p: Vec3, directions: &[Vec3], to: &mut [(Vec3, f32)]);

    /// See [`LightType::bounds`].
    fn bounds(&self, light: &LightRecord, p: Vec3) -> Option<Cone>;

    /// See [`LightType::same_between`].
    fn same_between(&self, light: &LightRecord, corners: &[Vec3; 4]) -> Option<Vec3>;

    /// See [`LightType::fills`].
    fn fills(&self, light: &LightRecord, p: Vec3) -> Option<f64>;

    /// See [`LightType::factors`].
    fn factors(&self, light: &LightRecord, p: Vec3) -> Vec<Factor>;
}

impl<L: LightType> Emitter for L {
    forwards! {
        |this| this => LightType:
        fn incident(light: &LightRecord, p: Vec3) -> Incident;
        fn sample(light: &LightRecord, p: Vec3, u: Vec2) -> Sample;
        fn seen(light: &LightRecord, p: Vec3, l: Vec3) -> Seen;
        fn bounds(light: &LightRecord, p: Vec3) -> Option<Cone>;
        fn same_between(light: &LightRecord, corners: &[Vec3; 4]) -> Option<Vec3>;
        fn fills(light: &LightRecord, p: Vec3) -> Option<f64>;
        fn factors(light: &LightRecord, p: Vec3) -> Vec<Factor>;
    }

    fn seen_along(&self, light: &LightRecord, p: Vec3, directions: &[Vec3], to: &mut [(Vec3, f32)]) {
        for (l, to) in directions.iter().zip(to) {
            let seen = LightType::seen(self, light, p, *l);
            *to = (seen.radiance, seen.distance);
        }
    }
}

/// Number of lights calculated together.
pub const AT_ONCE: usize = 8;

/// Lights of one type, calculated together, so that the type is dispatched once instead of for each light.
pub trait Emitters: Send + Sync {
    /// The number of lights.
    fn count(&self) -> usize;

    /// The light arriving at `p` from the [`AT_ONCE`] lights starting with `first`: writes those that shine
    /// there from a direction to `to` and returns their number, and the sum of the others, which are uniform.
    fn arrive(&self, first: usize, p: Vec3, to: &mut [Arriving; AT_ONCE]) -> (usize, Vec3);

    /// For lights with extent: adds the weighted light arriving at `p` from each of these lobe directions.
    fn meet(&self, p: Vec3, directions: &mut Directions);

    /// For lights with extent: the radiance arriving at `p` from a direction, including their colours. Densities are not
    /// calculated.
    fn seen(&self, p: Vec3, l: Vec3) -> Vec3;

    /// For a light with extent: false if all of it lies below the surface at `p` with the normal `n`,
    /// according to its [`bounds`](LightType::bounds).
    fn rises(&self, light: usize, p: Vec3, n: Vec3) -> bool;

    /// For a light with extent: directions to it from `p` for at most [`BLOCK`] points of the unit square;
    /// the radiance includes the colour of the light.
    fn send(&self, light: usize, p: Vec3, points: &[Vec2]) -> [Sample; BLOCK];
}

impl<L: LightType> Emitters for Vec<(L, LightRecord)> {
    fn count(&self) -> usize {
        self.len()
    }

    fn arrive(&self, first: usize, p: Vec3, to: &mut [Arriving; AT_ONCE]) -> (usize, Vec3) {
        let (mut count, mut uniform) = (0, Vec3::ZERO);
        for (emitter, light) in self.iter().skip(first).take(AT_ONCE) {
            match LightType::incident(emitter, light, p) {
                // Nothing to calculate outside the cone.
                Incident::From { l, intensity } => {
                    if intensity != Vec3::ZERO {
                        to[count] = Arriving { l, light: intensity * light.colour };
                        count += 1;
                    }
                }
                Incident::Uniform { intensity } => uniform += intensity * light.colour,
            }
        }
        (count, uniform)
    }

    fn meet(&self, p: Vec3, directions: &mut Directions) {
        for (emitter, light) in self {
            for i in 0..BLOCK {
                if directions.pdf[i] <= 0.0 {
                    continue;
                }
                let seen = LightType::seen(emitter, light, p, directions.l[i]);
                if seen.radiance != Vec3::ZERO {
                    let weight = power_heuristic(directions.pdf[i], seen.pdf);
                    directions.light[i] += seen.radiance * light.colour * weight;
                }
            }
        }
    }

    fn seen(&self, p: Vec3, l: Vec3) -> Vec3 {
        self.iter()
            .map(|(emitter, light)| LightType::seen(emitter, light, p, l).radiance * light.colour)
            .sum()
    }

    fn rises(&self, light: usize, p: Vec3, n: Vec3) -> bool {
        let bounds = self.get(light).and_then(|(emitter, light)| LightType::bounds(emitter, light, p));
        // An angle is at least its sine.
        bounds.is_none_or(|cone| cone.axis.dot(n) >= -cone.half_angle)
    }

    fn send(&self, light: usize, p: Vec3, points: &[Vec2]) -> [Sample; BLOCK] {
        let mut sent = [Sample::default(); BLOCK];
        if let Some((emitter, light)) = self.get(light) {
            emitter.samples(light, p, points, &mut sent);
            sent.iter_mut().for_each(|sample| sample.radiance *= light.colour);
        }
        sent
    }
}

/// A registered light type.
#[derive(Clone, Copy)]
pub struct LightEntry {
    /// Name, properties, shader.
    pub declaration: &'static Declaration,
    /// Parameters of the type.
    pub parameters: &'static [Parameter],
    /// Index in the registry, which identifies the type in shaders.
    pub index: u32,
    /// Creates the type with the parameters of one light.
    pub instantiate: fn(&Values, Encoding) -> Box<dyn Emitter>,
    /// Creates a group of lights of the type.
    pub group: fn(&[(&Values, LightRecord)], Encoding) -> Box<dyn Emitters>,
    /// Component of the type.
    pub component: TypeComponent,
    solid_angle: fn(&Values) -> Option<f64>,
    unit: fn(&Values) -> &'static str,
    derived: &'static [Parameter],
    derive: fn(&Values, Encoding) -> Vec<f32>,
}

impl LightEntry {
    /// The entry of a light type.
    #[must_use]
    pub fn of<L: LightType>() -> Self {
        Self {
            declaration: const { &L::DECLARATION },
            parameters: L::PARAMETERS,
            index: 0,
            instantiate: |values, encoding| Box::new(L::from_values(values, encoding)),
            group: |lights, encoding| {
                let light =
                    |(values, record): &(&Values, LightRecord)| (L::from_values(values, encoding), *record);
                Box::new(lights.iter().map(light).collect::<Vec<_>>())
            },
            component: TypeComponent::of::<L>(),
            solid_angle: |values| L::from_values(values, Encoding::default()).solid_angle(),
            unit: |values| L::from_values(values, Encoding::default()).unit(),
            derived: L::DERIVED,
            derive: |values, encoding| L::from_values(values, encoding).derived(),
        }
    }

    /// Luminous flux divided by intensity of a light with these parameters, sr; `None` if the type has no
    /// flux.
    #[must_use]
    pub fn solid_angle(&self, values: &Values) -> Option<f64> {
        (self.solid_angle)(values)
    }

    /// Unit of the intensity of a light with these parameters.
    #[must_use]
    pub fn unit(&self, values: &Values) -> &'static str {
        (self.unit)(values)
    }

    /// The mean luminance over all directions, cd/m², of a light with these parameters and the intensity 1, by its samples:
    /// `∫ L dω / 4π`. `None` for a light that is somewhere, or without extent: it has none that is the same everywhere.
    #[must_use]
    pub fn mean_luminance(&self, values: &Values) -> Option<f64> {
        /// With Sobol's points, the mean of a sky or a studio is off by less than 0.2 %.
        const SAMPLES: u32 = 4096;
        let d = self.declaration;
        if !d.extent || d.has_position || d.has_direction {
            return None;
        }
        let emitter = (self.instantiate)(values, Encoding::default());
        let light = LightRecord { colour: Vec3::ONE, intensity: 1.0, ..LightRecord::default() };
        let sequence = Sequence::new(0, 1);
        let sum: f64 = (0..SAMPLES)
            .map(|i| emitter.sample(&light, Vec3::ZERO, sequence.point(i)))
            .filter(|sample| sample.pdf > 0.0)
            .map(|sample| f64::from(luminance(sample.radiance) / sample.pdf))
            .sum();
        Some(sum / (f64::from(SAMPLES) * SPHERE))
    }

    /// True if lights of the type have a luminous flux.
    #[must_use]
    pub fn has_flux(&self) -> bool {
        self.solid_angle(&Values::default()).is_some()
    }

    /// The parameter with the half angle, in degrees, of the cone drawn as a gizmo.
    #[must_use]
    pub fn cone_parameter(&self) -> Option<&'static Parameter> {
        self.parameter(self.declaration.cone_parameter?)
    }

    /// The parameter with the rotation about the direction, in degrees.
    #[must_use]
    pub fn roll_parameter(&self) -> Option<&'static Parameter> {
        self.parameter(self.declaration.roll_parameter?)
    }

    /// The half angle, in degrees, of the cone drawn as a gizmo.
    #[must_use]
    pub fn cone_angle(&self, values: &Values) -> Option<f32> {
        Some(values.number(self.cone_parameter()?))
    }

    /// True if lights of the type with these parameters are visible in the picture: those with extent, unless
    /// their parameter `visible` is off.
    #[must_use]
    pub fn is_visible(&self, values: &Values) -> bool {
        self.declaration.extent && self.parameter("visible").is_none_or(|visible| values.choice(visible) == 1)
    }

    /// Position of the parameter `visible` among the [`words`](Self::words), which is 1 for visible lights;
    /// `None` if the type has no such parameter.
    #[must_use]
    pub fn visible_word(&self) -> Option<usize> {
        let at = self.parameters.iter().position(|p| p.name == "visible")?;
        Some(words(&self.parameters[..at], &Values::default(), Encoding::default()).len())
    }

    /// The fields of the type's [struct in WGSL](Self::parameter_struct): its parameters, and numbers derived
    /// from them.
    #[must_use]
    pub fn fields(&self) -> Vec<Parameter> {
        self.parameters.iter().chain(self.derived).cloned().collect()
    }

    /// The fields of a light in the shader's layout, in order and without padding.
    #[must_use]
    pub fn words(&self, values: &Values, encoding: Encoding) -> Vec<u32> {
        let mut words = words(self.parameters, values, encoding);
        words.extend((self.derive)(values, encoding).into_iter().map(f32::to_bits));
        words
    }

    /// The files used by a light, each with the position of its parameter among the [`words`](Self::words).
    #[must_use]
    pub fn tables(&self, values: &Values) -> Vec<(usize, Table)> {
        let mut at = 0;
        let mut tables = Vec::new();
        for p in self.parameters {
            let is_used = p.used_when.is_none_or(|condition| {
                let other = self.parameter(condition.parameter).map(|other| values.get(other));
                matches!(other, Some(Value::Choice(id)) if condition.choices.contains(&&*id))
            });
            tables.extend(values.table(p).filter(|_| is_used).map(|table| (at, table)));
            at += words(std::slice::from_ref(p), values, Encoding::default()).len();
        }
        tables
    }

    /// The name of the parameter struct in WGSL: `SpotParameters` for the id `spot`.
    #[must_use]
    pub fn parameter_struct(&self) -> String {
        self.declaration.id.split('_').map(capitalised).collect::<String>() + "Parameters"
    }
}

entry!(LightEntry);

#[cfg(test)]
mod tests;
