//! A number with its first and second derivatives by x, y and z: forward automatic differentiation.
//!
//! For g(u): ∇g = g′·∇u and Hg = g′·Hu + g″·∇u·∇uᵀ; for u·v: H = u·Hv + v·Hu + ∇u·∇vᵀ + ∇v·∇uᵀ
//! ([Griewank 2008 §2]).

use super::program::{Function, Number, power};
use math::{DMat3, DVec3};
use std::ops::{Add, Mul, Neg, Sub};

/// Value, gradient and matrix of second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jet {
    pub value: f64,
    pub gradient: DVec3,
    pub hessian: DMat3,
}

impl Jet {
    /// A coordinate of the point `p` itself.
    pub fn coordinate(p: DVec3, axis: usize) -> Self {
        Self { value: p[axis], gradient: DVec3::AXES[axis], hessian: DMat3::ZERO }
    }

    /// g of this, given g, g′ and g″ here.
    fn compose(self, [g, first, second]: [f64; 3]) -> Self {
        let square = outer(self.gradient, self.gradient);
        Self { value: g, gradient: self.gradient * first, hessian: self.hessian * first + square * second }
    }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self.scale(-1.0)
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            gradient: self.gradient + other.gradient,
            hessian: self.hessian + other.hessian,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mixed = outer(self.gradient, other.gradient) + outer(other.gradient, self.gradient);
        Self {
            value: self.value * other.value,
            gradient: other.gradient * self.value + self.gradient * other.value,
            hessian: other.hessian * self.value + self.hessian * other.value + mixed,
        }
    }
}

impl Number for Jet {
    fn constant(value: f64) -> Self {
        Self { value, gradient: DVec3::ZERO, hessian: DMat3::ZERO }
    }

    fn scale(self, factor: f64) -> Self {
        Self { value: self.value * factor, gradient: self.gradient * factor, hessian: self.hessian * factor }
    }

    fn offset(self, term: f64) -> Self {
        Self { value: self.value + term, ..self }
    }

    fn power(self, n: u32) -> Self {
        power(self, n)
    }

    fn min(self, other: Self) -> Self {
        if self.value < other.value { self } else { other }
    }

    fn max(self, other: Self) -> Self {
        if self.value > other.value { self } else { other }
    }

    fn apply(self, function: Function) -> Self {
        let x = self.value;
        self.compose(match function {
            Function::Reciprocal => {
                let inverse = 1.0 / x;
                [inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse]
            }
            Function::Sqrt => {
                let root = x.sqrt();
                [root, 0.5 / root, -0.25 / (root * x)]
            }
            Function::Abs => [x.abs(), x.signum(), 0.0],
            Function::Sin => [libm::sin(x), libm::cos(x), -libm::sin(x)],
            Function::Cos => [libm::cos(x), -libm::sin(x), -libm::cos(x)],
            Function::Exp => [libm::exp(x); 3],
            Function::Log => [libm::log(x), 1.0 / x, -1.0 / (x * x)],
            Function::Real(p) => {
                [libm::pow(x, p), p * libm::pow(x, p - 1.0), p * (p - 1.0) * libm::pow(x, p - 2.0)]
            }
        })
    }
}
