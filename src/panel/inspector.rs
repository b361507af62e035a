//! The inspector at the right: everything that can be set about what is selected.

use super::{
    Panel, Place, author, chooser,
    icon::{self, Icon},
    knob::{self, Caption},
    maths, model_override, shader,
    state::{Action, Lab, Severity, ViewChange},
    theme::{self, Palette},
    top::segmented,
};
use crate::document::{
    Edit, LightField, ObjectField, Selection,
    limits::{self, Limits},
};
use crate::{
    light::LightEntry,
    optics::{TermSelection, colour::Encoding, temperature, tone::ToneMapping},
    parameter::Value,
    reflection::{EquationPart, Measured, ModelEntry, Term, preset, usage},
    registry::Registry,
    scene::{Display, Light, Object, Observer, SceneSize},
    shading::ModeEntry,
    text::plural,
};
use bevy_egui::egui::{
    self, Align, CollapsingHeader, Key, Layout, RichText, ScrollArea, Sense, TextEdit, TextStyle, Ui,
    WidgetInfo, vec2,
};
use glam::Vec3;

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct Inspector;

impl Panel for Inspector {
    fn id(&self) -> &'static str {
        "inspector"
    }

    fn title(&self) -> &'static str {
        "Properties"
    }

    fn place(&self) -> Place {
        Place::Right
    }

    fn show(&self, ui: &mut Ui, lab: &Lab, registry: &Registry) -> Vec<Action> {
        let mut actions = Vec::new();
        // Each part has fields of its own: what is typed about one must not turn up in another.
        ui.push_id(lab.selection, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                // The scroll bar floats over this margin.
                ui.set_max_width(ui.available_width() - 8.0);
                match lab.selection {
                    Selection::Room => room(ui, lab, registry, &mut actions),
                    Selection::Observer => observer(ui, lab, &mut actions),
                    Selection::Light(i) => light(ui, lab, registry, i, &mut actions),
                    Selection::Object(i) => object(ui, lab, registry, i, &mut actions),
                }
                ui.add_space(16.0);
            });
        });
        actions
    }
}

/// A group with a heading; folds.
fn section(ui: &mut Ui, title: &str, open: bool, add: impl FnOnce(&mut Ui)) {
    ui.add_space(4.0);
    let line = ui.available_rect_before_wrap();
    let palette = Palette::here(ui);
    ui.painter().hline(line.x_range(), line.top(), egui::Stroke::new(1.0, palette.line));
    ui.add_space(4.0);
    let heading = theme::strong(ui, title);
    ui.scope(|ui| {
        ui.spacing_mut().indent = 16.0;
        ui.visuals_mut().indent_has_left_vline = false;
        CollapsingHeader::new(heading).id_salt(title).default_open(open).show_unindented(ui, |ui| {
            ui.add_space(2.0);
            add(ui);
        });
    });
}

/// The name of a part, its type below it, and what can be done with it as a whole.
fn header(
    ui: &mut Ui,
    lab: &Lab,
    registry: &Registry,
    part: Selection,
    own: Option<&str>,
    actions: &mut Vec<Action>,
) {
    let name = lab.name_of(part, registry);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let width = ui.available_width() - 76.0;
        let rename = move |text: String| match part {
            Selection::Light(i) => Action::Edit(Edit::Light(i, LightField::Name(text))),
            Selection::Object(i) => Action::Edit(Edit::Object(i, ObjectField::Name(text))),
            _ => Action::Edit(Edit::SceneName(text)),
        };
        text_field(ui, "name", "Name", own.unwrap_or_default(), &name, width, true, |text| {
            actions.push(rename(text))
        });
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if icon::button(ui, Icon::Bin, &format!("Delete {name}")).clicked() {
                actions.push(Action::Remove(part));
            }
            if icon::button(ui, Icon::Duplicate, &format!("Duplicate {name}")).clicked() {
                actions.push(Action::Duplicate(part));
            }
            if icon::button(ui, Icon::Target, &format!("Look at {name}  (C)")).clicked() {
                actions.push(Action::FocusSelection);
            }
        });
    });
    ui.add_space(4.0);
}

/// A field for text; the change counts when the field is left.
fn text_field(
    ui: &mut Ui,
    salt: &str,
    label: &str,
    value: &str,
    hint: &str,
    width: f32,
    heading: bool,
    mut set: impl FnMut(String),
) {
    let palette = Palette::here(ui);
    let id = ui.make_persistent_id(salt);
    let draft_id = id.with("draft");
    let mut text: String = ui.data(|d| d.get_temp(draft_id)).unwrap_or_else(|| value.to_owned());
    let focused = ui.memory(|m| m.has_focus(id));
    // A stroke of another width would move what stands below.
    let stroke = egui::Stroke::new(1.0, if focused { palette.accent } else { palette.line });
    let style = if heading { egui::TextStyle::Heading } else { egui::TextStyle::Body };
    let edit = TextEdit::singleline(&mut text)
        .id(id)
        .font(style)
        .hint_text(if heading { RichText::new(hint).heading() } else { RichText::new(hint) })
        .desired_width(width - 14.0)
        .frame(
            egui::Frame::new()
                .fill(palette.field)
                .stroke(stroke)
                .corner_radius(4.0)
                .inner_margin(egui::Margin::symmetric(6, 3)),
        );
    let response = ui.add(edit);
    response.widget_info(|| {
        let mut info = WidgetInfo::text_edit(true, value, &text, hint);
        info.label = Some(label.to_owned());
        info
    });
    if response.changed() {
        ui.data_mut(|d| d.insert_temp(draft_id, text.clone()));
    }
    if response.lost_focus() {
        ui.data_mut(|d| d.remove::<String>(draft_id));
        if !ui.input(|i| i.key_pressed(Key::Escape)) && text.trim() != value {
            set(text);
        }
    }
    response.on_hover_text(label);
}

fn position_limits(size: SceneSize) -> [Limits; 3] {
    [0, 1, 2].map(|axis| limits::position(size, axis))
}

fn thrice(limits: Limits) -> [Limits; 3] {
    [limits.clone(), limits.clone(), limits]
}

fn direction_knob(ui: &mut Ui, value: Vec3, help: &str) -> Option<Vec3> {
    let caption = Caption { label: "direction", help, ..Caption::default() };
    knob::vector_knob(ui, "direction", &caption, value, &thrice(limits::direction()))
}

// ── object ──

fn object(ui: &mut Ui, lab: &Lab, registry: &Registry, i: usize, actions: &mut Vec<Action>) {
    let Some(object) = lab.document.objects.get(i) else { return };
    let set = |field: ObjectField| Action::Edit(Edit::Object(i, field));
    header(ui, lab, registry, Selection::Object(i), object.name.as_deref(), actions);

    let model = registry.model(lab.document.model_of(object));
    let mode = registry.mode(lab.document.mode_of(object));
    section(ui, "Reflection", true, |ui| {
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                actions.extend(model_override::control(ui, lab, registry, object).map(set));
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    if let Some(model) = model {
                        model_header(ui, model);
                    }
                });
            });
        });
        match model {
            Some(model) => {
                equation(ui, model);
                terms(ui, lab, registry, actions);
            }
            None => missing_model(ui, lab, registry, lab.document.model_of(object), actions),
        }
        if let Some(mode) = mode {
            stage(ui, mode);
        }
    });

    section(ui, "Material", true, |ui| {
        let Some(model) = model else {
            ui.label(theme::small(ui, "The knobs belong to the model; they are here again when it is."));
            return;
        };
        if let Some(values) = measured(ui, registry, model, object) {
            actions.push(set(ObjectField::Preset(values)));
        }
        for p in model.parameters {
            let unused = usage::unused(model.parameters, p, &object.material);
            if let Some(v) = knob::parameter_knob(ui, p.name, p, &object.material.get(p), unused.as_deref()) {
                actions.push(set(ObjectField::Material(p.name, v)));
            }
        }
        if model.parameters.is_empty() {
            ui.label(theme::small(ui, "This model has no knobs."));
        }
        readouts(ui, lab, model, object);
        let unused: Vec<_> = registry
            .material_parameters()
            .filter(|p| model.parameter(p.name).is_none() && object.material.0.contains_key(p.name))
            .collect();
        if !unused.is_empty() {
            let reason = format!("Not used by {}", model.declaration.name);
            ui.add_space(4.0);
            ui.label(theme::small(ui, format!("{reason} (values kept)")));
            ui.add_space(2.0);
            for p in unused {
                knob::parameter_knob(ui, p.name, p, &object.material.get(p), Some(&reason));
            }
        }
    });

    section(ui, "Shape and position", true, |ui| {
        let kinds: Vec<_> = registry.shapes().iter().map(|s| s.declaration).collect();
        let names: Vec<_> = kinds.iter().map(|d| d.name).collect();
        let chosen = kinds.iter().position(|d| d.id == object.kind);
        let help = chosen.map_or("", |k| kinds[k].summary);
        let caption = Caption { label: "type", help, ..Caption::default() };
        if let Some(k) = knob::choice_knob(ui, "type", &caption, chosen.unwrap_or(usize::MAX), &names) {
            actions.push(set(ObjectField::Kind(kinds[k].id.to_owned())));
        }
        let caption = Caption { label: "size", unit: "m", help: "The largest extent.", ..Caption::default() };
        let size_limits = limits::object_size(lab.document.scene_size);
        let default = f64::from(crate::scene::DEFAULT_SIZE);
        if let Some(v) =
            knob::number_knob(ui, "size", &caption, f64::from(object.size), Some(default), &size_limits)
        {
            actions.push(set(ObjectField::Size(v as f32)));
        }
        let caption = Caption {
            label: "position",
            unit: "m",
            help: "Position of the centre; y is up, the origin is a corner of the room.",
            ..Caption::default()
        };
        if let Some(p) = knob::vector_knob(
            ui,
            "position",
            &caption,
            object.position,
            &position_limits(lab.document.scene_size),
        ) {
            actions.push(set(ObjectField::Position(p)));
        }
        let caption = Caption {
            label: "rotation",
            unit: "°",
            help: "Turned about x first, then y, then z of the room.",
            ..Caption::default()
        };
        if let Some(r) =
            knob::vector_knob(ui, "rotation", &caption, object.rotation, &thrice(limits::rotation()))
        {
            actions.push(set(ObjectField::Rotation(r)));
        }
        if let Some(shape) = registry.shape(&object.kind) {
            let d = shape.declaration;
            let caption = Caption { label: "tessellation", help: d.tessellation_help, ..Caption::default() };
            let value = f64::from(shape.tessellation(object.tessellation));
            let default = f64::from(d.default_tessellation);
            if let Some(v) = knob::number_knob(
                ui,
                "tessellation",
                &caption,
                value,
                Some(default),
                &limits::tessellation(d),
            ) {
                actions.push(set(ObjectField::Tessellation(
                    Some(v as u32).filter(|n| *n != d.default_tessellation),
                )));
            }
        }
    });
}

/// The chooser of measured materials, for models that can be one. Returns the parameters of the chosen.
fn measured(
    ui: &mut Ui,
    registry: &Registry,
    model: &ModelEntry,
    object: &Object,
) -> Option<Vec<(&'static str, Value)>> {
    let offered: Vec<_> = preset::all().iter().filter(|m| !(model.preset)(m).is_empty()).collect();
    if offered.is_empty() {
        return None;
    }
    let is = |m: &Measured| {
        (model.preset)(m)
            .iter()
            .all(|(name, value)| model.parameter(name).is_some_and(|p| object.material.get(p) == *value))
    };
    let present = offered.iter().find(|m| is(m)).copied();
    let caption = Caption {
        label: "measured material",
        help: "Sets the knobs below to what was measured on a real material, and those of the other physically based models too. It shows “none” as soon as one of them is turned away.",
        ..Caption::default()
    };
    let words = chooser::Words {
        label: "Search measured materials",
        hint: "Search materials",
        none: "No material has that in its name or source.",
        foot: "The numbers are F₀ over the whole spectrum, as red, green and blue; models that calculate with n and k at three wavelengths differ a little.",
    };
    let chosen =
        knob::list_knob(ui, "measured material", &caption, present.map_or("none", |m| m.name), |ui, id| {
            let height = 0.45 * ui.ctx().content_rect().height();
            let find = |search: &str| -> Vec<&'static Measured> {
                let hit =
                    |m: &&&'static Measured| chooser::matches(&[m.name, m.id, m.source].join(" "), search);
                offered.iter().filter(hit).copied().collect()
            };
            let entry = |m: &&'static Measured| chooser::Entry {
                heading: if m.metal { "Metals and semiconductors" } else { "Dielectrics" },
                name: m.name,
                note: m.f0.to_array().map(|v| format!("{v:.2}")).join("  "),
                number: None,
                swatch: Some(theme::swatch(m.f0)),
                current: present == Some(*m),
            };
            chooser::list(ui, id, words, height, find, entry, |ui, m| measurement(ui, m))
        });
    chosen.map(|material| crate::registry::along(model, material, registry))
}

/// What was measured on a material, and by whom.
fn measurement(ui: &mut Ui, material: &Measured) {
    let palette = Palette::here(ui);
    ui.label(theme::strong(ui, material.name));
    egui::Grid::new("measurement").num_columns(5).spacing(vec2(14.0, 3.0)).show(ui, |ui| {
        ui.label("");
        for wavelength in ["630 nm", "532 nm", "465 nm"] {
            ui.label(theme::small(ui, wavelength));
        }
        ui.end_row();
        let rows = [("n", material.n), ("k", material.k), ("F_0", material.f0.to_array())];
        for (symbol, values) in rows {
            maths::symbol(ui, symbol, 15.0);
            for v in values {
                // The k of glass and water is about 10⁻⁸.
                let text = if v > 0.0 && v < 5e-4 {
                    format!("{v:.0e}").replace('-', "−")
                } else {
                    format!("{v:.3}")
                };
                ui.label(text);
            }
            if symbol == "F_0" {
                let (rect, _) = ui.allocate_exact_size(vec2(30.0, 16.0), Sense::hover());
                let stroke = egui::Stroke::new(1.0, palette.weak);
                ui.painter().rect(rect, 3.0, theme::swatch(material.f0), stroke, egui::StrokeKind::Inside);
            }
            ui.end_row();
        }
    });
    ui.label(theme::small(ui, "F₀ is a linear sRGB colour of the whole spectrum"));
    ui.label(theme::small(ui, format!("Measured by {}", material.source)));
}

/// What follows from the values of the knobs.
fn readouts(ui: &mut Ui, lab: &Lab, model: &ModelEntry, object: &Object) {
    let readouts = model.instantiate(&object.material, lab.document.display.encoding).readouts();
    if readouts.is_empty() {
        return;
    }
    ui.add_space(2.0);
    ui.label(theme::small(ui, "Derived values"));
    for readout in &readouts {
        knob::readout(ui, readout);
    }
    ui.add_space(4.0);
}

/// Name, author and year of a model; the whole story is the tooltip.
fn model_header(ui: &mut Ui, model: &ModelEntry) {
    let d = model.declaration;
    let palette = Palette::here(ui);
    let name = theme::elided(ui, d.name, TextStyle::Heading, palette.text, ui.available_width());
    ui.horizontal(|ui| {
        ui.label(name);
        // What does not fit is in the tooltip.
        if !d.author.is_empty() && ui.available_width() > 48.0 {
            ui.add(egui::Label::new(theme::small(ui, d.author)).truncate());
        }
    })
    .response
    .on_hover_ui(|ui| {
        ui.set_max_width(320.0);
        chooser::about(ui, model);
    });
}

/// What stands in the place of a model that is not there: its file is gone, or never worked.
fn missing_model(ui: &mut Ui, lab: &Lab, registry: &Registry, id: &str, actions: &mut Vec<Action>) {
    let palette = Palette::here(ui);
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let (sign, _) = ui.allocate_exact_size(vec2(16.0, 20.0), Sense::hover());
        icon::severity(ui.painter(), sign.center(), 6.0, Severity::Error, &palette);
        ui.vertical(|ui| {
            ui.add(egui::Label::new(shader::missing_model(lab, registry, id)).wrap().selectable(true));
            ui.horizontal_wrapped(|ui| {
                if ui.button("Choose another model").clicked() {
                    actions.push(Action::View(ViewChange::Chooser(true)));
                }
                if !lab.shaders.troubles.is_empty() && ui.button("Show the error").clicked() {
                    actions.push(Action::View(ViewChange::BottomTab(author::SHADER_TAB.to_owned())));
                }
            });
        });
    });
    ui.add_space(6.0);
}

fn equation(ui: &mut Ui, model: &ModelEntry) {
    let d = model.declaration;
    // Own models need not say one.
    if d.equation.is_empty() {
        return;
    }
    let name = |symbol: &str| -> Option<String> {
        let parameter = model.parameters.iter().find(|p| maths::same_symbol(p.symbol, symbol));
        match parameter {
            Some(p) => Some(format!("{}: {}", p.label, p.help)),
            None => {
                let defined =
                    maths::definition(d.equation, symbol).map(|text| format!("defined here: {text}"));
                let general = maths::meaning(symbol).map(str::to_owned);
                // A letter that the equation uses for something of its own does not mean what it usually does.
                let terms = ["I", "I_a", "I_d", "I_s"];
                if terms.contains(&symbol) { general.or(defined) } else { defined.or(general) }
            }
        }
    };
    maths::equation(ui, d.equation, name);
    ui.add_space(4.0);
}

/// The choice of the term that the picture shows, where there is one.
fn terms(ui: &mut Ui, lab: &Lab, registry: &Registry, actions: &mut Vec<Action>) {
    let mut options = lab.offered_terms(registry);
    if !options.contains(&lab.view.terms) {
        options.push(lab.view.terms);
    }
    if options.len() == 1 {
        return;
    }
    ui.horizontal(|ui| {
        ui.set_min_height(30.0);
        ui.label(theme::small(ui, "show"));
        let chosen = options.iter().position(|t| *t == lab.view.terms);
        let names: Vec<_> = options.iter().map(|t| t.id()).collect();
        let tip = |ui: &mut Ui, i: usize| {
            ui.label(match options[i] {
                TermSelection::All => "The whole equation.".to_owned(),
                other => format!("The {} term alone, the others as if they were 0.", other.id()),
            });
            ui.label(theme::small(ui, "key T goes through them"));
        };
        if let Some(i) = segmented(ui, "Terms", &names, chosen, tip) {
            actions.push(Action::View(ViewChange::Terms(options[i])));
        }
    });
    ui.add_space(4.0);
}

/// The stage that evaluates the model: a picture and the words.
fn stage(ui: &mut Ui, mode: &ModeEntry) {
    let d = mode.declaration;
    let palette = Palette::here(ui);
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(48.0, 42.0), Sense::hover());
        icon::stage(ui.painter(), rect, d.stage, &palette);
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            ui.label(theme::strong(ui, format!("computed {}", d.stage.phrase())));
            ui.label(theme::small(ui, format!("{} shading · {}", d.name, d.author)));
        });
    })
    .response
    .on_hover_ui(|ui| {
        ui.set_max_width(320.0);
        ui.label(d.summary);
        ui.label(theme::small(ui, d.source));
    });
    ui.add_space(6.0);
}

// ── light ──

fn light(ui: &mut Ui, lab: &Lab, registry: &Registry, i: usize, actions: &mut Vec<Action>) {
    let Some(light) = lab.document.lights.get(i) else { return };
    let set = |field: LightField| Action::Edit(Edit::Light(i, field));
    header(ui, lab, registry, Selection::Light(i), light.name.as_deref(), actions);
    let kinds: Vec<_> = registry.lights().iter().map(|l| l.declaration).collect();
    let names: Vec<_> = kinds.iter().map(|d| d.name).collect();
    let chosen = registry.light_index(&light.kind).map(|k| k as usize);
    section(ui, "Light", true, |ui| {
        let help = chosen.map_or("", |k| kinds[k].summary);
        let caption = Caption { label: "type", help, ..Caption::default() };
        if let Some(k) = knob::choice_knob(ui, "type", &caption, chosen.unwrap_or(usize::MAX), &names) {
            actions.push(set(LightField::Kind(kinds[k].id.to_owned())));
        }
        let Some(kind) = registry.light(&light.kind) else {
            ui.label("This type of light is not known here; choose another one.");
            return;
        };
        let d = kind.declaration;
        if !d.summary.is_empty() {
            ui.add(egui::Label::new(theme::small(ui, d.summary)).wrap());
        }
        let part = [EquationPart { term: Term::Total, text: d.equation }];
        maths::equation(ui, &part, |symbol| match symbol {
            "I" => Some("the intensity of the light".to_owned()),
            other => maths::meaning(other).map(str::to_owned),
        });
        actions.extend(brightness(ui, light, kind).map(set));
        actions.extend(light_colour(ui, light).map(set));
        for p in d.parameters {
            let unused = usage::unused(d.parameters, p, &light.parameters);
            if let Some(v) = knob::parameter_knob(ui, p.name, p, &light.parameters.get(p), unused.as_deref())
            {
                actions.push(set(LightField::Parameter(p.name, v)));
            }
        }
    });
    if light.position.is_some() || light.direction.is_some() {
        section(ui, "Position", true, |ui| {
            if let Some(position) = light.position {
                let caption = Caption {
                    label: "position",
                    unit: "m",
                    help: "Position of the light; y is up, the origin is a corner of the room.",
                    ..Caption::default()
                };
                if let Some(p) = knob::vector_knob(
                    ui,
                    "position",
                    &caption,
                    position,
                    &position_limits(lab.document.scene_size),
                ) {
                    actions.push(set(LightField::Position(p)));
                }
            }
            if let Some(direction) = light.direction
                && let Some(d) = direction_knob(
                    ui,
                    direction,
                    "Direction in which the light shines; its length does not matter.",
                )
            {
                actions.push(set(LightField::Direction(d)));
            }
        });
    }
}

/// How bright a light is: its intensity, or, for types that have one, its luminous flux.
fn brightness(ui: &mut Ui, light: &Light, kind: &LightEntry) -> Option<LightField> {
    let d = kind.declaration;
    let intensity = f64::from(light.intensity_as(kind));
    let caption = Caption {
        symbol: "I",
        label: "intensity",
        unit: d.unit,
        help: unit_help(d.unit),
        ..Caption::default()
    };
    let default = f64::from(d.default_intensity);
    let limits = limits::intensity(d);
    let Some(solid_angle) = kind.solid_angle(&light.parameters) else {
        let new = knob::number_knob(ui, "intensity", &caption, intensity, Some(default), &limits);
        return new.map(|v| LightField::Intensity(v as f32));
    };
    // Rounded where it is converted, to what can be told apart.
    let flux = light.luminous_flux.map_or_else(|| limits::significant(intensity * solid_angle, 6), f64::from);
    let as_flux = light.luminous_flux.is_some();
    let rounded = |v: f64| limits::number(limits::significant(v, 4));
    let conversion = if as_flux {
        format!("I = Φ / ({} sr) = {} cd", rounded(solid_angle), rounded(intensity))
    } else {
        format!("Φ = I · {} sr = {} lm", rounded(solid_angle), rounded(flux))
    };
    maths::equation_of(ui, &[(Term::Total, &conversion)], |symbol| match symbol {
        "I" => Some("the intensity of the light: what it sends into each direction".to_owned()),
        "Φ" => Some("the luminous flux: what it sends out in all directions together".to_owned()),
        _ => None,
    });
    let mut other_unit = None;
    let units = [["cd", "candela"], ["lm", "lumen"]];
    let beside = |ui: &mut Ui| other_unit = knob::unit_choice(ui, usize::from(as_flux), &units);
    let out = if as_flux {
        let caption =
            Caption { symbol: "Φ", label: "luminous flux", unit: "lm", help: unit_help("lm"), ..caption };
        let default = limits::significant(default * solid_angle, 3);
        let limits = limits::luminous_flux(d);
        knob::number_knob_beside(ui, "flux", &caption, flux, Some(default), &limits, beside)
            .map(|v| LightField::LuminousFlux(v as f32))
    } else {
        knob::number_knob_beside(ui, "intensity", &caption, intensity, Some(default), &limits, beside)
            .map(|v| LightField::Intensity(v as f32))
    };
    match other_unit {
        Some(0) => Some(LightField::Intensity(limits::significant(intensity, 6) as f32)),
        Some(_) => Some(LightField::LuminousFlux(flux as f32)),
        None => out,
    }
}

/// The colour of a light: sRGB, or the temperature of a black body.
fn light_colour(ui: &mut Ui, light: &Light) -> Option<LightField> {
    let mut out = None;
    ui.horizontal(|ui| {
        ui.set_min_height(30.0);
        ui.label(theme::small(ui, "Colour from"));
        let chosen = usize::from(light.colour_temperature.is_some());
        let tip = |ui: &mut Ui, i: usize| {
            ui.label(if i == 0 {
                "Red, green and blue, as on a display."
            } else {
                "The temperature of a black body that glows in this colour."
            });
        };
        match segmented(ui, "Colour by", &["RGB", "temperature"], Some(chosen), tip) {
            Some(0) => out = Some(LightField::Colour(light.rgb8())),
            Some(_) => {
                out = Some(LightField::ColourTemperature(temperature::nearest_temperature(light.colour)))
            }
            None => {}
        }
        if light.colour_temperature.is_some() {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add_space(22.0);
                knob::colour_sample(ui, light.rgb8());
            });
        }
    });
    let field = match light.colour_temperature {
        Some(kelvin) => {
            let caption = Caption {
                symbol: "T",
                label: "colour temperature",
                unit: "K",
                help: "The colour of a black body of this temperature: a candle has 1900 K, a light bulb 2700 K, the \
                       midday sun about 5500 K, a blue sky 10 000 K and more; 6500 K is white. How bright the \
                       light is does not change.",
                ..Caption::default()
            };
            let default = Some(f64::from(temperature::WHITE_TEMPERATURE));
            let limits = limits::colour_temperature();
            knob::number_knob(ui, "temperature", &caption, f64::from(kelvin), default, &limits)
                .map(|v| LightField::ColourTemperature(v as f32))
        }
        None => {
            let caption = Caption {
                label: "colour",
                unit: "sRGB",
                help: "The colour of the light; white leaves the materials as they are.",
                ..Caption::default()
            };
            knob::colour_knob(ui, "colour", &caption, light.colour, Some([255; 3])).map(LightField::Colour)
        }
    };
    out.or(field)
}

fn unit_help(unit: &str) -> &'static str {
    match unit {
        "cd" => "In candela: the light sent into each direction. At 1 m, 1 cd gives an illuminance of 1 lx.",
        "lm" => "In lumen: the light sent out in all directions together, as printed on light bulbs.",
        "lx" => "In lux: the light that arrives on a surface that faces it.",
        _ => "How strong the light is.",
    }
}

// ── observer ──

fn observer(ui: &mut Ui, lab: &Lab, actions: &mut Vec<Action>) {
    let o = lab.document.observer;
    let set = |o: Observer| Action::Edit(Edit::Observer(o));
    ui.label(RichText::new("Observer").heading());
    ui.label(theme::small(ui, "The camera of the scene"));
    ui.add_space(6.0);
    section(ui, "Position", true, |ui| {
        let caption = Caption {
            label: "position",
            unit: "m",
            help: "Position of the eye; y is up, the origin is a corner of the room.",
            ..Caption::default()
        };
        if let Some(position) =
            knob::vector_knob(ui, "position", &caption, o.position, &position_limits(lab.document.scene_size))
        {
            actions.push(set(Observer { position, ..o }));
        }
        if let Some(direction) =
            direction_knob(ui, o.direction, "Viewing direction; its length does not matter.")
        {
            actions.push(set(Observer { direction, ..o }));
        }
        let caption = Caption {
            label: "field of view",
            unit: "°",
            help: "The angle between the lower and the upper edge of the picture.",
            ..Caption::default()
        };
        let default = Some(f64::from(crate::scene::DEFAULT_FIELD_OF_VIEW));
        if let Some(v) = knob::number_knob(
            ui,
            "field of view",
            &caption,
            f64::from(o.field_of_view),
            default,
            &limits::field_of_view(),
        ) {
            actions.push(set(Observer { field_of_view: v as f32, ..o }));
        }
        ui.horizontal_wrapped(|ui| {
            if ui.button("View as observer").on_hover_text("Move the camera to the observer (H)").clicked() {
                actions.push(Action::HomeView);
            }
            if ui
                .button("Set observer to this view")
                .on_hover_text("Make the place of the camera that of the observer")
                .clicked()
            {
                actions.push(Action::ObserverFromView);
            }
        });
    });
}

// ── room and display ──

fn room(ui: &mut Ui, lab: &Lab, registry: &Registry, actions: &mut Vec<Action>) {
    let width = ui.available_width();
    let s = &lab.document;
    text_field(
        ui,
        "scene name",
        "Name of the scene",
        s.name.as_deref().unwrap_or_default(),
        "Untitled scene",
        width,
        true,
        |text| {
            actions.push(Action::Edit(Edit::SceneName(text)));
        },
    );
    ui.add_space(4.0);
    text_field(
        ui,
        "description",
        "What the scene shows",
        s.description.as_deref().unwrap_or_default(),
        "What the scene shows, in one line",
        width,
        false,
        |text| {
            actions.push(Action::Edit(Edit::SceneDescription(text)));
        },
    );
    ui.add_space(6.0);
    section(ui, "Room", true, |ui| {
        let size = s.scene_size;
        let caption = Caption {
            label: "size",
            unit: "m",
            help: "Width along x, height along y, depth along z. One corner of the room is the origin; everything stands in it.",
            ..Caption::default()
        };
        let limits = [0, 1, 2].map(|axis| lab.document.dimension_limits(axis, registry));
        if let Some(c) = knob::vector_knob(ui, "size", &caption, size.corner(), &limits) {
            actions.push(Action::Edit(Edit::SceneSize(SceneSize { width: c.x, height: c.y, depth: c.z })));
        }
    });
    section(ui, "Display", true, |ui| {
        let d = s.display;
        let set = |d: Display| Action::Edit(Edit::Display(d));
        let caption = Caption {
            label: "exposure",
            unit: "EV",
            help: "Each EV doubles the brightness of the picture, as a stop of a camera does.",
            ..Caption::default()
        };
        if let Some(v) =
            knob::number_knob(ui, "exposure", &caption, f64::from(d.exposure), Some(0.0), &limits::exposure())
        {
            actions.push(set(Display { exposure: v as f32, ..d }));
        }
        let told: Vec<_> = ToneMapping::ALL.iter().map(|t| [t.name(), t.author(), t.summary()]).collect();
        let chosen = ToneMapping::ALL.iter().position(|t| *t == d.tone_mapping).unwrap_or(0);
        let caption = Caption {
            label: "tone mapping",
            help: "How light brighter than the display can show is brought into its range. None: it is cut off, and values stay comparable.",
            ..Caption::default()
        };
        if let Some(i) = knob::told_choice_knob(ui, "tone mapping", &caption, chosen, &told) {
            actions.push(set(Display { tone_mapping: ToneMapping::ALL[i], ..d }));
        }
        let names: Vec<_> = Encoding::ALL
            .iter()
            .map(|e| match e {
                Encoding::Srgb => "sRGB",
                Encoding::Off => "off (gamma-naive)",
            })
            .collect();
        let chosen = Encoding::ALL.iter().position(|e| *e == d.encoding).unwrap_or(0);
        let caption = Caption {
            label: "encoding",
            help: "sRGB: colours are decoded to linear light, the picture is encoded for the display. Off: neither; deliberately wrong, for comparison.",
            ..Caption::default()
        };
        if let Some(i) = knob::choice_knob(ui, "encoding", &caption, chosen, &names) {
            actions.push(set(Display { encoding: Encoding::ALL[i], ..d }));
        }
    });
    let objects = s.objects.len();
    let own = s.objects.iter().filter(|o| o.reflection_model.is_some() || o.shading_model.is_some()).count();
    ui.add_space(8.0);
    let text = format!("{} · {}", plural(s.lights.len(), "light"), plural(objects, "object"));
    let text = if own > 0 { format!("{text}, {own} with an override of model or shading") } else { text };
    ui.add(egui::Label::new(theme::small(ui, text)).wrap());
}
