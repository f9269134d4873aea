//! What is compared of two plans, as pairs of a name that users know and a value in words.

use corniche_settings::{SettingSection, SettingValue, SettingsRecord};
use corniche_tileset::ReliefLevels;

/// A setting's name, and its value in words.
pub(crate) type Fact = (String, String);

/// The sentence about one value.
pub(crate) fn different(name: &str, ours: &str, theirs: &str) -> String {
    format!("{name} is {ours}, the store was made with {theirs}")
}

pub(crate) fn different_facts(ours: &[Fact], theirs: &[Fact]) -> Vec<String> {
    let mut said: Vec<String> = ours
        .iter()
        .zip(theirs)
        .filter(|(ours, theirs)| ours != theirs)
        .map(|((name, ours), (_, theirs))| different(name, ours, theirs))
        .collect();
    if ours.len() != theirs.len() {
        said.push(format!("{} values are compared with {}", ours.len(), theirs.len()));
    }
    said
}

/// How the settings for the ground differ from those that a package records, in words; those for
/// roads do not count, and photos are taken with the terrain.
pub(crate) fn terrain_differences(ours: &SettingsRecord, package: &SettingsRecord) -> Vec<String> {
    let mut theirs = package.clone();
    // A polygon is the same under another name.
    if let (Some(own), Some(recorded)) = (&ours.polygon, &mut theirs.polygon)
        && own.sha256 == recorded.sha256
    {
        recorded.name.clone_from(&own.name);
    }
    // Relief that a package has may be left out.
    if ours.relief == ReliefLevels::Off {
        theirs.relief = ReliefLevels::Off;
    }
    differences_from(ours, &theirs, &[SettingSection::Terrain])
}

/// How the settings for roads and areas differ from those that a package records, in words; those for the ground do not count.
#[must_use]
pub fn network_differences(ours: &SettingsRecord, package: &SettingsRecord) -> Vec<String> {
    // The names of classes change no road.
    let theirs = SettingsRecord { class_labels: ours.class_labels.clone(), ..package.clone() };
    differences_from(ours, &theirs, &[SettingSection::Roads, SettingSection::Areas])
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
            format!("{} is {}, it was made with {}", ours.name, ours.value, theirs.value)
        })
        .collect()
}

pub(crate) fn fact(name: &str, value: &impl SettingValue) -> Fact {
    (name.to_owned(), value.text())
}

pub(crate) fn setting_facts(record: &SettingsRecord) -> Vec<Fact> {
    record.facts().into_iter().map(|fact| (fact.name.to_owned(), fact.value)).collect()
}
