//! Declarations of custom models live as long as the program, like those of built-in models. Equal ones are stored
//! once: re-reading a file with an unchanged declaration stores nothing new.

use std::{
    collections::HashSet,
    sync::{LazyLock, Mutex},
};

use crate::{
    caught::lock,
    optics::albedo::NamedCurve,
    parameter::Parameter,
    reflection::{Declaration, EquationPart, Group},
};

/// The stored values of one type.
type Kept<T> = Mutex<Vec<&'static T>>;

/// The stored value equal to `new`, which is stored if there was none.
fn kept<T: PartialEq + ?Sized, O>(all: &'static Kept<T>, new: O, keep: fn(O) -> &'static T) -> &'static T
where
    O: AsRef<T>,
{
    let mut all = lock(all);
    if let Some(old) = all.iter().find(|old| ***old == *new.as_ref()) {
        return old;
    }
    let new = keep(new);
    all.push(new);
    new
}

/// A text. There are many: a folder of 500 models has thousands.
pub(super) fn text(text: &str) -> &'static str {
    static ALL: LazyLock<Mutex<HashSet<&'static str>>> = LazyLock::new(Mutex::default);
    let mut all = lock(&ALL);
    if let Some(old) = all.get(text) {
        return old;
    }
    let new: &'static str = Box::leak(text.into());
    all.insert(new);
    new
}

macro_rules! lists {
    ($($(#[$about:meta])* $name:ident: $Item:ty;)*) => {
        $($(#[$about])* pub(super) fn $name(all: Vec<$Item>) -> &'static [$Item] {
            static ALL: Kept<[$Item]> = Mutex::new(Vec::new());
            kept(&ALL, all, |new| new.leak())
        })*
    };
}

lists! {
    /// The choices of a parameter: name in files, name in the window.
    options: (&'static str, &'static str);
    /// The names of choices.
    names: &'static str;
    /// The parts of an equation.
    equation: EquationPart;
    /// The groups of parameters of a model.
    groups: Group;
    /// The curves that a model reads.
    curves: NamedCurve;
    /// The parameters of a model.
    parameters: Parameter;
}

/// A declaration.
pub(super) fn declaration(declaration: Declaration) -> &'static Declaration {
    static ALL: Kept<Declaration> = Mutex::new(Vec::new());
    kept(&ALL, Box::new(declaration), |new| Box::leak(new))
}
