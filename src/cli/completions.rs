//! `meshless completions` and `meshless manual`: the command line for shells and for `man`.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::commands::CommandLine;
use super::failure::CommandFailure;
use super::text::say;

/// Print the completions of a shell: `meshless completions
/// bash > ~/.local/share/bash-completion/completions/meshless`
#[derive(Args)]
pub struct CompletionsArguments {
    /// Shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Print the manual page: `meshless manual > ~/.local/share/man/man1/meshless.1`
#[derive(Args)]
pub struct Manual {}

/// Prints the completions.
pub fn execute(arguments: &CompletionsArguments) -> Result<(), CommandFailure> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut CommandLine::command(), "meshless", &mut text);
    say(&String::from_utf8_lossy(&text));
    Ok(())
}

/// Prints the manual page, with a section for every command.
pub fn manual() -> Result<(), CommandFailure> {
    let mut command = CommandLine::command();
    command.build();
    let mut text = Vec::new();
    let failed = |error: std::io::Error| CommandFailure::Run(error.to_string());
    clap_mangen::Man::new(command.clone()).render(&mut text).map_err(failed)?;
    for sub in command.get_subcommands() {
        let man = clap_mangen::Man::new(sub.clone());
        text.extend(format!(".SH COMMAND {}\n", sub.get_name().to_uppercase()).bytes());
        man.render_description_section(&mut text).map_err(failed)?;
        man.render_options_section(&mut text).map_err(failed)?;
    }
    say(&String::from_utf8_lossy(&text));
    Ok(())
}
