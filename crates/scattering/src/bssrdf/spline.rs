//! Cubic splines through values at nodes of any distance, after Catmull and Rom: the slope at a
//! node is that of the line through its neighbours, and at an end that of the last line.
//!
//! Source: [Pharr 2016 §8.6.1, §13.3.3].

use math::find_interval;

/// The nodes on which a value of the spline depends, and their weights. At the ends some nodes are
/// named twice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    pub nodes: [usize; 4],
    pub weights: [f32; 4],
}

impl Weights {
    /// Those at `x`; `None` beyond the first and last of the ascending `nodes`.
    pub fn at(nodes: &[f32], x: f32) -> Option<Self> {
        let last = nodes.len() - 1;
        if !(nodes[0] <= x && x <= nodes[last]) {
            return None;
        }
        let i = find_interval(nodes.len(), |i| nodes[i] <= x);
        let width = nodes[i + 1] - nodes[i];
        let t = (x - nodes[i]) / width;
        let [near, from_slope, to_slope] =
            [1.0 - t * t * (3.0 - 2.0 * t), t * (1.0 - t) * (1.0 - t), -t * t * (1.0 - t)];
        let (before, after) = (i.saturating_sub(1), (i + 2).min(last));
        let from = from_slope * width / (nodes[i + 1] - nodes[before]);
        let to = to_slope * width / (nodes[after] - nodes[i]);
        Some(Self { nodes: [before, i, i + 1, after], weights: [-from, near - to, 1.0 - near + from, to] })
    }

    /// The sum of the weighted values.
    pub fn sum(&self, value: impl Fn(usize) -> f32) -> f32 {
        self.nodes.iter().zip(self.weights).map(|(&node, weight)| weight * value(node)).sum()
    }
}

/// The cubic polynomial between two nodes, as the coefficients of the powers of t in [0, 1].
struct Segment {
    start: f32,
    width: f32,
    c: [f32; 4],
}

impl Segment {
    /// That after node `i`.
    fn new(nodes: &[f32], i: usize, value: impl Fn(usize) -> f32) -> Self {
        let (before, after) = (i.saturating_sub(1), (i + 2).min(nodes.len() - 1));
        let (start, width) = (nodes[i], nodes[i + 1] - nodes[i]);
        let (f0, f1) = (value(i), value(i + 1));
        let from = width * (f1 - value(before)) / (nodes[i + 1] - nodes[before]);
        let to = width * (value(after) - f0) / (nodes[after] - nodes[i]);
        let rise = f1 - f0;
        Self { start, width, c: [f0, from, 3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise] }
    }

    fn value(&self, t: f32) -> f32 {
        let [a, b, c, d] = self.c;
        a + t * (b + t * (c + t * d))
    }

    fn slope(&self, t: f32) -> f32 {
        let [_, b, c, d] = self.c;
        b + t * (2.0 * c + t * 3.0 * d)
    }

    /// The integral over t from 0.
    fn integral(&self, t: f32) -> f32 {
        let [a, b, c, d] = self.c;
        t * (a + t * (b / 2.0 + t * (c / 3.0 + t * (d / 4.0))))
    }

    fn x(&self, t: f32) -> f32 {
        self.start + self.width * t
    }
}

/// The running integral of the spline at each node.
pub(super) fn integrate(nodes: &[f32], values: &[f32]) -> Vec<f32> {
    let mut sum = 0.0;
    let segments = (0..nodes.len() - 1).map(|i| {
        let segment = Segment::new(nodes, i, |i| values[i]);
        sum += segment.width * segment.integral(1.0);
        sum
    });
    std::iter::once(0.0).chain(segments).collect()
}

/// Where a spline through ascending `values` has the value `y`; the nearest end if nowhere.
pub(super) fn invert(nodes: &[f32], values: &[f32], y: f32) -> f32 {
    let last = nodes.len() - 1;
    if y.is_nan() || y <= values[0] {
        return nodes[0];
    }
    if y >= values[last] {
        return nodes[last];
    }
    let segment = Segment::new(nodes, find_interval(nodes.len(), |i| values[i] <= y), |i| values[i]);
    segment.x(solve(y, 0.5, |t| (segment.value(t), segment.slope(t))))
}

/// A position with the density of a spline, whose running integral is `cdf`; `None` if the spline
/// has no positive integral.
pub(super) fn sample(
    nodes: &[f32],
    value: impl Fn(usize) -> f32,
    cdf: impl Fn(usize) -> f32,
    u: f32,
) -> Option<f32> {
    let total = cdf(nodes.len() - 1);
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    let u = u * total;
    let i = find_interval(nodes.len(), |i| cdf(i) <= u);
    let segment = Segment::new(nodes, i, value);
    let u = (u - cdf(i)) / segment.width;
    // Newton's method starts where a straight line would be.
    let (f0, rise) = (segment.value(0.0), segment.value(1.0) - segment.value(0.0));
    let start = 2.0 * u / (f0 + (f0 * f0 + 2.0 * u * rise).max(0.0).sqrt());
    Some(segment.x(solve(u, start, |t| (segment.integral(t), segment.value(t)))))
}

/// Where an ascending function of [0, 1], given with its slope, is `y`: Newton's method within
/// bounds that bisection narrows.
fn solve(y: f32, start: f32, f: impl Fn(f32) -> (f32, f32)) -> f32 {
    let (mut low, mut high, mut t) = (0.0, 1.0, start);
    for _ in 0..32 {
        if !(low < t && t < high) {
            t = 0.5 * (low + high);
        }
        let (value, slope) = f(t);
        if (value - y).abs() <= 1e-6 * y.abs() || high - low < 1e-6 {
            break;
        }
        if value < y {
            low = t;
        } else {
            high = t;
        }
        t -= (value - y) / slope;
    }
    t.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: [f32; 6] = [0.0, 0.1, 0.25, 0.7, 1.0, 2.0];

    #[test]
    fn lines_are_reproduced() {
        for x in [0.0, 0.05, 0.1, 0.2, 0.5, 0.99, 1.5, 2.0] {
            let weights = Weights::at(&NODES, x).unwrap();
            assert!((weights.sum(|i| 3.0 - 2.0 * NODES[i]) - (3.0 - 2.0 * x)).abs() < 1e-5, "{x}");
            assert!((weights.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
        assert!(Weights::at(&NODES, -1e-6).is_none() && Weights::at(&NODES, 2.001).is_none());
        assert!(Weights::at(&NODES, f32::NAN).is_none());
    }

    #[test]
    fn weights_and_segments_are_one_spline() {
        let values = [0.0, 2.0, 1.0, 4.0, 4.5, 0.5];
        for i in 0..NODES.len() - 1 {
            let segment = Segment::new(&NODES, i, |i| values[i]);
            for t in [0.0, 0.2, 0.5, 0.9] {
                let sum = Weights::at(&NODES, segment.x(t)).unwrap().sum(|i| values[i]);
                assert!((sum - segment.value(t)).abs() < 1e-4, "{i} {t}");
            }
        }
    }

    #[test]
    fn the_integral_of_a_line_is_exact() {
        let cdf = integrate(&NODES, &NODES.map(|x| 1.0 + x));
        for (x, sum) in NODES.iter().zip(cdf) {
            assert!((sum - (x + x * x / 2.0)).abs() < 1e-5);
        }
    }

    #[test]
    fn inversion_finds_the_value() {
        let values = [0.1, 0.2, 0.5, 0.6, 1.5, 1.6];
        for y in [0.1, 0.15, 0.3, 0.55, 1.0, 1.59] {
            let x = invert(&NODES, &values, y);
            assert!((Weights::at(&NODES, x).unwrap().sum(|i| values[i]) - y).abs() < 1e-4, "{y}");
        }
        assert_eq!([invert(&NODES, &values, 0.0), invert(&NODES, &values, 2.0)], [0.0, 2.0]);
    }

    /// The inverse of the running integral of 1 + x, in closed form.
    #[test]
    fn samples_invert_the_integral() {
        let values = NODES.map(|x| 1.0 + x);
        let cdf = integrate(&NODES, &values);
        for u in [0.0, 0.01, 0.3, 0.5, 0.999] {
            let x = sample(&NODES, |i| values[i], |i| cdf[i], u).unwrap();
            assert!((x - ((1.0 + 8.0 * u).sqrt() - 1.0)).abs() < 1e-4, "{u}: {x}");
        }
        assert_eq!(sample(&NODES, |_| 0.0, |_| 0.0, 0.5), None);
    }
}
