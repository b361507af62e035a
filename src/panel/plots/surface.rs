//! The plot itself, and the values read from it.

use super::{
    Built, PlotPanel, Request, handle,
    pen::{SCALE, Screen},
    reading::{self, Reading},
    series,
};
use crate::{
    curves::draw::{Figure, GAP, Ground, Ink, Series},
    panel::{focus, linked, prelude::*, state::Slot},
    parameter::NamedFile,
};

impl PlotPanel {
    /// Shows the plot in all the room that there is, with a curve that stands out from the others. Returns the one that the
    /// pointer is at.
    pub(super) fn surface(
        &mut self,
        ui: &mut Ui,
        request: &Request,
        lit: Option<Slot>,
        context: &mut PanelContext<'_>,
    ) -> Option<Slot> {
        let place = ui.available_rect_before_wrap();
        let response = ui.interact(place, ui.id().with("plot"), Sense::click());
        let empty = self.nothing(request);
        let built = self.figure.as_mut()?;
        let mut screen = Screen::new(ui, place, &mut self.textures);
        let units = [place.width(), place.height()].map(|points| f64::from(points / SCALE));
        fit(ui, built, units, request);
        screen.lit = lit.and_then(|slot| built.slots.iter().position(|known| *known == slot));
        let ground = built.figure.draw(&mut screen);
        let axis = match &built.figure {
            Figure::Plot(plot) => [plot.x.from, plot.x.to],
            Figure::Polar(polar) if polar.around => [-180.0, 180.0],
            _ => [-90.0, 90.0],
        };
        let unit = |at: Pos2| {
            let at = (at - place.min) / SCALE;
            [f64::from(at.x), f64::from(at.y)]
        };
        let pointed = response.hover_pos().and_then(|at| Reading::at(unit(at), &ground, axis));
        self.reading = match pointed {
            Some(reading) => Some(reading.snapped(&built.sheet)),
            None if response.has_focus() => walked(ui, &response, self.reading, request, axis),
            None => None,
        };
        tips(ui, request, built, &ground, &screen);
        let (_, title) = built.figure.frame();
        let says = match self.reading {
            Some(reading) => format!("{title}; {}", reading.name()),
            None => title.to_owned(),
        };
        if response.clicked() {
            response.request_focus();
        }
        theme::says(&response, WidgetType::Image, says);
        if request.setup.kind.declaration().has_light {
            handle::show(ui, &screen, (&ground, axis), unit, context);
        }
        match (empty, self.reading) {
            (Some(text), _) => says_instead(ui, place, text),
            (None, Some(reading)) => mark(ui, &screen, &ground, built, reading),
            (None, None) => {}
        }
        let at = response.hover_pos().filter(|_| !ui.input(|i| i.pointer.any_down()))?;
        let lines = lines(built, &ground, &screen);
        let off = lines.iter().map(|line| linked::distance(at, line)).zip(&built.slots);
        let near = off.filter(|(off, _)| *off < GRASP).min_by(|(a, _), (b, _)| a.total_cmp(b));
        near.map(|(_, slot)| *slot)
    }

    /// The text of a plot without curves.
    fn nothing(&self, request: &Request) -> Option<String> {
        let kind = request.setup.kind;
        let shown: Vec<_> = request.entries.iter().filter(|entry| entry.shown).collect();
        let outcomes: Vec<_> = shown.iter().map(|entry| self.known(entry.slot, kind)).collect();
        if outcomes.iter().any(|outcome| outcome.is_some_and(Result::is_ok)) {
            return None;
        }
        let why: Vec<_> = outcomes.iter().flatten().filter_map(|outcome| outcome.as_ref().err()).collect();
        Some(match () {
            () if shown.is_empty() => "No curve is shown. Show one in the list, or lay one over.".to_owned(),
            () if why.len() < shown.len() => "Calculating…".to_owned(),
            () if why.len() > 1 => "None of the curves can be shown: the list says why.".to_owned(),
            () => why.iter().map(|why| format!("{why}.")).collect(),
        })
    }
}

/// The pointer is at a curve that is this near, points.
const GRASP: f32 = 7.0;

/// The place of a value at an angle in a figure that has such, and true if it is within the scale.
fn place_of(figure: &Figure, ground: &Ground, angle: f64, value: f64) -> Option<([f64; 2], bool)> {
    Some(match (figure, ground) {
        (Figure::Plot(plot), Ground::Plot([left, top, right, bottom])) => {
            let y = bottom - plot.y.place(value) * (bottom - top);
            ([left + plot.x.place(angle) * (right - left), y], (*top - 0.5..=bottom + 0.5).contains(&y))
        }
        (Figure::Polar(polar), Ground::Polar { centre: [x, y], radius, .. }) => {
            let (sin, cos) = angle.to_radians().sin_cos();
            let part = polar.radius.place(value);
            let out = radius * part.max(0.0);
            ([x + out * sin, y - out * cos], (..=1.001).contains(&part))
        }
        _ => return None,
    })
}

/// The curves of a figure as they are on screen.
fn lines(built: &Built, ground: &Ground, screen: &Screen) -> Vec<Vec<Pos2>> {
    let place = |(angle, value): &(f64, f64)| {
        let ([x, y], _) = place_of(&built.figure, ground, *angle, *value)?;
        let y = if let Ground::Plot([_, top, _, bottom]) = ground { y.clamp(*top, *bottom) } else { y };
        Some(screen.place([x, y]))
    };
    let finite = |point: &&(f64, f64)| point.1.is_finite();
    let line = |series: &Series| series.points.iter().filter(finite).filter_map(place).collect();
    series(&built.figure).iter().map(line).collect()
}

/// Says something in the middle of the plot.
fn says_instead(ui: &Ui, place: Rect, text: String) {
    let palette = Palette::here(ui);
    let font = TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout(text, font, palette.text, 0.6 * place.width());
    let at = Align2::CENTER_CENTER.anchor_size(place.center(), galley.size());
    ui.painter().rect(at.expand(8.0), 4.0, palette.panel, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    ui.painter().galley(at.min, galley, palette.text);
}

/// Height of the letters of a name above a slice, in units of figures.
const NAME: f64 = 17.0;

/// The room for the name of a slice with this side, in units of figures.
fn room(side: f64) -> f64 {
    side + GAP[0] - 12.0
}

/// Gives a figure the size of its place.
fn fit(ui: &Ui, built: &mut Built, [width, height]: [f64; 2], request: &Request) {
    let size = (width as u32, height as u32);
    match &mut built.figure {
        Figure::Plot(plot) => plot.size = size,
        Figure::Polar(polar) => polar.size = size,
        Figure::Slices(slices) => {
            let count = slices.tiles.len().max(1);
            let side = |columns: usize| {
                let rows = count.div_ceil(columns) as f64;
                let across = (width - 28.0) / columns as f64 - GAP[0];
                across.min((height - 24.0) / rows - GAP[1]).max(24.0)
            };
            let columns = (1..=count).max_by(|a, b| side(*a).total_cmp(&side(*b)));
            slices.columns = columns.unwrap_or(1);
            slices.side = side(slices.columns);
            let all = built.sheet.slices.iter().zip(&built.slots);
            for (tile, (slice, slot)) in slices.tiles.iter_mut().zip(all) {
                tile.name = short(ui, &slice.name, request.file(*slot), room(slices.side));
            }
        }
    }
}

/// A name shortened to this width in its middle; where it is too long, a file has its own name.
fn short(ui: &Ui, name: &str, file: Option<NamedFile>, width: f64) -> String {
    let font = FontId::proportional(SCALE * NAME as f32);
    let ink = Palette::here(ui).text;
    let within = |text: &str| theme::elided_within(ui, text, &font, ink, SCALE * width as f32);
    let galley = match (within(name), file) {
        ((_, true), Some(file)) => within(&file.short_name()).0,
        ((galley, _), _) => galley,
    };
    galley.text().to_owned()
}

/// Says the whole names of slices where the pointer is at them, and the paths of their files.
fn tips(ui: &Ui, request: &Request, built: &Built, ground: &Ground, screen: &Screen) {
    let Ground::Slices(places) = ground else { return };
    let all = built.sheet.slices.iter().zip(&built.slots).zip(places);
    for ((slice, slot), [left, top, right, _]) in all {
        let corners = [[*left, top - 2.6 * NAME], [left + room(right - left), top - 1.3 * NAME]];
        let [min, max] = corners.map(|corner| screen.place(corner));
        let name = ui.interact(Rect::from_min_max(min, max), ui.id().with(("name", slot)), Sense::hover());
        theme::says(&name, WidgetType::Label, &slice.name);
        theme::tip(name, 480.0, |ui| {
            ui.label(&slice.name);
            if let Some(path) = request.file(*slot).as_ref().and_then(NamedFile::path) {
                ui.label(theme::small(ui, path.shown().to_string()));
            }
        });
    }
}

/// The angle to which arrow keys bring the reading.
fn walked(
    ui: &Ui,
    response: &Response,
    now: Option<Reading>,
    request: &Request,
    [from, to]: [f64; 2],
) -> Option<Reading> {
    let [step, _] = focus::steps(ui, response, [true, false]);
    let start = if request.setup.kind.declaration().has_light { request.setup.theta_i } else { 0.0 };
    let angle = match now {
        Some(Reading::Angle(angle)) => angle,
        Some(other) => return Some(other),
        None => start,
    };
    Some(Reading::Angle((angle + step).clamp(from, to)))
}

/// Marks the values that are read.
fn mark(ui: &Ui, screen: &Screen, ground: &Ground, built: &Built, reading: Reading) {
    let palette = Palette::here(ui);
    let painter = ui.painter();
    let stroke = Stroke::new(1.0, palette.weak);
    match (reading, ground, &built.figure) {
        (Reading::Angle(angle), Ground::Plot([left, top, right, bottom]), Figure::Plot(plot)) => {
            let x = left + plot.x.place(angle) * (right - left);
            painter.line_segment([screen.place([x, *top]), screen.place([x, *bottom])], stroke);
            let font = TextStyle::Small.resolve(ui.style());
            let label = painter.layout_no_wrap(reading::degrees(angle), font, palette.text);
            let at = screen.place([x, *top]) - vec2(0.0, 2.0);
            let at = Align2::CENTER_BOTTOM.anchor_size(at, label.size());
            painter.rect_filled(at.expand2(vec2(4.0, 1.0)), 2.0, palette.panel);
            painter.galley(at.min, label, palette.text);
        }
        (Reading::Angle(angle), Ground::Polar { centre: [x, y], radius, .. }, Figure::Polar(_)) => {
            let (sin, cos) = angle.to_radians().sin_cos();
            let ends =
                [0.0, 1.0].map(|part| screen.place([x + part * radius * sin, y - part * radius * cos]));
            painter.line_segment(ends, stroke);
        }
        (Reading::Angles(half, difference), Ground::Slices(places), _) => {
            for [left, top, right, bottom] in places {
                let x = left + half / 90.0 * (right - left);
                let y = bottom - difference / 90.0 * (bottom - top);
                let at = screen.place([x, y]);
                // Seen on dark and on light.
                for (colour, width) in [(palette.panel, 3.0), (palette.text, 1.0)] {
                    painter.add(Shape::circle_stroke(at, 5.0, Stroke::new(width, colour)));
                }
            }
        }
        _ => {}
    }
    let Reading::Angle(angle) = reading else { return };
    for (curve, series) in built.sheet.curves.iter().zip(series(&built.figure)) {
        let value = reading::of_curve(&built.sheet, curve, angle).unwrap_or(f64::NAN);
        if let Some((at, true)) = place_of(&built.figure, ground, angle, value) {
            let colour = screen.colour(Ink::Curve(series.colour));
            painter.circle(screen.place(at), 3.5, colour, Stroke::new(1.0, palette.panel));
        }
    }
}

/// A legend's sample.
pub(super) fn sample(ui: &Ui, place: Rect, series: &crate::curves::draw::Series) {
    let mut none = super::pen::Textures::default();
    let mut screen = Screen::new(ui, place, &mut none);
    let [width, height] = [place.width(), place.height()].map(|points| f64::from(points / SCALE));
    crate::curves::draw::sample(&mut screen, [2.0, 0.5 * height], width - 4.0, series);
}

/// The room of a sample.
pub(super) fn sample_size() -> Vec2 {
    vec2(34.0, 18.0)
}

/// The middle of the left edge, and the right: for samples in menus.
pub(super) fn right_end(row: Rect) -> Rect {
    let size = sample_size();
    Rect::from_min_size(pos2(row.right() - size.x - 6.0, row.center().y - 0.5 * size.y), size)
}
