//! The views of a comparison: the active view, and adding and removing views.

use super::{Converging, Numbers, Session, Severity};
use crate::{
    channel::DebugChannel,
    document::{Edit, Extent, Selection},
    optics::TermSelection,
    parameter::{Value, Values},
    registry::Registry,
    scene::{
        Comparison, Key, Object, Part, Scene, Variant,
        comparison::{Compared, Layout},
        field::Kind,
        part::{Fields as _, Structure as _},
        variant::{LETTERS, MAX_VARIANTS},
    },
};

/// A command for the views of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub enum CompareCommand {
    /// Activate a view, which the panels then show and change: 0 is the scene, 1 view B.
    Activate(usize),
    /// Add a copy of the active view.
    Add,
    /// Remove a view.
    Remove(usize),
    /// Remove all overrides of a view.
    LikeA(usize),
    /// Swap view A with another view.
    Swap(usize),
    /// Choose a layout; a single view gets a second one.
    Layout(Layout),
    /// Choose the next layout.
    NextLayout,
    /// Change other options of the comparison.
    Set(Comparison),
    /// Show the other view while the key is held, where views are shown [in turn](Layout::is_in_turn).
    Blink(bool),
    /// Remove one override of a view.
    Reset(usize, Key),
}

/// A field of a part and its new value; `None` stands for the default.
type Set = (Key, Option<Value>);

fn is_overridable(key: Key) -> bool {
    match key {
        Key::Material(_) => true,
        Key::Own(name) => {
            Variant::FIELDS.iter().any(|field| field.key == name && !matches!(field.kind, Kind::Text(_)))
        }
    }
}

impl Session {
    /// The active view, which the panels show and change: 0 is the scene itself, 1 view B.
    #[must_use]
    pub fn active(&self) -> usize {
        self.view.active.min(self.document.variants.len())
    }

    /// The scene as seen in the active view.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        self.seen.scene(&self.document, self.active())
    }

    /// The view compared with view A: side by side, the active one.
    #[must_use]
    pub fn compared_with(&self) -> usize {
        match self.active() {
            view @ 1.. if self.document.comparison.layout.is_beside() => view,
            _ => self.document.comparison.with,
        }
    }

    /// The view that is on screen where one is shown at a time.
    #[must_use]
    pub fn shown_alone(&self) -> usize {
        match self.active() {
            0 if self.view.blinking => self.document.comparison.with.min(self.document.variants.len()),
            _ if self.view.blinking => 0,
            active => active,
        }
    }

    /// The views on screen.
    #[must_use]
    pub fn views_shown(&self) -> Vec<usize> {
        match self.document.comparison.layout {
            Layout::Single => vec![self.shown_alone()],
            _ => self.document.comparison.views(self.document.variants.len()),
        }
    }

    /// True while the picture of a view is behind, because a shader is not ready.
    #[must_use]
    pub fn compiles(&self, view: usize) -> bool {
        self.facts.compiling.get(view).copied().unwrap_or_default()
    }

    /// The reason why the compared views lack statistics and a difference map, if they do.
    #[must_use]
    pub fn incomparable(&self) -> Option<String> {
        let with = self.compared_with();
        let letter = LETTERS.get(with).copied().unwrap_or("B");
        let name = |channel: Option<DebugChannel>| channel.map_or("the picture", DebugChannel::name);
        match [0, with].map(|view| self.channel_of(view)) {
            [a, b] if a != b => {
                Some(format!("Not compared: A shows {}, {letter} shows {}.", name(a), name(b)))
            }
            [Some(channel), _] if self.document.comparison.values == Compared::Light => {
                Some(format!("Not compared: {} is not light; compare display codes instead.", channel.name()))
            }
            _ => None,
        }
    }

    /// A note that the compared views have not converged, so that there are no statistics and no difference map; `None`
    /// once they have.
    #[must_use]
    pub fn unconverged(&self) -> Option<String> {
        let views = [0, self.compared_with()].map(|view| self.facts.converged[view.min(MAX_VARIANTS)]);
        let least = views.into_iter().max_by_key(Converging::missing)?;
        (least.missing() > 0).then(|| format!("Not converged yet: {}", least.samples()))
    }

    /// Statistics of the compared views; `None` unless both pictures are up to date.
    #[must_use]
    pub fn numbers(&self) -> Option<&Numbers> {
        let is_behind = [0, self.compared_with()].into_iter().any(|view| self.compiles(view));
        self.facts.comparison.as_ref().filter(|_| !is_behind)
    }

    /// The reason why the views on screen have no statistics and no difference map yet; `None` if they have, or if there
    /// is only one.
    #[must_use]
    pub fn no_difference(&self) -> Option<String> {
        let several = self.document.comparison.views(self.document.variants.len()).len() > 1;
        let is_due = several && self.numbers().is_none();
        let measuring = || is_due.then(|| "Measuring the difference…".to_owned());
        self.incomparable().or_else(|| self.unconverged()).or_else(measuring)
    }

    /// The view that is shown as long as there is no difference map, in words.
    #[must_use]
    pub fn shown_for_map(&self) -> Option<&'static str> {
        let is_map = self.document.comparison.layout.is_map();
        (is_map && self.no_difference().is_some()).then_some("Shown: A")
    }

    /// Stores in the scene which view is compared with view A, before the scene is written. Not a step of the history.
    pub fn settle_comparison(&mut self) {
        let with = self.compared_with();
        if with != self.document.comparison.with {
            self.document.amend(|scene| scene.comparison.with = with);
        }
    }

    /// True if the cached scene of the active view is out of date, so that [`look`](Self::look) must be called.
    #[must_use]
    pub fn is_stale(&self) -> bool {
        self.seen.is_stale(&self.document, self.active())
    }

    /// Updates [`scene`](Self::scene) to the active view, at a cost that grows with the changes since the last update.
    pub fn look(&mut self, registry: &Registry) {
        self.view.active = self.active();
        self.seen.look(&self.document, self.view.active, registry);
    }

    /// Overrides of the active view; `None` for view A.
    #[must_use]
    pub fn variant(&self) -> Option<&Variant> {
        self.document.variants.get(self.active().checked_sub(1)?)
    }

    /// The visible terms of the active view.
    #[must_use]
    pub fn terms(&self) -> TermSelection {
        self.terms_of(self.active())
    }

    /// The visible terms of a view.
    #[must_use]
    pub fn terms_of(&self, view: usize) -> TermSelection {
        let own = self.document.overrides(view).and_then(|variant| variant.terms);
        own.unwrap_or(self.view.terms)
    }

    /// The debug channel that a view shows instead of its picture.
    #[must_use]
    pub fn channel_of(&self, view: usize) -> Option<DebugChannel> {
        self.view.channels.get(view).copied().flatten()
    }

    /// The selected light, which debug channels refer to.
    #[must_use]
    pub fn channel_light(&self) -> Option<usize> {
        match self.selection {
            Selection::Light(light) => Some(light),
            _ => None,
        }
    }

    /// The edit that has the effect of `edit` in the active view. Fields that a variant cannot override are changed in
    /// the scene itself.
    pub(super) fn redirected(&self, edit: Edit, registry: &Registry) -> Edit {
        let Some(view) = self.active().checked_sub(1) else { return edit };
        match edit {
            Edit::Set { part, values, what } if self.can_override(part, &values) => {
                let values = self.overrides(part, values, registry);
                Edit::Set { part: Part::Variant(view), values, what }
            }
            edit => edit,
        }
    }

    /// True if a variant can override these fields of a part, those aside that stay as they are.
    fn can_override(&self, part: Part, values: &[Set]) -> bool {
        match part {
            Part::Scene | Part::Object(_) => values.iter().all(|(key, _)| is_overridable(*key)),
            Part::Display => values.iter().all(|set| is_overridable(set.0) || !self.changes_display(set)),
            _ => false,
        }
    }

    /// Values of a part as those of a variant.
    fn overrides(&self, part: Part, mut values: Vec<Set>, registry: &Registry) -> Vec<Set> {
        match part {
            Part::Display => values.retain(|set| self.changes_display(set)),
            // A variant without a value shows the scene's. To have the default, it needs the number itself.
            Part::Object(o) => {
                if let [(key, value @ None)] = &mut values[..]
                    && *key == Object::tessellation.into()
                    && let Some(object) = self.document.objects.get(o)
                {
                    *value = registry.shape(&object.object_type).map(|shape| shape.tessellation(None).into());
                }
            }
            _ => {}
        }
        values
    }

    fn changes_display(&self, (key, value): &Set) -> bool {
        self.scene().display.value(*key) != *value
    }

    pub(super) fn compare(&mut self, command: CompareCommand, registry: &Registry) {
        let comparison = self.document.comparison;
        match command {
            CompareCommand::Activate(view) => self.activate(view, registry),
            CompareCommand::Add => self.add_view(comparison.layout, registry),
            CompareCommand::Layout(layout)
                if self.document.variants.is_empty() && layout != Layout::Single =>
            {
                self.add_view(layout, registry);
            }
            CompareCommand::Layout(layout) => {
                let with = match self.active() {
                    0 => comparison.with,
                    view => view,
                };
                self.set(Comparison { layout, with, ..comparison }, registry);
            }
            CompareCommand::NextLayout => {
                self.compare(CompareCommand::Layout(comparison.layout.next()), registry);
            }
            CompareCommand::Set(comparison) => self.set(comparison, registry),
            CompareCommand::Remove(view) => self.remove_view(view, registry),
            CompareCommand::LikeA(view) => {
                let mut all = self.document.variants.clone();
                let Some(variant) = view.checked_sub(1).and_then(|i| all.get_mut(i)) else { return };
                *variant = Variant { name: variant.name.take(), ..Variant::default() };
                let step = "Make a view like A";
                self.edit_here(Edit::Views { variants: all, comparison, step }, registry);
            }
            CompareCommand::Swap(view) => self.swap_views(view, registry),
            CompareCommand::Blink(on) => self.view.blinking = on,
            CompareCommand::Reset(view, key) => {
                if let Some(i) = view.checked_sub(1) {
                    self.edit_here(Edit::put(Part::Variant(i), key, None::<Value>), registry);
                }
            }
        }
        self.look(registry);
    }

    /// Makes a view the active one, and the one that is compared with view A where two are.
    fn activate(&mut self, view: usize, registry: &Registry) {
        if view > self.document.variants.len() {
            return;
        }
        self.view.active = view;
        let comparison = self.document.comparison;
        if view > 0 && view != comparison.with && comparison.layout.shows_two() {
            self.set(Comparison { with: view, ..comparison }, registry);
        }
    }

    fn set(&mut self, comparison: Comparison, registry: &Registry) {
        if comparison != self.document.comparison {
            self.edit_here(Edit::from(comparison), registry);
        }
    }

    fn add_view(&mut self, layout: Layout, registry: &Registry) {
        let mut all = self.document.variants.clone();
        if all.len() >= MAX_VARIANTS {
            let last = LETTERS[MAX_VARIANTS];
            self.say(Severity::Info, format!("A scene has at most four views, A to {last}."));
            return;
        }
        let copied = self.document.overrides(self.active()).unwrap_or_default();
        all.push(Variant { name: None, ..copied });
        let with = all.len();
        self.show_views(all, with, layout, "Add a view", registry);
        self.view.active = with.min(self.document.variants.len());
    }

    /// Sets the views and the one that is compared with view A, in this layout, or beside each other if it shows one
    /// alone.
    pub(super) fn show_views(
        &mut self,
        variants: Vec<Variant>,
        with: usize,
        layout: Layout,
        step: &'static str,
        registry: &Registry,
    ) {
        let layout = if layout == Layout::Single { Layout::SideBySide } else { layout };
        let comparison = Comparison { layout, with, ..self.document.comparison };
        self.edit_here(Edit::Views { variants, comparison, step }, registry);
        // The views need the room.
        self.view.examples_open = false;
    }

    fn remove_view(&mut self, view: usize, registry: &Registry) {
        let Some(i) = view.checked_sub(1).filter(|i| *i < self.document.variants.len()) else { return };
        let mut all = self.document.variants.clone();
        let gone = all.remove(i);
        // Views based on the removed one inherit its overrides.
        for variant in &mut all {
            if variant.based_on.is_some() && variant.based_on == gone.name {
                let merged = variant.clone().over(&gone);
                *variant = merged;
            }
        }
        let mut comparison = self.document.comparison;
        let with = if comparison.with > view { comparison.with - 1 } else { comparison.with };
        comparison.with = with.clamp(1, all.len().max(1));
        if all.is_empty() {
            comparison.layout = Layout::Single;
        }
        self.edit_here(Edit::Views { variants: all, comparison, step: "Remove a view" }, registry);
        self.view.active = 0;
        let text = format!("Removed view {}.", LETTERS[view]);
        let step = self.last_step();
        self.messages.offer_undo(text, step);
    }

    fn swap_views(&mut self, view: usize, registry: &Registry) {
        let name = format!("Swap A and {}", LETTERS.get(view).copied().unwrap_or("B"));
        match swapped(&self.document, view, registry) {
            Ok(scene) => self.document.change(name, Extent::All, self.selection, |all| *all = scene),
            Err(why) => self.say(Severity::Warning, format!("The views cannot be swapped: {why}.")),
        }
    }
}

/// The scene with view A and another view swapped. Further views keep their appearance.
///
/// # Errors
/// Returns an error if the view does not exist or inherits from another one, if the objects differ in a property that
/// the view overrides for all of them, which a variant cannot hold, or if the view has its own selection of terms,
/// which the scene itself cannot hold.
fn swapped(scene: &Scene, view: usize, registry: &Registry) -> Result<Scene, String> {
    let Some(variant) = scene.overrides(view) else { return Err("there is no such view".to_owned()) };
    if scene.variants[view - 1].based_on.is_some() {
        return Err("the view inherits from another".to_owned());
    }
    if variant.terms.is_some() {
        return Err("the view has its own choice of terms, which the scene itself cannot have".to_owned());
    }
    /// The common value of all objects.
    fn one<T: PartialEq>(mut all: impl Iterator<Item = T>, what: &str) -> Result<Option<T>, String> {
        let Some(first) = all.next() else { return Ok(None) };
        if all.any(|other| other != first) {
            return Err(format!("the objects differ in {what}, but the other view has one for all of them"));
        }
        Ok(Some(first))
    }
    let objects = &scene.objects;
    let mut back = Variant { name: scene.variants[view - 1].name.clone(), ..Variant::default() };
    if variant.reflection_model.is_some() {
        back.reflection_model =
            one(objects.iter().map(|o| scene.model_of(o)), "the reflection model")?.map(str::to_owned);
    }
    if variant.shading_model.is_some() {
        back.shading_model =
            one(objects.iter().map(|o| scene.shading_model_of(o)), "the shading model")?.map(str::to_owned);
    }
    if variant.tessellation.is_some() {
        let counts = objects
            .iter()
            .map(|o| registry.shape(&o.object_type).map_or(1, |shape| shape.tessellation(o.tessellation)));
        back.tessellation = one(counts, "the tessellation")?;
    }
    let mut values = Values::default();
    for name in variant.material.0.keys() {
        let Some(p) = registry.material_parameter(name) else { continue };
        let value: Option<Value> = one(objects.iter().map(|o| o.material.get(p)), p.label)?;
        if let Some(value) = value {
            values.set(p.name, value);
        }
    }
    back.material = values;
    back.tone_mapping = variant.tone_mapping.map(|_| scene.display.tone_mapping);
    back.exposure = variant.exposure.map(|_| scene.display.exposure);
    back.encoding = variant.encoding.map(|_| scene.display.encoding);
    let mut after = variant.applied(scene, registry);
    let swapped = view - 1;
    for (_, other) in after.variants.iter_mut().enumerate().filter(|(i, _)| *i != swapped) {
        if other.based_on.is_some() && other.based_on == back.name {
            other.based_on = None;
        } else if other.based_on.is_none() {
            *other = other.clone().over(&back);
        }
    }
    after.variants[swapped] = back;
    Ok(after)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{panel::state::Action, scene::Object};

    fn session() -> (Session, Registry) {
        (Session::new(Scene::default()), Registry::builtin())
    }

    #[test]
    fn what_is_changed_in_the_active_view_is_overridden_there_and_nowhere_else() {
        let (mut session, registry) = session();
        let before = session.document.clone();
        session.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)), &registry);
        assert_eq!((session.active(), session.document.variants.len()), (1, 1));
        session.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")), &registry);
        session.look(&registry);
        let alpha = Edit::material(Part::Object(0), "alpha", Value::Integer(30));
        session.apply(Action::Edit(alpha), &registry);
        session.look(&registry);
        session.apply(Action::Expose(0.5), &registry);
        session.look(&registry);
        assert_eq!(session.document.reflection_model, before.reflection_model);
        assert_eq!(session.document.objects, before.objects);
        assert_eq!(session.document.display, before.display);
        let variant = session.variant().expect("view B is active");
        assert_eq!(variant.reflection_model.as_deref(), Some("phong"));
        assert_eq!(variant.exposure, Some(0.5));
        assert_eq!(session.scene().objects[0].material.0["alpha"], Value::Integer(30));
        // Properties that a variant cannot override change the scene.
        session.apply(Action::Edit(Edit::set(Part::Object(0), Object::size, 1.0)), &registry);
        assert_eq!(session.document.objects[0].size, 1.0);
        // Back to A, one by one, and all at once.
        session.apply(Action::Compare(CompareCommand::Reset(1, Variant::exposure.into())), &registry);
        assert_eq!(session.variant().and_then(|v| v.exposure), None);
        session.apply(Action::Compare(CompareCommand::LikeA(1)), &registry);
        assert_eq!(session.variant(), Some(&Variant::default()));
        session.apply(Action::Compare(CompareCommand::Remove(1)), &registry);
        assert_eq!(session.document.variants, []);
        assert_eq!(session.document.comparison.layout, Layout::Single);
        assert_eq!(session.active(), 0);
        while session.document.done() > 0 {
            session.apply(Action::Undo, &registry);
        }
        assert_eq!(session.document.variants, []);
        assert_eq!(*session.document, *before);
    }

    #[test]
    fn there_are_at_most_four_views() {
        let (mut session, registry) = session();
        for _ in 0..5 {
            session.apply(Action::Compare(CompareCommand::Add), &registry);
        }
        assert_eq!(session.document.variants.len(), MAX_VARIANTS);
        assert!(session.messages.last().is_some_and(|m| m.text.contains("at most four views")));
    }

    #[test]
    fn swapping_twice_changes_nothing_that_is_seen_and_what_cannot_be_swapped_stays() {
        let (mut session, registry) = session();
        session.apply(Action::Compare(CompareCommand::Add), &registry);
        session.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")), &registry);
        session.look(&registry);
        let alpha = Edit::material(Part::Object(0), "alpha", Value::Integer(30));
        session.apply(Action::Edit(alpha), &registry);
        let both = |session: &Session| {
            [0, 1].map(|view| {
                let (scene, _) = session.document.seen(view, &registry).expect("both views are there");
                let p = registry.material_parameter("alpha").expect("it is declared");
                (scene.model_of(&scene.objects[0]).to_owned(), scene.objects[0].material.get(p))
            })
        };
        let [a, b] = both(&session);
        assert_ne!(a, b);
        session.apply(Action::Compare(CompareCommand::Swap(1)), &registry);
        assert_eq!(both(&session), [b.clone(), a.clone()]);
        session.apply(Action::Compare(CompareCommand::Swap(1)), &registry);
        assert_eq!(both(&session), [a, b]);
        session.document.insert_object(
            1,
            Object {
                reflection_model: Some("eon".to_owned()),
                position: glam::Vec3::splat(3.0),
                ..Object::default()
            },
            "Add",
            session.selection,
            &registry,
        );
        let before = session.document.clone();
        session.apply(Action::Compare(CompareCommand::Swap(1)), &registry);
        assert_eq!(*session.document, *before);
        let said = session.messages.last().map(|m| m.text.clone()).unwrap_or_default();
        assert!(said.contains("the objects differ in the reflection model"), "{said}");
    }
}
