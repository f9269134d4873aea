//! The connections of the server, and their time limits.

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
    connections::{Connection, ConnectionEnd, Connections},
    host::Hosts,
    patience::Patient,
    routes::Routes,
};

/// Interval of the checks whether to stop.
const ASKS_EVERY: Duration = Duration::from_millis(100);
/// Time for begun answers after the server is stopped.
const ENDS_WITHIN: Duration = Duration::from_secs(2);
/// Time for a client to send a request; also the time that an idle connection stays open.
const REQUEST_WITHIN: Duration = Duration::from_mins(1);
/// Total waiting time on a connection for a client that does not read the answer.
const READS_WITHIN: Duration = Duration::from_secs(30);
/// The system's buffer for bytes that a client has not received yet. Linux allocates twice as much,
/// and accepts more when a third of that is free: a client with the least rate of
/// [`patience`](crate::patience) reads that much in [`READS_WITHIN`].
const SEND_BUFFER_BYTES: u32 = 128 << 10;
/// The largest number of connections; beyond it, the connection that has been idle for longest is
/// closed. A browser opens six.
const MOST_CONNECTIONS: usize = 256;
/// Threads for answers; files are read by other threads.
const THREADS: usize = 2;

/// A request and its answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answered {
    /// `GET`, `HEAD` and so on.
    pub method: String,
    /// The path of the URL.
    pub path: String,
    /// The `Range` header.
    pub range: Option<String>,
    /// The status of the answer, such as 206.
    pub status: u16,
}

/// The callbacks of the program that starts a server.
pub struct ServerWatch<'a> {
    /// Called every tenth of a second: returns whether to stop.
    pub is_stopped: &'a dyn Fn() -> bool,
    /// Called for every answer, from other threads.
    pub observer: Arc<dyn Fn(&Answered) + Send + Sync>,
}

/// A server that listens, and answers after [`Server::serve`] is called.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    hosts: Hosts,
    patience: Duration,
    most_connections: usize,
}

impl Server {
    /// Listens at a port of an address or name of this machine; port 0 selects any free port.
    ///
    /// # Errors
    /// [`ServeError`], when the address does not belong to this machine or the port is in use.
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
        let hosts = Hosts::from_names(bare, address);
        let (patience, most_connections) = (READS_WITHIN, MOST_CONNECTIONS);
        Ok(Self { listener, address, hosts, patience, most_connections })
    }

    /// Sets the waiting time for clients that do not read, and the largest number of connections:
    /// for tests.
    #[doc(hidden)]
    #[must_use]
    pub fn with_limits(self, patience: Duration, most_connections: usize) -> Self {
        Self { patience, most_connections, ..self }
    }

    /// The address of the server.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers requests until the server is stopped. Begun answers may still end, for two seconds.
    ///
    /// # Errors
    /// [`ServeError::Start`].
    pub fn serve(self, routes: Routes, watch: &ServerWatch<'_>) -> Result<(), ServeError> {
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
        // A hanging read must not keep the program alive.
        runtime.shutdown_background();
        Ok(())
    }
}

async fn accept(
    listener: TcpListener,
    site: &Arc<Site>,
    (patience, most_connections): (Duration, usize),
    watch: &ServerWatch<'_>,
) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let connections = Arc::new(Connections::default());
    let free = Arc::new(Semaphore::new(most_connections));
    // A connection that is accepted and still waits for a free place.
    let mut next: Option<TcpStream> = None;
    while !(watch.is_stopped)() {
        let Some(stream) = next.take() else {
            match timeout(ASKS_EVERY, listener.accept()).await {
                Ok(Ok((stream, _))) => next = Some(stream),
                // Too many open files, or a client that has already disconnected: neither ends the
                // server.
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
        // Without this option, small answers may wait for each other.
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

/// The connection with a buffer that a slow client empties in time. A large buffer would be filled
/// before the server waits for the client at all.
fn with_small_buffer(stream: TcpStream) -> io::Result<TcpStream> {
    let stream = stream.into_std()?;
    // The option belongs to the connection, which both handles share. Without it, only slow clients
    // are worse off.
    let _ = TcpSocket::from_std_stream(stream.try_clone()?).set_send_buffer_size(SEND_BUFFER_BYTES);
    TcpStream::from_std(stream)
}

/// Serves the requests on a connection.
fn begin(
    stream: Patient<TcpStream>,
    permit: OwnedSemaphorePermit,
    site: &Arc<Site>,
    watch: &ServerWatch<'_>,
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
            // A request that has arrived meanwhile is answered: the first branch is polled first.
            match select(served.as_mut(), pin!(own.is_told())).await {
                // A client that disconnects is not an error.
                Either::Left(_) => break,
                Either::Right(_) => match own.end() {
                    ConnectionEnd::Now => break,
                    ConnectionEnd::AfterAnswer => served.as_mut().graceful_shutdown(),
                    ConnectionEnd::Not => {}
                },
            }
        }
        connections.remove(number);
        drop(permit);
    });
}
