//! The panel of the shaders: which files the picture is made of, and what is wrong with them.

use bevy_egui::egui::{
    self, Align, FontId, Layout, RichText, ScrollArea, Sense, TextStyle, Ui, WidgetInfo, WidgetType, vec2,
};

use super::{
    Panel, Place,
    author::{self, Ask},
    icon::{self, Icon},
    laws,
    state::{Action, Lab, Severity},
    theme::{self, Palette},
};
use crate::{
    custom::source_path,
    library::status::Trouble,
    registry::{
        Registry,
        compose::{File, Part},
    },
    shader::report::annotated,
    text::plural,
};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Shader;

impl Panel for Shader {
    fn id(&self) -> &'static str {
        author::SHADER_TAB
    }

    fn title(&self) -> &'static str {
        "Shader"
    }

    fn place(&self) -> Place {
        Place::Bottom
    }

    fn note(&self, lab: &Lab) -> Option<(Severity, String)> {
        let count = lab.shaders.troubles.len();
        (count > 0).then(|| (Severity::Error, plural(count, "error")))
    }

    fn show(&self, ui: &mut Ui, lab: &Lab, registry: &Registry) -> Vec<Action> {
        let mut actions = Vec::new();
        let palette = Palette::here(ui);
        let whole = ui.available_rect_before_wrap();
        let gap = 12.0;
        // What is wrong comes first where there is little room.
        let share = if lab.shaders.troubles.is_empty() { 0.5 } else { 0.4 };
        let left = (share * whole.width()).clamp(240.0, 620.0);
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let column = |ui: &mut Ui, width: f32, add: &mut dyn FnMut(&mut Ui)| {
                ui.allocate_ui_with_layout(vec2(width, whole.height()), Layout::top_down(Align::Min), |ui| {
                    ui.spacing_mut().item_spacing.x = theme::UNIT;
                    ui.set_width(width);
                    add(ui);
                });
            };
            column(ui, left, &mut |ui| files(ui, lab, registry, &mut actions));
            let (line, _) = ui.allocate_exact_size(vec2(2.0 * gap, whole.height()), Sense::hover());
            ui.painter().vline(line.center().x, whole.y_range(), egui::Stroke::new(1.0, palette.line));
            let right = (whole.width() - left - 2.0 * gap).max(64.0);
            column(ui, right, &mut |ui| {
                if lab.shaders.troubles.is_empty() {
                    well(ui, lab, registry, &mut actions);
                } else {
                    troubles(ui, lab, &mut actions);
                }
            });
        });
        actions
    }
}

// ── the files ──

/// What people call a file of a composition, and what it is for.
#[must_use]
pub fn words(part: Part, path: &str) -> (String, &'static str) {
    let word = path.rsplit('/').next().and_then(|name| name.split('.').next()).unwrap_or(path);
    let (name, help) = match part {
        Part::Model => (
            "the model",
            "How light leaves the surface: `response` answers to one light, `ambient_response` to light from everywhere. Begin here.",
        ),
        Part::Import => ("imported", "A file of yours that another one of the list asks for with `#import`."),
        Part::Mode => (
            "the shading mode",
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
            "What goes into a shading mode and what comes out of it: the vertex, and what is interpolated for the pixel.",
        ),
        Part::Vocabulary => {
            let help = "Functions that models are written in: terms and frames, Fresnel reflectance, distributions, masking. \
                        Their twins in Rust have the same names.";
            return (format!("vocabulary: {word}"), help);
        }
        Part::Wrapper => (
            "the wrapper",
            "The entry points of the graphics card: bindings and entry points. The only file that knows the renderer.",
        ),
    };
    (name.to_owned(), help)
}

fn files(ui: &mut Ui, lab: &Lab, registry: &Registry, actions: &mut Vec<Action>) {
    let (Some(model), Some(mode)) = (registry.model(lab.model_shown()), registry.mode(lab.mode_shown()))
    else {
        ui.add(egui::Label::new(missing_model(lab, registry, lab.model_shown())).wrap());
        return;
    };
    ui.horizontal(|ui| {
        let title = format!("{} · {}", model.declaration.name, mode.declaration.name);
        ui.label(theme::strong(ui, title)).on_hover_text("What is shown is made of these files.");
        folder(ui, lab, actions);
    });
    ScrollArea::vertical().id_salt("files").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.spacing_mut().interact_size.y = ROW;
        for file in crate::registry::compose::files(registry.sources(), model, mode, registry.lights()) {
            self::file(ui, lab, &file, actions);
        }
    });
}

/// Which folder is watched, or how to get one.
fn folder(ui: &mut Ui, lab: &Lab, actions: &mut Vec<Action>) {
    let Some(folder) = &lab.shaders.shaders else {
        ui.label(theme::small(ui, "The shaders are built in."));
        let button = ui.button("Write them out for editing…").on_hover_text(
            "Copies every shader file into a folder that you choose. From there they are read again whenever you save one.",
        );
        if button.clicked() {
            actions.push(Action::Author(Ask::ExportDialog));
        }
        return;
    };
    let palette = Palette::here(ui);
    let text = folder.display().to_string();
    ui.label(theme::small(ui, "watched:"));
    let room = ui.available_width() - 36.0;
    let shown = tail(ui, &text, TextStyle::Small, room);
    let path = ui.label(RichText::new(shown).small().color(palette.text));
    let mut help = format!("{text}\nA file saved in this folder is loaded at once.");
    if let Some(models) = &lab.shaders.models {
        help += &format!("\nOwn models: {}", models.display());
    }
    path.on_hover_text(help);
    if icon::button(ui, Icon::Copy, "Copy the path of the folder").clicked() {
        actions.push(Action::Copy(text.clone()));
    }
}

/// A path that is cut off at its beginning where it is too long: its end says more.
fn tail(ui: &Ui, text: &str, style: TextStyle, room: f32) -> String {
    let font = style.resolve(ui.style());
    let width =
        |s: &str| ui.painter().layout_no_wrap(s.to_owned(), font.clone(), egui::Color32::WHITE).size().x;
    if width(text) <= room {
        return text.to_owned();
    }
    let starts: Vec<usize> = text.char_indices().map(|(i, _)| i).skip(1).collect();
    let cut = |i: usize| format!("…{}", &text[starts[i]..]);
    let first = (0..starts.len()).collect::<Vec<_>>().partition_point(|&i| width(&cut(i)) > room);
    if first < starts.len() { cut(first) } else { "…".to_owned() }
}

/// The height of a row of the list, points.
const ROW: f32 = 22.0;

fn file(ui: &mut Ui, lab: &Lab, file: &File, actions: &mut Vec<Action>) {
    let File { part, ref path, edited } = *file;
    let palette = Palette::here(ui);
    let (name, help) = words(part, path);
    let trouble = lab.shaders.troubles.iter().find(|t| t.problem.file == *path);
    let on_disk = author::on_disk(&lab.shaders, path);
    let row = ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.spacing_mut().item_spacing.x = 6.0;
        let (sign, _) = ui.allocate_exact_size(vec2(14.0, ROW), Sense::hover());
        if trouble.is_some() {
            icon::severity(ui.painter(), sign.center(), 5.5, Severity::Error, &palette);
        }
        let (place, label) = ui.allocate_exact_size(vec2(140.0, ROW), Sense::hover());
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
                    let line = lab.line_of_trouble(path);
                    actions.push(Action::Author(Ask::Edit { path: file.clone(), line }));
                }
            }
            if let Some(t) = trouble {
                ui.label(RichText::new(format!("line {}", t.problem.line)).small().color(palette.error));
            } else if edited {
                let mark = ui.label(RichText::new("● edited").small().color(palette.accent));
                mark.on_hover_text("This file differs from the copy that is built in.");
            }
            let room = ui.available_width();
            let shown = tail(ui, path, TextStyle::Monospace, room);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.label(RichText::new(shown).monospace().color(palette.weak));
            });
        });
    });
    row.response.on_hover_ui(|ui| {
        ui.set_max_width(340.0);
        ui.label(theme::strong(ui, &name));
        ui.label(help);
        let place = on_disk.map_or_else(|| format!("{path}, built in"), |f| f.display().to_string());
        ui.label(theme::small(ui, place));
    });
}

/// What is said of a model that a scene names and that is not there.
#[must_use]
pub fn missing_model(lab: &Lab, registry: &Registry, id: &str) -> String {
    let path = source_path(id);
    let trouble = lab.shaders.troubles.iter().find(|t| t.problem.file == path).map(|t| t.problem.to_string());
    match trouble.or_else(|| registry.broken_model(id).map(str::to_owned)) {
        Some(why) => format!(
            "There is no version of the file {path} yet that works: {why}. Correct it, and the model is there; or \
             choose another one."
        ),
        None => format!(
            "There is no reflection model “{id}”: the file {path} is gone. Put it back, and its knobs are here again; \
             or choose another model."
        ),
    }
}

// ── what is wrong ──

/// "A", "A and B", "A, B and C".
#[must_use]
pub fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// What a problem means for the picture.
#[must_use]
pub fn consequence(trouble: &Trouble) -> String {
    let names: Vec<_> = trouble.stale.iter().map(String::as_str).collect();
    if names.is_empty() {
        return "Nothing on the picture depends on it.".to_owned();
    }
    format!("The picture shows the last good version of {} until this is corrected.", listed(&names))
}

/// How wide a tab is shown, in characters.
const TAB: usize = 4;

/// A line of source, short enough to be shown, and the character that is meant in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// Without tabs, cut to the room; `…` stands where something was cut off.
    pub text: String,
    /// Which character is meant, from 0; may be one past the end.
    pub caret: usize,
}

/// The part of a line of source around a column (in characters, from 1; it may be past the end) that fits into so
/// many characters. Tabs become spaces up to the next multiple of four.
#[must_use]
pub fn excerpt(source: &str, column: usize, room: usize) -> Excerpt {
    let mut chars: Vec<char> = Vec::new();
    let mut caret = None;
    for (i, c) in source.trim_end().chars().enumerate() {
        if i + 1 == column.max(1) {
            caret = Some(chars.len());
        }
        match c {
            '\t' => chars.extend(std::iter::repeat_n(' ', TAB - chars.len() % TAB)),
            c => chars.push(c),
        }
    }
    let mut caret = caret.unwrap_or(chars.len());
    // The indentation says nothing.
    let indent = chars.iter().take(caret).take_while(|c| **c == ' ').count();
    let room = room.max(8);
    if chars.len() > room && indent > 0 {
        chars.drain(..indent);
        caret -= indent;
    }
    if chars.len() > room {
        // What stands before the place explains more than what stands after it.
        let start = (caret + room / 3 + 1).saturating_sub(room).min(chars.len() - room);
        let end = (start + room).min(chars.len());
        let (cut_start, cut_end) = (start > 0, end < chars.len());
        chars = chars[start..end].to_vec();
        caret -= start;
        if cut_start {
            chars[0] = '…';
        }
        if cut_end && let Some(last) = chars.last_mut() {
            *last = '…';
        }
    }
    Excerpt { text: chars.into_iter().collect(), caret }
}

/// A problem as text: message, place, the line with a caret, what it means.
#[must_use]
pub fn report(trouble: &Trouble) -> String {
    let path = trouble.path.as_ref().map(|path| path.display().to_string());
    let text = annotated(&trouble.problem, path.as_deref().unwrap_or(&trouble.problem.file));
    format!("{text}\n{}\n", consequence(trouble))
}

fn troubles(ui: &mut Ui, lab: &Lab, actions: &mut Vec<Action>) {
    let mut all: Vec<_> = lab.shaders.troubles.iter().collect();
    // What the picture suffers from comes first.
    all.sort_by_key(|t| t.stale.is_empty());
    ScrollArea::vertical().id_salt("troubles").auto_shrink(false).show(ui, |ui| {
        ui.set_width(ui.available_width() - 8.0);
        for (i, trouble) in all.into_iter().enumerate() {
            if i > 0 {
                ui.separator();
            }
            ui.push_id(i, |ui| self::trouble(ui, trouble, actions));
        }
    });
}

fn trouble(ui: &mut Ui, trouble: &Trouble, actions: &mut Vec<Action>) {
    let palette = Palette::here(ui);
    let p = &trouble.problem;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let (sign, response) = ui.allocate_exact_size(vec2(16.0, 24.0), Sense::hover());
        icon::severity(ui.painter(), sign.center(), 6.0, Severity::Error, &palette);
        response.on_hover_text(Severity::Error.name());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(path) = &trouble.path {
                let open = ui.button("Open in editor").on_hover_text(path.display().to_string());
                if open.clicked() {
                    actions.push(Action::Author(Ask::Edit { path: path.clone(), line: p.line }));
                }
            }
            if ui.button("Copy").on_hover_text("Copy place, message and line").clicked() {
                actions.push(Action::Copy(report(trouble)));
            }
            let place = format!("{}:{}:{}", p.file, p.line, p.column);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(egui::Label::new(theme::strong(ui, place)).truncate());
            });
        });
    });
    ui.add(egui::Label::new(RichText::new(&p.message).color(palette.error)).wrap().selectable(true));
    source_line(ui, trouble);
    ui.add(egui::Label::new(consequence(trouble)).wrap());
}

/// The line as it stands in the file, with its number, and a caret below the place that is meant.
fn source_line(ui: &mut Ui, trouble: &Trouble) {
    let p = &trouble.problem;
    if p.source.trim().is_empty() {
        return;
    }
    let palette = Palette::here(ui);
    let font = FontId::monospace(TextStyle::Body.resolve(ui.style()).size);
    let plain = |text: String, colour| ui.painter().layout_no_wrap(text, font.clone(), colour);
    let number = plain(p.line.to_string(), palette.weak);
    let advance = plain("0".repeat(10), palette.text).size().x / 10.0;
    let padding = vec2(8.0, 4.0);
    let gutter = number.size().x + 2.0 * padding.x;
    let width = ui.available_width();
    let room = ((width - gutter - 2.0 * padding.x) / advance).floor().max(0.0) as usize;
    let shown = excerpt(&p.source, p.column, room);
    let source = plain(shown.text.clone(), palette.text);
    // Larger than the text: it is looked for.
    let large = FontId::monospace(1.5 * font.size);
    let caret = ui.painter().layout_no_wrap("^".to_owned(), large, palette.error);
    let height = source.size().y + 0.55 * caret.size().y + 2.0 * padding.y;
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(WidgetType::Label, true, format!("line {}: {}", p.line, p.source.trim()))
    });
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 4.0, palette.field);
    let top = rect.min + padding;
    painter.galley(top, number, palette.weak);
    let left = rect.left() + gutter;
    painter.vline(left - 0.5 * padding.x, rect.y_range().shrink(2.0), egui::Stroke::new(1.0, palette.line));
    let at = egui::pos2(left + padding.x, top.y);
    // Asked of the text itself, since not every sign is as wide as the others.
    let here = source.pos_from_cursor(egui::text::CCursor::new(shown.caret));
    let middle = here.min.x + 0.5 * advance;
    let under = at + vec2(middle - 0.5 * caret.size().x, source.size().y - 0.1 * caret.size().y);
    painter.galley(at, source, palette.text);
    painter.galley(under, caret, palette.error);
}

/// Nothing is wrong: what was last taken over, and how to begin.
fn well(ui: &mut Ui, lab: &Lab, registry: &Registry, actions: &mut Vec<Action>) {
    let heading = if laws::are_broken(lab) { "No errors, but broken laws" } else { "No errors" };
    let how = match &lab.shaders.shaders {
        Some(_) => {
            "Open a file at the left, change it and save it: the picture follows. Errors appear here, and the picture keeps the last version that worked."
        }
        None => {
            "To change how the picture is computed: export the shaders, open one in an editor, save it. The picture follows. Or write a custom model:"
        }
    };
    ui.horizontal(|ui| {
        ui.label(theme::strong(ui, heading));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            laws::button(ui, lab, registry, actions);
            let last = lab.shaders.last.as_ref();
            let text =
                last.map(|last| format!("{} loaded in {:.0} ms", last.file, last.milliseconds.max(0.0)));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                text.map(|text| ui.add(egui::Label::new(theme::small(ui, text)).truncate()));
            });
        });
    });
    ScrollArea::vertical().id_salt("well").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        laws::findings(ui, lab);
        ui.add(egui::Label::new(how).wrap());
        ui.add_space(4.0);
        actions.extend(author::buttons(ui, lab, registry));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(source: &str, column: usize, room: usize) -> (String, usize) {
        let e = excerpt(source, column, room);
        (e.text, e.caret)
    }

    #[test]
    fn the_caret_stands_under_the_column_whatever_comes_before() {
        assert_eq!(at("let x = ;", 9, 80), ("let x = ;".to_owned(), 8));
        assert_eq!(at("\tlet x = ;", 10, 80), ("    let x = ;".to_owned(), 12), "a tab is four wide");
        assert_eq!(at("ab\tx", 4, 80), ("ab  x".to_owned(), 4), "a tab ends at the next stop");
        assert_eq!(at("/* 漢 */ x", 9, 80).1, 8, "characters, not bytes");
        assert_eq!(at("abc", 99, 80), ("abc".to_owned(), 3), "past the end");
        assert_eq!(at("abc", 0, 80).1, 0);
        assert_eq!(at("", 1, 80), (String::new(), 0));
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let line: String = ('a'..='z').cycle().take(200).collect();
        for column in [1, 5, 30, 100, 170, 200, 201] {
            let (text, caret) = at(&line, column, 40);
            assert_eq!(text.chars().count(), 40, "{column}");
            assert!(caret <= 40);
            if column <= 200 {
                let meant = line.chars().nth(column - 1);
                let shown = text.chars().nth(caret);
                assert!(
                    shown == meant || shown == Some('…') && (column == 1 || column == 200),
                    "{column}: {text}"
                );
            }
        }
        let (text, caret) = at(&format!("{}let x = ;", " ".repeat(60)), 69, 40);
        assert_eq!((text.as_str(), caret), ("let x = ;", 8), "indentation goes first");
    }

    #[test]
    fn names_are_listed_as_people_do() {
        assert_eq!(listed(&["A"]), "A");
        assert_eq!(listed(&["A", "B"]), "A and B");
        assert_eq!(listed(&["A", "B", "C"]), "A, B and C");
    }
}
