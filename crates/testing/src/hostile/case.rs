//! A hostile package, and what must come of it.

/// What must come of reading a package.
#[derive(Debug, Clone, Copy)]
pub enum Outcome {
    /// An error whose text has this in it.
    Refused(&'static str),
    /// It is read to its end.
    Read,
}

/// A package, what must come of reading it, and the memory that this may take beyond its own bytes.
#[derive(Debug)]
#[expect(missing_docs, reason = "the names say what they are")]
pub struct Case {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    pub outcome: Outcome,
    pub limit_mib: usize,
}

/// Most cases: an error long before anything large.
pub(crate) fn refused(name: &'static str, bytes: Vec<u8>, reason: &'static str) -> Case {
    Case { name, bytes, outcome: Outcome::Refused(reason), limit_mib: 4 }
}
