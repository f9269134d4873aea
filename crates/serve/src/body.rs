//! The bodies of answers: bytes in memory, or ranges of a file.

use std::{io, ops::RangeInclusive};

use bytes::Bytes;
use futures_util::TryStreamExt as _;
use http_body_util::{BodyExt as _, Full, StreamBody, combinators::UnsyncBoxBody};
use hyper::body::Frame;
use tokio::{
    fs::File,
    io::{AsyncReadExt as _, AsyncSeekExt as _, SeekFrom},
};
use tokio_util::io::ReaderStream;

/// The body of an answer.
pub(crate) type Body = UnsyncBoxBody<Bytes, io::Error>;

/// The number of bytes of a file that are read at once.
const CHUNK_BYTES: usize = 256 * 1024;

pub(crate) fn of_bytes(bytes: impl Into<Bytes>) -> Body {
    Full::new(bytes.into()).map_err(|never| match never {}).boxed_unsync()
}

/// A range of a file. If the file ends early, the connection is closed, which tells the client that
/// bytes are missing.
pub(crate) async fn of_file(mut file: File, range: &RangeInclusive<u64>) -> io::Result<Body> {
    file.seek(SeekFrom::Start(*range.start())).await?;
    let part = file.take(range.end() - range.start() + 1);
    let chunks = ReaderStream::with_capacity(part, CHUNK_BYTES).map_ok(Frame::data);
    Ok(StreamBody::new(chunks).boxed_unsync())
}
