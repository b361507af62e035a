//! Pictures that contain the scene that they show: Radiance files with the scene in remarks of the header, between two
//! lines with this program's keyword.

use super::{
    Parsed, SceneFormat, Source,
    picture::{self, Others, SCENE_KEYWORD, truncated},
};
use crate::{
    files,
    linear::{SCENE_BEGINS, SCENE_ENDS},
    registry::Registry,
    scene::error::LoadError,
};

/// Pictures with a scene. They can only be read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hdr;

impl SceneFormat for Hdr {
    fn name(&self) -> &'static str {
        "Radiance picture"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["hdr"]
    }

    fn recognises(&self, content: &[u8]) -> bool {
        content.starts_with(files::HDR.begins)
    }

    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
        picture::parsed(source, registry, scene_text)
    }
}

/// The text of the scene in a picture; `most` is its maximum size in bytes.
pub(super) fn scene_text(bytes: &[u8], most: u64) -> Result<String, String> {
    if !bytes.starts_with(files::HDR.begins) {
        return Err("this is not a Radiance picture, though its name ends in .hdr".to_owned());
    }
    let [begins, ends] = [SCENE_BEGINS, SCENE_ENDS].map(|word| format!("{SCENE_KEYWORD} {word}"));
    let mut lines = bytes.split_inclusive(|byte| *byte == b'\n');
    loop {
        let line = lines.next().ok_or_else(truncated)?;
        match line {
            b"\n" => return Err(Others::default().without_scene()),
            line if remark(line) == Some(begins.as_bytes()) => break,
            _ => {}
        }
    }
    let mut scene = Vec::new();
    for line in lines {
        let Some(line) = remark(line) else { break };
        if line == ends.as_bytes() {
            return picture::text(&scene, most);
        }
        if scene.len() as u64 > most {
            return picture::text(&scene, most);
        }
        scene.extend_from_slice(line);
        scene.push(b'\n');
    }
    Err("the scene in the picture is damaged: its end is missing".to_owned())
}

/// The text of a line that is a remark, and complete.
fn remark(line: &[u8]) -> Option<&[u8]> {
    line.strip_prefix(b"# ")?.strip_suffix(b"\n")
}

#[cfg(test)]
mod tests {
    use super::{super::picture::WRITERS, *};

    fn picture(lines: &str) -> Vec<u8> {
        format!("#?RADIANCE\nSOFTWARE=a\n{lines}FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\naaaa").into_bytes()
    }

    fn scene(lines: &str) -> String {
        format!("# {SCENE_KEYWORD} begins\n{lines}# {SCENE_KEYWORD} ends\n")
    }

    #[test]
    fn the_scene_is_found_among_other_lines() {
        let read = |lines: &str| scene_text(&picture(lines), 8);
        assert_eq!(read(&scene("# {\n#  }\n")).as_deref(), Ok("{\n }\n"));
        assert_eq!(read(&format!("# a\n{}# b\n", scene("# {}\n"))).as_deref(), Ok("{}\n"));
        assert_eq!(read(&(scene("# {}\n") + &scene("# []\n"))).as_deref(), Ok("{}\n"), "the first counts");
        assert_eq!(read(&scene("")).as_deref(), Ok(""));
    }

    #[test]
    fn every_mistake_has_its_message() {
        let none = format!("there is no scene in this picture; {WRITERS}");
        let ended = "the scene in the picture is damaged: its end is missing".to_owned();
        let large = "the scene in the picture is larger than 1 MiB, the most allowed; it was not read";
        let begin = format!("# {SCENE_KEYWORD} begins\n# {{}}\n");
        let cases = [
            (b"{}".to_vec(), "this is not a Radiance picture, though its name ends in .hdr".to_owned()),
            (picture(""), none.clone()),
            (picture("# a\n"), none.clone()),
            (picture(&format!("# {SCENE_KEYWORD}\n")), none.clone()),
            // Behind the header are pixels, whatever they look like.
            ([picture(""), b"\n".to_vec(), scene("# {}\n").into_bytes()].concat(), none),
            (b"#?RADIANCE\n".to_vec(), truncated()),
            (b"#?RADIANCE\n# a".to_vec(), truncated()),
            (picture(&begin), ended.clone()),
            (format!("#?RADIANCE\n{begin}").into_bytes(), ended.clone()),
            (format!("#?RADIANCE\n{begin}# {SCENE_KEYWORD} ends").into_bytes(), ended),
            (picture(&scene(&"# 12345678\n".repeat(200_000))), large.to_owned()),
            (picture(&scene(&format!("# {}\n", "a".repeat(2 << 20)))), large.to_owned()),
        ];
        for (bytes, expected) in cases {
            assert_eq!(scene_text(&bytes, 1 << 20), Err(expected));
        }
        let odd = [b"#?RADIANCE\n".to_vec(), scene("# ?\n").into_bytes()].concat();
        let odd: Vec<u8> = odd.into_iter().map(|byte| if byte == b'?' { 0xff } else { byte }).collect();
        let odd = [b"#?R\n".as_slice(), odd.strip_prefix(b"#\xffRADIANCE\n").expect("there")].concat();
        let said = "the scene in the picture is damaged: it is not UTF-8 text";
        assert_eq!(scene_text(&odd, 1 << 20), Err(said.to_owned()));
    }
}
