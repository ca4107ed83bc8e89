//! The macros that declare settings.

/// Declares a struct of settings, or a closed set whose members have settings.
///
/// ```text
/// settings! {
///     /// What it is.
///     #[derive(…)]
///     pub struct Name {
///         /// What the field means: documentation and help.
///         field: Type = default => ["name" | "alias": domain];
///         /// Settings that are elements of an array.
///         array: [Type; 2] = default => ["first"[0], "second"[1]];
///         /// Settings of their own, among those of this struct.
///         part: OtherSettings = default => ..;
///         /// A field that is not a setting.
///         other: Type = default;
///     }
/// }
/// ```
///
/// A set is an `enum` with the name of its default member, whose members have no settings, those of
/// a struct, or fields as above; `not drawn` marks a member that cannot be chosen:
///
/// ```text
/// settings! {
///     /// What it is.
///     #[derive(…)]
///     pub enum Set = First {
///         /// What it is.
///         First(FirstDesc) = "first" | "another-name",
///         /// What it is.
///         Second = "second" { /* fields */ },
///         /// What it is.
///         Third = "third" (not drawn),
///     }
/// }
/// ```
///
/// `pub enum Set: Facts = First` gives each member a constant of the type `Facts`, which has a
/// constant `NONE`. A member then does not compile without a list of what differs from `NONE`,
/// where a field alone is `true`: `First(FirstDesc) = "first" [is_quick, order: 2]`.
macro_rules! settings {
    ($(#[$meta:meta])* pub struct $name:ident {
        $($(#[doc = $help:literal])+ $field:ident: $type:ty = $default:expr $(=> $keys:tt)?;)*
    }) => {
        $(#[$meta])*
        pub struct $name {
            $($(#[doc = $help])+ pub $field: $type,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl $crate::schema::Settings for $name {
            #[allow(unused_variables)]
            fn visit(&mut self, visitor: $crate::schema::Visitor) {
                let Self { $($field,)* } = self;
                $($crate::schema::settings!(@visit visitor ($field) (concat!($($help),+)) $($keys)?);)*
            }

            fn member(&self) -> Option<&'static $crate::schema::Member> {
                None $($(.or_else(|| $crate::schema::settings!(@member (self.$field) $keys)))?)*
            }

            fn members() -> Vec<Self> {
                let members = vec![Self::default()];
                $($($crate::schema::settings!(@members members $field $type, $keys);)?)*
                members
            }
        }
    };

    ($(#[$meta:meta])* pub enum $name:ident $(: $facts:ident)? = $first:ident {
        $(
            $(#[doc = $about:literal])+
            $variant:ident $(($settings:ty))? = $($spelling:literal)|+ $(($not:ident drawn))?
                $([$($fact:ident $(: $value:expr)?),*])? $({
                $($(#[doc = $help:literal])+ $field:ident: $type:ty = $default:expr $(=> $keys:tt)?;)*
            })?,
        )*
    }) => {
        $(#[$meta])*
        pub enum $name {
            $($(#[doc = $about])+ $variant $(($settings))? $({ $($(#[doc = $help])+ $field: $type,)* })?,)*
        }

        $crate::schema::settings!(@facts $name [$($facts)?] $($variant $([$($fact $(: $value)?),*])?)*);

        impl Default for $name {
            fn default() -> Self {
                #[allow(dead_code)]
                enum Member { $($variant,)* }
                match Member::$first {
                    $(Member::$variant => Self::$variant $((<$settings>::default()))? $({ $($field: $default,)* })?,)*
                }
            }
        }

        impl $crate::schema::Settings for $name {
            fn visit(&mut self, visitor: $crate::schema::Visitor) {
                match self {
                    $(
                        $(Self::$variant(settings) => <$settings as $crate::schema::Settings>::visit(settings, visitor),)?
                        $(Self::$variant { $($field,)* } => {
                            $($crate::schema::settings!(@visit visitor ($field) (concat!($($help),+)) $($keys)?);)*
                        })?
                    )*
                    #[allow(unreachable_patterns)]
                    _ => (),
                }
            }

            fn member(&self) -> Option<&'static $crate::schema::Member> {
                Some(match self {
                    $(Self::$variant { .. } => const {
                        &$crate::schema::Member {
                            names: &[$($spelling),+],
                            help: concat!($($about),+).trim_ascii(),
                            is_drawn: $crate::schema::settings!(@drawn $($not)?),
                            is_extension: false,
                        }
                    },)*
                })
            }

            fn members() -> Vec<Self> {
                vec![$(Self::$variant $((<$settings>::default()))? $({ $($field: $default,)* })?,)*]
            }
        }
    };

    (@facts $name:ident [] $($variant:ident)*) => {};
    (@facts $name:ident [$facts:ident] $($variant:ident [$($fact:ident $(: $value:expr)?),*])*) => {
        impl $name {
            /// The facts of the member, which do not depend on its settings.
            pub fn facts(&self) -> &'static $facts {
                match self {
                    $(Self::$variant { .. } => const {
                        &$facts { $($fact: $crate::schema::settings!(@fact $($value)?),)* ..$facts::NONE }
                    },)*
                }
            }
        }
    };

    (@fact) => { true };
    (@fact $value:expr) => { $value };

    (@visit $visitor:ident ($field:expr) ($help:expr)) => {};
    (@visit $visitor:ident ($field:expr) ($help:expr) ..) => {
        $crate::schema::Settings::visit($field, $visitor)
    };
    (@visit $visitor:ident ($field:expr) ($help:expr) [
        $($name:literal $([$element:literal])? $(| $alias:literal)* $(: $domain:expr)?),+
    ]) => {
        $($visitor(
            const {
                &$crate::schema::Field {
                    name: $name,
                    aliases: &[$($alias),*],
                    help: $help.trim_ascii(),
                    domain: $crate::schema::settings!(@domain $($domain)?),
                }
            },
            &mut (*$field) $([$element])?,
        );)+
    };

    (@domain) => { $crate::schema::Domain::ANY };
    (@domain $domain:expr) => { $domain };

    (@drawn) => { true };
    (@drawn not) => { false };

    (@member ($field:expr) ..) => { $crate::schema::Settings::member(&$field) };
    (@member ($field:expr) $names:tt) => { None };

    (@members $members:ident $field:ident $type:ty, ..) => {
        let $members: Vec<Self> = $members
            .into_iter()
            .flat_map(|desc| {
                <$type as $crate::schema::Settings>::members()
                    .into_iter()
                    .map(move |$field| Self { $field, ..desc.clone() })
            })
            .collect();
    };
    (@members $members:ident $field:ident $type:ty, $names:tt) => {};
}

pub(crate) use settings;
