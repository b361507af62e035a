//! Shaders that may end the program. Where no other process tries them, a driver that hangs or crashes takes the page with
//! it: each is noted until a picture with it is drawn, and a page that finds one noted by a page that has ended refuses it.

use std::{
    hash::{DefaultHasher, Hash as _, Hasher as _},
    sync::{Arc, Mutex},
};

use bevy::prelude::*;

use super::process::{Request, refused_whole};
use crate::{
    caught::lock,
    platform,
    shader::{check::ShaderProblem, compose::Composed},
};

/// Number of frames until a shader is drawn with: it is exchanged in the first, and compiled in the next ones.
const FRAMES: u32 = 4;

/// The shaders that may end the program, and those that did. Clones share them.
#[derive(Clone, Debug, Default, Resource)]
pub(super) struct Risks(Arc<Mutex<Noted>>);

#[derive(Debug, Default)]
struct Noted {
    /// Those that have ended the program.
    fatal: Vec<String>,
    /// Those whose first picture is not drawn yet, and the number of frames since.
    tried: Vec<(String, u32)>,
}

/// The name of a shader: a hash of its text, and its file.
fn name(composed: &Composed, faces: bool) -> String {
    let mut hasher = DefaultHasher::new();
    (&composed.text, faces).hash(&mut hasher);
    let file = composed.map.files().find(|file| file.starts_with("models/"));
    format!("{:016x} {}", hasher.finish(), file.unwrap_or("an edited shader"))
}

impl Risks {
    /// Begins with the names of shaders that have ended the program.
    pub(super) fn new(fatal: Vec<String>) -> Self {
        Self(Arc::new(Mutex::new(Noted { fatal, tried: Vec::new() })))
    }

    /// The reason not to draw with a shader, if it has ended the program.
    pub(super) fn refused(&self, composed: &Composed, faces: bool) -> Option<Box<ShaderProblem>> {
        if !lock(&self.0).fatal.contains(&name(composed, faces)) {
            return None;
        }
        let message = "the page ended when it first drew with it: the graphics driver may hang or crash; change it to try it \
                       again";
        let (text, map) = (composed.text.clone(), composed.map.clone());
        Some(refused_whole(&Request { text, map, faces, row: Vec::new() }, message.to_owned()))
    }

    /// Notes a shader that is about to be drawn with.
    pub(super) fn begin(&self, composed: &Composed, faces: bool) {
        let name = name(composed, faces);
        self.change(|tried| {
            tried.retain(|(known, _)| *known != name);
            tried.push((name, 0));
        });
    }

    /// True if more frames are needed to draw with a noted shader.
    pub(super) fn wants_frames(&self) -> bool {
        lock(&self.0).tried.iter().any(|(_, frames)| *frames < FRAMES)
    }

    /// Counts a frame. Returns the shaders whose first picture the driver has by now.
    pub(super) fn frame(&self) -> Vec<String> {
        let mut noted = lock(&self.0);
        noted.tried.iter_mut().for_each(|(_, frames)| *frames += 1);
        noted.tried.iter().filter(|(_, frames)| *frames == FRAMES).map(|(name, _)| name.clone()).collect()
    }

    /// Removes shaders whose picture is drawn.
    pub(super) fn drawn(&self, names: &[String]) {
        self.change(|tried| tried.retain(|(name, frames)| *frames < FRAMES || !names.contains(name)));
    }

    fn change(&self, change: impl FnOnce(&mut Vec<(String, u32)>)) {
        let mut noted = lock(&self.0);
        change(&mut noted.tried);
        let names: Vec<_> = noted.tried.iter().map(|(name, _)| name.as_str()).collect();
        platform::note_trials(&names.join("\n"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shader(text: &str) -> Composed {
        Composed { text: text.to_owned(), ..Composed::default() }
    }

    #[test]
    fn a_shader_is_noted_until_its_picture_is_drawn() {
        let (risks, [a, b]) = (Risks::default(), ["a", "b"].map(shader));
        assert!(!risks.wants_frames() && risks.frame().is_empty());
        risks.begin(&a, false);
        let names: Vec<_> = (0..FRAMES).flat_map(|_| risks.frame()).collect();
        assert_eq!(names, [name(&a, false)]);
        assert!(!risks.wants_frames() && risks.frame().is_empty(), "once");
        risks.begin(&b, true);
        assert!(risks.wants_frames());
        let noted =
            |risks: &Risks| lock(&risks.0).tried.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        assert_eq!(noted(&risks), [name(&a, false), name(&b, true)]);
        // The same text again, before its picture is drawn.
        risks.begin(&a, false);
        risks.drawn(&names);
        assert_eq!(noted(&risks), [name(&b, true), name(&a, false)]);
        let names: Vec<_> = (0..FRAMES).flat_map(|_| risks.frame()).collect();
        risks.drawn(&names);
        assert_eq!(noted(&risks), Vec::<String>::new());
    }

    #[test]
    fn what_has_ended_the_program_is_refused_until_it_is_changed() {
        let fatal = shader("fn f() {}\n");
        let risks = Risks::new(vec![name(&fatal, false)]);
        let problem = risks.refused(&fatal, false).expect("refused");
        assert!(problem.message.contains("the page ended"), "{problem:?}");
        assert_eq!(risks.refused(&fatal, true), None, "another pipeline");
        assert_eq!(risks.refused(&shader("fn g() {}\n"), false), None);
    }
}
