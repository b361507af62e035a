//! `lcm match`: the parameters of a view that come closest to view A.

use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

use clap::{
    Args,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
    value_parser,
};
use serde_json::{Value as Json, json};

use super::{
    Options, Outcome, gauged_until, outputs, print_json, print_text,
    scenes::Source,
    views::find,
    workshop::{Workshop, drawable},
};
use crate::files::Shown as _;
use crate::{
    export::write::inputs,
    failure::Failure,
    matching::{
        self, Ended, Match, MatchError, Measure, Metric, Request, What, digits,
        each::{Matched, Ranking, candidates, match_each},
        match_view, rounded,
    },
    parameter::Value,
    registry::Registry,
    scene::{
        Scene,
        save::{self, Expected, SaveError, Unwritten},
        variant::LETTERS,
    },
    signals::Interrupt,
    text::{listed, plural},
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file with variants; `-` is standard input
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Match every model for opaque surfaces to view A, with all its numbers, colours and choices free, and list them, the nearest first
    #[arg(long, conflicts_with_all = ["view", "free", "output"])]
    each: bool,
    /// The view whose parameters are searched: its letter, or its name
    #[arg(long, default_value = "B", value_name = "LETTER|NAME")]
    view: String,
    /// What is compared with view A
    #[arg(long, value_parser = what(), default_value = What::Lobe.id())]
    on: What,
    /// The metric of the lobes: what the difference is taken of
    #[arg(long, value_parser = metric(), default_value = Metric::default().id())]
    metric: Metric,
    /// The parameters that are free, such as alpha,k_s; by default every number, and beside a measurement every colour too. The fewer, the quicker and the surer
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    free: Vec<String>,
    /// End after so many seconds with the nearest found until then, as Ctrl+C does: 1 to 600; by default 600, with --each those that all models take.
    /// Few searches take as long: each also ends by itself, or at its number of comparisons
    #[arg(long, value_name = "N", value_parser = value_parser!(u64).range(1..=600))]
    seconds: Option<u64>,
    /// Write the scene with these parameters to this file, another one than the scene's
    #[arg(long, short, value_name = "FILE", value_parser = outputs::place())]
    output: Option<PathBuf>,
    /// Replace an existing file
    #[arg(long, requires = "output")]
    overwrite: bool,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Parser of what is compared, with help for each choice.
fn what() -> impl TypedValueParser<Value = What> {
    let help = [
        "The light reflected by the models, for all directions of light and viewer",
        "The pictures of this scene, in linear light",
        "The width of the highlights",
    ];
    let choices =
        What::ALL.into_iter().zip(help).map(|(what, help)| PossibleValue::new(what.id()).help(help));
    PossibleValuesParser::new(choices).map(|id| What::from_id(&id).unwrap_or_default())
}

/// Parser of the metric, with the source of each.
fn metric() -> impl TypedValueParser<Value = Metric> {
    let choices = Metric::ALL.into_iter().map(|metric| {
        let help = format!("{} {}", metric.summary(), metric.source().replace('*', ""));
        PossibleValue::new(metric.id()).help(help)
    });
    PossibleValuesParser::new(choices).map(|id| Metric::from_id(&id).unwrap_or_default())
}

impl Arguments {
    /// What is compared; lobes alone have a choice of metrics.
    fn measure(&self) -> Result<Measure, Failure> {
        let measure = Measure { what: self.on, metric: self.metric };
        if measure.metric().is_none() && self.metric != Metric::default() {
            return Err(Failure::Usage(format!(
                "--metric {} is for lobes, but --on is {}",
                self.metric.id(),
                self.on.id()
            )));
        }
        Ok(measure)
    }
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    let measure = arguments.measure()?;
    let source = Source::named(&arguments.scene);
    let mut scene = source.open(workshop, options)?;
    let expected = if arguments.overwrite { Expected::Anything } else { Expected::Nothing };
    // Better detected now than after the search.
    if let Some(file) = &arguments.output {
        outputs::spare(file, &inputs(source.path(), [&scene], &workshop.registry))?;
    }
    arguments.output.as_deref().map_or(Ok(()), outputs::can_begin)?;
    let registry = &workshop.registry;
    if let Some(file) = &arguments.output {
        save::can_write(file, &scene, registry, expected).map_err(|error| unwritten(&error))?;
    }
    drawable(registry, &scene)?;
    let invalid = |why: &dyn std::fmt::Display| Failure::Invalid(format!("{}: {why}", source.name()));
    if arguments.each {
        return each(&scene, (measure, arguments), options, registry);
    }
    let view = view(&scene, &arguments.view, invalid)?;
    let free: Vec<&str> = match arguments.free.as_slice() {
        [] => {
            let all = matching::parameters(&scene, view, registry).into_iter();
            all.filter(|(_, usual)| *usual).map(|(parameter, _)| parameter.name).collect()
        }
        names => names.iter().map(|name| name.trim()).collect(),
    };
    let request = Request { scene: &scene, view, measure, parameters: &free };
    let end = End::new(arguments.seconds);
    let found = gauged_until("matching", options, &|| end.is_due(), |progress| {
        match_view(&request, registry, progress)
    });
    if found == Err(MatchError::Cancelled) {
        end.interrupt.end_if_asked();
    }
    let mut found = found.map_err(|error| match error {
        MatchError::NothingFree { known } if arguments.free.is_empty() && !known.is_empty() => {
            Failure::Usage(format!(
                "no parameter of view {} is free by default; name some with --free: {}",
                LETTERS[view],
                listed(&known, "and")
            ))
        }
        MatchError::NothingFree { .. } if arguments.free.is_empty() => invalid(&error),
        MatchError::NothingFree { .. }
        | MatchError::NoParameter { .. }
        | MatchError::NoNumber { .. }
        | MatchError::Unused { .. } => Failure::Usage(format!("--free: {error}")),
        MatchError::Cancelled => {
            invalid(&"the views could not be compared even once in time; more --seconds may be enough")
        }
        error => invalid(&error),
    })?;
    if found.ended == Ended::Interrupted && !end.interrupt.is_asked() {
        found.ended = Ended::Time;
    }
    let before: Vec<Value> = found.values.iter().map(|(name, _)| now(&scene, view, name, registry)).collect();
    if arguments.json {
        print_json(&as_json(&found, view, measure))?;
    } else {
        print_text(&in_words(&found, &before, view, measure))?;
    }
    if let Some(file) = &arguments.output {
        for (name, value) in &found.values {
            scene.variants[view - 1].material.set(*name, value.clone());
        }
        save::write(file, &scene, registry, expected).map_err(|error| unwritten(&error))?;
        options.tell(format_args!("wrote {}", file.shown()));
    }
    end.interrupt.end_if_asked();
    Ok(())
}

/// What ends a search with what it has: Ctrl+C, or the time that it was given.
struct End {
    interrupt: Interrupt,
    begun: Instant,
    longest: Option<Duration>,
}

impl End {
    fn new(seconds: Option<u64>) -> Self {
        Self {
            // Without it, Ctrl+C ends the program at once.
            interrupt: Interrupt::listen(|| (), |_| ()).unwrap_or_default(),
            begun: Instant::now(),
            longest: seconds.map(Duration::from_secs),
        }
    }

    fn is_due(&self) -> bool {
        self.interrupt.is_asked() || self.longest.is_some_and(|longest| self.begun.elapsed() >= longest)
    }
}

/// `lcm match --each`. Ctrl+C and the end of its time end it with what was matched until then.
fn each(
    scene: &Scene,
    (measure, arguments): (Measure, &Arguments),
    options: Options,
    registry: &Registry,
) -> Outcome {
    let end = End::new(arguments.seconds);
    let ranking = gauged_until("matching", options, &|| end.is_due(), |progress| {
        match_each(scene, candidates(registry), measure, registry, progress)
    });
    if arguments.json {
        print_json(&ranking_as_json(&ranking, measure))?;
    } else {
        print_text(&ranking_in_words(&ranking, measure))?;
    }
    end.interrupt.end_if_asked();
    if ranking.matched.is_empty() {
        return Err(Failure::Invalid("no model could be matched to view A".to_owned()));
    }
    Ok(())
}

fn ranking_in_words(ranking: &Ranking, measure: Measure) -> String {
    let mut text = format!("{}\n", measure.unit());
    let widest = ranking.matched.iter().map(|matched| matched.model.len()).max().unwrap_or_default();
    for Matched { model, found } in &ranking.matched {
        let values: Vec<_> =
            found.values.iter().map(|(name, value)| format!("{name}={}", rounded(value))).collect();
        text += &format!("{:>8}  {model:widest$}  {}", digits(found.after), values.join(" "));
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    for (model, why) in &ranking.left_out {
        text += &format!("{model}: {why}\n");
    }
    if !ranking.unfinished.is_empty() {
        text += &format!("interrupted before {}\n", listed(&ranking.unfinished, "and"));
    }
    text
}

fn ranking_as_json(ranking: &Ranking, measure: Measure) -> Json {
    let matched = |Matched { model, found }: &Matched| {
        let values: serde_json::Map<_, _> =
            found.values.iter().map(|(name, v)| ((*name).to_owned(), v.json())).collect();
        json!({ "model": model, "before": found.before, "after": found.after, "values": values })
    };
    let left_out = |(model, why): &(&str, MatchError)| json!({ "model": model, "why": why.to_string() });
    json!({
        "on": measure.what.id(),
        "metric": measure.metric().map(Metric::id),
        "unit": measure.unit(),
        "models": ranking.matched.iter().map(matched).collect::<Vec<_>>(),
        "left_out": ranking.left_out.iter().map(left_out).collect::<Vec<_>>(),
        "unfinished": ranking.unfinished,
    })
}

fn unwritten(error: &SaveError) -> Failure {
    let advice = match error.why {
        Unwritten::Exists => "; --overwrite replaces it",
        _ => "",
    };
    Failure::Write(format!("{error}{advice}"))
}

/// The view with a letter or a name, other than A.
fn view(
    scene: &Scene,
    wanted: &str,
    invalid: impl Fn(&dyn std::fmt::Display) -> Failure,
) -> Result<usize, Failure> {
    if scene.variants.is_empty() {
        return Err(invalid(&"the scene has no variants, so there is no view to match to view A"));
    }
    match find(scene, wanted) {
        Ok(0) => {
            Err(Failure::Usage("--view is A, but it must be another view, to be matched to A".to_owned()))
        }
        found => found.map_err(|why| invalid(&format!("--view: {why}"))),
    }
}

/// The present value of a parameter in a view: that of the first visible object.
fn now(scene: &Scene, view: usize, name: &str, registry: &Registry) -> Value {
    let seen = scene.seen(view, registry).map(|(seen, _)| seen).unwrap_or_default();
    let value = seen.shown().find_map(|object| {
        let parameter = registry.model(seen.model_of(object))?.parameter(name)?;
        Some(object.material.get(parameter))
    });
    value.unwrap_or(Value::Number(0.0))
}

fn in_words(found: &Match, before: &[Value], view: usize, measure: Measure) -> String {
    let letter = LETTERS[view];
    if found.values.is_empty() {
        let (unit, before) = (measure.unit(), digits(found.before));
        let none = match found.ended {
            Ended::Itself => "no other values come nearer",
            _ => "until then no other values came nearer",
        };
        let stays = format!("view {letter} stays as it is: {none} to view A");
        return format!("{stays}\n{unit}: {before}\n{}", about_the_search(found));
    }
    let mut text = format!("view {letter} matched to view A on the {measure}\n");
    let mut kept = found.kept.clone();
    for ((name, value), before) in found.values.iter().zip(before) {
        if matching::nearly_equal(before, value) {
            kept.push(*name);
            continue;
        }
        let mut shown = [before, value].map(rounded);
        if shown[0] == shown[1] {
            shown = [before.clone(), value.clone()];
        }
        text += &format!("{name}: {} → {}\n", shown[0], shown[1]);
    }
    if !kept.is_empty() {
        text += &format!("unchanged: {}\n", listed(&kept, "and"));
    }
    text += &format!("{}: {} → {}\n", measure.unit(), digits(found.before), digits(found.after));
    text + &about_the_search(found)
}

/// The parameters without effect, the number of evaluations, and what ended the search.
fn about_the_search(found: &Match) -> String {
    let mut text = found.ambiguity(|name| name).map_or_else(String::new, |note| note + "\n");
    if !found.without_effect.is_empty() {
        text += &format!("without effect in all that was tried: {}\n", listed(&found.without_effect, "and"));
    }
    text += &format!("compared {}\n", plural(found.evaluations, "time"));
    if let Some(note) = found.ended.note() {
        text += &format!("{note}\n");
    }
    text
}

fn as_json(found: &Match, view: usize, measure: Measure) -> Json {
    let values: serde_json::Map<_, _> =
        found.values.iter().map(|(name, v)| ((*name).to_owned(), v.json())).collect();
    json!({
        "view": LETTERS[view],
        "on": measure.what.id(),
        "metric": measure.metric().map(Metric::id),
        "unit": measure.unit(),
        "before": found.before,
        "after": found.after,
        "values": values,
        "unchanged": found.kept,
        "without_effect": found.without_effect,
        "ambiguous": found.ambiguous,
        "evaluations": found.evaluations,
        "ended": found.ended.id(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_differ_by_rounding_are_unchanged() {
        let number = Value::Number;
        let values = [("roughness", 0.299_991_67), ("metallic", 0.999_95), ("k_s", 0.583_21)];
        let values = values.map(|(name, value)| (name, number(value))).to_vec();
        let found = Match { values, kept: vec!["k_d"], before: 0.5, after: 0.1, ..Match::default() };
        let said = in_words(&found, &[0.3, 1.0, 0.6].map(number), 1, Measure::default());
        assert!(said.contains("\nk_s: 0.6 → 0.583\nunchanged: k_d, roughness and metallic\n"), "{said}");
        let json = as_json(&found, 1, Measure::default());
        assert_eq!(json["values"]["roughness"], number(0.299_991_67).json(), "with all its digits");
    }

    #[test]
    fn values_that_three_digits_do_not_tell_apart_are_shown_in_full() {
        let values = vec![("ior", Value::Number(1.504)), ("extinction", Value::Triple([3.0, 2.0, 1.0011]))];
        let found = Match { values, before: 0.5, after: 0.1, ..Match::default() };
        let before = [Value::Number(1.5), Value::Triple([3.0, 2.0, 1.001])];
        let said = in_words(&found, &before, 1, Measure::default());
        assert!(
            said.contains("\nior: 1.5 → 1.504\n") && said.contains("\nunchanged: extinction\n"),
            "{said}"
        );
    }
}
