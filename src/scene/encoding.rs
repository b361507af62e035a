//! Decoding of text: UTF-8, or a guess at the encoding.

use super::error::LoadError;
use crate::text::place::Lines;

/// The text of the bytes, or a guess at their encoding.
pub(crate) fn decode<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str, LoadError> {
    let not_text = |at: usize, what: String| {
        // Everything before the first wrong byte is valid text.
        let before = std::str::from_utf8(&bytes[..at]).unwrap_or_default();
        LoadError::NotUtf8 { name: name.to_owned(), place: Lines::new(before).place(at), what }
    };
    let first = |what: &str| Err(not_text(0, what.to_owned()));
    let magic: [(&[u8], &str); 10] = [
        (b"\xFF\xFE\0\0", "the file is UTF-32; save it as UTF-8"),
        (b"\0\0\xFE\xFF", "the file is UTF-32; save it as UTF-8"),
        (b"\xFF\xFE", "the file is UTF-16 (little-endian); save it as UTF-8"),
        (b"\xFE\xFF", "the file is UTF-16 (big-endian); save it as UTF-8"),
        (b"\x89PNG", "the file is a PNG picture; a scene in it is read if the name of the file ends in .png"),
        (
            b"\x76\x2F\x31\x01",
            "the file is an OpenEXR picture; a scene in it is read if the name of the file ends in .exr",
        ),
        (
            b"#?R",
            "the file is a Radiance picture; a scene in it is read if the name of the file ends in .hdr",
        ),
        (b"\xFF\xD8\xFF", "the file is a JPEG picture, not a scene"),
        (b"\x1F\x8B", "the file is compressed (gzip); unpack it first"),
        (b"PK\x03\x04", "the file is a ZIP archive; unpack it first"),
    ];
    if let Some((_, what)) = magic.iter().find(|(start, _)| bytes.starts_with(start)) {
        return first(what);
    }
    // JSON begins with an ASCII character; in UTF-16 a zero byte is beside it.
    if let [a, b, ..] = bytes
        && (*a == 0) != (*b == 0)
    {
        return first("the file seems to be UTF-16; save it as UTF-8");
    }
    if let Some(at) = bytes.iter().position(|b| *b == 0)
        && std::str::from_utf8(&bytes[..at]).is_ok()
    {
        return Err(not_text(at, "there is a zero byte; the file is binary, or damaged".to_owned()));
    }
    std::str::from_utf8(bytes).map_err(|e| {
        let at = e.valid_up_to();
        let byte = bytes.get(at).copied().unwrap_or_default();
        if e.error_len().is_none() {
            return not_text(at, "the file ends within a character; it seems to be truncated".to_owned());
        }
        let binary = bytes.iter().take(1000).filter(|b| **b < 9).count() > 0;
        let guess = if binary {
            "the file is binary, or damaged"
        } else {
            "the file may be Latin-1 or Windows-1252; save it as UTF-8"
        };
        not_text(at, format!("unexpected byte {byte:#04X}; {guess}"))
    })
}
