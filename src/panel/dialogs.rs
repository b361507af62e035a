//! The file dialogs.

use std::{
    collections::HashMap,
    ops::DerefMut,
    path::{Path, PathBuf},
};

use bevy_egui::egui::{Event, LayerId, Margin, Modifiers, Order, containers::panel::PanelState};
use egui_file_dialog::{DialogMode, DialogState, FileDialog, FileDialogLabels, FileDialogStorage};

use super::{
    narrow,
    prelude::*,
    preview::{self, Preview, Source},
    state::{Effect, ExportCommand, LessonSource, Pick},
};
use crate::{
    export::form,
    parameter::{Outside, Parameter},
    platform::{self, fs},
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
/// Width of a column below which the name of a file and the filter have a line each, and the buttons share the next.
const SHARED_LINE: f32 = 560.0;
/// Caption of the button that closes a dialog.
const CANCEL: &str = "🚫 Cancel";
/// Number of frames after which an empty list is taken to be final.
const BLANK_FRAMES: u8 = 3;

/// The file dialogs of the window, one at a time.
#[derive(Debug, Default)]
pub struct Dialogs {
    dialog: FileDialog,
    /// Id of the dialog.
    id: &'static str,
    /// The purpose of the selection in progress.
    asked: Option<Pick>,
    /// The memory of earlier dialogs, by their ids.
    kept: HashMap<&'static str, FileDialogStorage>,
    /// The dialog field that had the focus at the end of the previous frame.
    typed_into: Option<Field>,
    /// A key to repeat in the next frame.
    again: Option<Key>,
    /// Number of frames for which the list has been empty.
    blank: u8,
}

/// Dialog fields, of which the first two pass keys on to the dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Field {
    Search,
    Name,
    /// One that handles its own keys, such as the path at the top.
    Other,
}

/// Labels with a short caption below the list, which leaves room for the file name.
fn labels() -> FileDialogLabels {
    FileDialogLabels { selected_file: "File:".to_owned(), ..FileDialogLabels::default() }
}

/// A dialog in the middle of the window.
fn dialog(title: &str, labels: FileDialogLabels) -> FileDialog {
    platform::file_dialog().title(title).labels(labels).anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
}

/// A dialog that selects a file to read: a new folder never contains one.
fn picker(title: &str) -> FileDialog {
    let mut dialog = dialog(title, labels());
    dialog.config_mut().show_new_folder_button = false;
    dialog.config_mut().keybindings.new_folder.clear();
    dialog
}

/// Makes a dialog offer the formats of scenes, starting with that of `file`, which may not exist yet.
fn offering(mut dialog: FileDialog, file: &Path, registry: &Registry) -> FileDialog {
    // There is no room for all extensions.
    let filter = "Scenes".to_owned();
    let extensions = formats::extensions(registry);
    let mut config = std::mem::take(dialog.config_mut()).add_file_filter_extensions(&filter, extensions);
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
    *dialog.config_mut() = config;
    dialog
}

/// The dialog that selects a file for a parameter.
fn file_dialog(parameter: &Parameter) -> FileDialog {
    let Some(format) = parameter.kind.format() else { return picker("") };
    let extensions: Vec<_> = format.extensions.iter().map(|extension| format!("*.{extension}")).collect();
    let filter = format!("Files ({})", extensions.join(", "));
    picker(&format!("Choose {}", format.name))
        .add_file_filter_extensions(&filter, format.extensions.to_vec())
        .default_file_filter(&filter)
}

/// The dialog that selects the destination of an export, a picture or a plot.
fn export_dialog(what: Pick, session: &Session) -> FileDialog {
    let (title, button, name) = match what {
        Pick::Picture(view) => {
            ("Save the picture".to_owned(), "Save", format!("{}.png", session.picture_stem(view)))
        }
        Pick::Sheet(_) => {
            ("Save the sheet or the film".to_owned(), "Save", format!("{}_sheet.png", session.stem()))
        }
        Pick::Export(id) => {
            let (form, stem) = (form(id), session.stem());
            let title = form.map_or_else(String::new, |form| format!("Export as {}", form.name));
            let name = form
                .and_then(|form| Some(form.default_path(&stem).file_name()?.to_string_lossy().into_owned()));
            (title, "Export", name.unwrap_or(stem))
        }
        _ => ("Export the plot".to_owned(), "Export", super::plots::file_name(session)),
    };
    let (save_button, file_name) = (button.to_owned(), "Name:".to_owned());
    let labels = FileDialogLabels { save_button, file_name, ..FileDialogLabels::default() };
    let mut dialog = dialog(&title, labels).default_file_name(&name);
    if what == Pick::Plot {
        super::plots::offer(&mut dialog);
    }
    dialog
}

/// The dialog for a selection: its id, and its mode.
fn requested(what: Pick, session: &Session, registry: &Registry) -> (&'static str, FileDialog, DialogMode) {
    // JSON replaces a read-only format.
    let file = match session.path.as_deref() {
        Some(path) if formats::can_write(path, registry) => path.to_owned(),
        Some(path) => as_json(path),
        None => PathBuf::from(format!("{}.json", session.stem())),
    };
    match what {
        Pick::Open => {
            let dialog = offering(picker("Open a scene"), &file, registry);
            ("open dialog", dialog.default_file_name("scene.json"), DialogMode::PickFile)
        }
        Pick::Save => {
            let dialog = offering(dialog("Save the scene as", labels()), &file, registry);
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            ("save dialog", dialog.default_file_name(&name), DialogMode::SaveFile)
        }
        Pick::File(.., parameter) => ("file dialog", file_dialog(parameter), DialogMode::PickFile),
        Pick::Lesson => {
            let lessons = "Lessons (*.md)";
            let dialog = picker("Open a lesson").add_file_filter_extensions(lessons, vec!["md"]);
            ("lesson dialog", dialog.default_file_filter(lessons), DialogMode::PickFile)
        }
        Pick::ShaderFolder => {
            let open_button = "Export here".to_owned();
            let labels = FileDialogLabels { open_button, ..FileDialogLabels::default() };
            let dialog = dialog("Export the shaders to which folder?", labels);
            ("folder dialog", dialog, DialogMode::PickDirectory)
        }
        Pick::Export(_) | Pick::Picture(_) | Pick::Plot | Pick::Sheet(_) => {
            ("export dialog", export_dialog(what, session), DialogMode::SaveFile)
        }
    }
}

/// The action that a dialog was opened for, with the selected file.
fn action(what: Pick, path: PathBuf, session: &Session, registry: &Registry) -> Option<Action> {
    Some(match what {
        // The user was asked about unsaved changes before the dialog opened.
        Pick::Open => Action::Open(path),
        Pick::Save => Action::SaveAs(path),
        Pick::File(part, key, parameter) => {
            return session.file_chosen(part, key, parameter, &path, registry).map(Action::Edit);
        }
        Pick::Lesson => Action::Lesson(LessonCommand::Open(LessonSource::File(path))),
        Pick::ShaderFolder => Action::Do(Effect::ExportShaders(path)),
        Pick::Export(form) => Action::Export(ExportCommand::To { form, path }),
        Pick::Picture(view) => {
            // The dialog asked about the name as typed, but not about the name with an extension.
            let overwrite = path.extension().is_some();
            Action::Do(Effect::Picture { view, file: Some(path), overwrite })
        }
        Pick::Plot => Action::Do(Effect::WritePlot(path)),
        Pick::Sheet(subject) => Action::Do(Effect::WriteSheet { subject, path }),
    })
}

impl Dialogs {
    /// True if a dialog is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        *self.dialog.state() == DialogState::Open
    }

    /// Opens the dialog that an effect requests. Returns false if the effect requests none.
    pub(super) fn start(
        &mut self,
        ctx: &Context,
        effect: &Effect,
        session: &Session,
        registry: &Registry,
    ) -> bool {
        let Effect::Pick(what) = *effect else { return false };
        let (id, dialog, mode) = requested(what, session, registry);
        if what == Pick::Open {
            preview::forget_files(ctx);
        }
        // Dialogs that depend on what is exported or chosen begin anew.
        let remembers = !matches!(id, "file dialog" | "export dialog");
        self.kept.insert(self.id, std::mem::take(self.dialog.storage_mut()));
        let storage = self.kept.remove(id).filter(|_| remembers).unwrap_or_default();
        (self.id, self.dialog) = (id, dialog.id(id).storage(storage));
        let folder = session.path.as_ref().and_then(|p| p.parent());
        let folder = match what {
            Pick::ShaderFolder => None,
            Pick::Lesson => session.lesson_folder().or(folder.filter(|folder| fs::is_dir(folder))),
            _ => folder,
        };
        if let Some(folder) = folder.filter(|folder| fs::is_dir(folder)) {
            self.dialog.config_mut().initial_directory = folder.to_owned();
        }
        let is_result = matches!(what, Pick::Export(_) | Pick::Picture(_) | Pick::Plot | Pick::Sheet(_));
        if let Some(folder) = platform::results_folder().filter(|_| is_result) {
            self.dialog.config_mut().initial_directory = folder;
        }
        match mode {
            DialogMode::SaveFile => self.dialog.save_file(),
            DialogMode::PickDirectory => self.dialog.pick_directory(),
            _ => self.dialog.pick_file(),
        }
        self.asked = Some(what);
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
        let (palette, narrow) = (Palette::of(&session.settings), is_narrow(ctx));
        ctx.global_style_mut(|style| {
            let selection = &mut style.visuals.selection;
            (selection.bg_fill, selection.stroke) = (palette.accent, Stroke::new(1.0, palette.panel));
            // The buttons would seem to touch the edge of their panel.
            style.visuals.panel_fill = style.visuals.window_fill;
            if narrow {
                let spacing = &mut style.spacing;
                spacing.window_margin = Margin::same(theme::UNIT as i8);
                (spacing.interact_size.y, spacing.item_spacing.y) = (2.5 * theme::UNIT, 0.25 * theme::UNIT);
            }
        });
        self.arrange(ctx);
        if self.asked == Some(Pick::Open) && !narrow::is(ctx) {
            self.dialog.update_with_right_panel_ui(ctx, &mut |ui, dialog| {
                let file = dialog.selected_entry().filter(|entry| entry.is_file());
                let file = file.map(|entry| Source::File(entry.to_path_buf()));
                show_preview(ui, file, registry, &session.outside);
            });
        } else {
            self.dialog.update(ctx);
        }
        self.finish(ctx, &palette);
        ctx.set_global_style(plain);
        if let (Some(path), Some(what)) = (self.dialog.take_picked(), self.asked) {
            actions.extend(action(what, path, session, registry));
        } else if *self.dialog.state() == DialogState::Cancelled {
            match self.asked {
                Some(Pick::Open) => session.questions.not_opened(),
                Some(Pick::Save) => session.questions.not_saved(),
                _ => {}
            }
        }
        actions
    }

    /// Fits the dialog to the window.
    fn arrange(&mut self, ctx: &Context) {
        let screen = ctx.content_rect().size();
        let narrow = is_narrow(ctx);
        let size = if narrow { ALL } else { SHARE } * screen;
        let id = self.dialog.get_window_id();
        let config = self.dialog.config_mut();
        config.show_left_panel = !narrow::is(ctx);
        (config.default_size, config.min_size, config.max_size) = (size, size, Some(size));
        // Leaves enough width for the buttons below the list.
        config.right_panel_width = Some(if narrow { 0.28 } else { 0.34 } * size.x);
        config.labels.cancel_button = cancel(ctx, id);
        let known = ctx.data(|data| data.get_temp::<Vec2>(id));
        if known != Some(size) {
            // The widths of another size would leave no room for the list and the buttons.
            ctx.data_mut(|data| {
                data.insert_temp(id, size);
                for name in ["left_panel", "right_panel"] {
                    data.remove::<PanelState>(id.with(name));
                }
            });
            ctx.request_repaint();
        }
    }

    /// Adds to the dialog, once shown, what it lacks.
    fn finish(&mut self, ctx: &Context, palette: &Palette) {
        let layer = LayerId::new(Order::Middle, self.dialog.get_window_id());
        lighten(ctx, layer, palette);
        if self.is_open() && self.aid(ctx, layer, palette) {
            // As with the keyboard: the dialog shows the contents of the folder.
            ctx.memory_mut(|m| m.focused().into_iter().for_each(|focus| m.surrender_focus(focus)));
            self.again = Some(Key::Enter);
            ctx.request_repaint();
        }
    }

    /// Aids of an open dialog: names of its icons, the whole name of the selected file, folders that open, and a word about
    /// an empty list. Updates the field that has the focus and the number of frames without entries. Returns true if a
    /// folder is to be opened.
    fn aid(&mut self, ctx: &Context, layer: LayerId, palette: &Palette) -> bool {
        // The dialog blocks the pointer, but not the keys.
        ctx.memory_mut(|m| m.set_modal_layer(layer));
        let (dialog, list) = (&mut self.dialog, Places::of(ctx, layer.id));
        let mut entered = false;
        if let Some(places) = &list {
            let file = dialog.selected_entry().map(|entry| entry.file_name().to_owned());
            let parts = (places.top, places.bottom);
            aids::name_parts(ctx, layer, parts, (&*dialog.config_mut(), file.as_deref()));
            if let Some(name) = &file {
                aids::shorten_name(ctx, layer, places.bottom, name);
            }
            // The dialog keeps a folder selected after it has shown what is in it.
            let shown = dialog.storage_mut().last_visited_dir.clone();
            let selected =
                dialog.selected_entry().filter(|entry| entry.as_path().parent() == shown.as_deref());
            let is_folder = selected.is_some_and(egui_file_dialog::DirectoryEntry::is_dir);
            if is_folder && dialog.mode() == DialogMode::PickFile {
                let label = dialog.config_mut().labels.open_button.clone();
                entered = aids::open_folder(ctx, layer, places.bottom, &label);
            }
        }
        self.typed_into = list.as_ref().and_then(|places| places.focused(ctx));
        let is_blank = list.as_ref().is_some_and(|places| places.is_blank(ctx, layer));
        self.blank = if is_blank { self.blank.saturating_add(1).min(BLANK_FRAMES) } else { 0 };
        match list {
            Some(places) if self.blank == BLANK_FRAMES => places.say_empty(ctx, layer, palette),
            _ if is_blank => ctx.request_repaint(),
            _ => {}
        }
        entered
    }

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
            let picks = self.dialog.mode() == DialogMode::PickFile;
            // In the name field, Enter saves.
            let passed: &[Key] = match self.typed_into {
                Some(Field::Search) if self.asked != Some(Pick::Save) => &[Key::Enter, Key::Escape],
                Some(Field::Search | Field::Name) => &[Key::Escape],
                // A button that has the focus would only lose it. Dialogs that save ask questions, which take the key.
                None if picks && !egui::Popup::is_any_open(ctx) => &[Key::Escape],
                None | Some(Field::Other) => &[],
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

fn is_narrow(ctx: &Context) -> bool {
    ctx.content_rect().width() < NARROW
}

/// The caption of the button that closes a dialog, padded in a narrow column: the dialog makes its other button as wide,
/// and the filter as wide as both, which leaves the line above to the name of the file.
fn cancel(ctx: &Context, dialog: Id) -> String {
    let column = Places::of(ctx, dialog).map(|places| places.list.width());
    let Some(column) = column.filter(|width| *width < SHARED_LINE) else { return CANCEL.to_owned() };
    let style = ctx.global_style();
    let (spacing, font) = (&style.spacing, TextStyle::Body.resolve(&style));
    // The margins of the panel and of the window beside it, and two buttons with the padding that the dialog adds.
    let line = column - 2.0 * theme::UNIT - spacing.window_margin.leftf() - spacing.item_spacing.y;
    let wanted = 0.5 * line - 4.0 * spacing.button_padding.x;
    let [own, space] = ctx.fonts_mut(|fonts| {
        let mut width = |c: char| fonts.glyph_width(&font, c);
        [CANCEL.chars().map(&mut width).sum::<f32>(), width(' ')]
    });
    let pad = " ".repeat((0.5 * (wanted - own) / space.max(1.0)).max(0.0) as usize);
    format!("{pad}{CANCEL}{pad}")
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

    /// The focused field.
    fn focused(&self, ctx: &Context) -> Option<Field> {
        let focus = ctx.memory(egui::Memory::focused)?;
        let rect = ctx.viewport(|v| v.this_pass.widgets.get(focus).map(|w| w.rect))?;
        // The search is the last thing at the top.
        let search = self.top.contains_rect(rect) && rect.right() > self.top.right() - 80.0;
        let text = ctx.text_edit_focused();
        let name = text && self.bottom.contains_rect(rect);
        search.then_some(Field::Search).or(name.then_some(Field::Name)).or(text.then_some(Field::Other))
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
fn show_preview(ui: &mut Ui, source: Option<Source>, registry: &Registry, outside: &Outside) {
    let width = ui.available_width();
    let (place, _) = ui.allocate_exact_size(vec2(width, width * 9.0 / 16.0), Sense::hover());
    let Some(source) = source else {
        ui.painter().rect_filled(place, 2.0, Palette::here(ui).field);
        theme::note(ui, "Select a scene to see what is in it.");
        return;
    };
    let preview = preview::of(ui.ctx(), &source, registry, outside);
    preview::paint(ui, place, &preview);
    // The full name, for which the line below the list may have no room.
    if let Source::File(path) = &source {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        ui.add(Label::new(theme::small(ui, name)).wrap_mode(egui::TextWrapMode::Wrap));
    }
    ScrollArea::vertical().show(ui, |ui| match preview {
        Preview::Waiting => {}
        Preview::Failed(why) => {
            ui.add(Label::new(RichText::new(&*why).color(Palette::here(ui).error)).wrap());
        }
        Preview::Ready(shown) => {
            if let Some(name) = &shown.name {
                ui.add(Label::new(theme::strong(ui, name)).wrap());
            }
            if let Some(description) = &shown.description {
                ui.add(Label::new(description).wrap());
            }
            theme::note(ui, &shown.facts);
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
