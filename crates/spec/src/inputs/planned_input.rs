//! An input file as it was when the plan was made, and how it has changed since.

use serde::{Deserialize, Serialize};

/// An input as it was when the plan was made.
///
/// A change of any of these values makes another plan. Of two files with the same path, size and time the content is taken to be
/// the same: so do `make` and `rsync`. The path counts, because archives give many files the same time, and raw rasters have
/// the same size: a file of the same name in another folder may be another release of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedInput {
    /// "dem", "dem-part" or "osm", as in a package's manifest.
    pub kind: String,
    /// Name without folders.
    pub name: String,
    /// Where it is: the name it was given by, its path made absolute, links not followed.
    pub path: String,
    /// Size; of a file in an archive, of the archive; of a folder 0.
    pub bytes: u64,
    /// When it was written last, nanoseconds after the start of 1970; `None` for files on a server.
    pub modified_ns: Option<i64>,
    /// The `ETag` of a file on a server, if the server gives one.
    pub etag: Option<String>,
}

impl PlannedInput {
    /// What changed from `earlier`, the same input in another plan, in words; `None` if nothing did.
    #[must_use]
    pub fn change_since(&self, earlier: &Self) -> Option<String> {
        if self == earlier {
            return None;
        }
        let mut said = Vec::new();
        if self.bytes != earlier.bytes {
            said.push(format!("it had {} bytes and has {}", earlier.bytes, self.bytes));
        }
        match (earlier.modified_ns, self.modified_ns) {
            (Some(then), Some(now)) if then < now => {
                said.push(format!("it was written {} later", span(now.saturating_sub(then))));
            }
            (Some(then), Some(now)) if then > now => {
                said.push(format!("its time is {} earlier", span(then.saturating_sub(now))));
            }
            (then, now) if then != now => said.push("its time is another one".to_owned()),
            _ => {}
        }
        if self.etag != earlier.etag {
            let text = |etag: &Option<String>| etag.clone().unwrap_or_else(|| "none".to_owned());
            said.push(format!("its ETag was {} and is {}", text(&earlier.etag), text(&self.etag)));
        }
        Some(said.join(", "))
    }
}

/// A time between two others, in words.
fn span(nanoseconds: i64) -> String {
    const UNITS: [(f64, &str); 3] = [(86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    let seconds = nanoseconds as f64 / 1e9;
    let unit = UNITS.iter().find(|(length, _)| seconds >= 2.0 * length);
    unit.map_or_else(
        || format!("{seconds:.3} s"),
        |(length, name)| format!("{:.1} {name}", seconds / length),
    )
}
