//! Debug channels: each pixel matches its formula, on the GPU and on the CPU, and the window and the command
//! line show them.

use std::{fs, ops::Range, path::Path};

use bevy_egui::egui::{Key, Modifiers};
use glam::Vec3;
use lights_camera_models::{
    channel::{
        DebugChannel, Setting,
        colours::{BELOW, NAN, TOWARDS},
    },
    explain::{Explainer, Inside},
    optics::{TermSelection, colour::luminance, tone::ToneMapping, viridis::viridis},
    panel::{
        state::{Action, Session, ViewChange},
        wires,
    },
    parameter::Value,
    reference::{self, LightSamples, render_channel},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        illumination::REMAINING_SAMPLES,
    },
    scene::{Display, Light, Object, Observer, Scene, Variant},
};

use crate::{
    helpers::pictures::close_up,
    helpers::screen::Picture,
    helpers::support::{builtin, lcm_in, root},
    window::panels::Bench,
};

const SIZE: u32 = 97;

fn settings() -> reference::Settings {
    reference::Settings { width: SIZE, height: SIZE, samples: 1, ..reference::Settings::default() }
}

fn renderer() -> GpuRenderer {
    GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed")
}

fn setting(channel: DebugChannel, scene: &Scene) -> Setting {
    Setting::new(channel, scene, &builtin(), scene.observer.position, None)
}

fn on_cpu(scene: &Scene, channel: DebugChannel) -> Vec<u8> {
    render_channel(scene, &builtin(), &settings(), &setting(channel, scene))
}

fn on_gpu(renderer: &mut GpuRenderer, scene: &Scene, channel: Option<DebugChannel>) -> Vec<u8> {
    renderer.set_scene(scene.clone());
    renderer.set_channel(channel.map(|channel| setting(channel, scene)));
    renderer.settle().expect("the GPU draws");
    renderer.read_rgb8().expect("the picture can be read")
}

/// The fraction of pixels with a channel that differs by more than some codes.
fn share(a: &[u8], b: &[u8], tolerance: u8) -> f32 {
    let (a, b) = (a.as_chunks::<3>().0, b.as_chunks::<3>().0);
    assert_eq!(a.len(), b.len());
    let off = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > tolerance);
    a.iter().zip(b).filter(off).count() as f32 / a.len() as f32
}

#[test]
fn both_renderers_draw_the_same_channels_with_every_shading_model() {
    let mut renderer = renderer();
    for (shape, light, shading) in [
        ("sphere", "point", "flat"),
        ("torus", "directional", "gouraud"),
        ("cube", "spot", "phong"),
        ("sphere", "point", "derivative"),
    ] {
        let mut scene = close_up(shape, light);
        scene.shading_model = shading.to_owned();
        // Neither may leave traces in channels.
        scene.display = Display { exposure: 1.5, tone_mapping: ToneMapping::AgX, ..scene.display };
        let gpu = DebugChannel::ALL.map(|channel| on_gpu(&mut renderer, &scene, Some(channel)));
        let cpu = DebugChannel::ALL.map(|channel| on_cpu(&scene, channel));
        for (i, channel) in DebugChannel::ALL.into_iter().enumerate() {
            let right = share(&gpu[i], &cpu[i], 3);
            assert!(right < 0.02, "{shape}, {shading}, {channel:?}: {right} of the pixels differ");
            // Wrong twins: every other channel. Two may be equal where nothing is special.
            for (j, other) in DebugChannel::ALL.into_iter().enumerate() {
                if i == j || (channel.is_of_light() && other.is_of_light()) {
                    continue;
                }
                let alike = |a, b| [channel, other] == [a, b] || [other, channel] == [a, b];
                let flat = shape == "cube" && alike(DebugChannel::Normals, DebugChannel::FaceNormals);
                let wrong = share(&gpu[i], &cpu[j], 3);
                assert!(flat || wrong > 0.02, "{shape}, {channel:?}: {other:?} goes unnoticed, {wrong}");
            }
        }
    }
}

/// A sphere whose nearest point is in the middle of the picture, lit from 45° above, and another beside the picture.
fn head_on() -> Scene {
    let sphere = |position, size| Object {
        object_type: "sphere".to_owned(),
        position,
        size,
        tessellation: Some(64),
        ..Object::default()
    };
    Scene {
        lights: vec![Light {
            light_type: "directional".to_owned(),
            direction: Some(Vec3::new(0.0, -1.0, -1.0)),
            intensity: 0.5,
            ..Light::default()
        }],
        observer: Observer {
            position: Vec3::new(5.0, 5.0, 9.0),
            direction: Vec3::NEG_Z,
            ..Observer::default()
        },
        objects: vec![sphere(Vec3::splat(5.0), 2.0), sphere(Vec3::new(8.0, 5.0, 8.0), 1.0)],
        shading_model: "phong".to_owned(),
        ..Scene::default()
    }
}

fn middle(picture: &[u8]) -> [u8; 3] {
    picture.as_chunks::<3>().0[(SIZE * SIZE / 2) as usize]
}

fn bytes(codes: Vec3) -> [u8; 3] {
    (255.0 * codes).to_array().map(|c| c.round() as u8)
}

#[test]
fn each_channel_is_its_formula_at_a_point_that_is_known() {
    let scene = head_on();
    let picture = reference::render(&scene, &Registry::builtin(), &settings());
    let light = picture.pixel(SIZE / 2, SIZE / 2).truncate();
    let cos = |degrees: f32| degrees.to_radians().cos();
    let depth = setting(DebugChannel::Depth, &scene);
    assert_eq!(depth.range, [2.6, 5.0], "the nearest is that beside the picture");
    let expected = [
        (DebugChannel::Normals, [128, 128, 255]),
        (DebugChannel::FaceNormals, [128, 128, 255]),
        (DebugChannel::NDotL, bytes(viridis(cos(45.0)))),
        (DebugChannel::NDotV, bytes(viridis(1.0))),
        (DebugChannel::NDotH, bytes(viridis(cos(22.5)))),
        (DebugChannel::Facing, TOWARDS),
        (DebugChannel::Depth, bytes(viridis((3.0 - 2.6) / (5.0 - 2.6)))),
        (DebugChannel::Luminance, bytes(viridis((luminance(light).log10() + 3.0) / 4.0))),
    ];
    let mut renderer = renderer();
    let near = |a: [u8; 3], b: [u8; 3]| (0..3).all(|c| a[c].abs_diff(b[c]) <= 8);
    for (channel, right) in expected {
        let found =
            [on_cpu(&scene, channel), on_gpu(&mut renderer, &scene, Some(channel))].map(|p| middle(&p));
        assert!(found.iter().all(|f| near(*f, right)), "{channel:?}: {found:?} instead of {right:?}");
    }
    // A wrong twin, the light behind the sphere.
    let mut behind = scene.clone();
    behind.lights[0].direction = Some(Vec3::new(0.0, 1.0, 1.0));
    for found in
        [on_cpu(&behind, DebugChannel::NDotL), on_gpu(&mut renderer, &behind, Some(DebugChannel::NDotL))]
    {
        assert_eq!(middle(&found), BELOW);
    }
}

#[test]
fn a_picture_is_the_same_before_and_after_a_channel() {
    let mut renderer = renderer();
    let scene = close_up("torus", "point");
    let before = on_gpu(&mut renderer, &scene, None);
    let during = on_gpu(&mut renderer, &scene, Some(DebugChannel::NDotV));
    assert!(share(&before, &during, 3) > 0.1);
    assert_eq!(on_gpu(&mut renderer, &scene, None), before);
}

#[test]
fn light_that_is_not_a_number_is_shown_by_both_renderers() {
    let mut renderer = renderer();
    for shading in ["flat", "gouraud", "phong"] {
        let mut scene = head_on();
        scene.shading_model = shading.to_owned();
        let fine = [
            on_cpu(&scene, DebugChannel::NotANumber),
            on_gpu(&mut renderer, &scene, Some(DebugChannel::NotANumber)),
        ];
        assert!(fine.iter().all(|picture| !picture.as_chunks::<3>().0.contains(&NAN)), "{shading}");
        scene.lights[0].intensity = f32::NAN;
        for channel in [DebugChannel::NotANumber, DebugChannel::Luminance, DebugChannel::Clipped] {
            assert_eq!(middle(&on_cpu(&scene, channel)), NAN, "{shading}, {channel:?}");
            let gpu = on_gpu(&mut renderer, &scene, Some(channel));
            assert_eq!(middle(&gpu), NAN, "{shading}, {channel:?} on the GPU");
        }
    }
}

#[test]
fn light_that_remains_in_solids_is_shown_by_both_renderers() {
    let mut renderer = renderer();
    let channel = DebugChannel::RemainingLight;
    let bright = |picture: &[u8]| {
        let shown = |p: &&[u8; 3]| **p != [0; 3] && p[0].abs_diff(p[1]) > 4;
        picture.as_chunks::<3>().0.iter().filter(shown).count()
    };
    for (shape, shading, index, roughness) in [
        ("cube", "derivative", 2.4, 0.0),
        ("torus", "phong", 2.4, 0.0),
        ("cube", "flat", 2.4, 0.0),
        ("cube", "derivative", 2.4, 0.4),
    ] {
        let mut scene = close_up(shape, "point");
        scene.reflection_model = "glass".to_owned();
        scene.shading_model = shading.to_owned();
        for (name, number) in [("refractive_index", index), ("roughness", roughness)] {
            scene.objects[0].material.set(name, Value::Number(number));
        }
        // As many ways by chance as the other renderer takes.
        let (samples, setting) = (LightSamples::of(REMAINING_SAMPLES), setting(channel, &scene));
        let cpu = reference::render_channel_by(&scene, &builtin(), &settings(), &setting, samples);
        let gpu = on_gpu(&mut renderer, &scene, Some(channel));
        assert!(bright(&cpu) > 200, "{shape}, {shading}: {} pixels", bright(&cpu));
        let off = share(&gpu, &cpu, 3);
        assert!(off < 0.02, "{shape}, {shading}, {roughness}: {off} of the pixels differ");
        if shading != "flat" && roughness == 0.0 {
            // It is the number of the explanation.
            let (mut compared, registry, mut explainer) = (0, builtin(), Explainer::default());
            let pixels = cpu.as_chunks::<3>().0.iter().enumerate().filter(|(_, p)| p[0].abs_diff(p[1]) > 4);
            for (i, pixel) in pixels.step_by(97) {
                let at = [i as u32 % SIZE, i as u32 / SIZE];
                let explained = explainer.pixel(&scene, &registry, &settings(), at).expect("within");
                let seen = explained.seen.expect("the object");
                let refraction = seen.spots[0].refraction.as_ref().expect("it bends light");
                let Some(Inside::Ways(_, remaining)) = &refraction.inside else { panic!("{refraction:?}") };
                let right = bytes(viridis((luminance(*remaining).log10() + 4.0) / 4.0));
                assert!((0..3).all(|c| pixel[c].abs_diff(right[c]) <= 2), "{at:?}: {pixel:?}, not {right:?}");
                compared += 1;
            }
            assert!(compared > 1, "{shape}");
        }
    }
    // A ball keeps nothing but at its rim, where nearly everything is reflected, and other objects nothing at all.
    for model in ["glass", "phong", "diffuse_transmission"] {
        let mut scene = close_up("sphere", "point");
        scene.reflection_model = model.to_owned();
        for picture in [on_cpu(&scene, channel), on_gpu(&mut renderer, &scene, Some(channel))] {
            let most = if model == "glass" { 200 } else { 0 };
            assert!(bright(&picture) <= most && middle(&picture) == [0; 3], "{model}: {}", bright(&picture));
        }
    }
}

#[test]
fn what_is_cut_off_is_striped() {
    let mut scene = head_on();
    scene.lights[0].intensity = 40.0;
    let mut renderer = renderer();
    let black = |picture: &[u8]| picture.as_chunks::<3>().0.iter().filter(|p| **p == [0; 3]).count();
    let bright = |picture: &[u8]| picture.as_chunks::<3>().0.iter().filter(|p| **p == [240, 228, 66]).count();
    for picture in
        [on_cpu(&scene, DebugChannel::Clipped), on_gpu(&mut renderer, &scene, Some(DebugChannel::Clipped))]
    {
        assert!(black(&picture) > 100 && bright(&picture) > 100, "{} {}", black(&picture), bright(&picture));
    }
    scene.display.exposure = -10.0;
    assert_eq!(bright(&on_cpu(&scene, DebugChannel::Clipped)), 0, "after exposure nothing is");
}

#[test]
fn one_light_alone_is_the_picture_without_the_others() {
    let mut scene = close_up("sphere", "point");
    scene.lights.push(Light { position: Some(Vec3::new(1.0, 5.0, 8.0)), ..scene.lights[0].clone() });
    scene.lights.push(Light { enabled: false, ..scene.lights[0].clone() });
    let registry = Registry::builtin();
    let mut renderer = renderer();
    for chosen in [0, 1] {
        let mut alone = scene.clone();
        alone.lights = vec![scene.lights[chosen].clone()];
        let right = reference::render_rgb8(&alone, &registry, &settings());
        let eye = scene.observer.position;
        let setting = Setting::new(DebugChannel::Light, &scene, &registry, eye, Some(chosen));
        assert_eq!(render_channel(&scene, &registry, &settings(), &setting), right);
        renderer.set_scene(scene.clone());
        renderer.set_channel(Some(setting));
        renderer.settle().expect("the GPU draws");
        let gpu = renderer.read_rgb8().expect("the picture can be read");
        assert!(share(&gpu, &right, 2) < 0.02);
        let all = reference::render_rgb8(&scene, &registry, &settings());
        assert!(share(&gpu, &all, 2) > 0.05, "all lights go unnoticed");
    }
}

#[test]
fn keys_menu_and_legend_show_a_channel_and_the_picture_again() {
    let mut bench = Bench::new(Session::default());
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.settle();
    let legend = |bench: &Bench| {
        bench
            .tree
            .iter()
            .find(|s| s.label.starts_with("Channel: "))
            .map(|s| (s.label.clone(), s.rect.center()))
    };
    assert_eq!(legend(&bench), None);
    bench.key(Key::X, Modifiers::NONE);
    assert_eq!(bench.session.channel_of(0), Some(DebugChannel::ALL[0]));
    bench.settle();
    assert!(legend(&bench).is_some_and(|(text, _)| text.contains("Interpolated normals")));
    for _ in 1..DebugChannel::ALL.len() {
        bench.key(Key::X, Modifiers::NONE);
    }
    assert_eq!(bench.session.channel_of(0), Some(DebugChannel::Light));
    bench.key(Key::X, Modifiers::NONE);
    assert_eq!(bench.session.channel_of(0), None, "at the end comes the picture");
    bench.click("View");
    bench.click("Channel ⏵");
    bench.click("Depth");
    assert_eq!(bench.session.channel_of(0), Some(DebugChannel::Depth));
    bench.settle();
    let (text, at) = legend(&bench).expect("it is shown");
    assert!(text.contains("distance from the eye, m"), "{text}");
    bench.click_at(at, bevy_egui::egui::PointerButton::Primary);
    assert_eq!(bench.session.channel_of(0), None, "a click on the legend");
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotL))));
    bench.key(Key::X, Modifiers::SHIFT);
    assert_eq!(bench.session.channel_of(0), None);
}

#[test]
fn both_renderers_draw_the_same_lines_and_dots_over_a_dim_surface() {
    let mut renderer = renderer();
    for (shape, shading) in [("torus", "flat"), ("sphere", "gouraud"), ("cube", "phong")] {
        let mut scene = close_up(shape, "point");
        scene.shading_model = shading.to_owned();
        let ground = on_cpu(&scene, DebugChannel::NotANumber);
        let wires: Vec<_> = DebugChannel::ALL.into_iter().filter(|channel| channel.has_wires()).collect();
        assert_eq!(wires.len(), 3);
        let cpu: Vec<_> = wires.iter().map(|channel| on_cpu(&scene, *channel)).collect();
        for (i, channel) in wires.iter().enumerate() {
            let gpu = on_gpu(&mut renderer, &scene, Some(*channel));
            let right = share(&gpu, &cpu[i], 3);
            assert!(right < 0.01, "{shape}, {channel:?}: {right} of the pixels differ");
            let over = share(&gpu, &ground, 30);
            assert!((0.005..0.8).contains(&over), "{shape}, {channel:?}: {over} of the picture are lines");
            // Wrong twins: the others.
            for other in (0..3).filter(|other| *other != i) {
                let wrong = share(&gpu, &cpu[other], 3);
                assert!(
                    wrong > 2.0 * right + 0.005,
                    "{shape}, {channel:?}: {:?} goes unnoticed",
                    wires[other]
                );
            }
        }
    }
}

/// Waits until the lines of a view are finished; returns them with the number of calculations.
fn lines(bench: &mut Bench, view: usize) -> (std::sync::Arc<reference::Wires>, u64) {
    let mut before = None;
    for _ in 0..15_000 {
        bench.settle();
        std::thread::sleep(std::time::Duration::from_millis(4));
        let found = wires::shown(&bench.ctx, view);
        match (&before, &found) {
            (Some(Some((old, count))), Some((new, now)))
                if count == now && std::sync::Arc::ptr_eq(old, new) =>
            {
                return found.expect("there");
            }
            _ => before = Some(found),
        }
    }
    panic!("the lines are never finished");
}

/// The largest untextured mesh over the picture: its number of vertices, and the mean of those that are not
/// transparent.
fn drawn(bench: &mut Bench) -> (usize, bevy_egui::egui::Vec2) {
    let meshes = bench.shapes().into_iter().filter_map(|shape| match shape {
        bevy_egui::egui::Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    });
    let Some(mesh) = meshes.max_by_key(|mesh| mesh.vertices.len()) else { return Default::default() };
    let seen: Vec<_> = mesh.vertices.iter().filter(|v| v.color.a() > 0).map(|v| v.pos.to_vec2()).collect();
    (
        mesh.vertices.len(),
        seen.iter().fold(bevy_egui::egui::Vec2::ZERO, |sum, at| sum + *at) / seen.len() as f32,
    )
}

#[test]
fn the_window_draws_lines_over_each_view_and_follows_the_camera() {
    let mut bench = Bench::new(Session::new(head_on()));
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.settle();
    let (before, _) = drawn(&mut bench);
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::Wireframe))));
    let (wires, first) = lines(&mut bench, 0);
    assert!(wires.lines.len() > 1000 && wires.dots.is_empty() && wires.remark().is_none());
    let (vertices, at) = drawn(&mut bench);
    assert!(vertices >= 6 * 1000 && vertices > before);
    let (same, count) = lines(&mut bench, 0);
    assert!(std::sync::Arc::ptr_eq(&wires, &same) && count == first, "nothing changed");

    bench.session.facts.eye += Vec3::new(0.4, 0.0, 0.0);
    // On a busy machine the previous ones are shown for a while.
    let new = (0..100).map(|_| lines(&mut bench, 0)).find(|(new, _)| !std::sync::Arc::ptr_eq(&wires, new));
    assert!(new.expect("other lines").1 > first);
    assert!(drawn(&mut bench).1.x < at.x - 5.0, "the camera went to the right");
    bench.key(Key::X, Modifiers::NONE);
    let (dots, _) = lines(&mut bench, 0);
    assert!(bench.session.channel_of(0) == Some(DebugChannel::Vertices) && dots.dots.len() > 500);
    bench.key(Key::X, Modifiers::SHIFT);
    bench.settle();
    assert!(wires::shown(&bench.ctx, 0).is_none() && drawn(&mut bench).0 < 6000);
}

#[test]
fn with_very_many_objects_the_window_draws_the_nearest_and_says_so() {
    let mut scene = head_on();
    let cube = Object {
        object_type: "cube".to_owned(),
        size: 0.05,
        tessellation: Some(8),
        ..scene.objects[0].clone()
    };
    let at = |i: usize| {
        Vec3::new(4.0 + 0.1 * (i % 20) as f32, 4.0 + 0.1 * (i / 20 % 20) as f32, 5.0 - 0.1 * (i / 400) as f32)
    };
    scene.objects = (0..1600).map(|i| Object { position: at(i), ..cube.clone() }).collect();
    let mut bench = Bench::new(Session::new(scene));
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::Wireframe))));
    let (wires, _) = lines(&mut bench, 0);
    assert!(wires.drawn < wires.objects && wires.objects > 400, "{} of {}", wires.drawn, wires.objects);
    bench.settle();
    assert!(bench.says(&format!("only the {} nearest of {} objects", wires.drawn, wires.objects)));
}

#[test]
fn every_view_has_a_channel_of_its_own() {
    let scene = Scene { variants: vec![Variant::default()], ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::View(ViewChange::Channel(Some(DebugChannel::NDotV))));
    bench.key(Key::K, Modifiers::COMMAND);
    assert_eq!((bench.session.view.active, bench.session.channel_of(1)), (1, None));
    bench.key(Key::X, Modifiers::NONE);
    let shown = [0, 1].map(|view| bench.session.channel_of(view));
    assert_eq!(shown, [Some(DebugChannel::NDotV), Some(DebugChannel::Normals)]);
    bench.session.opened(Path::new("other.json").to_owned(), Scene::default());
    assert_eq!(bench.session.channel_of(0), None, "another scene begins with its picture");
}

#[test]
fn terms_are_said_to_be_hidden_only_where_the_picture_has_them() {
    let mut bench = Bench::with_model("phong");
    bench.size = bevy_egui::egui::vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Terms(TermSelection::Diffuse)));
    for channel in DebugChannel::ALL.iter().copied().map(Some).chain([None]) {
        bench.apply(Action::View(ViewChange::Channel(channel)));
        bench.settle();
        let has_terms = channel.is_none_or(DebugChannel::is_of_light);
        assert_eq!(bench.says("Only the diffuse term"), has_terms, "{channel:?}");
    }
    assert!(DebugChannel::Luminance.is_of_light() && !DebugChannel::Depth.is_of_light());
}

#[test]
fn the_command_line_draws_channels_with_legends_and_says_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let all = ["render", "-o", "x.png", "--size", "320x180", "--renderer", "cpu"];
        lcm_in(folder.path(), &[&all, more].concat(), b"")
    };
    for channel in DebugChannel::ALL {
        let run = run(&["--channel", channel.id()]);
        assert_eq!(run.status, Some(0), "{}", run.err);
        assert!(folder.path().join("x.png").is_file());
    }
    let dark = |file: &str| Picture::read(&folder.path().join(file)).count(6..30, 6..30, |p| p[0] < 40);
    assert_eq!(run(&["--channel", "depth"]).status, Some(0));
    assert!(dark("x.png") > 300, "the plate of the legend");
    assert_eq!(run(&["--channel", "depth", "--no-legend"]).status, Some(0));
    assert_eq!(dark("x.png"), 0);
    for (arguments, status, said) in [
        (&["--channel", "normal"][..], 2, "did you mean normals?"),
        (&["--channel", "x"], 2, "it must be normals, face_normals, vertex_normals"),
        (&["--light", "1"], 2, "--channel"),
        (&["--channel", "n_dot_l", "--light", "77"], 1, "there is no light \"77\"; it must be "),
        (
            &["--channel", "depth", "--light", "1"],
            1,
            "--light is for channels of one light, and depth is not one",
        ),
    ] {
        let run = run(arguments);
        assert!(run.status == Some(status) && run.err.contains(said), "{:?} {}", run.status, run.err);
    }
}

#[test]
fn each_view_in_a_picture_has_its_own_legend_clear_of_its_letter() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(root().join("scenes/compare_gouraud_phong.json")).expect("it ships");
    let phong = text.replace("\"shading_model\": \"gouraud\"", "\"shading_model\": \"phong\"");
    assert_ne!(text, phong);
    for (name, text) in [("two.json", text), ("phong.json", phong)] {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let drawn = |scene: &str, more: &[&str]| {
        let all = ["render", scene, "-o", "x.png", "--size", "640x360", "--renderer", "cpu"];
        let run = lcm_in(folder.path(), &[&all[..], &["--channel", "vertices"], more].concat(), b"");
        assert_eq!(run.status, Some(0), "{}", run.err);
        Picture::read(&folder.path().join("x.png"))
    };
    // One view alone: as if it were the scene.
    let alone = ["B", "A"].map(|view| drawn("two.json", &["--view", view]).pixels);
    assert!(alone[0] == drawn("phong.json", &["--view", "A"]).pixels, "the legend of another view");
    assert!(alone[0] != alone[1]);
    // The legend appears where it makes a difference.
    let red = |picture: &Picture, x: Range<u32>| picture.count(x, 0..360, |p| p == [255, 128, 128]);
    for layout in ["side_by_side", "wipe"] {
        let with = drawn("two.json", &["--layout", layout]);
        let without = drawn("two.json", &["--layout", layout, "--no-legend"]);
        let changed = |x: Range<u32>, y: Range<u32>| {
            let all = y.flat_map(|y| x.clone().map(move |x| (x, y)));
            all.filter(|(x, y)| with.at(*x, *y) != without.at(*x, *y)).count()
        };
        // Letters are in the first rows.
        assert_eq!(changed(0..640, 0..18), 0, "{layout}");
        for side in [0..318, 322..640] {
            assert!(changed(side.clone(), 18..200) > 500, "{layout}: {side:?} has no legend");
        }
        // Where no vertex has a colour, the axes of normals are explained.
        let more = [0..318, 322..640].map(|side| red(&with, side.clone()).abs_diff(red(&without, side)));
        assert!(more[0] == 0 && more[1] > 20, "{layout}: {more:?}");
    }
    // A map of differences shows both.
    let with = drawn("two.json", &["--layout", "difference"]);
    assert!(red(&with, 0..640) > 20, "the legend of B");
}

#[test]
fn exported_shaders_have_no_trace_of_channels() {
    let folder = tempfile::tempdir().unwrap();
    let mut seen = 0;
    for (form, to) in [("wgsl", "wgsl"), ("glsl", "glsl"), ("html", "page.html"), ("bevy", "bevy")] {
        let run = lcm_in(folder.path(), &["export", "--as", form, "-o", to], b"");
        assert_eq!(run.status, Some(0), "{form}: {}", run.err);
        let mut folders = vec![folder.path().join(to)];
        while let Some(at) = folders.pop() {
            if at.is_dir() {
                folders.extend(std::fs::read_dir(&at).unwrap().map(|entry| entry.unwrap().path()));
            } else if let Ok(text) = std::fs::read_to_string(&at) {
                seen += 1;
                for trace in ["channel_", "CHANNEL_", "illumination.channel"] {
                    assert!(!text.contains(trace), "{}: {trace}", at.display());
                }
            }
        }
    }
    assert!(seen >= 3, "{seen} files");
}
