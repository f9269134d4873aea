//! What was read: names, sizes, hashes.

use std::{
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
};

use corniche_tileset::InputRecord;
use sha2::{Digest, Sha256};

use super::package::hex;
use crate::{BuildError, BuildSettings, Observer, Stage};

/// Hashes every input file.
pub(crate) fn hash(
    settings: &BuildSettings,
    observer: &dyn Observer,
) -> Result<Vec<InputRecord>, BuildError> {
    let files = settings
        .dem
        .iter()
        .map(|path| ("dem", path))
        .chain(settings.osm.iter().map(|path| ("osm", path)));
    observer.begin(Stage::Hash, Some(files.clone().count() as u64));
    let mut inputs = Vec::new();
    for (kind, path) in files {
        if observer.is_cancelled() {
            return Err(BuildError::Interrupted);
        }
        inputs.push(record(kind, path, observer)?);
        observer.advance(Stage::Hash, 1);
    }
    observer.end(Stage::Hash);
    Ok(inputs)
}

/// The file that holds an input, and the input's name without folders.
///
/// They differ for a raster inside a container, as GDAL names it (`GPKG:dem.gpkg:heights`, `NETCDF:"dem.nc":Band1`).
fn named(path: &Path) -> (PathBuf, String) {
    let file_name = |path: &Path| {
        path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    };
    let text = path.to_string_lossy();
    let container = (!path.exists())
        .then(|| text.split(':').map(|part| part.trim_matches('"')))
        .and_then(|mut parts| parts.find(|part| Path::new(part).is_file()));
    match container {
        Some(container) => {
            let short = file_name(Path::new(container));
            (PathBuf::from(container), text.replace(container, &short))
        }
        None => (path.to_path_buf(), file_name(path)),
    }
}

/// Name, size and hash of one file.
pub(crate) fn record(
    kind: &str,
    path: &Path,
    observer: &dyn Observer,
) -> Result<InputRecord, BuildError> {
    let (path, name) = &named(path);
    let name = name.clone();
    // By text: `Path::starts_with` compares whole names, and they go on, as in /vsizip/ and /vsicurl/.
    if !path.exists() && path.to_string_lossy().starts_with("/vsi") {
        // A name that only GDAL understands (inside an archive, on a server) has no bytes of its own to hash.
        return Ok(InputRecord {
            kind: kind.to_owned(),
            name,
            bytes: 0,
            sha256: "not hashed: virtual".to_owned(),
        });
    }
    let failed = |source: io::Error| BuildError::Input { path: path.clone(), source };
    let mut file = File::open(path).map_err(failed)?;
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; 1 << 20];
    let mut bytes = 0;
    loop {
        if observer.is_cancelled() {
            return Err(BuildError::Interrupted);
        }
        match file.read(&mut buffer) {
            Ok(0) => break,
            Ok(read) => {
                hasher.update(&buffer[..read]);
                bytes += read as u64;
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(failed(error)),
        }
    }
    Ok(InputRecord { kind: kind.to_owned(), name, bytes, sha256: hex(&hasher.finalize()) })
}
