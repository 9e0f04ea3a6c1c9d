//! Every case of `meshless validate` at its cheapest meaningful resolution.

use meshless::standard_plugins;
use meshless_validation::CASES;

fn passes(id: &str) {
    let case = CASES.iter().find(|case| case.id == id).expect("a known case");
    let checks =
        (case.run)(&standard_plugins(), case.ci_resolution).unwrap_or_else(|error| panic!("{id}: {error:#}"));
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

#[test]
fn every_case_has_resolutions_that_rise() {
    for case in CASES {
        assert!(case.resolutions.windows(2).all(|pair| pair[0] < pair[1]), "{}", case.id);
        assert!(case.resolutions.contains(&case.ci_resolution) || case.resolutions[0] > case.ci_resolution);
    }
}
