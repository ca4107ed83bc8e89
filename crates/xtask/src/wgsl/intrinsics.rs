//! Operations that WGSL has itself, or the prelude: the methods of numbers with lanes, and of
//! vectors.

use super::names;
use super::types::Type;
use super::value::{Value, bare};

/// A call of a function of WGSL.
fn call(function: &str, arguments: &[&String]) -> String {
    let arguments: Vec<&str> = arguments.iter().map(|argument| bare(argument)).collect();
    format!("{function}({})", arguments.join(", "))
}

/// Whether vectors have an operation in WGSL, which is taken instead of the method of `math`.
pub fn is_operation(owner: &Type, name: &str) -> bool {
    let operations = ["new", "splat", "broadcast", "into", "from", "from_array", "to_array", "abs", "select"];
    owner.coordinates().is_some() && operations.contains(&name)
}

/// The operation `name` of a type, if it is one of WGSL; the receiver is the first argument.
pub fn operation(owner: &Type, name: &str, arguments: &[String]) -> Option<Value> {
    let plain = |text: String, ty: &Type| Some(Value::Plain(text, ty.clone()));
    if let ("select", [mask, a, b]) = (name, arguments) {
        return plain(call("select", &[b, a, mask]), owner);
    }
    if let Some(comparison) = comparison(name)
        && let [a, b] = arguments
        && matches!(owner, Type::Real | Type::Uint | Type::Bool)
    {
        return Some(Value::bool(format!("({a} {comparison} {b})")));
    }
    match owner {
        Type::Real => real(name, arguments),
        Type::Uint => uint(name, arguments),
        Type::Sint => match (name, arguments) {
            ("unsigned_abs", [x]) => plain(format!("u32(abs({x}))"), &Type::Uint),
            _ => None,
        },
        Type::Bool => match (name, arguments) {
            ("splat" | "any" | "all", [a]) => Some(Value::bool(a.clone())),
            _ => None,
        },
        Type::Literal => uint(name, arguments),
        _ => match (name, arguments) {
            _ if owner.coordinates().is_none() => None,
            ("new", _) => {
                plain(call(&format!("vec{}f", arguments.len()), &arguments.iter().collect::<Vec<_>>()), owner)
            }
            ("splat", [a]) => plain(format!("vec{}f({a})", owner.coordinates()?), owner),
            ("broadcast" | "into" | "from", [a]) => plain(a.clone(), owner),
            ("from_array", [a]) => plain(a.clone(), owner),
            ("to_array", [a]) => plain(a.clone(), &Type::Array(Box::new(Type::Real), owner.coordinates()?)),
            ("abs", [a]) => plain(call("abs", &[a]), owner),
            _ => None,
        },
    }
}

fn comparison(name: &str) -> Option<&'static str> {
    Some(match name {
        "lt" => "<",
        "le" => "<=",
        "gt" => ">",
        "ge" => ">=",
        "eq" => "==",
        "ne" => "!=",
        _ => return None,
    })
}

fn real(name: &str, arguments: &[String]) -> Option<Value> {
    let text = match (name, arguments) {
        ("splat", [x]) => x.clone(),
        ("zero", []) => "0.0f".into(),
        ("one", []) => "1.0f".into(),
        ("abs" | "sqrt" | "floor", [x]) => call(name, &[x]),
        ("min" | "max", [a, b]) => call(&format!("real_{name}"), &[a, b]),
        ("clamp", [x, low, high]) => call("real_min", &[&call("real_max", &[x, low]), high]),
        ("copysign", [x, sign]) => call("copysign", &[x, sign]),
        ("mul_add", [a, b, c]) => call("fma", &[a, b, c]),
        ("from_bits", [bits]) => call("bitcast<f32>", &[bits]),
        ("to_bits", [x]) => return Some(Value::Plain(call("bitcast<u32>", &[x]), Type::Uint)),
        ("to_int", [x]) => return Some(Value::Plain(format!("bitcast<u32>(i32({x}))"), Type::Uint)),
        _ => return None,
    };
    Some(Value::real(text))
}

fn uint(name: &str, arguments: &[String]) -> Option<Value> {
    let text = match (name, arguments) {
        ("splat", [x]) if names::is_number(x) && !x.ends_with('u') => format!("{x}u"),
        ("splat", [x]) => call("u32", &[x]),
        ("min", [a, b]) => call("min", &[a, b]),
        ("div_ceil", [a, b]) => format!("({a} / {b} + u32({a} % {b} != 0))"),
        ("wrapping_add", [a, b]) => format!("({a} + {b})"),
        ("wrapping_sub", [a, b]) => format!("({a} - {b})"),
        ("wrapping_mul", [a, b]) => format!("({a} * {b})"),
        ("shl", [x, bits]) => format!("({x} << {bits})"),
        ("shr", [x, bits]) => format!("({x} >> {bits})"),
        ("to_real", [x]) => return Some(Value::real(format!("f32(bitcast<i32>({x}))"))),
        _ => return None,
    };
    Some(Value::Plain(text, Type::Uint))
}

/// A constant of `std`, or of one of its types.
pub fn standard_constant(owner: Option<&Type>, name: &str) -> Option<Value> {
    use std::f32::consts as c;
    if let (Some(Type::Sint), "MAX") = (owner, name) {
        return Some(Value::Plain(format!("{}i", i32::MAX), Type::Sint));
    }
    let number = match name {
        "PI" => c::PI,
        "TAU" => c::TAU,
        "FRAC_1_PI" => c::FRAC_1_PI,
        "FRAC_2_PI" => c::FRAC_2_PI,
        "FRAC_PI_2" => c::FRAC_PI_2,
        "FRAC_PI_4" => c::FRAC_PI_4,
        "FRAC_1_SQRT_2" => c::FRAC_1_SQRT_2,
        "LN_2" => c::LN_2,
        "LOG2_E" => c::LOG2_E,
        "EPSILON" => f32::EPSILON,
        "MIN_POSITIVE" => f32::MIN_POSITIVE,
        // The shortest decimal that is nearest to it is larger, which WGSL does not take.
        "MAX" => return Some(Value::real("3.4028234e38f")),
        // No literal has these values; the prelude makes them of their bits.
        "INFINITY" => return Some(Value::real("infinity()")),
        "NEG_INFINITY" => return Some(Value::real("-infinity()")),
        "NAN" => return Some(Value::real("not_a_number()")),
        _ => return None,
    };
    Some(Value::real(format!("{number:?}f")))
}
