//! The open connections, and which of them is closed when there are too many: the one that has
//! been idle for longest.
//!
//! A connection is busy from the head of a request until the client has received the body of
//! the answer; otherwise it is idle. So a connection on which a client sends half a request and
//! then nothing is idle, too.

use std::{
    collections::BTreeMap,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    time::Instant,
};

use http_body_util::BodyExt as _;
use tokio::sync::Notify;

use crate::body::Body;

/// All open connections, by number.
#[derive(Debug, Default)]
pub(crate) struct Connections(Mutex<Open>);

#[derive(Debug, Default)]
struct Open {
    by_number: BTreeMap<u64, Arc<Connection>>,
    next: u64,
}

/// How a connection that was told to close does so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ConnectionEnd {
    /// At once, because nothing is being answered on it.
    Now,
    /// After the current answer has been sent.
    AfterAnswer,
    /// Not, because it has become busy.
    Not,
}

impl Connections {
    fn open(&self) -> MutexGuard<'_, Open> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a connection and returns its number.
    pub(crate) fn add(&self, connection: &Arc<Connection>) -> u64 {
        let mut open = self.open();
        open.next += 1;
        let number = open.next;
        open.by_number.insert(number, Arc::clone(connection));
        number
    }

    pub(crate) fn remove(&self, number: u64) {
        self.open().by_number.remove(&number);
    }

    /// Tells the connection to close that has been idle for longest and was not told before, if
    /// there is one.
    pub(crate) fn close_idlest(&self) {
        let open = self.open();
        let idle = open.by_number.values();
        let idle = idle.filter_map(|one| Some((one.idle_since()?, one)));
        if let Some((_, idlest)) = idle.min_by_key(|(since, _)| *since) {
            idlest.tell(ShutdownStage::GiveWay);
        }
    }

    /// Tells all connections to close: idle ones at once, the others after their answers.
    pub(crate) fn end_all(&self) {
        self.open().by_number.values().for_each(|one| one.tell(ShutdownStage::End));
    }
}

/// An open connection.
#[derive(Debug)]
pub(crate) struct Connection {
    state: Mutex<State>,
    /// Whether the answer waits for its reader.
    is_waiting: Arc<AtomicBool>,
    told: Notify,
}

#[derive(Debug)]
struct State {
    /// Answers that were begun and are not sent yet.
    answers: usize,
    /// The time of the last change of state.
    since: Instant,
    told: Option<ShutdownStage>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ShutdownStage {
    GiveWay,
    End,
}

impl Connection {
    /// A connection without requests so far.
    pub(crate) fn new(is_waiting: Arc<AtomicBool>) -> Self {
        let state = State { answers: 0, since: Instant::now(), told: None };
        Self { state: Mutex::new(state), is_waiting, told: Notify::new() }
    }

    /// The time since which the connection is idle; `None` if it is busy, or was told to close.
    fn idle_since(&self) -> Option<Instant> {
        let state = self.state();
        (self.is_idle(&state) && state.told.is_none()).then_some(state.since)
    }

    fn is_idle(&self, state: &State) -> bool {
        state.answers == 0 && !self.is_waiting.load(Ordering::Relaxed)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tell(&self, what: ShutdownStage) {
        self.state().told = Some(what);
        self.told.notify_one();
    }

    /// Returns when the connection is told to close.
    pub(crate) async fn is_told(&self) {
        self.told.notified().await;
    }

    /// How to close the connection, after it was told to.
    pub(crate) fn end(&self) -> ConnectionEnd {
        let mut state = self.state();
        match state.told {
            Some(_) if self.is_idle(&state) => ConnectionEnd::Now,
            Some(ShutdownStage::End) => ConnectionEnd::AfterAnswer,
            Some(ShutdownStage::GiveWay) | None => {
                state.told = None;
                ConnectionEnd::Not
            }
        }
    }

    /// Marks the connection as busy until the returned value is dropped.
    pub(crate) fn begin_answer(self: &Arc<Self>) -> Answering {
        let mut state = self.state();
        (state.answers, state.since) = (state.answers + 1, Instant::now());
        Answering(Arc::clone(self))
    }
}

/// A begun answer.
pub(crate) struct Answering(Arc<Connection>);

impl Answering {
    /// The body, which ends the answer when it has been sent: until then, it owns this value.
    pub(crate) fn with_body(self, body: Body) -> Body {
        let own = move |error| {
            let _answering = &self;
            error
        };
        body.map_err(own).boxed_unsync()
    }
}

impl Drop for Answering {
    fn drop(&mut self) {
        let mut state = self.0.state();
        (state.answers, state.since) = (state.answers.saturating_sub(1), Instant::now());
    }
}
