//! What the writers of all model formats have in common.

use std::io::{self, Write};

use super::model::TileMesh;

/// What a model says of itself.
pub(crate) struct About<'a> {
    /// Names and texts.
    pub(crate) facts: Vec<(&'a str, String)>,
}

impl About<'_> {
    pub(crate) fn fact(&self, name: &str) -> &str {
        let found = self.facts.iter().find(|(own, _)| *own == name);
        found.map_or("", |(_, text)| text.as_str())
    }
}

/// Makes a file of tiles.
pub(crate) trait MeshWriter {
    fn tile(&mut self, tile: &TileMesh) -> io::Result<()>;
    fn finish(self: Box<Self>, into: &mut dyn Write, about: &About<'_>) -> io::Result<()>;
}
