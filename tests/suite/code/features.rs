//! The program alone is built with the same features as together with its tests, so that Bevy is compiled
//! once.

use std::{
    collections::{BTreeMap, BTreeSet},
    process::Command,
};

use crate::helpers::support::root;

/// The features with which each package is built, as resolved by cargo over these kinds of dependencies.
fn features(kinds: &str) -> BTreeMap<String, BTreeSet<String>> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["tree", "--offline", "--locked", "--prefix", "none", "--format", "{p}|{f}", "--edges", kinds])
        .current_dir(root())
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut packages = BTreeMap::<_, BTreeSet<_>>::new();
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        if let Some((package, features)) = line.trim_end_matches(" (*)").split_once('|') {
            packages.entry(package.to_owned()).or_default().insert(features.to_owned());
        }
    }
    packages
}

#[cfg(target_os = "linux")]
#[test]
fn the_tests_ask_for_no_other_features_than_the_program() {
    let (program, tests) = (features("normal,build"), features("normal,build,dev"));
    assert!(program.len() > 300 && program.keys().any(|p| p.starts_with("bevy_pbr ")), "{}", program.len());
    for (package, features) in &program {
        // Features for build scripts and macros are additional.
        let known = &tests[package];
        assert!(features.is_subset(known), "{package}: {features:?}, with the tests {known:?}");
    }
    for alone in ["criterion ", "jsonschema ", "proptest "] {
        assert!(!program.keys().any(|p| p.starts_with(alone)), "{alone}is part of the program");
    }
}
