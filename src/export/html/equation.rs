//! Equations and symbols as HTML: italic letters, upright words, subscripts and superscripts.

pub use crate::text::xml::marked as escaped;

use crate::text::mathematics::{Atom, parse, parse_symbol};

/// An equation. Several definitions in one, with commas between them, each go to the next line as a whole.
#[must_use]
pub fn equation(text: &str) -> String {
    let set = |part: &str| parse(part).iter().map(atom).collect::<String>();
    match definitions(text).as_slice() {
        [_] => set(text),
        all => {
            let whole = |part: &&str| format!("<span class=\"whole\">{}</span>", set(part));
            all.iter().map(whole).collect::<Vec<_>>().join(", ")
        }
    }
}

/// The definitions of an equation: it ends one at each comma outside brackets with another one behind it.
fn definitions(text: &str) -> Vec<&str> {
    let (mut depth, mut commas) = (0, Vec::new());
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' | '⟨' => depth += 1,
            ')' | ']' | '}' | '⟩' => depth -= 1,
            ',' if depth == 0 && text[at..].starts_with(", ") => commas.push(at),
            _ => {}
        }
    }
    let (mut all, mut start) = (Vec::new(), 0);
    for (i, at) in commas.iter().enumerate() {
        let end = commas.get(i + 1).copied().unwrap_or(text.len());
        if text[*at..end].contains(" = ") {
            all.push(&text[start..*at]);
            start = at + ", ".len();
        }
    }
    all.push(&text[start..]);
    all
}

/// The symbol of a parameter.
#[must_use]
pub fn symbol(text: &str) -> String {
    if text.is_empty() { String::new() } else { atom(&parse_symbol(text)) }
}

fn atom(atom: &Atom) -> String {
    let base = match atom {
        Atom::Space => return " ".to_owned(),
        Atom::Symbol { base, .. } => format!("<i>{}</i>", escaped(base)),
        Atom::Upright { base, .. } => escaped(base),
    };
    let script = |tag: &str, text: &str| match text {
        "" => String::new(),
        text => format!("<{tag}>{}</{tag}>", equation(text)),
    };
    base + &script("sub", atom.sub()) + &script("sup", atom.sup())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::Registry;

    #[test]
    fn letters_are_slanted_and_scripts_stand_in_their_places() {
        assert_eq!(
            equation("I_d = max(0, N·L)^α"),
            "<i>I</i><sub><i>d</i></sub> = max(0, <i>N</i>·<i>L</i>)<sup><i>α</i></sup>"
        );
        assert_eq!(equation("F_{90}^{−x^2}"), "<i>F</i><sub>90</sub><sup>−<i>x</i><sup>2</sup></sup>");
        let tower = "<i>x</i><sup><i>y</i><sup><i>z</i></sup></sup>";
        assert_eq!([equation("x^y^z"), equation("x^{y^z}")], [tower, tower]);
        assert_eq!(symbol("α_x"), "<i>α</i><sub><i>x</i></sub>");
        assert_eq!(symbol(""), "");
    }

    #[test]
    fn each_of_several_definitions_is_kept_whole() {
        let whole = |part: &str| format!("<span class=\"whole\">{part}</span>");
        let [a, b] = ["<i>D</i> = <i>a</i>, <i>b</i>", "<i>r</i> = max(0, <i>c</i>)"].map(whole);
        assert_eq!(equation("D = a, b, r = max(0, c)"), format!("{a}, {b}"));
        for text in ["F = max(0, a = b), c", "f(a, b) = c if d, and e"] {
            assert!(!equation(text).contains("whole"), "{text}");
        }
    }

    #[test]
    fn what_users_write_is_no_markup() {
        assert_eq!(equation("a < b & \"c\""), "<i>a</i> &lt; <i>b</i> &amp; &quot;<i>c</i>&quot;");
        assert!(!symbol("<b>_<script>").contains("<script"));
    }

    #[test]
    fn every_mark_of_every_equation_is_set() {
        for model in Registry::builtin().models() {
            for part in model.declaration.equation {
                let html = equation(part.text);
                assert!(!html.contains(['_', '^', '{', '}']), "{html}");
                for tag in ["i", "sub", "sup"] {
                    let count = |mark: String| html.matches(&mark).count();
                    assert_eq!(count(format!("<{tag}>")), count(format!("</{tag}>")), "{html}");
                }
            }
        }
    }
}
