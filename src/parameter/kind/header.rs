//! Declarations of parameters in custom models: the code common to several kinds.

use super::{ABOVE_ZERO, Cursor, Fields, Json, ParameterKind, Reader, text};

/// A type of parameters in custom models.
pub struct Type {
    /// The name.
    pub name: &'static str,
    /// The keys of the type, besides the default.
    pub keys: &'static [&'static str],
    /// True if a declaration that names no type is of this one. A declaration that fits several types must name one;
    /// one that fits none is of the first.
    pub fits: fn(&Fields) -> bool,
    /// Reads a declaration.
    pub read: fn(&mut Header) -> Option<ParameterKind>,
}

/// A declaration that is read.
pub struct Header<'h> {
    /// The reader.
    pub reader: &'h mut dyn Declarations,
    /// The given keys.
    pub fields: &'h Fields<'h, 'h>,
    /// The kind of the built-in parameter with the same name, from which the rest is taken.
    pub shared: Option<&'h ParameterKind>,
}

/// The reader of a custom model.
pub trait Declarations: Reader {
    /// The name of each choice in files, and that in the window.
    fn choices(&mut self, value: Cursor) -> Option<&'static [(&'static str, &'static str)]>;

    /// The index of one of several words.
    fn index(&mut self, value: Cursor, what: &str, words: &[&'static str]) -> Option<usize>;
}

/// Reads one value.
type Read<T> = fn(&mut dyn Declarations, Cursor) -> Option<T>;

/// A finite 32-bit number.
pub(super) fn number(reader: &mut dyn Declarations, value: Cursor) -> Option<f32> {
    let number = value.number().filter(|n| n.is_finite());
    if number.is_none() {
        reader.wrong(value, value.too_large().unwrap_or("it must be a number"));
    }
    number
}

/// True if a declaration has choices.
pub(super) fn has_choices(fields: &Fields) -> bool {
    fields.get("choices").is_some()
}

/// True if the default is a list, and not a mistake in a declaration with choices.
pub(super) fn has_list(fields: &Fields) -> bool {
    !has_choices(fields) && fields.get("default").is_some_and(|default| default.list().is_some())
}

impl Header<'_> {
    /// An optional field; `None` only if it is invalid.
    pub(super) fn given<T>(&mut self, key: &str, read: Read<T>) -> Option<Option<T>> {
        self.fields.get(key).map_or(Some(None), |value| read(self.reader, value).map(Some))
    }

    /// Minimum and maximum, from `range`, or from `min` or `above`, and `max`.
    pub(super) fn limits<T: Copy + PartialOrd>(
        &mut self,
        (min, max): (T, Option<T>),
        read: Read<T>,
        above_zero: Option<T>,
    ) -> Option<(T, Option<T>)> {
        let (mut low, mut high) = (min, max);
        let fields = self.fields;
        if let Some(value) = fields.get("range") {
            if let Some(other) = ["min", "max", "above"].into_iter().find(|key| fields.get(key).is_some()) {
                let predicate = format!("conflicts with {other}; a range is [min, max]");
                self.reader.report(value.start(), value.path(), None, &predicate);
                return None;
            }
            let Some(list) = value.list().filter(|list| list.len() == 2) else {
                self.reader.wrong(value, "a range must be two numbers: [min, max]");
                return None;
            };
            let ends: Vec<_> = list.map(|end| read(self.reader, end)).collect();
            (low, high) = (ends[0]?, Some(ends[1]?));
        }
        let (least, most) = (self.given("min", read), self.given("max", read));
        if let Some(value) = fields.get("above") {
            let zero = value.integer() == Some(0);
            let Some(above) = above_zero.filter(|_| zero && fields.get("min").is_none()) else {
                self.reader.wrong(value, "it must be 0; it replaces min and means greater than 0");
                return None;
            };
            low = above;
        }
        (low, high) = (least?.unwrap_or(low), most?.or(high));
        if high.is_some_and(|h| h <= low) {
            let value = ["max", "range", "min", "above"].into_iter().find_map(|key| fields.get(key))?;
            self.reader.wrong(value, "the largest value must be greater than the smallest");
            return None;
        }
        Some((low, high))
    }

    /// The range and the default of real numbers; `usual` are those of the shared parameter.
    pub(super) fn real(
        &mut self,
        usual: Option<(f32, f32, [f32; 3])>,
        read: Read<[f32; 3]>,
    ) -> Option<(f32, f32, [f32; 3])> {
        let (min, max, _) = usual.unwrap_or((0.0, 1.0, [0.0; 3]));
        let limits = self.limits((min, Some(max)), number, Some(ABOVE_ZERO));
        let given = self.given("default", read)?;
        let (min, max) = limits?;
        let max = max.unwrap_or(1.0);
        let usual = usual.map(|(.., usual)| usual).filter(|u| u.iter().all(|v| (min..=max).contains(v)));
        Some((min, max, given.or(usual).unwrap_or([0.5 * min + 0.5 * max; 3])))
    }

    /// The declaration, if its default is within the range.
    pub(super) fn within(&mut self, kind: ParameterKind) -> Option<ParameterKind> {
        if kind.allows(&kind.default_value()) {
            return Some(kind);
        }
        let rule = format!("it must be {}", kind.rule());
        match self.fields.get("default") {
            Some(value) => self.reader.wrong(value, &rule),
            None => self.reader.lacking(self.fields, "default", &rule),
        }
        None
    }
}

/// The keys of the ends of a range.
pub(super) fn ends(min: f32, max: f32) -> Vec<(&'static str, Json)> {
    let least = if min == ABOVE_ZERO { ("above", 0.into()) } else { ("min", text::number(min)) };
    vec![least, ("max", text::number(max))]
}
