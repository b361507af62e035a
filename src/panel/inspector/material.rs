//! The knobs of a material, in the groups of its model; all of them, or only those that differ from their defaults.

use bevy_egui::egui::{CollapsingHeader, TextFormat, text::LayoutJob};

use super::{measured::measured, object::ObjectPanel, part::knob_of, variant::marked};
use crate::{
    panel::{
        knob,
        lesson::point,
        prelude::*,
        state::{Effect, Pick},
    },
    parameter::{Parameter, Value},
    reflection::{ModelEntry, ungrouped},
    scene::Key,
    shading::ShadingEntry,
};

impl ObjectPanel<'_> {
    /// The knobs of the parameters of the model, and the parameters that it does not use.
    pub(super) fn material(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let Self { session, registry, part, object, model, .. } = *self;
        let Some(model) = model else {
            ui.label(theme::small(ui, "The parameters come back with the model."));
            return;
        };
        if let Some(values) = measured(ui, registry, model, object) {
            context.edit(Edit::materials(part, values, "Measured material"));
        }
        let listed = self.listed(ui, model);
        self.filter(ui, model, context);
        let mut knob = |ui: &mut Ui, p: &'static Parameter| {
            let key = Key::Material(p.name);
            if let Value::File(file) = object.material.get(p) {
                let asked = marked(ui, key, context, |ui| knob::file_knob(ui, p, &file, self.fixed(key)));
                if let Part::Object(i) = part
                    && asked
                {
                    context.act(Action::Do(Effect::Pick(Pick::File(Selection::Object(i), key, p))));
                }
                return;
            }
            let value = marked(ui, key, context, |ui| {
                let fixed = self.fixed(key);
                knob_of(ui, p.name, p, (model.parameters, &object.material), fixed)
            });
            context.edits(value.map(|v| Edit::material(part, p.name, v)));
        };
        for p in ungrouped(model.groups, model.parameters).filter(|p| listed.contains(&p.name)) {
            knob(ui, p);
        }
        for group in model.groups {
            let all: Vec<_> = group.of(model.parameters).collect();
            let shown: Vec<_> = all.iter().copied().filter(|p| listed.contains(&p.name)).collect();
            if shown.is_empty() {
                continue;
            }
            let changed = all.iter().filter(|p| self.differs(p)).count();
            let sought = all.iter().any(|p| point::at_knob(ui, p.name));
            group_of_knobs(ui, group.name, changed, sought, |ui| shown.into_iter().for_each(|p| knob(ui, p)));
        }
        if model.parameters.is_empty() {
            ui.label(theme::small(ui, "This model has no knobs."));
        } else if listed.is_empty() {
            ui.label(theme::small(ui, "Every parameter has its default."));
        }
        let shading = registry.shading_model(session.scene().shading_model_of(object));
        if let Some(shading) = shading {
            self.shading(ui, model, shading, context);
        }
        self.readouts(ui, model);
        self.unused(ui, model, shading);
    }

    /// The parameters that have values, but neither the model nor the shading model uses.
    fn unused(&self, ui: &mut Ui, model: &ModelEntry, shading: Option<&ShadingEntry>) {
        let values = &self.object.material;
        let unused = |p: &&'static Parameter| {
            model.parameter(p.name).is_none()
                && values.0.contains_key(p.name)
                && shading.is_none_or(|s| s.parameter(p.name).is_none())
        };
        let unused: Vec<_> = self.registry.material_parameters().filter(unused).collect();
        if unused.is_empty() {
            return;
        }
        let reason = format!("Not used by {}", model.declaration.name);
        ui.add_space(4.0);
        ui.label(theme::small(ui, format!("{reason} (values kept)")));
        ui.add_space(2.0);
        for p in unused {
            knob::parameter_knob(ui, p.name, p, &values.get(p), Some(&reason));
        }
    }

    /// True if a parameter of the model does not have its default.
    fn differs(&self, p: &Parameter) -> bool {
        self.object.material.get(p) != p.default_value()
    }

    /// The names of the parameters that have knobs. With the filter, what is being changed stays when it reaches its
    /// default.
    fn listed(&self, ui: &Ui, model: &ModelEntry) -> Vec<&'static str> {
        let memory = Id::new(("knobs that are shown", self.session.selection, model.declaration.id));
        let kept: Vec<&'static str> = ui.data(|d| d.get_temp(memory)).unwrap_or_default();
        let busy = ui.input(|i| i.pointer.any_down()) || ui.memory(|m| m.focused()).is_some();
        let filters = self.session.view.only_changed && !model.groups.is_empty();
        let shown = |p: &&Parameter| {
            !filters || self.differs(p) || busy && kept.contains(&p.name) || point::at_knob(ui, p.name)
        };
        let listed: Vec<_> = model.parameters.iter().filter(shown).map(|p| p.name).collect();
        ui.data_mut(|d| d.insert_temp(memory, listed.clone()));
        listed
    }

    /// The switch between all parameters and those that differ, for models with groups: they have many.
    fn filter(&self, ui: &mut Ui, model: &ModelEntry, context: &mut PanelContext<'_>) {
        if model.groups.is_empty() {
            return;
        }
        let on = self.session.view.only_changed;
        let changed = model.parameters.iter().filter(|p| self.differs(p)).count();
        ui.horizontal(|ui| {
            ui.label(theme::small(ui, format!("{} changed", plural(changed, "parameter"))));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let text = RichText::new("Only changed").text_style(TextStyle::Small);
                let help = "Show the knobs of those parameters alone that differ from their defaults";
                let button = ui.add(Button::new(text).selected(on)).on_hover_text(help);
                context.on_click(&button, || Action::View(ViewChange::OnlyChanged(!on)));
            });
        });
    }
}

/// A group of knobs below its heading, which folds it; unfolded if one of them is `sought`.
pub(super) fn group_of_knobs(
    ui: &mut Ui,
    name: &'static str,
    changed: usize,
    sought: bool,
    add: impl FnOnce(&mut Ui),
) {
    CollapsingHeader::new(heading(ui, name, changed))
        .id_salt(("group", name))
        .default_open(true)
        .open(sought.then_some(true))
        .show_unindented(ui, add);
}

/// The heading of a group: its name, and how many of its parameters differ from their defaults.
fn heading(ui: &Ui, name: &str, changed: usize) -> LayoutJob {
    let palette = Palette::here(ui);
    let mut job = LayoutJob::default();
    let body = FontId::new(TextStyle::Body.resolve(ui.style()).size, theme::semibold());
    let small = TextStyle::Small.resolve(ui.style());
    job.append(name, 0.0, TextFormat::simple(body, palette.text));
    if changed > 0 {
        job.append(&format!("{changed} changed"), 8.0, TextFormat::simple(small, palette.weak));
    }
    job
}
