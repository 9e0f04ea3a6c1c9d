//! The architecture itself: who depends on whom, what every plugin has, how long files are.

mod imports;

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

/// Tables, addresses and formulas, which mean something else in two lines, are left as they are: rows of
/// tables, and text that is set in as code.
#[test]
fn comments_are_no_wider_than_the_code() {
    let is_prose = |comment: &str| !comment.starts_with('|') && !comment.starts_with("    ");
    for path in sources() {
        let text = read(&path);
        let mut is_code = false;
        for (number, line) in text.lines().enumerate() {
            let marks = ["///", "//!", "//"];
            let start = line.trim_start();
            let Some(comment) = marks.iter().find_map(|mark| start.strip_prefix(mark)) else { continue };
            let comment = comment.strip_prefix(' ').unwrap_or(comment);
            is_code ^= comment.starts_with("```");
            let is_wide = line.chars().count() > 110 && comment.contains(' ');
            assert!(
                !is_wide || is_code || !is_prose(comment),
                "{}:{}: a comment wider than 110 characters",
                shown(&path),
                number + 1
            );
        }
    }
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

/// The README and the recipe for a formulation say so.
#[test]
fn the_formulation_to_copy_has_under_300_lines() {
    let length = read(&root().join("tests/toy_solid/toy.rs")).lines().count();
    assert!(length < 300, "tests/toy_solid/toy.rs has {length} lines");
}
