//! The study: a report, with numbers, plots and pictures, of four phenomena that physically based models
//! reproduce and Blinn–Phong does not, of the layers of OpenPBR, and of light with extent.
//!
//! Each chapter has a file: `fresnel`, `furnace` (conservation of energy), `gold` (another light), `lobe`
//! (the shape of the highlight), `layers`, `extent`; their measured data are in
//! [`curves::data`](crate::curves::data). This is the results chapter planned in E. James (2022), *Physically
//! Based Shading Models in Real-time Rendering*. Every sentence of a conclusion that depends on a number is
//! selected by that number.

use std::{fmt::Write as _, fs, io, iter, path::Path, sync::Arc};

use maud::{Markup, PreEscaped, html};
use thiserror::Error;

use crate::{
    curves::draw::Plot,
    files::{self, Before, FolderDraft},
    optics::{Frame, TermSelection, albedo, colour::Encoding, geometry::direction},
    parameter::{Value, Values},
    reference::{self, Picture},
    reflection::Surface,
    registry::Registry,
    render::capture::png,
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
mod report;

/// The number of steps reported by [`run`].
pub const STEPS: u64 = 7;

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
    finding: String,
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
        fs::create_dir_all(files::folder_of(folder))?;
        let draft = FolderDraft::new(folder)?;
        for (name, text) in all {
            draft.add(&name, text, false)?;
        }
        Ok(draft.replace_if(&before)?)
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

/// A setting of a model.
type Setting = (&'static str, Value);

/// A setting that is a choice.
fn choice(name: &'static str, value: &'static str) -> Setting {
    (name, Value::Choice(value.into()))
}

/// A setting that is a number.
fn number(name: &'static str, value: f64) -> Setting {
    (name, Value::Number(value as f32))
}

/// The settings of both roughnesses of the microfacet models.
fn alpha(value: f64) -> [Setting; 2] {
    [number("alpha_x", value), number("alpha_y", value)]
}

impl Lab<'_> {
    /// A model with settings, which it must have and allow.
    fn surface(&self, id: &str, settings: &[Setting]) -> Result<Arc<dyn Surface>, StudyError> {
        let model = self.registry.model(id).ok_or_else(|| StudyError::NoModel(id.to_owned()))?;
        let mut values = Values::default();
        for (name, value) in settings {
            if !model.parameter(name).is_some_and(|p| p.allows(value)) {
                return Err(StudyError::NoSetting {
                    model: id.to_owned(),
                    name: (*name).to_owned(),
                    value: value.to_string(),
                });
            }
            values.set(*name, value.clone());
        }
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

    /// A numbered figure.
    fn figure(&mut self, content: &Markup, caption: &Markup) -> Markup {
        self.figures += 1;
        html! {
            figure {
                (content)
                figcaption { b { "Figure " (self.figures) ". " } (caption) }
            }
        }
    }

    /// A numbered table: the first column is words, the rest numbers.
    fn table(&mut self, caption: &Markup, head: &[&str], rows: &[Vec<String>]) -> Markup {
        self.tables += 1;
        html! {
            figure .table {
                figcaption { b { "Table " (self.tables) ". " } (caption) }
                (grid(head, rows))
            }
        }
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

/// A table without a number.
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
fn pictures(all: &[(Markup, &str)]) -> Markup {
    row(all.len().min(3), all)
}

/// Pictures side by side, with this many in a row.
fn row(columns: usize, all: &[(Markup, &str)]) -> Markup {
    html! {
        div .pictures style=(format!("--columns:{columns}")) {
            @for (picture, words) in all { div { (picture) p { (words) } } }
        }
    }
}

/// A plot for the page.
fn svg(plot: &Plot) -> Markup {
    PreEscaped(plot.page_svg())
}

/// The directional albedo of a surface by term, for a viewer at an angle from the normal: diffuse and
/// specular together, and the specular one alone, green channel.
fn albedo_at(surface: &dyn Surface, degrees: f64) -> (f64, f64) {
    let v = direction(degrees, 0.0);
    let frame = &Frame::LOCAL;
    let all = albedo::directional(|l| surface.response(l, v, frame), v, frame);
    let specular = albedo::directional(
        |l| {
            let terms = surface.response(l, v, frame);
            crate::optics::Terms { specular: terms.specular, ..Default::default() }
        },
        v,
        frame,
    );
    (all.y, specular.y)
}

/// A number with a given number of decimals and a true minus sign.
fn fixed(x: f64, digits: usize) -> String {
    format!("{x:.digits$}").replace('-', "−")
}

/// A difference in per cent with its sign.
fn percent(x: f64) -> String {
    let p = 100.0 * x;
    if p.abs() < 0.05 { "±0.0\u{a0}%".to_owned() } else { format!("{p:+.1}\u{a0}%").replace('-', "−") }
}

/// Runs the study. `tell` is called [`STEPS`] times with the name of the next step.
///
/// # Errors
/// Returns an error if a model, a scene or data of the program does not match the study's expectations.
pub fn run(registry: &Registry, settings: Settings, tell: &dyn Fn(&str)) -> Result<Study, StudyError> {
    let mut lab = Lab { registry, settings, figures: 0, tables: 0 };
    tell("Fresnel effect");
    let fresnel = fresnel::chapter(&mut lab)?;
    tell("conservation of energy");
    let furnace = furnace::chapter(&mut lab)?;
    tell("gold under other lights");
    let gold = gold::chapter(&mut lab)?;
    tell("shape of the specular lobe");
    let lobe = lobe::chapter(&mut lab)?;
    tell("layers of OpenPBR");
    let layers = layers::chapter(&mut lab)?;
    tell("light with extent");
    let extent = extent::chapter(&mut lab)?;
    tell("writing the report");
    let phenomena = [fresnel, furnace, gold, lobe];
    let beyond = [("layers", layers), ("extent", extent)];
    let html = report::page(&phenomena, &beyond, settings);
    let beyond = beyond.into_iter().map(|(_, chapter)| chapter);
    Ok(Study { html, tables: phenomena.into_iter().chain(beyond).flat_map(|c| c.tables).collect() })
}
