//! The footer of a presentation of several views: the equation and the caption of each compared view, and below them
//! the statistics of their difference.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::{BODY, Block, CAPTION, Definition, columns, padding, since};
use crate::{
    caption::{Part, single},
    panel::{
        caption::{Lines, parts_of},
        maths, notice,
        prelude::*,
    },
    scene::comparison::Layout,
};

/// Maximum height of all equations, as a fraction of the screen; larger equations are left out.
const MOST: f32 = 0.34;

/// The texts about a view.
#[derive(Clone, Debug)]
struct Side {
    model: Option<String>,
    equation: Vec<Definition>,
    parts: Vec<Part>,
}

/// A typeset equation with its position in the footer.
#[derive(Clone, Debug)]
struct Set {
    side: usize,
    block: Block,
    at: Pos2,
}

/// The footer of a presentation of several views.
#[derive(Clone, Debug, Default)]
pub struct Footer {
    sides: Vec<Side>,
    equations: Vec<Set>,
    /// Upper left corners of the captions, and their width.
    captions: (Vec<Pos2>, f32),
    /// Distance from the top to the line with the statistics, if there is one.
    numbers: Option<f32>,
    /// Height of the footer, in points.
    pub height: f32,
}

impl Side {
    fn of(session: &Session, view: usize, registry: &Registry) -> Self {
        let seen = (view != session.active()).then(|| session.document.seen(view, registry)).flatten();
        let scene = seen.as_ref().map_or(session.scene(), |(scene, _)| scene);
        let mut parts = parts_of(scene, session.terms_of(view), registry);
        let letter = LETTERS.get(view).copied().unwrap_or_default();
        parts.insert(0, Part::new(0, format!("{letter}:")));
        // With several models, an equation would seem to apply to all of them.
        let models = scene.shown().map(|o| scene.model_of(o)).collect();
        let model = single(&models).and_then(|id| registry.model(id));
        let equation = model.map_or_else(Vec::new, |model| maths::definitions(model.declaration.equation));
        Self { model: model.map(|model| model.declaration.id.to_owned()), equation, parts }
    }
}

impl Footer {
    /// The footer of a screen.
    #[must_use]
    pub fn of(ui: &mut Ui, whole: Rect, session: &Session, registry: &Registry) -> Self {
        let views = match session.document.comparison.layout {
            Layout::Single => vec![session.active()],
            _ => vec![0, session.compared_with().min(session.document.variants.len())],
        };
        let sides: Vec<_> = views.into_iter().map(|view| Side::of(session, view, registry)).collect();
        let mut hasher = DefaultHasher::new();
        format!("{sides:?} {whole:?}").hash(&mut hasher);
        let (ctx, id) = (ui.ctx().clone(), Id::new("footer of the presentation"));
        kept::of_key(&ctx, id, hasher.finish(), || Self::laid_out(ui, whole, sides))
    }

    fn laid_out(ui: &mut Ui, whole: Rect, sides: Vec<Side>) -> Self {
        let (height, padding) = (whole.height(), padding(whole));
        let most = whole.width() - 2.0 * padding.x;
        let several = sides.len() > 1;
        let gap = 2.0 * padding.x;
        let half = if several { 0.5 * (most - gap) } else { most };
        let left = [padding.x, padding.x + half + gap];
        let words =
            |side: &Side| Lines::of(ui, side.parts.clone(), CAPTION * height, Palette::here(ui).text, half);
        let words = sides.iter().map(|side| words(side).size.y).fold(0.0, f32::max);
        let mut trial = ui.new_child(UiBuilder::new().id_salt("footer trial").max_rect(whole).invisible());
        trial.style_mut().text_styles.insert(TextStyle::Body, FontId::proportional(BODY * height));
        let (equations, high) = equations(&trial, &sides, [half, most], left, padding.y, MOST * height);
        let mut at = padding.y;
        if high > 0.0 {
            at += high + padding.y;
        }
        let captions = (0..sides.len()).map(|i| pos2(left[i], at)).collect();
        at += words + padding.y;
        let numbers = several.then_some(at);
        if several {
            at += 1.3 * CAPTION * height + padding.y;
        }
        Self { sides, equations, captions: (captions, half), numbers, height: at }
    }

    /// Paints the footer at the lower end of the screen.
    pub(in crate::panel) fn paint(&self, ui: &mut Ui, whole: Rect, session: &Session, registry: &Registry) {
        let palette = Palette::here(ui);
        let (height, padding) = (whole.height(), padding(whole));
        let place = whole.with_min_y(whole.bottom() - self.height);
        ui.painter().rect_filled(place, 0.0, palette.panel);
        for Set { side, block, at } in &self.equations {
            let Side { equation, model, .. } = &self.sides[*side];
            let model = model.as_deref().and_then(|id| registry.model(id));
            ui.push_id(("equation", side), |ui| {
                columns(ui, block, equation, model, place.min + at.to_vec2(), height);
            });
        }
        let (corners, width) = &self.captions;
        for (side, at) in self.sides.iter().zip(corners) {
            let words = Lines::of(ui, side.parts.clone(), CAPTION * height, palette.text, *width);
            words.paint(ui, place.min + at.to_vec2(), palette.text);
        }
        if let Some(top) = self.numbers {
            let room = whole.width() - 2.0 * padding.x;
            let text = numbers(ui, session, CAPTION * height, room);
            let ink = palette.text;
            let galley = theme::elided(ui, &text, FontId::proportional(CAPTION * height), ink, room);
            ui.painter().galley(place.min + vec2(padding.x, top), galley, ink);
        }
        notice::show(ui, whole.with_max_y(place.top()), CAPTION * height, since(ui), &session.messages);
    }
}

/// The equations and their total height: side by side, or stacked if that is lower. An equation that both views share
/// appears once; if there is no room for all, the highest is left out.
fn equations(
    ui: &Ui,
    sides: &[Side],
    [half, most]: [f32; 2],
    left: [f32; 2],
    space: f32,
    limit: f32,
) -> (Vec<Set>, f32) {
    let shared = sides.windows(2).all(|pair| pair[0].model == pair[1].model);
    let mut wanted: Vec<usize> = (0..sides.len()).filter(|i| !sides[*i].equation.is_empty()).collect();
    wanted.truncate(if shared { 1 } else { sides.len() });
    let block = |i: usize, width: f32| {
        let blocks = (1..=4).map(|columns| Block::of(ui, &sides[i].equation, columns, width, true));
        let order = |a: &Block, b: &Block| a.broken.cmp(&b.broken).then(a.size.y.total_cmp(&b.size.y));
        blocks.min_by(order).unwrap_or_default()
    };
    let narrow: Vec<_> = wanted.iter().map(|i| block(*i, half)).collect();
    let wide: Vec<_> = wanted.iter().map(|i| block(*i, most)).collect();
    let beside = narrow.iter().map(|b| b.size.y).fold(0.0, f32::max);
    let fits = narrow.iter().all(|b| b.size.x <= half + 1.0);
    let above = wide.iter().map(|b| b.size.y + space).sum::<f32>() - space;
    if wanted.len() > 1 && fits && beside <= above.min(limit) {
        let sets = narrow.into_iter().zip(&wanted);
        let sets = sets.map(|(block, side)| Set { side: *side, block, at: pos2(left[*side], space) });
        return (sets.collect(), beside);
    }
    let mut blocks: Vec<_> = wanted.into_iter().zip(wide).collect();
    while !blocks.is_empty() && blocks.iter().map(|(_, b)| b.size.y + space).sum::<f32>() - space > limit {
        let highest = |(_, a): &(usize, &(usize, Block)), (_, b): &(usize, &(usize, Block))| {
            a.1.size.y.total_cmp(&b.1.size.y)
        };
        let Some((i, _)) = blocks.iter().enumerate().max_by(highest) else { break };
        blocks.remove(i);
    }
    let mut top = space;
    let mut sets = Vec::new();
    for (side, block) in blocks {
        let at = pos2(left[0], top);
        top += block.size.y + space;
        sets.push(Set { side, block, at });
    }
    let height = if sets.is_empty() { 0.0 } else { top - 2.0 * space };
    (sets, height)
}

/// The statistics of the difference in one line, as many as fit, or why there are none.
fn numbers(ui: &Ui, session: &Session, size: f32, room: f32) -> String {
    let with = LETTERS.get(session.compared_with()).copied().unwrap_or("B");
    let mut line = format!("{with} compared with A:");
    if let Some(reason) = session.no_difference() {
        return reason;
    }
    let Some(numbers) = &session.facts.comparison else { return line + " …" };
    for (i, (name, value, _)) in numbers.entries().filter(|(_, value, _)| !value.is_empty()).enumerate() {
        let more = format!("{line}{} {name} {value}", if i > 0 { " ·" } else { "" });
        let galley =
            theme::elided(ui, &more, FontId::proportional(size), Palette::here(ui).text, f32::INFINITY);
        if galley.size().x > room {
            break;
        }
        line = more;
    }
    line
}
