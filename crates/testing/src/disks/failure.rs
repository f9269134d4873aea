//! The failures that a simulated disk can have at a call.

/// The failure of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DiskFailure {
    /// From this call on, calls that need disk space fail; others do not. `MemoryDisk::make_room`
    /// ends it.
    Full,
    /// This call fails like a device error (`EIO`).
    Device,
    /// This call is interrupted (`EINTR`) and does nothing. The caller must repeat it.
    Interrupted,
    /// If this call reads or writes, it does half of the work and reports so.
    Short,
    /// This call and all later ones fail, as if the process were dead: nothing reaches the disk any
    /// more.
    Death,
}
