//! Measured data: paints, and fits of measured materials. `assets/data/README.md` names their sources.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

const PAINT_TABLE: &str = include_str!("../../assets/data/cornell_paints.csv");
const SGD: &str = include_str!("../../assets/data/sgd_merl100.csv");
const ABC: &str = include_str!("../../assets/data/abc_merl100.csv");

/// A measured value: angles in degrees and the BRDF in sr⁻¹ at 630, 550 and 465 nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The angle between light and normal.
    pub theta_i: f32,
    /// The angle between viewer and normal.
    pub theta_o: f32,
    /// The angle between the azimuths of light and viewer; at 180, the viewer is on the side of the mirror
    /// direction.
    pub delta_phi: f32,
    /// The azimuth of the light.
    pub phi_i: f32,
    /// The BRDF `f_r`.
    pub f: [f64; 3],
}

impl Measurement {
    /// The angle of the viewer in the plane of incidence, degrees, positive on the side of the mirror
    /// direction; `None` outside the plane.
    #[must_use]
    pub fn in_plane(&self) -> Option<f32> {
        let delta = self.delta_phi.rem_euclid(360.0);
        if (delta - 180.0).abs() < 1.0 {
            Some(self.theta_o)
        } else if !(1.0..=359.0).contains(&delta) {
            Some(-self.theta_o)
        } else {
            None
        }
    }
}

/// The paints: id and name.
pub const PAINTS: [(&str, &str); 3] =
    [("krylon_blue", "Krylon blue"), ("garnet_red", "Garnet red"), ("acryl_blue", "Acryl blue")];

/// Angles of the light beyond which, and angles of the viewer beyond which, the measurements are unreliable and violate
/// reciprocity, degrees.
pub const LARGEST_ANGLE: f32 = 71.0;

/// The measured values of a paint; empty for an unknown paint.
#[must_use]
pub fn paint(id: &str) -> Vec<Measurement> {
    let row = |line: &str| {
        let mut cells = line.split(',');
        if cells.next() != Some(id) {
            return None;
        }
        let mut number = || cells.next()?.parse::<f64>().ok();
        let [theta_i, phi_i, theta_o, phi_o, r, g, b] =
            [number()?, number()?, number()?, number()?, number()?, number()?, number()?];
        Some(Measurement {
            theta_i: theta_i as f32,
            theta_o: theta_o as f32,
            delta_phi: (phi_o - phi_i) as f32,
            phi_i: phi_i as f32,
            f: [r, g, b],
        })
    };
    PAINT_TABLE.lines().filter_map(row).collect()
}

/// The band in which a paint is brightest.
#[must_use]
pub fn brightest(paint: &[Measurement]) -> usize {
    let sum = |band: usize| paint.iter().map(|m| m.f[band]).sum::<f64>();
    (0..3).max_by(|a, b| sum(*a).total_cmp(&sum(*b))).unwrap_or(0)
}

/// **The model of the shifted gamma distribution**, with the parameters fitted by its authors to a material of the MERL
/// database. A fit, not a measurement.
///
/// ```text
/// f = (ρ_d + ρ_s F(v·h) G(l) G(v) D(h) / ((n·l) (n·v))) / π
/// D = κ e^(−x) / (π cos⁴ θ_h x^p),  x = α + tan² θ_h / α
/// G(k) = clamp(1 + λ (1 − exp(c max(θ_k − θ₀, 0)^k)), 0, 1)
/// F = F₀ − F₁ cos θ_d + (1 − F₀)(1 − cos θ_d)⁵
/// ```
///
/// M. Bagher, C. Soler, N. Holzschuch (2012), *Accurate Fitting of Measured Reflectances Using a Shifted
/// Gamma Micro-Facet Distribution*, Computer Graphics Forum 31(4), 1509–1518.
#[derive(Clone, Debug, PartialEq)]
pub struct Sgd {
    /// The name of the material in the MERL database.
    pub name: &'static str,
    /// ρ_d, ρ_s, α, p, F₀, F₁, κ, λ, c, k, θ₀, each in red, green and blue.
    parameters: [[f64; 3]; 11],
}

impl Sgd {
    /// Every material, in the order of the table.
    #[must_use]
    pub fn all() -> Vec<Self> {
        SGD.lines().skip(1).filter_map(Self::read).collect()
    }

    fn read(line: &'static str) -> Option<Self> {
        let mut cells = line.split(',');
        let name = cells.next()?;
        // Another name of the same material.
        cells.next()?;
        let mut parameters = [[0.0; 3]; 11];
        for number in parameters.as_flattened_mut() {
            *number = cells.next()?.parse().ok()?;
        }
        Some(Self { name, parameters })
    }

    /// `f_r` in sr⁻¹ in the three channels; l and v are in the local frame. Zero below the surface.
    #[must_use]
    pub fn brdf(&self, l: Vec3, v: Vec3) -> [f64; 3] {
        let Some([l, v, h]) = with_half(l, v) else { return [0.0; 3] };
        let cos_d = h.dot(l).clamp(0.0, 1.0);
        let cos2 = h.z * h.z;
        std::array::from_fn(|c| {
            let [rho_d, rho_s, alpha, p, f_0, f_1, kappa, lambda, drop, power, theta_0] =
                self.parameters.map(|channels| channels[c]);
            let x = alpha + (1.0 - cos2) / cos2 / alpha;
            let d = kappa * (-x).exp() / (PI * cos2 * cos2 * x.powf(p));
            let g = |cos: f64| {
                let beyond = (cos.min(1.0).acos() - theta_0).max(0.0);
                (1.0 + lambda * (1.0 - (drop * beyond.powf(power)).exp())).clamp(0.0, 1.0)
            };
            let f = (f_0 - f_1 * cos_d + (1.0 - f_0) * (1.0 - cos_d).powi(5)).max(0.0);
            (rho_d + rho_s * f * g(l.z) * g(v.z) * d / (l.z * v.z)) / PI
        })
    }

    /// The luminance of [`Self::brdf`] (ITU-R BT.709).
    #[must_use]
    pub fn luminance(&self, l: Vec3, v: Vec3) -> f64 {
        luminance(self.brdf(l, v))
    }
}

fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// **The ABC model**, with the parameters fitted by its authors to a material of the MERL database. A fit, not a measurement.
///
/// ```text
/// f = k_d/π + F(v·h) G D(h) / (π (n·l) (n·v)),  D = A / (1 + B (1 − n·h))^C
/// G = min(1, 2 (n·h)(n·l)/(v·h), 2 (n·h)(n·v)/(v·h)),  F of a dielectric with the index n
/// ```
///
/// J. Löw, J. Kronander, A. Ynnerman, J. Unger (2012), *BRDF Models for Accurate and Efficient Rendering of Glossy
/// Surfaces*, ACM Transactions on Graphics 31(1), 9.
#[derive(Clone, Debug, PartialEq)]
pub struct Abc {
    /// The name of the material in the MERL database.
    pub name: &'static str,
    diffuse: [f64; 3],
    a: [f64; 3],
    b: f64,
    c: f64,
    ior: f64,
}

impl Abc {
    /// The fit of a material.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        ABC.lines().skip(1).find(|line| line.split(',').next() == Some(name)).and_then(Self::read)
    }

    fn read(line: &'static str) -> Option<Self> {
        let mut cells = line.split(',');
        let name = cells.next()?;
        let mut number = || cells.next()?.parse::<f64>().ok();
        Some(Self {
            name,
            diffuse: [number()?, number()?, number()?],
            a: [number()?, number()?, number()?],
            b: number()?,
            c: number()?,
            ior: number()?,
        })
    }

    /// `f_r` in sr⁻¹ in the three channels; l and v are in the local frame. Zero below the surface.
    #[must_use]
    pub fn brdf(&self, l: Vec3, v: Vec3) -> [f64; 3] {
        let Some([l, v, h]) = with_half(l, v) else { return [0.0; 3] };
        let cos_d = h.dot(l).clamp(1e-9, 1.0);
        let g = (2.0 * h.z / cos_d * l.z.min(v.z)).min(1.0);
        let lobe = reflectance(cos_d, self.ior) * g / (1.0 + self.b * (1.0 - h.z)).powf(self.c);
        std::array::from_fn(|i| (self.diffuse[i] + self.a[i] * lobe / (l.z * v.z)) / PI)
    }

    /// The luminance of [`Self::brdf`] (ITU-R BT.709).
    #[must_use]
    pub fn luminance(&self, l: Vec3, v: Vec3) -> f64 {
        luminance(self.brdf(l, v))
    }
}

/// Unit vectors to light and viewer and the half vector; `None` below the surface.
fn with_half(l: Vec3, v: Vec3) -> Option<[DVec3; 3]> {
    if l.z <= 0.0 || v.z <= 0.0 {
        return None;
    }
    let (l, v) = (l.as_dvec3().normalize(), v.as_dvec3().normalize());
    Some([l, v, (l + v).normalize()])
}

/// The reflectance of the boundary of a dielectric with refractive index n, unpolarised (A.-J. Fresnel 1823).
fn reflectance(cos: f64, n: f64) -> f64 {
    let bent = (n * n - 1.0 + cos * cos).max(0.0).sqrt();
    let (s, p) = ((cos - bent) / (cos + bent), (n * n * cos - bent) / (n * n * cos + bent));
    0.5 * (s * s + p * p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::geometry::direction;

    #[test]
    fn every_row_is_read() {
        for id in ["krylon_blue", "garnet_red", "acryl_blue"] {
            assert_eq!(paint(id).len(), 1439, "{id}");
        }
        assert!(paint("cayman").is_empty() && paint("material").is_empty());
        assert_eq!(brightest(&paint("krylon_blue")), 2);
        assert_eq!(brightest(&paint("garnet_red")), 0);
        assert_eq!(Sgd::all().len(), 100);
        for (id, _) in PAINTS {
            assert!(!paint(id).is_empty(), "{id}");
        }
    }

    #[test]
    fn fits_are_positive_and_reciprocal() {
        for material in Sgd::all() {
            for i in 0..8u8 {
                for j in 0..40u8 {
                    let l = direction(f64::from(i) * 11.0, 0.0);
                    let v = direction(f64::from(j % 8) * 11.0, f64::from(j / 8) * 45.0);
                    let (there, back) = (material.brdf(l, v), material.brdf(v, l));
                    for c in 0..3 {
                        assert!(there[c].is_finite() && there[c] >= 0.0, "{} {there:?}", material.name);
                        assert!((there[c] - back[c]).abs() <= 1e-6 * there[c].max(1e-9), "{}", material.name);
                    }
                }
            }
            assert_eq!(material.brdf(Vec3::NEG_Z, Vec3::Z), [0.0; 3]);
        }
    }

    #[test]
    fn two_published_fits_of_a_material_are_alike() {
        let sgd = Sgd::all();
        let abc: Vec<_> = sgd.iter().map(|m| Abc::named(m.name).expect("both have it")).collect();
        assert!(abc.iter().zip(&sgd).all(|(a, b)| a.name == b.name) && Abc::named("paper").is_none());
        // Along the normal: k_d/π + ((n − 1)/(n + 1))² A/π.
        let bronze = abc[0].brdf(Vec3::Z, Vec3::Z)[0];
        let expected = (0.024514 + (1.236525f64 / 3.236525).powi(2) * 51.714554) / PI;
        assert!((bronze / expected - 1.0).abs() < 1e-9, "{bronze} {expected}");
        // At 60° from glass (n = 1.5), 0.08918671.
        assert!((reflectance(0.5, 1.5) - 0.089_186_71).abs() < 1e-7);
        // Of the measurement, halfway up the lobe of a plastic, both make about the same; of another material, not.
        let (l, v) = (direction(30.0, 0.0), direction(40.0, 180.0));
        let at = |name: &str| {
            let i = abc.iter().position(|m| m.name == name).expect("is in the table");
            (sgd[i].luminance(l, v), abc[i].luminance(l, v))
        };
        let (teflon, plastic) = (at("teflon"), at("black-obsidian"));
        assert!((teflon.0 / teflon.1 - 1.0).abs() < 0.25, "{teflon:?}");
        assert!((teflon.0 / plastic.1 - 1.0).abs() > 0.5, "the wrong twin: {teflon:?} {plastic:?}");
    }

    #[test]
    fn a_value_that_was_calculated_elsewhere() {
        let teflon = Sgd::all().into_iter().find(|m| m.name == "teflon").expect("is in the table");
        let f = teflon.brdf(direction(30.0, 0.0), direction(50.0, 120.0));
        let expected = TEFLON;
        for c in 0..3 {
            assert!((f[c] / expected[c] - 1.0).abs() < 1e-5, "{f:?}");
        }
        // A wrong twin: the light from the other side.
        let wrong = teflon.brdf(direction(30.0, 180.0), direction(50.0, 120.0));
        assert!((wrong[0] / expected[0] - 1.0).abs() > 1e-3);
    }

    /// From a separate script with the equations above.
    const TEFLON: [f64; 3] = [0.113510815, 0.113223260, 0.110613911];
}
