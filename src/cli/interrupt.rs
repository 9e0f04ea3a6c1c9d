//! Signals: the first one asks the run to end after its step, the second one ends the program.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};

use super::failure::CommandFailure;
use super::text::complain;

/// Number of the signal that has requested the end of the run, 0 for none; one for the program.
static ASKED: AtomicU8 = AtomicU8::new(0);

/// Whether the end of the run has been requested.
#[derive(Clone, Copy)]
pub struct Interrupt(());

impl Interrupt {
    /// Listens for Ctrl-C and for the request of the system to end; once for all runs of the program.
    pub fn listen() -> Result<Self, CommandFailure> {
        static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
        match LISTENING.get_or_init(|| listen(stop).map_err(|error| error.to_string())) {
            Ok(()) => Ok(Self(())),
            Err(error) => Err(CommandFailure::Run(format!("cannot listen for signals: {error}"))),
        }
    }

    /// Whether the end of the run has been requested.
    pub fn asked(self) -> bool {
        self.signal() != 0
    }

    /// The number of the signal that has requested the end of the run, 0 for none.
    pub fn signal(self) -> u8 {
        ASKED.load(Ordering::SeqCst)
    }
}

/// Stores the number of a signal.
fn stop(signal: u8) {
    if ASKED.swap(signal, Ordering::SeqCst) != 0 {
        std::process::exit(i32::from(exit_code(signal)));
    }
    complain("stopping after this step; another signal ends the program at once");
}

/// The exit code of a program ended by a signal, as in shells: 130 for Ctrl-C, 143 for SIGTERM, 129 for
/// SIGHUP.
pub fn exit_code(signal: u8) -> u8 {
    128 + signal
}

/// Calls `then` with the number of each signal to stop, on a thread of its own. SIGHUP stays ignored if the
/// program was started so, as by `nohup`; Ctrl-C also stops a program that a script has started in the
/// background.
#[cfg(unix)]
fn listen(then: fn(u8)) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let mut heard = vec![SIGINT, SIGTERM];
    if ignored() >> (SIGHUP - 1) & 1 == 0 {
        heard.push(SIGHUP);
    }
    let mut signals = signal_hook::iterator::Signals::new(heard)?;
    std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
        for signal in signals.forever() {
            then(u8::try_from(signal).unwrap_or(u8::MAX - 128));
        }
    })?;
    Ok(())
}

/// The ignored signals, one bit each, from Linux; none if unknown.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// The same on systems with Ctrl-C only.
#[cfg(not(unix))]
fn listen(then: fn(u8)) -> Result<(), ctrlc::Error> {
    /// Number of the signal of Ctrl-C.
    const SIGINT: u8 = 2;
    ctrlc::set_handler(move || then(SIGINT))
}
