//! The packages that commands read, from files and from web servers.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use corniche_export::with_vertical_crs;
use corniche_remote::{HttpSettings, HttpSource, PackagePlace, Requests, Web};
use corniche_tileset::FilePackage;
use corniche_viewer::tiles::PackageSource;

use crate::{args::DatumArg, exit::ExitCode, failure::Failure};

/// What asks web servers, once it is needed.
static WEB: OnceLock<Web> = OnceLock::new();
/// What was opened on web servers: a package that is opened again has what was read of it.
static SOURCES: Mutex<Vec<Arc<HttpSource>>> = Mutex::new(Vec::new());

/// Opens a package.
pub(crate) fn open(place: &PackagePlace) -> Result<FilePackage, Failure> {
    let PackagePlace::Address(address) = place else {
        return Ok(corniche_spec::open_package(place.name())?);
    };
    let mut sources = SOURCES.lock().unwrap_or_else(PoisonError::into_inner);
    let known = sources.iter().find(|source| source.address() == address).cloned();
    let source = if let Some(known) = known {
        known
    } else {
        let web = if let Some(web) = WEB.get() {
            web
        } else {
            let web = Web::new(HttpSettings::default());
            let web = web.map_err(|error| Failure::new(ExitCode::Failed, error))?;
            WEB.get_or_init(|| web)
        };
        let source = Arc::new(web.source(address));
        sources.push(Arc::clone(&source));
        source
    };
    drop(sources);
    Ok(FilePackage::of_source(place.name(), place.file_name(), source)?)
}

/// Opens a package to export it with heights of the datum that is said, if one is.
pub(crate) fn open_with_datum(
    place: &PackagePlace,
    said: &DatumArg,
) -> Result<FilePackage, Failure> {
    let package = open(place)?;
    match &said.dem_vertical_crs {
        None => Ok(package),
        Some(text) => Ok(with_vertical_crs(package, text)?),
    }
}

/// Opens a package to draw it.
pub(crate) fn source(place: &PackagePlace) -> Result<PackageSource, Failure> {
    Ok(PackageSource::of_file(open(place)?)?)
}

/// Tells, with `-v`, what was asked of web servers.
pub(crate) fn tell_requests() {
    for source in SOURCES.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        let Requests { count, received_bytes } = source.requests();
        let package_bytes = source.known_length();
        tracing::debug!(address = %source.address(), requests = count, received_bytes, package_bytes, "read from a web server");
    }
}
