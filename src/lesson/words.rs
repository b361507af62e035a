//! Pieces of a text that know their place: lines, and the pairs `KEY: VALUE`.

/// A piece of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Piece<'a> {
    /// Its first byte in the whole text.
    pub(super) at: usize,
    pub(super) text: &'a str,
}

impl<'a> Piece<'a> {
    /// Without white space at both ends.
    pub(super) fn trimmed(self) -> Self {
        let text = self.text.trim_start();
        if text.is_empty() {
            // The place where something is missing.
            return Self { at: self.at, text };
        }
        Self { at: self.at + self.text.len() - text.len(), text: text.trim_end() }
    }

    /// The part from one byte to another, counted from its first.
    pub(super) fn part(self, from: usize, to: usize) -> Self {
        Self { at: self.at + from, text: self.text.get(from..to).unwrap_or_default() }
    }

    /// The byte after it.
    pub(super) fn end(self) -> usize {
        self.at + self.text.len()
    }
}

/// A line without its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// Its first byte.
    pub(super) at: usize,
    pub(super) text: &'a str,
    /// The first byte of the next line.
    pub(super) end: usize,
}

impl<'a> Line<'a> {
    pub(super) fn piece(&self) -> Piece<'a> {
        Piece { at: self.at, text: self.text }.trimmed()
    }
}

/// The lines of a piece of a text that begins at a byte of it.
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
