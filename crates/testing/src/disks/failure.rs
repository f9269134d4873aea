//! The failures that a simulated disk can have at a call.

/// What happens at a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// From this call on, calls that need room fail; others do not. `MemoryDisk::make_room` ends it.
    Full,
    /// This call fails as if the device could not do it (`EIO`).
    Device,
    /// This call is interrupted (`EINTR`) and does nothing. Who calls must make it again.
    Interrupted,
    /// If this call reads or writes, it does half of it and says so.
    Short,
    /// This call and all that follow fail, as if the process were dead: nothing reaches the disk any more.
    Death,
}
