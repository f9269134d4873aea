//! A store of sealed parts in object storage.
//!
//! ```text
//! PREFIX/plan.json                what the prefix is bound to, as the caller wrote it
//!        store                    its header, as the file of a store in a folder
//!        parts/NAME.DIGEST.part   a sealed part
//! ```
//!
//! Each object is written once, on the condition that none exists. The first writer of `plan.json`
//! has bound the prefix; the header is written after it and marks the binding as complete.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, OnceLock},
};

use corniche_blocks::{BlockCache, CacheLimits};
use corniche_store::{
    Existing, PARTS_NAME, PLAN_NAME, PartFile, PartsPlace, Publish, STORE_NAME, StoreError,
    StoredPlan, check_sealed, part_of_sealed, plan_of_header, store_header,
};
use corniche_work::locked;

use crate::{Bucket, ObjectAddress, ObjectError, ObjectInfo, Storage, Upload};

/// The largest block: with larger ones, answers take longer and more of their bytes are never used.
const LARGEST_BLOCK_BYTES: u64 = 4 << 20;
/// The smallest block: each request costs as much as some hundred kilobytes.
const SMALLEST_BLOCK_BYTES: u64 = 256 << 10;
/// The cache holds this many blocks, unless they would be smaller than the smallest one.
const BLOCKS: u64 = 16;

/// Creates a cache for parts in object storage that takes at most `kept_bytes`, in blocks of 256
/// KiB to 4 MiB.
#[must_use]
pub fn block_cache(kept_bytes: u64) -> BlockCache {
    let block_bytes = (kept_bytes / BLOCKS).clamp(SMALLEST_BLOCK_BYTES, LARGEST_BLOCK_BYTES);
    BlockCache::new(CacheLimits { block_bytes, kept_bytes, most_blocks: 1 })
}

/// The store under a prefix.
#[derive(Debug)]
pub struct ObjectPlace {
    bucket: Bucket,
    address: ObjectAddress,
    /// The address, in place of the path of other stores.
    name: PathBuf,
    blocks: Arc<BlockCache>,
    /// The plan that the store is bound to, which never changes.
    plan: OnceLock<StoredPlan>,
    /// The last listing, by file name. It has length and `ETag`, so that no further requests are
    /// needed for them.
    listed: Mutex<BTreeMap<String, ObjectInfo>>,
}

impl ObjectPlace {
    /// Creates the store at an address, without any request to the server.
    ///
    /// # Errors
    /// [`ObjectError::Settings`].
    pub fn new(
        storage: &Storage,
        address: &ObjectAddress,
        blocks: &Arc<BlockCache>,
    ) -> Result<Self, ObjectError> {
        Ok(Self {
            bucket: storage.bucket(&address.bucket)?,
            address: address.clone(),
            name: address.to_string().into(),
            blocks: Arc::clone(blocks),
            plan: OnceLock::new(),
            listed: Mutex::default(),
        })
    }

    fn parts_key(&self) -> String {
        self.address.beneath(PARTS_NAME)
    }

    fn header_path(&self) -> PathBuf {
        self.bucket.address(&self.address.beneath(STORE_NAME)).to_string().into()
    }

    /// Fails if the prefix contains objects that no store writes.
    fn refuse_others(&self) -> Result<(), StoreError> {
        let own = [PLAN_NAME, STORE_NAME].map(|name| self.address.beneath(name));
        let (found, folders) = self.bucket.list(&self.address.key)?;
        let parts = self.parts_key();
        // Programs that show folders create an object for the prefix itself.
        let is_other = |key: &String| !own.contains(key) && *key != self.address.key;
        let others = found.into_iter().map(|found| found.key).filter(is_other);
        let folders = folders.into_iter().filter(|folder| *folder != parts);
        match others.chain(folders).next() {
            Some(other) => Err(StoreError::NotAStore {
                path: self.name.clone(),
                what: format!("it contains {}", self.bucket.address(&other)),
            }),
            None => Ok(()),
        }
    }

    fn find_part(&self, file_name: &str) -> Result<Option<ObjectInfo>, ObjectError> {
        self.bucket.find(&format!("{}/{file_name}", self.parts_key()))
    }
}

impl PartsPlace for ObjectPlace {
    fn name(&self) -> &Path {
        &self.name
    }

    fn stored_plan(&self) -> Result<Option<StoredPlan>, StoreError> {
        if let Some(plan) = self.plan.get() {
            return Ok(Some(plan.clone()));
        }
        let Some(header) = self.bucket.get(&self.address.beneath(STORE_NAME))? else {
            return Ok(None);
        };
        let path = self.header_path();
        let Some(bytes) = self.bucket.get(&self.address.beneath(PLAN_NAME))? else {
            let what =
                format!("{PLAN_NAME} is missing next to it; remove all objects with this prefix");
            return Err(StoreError::Damaged { path, what });
        };
        let plan = plan_of_header(&header, bytes, &path)?;
        Ok(Some(self.plan.get_or_init(|| plan).clone()))
    }

    fn parts(&self) -> Result<Vec<String>, StoreError> {
        let (found, _) = self.bucket.list(&self.parts_key())?;
        let named = found.into_iter().filter_map(|found| {
            let name = found.key.rsplit('/').next()?.to_owned();
            part_of_sealed(&name).is_some().then_some((name, found))
        });
        let listed: BTreeMap<String, ObjectInfo> = named.collect();
        let names = listed.keys().cloned().collect();
        *locked(&self.listed) = listed;
        Ok(names)
    }

    fn open(&self, file_name: &str) -> Result<Box<dyn PartFile>, StoreError> {
        let listed = locked(&self.listed).get(file_name).cloned();
        let found = match listed {
            Some(found) => found,
            None => self
                .find_part(file_name)?
                .ok_or_else(|| self.bucket.missing(&format!("{}/{file_name}", self.parts_key())))?,
        };
        Ok(Box::new(ObjectPart::new(self.bucket.clone(), found, Arc::clone(&self.blocks))))
    }
}

impl Publish for ObjectPlace {
    fn bind(&self, plan: &StoredPlan) -> Result<StoredPlan, StoreError> {
        if let Some(bound) = self.stored_plan()? {
            return Ok(bound);
        }
        self.refuse_others()?;
        let key = self.address.beneath(PLAN_NAME);
        if self.bucket.create(&key, plan.bytes.clone())? {
            // A server that ignores the condition would let writers overwrite each other's parts.
            if self.bucket.create(&key, plan.bytes.clone())? {
                let name = self.bucket.address(&key).to_string();
                return Err(ObjectError::NoConditions { name }.into());
            }
        } else {
            // Another process was first, now or earlier, and was perhaps killed before it wrote the
            // header.
            let bytes = self.bucket.get(&key)?.ok_or_else(|| self.bucket.missing(&key))?;
            if bytes != plan.bytes {
                return Ok(StoredPlan { hash: [0; 32], bytes });
            }
        }
        let header = self.address.beneath(STORE_NAME);
        self.bucket.create(&header, store_header(plan))?;
        self.stored_plan()?.ok_or_else(|| self.bucket.missing(&header).into())
    }

    fn publish(
        &self,
        sealed: &Path,
        should_stop: &dyn Fn() -> bool,
    ) -> Result<PathBuf, StoreError> {
        let name = sealed.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let key = format!("{}/{name}", self.parts_key());
        let address = PathBuf::from(self.bucket.address(&key).to_string());
        let upload = Upload { file: sealed, key: &key, existing: Existing::Keep, should_stop };
        if self.find_part(name)?.is_some() {
            // Another process uploaded the part, perhaps after this machine had started to.
            self.bucket.end_earlier(sealed)?;
        } else {
            match self.bucket.upload(&upload) {
                Ok(_) => return Ok(address),
                Err(ObjectError::Exists { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        // The name of a part determines its content. Threads may write the content in another
        // order, so only its list can be compared.
        let plan =
            self.stored_plan()?.ok_or_else(|| StoreError::NoStore { path: self.name.clone() })?;
        check_sealed(&*self.open(name)?, &plan.hash)?;
        Ok(address)
    }
}

/// A sealed part in object storage.
#[derive(Debug)]
pub(crate) struct ObjectPart {
    bucket: Bucket,
    found: ObjectInfo,
    /// The address of the part, in place of a path.
    path: PathBuf,
    blocks: Arc<BlockCache>,
    number: u64,
}

impl ObjectPart {
    pub(crate) fn new(bucket: Bucket, found: ObjectInfo, blocks: Arc<BlockCache>) -> Self {
        let path = bucket.address(&found.key).to_string().into();
        let number = blocks.new_file();
        Self { bucket, found, path, blocks, number }
    }

    /// Fails if bytes beyond the end of the part are requested: another process replaced it, or its
    /// list is wrong.
    fn check_inside(&self, length: usize, offset: u64) -> Result<(), StoreError> {
        if offset.checked_add(length as u64).is_some_and(|end| end <= self.found.length) {
            return Ok(());
        }
        let what = format!("bytes beyond its end ({}) were requested", self.found.length);
        Err(StoreError::Damaged { path: self.path.clone(), what })
    }
}

impl PartFile for ObjectPart {
    fn path(&self) -> &Path {
        &self.path
    }

    fn length(&self) -> Result<u64, StoreError> {
        Ok(self.found.length)
    }

    fn read_exact_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        self.check_inside(bytes.len(), offset)?;
        let ObjectInfo { key, length, etag } = &self.found;
        let fetch = |range| self.bucket.read(key, etag.as_deref(), range);
        Ok(self.blocks.read((self.number, *length), bytes, offset, fetch)?)
    }

    fn read_alone_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        self.check_inside(bytes.len(), offset)?;
        let ObjectInfo { key, etag, .. } = &self.found;
        let range = offset..offset + bytes.len() as u64;
        bytes.copy_from_slice(&self.bucket.read(key, etag.as_deref(), range)?);
        Ok(())
    }
}
