//! PNG files: pictures that say what they show.

use std::{
    fs,
    io::{self, BufWriter, Write},
    path::Path,
};

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, SrgbRenderingIntent};

use crate::files::Output;

/// Writes an sRGB picture (red, green, blue, row by row from the top) with `text`: pairs of keyword
/// and value, which picture viewers show; keywords such as `Software`, `Title` and `Description` are
/// those of the PNG specification.
///
/// Missing folders are created. A file appears complete or not at all; standard output, devices and pipes are
/// written straight, as [`Output`] says.
///
/// # Errors
/// If `rgb8` is not `width · height · 3` bytes, a keyword is empty or longer than 79 characters, or
/// the file cannot be written.
pub fn write(path: &Path, width: u32, height: u32, rgb8: &[u8], text: &[(&str, &str)]) -> io::Result<()> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder)?;
    }
    let mut output = Output::open(path)?;
    encode(BufWriter::new(&mut output), width, height, rgb8, text)?;
    Ok(output.finish()?)
}

/// The picture as the bytes of a PNG file.
///
/// # Errors
/// As [`write`](fn@write), but for the file system.
pub fn encode(
    mut to: impl Write,
    width: u32,
    height: u32,
    rgb8: &[u8],
    text: &[(&str, &str)],
) -> io::Result<()> {
    let mut encoder = Encoder::new(&mut to, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fast);
    for (keyword, value) in text {
        let (keyword, value) = ((*keyword).to_owned(), (*value).to_owned());
        // Latin-1 fits the plain chunk that every reader knows; names like "Blinn–Phong" do not.
        if value.chars().all(|c| u32::from(c) < 256) {
            encoder.add_text_chunk(keyword, value).map_err(plain)?;
        } else {
            encoder.add_itxt_chunk(keyword, value).map_err(plain)?;
        }
    }
    let mut writer = encoder.write_header().map_err(plain)?;
    writer.write_image_data(rgb8).map_err(plain)?;
    writer.finish().map_err(plain)?;
    to.flush()
}

/// Keeps the kind of errors of the system.
fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use super::*;

    fn gradient() -> Vec<u8> {
        (0..16 * 8 * 3).map(|i| (i % 251) as u8).collect()
    }

    #[test]
    fn what_is_written_can_be_read_back_with_its_text() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("new/folder/picture.png");
        let text = [("Software", "Lights, Camera, Models!"), ("Model", "Blinn–Phong")];
        write(&path, 16, 8, &gradient(), &text).expect("can be written");
        let decoder = png::Decoder::new(io::BufReader::new(File::open(&path).expect("exists")));
        let mut reader = decoder.read_info().expect("is a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("fits")];
        reader.next_frame(&mut bytes).expect("has a picture");
        assert_eq!(bytes, gradient());
        let info = reader.info();
        assert_eq!((info.width, info.height), (16, 8));
        assert_eq!(info.uncompressed_latin1_text[0].text, text[0].1);
        assert_eq!(info.utf8_text[0].get_text().expect("is text"), text[1].1);
        // Nothing is left beside it.
        assert_eq!(fs::read_dir(path.parent().expect("has one")).expect("readable").count(), 1);
    }

    #[test]
    fn a_wrong_number_of_bytes_is_an_error_and_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!(write(&folder.path().join("p.png"), 16, 9, &gradient(), &[]).is_err());
        assert!(write(&folder.path().join("p.png"), 0, 0, &[], &[]).is_err());
        assert!(write(folder.path(), 16, 8, &gradient(), &[]).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
    }

    #[test]
    fn an_existing_file_is_replaced() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("p.png");
        fs::write(&path, "old").expect("can be written");
        write(&path, 16, 8, &gradient(), &[]).expect("can be written");
        assert!(fs::read(&path).expect("exists").starts_with(b"\x89PNG"));
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_not_replaced() {
        write(Path::new("/dev/null"), 16, 8, &gradient(), &[]).expect("takes everything");
        assert!(!Path::new("/dev/null").is_file());
    }
}
