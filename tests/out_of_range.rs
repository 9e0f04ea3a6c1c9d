//! Every parameter of laws, equations of state, failure, control, contact and tools: a value out of range is
//! refused where it stands in the scene, with what would be right.

use meshless::assembly::build;
use meshless::scene::{Source, parse};

/// A scene in which one slot is filled otherwise. The value that is out of range stands between « and ».
fn scene(slot: &str, text: &str) -> String {
    let or = |name: &str, usual: &str| if name == slot { text.to_owned() } else { usual.to_owned() };
    format!(
        r#"(dimension: {dimension},
    materials: {{
        "m": {material},
        "s": Steel,
    }},
    bodies: [
        (name: "b", material: "m", spacing: 0.1, formulation: {formulation}, shape: Box(min: (0, 0{zero}), max: (1, 1{one})),
            plugins: [{plugin}]),
        (name: "tool", material: "s", spacing: 0.1, formulation: {tool}, shape: {shape}),
    ],
    contacts: [
        {contact},
    ],
    conditions: [{condition}],
    time: (end: 1.0))"#,
        dimension = if slot == "shape" { "Three" } else { "Two" },
        zero = if slot == "shape" { ", 0" } else { "" },
        one = if slot == "shape" { ", 1" } else { "" },
        material = or("material", "Copper"),
        formulation = or("formulation", "TotalLagrangian"),
        plugin = or("plugin", ""),
        tool = or("tool", "Rigid()"),
        shape = or("shape", "Box(min: (0, 1.1), max: (1, 1.5))"),
        contact = or("contact", r#"Contact(between: ("b", "tool"), law: Penalty())"#),
        condition = or("condition", ""),
    )
}

/// Line and column of the value, from one, and the text without its marks.
fn place(text: &str) -> (usize, usize, String) {
    let before = text.split('«').next().expect("a text");
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().expect("a line").chars().count() + 1;
    (line, column, text.replace(['«', '»'], ""))
}

fn refused(slot: &str, marked: &str) {
    assert_eq!(marked.matches('«').count(), 1, "{marked}");
    let (line, column, text) = place(&scene(slot, marked));
    let read = parse(Source::new("scene.ron", text)).map_err(|error| error.to_string());
    let built = read.and_then(|(scene, source)| {
        build(&scene, &source, &meshless::standard_plugins()).map_err(|error| error.to_string())
    });
    let Err(shown) = built else { panic!("{marked}: no error") };
    assert!(
        shown.contains(&format!("scene.ron:{line}:{column}\n")),
        "{marked}: not at {line}:{column}:\n{shown}"
    );
    let helps = shown.contains("= help: ") || shown.contains(" must ");
    assert!(helps, "{marked}: no help:\n{shown}");
}

/// Parameters with a value out of range: `before`, the value, and what comes after it.
fn each(slot: &str, pattern: &str, parameters: &[(&str, &str)]) {
    for (name, value) in parameters {
        refused(slot, &pattern.replace("{}", &format!("{name}: «{value}»")));
    }
}

#[test]
fn elastic_constants() {
    for law in ["StVenantKirchhoff", "NeoHookean", "DecoupledNeoHookean", "Hypoelastic"] {
        each(
            "material",
            &format!("{law}({{}}, young: 1e9, poisson: 0.3)"),
            &[("density", "0.0"), ("density", "-1.0")],
        );
        each(
            "material",
            &format!("{law}(density: 1.0, {{}}, poisson: 0.3)"),
            &[("young", "0.0"), ("young", "-1e9")],
        );
        each(
            "material",
            &format!("{law}(density: 1.0, young: 1e9, {{}})"),
            &[("poisson", "0.5"), ("poisson", "-1.0")],
        );
        each("material", &format!("{law}(density: 1.0, {{}}, shear: 1e9)"), &[("bulk", "0.0")]);
        each("material", &format!("{law}(density: 1.0, bulk: 1e9, {{}})"), &[("shear", "-1.0")]);
    }
}

#[test]
fn flow_stress() {
    for law in ["J2", "Hypoelastic"] {
        let pattern = |hardening: &str| {
            format!("{law}(density: 1.0, young: 1e9, poisson: 0.3, hardening: {hardening})")
        };
        each("material", &pattern("Perfect({})"), &[("yield_stress", "0.0"), ("yield_stress", "-1e6")]);
        each("material", &pattern("Linear({}, modulus: 0.0)"), &[("yield_stress", "0.0")]);
        each("material", &pattern("Linear(yield_stress: 1e6, {})"), &[("modulus", "-1.0")]);
        each("material", &pattern("Power({}, coefficient: 1e6, exponent: 0.5)"), &[("yield_stress", "0.0")]);
        each("material", &pattern("Power(yield_stress: 1e6, {}, exponent: 0.5)"), &[("coefficient", "-1.0")]);
        each("material", &pattern("Power(yield_stress: 1e6, coefficient: 1e6, {})"), &[("exponent", "0.0")]);
        each("material", &pattern("Voce({}, saturation: 1e6, rate: 1.0)"), &[("yield_stress", "0.0")]);
        each("material", &pattern("Voce(yield_stress: 1e6, {}, rate: 1.0)"), &[("saturation", "-1.0")]);
        each("material", &pattern("Voce(yield_stress: 1e6, saturation: 1e6, {})"), &[("rate", "-1.0")]);
        each_of_johnson_cook(&|parameters| pattern(&format!("JohnsonCook({parameters})")));
        let hot = pattern("Perfect(yield_stress: 1e6)").replace("))", "), heating: ({}))");
        each(
            "material",
            &hot,
            &[
                ("specific_heat", "0.0"),
                ("taylor_quinney", "-0.1"),
                ("taylor_quinney", "1.1"),
                ("temperature", "-20.0"),
            ],
        );
    }
}

/// The parameters of Johnson and Cook, of a material that is written around them.
fn each_of_johnson_cook(material: &dyn Fn(&str) -> String) {
    each("material", &material("{}, b: 1e6, n: 0.5, melt_temperature: 900.0"), &[("a", "0.0")]);
    each("material", &material("a: 1e6, {}, n: 0.5, melt_temperature: 900.0"), &[("b", "-1.0")]);
    each("material", &material("a: 1e6, b: 1e6, {}, melt_temperature: 900.0"), &[("n", "0.0")]);
    let more = [("c", "-0.1"), ("m", "0.0"), ("reference_rate", "0.0"), ("reference_temperature", "-10.0")];
    each("material", &material("a: 1e6, b: 1e6, n: 0.5, melt_temperature: 900.0, {}"), &more);
    each(
        "material",
        &material("a: 1e6, b: 1e6, n: 0.5, {}"),
        &[("melt_temperature", "293.0"), ("melt_temperature", "-5.0")],
    );
}

#[test]
fn named_materials() {
    let metal =
        |parameters: &str| format!("JohnsonCook(density: 1.0, young: 1e9, poisson: 0.3, {parameters})");
    each_of_johnson_cook(&metal);
    let heat = [("specific_heat", "0.0"), ("taylor_quinney", "2.0"), ("temperature", "0.0")];
    each("material", &metal("a: 1e6, b: 1e6, n: 0.5, melt_temperature: 900.0, {}"), &heat);
    let elastic = [("density", "0.0"), ("young", "0.0"), ("poisson", "0.5")];
    for name in ["Al6061T6", "PMMA", "Steel42CrMo4"] {
        let pattern = format!("{name}({{}})");
        each("material", &pattern, &elastic);
        let flow = [
            ("a", "0.0"),
            ("b", "-1.0"),
            ("n", "0.0"),
            ("c", "-0.1"),
            ("m", "0.0"),
            ("reference_rate", "0.0"),
        ];
        each("material", &pattern, &flow);
        each("material", &pattern, &[("reference_temperature", "0.0"), ("melt_temperature", "100.0")]);
        each(
            "material",
            &pattern,
            &[("specific_heat", "-1.0"), ("taylor_quinney", "1.5"), ("temperature", "-1.0")],
        );
    }
    for name in ["Copper", "Steel"] {
        each("material", &format!("{name}({{}})"), &elastic);
        each("material", &format!("{name}({{}})"), &[("yield_stress", "0.0"), ("modulus", "-1.0")]);
    }
    each("material", "Rubber({})", &elastic);
}

#[test]
fn equations_of_state() {
    for material in [
        "J2(density: 1.0, young: 1e9, poisson: 0.3, hardening: Perfect(yield_stress: 1e6), eos: ",
        "Copper(eos: ",
    ] {
        let mie = format!("{material}MieGrueneisen(slope: 1.5, {{}}))");
        each("material", &mie, &[("sound_speed", "0.0"), ("gamma", "-1.0")]);
        each("material", &format!("{material}MieGrueneisen({{}}))"), &[("slope", "-0.1")]);
        let polynomial = format!("{material}Polynomial(c2: 0.0, c3: 0.0, {{}}))");
        each("material", &polynomial, &[("c1", "0.0"), ("gamma", "-1.0")]);
        each("material", &format!("{material}Polynomial({{}}, c3: 0.0))"), &[("c2", "-1.0")]);
        each("material", &format!("{material}Polynomial(c2: 0.0, {{}}))"), &[("c3", "-1.0")]);
    }
}

#[test]
fn failure() {
    each("plugin", "failure(criterion: MaximumPrincipalStrain({}))", &[("limit", "0.0"), ("limit", "-0.1")]);
    each("plugin", "failure(criterion: MaximumPrincipalStress({}))", &[("limit", "0.0")]);
    let strain = "failure(criterion: JohnsonCook(d1: 0.1, d2: 0.0, d3: 0.0, {}))";
    let more = [("reference_rate", "0.0"), ("reference_temperature", "0.0"), ("minimum_strain", "0.0")];
    each("plugin", strain, &more);
    each("plugin", &strain.replace("{}", "d5: 1.0, {}"), &[("melt_temperature", "20.0")]);
    let growth = "failure(criterion: MaximumPrincipalStrain(limit: 0.1), growth: CrackSpeed({}))";
    each("plugin", growth, &[("factor", "0.0"), ("factor", "-0.4")]);
}

#[test]
fn control_and_viscosity() {
    for form in ["Variational", "Ganzenmueller2015", "Viscous", "Combined"] {
        let pattern = format!("hourglass_control(form: {form}, {{}})");
        let range = [("alpha", "-1.0"), ("zeta", "-1.0"), ("chi", "-0.1"), ("chi", "1.1")];
        each("plugin", &pattern, &range);
    }
    each("plugin", "artificial_viscosity({})", &[("alpha", "-1.0"), ("beta", "-1.0")]);
}

#[test]
fn contact_and_tools() {
    let law = |law: &str| format!(r#"Contact(between: ("b", "tool"), law: {law})"#);
    each("contact", &law("Penalty({})"), &[("stiffness", "0.0"), ("factor", "0.0"), ("factor", "-1.0")]);
    each("contact", &law("Hertz({})"), &[("modulus", "0.0"), ("modulus", "-1.0")]);
    let pattern = law("Penalty(), {}");
    each("contact", &pattern, &[("friction", "-0.1"), ("restitution", "-0.1"), ("restitution", "1.1")]);
    each("tool", "Rigid({})", &[("mass", "0.0"), ("mass", "-1.0"), ("spin", "(1.0, 0.0, 0.0)")]);
    each("tool", "Rigid({})", &[("rotation", "About(0.0, 0.0, 0.0)")]);
    let rotation = r#"RotationRate(on: Select(body: "tool"), rate: 1.0, {})"#;
    each("condition", rotation, &[("axis", "(1.0, 0.0, 0.0)"), ("axis", "(0.0, 0.0, 0.0)")]);
    let range = [("support", "1.0"), ("support", "20.0"), ("neighbors", "2"), ("neighbors", "4000")];
    each("formulation", "TotalLagrangian({})", &range);
    // The second body of a formulation is another place than the first.
    each("tool", "TotalLagrangian({})", &range);
}

#[test]
fn meshes() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/meshes/box.obj");
    let pattern = format!(r#"Translate(shape: Mesh(file: "{file}", {{}}), by: (0, 0, 2))"#);
    each("shape", &pattern, &[("scale", "0.0"), ("scale", "-1.0")]);
}
