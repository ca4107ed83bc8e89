//! The declaration of closed sets.

/// Declares a closed set: an enum whose members are listed by its declaration. With `each name`
/// after it, `name!` evaluates an expression with what a member holds, whichever it is. (`$` is
/// passed because a macro cannot write it in another.)
///
/// ```
/// alhazen_math::closed_set! {
///     /// A number.
///     pub enum Number {
///         /// Whole.
///         Whole(i32),
///         /// With digits.
///         Decimal(f64),
///     }
///     each each_number $
/// }
///
/// assert_eq!(Number::MEMBERS, ["Whole", "Decimal"]);
/// assert_eq!(Number::Decimal(0.5).member(), "Decimal");
/// assert_eq!(each_number!(Number::Whole(7), number => number.to_string()), "7");
/// ```
#[macro_export]
macro_rules! closed_set {
    (
        $(#[$meta:meta])* pub enum $set:ident $(<$lifetime:lifetime>)? {
            $($(#[$about:meta])* $member:ident $(($($held:ty),+))?,)+
        }
        $(each $each:ident $dollar:tt)?
    ) => {
        $(#[$meta])*
        pub enum $set $(<$lifetime>)? {
            $($(#[$about])* $member $(($($held),+))?,)+
        }

        impl $(<$lifetime>)? $set $(<$lifetime>)? {
            /// The names of all members.
            pub const MEMBERS: &'static [&'static str] = &[$(stringify!($member)),+];

            /// The name of the member.
            pub fn member(&self) -> &'static str {
                match self { $(Self::$member { .. } => stringify!($member),)+ }
            }
        }

        $crate::closed_set!(@each [$($each $dollar)?] $set $($member)+);
    };

    (@each [] $set:ident $($member:ident)+) => {};
    (@each [$each:ident $dollar:tt] $set:ident $($member:ident)+) => {
        /// Evaluates an expression with what a member holds, whichever it is.
        macro_rules! $each {
            ($dollar value:expr, $dollar held:ident => $dollar result:expr) => {
                match $dollar value { $($set::$member($dollar held) => $dollar result,)+ }
            };
        }
    };
}
