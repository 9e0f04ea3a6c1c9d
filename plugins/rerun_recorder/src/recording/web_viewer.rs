//! rerun's web viewer, and a recording for it to show, on a port of this machine.

use std::fs::File;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};

use thiserror::Error;
use tiny_http::{Header, Request, Response, Server};

/// Threads that answer: a browser asks for the viewer and the recording at once.
const THREADS: usize = 4;
/// Path of the recording.
const RECORDING: &str = "/recording.rrd";

/// Tells the browser to load nothing from elsewhere.
const FROM_HERE: &str = "default-src 'self' data: blob: 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval'";

/// Path, type and content of the files of the viewer.
static FILES: [(&str, &str, &[u8]); 6] = [
    ("/", "text/html", include_bytes!(concat!(env!("OUT_DIR"), "/index.html"))),
    ("/index.html", "text/html", include_bytes!(concat!(env!("OUT_DIR"), "/index.html"))),
    ("/favicon.ico", "image/x-icon", include_bytes!(concat!(env!("OUT_DIR"), "/favicon.ico"))),
    ("/sw.js", "text/javascript", include_bytes!(concat!(env!("OUT_DIR"), "/sw.js"))),
    ("/re_viewer.js", "text/javascript", include_bytes!(concat!(env!("OUT_DIR"), "/re_viewer.js"))),
    (
        "/re_viewer_bg.wasm",
        "application/wasm",
        include_bytes!(concat!(env!("OUT_DIR"), "/re_viewer_bg.wasm")),
    ),
];

/// Why the web viewer cannot be served.
#[derive(Debug, Error)]
pub enum WebViewerError {
    /// The recording cannot be read.
    #[error("the recording `{}` cannot be read: {error}", path.display())]
    Recording {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The port cannot be used.
    #[error("the port {port} of this machine cannot be used: {error}")]
    Port {
        /// The port.
        port: u16,
        /// Why.
        error: Box<dyn std::error::Error + Send + Sync>,
    },
}

/// Serves the viewer and one recording, to this machine only, until it is dropped.
pub struct WebViewer {
    server: Arc<Server>,
    threads: Vec<JoinHandle<()>>,
}

impl WebViewer {
    /// Starts to serve on a port of the loopback address, 0 for any free one.
    ///
    /// # Errors
    /// The recording cannot be read, or the port is taken.
    pub fn start(recording: &Path, port: u16) -> Result<Self, WebViewerError> {
        let unreadable = |error| WebViewerError::Recording { path: recording.to_owned(), error };
        File::open(recording).map_err(unreadable)?;
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let server = Server::http(address).map_err(|error| WebViewerError::Port { port, error })?;
        let server = Arc::new(server);
        let serve = |_| {
            let (server, recording) = (Arc::clone(&server), recording.to_owned());
            thread::spawn(move || {
                // The end is an error here: `drop` unblocks every thread once.
                while let Ok(request) = server.recv() {
                    // A browser that hangs up is its own business.
                    let _ = answer(request, &recording);
                }
            })
        };
        let threads = (0..THREADS).map(serve).collect();
        Ok(Self { server, threads })
    }

    /// The page that shows the recording.
    pub fn url(&self) -> String {
        let origin = self.origin();
        format!("{origin}/?url={origin}{RECORDING}")
    }

    fn origin(&self) -> String {
        format!("http://{}", self.server.server_addr())
    }

    /// Serves until the program is ended.
    pub fn wait(mut self) {
        for thread in std::mem::take(&mut self.threads) {
            // A thread that has panicked serves no longer, which is all there is to know.
            let _ = thread.join();
        }
    }
}

impl Drop for WebViewer {
    fn drop(&mut self) {
        for _ in &self.threads {
            self.server.unblock();
        }
        for thread in self.threads.drain(..) {
            // As above.
            let _ = thread.join();
        }
    }
}

/// Whether the request was sent to this machine by its name: a page from elsewhere that has made its own name
/// point here was not.
fn is_local(request: &Request) -> bool {
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    let host = host.map_or("", |header| header.value.as_str());
    let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
    ["127.0.0.1", "localhost", ""].contains(&name)
}

fn answer(request: Request, recording: &Path) -> io::Result<()> {
    if !is_local(&request) {
        return request.respond(Response::empty(403));
    }
    let path = request.url().split('?').next().unwrap_or_default();
    if path == RECORDING {
        return match File::open(recording) {
            Ok(file) => request.respond(Response::from_file(file)),
            Err(_) => request.respond(Response::empty(404)),
        };
    }
    match FILES.iter().find(|(name, ..)| *name == path) {
        Some((_, kind, content)) => {
            let length = content.len().to_string();
            let mut response = Response::from_data(*content);
            // The page shows how much of the viewer has arrived by a length that chunks do not hide.
            for (name, value) in [
                ("Content-Type", *kind),
                ("rerun-final-length", length.as_str()),
                ("Content-Security-Policy", FROM_HERE),
            ] {
                if let Ok(header) = Header::from_bytes(name, value) {
                    response.add_header(header);
                }
            }
            request.respond(response)
        }
        None => request.respond(Response::empty(404)),
    }
}
