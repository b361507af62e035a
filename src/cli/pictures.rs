//! Pictures as inputs: PNG files.

use std::{
    io::{Cursor, ErrorKind},
    path::Path,
};

use png::{ColorType, Decoder, DecodingError, Transformations};

use super::render::MAX_SIDE;
use crate::files::Shown as _;
use crate::{compare::Shown, failure::Failure, files, scene::load::MAX_PICTURE_BYTES};

/// True if a path leads to a picture, judging by its content or its name.
pub(super) fn is_picture(path: &Path) -> bool {
    let named = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    named || files::PNG.begins(path)
}

/// Reads a PNG file: its 8-bit colours, unchanged.
pub(super) fn read(path: &Path) -> Result<Shown, Failure> {
    let name = path.shown();
    let bytes = files::read_input(path, MAX_PICTURE_BYTES)
        .map_err(|error| Failure::Invalid(format!("{name} could not be read: {error}")))?;
    decode(&bytes).map_err(|what| Failure::Invalid(format!("{name}: {what}")))
}

fn decode(bytes: &[u8]) -> Result<Shown, String> {
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
    if width.max(height) > MAX_SIDE {
        let size = format!("{width}×{height} pixels");
        return Err(format!("the picture has {size}, but each side must have at most {MAX_SIDE}"));
    }
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
