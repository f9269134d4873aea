//! One name for one thing: words that once stood for many things name no type and no file of products.

use std::fs;

use corniche_tidy::{crates_of, files_below, read_crate, root};

/// Each of these was the name of up to seven types. What a thing is in particular belongs into its name: `GridFrame`, `RoadPart`.
const TYPES: [&str; 5] = ["Frame", "Part", "PartRecord", "Place", "Splitting"];
/// Each of these was the name of several files.
const FILES: [&str; 3] = ["place.rs", "request.rs", "run.rs"];

#[test]
fn no_type_has_a_name_that_stood_for_many() {
    for folder in crates_of(&root()).unwrap() {
        let read = read_crate(&folder).unwrap();
        for module in &read.modules {
            for name in TYPES {
                assert!(
                    !module.items.iter().any(|item| item == name),
                    "{}/src/{}: say in the name of {name} what it is",
                    folder.display(),
                    module.file.display()
                );
            }
        }
    }
}

#[test]
fn no_file_has_a_name_that_stood_for_many() {
    for folder in crates_of(&root()).unwrap() {
        for file in files_below(&folder.join("src"), "rs").unwrap() {
            let name = file.file_name().unwrap();
            assert!(
                !FILES.iter().any(|taken| name == *taken),
                "{}: say in the name what is in the file",
                file.display()
            );
        }
    }
}

/// Functional road classes are 0 to 8: 8 is for paths, steps and cycleways.
#[test]
fn functional_road_classes_are_0_to_8() {
    let wrong = ["FRC 0–7", "FRC 0-7", "FRC 0..7", "FRC 0 to 7"];
    for file in files_below(&root().join("crates"), "rs").unwrap() {
        let text = fs::read_to_string(&file).unwrap();
        for form in wrong {
            assert!(!text.contains(form), "{}: {form}", file.display());
        }
    }
}
