//! PNG files: pictures with metadata.

use std::{
    io::{self, BufWriter, Cursor, Write},
    path::Path,
};

use png::{
    BitDepth, ColorType, Compression, Decoder, Encoder, EncodingError, SrgbRenderingIntent,
    text_metadata::ITXtChunk,
};

use crate::{
    files::{self, Output},
    registry::Registry,
    scene::{Scene, formats::SCENE_KEYWORD, load::MAX_PICTURE_BYTES, save::to_json},
};

/// The metadata of a picture: texts for picture viewers, and the scene, which the program can open again.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    pub(super) texts: Vec<(&'static str, String)>,
    pub(super) scene: Option<String>,
}

impl About {
    /// The name and the version of the program.
    #[must_use]
    pub fn program() -> Self {
        let program = concat!("Lights, Camera, Models! ", env!("CARGO_PKG_VERSION"));
        Self::default().with("Software", program)
    }

    /// The program, and the scene shown in the picture.
    #[must_use]
    pub fn scene(scene: &Scene, registry: &Registry) -> Self {
        let shown = Self::program()
            .with("Title", scene.name.as_deref().unwrap_or_default())
            .with("Reflection model", &*scene.reflection_model)
            .with("Shading model", &*scene.shading_model);
        Self { scene: Some(to_json(scene, None, registry)), ..shown }
    }

    /// Adds a text. Keywords such as `Title` and `Description` are those of the PNG specification.
    #[must_use]
    pub fn with(mut self, keyword: &'static str, text: impl Into<String>) -> Self {
        self.texts.push((keyword, text.into()));
        self
    }

    /// Removes the scene, for pictures that must not reveal it.
    #[must_use]
    pub fn without_scene(self) -> Self {
        Self { scene: None, ..self }
    }
}

/// Writes an sRGB picture (red, green, blue, row by row from the top) with its metadata.
///
/// A file appears complete or not at all, in a folder that is created if it is missing; standard output, devices and
/// pipes are written to directly, see [`Output::put`].
///
/// # Errors
/// Returns an error if `rgb8` is not `width · height · 3` bytes, if a keyword is empty or longer than 79
/// characters, or if the file cannot be written.
pub fn write(path: &Path, width: u32, height: u32, rgb8: &[u8], about: &About) -> io::Result<()> {
    Output::put(path, |to| encode(BufWriter::new(to), width, height, rgb8, about))
}

/// Writes a film that goes on for ever, as an animated PNG file: pictures of one size, so many per second. Programs that
/// know no films show its first picture.
///
/// # Errors
/// Returns the errors of [`write`](fn@write), and an error if there are no pictures.
pub fn write_film(
    path: &Path,
    size: [u32; 2],
    pictures: &[Vec<u8>],
    rate: u32,
    about: &About,
) -> io::Result<()> {
    Output::put(path, |to| encode_all(BufWriter::new(to), size, pictures, Some(rate), about))
}

/// The picture as the bytes of a PNG file.
///
/// # Errors
/// Returns the errors of [`write`](fn@write), except those of the file system.
pub fn encode(to: impl Write, width: u32, height: u32, rgb8: &[u8], about: &About) -> io::Result<()> {
    encode_all(to, [width, height], &[rgb8], None, about)
}

/// A picture, or the pictures of a film with so many per second.
fn encode_all(
    mut to: impl Write,
    [width, height]: [u32; 2],
    pictures: &[impl AsRef<[u8]>],
    rate: Option<u32>,
    about: &About,
) -> io::Result<()> {
    let mut encoder = Encoder::new(&mut to, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Fastest);
    if let Some(rate) = rate {
        encoder.set_animated(u32::try_from(pictures.len()).unwrap_or(u32::MAX), 0).map_err(plain)?;
        encoder.set_frame_delay(1, u16::try_from(rate).unwrap_or(u16::MAX)).map_err(plain)?;
    }
    for (keyword, text) in &about.texts {
        let (keyword, text) = ((*keyword).to_owned(), text.clone());
        // Latin-1 text fits into the plain chunk that every reader supports; names like "Blinn–Phong" do not.
        if text.chars().all(|c| u32::from(c) < 256) {
            encoder.add_text_chunk(keyword, text).map_err(plain)?;
        } else {
            encoder.add_itxt_chunk(keyword, text).map_err(plain)?;
        }
    }
    let mut writer = encoder.write_header().map_err(plain)?;
    if let Some(scene) = &about.scene {
        let mut text = ITXtChunk::new(SCENE_KEYWORD, scene);
        text.compressed = true;
        writer.write_text_chunk(&text).map_err(plain)?;
    }
    for picture in pictures {
        writer.write_image_data(picture.as_ref()).map_err(plain)?;
    }
    writer.finish().map_err(plain)?;
    to.flush()
}

/// The picture in a file that has this text, if it is whole and of this size.
#[must_use]
pub fn read_with(path: &Path, keyword: &str, text: &str, size: [u32; 2]) -> Option<Vec<u8>> {
    let bytes = files::read(path, MAX_PICTURE_BYTES).ok()?;
    let mut reader = Decoder::new(Cursor::new(bytes)).read_info().ok()?;
    let info = reader.info();
    let has_text = info.uncompressed_latin1_text.iter().any(|own| own.keyword == keyword && own.text == text);
    if !has_text || [info.width, info.height] != size || info.color_type != ColorType::Rgb {
        return None;
    }
    let mut rgb8 = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut rgb8).ok()?;
    // A file that was cut off may end after its pixels.
    reader.finish().ok()?;
    Some(rgb8)
}

/// The text with a keyword in a file, if it begins as a picture and has one.
#[must_use]
pub fn text(path: &Path, keyword: &str) -> Option<String> {
    let bytes = files::read(path, MAX_PICTURE_BYTES).ok()?;
    let reader = Decoder::new(Cursor::new(bytes)).read_info().ok()?;
    let mut texts = reader.info().uncompressed_latin1_text.iter();
    texts.find(|own| own.keyword == keyword).map(|own| own.text.clone())
}

/// Keeps the kind of operating system errors.
fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        error => error.into(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};

    use super::*;
    use crate::scene::load::{self, Defaults};

    fn gradient() -> Vec<u8> {
        (0..16 * 8 * 3).map(|i| (i % 251) as u8).collect()
    }

    #[test]
    fn what_is_written_can_be_read_back_with_its_text() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("new/folder/picture.png");
        let (scene, registry) =
            (Scene { name: Some("Blinn–Phong".to_owned()), ..Scene::default() }, Registry::builtin());
        let about = About::scene(&scene, &registry).with("Source", "a.json");
        write(&path, 16, 8, &gradient(), &about).expect("can be written");
        let decoder = png::Decoder::new(io::BufReader::new(File::open(&path).expect("exists")));
        let mut reader = decoder.read_info().expect("is a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("fits")];
        reader.next_frame(&mut bytes).expect("has a picture");
        assert_eq!(bytes, gradient());
        let info = reader.info();
        assert_eq!((info.width, info.height), (16, 8));
        let plain: Vec<_> = info.uncompressed_latin1_text.iter().map(|t| (&*t.keyword, &*t.text)).collect();
        let software = concat!("Lights, Camera, Models! ", env!("CARGO_PKG_VERSION"));
        let models = [("Reflection model", "lambert"), ("Shading model", "gouraud"), ("Source", "a.json")];
        assert_eq!(plain, [&[("Software", software)], &models[..]].concat());
        let [title, embedded] = info.utf8_text.as_slice() else { panic!("{:?}", info.utf8_text) };
        assert_eq!((&*title.keyword, title.get_text().expect("is text").as_str()), ("Title", "Blinn–Phong"));
        assert_eq!((&*embedded.keyword, embedded.compressed), (SCENE_KEYWORD, true));
        assert_eq!(embedded.get_text().expect("is text"), to_json(&scene, None, &registry));
        // The program opens it again.
        let back = load::file(&path, &registry, Defaults::Refuse).expect("has a scene").scene;
        assert_eq!(back, scene);
        // The wrong twin: without the scene.
        write(&path, 16, 8, &gradient(), &about.without_scene()).expect("can be written");
        let said = load::file(&path, &registry, Defaults::Refuse).expect_err("has no scene").to_string();
        assert!(said.contains("there is no scene in this picture, only texts called \"Software\""), "{said}");
        // No other files are left.
        assert_eq!(fs::read_dir(path.parent().expect("has one")).expect("readable").count(), 1);
    }

    #[test]
    fn a_film_has_its_pictures_its_rate_and_its_scene() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("film.png");
        let (scene, registry) = (Scene::default(), Registry::builtin());
        let pictures = [gradient(), vec![7; 16 * 8 * 3], gradient()];
        write_film(&path, [16, 8], &pictures, 12, &About::scene(&scene, &registry)).expect("can be written");
        let decoder = Decoder::new(io::BufReader::new(File::open(&path).expect("exists")));
        let mut reader = decoder.read_info().expect("is a PNG");
        assert_eq!(reader.info().animation_control.map(|of| (of.num_frames, of.num_plays)), Some((3, 0)));
        for picture in &pictures {
            let mut bytes = vec![0; reader.output_buffer_size().expect("fits")];
            reader.next_frame(&mut bytes).expect("has a picture");
            let delay = reader.info().frame_control.map(|of| (of.delay_num, of.delay_den));
            assert!(bytes == *picture && delay == Some((1, 12)), "{delay:?}");
        }
        assert_eq!(load::file(&path, &registry, Defaults::Refuse).expect("has a scene").scene, scene);
        assert!(write_film(&path, [16, 8], &[], 12, &About::program()).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }

    #[test]
    fn a_picture_is_known_by_its_text() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("p.png");
        write(&path, 16, 8, &gradient(), &About::default().with("Sweep", "1")).expect("can be written");
        assert_eq!(read_with(&path, "Sweep", "1", [16, 8]), Some(gradient()));
        assert!(text(&path, "Sweep").is_some() && text(&path, "Title").is_none());
        for (keyword, text, size) in
            [("Sweep", "2", [16, 8]), ("Title", "1", [16, 8]), ("Sweep", "1", [8, 16])]
        {
            assert_eq!(read_with(&path, keyword, text, size), None);
        }
        let whole = fs::read(&path).expect("exists");
        fs::write(&path, &whole[..whole.len() - 6]).expect("written");
        assert_eq!(read_with(&path, "Sweep", "1", [16, 8]), None, "it was cut off");
    }

    #[test]
    fn a_wrong_number_of_bytes_is_an_error_and_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!(write(&folder.path().join("p.png"), 16, 9, &gradient(), &About::program()).is_err());
        assert!(write(&folder.path().join("p.png"), 0, 0, &[], &About::program()).is_err());
        assert!(write(folder.path(), 16, 8, &gradient(), &About::program()).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
    }

    #[test]
    fn an_existing_file_is_replaced() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("p.png");
        fs::write(&path, "old").expect("can be written");
        write(&path, 16, 8, &gradient(), &About::program()).expect("can be written");
        assert!(fs::read(&path).expect("exists").starts_with(b"\x89PNG"));
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_not_replaced() {
        write(Path::new("/dev/null"), 16, 8, &gradient(), &About::program()).expect("takes everything");
        assert!(!Path::new("/dev/null").is_file());
    }
}
