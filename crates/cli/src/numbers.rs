//! Numbers formatted for people.

use std::time::Duration;

/// A count with three digits and a decimal prefix: 1234567 is "1.23 M".
pub fn count(value: f64) -> String {
    const PREFIXES: [(f64, &str); 4] = [(1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")];
    match PREFIXES.iter().find(|(size, _)| value >= 0.9995 * size) {
        Some((size, prefix)) => format!("{}{prefix}", three_digits(value / size)),
        None if value.fract() == 0.0 => format!("{value}"),
        None => three_digits(value),
    }
}

/// A size in memory with a binary prefix.
pub fn bytes(value: u64) -> String {
    const PREFIXES: [(u64, &str); 3] = [(1 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    match PREFIXES.iter().find(|(size, _)| value >= *size) {
        Some((size, prefix)) => format!("{} {prefix}", three_digits(value as f64 / *size as f64)),
        None => format!("{value} bytes"),
    }
}

/// A time in the units that suit its length.
pub fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{} s", three_digits(time.as_secs_f64())),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

fn three_digits(value: f64) -> String {
    match value {
        v if v >= 99.95 => format!("{v:.0}"),
        v if v >= 9.995 => format!("{v:.1}"),
        v => format!("{v:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_and_a_unit() {
        let counts = [0.0, 7.0, 0.5, 999.0, 1000.0, 1_234_567.0, 999_700.0, 5e13];
        assert_eq!(counts.map(count), ["0", "7", "0.50", "999", "1.00 k", "1.23 M", "1.00 M", "50.0 T"]);
        assert_eq!([12, 2048, 300 << 20].map(bytes), ["12 bytes", "2.00 KiB", "300 MiB"]);
        let times = [0.5, 12.34, 192.0, 7260.0].map(|seconds| duration(Duration::from_secs_f64(seconds)));
        assert_eq!(times, ["0.50 s", "12.3 s", "3 min 12 s", "2 h 01 min"]);
    }
}
