//! CPU time, memory and bytes of the process are read from the kernel unchanged.

use super::*;

/// A name may have any characters; the fields are counted from its last bracket.
#[test]
fn cpu_time_is_user_and_system() {
    let fields = "S 1 2 3 4 5 6 7 8 9 10 1234 66 99 98 20 0 3";
    for name in ["corniche", "a b", "a) R 1 (b"] {
        let stat = format!("4711 ({name}) {fields}\n");
        assert_eq!(cpu(&stat), Some(Duration::from_secs(13)), "{name}");
    }
    for damaged in
        ["", "4711 (corniche", "4711 (corniche) S 1 2", "1 (c) S 1 2 3 4 5 6 7 8 9 10 x 6"]
    {
        assert_eq!(cpu(damaged), None, "{damaged}");
    }
}

#[test]
fn numbers_are_found_by_the_name_of_their_line() {
    let status = "VmPeak:\t  99 kB\nVmHWM:\t    2020 kB\n";
    assert_eq!(number_after(status, "VmHWM:"), Some(2020));
    assert_eq!(number_after("rchar: 6976\nwchar: 0\n", "wchar:"), Some(0));
    assert_eq!(
        (number_after(status, "rchar:"), number_after("rchar: many", "rchar:")),
        (None, None)
    );
}

#[test]
fn differences_and_sums_keep_what_is_unknown_unknown() {
    let usage = |cpu_s, peak, read| Usage {
        cpu: Some(Duration::from_secs(cpu_s)),
        peak_memory_bytes: Some(peak),
        read_bytes: Some(read),
        written_bytes: None,
    };
    assert_eq!(usage(9, 50, 700).since(&usage(4, 30, 100)), usage(5, 50, 600));
    assert_eq!(usage(5, 50, 600).and(&usage(2, 70, 100)), usage(7, 70, 700));
    assert_eq!(Usage::default().since(&usage(4, 30, 100)), Usage::default());
}

/// The work of this process is counted.
#[cfg(target_os = "linux")]
#[test]
fn the_kernel_counts_what_is_used() {
    const BYTES: usize = 3 << 20;
    let begin = Usage::now();
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), vec![1; BYTES]).unwrap();
    assert_eq!(fs::read(file.path()).unwrap().len(), BYTES);
    // The loop runs until the kernel's clock has ticked; it needs no other limit.
    while Usage::now().since(&begin).cpu.unwrap() < Duration::from_millis(50) {}
    let used = Usage::now().since(&begin);
    assert!(used.read_bytes.unwrap() >= BYTES as u64, "{used:?}");
    assert!(used.written_bytes.unwrap() >= BYTES as u64, "{used:?}");
    assert!(used.peak_memory_bytes.unwrap() >= BYTES as u64, "{used:?}");
}
