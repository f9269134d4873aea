//! `corniche serve`: shows packages in web browsers, with a small web server or as files for
//! another one.

mod browser;
mod package_file;
mod page;
mod page_files;
mod shown;
mod site;

use std::{
    borrow::Cow,
    net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr},
    path::Path,
    sync::Arc,
};

use corniche_serve::{Answered, FileContent, Readers, Routes, Server, ServerWatch};
use corniche_store::folder_of;

use self::{
    package_file::PackageFile,
    page::PageFile,
    shown::{LIST, Shown},
};
use crate::{
    args::ServeArgs,
    failure::{CommandFailure, Result},
    interrupt, messages,
    output::existing_of,
    table::bytes,
};

pub(crate) fn run(args: &ServeArgs) -> Result<()> {
    let page = page::load(args.page.as_deref())?;
    let packages = shown::open(&args.packages, args.layers.as_deref())?;
    match &args.site {
        Some(folder) => write_site(args, folder, &page, &packages),
        None => serve(args, page, &packages),
    }
}

fn write_site(
    args: &ServeArgs,
    folder: &Path,
    page: &[PageFile],
    packages: &[Shown],
) -> Result<()> {
    refuse_inside_page(folder, args.page.as_deref())?;
    let files = packages.iter().map(|package| package.file.as_path());
    let used: Vec<&Path> = files.chain(args.page.as_deref()).collect();
    let size = site::write(folder, existing_of(args.overwrite), page, packages, &used)?;
    note!(
        "{}: {} of the page, {}, {}; any web server with support for range requests can serve it",
        folder.display(),
        counted(page.len(), "file"),
        counted(packages.len(), "package"),
        bytes(size)
    );
    Ok(())
}

/// Rejects a site inside the folder of the page: the next site would include it in the page.
fn refuse_inside_page(site: &Path, page: Option<&Path>) -> Result<()> {
    let place = |path: &Path| path.canonicalize().ok();
    let parent = place(folder_of(site));
    match (parent, page.and_then(place)) {
        (Some(parent), Some(page)) if parent.starts_with(&page) => Err(unusable!(
            "cannot write {site:?}: it would be inside the folder of the page, {page:?}; choose a folder outside it"
        )),
        _ => Ok(()),
    }
}

fn serve(args: &ServeArgs, page: Vec<PageFile>, packages: &[Shown]) -> Result<()> {
    let mut routes = Routes::default();
    for PageFile { path, bytes } in page {
        let content = match bytes {
            Cow::Borrowed(bytes) => FileContent::Memory(bytes.into()),
            Cow::Owned(bytes) => FileContent::Memory(bytes.into()),
        };
        routes.add(path, content, Readers::AnyPage);
    }
    // Nobody who does not know the address should see what is served.
    routes.add(LIST, FileContent::Memory(shown::list(packages).into()), Readers::OwnPages);
    for package in packages {
        let file = PackageFile::at_path(&package.file);
        let file = file.map_err(|error| CommandFailure::from(error).about(&package.file))?;
        routes.add(package.path(), FileContent::Disk(Arc::new(file)), Readers::AnyPage);
    }
    let server = Server::bind(&args.address, args.port)?;
    let address = server.address();
    let url = url(&args.address, address);
    messages::answer(&format!("{url}\n"))?;
    note!("serving {}; press Ctrl-C to stop", counted(packages.len(), "package"));
    if !address.ip().is_loopback() {
        note!("the server listens at {address}, so other computers can read these packages");
    }
    // The address already accepts connections: until the server is ready, they wait in its queue.
    if args.open && !browser::open(&url) {
        messages::note("cannot open a browser on this computer; open the address above in one");
    }
    let observer = |Answered { method, path, range, status }: &Answered| {
        let range = range.as_deref().unwrap_or_default();
        tracing::debug!(method, path, range, status, "answered");
    };
    server.serve(
        routes,
        &ServerWatch { is_stopped: &interrupt::is_noted, observer: Arc::new(observer) },
    )?;
    // This is the normal end, so it is not a failure.
    Ok(())
}

/// The URL of the page for a browser.
fn url(named: &str, bound: SocketAddr) -> String {
    let host = match bound.ip() {
        // The address stands for all addresses of this machine, so use the loopback address.
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    let is_number = named.trim_matches(['[', ']']).parse::<IpAddr>().is_ok();
    if is_number {
        format!("http://{}/", SocketAddr::new(host, bound.port()))
    } else {
        format!("http://{named}:{}/", bound.port())
    }
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
#[path = "serve_tests.rs"]
mod tests;
