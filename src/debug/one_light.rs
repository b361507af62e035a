//! The picture under one light.

use super::{Declaration, Legend, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "one_light",
    name: "One light alone",
    explanation: "The picture as if only this light shone: the light that is selected, otherwise the one that is \
        brightest at the objects. The picture is the sum of such pictures, before tone mapping.",
    legend: |about| {
        let light = (about.light)().unwrap_or_else(|| "no light shines".to_owned());
        Legend::new(format!("One light alone: {light}"))
    },
    has_light: true,
    shows: Shows::Picture,
    ..Declaration::PLAIN
};
