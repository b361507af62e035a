//! Parts of a text with their positions: lines, and pairs `KEY: VALUE`.

/// A part of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Piece<'a> {
    /// First byte in the whole text.
    pub(super) at: usize,
    pub(super) text: &'a str,
}

impl<'a> Piece<'a> {
    /// The piece without white space at both ends.
    pub(super) fn trimmed(self) -> Self {
        let text = self.text.trim_start();
        if text.is_empty() {
            // The position where something is missing.
            return Self { at: self.at, text };
        }
        Self { at: self.at + self.text.len() - text.len(), text: text.trim_end() }
    }

    /// The part from one byte to another, counted from the start of the piece.
    pub(super) fn part(self, from: usize, to: usize) -> Self {
        Self { at: self.at + from, text: self.text.get(from..to).unwrap_or_default() }
    }

    /// The byte after the piece.
    pub(super) fn end(self) -> usize {
        self.at + self.text.len()
    }
}

/// A line without its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// First byte of the line.
    pub(super) at: usize,
    pub(super) text: &'a str,
    /// First byte of the next line.
    pub(super) end: usize,
}

impl<'a> Line<'a> {
    pub(super) fn piece(&self) -> Piece<'a> {
        Piece { at: self.at, text: self.text }.trimmed()
    }
}

/// The lines of a piece of text that starts at this byte.
pub(super) fn lines(text: &str, at: usize) -> impl Iterator<Item = Line<'_>> {
    let mut next = at;
    text.split_inclusive('\n').map(move |line| {
        let at = next;
        next += line.len();
        Line { at, text: line.trim_end_matches(['\n', '\r']), end: next }
    })
}

/// The key and the value of a line `KEY: VALUE`.
pub(super) fn pair<'a>(line: &Line<'a>) -> Option<(Piece<'a>, Piece<'a>)> {
    let piece = line.piece();
    let colon = piece.text.find(':')?;
    let key = piece.part(0, colon).trimmed();
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    (!key.text.is_empty() && key.text.chars().all(is_word))
        .then(|| (key, piece.part(colon + 1, piece.text.len()).trimmed()))
}
