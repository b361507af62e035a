//! The legend of a debug channel, in a picture.

use super::canvas::{BRIGHT, Canvas, DARK};
use crate::{channel::Legend, lettering::Lettering, optics::viridis::viridis};

/// The picture with a legend in its upper left corner, if there is room for it.
#[must_use]
pub fn with_legend(rgb8: Vec<u8>, size: [u32; 2], legend: &Legend) -> Vec<u8> {
    let mut canvas = Canvas { size, rgb8 };
    draw(&mut canvas, legend);
    canvas.rgb8
}

fn draw(canvas: &mut Canvas, legend: &Legend) {
    let scale = canvas.scale();
    let px = 16.0 * scale;
    let style = Lettering::Regular;
    let [pad, gap, bar] = [10.0, 4.0, 14.0].map(|v| (v * scale).round() as u32);
    let line = style.height(px);
    let of_colours = legend.colours.iter().map(|(_, text)| bar + 2 * gap + style.width(px, text));
    let least = match &legend.scale {
        Some(numbers) => numbers.iter().map(|n| style.width(px, n)).sum::<u32>() + 4 * gap,
        None => 0,
    };
    let wanted = of_colours.chain([style.width(px, &legend.title), least]).max().unwrap_or_default();
    let width = wanted.min(canvas.size[0].saturating_sub(4 * pad));
    let title = style.lines(px, &legend.title, width, 3);
    let of_scale = if legend.scale.is_some() { 2 * gap + bar + line } else { 0 };
    let height = line * (title.len() + legend.colours.len()) as u32 + of_scale;
    if width < least || height + 4 * pad > canvas.size[1] {
        return;
    }
    canvas.fill([pad, pad, width + 2 * pad, height + 2 * pad], DARK, 0.88);
    let (left, mut y) = (2 * pad, 2 * pad);
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
        let picture = with_legend(vec![100; 3 * 320 * 180], size, &legend);
        let near = |a: [u8; 3], b: [u8; 3]| (0..3).all(|c| a[c].abs_diff(b[c]) <= 8);
        let has = |colour: [u8; 3]| picture.as_chunks::<3>().0.iter().filter(|p| near(**p, colour)).count();
        let [low, high] = [0.0, 1.0].map(|x| (255.0 * viridis(x)).to_array().map(|c| c.round() as u8));
        assert!(has([255, 0, 200]) > 20 && has(high) > 0 && has(low) > 0);
        assert!(has([100; 3]) > 320 * 180 / 2, "it is in a corner");
        let small = vec![100; 3 * 24 * 24];
        assert_eq!(with_legend(small.clone(), [24, 24], &legend), small);
    }
}
