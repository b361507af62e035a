//! The hemisphere above the explained point, shown for light with extent as three discs. The pointer shows the light
//! from a direction.
//!
//! It is calculated in a thread because it evaluates the model for thousands of directions. Meanwhile, the previous
//! discs stay if they belong to the same point.

use std::{
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{self, Receiver, TryRecvError},
    },
    thread,
};

use bevy_egui::egui::{
    Align2, Color32, ColorImage, Context, FontId, Id, Rect, Sense, Stroke, TextureHandle, TextureOptions, Ui,
    pos2, vec2,
};
use glam::{Vec2, Vec3};

use super::{
    probe::{self, Choice, Explained},
    rows,
};
use crate::{
    explain::{
        Seen, Spot, angle,
        hemisphere::{Above, DISCS, Hemisphere, Shining, above},
    },
    panel::theme::{self, Palette},
    registry::Registry,
};

/// Side of a disc, in pixels.
const SIDE: usize = 96;
/// Largest diameter of a disc, and gap between discs, in points.
const LARGEST: f32 = 150.0;
const GAP: f32 = 10.0;
/// Distance below which two points count as the same, in metres.
const SAME: f32 = 1e-4;
/// Colours of V and R, as those of the vectors in the picture.
const MARKS: [(&str, Color32); 2] =
    [("V", Color32::from_rgb(86, 180, 233)), ("R", Color32::from_rgb(230, 110, 40))];

/// The explanation that the discs belong to, and the index of the point in it.
#[derive(Clone)]
struct Question(Arc<Explained>, usize);

impl PartialEq for Question {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) && self.1 == other.1
    }
}

/// Calculated discs with their textures.
struct Discs {
    position: Vec3,
    hemisphere: Hemisphere,
    textures: Vec<TextureHandle>,
    /// The ends of the scales.
    scales: [String; DISCS.len()],
}

#[derive(Default)]
struct Work {
    shown: Option<(Question, Arc<Discs>)>,
    running: Option<(Question, Vec3, Receiver<Hemisphere>)>,
}

impl Work {
    /// The discs or, while they are calculated, the previous discs if they belong to the same point.
    fn answer(
        &mut self,
        ctx: &Context,
        question: Question,
        (seen, spot): (&Seen, &Spot),
        registry: &Registry,
    ) -> Option<Arc<Discs>> {
        if let Some((asked, position, receiver)) = &self.running {
            match receiver.try_recv() {
                Ok(hemisphere) => {
                    let textures = textures(ctx, &hemisphere);
                    let scales = DISCS.each_ref().map(|disc| hemisphere.end_of_scale(disc));
                    let discs = Discs { position: *position, hemisphere, textures, scales };
                    self.shown = Some((asked.clone(), Arc::new(discs)));
                    self.running = None;
                }
                Err(TryRecvError::Disconnected) => self.running = None,
                Err(TryRecvError::Empty) => {}
            }
        }
        let fits = self.shown.as_ref().is_some_and(|(of, _)| *of == question);
        if !fits && self.running.is_none() {
            let view = question.0.view;
            let shining = probe::with_scene(ctx, view, |scene| Shining::new(scene, registry))?;
            let terms = question.0.explanation.terms;
            let (surface, spot, ctx) = (seen.model.surface.0.clone(), spot.clone(), ctx.clone());
            let (sender, receiver) = mpsc::channel();
            self.running = Some((question, spot.position, receiver));
            thread::spawn(move || {
                // The receiver is gone once the window is closed.
                drop(sender.send(Hemisphere::new(&shining, &*surface, &spot, terms, SIDE)));
                ctx.request_repaint();
            });
        }
        let shown = self.shown.as_ref().map(|(_, discs)| discs.clone());
        shown.filter(|discs| fits || discs.position.distance(spot.position) < SAME)
    }
}

fn textures(ctx: &Context, hemisphere: &Hemisphere) -> Vec<TextureHandle> {
    let image = |of: fn(&Above) -> Vec3| {
        let rgba: Vec<u8> = hemisphere.disc(of).into_flattened();
        ColorImage::from_rgba_unmultiplied([hemisphere.side; 2], &rgba)
    };
    DISCS.iter().map(|disc| ctx.load_texture(disc.name, image(disc.of), TextureOptions::LINEAR)).collect()
}

/// Shows the discs if light with extent shines on the current point.
pub(super) fn hemisphere(
    ui: &mut Ui,
    explained: &Arc<Explained>,
    seen: &Seen,
    choice: Choice,
    registry: &Registry,
) {
    let number = probe::shown_spot(seen, choice);
    let spot = probe::spots(seen).get(number).copied();
    let Some(spot) = spot.filter(|spot| spot.lights.iter().any(|lit| lit.integral.is_some())) else { return };
    ui.add_space(8.0);
    rows::heading(ui, "The hemisphere above the point");
    if seen.model.trouble.is_some() {
        rows::note(ui, "The CPU cannot run this model: there is no picture of it.");
        return;
    }
    let work =
        ui.ctx().data_mut(|d| d.get_temp_mut_or_default::<Arc<Mutex<Work>>>(Id::new("hemisphere")).clone());
    let question = Question(explained.clone(), number);
    let discs = {
        let mut work = work.lock().unwrap_or_else(PoisonError::into_inner);
        work.answer(ui.ctx(), question, (seen, spot), registry)
    };
    let Some(discs) = discs else {
        rows::note(ui, "Calculating…");
        return;
    };
    rows::note(
        ui,
        "From straight above: area is projected solid angle, N is the middle, the rim is the horizon, the tangent points right.",
    );
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let width = ((ui.available_width() - 2.0 * GAP) / 3.0).clamp(24.0, LARGEST * theme::scale_here(ui));
        for (i, disc) in DISCS.iter().enumerate() {
            ui.vertical(|ui| {
                ui.set_width(width);
                rows::note(ui, disc.name);
                one(ui, &discs, i, width);
                rows::note(ui, &format!("white: {}", discs.scales[i]));
            });
        }
    });
    // From the pixels of the disc, which give two digits; the integral of the samples is shown below its light.
    let integral = crate::explain::rounded_number_or_triple(discs.hemisphere.integral, 2);
    rows::note(
        ui,
        &format!("The mean of the product times π is the light to the observer: about {integral}"),
    );
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
