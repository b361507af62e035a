//! The declaration of a quantity of plots.

use glam::Vec3;

use super::Kind;
use crate::{
    curves::{
        Setup, Subject,
        angles::{GRAZING, grid, viewer},
    },
    optics::geometry::direction,
    reflection::Factor,
};

/// The declaration of a quantity.
pub struct Declaration {
    /// The name on the command line.
    pub id: &'static str,
    /// The quantity in words.
    pub name: &'static str,
    /// The heading of a figure, if it says more.
    pub heading: Option<&'static str>,
    /// A remark in the help of the command line; often empty.
    pub remark: &'static str,
    /// The curve, for the table of the documents.
    pub row: &'static str,
    /// The name and the tooltip in the list of the window.
    pub choice: [&'static str; 2],
    /// The quantity with its unit, for an axis.
    pub quantity: &'static str,
    /// The name of the values in CSV.
    pub column: &'static str,
    /// The symbols that it has in an equation, if that defines `I`, the answer of the whole model to light, or not.
    pub symbols: fn(bool) -> &'static [&'static str],
    /// The shape of the figure.
    pub form: Form,
    /// The horizontal axis.
    pub horizontal: Horizontal,
    /// True if the viewer goes all around surfaces that light passes through, not only above them.
    pub is_around: bool,
    /// True if the quantity counts reflected light only, also of surfaces that light passes through.
    pub is_reflected: bool,
    /// True if the quantity depends on the angle of the light.
    pub has_light: bool,
    /// True if it depends on the azimuth.
    pub has_azimuth: bool,
    /// True if the quantity has no colour channels.
    pub is_scalar: bool,
    /// True if the axis of the values always reaches 1, which is where they end.
    pub up_to_one: bool,
    /// True if the values of some models rise without limit towards grazing angles, with the light at an angle.
    pub rises: fn(f64) -> bool,
    /// A factor of the model that must be there.
    pub factor: Option<Factor>,
    /// The factor that turns a measured BRDF into the quantity, from the cosine of the light; `None` if single directions
    /// do not give it.
    pub of_measured: Option<fn(f32) -> f32>,
    /// The value at an angle of the horizontal axis.
    pub value: fn(&Subject, &Setup, f64) -> Vec3,
    /// The angles at which it is calculated, with the light at an angle; fine, or coarse.
    pub angles: fn(f64, bool) -> Vec<f64>,
    /// True if more points are calculated where a curve bends.
    pub is_refined: bool,
    /// The quantity that shows faster if a parameter matters, and the angle of its light.
    pub tried: Option<(Kind, f64)>,
}

/// The shape of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Curves over an axis.
    Plot,
    /// Curves around a point.
    Polar,
    /// A picture for each subject.
    Slices,
}

/// The horizontal axis of a quantity, degrees.
#[derive(Clone, Copy)]
pub struct Horizontal {
    /// The angle, with its unit.
    pub name: &'static str,
    /// The two ends.
    pub ends: (f64, f64),
    /// The columns of CSV for the angles, and their cells at one.
    pub columns: (&'static str, fn(&Setup, f64) -> String),
}

impl Horizontal {
    /// The angle of the viewer in the plane of incidence.
    pub(super) const PLANE: Self = Self {
        name: "angle of the viewer (°), mirror side positive",
        ends: (-90.0, 90.0),
        columns: ("angle,theta_i,phi_i,theta_o,phi_o", |setup, angle| {
            let Setup { theta_i, phi_i, .. } = setup;
            let (theta_o, phi_o) = viewer(angle, *phi_i);
            format!("{angle},{theta_i},{phi_i},{theta_o},{phi_o}")
        }),
    };

    /// An angle from the normal of a surface or a facet.
    pub(super) const fn from_normal(name: &'static str) -> Self {
        Self { name, ends: (0.0, 90.0), columns: ("angle", |_, angle| format!("{angle}")) }
    }
}

/// The direction to the light.
pub(in crate::curves) fn light(setup: &Setup) -> Vec3 {
    direction(setup.theta_i, setup.phi_i)
}

/// The direction to the viewer in the plane of incidence.
pub(in crate::curves) fn seen(setup: &Setup, angle: f64) -> Vec3 {
    let (theta, phi) = viewer(angle, setup.phi_i);
    direction(theta, phi)
}

impl Declaration {
    /// The BRDF in the plane of incidence.
    pub(super) const IN_PLANE: Self = Self {
        id: "",
        name: "",
        heading: None,
        remark: "",
        row: "",
        choice: ["", ""],
        quantity: "",
        column: "",
        symbols: |whole| if whole { &["I"] } else { &["I_d", "I_s"] },
        form: Form::Plot,
        horizontal: Horizontal::PLANE,
        is_around: true,
        is_reflected: false,
        has_light: true,
        has_azimuth: true,
        is_scalar: false,
        up_to_one: false,
        rises: |theta_i| theta_i <= 70.0,
        factor: None,
        of_measured: Some(|_| 1.0),
        value: |subject, setup, angle| subject.brdf(light(setup), seen(setup, angle)),
        angles: |theta_i, _| {
            // The positions of lobes: the mirror direction, the direction back to the light, the normal.
            let around = |centre: f64| [-0.5, -0.05, 0.0, 0.05, 0.5].map(|step| centre + step);
            let lobes = [theta_i, -theta_i, 0.0].into_iter().flat_map(around);
            grid(-88, 88, 2, &lobes.chain([-GRAZING, GRAZING]).collect::<Vec<_>>())
        },
        is_refined: true,
        tried: None,
    };

    /// A factor of microfacet models, or an integral: it cannot be measured at single directions.
    pub(super) const UNMEASURED: Self =
        Self { of_measured: None, is_around: false, rises: |_| false, ..Self::IN_PLANE };
}
