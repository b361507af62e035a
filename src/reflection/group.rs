//! Groups of parameters: the layers of a surface, for the properties panel.

use std::collections::HashSet;

use crate::{
    parameter::Parameter,
    text::{did_you_mean, quoted},
};

/// Related parameters of a model, such as those of one layer of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Name: "Clear coat".
    pub name: &'static str,
    /// Names of the parameters, in display order.
    pub parameters: &'static [&'static str],
}

impl Group {
    /// A group with a name.
    #[must_use]
    pub const fn new(name: &'static str, parameters: &'static [&'static str]) -> Self {
        Self { name, parameters }
    }

    /// The parameters of this group among those of its model.
    pub fn of<'p>(&self, all: &'p [Parameter]) -> impl Iterator<Item = &'p Parameter> {
        self.parameters.iter().filter_map(|name| all.iter().find(|p| p.name == *name))
    }

    /// The error in the groups of a model with these parameters: the index of the group, and the sentence.
    #[must_use]
    pub fn problem(groups: &[Self], all: &[Parameter]) -> Option<(usize, String)> {
        let (mut names, mut known) = (HashSet::new(), HashSet::new());
        for (i, group) in groups.iter().enumerate() {
            let of = |what: String| Some((i, format!("group {}: {what}", quoted(group.name))));
            if group.name.trim().is_empty() {
                return of("the name is empty; it is the heading of its knobs".to_owned());
            }
            if !names.insert(group.name) {
                return of("is given twice; names must differ".to_owned());
            }
            if group.parameters.is_empty() {
                return of("has no parameters, but needs at least one".to_owned());
            }
            for name in group.parameters {
                if !all.iter().any(|p| p.name == *name) {
                    let hint = did_you_mean(name, all.iter().map(|p| (p.name, p.name)));
                    return of(format!("{} is not a parameter of the model{hint}", quoted(name)));
                }
                if !known.insert(*name) {
                    return of(format!(
                        "{} is already in a group; a parameter may be in only one",
                        quoted(name)
                    ));
                }
            }
        }
        None
    }
}

/// The parameters of a model that are not in any group.
pub fn ungrouped<'p>(groups: &[Group], all: &'p [Parameter]) -> impl Iterator<Item = &'p Parameter> {
    all.iter().filter(move |p| !groups.iter().any(|group| group.parameters.contains(&p.name)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::ParameterSet as _, reflection::Disney, reflection::ReflectionModel as _};

    #[test]
    fn each_mistake_in_groups_is_told_and_right_ones_pass() {
        let told = |groups: &[Group]| Group::problem(groups, Disney::PARAMETERS).map(|(_, what)| what);
        assert_eq!(told(Disney::GROUPS), None);
        let sheen = Group::new("Sheen", &["sheen", "sheen_tint"]);
        for (groups, expected) in [
            (vec![Group::new(" ", &["sheen"])], "the name is empty"),
            (vec![sheen, Group::new("Sheen", &["metallic"])], "is given twice"),
            (vec![Group::new("Sheen", &[])], "has no parameters"),
            (vec![Group::new("Sheen", &["shen"])], "did you mean \"sheen\"?"),
            (vec![sheen, Group::new("Cloth", &["sheen"])], "is already in a group"),
        ] {
            let what = told(&groups).expect(expected);
            assert!(what.contains(expected), "{what}");
        }
    }

    #[test]
    fn groups_and_the_rest_are_all_parameters() {
        let all = Disney::PARAMETERS;
        let groups = [Group::new("Sheen", &["sheen_tint", "sheen"])];
        let of: Vec<_> = groups[0].of(all).map(|p| p.name).collect();
        assert_eq!(of, ["sheen_tint", "sheen"], "in their order");
        assert_eq!(ungrouped(&groups, all).count() + 2, all.len());
    }
}
