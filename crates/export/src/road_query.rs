//! Roads by what is written on signs: their numbers and names.

use std::collections::{BTreeMap, BTreeSet};

use corniche_roads::RoadAttributes;
use corniche_tileset::{FilePackage, Sections};
use corniche_work::{Observer, Stage, workers::one_by_one};
use icu_normalizer::ComposingNormalizerBorrowed;

use crate::{error::RoadQueryError, read};

/// So many numbers or names that are like the one that was asked for are told.
const MOST_NEAR: usize = 5;
/// Texts are alike if no more letters than these have to be changed, and one of so many at most.
const ALIKE: usize = 2;
const LETTERS_OF_CHANGE: usize = 3;

/// A road as a person names it. Spaces, hyphens and case do not matter; where a way has several numbers (`A 1;E 60`), one of them is enough.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RoadQuery {
    /// OSM's `ref`, the number on signs.
    pub reference: Option<String>,
    /// OSM's `name`.
    pub name: Option<String>,
}

/// The ways of a level.
pub(crate) struct NamedWays {
    /// What is known of all ways: those that are not meant join those that are.
    pub(crate) known: BTreeMap<i64, RoadAttributes>,
    /// The ways that are meant.
    pub(crate) meant: BTreeSet<i64>,
}

impl RoadQuery {
    fn is_met_by(&self, way: &RoadAttributes) -> bool {
        let meets = |wanted: &Option<String>, texts: &str| {
            wanted.as_ref().is_none_or(|wanted| {
                let texts: Vec<String> = texts.split(';').map(folded).collect();
                let wanted: Vec<String> = wanted.split(';').map(folded).collect();
                let is_there = |part: &String| !part.is_empty() && texts.contains(part);
                wanted.iter().all(is_there)
            })
        };
        meets(&self.reference, &way.reference) && meets(&self.name, &way.name)
    }

    /// The number or the name that is meant, as a way has it.
    #[must_use]
    pub fn written<'a>(&self, reference: &'a str, name: &'a str) -> Option<&'a str> {
        let part = |wanted: &Option<String>, texts: &'a str| {
            let wanted: Vec<String> = wanted.as_ref()?.split(';').map(folded).collect();
            texts.split(';').map(str::trim).find(|text| wanted.contains(&folded(text)))
        };
        part(&self.reference, reference).or_else(|| part(&self.name, name))
    }

    /// The query as it is told, such as `ref "A 1"`.
    #[must_use]
    pub fn text(&self) -> String {
        let part = |key: &str, text: &Option<String>| {
            text.as_ref().map(|text| format!("{key} \"{text}\""))
        };
        let parts = [part("ref", &self.reference), part("name", &self.name)];
        parts.into_iter().flatten().collect::<Vec<_>>().join(" and ")
    }

    /// Values of the key that was asked for, the most alike first.
    fn near<'a>(&self, ways: impl Iterator<Item = &'a RoadAttributes>) -> Vec<String> {
        let (wanted, of): (&str, fn(&RoadAttributes) -> &str) = match (&self.reference, &self.name)
        {
            (Some(reference), _) => (reference, |way| &way.reference),
            (None, Some(name)) => (name, |way| &way.name),
            (None, None) => return Vec::new(),
        };
        let wanted = folded(wanted);
        let texts: BTreeSet<&str> =
            ways.flat_map(|way| of(way).split(';')).map(str::trim).collect();
        let rank = |text: &&str| {
            let own = folded(text);
            let changes = changes(&wanted, &own);
            let is_part = !wanted.is_empty() && (own.contains(&wanted) || wanted.contains(&own));
            let alike = ALIKE.min(wanted.chars().count() / LETTERS_OF_CHANGE);
            (!own.is_empty() && (changes <= alike || is_part)).then_some(changes)
        };
        let mut near: Vec<(usize, &str)> =
            texts.iter().filter_map(|text| Some((rank(text)?, *text))).collect();
        near.sort_unstable();
        near.into_iter().take(MOST_NEAR).map(|(_, text)| text.to_owned()).collect()
    }
}

/// A text without what does not matter: spaces, hyphens, case, ß for ss, and whether accents are letters of their own.
fn folded(text: &str) -> String {
    let matters = |letter: &char| {
        let is_hyphen =
            matches!(letter, '-' | '\u{ad}' | '\u{2010}'..='\u{2015}' | '\u{2212}' | '\u{feff}');
        !is_hyphen && !letter.is_whitespace()
    };
    let lower = text.chars().filter(matters).flat_map(char::to_lowercase).collect::<String>();
    ComposingNormalizerBorrowed::new_nfc().normalize(&lower.replace('ß', "ss")).into_owned()
}

/// How many letters have to be put in, left out or replaced to make one text of another. Source: Wagner & Fischer 1974, *The String-to-String Correction
/// Problem*.
fn changes(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (done, letter) in (1..).zip(one.chars()) {
        let mut before = std::mem::replace(&mut row[0], done);
        for (k, own) in other.iter().enumerate() {
            let replaced = before + usize::from(*own != letter);
            before = row[k + 1];
            row[k + 1] = replaced.min(before + 1).min(row[k] + 1);
        }
    }
    row.last().copied().unwrap_or_default()
}

/// The ways of a level, and which of them a query means: none without one.
///
/// # Errors
/// When a tile cannot be read, or no way is meant.
pub(crate) fn named_ways(
    package: &FilePackage,
    level: u8,
    query: Option<&RoadQuery>,
    observer: &dyn Observer,
) -> Result<NamedWays, RoadQueryError> {
    let mut known = BTreeMap::new();
    let tiles = read::tiles(package, level, None)?;
    one_by_one((observer, Stage::ExportTiles), &tiles, |&id| {
        let payload = package.payload(id, Sections::ATTRIBUTES)?;
        for record in payload.into_iter().flat_map(|payload| payload.attributes) {
            known.entry(record.way_id).or_insert(record.attributes);
        }
        Ok::<(), RoadQueryError>(())
    })?;
    let Some(query) = query else { return Ok(NamedWays { known, meant: BTreeSet::new() }) };
    let meant = known.iter().filter(|(_, way)| query.is_met_by(way));
    let meant: BTreeSet<i64> = meant.map(|(&way_id, _)| way_id).collect();
    if meant.is_empty() {
        let near = query.near(known.values());
        let quoted: Vec<String> = near.iter().map(|text| format!("\"{text}\"")).collect();
        let near = if near.is_empty() {
            String::new()
        } else {
            format!("; similar ones are {}", quoted.join(", "))
        };
        let package = package.path().to_path_buf();
        return Err(RoadQueryError::NoSuchRoad { package, query: query.text(), near });
    }
    Ok(NamedWays { known, meant })
}

#[cfg(test)]
#[path = "road_query_tests.rs"]
mod tests;
