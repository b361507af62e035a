//! `f` by half angle θ_h and difference angle θ_d, across (φ_d = 90°), as a picture: B. Burley (2012), *Physically-Based
//! Shading at Disney*; angles of S. Rusinkiewicz (1998), *A New Change of Variables for Efficient BRDF Representation*.

use super::{Declaration, Form, Horizontal, Kind};

pub(super) static KIND: Declaration = Declaration {
    id: "slice",
    name: "image slice",
    heading: Some("image slice of the BRDF"),
    remark: "f by half and difference angle",
    row: "the BRDF by half and difference angle, as a picture",
    choice: [
        "Image slice",
        "π f as a picture, after B. Burley (2012): the half angle θ_h from left to right, the difference angle θ_d from bottom to top. Highlights are at the left, the Fresnel effect at the top, retroreflection at the bottom.",
    ],
    quantity: "f (sr⁻¹)",
    column: "f",
    form: Form::Slices,
    horizontal: Horizontal {
        name: "angle between normal and half vector (°)",
        columns: ("theta_h,theta_d", |_, angle| format!("{angle}")),
        ..Horizontal::PLANE
    },
    has_light: false,
    tried: Some((Kind::Brdf, 45.0)),
    ..Declaration::UNMEASURED
};
