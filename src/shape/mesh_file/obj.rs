//! Wavefront OBJ files: Wavefront Technologies (1995), *Advanced Visualizer Manual*, appendix B1. Read are the faces with
//! their vertices, normals and texture coordinates; groups count as one, and materials are not read.

use std::{
    collections::HashMap,
    io::{self, BufRead, Read},
};

use glam::{Vec2, Vec3};
use tobj::{LoadError, LoadOptions};

use super::model::{Builder, Corner};
use crate::parameter::FileProblem;

/// A text that knows how many lines were read.
struct Counted<'a> {
    rest: &'a [u8],
    lines: usize,
}

impl Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.rest[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Counted<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        Ok(self.rest)
    }

    fn consume(&mut self, amount: usize) {
        let (read, rest) = self.rest.split_at(amount.min(self.rest.len()));
        self.lines += read.iter().filter(|b| **b == b'\n').count();
        // A last line may lack its end.
        self.lines += usize::from(rest.is_empty() && read.last().is_some_and(|b| *b != b'\n'));
        self.rest = rest;
    }
}

/// The text with each statement in one line: a backslash at the end of a line continues it in the next. The empty lines
/// that follow keep the others at their numbers.
fn joined(text: &str) -> String {
    let mut joined = String::with_capacity(text.len());
    let mut held = 0;
    for line in text.split_inclusive('\n') {
        let end = ["\\\n", "\\\r\n"].into_iter().find_map(|end| line.strip_suffix(end));
        // A comment may end with a path.
        match end.filter(|_| held > 0 || !line.trim_start().starts_with('#')) {
            Some(begin) => {
                joined.push_str(begin);
                joined.push(' ');
                held += 1;
            }
            None => {
                joined.push_str(line);
                joined.extend(std::iter::repeat_n('\n', std::mem::take(&mut held)));
            }
        }
    }
    joined
}

/// Reads the polygons of a file.
pub fn read(bytes: &[u8], to: &mut Builder) -> Result<(), FileProblem> {
    let problem = |line: Option<usize>, message: String| FileProblem { line, message };
    // Comments are in any encoding.
    let text = joined(&String::from_utf8_lossy(bytes));
    let mut counted = Counted { rest: text.as_bytes(), lines: 0 };
    let options =
        LoadOptions { single_index: false, triangulate: false, ignore_points: true, ignore_lines: true };
    let no_materials = |_: &std::path::Path| Ok((Vec::new(), HashMap::new()));
    let read = tobj::load_obj_buf(&mut counted, &options, no_materials);
    let (models, _) = read.map_err(|error| {
        let (message, has_line) = told(error);
        problem(Some(counted.lines).filter(|line| has_line && *line > 0), message)
    })?;
    for tobj::Model { mesh, .. } in models {
        let vector =
            |of: &[f32], i: u32| of.as_chunks().0.get(i as usize).map(|v: &[f32; 3]| Vec3::from_array(*v));
        let mut begin = 0;
        let triangles = mesh.face_arities.is_empty().then_some(3);
        let faces = mesh.indices.len() / 3;
        let counts = mesh.face_arities.iter().copied().chain(triangles.into_iter().cycle().take(faces));
        for count in counts {
            let corners = (begin..begin + count as usize).map(|k| {
                let normal = mesh.normal_indices.get(k).and_then(|i| vector(&mesh.normals, *i));
                let texture =
                    mesh.texcoord_indices.get(k).and_then(|i| mesh.texcoords.as_chunks().0.get(*i as usize));
                Some(Corner {
                    position: vector(&mesh.positions, *mesh.indices.get(k)?)?,
                    normal,
                    texture: texture.map(|uv: &[f32; 2]| Vec2::from_array(*uv)),
                })
            });
            let corners: Vec<_> = corners.flatten().collect();
            to.polygon(&corners).map_err(|what| problem(None, what))?;
            begin += count as usize;
        }
    }
    Ok(())
}

/// A mistake in words, and whether it is in the line that was read last.
fn told(error: LoadError) -> (String, bool) {
    let beyond = |what: &str, letters: &str| {
        let rule = format!(
            "a face (f) names {what} that there is none of: {letters} are counted from 1, or back from −1"
        );
        (rule, false)
    };
    let (message, has_line) = match error {
        LoadError::PositionParseError => ("a vertex (v) must be three numbers", true),
        LoadError::ScalingByZeroError => ("the fourth number of a vertex (v) must not be 0", true),
        LoadError::ColorParseError => ("a vertex (v) must be three numbers, or six with its colour", true),
        LoadError::NormalParseError => ("a normal (vn) must be three numbers", true),
        LoadError::TexcoordParseError => ("a texture coordinate (vt) must be two numbers", true),
        LoadError::FaceParseError => {
            ("a face (f) must name its corners as vertex, vertex/texture, vertex//normal or all three", true)
        }
        LoadError::MaterialParseError => ("a material (usemtl) must have a name", true),
        LoadError::FaceVertexOutOfBounds => return beyond("a vertex", "vertices (v)"),
        LoadError::FaceTexCoordOutOfBounds => {
            return beyond("a texture coordinate", "texture coordinates (vt)");
        }
        LoadError::FaceNormalOutOfBounds => return beyond("a normal", "normals (vn)"),
        LoadError::FaceColorOutOfBounds => ("either all vertices (v) must have a colour, or none", false),
        other => return (format!("it is no valid OBJ file: {other}"), true),
    };
    (message.to_owned(), has_line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{PolygonMesh, mesh_file::model::Model};

    fn numbers(text: &[u8]) -> Result<Vec<f32>, String> {
        let mut builder = Builder::default();
        read(text, &mut builder)
            .map_err(|FileProblem { line, message }| format!("{}: {message}", line.unwrap_or_default()))?;
        builder.numbers()
    }

    fn mesh(text: &str, own_normals: bool) -> PolygonMesh {
        match numbers(text.as_bytes()) {
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
    fn a_backslash_continues_a_line_in_the_next() {
        let whole = mesh(&format!("{SQUARE}f 1 2 3 4\n"), false);
        for end in ["\\\n", "\\\r\n"] {
            let cut = SQUARE.replacen("v 2 0 0", &format!("v 2{end} 0{end}0"), 1);
            let text = format!("# C:\\models{end}{cut}f 1 2{end}3{end} 4");
            assert_eq!(mesh(&text, false), whole, "{text}");
            // A mistake is in the line where its statement begins, and those after it are in their own.
            for (more, expected) in [("x\n", "7: a face (f)"), ("3\nv one\n", "10: a vertex (v)")] {
                let said = numbers(format!("{cut}f 1{end} 2{end} {more}").as_bytes()).expect_err(more);
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
            ("v 0 0 0\nf 1 2 3\n", "0: a face (f) names a vertex that there is none of"),
            ("v 0 0 0\nf -1 -2 -3\n", "0: a face (f) names a vertex that there is none of"),
            ("v 0 0 0\nf 0 0 0\n", "0: a face (f) names a vertex that there is none of"),
            ("v 0 0 0\nvn 0 0 1\nf 1//9 1//1 1//1\n", "0: a face (f) names a normal"),
            ("v 0 0 0\nvt 0 0\nf 1/9 1/1 1/1\n", "0: a face (f) names a texture coordinate"),
            (
                "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "0: a corner of polygon 1 is at (NaN, 0, 0), which is nowhere",
            ),
            ("v 1e99 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "0: a corner of polygon 1 is at (inf, 0, 0)"),
            ("usemtl\n", "1: a material (usemtl) must have a name"),
            ("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "it has no polygons with an area"),
        ] {
            let said = numbers(text.as_bytes()).expect_err(text);
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
                if let Ok(numbers) = numbers(&bytes) {
                    let mesh = Model::new(&numbers).expect("a model").mesh(true);
                    assert!(mesh.positions.iter().all(|p| p.is_finite()), "byte {i} is {byte}");
                }
            }
        }
        for index in
            ["9223372036854775807", "-9223372036854775808", "6148914691236517206", "99999999999999999999"]
        {
            assert!(
                numbers(format!("{SQUARE}vn 0 0 1\nvt 0 1\nf {index} 1 2\n").as_bytes()).is_err(),
                "{index}"
            );
            // A library that wraps around may find something there; it must not fall.
            let _ =
                numbers(format!("{SQUARE}vn 0 0 1\nvt 0 1\nf 1/{index}/{index} 2/1/1 3/1/1\n").as_bytes());
        }
    }
}
