//! An input file as it was when the plan was created, and how it has changed since.

use serde::{Deserialize, Serialize};

/// An input as it was when the plan was created.
///
/// A change of any of these values makes another plan. Two files with the same path, size and time
/// are assumed to have the same content, as `make` and `rsync` assume. The path counts, because
/// archives give many files the same time, and raw rasters have the same size: a file of the same
/// name in another folder may be another release.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedInput {
    /// "dem", "dem-part" or "osm", as in a package's manifest.
    pub kind: String,
    /// Name without folders.
    pub name: String,
    /// Path of the file: the name given by the user, made absolute, without following links.
    pub path: String,
    /// Size in bytes; for a file in an archive, the size of the archive; for a folder, 0.
    pub bytes: u64,
    /// Time of the last modification, nanoseconds since the start of 1970; `None` for files on a
    /// server.
    pub modified_ns: Option<i64>,
    /// The `ETag` of a file on a server, if the server gives one.
    pub etag: Option<String>,
}

impl PlannedInput {
    /// Returns in words what changed from `earlier`, the same input in another plan; `None` if
    /// nothing changed.
    #[must_use]
    pub fn change_since(&self, earlier: &Self) -> Option<String> {
        if self == earlier {
            return None;
        }
        let mut said = Vec::new();
        if self.bytes != earlier.bytes {
            said.push(format!("it had {} bytes and now has {}", earlier.bytes, self.bytes));
        }
        match (earlier.modified_ns, self.modified_ns) {
            (Some(then), Some(now)) if then < now => {
                said.push(format!("it was written {} later", span(now.saturating_sub(then))));
            }
            (Some(then), Some(now)) if then > now => {
                said.push(format!(
                    "its modification time is {} earlier",
                    span(then.saturating_sub(now))
                ));
            }
            (then, now) if then != now => said.push("its modification time has changed".to_owned()),
            _ => {}
        }
        if self.etag != earlier.etag {
            let text = |etag: &Option<String>| etag.clone().unwrap_or_else(|| "none".to_owned());
            said.push(format!(
                "its ETag was {} and now is {}",
                text(&earlier.etag),
                text(&self.etag)
            ));
        }
        Some(said.join(", "))
    }
}

/// The time between two moments, in words.
fn span(nanoseconds: i64) -> String {
    const UNITS: [(f64, &str); 3] = [(86_400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    let seconds = nanoseconds as f64 / 1e9;
    let unit = UNITS.iter().find(|(length, _)| seconds >= 2.0 * length);
    unit.map_or_else(
        || format!("{seconds:.3} s"),
        |(length, name)| format!("{:.1} {name}", seconds / length),
    )
}
