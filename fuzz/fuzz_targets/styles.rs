//! The libFuzzer entry point of [`corniche_fuzz::styles`].
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| corniche_fuzz::styles(data));
