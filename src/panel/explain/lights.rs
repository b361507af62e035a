//! The equation at a point, light by light: symbolic, with numbers, and the result. One light is unfolded.

use glam::Vec3;

use super::{
    factors, pairs,
    probe::{self, Choice, Level, Unfolded},
    rows::{self, Name},
};
use crate::{
    explain::{
        Brightest, Explanation, Geometry, Line, Lit, Model, Place, Seen, Spot, angle, of_value, shown_lines,
    },
    panel::{
        linked::{self, Domain, linked},
        maths,
        prelude::*,
        segmented::{segment_width, segmented},
    },
    reflection::Term,
};

/// Maximum number of lights in the list.
const MOST: usize = 32;

/// Shows the current point and its lights, the brightest first.
pub(super) fn lights(ui: &mut Ui, explanation: &Explanation, seen: &Seen, name: &dyn Fn(usize) -> String) {
    rows::close(ui);
    let (choice, spots) = (probe::choice(ui.ctx()), probe::spots(seen));
    let Some((shown, spot)) = probe::shown_spot(ui.ctx(), seen) else {
        rows::heading(ui, "Light by light");
        theme::note(ui, "The shading model did not evaluate the reflection model.");
        return;
    };
    if spots.len() > 1 {
        points(ui, seen, &spots, shown, choice);
    } else {
        rows::heading(ui, &format!("Light by light {}", at(seen, spot)));
    }
    place(ui, spot, seen);
    if spot.lights.is_empty() {
        theme::note(ui, "No light is switched on, so there is no light here.");
    }
    let unfolded = probe::shown_light(ui.ctx(), spot).map(|lit| lit.light.index);
    let lights = spot.brightest();
    for lit in lights.iter().take(MOST) {
        let open = unfolded == Some(lit.light.index);
        let name = name(lit.light.index);
        // An unnamed light is labelled with its type.
        let kind = if lit.light.name.is_some() { lit.light.type_name } else { "" };
        let id = Id::new(("light of an explanation", lit.light.index));
        let shown = (lit.contribution, lit.error());
        if rows::fold(ui, id, (&name, kind), open, shown).clicked() {
            let light = if open { Unfolded::None } else { Unfolded::Light(lit.light.index) };
            probe::choose(ui.ctx(), Choice { light, ..choice });
        }
        if open {
            rows::inset(ui, |ui| light(ui, explanation, seen, lit));
        }
    }
    if lights.len() > MOST {
        let rest: Vec3 = lights[MOST..].iter().map(|lit| lit.contribution).sum();
        let count = plural(lights.len() - MOST, "more light");
        rows::light(ui, &format!("{count}, none brighter:"), rest, false);
    }
    if spot.lights.len() > 1 {
        let before = format!("sum over {}", plural(spot.lights.len(), "light"));
        rows::told(ui, &before, spot.sum, spot.error(), true);
    }
    if spot.is_replaced() {
        rows::light(ui, "what is no number counts as 0, and nothing beyond ±10³⁰:", spot.colour, true);
    }
}

/// The choice of the point.
fn points(ui: &mut Ui, seen: &Seen, spots: &[&Spot], shown: usize, choice: Choice) {
    let names = names(ui, spots);
    let names: Vec<_> = names.iter().map(String::as_str).collect();
    let tip = |ui: &mut Ui, i: usize| {
        ui.label(theme::strong(ui, name_of(spots[i], LONGEST)));
        ui.label(if i < seen.spots.len() {
            "A point at which the equation was evaluated"
        } else {
            "What per-pixel shading would give here, which is not what is shown"
        });
    };
    if let Some(i) = segmented(ui, "Point", &names, Some(shown), tip) {
        probe::choose(ui.ctx(), Choice { spot: Some(i), ..choice });
    }
}

/// Levels of abbreviation for the names of points: the longest and the shortest.
const LONGEST: usize = 0;
const SHORTEST: usize = 2;

/// Names of points, as long as the width allows.
fn names(ui: &Ui, spots: &[&Spot]) -> Vec<String> {
    // Leaves room for the frame and the scroll bar.
    let room = ui.available_width() - 8.0;
    let all = |short: usize| spots.iter().map(|spot| name_of(spot, short)).collect::<Vec<_>>();
    let fits = |names: &Vec<String>| names.iter().map(|name| segment_width(ui, name)).sum::<f32>() <= room;
    (LONGEST..SHORTEST).map(all).find(fits).unwrap_or_else(|| all(SHORTEST))
}

fn name_of(spot: &Spot, short: usize) -> String {
    match spot.place {
        Place::Polygon => "polygon".to_owned(),
        Place::Vertex { vertex, weight } => match short {
            LONGEST => format!("vertex {vertex} · {}", rows::short(weight)),
            SHORTEST => vertex.to_string(),
            _ => format!("vertex {vertex}"),
        },
        Place::Pixel => "per pixel".to_owned(),
    }
}

fn at(seen: &Seen, spot: &Spot) -> String {
    match spot.place {
        Place::Polygon => format!("at the centre of polygon {}", seen.polygon),
        Place::Vertex { vertex, .. } => format!("at vertex {vertex}"),
        Place::Pixel => "at this pixel".to_owned(),
    }
}

/// Shows position, normal and observer.
fn place(ui: &mut Ui, spot: &Spot, seen: &Seen) {
    if spot.position != seen.position {
        rows::named_triple(ui, "position", spot.position, " m");
    }
    rows::vectors(ui, &seen.model, &[("N", spot.normal), ("V", spot.view)]);
    if spot.is_mirrored() {
        let text = "The normal faces away from the observer: V is the direction to the observer, mirrored in the surface.";
        theme::note(ui, text);
    }
}

/// Shows one light: the result of the model first, since the user asked for it, then the arriving light, and the
/// directions that both depend on.
fn light(ui: &mut Ui, explanation: &Explanation, seen: &Seen, lit: &Lit) {
    if let Some(remark) = lit.remark_on(&seen.model) {
        theme::note(ui, remark);
    }
    if !lit.is_dark() {
        terms(ui, explanation, seen, lit);
    }
    ui.add_space(4.0);
    theme::note(ui, "light that arrives");
    linked::within(ui, Domain::Light, |ui| match &lit.integral {
        Some(integral) => {
            place_of(ui, lit);
            theme::note(ui, integral.basis());
            samples(ui);
            theme::note(ui, integral.filled());
        }
        None => arriving(ui, lit),
    });
    if let Some(brightest) = lit.integral.and_then(|integral| integral.brightest) {
        most(ui, explanation, seen, &brightest);
    }
    if lit.geometry.is_some() {
        ui.add_space(4.0);
        theme::note(ui, "directions and angles");
        directions(ui, seen, lit.geometry.as_ref());
    }
}

/// The choice of the number of samples.
fn samples(ui: &mut Ui) {
    let choice = probe::choice(ui.ctx());
    let names = probe::SAMPLES.map(|count| count.to_string());
    let tip = |ui: &mut Ui, i: usize| {
        ui.label(match i {
            0 => "As many samples as the picture has".to_owned(),
            _ => {
                let fewer = (probe::SAMPLES[i] / probe::SAMPLES[0]).isqrt();
                format!("Further samples, for this explanation alone: about 1/{fewer} of the standard error, or less")
            }
        });
    };
    let names = names.each_ref().map(String::as_str);
    if let Some(i) = segmented(ui, "Light samples", &names, Some(choice.samples), tip) {
        probe::choose(ui.ctx(), Choice { samples: i, ..choice });
    }
}

/// The direction of a light with extent that contributes most; at the level of factors, with the equation for that
/// direction.
fn most(ui: &mut Ui, explanation: &Explanation, seen: &Seen, brightest: &Brightest) {
    ui.add_space(4.0);
    theme::note(ui, "of the directions that were sampled, the one that gives most");
    directions(ui, seen, Some(&brightest.geometry));
    rows::light(ui, "L(l) =", brightest.luminance, false);
    if probe::choice(ui.ctx()).level == Level::Factors {
        let lines = brightest.lines(&seen.model, rows::DIGITS);
        let lines = shown_lines(&lines, explanation.terms);
        for line in lines.into_iter().filter(|line| line.is_equation()) {
            written(ui, line, &|symbol| meaning(&seen.model, symbol));
        }
    }
}

/// Shows the terms of the equation, symbolic and with numbers, and the light to the observer.
fn terms(ui: &mut Ui, explanation: &Explanation, seen: &Seen, lit: &Lit) {
    let lines = probe::lines(ui.ctx(), lit, &seen.model);
    let name = |symbol: &str| {
        let quantity = lines.iter().find(|line| maths::same_symbol(line.defines(), symbol));
        meaning(&seen.model, symbol).or_else(|| quantity?.quantity.map(|quantity| quantity.label.to_owned()))
    };
    let mut clicked = None;
    let factors = probe::choice(ui.ctx()).level == Level::Factors;
    // The sum of the terms appears in the light to the observer.
    let is_sum = |line: &Line| {
        line.term == Term::Total && line.is_term() && lines.iter().any(|l| l.term != Term::Total)
    };
    for line in shown_lines(&lines, explanation.terms).into_iter().filter(|line| !is_sum(line)) {
        // The second level shows the equation, whose symbols show their values; the third shows everything.
        let factor = !line.is_term() && (line.quantity.is_some() || factors);
        if factor {
            if factors {
                let found = factors::factor(ui, &seen.model, lit.geometry.as_ref(), line, &name);
                clicked = clicked.or(found);
            }
            continue;
        }
        clicked = clicked.or(written(ui, line, &name));
    }
    if let Some(symbol) = clicked {
        origin(ui, &symbol, &lines);
    }
    ui.add_space(2.0);
    theme::note(ui, "light to the observer");
    let sum = lit.sum(explanation.terms);
    match &lit.integral {
        Some(integral) => {
            rows::equation(ui, Term::Total, &sum, true, &name);
            rows::inset(ui, |ui| rows::measured(ui, "=", lit.contribution, integral.error, true));
        }
        None => {
            let mut product = format!("{sum} × {}", rows::formula(lit.arriving));
            if lit.through != Vec3::ZERO {
                theme::note(ui, "the last part comes through the body");
                product.push_str(&format!(" + {}", rows::formula(lit.through)));
            }
            rows::equation(ui, Term::Total, &product, true, &name);
            rows::inset(ui, |ui| drop(rows::light(ui, "=", lit.contribution, true)));
        }
    }
    if !lit.is_finite() {
        theme::note(ui, "Some of these are not finite numbers.");
    }
}

/// The meaning of a symbol: that of the model's parameter, otherwise its general meaning.
pub(super) fn meaning(model: &Model, symbol: &str) -> Option<String> {
    let parameter = model.settings.iter().find(|s| maths::same_symbol(s.parameter.symbol, symbol));
    parameter
        .map(|s| format!("{}: {}", s.parameter.label, s.parameter.help))
        .or_else(|| maths::meaning(symbol).map(str::to_owned))
}

/// A line of the equation: symbolic, with numbers, and the value. Returns the symbol of a clicked number.
pub(super) fn written(ui: &mut Ui, line: &Line, name: Name<'_>) -> Option<String> {
    let bare = !line.text.contains('=');
    let head = if bare { format!("{} =", line.defines()) } else { line.text.clone() };
    if !bare {
        rows::equation(ui, line.term, &head, false, name);
    }
    let clicked = line.right().and_then(|numbers| rows::calculation(ui, numbers, &line.symbols, name));
    if let (Some(value), Some(rgb)) = (&line.value, line.rgb()) {
        rows::inset(ui, |ui| match (line.is_term() || value.is_colour, bare) {
            _ if line.error.is_some() => {
                rows::measured(ui, "=", rgb, line.error.unwrap_or_default(), false);
            }
            (true, true) => drop(rows::light(ui, &head, rgb, false)),
            (true, false) => drop(rows::light(ui, "=", rgb, false)),
            (false, true) => drop(ui.label(format!("{head} {}", of_value(value, rows::DIGITS)))),
            (false, false) => drop(ui.label(format!("= {}", of_value(value, rows::DIGITS)))),
        });
    }
    clicked
}

/// Points to the origin of a number: the row of the quantity, or the control, vector or light of the symbol.
fn origin(ui: &Ui, symbol: &str, lines: &[Line]) {
    let plain = |text: &str| text.replace([' ', '{', '}'], "");
    match lines.iter().find(|line| !line.is_term() && plain(line.defines()) == plain(symbol)) {
        Some(line) => probe::seek(ui.ctx(), line.defines()),
        None => linked::seek(ui.ctx(), &symbol.split('·').collect::<Vec<_>>()),
    }
}

/// Shows the directions to and from the light that the equation uses, and their angles.
fn directions(ui: &mut Ui, seen: &Seen, geometry: Option<&Geometry>) {
    if let Some(geometry) = geometry {
        // Half vector and mirror direction, if the equation uses them.
        let all = [("L", geometry.l), ("H", geometry.h), ("R", geometry.r)];
        let belongs = |letter: &str| pairs::belongs(&seen.model, letter);
        let all: Vec<_> = all.into_iter().filter(|(letter, _)| belongs(letter)).collect();
        rows::vectors(ui, &seen.model, &all);
        let all: &[usize] =
            if seen.model.declaration.anisotropic { &[0, 1, 2, 3, 4, 7, 8] } else { &[0, 1, 2, 3, 4] };
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            let mine = |name: &str| name.split('·').all(belongs);
            for (name, cosine) in all.iter().map(|i| geometry.cosines[*i]).filter(|(name, _)| mine(name)) {
                let text = format!("{name} = {} ({}°)", rows::short(cosine), rows::short(angle(cosine)));
                let ends: Vec<_> = name.split('·').collect();
                let lit = |ctx: &Context| pairs::are_lit(ctx, &seen.model, &ends);
                let symbols = pairs::symbols(&seen.model, &ends);
                linked(ui, &symbols, lit, |ui| ui.add(Label::new(text).extend()))
                    .on_hover_text(rows::all(cosine));
            }
        });
    }
}

/// Distance and position of a light, if it has them.
fn place_of(ui: &mut Ui, lit: &Lit) {
    if let (Some(position), Some(distance)) = (lit.position, lit.distance) {
        let from = format!("{} m, at {} m", rows::short(distance), rows::short_triple(position));
        rows::value(ui, "d", &from, &rows::all(distance));
    }
}

/// Shows the light that arrives at the point.
fn arriving(ui: &mut Ui, lit: &Lit) {
    place_of(ui, lit);
    let equation = lit.arrival();
    let name = |symbol: &str| {
        let factor = lit.factors.iter().find(|f| maths::same_symbol(f.symbol, symbol));
        factor.map(|f| f.meaning.to_owned()).or_else(|| maths::meaning(symbol).map(str::to_owned))
    };
    rows::equation(ui, Term::Total, equation, false, &name);
    for factor in lit.factors.iter().filter(|factor| !factor.from.is_empty()) {
        let givens = format!("{} for {}", factor.meaning, factor.givens(rows::short));
        let givens = rows::unbroken(ui, &givens);
        theme::note(ui, givens);
        let steps = factor.steps(rows::DIGITS);
        for step in &steps {
            let line = format!("{} = {} = {}", step.text, step.numbers, of_value(&step.value, rows::DIGITS));
            rows::equation(ui, Term::Total, &line, true, &name);
        }
        if steps.is_empty() {
            let line = format!("{} = {}", factor.symbol, rows::formula(factor.value));
            rows::equation(ui, Term::Total, &line, true, &name);
        }
    }
    let factors: Vec<_> = lit.factors.iter().map(|factor| rows::short_or_triple(factor.value)).collect();
    let units = lit.factors.iter().filter(|f| !matches!(f.unit, "" | "×")).map(|f| f.unit);
    let units = units.collect::<Vec<_>>().join(" · ");
    let numbers = match factors.len() {
        0 | 1 => format!("= {}", rows::short_or_triple(lit.intensity)),
        _ => format!("= {} = {}", factors.join(" × "), rows::short_or_triple(lit.intensity)),
    };
    rows::inset(ui, |ui| {
        rows::named(ui, "", &numbers, &format!("{} {units}", rows::spoken(lit.intensity)));
    });
    if lit.colour != Vec3::ONE && lit.intensity != Vec3::ZERO {
        rows::light(ui, "times the colour of the light", lit.colour, false);
        rows::inset(ui, |ui| drop(rows::light(ui, "=", lit.arriving, false)));
    }
}
