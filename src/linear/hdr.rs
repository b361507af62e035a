//! Writes Radiance pictures with the crate `image`. The scene is in lines of the header that other programs read as
//! remarks: source, G. Ward, *Radiance File Formats*, section on picture files.

use std::io;

use image::{ImageError, Rgb, codecs::hdr::HdrEncoder};

use super::{Channels, Notes};

/// The first line of a file, as its encoder writes it.
const FIRST: &[u8] = b"#?RADIANCE\n";
/// The smallest and the largest number that the format can hold; the encoder does not check.
const RANGE: [f32; 2] = [1e-37, 1e38];

/// The end of the line before the scene, after `# ` and the name of the scene's attribute.
pub const SCENE_BEGINS: &str = "begins";
/// The end of the line after it.
pub const SCENE_ENDS: &str = "ends";

pub(super) fn encode(channels: &Channels, notes: &Notes) -> io::Result<Vec<u8>> {
    let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidInput, what);
    let [Some(red), Some(green), Some(blue)] = ["R", "G", "B"].map(|name| channels.get(name)) else {
        return Err(wrong("a Radiance picture needs the channels R, G and B".to_owned()));
    };
    let number = |c: f32| if c >= RANGE[0] { c.min(RANGE[1]) } else { 0.0 };
    let pixels: Vec<_> =
        red.iter().zip(green).zip(blue).map(|((r, g), b)| Rgb([*r, *g, *b].map(number))).collect();
    let mut encoded = Vec::new();
    HdrEncoder::new(&mut encoded)
        .encode(&pixels, channels.width as usize, channels.height as usize)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            error => wrong(error.to_string()),
        })?;
    let rest = encoded.strip_prefix(FIRST).ok_or_else(|| wrong("its header is missing".to_owned()))?;
    Ok([FIRST, header(notes).as_bytes(), rest].concat())
}

/// The lines of the header that are our own. None is empty: an empty line ends the header.
fn header(notes: &Notes) -> String {
    let plain = |line: &str| line.replace(|c: char| c.is_control(), " ");
    let mut lines = Vec::new();
    if !notes.software.is_empty() {
        lines.push(format!("SOFTWARE={}", plain(&notes.software)));
    }
    lines.extend(notes.comments.lines().map(|line| format!("# {}", plain(line))));
    if let Some((name, scene)) = notes.scene {
        lines.push(format!("# {name} {SCENE_BEGINS}"));
        lines.extend(scene.lines().map(|line| format!("# {line}")));
        lines.push(format!("# {name} {SCENE_ENDS}"));
    }
    lines.iter().flat_map(|line| [line.as_str(), "\n"]).collect()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use glam::Vec4;
    use image::{ImageDecoder as _, codecs::hdr::HdrDecoder};

    use super::{super::Format, *};

    #[test]
    fn colours_are_within_a_step_of_the_format_and_other_programs_read_the_header() {
        let pixels: Vec<_> = (0..64 * 3)
            .map(|i| {
                let size = 2.0f32.powi(i % 60 - 30);
                Vec4::new(1.3 * size, 0.01 * i as f32 * size, size, 0.5)
            })
            .chain([Vec4::ZERO, Vec4::splat(-1.0), Vec4::splat(f32::NAN), Vec4::splat(f32::INFINITY)])
            .chain([Vec4::splat(1e-40), Vec4::splat(3e38), Vec4::new(-1.0, 2.0, f32::NAN, 1.0)])
            .collect();
        let mut channels = Channels::new(pixels.len() as u32, 1);
        channels.add("", &["R", "G", "B", "A"], &pixels);
        let scene = "{\n  \"name\": \"größe\"\n}\n";
        let notes = Notes {
            software: "lab\n1".into(),
            comments: "a\n\nb\tc".into(),
            scene: Some(("the scene", scene)),
        };
        let bytes = channels.encode(Format::Hdr, &notes).expect("written");
        let head = "#?RADIANCE\nSOFTWARE=lab 1\n# a\n# \n# b c\n# the scene begins\n# {\n#   \"name\": \"größe\"\n# }\n\
                    # the scene ends\n";
        assert!(bytes.starts_with(head.as_bytes()), "{}", String::from_utf8_lossy(&bytes[..200]));
        let decoder = HdrDecoder::new(Cursor::new(&bytes)).expect("a Radiance file");
        assert_eq!(decoder.dimensions(), (pixels.len() as u32, 1));
        let mut read = vec![0; 12 * pixels.len()];
        decoder.read_image(&mut read).expect("whole");
        let numbers: Vec<_> =
            read.as_chunks::<4>().0.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
        for (i, (read, right)) in numbers.as_chunks::<3>().0.iter().zip(&pixels).enumerate() {
            let right = right.truncate().map(|c| if c > 1e-37 { c.min(1e38) } else { 0.0 });
            let step = right.max_element() / 127.0;
            let near = read.iter().zip(right.to_array()).all(|(a, b)| (b - step..=b).contains(a));
            assert!(near, "{i}: {read:?} for {right}");
        }
        assert_eq!(channels.encode(Format::Hdr, &notes).expect("written"), bytes, "the same bytes again");
    }
}
