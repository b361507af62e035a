//! The fields that lights of all types have in scene files.

/// Passes the declaration to a macro: that of the scene, which makes a struct of the fields, or
/// [`keys!`](crate::declared::keys). Names in it are those known where it is called.
macro_rules! fields {
    ($with:ident) => {
        $with! {
            /// A light.
            pub struct Light("a light") {
                /// Light type.
                light_type["type"]: String = Field::of("the type", Kind::Id(Ids::LightType)).required(""), "point".to_owned();
                /// Name of the light.
                name: Option<String> = Field::of("the name", Kind::Text(None)), None;
                /// False if switched off.
                enabled: bool = Field::of("enabled", Kind::Flag(["Switch off", "Switch on"])), true;
                /// Position: [x, y, z] in metres, inside the room, not at the position of the observer or an object.
                position: Option<Vec3> = Field::of("a position", Kind::Position).unit("m").by_type(), Some(Vec3::new(7.5, 8.0, 9.0));
                /// Direction in which it shines: [x, y, z], of any length.
                direction: Option<Vec3> = Field::of("a direction", Kind::Direction).by_type(), None;
                /// Colour: [red, green, blue], whole numbers from 0 to 255, sRGB. Conflicts with `colour_temperature`.
                colour: [u8; 3] = Field::of("a colour", Kind::Colour).unit("sRGB").or("colour_temperature"), [255; 3];
                /// Colour temperature in kelvin: the colour of a black body of this temperature. A candle has 1900, a light bulb
                /// 2700, white is 6500. The luminance is that of a white light. Conflicts with `colour`.
                colour_temperature: Option<f32> = Field::number("a colour temperature", MIN_TEMPERATURE..=MAX_TEMPERATURE)
                    .unit("K").slider(1000.0, 12_000.0), None;
                /// Intensity: candela for point and spot lights; lux for directional and ambient ones and the sun; cd/m² for rectangles, discs, spheres and cylinders; a factor for photometric lamps and environments, which of a uniform one is its luminance in cd/m². Conflicts with `luminous_flux`.
                intensity: f32 = Field::number("an intensity", 0.0..=f32::INFINITY).by_type().or("luminous_flux"), 20.0;
                /// Luminous flux in lumen: the light sent out in all directions together, as printed on light bulbs. Conflicts with
                /// `intensity`.
                luminous_flux: Option<f32> = Field::number("a luminous flux", 0.0..=f32::INFINITY).unit("lm"), None;
                /// Further parameters declared by the type; absent ones have their defaults.
                parameters[""]: Values = Field::of("", Kind::Parameters), Values::default();
            }
        }
    };
}
pub(crate) use fields;
