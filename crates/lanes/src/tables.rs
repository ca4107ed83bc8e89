//! Macros that implement an instruction set from a table of intrinsics.

/// Defines a vector as a newtype over a register, which has the layout of an array of its lanes.
/// Each operation is an expression of registers.
macro_rules! vector {
    (
        $(#[$doc:meta])* $name:ident($register:ty): Vector<$n:literal>;
        splat($x:ident) = $splat:expr;
        lane($of:ident, $index:ident) = $lane:expr;
        $($operation:ident($a:ident $(, $b:ident)*) = $result:expr;)*
        -> u32:
        $($comparison:ident($left:ident, $right:ident) = $bits:expr;)*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $name(pub(crate) $register);

        // SAFETY, for every block: the caller of the constructor promised the instruction set, and
        // a vector is the proof of it. Registers are loaded as arrays, not by intrinsics: those
        // check their pointers where assertions are on, and are calls then.
        #[allow(unused_unsafe, clippy::useless_transmute)]
        impl $crate::simd::Vector<$n> for $name {
            #[inline(always)]
            unsafe fn splat($x: f32) -> Self {
                unsafe { Self($splat) }
            }

            #[inline(always)]
            unsafe fn load(from: &[f32; $n]) -> Self {
                unsafe { Self(std::mem::transmute::<[f32; $n], $register>(*from)) }
            }

            #[inline(always)]
            fn store(self) -> [f32; $n] {
                unsafe { std::mem::transmute::<$register, [f32; $n]>(self.0) }
            }

            #[inline(always)]
            fn lane(self, $index: usize) -> f32 {
                let $of = self.0;
                unsafe { $lane }
            }

            $(
                #[inline(always)]
                fn $operation(self $(, $b: Self)*) -> Self {
                    let $a = self.0;
                    $(let $b = $b.0;)*
                    unsafe { Self($result) }
                }
            )*

            $(
                #[inline(always)]
                fn $comparison(self, $right: Self) -> u32 {
                    let ($left, $right) = (self.0, $right.0);
                    unsafe { $bits }
                }
            )*
        }
    };
}

/// Defines an instruction set: its processor features, which are detected and enabled alike, and
/// its vectors.
macro_rules! instruction_set {
    (
        $name:ident, $is_detected:ident [$($feature:tt)*];
        $f32x4:ty, $f32x8:ty, $f32x16:ty;
        $real:ty;
        $($item:item)*
    ) => {
        #[doc = concat!("See [`crate::InstructionSet::", stringify!($name), "`].")]
        #[derive(Clone, Copy)]
        pub struct $name;

        impl $crate::simd::Simd for $name {
            type F32x4 = $f32x4;
            type F32x8 = $f32x8;
            type F32x16 = $f32x16;
            type Real = $real;
            $($item)*
        }

        /// Whether the processor has the instruction set.
        pub fn is_available() -> bool {
            true $(&& $is_detected!($feature))*
        }

        /// Runs a task.
        ///
        /// # Safety
        /// The processor must have the instruction set.
        $(#[target_feature(enable = $feature)])*
        pub unsafe fn run<T: $crate::simd::Task>(task: T) -> T::Output {
            // SAFETY: the caller promises the instruction set.
            unsafe { task.run::<$name>() }
        }
    };
}

/// Makes a vector of `vector!` a [`Real`](crate::Real), which has the arithmetic of that table.
/// Masks and integers are those that `mask!` and `int!` define. `gather` has a pointer, and indices
/// that lie inside of the table; `scatter` likewise; `gather_rows` has an array of indices. Each
/// four lanes of `transpose` are the rows of a matrix that is the transpose of theirs.
macro_rules! real {
    (
        $real:ident, $int:ident, $mask:ident: $n:literal;
        select($which:ident, $x:ident, $y:ident) = $select:expr;
        from_bits($bits:ident) = $from_bits:expr;
        $($operation:ident($a:ident) = $result:expr;)*
        -> Mask: $($comparison:ident($left:ident, $right:ident) = $compared:expr;)*
        -> Int: $($conversion:ident($from:ident) = $converted:expr;)*
        $(
            -> Self, if there is an instruction: gather($table:ident, $indices:ident) = $gather:expr;
            -> [Self; 4], by shuffles:
            gather_rows::<$k:ident>($rows:ident, $first:ident) = $gather_rows:expr;
            transpose($columns:ident) = $transpose:expr;
        )?
        $(
            -> (), if there is an instruction:
            scatter($written:ident, $lanes:ident, $places:ident, $at:ident) = $scatter:expr;
        )?
    ) => {
        #[allow(unused_unsafe)]
        impl $crate::Real for $real {
            const LANES: usize = $n;

            type Mask = $mask;
            type Int = $int;

            #[inline(always)]
            fn splat(x: f32) -> Self {
                // SAFETY: as for every block: see the head of the crate.
                unsafe { $crate::Vector::splat(x) }
            }

            #[inline(always)]
            fn load(from: &[f32]) -> Self {
                unsafe { $crate::Vector::load($crate::slices::lanes(from)) }
            }

            #[inline(always)]
            fn store(self, to: &mut [f32]) {
                *$crate::slices::lanes_mut(to) = $crate::Vector::<$n>::store(self);
            }

            #[inline(always)]
            fn call<C: $crate::Callee<Self>>(callee: C) -> C::Output {
                // A set without features of its own would be compiled into the caller.
                #[inline(never)]
                fn apart<C: $crate::Callee<$real>>(callee: C) -> C::Output {
                    // The function `run` of the table's instruction set.
                    unsafe { run($crate::simd::Applied::new(callee)) }
                }
                apart(callee)
            }

            #[inline(always)]
            fn select($which: $mask, a: Self, b: Self) -> Self {
                let ($which, $x, $y) = ($which.0, a.0, b.0);
                unsafe { Self($select) }
            }

            #[inline(always)]
            fn from_bits(bits: $int) -> Self {
                let $bits = bits.0;
                unsafe { Self($from_bits) }
            }

            $(
                #[inline(always)]
                fn gather(table: &[f32], indices: $int) -> Self {
                    if !$crate::slices::are_inside(table.len(), indices) {
                        let indices = $crate::Int::to_array(indices);
                        return $crate::Real::load(&$crate::slices::gather_each::<_, $n>(table, &indices));
                    }
                    let ($table, $indices) = (table.as_ptr(), indices.0);
                    unsafe { Self($gather) }
                }

                #[inline(always)]
                fn gather_rows<const $k: usize>(table: &[f32], indices: $int) -> [Self; $k] {
                    let starts = (table.len() + 1).saturating_sub($k);
                    if !$crate::slices::are_inside(starts, indices) {
                        let indices = $crate::Int::to_array(indices);
                        let columns = $crate::slices::gather_rows_each::<$k>(table, &indices[..$n]);
                        let mut rows = [$crate::Real::zero(); $k];
                        for (row, column) in rows.iter_mut().zip(&columns) {
                            *row = $crate::Real::load(column);
                        }
                        return rows;
                    }
                    let $first = $crate::Int::to_array(indices);
                    let $rows = table.as_ptr();
                    let columns = unsafe { $gather_rows };
                    let mut rows = [$crate::Real::zero(); $k];
                    for (row, column) in rows.iter_mut().zip(columns) {
                        *row = Self(column);
                    }
                    rows
                }

                #[inline(always)]
                fn compress_four([a, b, c, d]: [Self; 4], mask: $mask, to: &mut [f32]) -> usize {
                    let $columns = [a.0, b.0, c.0, d.0];
                    let [a, b, c, d] = unsafe { $transpose };
                    let rows = [Self(a), Self(b), Self(c), Self(d)];
                    let rows = $crate::Each::each(rows, $crate::Vector::<$n>::store);
                    $crate::real::compress_rows($crate::Mask::bits(mask), $n, to, |lane| {
                        let (row, first) = (&rows[lane % 4], lane / 4 * 4);
                        [row[first], row[first + 1], row[first + 2], row[first + 3]]
                    })
                }
            )?

            $(
                #[inline(always)]
                fn scatter(self, mask: $mask, table: &mut [f32], indices: $int) {
                    assert!($crate::slices::are_inside(table.len(), indices), "a place for each lane");
                    let ($written, $lanes, $places, $at) = (self.0, mask.0, table.as_mut_ptr(), indices.0);
                    unsafe { $scatter }
                }
            )?

            #[inline(always)]
            fn abs(self) -> Self {
                $crate::Vector::abs(self)
            }

            #[inline(always)]
            fn min(self, b: Self) -> Self {
                $crate::Vector::min(self, b)
            }

            #[inline(always)]
            fn max(self, b: Self) -> Self {
                $crate::Vector::max(self, b)
            }

            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                $crate::Vector::mul_add(self, b, c)
            }

            $(
                #[inline(always)]
                fn $operation(self) -> Self {
                    let $a = self.0;
                    unsafe { Self($result) }
                }
            )*

            $(
                #[inline(always)]
                fn $comparison(self, b: Self) -> $mask {
                    let ($left, $right) = (self.0, b.0);
                    unsafe { $mask($compared) }
                }
            )*

            $(
                #[inline(always)]
                fn $conversion(self) -> $int {
                    let $from = self.0;
                    unsafe { $int($converted) }
                }
            )*
        }

        arithmetic! { $real: Add::add, AddAssign::add_assign }
        arithmetic! { $real: Sub::sub, SubAssign::sub_assign }
        arithmetic! { $real: Mul::mul, MulAssign::mul_assign }
        arithmetic! { $real: Div::div, DivAssign::div_assign }

        impl std::ops::Neg for $real {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                let bits = $crate::Real::to_bits(self) ^ <$int as $crate::Int>::splat(1 << 31);
                $crate::Real::from_bits(bits)
            }
        }

        impl Default for $real {
            #[inline(always)]
            fn default() -> Self {
                $crate::Real::splat(0.0)
            }
        }

        impl std::fmt::Debug for $real {
            fn fmt(&self, to: &mut std::fmt::Formatter) -> std::fmt::Result {
                $crate::Vector::<$n>::store(*self).fmt(to)
            }
        }
    };
}

/// An operator of floats, which is the operation of the vector.
macro_rules! arithmetic {
    ($real:ident: $operator:ident::$operation:ident, $assign:ident::$assignment:ident) => {
        impl std::ops::$operator for $real {
            type Output = Self;

            #[inline(always)]
            fn $operation(self, b: Self) -> Self {
                $crate::Vector::$operation(self, b)
            }
        }

        impl std::ops::$assign for $real {
            #[inline(always)]
            fn $assignment(&mut self, b: Self) {
                *self = $crate::Vector::$operation(*self, b);
            }
        }
    };
}

/// Defines integers for the lanes of a `real!` as a newtype over a register. `gather` has a
/// pointer, and indices that lie inside of the table; `scatter` likewise.
macro_rules! int {
    (
        $(#[$doc:meta])* $int:ident($register:ty), $real:ident, $mask:ident: $n:literal;
        splat($x:ident) = $splat:expr;
        select($which:ident, $sx:ident, $sy:ident) = $select:expr;
        mul_wide($wx:ident, $wy:ident) = $mul_wide:expr;
        shl($left:ident, $shl_bits:ident) = $shl:expr;
        shr($right:ident, $shr_bits:ident) = $shr:expr;
        to_real($signed:ident) = $to_real:expr;
        $($operation:ident($a:ident, $b:ident) = $result:expr;)*
        -> Mask: $($comparison:ident($cx:ident, $cy:ident) = $compared:expr;)*
        -> Self, as operators: $($operator:ident::$bitwise:ident($bx:ident, $by:ident) = $bits:expr;)*
        $(
            -> Self, if there is an instruction:
            gather($table:ident, $indices:ident) = $gather:expr;
            gather_bytes($bytes:ident, $byte:ident) = $gather_bytes:expr;
            gather_halves($halves:ident, $half:ident) = $gather_halves:expr;
            compress($all:ident, $kept:ident) = $compress:expr;
        )?
        $(
            -> (), if there is an instruction:
            scatter($written:ident, $lanes:ident, $places:ident, $at:ident) = $scatter:expr;
        )?
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $int($register);

        #[allow(unused_unsafe, clippy::useless_transmute)]
        impl $crate::Int for $int {
            type Real = $real;
            type Mask = $mask;

            #[inline(always)]
            fn splat(x: u32) -> Self {
                let $x = x as _;
                // SAFETY: as for every block: see the head of the crate.
                unsafe { Self($splat) }
            }

            #[inline(always)]
            fn load(from: &[u32]) -> Self {
                let from = *$crate::slices::lanes::<_, $n>(from);
                unsafe { Self(std::mem::transmute::<[u32; $n], $register>(from)) }
            }

            #[inline(always)]
            fn store(self, to: &mut [u32]) {
                let lanes = unsafe { std::mem::transmute::<$register, [u32; $n]>(self.0) };
                *$crate::slices::lanes_mut(to) = lanes;
            }

            #[inline(always)]
            fn select($which: $mask, a: Self, b: Self) -> Self {
                let ($which, $sx, $sy) = ($which.0, a.0, b.0);
                unsafe { Self($select) }
            }

            $(
                #[inline(always)]
                fn gather(table: &[u32], indices: Self) -> Self {
                    if !$crate::slices::are_inside(table.len(), indices) {
                        let indices = $crate::Int::to_array(indices);
                        return $crate::Int::load(&$crate::slices::gather_each::<_, $n>(table, &indices));
                    }
                    let ($table, $indices) = (table.as_ptr(), indices.0);
                    unsafe { Self($gather) }
                }

                #[inline(always)]
                fn gather_bytes(table: &[u8], indices: Self) -> Self {
                    // The instruction reads four bytes.
                    if !$crate::slices::are_inside(table.len().saturating_sub(3), indices) {
                        let indices = $crate::Int::to_array(indices);
                        return $crate::Int::load(&$crate::slices::gather_bytes(table, &indices[..$n]));
                    }
                    let ($bytes, $byte) = (table.as_ptr(), indices.0);
                    unsafe { Self($gather_bytes) }
                }

                #[inline(always)]
                fn gather_halves(table: &[u16], indices: Self) -> Self {
                    // The instruction reads two numbers, of which the second one is not used.
                    if !$crate::slices::are_inside(table.len().saturating_sub(1), indices) {
                        let indices = $crate::Int::to_array(indices);
                        let halves = $crate::slices::gather_each::<_, $n>(table, &indices);
                        return $crate::Int::from_fn(|lane| halves[lane].into());
                    }
                    let ($halves, $half) = (table.as_ptr(), indices.0);
                    unsafe { Self($gather_halves) & $crate::Int::splat(0xffff) }
                }

                #[inline(always)]
                fn compress(self, mask: $mask, to: &mut [u32]) -> usize {
                    let ($all, $kept) = (self.0, mask.0);
                    $crate::Int::store(unsafe { Self($compress) }, to);
                    $crate::Mask::bits(mask).count_ones() as usize
                }
            )?

            $(
                #[inline(always)]
                fn scatter(self, mask: $mask, table: &mut [u32], indices: Self) {
                    assert!($crate::slices::are_inside(table.len(), indices), "a place for each lane");
                    let ($written, $lanes, $places, $at) = (self.0, mask.0, table.as_mut_ptr(), indices.0);
                    unsafe { $scatter }
                }
            )?

            #[inline(always)]
            fn mul_wide(self, b: Self) -> (Self, Self) {
                let ($wx, $wy) = (self.0, b.0);
                let (low, high) = unsafe { $mul_wide };
                (Self(low), Self(high))
            }

            #[inline(always)]
            fn shl(self, bits: u32) -> Self {
                debug_assert!(bits < 32);
                let ($left, $shl_bits) = (self.0, bits as i32);
                unsafe { Self($shl) }
            }

            #[inline(always)]
            fn shr(self, bits: u32) -> Self {
                debug_assert!(bits < 32);
                let ($right, $shr_bits) = (self.0, bits as i32);
                unsafe { Self($shr) }
            }

            #[inline(always)]
            fn to_real(self) -> $real {
                let $signed = self.0;
                unsafe { $real($to_real) }
            }

            $(
                #[inline(always)]
                fn $operation(self, b: Self) -> Self {
                    let ($a, $b) = (self.0, b.0);
                    unsafe { Self($result) }
                }
            )*

            $(
                #[inline(always)]
                fn $comparison(self, b: Self) -> $mask {
                    let ($cx, $cy) = (self.0, b.0);
                    unsafe { $mask($compared) }
                }
            )*
        }

        bitwise! { $int, $crate::Int::splat(u32::MAX);
            $($operator::$bitwise($bx, $by) = $bits;)* }

        impl Default for $int {
            #[inline(always)]
            fn default() -> Self {
                $crate::Int::splat(0)
            }
        }

        impl std::fmt::Debug for $int {
            fn fmt(&self, to: &mut std::fmt::Formatter) -> std::fmt::Result {
                $crate::Int::to_array(*self)[..$n].fmt(to)
            }
        }
    };
}

/// Defines bools for the lanes of a `real!` as a newtype over a register.
macro_rules! mask {
    (
        $(#[$doc:meta])* $mask:ident($register:ty): $n:literal;
        splat($x:ident) = $splat:expr;
        from_bits($set:ident) = $from_bits:expr;
        bits($a:ident) = $bits:expr;
        -> Self, as operators: $($operator:ident::$bitwise:ident($bx:ident, $by:ident) = $result:expr;)*
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $mask($register);

        #[allow(unused_unsafe)]
        impl $crate::Mask for $mask {
            #[inline(always)]
            fn splat($x: bool) -> Self {
                // SAFETY: as for every block: see the head of the crate.
                unsafe { Self($splat) }
            }

            #[inline(always)]
            fn from_bits(bits: u32) -> Self {
                let $set = bits as _;
                unsafe { Self($from_bits) }
            }

            #[inline(always)]
            fn bits(self) -> u32 {
                let $a = self.0;
                unsafe { $bits }
            }
        }

        bitwise! { $mask, $crate::Mask::splat(true);
            $($operator::$bitwise($bx, $by) = $result;)* }

        impl std::fmt::Debug for $mask {
            fn fmt(&self, to: &mut std::fmt::Formatter) -> std::fmt::Result {
                let bits = $crate::Mask::bits(*self);
                std::array::from_fn::<bool, $n, _>(|lane| bits >> lane & 1 == 1).fmt(to)
            }
        }
    };
}

/// Operators of a newtype over a register; the complement differs from it in all bits.
macro_rules! bitwise {
    (
        $type:ident, $all:expr;
        $($operator:ident::$operation:ident($a:ident, $b:ident) = $result:expr;)*
    ) => {
        $(
            #[allow(unused_unsafe)]
            impl std::ops::$operator for $type {
                type Output = Self;

                #[inline(always)]
                fn $operation(self, b: Self) -> Self {
                    let ($a, $b) = (self.0, b.0);
                    // SAFETY: see the head of the crate.
                    unsafe { Self($result) }
                }
            }
        )*

        impl std::ops::Not for $type {
            type Output = Self;

            #[inline(always)]
            fn not(self) -> Self {
                self ^ $all
            }
        }
    };
}
