//! The conclusion on lobes. Each sentence that depends on a number is selected by that number.

use super::{
    merl::{Merl, MerlFit},
    paint::Paints,
};
use crate::{
    study::{
        fixed,
        text::{Values, values},
    },
    text::listed,
};

/// Width below which a lobe is very shiny: the highlight of a lamp is about a degree wide.
const SHINY: f64 = 0.02;

/// The values of the conclusion and of the finding, and true if the numbers confirm the phenomenon.
pub(super) fn values(paints: &Paints, merl: &Merl) -> (Values, bool) {
    // A log error as a fraction.
    let off = |error: f64| error.exp() - 1.0;
    let errors = |model: &str| [0, 1, 2].map(|paint| paints.error(paint, model));
    let [blinn_0, blinn_1, blinn_2] = errors("Blinn–Phong");
    let [ggx_0, ggx_1, ggx_2] = errors("GGX");
    let [inside_0, inside_1, _] = errors("Blinn’s distribution");
    let [beckmann_0, beckmann_1, _] = errors("Beckmann’s distribution");
    let [outside_0, outside_1, _] = errors("GGX distribution");
    let glossy_wins = usize::from(ggx_0 < blinn_0) + usize::from(ggx_1 < blinn_1);
    // From Blinn–Phong to the microfacet model with the same distribution, and from there to GGX.
    let frame = [blinn_0 - inside_0, blinn_1 - inside_1];
    let tail = [inside_0 - outside_0, inside_1 - outside_1];
    let [frame_0, frame_1] = [0, 1].map(|paint| frame[paint] / (frame[paint] + tail[paint]));

    let Merl { contestants, fits, .. } = merl;
    let last = merl.last();
    let [median_blinn, median_ggx] = [0, last].map(|i| merl.median(i));
    let smaller = median_ggx < median_blinn;
    let best: Vec<_> = contestants
        .iter()
        .enumerate()
        .map(|(i, c)| format!("{} for {}", c.name, merl.best(i)))
        .rev()
        .collect();
    let width = |f: &MerlFit| f.fits[0].fit.width;
    // By the width of Blinn–Phong.
    let mut worse: Vec<&MerlFit> = fits.iter().filter(|f| f.error(last) > f.error(0)).collect();
    worse.sort_by(|a, b| width(a).total_cmp(&width(b)));
    let shiny = |f: &MerlFit| width(f) < SHINY;
    let shiny_worse = worse.iter().filter(|f| shiny(f)).count();
    let shiny_all = fits.iter().filter(|f| shiny(f)).count();
    let short = contestants.iter().position(|c| c.name == "Cook–Torrance").unwrap_or(last);
    let short_better = worse.iter().filter(|f| f.error(short) < f.error(last)).count();
    let worse_names: Vec<String> =
        worse.iter().map(|f| format!("{} ({})", f.name.replace('-', " "), fixed(width(f), 3))).collect();
    let (bound_median, bound_better) = merl.bound();
    let values = values! {
        off_blinn_0: off(blinn_0), off_blinn_1: off(blinn_1), off_ggx_0: off(ggx_0), off_ggx_1: off(ggx_1),
        off_blinn: off(median_blinn), off_ggx: off(median_ggx),
        glossy: glossy_wins == 2, glossy_wins, ggx_0, ggx_1, blinn_0, blinn_1, inside_0, inside_1, beckmann_0, beckmann_1,
        tails: outside_0 < inside_0 && outside_1 < inside_1, frame_0, frame_1,
        frame_larger: frame[0] > tail[0] && frame[1] > tail[1], tail_larger: frame[0] < tail[0] && frame[1] < tail[1],
        blinn_2, ggx_2, alike: (blinn_2 - ggx_2).abs() < 0.02,
        smaller, median_ggx, median_blinn, ratio: median_blinn / median_ggx, best: listed(&best, "and"),
        none_worse: worse.is_empty(), worse: worse.len(), worse_names: worse_names.join(", "), shiny: SHINY,
        most_shiny: 2 * shiny_worse > worse.len(), shiny_worse, shiny_better: shiny_all - shiny_worse, shiny_all,
        short: 2 * short_better > worse.len(), short_better, bound_median, bound_better,
    };
    (values, glossy_wins == 2 && smaller)
}
