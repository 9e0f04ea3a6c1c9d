//! The web viewer is served with a recording.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::Duration;

use rerun_recorder::{WebViewer, WebViewerError};

fn get(address: &str, path: &str) -> (String, Vec<u8>) {
    get_as(address, path, address)
}

/// Head and body of an answer to a request of version 1.0, which is sent in one piece.
fn get_as(address: &str, path: &str, host: &str) -> (String, Vec<u8>) {
    let mut stream = TcpStream::connect(address).expect("somebody listens");
    write!(stream, "GET {path} HTTP/1.0\r\nHost: {host}\r\n\r\n").expect("a request");
    stream.shutdown(Shutdown::Write).expect("the end of the request");
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("an answer");
    let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").expect("a head");
    (String::from_utf8_lossy(&answer[..end]).into_owned(), answer[end + 4..].to_vec())
}

#[test]
fn page_viewer_and_recording_come_over_http_until_the_end() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("two.rrd");
    let recording: Vec<u8> = (0..100_000_u32).map(|k| (k % 251) as u8).collect();
    std::fs::write(&file, &recording).expect("a file");
    let viewer = WebViewer::start(&file, 0).expect("a free port");
    let url = viewer.url();
    let (origin, query) = url.split_once("/?url=").expect("the page is told what to show");
    let address = origin.strip_prefix("http://").expect("an address");
    assert_eq!(query, format!("{origin}/recording.rrd"));

    let (head, page) = get(address, url.strip_prefix(origin).expect("a path"));
    assert!(head.starts_with("HTTP/1.0 200") && head.contains("Content-Type: text/html"), "{head}");
    let page = String::from_utf8_lossy(&page);
    assert!(page.contains("re_viewer.js") && page.contains("<style>"), "{page}");
    // Nothing is loaded from elsewhere, and nothing is served to pages from elsewhere.
    assert!(head.contains("Content-Security-Policy: default-src 'self'"), "{head}");
    assert!(!page.contains("googleapis") && !page.contains("gstatic"), "{page}");
    let asked = |host: &str| get_as(address, "/", host).0;
    assert!(asked("elsewhere.example").starts_with("HTTP/1.0 403"));
    assert!(asked("localhost:8080").starts_with("HTTP/1.0 200"));
    let (head, script) = get(address, "/re_viewer.js");
    assert!(head.contains("Content-Type: text/javascript") && script.len() > 10_000, "{head}");
    let (head, wasm) = get(address, "/re_viewer_bg.wasm");
    assert!(head.contains("Content-Type: application/wasm"), "{head}");
    assert!(wasm.starts_with(b"\0asm") && wasm.len() > 1_000_000, "{} bytes", wasm.len());
    let (head, bytes) = get(address, "/recording.rrd");
    assert!(head.starts_with("HTTP/1.0 200") && bytes == recording, "{head}");
    assert!(get(address, "/../two.rrd").0.starts_with("HTTP/1.0 404"));

    drop(viewer);
    // The thread of the server that accepts connections ends a moment later.
    let closed = (0..500).any(|_| {
        std::thread::sleep(Duration::from_millis(20));
        TcpStream::connect(address).is_err()
    });
    assert!(closed, "the port is not free again");
}

#[test]
fn a_recording_that_is_not_there_and_a_port_that_is_taken_are_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("none.rrd");
    assert!(matches!(WebViewer::start(&file, 0), Err(WebViewerError::Recording { .. })));
    std::fs::write(&file, b"").expect("a file");
    let first = WebViewer::start(&file, 0).expect("a free port");
    let port =
        first.url().split(':').nth(2).and_then(|rest| rest.split('/').next()?.parse().ok()).expect("a port");
    let Err(error) = WebViewer::start(&file, port) else { panic!("the port is taken") };
    assert!(
        error.to_string().contains(&format!("the port {port} of this machine cannot be used")),
        "{error}"
    );
}
