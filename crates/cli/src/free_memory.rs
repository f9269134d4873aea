//! Memory that is free goes back to the system.
#![cfg_attr(
    all(target_os = "linux", target_env = "gnu"),
    expect(unsafe_code, reason = "mallopt and malloc_trim have no safe wrapper")
)]

/// Blocks of this size and larger are given back as soon as they are free, bytes. What is smaller stays: to make a tile takes some blocks of up to
/// 4 MiB, and pages that are given back and taken again for each tile cost 3 to 5 % of the processor's time.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const GIVEN_BACK_BYTES: i32 = 4 << 20;

/// Lets the C library's allocator give back large blocks when they are freed, which `--memory` counts on.
///
/// By default it keeps more and more of them, up to 32 MiB each: after an extract was sorted, 110 MB stayed with the process for the
/// rest of a build, in pieces. (glibc manual, "Malloc Tunable Parameters": the threshold adjusts itself unless it is set.)
pub(crate) fn give_back_early() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        // SAFETY: `mallopt` takes two numbers and touches nothing but the allocator's parameters, under the allocator's lock. If it refuses
        // them, it returns 0, and they stay as they are.
        let _ = unsafe {
            libc::mallopt(libc::M_MMAP_THRESHOLD, GIVEN_BACK_BYTES)
                & libc::mallopt(libc::M_TRIM_THRESHOLD, GIVEN_BACK_BYTES)
        };
    }
}

/// Gives back all that is free, whatever its size. To be called where a stage ends, and once in a while within one: what it leaves are small blocks
/// all over the allocator's areas, which the next stage, with blocks of other sizes and in other threads, does not fill.
///
/// After 30 million nodes of roads, areas and boundaries were read, 85 MiB stayed so, and a build with 256 MiB took 284 MiB. (`malloc_trim(3)`:
/// this call alone gives back whole pages in the middle of an area.)
pub(crate) fn give_back_all() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        // SAFETY: `malloc_trim` takes a number and gives back pages of free blocks alone, under the allocator's locks.
        let _ = unsafe { libc::malloc_trim(0) };
    }
}
