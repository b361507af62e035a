//! The reflection model of an object: its name, its equation, the stage that evaluates it.

use crate::{
    optics::TermSelection,
    panel::{
        chooser, keys,
        lesson::point,
        maths,
        prelude::*,
        segmented::{segment_width, segmented},
        shader,
        state::{CodeCommand, SHADER_TAB},
    },
    reflection::{EquationPart, ModelEntry, Passage},
    scene::{Object, shines_from_everywhere},
    shading::ShadingEntry,
    text::facts,
};

/// The name of a model; the whole story is the tooltip.
pub(super) fn model_name(ui: &mut Ui, model: &ModelEntry) {
    let name = model.declaration.name;
    let name = theme::elided(ui, name, TextStyle::Heading, Palette::here(ui).text, ui.available_width());
    ui.label(name).on_hover_ui(|ui| about(ui, model));
}

/// The button that opens the code of a model in the panel *Code*; for a built-in one it offers to copy the model as a
/// file.
pub(super) fn edit_code(ui: &mut Ui, id: &str, context: &mut PanelContext<'_>) {
    let button = ui.small_button("Edit code");
    let help = "Opens the code of this model in the panel Code; a built-in one is first copied as a file.";
    // The key is for the model at the top of the window, which need not be that of this object.
    context.on_click(&button.on_hover_text(help), || Action::Code(CodeCommand::ModelOf(id.to_owned())));
}

/// The authors and the year, below the name.
pub(super) fn model_author(ui: &mut Ui, model: &ModelEntry) {
    let author = model.declaration.author;
    if !author.is_empty() {
        theme::note(ui, author).on_hover_ui(|ui| about(ui, model));
    }
}

fn about(ui: &mut Ui, model: &ModelEntry) {
    ui.set_max_width(320.0);
    chooser::about(ui, model);
}

/// The replacement for a model that is missing: its file is gone, or never worked.
pub(super) fn missing_model(ui: &mut Ui, id: &str, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        icon::sign(ui, [16.0, 20.0], 6.0, Severity::Error);
        ui.vertical(|ui| {
            ui.add(Label::new(shader::missing_model(session, registry, id)).wrap().selectable(true));
            ui.horizontal_wrapped(|ui| {
                let button = ui.button("Choose another model");
                context.on_click(&button, || Action::View(ViewChange::Chooser(true)));
                if !session.shaders.troubles.is_empty() && ui.button("Show the error").clicked() {
                    context.act(Action::View(ViewChange::BottomTab(SHADER_TAB.to_owned())));
                }
            });
        });
    });
    ui.add_space(6.0);
}

/// The parts of the equation of an object with a model. A knob that makes it transparent adds some only once the pointer
/// lets go of it: no knob may move under the hand.
pub(super) fn parts(ctx: &Context, model: &ModelEntry, object: &Object) -> Vec<EquationPart> {
    let (id, name) = (Id::new("passage of the equation"), model.declaration.id);
    let held = ctx.input(|i| i.pointer.any_down());
    let known = ctx.data(|d| d.get_temp::<(&'static str, Passage)>(id));
    let known = known.filter(|(of, _)| held && *of == name).map(|(_, passage)| passage);
    let passage = known.unwrap_or_else(|| model.passage(&object.material));
    ctx.data_mut(|d| d.insert_temp(id, (name, passage)));
    model.declaration.equation_of(passage)
}

/// These parts of the equation of a model.
pub(super) fn equation(ui: &mut Ui, model: &ModelEntry, parts: &[EquationPart]) {
    // Custom models need not declare one.
    if parts.is_empty() {
        return;
    }
    maths::equation(ui, parts, |symbol| meaning(model, symbol));
    ui.add_space(4.0);
}

/// The meaning of a symbol in the equation of a model.
pub(in crate::panel) fn meaning(model: &ModelEntry, symbol: &str) -> Option<String> {
    if let Some(p) = model.parameters.iter().find(|p| maths::same_symbol(p.symbol, symbol)) {
        return Some(format!("{}: {}", p.label, p.help));
    }
    let defined =
        maths::definition(model.declaration.equation, symbol).map(|text| format!("defined here: {text}"));
    let mut quantities = model.declaration.quantities.iter();
    let quantity = quantities.find(|quantity| maths::same_symbol(quantity.symbol(), symbol));
    let named = quantity.map(|quantity| format!("{}: {}", quantity.label, quantity.text));
    let defined = defined.or(named);
    let general = maths::meaning(symbol).map(str::to_owned);
    // A letter that the equation uses for something of its own does not mean what it usually does.
    let terms = ["I", "I_a", "I_d", "I_s"];
    if terms.contains(&symbol) { general.or(defined) } else { defined.or(general) }
}

/// The choice of the term that the picture shows, where there is one: among those of the equation above it.
pub(super) fn terms(ui: &mut Ui, parts: &[EquationPart], context: &mut PanelContext<'_>) {
    let session = context.session();
    let written: Vec<_> = parts.iter().filter_map(|p| p.term.alone()).collect();
    let mut options = session.offered_terms(context.registry());
    options.retain(|t| written.is_empty() || *t == TermSelection::All || written.contains(t));
    if options.len() < 3 {
        // One term is the whole equation. Where it has more, the row stays while a knob makes one of them 0: no knob may
        // move under the hand.
        let scene = session.scene();
        let everywhere = shines_from_everywhere(scene.shining(), scene.display.encoding, context.registry());
        options = written;
        options.retain(|t| *t != TermSelection::Ambient || everywhere);
        options.dedup();
        if options.len() == 1 {
            options.clear();
        }
    }
    options.extend([TermSelection::All, session.terms()]);
    let options: Vec<_> = TermSelection::ALL.into_iter().filter(|t| options.contains(t)).collect();
    if options.len() == 1 {
        return;
    }
    let row = ui.horizontal(|ui| {
        ui.set_min_height(30.0);
        let chosen = options.iter().position(|t| *t == session.terms());
        let names: Vec<_> = options.iter().map(|t| t.id()).collect();
        let buttons: f32 = names.iter().map(|name| segment_width(ui, name)).sum();
        // The scroll bar needs some room too.
        if buttons + theme::small_width(ui, "show") + 24.0 < ui.available_width() {
            ui.label(theme::small(ui, "show"));
        }
        let tip = |ui: &mut Ui, i: usize| {
            ui.label(match options[i] {
                TermSelection::All => "The whole equation.".to_owned(),
                other => format!("The {} term alone, the others as if they were 0.", other.id()),
            });
            let key = keys::word(ui.ctx(), "next_term");
            ui.label(theme::small(ui, format!("key {key} goes through them")));
        };
        if let Some(i) = segmented(ui, "Terms", &names, chosen, tip) {
            context.act(Action::View(ViewChange::Terms(options[i])));
        }
    });
    point::button(ui, "terms", row.response.rect);
    ui.add_space(4.0);
}

/// The stage that evaluates the model: a picture and the words.
pub(in crate::panel) fn stage(ui: &mut Ui, shading: &ShadingEntry) {
    let d = shading.declaration;
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(48.0, 42.0), Sense::hover());
        icon::stage(ui.painter(), rect, d.stage, &Palette::here(ui));
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            ui.label(theme::strong(ui, format!("computed {}", d.stage.phrase())));
            // Those of other crates need not name one.
            ui.label(theme::small(ui, facts([&format!("{} shading", d.name), d.author])));
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
