//! The integration tests, in one binary: linking Bevy once is enough.
#![allow(missing_docs, clippy::unwrap_used)]

mod code;
mod commands;
mod comparing;
mod documents;
mod editing;
mod explaining;
mod exports;
mod helpers;
mod hostile;
mod lessons;
mod library;
mod models;
mod renderers;
mod scenes;
mod web;
mod window;
