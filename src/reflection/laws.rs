//! A search for violations of a model's laws: over random directions and legal parameters, identical in every
//! run, and at the ends of all ranges. Tests use it on the CPU for the built-in models, `lcm models check` on
//! the GPU for any model, and on the CPU where there is no window.

use std::{
    f32::consts::{FRAC_PI_2, PI, TAU},
    sync::Arc,
};

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::{Laws, ModelEntry, Surface, brdf_of};
use crate::{
    optics::{
        Frame, TermSelection, Terms,
        albedo::directional_in_batches,
        colour::Encoding,
        geometry::direction,
        lobes::Lobes,
        sampling::{cone, power_heuristic},
        sequence::Sequence,
    },
    parameter::{Parameter, Value, Values},
    progress::{Cancelled, Progress},
};

/// Maximum relative difference after exchanging directions that is attributed to rounding.
pub const RECIPROCITY_TOLERANCE: f32 = 2e-3;
/// Maximum directional albedo that the quadrature may return for 1.
pub const LARGEST_ALBEDO: f32 = 1.01;
/// Most negative response attributed to rounding.
pub const NEGATIVE_TOLERANCE: f32 = 1e-6;
/// Number of samples from a model's lobes, and from the light, that must yield the directional albedo.
pub const SAMPLES: u32 = 1 << 14;
/// Maximum error of these samples, relative to an albedo of at least [`DARKEST`].
pub const SAMPLING_TOLERANCE: f32 = 1e-2;
/// Albedo relative to which the errors of darker albedos are measured.
pub const DARKEST: f32 = 0.02;
/// Steps of the quadrature of an albedo along tangent and bitangent.
pub const COARSE: usize = 48;
/// Steps of the finer quadrature, used where the coarse one returns nearly 1 or more, so that its error
/// matters.
pub const FINE: usize = 160;
/// Albedo from which the finer quadrature is used.
pub const NEARLY_ALL: f32 = 0.98;

/// A small random number generator with the same sequence in every run (G. Marsaglia 2003, xorshift).
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// A number from 0 (inclusive) to 1 (exclusive).
    pub fn unit(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    /// A unit vector in any direction.
    pub fn direction(&mut self) -> Vec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        Vec3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    }

    /// A unit vector on the outer side, down to grazing angles.
    pub fn above(&mut self, frame: &Frame) -> Vec3 {
        let d = self.direction();
        let d = if d.dot(frame.n) < 0.0 { -d } else { d };
        // Every fourth direction is near grazing.
        let tilt = if self.unit() < 0.25 { self.unit() * 0.05 } else { 1.0 };
        let flat = d - d.dot(frame.n) * frame.n;
        (flat + tilt * d.dot(frame.n) * frame.n).normalize_or(frame.n)
    }

    /// A legal value, often at an end of the range.
    pub fn value(&mut self, parameter: &Parameter) -> Value {
        let (pick, within) = (self.unit(), self.unit());
        parameter.kind.random(pick, within, &mut || self.unit())
    }

    /// Legal values of all parameters of a model.
    pub fn values(&mut self, model: &ModelEntry) -> Values {
        Values::each(model.parameters, |parameter| self.value(parameter))
    }

    /// Every number at one end of its range, colours white or black.
    pub fn corner(&mut self, model: &ModelEntry) -> Values {
        Values::each(model.parameters, |parameter| {
            let high = self.unit() < 0.5;
            end(parameter, high, self)
        })
    }
}

/// The minimum or maximum of a parameter; any value of a choice.
fn end(parameter: &Parameter, high: bool, random: &mut Random) -> Value {
    match parameter.kind.limits() {
        Some(range) => parameter.kind.of_numbers([if high { range.far() } else { range.min }; 3]),
        None => random.value(parameter),
    }
}

/// White, and every number at its minimum.
#[must_use]
pub fn least(model: &ModelEntry) -> Values {
    ends(model, false)
}

fn ends(model: &ModelEntry, high: bool) -> Values {
    let numbers = model.parameters.iter().filter(|parameter| parameter.kind.is_number());
    Values::each(numbers, |parameter| end(parameter, high, &mut Random(1)))
}

/// The difference of a BRDF with light and view exchanged, relative to the larger value; differences of dark
/// values do not count. 0 where a cosine is so small that rounding decides.
#[must_use]
pub fn reciprocity_error(there: Terms, back: Terms, l: Vec3, v: Vec3, frame: &Frame) -> f32 {
    if frame.n.dot(l) < 0.01 || frame.n.dot(v) < 0.01 {
        return 0.0;
    }
    let (there, back) = (brdf_of(there, l, v, frame), brdf_of(back, v, l, frame));
    let scale = there.abs().max(back.abs()).max_element().max(1e-3);
    (there - back).abs().max_element() / scale
}

/// The difference of a BTDF from behind the surface to a viewer in front with light and viewer exchanged, relative to the
/// larger value: `f_t(l, v)/n_v² = f_t(v, l)/n_l²` (E. Veach 1997; B. Walter and others 2007). `back` is `f_t(v, l)/n_l²`.
/// As in [`reciprocity_error`], dark values and grazing directions do not count.
#[must_use]
pub fn transmission_error(there: Terms, back: Vec3, l: Vec3, v: Vec3, frame: &Frame) -> f32 {
    if frame.n.dot(l) > -0.01 || frame.n.dot(v) < 0.01 {
        return 0.0;
    }
    let there = brdf_of(there, l, v, frame);
    let scale = there.abs().max(back.abs()).max_element().max(1e-3);
    (there - back).abs().max_element() / scale
}

/// A pair of directions with light and viewer exchanged and both mirrored in the surface: the exchange as it is seen
/// by a viewer in front. A sheet is alike on both sides.
#[must_use]
pub fn from_behind(l: Vec3, v: Vec3, frame: &Frame) -> (Vec3, Vec3) {
    let mirrored = |d: Vec3| d - 2.0 * frame.n.dot(d) * frame.n;
    (mirrored(v), mirrored(l))
}

/// `f_t(v, l)/n_l²` of a model that transmits, for light `l` from behind and a viewer `v` in front. `None` of a solid, whose
/// light follows its mesh, and of a boundary that does not say what is behind it.
#[must_use]
pub fn exchanged(model: &ModelEntry, surface: &dyn Surface, l: Vec3, v: Vec3, frame: &Frame) -> Option<Vec3> {
    let d = model.declaration;
    if !d.transmits || d.solid || surface.interior().is_some() {
        return None;
    }
    if d.boundary {
        return surface.refractive_index().map(|n| surface.behind(v, l, frame) / (n * n));
    }
    let (light, viewer) = from_behind(l, v, frame);
    Some(brdf_of(surface.response(light, viewer, frame), light, viewer, frame))
}

/// The smallest number in a response.
#[must_use]
pub fn smallest(terms: &Terms) -> f32 {
    terms.each().into_iter().map(Vec3::min_element).fold(f32::INFINITY, f32::min)
}

/// Directions to the light with weights, such that the weighted sum of the responses approximates the
/// directional albedo for a view in the local frame: sampled like a uniform environment, by `count`
/// directions from a sampling technique with its density, and as many from all directions above the surface,
/// weighted by the power heuristic.
#[must_use]
pub fn sampled_directions(
    sample: impl Fn(Vec2) -> Vec3,
    pdf: impl Fn(Vec3) -> f32,
    count: u32,
) -> Vec<(Vec3, f32)> {
    let even = 1.0 / TAU;
    let [by_lobes, by_light] = [Sequence::new(0, 0), Sequence::new(0, 1)];
    let own = (0..count).map(|i| {
        let l = sample(by_lobes.point(i));
        let density = if l.z > 0.0 { pdf(l) } else { 0.0 };
        (l, density, power_heuristic(density, even))
    });
    let others = (0..count).map(|i| {
        let l = cone(by_light.point(i), 1.0);
        (l, even, power_heuristic(even, pdf(l)))
    });
    let all = own.chain(others).filter(|(_, density, _)| *density > 0.0);
    all.map(|(l, density, weight)| (l, weight / (density * PI * count as f32))).collect()
}

/// True if a response has neither NaN nor infinity.
#[must_use]
pub fn is_finite(terms: &Terms) -> bool {
    terms.each().into_iter().all(Vec3::is_finite)
}

/// Directions to the light with weights, such that the weighted sum of the responses is the directional
/// albedo for a view: `∫ f_r cos θ dω` over the slopes of the facets that mirror `v` to `l`, by the midpoint
/// rule with `rows` steps along the tangent and along the bitangent.
#[must_use]
pub fn albedo_directions(v: Vec3, frame: &Frame, rows: usize) -> Vec<(Vec3, f32)> {
    // Slopes are spaced as u³/(1 − u²), which resolves lobes that are narrow in one direction or both: those of all
    // models are centred at slope 0.
    let steps: Vec<_> = (0..rows)
        .map(|i| {
            let u = 2.0 * (i as f32 + 0.5) / rows as f32 - 1.0;
            let rest = 1.0 - u * u;
            (u.powi(3) / rest, u * u * (3.0 - u * u) / (rest * rest) * 2.0 / rows as f32)
        })
        .collect();
    let mut directions = Vec::with_capacity(rows * rows);
    for (x, width) in &steps {
        for (y, height) in &steps {
            let scale = (1.0 + x * x + y * y).sqrt().recip();
            let h = scale * (frame.n + x * frame.t + y * frame.b);
            let cos_d = v.dot(h);
            let l = 2.0 * cos_d * h - v;
            if cos_d > 0.0 && frame.n.dot(l) > 0.0 {
                // dω_l = 4 L·H dω_h and dω_h = dx dy (N·H)³. Response is π f_r cos θ.
                directions.push((l, 4.0 * cos_d * scale.powi(3) * width * height / PI));
            }
        }
    }
    directions
}

/// The largest directional albedo of any channel, from the responses in [`albedo_directions`].
#[must_use]
pub fn albedo(directions: &[(Vec3, f32)], responses: impl IntoIterator<Item = Terms>) -> f32 {
    let weighted = directions
        .iter()
        .zip(responses)
        .map(|((_, weight), t)| (t.diffuse + t.specular + t.transmitted) * *weight);
    weighted.sum::<Vec3>().max_element()
}

/// Directions below the surface with weights, such that the weighted sum of the responses approximates the part of
/// uniform light that passes through: `count` samples of the lobes there.
#[must_use]
pub fn directions_below(lobes: &Lobes, v: Vec3, count: u32) -> Vec<(Vec3, f32)> {
    let (lobes, sequence) = (lobes.below(), Sequence::new(0, 0));
    let below = (0..count).map(|i| lobes.sample(sequence.point(i), v)).filter(|l| l.z < 0.0);
    let weighted = below.map(|l| (l, (PI * lobes.pdf(l, v) * count as f32).recip()));
    weighted.filter(|(_, weight)| weight.is_finite()).collect()
}

/// The location of a finding, in the local frame (normal +z, tangent +x).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// The parameters.
    pub values: Values,
    /// Direction to the light; `None` for integrals over it.
    pub l: Option<Vec3>,
    /// Direction to the viewer.
    pub v: Vec3,
}

/// The most extreme value found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extreme {
    /// The value.
    pub size: f32,
    /// Location of the value; `None` if nothing could be compared.
    pub case: Option<Case>,
}

impl Extreme {
    fn note(&mut self, size: f32, further: bool, case: impl FnOnce() -> Case) {
        if further || self.case.is_none() {
            *self = Self { size, case: Some(case()) };
        }
    }

    fn note_larger(&mut self, size: f32, case: impl FnOnce() -> Case) {
        self.note(size, size > self.size, case);
    }
}

/// The extent of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Number of sets of parameters.
    pub sets: usize,
    /// Number of pairs of directions for each set.
    pub pairs: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self { sets: 200, pairs: 2000 }
    }
}

/// The findings about a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// The largest relative difference after exchanging light and view.
    pub reciprocity: Extreme,
    /// The largest relative difference of light that passes after exchanging light and view; without a
    /// [case](Extreme::case) for models that let none through.
    pub transmission: Extreme,
    /// The largest directional albedo.
    pub albedo: Extreme,
    /// The smallest number in a response.
    pub smallest: Extreme,
    /// The largest response to light from below the surface.
    pub from_below: Extreme,
    /// The largest error of a directional albedo from samples of the model's lobes, see [`sampling_errors`].
    pub sampling: Extreme,
    /// The number of responses.
    pub responses: usize,
    /// The number of non-finite responses.
    pub not_finite: usize,
    /// The first of those.
    pub first_not_finite: Option<Case>,
}

impl Findings {
    /// The laws without a violation.
    #[must_use]
    pub fn kept(&self) -> Laws {
        Laws {
            reciprocal: self.reciprocity.size <= RECIPROCITY_TOLERANCE,
            energy_conserving: self.albedo.size <= LARGEST_ALBEDO,
            non_negative: self.smallest.size >= -NEGATIVE_TOLERANCE,
        }
    }
}

/// Searches for violations of a model's laws with the `given` values and any others. `ask` returns the responses to pairs of directions (to the light, to the
/// viewer) in the local frame.
///
/// # Errors
/// Returns the errors of `ask`.
pub fn examine<E>(
    model: &ModelEntry,
    given: &Values,
    effort: Effort,
    mut ask: impl FnMut(&Values, &[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<Findings, E> {
    let mut random = Random(0x5eed);
    let mut findings = Findings::default();
    for set in 0..effort.sets {
        let mut values = match set {
            0 => Values::default(),
            1 => least(model),
            2 => ends(model, true),
            3..40 if set % 2 == 1 => random.corner(model),
            _ => random.values(model),
        };
        values.0.extend(given.0.clone());
        // A few sets are enough: lobes that suit the parameters also suit the ends of their ranges.
        if set < 3 {
            let lobes = model.instantiate(&values, Encoding::Srgb).lobes();
            for (v, error) in sampling_errors(&lobes, |pairs| ask(&values, pairs))? {
                let case = || Case { values: values.clone(), l: None, v };
                findings.sampling.note_larger(error, case);
            }
        }
        compare(&values, effort.pairs, &mut random, &mut findings, &mut ask)?;
        exchange(model, &values, effort.pairs, &mut random, &mut findings, &mut ask)?;
        integrate(model, &values, &mut random, &mut findings, &mut ask)?;
    }
    Ok(findings)
}

/// Like [`examine`], with the model on the CPU.
///
/// # Errors
/// Returns [`Cancelled`] if the user cancels.
pub fn examine_on_cpu(
    model: &ModelEntry,
    given: &Values,
    effort: Effort,
    progress: &Progress,
) -> Result<Findings, Cancelled> {
    let mut last: Option<(Values, Arc<dyn Surface>)> = None;
    let mut sets = 0;
    examine(model, given, effort, |values, pairs| {
        if last.as_ref().is_none_or(|(known, _)| known != values) {
            progress.step(sets as f32 / effort.sets as f32, "sets of parameters")?;
            sets += 1;
            last = Some((values.clone(), model.instantiate(values, Encoding::Srgb)));
        }
        let Some((_, surface)) = &last else { return Ok(Vec::new()) };
        Ok(pairs.par_iter().map(|(l, v)| surface.response(*l, *v, &Frame::LOCAL)).collect())
    })
}

/// The deviation of directional albedos from [`SAMPLES`] of some lobes from those by quadrature, for several
/// views. Any lobes yield the albedo eventually, so a large error means that they miss the directions in
/// which the model reflects most. Not compared with samples of the cosine lobe alone, which are no better for
/// narrow highlights.
///
/// # Errors
/// Returns the errors of `ask`.
pub fn sampling_errors<E>(
    lobes: &Lobes,
    mut ask: impl FnMut(&[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<Vec<(Vec3, f32)>, E> {
    let views = [direction(10.0, 0.0), direction(45.0, 60.0), direction(75.0, 200.0)];
    let exact = directional_in_batches(&views, &mut ask)?;
    let mut errors = Vec::with_capacity(views.len());
    for (v, exact) in views.into_iter().zip(exact) {
        let directions = sampled_directions(|u| lobes.sample(u, v), |l| lobes.pdf(l, v), SAMPLES);
        let pairs: Vec<_> = directions.iter().map(|(l, _)| (*l, v)).collect();
        let found = albedo(&directions, ask(&pairs)?);
        let exact = exact.max_element() as f32;
        let error = (found - exact).abs() / exact.max(DARKEST);
        if error.is_finite() {
            errors.push((v, error));
        }
    }
    Ok(errors)
}

/// Compares responses in random directions, and with light and view exchanged.
fn compare<E>(
    values: &Values,
    pairs: usize,
    random: &mut Random,
    findings: &mut Findings,
    ask: &mut impl FnMut(&Values, &[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<(), E> {
    let frame = Frame::LOCAL;
    let grazing = Vec3::new(1.0, 0.0, 1e-7).normalize();
    let special = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y, grazing];
    let mut directions: Vec<_> = special.iter().flat_map(|l| special.map(|v| (*l, v))).collect();
    directions.extend((0..pairs).map(|_| (random.direction(), random.direction())));
    let both = directions.len();
    for _ in 0..pairs {
        let (l, v) = (random.above(&frame), random.above(&frame));
        directions.extend([(l, v), (v, l)]);
    }
    let answers = ask(values, &directions)?;
    for ((l, v), terms) in directions.iter().zip(&answers) {
        let case = || Case { values: values.clone(), l: Some(*l), v: *v };
        findings.responses += 1;
        if is_finite(terms) {
            let least = smallest(terms);
            findings.smallest.note(least, least < findings.smallest.size, case);
            let total = terms.select(TermSelection::All).abs().max_element();
            if l.z < 0.0 && v.z > 0.0 && total > 0.0 {
                findings.from_below.note_larger(total, case);
            }
        } else {
            findings.not_finite += 1;
            findings.first_not_finite.get_or_insert_with(case);
        }
    }
    let opposite = directions[both..].chunks_exact(2).zip(answers[both..].chunks_exact(2));
    for (pair, answer) in opposite {
        let ((l, v), [there, back]) = (pair[0], [answer[0], answer[1]]);
        if is_finite(&there) && is_finite(&back) {
            let error = reciprocity_error(there, back, l, v, &frame);
            let case = || Case { values: values.clone(), l: Some(l), v };
            findings.reciprocity.note_larger(error, case);
        }
    }
    Ok(())
}

/// Compares light that passes with the exchange of light and view. Sheets are asked for both; what is behind a boundary only
/// the CPU knows, which then has both.
fn exchange<E>(
    model: &ModelEntry,
    values: &Values,
    pairs: usize,
    random: &mut Random,
    findings: &mut Findings,
    ask: &mut impl FnMut(&Values, &[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<(), E> {
    let frame = Frame::LOCAL;
    if !model.declaration.transmits {
        return Ok(());
    }
    let surface = model.instantiate(values, Encoding::Srgb);
    if exchanged(model, &*surface, -Vec3::Z, Vec3::Z, &frame).is_none() {
        return Ok(());
    }
    let through: Vec<_> = (0..pairs).map(|_| (-random.above(&frame), random.above(&frame))).collect();
    let mut answers = Vec::new();
    if !model.declaration.boundary {
        let both = through.iter().flat_map(|(l, v)| [(*l, *v), from_behind(*l, *v, &frame)]);
        answers = ask(values, &both.collect::<Vec<_>>())?;
    }
    for (i, (l, v)) in through.into_iter().enumerate() {
        let found = match answers.chunks_exact(2).nth(i) {
            Some(pair) => {
                let (light, viewer) = from_behind(l, v, &frame);
                Some((pair[0], brdf_of(pair[1], light, viewer, &frame)))
            }
            None => exchanged(model, &*surface, l, v, &frame).map(|b| (surface.response(l, v, &frame), b)),
        };
        let Some((there, back)) = found.filter(|(t, b)| is_finite(t) && b.is_finite()) else { continue };
        let error = transmission_error(there, back, l, v, &frame);
        let case = || Case { values: values.clone(), l: Some(l), v };
        findings.transmission.note_larger(error, case);
    }
    Ok(())
}

/// Directional albedos, the largest with the finer quadrature; with the transmitted light.
fn integrate<E>(
    model: &ModelEntry,
    values: &Values,
    random: &mut Random,
    findings: &mut Findings,
    ask: &mut impl FnMut(&Values, &[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<(), E> {
    let tilts = [0.02, 0.5, 0.8, 0.95, 0.99, random.unit() * 0.99];
    for (i, tilt) in tilts.into_iter().enumerate() {
        let (sin, cos) = (FRAC_PI_2 * tilt).sin_cos();
        // Alternately from the side and along the tangent.
        let (sin_azimuth, cos_azimuth) =
            if i % 2 == 0 { (0.0, 1.0) } else { (TAU * random.unit()).sin_cos() };
        let v = Vec3::new(sin * cos_azimuth, sin * sin_azimuth, cos);
        let mut found = 0.0;
        let through = model.declaration.transmits.then(|| model.instantiate(values, Encoding::Srgb));
        let sharp = through.iter().flat_map(|surface| surface.sharp(v, &Frame::LOCAL));
        let sharp = sharp.map(|sharp| sharp.share).sum::<Vec3>().max_element();
        for rows in [COARSE, FINE] {
            let mut directions = albedo_directions(v, &Frame::LOCAL, rows);
            if let Some(surface) = &through {
                directions.extend(directions_below(&surface.lobes(), v, (rows * rows) as u32));
            }
            let pairs: Vec<_> = directions.iter().map(|(l, _)| (*l, v)).collect();
            let answers = ask(values, &pairs)?;
            found = albedo(&directions, answers) + sharp;
            if found <= NEARLY_ALL {
                break;
            }
        }
        let case = || Case { values: values.clone(), l: None, v };
        if found.is_finite() {
            findings.albedo.note_larger(found, case);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;
    use crate::{optics::lobes::Lobe, registry::Registry};

    #[test]
    fn samples_give_the_albedo_and_those_of_another_density_do_not() {
        let lambert = |directions: &[(Vec3, f32)]| {
            let answers =
                directions.iter().map(|(l, _)| Terms { diffuse: Vec3::splat(l.z), ..Terms::default() });
            albedo(directions, answers)
        };
        let v = direction(45.0, 60.0);
        let narrow = Lobes::new(&[(Lobe::Cosine, 0.5), (Lobe::ggx(0.1), 0.5)]);
        for lobes in [Lobes::cosine(), Lobes::default(), narrow] {
            let found = sampled_directions(|u| lobes.sample(u, v), |l| lobes.pdf(l, v), SAMPLES);
            assert!((lambert(&found) - 1.0).abs() < SAMPLING_TOLERANCE, "{lobes:?}");
            // The wrong twin.
            let other = Lobes::new(&[(Lobe::Power { exponent: 20.0 }, 1.0)]);
            let found = sampled_directions(|u| lobes.sample(u, v), |l| other.pdf(l, v), SAMPLES);
            assert!((lambert(&found) - 1.0).abs() > 3.0 * SAMPLING_TOLERANCE, "{lobes:?}");
        }
    }

    #[test]
    fn lobes_that_miss_a_highlight_are_found() {
        let registry = Registry::builtin();
        let model = registry.model("metallic_roughness").expect("built in");
        let mut values = Values::default();
        values.set("roughness", Value::Number(0.05));
        let surface = model.instantiate(&values, Encoding::Srgb);
        let worst = |lobes: Lobes| {
            let answer = |(l, v): &(Vec3, Vec3)| surface.response(*l, *v, &Frame::LOCAL);
            let answers = |pairs: &[_]| Ok::<_, Infallible>(pairs.iter().map(answer).collect());
            let Ok(errors) = sampling_errors(&lobes, answers);
            errors.into_iter().map(|(_, error)| error).fold(0.0, f32::max)
        };
        assert!(worst(surface.lobes()) < SAMPLING_TOLERANCE);
        for lobes in [Lobes::cosine(), Lobes::default()] {
            assert!(worst(lobes) > SAMPLING_TOLERANCE, "{lobes:?}");
        }
    }
}
