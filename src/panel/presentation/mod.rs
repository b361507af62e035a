//! The presentation (F5): the picture fills the screen, with equation and caption over it, large enough for the back
//! row. If they would hide objects, the picture makes room for them.

use std::{
    hash::{DefaultHasher, Hash, Hasher},
    ops::Range,
};

use bevy_egui::egui::CornerRadius;

use super::{
    caption::{self, Lines},
    inspector::model::meaning,
    keys,
    marks::Lens,
    maths::{self, Sizes},
    placer::Placer,
    prelude::*,
    shares::shared,
    typeset::Break,
};
use crate::reflection::{ModelEntry, Term};

pub use footer::Footer;
pub(super) use free::{Needed, PlatePlace, height_of_rows, message};

mod footer;
mod free;
mod sides;

/// Font size of the caption, as a fraction of the screen height. The cap height of its font is 0.727.
pub(super) const CAPTION: f32 = 0.036;
/// Body size at which the smallest symbols of an equation have the cap height of the caption: they are 1.1 times as
/// large, in a font with cap height 0.66.
const BODY: f32 = 0.035;
/// Preferred maximum height of the equation, as a fraction of the screen.
const MOST: f32 = 0.4;
/// Maximum height, including padding, if the equation would otherwise break inside brackets.
const TALLEST: f32 = 0.54;
/// Widths of an equation beside the objects, as fractions of the screen, each with true if terms are as small as
/// definitions. The first that works is used.
const BESIDE: [(f32, bool); 6] =
    [(0.34, false), (0.42, false), (0.34, true), (0.5, false), (0.42, true), (0.5, true)];
/// Fraction of the objects that may be hidden.
const HIDDEN: f32 = 0.005;
/// Radius of the discs that stand for objects, as a multiple of half their size: an allowance for corners.
const ALLOWANCE: f32 = 1.2;

/// Leaves the presentation on Escape, unless something else handles the key.
pub fn on_escape(ctx: &Context, session: &Session, area: &PictureArea) -> Option<Action> {
    let leaves = session.view.presenting && keys::escapes(ctx, session, area);
    leaves.then_some(Action::View(ViewChange::Presenting(false)))
}

/// A definition: term and text.
type Definition = (Term, &'static str);

/// The equation, arranged in columns.
#[derive(Clone, Debug, Default)]
struct Block {
    /// Definitions, upper left corner and width of each column.
    columns: Vec<(Range<usize>, Vec2, f32)>,
    /// Distance from the top to the first baseline, which all columns share if lines are level.
    baseline: f32,
    sizes: Sizes,
    /// The worst line break.
    broken: Break,
    size: Vec2,
}

/// The texts of a presentation, and their rectangles.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The screen.
    whole: Rect,
    /// Rectangle of the picture.
    pub picture: Rect,
    equation: Vec<Definition>,
    block: Block,
    plate: Rect,
    caption: Rect,
    parts: Vec<caption::Part>,
    /// Place of badges, legend and messages.
    spot: PlatePlace,
}

impl Stage {
    /// Lays out the texts for a screen, with room for the plates over the picture.
    pub(super) fn of(
        ui: &mut Ui,
        whole: Rect,
        session: &Session,
        registry: &Registry,
        needed: Needed,
    ) -> Self {
        // None with several models, since it would seem to apply to all of them.
        let equation = model_of(session, registry).map(|model| definitions(session.scene(), model));
        let equation = equation.unwrap_or_default();
        let parts = caption::parts(session, registry);
        // A turning camera must not move the layout: its position at the start counts.
        let mut hasher = DefaultHasher::new();
        let objects: Vec<_> = session.scene().shown().map(|o| (o.position, o.size)).collect();
        format!("{equation:?} {parts:?} {whole:?} {objects:?} {needed:?} {}", since(ui)).hash(&mut hasher);
        let (ctx, id) = (ui.ctx().clone(), Id::new("stage of the presentation"));
        kept::of_key(&ctx, id, hasher.finish(), || {
            let over = Self::laid_out(ui, whole, 0.0, session, (equation.clone(), parts.clone()));
            let (discs, taken) = (discs(session, over.picture), [over.plate, over.caption]);
            if let Some(spot) = PlatePlace::corner(&discs, over.free(), needed, &taken) {
                return Self { spot, ..over };
            }
            let spot = PlatePlace::band(needed, whole);
            Self { spot, ..Self::laid_out(ui, whole, spot.above(), session, (equation, parts)) }
        })
    }

    /// Lays out the texts below a band of the height `above`.
    fn laid_out(
        ui: &mut Ui,
        whole: Rect,
        above: f32,
        session: &Session,
        (equation, parts): (Vec<Definition>, Vec<caption::Part>),
    ) -> Self {
        let padding = padding(whole);
        let (spot, below) =
            (PlatePlace::Corner(Align2::LEFT_TOP, 0.0), whole.with_min_y(whole.top() + above));
        let most = whole.width() - 2.0 * padding.x;
        let words = Lines::even(ui, &parts, CAPTION * whole.height(), Palette::here(ui).text, most);
        let caption = Align2::LEFT_BOTTOM.anchor_size(whole.left_bottom(), words.size + 2.0 * padding);
        let room = below.with_max_y(caption.top());
        let mut ui = ui.new_child(UiBuilder::new().id_salt("trial").max_rect(whole).invisible());
        ui.style_mut().text_styles.insert(TextStyle::Body, FontId::proportional(BODY * whole.height()));
        let block = |columns, width, even| {
            Block::of(&ui, &equation, columns, width, Sizes { column: true, even, level: false })
        };
        let tall = TALLEST * whole.height() - 2.0 * padding.y;
        let narrow = BESIDE.map(|(part, even)| block(1, part * whole.width(), even));
        let narrow = narrow.iter().min_by_key(|b| (b.broken, b.size.y > tall)).unwrap_or(&narrow[0]).clone();
        let mut wide = vec![block(1, most, false), block(2, most, false)];
        let limit = MOST * whole.height();
        if wide.iter().all(|b| b.broken > Break::Sign || b.size.y > limit) {
            wide.extend([block(2, most, true), block(3, most, true), block(4, most, true)]);
        }
        // A block with better line breaks is easier to read, even if it is higher.
        let mut all: Vec<&Block> = wide.iter().chain([&narrow]).collect();
        let limits =
            [Break::Sign, Break::Product].into_iter().flat_map(|broken| [(broken, limit), (broken, tall)]);
        let within = |b: &Block, (broken, limit)| b.broken <= broken && b.size.y <= limit;
        let limit = limits.into_iter().find(|l| all.iter().any(|b| within(b, *l)));
        if let Some(limit) = limit {
            all.retain(|b| within(b, limit));
        }
        let discs = discs(session, below);
        let mut over = all.iter().filter(|b| b.size.y <= tall).flat_map(|block| {
            [Align2::LEFT_TOP, Align2::RIGHT_TOP, Align2::LEFT_BOTTOM]
                .map(|corner| (block, corner.align_size_within_rect(block.size_with(padding), room)))
        });
        if let Some((block, plate)) = over.find(|(_, plate)| hidden(&discs, &[*plate, caption]) <= HIDDEN) {
            let block = (*block).clone();
            return Self { whole, picture: below, equation, block, plate, caption, parts, spot };
        }
        // Beside or above the picture, whichever leaves the larger picture.
        let plate = |b: &Block| Align2::LEFT_TOP.align_size_within_rect(b.size_with(padding), room);
        let beside = |b: &Block| (b.clone(), plate(b), room.with_min_x(plate(b).right()));
        let above = |b: &Block| {
            let plate = plate(b);
            (b.clone(), plate, room.with_min_y(plate.bottom().min(room.bottom() - 0.2 * room.height())))
        };
        let scale = |r: &Rect| (r.width() / whole.width()).min(r.height() / whole.height());
        let fits = |b: &&Block| b.size.y <= tall && limit.is_none_or(|l| b.broken <= l.0);
        let sides = Some(&narrow).filter(fits).map(beside);
        let above = all.iter().filter(|b| b.columns != narrow.columns).map(|b| above(b));
        let (block, plate, picture) = (sides.into_iter().chain(above))
            .max_by(|a, b| scale(&a.2).total_cmp(&scale(&b.2)))
            .unwrap_or_else(|| (narrow.clone(), Rect::NOTHING, below));
        Self { whole, picture, equation, block, plate, caption, parts, spot }
    }

    /// The part of the picture above the caption.
    pub(super) fn free(&self) -> Rect {
        self.picture.with_max_y(self.caption.top().min(self.picture.bottom()))
    }

    /// The places of badges, legend and messages.
    pub(super) fn placer(&self) -> Placer {
        match self.spot {
            PlatePlace::Corner(..) => self.spot.placer(self.free()),
            PlatePlace::Band(height) => self.spot.placer(self.whole.with_min_y(self.whole.top() + height)),
        }
    }

    /// The rectangles of equation and caption.
    pub(super) fn plates(&self) -> [Rect; 2] {
        [self.plate, self.caption]
    }

    /// All rectangles that something takes: equation, caption, and the plates over the picture, which need this room.
    pub(super) fn taken(&self, needed: Needed) -> Vec<Rect> {
        let all = [self.plate, self.caption, self.spot.column(self.free(), needed)];
        all.into_iter().filter(Rect::is_positive).collect()
    }

    /// Paints equation and caption on backgrounds that make them readable over any picture, and sets the size of all text
    /// over the picture.
    pub(super) fn paint(&self, ui: &mut Ui, session: &Session, registry: &Registry) {
        let palette = Palette::here(ui);
        let height = self.whole.height();
        let padding = padding(self.whole);
        ui.painter().rect_filled(self.caption, CornerRadius { ne: 8, ..CornerRadius::ZERO }, palette.panel);
        let width = self.whole.width() - 2.0 * padding.x;
        let words = Lines::even(ui, &self.parts, CAPTION * height, palette.text, width);
        words.paint(ui, self.caption.min + padding, palette.text);
        if !self.equation.is_empty() {
            ui.painter().rect_filled(self.plate, 8.0, palette.panel);
            let model = model_of(session, registry);
            columns(ui, &self.block, &self.equation, model, self.plate.min + padding, height);
        }
        text_of_size(ui, CAPTION * height);
    }
}

/// Sets the size of all text over a picture, the smallest included: it is read from afar.
pub(super) fn text_of_size(ui: &mut Ui, size: f32) {
    for style in [TextStyle::Body, TextStyle::Small] {
        ui.style_mut().text_styles.insert(style, FontId::proportional(size));
    }
}

fn model_of<'r>(session: &Session, registry: &'r Registry) -> Option<&'r ModelEntry> {
    let models = session.document.models_shown(session.active());
    models.first().and_then(|id| registry.model(id)).filter(|_| models.len() == 1)
}

/// The equation of a model, as the visible objects need it: without the transmitted term if all are opaque.
fn definitions(scene: &Scene, model: &ModelEntry) -> Vec<Definition> {
    let own = scene.shown().filter(|object| scene.model_of(object) == model.declaration.id);
    let passages = own.map(|object| model.passage(&object.material));
    let passage = passages.reduce(|all, one| all | one).unwrap_or_default();
    maths::definitions(&model.declaration.equation_of(passage))
}

/// Shows the equation of a model in columns from a corner on.
fn columns(
    ui: &mut Ui,
    block: &Block,
    equation: &[Definition],
    model: Option<&ModelEntry>,
    at: Pos2,
    height: f32,
) {
    for (i, (which, corner, width)) in block.columns.iter().enumerate() {
        let place = Rect::from_min_size(at + *corner, vec2(*width, block.size.y));
        let mut ui = ui.new_child(UiBuilder::new().id_salt(("column", i)).max_rect(place));
        ui.style_mut().text_styles.insert(TextStyle::Body, FontId::proportional(BODY * height));
        maths::equation_of(&mut ui, &equation[which.clone()], block.sizes, |symbol| meaning(model?, symbol));
    }
}

fn padding(whole: Rect) -> Vec2 {
    vec2(0.022, 0.014) * whole.height()
}

impl Block {
    /// Arranges an equation in at most `columns` columns, each as wide as its lines. If that is too wide, long columns
    /// share the space that short ones leave, and are as narrow as possible without becoming higher.
    fn of(ui: &Ui, all: &[Definition], columns: usize, most: f32, sizes: Sizes) -> Self {
        let gap = 0.04 * most;
        let measure = |range: &Range<usize>, width| maths::measured(ui, &all[range.clone()], sizes, width);
        let each = (most - gap * (columns - 1) as f32) / columns as f32;
        let mut layouts: Vec<Vec<Range<usize>>> = Vec::new();
        for width in [f32::INFINITY, each] {
            let heights: Vec<_> = (0..all.len()).map(|i| measure(&(i..i + 1), width).height).collect();
            for ranges in partitions(&heights).filter(|r| r.len() <= columns) {
                if !layouts.contains(&ranges) {
                    layouts.push(ranges);
                }
            }
        }
        let laid_out = layouts.into_iter().map(|ranges| {
            let room = most - gap * (ranges.len() - 1) as f32;
            let widths: Vec<f32> = ranges.iter().map(|r| measure(r, f32::INFINITY).width + 1.0).collect();
            let cut = shared(&widths, room);
            let mut block = Self { sizes, ..Self::default() };
            let (mut at, mut heights) = (0.0, Vec::new());
            for (range, natural) in ranges.into_iter().zip(widths) {
                let wide = measure(&range, natural.min(cut));
                let (mut narrow, mut width) = (0.0, natural.min(cut));
                while natural > cut && width - narrow > 4.0 {
                    let middle = 0.5 * (narrow + width);
                    let here = measure(&range, middle);
                    // Less height would mean unstacked fractions and arbitrary breaks.
                    let same = (here.height - wide.height).abs() < 0.5 && here.broken <= wide.broken;
                    *(if same { &mut width } else { &mut narrow }) = middle;
                }
                let baseline = measure(&range, width).baseline;
                heights.push(wide.height);
                block.columns.push((range, vec2(at, baseline), width));
                block.baseline = block.baseline.max(baseline);
                block.size.x = at + width;
                block.broken = block.broken.max(wide.broken);
                at += width + gap;
            }
            for ((_, corner, _), height) in block.columns.iter_mut().zip(heights) {
                corner.y = if sizes.level { block.baseline - corner.y } else { 0.0 };
                block.size.y = block.size.y.max(corner.y + height);
            }
            block
        });
        let order = |a: &Self, b: &Self| a.broken.cmp(&b.broken).then(a.size.y.total_cmp(&b.size.y));
        laid_out.min_by(order).unwrap_or_default()
    }

    fn size_with(&self, padding: Vec2) -> Vec2 {
        if self.columns.is_empty() { Vec2::ZERO } else { self.size + 2.0 * padding }
    }
}

/// Ways to fill columns from the top, up to various heights.
fn partitions(heights: &[f32]) -> impl Iterator<Item = Vec<Range<usize>>> {
    let whole: f32 = heights.iter().sum();
    let fill = move |most: f32| {
        let (mut out, mut start, mut height) = (Vec::new(), 0, 0.0);
        for (i, high) in heights.iter().enumerate() {
            if i > start && height + high > most {
                out.push(start..i);
                (start, height) = (i, 0.0);
            }
            height += high;
        }
        out.push(start..heights.len());
        out
    };
    (1..=64).map(move |k| fill(whole * k as f32 / 64.0 + 0.5)).filter(|r| r.iter().all(|r| !r.is_empty()))
}

/// The objects as seen by the camera: discs, without those far outside the picture.
pub(super) fn discs(session: &Session, rect: Rect) -> Vec<(Pos2, f32)> {
    let lens = Lens::of(session, rect);
    let right = session.facts.camera * glam::Vec3::X;
    let disc = |o: &crate::scene::Object| {
        let radius = 0.5 * ALLOWANCE * o.size;
        let at = lens.project(o.position)?;
        Some((at, lens.project(o.position + radius * right)?.distance(at)))
    };
    session.scene().shown().filter_map(disc).filter(|(at, r)| rect.expand(*r).contains(*at)).collect()
}

/// The share of the discs that rectangles hide, by their areas.
fn hidden(discs: &[(Pos2, f32)], plates: &[Rect]) -> f32 {
    let covered = |at: Pos2, r: f32| plates.iter().any(|p| p.is_positive() && at.distance(p.clamp(at)) < r);
    let share = |d: &(Pos2, f32)| if covered(d.0, d.1) { d.1 * d.1 } else { 0.0 };
    discs.iter().map(share).sum::<f32>() / discs.iter().map(|d| d.1 * d.1).sum::<f32>().max(1.0)
}

/// The share of the objects in a picture, given as discs, that rectangles cover, by their areas. Floors and backdrops, as
/// wide as the picture, do not count.
pub(super) fn covered(discs: &[(Pos2, f32)], picture: Rect, plates: &[Rect]) -> f32 {
    // Many are small.
    let steps = if discs.len() > 32 { 1 } else { 9 };
    let middle = |i: usize| (2 * i + 1) as f32 / steps as f32 - 1.0;
    let grid = (0..steps * steps).map(|i| vec2(middle(i % steps), middle(i / steps)));
    let grid: Vec<_> = grid.filter(|offset| offset.length() < 1.0).collect();
    let (mut all, mut hidden) = (0.0f32, 0.0f32);
    let widest = 0.5 * picture.size().max_elem();
    for (at, radius) in discs.iter().filter(|(_, radius)| *radius < widest) {
        let places = grid.iter().map(|offset| *at + *offset * (*radius / ALLOWANCE));
        for place in places.filter(|place| picture.contains(*place)) {
            let area = radius * radius;
            all += area;
            hidden += if plates.iter().any(|plate| plate.contains(place)) { area } else { 0.0 };
        }
    }
    hidden / all.max(1.0)
}

/// Start time of the presentation, in seconds.
fn since(ui: &Ui) -> f64 {
    let id = Id::new("presentation since");
    let (now, pass) = (ui.input(|i| i.time), ui.ctx().cumulative_pass_nr());
    let known = ui.data(|d| d.get_temp::<(f64, u64)>(id)).filter(|(_, last)| last + 2 > pass);
    let since = known.map_or(now, |(since, _)| since);
    ui.data_mut(|d| d.insert_temp(id, (since, pass)));
    since
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_plates_cover_of_objects_is_a_share_of_their_area_in_the_picture() {
        let picture = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        let ball = [(pos2(200.0, 150.0), 120.0)];
        let share = |plate: Rect| covered(&ball, picture, &[plate]);
        assert!(share(picture) > 0.99 && share(picture.with_max_y(40.0)) < 0.01);
        assert!((share(picture.with_max_x(200.0)) - 0.5).abs() < 0.1);
        let on_a_floor = [ball[0], (pos2(200.0, 900.0), 800.0)];
        let corner = picture.with_min_y(280.0);
        assert_eq!(covered(&on_a_floor, picture, &[corner]), covered(&ball, picture, &[corner]), "a floor");
        assert_eq!(covered(&[], picture, &[picture]), 0.0, "there is no object");
        let many = vec![(pos2(50.0, 50.0), 10.0); 40];
        assert!(covered(&many, picture, &[picture]) > 0.99);
    }
}
