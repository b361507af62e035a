//! The command that views the pinned point from the side.

use super::probe;
use crate::panel::{
    keys,
    prelude::*,
    state::{Effect, Steer},
};

/// Sine of the angle below which two vectors span no usable plane.
const APART: f32 = 0.02;

/// The pinned point, whether light is bent there, and the direction that views the plane of its vectors face on: that of `N` and `L`,
/// that of `N` and `V` if the former coincide or light is bent, otherwise any plane with `N` in it.
fn side(ctx: &Context, session: &Session) -> Option<(Steer, bool)> {
    session.view.pinned?;
    let explained = probe::explained(ctx)?;
    let seen = explained.explanation.seen.as_ref()?;
    let (_, spot) = probe::shown_spot(ctx, seen)?;
    let l = probe::shown_light(ctx, spot).and_then(|lit| Some(lit.leading()?.l));
    let (up, right) = (session.facts.camera * Vec3::Y, session.facts.camera * Vec3::X);
    let bent = spot.refraction.as_ref().map(|_| spot.view);
    let ways = bent.into_iter().chain(l).chain([spot.view, up, right]).map(|other| spot.normal.cross(other));
    let way = ways.into_iter().find(|way| way.is_finite() && way.length() > APART)?;
    Some((Steer::Along { point: seen.position, way: way.normalize() }, bent.is_some()))
}

/// True if there is a pinned point that can be viewed from the side.
pub fn has_sides(ctx: &Context, session: &Session) -> bool {
    side(ctx, session).is_some()
}

/// Completes the action that views from the side with the pinned point.
pub fn placed(ctx: &Context, session: &Session, action: Action) -> Action {
    match (action, side(ctx, session)) {
        (Action::LookFromSide, Some((steer, is_bent))) => {
            // The way inside begins with the ray of the observer: of another one it would be another.
            if is_bent {
                probe::keep_ray(ctx, session);
            }
            Action::Do(Effect::Steer(steer))
        }
        (Action::LookFromSide, None) => {
            let key = keys::word(ctx, "explain");
            let why = format!(
                "There is no pinned point to look at from the side: {key} explains the point at the pointer, and pins it."
            );
            Action::Say(Severity::Info, why)
        }
        (action, _) => action,
    }
}
