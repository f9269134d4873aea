//! Every test is compiled, every command that names a test finds one, and tests that cannot run
//! report it in one way.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_tidy::{crates_of, files_below, root};

/// Test binaries other than `it`, with the reason why each needs a separate process.
const ALONE: [(&str, &str); 4] = [
    ("osm/tests/memory", "measures the peak memory of its process"),
    ("osm/tests/memory_of_roads", "measures the peak memory of its process"),
    (
        "store/tests/killed",
        "a child that is about to begin shares the locks of other tests for a moment",
    ),
    (
        "tileset/tests/hostile",
        "owns the allocator, to bound what hostile bytes make the reader allocate",
    ),
];

/// The packages with tests: the name for `-p`, and the folder.
fn packages() -> BTreeMap<String, PathBuf> {
    let others = ["config", "tests", "fuzz", "tidy"].map(|name| root().join(name));
    let folders = crates_of(&root()).unwrap().into_iter().chain(others);
    folders
        .map(|folder| {
            let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
            let manifest: toml::Table = manifest.parse().unwrap();
            (manifest["package"]["name"].as_str().unwrap().to_owned(), folder)
        })
        .collect()
}

/// The test binaries of a package: the name, and the root file.
fn binaries(package: &Path) -> Vec<(String, PathBuf)> {
    let tests = package.join("tests");
    let Ok(entries) = fs::read_dir(&tests) else { return Vec::new() };
    let mut found = Vec::new();
    for path in entries.map(|entry| entry.unwrap().path()) {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if path.extension().is_some_and(|end| end == "rs") {
            found.push((name, path));
        } else if path.join("main.rs").is_file() {
            found.push((name, path.join("main.rs")));
        }
    }
    found
}

/// A package has one test binary, because linking takes as long as compiling. Exceptions are in the
/// list, with their reasons.
#[test]
fn a_package_has_one_test_binary() {
    let mut alone = Vec::new();
    for folder in packages().values() {
        for (name, _) in binaries(folder).iter().filter(|(name, _)| name != "it") {
            let package = folder.file_name().unwrap().to_string_lossy();
            alone.push(format!("{package}/tests/{name}"));
        }
    }
    alone.sort();
    assert_eq!(alone, ALONE.map(|(binary, _)| binary));
}

/// The modules that a file declares.
fn declared(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).unwrap();
    let names = text.lines().filter_map(|line| {
        let (before, name) = line.trim().strip_suffix(';')?.rsplit_once("mod ")?;
        matches!(before, "" | "pub " | "pub(crate) ").then(|| name.to_owned())
    });
    names.collect()
}

/// Cargo does not find files in `tests/it`: each must be declared by the file above it, or its
/// tests never run.
#[test]
fn every_file_of_tests_is_a_module() {
    let mut checked = 0;
    for it in packages().values().map(|folder| folder.join("tests/it")) {
        for file in files_below(&it, "rs").unwrap() {
            let (stem, folder) = (file.file_stem().unwrap(), file.parent().unwrap());
            let (name, above) = match stem.to_str().unwrap() {
                "main" if folder == it => continue,
                "mod" => (folder.file_name().unwrap(), folder.parent().unwrap()),
                _ => (stem, folder),
            };
            let root_of = |folder: &Path| {
                if folder == it { folder.join("main.rs") } else { folder.with_extension("rs") }
            };
            let above =
                [root_of(above), above.join("mod.rs")].into_iter().find(|file| file.is_file());
            let above = above.unwrap_or_else(|| panic!("{} belongs to no module", file.display()));
            let is_declared = declared(&above).iter().any(|declared| **declared == *name);
            assert!(is_declared, "{} does not declare {}", above.display(), file.display());
            checked += 1;
        }
    }
    assert!(checked > 100, "only {checked} files were checked");
}

/// The names of the test functions in a text, including those within `proptest!`.
fn tests_of(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut is_test = false;
    for line in text.lines().map(str::trim_start) {
        if let Some((name, _)) = line.strip_prefix("fn ").and_then(|rest| rest.split_once('(')) {
            names.extend(is_test.then(|| name.to_owned()));
        }
        // There may be other attributes between.
        is_test = line == "#[test]" || is_test && line.starts_with("#[");
    }
    names
}

/// Paths of the tests of a binary, `module::function`, as `libtest` names them.
fn test_names(root_file: &Path) -> Vec<String> {
    let folder = root_file.parent().unwrap();
    let is_folder = root_file.ends_with("main.rs");
    let files =
        if is_folder { files_below(folder, "rs").unwrap() } else { vec![root_file.to_owned()] };
    let of_file = |file: &PathBuf| {
        let inside = file.strip_prefix(folder).unwrap().with_extension("");
        let modules = inside.iter().map(|part| part.to_string_lossy().into_owned());
        let modules: Vec<String> =
            modules.filter(|part| is_folder && part != "main" && part != "mod").collect();
        let names = tests_of(&fs::read_to_string(file).unwrap());
        names.into_iter().map(move |name| [&modules[..], &[name]].concat().join("::"))
    };
    files.iter().flat_map(of_file).collect()
}

/// The words after this word in a command.
fn after<'a>(words: &[&'a str], word: &str) -> Vec<&'a str> {
    words.windows(2).filter(|pair| pair[0] == word).map(|pair| pair[1]).collect()
}

/// The reason why a command of the form `cargo test …` runs no test; `None` if it runs one, or
/// names none.
fn finds_nothing(command: &str, packages: &BTreeMap<String, PathBuf>) -> Option<String> {
    let (command, _) = command.split_once(" -- ").unwrap_or((command, ""));
    let words: Vec<&str> = command.split_whitespace().collect();
    let [named, targets] = [["-p", "--package"], ["--test", "--test"]]
        .map(|options| options.iter().flat_map(|option| after(&words, option)).collect::<Vec<_>>());
    let mut chosen: Vec<&PathBuf> = Vec::new();
    for name in named {
        match packages.get(name) {
            Some(folder) => chosen.push(folder),
            None => return Some(format!("there is no package {name}")),
        }
    }
    if chosen.is_empty() {
        chosen = packages.values().collect();
    }
    // The first word that is neither an option nor an option's value filters the names.
    let takes_value =
        ["-p", "--package", "--test", "--features", "--target", "--profile", "--example"];
    let mut filter = None;
    let mut rest = words.iter().skip(2);
    while let Some(word) = rest.next() {
        if takes_value.contains(word) {
            rest.next();
        } else if !word.starts_with('-') && filter.is_none() {
            filter = Some(*word);
        }
    }
    let mut tests = Vec::new();
    for target in &targets {
        let found: Vec<PathBuf> = chosen
            .iter()
            .flat_map(|folder| binaries(folder))
            .filter_map(|(name, file)| (name == *target).then_some(file))
            .collect();
        if found.is_empty() {
            return Some(format!("there is no test binary {target}"));
        }
        tests.extend(found.iter().flat_map(|file| test_names(file)));
    }
    if targets.is_empty() {
        let of_file = |file: PathBuf| {
            let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
            let module = stem.trim_end_matches("_tests").to_owned();
            let names = tests_of(&fs::read_to_string(&file).unwrap());
            names.into_iter().map(move |name| format!("{module}::{name}"))
        };
        let files = chosen.iter().flat_map(|folder| files_below(folder, "rs").unwrap());
        tests = files.flat_map(of_file).collect();
    }
    // A page may leave the name to the reader.
    let filter = filter.filter(|filter| *filter != "NAME")?;
    let runs = tests.iter().any(|name| name.contains(filter));
    (!runs).then(|| format!("no test is called {filter}"))
}

/// The commands `cargo test …` in a text, up to the end of the line or of the code span.
/// `scripts/test TIER NAME` is returned as the command that it runs.
fn commands(text: &str) -> Vec<String> {
    let joined = text.replace("\\\n", " ");
    let ends = |c: char| "`\"')#|&>;".contains(c);
    let mut found = Vec::new();
    for line in joined.lines().filter(|line| !line.trim_start().starts_with("# ")) {
        let from = |begin: &str| -> Vec<String> {
            let places = line.match_indices(begin).map(|(at, _)| &line[at..]);
            places
                .map(|rest| rest.split(ends).next().unwrap_or_default().trim().to_owned())
                .collect()
        };
        found.extend(from("cargo test"));
        for command in from("scripts/test ") {
            let words: Vec<&str> = command.split_whitespace().collect();
            if let ["scripts/test", "quick" | "ci" | "full", name, ..] = words[..] {
                found.push(format!("cargo test --workspace {name}"));
            }
        }
    }
    found
}

/// Commands in pages, scripts and comments run at least one test.
#[test]
fn commands_that_name_a_test_find_it() {
    let packages = packages();
    let mut files = files_below(&root(), "md").unwrap();
    files.extend(files_below(&root(), "rs").unwrap());
    files.extend(files_below(&root().join("scripts"), "sh").unwrap());
    let scripts = fs::read_dir(root().join("scripts")).unwrap().map(|entry| entry.unwrap().path());
    files.extend(scripts.filter(|path| path.is_file()));
    files.push(root().join(".ci/run"));
    let mut checked = 0;
    let mut wrong = Vec::new();
    for file in files.iter().filter(|file| !file.ends_with("tests_are_run.rs")) {
        // A script may be a binary file.
        let Ok(text) = fs::read_to_string(file) else { continue };
        for command in commands(&text) {
            checked += 1;
            if let Some(why) = finds_nothing(&command, &packages) {
                wrong.push(format!("{}: {command}: {why}", file.display()));
            }
        }
    }
    assert!(checked > 10, "only {checked} commands were found");
    assert!(wrong.is_empty(), "commands that run no test:\n{}", wrong.join("\n"));
}

/// The search for commands finds those that name no test.
#[test]
fn wrong_commands_are_seen() {
    let packages = packages();
    let wrong = |command: &str| finds_nothing(command, &packages);
    assert_eq!(wrong("cargo test --workspace --locked"), None);
    assert_eq!(wrong("cargo test -p corniche-tidy --test it wrong_commands -- --nocapture"), None);
    assert_eq!(wrong("cargo test -p corniche-tidy --test it tests_are_run::wrong"), None);
    for (command, why) in [
        ("cargo test -p corniche-tiddy", "no package corniche-tiddy"),
        ("cargo test -p corniche-tidy --test files", "no test binary files"),
        ("cargo test -p corniche-tidy --test it nothing_of_this_name", "no test is called"),
        ("cargo test --locked --test it nothing_of_this_name -- --ignored", "no test is called"),
        // A helper function is not a test.
        ("cargo test -p corniche-tidy --test it finds_nothing", "no test is called"),
        ("cargo test -p corniche-tidy finds_nothing", "no test is called"),
    ] {
        assert!(wrong(command).is_some_and(|said| said.contains(why)), "{command}");
    }
    assert_eq!(
        commands("run `cargo test -p a b` now\ncargo test \\\n -p c"),
        ["cargo test -p a b", "cargo test   -p c"]
    );
}

/// `corniche_testing::skip` counts skipped tests; a line that a test prints by itself is lost.
#[test]
fn what_is_skipped_is_counted() {
    let forms = ["print", "eprint"].map(|name| format!("{name}ln!(\"{}", "skipped"));
    for file in files_below(&root(), "rs").unwrap() {
        if file.ends_with("crates/testing/src/skip.rs") {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        let has_form = forms.iter().any(|form| text.contains(form));
        assert!(!has_form, "{}: use corniche_testing::skip", file.display());
        // A test is skipped in one of two ways: `skip`, or `ignore` with the reason why it is slow.
        for line in text.lines().filter(|line| line.trim_start().starts_with("#[ignore")) {
            let is_slow = line.trim_start().starts_with("#[ignore = \"slow: ");
            assert!(is_slow, "{}: {line}: write #[ignore = \"slow: reason\"]", file.display());
        }
    }
}
