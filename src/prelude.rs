//! The most important names for extensions of the program, to be imported next to `bevy::prelude`. The
//! declarations of models, lights and shapes, which share a name, stay in their modules.

pub use crate::{
    document::{Edit, PartId, Selection},
    light::{self, Incident, LightRecord, LightType},
    optics::{Frame, Terms},
    parameter::{Parameter, ParameterKind, Value},
    parameters,
    reflection::{self, ReflectionModel},
    registry::{Register, Registry},
    scene::{
        Light, Object, Part, Scene,
        formats::{SceneFormat, SceneFormats},
    },
    shader::Source,
    shading::{self, ShadingModel},
    shape::{self, ObjectType, PolygonMesh},
};
#[cfg(feature = "window")]
pub use crate::{
    panel::{
        Panel, PanelApp, PanelContext, Panels, Place,
        state::{Action, Session},
    },
    render::{
        parts::{
            Animated, LightColour, LightPower, SceneLight, SceneObject, SceneObserver, Surface, Tessellation,
        },
        schedule::{LabFrame, LabSystems},
    },
    window::LabPlugins,
};

#[cfg(all(test, feature = "window"))]
mod tests {
    #![deny(ambiguous_glob_imports)]

    use bevy::prelude::*;

    use super::super::prelude::*;

    /// Compiles only if no name is also Bevy's.
    #[test]
    fn both_preludes_can_be_imported() {
        fn known<T: ?Sized>() {}
        known::<(App, Transform)>();
        known::<(Edit, Selection, Incident, LightRecord, Frame, Terms, PanelContext, Panels, Place, Action)>(
        );
        known::<(PartId, Session, Parameter, ParameterKind, Value, Registry, LabFrame)>();
        known::<(
            Animated,
            LightColour,
            LightPower,
            SceneLight,
            SceneObject,
            SceneObserver,
            Surface,
            Tessellation,
        )>();
        known::<(LabSystems, Light, Object, Scene, Source, PolygonMesh, LabPlugins, dyn Panel)>();
        fn registers<R: Register, M: ReflectionModel, S: ShadingModel, L: LightType, T: ObjectType>() {}
        registers::<Registry, reflection::Lambert, shading::Flat, light::Point, shape::Sphere>();
    }
}
