//! The plot itself, and what is read from it.

use bevy_egui::egui::{
    Align2, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo, WidgetType,
    pos2, vec2,
};

use super::{
    Built, PlotPanel, Request, handle,
    pen::{SCALE, Screen},
    reading::{self, Reading},
};
use crate::{
    curves::{
        Sheet,
        draw::{Figure, GAP, Ground, Ink, Pen, Series},
    },
    panel::{
        focus, linked,
        state::{Action, Slot},
        theme::{self, Palette},
    },
};

impl PlotPanel {
    /// Shows the plot in all the room that there is, with a curve that stands out from the others. Returns the one that the
    /// pointer is at.
    pub(super) fn surface(
        &mut self,
        ui: &mut Ui,
        request: &Request,
        theta_i: f64,
        lit: Option<Slot>,
        actions: &mut Vec<Action>,
    ) -> Option<Slot> {
        let place = ui.available_rect_before_wrap();
        let response = ui.interact(place, ui.id().with("plot"), Sense::click());
        let empty = self.nothing(request);
        let built = self.figure.as_mut()?;
        let mut screen = Screen::new(ui, place, &mut self.textures);
        let units = [place.width(), place.height()].map(|points| f64::from(points / SCALE));
        fit(built, units, &screen);
        screen.lit = lit.and_then(|slot| built.slots.iter().position(|known| *known == slot));
        let ground = built.figure.draw(&mut screen);
        let axis = match &built.figure {
            Figure::Plot(plot) => [plot.x.from, plot.x.to],
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
        let title = match &built.figure {
            Figure::Plot(plot) => &plot.title,
            Figure::Polar(polar) => &polar.title,
            Figure::Slices(slices) => &slices.title,
        };
        let says = match self.reading {
            Some(reading) => format!("{title}; {}", reading.name()),
            None => title.clone(),
        };
        if response.clicked() {
            response.request_focus();
        }
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, &says));
        if request.setup.kind.has_light() {
            handle::show(ui, &screen, &ground, theta_i, unit, actions);
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

/// The curves of a figure as they are on screen.
fn lines(built: &Built, ground: &Ground, screen: &Screen) -> Vec<Vec<Pos2>> {
    let of = |series: &[Series], place: &dyn Fn(f64, f64) -> [f64; 2]| {
        let line = |series: &Series| {
            let finite = series.points.iter().filter(|point| point.1.is_finite());
            finite.map(|(angle, value)| screen.place(place(*angle, *value))).collect()
        };
        series.iter().map(line).collect()
    };
    match (&built.figure, ground) {
        (Figure::Plot(plot), Ground::Plot([left, top, right, bottom])) => {
            of(&plot.series, &|angle, value| {
                let y = bottom - plot.y.place(value) * (bottom - top);
                [left + plot.x.place(angle) * (right - left), y.clamp(*top, *bottom)]
            })
        }
        (Figure::Polar(polar), Ground::Polar { centre: [x, y], radius }) => {
            of(&polar.series, &|angle, value| {
                let (sin, cos) = angle.to_radians().sin_cos();
                let out = radius * polar.radius.place(value).max(0.0);
                [x + out * sin, y - out * cos]
            })
        }
        _ => Vec::new(),
    }
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

/// Gives a figure the size of its place.
fn fit(built: &mut Built, [width, height]: [f64; 2], screen: &Screen) {
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
            for (tile, slice) in slices.tiles.iter_mut().zip(&built.sheet.slices) {
                tile.name = cut(&slice.name, slices.side + GAP[0] - 12.0, screen);
            }
        }
    }
}

/// A name that is no wider than this.
fn cut(name: &str, width: f64, screen: &Screen) -> String {
    let fits = |text: &str| screen.width(17.0, text) <= width;
    if fits(name) {
        return name.to_owned();
    }
    let letters: Vec<char> = name.chars().collect();
    let with = |count: usize| letters[..count].iter().collect::<String>().trim_end().to_owned() + "…";
    let most = (1..letters.len()).take_while(|count| fits(&with(*count))).last();
    with(most.unwrap_or(1))
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
    let start = if request.setup.kind.has_light() { request.setup.theta_i } else { 0.0 };
    let angle = match now {
        Some(Reading::Angle(angle)) => angle,
        Some(other) => return Some(other),
        None => start,
    };
    Some(Reading::Angle((angle + step).clamp(from, to)))
}

/// Marks what is read.
fn mark(ui: &Ui, screen: &Screen, ground: &Ground, built: &Built, reading: Reading) {
    let palette = Palette::here(ui);
    let painter = ui.painter();
    let stroke = Stroke::new(1.0, palette.weak);
    let font = TextStyle::Small.resolve(ui.style());
    let dot = |at: Pos2, colour: usize| {
        painter.circle(at, 3.5, screen.colour(Ink::Curve(colour)), Stroke::new(1.0, palette.panel));
    };
    let values = |sheet: &Sheet, angle: f64| -> Vec<f64> {
        let value = |curve| reading::of_curve(sheet, curve, angle).unwrap_or(f64::NAN);
        sheet.curves.iter().map(value).collect()
    };
    match (reading, ground, &built.figure) {
        (Reading::Angle(angle), Ground::Plot([left, top, right, bottom]), Figure::Plot(plot)) => {
            let x = left + plot.x.place(angle) * (right - left);
            painter.line_segment([screen.place([x, *top]), screen.place([x, *bottom])], stroke);
            let label = reading::degrees(angle);
            let label = painter.layout_no_wrap(label, font, palette.text);
            let at = screen.place([x, *top]) - vec2(0.0, 2.0);
            let at = Align2::CENTER_BOTTOM.anchor_size(at, label.size());
            painter.rect_filled(at.expand2(vec2(4.0, 1.0)), 2.0, palette.panel);
            painter.galley(at.min, label, palette.text);
            for (value, series) in values(&built.sheet, angle).iter().zip(&plot.series) {
                let y = bottom - plot.y.place(*value) * (bottom - top);
                if (*top - 0.5..=bottom + 0.5).contains(&y) {
                    dot(screen.place([x, y]), series.colour);
                }
            }
        }
        (Reading::Angle(angle), Ground::Polar { centre, radius }, Figure::Polar(polar)) => {
            let at = |part: f64| {
                let (sin, cos) = angle.to_radians().sin_cos();
                screen.place([centre[0] + part * radius * sin, centre[1] - part * radius * cos])
            };
            painter.line_segment([at(0.0), at(1.0)], stroke);
            for (value, series) in values(&built.sheet, angle).iter().zip(&polar.series) {
                let part = polar.radius.place(*value);
                if (..=1.001).contains(&part) {
                    dot(at(part.max(0.0)), series.colour);
                }
            }
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
}

/// A legend's sample.
pub(super) fn sample(ui: &Ui, place: Rect, series: &crate::curves::draw::Series) {
    let mut none = super::pen::Textures::default();
    let mut screen = Screen::new(ui, place, &mut none);
    let [width, height] = [place.width(), place.height()].map(|points| f64::from(points / SCALE));
    crate::curves::draw::sample(&mut screen, [2.0, 0.5 * height], width - 4.0, series);
}

/// The room of a sample.
pub(super) fn sample_size() -> bevy_egui::egui::Vec2 {
    vec2(34.0, 18.0)
}

/// The middle of the left edge, and the right: for samples in menus.
pub(super) fn right_end(row: Rect) -> Rect {
    let size = sample_size();
    Rect::from_min_size(pos2(row.right() - size.x - 6.0, row.center().y - 0.5 * size.y), size)
}

/// Text of less weight, in lines.
pub(super) fn small_lines(ui: &mut Ui, text: &str) {
    ui.add(bevy_egui::egui::Label::new(theme::small(ui, text)).wrap());
}
