//! The vectors of the explained point in the picture, and its polygon or vertices.

use super::{
    lobe, pairs, probe,
    room::{self, Room},
    rows,
    surface::LENGTH,
};
use crate::{
    explain::{Inside, Lit, Model, Place, Seen, Spot},
    panel::{
        is_in_sight, linked,
        marks::{Ink, Lens, OUTLINE, Sight},
        prelude::*,
    },
    reflection::Term,
    shading::Stage,
};

const WHITE: Color32 = Color32::from_rgb(0xf6, 0xf6, 0xf6);
/// Okabe–Ito yellow.
const YELLOW: Color32 = Color32::from_rgb(0xf0, 0xe4, 0x42);
/// Okabe–Ito blue, bluish green and vermilion, lightened.
const BLUE: Color32 = Color32::from_rgb(0x5a, 0xa9, 0xf5);
const GREEN: Color32 = Color32::from_rgb(0x2e, 0xd0, 0x9c);
const VERMILION: Color32 = Color32::from_rgb(0xff, 0x7a, 0x33);
/// Width of a line and of a highlighted line, in points.
const LINE: f32 = 2.25;
const LIT: f32 = 4.5;
/// Opacity factor of lines while others are highlighted.
const DIM: f32 = 0.5;
/// Distance at which the pointer is on a line, in points, and radius around the origin that is excluded because all
/// lines meet there.
const GRASP: f32 = 6.0;
const ORIGIN: f32 = 16.0;
/// Height of the caption below a picture, in points.
const CAPTION: f32 = 36.0;
/// Font size of labels, in points.
const LETTER: f32 = 13.0;
/// Projected length below which a vector counts as pointing at or away from the eye, in points.
const END_ON: f32 = 7.0;
/// Side length of a triangle above which the vertices have room for their weights, in points.
const ROOMY: f32 = 48.0;
/// Minimum picture size for vectors, in points.
const SMALLEST: f32 = 120.0;

/// Lengths of dashes and gaps, in points; empty for a solid line.
type Dashes = &'static [f32];

/// A vector in the picture: letter, direction, colour and dash pattern.
struct Arrow {
    letter: &'static str,
    way: Vec3,
    colour: Color32,
    dashes: Dashes,
}

fn arrows(spot: &Spot, lit: Option<&Lit>) -> Vec<Arrow> {
    let arrow = |letter, way, colour, dashes| Arrow { letter, way, colour, dashes };
    let geometry = lit.and_then(Lit::leading);
    let mut all = Vec::new();
    if let Some(geometry) = geometry {
        all.push(arrow("R", geometry.r, VERMILION, &[4.0, 5.0]));
        all.push(arrow("H", geometry.h, GREEN, &[10.0, 4.0, 2.0, 4.0]));
        all.push(arrow("L", geometry.l, YELLOW, &[12.0, 6.0]));
    }
    all.push(arrow("V", spot.view, BLUE, &[1.5, 5.0]));
    all.push(arrow("N", spot.normal, WHITE, &[]));
    all
}

/// Paints the vectors of the explained point into a view, while the point is pinned or under the pointer; those of a
/// pinned point also into the other views. The letters keep clear of the text over the picture, and the legend of the
/// lobe of the plates that are `taken`. Returns the rectangle of that legend.
pub fn vectors(ui: &Ui, view: usize, sight: Sight<'_>, taken: &[Rect]) -> Option<Rect> {
    let Sight { rect, written, session, registry } = sight;
    let shown = session.view.pinned.is_some() || probe::is_hovered(ui.ctx());
    let explained =
        probe::explained_in(ui.ctx(), view).filter(|_| shown && rect.size().min_elem() >= SMALLEST)?;
    // With the panel closed, a lesson only needs to show which pixel it is about.
    let explains = session.shows_vectors();
    let name = |light: usize| session.name_of(Selection::Light(light), registry);
    let mut room = Room::default();
    let legend = match explains {
        true => lobe::paint(ui, (rect, taken), &explained, session, &mut room, &name),
        false => None,
    };
    legend.iter().chain(written).for_each(|plate| room.take_plate(*plate));
    let at = ui.input(|i| i.pointer.latest_pos().filter(|_| !i.pointer.any_down()));
    let pointer = at.filter(|at| is_in_sight(ui.ctx(), rect, *at));
    let ink = Ink::new(Lens::of(session, rect));
    let scale = theme::scale_here(ui);
    let mut drawing = Drawing { ink, words: Vec::new(), rect, scale, pointer, lit: Vec::new(), near: None };
    if let Some(seen) = explained.explanation.seen.as_ref().filter(|_| explains) {
        drawing.seen(ui, seen);
    }
    if let Some(at) = probe::place(session, rect, &explained) {
        drawing.cross(at, session.view.pinned.is_some());
    }
    drawing.paint(ui, room, explained.explanation.seen.as_ref().map(|seen| &seen.model));
    legend
}

struct Drawing {
    ink: Ink,
    /// Letters and angles, each with its position and the symbols it stands for.
    words: Vec<(Pos2, String, Color32, Vec<&'static str>)>,
    rect: Rect,
    /// Scale factor of the letters.
    scale: f32,
    pointer: Option<Pos2>,
    /// The highlighted vectors.
    lit: Vec<&'static str>,
    /// Distance from the pointer to the nearest line, and the symbols of that line.
    near: Option<(f32, Vec<&'static str>)>,
}

impl Drawing {
    fn seen(&mut self, ui: &Ui, seen: &Seen) {
        let Some((_, spot)) = probe::shown_spot(ui.ctx(), seen) else { return };
        self.polygon(seen, spot);
        let lit = probe::shown_light(ui.ctx(), spot);
        let lens = self.ink.lens;
        let Some(origin) = lens.project(spot.position) else { return };
        let reach = lens.metres(spot.position, LENGTH);
        let mut all = arrows(spot, lit);
        all.retain(|arrow| pairs::belongs(&seen.model, arrow.letter));
        self.lit = pairs::lit(ui.ctx(), &seen.model);
        self.angles(&lens, spot, lit, reach, &all);
        for arrow in &all {
            self.arrow(&lens, spot.position, origin, arrow, reach);
        }
        // The colour of the term whose light it is.
        self.way(&lens, spot, reach, Palette::here(ui).term(Term::Transmitted));
        if all.len() > 1 {
            self.ink.disc(origin, 2.5, WHITE);
        }
    }

    /// The way of the ray through a solid body to the boundary where most of the light comes in, and from where: `T`.
    fn way(&mut self, lens: &Lens, spot: &Spot, reach: f32, transmitted: Color32) {
        let Some(refraction) = &spot.refraction else { return };
        let (Some(Inside::Ways(turns, _)), Some((last, way))) = (&refraction.inside, refraction.main_way())
        else {
            return;
        };
        let points = [spot.position].into_iter().chain(turns[..=last].iter().map(|turn| turn.position));
        let (width, colour) = self.stroke(&["T"], LINE, transmitted);
        for run in lens.path(&points.collect::<Vec<_>>()) {
            self.ink.stroke(run, width, colour);
        }
        let from = turns[last].position;
        if let Some(origin) = lens.project(from) {
            self.arrow(
                lens,
                from,
                origin,
                &Arrow { letter: "T", way, colour: transmitted, dashes: &[] },
                reach,
            );
        }
    }

    /// The polygon, or the triangle between the vertices, with their weights.
    fn polygon(&mut self, seen: &Seen, spot: &Spot) {
        let lens = self.ink.lens;
        let triangle = seen.corners.map(|corner| corner.position);
        let (points, faint) = match seen.shading.stage {
            Stage::Polygon => (&seen.outline[..], false),
            Stage::Vertex => (&triangle[..], false),
            Stage::Pixel => (&seen.outline[..], true),
        };
        let line: Vec<_> = points.iter().chain(points.first()).copied().collect();
        let colour = if faint { WHITE.gamma_multiply(0.45) } else { WHITE };
        for run in lens.path(&line) {
            self.ink.stroke(run, if faint { 1.0 } else { 1.5 }, colour);
        }
        if seen.shading.stage != Stage::Vertex {
            return;
        }
        let places = triangle.map(|p| lens.project(p));
        // A small triangle has no room for them; the panel shows them too.
        let side = |i: usize| places[i].zip(places[(i + 1) % 3]);
        let roomy = (0..3).all(|i| side(i).is_some_and(|(a, b)| a.distance(b) >= ROOMY));
        let middle = places.iter().flatten().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / 3.0;
        for (corner, at) in seen.corners.iter().zip(places) {
            let Some(at) = at else { continue };
            let radius = if roomy { 5.0 } else { 3.0 };
            let this = matches!(spot.place, Place::Vertex { vertex, .. } if vertex == corner.vertex);
            let colour = theme::swatch(corner.colour.clamp(Vec3::ZERO, Vec3::ONE));
            self.ink.disc(at, if this { radius } else { 0.7 * radius }, colour);
            let out = (at.to_vec2() - middle).normalized();
            if roomy {
                self.words.push((
                    at + out * (20.0 * self.scale),
                    rows::short(corner.weight),
                    WHITE,
                    Vec::new(),
                ));
            }
        }
    }

    /// Width and colour of a mark for the given vectors.
    fn stroke(&self, ends: &[&str], width: f32, colour: Color32) -> (f32, Color32) {
        match () {
            () if self.lit.is_empty() => (width, colour),
            () if ends.iter().all(|end| self.lit.contains(end)) => (width * LIT / LINE, colour),
            () => (width, colour.gamma_multiply(DIM)),
        }
    }

    /// Records the distance from the pointer to a line that starts at the origin or runs around it.
    fn approach(&mut self, origin: Pos2, line: &[Pos2], symbols: &[&'static str]) {
        let Some(at) = self.pointer.filter(|at| at.distance(origin) > ORIGIN) else { return };
        let off = linked::distance(at, line);
        if off < GRASP && self.near.as_ref().is_none_or(|(nearest, _)| off < *nearest) {
            self.near = Some((off, symbols.to_vec()));
        }
    }

    fn arrow(&mut self, lens: &Lens, from: Vec3, origin: Pos2, arrow: &Arrow, reach: f32) {
        let to = from + arrow.way * reach;
        let Some(tip) = lens.project(to).filter(|_| arrow.way.is_finite() && arrow.way != Vec3::ZERO) else {
            return;
        };
        let along = tip - origin;
        let (width, colour) = self.stroke(&[arrow.letter], LINE, arrow.colour);
        self.approach(origin, &[origin, tip], &[arrow.letter]);
        if along.length() < END_ON {
            // As in textbooks: a dot is the tip of an arrow, a cross its feathers.
            let ahead = lens.metres(to, 1.0) < lens.metres(from, 1.0);
            let ring: Vec<Pos2> = (0..=24)
                .map(|k| origin + 9.0 * Vec2::angled(k as f32 / 24.0 * std::f32::consts::TAU))
                .collect();
            self.ink.stroke(ring, width, colour);
            if !ahead {
                for turn in [1.0, 3.0] {
                    let arm = 6.0 * Vec2::angled(turn * std::f32::consts::FRAC_PI_4);
                    self.ink.stroke(vec![origin - arm, origin + arm], width, colour);
                }
            }
            let at = origin + vec2(-15.0, 15.0) * self.scale;
            self.words.push((at, arrow.letter.to_owned(), colour, vec![arrow.letter]));
            return;
        }
        let ahead = along.normalized();
        let head = (8.0 * (width / LINE).sqrt()).min(0.6 * along.length());
        for dash in dashes(origin, tip - 0.6 * head * ahead, arrow.dashes) {
            self.ink.stroke(dash.to_vec(), width, colour);
        }
        let back = tip - head * ahead;
        let side = ahead.rot90() * (0.5 * head);
        self.ink.fill(vec![tip, back + side, back - side], colour);
        let at = tip + 12.0 * self.scale * ahead;
        self.words.push((at, arrow.letter.to_owned(), colour, vec![arrow.letter]));
    }

    /// Arcs between the vectors, where their directions are distinct in the picture.
    fn angles(&mut self, lens: &Lens, spot: &Spot, lit: Option<&Lit>, reach: f32, shown: &[Arrow]) {
        let Some(geometry) = lit.and_then(Lit::leading) else { return };
        let n = spot.normal;
        let all = [
            (["N", "L"], [n, geometry.l], YELLOW, 0.62),
            (["N", "H"], [n, geometry.h], GREEN, 0.4),
            (["R", "V"], [geometry.r, spot.view], BLUE, 0.8),
        ];
        let is_shown = |letter: &&str| shown.iter().any(|arrow| arrow.letter == *letter);
        for (letters, [a, b], colour, part) in all {
            if !letters.iter().all(is_shown) {
                continue;
            }
            let angle = a.angle_between(b);
            let ends = [a, b].map(|way| lens.project(spot.position + way * reach));
            let origin = lens.project(spot.position);
            let apart = match origin {
                Some(o) => ends.iter().all(|end| end.is_some_and(|end| (end - o).length() > 2.0 * END_ON)),
                None => false,
            };
            if !apart || !angle.is_finite() || !(0.03..3.1).contains(&angle) {
                continue;
            }
            let count = 2 + (angle.to_degrees() / 4.0) as usize;
            let between = |t: f32| {
                let turned = a * ((1.0 - t) * angle).sin() + b * (t * angle).sin();
                spot.position + turned / angle.sin() * (part * reach)
            };
            let arc: Vec<Vec3> = (0..=count).map(|k| between(k as f32 / count as f32)).collect();
            let (width, colour) = self.stroke(&letters, 1.25, colour);
            let symbols: Vec<_> = letters.into_iter().chain(pairs::angles(letters[0], letters[1])).collect();
            for run in lens.path(&arc) {
                origin.into_iter().for_each(|origin| self.approach(origin, &run, &symbols));
                self.ink.stroke(run, width, colour);
            }
            if let Some(middle) = lens.project(between(0.5)) {
                self.words.push((middle, format!("{:.0}°", angle.to_degrees()), colour, symbols));
            }
        }
    }

    /// Marks the pixel itself with the arms of a cross, surrounded by a ring if it is pinned.
    fn cross(&mut self, at: Pos2, pinned: bool) {
        for k in 0..4 {
            let arm = Vec2::angled(k as f32 * std::f32::consts::FRAC_PI_2);
            self.ink.stroke(vec![at + 4.0 * arm, at + 9.0 * arm], 1.25, WHITE);
        }
        if pinned {
            let ring = (0..=24).map(|k| at + 5.5 * Vec2::angled(k as f32 / 24.0 * std::f32::consts::TAU));
            self.ink.stroke(ring.collect(), 1.25, WHITE);
        }
    }

    fn paint(self, ui: &Ui, mut room: Room, model: Option<&Model>) {
        let painter = ui.painter_at(self.rect);
        self.ink.paint(&painter);
        let font = FontId::new(LETTER * self.scale, theme::semibold());
        // The caption of the picture is at its lower edge.
        let within = self.rect.with_max_y(self.rect.bottom() - CAPTION);
        let mut near = self.near;
        let mut plates = Vec::new();
        for (at, word, colour, symbols) in self.words {
            let text = painter.layout_no_wrap(word, font.clone(), colour);
            let plate = room.find(at, text.size() + vec2(8.0, 2.0), within);
            room.take_plate(plate);
            if plate.center().distance(at) > room::APART * self.scale {
                let line = [plate.clamp(at), at];
                painter.line_segment(line, Stroke::new(3.0, OUTLINE.gamma_multiply(0.78)));
                painter.line_segment(line, Stroke::new(1.0, colour));
            }
            if self.pointer.is_some_and(|at| plate.contains(at)) {
                near = Some((0.0, symbols));
            }
            plates.push((plate, text, colour));
        }
        for (plate, text, colour) in plates {
            painter.rect_filled(plate, 4.0, OUTLINE.gamma_multiply(0.78));
            painter.galley(plate.center() - 0.5 * text.size(), text, colour);
        }
        if let (Some((_, symbols)), Some(model)) = (near, model) {
            linked::point(ui.ctx(), &pairs::symbols(model, &symbols));
        }
    }
}

/// The segments of a dashed line.
fn dashes(from: Pos2, to: Pos2, pattern: Dashes) -> Vec<[Pos2; 2]> {
    let (length, way) = ((to - from).length(), (to - from).normalized());
    if pattern.is_empty() {
        return vec![[from, to]];
    }
    let (mut all, mut at) = (Vec::new(), 0.0);
    for (k, step) in pattern.iter().cycle().enumerate() {
        if at >= length {
            break;
        }
        if k % 2 == 0 {
            all.push([from + way * at, from + way * (at + step).min(length)]);
        }
        at += step;
    }
    all
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;

    use super::*;

    #[test]
    fn dashes_end_with_their_line() {
        let (from, to) = (pos2(0.0, 0.0), pos2(30.0, 0.0));
        assert_eq!(dashes(from, to, &[]), [[from, to]]);
        let all = dashes(from, to, &[12.0, 6.0]);
        assert_eq!(all, [[from, pos2(12.0, 0.0)], [pos2(18.0, 0.0), to]]);
        assert!(dashes(from, from, &[4.0, 5.0]).is_empty());
    }

    #[test]
    fn every_vector_has_a_colour_and_dashes_of_its_own() {
        let explanation = crate::explain::pixel(
            &crate::scene::Scene::default(),
            &crate::registry::Registry::builtin(),
            &crate::reference::Settings { width: 64, height: 36, ..Default::default() },
            [32, 18],
        );
        let seen = explanation.expect("in the picture").seen.expect("the sphere");
        let all = arrows(&seen.spots[0], seen.spots[0].lights.first());
        assert_eq!(all.iter().map(|a| a.letter).collect::<String>(), "RHLVN");
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                assert!(a.colour != b.colour && a.dashes != b.dashes, "{} and {}", a.letter, b.letter);
            }
        }
    }
}
