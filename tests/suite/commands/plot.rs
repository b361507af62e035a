//! `lcm plot`: numbers equal to those of `lcm evaluate` and `lcm albedo`, files, messages.

use std::fs;

use lights_camera_models::{
    curves::{Kind, subjects_with},
    registry::Registry,
};

use crate::helpers::support::{Run, command_in, lcm, lcm_in, names, root};

/// The rows of a CSV file below its header, without the name of the curve, which must be the first word of
/// each.
fn rows(csv: &str, curve: &str, header: &str) -> Vec<Vec<String>> {
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(header));
    let of_curve = |line: &str| {
        let quoted =
            line.strip_prefix(&format!("\"{curve}\",")).or_else(|| line.strip_prefix(&format!("{curve},")));
        quoted.map(|rest| rest.split(',').map(str::to_owned).collect::<Vec<_>>())
    };
    lines.filter_map(of_curve).collect()
}

fn done(arguments: &[&str], input: &str) -> String {
    let run = lcm(arguments, input);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{arguments:?}");
    run.out
}

const LOBE: &str = "curve,angle,theta_i,phi_i,theta_o,phi_o";

#[test]
fn evaluate_answers_for_the_whole_sphere() {
    let asked = "theta_i,phi_i,theta_o,phi_o\n0,0,60,0\n180,0,60,0\n120,90,0,0\n60,0,180,0\n120,0,120,0\n180,0,180,0\n";
    let values = |arguments: &[&str]| {
        let out = done(&[&["evaluate"], arguments].concat(), asked);
        let last =
            |line: &str| line.rsplit(',').next().and_then(|v| v.parse::<f32>().ok()).expect("a number");
        out.lines().skip(1).map(last).collect::<Vec<_>>()
    };
    let half = 0.5 / std::f32::consts::PI;
    let paper = values(&["diffuse_transmission"]);
    for (found, right) in paper.iter().zip([half, half, half, half, 0.0, 0.0]) {
        assert!((found - right).abs() < 1e-6, "{paper:?}");
    }
    assert_eq!(values(&["lambert"])[1..], [0.0; 5]);
    let run = lcm(&["evaluate", "lambert"], "theta_i,phi_i,theta_o,phi_o\n181,0,0,0\n");
    assert!(run.status == Some(1) && run.err.contains("theta_i") && run.err.contains("180"), "{}", run.err);
}

#[test]
fn evaluate_says_which_rows_of_a_solid_body_it_leaves_out() {
    let asked = "theta_i,phi_i,theta_o,phi_o\n150,0,45,180\n45,0,151.9,180\n155,0,45,180\n";
    for (model, set) in [("glass", "roughness=0.4"), ("openpbr", "transmission_weight=1")] {
        let run = lcm(&["evaluate", model, "--set", set, "--set", "roughness=0.4"], asked);
        assert_eq!(run.status, Some(0), "{}", run.err);
        let first = |row: usize| {
            run.out.lines().nth(row).and_then(|line| line.split(',').nth(4)?.parse::<f32>().ok())
        };
        assert!(first(1) == Some(0.0) && first(2).is_some_and(|f| f > 10.0), "{model}:\n{}", run.out);
        let begins = format!("{model}: rows with light from inside the body (theta_i beyond 90°) are 0: ");
        assert!(run.err.starts_with(&begins) && run.err.lines().count() == 1, "{}", run.err);
    }
    let run = lcm(&["evaluate", "rough_dielectric"], asked);
    assert!(run.err.is_empty() && !run.out.contains("150,0,45,180,0,"), "{} {}", run.out, run.err);
}

#[test]
fn curves_are_what_evaluate_prints() {
    for (model, name, set) in [
        ("phong:alpha=20", "Phong, α = 20", "alpha=20"),
        ("disney:base_colour=200,80,40", "Disney, base colour = (200, 80, 40)", "base_colour=200,80,40"),
        ("ward:alpha_x=0.1", "Ward, roughness along the tangent = 0.1", "alpha_x=0.1"),
        (
            "rough_dielectric:alpha_x=0.2",
            "Rough dielectric, roughness along the tangent = 0.2",
            "alpha_x=0.2",
        ),
    ] {
        // Another model is next to it.
        let plot = [model, "lambert", "--theta-i", "60", "--phi-i", "30"];
        let csv = done(&[&["plot"][..], &plot].concat(), "");
        let rows = rows(&csv, name, &format!("{LOBE},f_r,f_g,f_b,luminance"));
        assert!(rows.len() > 80, "{}\n{}", rows.len(), &csv[..300]);
        let mut asked = String::from("theta_i,phi_i,theta_o,phi_o\n");
        let mut plotted = Vec::new();
        for row in &rows {
            asked += &format!("{}\n", row[1..5].join(","));
            plotted.push(row[1..8].join(","));
        }
        let id = model.split(':').next().expect("an id");
        let evaluated = done(&["evaluate", id, "--set", set], &asked);
        assert!(evaluated.lines().skip(1).eq(plotted.iter().map(String::as_str)), "{model}");
        // A wrong twin: another value.
        let wrong = done(&["evaluate", id], &asked);
        assert!(!wrong.lines().skip(1).eq(plotted.iter().map(String::as_str)), "{model}");
        // Negative angles are those of viewers on the side of the light.
        assert!(rows.iter().any(|row| row[0].starts_with('-') && row[4] == "30"));
        assert!(rows.iter().any(|row| !row[0].starts_with('-') && row[4] == "210"));
    }
}

#[test]
fn the_cosine_and_pi_are_factors() {
    let value = |kind: &str, column: &str| {
        let csv = done(&["plot", "phong", "--theta-i", "60", "--kind", kind], "");
        let rows = rows(&csv, "Phong", &format!("{LOBE},{column}_r,{column}_g,{column}_b,luminance"));
        let row = rows.iter().find(|row| row[0] == "60").expect("the mirror direction is among them");
        row[5].parse::<f64>().expect("a number")
    };
    let f = value("f", "f");
    assert!((value("f_cos", "f_cos") - 0.5 * f).abs() < 1e-6 * f);
    assert!((value("pi_f_cos", "pi_f_cos") - 0.5 * std::f64::consts::PI * f).abs() < 1e-6 * f);
    assert!((value("polar", "f") - f).abs() == 0.0);
}

#[test]
fn albedos_are_what_albedo_prints() {
    let csv = done(&["plot", "metallic_roughness:roughness=0.8", "--kind", "albedo"], "");
    let rows = rows(&csv, "Metallic–roughness, r = 0.8", "curve,angle,mu,e_r,e_g,e_b,luminance");
    assert!(rows.len() > 40);
    let column = |i: usize| rows.iter().map(|row| row[i].as_str()).collect::<Vec<_>>().join("\n");
    let plotted: Vec<_> = rows.iter().map(|row| row[1..5].join(",")).collect();
    let asked = format!("mu\n{}\n", column(1));
    let same = |set: &str| {
        let albedo = done(&["albedo", "metallic_roughness", "--set", set], &asked);
        albedo.lines().skip(1).eq(plotted.iter().map(String::as_str))
    };
    assert!(same("roughness=0.8") && !same("roughness=0.7"));
    assert!(rows[0][0] == "0" && rows[0][1] == "1");
}

#[test]
fn slices_are_what_evaluate_prints() {
    let csv = done(&["plot", "lambert", "--kind", "slice"], "");
    let rows = rows(&csv, "Lambert", "curve,theta_h,theta_d,f_r,f_g,f_b,luminance");
    assert_eq!(rows.len(), 256 * 256);
    assert!(
        rows.iter()
            .all(|row| row[2].parse::<f32>().is_ok_and(|f| (f - 1.0 / std::f32::consts::PI).abs() < 1e-6))
    );
}

#[test]
fn common_settings_hold_for_the_models_that_have_them() {
    let csv = done(&["plot", "phong,phong:k_s=0.1", "lambert", "--set", "k_s=0.9", "--theta-i", "30"], "");
    for name in ["Phong, specular coefficient = 0.9", "Phong, specular coefficient = 0.1", "Lambert"] {
        assert!(!rows(&csv, name, &format!("{LOBE},f_r,f_g,f_b,luminance")).is_empty(), "{name}");
    }
}

fn refused(arguments: &[&str], status: i32, expected: &str) {
    let run = lcm(&[&["plot"], arguments].concat(), "");
    assert_eq!((run.status, run.out.as_str()), (Some(status), ""), "{arguments:?}: {}", run.err);
    assert!(run.err.contains(expected), "{}\nnot: {expected}", run.err);
}

#[test]
fn mistakes_are_explained() {
    for (arguments, expected) in [
        (&["fong"][..], "MODEL is \"fong\", but the reflection model must be"),
        (&["phong,lambrt"], "did you mean \"lambert\"?"),
        (&["phong:alfa=3"], "phong:alfa=3: phong has no parameter alfa; did you mean alpha?"),
        (
            &["phong:k_d=0.2"],
            "phong:k_d=0.2: k_d is 0.2, but the diffuse coefficient must be between 0.5 and 1",
        ),
        (&["phong:alpha"], "phong:alpha: a colon must be followed by NAME=VALUE, e.g. phong:alpha=20"),
        (&["phong", "--set", "rouhgness=1"], "--set rouhgness=1: phong has no parameter rouhgness"),
        (
            &["phong", "--kind", "fresnel"],
            "--kind fresnel: Phong has no Fresnel factor F; models with one: ashikhmin_shirley, microfacet",
        ),
        (
            &["ward", "--kind", "d"],
            "--kind d: Ward has no distribution D of microfacets; models with one: microfacet, torrance_sparrow, cook_torrance, metallic_roughness, disney, openpbr, thin_glass, rough_dielectric and glass",
        ),
        (&["lambert", "--kind", "g"], "--kind g: Lambert has no masking factor G; models with one:"),
        (
            &["phong", "--theta-i", "95"],
            "--theta-i: the angle of the light is 95°, but it must be at least 0° and less than 90°",
        ),
        (&["phong", "--theta-i", "-5"], "--theta-i: the angle of the light is -5°"),
        (&["phong", "--phi-i", "inf"], "--phi-i: the azimuth of the light is inf°"),
        (
            &["phong", "--data", "krylon_bleu"],
            "--data is \"krylon_bleu\", but measured data must be one of the paints krylon_blue, garnet_red and acryl_blue",
        ),
        (
            &["phong", "--data", "krylon_blue"],
            "--theta-i: Krylon blue was measured with the light at 10°, 20°, 30°, 40°, 50°, 60°, 70° and 80°, not at 45°",
        ),
        (
            &["--data", "krylon_blue", "--kind", "slice"],
            "--kind slice: Krylon blue was measured only at single directions, so it has no image slice",
        ),
        (&["phong:alpha=20:alpha=30"], "phong:alpha=20:alpha=30: alpha is given twice"),
        (&["phong:base_color=1,2,3:base_colour=4,5,6"], "base_colour is given twice"),
        (&["phong", "-o", "x.jpg"], "-o x.jpg: a plot is written as .svg, .png or .csv; did you mean x.svg?"),
        (&["phong", "--kind", "brdf"], "invalid value 'brdf'"),
        (&["phong", "--channel", "x"], "luminance, r, g, b"),
        (&[], "MODEL"),
    ] {
        refused(arguments, 2, expected);
    }
    refused(
        &["phong", "-o", "/dev/null/x.svg"],
        4,
        "/dev/null/x.svg could not be written: /dev/null is not a folder",
    );
}

#[test]
fn files_are_what_their_names_say_and_replace_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let plot = |arguments: &[&str]| {
        lcm_in(folder.path(), &[&["plot", "phong", "--theta-i", "30"], arguments].concat(), b"")
    };
    let read = |name: &str| fs::read(folder.path().join(name)).expect("written");
    for name in ["a.svg", "a.png", "a.csv"] {
        // The second run replaces the first.
        for _ in 0..2 {
            let run = plot(&["-o", name]);
            assert_eq!(
                (run.status, run.out.as_str(), run.err.as_str()),
                (Some(0), "", &*format!("wrote {name}\n"))
            );
        }
    }
    assert_eq!(names(folder.path()), ["a.csv", "a.png", "a.svg"], "nothing else is left behind");
    assert_eq!(plot(&["-o", "new/folder/a.svg"]).status, Some(0));
    assert!(read("new/folder/a.svg") == read("a.svg"));
    let svg = String::from_utf8(read("a.svg")).expect("text");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for shown in [
        "aria-label=\"BRDF in the plane of incidence, light at 30°: Phong\"",
        ">BRDF in the plane of incidence, light at 30°</text>",
        ">f (sr⁻¹)</text>",
        ">angle of the viewer (°), mirror side positive</text>",
        ">Phong</text>",
        ">−60</text>",
    ] {
        assert!(svg.contains(shown), "{shown}");
    }
    assert!(!svg.contains(">Lambert</text>"));
    assert_eq!(String::from_utf8(read("a.csv")).expect("text"), plot(&[]).out);
    assert_eq!(read("a.png")[..8], *b"\x89PNG\r\n\x1a\n");
    let picture = crate::renderers::golden::read_png(&folder.path().join("a.png")).expect("a picture");
    assert_eq!((picture.0, picture.1), (1920, 1200));
    for (name, what) in
        [("a.svg", "an SVG file"), ("a.png", "a PNG file"), ("a.csv", "a CSV file of lcm plot")]
    {
        fs::write(folder.path().join(name), "my notes").expect("written");
        let run = plot(&["-o", name]);
        assert_eq!(run.status, Some(4));
        assert!(
            run.err.contains(&format!("{name} exists and is not {what}; it was not overwritten")),
            "{}",
            run.err
        );
        assert_eq!(read(name), b"my notes");
    }
}

#[test]
fn the_curve_goes_through_its_points() {
    // Lambert's law is a level line; a wrong twin bends.
    let line = |model: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        let run = lcm_in(folder.path(), &["plot", model, "--theta-i", "30", "-o", "a.svg"], b"");
        assert_eq!(run.status, Some(0), "{}", run.err);
        let svg = fs::read_to_string(folder.path().join("a.svg")).expect("written");
        let curve = svg.lines().rfind(|l| l.contains("stroke=\"#0072b2\"")).expect("a curve").to_owned();
        let points =
            curve.split("points=\"").nth(1).and_then(|p| p.split('"').next()).expect("points").to_owned();
        let heights =
            points.split(' ').map(|p| p.split(',').nth(1).expect("y").parse::<f64>().expect("a number"));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
        high - low
    };
    assert!(line("lambert") < 0.1 && line("phong") > 100.0);
}

/// A model that returns NaN where the viewer is far from the normal.
const BROKEN: &str = r#"/* lcm { "name": "Broken" } */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(sqrt(dot(frame.n, v) - 0.5)), vec3(0.0));
}
"#;

#[test]
fn custom_models_are_plotted_and_what_is_no_number_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("broken.wgsl"), BROKEN).expect("written");
    let plot = |arguments: &[&str]| -> Run {
        let output =
            command_in(folder.path(), [&["plot", "broken", "--models", "."], arguments].concat()).output();
        output.expect("it runs").into()
    };
    let note = "Broken: values are not finite numbers from −89.9° to −60° and from 60° to 89.9°, where the curve has a gap.\n";
    let run = plot(&["--theta-i", "20"]);
    assert_eq!((run.status, run.err.as_str()), (Some(0), note));
    assert!(run.out.contains(",NaN,NaN,NaN,NaN\n"));
    let run = plot(&["--theta-i", "20", "-o", "a.svg"]);
    assert_eq!((run.status, run.err), (Some(0), format!("{note}wrote a.svg\n")));
    let svg = fs::read_to_string(folder.path().join("a.svg")).expect("written");
    assert!(svg.contains("Broken: values are not") && !svg.contains("NaN"));
    let run = plot(&["--kind", "slice", "-o", "a.png"]);
    assert!(run.err.contains("values are not finite numbers (magenta and black)"), "{}", run.err);
    let run = plot(&["--kind", "fresnel"]);
    assert_eq!(run.status, Some(2));
    assert!(run.err.contains("Broken has no Fresnel factor F"), "{}", run.err);
}

#[test]
fn the_documents_name_every_kind_and_every_model_with_factors() {
    let read =
        |name: &str| fs::read_to_string(root().join("docs").join(name)).expect("there").replace('\n', " ");
    let commands = read("command-line.md");
    for kind in Kind::ALL {
        assert!(commands.contains(&format!("| `{}` | ", kind.id())), "{}", kind.id());
    }
    let registry = Registry::builtin();
    let code = |ids: &[&str]| ids.iter().map(|id| format!("`{id}`")).collect::<Vec<_>>();
    let all = code(&subjects_with(Kind::Distribution, &registry));
    let (last, first) = all.split_last().expect("some");
    let models = read("reflection-models.md");
    assert!(models.contains(&format!("F, D and G exist for {} and {last}", first.join(", "))));
    let only: Vec<_> =
        code(&subjects_with(Kind::Fresnel, &registry)).into_iter().filter(|id| !all.contains(id)).collect();
    assert!(models.contains(&format!("F alone for {} too", only.join(", "))), "{only:?}");
}
