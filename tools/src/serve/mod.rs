//! The server of `nephrite view`: a few fixed addresses, each a part of the page or one of the files named.
//!
//! No address is ever turned into a path: [`Site`] is a table, and what it does not list does not exist. HTTP itself is hyper's, whose
//! parser meets hostile bytes every day; smaller crates serve too, but the likely one (`tiny_http`) has had no release
//! since 2022. hyper knows no ranges, so [`range`] reads the one header that is needed (RFC 9110, section 14).

mod answer;
#[cfg(test)]
mod fuzz;
mod range;
mod site;

use std::convert::Infallible;
use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

use hyper::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1::{self, Connection};
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::time;

use self::answer::Answer;
pub(crate) use self::site::{Body, Site};
use crate::interrupt;

/// Time a client has to send the head of a request, and a request has to end once the server stops.
const PATIENCE: Duration = Duration::from_secs(10);
const PARTING: Duration = Duration::from_millis(500);
/// How often the server looks whether somebody pressed Ctrl-C.
const PULSE: Duration = Duration::from_millis(50);

/// A server that has its address but answers nobody yet.
pub(crate) struct Server {
    listener: TcpListener,
    address: SocketAddr,
}

impl Server {
    /// Takes a port of an address; 0 stands for any that is free.
    ///
    /// # Errors
    ///
    /// The port is taken, or the address is none of this machine.
    pub(crate) fn bind(address: IpAddr, port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((address, port))?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        Ok(Self { listener, address })
    }

    /// What to type into a browser.
    pub(crate) fn url(&self) -> String {
        let ip = self.address.ip();
        let host = match ip {
            // Listening everywhere is no place to go to.
            ip if ip.is_unspecified() => "localhost".to_owned(),
            IpAddr::V4(ip) => ip.to_string(),
            IpAddr::V6(ip) => format!("[{ip}]"),
        };
        format!("http://{host}:{}/", self.address.port())
    }

    /// Answers until somebody presses Ctrl-C; a second later at most it has ended.
    ///
    /// # Errors
    ///
    /// The system has no room for a server. What goes wrong with one client concerns only that client.
    pub(crate) fn run(self, site: Site) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let is_private = self.address.ip().is_loopback();
        let served = runtime.block_on(serve(self.listener, Arc::new(site), is_private));
        runtime.shutdown_timeout(PARTING);
        served
    }
}

async fn serve(listener: TcpListener, site: Arc<Site>, is_private: bool) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let connections = GracefulShutdown::new();
    let mut pulse = time::interval(PULSE);
    loop {
        tokio::select! {
            _ = pulse.tick() => if interrupt::is_requested() { break },
            accepted = listener.accept() => match accepted {
                // A client that goes away in the middle is its own affair.
                Ok((stream, _)) => drop(tokio::spawn(connections.watch(connection(stream, &site, is_private)))),
                // Out of descriptors, for one: those in use are given back in time.
                Err(_) => time::sleep(PULSE).await,
            }
        }
    }
    let _ = time::timeout(PARTING, connections.shutdown()).await;
    Ok(())
}

/// The conversation with one client over its stream: a future that ends when the client has gone, or was silent for too long in
/// the middle of a request's head.
fn connection<S: AsyncRead + AsyncWrite + Unpin>(
    stream: S,
    site: &Arc<Site>,
    is_private: bool,
) -> Connection<
    TokioIo<S>,
    impl Service<Request<Incoming>, Response = Answer, Error = Infallible, Future: Send> + use<S>,
> {
    let site = Arc::clone(site);
    let answer = service_fn(move |request| {
        let site = Arc::clone(&site);
        async move { Ok(answer::answer(&site, is_private, &request).await) }
    });
    http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(PATIENCE)
        .serve_connection(TokioIo::new(stream), answer)
}
