//! All integration tests, one binary: it links Bevy once.

mod panels;
