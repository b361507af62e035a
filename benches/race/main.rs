//! The lab compared with other programs, in one run on the same machine: the default scene with a program
//! written in OpenGL, and light with extent with Mitsuba 3. `scripts/race` builds everything needed. `cargo
//! bench --bench race -- opengl` or `-- mitsuba` runs one of them.
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
