//! The quantities of plots: each is declared in a file of its own, and named in [`Kind`].

mod declaration;

mod albedo;
mod brdf;
mod brdf_cos;
mod distribution;
mod fresnel;
mod masking;
mod polar;
mod response;
mod slice;

use crate::declared::declared;

pub use declaration::{Declaration, Form, Horizontal};
pub(super) use declaration::{light, seen};

declared! {
    /// The quantity of a plot.
    Kind: Declaration {
        Brdf = brdf::KIND,
        BrdfCos = brdf_cos::KIND,
        Response = response::KIND,
        Polar = polar::KIND,
        Albedo = albedo::KIND,
        Fresnel = fresnel::KIND,
        Distribution = distribution::KIND,
        Masking = masking::KIND,
        Slice = slice::KIND,
    }
}

impl Kind {
    /// The quantity in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// Every quantity in words, for the help of the command line: neighbours with the same remark share it.
    #[must_use]
    pub fn listed() -> String {
        let groups = Self::ALL.chunk_by(|a, b| {
            let remark = a.declaration().remark;
            !remark.is_empty() && remark == b.declaration().remark
        });
        let group = |kinds: &[Self]| {
            let ids = crate::text::listed(&kinds.iter().map(|kind| kind.id()).collect::<Vec<_>>(), "and");
            match kinds[0].declaration().remark {
                "" => ids,
                remark => format!("{ids} ({remark})"),
            }
        };
        groups.map(group).collect::<Vec<_>>().join(", ")
    }
}
