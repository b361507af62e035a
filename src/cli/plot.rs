//! `lcm plot`: curves of models as figures and numbers.

use std::{
    io::Write as _,
    path::{Path, PathBuf},
};

use clap::{Args, builder::PossibleValuesParser, builder::TypedValueParser as _};

use super::{
    Options, Outcome, complain,
    evaluate::{Machine, SetParameters, find, setting},
    outputs, print, progress,
    workshop::{Workshop, valid},
};
use crate::files::Shown as _;
use crate::{
    curves::{
        Channel, CurveError, Detail, Form, Format, Kind, Setup, Sheet, Subject, curve, slice, subjects_with,
    },
    export::write::inputs,
    failure::Failure,
    files::Output,
    optics::colour::Encoding,
    parameter::Values,
    progress::Progress,
    registry::Registry,
    text::{listed, quoted},
};

/// Parser of kinds, which lists them in the help.
fn kind() -> impl clap::builder::TypedValueParser<Value = Kind> {
    PossibleValuesParser::new(Kind::ALL.map(Kind::id)).map(|id| Kind::from_id(&id).unwrap_or(Kind::Brdf))
}

fn channel() -> impl clap::builder::TypedValueParser<Value = Channel> {
    PossibleValuesParser::new(Channel::ALL.map(Channel::id))
        .map(|id| Channel::from_id(&id).unwrap_or(Channel::Luminance))
}

/// Parser of angles; their range depends on the kind of plot.
fn angle(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "it must be a number of degrees, e.g. 22.5".to_owned())
}

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// IDs of models, each with parameters of its own if it has any: phong, phong:alpha=20, phong:alpha=20:k_s=0.3; with
    /// spaces or commas between them
    #[arg(value_name = "MODEL[:NAME=VALUE]", required_unless_present = "data")]
    wanted: Vec<String>,
    #[command(flatten)]
    set: SetParameters,
    #[arg(long, value_parser = kind(), default_value = "f", hide_possible_values = true, help = format!("The quantity: {}", Kind::listed()))]
    kind: Kind,
    /// The angle between light and normal, degrees, for kinds in the plane of incidence
    #[arg(long, value_name = "DEG", default_value_t = 45.0, value_parser = angle)]
    theta_i: f64,
    /// The azimuth of the plane from the tangent, degrees, for anisotropic models
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = angle)]
    phi_i: f64,
    /// What figures show of three channels: luminance by default, for slices colour
    #[arg(long, value_parser = channel())]
    channel: Option<Channel>,
    /// Use a logarithmic axis
    #[arg(long)]
    log: bool,
    /// Lay measured data over the curves: krylon_blue, garnet_red, acryl_blue, or the fit to a material of the MERL
    /// database, such as gold-metallic-paint; can be repeated
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    data: Vec<String>,
    /// File to write: .svg, .png or .csv; without it CSV goes to standard output
    #[arg(long, short, value_name = "FILE", value_parser = outputs::place())]
    output: Option<PathBuf>,
}

/// One curve as written: `phong:alpha=20:k_s=0.3`.
struct Wanted<'a> {
    id: &'a str,
    settings: Vec<&'a str>,
    written: &'a str,
}

/// The curves in one word. A comma before a number belongs to a value, such as that of a colour.
fn wanted(word: &str) -> Vec<Wanted<'_>> {
    let starts_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let (mut all, mut start) = (Vec::new(), 0);
    for (comma, _) in word.match_indices(',').chain([(word.len(), "")]) {
        if !word[comma..].strip_prefix(',').is_some_and(|rest| starts_number(rest.trim_start())) {
            let written = word[start..comma].trim();
            let mut parts = written.split(':');
            let id = parts.next().unwrap_or_default().trim();
            all.push(Wanted { id, settings: parts.collect(), written });
            start = comma + 1;
        }
    }
    all
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let format = |file: &PathBuf| {
        Format::of(file).map_err(|rule| Failure::Usage(format!("-o {}: {rule}", file.shown())))
    };
    let format = arguments.output.as_ref().map(format).transpose()?;
    let setup = Setup::new(arguments.kind, arguments.theta_i, arguments.phi_i).map_err(|error| {
        let option = match error {
            CurveError::Azimuth(_) => "--phi-i",
            _ => "--theta-i",
        };
        Failure::Usage(format!("{option}: {error}"))
    })?;
    let models: Vec<_> = arguments.wanted.iter().flat_map(|word| wanted(word)).collect();
    models.iter().for_each(|model| workshop.need(model.id));
    let registry = &workshop.registry;
    let mut subjects = subjects(&models, &arguments.set, registry)?;
    for name in &arguments.data {
        let measured = Subject::measured(name.trim());
        subjects.push(
            measured.map_err(|rule| Failure::Usage(format!("--data is {}, but {rule}", quoted(name))))?,
        );
    }
    if let (Some(file), Some(format)) = (&arguments.output, format) {
        outputs::of_format(file, format.signature(), &inputs([], [], registry))?;
    }
    let sheet = sheet(&subjects, setup, arguments, options, registry)?;
    let (Some(file), Some(format)) = (&arguments.output, format) else {
        print(&sheet.csv())?;
        sheet.notes().iter().for_each(complain);
        return Ok(());
    };
    write(file, &format.bytes(&sheet)?)?;
    sheet.notes().iter().for_each(complain);
    options.tell(format_args!("wrote {}", file.shown()));
    Ok(())
}

/// The models with their parameters.
fn subjects(models: &[Wanted], set: &SetParameters, registry: &Registry) -> Result<Vec<Subject>, Failure> {
    let mut subjects = Vec::new();
    let mut problems = Vec::new();
    let mut entries = Vec::new();
    for wanted in models {
        let model = find(registry, wanted.id)?;
        valid(registry, model)?;
        Machine::Cpu.can_run(model)?;
        entries.push((wanted, model));
    }
    for (wanted, model) in &entries {
        let mut values = Values::default();
        let place = wanted.written;
        for text in &wanted.settings {
            let Some((name, value)) = text.split_once('=') else {
                problems
                    .push(format!("{place}: a colon must be followed by NAME=VALUE, e.g. phong:alpha=20"));
                continue;
            };
            match setting(model, name.trim(), value.trim()) {
                Ok((name, _)) if values.0.contains_key(name) => {
                    problems.push(format!("{place}: {name} is given twice"));
                }
                Ok((name, value)) => values.set(name, value),
                Err(problem) => problems.push(format!("{place}: {problem}")),
            }
        }
        for of_all in &set.settings {
            let name = of_all.name.as_str();
            // Values given with the model take precedence over those given for all.
            let given = wanted.settings.iter().any(|text| text.split('=').next() == Some(name));
            // A parameter of one of the other models is not an error.
            let elsewhere = entries.iter().any(|(_, other)| other.parameter(name).is_some());
            if !given && (!elsewhere || model.parameter(name).is_some()) {
                of_all.put(model, &mut values, &mut problems);
            }
        }
        subjects.push(Subject::model(model, &values, Encoding::Srgb));
    }
    problems.dedup();
    if problems.is_empty() { Ok(subjects) } else { Err(Failure::Usage(problems.join("\nerror: "))) }
}

/// Calculates everything.
fn sheet(
    subjects: &[Subject],
    setup: Setup,
    arguments: &Arguments,
    options: Options,
    registry: &Registry,
) -> Result<Sheet, Failure> {
    let failed = |error: CurveError| match error {
        CurveError::NoFactor { .. } => {
            let known = listed(&subjects_with(setup.kind, registry), "and");
            Failure::Usage(format!("--kind {}: {error}; models with one: {known}", setup.kind.id()))
        }
        CurveError::NotMeasured { .. } => Failure::Usage(format!("--kind {}: {error}", setup.kind.id())),
        CurveError::OtherLight { .. } => Failure::Usage(format!("--theta-i: {error}")),
        error => Failure::Invalid(error.to_string()),
    };
    // Before any curve is calculated.
    subjects.iter().try_for_each(|subject| subject.has(setup.kind)).map_err(failed)?;
    let mut sheet = Sheet { channel: arguments.channel, log: arguments.log, ..Sheet::new(setup) };
    let bar = progress(100 * subjects.len() as u64, options);
    for (i, subject) in subjects.iter().enumerate() {
        let tell = |done: f32, _: &str| bar.set_position(100 * i as u64 + (100.0 * done) as u64);
        let progress = Progress { tell: &tell, cancelled: &|| false };
        if setup.kind.declaration().form == Form::Slices {
            sheet.slices.push(slice(subject, &setup, Detail::Fine, &progress).map_err(failed)?);
        } else {
            sheet.curves.push(curve(subject, &setup, Detail::Fine, &progress).map_err(failed)?);
        }
    }
    bar.finish_and_clear();
    Ok(sheet)
}

/// Writes a file whole or not at all.
fn write(file: &Path, bytes: &[u8]) -> Outcome {
    outputs::tidy_beside(file);
    Output::put(file, |to| to.write_all(bytes)).map_err(|error| outputs::unwritten(file, &error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_taken_apart_at_commas_and_colons() {
        let parts = |word: &str| -> Vec<(String, Vec<String>)> {
            let each = |w: Wanted| (w.id.to_owned(), w.settings.iter().map(|s| (*s).to_owned()).collect());
            wanted(word).into_iter().map(each).collect()
        };
        let one = |id: &str, settings: &[&str]| {
            (id.to_owned(), settings.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>())
        };
        assert_eq!(parts("phong"), [one("phong", &[])]);
        assert_eq!(parts("phong,lambert"), [one("phong", &[]), one("lambert", &[])]);
        assert_eq!(
            parts("phong:alpha=20:k_s=0.3,lambert:base_colour=255,128,0,ward"),
            [
                one("phong", &["alpha=20", "k_s=0.3"]),
                one("lambert", &["base_colour=255,128,0"]),
                one("ward", &[])
            ]
        );
        assert_eq!(parts("a, b"), [one("a", &[]), one("b", &[])]);
        assert_eq!(parts(""), [one("", &[])]);
    }
}
