//! Enums whose values are declared in a file each, lists of types that are, choices and other enums with texts, structs
//! whose fields are declared with their defaults, the keys of declared fields, and what differs only in names: builder
//! methods, conversions, calls of another trait, the registered types' methods.

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

/// An enum with methods that give a text for each value.
macro_rules! texts {
    (
        $(#[$about:meta])* $Name:ident($($(#[$of:meta])* $method:ident),+)
        { $($(#[$doc:meta])* $Value:ident = $($text:literal)+,)+ }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $Name {
            $($(#[$doc])* $Value,)+
        }

        const _: () = {
            #[allow(non_camel_case_types)]
            enum Text { $($method),+ }

            const TEXTS: [[&str; [$(Text::$method),+].len()]; [$($Name::$Value),+].len()] =
                [$([$($text),+]),+];

            impl $Name {
                $($(#[$of])*
                #[must_use]
                pub const fn $method(self) -> &'static str {
                    TEXTS[self as usize][Text::$method as usize]
                })+
            }
        };
    };
}

/// An enum, each value with an id, perhaps with further texts.
macro_rules! ids {
    (
        $(#[$about:meta])* $Name:ident $(($($(#[$of:meta])* $method:ident),+))?
        { $($(#[$doc:meta])* $Value:ident = $id:literal $($text:literal)*,)+ }
    ) => {
        $crate::declared::texts! {
            $(#[$about])*
            $Name(#[doc = "The name in files and on the command line."] id $($(, $(#[$of])* $method)+)?)
            { $($(#[$doc])* $Value = $id $($text)*,)+ }
        }

        impl $Name {
            /// All variants, in display order.
            pub const ALL: [Self; [$($id),+].len()] = [$(Self::$Value),+];

            /// The variant with this id.
            #[must_use]
            pub fn from_id(id: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|one| one.id() == id)
            }
        }
    };
}

/// An enum of choices, each with an id for files, a name for people, and one sentence.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident { $($(#[$default:ident])? $variant:ident $id:literal $label:literal $help:literal,)+ }) => {
        $crate::declared::texts! {
            $(#[$doc])*
            #[derive(Default)]
            $name(
                #[doc = "The id in files and on the command line."] id,
                #[doc = "The name for people."] name,
                #[doc = "One sentence of explanation."] summary
            )
            { $(#[doc = $help] $(#[$default])? $variant = $id $label $help,)+ }
        }

        impl $name {
            /// Every choice, in the order of presentation.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

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

/// The key of a declared field in scene files: its name, unless the declaration has another.
macro_rules! key {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $key:literal) => {
        $key
    };
}

/// The keys of all declared fields of a part; that of the parameters of its type is empty.
macro_rules! keys {
    (
        $(#[$about:meta])+
        pub struct $Part:ident($what:literal) {
            $($(#[$help:meta])+ $field:ident $([$key:literal])?: $type:ty = $declared:expr, $default:expr;)+
        }
    ) => {
        &[$($crate::declared::key!($field $($key)?)),+]
    };
}

/// Builder methods, each with its arguments and the fields it sets.
macro_rules! setters {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $Type:ty),*) { $($field:tt)+ })+) => {
        $($(#[$doc])*
        #[must_use]
        pub const fn $name(self, $($argument: $Type),*) -> Self {
            Self { $($field)+, ..self }
        })+
    };
}

/// Methods of a dyn-compatible trait that call the methods of the same names in a trait that is not.
macro_rules! forwards {
    (|$this:ident| $to:expr => $Trait:ident: $(fn $name:ident($($argument:ident: $Type:ty),*) -> $Result:ty;)+) => {
        $(fn $name(&self, $($argument: $Type),*) -> $Result {
            let $this = self;
            $Trait::$name($to, $($argument),*)
        })+
    };
}

/// The debug output of a type: its name and one field.
macro_rules! debug_by {
    ($Type:ident: $($field:ident).+) => {
        impl std::fmt::Debug for $Type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_tuple(stringify!($Type)).field(&self.$($field).+).finish()
            }
        }
    };
}

/// The parameters of a registered type by name, and its id as debug output.
macro_rules! entry {
    ($Entry:ident) => {
        impl $Entry {
            /// The parameter with this name, if the type has it.
            #[must_use]
            pub fn parameter(&self, name: &str) -> Option<&'static $crate::parameter::Parameter> {
                self.parameters.iter().find(|p| p.name == name)
            }
        }

        $crate::declared::debug_by!($Entry: declaration.id);
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

pub(crate) use {
    choice, debug_by, declared, entry, forwards, from, ids, key, keys, setters, take_each, texts,
    with_defaults,
};
