//! When there are too many connections, the right ones are closed.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    io::{Read as _, Write as _},
    net::{SocketAddr, TcpStream},
    time::{Duration, Instant},
};

use crate::serving::{CONNECTIONS, start};

/// Requests the page, and leaves the connection open.
fn ask_and_stay(address: SocketAddr) -> TcpStream {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    stream.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").unwrap();
    let mut begun = [0; 12];
    stream.read_exact(&mut begun).unwrap();
    assert_eq!(&begun, b"HTTP/1.1 200");
    stream
}

/// Idle connections are closed, whatever was sent on them before: nothing, half a request, or a
/// whole one.
#[test]
fn idle_connections_give_way() {
    let running = start();
    let said: [&[u8]; 3] = [b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: loc"];
    for said in said {
        let idle: Vec<TcpStream> = (0..3 * CONNECTIONS)
            .map(|_| {
                let mut stream = TcpStream::connect(running.address).unwrap();
                let _ = stream.write_all(said);
                stream
            })
            .collect();
        let begun = Instant::now();
        drop(ask_and_stay(running.address));
        assert!(begun.elapsed() < Duration::from_secs(10), "{:?}", begun.elapsed());
        drop(idle);
    }
    // Connections with requests stay as long as there is space, and the last ones longest.
    let kept: Vec<TcpStream> =
        (0..2 * CONNECTIONS).map(|_| ask_and_stay(running.address)).collect();
    let mut last = kept.last().unwrap();
    last.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").unwrap();
    let mut answers = Vec::new();
    last.read_to_end(&mut answers).unwrap();
    assert!(String::from_utf8_lossy(&answers).contains("HTTP/1.1 200"), "it was closed");
}

/// A client that receives its answer slowly is not idle: it gets the whole answer while others
/// connect.
#[test]
fn what_is_being_answered_does_not_give_way() {
    let running = start();
    let mut slow = TcpStream::connect(running.address).unwrap();
    slow.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let asked =
        "GET /packages/a%20b.pmtiles HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    slow.write_all(asked.as_bytes()).unwrap();
    let mut first = vec![0; 1000];
    slow.read_exact(&mut first).unwrap();
    let others: Vec<TcpStream> =
        (0..2 * CONNECTIONS).map(|_| ask_and_stay(running.address)).collect();
    let mut rest = Vec::new();
    slow.read_to_end(&mut rest).unwrap();
    assert!([first, rest].concat().ends_with(&running.bytes), "it was cut off");
    drop(others);
}
