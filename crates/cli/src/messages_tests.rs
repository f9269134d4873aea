//! Messages have a form for people and one for programs, and each voice prints more than the
//! previous one.

use std::sync::{Arc, Mutex};

use super::*;

/// A buffer for a test's messages.
#[derive(Clone, Default)]
struct Paper(Arc<Mutex<Vec<u8>>>);

impl Write for Paper {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The lines that are printed with this voice.
fn said(voice: Voice, talk: impl FnOnce()) -> String {
    let paper = Paper::default();
    let pen = paper.clone();
    let (own, libraries) = levels(voice);
    let shown = Targets::new().with_target(OWN_TARGETS, own).with_default(libraries);
    let layer = fmt::layer().with_writer(move || pen.clone()).event_format(Lines);
    let subscriber = tracing_subscriber::registry().with(layer.with_filter(shown));
    tracing::subscriber::with_default(subscriber, talk);
    let bytes = paper.0.lock().unwrap().clone();
    String::from_utf8(bytes).unwrap()
}

fn talk() {
    let _span = tracing::info_span!("build").entered();
    tracing::error!(exit_code = 2, "broken");
    tracing::warn!("odd");
    tracing::info!("good to know");
    tracing::debug!(tiles = 3, name = "a b", "done");
    let stage = tracing::info_span!("stage", id = "tiles");
    tracing::trace!(parent: &stage, "step");
    tracing::warn!(target: "wgpu_core", "from a library");
    tracing::debug!(target: "wgpu_core", "a detail of a library");
}

#[test]
fn lines_are_for_people_and_details_have_spans_and_fields() {
    let loud = said(Voice { verbose: 2, ..Voice::default() }, talk);
    let lines: Vec<&str> = loud.lines().collect();
    assert_eq!(
        lines,
        [
            "corniche: broken",
            "corniche: warning: odd",
            "good to know",
            "debug: build: done tiles=3 name=\"a b\"",
            "trace: build: stage(id=\"tiles\"): step",
            "corniche: warning: from a library",
            "debug: build: a detail of a library",
        ]
    );
}

#[test]
fn each_voice_says_more_than_the_one_before() {
    let quiet = Voice { quiet: true, ..Voice::default() };
    let count = |voice| said(voice, talk).lines().count();
    assert_eq!(count(quiet), 2);
    assert_eq!(count(Voice::default()), 3);
    assert_eq!(count(Voice { verbose: 1, ..Voice::default() }), 5);
    assert_eq!(count(Voice { verbose: 2, ..Voice::default() }), 7);
}
