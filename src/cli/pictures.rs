//! Pictures as inputs: PNG files, and OpenEXR and Radiance files with linear light.

use std::{
    io::{Cursor, ErrorKind},
    path::Path,
};

use glam::{DVec3, Vec4};
use png::{ColorType, Decoder, DecodingError, Transformations};

use crate::files::Shown as _;
use crate::{
    compare::{Shown, Undrawn},
    failure::Failure,
    files,
    linear::{self, Format, Limits, MAX_PIXELS, Pixels},
    reference::{MAX_SIDE, Picture},
    scene::load::{MAX_FILE_BYTES, MAX_PICTURE_BYTES},
};

/// True if a path leads to a picture, judging by its content or its name.
pub(super) fn is_picture(path: &Path) -> bool {
    let named = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    named || Format::of(path).is_some() || files::PICTURES.iter().any(|picture| picture.begins(path))
}

/// Reads a picture: the 8-bit colours of a PNG file, unchanged, or linear light.
pub(super) fn read(path: &Path) -> Result<Shown, Failure> {
    let name = path.shown();
    let bytes = files::read_input(path, MAX_PICTURE_BYTES)
        .map_err(|error| Failure::Invalid(format!("{name} could not be read: {error}")))?;
    let is_linear = |format: Format| bytes.starts_with(format.signature().begins);
    let shown = match Format::of(path) {
        None if !is_linear(Format::Exr) && !is_linear(Format::Hdr) => decode(&bytes),
        _ => linear::read::<Light>(&bytes, &LIMITS).and_then(Light::shown),
    };
    shown.map_err(|what| Failure::Invalid(format!("{name}: {what}")))
}

/// Limits of linear pictures: a scene may be in the header, and layers beside the picture.
const LIMITS: Limits = Limits {
    head: 2 * MAX_FILE_BYTES as usize,
    channels: 1024,
    size: [MAX_SIDE as usize; 2],
    surroundings: false,
};

/// Fails if a picture has a size that is not read.
fn can_be_compared(width: usize, height: usize) -> Result<(), String> {
    let most = MAX_SIDE as usize;
    let fits = (1..=most).contains(&width) && (1..=most).contains(&height) && width * height <= MAX_PIXELS;
    let rule = format!("each side must have 1 to {most}, and both together at most {MAX_PIXELS}");
    fits.then_some(()).ok_or_else(|| format!("the picture has {width}×{height} pixels, but {rule}"))
}

/// The light of a file.
struct Light {
    picture: Picture,
    scale: DVec3,
    /// True if the file has no coverage.
    is_opaque: bool,
    /// The first pixel that is not light: row, column, and its number.
    odd: Option<(usize, usize, f32)>,
}

impl Pixels for Light {
    fn check(width: usize, height: usize) -> Result<(), String> {
        can_be_compared(width, height)?;
        // A short file may claim any size.
        let size = [width, height].map(|side| side as u32);
        Undrawn::check_light(size, 0).map_err(|error| format!("the picture cannot be read: {error}"))
    }

    fn new(width: usize, height: usize, scale: DVec3) -> Self {
        let pixels = vec![Vec4::ZERO; width * height];
        let picture = Picture { width: width as u32, height: height as u32, pixels };
        Self { picture, scale, is_opaque: false, odd: None }
    }

    fn add(&mut self, column: usize, row: usize, [r, g, b, a]: [f32; 4]) {
        let Picture { width, pixels, .. } = &mut self.picture;
        let Some(pixel) = pixels.get_mut(row * *width as usize + column) else { return };
        let light = (DVec3::new(r.into(), g.into(), b.into()) * self.scale).as_vec3();
        self.is_opaque |= a.is_nan();
        // Other programs may write anything as opacity.
        *pixel = light.extend(if a.is_nan() { 1.0 } else { a.clamp(0.0, 1.0) });
        let odd = light.to_array().into_iter().find(|number| !number.is_finite());
        if let Some(number) = odd.filter(|_| self.odd.is_none_or(|(r, c, _)| (row, column) < (r, c))) {
            self.odd = Some((row, column, number));
        }
    }
}

impl Light {
    fn shown(self) -> Result<Shown, String> {
        match self.odd {
            Some((row, column, number)) => Err(format!(
                "the pixel in column {}, row {} has {number}; light must be finite",
                column + 1,
                row + 1
            )),
            None => Ok(Shown::linear(self.picture, !self.is_opaque)),
        }
    }
}

fn decode(bytes: &[u8]) -> Result<Shown, String> {
    if bytes.is_empty() {
        return Err(files::EMPTY.to_owned());
    }
    if !bytes.starts_with(files::PNG.begins) {
        return Err("this is not a PNG picture, though its name ends in .png".to_owned());
    }
    let broken = |error: DecodingError| match error {
        DecodingError::LimitsExceeded => "the picture is too large".to_owned(),
        error => format!("the picture is damaged: {}; copy it again from its source", damage(&error)),
    };
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::normalize_to_color8());
    decoder.set_ignore_text_chunk(true);
    let mut reader = decoder.read_info().map_err(broken)?;
    let (width, height) = (reader.info().width, reader.info().height);
    // A file of less than a megabyte can claim gigabytes.
    can_be_compared(width as usize, height as usize)?;
    let size = reader.output_buffer_size().ok_or_else(|| "the picture is too large".to_owned())?;
    let mut codes = vec![0; size];
    let frame = reader.next_frame(&mut codes).map_err(broken)?;
    codes.truncate(frame.buffer_size());
    let rgb8 = match frame.color_type {
        ColorType::Rgb => codes,
        ColorType::Rgba => opaque::<4>(&codes)?.flat_map(|[r, g, b, _]| [r, g, b]).collect(),
        ColorType::Grayscale => codes.iter().flat_map(|grey| [*grey; 3]).collect(),
        ColorType::GrayscaleAlpha => opaque::<2>(&codes)?.flat_map(|[grey, _]| [grey; 3]).collect(),
        ColorType::Indexed => return Err("the picture has a palette that could not be applied".to_owned()),
    };
    Shown::of_codes(width, height, rgb8).map_err(|error| error.to_string())
}

/// The damage of a picture in our own words: the decoder's are written for its authors.
fn damage(error: &DecodingError) -> &'static str {
    /// The decoder's messages, which are all that identifies the kind of an error, and ours.
    const KINDS: &[(&str, &str)] = &[
        ("CRC error", "a checksum is wrong, so some of its bytes were changed"),
        ("before IHDR", "its first part is not a header"),
        ("Corrupt deflate stream", "its compressed data cannot be read"),
        ("not have enough data", "it has fewer pixels than its header says"),
        ("IDAT or fdAT chunk is missing", "it has no pixels"),
        ("Unknown filter method", "its pixels have a filter that PNG does not define"),
        ("Unknown compression method", "it has a compression method that PNG does not define"),
        ("palette", "it has no palette for its colours"),
        ("Invalid image dimensions", "its header gives it no pixels"),
        ("Invalid bit depth", "its header is wrong"),
        ("Invalid color", "its header is wrong"),
        ("Unknown interlace method", "its header is wrong"),
    ];
    match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => "it ends too early",
        DecodingError::Format(error) => {
            let said = error.to_string();
            let known = KINDS.iter().find(|(theirs, _)| said.contains(*theirs));
            known.map_or("one of its parts is not valid", |(_, ours)| *ours)
        }
        _ => "it cannot be read",
    }
}

/// The pixels of a picture whose last channel, opacity, must be full.
fn opaque<const N: usize>(codes: &[u8]) -> Result<impl Iterator<Item = [u8; N]>, String> {
    let pixels = codes.as_chunks::<N>().0;
    match pixels.iter().all(|pixel| pixel[N - 1] == 255) {
        true => Ok(pixels.iter().copied()),
        false => Err("the picture is transparent in places; it must be opaque".to_owned()),
    }
}
