//! Pictures that contain the scene that they show: OpenEXR files with a text attribute under this program's keyword.
//!
//! The header is read here, like the chunks of a PNG file: the pixels do not matter. Source: Academy Software
//! Foundation, *OpenEXR File Layout*, sections on the header and on attributes.

use super::{
    Parsed, SceneFormat, Source,
    picture::{self, Others, SCENE_KEYWORD, truncated, until_zero},
};
use crate::{files, registry::Registry, scene::error::LoadError};

/// Pictures with a scene. They can only be read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exr;

impl SceneFormat for Exr {
    fn name(&self) -> &'static str {
        "OpenEXR picture"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["exr"]
    }

    fn recognises(&self, content: &[u8]) -> bool {
        content.starts_with(files::EXR.begins)
    }

    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        picture::parsed(source, registry, scene_text)
    }
}

/// The text of the scene in a picture; `most` is its maximum size in bytes.
pub(super) fn scene_text(bytes: &[u8], most: u64) -> Result<String, String> {
    let Some(rest) = bytes.strip_prefix(files::EXR.begins) else {
        return Err("this is not an OpenEXR picture, though its name ends in .exr".to_owned());
    };
    // After the version and the flags.
    let mut rest = rest.get(4..).ok_or_else(truncated)?;
    let mut others = Others::default();
    loop {
        if rest.first() == Some(&0) {
            return Err(others.without_scene());
        }
        let (name, kind, value, after) = attribute(rest).ok_or_else(truncated)?;
        rest = after;
        if kind != b"string" {
            continue;
        }
        if name == SCENE_KEYWORD.as_bytes() {
            return picture::text(value, most);
        }
        others.add(name);
    }
}

/// The name, the type and the value of the first attribute, and the bytes after it; `None` if they end within it.
fn attribute(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8], &[u8])> {
    let (name, rest) = until_zero(bytes)?;
    let (kind, rest) = until_zero(rest)?;
    let (length, rest) = rest.split_first_chunk()?;
    let (value, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    Some((name, kind, value, rest))
}

#[cfg(test)]
mod tests {
    use super::{super::picture::WRITERS, *};

    fn attribute(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
        let length = (value.len() as u32).to_le_bytes();
        [name.as_bytes(), &[0], kind.as_bytes(), &[0], &length, value].concat()
    }

    fn picture(attributes: &[Vec<u8>]) -> Vec<u8> {
        [files::EXR.begins, &[2, 0, 0, 0], &attributes.concat(), &[0], b"pixels"].concat()
    }

    fn scene(text: &[u8]) -> Vec<u8> {
        attribute(SCENE_KEYWORD, "string", text)
    }

    #[test]
    fn the_scene_is_found_among_other_attributes() {
        let pixels = || attribute("dataWindow", "box2i", &[0; 16]);
        for attributes in [
            vec![scene(b"{}")],
            vec![pixels(), attribute("software", "string", b"a"), scene(b"{}"), pixels()],
            // The first of two counts.
            vec![scene(b"{}"), scene(b"[]")],
        ] {
            assert_eq!(scene_text(&picture(&attributes), 2).as_deref(), Ok("{}"));
        }
    }

    #[test]
    fn every_mistake_has_its_message() {
        let none = |texts: &str| format!("there is no scene in this picture{texts}; {WRITERS}");
        let text = |name: &str| attribute(name, "string", b"x");
        let cases = [
            (b"{}".to_vec(), "this is not an OpenEXR picture, though its name ends in .exr".to_owned()),
            (picture(&[]), none("")),
            (picture(&[text("comments")]), none(", only texts called \"comments\"")),
            (
                picture(&["a", "b", "c", "d"].map(text)),
                none(", only texts called \"a\", \"b\", \"c\" and 1 more"),
            ),
            (picture(&[attribute(SCENE_KEYWORD, "float", &[0; 4])]), none("")),
            (
                picture(&[scene(b"\xff\xfe")]),
                "the scene in the picture is damaged: it is not UTF-8 text".to_owned(),
            ),
            (
                picture(&[scene(&vec![b' '; (1 << 20) + 1])]),
                "the scene in the picture is larger than 1 MiB, the most allowed; it was not read".to_owned(),
            ),
        ];
        for (bytes, expected) in cases {
            assert_eq!(scene_text(&bytes, 1 << 20), Err(expected));
        }
        // Whatever its beginning says.
        let many: Vec<_> = (0..5000).map(|i| text(["a", "b"][i % 2])).collect();
        assert!(scene_text(&picture(&many), 1).expect_err("no scene").contains("and 997 more"));
    }

    #[test]
    fn a_picture_that_ends_early_is_an_error_wherever_it_ends() {
        let whole = picture(&[attribute("a", "float", &[0; 4]), scene(b"{}")]);
        let end = whole.len() - 7;
        for length in 4..end {
            assert_eq!(scene_text(&whole[..length], 1 << 20), Err(truncated()), "{length}");
        }
        // Behind the scene nothing is needed.
        assert!(scene_text(&whole[..end], 1 << 20).is_ok());
        for length in [u32::MAX, 1 << 31] {
            let bytes =
                [files::EXR.begins, &[2, 0, 0, 0], b"a\0string\0", &length.to_le_bytes(), b"x"].concat();
            assert_eq!(scene_text(&bytes, 1 << 20), Err(truncated()));
        }
    }
}
