//! Structs whose fields are declared parameters.

use super::{declaration::Parameter, value::Values};
use crate::optics::colour::Encoding;

/// A type whose fields are declared parameters; written by [`parameters!`](crate::parameters).
pub trait ParameterSet: Sized + Send + Sync + 'static {
    /// The declarations, in the order of the fields.
    const PARAMETERS: &'static [Parameter];

    /// The values for calculation: colours decoded, choices as indices.
    fn from_values(values: &Values, encoding: Encoding) -> Self;
}

/// Declares the struct of a model: its fields are its parameters, each with its declaration. A block `derived { field:
/// Type = function }` after it adds fields calculated once from the others.
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
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        pub struct $name:ident { $( $(#[$field_meta:meta])* $field:ident : $kind:ident = $declaration:expr ),* $(,)? }
        $( derived {
            $( $(#[$derived_meta:meta])* $derived:ident : $derived_type:ty = $derive:expr ),* $(,)?
        } )?
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            $( $(#[$field_meta])* pub $field: $crate::parameters!(@type $kind), )*
            $( $( $(#[$derived_meta])* pub $derived: $derived_type, )* )?
        }

        impl $crate::parameter::ParameterSet for $name {
            const PARAMETERS: &'static [$crate::parameter::Parameter] = &[$($declaration),*];

            #[allow(unused_variables, unused_mut)]
            fn from_values(
                values: &$crate::parameter::Values,
                encoding: $crate::optics::colour::Encoding,
            ) -> Self {
                let mut this = Self {
                    $( $field: $crate::parameters!(@get $kind values encoding $declaration), )*
                    $( $( $derived: <$derived_type>::default(), )* )?
                };
                $( $( this.$derived = ($derive)(&this); )* )?
                this
            }
        }
    };
    (@type colour) => { glam::Vec3 };
    (@type triple) => { glam::Vec3 };
    (@type number) => { f32 };
    (@type choice) => { u32 };
    (@get colour $values:ident $encoding:ident $declaration:expr) => { $values.colour(&$declaration, $encoding) };
    (@get triple $values:ident $encoding:ident $declaration:expr) => { $values.colour(&$declaration, $encoding) };
    (@get number $values:ident $encoding:ident $declaration:expr) => { $values.number(&$declaration) };
    (@get choice $values:ident $encoding:ident $declaration:expr) => { $values.choice(&$declaration) };
}
