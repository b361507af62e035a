//! Lights of types with edited WGSL, which the CPU renderer does not run: it has their functions in Rust. Here the
//! interpreter runs it.

use std::{
    collections::HashMap,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::{Vec2, Vec3};

use crate::{
    light::{
        Incident, LightEntry, LightRecord,
        extent::{Sample, Seen},
    },
    optics::colour::Encoding,
    registry::{
        Registry,
        compose::{FILE_TABLE, compose_light, numbers_of_files},
    },
    scene::{Light, record},
    shader::{check::validate, compose::Sources, interpret::Program},
};

/// The functions of edited light types, each prepared once.
#[derive(Debug, Default)]
pub(super) struct EditedLights {
    sources: Sources,
    functions: HashMap<&'static str, Option<Functions>>,
}

impl EditedLights {
    /// A light as the edited WGSL of its type gives it; `None` if no edit affects the type, or the CPU cannot run it.
    pub(super) fn lamp(
        &mut self,
        light: &Light,
        registry: &Registry,
        encoding: Encoding,
    ) -> Option<EditedLamp<'_>> {
        let sources = registry.sources();
        if self.sources != *sources {
            (self.sources, self.functions) = (sources.clone(), HashMap::new());
        }
        let entry = registry.light(&light.light_type)?;
        let known = self.functions.entry(entry.declaration.id);
        let functions = known.or_insert_with(|| Functions::of(entry, sources)).as_ref()?;
        let (own, files) = entry.arguments(&light.parameters, encoding);
        let fits = files.len() <= numbers_of_files(entry);
        fits.then(|| EditedLamp { functions, own, files, record: record(light, registry, encoding) })
    }
}

/// The WGSL functions of a light type.
#[derive(Debug)]
struct Functions {
    /// `incident`, or `sample` and `seen` of a type with extent.
    programs: Vec<Program>,
    extent: bool,
    /// True if a function exceeded the step limit, which takes time.
    endless: AtomicBool,
}

impl Functions {
    fn of(light: &LightEntry, sources: &Sources) -> Option<Self> {
        sources.edited().next()?;
        let composed = compose_light(sources, light);
        if !sources.edited().any(|path| composed.depends_on(path)) {
            return None;
        }
        let module = validate(&composed).ok()?;
        let extent = light.declaration.extent;
        let names: &[&str] = if extent { &["sample_light", "seen_light"] } else { &["incident"] };
        let programs = names.iter().map(|name| Program::with_table(&module, name, FILE_TABLE).ok());
        Some(Self { programs: programs.collect::<Option<_>>()?, extent, endless: AtomicBool::new(false) })
    }
}

/// A light with its parameters.
pub(super) struct EditedLamp<'a> {
    functions: &'a Functions,
    own: Vec<u32>,
    files: Vec<u32>,
    record: LightRecord,
}

impl EditedLamp<'_> {
    /// True if the type has extent: [`sample`](Self::sample) and [`seen`](Self::seen) instead of
    /// [`incident`](Self::incident).
    pub(super) fn has_extent(&self) -> bool {
        self.functions.extent
    }

    /// The light arriving at `p`.
    pub(super) fn incident(&self, p: Vec3) -> Incident {
        let [x, y, z, red, green, blue, everywhere] = self.run(0, p, &[]);
        let intensity = Vec3::new(red, green, blue);
        match everywhere.to_bits() {
            0 => Incident::From { l: Vec3::new(x, y, z), intensity },
            _ => Incident::Uniform { intensity },
        }
    }

    /// A direction from `p` to the light, for a point of the unit square.
    pub(super) fn sample(&self, p: Vec3, u: Vec2) -> Sample {
        let [x, y, z, red, green, blue, pdf] = self.run(0, p, &u.to_array());
        Sample { l: Vec3::new(x, y, z), radiance: Vec3::new(red, green, blue), pdf }
    }

    /// The light, seen in a direction from `p`.
    pub(super) fn seen(&self, p: Vec3, l: Vec3) -> Seen {
        let [red, green, blue, pdf, distance] = self.run(1, p, &l.to_array());
        Seen { radiance: Vec3::new(red, green, blue), pdf, distance }
    }

    /// The results of a function for a point; zeros if it runs too long.
    fn run<const N: usize>(&self, function: usize, p: Vec3, last: &[f32]) -> [f32; N] {
        let Functions { programs, endless, .. } = self.functions;
        let mut results = [0; N];
        let Some(program) = programs.get(function).filter(|_| !endless.load(Ordering::Relaxed)) else {
            return [0.0; N];
        };
        let mut arguments = self.record.arguments(&self.own, p);
        arguments.extend(last.iter().map(|number| number.to_bits()));
        if program.run_with(&self.files, &arguments, &mut results).is_err() {
            endless.store(true, Ordering::Relaxed);
            return [0.0; N];
        }
        results.map(f32::from_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_is_run_only_where_an_edit_affects_its_type() {
        let mut registry = Registry::builtin();
        let mut edited = EditedLights::default();
        let point = Light { light_type: "point".to_owned(), intensity: 8.0, ..Light::default() };
        let mut lit = |registry: &Registry| {
            let lamp = edited.lamp(&point, registry, Encoding::Srgb)?;
            let place = lamp.record.position + 2.0 * Vec3::X;
            match lamp.incident(place) {
                Incident::From { intensity, .. } => Some(intensity.x),
                Incident::Uniform { .. } => None,
            }
        };
        assert_eq!(lit(&registry), None);
        registry.sources_mut().edit("reflection/phong.wgsl", "// mine");
        assert_eq!(lit(&registry), None);
        let wgsl = registry.light("point").expect("built in").declaration.wgsl;
        for (factor, expected) in [("3.0", 6.0), ("5.0", 10.0)] {
            let text = wgsl.text.replace("vec3(light.intensity", &format!("vec3({factor} * light.intensity"));
            registry.sources_mut().edit(wgsl.path, text);
            assert_eq!(lit(&registry), Some(expected));
        }
        let endless = wgsl.text.replace("let to_light", "var x = 0.0; loop { x += 1.0; }\n    let to_light");
        registry.sources_mut().edit(wgsl.path, endless);
        assert!(matches!(lit(&registry), None | Some(0.0)), "it ends");
        registry.sources_mut().edit(wgsl.path, "nonsense");
        assert_eq!(lit(&registry), None);
    }
}
