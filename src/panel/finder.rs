//! The finder: a few letters find a command, an example scene, a lesson, a reflection model or a parameter of what is
//! selected, with its key. Enter runs it.

use std::cell::RefCell;

use bevy_egui::egui::{Frame, LayerId, PopupCloseBehavior, RectAlign};

use super::{
    chooser::{self, Entry, Words},
    command::{self, Command, Mark, Menu},
    explain::has_sides,
    keys,
    lesson::point,
    narrow,
    prelude::*,
    rank::{leave_out_chance, rank},
};
use crate::{
    parameter::{Parameter, Values},
    reflection::usage,
    text::{capitalised, facts},
};

/// The width, points, and the room at its sides in a narrower window.
const WIDTH: f32 = 620.0;
const MARGIN: f32 = 24.0;
/// The margin around the content, points.
const PADDING: f32 = 8.0;
/// The part of the window above it, and the part that its list takes.
const ABOVE: f32 = 0.09;
const LIST: f32 = 0.58;
/// Number of the latest commands that come first.
const RECENT: usize = 5;

pub(super) const WORDS: Words = Words {
    label: "Find a command",
    hint: "Find a command, a scene, a lesson, a model or a parameter…",
    none: "Nothing is called so.",
    foot: "↑ ↓ choose · Enter runs · Esc closes",
    roomy: true,
};

fn id() -> Id {
    Id::new("finder")
}

/// An entry that can be found.
struct Found {
    id: String,
    title: String,
    /// The place among the headings.
    order: u8,
    heading: &'static str,
    note: String,
    /// Further words by which it is found, each with its name.
    said: Vec<(String, String)>,
    /// What finds it though its row does not show it, each with its name: synonyms first, which are alike.
    unsaid: Vec<(String, String)>,
    key: String,
    off: bool,
    on: bool,
    tip: String,
    does: Does,
}

impl Found {
    fn entry<'f>(&'f self, heading: &'f str, search: &str) -> Entry<'f> {
        // Its menu stands above.
        let note = Some(&self.note).filter(|note| !note.is_empty() && *note != heading).cloned();
        let unseen = self.unsaid.iter().chain(&self.said);
        let why = chooser::reason(&format!("{} {}", self.title, self.note), unseen, search);
        Entry {
            heading,
            name: &self.title,
            note: why.into_iter().chain(note).collect::<Vec<_>>().join(" · "),
            on: self.on,
            key: Some(self.key.clone()),
            off: self.off,
            ..Entry::default()
        }
    }
}

/// The effect of the chosen entry.
enum Does {
    Act(Action),
    /// The knob of this name has the focus.
    Seek(String),
}

/// See the module.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let ctx = ui.ctx();
    if !context.session().view.finder_open {
        return chooser::forget(ctx, id());
    }
    if let Some(text) = keys::typed_ahead(ctx) {
        chooser::begin(ctx, id(), text);
    }
    let all = everything(ctx, context.session(), context.registry());
    let screen = ctx.content_rect();
    let margin = if narrow::is(ctx) { 0.5 * MARGIN } else { MARGIN };
    let width = WIDTH.min(screen.width() - 2.0 * margin);
    let at = pos2(screen.center().x, screen.top() + ABOVE * screen.height());
    let (mut open, mut chosen) = (true, None);
    Popup::new(id(), ctx.clone(), at, LayerId::background())
        .align(RectAlign::BOTTOM)
        .open_bool(&mut open)
        .width(width)
        .frame(Frame::popup(&ctx.global_style()).inner_margin(PADDING))
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(width);
            let typed = RefCell::new(String::new());
            let find = |search: &str| {
                search.trim().clone_into(&mut typed.borrow_mut());
                if search.trim().is_empty() { listed(ctx, &all) } else { ranked(&all, search) }
            };
            let height = LIST * screen.height();
            chosen = chooser::list(
                ui,
                id(),
                WORDS,
                height,
                find,
                |(heading, found)| {
                    let search = typed.borrow();
                    found.entry(if search.is_empty() { heading } else { "" }, &search)
                },
                |ui, (_, found)| _ = ui.label(&found.tip),
            );
        });
    if !open || chosen.is_some() {
        context.act(Action::View(ViewChange::Finder(false)));
    }
    let Some((_, found)) = chosen else { return };
    remember(ctx, &found.id);
    match &found.does {
        Does::Act(action) => context.act(action.clone()),
        Does::Seek(knob) => {
            context.act(Action::View(ViewChange::Right(true)));
            point::seek(ctx, knob);
        }
    }
}

/// The ids of the latest commands, the last one first.
fn latest(ctx: &Context) -> Vec<String> {
    ctx.data(|d| d.get_temp(id().with("latest"))).unwrap_or_default()
}

fn remember(ctx: &Context, command: &str) {
    let mut all = latest(ctx);
    all.retain(|known| known != command);
    all.insert(0, command.to_owned());
    all.truncate(RECENT);
    ctx.data_mut(|d| d.insert_temp(id().with("latest"), all));
}

/// All entries in the order of the menus, after the latest.
fn listed<'f>(ctx: &Context, all: &'f [Found]) -> Vec<(&'static str, &'f Found)> {
    let latest = latest(ctx);
    let again = latest.iter().filter_map(|id| all.iter().find(|found| found.id == *id));
    again.map(|found| ("Used last", found)).chain(all.iter().map(|found| (found.heading, found))).collect()
}

/// The entries that match the typed text, best first.
fn ranked<'f>(all: &'f [Found], search: &str) -> Vec<(&'static str, &'f Found)> {
    let texts =
        |all: &'f [(String, String)]| -> Vec<&'f str> { all.iter().map(|(text, _)| text.as_str()).collect() };
    let fits = |found: &'f Found| {
        let said = texts(&found.said).join(" ");
        Some((rank(&found.title, &texts(&found.unsaid), &said, search)?, found))
    };
    let mut found: Vec<_> = all.iter().filter_map(fits).collect();
    leave_out_chance(&mut found);
    // Who types the name of a model looks for the model, not for a scene that is called so too.
    found.sort_by_key(|(rank, found)| (-rank, found.off, !found.id.starts_with("model.")));
    found.into_iter().map(|(_, found)| (found.heading, found)).collect()
}

fn everything(ctx: &Context, session: &Session, registry: &Registry) -> Vec<Found> {
    let root = command::all(session, registry, has_sides(ctx, session));
    let mut all = commands(&root, session, registry);
    if !session.view.presenting {
        all.extend(parameters(session, registry));
    }
    all.sort_by_key(|found| found.order);
    all
}

fn commands(root: &Menu, session: &Session, registry: &Registry) -> Vec<Found> {
    // Recent models are among all models, with the keys of their numbers.
    let recent = |command: &Command| command.id.starts_with("recent_model.");
    let numbers: Vec<_> = root.commands().into_iter().map(|(_, c)| c).filter(|c| recent(c)).collect();
    let key = |command: &Command| {
        let model = command.id.strip_prefix("model.");
        let slot = session.model_slots.iter().position(|known| Some(&**known) == model);
        let number = || numbers.get(slot?)?.keys.first();
        command.keys.first().or_else(number).map(ToString::to_string)
    };
    let offered = |command: &Command| {
        let away = session.view.presenting && command.at_desk;
        !(command.absent || command.held || away || recent(command) || command.id == command::FINDER)
    };
    let short = chooser::short_names(registry);
    let all = root.commands().into_iter().filter(|(_, command)| offered(command));
    let found = all.map(|(path, command)| {
        let why = command.why_not.as_deref().map(|why| why.trim_end_matches('.').to_owned());
        let place = if path.is_empty() { command.heading().name().to_owned() } else { path.join(" › ") };
        let model = command.id.strip_prefix("model.").and_then(|id| registry.model(id));
        let said = match model {
            Some(model) => Vec::from(chooser::words(model)),
            None => said(command, &place),
        };
        Found {
            id: command.id.to_string(),
            title: command.title(&path),
            order: match path.first() {
                Some(menu) if command::BAR.iter().any(|(_, name)| name == menu) => 0,
                None => 1,
                Some(_) => 3,
            },
            heading: path.first().copied().unwrap_or(command.heading().name()),
            note: match (&why, model) {
                (Some(why), _) => why.clone(),
                (None, Some(model)) => facts([&place, &chooser::author_of(model, registry)]),
                (None, None) => place,
            },
            said,
            unsaid: model.map(|model| chooser::further(model, &short)).unwrap_or_default(),
            key: key(command).unwrap_or_default(),
            off: why.is_some(),
            on: matches!(command.mark, Mark::Check(true) | Mark::Radio(true)),
            tip: if command.tip.is_empty() { command.title(&path) } else { command.tip.to_string() },
            does: Does::Act(command.action.clone()),
        }
    });
    found.collect()
}

/// The words by which a command is found, besides its title, each with what the row says of it.
fn said(command: &Command, place: &str) -> Vec<(String, String)> {
    let [name, tip, id] = [&*command.name, &*command.tip, &*command.id];
    let all = [(place, place), (name, name), (tip, chooser::DESCRIPTION), (id, id)];
    Vec::from(all.map(|(text, name)| (text.to_owned(), name.to_owned())))
}

/// The parameters of the selected object or light that have knobs.
fn parameters(session: &Session, registry: &Registry) -> Vec<Found> {
    let name = session.name_of(session.selection, registry);
    let of = |parameters: &'static [Parameter], values: &Values, beginning: &str| -> Vec<Found> {
        let knobs = parameters.iter().filter(|p| p.kind.format().is_none());
        knobs.map(|p| parameter(p, &name, beginning, usage::unused(parameters, p, values))).collect()
    };
    match session.selection {
        Selection::Object(i) => {
            let Some(object) = session.scene().objects.get(i) else { return Vec::new() };
            let model = registry.model(session.scene().model_of(object)).map_or(&[][..], |m| m.parameters);
            let shape = registry.shape(&object.object_type).map_or(&[][..], |s| s.parameters);
            let mut all = of(model, &object.material, "");
            all.extend(of(shape, &object.shape, "shape "));
            all
        }
        Selection::Light(i) => {
            let Some(light) = session.scene().lights.get(i) else { return Vec::new() };
            let own = registry.light(&light.light_type).map_or(&[][..], |light| light.parameters);
            of(own, &light.parameters, "")
        }
        Selection::Room | Selection::Observer => Vec::new(),
    }
}

fn parameter(p: &Parameter, of: &str, beginning: &str, unused: Option<String>) -> Found {
    let knob = format!("{beginning}{}", p.name);
    let name = if p.symbol.is_empty() { p.name } else { p.symbol };
    Found {
        id: format!("knob {of} {knob}"),
        title: capitalised(p.label),
        order: 2,
        heading: "Parameters",
        off: unused.is_some(),
        note: unused.unwrap_or_else(|| format!("Parameter of {of}")),
        said: vec![(format!("parameter {of}"), format!("Parameter of {of}"))],
        unsaid: vec![(format!("{} {}", p.name, p.symbol), name.to_owned())],
        key: String::new(),
        on: false,
        tip: p.help.to_owned(),
        does: Does::Seek(knob),
    }
}
