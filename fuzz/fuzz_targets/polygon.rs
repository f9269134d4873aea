//! The libFuzzer entry point of [`corniche_fuzz::polygon`].
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| corniche_fuzz::polygon(data));
