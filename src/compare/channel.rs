//! The legends of debug channels, in a picture.

use super::{
    canvas::{BRIGHT, Canvas, DARK, Rect},
    layout::areas,
};
use crate::{channel::Legend, lettering::Lettering, optics::viridis::viridis, scene::Comparison};

/// The picture of a layout with the legends of its views, in the order of [`Comparison::views`], as far as
/// there is room. Each legend is at the letter of its view; without letters, all are at the upper left.
#[must_use]
pub fn with_legends(comparison: &Comparison, rgb8: Vec<u8>, size: [u32; 2], legends: &[Legend]) -> Vec<u8> {
    let mut canvas = Canvas { size, rgb8 };
    let areas = areas(comparison, size, legends.len());
    for area in &areas {
        let room = area.clear_of_letter(&canvas);
        if let Some(legend) = legends.get(area.place) {
            draw(&mut canvas, room, area.corner, legend);
        }
    }
    if areas.is_empty() {
        let mut top = 0;
        for legend in legends {
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
fn draw(
    canvas: &mut Canvas,
    [left, top, across, down]: Rect,
    [at_right, at_bottom]: [bool; 2],
    legend: &Legend,
) -> Option<Rect> {
    let scale = canvas.scale();
    let px = 16.0 * scale;
    let style = Lettering::Regular;
    let [pad, gap, bar] = [10.0, 4.0, 14.0].map(|v| (v * scale).round() as u32);
    let line = style.height(px);
    let of_colours = legend.colours.iter().map(|(_, text)| bar + 2 * gap + style.width(px, text));
    let of_numbers = match &legend.scale {
        Some(numbers) => numbers.iter().map(|n| style.width(px, n)).sum::<u32>() + 4 * gap,
        None => 0,
    };
    let least = of_colours.fold(of_numbers, u32::max);
    let width = style.width(px, &legend.title).max(least).min(across.saturating_sub(4 * pad));
    let title = style.lines(px, &legend.title, width, 3);
    let of_scale = if legend.scale.is_some() { 2 * gap + bar + line } else { 0 };
    let height = line * (title.len() + legend.colours.len()) as u32 + of_scale;
    let is_wide = title.iter().any(|text| style.width(px, text) > width);
    if width == 0 || width < least || is_wide || height + 4 * pad > down {
        return None;
    }
    let plate = [width + 2 * pad, height + 2 * pad];
    let x = if at_right { left + across - plate[0] - pad } else { left + pad };
    let y = if at_bottom { top + down - plate[1] - pad } else { top + pad };
    let place = [x, y, plate[0], plate[1]];
    canvas.fill(place, DARK, 0.88);
    let (left, mut y) = (x + pad, y + pad);
    for text in &title {
        canvas.text(style, [left, y], px, text);
        y += line;
    }
    if let Some(numbers) = &legend.scale {
        y += gap;
        canvas.fill([left - 1, y - 1, width + 2, bar + 2], BRIGHT, 0.5);
        for x in 0..width {
            let colour = (255.0 * viridis((x as f32 + 0.5) / width as f32)).to_array();
            canvas.fill([left + x, y, 1, bar], colour.map(|c| c.round() as u8), 1.0);
        }
        y += bar;
        for (number, at) in numbers.iter().zip([0.0, 0.5, 1.0]) {
            let free = width.saturating_sub(style.width(px, number));
            canvas.text(style, [left + (at * free as f32) as u32, y], px, number);
        }
        y += line + gap;
    }
    for (colour, text) in &legend.colours {
        let top = y + line.saturating_sub(bar) / 2;
        canvas.fill([left - 1, top - 1, bar + 2, bar + 2], BRIGHT, 0.5);
        canvas.fill([left, top, bar, bar], *colour, 1.0);
        canvas.text(style, [left + bar + 2 * gap, y], px, text);
        y += line;
    }
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_has_its_colours_and_leaves_small_pictures_alone() {
        let legend = Legend {
            title: "Depth, m".to_owned(),
            scale: Some(["0", "1", "2"].map(str::to_owned)),
            colours: vec![([255, 0, 200], "not a number".to_owned())],
        };
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
