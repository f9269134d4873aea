//! Inputs on servers: their names for users and for GDAL, and how GDAL reaches the servers.

use std::{
    collections::HashSet,
    path::{Path, PathBuf},
};

use corniche_gis::{SoughtFiles, expand_name, set_unless_set, unpack_name};
use corniche_objects::{ObjectAddress, StorageSettings};

use super::error::InputError;

/// Returns the name by which GDAL knows an input: `s3://BUCKET/NAME` becomes `/vsis3/BUCKET/NAME`,
/// `https://…` becomes `/vsicurl/https://…`. Other names stay as they are.
///
/// # Errors
/// When the name begins like an address in object storage but is not a valid one.
pub fn input_name(path: PathBuf) -> Result<PathBuf, corniche_objects::ObjectError> {
    let Some(text) = path.to_str() else { return Ok(path) };
    if let Some(ObjectAddress { bucket, key }) = ObjectAddress::parse(text)? {
        return Ok(format!("/vsis3/{bucket}/{key}").into());
    }
    if text.starts_with("https://") || text.starts_with("http://") {
        return Ok(format!("/vsicurl/{text}").into());
    }
    Ok(path)
}

/// Expands names into elevation files, as GDAL knows them, in order of precedence. Folders,
/// patterns, `@LIST`, archives and addresses are expanded; see [`expand_name`] and [`unpack_name`].
///
/// # Errors
/// When a name matches no file, or is not a valid address.
pub fn elevation_names(names: &[PathBuf]) -> Result<Vec<PathBuf>, InputError> {
    raster_names(names, SoughtFiles::Elevation)
}

/// Expands names, each into the files for which it stands.
fn expanded(names: &[PathBuf], sought: SoughtFiles) -> Result<Vec<PathBuf>, InputError> {
    let mut plain = Vec::new();
    for name in names {
        for name in expand_name(name, sought)? {
            plain.push(input_name(name)?);
        }
    }
    Ok(plain)
}

/// Expands names into rasters.
fn raster_names(names: &[PathBuf], sought: SoughtFiles) -> Result<Vec<PathBuf>, InputError> {
    let plain = expanded(names, sought)?;
    // Archives on a server are opened, too.
    reach_servers(plain.iter().map(PathBuf::as_path))?;
    let mut files = Vec::new();
    for name in plain {
        files.extend(unpack_name(name)?);
    }
    Ok(files)
}

/// Expands names into photos, in the order of the names: the first photo is on top. Names are
/// expanded as for elevation files.
///
/// # Errors
/// See [`elevation_names`].
pub fn photo_names(names: &[PathBuf]) -> Result<Vec<PathBuf>, InputError> {
    raster_names(names, SoughtFiles::Photos)
}

/// Expands names, including folders, patterns and `@LIST`, into extracts. The extracts are sorted
/// by file name and then by path, each once, so that the result does not depend on the order of the
/// names.
///
/// # Errors
/// When a name matches no file, or is not a valid address.
pub fn extract_names(names: &[PathBuf]) -> Result<Vec<PathBuf>, InputError> {
    let mut files = expanded(names, SoughtFiles::Extracts)?;
    // One file may have been named in several ways.
    let place = |path: &PathBuf| path.canonicalize().unwrap_or_else(|_| path.clone());
    let key = |path: &PathBuf| (path.file_name().map(ToOwned::to_owned), place(path));
    files.sort_by_cached_key(key);
    let mut known = HashSet::new();
    files.retain(|path| known.insert(place(path)));
    Ok(files)
}

/// Configures how GDAL reaches servers, before GDAL reads the first of these files, which may be on
/// servers or name other files that are. GDAL's own settings take precedence and are left alone.
/// Fails with the setting that GDAL rejected.
pub(crate) fn reach_servers<'a>(
    files: impl IntoIterator<Item = &'a Path>,
) -> Result<(), InputError> {
    let settings = StorageSettings::of_environment();
    let mut names = files.into_iter().filter_map(Path::to_str);
    if !names.any(|name| name.contains("/vsi"))
        && settings.endpoint().is_none()
        && !settings.is_unsigned()
    {
        return Ok(());
    }
    for (option, value) in options(&settings) {
        set_unless_set(option, &value)
            .map_err(|error| InputError::Setting { what: format!("{option}: {error}") })?;
    }
    Ok(())
}

/// GDAL's options for the settings of the environment.
fn options(settings: &StorageSettings) -> Vec<(&'static str, String)> {
    let text = str::to_owned;
    // Temporary failures are retried. GDAL retries only if it is configured to.
    let mut options = vec![
        ("GDAL_HTTP_MAX_RETRY", text("8")),
        ("GDAL_HTTP_RETRY_DELAY", text("0.5")),
        // A connection is given up after a minute with fewer bytes per second than this.
        ("GDAL_HTTP_LOW_SPEED_LIMIT", text("1024")),
        ("GDAL_HTTP_LOW_SPEED_TIME", text("60")),
    ];
    if let Some(endpoint) = settings.endpoint() {
        let is_plain = endpoint.starts_with("http://");
        let host = endpoint.split_once("://").map_or(endpoint, |(_, host)| host);
        options.push(("AWS_S3_ENDPOINT", text(host.trim_end_matches('/'))));
        options.push(("AWS_HTTPS", text(if is_plain { "NO" } else { "YES" })));
        options.push(("AWS_VIRTUAL_HOSTING", text("FALSE")));
    }
    if settings.is_unsigned() {
        options.push(("AWS_NO_SIGN_REQUEST", text("YES")));
    }
    options
}

#[cfg(test)]
#[path = "servers_tests.rs"]
mod tests;
