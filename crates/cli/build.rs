//! Embeds the page of the viewer into the program: the files in `page`, which `scripts/web
//! --update` creates.

#[path = "src/serve/page_files.rs"]
mod page_files;

use std::{env, error::Error, fmt::Write as _, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=page");
    println!("cargo::rerun-if-changed=src/serve/page_files.rs");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
    let mut table = String::from("&[\n");
    for (path, file) in page_files::page_files(&folder)? {
        let file = file.to_str().ok_or("a path that is not UTF-8")?;
        writeln!(table, "    ({path:?}, include_bytes!({file:?}).as_slice()),")?;
    }
    table.push_str("]\n");
    let target = env::var_os("OUT_DIR").ok_or("cargo names no OUT_DIR")?;
    fs::write(Path::new(&target).join("page.rs"), table)?;
    Ok(())
}
