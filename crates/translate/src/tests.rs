//! Small sources and their translations.

use super::library::Library;
use super::names;
use super::translate;
use super::translator::Translator;

/// The translation of all functions named `f` and what they use, without empty lines.
fn translated(source: &str) -> Result<String, String> {
    translated_but("", source)
}

/// The same, but for what there is by hand.
fn translated_but(by_hand: &str, source: &str) -> Result<String, String> {
    let mut library = Library::default();
    library.add("source", source)?;
    let mut translator = Translator::new(&library, by_hand);
    translator.root(0, "f")?;
    translate(&mut translator)?;
    Ok(translator.texts_of(None).concat() + &translator.texts_of(Some(0)).concat())
}

/// Asserts the lines within `f`, the last function.
#[track_caller]
fn assert_body(source: &str, expected: &[&str]) {
    let text = translated(source).unwrap();
    let (_, body) = text.split_once("fn f").unwrap();
    let lines: Vec<&str> = body.lines().skip(1).map(str::trim).collect();
    assert_eq!(lines[..lines.len() - 1], *expected, "{text}");
}

#[test]
fn lanes_become_numbers() {
    let text =
        translated("fn f<R: Real>(x: R, m: R::Mask) -> R { R::select(m, x.max(R::zero()).sqrt(), -x) }");
    assert_eq!(
        text.unwrap(),
        "fn f(x: f32, m: bool) -> f32 {\n    return select(-x, sqrt(real_max(x, 0.0f)), m);\n}\n"
    );
}

#[test]
fn literals_keep_their_values() {
    assert_body(
        "fn f<R: Real>(x: R) -> R { x * R::splat(0.159_15) - R::splat(2.0 * PI) }",
        &["return (x * 0.15915f) - (2.0f * 3.1415927f);"],
    );
    assert_body(
        "fn f<I: Int>(v: I) -> I { (v ^ v.shr(16)).wrapping_mul(I::splat(0x7feb_352d)) }",
        &["return (v ^ (v >> 16)) * 0x7feb352du;"],
    );
}

#[test]
fn shadowed_and_reserved_names_are_renamed() {
    assert_body(
        "fn f<R: Real>(x: R) -> R { let smooth = x + x; let x = smooth * x; x }",
        &["let smooth_1 = x + x;", "let x_1 = smooth_1 * x;", "return x_1;"],
    );
}

#[test]
fn tuples_arrays_and_closures_are_resolved() {
    assert_body(
        "fn f<R: Real>(x: R) -> R {
            let [a, b] = [1.0, 2.0].each(R::splat);
            let (p, q) = (x + a, x * b);
            let sum = |y: R| y + p;
            sum(q)
        }",
        &["let p = x + 1.0f;", "let q = x * 2.0f;", "return q + p;"],
    );
}

#[test]
fn functions_of_functions_are_inlined() {
    assert_body(
        "struct S<R>([R; N]);
        impl<R: Real> S<R> {
            fn map(self, f: impl Fn(R) -> R) -> Self { Self(self.0.each(f)) }
            fn twice(self) -> Self { self.map(|x| x + x) }
        }
        fn f<R: Real>(s: S<R>) -> S<R> { s.twice() }",
        &["return S_twice(s);"],
    );
}

#[test]
fn results_of_several_values_are_structs() {
    let text = translated(
        "fn g<R: Real>(x: R) -> (R, R::Mask) { (x, x.lt(R::one())) }
        fn f<R: Real>(x: R) -> R { let (y, valid) = g(x); if valid.any() { y } else { R::zero() } }",
    );
    let expected = "struct Tuple_f32_bool {\n    v0: f32,\n    v1: bool,\n}\n\
        fn g(x: f32) -> Tuple_f32_bool {\n    return Tuple_f32_bool(x, x < 1.0f);\n}\n\
        fn f(x: f32) -> f32 {\n    let parts = g(x);\n    let y = parts.v0;\n    let valid = parts.v1;\n    \
        if (valid) {\n        return y;\n    } else {\n        return 0.0f;\n    }\n}\n";
    assert_eq!(text.unwrap(), expected);
}

#[test]
fn methods_change_what_they_are_called_on() {
    assert_body(
        "struct S<R> { x: R }
        impl<R: Real> S<R> { fn step(&mut self) -> R { self.x += R::one(); self.x } }
        fn f<R: Real>(x: R) -> R { let mut s = S { x }; s.step() * s.step() }",
        &[
            "var s = S(x);",
            "let result = S_step(&s);",
            "let result_1 = S_step(&s);",
            "return result * result_1;",
        ],
    );
}

#[test]
fn matches_and_loops_stay() {
    assert_body(
        "enum E { A, B }
        fn f<R: Real>(e: E, n: u32, x: R) -> R {
            let y = match e { E::A => x * x, E::B => x };
            let mut sum = y;
            for i in 0..n { if i == 3 { break; } sum += x; }
            sum
        }",
        &[
            "var chosen: f32;",
            "if (e == E_A) {",
            "chosen = x * x;",
            "} else {",
            "chosen = x;",
            "}",
            "let y = chosen;",
            "var sum = y;",
            "for (var i = 0u; i < n; i++) {",
            "if (i == 3) {",
            "break;",
            "}",
            "sum += x;",
            "}",
            "return sum;",
        ],
    );
}

#[test]
fn loops_over_parts_are_unrolled() {
    assert_body(
        "fn f<I: Int>(words: [I; 2]) -> [I; 2] {
            let mut mixed = words;
            for v in &mut mixed { *v = v.wrapping_add(I::splat(1)); }
            mixed
        }",
        &[
            "var mixed = words;",
            "{",
            "mixed[0] = mixed[0] + 1u;",
            "}",
            "{",
            "mixed[1] = mixed[1] + 1u;",
            "}",
            "return mixed;",
        ],
    );
}

#[test]
fn what_is_not_in_the_subset_is_an_error() {
    for source in [
        "fn f(x: &[f32]) -> f32 { x[0] }",
        "fn f<R: Real>(x: R) -> R { unknown(x) }",
        "fn f<R: Real>(x: R) -> R { x.unknown() }",
        "fn f<R: Real>(x: R) -> R { let g = |y| { return y; }; g(x) }",
        "fn f<R: Real>(x: Option<R>) -> R { x.unwrap_or(R::zero()) }",
    ] {
        assert!(translated(source).is_err(), "{source}");
    }
}

#[test]
fn errors_name_the_line_and_what_is_translated() {
    let source = "fn f<R: Real>(x: R) -> R {\n    let y = {\n        unknown(x)\n    };\n    y\n}";
    assert_eq!(translated(source).unwrap_err(), "source:3: the function unknown, in f");
    let source = "struct S<R> { x: T<R> }\nstruct T<R> { y: R }\n\
        impl<R: Real> T<R> { fn g(&mut self) { self.y = R::one(); } }\n\
        fn f<R: Real>(s: &mut S<R>) {\n    s.x.g();\n}";
    assert_eq!(translated(source).unwrap_err(), "source:5: a reference to a part, (*s).x, in f");
}

#[test]
fn macros_of_a_name_are_expanded() {
    let text = translated(
        "macro_rules! methods { ($vector:ident) => { impl<R: Real> $vector<R> {
            fn double(self) -> Self { self + self }
        } } }
        methods!(Vec3);
        fn f<R: Real>(v: Vec3<R>) -> Vec3<R> { v.double() }",
    );
    let expected = "fn Vec3_double(this_: vec3f) -> vec3f {\n    return this_ + this_;\n}\n\
        fn f(v: vec3f) -> vec3f {\n    return Vec3_double(v);\n}\n";
    assert_eq!(text.unwrap(), expected);
}

#[test]
fn what_is_by_hand_is_not_translated() {
    let text = translated_but(
        "fn g(x: f32) -> Tuple_f32_f32 {",
        "fn g<R: Real>(x: R) -> (R, R) { x.untranslatable() }
        fn f<R: Real>(x: R) -> R { g(x).1 }",
    );
    let expected = "struct Tuple_f32_f32 {\n    v0: f32,\n    v1: f32,\n}\n\
        fn f(x: f32) -> f32 {\n    return g(x).v1;\n}\n";
    assert_eq!(text.unwrap(), expected);
}

#[test]
fn pairs_of_arrays_are_taken_apart() {
    assert_body(
        "fn f<R: Real>(x: R) -> R {
            let mut sums = [R::zero(); 2];
            for (i, (sum, y)) in sums.iter_mut().zip([x, x * x]).enumerate() {
                *sum += y * R::splat(i as f32);
            }
            sums[0] + sums[1]
        }",
        &[
            "var sums = vec2f(0.0f, 0.0f);",
            "{",
            "sums[0] += x * f32(0);",
            "}",
            "{",
            "let y = x * x;",
            "sums[1] += y * f32(1);",
            "}",
            "return sums.x + sums.y;",
        ],
    );
}

#[test]
fn arguments_of_types_are_inferred() {
    assert_body(
        "struct One<R> { y: R }
        struct Pair<B, R> { b: B, x: R }
        struct Holder<'a, B, R> { pair: &'a Pair<B, R> }
        fn f<R: Real>(x: R) -> R {
            let h = Holder { pair: &Pair { b: One { y: x }, x } };
            h.pair.x
        }",
        &["let h = Holder_One(Pair_One(One(x), x));", "return h.pair.x;"],
    );
}

#[test]
fn integers_have_limits() {
    assert_body(
        "fn f(n: u32) -> i32 { n.div_ceil(2).min(i32::MAX as u32) as i32 }",
        &["return i32(min(n / 2 + u32(n % 2 != 0), u32(2147483647i)));"],
    );
}

#[test]
fn the_largest_float_is_not_exceeded() {
    assert_body("fn f(x: f32) -> f32 { x + f32::MAX }", &["return x + 3.4028234e38f;"]);
}

#[test]
fn arrays_longer_than_vectors_have_no_coordinates() {
    assert_body("fn f<R: Real>(x: [R; 5]) -> R { x[0] + x[4] }", &["return x[0] + x[4];"]);
    assert_body("fn f<R: Real>(x: [R; 4]) -> R { x[0] + x[3] }", &["return x.x + x.w;"]);
}

#[test]
fn words_of_wgsl_are_taken() {
    assert!(
        names::is_taken("abs")
            && names::is_taken("yield")
            && names::is_taken("smooth")
            && !names::is_taken("smooth_1")
    );
    assert_eq!((names::member("self"), names::member("pdf")), ("self_".to_owned(), "pdf".to_owned()));
}

#[test]
fn numbers_and_identifiers_are_told_apart() {
    assert!(
        names::is_number("-1.5e-3f")
            && names::is_number("0x7fu")
            && !names::is_number("x1")
            && !names::is_number("(1 + 2)")
    );
    assert!(names::is_identifier("x_1") && !names::is_identifier("x.y") && !names::is_identifier("1x"));
}
