//! The lab against other programs, in one run on the same machine: the default scene against a program written in OpenGL, and
//! light with extent against Mitsuba 3. `scripts/race` builds what it takes. `cargo bench --bench race -- opengl` or
//! `-- mitsuba` races against one alone.
#![allow(missing_docs)]

mod mitsuba;
mod opengl;

fn main() {
    let named: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with('-')).collect();
    for (name, race) in [("opengl", opengl::race as fn()), ("mitsuba", mitsuba::race)] {
        if named.is_empty() || named.iter().any(|wanted| wanted == name) {
            race();
        }
    }
}
