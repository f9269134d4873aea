//! Which file uses which: every path is followed to the file that defines the name.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use crate::source::Crate;

/// A use in one file of a name that another file defines.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Use {
    /// Index of the module that uses it.
    pub user: usize,
    /// Index of the module that defines it.
    pub owner: usize,
    /// The name that is used.
    pub name: String,
}

impl Use {
    /// The files of both modules, relative to the crate's `src`.
    #[must_use]
    pub fn files<'a>(&self, of: &'a Crate) -> [&'a Path; 2] {
        [&of.modules[self.user].file, &of.modules[self.owner].file]
    }
}

/// All uses between different files of `of`, sorted. A re-export is not a use by the module that
/// contains it; a module that names the re-export uses the file behind it.
#[must_use]
pub fn uses(of: &Crate) -> Vec<Use> {
    let mut found = BTreeSet::new();
    for (user, module) in of.modules.iter().enumerate() {
        let imports = module.imports.iter().filter(|import| !import.is_public);
        for path in imports.map(|import| &import.path).chain(&module.paths) {
            let Some((owner, name)) = (Resolver { of, depth: 0 }).find(user, path) else {
                continue;
            };
            let found_use = Use { user, owner, name };
            let [from, to] = found_use.files(of);
            if from != to {
                found.insert(found_use);
            }
        }
    }
    found.into_iter().collect()
}

/// Follows paths. `depth` limits the search through imports that name each other.
struct Resolver<'a> {
    of: &'a Crate,
    depth: u32,
}

const MAX_DEPTH: u32 = 16;

impl Resolver<'_> {
    /// Returns the module that defines the name which `path` denotes in `module`, and the name
    /// there. `None` for a name from another crate, or for a module itself.
    fn find(&self, module: usize, path: &[String]) -> Option<(usize, String)> {
        if self.depth > MAX_DEPTH {
            return None;
        }
        let modules = &self.of.modules;
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => self.below(0, rest),
            "self" => self.below(module, rest),
            "super" => self.below(modules[module].parent?, rest),
            "Self" => None,
            _ => self.below(module, path),
        }
    }

    /// Follows a path that starts below `module`.
    fn below(&self, module: usize, path: &[String]) -> Option<(usize, String)> {
        let here = &self.of.modules[module];
        let (first, rest) = path.split_first()?;
        if first == "super" {
            return self.below(here.parent?, rest);
        }
        if let Some(&child) = here.children.get(first) {
            return self.below(child, rest);
        }
        if here.items.contains(first) {
            return Some((module, first.clone()));
        }
        let deeper = Resolver { of: self.of, depth: self.depth + 1 };
        let named = here.imports.iter().filter(|import| import.name.as_ref() == Some(first));
        for import in named {
            let whole: Vec<String> = import.path.iter().chain(rest).cloned().collect();
            // `use name;` of another crate imports a name that denotes itself.
            if whole == path {
                continue;
            }
            if let Some(found) = deeper.find(module, &whole) {
                return Some(found);
            }
        }
        let globs = here.imports.iter().filter(|import| import.name.is_none());
        for import in globs {
            let whole: Vec<String> = import.path.iter().chain(path).cloned().collect();
            if let Some(found) = deeper.find(module, &whole) {
                return Some(found);
            }
        }
        None
    }
}

/// The files of a crate that are not tests, sorted.
pub(crate) fn files_of(of: &Crate) -> Vec<PathBuf> {
    let files: BTreeSet<&PathBuf> = of.modules.iter().map(|module| &module.file).collect();
    files.into_iter().cloned().collect()
}
