//! The study: a report, with numbers, plots and pictures, of four phenomena that physically based models
//! reproduce and Blinn–Phong does not, of published orders of models on MERL, of the layers of OpenPBR, and of light with extent.
//!
//! Each chapter has a file: `fresnel`, `furnace` (conservation of energy), `gold` (another light), `lobe`
//! (the shape of the highlight), `merl`, `layers`, `extent`; their measured data are in
//! [`curves::data`](crate::curves::data). This is the results chapter planned in E. James (2022), *Physically
//! Based Shading Models in Real-time Rendering*. Every sentence of a conclusion that depends on a number is
//! selected by that number.

use std::{fmt::Write as _, io, iter, path::Path, sync::Arc};

use glam::DVec3;
use maud::{Markup, PreEscaped, html};
use thiserror::Error;

use crate::{
    curves::draw::{Axis, Line, Mark, Plot, Series},
    files::{self, Before, FolderDraft},
    optics::{Frame, TermSelection, Terms, albedo, colour::Encoding, geometry::direction},
    parameter::Values,
    picture::png,
    reference::{self, Picture},
    reflection::{ModelEntry, Surface},
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
    },
};

mod extent;
pub mod fit;
mod fresnel;
mod furnace;
mod gold;
mod layers;
mod lobe;
mod merl;
mod report;
mod text;

/// The number of steps reported by [`run`].
pub const STEPS: u64 = CHAPTERS.len() as u64 + 1;

/// File name of the report in its folder.
pub const PAGE: &str = "index.html";

/// True if a folder contains a report of this program.
#[must_use]
pub fn is_report(folder: &Path) -> bool {
    /// Size of the beginning that contains the mark.
    const HEAD: u64 = 4096;
    let start = files::read_start(&folder.join(PAGE), HEAD).unwrap_or_default();
    let mark = format!("<meta name=\"generator\" content=\"{}", report::GENERATOR);
    String::from_utf8_lossy(&start).contains(&mark)
}

/// An error of a study: something that it needs is missing.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A model is not registered.
    #[error("there is no reflection model {0}")]
    NoModel(String),
    /// A model lacks a setting, or does not allow its value.
    #[error("{model} does not accept {name} = {value}")]
    NoSetting {
        /// Model.
        model: String,
        /// Parameter.
        name: String,
        /// Value.
        value: String,
    },
    /// Shipped data cannot be read.
    #[error("{0}")]
    Data(String),
    /// A plot or picture could not be drawn.
    #[error("a figure could not be drawn: {0}")]
    Figure(String),
}

/// The extent of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Small pictures and a tenth of the materials, for a quick trial.
    pub quick: bool,
}

/// A table of raw numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// File name, without extension.
    pub name: &'static str,
    /// CSV text.
    pub csv: String,
}

impl Table {
    fn new(name: &'static str, header: &str) -> Self {
        Self { name, csv: format!("{header}\n") }
    }

    /// Adds a row of words and numbers.
    fn row(&mut self, words: &[&str], numbers: &[f64]) {
        let mut cells: Vec<String> = words.iter().map(|w| w.replace(',', ";")).collect();
        // Cells without a finite number stay empty.
        cells.extend(numbers.iter().map(|n| if n.is_finite() { format!("{n:.6}") } else { String::new() }));
        // Writing to a String cannot fail.
        let _ = writeln!(self.csv, "{}", cells.join(","));
    }
}

/// A chapter on a phenomenon or another subject: its section of the report, the finding, and the numbers.
struct Chapter {
    title: &'static str,
    body: Markup,
    /// One sentence for the summary.
    finding: Markup,
    /// True if the numbers confirm the phenomenon.
    shown: bool,
    tables: Vec<Table>,
}

/// The report and its numbers.
#[derive(Clone, Debug)]
pub struct Study {
    /// The report: one self-contained HTML page.
    pub html: String,
    /// The numbers behind it.
    pub tables: Vec<Table>,
}

impl Study {
    /// Writes `index.html` and the tables into a folder, all or nothing. A missing folder is created; other
    /// files in an existing one are kept.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be created or a file cannot be written.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        let tables = self.tables.iter().map(|table| (format!("{}.csv", table.name), table.csv.as_bytes()));
        // The page comes first: it identifies the report, which may then be replaced if a killed process left
        // half of it.
        let all = iter::once((PAGE.to_owned(), self.html.as_bytes())).chain(tables);
        let before = Before::of(folder);
        if !before.is_nothing() {
            return Ok(files::write_all(all.map(|(name, text)| (folder.join(name), text)))?);
        }
        files::in_folder(files::folder_of(folder), || {
            let draft = FolderDraft::new(folder)?;
            for (name, text) in all {
                draft.add(&name, text, false)?;
            }
            Ok(draft.replace_if(&before)?)
        })
    }
}

/// The registry, the settings and the counters shared by chapters.
struct Lab<'a> {
    registry: &'a Registry,
    settings: Settings,
    /// Number of figures so far.
    figures: u32,
    /// Number of tables so far.
    tables: u32,
}

/// A model, and values of its parameters as on the command line: `fresnel=none alpha_x=0.8`. Of two values of one
/// parameter the later one counts.
fn set<'r>(registry: &'r Registry, id: &str, settings: &str) -> Result<(&'r ModelEntry, Values), StudyError> {
    let model = registry.model(id).ok_or_else(|| StudyError::NoModel(id.to_owned()))?;
    let mut values = Values::default();
    for setting in settings.split_whitespace() {
        let (name, value) = setting.split_once('=').unwrap_or((setting, ""));
        let parsed = model.parameter(name).and_then(|p| Some((p.name, p.parse(value).ok()?)));
        let Some((name, value)) = parsed else {
            let [model, name, value] = [id, name, value].map(str::to_owned);
            return Err(StudyError::NoSetting { model, name, value });
        };
        values.set(name, value);
    }
    Ok((model, values))
}

/// The rows of a table, with | between their cells; what is missing at the end of a row is empty.
fn cells<const N: usize>(table: &'static str) -> impl Iterator<Item = [&'static str; N]> {
    table.lines().map(|line| {
        let mut row = line.split('|').map(str::trim);
        std::array::from_fn(|_| row.next().unwrap_or_default())
    })
}

/// The settings of both roughnesses of the microfacet models.
fn alpha(value: f64) -> String {
    format!("alpha_x={value} alpha_y={value}")
}

impl Lab<'_> {
    /// A model with [settings](set), which it must have and allow.
    fn surface(&self, id: &str, settings: &str) -> Result<Arc<dyn Surface>, StudyError> {
        let (model, values) = set(self.registry, id, settings)?;
        Ok(model.instantiate(&values, Encoding::Srgb))
    }

    /// A scene shipped with the program.
    fn scene(&self, text: &str) -> Result<Scene, StudyError> {
        load::from_text(text, "a shipped scene", self.registry, Defaults::Refuse)
            .map(|loaded| loaded.scene)
            .map_err(|e| StudyError::Data(e.to_string()))
    }

    /// The size of pictures in pixels.
    fn size(&self, width: u32, height: u32) -> (u32, u32) {
        if self.settings.quick { (width / 4, height / 4) } else { (width, height) }
    }

    /// The light of a scene with one model for every object.
    fn render(
        &self,
        scene: &Scene,
        model: &str,
        terms: TermSelection,
        (width, height): (u32, u32),
    ) -> Picture {
        let mut scene = scene.clone();
        if !model.is_empty() {
            model.clone_into(&mut scene.reflection_model);
            scene.objects.iter_mut().for_each(|o| o.reflection_model = None);
        }
        let settings = reference::Settings { width, height, samples: 4, terms };
        reference::render(&scene, self.registry, &settings)
    }
}

/// Text with subscripts: in `k_d` the d is a subscript.
fn words(text: &str) -> Markup {
    let mut parts = text.split('_');
    html! {
        (parts.next().unwrap_or_default())
        @for part in parts {
            @let (below, rest) = part.split_at(part.chars().next().map_or(0, char::len_utf8));
            sub { (below) } (rest)
        }
    }
}

/// A table: the first column is words, the rest numbers.
fn grid(head: &[&str], rows: &[Vec<String>]) -> Markup {
    html! {
        div .scroll {
            table {
                thead { tr { @for cell in head { th scope="col" { (words(cell)) } } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for (i, cell) in row.iter().enumerate() {
                                @if i == 0 { th scope="row" { (words(cell)) } } @else { td { (cell) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A picture for the page: eight bits per channel, embedded.
fn image(rgb8: &[u8], (width, height): (u32, u32), alt: &str) -> Result<Markup, StudyError> {
    use base64::Engine as _;
    let mut bytes = Vec::new();
    png::encode(&mut bytes, width, height, rgb8, &png::About::default())
        .map_err(|e| StudyError::Figure(e.to_string()))?;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    Ok(html! {
        img src=(format!("data:image/png;base64,{data}")) width=(width) height=(height) alt=(alt);
    })
}

/// Pictures side by side, at most three in a row, each with a short caption.
fn pictures(all: &[(Markup, impl AsRef<str>)]) -> Markup {
    row(all.len().min(3), all)
}

/// Pictures side by side, with this many in a row.
fn row(columns: usize, all: &[(Markup, impl AsRef<str>)]) -> Markup {
    html! {
        div .pictures style=(format!("--columns:{columns}")) {
            @for (picture, words) in all { div { (picture) p { (words.as_ref()) } } }
        }
    }
}

/// Contents below each other, each under its name.
fn stack(all: &[(impl AsRef<str>, Markup)]) -> Markup {
    html! { @for (name, content) in all { div { p .over { (name.as_ref()) } (content) } } }
}

/// Names below the objects of a picture.
fn labels(names: &[&str]) -> Markup {
    html! { div .labels style=(format!("--columns:{}", names.len())) { @for name in names { span { (name) } } } }
}

/// A series of a plot, with its colour, line and mark.
fn series(
    name: impl Into<String>,
    points: Vec<(f64, f64)>,
    (colour, line, mark): (usize, Line, Mark),
) -> Series {
    Series { name: name.into(), points, bars: Vec::new(), colour, line, mark }
}

/// A plot for the page, this high, with a legend.
fn plot(title: &str, x: Axis, y: Axis, height: u32, series: Vec<Series>) -> Markup {
    svg(&Plot { title: title.to_owned(), x, y, series, size: (720, height), ..Plot::default() })
}

fn svg(plot: &Plot) -> Markup {
    PreEscaped(plot.page_svg())
}

/// The value of a curve at one of its angles.
fn at(curve: &[(f64, f64)], angle: f64) -> f64 {
    curve.iter().find(|p| (p.0 - angle).abs() < 0.1).map_or(f64::NAN, |p| p.1)
}

/// The smallest and the largest value of a curve.
fn ends(curve: &[(f64, f64)]) -> (f64, f64) {
    curve.iter().fold((f64::INFINITY, 0.0), |(least, most), p| (p.1.min(least), p.1.max(most)))
}

/// The directional albedo of a surface by term, for a viewer at an angle from the normal: diffuse and
/// specular together, and the specular one alone, green channel.
fn albedo_at(surface: &dyn Surface, degrees: f64) -> (f64, f64) {
    let specular = |terms: Terms| Terms { specular: terms.specular, ..Terms::default() };
    (directional(surface, degrees, |terms| terms).y, directional(surface, degrees, specular).y)
}

/// The directional albedo of terms of a surface.
fn directional(surface: &dyn Surface, degrees: f64, of: impl Fn(Terms) -> Terms) -> DVec3 {
    let (v, frame) = (direction(degrees, 0.0), &Frame::LOCAL);
    albedo::directional(|l| of(surface.response(l, v, frame)), v, frame)
}

/// A number with a given number of decimals and a true minus sign.
fn fixed(x: f64, digits: usize) -> String {
    format!("{x:.digits$}").replace('-', "−")
}

/// A fraction in per cent.
fn share(x: f64, digits: usize) -> String {
    format!("{}\u{a0}%", fixed(100.0 * x, digits))
}

/// A difference in per cent with its sign.
fn percent(x: f64) -> String {
    let p = 100.0 * x;
    if p.abs() < 0.05 { "±0.0\u{a0}%".to_owned() } else { format!("{p:+.1}\u{a0}%").replace('-', "−") }
}

/// The chapters: the id in the page, the name of the step, and the calculation. The first [`PHENOMENA`] are about
/// phenomena.
const CHAPTERS: [(&str, &str, fn(&mut Lab) -> Result<Chapter, StudyError>); 7] = [
    ("phenomenon-1", "Fresnel effect", fresnel::chapter),
    ("phenomenon-2", "conservation of energy", furnace::chapter),
    ("phenomenon-3", "gold under other lights", gold::chapter),
    ("phenomenon-4", "shape of the specular lobe", lobe::chapter),
    ("merl", "published orders of models", merl::chapter),
    ("layers", "layers of OpenPBR", layers::chapter),
    ("extent", "light with extent", extent::chapter),
];
const PHENOMENA: usize = 4;

/// Runs the study. `tell` is called [`STEPS`] times with the name of the next step.
///
/// # Errors
/// Returns an error if a model, a scene or data of the program does not match the study's expectations.
pub fn run(registry: &Registry, settings: Settings, tell: &dyn Fn(&str)) -> Result<Study, StudyError> {
    let mut lab = Lab { registry, settings, figures: 0, tables: 0 };
    let mut chapters = Vec::new();
    for (id, step, chapter) in CHAPTERS {
        tell(step);
        chapters.push((id, chapter(&mut lab)?));
    }
    tell("writing the report");
    let html = report::page(&mut lab, &chapters)?;
    Ok(Study { html, tables: chapters.into_iter().flat_map(|(_, chapter)| chapter.tables).collect() })
}
