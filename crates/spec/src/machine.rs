//! Memory and disk space of the machine.

use std::{fs, io, path::Path, time::Duration};
#[cfg(not(unix))]
use std::{sync::OnceLock, time::Instant};

/// The least memory with which a build can run.
pub const MIN_MEMORY_BYTES: u64 = 256 << 20;
/// The most memory that a build uses by default.
const MOST_DEFAULT_MEMORY_BYTES: u64 = 4 << 30;
/// The memory to use on a machine whose memory is unknown.
const UNKNOWN_MEMORY_BYTES: u64 = 1 << 30;

/// The memory that a build uses without `--memory`: half of the machine's memory, from 256 MiB to 4
/// GiB; 1 GiB if the machine's memory is unknown.
#[must_use]
pub fn default_memory_bytes() -> u64 {
    default_of(machine_memory_bytes())
}

fn default_of(machine_bytes: Option<u64>) -> u64 {
    machine_bytes.map_or(UNKNOWN_MEMORY_BYTES, |bytes| {
        (bytes / 2).clamp(MIN_MEMORY_BYTES, MOST_DEFAULT_MEMORY_BYTES)
    })
}

/// The machine's memory, or the limit of a container, bytes; `None` if the system does not report
/// it.
#[must_use]
pub fn machine_memory_bytes() -> Option<u64> {
    let read = |path: &str| fs::read_to_string(path).ok();
    let total = read("/proc/meminfo").as_deref().and_then(total_of_meminfo);
    // Control groups, version 2 and version 1. Without a limit the text is "max" or a number beyond
    // all memory.
    let limits = ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"];
    let limits = limits.iter().filter_map(|path| read(path)?.trim().parse::<u64>().ok());
    total.into_iter().chain(limits).min()
}

/// Parses a line such as `MemTotal:       24576000 kB`.
fn total_of_meminfo(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1 << 10)
}

/// The CPU time of this thread, from any start. Unlike the elapsed time, it does not grow when the
/// machine is busy.
#[cfg(unix)]
#[must_use]
pub fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// The elapsed time instead, because the CPU time is unknown here.
#[cfg(not(unix))]
pub fn thread_time() -> Duration {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// The file system of a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileSystem {
    /// The number of the device. Two folders with the same number share their free space.
    pub device: u64,
    /// Space that this user can fill, bytes.
    pub free_bytes: u64,
}

impl FileSystem {
    /// Returns the file system of an existing folder.
    ///
    /// # Errors
    /// When the file system cannot be queried.
    #[cfg(unix)]
    pub fn containing(folder: &Path) -> io::Result<Self> {
        use std::os::unix::fs::MetadataExt as _;
        let found = rustix::fs::statvfs(folder)?;
        let free_bytes = found.f_bavail.saturating_mul(found.f_frsize);
        Ok(Self { device: fs::metadata(folder)?.dev(), free_bytes })
    }

    /// Returns unlimited space, because file systems cannot be queried here.
    #[cfg(not(unix))]
    pub fn containing(folder: &Path) -> io::Result<Self> {
        fs::metadata(folder)?;
        Ok(Self { device: 0, free_bytes: u64::MAX })
    }
}

#[cfg(test)]
#[path = "machine_tests.rs"]
mod tests;
