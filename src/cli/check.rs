//! `lcm check`: all problems of scenes.

use std::{collections::BTreeSet, fmt::Write as _, path::PathBuf};

use clap::Args;

use super::{
    Checked, Options, Outcome, complain,
    scenes::Source,
    workshop::{Workshop, on_disk, shader_problems},
};
use crate::{
    explain::{
        dark_glass::dark_glass,
        finite::{Scope, Tried, probe},
        solids::{Tested, thin},
    },
    reflection::ModelEntry,
    registry::Registry,
    scene::{
        Scene,
        error::{LoadError, Path, Problem},
        load::Defaults,
    },
    shader::{check::ShaderProblem, report::annotated},
    text::plural,
};

/// The problems of a legal scene that appear when it is drawn, for people and for programs: invalid shaders,
/// models that run too long, and light that is not finite, in any of its views.
fn drawn(scene: &Scene, name: &str, registry: &Registry) -> (String, Vec<Problem>) {
    let (mut said, mut problems) = (Vec::new(), Vec::new());
    let mut tried = Tried::default();
    // With the parameters of the previous scene, a model may have run too long.
    registry.models().iter().for_each(ModelEntry::run_again);
    for view in 0..=scene.variants.len() {
        let Some((seen, _)) = scene.seen(view, registry) else { continue };
        for (i, problem) in shader_problems(registry, &seen) {
            let file = on_disk(registry, &problem.file);
            let ShaderProblem { line, column, message, .. } = &problem;
            let rule =
                format!("cannot be drawn: there is an error in a shader, {file}:{line}:{column}: {message}");
            put(&mut problems, Problem::about(Path::root().key("objects").index(i), rule), || {
                said.push(annotated(&problem, &file));
            });
        }
        let odd = probe(&seen, registry, Scope::All, &mut tried);
        for odd in odd.into_iter().chain(tried.too_long().to_vec()) {
            let line = format!("{name}: {odd}");
            put(&mut problems, Problem::about(odd.path.clone(), odd.rest()), || said.push(line));
        }
    }
    (said.join("\n"), problems)
}

/// A line for each model of a legal scene that only a GPU can run, with the first object that uses it in any
/// of its views.
fn only_on_gpu(scene: &Scene, name: &str, registry: &Registry) -> Vec<String> {
    let (mut said, mut met) = (Vec::new(), BTreeSet::new());
    for (seen, _) in (0..=scene.variants.len()).filter_map(|view| scene.seen(view, registry)) {
        for (i, object) in seen.objects.iter().enumerate() {
            let Some(model) = registry.model(seen.model_of(object)) else { continue };
            let id = model.declaration.id;
            let Some(why) = model.not_on_cpu().filter(|_| !model.runs_too_long() && met.insert(id)) else {
                continue;
            };
            let path = Path::root().key("objects").index(i);
            said.push(format!(
                "{name}: {path} has the reflection model {id}, which the CPU renderer cannot run ({why}): only \
                 the GPU renderer draws it, and lcm explain does not support it"
            ));
        }
    }
    said
}

/// Remarks on the glass of a legal scene in any of its views: a line for each object that a solid model draws as thin glass,
/// and one on smooth glass through which no light is seen.
pub(super) fn of_glass(scene: &Scene, name: &str, registry: &Registry) -> Vec<String> {
    let (mut said, mut tested) = (Vec::new(), Tested::default());
    for (seen, _) in (0..=scene.variants.len()).filter_map(|view| scene.seen(view, registry)) {
        let thin = thin(&seen, registry, &mut tested);
        for remark in thin.into_iter().chain(dark_glass(&seen, registry)) {
            let line = format!("{name}: {remark}");
            if !said.contains(&line) {
                said.push(line);
            }
        }
    }
    said
}

/// Adds a problem unless it is known.
fn put(problems: &mut Vec<Problem>, problem: Problem, say: impl FnOnce()) {
    if !problems.contains(&problem) {
        say();
        problems.push(problem);
    }
}

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene files; `-` is standard input
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    // Checking does not ask questions: missing parts are problems, unless `--use-defaults` is given.
    let defaults = match options.defaults() {
        Defaults::Ask => Defaults::Refuse,
        answered => answered,
    };
    let mut checked = Checked::new();
    for path in &arguments.scenes {
        let source = Source::named(path);
        let mut problems = Vec::new();
        let read = match source.read(workshop, defaults) {
            Err(LoadError::Empty { .. }) if defaults == Defaults::Use => {
                Source::Default.read(workshop, defaults)
            }
            read => read,
        };
        let read = read.map_err(|error| (error.to_string(), error.problems()));
        let read = read.and_then(|loaded| match drawn(&loaded.scene, &source.name(), &workshop.registry) {
            (_, problems) if problems.is_empty() => Ok(loaded),
            wrong => Err(wrong),
        });
        match read {
            Ok(loaded) => {
                let (scene, name) = (&loaded.scene, source.name());
                let gpu = only_on_gpu(scene, &name, &workshop.registry);
                let glass = of_glass(scene, &name, &workshop.registry);
                gpu.into_iter().chain(glass).for_each(|line| options.tell(line));
                let Scene { lights, objects, variants, .. } = &loaded.scene;
                let mut counts = vec![plural(lights.len(), "light"), plural(objects.len(), "object")];
                counts.extend((!variants.is_empty()).then(|| plural(variants.len(), "variant")));
                // Writing to a String cannot fail.
                let _ = writeln!(checked.listed, "{}: valid: {}", source.name(), counts.join(", "));
                for said in loaded.scene.beyond_the_range_of_views(&workshop.registry) {
                    let _ = writeln!(checked.listed, "{}: {said}", source.name());
                }
            }
            Err((said, found)) => {
                problems = found;
                if !arguments.json {
                    complain(&said);
                }
            }
        }
        checked.add(source.plain_name(), problems);
    }
    checked.print(arguments.json, options, "scenes")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        optics::{Frame, Terms},
        parameters,
        reflection::{Declaration, ReflectionModel},
        registry::Register as _,
        scene::Variant,
        shader::Source,
    };
    use glam::Vec3;

    parameters! {
        struct Misnamed {}
    }
    parameters! {
        struct Fieldless {}
    }

    macro_rules! guest {
        ($name:ident, $id:literal, $text:literal) => {
            impl ReflectionModel for $name {
                const DECLARATION: Declaration =
                    Declaration::new($id, "Guest", Source::new(concat!($id, ".wgsl"), $text));
                fn response(&self, _: Vec3, _: Vec3, _: &Frame) -> Terms {
                    Terms::default()
                }
                fn ambient_response(&self, _: Vec3, _: &Frame) -> Vec3 {
                    Vec3::ZERO
                }
            }
        };
    }
    guest!(Misnamed, "misnamed", "// mine\nfn respond() {}\n");
    guest!(
        Fieldless,
        "fieldless",
        "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), vec3(m.gloss), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return vec3(0.0); }
"
    );

    #[test]
    fn wrong_shaders_of_other_crates_are_problems_of_the_scenes_that_use_them() {
        let mut registry = Registry::builtin();
        registry.add_reflection_model::<Misnamed>().add_reflection_model::<Fieldless>();
        let mut scene = Scene::default();
        assert_eq!(drawn(&scene, "s.json", &registry), (String::new(), Vec::new()), "they are not used");
        for (id, place, message) in [
            ("misnamed", "misnamed.wgsl:2:4", "the function response is missing"),
            ("fieldless", "fieldless.wgsl:2:", "gloss"),
        ] {
            scene.reflection_model = id.to_owned();
            let (said, problems) = drawn(&scene, "s.json", &registry);
            assert!(said.contains(place) && said.contains(message), "{said}");
            assert_eq!(problems.len(), 1, "{problems:?}");
            let problem = problems[0].to_string();
            let begins = "objects[0] cannot be drawn: there is an error in a shader";
            assert!(problem.starts_with(begins), "{problem}");
            assert!(problem.contains(place) && problem.contains(message), "{problem}");
        }
        // A variant is drawn, too.
        scene.reflection_model = "phong".to_owned();
        scene.variants.push(Variant { reflection_model: Some("misnamed".to_owned()), ..Variant::default() });
        assert_eq!(drawn(&scene, "s.json", &registry).1.len(), 1);
    }
}
