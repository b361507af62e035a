//! The overlays of the picture: badges, caption, axes, hints.

use std::{
    hash::{DefaultHasher, Hash as _, Hasher as _},
    iter,
};

use bevy_egui::egui::FontFamily;

use super::{
    band,
    caption::{self, Lines, caption_text},
    channels, clipping,
    compare::{self, Arrangement},
    explain,
    focus::{self, Region},
    handles, keys, labels, marks,
    placer::{self, Placer},
    prelude::*,
    presentation::{self, CAPTION, Footer, Needed, PlatePlace, Stage},
    resting,
    state::{Badge, Cell, SHADER_TAB},
    wires,
};
use crate::{
    caption::single,
    channel::DebugChannel,
    library::status::{STAND_IN, ShaderStatus, shown_instead},
    optics::TermSelection,
    reflection::Term,
    scene::comparison::Edge,
};

/// Minimum size of a picture for axes, in points: in a smaller one they would hide more than they say.
const AXES: Vec2 = vec2(240.0, 170.0);
/// Side of the corner for the axes, in points.
const AXES_CORNER: f32 = 84.0;

/// Minimum width of a part of a picture for its own badges, in points.
const NARROWEST: f32 = 140.0;
/// Width of a wide legend, in points.
const WIDE_PLATE: f32 = 330.0;
/// Maximum fraction of a picture that badges cover, that the plate about an error covers, and of its height down to the
/// end of the plate where the editor shows the error.
const PLATE: f32 = 0.25;

/// Maximum fraction of the objects in a picture that badges cover while they have shorter words.
const OBJECTS: f32 = 0.1;

/// Maximum size of letters over one of several pictures of a presentation, as a fraction of its height.
const LETTER_SIZE: f32 = 0.1;

/// The picture's own panel: all that is written over the picture.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let whole = ui.available_rect_before_wrap();
    focus::region(ui.ctx(), Region::Picture, whole);
    let presenting = session.view.presenting;
    let several = presenting && !session.document.variants.is_empty();
    let footer = several.then(|| Footer::of(ui, whole, session, registry));
    let high = footer.as_ref().map_or(0.0, |footer| footer.height);
    let mut arrangement = compare::arrange(session, whole, high, 0.0);
    let needed = if presenting { Needed::so_far(ui, whole, session) } else { Needed::default() };
    let sizes = Needed::default();
    let mut over = Overlaid { context, places: Vec::new(), written: Vec::new(), needed, sizes };
    let (rect, frame, pictures) = if arrangement.is_single() {
        let stage = presenting.then(|| Stage::of(ui, whole, session, registry, needed));
        let frame = stage.as_ref().map_or(whole, |stage| stage.picture);
        over.single(ui, [whole, frame], stage.as_ref());
        (whole, frame, stage.map_or_else(Vec::new, |stage| vec![stage.free()]))
    } else {
        let spot = several.then(|| PlatePlace::of_pictures(ui, arrangement.cells[0].rect, session, needed));
        if let Some(PlatePlace::Band(band)) = spot {
            arrangement = compare::arrange(session, whole, high, band);
        }
        over.views(ui, &arrangement, spot);
        let pictures = arrangement.cells.iter().map(|cell| cell.rect).collect();
        (arrangement.picture, arrangement.picture, pictures)
    };
    let Overlaid { mut places, written, sizes, .. } = over;
    places.extend(compare::show(ui, &arrangement, context));
    if let Some(footer) = footer {
        footer.paint(ui, whole, session, registry);
    }
    if presenting {
        sizes.keep(ui, whole, session);
        let headers = arrangement.headers.iter().map(|(_, rect)| *rect);
        let lower = whole.with_min_y(whole.bottom() - high);
        let texts: Vec<_> = written.iter().copied().chain(headers).chain([lower]).collect();
        let texts: Vec<_> = texts.into_iter().filter(Rect::is_positive).collect();
        presentation::message(ui, whole, &pictures, &texts, session);
    }
    // As large as in other legends.
    let letters = if presenting { CAPTION * whole.height() } else { theme::SMALL };
    let mut area = PictureArea { rect, frame, written, letters, ..PictureArea::default() };
    if !arrangement.is_single() {
        (area.cells, area.map) = (arrangement.cells, arrangement.map);
    }
    context.actions.extend(band::band(ui, &area, session, registry));
    context.picture = (area, places);
}

/// Size of the letters of the legend that a difference map contains, in pixels of the map, which is so many pixels high.
#[must_use]
pub fn letters_of_map(area: &PictureArea, height: f32) -> Option<f32> {
    Some(area.letters * height / area.map?.height())
}

/// Size of the letters over the pictures of a presentation of several views.
fn letters_on_slide(ui: &Ui, cells: &[Cell], spot: PlatePlace) -> f32 {
    let room = cells.first().map_or(0.0, |cell| cell.rect.height() + spot.above());
    (CAPTION * ui.max_rect().height()).min(LETTER_SIZE * room)
}

/// The overlays of a picture, as far as they are painted.
struct Overlaid<'c, 'a> {
    context: &'c mut PanelContext<'a>,
    /// Clickable rectangles, which cover the picture.
    places: Vec<Rect>,
    /// Rectangles of badges, caption and axes.
    written: Vec<Rect>,
    /// Room that badges, legends and the message about an error took so far in a presentation, and that they take.
    needed: Needed,
    sizes: Needed,
}

impl<'a> Overlaid<'_, 'a> {
    /// Paints the overlays into the picture, which extends over `whole`, and around it the texts of a presentation.
    fn single(&mut self, ui: &mut Ui, [whole, rect]: [Rect; 2], stage: Option<&Stage>) {
        let (session, registry) = (self.context.session(), self.context.registry());
        let view = session.active();
        if rect.width() < 80.0 || rect.height() < 80.0 {
            return;
        }
        wires::paint(ui, rect, rect, view, session, registry);
        clipping::paint(&ui.painter_at(whole), whole, view, session, ui.pixels_per_point());
        // A presentation has no marks, and its messages are as large as the rest of the text.
        self.marked(ui, rect);
        self.written.extend(labels::labels(ui, rect, view, session, registry));
        let taken = stage.map_or_else(Vec::new, |stage| stage.taken(self.needed));
        let letters = stage.map(|_| CAPTION * whole.height());
        self.vectors(ui, (view, rect), letters, &taken);
        ui.scope(|ui| {
            let mut placer = match stage {
                Some(stage) => {
                    stage.paint(ui, session, registry);
                    self.written.extend(stage.plates().into_iter().filter(Rect::is_positive));
                    stage.placer()
                }
                None => Placer::column(rect, Align2::LEFT_TOP, rect.top() + placer::EDGE),
            };
            self.stale(ui, rect, &mut placer);
            self.channel(ui, &mut placer, view);
            let front: Vec<_> = of_disk(session).into_iter().collect();
            let of_view = badges_of(view, whole, ui, session, registry);
            let badges = match stage {
                Some(_) => ([front, of_view].concat(), false),
                None => yielding(ui, &placer, [front, of_view], (session, view), (rect, 1.0)),
            };
            self.badges(ui, &mut placer, badges);
            self.sizes = Needed::of([&placer.sizes; 2].map(Vec::as_slice), placer.room.width());
            hint(ui, rect, session);
        });
        if stage.is_none() {
            self.written.push(caption(ui, rect, session, registry));
            let corner = Rect::from_min_max(rect.right_bottom() - vec2(AXES_CORNER, AXES_CORNER), rect.max);
            if has_axes(rect) && !self.written.iter().any(|place| place.intersects(corner)) {
                self.written.push(axes(ui, rect, session));
            }
        }
    }

    /// Paints the legend of a view's debug channel, if there is one. A difference has no lines and dots to explain; in place
    /// of a missing one, there is the picture of view A.
    fn channel(&mut self, ui: &mut Ui, placer: &mut Placer, view: usize) {
        let session = self.context.session();
        let in_map = !session.document.variants.is_empty() && session.document.comparison.layout.is_map();
        let has_wires = session.channel_of(view).is_some_and(DebugChannel::has_wires);
        let hides = match session.shown_for_map() {
            Some(_) => view != 0,
            None => in_map && has_wires,
        };
        if hides {
            return;
        }
        if let Some(place) = channels::legend(ui, placer, view, self.context) {
            self.places.push(place);
            self.written.push(place);
        }
    }

    /// A picture for marks and vectors, which keep clear of what was written over it in the previous frame.
    fn sight(&self, rect: Rect) -> marks::Sight<'a> {
        let (session, registry) = (self.context.session(), self.context.registry());
        marks::Sight { rect, written: &self.context.area().written, session, registry }
    }

    /// Paints the vectors of the explained point into a view: in a presentation with letters of this size, and their legend
    /// clear of the plates that are `taken`.
    fn vectors(&mut self, ui: &mut Ui, (view, rect): (usize, Rect), letters: Option<f32>, taken: &[Rect]) {
        let sight = self.sight(rect);
        let legend = match letters {
            None => explain::vectors(ui, view, sight, taken),
            Some(size) => {
                let mut inside = ui.new_child(UiBuilder::new().id_salt(("vectors", view)));
                presentation::text_of_size(&mut inside, size);
                explain::vectors(&inside, view, sight, taken)
            }
        };
        self.written.extend(legend);
    }

    /// Paints the marks of a view, and over them the handles of the selection.
    fn marked(&mut self, ui: &Ui, rect: Rect) {
        let session = self.context.session();
        if session.view.presenting {
            return;
        }
        let sight = self.sight(rect);
        // Handles would cover the pixel that is explained or that a lesson refers to, and look like vectors.
        let covers = session.explains() || session.lesson.is_some();
        let paints = [marks::marks, handles::handles];
        for paint in paints.into_iter().take(if covers { 1 } else { 2 }) {
            let (asked, places) = paint(ui, sight);
            self.context.actions.extend(asked);
            self.places.extend(places);
        }
    }

    /// Paints the overlays of a comparison: marks and handles into every view, and messages about the picture into the
    /// active one. In a presentation, `spot` is the place of its plates.
    fn views(&mut self, ui: &mut Ui, arrangement: &Arrangement, spot: Option<PlatePlace>) {
        let (session, registry) = (self.context.session(), self.context.registry());
        let cells = &arrangement.cells;
        let layout = session.document.comparison.layout;
        // A difference has no wireframe.
        for cell in in_sight(cells, session) {
            wires::paint(ui, cell.rect, cell.part, cell.view, session, registry);
            let painter = ui.painter_at(cell.part);
            clipping::paint(&painter, cell.rect, cell.view, session, ui.pixels_per_point());
        }
        // Stacked views share their marks.
        let shown = cells.iter().filter(|cell| cell.part.is_positive());
        for cell in shown.take(if layout.is_beside() { usize::MAX } else { 1 }) {
            ui.push_id(("view", cell.view), |ui| {
                self.marked(ui, cell.rect);
                self.written.extend(labels::labels(ui, cell.rect, cell.view, session, registry));
            });
        }
        for cell in cells.iter().filter(|cell| cell.rect.is_positive()) {
            // Stacked views share a rectangle.
            let taken = spot.map(|spot| spot.column(cell.rect, self.needed)).filter(Rect::is_positive);
            let letters = spot.map(|spot| letters_on_slide(ui, cells, spot));
            self.vectors(ui, (cell.view, cell.rect), letters, taken.as_slice());
        }
        let active = cells.iter().find(|cell| cell.view == session.active());
        let told = active.or(cells.first());
        if let Some(cell) = told {
            hint(ui, cell.rect, session);
        }
        if let Some(spot) = spot {
            ui.scope(|ui| self.on_slide(ui, cells, spot));
            return;
        }
        let covered = stale_cell(cells.iter(), session, registry).map(|cell| {
            let mut placer = Placer::column(cell.rect, Align2::LEFT_TOP, cell.rect.top() + placer::EDGE);
            (cell.view, ui.scope(|ui| self.stale(ui, cell.rect, &mut placer)).inner)
        });
        ui.scope(|ui| self.badges_in_views(ui, cells, covered.filter(|(_, place)| place.is_positive())));
    }

    /// Paints the plates of a presentation of several views, where they hide no object.
    fn on_slide(&mut self, ui: &mut Ui, cells: &[Cell], spot: PlatePlace) {
        let (session, registry) = (self.context.session(), self.context.registry());
        let layout = session.document.comparison.layout;
        let palette = Palette::here(ui);
        presentation::text_of_size(ui, letters_on_slide(ui, cells, spot));
        let mut disk = of_disk(session);
        let mut shared: Option<Placer> = None;
        // Sizes of plates below each other, and in rows.
        let (mut below, mut beside) = (Vec::new(), Vec::new());
        // The plates of a difference are those of both views.
        let shown: Vec<_> = cells.iter().filter(|c| c.part.is_positive() || layout.is_map()).collect();
        let told = stale_cell(shown.iter().copied(), session, registry).map(|cell| cell.view);
        for cell in &shown {
            let mut placer = shared.take().filter(|_| !layout.is_beside()).unwrap_or_else(|| {
                let above = cell.rect.with_min_y(cell.rect.top() - spot.above()).with_max_y(cell.rect.top());
                ui.painter().rect_filled(above, 0.0, palette.panel);
                spot.placer(cell.rect)
            });
            if layout.is_beside() {
                (below, beside) = Default::default();
            }
            let known = placer.sizes.len();
            if told == Some(cell.view) {
                self.stale(ui, cell.rect, &mut placer);
            }
            self.channel(ui, &mut placer, cell.view);
            for sizes in [&mut below, &mut beside] {
                sizes.extend_from_slice(&placer.sizes[known..]);
            }
            let signs: Vec<_> = disk.take().into_iter().collect();
            let signs = [signs, badges_of(cell.view, cell.rect, ui, session, registry)];
            let few = in_few_rows(ui, cell.rect, &signs, &beside);
            let signs = signs.concat();
            below.extend(sizes_of_badges(ui, cell.rect, &signs, false));
            beside.extend(sizes_of_badges(ui, cell.rect, &few.0, few.1));
            let badges = if matches!(spot, PlatePlace::Band(_)) { few } else { (signs, false) };
            self.badges(ui, &mut placer, badges);
            self.sizes = self.sizes.or(Needed::of([&below, &beside].map(Vec::as_slice), cell.rect.width()));
            shared = Some(placer);
        }
    }

    /// Paints the legends and badges of views, below the message about a shader error in one of them.
    fn badges_in_views(&mut self, ui: &mut Ui, cells: &[Cell], stale: Option<(usize, Rect)>) {
        let (session, registry) = (self.context.session(), self.context.registry());
        let comparison = &session.document.comparison;
        let apart = comparison.layout.is_beside();
        let scale = theme::scale_here(ui);
        let mut next = None;
        let mut disk = of_disk(session);
        let mut missing = no_map(session);
        let sharing = if apart { 1.0 } else { cells.len() as f32 };
        // The badges of a difference are those of both views.
        for cell in cells.iter().filter(|cell| cell.part.is_positive() || comparison.layout.is_map()) {
            let free = stale.filter(|(view, _)| *view == cell.view || !apart);
            let first = free.map_or(cell.rect.top() + 8.0, |(_, covered)| covered.bottom() + 4.0);
            let is_second = cell.part.is_positive() && cell.part.min != cell.rect.min;
            // Below the legend of a lobe, if there is one, and in a narrow picture below the badges at the left.
            let narrow = cell.rect.width() < 2.0 * WIDE_PLATE * scale;
            let corner = Rect::from_min_max(cell.rect.right_top() - vec2(16.0, 0.0), cell.rect.right_top())
                .expand2(vec2(0.0, 16.0));
            let there = self.written.iter().filter(|place| place.is_positive() && place.intersects(corner));
            let lobe = there.map(|place| place.bottom() + 4.0).reduce(f32::max);
            let under = |top: f32| lobe.map_or(top, |lobe| lobe.max(top));
            let below = under(next.filter(|_| narrow).unwrap_or(first));
            let first = if narrow && apart { under(first) } else { first };
            let from = match comparison.edge {
                Edge::Vertical if is_second => (Align2::RIGHT_TOP, below),
                Edge::Horizontal if is_second => (Align2::LEFT_TOP, first.max(cell.part.top() + 8.0)),
                _ => (Align2::LEFT_TOP, next.filter(|_| !apart).unwrap_or(first)),
            };
            let mut placer = Placer::column(cell.rect, from.0, from.1);
            self.channel(ui, &mut placer, cell.view);
            let mut signs = std::mem::take(&mut missing);
            signs.extend(disk.take());
            let signs = [signs, badges_of(cell.view, cell.rect, ui, session, registry)];
            // Keeps badges on their own side of the edge of a wipe, if there is room.
            let beside = cell.part.is_positive() && cell.part.width() >= NARROWEST * scale;
            let room = if beside { cell.part } else { cell.rect };
            let mut placer = Placer::column(room, from.0, placer.below());
            let badges = yielding(ui, &placer, signs, (session, cell.view), (cell.rect, sharing));
            self.badges(ui, &mut placer, badges);
            next = Some(placer.below());
        }
    }

    /// Shows that the picture does not match the shaders, in a way that stands out on any picture: a frame, and a filled
    /// plate that opens the panel with the errors. Returns the rectangle of the plate.
    fn stale(&mut self, ui: &mut Ui, rect: Rect, placer: &mut Placer) -> Rect {
        let (session, registry) = (self.context.session(), self.context.registry());
        let shown = registry.model(session.model_shown()).map_or("", |m| m.declaration.name);
        let Some((heading, lines)) = stale_words(&session.shaders, shown) else { return Rect::NOTHING };
        let palette = Palette::here(ui);
        ui.painter_at(rect).rect_stroke(rect, 0.0, Stroke::new(3.0, palette.error), StrokeKind::Inside);
        let painter = ui.painter_at(placer.room);
        // Without them, there is room for the frame only.
        // The editor has the messages at their lines, and the object is what is looked at.
        let low = PLATE * placer.room.height() - placer::EDGE;
        let (said, tallest) = match session.edits_troubles() {
            true => (&lines[..0], low),
            // In a low picture there is room for the heading.
            false if session.view.presenting => {
                (&lines[..], low.max(4.0 * TextStyle::Body.resolve(ui.style()).size))
            }
            false => (&lines[..], f32::INFINITY),
        };
        let shorter = shorter_words(&session.shaders).map(str::to_owned);
        let headings = iter::once(heading.clone()).chain(shorter);
        let Some(galleys) = that_fit(ui, placer.room, headings, said, tallest) else { return Rect::NOTHING };
        let place = placer.place(size_of(ui, &galleys));
        let response = ui.interact(place, ui.id().with("stale shader"), Sense::click());
        theme::says(&response, WidgetType::Button, format!("{heading}: {}", lines.join("; ")));
        // The rim stands out even where the picture has the colour of the plate.
        let rim = if response.hovered() || response.has_focus() { palette.text } else { palette.panel };
        painter.rect(place, 5.0, palette.error, Stroke::new(2.0, rim), StrokeKind::Outside);
        let mut at = place.min + PADDING;
        let radius = SIGN[0] * theme::scale_here(ui);
        let sign = pos2(at.x + radius, at.y + 0.5 * galleys[0].rows.first().map_or(0.0, |r| r.height()));
        icon::severity_in(&painter, sign, radius, Severity::Error, palette.panel);
        at.x += SIGN[1] * theme::scale_here(ui);
        for galley in galleys {
            let height = galley.size().y;
            painter.galley(at, galley, palette.panel);
            at.y += height + 2.0;
        }
        let response = response.on_hover_cursor(CursorIcon::PointingHand).on_hover_ui(|ui| {
            ui.set_max_width(340.0);
            ui.label(
                "A shader has an error, so the picture shows these models as they were before the last change. Correct \
                 the file and save it: the picture updates by itself.",
            );
            let key = keys::word(ui.ctx(), "panel.shader");
            ui.label(theme::small(ui, format!("Click, or key {key}: the line and the message")));
        });
        self.context.on_click(&response, || Action::View(ViewChange::BottomTab(SHADER_TAB.to_owned())));
        self.places.push(place);
        self.written.push(place);
        place
    }

    /// Paints badges, one after the other, in their shortest words if `short`.
    fn badges(&mut self, ui: &mut Ui, placer: &mut Placer, (all, short): (Vec<Sign>, bool)) {
        let palette = Palette::here(ui);
        let scale = theme::scale_here(ui);
        let font = theme::bold(ui);
        let rect = placer.room;
        for (badge, click) in all {
            let put = |size| placer.place(size);
            let text = words(ui, rect, &badge, short);
            let place = plate(ui, rect, put, text, font.clone(), BADGE_SIGN * scale);
            let sense = if click.is_none() { Sense::hover() | Sense::FOCUSABLE } else { Sense::click() };
            let response = ui.interact(place, ui.id().with(("badge", &badge.text)), sense);
            let painter = ui.painter_at(rect);
            let here = click.is_some() && (response.hovered() || response.has_focus());
            let rim = if here { palette.text } else { palette.severity(badge.severity) };
            painter.rect_stroke(place, 4.0, Stroke::new(scale, rim), StrokeKind::Inside);
            let sign = pos2(place.left() + 14.0 * scale, place.center().y);
            icon::severity(&painter, sign, 6.0 * scale, badge.severity, &palette);
            let role = if click.is_none() { WidgetType::Label } else { WidgetType::Button };
            theme::says(&response, role, &badge.text);
            self.written.push(place);
            let pointer = if sense.senses_click() { CursorIcon::PointingHand } else { CursorIcon::Default };
            let response = response.on_hover_cursor(pointer);
            let mut help = if *text == badge.text {
                badge.help.clone()
            } else {
                format!("{}. {}", badge.text, badge.help)
            };
            if let Some(click) = click {
                self.places.push(place);
                help = format!("{help} {}", click.help);
                if response.clicked() {
                    self.context.actions.extend(click.actions);
                }
            }
            if !help.is_empty() {
                // With the keyboard alone, the help can be reached in no other way.
                if response.has_focus() {
                    response.show_tooltip_text(&help);
                }
                response.on_hover_text(&help);
            }
        }
    }
}

/// The view with the message about a shader error: the active one, unless only others show one of the models.
fn stale_cell<'c>(
    cells: impl Iterator<Item = &'c Cell> + Clone,
    session: &Session,
    registry: &Registry,
) -> Option<&'c Cell> {
    let stale = session.shaders.stale();
    let names: Vec<_> = stale.iter().map(|name| name.trim_end_matches(STAND_IN)).collect();
    let is_shown = |cell: &&Cell| {
        let shows =
            |id: &str| registry.model(id).is_some_and(|model| names.contains(&model.declaration.name));
        session.document.models_shown(cell.view).into_iter().any(shows)
    };
    let active = cells.clone().find(|cell| cell.view == session.active());
    let first = active.or_else(|| cells.clone().next());
    if names.is_empty() || first.as_ref().is_some_and(is_shown) {
        return first;
    }
    cells.clone().find(is_shown).or(first)
}

/// Heading and lines of the message about a shader error in the picture. The model with the display name `shown` comes
/// first.
#[must_use]
pub fn stale_words(status: &ShaderStatus, shown: &str) -> Option<(String, Vec<String>)> {
    /// Maximum number of lines; more would hide the picture.
    const MOST: usize = 3;
    let mut names = status.stale();
    if names.is_empty() {
        return None;
    }
    names.sort_by_key(|name| *name != shown);
    let few = |all: Vec<&str>| {
        let kind = if all.iter().all(|name| name.ends_with(STAND_IN)) { STAND_IN } else { "" };
        let more = format!("{} more{kind}", all.len().saturating_sub(MOST));
        let shown: Vec<_> = all.iter().take(MOST).copied().collect();
        shown_instead(&if all.len() > MOST { [shown, vec![more.as_str()]].concat() } else { shown })
    };
    let heading = format!("Showing {}", few(names));
    let causes: Vec<_> = status.troubles.iter().filter(|t| !t.stale.is_empty()).collect();
    let mut lines: Vec<_> = causes.iter().take(MOST).map(|t| t.problem.to_string()).collect();
    if causes.len() > MOST {
        lines.push(format!("and {}", plural(causes.len() - MOST, "more error")));
    }
    Some((heading, lines))
}

/// Space around the message about a shader error, in points.
const PADDING: Vec2 = vec2(10.0, 7.0);
/// Radius of the sign at its left, and the space for it, in points at the usual size of text.
const SIGN: [f32; 2] = [8.0, 26.0];

/// Size of the plate of these texts.
fn size_of(ui: &Ui, galleys: &[Arc<Galley>]) -> Vec2 {
    let height: f32 = galleys.iter().map(|g| g.size().y + 2.0).sum();
    let width = galleys.iter().map(|g| g.size().x).fold(0.0, f32::max);
    vec2(width + SIGN[1] * theme::scale_here(ui), height) + 2.0 * PADDING
}

/// Shorter headings of the message about a shader error, down to its sign alone, for small pictures.
fn shorter_words(status: &ShaderStatus) -> [&'static str; 4] {
    let [sentence, words] = match status.stale().iter().all(|name| name.ends_with(STAND_IN)) {
        true => ["Showing a grey stand-in", "Grey stand-in"],
        false => ["Showing the last good version", "Last good version"],
    };
    [sentence, words, "Error", ""]
}

/// The longest heading of which nothing is cut, and lines, as far as their plate leaves room for the picture: that has
/// priority; the panel lists all errors. The plate is not taller than `tallest`.
fn that_fit(
    ui: &Ui,
    rect: Rect,
    headings: impl IntoIterator<Item = String>,
    lines: &[String],
    tallest: f32,
) -> Option<Vec<Arc<Galley>>> {
    let scale = theme::scale_here(ui);
    let room = (rect.width() - 2.0 * placer::EDGE).min(560.0 * scale) - SIGN[1] * scale - 2.0 * PADDING.x;
    let body = TextStyle::Body.resolve(ui.style()).size;
    let ink = Palette::here(ui).panel;
    let head = FontId::new(1.12 * body, theme::semibold());
    let fits = |galleys: &[_]| {
        let size = size_of(ui, galleys);
        size.x * size.y <= PLATE * rect.area() && size.y <= tallest
    };
    let mut all =
        headings.into_iter().map(|text| vec![theme::lines(ui, &text, head.clone(), ink, (room, 3))]);
    let mut galleys = all.find(|galleys| !galleys[0].elided && fits(galleys))?;
    for line in lines {
        galleys.push(theme::lines(ui, line, FontId::proportional(body), ink, (room, 2)));
        if !fits(&galleys) {
            galleys.pop();
            break;
        }
    }
    Some(galleys)
}

/// The width of the text of a plate in a picture.
fn plate_room(ui: &Ui, rect: Rect, left: f32) -> f32 {
    (rect.width() - 16.0 - 16.0 * theme::scale_here(ui) - left).max(64.0)
}

/// Room for the sign of a badge, in points at the usual size of text.
const BADGE_SIGN: f32 = 18.0;

/// The text of a badge: the longest that takes one line, if it need not be `short`. If none does, the shortest.
fn words<'b>(ui: &Ui, rect: Rect, badge: &'b Badge, short: bool) -> &'b String {
    let room = plate_room(ui, rect, BADGE_SIGN * theme::scale_here(ui));
    let font = theme::bold(ui);
    let mut texts = iter::once(&badge.text).chain(&badge.shorter);
    let shortest = badge.shorter.last().unwrap_or(&badge.text);
    texts.find(|text| !short && theme::width_in(ui, text, &font) <= room).unwrap_or(shortest)
}

/// The sizes of badges, in their shortest words if `short`.
fn sizes_of_badges(ui: &Ui, rect: Rect, all: &[Sign], short: bool) -> Vec<Vec2> {
    let left = BADGE_SIGN * theme::scale_here(ui);
    let size =
        |(badge, _): &Sign| lay_out_plate(ui, rect, words(ui, rect, badge, short), theme::bold(ui), left).1;
    all.iter().map(size).collect()
}

/// The words of the badges of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wording {
    /// The longest that fit.
    Whole,
    /// The shortest.
    Short,
    /// The shortest, where one badge stands for all of the view.
    Gathered,
}

/// Badges that cover no more of a picture and of the objects in it than they may, as far as that is possible, and true if
/// they have their shortest words. If those cover too much, one badge is left of those of a view, the second ones, which
/// says under the pointer what all say; the first ones stay before it. So many views share the picture.
///
/// While the camera turns, the choice is kept: it takes a look at every object, and words that change with the view are
/// restless.
fn yielding(
    ui: &Ui,
    placer: &Placer,
    [front, of_view]: [Vec<Sign>; 2],
    (session, view): (&Session, usize),
    (picture, views): (Rect, f32),
) -> (Vec<Sign>, bool) {
    if front.is_empty() && of_view.is_empty() {
        return (front, false);
    }
    let all = || front.iter().chain(&of_view);
    // In each frame, so without copies of the texts.
    let [mut words, mut lengths] = [DefaultHasher::new(), DefaultHasher::new()];
    for text in all().flat_map(|(badge, _)| iter::once(&badge.text).chain(&badge.shorter)) {
        // A share that follows the picture makes no other badge of it.
        let letters = text.chars().filter(|c| !c.is_ascii_digit() && *c != '.');
        letters.chain(['\n']).for_each(|c| c.hash(&mut words));
        text.len().hash(&mut lengths);
    }
    let shown = (session.document.revision(), session.active());
    let type_size = (theme::bold(ui), ui.pixels_per_point());
    let counts = [front.len(), of_view.len()];
    let key = (words.finish(), counts, [picture, placer.room], views, shown, type_size);
    let id = Id::new(("words of badges", view));
    let wording = resting::choice(ui.ctx(), id, session, (key, (lengths.finish(), placer.clone())), || {
        let all: Vec<_> = all().cloned().collect();
        wording(ui, placer, (&all, of_view.len()), (session, picture, views))
    });
    match wording {
        Wording::Gathered => (with_one(&front, &of_view), true),
        _ => (front.into_iter().chain(of_view).collect(), wording == Wording::Short),
    }
}

/// The words of badges, the last so many of which are those of a view, by what they cover.
fn wording(
    ui: &Ui,
    placer: &Placer,
    (all, of_view): (&[Sign], usize),
    (session, picture, views): (&Session, Rect, f32),
) -> Wording {
    let discs = presentation::discs(session, picture);
    let fits = |short: bool| {
        let mut placer = placer.clone();
        let sizes = sizes_of_badges(ui, placer.room, all, short);
        let plates: Vec<_> = sizes.into_iter().map(|size| placer.place(size)).collect();
        let area: f32 = plates.iter().map(Rect::area).sum();
        area <= PLATE * picture.area() / views
            && presentation::covered(&discs, picture, &plates) <= OBJECTS / views
    };
    if fits(false) {
        Wording::Whole
    } else if of_view < 2 || fits(true) {
        Wording::Short
    } else {
        Wording::Gathered
    }
}

/// Badges that take as few rows above a picture as possible after plates of these sizes, and true if they have their shortest
/// words. Only those of a view, the second ones, can become one.
fn in_few_rows(ui: &Ui, rect: Rect, signs: &[Vec<Sign>; 2], before: &[Vec2]) -> (Vec<Sign>, bool) {
    let all = signs.concat();
    if all.len() < 2 {
        return (all, false);
    }
    let high = |signs: &[Sign], short: bool| {
        let sizes = sizes_of_badges(ui, rect, signs, short);
        presentation::height_of_rows(before.iter().copied().chain(sizes), rect.width())
    };
    let [front, of_view] = signs;
    let one = if of_view.len() < 2 { all.clone() } else { with_one(front, of_view) };
    let least = high(&one, true) + 0.5;
    match [false, true].into_iter().find(|short| high(&all, *short) <= least) {
        Some(short) => (all, short),
        None => (one, true),
    }
}

/// Badges, and after them one for several of a view.
fn with_one(front: &[Sign], of_view: &[Sign]) -> Vec<Sign> {
    front.iter().cloned().chain([gathered(of_view)]).collect()
}

/// One badge for several. A click does what it does on the first of them that can be clicked.
fn gathered(all: &[Sign]) -> Sign {
    let badges = || all.iter().map(|(badge, _)| badge);
    let joined = |texts: Vec<&str>, by: &str| texts.join(by);
    let letter = badges().find_map(|badge| {
        let (letter, _) = badge.text.split_once(" · ")?;
        LETTERS.contains(&letter).then(|| format!("{letter} · "))
    });
    let badge = Badge {
        severity: badges().map(|badge| badge.severity).max().unwrap_or(Severity::Info),
        text: joined(badges().map(|badge| badge.text.as_str()).collect(), "; "),
        shorter: vec![format!("{}{}", letter.unwrap_or_default(), plural(all.len(), "note"))],
        help: joined(
            badges().map(|badge| badge.help.as_str()).filter(|help| !help.is_empty()).collect(),
            " ",
        ),
    };
    (badge, all.iter().find_map(|(_, click)| click.clone()))
}

/// The text of a plate in a picture, and the size of the plate.
fn lay_out_plate(ui: &Ui, rect: Rect, text: &str, font: FontId, left: f32) -> (Arc<Galley>, Vec2) {
    let room = plate_room(ui, rect, left);
    let galley = ui.painter().layout(text.to_owned(), font, Palette::here(ui).text, room);
    let size = galley.size() + 2.0 * plate_padding(ui) + vec2(left, 0.0);
    (galley, size)
}

/// Space around the text of a plate.
fn plate_padding(ui: &Ui) -> Vec2 {
    vec2(8.0, 4.0) * theme::scale_here(ui)
}

/// Text on a background that is readable over any picture, where `put` puts a plate of its size. Returns the rectangle.
fn plate(ui: &Ui, rect: Rect, put: impl FnOnce(Vec2) -> Rect, text: &str, font: FontId, left: f32) -> Rect {
    let palette = Palette::here(ui);
    let (galley, size) = lay_out_plate(ui, rect, text, font, left);
    let place = put(size);
    let painter = ui.painter_at(rect);
    painter.rect_filled(place, 4.0, palette.plate());
    painter.galley(place.min + plate_padding(ui) + vec2(left, 0.0), galley, palette.text);
    place
}

/// The badge for a scene file that has changed on disk.
fn of_disk(session: &Session) -> Option<Sign> {
    session.disk_badge().map(|badge| (badge, None))
}

/// The views whose pictures are seen; without a difference map, that is the one shown in its place, whole.
fn in_sight(cells: &[Cell], session: &Session) -> Vec<Cell> {
    if !session.document.comparison.layout.is_map() {
        return cells.to_vec();
    }
    let alone = cells.iter().filter(|cell| cell.view == 0 && session.shown_for_map().is_some());
    alone.map(|cell| Cell { part: cell.rect, ..*cell }).collect()
}

/// The badges in the place of a difference map that is missing: why, and what is shown until then.
fn no_map(session: &Session) -> Vec<Sign> {
    let Some((reason, shown)) = session.no_difference().zip(session.shown_for_map()) else {
        return Vec::new();
    };
    let help = "This is the picture of view A. The map replaces it as soon as it belongs to both pictures.";
    let badge = |text: &str, shorter: &[&str], help: &str| {
        let badge = Badge {
            severity: Severity::Info,
            text: text.to_owned(),
            shorter: shorter.iter().map(|text| (*text).to_owned()).collect(),
            help: help.to_owned(),
        };
        (badge, None)
    };
    vec![badge(&reason, &["No map"], ""), badge(shown, &[], help)]
}

/// A badge, and what a click on it does.
type Sign = (Badge, Option<Click>);

/// A sentence about a click, and its actions.
#[derive(Clone)]
struct Click {
    help: &'static str,
    actions: Vec<Action>,
}

/// The badge for hidden terms of the equation in a view, which shows them all.
fn hidden_terms(view: usize, session: &Session, registry: &Registry) -> Option<Sign> {
    // A channel of geometry has no terms.
    let of_geometry = session.channel_of(view).is_some_and(|channel| !channel.is_of_light());
    let shown = match session.terms_of(view) {
        TermSelection::All => return None,
        _ if of_geometry => return None,
        other => other.id(),
    };
    let whose = match single(&session.document.models_shown(view)).and_then(|id| registry.model(id)) {
        _ if !session.lacks_term(view, registry) => String::new(),
        Some(model) => format!(", which is 0 with {}", model.declaration.name),
        None => ", which is 0 in this picture".to_owned(),
    };
    let badge = Badge {
        severity: if whose.is_empty() { Severity::Info } else { Severity::Warning },
        text: format!("Only the {shown} term{whose} · Show all"),
        shorter: vec![format!("Only the {shown} term"), format!("Only {shown}")],
        help: "The other terms of the equation are hidden.".to_owned(),
    };
    let actions = vec![Action::View(ViewChange::Terms(TermSelection::All))];
    Some((badge, Some(Click { help: "Click to show all terms; T goes on to the next.", actions })))
}

/// The badge for lights and objects of a view whose light is not a finite number, which switches the channel that shows
/// where.
fn no_number(view: usize, session: &Session, registry: &Registry) -> Option<Sign> {
    /// Maximum number of names; more would hide the picture.
    const MOST: usize = 2;
    let odd = session.facts.not_finite.get(view).filter(|odd| !odd.is_empty())?;
    let all: Vec<_> = odd.iter().map(|odd| (session.name_of(odd.part, registry), &odd.what)).collect();
    let mut names: Vec<_> = all.iter().take(MOST).map(|(name, _)| name.clone()).collect();
    if let Some(more) = all.len().checked_sub(MOST).filter(|more| *more > 0) {
        names.push(format!("{more} more"));
    }
    let lines: Vec<_> = all.iter().take(MOST).map(|(name, what)| format!("{name} {what}.")).collect();
    let badge = Badge {
        severity: Severity::Warning,
        text: format!("Not a number: {}", names.join(", ")),
        shorter: vec!["Not a number".to_owned()],
        help: format!("{} It is drawn black or white.", lines.join(" ")),
    };
    let shown = session.view.channels.get(view).copied().flatten() == Some(DebugChannel::NotANumber);
    let channel = (!shown).then_some(DebugChannel::NotANumber);
    let actions = vec![Action::View(ViewChange::Channel(channel))];
    Some((badge, Some(Click { help: "Click to show where the light is not a number.", actions })))
}

/// The badges of a view's picture. An action on the active view activates the view first.
fn badges_of(view: usize, picture: Rect, ui: &Ui, session: &Session, registry: &Registry) -> Vec<Sign> {
    let per_point = ui.pixels_per_point();
    let pixels = f64::from(picture.area() * per_point * per_point);
    let toggle = Action::View(ViewChange::Clipping(!session.view.show_clipping));
    let click = Click { help: "Click to show where.", actions: vec![toggle] };
    let clipped = clipping::badge(session, view, pixels).map(|badge| (badge, Some(click)));
    let of_view = hidden_terms(view, session, registry).into_iter().chain(no_number(view, session, registry));
    let mut all: Vec<_> = of_view.collect();
    if view != session.active() {
        for click in all.iter_mut().filter_map(|(_, click)| click.as_mut()) {
            click.actions.insert(0, Action::Compare(CompareCommand::Activate(view)));
        }
    }
    all.extend(clipped);
    if !session.document.variants.is_empty() {
        let letter = LETTERS[view.min(MAX_VARIANTS)];
        for text in
            all.iter_mut().flat_map(|(badge, _)| iter::once(&mut badge.text).chain(&mut badge.shorter))
        {
            *text = format!("{letter} · {text}");
        }
    }
    all
}

fn caption(ui: &Ui, rect: Rect, session: &Session, registry: &Registry) -> Rect {
    let palette = Palette::here(ui);
    let terms = [Term::Ambient, Term::Diffuse, Term::Specular, Term::Transmitted];
    let term = terms.into_iter().find(|term| term.alone() == Some(session.terms()));
    let padding = vec2(8.0, 4.0);
    let left = if term.is_some() { 14.0 } else { 0.0 };
    // The axes take the corner if there is room for them.
    let corner = if has_axes(rect) { 100.0 } else { 0.0 };
    let room = (rect.width() - 16.0 - corner - 2.0 * padding.x - left).max(64.0);
    let size = TextStyle::Small.resolve(ui.style()).size;
    let lines = Lines::of(ui, caption::parts(session, registry), size, palette.text, room);
    let size = lines.size + 2.0 * padding + vec2(left, 0.0);
    let place = Align2::LEFT_BOTTOM.anchor_size(rect.left_bottom() + vec2(8.0, -8.0), size);
    ui.painter().rect_filled(place, 4.0, palette.plate());
    if lines.cut {
        let whole = ui.interact(place, ui.id().with("caption"), Sense::hover());
        whole.on_hover_text(caption_text(session, registry));
    }
    lines.paint(ui, place.min + padding + vec2(left, 0.0), palette.text);
    if let Some(term) = term {
        // The colour of the term in the equation.
        let at = pos2(place.left() + 8.0 + 4.0, place.center().y);
        ui.painter().circle_filled(at, 4.0, palette.term_text(term));
    }
    place
}

/// True if a picture has room for the axes.
fn has_axes(rect: Rect) -> bool {
    rect.width() >= AXES.x && rect.height() >= AXES.y
}

/// The world axes as seen by the camera, with letters to tell them apart.
fn axes(ui: &Ui, rect: Rect, session: &Session) -> Rect {
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    let radius = 34.0;
    let centre = rect.right_bottom() - vec2(radius + 8.0, radius + 8.0);
    painter.circle_filled(centre, radius, palette.panel.gamma_multiply(0.72));
    let inverse = session.facts.camera.inverse();
    let mut ends: Vec<(Vec3, &str)> =
        [(Vec3::X, "x"), (Vec3::Y, "y"), (Vec3::Z, "z")].into_iter().map(|(a, n)| (inverse * a, n)).collect();
    // Axes that point away from the eye are painted first.
    ends.sort_by(|a, b| a.0.z.total_cmp(&b.0.z));
    for (direction, name) in ends {
        let length = radius * 0.66;
        let end = centre + vec2(direction.x, -direction.y) * length;
        let colour = if direction.z < -0.2 { palette.weak } else { palette.text };
        painter.line_segment([centre, end], Stroke::new(1.5, colour));
        let outward = vec2(direction.x, -direction.y);
        let place =
            if outward.length() > 0.2 { end + outward.normalized() * 7.0 } else { centre + vec2(8.0, 8.0) };
        painter.text(place, Align2::CENTER_CENTER, name, FontId::new(12.0, theme::maths_italic()), colour);
    }
    Rect::from_center_size(centre, vec2(2.0, 2.0) * radius)
}

/// Shows a hint in place of a missing picture.
fn hint(ui: &Ui, rect: Rect, session: &Session) {
    let text = if session.scene().objects.is_empty() {
        "There is nothing to light. Add an object: + beside “Objects”."
    } else if session.document.lights.is_empty() {
        "It is dark. Add a light: + beside “Lights”."
    } else {
        return;
    };
    let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, FontFamily::Proportional);
    let put = |size| Rect::from_center_size(rect.center(), size);
    plate(ui, rect, put, text, font, 0.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gathered_badge_does_what_the_first_does_that_can_be_clicked() {
        let sign = |text: &str, click: Option<Click>| {
            let badge = Badge {
                severity: Severity::Info,
                text: text.to_owned(),
                shorter: Vec::new(),
                help: String::new(),
            };
            (badge, click)
        };
        let click = |help, change| Some(Click { help, actions: vec![Action::View(change)] });
        let all = [
            sign("A · first", None),
            sign("A · second", click("Click.", ViewChange::Clipping(true))),
            sign("A · third", click("Not this.", ViewChange::Clipping(false))),
        ];
        let made = with_one(&all[..1], &all);
        let [front, (badge, Some(click))] = made.as_slice() else {
            panic!("two, the second of which can be clicked")
        };
        assert_eq!(front.0.text, "A · first");
        assert_eq!((badge.text.as_str(), click.help), ("A · first; A · second; A · third", "Click."));
        assert_eq!(badge.shorter, ["A · 3 notes"]);
        assert!(matches!(click.actions[..], [Action::View(ViewChange::Clipping(true))]));
    }
}
