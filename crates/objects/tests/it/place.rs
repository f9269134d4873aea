//! A store of sealed parts in object storage: bound once, filled with whole parts, read by ranges.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{fs, path::Path, sync::Arc, time::Duration};

use crate::support::{
    request::Request,
    server::{Fault, Server, first},
    storage,
};
use corniche_objects::{ObjectAddress, ObjectPlace, block_cache};
use corniche_store::{
    ArtifactKey, Artifacts as _, Hold, LocalStore, OwnPart, PartsPlace as _, Publish as _,
    SealedParts, StoreError, StoredPlan, SystemDisk,
};
use corniche_testing::Random;

fn plan() -> StoredPlan {
    StoredPlan { hash: [7; 32], bytes: b"{\"cell\": 30}".to_vec() }
}

fn other_plan() -> StoredPlan {
    StoredPlan { hash: [8; 32], bytes: b"{\"cell\": 40}".to_vec() }
}

fn place(server: &Server) -> ObjectPlace {
    let address = ObjectAddress::parse("s3://maps/utah").unwrap().unwrap();
    ObjectPlace::new(&storage(server), &address, &Arc::new(block_cache(4 << 20))).unwrap()
}

fn artifact(item: u64) -> Vec<u8> {
    let mut random = Random::new(item);
    (0..random.below(4000)).map(|_| random.bits() as u8).collect()
}

fn key(item: u64) -> ArtifactKey {
    ArtifactKey { kind: 3, item }
}

fn open(
    folder: &Path,
    name: &str,
    place: &ObjectPlace,
    is_needed: &dyn Fn(&str) -> bool,
) -> Result<LocalStore, StoreError> {
    let plan = plan();
    let own = OwnPart { folder, name, plan: &plan, interval: Duration::MAX };
    let sealed = SealedParts { places: &[place], is_needed };
    LocalStore::open_places(Arc::new(SystemDisk), sealed, &plan.hash, Some((own, Hold::Alone)))
}

/// Writes a part with these items, in this order, and uploads it.
fn make(
    place: &ObjectPlace,
    name: &str,
    items: impl IntoIterator<Item = u64>,
) -> Result<Option<String>, StoreError> {
    let folder = tempfile::tempdir().unwrap();
    let work = folder.path().join("work");
    let store = open(&work, name, place, &|_| true)?;
    for item in items {
        store.put(key(item), &artifact(item))?;
    }
    let sent = store.publish(place, &|| false)?;
    nothing_is_left(&work);
    Ok(sent.map(|path| path.display().to_string()))
}

/// Checks that nothing of a part is left in the work folder once it is uploaded.
fn nothing_is_left(work: &Path) {
    let parts = fs::read_dir(work.join("parts"));
    assert_eq!(parts.map_or(0, Iterator::count), 0, "what is sent is removed");
    assert!(LocalStore::discard(Arc::new(SystemDisk), work).unwrap().is_empty());
    assert!(!work.exists());
}

/// S3 answers 409 to one of two concurrent writers of an object. This answer says nothing about the
/// existing object.
#[test]
fn what_is_refused_because_another_writes_at_that_moment_is_written_again() {
    let server = Server::start();
    let place = place(&server);
    let fault = Fault::Error(409, "ConditionalRequestConflict", "try again");
    server.break_with(first(3, fault, |request| request.method == "PUT"));
    assert_eq!(place.bind(&plan()).unwrap(), plan());
    assert!(make(&place, "heights", 0..3).unwrap().is_some());
}

/// On other servers, two writers of the same part would overwrite each other's.
#[test]
fn a_server_that_writes_over_what_is_to_be_kept_is_refused() {
    let server = Server::start();
    let is_put = |request: &Request| request.method == "PUT";
    server.break_with(move |request| is_put(request).then_some(Fault::Ignore("if-none-match")));
    let error = place(&server).bind(&plan()).unwrap_err();
    assert!(error.is_unusable(), "{error}");
    let message = error.to_string();
    assert!(message.contains("If-None-Match") && message.contains("utah/plan.json"), "{message}");
    assert_eq!(server.content("utah/store"), None);
}

#[test]
fn a_prefix_is_bound_to_the_plan_that_came_first() {
    let server = Server::start();
    assert_eq!(place(&server).stored_plan().unwrap(), None);
    assert_eq!(place(&server).bind(&plan()).unwrap(), plan());
    assert_eq!(place(&server).bind(&plan()).unwrap(), plan());
    // A process with another plan gets the existing plan in the error.
    assert_eq!(place(&server).bind(&other_plan()).unwrap(), plan());
    assert_eq!(place(&server).stored_plan().unwrap(), Some(plan()));
    assert_eq!(server.content("utah/plan.json").unwrap(), plan().bytes);
    // The first process was killed between the two objects.
    server.state().objects.remove("maps/utah/store");
    assert_eq!(place(&server).stored_plan().unwrap(), None);
    assert_eq!(place(&server).bind(&other_plan()).unwrap().bytes, plan().bytes);
    assert_eq!(place(&server).stored_plan().unwrap(), None);
    assert_eq!(place(&server).bind(&plan()).unwrap(), plan());
    assert_eq!(place(&server).stored_plan().unwrap(), Some(plan()));
}

#[test]
fn a_prefix_that_holds_something_else_is_left_alone() {
    let server = Server::start();
    for name in ["utah/photo.jpg", "utah/old/photo.jpg"] {
        server.put(name, "dear to someone");
        let error = place(&server).bind(&plan()).unwrap_err();
        assert!(matches!(error, StoreError::NotAStore { .. }), "{error}");
        assert!(error.to_string().contains("s3://maps/utah"), "{error}");
        server.state().objects.remove(&format!("maps/{name}"));
    }
    // A prefix with the same beginning is a different store.
    server.put("utah-2/photo.jpg", "dear to someone");
    assert_eq!(place(&server).bind(&plan()).unwrap(), plan());
    // A corrupt header is reported.
    server.put("utah/store", "odd");
    let error = place(&server).stored_plan().unwrap_err();
    assert!(matches!(error, StoreError::Damaged { .. }), "{error}");
}

#[test]
fn parts_are_sent_whole_and_read_where_they_are_needed() {
    let server = Server::start();
    let place = place(&server);
    place.bind(&plan()).unwrap();
    let sent = make(&place, "heights-1-0-0", 0..3000).unwrap().unwrap();
    assert!(sent.starts_with("s3://maps/utah/parts/heights-1-0-0."), "{sent}");
    make(&place, "heights-1-1-0", 3000..3100).unwrap().unwrap();
    // Existing objects are not written again.
    assert_eq!(make(&place, "tiles", 50..80).unwrap(), None);
    assert_eq!(place.parts().unwrap().len(), 2);

    let folder = tempfile::tempdir().unwrap();
    let work = folder.path().join("work");
    server.take_log();
    let store = open(&work, "tiles", &place, &|part| part == "heights-1-1-0").unwrap();
    for item in 3000..3100 {
        assert_eq!(store.get(key(item)).unwrap().unwrap(), artifact(item));
    }
    assert!(!store.has(key(0)) && store.has(key(3099)));
    let log = server.take_log();
    assert!(!log.iter().any(|line| line.contains("heights-1-0-0")), "{log:?}");
    // The requests are: one list, header and list of the part, and its one block.
    assert_eq!(log.len(), 4, "{log:?}");
    drop(store);

    let store = open(&work, "tiles", &place, &|_| true).unwrap();
    let mut random = Random::new(1);
    for _ in 0..500 {
        let item = random.below(3100) as u64;
        assert_eq!(store.get(key(item)).unwrap().unwrap(), artifact(item));
    }
    assert_eq!(store.items(3), (0..3100).collect::<Vec<_>>());
}

/// Both processes computed the same artifacts, in another order, so the files differ and the names
/// do not. The first file is kept.
#[test]
fn a_part_that_is_made_twice_is_one_object() {
    let server = Server::start();
    let place = place(&server);
    place.bind(&plan()).unwrap();
    // Both processes check before either has uploaded anything.
    let folder = tempfile::tempdir().unwrap();
    let stores = [(0..60).collect::<Vec<u64>>(), (0..60).rev().collect()].map(|items| {
        let work = folder.path().join(format!("work-{}", items[0]));
        let store = open(&work, "heights", &place, &|_| true).unwrap();
        for item in items {
            store.put(key(item), &artifact(item)).unwrap();
        }
        store
    });
    let mut contents = Vec::new();
    for store in stores {
        let sent = store.publish(&place, &|| false).unwrap().unwrap();
        let name = sent.display().to_string();
        contents.push(server.content(name.strip_prefix("s3://maps/").unwrap()).unwrap());
    }
    assert_eq!(place.parts().unwrap().len(), 1);
    assert!(contents[0] == contents[1], "the first was replaced");
}

/// The same, if the second process finds out only after its upload: the first one was faster
/// between its check and its upload.
#[test]
fn of_two_that_send_a_part_at_once_the_first_is_kept() {
    let server = Server::start();
    let place = place(&server);
    place.bind(&plan()).unwrap();
    make(&place, "heights", 0..60).unwrap();
    let [(path, object)] = {
        let state = server.state();
        let parts = state.objects.iter().filter(|(path, _)| path.contains("/parts/"));
        parts.map(|(path, object)| (path.clone(), object.clone())).collect::<Vec<_>>()
    }
    .try_into()
    .unwrap();
    server.state().objects.remove(&path);
    let back = (path.clone(), object.clone());
    let own = server.clone();
    server.break_with(first(1, Fault::Cut, move |request| {
        let is_sent = request.method == "PUT";
        if is_sent {
            // The caller holds the lock of the state, so the object comes from a thread.
            let (own, (path, object)) = (own.clone(), back.clone());
            std::thread::spawn(move || own.state().objects.insert(path, object));
            std::thread::sleep(Duration::from_millis(1));
        }
        is_sent
    }));
    make(&place, "heights", (0..60).rev()).unwrap().unwrap();
    let state = server.state();
    assert!(state.objects[&path].etag == object.etag, "the first was replaced");
}

#[test]
fn a_part_that_is_exchanged_or_damaged_is_noticed() {
    let server = Server::start();
    let place = place(&server);
    place.bind(&plan()).unwrap();
    let name = make(&place, "heights", 0..60).unwrap().unwrap();
    let name = name.strip_prefix("s3://maps/").unwrap().to_owned();
    let bytes = server.content(&name).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let store = open(&folder.path().join("a"), "tiles", &place, &|_| true).unwrap();
    server.put(&name, bytes.clone());
    let error = store.get(key(5)).unwrap_err().to_string();
    assert!(error.contains("changed while it was in use") && error.contains(&name), "{error}");
    drop(store);
    // The list of the part is corrupt: the part is not opened.
    let mut damaged = bytes.clone();
    let at = damaged.len() - 100;
    damaged[at] ^= 1;
    server.put(&name, damaged.clone());
    let error = open(&folder.path().join("b"), "tiles", &place, &|_| true).unwrap_err();
    assert!(matches!(error, StoreError::Damaged { .. }), "{error}");
    assert!(error.to_string().contains(&name), "{error}");
    // An artifact is corrupt: it is not returned.
    let mut damaged = bytes;
    damaged[200] ^= 1;
    server.put(&name, damaged);
    let store = open(&folder.path().join("c"), "tiles", &place, &|_| true).unwrap();
    let read = (0..60).map(|item| store.get(key(item)));
    assert_eq!(read.filter(Result::is_err).count(), 1);
}

/// The part was sealed, and then the server or the process went away. The next run computes the
/// same part and only uploads it.
#[test]
fn a_part_that_could_not_be_sent_is_sent_by_the_next_try() {
    let server = Server::start();
    let place = place(&server);
    place.bind(&plan()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let work = folder.path().join("work");
    let store = open(&work, "heights", &place, &|_| true).unwrap();
    for item in 0..60 {
        store.put(key(item), &artifact(item)).unwrap();
    }
    server.break_with(|request| {
        (request.method == "PUT").then_some(Fault::Error(403, "AccessDenied", "read only"))
    });
    let error = store.publish(&place, &|| false).unwrap_err();
    assert!(error.is_unusable() && error.to_string().contains("read only"), "{error}");
    assert_eq!(place.parts().unwrap(), [""; 0]);
    server.repair();
    let store = open(&work, "heights", &place, &|_| true).unwrap();
    assert!((0..60).all(|item| store.has(key(item))), "nothing is made again");
    store.publish(&place, &|| false).unwrap().unwrap();
    assert_eq!(place.parts().unwrap().len(), 1);
    nothing_is_left(&work);
}

#[test]
fn blocks_fit_the_memory() {
    for (limit, block) in [(1 << 20, 256 << 10), (16 << 20, 1 << 20), (1 << 30, 4 << 20)] {
        assert_eq!(block_cache(limit).block_bytes(), block, "{limit}");
    }
}
