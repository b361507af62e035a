//! Options of `lcm render` and `lcm sweep` that change every scene before it is drawn.

use clap::Args;

use super::{Options, Outcome, scenes::Source, workshop::Workshop};
use crate::{
    failure::Failure,
    optics::tone::ToneMapping,
    registry::Registry,
    scene::{Display, Scene, field::Ids},
    text::{behind, listed, quoted},
};

/// Models and display settings in place of those of a scene.
#[derive(Args, Debug)]
pub(super) struct Changes {
    /// Use this reflection model for every object
    #[arg(long, value_name = "ID")]
    reflection: Option<String>,
    /// Use this shading model for every object
    #[arg(long, value_name = "ID")]
    shading: Option<String>,
    #[arg(long, value_name = "NAME", help = format!(
        "Use this tone mapping instead of the scene's: {}", listed(&ToneMapping::ALL.map(ToneMapping::id), "or")
    ))]
    tone_mapping: Option<String>,
    /// Use this exposure in EV instead of the scene's; each step up doubles the light
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = exposure)]
    exposure: Option<Exposure>,
}

/// An exposure, with the text that was given.
#[derive(Clone, Debug)]
struct Exposure {
    ev: f32,
    written: String,
}

/// Parser of the exposure; its range is checked with those of all changes.
fn exposure(text: &str) -> Result<Exposure, String> {
    let ev = text.trim().parse().map_err(|_| "it must be a number of EV, e.g. -1.5".to_owned())?;
    Ok(Exposure { ev, written: text.to_owned() })
}

impl Changes {
    /// Fails if an option has a wrong value. Reads the custom model that is named.
    pub(super) fn check(&self, workshop: &mut Workshop) -> Outcome {
        let usage = |flag: &str, value: &str, rule: String| {
            Failure::Usage(format!("--{flag} is {}, but {}", quoted(value), behind(flag, &rule)))
        };
        if let Some(id) = &self.reflection {
            workshop.need(id);
            let registry = &workshop.registry;
            Ids::ReflectionModel.check(registry, id).map_err(|rule| {
                super::evaluate::unknown(registry, id, format!("--reflection is {}, but {rule}", quoted(id)))
            })?;
        }
        if let Some(id) = &self.shading {
            Ids::ShadingModel.check(&workshop.registry, id).map_err(|rule| usage("shading", id, rule))?;
        }
        if let Some(Exposure { ev, written }) = &self.exposure {
            Display::exposure.check_number(*ev).map_err(|rule| usage("exposure", written, rule))?;
        }
        if let Some(id) = &self.tone_mapping {
            Display::tone_mapping.check_text(id).map_err(|rule| usage("tone-mapping", id, rule))?;
        }
        Ok(())
    }

    /// The options that are given, each with the path of the value that it sets.
    pub(super) fn given(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        [
            (self.reflection.is_some(), "--reflection", "reflection_model"),
            (self.shading.is_some(), "--shading", "shading_model"),
            (self.tone_mapping.is_some(), "--tone-mapping", "display.tone_mapping"),
            (self.exposure.is_some(), "--exposure", "display.exposure"),
        ]
        .into_iter()
        .filter_map(|(given, flag, path)| given.then_some((flag, path)))
    }

    /// Reads a scene and changes it. Says which numbers of materials its models do not allow, so that the nearest are used.
    pub(super) fn open(
        &self,
        source: &Source,
        workshop: &mut Workshop,
        options: Options,
    ) -> Result<Scene, Failure> {
        let mut scene = self.apply(source.open(workshop, options)?, &workshop.registry);
        let mut beyond = scene.bring_into_range(&workshop.registry);
        beyond.extend(scene.beyond_the_range_of_views(&workshop.registry));
        beyond.iter().for_each(|said| options.tell(format_args!("{}: {said}", source.name())));
        Ok(scene)
    }

    /// The scene with the changes. A model from the command line also replaces the overrides of objects and
    /// views: the purpose is to see the whole scene with it. The materials go along as in the window.
    fn apply(&self, mut scene: Scene, registry: &Registry) -> Scene {
        let Self { reflection, shading, .. } = self;
        let exposure = self.exposure.as_ref().map(|exposure| exposure.ev);
        let tone_mapping = self.tone_mapping.as_deref().and_then(ToneMapping::from_id);
        if let Some(id) = reflection {
            scene.show_with(id, registry);
        }
        if let Some(id) = shading {
            scene.shading_model.clone_from(id);
            scene.objects.iter_mut().for_each(|o| o.shading_model = None);
        }
        scene.display.tone_mapping = tone_mapping.unwrap_or(scene.display.tone_mapping);
        scene.display.exposure = exposure.unwrap_or(scene.display.exposure);
        for variant in &mut scene.variants {
            variant.shading_model.take_if(|_| shading.is_some());
            variant.tone_mapping.take_if(|_| tone_mapping.is_some());
            variant.exposure.take_if(|_| exposure.is_some());
        }
        scene
    }
}
