//! A scene in the address of a page: packed into its fragment, `#scene=1.…`, which browsers send to no server. 1 is the
//! version; base64 for addresses follows, of the scene as JSON, compressed as zlib does, whose checksum finds what was
//! changed or cut off on the way.

use std::{
    collections::BTreeSet,
    io::{Read as _, Write as _},
};

use base64::{Engine as _, engine::general_purpose::URL_SAFE_NO_PAD};
use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};

use super::{Scene, check, save};
use crate::{registry::Registry, text::listed};

/// The most characters of a link that is made, without the address of the page: programs for mail and chat carry so many.
pub const MOST_MADE: usize = 8_000;
/// The most characters that are read.
pub const MOST_READ: usize = 64 << 10;
/// The largest scene in a link, in bytes.
pub const MOST_UNPACKED: u64 = 1 << 20;

/// The beginning of a fragment with a scene.
const BEGINS: &str = "#scene=";
/// The version of what follows.
const VERSION: &str = "1";
/// What is said if something else arrives than was sent.
const DAMAGED: &str = "it is damaged: a part of the address is missing, or was changed on the way";

/// The end of an address that opens a scene.
///
/// # Errors
/// Returns the reason why a link cannot hold the scene, as the end of "it was not copied: …".
pub fn made(scene: &Scene, registry: &Registry) -> Result<String, String> {
    let beside = beside(scene, registry);
    if !beside.is_empty() {
        let beside = listed(&beside, "and");
        return Err(format!(
            "a link cannot hold {beside}, which the scene needs; save the scene, and send the files"
        ));
    }
    if let Some(problem) = check::scene(scene, registry).first() {
        return Err(format!("the scene has problems: {problem}"));
    }
    let link = packed(&save::to_json(scene, None, registry));
    if link.len() > MOST_MADE {
        let length = link.len();
        return Err(format!(
            "it would have {length} characters, and a link has at most {MOST_MADE}; save the scene, and send its file"
        ));
    }
    Ok(link)
}

/// What a scene needs from files, in words. What comes with the program is everywhere.
fn beside(scene: &Scene, registry: &Registry) -> Vec<String> {
    let files = scene.files().filter(|file| file.path().is_some());
    let files: BTreeSet<_> = files.map(|file| file.short_name().into_owned()).collect();
    let models = scene.models().into_iter().filter(|id| registry.custom_file(id).is_some());
    files.into_iter().chain(models.map(|id| format!("the custom model {id}"))).collect()
}

/// A text as the end of an address, whatever its length.
#[must_use]
pub fn packed(json: &str) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    let bytes = encoder.write_all(json.as_bytes()).and_then(|()| encoder.finish()).unwrap_or_default();
    format!("{BEGINS}{VERSION}.{}", URL_SAFE_NO_PAD.encode(bytes))
}

/// The end of an address that holds a scene, or of a text that is only such an end; `None` for any other text.
#[must_use]
pub fn found(text: &str) -> Option<&str> {
    let (before, link) = text.split_at(text.find(BEGINS)?);
    (before.is_empty() || before.contains("://")).then_some(link)
}

/// The scene in the end of an address, as JSON.
///
/// # Errors
/// Returns the reason why there is none, without the name of the link.
pub fn unpacked(link: &str) -> Result<String, String> {
    if link.len() > MOST_READ {
        return Err(format!("it has more than {MOST_READ} characters, the most that are read"));
    }
    let (version, packed) = link.strip_prefix(BEGINS).and_then(|link| link.split_once('.')).ok_or(DAMAGED)?;
    if version != VERSION {
        let is_number = version.len() < 4 && version.parse::<u16>().is_ok();
        return Err(match is_number {
            true => format!("it is of version {version}, and this program reads version {VERSION}"),
            false => DAMAGED.to_owned(),
        });
    }
    let bytes = URL_SAFE_NO_PAD.decode(packed).map_err(|_| DAMAGED)?;
    let mut json = Vec::new();
    // Compressed well, a short text can be a very long one.
    ZlibDecoder::new(&bytes[..]).take(MOST_UNPACKED + 1).read_to_end(&mut json).map_err(|_| DAMAGED)?;
    if json.len() as u64 > MOST_UNPACKED {
        let most = MOST_UNPACKED >> 20;
        return Err(format!("the scene in it is larger than {most} MiB, the most that is read"));
    }
    String::from_utf8(json).map_err(|_| DAMAGED.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_is_found_in_an_address_and_alone() {
        let link = packed("{}");
        assert!(link.starts_with("#scene=1.") && !link.contains(['+', '/', '%']), "{link}");
        for text in [link.clone(), format!("https://lab.example.org/a/?x=1{link}")] {
            assert_eq!(found(&text).map(unpacked), Some(Ok("{}".to_owned())), "{text}");
        }
        for text in ["room.json", "scenes/#scene=1.json", "https://lab.example.org/?scene=gem"] {
            assert_eq!(found(text), None, "{text}");
        }
    }

    #[test]
    fn what_is_cut_off_or_changed_is_no_other_scene() {
        let json = save::to_json(&Scene::default(), None, &Registry::builtin());
        let link = packed(&json);
        assert_eq!(unpacked(&link).as_ref(), Ok(&json));
        for end in 0..link.len() {
            assert!(unpacked(&link[..end]).is_err(), "{end} characters");
        }
        let mut refused = 0;
        for at in BEGINS.len() + 2..link.len() {
            let other = if &link[at..=at] == "A" { "B" } else { "A" };
            let changed = [&link[..at], other, &link[at + 1..]].concat();
            match unpacked(&changed) {
                // A few bits mean nothing.
                Ok(same) => assert_eq!(same, json, "{at}: {changed}"),
                Err(_) => refused += 1,
            }
        }
        assert!(refused > link.len() - BEGINS.len() - 8, "{refused} of {}", link.len());
    }

    #[test]
    fn limits_are_stated_before_memory_is_taken() {
        let said = |link: &str| unpacked(link).err().unwrap_or_default();
        let spaces = |n: u64| packed(&" ".repeat(n as usize));
        assert!(spaces(MOST_UNPACKED).len() < MOST_MADE, "it is short");
        assert_eq!(unpacked(&spaces(MOST_UNPACKED)).map(|json| json.len() as u64), Ok(MOST_UNPACKED));
        assert_eq!(
            said(&spaces(MOST_UNPACKED + 1)),
            "the scene in it is larger than 1 MiB, the most that is read"
        );
        let long = format!("#scene=1.{}", "A".repeat(MOST_READ));
        assert_eq!(said(&long), "it has more than 65536 characters, the most that are read");
        assert_eq!(said("#scene=2.AAAA"), "it is of version 2, and this program reads version 1");
        for odd in ["", "#scene=", "#scene=1", "#scene=1.", "#scene=one.AAAA", "#scene=1.ä", "#scene=1.AA=="]
        {
            assert_eq!(said(odd), DAMAGED, "{odd}");
        }
    }
}
