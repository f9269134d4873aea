use super::*;

fn keeps_what_it_is_given(storage: &dyn Storage) {
    let a = storage.append(Kind::Tins, b"hello").unwrap();
    let b = storage.append(Kind::Tins, b"").unwrap();
    let c = storage.append(Kind::Payloads, b"world").unwrap();
    assert_eq!(storage.read(Kind::Tins, a).unwrap(), b"hello");
    assert_eq!(storage.read(Kind::Tins, b).unwrap(), b"");
    assert_eq!(storage.read(Kind::Payloads, c).unwrap(), b"world");
    assert_eq!(storage.read(Kind::Payloads, c.part(1, 3)).unwrap(), b"orl");
    assert_eq!(storage.read(Kind::Payloads, c.part(4, 30)).unwrap(), b"d");
    let beyond = Span { offset: 3, length: 99 };
    assert!(storage.read(Kind::Tins, beyond).is_err());
}

#[test]
fn memory_and_disk_keep_what_they_are_given() {
    keeps_what_it_is_given(&MemoryStorage::default());
    let folder = tempfile::tempdir().unwrap();
    keeps_what_it_is_given(&DiskStorage::create(folder.path()).unwrap());
}
