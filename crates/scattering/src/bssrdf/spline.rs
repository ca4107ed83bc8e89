//! Cubic splines through values at nodes of any distance, after Catmull and Rom: the slope at a
//! node is that of the line through its neighbours, and at an end that of the last line.
//!
//! Source: [Pharr 2016 §8.6.1, §13.3.3].

use lanes::Each;
use math::find_interval;
use spectrum::{N, SampledSpectrum};

/// Ascending nodes, or a value for each. The first and the last are there twice, so that the four
/// on which a place of the spline depends follow one another.
#[derive(Clone, Debug)]
pub(super) struct Nodes(Vec<f32>);

impl Nodes {
    /// From the nodes, of which there are two at least.
    pub fn new(nodes: &[f32]) -> Self {
        let ends = [nodes[0], nodes[nodes.len() - 1]];
        Self(ends[..1].iter().chain(nodes).chain(&ends[1..]).copied().collect())
    }

    /// The nodes.
    pub fn all(&self) -> &[f32] {
        &self.0[1..self.0.len() - 1]
    }

    /// All, with the ends twice.
    pub fn twice(&self) -> &[f32] {
        &self.0
    }

    /// The four nodes around the interval after node `i`.
    pub fn around(&self, i: usize) -> [f32; 4] {
        four(&self.0, i)
    }

    /// The same for four intervals: the first nodes of each, the second ones, and so on.
    #[inline]
    pub fn around_each(&self, intervals: [usize; N]) -> [SampledSpectrum; 4] {
        let mut nodes = [SampledSpectrum::ZERO; 4];
        for (i, &interval) in intervals.iter().enumerate() {
            let four = self.around(interval);
            for k in 0..4 {
                nodes[k][i] = four[k];
            }
        }
        nodes
    }

    /// Whether `x` lies between the first and the last.
    #[inline]
    pub fn has_between(&self, x: f32) -> bool {
        self.0.first().is_some_and(|&first| first <= x) && self.0.last().is_some_and(|&last| x <= last)
    }

    /// The interval of `x`; the first or the last beyond them.
    pub fn interval(&self, x: f32) -> usize {
        let nodes = self.all();
        let (mut i, mut step) = (0, (nodes.len() - 1).next_power_of_two() / 2);
        while step > 0 {
            let next = i + step;
            // An index instead of a branch, which nobody could predict.
            i += step * usize::from(next < nodes.len() - 1 && nodes[next] <= x);
            step /= 2;
        }
        i
    }
}

/// The four numbers of a table from an index on.
#[inline]
pub(super) fn four(table: &[f32], index: usize) -> [f32; 4] {
    *table[index..].first_chunk().expect("an index inside of the table")
}

/// Of the four nodes from one on the weights with which a value of the spline depends on them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Weights {
    /// Among the [`Nodes`], the ends of which are there twice.
    pub first: usize,
    pub weights: [f32; 4],
}

impl Weights {
    /// The values at `x`; `None` beyond the first and last of the nodes.
    pub fn at(nodes: &Nodes, x: f32) -> Option<Self> {
        nodes.has_between(x).then(|| {
            let first = nodes.interval(x);
            let weights = weights(nodes.around_each([first; N]), SampledSpectrum::splat(x));
            Self { first, weights: weights.each(|weights| weights[0]) }
        })
    }

    /// The sum of the weighted values of the four nodes.
    #[inline]
    pub fn sum(&self, values: [f32; 4]) -> f32 {
        let ([a, b, c, d], [p, q, r, s]) = (self.weights, values);
        a * p + b * q + c * r + d * s
    }
}

/// The weights of four nodes for places between the middle ones, four at once.
#[inline]
pub(super) fn weights(nodes: [SampledSpectrum; 4], x: SampledSpectrum) -> [SampledSpectrum; 4] {
    let [before, here, next, after] = nodes;
    let width = next - here;
    let t = (x - here) / width;
    let rest = 1.0 - t;
    let near = 1.0 - t * t * (3.0 - 2.0 * t);
    let from = t * rest * rest * width / (next - before);
    let to = -t * t * rest * width / (after - here);
    [-from, near - to, 1.0 - near + from, to]
}

/// The cubic polynomial between two nodes, as the coefficients of the powers of t in [0, 1].
struct Segment {
    start: f32,
    width: f32,
    c: [f32; 4],
}

impl Segment {
    /// Between the middle ones of four nodes with their values.
    fn new([before, here, next, after]: [f32; 4], [f_before, f0, f1, f_after]: [f32; 4]) -> Self {
        let (start, width) = (here, next - here);
        let from = width * (f1 - f_before) / (next - before);
        let to = width * (f_after - f0) / (after - here);
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
pub(super) fn integrate(nodes: &Nodes, values: &Nodes) -> Vec<f32> {
    let mut sum = 0.0;
    let segments = (0..nodes.all().len() - 1).map(|i| {
        let segment = Segment::new(nodes.around(i), values.around(i));
        sum += segment.width * segment.integral(1.0);
        sum
    });
    std::iter::once(0.0).chain(segments).collect()
}

/// Where a spline through ascending `values` has the value `y`; the nearest end if nowhere.
pub(super) fn invert(nodes: &Nodes, values: &Nodes, y: f32) -> f32 {
    let (x, f) = (nodes.all(), values.all());
    let last = x.len() - 1;
    if y.is_nan() || y <= f[0] {
        return x[0];
    }
    if y >= f[last] {
        return x[last];
    }
    let i = values.interval(y);
    let segment = Segment::new(nodes.around(i), values.around(i));
    segment.x(solve(y, 0.5, |t| (segment.value(t), segment.slope(t))))
}

/// A position with the density of a spline, whose running integral is `cdf` at each node; `None` if
/// the spline has no positive integral. `values` are those of the four nodes around an interval.
pub(super) fn sample(
    nodes: &Nodes,
    values: impl Fn(usize) -> [f32; 4],
    cdf: impl Fn(usize) -> f32,
    u: f32,
) -> Option<f32> {
    let count = nodes.all().len();
    let total = cdf(count - 1);
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    let u = u * total;
    let i = find_interval(count, |i| cdf(i) <= u);
    let segment = Segment::new(nodes.around(i), values(i));
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
        let (nodes, values) = (Nodes::new(&NODES), Nodes::new(&NODES.map(|x| 3.0 - 2.0 * x)));
        for x in [0.0, 0.05, 0.1, 0.2, 0.5, 0.99, 1.5, 2.0] {
            let weights = Weights::at(&nodes, x).unwrap();
            let sum = weights.sum(values.around(weights.first));
            assert!((sum - (3.0 - 2.0 * x)).abs() < 1e-5, "{x}");
            assert!((weights.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
        assert!(Weights::at(&nodes, -1e-6).is_none() && Weights::at(&nodes, 2.001).is_none());
        assert!(Weights::at(&nodes, f32::NAN).is_none());
    }

    #[test]
    fn intervals_are_those_of_a_bisection() {
        for count in 2..40 {
            let ascending: Vec<f32> = (0..count).map(|i| (i * i) as f32).collect();
            let nodes = Nodes::new(&ascending);
            for i in -2..count * count + 2 {
                let x = i as f32 + if i % 3 == 0 { 0.5 } else { 0.0 };
                let expected = find_interval(count as usize, |i| ascending[i] <= x);
                assert_eq!(nodes.interval(x), expected, "{x} of {count}");
            }
        }
    }

    #[test]
    fn weights_and_segments_are_one_spline() {
        let (nodes, values) = (Nodes::new(&NODES), Nodes::new(&[0.0, 2.0, 1.0, 4.0, 4.5, 0.5]));
        for i in 0..NODES.len() - 1 {
            let segment = Segment::new(nodes.around(i), values.around(i));
            for t in [0.0, 0.2, 0.5, 0.9] {
                let weights = Weights::at(&nodes, segment.x(t)).unwrap();
                let sum = weights.sum(values.around(weights.first));
                assert!((sum - segment.value(t)).abs() < 1e-4, "{i} {t}");
            }
        }
    }

    #[test]
    fn the_integral_of_a_line_is_exact() {
        let cdf = integrate(&Nodes::new(&NODES), &Nodes::new(&NODES.map(|x| 1.0 + x)));
        for (x, sum) in NODES.iter().zip(cdf) {
            assert!((sum - (x + x * x / 2.0)).abs() < 1e-5);
        }
    }

    #[test]
    fn inversion_finds_the_value() {
        let (nodes, values) = (Nodes::new(&NODES), Nodes::new(&[0.1, 0.2, 0.5, 0.6, 1.5, 1.6]));
        for y in [0.1, 0.15, 0.3, 0.55, 1.0, 1.59] {
            let weights = Weights::at(&nodes, invert(&nodes, &values, y)).unwrap();
            assert!((weights.sum(values.around(weights.first)) - y).abs() < 1e-4, "{y}");
        }
        assert_eq!([0.0, 2.0].map(|y| invert(&nodes, &values, y)), [0.0, 2.0]);
    }

    /// The inverse of the running integral of 1 + x, in closed form.
    #[test]
    fn samples_invert_the_integral() {
        let (nodes, values) = (Nodes::new(&NODES), Nodes::new(&NODES.map(|x| 1.0 + x)));
        let cdf = integrate(&nodes, &values);
        for u in [0.0, 0.01, 0.3, 0.5, 0.999] {
            let x = sample(&nodes, |i| values.around(i), |i| cdf[i], u).unwrap();
            assert!((x - ((1.0 + 8.0 * u).sqrt() - 1.0)).abs() < 1e-4, "{u}: {x}");
        }
        assert_eq!(sample(&nodes, |_| [0.0; 4], |_| 0.0, 0.5), None);
    }
}
