//! A way to save files, for tests in which nothing is saved.

use super::*;

/// For tests in which nothing is saved.
pub(crate) struct NoFiles;

impl SaveFiles for NoFiles {
    fn save(&mut self, stem: &'static str, _: &'static str, _: Encode) {
        panic!("{stem} is saved");
    }

    fn news(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        Vec::new()
    }

    fn finish(&mut self) -> Vec<Result<PathBuf, NotSaved>> {
        Vec::new()
    }
}
