//! Wavefront OBJ files: Wavefront Technologies (1995), *Advanced Visualizer Manual*, appendix B1. Reads the
//! faces with their vertices, normals and texture coordinates; groups count as one, and materials are
//! ignored.
//!
//! The reader is our own so that every error has a line number, even in files of a million lines: a face may
//! refer to vertices that follow it, so faces are resolved at the end, and each stores its line.

use std::{borrow::Cow, str::FromStr};

use glam::{DVec3, Vec2, Vec3};

use super::model::{Builder, Corner, MAX_VERTICES};
use crate::{
    parameter::FileProblem,
    text::{after_mark, quoted, with_line_feeds},
};

/// Maximum number of corners of all faces, including those without area.
const MOST_NAMED: usize = 2 * MAX_VERTICES;
/// The rule for faces.
const FACE: &str = "a face (f) must name its corners as vertex, vertex/texture, vertex//normal or all three";
/// What a corner of a face names, each in the singular and in the plural.
const KINDS: [(&str, &str); 3] = [
    ("vertex", "vertices (v)"),
    ("texture coordinate", "texture coordinates (vt)"),
    ("normal", "normals (vn)"),
];

/// The statements of a text, each with its line: a backslash at the end of a line continues it on the next.
fn statements(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.split('\n').enumerate();
    std::iter::from_fn(move || {
        let (i, line) = lines.next()?;
        let continued = |line: &'_ str| line.strip_suffix('\r').unwrap_or(line).ends_with('\\');
        // A comment may end with a path.
        if !continued(line) || line.trim_start().starts_with('#') {
            return Some((i + 1, Cow::Borrowed(line)));
        }
        let mut whole = String::new();
        let mut part = line;
        while continued(part) {
            whole.push_str(part.trim_end_matches('\r').strip_suffix('\\').unwrap_or(part));
            whole.push(' ');
            part = lines.next().map_or("", |(_, line)| line);
        }
        whole.push_str(part);
        Some((i + 1, Cow::Owned(whole)))
    })
}

/// The first numbers of a statement; `None` if one of them is not a number.
fn numbers<'a, T: FromStr + Copy + Default, const N: usize>(
    words: &mut impl Iterator<Item = &'a str>,
) -> Option<[T; N]> {
    let mut numbers = [T::default(); N];
    for number in &mut numbers {
        *number = words.next()?.parse().ok()?;
    }
    Some(numbers)
}

/// Appends to a list of a file, which is limited to [`MAX_VERTICES`].
fn push<T>(list: &mut Vec<T>, item: T, what: &str) -> Result<(), Cow<'static, str>> {
    if list.len() == MAX_VERTICES {
        return Err(format!("the file has more than {MAX_VERTICES} {what}, the most allowed").into());
    }
    list.push(item);
    Ok(())
}

/// The references of a corner of a face: a vertex, a texture coordinate and a normal.
#[derive(Clone, Copy, Debug, Default)]
struct Named {
    /// Counted from 1; 0 for none.
    places: [u32; 3],
}

/// The lists of a file: vertices, texture coordinates and normals, and the faces that refer to them.
#[derive(Default)]
struct Lists {
    positions: Vec<DVec3>,
    textures: Vec<Vec2>,
    normals: Vec<Vec3>,
    named: Vec<Named>,
    /// The line of each face, and the end of its corners.
    faces: Vec<(usize, usize)>,
}

impl Lists {
    /// Reads a statement, or returns the rule that it breaks.
    fn statement(&mut self, line: usize, statement: &str) -> Result<(), Cow<'static, str>> {
        let mut words = statement.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let position = numbers(&mut words).ok_or("a vertex (v) must be three numbers")?;
                let position = DVec3::from_array(position);
                // A weight, or a colour.
                let more: Vec<_> = words.take(4).collect();
                let position = match more[..] {
                    [] | [_, _, _] => position,
                    [weight] => match weight.parse::<f64>() {
                        Ok(0.0) => return Err("the fourth number of a vertex (v) must not be 0".into()),
                        Ok(weight) => position / weight,
                        Err(_) => return Err("a vertex (v) must be three numbers".into()),
                    },
                    _ => return Err("a vertex (v) must be three numbers, or six with its colour".into()),
                };
                push(&mut self.positions, position, "vertices (v)")?;
            }
            Some("vt") => {
                let texture = numbers(&mut words).ok_or("a texture coordinate (vt) must be two numbers")?;
                push(&mut self.textures, Vec2::from_array(texture), "texture coordinates (vt)")?;
            }
            Some("vn") => {
                let normal = numbers(&mut words).ok_or("a normal (vn) must be three numbers")?;
                push(&mut self.normals, Vec3::from_array(normal), "normals (vn)")?;
            }
            Some("f") => {
                let begin = self.named.len();
                for word in words {
                    if self.named.len() == MOST_NAMED {
                        return Err(format!(
                            "the faces (f) have more than {MOST_NAMED} corners, the most allowed"
                        )
                        .into());
                    }
                    let named = self.corner(word)?;
                    self.named.push(named);
                }
                if self.named.len() == begin {
                    return Err(FACE.into());
                }
                self.faces.push((line, self.named.len()));
            }
            Some("usemtl") if words.next().is_none() => {
                return Err("a material (usemtl) must have a name".into());
            }
            _ => {}
        }
        Ok(())
    }

    /// The references of a corner of a face. Negative numbers count back from the last item read.
    fn corner(&self, word: &str) -> Result<Named, Cow<'static, str>> {
        let counts = [self.positions.len(), self.textures.len(), self.normals.len()].map(|n| n as u32);
        let mut named = Named::default();
        for (i, part) in word.split('/').enumerate() {
            let Some(place) = named.places.get_mut(i) else { return Err(FACE.into()) };
            // A texture or a normal may be omitted.
            if part.is_empty() && i > 0 {
                continue;
            }
            let number: i64 = part.parse().map_err(|_| wrong_number(i, part))?;
            let back = u32::try_from(number.unsigned_abs()).unwrap_or(u32::MAX);
            *place = match number {
                1.. => back,
                _ => (counts[i] + 1)
                    .checked_sub(back)
                    .filter(|place| number < 0 && *place > 0)
                    .ok_or_else(|| beyond(i, part, counts[i]))?,
            };
        }
        Ok(named)
    }

    /// The corner to which a face refers, or the reason why it does not exist.
    fn resolved(&self, named: Named) -> Result<Corner, Cow<'static, str>> {
        let [position, texture, normal] = named.places;
        fn at<T: Copy>(list: &[T], kind: usize, place: u32) -> Result<Option<T>, Cow<'static, str>> {
            let Some(index) = place.checked_sub(1) else { return Ok(None) };
            list.get(index as usize)
                .copied()
                .map(Some)
                .ok_or_else(|| beyond(kind, &place.to_string(), list.len() as u32))
        }
        Ok(Corner {
            position: at(&self.positions, 0, position)?.unwrap_or_default(),
            texture: at(&self.textures, 1, texture)?,
            normal: at(&self.normals, 2, normal)?,
        })
    }
}

/// The message about a reference that is not a number, or one that no computer counts to.
fn wrong_number(kind: usize, written: &str) -> Cow<'static, str> {
    let digits = written.trim_start_matches(['+', '-']);
    if digits.is_empty() || digits.contains(|c: char| !c.is_ascii_digit()) {
        return FACE.into();
    }
    let number = crate::text::shortened(written);
    let (one, all) = KINDS[kind];
    format!("this face (f) names the {one} {number}, but a file has at most {MAX_VERTICES} {all}").into()
}

/// The message about an invalid reference of a face.
fn beyond(kind: usize, written: &str, count: u32) -> Cow<'static, str> {
    let (one, all) = KINDS[kind];
    let have = match count {
        0 => format!("the file has no {all}"),
        1 => format!("there is only 1 of the {all}"),
        n => format!("there are {n} {all}"),
    };
    format!(
        "this face (f) names the {one} {}, but {have}; they are counted from 1, or back from −1",
        quoted(written).trim_matches('"')
    )
    .into()
}

/// Reads the polygons of a file, and returns how many faces it has.
pub fn read(bytes: &[u8], to: &mut Builder) -> Result<usize, FileProblem> {
    // Comments may be in any encoding.
    let text = String::from_utf8_lossy(after_mark(bytes));
    let text = with_line_feeds(&text);
    let at =
        |line: usize| move |what: Cow<'_, str>| FileProblem { line: Some(line), message: what.into_owned() };
    let mut lists = Lists::default();
    for (line, statement) in statements(&text) {
        lists.statement(line, &statement).map_err(at(line))?;
    }
    let mut begin = 0;
    let mut corners = Vec::new();
    for (line, end) in &lists.faces {
        corners.clear();
        for named in &lists.named[begin..*end] {
            corners.push(lists.resolved(*named).map_err(at(*line))?);
        }
        begin = *end;
        to.polygon(&corners).map_err(|what| at(*line)(what.into()))?;
    }
    Ok(lists.faces.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{PolygonMesh, mesh_file::model::Model};

    fn result(text: &[u8]) -> Result<Vec<f32>, String> {
        let mut builder = Builder::default();
        read(text, &mut builder)
            .map_err(|FileProblem { line, message }| format!("{}: {message}", line.unwrap_or_default()))?;
        builder.numbers()
    }

    fn mesh(text: &str, own_normals: bool) -> PolygonMesh {
        match result(text.as_bytes()) {
            Ok(numbers) => Model::new(&numbers).expect("a model").mesh(own_normals),
            Err(what) => panic!("{what} in {text}"),
        }
    }

    const SQUARE: &str = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";

    #[test]
    fn faces_of_any_form_have_the_corners_of_the_file() {
        let expected = [[-0.5, -0.25], [0.5, -0.25], [0.5, 0.25], [-0.5, 0.25]];
        let extra = "# a comment\nvt 0 0\nvn 0 0 5\n";
        for face in [
            "f 1 2 3 4",
            "f 1/1 2/1 3/1 4/1",
            "f 1//1 2//1 3//1 4//1",
            "f 1/1/1 2/1/1 3/1/1 4/1/1",
            "f -4 -3 -2 -1",
        ] {
            let mesh = mesh(&format!("mtllib ../secret.mtl\no square\n{SQUARE}{extra}{face}\r\n"), true);
            assert_eq!(mesh.polygons.len(), 1, "{face}");
            assert_eq!(mesh.polygons[0].corners(), [0, 1, 2, 3], "{face}");
            assert_eq!(mesh.positions, expected.map(|[x, y]| Vec3::new(x, y, 0.0)), "{face}");
            assert_eq!(mesh.vertex_normals(), [Vec3::Z; 4]);
        }
    }

    #[test]
    fn a_mark_at_the_beginning_and_old_line_ends_lose_nothing() {
        let whole = mesh(&format!("{SQUARE}f 1 2 3 4\n"), false);
        let marked = format!("\u{feff}{SQUARE}f 1 2 3 4\n");
        assert_eq!(mesh(&marked, false), whole);
        assert_eq!(mesh(&marked.replace('\n', "\r\n"), false), whole);
        assert_eq!(mesh(&marked.replace('\n', "\r"), false), whole);
        // Faces may come before their vertices.
        assert_eq!(mesh(&format!("f 1 2 3 4\n{SQUARE}"), false), whole);
    }

    #[test]
    fn a_backslash_continues_a_line_in_the_next() {
        let whole = mesh(&format!("{SQUARE}f 1 2 3 4\n"), false);
        for end in ["\\\n", "\\\r\n"] {
            let cut = SQUARE.replacen("v 2 0 0", &format!("v 2{end} 0{end}0"), 1);
            let text = format!("# C:\\models{end}{cut}f 1 2{end}3{end} 4");
            assert_eq!(mesh(&text, false), whole, "{text}");
            // An error is on the line where its statement begins, and those after it are on theirs.
            for (more, expected) in [("x\n", "7: a face (f)"), ("3\nv one\n", "10: a vertex (v)")] {
                let said = result(format!("{cut}f 1{end} 2{end} {more}").as_bytes()).expect_err(more);
                assert!(said.starts_with(expected), "{said}");
            }
        }
    }

    #[test]
    fn faces_of_several_groups_share_the_points_that_they_have_in_common() {
        let text = format!("g a\n{SQUARE}f 1 2 3\ng b\nf 3 4 1\nl 1 2\np 1\nf 1 2 2\n");
        let mesh = mesh(&text, false);
        assert_eq!((mesh.positions.len(), mesh.polygons.len()), (4, 2));
        assert_eq!(mesh.vertex_normals(), [Vec3::Z; 4]);
        // Five corners become three triangles.
        let five = format!("{SQUARE}v 1 3 0\nf 1 2 3 5 4\nf 1 2 3\nf 1 2 3 4\n");
        assert_eq!(super::tests::mesh(&five, false).polygons.len(), 5);
    }

    #[test]
    fn normals_are_those_of_the_file_if_wanted() {
        let text = format!("{SQUARE}vn 0 3 4\nvn 0 0 1\nf 1//1 2//1 3//2 4//2\n");
        let own = mesh(&text, true).vertex_normals();
        assert_eq!(own, [Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.0, 0.6, 0.8), Vec3::Z, Vec3::Z]);
        assert_eq!(mesh(&text, false).vertex_normals(), [Vec3::Z; 4]);
    }

    #[test]
    fn mistakes_are_told_with_their_lines() {
        for (text, expected) in [
            ("v 0 0\nf 1 1 1", "1: a vertex (v) must be three numbers"),
            ("v 0 0 0\nv one 0 0\n", "2: a vertex (v) must be three numbers"),
            ("v 0 0 0 0\n", "1: the fourth number of a vertex (v) must not be 0"),
            ("v 0 0 0 1 1\n", "1: a vertex (v) must be three numbers, or six"),
            ("\n\nvn 0 0\n", "3: a normal (vn) must be three numbers"),
            ("vt 0\n", "1: a texture coordinate (vt) must be two numbers"),
            ("v 0 0 0\nf a b c\n", "2: a face (f) must name its corners"),
            ("v 0 0 0\nf 1/1/1/1 1 1\n", "2: a face (f) must name its corners"),
            (
                "v 0 0 0\nf 1 2 3\n",
                "2: this face (f) names the vertex 2, but there is only 1 of the vertices (v); they",
            ),
            ("v 0 0 0\nf -1 -2 -3\n", "2: this face (f) names the vertex -2, but there is only 1"),
            ("v 0 0 0\nf 0 0 0\n", "2: this face (f) names the vertex 0, but there is only 1"),
            (
                "v 0 0 0\nvn 0 0 1\nf 1//9 1//1 1//1\n",
                "3: this face (f) names the normal 9, but there is only 1",
            ),
            ("v 0 0 0\nvt 0 0\nf 1/9 1/1 1/1\n", "3: this face (f) names the texture coordinate 9, but"),
            (
                "v 0 0 0\n\nf 1/1 1/1 1/1\n",
                "3: this face (f) names the texture coordinate 1, but the file has no",
            ),
            (
                "v 0 0 0\n\nf 1//1 1//1 1//1\n",
                "3: this face (f) names the normal 1, but the file has no normals",
            ),
            (
                "v 0 0 0\nvt 0 0\nvt 1 1\nf 1/-3 1/1 1/1\n",
                "4: this face (f) names the texture coordinate -3, but there are 2",
            ),
            ("v 0 0 0\nvn 0 0 1\nf 1/0/1 1//1 1//1\n", "3: this face (f) names the texture coordinate 0"),
            ("f\n", "1: a face (f) must name its corners"),
            ("v 0 0 0\nf /1 1 1\n", "2: a face (f) must name its corners"),
            (
                "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "4: a corner of polygon 1 is at (NaN, 0, 0), but positions must be finite",
            ),
            ("v 1e99 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "4: a corner of polygon 1 is at (inf, 0, 0)"),
            ("usemtl\n", "1: a material (usemtl) must have a name"),
            ("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "it has no polygons with an area"),
        ] {
            let said = result(text.as_bytes()).expect_err(text);
            assert!(said.starts_with(expected), "{said}\n{expected}");
        }
    }

    #[test]
    fn files_with_any_byte_changed_are_read_or_refused() {
        let text =
            format!("o a\n{SQUARE}vn 0 0 1\nvt 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -1//-1 -2//1 -4//1\n");
        for i in 0..text.len() {
            for byte in [0, b'-', b'9', b'/', b'f', b'\n', b' ', 0xff] {
                let mut bytes = text.clone().into_bytes();
                bytes[i] = byte;
                if let Ok(numbers) = result(&bytes) {
                    let mesh = Model::new(&numbers).expect("a model").mesh(true);
                    assert!(mesh.positions.iter().all(|p| p.is_finite()), "byte {i} is {byte}");
                }
            }
        }
        for index in
            ["9223372036854775807", "-9223372036854775808", "6148914691236517206", "99999999999999999999"]
        {
            assert!(
                result(format!("{SQUARE}vn 0 0 1\nvt 0 1\nf {index} 1 2\n").as_bytes()).is_err(),
                "{index}"
            );
            for corner in [format!("1/{index}/1"), format!("1/1/{index}")] {
                let text = format!("{SQUARE}vn 0 0 1\nvt 0 1\nf {corner} 2/1/1 3/1/1\n");
                assert!(result(text.as_bytes()).is_err(), "{corner}");
            }
        }
    }
}
