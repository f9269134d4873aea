//! A part that is complete: nothing is added to it any more, and its name depends on its content.
//!
//! ```text
//!  ┌────────┬───────────┬─ ─ ─┬───────────┬─────────────────────────┬────────┐
//!  │ header │ artifact  │     │ artifact  │ entries, sorted by key  │ footer │
//!  └────────┴───────────┴─ ─ ─┴───────────┴─────────────────────────┴────────┘
//!  footer:  0         8       16    20    24      32     integers are little-endian
//!           ┌─────────┬───────┬─────┬─────┬───────┐
//!           │ entries │ count │ CRC │zeros│ magic │     entries: where they begin; CRC: of the 16 bytes before it
//!           └─────────┴───────┴─────┴─────┴───────┘
//! ```
//!
//! Its file is `parts/NAME.DIGEST.part`. The digest is the first 16 bytes of the SHA-256 over kind,
//! item, length and CRC-32 of each artifact, by key: the order in which threads finished does not
//! matter, and two copies of the same part get the same name.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use sha2::{Digest as _, Sha256};

use crate::{
    ArtifactKey, PartFile, PlanHash, StoreError,
    files::OpenFile,
    local::{
        entry::{ArtifactEntry, ENTRY_BYTES, Visit},
        header::{self, FileKind, HEADER_BYTES, u32_at, u64_at},
        layout,
    },
};

const FOOTER_BYTES: usize = 32;
const FOOTER_MAGIC: &[u8; 8] = b"CORNSEAL";
/// Number of entries that are written at once.
const ENTRIES_AT_ONCE: usize = 2048;
/// Number of bytes of a list that are read at once.
const LIST_BYTES_AT_ONCE: u64 = 32_768 * ENTRY_BYTES as u64;
/// Number of bytes before the footer that are read together with it.
const TAIL_BYTES: u64 = 2048 * ENTRY_BYTES as u64;

/// Completes a data file whose artifacts end at `end`, makes it durable, and gives it its name in
/// the folder of parts. `entries` are sorted by key. If the same part already exists, the file is
/// deleted.
pub(crate) fn seal(
    data: &OpenFile,
    folder: &Path,
    part: &str,
    entries: impl Iterator<Item = ArtifactEntry>,
    end: u64,
) -> Result<PathBuf, StoreError> {
    let mut digest = Digest::default();
    let (mut count, mut offset) = (0, end);
    let mut bytes = Vec::with_capacity(ENTRIES_AT_ONCE * ENTRY_BYTES);
    for entry in entries {
        digest.add(&entry);
        bytes.extend(entry.encode(count));
        count += 1;
        if bytes.len() == ENTRIES_AT_ONCE * ENTRY_BYTES {
            data.write_all_at(&bytes, offset)?;
            offset += bytes.len() as u64;
            bytes.clear();
        }
    }
    bytes.extend(footer(end, count));
    data.write_all_at(&bytes, offset)?;
    data.set_length(offset + bytes.len() as u64)?;
    data.sync()?;

    let files = data.files();
    let parts = folder.join(layout::PARTS);
    files.create_folder(&parts)?;
    files.sync_folder(folder)?;
    let path = layout::sealed(folder, part, &digest.finish());
    if !data.is_in_place()? {
        return Err(StoreError::Gone { path: data.path().to_owned() });
    }
    if files.exists(&path)? {
        files.remove(data.path())?;
    } else {
        files.rename(data.path(), &path)?;
    }
    files.sync_folder(&parts)?;
    files.sync_folder(folder)?;
    Ok(path)
}

/// Fails unless a file is a complete sealed part of this plan, and the part that its name says. The
/// artifacts are not read: each of them is checked when it is read.
///
/// # Errors
/// [`StoreError::Damaged`], [`StoreError::OtherPlan`] and [`StoreError::OtherVersion`]; when the
/// file cannot be read.
pub fn check_sealed(file: &dyn PartFile, plan: &PlanHash) -> Result<(), StoreError> {
    read_list(file, plan, &mut |_, _| Ok(()))
}

/// Passes on the entries of a sealed part, by key. Damage of the part is reported at the end of the
/// list at the latest.
pub(crate) fn read_list(
    file: &dyn PartFile,
    plan: &PlanHash,
    visit: &mut Visit<'_>,
) -> Result<(), StoreError> {
    let path = file.path();
    let damaged = |what| FileKind::Sealed.damaged(path, what);
    let length = file.length()?;
    let mut bytes = vec![0; length.min(HEADER_BYTES) as usize];
    file.read_alone_at(&mut bytes, 0)?;
    header::check(FileKind::Sealed, &bytes, path, plan)?;

    let ended = length.checked_sub(FOOTER_BYTES as u64).filter(|&ended| ended >= HEADER_BYTES);
    let ended = ended.ok_or_else(|| damaged("it is too short"))?;
    // The end of the list is read together with the footer: for most parts this is the whole list,
    // and in places other than a disk each request takes long.
    let tail_from = ended - (ended - HEADER_BYTES).min(TAIL_BYTES);
    let mut tail = vec![0; (length - tail_from) as usize];
    file.read_alone_at(&mut tail, tail_from)?;
    let footer = tail.split_off((ended - tail_from) as usize);
    let (from, count) = decode_footer(&footer)
        .ok_or_else(|| damaged("it does not end with the footer of a sealed part"))?;
    let entry_bytes = count.checked_mul(ENTRY_BYTES as u64);
    if entry_bytes.and_then(|bytes| from.checked_add(bytes)) != Some(ended) {
        return Err(damaged(
            "its list of artifacts does not have the length that its footer gives",
        ));
    }

    let mut digest = Digest::default();
    let mut last: Option<ArtifactKey> = None;
    let mut bytes = Vec::new();
    let mut number = 0;
    while number < count {
        let offset = from + number * ENTRY_BYTES as u64;
        let end = ended.min(offset + LIST_BYTES_AT_ONCE);
        if let Some(at) = offset.checked_sub(tail_from) {
            tail[at as usize..].clone_into(&mut bytes);
        } else {
            bytes.resize((end - offset) as usize, 0);
            file.read_alone_at(&mut bytes, offset)?;
        }
        for entry in bytes.chunks(ENTRY_BYTES) {
            let entry = ArtifactEntry::decode(number, entry, from)
                .filter(|entry| last.is_none_or(|last| last < entry.key))
                .ok_or_else(|| damaged("its list of artifacts is invalid"))?;
            digest.add(&entry);
            visit(path, entry)?;
            last = Some(entry.key);
            number += 1;
        }
    }
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if layout::digest_of_sealed(&name) != Some(&digest.finish()) {
        return Err(damaged("its content does not match its name"));
    }
    Ok(())
}

fn footer(from: u64, count: u64) -> [u8; FOOTER_BYTES] {
    let mut bytes = [0; FOOTER_BYTES];
    bytes[..8].copy_from_slice(&from.to_le_bytes());
    bytes[8..16].copy_from_slice(&count.to_le_bytes());
    let crc = crc32fast::hash(&bytes[..16]);
    bytes[16..20].copy_from_slice(&crc.to_le_bytes());
    bytes[24..].copy_from_slice(FOOTER_MAGIC);
    bytes
}

fn decode_footer(bytes: &[u8]) -> Option<(u64, u64)> {
    let whole = bytes.len() == FOOTER_BYTES
        && &bytes[24..] == FOOTER_MAGIC
        && u32_at(bytes, 16) == crc32fast::hash(&bytes[..16]);
    whole.then(|| (u64_at(bytes, 0), u64_at(bytes, 8)))
}

/// The digest of the content of a part.
#[derive(Default)]
struct Digest(Sha256);

impl Digest {
    fn add(&mut self, entry: &ArtifactEntry) {
        self.0.update([entry.key.kind]);
        self.0.update(entry.key.item.to_le_bytes());
        self.0.update(entry.length.to_le_bytes());
        self.0.update(entry.crc.to_le_bytes());
    }

    fn finish(self) -> String {
        self.0.finalize().iter().take(16).fold(String::new(), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        })
    }
}
