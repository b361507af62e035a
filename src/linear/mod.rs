//! Pictures of linear light in files: Radiance's and OpenEXR's formats, read within limits and written from
//! [`Channels`].

use std::{borrow::Cow, io, path::Path};

use glam::Vec4;

use crate::files::{self, Signature};

mod exr;
mod hdr;
mod read;

pub use hdr::{SCENE_BEGINS, SCENE_ENDS};
pub use read::{Limits, Pixels, read};

/// Red, green, blue and white of Rec. 709 as OpenEXR has them by default, x and y.
const REC_709: [[f32; 2]; 4] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];

/// Those of Radiance by default: G. Ward, *Radiance File Formats*. They count as the same.
const RADIANCE_USUAL: [[f32; 2]; 4] = [[0.64, 0.33], [0.29, 0.60], [0.15, 0.06], [0.3333, 0.3333]];

/// Maximum number of pixels of a picture that is written or compared.
pub const MAX_PIXELS: usize = 1 << 26;

/// A format of linear pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// OpenEXR: 32-bit floats, as many channels as there are.
    Exr,
    /// Radiance: red, green and blue with 8 bits each and a common exponent.
    Hdr,
}

impl Format {
    /// The format of a file by its extension.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?;
        [Self::Exr, Self::Hdr].into_iter().find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// The extension of its files.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Hdr => "hdr",
        }
    }

    /// The first bytes of its files.
    #[must_use]
    pub const fn signature(self) -> Signature {
        match self {
            Self::Exr => files::EXR,
            Self::Hdr => files::HDR,
        }
    }

    /// The number of bytes of a file before compression, without its header.
    #[must_use]
    pub fn bytes(self, pixels: usize, channels: usize) -> u64 {
        let each = match self {
            Self::Exr => 4 * channels,
            Self::Hdr => 4,
        };
        pixels as u64 * each as u64
    }
}

/// The channels of a picture: a number for each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Channels {
    width: u32,
    height: u32,
    list: Vec<(String, Vec<f32>)>,
}

impl Channels {
    /// A picture without channels.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, list: Vec::new() }
    }

    /// Adds a layer, which is a name before those of channels: `depth` before `Z` is `depth.Z`; without one, the
    /// names are plain. A pixel's first number is that of the first channel, and so on.
    pub fn add(&mut self, layer: &str, names: &[&str], pixels: &[Vec4]) {
        for (i, name) in names.iter().enumerate().take(4) {
            let name = if layer.is_empty() { (*name).to_owned() } else { format!("{layer}.{name}") };
            self.list.push((name, pixels.iter().map(|pixel| pixel[i]).collect()));
        }
    }

    /// Subtracts the numbers of another channel from those of one, if there are both.
    pub fn subtract(&mut self, name: &str, other: &str) {
        let Some(other) = self.get(other).map(<[f32]>::to_vec) else { return };
        if let Some((_, numbers)) = self.list.iter_mut().find(|(known, _)| known == name) {
            numbers.iter_mut().zip(other).for_each(|(number, other)| *number -= other);
        }
    }

    /// The numbers of the channel with a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&[f32]> {
        self.list.iter().find(|(known, _)| known == name).map(|(_, numbers)| &**numbers)
    }

    /// The names, in the order in which the channels were added.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|(name, _)| name.as_str())
    }

    /// The picture as the bytes of a file. A Radiance file holds the channels R, G and B alone.
    ///
    /// # Errors
    /// Returns an error if there are no pixels, if a channel has another number of them, if two channels have one
    /// name, or if the format cannot hold the picture.
    pub fn encode(&self, format: Format, notes: &Notes) -> io::Result<Vec<u8>> {
        let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidInput, what);
        let pixels = self.width as usize * self.height as usize;
        if pixels == 0 || pixels > MAX_PIXELS {
            return Err(wrong(format!("it has {pixels} pixels, but must have 1 to {MAX_PIXELS}")));
        }
        let mut names: Vec<_> = self.names().collect();
        names.sort_unstable();
        if let Some(twice) = names.windows(2).find(|two| two[0] == two[1]) {
            return Err(wrong(format!("two channels are called {}", twice[0])));
        }
        if self.list.is_empty() {
            return Err(wrong("it has no channels".to_owned()));
        }
        if let Some((name, numbers)) = self.list.iter().find(|(_, numbers)| numbers.len() != pixels) {
            return Err(wrong(format!("{name} has {} numbers for {pixels} pixels", numbers.len())));
        }
        match format {
            Format::Exr => exr::encode(self, notes),
            Format::Hdr => hdr::encode(self, notes),
        }
    }
}

/// The metadata of a picture.
#[derive(Clone, Debug, Default)]
pub struct Notes<'a> {
    /// The program, with its version.
    pub software: Cow<'a, str>,
    /// Further texts, a line each.
    pub comments: Cow<'a, str>,
    /// The name of the attribute with the scene, and the scene as JSON.
    pub scene: Option<(&'a str, &'a str)>,
}
