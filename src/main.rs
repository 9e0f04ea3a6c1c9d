//! The `meshless` program: the command line with the standard plugins.

fn main() -> std::process::ExitCode {
    meshless::cli::run(meshless::standard_plugins())
}
