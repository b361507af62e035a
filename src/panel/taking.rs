//! Saved pictures and sheets: the window that asks for size, caption, background and layers before the file dialog, and
//! the progress of drawing.

use bevy_egui::egui::ComboBox;

use super::{
    draft, export, knob, menu,
    prelude::*,
    state::{Effect, PictureSize, SheetOf, SheetOptions, TakeDraft, Taken, Turning},
};
use crate::{
    channel::LayerKind,
    compare::metric,
    reference::MAX_SIDE,
    scene::{comparison, limits::Limits},
    sweep::MAX_RATE,
    text::listed,
};

/// Id of the window.
pub(super) const DRAFT: &str = "take draft";
/// Title of the window when all views are saved.
pub(super) const TITLE: &str = "Save the picture";
/// Width of a field for a number, in points.
const FIELD: f32 = 56.0;
/// Width of the names before lists and fields, in points.
const NAME: f32 = 96.0;
/// Width of tooltips, in points.
const TIP: f32 = 320.0;
/// The colour that a background of a picture's own begins with.
const WHITE: [u8; 3] = [255; 3];

/// The window about the picture or the sheet that is about to be saved.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(draft) = &context.session().take_draft else { return };
    let title = match draft.of {
        Taken::Picture(None) => TITLE.to_owned(),
        Taken::Picture(Some(view)) => format!("Save view {}", LETTERS[view.min(MAX_VARIANTS)]),
        Taken::Sheet(_) => "Save a sheet or a film".to_owned(),
    };
    let (centre, asked) = (context.area().rect.center(), context.actions.len());
    if is_gone(context.session(), draft.of)
        || !draft::window(ui, DRAFT, title, centre, |ui| ask(ui, draft, context))
    {
        context.actions.truncate(asked);
        context.act(Action::Take(TakeCommand::Close));
    }
}

/// True if the view or the row is no longer there.
fn is_gone(session: &Session, of: Taken) -> bool {
    let scene = &session.document;
    match of {
        Taken::Picture(view) => view.is_some_and(|view| view > scene.variants.len()),
        Taken::Sheet(SheetOf::Row(object)) => scene.row(object).is_none(),
        Taken::Sheet(SheetOf::Views) => scene.variants.is_empty(),
        Taken::Sheet(SheetOf::Turn(_)) => false,
    }
}

fn ask(ui: &mut Ui, draft: &TakeDraft, context: &mut PanelContext<'_>) {
    let mut next = draft.clone();
    let mut typed = Typed::default();
    draft::content(ui, |ui| match draft.of {
        Taken::Picture(view) => picture(ui, view, &mut next, (&mut typed, context.session())),
        Taken::Sheet(now) => sheet(ui, now, &mut next, (&mut typed, context)),
    });
    ui.add_space(10.0);
    let [choose, cancel] = draft::buttons(ui, "Choose a file…", !typed.is_wrong);
    if draft::is_new(ui, DRAFT) {
        choose.request_focus();
    }
    let choose = choose.on_hover_text("Keeps these options for the next time, and asks for the file");
    let choose = choose.on_disabled_hover_text("Correct the number in the field with the red rim first.");
    let cancel = cancel.on_hover_text("Closes the window; the options stay as they were");
    if next != *draft {
        context.act(Action::Take(TakeCommand::Change(Box::new(next))));
    }
    if choose.clicked() || typed.is_entered && !typed.is_wrong {
        context.act(Action::Take(TakeCommand::Choose));
    }
    context.on_click(&cancel, || Action::Take(TakeCommand::Close));
}

/// The result of typing into the fields of the window.
#[derive(Default)]
struct Typed {
    /// True if a number is wrong.
    is_wrong: bool,
    /// True if Enter was pressed in a field.
    is_entered: bool,
}

/// A line that begins with a name and its tooltip.
fn line(ui: &mut Ui, name: &str, tip: &str, add: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        let room = vec2(NAME * theme::scale_here(ui), 22.0);
        ui.allocate_ui_with_layout(room, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(room.x);
            ui.label(name).on_hover_text(tip);
        });
        add(ui);
    });
}

/// A box to check, with a tooltip; one that cannot be used says why.
fn check(ui: &mut Ui, on: &mut bool, name: &str, tip: &str, why_not: Option<&str>) {
    let check = ui.add_enabled(why_not.is_none(), egui::Checkbox::new(on, name));
    theme::says_chosen(&check, WidgetType::Checkbox, *on, name);
    let check = check.on_hover_ui(|ui| {
        ui.set_max_width(TIP);
        ui.label(tip);
    });
    if let Some(why) = why_not {
        check.on_disabled_hover_text(why);
    }
}

/// Width and height.
fn sides(ui: &mut Ui, [width, height]: &mut [u32; 2], typed: &mut Typed) {
    let limits = Limits::between(1.0, f64::from(MAX_SIDE)).whole();
    number(ui, ["Width in pixels", &format!("Width, from 1 to {MAX_SIDE} pixels")], (width, &limits), typed);
    ui.label("×");
    number(
        ui,
        ["Height in pixels", &format!("Height, from 1 to {MAX_SIDE} pixels")],
        (height, &limits),
        typed,
    );
    ui.label(theme::small(ui, "pixels"));
}

/// A field for a whole number. While it is wrong, the tooltip says why.
fn number(ui: &mut Ui, [name, tip]: [&str; 2], (value, limits): (&mut u32, &Limits), typed: &mut Typed) {
    let id = ui.make_persistent_id(("take", name));
    let field = knob::field(ui, id, name, f64::from(*value), limits, FIELD);
    let response = field.response.on_hover_text(tip);
    typed.is_wrong |= field.error.is_some();
    typed.is_entered |= response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if let Some(error) = field.error {
        response.on_hover_text(format!("{name} {error}"));
    }
    if let Some(new) = field.value {
        *value = new as u32;
    }
}

/// The options of a picture.
fn picture(ui: &mut Ui, view: Option<usize>, next: &mut TakeDraft, (typed, session): (&mut Typed, &Session)) {
    let TakeDraft { picture: options, caption, .. } = next;
    let tip = "Width and height of the picture, without its caption. Pictures of another size than the view are drawn \
               anew, in the background.";
    line(ui, "Size", tip, |ui| {
        let names = PictureSize::ALL.map(PictureSize::name);
        let now = PictureSize::ALL.iter().position(|size| *size == options.size);
        let combo = ComboBox::from_id_salt("take size").width(128.0);
        let tip = |ui: &mut Ui, i: usize| {
            ui.label(PictureSize::ALL[i].summary());
        };
        let (button, picked) = menu::list(ui, combo, "Size", &names, now, tip);
        button.on_hover_text(options.size.summary());
        options.size = picked.map_or(options.size, |i| PictureSize::ALL[i]);
        if options.size == PictureSize::Own {
            sides(ui, &mut options.own, typed);
        }
    });
    let as_view = options.pixels().is_none().then_some("Pictures as the view have the edges of the view.");
    let tip = "Four samples per pixel instead of one";
    check(ui, &mut options.smooth, "Smooth edges", tip, as_view);
    background(ui, &mut options.background);
    ui.separator();
    let tip =
        "A strip below the picture: models, values that differ from the defaults, tone mapping, version";
    check(ui, caption, "Caption", tip, None);
    let several = view.is_none() && shows_several(session);
    let why = match (*caption, several) {
        (_, false) => Some("The picture shows one view; numbers compare several."),
        (false, true) => Some("The numbers stand in the caption."),
        (true, true) => None,
    };
    let metrics = listed(&metric::names_in_window(), "and");
    let tip = format!("{metrics} between the views, in the caption: over the pixels that objects cover");
    check(ui, &mut options.numbers, "Numbers of the difference in the caption", &tip, why);
    let tip = "The legends of debug channels and of the map of a difference: colours and their values";
    let plain = !has_legend(view, session);
    let why =
        plain.then_some("The picture has no legend: it shows neither a debug channel nor a difference.");
    check(ui, &mut options.legend, "Legend", tip, why);
    ui.separator();
    layers(ui, &mut options.layers);
}

/// True if the picture as it is shown has several views. Views that alternate are taken one at a time.
fn shows_several(session: &Session) -> bool {
    let layout = session.document.comparison.layout;
    !session.document.variants.is_empty() && layout != comparison::Layout::Single && !layout.is_in_turn()
}

/// True if the picture has something that a legend explains.
fn has_legend(view: Option<usize>, session: &Session) -> bool {
    let map = view.is_none() && shows_several(session) && session.document.comparison.layout.is_map();
    let mut views = view.map_or(0..=session.document.variants.len(), |view| view..=view);
    map || views.any(|view| session.channel_of(view).is_some())
}

/// The background: that of the scene, or a colour.
fn background(ui: &mut Ui, colour: &mut Option<[u8; 3]>) {
    let mut own = colour.is_some();
    let tip = "A colour behind the objects of this picture, instead of the background of the scene, which stays as it is. \
               Linear pictures have none.";
    check(ui, &mut own, "Another background", tip, None);
    if own != colour.is_some() {
        *colour = own.then_some(WHITE);
    }
    if let Some(rgb) = colour {
        let caption = knob::Caption::new("background of the picture", "", "The colour behind objects.");
        *rgb = knob::colour_knob(ui, &caption, *rgb, Some(WHITE)).unwrap_or(*rgb);
    }
}

/// The layers of OpenEXR files.
fn layers(ui: &mut Ui, chosen: &mut Vec<String>) {
    ui.horizontal_wrapped(|ui| {
        let tip = "If the name of the file ends in .exr, it holds linear light, and these layers beside the picture";
        ui.label("Layers of .exr files").on_hover_text(tip);
        for kind in LayerKind::ALL {
            let mut on = chosen.iter().any(|id| id == kind.id());
            let before = on;
            check(ui, &mut on, kind.name(), kind.summary(), None);
            if on && !before {
                chosen.push(kind.id().to_owned());
            } else if before && !on {
                chosen.retain(|id| id != kind.id());
            }
        }
    });
}

/// The options of a sheet or a film.
fn sheet(ui: &mut Ui, now: SheetOf, next: &mut TakeDraft, (typed, context): (&mut Typed, &PanelContext<'_>)) {
    let subject = subject(ui, now, context);
    next.of = Taken::Sheet(subject);
    let options = &mut next.sheet;
    line(ui, "Each picture", "Width and height of each picture of the sheet", |ui| {
        sides(ui, &mut options.size, typed);
    });
    if let SheetOf::Turn(_) = subject {
        line(ui, "Pictures", "Number of pictures of the full turn", |ui| {
            let (least, most) = (SheetOptions::MIN_TURN, SheetOptions::MAX_TURN);
            let limits = Limits::between(least.into(), most.into()).whole();
            let tip = format!("From {least} to {most}");
            number(ui, ["Pictures", &tip], (&mut options.turn, &limits), typed);
        });
    }
    line(ui, "Columns", "Number of pictures beside each other; further ones begin a new row", |ui| {
        let limits = Limits::between(0.0, f64::from(SheetOptions::MAX_COLUMNS)).whole();
        let tip = format!("From 1 to {}; 0 leaves it to the program", SheetOptions::MAX_COLUMNS);
        number(ui, ["Columns", &tip], (&mut options.columns, &limits), typed);
        ui.label(theme::small(ui, if options.columns == 0 { "as many as suit" } else { "" }));
    });
    line(
        ui,
        "Films",
        "A name that ends in .gif or .apng makes a film: the pictures one after the other",
        |ui| {
            let limits = Limits::between(1.0, f64::from(MAX_RATE)).whole();
            number(
                ui,
                ["Pictures per second", &format!("From 1 to {MAX_RATE}")],
                (&mut options.rate, &limits),
                typed,
            );
            ui.label(theme::small(ui, "pictures per second, in .gif and .apng files"));
        },
    );
    let tip = "The name or the values of each picture above it, and a caption below all";
    check(ui, &mut options.labels, "Labels and caption", tip, None);
    // Copies of a row, and parts that turn, are in different places of their pictures.
    if subject == SheetOf::Views {
        differences(ui, options, context.session());
    }
    check(ui, &mut options.smooth, "Smooth edges", "Four samples per pixel instead of one", None);
}

/// The choice of the view from which the others differ.
fn differences(ui: &mut Ui, options: &mut SheetOptions, session: &Session) {
    let tip = "Below each picture of a sheet its difference from one of them, as a map with numbers. Channel, sign and \
               amplification are those of the comparison.";
    check(ui, &mut options.differences, "Differences from one picture", tip, None);
    let count = session.document.variants.len() + 1;
    if !options.differences || count < 2 {
        return;
    }
    let name = |view: usize| format!("view {}", LETTERS[view.min(MAX_VARIANTS)]);
    let names: Vec<_> = (0..count).map(name).collect();
    let names: Vec<_> = names.iter().map(String::as_str).collect();
    let now = (options.against as usize).min(count - 1);
    let tip = "The view with which the others are compared";
    line(ui, "Compared with", tip, |ui| {
        let combo = ComboBox::from_id_salt("take against").width(128.0);
        let (button, picked) = menu::list(ui, combo, "Compared with", &names, Some(now), |_, _| {});
        button.on_hover_text(tip);
        options.against = picked.unwrap_or(now) as u32;
    });
}

/// The list of the possible subjects of a sheet: the views, the rows, and turns. Returns the chosen one.
fn subject(ui: &mut Ui, now: SheetOf, context: &PanelContext<'_>) -> SheetOf {
    let (session, scene) = (context.session(), &context.session().document);
    let views = (!scene.variants.is_empty()).then(|| (SheetOf::Views, "The views".to_owned()));
    let of_row = |first: usize| {
        let name = session.name_of(Selection::Object(first), context.registry());
        (SheetOf::Row(first), format!("The row from {name} on"))
    };
    let turns = Turning::ALL.iter().map(|turning| (SheetOf::Turn(*turning), turning.name().to_owned()));
    let rows = scene.rows().map(|row| of_row(row.first));
    let all: Vec<_> = views.into_iter().chain(rows).chain(turns).collect();
    let now = match now {
        SheetOf::Row(object) => SheetOf::Row(scene.row(object).map_or(object, |row| row.first)),
        other => other,
    };
    let at = all.iter().position(|(one, _)| *one == now);
    let mut chosen = now;
    let about = "The views, the copies of a row, or the steps of a turn: one for each picture";
    line(ui, "Pictures of", about, |ui| {
        let names: Vec<_> = all.iter().map(|(_, name)| name.as_str()).collect();
        let combo = ComboBox::from_id_salt("take subject").width(240.0);
        let tip = |ui: &mut Ui, i: usize| {
            let tip = match all.get(i) {
                Some((SheetOf::Row(_), _)) => "Each copy of the row alone, with what else is in the scene",
                Some((SheetOf::Turn(turning), _)) => turning.summary(),
                _ => "Each view of the scene",
            };
            ui.label(tip);
        };
        let (button, picked) = menu::list(ui, combo, "Pictures of", &names, at, tip);
        button.on_hover_text(about);
        chosen = picked.and_then(|i| all.get(i)).map_or(now, |(one, _)| *one);
    });
    chosen
}

/// The progress of pictures and sheets that are drawn for files, with buttons that stop them.
pub(super) fn progress(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let facts = &context.session().facts;
    let running = [
        (&facts.picture, "Drawing the picture", Effect::CancelPicture),
        (&facts.sheet, "Drawing the sheet", Effect::CancelSheet),
    ];
    for (running, name, cancel) in running {
        let Some(now) = running else { continue };
        if export::strip(ui, name, (now.done, &now.step), "Stop drawing; no file is written") {
            context.act(Action::Do(cancel));
        }
    }
}
