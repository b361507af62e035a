//! The footer of a presentation of several views: the equation and the caption of each view, and below them the
//! statistics of the difference.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::{BODY, Block, CAPTION, Definition, columns, definitions, padding, sides};
use crate::{
    caption::{Part, single},
    panel::{caption::Lines, keys, maths::Sizes, prelude::*},
    scene::comparison::Layout,
    text::sentence,
};

/// Maximum height of all equations, as a fraction of the screen: of two views, and of more, whose pictures are smaller.
const MOST: [f32; 2] = [0.34, 0.2];
/// Sizes of equations, of which the first is used at which all definitions have room.
const SCALES: [f32; 3] = [1.0, 0.8, SMALLEST];
/// Size of equations for which there is no room otherwise. Without room even then, those of two views end early, and
/// say so; those of more views give way to the pictures.
const SMALLEST: f32 = 0.64;
/// Height of a line of text, as a multiple of its font size.
const LINE: f32 = 1.3;

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
    /// True if the letters of its views stand before it.
    lettered: bool,
}

/// The footer of a presentation of several views.
#[derive(Clone, Debug, Default)]
pub struct Footer {
    sides: Vec<Side>,
    equations: Vec<Set>,
    /// Size of the equations.
    scale: f32,
    /// True if there is no room for them.
    lacks_equations: bool,
    /// Upper left corners of the captions, and their width.
    captions: (Vec<Pos2>, f32),
    /// Distance from the top to the line with the statistics, if there is one.
    numbers: Option<f32>,
    /// Height of the footer, in points.
    pub height: f32,
}

impl Side {
    fn of(scene: &Scene, view: usize, mut parts: Vec<Part>, registry: &Registry) -> Self {
        let letter = LETTERS.get(view).copied().unwrap_or_default();
        parts.insert(0, Part::new(0, format!("{letter}:")));
        // With several models, an equation would seem to apply to all of them.
        let models = scene.shown().map(|o| scene.model_of(o)).collect();
        let model = single(&models).and_then(|id| registry.model(id));
        let equation = model.map_or_else(Vec::new, |model| definitions(scene, model));
        Self { model: model.map(|model| model.declaration.id.to_owned()), equation, parts }
    }
}

impl Footer {
    /// The footer of a screen.
    #[must_use]
    pub fn of(ui: &mut Ui, whole: Rect, session: &Session, registry: &Registry) -> Self {
        let views = match session.document.comparison.layout {
            Layout::Single => vec![session.active()],
            _ => session.views_shown(),
        };
        let seen = |view: &usize| (*view != session.active()).then(|| session.document.seen(*view, registry));
        let seen: Vec<_> = views.iter().map(|view| seen(view).flatten()).collect();
        let scenes = seen.iter().map(|seen| seen.as_ref().map_or(session.scene(), |(scene, _)| scene));
        let shown: Vec<_> = scenes.zip(views.iter().map(|view| session.terms_of(*view))).collect();
        let captions = sides::alike(&shown, registry);
        let sides = shown.iter().zip(&views).zip(captions);
        let sides: Vec<_> =
            sides.map(|((shown, view), parts)| Side::of(shown.0, *view, parts, registry)).collect();
        let mut hasher = DefaultHasher::new();
        format!("{sides:?} {whole:?}").hash(&mut hasher);
        let (ctx, id) = (ui.ctx().clone(), Id::new("footer of the presentation"));
        kept::of_key(&ctx, id, hasher.finish(), || Self::laid_out(ui, whole, sides))
    }

    fn laid_out(ui: &mut Ui, whole: Rect, mut sides: Vec<Side>) -> Self {
        let (height, padding) = (whole.height(), padding(whole));
        let most = whole.width() - 2.0 * padding.x;
        let (several, many) = (sides.len() > 1, sides.len() > 2);
        let gap = 2.0 * padding.x;
        let column = (most + gap) / sides.len() as f32 - gap;
        let left: Vec<_> = (0..sides.len()).map(|i| padding.x + i as f32 * (column + gap)).collect();
        let words =
            |side: &Side| Lines::of(ui, side.parts.clone(), CAPTION * height, Palette::here(ui).text, column);
        fit(&mut sides, |side| !words(side).cut);
        let words = sides.iter().map(|side| words(side).size.y).fold(0.0, f32::max);
        let mut trial = ui.new_child(UiBuilder::new().id_salt("footer trial").max_rect(whole).invisible());
        let letters = (0..sides.len()).map(|i| letter(ui, &letters(&sides, i), height).size().x);
        let indent = letters.fold(0.0, f32::max) + padding.x;
        let (limit, line) = (MOST[usize::from(many)] * height, LINE * CAPTION * height);
        let room = Room { column, most, left: &left, indent, space: padding.y, limit, line };
        let all = SCALES.into_iter().find_map(|scale| {
            let font = FontId::proportional(scale * BODY * height);
            trial.style_mut().text_styles.insert(TextStyle::Body, font);
            room.for_all(&trial, &sides, scale == SMALLEST).map(|all| (all, scale))
        });
        let lacks_equations = many && all.is_none();
        let cut = || if many { Default::default() } else { room.for_the_first(&trial, &sides) };
        let ((equations, high), scale) = all.unwrap_or_else(|| (cut(), SMALLEST));
        let mut at = padding.y;
        if high > 0.0 {
            at += high + padding.y;
        }
        let captions = left.iter().map(|left| pos2(*left, at)).collect();
        at += words + padding.y;
        let numbers = several.then_some(at);
        if several {
            at += line + padding.y;
        }
        let captions = (captions, column);
        Self { sides, equations, scale, lacks_equations, captions, numbers, height: at }
    }

    /// Paints the footer at the lower end of the screen.
    pub(in crate::panel) fn paint(&self, ui: &mut Ui, whole: Rect, session: &Session, registry: &Registry) {
        let palette = Palette::here(ui);
        let (height, padding) = (whole.height(), padding(whole));
        let place = whole.with_min_y(whole.bottom() - self.height);
        ui.painter().rect_filled(place, 0.0, palette.panel);
        for Set { side, block, at, lettered } in &self.equations {
            let Side { equation, model, .. } = &self.sides[*side];
            if *lettered {
                let galley = letter(ui, &letters(&self.sides, *side), height);
                let first = galley.rows.first().and_then(|row| row.row.glyphs.first());
                let top = at.y + block.baseline - first.map_or(0.0, |glyph| glyph.pos.y);
                ui.painter().galley(place.min + vec2(padding.x, top), galley, palette.text);
            }
            let model = model.as_deref().and_then(|id| registry.model(id));
            ui.push_id(("equation", side), |ui| {
                columns(ui, block, equation, model, place.min + at.to_vec2(), self.scale * height);
            });
            let more = equation.len() - shown(block);
            if more > 0 {
                let text = format!("… and {}", plural(more, "more definition"));
                let font = FontId::proportional(self.scale * CAPTION * height);
                let alone = self.equations.len() == 1;
                let room = if alone { whole.width() - padding.x - at.x } else { self.captions.1 };
                let galley = theme::elided(ui, &text, font, palette.text, room);
                ui.painter().galley(place.min + vec2(at.x, at.y + block.size.y), galley, palette.text);
            }
        }
        let (corners, width) = &self.captions;
        for (side, at) in self.sides.iter().zip(corners) {
            let words = Lines::even(ui, &side.parts, CAPTION * height, palette.text, *width);
            words.paint(ui, place.min + at.to_vec2(), palette.text);
        }
        if let Some(top) = self.numbers {
            let line =
                Rect::from_min_max(place.min + vec2(0.0, top), place.max).shrink2(vec2(padding.x, 0.0));
            self.statistics(ui, line, CAPTION * height, session);
        }
    }

    /// Paints the line with the statistics in letters of this size. If there is no room for equations, it ends with the way
    /// to see them.
    fn statistics(&self, ui: &Ui, line: Rect, size: f32, session: &Session) {
        let (font, ink, mut room) = (FontId::proportional(size), Palette::here(ui).text, line.width());
        if self.lacks_equations {
            let words = format!("Equations: {} shows two views", keys::word(ui.ctx(), "next_layout"));
            let galley = theme::elided(ui, &words, font.clone(), ink, room);
            let left = line.right() - galley.size().x;
            ui.painter().galley(pos2(left, line.top()), galley, ink);
            room = left - size - line.left();
        }
        let text = numbers(ui, session, size, room);
        let galley = theme::elided(ui, &text, font, ink, room);
        ui.painter().galley(line.min, galley, ink);
    }
}

/// The letters before the equation of a view: those of all views with its model.
fn letters(sides: &[Side], side: usize) -> String {
    let same = sides.iter().filter(|other| other.model == sides[side].model);
    let letters = same.filter_map(|other| Some(other.parts.first()?.text.trim_end_matches(':')));
    letters.collect::<Vec<_>>().join(", ") + ":"
}

/// Letters before an equation, on a screen of this height.
fn letter(ui: &Ui, text: &str, height: f32) -> Arc<Galley> {
    let font = FontId::new(CAPTION * height, theme::semibold());
    theme::elided(ui, text, font, Palette::here(ui).text, f32::INFINITY)
}

/// Leaves parts out until all captions fit, the same ones of each.
fn fit(sides: &mut [Side], fits: impl Fn(&Side) -> bool) {
    while !sides.iter().all(&fits) {
        let last = sides.iter().flat_map(|side| &side.parts).map(|part| part.rank).max().unwrap_or(0);
        if last == 0 {
            return;
        }
        sides.iter_mut().for_each(|side| side.parts.retain(|part| part.rank < last));
    }
}

/// The room for equations.
struct Room<'a> {
    /// Width for one of several equations side by side.
    column: f32,
    /// Width for one equation.
    most: f32,
    /// Left edges of all sides.
    left: &'a [f32],
    /// Width of the letters before one of several equations above each other.
    indent: f32,
    /// Space around equations.
    space: f32,
    /// Maximum height of all equations.
    limit: f32,
    /// Height of a line of text.
    line: f32,
}

impl Room<'_> {
    /// The equations and their total height: side by side, or stacked if that is lower; `None` if they are too high.
    /// With `broken`, better with bad line breaks than too high.
    fn for_all(&self, ui: &Ui, sides: &[Side], broken: bool) -> Option<(Vec<Set>, f32)> {
        let wanted = wanted(sides);
        let limit = if broken { self.limit } else { f32::INFINITY };
        let blocks =
            |width: f32| wanted.iter().map(move |i| (*i, block(ui, &sides[*i].equation, width, limit)));
        let lettered = lettered(sides);
        let indent = if lettered { self.indent } else { 0.0 };
        let narrow: Vec<_> = blocks(self.column).collect();
        let wide: Vec<_> = blocks(self.most - indent).collect();
        let fits = narrow.iter().all(|(_, b)| b.size.x <= self.column + 1.0);
        let above = wide.iter().map(|(_, b)| b.size.y + self.space).sum::<f32>() - self.space;
        // Otherwise an equation would stand in the column of one view alone.
        let apart = sides.iter().filter(|side| !side.equation.is_empty()).count() == wanted.len();
        if wanted.len() > 1 && apart && fits {
            let beside = self.beside(sides, narrow);
            if beside.1 <= above.min(self.limit) {
                return Some(beside);
            }
        }
        let mut top = self.space;
        let mut sets = Vec::new();
        for (side, block) in wide {
            let at = pos2(self.left[0] + indent, top);
            top += block.size.y + self.space;
            sets.push(Set { side, block, at, lettered });
        }
        (above <= self.limit).then_some((sets, above.max(0.0)))
    }

    /// The first definitions of each equation, as many as there is room for but at least one, and their height.
    fn for_the_first(&self, ui: &Ui, sides: &[Side]) -> (Vec<Set>, f32) {
        let wanted = wanted(sides);
        let indent = if wanted.len() == 1 && lettered(sides) { self.indent } else { 0.0 };
        let width = if wanted.len() > 1 { self.column } else { self.most - indent };
        let first = |i: usize| {
            let all = &sides[i].equation;
            let limit = |b: &Block| if shown(b) < all.len() { self.limit - self.line } else { self.limit };
            let fits = |b: &Block| b.size.x <= width + 1.0 && b.size.y <= limit(b);
            let begun = |count: usize| block(ui, &all[..count], width, self.limit - self.line);
            (i, (2..=all.len()).map(begun).take_while(fits).last().unwrap_or_else(|| begun(1)))
        };
        self.beside(sides, wanted.iter().map(|i| first(*i)).collect())
    }

    /// Equations side by side, with their first lines on one baseline, and their height. One alone has the letter of
    /// its view.
    fn beside(&self, sides: &[Side], blocks: Vec<(usize, Block)>) -> (Vec<Set>, f32) {
        let baseline = blocks.iter().map(|(_, b)| b.baseline).fold(0.0, f32::max);
        let (mut height, lettered) = (0.0f32, blocks.len() == 1 && lettered(sides));
        let set = |(side, block): (usize, Block)| {
            let lower = baseline - block.baseline;
            let more = if shown(&block) < sides[side].equation.len() { self.line } else { 0.0 };
            height = height.max(lower + block.size.y + more);
            let left = if lettered { self.left[0] + self.indent } else { self.left[side] };
            Set { side, block, at: pos2(left, self.space + lower), lettered }
        };
        (blocks.into_iter().map(set).collect(), height)
    }
}

/// True if all views have one model.
fn shared(sides: &[Side]) -> bool {
    sides.windows(2).all(|pair| pair[0].model == pair[1].model)
}

/// True if an equation that has no column of its own needs the letter of its view.
fn lettered(sides: &[Side]) -> bool {
    sides.len() > 1 && !shared(sides)
}

/// The number of definitions in a block.
fn shown(block: &Block) -> usize {
    block.columns.last().map_or(0, |(range, ..)| range.end)
}

/// The sides whose equations are shown: the first one with each model.
fn wanted(sides: &[Side]) -> Vec<usize> {
    let is_first = |i: usize| sides[..i].iter().all(|other| other.model != sides[i].model);
    (0..sides.len()).filter(|i| !sides[*i].equation.is_empty() && is_first(*i)).collect()
}

/// An equation in as many columns as suit it, preferably not higher than `limit`.
fn block(ui: &Ui, equation: &[Definition], width: f32, limit: f32) -> Block {
    let sizes = Sizes { column: true, even: true, level: true };
    let blocks = (1..=4).map(|columns| Block::of(ui, equation, columns, width, sizes));
    let weight = |b: &Block| (b.size.y > limit, b.broken);
    let order = |a: &Block, b: &Block| weight(a).cmp(&weight(b)).then(a.size.y.total_cmp(&b.size.y));
    blocks.min_by(order).unwrap_or_default()
}

/// The statistics of the difference in one line, as many as fit, or why there are none.
fn numbers(ui: &Ui, session: &Session, size: f32, room: f32) -> String {
    let with = LETTERS.get(session.compared_with()).copied().unwrap_or("B");
    let mut line = format!("{with} compared with A:");
    let reason = session.incomparable().or_else(|| session.unconverged());
    let Some(numbers) = session.numbers().filter(|_| reason.is_none()) else {
        let said = reason.unwrap_or_else(|| line + " …");
        return match session.shown_for_map() {
            Some(shown) => format!("{} {shown}", sentence(&said)),
            None => said,
        };
    };
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
