//! The status line at the bottom: messages, shader errors, the selection.

use super::{
    export, fits, keys, matching, messages, narrow,
    prelude::*,
    state::{Converging, MESSAGES_TAB, SHADER_TAB},
    taking,
};
use crate::{library::status::kind_shown_instead, text::per_cent};

/// The status line.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    if narrow::is(ui.ctx()) {
        ui.horizontal_wrapped(|ui| {
            messages(ui, context);
            news(ui, context);
            latest(ui, 0.0, context);
        });
        return;
    }
    ui.horizontal(|ui| {
        ui.set_min_height(20.0);
        messages(ui, context);
        news(ui, context);
        let name = if session.has_group() {
            session.name_of_group()
        } else {
            session.name_of(session.selection, context.registry())
        };
        let mut selected = format!("{name} selected");
        if let Some(key) = keys::of(ui.ctx(), "keys") {
            selected.push_str(&format!(" · {key} keys"));
        }
        latest(ui, theme::small_width(ui, &selected), context);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add(Label::new(theme::small(ui, selected)).truncate());
        });
    });
}

/// A button of the line: small, but in a narrow window as high as a thumb, and cut at the edge.
fn small(ui: &Ui, text: RichText) -> Button<'static> {
    let button = Button::new(text).frame_when_inactive(false);
    if narrow::is(ui.ctx()) { button.truncate() } else { button.small() }
}

/// The number of messages, as a button that lists them.
fn messages(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let count = session.messages.len();
    let text = match count {
        // A shader error beside it is news, too.
        0 if shows_errors(session) => "Messages".to_owned(),
        0 => "No messages".to_owned(),
        _ => plural(count, "message"),
    };
    let text = theme::small(ui, text);
    match session.messages.worst() {
        Some(worst) => _ = icon::sign(ui, [14.0, 16.0], 5.5, worst),
        None => {
            let (rect, _) = ui.allocate_exact_size(vec2(14.0, 16.0), Sense::hover());
            let icon = if session.view.shows_strip() { Icon::Down } else { Icon::Up };
            icon::paint(ui.painter(), rect.shrink(3.0), icon, Palette::here(ui).weak);
        }
    }
    let says = if session.view.shows_strip() { "Fold the strip away" } else { "Show messages" };
    let says = keys::hint(ui.ctx(), says, "panel.messages");
    let button = ui.add(small(ui, text));
    theme::says(&button, WidgetType::Button, format!("Messages: {count}"));
    context.on_click(&button.on_hover_text(says), || Action::View(session.strip_change()));
}

/// Shader errors, and what is running.
fn news(ui: &mut Ui, context: &mut PanelContext<'_>) {
    shader_errors(ui, context);
    export::progress(ui, context);
    matching::progress(ui, context);
    fits::progress(ui, context);
    taking::progress(ui, context);
    samples(ui, &context.session().facts.converged);
}

/// Convergence of pictures with light with extent: the least converged one in words, with the largest noise of those that
/// still converge, once all of these have one; and one line per view if there are several. `None` while no view has such
/// light.
fn samples_in_words(converged: &[Converging]) -> Option<(String, Vec<String>)> {
    let shown: Vec<_> = converged.iter().enumerate().filter(|(_, view)| view.total > 0).collect();
    let words = |view: Converging| {
        let noise = view.noise.map(|noise| format!(" · noise {}", per_cent(noise))).unwrap_or_default();
        view.samples() + &noise
    };
    let (_, least) = shown.iter().max_by_key(|(_, view)| view.missing())?;
    // A picture that is finished says nothing of those that are not.
    let counts = shown.iter().filter(|(_, view)| view.missing() > 0 || least.missing() == 0);
    let most_noise = counts.map(|(_, view)| view.noise).reduce(|a, b| Some(a?.max(b?))).flatten();
    let lines = shown.iter().filter(|_| shown.len() > 1).map(|(view, converging)| {
        format!("{}: {}", LETTERS.get(*view).copied().unwrap_or_default(), words(**converging))
    });
    Some((words(Converging { noise: most_noise, ..**least }), lines.collect()))
}

/// Shows the convergence of pictures with light with extent.
fn samples(ui: &mut Ui, converged: &[Converging]) {
    let Some((words, lines)) = samples_in_words(converged) else { return };
    ui.add(Label::new(theme::small(ui, words))).on_hover_ui(|ui| {
        ui.set_max_width(320.0);
        ui.label(
            "Light with extent is added up from samples, a few in each frame. The picture is their mean, and nothing more \
             is drawn once it has all. Every change begins anew.",
        );
        ui.label(
            "Noise: how far pixels are from their final value, as the root mean square of their standard errors, over the \
             mean luminance of what is seen. The true error is smaller, by nearly three times in two scenes measured: samples are spread \
             evenly, and the estimate takes them as independent.",
        );
        for line in lines {
            ui.label(line);
        }
    });
}

/// Minimum fraction of the remaining line for the latest message, even at the expense of the text at the right.
const NEWS: f32 = 0.75;

/// The latest message, until something changes. The text at the right needs `beside` points.
fn latest(ui: &mut Ui, beside: f32, context: &mut PanelContext<'_>) {
    let session = context.session();
    let Some(message) = session.messages.last() else { return };
    let listed = session.view.shows_strip() && session.view.bottom_tab == MESSAGES_TAB;
    if listed || !session.has_news() {
        return;
    }
    // The icon in front of the count shows the worst severity.
    if session.messages.worst() != Some(message.severity) {
        icon::sign(ui, [14.0, 16.0], 5.5, message.severity);
    }
    let (all, gap) = (ui.available_width(), 2.0 * ui.spacing().item_spacing.x);
    let button = message.offer.as_ref().map_or(0.0, |(text, _)| theme::small_width(ui, text) + 2.0 * gap);
    let room = (all - beside - gap).max(NEWS * all) - button;
    let colour = Palette::here(ui).text;
    let galley = theme::elided(ui, &message.text, TextStyle::Small, colour, room);
    // Its own tooltip would be a second one.
    let label = ui.add(Label::new(galley).show_tooltip_when_elided(false));
    label.on_hover_text(&message.text);
    if let Some((text, action)) = &message.offer {
        let button = ui.add(Button::new(theme::small(ui, *text).color(colour)).small());
        context.on_click(&messages::explained(button, session, action), || (**action).clone());
    }
}

/// True if the line reports shader errors. Not while the editor marks them: the picture says the rest.
fn shows_errors(session: &Session) -> bool {
    !session.shaders.troubles.is_empty() && !session.edits_troubles()
}

/// The number of shader errors, and whether they affect the picture; a click opens the shader panel.
fn shader_errors(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    if !shows_errors(session) {
        return;
    }
    let count = session.shaders.troubles.len();
    let stale = session.shaders.stale();
    let effect = if stale.is_empty() {
        "nothing in the picture depends on it".to_owned()
    } else {
        format!("the picture shows {}", kind_shown_instead(&stale))
    };
    icon::sign(ui, [14.0, 16.0], 5.5, Severity::Error);
    let text = format!("{}: {effect}", plural(count, "shader error"));
    let text = RichText::new(text).small().color(Palette::here(ui).error);
    let button = ui.add(small(ui, text));
    let tip = keys::hint(ui.ctx(), "Show where the errors are", "panel.shader");
    let button = button.on_hover_text(tip);
    context.on_click(&button, || Action::View(ViewChange::BottomTab(SHADER_TAB.to_owned())));
}

#[cfg(test)]
mod tests {
    use super::{Converging, samples_in_words};

    #[test]
    fn samples_and_noise_are_told_of_the_view_that_lacks_most_and_of_each_where_there_are_several() {
        let of = |done, noise| Converging { done, total: 256, noise };
        assert_eq!(samples_in_words(&[Converging::default(); 2]), None);
        let one = samples_in_words(&[of(64, None), Converging::default()]);
        assert_eq!(one, Some(("64 of 256 samples".to_owned(), Vec::new())));
        let both = samples_in_words(&[of(64, Some(0.0123)), of(8, Some(0.005))]);
        let lines = ["A: 64 of 256 samples · noise 1.2 %", "B: 8 of 256 samples · noise 0.50 %"];
        let words = "8 of 256 samples · noise 1.2 %".to_owned();
        assert_eq!(both, Some((words, lines.map(str::to_owned).to_vec())));
    }

    #[test]
    fn the_noise_is_that_of_pictures_that_still_converge() {
        let of = |done, noise| Converging { done, total: 256, noise };
        let words = |a, b| samples_in_words(&[a, b]).map(|(words, _)| words);
        let done = of(256, Some(0.049));
        assert_eq!(words(done, of(6, None)).as_deref(), Some("6 of 256 samples"), "only A has one");
        assert_eq!(words(done, of(9, Some(0.01))).as_deref(), Some("9 of 256 samples · noise 1.0 %"));
        assert_eq!(words(of(64, Some(0.02)), of(6, None)).as_deref(), Some("6 of 256 samples"));
        assert_eq!(words(done, of(256, Some(0.01))).as_deref(), Some("256 of 256 samples · noise 4.9 %"));
    }
}
