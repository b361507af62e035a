//! Phenomenon 4: the shape of the highlight.

use maud::{Markup, html};

use super::{Chapter, Lab, StudyError, image, pictures};
use crate::{
    curves::data::LARGEST_ANGLE,
    optics::{Frame, TermSelection, colour::Encoding},
};
use conclusion::Conclusion;
use merl::Merl;
use paint::Paints;

mod conclusion;
mod contestant;
mod merl;
mod paint;

pub(super) use contestant::Contestant;
pub(super) use paint::paint_samples;

const SCENE: &str = include_str!("../../../scenes/lobe_shape.json");

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let five_lobes = five_lobes(lab)?;
    let paints = Paints::fit(lab)?;
    let paint_results = paints.results(lab)?;
    let merl = Merl::fit(lab);
    let merl_results = merl.results(lab)?;
    let conclusion = Conclusion { paints: &paints, merl: &merl };
    let body = html! {
        (question_and_method(&merl))
        h3 { "Results" }
        (five_lobes)
        (paint_results)
        (merl_results)
        h3 { "Conclusion" }
        div .conclusion { (conclusion.text()) }
    };
    Ok(Chapter {
        title: "Shape of the specular lobe",
        body,
        finding: conclusion.finding(),
        shown: conclusion.is_confirmed(),
        tables: vec![paints.raw(), merl.raw()],
    })
}

/// The figure of five lobes of the same roughness.
fn five_lobes(lab: &mut Lab) -> Result<Markup, StudyError> {
    let mut scene = lab.scene(SCENE)?;
    // A row of objects, without the room above and below it.
    scene.observer.field_of_view = 4.936;
    let size = lab.size(1200, 240);
    let picture = lab.render(&scene, "", TermSelection::All, size);
    let names: Vec<&str> = scene.objects.iter().map(|o| o.name.as_deref().unwrap_or_default()).collect();
    // The height of each lobe, with light and viewer along the normal.
    let heights: Vec<f64> = scene
        .objects
        .iter()
        .filter_map(|o| {
            let model = lab.registry.model(o.reflection_model.as_deref()?)?;
            let surface = model.instantiate(&o.material, Encoding::Srgb);
            Some(f64::from(surface.response(glam::Vec3::Z, glam::Vec3::Z, &Frame::LOCAL).specular.y))
        })
        .collect();
    let lower: Vec<String> = names
        .iter()
        .zip(&heights)
        .filter(|(_, h)| **h < 0.95 * heights[0])
        .map(|(name, h)| format!("{name} ({:.0}\u{a0}%)", 100.0 * h / heights[0]))
        .collect();
    Ok(lab.figure(
        &html! {
            div .wide {
                (pictures(&[(image(&picture.to_rgb8(&scene.display), size, "Five highlights of the same roughness")?, "")]))
                div .labels style=(format!("--columns:{}", names.len())) { @for name in &names { span { (name) } } }
            }
        },
        &html! {
            "Black plastic under one lamp: five lobes of the same roughness (α = 0.15, n = 87). "
            @if lower.is_empty() { "All have the same height. " } @else { "All have the same height except those that reach less of it: " (lower.join("; ")) ". " }
            "They differ in their tails: GGX and GTR still glow where Blinn–Phong and Beckmann are dark. Scene "
            code { "lobe_shape.json" } "."
        },
    ))
}

fn question_and_method(merl: &Merl) -> Markup {
    html! {
        h3 { "Question" }
        p { "Which model’s highlight has the shape of real highlights, each with its best parameters?" }
        h3 { "Method" }
        p { "Every model is fitted with three free numbers, the diffuse reflectance d, a scale s and the width α of its own specular lobe:" }
        p .equation { span { "f(l, v) = d/π + s · lobe(l, v; α)." } }
        p {
            "The fit minimises the root mean square of ln f − ln f" sub { "data" } " over all pairs of directions, the log error. For each width, d and s are found by Levenberg’s method; the width by "
            "search (" code { "study::fit" } "). The lobe is the specular term of the program’s custom models: " code { "blinn_phong" } " (its response divided by π cos θ; n from α), " code { "ward" } ", and " code { "microfacet" }
            " as Cook–Torrance (Beckmann, V-cavities) and as GGX (Smith’s height-correlated masking)."
        }
        p {
            "Data are, first, three paints measured at Cornell University, each in its brightest band. Directions beyond " (LARGEST_ANGLE) "° are left out, since the measurement is unreliable there. "
            "Second, the materials of the MERL database, not as measured but as represented by published fits of the SGD model, evaluated at " (merl.directions)
            " pairs of directions concentrated about the mirror direction like the database (luminance). "
            @if merl.flat > 0 { "Of the " (merl.flat + merl.fits.len()) " materials " (merl.flat) " are left out, because their SGD fit has no specular part. " }
            "The microfacet models may choose here between the Fresnel term for n = 1.5 and none, because metals need the latter."
        }
    }
}
