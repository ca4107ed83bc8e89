//! Types of settings whose values are names.

/// A type with a name for each value.
pub trait Choice: Copy {
    /// The names of all values.
    const NAMES: &'static [&'static str];

    /// Its name.
    fn name(self) -> &'static str;

    /// The value of a name.
    fn named(name: &str) -> Option<Self>;
}

/// Declares an `enum` as the type of a setting, with a name for each value, the first of several.
macro_rules! choices {
    ($(#[$meta:meta])* pub enum $name:ident {
        $($(#[$attribute:meta])* $variant:ident = $spelling:literal $(| $alias:literal)*,)+
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub enum $name {
            $($(#[$attribute])* $variant,)+
        }

        impl $name {
            /// The names of all values.
            pub const NAMES: &'static [&'static str] = &[$($spelling $(, $alias)*),+];

            /// Its name.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $spelling,)+ }
            }

            /// The value of a name.
            pub fn named(name: &str) -> Option<Self> {
                match name {
                    $($spelling $(| $alias)* => Some(Self::$variant),)+
                    _ => None,
                }
            }
        }

        impl $crate::schema::Choice for $name {
            const NAMES: &'static [&'static str] = Self::NAMES;

            fn name(self) -> &'static str {
                self.name()
            }

            fn named(name: &str) -> Option<Self> {
                Self::named(name)
            }
        }
    };
}

pub(crate) use choices;
