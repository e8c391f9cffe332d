//! `nephrite view` serves the page and the files named, in parts, to this machine, and nothing else
//! to nobody else.
#![cfg(feature = "view")]
#![allow(clippy::expect_used, reason = "a panic is how a test fails")]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use support::Workplace;

/// A running server.
struct Viewer {
    child: Child,
    address: String,
}

impl Viewer {
    fn start(place: &Workplace, files: &[&str]) -> Self {
        let words = ["view", "--no-open", "--json"].iter().chain(files);
        let mut child = place.command(words).stdout(Stdio::piped()).spawn().expect("the program starts");
        let mut line = String::new();
        let stdout = child.stdout.as_mut().expect("piped");
        BufReader::new(stdout).read_line(&mut line).expect("one line");
        let report: serde_json::Value = serde_json::from_str(&line).expect("JSON");
        let url = report["url"].as_str().expect("an address");
        let address = url.trim_start_matches("http://").trim_end_matches('/').to_owned();
        assert!(address.starts_with("127.0.0.1:"), "{address}");
        Self { child, address }
    }

    /// The answer to a request of these lines, split into head and body.
    fn answer(&self, lines: &[&str]) -> (String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.address).expect("the server is there");
        let request = lines.join("\r\n") + "\r\nConnection: close\r\n\r\n";
        stream.write_all(request.as_bytes()).expect("it listens");
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).expect("it answers");
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8(bytes[..end].to_vec()).expect("text").to_lowercase();
        (head, bytes.split_off(end + 4))
    }

    /// As [`answer`](Self::answer), for a path and further headers.
    fn get(&self, path: &str, headers: &[&str]) -> (String, Vec<u8>) {
        let (first, host) = (format!("GET {path} HTTP/1.1"), format!("Host: {}", self.address));
        self.answer(&[&[first.as_str(), host.as_str()], headers].concat())
    }

    #[cfg(unix)]
    fn interrupt(mut self) -> i32 {
        let killed = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status();
        assert!(killed.expect("kill is there").success());
        self.child.wait().expect("the program ends").code().expect("a status")
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A folder with `ball.neph`, and its bytes; `None` if npm was missing when the program was
/// built.
fn place_with_file() -> Option<(Workplace, Vec<u8>)> {
    let place = Workplace::new();
    place.done("generate sphere -o in.ply");
    place.done("build in.ply -o ball.neph");
    if place.run("view ball.neph --export site").stderr.contains("the page: npm is missing") {
        return None;
    }
    let bytes = place.read("ball.neph");
    Some((place, bytes))
}

#[test]
fn files_come_in_parts() {
    let Some((place, bytes)) = place_with_file() else { return };
    let viewer = Viewer::start(&place, &["ball.neph"]);
    let (head, body) = viewer.get("/files/ball.neph", &[]);
    assert!(head.starts_with("http/1.1 200") && head.contains("accept-ranges: bytes"), "{head}");
    assert!(body == bytes, "the whole file");
    let tag = head.lines().find_map(|line| line.strip_prefix("etag: ")).expect("a tag").to_owned();

    let (head, body) = viewer.get("/files/ball.neph", &["Range: bytes=100-299"]);
    assert!(head.starts_with("http/1.1 206"), "{head}");
    assert!(head.contains(&format!("content-range: bytes 100-299/{}", bytes.len())), "{head}");
    assert!(head.contains("content-length: 200") && head.contains(&format!("etag: {tag}")), "{head}");
    assert!(body == bytes[100..300]);

    let if_range = format!("If-Range: {tag}");
    let (_, body) = viewer.get("/files/ball.neph", &["Range: bytes=-5", &if_range]);
    assert!(body == bytes[bytes.len() - 5..]);
    let (head, _) = viewer.get("/files/ball.neph", &["Range: bytes=0-4", "If-Range: \"other\""]);
    assert!(head.starts_with("http/1.1 200"), "another version is sent whole: {head}");

    let (head, _) = viewer.get("/files/ball.neph", &[&format!("Range: bytes={}-", bytes.len())]);
    assert!(head.starts_with("http/1.1 416"), "{head}");
    assert!(head.contains(&format!("content-range: bytes */{}", bytes.len())), "{head}");

    let host = format!("Host: {}", viewer.address);
    let (head, body) = viewer.answer(&["HEAD /files/ball.neph HTTP/1.1", &host]);
    assert!(head.contains(&format!("content-length: {}", bytes.len())) && body.is_empty(), "{head}");
}

#[test]
fn a_replaced_file_has_another_tag() {
    let Some((place, bytes)) = place_with_file() else { return };
    let viewer = Viewer::start(&place, &["ball.neph"]);
    let tag = || {
        let (head, _) = viewer.get("/files/ball.neph", &["Range: bytes=0-0"]);
        head.lines().find_map(|line| line.strip_prefix("etag: ")).expect("a tag").to_owned()
    };
    let before = tag();
    assert_eq!(before, tag());
    place.write("ball.neph", &bytes[..bytes.len() - 1]);
    assert_ne!(before, tag());
    std::fs::remove_file(place.path("ball.neph")).expect("it was there");
    assert!(viewer.get("/files/ball.neph", &[]).0.starts_with("http/1.1 404"));
}

#[test]
fn nothing_else_is_served() {
    let Some((place, _)) = place_with_file() else { return };
    place.write("secret.txt", "secret");
    let viewer = Viewer::start(&place, &["ball.neph"]);
    for path in [
        "/secret.txt",
        "/files/../secret.txt",
        "/files/..%2fsecret.txt",
        "/files/%2e%2e/secret.txt",
        "/..//secret.txt",
        "//secret.txt",
        "/files/in.ply",
        "/files/",
        "/files/ball.neph/",
        "/etc/passwd",
        "/%00",
    ] {
        let (head, body) = viewer.get(path, &[]);
        assert!(head.starts_with("http/1.1 404"), "{path}: {head}");
        assert!(!String::from_utf8_lossy(&body).contains("secret"), "{path}");
    }
    let host = format!("Host: {}", viewer.address);
    for method in ["POST", "PUT", "DELETE", "OPTIONS"] {
        let (head, _) = viewer.answer(&[&format!("{method} /files/ball.neph HTTP/1.1"), &host]);
        assert!(head.starts_with("http/1.1 405"), "{head}");
    }
    // A page of another site whose name was made to point here.
    let (head, _) = viewer.answer(&["GET /files/ball.neph HTTP/1.1", "Host: evil.example"]);
    assert!(head.starts_with("http/1.1 421"), "{head}");
    let (head, _) = viewer.answer(&["nonsense"]);
    assert!(head.starts_with("http/1.1 400"), "{head}");
    assert!(viewer.get("/", &[]).0.starts_with("http/1.1 200"), "and it still answers");
}

#[test]
#[cfg(unix)]
fn an_interrupt_ends_it_cleanly() {
    let Some((place, _)) = place_with_file() else { return };
    let viewer = Viewer::start(&place, &["ball.neph", "ball.neph"]);
    let (_, list) = viewer.get("/files.json", &[]);
    let list: serde_json::Value = serde_json::from_slice(&list).expect("JSON");
    assert_eq!(list["files"][1]["url"], "files/ball-2.neph");
    // A connection that says nothing keeps nobody waiting.
    let _idle = TcpStream::connect(&viewer.address).expect("the server is there");
    assert_eq!(viewer.interrupt(), 0);
}

#[test]
fn what_cannot_be_served_is_told() {
    let Some((place, bytes)) = place_with_file() else { return };
    assert!(place.failure("view none.neph --no-open").contains("none.neph"));
    assert!(place.failure("view . --no-open").contains("is not a file"));
    place.write("README.md", "# About\n");
    let failure = place.failure("view README.md --no-open");
    assert!(failure.starts_with("nephrite: README.md: ") && failure.contains(".neph"), "{failure}");
    let failure = place.failure("view ball.neph in.ply --no-open");
    assert!(failure.ends_with("build a file of it first: nephrite build in.ply -o in.neph"), "{failure}");
    place.write("cut.neph", &bytes[..bytes.len() - 1]);
    assert!(place.failure("view cut.neph --no-open").starts_with("nephrite: cut.neph: "));
    place.write("head.neph", &bytes[..100]);
    assert!(place.failure("view head.neph --export other").starts_with("nephrite: head.neph: "));
    assert!(!place.path("other").exists());
    assert!(place.failure("view ball.neph --no-open --address 192.0.2.1").contains("192.0.2.1"));
    let viewer = Viewer::start(&place, &["ball.neph"]);
    let port = viewer.address.rsplit(':').next().expect("a port");
    assert!(place.failure(&format!("view ball.neph --no-open --port {port}")).contains(port));
    // Exported into its own place, a file would be replaced by itself.
    std::fs::create_dir(place.path("files")).expect("a folder");
    place.write("files/ball.neph", &bytes);
    assert!(place.failure("view files/ball.neph --export .").contains("is the input"));
}

#[test]
fn an_export_is_the_same_site() {
    let Some((place, bytes)) = place_with_file() else { return };
    let report = place.json("view ball.neph --export site");
    assert_eq!(report["files"], 1);
    assert!(place.read("site/files/ball.neph") == bytes);
    let viewer = Viewer::start(&place, &["ball.neph"]);
    for name in ["index.html", "page.js", "page.css", "worker.js", "LICENSES.txt"] {
        assert!(viewer.get(&format!("/{name}"), &[]).1 == place.read(&format!("site/{name}")), "{name}");
    }
    let list = String::from_utf8(place.read("site/files.json")).expect("text");
    assert!(list.contains("\"live\":false"), "{list}");
}
