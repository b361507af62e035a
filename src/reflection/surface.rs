//! A model with its parameters set.

use std::{f32::consts::PI, sync::OnceLock};

use glam::{DVec3, Vec3, Vec4};

use super::{declaration::Ambient, factor::Factor, model::ReflectionModel, readout::Readout};
use crate::{
    declared::forwards,
    optics::{
        Frame, TermSelection, Terms,
        albedo::{self, AlbedoCurve, LobeAlbedo},
        interior::Interior,
        lobes::Lobes,
        radiometry::Arriving,
        sharp::Sharps,
    },
};

/// A model with its parameters set: the object-safe half of [`ReflectionModel`].
pub trait Surface: Send + Sync {
    /// See [`ReflectionModel::response`].
    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms;
    /// True if light passes through the surface, so that light from below counts.
    fn transmits(&self) -> bool {
        false
    }
    /// See [`Declaration::lit_from_below`](super::Declaration::lit_from_below).
    fn lit_from_below(&self) -> bool {
        false
    }
    /// See [`ReflectionModel::sharp`].
    fn sharp(&self, _v: Vec3, _frame: &Frame) -> Sharps {
        Sharps::new()
    }
    /// See [`ReflectionModel::spreads`].
    fn spreads(&self) -> bool {
        true
    }
    /// See [`ReflectionModel::interior`].
    fn interior(&self) -> Option<Interior> {
        None
    }
    /// See [`ReflectionModel::behind`].
    fn behind(&self, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
        self.response(v, l, frame).transmitted / (PI * frame.n.dot(v).abs())
    }
    /// See [`ReflectionModel::refractive_index`].
    fn refractive_index(&self) -> Option<f32> {
        None
    }
    /// See [`ReflectionModel::entering`].
    fn entering(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        Vec3::ONE
    }
    /// The response to uniform light of 1 lx, from a formula or the albedo.
    fn ambient_response(&self, v: Vec3, frame: &Frame) -> Vec3;
    /// The part of uniform light above the surface that is mirrored to the viewer, without spreading.
    fn mirrored(&self, v: Vec3, frame: &Frame) -> Vec3 {
        let sharp = self.sharp(v, frame);
        sharp.iter().filter(|sharp| !sharp.transmitted).map(|sharp| sharp.share).sum()
    }
    /// The directional albedo for a viewer in the local frame: the part of uniform light above the surface that reaches
    /// it, spread or [mirrored](Self::mirrored).
    fn directional_albedo(&self, v: Vec3) -> DVec3 {
        let frame = &Frame::LOCAL;
        albedo::directional(|l| self.response(l, v, frame), v, frame) + self.mirrored(v, frame).as_dvec3()
    }
    /// The directional albedo over the view, for models that declare [`Ambient::Albedo`].
    fn curve(&self) -> Option<AlbedoCurve>;
    /// See [`ReflectionModel::lobe`].
    fn lobe(&self) -> Option<LobeAlbedo> {
        None
    }
    /// See [`ReflectionModel::curves`].
    fn curves(&self) -> Vec<Vec4> {
        Vec::new()
    }
    /// See [`ReflectionModel::lobes`].
    fn lobes(&self) -> Lobes {
        Lobes::default()
    }
    /// See [`ReflectionModel::readouts`].
    fn readouts(&self) -> Vec<Readout> {
        Vec::new()
    }
    /// See [`ReflectionModel::uncertainty`].
    fn uncertainty(&self, _l: Vec3, _v: Vec3, _frame: &Frame) -> Option<f32> {
        None
    }
    /// See [`ReflectionModel::measured_near`].
    fn measured_near(&self, l: Vec3, v: Vec3) -> Option<(Vec3, Vec3)> {
        Some((l, v))
    }
    /// See [`ReflectionModel::factor`].
    fn factor(&self, _factor: Factor) -> Option<Vec3> {
        None
    }

    /// A quantity of the equation without a definition there; see [`ReflectionModel::quantity`]. Custom
    /// models also provide values from their WGSL for these directions.
    fn quantity(
        &self,
        _symbol: &str,
        _arguments: &[f32],
        _l: Vec3,
        _v: Vec3,
        _frame: &Frame,
    ) -> Option<Vec3> {
        None
    }

    /// The BSDF in sr⁻¹ for pairs of directions in the local frame, as of [`bsdf`]. Each model has its own copy of this loop.
    fn bsdfs(&self, l: &[[f32; 3]], v: &[[f32; 3]], out: &mut [[f32; 3]]) {
        for ((l, v), out) in l.iter().zip(v).zip(out) {
            *out = of_pair(self, Vec3::from_array(*l), Vec3::from_array(*v), &Frame::LOCAL).to_array();
        }
    }

    /// See [`ReflectionModel::lit_together`].
    fn lit_together(
        &self,
        _lights: &[Arriving],
        _v: Vec3,
        _frame: &Frame,
        _terms: TermSelection,
    ) -> Option<Vec3> {
        None
    }

    /// The light that leaves towards `v` under these lights: the sum of the responses. Each model has its own
    /// copy of this loop, from which the compiler hoists everything that depends only on the object or the
    /// view.
    fn lit_by(&self, lights: &[Arriving], v: Vec3, frame: &Frame, terms: TermSelection) -> Vec3 {
        if let Some(all) = self.lit_together(lights, v, frame, terms) {
            return all;
        }
        let respond = |l: Vec3| self.response(l, v, frame);
        match terms {
            TermSelection::All => sum(lights, |l| respond(l).select(TermSelection::All)),
            TermSelection::Ambient => sum(lights, |l| respond(l).ambient),
            TermSelection::Diffuse => sum(lights, |l| respond(l).diffuse),
            TermSelection::Specular => sum(lights, |l| respond(l).specular),
            TermSelection::Transmitted => sum(lights, |l| respond(l).transmitted),
        }
    }
}

fn sum(lights: &[Arriving], response: impl Fn(Vec3) -> Vec3) -> Vec3 {
    lights.iter().fold(Vec3::ZERO, |sum, at| sum + response(at.l) * at.light)
}

/// The part of uniform light that reaches the viewer through the surface or without spreading, from `count` samples of
/// the lobes.
fn beyond<M: ReflectionModel>(model: &M, v: Vec3, frame: &Frame, count: u32) -> Vec3 {
    let sharp: Vec3 = model.sharp(v, frame).iter().map(|sharp| sharp.share).sum();
    sharp + albedo::through(|l| model.response(l, v, frame).transmitted, &model.lobes(), v, frame, count)
}

/// Samples of the transmitted light in a curve, and in a single value.
const IN_CURVES: u32 = 1 << 12;
const ALONE: u32 = 1 << 16;

fn curve_of<M: ReflectionModel>(model: &M) -> Option<AlbedoCurve> {
    (M::DECLARATION.ambient == Ambient::Albedo).then(|| {
        let anisotropic = M::DECLARATION.anisotropic;
        let curve = AlbedoCurve::new(|l, v| model.response(l, v, &Frame::LOCAL), anisotropic);
        if !model.passage().transmits {
            return curve;
        }
        curve.with(|v| beyond(model, v, &Frame::LOCAL, IN_CURVES), anisotropic)
    })
}

/// A model on its own: it recalculates its albedo at every call, to [`albedo::ACCURACY`].
impl<M: ReflectionModel> Surface for M {
    forwards! {
        |this| this => ReflectionModel:
        fn response(l: Vec3, v: Vec3, frame: &Frame) -> Terms;
        fn lit_together(lights: &[Arriving], v: Vec3, frame: &Frame, terms: TermSelection) -> Option<Vec3>;
        fn sharp(v: Vec3, frame: &Frame) -> Sharps;
        fn spreads() -> bool;
        fn interior() -> Option<Interior>;
        fn behind(l: Vec3, v: Vec3, frame: &Frame) -> Vec3;
        fn refractive_index() -> Option<f32>;
        fn entering(v: Vec3, frame: &Frame) -> Vec3;
        fn lobe() -> Option<LobeAlbedo>;
        fn curves() -> Vec<Vec4>;
        fn lobes() -> Lobes;
        fn readouts() -> Vec<Readout>;
        fn uncertainty(l: Vec3, v: Vec3, frame: &Frame) -> Option<f32>;
        fn measured_near(l: Vec3, v: Vec3) -> Option<(Vec3, Vec3)>;
        fn factor(factor: Factor) -> Option<Vec3>;
    }

    fn transmits(&self) -> bool {
        self.passage().transmits
    }

    fn lit_from_below(&self) -> bool {
        M::DECLARATION.lit_from_below
    }

    fn ambient_response(&self, v: Vec3, frame: &Frame) -> Vec3 {
        match M::DECLARATION.ambient {
            Ambient::Formula => ReflectionModel::ambient_response(self, v, frame),
            Ambient::Albedo => {
                let response = |l| ReflectionModel::response(self, l, v, frame);
                let reflected = albedo::directional(response, v, frame).as_vec3();
                if !self.passage().transmits {
                    return reflected;
                }
                reflected + beyond(self, v, frame, ALONE)
            }
        }
    }

    fn curve(&self) -> Option<AlbedoCurve> {
        curve_of(self)
    }

    fn quantity(&self, symbol: &str, arguments: &[f32], _: Vec3, _: Vec3, _: &Frame) -> Option<Vec3> {
        ReflectionModel::quantity(self, symbol, arguments)
    }
}

/// A model that calculates its curve at the first call and then uses it: for pictures.
pub(super) struct Instance<M> {
    pub(super) model: M,
    pub(super) curve: OnceLock<Option<AlbedoCurve>>,
}

impl<M: ReflectionModel> Surface for Instance<M> {
    forwards! {
        |this| &this.model => ReflectionModel:
        fn response(l: Vec3, v: Vec3, frame: &Frame) -> Terms;
        fn lit_together(lights: &[Arriving], v: Vec3, frame: &Frame, terms: TermSelection) -> Option<Vec3>;
        fn sharp(v: Vec3, frame: &Frame) -> Sharps;
        fn spreads() -> bool;
        fn interior() -> Option<Interior>;
        fn behind(l: Vec3, v: Vec3, frame: &Frame) -> Vec3;
        fn refractive_index() -> Option<f32>;
        fn entering(v: Vec3, frame: &Frame) -> Vec3;
        fn lobe() -> Option<LobeAlbedo>;
        fn curves() -> Vec<Vec4>;
        fn lobes() -> Lobes;
        fn readouts() -> Vec<Readout>;
        fn uncertainty(l: Vec3, v: Vec3, frame: &Frame) -> Option<f32>;
        fn measured_near(l: Vec3, v: Vec3) -> Option<(Vec3, Vec3)>;
        fn factor(factor: Factor) -> Option<Vec3>;
    }

    fn transmits(&self) -> bool {
        self.model.passage().transmits
    }

    fn lit_from_below(&self) -> bool {
        M::DECLARATION.lit_from_below
    }

    fn ambient_response(&self, v: Vec3, frame: &Frame) -> Vec3 {
        match self.curve.get_or_init(|| self.model.curve()) {
            Some(curve) => curve.at(v, frame),
            None => ReflectionModel::ambient_response(&self.model, v, frame),
        }
    }

    fn curve(&self) -> Option<AlbedoCurve> {
        *self.curve.get_or_init(|| self.model.curve())
    }

    fn quantity(&self, symbol: &str, arguments: &[f32], _: Vec3, _: Vec3, _: &Frame) -> Option<Vec3> {
        ReflectionModel::quantity(&self.model, symbol, arguments)
    }
}

/// The BSDF in sr⁻¹ for directions on all sides of a surface: [`brdf`], and [`Surface::behind`] for viewers behind surfaces
/// that light passes through.
#[must_use]
pub fn bsdf(surface: &dyn Surface, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
    of_pair(surface, l, v, frame)
}

#[inline]
fn of_pair<S: Surface + ?Sized>(surface: &S, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
    let [cos_l, cos_v] = [l, v].map(|d| frame.n.dot(d));
    if cos_v < 0.0 && cos_l > 0.0 && surface.transmits() {
        return surface.behind(l, v, frame);
    }
    brdf_of(surface.response(l, v, frame), l, v, frame)
}

/// The BSDF `f` in sr⁻¹ of a surface: its response over `π |cos θ_i|`, without the ambient term. Zero where the light
/// or the viewer is below the surface, unless light passes through.
#[must_use]
pub fn brdf(surface: &dyn Surface, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
    brdf_of(surface.response(l, v, frame), l, v, frame)
}

/// The BSDF `f` in sr⁻¹ of a response; see [`brdf`].
#[must_use]
pub fn brdf_of(response: Terms, l: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
    let Some((cos_i, _)) = frame.cosines(l, v) else {
        let below = frame.n.dot(l).abs();
        return if below > 0.0 { response.transmitted / (PI * below) } else { Vec3::ZERO };
    };
    (response.diffuse + response.specular) / (PI * cos_i)
}
