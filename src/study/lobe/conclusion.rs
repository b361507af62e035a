//! The conclusion on lobes. Each sentence that depends on a number is selected by that number.

use maud::{Markup, html};

use super::{
    merl::{Merl, MerlFit},
    paint::Paints,
};
use crate::study::fixed;

/// Width below which a lobe is very shiny: the highlight of a lamp is about a degree wide.
const SHINY: f64 = 0.02;

/// The fits on which the conclusion is based.
pub(super) struct Conclusion<'a> {
    pub(super) paints: &'a Paints,
    pub(super) merl: &'a Merl,
}

impl Conclusion<'_> {
    /// The number of glossy paints that GGX fits better than Blinn–Phong.
    fn glossy_wins(&self) -> usize {
        (0..2).filter(|p| self.paints.error(*p, "GGX") < self.paints.error(*p, "Blinn–Phong")).count()
    }

    /// The median errors of Blinn–Phong and GGX over the materials.
    fn medians(&self) -> [f64; 2] {
        [0, self.merl.last()].map(|i| self.merl.median(i))
    }

    fn ggx_has_smaller_median(&self) -> bool {
        let [blinn, ggx] = self.medians();
        ggx < blinn
    }

    /// True if the numbers confirm the phenomenon.
    pub(super) fn is_confirmed(&self) -> bool {
        self.glossy_wins() == 2 && self.ggx_has_smaller_median()
    }

    /// One sentence for the summary of the study.
    pub(super) fn finding(&self) -> String {
        // A log error in per cent.
        let off = |error: f64| 100.0 * (error.exp() - 1.0);
        let paint = |paint: usize, model: &str| off(self.paints.error(paint, model));
        let [blinn, ggx] = self.medians();
        format!(
            "Fitted to measured paint with the same freedom, Blinn–Phong is off by {:.1}\u{a0}% and {:.1}\u{a0}%, GGX by {:.1}\u{a0}% and {:.1}\u{a0}%; over {} MERL fits, where GGX may also choose its Fresnel term, the medians are {:.1}\u{a0}% and {:.1}\u{a0}%.",
            paint(0, "Blinn–Phong"),
            paint(1, "Blinn–Phong"),
            paint(0, "GGX"),
            paint(1, "GGX"),
            self.merl.fits.len(),
            off(blinn),
            off(ggx)
        )
    }

    /// The whole conclusion.
    pub(super) fn text(&self) -> Markup {
        html! {
            (self.on_glossy_paints())
            (self.on_the_matte_paint())
            (self.on_materials())
            (self.where_ggx_is_worse())
        }
    }

    fn on_glossy_paints(&self) -> Markup {
        let error = |paint: usize, model: &str| self.paints.error(paint, model);
        // From Blinn–Phong to the microfacet model with the same distribution, and from there to GGX.
        let frame = [0, 1].map(|p| error(p, "Blinn–Phong") - error(p, "Blinn’s distribution"));
        let tail = [0, 1].map(|p| error(p, "Blinn’s distribution") - error(p, "GGX distribution"));
        let share = [0, 1].map(|p| format!("{:.0}\u{a0}%", 100.0 * frame[p] / (frame[p] + tail[p])));
        let tails = (0..2).all(|p| error(p, "GGX distribution") < error(p, "Blinn’s distribution"));
        html! {
        p {
            @if self.glossy_wins() == 2 {
                "For both glossy paints GGX comes closest to the measurement: its log error is " (fixed(error(0, "GGX"), 3)) " and " (fixed(error(1, "GGX"), 3)) ", Blinn–Phong’s "
                (fixed(error(0, "Blinn–Phong"), 3)) " and " (fixed(error(1, "Blinn–Phong"), 3)) ". Exchanging the distribution alone shows its part: with Blinn’s distribution inside the same microfacet model the errors are "
                (fixed(error(0, "Blinn’s distribution"), 3)) " and " (fixed(error(1, "Blinn’s distribution"), 3)) ", with Beckmann’s " (fixed(error(0, "Beckmann’s distribution"), 3)) " and " (fixed(error(1, "Beckmann’s distribution"), 3))
                ". "
                @if tails {
                    "Of the way from Blinn–Phong to GGX, " (share[0]) " and " (share[1]) " are due to the frame of the microfacet model (its denominator, masking and Fresnel term), and the rest to the longer tail of GGX. "
                    @if frame[0] > tail[0] && frame[1] > tail[1] { "The frame is the larger part for both paints." }
                    @else if frame[0] < tail[0] && frame[1] < tail[1] { "The tail is the larger part for both paints." }
                    @else { "Which part is larger depends on the paint." }
                }
            } @else {
                "For the glossy paints GGX is better than Blinn–Phong in " (self.glossy_wins()) " of two cases."
            }
        }
        }
    }

    fn on_the_matte_paint(&self) -> Markup {
        let acryl = ["Blinn–Phong", "GGX"].map(|model| self.paints.error(2, model));
        html! {
        p {
            "Acryl blue is nearly matte in this data: the errors of Blinn–Phong and GGX are " (fixed(acryl[0], 3)) " and " (fixed(acryl[1], 3)) ". "
            @if (acryl[0] - acryl[1]).abs() < 0.02 { "The shape of a barely visible highlight decides nothing." }
        }
        }
    }

    fn on_materials(&self) -> Markup {
        let Merl { contestants, fits, .. } = self.merl;
        let [blinn, ggx] = self.medians();
        html! {
        p {
            @if self.ggx_has_smaller_median() {
                "Over the " (fits.len()) " MERL fits the median error of GGX is " (fixed(ggx, 2)) ", that of Blinn–Phong " (fixed(blinn, 2)) ", " (fixed(blinn / ggx, 1)) " times as large. "
            } @else {
                "Over the " (fits.len()) " MERL fits GGX has no smaller median error (" (fixed(ggx, 2)) ") than Blinn–Phong (" (fixed(blinn, 2)) "). "
            }
            "The best of the four is "
            @for (i, c) in contestants.iter().enumerate().rev() {
                (c.name) " for " (self.merl.best(i)) @if i > 1 { ", " } @else if i == 1 { " and " }
            }
            ". No model is best for every material: these are fits of one more model, and the tails of real materials differ."
        }
        }
    }

    fn where_ggx_is_worse(&self) -> Markup {
        let Merl { contestants, fits, .. } = self.merl;
        let last = self.merl.last();
        let width = |f: &MerlFit| f.fits[0].fit.width;
        // By the width of Blinn–Phong.
        let mut worse: Vec<&MerlFit> = fits.iter().filter(|f| f.error(last) > f.error(0)).collect();
        worse.sort_by(|a, b| width(a).total_cmp(&width(b)));
        let shiny = |f: &MerlFit| width(f) < SHINY;
        let shiny_worse = worse.iter().filter(|f| shiny(f)).count();
        let all_shiny = fits.iter().filter(|f| shiny(f)).count();
        let short = contestants.iter().position(|c| c.name == "Cook–Torrance").unwrap_or(last);
        let short_better = worse.iter().filter(|f| f.error(short) < f.error(last)).count();
        let worse_names: Vec<String> =
            worse.iter().map(|f| format!("{} ({})", f.name.replace('-', " "), fixed(width(f), 3))).collect();
        let (bound_median, bound_better) = self.merl.bound();
        html! {
        p {
            @if worse.is_empty() {
                "GGX is worse than Blinn–Phong for none of them. "
            } @else {
                "GGX is worse than Blinn–Phong for " (worse.len()) " of them (in brackets the width α of Blinn–Phong’s lobe): " (worse_names.join(", ")) ". "
                @if 2 * shiny_worse > worse.len() {
                    "Most of these, " (shiny_worse) ", are very shiny (α < " (SHINY) "); a narrow lobe alone does not decide, as GGX is better for " (all_shiny - shiny_worse) " of the " (all_shiny) " that are. "
                } @else {
                    "Of these " (shiny_worse) " are very shiny (α < " (SHINY) "). "
                }
                @if 2 * short_better > worse.len() {
                    "For " (short_better) " of the " (worse.len()) " Cook–Torrance is better than GGX, too: their lobes fall off faster than GGX’s, which a short tail fits. "
                }
            }
            "The microfacet models had one more choice, that of F. With F for n = 1.5 throughout, the median error of GGX is " (fixed(bound_median, 2)) ", and it is better than Blinn–Phong for " (bound_better) " of " (fits.len()) "."
        }
        }
    }
}
