//! The panel of the plots: curves of the selected object's model with its present parameters, and of what was pinned or
//! laid over. Curves are calculated in a thread of their own, and only while the panel is shown.
//!
//! The figure is that of [`curves`](crate::curves), drawn by another pen: what the window shows is what
//! its files show.

use super::{linked, narrow, prelude::*, state::Slot};
use crate::curves::{
    Channel, Kind, Setup, Sheet, Style,
    draw::{Figure, Series},
};
use reading::Reading;
use request::{Drawn, Key};
use work::{Done, Item, Job, Worker};

mod choices;
mod file;
mod handle;
mod legend;
mod links;
mod pen;
mod reading;
mod request;
mod surface;
mod work;

pub(super) use file::{file_name, offer};
pub use file::{file_of, write};
pub use request::{Entry, NoCurve, Recipe, Request};

/// See the module.
#[derive(Default)]
pub struct PlotPanel {
    worker: Worker,
    /// The last curve of each place in the list.
    known: Vec<Done>,
    /// The last request.
    asked: Option<(Setup, Vec<(Slot, Key)>)>,
    /// The number of curves that have come.
    news: u64,
    figure: Option<Built>,
    textures: pen::Textures,
    reading: Option<Reading>,
    /// The place in the list of the curve that the pointer is at.
    pointed: Option<Slot>,
    influences: Vec<links::Influence>,
}

/// A figure, and what it was made from.
struct Built {
    of: (u64, Setup, Option<Channel>, bool, Vec<(Slot, Style)>),
    sheet: Sheet,
    figure: Figure,
    /// Remarks on it.
    notes: Vec<String>,
    /// The place in the list of each curve of the sheet.
    slots: Vec<Slot>,
    /// The longest value in the list.
    longest: String,
}

impl PlotPanel {
    /// Shows the panel.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry) = (context.session(), context.registry());
        let request = Request::of(session, registry);
        self.follow(ui.ctx(), &request, registry);
        self.build(&request);
        let live = links::is_live_lit(ui.ctx(), &request, &mut self.influences);
        let lit = self.pointed.or(live.then_some(Slot::Live));
        choices::row(ui, context);
        let whole = ui.available_rect_before_wrap();
        let (plot, list) = divided(ui, whole);
        let mut pointed = None;
        theme::column(ui, plot.with_max_x(plot.right() - 8.0), |ui| {
            pointed = self.surface(ui, &request, lit, context);
        });
        if let Some(slot) = pointed {
            linked::point(ui.ctx(), links::of_slot(&request, slot));
        }
        let list = Rect::from_min_max(list.min + vec2(12.0, 0.0), list.max);
        theme::column(ui, list, |ui| {
            pointed = pointed.or(legend::show(ui, self, &request, lit, context));
        });
        if std::mem::replace(&mut self.pointed, pointed) != pointed {
            ui.ctx().request_repaint();
        }
    }

    /// Takes what was calculated, and asks for what is missing.
    fn follow(&mut self, ctx: &Context, request: &Request, registry: &Registry) {
        self.worker.shown(ctx);
        let busy = self.worker.is_busy();
        for done in self.worker.take() {
            self.known.retain(|known| known.slot != done.slot);
            self.known.push(done);
            self.news += 1;
        }
        let setup = request.calculated();
        self.known.retain(|known| request.entries.iter().any(|entry| entry.slot == known.slot));
        let shown = || request.entries.iter().filter(|entry| entry.shown);
        let known = |entry: &Entry| {
            let is = |done: &&Done| done.slot == entry.slot && done.key == entry.key && done.setup == setup;
            self.known.iter().find(is)
        };
        let missing: Vec<_> = shown().filter(|entry| !known(entry).is_some_and(|done| done.fine)).collect();
        let asked = (setup, shown().map(|entry| (entry.slot, entry.key.clone())).collect());
        if missing.is_empty() || busy && self.asked.as_ref() == Some(&asked) {
            return;
        }
        let item = |entry: &Entry| Item {
            slot: entry.slot,
            key: entry.key.clone(),
            recipe: entry.recipe.clone(),
            coarse: known(entry).is_some(),
        };
        let items = missing.into_iter().map(item).collect();
        let may_lack = setup.kind.declaration().factor.is_some();
        self.worker.ask(ctx, Job { setup, items, registry: may_lack.then(|| registry.clone()) });
        self.asked = Some(asked);
    }

    /// The result known for a place in the list for the quantity that is shown; while a knob is dragged it may be a moment
    /// old.
    fn known(&self, slot: Slot, kind: Kind) -> Option<&Result<Arc<Drawn>, String>> {
        let done = self.known.iter().find(|done| done.slot == slot && done.setup.kind == kind)?;
        Some(&done.outcome)
    }

    /// Makes the figure anew if anything is new.
    fn build(&mut self, request: &Request) {
        let kind = request.setup.kind;
        let shown = request.entries.iter().filter(|entry| entry.shown);
        let styles: Vec<_> = shown.map(|entry| (entry.slot, entry.style)).collect();
        let of = (self.news, request.setup, request.channel, request.log, styles);
        if self.figure.as_ref().is_some_and(|built| built.of == of) {
            return;
        }
        let drawn: Vec<_> = (of.4.iter())
            .filter_map(|(slot, style)| {
                let drawn = self.known(*slot, kind)?.as_ref().ok()?;
                Some((*slot, *style, drawn.clone()))
            })
            .collect();
        let sheet = request.sheet(drawn.iter().map(|(_, style, drawn)| (*style, &**drawn)));
        let (figure, notes) = bare(sheet.figure());
        self.textures.stale = true;
        let slots: Vec<_> = drawn.iter().map(|(slot, ..)| *slot).collect();
        // While a knob is turned, the room for the values only grows.
        let before = self.figure.take().filter(|built| built.of.1.kind == kind && built.slots == slots);
        let all = before.map(|built| built.longest).into_iter().chain([reading::longest(&sheet)]);
        let longest = all.max_by_key(|text| text.chars().count()).unwrap_or_default();
        self.figure = Some(Built { of, sheet, figure, notes, slots, longest });
    }
}

/// The places of the curves and of their list.
fn divided(ui: &Ui, whole: Rect) -> (Rect, Rect) {
    let line = Stroke::new(1.0, Palette::here(ui).line);
    if narrow::is(ui.ctx()) {
        let (plot, list) = whole.split_top_bottom_at_fraction(0.62);
        ui.painter().hline(whole.x_range(), list.top(), line);
        return (plot, list.with_min_y(list.top() + 6.0));
    }
    let width = (0.3 * whole.width()).clamp(230.0, 360.0);
    let (plot, list) = whole.split_left_right_at_x(whole.right() - width);
    ui.painter().vline(list.left(), whole.y_range(), line);
    (plot, list)
}

impl Built {
    /// The line of a place in the list, as the figure has it.
    fn series(&self, slot: Slot) -> Option<&Series> {
        series(&self.figure).get(self.slots.iter().position(|known| *known == slot)?)
    }
}

/// The lines of a figure.
fn series(figure: &Figure) -> &[Series] {
    match figure {
        Figure::Plot(plot) => &plot.series,
        Figure::Polar(polar) => &polar.series,
        Figure::Slices(_) => &[],
    }
}

/// A figure without what the panel shows beside it, and the remarks.
fn bare(mut figure: Figure) -> (Figure, Vec<String>) {
    let (heading, notes) = match &mut figure {
        Figure::Plot(plot) => {
            plot.legend = false;
            (&mut plot.heading, &mut plot.notes)
        }
        Figure::Polar(polar) => {
            polar.legend = false;
            (&mut polar.heading, &mut polar.notes)
        }
        Figure::Slices(slices) => (&mut slices.heading, &mut slices.notes),
    };
    heading.clear();
    let notes = std::mem::take(notes);
    (figure, notes)
}
