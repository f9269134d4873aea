//! Returns free memory to the system.
#![cfg_attr(
    all(target_os = "linux", target_env = "gnu"),
    expect(unsafe_code, reason = "mallopt and malloc_trim have no safe wrapper")
)]

/// Blocks of this size and larger are returned as soon as they are free, bytes. Smaller blocks are
/// kept: computing a tile needs several blocks of up to 4 MiB, and releasing and reallocating their
/// pages for each tile costs 3 to 5 % of the CPU time.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const GIVEN_BACK_BYTES: i32 = 4 << 20;

/// Makes the C library's allocator return large blocks when they are freed; `--memory` relies on
/// this.
///
/// The allocator by default keeps more and more freed blocks, up to 32 MiB each: after sorting an
/// extract, 110 MB stayed with the process for the rest of a build, in fragments. (glibc manual,
/// "Malloc Tunable Parameters": the threshold adjusts itself unless it is set.)
pub(crate) fn give_back_early() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        // SAFETY: `mallopt` takes two numbers and changes nothing but the allocator's parameters,
        // under the allocator's lock. If it rejects them, it returns 0, and they stay unchanged.
        let _ = unsafe {
            libc::mallopt(libc::M_MMAP_THRESHOLD, GIVEN_BACK_BYTES)
                & libc::mallopt(libc::M_TRIM_THRESHOLD, GIVEN_BACK_BYTES)
        };
    }
}

/// Returns all free memory, whatever its size. Call it at the end of a stage, and occasionally
/// within a stage: the remaining small blocks are scattered over the allocator's areas, and the
/// next stage, with other sizes and threads, does not fill them.
///
/// After reading 30 million nodes of roads, areas and boundaries, 85 MiB remained in this way, and
/// a build with 256 MiB needed 284 MiB. (`malloc_trim(3)`: only this call returns whole pages in
/// the middle of an area.)
pub(crate) fn give_back_all() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        // SAFETY: `malloc_trim` takes a number and returns only pages of free blocks, under the
        // allocator's locks.
        let _ = unsafe { libc::malloc_trim(0) };
    }
}
