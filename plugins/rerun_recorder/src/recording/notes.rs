//! What is worth knowing of a run, as a page beside the particles.

use std::fmt::Write;

use meshless_engine::record::RunInfo;
use re_sdk_types::archetypes::TextDocument;

/// Title, bodies and sources of a run.
pub struct Notes {
    text: String,
}

impl Notes {
    /// Facts known at the start.
    pub fn new(run: &RunInfo<'_>) -> Self {
        let mut text = format!("# {}\n\nScene `{}`", run.title, run.scene_name);
        // Writing into a string cannot fail.
        let _ = write!(text, ", from {} s to {} s", run.start_time, run.end_time);
        if run.resumed {
            text.push_str(
                ", resumed from a checkpoint: the time before is in the recording of the earlier run",
            );
        }
        text.push_str("\n\n| body | particles | spacing [m] |\n|---|---|---|\n");
        for body in run.bodies {
            let _ = writeln!(text, "| {} | {} | {} |", body.name, body.particles, 2.0 * body.radius);
        }
        if !run.references.is_empty() {
            text.push_str("\n## Methods\n\n");
            for reference in run.references {
                let _ = writeln!(text, "- {reference}");
            }
        }
        Self { text }
    }

    /// The page, with what the user should look at.
    pub fn document(&self, warnings: &[String]) -> TextDocument {
        let mut text = self.text.clone();
        if !warnings.is_empty() {
            text.push_str("\n## Warnings\n\n");
            for warning in warnings {
                let _ = writeln!(text, "- {warning}");
            }
        }
        TextDocument::from_markdown(text)
    }
}
