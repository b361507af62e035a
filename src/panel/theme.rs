//! The visual style of the window: colours, type, spacing.
//!
//! Neutral greys, since users judge colours against them; one accent for interactive and selected widgets; the colours
//! of M. Okabe and K. Ito (2008), *Color Universal Design*, for data. Text has a contrast of at least 4.5:1 (WCAG 2.2,
//! AA), which a test checks for both palettes.

use std::sync::Arc;

use bevy_egui::egui::{
    self, Align, Button, Color32, Context, CornerRadius, FontId, FontSelection, Frame, Galley, Id, Label,
    LayerId, Layout, Margin, Painter, Pos2, Rect, Response, RichText, Stroke, Style, TextStyle, Ui,
    UiBuilder, Vec2, WidgetInfo, WidgetType, Window, style::HandleShape, vec2,
};

use super::{
    narrow,
    state::{Settings, Severity, ThemeChoice},
};
pub use crate::lettering::{maths, maths_italic, semibold};
use crate::{lettering, reflection::Term};

/// Unit of spacing, in points; halves are allowed.
pub const UNIT: f32 = 8.0;

const fn grey(v: u8) -> Color32 {
    Color32::from_rgb(v, v, v)
}

/// Declares the colours of the window, each in the dark and in the light palette.
macro_rules! palettes {
    ($($(#[$doc:meta])* $name:ident: $Type:ty = $dark:expr, $light:expr;)+) => {
        /// The colours of the window.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Palette {
            $($(#[$doc])* pub $name: $Type,)+
        }

        /// Dark palette, for judging pictures.
        pub const DARK: Palette = Palette { $($name: $dark),+ };

        /// Light palette, for bright rooms and projectors.
        pub const LIGHT: Palette = Palette { $($name: $light),+ };
    };
}

palettes! {
    /// True for the dark palette.
    dark: bool = true, false;
    /// Background of a panel.
    panel: Color32 = grey(21), grey(250);
    /// Surfaces raised above a panel: menus, dialogs, buttons.
    raised: Color32 = grey(34), grey(238);
    /// A widget under the pointer.
    hovered: Color32 = grey(48), grey(224);
    /// Text fields, and rails of sliders.
    field: Color32 = grey(11), grey(255);
    /// Separating lines.
    line: Color32 = grey(52), grey(205);
    /// Text.
    text: Color32 = grey(230), grey(24);
    /// Secondary text: units, ends of ranges, hints.
    weak: Color32 = grey(160), grey(92);
    /// Selected and interactive widgets.
    accent: Color32 = Color32::from_rgb(0x6c, 0xb4, 0xff), Color32::from_rgb(0x0a, 0x5c, 0xb0);
    /// Background of selected list items.
    chosen: Color32 = Color32::from_rgb(0x1f, 0x3a, 0x57), Color32::from_rgb(0xcf, 0xe3, 0xf8);
    /// Errors.
    error: Color32 = Color32::from_rgb(0xff, 0x8a, 0x7a), Color32::from_rgb(0xb3, 0x26, 0x1e);
    /// Warnings.
    warning: Color32 = Color32::from_rgb(0xf0, 0xc0, 0x50), Color32::from_rgb(0x7a, 0x52, 0x00);
    /// Surroundings of the picture.
    surround: Color32 = grey(46), grey(184);
}

impl Palette {
    /// The palette that the settings select.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        match settings.theme {
            ThemeChoice::Dark => DARK,
            ThemeChoice::Light => LIGHT,
        }
    }

    /// The current palette of a widget.
    #[must_use]
    pub fn here(ui: &Ui) -> Self {
        if ui.visuals().dark_mode { DARK } else { LIGHT }
    }

    /// Background of badges, captions, labels and legends over a picture, on which they can be read whatever it shows.
    #[must_use]
    pub fn plate(&self) -> Color32 {
        self.panel.gamma_multiply(PLATE)
    }

    /// The data colour of a term of an equation, for lines and areas.
    #[must_use]
    pub fn term(&self, term: Term) -> Color32 {
        match term {
            Term::Total => self.text,
            Term::Ambient => Color32::from_rgb(0x00, 0x9e, 0x73),
            Term::Diffuse => Color32::from_rgb(0xe6, 0x9f, 0x00),
            Term::Specular => Color32::from_rgb(0xcc, 0x79, 0xa7),
            Term::Transmitted => Color32::from_rgb(0x56, 0xb4, 0xe9),
        }
    }

    /// The colour of a term with enough contrast for text.
    #[must_use]
    pub fn term_text(&self, term: Term) -> Color32 {
        match (self.dark, term) {
            (_, Term::Total) => self.text,
            (true, Term::Ambient) => Color32::from_rgb(0x2f, 0xc7, 0x9b),
            (true, Term::Diffuse) => Color32::from_rgb(0xf0, 0xb4, 0x2d),
            (true, Term::Specular) => Color32::from_rgb(0xe0, 0x9c, 0xc3),
            (true, Term::Transmitted) => Color32::from_rgb(0x7c, 0xc5, 0xf2),
            (false, Term::Ambient) => Color32::from_rgb(0x00, 0x69, 0x4d),
            (false, Term::Diffuse) => Color32::from_rgb(0x80, 0x58, 0x00),
            (false, Term::Specular) => Color32::from_rgb(0x94, 0x3c, 0x70),
            (false, Term::Transmitted) => Color32::from_rgb(0x0b, 0x5a, 0x8c),
        }
    }

    /// The colour of a severity.
    #[must_use]
    pub fn severity(&self, severity: Severity) -> Color32 {
        match severity {
            Severity::Info => self.accent,
            Severity::Warning => self.warning,
            Severity::Error => self.error,
        }
    }
}

/// The current scale factor of text.
#[must_use]
pub fn scale_here(ui: &Ui) -> f32 {
    ui.style().text_styles.get(&TextStyle::Body).map_or(1.0, |f| f.size / BODY)
}

/// Opacity of plates over a picture.
const PLATE: f32 = 0.97;
/// Opacity of scroll bars relative to the text's colour while the pointer is elsewhere.
const SCROLL_BAR: f32 = 0.55;
/// Size of secondary text, in points.
pub(super) const SMALL: f32 = 11.5;
const BODY: f32 = 13.0;
const HEADING: f32 = 16.0;

/// Secondary text in the smallest size.
#[must_use]
pub fn small(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).small().color(Palette::here(ui).weak)
}

/// Width of a text in the smallest size.
#[must_use]
pub fn small_width(ui: &Ui, text: &str) -> f32 {
    width_in(ui, text, &TextStyle::Small.resolve(ui.style()))
}

/// Width of a text in a font.
#[must_use]
pub fn width_in(ui: &Ui, text: &str, font: &FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE).size().x
}

/// Text in bold, for headings of groups.
#[must_use]
pub fn strong(ui: &Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).family(semibold()).color(Palette::here(ui).text)
}

/// The font of text in bold, in the size of the panel's text.
pub(super) fn bold(ui: &Ui) -> FontId {
    FontId::new(TextStyle::Body.resolve(ui.style()).size, semibold())
}

/// A remark in the smallest size, in as many lines as it needs.
pub(super) fn note(ui: &mut Ui, text: impl Into<String>) -> Response {
    ui.add(Label::new(small(ui, text)).wrap())
}

/// Shows a window while it is open. Returns false once the user closes it, by the button in its corner or by Escape.
pub(super) fn window(
    ui: &Ui,
    id: &str,
    title: impl Into<String>,
    open: bool,
    size: impl FnOnce(Window<'static>) -> Window<'static>,
    content: impl FnOnce(&mut Ui),
) -> bool {
    let mut shown = open;
    let window = Window::new(RichText::new(title).heading()).id(Id::new(id));
    size(window.collapsible(false).resizable(false)).open(&mut shown).show(ui.ctx(), content);
    // A dialog or a question over it takes the key.
    let layer = LayerId::new(egui::Order::Middle, Id::new(id));
    let has_keys = ui.memory(|memory| memory.allows_interaction(layer));
    shown && !(has_keys && ui.input(|i| i.key_pressed(egui::Key::Escape)))
}

/// Shows a tooltip of at most this width, in points.
pub(super) fn tip(widget: Response, width: f32, add: impl FnOnce(&mut Ui)) -> Response {
    widget.on_hover_ui(|ui| {
        ui.set_max_width(narrow::wide(ui.ctx(), width, 0.0));
        add(ui);
    })
}

/// Shows widgets in a column that keeps its width, whatever it contains.
pub(super) fn column(ui: &mut Ui, rect: Rect, add: impl FnOnce(&mut Ui)) {
    let layout = Layout::top_down(Align::Min);
    ui.scope_builder(UiBuilder::new().max_rect(rect).layout(layout), add);
}

/// A button that stands out if it does what the user most likely wants.
pub(super) fn action_button(ui: &Ui, label: &str, stands_out: bool, size: Vec2) -> Button<'static> {
    let (button, palette) = (Button::new(strong(ui, label)).min_size(size), Palette::here(ui));
    let stroke = Stroke::new(1.0, palette.accent);
    if stands_out { button.fill(palette.chosen).stroke(stroke) } else { button }
}

/// A line of text, truncated with … if it is wider than `width`.
#[must_use]
pub fn elided(ui: &Ui, text: &str, font: impl Into<FontSelection>, ink: Color32, width: f32) -> Arc<Galley> {
    let font = font.into().resolve(ui.style());
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, ink);
    job.wrap = egui::text::TextWrapping::truncate_at_width(width.max(0.0));
    ui.painter().layout_job(job)
}

/// A title in the bold font, truncated with … if two lines of this width are not enough.
pub(super) fn title(ui: &Ui, text: &str, width: f32) -> Arc<Galley> {
    lines(ui, text, bold(ui), Palette::here(ui).text, (width, 2))
}

/// Text truncated with … if it needs more than this width and this number of lines.
pub(super) fn lines(
    ui: &Ui,
    text: &str,
    font: impl Into<FontSelection>,
    ink: Color32,
    (width, most): (f32, usize),
) -> Arc<Galley> {
    let font = font.into().resolve(ui.style());
    let mut job = egui::text::LayoutJob::simple(text.to_owned(), font, ink, width.max(0.0));
    job.wrap.max_rows = most;
    ui.painter().layout_job(job)
}

/// A line of text, with … in the middle if it is wider than `width`: names often differ only at their ends.
#[must_use]
pub fn elided_within(ui: &Ui, text: &str, font: &FontId, ink: Color32, width: f32) -> (Arc<Galley>, bool) {
    let line = |text: String| ui.painter().layout_no_wrap(text, font.clone(), ink);
    let whole = line(text.to_owned());
    if whole.size().x <= width {
        return (whole, false);
    }
    let letters: Vec<char> = text.chars().collect();
    let with = |kept: usize| {
        let (head, tail) = (&letters[..kept.div_ceil(2)], &letters[letters.len() - kept / 2..]);
        let [head, tail]: [String; 2] = [head, tail].map(|part| part.iter().collect());
        line(format!("{}…{}", head.trim_end(), tail.trim_start()))
    };
    // The largest number of letters that fits.
    let (mut fits, mut over) = (0, letters.len());
    while over - fits > 1 {
        let middle = fits.midpoint(over);
        *(if with(middle).size().x <= width { &mut fits } else { &mut over }) = middle;
    }
    (with(fits), true)
}

/// Paints words on a plate beside the pointer, within the clip rectangle of a painter.
pub(super) fn beside(ui: &Ui, painter: &Painter, pointer: Pos2, words: String) {
    let palette = Palette::here(ui);
    let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, semibold());
    let galley = painter.layout_no_wrap(words, font, palette.text);
    let padding = vec2(8.0, 4.0) * scale_here(ui);
    let size = galley.size() + 2.0 * padding;
    let room = painter.clip_rect().shrink(4.0);
    let mut at = pointer + vec2(18.0, 16.0);
    if at.x + size.x > room.right() {
        at.x = pointer.x - 18.0 - size.x;
    }
    if at.y + size.y > room.bottom() {
        at.y = pointer.y - 16.0 - size.y;
    }
    let place = Rect::from_min_size(at.max(room.min), size);
    painter.rect_filled(place, 4.0, palette.plate());
    painter.galley(place.min + padding, galley, palette.text);
}

/// Selects all text of a field, for typing to replace it.
pub(super) fn select_all(ui: &Ui, id: Id, text: &str) {
    use egui::text::{CCursor, CCursorRange};
    if let Some(mut state) = egui::text_edit::TextEditState::load(ui.ctx(), id) {
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
}

/// Names a widget for screen readers.
pub(super) fn says(widget: &Response, role: WidgetType, name: impl ToString) {
    widget.widget_info(|| WidgetInfo::labeled(role, true, name.to_string()));
}

/// Names a widget for screen readers, and says if it is chosen or unfolded.
pub(super) fn says_chosen(widget: &Response, role: WidgetType, chosen: bool, name: impl ToString) {
    widget.widget_info(|| WidgetInfo::selected(role, true, chosen, name.to_string()));
}

/// True if a widget is under the pointer or has the focus.
pub(super) fn is_hot(widget: &Response) -> bool {
    widget.hovered() || widget.has_focus()
}

/// Names a text field for screen readers, with the text before, the text now, and the hint in the empty field.
pub(super) fn names_field(field: &Response, name: &str, [before, now, hint]: [&str; 3]) {
    field.widget_info(|| {
        let mut info = WidgetInfo::text_edit(field.enabled(), before, now, hint);
        info.label = Some(name.to_owned());
        info
    });
}

/// Layers of the tooltips shown in this frame so far.
pub(super) fn tooltips(ctx: &Context) -> Vec<LayerId> {
    let layers: Vec<_> = ctx.memory(|m| m.areas().visible_layer_ids().into_iter().collect());
    let shown = |layer: &LayerId| ctx.graphics(|g| g.get(*layer).is_some_and(|list| !list.is_empty()));
    layers.into_iter().filter(|layer| layer.order == egui::Order::Tooltip).filter(shown).collect()
}

/// Hides the tooltips of this frame, except for the given ones.
pub(super) fn hide_tooltips(ctx: &Context, but: &[LayerId]) {
    let hidden = tooltips(ctx).into_iter().filter(|layer| !but.contains(layer));
    ctx.graphics_mut(|graphics| {
        for layer in hidden {
            if let Some(list) = graphics.get_mut(layer) {
                let all = list.next_idx().0;
                (0..all).for_each(|i| list.reset_shape(egui::layers::ShapeIdx(i)));
            }
        }
    });
}

/// The display colour of a linear reflectance.
#[must_use]
pub fn swatch(reflectance: glam::Vec3) -> Color32 {
    let [r, g, b] = reflectance.to_array().map(crate::optics::colour::srgb_encode8);
    Color32::from_rgb(r, g, b)
}

/// Applies the settings to egui. Cheap if nothing has changed. Returns false until the fonts are available, which
/// is in the next pass: until then, nothing can be shown.
#[must_use]
pub fn apply(ctx: &Context, settings: &Settings) -> bool {
    let id = Id::new("lab theme");
    // Takes effect in the next pass; setting the same factor again does nothing.
    ctx.set_zoom_factor(f32::from(settings.scale) / 100.0);
    let dark = settings.theme == ThemeChoice::Dark;
    let now = (dark, narrow::is(ctx));
    let before: Option<(bool, bool)> = ctx.data(|d| d.get_temp(id));
    if before == Some(now) {
        return true;
    }
    if before.is_none() {
        ctx.set_fonts(lettering::fonts());
        // The window handles these keys itself.
        ctx.options_mut(|o| o.zoom_with_keyboard = false);
    }
    ctx.data_mut(|d| d.insert_temp(id, now));
    let theme = if dark { egui::Theme::Dark } else { egui::Theme::Light };
    ctx.set_theme(theme);
    let mut style = style(&Palette::of(settings));
    if now.1 {
        for_thumbs(&mut style.spacing);
    }
    ctx.set_style_of(theme, style);
    if before.is_none() {
        ctx.request_repaint();
    }
    before.is_some()
}

fn style(p: &Palette) -> Style {
    let text_styles = [
        (TextStyle::Small, FontId::proportional(SMALL)),
        (TextStyle::Body, FontId::proportional(BODY)),
        (TextStyle::Button, FontId::proportional(BODY)),
        (TextStyle::Monospace, FontId::monospace(SMALL)),
        (TextStyle::Heading, FontId::new(HEADING, semibold())),
    ]
    .into();
    let mut style = Style { text_styles, ..Style::default() };
    spacing(&mut style.spacing);
    style.interaction.tooltip_delay = 0.35;
    style.interaction.selectable_labels = false;
    style.animation_time = 0.08;

    let v = &mut style.visuals;
    *v = if p.dark { egui::Visuals::dark() } else { egui::Visuals::light() };
    v.override_text_color = None;
    v.weak_text_color = Some(p.weak);
    v.panel_fill = p.panel;
    v.window_fill = p.raised;
    v.window_stroke = Stroke::new(1.0, p.line);
    v.window_corner_radius = CornerRadius::same(6);
    v.menu_corner_radius = CornerRadius::same(6);
    v.extreme_bg_color = p.field;
    v.text_edit_bg_color = Some(p.field);
    v.faint_bg_color = p.raised;
    v.code_bg_color = p.raised;
    v.hyperlink_color = p.accent;
    v.warn_fg_color = p.warning;
    v.error_fg_color = p.error;
    v.selection.bg_fill = p.chosen;
    v.selection.stroke = Stroke::new(1.0, p.accent);
    v.handle_shape = HandleShape::Circle;
    v.slider_trailing_fill = true;
    v.disabled_alpha = 0.62;
    widgets(&mut v.widgets, p);
    style
}

fn spacing(s: &mut egui::style::Spacing) {
    s.item_spacing = vec2(UNIT, UNIT / 2.0);
    s.button_padding = vec2(UNIT, UNIT / 4.0);
    s.interact_size = vec2(3.0 * UNIT, 3.0 * UNIT);
    s.menu_margin = Margin::same((UNIT / 2.0) as i8);
    s.window_margin = Margin::same((2.0 * UNIT) as i8);
    s.indent = 2.0 * UNIT;
    s.icon_width = 14.0;
    s.icon_width_inner = 8.0;
    s.icon_spacing = 6.0;
    s.combo_width = 8.0 * UNIT;
    s.combo_height = 40.0 * UNIT;
    s.tooltip_width = 40.0 * UNIT;
    s.menu_width = 36.0 * UNIT;
    s.scroll = egui::style::ScrollStyle::thin();
    // A bar that appears only under the pointer would hide that there is more.
    s.scroll.foreground_color = true;
    s.scroll.dormant_handle_opacity = SCROLL_BAR;
    s.scroll.dormant_background_opacity = 0.0;
    s.scroll.floating_width = 5.0;
    // Faded edges would distort the colours there.
    s.scroll.fade.strength = 0.0;
}

/// The spacing of a narrow window.
fn for_thumbs(s: &mut egui::style::Spacing) {
    s.interact_size.y = narrow::THUMB;
    s.tooltip_width = 25.0 * UNIT;
    s.menu_width = 25.0 * UNIT;
    s.window_margin = Margin::same(UNIT as i8);
}

/// The states of a widget.
fn widgets(w: &mut egui::style::Widgets, p: &Palette) {
    let looks = [
        (&mut w.noninteractive, p.panel, 1.0, p.line),
        (&mut w.inactive, p.raised, 1.0, p.line),
        (&mut w.hovered, p.hovered, 1.0, p.weak),
        (&mut w.active, p.hovered, 1.5, p.accent),
        (&mut w.open, p.hovered, 1.0, p.accent),
    ];
    for (widget, fill, width, edge) in looks {
        (widget.bg_fill, widget.weak_bg_fill) = (fill, fill);
        widget.bg_stroke = Stroke::new(width, edge);
        widget.corner_radius = CornerRadius::same(4);
        widget.expansion = 0.0;
        widget.fg_stroke = Stroke::new(1.0, p.text);
    }
}

/// The margins inside a panel.
pub fn panel_frame(p: &Palette, margin: Vec2) -> Frame {
    Frame::new().fill(p.panel).inner_margin(Margin::symmetric(margin.x as i8, margin.y as i8))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(c: Color32) -> f32 {
        let linear = |v: u8| crate::optics::colour::srgb_decode(f32::from(v) / 255.0);
        0.2126 * linear(c.r()) + 0.7152 * linear(c.g()) + 0.0722 * linear(c.b())
    }

    fn contrast(a: Color32, b: Color32) -> f32 {
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    #[test]
    fn text_can_be_read_on_every_ground() {
        for p in [DARK, LIGHT] {
            for ground in [p.panel, p.raised, p.field, p.hovered, p.chosen] {
                assert!(contrast(p.text, ground) >= 7.0, "text on {ground:?}");
            }
            for ground in [p.panel, p.raised, p.field] {
                for ink in [p.weak, p.accent, p.error, p.warning] {
                    assert!(contrast(ink, ground) >= 4.5, "{ink:?} on {ground:?}: {}", contrast(ink, ground));
                }
                for term in [Term::Total, Term::Ambient, Term::Diffuse, Term::Specular, Term::Transmitted] {
                    assert!(contrast(p.term_text(term), ground) >= 4.5, "{term:?} on {ground:?}");
                }
            }
        }
    }

    #[test]
    fn text_can_be_read_on_plates_over_white_and_black() {
        for p in [DARK, LIGHT] {
            let plate = p.plate();
            let rest = 1.0 - f32::from(plate.a()) / 255.0;
            for behind in [Color32::WHITE, Color32::BLACK] {
                // The light behind shines through by display codes or as light, as the renderer blends.
                let codes = plate.r() + (rest * f32::from(behind.r())).round() as u8;
                let light = (1.0 - rest) * luminance(p.panel) + rest * luminance(behind);
                for ground in [luminance(grey(codes)), light] {
                    for ink in [p.text, p.accent, p.error, p.warning] {
                        let (a, b) = (luminance(ink) + 0.05, ground + 0.05);
                        let ratio = a.max(b) / a.min(b);
                        assert!(ratio >= 4.5, "{ink:?} on a plate over {behind:?}: {ratio}");
                    }
                }
            }
        }
    }

    #[test]
    fn scroll_bars_are_seen_before_the_pointer_finds_them() {
        for p in [DARK, LIGHT] {
            for ground in [p.panel, p.raised] {
                let bar = ground.lerp_to_gamma(p.text, SCROLL_BAR);
                assert!(contrast(bar, ground) >= 3.0, "on {ground:?}: {}", contrast(bar, ground));
            }
        }
        let style = style(&DARK);
        assert!(style.spacing.scroll.dormant_handle_opacity >= SCROLL_BAR);
        assert!(style.spacing.scroll.foreground_color);
    }

    #[test]
    fn the_surround_of_the_picture_has_no_tint() {
        for p in [DARK, LIGHT] {
            assert!(p.surround.r() == p.surround.g() && p.surround.g() == p.surround.b());
        }
        assert_eq!(DARK.surround, Color32::from_rgb(46, 46, 46));
    }
}
