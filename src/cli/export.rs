//! `lcm export`: a scene as code, a web page, a program, or a scene for another renderer.

use std::path::PathBuf;

use clap::{Args, builder::PossibleValuesParser};

use super::{
    Options, Outcome,
    engine::engine,
    explain::place,
    finite, name_step, outputs, progress,
    scenes::Source,
    sides, views,
    workshop::{Workshop, drawable},
};
use crate::files::Shown as _;
use crate::{
    explain::{self, finite::Tried},
    export::{
        self, ExportError, FORMS, Form, Progress, Request,
        executable::{FORM as PROGRAM, WITHOUT_WINDOW},
        view,
        write::{WriteError, inputs, may_write, write},
    },
    failure::Failure,
    scene::{Object, Scene},
    text::{did_you_mean, listed, quoted},
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file; `-` is standard input; without one, the default scene
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    #[arg(long = "as", value_name = "FORM", required = true, help = help(),
        value_parser = PossibleValuesParser::new(FORMS.iter().map(|form| form.id)), hide_possible_values = true)]
    form: String,
    /// File or folder to write; by default in the folder exports
    #[arg(long, short, value_name = "FILE|FOLDER", value_parser = outputs::place())]
    output: Option<PathBuf>,
    /// Replace an existing file or folder
    #[arg(long)]
    overwrite: bool,
    /// The object for forms that hold one: its name, or its place in the list from 0
    #[arg(long, value_name = "NAME|INDEX")]
    object: Option<String>,
    /// Export this view: A, B, C or D, or the name of a variant; by default view A, and of programs and pages all views
    #[arg(long, value_name = "VIEW")]
    view: Option<String>,
    /// Size of pictures and windows in pixels
    #[arg(long, value_name = "WxH", value_parser = sides, default_value = "1280x720")]
    size: [u32; 2],
    /// Say on a web page why this pixel has its colour: column and row, from 0,0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = place)]
    explain: Option<[u32; 2]>,
}

fn help() -> String {
    let line = |form: &&Form| format!("\n- {}: {}", form.id, form.summary);
    format!("The form:{}", FORMS.iter().map(line).collect::<String>())
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let Some(form) = export::form(&arguments.form) else {
        let form = quoted(&arguments.form);
        return Err(Failure::Usage(format!("unknown form {form}; lcm export --help lists the forms")));
    };
    let size = arguments.size;
    if let Some(pixel) = arguments.explain {
        if !form.explains() {
            let said = format!("{} does not explain pixels, only html does; omit --explain", form.id);
            return Err(Failure::Usage(said));
        }
        explain::inside(pixel, size).map_err(|error| Failure::Usage(format!("--explain: {error}")))?;
    }
    // Before an existing file is spoken of.
    if form.id == PROGRAM.id {
        engine(WITHOUT_WINDOW)?;
    }
    let source = Source::of(arguments.scene.as_deref(), workshop);
    let scene = source.open(workshop, options)?;
    let place = arguments.output.clone().unwrap_or_else(|| form.default_path(&source.stem()));
    let read = inputs(source.path(), [&scene], &workshop.registry);
    let before = may_write(form, &place, arguments.overwrite, &read).map_err(unwritten)?;
    let view = arguments.view.as_ref().map(|name| views::find(&scene, name)).transpose();
    let invalid = |why: String| Failure::Invalid(format!("{}: {why}", source.name()));
    let view = view.map_err(invalid)?;
    let (scene, of_view) = view::exported(form, &scene, view, &source.stem(), &workshop.registry);
    drawable(&workshop.registry, &scene)?;
    let object = match &arguments.object {
        Some(name) if form.of_object => find(&scene, name).map_err(invalid)?,
        Some(_) => {
            return Err(Failure::Usage(format!("{} always contains all objects; omit --object", form.id)));
        }
        None => scene.objects.iter().position(|object| object.visible).unwrap_or_default(),
    };
    let odd = finite::remark_on_scene(&scene, &workshop.registry, &mut Tried::default());
    odd.iter().for_each(|odd| options.tell(format_args!("{}: {odd}", source.name())));
    let bar = progress(100, options);
    let tell = |done: f32, what: &str| {
        bar.set_position((100.0 * done) as u64);
        name_step(&bar, what, "");
        options.detail(format_args!("{what} …"));
    };
    let request = Request {
        scene: &scene,
        registry: &workshop.registry,
        stem: &source.stem(),
        size: size.into(),
        object,
        point: arguments.explain,
    };
    let made = (form.make)(&request, &Progress { tell: &tell, cancelled: &|| false });
    bar.finish_and_clear();
    let export = made.map_err(|error| refused(&error, form, &source))?;
    write(&export, &place, &before).map_err(unwritten)?;
    of_view.iter().for_each(|note| options.tell(note));
    export.notes.iter().for_each(|note| options.tell(note));
    options.tell(format_args!("wrote {}", place.shown()));
    Ok(())
}

fn unwritten(error: WriteError) -> Failure {
    let advice = match error {
        WriteError::Exists(_) => "; --overwrite replaces it, -o writes elsewhere",
        WriteError::Taken(_) => "; -o writes elsewhere",
        _ => "",
    };
    Failure::Write(format!("{error}{advice}"))
}

fn refused(error: &ExportError, form: &Form, source: &Source) -> Failure {
    let lines = match error {
        ExportError::Refused(reasons) => reasons.iter().map(String::as_str).collect(),
        ExportError::Cancelled => vec!["cancelled"],
    };
    let name = source.name();
    let line = |reason| format!("{name}: cannot be exported as {}: {reason}", form.id);
    Failure::Invalid(lines.into_iter().map(line).collect::<Vec<_>>().join("\n"))
}

/// The index of the object with a name, or of a number in the list.
fn find(scene: &Scene, name: &str) -> Result<usize, String> {
    let called = |(_, object): &(usize, &Object)| object.name.as_deref() == Some(name);
    let named: Vec<_> = scene.objects.iter().enumerate().filter(called).map(|(i, _)| i).collect();
    match named[..] {
        [] => {}
        [one] => return Ok(one),
        [first, ..] => {
            let paths: Vec<_> = named.iter().map(|i| format!("objects[{i}]")).collect();
            let (paths, name) = (listed(&paths, "and"), quoted(name));
            return Err(format!("{paths} are called {name}; name one by its index: --object {first}"));
        }
    }
    name.parse().ok().filter(|i| *i < scene.objects.len()).ok_or_else(|| {
        let names = scene.objects.iter().filter_map(|object| object.name.as_deref());
        let hint = did_you_mean(name, names.map(|n| (n, n)));
        let last = scene.objects.len() - 1;
        format!("there is no object {}; it must be a name, or an index from 0 to {last}{hint}", quoted(name))
    })
}
