//! The fields that objects of all types have in scene files.

/// Passes the declaration to a macro: that of the scene, which makes a struct of the fields, or
/// [`keys!`](crate::declared::keys). Names in it are those known where it is called.
macro_rules! fields {
    ($with:ident) => {
        $with! {
            /// An object.
            pub struct Object("an object") {
                /// Object type.
                object_type["type"]: String = Field::of("the type", Kind::Id(Ids::ObjectType)).required(""), "sphere".to_owned();
                /// Name of the object.
                name: Option<String> = Field::of("the name", Kind::Text(None)), None;
                /// False if hidden.
                visible: bool = Field::of("visible", Kind::Flag(["Hide", "Show"])), true;
                /// Position of the centre: [x, y, z] in metres, inside the room, not at the position of a light or the observer.
                position: Vec3 = Field::of("a position", Kind::Position).unit("m").required("an object needs one"), Vec3::splat(5.0);
                // Far beyond a million kilometres, the squares of distances and of their derivatives overflow on GPUs, and the
                // two renderers could not agree on a picture.
                /// Largest extent, metres.
                size: f32 = Field::number("a size", ABOVE_ZERO..=1e9).unit("m").always(), 2.0;
                /// Rotation in degrees about x, then y, then z.
                rotation: Vec3 = Field::of("a rotation", Kind::Rotation).unit("°"), Vec3::ZERO;
                /// Tessellation: how finely the shape is divided into polygons.
                tessellation: Option<u32> = Field::of("the tessellation", Kind::Count(0)), None;
                /// Parameters declared by the type; absent ones have their defaults.
                shape[""]: Values = Field::of("", Kind::Parameters), Values::default();
                /// Override of the scene's reflection model.
                reflection_model: Option<String> = Field::of("the reflection model", Kind::Id(Ids::ReflectionModel)), None;
                /// Override of the scene's shading model.
                shading_model: Option<String> = Field::of("the shading model", Kind::Id(Ids::ShadingModel)), None;
                /// Parameters of the reflection model and of the shading model, by name. One material serves every model: values not
                /// used by the current
                /// model are kept for the others.
                material: Values = Field::of("the material", Kind::Material), Values::default();
                /// Row or grid: the object stands for so many copies, which may differ in some values.
                repeat: Repetition = Field::of("the row", Kind::Part).always(), Repetition::None;
            }
        }
    };
}
pub(crate) use fields;
