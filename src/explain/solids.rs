//! Objects of solid models that are drawn as thin glass because their meshes are not solids, with the reasons.

use std::collections::HashMap;

use super::dark_glass::the_same_for;
use crate::{
    registry::Registry,
    scene::{Object, Scene},
    shape::{
        Hierarchy, MeshKey, ShapeEntry,
        closed::{self, NotSolid},
    },
};

/// Maximum number of meshes whose results are kept.
const KEPT: usize = 1 << 12;

/// The meshes tested so far.
#[derive(Debug, Default)]
pub struct Tested(HashMap<MeshKey, Option<NotSolid>>);

impl Tested {
    /// The reason why an object's mesh is not a solid; `None` if it is one.
    fn problem(&mut self, shape: &ShapeEntry, object: &Object) -> Option<&NotSolid> {
        let key = shape.key(&object.shape, object.tessellation);
        if self.0.len() > KEPT && !self.0.contains_key(&key) {
            self.0.clear();
        }
        let test = || {
            let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
            closed::check(&mesh, &Hierarchy::new(&mesh)).err()
        };
        self.0.entry(key).or_insert_with(test).as_ref()
    }
}

/// A sentence on each model and mesh of a scene that a solid model draws as thin glass: the first object with both, the
/// reason and the remedy.
#[must_use]
pub fn thin(scene: &Scene, registry: &Registry, tested: &mut Tested) -> Vec<String> {
    // By model and mesh: the place in the list.
    let mut known: HashMap<(&str, MeshKey), usize> = HashMap::new();
    let mut found: Vec<(String, usize)> = Vec::new();
    for (i, object) in scene.objects.iter().enumerate().filter(|(_, object)| object.visible) {
        let model =
            registry.model(scene.model_of(object)).filter(|model| model.passage(&object.material).solid);
        let Some((model, shape)) = model.zip(registry.shape(&object.object_type)) else { continue };
        let surface = model.instantiate(&object.material, scene.display.encoding);
        if surface.interior().is_none() {
            continue;
        }
        let key = (model.declaration.id, shape.key(&object.shape, object.tessellation));
        if let Some(place) = known.get(&key) {
            found[*place].1 += 1;
        } else if let Some(problem) = tested.problem(shape, object) {
            known.insert(key, found.len());
            let (path, reason) = (scene.object_path(i), reason(problem, shape));
            let said = format!("{path} is drawn as thin glass, since its mesh is not a solid: {reason}");
            found.push((said, 0));
        }
    }
    found.into_iter().map(|(said, more)| said + &the_same_for(more)).collect()
}

/// The problem of a mesh and its remedy; for a built-in shape, the problem and its cause.
fn reason(problem: &NotSolid, shape: &ShapeEntry) -> String {
    let said = problem.to_string();
    match (shape.declaration.open, said.split_once("; ")) {
        ("", _) | (_, None) => said,
        (why, Some((what, _))) => format!("{what}; {why}"),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{
        parameter::{NamedFile, Value},
        shape::mesh_file,
    };

    fn scene(object_type: &str, model: &str) -> Scene {
        let object = Object { object_type: object_type.to_owned(), ..Object::default() };
        Scene { reflection_model: model.to_owned(), objects: vec![object], ..Scene::default() }
    }

    fn said(scene: &Scene) -> Vec<String> {
        thin(scene, &Registry::builtin(), &mut Tested::default())
    }

    /// A scene with the mesh of an OBJ file.
    fn obj(text: &str) -> Scene {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("model.obj"), text).expect("written");
        let mut scene = scene("mesh", "glass");
        let file = NamedFile::named("model.obj", folder.path(), &mesh_file::FORMAT);
        assert_eq!(file.problem(), None);
        scene.objects[0].shape.set("path", Value::File(file));
        scene
    }

    #[test]
    fn only_solid_models_on_meshes_that_are_no_solids_are_named() {
        for shape in ["sphere", "cube", "torus", "superellipsoid", "mesh"] {
            assert_eq!(said(&scene(shape, "glass")), [""; 0], "{shape}");
        }
        for model in ["thin_glass", "rough_dielectric", "diffuse_transmission", "phong"] {
            assert_eq!(said(&scene("teapot", model)), [""; 0], "{model}");
        }
        let mut hidden = scene("teapot", "glass");
        hidden.objects[0].visible = false;
        assert_eq!(said(&hidden), [""; 0]);
    }

    #[test]
    fn the_teapot_says_how_many_edges_are_open_and_why() {
        let mut scene = scene("teapot", "glass");
        scene.objects[0].name = Some("pot".to_owned());
        let said = said(&scene);
        assert_eq!(said.len(), 1);
        let begins = "objects[0] (\"pot\") is drawn as thin glass, since its mesh is not a solid: it is open: 160 edges with a triangle \
                      on one side only, in 6 rims, the longest around (";
        assert!(said[0].starts_with(begins), "{said:?}");
        assert!(said[0].ends_with(
            "; Newell's lid, body, handle and spout are separate surfaces that pass into each other"
        ));
    }

    #[test]
    fn files_say_what_would_be_right_and_copies_are_counted() {
        let tent = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
        let mut open = obj(tent);
        let message = &said(&open)[0];
        assert!(
            message.contains("it is open: 3 edges with a triangle on one side only, in 1 rim around ("),
            "{message}"
        );
        assert!(message.ends_with("; close the holes, or merge vertices that nearly meet"), "{message}");
        open.objects.extend([open.objects[0].clone(), open.objects[0].clone()]);
        open.objects[2].tessellation = Some(1);
        let all = said(&open);
        assert_eq!(all.len(), 1, "{all:?}");
        assert!(all[0].ends_with(" (the same for 2 more objects)"), "{all:?}");
        let inside_out = obj(&format!("{tent}f 2 3 4\n")
            .replace("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4", "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3"));
        assert_eq!(
            said(&inside_out),
            [
                "objects[0] is drawn as thin glass, since its mesh is not a solid: it is inside out; reverse the order of the corners, so \
              that faces point outwards"
            ]
        );
        assert_eq!(said(&obj(&format!("{tent}f 2 3 4\n"))), [""; 0]);
    }

    #[test]
    fn each_mesh_is_tested_once() {
        let (registry, mut tested) = (Registry::builtin(), Tested::default());
        let mut scene = scene("teapot", "glass");
        let first = thin(&scene, &registry, &mut tested);
        scene.objects.push(scene.objects[0].clone());
        assert_eq!(
            thin(&scene, &registry, &mut tested),
            [format!("{} (the same for 1 more object)", first[0])]
        );
        assert_eq!(tested.0.len(), 1);
        scene.objects[1].tessellation = Some(4);
        assert_eq!(thin(&scene, &registry, &mut tested).len(), 2);
        assert_eq!(tested.0.len(), 2);
    }
}
