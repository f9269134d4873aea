//! Shared parts of the tests of object storage: a small S3 server that misbehaves on request.
#![allow(clippy::unwrap_used, reason = "each test file uses some of it; tests may unwrap")]

pub(crate) mod request;
pub(crate) mod server;

use std::time::Duration;

use corniche_objects::{Bucket, ObjectError, Retries, Storage, StorageSettings};
use server::Server;

/// The secret, which no message may contain.
pub(crate) const SECRET: &str = "do-not-tell-0123456789";
/// The number of retries.
pub(crate) const RETRIES: usize = 4;

pub(crate) fn settings(server: &Server) -> StorageSettings {
    let variables = [
        ("AWS_ENDPOINT_URL", server.url().as_str()),
        ("AWS_ACCESS_KEY_ID", "tester"),
        ("AWS_SECRET_ACCESS_KEY", SECRET),
        ("AWS_REGION", "eu-central-1"),
    ]
    .map(|(name, value)| (name.to_owned(), value.to_owned()));
    let pause = Duration::from_millis(2);
    let retries = Retries { count: RETRIES, first_pause: pause, longest_pause: pause * 2 };
    StorageSettings { variables: variables.into(), retries }
}

pub(crate) fn storage(server: &Server) -> Storage {
    Storage::new(settings(server)).unwrap()
}

/// The bucket of the server.
pub(crate) fn bucket(server: &Server) -> Bucket {
    storage(server).bucket("maps").unwrap()
}

/// The message of an error, which must not contain the secret.
pub(crate) fn told(error: &ObjectError) -> String {
    let told = error.told();
    assert!(!told.contains(SECRET), "{told}");
    assert!(!format!("{error:?}").contains(SECRET), "{error:?}");
    told
}
