//! Every case of `meshless validate` at its cheapest meaningful resolution.

use meshless::standard_plugins;
use meshless_validation::CASES;

/// The test runner does several cases at once, so that each has one thread: the same bits, and no waiting
/// between threads.
fn alone<T: Send>(run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread").install(run)
}

fn passes(id: &str) {
    let case = CASES.iter().find(|case| case.id == id).expect("a known case");
    let checks = alone(|| (case.run)(&standard_plugins(), case.ci_resolution))
        .unwrap_or_else(|error| panic!("{id}: {error:#}"));
    assert!(!checks.is_empty());
    let failed: Vec<_> = checks.iter().filter(|check| !check.passes()).collect();
    assert!(failed.is_empty(), "{id}: {failed:#?}");
}

macro_rules! tests {
    ($($id:ident $case:path;)*) => {
        $(
            #[test]
            fn $id() {
                passes(stringify!($id));
            }
        )*
    };
}

meshless_validation::for_each_case!(tests);

/// Cases whose errors fall from each resolution to the next, and how many of their resolutions take seconds.
const CONVERGING: &[(&str, usize)] =
    &[("M4", 3), ("M4E", 3), ("S10", 2), ("S22", 3), ("S23", 3), ("S23b", 2), ("S23c", 2)];

#[test]
fn errors_of_cheap_cases_fall_with_the_spacing() {
    for &(id, count) in CONVERGING {
        let case = CASES.iter().find(|case| case.id == id).expect("a known case");
        let run = |&n: &usize| (case.run)(&standard_plugins(), n).unwrap_or_else(|e| panic!("{id}: {e:#}"));
        let runs: Vec<_> = case.resolutions[..count].iter().map(run).collect();
        let errors = |name: &str| -> Vec<f64> {
            runs.iter()
                .flatten()
                .filter(|check| check.name == name)
                .map(|check| check.error().abs())
                .collect()
        };
        let mut compared = 0;
        for check in runs[0].iter().filter(|check| check.converges) {
            let errors = errors(&check.name);
            assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{id}, {}: {errors:?}", check.name);
            compared += 1;
        }
        assert!(compared > 0, "{id} has no error that is said to fall");
    }
}

#[test]
fn every_case_has_resolutions_that_rise() {
    for case in CASES {
        assert!(case.resolutions.windows(2).all(|pair| pair[0] < pair[1]), "{}", case.id);
        assert!(case.resolutions.contains(&case.ci_resolution) || case.resolutions[0] > case.ci_resolution);
    }
}
