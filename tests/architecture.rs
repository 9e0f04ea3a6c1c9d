//! The architecture itself: who depends on whom, what every plugin has, how long files are.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// What is in a folder, in the order of names.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let read = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut entries: Vec<PathBuf> = read.map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    entries
}

fn plugins() -> Vec<PathBuf> {
    entries(&root().join("plugins")).into_iter().filter(|path| path.is_dir()).collect()
}

fn collect_sources(folder: &Path, sources: &mut Vec<PathBuf>) {
    for path in entries(folder) {
        if path.is_dir() {
            collect_sources(&path, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            sources.push(path);
        }
    }
}

/// Every source file of the project.
fn sources() -> Vec<PathBuf> {
    let mut sources = Vec::new();
    for folder in ["src", "plugins", "tests", "examples"] {
        collect_sources(&root().join(folder), &mut sources);
    }
    sources
}

fn shown(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}

/// The names under `[dependencies]` of a package.
fn dependencies(manifest: &Path) -> Vec<String> {
    let text = read(manifest);
    let section = text.split("[dependencies]").nth(1).expect("a section of dependencies");
    let lines = section.lines().skip(1).take_while(|line| !line.starts_with('['));
    let names = lines.filter_map(|line| line.split(['.', '=', ' ']).next()).filter(|name| !name.is_empty());
    names.filter(|name| !name.starts_with('#')).map(str::to_owned).collect()
}

/// The folders of the engine and of what it stands on.
const ENGINE: [&str; 2] = ["src/engine", "src/base"];

/// Every source file of the engine and of what it stands on.
fn engine_sources() -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in ENGINE {
        collect_sources(&root().join(folder), &mut files);
    }
    files
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

#[test]
fn the_engine_depends_on_no_plugin_and_on_neither_the_viewer_nor_the_command_line() {
    for folder in ENGINE {
        let own = dependencies(&root().join(folder).join("Cargo.toml"));
        assert!(own.contains(&"glam".to_owned()), "the list is read wrongly: {own:?}");
        for plugin in plugins() {
            assert!(!own.contains(&name(&plugin)), "{folder} depends on {}", name(&plugin));
        }
        for other in ["rerun", "clap", "indicatif", "ctrlc", "anyhow", "meshless", "meshless_validation"] {
            assert!(!own.contains(&other.to_owned()), "{folder} depends on {other}");
        }
    }
}

#[test]
fn validation_cases_depend_on_the_engine_alone() {
    let own = dependencies(&root().join("src/validation/Cargo.toml"));
    assert!(own.contains(&"meshless_engine".to_owned()), "the list is read wrongly: {own:?}");
    assert!(!own.contains(&"meshless".to_owned()), "the cases depend on the application");
    for plugin in plugins() {
        assert!(!own.contains(&name(&plugin)), "the cases depend on {}", name(&plugin));
    }
}

#[test]
fn plugins_depend_on_the_engine_and_not_on_each_other() {
    let names: Vec<String> = plugins().iter().map(|plugin| name(plugin)).collect();
    for plugin in plugins() {
        let own = dependencies(&plugin.join("Cargo.toml"));
        assert!(own.contains(&"meshless_engine".to_owned()), "{} does not use the engine", name(&plugin));
        assert!(!own.contains(&"meshless".to_owned()), "{} depends on the application", name(&plugin));
        assert!(own.iter().all(|other| !names.contains(other)), "{} depends on a plugin", name(&plugin));
        let sees_rerun = own.contains(&"rerun".to_owned());
        assert_eq!(sees_rerun, name(&plugin) == "rerun_recorder", "{} and rerun", name(&plugin));
    }
}

#[test]
fn every_plugin_has_a_page_a_scene_and_a_test() {
    for plugin in plugins() {
        for file in ["README.md", "scene.ron"] {
            assert!(plugin.join(file).is_file(), "{} has no {file}", name(&plugin));
        }
        let mut files = Vec::new();
        collect_sources(&plugin, &mut files);
        let tested = files.iter().any(|file| read(file).contains("#[test]"));
        assert!(tested, "{} has no test", name(&plugin));
        let page = read(&plugin.join("README.md"));
        assert!(
            page.starts_with(&format!("# {}\n", name(&plugin))),
            "the page of {} has no title",
            name(&plugin)
        );
    }
}

#[test]
fn files_are_short() {
    let mut lengths: Vec<(usize, String)> =
        sources().iter().map(|path| (read(path).lines().count(), shown(path))).collect();
    lengths.sort();
    let longest = lengths.last().expect("there are sources");
    assert!(longest.0 <= 500, "{} has {} lines", longest.1, longest.0);
    let median = lengths[lengths.len() / 2].0;
    assert!(median <= 150, "the median is {median} lines");
}

#[test]
fn nothing_is_left_open_and_nothing_is_a_grab_bag() {
    let open = ["TO", "DO"].concat();
    for path in sources() {
        assert!(!read(&path).contains(&open), "{} has a {open}", shown(&path));
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let grab_bag = ["utils", "util", "helpers", "misc", "common"].contains(&stem.as_str());
        assert!(!grab_bag, "{} says nothing about what is in it", shown(&path));
    }
}

/// Whether the line begins a function.
fn is_function(line: &str) -> bool {
    let line = line.trim_start();
    let Some(rest) = line.strip_prefix("pub") else { return line.starts_with("fn ") };
    let rest = rest.strip_prefix('(').and_then(|rest| rest.split_once(')')).map_or(rest, |(_, rest)| rest);
    rest.trim_start().starts_with("fn ")
}

#[test]
fn module_files_only_list() {
    // In a folder of tests, `mod.rs` holds what the tests share.
    let of_tests = |path: &Path| path.iter().any(|part| part == "tests");
    let lists = |path: &&PathBuf| name(path) == "mod.rs" && !of_tests(path);
    for path in sources().iter().filter(lists) {
        let text = read(path);
        let others: Vec<&str> =
            text.lines().filter(|line| is_function(line) && !line.contains("fn register(")).collect();
        assert!(others.is_empty(), "{} holds {others:?}", shown(path));
    }
}

/// A function of a file: its name, number of lines, and number of arguments without `self`.
fn functions(text: &str) -> Vec<(String, usize, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (k, line) in lines.iter().enumerate().filter(|(_, line)| is_function(line)) {
        let indent = &line[..line.len() - line.trim_start().len()];
        let ends = |other: &&str| other.strip_prefix(indent).is_some_and(|rest| rest.starts_with('}'));
        let head = lines[k..].iter().position(|line| line.ends_with(['{', ';', '}'])).unwrap_or_default();
        let length = if lines[k + head].ends_with('{') {
            lines[k..].iter().position(ends).unwrap_or_default() + 1
        } else {
            head + 1
        };
        let signature = lines[k..=k + head].join(" ");
        let name = signature.split("fn ").nth(1).unwrap_or_default();
        let name = name.split(['(', '<']).next().unwrap_or_default().to_owned();
        found.push((name, length, arguments(&signature)));
    }
    found
}

/// Number of arguments of a function without `self`: types before a colon at the depth of the list.
fn arguments(signature: &str) -> usize {
    let (mut depth, mut count, mut in_list, mut last) = (0, 0, false, ' ');
    for c in signature[signature.find("fn ").unwrap_or_default()..].chars() {
        match c {
            '(' if depth == 0 && !in_list => in_list = true,
            '(' | '[' | '{' | '<' => depth += 1,
            ')' if depth == 0 => break,
            ')' | ']' | '}' => depth -= 1,
            '>' if last != '-' && last != '=' => depth -= 1,
            // `::` is no end of a name.
            ' ' if depth == 0 && in_list && last == ':' => count += 1,
            _ => {}
        }
        last = c;
    }
    count
}

#[test]
fn functions_of_the_engine_are_short_and_have_few_arguments() {
    let read_rightly = functions("fn f(&self, a: u8, b: &dyn Fn(u8) -> u8) -> u8 {\n    a\n}\n");
    assert_eq!(read_rightly, [("f".to_owned(), 3, 2)]);
    for path in &engine_sources() {
        let file = shown(path);
        let Some(text) = without_tests(path) else { continue };
        for (name, length, arguments) in functions(&text) {
            assert!(length <= 60, "{file}: `{name}` has {length} lines");
            assert!(arguments <= 5, "{file}: `{name}` has {arguments} arguments");
        }
    }
}

/// Systems run one after another and find what they share among the resources.
#[test]
fn systems_share_without_locks() {
    for path in &engine_sources() {
        let Some(text) = without_tests(path) else { continue };
        for lock in ["Mutex", "RwLock"] {
            assert!(!text.contains(lock), "{} has a {lock}", shown(path));
        }
    }
}

/// What sums over the particles of a flow says so to the schedule.
#[test]
fn plugins_that_go_through_the_neighbours_of_fluids_declare_it() {
    let mut found = 0;
    for plugin in plugins() {
        let mut files = Vec::new();
        collect_sources(&plugin.join("src"), &mut files);
        let text: String = files.iter().filter_map(|file| without_tests(file)).collect();
        let sums = [".fours(", ".for_each_row(", ".for_each_neighbor(", "Repayment::"];
        if sums.iter().any(|call| text.contains(call)) {
            found += 1;
            assert!(text.contains("touches_packed(FLOW_RECORDS"), "{} does not declare it", name(&plugin));
        }
    }
    assert!(found >= 4, "only {found} plugins are found");
}

/// Targets of the links of a page, without those to other sites.
fn links(page: &str) -> impl Iterator<Item = &str> {
    page.split("](")
        .skip(1)
        .filter_map(|rest| rest.split([')', '#']).next())
        .filter(|link| !link.contains("://"))
}

#[test]
fn links_between_pages_lead_somewhere() {
    let pages = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "assets/README.md"]
        .map(|page| root().join(page));
    let docs =
        entries(&root().join("docs")).into_iter().filter(|path| path.extension().is_some_and(|e| e == "md"));
    let own = plugins().into_iter().map(|plugin| plugin.join("README.md"));
    for page in pages.into_iter().chain(docs).chain(own) {
        let folder = page.parent().expect("a folder");
        let text = read(&page);
        for link in links(&text).filter(|link| !link.is_empty()) {
            assert!(folder.join(link).exists(), "{} links to {link}, which is not there", shown(&page));
        }
    }
}

/// The modules of the engine, each above those that it may import.
const LAYERS: &[&str] = &[
    "invariants",
    "assembly",
    "contact",
    "boundaries",
    "simulation",
    "record",
    "formulations",
    "skins",
    "solids",
    "symmetry",
    "removal",
    "pair",
    "rigid",
    "integrate",
    "fields",
    "plugin",
    "schedule",
    "materials",
    "world",
    "scene",
    "shapes",
    "space",
    "neighbors",
    "correction",
    "kernels",
    "parallel",
    "ranks",
    "linalg",
    "notation",
];

#[test]
fn the_table_of_modules_has_all_of_them_in_order() {
    let page = read(&root().join("ARCHITECTURE.md"));
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let modules =
        rows.flat_map(|line| line.split('|').nth(1).unwrap_or_default().split('`').skip(1).step_by(2));
    let modules: Vec<&str> = modules.collect();
    assert_eq!(modules, LAYERS, "ARCHITECTURE.md lists the modules in the order of LAYERS");
    assert!(
        page.split_whitespace().count() < 1400,
        "ARCHITECTURE.md is a page to begin with: two printed pages"
    );
}

/// Folders whose files and folders must not import each other in circles.
const WITHOUT_CIRCLES: &[&str] = &[
    "formulations/total_lagrangian",
    "formulations/fluid",
    "formulations/fluid/lanes",
    "formulations/fluid/lists",
    "formulations/fluid/lists/blocks",
    "formulations/fluid/cloud",
    "formulations/fluid/density",
    "formulations/fluid/rotation",
    "formulations/fluid/moments",
    "formulations/fluid/walls",
    "formulations/fluid/passes",
    "formulations/fluid/passes/blocks",
    "formulations/fluid/coupling",
    "formulations/fluid/stabilizers",
    "formulations/fluid/setup",
    "formulations/fluid/warnings",
    "contact",
    "contact/laws",
    "contact/response",
    "contact/bodies",
    "contact/active",
    "contact/particles",
    "contact/tools",
    "contact/skins",
    "contact/system",
    "contact/plan",
    "solids",
    "symmetry",
    "assembly",
];

/// The text of a file of the engine without comments and tests; none for a file of tests.
fn without_tests(path: &Path) -> Option<String> {
    let of_tests = |part: &std::ffi::OsStr| {
        let part = part.to_string_lossy();
        let stem = part.trim_end_matches(".rs");
        stem == "tests" || stem.ends_with("_tests")
    };
    if path.iter().any(of_tests) {
        return None;
    }
    let text = read(path);
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    Some(lines.collect::<Vec<_>>().join("\n"))
}

/// The words that follow `path::` in a text.
fn words_after<'t>(text: &'t str, path: &str) -> Vec<&'t str> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let rests = text.match_indices(path).map(|(at, _)| (at, &text[at + path.len()..]));
    // `supercrate::` is not `crate::`.
    let whole = rests.filter(|(at, _)| !text[..*at].ends_with(is_word));
    whole.map(|(_, rest)| &rest[..rest.find(|c| !is_word(c)).unwrap_or(rest.len())]).collect()
}

#[test]
fn imports_of_the_engine_go_down_the_list_of_modules() {
    let rank = |module: &str| LAYERS.iter().position(|layer| *layer == module);
    let mut imports = 0;
    for folder in ENGINE.map(|folder| root().join(folder)) {
        for line in read(&folder.join("lib.rs")).lines() {
            if let Some(module) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';')) {
                assert!(rank(module).is_some(), "module `{module}` has no place in the list");
            }
        }
        let mut files = Vec::new();
        collect_sources(&folder, &mut files);
        for path in &files {
            let inside = path.strip_prefix(&folder).expect("a file of the folder");
            let first = inside.iter().next().expect("a name").to_string_lossy().into_owned();
            let Some(own) = rank(first.trim_end_matches(".rs")) else { continue };
            let Some(text) = without_tests(path) else { continue };
            for other in words_after(&text, "crate::").into_iter().filter_map(rank) {
                imports += 1;
                let (own_name, name) = (LAYERS[own], LAYERS[other]);
                assert!(own <= other, "{}: `{own_name}` is below `{name}` and imports it", shown(path));
            }
        }
    }
    assert!(imports > 500, "only {imports} imports are found");
}

/// The modules of `folder` that a file of it imports: `path` leads there from the folder.
fn imports_within(folder: &str, path: &Path) -> Vec<String> {
    let Some(text) = without_tests(path) else { return Vec::new() };
    let inside = path.strip_prefix(root().join("src/engine").join(folder)).expect("a file of the folder");
    let above = "super::".repeat(inside.components().count());
    let absolute = format!("crate::{}::", folder.replace('/', "::"));
    let relative = words_after(&text, &above).into_iter().filter(|word| *word != "super");
    relative.chain(words_after(&text, &absolute)).map(str::to_owned).collect()
}

/// Every file and folder in a folder of the engine, without the extension, and what it imports of the others.
fn modules_and_imports(folder: &str) -> Vec<(String, Vec<String>)> {
    let mut modules = Vec::new();
    for path in entries(&root().join("src/engine").join(folder)) {
        let own = name(&path).trim_end_matches(".rs").to_owned();
        if own == "mod" || own.ends_with("tests") {
            continue;
        }
        let mut files = Vec::new();
        if path.is_dir() {
            collect_sources(&path, &mut files)
        } else {
            files.push(path)
        }
        let imports = files.iter().flat_map(|file| imports_within(folder, file)).collect();
        modules.push((own, imports));
    }
    modules
}

#[test]
fn modules_of_a_folder_import_each_other_without_circles() {
    for folder in WITHOUT_CIRCLES {
        let mut open = modules_and_imports(folder);
        // What imports nothing that is still open is closed, until all are closed or wait for each other.
        loop {
            let names: Vec<String> = open.iter().map(|(name, _)| name.clone()).collect();
            let waits = |(own, imports): &(String, Vec<String>)| {
                imports.iter().any(|other| other != own && names.contains(other))
            };
            open.retain(waits);
            if open.len() == names.len() {
                break;
            }
        }
        let waiting: Vec<&str> = open.iter().map(|(name, _)| name.as_str()).collect();
        assert!(waiting.is_empty(), "{folder}: circles among {}", waiting.join(", "));
    }
}

#[test]
fn folders_of_contact_and_fluid_import_only_those_above_them_in_their_lists() {
    for folder in ["contact", "formulations/fluid"] {
        imports_go_up_the_list_of(folder);
    }
}

fn imports_go_up_the_list_of(folder: &str) {
    let list = read(&root().join("src/engine").join(folder).join("mod.rs"));
    let folders: Vec<&str> =
        list.lines().filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';')).collect();
    let place = |name: &str| folders.iter().position(|folder| *folder == name);
    let mut imports = 0;
    for (own, others) in modules_and_imports(folder) {
        for other in others.iter().filter(|other| **other != own) {
            // What the list itself exports has no place in it.
            let Some(at) = place(other) else { continue };
            imports += 1;
            assert!(Some(at) < place(&own), "{folder}: `{own}` stands above `{other}` and imports it");
        }
    }
    assert!(imports > 30, "{folder}: only {imports} imports are found");
}
