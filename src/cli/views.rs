//! The views of a scene on the command line: the ones to draw, and how they are compared.

use clap::Args;

use crate::{
    compare::{Cell, cells},
    failure::Failure,
    optics::TermSelection,
    registry::Registry,
    scene::{
        Comparison, Field, Scene,
        comparison::{Channel, Compared, Edge, Layout, Sign},
        held::Word,
        variant::LETTERS,
    },
    text::{did_you_mean, listed, quoted},
};

/// Options that change how views are compared.
#[derive(Args, Debug)]
pub(super) struct Choice {
    /// Arrange the views so: single, side_by_side, wipe, difference or blink
    #[arg(long, value_parser = |text: &str| word::<Layout>(text, Comparison::layout))]
    layout: Option<Layout>,
    /// Compare view A with this one: its letter, or the name of its variant
    #[arg(long, value_name = "VIEW")]
    pub(super) with: Option<String>,
    /// Show the size of differences, or with their sign: absolute or signed
    #[arg(long, value_parser = |text: &str| word::<Sign>(text, Comparison::sign))]
    sign: Option<Sign>,
    /// Compare this number of pixels: largest, luminance, red, green or blue
    #[arg(long, value_parser = |text: &str| word::<Channel>(text, Comparison::channel))]
    channel: Option<Channel>,
    /// Compare display codes, or linear light: codes or light
    #[arg(long, value_parser = |text: &str| word::<Compared>(text, Comparison::values))]
    values: Option<Compared>,
    /// Multiply differences by this, 1 to 100, before they become colours; else by what fits the largest one
    #[arg(long, value_name = "FACTOR", value_parser = |text: &str| number(text, Comparison::amplification))]
    amplification: Option<f32>,
    /// Place the edge of a wipe here: 0 at the left or top, 1 at the right or bottom
    #[arg(long, value_name = "PLACE", value_parser = |text: &str| number(text, Comparison::split))]
    split: Option<f32>,
    /// Direction of the edge of a wipe: vertical or horizontal
    #[arg(long, value_parser = |text: &str| word::<Edge>(text, Comparison::edge))]
    edge: Option<Edge>,
}

/// Reads the word of a field.
pub(super) fn word<T: Word>(text: &str, field: Field) -> Result<T, String> {
    field.check_text(text).and_then(|()| T::of_word(text).ok_or_else(|| "it is unknown".to_owned()))
}

/// Reads the number of a field.
fn number(text: &str, field: Field) -> Result<f32, String> {
    let number = text.parse().unwrap_or(f32::NAN);
    field.check_number(number).map(|()| number)
}

impl Choice {
    /// The comparison with these changes, except for the other view. For a single view, there is no
    /// comparison: the views are then side by side.
    pub(super) fn applied(&self, comparison: Comparison) -> Comparison {
        let usual = match comparison.layout {
            Layout::Single => Layout::SideBySide,
            layout => layout,
        };
        Comparison {
            layout: self.layout.unwrap_or(usual),
            sign: self.sign.unwrap_or(comparison.sign),
            channel: self.channel.unwrap_or(comparison.channel),
            values: self.values.unwrap_or(comparison.values),
            amplification: self.amplification.or(comparison.amplification),
            split: self.split.unwrap_or(comparison.split),
            edge: self.edge.unwrap_or(comparison.edge),
            with: comparison.with,
        }
    }
}

/// The view with a letter, or with the name of its variant.
pub(super) fn find(scene: &Scene, name: &str) -> Result<usize, String> {
    let letters = &LETTERS[..=scene.variants.len().min(LETTERS.len() - 1)];
    let letter = letters.iter().position(|letter| letter.eq_ignore_ascii_case(name));
    let named = || scene.variants.iter().position(|v| v.name.as_deref() == Some(name)).map(|i| i + 1);
    letter.or_else(named).ok_or_else(|| {
        let names = scene.variants.iter().filter_map(|variant| variant.name.as_deref());
        let hint = did_you_mean(name, names.map(|n| (n, n)));
        let known = |(i, letter): (usize, &&str)| {
            let name = i.checked_sub(1).and_then(|i| scene.variants.get(i)?.name.as_deref());
            name.map_or_else(|| (*letter).to_owned(), |name| format!("{letter} ({name})"))
        };
        let known: Vec<_> = letters.iter().enumerate().map(known).collect();
        format!("there is no view {}; it must be {}{hint}", quoted(name), listed(&known, "or"))
    })
}

/// A part of a picture: a view, and its area.
pub(super) struct Part {
    pub(super) cell: Cell,
    /// The scene that the view shows.
    pub(super) scene: Scene,
    pub(super) terms: TermSelection,
}

/// The parts of a picture of a scene, and how they are combined.
pub(super) struct Plan {
    pub(super) comparison: Comparison,
    pub(super) parts: Vec<Part>,
}

impl Plan {
    /// The picture of a scene as compared. `terms`, unless all are selected, replace those of each view.
    pub(super) fn new(
        scene: &Scene,
        comparison: Comparison,
        size: [u32; 2],
        terms: TermSelection,
        registry: &Registry,
    ) -> Result<Self, Failure> {
        let cells = cells(&comparison, scene.variants.len(), size).ok_or_else(|| {
            let [w, h] = size;
            Failure::Usage(format!("a picture of {w}x{h} pixels is too small for the views side by side"))
        })?;
        let part = |cell: Cell| {
            let (scene, own) = scene.seen(cell.view, registry)?;
            Some(Part { cell, scene, terms: if terms == TermSelection::All { own } else { terms } })
        };
        // The picture of a blink is that of view A.
        let count = if comparison.layout.is_in_turn() { 1 } else { cells.len() };
        Ok(Self { comparison, parts: cells.into_iter().take(count).filter_map(part).collect() })
    }

    /// The picture of one view.
    pub(super) fn of_view(
        scene: &Scene,
        view: usize,
        [width, height]: [u32; 2],
        terms: TermSelection,
        registry: &Registry,
    ) -> Self {
        let cell = Cell { view, left: 0, top: 0, width, height };
        let (scene, own) = scene.seen(view, registry).unwrap_or_else(|| (scene.clone(), terms));
        let terms = if terms == TermSelection::All { own } else { terms };
        let comparison = Comparison { layout: Layout::Single, ..scene.comparison };
        Self { comparison, parts: vec![Part { cell, scene, terms }] }
    }

    /// True if the picture is made from light instead of display codes.
    pub(super) fn needs_light(&self) -> bool {
        self.is_map() && self.comparison.values == Compared::Light
    }

    /// True if the picture is a map of differences.
    pub(super) fn is_map(&self) -> bool {
        self.comparison.layout.is_map() && self.parts.len() > 1
    }
}
