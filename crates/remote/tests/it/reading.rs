//! Reading from a server that behaves, and the number of requests.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{sync::Arc, thread};

use crate::support::{Server, settings, source};
use corniche_remote::{HttpAddress, PackagePlace, ServerRequests, Web};
use corniche_testing::Random;
use corniche_tileset::{BlockingSource as _, FilePackage};

#[test]
fn any_bytes_come_as_they_are_on_the_server() {
    for bytes in [1, 100, 65_535, 65_536, 65_537, 1_000_000] {
        let server = Server::start(bytes);
        let file = server.state().bytes.clone();
        let source = source(&server.url());
        assert_eq!(source.length().unwrap(), bytes as u64);
        let mut random = Random::new(bytes as u64);
        for _ in 0..200 {
            let from = random.below(bytes as i64 + 1) as usize;
            let length = random.below((bytes - from) as i64 + 1) as usize;
            let read = source.read(from as u64, length).unwrap();
            assert_eq!(read, file[from..][..length], "{from} + {length}");
        }
        assert_eq!(source.read(0, bytes).unwrap(), file);
        let beyond = source.read(1, bytes).unwrap_err().to_string();
        assert!(beyond.contains(&format!("only {bytes} bytes")), "{beyond}");
        let blocks = bytes.div_ceil(65_536) as u64;
        let ServerRequests { count, received_bytes } = source.requests();
        assert!(count <= blocks, "{count} requests for {blocks} blocks");
        assert_eq!(received_bytes, bytes as u64, "each byte once");
    }
}

#[test]
fn the_first_request_is_of_64_kib_and_tells_the_length() {
    let server = Server::start(1_000_000);
    let source = source(&server.url());
    assert_eq!(source.known_length(), None);
    assert_eq!(source.length().unwrap(), 1_000_000);
    source.read(0, 16_384).unwrap();
    source.read(16_384, 3_000).unwrap();
    assert_eq!(server.take_ranges(), ["0-65535"]);
    assert_eq!(source.known_length(), Some(1_000_000));
}

#[test]
fn neighbouring_reads_share_requests() {
    let server = Server::start(20_000_000);
    let source = source(&server.url());
    for at in 0..200_u64 {
        source.read(at * 100_000, 90_000).unwrap();
    }
    let ServerRequests { count, received_bytes } = source.requests();
    // 1, 2, 4 … 64 blocks, then 64 each time: 7 + 3.
    assert_eq!((count, server.take_log().len()), (10, 10));
    assert!(received_bytes <= 20_000_000, "nothing twice");
}

#[test]
fn an_empty_file_is_no_package() {
    let server = Server::start(0);
    let address = HttpAddress::parse(&server.url()).unwrap().unwrap();
    let error = Web::new(settings()).unwrap().open(&PackagePlace::Address(address)).unwrap_err();
    let told = format!("{error}: {}", std::error::Error::source(&error).unwrap());
    assert!(told.contains(&server.url()) && told.contains("not a PMTiles file"), "{told}");
}

/// Threads, a file and an address return the same tiles.
#[test]
fn a_package_is_the_same_by_its_address() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, corniche_testing::package::written()).unwrap();
    let server = Server::with(std::fs::read(&path).unwrap());
    let web = Web::new(settings()).unwrap();
    let place = PackagePlace::parse(server.url().into()).unwrap();
    let [here, there] =
        [PackagePlace::File(path), place].map(|place| Arc::new(web.open(&place).unwrap()));
    assert_eq!(here.tile_ids().unwrap(), there.tile_ids().unwrap());
    assert_eq!(here.bytes().unwrap(), there.bytes().unwrap());
    let all = |package: &FilePackage| {
        let ids = package.tile_ids().unwrap();
        ids.into_iter().map(|id| package.tile(id).unwrap().unwrap()).collect::<Vec<_>>()
    };
    let wanted = all(&here);
    let readers: Vec<_> = (0..4)
        .map(|_| {
            let there = Arc::clone(&there);
            thread::spawn(move || all(&there))
        })
        .collect();
    for reader in readers {
        assert_eq!(reader.join().unwrap(), wanted);
    }
    assert!(there.failed_read().is_none());
    assert_eq!(server.take_log().len(), 1, "it fits into one block");
    assert_eq!(there.path().to_str().unwrap(), server.url());
}
