//! Pages of several tests.

use std::{path::PathBuf, sync::LazyLock};

use lights_camera_models::{
    export::{Export, Progress, Request, html},
    registry::Registry,
    scene::load::{self, Defaults},
};

use super::support::shipped_scenes;

/// The shipped scenes as pages that explain no point, whatever their size; made once, since all together take long.
pub static PAGES: LazyLock<Vec<(PathBuf, Export)>> = LazyLock::new(|| {
    let registry = Registry::builtin();
    let page = |path: PathBuf| {
        let scene = load::file(&path, &registry, Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
        let (scene, registry) = (&scene, &registry);
        let request = Request { scene, registry, stem: "scene", size: (1280, 720), object: 0, point: None };
        let export = (html::HTML.make)(&request, &Progress::NONE);
        let export = export.unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert!(export.files.len() == 1 && export.files[0].path.is_empty());
        (path, export)
    };
    shipped_scenes().into_iter().map(page).collect()
});
