//! Spectra given by values at some wavelengths, linear between them and zero outside, and the text
//! form of them.
//!
//! Text: numbers separated by white space, alternately wavelength and value, wavelengths in
//! nanometres and strictly increasing; `#` starts a comment to the end of the line.

use lanes::{Int, Real};
use std::fmt;

use crate::dense::DenselySampled;

/// Why pairs of wavelength and value are not a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumError {
    /// There are no values at all.
    Empty,
    /// A word that is not a finite number.
    NotANumber {
        /// The word.
        found: String,
    },
    /// The last wavelength has no value.
    NoValue {
        /// That wavelength.
        lambda: f32,
    },
    /// A wavelength is not larger than the one before it.
    NotIncreasing {
        /// The wavelength before.
        previous: f32,
        /// The wavelength that is not larger.
        lambda: f32,
    },
}

impl fmt::Display for SpectrumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "there are no values"),
            Self::NotANumber { found } => write!(f, "`{found}` is not a finite number"),
            Self::NoValue { lambda } => write!(f, "the wavelength {lambda} has no value"),
            Self::NotIncreasing { previous, lambda } => {
                write!(f, "wavelengths must increase: {lambda} follows {previous}")
            }
        }
    }
}

impl std::error::Error for SpectrumError {}

/// A [`SpectrumError`] and its position in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct ParseError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong there.
    pub error: SpectrumError,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.line, self.column, self.error)
    }
}

impl std::error::Error for ParseError {}

/// A spectrum that is linear between given wavelengths and zero outside them.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    lambdas: Box<[f32]>,
    /// The same wavelengths, each with its value, and the slope from there to the next one, per
    /// nanometre; 0 for the last.
    knots: Box<[[f32; 3]]>,
    guide: Option<Guide>,
}

/// Where the search for an interval begins.
#[derive(Clone, Debug, PartialEq)]
struct Guide {
    /// The first whole nanometre.
    first: f32,
    /// For each whole nanometre, the index of the last wavelength up to there, or else 0.
    below: Box<[u32]>,
    /// The most wavelengths between two whole nanometres.
    between: u32,
}

impl Guide {
    /// The most nanometres.
    const MAX_LEN: f32 = 4096.0;

    /// Binary search is faster where there are more wavelengths between two whole nanometres.
    const MAX_BETWEEN: u32 = 4;

    /// That of increasing wavelengths; `None` where binary search is better.
    fn new(lambdas: &[f32]) -> Option<Self> {
        let (first, last) = (lambdas[0].floor(), lambdas[lambdas.len() - 1].floor());
        // Differences of smaller numbers and whole ones are exact.
        let is_exact = first >= 0.0 && last < (1 << 20) as f32;
        if !is_exact || last - first >= Self::MAX_LEN {
            return None;
        }
        let upto = |lambda: f32| lambdas.partition_point(|&l| l <= lambda) as u32;
        let whole = (0..=(last - first) as u32).map(|nanometre| first + nanometre as f32);
        let below = whole.clone().map(|nanometre| upto(nanometre).saturating_sub(1)).collect();
        let before = |lambda: f32| lambdas.partition_point(|&l| l < lambda) as u32;
        let between = whole.map(|nanometre| before(nanometre + 1.0) - upto(nanometre)).max().unwrap_or(0);
        (between <= Self::MAX_BETWEEN).then_some(Self { first, below, between })
    }
}

impl PiecewiseLinear {
    /// From pairs of wavelength in nanometres and value, wavelengths strictly increasing.
    pub fn from_pairs(pairs: &[(f32, f32)]) -> Result<Self, SpectrumError> {
        if pairs.is_empty() {
            return Err(SpectrumError::Empty);
        }
        if let Some(bad) = pairs.iter().flat_map(|&(lambda, value)| [lambda, value]).find(|v| !v.is_finite())
        {
            return Err(SpectrumError::NotANumber { found: bad.to_string() });
        }
        if let Some(w) = pairs.windows(2).find(|w| w[1].0 <= w[0].0) {
            return Err(SpectrumError::NotIncreasing { previous: w[0].0, lambda: w[1].0 });
        }
        let lambdas: Box<[f32]> = pairs.iter().map(|&(lambda, _)| lambda).collect();
        let slope = |w: &[(f32, f32)]| (w[1].1 - w[0].1) / (w[1].0 - w[0].0);
        let slopes = pairs.windows(2).map(slope).chain([0.0]);
        let knots = pairs.iter().zip(slopes).map(|(&(lambda, value), slope)| [lambda, value, slope]);
        Ok(Self { guide: Guide::new(&lambdas), knots: knots.collect(), lambdas })
    }

    /// From numbers, wavelength and value in turn.
    pub fn from_interleaved(numbers: &[f32]) -> Result<Self, SpectrumError> {
        if let [.., lambda] = numbers
            && numbers.len() % 2 == 1
        {
            return Err(SpectrumError::NoValue { lambda: *lambda });
        }
        let pairs: Vec<(f32, f32)> = numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        Self::from_pairs(&pairs)
    }

    /// From text.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        let mut pairs: Vec<(f32, f32)> = Vec::new();
        let mut unpaired: Option<(f32, usize, usize)> = None;
        for (index, line_text) in text.lines().enumerate() {
            let line = index + 1;
            let content = line_text.split('#').next().unwrap_or_default();
            for word in content.split_whitespace() {
                let column =
                    content[..word.as_ptr() as usize - content.as_ptr() as usize].chars().count() + 1;
                let number = parse_number(word).map_err(|error| ParseError { line, column, error })?;
                unpaired = match unpaired {
                    None => {
                        if let Some(&(previous, _)) = pairs.last()
                            && number <= previous
                        {
                            let error = SpectrumError::NotIncreasing { previous, lambda: number };
                            return Err(ParseError { line, column, error });
                        }
                        Some((number, line, column))
                    }
                    Some((lambda, ..)) => {
                        pairs.push((lambda, number));
                        None
                    }
                };
            }
        }
        if let Some((lambda, line, column)) = unpaired {
            return Err(ParseError { line, column, error: SpectrumError::NoValue { lambda } });
        }
        Self::from_pairs(&pairs).map_err(|error| ParseError { line: 1, column: 1, error })
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        let below = self.interval(lambda);
        let first = below.wrapping_mul(R::Int::splat(3));
        let [start, value, slope] = R::gather_rows(self.knots.as_flattened(), first);
        let last = R::splat(self.lambdas[self.lambdas.len() - 1]);
        let inside = lambda.ge(start) & lambda.le(last);
        R::select(inside, value + (lambda - start) * slope, R::zero())
    }

    /// The index of the last wavelength that is at most `lambda`, or else 0, with the same steps in
    /// all lanes.
    #[inline(always)]
    fn interval<R: Real>(&self, lambda: R) -> R::Int {
        match &self.guide {
            Some(guide) => {
                let last = R::splat((guide.below.len() - 1) as f32);
                let nanometre = (lambda - R::splat(guide.first)).floor().clamp(R::zero(), last);
                let mut below = R::Int::gather(&guide.below, nanometre.to_int());
                for _ in 0..guide.between {
                    below = self.next_if_up_to(lambda, below, 1);
                }
                below
            }
            None => {
                let (mut below, mut size) = (R::Int::splat(0), self.lambdas.len() as u32);
                while size > 1 {
                    below = self.next_if_up_to(lambda, below, size / 2);
                    size -= size / 2;
                }
                below
            }
        }
    }

    /// The wavelength `step` after the one at an index if it is at most `lambda`, else that one.
    #[inline(always)]
    fn next_if_up_to<R: Real>(&self, lambda: R, below: R::Int, step: u32) -> R::Int {
        let next = below.wrapping_add(R::Int::splat(step));
        let last = R::Int::splat(self.lambdas.len() as u32 - 1);
        let next = R::Int::select(next.lt(last), next, last);
        R::Int::select(R::gather(&self.lambdas, next).le(lambda), next, below)
    }

    /// The largest of the given values.
    pub fn max_value(&self) -> f32 {
        self.knots.iter().fold(f32::NEG_INFINITY, |max, &[_, value, _]| max.max(value))
    }

    /// The pairs of wavelength and value.
    pub fn pairs(&self) -> impl Iterator<Item = (f32, f32)> + '_ {
        self.knots.iter().map(|&[lambda, value, _]| (lambda, value))
    }

    /// The same spectrum times `factor`.
    pub fn scaled(mut self, factor: f32) -> Self {
        for [_, value, slope] in &mut self.knots {
            *value *= factor;
            *slope *= factor;
        }
        self
    }

    /// The spectrum at each whole nanometre.
    pub fn to_dense(&self) -> DenselySampled {
        DenselySampled::from_fn(|lambda| self.at(lambda))
    }
}

/// A word as a finite number.
fn parse_number(word: &str) -> Result<f32, SpectrumError> {
    match word.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(SpectrumError::NotANumber { found: word.to_owned() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_linear_inside_and_zero_outside() {
        let spectrum = PiecewiseLinear::from_pairs(&[(400.0, 1.0), (500.0, 3.0), (520.0, 0.0)]).unwrap();
        for (lambda, value) in
            [(399.9, 0.0), (400.0, 1.0), (450.0, 2.0), (500.0, 3.0), (510.0, 1.5), (520.0, 0.0), (520.1, 0.0)]
        {
            assert!((spectrum.at(lambda) - value).abs() < 1e-5, "{lambda}");
        }
        assert_eq!(spectrum.max_value(), 3.0);
        assert!((spectrum.clone().scaled(2.0).at(450.0) - 4.0).abs() < 1e-5);
        assert_eq!(PiecewiseLinear::from_pairs(&[(500.0, 2.0)]).unwrap().at(500.0), 2.0);
    }

    #[test]
    fn the_guide_finds_what_a_search_finds() {
        let spectra: [&[f32]; 6] = [
            &[400.0, 420.0, 440.0, 460.0],
            &[359.5, 359.75, 360.0, 361.25, 361.5, 361.999, 830.0],
            &[0.25, 0.5, 4000.0],
            &[555.0],
            &[555.5],
            &[700.0, 700.1, 700.2],
        ];
        for lambdas in spectra {
            let pairs: Vec<_> = lambdas.iter().map(|&l| (l, (l * 7.3).sin())).collect();
            let guided = PiecewiseLinear::from_pairs(&pairs).unwrap();
            assert!(guided.guide.is_some(), "{lambdas:?}");
            let searched = PiecewiseLinear { guide: None, ..guided.clone() };
            let between = (0..20_000).map(|i| 0.25 * i as f32 - 100.0);
            let around = lambdas.iter().flat_map(|l| [l.next_down(), *l, l.next_up()]);
            for lambda in between.chain(around) {
                assert_eq!(guided.interval(lambda), searched.interval(lambda), "{lambda} in {lambdas:?}");
            }
        }
        let dense: Vec<_> = (0..1000).map(|i| (400.0 + 0.1 * i as f32, 1.0)).collect();
        assert!(PiecewiseLinear::from_pairs(&dense).unwrap().guide.is_none());
    }

    #[test]
    fn text_with_comments_is_parsed() {
        let spectrum = PiecewiseLinear::parse("# a lamp\n400 1.5 # first\n\n 410\t2e0\r\n420 -1").unwrap();
        assert_eq!(spectrum.pairs().collect::<Vec<_>>(), [(400.0, 1.5), (410.0, 2.0), (420.0, -1.0)]);
    }

    #[test]
    fn errors_in_text_are_located() {
        for (text, message) in [
            ("", "1:1: there are no values"),
            ("# nothing", "1:1: there are no values"),
            ("400 1\n  4x0 2", "2:3: `4x0` is not a finite number"),
            ("400 nan", "1:5: `nan` is not a finite number"),
            ("400 1e99", "1:5: `1e99` is not a finite number"),
            ("400, 1", "1:1: `400,` is not a finite number"),
            ("400 1 410", "1:7: the wavelength 410 has no value"),
            ("400 1\n400 2", "2:1: wavelengths must increase: 400 follows 400"),
            ("é 400 1", "1:1: `é` is not a finite number"),
            ("400 é1", "1:5: `é1` is not a finite number"),
        ] {
            assert_eq!(PiecewiseLinear::parse(text).unwrap_err().to_string(), message, "{text:?}");
        }
    }

    #[test]
    fn invalid_pairs_are_rejected() {
        assert_eq!(PiecewiseLinear::from_pairs(&[]), Err(SpectrumError::Empty));
        assert_eq!(
            PiecewiseLinear::from_interleaved(&[400.0, 1.0, 500.0]),
            Err(SpectrumError::NoValue { lambda: 500.0 })
        );
        assert!(PiecewiseLinear::from_interleaved(&[400.0, f32::NAN]).is_err());
        assert!(PiecewiseLinear::from_interleaved(&[400.0, 1.0, 300.0, 1.0]).is_err());
    }

    proptest::proptest! {
        #[test]
        fn arbitrary_text_does_not_panic(text in "([0-9a-z.#,é+-]{0,6}[ \n\t\r]{0,2}){0,12}") {
            let _ = PiecewiseLinear::parse(&text);
        }

        #[test]
        fn written_spectra_are_parsed_again(steps in proptest::collection::vec((0.01_f32..50.0, -10.0_f32..10.0), 1..20)) {
            let mut lambda = 300.0;
            let pairs: Vec<(f32, f32)> = steps.iter().map(|&(step, value)| { lambda += step; (lambda, value) }).collect();
            let text: String = pairs.iter().map(|(lambda, value)| format!("{lambda} {value} # …\n")).collect();
            let again = PiecewiseLinear::parse(&text).unwrap();
            proptest::prop_assert_eq!(again.pairs().collect::<Vec<_>>(), pairs);
        }
    }
}
