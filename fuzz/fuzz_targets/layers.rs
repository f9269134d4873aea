//! The libFuzzer entry point of [`corniche_fuzz::layers`].
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| corniche_fuzz::layers(data));
