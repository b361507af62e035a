//! The `view` block: the window on entering a step.

use super::{
    PartName,
    draft::Draft,
    problem::Problems,
    words::{Line, Piece, pair},
};
use crate::{
    channel::DebugChannel,
    curves::Kind,
    optics::TermSelection,
    scene::variant::LETTERS,
    text::{did_you_mean, listed, quoted},
};

/// The settings: the key, its values, and its meaning.
pub const SETTINGS: &[(&str, &str, &str)] = &[
    ("channel", "id of a debug channel, or `none`", "the debug channel of the active view"),
    ("terms", "`all`, `ambient`, `diffuse` or `specular`", "the terms of the equation that are shown"),
    ("explain", "`on` or `off`", "the panel *Explain*"),
    ("plots", "id of a plot, or `off`", "the panel *Plots*"),
    ("markers", "`on` or `off`", "the markers of lights, which may cover what a step is about"),
    ("active", "`A` to `D`", "the view that the panels show and change"),
    ("select", "`room`, `observer`, `object 1`, `light \"key light\"`, …", "the selected part"),
    (
        "pin",
        "`X, Y` from 0 to 1, or `none`",
        "the pinned pixel: fractions of the picture from the left and the top",
    ),
];

/// The words of settings that are on or off.
const SWITCH: [(&str, bool); 2] = [("on", true), ("off", false)];

/// A word from a list; reports an unknown one.
fn one_of<T: Clone>(key: &str, value: Piece, known: &[(&str, T)], problems: &mut Problems) -> Option<T> {
    let found = known.iter().find(|(word, _)| *word == value.text);
    if found.is_none() {
        let words: Vec<_> = known.iter().map(|(word, _)| *word).collect();
        let near = did_you_mean(value.text, words.iter().map(|w| (*w, *w)));
        let rule = format!("it must be {}{near}", listed(&words, "or"));
        problems.at(value.at, format!("{key} is {}, but {rule}", quoted(value.text)));
    }
    found.map(|(_, meaning)| meaning.clone())
}

/// Reads a line of a `view` block. Keeps the bytes of parts and views, to be looked up in the scene.
pub(super) fn setting(
    line: &Line,
    given: &mut Vec<&'static str>,
    draft: &mut Draft,
    problems: &mut Problems,
) {
    let Draft { settings: places, misnamed, step, .. } = draft;
    let window = &mut step.window;
    let Some((key, value)) = pair(line) else {
        problems.at(line.piece().at, "each line of a view block must be SETTING: VALUE");
        return;
    };
    let keys: Vec<_> = SETTINGS.iter().map(|(key, ..)| *key).collect();
    let Some(known) = problems.key(key, ("a view block", "setting"), &keys, given) else { return };
    places.push((known, value.at));
    match known {
        "channel" => {
            let channels = DebugChannel::ALL.map(|channel| (channel.id(), Some(channel)));
            let all: Vec<_> = channels.into_iter().chain([("none", None)]).collect();
            window.channel = one_of(known, value, &all, problems);
        }
        "terms" => window.terms = one_of(known, value, &TermSelection::ALL.map(|t| (t.id(), t)), problems),
        "explain" => window.explain = one_of(known, value, &SWITCH, problems),
        "markers" => window.markers = one_of(known, value, &SWITCH, problems),
        "plots" => {
            let kinds = Kind::ALL.map(|kind| (kind.id(), Some(kind)));
            let all: Vec<_> = kinds.into_iter().chain([("off", None)]).collect();
            window.plots = one_of(known, value, &all, problems);
        }
        "active" => {
            let letters: Vec<_> = LETTERS.into_iter().enumerate().map(|(i, letter)| (letter, i)).collect();
            window.active = one_of(known, value, &letters, problems);
        }
        "select" => match PartName::parse(value) {
            Ok(part) => window.select = Some(part),
            Err(what) => {
                problems.at(value.at, what);
                misnamed.push((value.at, value.text.to_owned()));
            }
        },
        _ => window.pin = pin(value, problems),
    }
}

fn pin(value: Piece, problems: &mut Problems) -> Option<Option<[f32; 2]>> {
    if value.text == "none" {
        return Some(None);
    }
    let numbers: Vec<f32> = value.text.split(',').map_while(|part| part.trim().parse().ok()).collect();
    match numbers.as_slice() {
        [x, y] if value.text.matches(',').count() == 1 && [x, y].iter().all(|n| (0.0..=1.0).contains(*n)) => {
            Some(Some([*x, *y]))
        }
        _ => {
            let rule = "pin must be none, or two numbers from 0 to 1: X, Y from the top left of the picture";
            problems.at(value.at, format!("this is {}, but {rule}", quoted(value.text)));
            None
        }
    }
}
