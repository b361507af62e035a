//! Tests that a machine cannot run: they are listed where `scripts/test` prints them at the end, since a test that passes
//! without running would say nothing.

use std::{fs::File, io::Write as _, path::Path, thread};

/// Lists the running test as skipped: the reason, and the remedy.
pub fn skip(why: &str) {
    let thread = thread::current();
    let line = format!("skipped: {}: {why}\n", thread.name().unwrap_or("a test"));
    // Printed past the capture of tests.
    let _ = std::io::stderr().write_all(line.as_bytes());
    let list = Path::new(env!("CARGO_TARGET_TMPDIR")).join("skipped.txt");
    let file = File::options().create(true).append(true).open(list);
    file.and_then(|mut file| file.write_all(line.as_bytes())).expect("the list can be written");
}
