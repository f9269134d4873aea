//! The list that `corniche build --defects` writes: one line per defect of the extract and per
//! lost road.

use std::{
    fmt::Write as _,
    io::{self, Write as _},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use corniche_export::cell_text;
use corniche_spec::{Defect, span_reason_words};
use corniche_work::locked;

use crate::{
    failure::Result,
    output::{self, Existing, Output},
};

/// The columns. `count` is the number of affected points, pieces or crossings; `detail` has further
/// facts, if any.
const HEADER: &str = "reason,object,id,count,length_m,detail\n";

/// A list that is being written.
pub(crate) struct DefectList {
    target: PathBuf,
    /// The file. The first failure ends the writing and is reported at the end; the build
    /// continues.
    file: Mutex<io::Result<Output>>,
}

impl DefectList {
    /// Begins a list at `target`, which must not be one of `others`.
    pub(crate) fn create(target: &Path, existing: Existing, others: &[&Path]) -> Result<Self> {
        let mut output = Output::create(target, existing, others)?;
        let begun = output.write_all(HEADER.as_bytes()).map(|()| output);
        Ok(Self { target: target.to_path_buf(), file: Mutex::new(begun) })
    }

    /// Adds a line, unless the event is not a defect of the extract.
    pub(crate) fn add(&self, defect: &Defect) {
        if matches!(defect, Defect::Osm(defect) if defect.is_beyond_extract()) {
            return;
        }
        let mut file = locked(&self.file);
        if let Ok(output) = &mut *file
            && let Err(error) = output.write_all(line(defect).as_bytes())
        {
            *file = Err(error);
        }
    }

    /// Moves the complete list to its target.
    pub(crate) fn finish(self) -> Result<()> {
        let file = self.file.into_inner().unwrap_or_else(PoisonError::into_inner);
        file.map_err(|error| output::failed(&self.target, &error))?.finish()
    }
}

fn line(defect: &Defect) -> String {
    let mut line = quoted(&defect.name());
    match defect {
        Defect::Osm(defect) => {
            let (object, id) = defect.object();
            let count = defect.count().map(|count| count.to_string()).unwrap_or_default();
            let detail = quoted(defect.detail().unwrap_or_default());
            let _ = writeln!(line, ",{object},{id},{count},,{detail}");
        }
        Defect::LostRoad { way_id, length_m, is_whole, .. } => {
            let detail = if *is_whole { "the whole road" } else { "a part of it" };
            let _ = writeln!(line, ",way,{way_id},,{length_m:.3},{detail}");
        }
        Defect::Span { way_id, node_id, reason } => {
            let words = span_reason_words(reason);
            let detail = match node_id {
                Some(node_id) => quoted(&format!("node {node_id}: {words}")),
                None => quoted(words),
            };
            let _ = writeln!(line, ",way,{way_id},,,{detail}");
        }
    }
    line
}

/// A text as a CSV field (RFC 4180, section 2): quoted if it contains a comma or a quote. Line
/// breaks and control characters are escaped as in JSON, and spreadsheets do not interpret it as a
/// formula.
pub(crate) fn quoted(text: &str) -> String {
    let text = &*cell_text(text);
    if text.contains([',', '"']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
#[path = "defects_tests.rs"]
mod tests;
