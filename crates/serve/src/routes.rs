//! The table of served files.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex},
};

use bytes::Bytes;
use percent_encoding::percent_decode_str;
use sha2::{Digest as _, Sha256};

use crate::{
    media_type::media_type,
    on_disk::{Known, OnDisk, half_in_hex},
    packed::{CompressedFile, is_worth_it},
    policy::policy,
};

/// The source of a file's bytes.
#[derive(Debug, Clone)]
pub enum FileContent {
    /// Bytes in memory.
    Memory(Bytes),
    /// A file on disk, which may change or disappear.
    Disk(Arc<dyn OnDisk>),
}

/// The pages that may read a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readers {
    /// Pages of any server: `Access-Control-Allow-Origin: *`.
    AnyPage,
    /// Only pages of this server.
    OwnPages,
}

/// The file that is served at one path.
#[derive(Debug, Clone)]
pub(crate) struct ServedRoute {
    pub(crate) content: FileContent,
    pub(crate) readers: Readers,
    /// The `ETag` of a file in memory.
    pub(crate) tag_in_memory: String,
    /// The compressed form of a file in memory; `None` for files that are sent uncompressed.
    pub(crate) packed: Option<CompressedFile>,
    /// The content security policy; `None` for files that are not pages.
    pub(crate) policy: Option<String>,
    /// The version on disk that was hashed last.
    pub(crate) known: Arc<Mutex<Option<Known>>>,
}

/// The served files, by path. A path has no slash at its beginning: `examples/fly.html`.
#[derive(Debug, Clone, Default)]
pub struct Routes {
    by_path: BTreeMap<String, ServedRoute>,
}

impl Routes {
    /// Adds a file. It replaces one at the same path.
    pub fn add(&mut self, path: impl Into<String>, content: FileContent, readers: Readers) {
        let path = path.into();
        let (tag_in_memory, packed, policy) = match &content {
            FileContent::Memory(bytes) => {
                let media_type = media_type(&path);
                let is_page = media_type.starts_with("text/html");
                let packed = is_worth_it(media_type, bytes.len()).then(CompressedFile::default);
                (tag_of(bytes), packed, is_page.then(|| policy(bytes)))
            }
            FileContent::Disk(_) => (String::new(), None, None),
        };
        let known = Arc::default();
        self.by_path
            .insert(path, ServedRoute { content, readers, tag_in_memory, packed, policy, known });
    }

    /// The file at a URL path, with its path in the table. The path of a folder means its
    /// `index.html`.
    pub(crate) fn find(&self, path_of_address: &str) -> Option<(&str, &ServedRoute)> {
        let path = percent_decode_str(path_of_address.strip_prefix('/')?).decode_utf8().ok()?;
        let named = if path.is_empty() || path.ends_with('/') {
            self.by_path.get_key_value(&format!("{path}index.html"))
        } else {
            self.by_path.get_key_value(path.as_ref())
        };
        named.map(|(path, route)| (path.as_str(), route))
    }
}

/// The tag: half of a hash of the bytes, in quotes.
fn tag_of(bytes: &[u8]) -> String {
    format!("\"{}\"", half_in_hex(Sha256::new_with_prefix(bytes)))
}

#[cfg(test)]
#[path = "routes_tests.rs"]
mod tests;
