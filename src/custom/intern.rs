//! Declarations of custom models live as long as the program, like those of built-in models. Equal ones are stored
//! once: re-reading a file with an unchanged declaration stores nothing new.

use std::{
    collections::HashSet,
    sync::{LazyLock, Mutex, PoisonError},
};

use crate::{
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

/// The choices of a parameter: name in files, name in the window.
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

/// The groups of parameters of a model.
pub(super) fn groups(groups: Vec<Group>) -> &'static [Group] {
    static ALL: Kept<[Group]> = Mutex::new(Vec::new());
    kept(&ALL, groups, |new| new.leak())
}

/// The curves that a model reads.
pub(super) fn curves(curves: Vec<NamedCurve>) -> &'static [NamedCurve] {
    static ALL: Kept<[NamedCurve]> = Mutex::new(Vec::new());
    kept(&ALL, curves, |new| new.leak())
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
