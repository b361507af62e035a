//! Curves over a cosine, and other numbers, that a model calculates once per surface and its shader reads by name.

use glam::{Vec3, Vec4};

use super::{
    cubature::Plan,
    curve::{LobeAlbedo, NODES, nodes, spline},
};
use crate::optics::Terms;

/// Four numbers as a function of a cosine μ, by name. In WGSL they are `curve_NAME(mu)`, their means over the
/// hemisphere `mean_NAME()`; those of [`Spacing::Values`] are `value_NAME(i)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedCurve {
    /// A name that can be part of a function name.
    pub name: &'static str,
    /// Positions of the nodes.
    pub spacing: Spacing,
}

/// The positions of the nodes of a [`NamedCurve`], and the interpolation between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// [`NODES`] nodes at `μ = (i/15)³`, with cubic interpolation, as in [`Albedos`].
    Cubic,
    /// This many equidistant nodes from 0 to 1, with linear interpolation, as in [`Lines`]. At least 2.
    Linear(usize),
    /// Not a curve: this many quadruples, read by index, such as numbers that take long to calculate.
    Values(usize),
}

impl NamedCurve {
    /// The number of nodes.
    #[must_use]
    pub const fn nodes(&self) -> usize {
        match self.spacing {
            Spacing::Cubic => NODES,
            Spacing::Linear(count) | Spacing::Values(count) => count,
        }
    }

    /// The number of quadruples in a row: the nodes and, for a curve, the mean.
    #[must_use]
    pub const fn length(&self) -> usize {
        match self.spacing {
            Spacing::Values(count) => count,
            _ => self.nodes() + 1,
        }
    }
}

/// The albedos of up to four lobes as functions of the cosine between view and normal, with their means `2 ∫ E μ dμ`: the
/// values of a [`NamedCurve`] with [`Spacing::Cubic`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Albedos {
    nodes: [Vec4; NODES],
    mean: Vec4,
}

impl Albedos {
    /// The albedos of isotropic lobes, each by its own curve.
    #[must_use]
    pub fn of(lobes: [LobeAlbedo; 4]) -> Self {
        let four = |number: &dyn Fn(&LobeAlbedo) -> f32| Vec4::from_array(lobes.each_ref().map(number));
        Self { nodes: std::array::from_fn(|i| four(&|lobe| lobe.nodes[i])), mean: four(&LobeAlbedo::average) }
    }

    /// The albedos at a cosine.
    #[must_use]
    pub fn at(&self, mu: f32) -> Vec4 {
        let (i, weights) = spline(mu);
        weights.iter().zip(&self.nodes[i..]).map(|(weight, node)| *weight * *node).sum()
    }

    /// The means of the albedos.
    #[must_use]
    pub fn mean(&self) -> Vec4 {
        self.mean
    }

    /// The quadruples for [`ReflectionModel::curves`](crate::reflection::ReflectionModel::curves).
    #[must_use]
    pub fn values(&self) -> Vec<Vec4> {
        self.nodes.iter().copied().chain([self.mean]).collect()
    }
}

/// The albedos of two isotropic lobes that differ only in their Fresnel term, from their responses `π f_r(l,
/// v) cos θ_l` in the local frame (normal +z, tangent +x): one integration for both.
#[must_use]
pub fn lobe_albedos(response: impl Fn(Vec3, Vec3) -> [f32; 2]) -> [LobeAlbedo; 2] {
    let response = |l, v| {
        let [x, y] = response(l, v);
        Terms { specular: Vec3::new(x, y, 0.0), ..Terms::default() }
    };
    let both = nodes(response, 0.0, &Plan::isotropic());
    [LobeAlbedo::from_nodes(both.map(|e| e.x as f32)), LobeAlbedo::from_nodes(both.map(|e| e.y as f32))]
}

/// Four numbers at N equidistant cosines, with linear interpolation: the values of a [`NamedCurve`] with
/// [`Spacing::Linear`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines<const N: usize> {
    nodes: [Vec4; N],
}

impl<const N: usize> Default for Lines<N> {
    fn default() -> Self {
        Self { nodes: [Vec4::ZERO; N] }
    }
}

impl<const N: usize> Lines<N> {
    /// The curve through these values.
    #[must_use]
    pub fn new(nodes: [Vec4; N]) -> Self {
        const { assert!(N >= 2, "a line has two ends") };
        Self { nodes }
    }

    /// The values at a cosine.
    #[must_use]
    pub fn at(&self, mu: f32) -> Vec4 {
        let x = mu.clamp(0.0, 1.0) * (N - 1) as f32;
        let i = (x as usize).min(N - 2);
        self.nodes[i].lerp(self.nodes[i + 1], x - i as f32)
    }

    /// The means over the hemisphere, `2 ∫ f μ dμ`, exact.
    #[must_use]
    pub fn mean(&self) -> Vec4 {
        let step = ((N - 1) as f32).recip();
        // For a line from b to c over [x, x + h]: 2 ∫ f μ dμ = h (b (x + h/3) + c (x + 2h/3)).
        let piece = |(i, ends): (usize, &[Vec4])| {
            let x = i as f32 * step;
            step * (ends[0] * (x + step / 3.0) + ends[1] * (x + step * (2.0 / 3.0)))
        };
        self.nodes.windows(2).enumerate().map(piece).sum()
    }

    /// The quadruples for [`ReflectionModel::curves`](crate::reflection::ReflectionModel::curves).
    #[must_use]
    pub fn values(&self) -> Vec<Vec4> {
        self.nodes.iter().copied().chain([self.mean()]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests::ggx, *};

    #[test]
    fn two_lobes_in_one_integration_are_those_of_two() {
        let lobe = ggx(0.4, false);
        let both = lobe_albedos(|l, v| [lobe(l, v), 0.25 * lobe(l, v)]);
        let alone = LobeAlbedo::new(&lobe);
        let four = Albedos::of([both[0], both[1], alone, LobeAlbedo::default()]);
        for mu in [0.0, 0.01, 0.2, 0.7, 1.0] {
            let at = four.at(mu);
            assert!((at.x - alone.at(mu)).abs() < 1e-4 && (at.y - 0.25 * alone.at(mu)).abs() < 1e-4, "{at}");
            assert!((at.z - alone.at(mu)).abs() < 1e-6 && (at.w - 1.0).abs() < 1e-6, "{at}");
        }
        assert_eq!(four.mean().z, alone.average());
        assert_eq!(four.values().len(), NODES + 1);
    }

    #[test]
    fn lines_pass_through_their_nodes_and_have_exact_means() {
        let lines = Lines::new([Vec4::ZERO, Vec4::new(1.0, 2.0, 0.0, 1.0), Vec4::new(2.0, 0.0, 0.0, 1.0)]);
        assert_eq!(lines.at(0.5), Vec4::new(1.0, 2.0, 0.0, 1.0));
        assert_eq!(lines.at(0.75), Vec4::new(1.5, 1.0, 0.0, 1.0));
        assert_eq!(lines.at(7.0), lines.at(1.0));
        // 2 ∫ 2μ μ dμ = 4/3; 2 ∫ 4μ μ dμ to ½ + 2 ∫ (4 − 4μ) μ dμ from ½ = 1/3 + 2/3.
        let mean = lines.mean();
        assert!((mean.x - 4.0 / 3.0).abs() < 1e-6 && (mean.y - 1.0).abs() < 1e-6, "{mean}");
        assert_eq!(lines.values().len(), 4);
    }
}
