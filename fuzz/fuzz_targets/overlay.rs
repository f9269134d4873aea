//! The libFuzzer entry point of [`corniche_fuzz::overlay`].
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| corniche_fuzz::overlay(data));
