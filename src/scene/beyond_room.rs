//! A scene without `scene_size` and with parts outside the default room: the missing size is reported, not
//! each of the positions.

use glam::Vec3;

use super::{
    MAX_DIMENSION, Scene, SceneSize, check,
    error::{Path, Problem, Segment},
    reading::Missing,
};

/// An extent of the room: its key, and functions that get its value from a position and a size.
type Axis = (&'static str, fn(Vec3) -> f32, fn(&mut SceneSize) -> &mut f32);

/// The extents, in the order of the file.
const AXES: [Axis; 3] = [
    ("height", |p| p.y, |size| &mut size.height),
    ("width", |p| p.x, |size| &mut size.width),
    ("depth", |p| p.z, |size| &mut size.depth),
];

/// Replaces the problems of positions caused by the missing size by a single problem. Positions that no size
/// would fix are kept, with a remark that the size is a default.
pub(super) fn explain(problems: Vec<Problem>, scene: &Scene, missing: &[Missing]) -> Vec<Problem> {
    let room = Path::root().key("scene_size");
    let lacks = |axis: &'static str| missing.iter().find(|m| m.path == room || m.path == room.key(axis));
    let lacking: Vec<_> = AXES.into_iter().filter_map(|axis| Some((axis, lacks(axis.0)?))).collect();
    let Some((_, first)) = lacking.first() else { return problems };
    let assumed = check::plausible(scene.scene_size);
    let outside = check::position(assumed, Vec3::NAN);
    let mut largest = assumed;
    for ((_, _, extent), _) in &lacking {
        *extent(&mut largest) = MAX_DIMENSION;
    }
    // The size that would suffice.
    let mut enough = assumed;
    let mut beyond = Vec::new();
    let mut rest = Vec::new();
    for mut problem in problems {
        let about_room = outside.as_ref().is_err_and(|rule| *rule == problem.rule);
        match position(scene, &problem.path).filter(|_| about_room) {
            None => rest.push(problem),
            Some(p) if largest.contains(p) => {
                for ((_, along, extent), _) in &lacking {
                    let extent = extent(&mut enough);
                    *extent = extent.max(along(p).ceil());
                }
                beyond.push(problem);
            }
            Some(_) => {
                problem.rule += &format!("; {} is missing, and its default is {}", first.path, first.default);
                rest.push(problem);
            }
        }
    }
    let Some(example) = beyond.first() else { return rest };
    let mut default = assumed;
    let too_small = |((_, _, extent), _): &&(Axis, &Missing)| *extent(&mut enough) > *extent(&mut default);
    let short: Vec<_> = lacking.iter().filter(too_small).collect();
    let first = short.first().map_or(*first, |(_, missing)| *missing);
    let found = example.found.as_deref().unwrap_or_default();
    let more = match beyond.len() - 1 {
        0 => String::new(),
        1 => " and one more position".to_owned(),
        n => format!(" and {n} more positions"),
    };
    let wanted: Vec<_> = if first.path == room {
        let SceneSize { height, width, depth, .. } = enough;
        vec![format!("\"scene_size\": {{ \"height\": {height}, \"width\": {width}, \"depth\": {depth} }}")]
    } else {
        short.iter().map(|((axis, _, extent), _)| format!("\"{axis}\": {}", extent(&mut enough))).collect()
    };
    let predicate = format!(
        "is missing, and the default, {}, is too small for {} {found}{more}; write {} or more",
        first.default,
        example.path,
        crate::text::listed(&wanted, "and")
    );
    rest.insert(0, Problem { place: first.place, ..Problem::about(first.path.clone(), predicate) });
    rest
}

/// The position with the problem, if the problem is about a position.
fn position(scene: &Scene, path: &Path) -> Option<Vec3> {
    match path.segments() {
        [Segment::Key(list), Segment::Index(i), Segment::Key(key)] if key == "position" => match &**list {
            "lights" => scene.lights.get(*i)?.position,
            _ => Some(scene.objects.get(*i)?.position),
        },
        [Segment::Key(observer), Segment::Key(key)] if observer == "observer" && key == "position" => {
            Some(scene.observer.position)
        }
        _ => None,
    }
}
