//! The status of the shaders for display.

use std::path::PathBuf;

use super::{Key, LiveShaders, Registry, Visible};
use crate::{
    library::status::{STAND_IN, ShaderStatus, Trouble},
    shader::check::ShaderProblem,
};

impl LiveShaders {
    /// Updates the status.
    pub(super) fn report(&mut self, registry: &Registry, visible: &Visible) {
        let mut troubles: Vec<Trouble> = Vec::new();
        let mut add = |problem: &ShaderProblem, stale: Option<String>| {
            let i = troubles.iter().position(|t| t.problem == *problem).unwrap_or_else(|| {
                // Sources compiled into another crate may exist only on its author's disk.
                let there = |path: &PathBuf| !registry.is_foreign(&problem.file) || path.is_file();
                let path = registry.folders().file_of(&problem.file).filter(there);
                troubles.push(Trouble { problem: problem.clone(), path, stale: Vec::new() });
                troubles.len() - 1
            });
            if let Some(name) = stale
                && !troubles[i].stale.contains(&name)
            {
                troubles[i].stale.push(name);
            }
        };
        let name = |key: &Key| match registry.model(key.0) {
            // A file that was never valid.
            Some(m)
                if registry.custom_file(key.0).is_some()
                    && registry.sources().get(m.declaration.wgsl.path).is_none() =>
            {
                format!("{}{STAND_IN}", m.declaration.name)
            }
            Some(model) => {
                let (name, replaced) = (model.declaration.name, &self.shaders[key].replaced);
                match replaced.as_slice() {
                    [] => name.to_owned(),
                    paths if paths.contains(&model.declaration.wgsl.path) => {
                        format!("{name}{STAND_IN}")
                    }
                    paths => format!("{name} (without {})", crate::text::listed(paths, "and")),
                }
            }
            None => key.0.to_owned(),
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
