//! Numbers in text, read fast and exactly.
//!
//! Most numbers of scene files have few digits. If the digits fit into 53 bits and the decimal
//! exponent is at most 22, digits and power of ten are exact as doubles, so that one multiplication
//! or division rounds correctly [Clinger 1990]. All others go to the standard library.

/// A double; `None` if the text is not a decimal number.
#[inline]
pub fn double(text: &[u8]) -> Option<f64> {
    exact(text).or_else(|| slow(text))
}

/// A float, correctly rounded; `None` if the text is not a decimal number.
#[inline]
pub fn float(text: &[u8]) -> Option<f32> {
    /// The mantissa bits of a double beyond those of a float.
    const BELOW: u64 = (1 << 29) - 1;
    /// Their value half way between two floats. The exact value of a double that rounds to it may
    /// be on either side.
    const HALFWAY: u64 = 1 << 28;
    if let Some(value) = exact(text)
        && value.to_bits() & BELOW != HALFWAY
        && (value == 0.0 || value.abs() >= f64::from(f32::MIN_POSITIVE))
    {
        return Some(value as f32);
    }
    if is_decimal(text) { std::str::from_utf8(text).ok()?.parse().ok() } else { None }
}

/// A double, or what programs write for infinity and for no number; `None` for all else.
#[inline]
pub fn lenient(text: &[u8]) -> Option<f64> {
    double(text).or_else(|| special(text))
}

/// The value of `inf`, `-nan`, `1.#QNAN`, `nan(ind)` and the like.
fn special(text: &[u8]) -> Option<f64> {
    let text = String::from_utf8_lossy(text).to_ascii_lowercase();
    let name = text.trim_start_matches(['+', '-']);
    // A width of digits is filled up by some programs.
    let name = name.strip_prefix("1.#").map_or(name, |name| name.trim_end_matches('0'));
    let magnitude = match name {
        "inf" | "infinity" => f64::INFINITY,
        "nan" | "ind" | "qnan" | "snan" => f64::NAN,
        _ if name.starts_with("nan(") => f64::NAN,
        _ => return None,
    };
    Some(if text.starts_with('-') { -magnitude } else { magnitude })
}

/// An integer; `None` if the text is not one or does not fit.
#[inline]
pub fn integer(text: &[u8]) -> Option<i32> {
    let (negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > 10 {
        return None;
    }
    let mut value = 0_i64;
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value * 10 + i64::from(digit - b'0');
    }
    i32::try_from(if negative { -value } else { value }).ok()
}

fn is_decimal(text: &[u8]) -> bool {
    text.iter().all(|byte| matches!(byte, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E'))
}

fn slow(text: &[u8]) -> Option<f64> {
    if is_decimal(text) { std::str::from_utf8(text).ok()?.parse().ok() } else { None }
}

#[inline]
fn exact(text: &[u8]) -> Option<f64> {
    #[rustfmt::skip]
    const POWERS: [f64; 23] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19,
        1e20, 1e21, 1e22,
    ];
    let mut at = 0;
    let negative = match text.first()? {
        b'-' => {
            at = 1;
            true
        }
        b'+' => {
            at = 1;
            false
        }
        _ => false,
    };
    let mut digits = 0_u64;
    let mut exponent = 0_i32;
    let first = at;
    while let Some(byte @ b'0'..=b'9') = text.get(at) {
        digits = digits * 10 + u64::from(byte - b'0');
        at += 1;
        if at - first > 18 {
            return None;
        }
    }
    let mut count = at - first;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let point = at;
        while let Some(byte @ b'0'..=b'9') = text.get(at) {
            digits = digits * 10 + u64::from(byte - b'0');
            at += 1;
            if at - first > 18 {
                return None;
            }
        }
        exponent = -((at - point) as i32);
        count += at - point;
    }
    if count == 0 || digits > 1 << 53 {
        return None;
    }
    if let Some(b'e' | b'E') = text.get(at) {
        exponent = exponent.checked_add(integer(&text[at + 1..])?)?;
    } else if at != text.len() {
        return None;
    }
    let magnitude = match exponent {
        0..=22 => digits as f64 * POWERS[exponent as usize],
        -22..=-1 => digits as f64 / POWERS[-exponent as usize],
        _ => return None,
    };
    Some(if negative { -magnitude } else { magnitude })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    #[test]
    fn invalid_numbers_are_refused() {
        for text in
            ["", "-", ".", "+.", "1x", "inf", "nan", "e5", "1e", "0x10", "--1", "1.2.3", "1e5.", "infinity"]
        {
            assert_eq!((double(text.as_bytes()), float(text.as_bytes())), (None, None), "{text}");
        }
        for text in ["", "-", "1.0", "1e3", "2147483648", "99999999999"] {
            assert_eq!(integer(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn words_for_infinity_and_no_number_are_numbers_where_they_may_be() {
        for (text, value) in [("inf", 1.0), ("-Infinity", -1.0), ("1.#INF", 1.0), ("-1.#INF00", -1.0)] {
            assert_eq!(lenient(text.as_bytes()), Some(value * f64::INFINITY), "{text}");
        }
        for text in ["nan", "-NaN", "nan(ind)", "-nan(ind)", "1.#QNAN", "-1.#IND"] {
            assert!(lenient(text.as_bytes()).is_some_and(f64::is_nan), "{text}");
        }
        assert_eq!((lenient(b"2.5"), lenient(b"name"), lenient(b"")), (Some(2.5), None, None));
    }

    #[test]
    fn unusual_numbers_are_read() {
        let expected = [("1.", 1.0), (".5", 0.5), ("+2", 2.0), ("-0", -0.0), ("1E-3", 1e-3), ("007", 7.0)];
        for (text, value) in expected {
            assert_eq!(float(text.as_bytes()), Some(value), "{text}");
        }
        assert_eq!(integer(b"-2147483648"), Some(i32::MIN));
        // Half way between two floats, and just above it.
        assert_eq!(float(b"16777217"), Some(16_777_216.0));
        assert_eq!(float(b"16777217.000000001"), "16777217.000000001".parse().ok());
    }

    proptest! {
        #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn every_float_is_read_exactly(bits: u32, digits in 0..12_usize) {
            let value = f32::from_bits(bits);
            prop_assume!(value.is_finite());
            for text in [format!("{value}"), format!("{value:e}"), format!("{value:.digits$}"), format!("{value:.digits$e}")] {
                prop_assert_eq!(float(text.as_bytes()), text.parse().ok(), "{}", text);
                prop_assert_eq!(double(text.as_bytes()), text.parse().ok(), "{}", text);
            }
        }

        #[test]
        fn random_text_is_read_as_the_standard_library_does(text in "[-+]?[0-9]{0,20}[.]?[0-9]{0,20}([eE][-+]?[0-9]{1,3})?") {
            prop_assert_eq!(float(text.as_bytes()), text.parse().ok());
            prop_assert_eq!(double(text.as_bytes()), text.parse().ok());
        }
    }
}
