//! The macro that declares the members of a scene.

/// Declares a closed set of descriptions, such as the materials, with the parameters of each member
/// in the syntax of `settings!`.
///
/// ```text
/// members! {
///     /// What it is.
///     #[derive(…)]
///     pub enum Set: SetType = First {
///         /// Fields that are parameters.
///         First = "first" {
///             /// Documentation and help.
///             field: Type = default => ["name" | "alias": domain];
///         },
///         /// The parameters of a struct.
///         Second(SecondDesc) = "second",
///         /// A member that the format of pbrt-v4 has not.
///         Third = "third" [extension],
///         /// Fields that an importer finds by itself.
///         Fourth = "fourth" by hand {
///             /// What it is.
///             other: Type;
///         },
///     }
/// }
/// ```
///
/// `SetType` is the set without fields: importers match over it. `pub enum Set<V: Bound>: SetType`
/// has fields of a type `V`.
macro_rules! members {
    ($(#[$meta:meta])* pub enum $set:ident $(<$value:ident: $bound:ident>)?: $type:ident = $first:ident {
        $(
            $(#[doc = $about:literal])+
            $variant:ident $(($settings:ty))? = $name:literal $([$mark:ident])?
            $({ $($(#[doc = $help:literal])+ $field:ident: $kind:ty = $default:expr $(=> $keys:tt)?;)* })?
            $(by hand { $($(#[doc = $meaning:literal])+ $found:ident: $of:ty;)* })?
        ),* $(,)?
    }) => {
        $(#[$meta])*
        pub enum $set $(<$value>)? {
            $(
                $(#[doc = $about])+
                $variant
                $(($settings))?
                $({ $($(#[doc = $help])+ $field: $kind,)* })?
                $({ $($(#[doc = $meaning])+ $found: $of,)* })?,
            )*
        }

        #[doc = concat!("The members of [`", stringify!($set), "`], without their parameters.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $(#[doc = concat!("`", $name, "`.")] $variant,)*
        }

        impl $type {
            /// The names of all members.
            pub const NAMES: &'static [&'static str] = &[$($name),*];

            /// The declarations of all members.
            pub const MEMBERS: &'static [$crate::schema::Member] = &[$($crate::schema::Member {
                names: &[$name],
                help: concat!($($about),+).trim_ascii(),
                is_drawn: true,
                is_extension: $crate::schema::members!(@mark $($mark)?),
            }),*];

            /// The member of a name.
            pub fn named(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self::$variant),)*
                    _ => None,
                }
            }
        }

        impl $(<$value: $bound>)? $set $(<$value>)? {
            /// The member with the defaults of its parameters; none if it has fields that are not
            /// parameters.
            pub fn new(kind: $type) -> Option<Self> {
                match kind {
                    $($type::$variant => $crate::schema::members!(
                        @new $variant $(($settings))? $({ $($field: $default,)* })? $(by hand { $($found)* })?
                    ),)*
                }
            }

            /// The member, without its parameters.
            pub fn kind(&self) -> $type {
                match self {
                    $(Self::$variant { .. } => $type::$variant,)*
                }
            }

            /// The format's name of it.
            pub fn name(&self) -> &'static str {
                $type::NAMES[self.kind() as usize]
            }
        }

        impl $(<$value: $bound>)? Default for $set $(<$value>)? {
            fn default() -> Self {
                Self::new($type::$first).expect("the default member has defaults")
            }
        }

        impl $(<$value: $bound>)? $crate::schema::Settings for $set $(<$value>)? {
            #[allow(unused_variables)]
            fn visit(&mut self, visitor: $crate::schema::Visitor) {
                match self {
                    $(
                        $(Self::$variant(settings) => <$settings as $crate::schema::Settings>::visit(settings, visitor),)?
                        $(Self::$variant { $($field,)* } => {
                            $($crate::schema::settings!(@visit visitor ($field) (concat!($($help),+)) $($keys)?);)*
                        })?
                        $(Self::$variant { $($found: _,)* } => (),)?
                    )*
                    #[allow(unreachable_patterns)]
                    _ => (),
                }
            }

            fn member(&self) -> Option<&'static $crate::schema::Member> {
                Some(&$type::MEMBERS[self.kind() as usize])
            }

            fn members() -> Vec<Self> {
                [$(Self::new($type::$variant)),*].into_iter().flatten().collect()
            }

            fn called(name: &str) -> Option<Self> {
                $type::named(name).and_then(Self::new)
            }
        }
    };

    (@mark) => { false };
    (@mark extension) => { true };

    (@new $variant:ident ($settings:ty)) => { Some(Self::$variant(<$settings>::default())) };
    (@new $variant:ident { $($fields:tt)* }) => { Some(Self::$variant { $($fields)* }) };
    (@new $variant:ident by hand { $($found:ident)* }) => { None };
    (@new $variant:ident) => { Some(Self::$variant) };
}

pub(crate) use members;
