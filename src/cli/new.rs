//! `meshless new`: a commented scene to start from.

use std::path::{Path, PathBuf};

use clap::Args;
use meshless_engine::record::{Existing, write_atomically};
use meshless_engine::scene::unknown;

use super::failure::CommandFailure;
use super::text::{TextTable, program, quoted, say};

/// Write a commented scene to start from; without a name, list those that there are
#[derive(Args)]
pub struct NewArguments {
    /// Name of the template
    #[arg(value_name = "TEMPLATE")]
    template: Option<String>,
    /// File to write [default: <template>.ron]
    #[arg(value_name = "FILE", requires = "template")]
    file: Option<PathBuf>,
}

struct SceneTemplate {
    name: &'static str,
    text: &'static str,
}

macro_rules! templates {
    ($($name:literal),+ $(,)?) => {
        [$(SceneTemplate { name: $name, text: include_str!(concat!("../../assets/scenes/", $name, ".ron")) }),+]
    };
}

/// The scenes of the project are the templates, except those that need a file beside them.
const TEMPLATES: &[SceneTemplate] = &templates![
    "cantilever",
    "oscillating_plate",
    "rubber_pull",
    "punch",
    "quarter_punch",
    "colliding_rings",
    "patch_breathing",
    "thrown_ring",
    "turek_hron_csm3",
    "cook_membrane",
    "bending_column",
    "bending_cylinder",
    "twisting_column",
    "taylor_bar",
    "tensile_specimen",
    "brittle_bar",
    "projectile",
    "metal_cutting",
    "abrasive_flow",
    "abrasive_flow_3d",
    "dam_break",
    "dam_break_3d",
    "dam_break_obstacle",
    "elastic_gate",
    "water_on_plate",
    "floating_box",
    "sloshing",
    "taylor_green",
    "vortex_street",
];

impl SceneTemplate {
    /// The first line of the comment that a scene begins with.
    fn about(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches('/').trim()
    }
}

/// Writes the template, or lists all.
pub fn execute(arguments: NewArguments) -> Result<(), CommandFailure> {
    let Some(name) = arguments.template else {
        say(&list());
        return Ok(());
    };
    let Some(template) = TEMPLATES.iter().find(|template| template.name == name) else {
        let known: Vec<&str> = TEMPLATES.iter().map(|template| template.name).collect();
        let (message, helps) = unknown("template", &name, &known);
        return Err(CommandFailure::Usage(format!("{message}\n{}", helps.join("\n"))));
    };
    let file = arguments.file.unwrap_or_else(|| Path::new(&name).with_extension("ron"));
    write_atomically(&file, Existing::Refuse, |to| to.write_all(template.text.as_bytes()))
        .map_err(|error| CommandFailure::Run(error.to_string()))?;
    say(&format!(
        "wrote {}; run it with: {} run {}",
        file.display(),
        program(),
        quoted(&file.display().to_string())
    ));
    Ok(())
}

fn list() -> String {
    let mut table = TextTable::new(&["template", "what it shows"], 0);
    for template in TEMPLATES {
        table.row([template.name.to_owned(), template.about().to_owned()]);
    }
    table.render() + "\n`meshless new TEMPLATE [FILE]` writes one"
}
