//! The numbers of the files of lights, which share one uniform: pictures of environments are reduced to the room that
//! the other files leave.

use std::sync::Arc;

use crate::{
    light::panorama::{FORMAT, Panorama},
    parameter::Table,
};

/// Maximum size of a uniform guaranteed by WebGPU, in bytes.
pub(super) const UNIFORM_BYTES: usize = 65_536;

/// Pictures are not reduced to fewer columns: with less, an environment is hardly one.
const LEAST_COLUMNS: usize = 16;

/// Different files, in the order of their first use.
#[derive(Default)]
pub(super) struct LampFiles(Vec<Table>);

/// The numbers of files, one file after the other.
#[derive(Debug, Default)]
pub(super) struct Fitted {
    pub(super) numbers: Vec<f32>,
    /// The index of the first number of each file.
    pub(super) begins: Vec<u32>,
    /// How many of the numbers are those of pictures.
    pub(super) pictures: usize,
    /// A sentence for each picture that was reduced.
    pub(super) notes: Vec<String>,
}

impl LampFiles {
    /// The index of a file, which is added if it is new.
    pub(super) fn index(&mut self, table: Table) -> usize {
        self.0.iter().position(|known| Arc::ptr_eq(&known.numbers, &table.numbers)).unwrap_or_else(|| {
            self.0.push(table);
            self.0.len() - 1
        })
    }

    /// The numbers, with pictures as large as fits into a uniform beside the other files; all with the same limit.
    pub(super) fn fitted(&self) -> Fitted {
        let pictures: Vec<_> = self.0.iter().map(picture).collect();
        let most = most_columns(&self.0, &pictures);
        let mut fitted = Fitted::default();
        for (table, picture) in self.0.iter().zip(pictures) {
            let reduced = picture.and_then(|picture| {
                let [columns, rows] = picture.size();
                let numbers = picture.reduced(most)?;
                let name = table.file.as_ref().map_or("", |file| file.name());
                fitted.notes.push(format!(
                    "The picture of the environment, {name}, is reduced from {columns}×{rows} to {most}×{} pixels: \
                     reflections are less sharp.",
                    most / 2
                ));
                Some(numbers)
            });
            let numbers = reduced.as_deref().unwrap_or(&table.numbers);
            fitted.begins.push(fitted.numbers.len() as u32);
            fitted.numbers.extend_from_slice(numbers);
            fitted.pictures += if picture.is_some() { numbers.len() } else { 0 };
        }
        fitted
    }
}

fn picture(table: &Table) -> Option<Panorama<'_>> {
    let is_picture = table.file.as_ref().is_some_and(|file| file.is_in(&FORMAT));
    is_picture.then(|| Panorama::new(&table.numbers))?
}

/// The largest number of columns, an even one, with which all pictures fit beside the other files.
fn most_columns(files: &[Table], pictures: &[Option<Panorama>]) -> usize {
    let room = UNIFORM_BYTES / size_of::<f32>();
    let taken = |most: usize| -> usize {
        let one = |(table, picture): (&Table, &Option<Panorama>)| match picture {
            Some(picture) if picture.size()[0] > most => Panorama::count(most),
            _ => table.numbers.len(),
        };
        files.iter().zip(pictures).map(one).sum()
    };
    let widest = pictures.iter().flatten().map(|picture| picture.size()[0]).max().unwrap_or(0);
    let mut most = widest.next_multiple_of(2);
    while most > LEAST_COLUMNS && taken(most) > room {
        most -= 2;
    }
    most
}

/// The reason why the numbers of files, so many of them of pictures, do not fit into a uniform; `None` if they do.
pub(super) fn excess(numbers: usize, pictures: usize) -> Option<String> {
    let bytes = |count: usize| count * size_of::<f32>();
    if bytes(numbers) <= UNIFORM_BYTES {
        return None;
    }
    let (others, pictures) = (bytes(numbers - pictures), bytes(pictures));
    let (what, remedy) = if pictures == 0 {
        (format!("the photometric files of the lamps take {others} bytes"), "files with fewer angles")
    } else if others == 0 {
        (format!("the pictures of environments take {pictures} bytes, reduced"), "fewer pictures")
    } else {
        let what = format!(
            "the photometric files of the lamps take {others} bytes, and the pictures of environments, reduced, {pictures}"
        );
        (what, "photometric files with fewer angles, or fewer pictures")
    };
    Some(format!("{what}, but a uniform holds {UNIFORM_BYTES}; use {remedy}"))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{
        light::{ies, panorama},
        parameter::{FileFormat, NamedFile},
    };

    fn table(format: &'static FileFormat, name: &str, numbers: Vec<f32>) -> Table {
        Table { file: Some(NamedFile::named(name, Path::new(""), format)), numbers: numbers.into() }
    }

    /// A sky above a dark ground, with a lamp in one pixel.
    fn pixel(column: usize, row: usize) -> [f32; 3] {
        match (column, row) {
            (700, 100) => [5000.0; 3],
            (_, row) if row < 256 => [0.2, 0.4, 0.8],
            _ => [0.05, 0.04, 0.03],
        }
    }

    fn files(others: &[usize]) -> LampFiles {
        let mut files = LampFiles::default();
        files.index(table(&panorama::FORMAT, "sky.hdr", panorama::of_pixels(1024, pixel)));
        for count in others {
            files.index(table(&ies::FORMAT, "lamp.ies", vec![1.0; *count]));
        }
        files
    }

    #[test]
    fn a_large_picture_is_reduced_to_the_room_and_keeps_its_light() {
        let files = files(&[]);
        let whole = Panorama::new(&files.0[0].numbers).expect("a picture");
        let fitted = files.fitted();
        let reduced = Panorama::new(&fitted.numbers).expect("a picture");
        assert_eq!((whole.size(), reduced.size()), ([1024, 512], [90, 45]));
        assert!(Panorama::count(92) * 4 > UNIFORM_BYTES && fitted.numbers.len() * 4 <= UNIFORM_BYTES);
        assert_eq!(fitted.numbers.len(), Panorama::count(90));
        assert_eq!(excess(fitted.numbers.len(), fitted.pictures), None);
        // The third number is the integral of the luminance over all directions.
        let [before, after] = [files.0[0].numbers[2], fitted.numbers[2]];
        assert!((after / before - 1.0).abs() < 1e-5, "{before} {after}");
        let [note] = &fitted.notes[..] else { panic!("{:?}", fitted.notes) };
        assert!(note.contains("sky.hdr, is reduced from 1024×512 to 90×45 pixels"), "{note}");
    }

    #[test]
    fn pictures_leave_the_room_that_other_files_take() {
        let fitted = files(&[8000]).fitted();
        let first = Panorama::new(&fitted.numbers[..fitted.begins[1] as usize]).expect("a picture");
        assert_eq!(first.size(), [64, 32]);
        assert!(4 * fitted.numbers.len() <= UNIFORM_BYTES);
        assert_eq!(fitted.numbers[fitted.begins[1] as usize..], vec![1.0; 8000]);
    }

    #[test]
    fn what_does_not_fit_even_so_is_refused_with_what_takes_the_room() {
        let fitted = files(&[16_000]).fitted();
        let why = excess(fitted.numbers.len(), fitted.pictures).expect("too much");
        let pictures = 4 * Panorama::count(LEAST_COLUMNS);
        assert!(why.contains("photometric files of the lamps take 64000 bytes"), "{why}");
        assert!(why.contains(&format!("pictures of environments, reduced, {pictures},")), "{why}");
        let photometric = excess(20_000, 0).expect("too much");
        assert!(photometric.contains("fewer angles") && !photometric.contains("picture"), "{photometric}");
        let pictures = excess(20_000, 20_000).expect("too much");
        assert!(pictures.contains("fewer pictures") && !pictures.contains("photometric"), "{pictures}");
    }

    #[test]
    fn a_picture_that_fits_stays() {
        let mut files = LampFiles::default();
        let numbers = panorama::of_pixels(32, pixel);
        let picture = table(&panorama::FORMAT, "small.hdr", numbers.clone());
        assert_eq!([files.index(picture.clone()), files.index(picture)], [0, 0]);
        let fitted = files.fitted();
        assert_eq!((fitted.numbers, fitted.notes.len()), (numbers, 0));
    }
}
