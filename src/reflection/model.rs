//! The trait of reflection models.

use std::f32::consts::PI;

use glam::{Vec3, Vec4};

use super::{
    declaration::Declaration, factor::Factor, group::Group, passage::Passage, preset::Measured,
    readout::Readout,
};
use crate::{
    optics::{
        Frame, TermSelection, Terms,
        albedo::{LobeAlbedo, NamedCurve},
        interior::Interior,
        lobes::Lobes,
        radiometry::Arriving,
        sharp::Sharps,
    },
    parameter::{ParameterSet, Value, Values},
};

/// The curves of a model as JavaScript, for web pages.
#[derive(Clone, Copy, Debug)]
pub struct OnPages {
    /// A JavaScript function, `(m, table) => curves`: from the parameters by name, with colours as linear
    /// light, to the quadruples of each of the [`CURVES`](ReflectionModel::CURVES) by name, as in
    /// [`ReflectionModel::curves`].
    pub script: &'static str,
    /// Numbers that the function reads; often empty.
    pub table: fn() -> Vec<f32>,
}

/// A reflection model. The implementing struct contains its parameters (see
/// [`parameters!`](crate::parameters)).
pub trait ReflectionModel: ParameterSet + Clone {
    /// Name, source, laws, equation, shader.
    const DECLARATION: Declaration;

    /// Parameters in groups, such as one for each layer of the surface. Ungrouped parameters come before the
    /// groups.
    const GROUPS: &'static [Group] = &[];

    /// True if the model has a [`lobe`](Self::lobe); then its WGSL may call
    /// `lobe_albedo(mu)` and `average_lobe_albedo()`.
    const LOBE: bool = false;

    /// Additional curves over a cosine that the model calculates once per surface, see
    /// [`curves`](Self::curves). The WGSL of the model may call `curve_NAME(mu)` and `mean_NAME()` for each.
    const CURVES: &'static [NamedCurve] = &[];

    /// The curves as JavaScript, for web pages that change parameters without the program. A model with
    /// [`CURVES`](Self::CURVES) but without this has fixed parameters there, which the export reports.
    const ON_PAGES: Option<OnPages> = None;

    /// The [`interior`](Self::interior) as a JavaScript function, `(m, curves) => [n, B, α, σ for red, green and blue]`, for web
    /// pages that change parameters without the program: `m` has them by name, with colours as linear light, `curves` the
    /// [`CURVES`](Self::CURVES). A model of a solid body without this has fixed parameters there, which the export reports.
    const INTERIOR_ON_PAGES: Option<&'static str> = None;

    /// The passage of light through surfaces with these parameters, for models whose parameters decide that; `None` for
    /// those that are as [declared](Declaration::passage). Called for every object that changes, so it must be quick.
    /// Equivalent to [`passage`](Self::passage), without the model.
    const PASSAGE: Option<fn(&Values) -> Passage> = None;

    /// The passage of light through the surface.
    fn passage(&self) -> Passage {
        Self::DECLARATION.passage()
    }

    /// The response `π f_r(l, v) cos θ_i` to a light of unit intensity, by term; for the models of the CA, their
    /// formula as published. Finite for all unit vectors and legal parameters. Of a model that is
    /// [declared](Declaration::transmits) to transmit, also for light on the other side of the surface than the viewer:
    /// then `π f_t(l, v) |cos θ_i|` as [`Terms::through`]. Others give zero there.
    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms;

    /// The light that leaves towards `v` under several lights: the sum of the [`response`](Self::response) to each, times its light;
    /// `None` if it is calculated one by one. Worth writing for a model that needs long for the view alone, or is faster with
    /// several lights at once.
    fn lit_together(
        &self,
        _lights: &[Arriving],
        _v: Vec3,
        _frame: &Frame,
        _terms: TermSelection,
    ) -> Option<Vec3> {
        None
    }

    /// The directions from which light reaches the viewer without spreading, by reflection or transmission at a smooth
    /// surface, for models that are [declared](Declaration::sharp) to have any. Only light with extent is seen in them.
    fn sharp(&self, _v: Vec3, _frame: &Frame) -> Sharps {
        Sharps::new()
    }

    /// False if all light reaches the viewer [without spreading](Self::sharp), so that [`response`](Self::response) is zero in
    /// all directions and need not be asked: of a smooth boundary of glass.
    fn spreads(&self) -> bool {
        true
    }

    /// The inside of a solid body, for models of such: the light that enters follows the object's own mesh, which must be
    /// closed, and is the transmitted term. [`response`](Self::response) is then that of the outer boundary alone.
    fn interior(&self) -> Option<Interior> {
        None
    }

    /// The BSDF in sr⁻¹ for light above the surface and a viewer below it, within the body if there is one, for plots. The
    /// default exchanges the two directions, as reciprocity allows where the same medium is on both sides.
    fn behind(&self, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
        self.response(v, l, frame).transmitted / (PI * frame.n.dot(v).abs())
    }

    /// The refractive index of the body behind the surface relative to the room, for models in which light is bent by
    /// Snell's law: explanations then give the angles.
    fn refractive_index(&self) -> Option<f32> {
        self.interior().map(|interior| interior.ior)
    }

    /// The part of the light from within a solid body that reaches the viewer through what lies on its surface, such as
    /// paint that covers some of it. The twin in WGSL is `entering`.
    fn entering(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        Vec3::ONE
    }

    /// The response to uniform light of 1 lx, for models that declare [`Ambient::Formula`](super::Ambient::Formula); not called for others.
    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        Vec3::ZERO
    }

    /// The albedo of the specular lobe alone with F = 1, for models that compensate multiple scattering and
    /// set [`LOBE`](Self::LOBE). A model stores it as a derived field (see
    /// [`parameters!`](crate::parameters)); the shader receives the same numbers.
    fn lobe(&self) -> Option<LobeAlbedo> {
        None
    }

    /// The values of the [`CURVES`](Self::CURVES), in their order: for each the nodes, then the mean. A model
    /// stores them as derived fields, like the lobe; [`Albedos`](crate::optics::albedo::Albedos) and
    /// [`Lines`](crate::optics::albedo::Lines) provide them in this form.
    fn curves(&self) -> Vec<Vec4> {
        Vec::new()
    }

    /// The directions in which the model reflects most, for sampling light with extent. Any lobes give the
    /// same picture eventually, good ones sooner. A matte model has a cosine alone.
    fn lobes(&self) -> Lobes {
        match Self::DECLARATION {
            Declaration { transmits: true, .. } => Lobes::of_both_sides(),
            Declaration { matte: true, .. } => Lobes::cosine(),
            _ => Lobes::default(),
        }
    }

    /// Derived values that help interpret the parameters: the reflectance at normal incidence, the roughness
    /// on another scale.
    fn readouts(&self) -> Vec<Readout> {
        Vec::new()
    }

    /// The standard uncertainty of a measured BRDF in sr⁻¹, for plots; `None` if it is not known.
    fn uncertainty(&self, _l: Vec3, _v: Vec3, _frame: &Frame) -> Option<f32> {
        None
    }

    /// The pair of directions in the local frame nearest to another for which a measurement has a value of its own, without
    /// interpolation: there fits compare models with it. `None` if the nearest one was not measured.
    fn measured_near(&self, l: Vec3, v: Vec3) -> Option<(Vec3, Vec3)> {
        Some((l, v))
    }

    /// A single factor of the lobe, as used by [`response`](Self::response), for plots. `None` at all angles
    /// for a factor that the model lacks.
    fn factor(&self, _factor: Factor) -> Option<Vec3> {
        None
    }

    /// A quantity used in the [equation](Declaration::equation) without a definition there, such as an albedo
    /// from a table: by its symbol, and the arguments of a function, `E(N·L)`. `None` for any other.
    fn quantity(&self, _symbol: &str, _arguments: &[f32]) -> Option<Vec3> {
        None
    }

    /// The parameters that turn the surface into a measured material; `None` if the model cannot represent it.
    fn preset(_material: &Measured) -> Vec<(&'static str, Value)> {
        Vec::new()
    }
}
