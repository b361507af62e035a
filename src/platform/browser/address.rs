//! The command line that the address of a page means.

/// The arguments that a query and a fragment mean. What has another name is left out. Of two scenes, the one that the address
/// holds is opened.
pub(super) fn arguments(query: &str, fragment: &str) -> Vec<String> {
    let mut arguments = vec!["lcm".to_owned()];
    let held = fragment.starts_with("#scene=").then(|| decoded(fragment));
    for part in query.trim_start_matches('?').split('&') {
        let Some((name, value)) = part.split_once('=') else { continue };
        let value = decoded(value);
        match name {
            "lesson" | "step" => arguments.push(format!("--{name}={value}")),
            "scene" if held.is_none() && !value.starts_with('-') => arguments.push(value),
            _ => {}
        }
    }
    arguments.extend(held);
    arguments
}

/// A text with `%20` and `+` replaced by what they stand for.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).filter(|_| *first == b'%');
        let code = code.and_then(|code| u8::from_str_radix(std::str::from_utf8(code).ok()?, 16).ok());
        bytes.push(match (code, first) {
            (Some(code), _) => code,
            (None, b'+') => b' ',
            (None, other) => *other,
        });
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
