//! Errors of layer tables: what is wrong, and where.

use std::fmt;

/// A key, or the number of an entry in a list, counted from 0.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TableStep {
    /// A key of a table.
    Key(String),
    /// An entry of a list.
    Index(usize),
}

/// The position of a value in a table: the keys and numbers that lead to it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TablePath(pub Vec<TableStep>);

impl fmt::Display for TablePath {
    /// Writes the path as `class[2].tags.railway`; keys with other characters are quoted.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, step) in self.0.iter().enumerate() {
            match step {
                TableStep::Index(number) => write!(f, "[{number}]")?,
                TableStep::Key(key) => {
                    f.write_str(if index == 0 { "" } else { "." })?;
                    let is_bare = |c: char| c.is_ascii_alphanumeric() || "_:-".contains(c);
                    if key.chars().all(is_bare) { f.write_str(key)? } else { write!(f, "{key:?}")? }
                }
            }
        }
        Ok(())
    }
}

/// The reason why a form is not a layer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {problem}")]
pub struct LayerTableError {
    /// The value that is wrong.
    pub path: TablePath,
    /// What is wrong with it, and what to do.
    pub problem: String,
}

/// The result of a check; an error has the path from the value that was checked.
pub(crate) type CheckResult = Result<(), LayerTableError>;

/// The error of the value that is being checked.
pub(crate) fn wrong(problem: impl Into<String>) -> LayerTableError {
    LayerTableError { path: TablePath::default(), problem: problem.into() }
}

/// Puts a step in front of the path of an error.
pub(crate) trait ErrorPath: Sized {
    /// Puts the step in front.
    fn within(self, step: TableStep) -> Self;

    /// Puts a key in front.
    fn at(self, key: &str) -> Self {
        self.within(TableStep::Key(key.to_owned()))
    }

    /// Puts the number of an entry in front.
    fn nth(self, index: usize) -> Self {
        self.within(TableStep::Index(index))
    }
}

impl<T> ErrorPath for Result<T, LayerTableError> {
    fn within(self, step: TableStep) -> Self {
        self.map_err(|mut error| {
            error.path.0.insert(0, step);
            error
        })
    }
}
