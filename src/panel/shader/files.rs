//! The list of the shader files behind the picture.

use std::{path::Path, sync::Arc};

use bevy_egui::egui::{
    self, Align, Color32, FontId, Galley, Layout, RichText, ScrollArea, Sense, TextStyle, Ui, WidgetInfo,
    WidgetType, vec2,
};

use super::missing_model;
use crate::files::Shown as _;
use crate::{
    panel::{
        icon::{self, Icon},
        state::{Action, ModelCommand, Session, Severity},
        theme::{self, Palette},
    },
    program,
    registry::{
        Registry,
        compose::{File, Part},
    },
};

/// The display name and the purpose of a file of a composition.
#[must_use]
pub fn words(part: Part, path: &str) -> (String, &'static str) {
    let word = path.rsplit('/').next().and_then(|name| name.split('.').next()).unwrap_or(path);
    let (name, help) = match part {
        Part::Model => (
            "the model",
            "How light leaves the surface: `response` answers to one light, `ambient_response` to uniform light. Begin here.",
        ),
        Part::Import => ("imported", "A file of yours that another one of the list asks for with `#import`."),
        Part::ShadingModel => (
            "the shading model",
            "The stage that evaluates the model: per polygon, per vertex or per pixel, and what is interpolated between.",
        ),
        Part::Loop => (
            "the light loop",
            "Asks every light what arrives at the point, hands that to the model, and adds up the answers.",
        ),
        Part::LightType => {
            let help = "From where, and how strongly, the light of this type arrives at a point.";
            return (format!("the light type: {word}"), help);
        }
        Part::LightRecord => (
            "the light record",
            "The record of each light in the shader: place, direction, colour, strength, parameters.",
        ),
        Part::Stages => (
            "the stages",
            "What goes into a shading model and what comes out of it: the vertex, and what is interpolated for the pixel.",
        ),
        Part::Vocabulary => {
            let help = "Functions that models are written in: terms and frames, Fresnel reflectance, distributions, masking. \
                        Their twins in Rust have the same names.";
            return (format!("vocabulary: {word}"), help);
        }
        Part::Channels => {
            ("the debug channels", "The values that lead to a pixel as colours: View › Channel shows them.")
        }
        Part::Wrapper => {
            ("the wrapper", "Bindings and entry points for the GPU. The only file that knows the renderer.")
        }
    };
    (name.to_owned(), help)
}

fn origin(files: &[File], registry: &Registry) -> &'static str {
    let own = files.iter().any(|file| file.path.starts_with("models/"));
    match files.iter().any(|file| registry.is_foreign(&file.path)) {
        true => "Some are of this program, the others built in.",
        false if own => "All but the model is built in.",
        false => "The shaders are built in.",
    }
}

pub(super) fn files(ui: &mut Ui, session: &Session, registry: &Registry, actions: &mut Vec<Action>) {
    let (Some(model), Some(shading)) =
        (registry.model(session.model_shown()), registry.shading_model(session.shading_shown()))
    else {
        ui.add(egui::Label::new(missing_model(session, registry, session.model_shown())).wrap());
        return;
    };
    let lights = registry.lights_in(session.document.scene().light_types(registry));
    let files = crate::registry::compose::files(registry.sources(), model, shading, &lights);
    let title = format!("{} · {}", model.declaration.name, shading.declaration.name);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            match &session.shaders.folders.shaders {
                Some(folder) => watched(ui, session, folder, actions),
                None => export(ui, actions),
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let label = egui::Label::new(theme::strong(ui, title)).truncate();
                ui.add(label).on_hover_text("The picture is made of these files.");
                let text = origin(&files, registry);
                let folder = &session.shaders.folders.shaders;
                if folder.is_none() && theme::small_width(ui, text) <= ui.available_width() {
                    ui.label(theme::small(ui, text));
                }
            });
        });
    });
    // Paths are aligned, after the longest name.
    let font = TextStyle::Body.resolve(ui.style());
    let width = |text: String| ui.painter().layout_no_wrap(text, font.clone(), egui::Color32::WHITE).size().x;
    let names = files.iter().map(|file| width(words(file.part, &file.path).0)).fold(0.0, f32::max);
    ScrollArea::vertical().id_salt("files").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.spacing_mut().interact_size.y = ROW;
        let names = (names.ceil() + 10.0).min(0.6 * ui.available_width());
        for file in files {
            self::file(ui, (session, registry), &file, names, actions);
        }
    });
}

/// The button that exports the shaders to a folder.
fn export(ui: &mut Ui, actions: &mut Vec<Action>) {
    let button = ui.button("Export shaders for editing…").on_hover_text(
        "Copies every shader file into a folder that you choose. A file saved there is reloaded at once.",
    );
    if button.clicked() {
        actions.push(Action::Model(ModelCommand::ExportDialog));
    }
}

/// The watched folder, laid out from right to left.
fn watched(ui: &mut Ui, session: &Session, folder: &Path, actions: &mut Vec<Action>) {
    let palette = Palette::here(ui);
    let text = folder.shown().to_string();
    if icon::button(ui, Icon::Copy, "Copy the path of the folder").clicked() {
        actions.push(Action::Copy(text.clone()));
    }
    let room = 0.5 * ui.available_width();
    let font = TextStyle::Small.resolve(ui.style());
    let (shown, _) = theme::elided_within(ui, &text, &font, palette.text, room);
    let path = ui.label(shown);
    let mut help = format!("{text}\nA file saved in this folder is loaded at once.");
    if let Some(models) = &session.shaders.folders.models {
        help += &format!("\nCustom models: {}", models.shown());
    }
    path.on_hover_text(help);
    ui.label(theme::small(ui, "watched:"));
}

/// A path, without its folders if there is little room.
fn short(ui: &Ui, path: &str, font: &FontId, colour: Color32, room: f32) -> Arc<Galley> {
    let file = path.rsplit('/').next().unwrap_or(path);
    [path, &format!("…/{file}")]
        .map(|text| ui.painter().layout_no_wrap(text.to_owned(), font.clone(), colour))
        .into_iter()
        .find(|galley| galley.size().x <= room)
        .unwrap_or_else(|| theme::elided_within(ui, file, font, colour, room).0)
}

/// Height of a row of the list, in points.
const ROW: f32 = 22.0;

/// The row of a file; `names` is the width of the name column, in points.
pub(super) fn file(
    ui: &mut Ui,
    (session, registry): (&Session, &Registry),
    file: &File,
    names: f32,
    actions: &mut Vec<Action>,
) {
    let foreign = registry.is_foreign(&file.path);
    let File { part, ref path, edited } = *file;
    let palette = Palette::here(ui);
    let (name, help) = words(part, path);
    let trouble = session.shaders.troubles.iter().find(|t| t.problem.file == *path);
    let on_disk = session.shaders.folders.file_of(path);
    let row = ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.spacing_mut().item_spacing.x = 6.0;
        let (sign, _) = ui.allocate_exact_size(vec2(14.0, ROW), Sense::hover());
        if trouble.is_some() {
            icon::severity(ui.painter(), sign.center(), 5.5, Severity::Error, &palette);
        }
        let (place, label) = ui.allocate_exact_size(vec2(names, ROW), Sense::hover());
        let galley = theme::elided(ui, &name, TextStyle::Body, palette.text, place.width());
        let at = egui::pos2(place.left(), place.center().y - galley.size().y / 2.0);
        ui.painter().galley(at, galley, palette.text);
        let says = match (trouble, edited) {
            (Some(t), _) => format!("{name}: {path}: error in line {}", t.problem.line),
            (None, true) => format!("{name}: {path}: edited"),
            (None, false) => format!("{name}: {path}"),
        };
        label.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &says));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(file) = &on_disk {
                let open = icon::button(ui, Icon::Pencil, &format!("Open {path} in an editor"));
                if open.clicked() {
                    let line = session.line_of_trouble(path);
                    actions.push(Action::Model(ModelCommand::Edit { path: file.clone(), line }));
                }
            }
            if let Some(t) = trouble {
                ui.label(RichText::new(format!("line {}", t.problem.line)).small().color(palette.error));
            } else if edited {
                let mark = ui.label(RichText::new("● edited").small().color(palette.accent));
                mark.on_hover_text("This file differs from the copy that is compiled in.");
            }
            let font = TextStyle::Monospace.resolve(ui.style());
            let shown = short(ui, path, &font, palette.weak, ui.available_width());
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.label(shown));
        });
    });
    row.response.on_hover_ui(|ui| {
        ui.set_max_width(340.0);
        ui.label(theme::strong(ui, &name));
        ui.label(help);
        let place = on_disk.map_or_else(
            // The folder it belongs to may only exist on its author's machine.
            || if foreign { format!("{path}, of {}", program::name()) } else { format!("{path}, built in") },
            |f| f.shown().to_string(),
        );
        ui.label(theme::small(ui, place));
    });
}
