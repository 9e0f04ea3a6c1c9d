//! The commands of the program. A command is a file and a line in [`Command`] and in [`Command::execute`].

use std::io::{self, ErrorKind};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use meshless_engine::plugin::Registry;

use super::failure::CommandFailure;
use super::text::unsaid;
use super::{
    bench, check, completions, new, picture, plugins, ranks, resume, schema, surface, sweep, validate,
    version, view,
};

/// Particle simulation of solids, fluids and their interaction by smoothed particle hydrodynamics.
#[derive(Parser)]
#[command(name = "meshless", version, long_version = version::long(), arg_required_else_help = true, after_help = EXIT_CODES)]
pub(super) struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(super::run::RunArguments),
    Resume(resume::ResumeArguments),
    Sweep(sweep::SweepArguments),
    Check(check::CheckArguments),
    Bench(bench::BenchArguments),
    New(new::NewArguments),
    Plugins(plugins::PluginsArguments),
    Schema(schema::SchemaArguments),
    Validate(validate::ValidateArguments),
    View(view::ViewArguments),
    Picture(picture::PictureArguments),
    Surface(surface::SurfaceArguments),
    Completions(completions::CompletionsArguments),
    Manual(completions::Manual),
}

const EXIT_CODES: &str = "\
exit codes: 0 success, 1 the run failed or a file could not be read or written, 2 the scene or the command line is wrong,
130 stopped by Ctrl-C (SIGINT), 143 by the system (SIGTERM), 129 as the terminal closed (SIGHUP), each with a checkpoint left";

impl Command {
    fn execute(self, registry: &Registry) -> Result<(), CommandFailure> {
        if !matches!(self, Self::Run(_) | Self::Resume(_) | Self::Bench(_)) {
            ranks::require_one()?;
        }
        match self {
            Self::Run(arguments) => super::run::execute(arguments, registry),
            Self::Resume(arguments) => resume::execute(arguments, registry),
            Self::Sweep(arguments) => sweep::execute(&arguments, registry),
            Self::Check(arguments) => check::execute(&arguments, registry),
            Self::Bench(arguments) => bench::execute(&arguments, registry),
            Self::New(arguments) => new::execute(arguments),
            Self::Plugins(arguments) => plugins::execute(&arguments, registry),
            Self::Schema(arguments) => schema::execute(&arguments, registry),
            Self::Validate(arguments) => validate::execute(&arguments, registry),
            Self::View(arguments) => view::execute(&arguments),
            Self::Picture(arguments) => picture::execute(&arguments),
            Self::Surface(arguments) => surface::execute(&arguments),
            Self::Completions(arguments) => completions::execute(&arguments),
            Self::Manual(_) => completions::manual(),
        }
    }
}

/// Runs the program with its command-line arguments: the whole `main` of a program that runs scenes.
pub fn run(registry: Registry) -> ExitCode {
    ranks::let_the_first_speak();
    let command = match CommandLine::try_parse() {
        Ok(line) => line.command,
        Err(error) => {
            // Help and version are also reported this way; a closed output stream is no failure.
            return match error.print() {
                Err(lost) if !error.use_stderr() && lost.kind() != ErrorKind::BrokenPipe => {
                    ended(Err(unwritten(&lost)))
                }
                _ => ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2)),
            };
        }
    };
    ended(command.execute(&registry).and_then(|()| unsaid().map_or(Ok(()), |error| Err(unwritten(&error)))))
}

fn unwritten(error: &io::Error) -> CommandFailure {
    CommandFailure::Run(format!("cannot write to the standard output: {error}"))
}

/// Reports a failure and returns the exit code.
fn ended(done: Result<(), CommandFailure>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.code())
        }
    }
}
