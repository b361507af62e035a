//! The list of the shader files behind the picture.

use std::path::Path;

use super::{missing_model, open_in_editor};
use crate::{
    panel::{
        prelude::*,
        state::{CodeCommand, Effect, Pick},
    },
    program,
    registry::{
        MODELS,
        compose::{File, Part},
    },
};

/// The names and purposes of files, by their parts.
const WORDS: &str = include_str!("../../../assets/text/shader_files.tsv");

/// The display name and the purpose of a file of a composition.
#[must_use]
pub fn words(part: Part, path: &str) -> (String, &'static str) {
    let part = format!("{part:?}\t");
    let line = WORDS.lines().find_map(|line| line.strip_prefix(&*part));
    let (name, help) = line.and_then(|line| line.split_once('\t')).unwrap_or_default();
    let word = path.rsplit('/').next().and_then(|name| name.split('.').next()).unwrap_or(path);
    (name.replace("{word}", word), help)
}

fn origin(files: &[File], registry: &Registry) -> &'static str {
    let own = files.iter().any(|file| file.path.starts_with(MODELS));
    match (files.iter().any(|file| registry.is_foreign(&file.path)), own) {
        (true, true) => "Not all are built in.",
        (true, false) => "Some are of this program, the others built in.",
        (false, true) => "All but the model is built in.",
        (false, false) => "The shaders are built in.",
    }
}

/// The place of a file, as its tooltip says it.
fn place(path: &str, on_disk: Option<&Path>, registry: &Registry) -> String {
    match on_disk {
        Some(file) => file.shown().to_string(),
        // The folder it belongs to may only exist on its author's machine.
        None if registry.is_foreign(path) => format!("{path}, of {}", program::name()),
        None if path.starts_with(MODELS) => path.to_owned(),
        None => format!("{path}, built in"),
    }
}

pub(super) fn files(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let (Some(model), Some(shading)) =
        (registry.model(session.model_shown()), registry.shading_model(session.shading_shown()))
    else {
        ui.add(Label::new(missing_model(session, registry, session.model_shown())).wrap());
        return;
    };
    let lights = registry.lights_in(session.document.scene().light_types(registry));
    let passage = session.document.scene().passage_of(model);
    let files = crate::registry::compose::files(registry.sources(), (model, passage), shading, &lights);
    let title = format!("{} · {}", model.declaration.name, shading.declaration.name);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            match &session.shaders.folders.shaders {
                Some(folder) => watched(ui, folder, context),
                None => export(ui, context),
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| heading(ui, title, &files, context));
        });
    });
    // Paths are aligned, after the longest name.
    let font = TextStyle::Body.resolve(ui.style());
    let width = |text: String| ui.painter().layout_no_wrap(text, font.clone(), Color32::WHITE).size().x;
    let names = files.iter().map(|file| width(words(file.part, &file.path).0)).fold(0.0, f32::max);
    ScrollArea::vertical().id_salt("files").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.spacing_mut().interact_size.y = ROW;
        let names = (names.ceil() + 10.0).min(0.6 * ui.available_width());
        for file in files {
            self::file(ui, &file, names, context);
        }
    });
}

/// The owner of the files, and their origin if there is room beside the button that exports them.
fn heading(ui: &mut Ui, title: String, files: &[File], context: &PanelContext<'_>) {
    let label = Label::new(theme::strong(ui, title)).truncate();
    ui.add(label).on_hover_text("The picture is made of these files.");
    let text = origin(files, context.registry());
    let is_watched = context.session().shaders.folders.shaders.is_some();
    if !is_watched && theme::small_width(ui, text) <= ui.available_width() {
        ui.label(theme::small(ui, text));
    }
}

/// The button that exports the shaders to a folder.
fn export(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let button = ui.button("Export shaders for editing…").on_hover_text(
        "Copies every shader file into a folder that you choose. A file saved there is reloaded at once.",
    );
    context.on_click(&button, || Action::Do(Effect::Pick(Pick::ShaderFolder)));
}

/// The watched folder, laid out from right to left.
fn watched(ui: &mut Ui, folder: &Path, context: &mut PanelContext<'_>) {
    let text = folder.shown().to_string();
    let button = icon::button(ui, Icon::Copy, "Copy the path of the folder");
    context.on_click(&button, || Action::Do(Effect::CopyText(text.clone())));
    let room = 0.5 * ui.available_width();
    let font = TextStyle::Small.resolve(ui.style());
    let (shown, _) = theme::elided_within(ui, &text, &font, Palette::here(ui).text, room);
    let path = ui.label(shown);
    let mut help = format!("{text}\nA file saved in this folder is loaded at once.");
    if let Some(models) = &context.session().shaders.folders.models {
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
fn file(ui: &mut Ui, file: &File, names: f32, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
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
        let sense = if on_disk.is_some() { Sense::click() } else { Sense::hover() };
        let (place, label) = ui.allocate_exact_size(vec2(names, ROW), sense);
        let galley = theme::elided(ui, &name, TextStyle::Body, palette.text, place.width());
        let at = pos2(place.left(), place.center().y - galley.size().y / 2.0);
        ui.painter().galley(at, galley, palette.text);
        let says = match (trouble, edited) {
            (Some(t), _) => format!("{name}: {path}: error in line {}", t.problem.line),
            (None, true) => format!("{name}: {path}: edited"),
            (None, false) => format!("{name}: {path}"),
        };
        theme::says(&label, WidgetType::Label, says);
        if let Some(file) = &on_disk {
            let command = || CodeCommand::File(file.clone(), session.line_of_trouble(path).unwrap_or(0));
            context.on_click(&label, || Action::Code(command()));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(file) = &on_disk {
                let open = icon::button(ui, Icon::Pencil, &format!("Open {path} in an editor"));
                let line = session.line_of_trouble(path).unwrap_or(1);
                context.on_click(&open, || open_in_editor(file, line));
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
        label
    });
    // A name that takes clicks hides the row below it from the pointer.
    theme::tip(row.response.union(row.inner), 340.0, |ui| {
        ui.label(theme::strong(ui, &name));
        ui.label(help);
        ui.label(theme::small(ui, place(path, on_disk.as_deref(), registry)));
        if on_disk.is_some() {
            ui.label(theme::small(ui, "A click on the name edits the file in the panel Code."));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        light::{Declaration, Incident, LightRecord, LightType},
        parameters,
        platform::fs,
        registry::Register as _,
        shader::Source,
    };

    parameters! {
        struct Lamp {}
    }
    impl LightType for Lamp {
        const DECLARATION: Declaration =
            Declaration::new("lamp", "Lamp", Source::new("light/lamp.wgsl", "fn incident_lamp() {}"));
        fn incident(&self, _: &LightRecord, _: Vec3) -> Incident {
            Incident::From { l: Vec3::Y, intensity: Vec3::ONE }
        }
    }

    #[test]
    fn only_what_ships_is_called_built_in() {
        let mut registry = Registry::builtin();
        registry.add_light_type::<Lamp>();
        let [ships, foreign, custom] = ["reflection/lambert.wgsl", "light/lamp.wgsl", "models/velvet.wgsl"];
        let said = |paths: &[&str]| {
            let file = |path: &&str| File { part: Part::Model, path: (*path).to_owned(), edited: false };
            origin(&paths.iter().map(file).collect::<Vec<_>>(), &registry)
        };
        assert_eq!(said(&[ships]), "The shaders are built in.");
        assert_eq!(said(&[ships, custom]), "All but the model is built in.");
        assert_eq!(said(&[ships, foreign]), "Some are of this program, the others built in.");
        assert_eq!(said(&[ships, foreign, custom]), "Not all are built in.");
        for (path, own) in [(ships, false), (foreign, true), (custom, true)] {
            let place = |on_disk: Option<&str>| place(path, on_disk.map(Path::new), &registry);
            assert_eq!(!place(None).contains("built in"), own, "{}", place(None));
            assert!(place(None).starts_with(path));
            assert_eq!(place(Some("/home/mira/added.wgsl")), "/home/mira/added.wgsl");
        }
    }

    #[test]
    fn a_file_in_the_folder_of_another_crate_is_called_by_its_place() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("light")).expect("writable");
        let mut registry = Registry::builtin();
        registry.add_light_type::<Lamp>();
        registry.add_shader_folder(folder.path());
        // The second is only imported.
        for path in ["light/lamp.wgsl", "light/glow.wgsl"] {
            let file = folder.path().join(path);
            fs::write(&file, "fn glow() {}").expect("writable");
            let on_disk = registry.path_on_disk(path);
            assert_eq!(on_disk.as_deref(), Some(&*file));
            let place = place(path, on_disk.as_deref(), &registry);
            assert!(place.ends_with(path) && !place.contains("built in"), "{place}");
        }
    }

    #[test]
    fn every_part_has_its_words() {
        use Part::{
            Channels, Import, LightRecord, LightType, Loop, Model, ShadingModel, Stages, Vocabulary, Wrapper,
        };
        let parts = [
            Model,
            Import,
            ShadingModel,
            Loop,
            LightType,
            Vocabulary,
            LightRecord,
            Stages,
            Channels,
            Wrapper,
        ];
        for part in parts {
            let (name, help) = words(part, "shaders/light/point.wgsl");
            assert!(!name.is_empty() && help.ends_with('.'), "{part:?}");
        }
        assert_eq!(words(LightType, "shaders/light/point.wgsl").0, "the light type: point");
        assert_eq!(WORDS.lines().count(), parts.len());
    }
}
