//! Settings are checked once the command line has overridden them.

use corniche_presets::{Config, ResourceOptions};

use super::*;

#[test]
fn lengths_must_be_lengths() {
    assert!(positive("--max-error", Some(0.0)).is_err());
    assert!(positive("--max-error", Some(f64::NAN)).is_err());
    assert_eq!(positive("--max-error", Some(2.5)).unwrap(), Some(2.5));
}

#[test]
fn a_memory_that_the_command_line_overrides_does_not_matter() {
    let of_file = Config::parse("[resources]\nmemory = \"1M\"\n").unwrap().resources;
    let error = resources(None, of_file.memory.as_deref()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "--memory \"1M\" is not a size of at least 256M; write it like 512M, 800MB, 0.5G or 1T"
    );
    let given = ResourceOptions { memory: Some("512M".to_owned()), ..ResourceOptions::default() };
    let merged = given.or(of_file);
    assert_eq!(resources(None, merged.memory.as_deref()).unwrap().memory_bytes, 512 << 20);
}
