//! Stored defects are reported again unchanged, and a missing block is an error.

use corniche_spec::artifacts::ArtifactError;
use std::sync::{
    Mutex,
    atomic::{AtomicBool, Ordering},
};

use corniche_osm::ExtractDefect as OsmDefect;
use corniche_store::MemoryStore;

use super::*;

/// Records what is reported to it.
#[derive(Default)]
struct Listener {
    told: Mutex<Vec<Defect>>,
    is_cancelled: AtomicBool,
}

impl corniche_work::Observer for Listener {
    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

impl BuildObserver for Listener {
    fn defect(&self, defect: &Defect) {
        self.told.lock().unwrap().push(defect.clone());
    }
}

/// Defects of several kinds; no two are equal.
fn defects(count: usize) -> Vec<Defect> {
    let defect = |k: usize| {
        let way_id = 7 - k as i64;
        Defect::Osm(match k % 3 {
            0 => OsmDefect::UnknownHighway { way_id, value: format!("\"moat\",\n{k} ä") },
            1 => OsmDefect::SelfCrossing { way_id, crossings: k as u32 },
            _ => OsmDefect::ConflictingNode { node_id: -way_id },
        })
    };
    (0..count).map(defect).collect()
}

fn keep(defects: &[Defect], store: &MemoryStore) -> (Vec<Defect>, BTreeMap<String, u64>) {
    let listener = Listener::default();
    let mut writer = DefectsWriter::new(store, &listener);
    for defect in defects {
        writer.push(defect.clone());
    }
    let by_name = writer.finish().unwrap();
    (listener.told.into_inner().unwrap(), by_name)
}

#[test]
fn defects_are_told_again_as_they_were() {
    for (count, blocks) in [
        (0, 1),
        (1, 1),
        (BLOCK_DEFECTS - 1, 1),
        (BLOCK_DEFECTS, 2),
        (BLOCK_DEFECTS + 1, 2),
        (2 * BLOCK_DEFECTS + 5, 3),
    ] {
        let (store, defects) = (MemoryStore::default(), defects(count));
        let (told, by_name) = keep(&defects, &store);
        assert!(told == defects, "{count} reported as they are found");
        assert_eq!(by_name.values().sum::<u64>(), count as u64);
        assert_eq!(store.items(ArtifactKind::Defects as u8).len(), blocks, "{count}");
        let listener = Listener::default();
        replay_defects(&store, &listener).unwrap();
        assert!(listener.told.into_inner().unwrap() == defects, "{count} reported again");
    }
}

/// All blocks but one are copied: each missing block is noticed, also the last one.
#[test]
fn a_missing_block_is_an_error() {
    let whole = MemoryStore::default();
    keep(&defects(2 * BLOCK_DEFECTS), &whole);
    let items = whole.items(ArtifactKind::Defects as u8);
    assert_eq!(items, [0, 1, 2]);
    for &missing in &items {
        let store = MemoryStore::default();
        for key in
            items.iter().filter(|&&item| item != missing).map(|&k| ArtifactKind::Defects.item(k))
        {
            store.put(key, &whole.get(key).unwrap().unwrap()).unwrap();
        }
        let error = replay_defects(&store, &Listener::default()).unwrap_err();
        assert!(matches!(error, ExtractError::Artifact(ArtifactError::Damaged { .. })), "{error}");
        assert!(error.to_string().contains(&format!("artifact {missing} ")), "{error}");
    }
}

#[test]
fn telling_again_can_be_cancelled() {
    let store = MemoryStore::default();
    keep(&defects(1), &store);
    let listener = Listener { is_cancelled: true.into(), ..Listener::default() };
    let error = replay_defects(&store, &listener).unwrap_err();
    assert!(matches!(error, ExtractError::Interrupted), "{error}");
    assert!(listener.told.into_inner().unwrap().is_empty());
}
