//! The dialogs that choose files.

use std::ops::DerefMut;

use bevy_egui::egui::{self, Color32, Context, Label, LayerId, Order, Sense, Shape, Stroke, Ui, vec2};
use egui_file_dialog::{DialogState, FileDialog, FileDialogLabels};

use super::{
    author::ModelCommand,
    preview::{self, Preview, Source},
    state::{Action, Effect, Session},
    theme::{self, Palette},
};
use crate::registry::Registry;

/// Their share of the window.
const SHARE: f32 = 0.7;
/// The same in a window that is narrow, which has no room to spare.
const ALL: f32 = 0.96;
/// Width of a narrow window, points.
const NARROW: f32 = 800.0;

/// See the module.
#[derive(Debug)]
pub struct Dialogs {
    open: FileDialog,
    save: FileDialog,
    folder: FileDialog,
}

impl Default for Dialogs {
    fn default() -> Self {
        let dialog = |title: &str, id: &'static str| {
            FileDialog::new()
                .title(title)
                .id(id)
                .add_file_filter_extensions("Scenes (*.json)", vec!["json"])
                .default_file_filter("Scenes (*.json)")
                .add_save_extension("Scene (*.json)", "json")
                .default_save_extension("Scene (*.json)")
                .anchor(egui::Align2::CENTER_CENTER, vec2(0.0, 0.0))
                .default_file_name("scene.json")
        };
        let folder = FileDialog::new()
            .title("Export the shaders to which folder?")
            .id("folder dialog")
            .labels(FileDialogLabels { open_button: "Export here".to_owned(), ..FileDialogLabels::default() })
            .anchor(egui::Align2::CENTER_CENTER, vec2(0.0, 0.0));
        Self {
            open: dialog("Open a scene", "open dialog"),
            save: dialog("Save the scene as", "save dialog"),
            folder,
        }
    }
}

impl Dialogs {
    /// True if one is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        [&self.open, &self.save, &self.folder].into_iter().any(|d| *d.state() == DialogState::Open)
    }

    /// Opens the dialog that is asked for; false if it is none.
    pub(super) fn start(&mut self, ctx: &Context, effect: &Effect, session: &Session) -> bool {
        let folder = session.path.as_ref().and_then(|p| p.parent()).filter(|p| p.is_dir());
        let (dialog, save) = match effect {
            Effect::PickOpen => {
                preview::forget_files(ctx);
                (&mut self.open, false)
            }
            Effect::PickSave => (&mut self.save, true),
            Effect::PickShaderFolder => {
                self.folder.pick_directory();
                return true;
            }
            _ => return false,
        };
        if let Some(folder) = folder {
            dialog.config_mut().initial_directory = folder.to_owned();
        }
        if save {
            let name =
                session.path.as_ref().and_then(|p| p.file_name()).map(|n| n.to_string_lossy().into_owned());
            dialog.config_mut().default_file_name =
                name.unwrap_or_else(|| format!("{}.json", file_name(&session.title())));
            dialog.save_file();
        } else {
            dialog.pick_file();
        }
        true
    }

    /// Shows those that are open. Returns what was chosen.
    pub(super) fn update(
        &mut self,
        ctx: &Context,
        session: &mut impl DerefMut<Target = Session>,
        registry: &Registry,
    ) -> Vec<Action> {
        let mut actions = Vec::new();
        if !self.is_open() {
            return actions;
        }
        let plain = ctx.global_style();
        let palette = Palette::of(&session.view);
        ctx.global_style_mut(|style| {
            let selection = &mut style.visuals.selection;
            (selection.bg_fill, selection.stroke) = (palette.accent, Stroke::new(1.0, palette.panel));
        });
        let screen = ctx.content_rect().size();
        let size = if screen.x < NARROW { ALL } else { SHARE } * screen;
        for dialog in [&mut self.open, &mut self.save, &mut self.folder] {
            let config = dialog.config_mut();
            (config.default_size, config.min_size, config.max_size) = (size, size, Some(size));
            config.right_panel_width = Some(0.34 * size.x);
        }
        let was_open = *self.open.state() == DialogState::Open;
        self.open.update_with_right_panel_ui(ctx, &mut |ui, dialog| {
            let file =
                dialog.selected_entry().filter(|entry| entry.is_file()).map(|entry| entry.to_path_buf());
            look(ui, file.map(Source::File), registry);
        });
        if let Some(path) = self.open.take_picked() {
            // Whoever got this far was asked about unsaved changes before.
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
        self.folder.update(ctx);
        for dialog in [&self.open, &self.save, &self.folder] {
            let layer = LayerId::new(Order::Middle, dialog.get_window_id());
            lighten(ctx, layer, &palette);
            // It keeps the pointer to itself, but not the keys.
            if *dialog.state() == DialogState::Open {
                ctx.memory_mut(|m| m.set_modal_layer(layer));
            }
        }
        ctx.set_global_style(plain);
        actions.extend(self.folder.take_picked().map(|folder| Action::Model(ModelCommand::Export(folder))));
        actions
    }
}

/// The preview beside the list.
fn look(ui: &mut Ui, source: Option<Source>, registry: &Registry) {
    let width = ui.available_width();
    let (place, _) = ui.allocate_exact_size(vec2(width, width * 9.0 / 16.0), Sense::hover());
    let Some(source) = source else {
        ui.painter().rect_filled(place, 2.0, Palette::here(ui).field);
        ui.add(Label::new(theme::small(ui, "Select a scene to see what is in it.")).wrap());
        return;
    };
    let preview = preview::of(ui.ctx(), &source, registry);
    preview::paint(ui, place, &preview);
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

/// The dialogs paint their fields on black in every theme, and offer no other colour.
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

/// A title as the name of a file.
fn file_name(title: &str) -> String {
    let plain: String =
        title.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let name = plain.split('-').filter(|s| !s.is_empty()).collect::<Vec<_>>().join("-");
    if name.is_empty() { "scene".to_owned() } else { name }
}
