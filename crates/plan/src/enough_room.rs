//! Whether the available memory and disk space are sufficient for a build.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use corniche_spec::machine::{FileSystem, MIN_MEMORY_BYTES, machine_memory_bytes};

use super::{BuildEstimate, MemoryEstimate};
use crate::PlanError;

/// The memory and disk space that a build may use.
pub(crate) struct AvailableSpace {
    /// The limit of `--memory`.
    pub memory_bytes: u64,
    /// The machine's memory; `None` if it is unknown.
    pub machine_bytes: Option<u64>,
    /// The folder and file system of intermediate results.
    pub store: (PathBuf, FileSystem),
    /// The folder and file system of the package.
    pub target: (PathBuf, FileSystem),
}

impl AvailableSpace {
    /// Measures the space on this machine. `held_bytes` is the space that an existing store
    /// occupies: the build continues from it, or deletes it first.
    pub(crate) fn measure(
        memory_bytes: u64,
        [store, target]: [&Path; 2],
        held_bytes: u64,
    ) -> Result<Self, PlanError> {
        let place = |folder: &Path| -> Result<_, PlanError> {
            let failed = |source| PlanError::Target { folder: folder.to_path_buf(), source };
            let there = nearest_folder(folder).map_err(failed)?;
            Ok((folder.to_path_buf(), FileSystem::containing(&there).map_err(failed)?))
        };
        let (mut store, mut target) = (place(store)?, place(target)?);
        if store.1.device == target.1.device {
            target.1.free_bytes = target.1.free_bytes.saturating_add(held_bytes);
        }
        store.1.free_bytes = store.1.free_bytes.saturating_add(held_bytes);
        Ok(Self { memory_bytes, machine_bytes: machine_memory_bytes(), store, target })
    }

    /// Fails if the build needs more than is available.
    pub(crate) fn check(&self, estimate: &BuildEstimate) -> Result<(), PlanError> {
        self.check_memory(estimate)?;
        self.check_disk(estimate)
    }

    fn check_memory(&self, estimate: &BuildEstimate) -> Result<(), PlanError> {
        let need = estimate.memory.least_bytes.max(MIN_MEMORY_BYTES);
        let machine_bytes = self.machine_bytes.filter(|machine| *machine < self.memory_bytes);
        if need <= machine_bytes.unwrap_or(self.memory_bytes) {
            return Ok(());
        }
        let have = match machine_bytes {
            Some(machine) => format!("this machine has {}", size(machine)),
            None => format!("--memory allows {}", size(self.memory_bytes)),
        };
        let more = machine_bytes.is_none().then(|| format!("pass --memory {}", size(need)));
        Err(PlanError::NoMemory { why: memory_text(&estimate.memory, need, &have, more) })
    }

    fn check_disk(&self, estimate: &BuildEstimate) -> Result<(), PlanError> {
        let (store, package) = (estimate.store_bytes, estimate.package_bytes);
        let refuse = |folder: &Path, need: u64, what: String, free: u64| PlanError::NoRoom {
            folder: folder.to_path_buf(),
            need: size(need),
            what,
            free: size(free),
        };
        let for_store = format!("{} for intermediate results", size(store));
        let for_package = format!("{} for the package", size(package));
        let [(store_folder, of_store), (target_folder, of_target)] = [&self.store, &self.target];
        if of_store.device == of_target.device {
            let need = store.saturating_add(package);
            let free = of_store.free_bytes.min(of_target.free_bytes);
            let what = format!("{for_store} and {for_package}");
            return if need > free { Err(refuse(store_folder, need, what, free)) } else { Ok(()) };
        }
        if store > of_store.free_bytes {
            return Err(refuse(store_folder, store, for_store, of_store.free_bytes));
        }
        if package > of_target.free_bytes {
            return Err(refuse(target_folder, package, for_package, of_target.free_bytes));
        }
        Ok(())
    }
}

/// The message about the required memory: its parts, and what the user can do.
fn memory_text(memory: &MemoryEstimate, need: u64, have: &str, more: Option<String>) -> String {
    let threads = memory.threads;
    // Blocks are mentioned if they need more memory than a thread's other work.
    let has_large_blocks = memory.block_bytes > memory.thread_bytes;
    let mut parts = vec![
        format!("{} for the program and its lists", size(memory.base_bytes + memory.tiles_bytes)),
        format!("{threads} × {} for the work of threads", size(memory.thread_bytes)),
    ];
    let mut ways: Vec<String> = more.into_iter().collect();
    if threads > 1 {
        ways.push("use fewer --threads".to_owned());
    }
    if has_large_blocks {
        let block = size(memory.block_bytes);
        let file = &memory.block_file;
        parts.push(format!(
            "{threads} × {block} for a block of {file:?}, which can only be decoded as a whole"
        ));
        let store_tiled =
            "store the file in tiles (gdal_translate -co TILED=YES -co COMPRESS=DEFLATE)";
        ways.push(store_tiled.to_owned());
    }
    ways.push("start anyway with --force".to_owned());
    format!(
        "the build needs at least {} of memory, and {have}: {}; {}",
        size(need),
        parts.join(", "),
        ways.join(", or ")
    )
}

/// The folder itself, or its nearest existing ancestor.
fn nearest_folder(folder: &Path) -> io::Result<PathBuf> {
    let whole = std::path::absolute(folder)?;
    let existing = whole.ancestors().find(|ancestor| fs::metadata(ancestor).is_ok());
    Ok(existing.unwrap_or(&whole).to_path_buf())
}

/// A number of bytes in the form that `--memory` accepts, rounded up.
fn size(bytes: u64) -> String {
    const G: u64 = 1 << 30;
    match bytes {
        _ if bytes >= 100 * G => format!("{}G", bytes.div_ceil(G)),
        _ => format!("{}M", bytes.div_ceil(1 << 20)),
    }
}

#[cfg(test)]
#[path = "enough_room_tests.rs"]
mod tests;
