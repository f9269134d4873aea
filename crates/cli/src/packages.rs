//! The packages that commands read, from files and from web servers.

use std::sync::{Arc, Mutex};

use corniche_export::with_vertical_crs;
use corniche_remote::{HttpSettings, HttpSource, PackagePlace, ServerRequests, Web};
use corniche_tileset::FilePackage;
use corniche_viewer::tiles::PackageSource;
use corniche_work::locked;

use crate::{
    args::DatumArg,
    exit::ExitCode,
    failure::{CommandFailure, Result},
};

/// The HTTP client, once it is needed, and the sources that it has opened: a package that is opened
/// again reuses the cached data.
static OPENED: Mutex<(Option<Web>, Vec<Arc<HttpSource>>)> = Mutex::new((None, Vec::new()));

/// Opens a package.
pub(crate) fn open(place: &PackagePlace) -> Result<FilePackage> {
    let PackagePlace::Address(address) = place else {
        return Ok(corniche_spec::open_package(place.name())?);
    };
    let mut opened = locked(&OPENED);
    let (web, sources) = &mut *opened;
    let known = sources.iter().find(|source| source.address() == address).cloned();
    let source = if let Some(known) = known {
        known
    } else {
        let web = match web {
            Some(web) => web,
            None => web.insert(
                Web::new(HttpSettings::default())
                    .map_err(|error| CommandFailure::new(ExitCode::Failed, error))?,
            ),
        };
        let source = Arc::new(web.source(address));
        sources.push(Arc::clone(&source));
        source
    };
    drop(opened);
    Ok(FilePackage::of_source(place.name(), place.file_name(), source)?)
}

/// Opens a package for an export with heights; `--dem-vertical-crs` sets a missing datum.
pub(crate) fn open_with_datum(place: &PackagePlace, said: &DatumArg) -> Result<FilePackage> {
    let package = open(place)?;
    match &said.dem_vertical_crs {
        None => Ok(package),
        Some(text) => Ok(with_vertical_crs(package, text)?),
    }
}

/// Opens a package to draw it.
pub(crate) fn source(place: &PackagePlace) -> Result<PackageSource> {
    Ok(PackageSource::of_file(open(place)?)?)
}

/// Reports the requests to web servers, with `-v`.
pub(crate) fn tell_requests() {
    for source in &locked(&OPENED).1 {
        let ServerRequests { count, received_bytes } = source.requests();
        let package_bytes = source.known_length();
        tracing::debug!(address = %source.address(), requests = count, received_bytes, package_bytes, "read from a web server");
    }
}
