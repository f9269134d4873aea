//! `corniche serve`: packages in web browsers, by a small web server, or by the files for another one.

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

use corniche_serve::{Answered, Content, Readers, Routes, Server, Watch};
use corniche_store::folder_of;

use self::{
    package_file::PackageFile,
    page::PageFile,
    shown::{LIST, Shown},
};
use crate::{
    args::ServeArgs, exit::ExitCode, failure::Failure, interrupt, messages, output::existing_of,
    table::bytes,
};

pub(crate) fn run(args: &ServeArgs) -> Result<ExitCode, Failure> {
    let page = page::load(args.page.as_deref())?;
    let packages = shown::open(&args.packages)?;
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
) -> Result<ExitCode, Failure> {
    refuse_inside_page(folder, args.page.as_deref())?;
    let files = packages.iter().map(|package| package.file.as_path());
    let used: Vec<&Path> = files.chain(args.page.as_deref()).collect();
    let size = site::write(folder, existing_of(args.overwrite), page, packages, &used)?;
    messages::note(&format!(
        "{}: {} of the page, {}, {}; any web server that knows range requests can show it",
        folder.display(),
        counted(page.len(), "file"),
        counted(packages.len(), "package"),
        bytes(size),
    ));
    Ok(ExitCode::Done)
}

/// Refuses a site in the folder of the page, where the next one would take it for a part of the page.
fn refuse_inside_page(site: &Path, page: Option<&Path>) -> Result<(), Failure> {
    let place = |path: &Path| path.canonicalize().ok();
    let parent = place(folder_of(site));
    match (parent, page.and_then(place)) {
        (Some(parent), Some(page)) if parent.starts_with(&page) => Err(Failure::unusable(format!(
            "cannot write {}: it would be in the folder of the page, {}; give a folder beside it",
            site.display(),
            page.display()
        ))),
        _ => Ok(()),
    }
}

fn serve(args: &ServeArgs, page: Vec<PageFile>, packages: &[Shown]) -> Result<ExitCode, Failure> {
    let mut routes = Routes::default();
    for PageFile { path, bytes } in page {
        let content = match bytes {
            Cow::Borrowed(bytes) => Content::Memory(bytes.into()),
            Cow::Owned(bytes) => Content::Memory(bytes.into()),
        };
        routes.add(path, content, Readers::AnyPage);
    }
    // What is shown here is nobody's business who does not know it.
    routes.add(LIST, Content::Memory(shown::list(packages).into()), Readers::OwnPages);
    for package in packages {
        let file = PackageFile::of(&package.file);
        let file = file.map_err(|error| Failure::from(error).about(&package.file))?;
        routes.add(package.path(), Content::Disk(Arc::new(file)), Readers::AnyPage);
    }
    let server = Server::bind(&args.address, args.port)?;
    let address = server.address();
    let url = url(&args.address, address);
    messages::answer(&format!("{url}\n"))?;
    messages::note(&format!("serves {}; Ctrl-C ends it", counted(packages.len(), "package")));
    if !address.ip().is_loopback() {
        messages::note(&format!(
            "it listens at {address}, so other computers can read these packages"
        ));
    }
    // The address answers already: until the server is ready, connections wait in its queue.
    if args.open && !browser::open(&url) {
        messages::note("no browser could be opened here; open the address above in one");
    }
    let observer = |Answered { method, path, range, status }: &Answered| {
        let range = range.as_deref().unwrap_or_default();
        tracing::debug!(method, path, range, status, "answered");
    };
    server
        .serve(routes, &Watch { is_stopped: &interrupt::is_noted, observer: Arc::new(observer) })?;
    // That is how it is meant to end, so it is no failure.
    Ok(ExitCode::Done)
}

/// Where a browser finds the page.
fn url(named: &str, bound: SocketAddr) -> String {
    let host = match bound.ip() {
        // All addresses of this machine; this one is among them.
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
