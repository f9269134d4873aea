//! Resources that this process has used so far, as counted by the kernel. Linux only: on other
//! systems they are unknown, and nothing is estimated.

use std::{fs, time::Duration};

/// Resources that the process has used since it began.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Usage {
    /// CPU time of all threads on all cores, including the kernel's work for them.
    pub cpu: Option<Duration>,
    /// Peak resident memory so far.
    pub peak_memory_bytes: Option<u64>,
    /// Bytes that the process requested to read and to write, whether or not a disk was involved.
    /// Memory-mapped files and network connections are not included.
    pub read_bytes: Option<u64>,
    pub written_bytes: Option<u64>,
}

/// Clock ticks per second in `/proc/PID/stat`: `USER_HZ`, which is 100 on every machine of Rust's
/// Linux targets.
const TICKS_PER_SECOND: u64 = 100;

impl Usage {
    /// Resources used until now. Values that the kernel does not report are `None`.
    pub(crate) fn now() -> Self {
        let file = |name| {
            if cfg!(target_os = "linux") { fs::read_to_string(name).ok() } else { None }
        };
        let io = file("/proc/self/io");
        let io = io.as_deref().unwrap_or_default();
        Self {
            cpu: file("/proc/self/stat").as_deref().and_then(cpu),
            peak_memory_bytes: file("/proc/self/status")
                .as_deref()
                .and_then(|status| number_after(status, "VmHWM:"))
                .map(|kilobytes| kilobytes * 1024),
            read_bytes: number_after(io, "rchar:"),
            written_bytes: number_after(io, "wchar:"),
        }
    }

    /// Resources used since `earlier`. Peak memory stays unchanged: it is never reset.
    pub(crate) fn since(&self, earlier: &Self) -> Self {
        let difference = |now: Option<u64>, then: Option<u64>| Some(now?.saturating_sub(then?));
        Self {
            cpu: self.cpu.zip(earlier.cpu).map(|(now, then)| now.saturating_sub(then)),
            peak_memory_bytes: self.peak_memory_bytes,
            read_bytes: difference(self.read_bytes, earlier.read_bytes),
            written_bytes: difference(self.written_bytes, earlier.written_bytes),
        }
    }

    /// Resources used in this period and in `later` together.
    pub(crate) fn and(&self, later: &Self) -> Self {
        let sum = |a: Option<u64>, b: Option<u64>| Some(a? + b?);
        Self {
            cpu: self.cpu.zip(later.cpu).map(|(a, b)| a + b),
            peak_memory_bytes: self.peak_memory_bytes.max(later.peak_memory_bytes),
            read_bytes: sum(self.read_bytes, later.read_bytes),
            written_bytes: sum(self.written_bytes, later.written_bytes),
        }
    }
}

/// User and system time, fields 14 and 15 of `/proc/PID/stat`. Field 2 is the program's name in
/// brackets, which may contain spaces and brackets.
///
/// Source: `man 5 proc_pid_stat`.
fn cpu(stat: &str) -> Option<Duration> {
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_ascii_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<u64>().ok();
    Some(Duration::from_millis((ticks()? + ticks()?) * (1000 / TICKS_PER_SECOND)))
}

/// The number after `name` at the begin of a line.
fn number_after(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_ascii_whitespace().next()?.parse().ok()
}

#[cfg(test)]
#[path = "usage_tests.rs"]
mod tests;
