//! `lcm new`: the default scene as a new file.

use std::path::Path;

use super::{Options, Outcome};
use crate::files::Shown as _;
use crate::{
    failure::Failure,
    registry::Registry,
    scene::{
        Scene,
        save::{self, Expected},
    },
};

pub(super) fn run(file: &Path, options: Options, registry: &Registry) -> Outcome {
    save::write(file, &Scene::default(), registry, Expected::Nothing)
        .map_err(|error| Failure::Write(error.to_string()))?;
    options.tell(format_args!("wrote {}", file.shown()));
    Ok(())
}
