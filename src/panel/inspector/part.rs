//! Widgets that all parts of the scene share: headings, groups, text fields, knobs for positions and directions.

use bevy_egui::egui::{CollapsingHeader, TextEdit};

use crate::{
    panel::{
        keys,
        knob::{self, Amount, Caption},
        lesson::point,
        narrow,
        prelude::*,
        state::Effect,
    },
    parameter::{Parameter, Value, Values},
    reflection::usage,
    scene::{Field, Light, SceneSize, field::Kind, limits},
};

/// A group with a heading; folds.
pub(super) fn section(ui: &mut Ui, title: &str, open: bool, add: impl FnOnce(&mut Ui)) {
    ui.add_space(4.0);
    let line = ui.available_rect_before_wrap();
    ui.painter().hline(line.x_range(), line.top(), Stroke::new(1.0, Palette::here(ui).line));
    ui.add_space(4.0);
    let heading = theme::strong(ui, title);
    ui.scope(|ui| {
        ui.spacing_mut().indent = 16.0;
        ui.visuals_mut().indent_has_left_vline = false;
        let heading = CollapsingHeader::new(heading).id_salt(title).default_open(open);
        heading.open(point::seeks(ui).then_some(true)).show_unindented(ui, |ui| {
            ui.add_space(2.0);
            add(ui);
        });
    });
}

/// The name of a part, and buttons that focus, duplicate and delete it.
pub(super) fn header(ui: &mut Ui, part: Selection, own: Option<&str>, context: &mut PanelContext<'_>) {
    let name = context.session().name_of(part, context.registry());
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        let width = ui.available_width() - 76.0;
        let own = own.unwrap_or_default();
        text_field(ui, "name", "Name", own, &name, width, Text::Heading, |text| {
            context.edit(Edit::set(part.into(), Light::name, text));
        });
        // At the right edge, and for the Tab key in this order.
        let buttons = 3.0 * icon::SIZE + 2.0 * ui.spacing().item_spacing.x;
        ui.add_space(ui.available_width() - buttons);
        let look = keys::hint(ui.ctx(), &format!("Look at {name} "), "focus");
        context.on_click(&icon::button(ui, Icon::Target, &look), || Action::Do(Effect::FocusSelection));
        if icon::button(ui, Icon::Duplicate, &format!("Duplicate {name}")).clicked() {
            context.act(Action::Duplicate(part));
        }
        if icon::button(ui, Icon::Bin, &format!("Delete {name}")).clicked() {
            context.act(Action::Remove(part));
        }
    });
    ui.add_space(4.0);
}

/// The content of a field for text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Text {
    /// A name, in the size of headings.
    Heading,
    /// A name, in the size of labels.
    Name,
    /// Sentences, in as many lines as they need.
    Sentences,
}

/// A field for text; the change counts when the field is left, which Enter does.
pub(super) fn text_field(
    ui: &mut Ui,
    salt: &str,
    label: &str,
    value: &str,
    hint: &str,
    width: f32,
    kind: Text,
    mut set: impl FnMut(String),
) {
    let palette = Palette::here(ui);
    let id = ui.make_persistent_id(salt);
    let draft_id = id.with("draft");
    let mut text: String = ui.data(|d| d.get_temp(draft_id)).unwrap_or_else(|| value.to_owned());
    let focused = ui.memory(|m| m.has_focus(id));
    // A stroke of another width would move what stands below.
    let stroke = Stroke::new(1.0, if focused { palette.accent } else { palette.line });
    let frame = egui::Frame::new().fill(palette.field).stroke(stroke).corner_radius(4.0);
    let (edit, style) = match kind {
        Text::Heading => (TextEdit::singleline(&mut text), TextStyle::Heading),
        Text::Name => (TextEdit::singleline(&mut text), TextStyle::Body),
        Text::Sentences => (TextEdit::multiline(&mut text).desired_rows(2).return_key(None), TextStyle::Body),
    };
    let edit = edit
        .id(id)
        .font(style.clone())
        .hint_text(RichText::new(hint).text_style(style))
        .desired_width(width - 14.0)
        .min_size(vec2(0.0, narrow::high(ui.ctx(), 0.0)))
        .vertical_align(if kind == Text::Sentences { Align::Min } else { Align::Center })
        .frame(frame.inner_margin(egui::Margin::symmetric(6, 3)));
    let response = ui.add(edit);
    theme::names_field(&response, label, [value, &text, hint]);
    if kind == Text::Sentences && response.has_focus() && ui.input(|i| i.key_pressed(Key::Enter)) {
        response.surrender_focus();
    }
    if response.changed() {
        ui.data_mut(|d| d.insert_temp(draft_id, text.clone()));
    }
    if response.lost_focus() {
        ui.data_mut(|d| d.remove::<String>(draft_id));
        if !ui.input(|i| i.key_pressed(Key::Escape)) && text.trim() != value {
            set(text);
        }
    }
    // A name may be longer than its field.
    response.on_hover_text(if kind != Text::Sentences && !value.is_empty() { value } else { label });
}

/// The knob of a vector of a part.
pub(super) fn vector(ui: &mut Ui, part: Part, field: Field, value: Vec3, room: SceneSize) -> Option<Edit> {
    let limits = [0, 1, 2].map(|axis| match field.kind {
        Kind::Position => limits::position(room, axis),
        _ => field.limits(),
    });
    knob::vector_knob(ui, &Caption::of(&field), value, &limits).map(|v| Edit::set(part, field, v))
}

/// The knob of a number of a part, with its default.
pub(super) fn number(ui: &mut Ui, part: Part, field: Field, [value, default]: [f32; 2]) -> Option<Edit> {
    let limits = field.limits();
    let amount = Amount::new(value.into(), Some(default.into()), &limits);
    knob::number_knob(ui, &Caption::of(&field), amount).map(|v| Edit::set(part, field, v as f32))
}

/// The choice of a type from the id, name and summary of each. Returns the id of another one. `fixed` is the reason why it
/// cannot be changed.
pub(super) fn type_knob<'t>(
    ui: &mut Ui,
    types: impl Iterator<Item = [&'t str; 3]>,
    id: &str,
    fixed: Option<&str>,
) -> Option<&'t str> {
    let types: Vec<_> = types.collect();
    let names: Vec<_> = types.iter().map(|[_, name, _]| *name).collect();
    let chosen = types.iter().position(|[known, ..]| *known == id);
    let caption = Caption { disabled: fixed, ..Caption::new("type", "", chosen.map_or("", |k| types[k][2])) };
    knob::choice_knob(ui, &caption, chosen.unwrap_or(usize::MAX), &names).map(|k| types[k][0])
}

/// The knob of a declared parameter of a part with these values; disabled if they leave it unused, or for the reason `fixed`.
pub(super) fn knob_of(
    ui: &mut Ui,
    salt: &str,
    parameter: &Parameter,
    (all, values): (&[Parameter], &Values),
    fixed: Option<&str>,
) -> Option<Value> {
    let unused = usage::unused(all, parameter, values);
    knob::parameter_knob(ui, salt, parameter, &values.get(parameter), fixed.or(unused.as_deref()))
}
