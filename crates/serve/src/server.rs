//! Connections and the time they may take.

use std::{
    convert::Infallible,
    io,
    net::{SocketAddr, TcpListener, ToSocketAddrs as _},
    pin::pin,
    sync::Arc,
    time::Duration,
};

use futures_util::future::{Either, select};
use hyper::{Request, body::Incoming, server::conn::http1, service::service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::{
    net::{TcpSocket, TcpStream},
    runtime::Builder,
    sync::{OwnedSemaphorePermit, Semaphore},
    time::{sleep, timeout},
};

use crate::{
    ServeError,
    answer::Site,
    connections::{Connection, Connections, End},
    host::Hosts,
    patience::Patient,
    routes::Routes,
};

/// How often it is asked whether to stop.
const ASKS_EVERY: Duration = Duration::from_millis(100);
/// What answers that were begun may take when the server is stopped.
const ENDS_WITHIN: Duration = Duration::from_secs(2);
/// What a client may take to say what it wants; also how long a connection stays open on which nothing is said.
const REQUEST_WITHIN: Duration = Duration::from_mins(1);
/// How long is waited in all, on a connection, for a client that does not read what it asked for.
const READS_WITHIN: Duration = Duration::from_secs(30);
/// What the system keeps for a client that has not taken it yet. Linux takes twice as much, and asks for more when a third of that is free: a client
/// of [`patience`](crate::patience)'s least rate gets so far in [`READS_WITHIN`].
const SEND_BUFFER_BYTES: u32 = 128 << 10;
/// Connections at once; where there are as many, the one on which nothing was asked for longest gives way. A browser opens six.
const MOST_CONNECTIONS: usize = 256;
/// Threads that answer; files are read by others.
const THREADS: usize = 2;

/// What was asked and answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answered {
    /// `GET`, `HEAD` and so on.
    pub method: String,
    /// The path of the address.
    pub path: String,
    /// The `Range` header.
    pub range: Option<String>,
    /// The status of the answer, such as 206.
    pub status: u16,
}

/// What whoever started a server has to do with it while it runs.
pub struct Watch<'a> {
    /// Asked every tenth of a second: whether to stop.
    pub is_stopped: &'a dyn Fn() -> bool,
    /// Told of every answer, from other threads.
    pub observer: Arc<dyn Fn(&Answered) + Send + Sync>,
}

/// A server that listens, and answers when [`Server::serve`] is called.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    hosts: Hosts,
    patience: Duration,
    most_connections: usize,
}

impl Server {
    /// Listens at a port of an address or name of this machine; port 0 is any that is free.
    ///
    /// # Errors
    /// [`ServeError`], when the address is none of this machine or the port is in use.
    pub fn bind(host: &str, port: u16) -> Result<Self, ServeError> {
        let bare = host.strip_prefix('[').and_then(|host| host.strip_suffix(']')).unwrap_or(host);
        let no_address = |source| ServeError::NoAddress { host: host.to_owned(), source };
        let found: Vec<SocketAddr> = (bare, port).to_socket_addrs().map_err(no_address)?.collect();
        let listen = |source: io::Error| match source.kind() {
            io::ErrorKind::AddrInUse => ServeError::InUse { host: host.to_owned(), port },
            io::ErrorKind::AddrNotAvailable => no_address(source),
            _ => ServeError::Listen { host: host.to_owned(), port, source },
        };
        let listener = TcpListener::bind(&found[..]).map_err(listen)?;
        let address = listener.local_addr().map_err(listen)?;
        listener.set_nonblocking(true).map_err(listen)?;
        let hosts = Hosts::of(bare, address);
        let (patience, most_connections) = (READS_WITHIN, MOST_CONNECTIONS);
        Ok(Self { listener, address, hosts, patience, most_connections })
    }

    /// Waits so long for clients that do not read, and has so many at once: for tests.
    #[doc(hidden)]
    #[must_use]
    pub fn with_limits(self, patience: Duration, most_connections: usize) -> Self {
        Self { patience, most_connections, ..self }
    }

    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers requests until it is stopped. Answers that were begun then may still end, for two seconds.
    ///
    /// # Errors
    /// [`ServeError::Start`].
    pub fn serve(self, routes: Routes, watch: &Watch<'_>) -> Result<(), ServeError> {
        let Self { listener, address, hosts, patience, most_connections } = self;
        let start = |source| ServeError::Start { address, source };
        let runtime = Builder::new_multi_thread()
            .worker_threads(THREADS)
            .thread_name("serve")
            .enable_all()
            .build()
            .map_err(start)?;
        let site = Arc::new(Site { routes, hosts });
        let limits = (patience, most_connections);
        runtime.block_on(accept(listener, &site, limits, watch)).map_err(start)?;
        // A read that hangs must not keep the program.
        runtime.shutdown_background();
        Ok(())
    }
}

async fn accept(
    listener: TcpListener,
    site: &Arc<Site>,
    (patience, most_connections): (Duration, usize),
    watch: &Watch<'_>,
) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let connections = Arc::new(Connections::default());
    let free = Arc::new(Semaphore::new(most_connections));
    // One that has come and has no room yet.
    let mut next: Option<TcpStream> = None;
    while !(watch.is_stopped)() {
        let Some(stream) = next.take() else {
            match timeout(ASKS_EVERY, listener.accept()).await {
                Ok(Ok((stream, _))) => next = Some(stream),
                // Too many open files, or a client that is gone already: neither ends the server.
                Ok(Err(_)) => sleep(ASKS_EVERY).await,
                Err(_) => {}
            }
            continue;
        };
        if free.available_permits() == 0 {
            connections.close_idlest();
        }
        let Ok(Ok(permit)) = timeout(ASKS_EVERY, Arc::clone(&free).acquire_owned()).await else {
            next = Some(stream);
            continue;
        };
        // Without it small answers may wait for each other.
        let _ = stream.set_nodelay(true);
        let Ok(stream) = with_small_buffer(stream) else { continue };
        begin(Patient::new(stream, patience), permit, site, watch, &connections);
    }
    drop((listener, next));
    connections.end_all();
    let all = u32::try_from(most_connections).unwrap_or(u32::MAX);
    let _ = timeout(ENDS_WITHIN, free.acquire_many(all)).await;
    Ok(())
}

/// The connection with a buffer that a slow client empties in time. A large one would be filled before its client is waited for at all.
fn with_small_buffer(stream: TcpStream) -> io::Result<TcpStream> {
    let stream = stream.into_std()?;
    // The option is one of the connection, which both handles have. Without it only slow clients are worse off.
    let _ = TcpSocket::from_std_stream(stream.try_clone()?).set_send_buffer_size(SEND_BUFFER_BYTES);
    TcpStream::from_std(stream)
}

/// Answers what is asked on a connection.
fn begin(
    stream: Patient<TcpStream>,
    permit: OwnedSemaphorePermit,
    site: &Arc<Site>,
    watch: &Watch<'_>,
    connections: &Arc<Connections>,
) {
    let (site, observer) = (Arc::clone(site), Arc::clone(&watch.observer));
    let (connections, connection) =
        (Arc::clone(connections), Arc::new(Connection::new(stream.is_waiting())));
    let number = connections.add(&connection);
    let own = Arc::clone(&connection);
    let service = service_fn(move |request: Request<Incoming>| {
        let (site, observer) = (Arc::clone(&site), Arc::clone(&observer));
        let answering = connection.begin_answer();
        async move {
            let answer = site.answer(&request).await;
            let range = request.headers().get(hyper::header::RANGE);
            observer(&Answered {
                method: request.method().to_string(),
                path: request.uri().path().to_owned(),
                range: range.and_then(|range| range.to_str().ok()).map(str::to_owned),
                status: answer.status().as_u16(),
            });
            Ok::<_, Infallible>(answer.map(|body| answering.with_body(body)))
        }
    });
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(REQUEST_WITHIN)
        .serve_connection(TokioIo::new(stream), service);
    tokio::spawn(async move {
        let mut served = pin!(served);
        loop {
            // What has been asked meanwhile is answered: the first of both is looked at first.
            match select(served.as_mut(), pin!(own.is_told())).await {
                // A client that goes away is no concern of ours.
                Either::Left(_) => break,
                Either::Right(_) => match own.end() {
                    End::Now => break,
                    End::AfterAnswer => served.as_mut().graceful_shutdown(),
                    End::Not => {}
                },
            }
        }
        connections.remove(number);
        drop(permit);
    });
}
