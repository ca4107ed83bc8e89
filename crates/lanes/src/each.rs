//! Small arrays in lanes.

/// Maps small arrays without calling anything. The closures of the standard library's adapters may
/// not be inlined into a function that is compiled for an instruction set, and are slow then.
pub trait Each<T> {
    /// The array type with other elements.
    type Of<U>;

    /// `f` of each element.
    fn each<U>(self, f: impl FnMut(T) -> U) -> Self::Of<U>;
}

macro_rules! each {
    ($($n:literal: $($element:ident)*;)*) => {$(
        impl<T> Each<T> for [T; $n] {
            type Of<U> = [U; $n];

            #[inline(always)]
            fn each<U>(self, mut f: impl FnMut(T) -> U) -> [U; $n] {
                let [$($element),*] = self;
                [$(f($element)),*]
            }
        }
    )*};
}

each! {
    2: a b;
    3: a b c;
    4: a b c d;
}
