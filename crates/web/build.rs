//! Reads the bundled TOML files, so that the module of the page needs no TOML parser: styles, and
//! the names of the classes in the FRC tables.

use std::{env, error::Error, fs, path::PathBuf};

use corniche_presets::{class_labels, frc_preset_names};
use corniche_styles::{Style, parse_style, style_preset, style_preset_names};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = PathBuf::from(env::var("OUT_DIR")?);
    let mut styles: Vec<(&str, Style)> = Vec::new();
    for name in style_preset_names() {
        let text = style_preset(name).ok_or("a style without a text")?;
        styles.push((name, parse_style(text)?));
    }
    let labels: Vec<(&str, Vec<String>)> =
        frc_preset_names().map(|name| (name, class_labels(name).into())).collect();
    let config = bincode::config::legacy();
    fs::write(folder.join("styles.bin"), bincode::serde::encode_to_vec(&styles, config)?)?;
    fs::write(folder.join("labels.bin"), bincode::serde::encode_to_vec(&labels, config)?)?;
    Ok(())
}
