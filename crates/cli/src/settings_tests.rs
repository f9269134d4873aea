//! Settings are checked after the command line has overridden them.

use corniche_presets::{Config, ResourceOptions};

use super::*;

#[test]
fn lengths_must_be_lengths() {
    let checked = |max_error_m| {
        let options = TerrainOptions { max_error: Some(max_error_m), ..TerrainOptions::default() };
        Ok::<_, CommandFailure>(terrain_settings(options, TerrainSettings::usual())?.max_error_m)
    };
    assert!(checked(0.0).is_err());
    assert!(checked(f64::NAN).is_err());
    assert_eq!(checked(2.5).unwrap(), Some(2.5));
}

#[test]
fn a_memory_that_the_command_line_overrides_does_not_matter() {
    let of_file = Config::parse("[resources]\nmemory = \"1M\"\n").unwrap().resources;
    let error = resources(None, of_file.memory.as_deref()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "--memory \"1M\" is not a size of at least 256M; write a size such as 512M, 800MB, 0.5G or 1T"
    );
    let given = ResourceOptions { memory: Some("512M".to_owned()), ..ResourceOptions::default() };
    let merged = given.or(of_file);
    assert_eq!(resources(None, merged.memory.as_deref()).unwrap().memory_bytes, 512 << 20);
}

/// The settings file that comes with the program, with those keys uncommented whose line
/// `is_wanted` accepts.
fn uncommented(is_wanted: impl Fn(&str) -> bool) -> String {
    let lines = corniche_config::BUILD_SETTINGS.lines().map(|line| match line.strip_prefix('#') {
        Some(key) if is_key(line) && is_wanted(key) => key,
        _ => line,
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Whether this line is a commented key: no space follows its `#`.
fn is_key(line: &str) -> bool {
    line.strip_prefix('#').is_some_and(|key| key.starts_with(char::is_alphabetic))
}

/// The settings in a file; without inputs, outputs and settings that depend on the machine.
fn settings_of(text: &str) -> String {
    let Config { terrain, roads, layers, photo, .. } = Config::parse(text).unwrap();
    let credits = (terrain.attribution.clone(), photo.attribution.clone(), terrain.bounds);
    let terrain = terrain_settings(terrain, TerrainSettings::usual()).unwrap();
    let photo = photo_choice(&[PathBuf::from("a.tif")], &photo).unwrap();
    let layers = layer_tables(&layers, &[]).unwrap();
    format!("{credits:?} {terrain:?} {:?} {layers:?} {photo:?}", road_settings(roads).unwrap())
}

/// Every key of the settings file is known. A default has no effect, but an example has. Inputs and
/// outputs have no defaults, and those of resources depend on the machine.
#[test]
fn the_settings_file_has_the_defaults() {
    // Two pairs of keys exclude each other only when a build begins, so all can be parsed at once.
    Config::parse(&uncommented(|_| true)).unwrap();
    let without = settings_of("");
    let mut compared = 0;
    let mut is_compared = false;
    let lines = corniche_config::BUILD_SETTINGS.lines();
    for line in lines.filter(|line| is_key(line) || line.starts_with('[')) {
        if let Some(section) = line.strip_prefix('[') {
            is_compared = !["inputs]", "output]", "resources]"].contains(&section);
            continue;
        }
        if is_compared {
            let text = uncommented(|key| Some(key) == line.strip_prefix('#'));
            // An example is not a default.
            let is_example = line.ends_with("# example");
            assert_eq!(settings_of(&text) != without, is_example, "{line}");
            compared += 1;
        }
    }
    assert!(compared > 20, "only {compared} keys were compared");
}

/// The settings file has every key: those that the parser lists in its error about an unknown key.
#[test]
fn the_settings_file_has_every_key() {
    let known = |text: &str| -> Vec<String> {
        let error = Config::parse(text).unwrap_err().to_string();
        let (_, names) =
            error.split_once("expected one of").or_else(|| error.split_once("expected")).unwrap();
        names.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    };
    let whole: toml::Table = uncommented(|_| true).parse().unwrap();
    let sections = known("nothing-of-ours = 1");
    assert_eq!(sections.len(), whole.len());
    for section in sections {
        let mut keys: Vec<String> = whole[&section].as_table().unwrap().keys().cloned().collect();
        let mut wanted = known(&format!("[{section}]\nnothing-of-ours = 1"));
        keys.sort();
        wanted.sort();
        assert_eq!(keys, wanted, "[{section}]");
    }
}

#[test]
fn memory_has_a_least_size() {
    let bytes = |text| {
        let found = resources(None, Some(text)).map(|found| found.memory_bytes);
        found.map_err(|failure| failure.to_string())
    };
    assert_eq!(bytes("256M"), Ok(256 << 20));
    assert_eq!(bytes("1073741824"), Ok(1 << 30));
    for bad in ["", "G", "-1G", "255M", "99999999999G", "ä"] {
        assert!(bytes(bad).unwrap_err().contains("at least 256M"), "{bad}");
    }
}
