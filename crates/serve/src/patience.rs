//! A connection that ends when its client does not read the answer.

use std::{
    future::Future as _,
    io,
    pin::Pin,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    task::{Context, Poll, ready},
    time::{Duration, Instant},
};

use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    time::{Sleep, sleep},
};

/// The least rate of a client, in bytes per second on average; slower clients are disconnected.
const LEAST_BYTES_PER_SECOND: u64 = 4096;
/// The factor for the waiting time of clients that read, because the system accepts more data only
/// when much of its buffer is free.
const MOST_TIMES: u32 = 4;

/// A stream that waits for its reader only for a limited time in total: a fixed time, and more for
/// received bytes.
pub(crate) struct Patient<S> {
    stream: S,
    /// The remaining waiting time, and its limit.
    left: Duration,
    most: Duration,
    /// The time that received bytes may still add: a multiple of the time that was waited for them.
    /// The buffers of both sides fill without a reader, so they add little.
    may_earn: Duration,
    /// The begin of the current wait, and the timer that ends it.
    waits: Option<(Instant, Pin<Box<Sleep>>)>,
    /// Whether the stream waits for its reader, for other parts of the server.
    is_waiting: Arc<AtomicBool>,
}

impl<S> Patient<S> {
    pub(crate) fn new(stream: S, patience: Duration) -> Self {
        let most = patience * MOST_TIMES;
        let is_waiting = Arc::default();
        Self { stream, left: patience, most, may_earn: Duration::ZERO, waits: None, is_waiting }
    }

    /// A shared flag: whether the stream waits for its reader. Then a part of an answer is unsent.
    pub(crate) fn is_waiting(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.is_waiting)
    }

    /// Counts the result of a call that may wait.
    fn count(
        &mut self,
        context: &mut Context<'_>,
        done: Poll<io::Result<usize>>,
    ) -> Poll<io::Result<usize>> {
        self.is_waiting.store(done.is_pending(), Ordering::Relaxed);
        if let Poll::Ready(done) = done {
            if let Some((since, _)) = self.waits.take() {
                let waited = since.elapsed();
                self.left = self.left.saturating_sub(waited);
                self.may_earn = waited * MOST_TIMES;
            }
            let taken = *done.as_ref().unwrap_or(&0) as u64;
            let earned = Duration::from_micros(taken * 1_000_000 / LEAST_BYTES_PER_SECOND);
            let earned = earned.min(self.may_earn);
            self.may_earn -= earned;
            self.left = (self.left + earned).min(self.most);
            return Poll::Ready(done);
        }
        let left = self.left;
        let (_, end) = self.waits.get_or_insert_with(|| (Instant::now(), Box::pin(sleep(left))));
        ready!(end.as_mut().poll(context));
        Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Patient<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Patient<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let done = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.count(context, done)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let done = Pin::new(&mut self.stream).poll_write_vectored(context, slices);
        self.count(context, done)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        let done = Pin::new(&mut self.stream).poll_flush(context).map_ok(|()| 0);
        self.count(context, done).map_ok(|_| ())
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        let done = Pin::new(&mut self.stream).poll_shutdown(context).map_ok(|()| 0);
        self.count(context, done).map_ok(|_| ())
    }
}
