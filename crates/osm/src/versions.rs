//! Distinguishes extracts from files that contain more than one point in time (histories, changes),
//! even if the header does not say so.
//!
//! An extract contains each object once, and no deleted objects. So a file is rejected if it
//! - marks an object as deleted (`Info.visible`), or
//! - contains an object in two versions (`Info.version`): either one after the other, as sorted
//!   histories and merged extracts do, or, if both are roads, anywhere in the file.
//!
//! Versions below 1 do not count, because programs write them for unknown versions. An object
//! without a version, or twice with the same version, does not indicate a history. The ids of all
//! objects are not stored, so in an unsorted file only the versions of roads are compared.
//!
//! This module reads the block in place, because the decoder drops versions and marks of dense
//! nodes that come without times and users.

use serde::{Deserialize, Serialize};

use crate::{
    block::{AuditedBlock, DenseNodes},
    object_info::{Info, to_version},
    wire::{self, WireValue, zigzag},
};

const KINDS: [&str; 3] = ["node", "way", "relation"];

/// The versions of the objects in a block, or in the file so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Versions {
    /// The runs of nodes, ways and relations.
    runs: [Run; 3],
    /// The first reason found why this is not an extract.
    pub(crate) history: Option<History>,
}

/// The reason why a file is not an extract, and the number of the file if there are several.
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
    /// The number of the file, if there are several extracts.
    file: u32,
}

/// Returns the version, if it is known.
pub(crate) fn known_version(version: i32) -> Option<i32> {
    (version > 0).then_some(version)
}

/// Returns the message for an object in two versions.
pub(crate) fn two_versions(kind: &str, id: i64, [first, second]: [i32; 2]) -> String {
    format!("the file contains {kind} {id} in versions {first} and {second}")
}

impl Versions {
    /// Scans a block.
    pub(crate) fn scan(block: &AuditedBlock<'_>) -> Self {
        let mut versions = Self::default();
        let mut dense = block.dense().iter();
        for group in block.groups() {
            for field in wire::fields(group).flatten() {
                match (field.number, field.value) {
                    (1, WireValue::Bytes(node)) => versions.object(0, node, zigzag),
                    (2, WireValue::Bytes(_)) => {
                        if let Some(nodes) = dense.next() {
                            versions.dense(nodes);
                        }
                    }
                    (3, WireValue::Bytes(way)) => versions.object(1, way, u64::cast_signed),
                    (4, WireValue::Bytes(relation)) => {
                        versions.object(2, relation, u64::cast_signed);
                    }
                    _ => {}
                }
            }
        }
        versions
    }

    /// Adds the next way of a block.
    pub(crate) fn take_way(&mut self, id: i64, info: Info) {
        self.take(1, id, info);
    }

    /// Returns the same versions as the versions of one of several extracts.
    pub(crate) fn of_file(mut self, file: u32) -> Self {
        let ends = self.runs.iter_mut().flat_map(|run| [&mut run.first, &mut run.last]);
        ends.flatten().for_each(|object| object.file = file);
        self.history.iter_mut().for_each(|history| history.file = file);
        self
    }

    /// Adds the versions of a later block.
    pub(crate) fn append(&mut self, later: Self) {
        for (kind, run) in later.runs.into_iter().enumerate() {
            if let Some(first) = run.first {
                self.follow(kind, first);
            }
            // The scan has compared the objects between the first and the last one.
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
                (1, WireValue::Varint(number)) => id = to_id(number),
                (4, WireValue::Bytes(message)) => info.read(message),
                _ => {}
            }
        }
        self.take(kind, id, info);
    }

    /// Adds dense nodes. Versions and marks may be fewer than the ids, or missing.
    fn dense(&mut self, nodes: &DenseNodes<'_>) {
        let DenseNodes { ids, versions, visible, .. } = nodes;
        if versions.is_empty() && visible.is_empty() {
            return;
        }
        if visible.is_empty() && ids.array_windows().all(|[one, next]| one < next) {
            // No object occurs twice, so those between the first and the last one with a version do
            // not matter.
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
            let reason = format!("the file marks {} {id} as deleted", KINDS[kind]);
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
