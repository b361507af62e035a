//! A scene as a program: a copy of the running program with the scene inside.

use super::{
    Export, ExportError, File, Form, Makes, Progress, Request,
    payload::{About, Payload, program_with},
    refusals::Refusals,
};
use crate::files::Shown as _;
use crate::{
    files,
    parameter::{Parameter, Value, Values},
    program::{HAS_WINDOW, without_window},
    registry::MODELS,
    scene::{Scene, save},
};

/// The form.
pub const FORM: Form = Form {
    id: "executable",
    name: "Program",
    summary: "a copy of this program that opens straight on the scene; runs on systems like this one",
    makes: Makes::File(if cfg!(windows) { "exe" } else { "" }),
    of_object: false,
    of_view: false,
    make,
};

/// The hint given in a program without the window.
pub(crate) const WITHOUT_WINDOW: &str =
    "a copy of it could not show the scene; a web page can, with --as html";

/// Default size of the window.
const USUAL: (u32, u32) = (1280, 720);

fn make(request: &Request, progress: &Progress) -> Result<Export, ExportError> {
    if !HAS_WINDOW {
        return Err(ExportError::refused(without_window(WITHOUT_WINDOW)));
    }
    progress.step(0.0, "gathering the files of the scene")?;
    let mut files = Vec::new();
    let scene = with_files(request, &mut files)?;
    let sources = request.registry.sources();
    for path in sources.edited() {
        let text = sources.get(path).unwrap_or_default();
        let path = if path.starts_with(MODELS) { path.to_owned() } else { format!("shaders/{path}") };
        files.push((path, text.as_bytes().to_vec()));
    }
    let payload = Payload {
        scene: save::to_json(&scene, None, request.registry).into_bytes(),
        about: About {
            stem: request.stem.to_owned(),
            size: (request.size != USUAL).then_some(request.size.into()),
        },
        files,
        checksum: 0,
    };
    progress.step(0.3, "copying the program")?;
    let bytes = program_with(&payload).map_err(|error| ExportError::refused(error.to_string()))?;
    let file = File { executable: true, ..File::new("", bytes) };
    let system =
        format!("it runs on {} ({}), like this program", std::env::consts::OS, std::env::consts::ARCH);
    Ok(Export { files: vec![file], notes: vec![system] })
}

/// The scene with a name, and with its file paths replaced by paths in `files`.
fn with_files(request: &Request, files: &mut Vec<(String, Vec<u8>)>) -> Result<Scene, ExportError> {
    let mut scene = request.scene.clone();
    scene.name.get_or_insert_with(|| request.stem.to_owned());
    let mut refused = Refusals::default();
    for (i, light) in scene.lights.iter_mut().enumerate() {
        let parameters = request.registry.light(&light.light_type).map_or(&[][..], |entry| entry.parameters);
        carry(&mut light.parameters, parameters, files)
            .unwrap_or_else(|problem| refused.add(request.scene.light_path(i), problem));
    }
    let materials: Vec<_> = request.registry.material_parameters().collect();
    for (i, object) in scene.objects.iter_mut().enumerate() {
        let shape = request.registry.shape(&object.object_type).map_or(&[][..], |entry| entry.parameters);
        carry(&mut object.shape, shape, files)
            .and_then(|()| carry(&mut object.material, materials.iter().copied(), files))
            .unwrap_or_else(|problem| refused.add(request.scene.object_path(i), problem));
    }
    refused.or(scene)
}

/// Adds the files named by some values, each once; files included in every program are left out.
fn carry<'a>(
    values: &mut Values,
    parameters: impl IntoIterator<Item = &'a Parameter>,
    files: &mut Vec<(String, Vec<u8>)>,
) -> Result<(), String> {
    for parameter in parameters {
        let Some(Value::File(file)) = values.0.get(parameter.name) else { continue };
        let Some(path) = file.path() else { continue };
        let bytes = files::read(path, file.max_bytes()).map_err(|error| {
            format!("{} is {}, which could not be read: {error}", parameter.name, path.shown())
        })?;
        let name = path.file_name().map_or_else(|| "file".into(), |name| name.to_string_lossy());
        let known = files.iter().find(|(place, there)| *there == bytes && place.ends_with(&*name));
        let place = known.map(|(place, _)| place.clone()).unwrap_or_else(|| {
            let place = format!("files/{}/{name}", files.len());
            files.push((place.clone(), bytes));
            place
        });
        let renamed = file.renamed(place);
        values.set(parameter.name, Value::File(renamed));
    }
    Ok(())
}
