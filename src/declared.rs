//! Enums whose values are declared in a file each.

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

pub(crate) use declared;
