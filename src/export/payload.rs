//! A scene inside a program: the data appended to an exported program, and how the program finds it.
//!
//! Every program made with this library contains a `Place`: 40 bytes that begin with a name. In a program as
//! built they end with zeros. `pack` appends the data to a copy of the program and records in that place its
//! offset, its length and a checksum. The program therefore knows that it carries data without reading its
//! file, and notices when the end of the file was cut off or changed. Operating systems load only the parts
//! listed at the beginning of the file, and ignore what follows.

use std::{
    hint::black_box,
    path::{Path, PathBuf},
};

use memchr::memmem;
use serde::{Deserialize, Serialize};

use crate::files::{self, FileError};
use crate::{files::Shown as _, platform::fs};

/// Length of the name at the start of the place.
const NAME: usize = 16;
/// Size of the place: name, offset, length and checksum.
const SIZE: usize = NAME + 3 * 8;
/// The place in this program. Read only by [`own`], lest the compiler assume its content.
#[used]
static OWN: [u8; SIZE] = *b"LCM scene place:\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";

/// Maximum length of the data: files are smaller, each within the limit of its format.
const LONGEST: u64 = 1 << 32;

/// The contents of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    /// Offset of the data in the file: the length of the program alone.
    begin: u64,
    /// Length of the data.
    length: u64,
    /// [`checksum`] of the data.
    checksum: u64,
}

/// A scene and the files that it needs, as carried inside a program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Payload {
    /// The scene, as a scene file. It refers to other files by their paths in `files`.
    pub scene: Vec<u8>,
    /// Name and window.
    pub about: About,
    /// The files that it needs, by path: `shaders/…`, `models/…`, and those named in the scene.
    pub files: Vec<(String, Vec<u8>)>,
    /// Identifies the payload.
    pub checksum: u64,
}

/// The name of a scene inside a program, and the size of its window.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// Name of the scene's file without extension.
    pub stem: String,
    /// Size of the window in pixels, unless it is the default.
    pub size: Option<[u32; 2]>,
}

/// The reason why a program cannot provide its scene, or receive one.
#[derive(Debug, thiserror::Error)]
pub enum PayloadError {
    /// The end of the program was cut off or changed.
    #[error("the scene inside this program is damaged: {0}; export the program again")]
    Damaged(&'static str),
    /// The file of the program cannot be read.
    #[error("the file of this program could not be read: {0}")]
    Unreadable(#[from] FileError),
    /// The files of the payload cannot be unpacked.
    #[error("the files inside this program could not be unpacked to {}: {error}", .within.shown())]
    Packed {
        /// The folder for the files of all programs.
        within: PathBuf,
        /// The reason.
        error: FileError,
    },
    /// An unpacked file is missing.
    #[error("{} has no {file}, which this program unpacked there; {}", .folder.shown(), unpacking(.folder))]
    Incomplete {
        /// The folder of this program's files.
        folder: PathBuf,
        /// The path of the file in it.
        file: String,
    },
    /// The program contains no place for a scene.
    #[error("this program's file was modified, so no scene can be added to it")]
    NoPlace,
}

/// The remedy for damaged files in a program's folder.
#[must_use]
pub fn unpacking(folder: &Path) -> String {
    format!("delete the folder {} to have it unpacked again", folder.shown())
}

/// Path of the scene file within the payload.
const SCENE: &str = "scene.json";
/// Path of [`About`] within the payload.
const ABOUT: &str = "about.json";

/// The bytes of this program's own place, as in the file.
fn own() -> [u8; SIZE] {
    *black_box(&OWN)
}

impl Place {
    /// The decoded place; `None` in a program as built.
    fn of(bytes: &[u8; SIZE]) -> Option<Self> {
        let (_, numbers) = bytes.split_at(NAME);
        let mut numbers = numbers.as_chunks::<8>().0.iter().map(|bytes| u64::from_le_bytes(*bytes));
        let (begin, length, checksum) = (numbers.next()?, numbers.next()?, numbers.next()?);
        (begin > 0).then_some(Self { begin, length, checksum })
    }

    fn bytes(self) -> [u8; SIZE - NAME] {
        let mut bytes = [0; SIZE - NAME];
        let numbers = [self.begin, self.length, self.checksum];
        for (out, number) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(numbers) {
            *out = number.to_le_bytes();
        }
        bytes
    }
}

/// FNV-1a, 64 bits: G. Fowler, L. C. Noll, K.-P. Vo. Detects accidents, not malice.
fn checksum(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The payload of this program, if it carries one.
///
/// # Errors
/// Returns an error if the payload is damaged, or the program's file cannot be read.
pub fn inside() -> Result<Option<Payload>, PayloadError> {
    let Some(place) = Place::of(&own()) else { return Ok(None) };
    let Some(program) = files::program() else { return Err(PayloadError::Damaged("its file is unknown")) };
    if place.length > LONGEST {
        return Err(PayloadError::Damaged("its length is wrong"));
    }
    let content = files::read_range(&program, place.begin, place.length)?;
    read(place, &content).map(Some)
}

fn read(place: Place, content: &[u8]) -> Result<Payload, PayloadError> {
    if (content.len() as u64) < place.length {
        return Err(PayloadError::Damaged("its end is missing"));
    }
    if checksum(content) != place.checksum {
        return Err(PayloadError::Damaged("its content was changed"));
    }
    let mut payload = Payload { checksum: place.checksum, ..Payload::default() };
    for (path, bytes) in unpack(content).ok_or(PayloadError::Damaged("its files are cut off"))? {
        match path.as_str() {
            SCENE => payload.scene = bytes,
            ABOUT => {
                let about = serde_json::from_slice(&bytes);
                payload.about = about.map_err(|_| PayloadError::Damaged("it has no name"))?;
            }
            _ => payload.files.push((path, bytes)),
        }
    }
    Ok(payload)
}

/// The bytes of a program with a payload: this program, without any payload that it carries, and the new one.
///
/// # Errors
/// Returns an error if the file of this program cannot be read, or was changed beyond recognition.
pub fn program_with(payload: &Payload) -> Result<Vec<u8>, PayloadError> {
    let program = files::program().ok_or(PayloadError::NoPlace)?;
    let alone = Place::of(&own()).map_or(LONGEST, |place| place.begin);
    let mut bytes = files::read_range(&program, 0, alone)?;
    pack(&mut bytes, &own(), payload)?;
    Ok(bytes)
}

/// Appends a payload to a program with this place.
fn pack(program: &mut Vec<u8>, own: &[u8; SIZE], payload: &Payload) -> Result<(), PayloadError> {
    let name = &own[..NAME];
    let mut found = memmem::find_iter(program, name);
    let (Some(at), None) = (found.next(), found.next()) else { return Err(PayloadError::NoPlace) };
    let about = serde_json::to_vec(&payload.about).unwrap_or_default();
    let own = [(SCENE, payload.scene.as_slice()), (ABOUT, about.as_slice())];
    let files = payload.files.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice()));
    let mut content = Vec::new();
    for (path, bytes) in own.into_iter().chain(files) {
        for part in [path.as_bytes(), bytes] {
            content.extend((part.len() as u64).to_le_bytes());
            content.extend(part);
        }
    }
    let place =
        Place { begin: program.len() as u64, length: content.len() as u64, checksum: checksum(&content) };
    let numbers = program.get_mut(at + NAME..at + SIZE).ok_or(PayloadError::NoPlace)?;
    numbers.copy_from_slice(&place.bytes());
    program.extend(content);
    Ok(())
}

/// The files of a payload; `None` if their lengths are wrong.
fn unpack(mut content: &[u8]) -> Option<Vec<(String, Vec<u8>)>> {
    let next = |content: &mut &[u8]| {
        let (length, rest) = content.split_first_chunk::<8>()?;
        let (part, rest) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
        *content = rest;
        Some(part.to_vec())
    };
    let mut files = Vec::new();
    while !content.is_empty() {
        let path = String::from_utf8(next(&mut content)?).ok()?;
        files.push((path, next(&mut content)?));
    }
    Some(files)
}

impl Payload {
    /// The folder with the payload's files, created on the first call; `None` if it has no files. Changes
    /// made there by the user are kept.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be created, or one of the files is missing from it.
    pub fn folder(&self, within: &Path) -> Result<Option<PathBuf>, PayloadError> {
        if self.files.is_empty() {
            return Ok(None);
        }
        let folder = within.join(format!("{:016x}", self.checksum));
        if fs::is_dir(&folder) {
            return match self.files.iter().find(|(path, _)| !fs::is_file(folder.join(path))) {
                None => Ok(Some(folder)),
                Some((file, _)) => Err(PayloadError::Incomplete { folder, file: file.clone() }),
            };
        }
        let unpacked = files::in_folder(within, || {
            let draft = files::FolderDraft::new(&folder)?;
            for (path, bytes) in &self.files {
                draft.add(path, bytes, false)?;
            }
            Ok::<_, FileError>(draft.replace()?)
        });
        unpacked.map_err(|error| PayloadError::Packed { within: within.to_owned(), error })?;
        Ok(Some(folder))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn payload() -> Payload {
        Payload {
            scene: b"{}".to_vec(),
            about: About { stem: "room".to_owned(), size: Some([640, 480]) },
            files: vec![("shaders/a.wgsl".to_owned(), b"// a".to_vec()), ("empty".to_owned(), Vec::new())],
            checksum: 0,
        }
    }

    fn place_in(program: &[u8]) -> Place {
        let at = memmem::find(program, &own()[..NAME]).expect("it has a place");
        let bytes = program[at..at + SIZE].try_into().expect("as long");
        Place::of(&bytes).expect("it carries something")
    }

    fn packed() -> Vec<u8> {
        let mut program = [b"program", &own()[..], b"more of it"].concat();
        pack(&mut program, &own(), &payload()).expect("it has a place");
        program
    }

    #[test]
    fn what_is_packed_is_read_again() {
        let program = packed();
        let place = place_in(&program);
        assert_eq!(place.begin, (7 + SIZE + 10) as u64);
        let read = read(place, &program[place.begin as usize..]).expect("whole");
        assert_eq!(Payload { checksum: 0, ..read }, payload());
    }

    #[test]
    fn every_damage_is_noticed() {
        let program = packed();
        let place = place_in(&program);
        let content = &program[place.begin as usize..];
        for length in 0..content.len() {
            assert!(matches!(
                read(place, &content[..length]),
                Err(PayloadError::Damaged("its end is missing"))
            ));
        }
        for i in 0..content.len() {
            let mut content = content.to_vec();
            content[i] ^= 1;
            let changed = PayloadError::Damaged("its content was changed");
            assert_eq!(read(place, &content).expect_err("changed").to_string(), changed.to_string());
            // Even with a matching checksum it does not panic.
            let _ = read(Place { checksum: checksum(&content), ..place }, &content);
        }
    }

    #[test]
    fn a_program_needs_one_place() {
        for program in [b"program".to_vec(), [own(), own()].concat(), own()[..SIZE - 1].to_vec()] {
            let packed = pack(&mut program.clone(), &own(), &payload());
            assert!(matches!(packed, Err(PayloadError::NoPlace)));
        }
    }

    #[test]
    fn the_checksum_is_that_of_its_authors() {
        assert_eq!(checksum(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(checksum(b"foobar"), 0x8594_4171_f739_67e8);
    }
}
