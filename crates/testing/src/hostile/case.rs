//! A hostile package, and the expected outcome of reading it.

/// The expected outcome of reading a package.
#[derive(Debug, Clone, Copy)]
pub enum ReadOutcome {
    /// An error whose text contains this text.
    Refused(&'static str),
    /// The package is read completely.
    Read,
}

/// A package, the expected outcome of reading it, and the memory that this may take in addition to
/// the package's bytes.
#[derive(Debug)]
#[expect(missing_docs, reason = "the names say what they are")]
pub struct Case {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    pub outcome: ReadOutcome,
    pub limit_mib: usize,
}

/// Returns a case like most: an error long before anything large is read.
pub(crate) fn refused(name: &'static str, bytes: Vec<u8>, reason: &'static str) -> Case {
    Case { name, bytes, outcome: ReadOutcome::Refused(reason), limit_mib: 4 }
}
