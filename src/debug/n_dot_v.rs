//! The cosine between normal and observer.

use super::{Declaration, Legend, Made, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "n_dot_v",
    name: "N·V",
    explanation: "The cosine of the angle between the interpolated normal and the direction to the observer. It is 1 \
        where the surface is seen head-on and 0 at the silhouette, where Fresnel reflectance is highest.",
    legend: |_| Legend::cosine("N·V: cosine towards the observer"),
    shows: Shows::Geometry(
        |point| Made::cosine(Some(point.normal.dot(point.v))),
        "return channel_cosine(dot(normal, v));",
    ),
    ..Declaration::PLAIN
};
