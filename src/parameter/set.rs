//! Structs whose fields are declared parameters.

use super::{Parameter, values::Values};
use crate::optics::colour::Encoding;

/// A type whose fields are declared parameters; written by [`parameters!`](crate::parameters).
pub trait ParameterSet: Sized + Send + Sync + 'static {
    /// The declarations, in the order of the fields.
    const PARAMETERS: &'static [Parameter];

    /// The values for calculation: colours decoded, choices as indices.
    fn from_values(values: &Values, encoding: Encoding) -> Self;

    /// The values as a scene has them: colours encoded to 8 bits, choices by name.
    fn to_values(&self, encoding: Encoding) -> Values;
}

/// Declares a struct whose fields are the parameters of a model, a light type or an object type, each with the file of
/// its [kind](crate::parameter::kind) and its declaration. A block `derived { field: Type = function }` after it adds
/// fields calculated once from the others. The default of the struct has the declared defaults. The struct is also a
/// component of Bevy's, and known to its reflection.
///
/// ```
/// use lights_camera_models::{parameters, parameter::{BASE_COLOUR, K_D, ParameterSet}};
/// parameters! {
///     /// A model with two parameters.
///     pub struct Matte {
///         /// The colour.
///         base_colour: colour = BASE_COLOUR,
///         /// The fraction of light that it scatters.
///         k_d: number = K_D,
///     }
/// }
/// assert_eq!(Matte::PARAMETERS[1].name, "k_d");
/// assert_eq!(Matte::default().k_d, 0.8);
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        $visible:vis struct $name:ident { $( $(#[$field_meta:meta])* $field:ident : $kind:ident = $declaration:expr ),* $(,)? }
        $( derived {
            $( $(#[$derived_meta:meta])* $derived:ident : $derived_type:ty = $derive:expr ),* $(,)?
        } )?
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        $visible struct $name {
            $( $(#[$field_meta])* pub $field: $crate::parameter::kind::$kind::Field, )*
            $( $( $(#[$derived_meta])* pub $derived: $derived_type, )* )?
        }

        $crate::parameters!(@copy $name $($kind)*);

        $crate::reflect_parameters!($name {
            $( $field: $crate::parameter::kind::$kind::Field ),*
        } derived {
            $( $( $derived = $derive ),* )?
        });

        impl ::core::default::Default for $name {
            fn default() -> Self {
                <Self as $crate::parameter::ParameterSet>::from_values(
                    &::core::default::Default::default(),
                    ::core::default::Default::default(),
                )
            }
        }

        impl $crate::bevy_ecs::component::Component for $name {
            const STORAGE_TYPE: $crate::bevy_ecs::component::StorageType =
                $crate::bevy_ecs::component::StorageType::Table;
            type Mutability = $crate::bevy_ecs::component::Mutable;
        }

        impl $crate::parameter::ParameterSet for $name {
            const PARAMETERS: &'static [$crate::parameter::Parameter] = &[$($declaration),*];

            #[allow(unused_variables, unused_mut, clippy::needless_update)]
            fn from_values(
                values: &$crate::parameter::Values,
                encoding: $crate::optics::colour::Encoding,
            ) -> Self {
                let mut this = Self {
                    $( $field: values.field(&$declaration, encoding), )*
                    $( $( $derived: <$derived_type>::default(), )* )?
                };
                $( $( this.$derived = ($derive)(&this); )* )?
                this
            }

            #[allow(unused_variables, unused_mut)]
            fn to_values(&self, encoding: $crate::optics::colour::Encoding) -> $crate::parameter::Values {
                let mut values = $crate::parameter::Values::default();
                $(
                    if let Some(value) =
                        $crate::parameter::kind::Member::value(&self.$field, &$declaration.kind, encoding)
                    {
                        values.set($declaration.name, value);
                    }
                )*
                values
            }
        }
    };
    // The numbers of a file are behind a reference-counted pointer.
    (@copy $name:ident) => { impl ::core::marker::Copy for $name {} };
    (@copy $name:ident file $($kind:ident)*) => {};
    (@copy $name:ident $first:ident $($kind:ident)*) => { $crate::parameters!(@copy $name $($kind)*); };
}
