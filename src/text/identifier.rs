//! The identifiers of scene files: ids, and names of parameters.

/// Maximum length of an id or a parameter name, in characters.
pub const LONGEST_ID: usize = 40;

/// Checks an id or a parameter name.
///
/// # Errors
/// Returns [`identifier_rule`] if the identifier is invalid.
pub fn identifier(id: &str) -> Result<(), String> {
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let starts = id.starts_with(|c: char| c.is_ascii_lowercase());
    if !starts || !id.chars().all(legal) || id.len() > LONGEST_ID {
        return Err(identifier_rule());
    }
    Ok(())
}

/// The rule of [`identifier`].
#[must_use]
pub fn identifier_rule() -> String {
    format!(
        "must be lower-case letters, digits and underscores, begin with a letter and have at most {LONGEST_ID} characters"
    )
}

/// The identifier that was probably meant by a word.
#[must_use]
pub fn as_identifier(word: &str) -> Option<String> {
    let mut out = String::new();
    let mut before = ' ';
    for c in word.chars() {
        // bandCount becomes band_count, and ID id.
        let new_word = c.is_ascii_uppercase() && before.is_ascii_lowercase();
        if (new_word || !c.is_ascii_alphanumeric()) && !out.is_empty() && !out.ends_with('_') {
            out.push('_');
        }
        if c.is_ascii_alphanumeric() {
            out.push(c.to_ascii_lowercase());
        }
        before = c;
    }
    let out = out.trim_end_matches('_');
    identifier(out).is_ok().then(|| out.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_is_no_identifier_leads_to_one_that_is() {
        for (word, meant) in [
            ("Bad Id!", Some("bad_id")),
            ("my-lamp", Some("my_lamp")),
            ("bandCount", Some("band_count")),
            ("ID", Some("id")),
            ("toon", Some("toon")),
            ("_x", Some("x")),
            ("3d", None),
            ("", None),
        ] {
            assert_eq!(as_identifier(word).as_deref(), meant, "{word}");
            assert_eq!(identifier(word).is_ok(), meant == Some(word), "{word}");
        }
    }
}
