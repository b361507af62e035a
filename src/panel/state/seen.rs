//! The scene as seen in the active view.

use std::sync::Arc;

use super::terms::KnownTerms;
use crate::{
    document::{Document, Extent, Revision},
    registry::Registry,
    scene::{Scene, Variant},
};

/// The scene as seen in the active view, with its known terms.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    /// The scene, unless it is that of the document itself.
    in_view: Option<InView>,
    /// The terms that pictures of scenes have.
    pub(super) terms: KnownTerms,
}

/// The scene that a view showed at a revision of the document.
#[derive(Clone, Debug)]
struct InView {
    at: (Revision, usize),
    variant: Variant,
    /// The models of the scene itself.
    models: [String; 2],
    scene: Arc<Scene>,
}

impl Seen {
    /// The scene as seen in a view; that of the document while it is [stale](Self::is_stale).
    pub(super) fn scene<'a>(&'a self, document: &'a Document, view: usize) -> &'a Scene {
        match &self.in_view {
            Some(seen) if view > 0 && seen.at == (document.revision(), view) => &seen.scene,
            _ => document,
        }
    }

    /// True if another view was looked at, or an earlier revision.
    pub(super) fn is_stale(&self, document: &Document, view: usize) -> bool {
        let now = (view > 0).then(|| (document.revision(), view));
        self.in_view.as_ref().map(|seen| seen.at) != now
    }

    /// Looks at a view, at a cost that grows with the changes since the last look.
    pub(super) fn look(&mut self, document: &Document, view: usize, registry: &Registry) {
        let before = self.in_view.take();
        let Some(variant) = document.overrides(view) else { return };
        let models = [document.reflection_model.clone(), document.shading_model.clone()];
        let same = |seen: &InView| {
            seen.at.1 == view && seen.models == models && seen.variant.shows_objects_like(&variant)
        };
        let kept = before.filter(same).and_then(|seen| {
            let parts = document.changes_since(seen.at.0)?;
            Some((parts, seen.scene))
        });
        let scene = match kept {
            Some((parts, mut scene)) => {
                let seen = Arc::make_mut(&mut scene);
                for part in parts {
                    part.copy(document, seen);
                    match part {
                        Extent::Object(i) => variant.apply_to_object(seen, i, registry),
                        _ => variant.lay_over_rest(seen),
                    }
                }
                scene
            }
            None => Arc::new(variant.applied(document, registry)),
        };
        self.in_view = Some(InView { at: (document.revision(), view), variant, models, scene });
    }
}
