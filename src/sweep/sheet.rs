//! Sheets: the pictures of a sweep in columns and rows, with labels, and maps of their differences below them.

use rayon::prelude::*;

use super::Sweep;
use crate::{
    caption::{self, Ground, Part as Words},
    compare::{Pair, Shown, Unequal, fitting_amplification, legend_alone, short},
    lettering::Lettering,
    scene::Comparison,
};

/// The smallest letters of labels, pixels.
const SMALLEST: f32 = 10.0;
/// A single row has at most so many pictures, unless the user says otherwise.
const ROW: usize = 8;

/// The pictures of a sheet in columns and rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// True if the pictures of a single axis stand in several rows, each with a label of its own.
    pub wrapped: bool,
}

impl Grid {
    /// The grid for pictures in order, in as many columns as suit their number if not given.
    fn row(count: usize, columns: Option<usize>) -> Self {
        let usual = if count <= ROW { count } else { (count as f64).sqrt().ceil() as usize };
        let columns = columns.unwrap_or(usual).clamp(1, count.max(1));
        Self { columns, rows: count.div_ceil(columns), wrapped: columns < count }
    }

    /// The grid for pictures along one axis, or two: columns and rows. `columns` breaks a single axis into rows.
    ///
    /// # Errors
    /// Returns an error for more axes, or if two axes are to be broken.
    pub fn of(counts: &[usize], columns: Option<usize>) -> Result<Self, String> {
        match (counts, columns) {
            ([], _) => Ok(Self { columns: 1, rows: 1, wrapped: false }),
            ([count], columns) => Ok(Self::row(*count, columns)),
            ([columns, rows], None) => Ok(Self { columns: *columns, rows: *rows, wrapped: false }),
            ([_, _], Some(_)) => {
                Err("the first of two varied values makes the columns; --columns is for one".to_owned())
            }
            (more, _) => Err(format!(
                "a sheet has columns and rows, but {} values vary; write a film, in which the last one varies from \
                 picture to picture, or a folder",
                more.len()
            )),
        }
    }
}

/// The note on the numbers below maps; those of the window are over the pixels that objects cover.
const OVER_ALL: &str = "numbers over all pixels";

/// The reference of the maps below the pictures of a sheet: each shows the difference from the picture of one column.
#[derive(Clone, Copy, Debug)]
pub struct Against<'a> {
    /// The column, counted from 0; of a single axis the picture.
    pub column: usize,
    /// The way in which display codes are compared.
    pub comparison: &'a Comparison,
}

/// The map below a picture: its colours, and its numbers. The map of the column itself is the legend.
type Map = (Vec<u8>, String);

/// The maps of all pictures of a sheet, or of all sheets of a film, which have one scale.
///
/// # Errors
/// Returns an error if pictures cannot be compared.
pub fn maps(
    sweep: &Sweep,
    pictures: &[Vec<u8>],
    size: [u32; 2],
    against: Against,
) -> Result<Vec<Map>, Unequal> {
    let across = sweep.varied().next().map_or(1, super::Axis::count);
    let reference = |i: usize| i / across * across + against.column;
    let shown = |i: usize| Shown::of_codes(size[0], size[1], pictures[i].clone());
    let with = |i: usize| Some([shown(reference(i)).ok()?, shown(i).ok()?]);
    let largest = |i: usize| {
        let Some([a, b]) = with(i) else { return Ok(0.0) };
        let found = Pair::new(&a, &b)?.differences(against.comparison)?.largest;
        Ok(found.map_or(0.0, |largest| largest.difference.abs()))
    };
    let indices = || (0..pictures.len()).into_par_iter();
    let factor = match against.comparison.amplification {
        Some(factor) => factor,
        None => {
            let all = indices().map(largest).collect::<Result<Vec<f32>, Unequal>>()?;
            fitting_amplification(against.comparison.values, all.into_iter().fold(0.0, f32::max))
        }
    };
    let comparison = Comparison { amplification: Some(factor), ..*against.comparison };
    let column = sweep.varied().next().map(|axis| axis.spoken(against.column)).unwrap_or_default();
    let (names, ground) = (["this".to_owned(), column], sweep.ground());
    let one = |i: usize| {
        if i == reference(i) {
            let legend = legend_alone(size, ground.colour, &comparison, factor, &names);
            return Ok((legend, OVER_ALL.to_owned()));
        }
        let Some([a, b]) = with(i) else { return Ok(Map::default()) };
        let pair = Pair::new(&a, &b)?;
        let colours = pair.differences(&comparison)?.colours(&comparison);
        let measured = pair.measure().map(|measured| measured.all);
        let number = |id: &str| measured.as_ref().and_then(|all| all.of(id)).unwrap_or(f64::NAN);
        let [rmse, flip] = ["rmse", "flip"].map(|id| short(number(id) as f32));
        Ok((colours, format!("RMSE {rmse}, FLIP {flip}")))
    };
    indices().map(one).collect()
}

/// The layout of a sheet, and the words in it.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    grid: Grid,
    cell: [u32; 2],
    /// The size of letters, and the height of a line.
    px: f32,
    line: u32,
    gap: u32,
    /// The width of the names of rows.
    left: u32,
    columns: Vec<&'a [Words]>,
    rows: Vec<&'a [Words]>,
    /// True if a line above all gives the time in a film.
    is_dated: bool,
    has_maps: bool,
    /// The ground between pictures, as that of the strip of a caption.
    ground: Ground,
}

impl<'a> Page<'a> {
    /// Lays out a sheet of pictures of this size. `axes` are those of its columns and rows.
    #[must_use]
    pub fn new(axes: &[&'a super::Axis], grid: Grid, cell: [u32; 2], has_maps: bool) -> Self {
        let px = (cell[1] as f32 / 12.0).round().clamp(12.0, 28.0);
        let gap = if grid.columns * grid.rows == 1 { 0 } else { (0.4 * px).round() as u32 };
        let labels = |axis: usize| -> Vec<&'a [Words]> {
            axes.get(axis).map_or_else(Vec::new, |axis| axis.labels.iter().map(|label| &**label).collect())
        };
        let rows = labels(1);
        let widest = rows.iter().map(|label| caption::line_width(label, px)).max();
        let left = widest.map_or(0, |width| width.min(cell[0]) + gap);
        let line = Lettering::Regular.height(px) + (0.3 * px).round() as u32;
        Self {
            grid,
            cell,
            px,
            line,
            gap,
            left,
            columns: labels(0),
            rows,
            is_dated: false,
            has_maps,
            ground: Ground::DARK,
        }
    }

    /// Lays out pictures of this size with a label each, in as many columns as suit their number.
    #[must_use]
    pub fn labelled(labels: &'a [Vec<Words>], cell: [u32; 2]) -> Self {
        let grid = Grid::row(labels.len(), None);
        Self { columns: labels.iter().map(Vec::as_slice).collect(), ..Self::new(&[], grid, cell, false) }
    }

    /// Lays the pictures on another ground.
    #[must_use]
    pub fn on(self, ground: Ground) -> Self {
        Self { ground, ..self }
    }

    /// Leaves all words out.
    #[must_use]
    pub fn silent(mut self) -> Self {
        (self.columns, self.rows, self.left) = (Vec::new(), Vec::new(), 0);
        self
    }

    /// Adds a line above all, for the axis that varies in a film.
    #[must_use]
    pub fn dated(self) -> Self {
        Self { is_dated: true, ..self }
    }

    /// The height of the line above all.
    fn date(&self) -> u32 {
        if self.is_dated { self.line + self.gap } else { 0 }
    }

    /// The height of the line above columns, or in a wrapped row above each picture.
    fn head(&self) -> u32 {
        if self.columns.is_empty() { 0 } else { self.line }
    }

    /// The height of a picture with everything that belongs to it.
    fn block(&self) -> u32 {
        let maps = if self.has_maps { self.gap + self.cell[1] + self.line } else { 0 };
        self.cell[1] + maps + if self.grid.wrapped { self.head() } else { 0 }
    }

    /// The width and height of the sheet, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        let sides = |count: usize, side: u32| {
            let side = u64::from(side) + u64::from(self.gap);
            u32::try_from(count as u64 * side).unwrap_or(u32::MAX)
        };
        let above = self.date() + if self.grid.wrapped { 0 } else { self.head() };
        let width = sides(self.grid.columns, self.cell[0]).saturating_add(self.left + self.gap);
        [width, sides(self.grid.rows, self.block()).saturating_add(above + self.gap)]
    }

    /// The sheet of pictures in order, each with its map if there are maps; `date` is the line above all.
    #[must_use]
    pub fn compose(&self, pictures: &[Vec<u8>], maps: &[Map], date: Option<&[Words]>) -> Vec<u8> {
        let mut paper = Paper::new(self.size(), self.ground.colour);
        let [width, height] = self.cell;
        if let Some(date) = date {
            self.write(&mut paper, date, [self.gap, self.gap], self.size()[0].saturating_sub(2 * self.gap));
        }
        let above = self.date() + if self.grid.wrapped { 0 } else { self.head() };
        let head = if self.grid.wrapped { self.head() } else { 0 };
        for (i, picture) in pictures.iter().enumerate() {
            let (column, row) = (i % self.grid.columns, i / self.grid.columns);
            let x = self.left + self.gap + column as u32 * (width + self.gap);
            let y = above + self.gap + row as u32 * (self.block() + self.gap);
            if let Some(label) = self.columns.get(i).filter(|_| self.grid.wrapped || row == 0) {
                let top = if self.grid.wrapped { y } else { self.date() + self.gap };
                self.write(&mut paper, label, [x, top], width);
            }
            if let Some(label) = self.rows.get(row).filter(|_| column == 0) {
                let middle = y + (height.saturating_sub(self.line)) / 2;
                self.write(&mut paper, label, [self.gap, middle], self.left - self.gap);
            }
            paper.put(picture, self.cell, [x, y + head]);
            if let Some((map, numbers)) = maps.get(i) {
                let y = y + head + height + self.gap;
                paper.put(map, self.cell, [x, y]);
                self.write(&mut paper, &[Words::new(0, numbers.as_str())], [x, y + height], width);
            }
        }
        paper.rgb8
    }

    /// Writes a label in the middle of a line; a longer one is smaller, and then shortened.
    fn write(&self, paper: &mut Paper, label: &[Words], [x, y]: [u32; 2], room: u32) {
        let (mut parts, mut px) = (label.to_vec(), self.px);
        while caption::line_width(&parts, px) > room && px > SMALLEST {
            px -= 1.0;
        }
        if caption::line_width(&parts, px) > room {
            let short = Lettering::Regular.lines(px, &caption::line(label), room, 1);
            parts = short.into_iter().map(|text| Words::new(0, text)).collect();
        }
        let free = room.saturating_sub(caption::line_width(&parts, px));
        let at = [x + free / 2, y].map(|v| v as i32);
        caption::draw_line(&parts, &mut paper.rgb8, paper.size, at, px, self.ground.title);
    }
}

/// A sheet to draw on.
struct Paper {
    size: [u32; 2],
    rgb8: Vec<u8>,
}

impl Paper {
    fn new(size: [u32; 2], ground: [u8; 3]) -> Self {
        Self { size, rgb8: ground.repeat(size[0] as usize * size[1] as usize) }
    }

    /// Puts a picture of some size at a place.
    fn put(&mut self, picture: &[u8], [width, height]: [u32; 2], [left, top]: [u32; 2]) {
        let row = 3 * width as usize;
        if row == 0 || picture.len() != row * height as usize {
            return;
        }
        for (y, line) in (top as usize..).zip(picture.chunks_exact(row)) {
            let start = 3 * (y * self.size[0] as usize + left as usize);
            if let Some(place) = self.rgb8.get_mut(start..start + row) {
                place.copy_from_slice(line);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{registry::Registry, scene::Scene, sweep::Axis};

    fn axes(texts: &[&str]) -> Vec<Axis> {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        texts.iter().map(|text| Axis::vary(text, &scene, &registry).expect("valid")).collect()
    }

    #[test]
    fn one_axis_is_a_row_or_several_and_two_are_columns_and_rows() {
        let of =
            |counts: &[usize], columns| Grid::of(counts, columns).map(|g| (g.columns, g.rows, g.wrapped));
        assert_eq!(of(&[5], None), Ok((5, 1, false)));
        assert_eq!(of(&[20], None), Ok((5, 4, true)));
        assert_eq!(of(&[5], Some(2)), Ok((2, 3, true)));
        assert_eq!(of(&[5, 3], None), Ok((5, 3, false)));
        assert!(of(&[5, 3], Some(2)).is_err());
        assert!(
            of(&[2, 2, 2], None)
                .is_err_and(|e| e.contains("a sheet has columns and rows, but 3 values vary"))
        );
    }

    #[test]
    fn every_picture_is_in_its_place_and_the_words_are_around_it() {
        let axes = axes(&["objects[0].size=1,2,3", "reflection_model=lambert,phong"]);
        let both: Vec<_> = axes.iter().collect();
        let (cell, grid) = ([60, 40], Grid::of(&[3, 2], None).expect("two"));
        let pictures: Vec<Vec<u8>> = (1..=6_u8).map(|i| vec![40 * i; 60 * 40 * 3]).collect();
        let page = Page::new(&both, grid, cell, false);
        let [width, height] = page.size();
        let sheet = page.compose(&pictures, &[], None);
        assert_eq!(sheet.len(), (width * height * 3) as usize);
        let count =
            |sheet: &[u8], value: u8| sheet.as_chunks::<3>().0.iter().filter(|p| **p == [value; 3]).count();
        for i in 1..=6 {
            assert!(count(&sheet, 40 * i) >= 60 * 40, "{i}");
        }
        // Ink outside of the pictures, smooth at its edges.
        let inked = |sheet: &[u8]| {
            let plain = |p: &[u8; 3]| p[0] == Ground::DARK.colour[0] || p[0].is_multiple_of(40);
            sheet.as_chunks::<3>().0.iter().filter(|p| !plain(p)).count()
        };
        assert!(inked(&sheet) > 20);
        let silent = Page::new(&both, grid, cell, false).silent();
        assert!(silent.size()[0] < width && silent.size()[1] < height);
        assert_eq!(inked(&silent.compose(&pictures, &[], None)), 0);
        // On a light ground the ink is dark.
        let light = Page::new(&both, grid, cell, false).on(Ground::LIGHT).compose(&pictures, &[], None);
        let darker = light.as_chunks::<3>().0.iter().filter(|p| p[0] < 40).count();
        assert!(count(&light, 246) > 500 && darker > 10, "{darker}");
        // A film of one picture without words is the picture.
        let one = Page::new(&[], Grid::of(&[], None).expect("one"), cell, false);
        assert_eq!((one.size(), one.compose(&pictures[..1], &[], None) == pictures[0]), (cell, true));
        let dated = one.dated();
        assert!(dated.size()[1] > cell[1]);
        let words = [Words::new(0, "15°")];
        assert!(inked(&dated.compose(&pictures[..1], &[], Some(&words))) > 0);
    }

    #[test]
    fn maps_have_one_scale_and_the_column_itself_has_the_legend() {
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let axis = Axis::vary("objects[0].size=1,2,3", &scene, &registry).expect("valid");
        let sweep = Sweep::new(&scene, 0, vec![axis], &registry).expect("valid");
        let size = [240, 160];
        let pictures: Vec<Vec<u8>> = [100, 110, 90].map(|v: u8| vec![v; 240 * 160 * 3]).into();
        let comparison = Comparison::default();
        let against = Against { column: 0, comparison: &comparison };
        let maps = maps(&sweep, &pictures, size, against).expect("comparable");
        assert_eq!(maps[0].1, OVER_ALL);
        assert!(maps[0].0 != Ground::DARK.colour.repeat(240 * 160), "there is a legend");
        // The same difference has the same colour.
        assert!(maps[1].0 == maps[2].0 && maps[1].1.starts_with("RMSE 0.0392, FLIP "), "{:?}", maps[1].1);
        let page = Page::new(&[&sweep.axes[0]], Grid::of(&[3], None).expect("one"), size, true);
        assert_eq!(
            page.compose(&pictures, &maps, None).len(),
            (page.size()[0] * page.size()[1] * 3) as usize
        );
    }
}
