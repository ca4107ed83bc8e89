//! Operations that WGSL has itself, or the prelude: the methods of numbers with lanes, and of
//! vectors.

use super::names;
use super::types::Type;
use super::value::{Value, bare};

/// The operation `name` of a type, if it is one of WGSL; the receiver is the first argument.
pub fn operation(owner: &Type, name: &str, arguments: &[String]) -> Option<Value> {
    let operator = match name {
        "lt" => "<",
        "le" => "<=",
        "gt" => ">",
        "ge" => ">=",
        "eq" => "==",
        "ne" => "!=",
        "wrapping_add" => "+",
        "wrapping_sub" => "-",
        "wrapping_mul" => "*",
        "shl" => "<<",
        "shr" => ">>",
        _ => "",
    };
    let text = match (owner, name, arguments) {
        (Type::Real | Type::Uint | Type::Bool, _, [a, b]) if !operator.is_empty() => {
            format!("({a} {operator} {b})")
        }
        (_, "select", [mask, a, b]) => call("select", [b, a, mask]),
        (Type::Bool, "splat" | "any" | "all", [x]) | (Type::Real, "splat", [x]) => x.clone(),
        (Type::Real, "zero", []) => "0.0f".into(),
        (Type::Real, "one", []) => "1.0f".into(),
        (Type::Real, "abs" | "sqrt" | "floor" | "copysign", _) => call(name, arguments),
        (Type::Real, "min" | "max", _) => call(&format!("real_{name}"), arguments),
        (Type::Real, "clamp", [x, low, high]) => call("real_min", [&call("real_max", [x, low]), high]),
        (Type::Real, "mul_add", _) => call("fma", arguments),
        (Type::Real, "from_bits", _) => call("bitcast<f32>", arguments),
        (Type::Real, "to_bits", _) => call("bitcast<u32>", arguments),
        (Type::Real, "to_int", [x]) => format!("bitcast<u32>(i32({x}))"),
        (Type::Uint, "to_real", [x]) => format!("f32(bitcast<i32>({x}))"),
        (Type::Uint, "splat", [x]) if names::is_number(x) && !x.ends_with('u') => format!("{x}u"),
        (Type::Uint, "splat", _) => call("u32", arguments),
        (Type::Uint, "min", _) => call(name, arguments),
        (Type::Uint, "div_ceil", [a, b]) => format!("({a} / {b} + u32({a} % {b} != 0))"),
        (Type::Sint, "unsigned_abs", [x]) => format!("u32(abs({x}))"),
        (Type::Named(vector, _), "new" | "splat", _) if owner.coordinates().is_some() => {
            call(&(vector.to_lowercase() + "f"), arguments)
        }
        (_, "abs", _) if owner.coordinates().is_some() => call(name, arguments),
        (_, "broadcast" | "to_array", [v]) if owner.coordinates().is_some() => v.clone(),
        _ => return None,
    };
    let ty = match name {
        _ if ["<", "<=", ">", ">=", "==", "!="].contains(&operator) => Type::Bool,
        "to_bits" | "to_int" | "unsigned_abs" => Type::Uint,
        "to_real" => Type::Real,
        "to_array" => Type::Array(Box::new(Type::Real), owner.coordinates()?),
        _ => owner.clone(),
    };
    Some(Value::Plain(text, ty))
}

/// A call of a function of WGSL.
fn call<'a>(function: &str, arguments: impl IntoIterator<Item = &'a String>) -> String {
    let arguments: Vec<&str> = arguments.into_iter().map(|argument| bare(argument)).collect();
    format!("{function}({})", arguments.join(", "))
}

/// A constant of `std`, or of one of its types.
pub fn standard_constant(owner: Option<&Type>, name: &str) -> Option<Value> {
    use std::f32::consts as c;
    let float = |number: f32| format!("{number:?}f");
    if let (Some(Type::Sint), "MAX") = (owner, name) {
        return Some(Value::Plain(format!("{}i", i32::MAX), Type::Sint));
    }
    let text = match name {
        // The shortest decimal that is nearest to it is larger, which WGSL does not take.
        "MAX" => "3.4028234e38f".into(),
        // No literal has these values; the prelude makes them of their bits.
        "INFINITY" => "infinity()".into(),
        "NEG_INFINITY" => "-infinity()".into(),
        "NAN" => "not_a_number()".into(),
        "PI" => float(c::PI),
        "TAU" => float(c::TAU),
        "FRAC_1_PI" => float(c::FRAC_1_PI),
        "FRAC_2_PI" => float(c::FRAC_2_PI),
        "FRAC_PI_2" => float(c::FRAC_PI_2),
        "FRAC_PI_4" => float(c::FRAC_PI_4),
        "FRAC_1_SQRT_2" => float(c::FRAC_1_SQRT_2),
        "LN_2" => float(c::LN_2),
        "LOG2_E" => float(c::LOG2_E),
        "EPSILON" => float(f32::EPSILON),
        "MIN_POSITIVE" => float(f32::MIN_POSITIVE),
        _ => return None,
    };
    Some(Value::Plain(text, Type::Real))
}
