//! Labels of rows in pictures: below each copy the values in which it differs from the others.

use glam::Vec3;

use super::{
    Cell,
    canvas::{Canvas, Rect},
};
use crate::{
    caption::{Ground, Part, draw_line, line_width, row_labels},
    lettering::Lettering,
    registry::Registry,
    scene::{
        Scene,
        observer::{NEAR, aspect, clip_from_room, orientation},
    },
};

/// Maximum number of labels in a view; more would be the picture.
const MOST: usize = 400;
/// Text size in a picture of 720 lines, and the smallest legible one, pixels.
const TEXT: f32 = 18.0;
const SMALLEST: f32 = 8.0;
/// The opacity of the plate behind a text: any picture behind it leaves a contrast of 7:1.
const PLATE: f32 = 0.75;

/// A picture with the labels of its rows. `views` are the places of its views, each with the scene it shows.
#[must_use]
pub fn with_row_labels<'s>(
    rgb8: Vec<u8>,
    size: [u32; 2],
    views: impl IntoIterator<Item = (Cell, &'s Scene)>,
    registry: &Registry,
) -> Vec<u8> {
    let mut canvas = Canvas { size, rgb8 };
    let mut done = Vec::new();
    for (Cell { left, top, width, height, .. }, scene) in views {
        let area = [left, top, width, height];
        // Where views lie over each other, one has the labels.
        if !done.contains(&area) {
            draw(&mut canvas, area, scene, registry);
            done.push(area);
        }
    }
    canvas.rgb8
}

fn draw(canvas: &mut Canvas, area: Rect, scene: &Scene, registry: &Registry) {
    let labels = row_labels(scene, registry);
    let seen = |(i, parts): (usize, Vec<Part>)| Some((below(scene, i, area)?, parts));
    let labels: Vec<_> = labels.into_iter().filter_map(seen).take(MOST).collect();
    if labels.is_empty() {
        // Fonts take longer to read than a small picture takes to draw.
        return;
    }
    let (style, usual) = (Lettering::Regular, TEXT * canvas.scale());
    let ground = Ground::of(&scene.display);
    let room = apart(&labels, style.height(usual)).unwrap_or(f32::INFINITY);
    let labels: Vec<_> = labels.into_iter().map(|(at, parts)| (at, vec![parts])).collect();
    let widest = |labels: &[([f32; 2], Vec<Vec<Part>>)]| {
        let lines = labels.iter().flat_map(|(_, lines)| lines);
        lines.map(|line| line_width(line, usual)).max().unwrap_or(0) as f32
    };
    // Where there is no room for all values beside each other, they stand below each other.
    let labels = match widest(&labels) + 0.7 * usual > room {
        true => labels.into_iter().map(|(at, lines)| (at, one_by_one(lines))).collect(),
        false => labels,
    };
    let widest = widest(&labels);
    // Padding of a third of a line at both sides.
    let px = (usual * room / (widest + 0.7 * usual)).clamp(SMALLEST.min(usual), usual);
    let mut plates: Vec<Rect> = Vec::with_capacity(labels.len());
    for ([x, y], lines) in &labels {
        let (pad, line) = ((0.25 * px).round() as u32, style.height(px));
        let widths: Vec<_> = lines.iter().map(|line| line_width(line, px)).collect();
        let width = widths.iter().max().copied().unwrap_or(0) + 2 * pad;
        let height = line * lines.len() as u32;
        let [left, top, across, down] = area;
        let at = |middle: f32, extent: u32, [from, room]: [u32; 2]| {
            (middle - 0.5 * extent as f32).round().max(0.0).min(room.saturating_sub(extent) as f32) as u32
                + from
        };
        let plate = [
            at(*x, width, [left, across]),
            at(y + 0.5 * height as f32 + 0.3 * px, height, [top, down]),
            width,
            height,
        ];
        // Two over each other could not be read; the first stays, as in the window.
        if plates.iter().any(|other| overlap(*other, plate)) {
            continue;
        }
        plates.push(plate);
        canvas.fill(plate, ground.colour, PLATE);
        for (i, (parts, own)) in lines.iter().zip(widths).enumerate() {
            let at = [plate[0] + (width - own) / 2, plate[1] + i as u32 * line];
            let at = at.map(|v| i32::try_from(v).unwrap_or(i32::MAX));
            draw_line(parts, &mut canvas.rgb8, canvas.size, at, px, ground.title);
        }
    }
}

/// Each part of some lines in a line of its own.
fn one_by_one(lines: Vec<Vec<Part>>) -> Vec<Vec<Part>> {
    lines.into_iter().flatten().map(|part| vec![part]).collect()
}

/// True if two rectangles have pixels in common.
fn overlap(a: Rect, b: Rect) -> bool {
    (0..2).all(|axis| a[axis] < b[axis] + b[axis + 2] && b[axis] < a[axis] + a[axis + 2])
}

/// The point below a visible object, pixels from the corner of an area; `None` if its middle is not in it.
fn below(scene: &Scene, i: usize, [_, _, width, height]: Rect) -> Option<[f32; 2]> {
    let object = scene.objects.get(i).filter(|object| object.visible)?;
    let size = [width, height].map(|side| side as f32);
    let clip = clip_from_room(&scene.observer, aspect([width, height]) as f32);
    let project = |p: Vec3| {
        let p = clip * p.extend(1.0);
        (p.w > NEAR).then(|| [0.5 * (1.0 + p.x / p.w) * size[0], 0.5 * (1.0 - p.y / p.w) * size[1]])
    };
    let [x, y] = project(object.position)?;
    let inside = (0.0..size[0]).contains(&x) && (0.0..size[1]).contains(&y);
    let down = orientation(scene.observer.direction) * Vec3::NEG_Y;
    project(object.position + down * (0.5 * object.size)).filter(|_| inside)
}

/// The smallest distance between neighbours in one line of text, pixels.
fn apart(labels: &[([f32; 2], Vec<Part>)], line: u32) -> Option<f32> {
    let each = labels.iter().enumerate().flat_map(|(i, (a, _))| labels[..i].iter().map(move |(b, _)| (a, b)));
    let beside = each.filter(|(a, b)| (a[1] - b[1]).abs() < line as f32).map(|(a, b)| (a[0] - b[0]).abs());
    beside.min_by(f32::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        parameter::Value,
        scene::{Background, Object, Repeat, Repetition, Varied},
    };

    fn row(labels: bool) -> Scene {
        let varied = Varied {
            parameter: "material.k_d".to_owned(),
            from: Some(0.6),
            to: Some(0.8),
            ..Varied::default()
        };
        let repeat = Repeat { columns: 3, spacing: Vec3::X, labels, vary: vec![varied], ..Repeat::default() };
        let entry = Object {
            position: Vec3::new(4.0, 5.0, 5.0),
            size: 0.8,
            repeat: Repetition::Entry(Box::new(repeat)),
            ..Object::default()
        };
        let scene = Scene { objects: vec![entry], reflection_model: "phong".to_owned(), ..Scene::default() };
        scene.expanded(&Registry::builtin()).expect("a row")
    }

    #[test]
    fn each_copy_has_a_label_below_it_if_the_row_wants_labels() {
        let size = [320, 180];
        let cell = Cell { view: 0, left: 0, top: 0, width: 320, height: 180 };
        let black = vec![0; 320 * 180 * 3];
        let drawn = |scene: &Scene| {
            with_row_labels(black.clone(), size, [(cell, scene), (cell, scene)], &Registry::builtin())
        };
        assert_eq!(drawn(&row(false)), black);
        let picture = drawn(&row(true));
        let lit = |x: usize, y: usize| picture[3 * (y * 320 + x)] > 0;
        let middle = below(&row(true), 1, [0, 0, 320, 180]).expect("in sight");
        assert!((middle[0] - 160.0).abs() < 0.01 && middle[1] > 90.0, "{middle:?}");
        let line = (middle[1] as usize..180).find(|y| lit(160, *y)).expect("a label");
        let starts = (1..320).filter(|x| lit(*x, line) && !lit(x - 1, line)).count();
        assert_eq!(starts, 3, "three plates beside each other");
        // Beside the letters, at the left edge of the plate.
        let plate = (1..160).find(|x| lit(*x, line)).map(|x| picture[3 * (line * 320 + x)]);
        assert_eq!(plate, Some(18), "a dark plate over black");
        assert!((0..80).all(|y| (0..320).all(|x| !lit(x, y))), "nothing above the objects");
    }

    #[test]
    fn many_values_stand_below_each_other_and_no_label_is_left_out() {
        let mut scene = row(true);
        let Repetition::Copy { entry, .. } = &scene.objects[0].repeat else { panic!("a row") };
        let mut entry = (**entry).clone();
        let Repetition::Entry(repeat) = &mut entry.repeat else { panic!("a row") };
        let colours = [[250, 120, 10], [10, 120, 250], [120, 250, 10]].map(Value::Colour).to_vec();
        repeat.vary.push(Varied {
            parameter: "material.base_colour".to_owned(),
            values: colours,
            ..Varied::default()
        });
        scene.objects = vec![entry];
        let scene = scene.expanded(&Registry::builtin()).expect("a row");
        let cell = Cell { view: 0, left: 0, top: 0, width: 640, height: 360 };
        let picture =
            with_row_labels(vec![0; 640 * 360 * 3], [640, 360], [(cell, &scene)], &Registry::builtin());
        let lit = |x: usize, y: usize| picture[3 * (y * 640 + x)] > 0;
        let starts = |y: usize| (1..640).filter(|x| lit(*x, y) && !lit(x - 1, y)).count();
        let first = (0..360).find(|y| (0..640).any(|x| lit(x, *y))).expect("labels");
        let last = (0..360).rfind(|y| (0..640).any(|x| lit(x, *y))).expect("labels");
        assert_eq!((starts(first), starts(last)), (3, 3));
        assert!(last - first > 14, "two lines: {first} to {last}");
    }

    #[test]
    fn labels_on_a_light_background_are_dark_on_a_light_plate() {
        let size = [640, 360];
        let cell = Cell { view: 0, left: 0, top: 0, width: 640, height: 360 };
        let mut scene = row(true);
        scene.display.background = Background::Colour;
        // Over black, where a plate is darkest.
        let black = vec![0; 640 * 360 * 3];
        let picture = with_row_labels(black, size, [(cell, &scene)], &Registry::builtin());
        let codes: Vec<u8> = picture.chunks(3).map(|p| p[0]).filter(|code| *code > 0).collect();
        let count = |codes: &[u8], is: fn(u8) -> bool| codes.iter().filter(|code| is(**code)).count();
        assert!(count(&codes, |code| code == 185) > 500, "the plate");
        assert!(count(&codes, |code| code < 60) > 20, "the ink");
        assert_eq!(count(&codes, |code| code > 185), 0);
    }
}
