//! Phenomenon 4: the shape of the highlight.

use maud::html;

use super::{
    Chapter, Lab, StudyError, image, labels, pictures, share,
    text::{Values, values},
};
use crate::optics::{Frame, TermSelection, colour::Encoding};
use merl::Merl;
use paint::Paints;

mod conclusion;
mod contestant;
mod merl;
mod paint;

pub(super) use contestant::Contestant;
pub(super) use merl::median;
pub(super) use paint::paint_samples;

const SCENE: &str = include_str!("../../../scenes/lobe_shape.json");

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let (paints, merl) = (Paints::fit(lab)?, Merl::fit(lab));
    let (mut values, is_confirmed) = conclusion::values(&paints, &merl);
    values.extend(five_lobes(lab)?);
    values.extend(paints.values(lab)?);
    values.extend(merl.values(lab));
    let tables = vec![paints.raw(), merl.raw()];
    lab.chapter(include_str!("lobe.html"), &values, is_confirmed, tables)
}

/// The picture of five lobes of the same roughness, and the names of those that are lower.
fn five_lobes(lab: &Lab) -> Result<Values, StudyError> {
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
        .map(|(name, h)| format!("{name} ({})", share(h / heights[0], 0)))
        .collect();
    let picture = image(&picture.to_rgb8(&scene.display), size, "Five highlights of the same roughness")?;
    let five_lobes = html! { (pictures(&[(picture, "")])) (labels(&names)) };
    Ok(values! { five_lobes, even: lower.is_empty(), lower: lower.join("; ") })
}
