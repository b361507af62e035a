//! The list of the curves: the subject, its colour and dash, its value where the plot is read.

use bevy_egui::egui::PopupCloseBehavior;

use super::{
    Entry, PlotPanel, Recipe, Request, links,
    reading::{self, Reading},
    request::Drawn,
    surface::{right_end, sample, sample_size},
};
use crate::{
    curves::{
        Form, Kind, Style,
        data::{PAINTS, Sgd},
        draw::{COLOURS, Line, Mark, Series},
    },
    panel::{
        chooser, knob, linked, menu,
        prelude::*,
        state::{Effect, Of, Pick, Slot},
    },
    parameter::Values,
};

/// The colours of curves, as they are called.
const COLOUR_NAMES: [&str; COLOURS.len()] = ["blue", "vermilion", "green", "purple", "orange", "sky blue"];

/// Shows the list in all the room that there is, with the row of a curve that stands out. Returns the one that the pointer
/// is at.
pub(super) fn show(
    ui: &mut Ui,
    panel: &PlotPanel,
    request: &Request,
    lit: Option<Slot>,
    context: &mut PanelContext<'_>,
) -> Option<Slot> {
    buttons(ui, context);
    let quantity = request.setup.kind.declaration().quantity;
    let heading = panel.reading.map_or_else(String::new, |at| format!("{quantity} {}", at.name()));
    // The line is there before it says something: nothing moves under the pointer.
    ui.label(theme::small(ui, if heading.is_empty() { " " } else { &heading }));
    let mut pointed = None;
    ScrollArea::vertical().id_salt("curves of the plot").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        ui.spacing_mut().item_spacing.y = 2.0;
        for entry in &request.entries {
            let under = ui.painter().add(Shape::Noop);
            let row = ui.push_id(entry.slot, |ui| row(ui, panel, entry, request.setup.kind, context));
            let place = row.response.rect;
            linked::touch(ui, place, links::of_slot(request, entry.slot));
            if ui.rect_contains_pointer(place) && ui.ctx().dragged_id().is_none() {
                pointed = Some(entry.slot);
            }
            if lit == Some(entry.slot) {
                ui.painter().set(under, linked::row_ground(place, &Palette::here(ui)));
            }
        }
        let notes = panel.figure.as_ref().map_or(&[][..], |built| &built.notes);
        if !notes.is_empty() {
            ui.add_space(6.0);
            notes.iter().for_each(|note| _ = theme::note(ui, note));
        }
    });
    pointed
}

fn buttons(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let help = "Keep the curve of the selected object as it is now, to compare it with what it becomes";
        let some = session.plotted().is_some();
        let button = ui.add_enabled(some, Button::new("Pin")).on_hover_text(help);
        context.on_click(&button, || Action::Plot(PlotCommand::Pin));
        let more =
            |text: &str| Button::new(text).right_text(RichText::new("▾").color(Palette::here(ui).weak));
        let (model, data) = (more("Model"), more("Measured"));
        let height = 0.45 * ui.ctx().content_rect().height();
        let button = ui.add(model).on_hover_text("Lay another model over, with its defaults");
        theme::says(&button, WidgetType::ComboBox, "Lay a model over");
        let id = ui.make_persistent_id("model of the plot");
        let picked = knob::drop_down(&button, id, knob::WIDE, |ui, id| {
            chooser::models(ui, id, height, session, registry, None, None).flatten()
        });
        if let Some(entry) = picked {
            Popup::close_id(ui.ctx(), id);
            let id = entry.declaration.id.to_owned();
            let encoding = session.scene().display.encoding;
            let of = Of::Model { id, values: Values::default(), encoding };
            context.act(Action::Plot(PlotCommand::Add(of)));
        }
        let help =
            "Lay measured data over: the Cornell paints, or fits to the materials of the MERL database";
        let button = ui.add(data).on_hover_text(help);
        theme::says(&button, WidgetType::ComboBox, "Lay measured data over");
        let id = ui.make_persistent_id("data of the plot");
        if let Some(name) = knob::drop_down(&button, id, 320.0, |ui, id| measured(ui, id, height)) {
            Popup::close_id(ui.ctx(), id);
            context.act(Action::Plot(PlotCommand::Add(Of::Measured(name))));
        }
        let help = "Write the plot to a file: vector graphics (SVG), a picture (PNG) or numbers (CSV)";
        let button = ui.button("Export…").on_hover_text(help);
        context.on_click(&button, || Action::Do(Effect::Pick(Pick::Plot)));
    });
}

/// The list of measured data.
fn measured(ui: &mut Ui, id: Id, height: f32) -> Option<String> {
    let words = chooser::Words {
        label: "Search measured data",
        hint: "Search materials",
        none: "No material has that in its name.",
        foot: "Paints were measured at light angles of about 30° to 75° only, in single directions. Materials of the MERL database are shown by the fits of M. Bagher et al. (2012).",
        ..chooser::Words::default()
    };
    let paints = PAINTS.map(|(id, name)| (id.to_owned(), name.to_owned(), true));
    let fits = Sgd::all().into_iter().map(|fit| (fit.name.to_owned(), fit.name.replace('-', " "), false));
    let all: Vec<_> = paints.into_iter().chain(fits).collect();
    let find = |search: &str| -> Vec<&(String, String, bool)> {
        all.iter().filter(|(id, name, _)| chooser::matches(&[id.as_str(), name].join(" "), search)).collect()
    };
    fn entry<'e>((_, name, paint): &&'e (String, String, bool)) -> chooser::Entry<'e> {
        let heading = if *paint { "Cornell paints, measured" } else { "MERL database, fitted" };
        chooser::Entry { heading, name, ..chooser::Entry::default() }
    }
    let picked = chooser::list(ui, id, words, height, find, entry, |ui, (_, name, _)| {
        ui.label(theme::strong(ui, name));
    });
    picked.map(|(id, ..)| id.clone())
}

fn row(ui: &mut Ui, panel: &PlotPanel, entry: &Entry, kind: Kind, context: &mut PanelContext<'_>) {
    let session = context.session();
    let palette = Palette::here(ui);
    let known = panel.known(entry.slot, kind);
    let drawn = known.and_then(|known| known.as_ref().ok());
    let name = drawn.map_or_else(|| entry.recipe.name(), |drawn| drawn.name().to_owned());
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let (icon, way) = if entry.shown { (Icon::Eye, "Hide") } else { (Icon::EyeOff, "Show") };
        if icon::button(ui, icon, &format!("{way} the curve of {name}")).clicked() {
            context.act(Action::Plot(PlotCommand::Show(entry.slot, !entry.shown)));
        }
        style(ui, panel, entry, &name, kind, context);
        ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            if let Slot::Pin(number) = entry.slot {
                if icon::button(ui, Icon::Cross, &format!("Remove the curve of {name}")).clicked() {
                    context.act(Action::Plot(PlotCommand::Remove(number)));
                }
            } else {
                ui.add_space(icon::SIZE + 4.0);
            }
            let value = value(panel, entry, drawn.map(|drawn| &**drawn));
            let below = value_beside(ui, panel, value);
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                let colour = if entry.shown { palette.text } else { palette.weak };
                ui.add(Label::new(RichText::new(&name).color(colour)).wrap());
                below.into_iter().for_each(|value| _ = ui.label(theme::strong(ui, value)));
                if entry.slot == Slot::Live
                    && let Some((scene, object)) = session.plotted()
                    && let Some(i) = scene.objects.iter().position(|o| std::ptr::eq(o, object))
                {
                    let of = session.name_of(Selection::Object(i), context.registry());
                    theme::note(ui, format!("now: {of}"));
                }
                if let Some(Err(why)) = known.filter(|_| entry.shown) {
                    let text = RichText::new(format!("{why}.")).small().color(palette.warning);
                    ui.add(Label::new(text).wrap().selectable(true));
                }
            });
        });
    });
}

/// The least room for a name beside its value, in points.
const NAME: f32 = 96.0;

/// Shows a value at the right, with the room of the longest: names wrap alike whether there is one or not. Returns the
/// line to be shown below the name where there is too little room.
fn value_beside(ui: &mut Ui, panel: &PlotPanel, value: Option<String>) -> Option<String> {
    let longest = panel.figure.as_ref().map_or("", |built| &*built.longest);
    if longest.is_empty() {
        return value;
    }
    let width = |text: &str| {
        let font = theme::bold(ui);
        ui.painter().layout_no_wrap(text.to_owned(), font, Color32::WHITE).size().x
    };
    let width = value.iter().map(|value| width(value)).fold(width(longest), f32::max);
    if ui.available_width() - width < NAME {
        return Some(value.unwrap_or_else(|| " ".to_owned()));
    }
    let room = vec2(width, ui.text_style_height(&TextStyle::Body));
    ui.allocate_ui_with_layout(room, Layout::right_to_left(Align::Min), |ui| {
        ui.set_min_width(width);
        value.into_iter().for_each(|value| _ = ui.label(theme::strong(ui, value)));
    });
    None
}

/// The value of a curve where the plot is read.
fn value(panel: &PlotPanel, entry: &Entry, drawn: Option<&Drawn>) -> Option<String> {
    let sheet = &panel.figure.as_ref()?.sheet;
    match (panel.reading.filter(|_| entry.shown)?, drawn?) {
        (Reading::Angle(angle), Drawn::Curve(curve)) => Some(reading::curve_text(sheet, curve, angle)),
        (Reading::Angles(half, difference), Drawn::Slice(slice)) => {
            let value = reading::of_slice(sheet, slice, [half, difference]);
            Some(value.map_or_else(|| "–".to_owned(), reading::text))
        }
        _ => None,
    }
}

/// The sample of a curve, which opens the choice of its colour and its dash.
fn style(
    ui: &mut Ui,
    panel: &PlotPanel,
    entry: &Entry,
    name: &str,
    kind: Kind,
    context: &mut PanelContext<'_>,
) {
    if kind.declaration().form == Form::Slices {
        return;
    }
    let built = panel.figure.as_ref().and_then(|built| built.series(entry.slot));
    let data = matches!(&entry.recipe, Recipe::Measured(id) if PAINTS.iter().any(|(paint, _)| paint == id));
    let plain = Series {
        name: String::new(),
        points: Vec::new(),
        bars: Vec::new(),
        colour: if data { COLOURS.len() } else { entry.style.colour },
        line: if data { Line::None } else { entry.style.line },
        mark: if data { Mark::Ring } else { Mark::None },
    };
    let series = built.unwrap_or(&plain);
    if data {
        let (place, response) = ui.allocate_exact_size(sample_size(), Sense::hover());
        sample(ui, place, series);
        response.on_hover_text("Measured points");
        return;
    }
    let (place, response) = ui.allocate_exact_size(sample_size(), Sense::click());
    let Style { colour, line } = entry.style;
    let colour = COLOUR_NAMES.get(colour).copied().unwrap_or_default();
    let says = format!("Colour and dash of {name}: {colour}, {}", line.name());
    theme::says(&response, WidgetType::ComboBox, says);
    if theme::is_hot(&response) {
        ui.painter().rect_filled(place, 4.0, Palette::here(ui).hovered);
    }
    sample(ui, place, series);
    let response = response.on_hover_text("Colour and dash");
    let mut by_key = false;
    let popup = Popup::menu(&response).close_behavior(PopupCloseBehavior::CloseOnClick).width(190.0);
    let picked = popup.show(|ui| picked(ui, entry.style, &plain, &mut by_key));
    if by_key {
        response.request_focus();
    }
    if let Some(style) = picked.and_then(|shown| shown.inner) {
        context.act(Action::Plot(PlotCommand::Style(entry.slot, style)));
    }
}

/// The colours and dashes that a curve can have. Returns the chosen style.
fn picked(ui: &mut Ui, now: Style, plain: &Series, by_key: &mut bool) -> Option<Style> {
    ui.set_min_width(190.0);
    let mut picked = None;
    let mut offer = |ui: &mut Ui, name: &str, style: Style| {
        let text = format!("{name}{}", " ".repeat(16));
        let response = menu::choice(ui, style == now, text, by_key);
        let series = Series { colour: style.colour, line: style.line, ..plain.clone() };
        sample(ui, right_end(response.rect.with_max_x(ui.max_rect().right())), &series);
        if response.clicked() {
            picked = Some(style);
        }
    };
    for (colour, name) in COLOUR_NAMES.into_iter().enumerate() {
        offer(ui, name, Style { colour, ..now });
    }
    ui.separator();
    for line in Line::ALL {
        offer(ui, line.name(), Style { line, ..now });
    }
    picked
}
