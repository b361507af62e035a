//! The symbol under the pointer: in an equation, at its knob, its vector in the picture, its number or its curve. In
//! the next frame, everything that represents the symbol is highlighted.

use super::prelude::*;
use crate::text::mathematics::same_symbol;

/// The subject of an equation. The same letter has different meanings in the equation of a surface and in that of a
/// light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Domain {
    /// Reflection models, with their knobs, vectors and curves.
    #[default]
    Surface,
    /// Lights.
    Light,
    /// Object types.
    Shape,
}

/// The symbols of one element, such as the two of `N·L`.
#[derive(Clone, Debug, PartialEq)]
struct Pointed {
    domain: Domain,
    symbols: Vec<String>,
    /// True for the pointer, false for the keyboard focus.
    by_pointer: bool,
}

#[derive(Clone, Debug, Default)]
struct Links {
    /// Symbols pointed at in the previous frame.
    lit: Option<Pointed>,
    /// Symbols pointed at in this frame.
    next: Option<Pointed>,
    /// Domain of the widgets being shown.
    domain: Domain,
    /// Symbols requested by a click, end time of their highlight, and true until their knob has been scrolled into
    /// view.
    held: Option<(Pointed, f64, bool)>,
}

/// Duration of the highlight after a click, in seconds.
const HELD: f64 = 2.5;

fn links<R>(ctx: &Context, f: impl FnOnce(&mut Links) -> R) -> R {
    kept::with(ctx, f)
}

/// Starts a frame: highlights what was pointed at in the previous one.
pub(super) fn begin(ctx: &Context) {
    let now = ctx.input(|i| i.time);
    links(ctx, |links| {
        links.held = links.held.take().filter(|(_, until, _)| now < *until);
        let held = links.held.as_ref().map(|(held, ..)| held.clone());
        links.lit = links.next.take().or(held);
    });
}

/// Shows the origin of a symbol of a surface: highlights everything that represents it for a while, and scrolls to its
/// knob.
pub(super) fn seek(ctx: &Context, symbols: &[&str]) {
    let symbols = symbols.iter().map(|s| (*s).to_owned()).collect();
    let until = ctx.input(|i| i.time) + HELD;
    let held = Pointed { domain: Domain::Surface, symbols, by_pointer: true };
    links(ctx, |links| links.held = Some((held, until, true)));
    ctx.request_repaint_after_secs(HELD as f32 + 0.05);
    ctx.request_repaint();
}

/// True once for the knob of a symbol to scroll to.
pub(super) fn is_sought(ctx: &Context, symbol: &str) -> bool {
    links(ctx, |links| {
        let domain = links.domain;
        let Some((held, _, waits)) = &mut links.held else { return false };
        let mine = held.domain == domain && held.symbols.iter().any(|s| same_symbol(s, symbol));
        mine && std::mem::take(waits)
    })
}

/// Ends a frame. Requests another one if the highlight changes.
pub(super) fn end(ctx: &Context) {
    if links(ctx, |links| links.lit != links.next) {
        ctx.request_repaint();
    }
}

/// Shows widgets whose symbols belong to another domain.
pub(super) fn within<R>(ui: &mut Ui, domain: Domain, add: impl FnOnce(&mut Ui) -> R) -> R {
    let before = links(ui.ctx(), |links| std::mem::replace(&mut links.domain, domain));
    let out = add(ui);
    links(ui.ctx(), |links| links.domain = before);
    out
}

fn note(ctx: &Context, symbols: &[&str], by_pointer: bool) {
    let symbols: Vec<_> = symbols.iter().filter(|s| !s.is_empty()).map(|s| (*s).to_owned()).collect();
    if symbols.is_empty() {
        return;
    }
    links(ctx, |links| {
        // The pointer wins over the focus: the focus stays where the last click was, the pointer is where the user
        // looks.
        let weaker = !by_pointer && links.next.as_ref().is_some_and(|next| next.by_pointer);
        if !weaker {
            links.next = Some(Pointed { domain: links.domain, symbols, by_pointer });
        }
    });
}

/// Reports that the pointer is at an element with these symbols.
pub(super) fn point(ctx: &Context, symbols: &[&str]) {
    note(ctx, symbols, true);
}

/// Reports if the pointer or the keyboard focus is in a part of a panel that has these symbols.
pub(super) fn touch(ui: &Ui, rect: Rect, symbols: &[&str]) {
    let seen = rect.intersect(ui.clip_rect());
    let has = |id: Id| {
        let widget = ui.ctx().viewport(|viewport| viewport.prev_pass.widgets.get(id).copied());
        widget.is_some_and(|w| w.layer_id == ui.layer_id() && seen.contains(w.rect.center()))
    };
    // A dragged widget keeps the pointer wherever it goes.
    let pointed = match ui.ctx().dragged_id() {
        Some(id) => has(id),
        None => ui.rect_contains_pointer(rect),
    };
    if pointed {
        note(ui.ctx(), symbols, true);
    } else if ui.memory(|m| m.focused()).is_some_and(has) {
        note(ui.ctx(), symbols, false);
    }
}

/// The highlighted symbols of a domain, if any.
pub(super) fn lit_in(ctx: &Context, domain: Domain) -> Vec<String> {
    links(ctx, |links| match &links.lit {
        Some(lit) if lit.domain == domain => lit.symbols.clone(),
        _ => Vec::new(),
    })
}

/// True if a symbol is highlighted in the current domain.
pub(super) fn is_lit(ctx: &Context, symbol: &str) -> bool {
    let domain = links(ctx, |links| links.domain);
    !symbol.is_empty() && lit_in(ctx, domain).iter().any(|lit| same_symbol(lit, symbol))
}

/// The background of a highlighted element: a tint and a line below, since a tint alone is easily missed.
pub(super) fn ground(rect: Rect, palette: &Palette) -> Shape {
    let line = [rect.left_bottom(), rect.right_bottom()].map(|at| at - vec2(0.0, 1.0));
    Shape::Vec(vec![
        Shape::rect_filled(rect, 3.0, palette.chosen),
        Shape::line_segment(line, Stroke::new(1.5, palette.accent)),
    ])
}

/// The background of a highlighted row: a tint with a frame.
pub(super) fn row_ground(rect: Rect, palette: &Palette) -> Shape {
    let frame = Stroke::new(1.0, palette.accent);
    Shape::Vec(vec![
        Shape::rect_filled(rect, 3.0, palette.chosen),
        Shape::rect_stroke(rect, 3.0, frame, StrokeKind::Inside),
    ])
}

/// Shows something that represents these symbols, with a background if `lit` says that it is highlighted.
pub(super) fn linked(
    ui: &mut Ui,
    symbols: &[&str],
    lit: impl FnOnce(&Context) -> bool,
    add: impl FnOnce(&mut Ui) -> Response,
) -> Response {
    let under = ui.painter().add(Shape::Noop);
    let response = add(ui);
    touch(ui, response.rect, symbols);
    if lit(ui.ctx()) {
        ui.painter().set(under, ground(response.rect.expand2(vec2(2.0, 0.0)), &Palette::here(ui)));
    }
    response
}

/// Distance from a position to a polyline.
pub(super) fn distance(at: Pos2, path: &[Pos2]) -> f32 {
    let to = |a: Pos2, b: Pos2| {
        let (along, from) = (b - a, at - a);
        let part = (from.dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
        (from - part * along).length()
    };
    path.windows(2).map(|ends| to(ends[0], ends[1])).fold(f32::INFINITY, f32::min)
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{RawInput, pos2};

    use super::*;

    fn frame(ctx: &Context, add: impl Fn(&Context)) {
        let _ = ctx.run_ui(RawInput::default(), |ui| {
            begin(ui.ctx());
            add(ui.ctx());
            end(ui.ctx());
        });
    }

    #[test]
    fn what_is_pointed_at_lights_for_a_frame_in_its_domain() {
        let ctx = Context::default();
        frame(&ctx, |ctx| point(ctx, &["k_{d}"]));
        frame(&ctx, |ctx| {
            assert!(is_lit(ctx, "k_d") && !is_lit(ctx, "k_s") && !is_lit(ctx, ""));
            assert_eq!(lit_in(ctx, Domain::Light), [""; 0]);
        });
        frame(&ctx, |ctx| assert!(!is_lit(ctx, "k_d"), "nothing points any more"));
        frame(&ctx, |ctx| point(ctx, &["", ""]));
        frame(&ctx, |ctx| assert!(!is_lit(ctx, "")));
    }

    #[test]
    fn the_same_letter_of_a_light_is_another_symbol() {
        let ctx = Context::default();
        let both = |lit: [bool; 2]| {
            let _ = ctx.run_ui(RawInput::default(), |ui| {
                begin(ui.ctx());
                let surface = is_lit(ui.ctx(), "I");
                let light = within(ui, Domain::Light, |ui| is_lit(ui.ctx(), "I"));
                assert_eq!([surface, light], lit);
                within(ui, Domain::Light, |ui| point(ui.ctx(), &["I"]));
            });
        };
        both([false, false]);
        both([false, true]);
    }

    #[test]
    fn the_pointer_counts_more_than_the_focus() {
        let ctx = Context::default();
        for order in [[true, false], [false, true]] {
            frame(&ctx, |ctx| order.iter().for_each(|by| note(ctx, &[if *by { "a" } else { "b" }], *by)));
            frame(&ctx, |ctx| assert!(is_lit(ctx, "a") && !is_lit(ctx, "b")));
        }
    }

    #[test]
    fn only_a_change_asks_for_another_frame() {
        let ctx = Context::default();
        let asks = |symbol: &'static str| {
            let output = ctx.run_ui(RawInput::default(), |ui| {
                begin(ui.ctx());
                point(ui.ctx(), &[symbol]);
                end(ui.ctx());
            });
            output.viewport_output.values().any(|v| v.repaint_delay.is_zero())
        };
        // egui requests the first frames itself.
        (0..6).for_each(|_| {
            asks("");
        });
        // After each requested frame, egui draws another one itself.
        for symbol in ["a", "b", ""] {
            assert_eq!([symbol; 5].map(asks), [true, true, false, false, false], "{symbol}");
        }
    }

    #[test]
    fn distances_are_those_to_the_nearest_part() {
        let path = [pos2(0.0, 0.0), pos2(10.0, 0.0), pos2(10.0, 10.0)];
        assert_eq!(distance(pos2(5.0, 3.0), &path), 3.0);
        assert_eq!(distance(pos2(13.0, 14.0), &path), 5.0);
        assert_eq!(distance(pos2(0.0, 0.0), &path[..1]), f32::INFINITY);
    }
}
