//! The table of what is served.

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
    packed::{Packed, is_worth_it},
    policy::policy,
};

/// Where the bytes of a file come from.
#[derive(Debug, Clone)]
pub enum Content {
    /// They are known.
    Memory(Bytes),
    /// They are on disk, and may change or go.
    Disk(Arc<dyn OnDisk>),
}

/// Which pages may read a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readers {
    /// Pages of any server may read it: `Access-Control-Allow-Origin: *`.
    AnyPage,
    /// Pages of this server alone may read it.
    OwnPages,
}

/// What is served at one path.
#[derive(Debug, Clone)]
pub(crate) struct Route {
    pub(crate) content: Content,
    pub(crate) readers: Readers,
    /// The `ETag` of what is in memory.
    pub(crate) tag_in_memory: String,
    /// What is in memory, packed; `None` for what is sent as it is.
    pub(crate) packed: Option<Packed>,
    /// What a page may load and do; `None` for what is no page.
    pub(crate) policy: Option<String>,
    /// The version on disk that was hashed last.
    pub(crate) known: Arc<Mutex<Option<Known>>>,
}

/// What is served, by path. A path has no slash at its beginning: `examples/fly.html`.
#[derive(Debug, Clone, Default)]
pub struct Routes {
    by_path: BTreeMap<String, Route>,
}

impl Routes {
    /// Adds a file. One that was added at the same path before is replaced.
    pub fn add(&mut self, path: impl Into<String>, content: Content, readers: Readers) {
        let path = path.into();
        let (tag_in_memory, packed, policy) = match &content {
            Content::Memory(bytes) => {
                let media_type = media_type(&path);
                let is_page = media_type.starts_with("text/html");
                let packed = is_worth_it(media_type, bytes.len()).then(Packed::default);
                (tag_of(bytes), packed, is_page.then(|| policy(bytes)))
            }
            Content::Disk(_) => (String::new(), None, None),
        };
        let known = Arc::default();
        self.by_path.insert(path, Route { content, readers, tag_in_memory, packed, policy, known });
    }

    /// What is served at the path of an address, with the path as it is in the table. A folder's own path means its `index.html`.
    pub(crate) fn find(&self, path_of_address: &str) -> Option<(&str, &Route)> {
        let path = percent_decode_str(path_of_address.strip_prefix('/')?).decode_utf8().ok()?;
        let named = if path.is_empty() || path.ends_with('/') {
            self.by_path.get_key_value(&format!("{path}index.html"))
        } else {
            self.by_path.get_key_value(path.as_ref())
        };
        named.map(|(path, route)| (path.as_str(), route))
    }
}

/// Half of a hash of the bytes, in quotes.
fn tag_of(bytes: &[u8]) -> String {
    format!("\"{}\"", half_in_hex(Sha256::new_with_prefix(bytes)))
}

#[cfg(test)]
#[path = "routes_tests.rs"]
mod tests;
