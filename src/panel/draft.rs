//! Windows beside the picture that ask for something, and block the rest until they are closed, or list something.

use bevy_egui::egui::{TextEdit, Window};

use super::{narrow, prelude::*};

/// Width of such a window, in points.
const WIDTH: f32 = 450.0;
/// Width of the scroll bar beside the content, in points.
const BAR: f32 = 10.0;
/// Height of title, margins and buttons of such a window, in points.
const AROUND: f32 = 132.0;
/// Height of title and margins alone, in points.
const TITLE: f32 = 72.0;

/// Shows such a window around a point. Returns false if the user closes it.
pub(super) fn window(ui: &Ui, id: &str, title: String, centre: Pos2, content: impl FnOnce(&mut Ui)) -> bool {
    // It may have been pushed aside the last time, by the user or by a lack of room.
    let opens = is_new(ui, &format!("{id} place"));
    let width = narrow::wide(ui.ctx(), WIDTH, ui.spacing().window_margin.sum().x);
    let size = |window: Window<'static>| {
        let window = window.default_width(width).pivot(Align2::CENTER_CENTER).default_pos(centre);
        if opens { window.current_pos(centre) } else { window }
    };
    theme::window(ui, id, title, true, size, |ui| {
        ui.set_width(width);
        if !narrow::is(ui.ctx()) {
            return content(ui);
        }
        let most = ui.ctx().content_rect().height() - TITLE;
        let scroll = ScrollArea::both().auto_shrink([false, true]).min_scrolled_height(most);
        scroll.max_height(most).show(ui, content);
    })
}

/// The content of such a window. It scrolls if the screen is too low: the buttons below stay in sight.
pub(super) fn content(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let most = ui.ctx().content_rect().height() - AROUND;
    let scroll = ScrollArea::vertical().auto_shrink([false, true]).min_scrolled_height(most);
    scroll.max_height(most).show(ui, |ui| {
        ui.set_max_width(ui.available_width() - BAR);
        add(ui);
        // Tab brings into sight what it reaches.
        let focused = ui.memory(|memory| memory.focused()).and_then(|id| ui.ctx().read_response(id));
        let reached = focused.filter(|on| on.gained_focus() && ui.min_rect().contains_rect(on.rect));
        reached.inspect(|on| on.scroll_to_me(None));
    });
}

/// The field for a name in such a window, which says what it is for, and the name once it is changed. It takes the focus when
/// the window opens.
pub(super) fn name_field(
    ui: &mut Ui,
    window: &str,
    says: &str,
    name: &str,
    is_right: bool,
) -> (Response, Option<String>) {
    let palette = Palette::here(ui);
    let mut text = name.to_owned();
    let stroke = Stroke::new(1.5, if is_right { palette.accent } else { palette.error });
    let frame = egui::Frame::new().fill(palette.field).stroke(stroke).corner_radius(4.0);
    let id = Id::new((window, "name"));
    let edit = TextEdit::singleline(&mut text).id(id).desired_width(f32::INFINITY);
    let edit = edit.frame(frame.inner_margin(egui::Margin::symmetric(6, 5))).show(ui);
    let response = edit.response.response;
    theme::names_field(&response, says, [name, &text, ""]);
    if is_new(ui, window) {
        response.request_focus();
        // Typing replaces the suggested name.
        theme::select_all(ui, id, name);
    }
    let changed = response.changed().then_some(text);
    (response, changed)
}

/// The buttons of such a window: what it is for, which stands out if it is possible now, and *Cancel*. The window takes
/// the input from everything behind it, and Enter is for the first button unless another widget has the focus.
pub(super) fn buttons(ui: &mut Ui, does: &str, possible: bool) -> [Response; 2] {
    let layer = ui.layer_id();
    let is_free = ui.memory_mut(|memory| {
        memory.set_modal_layer(layer);
        memory.focused().is_none()
    });
    // By these keys the window may be closed now, or a field with a mistake keeps the focus.
    let ends = ui.input(|i| i.key_pressed(Key::Enter) || i.key_pressed(Key::Escape));
    let (line, size) = (vec2(ui.available_width(), 28.0), vec2(80.0, 28.0));
    let layout = Layout::right_to_left(Align::Center);
    let buttons = ui.allocate_ui_with_layout(line, layout, |ui| {
        let button = theme::action_button(ui, does, possible, size);
        [ui.add_enabled(possible, button), ui.add(Button::new("Cancel").min_size(size))]
    });
    if possible && is_free && !ends {
        buttons.inner[0].request_focus();
    }
    buttons.inner
}

/// True when a window was not shown in the pass before.
pub(super) fn is_new(ui: &Ui, id: &str) -> bool {
    let pass = ui.ctx().cumulative_pass_nr();
    let last: Option<u64> =
        ui.data_mut(|d| d.get_temp_mut_or_default::<Option<u64>>(Id::new((id, "shown"))).replace(pass));
    last.is_none_or(|last| last + 1 < pass)
}
