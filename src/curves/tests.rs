use std::f64::consts::TAU;

use super::*;
use crate::{
    optics::{Frame, colour::Encoding},
    parameter::{Value, Values},
    progress::Progress,
    reflection::{Factor, brdf},
    registry::Registry,
};

fn subject(id: &str, set: &[(&'static str, Value)]) -> Subject {
    let mut values = Values::default();
    set.iter().for_each(|(name, value)| values.set(*name, value.clone()));
    let registry = Registry::builtin();
    Subject::model(registry.model(id).expect("built in"), &values, Encoding::Srgb)
}

fn fine(subject: &Subject, kind: Kind, theta_i: f64) -> Curve {
    let setup = Setup::new(kind, theta_i, 0.0).expect("legal");
    curve(subject, &setup, Detail::Fine, &Progress::NONE).expect("exists")
}

fn number(v: f32) -> Value {
    Value::Number(v)
}

#[test]
fn names_say_what_differs() {
    assert_eq!(subject("phong", &[]).name, "Phong");
    let set =
        [("alpha", Value::Integer(20)), ("k_s", number(0.3)), ("base_colour", Value::Colour([255, 128, 0]))];
    assert_eq!(
        subject("phong", &set).name,
        "Phong, base colour = (255, 128, 0), specular coefficient = 0.3, α = 20"
    );
    // Settings without effect are not mentioned.
    let set = [("fresnel", Value::Choice("none".into())), ("ior", Value::Triple([2.0; 3]))];
    assert_eq!(subject("microfacet", &set).name, "Microfacet, no Fresnel term");
}

#[test]
fn fresnel_has_the_known_values() {
    let glass = fine(&subject("microfacet", &[]), Kind::Fresnel, 45.0);
    let at = |curve: &Curve, angle: f64| {
        curve.points.iter().find(|p| (p.angle - angle).abs() < 1e-9).map_or(f32::NAN, |p| p.rgb.x)
    };
    assert!((at(&glass, 0.0) - 0.04).abs() < 1e-6 && at(&glass, 90.0) == 1.0);
    assert!((at(&glass, 60.0) - 0.089_186_71).abs() < 1e-6);
    // A wrong twin: Schlick's approximation.
    let schlick =
        fine(&subject("microfacet", &[("fresnel", Value::Choice("schlick".into()))]), Kind::Fresnel, 45.0);
    assert!((at(&schlick, 60.0) - 0.089_186_71).abs() > 1e-3 && (at(&schlick, 0.0) - 0.04).abs() < 1e-6);
}

/// `∫ D cos θ dω` by the trapezoidal rule over the points of a curve.
fn norm(curve: &Curve, power: i32) -> f64 {
    let weighted = |p: &Point| {
        let (sin, cos) = p.angle.to_radians().sin_cos();
        TAU * f64::from(p.rgb.x) * cos.powi(power) * sin
    };
    let step =
        |pair: &[Point]| 0.5 * (weighted(&pair[0]) + weighted(&pair[1])) * (pair[1].angle - pair[0].angle);
    curve.points.windows(2).map(step).sum::<f64>().to_radians()
}

#[test]
fn distributions_are_normalised() {
    for (id, set) in [
        ("microfacet", vec![]),
        ("microfacet", vec![("distribution", Value::Choice("beckmann".into()))]),
        ("microfacet", vec![("alpha_x", number(0.02)), ("alpha_y", number(0.02))]),
        ("cook_torrance", vec![]),
        ("metallic_roughness", vec![("roughness", number(0.1))]),
        ("disney", vec![]),
    ] {
        let curve = fine(&subject(id, &set), Kind::Distribution, 0.0);
        assert!((norm(&curve, 1) - 1.0).abs() < 3e-3, "{id} {set:?}: {}", norm(&curve, 1));
    }
    let wide = fine(&subject("microfacet", &[]), Kind::Distribution, 0.0);
    assert!((norm(&wide, 0) - 1.0).abs() > 0.05, "the wrong twin passes");
}

#[test]
fn factors_are_those_of_the_response() {
    let registry = Registry::builtin();
    let all = |kind| subjects_with(kind, &registry);
    let microfacets = all(Kind::Distribution);
    assert_eq!(
        microfacets,
        [
            "microfacet",
            "torrance_sparrow",
            "cook_torrance",
            "metallic_roughness",
            "disney",
            "openpbr",
            "thin_glass",
            "rough_dielectric",
            "glass"
        ]
    );
    assert_eq!(all(Kind::Masking), microfacets);
    assert!(all(Kind::Fresnel).contains(&"ashikhmin_shirley") && !all(Kind::Fresnel).contains(&"phong"));
    assert_eq!(all(Kind::Brdf).len(), registry.models().len());
    for id in microfacets {
        // The share of the lobe in the model.
        let share = if ["torrance_sparrow", "cook_torrance"].contains(&id) { 0.5 } else { 1.0 };
        // Smooth glass has no lobe.
        let smooth = ["thin_glass", "glass"].contains(&id);
        let rough = [("roughness", Value::Number(0.5))];
        let set = if smooth { &rough[..] } else { &[] };
        let model = subject(id, set);
        let mut values = Values::default();
        set.iter().for_each(|(name, value)| values.set(*name, value.clone()));
        let surface = registry.model(id).expect("built in").instantiate(&values, Encoding::Srgb);
        // Thin glass adds light of several bounces between the facets.
        let more = if id == "thin_glass" { 0.5 } else { 2e-4 };
        let mut twin = 0.0f32;
        for (theta_i, theta_o, phi) in
            [(10.0, 30.0, 150.0), (60.0, 50.0, 180.0), (40.0, 5.0, 77.0), (85.0, 60.0, 180.0)]
        {
            let l = crate::optics::geometry::direction(theta_i, 0.0);
            let v = crate::optics::geometry::direction(theta_o, phi);
            let h = (l + v).normalize();
            let factor = |f| model.factor(f).expect("has all three").x;
            let [f, d, g] = [
                factor(Factor::Fresnel { cos_d: h.dot(l) }),
                factor(Factor::Distribution { h }),
                factor(Factor::Masking { l, v }),
            ];
            let found = std::f32::consts::PI * d * f * g / (4.0 * v.z) * share;
            let expected = surface.response(l, v, &Frame::LOCAL).specular.x;
            let bounds = expected * (1.0 - more) - 1e-9..=expected * (1.0 + 2e-4) + 1e-9;
            assert!(bounds.contains(&found), "{id}: {found} {expected}");
            twin = twin.max((found / g / expected - 1.0).abs());
            assert!((0.0..=1.0 + 1e-5).contains(&g) && (0.0..=1.0).contains(&f), "{id}: {g} {f}");
        }
        assert!(twin > 1e-3, "{id}: without G nothing changes");
    }
}

#[test]
fn curves_are_the_brdf_and_fine_ones_follow_the_highlight() {
    let phong = subject("phong", &[("alpha", Value::Integer(2000))]);
    let registry = Registry::builtin();
    let mut values = Values::default();
    values.set("alpha", Value::Integer(2000));
    let surface = registry.model("phong").expect("built in").instantiate(&values, Encoding::Srgb);
    for (kind, factor) in
        [(Kind::Brdf, 1.0), (Kind::BrdfCos, 0.5f32), (Kind::Response, 0.5 * std::f32::consts::PI)]
    {
        let lobe = fine(&phong, kind, 60.0);
        assert!(lobe.points.windows(2).all(|pair| pair[0].angle < pair[1].angle));
        assert!(lobe.points.len() > 100 && lobe.points.len() < 2000, "{}", lobe.points.len());
        for p in &lobe.points {
            // Positive angles are on the side of the mirror direction.
            let l = crate::optics::geometry::direction(60.0, 0.0);
            let v = crate::optics::geometry::direction(p.angle, 180.0);
            let expected = factor * brdf(surface.as_ref(), l, v, &crate::optics::Frame::LOCAL);
            assert!((p.rgb - expected).abs().max_element() < 1e-4 * expected.max_element(), "{}", p.angle);
        }
        let peak = lobe.points.iter().max_by(|a, b| a.rgb.x.total_cmp(&b.rgb.x)).expect("points");
        assert!((peak.angle - 60.0).abs() < 0.5, "{}", peak.angle);
    }
    let setup = Setup::new(Kind::Brdf, 60.0, 0.0).expect("legal");
    let coarse = curve(&phong, &setup, Detail::Coarse, &Progress::NONE).expect("exists");
    assert!(coarse.points.len() < 120);
    let stop = Progress { tell: &|_, _| (), cancelled: &|| true };
    assert_eq!(
        curve(&phong, &setup, Detail::Coarse, &stop).map(|c| c.points.len()),
        Err(CurveError::Cancelled(crate::progress::Cancelled))
    );
    let setup = Setup { kind: Kind::Slice, ..setup };
    assert!(slice(&phong, &setup, Detail::Coarse, &stop).is_err());
}

#[test]
fn slices_are_the_brdf_at_their_angles() {
    let registry = Registry::builtin();
    for id in ["disney", "ward", "lambert"] {
        let model = subject(id, &[]);
        let surface = registry.model(id).expect("built in").instantiate(&Values::default(), Encoding::Srgb);
        let setup = Setup::new(Kind::Slice, 0.0, 0.0).expect("legal");
        let slice = slice(&model, &setup, Detail::Coarse, &Progress::NONE).expect("exists");
        assert_eq!(slice.values.len(), (slice.side * slice.side) as usize);
        let (mut worst, mut twin) = (0.0f32, 0.0f32);
        for (i, f) in slice.values.iter().enumerate() {
            let (theta_h, theta_d) = slice.angles(i);
            let (l, v) = super::slice::directions(theta_h, theta_d, 0.0);
            // The angles of Rusinkiewicz, from the directions.
            let h = (l + v).as_dvec3().normalize();
            assert!((h.z.acos().to_degrees() - theta_h).abs() < 0.02, "{theta_h}");
            assert!((h.dot(l.as_dvec3()).min(1.0).acos().to_degrees() - theta_d).abs() < 0.02, "{theta_d}");
            // φ_d = 90°: light and viewer lie across the plane of normal and half vector.
            assert!((l - v).z.abs() < 1e-6 && h.y.abs() < 1e-6);
            let expected = brdf(surface.as_ref(), l, v, &crate::optics::Frame::LOCAL);
            worst = worst.max((*f - expected).abs().max_element());
            let (l, v) = super::slice::directions(theta_d, theta_h, 0.0);
            twin = twin
                .max((*f - brdf(surface.as_ref(), l, v, &crate::optics::Frame::LOCAL)).abs().max_element());
        }
        assert_eq!(worst, 0.0, "{id}");
        assert!(twin > 1e-3 || id == "lambert", "{id}: the axes are exchanged");
        // The first row is grazing, the first column has the highlight.
        assert!(slice.angles(0).1 > 85.0 && slice.angles(0).0 < 5.0);
    }
}

#[test]
fn values_that_are_no_numbers_are_said_and_shown() {
    let points = (0..10u8).map(|i| Point {
        angle: f64::from(i) - 5.0,
        rgb: Vec3::splat(if (2..4).contains(&i) {
            f32::NAN
        } else if i == 7 {
            f32::INFINITY
        } else {
            1.0
        }),
    });
    let curve = Curve {
        name: "broken".to_owned(),
        points: points.collect(),
        sigma: Vec::new(),
        measured: false,
        sharp: false,
        reflected: false,
    };
    let missing = curve.missing().expect("there are some");
    assert_eq!(missing.to_string(), "values are not finite numbers from −3° to −2° and at 2°");
    let none = Curve { points: vec![Point { angle: 1.0, rgb: Vec3::NAN }], ..curve.clone() };
    assert_eq!(none.missing().map(|m| m.to_string()).as_deref(), Some("no value is a finite number"));
    let whole = Curve { points: vec![Point { angle: 1.0, rgb: Vec3::ONE }], ..curve.clone() };
    assert_eq!(whole.missing(), None);
    for kind in [Kind::Brdf, Kind::Polar] {
        let setup = Setup::new(kind, 30.0, 0.0).expect("legal");
        for log in [false, true] {
            let with = |curve: &Curve| Sheet { curves: vec![curve.clone()], log, ..Sheet::new(setup) };
            let note =
                "broken: values are not finite numbers from −3° to −2° and at 2°, where the curve has a gap.";
            assert_eq!(with(&curve).notes(), [note]);
            // In several lines, perhaps.
            assert!(with(&curve).figure().svg().contains("broken: values are not"));
            assert!(!with(&whole).figure().svg().contains("finite"));
            let csv = with(&curve).csv();
            assert!(csv.contains(",NaN,NaN,NaN,NaN\n") && csv.contains(",inf,inf,inf,inf\n"), "{csv}");
        }
    }
    let broken =
        Slice { name: "x".to_owned(), side: 2, values: vec![Vec3::NAN, Vec3::ONE, Vec3::ONE, Vec3::ZERO] };
    assert_eq!(broken.rgb8(None, false)[..3], [255, 0, 255], "nothing else is magenta");
    assert_eq!(broken.rgb8(None, false)[3..6], [255; 3]);
    let setup = Setup::new(Kind::Slice, 0.0, 0.0).expect("legal");
    let sheet = Sheet { slices: vec![broken], ..Sheet::new(setup) };
    assert!(sheet.notes()[0].contains("1 of 4 values are not finite numbers"), "{:?}", sheet.notes());
}

#[test]
fn every_curve_has_a_colour_and_a_dash() {
    let setup = Setup::new(Kind::Brdf, 30.0, 0.0).expect("legal");
    let one = |i: usize| Curve {
        name: format!("curve {i}"),
        points: vec![Point { angle: 0.0, rgb: Vec3::ONE }, Point { angle: 9.0, rgb: Vec3::ONE }],
        sigma: Vec::new(),
        measured: false,
        sharp: false,
        reflected: false,
    };
    let sheet = Sheet { curves: (0..8).map(one).collect(), ..Sheet::new(setup) };
    let draw::Figure::Plot(plot) = sheet.figure() else { panic!("a plot") };
    for (i, a) in plot.series.iter().enumerate() {
        for b in &plot.series[i + 1..] {
            assert!(a.line != b.line, "{} and {} have one dash", a.name, b.name);
        }
        assert!(a.points.iter().all(|p| p.1 == 1.0));
    }
    // Names with commas stay one cell.
    let mut sheet = sheet;
    sheet.curves[0].name = "a, \"b\"".to_owned();
    assert!(sheet.csv().contains("\n\"a, \"\"b\"\"\",0,30,0,0,180,1,1,1,1\n"), "{}", sheet.csv());
}

#[test]
fn measured_data_is_what_was_measured() {
    let krylon = Subject::measured("krylon_blue").expect("measured");
    let points = fine(&krylon, Kind::Brdf, 60.0);
    assert!(points.measured && points.points.len() == 16);
    assert!(points.points.windows(2).all(|pair| pair[0].angle <= pair[1].angle));
    let cos = fine(&krylon, Kind::BrdfCos, 60.0);
    assert!((cos.points[3].rgb / points.points[3].rgb - 0.5).abs().max_element() < 1e-5);
    let at = |kind, theta_i| {
        let setup = Setup::new(kind, theta_i, 0.0).expect("legal");
        curve(&krylon, &setup, Detail::Fine, &Progress::NONE).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert_eq!(
        at(Kind::Brdf, 45.0),
        "Krylon blue was measured with the light at 10°, 20°, 30°, 40°, 50°, 60°, 70° and 80°, not at 45°"
    );
    assert!(at(Kind::Albedo, 45.0).contains("only at single directions, so it has no directional albedo E"));
    assert!(at(Kind::Fresnel, 45.0).contains("has no Fresnel factor F"));
    let gold = Subject::measured("gold-metallic-paint").expect("fitted");
    assert_eq!(gold.name, "gold metallic paint (fit to MERL)");
    assert!(fine(&gold, Kind::Brdf, 45.0).points.len() > 100);
    let albedo = fine(&Subject::measured("white-paint").expect("fitted"), Kind::Albedo, 0.0);
    assert!(albedo.points[0].rgb.x > 0.3 && albedo.points[0].rgb.x < 1.1, "{:?}", albedo.points[0]);
    for (wrong, said) in [("krylon_blu", "did you mean \"krylon_blue\"?"), ("x", "one of 100 materials")] {
        let rule = Subject::measured(wrong).err().unwrap_or_default();
        assert!(rule.contains(said), "{rule}");
    }
}

#[test]
fn light_from_below_is_refused() {
    for (theta, phi, said) in [
        (90.0, 0.0, "is 90°, but it must be at least 0° and less than 90°"),
        (-1.0, 0.0, "is -1°, but"),
        (f64::NAN, 0.0, "is NaN°, but"),
        (1.0, 361.0, "the azimuth of the light is 361°, but it must be at least −360° and at most 360°"),
        (1.0, 1e300, "the azimuth of the light is 1000"),
        (1.0, f64::INFINITY, "the azimuth of the light is inf°"),
    ] {
        let error = Setup::new(Kind::Brdf, theta, phi).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn what_a_logarithmic_axis_cannot_show_is_said() {
    let setup = Setup::new(Kind::Brdf, 30.0, 0.0).expect("legal");
    let said = |values: [f32; 3], log: bool| {
        let point = |(i, v): (usize, f32)| Point { angle: i as f64, rgb: Vec3::splat(v) };
        let points = values.into_iter().enumerate().map(point).collect();
        let curves = vec![Curve {
            name: "x".to_owned(),
            points,
            sigma: Vec::new(),
            measured: false,
            sharp: false,
            reflected: false,
        }];
        let sheet = Sheet { curves, log, ..Sheet::new(setup) };
        assert!(!sheet.figure().svg().contains("NaN"));
        sheet.notes().join(" ")
    };
    assert_eq!(said([1.0, 0.0, 1.0], true), "", "a zero leaves at the foot of the plot");
    assert_eq!(said([1.0, -1.0, 1.0], true), "x: negative values have no place on a logarithmic axis.");
    assert_eq!(said([0.0; 3], true), "x: every value is 0, which has no place on a logarithmic axis.");
    assert_eq!(said([0.0, -1.0, 1.0], false), "");
}

#[test]
fn what_rises_beyond_the_plot_is_said() {
    let figure = |theta_i: f64| {
        let curves = ["ward", "lambert"].map(|id| fine(&subject(id, &[]), Kind::Brdf, theta_i)).to_vec();
        let setup = Setup::new(Kind::Brdf, theta_i, 0.0).expect("legal");
        let draw::Figure::Plot(plot) = (Sheet { curves, ..Sheet::new(setup) }).figure() else {
            panic!("a plot")
        };
        plot
    };
    let cut = figure(70.0);
    assert!(cut.y.to < 12.0 && cut.notes.len() == 1, "{:?} {:?}", cut.y, cut.notes);
    assert!(cut.notes[0].starts_with("Ward rises to ") && cut.notes[0].ends_with("beyond the plot."));
    // At grazing light the highlight itself is there.
    let whole = figure(80.0);
    assert!(whole.notes.is_empty() && whole.y.to > 20.0, "{:?} {:?}", whole.y, whole.notes);
}

/// The value of a curve near an angle.
fn near(curve: &Curve, angle: f64) -> f32 {
    let off = |p: &&Point| (p.angle - angle).abs();
    curve.points.iter().min_by(|a, b| off(a).total_cmp(&off(b))).map_or(f32::NAN, |p| p.rgb.x)
}

#[test]
fn curves_of_models_that_light_passes_through_go_all_around() {
    let angles = |curve: &Curve| (curve.points[0].angle, curve.points[curve.points.len() - 1].angle);
    for kind in [Kind::Brdf, Kind::BrdfCos, Kind::Response, Kind::Polar] {
        assert_eq!(
            angles(&fine(&subject("diffuse_transmission", &[]), kind, 30.0)),
            (-180.0, 180.0),
            "{kind:?}"
        );
        assert_eq!(angles(&fine(&subject("phong", &[]), kind, 30.0)), (-89.9, 89.9), "{kind:?}");
    }
    let set = [("base_colour", Value::Colour([188; 3])), ("transmittance_colour", Value::Colour([137; 3]))];
    let paper = fine(&subject("diffuse_transmission", &set), Kind::Brdf, 30.0);
    for (angle, albedo) in [(0.0, 0.5029), (60.0, 0.5029), (-120.0, 0.2502), (150.0, 0.2502), (180.0, 0.2502)]
    {
        let f = near(&paper, angle) * std::f32::consts::PI;
        assert!((f - albedo).abs() < 1e-3, "{angle}: {f}");
    }
    // Increasing, and none within the surface.
    let rough = fine(
        &subject("rough_dielectric", &[("alpha_x", number(0.1)), ("alpha_y", number(0.1))]),
        Kind::Brdf,
        50.0,
    );
    assert!(rough.points.windows(2).all(|pair| pair[0].angle < pair[1].angle));
    assert!(rough.points.iter().all(|p| p.rgb.is_finite() && (p.angle.abs() - 90.0).abs() > 0.09));
    // The peak behind is near Snell's angle, not straight on; with n = 1.5 of glass, 30.7°.
    let behind = rough.points.iter().filter(|p| p.angle > 90.0);
    let peak = behind.max_by(|a, b| a.rgb.x.total_cmp(&b.rgb.x)).expect("points").angle;
    assert!((180.0 - peak - 30.7).abs() < 1.0, "{peak}");
    // A pane bends nothing.
    let pane = fine(&subject("thin_glass", &[("roughness", number(0.3))]), Kind::Brdf, 50.0);
    let behind = pane.points.iter().filter(|p| p.angle > 90.0);
    let peak = behind.max_by(|a, b| a.rgb.x.total_cmp(&b.rgb.x)).expect("points").angle;
    assert!((peak - 130.0).abs() < 3.0, "{peak}");
}

#[test]
fn light_into_a_body_is_denser_by_the_square_of_its_index() {
    let (l, v) =
        (crate::optics::geometry::direction(40.0, 10.0), crate::optics::geometry::direction(155.0, 190.0));
    let rough = [("alpha_x", number(0.3)), ("alpha_y", number(0.3))];
    let boundary = subject("rough_dielectric", &rough);
    let there = boundary.brdf(l, v).x;
    let registry = Registry::builtin();
    let mut values = Values::default();
    rough.iter().for_each(|(name, value)| values.set(*name, value.clone()));
    let surface = registry.model("rough_dielectric").expect("built in").instantiate(&values, Encoding::Srgb);
    let back = brdf(&*surface, v, l, &crate::optics::Frame::LOCAL).x;
    assert!(there > 0.1 && (there / (2.25 * back) - 1.0).abs() < 1e-4, "{there} {back}");
    // The outer boundary of a rough solid is one of these.
    let solid = subject("glass", &[("roughness", number(0.3f32.sqrt()))]).brdf(l, v).x;
    assert!((solid / there - 1.0).abs() < 1e-4, "{solid} {there}");
    assert_eq!(subject("glass", &[]).brdf(l, v).x, 0.0, "a smooth one has no lobe");
    // OpenPBR's body has it in the share of its weight, coloured where it crosses the surface.
    let body = |weight: f32, roughness: f32| {
        let colour = ("transmission_colour", Value::Colour([255, 255, 0]));
        let set = [("transmission_weight", number(weight)), ("roughness", number(roughness)), colour];
        subject("openpbr", &set).brdf(l, v)
    };
    for weight in [1.0, 0.5] {
        let found = body(weight, 0.3f32.sqrt());
        assert!((found.x / (weight * there) - 1.0).abs() < 1e-3 && found.z == 0.0, "{found} {there}");
    }
    assert_eq!(body(1.0, 0.0).x, 0.0, "a smooth one has no lobe");
    assert_eq!(body(0.0, 0.3f32.sqrt()).x, 0.0, "an opaque one neither");
}

#[test]
fn figures_show_both_sides_only_where_a_curve_goes_there() {
    let sheet = |ids: &[&str], kind| {
        let setup = Setup::new(kind, 45.0, 0.0).expect("legal");
        let curves = ids.iter().map(|id| fine(&subject(id, &[]), kind, 45.0)).collect();
        Sheet { curves, ..Sheet::new(setup) }
    };
    let ends = |ids: &[&str]| match sheet(ids, Kind::Brdf).figure() {
        draw::Figure::Plot(plot) => (plot.x.from, plot.x.to),
        other => panic!("{other:?}"),
    };
    assert_eq!(ends(&["phong"]), (-90.0, 90.0));
    assert_eq!(ends(&["phong", "diffuse_transmission"]), (-180.0, 180.0));
    let around = |ids: &[&str]| match sheet(ids, Kind::Polar).figure() {
        draw::Figure::Polar(polar) => polar.around,
        other => panic!("{other:?}"),
    };
    assert!(!around(&["lambert"]) && around(&["lambert", "diffuse_transmission"]));
    let svg = sheet(&["diffuse_transmission"], Kind::Polar).figure().svg();
    assert!(svg.contains("150°") && svg.contains("180°"), "labels below the surface");
}

#[test]
fn a_smooth_surface_has_an_albedo_and_says_what_curves_leave_out() {
    let rough = [("roughness", number(0.4))];
    for id in ["glass", "thin_glass"] {
        let [smooth, spread] = [subject(id, &[]), subject(id, &rough)];
        let e = fine(&smooth, Kind::Albedo, 0.0);
        // Of the single boundary of a body F, of the two of a pane 2 F/(1 + F), all orders together.
        let expected = if id == "glass" { 0.04 } else { 0.08 / 1.04 };
        assert!((e.points[0].rgb.x - expected).abs() < 1e-4 && !e.sharp, "{id}: {:?}", e.points[0]);
        // It counts what is reflected, and says so.
        let setup = Setup::new(Kind::Albedo, 0.0, 0.0).expect("legal");
        let heading = |curves: Vec<Curve>| Sheet { curves, ..Sheet::new(setup) }.heading();
        assert_eq!(heading(vec![e]), "Directional albedo E, reflected light only", "{id}");
        let opaque = fine(&subject("phong", &[]), Kind::Albedo, 0.0);
        assert!(!heading(vec![opaque]).contains("reflected"));
        let note = |subject: &Subject| {
            let curve = fine(subject, Kind::Brdf, 45.0);
            let sheet = Sheet {
                curves: vec![curve],
                ..Sheet::new(Setup::new(Kind::Brdf, 45.0, 0.0).expect("legal"))
            };
            (sheet.notes().iter().any(|note| note.contains("in single directions")), sheet.heading())
        };
        assert!(note(&smooth).0, "{id}");
        let (said, heading) = note(&spread);
        assert!(!said && heading.starts_with("BSDF in the plane"), "{id}: {heading}");
    }
    let (said, heading) = (fine(&subject("phong", &[]), Kind::Brdf, 45.0).sharp, Kind::Brdf.name());
    assert!(!said && heading == "BRDF");
}

#[test]
fn the_uncertainty_of_a_measurement_is_drawn_as_bars_and_written() {
    let registry = Registry::builtin();
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, column: &str, sigma: &str| {
        let mut rows = format!("theta_i,phi_i,theta_o,phi_o,value{column}\n");
        for (theta_i, theta_o, phi) in
            (0..9).flat_map(|i| (0..9).flat_map(move |j| [0, 60, 120, 180].map(|phi| (10 * i, 10 * j, phi))))
        {
            rows += &format!("{theta_i},0,{theta_o},{phi},0.25{sigma}\n");
        }
        let place = folder.path().join(name);
        std::fs::write(&place, rows).expect("written");
        let mut scene: serde_json::Value =
            serde_json::from_str(include_str!("../../scenes/default.json")).expect("shipped");
        scene["objects"][0]["reflection_model"] = "measured_table".into();
        scene["objects"][0]["material"] = serde_json::json!({ "table_file": name });
        let file = folder.path().join("scene.json");
        std::fs::write(&file, scene.to_string()).expect("written");
        let loaded = crate::scene::load::file(&file, &registry, crate::scene::load::Defaults::Use);
        let material = loaded.expect("a scene").scene.objects[0].material.clone();
        Subject::model(registry.model("measured_table").expect("built in"), &material, Encoding::Srgb)
    };
    let (with, without) = (write("with.csv", ",sigma", ",0.05"), write("without.csv", "", ""));
    let drawn = |subject: &Subject, kind: Kind| {
        let setup = Setup::new(kind, 60.0, 0.0).expect("legal");
        let curve = curve(subject, &setup, Detail::Coarse, &Progress::NONE).expect("a curve");
        Sheet { curves: vec![curve], ..Sheet::new(setup) }
    };
    // f has the uncertainty of the file, f cos θ half of it at 60°, π f cos θ π halves; an albedo has none.
    for (kind, expected) in
        [(Kind::Brdf, 0.05), (Kind::BrdfCos, 0.025), (Kind::Response, 0.025 * std::f64::consts::PI)]
    {
        let sheet = drawn(&with, kind);
        let sigma = &sheet.curves[0].sigma;
        assert_eq!(sigma.len(), sheet.curves[0].points.len());
        assert!(sigma.iter().all(|s| (s / expected - 1.0).abs() < 1e-3), "{kind:?} {sigma:?}");
    }
    assert!(drawn(&with, Kind::Albedo).curves[0].sigma.is_empty());
    let (sheet, plain) = (drawn(&with, Kind::Brdf), drawn(&without, Kind::Brdf));
    assert!(plain.curves[0].sigma.is_empty(), "the wrong twin");
    assert!((sheet.curves[0].sigma_at(12.3).expect("known") - 0.05).abs() < 1e-4);
    let draw::Figure::Plot(plot) = sheet.figure() else { panic!("a plot") };
    for ((_, v), (low, high)) in plot.series[0].points.iter().zip(&plot.series[0].bars) {
        assert!((v - low - 0.05).abs() < 1e-3 && (high - v - 0.05).abs() < 1e-3);
    }
    let lines = |sheet: &Sheet| sheet.figure().svg().matches("stroke=\"#0072b2\"").count();
    assert!(lines(&sheet) > lines(&plain) + 30, "three lines a bar: {} {}", lines(&sheet), lines(&plain));
    assert!(lines(&drawn(&with, Kind::Polar)) > lines(&plain) + 30);
    assert!(sheet.notes().iter().any(|note| note.contains("bars are the standard uncertainty σ")));
    assert!(plain.notes().is_empty());
    let csv = sheet.csv();
    let mut rows = csv.lines();
    assert!(rows.next().is_some_and(|head| head.ends_with(",luminance,sigma")));
    assert!(rows.all(|row| row.rsplit(',').next().is_some_and(|s| s.starts_with("0.0"))), "{csv}");
    assert!(plain.csv().lines().next().is_some_and(|head| head.ends_with(",luminance")));
}
