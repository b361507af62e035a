//! The file dialogs.

use std::{
    ops::{Deref, DerefMut},
    path::{Path, PathBuf},
};

use bevy_egui::egui::{
    self, Align2, Color32, Context, Event, Id, Key, Label, LayerId, Modifiers, Order, Rect, Sense, Shape,
    Stroke, TextStyle, Ui, containers::panel::PanelState, pos2, vec2,
};
use egui_file_dialog::{DialogMode, DialogState, FileDialog, FileDialogLabels};

use super::{
    preview::{self, Preview, Source},
    state::{
        Action, Effect, ExportCommand, LessonCommand, LessonSource, ModelCommand, PictureCommand,
        PlotCommand, Session,
    },
    theme::{self, Palette},
};
use crate::{
    document::Selection,
    export::form,
    parameter::{FileFormat, Parameter, ParameterKind},
    registry::Registry,
    scene::{
        formats::{self, SceneFormat},
        save::as_json,
    },
};

mod aids;

/// Size of a dialog as a fraction of the window.
const SHARE: f32 = 0.7;
/// Size of a dialog as a fraction of a narrow window, which has no room to spare.
const ALL: f32 = 0.96;
/// Width below which a window is narrow, in points; also reached by a large interface scale.
const NARROW: f32 = 1000.0;
/// Number of frames after which an empty list is taken to be final.
const BLANK_FRAMES: u8 = 3;

/// The file dialogs of the window, with their state.
#[derive(Debug)]
pub struct Dialogs {
    open: FileDialog,
    save: FileDialog,
    folder: FileDialog,
    /// Selects files for parameters of lights and objects.
    file: FileDialog,
    /// Selects a lesson.
    lesson: FileDialog,
    /// Selects the destination of an export.
    export: FileDialog,
    /// The export for which a destination is being selected.
    exporting: Option<Exported>,
    /// The part and the parameter for which a file is being selected.
    wanted: Option<(Selection, &'static Parameter)>,
    /// The dialog field that had the focus at the end of the previous frame.
    typed_into: Option<Field>,
    /// A key to repeat in the next frame.
    again: Option<Key>,
    /// Number of frames for which the list has been empty.
    blank: u8,
}

/// The subject of an export: a file in a format (by its id), the picture of one view or of all, or the plot.
#[derive(Clone, Copy, Debug)]
enum Exported {
    Form(&'static str),
    Picture(Option<usize>),
    Plot,
}

impl Exported {
    /// The subject of the export for which an effect requests a destination.
    fn of(effect: &Effect) -> Option<Self> {
        match effect {
            Effect::PickExport(id) => Some(Self::Form(id)),
            Effect::PickPicture(view) => Some(Self::Picture(*view)),
            Effect::PickPlot => Some(Self::Plot),
            _ => None,
        }
    }
}

/// Dialog fields that pass keys on to the dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Field {
    Search,
    Name,
}

impl Default for Dialogs {
    fn default() -> Self {
        let own = FileDialogLabels { open_button: "Export here".to_owned(), ..FileDialogLabels::default() };
        let lessons = "Lessons (*.md)";
        Self {
            open: picker("Open a scene", "open dialog").default_file_name("scene.json"),
            save: dialog("Save the scene as", "save dialog", labels()).default_file_name("scene.json"),
            folder: dialog("Export the shaders to which folder?", "folder dialog", own),
            file: FileDialog::new(),
            lesson: picker("Open a lesson", "lesson dialog")
                .add_file_filter_extensions(lessons, vec!["md"])
                .default_file_filter(lessons),
            export: FileDialog::new(),
            exporting: None,
            wanted: None,
            typed_into: None,
            again: None,
            blank: 0,
        }
    }
}

/// Labels with a short caption below the list, which leaves room for the file name.
fn labels() -> FileDialogLabels {
    FileDialogLabels { selected_file: "File:".to_owned(), ..FileDialogLabels::default() }
}

/// A dialog in the middle of the window.
fn dialog(title: &str, id: &'static str, labels: FileDialogLabels) -> FileDialog {
    FileDialog::new().title(title).id(id).labels(labels).anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
}

/// A dialog that selects a file to read: a new folder never contains one.
fn picker(title: &str, id: &'static str) -> FileDialog {
    let mut dialog = dialog(title, id, labels());
    dialog.config_mut().show_new_folder_button = false;
    dialog.config_mut().keybindings.new_folder.clear();
    dialog
}

/// Makes a dialog offer the formats of scenes, starting with that of `file`, which may not exist yet.
fn offer(dialog: &mut FileDialog, file: &Path, registry: &Registry) {
    let extensions = formats::extensions(registry);
    let all: Vec<_> = extensions.iter().map(|extension| format!("*.{extension}")).collect();
    let filter = format!("Scenes ({})", all.join(", "));
    let place = dialog.config_mut();
    place.file_filters.clear();
    place.save_extensions.clear();
    let mut config = std::mem::take(place).add_file_filter_extensions(&filter, extensions);
    // The dialog shows the extension itself, and appends it to what is typed.
    let name = |format: &dyn SceneFormat| match format.name() {
        "JSON" => "Scene".to_owned(),
        other => format!("Scene as {other}"),
    };
    for format in formats::all(registry).filter(|format| format.writer().is_some()) {
        for extension in format.extensions().iter().take(1) {
            config = config.add_save_extension(&name(format), extension);
        }
    }
    config.default_file_filter = Some(filter);
    config.default_save_extension = formats::of_path(file, registry).ok().map(name);
    *place = config;
}

/// The dialog that selects a file for a parameter.
fn file_dialog(format: &FileFormat) -> FileDialog {
    let extensions: Vec<_> = format.extensions.iter().map(|extension| format!("*.{extension}")).collect();
    let filter = format!("Files ({})", extensions.join(", "));
    picker(&format!("Choose {}", format.name), "file dialog")
        .add_file_filter_extensions(&filter, format.extensions.to_vec())
        .default_file_filter(&filter)
}

/// The dialog that selects the destination of an export, a picture or a plot.
fn export_dialog(what: Exported, session: &Session, folder: Option<&Path>) -> FileDialog {
    let (title, button, name) = match what {
        Exported::Form(id) => {
            let form = form(id);
            let stem = session.stem();
            let name = form
                .and_then(|form| Some(form.default_path(&stem).file_name()?.to_string_lossy().into_owned()));
            let title = form.map_or_else(String::new, |form| format!("Export as {}", form.name));
            (title, "Export", name.unwrap_or(stem))
        }
        Exported::Picture(view) => {
            ("Save the picture".to_owned(), "Save", format!("{}.png", session.picture_stem(view)))
        }
        Exported::Plot => ("Export the plot".to_owned(), "Export", super::plots::file_name(session)),
    };
    let (save_button, file_name) = (button.to_owned(), "Name:".to_owned());
    let labels = FileDialogLabels { save_button, file_name, ..FileDialogLabels::default() };
    let mut dialog = dialog(&title, "export dialog", labels).default_file_name(&name);
    if matches!(what, Exported::Plot) {
        super::plots::offer(&mut dialog);
    }
    if let Some(folder) = folder {
        dialog.config_mut().initial_directory = folder.to_owned();
    }
    dialog
}

impl Dialogs {
    /// True if any dialog is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        [&self.open, &self.save, &self.folder, &self.file, &self.lesson, &self.export]
            .into_iter()
            .any(|d| *d.state() == DialogState::Open)
    }

    /// Opens the dialog that an effect requests. Returns false if the effect requests none.
    pub(super) fn start(
        &mut self,
        ctx: &Context,
        effect: &Effect,
        session: &Session,
        registry: &Registry,
    ) -> bool {
        let folder = session.path.as_ref().and_then(|p| p.parent()).filter(|p| p.is_dir());
        if let Some(what) = Exported::of(effect) {
            self.exporting = Some(what);
            self.export = export_dialog(what, session, folder);
            self.export.save_file();
            return true;
        }
        let (dialog, save) = match effect {
            Effect::PickOpen => {
                preview::forget_files(ctx);
                (&mut self.open, false)
            }
            Effect::PickSave => (&mut self.save, true),
            Effect::PickFile(part, parameter) => {
                self.wanted = Some((*part, *parameter));
                if let ParameterKind::File { format, .. } = parameter.kind {
                    self.file = file_dialog(format);
                }
                (&mut self.file, false)
            }
            Effect::PickLesson => {
                if let Some(folder) = session.lesson_folder().or(folder).filter(|folder| folder.is_dir()) {
                    self.lesson.config_mut().initial_directory = folder.to_owned();
                }
                self.lesson.pick_file();
                return true;
            }
            Effect::PickShaderFolder => {
                self.folder.pick_directory();
                return true;
            }
            _ => return false,
        };
        if let Some(folder) = folder {
            dialog.config_mut().initial_directory = folder.to_owned();
        }
        // JSON replaces a read-only format.
        let file = match session.path.as_deref() {
            Some(path) if formats::can_write(path, registry) => path.to_owned(),
            Some(path) => as_json(path),
            None => PathBuf::from(format!("{}.json", session.stem())),
        };
        if !matches!(effect, Effect::PickFile(..)) {
            offer(dialog, &file, registry);
        }
        if save {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            dialog.config_mut().default_file_name = name;
            dialog.save_file();
        } else {
            dialog.pick_file();
        }
        true
    }

    /// Shows the open dialogs. Returns the resulting actions.
    pub(super) fn update(
        &mut self,
        ctx: &Context,
        session: &mut impl DerefMut<Target = Session>,
        registry: &Registry,
    ) -> Vec<Action> {
        let mut actions = Vec::new();
        if !self.is_open() {
            (self.typed_into, self.again, self.blank) = (None, None, 0);
            return actions;
        }
        self.pass_keys_on(ctx);
        let plain = ctx.global_style();
        let palette = Palette::of(&session.view);
        ctx.global_style_mut(|style| {
            let selection = &mut style.visuals.selection;
            (selection.bg_fill, selection.stroke) = (palette.accent, Stroke::new(1.0, palette.panel));
        });
        self.arrange(ctx);
        self.show_scenes(ctx, session, registry, &mut actions);
        self.show_others(ctx, session, &mut actions);
        self.finish(ctx, &palette);
        ctx.set_global_style(plain);
        actions.extend(self.folder.take_picked().map(|folder| Action::Model(ModelCommand::Export(folder))));
        actions
    }

    fn all(&mut self) -> [&mut FileDialog; 6] {
        let Self { open, save, folder, file, lesson, export, .. } = self;
        [open, save, folder, file, lesson, export]
    }

    /// Fits the dialogs to the window.
    fn arrange(&mut self, ctx: &Context) {
        let screen = ctx.content_rect().size();
        let narrow = screen.x < NARROW;
        let size = if narrow { ALL } else { SHARE } * screen;
        for dialog in self.all() {
            let config = dialog.config_mut();
            (config.default_size, config.min_size, config.max_size) = (size, size, Some(size));
            // Leaves enough width for the buttons below the list.
            config.right_panel_width = Some(if narrow { 0.28 } else { 0.34 } * size.x);
            // The confirm button repeats the title.
            config.title_bar = !narrow;
        }
    }

    /// Shows the dialogs that open and save scenes.
    fn show_scenes(
        &mut self,
        ctx: &Context,
        session: &mut impl DerefMut<Target = Session>,
        registry: &Registry,
        actions: &mut Vec<Action>,
    ) {
        let was_open = *self.open.state() == DialogState::Open;
        self.open.update_with_right_panel_ui(ctx, &mut |ui, dialog| {
            let file =
                dialog.selected_entry().filter(|entry| entry.is_file()).map(|entry| entry.to_path_buf());
            show_preview(ui, file.map(Source::File), registry);
        });
        if let Some(path) = self.open.take_picked() {
            // The user was asked about unsaved changes before the dialog opened.
            actions.push(Action::Open(path));
        } else if was_open && *self.open.state() == DialogState::Cancelled {
            session.questions.not_opened();
        }
        let was_open = *self.save.state() == DialogState::Open;
        self.save.update(ctx);
        if let Some(path) = self.save.take_picked() {
            actions.push(Action::SaveAs(path));
        } else if was_open && *self.save.state() == DialogState::Cancelled {
            session.questions.not_saved();
        }
    }

    /// Shows the dialogs for folders, files of parameters, lessons and exports.
    fn show_others(
        &mut self,
        ctx: &Context,
        session: &impl Deref<Target = Session>,
        actions: &mut Vec<Action>,
    ) {
        self.folder.update(ctx);
        self.file.update(ctx);
        if let (Some(path), Some((part, parameter))) = (self.file.take_picked(), self.wanted) {
            actions.extend(session.file_chosen(part, parameter, &path).map(Action::Edit));
        }
        self.lesson.update(ctx);
        if let Some(path) = self.lesson.take_picked() {
            actions.push(Action::Lesson(LessonCommand::Open(LessonSource::File(path))));
        }
        self.export.update(ctx);
        if let (Some(path), Some(what)) = (self.export.take_picked(), self.exporting) {
            actions.push(match what {
                Exported::Form(form) => Action::Export(ExportCommand::To { form, path }),
                Exported::Picture(view) => Action::Picture(PictureCommand::To { view, path }),
                Exported::Plot => Action::Plot(PlotCommand::To(path)),
            });
        }
    }

    /// Adds to the dialogs, once shown, what they lack.
    fn finish(&mut self, ctx: &Context, palette: &Palette) {
        let (mut entered, mut aids) = (false, (self.typed_into, self.blank));
        for dialog in self.all() {
            let layer = LayerId::new(Order::Middle, dialog.get_window_id());
            lighten(ctx, layer, palette);
            if *dialog.state() == DialogState::Open {
                entered |= aid(ctx, layer, dialog, palette, &mut aids);
            }
        }
        (self.typed_into, self.blank) = aids;
        if entered {
            // As with the keyboard: the dialog shows the contents of the folder.
            ctx.memory_mut(|m| m.focused().into_iter().for_each(|focus| m.surrender_focus(focus)));
            self.again = Some(Key::Enter);
            ctx.request_repaint();
        }
    }
}

/// Aids of an open dialog: names of its icons, folders that open, and a word about an empty list. Updates the field
/// that has the focus and the number of frames without entries. Returns true if a folder is to be opened.
fn aid(
    ctx: &Context,
    layer: LayerId,
    dialog: &mut FileDialog,
    palette: &Palette,
    (typed_into, blank): &mut (Option<Field>, u8),
) -> bool {
    // The dialog blocks the pointer, but not the keys.
    ctx.memory_mut(|m| m.set_modal_layer(layer));
    let list = Places::of(ctx, layer.id);
    let mut entered = false;
    if let Some(places) = &list {
        aids::name_icons(ctx, layer, places.top, dialog.config_mut());
        let selected = dialog.selected_entry();
        let is_folder = selected.is_some_and(egui_file_dialog::DirectoryEntry::is_dir);
        if is_folder && dialog.mode() == DialogMode::PickFile {
            let label = dialog.config_mut().labels.open_button.clone();
            entered = aids::open_folder(ctx, layer, places.bottom, &label);
        }
    }
    *typed_into = list.as_ref().and_then(|places| places.focused(ctx));
    let is_blank = list.as_ref().is_some_and(|places| places.is_blank(ctx, layer));
    *blank = if is_blank { blank.saturating_add(1).min(BLANK_FRAMES) } else { 0 };
    match list {
        Some(places) if *blank == BLANK_FRAMES => places.say_empty(ctx, layer, palette),
        _ if is_blank => ctx.request_repaint(),
        _ => {}
    }
    entered
}

impl Dialogs {
    /// Passes keys on to the dialogs, which handle Enter and Escape only while nothing has the focus: pressed in a
    /// field, these keys would only leave it. Also keeps shortcuts out of the search, which takes every typed
    /// character.
    fn pass_keys_on(&mut self, ctx: &Context) {
        if let Some(key) = self.again.take() {
            let modifiers = Modifiers::NONE;
            let event = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
            ctx.input_mut(|input| {
                input.keys_down.insert(key);
                input.events.push(event);
            });
        } else {
            // In the name field, Enter saves.
            let passed: &[Key] = match self.typed_into {
                Some(Field::Search) if *self.save.state() != DialogState::Open => &[Key::Enter, Key::Escape],
                Some(_) => &[Key::Escape],
                None => &[],
            };
            self.again = passed.iter().copied().find(|key| ctx.input(|input| input.key_pressed(*key)));
            if self.again.is_some() {
                ctx.request_repaint();
            }
        }
        ctx.input_mut(|input| {
            let shortcut = |pair: &[Event]| {
                matches!(pair, [Event::Text(_), Event::Key { pressed: true, modifiers, .. }]
                    if modifiers.command && !modifiers.alt)
            };
            let drop: Vec<_> = input.events.windows(2).map(shortcut).chain([false]).collect();
            let mut drop = drop.into_iter();
            input.events.retain(|_| !drop.next().unwrap_or(false));
        });
    }
}

/// The areas of a dialog.
struct Places {
    top: Rect,
    bottom: Rect,
    list: Rect,
}

impl Places {
    fn of(ctx: &Context, dialog: Id) -> Option<Self> {
        let panel = |name: &str| PanelState::load(ctx, dialog.with(name)).map(|panel| panel.outer_rect);
        let whole = ctx.memory(|m| m.area_rect(dialog))?;
        let (top, bottom) = (panel("top_panel")?, panel("bottom_panel")?);
        let left = panel("left_panel").map_or(whole.left(), |left| left.right());
        let right = panel("right_panel").map_or(whole.right(), |right| right.left());
        let list = Rect::from_min_max(pos2(left, top.bottom()), pos2(right, bottom.top()));
        Some(Self { top, bottom, list })
    }

    /// The focused field. The path at the top and the name of a new folder handle their own keys.
    fn focused(&self, ctx: &Context) -> Option<Field> {
        let focus = ctx.memory(egui::Memory::focused)?;
        let rect = ctx.viewport(|v| v.this_pass.widgets.get(focus).map(|w| w.rect))?;
        // The search is the last thing at the top.
        let search = self.top.contains_rect(rect) && rect.right() > self.top.right() - 80.0;
        let name = ctx.text_edit_focused() && self.bottom.contains_rect(rect);
        search.then_some(Field::Search).or(name.then_some(Field::Name))
    }

    /// True if the list contains neither text nor a loading spinner.
    fn is_blank(&self, ctx: &Context, layer: LayerId) -> bool {
        fn has_words(shape: &Shape, place: Rect) -> bool {
            match shape {
                Shape::Vec(shapes) => shapes.iter().any(|shape| has_words(shape, place)),
                Shape::Text(_) | Shape::Path(_) => place.contains(shape.visual_bounding_rect().center()),
                _ => false,
            }
        }
        ctx.graphics(|graphics| {
            let list = graphics.get(layer);
            list.is_some_and(|list| !list.all_entries().any(|entry| has_words(&entry.shape, self.list)))
        })
    }

    fn say_empty(&self, ctx: &Context, layer: LayerId, palette: &Palette) {
        let font = TextStyle::Body.resolve(&ctx.global_style());
        let at = self.list.center_top() + vec2(0.0, 24.0);
        let text = "No file or folder matches.";
        ctx.layer_painter(layer).text(at, Align2::CENTER_TOP, text, font, palette.weak);
    }
}

/// Shows the preview beside the list.
fn show_preview(ui: &mut Ui, source: Option<Source>, registry: &Registry) {
    let width = ui.available_width();
    let (place, _) = ui.allocate_exact_size(vec2(width, width * 9.0 / 16.0), Sense::hover());
    let Some(source) = source else {
        ui.painter().rect_filled(place, 2.0, Palette::here(ui).field);
        ui.add(Label::new(theme::small(ui, "Select a scene to see what is in it.")).wrap());
        return;
    };
    let preview = preview::of(ui.ctx(), &source, registry);
    preview::paint(ui, place, &preview);
    // The full name, for which the line below the list may have no room.
    if let Source::File(path) = &source {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        ui.add(Label::new(theme::small(ui, name)).wrap_mode(egui::TextWrapMode::Wrap));
    }
    egui::ScrollArea::vertical().show(ui, |ui| match preview {
        Preview::Waiting => {}
        Preview::Failed(why) => {
            let text = egui::RichText::new(&*why).color(Palette::here(ui).error);
            ui.add(Label::new(text).wrap());
        }
        Preview::Ready(shown) => {
            if let Some(name) = &shown.name {
                ui.add(Label::new(theme::strong(ui, name)).wrap());
            }
            if let Some(description) = &shown.description {
                ui.add(Label::new(description).wrap());
            }
            ui.add(Label::new(theme::small(ui, &shown.facts)).wrap());
        }
    });
}

/// Recolours the fields of a dialog, which are black in every theme and cannot be configured.
fn lighten(ctx: &Context, layer: LayerId, palette: &Palette) {
    const BLACK: Color32 = Color32::from_black_alpha(250);
    fn visit(shape: &mut Shape, to: Color32) {
        match shape {
            Shape::Vec(shapes) => shapes.iter_mut().for_each(|shape| visit(shape, to)),
            Shape::Rect(rect) if rect.fill == BLACK => rect.fill = to,
            _ => {}
        }
    }
    ctx.graphics_mut(|graphics| {
        let Some(list) = graphics.get_mut(layer) else { return };
        for i in 0..list.next_idx().0 {
            list.mutate_shape(egui::layers::ShapeIdx(i), |clipped| visit(&mut clipped.shape, palette.field));
        }
    });
}
