//! A formula as a list of operations, which is evaluated on any kind of number.
//!
//! Common subexpressions are shared and constants folded. Plain numbers give the value of F,
//! [`super::interval::Interval`] a range that contains it over a box, [`super::jet::Jet`] its
//! derivatives, [`super::model::Model`] a polynomial along a ray with a bound of its error.

use std::ops::{Add, Mul, Neg, Sub};

/// A function of one number; NaN where it is undefined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    /// 1/x.
    Reciprocal,
    Sqrt,
    Abs,
    Sin,
    Cos,
    Exp,
    Log,
    /// xᵖ for x ≥ 0, where p is no small integer.
    Real(f64),
}

/// Numbers that a formula can be evaluated on.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    fn constant(value: f64) -> Self;
    /// Times a constant.
    fn scale(self, factor: f64) -> Self;
    /// Plus a constant.
    fn offset(self, term: f64) -> Self;
    /// xⁿ, n ≥ 2.
    fn power(self, n: u32) -> Self;
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn apply(self, function: Function) -> Self;
}

/// xⁿ by squaring, n ≥ 1.
pub(super) fn power<T: Copy + Mul<Output = T>>(x: T, n: u32) -> T {
    let (mut square, mut rest) = (x, n);
    while rest.is_multiple_of(2) {
        square = square * square;
        rest /= 2;
    }
    let mut product = square;
    rest /= 2;
    while rest > 0 {
        square = square * square;
        if rest % 2 == 1 {
            product = product * square;
        }
        rest /= 2;
    }
    product
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn scale(self, factor: f64) -> Self {
        self * factor
    }
    fn offset(self, term: f64) -> Self {
        self + term
    }
    fn power(self, n: u32) -> Self {
        power(self, n)
    }
    fn min(self, other: Self) -> Self {
        if self.is_nan() || self < other { self } else { other }
    }
    fn max(self, other: Self) -> Self {
        if self.is_nan() || self > other { self } else { other }
    }
    fn apply(self, function: Function) -> Self {
        let value = match function {
            Function::Reciprocal => 1.0 / self,
            Function::Sqrt => self.sqrt(),
            Function::Abs => self.abs(),
            Function::Sin => libm::sin(self),
            Function::Cos => libm::cos(self),
            Function::Exp => libm::exp(self),
            Function::Log => libm::log(self),
            Function::Real(p) => libm::pow(self, p),
        };
        // A pole has no value.
        if self == 0.0 && value.is_infinite() { f64::NAN } else { value }
    }
}

/// One operation; operands are the indices of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    Constant(f64),
    /// x, y or z.
    Coordinate(u8),
    Add(u16, u16),
    Sub(u16, u16),
    Mul(u16, u16),
    Neg(u16),
    Scale(u16, f64),
    Offset(u16, f64),
    Power(u16, u32),
    Min(u16, u16),
    Max(u16, u16),
    Apply(Function, u16),
}

/// The operations of a formula; the last one is its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Program {
    ops: Vec<Op>,
}

impl Program {
    /// The value at a point; `values` is scratch memory.
    pub fn evaluate<T: Number>(&self, point: [T; 3], values: &mut Vec<T>) -> T {
        values.clear();
        for op in &self.ops {
            let at = |i: u16| values[i as usize];
            let value = match *op {
                Op::Constant(value) => T::constant(value),
                Op::Coordinate(axis) => point[axis as usize],
                Op::Add(a, b) => at(a) + at(b),
                Op::Sub(a, b) => at(a) - at(b),
                Op::Mul(a, b) => at(a) * at(b),
                Op::Neg(a) => -at(a),
                Op::Scale(a, factor) => at(a).scale(factor),
                Op::Offset(a, term) => at(a).offset(term),
                Op::Power(a, n) => at(a).power(n),
                Op::Min(a, b) => at(a).min(at(b)),
                Op::Max(a, b) => at(a).max(at(b)),
                Op::Apply(function, a) => at(a).apply(function),
            };
            values.push(value);
        }
        values[self.ops.len() - 1]
    }

    /// The total degree; `None` where it is no polynomial.
    pub fn degree(&self) -> Option<u32> {
        let mut degrees: Vec<Option<u32>> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let at = |i: u16| degrees[i as usize];
            let degree = match *op {
                Op::Constant(_) => Some(0),
                Op::Coordinate(_) => Some(1),
                Op::Add(a, b) | Op::Sub(a, b) => at(a).zip(at(b)).map(|(a, b)| a.max(b)),
                Op::Mul(a, b) => at(a).zip(at(b)).map(|(a, b)| a.saturating_add(b)),
                Op::Neg(a) | Op::Scale(a, _) | Op::Offset(a, _) => at(a),
                Op::Power(a, n) => at(a).map(|a| a.saturating_mul(n)),
                Op::Min(..) | Op::Max(..) | Op::Apply(..) => None,
            };
            degrees.push(degree);
        }
        degrees.last().copied().flatten()
    }
}

/// An operand while a [`Program`] is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Known(f64),
    Step(u16),
}

/// There are too many operations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooLong;

/// Collects operations.
#[derive(Debug, Default)]
pub(super) struct Builder {
    ops: Vec<Op>,
}

impl Builder {
    /// The most operations of a program.
    pub const MAX_STEPS: usize = 1024;
    /// The largest exponent for which a power is a product.
    pub const MAX_POWER: u32 = 256;

    /// The steps up to `value`; `None` where it is a constant.
    pub fn finish(mut self, value: Value) -> Option<Program> {
        let Value::Step(last) = value else { return None };
        self.ops.truncate(last as usize + 1);
        Some(Program { ops: self.ops })
    }

    fn push(&mut self, op: Op) -> Result<Value, TooLong> {
        if let Some(known) = self.ops.iter().position(|earlier| *earlier == op) {
            return Ok(Value::Step(known as u16));
        }
        if self.ops.len() == Self::MAX_STEPS {
            return Err(TooLong);
        }
        self.ops.push(op);
        Ok(Value::Step((self.ops.len() - 1) as u16))
    }

    fn step(&mut self, value: Value) -> Result<u16, TooLong> {
        match value {
            Value::Step(step) => Ok(step),
            Value::Known(value) => match self.push(Op::Constant(value))? {
                Value::Step(step) => Ok(step),
                Value::Known(_) => Err(TooLong),
            },
        }
    }

    pub fn coordinate(&mut self, axis: u8) -> Result<Value, TooLong> {
        self.push(Op::Coordinate(axis))
    }

    pub fn add(&mut self, a: Value, b: Value) -> Result<Value, TooLong> {
        match (a, b) {
            (Value::Known(a), Value::Known(b)) => Ok(Value::Known(a + b)),
            (Value::Step(a), Value::Step(b)) => self.push(Op::Add(a.min(b), a.max(b))),
            (Value::Step(a), Value::Known(b)) | (Value::Known(b), Value::Step(a)) => {
                self.push(Op::Offset(a, b))
            }
        }
    }

    pub fn sub(&mut self, a: Value, b: Value) -> Result<Value, TooLong> {
        match (a, b) {
            (Value::Step(a), Value::Step(b)) => self.push(Op::Sub(a, b)),
            _ => {
                let minus = self.neg(b)?;
                self.add(a, minus)
            }
        }
    }

    pub fn neg(&mut self, a: Value) -> Result<Value, TooLong> {
        match a {
            Value::Known(a) => Ok(Value::Known(-a)),
            Value::Step(a) => self.push(Op::Neg(a)),
        }
    }

    pub fn mul(&mut self, a: Value, b: Value) -> Result<Value, TooLong> {
        match (a, b) {
            (Value::Known(a), Value::Known(b)) => Ok(Value::Known(a * b)),
            (Value::Step(a), Value::Step(b)) if a == b => self.push(Op::Power(a, 2)),
            (Value::Step(a), Value::Step(b)) => self.push(Op::Mul(a.min(b), a.max(b))),
            (Value::Step(a), Value::Known(b)) | (Value::Known(b), Value::Step(a)) => {
                self.push(Op::Scale(a, b))
            }
        }
    }

    pub fn div(&mut self, a: Value, b: Value) -> Result<Value, TooLong> {
        match (a, b) {
            (Value::Known(a), Value::Known(b)) => Ok(Value::Known(a / b)),
            _ => {
                let inverse = self.apply(Function::Reciprocal, b)?;
                self.mul(a, inverse)
            }
        }
    }

    pub fn pow(&mut self, a: Value, b: Value) -> Result<Value, TooLong> {
        match (a, b) {
            (Value::Known(a), Value::Known(p)) => Ok(Value::Known(libm::pow(a, p))),
            (Value::Step(step), Value::Known(p)) => {
                if p.fract() != 0.0 || p.abs() > Self::MAX_POWER as f64 {
                    return self.apply(if p == 0.5 { Function::Sqrt } else { Function::Real(p) }, a);
                }
                let raised = match p.abs() as u32 {
                    0 => return Ok(Value::Known(1.0)),
                    1 => a,
                    n => self.push(Op::Power(step, n))?,
                };
                if p < 0.0 { self.apply(Function::Reciprocal, raised) } else { Ok(raised) }
            }
            // aᵇ = e^(b·log a).
            (_, Value::Step(_)) => {
                let log = self.apply(Function::Log, a)?;
                let exponent = self.mul(b, log)?;
                self.apply(Function::Exp, exponent)
            }
        }
    }

    pub fn extreme(&mut self, is_min: bool, a: Value, b: Value) -> Result<Value, TooLong> {
        if let (Value::Known(a), Value::Known(b)) = (a, b) {
            return Ok(Value::Known(if is_min { Number::min(a, b) } else { Number::max(a, b) }));
        }
        let (a, b) = (self.step(a)?, self.step(b)?);
        self.push(if is_min { Op::Min(a, b) } else { Op::Max(a, b) })
    }

    pub fn apply(&mut self, function: Function, a: Value) -> Result<Value, TooLong> {
        match a {
            Value::Known(a) => Ok(Value::Known(a.apply(function))),
            Value::Step(a) => self.push(Op::Apply(function, a)),
        }
    }
}
