//! Reflection of structs of declared parameters, for tools that access values by name, such as inspectors.

/// Implements Bevy's `Reflect` for a struct of [`parameters!`](crate::parameters); its fields are the
/// parameters. The derive macro would require each crate that declares parameters to depend on Bevy itself.
#[doc(hidden)]
#[macro_export]
macro_rules! reflect_parameters {
    ($name:ident { $( $field:ident: $type:ty ),* } derived { $( $derived:ident = $derive:expr ),* }) => {
        const _: () = {
            use $crate::{
                bevy_ecs::reflect::ReflectComponent,
                bevy_reflect::{
                    ApplyError, FromReflect, FromType, GetTypeRegistration, NamedField, PartialReflect, Reflect,
                    ReflectFromPtr, ReflectFromReflect, ReflectKind, ReflectMut, ReflectOwned, ReflectRef, TypeInfo,
                    TypePath, TypeRegistration, TypeRegistry, Typed,
                    std_traits::ReflectDefault,
                    structs::{FieldIter, Struct, StructInfo, struct_partial_eq},
                    utility::NonGenericTypeInfoCell,
                },
            };

            const FIELDS: &[&str] = &[$(::core::stringify!($field)),*];

            impl TypePath for $name {
                fn type_path() -> &'static str {
                    ::core::concat!(::core::module_path!(), "::", ::core::stringify!($name))
                }
                fn short_type_path() -> &'static str {
                    ::core::stringify!($name)
                }
                fn type_ident() -> ::core::option::Option<&'static str> {
                    ::core::option::Option::Some(::core::stringify!($name))
                }
                fn crate_name() -> ::core::option::Option<&'static str> {
                    ::core::module_path!().split("::").next()
                }
                fn module_path() -> ::core::option::Option<&'static str> {
                    ::core::option::Option::Some(::core::module_path!())
                }
            }

            impl Typed for $name {
                fn type_info() -> &'static TypeInfo {
                    static INFO: NonGenericTypeInfoCell = NonGenericTypeInfoCell::new();
                    INFO.get_or_set(|| {
                        let fields: &[NamedField] = &[$(NamedField::new::<$type>(::core::stringify!($field))),*];
                        TypeInfo::Struct(StructInfo::new::<Self>(fields))
                    })
                }
            }

            impl GetTypeRegistration for $name {
                fn get_type_registration() -> TypeRegistration {
                    let mut registration = TypeRegistration::of::<Self>();
                    registration.insert::<ReflectFromPtr>(FromType::<Self>::from_type());
                    registration.insert::<ReflectFromReflect>(FromType::<Self>::from_type());
                    registration.insert::<ReflectDefault>(FromType::<Self>::from_type());
                    registration.insert::<ReflectComponent>(FromType::<Self>::from_type());
                    registration
                }
                fn register_type_dependencies(_registry: &mut TypeRegistry) {
                    $( _registry.register::<$type>(); )*
                }
            }

            impl FromReflect for $name {
                fn from_reflect(value: &dyn PartialReflect) -> ::core::option::Option<Self> {
                    let mut this = <Self as ::core::default::Default>::default();
                    this.try_apply(value).ok().map(|()| this)
                }
            }

            impl Struct for $name {
                fn field(&self, name: &str) -> ::core::option::Option<&dyn PartialReflect> {
                    self.field_at(self.index_of_name(name)?)
                }
                fn field_mut(&mut self, name: &str) -> ::core::option::Option<&mut dyn PartialReflect> {
                    self.field_at_mut(self.index_of_name(name)?)
                }
                fn field_at(&self, index: usize) -> ::core::option::Option<&dyn PartialReflect> {
                    let all: [&dyn PartialReflect; FIELDS.len()] = [$(&self.$field),*];
                    all.get(index).copied()
                }
                fn field_at_mut(&mut self, index: usize) -> ::core::option::Option<&mut dyn PartialReflect> {
                    let all: [&mut dyn PartialReflect; FIELDS.len()] = [$(&mut self.$field),*];
                    all.into_iter().nth(index)
                }
                fn name_at(&self, index: usize) -> ::core::option::Option<&str> {
                    FIELDS.get(index).copied()
                }
                fn index_of_name(&self, name: &str) -> ::core::option::Option<usize> {
                    FIELDS.iter().position(|known| *known == name)
                }
                fn field_len(&self) -> usize {
                    FIELDS.len()
                }
                fn iter_fields(&self) -> FieldIter<'_> {
                    FieldIter::new(self)
                }
            }

            impl PartialReflect for $name {
                fn get_represented_type_info(&self) -> ::core::option::Option<&'static TypeInfo> {
                    ::core::option::Option::Some(<Self as Typed>::type_info())
                }
                fn into_partial_reflect(self: ::std::boxed::Box<Self>) -> ::std::boxed::Box<dyn PartialReflect> {
                    self
                }
                fn as_partial_reflect(&self) -> &dyn PartialReflect {
                    self
                }
                fn as_partial_reflect_mut(&mut self) -> &mut dyn PartialReflect {
                    self
                }
                fn try_into_reflect(
                    self: ::std::boxed::Box<Self>,
                ) -> ::core::result::Result<::std::boxed::Box<dyn Reflect>, ::std::boxed::Box<dyn PartialReflect>> {
                    ::core::result::Result::Ok(self)
                }
                fn try_as_reflect(&self) -> ::core::option::Option<&dyn Reflect> {
                    ::core::option::Option::Some(self)
                }
                fn try_as_reflect_mut(&mut self) -> ::core::option::Option<&mut dyn Reflect> {
                    ::core::option::Option::Some(self)
                }
                fn try_apply(&mut self, value: &dyn PartialReflect) -> ::core::result::Result<(), ApplyError> {
                    let ReflectRef::Struct(values) = value.reflect_ref() else {
                        return ::core::result::Result::Err(ApplyError::MismatchedKinds {
                            from_kind: value.reflect_kind(),
                            to_kind: ReflectKind::Struct,
                        });
                    };
                    for (name, value) in values.iter_fields() {
                        if let ::core::option::Option::Some(field) = self.field_mut(name) {
                            field.try_apply(value)?;
                        }
                    }
                    $( self.$derived = ($derive)(&*self); )*
                    ::core::result::Result::Ok(())
                }
                fn reflect_ref(&self) -> ReflectRef<'_> {
                    ReflectRef::Struct(self)
                }
                fn reflect_mut(&mut self) -> ReflectMut<'_> {
                    ReflectMut::Struct(self)
                }
                fn reflect_owned(self: ::std::boxed::Box<Self>) -> ReflectOwned {
                    ReflectOwned::Struct(self)
                }
                fn reflect_clone(
                    &self,
                ) -> ::core::result::Result<::std::boxed::Box<dyn Reflect>, $crate::bevy_reflect::ReflectCloneError>
                {
                    ::core::result::Result::Ok(::std::boxed::Box::new(::core::clone::Clone::clone(self)))
                }
                fn reflect_partial_eq(&self, value: &dyn PartialReflect) -> ::core::option::Option<bool> {
                    struct_partial_eq(self, value)
                }
            }

            impl Reflect for $name {
                fn into_any(self: ::std::boxed::Box<Self>) -> ::std::boxed::Box<dyn ::core::any::Any> {
                    self
                }
                fn as_any(&self) -> &dyn ::core::any::Any {
                    self
                }
                fn as_any_mut(&mut self) -> &mut dyn ::core::any::Any {
                    self
                }
                fn into_reflect(self: ::std::boxed::Box<Self>) -> ::std::boxed::Box<dyn Reflect> {
                    self
                }
                fn as_reflect(&self) -> &dyn Reflect {
                    self
                }
                fn as_reflect_mut(&mut self) -> &mut dyn Reflect {
                    self
                }
                fn set(
                    &mut self,
                    value: ::std::boxed::Box<dyn Reflect>,
                ) -> ::core::result::Result<(), ::std::boxed::Box<dyn Reflect>> {
                    *self = <dyn Reflect>::take(value)?;
                    ::core::result::Result::Ok(())
                }
            }
        };
    };
}

#[cfg(test)]
mod tests {
    use bevy_reflect::{
        FromReflect as _, GetPath as _, PartialReflect as _, TypePath as _, Typed as _, structs::Struct,
    };

    use crate::{
        light::{Photometric, Spot},
        optics::colour::Encoding,
        parameter::{ParameterSet as _, Table},
        reflection::Microfacet,
    };

    #[test]
    fn parameters_are_fields_for_tools() {
        let mut spot = Spot::default();
        *spot.path_mut::<f32>("cone_angle").expect("a field") = 12.0;
        assert_eq!(spot.cone_angle, 12.0);
        assert_eq!(Spot::type_path(), "lights_camera_models::light::spot::Spot");
        let names = |all: &dyn Struct| -> Vec<_> {
            (0..all.field_len()).filter_map(|i| all.name_at(i).map(str::to_owned)).collect()
        };
        assert_eq!(names(&spot), ["cone_angle", "penumbra"]);
        assert_eq!(
            names(&Microfacet::default()),
            Microfacet::PARAMETERS.iter().map(|p| p.name).collect::<Vec<_>>()
        );
        assert!(spot.field("cone").is_none() && spot.field_at(2).is_none() && spot.field_at_mut(2).is_none());
        assert_eq!(Spot::type_info().as_struct().expect("a struct").field_len(), 2);
        let files = Photometric::default();
        assert!(files.path::<Table>("file").is_ok());
    }

    #[test]
    fn values_go_through_reflection_unchanged() {
        let spot = Spot { cone_angle: 12.0, penumbra: 0.75 };
        assert_eq!(Spot::from_reflect(&spot.to_dynamic_struct()), Some(spot));
        let clone = spot.reflect_clone().expect("it can be cloned");
        assert_eq!(clone.reflect_partial_eq(&spot), Some(true));
        assert_eq!(clone.reflect_partial_eq(&Spot::default()), Some(false));
        assert_eq!(Spot::from_reflect(&1.0_f32), None, "the wrong twin");
        // Derived fields are recalculated when parameters change.
        let rough = Microfacet { alpha_x: 0.9, multiple_scattering: 1, ..Microfacet::default() };
        let rough = Microfacet::from_values(&rough.to_values(Encoding::Srgb), Encoding::Srgb);
        assert_ne!(rough.lobe, Microfacet::default().lobe);
        assert_eq!(
            Microfacet::from_reflect(&rough.to_dynamic_struct()).map(|other| other.lobe),
            Some(rough.lobe)
        );
    }
}
