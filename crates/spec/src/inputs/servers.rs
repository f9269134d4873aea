//! Inputs on servers: what users call them, what GDAL calls them, and how GDAL reaches them.

use std::{
    collections::HashSet,
    path::{Path, PathBuf},
};

use corniche_gis::{Sought, expand_name, set_unless_set, unpack_name};
use corniche_objects::{ObjectAddress, StorageSettings};

use super::error::InputError;

/// The name by which GDAL knows an input: `s3://BUCKET/NAME` is `/vsis3/BUCKET/NAME`, `https://…` is `/vsicurl/https://…`. Other names stay as they are.
///
/// # Errors
/// Where it begins as an address in object storage and is none.
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

/// The elevation files that names stand for, as GDAL knows them, in the order in which they have precedence: folders, patterns, `@LIST`, archives
/// and addresses included; see [`expand_name`] and [`unpack_name`].
///
/// # Errors
/// When a name stands for no file, or is no address.
pub fn elevation_names(names: &[PathBuf]) -> Result<Vec<PathBuf>, InputError> {
    raster_names(names, Sought::Elevation)
}

/// The rasters that names stand for.
fn raster_names(names: &[PathBuf], sought: Sought) -> Result<Vec<PathBuf>, InputError> {
    let mut plain = Vec::new();
    for name in names {
        for name in expand_name(name, sought)? {
            plain.push(input_name(name)?);
        }
    }
    // An archive on a server is looked into.
    reach_servers(plain.iter().map(PathBuf::as_path))?;
    let mut files = Vec::new();
    for name in plain {
        files.extend(unpack_name(name)?);
    }
    Ok(files)
}

/// The photos that names stand for, in the order in which they were named: the first lies on top. Names are as for elevation files.
///
/// # Errors
/// As [`elevation_names`].
pub fn photo_names(names: &[PathBuf]) -> Result<Vec<PathBuf>, InputError> {
    raster_names(names, Sought::Photos)
}

/// The extracts that names stand for, sorted by file name and then by path, each once: folders, patterns and `@LIST` included. What is made of
/// them does not depend on the order in which they were named.
///
/// # Errors
/// When a name stands for no file, or is no address.
pub fn extract_names(names: &[PathBuf]) -> Result<Vec<PathBuf>, InputError> {
    let mut files = Vec::new();
    for name in names {
        for name in expand_name(name, Sought::Extracts)? {
            files.push(input_name(name)?);
        }
    }
    // One file may be written in several ways.
    let place = |path: &PathBuf| path.canonicalize().unwrap_or_else(|_| path.clone());
    let key = |path: &PathBuf| (path.file_name().map(ToOwned::to_owned), place(path));
    files.sort_by_cached_key(key);
    let mut known = HashSet::new();
    files.retain(|path| known.insert(place(path)));
    Ok(files)
}

/// Tells GDAL how servers are reached, before it is asked for the first of these files, which may be on servers, or name others that are. Its own
/// settings count for more, and are left alone. Fails with the setting that GDAL refused.
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

/// GDAL's options for what the environment says.
fn options(settings: &StorageSettings) -> Vec<(&'static str, String)> {
    let text = str::to_owned;
    // What fails for a moment is tried again. GDAL does so only if it is told.
    let mut options = vec![
        ("GDAL_HTTP_MAX_RETRY", text("8")),
        ("GDAL_HTTP_RETRY_DELAY", text("0.5")),
        // A server that sends fewer bytes a second for a minute is given up.
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
