//! Checks whether the page in the program (`crates/cli/page`) was generated from the current
//! sources.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write as _,
    fs,
    path::Path,
};

use anyhow::{Context, Result};
use sha2::{Digest, Sha256};
use toml::{Table, Value};

use crate::{files::files_in, source::is_test_file};

/// The path of the record about the generated page, relative to the root.
pub const PAGE: &str = "crates/cli/page.toml";

/// The folders of the crates whose modules the page loads.
const MODULES: [&str; 2] = ["crates/web", "crates/web-styles"];
/// The scripts that generate the page from the crates.
const SCRIPTS: [&str; 2] = ["scripts/web", "scripts/lib/web.sh"];
/// Folders of a crate that are not sources of the page.
const NOT_SOURCES: [&str; 3] = ["tests", "benches", "examples"];

/// The SHA-256, in hexadecimal digits, of all sources of the page: the crates of its modules and
/// the crates that they use, the versions and settings of external dependencies, and the script.
///
/// # Errors
/// When a file cannot be read or a manifest is not valid TOML.
pub fn page_sources(root: &Path) -> Result<String> {
    let workspace = read_toml(&root.join("Cargo.toml"))?;
    let mut hash = Sha256::new();
    let mut add = |name: &str, bytes: &[u8]| {
        hash.update((name.len() as u64).to_le_bytes());
        hash.update(name);
        hash.update((bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    };
    let known = workspace.get("workspace").and_then(|table| table.get("dependencies"));
    let known = known.context("Cargo.toml has no workspace dependencies")?;
    let used = used_crates(root, known)?;
    for name in &used.own {
        let folder = root.join(name);
        for file in files_in(&folder)? {
            let inside = file.strip_prefix(&folder)?;
            let is_other = NOT_SOURCES.iter().any(|name| inside.starts_with(name));
            let is_text = inside.extension().is_some_and(|ending| ending == "md");
            if !is_text && !is_test_file(inside) && !is_other {
                let bytes =
                    fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
                add(&format!("{name}/{}", inside.display()), &bytes);
            }
        }
    }
    for name in &used.names {
        add(name, known[name].to_string().as_bytes());
    }
    // The profiles of the browser's modules; the profile for wasm inherits from that for releases.
    for name in ["release", "wasm"] {
        let profile = workspace.get("profile").and_then(|profiles| profiles.get(name));
        let profile = profile.with_context(|| format!("Cargo.toml has no profile {name}"))?;
        add(name, profile.to_string().as_bytes());
    }
    add("versions", locked_versions(root, &used.names)?.as_bytes());
    for script in SCRIPTS {
        add(script, &fs::read(root.join(script)).with_context(|| format!("cannot read {script}"))?);
    }
    Ok(hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// The crates from which the modules are built.
#[derive(Default)]
struct UsedCrates {
    /// Folders of the workspace.
    own: BTreeSet<String>,
    /// Names in `workspace.dependencies`, of the workspace's own crates and of others.
    names: BTreeSet<String>,
}

fn used_crates(root: &Path, known: &Value) -> Result<UsedCrates> {
    let mut found = UsedCrates::default();
    let mut open: Vec<String> = MODULES.map(str::to_owned).into();
    while let Some(folder) = open.pop() {
        let manifest = read_toml(&root.join(&folder).join("Cargo.toml"))?;
        found.own.insert(folder);
        for name in dependencies(&manifest) {
            let dependency = known.get(&name).with_context(|| {
                format!("{name} is not a dependency of the workspace in Cargo.toml")
            })?;
            if let Some(folder) = dependency.get("path").and_then(Value::as_str)
                && !found.own.contains(folder)
            {
                open.push(folder.to_owned());
            }
            found.names.insert(name);
        }
    }
    Ok(found)
}

/// The names of a manifest's dependencies, on any system, except for those of tests.
fn dependencies(manifest: &Table) -> Vec<String> {
    let targets = manifest.get("target").and_then(Value::as_table);
    let tables =
        targets.into_iter().flatten().filter_map(|(_, target)| target.as_table()).chain([manifest]);
    let kinds =
        tables.flat_map(|table| ["dependencies", "build-dependencies"].map(|kind| table.get(kind)));
    let names = kinds.flatten().filter_map(Value::as_table).flat_map(Table::keys);
    names.cloned().collect()
}

/// The names and versions of all packages on which these names depend, as the lock file lists them.
fn locked_versions(root: &Path, names: &BTreeSet<String>) -> Result<String> {
    let lock = read_toml(&root.join("Cargo.lock"))?;
    let packages = lock["package"].as_array().context("Cargo.lock lists no packages")?;
    let mut by_name: BTreeMap<&str, Vec<&Value>> = BTreeMap::new();
    for package in packages {
        let name = package["name"].as_str().context("a package without a name")?;
        by_name.entry(name).or_default().push(package);
    }
    // The dependencies of the workspace's own crates are among the names; the lock file also lists
    // those of their tests.
    let is_other = |name: &&str| !name.starts_with("corniche-");
    let mut open: Vec<&str> = names.iter().map(String::as_str).filter(is_other).collect();
    let mut found = BTreeSet::new();
    while let Some(name) = open.pop() {
        for package in by_name.get(name).into_iter().flatten() {
            if found.insert(format!("{name} {}\n", package["version"])) {
                let needed = package.get("dependencies").and_then(Value::as_array);
                // An entry is `name` or `name version`.
                open.extend(
                    needed
                        .into_iter()
                        .flatten()
                        .filter_map(|text| text.as_str()?.split_whitespace().next()),
                );
            }
        }
    }
    Ok(found.into_iter().collect())
}

fn read_toml(path: &Path) -> Result<Table> {
    let text =
        fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    text.parse().with_context(|| format!("{} is not valid TOML", path.display()))
}
