//! Enums whose values are declared in a file each, lists of types that are, choices and conversions, which take a line
//! each, and structs whose fields are declared with their defaults.

/// An enum with the static that declares each of its values. The declaration has an `id`.
macro_rules! declared {
    ($(#[$about:meta])* $Name:ident: $Declaration:ty { $($Value:ident = $file:ident::$declaration:ident,)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $Name {
            $(#[doc = concat!("As `", stringify!($file), ".rs` declares it.")] $Value,)+
        }

        impl $Name {
            /// Every value, in the order of presentation.
            pub const ALL: [Self; [$(stringify!($Value)),+].len()] = [$(Self::$Value),+];

            /// The declaration of the value.
            #[must_use]
            pub const fn declaration(self) -> &'static $Declaration {
                match self {
                    $(Self::$Value => &$file::$declaration,)+
                }
            }

            /// The name on the command line.
            #[must_use]
            pub const fn id(self) -> &'static str {
                self.declaration().id
            }

            /// The one with an id.
            #[must_use]
            pub fn from_id(id: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|one| one.id() == id)
            }
        }
    };
}

/// Hands types to a receiver, one after the other.
macro_rules! take_each {
    ($to:ident: $($Type:ident)+) => {
        $($to.take::<$Type>();)+
    };
}

/// An enum of choices, each with an id for files, a name for people, and one sentence.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident { $($(#[$default:ident])? $variant:ident $id:literal $label:literal $help:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum $name {
            $(#[doc = $help] $(#[$default])? $variant,)+
        }

        impl $name {
            /// Every choice, in the order of presentation.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// The id in files and on the command line.
            #[must_use]
            pub const fn id(self) -> &'static str {
                match self { $(Self::$variant => $id,)+ }
            }

            /// The name for people.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $label,)+ }
            }

            /// One sentence of explanation.
            #[must_use]
            pub const fn summary(self) -> &'static str {
                match self { $(Self::$variant => $help,)+ }
            }

            /// The choice with this id.
            #[must_use]
            pub fn from_id(id: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|choice| choice.id() == id)
            }

            /// The next choice, in a cycle.
            #[must_use]
            pub const fn next(self) -> Self {
                Self::ALL[(self as usize + 1) % Self::ALL.len()]
            }
        }
    };
}

/// An enum, each value with its words, and the method that returns them.
macro_rules! in_words {
    ($(#[$about:meta])* $visible:vis enum $Name:ident {
        $($(#[$doc:meta])* $Value:ident = $words:literal,)+
    } $(#[$of:meta])* $method:ident) => {
        $(#[$about])*
        $visible enum $Name {
            $($(#[$doc])* $Value,)+
        }

        impl $Name {
            $(#[$of])*
            #[must_use]
            $visible const fn $method(self) -> &'static str {
                [$($words),+][self as usize]
            }
        }
    };
}

/// A struct whose fields are declared with their defaults: `field: Type = default,`.
macro_rules! with_defaults {
    ($(#[$about:meta])* $visible:vis struct $Name:ident {
        $($(#[$help:meta])* $of_field:vis $field:ident: $Type:ty = $default:expr,)+
    }) => {
        $(#[$about])*
        $visible struct $Name {
            $($(#[$help])* $of_field $field: $Type,)+
        }

        impl Default for $Name {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }
    };
}

/// The conversions of types into one type.
macro_rules! from {
    ($Into:ty; $($Type:ty: |$from:ident| $value:expr;)+) => {
        $(impl From<$Type> for $Into {
            fn from($from: $Type) -> Self {
                $value
            }
        })+
    };
}

pub(crate) use {choice, declared, from, in_words, take_each, with_defaults};
