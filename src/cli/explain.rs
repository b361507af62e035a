//! `lcm explain`: the colour of a pixel with every number behind it.

use std::{path::PathBuf, str::FromStr};

use clap::Args;

use super::{
    Options, Outcome, print, print_text,
    render::{Size, cpu_can_draw, term},
    scenes::Source,
    views::{Plan, find},
    workshop::{Workshop, drawable},
};
use crate::{
    explain,
    failure::Failure,
    optics::TermSelection,
    reference::{Settings, ignored_edits},
    text::listed,
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file; `-` is standard input; without one, the default scene
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Column and row of the pixel, from 0,0 at the top left
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    at: Pixel,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    size: Size,
    /// Explain this view: A, B, C or D, or the name of a variant
    #[arg(long, value_name = "VIEW", default_value = "A")]
    view: String,
    /// Show only one term of the reflection model's equation
    #[arg(long, value_parser = term, default_value = "all", value_name = "all|ambient|diffuse|specular")]
    term: TermSelection,
    /// Print the explanation as JSON
    #[arg(long)]
    json: bool,
}

/// Column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pixel([u32; 2]);

impl FromStr for Pixel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |s: &str| s.trim().parse().ok();
        text.split_once(',')
            .and_then(|(x, y)| Some(Self([side(x)?, side(y)?])))
            .ok_or_else(|| "it must be X,Y: two whole numbers, 0 or more, e.g. 640,360".to_owned())
    }
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let source = Source::of(arguments.scene.as_deref(), workshop);
    let scene = source.open(workshop, options)?;
    let registry = &workshop.registry;
    let view =
        find(&scene, &arguments.view).map_err(|why| Failure::Invalid(format!("{}: {why}", source.name())))?;
    let Size { width, height } = arguments.size;
    let plan = Plan::of_view(&scene, view, [width, height], arguments.term, registry);
    for part in &plan.parts {
        drawable(registry, &part.scene)?;
        cpu_can_draw(&part.scene, registry)?;
        let passed = ignored_edits(registry, &part.scene);
        if !passed.is_empty() {
            let passed: Vec<_> = passed.iter().map(String::as_str).collect();
            options.tell(format_args!(
                "the CPU renderer, which is explained, ignores the edited {}",
                listed(&passed, "and")
            ));
        }
        let settings = Settings { width, height, samples: 1, terms: part.terms };
        let explained = explain::pixel(&part.scene, registry, &settings, arguments.at.0)
            .map_err(|error| Failure::Usage(format!("--at: {error}")))?;
        // An endless function shows only when it runs.
        cpu_can_draw(&part.scene, registry)?;
        if arguments.json {
            print(&format!("{:#}\n", explained.to_json()))?;
        } else {
            print_text(&explained.to_text())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_have_a_column_and_a_row() {
        assert_eq!("640,360".parse(), Ok(Pixel([640, 360])));
        assert_eq!(" 0, 7 ".parse(), Ok(Pixel([0, 7])));
        for wrong in ["", "640", "640x360", "-1,5", "1,2,3", "1.5,2", "99999999999,1"] {
            assert!(wrong.parse::<Pixel>().is_err(), "{wrong}");
        }
    }
}
