//! The model and the shading of a single object in place of the scene's: a button beside the model's name, and a note
//! at the top.

use super::{chooser, knob, prelude::*, segmented::segmented};
use crate::{
    scene::{Field, Object},
    text::capitalised,
};

/// Width of the frame rate, in points.
const RATE: f32 = 96.0;

/// Notes that the choices at the top apply to the selected object only, if it overrides the scene's model or shading.
pub(super) fn whose(ui: &mut Ui, session: &Session, registry: &Registry) {
    let several = session.model_of(registry).filter(|_| session.is_in_group(session.selection));
    let what = match (session.model_override().is_some(), session.shading_override().is_some()) {
        _ if several.is_some() => "reflection",
        (true, true) => "reflection and shading",
        (true, false) => "reflection",
        (false, true) => "shading",
        (false, false) => return,
    };
    let palette = Palette::here(ui);
    ui.add_space(6.0);
    let name = several.clone().unwrap_or_else(|| session.name_of(session.selection, registry));
    let text = match &several {
        Some(name) => format!("{what} of {name}"),
        None => format!("“{name}” overrides {what}"),
    };
    // The frame rate keeps its place if there is room for both.
    let all = ui.available_width();
    let room = if all - RATE >= 40.0 { all - RATE } else { all };
    if room < 20.0 {
        return;
    }
    let short = if several.is_some() { &name } else { "override" };
    let shown = if theme::small_width(ui, &text) <= room { &text } else { short };
    let galley = theme::elided(ui, shown, TextStyle::Small, palette.accent, room);
    let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
    ui.painter().galley(rect.min, galley, palette.accent);
    theme::says(&response, WidgetType::Label, &text);
    theme::tip(response, 320.0, |ui| {
        if several.is_some() {
            ui.label(format!("The choice of a reflection model here changes {name}, which are selected."));
            return;
        }
        ui.label(format!(
            "{name} has its own {what}, so the choice here changes that of {name} alone. At the end of the \
             panel at the right it can be made to follow the scene again."
        ));
        let scene = session.scene();
        let model = registry.model(&scene.reflection_model).map_or("–", |m| m.declaration.name);
        let shading = registry.shading_model(&scene.shading_model).map_or("–", |m| m.declaration.name);
        ui.label(theme::small(ui, format!("The scene: {model}, {shading} shading")));
    });
}

/// A field of an object, and the id that it gets.
type Override = (Field, Option<&'static str>);

/// The button and its popup; `fixed` is the reason why it cannot be used. Returns the requested change.
pub fn control(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    object: &Object,
    fixed: Option<&str>,
) -> Option<Override> {
    let palette = Palette::here(ui);
    let own = (object.reflection_model.as_deref().map(|id| model_name(id, registry)).into_iter())
        .chain(object.shading_model.as_deref().map(|id| format!("{} shading", shading_name(id, registry))))
        .collect::<Vec<_>>();
    let (word, colour) =
        if own.is_empty() { ("Override", palette.weak) } else { ("Overridden", palette.accent) };
    let text = |text: &str| RichText::new(text).small().color(colour);
    let button = ui.add_enabled(fixed.is_none(), Button::new(text(word)).right_text(text("▾")));
    let said = if own.is_empty() { "none".to_owned() } else { own.join(", ") };
    let name = format!("Override model and shading: {said}");
    button.widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, fixed.is_none(), name.clone()));
    let id = ui.make_persistent_id("model override");
    let out = knob::drop_down(&button, id, knob::WIDE, |ui, list| {
        let scene_model = model_name(&session.scene().reflection_model, registry);
        let scene_shading = shading_name(&session.scene().shading_model, registry);
        ui.label(theme::strong(ui, "Override model and shading"));
        let text = format!("Of this object alone; the scene has {scene_model} and {scene_shading} shading.");
        ui.label(theme::small(ui, text));
        ui.add_space(4.0);
        let shading = shading(ui, object, &scene_shading, registry);
        ui.add_space(6.0);
        let own = object.reflection_model.as_deref();
        let height = 0.45 * ui.ctx().content_rect().height();
        let first = format!("Scene default ({scene_model})");
        let model = chooser::models(ui, list, height, session, registry, own, Some(&first));
        let model = model.map(|model| {
            Popup::close_id(ui.ctx(), id);
            (Object::reflection_model, model.map(|m| m.declaration.id))
        });
        model.or(shading)
    });
    let button = match fixed {
        Some(why) => button.on_disabled_hover_text(format!("{}.", capitalised(why))),
        None => button,
    };
    theme::tip(button, 300.0, |ui| {
        ui.label(theme::strong(ui, "Override model and shading"));
        ui.label(if own.is_empty() {
            "Give this object a reflection model or a shading of its own, whatever the scene has.".to_owned()
        } else {
            format!("This object has {}, not what the scene has.", own.join(" and "))
        });
    });
    out
}

fn model_name(id: &str, registry: &Registry) -> String {
    registry.model(id).map_or(id, |m| m.declaration.name).to_owned()
}

fn shading_name(id: &str, registry: &Registry) -> String {
    registry.shading_model(id).map_or(id, |m| m.declaration.name).to_owned()
}

/// The choice of an object's shading model, or of the scene's.
fn shading(ui: &mut Ui, object: &Object, scene: &str, registry: &Registry) -> Option<Override> {
    let all: Vec<_> = registry.shading_models().iter().map(|m| m.declaration).collect();
    let names: Vec<_> = ["Scene default"].into_iter().chain(all.iter().map(|d| d.name)).collect();
    let of = |id: &String| all.iter().position(|d| d.id == id).map(|k| k + 1);
    let chosen = object.shading_model.as_ref().map_or(Some(0), of);
    let tip = |ui: &mut Ui, i: usize| {
        ui.set_max_width(300.0);
        match i.checked_sub(1) {
            Some(k) => ui.label(all[k].summary),
            None => ui.label(format!("The shading of the scene: {scene}.")),
        };
    };
    let i = segmented(ui, "Shading of this object", &names, chosen, tip)?;
    Some((Object::shading_model, i.checked_sub(1).map(|k| all[k].id)))
}
