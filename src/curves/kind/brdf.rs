//! `f` in sr⁻¹ in the plane of incidence.

use super::Declaration;

pub(super) static KIND: Declaration = Declaration {
    id: "f",
    name: "BRDF",
    remark: "the BRDF",
    row: "the BRDF in sr⁻¹ by the angle of the viewer, in the plane of incidence; the default",
    choice: ["BRDF f", "The BRDF f in sr⁻¹ by the angle of the viewer, in the plane of light and normal."],
    quantity: "f (sr⁻¹)",
    column: "f",
    ..Declaration::IN_PLANE
};
