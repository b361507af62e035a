//! The file formats of plots.

use std::{ffi::OsStr, io, path::Path};

use super::Sheet;
use crate::{
    declared::ids,
    files::{self, Shown as _, Signature},
};

ids! {
    /// The format of a file; the id is the extension, without the dot.
    Format {
        /// Vector graphics.
        Svg = "svg",
        /// Pixels.
        Png = "png",
        /// Numbers.
        Csv = "csv",
    }
}

impl Format {
    /// The format given by the extension of a file name.
    ///
    /// # Errors
    /// Returns an error if no format has this extension.
    pub fn of(path: &Path) -> Result<Self, String> {
        let extension = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
        match extension.as_deref().and_then(Self::from_id) {
            Some(format) => Ok(format),
            // The name of a device or a pipe gives no format.
            None if extension.is_none() && files::is_stream(path) => Ok(Self::Csv),
            None => {
                let named = path.with_extension("svg");
                Err(match named == path {
                    // A folder such as `.`, to which no extension can be added.
                    true => "a plot is written as .svg, .png or .csv; name a file".to_owned(),
                    false => {
                        let named = named.shown();
                        format!("a plot is written as .svg, .png or .csv; did you mean {named}?")
                    }
                })
            }
        }
    }

    /// The signature of files of this format: other files are not replaced.
    #[must_use]
    pub fn signature(self) -> Signature {
        match self {
            Self::Svg => Signature { what: "an SVG file", begins: b"<svg" },
            Self::Png => files::PNG,
            Self::Csv => Signature { what: "a CSV file of lcm plot", begins: b"curve," },
        }
    }

    /// The content of the file.
    ///
    /// # Errors
    /// Returns an error if the picture is too large to be encoded.
    pub fn bytes(self, sheet: &Sheet) -> io::Result<Vec<u8>> {
        Ok(match self {
            Self::Svg => sheet.figure().svg().into_bytes(),
            Self::Png => sheet.png()?,
            Self::Csv => sheet.csv().into_bytes(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_the_file_says_its_format() {
        for (name, format) in [("a.svg", Format::Svg), ("a.PNG", Format::Png), ("b/a.csv", Format::Csv)] {
            assert_eq!(Format::of(Path::new(name)), Ok(format));
        }
        for name in ["a.jpg", "a", "svg"] {
            let Err(said) = Format::of(Path::new(name)) else { panic!("{name}") };
            assert!(said.contains(".svg, .png or .csv; did you mean"), "{said}");
        }
        for folder in [".", "..", "/"] {
            let Err(said) = Format::of(Path::new(folder)) else { panic!("{folder}") };
            assert_eq!(said, "a plot is written as .svg, .png or .csv; name a file");
        }
    }
}
