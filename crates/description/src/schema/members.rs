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
///         /// Fields that an importer finds by itself.
///         Third = "third" by hand {
///             /// What it is.
///             other: Type;
///         },
///     }
/// }
/// ```
///
/// `SetType` is the set without fields: importers match over it.
macro_rules! members {
    ($(#[$meta:meta])* pub enum $set:ident: $type:ident = $first:ident {
        $(
            $(#[doc = $about:literal])+
            $variant:ident $(($settings:ty))? = $name:literal
            $({ $($(#[doc = $help:literal])+ $field:ident: $kind:ty = $default:expr $(=> $keys:tt)?;)* })?
            $(by hand { $($(#[doc = $meaning:literal])+ $found:ident: $of:ty;)* })?
        ),* $(,)?
    }) => {
        $(#[$meta])*
        pub enum $set {
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
            }),*];

            /// The member of a name.
            pub fn named(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self::$variant),)*
                    _ => None,
                }
            }
        }

        impl $set {
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

        impl Default for $set {
            fn default() -> Self {
                Self::new($type::$first).expect("the default member has defaults")
            }
        }

        impl $crate::schema::Settings for $set {
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
        }
    };

    (@new $variant:ident ($settings:ty)) => { Some(Self::$variant(<$settings>::default())) };
    (@new $variant:ident { $($fields:tt)* }) => { Some(Self::$variant { $($fields)* }) };
    (@new $variant:ident by hand { $($found:ident)* }) => { None };
    (@new $variant:ident) => { Some(Self::$variant) };
}

pub(crate) use members;
