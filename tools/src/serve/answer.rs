//! The answer to a request.

use std::fs::Metadata;
use std::io::{self, SeekFrom};
use std::path::Path;
use std::time::UNIX_EPOCH;

use futures_util::TryStreamExt;
use http_body_util::{BodyExt, Empty, Full, StreamBody, combinators::BoxBody};
use hyper::body::{Bytes, Frame};
use hyper::header::{self, HeaderMap, HeaderName, HeaderValue};
use hyper::http::response::Builder;
use hyper::{Method, Request, Response, StatusCode};
use tokio::fs::File;
use tokio::io::{AsyncReadExt, AsyncSeekExt};
use tokio_util::io::ReaderStream;

use super::range::{self, Part};
use super::site::{Body, Site};

/// A response with any of the bodies below.
pub(super) type Answer = Response<BoxBody<Bytes, io::Error>>;

/// Bytes of a file that are in memory at a time for one answer.
const READ_BYTES: usize = 1 << 16;

/// Headers of every answer. They forbid the page to load anything from elsewhere, and isolate it
/// from other pages, which gives it a clock fine enough to time queries.
const ALWAYS: [(HeaderName, &str); 7] = [
    (header::CACHE_CONTROL, "no-store"),
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'",
    ),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-embedder-policy"), "require-corp"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Answers one request. `is_private` is true if only this machine can reach the server.
pub(super) async fn answer<B>(site: &Site, is_private: bool, request: &Request<B>) -> Answer {
    let refuse = |status, words: &'static str| finish(plain(status), Bytes::from_static(words.as_bytes()));
    if is_private && !names_this_machine(request.headers()) {
        // A page on the web could make its own name point here, and read the files.
        return refuse(StatusCode::MISDIRECTED_REQUEST, "this server answers only to its own address\n");
    }
    if !matches!(*request.method(), Method::GET | Method::HEAD) {
        let builder = plain(StatusCode::METHOD_NOT_ALLOWED).header(header::ALLOW, "GET, HEAD");
        return finish(builder, Bytes::from_static(b"only GET and HEAD\n"));
    }
    let Some(entry) = site.find(request.uri().path()) else {
        return refuse(StatusCode::NOT_FOUND, "there is nothing at this address\n");
    };
    let mut answer = match &entry.body {
        Body::Bytes(bytes) => {
            let builder = start(StatusCode::OK).header(header::CONTENT_TYPE, entry.content_type);
            finish(builder, Bytes::copy_from_slice(bytes))
        }
        Body::File(path) => match file(path, request.headers(), entry.content_type).await {
            Ok(answer) => answer,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                refuse(StatusCode::NOT_FOUND, "the file is no longer there\n")
            }
            Err(_) => refuse(StatusCode::INTERNAL_SERVER_ERROR, "the file cannot be read\n"),
        },
    };
    if request.method() == Method::HEAD {
        *answer.body_mut() = Empty::new().map_err(|never| match never {}).boxed();
    }
    answer
}

/// The file, or the part of it that is asked for. It is opened for this answer: a file that was
/// replaced is another file, with another tag.
async fn file(path: &Path, headers: &HeaderMap, content_type: &str) -> io::Result<Answer> {
    let mut file = File::open(path).await?;
    let metadata = file.metadata().await?;
    let (n_bytes, tag) = (metadata.len(), tag(&metadata));
    let part = match (headers.get(header::RANGE), headers.get(header::IF_RANGE)) {
        (Some(_), Some(seen)) if seen.as_bytes() != tag.as_bytes() => Part::Whole,
        (Some(range), _) => range.to_str().map_or(Part::Whole, |range| range::part(range, n_bytes)),
        (None, _) => Part::Whole,
    };
    let (status, first, n_sent) = match part {
        Part::Whole => (StatusCode::OK, 0, n_bytes),
        Part::Bytes { first, last } => (StatusCode::PARTIAL_CONTENT, first, last - first + 1),
        Part::Beyond => {
            let builder = plain(StatusCode::RANGE_NOT_SATISFIABLE)
                .header(header::CONTENT_RANGE, format!("bytes */{n_bytes}"))
                .header(header::ETAG, tag);
            return Ok(finish(builder, Bytes::from_static(b"the file ends before that\n")));
        }
    };
    let mut builder = start(status)
        .header(header::CONTENT_TYPE, content_type)
        .header(header::CONTENT_LENGTH, n_sent)
        .header(header::ACCEPT_RANGES, "bytes")
        .header(header::ETAG, tag);
    if status == StatusCode::PARTIAL_CONTENT {
        let range = format!("bytes {first}-{}/{n_bytes}", first + n_sent - 1);
        builder = builder.header(header::CONTENT_RANGE, range);
    }
    file.seek(SeekFrom::Start(first)).await?;
    let stream = ReaderStream::with_capacity(file.take(n_sent), READ_BYTES);
    let body = BodyExt::boxed(StreamBody::new(stream.map_ok(Frame::data)));
    builder.body(body).map_err(io::Error::other)
}

/// Changes whenever the file does: its length and the time of its last change.
fn tag(metadata: &Metadata) -> String {
    let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("\"{:x}-{:x}\"", metadata.len(), changed.map_or(0, |since| since.as_nanos()))
}

/// Whether a request names the server as this machine is named from itself.
fn names_this_machine(headers: &HeaderMap) -> bool {
    let Some(host) = headers.get(header::HOST).and_then(|host| host.to_str().ok()) else {
        return false;
    };
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    let address = name.trim_start_matches('[').trim_end_matches(']');
    name.eq_ignore_ascii_case("localhost")
        || address.parse::<std::net::IpAddr>().is_ok_and(|address| address.is_loopback())
}

fn start(status: StatusCode) -> Builder {
    ALWAYS.iter().fold(Response::builder().status(status), |builder, (name, value)| {
        builder.header(name, HeaderValue::from_static(value))
    })
}

fn plain(status: StatusCode) -> Builder {
    start(status).header(header::CONTENT_TYPE, "text/plain; charset=utf-8")
}

/// Headers are constants or made of digits, so that nothing is wrong with them.
fn finish(builder: Builder, bytes: Bytes) -> Answer {
    let builder = builder.header(header::CONTENT_LENGTH, bytes.len());
    let body = Full::new(bytes).map_err(|never| match never {}).boxed();
    builder.body(body).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_answered() {
        let names = |host: &str| {
            let headers = HeaderMap::from_iter([(header::HOST, HeaderValue::from_str(host).unwrap())]);
            names_this_machine(&headers)
        };
        for host in ["127.0.0.1:8080", "localhost:1", "LOCALHOST", "[::1]:8080", "[::1]", "127.1.2.3"] {
            assert!(names(host), "{host}");
        }
        for host in ["example.org", "127.0.0.1.example.org:80", "localhost.example.org", "10.0.0.1:80", ""] {
            assert!(!names(host), "{host}");
        }
        assert!(!names_this_machine(&HeaderMap::new()));
    }
}
