//! GDAL and PROJ for the whole process: their releases, settings, and the tables, drivers and
//! certificates that a released program ships.

use std::{
    env,
    ffi::OsString,
    path::{Path, PathBuf},
    sync::LazyLock,
};

use gdal::{errors::GdalError, version::VersionInfo};

use crate::proj_folders;

/// The folder of GDAL and PROJ in a released archive, relative to the folder of the program.
/// `scripts/release` creates it.
const LIBRARIES: &str = "../lib/corniche";

/// The folder of PROJ's database and grids in it. A program that has this folder is a released one.
const PROJ_TABLES: &str = "share/proj";

/// GDAL's options for its folders in it.
const FOLDERS: [(&str, &str); 2] =
    [("GDAL_DATA", "share/gdal"), ("GDAL_DRIVER_PATH", "gdalplugins")];

/// Files in which systems keep their trusted certificates. The released library for `https://` was
/// built on one system and knows only the path of that system.
const CERTIFICATES: [&str; 4] = [
    "/etc/ssl/certs/ca-certificates.crt",
    "/etc/pki/tls/certs/ca-bundle.crt",
    "/etc/ssl/ca-bundle.pem",
    "/etc/ssl/cert.pem",
];

/// Makes GDAL and PROJ use the tables and drivers next to `program`, if it is a released one;
/// otherwise changes nothing. Must be called before anything else uses GDAL.
///
/// A shell in which conda or another installation of GDAL is active sets `PROJ_DATA`, `GDAL_DATA`
/// and `GDAL_DRIVER_PATH` for libraries of other versions, which a released program does not use.
/// Therefore the program's own folders have precedence; PROJ searches the user's folders after
/// them, for more grids. Certificates that the user names have precedence.
pub fn use_files_beside(program: &Path) {
    let Some(folder) = libraries_beside(program) else { return };
    for (option, name) in FOLDERS {
        let place = folder.join(name);
        if let (true, Some(place)) = (place.is_dir(), place.to_str()) {
            // GDAL rejects only a name with a zero byte, and no folder has one.
            let _ = gdal::config::set_config_option(option, place);
        }
    }
    let named = proj_folders::NAMED_BY.iter().find_map(env::var_os);
    proj_folders::search(&proj_search(&folder, proj_folders::of_user(), named));
    let found = || CERTIFICATES.into_iter().find(|file| Path::new(file).is_file());
    // GDAL reads this variable with lower precedence.
    let given = env::var("SSL_CERT_FILE").ok().filter(|file| !file.is_empty());
    if let Some(file) = given.or_else(|| found().map(str::to_owned)) {
        let _ = set_unless_set("CURL_CA_BUNDLE", &file);
    }
}

/// The folder of GDAL and PROJ next to a released program; `None` for other programs.
fn libraries_beside(program: &Path) -> Option<PathBuf> {
    let folder = program.parent()?.join(LIBRARIES);
    folder.join(PROJ_TABLES).is_dir().then_some(folder)
}

/// The folders in which PROJ searches tables and grids: its own, the one in which it saves grids
/// for the user, and those that the environment names.
fn proj_search(
    libraries: &Path,
    of_user: Option<PathBuf>,
    named: Option<OsString>,
) -> Vec<PathBuf> {
    let named = named.unwrap_or_default();
    let named = env::split_paths(&named).filter(|folder| !folder.as_os_str().is_empty());
    [libraries.join(PROJ_TABLES)].into_iter().chain(of_user).chain(named).collect()
}

/// Limits the memory in which GDAL caches blocks of rasters, for all threads together; without a
/// limit GDAL uses up to 5 % of the machine's memory. Must be called before the first file is
/// opened.
///
/// # Errors
/// When GDAL rejects the value.
pub fn limit_block_cache(bytes: u64) -> Result<(), GdalError> {
    // GDAL reads small numbers as megabytes; a megabyte is the smallest sensible value anyway.
    gdal::config::set_config_option("GDAL_CACHEMAX", &bytes.max(1 << 20).to_string())
}

/// Sets one of GDAL's options for the whole process, unless the user has set it in the environment
/// or in GDAL's own configuration file.
///
/// # Errors
/// When GDAL rejects the value.
pub fn set_unless_set(option: &str, value: &str) -> Result<(), GdalError> {
    if gdal::config::get_config_option(option, "")?.is_empty() {
        gdal::config::set_config_option(option, value)?;
    }
    Ok(())
}

/// The releases of GDAL and PROJ that this program uses, as packages record them.
#[must_use]
pub fn libraries() -> String {
    // Queried once: PROJ writes its version again each time, into one buffer for all threads, and
    // another thread may read it half written.
    static LIBRARIES: LazyLock<String> = LazyLock::new(|| {
        let proj = VersionInfo::build_info()
            .remove("PROJ_RUNTIME_VERSION")
            .unwrap_or_else(|| "unknown".to_owned());
        format!("GDAL {}, PROJ {proj}", VersionInfo::release_name())
    });
    LIBRARIES.clone()
}

#[cfg(test)]
#[path = "libraries_tests.rs"]
mod tests;
