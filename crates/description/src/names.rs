//! The format's names of the members of a closed set.

/// Declares the names of all variants of an enum: `$type` is the enum without the variants' fields,
/// over which importers match, and `$set::name` returns the name of a value. A variant without a
/// name, or a match without its arm, does not compile.
macro_rules! names {
    ($(#[$doc:meta])* $type:ident of $set:ident { $($variant:ident = $name:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $(#[doc = concat!("`", $name, "`.")] $variant,)*
        }

        impl $type {
            /// The names of all members.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// The member of a name.
            pub fn named(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self::$variant),)*
                    _ => None,
                }
            }
        }

        impl $set {
            /// The format's name of it.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$variant { .. } => $name,)*
                }
            }
        }
    };
}

pub(crate) use names;
