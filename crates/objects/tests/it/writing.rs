//! Files become objects as a whole or not at all, and nothing is left of stopped uploads.
#![allow(clippy::unwrap_used, reason = "tests may unwrap")]

use std::{cell::Cell, fs, path::PathBuf};

use crate::support::{
    bucket,
    request::Request,
    server::{Fault, Server, first},
    told,
};
use corniche_objects::{Bucket, ObjectError, Upload};
use corniche_store::Existing;
use corniche_testing::Random;
use tempfile::TempDir;

/// Sizes of files that are sent in one request, and in three parts.
const SIZES: [usize; 2] = [30_000, 20 << 20];

struct Sent {
    server: Server,
    bucket: Bucket,
    folder: TempDir,
    file: PathBuf,
    bytes: Vec<u8>,
}

impl Sent {
    fn new(size: usize) -> Self {
        let mut random = Random::new(11);
        let bytes: Vec<u8> = (0..size).map(|_| random.bits() as u8).collect();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("package");
        fs::write(&file, &bytes).unwrap();
        let server = Server::start();
        let bucket = bucket(&server);
        Self { server, bucket, folder, file, bytes }
    }

    fn upload(&self, existing: Existing) -> Result<u64, ObjectError> {
        self.upload_unless(existing, &|| false)
    }

    fn upload_unless(
        &self,
        existing: Existing,
        should_stop: &dyn Fn() -> bool,
    ) -> Result<u64, ObjectError> {
        self.bucket.upload(&Upload { file: &self.file, key: "package", existing, should_stop })
    }

    /// Checks that the object equals the file, and that nothing else is left.
    fn check_whole(&self) {
        assert!(self.server.content("package") == Some(self.bytes.clone()));
        self.check_clean();
    }

    fn check_clean(&self) {
        assert_eq!(self.server.state().uploads.len(), 0, "an upload is left");
        assert_eq!(fs::read_dir(self.folder.path()).unwrap().count(), 1, "a note is left");
    }
}

fn is_end(request: &Request) -> bool {
    let ends_upload = request.method == "POST" && request.query.contains_key("uploadId");
    ends_upload || request.method == "PUT" && !request.query.contains_key("uploadId")
}

#[test]
fn a_small_object_is_created_once() {
    let server = Server::start();
    let bucket = bucket(&server);
    assert!(bucket.create("plan.json", b"{}".to_vec()).unwrap());
    assert!(!bucket.create("plan.json", b"other".to_vec()).unwrap());
    assert_eq!(server.content("plan.json").unwrap(), b"{}");
}

#[test]
fn a_file_is_sent_as_a_whole_in_one_request_or_in_parts() {
    for (size, requests) in SIZES.into_iter().zip([2, 6]) {
        let sent = Sent::new(size);
        assert_eq!(sent.upload(Existing::Keep).unwrap(), size as u64);
        sent.check_whole();
        assert_eq!(sent.server.take_log().len(), requests);
    }
}

/// The object may also appear between the first check and the end of the upload.
#[test]
fn an_object_that_is_there_is_kept_or_replaced_as_asked() {
    for size in SIZES {
        let sent = Sent::new(size);
        sent.server.put("package", "another's");
        let error = sent.upload(Existing::Keep).unwrap_err();
        assert!(matches!(error, ObjectError::Exists { .. }), "{}", told(&error));
        assert_eq!(sent.server.content("package").unwrap(), b"another's");
        sent.check_clean();
        sent.upload(Existing::Replace).unwrap();
        sent.check_whole();
    }
}

#[test]
fn sending_goes_on_after_what_fails_for_a_moment() {
    for size in SIZES {
        for fault in [Fault::Error(503, "SlowDown", "Slow down."), Fault::Cut] {
            let sent = Sent::new(size);
            sent.server.break_with(first(3, fault, |request| request.method != "HEAD"));
            sent.upload(Existing::Keep).unwrap();
            sent.check_whole();
        }
    }
}

/// The server executed the request, and the answer was lost: the retry then gets the answer that
/// the object exists already, or that the upload does not exist any more.
#[test]
fn an_answer_that_is_lost_is_no_failure() {
    for size in SIZES {
        for existing in [Existing::Keep, Existing::Replace] {
            let sent = Sent::new(size);
            sent.server.break_with(first(1, Fault::Lost, is_end));
            sent.upload(existing).unwrap();
            sent.check_whole();
        }
    }
}

#[test]
fn what_cannot_be_sent_leaves_nothing() {
    for size in SIZES {
        let sent = Sent::new(size);
        sent.server.break_with(|request| {
            is_end(request).then_some(Fault::Error(503, "SlowDown", "Slow down."))
        });
        let error = sent.upload(Existing::Keep).unwrap_err();
        let message = told(&error);
        assert!(message.contains("cannot write s3://maps/package"), "{message}");
        assert!(message.contains("SlowDown"), "{message}");
        assert_eq!(sent.server.content("package"), None);
        sent.check_clean();
        sent.server.repair();
        sent.upload(Existing::Keep).unwrap();
        sent.check_whole();
    }
}

#[test]
fn a_stop_while_parts_are_sent_ends_the_upload() {
    let sent = Sent::new(SIZES[1]);
    let asked = Cell::new(0);
    let stop = || {
        asked.set(asked.get() + 1);
        asked.get() > 1
    };
    let error = sent.upload_unless(Existing::Keep, &stop).unwrap_err();
    assert!(matches!(error, ObjectError::Stopped { .. }), "{}", told(&error));
    assert_eq!(sent.server.content("package"), None);
    sent.check_clean();
}

/// A killed process cannot abort its upload. The next process that sends the file does.
#[test]
fn the_upload_of_a_killed_process_is_ended_by_the_next() {
    let sent = Sent::new(SIZES[1]);
    // The state after a kill: the upload cannot be aborted, so its note stays.
    sent.server.break_with(|request| {
        let is_part = request.method == "PUT" && request.query["partNumber"] == "3";
        (is_part || request.method == "DELETE").then_some(Fault::Error(403, "AccessDenied", "no"))
    });
    sent.upload(Existing::Keep).unwrap_err();
    assert_eq!(sent.server.state().uploads.len(), 1);
    let note = sent.folder.path().join("package.upload");
    let text = fs::read_to_string(&note).unwrap();
    assert!(text.starts_with("package\nupload-"), "{text}");
    sent.server.repair();
    sent.upload(Existing::Keep).unwrap();
    sent.check_whole();
    // A note that is incomplete, or of an upload that is gone, does no harm.
    for text in [text.as_str(), "package\nupl", ""] {
        fs::write(&note, text).unwrap();
        sent.upload(Existing::Replace).unwrap();
        assert!(sent.server.content("package") == Some(sent.bytes.clone()), "{text:?}");
    }
}

/// A server that confirms an upload, but has stored nothing or only a part.
#[test]
fn what_is_said_to_be_stored_is_looked_for() {
    let lies = [
        (None, "it does not exist"),
        (Some(0), "it has 0 bytes"),
        (Some(20_000), "it has 20000 bytes"),
    ];
    for size in SIZES {
        for existing in [Existing::Keep, Existing::Replace] {
            for (left, said) in lies {
                let sent = Sent::new(size);
                sent.server
                    .break_with(move |request| is_end(request).then_some(Fault::Forgotten(left)));
                let told = told(&sent.upload(existing).unwrap_err());
                assert!(
                    told.contains("confirmed the upload, but") && told.contains(said),
                    "{told}"
                );
                sent.check_clean();
            }
        }
    }
}
