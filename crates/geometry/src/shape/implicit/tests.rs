//! Random formulas: ranges, models and derivatives contain their values. Random texts: nothing
//! panics.

use super::interval::Interval;
use super::jet::Jet;
use super::model::Model;
use super::program::Program;
use super::{Formula, parser};
use math::DVec3;
use proptest::{prelude::*, test_runner::RngSeed};

/// Random formulas with all operators, functions and names.
fn text() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        4 => prop::sample::select(vec!["x", "y", "z"]).prop_map(str::to_owned),
        1 => (-3.0f64..3.0).prop_map(|value| format!("{value:.3}")),
        1 => Just("pi".to_owned()),
    ];
    leaf.prop_recursive(5, 40, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            4 => (pair.clone(), prop::sample::select(vec!["+", "-", "*", "/"]))
                .prop_map(|((a, b), op)| format!("({a} {op} {b})")),
            1 => (inner.clone(), prop::sample::select(vec!["2", "3", "4", "7", "-2", "0.5", "1.7", "-0.3"]))
                .prop_map(|(a, n)| format!("({a})^{n}")),
            2 => (inner.clone(), prop::sample::select(vec!["sqrt", "abs", "sin", "cos", "tan", "exp", "log"]))
                .prop_map(|(a, f)| format!("{f}({a})")),
            1 => (pair.clone(), prop::sample::select(vec!["min", "max"]))
                .prop_map(|((a, b), f)| format!("{f}({a}, {b})")),
            1 => pair.prop_map(|(a, b)| format!("pow(abs({a}) + 0.1, {b})")),
            1 => inner.prop_map(|a| format!("-{a}")),
        ]
    })
}

/// The program of a text, unless it is a constant.
fn program(text: &str) -> Option<Program> {
    parser::parse(text)
        .inspect_err(|error| assert!(error.message.contains("the formula is constant"), "{text}: {error}"))
        .ok()
}

fn value(program: &Program, p: DVec3) -> f64 {
    program.evaluate(p.to_array(), &mut Vec::new())
}

fn point() -> impl Strategy<Value = DVec3> {
    [-2.0f64..2.0, -2.0f64..2.0, -2.0f64..2.0].prop_map(DVec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn values_lie_in_the_range_over_a_box(
        text in text(), center in point(), size in prop::sample::select(vec![0.0, 1e-9, 1e-3, 0.3, 2.0]),
    ) {
        let Some(program) = program(&text) else { return Ok(()) };
        let half = DVec3::new(1.0, 0.7, 0.4) * size;
        let axis = |i: usize| Interval::new(center[i] - half[i], center[i] + half[i]);
        let range = program.evaluate([axis(0), axis(1), axis(2)], &mut Vec::new());
        for i in 0..27 {
            let p = center + half * DVec3::new((i % 3) as f64 - 1.0, (i / 3 % 3) as f64 - 1.0, (i / 9) as f64 - 1.0);
            let value = value(&program, p);
            prop_assert!(!value.is_finite() || range.contains(value), "{text} at {p}: {value} not in {range:?}");
        }
    }

    #[test]
    fn values_lie_within_the_error_of_the_model(
        text in text(), o in point(), d in point(), a in -1.0f64..1.0, width in prop::sample::select(vec![1e-9, 1e-3, 0.1, 1.0]),
    ) {
        let Some(program) = program(&text) else { return Ok(()) };
        let t = [a, a + width];
        let axis = |i: usize| Model::<8>::coordinate(o[i], d[i], t);
        let model = program.evaluate([axis(0), axis(1), axis(2)], &mut Vec::new());
        for i in 0..=16 {
            let s = i as f64 / 8.0 - 1.0;
            let p = o + d * (0.5 * (t[0] + t[1]) + 0.5 * (t[1] - t[0]) * s);
            let value = value(&program, p);
            if !value.is_finite() {
                prop_assert!(model.partial || model.r == f64::INFINITY, "{text} is not defined at {p}");
                continue;
            }
            let polynomial = model.c.iter().rev().fold(0.0, |sum, c| sum * s + c);
            // The value itself is rounded in every step.
            let rounding = 1e-13 * (1.0 + value.abs() + model.c.iter().map(|c| c.abs()).sum::<f64>());
            prop_assert!((value - polynomial).abs() <= model.r + rounding, "{text} at {p}: {value}, {model:?}");
            prop_assert!(model.range.contains(value), "{text} at {p}: {value}, {model:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values(text in text(), p in point()) {
        let Some(program) = program(&text) else { return Ok(()) };
        let jet = |p: DVec3| program.evaluate([0, 1, 2].map(|axis| Jet::coordinate(p, axis)), &mut Vec::new());
        let here = jet(p);
        let h = 1e-5;
        for axis in 0..3 {
            let [above, below] = [h, -h].map(|h| jet(p + DVec3::AXES[axis] * h));
            // Finite differences across kinks and poles, or near them, are meaningless.
            let is_tame = |j: &Jet| j.value.is_finite() && j.hessian.abs_diff_eq(here.hessian, 0.01);
            if !(is_tame(&above) && is_tame(&below) && above.gradient.abs_diff_eq(below.gradient, 0.1)) {
                continue;
            }
            let slope = (above.value - below.value) / (2.0 * h);
            let tolerance = 1e-3 * (1.0 + here.gradient.length()) + 1e-10 * here.value.abs() / h;
            prop_assert!((slope - here.gradient[axis]).abs() < tolerance, "{text} at {p}: {slope}, {here:?}");
            let bend = (above.gradient - below.gradient) / (2.0 * h);
            let tolerance = 1e-2 * (1.0 + bend.length()) + 1e-10 * here.gradient.length() / h;
            prop_assert!((bend - here.hessian.col(axis)).length() < tolerance, "{text} at {p}: {bend}, {here:?}");
        }
    }

    #[test]
    fn any_text_is_a_formula_or_has_a_located_error(text in "[-+*/^(), .0-9exyzpisnqrtabcolgmwkE=\u{e9}\u{3c0}]{0,60}") {
        hostile(&text);
    }

    #[test]
    fn any_bytes_are_a_formula_or_have_a_located_error(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
        hostile(&String::from_utf8_lossy(&bytes));
    }
}

fn hostile(text: &str) {
    match Formula::parse(text) {
        Ok(formula) => _ = formula.value([0.3, -0.2, 1.1]),
        Err(error) => {
            assert!(text.get(error.place.clone()).is_some(), "{text}: {:?}", error.place);
            assert!(!error.message.is_empty());
        }
    }
}

#[test]
fn operators_have_their_precedence() {
    let at = |text: &str| {
        Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).value([2.0, 3.0, 5.0])
    };
    for (text, value) in [
        ("-x^2", -4.0),
        ("(-x)^2", 4.0),
        ("2^-x", 0.25),
        ("x^y^2", 512.0),
        ("z - y - x", 0.0),
        ("z/y*y", 5.0),
        ("- -x", 2.0),
        ("+x + + y", 5.0),
        ("2*x*3", 12.0),
        ("x*x - x^2 + 1", 1.0),
        ("min(x, max(y, z))", 2.0),
        ("pow(x, 3)", 8.0),
        ("(-x)^3", -8.0),
        ("x^-1", 0.5),
        ("x^0 + y", 4.0),
        ("1/x", 0.5),
        ("sqrt(x + 2)", 2.0),
        (" 1.5e1*x\n", 30.0),
        (".5*x", 1.0),
        ("2.*x", 4.0),
        ("log(e)*x", 2.0),
    ] {
        assert!((at(text) - value).abs() < 1e-12, "{text} = {}", at(text));
    }
}

#[test]
fn errors_have_a_place_and_a_message() {
    for (text, place, message, help) in [
        ("", "", "the formula is empty", None),
        ("x +", "", "expected a number or a name, found the end of the formula", None),
        (
            "x^2 + y^2 = 1",
            "=",
            "a formula has no `=`",
            Some("the surface is where the formula is 0: write `a - b` for a = b"),
        ),
        ("2x - 1", "x", "an operator is missing before `x`", Some("products are written with `*`")),
        ("2exp(x)", "exp", "an operator is missing before `exp`", Some("products are written with `*`")),
        ("x**2", "**", "`**` is not an operator", Some("powers are written with `^`")),
        ("xy + z", "xy", "there is no `xy` in formulas", Some("did you mean `x*y`?")),
        ("SIN(x)", "SIN", "there is no `SIN` in formulas", Some("did you mean `sin`?")),
        ("ln(x)", "ln", "there is no `ln` in formulas", Some("did you mean `log`?")),
        ("(x + 1", "(", "this `(` has no `)`", None),
        ("x + 1)", ")", "this `)` has no `(`", None),
        ("sin x", "sin", "`sin` needs its argument in parentheses", None),
        ("min(x)", ")", "`min` needs 2 arguments, separated by commas", None),
        ("sin(x, y)", ",", "too many arguments", None),
        ("x + 1e999", "1e999", "this number is too large", None),
        ("x + \u{3c0}", "\u{3c0}", "expected a number or a name, found `\u{3c0}`", None),
        ("1 + 2", "1 + 2", "the formula is constant: it uses neither x, y nor z", None),
    ] {
        let error = Formula::parse(text).expect_err(text);
        assert_eq!(
            (&text[error.place], error.message.as_str(), error.help.as_deref()),
            (place, message, help),
            "{text}"
        );
    }
}

#[test]
fn size_and_depth_are_bounded() {
    let error = |text: String| Formula::parse(&text).expect_err("too much").message;
    for (open, close) in [("(", ")"), ("-", ""), ("sin(", ")"), ("x^", "")] {
        let deep = format!("{}x{}", open.repeat(1000), close.repeat(1000));
        assert!(error(deep).contains("nested"), "{open}");
    }
    assert!(error("x+".repeat(10_000) + "x").contains("longer"));
    let many: Vec<_> = (0..1100).map(|i| format!("x*{i}.5")).collect();
    assert!(error(many.join("+")).contains("steps"));
    assert_eq!(
        Formula::parse(&format!("x{}", "+x".repeat(900))).expect("no deeper than one").value([1.0; 3]),
        901.0
    );
}
