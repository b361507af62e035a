//! Pictures that contain the scene that they show: PNG files with a compressed text under this program's
//! keyword.
//!
//! The chunks of the file are read here, since a decoder of pictures silently skips damaged texts, and
//! decompresses the picture to reach the texts after it. Source: *Portable Network Graphics (PNG)
//! Specification (Third Edition)*, W3C (2025), sections 5.2 to 5.5 and 11.3.3.

use std::io::Read as _;

use flate2::{Crc, read::ZlibDecoder};

use super::{
    Parsed, SceneFormat, Source,
    picture::{self, NOT_TEXT, Others, SCENE_KEYWORD, too_large, truncated, until_zero},
};
use crate::{files, registry::Registry, scene::error::LoadError};

/// Pictures with a scene. They can only be read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Png;

impl SceneFormat for Png {
    fn name(&self) -> &'static str {
        "PNG picture"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["png"]
    }

    fn recognises(&self, content: &[u8]) -> bool {
        content.starts_with(files::PNG.begins)
    }

    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        picture::parsed(source, registry, scene_text)
    }
}

/// A chunk of a PNG file.
struct Chunk<'a> {
    kind: [u8; 4],
    content: &'a [u8],
    whole: bool,
}

/// The text of the scene in a picture; `most` is its maximum size in bytes.
pub(super) fn scene_text(bytes: &[u8], most: u64) -> Result<String, String> {
    let Some(mut rest) = bytes.strip_prefix(files::PNG.begins) else {
        return Err("this is not a PNG picture, though its name ends in .png".to_owned());
    };
    let mut others = Others::default();
    loop {
        let (chunk, after) = next_chunk(rest).ok_or_else(truncated)?;
        rest = after;
        match &chunk.kind {
            b"iTXt" | b"tEXt" | b"zTXt" => {
                let name = until_zero(chunk.content).map_or(chunk.content, |(name, _)| name);
                if &chunk.kind == b"iTXt" && name == SCENE_KEYWORD.as_bytes() {
                    return unpacked(&chunk, most).map_err(|what| format!("the scene in the picture {what}"));
                }
                others.add(name);
            }
            b"IEND" => return Err(others.without_scene()),
            _ => {}
        }
    }
}

/// The first chunk, and the bytes after it; `None` if the bytes end within it.
fn next_chunk(bytes: &[u8]) -> Option<(Chunk<'_>, &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    let (kind, _) = rest.split_first_chunk::<4>()?;
    let length = u32::from_be_bytes(*length) as usize;
    let (checked, rest) = rest.split_at_checked(length.checked_add(4)?)?;
    let (sum, rest) = rest.split_first_chunk()?;
    let whole = || {
        let mut crc = Crc::new();
        crc.update(checked);
        crc.sum() == u32::from_be_bytes(*sum)
    };
    // The checksums of pictures do not matter here, and take a while.
    let whole = kind != b"iTXt" || whole();
    Some((Chunk { kind: *kind, content: &checked[4..], whole }, rest))
}

/// The content of an iTXt chunk: keyword, 0, compression flag, method, language, 0, translated keyword, 0,
/// text.
fn unpacked(chunk: &Chunk, most: u64) -> Result<String, String> {
    if !chunk.whole {
        return Err("is damaged: its checksum is wrong".to_owned());
    }
    let fields = || {
        let (_, rest) = until_zero(chunk.content)?;
        let ([compressed, method], rest) = rest.split_first_chunk()?;
        let (_, rest) = until_zero(rest)?;
        let (_, text) = until_zero(rest)?;
        Some((*compressed, *method, text))
    };
    let bytes = match fields() {
        Some((0, _, text)) if text.len() as u64 > most => return Err(too_large(most)),
        Some((0, _, text)) => text.to_vec(),
        Some((1, 0, packed)) => {
            let mut text = Vec::new();
            let unpacked = ZlibDecoder::new(packed).take(most + 1).read_to_end(&mut text);
            unpacked.map_err(|_| "is damaged: it cannot be decompressed".to_owned())?;
            if text.len() as u64 > most {
                return Err(too_large(most));
            }
            text
        }
        Some(_) => return Err("is compressed in an unknown way".to_owned()),
        None => return Err("is damaged: it has no text".to_owned()),
    };
    String::from_utf8(bytes).map_err(|_| NOT_TEXT.to_owned())
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::{Compression, write::ZlibEncoder};

    use super::{super::picture::WRITERS, *};

    fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
        let checked = [kind, content].concat();
        let mut crc = Crc::new();
        crc.update(&checked);
        [&(content.len() as u32).to_be_bytes()[..], &checked, &crc.sum().to_be_bytes()].concat()
    }

    fn picture(chunks: &[Vec<u8>]) -> Vec<u8> {
        [files::PNG.begins.to_vec(), chunk(b"IHDR", &[0; 13]), chunks.concat(), chunk(b"IEND", &[])].concat()
    }

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(text).expect("in memory");
        encoder.finish().expect("in memory")
    }

    fn scene(flags: [u8; 2], text: &[u8]) -> Vec<u8> {
        chunk(b"iTXt", &[SCENE_KEYWORD.as_bytes(), &[0], &flags, b"en\0Scene\0", text].concat())
    }

    #[test]
    fn the_scene_is_found_before_and_behind_the_picture() {
        let other = || chunk(b"iTXt", b"XML:com.adobe.xmp\0\0\0\0\0<x/>");
        let pixels = || chunk(b"IDAT", &[7; 100]);
        for chunks in [
            vec![scene([0, 0], b"{}"), pixels()],
            vec![scene([1, 0], &packed(b"{}"))],
            vec![other(), pixels(), scene([1, 0], &packed(b"{}"))],
            // The first of two counts.
            vec![scene([0, 0], b"{}"), scene([0, 0], b"[]")],
        ] {
            assert_eq!(scene_text(&picture(&chunks), 2).as_deref(), Ok("{}"));
        }
    }

    #[test]
    fn every_mistake_has_its_message() {
        let none = |texts: &str| format!("there is no scene in this picture{texts}; {WRITERS}");
        let of_scene = |what: &str| format!("the scene in the picture {what}");
        let text = |name: &str| chunk(b"tEXt", format!("{name}\0x").as_bytes());
        let bomb = packed(&vec![b' '; 3 << 20]);
        let mut flipped = scene([0, 0], b"{}");
        flipped[50] ^= 1;
        let cases: [(Vec<u8>, String); 12] = [
            (b"{}".to_vec(), "this is not a PNG picture, though its name ends in .png".to_owned()),
            (picture(&[]), none("")),
            (picture(&[text("Title")]), none(", only texts called \"Title\"")),
            (
                picture(&["a", "b", "c", "d", "e"].map(text)),
                none(", only texts called \"a\", \"b\", \"c\" and 2 more"),
            ),
            (picture(&[flipped]), of_scene("is damaged: its checksum is wrong")),
            (picture(&[scene([1, 0], b"no deflate")]), of_scene("is damaged: it cannot be decompressed")),
            (
                picture(&[scene([1, 0], &packed(b"{\"a\": 12345678}")[..12])]),
                of_scene("is damaged: it cannot be decompressed"),
            ),
            (picture(&[scene([1, 1], &packed(b"{}"))]), of_scene("is compressed in an unknown way")),
            (picture(&[scene([0, 0], b"\xff\xfe")]), of_scene("is damaged: it is not UTF-8 text")),
            (
                picture(&[chunk(b"iTXt", &[SCENE_KEYWORD.as_bytes(), b"\0\0\0{}"].concat())]),
                of_scene("is damaged: it has no text"),
            ),
            (
                picture(&[scene([1, 0], &bomb)]),
                of_scene("is larger than 1 MiB, the most allowed; it was not read"),
            ),
            (
                picture(&[scene([0, 0], &vec![b' '; (1 << 20) + 1])]),
                of_scene("is larger than 1 MiB, the most allowed; it was not read"),
            ),
        ];
        for (bytes, expected) in cases {
            assert_eq!(scene_text(&bytes, 1 << 20), Err(expected));
        }
    }

    #[test]
    fn a_picture_that_ends_early_is_an_error_wherever_it_ends() {
        let whole = picture(&[chunk(b"IDAT", &[7; 100]), scene([1, 0], &packed(b"{}"))]);
        let end = whole.len() - 12;
        for length in files::PNG.begins.len()..end {
            let said = scene_text(&whole[..length], 1 << 20).expect_err("it is truncated");
            assert!(said.starts_with("the picture is truncated, and there is no scene"), "{length}: {said}");
        }
        // Behind the scene nothing is needed.
        assert!(scene_text(&whole[..end], 1 << 20).is_ok());
        // A length beyond the file, and beyond memory.
        for length in [u32::MAX, u32::MAX - 11, 1 << 31] {
            let bytes = [files::PNG.begins, &length.to_be_bytes(), b"iTXtabcd"].concat();
            assert!(scene_text(&bytes, 1 << 20).is_err());
        }
    }
}
