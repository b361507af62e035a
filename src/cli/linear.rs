//! The option for the layers of linear pictures.

use super::one_of;
use crate::{channel::LayerKind, text::listed};

/// The kinds of layers in a picture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Kinds(pub(super) Vec<LayerKind>);

/// The word for all kinds.
const ALL: &str = "all";

/// Parser of kinds of layers, with commas between them.
pub(super) fn kinds(text: &str) -> Result<Kinds, String> {
    let mut kinds = Vec::new();
    for word in text.split(',').map(str::trim) {
        match LayerKind::from_id(word) {
            Some(kind) => kinds.push(kind),
            None if word == ALL => kinds.extend(LayerKind::ALL),
            None => return Err(one_of("each layer", word, &known())),
        }
    }
    Ok(Kinds(kinds))
}

/// The help of the option.
pub(super) fn help() -> String {
    let known = listed(&known(), "or");
    format!("Add layers to an OpenEXR picture, with commas between them: {known}")
}

fn known() -> Vec<&'static str> {
    LayerKind::ALL.iter().map(|kind| kind.id()).chain([ALL]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_of_layers_are_words_with_commas() {
        let read = |text| kinds(text).map(|kinds| kinds.0);
        assert_eq!(read("depth"), Ok(vec![LayerKind::Depth]));
        assert_eq!(read("lights, normals"), Ok(vec![LayerKind::Lights, LayerKind::Normals]));
        assert_eq!(read("all"), Ok(LayerKind::ALL.to_vec()));
        let rule = "each layer must be normals, face_normals, depth, terms, lights or all";
        assert_eq!(read("depths"), Err(format!("{rule}; did you mean depth?")));
        for empty in ["", "depth,", ","] {
            assert_eq!(read(empty), Err(rule.to_owned()));
        }
    }
}
