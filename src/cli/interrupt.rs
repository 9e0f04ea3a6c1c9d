//! Ctrl-C: the first one asks the run to end after its step, the second one ends the program.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use super::failure::Failure;
use super::text::complain;

/// Whether the user has asked to stop; one for the program, as there is one Ctrl-C.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether the user has asked to stop.
#[derive(Clone, Copy)]
pub struct Interrupt(());

impl Interrupt {
    /// Listens for Ctrl-C and for the request of the system to end; once for all runs of the program.
    pub fn listen() -> Result<Self, Failure> {
        static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
        let handler = || {
            if ASKED.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
            complain("stopping after this step; a second Ctrl-C ends the program at once");
        };
        let listening =
            LISTENING.get_or_init(|| ctrlc::set_handler(handler).map_err(|error| error.to_string()));
        match listening {
            Ok(()) => Ok(Self(())),
            Err(error) => Err(Failure::Run(format!("cannot listen for Ctrl-C: {error}"))),
        }
    }

    /// Whether the user has asked to stop.
    pub fn asked(self) -> bool {
        ASKED.load(Ordering::SeqCst)
    }
}
