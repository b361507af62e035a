//! The texts of the report: HTML with places for values.
//!
//! `{name}` is a value as it is, `{name:2}` a number with two decimals, `{name:%1}` in per cent with one, `{name:±}` a
//! difference in per cent with its sign. The text between `{if name}` and `{end}`, perhaps with an `{else}`, is kept if
//! a value is true. `{figure}` and `{table}` are the next numbers of these. Line breaks and the indentation of lines
//! are left out.

use maud::{Markup, PreEscaped, html};

use super::{Chapter, Lab, StudyError, Table, fixed, percent, share};
use crate::declared::from;

/// A value in a text.
pub(super) enum Value {
    Number(f64),
    Flag(bool),
    Html(Markup),
}

from! {
    Value;
    f64: |v| Self::Number(v);
    usize: |n| Self::Number(n as f64);
    bool: |is| Self::Flag(is);
    Markup: |html| Self::Html(html);
    String: |text| Self::Html(html! { (text) });
    &str: |text| Self::Html(html! { (text) });
}

/// Values with their names in texts.
pub(super) type Values = Vec<(&'static str, Value)>;

/// Makes [`Values`]: `values! { wins, share: 0.5 }`.
macro_rules! values {
    ($($name:ident $(: $value:expr)?),* $(,)?) => {
        vec![$((stringify!($name), $crate::study::text::values!(@ $name $($value)?))),*]
    };
    (@ $name:ident) => { $crate::study::text::Value::from($name) };
    (@ $name:ident $value:expr) => { $crate::study::text::Value::from($value) };
}
pub(super) use values;

impl Value {
    /// The value as the text wants it.
    fn written(&self, form: &str) -> String {
        match (self, form) {
            (Self::Flag(is), _) => is.to_string(),
            (Self::Html(html), _) => html.0.clone(),
            (Self::Number(v), "") => v.to_string(),
            (Self::Number(v), "±") => percent(*v),
            (Self::Number(v), form) => match form.strip_prefix('%') {
                Some(digits) => share(*v, digits.parse().unwrap_or_default()),
                None => fixed(*v, form.parse().unwrap_or_default()),
            },
        }
    }
}

/// The value with a name.
fn named<'v>(values: &'v [(&str, Value)], name: &str) -> Result<&'v Value, StudyError> {
    let found = values.iter().find(|(known, _)| *known == name);
    let missing = || StudyError::Data(format!("a text of the report has no value {name}"));
    found.map(|(_, value)| value).ok_or_else(missing)
}

impl Lab<'_> {
    /// A text with its values.
    pub(super) fn filled(&mut self, text: &str, values: &[(&str, Value)]) -> Result<Markup, StudyError> {
        let text: String = text.lines().map(str::trim_start).collect();
        let mut parts = text.split('{');
        let mut filled = parts.next().unwrap_or_default().to_owned();
        // The conditions around a place, the innermost last.
        let mut met: Vec<bool> = Vec::new();
        for part in parts {
            let (place, rest) = part.split_once('}').unwrap_or((part, ""));
            let (name, form) = place.split_once(':').unwrap_or((place, ""));
            let mut written = String::new();
            match name.strip_prefix("if ") {
                Some(name) => met.push(matches!(named(values, name)?, Value::Flag(true))),
                None if name == "else" => met.last_mut().into_iter().for_each(|met| *met = !*met),
                None if name == "end" => _ = met.pop(),
                None if name == "figure" || name == "table" => {
                    let number = if name == "figure" { &mut self.figures } else { &mut self.tables };
                    *number += u32::from(met.iter().all(|met| *met));
                    written = number.to_string();
                }
                None => written = named(values, name)?.written(form),
            }
            if met.iter().all(|met| *met) {
                filled.extend([&*written, rest]);
            }
        }
        Ok(PreEscaped(filled))
    }

    /// A chapter. The first line of its text is the title, the second one the finding.
    pub(super) fn chapter(
        &mut self,
        text: &'static str,
        values: &[(&str, Value)],
        shown: bool,
        tables: Vec<Table>,
    ) -> Result<Chapter, StudyError> {
        let mut lines = text.splitn(3, '\n');
        let mut line = || lines.next().unwrap_or_default();
        let (title, finding, body) = (line(), line(), line());
        let (finding, body) = (self.filled(finding, values)?, self.filled(body, values)?);
        Ok(Chapter { title, body, finding, shown, tables })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{registry::Registry, study::Settings};

    #[test]
    fn a_text_has_its_values() {
        let registry = Registry::builtin();
        let mut lab = Lab { registry: &registry, settings: Settings::default(), figures: 2, tables: 0 };
        let values = values! { x: -0.126, n: 3usize, yes: true, no: false, name: "<b>" };
        let mut filled = |text: &str| lab.filled(text, &values).map(|html| html.0).ok();
        assert_eq!(filled("a\n  {x} {x:2}\n {n}, {name}").as_deref(), Some("a-0.126 −0.133, &lt;b&gt;"));
        assert_eq!(filled("{x:%1} {x:±}").as_deref(), Some("−12.6\u{a0}% −12.6\u{a0}%"));
        let nested = "{if no}{figure}{if yes}1{end}{else}2{if yes}3{else}4{end}5{end}6{figure}";
        assert_eq!(filled(nested).as_deref(), Some("23563"));
        assert_eq!(filled("{if no}{y}{end}"), None);
    }
}
