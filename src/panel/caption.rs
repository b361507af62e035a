//! A caption that describes the picture, so that a screenshot says what it shows.

use std::collections::BTreeSet;

use super::{maths, prelude::*};
pub use crate::caption::Part;
use crate::{
    caption::{closing, display, line, single, terms_alone, value},
    optics::TermSelection,
    parameter::Parameter,
    reflection::usage,
    scene::Object,
};

/// Maximum number of values in a caption; more would be a list.
pub(super) const MOST_VALUES: usize = 4;
/// Maximum number of lines; more would hide the picture.
const LINES: usize = 2;
/// Number of even captions whose widths are kept: more than a screen has views.
const EVEN: usize = 2 * (MAX_VARIANTS + 1);

/// The caption of the picture: its models, shading and display, and for a single object the key values.
#[must_use]
pub fn caption_text(session: &Session, registry: &Registry) -> String {
    line(&parts(session, registry))
}

/// Parts of the caption of the picture.
#[must_use]
pub fn parts(session: &Session, registry: &Registry) -> Vec<Part> {
    let parts = parts_of(session.scene(), session.terms(), registry);
    compiling(session, session.active()).into_iter().chain(parts).collect()
}

/// The words before the caption of a view whose picture is behind.
pub(super) fn compiling(session: &Session, view: usize) -> Option<Part> {
    session.compiles(view).then(|| Part::new(0, "compiling…"))
}

/// The reflection model of a scene.
pub(super) fn model_part(scene: &Scene, registry: &Registry) -> Part {
    let models = scene.models_shown(0);
    let text = match single(&models) {
        Some(id) => registry.model(id).map_or(id, |m| m.declaration.name).to_owned(),
        None if models.is_empty() => "nothing visible".to_owned(),
        None => format!("{} models", models.len()),
    };
    Part::new(0, text)
}

/// The shading model of a scene, and its stage.
pub(super) fn shading_parts(scene: &Scene, registry: &Registry) -> Vec<Part> {
    let shadings: BTreeSet<_> = scene.shown().map(|o| scene.shading_model_of(o)).collect();
    match single(&shadings) {
        Some(id) => match registry.shading_model(id) {
            Some(shading) => {
                let d = shading.declaration;
                let stage = Part::new(u8::MAX, format!("computed {}", d.stage.phrase()));
                vec![Part::new(0, format!("{} shading", d.name)), stage]
            }
            None => vec![Part::new(0, format!("{id} shading"))],
        },
        None if shadings.is_empty() => Vec::new(),
        None => vec![Part::new(0, format!("{} shading models", shadings.len()))],
    }
}

/// Parts of the caption of a scene that shows the given terms of its equations.
fn parts_of(scene: &Scene, terms: TermSelection, registry: &Registry) -> Vec<Part> {
    let mut parts = vec![model_part(scene, registry)];
    parts.extend(shading_parts(scene, registry));
    let mut objects = scene.shown();
    if let (Some(object), None) = (objects.next(), objects.next()) {
        parts.extend(key_values(object, scene.model_of(object), registry));
    }
    parts.extend(terms_alone(terms));
    parts.extend(display(scene.display));
    parts
}

/// The most telling values of an object's material, in one line.
pub(super) fn values(object: &Object, model: &str, registry: &Registry, most: usize) -> String {
    let mut parts = key_values(object, model, registry);
    while parts.len() > most
        && let Some(first) = parts.iter().enumerate().max_by_key(|(_, part)| part.rank).map(|(i, _)| i)
    {
        parts.remove(first);
    }
    line(&parts)
}

/// Values of the material in declaration order: all of them if there are few, otherwise those that differ from their
/// defaults, then the first ones. When room runs out, defaults go first, then earlier values before later ones:
/// coefficients are declared before exponents and roughness, which say more.
fn key_values(object: &Object, model: &str, registry: &Registry) -> Vec<Part> {
    let mut all: Vec<_> = values_of(object, model, registry).into_iter().enumerate().collect();
    all.sort_by_key(|(_, (p, _))| object.material.get(p) == p.default_value());
    all.truncate(MOST_VALUES);
    all.sort_by_key(|(i, _)| *i);
    let ranked = all.into_iter().enumerate().map(|(place, (_, (p, part)))| {
        let default = object.material.get(p) == p.default_value();
        let rank = 2 + 2 * MOST_VALUES - place - if default { 0 } else { MOST_VALUES };
        Part { rank: rank as u8, ..part }
    });
    ranked.collect()
}

/// All values of the material that its model uses and that have one component, in declaration order.
pub(super) fn values_of(
    object: &Object,
    model: &str,
    registry: &Registry,
) -> Vec<(&'static Parameter, Part)> {
    let Some(model) = registry.model(model) else { return Vec::new() };
    let part = |p: &'static Parameter| {
        let (symbol, text) = value(p, &object.material.get(p)).filter(|_| p.kind.components() == 1)?;
        Some((p, Part { symbol, ..Part::new(2, text) }))
    };
    let used = |p: &&'static Parameter| usage::unused(model.parameters, p, &object.material).is_none();
    model.parameters.iter().filter(used).filter_map(part).collect()
}

/// An even caption.
#[derive(Clone, Debug)]
struct Even {
    parts: Vec<Part>,
    /// Size of its letters, the width that it has, and pixels per point.
    room: [f32; 3],
    /// The width of its lines.
    found: f32,
}

/// The latest even captions, the last used one at the end.
#[derive(Clone, Debug, Default)]
struct Evened(Vec<Even>);

impl Evened {
    /// The width of the lines of a caption, if it is known.
    fn find(&mut self, parts: &[Part], room: [f32; 3]) -> Option<f32> {
        let at = self.0.iter().position(|even| even.room == room && even.parts == parts)?;
        self.0[at..].rotate_left(1);
        self.0.last().map(|even| even.found)
    }

    /// Keeps a new one, in place of that which was not used for longest.
    fn keep(&mut self, even: Even) {
        if self.0.len() >= EVEN {
            self.0.remove(0);
        }
        self.0.push(even);
    }
}

/// A caption laid out in lines.
pub(super) struct Lines {
    runs: Vec<(Vec2, Arc<Galley>)>,
    /// Size of the laid-out text.
    pub(super) size: Vec2,
    /// True if parts were left out.
    pub(super) cut: bool,
    /// The number of parts that are left.
    kept: usize,
}

impl Lines {
    /// Lays out parts of a caption within a width, broken between parts.
    pub(super) fn of(ui: &Ui, parts: Vec<Part>, size: f32, colour: Color32, width: f32) -> Self {
        Self::within(ui, parts, size, colour, width, LINES)
    }

    /// The same on a slide: in narrower lines where they are no more, so that no word hangs alone in the last one. The width
    /// that was found is kept for the next frames.
    pub(super) fn even(ui: &Ui, parts: &[Part], size: f32, colour: Color32, width: f32) -> Self {
        let within = |width: f32| Self::of(ui, parts.to_vec(), size, colour, width);
        let room = [size, width, ui.pixels_per_point()];
        if let Some(found) = kept::with(ui.ctx(), |known: &mut Evened| known.find(parts, room)) {
            return within(found);
        }
        let (found, lines) = Self::evened(within, width);
        kept::with(ui.ctx(), |known: &mut Evened| known.keep(Even { parts: parts.to_vec(), room, found }));
        lines
    }

    /// The narrowest lines by `within` that are no more than those of this width and show as much, and their width.
    fn evened(within: impl Fn(f32) -> Self, width: f32) -> (f32, Self) {
        let wide = within(width);
        if wide.runs.last().is_none_or(|(at, _)| at.y <= 0.0) {
            return (width, wide);
        }
        let narrower = (6..12u8).map(|part| width * f32::from(part) / 12.0);
        let is_as_low = |(_, lines): &(f32, Self)| {
            lines.kept == wide.kept && !lines.is_elided() && lines.size.y <= wide.size.y + 0.5
        };
        narrower.map(|width| (width, within(width))).find(is_as_low).unwrap_or((width, wide))
    }

    /// Lays out parts within `most` lines, leaving out optional parts where necessary.
    pub(super) fn within(
        ui: &Ui,
        mut parts: Vec<Part>,
        size: f32,
        colour: Color32,
        width: f32,
        most: usize,
    ) -> Self {
        let all = parts.len();
        loop {
            let lines = Self::set(ui, &parts, size, colour, width);
            let last = parts.iter().rposition(|p| p.rank > 0 && parts.iter().all(|q| q.rank <= p.rank));
            match last {
                Some(i) if lines.1 > most => drop(parts.remove(i)),
                _ => return Self { cut: parts.len() < all, kept: parts.len(), ..lines.0 },
            }
        }
    }

    /// Lays out all parts. Returns the result and the number of lines.
    fn set(ui: &Ui, parts: &[Part], size: f32, colour: Color32, width: f32) -> (Self, usize) {
        let font = FontId::proportional(size);
        let text = |text: &str| theme::elided(ui, text, font.clone(), colour, width);
        let height = text("A").size().y;
        let baseline =
            |g: &Galley| g.rows.first().and_then(|r| r.row.glyphs.first()).map_or(0.0, |g| g.pos.y);
        let (mut runs, mut at, mut most, mut rows) = (Vec::new(), Vec2::ZERO, 0.0f32, 1);
        for (i, part) in parts.iter().enumerate() {
            let galley = text(&part.text);
            let symbol = (!part.symbol.is_empty())
                .then(|| maths::lay_out(ui, &maths::parse_symbol(part.symbol), 1.1 * size, colour));
            let lead = symbol.as_ref().map_or(0.0, |s| s.width + 0.3 * size);
            let more = parts.get(i + 1).map_or(0.0, |next| text(closing(next.joint(part))).size().x);
            let joint = i.checked_sub(1).map_or("", |before| part.joint(&parts[before]));
            let (dot, open) = (text(joint), text(closing(joint)));
            if at.x > 0.0 && at.x + dot.size().x + lead + galley.size().x + more > width {
                most = most.max(at.x + open.size().x);
                runs.push((at, open));
                at = vec2(0.0, at.y + height);
                rows += 1;
            } else if i > 0 {
                let end = at.x + dot.size().x;
                runs.push((at, dot));
                at.x = end;
            }
            let foot = at + vec2(0.0, baseline(&galley));
            runs.extend(symbol.into_iter().flat_map(|s| s.pieces).map(|p| (foot + p.offset, p.galley)));
            at.x += lead;
            let end = at.x + galley.size().x;
            runs.push((at, galley));
            at.x = end;
            most = most.max(end);
        }
        (Self { runs, size: vec2(most, at.y + height), cut: false, kept: parts.len() }, rows)
    }

    /// True if a part is cut within, since it is longer than a line.
    pub(super) fn is_elided(&self) -> bool {
        self.runs.iter().any(|(_, galley)| galley.elided)
    }

    pub(super) fn paint(self, ui: &Ui, at: Pos2, colour: Color32) {
        for (offset, galley) in self.runs {
            ui.painter().galley(pos2(at.x + offset.x, at.y + offset.y), galley, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::RawInput;

    use super::*;

    #[test]
    fn an_even_caption_is_laid_out_in_one_width_once_that_is_known() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        let words = ["Microfacet", "Phong shading", "computed per pixel", "roughness 0.35", "exposure 1 EV"];
        let parts = words.map(|word| Part::new(0, word));
        // The size of a caption, and the number of texts that its frame has laid out.
        let caption = |width: f32, even: bool| {
            // egui forgets the texts of earlier frames.
            (0..2).for_each(|_| drop(ctx.run_ui(RawInput::default(), |_| ())));
            let mut size = Vec2::ZERO;
            let _ = ctx.run_ui(RawInput::default(), |ui| {
                let lines = match even {
                    true => Lines::even(ui, &parts, 20.0, Color32::WHITE, width),
                    false => Lines::of(ui, parts.to_vec(), 20.0, Color32::WHITE, width),
                };
                size = lines.size;
            });
            (size, ctx.fonts(|fonts| fonts.num_galleys_in_cache()))
        };
        let (line, _) = caption(f32::INFINITY, false);
        for width in [0.9 * line.x, 0.8 * line.x] {
            let (wide, once) = caption(width, false);
            let (first, tried) = caption(width, true);
            assert!(wide.y > 1.5 * line.y && first.y == wide.y && first.x < 0.8 * width, "{wide} {first}");
            assert!(tried > once, "{tried} texts, {once} at one width");
            for _ in 0..2 {
                let (again, laid_out) = caption(width, true);
                assert_eq!(again, first);
                assert!(laid_out <= once, "{laid_out} texts, {once} at one width");
            }
        }
    }

    #[test]
    fn a_line_ends_with_no_dot_and_is_as_wide_as_its_words() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        let words = ["Microfacet", "Phong shading", "k = 0.35", "n = 12", "AgX"];
        let set = |continues: bool, width: f32| {
            let parts = words.map(|word| Part { continues, ..Part::new(0, word) });
            let mut lines = None;
            // Fonts come with the first frame.
            for _ in 0..2 {
                let _ = ctx.run_ui(RawInput::default(), |ui| {
                    lines = Some(Lines::of(ui, parts.to_vec(), 16.0, Color32::WHITE, width));
                });
            }
            lines.expect("laid out")
        };
        let all = (60..600u16).step_by(4).flat_map(|width| [false, true].map(|continues| (continues, width)));
        for (continues, width) in all {
            let lines = set(continues, f32::from(width));
            for (i, (at, galley)) in lines.runs.iter().enumerate() {
                let end = at.x + galley.size().x;
                assert!(end <= lines.size.x + 0.01, "{width}: {} ends at {end}", galley.text());
                let goes_on = lines.runs.get(i + 1).is_some_and(|(next, _)| next.y == at.y);
                assert!(goes_on || !galley.text().contains('·'), "{width}: {:?}", galley.text());
            }
            let breaks = lines.runs.iter().any(|(at, _)| at.y > 0.0);
            let ends = lines.runs.iter().any(|(_, galley)| galley.text() == ",");
            assert_eq!(ends, breaks && continues, "{width}");
        }
    }

    #[test]
    fn the_captions_that_are_used_are_kept() {
        let parts = |i: usize| vec![Part::new(0, i.to_string())];
        let mut known = Evened::default();
        for i in 0..3 * EVEN {
            known.keep(Even { parts: parts(i), room: [1.0; 3], found: i as f32 });
            assert_eq!(known.find(&parts(0), [1.0; 3]), Some(0.0), "{i}");
        }
        assert_eq!(known.0.len(), EVEN);
        assert_eq!(known.find(&parts(1), [1.0; 3]), None, "it was not used");
        assert_eq!(known.find(&parts(0), [2.0; 3]), None, "in another room");
    }
}
