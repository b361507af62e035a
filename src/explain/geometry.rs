//! Directions at a point, with their scalar products and angles.

use glam::{DVec3, Vec3};

use crate::optics::{
    Frame,
    geometry::{half_vector, mirror},
};

/// Directions at a point, and their cosines.
#[derive(Clone, Copy, Debug)]
pub struct Geometry {
    /// Direction to the light.
    pub l: Vec3,
    /// Direction to the observer, as passed to the model.
    pub v: Vec3,
    /// Normal, tangent and bitangent.
    pub frame: Frame,
    /// Half vector between light and observer.
    pub h: Vec3,
    /// The mirror direction of `l`.
    pub r: Vec3,
    /// Scalar products by name, `N·L` first: the ones listed in explanations.
    pub cosines: [(&'static str, f32); 9],
}

impl Geometry {
    /// The geometry for light from `l` and a viewer at `v`: unit vectors.
    #[must_use]
    pub fn of(l: Vec3, v: Vec3, frame: Frame) -> Self {
        let (h, r) = (half_vector(l, v), mirror(l, frame.n));
        let cosines = [
            ("N·L", frame.n.dot(l)),
            ("N·V", frame.n.dot(v)),
            ("N·H", frame.n.dot(h)),
            ("V·H", v.dot(h)),
            ("R·V", r.dot(v)),
            ("L·H", l.dot(h)),
            ("L·V", l.dot(v)),
            ("H·T", h.dot(frame.t)),
            ("H·B", h.dot(frame.b)),
        ];
        Self { l, v, frame, h, r, cosines }
    }

    /// The scalar product with this name, such as `N·L`; NaN for an unknown name.
    #[must_use]
    pub fn cosine(&self, name: &str) -> f32 {
        self.cosines.iter().find(|(known, _)| *known == name).map_or(f32::NAN, |(_, cosine)| *cosine)
    }

    /// The scalar products of all pairs of `N`, `L`, `V`, `H`, `R`, `T` and `B`, by name, each in one order.
    pub(super) fn products(&self) -> impl Iterator<Item = (String, f64)> {
        let Self { l, v, frame: Frame { n, t, b }, h, r, cosines } = *self;
        let all = [("N", n), ("L", l), ("V", v), ("H", h), ("R", r), ("T", t), ("B", b)];
        let pairs = (0..all.len()).flat_map(move |i| (i..all.len()).map(move |j| (all[i], all[j])));
        let products = pairs.map(|((a, x), (b, y))| (format!("{a}·{b}"), f64::from(x.dot(y))));
        // Products used by models have exactly the models' bits. Models that raise R·V to high powers
        // preserve its digits themselves.
        let [l, v, n] = [l, v, n].map(|d| d.as_dvec3().normalize_or_zero());
        let mirrored = ("R·V".to_owned(), 2.0 * n.dot(l) * n.dot(v) - l.dot(v));
        let cosines = cosines.into_iter().map(|(name, c)| (name.to_owned(), f64::from(c)));
        std::iter::once(mirrored).chain(cosines).chain(products)
    }

    /// Angles in degrees by symbol, precise where cosines lose digits. θ_i, θ_r (also θ_o) and θ_h are the
    /// angles of L, V and H to the normal, θ_d is the angle between L and H; φ_l, φ_v and φ_h are azimuths
    /// around the normal, measured from the tangent.
    pub(super) fn angles(&self) -> [(&'static str, f64); 8] {
        let Self { l, v, frame, .. } = self;
        let [l, v, n, t, b] = [*l, *v, frame.n, frame.t, frame.b].map(|d| d.as_dvec3());
        let between = |a: DVec3, b: DVec3| a.cross(b).length().atan2(a.dot(b)).to_degrees();
        let around = |a: DVec3| b.dot(a).atan2(t.dot(a)).to_degrees();
        let h = l + v;
        let (theta_r, theta_h) = (between(v, n), if h.length() < 1e-6 { 90.0 } else { between(h, n) });
        [
            ("θ_i", between(l, n)),
            ("θ_r", theta_r),
            ("θ_o", theta_r),
            ("θ_h", theta_h),
            ("θ_d", (l - v).length().atan2(h.length()).to_degrees()),
            ("φ_h", around(h)),
            ("φ_l", around(l)),
            ("φ_v", around(v)),
        ]
    }
}
