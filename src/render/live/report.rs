//! The status of the shaders for display.

use std::path::PathBuf;

use super::{Key, LiveShaders, Registry, Visible};
use crate::{
    library::status::{STAND_IN, ShaderStatus, Trouble},
    platform::fs,
    shader::check::ShaderProblem,
};

impl LiveShaders {
    /// Updates the status.
    pub(super) fn report(&mut self, registry: &Registry, visible: &Visible) {
        let mut troubles: Vec<Trouble> = Vec::new();
        let mut add = |problem: &ShaderProblem, stale: Option<String>| {
            let i = troubles.iter().position(|t| t.problem == *problem).unwrap_or_else(|| {
                // Sources compiled into another crate may exist only on its author's disk.
                let there = |path: &PathBuf| !registry.is_foreign(&problem.file) || fs::is_file(path);
                let path = registry.folders().file_of(&problem.file).filter(there);
                troubles.push(Trouble { problem: problem.clone(), path, stale: Vec::new() });
                troubles.len() - 1
            });
            let known = &mut troubles[i].stale;
            let new = stale.filter(|name| !known.contains(name));
            known.extend(new);
        };
        let name = |key: &Key| {
            let Some(model) = registry.model(key.0) else { return key.0.to_owned() };
            let (name, path) = (model.declaration.name, model.declaration.wgsl.path);
            let was_never_valid =
                registry.custom_file(key.0).is_some() && registry.sources().get(path).is_none();
            match self.shaders[key].replaced.as_slice() {
                paths if was_never_valid || paths.contains(&path) => format!("{name}{STAND_IN}"),
                [] => name.to_owned(),
                paths => format!("{name} (without {})", crate::text::listed(paths, "and")),
            }
        };
        let mut keys: Vec<_> = self.shaders.keys().collect();
        keys.sort_unstable();
        for (source, problems) in self.library.unusable().filter(|(_, p)| p.has_settled()) {
            let drawn = |key: &&&Key| visible.has(key) && self.shaders[**key].shown.depends_on(source);
            for problem in &problems.what {
                add(problem, None);
                keys.iter().filter(drawn).for_each(|key| add(problem, Some(name(key))));
            }
        }
        for key in keys {
            if let Some(refused) = self.shaders[key].refused.as_ref().filter(|r| r.problem.has_settled()) {
                add(&refused.problem.what, visible.has(key).then(|| name(key)));
            }
        }
        for problem in self.unused_problems.values().filter(|p| p.has_settled()) {
            add(&problem.what, None);
        }
        let folders = registry.folders().clone();
        let status = ShaderStatus { folders, troubles, last: self.last.clone() };
        if self.status != status {
            self.status = status;
        }
    }

    /// True if there are problems that are too recent to be reported.
    pub(super) fn has_young_problems(&self) -> bool {
        self.shaders.values().any(|live| live.refused.as_ref().is_some_and(|r| !r.problem.has_settled()))
            || self.library.unusable().any(|(_, problem)| !problem.has_settled())
            || self.unused_problems.values().any(|problem| !problem.has_settled())
    }
}
