//! The text of `meshless --version`: enough to build the same program again.

/// Version of the viewer whose recordings the program writes.
#[cfg(feature = "rerun")]
const FEATURES: &str = "rerun 0.36.3";
#[cfg(not(feature = "rerun"))]
const FEATURES: &str = "none (built without rerun)";

/// Version, revision and features.
pub fn long() -> &'static str {
    static TEXT: std::sync::OnceLock<String> = std::sync::OnceLock::new();
    TEXT.get_or_init(written)
}

fn written() -> String {
    let revision = option_env!("MESHLESS_REVISION").unwrap_or("unknown");
    format!(
        "{}\nrevision: {revision}\nfeatures: {FEATURES}\ninstruction path: {}",
        env!("CARGO_PKG_VERSION"),
        meshless_engine::parallel::instruction_path()
    )
}
