//! A caption that describes the picture, so that a screenshot says what it shows.

use std::collections::BTreeSet;

use super::{maths, prelude::*};
pub use crate::caption::Part;
use crate::{
    caption::{display, line, single, terms_alone, value},
    optics::TermSelection,
    parameter::Parameter,
    reflection::usage,
    scene::Object,
};

/// Maximum number of values in a caption; more would be a list.
pub(super) const MOST_VALUES: usize = 4;
/// Maximum number of lines; more would hide the picture.
const LINES: usize = 2;

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

    /// The same on a slide: in narrower lines where they are no more, so that no word hangs alone in the last one.
    pub(super) fn even(ui: &Ui, parts: &[Part], size: f32, colour: Color32, width: f32) -> Self {
        let within = |width: f32| Self::of(ui, parts.to_vec(), size, colour, width);
        let wide = within(width);
        if wide.runs.last().is_none_or(|(at, _)| at.y <= 0.0) {
            return wide;
        }
        let mut narrower = (6..12u8).map(|part| within(width * f32::from(part) / 12.0));
        let is_as_low =
            |lines: &Self| lines.kept == wide.kept && !lines.is_elided() && lines.size.y <= wide.size.y + 0.5;
        narrower.find(is_as_low).unwrap_or(wide)
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
            // A line that continues on the next one ends with the separator.
            let more = parts.get(i + 1).map_or(0.0, |next| text(next.joint(part).trim_end()).size().x);
            let joint = i.checked_sub(1).map_or("", |before| part.joint(&parts[before]));
            let (dot, open) = (text(joint), text(joint.trim_end()));
            if at.x > 0.0 && at.x + dot.size().x + lead + galley.size().x + more > width {
                runs.push((at, open.clone()));
                at = vec2(0.0, at.y + height);
                rows += 1;
            } else if i > 0 {
                runs.push((at, dot.clone()));
                at.x += dot.size().x;
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

    /// The lines without the dots at their ends: on a slide, a dot that nothing follows looks like a mistake.
    pub(super) fn closed(mut self) -> Self {
        self.runs.retain(|(_, galley)| galley.text() != " ·");
        self
    }

    pub(super) fn paint(self, ui: &Ui, at: Pos2, colour: Color32) {
        for (offset, galley) in self.runs {
            ui.painter().galley(pos2(at.x + offset.x, at.y + offset.y), galley, colour);
        }
    }
}
