//! The panel *Materials*: the library of materials as small pictures, found by a search, given to objects by a click or by
//! dragging.

use std::{path::PathBuf, sync::Mutex, time::Duration};

use bevy_egui::egui::{LayerId, Order, TextEdit};
use web_time::Instant;

use super::{
    cover::takes_drops,
    draft::is_new,
    kept::Answers,
    marks::Lens,
    narrow,
    prelude::*,
    rank::{leave_out_chance, rank},
    state::MaterialCommand,
};
use crate::{
    caught::lock,
    library::status::Reloaded,
    materials::{Library, Material, Origin, beside},
    reference::{meshes::MeshStore, probe::towards},
};
use broken::is_named;
use shelf::Picture;

mod broken;
mod draft_window;
mod shelf;

pub(super) use draft_window::{DRAFT, TITLE, show as ask};

/// Size of a picture, in points.
const PICTURE: f32 = 76.0;
/// Most lines of a name below its picture.
const NAME_LINES: usize = 2;
/// Width of the search field, in points.
const SEARCH: f32 = 200.0;
/// Height below which the panel scrolls as a whole, with its head: otherwise no row of pictures has room.
const LOW: f32 = 160.0;

/// What the list depends on.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    saved: u64,
    /// Number of times that the panel came into sight, or the window back from another program, which may have changed files.
    opened: u64,
    models: usize,
    reloaded: Option<Reloaded>,
}

/// The places of what a search finds.
struct Found {
    materials: Vec<usize>,
    broken: Vec<usize>,
}

/// See the module.
#[derive(Default)]
pub(super) struct MaterialPanel {
    library: Mutex<Answers<Question, Arc<Library>>>,
    opened: u64,
    /// The time at which it did so last.
    opened_at: Option<Instant>,
    focused: bool,
    search: String,
    /// True if the files that cannot be read are listed.
    broken_unfolded: bool,
    /// Number of materials saved so far, and the file of the latest until it is in sight.
    saved: u64,
    wanted: Option<PathBuf>,
    /// What was found last, by what was typed and in which list.
    found: Option<(String, Arc<Library>, Arc<Found>)>,
    /// The material that is being dragged.
    dragged: Option<Material>,
    /// The meshes that its way over the picture meets, until it is dropped.
    meshes: MeshStore,
}

impl MaterialPanel {
    pub(super) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let back = !std::mem::replace(&mut self.focused, ui.input(|i| i.focused)) && self.focused;
        if is_new(ui, "materials") || back {
            self.open();
        }
        self.notice_saved(context.session());
        let library = self.library(ui.ctx(), context);
        let is_low = ui.available_height() < LOW;
        if !is_low {
            self.head(ui, context);
        }
        ScrollArea::vertical().auto_shrink(false).min_scrolled_height(0.0).show(ui, |ui| {
            ui.set_max_width(ui.available_width() - 8.0);
            if is_low {
                self.head(ui, context);
            }
            match &library {
                Some(library) => self.list(ui, library, context),
                None => drop(ui.weak("Reading the materials…")),
            }
        });
        self.drag(ui, context);
    }

    /// Notes that it came into sight, or that files may have changed.
    fn open(&mut self) {
        self.opened += 1;
        self.opened_at = Some(Instant::now());
    }

    /// The files that cannot be read, and the materials that the search finds.
    fn list(&mut self, ui: &mut Ui, library: &Arc<Library>, context: &mut PanelContext<'_>) {
        let all = self.found(library, context.registry());
        let found: Vec<_> = all.materials.iter().filter_map(|i| library.materials.get(*i)).collect();
        let broken: Vec<_> = all.broken.iter().filter_map(|i| library.broken.get(*i)).collect();
        broken::broken(ui, &broken, &mut self.broken_unfolded);
        if found.is_empty() {
            ui.weak("No material has that in its name, description, source or model.");
        }
        let headed = self.search.trim().is_empty();
        for group in found.chunk_by(|a, b| !headed || a.origin.heading() == b.origin.heading()) {
            if headed && let Some(first) = group.first() {
                ui.label(theme::strong(ui, first.origin.heading()).small());
            }
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(8.0, 6.0);
                group.iter().for_each(|material| self.card(ui, material, context));
            });
        }
    }

    /// Makes sure that a material that was just saved is seen: empties the search, and scrolls to it once it is read.
    fn notice_saved(&mut self, session: &Session) {
        let saved = session.materials.saved;
        if std::mem::replace(&mut self.saved, saved) != saved {
            self.search.clear();
            self.wanted.clone_from(&session.materials.latest);
        }
    }

    /// The materials, once they are read.
    fn library(&self, ctx: &Context, context: &PanelContext<'_>) -> Option<Arc<Library>> {
        let (session, registry) = (context.session(), context.registry());
        let question = Question {
            saved: session.materials.saved,
            opened: self.opened,
            models: registry.models().len(),
            reloaded: session.shaders.last.clone(),
        };
        let mut library = lock(&self.library);
        library.ask(ctx, &question, Duration::ZERO, || {
            let (registry, folder) = (registry.clone(), registry.custom_folder().map(beside));
            Some(move || Arc::new(Library::read(folder.as_deref(), &registry)))
        });
        library.shown.as_ref().map(|(_, library)| library.clone())
    }

    /// What the search finds, sought anew for another search or another list.
    fn found(&mut self, library: &Arc<Library>, registry: &Registry) -> Arc<Found> {
        let known =
            self.found.take().filter(|(search, of, _)| *search == self.search && Arc::ptr_eq(of, library));
        let (.., found) = self.found.insert(known.unwrap_or_else(|| {
            let broken = library.broken.iter().enumerate().filter(|(_, one)| is_named(one, &self.search));
            let found = Found {
                materials: found(&library.materials, &self.search, registry),
                broken: broken.map(|(i, _)| i).collect(),
            };
            (self.search.clone(), library.clone(), Arc::new(found))
        }));
        found.clone()
    }

    /// The search, and the buttons.
    fn head(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        if narrow::is(ui.ctx()) {
            ui.horizontal_wrapped(|ui| self.search_and_buttons(ui, context));
            return;
        }
        ui.horizontal(|ui| {
            self.search_and_buttons(ui, context);
            let text = theme::small(ui, hint(context.session()));
            ui.add(Label::new(text).truncate());
        });
    }

    fn search_and_buttons(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let before = self.search.clone();
        let hint = "Search: gold, velvet, openpbr…";
        let edit = TextEdit::singleline(&mut self.search).hint_text(hint).desired_width(SEARCH);
        let edit = ui.add(edit);
        theme::names_field(&edit, "Search materials", [&before, &self.search, hint]);
        let save = ui.button("Save material…");
        let help = "Saves the material of the selected object as a small file in your folder of materials.";
        context.on_click(&save.on_hover_text(help), || Action::Material(MaterialCommand::Ask));
        let again = ui.button("Read again");
        if again.on_hover_text("Reads your folder of materials again.").clicked() {
            self.open();
        }
    }

    /// A material: its picture, its name and its model, and while its shader is being compiled, a word about that.
    fn card(&mut self, ui: &mut Ui, material: &Material, context: &mut PanelContext<'_>) {
        let palette = Palette::here(ui);
        let words = 4.0 + (NAME_LINES + 1) as f32 * ui.text_style_height(&TextStyle::Small);
        let size = vec2(PICTURE, PICTURE + words);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        theme::says(&response, WidgetType::Button, format!("Material: {}", material.name));
        let is_wanted = matches!(&material.origin, Origin::File(path) if self.wanted.as_ref() == Some(path));
        if is_wanted || response.gained_focus() {
            response.scroll_to_me(None);
        }
        if is_wanted {
            self.wanted = None;
        }
        if response.drag_started() {
            self.dragged = Some(material.clone());
        }
        let give = || Action::Material(MaterialCommand::Apply(Box::new(material.clone()), None));
        context.on_click(&response, give);
        if !ui.is_rect_visible(rect) {
            return;
        }
        let (session, registry) = (context.session(), context.registry());
        let place = Rect::from_min_size(rect.min, Vec2::splat(PICTURE));
        let picture = shelf::picture(ui.ctx(), material, self.opened_at, session, registry);
        shelf::paint(ui, place, &picture);
        let hot = theme::is_hot(&response);
        let edge = Stroke::new(if hot { 2.0 } else { 1.0 }, if hot { palette.accent } else { palette.line });
        ui.painter().rect_stroke(place, 2.0, edge, StrokeKind::Inside);
        let model = model_name(material, registry);
        if session.is_compiling(material) {
            shelf::compiling(ui, place);
        }
        caption(ui, place.left_bottom() + vec2(0.0, 2.0), &material.name, model);
        theme::tip(response, 320.0, |ui| {
            ui.label(theme::strong(ui, &material.name));
            ui.label(model);
            for text in [&material.description, &material.source].into_iter().flatten() {
                ui.label(theme::small(ui, text));
            }
            if let Origin::File(path) = &material.origin {
                ui.label(theme::small(ui, path.shown().to_string()));
            }
            if let Picture::Failed(why) = &picture {
                ui.label(theme::small(ui, &**why));
            }
        });
    }

    /// Paints the material that is dragged at the pointer with the name of the object there, and gives it to the object on
    /// which it is dropped.
    fn drag(&mut self, ui: &Ui, context: &mut PanelContext<'_>) {
        let Some(material) = self.dragged.take() else {
            self.meshes = MeshStore::default();
            return;
        };
        let ctx = ui.ctx();
        let (at, down, stop) =
            ui.input(|i| (i.pointer.latest_pos(), i.pointer.primary_down(), i.key_pressed(Key::Escape)));
        let Some(at) = at.filter(|_| !stop) else { return };
        let over = takes_drops(ctx, context.area().frame, at).then(|| self.object_at(context, at));
        if down {
            ctx.set_cursor_icon(CursorIcon::Grabbing);
            let picture =
                shelf::picture(ctx, &material, self.opened_at, context.session(), context.registry());
            carried(ui, at, &picture, over.map(|object| words(&material, at, object, context)));
            self.dragged = Some(material);
            return;
        }
        let Some(object) = over else { return };
        let Some(object) = object else {
            return context.say("There is no object: drop the material onto one.");
        };
        let cell = context.area().cell_at(at).copied();
        if let Some(cell) = cell.filter(|cell| cell.view != context.session().active()) {
            context.act(Action::Compare(CompareCommand::Activate(cell.view)));
        }
        context.act(Action::Material(MaterialCommand::Apply(Box::new(material), Some(object))));
    }

    /// The object that one sees at a place of the picture.
    fn object_at(&mut self, context: &PanelContext<'_>, at: Pos2) -> Option<usize> {
        let (session, registry) = (context.session(), context.registry());
        let cell = context.area().cell_at(at);
        let ray = Lens::of(session, cell.map_or(context.area().frame, |cell| cell.rect)).ray(at);
        towards(&mut self.meshes, session.scene(), registry, [ray.eye, ray.eye + ray.way]).map(|(i, _)| i)
    }
}

/// What a click and a drag do in the active view.
fn hint(session: &Session) -> String {
    match (session.active(), session.document.variants.len()) {
        (0, 0) => "click: for what is selected · drag: onto an object".to_owned(),
        (0, _) => "click: for what is selected · drag: onto an object of view A".to_owned(),
        _ => format!("click, or drag into view {}: for all its objects", session.letter()),
    }
}

/// The name of a material, whole if it fits into its lines, and its model below.
fn caption(ui: &Ui, at: Pos2, name: &str, model: &str) {
    let palette = Palette::here(ui);
    let name = theme::lines(ui, name, TextStyle::Small, palette.text, (PICTURE, NAME_LINES));
    let model = theme::elided(ui, model, TextStyle::Small, palette.weak, PICTURE);
    let below = at + vec2(0.0, name.size().y);
    ui.painter().galley(at, name, palette.text);
    ui.painter().galley(below, model, palette.weak);
}

/// A material and what gets it when it is dropped here.
fn words(material: &Material, at: Pos2, object: Option<usize>, context: &PanelContext<'_>) -> String {
    let (session, registry) = (context.session(), context.registry());
    let view = context.area().cell_at(at).map_or(session.active(), |cell| cell.view);
    match (object, LETTERS.get(view)) {
        (None, _) => "No object here".to_owned(),
        (_, Some(letter)) if view > 0 => format!("{} for all objects of view {letter}", material.name),
        (Some(i), _) => {
            format!("{} for {}", material.name, session.name_of(Selection::Object(i), registry))
        }
    }
}

/// Paints a picture at the pointer, over everything, and words beside it.
fn carried(ui: &Ui, at: Pos2, picture: &Picture, words: Option<String>) {
    let painter = ui.ctx().layer_painter(LayerId::new(Order::Tooltip, Id::new("dragged material")));
    let place = Rect::from_center_size(at, Vec2::splat(0.5 * PICTURE));
    if let Picture::Ready(texture) = picture {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(texture.id(), place, whole, Color32::WHITE);
    }
    if let Some(words) = words {
        theme::beside(ui, &painter, place.right_center(), words);
    }
}

fn model_name<'a>(material: &'a Material, registry: &'a Registry) -> &'a str {
    let id = &material.reflection_model;
    registry.model(id).map_or(id, |model| model.declaration.name)
}

/// The places of the materials that a search finds, the best first; without a search all in their order.
fn found(all: &[Material], search: &str, registry: &Registry) -> Vec<usize> {
    if search.trim().is_empty() {
        return (0..all.len()).collect();
    }
    let more = |m: &Material| {
        let texts = [m.description.as_deref(), m.source.as_deref(), Some(&m.reflection_model)];
        let texts: Vec<_> = texts.into_iter().flatten().chain([model_name(m, registry)]).collect();
        texts.join(" ")
    };
    let fits = |(i, m): (usize, &Material)| Some((rank(&m.name, &[], &more(m), search)?, i));
    let mut found: Vec<_> = all.iter().enumerate().filter_map(fits).collect();
    leave_out_chance(&mut found);
    found.sort_by_key(|(rank, _)| -rank);
    found.into_iter().map(|(_, i)| i).collect()
}
