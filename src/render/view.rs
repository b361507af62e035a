//! Views: pictures in separate textures, drawn again only when something that they show has changed.
//!
//! A view is a camera with a [`View`]. The texture has the displayed size, and keeps the last picture while
//! nothing is drawn, so that windows can show it as often as they like.

use bevy::{
    asset::{AssetEventSystems, RenderAssetUsages},
    camera::{
        CameraUpdateSystems, Hdr, RenderTarget, SubCameraView, primitives::Frustum,
        visibility::VisibilitySystems,
    },
    core_pipeline::tonemapping::Tonemapping,
    ecs::system::SystemParam,
    math::primitives::ViewFrustum,
    prelude::*,
    render::{
        render_resource::{TextureFormat, TextureUsages},
        storage::ShaderBuffer,
    },
};
use std::collections::HashSet;

use super::{
    converge::{Converged, Convergence, Part},
    drawn::{ByChance, Drawn},
    entities::CurrentScene,
    illumination::{IlluminationBuffer, ShownTerms},
    overrides::Overrides,
    parts::Animated,
    shown::Shown,
    stage::{Stage, ViewCopy},
    tables::ParameterTables,
};
use crate::registry::Registry;

/// Number of pictures drawn after a change: the second includes what the renderer could not prepare for the
/// first.
const PICTURES: u32 = 2;

/// Creates the textures of views, and draws views only when something changed.
pub(super) fn plugin(app: &mut App) {
    let rest = rest.after(AssetEventSystems).after(CameraUpdateSystems);
    let systems = (
        fit.before(AssetEventSystems).before(CameraUpdateSystems),
        frame.after(VisibilitySystems::UpdateFrusta),
        rest.before(VisibilitySystems::CheckVisibility),
    );
    app.init_resource::<Convergence>().add_systems(PostUpdate, systems.chain().in_set(ViewSystems));
}

/// The systems that create the textures of views and decide which views are drawn.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ViewSystems;

/// A picture that is drawn into a separate texture when something that it shows has changed.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[require(Drawing)]
pub struct View {
    /// The size of the picture in pixels. If it is zero, nothing is drawn.
    pub size: UVec2,
    /// Format of the texture.
    pub format: TextureFormat,
    /// The part of the picture covered by the lens, in pixels; the picture continues around it. `None` if it
    /// is all of it.
    pub inset: Option<URect>,
}

impl View {
    /// A view for display: 8 bits, sRGB-encoded.
    #[must_use]
    pub const fn for_display(size: UVec2) -> Self {
        Self { size, format: TextureFormat::Rgba8UnormSrgb, inset: None }
    }
}

/// The state of a view's picture.
#[derive(Component, Clone, Debug, Default)]
pub struct Drawing {
    last: Option<Look>,
    /// Number of pictures drawn since the last change, at most [`PICTURES`].
    recent: u32,
    /// Number of pictures drawn.
    drawn: u64,
    /// Number of the first of them after the last change.
    pub(super) began: u64,
    /// True if one is drawn in this frame.
    draws: bool,
    /// The samples of light with extent; none without such light.
    converged: Converged,
    /// The samples drawn in this frame.
    pub(super) part: Option<Part>,
}

impl Drawing {
    /// Draws the picture again, after a change known only to the caller.
    pub fn redraw(&mut self) {
        self.recent = 0;
    }

    /// True in a frame in which the picture is drawn.
    #[must_use]
    pub fn draws(&self) -> bool {
        self.draws
    }

    /// True once the picture is up to date.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.recent == PICTURES && self.converged.is_done()
    }

    /// The samples of light with extent of which the picture is the mean; 0 of 0 without such light.
    #[must_use]
    pub fn converged(&self) -> Converged {
        self.converged
    }

    /// True if the picture is up to date, and is not drawn in this frame.
    #[must_use]
    pub fn rests(&self) -> bool {
        self.is_done() && !self.draws()
    }

    /// The number of pictures drawn so far.
    #[must_use]
    pub fn drawn(&self) -> u64 {
        self.drawn
    }
}

/// Everything that a camera shows, besides the scene.
#[derive(Clone, Debug, PartialEq)]
struct Look {
    view: View,
    transform: Transform,
    /// Field of view and aspect of the lens.
    lens: Option<[f32; 2]>,
    background: Option<Color>,
    tone: Tonemapping,
    overrides: Option<Overrides>,
}

/// The texture into which a view draws.
#[must_use]
pub fn texture_of(target: &RenderTarget) -> Option<&Handle<Image>> {
    match target {
        RenderTarget::Image(image) => Some(&image.handle),
        _ => None,
    }
}

/// The background of a camera, if it has its own.
#[must_use]
pub fn background_of(camera: &Camera) -> Option<Color> {
    match camera.clear_color {
        ClearColorConfig::Custom(colour) => Some(colour),
        _ => None,
    }
}

/// Gives every view a texture of its size.
pub(super) fn fit(
    mut images: ResMut<Assets<Image>>,
    mut views: Query<(&View, &mut Camera, &mut RenderTarget, &mut Projection), Changed<View>>,
) {
    for (view, mut camera, mut target, mut lens) in &mut views {
        camera.sub_camera_view = view.inset.map(|inset| SubCameraView {
            full_size: inset.size(),
            offset: -inset.min.as_vec2(),
            size: view.size,
        });
        let known = texture_of(&target)
            .and_then(|handle| images.get(handle))
            .map(|image| (image.size(), image.texture_descriptor.format));
        if view.size.min_element() == 0 || known == Some((view.size, view.format)) {
            continue;
        }
        let mut image = Image::new_target_texture(view.size.x, view.size.y, view.format, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        image.asset_usage = RenderAssetUsages::default();
        *target = RenderTarget::Image(images.add(image).into());
        // Cameras check their target when their lens changes.
        lens.set_changed();
    }
}

/// Widens the frustum: around an inset more is visible than the lens covers.
fn frame(mut views: Query<(&Camera, &GlobalTransform, &Projection, &mut Frustum), With<View>>) {
    for (camera, transform, lens, mut frustum) in &mut views {
        let clip_from_world = camera.clip_from_view() * transform.affine().inverse();
        *frustum = Frustum(ViewFrustum::from_clip_from_world_custom_far(
            &clip_from_world,
            &transform.translation(),
            &transform.back(),
            lens.far(),
        ));
    }
}

/// All sources of changes.
#[derive(SystemParam)]
struct Changes<'w, 's> {
    scene: Res<'w, CurrentScene>,
    terms: Res<'w, ShownTerms>,
    registry: Res<'w, Registry>,
    shared: Res<'w, IlluminationBuffer>,
    tables: Res<'w, ParameterTables>,
    stages: Query<'w, 's, (Entity, &'static Stage)>,
    drawn: Query<'w, 's, Option<&'static ViewCopy>, Changed<Drawn>>,
    animated: Query<'w, 's, (), (With<Animated>, Or<(Changed<Transform>, Changed<Visibility>)>)>,
    rested: RemovedComponents<'w, 's, Animated>,
    shaders: MessageReader<'w, 's, AssetEvent<Shader>>,
    meshes: MessageReader<'w, 's, AssetEvent<Mesh>>,
    buffers: MessageReader<'w, 's, AssetEvent<ShaderBuffer>>,
}

impl Changes<'_, '_> {
    /// True if every view must be drawn; otherwise the views with overrides that must be, and `None` for
    /// those without.
    fn find(&mut self) -> (bool, HashSet<Option<Entity>>) {
        // All are read, so that no change is left for the next frame.
        let told = [self.shaders.read().count(), self.meshes.read().count()];
        let mut all =
            told.iter().any(|count| *count > 0) || self.scene.is_changed() || self.registry.is_changed();
        all |= self.rested.read().count() > 0 || !self.animated.is_empty();
        let mut some: HashSet<_> = self.drawn.iter().map(|s| s.map(|s| s.view)).collect();
        if self.terms.is_changed() {
            some.insert(None);
        }
        for event in self.buffers.read() {
            let (AssetEvent::Added { id } | AssetEvent::Modified { id }) = event else { continue };
            let lit = |(view, stage): (Entity, &Stage)| stage.illumination.has(*id).then_some(Some(view));
            let shared = || self.shared.buffers.has(*id).then_some(None);
            match self.tables.view_of(*id).or_else(shared).or_else(|| self.stages.iter().find_map(lit)) {
                Some(view) => _ = some.insert(view),
                None => all = true,
            }
        }
        (all, some)
    }
}

/// Chooses the views drawn in this frame, and the samples of light with extent in the converging ones.
fn rest(
    mut changes: Changes,
    shown: Res<Shown>,
    mut convergence: ResMut<Convergence>,
    mut views: Query<(
        Entity,
        &View,
        &mut Drawing,
        &mut Camera,
        &Transform,
        &Projection,
        &Tonemapping,
        Option<&Overrides>,
        Has<Hdr>,
    )>,
    by_chance: Query<Option<&ViewCopy>, With<ByChance>>,
) {
    let (all, some) = changes.find();
    let extent = shown.has_extent(&changes.registry);
    let target = convergence.target.max(1);
    // True if a picture begins, and the minimum number of samples missing in another.
    let (mut begins, mut missing) = (false, None::<u32>);
    for (entity, view, mut drawing, mut camera, transform, lens, tone, overrides, hdr) in &mut views {
        let look = Look {
            view: *view,
            transform: *transform,
            lens: match lens {
                Projection::Perspective(lens) => Some([lens.fov, lens.aspect_ratio]),
                _ => None,
            },
            background: background_of(&camera),
            tone: *tone,
            overrides: overrides.cloned(),
        };
        let own = overrides.map(|_| entity);
        let at_once =
            overrides.and_then(|o| o.channel.as_ref()).is_some_and(|own| own.channel.is_of_remaining());
        let sampled = !at_once && (extent || by_chance.iter().any(|copy| copy.map(|copy| copy.view) == own));
        let total = if hdr && sampled { target } else { 0 };
        let changed = all || some.contains(&own) || drawing.last.as_ref() != Some(&look);
        if changed || drawing.converged.total != total {
            drawing.last = Some(look);
            drawing.recent = 0;
            drawing.converged.total = total;
        }
        let starts = drawing.recent < PICTURES;
        if starts {
            drawing.converged.done = 0;
            drawing.began = drawing.drawn + 1;
        }
        let draws = !drawing.is_done() && view.size.min_element() > 0;
        if draws {
            drawing.recent = (drawing.recent + 1).min(PICTURES);
            drawing.drawn += 1;
            let Converged { done, total } = drawing.converged;
            begins |= starts && total > 0;
            if !starts {
                missing = Some(missing.map_or(total - done, |least| least.min(total - done)));
            }
        }
        drawing.draws = draws;
        if camera.is_active != draws {
            camera.is_active = draws;
        }
    }
    let converges = begins || missing.is_some();
    let part = converges.then(|| convergence.bypass_change_detection().part(begins, missing));
    if !converges {
        convergence.bypass_change_detection().rest();
    }
    for (_, _, mut drawing, ..) in &mut views {
        let drawing = drawing.bypass_change_detection();
        drawing.part = part.filter(|_| drawing.draws && drawing.converged.total > 0);
        if let Some(Part { count, .. }) = drawing.part {
            drawing.converged.done += count;
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::{
        MinimalPlugins,
        app::Update,
        asset::{AssetApp as _, AssetId, AssetPlugin},
    };

    use super::*;
    use crate::{
        optics::TermSelection,
        reference::LightSamples,
        scene::{Light, Object, Scene},
    };

    const SIZE: UVec2 = UVec2::new(64, 48);

    /// An app with views of one scene, without a renderer.
    fn app(views: usize) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, AssetPlugin::default()))
            .init_asset::<Image>()
            .add_message::<AssetEvent<Shader>>()
            .add_message::<AssetEvent<Mesh>>()
            .insert_resource(CurrentScene(Scene { objects: vec![Object::default(); 4], ..Scene::default() }))
            .insert_resource(Registry::builtin())
            .init_asset::<ShaderBuffer>()
            .init_resource::<ShownTerms>()
            .init_resource::<Shown>()
            .init_resource::<Convergence>()
            .init_resource::<IlluminationBuffer>()
            .init_resource::<ParameterTables>()
            .add_systems(Update, (fit, rest).chain());
        for _ in 0..views {
            app.world_mut().spawn((
                View::for_display(SIZE),
                Camera::default(),
                RenderTarget::None { size: UVec2::ONE },
                Transform::default(),
                Projection::default(),
                Tonemapping::AgX,
            ));
        }
        app
    }

    /// For each view, true if the next frame draws it.
    fn drawn(app: &mut App) -> Vec<bool> {
        app.update();
        let world = app.world_mut();
        let mut views = world.query::<(&Camera, &Drawing)>();
        views
            .iter(world)
            .map(|(camera, drawing)| {
                assert_eq!(camera.is_active, drawing.draws());
                camera.is_active
            })
            .collect()
    }

    fn rest_all(app: &mut App) {
        for _ in 0..2 * PICTURES {
            drawn(app);
        }
        assert!(drawn(app).iter().all(|draws| !draws));
    }

    #[test]
    fn a_view_is_drawn_when_something_that_it_shows_changes_and_then_rests() {
        let mut app = app(1);
        assert!(drawn(&mut app)[0] && drawn(&mut app)[0]);
        rest_all(&mut app);
        let changes: [(&str, fn(&mut World)); 12] = [
            ("an object", |w| w.resource_mut::<CurrentScene>().0.objects[3].size = 1.0),
            ("what is animated", |w| _ = w.spawn((Animated, Transform::default()))),
            ("what is animated no more", |w| {
                let mut animated = w.query_filtered::<Entity, With<Animated>>();
                let entity = animated.iter(w).next().expect("there is one");
                w.entity_mut(entity).remove::<Animated>();
            }),
            ("the terms", |w| w.resource_mut::<ShownTerms>().set_changed()),
            ("the models", |w| w.resource_mut::<Registry>().set_changed()),
            ("the camera", |w| one::<Transform>(w).translation.x += 1.0),
            ("the background", |w| one::<Camera>(w).clear_color = ClearColorConfig::Custom(Color::BLACK)),
            ("the tone curve", |w| *one::<Tonemapping>(w) = Tonemapping::Reinhard),
            ("the size", |w| one::<View>(w).size.x += 1),
            ("what only the caller knows", |w| one::<Drawing>(w).redraw()),
            ("a table", |w| {
                w.write_message(AssetEvent::<ShaderBuffer>::Modified { id: AssetId::default() });
            }),
            ("a shader", |w| {
                w.write_message(AssetEvent::<Shader>::Modified { id: AssetId::default() });
            }),
        ];
        for (what, change) in changes {
            let world = app.world_mut();
            let before = one::<Drawing>(world).drawn();
            change(app.world_mut());
            assert!(drawn(&mut app)[0], "{what}");
            rest_all(&mut app);
            assert_eq!(one::<Drawing>(app.world_mut()).drawn() - before, u64::from(PICTURES), "{what}");
        }
    }

    /// The component of the only view.
    fn one<C: Component<Mutability = bevy::ecs::component::Mutable>>(world: &mut World) -> Mut<'_, C> {
        let mut views = world.query_filtered::<&mut C, With<View>>();
        views.iter_mut(world).next().expect("there is a view")
    }

    #[test]
    fn a_view_of_light_that_goes_by_chance_converges_and_others_do_not() {
        let mut app = app(2);
        let world = app.world_mut();
        let mut cameras = world.query_filtered::<Entity, With<View>>();
        let views: Vec<_> = cameras.iter(world).collect();
        views.iter().for_each(|view| _ = world.entity_mut(*view).insert(Hdr));
        world
            .entity_mut(views[1])
            .insert(Overrides { terms: Some(TermSelection::All), ..Overrides::default() });
        let totals = |app: &mut App| {
            app.update();
            views.iter().map(|v| app.world().get::<Drawing>(*v).expect("a view").converged.total).collect()
        };
        let none: Vec<u32> = totals(&mut app);
        assert_eq!(none, [0, 0]);
        let body = app.world_mut().spawn((ByChance, ViewCopy { view: views[1] })).id();
        let target = LightSamples::DEFAULT;
        let own: Vec<u32> = totals(&mut app);
        assert_eq!(own, [0, target]);
        app.world_mut().entity_mut(body).remove::<ViewCopy>();
        let common: Vec<u32> = totals(&mut app);
        assert_eq!(common, [target, 0]);
    }

    #[test]
    fn only_lights_with_extent_that_shine_make_a_view_converge() {
        let mut app = app(1);
        let world = app.world_mut();
        let view = world.query_filtered::<Entity, With<View>>().iter(world).next().expect("there is a view");
        world.entity_mut(view).insert(Hdr);
        let lit = |app: &mut App, light_type: &str, enabled: bool| {
            let light = Light { light_type: light_type.to_owned(), enabled, ..Light::default() };
            let types = Registry::builtin().light_set([light_type]);
            *app.world_mut().resource_mut::<Shown>() =
                Shown { lights: vec![light], types, ..Shown::default() };
            app.update();
            app.world().get::<Drawing>(view).expect("a view").converged.total
        };
        for (light_type, enabled, total) in [
            ("environment", true, LightSamples::DEFAULT),
            ("environment", false, 0),
            ("rectangle", true, LightSamples::DEFAULT),
            ("rectangle", false, 0),
            ("point", true, 0),
        ] {
            assert_eq!(lit(&mut app, light_type, enabled), total, "{light_type}, {enabled}");
        }
    }

    #[test]
    fn a_change_of_one_view_draws_no_other() {
        let mut app = app(2);
        rest_all(&mut app);
        one::<Transform>(app.world_mut()).translation.y = 3.0;
        assert_eq!(drawn(&mut app), [true, false]);
    }

    #[test]
    fn a_change_of_what_one_view_overrides_draws_no_other() {
        let mut app = app(3);
        let world = app.world_mut();
        let views: Vec<_> = world.query_filtered::<Entity, With<View>>().iter(world).collect();
        for view in &views[..2] {
            world.entity_mut(*view).insert(Overrides::default());
        }
        rest_all(&mut app);
        let drawable = |app: &mut App| app.world_mut().spawn(Drawn::default()).id();
        let changes: [(&str, &dyn Fn(&mut App), [bool; 3]); 4] = [
            (
                "an override",
                &|app| {
                    let mut overrides =
                        app.world_mut().get_mut::<Overrides>(views[0]).expect("it has overrides");
                    overrides.shading_model = Some("flat".to_owned());
                },
                [true, false, false],
            ),
            (
                "a copy",
                &|app| {
                    let copy = drawable(app);
                    app.world_mut().entity_mut(copy).insert(ViewCopy { view: views[1] });
                },
                [false, true, false],
            ),
            ("an object", &|app| _ = drawable(app), [false, false, true]),
            (
                "the terms",
                &|app| app.world_mut().resource_mut::<ShownTerms>().set_changed(),
                [false, false, true],
            ),
        ];
        for (what, change, expected) in changes {
            change(&mut app);
            app.update();
            let draws = |view: &Entity| app.world().get::<Drawing>(*view).is_some_and(Drawing::draws);
            assert_eq!(views.iter().map(draws).collect::<Vec<_>>(), expected, "{what}");
            rest_all(&mut app);
        }
    }

    #[test]
    fn textures_have_the_size_at_which_a_view_is_seen_and_none_is_made_in_vain() {
        let mut app = app(1);
        let texture = |app: &mut App| {
            app.update();
            let world = app.world_mut();
            let handle = texture_of(&one::<RenderTarget>(world)).cloned();
            handle
                .map(|handle| (handle.id(), world.resource::<Assets<Image>>().get(&handle).map(Image::size)))
        };
        let first = texture(&mut app);
        assert_eq!(first.as_ref().and_then(|t| t.1), Some(SIZE));
        one::<View>(app.world_mut()).set_changed();
        assert_eq!(texture(&mut app), first);
        one::<View>(app.world_mut()).size = UVec2::new(10, 20);
        assert_eq!(texture(&mut app).and_then(|t| t.1), Some(UVec2::new(10, 20)));
        // A picture that is not visible is not drawn.
        one::<View>(app.world_mut()).size = UVec2::new(0, 20);
        assert_eq!(drawn(&mut app), [false]);
    }
}
