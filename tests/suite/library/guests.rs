//! Panels from other crates: their places, their state, and their abilities.

use bevy::ecs::{resource::Resource, world::World};
use bevy_egui::egui::{Key, Modifiers, Rect, Shape, Ui, vec2};
use glam::Vec3;
use lights_camera_models::{
    document::{Edit, Selection},
    panel::{
        Panel, PanelContext, Place,
        settings::Settings,
        state::{Action, Effect, Session, ViewChange},
    },
    parameters,
    registry::{Register as _, Registry},
    scene::{Part, Scene},
    shape::{self, ObjectType, PolygonMesh, mesh::Polygon},
};

use crate::window::panels::Bench;

/// The press that the guest found in the world.
#[derive(Resource, Default)]
struct Pressed(u32);

/// A panel with state, many rows, and a button for everything that a panel may do.
struct Guest {
    id: &'static str,
    title: &'static str,
    place: Place,
    rows: usize,
    shown: u32,
}

fn guest(id: &'static str, title: &'static str, place: Place, rows: usize) -> Guest {
    Guest { id, title, place, rows, shown: 0 }
}

impl Panel for Guest {
    fn id(&self) -> &'static str {
        self.id
    }

    fn title(&self) -> &'static str {
        self.title
    }

    fn place(&self) -> Place {
        self.place
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        self.shown += 1;
        let pressed = context.world().get_resource::<Pressed>().map_or(0, |pressed| pressed.0);
        ui.label(format!("{} of {}: pressed {pressed} times", self.id, context.document().objects.len()));
        ui.label(format!("{} was shown {}", self.id, if self.shown > 1 { "before" } else { "never" }));
        if ui.button("Everything").clicked() {
            context.edit(Edit::set(Part::Scene, Scene::name, "Changed by a guest"));
            context.act(Action::Select(Selection::Room));
            context.say("said by a guest");
            context.queue(|world| world.get_resource_or_init::<Pressed>().0 += 1);
        }
        for row in 0..self.rows {
            ui.label(format!("{} row {row}", self.id));
        }
    }
}

fn bench(scale: u16, guests: Vec<Guest>) -> Bench {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    guests.into_iter().for_each(|guest| bench.panels.add(guest));
    bench.apply(Action::View(ViewChange::Scale(scale)));
    bench.settle();
    bench
}

/// The position of a painted text.
fn place(bench: &mut Bench, words: &str) -> Option<Rect> {
    bench.shapes().into_iter().find_map(|shape| match shape {
        Shape::Text(text) if text.galley.text() == words => Some(text.visual_bounding_rect()),
        _ => None,
    })
}

#[test]
fn a_guest_keeps_state_reads_the_world_acts_says_and_queues() {
    let mut bench = bench(100, vec![guest("guest", "Guest", Place::Right, 0)]);
    assert!(bench.says("guest of 1: pressed 0 times") && bench.says("guest was shown before"));
    bench.click("Everything");
    assert!(bench.says("guest of 1: pressed 1 times"), "the command has run, and the world is read");
    assert_eq!(bench.session.title(), "Changed by a guest");
    assert_eq!(bench.session.selection, Selection::Room);
    assert_eq!(bench.session.messages.last().expect("said").text, "said by a guest");
    assert_eq!(bench.world.resource::<Pressed>().0, 1);
}

#[test]
fn guests_beside_the_picture_are_whole_in_view_and_leave_room_for_the_lists() {
    for scale in [100, 150] {
        let guests = vec![
            guest("first", "First", Place::Left, 2),
            guest("second", "Second", Place::Right, 2),
            guest("third", "Third", Place::Right, 100),
        ];
        let mut bench = bench(scale, guests);
        let (height, zoom) = (720.0, f32::from(scale) / 100.0);
        let status = height / zoom - 24.0;
        let mut last = 0.0;
        for (title, row) in [("First", "first row 1"), ("Second", "second row 1"), ("Third", "third row 0")] {
            // In large type, content below is scrolled to.
            let before = format!("{} was shown before", title.to_lowercase());
            let row = if scale == 100 { row } else { &before };
            let head = bench.find(title).unwrap_or_else(|| panic!("{title} at {scale} %")).rect;
            let row = place(&mut bench, row).unwrap_or_else(|| panic!("{row} at {scale} %"));
            assert!(row.top() > head.bottom() - 1.0 && row.bottom() < status, "{title}: {head:?}, {row:?}");
            assert!(title != "Third" || head.top() > last, "in the order in which they were added");
            last = head.top();
        }
        // The scene list and the properties keep at least half of their side.
        let first = bench.find("First").expect("a title").rect.top();
        let second = bench.find("Second").expect("a title").rect.top();
        assert!(first > 0.5 * height / zoom && second > 0.4 * height / zoom, "{scale} %: {first}, {second}");
        // Content that does not fit is scrolled, and covers nothing.
        let beyond = place(&mut bench, "third row 99");
        assert!(beyond.is_none_or(|beyond| beyond.top() > status), "{scale} %: {beyond:?}");
        assert!(bench.find("Messages: 0").is_some());
    }
}

#[test]
fn a_long_section_has_the_room_that_short_ones_leave() {
    let short = |id, title| guest(id, title, Place::Right, 0);
    let guests = vec![guest("long", "Long", Place::Right, 100), short("one", "One"), short("two", "Two")];
    let mut bench = bench(100, guests);
    let top = bench.find("Long").expect("a title").rect.top();
    // Equal shares would leave a third of it unused.
    assert!((0.46..0.56).contains(&(top / 720.0)), "{top}");
    for id in ["one", "two"] {
        let button = place(&mut bench, &format!("{id} was shown before"));
        assert!(button.is_some_and(|row| row.bottom() < 696.0), "{id}: {button:?}");
    }
}

#[test]
fn what_a_short_section_shows_ends_above_the_next_title() {
    for scale in [100, 150] {
        let short = |id, title| guest(id, title, Place::Right, 0);
        let bench = bench(scale, vec![short("one", "One"), short("two", "Two")]);
        // The first of two equal buttons; both are in view.
        let buttons = bench.tree.iter().filter(|seen| seen.label == "Everything").map(|seen| seen.rect);
        let button = buttons.min_by(|a, b| a.top().total_cmp(&b.top())).expect("a button");
        let next = bench.find("Two").expect("a title").rect.top();
        assert!(scale > 100 || button.bottom() + 9.0 <= next, "{scale} %: {button:?} {next}");
        assert!(button.bottom() + 0.5 <= next, "{scale} %: {button:?} {next}");
    }
}

#[test]
fn a_section_folds_hides_and_comes_back_from_the_menu_and_settings_keep_it() {
    let mut bench = bench(100, vec![guest("guest", "Guest", Place::Left, 0)]);
    bench.click("Guest");
    assert!(bench.find("Guest").is_some() && !bench.says("guest of 1"), "folded");
    assert!(bench.effects.contains(&Effect::SaveSettings));
    let again = |settings: Settings| {
        let mut session = Session::default();
        session.adopt(settings);
        let mut bench = Bench::new(session);
        bench.panels.add(guest("guest", "Guest", Place::Left, 0));
        bench.settle();
        bench
    };
    let other = again(bench.session.settings.clone());
    assert!(other.find("Guest").is_some() && !other.says("guest of 1"), "still folded");
    bench.click("Guest");
    assert!(bench.says("guest of 1"));
    bench.click("Hide “Guest”; View › Panels shows it again");
    assert!(bench.find("Guest").is_none());
    let other = again(bench.session.settings.clone());
    assert!(other.find("Guest").is_none(), "still hidden");
    bench.apply(Action::View(ViewChange::Left(false)));
    bench.click("View");
    bench.click("Panels ⏵");
    bench.click("Guest");
    assert!(bench.says("guest of 1") && bench.session.view.left_open);
    // The menu is still open: its entry hides it.
    assert!(!bench.session.settings.hides("guest"));
    bench.apply(Action::View(ViewChange::Panel("guest".to_owned(), false)));
    assert!(!bench.says("guest of 1"));
}

#[test]
fn the_tab_of_a_guest_is_open_again_after_a_restart() {
    let mut bench = bench(100, vec![guest("guest", "Guest", Place::Bottom, 50)]);
    assert!(!bench.says("guest of 1"));
    bench.click("View");
    bench.click("Panels ⏵");
    bench.click("Guest");
    assert!(bench.says("guest of 1"));
    let settings = bench.session.settings.clone();
    assert_eq!(settings.guest_tab.as_deref(), Some("guest"));
    for (known, open) in [(true, true), (false, false)] {
        let mut session = Session::default();
        session.adopt(settings.clone());
        let mut panels = Bench::new(Session::default());
        if known {
            panels.panels.add(guest("guest", "Guest", Place::Bottom, 50));
        }
        panels.session = session;
        panels.settle();
        assert_eq!(panels.session.view.bottom_open, open, "a window without it shows no strip");
        assert_eq!(panels.says("guest of 1"), open);
        assert_eq!(panels.session.settings.guest_tab, settings.guest_tab, "nor does it forget");
    }
    bench.apply(Action::View(ViewChange::Bottom(false)));
    assert_eq!(bench.session.settings.guest_tab, None);
}

#[test]
fn a_guest_may_take_the_place_of_a_built_in_panel() {
    let mut bench = bench(100, vec![guest("tree", "Tree of another", Place::Left, 0)]);
    bench.settle();
    assert!(
        bench.says("tree of 1") && bench.find("Tree of another").is_none(),
        "without a title, as the list has none"
    );
}

#[test]
fn the_built_in_glyphs_are_shown_as_they_are() {
    let mut bench = bench(100, Vec::new());
    bench.click("Edit");
    bench.click("Add a light ⏵");
    for light in bench.registry.clone().lights() {
        let entry = format!("{}  {}", light.declaration.glyph, light.declaration.name);
        assert!(bench.find(&entry).is_some(), "{entry}");
    }
    bench.click("Add an object ⏵");
    for shape in bench.registry.clone().shapes() {
        let entry = format!("{}  {}", shape.declaration.glyph, shape.declaration.name);
        assert!(bench.find(&entry).is_some(), "{entry}");
    }
}

#[test]
fn the_names_in_a_menu_of_types_begin_below_each_other() {
    let mut bench = bench(100, Vec::new());
    let registry = bench.registry.clone();
    let lights = registry.lights().iter().map(|light| (light.declaration.glyph, light.declaration.name));
    let shapes = registry.shapes().iter().map(|shape| (shape.declaration.glyph, shape.declaration.name));
    let [lights, shapes]: [Vec<_>; 2] = [lights.collect(), shapes.collect()];
    for (path, types) in [
        (&["Edit", "Add a light ⏵"][..], &lights),
        (&["Edit", "Add an object ⏵"], &shapes),
        (&["Add a light"], &lights),
        (&["Add an object"], &shapes),
    ] {
        path.iter().for_each(|button| bench.click(button));
        let (mut starts, shapes) = (Vec::new(), bench.shapes());
        for (glyph, name) in types {
            let entry = bench.find(&format!("{glyph}  {name}")).expect("an entry").rect;
            let span = |words: &str| {
                shapes.iter().find_map(|shape| match shape {
                    Shape::Text(text) if text.galley.text() == words && entry.contains(text.pos) => {
                        Some((text.pos.x, text.pos.x + text.galley.size().x))
                    }
                    _ => None,
                })
            };
            let (sign, text) = (span(glyph).expect("the glyph"), span(name).expect("the name"));
            assert!(sign.1 < text.0, "{name}: {sign:?} {text:?}");
            starts.push(text.0);
        }
        assert!(starts.iter().all(|x| (x - starts[0]).abs() < 0.5), "{path:?}: {starts:?}");
        bench.key(Key::Escape, Modifiers::NONE);
        bench.key(Key::Escape, Modifiers::NONE);
    }
}

parameters! {
    /// A shape whose name and glyph no font has.
    struct Prism {}
}

impl ObjectType for Prism {
    const DECLARATION: shape::Declaration = shape::Declaration::new("prism", "𝔓rism").glyph("⏢");

    fn mesh(&self, _: u32) -> PolygonMesh {
        let mut mesh = PolygonMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            polygons: vec![
                Polygon::triangle(0, 2, 1),
                Polygon::triangle(0, 1, 3),
                Polygon::triangle(0, 3, 2),
                Polygon::triangle(1, 2, 3),
            ],
        };
        mesh.normalise();
        mesh
    }
}

#[test]
fn what_the_fonts_lack_is_replaced_by_what_can_be_read() {
    let mut bench = bench(100, vec![guest("guest", "Яркость 𐍈", Place::Right, 0)]);
    let title = place(&mut bench, "Яркость 𐍈");
    assert_eq!(title, None, "not with a box in it");
    let shown: Vec<String> = bench
        .shapes()
        .into_iter()
        .filter_map(|shape| match shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        })
        .collect();
    let title = shown.iter().find(|t| t.contains("hv") || t.contains("ркость") || t.contains("Iarkost"));
    assert!(title.is_some(), "{shown:?}");
    let mut registry = Registry::builtin();
    registry.add_object_type::<Prism>();
    bench.registry = registry;
    bench.click("Edit");
    bench.click("Add an object ⏵");
    let entries: Vec<_> = bench.tree.iter().filter(|s| s.label.contains("rism")).collect();
    assert_eq!(entries.len(), 1, "{entries:?}");
    assert!(entries[0].label.starts_with("P  "), "the letter of its name: {}", entries[0].label);
}

#[test]
fn commands_of_panels_run_in_their_order_and_once() {
    let mut bench = bench(100, vec![guest("guest", "Guest", Place::Right, 0)]);
    bench.click("Everything");
    bench.settle();
    assert_eq!(bench.world.resource::<Pressed>().0, 1);
    let mut empty = World::new();
    for command in bench.panels.take_queued() {
        command(&mut empty);
    }
    assert!(empty.get_resource::<Pressed>().is_none());
}

/// A panel that panics when its button is pressed.
struct Fragile;

impl Panel for Fragile {
    fn id(&self) -> &'static str {
        "fragile"
    }

    fn title(&self) -> &'static str {
        "Fragile"
    }

    fn place(&self) -> Place {
        Place::Right
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        ui.label("Whole");
        if context.document().name.as_deref() == Some("Break") {
            panic!("{} lights are too many", context.document().lights.len());
        }
    }
}

#[test]
fn a_panel_that_panics_is_named_and_the_window_goes_on() {
    let mut bench = bench(100, vec![guest("sound", "Sound", Place::Left, 1)]);
    bench.panels.add(Fragile);
    bench.settle();
    assert!(bench.says("Whole"));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::name, "Break")));
    bench.settle();
    let lights = bench.session.document.lights.len();
    let why = format!("{lights} lights are too many");
    let said: Vec<_> = bench.session.messages.iter().filter(|m| m.text.contains("Fragile")).collect();
    assert_eq!(said.len(), 1, "once");
    assert_eq!(
        said[0].text,
        format!("The panel “Fragile” (fragile) crashed: {why}. The window continues without it.")
    );
    assert!(bench.says(&format!("This panel stopped: {why}")) && !bench.says("Whole"));
    assert!(bench.says("sound row 0"), "the others are there");
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::name, "Mended")));
    bench.click("Show it again");
    bench.settle();
    assert!(bench.says("Whole"));
}
