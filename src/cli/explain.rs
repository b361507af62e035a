//! `lcm explain`: the colour of a pixel with every number behind it.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{
    Options, Outcome, gauged,
    light_samples::{self, Sampling},
    outputs, print_json, print_text,
    render::{cpu_can_draw, term},
    scenes::Source,
    sides,
    views::{Plan, find},
    workshop::{Workshop, drawable},
};
use crate::{
    explain::{
        Explainer, Explanation, Influence,
        hemisphere::{Hemisphere, Shining},
    },
    failure::Failure,
    optics::TermSelection,
    picture::png::About,
    reference::{Settings, ignored_edits},
    registry::Registry,
    scene::{Scene, variant::LETTERS},
    text::listed,
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file; `-` is standard input; without one, the default scene
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Column and row of the pixel, from 0,0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = place)]
    at: [u32; 2],
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = sides, default_value = "1280x720")]
    size: [u32; 2],
    /// Explain this view: A, B, C or D, or the name of a variant
    #[arg(long, value_name = "VIEW", default_value = "A")]
    view: String,
    /// Show only one term of the reflection model's equation
    #[arg(long, value_parser = term, default_value = "all", value_name = "all|ambient|diffuse|specular|transmitted")]
    term: TermSelection,
    /// Samples of each light with extent, and as many of the directions in which the object reflects most: 1 to 1048576; by
    /// default 256
    #[arg(long, value_name = "N", value_parser = light_samples::count, allow_hyphen_values = true)]
    light_samples: Option<u32>,
    /// Also print the numbers of the scene that would move this pixel most, by differences
    #[arg(long)]
    derivatives: bool,
    /// Also print the lines that differ in another view at this pixel
    #[arg(long, value_name = "VIEW")]
    beside: Option<String>,
    /// Also write a picture of the hemisphere above the point, a PNG file: the light that arrives, the lobe of the model, and
    /// their product
    #[arg(long, value_name = "FILE", value_parser = outputs::place())]
    hemisphere: Option<PathBuf>,
    /// Print the explanation as JSON
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print the explanation as Markdown
    #[arg(long)]
    markdown: bool,
}

impl Arguments {
    /// An explainer with the samples asked for.
    fn explainer(&self) -> Explainer {
        let mut explainer = Explainer::default();
        explainer.set_light_samples(Sampling::of(self.light_samples).until().samples);
        explainer
    }
}

/// Parser of pixels: column and row.
pub(super) fn place(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.trim().parse().ok();
    let both = text.split_once(',').and_then(|(x, y)| Some([side(x)?, side(y)?]));
    both.ok_or_else(|| "it must be X,Y: two whole numbers, 0 or more, e.g. 640,360".to_owned())
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let source = Source::of(arguments.scene.as_deref(), workshop);
    let scene = source.open(workshop, options)?;
    let registry = &workshop.registry;
    if let Some(file) = &arguments.hemisphere {
        outputs::one_picture("--hemisphere", file)?;
        outputs::picture(file, arguments.scene.as_slice())?;
    }
    // Many samples of light take a while.
    let (first, influences, other) = gauged("explaining the pixel", options, |_| -> Result<_, Failure> {
        let explained = |view: &str| explained(arguments, &source, &scene, view, options, registry);
        let first = explained(&arguments.view)?;
        if let Some(file) = &arguments.hemisphere {
            hemisphere(file, &first, registry, options)?;
        }
        let influences =
            arguments.derivatives.then(|| influences(arguments, &first, registry)).transpose()?;
        let other = arguments.beside.as_deref().map(explained).transpose()?;
        Ok((first, influences, other))
    })?;
    if arguments.json {
        let mut json = first.explanation.to_json();
        if let Some(influences) = &influences {
            let moves = influences.iter().filter(|influence| influence.moves());
            json["derivatives"] = moves.map(Influence::to_json).collect();
        }
        if let Some(other) = &other {
            json["beside"] = other.explanation.to_json();
        }
        return print_json(&json);
    }
    let markdown = arguments.markdown;
    let mut text = match markdown {
        true => first.explanation.to_markdown(),
        false => first.explanation.to_text(),
    };
    if let Some(other) = &other {
        let names = [first.view, other.view].map(|view| LETTERS.get(view).copied().unwrap_or("?"));
        text += &first.explanation.differences_to_text(&other.explanation, names, markdown);
    }
    if let Some(influences) = &influences {
        text += &Explanation::influences_to_text(influences, markdown);
    }
    print_text(&text)
}

/// The explanation of one view.
struct Explained {
    view: usize,
    scene: Scene,
    settings: Settings,
    explanation: Explanation,
}

fn explained(
    arguments: &Arguments,
    source: &Source,
    scene: &Scene,
    view: &str,
    options: Options,
    registry: &Registry,
) -> Result<Explained, Failure> {
    let view = find(scene, view).map_err(|why| Failure::Invalid(format!("{}: {why}", source.name())))?;
    let [width, height] = arguments.size;
    let plan = Plan::of_view(scene, view, [width, height], arguments.term, registry);
    let Some(part) = plan.parts.into_iter().next() else {
        return Err(Failure::Invalid(format!("{}: the view shows nothing", source.name())));
    };
    drawable(registry, &part.scene)?;
    cpu_can_draw(&part.scene, registry)?;
    let passed = ignored_edits(registry, &part.scene);
    if !passed.is_empty() {
        let passed = listed(&passed.iter().map(String::as_str).collect::<Vec<_>>(), "and");
        options.tell(format!("explanations follow the CPU renderer, which ignores the edited {passed}"));
    }
    let settings = Settings { width, height, samples: 1, terms: part.terms };
    let sampling = Sampling::of(arguments.light_samples);
    if let Some(remark) = sampling.idle(&part.scene, registry) {
        options.tell(remark);
    }
    let explanation = arguments
        .explainer()
        .pixel(&part.scene, registry, &settings, arguments.at)
        .map_err(|error| Failure::Usage(format!("--at: {error}")))?;
    // An endless function is detected only when it runs.
    cpu_can_draw(&part.scene, registry)?;
    Ok(Explained { view, scene: part.scene, settings, explanation })
}

fn influences(
    arguments: &Arguments,
    explained: &Explained,
    registry: &Registry,
) -> Result<Vec<Influence>, Failure> {
    let Explained { scene, settings, .. } = explained;
    let found = arguments.explainer().influences(scene, registry, settings, arguments.at);
    found.map_err(|error| Failure::Usage(format!("--at: {error}")))
}

/// Writes the hemisphere above the point with the greatest weight in the pixel.
fn hemisphere(file: &Path, explained: &Explained, registry: &Registry, options: Options) -> Outcome {
    /// Pixels per disc.
    const SIDE: usize = 320;
    let seen = explained.explanation.seen.as_ref();
    let spot = seen.and_then(|seen| Some((seen, seen.spots.get(seen.main_spot()?)?)));
    let (seen, spot) = spot.ok_or_else(|| {
        Failure::Usage(
            "--hemisphere: no reflection model was evaluated for this pixel; choose a pixel on an object"
                .to_owned(),
        )
    })?;
    let surface = &*seen.model.surface.0;
    let shining = Shining::new(&explained.scene, registry);
    let found = Hemisphere::new(&shining, surface, spot, explained.settings.terms, SIDE);
    found.nothing().into_iter().for_each(|remark| options.tell(format_args!("--hemisphere: {remark}")));
    let found = found.picture();
    let about =
        About::program().with("Title", "The hemisphere above a point").with("Description", found.about);
    outputs::tidy_beside(file);
    outputs::write_picture(file, found.size, &found.rgb8, &about)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_have_a_column_and_a_row() {
        assert_eq!(place("640,360"), Ok([640, 360]));
        assert_eq!(place(" 0, 7 "), Ok([0, 7]));
        for wrong in ["", "640", "640x360", "-1,5", "1,2,3", "1.5,2", "99999999999,1"] {
            assert!(place(wrong).is_err(), "{wrong}");
        }
    }
}
