//! The limit of files that the program may have open at once.

/// Raises the limit of open files (`ulimit -n`) as far as the user may. Every sealed part of a
/// store is an open file while the store is read, and the usual limit of 1024 is only so low for
/// the sake of old programs that use `select`.
///
/// If this fails, the limit stays as it is: the error of a later open explains what to do.
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
