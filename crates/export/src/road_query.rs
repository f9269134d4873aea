//! Finds roads by the text on signs: their numbers and names.

use std::collections::{BTreeMap, BTreeSet};

use corniche_roads::RoadAttributes;
use corniche_tileset::{FilePackage, Sections};
use corniche_work::{Observer, Stage, workers::one_by_one};
use icu_normalizer::ComposingNormalizerBorrowed;
use strsim::levenshtein;

use crate::{error::RoadQueryError, read};

/// The number of similar numbers or names that are suggested.
const MOST_NEAR: usize = 5;
/// Texts are similar if they differ by at most this many letters, and by at most one in every
/// `LETTERS_OF_CHANGE`.
const ALIKE: usize = 2;
const LETTERS_OF_CHANGE: usize = 3;

/// A road as named by a person. Spaces, hyphens and case are ignored. If a way has several numbers
/// (`A 1;E 60`), one of them is enough.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RoadQuery {
    /// OSM's `ref`, the number on signs.
    pub reference: Option<String>,
    /// OSM's `name`.
    pub name: Option<String>,
}

/// The ways of a level.
pub(crate) struct NamedWays {
    /// The attributes of all ways: ways that do not match connect those that do.
    pub(crate) known: BTreeMap<i64, RoadAttributes>,
    /// The ways that match.
    pub(crate) meant: BTreeSet<i64>,
}

impl RoadQuery {
    fn is_met_by(&self, way: &RoadAttributes) -> bool {
        let meets = |wanted: &Option<String>, texts: &str| {
            wanted.as_ref().is_none_or(|wanted| {
                let [wanted, texts] = [wanted.as_str(), texts].map(folded_parts);
                let is_there = |part: &String| !part.is_empty() && texts.contains(part);
                wanted.iter().all(is_there)
            })
        };
        meets(&self.reference, &way.reference) && meets(&self.name, &way.name)
    }

    /// Returns the number or the name that matches, as written in the way's tags.
    #[must_use]
    pub fn written<'a>(&self, reference: &'a str, name: &'a str) -> Option<&'a str> {
        let part = |wanted: &Option<String>, texts: &'a str| {
            let wanted = folded_parts(wanted.as_ref()?);
            texts.split(';').map(str::trim).find(|text| wanted.contains(&folded(text)))
        };
        part(&self.reference, reference).or_else(|| part(&self.name, name))
    }

    /// The text of the query in messages, such as `ref "A 1"`.
    #[must_use]
    pub fn text(&self) -> String {
        let part = |key: &str, text: &Option<String>| {
            text.as_ref().map(|text| format!("{key} \"{text}\""))
        };
        let parts = [part("ref", &self.reference), part("name", &self.name)];
        parts.into_iter().flatten().collect::<Vec<_>>().join(" and ")
    }

    /// Returns values of the requested key, the most similar first.
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
            let changes = levenshtein(&wanted, &own);
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

/// Returns the texts of a list, each [`folded`].
fn folded_parts(list: &str) -> Vec<String> {
    list.split(';').map(folded).collect()
}

/// Returns a text without the differences that a query ignores: spaces, hyphens, case, ß for ss,
/// and whether accents are separate characters.
fn folded(text: &str) -> String {
    let matters = |letter: &char| {
        let is_hyphen =
            matches!(letter, '-' | '\u{ad}' | '\u{2010}'..='\u{2015}' | '\u{2212}' | '\u{feff}');
        !is_hyphen && !letter.is_whitespace()
    };
    let lower = text.chars().filter(matters).flat_map(char::to_lowercase).collect::<String>();
    ComposingNormalizerBorrowed::new_nfc().normalize(&lower.replace('ß', "ss")).into_owned()
}

/// Returns the ways of a level that match a query; `None` without a query.
pub(crate) fn meant_ways(
    package: &FilePackage,
    level: u8,
    query: Option<&RoadQuery>,
    observer: &dyn Observer,
) -> Result<Option<BTreeSet<i64>>, RoadQueryError> {
    let named = query.map(|_| named_ways(package, level, query, observer));
    Ok(named.transpose()?.map(|named| named.meant))
}

/// Returns the ways of a level, and those that match a query: none without a query.
///
/// # Errors
/// When a tile cannot be read, or no way matches.
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
