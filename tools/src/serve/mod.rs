//! The server of `nephrite view`: a few fixed addresses, each a part of the page or one of the
//! files.
//!
//! No address becomes a path: [`Site`] is a table, and an address that it does not list does not
//! exist. HTTP is left to the crate hyper, whose parser is exposed to hostile bytes every day; the
//! nearest smaller crate, `tiny_http`, has had no release since 2022. hyper does not handle ranges,
//! so [`range`] reads the one header that is needed (RFC 9110, section 14).

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

/// Time for a client to send the head of a request, and for a request to end once the server stops.
const PATIENCE: Duration = Duration::from_secs(10);
const PARTING: Duration = Duration::from_millis(500);
/// Interval at which the server looks for an interrupt.
const PULSE: Duration = Duration::from_millis(50);

/// A server that has its address but does not answer yet.
pub(crate) struct Server {
    listener: TcpListener,
    address: SocketAddr,
}

impl Server {
    /// Takes a port of an address; 0 stands for any free one.
    ///
    /// # Errors
    ///
    /// The port is taken, or this machine does not have the address.
    pub(crate) fn bind(address: IpAddr, port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((address, port))?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        Ok(Self { listener, address })
    }

    /// The address for a browser.
    pub(crate) fn url(&self) -> String {
        let ip = self.address.ip();
        let host = match ip {
            // A browser cannot open the address that means all addresses.
            ip if ip.is_unspecified() => "localhost".to_owned(),
            IpAddr::V4(ip) => ip.to_string(),
            IpAddr::V6(ip) => format!("[{ip}]"),
        };
        format!("http://{host}:{}/", self.address.port())
    }

    /// Answers requests until an interrupt, and ends at most a second after it.
    ///
    /// # Errors
    ///
    /// The system cannot run a server. An error with one client ends that client's connection only.
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
                // A client that goes away concerns nobody else.
                Ok((stream, _)) => drop(tokio::spawn(connections.watch(connection(stream, &site, is_private)))),
                // Such as no free descriptor: those in use become free again.
                Err(_) => time::sleep(PULSE).await,
            }
        }
    }
    let _ = time::timeout(PARTING, connections.shutdown()).await;
    Ok(())
}

/// The connection with one client: a future that ends when the client has gone, or did not send the
/// head of a request in time.
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
