//! Checks the WGSL of models, shading models and light types: required functions, their signatures, and
//! everything that naga rejects, located in the author's file.

use std::sync::LazyLock;

use naga::{Module, Scalar, ScalarKind, TypeInner, VectorSize};

use crate::{
    light::{LightEntry, Twin},
    reflection::{Ambient, ModelEntry},
    registry::{
        Registry,
        compose::{compose, compose_evaluation, compose_light},
    },
    shader::{
        Source,
        check::{ShaderProblem, validate},
        compose::Sources,
        definitions::{definition, functions},
        whole::validate_drawing,
    },
    shading::{ShadingEntry, Stage},
    text::nearest,
};

/// A function that a text must define.
#[derive(Clone, Debug)]
pub(crate) struct Function {
    name: String,
    signature: String,
}

impl Function {
    /// The error if a text lacks the function, and its byte, if known.
    pub(crate) fn missing(&self, text: &str) -> Option<(Option<usize>, String)> {
        let Self { name, signature } = self;
        if definition(text, name).is_some() {
            return None;
        }
        let defined = functions(text);
        let near = nearest(name, defined.iter().map(|(_, name)| (*name, *name)));
        let named = defined.iter().find(|(_, name)| Some(*name) == near);
        let hint = named.map_or_else(String::new, |(_, name)| format!("; did you name it {name}?"));
        Some((
            named.map(|(at, _)| *at),
            format!("the function {name} is missing; define fn {name}{signature}{hint}"),
        ))
    }

    /// Reports a file that lacks the function.
    fn required(&self, source: &Source, sources: &Sources) -> Result<(), Box<ShaderProblem>> {
        let text = sources.text(source);
        match self.missing(text) {
            None => Ok(()),
            Some((at, what)) => {
                Err(Box::new(ShaderProblem::at(source.path, text, at.unwrap_or_default(), what)))
            }
        }
    }

    /// The problem of a file that defines the function with another signature.
    fn otherwise(&self, source: &Source, sources: &Sources) -> Option<Box<ShaderProblem>> {
        let Self { name, signature } = self;
        let text = sources.text(source);
        let at = definition(text, name)?;
        let message = format!("{name} must be fn {name}{signature}");
        Some(Box::new(ShaderProblem::at(source.path, text, at, message)))
    }
}

/// The function `response` of models.
pub(crate) static RESPONSE: LazyLock<Function> = LazyLock::new(|| {
    function("response", "(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms")
});

fn function(name: &str, signature: &str) -> Function {
    Function { name: name.to_owned(), signature: signature.to_owned() }
}

/// The required functions of a model.
fn of_model(model: &ModelEntry) -> Vec<Function> {
    let mut all = vec![RESPONSE.clone()];
    if model.declaration.ambient == Ambient::Formula {
        all.push(function("ambient_response", "(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32>"));
    }
    if model.declaration.sharp {
        all.push(function("sharp", "(i: u32, v: vec3<f32>, frame: Frame, m: Parameters) -> Sharp"));
    }
    all
}

/// The required functions of a light type.
fn of_light(light: &LightEntry) -> Vec<Function> {
    let twins = Twin::all(light.declaration.extent).iter();
    twins.map(|twin| function(&twin.of(light), &twin.signature(light))).collect()
}

/// The required functions of a shading model.
fn of_shading() -> [Function; 2] {
    [
        function("shade_vertex", "(corner: Corner) -> Varying"),
        function("shade_pixel", "(passed: Varying) -> vec3<f32>"),
    ]
}

/// Checks the WGSL of a model on its own.
///
/// # Errors
/// Returns the first problem.
pub(crate) fn model(sources: &Sources, model: &ModelEntry) -> Result<Module, Box<ShaderProblem>> {
    let source = &model.declaration.wgsl;
    let all = of_model(model);
    all.iter().try_for_each(|function| function.required(source, sources))?;
    let composed = compose_evaluation(sources, model);
    let module = validate(&composed).map_err(|found| {
        // The caller of the model is not to blame.
        let called = found.file == crate::shader::compose::EVALUATE.path;
        called.then(|| all[0].otherwise(source, sources)).flatten().unwrap_or(found)
    })?;
    // The evaluation calls `response` alone.
    let wrong = all.iter().skip(1).find(|function| !has_signature(&module, &function.name));
    wrong.and_then(|function| function.otherwise(source, sources)).map_or(Ok(module), Err)
}

/// Checks the WGSL of a light type on its own.
///
/// # Errors
/// Returns the first problem.
pub(crate) fn light(sources: &Sources, light: &LightEntry) -> Result<Module, Box<ShaderProblem>> {
    let source = &light.declaration.wgsl;
    let all = of_light(light);
    all.iter().try_for_each(|function| function.required(source, sources))?;
    validate(&compose_light(sources, light)).map_err(|found| {
        // The caller of the light type is not to blame: its line names the function.
        let called = found.file.starts_with('(');
        let named = || all.iter().find(|function| found.source.contains(&function.name));
        let caller = called.then(|| named().or(all.first())).flatten();
        caller.and_then(|function| function.otherwise(source, sources)).unwrap_or(found)
    })
}

/// Checks the WGSL of a shading model together with a reflection model.
///
/// # Errors
/// Returns the first problem.
pub(crate) fn shading(
    sources: &Sources,
    shading: &ShadingEntry,
    model: &ModelEntry,
) -> Result<(), Box<ShaderProblem>> {
    let source = &shading.declaration.wgsl;
    let all = of_shading();
    all.iter().try_for_each(|function| function.required(source, sources))?;
    let composed = compose(sources, (model, model.declaration.passage()), shading, &[]);
    validate_drawing(&composed, shading.declaration.stage == Stage::Polygon).map_err(|found| {
        // The wrapper calls both, each in a line that names it.
        let called = found.file == crate::shader::compose::WRAPPER.path;
        let named = || all.iter().find(|function| found.source.contains(&function.name));
        let caller = called.then(|| named().or(all.first())).flatten();
        caller.and_then(|function| function.otherwise(source, sources)).unwrap_or(found)
    })
}

/// Names the author's file if a problem in a composed source appears elsewhere: a function from another crate
/// that is missing, or has another signature.
pub(crate) fn blamed(
    problem: Box<ShaderProblem>,
    registry: &Registry,
    model: &ModelEntry,
    shading: &ShadingEntry,
    lights: &[LightEntry],
) -> Box<ShaderProblem> {
    let sources = registry.sources();
    let foreign = |source: &Source| registry.is_foreign(source.path);
    let of_author = |path: &str| registry.is_foreign(path) || sources.get(path).is_some();
    if of_author(&problem.file) {
        return problem;
    }
    let lights = lights.iter().filter(|l| foreign(&l.declaration.wgsl));
    let of_lights = lights.filter_map(|l| light(sources, l).err());
    let of_model = [model].into_iter().filter(|m| foreign(&m.declaration.wgsl));
    let of_model = of_model.filter_map(|m| self::model(sources, m).err());
    let of_shading = [shading].into_iter().filter(|s| foreign(&s.declaration.wgsl));
    let of_shading = of_shading.filter_map(|s| self::shading(sources, s, registry.models().first()?).err());
    let mut found = of_lights.chain(of_model).chain(of_shading).filter(|p| of_author(&p.file));
    found.next().unwrap_or(problem)
}

/// True if the function for uniform light, `ambient_response`, or that for light that does not spread, `sharp`, has the
/// signature that the light loop expects.
fn has_signature(module: &Module, name: &str) -> bool {
    let vector = |ty| {
        matches!(
            module.types[ty].inner,
            TypeInner::Vector { size: VectorSize::Tri, scalar } if scalar.kind == ScalarKind::Float
        )
    };
    let whole = |ty| matches!(module.types[ty].inner, TypeInner::Scalar(Scalar::U32));
    let called = |ty, name: &str| module.types[ty].name.as_deref() == Some(name);
    let Some((_, f)) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name)) else {
        return false;
    };
    let result = f.result.as_ref().map(|result| result.ty);
    let at_view = |v, frame, m| vector(v) && called(frame, "Frame") && called(m, "Parameters");
    match f.arguments.as_slice() {
        [v, frame, m] => result.is_some_and(vector) && at_view(v.ty, frame.ty, m.ty),
        [i, v, frame, m] => {
            result.is_some_and(|ty| called(ty, "Sharp")) && whole(i.ty) && at_view(v.ty, frame.ty, m.ty)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_built_in_passes() {
        let registry = Registry::builtin();
        let sources = Sources::default();
        for entry in registry.models() {
            assert_eq!(model(&sources, entry).err(), None, "{}", entry.declaration.id);
        }
        for entry in registry.lights() {
            assert_eq!(light(&sources, entry).err(), None, "{}", entry.declaration.id);
        }
        for entry in registry.shading_models() {
            let lambert = registry.model("lambert").expect("built in");
            assert_eq!(shading(&sources, entry, lambert), Ok(()), "{}", entry.declaration.id);
        }
    }

    /// The problem of a file after this edit.
    fn problem(path: &str, from: &str, to: &str) -> String {
        let registry = Registry::builtin();
        let lambert = registry.model("lambert").expect("built in");
        let spot = registry.light("spot").expect("built in");
        let phong = registry.shading_model("phong").expect("built in");
        let sources = [lambert.declaration.wgsl, spot.declaration.wgsl, phong.declaration.wgsl];
        let source = sources.iter().find(|s| s.path == path).expect("one of these");
        assert!(source.text.contains(from), "{path}: {from}");
        let mut edited = Sources::default();
        edited.edit(path, source.text.replacen(from, to, 1));
        let all = [
            model(&edited, lambert).err(),
            light(&edited, spot).err(),
            shading(&edited, phong, lambert).err(),
        ];
        all.into_iter().flatten().next().map(|p| p.to_string()).unwrap_or_default()
    }

    #[test]
    fn mistakes_are_named_at_their_place_in_the_authors_file() {
        let lambert = "reflection/lambert.wgsl";
        for (path, from, to, parts) in [
            (
                lambert,
                "fn response(",
                "fn respond(",
                &["the function response is missing", "did you name it respond?"][..],
            ),
            (lambert, "l: vec3<f32>", "l: vec2<f32>", &["lambert.wgsl:"]),
            (
                lambert,
                "fn ambient_response(v: vec3<f32>, ",
                "fn ambient_response(v: vec2<f32>, ",
                &["ambient_response must be fn ambient_response(v: vec3<f32>"],
            ),
            (lambert, "frame.n", "frame.normal", &["lambert.wgsl:"]),
            (
                "light/spot.wgsl",
                "incident_spot",
                "incident_sport",
                &[
                    "the function incident_spot is missing; define fn incident_spot(light: Light, m: SpotParameters, p: vec3<f32>) -> Incident",
                    "did you name it incident_sport?",
                ],
            ),
            (
                "light/spot.wgsl",
                "p: vec3<f32>)",
                "p: vec3<f32>, q: f32)",
                &["incident_spot must be fn incident_spot(light: Light, m: SpotParameters, p"],
            ),
            ("light/spot.wgsl", "m: SpotParameters, ", "", &["spot.wgsl:"]),
            (
                "light/spot.wgsl",
                "m.inner_rise",
                "m.inner_rice",
                &["spot.wgsl:5:", "did you mean inner_rise?"],
            ),
            ("light/spot.wgsl", "unit_or_zero", "unit_or_one", &["spot.wgsl:4:"]),
            (
                "shading/phong.wgsl",
                "fn shade_pixel(",
                "fn shade_pixels(",
                &["the function shade_pixel is missing"],
            ),
            (
                "shading/phong.wgsl",
                "fn shade_vertex(corner: Corner)",
                "fn shade_vertex(corner: Varying)",
                &["phong.wgsl:"],
            ),
            (
                "shading/phong.wgsl",
                "(passed: Varying) -> vec3<f32> {",
                "(passed: Varying, more: f32) -> vec3<f32> {",
                &["shade_pixel must be fn shade_pixel(passed: Varying) -> vec3<f32>"],
            ),
        ] {
            let said = problem(path, from, to);
            assert!(said.starts_with(path), "{to}: {said}");
            for part in parts {
                assert!(said.contains(part), "{to}: {said}");
            }
        }
        assert_eq!(problem(lambert, "frame.n", "frame.n"), "");
    }
}
