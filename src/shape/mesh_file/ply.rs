//! PLY files: G. Turk (1994), *The PLY Polygon File Format*, Stanford University; as text or binary. Reads
//! the elements `vertex`, with positions, normals and texture coordinates, and `face`.

use std::io::ErrorKind;

use glam::{DVec2, DVec3};
use ply_rs_bw::{
    parser::{ParseError, Parser, Reader},
    ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType},
};

use super::model::{Builder, Corner, MAX_POLYGONS, MAX_VERTICES};
use crate::{
    parameter::FileProblem,
    text::{shortened, with_line_feeds},
};

/// First bytes of such a file.
pub const BEGIN: &[u8] = b"ply";

/// The names of the list of corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];
/// The names of texture coordinates.
const TEXTURES: [[&str; 2]; 4] =
    [["s", "t"], ["u", "v"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// A vertex.
#[derive(Clone, Copy, Default)]
struct Vertex {
    position: DVec3,
    normal: DVec3,
    texture: DVec2,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let texture = |k: usize| TEXTURES.iter().any(|names| names[k] == name);
        let to = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            "nx" => &mut self.normal.x,
            "ny" => &mut self.normal.y,
            "nz" => &mut self.normal.z,
            _ if texture(0) => &mut self.texture.x,
            _ if texture(1) => &mut self.texture.y,
            _ => return PropertyAccessResult::Ignored,
        };
        *to = match value {
            Property::Double(number) => number,
            Property::Int(number) => f64::from(number),
            Property::UInt(number) => f64::from(number),
            small => match small.to_f32_lossy() {
                Some(number) => f64::from(number),
                None => return PropertyAccessResult::UnsupportedType,
            },
        };
        PropertyAccessResult::Set
    }
}

/// A face: its corners; `None` if one is negative.
#[derive(Default)]
struct Face(Option<Vec<u32>>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !CORNERS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = value.to_u32_list();
        PropertyAccessResult::Set
    }
}

/// Another element, which is skipped.
struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}

/// Reads the polygons of a file.
pub fn read(bytes: &[u8], to: &mut Builder) -> Result<(), FileProblem> {
    let text = std::str::from_utf8(bytes).ok().filter(|text| text.contains("\rformat ascii"));
    let text = text.map(with_line_feeds);
    let bytes = text.as_deref().map_or(bytes, str::as_bytes);
    let mut reader = Reader::new(bytes);
    let mut header = Parser::<Other>::new().read_header(&mut reader).map_err(|e| in_header(&e, bytes))?;
    let whole = |message: String| FileProblem { line: None, message };
    let is_text = header.encoding == Encoding::Ascii;
    if is_text && let Some(vertex) = header.elements.get_mut("vertex") {
        // Text may have more digits than the type in the header holds.
        let float = PropertyType::Scalar(ScalarType::Float);
        for property in vertex.properties.values_mut().filter(|p| p.data_type == float) {
            property.data_type = PropertyType::Scalar(ScalarType::Double);
        }
    }
    let (vertex, face) = (header.elements.get("vertex"), header.elements.get("face"));
    let (vertex, face) = (declared(vertex, "vertex"), declared(face, "face"));
    let (vertex, face) = (vertex.map_err(whole)?, face.map_err(whole)?);
    let has = |names: &[&str]| names.iter().all(|name| vertex.properties.contains_key(*name));
    let (has_normals, has_texture) = (has(&["nx", "ny", "nz"]), TEXTURES.iter().any(|names| has(names)));
    for (element, most, what) in [(vertex, MAX_VERTICES, "vertices"), (face, MAX_POLYGONS, "polygons")] {
        if element.count > most {
            return Err(whole(format!("it has {} {what}; at most {most} are read", element.count)));
        }
    }
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for element in header.elements.values() {
        let read = match element.name.as_str() {
            "vertex" => Parser::<Vertex>::new()
                .read_payload_for_element(&mut reader, element, &header)
                .map(|v| vertices = v),
            "face" => Parser::<Face>::new()
                .read_payload_for_element(&mut reader, element, &header)
                .map(|f| faces = f),
            // A file without data may claim any number of them.
            name if element.count > bytes.len() => {
                return Err(whole(format!(
                    "the file ends before {} of the element {}",
                    element.count,
                    shortened(name)
                )));
            }
            _ => Parser::<Other>::new().read_payload_for_element(&mut reader, element, &header).map(|_| ()),
        };
        read.map_err(|e| in_element(&e, element, is_text, bytes))?;
    }
    let float = |axis: &str| vertex.properties[axis].data_type == PropertyType::Scalar(ScalarType::Float);
    if ["x", "y", "z"].into_iter().any(float) {
        to.note(vertices.iter().map(|vertex: &Vertex| vertex.position.as_vec3()));
    }
    for (i, Face(face)) in faces.iter().enumerate() {
        let corner = |index: &u32| {
            let Vertex { position, normal, texture } = *vertices.get(*index as usize)?;
            Some(Corner {
                position,
                normal: has_normals.then_some(normal.as_vec3()),
                texture: has_texture.then_some(texture.as_vec2()),
            })
        };
        let corners: Option<Vec<_>> = face.iter().flatten().map(corner).collect();
        let corners = corners.filter(|_| face.is_some()).ok_or_else(|| {
            let count = vertices.len();
            whole(format!("face {i} has a corner that is not one of the {count} vertices, counted from 0"))
        })?;
        to.polygon(&corners).map_err(whole)?;
    }
    Ok(())
}

/// An element of the header with its required properties.
fn declared<'a>(element: Option<&'a ElementDef>, name: &str) -> Result<&'a ElementDef, String> {
    let element = element.ok_or_else(|| format!("its header has no element {name}"))?;
    let kind = |name: &str| element.properties.get(name).map(|p| &p.data_type);
    let rule = if name == "vertex" {
        let scalar = |axis: &str| matches!(kind(axis), Some(PropertyType::Scalar(_)));
        (!["x", "y", "z"].into_iter().all(scalar)).then_some("the numbers x, y and z")
    } else {
        let list = |name: &str| matches!(kind(name), Some(PropertyType::List(..)));
        (!CORNERS.into_iter().any(list)).then_some("the list vertex_indices")
    };
    match rule {
        None => Ok(element),
        Some(rule) => Err(format!("the element {name} of its header must have {rule}")),
    }
}

/// An error in the header in our own words: the library's are written for its authors.
fn in_header(error: &ParseError, bytes: &[u8]) -> FileProblem {
    /// The beginnings of the library's messages, which are all that identifies the kind of an error, and
    /// ours.
    const KINDS: &[(&str, &str)] = &[
        ("No format line", "its header has no format line"),
        ("Invalid version", "its header has no version after the format, such as 1.0"),
        ("Expected magic number", "its first line must be ply alone"),
        ("Unexpected 'ply'", "its header has two ply lines"),
        ("Found contradicting format", "its header has two different format lines"),
        ("Property", "its header has a property before the first element"),
    ];
    let said = error.to_string();
    let said = said.split_once(": ").filter(|_| error.line().is_some()).map_or(&*said, |(_, said)| said);
    let line = error.line().and_then(|line| bytes.split(|byte| *byte == b'\n').nth(line.checked_sub(1)?));
    let ends = bytes.strip_prefix(b"ply\r").is_some_and(|rest| !rest.starts_with(b"\n"));
    let what = match KINDS.iter().find(|(theirs, _)| said.starts_with(*theirs)) {
        _ if ends => "the lines of its header must end with a line feed",
        Some((_, ours)) => *ours,
        None if error.kind() == ErrorKind::UnexpectedEof => "the file ends before the end_header line",
        None if error.line().is_none() => "its header is not text",
        None => match line.unwrap_or_default().split(u8::is_ascii_whitespace).next() {
            Some(b"element") => "element must be followed by a name and a whole number, 0 or more",
            Some(b"property") => {
                "property must be followed by a type and a name, such as float x or list uchar int vertex_indices"
            }
            Some(b"format") => {
                "format must be followed by ascii, binary_little_endian or binary_big_endian, and 1.0"
            }
            _ => {
                "a line of its header must begin with format, comment, obj_info, element, property or \
                 end_header"
            }
        },
    };
    no_valid(error, true, what, bytes)
}

/// An error in an element, in our own words.
fn in_element(error: &ParseError, element: &ElementDef, is_text: bool, bytes: &[u8]) -> FileProblem {
    let name = shortened(&element.name);
    let what = match error.kind() {
        ErrorKind::UnexpectedEof => {
            format!("the file ends before all {} of the element {name}", element.count)
        }
        _ if is_text && error.line().is_none() => "it is not text, although its header says so".to_owned(),
        _ if is_text => format!(
            "this line must have a number for each property of the element {name}, and the length of each list \
             before it"
        ),
        _ => format!("the element {name} does not match the header"),
    };
    no_valid(error, is_text, &what, bytes)
}

/// An error, with its line if it is in text.
fn no_valid(error: &ParseError, is_text: bool, what: &str, bytes: &[u8]) -> FileProblem {
    // The library does not report where the text part of a file ends.
    let stops =
        |error: std::str::Utf8Error| bytes[..error.valid_up_to()].split(|byte| *byte == b'\n').count();
    let line = match error.kind() {
        ErrorKind::InvalidData if error.line().is_none() => std::str::from_utf8(bytes).err().map(stops),
        _ => error.line(),
    };
    FileProblem {
        line: line.filter(|line| is_text && *line > 0),
        message: format!("it is not a valid PLY file: {what}"),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::shape::{PolygonMesh, mesh_file::model::Model};

    fn numbers(bytes: &[u8]) -> Result<Vec<f32>, String> {
        let mut builder = Builder::default();
        read(bytes, &mut builder)
            .map_err(|FileProblem { line, message }| format!("{}: {message}", line.unwrap_or_default()))?;
        builder.numbers()
    }

    fn mesh(bytes: &[u8], own_normals: bool) -> PolygonMesh {
        match numbers(bytes) {
            Ok(numbers) => Model::new(&numbers).expect("a model").mesh(own_normals),
            Err(what) => panic!("{what} in {}", String::from_utf8_lossy(bytes)),
        }
    }

    const SQUARE: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty double y\n\
                          property float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\n\
                          end_header\n0 0 0 7\n2 0 0 7\n2 1 0 7\n0 1 0 7\n4 0 1 2 3\n";

    /// The file as binary data.
    fn binary(little: bool) -> Vec<u8> {
        let header = SQUARE.split_inclusive("end_header\n").next().expect("a header");
        let mut bytes = header
            .replace("ascii", if little { "binary_little_endian" } else { "binary_big_endian" })
            .into_bytes();
        for (x, y) in [(0.0f32, 0.0f64), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)] {
            if little {
                bytes.extend(x.to_le_bytes());
                bytes.extend(y.to_le_bytes());
            } else {
                bytes.extend(x.to_be_bytes());
                bytes.extend(y.to_be_bytes());
            }
            bytes.extend([0, 0, 0, 0, 7]);
        }
        bytes.push(4);
        for i in 0..4i32 {
            bytes.extend(if little { i.to_le_bytes() } else { i.to_be_bytes() });
        }
        bytes
    }

    #[test]
    fn text_and_both_orders_of_bytes_give_the_same_mesh() {
        let expected = [[-0.5, -0.25], [0.5, -0.25], [0.5, 0.25], [-0.5, 0.25]];
        let windows = SQUARE.replace('\n', "\r\n").into_bytes();
        let old = SQUARE.replace('\n', "\r").into_bytes();
        for bytes in [SQUARE.as_bytes(), &windows, &old, &binary(true), &binary(false)] {
            let mesh = mesh(bytes, false);
            assert_eq!(mesh.positions, expected.map(|[x, y]| Vec3::new(x, y, 0.0)));
            assert_eq!(mesh.polygons.len(), 1);
            assert_eq!(mesh.polygons[0].corners(), [0, 1, 2, 3]);
        }
    }

    #[test]
    fn normals_texture_coordinates_and_other_elements_are_understood() {
        let text = "ply\nformat ascii 1.0\nelement camera 2\nproperty float a\nelement vertex 3\nproperty float x\n\
                    property float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n\
                    property float s\nproperty float t\nelement face 1\nproperty list uchar uint vertex_index\n\
                    property uchar flags\nend_header\n1\n2\n0 0 0 0 3 4 0 0\n1 0 0 0 3 4 0 1\n0 1 0 0 3 4 1 0\n3 0 1 2 9\n";
        let mesh = mesh(text.as_bytes(), true);
        assert_eq!(mesh.vertex_normals(), [Vec3::new(0.0, 0.6, 0.8); 3]);
        // s grows along y.
        assert!((mesh.polygon_tangents()[0] - Vec3::Y).length() < 1e-6);
        assert_eq!(super::tests::mesh(text.as_bytes(), false).vertex_normals(), [Vec3::Z; 3]);
    }

    #[test]
    fn binary_floats_far_away_are_refused_and_text_is_not() {
        let far = |text: &str| {
            text.replace("\n0 0 0 7\n2 0 0 7\n", "\n4600000 0 0 7\n4600002 0 0 7\n")
                .replace("\n2 1 0 7\n0 1 0 7\n", "\n4600002 1 0 7\n4600000 1 0 7\n")
        };
        assert!(numbers(far(SQUARE).as_bytes()).is_ok());
        let mut bytes = binary(true);
        let start = bytes.len() - 17 - 4 * 17;
        for (i, x) in [4.6e6_f32, 4.6e6 + 2.0, 4.6e6 + 2.0, 4.6e6].into_iter().enumerate() {
            bytes[start + 17 * i..][..4].copy_from_slice(&x.to_le_bytes());
        }
        let said = numbers(&bytes).expect_err("too far");
        assert!(said.starts_with("it has an extent of 2 at 4600002 from its origin"), "{said}");
    }

    #[test]
    fn mistakes_are_told_with_their_lines() {
        for (from, to, expected) in [
            ("format ascii 1.0\n", "", "0: it is not a valid PLY file: its header has no format line"),
            (
                "element vertex 4",
                "element vertex four",
                "4: it is not a valid PLY file: element must be followed by a name",
            ),
            (
                "element vertex 4",
                "element vertex -1",
                "4: it is not a valid PLY file: element must be followed by a name",
            ),
            (
                "property double y",
                "property y",
                "6: it is not a valid PLY file: property must be followed by a type",
            ),
            (
                "comment a square",
                "remark a square",
                "3: it is not a valid PLY file: a line of its header must begin",
            ),
            ("end_header\n", "", "11: it is not a valid PLY file: a line of its header must begin"),
            ("element vertex 4", "element point 4", "0: its header has no element vertex"),
            (
                "property float z\n",
                "",
                "0: the element vertex of its header must have the numbers x, y and z",
            ),
            (
                "uchar int vertex_indices",
                "uchar int strips",
                "0: the element face of its header must have the list",
            ),
            ("element face", "element faces", "0: its header has no element face"),
            (
                "element vertex 4",
                "element vertex 5000000",
                "0: it has 5000000 vertices; at most 2000000 are read",
            ),
            ("element face 1", "element face 500001", "0: it has 500001 polygons; at most 500000 are read"),
            (
                "element face 1",
                "element face 2",
                "17: it is not a valid PLY file: the file ends before all 2 of the element face",
            ),
            (
                "2 1 0 7",
                "2 one 0 7",
                "14: it is not a valid PLY file: this line must have a number for each property",
            ),
            ("2 1 0 7", "2 1", "14: it is not a valid PLY file: "),
            ("4 0 1 2 3", "4 0 1 2", "16: it is not a valid PLY file: "),
            (
                "4 0 1 2 3",
                "4 0 1 2 4",
                "0: face 0 has a corner that is not one of the 4 vertices, counted from 0",
            ),
            ("4 0 1 2 3", "4 0 1 2 -1", "0: face 0 has a corner that is not one of the 4 vertices"),
            ("4 0 1 2 3", "2 0 1", "it has no polygons with an area"),
            (
                "2 0 0 7",
                "1e99 0 0 7",
                "0: a corner of polygon 1 is at (inf, 0, 0), but positions must be finite",
            ),
        ] {
            assert!(SQUARE.contains(from), "{from}");
            let said = numbers(SQUARE.replacen(from, to, 1).as_bytes()).expect_err(to);
            assert!(said.starts_with(expected), "{said}\n{expected}");
            assert!(!said.contains('\n'), "{said}");
        }
        assert!(numbers(b"ply").is_err());
        let header = SQUARE.split_inclusive("end_header\n").next().expect("a header");
        let mut old = header.replace("ascii", "binary_little_endian").replace('\n', "\r").into_bytes();
        old.extend([0xff; 80]);
        let said = numbers(&old).expect_err("line ends");
        assert_eq!(said, "1: it is not a valid PLY file: the lines of its header must end with a line feed");
        let said = numbers(b"ply\n\xff\xfe").expect_err("no text");
        assert_eq!(said, "2: it is not a valid PLY file: its header is not text");
    }

    #[test]
    fn files_that_claim_more_than_they_have_are_refused_at_once() {
        let header = SQUARE.split_inclusive("end_header\n").next().expect("a header");
        for encoding in ["ascii", "binary_little_endian"] {
            let claims =
                header.replace("ascii", encoding).replace("element vertex 4", "element vertex 2000000");
            assert!(numbers(claims.as_bytes()).is_err(), "{encoding}");
            let nothing = header
                .replace("ascii", encoding)
                .replace("element vertex", "element nothing 18446744073709551615\nelement vertex");
            assert!(numbers(nothing.as_bytes()).is_err(), "{encoding}");
        }
        let mut long =
            header.replace("ascii", "binary_little_endian").replace("list uchar", "list uint").into_bytes();
        long.extend([0; 4 * 17]);
        long.extend([0xff; 4]);
        assert!(numbers(&long).is_err());
    }

    #[test]
    fn files_with_any_byte_changed_are_read_or_refused() {
        for whole in [SQUARE.as_bytes().to_vec(), binary(true), binary(false)] {
            for i in 0..whole.len() {
                for byte in [0, b'-', b'9', b'\n', b' ', 0x7f, 0xff] {
                    let mut bytes = whole.clone();
                    bytes[i] = byte;
                    if let Ok(numbers) = numbers(&bytes) {
                        let mesh = Model::new(&numbers).expect("a model").mesh(true);
                        assert!(mesh.positions.iter().all(|p| p.is_finite()), "byte {i} is {byte}");
                    }
                }
            }
        }
    }
}
