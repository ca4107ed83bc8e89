//! The picture in a browser, by a server on a thread of its own.
//!
//! Requests are small, have no content and one connection each. The number of connections, the time
//! of each and the size of headers are limited; so is, by the [`Feed`], the memory of pictures. So
//! clients that are slow or hostile cost little more than the time of one thread.

mod access;
mod content;
mod replies;

use std::net::{SocketAddr, TcpListener as StdListener, ToSocketAddrs};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::{TcpListener, TcpStream};

use self::access::{Access, generated_token};
use self::replies::Served;
use super::feed::Feed;
use crate::failure::Failure;
use crate::interrupt::Interrupt;

/// The most connections at a time; further ones are closed at once.
const MOST_CONNECTIONS: usize = 32;

/// How long a client may take to send its request.
const REQUEST: Duration = Duration::from_secs(5);

/// How long a connection may take altogether.
const CONNECTION: Duration = Duration::from_secs(60);

/// The most bytes of a request.
const REQUEST_SIZE: usize = 16 << 10;

/// A page that has not asked for news for this time is gone.
const ABSENT: Duration = Duration::from_millis(1500);

/// A server of the picture of one render.
pub struct Server {
    url: String,
    served: Arc<Served>,
    connections: Arc<()>,
}

impl Server {
    /// Starts the server of a picture at an address. Without a token, one is generated if other
    /// machines reach the address.
    pub fn start(
        address: &str,
        token: Option<&str>,
        name: &str,
        feed: &Arc<Feed>,
        interrupt: &Interrupt,
    ) -> Result<Self, Failure> {
        let fail = |error: &dyn std::fmt::Display| {
            Failure::Input(format!(
                "cannot serve at {address}: {error}; --serve=ADDR:PORT names another address"
            ))
        };
        let listener = listen(address).map_err(|error| fail(&error))?;
        let bound = listener.local_addr().map_err(|error| fail(&error))?;
        let token = match token {
            Some(token) => Some(token.to_owned()),
            None if bound.ip().is_loopback() => None,
            None => Some(generated_token().map_err(|error| fail(&error))?),
        };
        let served = Arc::new(Served {
            feed: Arc::clone(feed),
            name: name.to_owned(),
            access: Access::new(token.as_deref(), bound.ip()),
            interrupt: interrupt.clone(),
            is_save_asked: AtomicBool::new(false),
            saved: AtomicU32::new(0),
            waiting: Mutex::new(None),
        });
        let server = Self { url: url(bound, token.as_deref()), served, connections: Arc::new(()) };
        let (served, connections) = (Arc::clone(&server.served), Arc::clone(&server.connections));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|error| fail(&error))?;
        let listener = {
            let _context = runtime.enter();
            TcpListener::from_std(listener).map_err(|error| fail(&error))?
        };
        super::spawn("serve", move || runtime.block_on(serve(listener, served, connections)))?;
        Ok(server)
    }

    /// The address that a browser opens.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Whether a page asks for the picture to be written.
    pub fn is_save_asked(&self) -> bool {
        self.served.is_save_asked.load(Ordering::Relaxed)
    }

    /// The picture of so many passes has been written.
    pub fn note_saved(&self, passes: u32) {
        self.served.saved.store(passes, Ordering::Relaxed);
        self.served.is_save_asked.store(false, Ordering::Relaxed);
    }

    /// Whether a page lacks the latest picture, or news are on their way.
    pub fn is_awaited(&self) -> bool {
        let is_waiting = locked(&self.served.waiting).is_some_and(|last| last.elapsed() < ABSENT);
        is_waiting || Arc::strong_count(&self.connections) > 2
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn listen(address: &str) -> std::io::Result<StdListener> {
    let addresses: Vec<SocketAddr> = address.to_socket_addrs()?.collect();
    let listener = StdListener::bind(&addresses[..])?;
    listener.set_nonblocking(true)?;
    Ok(listener)
}

/// What a browser on this machine opens.
fn url(address: SocketAddr, token: Option<&str>) -> String {
    let host = match address.ip() {
        // All addresses of this machine.
        ip if ip.is_unspecified() => format!("localhost:{}", address.port()),
        _ => address.to_string(),
    };
    format!("http://{host}/{}", token.map_or(String::new(), |token| format!("?token={token}")))
}

async fn serve(listener: TcpListener, served: Arc<Served>, connections: Arc<()>) {
    loop {
        match listener.accept().await {
            // Beside those of connections, the server and this function have one.
            Ok((stream, _)) if Arc::strong_count(&connections) < MOST_CONNECTIONS + 2 => {
                tokio::spawn(answer(stream, Arc::clone(&served), Arc::clone(&connections)));
            }
            Ok(_) => (),
            // Such as no free file descriptor.
            Err(_) => tokio::time::sleep(Duration::from_millis(100)).await,
        }
    }
}

/// Answers the request of a connection.
async fn answer(stream: TcpStream, served: Arc<Served>, _connection: Arc<()>) {
    let reply = service_fn(|request| {
        let reply = replies::reply(&served, &request);
        async { Ok::<_, std::convert::Infallible>(reply) }
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(REQUEST)
        .max_buf_size(REQUEST_SIZE)
        .keep_alive(false)
        .serve_connection(TokioIo::new(stream), reply);
    // What fails, or takes too long, is of no interest to the render.
    let _ = tokio::time::timeout(CONNECTION, connection).await;
}
