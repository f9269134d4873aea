//! What the machine has to offer.

use std::{fs, io, path::Path, time::Duration};
#[cfg(not(unix))]
use std::{sync::OnceLock, time::Instant};

/// Less memory than this is not enough for a build.
pub const MIN_MEMORY_BYTES: u64 = 256 << 20;
/// The most that a build takes if nothing else is said.
const MOST_DEFAULT_MEMORY_BYTES: u64 = 4 << 30;
/// What is taken on a machine that does not tell its memory.
const UNKNOWN_MEMORY_BYTES: u64 = 1 << 30;

/// The memory that a build takes where `--memory` is not given: half of the machine's, from 256 MiB to 4 GiB; 1 GiB where the
/// machine does not tell how much it has.
#[must_use]
pub fn default_memory_bytes() -> u64 {
    default_of(machine_memory_bytes())
}

fn default_of(machine_bytes: Option<u64>) -> u64 {
    machine_bytes.map_or(UNKNOWN_MEMORY_BYTES, |bytes| {
        (bytes / 2).clamp(MIN_MEMORY_BYTES, MOST_DEFAULT_MEMORY_BYTES)
    })
}

/// The machine's memory, or what a container leaves of it, bytes; `None` where the system does not tell.
#[must_use]
pub fn machine_memory_bytes() -> Option<u64> {
    let read = |path: &str| fs::read_to_string(path).ok();
    let total = read("/proc/meminfo").as_deref().and_then(total_of_meminfo);
    // Control groups, version 2 and version 1. Without a limit the text is "max" or a number beyond all memory.
    let limits = ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"];
    let limits = limits.iter().filter_map(|path| read(path)?.trim().parse::<u64>().ok());
    total.into_iter().chain(limits).min()
}

/// `MemTotal:       24576000 kB`
fn total_of_meminfo(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1 << 10)
}

/// How long this thread has used a processor, from any start. Unlike the time that passes, it is the same on a busy machine.
#[cfg(unix)]
#[must_use]
pub fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// The time that passes stands for it: the processor's is not known here.
#[cfg(not(unix))]
pub fn thread_time() -> Duration {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// The file system of a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileSystem {
    /// Two folders with the same number share their free space.
    pub device: u64,
    /// Space that this user can fill, bytes.
    pub free_bytes: u64,
}

impl FileSystem {
    /// The file system of a folder that exists.
    ///
    /// # Errors
    /// When the file system cannot be asked.
    #[cfg(unix)]
    pub fn of(folder: &Path) -> io::Result<Self> {
        use std::os::unix::fs::MetadataExt as _;
        let found = rustix::fs::statvfs(folder)?;
        let free_bytes = found.f_bavail.saturating_mul(found.f_frsize);
        Ok(Self { device: fs::metadata(folder)?.dev(), free_bytes })
    }

    /// Nothing is known of file systems here: they count as endless.
    #[cfg(not(unix))]
    pub fn of(folder: &Path) -> io::Result<Self> {
        fs::metadata(folder)?;
        Ok(Self { device: 0, free_bytes: u64::MAX })
    }
}

#[cfg(test)]
#[path = "machine_tests.rs"]
mod tests;
