//! Copies the shaders without their comments, which the program does not need: in the WebAssembly
//! module of a web page every kilobyte counts. Line numbers stay the same.

use std::{env, error::Error, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=src/shaders");
    let folder = Path::new(&env::var("OUT_DIR")?).join("shaders");
    fs::create_dir_all(&folder)?;
    for entry in fs::read_dir("src/shaders")? {
        let path = entry?.path();
        let text = fs::read_to_string(&path)?;
        let name = path.file_name().ok_or("a shader without a name")?;
        fs::write(folder.join(name), without_comments(&text))?;
    }
    Ok(())
}

/// Removes comments. WGSL has no string literals, so `//` always begins a comment.
fn without_comments(text: &str) -> String {
    let code = |line: &str| line.split("//").next().unwrap_or_default().trim_end().to_owned();
    text.lines().map(|line| code(line) + "\n").collect()
}
