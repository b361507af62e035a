//! The law check in the shader panel: button and findings.

use super::{prelude::*, state::LawCheck};
use crate::{
    reflection::law_report::{LawReport, Sampling, UNDECLARED},
    text::capitalised,
};

/// The button, and a note about a check that runs or is out of date, laid out from right to left.
pub fn button(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let name = |id: &str| registry.model(id).map(|m| m.declaration.name);
    let Some(shown) = name(session.model_shown()) else { return };
    let running = session.authoring.laws.as_ref().filter(|check| check.outcome.is_none());
    let button = ui
        .add_enabled(running.is_none(), Button::new("Check laws"))
        .on_hover_text(format!(
            "Tries to find the laws broken that {shown} claims to keep: reciprocity, conservation of energy, no negative \
             values. Random directions and parameters, on the GPU, in a process of its own."
        ))
        .on_disabled_hover_text("A check is running.");
    context.on_click(&button, || Action::Model(ModelCommand::CheckLaws));
    if let Some(check) = running {
        ui.label(theme::small(ui, format!("Checking {}…", name(&check.model).unwrap_or(&check.model))));
    } else if of_shown(session).is_some_and(|check| check.since != session.shaders.last) {
        ui.label(theme::small(ui, "Findings from before the last change"));
    }
}

/// The check of the current model.
fn of_shown(session: &Session) -> Option<&LawCheck> {
    session.authoring.laws.as_ref().filter(|check| check.model == session.model_shown())
}

/// True if the current model violates a law that it claims, or returns values that are not numbers.
pub fn are_broken(session: &Session) -> bool {
    let outcome = of_shown(session).and_then(|check| check.outcome.as_ref());
    outcome.is_some_and(|found| found.as_ref().is_ok_and(|r| !r.broken().is_empty() || !r.is_finite()))
}

/// The findings about the current model, if any.
pub fn findings(ui: &mut Ui, session: &Session) {
    match of_shown(session).and_then(|check| check.outcome.as_ref()) {
        None => {}
        Some(Err(why)) => {
            line(ui, Some(Severity::Error), &format!("The laws were not checked: {why}"), "", &[])
        }
        Some(Ok(report)) => laws(ui, report),
    }
}

fn laws(ui: &mut Ui, report: &LawReport) {
    for law in &report.laws {
        let severity = match (law.claimed, law.kept) {
            (true, true) if report.is_finite() => None,
            (true, false) => Some(Severity::Error),
            _ => Some(Severity::Info),
        };
        let verdict = report.verdict(law).replace("BROKEN", "broken");
        let how = format!("{}: {}", law.measure, law.size);
        line(ui, severity, &format!("{}: {verdict}", law.law), &how, &law.at);
    }
    let sampling = &report.sampling;
    let how = format!("{}: {}", Sampling::measure(), sampling.error);
    let severity = (!sampling.fits || !report.is_finite()).then_some(Severity::Info);
    line(ui, severity, &format!("lobes for sampling: {}", report.sampling_verdict()), &how, &sampling.at);
    if !report.from_below.is_empty() {
        line(ui, Some(Severity::Info), UNDECLARED, "", &report.from_below);
    }
    if !report.is_finite() {
        let what = format!("NaN or infinite: {} of {} responses", report.not_finite, report.responses);
        line(ui, Some(Severity::Error), &what, "", &report.first_not_finite);
    }
}

/// A finding with its icon: a tick if there is no problem.
fn line(ui: &mut Ui, severity: Option<Severity>, what: &str, how: &str, at: &[String]) {
    let palette = Palette::here(ui);
    let bad = severity == Some(Severity::Error);
    let row = ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(6.0, 1.0);
        match severity {
            Some(severity) => _ = icon::sign(ui, [16.0, 18.0], 5.5, severity),
            None => {
                let (sign, _) = ui.allocate_exact_size(vec2(16.0, 18.0), Sense::hover());
                let (c, r) = (sign.center(), 4.5);
                let tick = vec![c + vec2(-r, 0.0), c + vec2(-0.3 * r, 0.7 * r), c + vec2(r, -0.7 * r)];
                ui.painter().line(tick, Stroke::new(1.6, palette.accent));
            }
        }
        let what = capitalised(what);
        let colour = if bad { palette.error } else { palette.text };
        ui.add(Label::new(RichText::new(what).color(colour)).wrap().selectable(true));
        if !how.is_empty() {
            ui.add(Label::new(theme::small(ui, how)).wrap().selectable(true));
        }
    });
    row.response.on_hover_text(at.join("\n"));
    // The place of a violation helps to fix it.
    for place in at.iter().filter(|_| bad) {
        ui.indent(place, |ui| ui.add(Label::new(theme::small(ui, place)).wrap().selectable(true)));
    }
}
