//! The rules for the places of tests, for visibility and for lengths of files, checked against the
//! workspace itself.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::PathBuf,
};

use corniche_tidy::{crates_of, figures, files_below, root};

/// The largest number of lines of a file.
const MAX_FILE_LINES: usize = 600;
/// The number of product lines below which a crate's manifest must give a reason for the crate.
const SMALL_CRATE_LINES: usize = 1000;
/// The smallest number of words in a file's first line.
const LEAST_WORDS: usize = 4;

fn all_rust_files() -> Vec<PathBuf> {
    let files = files_below(&root(), "rs").expect("the repository can be listed");
    assert!(files.len() > 100, "the workspace has more files than {}", files.len());
    files
}

/// Unit tests are in `NAME_tests.rs` next to the code, integration tests in `tests/`.
#[test]
fn unit_tests_lie_beside_the_code() {
    for file in all_rust_files() {
        let text = fs::read_to_string(&file).unwrap();
        let inline = text.lines().any(|line| line.trim_start().starts_with("mod tests {"));
        assert!(!inline, "{} contains a test module; move it to a file of its own", file.display());
    }
}

/// The file of the module `name` is `name.rs`, and its children are in the folder `name/`. In the
/// folders of integration tests `mod.rs` is allowed, because cargo treats every other file at the
/// top of `tests/` as a test.
#[test]
fn modules_of_products_have_files_of_their_own_name() {
    for file in all_rust_files() {
        let in_repository = file.strip_prefix(root()).unwrap();
        let is_product = in_repository.components().any(|part| part.as_os_str() == "src");
        assert!(
            !(is_product && file.ends_with("mod.rs")),
            "{}: name the file after its folder and put it next to the folder",
            file.display()
        );
    }
}

/// Inside a crate, items are visible everywhere, with `pub(crate)`, or nowhere.
#[test]
fn visibility_inside_a_crate_has_one_form() {
    let others = [concat!("pub(", "super)"), concat!("pub(", "in ")];
    for file in all_rust_files() {
        let text = fs::read_to_string(&file).unwrap();
        assert!(
            !others.iter().any(|form| text.contains(form)),
            "{}: use pub(crate)",
            file.display()
        );
    }
}

#[test]
fn files_stay_short() {
    for file in all_rust_files() {
        let lines = fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= MAX_FILE_LINES, "{} has {lines} lines", file.display());
    }
}

/// The first line of a file states its purpose: its content, or, in a module of tests, the tested
/// property. No two files have the same first line.
#[test]
fn each_file_begins_with_what_it_is_for() {
    let mut seen = BTreeMap::new();
    for file in all_rust_files() {
        let text = fs::read_to_string(&file).unwrap();
        let first = text.lines().next().unwrap_or_default();
        let purpose = first.strip_prefix("//! ").unwrap_or_else(|| {
            panic!(
                "{}: the first line is not a `//!` comment that describes the file",
                file.display()
            )
        });
        let words = purpose.split_whitespace().count();
        assert!(words >= LEAST_WORDS, "{}: {purpose:?} says too little", file.display());
        if let Some(other) = seen.insert(purpose.to_owned(), file.clone()) {
            panic!("{} and {} begin with the same line", other.display(), file.display());
        }
    }
}

/// Files that a crate includes are in its own folder, so that `cargo package` packs them.
#[test]
fn included_files_lie_in_the_crate_that_includes_them() {
    let mut checked = 0;
    let mut taken = BTreeSet::new();
    let config = root().join("config");
    let mut folders = crates_of(&root()).unwrap();
    folders.push(config.clone());
    for file in all_rust_files() {
        let Some(package) = folders.iter().find(|folder| file.starts_with(folder)) else {
            continue;
        };
        if *package != config && !file.starts_with(package.join("src")) {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        for included in text.split("include_str!(\"").chain(text.split("include_bytes!(\"")).skip(1)
        {
            let Some((name, _)) = included.split_once('"') else { continue };
            let path = file.parent().unwrap().join(name);
            let Ok(path) = path.canonicalize() else { continue };
            checked += 1;
            assert!(path.starts_with(package), "{} includes {}", file.display(), path.display());
            taken.insert(path);
        }
    }
    assert!(checked > 10, "only {checked} files are included");
    for text in files_below(&config, "toml").unwrap() {
        let is_manifest = text.ends_with("config/Cargo.toml");
        assert!(is_manifest || taken.contains(&text), "config/lib.rs lacks {}", text.display());
    }
}

/// `Dockerfile` copies exactly the files that `.dockerignore` lets pass.
#[test]
fn an_image_is_built_from_the_archive() {
    let text = fs::read_to_string(root().join("Dockerfile")).unwrap();
    let copied = text.lines().filter_map(|line| line.strip_prefix("COPY ")?.split(' ').next());
    let own = copied.filter(|name| !name.starts_with("--"));
    let wanted: BTreeSet<String> = own.map(|name| format!("!{name}")).collect();
    let list = fs::read_to_string(root().join(".dockerignore")).unwrap();
    let passing = list.lines().filter(|line| line.starts_with('!')).map(str::to_owned).collect();
    assert_eq!(wanted, passing);
    assert!(!wanted.is_empty());
}

/// The manifest of a small crate gives a reason why the crate is separate.
#[test]
fn small_crates_say_why_they_stand_alone() {
    for folder in crates_of(&root()).unwrap() {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let says = manifest.lines().any(|line| line.starts_with("# Separate crate: "));
        let lines = figures(&folder).unwrap().product_lines;
        let is_small = lines < SMALL_CRATE_LINES;
        assert_eq!(is_small, says, "{}: {lines} product lines", folder.display());
    }
}
