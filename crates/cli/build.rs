//! Puts the page of the viewer into the program, where the environment names a folder with its files (`CORNICHE_PAGE`; `scripts/web` makes
//! one). Without it the program has no page of its own.

#[path = "src/serve/page_files.rs"]
mod page_files;

use std::{
    env,
    error::Error,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

/// Names the folder. A path that is not absolute begins at the root of the repository.
const FOLDER: &str = "CORNICHE_PAGE";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed={FOLDER}");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/serve/page_files.rs");
    let mut table = String::from("&[\n");
    if let Some(named) = env::var_os(FOLDER).filter(|named| !named.is_empty()) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folder = root.join(named);
        println!("cargo::rerun-if-changed={}", folder.display());
        let files = page_files::page_files(&folder)
            .map_err(|error| format!("{FOLDER}: {}: {error}", folder.display()))?;
        for (path, file) in files {
            let file = file.canonicalize()?;
            let file = file.to_str().ok_or_else(|| format!("{} is not UTF-8", file.display()))?;
            writeln!(table, "    ({path:?}, include_bytes!({file:?}).as_slice()),")?;
        }
    }
    table.push_str("]\n");
    let target = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo names no OUT_DIR")?);
    fs::write(target.join("page.rs"), table)?;
    Ok(())
}
