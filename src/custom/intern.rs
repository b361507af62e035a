//! Declarations of custom models live as long as the program, as those of built-in models do. Equal ones are
//! the same one: reading a file again whose declaration did not change keeps nothing new, and whoever asks
//! whether it changed compares pointers.

use std::{
    collections::HashSet,
    sync::{LazyLock, Mutex, PoisonError},
};

use crate::{
    parameter::Parameter,
    reflection::{Declaration, EquationPart},
};

/// What has been kept of one type.
type Kept<T> = Mutex<Vec<&'static T>>;

/// The kept value that is equal to another; the other itself, kept from now on, if there is none.
fn kept<T: PartialEq + ?Sized, O>(all: &'static Kept<T>, new: O, keep: fn(O) -> &'static T) -> &'static T
where
    O: AsRef<T>,
{
    let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
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
    let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(old) = all.get(text) {
        return old;
    }
    let new: &'static str = Box::leak(text.into());
    all.insert(new);
    new
}

/// The choices of a parameter: name in files, name for people.
pub(super) fn options(options: Vec<(&'static str, &'static str)>) -> &'static [(&'static str, &'static str)] {
    static ALL: Kept<[(&str, &str)]> = Mutex::new(Vec::new());
    kept(&ALL, options, |new| new.leak())
}

/// The names of choices.
pub(super) fn names(names: Vec<&'static str>) -> &'static [&'static str] {
    static ALL: Kept<[&str]> = Mutex::new(Vec::new());
    kept(&ALL, names, |new| new.leak())
}

/// The parts of an equation.
pub(super) fn equation(parts: Vec<EquationPart>) -> &'static [EquationPart] {
    static ALL: Kept<[EquationPart]> = Mutex::new(Vec::new());
    kept(&ALL, parts, |new| new.leak())
}

/// The parameters of a model.
pub(super) fn parameters(parameters: Vec<Parameter>) -> &'static [Parameter] {
    static ALL: Kept<[Parameter]> = Mutex::new(Vec::new());
    kept(&ALL, parameters, |new| new.leak())
}

/// A declaration.
pub(super) fn declaration(declaration: Declaration) -> &'static Declaration {
    static ALL: Kept<Declaration> = Mutex::new(Vec::new());
    kept(&ALL, Box::new(declaration), |new| Box::leak(new))
}
