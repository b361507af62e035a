use super::*;
use crate::scene::Object;
use crate::scene::{Observer, Scene};

const SIZE: [u32; 2] = [320, 180];

fn settings() -> Settings {
    Settings { width: SIZE[0], height: SIZE[1], samples: 1, ..Settings::default() }
}

/// A cube of 2 m, seen from the front and slightly from above and from the right.
fn cube() -> Scene {
    let cube =
        Object { object_type: "cube".to_owned(), size: 2.0, tessellation: Some(1), ..Object::default() };
    let eye = Vec3::new(7.0, 7.0, 9.0);
    Scene {
        objects: vec![Object { position: Vec3::splat(5.0), ..cube }],
        observer: Observer { position: eye, direction: Vec3::splat(5.0) - eye, ..Observer::default() },
        ..Scene::default()
    }
}

fn wires(scene: &Scene, channel: DebugChannel) -> Wires {
    WireDrawer::default().wires(scene, &Registry::builtin(), &settings(), channel, usize::MAX)
}

fn length(wires: &Wires) -> f32 {
    wires.lines.iter().map(|line| line.ends[0].distance(line.ends[1])).sum()
}

#[test]
fn of_a_cube_nine_edges_and_seven_corners_are_in_sight() {
    let scene = cube();
    let edges = wires(&scene, DebugChannel::Wireframe);
    assert!((length(&edges) - 18.0).abs() < 0.3, "{}", length(&edges));
    assert_eq!((edges.drawn, edges.objects, edges.remark()), (1, 1, None));
    // No diagonals: every line runs along an axis, and none ends at the hidden corner.
    for line in &edges.lines {
        let along = (line.ends[1] - line.ends[0]).normalize().abs();
        assert!(along.max_element() > 0.999, "{line:?}");
        assert!(line.ends.iter().all(|end| end.distance(Vec3::splat(4.0)) > 1.0), "{line:?}");
    }
    let corners = wires(&scene, DebugChannel::Vertices);
    assert_eq!((corners.dots.len(), corners.lines.len()), (7, 0));
    let normals = wires(&scene, DebugChannel::VertexNormals);
    assert_eq!(normals.lines.len(), 7);
    for Line { ends: [from, to], colour, .. } in &normals.lines {
        let right = (from - Vec3::splat(5.0)).normalize();
        assert!((to - from).normalize().dot(right) > 0.999);
        let code = (255.0 * (0.5 + 0.5 * right)).round();
        assert_eq!(*colour, code.to_array().map(|c| c as u8));
    }
    // A wrong twin: seen from the other side, the cube shows other corners.
    let eye = Vec3::new(3.0, 3.0, 1.0);
    let behind = Observer { position: eye, direction: Vec3::splat(5.0) - eye, ..Observer::default() };
    let other = wires(&Scene { observer: behind, ..scene }, DebugChannel::Vertices);
    assert!(other.dots.iter().any(|dot| dot.at.distance(Vec3::splat(4.0)) < 1e-3));
}

#[test]
fn what_stands_before_an_object_hides_its_lines() {
    let mut scene = cube();
    let alone = length(&wires(&scene, DebugChannel::Wireframe));
    // A box before the nearest corner.
    let wall = Object { position: Vec3::new(6.3, 6.0, 7.0), size: 0.8, ..scene.objects[0].clone() };
    scene.objects.push(wall);
    let both = wires(&scene, DebugChannel::Wireframe);
    let of_first =
        |line: &&Line| line.ends.iter().all(|p| (*p - Vec3::splat(5.0)).abs().max_element() < 1.001);
    let seen: f32 = both.lines.iter().filter(of_first).map(|l| l.ends[0].distance(l.ends[1])).sum();
    assert!((0.3 * alone..0.95 * alone).contains(&seen), "{seen} of {alone}");
    assert_eq!((both.drawn, both.objects), (2, 2));
    // Nothing is visible behind the eye.
    scene.observer.direction = -scene.observer.direction;
    assert!(wires(&scene, DebugChannel::Wireframe).lines.is_empty());
}

#[test]
fn a_sphere_shows_its_nearer_side_only() {
    let mut scene = cube();
    scene.objects[0] =
        Object { object_type: "sphere".to_owned(), tessellation: Some(16), ..scene.objects[0].clone() };
    let eye = scene.observer.position;
    let corners = wires(&scene, DebugChannel::Vertices);
    let mean =
        |wires: &Wires| wires.lines.iter().map(|line| line.opacity).sum::<f32>() / wires.lines.len() as f32;
    let coarse = mean(&wires(&scene, DebugChannel::Wireframe));
    let mut fine = scene.clone();
    fine.objects[0].tessellation = Some(96);
    let fine = mean(&wires(&fine, DebugChannel::Wireframe));
    assert!(coarse > 2.0 * fine && fine < 0.3, "fine meshes are faint: {coarse}, {fine}");
    assert!(corners.dots.len() > 60, "{}", corners.dots.len());
    for dot in &corners.dots {
        let normal = (dot.at - Vec3::splat(5.0)).normalize();
        assert!(normal.dot((eye - dot.at).normalize()) > -0.15, "{dot:?}");
    }
    // Normals have the same length in the picture, however far the sphere is.
    let pixels = |scene: &Scene| {
        let clip = clip_from_room(&scene.observer, 16.0 / 9.0);
        let place = |p: Vec3| on_screen(clip * p.extend(1.0), SIZE.map(|side| side as f32)).expect("ahead");
        let of = |line: &Line| place(line.ends[0]).distance(place(line.ends[1]));
        wires(scene, DebugChannel::VertexNormals).lines.iter().map(of).fold(0.0, f32::max)
    };
    let near = pixels(&scene);
    scene.observer.position += 2.0 * (eye - Vec3::splat(5.0));
    let far = pixels(&scene);
    assert!((near - 180.0 * NORMAL).abs() < 0.6 && (far - near).abs() < 0.8, "{near} {far}");
}

#[test]
fn dots_have_the_colour_of_their_vertex_or_of_its_normal() {
    let mut scene = cube();
    scene.shading_model = "phong".to_owned();
    let by_normal = wires(&scene, DebugChannel::Vertices);
    scene.shading_model = "gouraud".to_owned();
    let by_light = wires(&scene, DebugChannel::Vertices);
    assert_eq!(by_normal.dots.len(), by_light.dots.len());
    assert!(by_light.dots.iter().all(|dot| dot.colour[0] == dot.colour[2]), "white light on a white cube");
    assert!(
        by_normal.dots.iter().all(|dot| dot.colour[0] != dot.colour[2]
            || dot.colour[1] != dot.colour[2]
            || dot.colour[0] > 128)
    );
    assert_ne!(by_normal, by_light);
    scene.lights.clear();
    let dark = wires(&scene, DebugChannel::Vertices);
    assert!(dark.dots.iter().all(|dot| dot.colour == [0; 3]));
    let apart = |dot: &Dot| dot.rim()[0].abs_diff(dot.colour.into_iter().max().unwrap_or(0)) > 60;
    assert!([by_normal, by_light, dark].iter().flat_map(|wires| &wires.dots).all(apart), "no rim is seen");
}

#[test]
fn where_there_are_too_many_the_nearest_are_drawn_and_it_is_said() {
    let mut scene = cube();
    let one = Object { size: 0.02, ..scene.objects[0].clone() };
    scene.objects = (0..1000)
        .map(|i| Object {
            position: Vec3::new(4.0 + 0.0001 * i as f32, 4.0 + 0.002 * (i % 500) as f32, 5.0),
            ..one.clone()
        })
        .collect();
    let some =
        WireDrawer::default().wires(&scene, &Registry::builtin(), &settings(), DebugChannel::Wireframe, 900);
    assert!(
        some.drawn < 1000 && some.drawn >= AT_ONCE && some.objects == 1000,
        "{} {}",
        some.drawn,
        some.objects
    );
    assert_eq!(some.remark(), Some(format!("only the {} nearest of 1000 objects", some.drawn)));
}

#[test]
fn lines_are_smooth_and_stay_in_the_picture() {
    let mut rgb8 = vec![0; 3 * 20 * 10];
    let mut canvas = Canvas { rgb8: &mut rgb8, size: [20, 10] };
    canvas.line([Vec2::new(-50.0, 5.5), Vec2::new(60.0, 5.5)], 0.5, [200; 3], 1.0);
    let row = |y: usize| rgb8[3 * 20 * y];
    assert_eq!([row(4), row(5), row(6)], [0, 200, 0]);
    let sum = |rgb8: &[u8]| rgb8.iter().map(|c| u32::from(*c)).sum::<u32>();
    let level = sum(&rgb8);
    // Equally dark at an angle and along the rows, per length.
    let mut slanted = vec![0; 3 * 20 * 10];
    let mut canvas = Canvas { rgb8: &mut slanted, size: [20, 10] };
    canvas.line([Vec2::new(0.0, 0.0), Vec2::new(20.0, 10.0)], 0.5, [200; 3], 1.0);
    let ratio = sum(&slanted) as f32 / level as f32 / (20f32.hypot(10.0) / 20.0);
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}
