//! The list that `corniche build --defects` writes: one line for every defect of the extract and every road lost.

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
    failure::Failure,
    output::{self, Existing, Output},
};

/// The columns. `count` is the number of points, pieces or crossings concerned; `detail` holds further facts, if there are any.
const HEADER: &str = "reason,object,id,count,length_m,detail\n";

/// A list that is being written.
pub(crate) struct DefectList {
    target: PathBuf,
    /// The first failure ends the writing and is reported at the end; the build goes on.
    file: Mutex<io::Result<Output>>,
}

impl DefectList {
    /// Begins a list at `target`, which is none of `others`.
    pub(crate) fn create(
        target: &Path,
        existing: Existing,
        others: &[&Path],
    ) -> Result<Self, Failure> {
        let mut output = Output::create(target, existing, others)?;
        let begun = output.write_all(HEADER.as_bytes()).map(|()| output);
        Ok(Self { target: target.to_path_buf(), file: Mutex::new(begun) })
    }

    /// Adds a line, unless nothing is wrong with the extract.
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

    /// Puts the list in its place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
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

/// A text as CSV wants it (RFC 4180, section 2): quoted where it holds a comma or a quote. Line breaks and control characters are written as in JSON, and spreadsheets do not take it for a
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
