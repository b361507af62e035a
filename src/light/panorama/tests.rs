use std::{
    f64::consts::{PI, TAU},
    io::Cursor,
    path::Path,
    time::{Duration, Instant},
};

use exr::prelude::{
    Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2 as At, WritableImage as _,
};
use glam::{Vec2, Vec3};
use image::{Rgb, codecs::hdr::HdrEncoder};

use super::{FORMAT, MAX_COLUMNS, Panorama, of_pixels as numbers};
use crate::{
    optics::colour::luminance,
    parameter::{NamedFile, Shipped},
    registry::compose::FILE_TABLE,
    shader::{
        Source,
        check::validate,
        compose::{Composer, LIGHT_ALONE, OPTICS, PANORAMA, Sources},
        interpret::Program,
    },
    testing::random,
};

/// A Radiance file with these pixels.
fn hdr(width: usize, pixel: impl Fn(usize, usize) -> [f32; 3]) -> Vec<u8> {
    let height = width / 2;
    let pixels: Vec<_> = (0..width * height).map(|i| Rgb(pixel(i % width, i / width))).collect();
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes).encode(&pixels, width, height).expect("written");
    bytes
}

/// An OpenEXR file with one layer of these pixels.
fn exr(
    size: [usize; 2],
    encoding: Encoding,
    own: LayerAttributes,
    pixel: impl Fn(usize, usize) -> [f32; 3] + Sync + 'static,
) -> Vec<u8> {
    let channels = SpecificChannels::rgb(move |at: At<usize>| {
        let [r, g, b] = pixel(at.x(), at.y());
        (r, g, b)
    });
    written(&Image::from_layer(Layer::new((size[0], size[1]), own, encoding, channels)))
}

fn written<L>(image: &Image<L>) -> Vec<u8>
where
    for<'a> L: exr::image::write::layers::WritableLayers<'a>,
{
    let mut bytes = Vec::new();
    image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).expect("written");
    bytes
}

/// Numbers that differ from pixel to pixel, all representable in Radiance's format.
fn pattern(column: usize, row: usize) -> [f32; 3] {
    [128 + (7 * column + 3 * row) % 128, 128, 128 + row].map(|n| n as f32 / 64.0)
}

/// A uniformly distributed direction.
fn any_direction(seed: &mut u64) -> Vec3 {
    let [u, v] = [random(seed), random(seed)].map(f64::from);
    direction(u, (1.0 - 2.0 * v).acos() / PI)
}

/// The direction of a position in the picture, from 0 to 1 across and down.
fn direction(across: f64, down: f64) -> Vec3 {
    let (phi, theta) = (TAU * (across - 0.5), PI * down);
    glam::DVec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos()).as_vec3()
}

#[test]
fn a_uniform_picture_has_the_density_of_the_sphere() {
    let numbers = numbers(64, |_, _| [2.0, 3.0, 4.0]);
    let picture = Panorama::new(&numbers).expect("a picture");
    let mut seed = 1;
    for _ in 0..1000 {
        let d = any_direction(&mut seed);
        assert_eq!(picture.radiance(d), Vec3::new(2.0, 3.0, 4.0));
        assert!((4.0 * PI * f64::from(picture.pdf(d)) - 1.0).abs() < 1e-6);
    }
    // Without sin θ, the wrong twin, half of the points would be within 45° of the poles instead of 1 − cos
    // 45°.
    let count = 20_000;
    let near_poles = (0..count)
        .filter(|i| {
            let u = Vec2::new(random(&mut seed), (*i as f32 + 0.5) / count as f32);
            let (d, light, pdf) = picture.sample(u);
            assert!((d.length() - 1.0).abs() < 1e-6);
            assert_eq!((light, pdf), (picture.radiance(d), picture.pdf(d)));
            d.y.abs() > std::f32::consts::FRAC_1_SQRT_2
        })
        .count();
    let share = near_poles as f64 / f64::from(count);
    assert!((share - (1.0 - 0.5_f64.sqrt())).abs() < 1e-3, "{share}");
}

#[test]
fn the_top_looks_up_the_middle_along_minus_z_and_the_right_along_x() {
    // Each pixel has its own colour.
    let numbers = numbers(8, |column, row| [column as f32, row as f32, 1.0]);
    let picture = Panorama::new(&numbers).expect("a picture");
    let at = |x: f32, y: f32, z: f32| picture.radiance(Vec3::new(x, y, z).normalize()).truncate();
    // Slightly to the right of and below the centre.
    assert_eq!(at(0.1, -0.1, -1.0), Vec2::new(4.0, 2.0));
    assert_eq!(at(-0.1, 0.1, -1.0), Vec2::new(3.0, 1.0));
    // The wrong twin is the mirrored picture.
    assert_eq!(at(1.0, 0.1, -0.1), Vec2::new(5.0, 1.0));
    assert_eq!(at(-1.0, 0.1, -0.1), Vec2::new(2.0, 1.0));
    // At the seam behind, and at the poles.
    assert_eq!(at(1e-5, 0.1, 1.0), Vec2::new(7.0, 1.0));
    assert_eq!(at(-1e-5, 0.1, 1.0), Vec2::new(0.0, 1.0));
    assert_eq!(at(0.0, 0.0, 1.0).x, 7.0);
    assert_eq!(at(-0.0, 0.0, 1.0).x, 7.0);
    for tiny in [0.0, -0.0, 1e-30, -1e-30] {
        for other in [0.0, -0.0, 1e-30, -1e-30] {
            assert_eq!(at(tiny, 1.0, other).y, 0.0);
            assert_eq!(at(tiny, -1.0, other).y, 3.0);
        }
    }
    // The sampled directions have the same order as the pixels.
    for i in 0..8 {
        for j in 0..4 {
            let d = direction((f64::from(i) + 0.5) / 8.0, (f64::from(j) + 0.5) / 4.0);
            assert_eq!(picture.radiance(d).truncate(), Vec2::new(i as f32, j as f32));
        }
    }
}

/// A dark room with a bright window and a dim lamp on the ceiling.
fn contrasts(column: usize, row: usize) -> [f32; 3] {
    match (column, row) {
        (20..24, 12..17) => [3000.0, 4000.0, 5000.0],
        (40..64, 0) => [90.0, 60.0, 10.0],
        // Nothing comes from below.
        (_, 24..) => [0.0; 3],
        _ => [0.5, 1.0, 2.0 * (1 + column % 3) as f32],
    }
}

/// Pearson's statistic of samples divided by its degrees of freedom, for cells of 8 × 8 pixels, where
/// `expected` is the density for each direction.
fn chi_squared(picture: &Panorama, expected: impl Fn(Vec3) -> f64) -> f64 {
    let count = 40_000;
    let mut seen = [[0.0; 8]; 4];
    let mut seed = 5;
    for _ in 0..count {
        let (d, ..) = picture.sample(Vec2::new(random(&mut seed), random(&mut seed)));
        let phi = f64::from(d.x).atan2(f64::from(-d.z));
        let [i, j] = [(0.5 + phi / TAU) * 8.0, f64::from(d.y).acos() / PI * 4.0];
        seen[(j as usize).min(3)][(i as usize).min(7)] += 1.0;
    }
    let (mut sum, mut cells) = (0.0, -1.0);
    for (j, row) in seen.iter().enumerate() {
        for (i, seen) in row.iter().enumerate() {
            // The integral over the pixels of the cell.
            let mut probability = 0.0;
            for y in 8 * j..8 * j + 8 {
                let solid = TAU / 64.0 * ((PI * y as f64 / 32.0).cos() - (PI * (y + 1) as f64 / 32.0).cos());
                for x in 8 * i..8 * i + 8 {
                    probability +=
                        solid * expected(direction((x as f64 + 0.5) / 64.0, (y as f64 + 0.5) / 32.0));
                }
            }
            let mean = f64::from(count) * probability;
            if mean > 5.0 {
                sum += (seen - mean) * (seen - mean) / mean;
                cells += 1.0;
            } else {
                assert!(*seen < 20.0, "{seen} points where {mean} should be");
            }
        }
    }
    assert!(cells > 10.0, "{cells}");
    sum / cells
}

#[test]
fn samples_are_as_dense_as_the_density_says() {
    let numbers = numbers(64, contrasts);
    let picture = Panorama::new(&numbers).expect("a picture");
    let whole: f64 = (0..64 * 32)
        .map(|i| {
            let (x, y) = ((i % 64) as f64, (i / 64) as f64);
            let solid = TAU / 64.0 * ((PI * y / 32.0).cos() - (PI * (y + 1.0) / 32.0).cos());
            solid * f64::from(picture.pdf(direction((x + 0.5) / 64.0, (y + 0.5) / 32.0)))
        })
        .sum();
    assert!((whole - 1.0).abs() < 1e-6, "{whole}");
    let right = chi_squared(&picture, |d| f64::from(picture.pdf(d)));
    assert!(right < 2.0, "{right}");
    // The wrong twin: by luminance alone, without sin θ, and normalised.
    let sine = |d: Vec3| f64::from(d.x.hypot(d.z)).max(1e-6);
    let sums: (f64, f64) = (0..64 * 32).fold((0.0, 0.0), |(a, b), i| {
        let d = direction(((i % 64) as f64 + 0.5) / 64.0, ((i / 64) as f64 + 0.5) / 32.0);
        let p = f64::from(picture.pdf(d));
        (a + p * sine(d), b + p)
    });
    let wrong = chi_squared(&picture, |d| f64::from(picture.pdf(d)) / sine(d) * sums.0 / sums.1);
    assert!(wrong > 10.0, "{wrong}");
}

#[test]
fn points_stay_in_their_pixel_and_fill_it() {
    // All the light is in one pixel.
    let numbers = numbers(16, |column, row| if (column, row) == (5, 2) { [1.0; 3] } else { [0.0; 3] });
    let picture = Panorama::new(&numbers).expect("a picture");
    let solid = TAU / 16.0 * ((PI / 4.0).cos() - (PI * 3.0 / 8.0).cos());
    let mut sum = Vec3::ZERO;
    for i in 0..10_000 {
        let u = Vec2::new((i % 100) as f32 + 0.5, (i / 100) as f32 + 0.5) / 100.0;
        let (d, light, pdf) = picture.sample(u);
        assert_eq!(light, Vec3::ONE, "{u}");
        assert!((f64::from(pdf) * solid - 1.0).abs() < 1e-6);
        sum += d;
    }
    // Uniform in height: the mean cosine of the polar angle is that of the edges.
    let mean = f64::from(sum.y) / 1e4;
    assert!((mean - 0.5 * ((PI / 4.0).cos() + (PI * 3.0 / 8.0).cos())).abs() < 1e-4, "{mean}");
    for u in [Vec2::ZERO, Vec2::ONE, Vec2::new(0.0, 1.0), Vec2::splat(f32::NAN), Vec2::new(-3.0, 7.0)] {
        let (d, _, pdf) = picture.sample(u);
        assert!(d.is_finite() || u.is_nan(), "{u}: {d}");
        assert!(pdf.is_finite(), "{u}: {pdf}");
    }
}

#[test]
fn a_dark_picture_is_sampled_uniformly() {
    for dark in [0.0, 1e-38] {
        let numbers = numbers(32, |_, _| [dark; 3]);
        assert!(numbers.iter().all(|n| n.is_finite()));
        let picture = Panorama::new(&numbers).expect("a picture");
        assert!(chi_squared(&picture, |_| 0.25 / PI) < 2.0);
        let (_, light, pdf) = picture.sample(Vec2::new(0.3, 0.8));
        assert!(light.max_element() <= dark && (f64::from(pdf) * 4.0 * PI - 1.0).abs() < 1e-6);
    }
}

#[test]
fn numbers_from_elsewhere_are_no_picture() {
    let good = numbers(8, pattern);
    assert!(Panorama::new(&good).is_some());
    assert_eq!(good.len(), 3 + 5 + 4 * 9 + 3 * 32);
    for end in 0..good.len() {
        assert!(Panorama::new(&good[..end]).is_none(), "{end}");
    }
    for (at, wrong) in [(0, f32::NAN), (0, 1e30), (0, 0.0), (1, -1.0), (1, f32::INFINITY)] {
        let mut numbers = good.clone();
        numbers[at] = wrong;
        assert!(Panorama::new(&numbers).is_none(), "{at} {wrong}");
    }
}

#[test]
fn both_formats_keep_their_pixels() {
    let expected = numbers(32, pattern);
    let plain = || LayerAttributes::named("main");
    let read = |bytes: &[u8]| (FORMAT.read)(bytes).map_err(|problem| problem.message);
    assert_eq!(read(&hdr(32, pattern)).as_ref(), Ok(&expected));
    // Too narrow for run-length encoding.
    assert_eq!(read(&hdr(4, pattern)), Ok(numbers(4, pattern)));
    for encoding in [
        Encoding::UNCOMPRESSED,
        Encoding::FAST_LOSSLESS,
        Encoding::SMALL_LOSSLESS,
        Encoding::SMALL_FAST_LOSSLESS,
    ] {
        assert_eq!(read(&exr([32, 16], encoding, plain(), pattern)).as_ref(), Ok(&expected), "{encoding:?}");
    }
    // The values of this file, 8, 8, 8, were multiplied by 0.5 × 4 and by 1, 2, 4.
    let file = [
        b"#?RGBE\nEXPOSURE=0.5\nEXPOSURE= 4\nCOLORCORR=1 2 4\n\n-Y 1 +X 2\n".as_slice(),
        &[128, 128, 128, 132, 128, 128, 128, 132],
    ]
    .concat();
    let picture = read(&file).expect("legal");
    assert_eq!(picture[picture.len() - 3..], [4.0, 2.0, 1.0]);
    // The primaries that Radiance has by default are nearly those of Rec. 709.
    for primaries in
        ["0.640 0.330 0.290 0.600 0.150 0.060 0.333 0.333", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"]
    {
        let head = format!("#?RADIANCE\nPRIMARIES= {primaries}\n\n-Y 1 +X 2\n");
        let file = [head.as_bytes(), &[128; 8]].concat();
        assert!(read(&file).is_ok(), "{primaries}");
    }
    // OpenEXR states how much light 1 is.
    let own = LayerAttributes { white_luminance: Some(100.0), ..plain() };
    let picture = read(&exr([2, 1], Encoding::FAST_LOSSLESS, own, |_, _| [1.0, 0.5, 2.0])).expect("legal");
    assert_eq!(picture[picture.len() - 3..], [100.0, 50.0, 200.0]);
}

#[test]
fn a_smaller_picture_has_the_light_of_the_larger_one() {
    // More light near the pole, where the solid angles of rows differ most.
    let steep = |row: usize| [1.0, 2.0, if row < 4 { 1000.0 * (4 - row) as f32 } else { 1.0 }];
    let numbers = numbers(4096, |_, row| steep(row));
    let picture = Panorama::new(&numbers).expect("a picture");
    let rows = picture.rows as f64;
    let sum = |j: usize| {
        let solid = TAU * ((PI * j as f64 / rows).cos() - (PI * (j + 1) as f64 / rows).cos());
        picture.radiance(direction(0.3, (j as f64 + 0.5) / rows)).as_dvec3() * solid
    };
    let found = (0..picture.rows).map(sum).sum::<glam::DVec3>();
    assert_eq!(picture.columns, MAX_COLUMNS);
    let exact: glam::DVec3 = (0..2048)
        .map(|j| {
            let solid = TAU * ((PI * j as f64 / 2048.0).cos() - (PI * (j + 1) as f64 / 2048.0).cos());
            Vec3::from_array(steep(j)).as_dvec3() * solid
        })
        .sum();
    assert!((found / exact - 1.0).abs().max_element() < 1e-6, "{found} {exact}");
    // By hand: the four rows at the pole have solid angles in the ratio 1 : 3 : 5 : 7. The wrong twin, each
    // row counted once, gives 2500.
    let top = picture.radiance(Vec3::Y).z;
    assert!((top - (4000.0 + 3.0 * 3000.0 + 5.0 * 2000.0 + 7.0 * 1000.0) / 16.0).abs() < 0.1, "{top}");
    // Widths that are not multiples.
    let wide = self::numbers(1502, |column, _| [if column == 740 { 1502.0 } else { 0.0 }, 1.0, 1.0]);
    let picture = Panorama::new(&wide).expect("a picture");
    let row: Vec<_> = picture.pixels[..3 * MAX_COLUMNS].chunks(3).collect();
    let red: f32 = row.iter().map(|pixel| pixel[0]).sum();
    assert!((red - MAX_COLUMNS as f32).abs() < 1e-2, "{red}");
    assert!(row.iter().all(|pixel| (pixel[1] - 1.0).abs() < 1e-6));
    assert_eq!(row.iter().filter(|pixel| pixel[0] > 0.0).count(), 2);
}

/// The shader's functions, run on the CPU: from a direction or point to four numbers.
fn wgsl(text: &str, function: &str, numbers: &[f32]) -> impl Fn(&[f32]) -> [f32; 4] {
    let mut sources = Sources::default();
    // The built-in text is found without a copy.
    if text != PANORAMA.text {
        sources.edit(PANORAMA.path, text);
    }
    let count = numbers.len();
    let mut composer = Composer::new(&sources);
    OPTICS.iter().for_each(|source| composer.source(source));
    let user = "#import \"../optics/panorama.wgsl\"
fn seen(d: vec3<f32>) -> vec4<f32> {
    return panorama_seen(0u, d);
}
fn sampled(u: vec2<f32>) -> vec4<f32> {
    return panorama_sample(0u, u);
}
";
    composer.source(&Source { path: "light/user.wgsl", text: user });
    composer.push(
        LIGHT_ALONE,
        &format!(
            "struct FileRow {{ numbers: array<f32, {count}> }}
@group(0) @binding(0) var<storage, read> {FILE_TABLE}: array<FileRow>;
fn illumination_number(i: u32) -> f32 {{
    return {FILE_TABLE}[0].numbers[i];
}}
"
        ),
    );
    assert!(composer.composed.problem.is_none() && composer.composed.depends_on(PANORAMA.path));
    let module = validate(&composer.composed).unwrap_or_else(|problem| panic!("{problem}"));
    let program = Program::with_table(&module, function, FILE_TABLE).expect("it runs");
    let row: Vec<_> = numbers.iter().map(|number| number.to_bits()).collect();
    move |arguments| {
        let arguments: Vec<_> = arguments.iter().map(|number| number.to_bits()).collect();
        let mut results = [0; 4];
        program.run_with(&row, &arguments, &mut results).expect("it ends");
        results.map(f32::from_bits)
    }
}

/// The fraction of directions and of points for which the shader differs.
fn differences(text: &str, numbers: &[f32]) -> [f64; 2] {
    let picture = Panorama::new(numbers).expect("a picture");
    let [seen, sampled] = ["seen", "sampled"].map(|function| wgsl(text, function, numbers));
    let mut seed = 9;
    let mut wrong = [0.0; 2];
    let near =
        |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 2e-6 * b.abs().max(1.0));
    let count = 4000;
    for _ in 0..count {
        let d = any_direction(&mut seed);
        if !near(seen(&d.to_array()), picture.radiance(d).extend(picture.pdf(d)).to_array()) {
            wrong[0] += 1.0;
        }
        let u = Vec2::new(random(&mut seed), random(&mut seed));
        let (d, _, pdf) = picture.sample(u);
        if !near(sampled(&u.to_array()), d.extend(pdf).to_array()) {
            wrong[1] += 1.0;
        }
    }
    wrong.map(|wrong| wrong / f64::from(count))
}

#[test]
fn the_shader_sees_and_samples_the_same() {
    let panorama = PANORAMA.text;
    // Larger ones are too large for the interpreter on the CPU.
    let contrasts = || numbers(40, |column, row| contrasts(column * 8 / 5, row * 8 / 5));
    for numbers in [contrasts(), numbers(32, pattern), numbers(16, |_, _| [0.0; 3])] {
        // At the edges of pixels, rounding decides.
        let wrong = differences(panorama, &numbers);
        assert!(wrong.iter().all(|wrong| *wrong < 1e-3), "{wrong:?}");
    }
    let numbers = contrasts();
    for (from, to, which) in [
        ("polar_angle(-d.z, d.x)", "polar_angle(-d.z, -d.x)", 0),
        ("total == 0.0", "total >= 0.0", 0),
        ("vec3(-around.y, ", "vec3(around.y, ", 1),
        ("up + row.y", "up + 0.9 * row.y", 1),
        ("0.5 * row.x", "0.49 * row.x", 1),
    ] {
        assert!(panorama.contains(from), "{from}");
        let wrong = differences(&panorama.replacen(from, to, 1), &numbers);
        assert!(wrong[which] > 0.05, "{to}: {wrong:?}");
    }
    // Also at the poles and at the seam.
    let seen = wgsl(panorama, "seen", &numbers);
    let picture = Panorama::new(&numbers).expect("a picture");
    let behind = Vec3::new(-0.0, 0.0, 1.0);
    for d in [Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::X, behind, Vec3::new(1e-30, 1.0, -1e-30)] {
        assert_eq!(seen(&d.to_array())[..3], picture.radiance(d).to_array(), "{d}");
    }
}

/// The error message for a file.
fn said(bytes: &[u8]) -> String {
    let start = Instant::now();
    let problem = (FORMAT.read)(bytes).expect_err("it is refused");
    assert!(problem.line.is_none() && start.elapsed() < Duration::from_secs(10), "{problem:?}");
    problem.message
}

#[test]
fn illegal_radiance_files_are_told_what_is_wrong() {
    let head = |text: &str| text.as_bytes().to_vec();
    let with = |size: &str| head(&format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n"));
    let no_magic = "it does not begin like a Radiance picture (#?RADIANCE) or an OpenEXR picture";
    let no_head = "the header of a Radiance picture must end with an empty line and a line such as “-Y 512 +X 1024” within 65536 bytes";
    let rule = "but an equirectangular picture is twice as wide as high, from 2 × 1 to 8192 × 4096 pixels";
    let no_size = |found: &str| {
        format!("the size of a Radiance picture must be given as “-Y height +X width”, not “{found}”")
    };
    for (bytes, expected) in [
        (vec![], "the file is empty".to_owned()),
        (head("#?RADI"), no_magic.to_owned()),
        (head("\u{89}PNG"), no_magic.to_owned()),
        (head("#?RADIANCE"), no_head.to_owned()),
        (head("#?RADIANCE\n\n-Y 1 +X 2"), no_head.to_owned()),
        (head(&format!("#?RADIANCE\n{}\n\n-Y 1 +X 2\n", "a".repeat(70_000))), no_head.to_owned()),
        (with("+X 2 -Y 1"), no_size("+X 2 -Y 1")),
        (with("-Y 1 +X -2"), no_size("-Y 1 +X -2")),
        (with("-Y 1 +X 99999999999999999999999"), no_size("-Y 1 +X 99999999999999999999999")),
        (with("-Y 0 +X 0"), format!("it has 0 × 0 pixels, {rule}")),
        (with("-Y 2 +X 2"), format!("it has 2 × 2 pixels, {rule}")),
        (with("-Y 4097 +X 8194"), format!("it has 8194 × 4097 pixels, {rule}")),
        (with("-Y 2147483648 +X 4294967296"), format!("it has 4294967296 × 2147483648 pixels, {rule}")),
        (with("-Y 4 +X 8"), "the file ends before its last pixel".to_owned()),
        (with("-Y 4096 +X 8192"), "the file ends before its last pixel".to_owned()),
        (
            head("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n\0\0\0\0\0\0\0\0"),
            "its FORMAT must be 32-bit_rle_rgbe".to_owned(),
        ),
        (
            head("#?RADIANCE\nEXPOSURE=-1\n\n-Y 1 +X 2\n\0\0\0\0\0\0\0\0"),
            "EXPOSURE and COLORCORR must be greater than 0".to_owned(),
        ),
        (
            [with("-Y 1 +X 2"), vec![1, 1, 1, 130, 200, 200, 200, 250]].concat(),
            "the Radiance picture is damaged: its compressed rows of pixels do not have the width that its header gives, 2; copy it again from its source".to_owned(),
        ),
        (
            head("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=bright\n\n-Y 1 +X 2\n\0\0\0\0\0\0\0\0"),
            "line 3 of its header is “EXPOSURE=bright”, but EXPOSURE must be a number".to_owned(),
        ),
        (
            head("#?RADIANCE\nCOLORCORR=1 2\n\n-Y 1 +X 2\n\0\0\0\0\0\0\0\0"),
            "line 2 of its header is “COLORCORR=1 2”, but COLORCORR must be three numbers".to_owned(),
        ),
        (
            head("#?RADIANCE\nPRIMARIES=0.64 0.33 0.3\n\n-Y 1 +X 2\n\0\0\0\0\0\0\0\0"),
            "line 2 of its header is “PRIMARIES=0.64 0.33 0.3”, but PRIMARIES must be eight numbers".to_owned(),
        ),
        (
            head("#?RADIANCE\nPRIMARIES= .64 .33 .21 .71 .15 .06 .3127 .329\n\n-Y 1 +X 2\n\0\0\0\0\0\0\0\0"),
            "its colours must be linear Rec. 709, but its PRIMARIES differ (green at 0.21, 0.71, not 0.3, 0.6)".to_owned(),
        ),
        (
            [with("-Y 1 +X 2"), vec![9, 9, 9, 130, 200, 200, 200, 250]].concat(),
            "the pixel in column 2, row 1 has red 4.1538375e36; values must be numbers from 0 to 1e12 cd/m²".to_owned(),
        ),
    ] {
        assert_eq!(said(&bytes), expected);
    }
}

#[test]
fn illegal_openexr_files_are_told_what_is_wrong() {
    let plain = || LayerAttributes::named("main");
    let fast = Encoding::FAST_LOSSLESS;
    let rule = "values must be numbers from 0 to 1e12 cd/m²";
    let marked =
        |value: f32| move |column, row| if (column, row) == (3, 1) { [1.0, value, 1.0] } else { [1.0; 3] };
    for (value, shown) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-0.5, "-0.5"), (1e20, "1e20")] {
        let bytes = exr([8, 4], fast, plain(), marked(value));
        assert_eq!(said(&bytes), format!("the pixel in column 4, row 2 has green {shown}; {rule}"));
    }
    // The first of several is reported, whatever the order in the file.
    let bytes =
        exr([64, 32], fast, plain(), |column, row| [if column + row > 70 { f32::NAN } else { 0.0 }; 3]);
    assert_eq!(said(&bytes), format!("the pixel in column 64, row 9 has red NaN; {rule}"));
    let shape = "but an equirectangular picture is twice as wide as high, from 2 × 1 to 8192 × 4096 pixels";
    assert_eq!(said(&exr([6, 4], fast, plain(), pattern)), format!("it has 6 × 4 pixels, {shape}"));
    assert_eq!(
        said(&exr([8194, 1], fast, plain(), |_, _| [1.0; 3])),
        "a layer has 8194 × 1 pixels; at most 8192 × 4096 are read"
    );
    let cube =
        LayerAttributes { environment_map: Some(exr::meta::attribute::EnvironmentMap::Cube), ..plain() };
    assert_eq!(
        said(&exr([4, 2], fast, cube, pattern)),
        "it is a cube map, but must be equirectangular (latitude and longitude)"
    );
    let white = LayerAttributes { white_luminance: Some(-1.0), ..plain() };
    assert_eq!(said(&exr([4, 2], fast, white, pattern)), "its whiteLuminance must be greater than 0, not -1");
    // Windows and chromaticities.
    let channels = || SpecificChannels::rgb(|_: At<usize>| (1.0_f32, 1.0_f32, 1.0_f32));
    let mut image = Image::from_layer(Layer::new((4, 2), plain(), fast, channels()));
    image.attributes.display_window.size = At(8, 4);
    assert_eq!(
        said(&written(&image)),
        "only 4 × 2 of 8 × 4 pixels are present (data window and display window); all must be"
    );
    let mut image = Image::from_layer(Layer::new((4, 2), plain(), fast, channels()));
    let aces = [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], [0.32168, 0.33767]].map(|[x, y]| At(x, y));
    let [red, green, blue, white] = aces;
    image.attributes.chromaticities = Some(exr::meta::attribute::Chromaticities { red, green, blue, white });
    assert_eq!(
        said(&written(&image)),
        "its colours must be linear Rec. 709, but its chromaticities differ (red at 0.7347, 0.2653, not 0.64, 0.33)"
    );
    // Other channels.
    let grey = SpecificChannels::build().with_channel("Y").with_pixel_fn(|_| (1.0_f32,));
    let image = Image::from_layer(Layer::new((4, 2), plain(), fast, grey));
    assert_eq!(said(&written(&image)), "no layer has the channels R, G and B; the channels are Y");
    // Tiles as large as the picture.
    let tiles = exr::image::Blocks::Tiles(At(4096, 2048));
    let encoding = Encoding { blocks: tiles, ..fast };
    assert_eq!(
        said(&exr([4, 2], encoding, plain(), pattern)),
        "its tiles have up to 4096 × 2048 pixels, and there are 1; at most 16777216 bytes per tile and 262144 tiles are read"
    );
    // An absurd window, before anything is allocated: the number after the window's first corner.
    let whole = exr([4, 2], fast, plain(), pattern);
    let at = whole.windows(10).position(|name| name == b"dataWindow").expect("it has one") + 10 + 1 + 6 + 4;
    assert_eq!(whole[at + 8..at + 16], [3, 0, 0, 0, 1, 0, 0, 0]);
    let mut absurd = whole.clone();
    absurd[at + 8..at + 16].copy_from_slice(&[0xff, 0xff, 0xff, 0x3f, 0xff, 0xff, 0xff, 0x1f]);
    let told = said(&absurd);
    assert!(
        told.starts_with("the OpenEXR picture is damaged: its header gives it no pixels, or too many;")
            || told.starts_with("a layer has "),
        "{told}"
    );
    for end in [4, 8, 20, whole.len() / 2, whole.len() - 1] {
        let told = said(&whole[..end]);
        assert!(told.starts_with("the OpenEXR picture is damaged: it ends too early;"), "{end}: {told}");
    }
    // Deep pixels: bit 11 of the version.
    let mut deep = whole;
    deep[5] |= 8;
    let told = said(&deep);
    assert!(told.contains("OpenEXR picture"), "{told}");
}

#[test]
fn the_layer_with_colours_is_read_wherever_it_is() {
    let fast = Encoding::FAST_LOSSLESS;
    let depth = SpecificChannels::build().with_channel("Z.\u{e9}").with_pixel_fn(|_| (f32::NAN,));
    let colours = SpecificChannels::build()
        .with_channel("B")
        .with_channel("G")
        .with_channel("R")
        .with_channel("strange name")
        .with_pixel_fn(|at: At<usize>| {
            let [r, g, b] = pattern(at.x(), at.y());
            (b, g, r, f32::NAN)
        });
    let size = At(32, 16);
    let image = Image::empty(exr::prelude::ImageAttributes::with_size(size))
        .with_layer(Layer::new(size, LayerAttributes::named("depth"), fast, depth))
        .with_layer(Layer::new(size, LayerAttributes::named("colours"), fast, colours));
    let mut bytes = Vec::new();
    image.write().non_parallel().to_buffered(Cursor::new(&mut bytes)).expect("written");
    assert_eq!((FORMAT.read)(&bytes), Ok(numbers(32, pattern)));
}

#[test]
fn broken_files_are_answered_quickly_and_without_a_panic() {
    let plain = || LayerAttributes::named("main");
    let mut files = vec![hdr(32, pattern), hdr(4, pattern)];
    for encoding in [
        Encoding::UNCOMPRESSED,
        Encoding::FAST_LOSSLESS,
        Encoding::SMALL_LOSSLESS,
        Encoding::SMALL_FAST_LOSSLESS,
    ] {
        files.push(exr([32, 16], encoding, plain(), pattern));
    }
    let mut seed = 77;
    let mut refused = 0;
    for i in 0..2000 {
        let mut bytes = files[i % files.len()].clone();
        let mut pick = |below: usize| (random(&mut seed) * below as f32) as usize;
        if i % 3 == 0 {
            bytes.truncate(pick(bytes.len()));
        } else {
            // Half of them in the head.
            for _ in 0..1 + pick(4) {
                let end = if i % 2 == 0 { bytes.len().min(400) } else { bytes.len() };
                let at = pick(end);
                bytes[at] = pick(256) as u8;
            }
        }
        let start = Instant::now();
        match (FORMAT.read)(&bytes) {
            Ok(numbers) => {
                assert!(Panorama::new(&numbers).is_some() && numbers.iter().all(|n| n.is_finite()))
            }
            Err(problem) => {
                assert!(problem.message.chars().count() < 300, "{problem:?}");
                refused += 1;
            }
        }
        assert!(start.elapsed() < Duration::from_secs(5), "{i}: {:?}", start.elapsed());
    }
    assert!(refused > 500, "{refused}");
}

/// A run-length block that would decompress to much more than the picture contains.
#[test]
fn what_unfolds_to_too_much_is_refused() {
    let whole = exr([32, 16], Encoding::FAST_LOSSLESS, LayerAttributes::named("main"), |_, _| [1.0; 3]);
    let runs = [127, 0].repeat(whole.len());
    let at = whole.len() / 2;
    let bomb = [&whole[..at], &runs, &whole[at..]].concat();
    assert!(said(&bomb).starts_with("the OpenEXR picture is damaged: its "));
    let head = b"#?RADIANCE\n\n-Y 16 +X 32\n".as_slice();
    let bomb = [head, &[2, 2, 0, 32], &[255, 1].repeat(1000)].concat();
    assert!(said(&bomb).contains("do not have the width that its header gives, 32;"), "{}", said(&bomb));
}

#[cfg(target_os = "linux")]
#[test]
fn only_files_within_the_folder_are_read() {
    use std::{fs, os::unix::fs::symlink, process::Command};
    let [inside, outside] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let problem = |name: &str| NamedFile::named(name, inside.path(), &FORMAT).problem();
    fs::write(inside.path().join("good.hdr"), hdr(8, pattern)).expect("written");
    fs::write(outside.path().join("good.exr"), hdr(8, pattern)).expect("written");
    assert_eq!(problem("good.hdr"), None);
    symlink(outside.path().join("good.exr"), inside.path().join("link.exr")).expect("linked");
    symlink("/dev/zero", inside.path().join("zero.hdr")).expect("linked");
    assert!(Command::new("mkfifo").arg(inside.path().join("pipe.hdr")).status().expect("mkfifo").success());
    let hole = fs::File::create(inside.path().join("large.hdr")).expect("created");
    hole.set_len(FORMAT.max_bytes + 1).expect("a hole takes no space");
    for (name, expected) in [
        ("link.exr", "--allow-outside"),
        ("zero.hdr", "--allow-outside"),
        ("pipe.hdr", "it is a named pipe, but it must be a file"),
        ("large.hdr", "256 MiB"),
        ("none.hdr", "none.hdr: "),
    ] {
        let said = problem(name).expect(name);
        assert!(said.contains(expected) && said.contains(name), "{said}");
    }
    // Somebody chose it, and its name does not indicate the format.
    let chosen = NamedFile::chosen("good.exr", outside.path(), &FORMAT);
    assert_eq!((chosen.problem(), chosen.numbers().as_deref()), (None, Some(&*numbers(8, pattern))));
    let device = NamedFile::chosen("/dev/zero", Path::new("/"), &FORMAT).problem().expect("no file");
    assert!(device.contains("a device"), "{device}");
}

/// The room of the shipped picture: 6 m wide, 8 m long and 3 m high, seen from its centre. A window is on the
/// left, a lamp on the ceiling behind.
fn room(d: glam::DVec3) -> glam::DVec3 {
    use glam::DVec3;
    let half = DVec3::new(3.0, 1.5, 4.0);
    let at = d * (half / d.abs().max(DVec3::splat(1e-9))).min_element();
    let [x, y, z] = at.to_array();
    if y > 1.5 - 1e-9 {
        let lamp = (x * x + (z - 2.0) * (z - 2.0)).sqrt() < 0.4;
        return if lamp { DVec3::new(50.0, 40.0, 25.0) } else { DVec3::new(0.6, 0.6, 0.58) };
    }
    if y < -1.5 + 1e-9 {
        // Lighter towards the window.
        return DVec3::new(0.3, 0.22, 0.15) * (1.0 - 0.2 * x);
    }
    if x < -3.0 + 1e-9 && y.abs() < 0.8 && z.abs() < 1.2 {
        // Sky above the roofs on the other side of the street.
        return if y > -0.2 { DVec3::new(8.0, 10.0, 13.0) } else { DVec3::new(2.0, 1.9, 1.8) };
    }
    DVec3::new(0.5, 0.48, 0.44) * (0.8 + 0.2 * y)
}

/// The shipped picture equals the one calculated here.
#[test]
fn the_shipped_picture_is_the_calculated_room() {
    // The CPU interprets at most 4096 numbers of a default.
    const WIDTH: usize = 40;
    let calculated = hdr(WIDTH, |column, row| {
        let sum: glam::DVec3 = (0..64)
            .map(|i| {
                let at =
                    |pixel: usize, part: usize| (pixel as f64 + (part as f64 + 0.5) / 8.0) / WIDTH as f64;
                let (phi, theta) = (TAU * (at(column, i % 8) - 0.5), TAU * at(row, i / 8));
                room(glam::DVec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos()))
            })
            .sum();
        (sum / 64.0).as_vec3().to_array()
    });
    let [(name, Shipped::Bytes(shipped))] = FORMAT.shipped else { panic!("one") };
    if calculated != *shipped {
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, &calculated).expect("written");
        panic!("{name} is not what is calculated; that is in {}", path.display());
    }
    assert!(shipped.len() < 16 << 10, "{}", shipped.len());
    let numbers = (FORMAT.read)(shipped).expect("legal");
    assert!(numbers.len() <= 4096, "{}", numbers.len());
    let picture = Panorama::new(&numbers).expect("a picture");
    let brightness = |x: f32, y: f32, z: f32| luminance(picture.radiance(Vec3::new(x, y, z).normalize()));
    // The window is on the left, the lamp above and behind, the floor darker than the ceiling.
    assert!(brightness(-3.0, 0.3, 0.0) > 9.0 && brightness(3.0, 0.3, 0.0) < 1.0);
    assert!(brightness(0.0, 1.5, 2.0) > 10.0 && brightness(0.0, 1.5, -2.0) < 1.0);
    assert!(brightness(1.0, -1.5, 0.0) < brightness(1.0, 1.5, 0.0));
}
