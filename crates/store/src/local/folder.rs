//! The sealed parts of a store in a folder.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::{
    Disk, OpenMode, PartFile, PartsPlace, StoreError, StoredPlan,
    files::Files,
    local::{binding, binding::FolderState, layout},
};

/// The sealed parts of a store in a folder.
#[derive(Debug)]
pub struct Folder {
    files: Arc<Files>,
    path: PathBuf,
}

impl Folder {
    /// Creates the place for the folder at `path`, which need not exist.
    #[must_use]
    pub fn new(disk: Arc<dyn Disk>, path: &Path) -> Self {
        Self::at_path(&Files::new(disk), path)
    }

    /// Creates the place with the bytes counted in `files`.
    pub(crate) fn at_path(files: &Arc<Files>, path: &Path) -> Self {
        Self { files: Arc::clone(files), path: path.to_owned() }
    }
}

impl PartsPlace for Folder {
    fn name(&self) -> &Path {
        &self.path
    }

    fn stored_plan(&self) -> Result<Option<StoredPlan>, StoreError> {
        match binding::state(&self.files, &self.path)? {
            FolderState::Store => binding::read_plan(&self.files, &self.path).map(Some),
            FolderState::Absent | FolderState::Free => Ok(None),
        }
    }

    fn parts(&self) -> Result<Vec<String>, StoreError> {
        let listed = self.files.list(&self.path.join(layout::PARTS))?.unwrap_or_default();
        let names = listed.into_iter().filter(|entry| !entry.is_folder);
        let names = names.filter_map(|entry| entry.name.into_string().ok());
        Ok(names.filter(|name| layout::part_of_sealed(name).is_some()).collect())
    }

    fn open(&self, file_name: &str) -> Result<Box<dyn PartFile>, StoreError> {
        let path = self.path.join(layout::PARTS).join(file_name);
        Ok(Box::new(self.files.open(&path, OpenMode::Read)?))
    }
}
