//! Sheets and films as files.

use std::{
    io::{self, Write as _},
    path::Path,
};

use super::{
    Axis, MAX_PIXELS, Sweep,
    draw::{Check, Settings, pictures},
    film::gif,
    parts::{Parts, unwritten},
    sheet::{Against, Grid, Page, maps},
};
use crate::{
    caption,
    failure::Failure,
    files::{Output, PNG, Signature},
    picture::png::{self, About},
    progress::Progress,
    reference::MAX_SIDE,
    scene::{Comparison, Scene},
};

/// The usual size of a picture among others on a sheet.
const SMALL: [u32; 2] = [320, 180];
/// The usual size of a picture of a film.
const MIDDLE: [u32; 2] = [640, 360];

/// The format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A sheet, as PNG.
    Sheet,
    /// A film, as animated GIF.
    Gif,
    /// A film, as animated PNG.
    Apng,
}

impl Format {
    /// The format of a file, by its name; `None` if neither a sheet nor a film has such a name.
    #[must_use]
    pub fn of(file: &Path) -> Option<Self> {
        let extension = file.extension()?;
        let all = [("png", Self::Sheet), ("gif", Self::Gif), ("apng", Self::Apng)];
        all.into_iter().find(|(known, _)| extension.eq_ignore_ascii_case(known)).map(|(_, format)| format)
    }

    /// The first bytes of such files.
    #[must_use]
    pub fn signature(self) -> Signature {
        if self == Self::Gif { super::GIF } else { PNG }
    }

    /// True for films, in which the last axis is time.
    #[must_use]
    pub fn is_film(self) -> bool {
        self != Self::Sheet
    }
}

/// The appearance of a sheet or a film.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// The format of the file.
    pub format: Format,
    /// The size of each picture, if not the usual one.
    pub size: Option<[u32; 2]>,
    /// A single axis is broken into rows of so many.
    pub columns: Option<usize>,
    /// The column with which pictures are compared, counted from 0, and the way to compare them.
    pub against: Option<(usize, Comparison)>,
    /// True with labels and a caption.
    pub words: bool,
    /// Number of pictures per second of a film.
    pub rate: u32,
}

/// A sheet or a film, laid out, before it is drawn.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    sweep: &'a Sweep<'a>,
    look: Look,
    settings: Settings,
    page: Page<'a>,
    /// The axis that varies from picture to picture of a film, if the film is to name it.
    time: Option<&'a Axis>,
    /// Number of pictures of each sheet.
    each: usize,
    /// The scene in the file.
    held: &'a Scene,
}

impl<'a> Plan<'a> {
    /// Lays out a sheet or a film; `settings` are those of its pictures, except for their size.
    ///
    /// # Errors
    /// Returns an error if there are too many axes, if there is no such column, or if the result is too large.
    pub fn new(sweep: &'a Sweep<'a>, look: Look, settings: Settings) -> Result<Self, String> {
        let mut axes: Vec<&Axis> = sweep.varied().collect();
        let last = if look.format.is_film() { axes.pop() } else { None };
        let counts: Vec<_> = axes.iter().map(|axis| axis.count()).collect();
        let grid = Grid::of(&counts, look.columns)?;
        let each: usize = counts.iter().product();
        let columns = counts.first().copied().unwrap_or(1);
        match look.against {
            Some(_) if columns < 2 => {
                let rule = "vary one more value, before the one that a film shows in time";
                return Err(format!("there is only one column, with nothing to compare it with; {rule}"));
            }
            Some((column, _)) if column >= columns => {
                return Err(format!("there is no column {}; it must be one from 1 to {columns}", column + 1));
            }
            _ => {}
        }
        let size = look.size.unwrap_or(if each > 1 { SMALL } else { MIDDLE });
        let settings = Settings { size, ..settings };
        let time = last.filter(|time| !time.moves && look.words);
        let page = Page::new(&axes, grid, size, look.against.is_some());
        let page = page.on(sweep.ground());
        let page = if look.words { page } else { page.silent() };
        let page = if time.is_some() { page.dated() } else { page };
        let caption = if look.words { caption::most_rows(page.size()) } else { 0 };
        room(&page, caption, size, sweep.count())?;
        Ok(Self { sweep, look, settings, page, time, each, held: sweep.scene })
    }

    /// Lets the file hold another scene than that of the sweep.
    #[must_use]
    pub fn holding(self, held: &'a Scene) -> Self {
        Self { held, ..self }
    }

    /// Draws the pictures and writes the file, whole or not at all. `source` is the name of the scene's source. Returns the
    /// number of pictures that an earlier run had finished.
    ///
    /// # Errors
    /// Returns an error if the user cancels, if a scene cannot be drawn, or if the file cannot be written. Finished pictures
    /// are then kept beside it, if they took long, for the next run.
    pub fn write(
        &self,
        output: &Path,
        source: &str,
        check: Check,
        progress: &Progress,
    ) -> Result<usize, Failure> {
        let Self { sweep, settings, page, each, .. } = self;
        let parts = Parts::beside(output);
        let drawn = pictures(sweep, settings, Some(&parts), check, progress)?;
        let invalid = |error: crate::compare::Unequal| Failure::Invalid(error.to_string());
        let maps = match &self.look.against {
            Some((column, comparison)) => {
                let against = Against { column: *column, comparison };
                maps(sweep, &drawn.pictures, settings.size, against).map_err(invalid)?
            }
            None => Vec::new(),
        };
        let caption = sweep.caption().resting_on(&drawn.sampled);
        let (light, kept) = (caption::line(&caption::sampled(&drawn.sampled)), drawn.kept);
        let pictures = drawn.labelled(sweep, settings.size);
        let mut whole = page.size();
        let mut sheets = Vec::with_capacity(pictures.len() / each);
        for (i, pictures) in pictures.chunks(*each).enumerate() {
            let maps = maps.get(i * each..(i + 1) * each).unwrap_or_default();
            let mut sheet = page.compose(pictures, maps, self.time.map(|time| &*time.labels[i]));
            if self.look.words {
                (sheet, whole) = caption::draw(&caption, sheet, page.size());
            }
            sheets.push(sheet);
        }
        let about = About::scene(self.held, sweep.registry)
            .with("Description", caption::line(&caption.facts))
            .with("Source", source)
            .with("Renderer", "CPU");
        let about = if light.is_empty() { about } else { about.with("Light", light) };
        self.file(output, whole, &sheets, &about).map_err(|error| match error.kind() {
            io::ErrorKind::BrokenPipe => Failure::Closed,
            _ => unwritten(output, &error),
        })?;
        parts.remove();
        Ok(kept)
    }

    fn file(&self, output: &Path, size: [u32; 2], sheets: &[Vec<u8>], about: &About) -> io::Result<()> {
        let rate = self.look.rate;
        match (self.look.format, sheets) {
            (Format::Sheet, [sheet, ..]) => png::write(output, size[0], size[1], sheet, about),
            (Format::Sheet, []) => Ok(()),
            (Format::Apng, sheets) => png::write_film(output, size, sheets, rate, about),
            (Format::Gif, sheets) => {
                let bytes = gif(sheets, size, rate)?;
                Output::put(output, |to| to.write_all(&bytes))
            }
        }
    }
}

/// Fails if a sheet is too large for programs that show pictures, or all of them for memory.
fn room(page: &Page, caption: u32, [width, height]: [u32; 2], count: usize) -> Result<(), String> {
    let [across, down] = page.size();
    let down = down.saturating_add(caption);
    if across.max(down) > MAX_SIDE {
        let said = format!(
            "the sheet would have {across}×{down} pixels, but each side must have at most {MAX_SIDE}"
        );
        return Err(format!("{said}; make the pictures smaller, or break a single row into columns"));
    }
    let pixels = u64::from(width) * u64::from(height) * count as u64;
    if pixels > MAX_PIXELS {
        let said = format!("{count} pictures of {width}×{height} have {pixels} pixels");
        let rule = format!("those of a sheet or a film must have at most {MAX_PIXELS} together");
        return Err(format!("{said}, but {rule}; make them smaller, or write them into a folder"));
    }
    Ok(())
}
