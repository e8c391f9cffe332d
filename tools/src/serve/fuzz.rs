//! Clients that send any bytes. Runs for a second under `cargo test`, and under libFuzzer by
//! `fuzz/run answer_requests`.

use std::sync::{Arc, LazyLock};
use std::time::Duration;

use tempfile::TempDir;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::runtime::Runtime;

use super::range::{self, Part};
use super::{Site, connection};
use crate::page::Asset;

/// Bytes of the file that is served, and of one beside it that is not.
const SERVED: &[u8] = b"0123456789";
const SECRET: &[u8] = b"nobody may read this";

/// Longest time of a connection, on the clock of the runtime, which jumps ahead when all tasks
/// wait.
const LONGEST: Duration = Duration::from_secs(60);

/// A site of a page and a file. The folder goes with the process.
static SITE: LazyLock<(TempDir, Arc<Site>)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let (served, secret) = (folder.path().join("served.neph"), folder.path().join("secret.neph"));
    std::fs::write(&served, SERVED).unwrap();
    std::fs::write(&secret, SECRET).unwrap();
    let page = Asset { name: "index.html", content_type: "text/html", bytes: b"<p>page" };
    let site = Site::new(&[page], &[served], true).unwrap();
    (folder, Arc::new(site))
});

thread_local! {
    static RUNTIME: Runtime =
        tokio::runtime::Builder::new_current_thread().enable_all().start_paused(true).build().unwrap();
}

#[test]
fn answer_requests() {
    bolero::check!().for_each(|bytes: &[u8]| {
        check_range(bytes);
        let answered = RUNTIME.with(|runtime| runtime.block_on(converse(bytes)));
        check_answers(bytes, &answered);
    });
}

/// All that a client gets which sends bytes and waits until the server has had enough.
async fn converse(bytes: &[u8]) -> Vec<u8> {
    let (mut client, server) = tokio::io::duplex(1 << 20);
    let mut answered = Vec::new();
    let conversation = async {
        let speak = async {
            // A server that has had enough already hears no more.
            let _ = client.write_all(bytes).await;
            client.read_to_end(&mut answered).await
        };
        tokio::join!(connection(server, &SITE.1, true), speak)
    };
    let (_, read) = tokio::time::timeout(LONGEST, conversation).await.expect("a client holds its connection");
    read.unwrap();
    answered
}

/// Answers begin as HTTP does, report no fault of the server, and hold only what the site lists.
fn check_answers(bytes: &[u8], answered: &[u8]) {
    let holds = |part: &[u8]| answered.windows(part.len()).any(|window| window == part);
    assert!(answered.is_empty() || answered.starts_with(b"HTTP/1."), "{}", answered.escape_ascii());
    assert!(!holds(b"HTTP/1.1 5") && !holds(b"HTTP/1.0 5"), "{}", answered.escape_ascii());
    assert!(!holds(SECRET), "{}", answered.escape_ascii());
    // A request takes some bytes, an answer its head and at most the longest body.
    assert!(answered.len() <= 1024 * (1 + bytes.len() / 10), "{} bytes for {}", answered.len(), bytes.len());
}

/// The bytes as the value of a range: what they ask for is inside the file.
fn check_range(bytes: &[u8]) {
    let Ok(header) = std::str::from_utf8(bytes) else { return };
    for n_bytes in [0, 1, 10, u64::MAX] {
        if let Part::Bytes { first, last } = range::part(header, n_bytes) {
            assert!(first <= last && last < n_bytes, "{header:?} of {n_bytes}");
        }
    }
}
