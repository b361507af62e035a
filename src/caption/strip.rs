//! The strip below a picture with its caption.

use std::collections::BTreeMap;

use super::{Caption, Part, closing};
use crate::lettering::Lettering;

/// Maximum number of lines for the facts.
const LINES: usize = 3;
/// Smallest legible text, in pixels.
const SMALLEST: f32 = 12.0;

/// Text size for a picture of this size, in pixels.
#[must_use]
pub fn type_size([width, height]: [u32; 2]) -> f32 {
    // As in a 16:9 picture: the strip must not consist of many lines under a narrow picture, nor be taller
    // than a flat one.
    let height = height.min(width / 16 * 9);
    (height as f32 / 48.0).round().clamp(SMALLEST, 96.0)
}

/// Draws parts of a caption in one line, starting at `at`.
pub fn draw_line(parts: &[Part], picture: &mut [u8], size: [u32; 2], at: [i32; 2], px: f32, colour: [u8; 3]) {
    let line = Line::of(parts, px);
    line.runs.iter().for_each(|run| run.draw(picture, size, at, px, colour));
}

/// Width of parts in one line, in pixels.
#[must_use]
pub fn line_width(parts: &[Part], px: f32) -> u32 {
    Line::of(parts, px).width
}

/// The most rows that a caption adds to a picture of this size.
#[must_use]
pub fn most_rows(size: [u32; 2]) -> u32 {
    let px = type_size(size);
    let row = |px: f32| Lettering::Regular.height(px) + (0.12 * px).round() as u32;
    // The facts, and the name of the program alone.
    1 + 2 * (0.6 * px).round() as u32 + row((1.15 * px).round()) + (LINES as u32 + 1) * row(px)
}

/// The picture with its caption in a strip below it, and the size of the whole. `size` is the size of the
/// picture; the height of the strip is added to it.
#[must_use]
pub fn draw(caption: &Caption, mut picture: Vec<u8>, size: [u32; 2]) -> (Vec<u8>, [u32; 2]) {
    let strip = Strip::of(caption, size);
    let [width, height] = size;
    let whole = [width, height + strip.height];
    let row = width as usize * 3;
    // No more than it takes: a picture may be most of the memory.
    picture.reserve_exact((row * whole[1] as usize).saturating_sub(picture.len()));
    picture.resize(row * height as usize, 0);
    picture.extend(caption.ground.line.repeat(width as usize));
    picture.extend(caption.ground.colour.repeat(width as usize * strip.height.saturating_sub(1) as usize));
    for (top, px, colour, line) in &strip.lines {
        let at = [strip.left as i32, (height + top) as i32];
        line.runs.iter().for_each(|run| run.draw(&mut picture, whole, at, *px, *colour));
    }
    (picture, whole)
}

/// Characters of a line.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    left: u32,
    lettering: Lettering,
    text: String,
}

impl Run {
    fn draw(&self, picture: &mut [u8], size: [u32; 2], at: [i32; 2], px: f32, colour: [u8; 3]) {
        let at = [at[0].saturating_add_unsigned(self.left), at[1]];
        self.lettering.draw(picture, size, at, px, colour, &self.text);
    }
}

/// A line of runs.
#[derive(Clone, Debug, Default, PartialEq)]
struct Line {
    runs: Vec<Run>,
    width: u32,
}

impl Line {
    fn of(parts: &[Part], px: f32) -> Self {
        let mut line = Self::default();
        for (i, part) in parts.iter().enumerate() {
            if let Some(before) = i.checked_sub(1) {
                line.push(Lettering::Regular, part.joint(&parts[before]), px);
            }
            line.part(part, px);
        }
        line
    }

    fn text(lettering: Lettering, text: &str, px: f32) -> Self {
        let mut line = Self::default();
        line.push(lettering, text, px);
        line
    }

    fn push(&mut self, lettering: Lettering, text: &str, px: f32) {
        self.runs.push(Run { left: self.width, lettering, text: text.to_owned() });
        self.width += lettering.width(px, text);
    }

    fn part(&mut self, part: &Part, px: f32) {
        if !part.symbol.is_empty() {
            self.push(Lettering::Symbol, part.symbol, px);
            self.width += (0.28 * px).round() as u32;
        }
        self.push(Lettering::Regular, &part.text, px);
    }
}

/// The lines of a strip, each with the distance of its top from the picture, its size and its colour.
struct Strip {
    left: u32,
    height: u32,
    lines: Vec<(u32, f32, [u8; 3], Line)>,
}

impl Strip {
    fn of(caption: &Caption, size: [u32; 2]) -> Self {
        let (px, ground) = (type_size(size), caption.ground);
        let title_px = (1.15 * px).round();
        // A picture of a few pixels has no room for margins.
        let left = ((0.9 * px) as u32).min(size[0] / 16);
        let room = size[0] - 2 * left;
        let mut rows: Vec<(f32, [u8; 3], Line)> = Vec::new();
        if !caption.title.is_empty() {
            rows.push((title_px, ground.title, elided(Lettering::Semibold, &caption.title, title_px, room)));
        }
        rows.extend(facts(&caption.facts, px, room).into_iter().map(|line| (px, ground.text, line)));
        // Lines of different sizes share a baseline; the program's name is beside the first where there is
        // room.
        let program = elided(Lettering::Regular, caption.program, px, room);
        let beside = |(_, _, line): &(f32, [u8; 3], Line)| line.width + 2 * px as u32 + program.width <= room;
        let last = rows.len().saturating_sub(1);
        let place = [0, last].into_iter().find(|i| rows.get(*i).is_some_and(beside));
        if place.is_none() {
            rows.push((px, ground.weak, Line::default()));
        }
        let place = place.unwrap_or(rows.len() - 1);

        let mut top = 1 + (0.6 * px).round() as u32;
        let mut lines = Vec::new();
        for (i, (size, colour, line)) in rows.into_iter().enumerate() {
            let foot = Lettering::Regular.foot(size);
            if i == place {
                let mut program = program.clone();
                let right = room.saturating_sub(program.width);
                program.runs.iter_mut().for_each(|run| run.left += right);
                lines.push((
                    top + (foot - Lettering::Regular.foot(px)).round() as u32,
                    px,
                    ground.weak,
                    program,
                ));
            }
            lines.push((top, size, colour, line));
            top += Lettering::Regular.height(size) + (0.12 * px).round() as u32;
        }
        Self { left, height: top + (0.6 * px).round() as u32, lines }
    }
}

/// A text in one line that fits into the room, shortened if necessary.
fn elided(lettering: Lettering, text: &str, px: f32, room: u32) -> Line {
    let text = lettering.lines(px, text, room, 1).into_iter().next().unwrap_or_default();
    let line = Line::text(lettering, &text, px);
    // A line with less than the ellipsis means nothing.
    if line.width <= room { line } else { Line::default() }
}

/// The facts in lines. Facts that do not fit are dropped, highest rank first, and last first within a rank;
/// "…" replaces those of each rank.
fn facts(parts: &[Part], px: f32, room: u32) -> Vec<Line> {
    let mut left: Vec<_> = parts.iter().enumerate().collect();
    // The first dropped part of each rank, by its position among all parts.
    let mut gaps: BTreeMap<u8, usize> = BTreeMap::new();
    loop {
        let gap = |i: usize| Part { continues: parts[i].continues, ..Part::new(0, "…") };
        let marks = gaps.values().map(|i| (*i, gap(*i)));
        let mut shown: Vec<_> = left.iter().map(|(i, part)| (*i, (*part).clone())).chain(marks).collect();
        shown.sort_by_key(|(i, _)| *i);
        let shown: Vec<_> = shown.into_iter().map(|(_, part)| part).collect();
        let mut lines = broken(&shown, px, room);
        // The first part always stays.
        let least = left.iter().skip(1).map(|(_, part)| part.rank).max();
        match left.iter().rposition(|(i, part)| *i > 0 && Some(part.rank) == least) {
            Some(at) if lines.len() > LINES => {
                let (i, part) = left.remove(at);
                gaps.insert(part.rank, i);
            }
            _ => {
                lines.truncate(LINES);
                return lines;
            }
        }
    }
}

/// The parts in lines that fit into the room, broken between parts.
fn broken(parts: &[Part], px: f32, room: u32) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let joint = i.checked_sub(1).map_or("", |before| part.joint(&parts[before]));
        // Room for the comma at the end of a line.
        let open = |next: &Part| Lettering::Regular.width(px, closing(next.joint(part)));
        let more = parts.get(i + 1).map_or(0, open);
        let mut own = Line::default();
        own.part(part, px);
        if own.width + more > room {
            own = elided(Lettering::Regular, &part.words(), px, room.saturating_sub(more));
        }
        match lines.last_mut() {
            Some(line) if line.width + Lettering::Regular.width(px, joint) + own.width + more <= room => {
                line.push(Lettering::Regular, joint, px);
                let left = line.width;
                line.runs.extend(own.runs.into_iter().map(|run| Run { left: left + run.left, ..run }));
                line.width += own.width;
            }
            last => {
                if let Some(line) = last {
                    line.push(Lettering::Regular, closing(joint), px);
                }
                lines.push(own);
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        caption::Ground,
        parameter::Value,
        registry::Registry,
        scene::{Background, Scene},
    };

    fn text(lines: &[Line]) -> Vec<String> {
        let text = |line: &Line| line.runs.iter().map(|run| run.text.as_str()).collect();
        lines.iter().map(text).collect()
    }

    fn parts(n: usize) -> Vec<Part> {
        let model = [Part::new(0, "Cook–Torrance"), Part::new(1, "Phong shading")];
        let value = |i| Part { symbol: "k_d", continues: i > 0, ..Part::new(3, format!("= 0.{i}")) };
        model.into_iter().chain((0..n).map(value)).chain([Part::new(1, "AgX")]).collect()
    }

    #[test]
    fn no_line_is_wider_than_the_room_and_what_is_left_out_is_marked() {
        for room in [60, 120, 200, 320, 600, 2000] {
            for n in [0, 3, 9, 40] {
                let lines = facts(&parts(n), 14.0, room);
                assert!(lines.len() <= LINES, "{room}, {n}: {:?}", text(&lines));
                for line in &lines {
                    assert!(line.width <= room, "{room}, {n}: {:?}", text(&lines));
                    let end =
                        line.runs.last().map_or(0, |run| run.left + run.lettering.width(14.0, &run.text));
                    assert_eq!(end, line.width);
                }
                assert!(
                    !text(&lines).iter().any(|line| line.ends_with('·')),
                    "{room}, {n}: {:?}",
                    text(&lines)
                );
                let all = text(&lines).join("");
                let shown = all.matches("k_d").count();
                assert!(shown == n || all.contains('…'), "{room}, {n}: {all}");
                // Values are dropped before the display, and the model stays.
                assert!(all.contains("AgX") || shown == 0, "{room}, {n}: {all}");
                assert!(all.starts_with("Cook") || room == 60, "{room}, {n}: {all}");
            }
        }
        // Dropped models are marked in their place, and so are values.
        let models = (0..20).flat_map(|i| {
            let value = Part { symbol: "α", continues: true, ..Part::new(3, format!("= {i}")) };
            [Part::new(if i == 0 { 0 } else { 2 }, format!("Model {i}")), value]
        });
        let models: Vec<_> = models.chain([Part::new(1, "Flat shading")]).collect();
        let lines = text(&facts(&models, 14.0, 320));
        assert!(
            lines[0].starts_with("Model 0, … · Model 1 · ") && lines[2].ends_with(" · … · Flat shading"),
            "{lines:?}"
        );
        let lines = text(&facts(&parts(40), 14.0, 320));
        assert!(lines[1].ends_with(',') && lines[2].ends_with(", … · AgX"), "{lines:?}");
    }

    #[test]
    fn the_picture_stays_and_the_strip_is_added() {
        let mut scene = Scene { name: Some("Gold".to_owned()), ..Scene::default() };
        scene.objects[0].material.set("k_d", Value::Number(0.5));
        let caption = super::super::of_view(&scene, 0, &Registry::builtin()).expect("the scene itself");
        let ground = caption.ground.colour;
        let mut heights = Vec::new();
        for size in [[640, 360], [1280, 720], [64, 36], [3, 500], [1, 1]] {
            let picture: Vec<u8> = (0..size[0] * size[1] * 3).map(|i| (i % 249) as u8).collect();
            let (whole, [width, height]) = draw(&caption, picture.clone(), size);
            assert!(width == size[0] && height > size[1], "{size:?}");
            assert!(height <= size[1] + most_rows(size), "{size:?}");
            assert_eq!(whole.len(), (width * height * 3) as usize);
            assert_eq!(whole[..picture.len()], picture);
            // The right and lower edges keep a margin.
            let strip = &whole[picture.len() + 3 * width as usize..];
            let free = |row: &[u8]| width < 60 || row[row.len() - 3..] == ground && row[..3] == ground;
            assert!(strip.chunks(3 * width as usize).all(free), "{size:?}");
            assert!(
                strip[strip.len() - 3 * width as usize..].iter().all(|byte| *byte == ground[0]),
                "{size:?}"
            );
            heights.push(height - size[1]);
        }
        assert!(heights[0] < 60 && heights[1] < 80, "{heights:?}");
    }

    #[test]
    fn a_strip_has_no_more_rows_than_it_may_have() {
        for size in [[1, 16_384], [40, 40], [300, 300], [700, 300], [4000, 3000]] {
            for facts in [0, 3, 40].map(parts) {
                let title = "A title that is rather long".to_owned();
                let caption = Caption { title, facts, program: "A program 1.2", ground: Ground::DARK };
                assert!(Strip::of(&caption, size).height <= most_rows(size), "{size:?}");
            }
        }
        assert!(facts(&parts(40), 12.0, 1).len() <= LINES);
    }

    #[test]
    fn a_picture_with_a_light_background_has_a_light_strip() {
        let mut scene = Scene { name: Some("Gold".to_owned()), ..Scene::default() };
        scene.display.background = Background::Colour;
        let caption = super::super::of_view(&scene, 0, &Registry::builtin()).expect("the scene itself");
        let size = [640, 360];
        let white = vec![255; 640 * 360 * 3];
        let (whole, _) = draw(&caption, white.clone(), size);
        let strip: Vec<u8> = whole[white.len()..].chunks(3).map(|p| p[0]).collect();
        assert_eq!(strip.last(), Some(&Ground::LIGHT.colour[0]));
        assert!(strip.iter().filter(|code| **code < 60).count() > 100, "dark words");
        assert!(strip.iter().all(|code| *code <= Ground::LIGHT.colour[0]));
    }

    #[test]
    fn a_long_title_leaves_the_program_a_line_of_its_own() {
        let caption = |title: &str| Caption {
            title: title.to_owned(),
            facts: vec![Part::new(0, "Phong")],
            program: "Lights, Camera, Models! 0.1.0",
            ground: Ground::DARK,
        };
        let lines = |title: &str, width| {
            let strip = Strip::of(&caption(title), [width, 9 * width / 16]);
            strip
                .lines
                .into_iter()
                .map(|(top, _, _, line)| (top, text(&[line])[0].clone()))
                .collect::<Vec<_>>()
        };
        let program = |lines: &[(u32, String)]| {
            lines.iter().find(|(_, text)| text.starts_with("Lights")).map(|(top, _)| *top).expect("is there")
        };
        let short = lines("Gold", 640);
        assert_eq!(short.len(), 3);
        assert!(program(&short) < short[2].0, "beside the title");
        let long = "A comparison of gold under Blinn–Phong and metallic–roughness with three lights";
        let beside = lines(long, 640);
        assert!(program(&beside) >= beside[0].0 + 10 && beside.len() == 3, "beside the facts: {beside:?}");
        let narrow = lines(long, 200);
        assert!(narrow[0].1.ends_with('…') && program(&narrow) > narrow[1].0, "{narrow:?}");
    }
}
