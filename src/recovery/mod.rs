//! Recovery copies: unsaved work that outlives the window, however that ends.
//!
//! While the document has unsaved changes, [`Keeper`] keeps a copy of it in a separate folder for each window
//! ([`Journal`]), written by a background thread about a second after an edit. Only saving and closing remove
//! it. Whatever ends the window, be it a signal, a crash or a lost display, at most that second is lost, and
//! [`Store::abandoned`] finds the copy at the next start.
//!
//! `writer` decides what is written and when, `store` manages the folder. A copy is an ordinary scene file,
//! `scene.json`, next to [`About`]. Independent of Bevy.

use std::{path::PathBuf, time::Duration};

use serde::{Deserialize, Serialize};

use crate::scene::load::Stamp;

mod store;
pub mod texts;
mod writer;

pub use store::{Abandoned, Journal, MAX_COPIES, Store};
pub use writer::{Keeper, Settled};

/// Facts about the copied document.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct About {
    /// Name of the document.
    pub title: String,
    /// Absolute path of the document's file, if it has one.
    #[serde(with = "path_text")]
    pub path: Option<PathBuf>,
    /// Absolute path of the folder of custom models, if there was one.
    #[serde(with = "path_text")]
    pub models: Option<PathBuf>,
    /// State of that file when it was last read or written.
    pub stamp: Option<Stamp>,
    /// Process that wrote the copy.
    pub process: u32,
}

/// The age of a copy in words: "5 minutes ago".
#[must_use]
pub fn ago(age: Duration) -> String {
    let minutes = age.as_secs() / 60;
    let (count, unit) = match minutes {
        0 => return "less than a minute ago".to_owned(),
        1..60 => (minutes, "minute"),
        60..1440 => (minutes / 60, "hour"),
        _ => (minutes / 1440, "day"),
    };
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {unit}{plural} ago")
}

/// Paths as text if they are valid text; as bytes where the system allows others.
mod path_text {
    use std::path::{Path, PathBuf};

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum Text {
        Text(String),
        Bytes(Vec<u8>),
    }

    pub(super) fn serialize<S: Serializer>(path: &Option<PathBuf>, to: S) -> Result<S::Ok, S::Error> {
        path.as_deref().map(text).serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<PathBuf>, D::Error> {
        Ok(Option::<Text>::deserialize(from)?.map(path))
    }

    fn text(path: &Path) -> Text {
        let text = path.to_str().map(|text| Text::Text(text.to_owned()));
        text.unwrap_or_else(|| Text::Bytes(path.as_os_str().as_encoded_bytes().to_owned()))
    }

    fn path(text: Text) -> PathBuf {
        match text {
            Text::Text(text) => text.into(),
            #[cfg(unix)]
            Text::Bytes(bytes) => {
                use std::os::unix::ffi::OsStringExt as _;
                std::ffi::OsString::from_vec(bytes).into()
            }
            #[cfg(not(unix))]
            Text::Bytes(bytes) => String::from_utf8_lossy(&bytes).into_owned().into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_age_of_a_copy_is_said_in_its_largest_unit() {
        for (seconds, expected) in [
            (0, "less than a minute ago"),
            (59, "less than a minute ago"),
            (60, "1 minute ago"),
            (59 * 60, "59 minutes ago"),
            (3600, "1 hour ago"),
            (47 * 3600, "1 day ago"),
            (96 * 3600, "4 days ago"),
        ] {
            assert_eq!(ago(Duration::from_secs(seconds)), expected);
        }
    }

    #[test]
    fn what_a_copy_is_about_is_read_back() {
        let mut paths = vec![None, Some(PathBuf::from("/scenes/Grün.json"))];
        #[cfg(unix)]
        {
            use std::os::unix::ffi::OsStringExt as _;
            paths.push(Some(std::ffi::OsString::from_vec(b"/scenes/\xff.json".to_vec()).into()));
        }
        for path in paths {
            let (models, stamp) = (path.clone(), Some(Stamp::of(b"text")));
            let about = About { title: "Room".to_owned(), path, models, stamp, process: 12 };
            let text = serde_json::to_string(&about).expect("no path is in the way");
            assert_eq!(serde_json::from_str::<About>(&text).expect("read"), about);
        }
        assert_eq!(serde_json::from_str::<About>("{}").expect("read"), About::default());
    }
}
