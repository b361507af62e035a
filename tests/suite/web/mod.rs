//! The whole program in a browser: Chromium, and the site that `scripts/web` builds.

#![cfg(target_os = "linux")]

mod laboratory;
mod links;
mod pictures;
mod tabs;
mod work;
