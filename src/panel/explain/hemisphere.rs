//! The hemisphere above the explained point, shown for light with extent as three discs. The pointer shows the light
//! from a direction.
//!
//! It is calculated in a thread because it evaluates the model for thousands of directions. Meanwhile, the previous
//! discs stay if they belong to the same point.

use std::time::Duration;

use bevy_egui::egui::{ColorImage, TextureHandle, TextureOptions};
use glam::Vec2;

use super::{
    probe::{self, Explained},
    rows,
};
use crate::{
    caught::catch,
    explain::{
        Seen, Spot, angle,
        hemisphere::{Above, DISCS, Hemisphere, Shining, above},
    },
    panel::{
        kept::{Answers, Same},
        prelude::*,
    },
};

/// Side of a disc, in pixels.
const SIDE: usize = 96;
/// Smallest and largest diameter of a disc, and gap between discs, in points.
const SMALLEST: f32 = 48.0;
const LARGEST: f32 = 150.0;
const GAP: f32 = 10.0;
/// Distance below which two points count as the same, in metres.
const SAME: f32 = 1e-4;
/// Colours of V and R, as those of the vectors in the picture.
const MARKS: [(&str, Color32); 2] =
    [("V", Color32::from_rgb(86, 180, 233)), ("R", Color32::from_rgb(230, 110, 40))];

/// The explanation that the discs belong to, and the index of the point in it.
type Question = (Same<Explained>, usize);

/// Calculated discs with their textures.
struct Discs {
    position: Vec3,
    hemisphere: Hemisphere,
    textures: Vec<TextureHandle>,
    /// The numbers of the scales, and the ends of the scales in words.
    scales: [Option<(String, Option<String>)>; DISCS.len()],
    ends: [String; DISCS.len()],
}

/// The calculation of discs; none where it crashes.
type Work = Answers<Question, Option<Arc<Discs>>>;

/// The discs or, while they are calculated, the previous discs if they belong to the same point.
fn answer(
    work: &mut Work,
    ctx: &Context,
    question: &Question,
    (seen, spot): (&Seen, &Spot),
    registry: &Registry,
) -> Option<Arc<Discs>> {
    let explained = &question.0.0;
    work.ask(ctx, question, Duration::ZERO, || {
        let shining = probe::with_scene(ctx, explained.view, |scene| Shining::new(scene, registry))?;
        let terms = explained.explanation.terms;
        let (surface, spot, ctx) = (seen.model.surface.0.clone(), spot.clone(), ctx.clone());
        let discs = move || {
            let hemisphere = Hemisphere::new(&shining, &*surface, &spot, terms, SIDE);
            let textures = textures(&ctx, &hemisphere);
            let scales = DISCS.each_ref().map(|disc| hemisphere.numbers_of_scale(disc));
            let ends = DISCS.each_ref().map(|disc| hemisphere.end_of_scale(disc));
            Arc::new(Discs { position: spot.position, hemisphere, textures, scales, ends })
        };
        Some(move || catch(discs).ok())
    });
    let (asked, discs) = work.shown.as_ref()?;
    discs.clone().filter(|discs| asked == question || discs.position.distance(spot.position) < SAME)
}

fn textures(ctx: &Context, hemisphere: &Hemisphere) -> Vec<TextureHandle> {
    let image = |of: fn(&Above) -> Vec3| {
        let rgba: Vec<u8> = hemisphere.disc(of).into_flattened();
        ColorImage::from_rgba_unmultiplied([hemisphere.side; 2], &rgba)
    };
    DISCS.iter().map(|disc| ctx.load_texture(disc.name, image(disc.of), TextureOptions::LINEAR)).collect()
}

/// True if light with extent shines on the current point.
pub(super) fn has(ctx: &Context, seen: &Seen) -> bool {
    probe::shown_spot(ctx, seen).is_some_and(|(_, spot)| spot.lights.iter().any(|lit| lit.integral.is_some()))
}

/// Shows the discs, as large as the column has room without scrolling.
pub(super) fn hemisphere(ui: &mut Ui, explained: &Arc<Explained>, seen: &Seen, registry: &Registry) {
    let Some((number, spot)) = probe::shown_spot(ui.ctx(), seen) else { return };
    rows::heading(ui, "The hemisphere above the point");
    if seen.model.trouble.is_some() {
        theme::note(ui, "The CPU cannot run this model: there is no picture of it.");
        return;
    }
    let question = (Same(explained.clone()), number);
    let discs = kept::shared(ui.ctx(), |work| answer(work, ui.ctx(), &question, (seen, spot), registry));
    let Some(discs) = discs else {
        theme::note(ui, "Calculating…");
        return;
    };
    let cell = ((ui.available_width() - 2.0 * GAP) / 3.0).clamp(24.0, LARGEST * theme::scale_here(ui));
    let (legends, has_units) = legends(ui, &discs.scales, cell);
    let width = diameter(ui, &legends, cell);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let short = DISCS.iter().any(|disc| theme::small_width(ui, disc.name) > cell);
        for (i, disc) in DISCS.iter().enumerate() {
            ui.vertical(|ui| {
                ui.set_width(cell);
                let name = if short { disc.short } else { disc.name };
                let label = Label::new(theme::small(ui, name)).truncate().show_tooltip_when_elided(false);
                ui.add(label).on_hover_text(disc.name);
                one(ui, &discs, i, width);
                theme::note(ui, legends[i].as_str()).on_hover_text(format!("white: {}", discs.ends[i]));
            });
        }
    });
    let text = "From straight above: area is projected solid angle, N is the middle, the rim is the horizon, the tangent points right.";
    theme::note(ui, text);
    if !has_units {
        theme::note(ui, format!("Light and product are in {}.", DISCS[0].unit));
    }
    // The integral of the samples is shown below its light.
    for text in discs.hemisphere.said() {
        let text = rows::unbroken(ui, &text);
        theme::note(ui, text);
    }
}

/// The legends of the discs, below which so much width is free: the ends of their scales; and true if they have units, for
/// which there must be room.
fn legends(
    ui: &Ui,
    scales: &[Option<(String, Option<String>)>; DISCS.len()],
    cell: f32,
) -> ([String; DISCS.len()], bool) {
    let all = |units: bool| -> [String; DISCS.len()] {
        std::array::from_fn(|i| {
            let Some((white, brighter)) = &scales[i] else { return "all is black".to_owned() };
            let unit = if units { DISCS[i].unit } else { "" };
            let white = format!("white: {white} {unit}").trim_end().to_owned();
            brighter
                .as_ref()
                .map_or_else(|| white.clone(), |largest| format!("{white}\nbrightest: {largest}"))
        })
    };
    let with_units = all(true);
    let fits = |legend: &String| legend.lines().all(|line| theme::small_width(ui, line) <= cell);
    if with_units.iter().all(fits) { (with_units, true) } else { (all(false), false) }
}

/// The diameter of discs that have so much width, with which title, names, discs and legends fit into the height of the
/// column.
fn diameter(ui: &Ui, legends: &[String], cell: f32) -> f32 {
    let font = TextStyle::Small.resolve(ui.style());
    let high =
        |legend: &String| ui.painter().layout(legend.clone(), font.clone(), Color32::WHITE, cell).size().y;
    let legend = legends.iter().map(high).fold(0.0, f32::max);
    let words = ui.text_style_height(&TextStyle::Body) + ui.text_style_height(&TextStyle::Small) + legend;
    let height = ui.clip_rect().height() - words - 5.0 * ui.spacing().item_spacing.y;
    height.max(SMALLEST).min(cell)
}

/// One disc with its marks. The pointer shows a direction and the light from there.
fn one(ui: &mut Ui, discs: &Discs, number: usize, width: f32) {
    let (rect, response) = ui.allocate_exact_size(vec2(width, width), Sense::hover());
    let painter = ui.painter();
    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(discs.textures[number].id(), rect, all, Color32::WHITE);
    painter.circle_stroke(rect.center(), 0.5 * width, Stroke::new(1.0, Palette::here(ui).weak));
    let hemisphere = &discs.hemisphere;
    let place = |p: Vec2| rect.center() + 0.5 * width * vec2(p.x, -p.y);
    for point in &hemisphere.points {
        painter.circle_filled(place(point.place), 2.5, Color32::from_rgb(240, 228, 66));
    }
    for ((name, colour), at) in MARKS.into_iter().zip([hemisphere.view, hemisphere.mirror]) {
        painter.circle_stroke(place(at), 4.0, Stroke::new(3.5, Color32::BLACK));
        painter.circle_stroke(place(at), 4.0, Stroke::new(1.5, colour));
        let font = FontId::new(11.0 * theme::scale_here(ui), theme::semibold());
        let corner = place(at) + vec2(6.0, -5.0);
        painter.text(corner + vec2(1.0, 1.0), Align2::LEFT_CENTER, name, font.clone(), Color32::BLACK);
        painter.text(corner, Align2::LEFT_CENTER, name, font, colour);
    }
    let Some(at) = response.hover_pos() else { return };
    let from = (at - rect.center()) / (0.5 * width);
    let at = Vec2::new(from.x, -from.y);
    if let (Some(l), Some(above)) = (above(at), hemisphere.at(at)) {
        response.on_hover_text(told(l, &above));
    }
}

/// A direction and the light from there, in words.
fn told(l: Vec3, Above { arriving, lobe, product }: &Above) -> String {
    let around = l.y.atan2(l.x).to_degrees();
    format!(
        "θ = {}°, φ = {}°\nL = {} cd/m²\nπ f = {}\nresponse π f N·L = {}\nπ f L = {} cd/m²",
        rows::short(angle(l.z)),
        rows::short(around),
        rows::short_or_triple(*arriving),
        rows::short_or_triple(*lobe),
        rows::short_or_triple(*lobe * l.z),
        rows::short_or_triple(*product)
    )
}
