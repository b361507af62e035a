//! Parameters of a scene and of the structs of models.

use lights_camera_models::{
    optics::colour::Encoding,
    parameter::{BASE_COLOUR, ParameterSet as _, Value, Values},
    parameters,
    reflection::Microfacet,
};

parameters! {
    /// No parameters, and private.
    struct Nothing {}
}

#[test]
fn values_of_a_scene_survive_the_way_through_the_struct() {
    assert_eq!(Nothing::PARAMETERS.len(), 0);
    assert_eq!(Nothing::default(), Nothing::from_values(&Values::default(), Encoding::Srgb));
    for encoding in [Encoding::Srgb, Encoding::Off] {
        let mut values = Microfacet::default().to_values(encoding);
        for p in Microfacet::PARAMETERS {
            if let Some((id, _)) = p.kind.options().last() {
                values.set(p.name, Value::Choice((*id).into()));
            }
        }
        for code in 0..=255 {
            values.set(BASE_COLOUR.name, Value::Colour([code, 255 - code, code / 2]));
            let there = Microfacet::from_values(&values, encoding);
            let back = there.to_values(encoding);
            for p in Microfacet::PARAMETERS {
                assert_eq!(back.get(p), values.get(p), "{} {code}", p.name);
            }
        }
    }
    // The wrong twin: another encoding.
    let dark = Microfacet::from_values(
        &Values([(BASE_COLOUR.name.into(), Value::Colour([100; 3]))].into()),
        Encoding::Srgb,
    );
    assert_ne!(dark.to_values(Encoding::Off).get(&BASE_COLOUR), Value::Colour([100; 3]));
}
