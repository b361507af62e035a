//! Writes XML: nested, indented elements. The writer is our own, since a few lines suffice: nothing is read back, and
//! the export needs only elements, attributes and comments.

use std::fmt::Write as _;

use glam::{Mat4, Vec3};

use crate::{files::printable, text::xml::comment};

/// An element: a plugin or one of its properties, containing elements and comments.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Xml {
    /// Name and attributes: `shape type="ply"`.
    open: String,
    within: Vec<Xml>,
}

impl Xml {
    /// A plugin: `<bsdf type="diffuse">`.
    pub(super) fn plugin(kind: &str, name: &str) -> Self {
        Self { open: format!("{kind} type=\"{name}\""), within: Vec::new() }
    }

    /// An element with these attributes.
    pub(super) fn element(open: impl Into<String>) -> Self {
        Self { open: open.into(), within: Vec::new() }
    }

    /// The element with a child added.
    pub(super) fn with(mut self, child: Self) -> Self {
        self.within.push(child);
        self
    }

    /// The element with a comment added.
    pub(super) fn says(self, text: &str) -> Self {
        self.with(Self { open: format!("!-- {} --", harmless(text)), within: Vec::new() })
    }

    /// The element with a property added: `<float name="fov" value="45"/>`.
    pub(super) fn set(self, kind: &str, name: &str, value: &str) -> Self {
        self.with(Self::element(format!("{kind} name=\"{name}\" value=\"{value}\"")))
    }

    /// The element with a number added.
    pub(super) fn float(self, name: &str, value: f32) -> Self {
        self.set("float", name, &number(value))
    }

    /// The element with a colour, or three numbers for red, green and blue, added.
    pub(super) fn rgb(self, name: &str, value: Vec3) -> Self {
        self.set("rgb", name, &triple(value))
    }

    /// The text of a file with this element.
    pub(super) fn file(&self, about: &str) -> String {
        let mut text = format!("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- {} -->\n", harmless(about));
        self.write(&mut text, 0);
        text
    }

    fn write(&self, text: &mut String, depth: usize) {
        let Self { open, within } = self;
        let space = "    ".repeat(depth);
        let name = open.split(' ').next().unwrap_or_default();
        // Writing to a String cannot fail.
        let _ = match within.as_slice() {
            _ if open.starts_with('!') => writeln!(text, "{space}<{open}>"),
            [] => writeln!(text, "{space}<{open}/>"),
            _ => writeln!(text, "{space}<{open}>"),
        };
        within.iter().for_each(|child| child.write(text, depth + 1));
        if !within.is_empty() {
            let _ = writeln!(text, "{space}</{name}>");
        }
    }
}

/// A text that cannot end a comment.
fn harmless(text: &str) -> String {
    comment(&printable(text))
}

/// A number with the digits to restore it exactly.
pub(super) fn number(value: f32) -> String {
    format!("{value}")
}

/// A transformation in the room.
pub(super) fn to_world(matrix: Mat4) -> Xml {
    let rows: Vec<_> = matrix.transpose().to_cols_array().iter().map(f32::to_string).collect();
    let matrix = Xml::element(format!("matrix value=\"{}\"", rows.join(" ")));
    Xml::element("transform name=\"to_world\"").with(matrix)
}

/// The transform of a thing at a position that looks in a direction.
pub(super) fn look_at(position: Vec3, direction: Vec3, up: Vec3) -> Xml {
    let [origin, target, up] = [position, position + direction, up].map(triple);
    let look = Xml::element(format!("lookat origin=\"{origin}\" target=\"{target}\" up=\"{up}\""));
    Xml::element("transform name=\"to_world\"").with(look)
}

/// Three numbers.
fn triple(value: Vec3) -> String {
    format!("{}, {}, {}", value.x, value.y, value.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_indented_and_comments_end_where_they_should() {
        let xml = Xml::element("scene version=\"3.5.0\"")
            .says("a --> b\u{1b}")
            .with(Xml::plugin("bsdf", "diffuse").rgb("reflectance", Vec3::new(1.0, 0.5, 1e-7)));
        let expected = r#"<?xml version="1.0" encoding="utf-8"?>
<!-- about -->
<scene version="3.5.0">
    <!-- a - -> b\u{1b} -->
    <bsdf type="diffuse">
        <rgb name="reflectance" value="1, 0.5, 0.0000001"/>
    </bsdf>
</scene>
"#;
        assert_eq!(xml.file("about"), expected);
    }
}
