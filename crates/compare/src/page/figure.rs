//! Formatting of numbers and text.

/// A number with three significant digits.
pub fn figure(value: f64) -> String {
    let magnitude = value.abs();
    match magnitude {
        _ if !value.is_finite() => "–".into(),
        0.0 => "0".into(),
        1e-3..1e5 => {
            let digits = (2 - magnitude.log10().floor() as i32).max(0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.2e}"),
    }
}

/// A fraction as a percentage.
pub fn percent(value: f64) -> String {
    if value.is_finite() { format!("{} %", figure(100.0 * value)) } else { "–".into() }
}

/// A large number with a decimal prefix.
pub fn count(value: f64) -> String {
    const PREFIXES: [(f64, &str); 4] = [(1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")];
    match PREFIXES.iter().find(|(size, _)| value >= *size) {
        Some((size, prefix)) => figure(value / size) + prefix,
        None => format!("{value:.0}"),
    }
}

/// Text with the special characters of HTML escaped.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_significant_digits() {
        let figures = [0.0, 0.01234, 1.0, 123.4, -5.678, 45678.9, 1e-9, f64::INFINITY].map(figure);
        assert_eq!(figures, ["0", "0.0123", "1.00", "123", "-5.68", "45679", "1.00e-9", "–"]);
        assert_eq!((percent(0.0123).as_str(), percent(f64::NAN).as_str()), ("1.23 %", "–"));
        assert_eq!([12.0, 12_345.0, 1.5e9].map(count), ["12", "12.3 k", "1.50 G"]);
    }

    #[test]
    fn markup_is_escaped() {
        assert_eq!(escape("<a b=\"c\"> & d"), "&lt;a b=&quot;c&quot;&gt; &amp; d");
    }
}
