//! Objects from files.

use super::{Declaration, ObjectType, PolygonMesh};
use crate::{
    parameter::{FileFormat, FileProblem, Parameter, Shipped},
    parameters,
    text::after_mark,
};

mod glb;
mod json;
mod model;
mod obj;
mod ply;
mod polygon;

use model::{Builder, Model};
pub use model::{MAX_CORNERS, MAX_POLYGONS, MAX_VERTICES};

/// A file of the folder `scenes`, with its name.
macro_rules! shipped {
    ($name:literal) => {
        ($name, Shipped::Bytes(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/", $name))))
    };
}

/// Models written by other programs: glTF 2.0 binary, OBJ and PLY, distinguished by their first bytes.
/// Renderers read: the numbers of vertices, of normals and of polygons; the vertices, around the origin with
/// a largest extent of 1; the normals; and for each polygon the number of its corners, three or four, four
/// indices of vertices, four of normals (−1: none), and the brush direction.
pub static FORMAT: FileFormat = FileFormat {
    name: "a glTF binary, OBJ or PLY file",
    extensions: &["glb", "obj", "ply"],
    max_bytes: 32 << 20,
    read,
    shipped: &[
        shipped!("knot.glb"),
        shipped!("gem.obj"),
        shipped!("steps.obj"),
        shipped!("lampshade.obj"),
        shipped!("slab.obj"),
    ],
};

fn read(bytes: &[u8]) -> Result<Vec<f32>, FileProblem> {
    let whole = |message: String| FileProblem { line: None, message };
    let mut builder = Builder::default();
    let bytes = after_mark(bytes);
    if bytes.starts_with(glb::BEGIN) {
        glb::read(bytes, &mut builder)?;
    } else if bytes.starts_with(ply::BEGIN) {
        ply::read(bytes, &mut builder)?;
    } else if bytes.trim_ascii_start().starts_with(b"{") {
        return Err(whole("it may be a text glTF file; only binary ones (.glb) are read".to_owned()));
    } else {
        let faces = obj::read(bytes, &mut builder)?;
        if builder.is_empty() && faces == 0 {
            let message = "it does not begin like binary glTF or PLY, and has no OBJ polygons (f)";
            return Err(whole(message.to_owned()));
        }
    }
    builder.numbers().map_err(whole)
}

const PATH: Parameter = Parameter::file("path", &FORMAT, "knot.glb")
    .symbol("")
    .label("model file")
    .help("The glTF binary (.glb), OBJ or PLY file with the polygons; relative to the folder of the scene.");

const NORMALS: Parameter = Parameter::choice(
    "normals",
    &[("computed", "Mean of the polygons"), ("file", "From the file")],
    0,
)
.symbol("")
.label("vertex normals")
.help(
    "The mean of the normals of the polygons that meet in a vertex, or those of the file, where it has them.",
);

parameters! {
    /// **Mesh**: the polygons of a [file](FORMAT). They are scaled and moved so that the largest extent of the box around
    /// them is the size of the object, and the middle of that box is its position; x, y and z are those of the file.
    ///
    /// Vertices in one place are one, so that the mean of the normals is over all polygons that meet there. With
    /// the normals of the file they are one where their normals are equal, too, so that edges that the file means to be
    /// sharp stay sharp. Polygons of more than four corners are cut into triangles. A polygon is brushed where its first
    /// texture coordinate grows, and horizontally if the file has none.
    pub struct MeshFile {
        /// The polygons.
        path: file = PATH,
        /// The origin of vertex normals: 0 for their mean, 1 for the file.
        normals: choice = NORMALS,
    }
}

impl ObjectType for MeshFile {
    const DECLARATION: Declaration = Declaration::new("mesh", "Mesh")
        .summary("The polygons of a file: any shape, as modelling programs write it.")
        .glyph("▲")
        .tessellation(1..=1, 1, "Its polygons are those of the file.");

    fn mesh(&self, _: u32) -> PolygonMesh {
        Model::new(&self.path.numbers).map(|model| model.mesh(self.normals == 1)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// The curve along which the tube of `scripts/knot` runs, and its direction, as in the file.
    fn curve(t: f32) -> (Vec3, Vec3) {
        let (s, c) = (f32::sin, f32::cos);
        let point = Vec3::new(s(t) + 2.0 * s(2.0 * t), c(t) - 2.0 * c(2.0 * t), -s(3.0 * t));
        let along = Vec3::new(c(t) + 4.0 * c(2.0 * t), -s(t) + 4.0 * s(2.0 * t), -3.0 * c(3.0 * t));
        (point, along.normalize())
    }

    #[test]
    fn the_shipped_model_is_the_knot_of_its_formula() {
        const EXTENT: f32 = 6.707_968;
        let mesh = MeshFile { normals: 1, ..MeshFile::default() }.mesh(1);
        assert_eq!((mesh.positions.len(), mesh.polygons.len()), (128 * 12, 2 * 128 * 12));
        // The centre of the bounding box: the knot has three axes of symmetry, but none along y.
        let circles = (0..128).map(|i| curve(std::f32::consts::TAU * i as f32 / 128.0)).collect::<Vec<_>>();
        let offset = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len() as f32
            - circles.iter().map(|(p, _)| *p).sum::<Vec3>() / 128.0 / EXTENT;
        let tangents = mesh.vertex_tangents();
        for ((p, n), t) in mesh.positions.iter().zip(mesh.vertex_normals()).zip(tangents) {
            let at = (*p - offset) * EXTENT;
            let (middle, along) = circles
                .iter()
                .min_by(|a, b| (at - a.0 - 0.62 * n).length().total_cmp(&(at - b.0 - 0.62 * n).length()))
                .expect("many");
            assert!(((at - *middle).length() - 0.62).abs() < 1e-3, "{at}");
            assert!(((at - *middle) / 0.62 - n).length() < 2e-3, "{at} {n}");
            assert!(along.dot(n).abs() < 1e-3 && along.dot(t) > 0.95, "{along} {t}");
        }
        // The wrong twin, the mean of the polygons, is not exact.
        let computed = MeshFile::default().mesh(1);
        let off: f32 =
            computed.vertex_normals().iter().zip(mesh.vertex_normals()).map(|(a, b)| (*a - b).length()).sum();
        assert!(off > 0.01 && computed.positions == mesh.positions, "{off}");
    }

    /// Maps and plans of buildings have their origin far away, where 32-bit floats are half a metre apart.
    #[test]
    fn models_far_from_their_origin_are_those_near_it() {
        let text = |[x, y, z]: [f64; 3], ply: Option<&str>| {
            let points =
                (0..7_i32).flat_map(|i| (0..12_i32).map(move |j| (f64::from(i) - 3.0, f64::from(j))));
            let mut lines: Vec<_> = points
                .map(|(i, j)| ((i * 0.4).sin_cos(), (j * std::f64::consts::TAU / 12.0).sin_cos()))
                .map(|((s, c), (sj, cj))| format!("{:.9} {:.9} {:.9}", x + c * cj, y + c * sj, z + s))
                .collect();
            let quads = (0..6).flat_map(|i| {
                (0..12).map(move |j| {
                    [i, i, i + 1, i + 1]
                        .map(|i| i * 12)
                        .into_iter()
                        .zip([j, (j + 1) % 12, (j + 1) % 12, j])
                        .map(|(i, j)| i + j)
                })
            });
            let Some(number) = ply else {
                lines.iter_mut().for_each(|line| line.insert_str(0, "v "));
                lines.extend(quads.map(|q| q.fold("f".to_owned(), |face, i| format!("{face} {}", i + 1))));
                return lines.join("\n");
            };
            lines.extend(quads.map(|q| q.fold("4".to_owned(), |face, i| format!("{face} {i}"))));
            let numbers = ["x", "y", "z"].map(|axis| format!("property {number} {axis}\n")).concat();
            format!(
                "ply\nformat ascii 1.0\nelement vertex 84\n{numbers}element face 72\n\
                 property list uchar int vertex_indices\nend_header\n{}\n",
                lines.join("\n")
            )
        };
        for ply in [None, Some("double"), Some("float")] {
            let [near, far] = [[0.0; 3], [4.6e6, 5.98e6, 3.22e6]].map(|middle| {
                let numbers = read(text(middle, ply).as_bytes()).expect("a model");
                Model::new(&numbers).expect("a model").mesh(false)
            });
            assert_eq!((near.positions.len(), near.polygons.len()), (84, 72), "{ply:?}");
            assert_eq!(near.polygons, far.polygons, "{ply:?}");
            for (a, b) in near.positions.iter().zip(&far.positions) {
                assert!((*a - *b).length() < 1e-6, "{ply:?}: {a} {b}");
            }
        }
        let small = "v 1e6 1e6 1e6\nv 1000000.01 1e6 1e6\nv 1e6 1000000.01 1e6\nf 1 2 3\n";
        assert!(read(small.as_bytes()).is_ok());
    }

    #[test]
    fn formats_are_told_apart_by_their_content() {
        let said = |bytes: &[u8]| read(bytes).expect_err("no model").message;
        assert!(said(b"").contains("does not begin like binary glTF or PLY"));
        assert!(said(b"a letter\nto nobody").contains("has no OBJ polygons (f)"));
        assert!(said(b" {\"asset\":{}}").contains("only binary ones (.glb) are read"));
        assert!(said(b"glTF").contains("ends before"));
        assert!(said(b"ply\nformat").contains("not a valid PLY file"));
        assert!(said(&[0xff; 100]).contains("does not begin like"));
        assert_eq!(said(b"v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), "it has no polygons with an area");
        let far = said(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 99999999999999999999\n");
        assert!(
            far.starts_with("this face (f) names the vertex 99999999999999999999, but a file has at most ")
        );
        let far = said(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/99999999999999999999 3/1\n");
        assert!(far.contains("names the texture coordinate 99999999999999999999"), "{far}");
        assert!(far.ends_with(" texture coordinates (vt)"), "{far}");
        assert!(said(b"v 0 0 0\nf 1 2 3e\n").contains("must name its corners as vertex"));
        assert!(said("\u{feff}ply\nformat".as_bytes()).contains("not a valid PLY file"));
        let square = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n";
        assert!(read(square.as_bytes()).is_ok());
    }
}
