//! How many files the program may have open at once.

/// Raises the limit of open files (`ulimit -n`) as far as the system lets the user. Every sealed part of a store is an open file while the
/// store is read, and the usual limit, 1024, is so low only for old programs that use `select`.
///
/// If that fails the limit stays as it is: an error that comes from it says what to do.
pub(crate) fn allow_many() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
        let limit = getrlimit(Resource::Nofile);
        if limit.current != limit.maximum {
            let _ = setrlimit(Resource::Nofile, Rlimit { current: limit.maximum, ..limit });
        }
    }
}
