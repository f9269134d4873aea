//! Every kind of input is listed once, and hashing counts the bytes of the files.

use std::sync::Mutex;

use super::*;

/// The match has no `_`, so a new kind does not compile here until it is added to the list or is
/// known to be in no manifest.
#[test]
fn every_kind_of_input_of_a_manifest_is_listed_once() {
    for (place, kind) in InputKind::RECORDED.into_iter().enumerate() {
        let expected = match kind {
            InputKind::Dem => 0,
            InputKind::DemPart => 1,
            InputKind::Photo => 2,
            InputKind::PhotoPart => 3,
            InputKind::Polygon => 4,
            InputKind::Osm => 5,
            InputKind::Terrain => panic!("a manifest has its files"),
        };
        assert_eq!(place, expected, "{kind:?}");
    }
    assert_eq!(InputKind::RECORDED.len(), 6);
}

/// Records the argument of `begin`, and the steps.
#[derive(Default)]
struct Counted(Mutex<(Option<u64>, u64)>);

impl corniche_work::Observer for Counted {
    fn begin(&self, stage: Stage, total: Option<u64>) {
        assert_eq!(stage, Stage::Hash);
        *self.0.lock().unwrap() = (total, 0);
    }

    fn advance(&self, _: Stage, steps: u64) {
        self.0.lock().unwrap().1 += steps;
    }
}

impl BuildObserver for Counted {}

/// Hashing counts bytes, and knows their number in advance, except for a part of an archive.
#[test]
fn hashing_counts_the_bytes_of_the_files() {
    const BYTES: u64 = (3 << 20) + 5;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, vec![7; BYTES as usize]).unwrap();
    let inside = PathBuf::from(format!("/vsisubfile/3_100,{}", file.display()));
    for (path, total, bytes) in [(&file, Some(BYTES), BYTES), (&inside, None, 100)] {
        let counted = Counted::default();
        let records = InputFiles::find(
            &[],
            OtherInputs { osm: std::slice::from_ref(path), polygon: None, photo: &[] },
        )
        .unwrap()
        .hash(&counted)
        .unwrap();
        assert_eq!(records[0].bytes, bytes);
        assert_eq!(*counted.0.lock().unwrap(), (total, bytes), "{}", path.display());
    }
}
