//! Which classes of a layer can never be reached, because classes before them match all their
//! objects.
//!
//! The values of a key fall into *atoms*, in which all values fulfil the same conditions: no tag,
//! each value that the table names, other values that are no numbers, and other numbers between two
//! bounds of ranges. An alternative of a class is then a box: a set of atoms for each key. A class
//! cannot be reached if the boxes of the classes before it cover all its boxes, which is decided by
//! cutting the boxes before it out of each box.

use std::collections::{BTreeMap, BTreeSet};

use crate::{
    ClassForm, LayerTableError, TablePath, TableStep, TagCondition, TagRule, TagUnit,
    atom_set::AtomSet, tag_condition::is_between,
};

/// Why a class is taken as unreachable.
pub(crate) enum Shadow {
    /// These classes match all its objects.
    ByClasses(Vec<String>),
    /// The decision takes more than [`MAX_STEPS`].
    Unknown,
}

/// The largest number of boxes that are compared for one layer.
const MAX_STEPS: usize = 1 << 21;

/// Returns the first class that cannot be reached, by its index.
///
/// # Errors
/// When a key is compared with numbers in two units.
pub(crate) fn shadows(classes: &[ClassForm]) -> Result<Option<(usize, Shadow)>, LayerTableError> {
    let keys = atoms_by_key(classes)?;
    let mut before: Vec<(usize, TagBox<'_>)> = Vec::new();
    let mut steps = MAX_STEPS;
    for (index, class) in classes.iter().enumerate() {
        let alternatives = class.tags.alternatives().iter();
        let boxes: Vec<TagBox<'_>> = alternatives
            .map(|conditions| {
                let set = |(key, condition): (&'_ String, &TagCondition)| {
                    keys.get_key_value(key.as_str())
                        .map(|(key, atoms)| (*key, atoms.fulfilling(condition)))
                };
                conditions.iter().filter_map(set).collect()
            })
            .collect();
        let mut by = BTreeSet::new();
        let mut is_covered = !boxes.is_empty();
        for own in &boxes {
            match cover(own.clone(), &before, &keys, &mut by, &mut steps) {
                None => return Ok(Some((index, Shadow::Unknown))),
                Some(covered) => is_covered &= covered,
            }
            if !is_covered {
                break;
            }
        }
        if is_covered {
            let names = by.iter().map(|&class: &usize| classes[class].id.clone()).collect();
            return Ok(Some((index, Shadow::ByClasses(names))));
        }
        before.extend(boxes.into_iter().map(|own| (index, own)));
    }
    Ok(None)
}

/// The objects whose tags are in these sets; other keys do not matter.
type TagBox<'a> = BTreeMap<&'a str, AtomSet>;

/// The atoms of a key.
struct KeyAtoms {
    /// The values that the table names, ascending: atoms 1, 2 ….
    values: Vec<String>,
    /// The bounds of ranges, ascending: the last atoms are the numbers below the first one, between
    /// two of them, and from the last one on.
    bounds: Vec<f64>,
}

/// The atom of objects without the tag.
const NO_TAG: usize = 0;

impl KeyAtoms {
    fn count(&self) -> usize {
        2 + self.values.len() + if self.bounds.is_empty() { 0 } else { self.bounds.len() + 1 }
    }

    /// The atoms whose values fulfil a condition.
    fn fulfilling(&self, condition: &TagCondition) -> AtomSet {
        let named =
            condition.values().iter().filter_map(|value| self.values.binary_search(value).ok());
        let named = named.map(|value| 1 + value);
        match condition {
            TagCondition::Absent => AtomSet::new(self.count(), [NO_TAG]),
            TagCondition::OneOf(_) => AtomSet::new(self.count(), named),
            TagCondition::NoneOf(_) => AtomSet::without(self.count(), named),
            TagCondition::Present | TagCondition::OtherThan(_) => {
                AtomSet::without(self.count(), named.chain([NO_TAG]))
            }
            TagCondition::Range { min, below, .. } => {
                let is_met = |&value: &usize| condition.is_met(Some(&self.values[value]));
                let named = (0..self.values.len()).filter(is_met).map(|value| 1 + value);
                // The bounds are all bounds of ranges, so one number decides for its interval.
                let numbers = [f64::NEG_INFINITY].into_iter().chain(self.bounds.iter().copied());
                let first = 2 + self.values.len();
                let intervals = (first..).zip(numbers);
                let intervals = intervals.filter(|&(_, number)| is_between(*min, *below, number));
                AtomSet::new(self.count(), named.chain(intervals.map(|(atom, _)| atom)))
            }
        }
    }
}

/// Collects the values and bounds of all conditions, by key.
fn atoms_by_key(classes: &[ClassForm]) -> Result<BTreeMap<&str, KeyAtoms>, LayerTableError> {
    let mut keys: BTreeMap<&str, (KeyAtoms, Option<TagUnit>)> = BTreeMap::new();
    for (index, class) in classes.iter().enumerate() {
        let alternatives = class.tags.alternatives().iter().enumerate();
        let conditions =
            alternatives.flat_map(|(number, one)| one.iter().map(move |one| (number, one)));
        for (alternative, (key, condition)) in conditions {
            let empty = || (KeyAtoms { values: Vec::new(), bounds: Vec::new() }, None);
            let (atoms, unit) = keys.entry(key).or_insert_with(empty);
            match condition {
                TagCondition::Present | TagCondition::Absent => {}
                TagCondition::OneOf(values)
                | TagCondition::NoneOf(values)
                | TagCondition::OtherThan(values) => atoms.values.extend(values.iter().cloned()),
                TagCondition::Range { min, below, unit: own } => {
                    if *unit.get_or_insert(*own) != *own {
                        let is_list = matches!(class.tags, TagRule::AnyOf(_));
                        let alternative = is_list.then_some(TableStep::Index(alternative));
                        return Err(two_units(index, alternative, key));
                    }
                    atoms.bounds.extend(min.iter().chain(below));
                }
            }
        }
    }
    let sorted = keys.into_iter().map(|(key, (mut atoms, _))| {
        atoms.values.sort_unstable();
        atoms.values.dedup();
        atoms.bounds.sort_unstable_by(f64::total_cmp);
        atoms.bounds.dedup();
        (key, atoms)
    });
    Ok(sorted.collect())
}

fn two_units(class: usize, alternative: Option<TableStep>, key: &str) -> LayerTableError {
    let own = |key: &str| TableStep::Key(key.to_owned());
    let steps = [own("class"), TableStep::Index(class), own("tags")];
    let steps = steps.into_iter().chain(alternative).chain([own(key)]);
    LayerTableError {
        path: TablePath(steps.collect()),
        problem: "ranges of this key have two units; use one".to_owned(),
    }
}

/// Whether boxes cover a box, with the classes of those that do; `None` if no steps are left.
fn cover<'a>(
    mut own: TagBox<'a>,
    before: &[(usize, TagBox<'a>)],
    keys: &BTreeMap<&'a str, KeyAtoms>,
    by: &mut BTreeSet<usize>,
    steps: &mut usize,
) -> Option<bool> {
    *steps = steps.checked_sub(1 + before.len())?;
    let meets = |(_, other): &(usize, TagBox<'a>)| {
        other.iter().all(|(key, set)| own.get(key).is_none_or(|own| !own.is_disjoint(set)))
    };
    let contains = |(_, other): &&(usize, TagBox<'a>)| {
        other.iter().all(|(key, set)| own.get(key).is_some_and(|own| own.is_subset(set)))
    };
    if let Some((class, _)) = before.iter().find(contains) {
        by.insert(*class);
        return Some(true);
    }
    let Some(first) = before.iter().position(meets) else { return Some(false) };
    let (class, other) = &before[first];
    let rest = &before[first + 1..];
    by.insert(*class);
    for (key, set) in other {
        let all = || AtomSet::without(keys.get(key).map_or(0, KeyAtoms::count), []);
        let own_set = own.get(key).cloned().unwrap_or_else(all);
        let outside = own_set.minus(set);
        if !outside.is_empty() {
            let mut piece = own.clone();
            piece.insert(key, outside);
            if !cover(piece, rest, keys, by, steps)? {
                return Some(false);
            }
        }
        own.insert(key, own_set.and(set));
    }
    Some(true)
}

#[cfg(test)]
#[path = "shadowing_tests.rs"]
mod tests;
