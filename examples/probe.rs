//! probe
use lights_camera_models::{capture::gpu::*, scene::*};
fn main() {
    bevy::app::App::new().add_plugins(bevy::log::LogPlugin::default());
    let t = std::time::Instant::now();
    let mut r = GpuRenderer::new(640, 360, 4, Output::Display).unwrap();
    println!("new {:?}", t.elapsed());
    let mut s = Scene::default();
    for (i, k) in ["cube", "torus", "teapot"].iter().enumerate() {
        s.objects.push(Object { kind: k.to_string(), position: glam::Vec3::new(2.5 + 2.5 * i as f32, 3.0, 4.0), rotation: glam::Vec3::new(20.0, 30.0, 0.0), reflection_model: Some("phong".into()), ..Object::default() });
    }
    r.set_scene(s.clone());
    r.settle().unwrap();
    println!("settle {:?}", t.elapsed());
    for mode in ["flat", "gouraud", "phong", "derivative"] {
        s.shading_model = mode.into();
        r.set_scene(s.clone());
        r.step();
        let px = r.read_rgb8().unwrap();
        let f = std::fs::File::create(format!("/tmp/w/gpu_{mode}.png")).unwrap();
        let mut e = png::Encoder::new(f, 640, 360); e.set_color(png::ColorType::Rgb);
        e.write_header().unwrap().write_image_data(&px).unwrap();
        println!("{mode} {:?}", t.elapsed());
    }
}
