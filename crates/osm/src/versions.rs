//! Distinguishes extracts from files that hold more than one point in time (histories, changes), where the header
//! does not say so.
//!
//! An extract holds each object once, and none that is deleted. So a file is refused that
//! - marks an object as deleted (`Info.visible`), or
//! - holds an object in two versions (`Info.version`): either one after the other, as histories and merged extracts are
//!   sorted, or, of ways, anywhere in the file if both are roads.
//!
//! Versions below 1 do not count: programs write them for unknown versions. An object without a version, or twice
//! with the same version, is no sign of a history. The ids of all objects are not kept, so in an unsorted file only
//! the versions of roads are compared.
//!
//! This reads the block in place: the decoder forgets versions and marks of dense nodes that come without times and users.

use serde::{Deserialize, Serialize};

use crate::{
    block::{Block, DenseNodes},
    object_info::{Info, to_version},
    wire::{self, Value, zigzag},
};

const KINDS: [&str; 3] = ["node", "way", "relation"];

/// What versions the objects of a block, or of the file so far, have.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Versions {
    /// Nodes, ways, relations.
    runs: [Run; 3],
    /// Why this is no extract: the first thing found.
    pub(crate) history: Option<History>,
}

/// Why a file is no extract, and of several files: which.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct History {
    pub(crate) file: u32,
    pub(crate) reason: String,
}

/// The objects of one kind, in the order of the file; those without a version are skipped.
#[derive(Debug, Default, Clone, Copy, Serialize, Deserialize)]
struct Run {
    first: Option<Versioned>,
    last: Option<Versioned>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Versioned {
    id: i64,
    version: i32,
    /// The number of the file, where there are several extracts.
    file: u32,
}

/// A version, if it is one.
pub(crate) fn known_version(version: i32) -> Option<i32> {
    (version > 0).then_some(version)
}

/// The words for a way in two versions, or another object.
pub(crate) fn two_versions(kind: &str, id: i64, [first, second]: [i32; 2]) -> String {
    format!("it holds {kind} {id} in versions {first} and {second}")
}

impl Versions {
    /// Looks through a block.
    pub(crate) fn scan(block: &Block<'_>) -> Self {
        let mut versions = Self::default();
        let mut dense = block.dense().iter();
        for group in block.groups() {
            for field in wire::fields(group).flatten() {
                match (field.number, field.value) {
                    (1, Value::Bytes(node)) => versions.object(0, node, zigzag),
                    (2, Value::Bytes(_)) => {
                        if let Some(nodes) = dense.next() {
                            versions.dense(nodes);
                        }
                    }
                    (3, Value::Bytes(way)) => versions.object(1, way, u64::cast_signed),
                    (4, Value::Bytes(relation)) => versions.object(2, relation, u64::cast_signed),
                    _ => {}
                }
            }
        }
        versions
    }

    /// Takes the next way of a block.
    pub(crate) fn take_way(&mut self, id: i64, info: Info) {
        self.take(1, id, info);
    }

    /// The same, found in this one of several extracts.
    pub(crate) fn of_file(mut self, file: u32) -> Self {
        let ends = self.runs.iter_mut().flat_map(|run| [&mut run.first, &mut run.last]);
        ends.flatten().for_each(|object| object.file = file);
        self.history.iter_mut().for_each(|history| history.file = file);
        self
    }

    /// Adds a later block.
    pub(crate) fn append(&mut self, later: Self) {
        for (kind, run) in later.runs.into_iter().enumerate() {
            if let Some(first) = run.first {
                self.follow(kind, first);
            }
            // What lies between its first and its last object was compared when it was looked through.
            self.runs[kind].last = run.last.or(self.runs[kind].last);
        }
        if self.history.is_none() {
            self.history = later.history;
        }
    }

    fn object(&mut self, kind: usize, message: &[u8], to_id: fn(u64) -> i64) {
        let (mut id, mut info) = (0, Info::default());
        for field in wire::fields(message).flatten() {
            match (field.number, field.value) {
                (1, Value::Varint(number)) => id = to_id(number),
                (4, Value::Bytes(message)) => info.read(message),
                _ => {}
            }
        }
        self.take(kind, id, info);
    }

    /// Versions and marks may be fewer than the ids, or not be there at all.
    fn dense(&mut self, nodes: &DenseNodes<'_>) {
        let DenseNodes { ids, versions, visible, .. } = nodes;
        if versions.is_empty() && visible.is_empty() {
            return;
        }
        if visible.is_empty() && ids.array_windows().all(|[one, next]| one < next) {
            // None is there twice: what lies between the first and the last one with a version tells nothing.
            let versions = ids.iter().zip(versions.numbers().map(to_version));
            let mut known = versions.filter(|&(_, version)| known_version(version).is_some());
            let of = |(&id, version)| Versioned { id, version, file: 0 };
            if let Some(first) = known.next().map(of) {
                self.follow(0, first);
                self.runs[0].last = known.last().map_or(Some(first), |last| Some(of(last)));
            }
            return;
        }
        let (mut versions, mut visible) = (versions.numbers(), visible.numbers());
        for &id in ids {
            let version = versions.next().map_or(0, to_version);
            self.take(0, id, Info { version, is_deleted: visible.next() == Some(0) });
        }
    }

    fn take(&mut self, kind: usize, id: i64, info: Info) {
        if info.is_deleted && self.history.is_none() {
            let reason = format!("it marks {} {id} as deleted", KINDS[kind]);
            self.history = Some(History { file: 0, reason });
        }
        if let Some(version) = known_version(info.version) {
            self.follow(kind, Versioned { id, version, file: 0 });
        }
    }

    fn follow(&mut self, kind: usize, object: Versioned) {
        let Run { first, last } = &mut self.runs[kind];
        first.get_or_insert(object);
        if let Some(last) = last.replace(object)
            && (last.id, last.file) == (object.id, object.file)
            && last.version != object.version
            && self.history.is_none()
        {
            let versions = [last.version, object.version];
            let reason = two_versions(KINDS[kind], object.id, versions);
            self.history = Some(History { file: object.file, reason });
        }
    }
}
