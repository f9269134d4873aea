//! The values that are compared between two plans, as pairs of a name that users know and a value
//! in words.

use corniche_settings::{SettingSection, SettingValue, SettingsRecord};
use corniche_tileset::ReliefLevels;

/// A setting's name, and its value in words.
pub(crate) type Fact = (String, String);

/// The sentence about one value that differs.
pub(crate) fn different(name: &str, ours: &str, theirs: &str) -> String {
    format!("{name} is {ours}, but the store was created with {theirs}")
}

pub(crate) fn different_facts(ours: &[Fact], theirs: &[Fact]) -> Vec<String> {
    let mut said: Vec<String> = ours
        .iter()
        .zip(theirs)
        .filter(|(ours, theirs)| ours != theirs)
        .map(|((name, ours), (_, theirs))| different(name, ours, theirs))
        .collect();
    if ours.len() != theirs.len() {
        said.push(format!(
            "there are {} values here and {} in the store",
            ours.len(),
            theirs.len()
        ));
    }
    said
}

/// Returns in words how the settings for the ground differ from those that a package records.
/// Settings for roads are not compared, and photos are reused with the terrain.
pub(crate) fn terrain_differences(ours: &SettingsRecord, package: &SettingsRecord) -> Vec<String> {
    let mut theirs = package.clone();
    // A polygon with another name is the same polygon.
    if let (Some(own), Some(recorded)) = (&ours.polygon, &mut theirs.polygon)
        && own.sha256 == recorded.sha256
    {
        recorded.name.clone_from(&own.name);
    }
    // The relief of a package may be omitted.
    if ours.relief == ReliefLevels::Off {
        theirs.relief = ReliefLevels::Off;
    }
    differences_from(ours, &theirs, &[SettingSection::Terrain])
}

/// Returns in words how the settings for roads and layers differ from those that a package records.
/// Settings for the ground are not compared.
#[must_use]
pub fn network_differences(ours: &SettingsRecord, package: &SettingsRecord) -> Vec<String> {
    // The labels of classes do not change roads.
    let theirs = SettingsRecord { class_labels: ours.class_labels.clone(), ..package.clone() };
    differences_from(ours, &theirs, &[SettingSection::Roads, SettingSection::Layers])
}

fn differences_from(
    ours: &SettingsRecord,
    theirs: &SettingsRecord,
    sections: &[SettingSection],
) -> Vec<String> {
    let pairs = ours.facts().into_iter().zip(theirs.facts());
    pairs
        .filter(|(ours, theirs)| ours != theirs && sections.contains(&ours.section))
        .map(|(ours, theirs)| {
            format!("{} is {}, but it was built with {}", ours.name, ours.value, theirs.value)
        })
        .collect()
}

pub(crate) fn fact(name: &str, value: &impl SettingValue) -> Fact {
    (name.to_owned(), value.text())
}

pub(crate) fn setting_facts(record: &SettingsRecord) -> Vec<Fact> {
    record.facts().into_iter().map(|fact| (fact.name.to_owned(), fact.value)).collect()
}
