use super::*;

fn value(text: &str) -> f64 {
    let x = DVec3::new(2.0, 3.0, 5.0);
    text.parse::<Expression>().unwrap_or_else(|error| panic!("{text}: {error}")).eval(x, 0.5)
}

#[test]
fn arithmetic() {
    for (text, expected) in [
        ("1 + 2*3 - 4/8", 6.5),
        ("-x^2", -4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("(-x)^2", 4.0),
        ("1e-3 + 2.5E2", 250.001),
        ("2*e-3", 2.0 * std::f64::consts::E - 3.0),
        ("5*z/3", 25.0 / 3.0),
        ("8 - 3 - 2", 3.0),
        ("8/4/2", 1.0),
        ("--2", 2.0),
        ("x*-y", -6.0),
        (".5", 0.5),
    ] {
        assert!((value(text) - expected).abs() < 1e-12, "{text} is {} not {expected}", value(text));
    }
}

#[test]
fn functions() {
    for (text, expected) in [
        ("-0.1*min(t/0.01, 1)", -0.1),
        ("max(x, pow(y, 2))", 9.0),
        ("sin(pi/2) + cos(pi)", 0.0),
        ("tan(pi/4)*sqrt(16)", 4.0),
        ("ln(exp(x))", 2.0),
        ("abs(-3) + tanh(0)", 3.0),
        ("step(-1e-9) + 2*step(0)", 2.0),
        ("ramp(-1) + ramp(t) + ramp(7)", 1.5),
        ("smoothstep(-1)", 0.0),
        ("smoothstep(0.25)", 3.0 / 16.0 - 2.0 / 64.0),
        ("smoothstep(t)", 0.5),
        ("smoothstep(2)", 1.0),
        ("mod(-1, 3)", 2.0),
        ("atan2(1, 0)", std::f64::consts::FRAC_PI_2),
        ("sign(-2) + sign(0)", -1.0),
    ] {
        assert!((value(text) - expected).abs() < 1e-12, "{text} is {} not {expected}", value(text));
    }
    assert!(value("min(1, sqrt(-x))").is_nan());
    assert!(value("max(sqrt(-x), 1)").is_nan());
}

#[test]
fn knows_what_it_depends_on() {
    let of = |text: &str| text.parse::<Expression>().unwrap();
    assert!(of("2*sin(pi/3)").is_constant());
    assert!(!of("0*x").is_constant());
    assert!(of("t").depends_on_time());
    assert!(!of("x+y").depends_on_time());
    assert!(of("x+y").depends_on_place() && of("2*z").depends_on_place());
    assert!(!of("2*t").depends_on_place());
    assert!(Expression::constant(3.0).is_constant());
}

#[test]
fn errors_point_at_their_place() {
    for (text, start, end, message) in [
        ("1 +", 3, 3, "found nothing more"),
        ("2*q", 2, 3, "unknown name `q`"),
        ("sinn(x)", 0, 4, "unknown name `sinn`"),
        ("min(1)", 0, 3, "`min` takes two arguments, found 1"),
        ("sin(x, y)", 0, 3, "`sin` takes one argument, found 2"),
        ("sin x", 0, 3, "without its argument"),
        ("(1 + 2", 6, 6, "expected `)`, found nothing more"),
        ("2x", 1, 2, "expected an operator or the end, found `x`"),
        ("x**2", 1, 3, "found `**`"),
        ("1.2.3", 0, 5, "not a number"),
        ("1/0", 0, 3, "must be finite, found inf"),
        ("", 0, 0, "found nothing more"),
        ("1 § 2", 2, 4, "found `§`"),
    ] {
        let error = text.parse::<Expression>().expect_err(text);
        assert_eq!((error.start, error.end), (start, end), "{text}: {error}");
        assert!(error.message.contains(message), "{text}: {error}");
    }
    let nested = format!("{}1{}", "(".repeat(1000), ")".repeat(1000));
    assert!(nested.parse::<Expression>().is_err());
    let wide = format!("{}1{}", "x+(".repeat(40), ")".repeat(40));
    assert!(wide.parse::<Expression>().is_err());
}

fn parsed(text: &str) -> Expression {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn ranges_hold_the_values_and_short_pulses() {
    let range =
        |text: &str, from: f64, to: f64| parsed(text).range_over_time(DVec3::new(2.0, 0.0, 0.0), [from, to]);
    for (text, from, to, expected) in [
        ("3", 0.0, 1.0, [3.0, 3.0]),
        ("x*t", 1.0, 2.0, [2.0, 4.0]),
        ("5*step(t - 0.5)*step(0.50001 - t)", 0.0, 1.0, [0.0, 5.0]),
        ("5*step(t - 0.5)", 0.5, 1.0, [5.0, 5.0]),
        ("sin(2*pi*t)", 0.0, 10.0, [-1.0, 1.0]),
        ("sin(2*pi*t)", 0.0, 0.25, [0.0, 1.0]),
        ("cos(2*pi*t)", 0.25, 0.75, [-1.0, 0.0]),
        ("(t - 1)^2", 0.0, 3.0, [0.0, 4.0]),
        ("(t - 1)^3", 0.0, 3.0, [-1.0, 8.0]),
        ("abs(t - 1)", 0.0, 3.0, [0.0, 2.0]),
        ("exp(-t)", 0.0, 1.0, [(-1.0_f64).exp(), 1.0]),
        ("1/(1 + t)", 0.0, 1.0, [0.5, 1.0]),
        ("1/t", 0.0, 1.0, [f64::NEG_INFINITY, f64::INFINITY]),
        ("tan(t)", 0.0, 1.0, [f64::NEG_INFINITY, f64::INFINITY]),
        ("mod(t, 1)", 0.25, 0.75, [0.25, 0.75]),
        ("mod(t, 1)", 0.25, 1.75, [0.0, 1.0]),
        ("atan2(t, 1)", 0.0, 1.0, [0.0, std::f64::consts::FRAC_PI_4]),
        ("min(t, 0.5)", 0.0, 1.0, [0.0, 0.5]),
        ("smoothstep(t/2)", 0.0, 1.0, [0.0, 0.5]),
    ] {
        let found = range(text, from, to);
        let near = |k: usize| found[k] == expected[k] || (found[k] - expected[k]).abs() < 1e-12;
        assert!(near(0) && near(1), "{text} from {from} to {to}: {found:?}");
    }
    // Where the time occurs twice, bounds may be wider than the values, but hold them.
    for text in [
        "t*sin(9*t) - t^2",
        "t^t",
        "sqrt(t)*cosh(t - 1)",
        "mod(7*t, 2)*sign(t - 0.3)",
        "atan2(t - 0.4, t - 0.6)",
    ] {
        for k in 0..50 {
            let from = 0.02 * f64::from(k);
            let [low, high] = range(text, from, from + 0.05);
            let times = (0..=10).map(|k| from + 0.005 * f64::from(k));
            let values = times.map(|t| parsed(text).eval(DVec3::new(2.0, 0.0, 0.0), t));
            values
                .for_each(|value| assert!(low - 1e-12 <= value && value <= high + 1e-12, "{text}: {value}"));
        }
    }
}

#[test]
fn every_name_has_a_meaning() {
    let count = functions::VARIABLES.len()
        + functions::CONSTANTS.len()
        + functions::UNARY.len()
        + functions::BINARY.len();
    assert_eq!(expression_names().len(), count);
    assert!(expression_names().iter().all(|(name, _)| is_reserved(name)));
}
