//! The libFuzzer entry point of [`corniche_fuzz::package`].
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| corniche_fuzz::package(data));
