//! The views of a comparison in the window: one shared camera position, textures of equal size, and positions.

use bevy::{
    camera::{Hdr, RenderTarget},
    ecs::system::SystemParam,
    prelude::*,
    window::{PrimaryWindow, RequestRedraw},
};
use bevy_egui::{PrimaryEguiContext, egui::Rect};

use super::{
    WindowView,
    place::{PicturePlace, area_of},
};
use crate::{
    channel::{DebugChannel, Setting},
    panel::state::{Cell, Converging, PictureArea, Session},
    registry::Registry,
    render::{
        camera::{PictureCamera, picture_camera},
        converge::Converged,
        entities::CurrentScene,
        noise::Noise,
        overrides::Overrides,
        show::{ShownPicture, Shows},
        stage::ViewCopy,
        view::{Drawing, View, background_of, texture_of},
    },
    scene::{Scene, variant::MAX_VARIANTS},
};

/// A view in addition to the main one: 0 is the scene itself, 1 view B.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OtherView(pub(super) usize);

/// The map of the difference between two views, and its size.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(super) struct DifferenceMap(pub(super) Option<(Handle<Image>, UVec2)>);

/// Debug channels of the views, view A first, and the light selected for them.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ShownChannels {
    pub(super) by_view: [Option<DebugChannel>; MAX_VARIANTS + 1],
    pub(super) light: Option<usize>,
}

impl ShownChannels {
    /// The overrides of a view relative to the scene, seen from an eye.
    fn overrides(&self, scene: &Scene, view: usize, registry: &Registry, eye: Vec3) -> Option<Overrides> {
        let own = Overrides::of_view(scene, view);
        let Some(channel) = self.by_view.get(view).copied().flatten() else { return own };
        let setting = Setting::new(channel, scene, registry, eye, self.light);
        Some(Overrides { channel: Some(setting), ..own.unwrap_or_default() })
    }
}

/// The number of the main view: that of the first cell.
pub(super) fn first(area: &PictureArea) -> usize {
    area.cells.first().map_or(0, |cell| cell.view)
}

/// Creates a camera, which follows that of the window, for every visible view, and removes the others.
pub(super) fn set_views(
    area: Option<Res<PictureArea>>,
    scene: Res<CurrentScene>,
    (channels, registry): (Option<Res<ShownChannels>>, Res<Registry>),
    main: Query<(Entity, &View, &Transform, &Camera, &Msaa, Option<&Overrides>), With<WindowView>>,
    mut others: Query<
        (Entity, &OtherView, &mut View, &mut Transform, &mut Camera, Option<&Overrides>),
        Without<WindowView>,
    >,
    mut commands: Commands,
) {
    let Ok((entity, view, place, lens, samples, overrides)) = main.single() else { return };
    let cells: &[Cell] = area.as_deref().map_or(&[], |area| &area.cells);
    let own = area.as_deref().map_or(0, first);
    let channels = channels.as_deref().copied().unwrap_or_default();
    let overrides_of = |view| channels.overrides(&scene.0, view, &registry, place.translation);
    override_view(entity, overrides, overrides_of(own), &mut commands);
    let shown: Vec<_> = cells.iter().map(|cell| cell.view).filter(|shown| *shown != own).collect();
    let mut known = Vec::new();
    for (entity, OtherView(number), mut other, mut transform, mut camera, overrides) in &mut others {
        if !shown.contains(number) || known.contains(number) {
            commands.entity(entity).despawn();
            continue;
        }
        known.push(*number);
        other.set_if_neq(*view);
        transform.set_if_neq(*place);
        if background_of(&camera) != background_of(lens) {
            camera.clear_color = lens.clear_color;
        }
        override_view(entity, overrides, overrides_of(*number), &mut commands);
    }
    for number in shown.into_iter().filter(|number| !known.contains(number)) {
        let samples = if *samples == Msaa::Off { 1 } else { 4 };
        let mut new = commands.spawn((
            picture_camera(samples),
            Hdr,
            RenderTarget::None { size: UVec2::ONE },
            OtherView(number),
            *view,
        ));
        // At the window's camera, whatever moves that one.
        new.insert((PictureCamera { follows_observer: false, fits_width: true }, *place));
        if let Some(overrides) = overrides_of(number) {
            new.insert(overrides);
        }
    }
}

/// Gives a view its overrides.
fn override_view(view: Entity, now: Option<&Overrides>, wanted: Option<Overrides>, commands: &mut Commands) {
    match wanted {
        wanted if wanted.as_ref() == now => {}
        Some(wanted) => _ = commands.entity(view).insert(wanted),
        None => _ = commands.entity(view).remove::<Overrides>(),
    }
}

/// A visible view.
#[derive(Clone, Copy)]
pub(super) struct ShownView<'a> {
    entity: Entity,
    pub(super) view: &'a View,
    pub(super) drawing: &'a Drawing,
    target: &'a RenderTarget,
    overrides: Option<&'a Overrides>,
}

impl<'a> ShownView<'a> {
    pub(super) fn texture(&self) -> Option<&'a Handle<Image>> {
        texture_of(self.target)
    }

    /// True if it shows objects with the models of these overrides.
    pub(super) fn has_shaders_of(&self, wanted: Option<&Overrides>) -> bool {
        let none = Overrides::default();
        self.overrides.unwrap_or(&none).has_shaders_of(wanted.unwrap_or(&none))
    }

    /// True if it shows this drawable: an object, or its copy for a view.
    pub(super) fn shows(&self, copy: Option<&ViewCopy>) -> bool {
        copy.map(|copy| copy.view) == self.overrides.map(|_| self.entity)
    }
}

/// The visible views, by number: 0 is the scene itself, 1 view B.
#[derive(SystemParam)]
pub(super) struct ShownViews<'w, 's> {
    area: Option<Res<'w, PictureArea>>,
    views: Query<
        'w,
        's,
        (
            Entity,
            &'static View,
            &'static Drawing,
            &'static RenderTarget,
            Option<&'static Overrides>,
            Option<&'static OtherView>,
        ),
        Or<(With<WindowView>, With<OtherView>)>,
    >,
}

impl ShownViews<'_, '_> {
    /// Areas of the visible views; empty if there is only one view.
    pub(super) fn cells(&self) -> &[Cell] {
        self.area().map_or(&[], |area| &area.cells)
    }

    /// Area of the picture.
    pub(super) fn area(&self) -> Option<&PictureArea> {
        self.area.as_deref()
    }

    /// The view with the given number.
    pub(super) fn find(&self, number: usize) -> Option<ShownView<'_>> {
        let own = self.area().map_or(0, first);
        let is = |other: Option<&OtherView>| other.map_or(own, |other| other.0) == number;
        let (entity, view, drawing, target, overrides, _) =
            self.views.iter().find(|(.., other)| is(*other))?;
        Some(ShownView { entity, view, drawing, target, overrides })
    }
}

/// Reports to the panels how far the pictures of the views have converged.
pub(super) fn tell_convergence(
    views: ShownViews,
    noise: Option<Res<Noise>>,
    mut session: ResMut<Session>,
    mut requests: MessageWriter<RequestRedraw>,
) {
    let mut awaited = false;
    let now = std::array::from_fn(|view| {
        let Some(ShownView { entity, drawing, .. }) = views.find(view) else { return Converging::default() };
        let Converged { done, total } = drawing.converged();
        awaited |= noise.as_ref().is_some_and(|noise| noise.is_awaited(entity, drawing));
        Converging { done, total, noise: noise.as_ref().and_then(|noise| noise.of(entity, drawing)) }
    });
    let known = &mut session.bypass_change_detection().facts.converged;
    if std::mem::replace(known, now) != now || awaited {
        requests.write(RequestRedraw);
    }
}

/// Shows the textures of the views, and the map of their difference, in their areas.
pub(super) fn show_views(
    views: ShownViews,
    map: Option<Res<DifferenceMap>>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut shows: Single<&mut Shows, With<PrimaryEguiContext>>,
) {
    let area = area_of(views.area.as_deref(), &window);
    let own = first(&area);
    let texture = |view: usize| views.find(view)?.texture().cloned();
    let place = |rect: Rect| PicturePlace::of_rect(rect, area.zoom, &window);
    let mut pictures = Vec::new();
    if area.cells.is_empty() {
        let at = PicturePlace::of(&area, &window).at;
        pictures.extend(texture(own).map(|image| ShownPicture { image, at, part: None }));
    }
    for cell in area.cells.iter().filter(|cell| cell.part.is_positive()) {
        let (whole, part) = (place(cell.rect), place(cell.part));
        let corner = part.at.saturating_sub(whole.at);
        let part = (cell.part != cell.rect).then(|| URect::from_corners(corner, corner + part.size));
        pictures.extend(texture(cell.view).map(|image| ShownPicture { image, at: whole.at, part }));
    }
    if let Some(rect) = area.map {
        let place = place(rect);
        let map = map.and_then(|map| map.0.clone()).filter(|(_, size)| *size == place.size);
        // Until there is a map of these pictures, view A is shown, and the panels say so.
        let image = map.map(|(image, _)| image).or_else(|| texture(own));
        pictures.extend(image.map(|image| ShownPicture { image, at: place.at, part: None }));
    }
    shows.set_if_neq(Shows(pictures));
}
