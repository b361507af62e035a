//! glTF 2.0 binary files (.glb): The Khronos Group (2021), *glTF 2.0 Specification*. Reads the triangles of
//! the file's default scene, as placed by its nodes: positions, normals and the first texture coordinates.

use glam::{DMat3, DMat4, Mat4, Vec2, Vec3};
use gltf::{
    Accessor, Document, Glb, Mesh, Semantic,
    accessor::{DataType, Dimensions},
    binary,
    buffer::Source,
    json::{Root, validation::Error as Mistake},
    mesh::Mode,
};

use super::{
    json,
    model::{Builder, Corner, MAX_VERTICES},
};
use crate::{parameter::FileProblem, text::shortened};

/// First bytes of such a file.
pub const BEGIN: &[u8] = b"glTF";

/// An extension that places meshes.
const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// Reads the polygons of a file.
pub fn read(bytes: &[u8], to: &mut Builder) -> Result<(), FileProblem> {
    whole(bytes, to).map_err(|message| FileProblem { line: None, message })
}

fn whole(bytes: &[u8], to: &mut Builder) -> Result<(), String> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    match (word(4), word(8)) {
        (Some(2), Some(length)) if (20..=bytes.len()).contains(&(length as usize)) => {}
        (Some(2) | None, _) => return Err("the file ends before the glTF does".to_owned()),
        (Some(version), _) => return Err(format!("it is glTF of version {version}; only version 2 is read")),
    }
    let wrong = |e: gltf::Error| format!("it is not valid glTF: {}", mistake(&e));
    let Glb { json, bin, .. } = Glb::from_slice(bytes).map_err(wrong)?;
    let json = json::read(json.into_owned()).map_err(|what| format!("it is not valid glTF: {what}"))?;
    // The library's validation trusts these.
    for (i, mesh) in json.meshes.iter().enumerate() {
        let mut attributes = mesh.primitives.iter().flat_map(|p| p.attributes.values());
        if let Some(stray) = attributes.find(|accessor| accessor.value() >= json.accessors.len()) {
            let count = json.accessors.len();
            let which = stray.value();
            return Err(format!(
                "meshes[{i}]: there is no accessor {which}; there are {count}, counted from 0"
            ));
        }
    }
    can_be_placed(&json)?;
    let document = Document::from_json(json).map_err(wrong)?;
    let blob = bin.unwrap_or_default();
    for (mesh, place) in placed(&document)? {
        polygons(&mesh, place, &blob, to).map_err(|what| format!("meshes[{}]: {what}", mesh.index()))?;
    }
    let mut modes = document.meshes().flat_map(|mesh| mesh.primitives()).map(|primitive| primitive.mode());
    match modes.next() {
        Some(first) if to.is_empty() && !is_surface(first) && !modes.any(is_surface) => {
            Err("it has lines or points alone; only triangles have a surface".to_owned())
        }
        _ => Ok(()),
    }
}

/// True for triangles.
fn is_surface(mode: Mode) -> bool {
    matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

/// Fails for nodes whose place is not known.
fn can_be_placed(json: &Root) -> Result<(), String> {
    let mut named = json.extensions_used.iter().chain(&json.extensions_required);
    if named.any(|name| name == INSTANCES) {
        let remedy = "export every copy as a node of its own";
        return Err(format!("it repeats meshes by the extension {INSTANCES}, which is not read; {remedy}"));
    }
    for (i, node) in json.nodes.iter().enumerate() {
        let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
        if node.matrix.is_some() && has_parts {
            let rule = "a node must have either the one or the others";
            return Err(format!("nodes[{i}] has a matrix and a translation, rotation or scale; {rule}"));
        }
        // Other programs round.
        let is_unit = |q: &[f32; 4]| (q.iter().map(|n| n * n).sum::<f32>().sqrt() - 1.0).abs() < 0.01;
        if let Some(rotation) = node.rotation.map(|rotation| rotation.0).filter(|q| !is_unit(q)) {
            return Err(format!("nodes[{i}].rotation is {rotation:?}, but its length must be 1"));
        }
    }
    Ok(())
}

/// An error in our own words: the library's are written for its authors.
fn mistake(error: &gltf::Error) -> String {
    match error {
        gltf::Error::Validation(mistakes) => {
            let Some((path, mistake)) = mistakes.first() else { return "a value is wrong".to_owned() };
            let path = shortened(path.as_str());
            match mistake {
                Mistake::Missing => format!("{path} is missing"),
                Mistake::IndexOutOfBounds => format!("{path} is an index out of range"),
                Mistake::Invalid => format!("{path} has an invalid value"),
                Mistake::Oversize => format!("{path} is too large"),
                Mistake::Unsupported => format!("{path} names an extension that is not supported"),
            }
        }
        gltf::Error::Deserialize(error) => {
            format!("its JSON has an error in line {}, column {}", error.line(), error.column())
        }
        gltf::Error::Binary(binary::Error::Length { .. } | binary::Error::ChunkLength { .. }) => {
            "one of its chunks is longer than the file".to_owned()
        }
        _ => "its chunks must be JSON and BIN, in this order".to_owned(),
    }
}

/// The meshes of the scene with their transformations: those of the nodes below its roots.
fn placed(document: &Document) -> Result<Vec<(Mesh<'_>, DMat4)>, String> {
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let Some(scene) = scene else { return Err("it has no scene".to_owned()) };
    let mut seen = vec![false; document.nodes().len()];
    let mut next: Vec<_> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
    let mut meshes = Vec::new();
    while let Some((node, above)) = next.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(format!("nodes[{}] has more than one parent, or is its own ancestor", node.index()));
        }
        let place = above * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        next.extend(node.children().map(|child| (child, place)));
        meshes.extend(node.mesh().map(|mesh| (mesh, place)));
    }
    Ok(meshes)
}

fn polygons(mesh: &Mesh, place: DMat4, blob: &[u8], to: &mut Builder) -> Result<(), String> {
    // Normals stay perpendicular to the stretched surface.
    let turn = DMat3::from_mat4(place);
    let (turn_normals, mirrored) = (turn.inverse().transpose(), turn.determinant() < 0.0);
    for primitive in mesh.primitives() {
        if !is_surface(primitive.mode()) {
            continue;
        }
        let Some(positions) = primitive.get(&Semantic::Positions) else { continue };
        let positions = floats::<3>(&positions, Dimensions::Vec3, "POSITION", blob)?;
        to.note(positions.iter().map(|position| Vec3::from_array(*position)));
        let optional = |semantic, dimensions, what: &str| {
            primitive
                .get(&semantic)
                .map(|accessor| floats::<3>(&accessor, dimensions, what, blob))
                .transpose()
        };
        let normals = optional(Semantic::Normals, Dimensions::Vec3, "NORMAL")?;
        let textures = primitive
            .get(&Semantic::TexCoords(0))
            // Integer texture coordinates are rare, and only determine the brush direction.
            .filter(|accessor| accessor.data_type() == DataType::F32)
            .map(|accessor| floats::<2>(&accessor, Dimensions::Vec2, "TEXCOORD_0", blob))
            .transpose()?;
        let corner = |i: u32| {
            let i = i as usize;
            let position = positions.get(i).ok_or_else(|| {
                format!("an index is {i}, but there are {} positions, counted from 0", positions.len())
            })?;
            let normal = normals.as_ref().and_then(|normals| normals.get(i));
            Ok::<_, String>(Corner {
                position: place.transform_point3(Vec3::from_array(*position).as_dvec3()),
                normal: normal
                    .map(|n| (turn_normals * Vec3::from_array(*n).as_dvec3()).normalize_or_zero().as_vec3()),
                texture: textures.as_ref().and_then(|all| all.get(i)).map(|uv| Vec2::from_array(*uv)),
            })
        };
        let order = match primitive.indices() {
            Some(accessor) => indices(&accessor, blob)?,
            None => (0..positions.len() as u32).collect(),
        };
        let triangles: Box<dyn Iterator<Item = [u32; 3]>> = match primitive.mode() {
            Mode::TriangleStrip => Box::new(order.windows(3).enumerate().map(|(i, t)| match i % 2 {
                0 => [t[0], t[1], t[2]],
                _ => [t[1], t[0], t[2]],
            })),
            Mode::TriangleFan => {
                Box::new(order.iter().skip(1).zip(order.iter().skip(2)).map(|(b, c)| [order[0], *b, *c]))
            }
            _ => Box::new(order.chunks_exact(3).map(|t| [t[0], t[1], t[2]])),
        };
        for [a, b, c] in triangles {
            let [a, b, c] = if mirrored { [a, c, b] } else { [a, b, c] };
            to.polygon(&[corner(a)?, corner(b)?, corner(c)?])?;
        }
    }
    Ok(())
}

/// The items of an accessor, `N` numbers each.
fn floats<const N: usize>(
    accessor: &Accessor,
    dimensions: Dimensions,
    what: &str,
    blob: &[u8],
) -> Result<Vec<[f32; N]>, String> {
    if (accessor.data_type(), accessor.dimensions()) != (DataType::F32, dimensions) {
        return Err(format!("{what} must be vectors of {N} 32-bit floats"));
    }
    let number = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let vector = |item: &[u8]| std::array::from_fn(|i| number(&item[4 * i..]));
    Ok(items(accessor, 4 * N, what, blob)?.map(vector).collect())
}

fn indices(accessor: &Accessor, blob: &[u8]) -> Result<Vec<u32>, String> {
    let what = "the list of indices";
    let index: fn(&[u8]) -> u32 = match (accessor.data_type(), accessor.dimensions()) {
        (DataType::U8, Dimensions::Scalar) => |b| u32::from(b[0]),
        (DataType::U16, Dimensions::Scalar) => |b| u32::from(u16::from_le_bytes([b[0], b[1]])),
        (DataType::U32, Dimensions::Scalar) => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        _ => return Err(format!("{what} must be unsigned integers of 8, 16 or 32 bits")),
    };
    Ok(items(accessor, accessor.data_type().size(), what, blob)?.map(index).collect())
}

/// The bytes of each item of an accessor. The library's reader trusts lengths and offsets; here they are
/// checked.
fn items<'a>(
    accessor: &Accessor,
    size: usize,
    what: &str,
    blob: &'a [u8],
) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, String> {
    let Some(view) = accessor.view().filter(|_| accessor.sparse().is_none()) else {
        return Err(format!("{what} is sparse, which is not supported"));
    };
    if !matches!(view.buffer().source(), Source::Bin) {
        return Err(format!("{what} is in another file, but must be part of this one"));
    }
    let count = accessor.count();
    if count > 3 * MAX_VERTICES {
        return Err(format!("{what} has {count} items; at most {} are read", 3 * MAX_VERTICES));
    }
    let stride = view.stride().unwrap_or(size).max(1);
    let all = || {
        let view = blob.get(view.offset()..view.offset().checked_add(view.length())?)?;
        let end = count.checked_sub(1).map_or(Some(0), |last| stride.checked_mul(last)?.checked_add(size))?;
        view.get(accessor.offset()..accessor.offset().checked_add(end)?)
    };
    let bytes = all().ok_or_else(|| format!("{what} extends beyond the end of its data"))?;
    Ok((0..count).map(move |i| &bytes[i * stride..][..size]))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::shape::mesh_file::model::Model;

    /// A tetrahedron-like corner: three triangles that meet in the origin, with a normal and texture coordinates.
    fn parts() -> (Value, Vec<u8>) {
        let positions = [[0.0f32, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut data: Vec<u8> = positions.into_iter().flatten().flat_map(f32::to_le_bytes).collect();
        data.extend([[0.0f32, 0.0, 1.0]; 4].into_iter().flatten().flat_map(f32::to_le_bytes));
        data.extend([0u16, 1, 2, 0, 2, 3, 0, 3, 1].into_iter().flat_map(u16::to_le_bytes));
        data.resize(data.len().next_multiple_of(4), 0);
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "children": [1] }, { "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2 }] }],
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [2, 1, 1] },
                { "bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC3" },
                { "bufferView": 1, "componentType": 5123, "count": 9, "type": "SCALAR" },
            ],
            "bufferViews": [
                { "buffer": 0, "byteLength": 96 },
                { "buffer": 0, "byteOffset": 96, "byteLength": 18 },
            ],
            "buffers": [{ "byteLength": data.len() }],
        });
        (json, data)
    }

    fn file(json: &Value, data: &[u8]) -> Vec<u8> {
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let word = |n: usize| (n as u32).to_le_bytes();
        let length = 12 + 8 + text.len() + 8 + data.len();
        [
            b"glTF",
            &word(2)[..],
            &word(length),
            &word(text.len()),
            b"JSON",
            &text,
            &word(data.len()),
            b"BIN\0",
            data,
        ]
        .concat()
    }

    fn numbers(bytes: &[u8]) -> Result<Vec<f32>, String> {
        let mut builder = Builder::default();
        read(bytes, &mut builder).map_err(|problem| problem.message)?;
        builder.numbers()
    }

    /// The mesh after a change, or the error.
    fn after(change: impl FnOnce(&mut Value)) -> Result<crate::shape::PolygonMesh, String> {
        let (mut json, data) = parts();
        change(&mut json);
        numbers(&file(&json, &data)).map(|numbers| Model::new(&numbers).expect("a model").mesh(false))
    }

    #[test]
    fn the_triangles_are_those_of_the_file() {
        let mesh = after(|_| {}).expect("legal");
        let expected = [[-0.5, -0.25, -0.25], [0.5, -0.25, -0.25], [-0.5, 0.25, -0.25], [-0.5, -0.25, 0.25]];
        assert_eq!(mesh.positions, expected.map(Vec3::from_array));
        let corners: Vec<_> = mesh.polygons.iter().map(|p| p.corners().to_vec()).collect();
        assert_eq!(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1]]);
    }

    #[test]
    fn whatever_authors_add_is_passed_over() {
        for extras in [json!("made by hand"), json!(1), json!(null), json!([1, [2]]), json!({ "extras": 3 })]
        {
            let mesh = after(|json| {
                json["extras"] = extras.clone();
                json["nodes"][0]["extras"] = extras.clone();
                json["meshes"][0]["primitives"][0]["extras"] = extras.clone();
            });
            assert_eq!(mesh, after(|_| {}), "{extras}");
        }
    }

    #[test]
    fn nodes_place_their_meshes_and_a_mirror_turns_the_corners() {
        let turned = |node: Value| {
            after(|json| {
                json["nodes"][0] = node;
                json["nodes"][0]["children"] = json!([1]);
            })
            .expect("legal")
        };
        // Rotated by 90° about z, then stretched: x becomes y.
        let s = std::f32::consts::FRAC_1_SQRT_2;
        let mesh = turned(json!({ "rotation": [0, 0, s, s], "scale": [2, 1, 1], "translation": [9, 9, 9] }));
        let extents = mesh.positions.iter().fold(Vec3::ZERO, |m, p| m.max(p.abs())) * 2.0;
        assert!((extents - Vec3::new(0.25, 1.0, 0.25)).length() < 1e-5, "{extents}");
        // Far away, nothing of the shape is lost.
        let far = turned(json!({ "translation": [4.6e6, 5.98e6, 3.22e6], "scale": [0.125, 0.125, 0.125] }));
        assert_eq!(far.positions, after(|_| {}).expect("legal").positions);
        let plain = after(|_| {}).expect("legal").polygon_normals()[0];
        let mirrored = turned(json!({ "scale": [1, 1, -1] }));
        assert!((mirrored.polygon_normals()[0] - plain * Vec3::new(1.0, 1.0, -1.0)).length() < 1e-6);
    }

    #[test]
    fn strips_and_fans_are_cut_and_lines_are_no_surface() {
        let of_mode = |mode: u32| {
            after(|json| {
                json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
                json["meshes"][0]["primitives"][0].as_object_mut().expect("an object").remove("indices");
            })
        };
        let normals = |mode: u32| of_mode(mode).expect("legal").polygon_normals();
        // 0 1 2, then 2 1 3, as seen from the same side.
        let strip = normals(5);
        assert!(strip.len() == 2 && strip[0] == Vec3::Z && strip[1].min_element() < 0.0, "{strip:?}");
        assert_eq!(normals(6), [Vec3::Z, Vec3::X]);
        assert_eq!(of_mode(1), Err("it has lines or points alone; only triangles have a surface".to_owned()));
    }

    #[test]
    fn mistakes_are_told() {
        let said = |change: fn(&mut Value)| after(change).expect_err("a mistake");
        for (expected, change) in [
            (
                "meshes[0]: an index is 3, but there are 3 positions",
                (|json| json["accessors"][0]["count"] = json!(3)) as fn(&mut Value),
            ),
            ("meshes[0]: POSITION extends beyond the end", |json| {
                json["accessors"][0]["count"] = json!(4000)
            }),
            ("meshes[0]: POSITION extends beyond", |json| {
                json["accessors"][0]["byteOffset"] = json!(u64::MAX / 2)
            }),
            ("meshes[0]: POSITION extends beyond", |json| {
                json["bufferViews"][0]["byteOffset"] = json!(u64::MAX)
            }),
            ("meshes[0]: POSITION has 1000000000000000000 items", |json| {
                json["accessors"][0]["count"] = json!(1_000_000_000_000_000_000_u64);
            }),
            ("meshes[0]: NORMAL extends beyond", |json| json["accessors"][1]["byteOffset"] = json!(92)),
            ("meshes[0]: the list of indices must be unsigned", |json| {
                json["accessors"][2]["componentType"] = json!(5126)
            }),
            ("meshes[0]: POSITION must be vectors of 3", |json| json["accessors"][0]["type"] = json!("VEC2")),
            ("meshes[0]: POSITION is sparse", |json| {
                json["accessors"][0]["sparse"] = json!({
                    "count": 1,
                    "indices": { "bufferView": 1, "componentType": 5123 },
                    "values": { "bufferView": 0 },
                });
            }),
            ("meshes[0]: POSITION is in another file", |json| {
                json["buffers"][0]["uri"] = json!("../secret.bin")
            }),
            ("nodes[0] has more than one parent, or is its own ancestor", |json| {
                json["nodes"][1]["children"] = json!([0])
            }),
            ("meshes[0]: there is no accessor 7; there are 3, counted from 0", |json| {
                json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(7);
            }),
            ("it has no scene", |json| {
                json.as_object_mut().expect("an object").retain(|key, _| !key.starts_with("scene"));
            }),
            ("nodes[1] has a matrix and a translation, rotation or scale; a node must have either", |json| {
                json["nodes"][1]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
                json["nodes"][1]["scale"] = json!([2, 1, 1]);
            }),
            ("nodes[0].rotation is [0.0, 0.0, 0.0, 0.0], but its length must be 1", |json| {
                json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]);
            }),
            ("it repeats meshes by the extension EXT_mesh_gpu_instancing, which is not read", |json| {
                json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
            }),
            ("it is not valid glTF: nodes[1].mesh is an index out of range", |json| {
                json["nodes"][1]["mesh"] = json!(7)
            }),
            ("it is not valid glTF: string \"none\" instead of a list (line 1, column ", |json| {
                json["nodes"] = json!("none")
            }),
            ("it is not valid glTF: ", |json| {
                json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
                json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
            }),
        ] {
            let said = said(change);
            assert!(said.starts_with(expected), "{said}\n{expected}");
        }
        let (json, data) = parts();
        let whole = file(&json, &data);
        let mut old = whole.clone();
        old[4] = 1;
        assert_eq!(numbers(&old), Err("it is glTF of version 1; only version 2 is read".to_owned()));
        for length in 4..whole.len() {
            let said = numbers(&whole[..length]).expect_err("cut off");
            assert_eq!(said, "the file ends before the glTF does", "{length}");
        }
    }

    #[test]
    fn files_with_any_byte_changed_are_read_or_refused() {
        let (json, data) = parts();
        let whole = file(&json, &data);
        for i in 0..whole.len() {
            for byte in [0, b'-', b'9', b'"', 0x7f, 0xff] {
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
