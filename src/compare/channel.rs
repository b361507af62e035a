//! The legends of debug channels, in a picture.

use super::{
    canvas::{Canvas, Rect, in_corner},
    layout::areas,
    legend::Lettered,
};
use crate::{channel::Legend, optics::viridis::viridis, scene::Comparison};

/// The picture of a layout with the legends of its views, in the order of [`Comparison::views`], as far as
/// they have legends, and there is room. Each legend is at the letter of its view; without letters, all are at the upper left.
#[must_use]
pub fn with_legends(
    comparison: &Comparison,
    rgb8: Vec<u8>,
    size: [u32; 2],
    legends: &[Option<Legend>],
) -> Vec<u8> {
    let mut canvas = Canvas { size, rgb8 };
    let areas = areas(comparison, size, legends.len());
    for area in &areas {
        let room = area.clear_of_letter(&canvas);
        if let Some(Some(legend)) = legends.get(area.place) {
            draw(&mut canvas, room, area.corner, legend);
        }
    }
    if areas.is_empty() {
        let mut top = 0;
        for legend in legends.iter().flatten() {
            let room = [0, top, size[0], size[1].saturating_sub(top)];
            if let Some([_, y, _, height]) = draw(&mut canvas, room, [false, false], legend) {
                top = y + height;
            }
        }
    }
    canvas.rgb8
}

/// Draws a legend in a corner of a part of the picture; the flags select right and bottom. Returns its
/// rectangle, or `None` without room.
fn draw(canvas: &mut Canvas, room: Rect, corner: [bool; 2], legend: &Legend) -> Option<Rect> {
    let [_, _, across, down] = room;
    let plate = Lettered::new(canvas.scale(), [across, down], legend, 2)?;
    let place = in_corner(room, corner, plate.size, plate.margin);
    plate.draw(canvas, place, |at| (255.0 * viridis(at)).to_array().map(|c| c.round() as u8));
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_has_its_colours_and_leaves_small_pictures_alone() {
        let legend = Some(Legend {
            title: "Depth, m".to_owned(),
            scale: Some(["0", "1", "2"].map(str::to_owned)),
            colours: vec![([255, 0, 200], "not a number".to_owned())],
        });
        let size = [320, 180];
        let with_legend = |rgb8: Vec<u8>, size| {
            with_legends(&Comparison::default(), rgb8, size, std::slice::from_ref(&legend))
        };
        let picture = with_legend(vec![100; 3 * 320 * 180], size);
        let near = |a: [u8; 3], b: [u8; 3]| (0..3).all(|c| a[c].abs_diff(b[c]) <= 8);
        let has = |colour: [u8; 3]| picture.as_chunks::<3>().0.iter().filter(|p| near(**p, colour)).count();
        let [low, high] = [0.0, 1.0].map(|x| (255.0 * viridis(x)).to_array().map(|c| c.round() as u8));
        assert!(has([255, 0, 200]) > 20 && has(high) > 0 && has(low) > 0);
        assert!(has([100; 3]) > 320 * 180 / 2, "it is in a corner");
        let small = vec![100; 3 * 24 * 24];
        assert_eq!(with_legend(small.clone(), [24, 24]), small);
    }
}
