//! The properties of a light.

use super::part::{header, knob_of, section, type_knob, vector};
use crate::{
    light::{Declaration, LightEntry},
    optics::temperature,
    panel::{
        knob::{self, Amount, Caption},
        linked::{self, Domain},
        maths,
        prelude::*,
        segmented::{segment_width, segmented},
        state::{Effect, Pick},
    },
    parameter::Value,
    reflection::{EquationPart, Term, usage::unused},
    scene::{Key, Light, limits},
};

pub(super) fn light(ui: &mut Ui, i: usize, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let Some(light) = session.document.lights.get(i) else { return };
    let part = Part::Light(i);
    header(ui, Selection::Light(i), light.name.as_deref(), context);
    section(ui, "Light", true, |ui| {
        linked::within(ui, Domain::Light, |ui| {
            let types = registry.lights().iter().map(|l| l.declaration);
            let types = types.map(|d| [d.id, d.name, d.summary]);
            if let Some(id) = type_knob(ui, types, &light.light_type, None) {
                context.edit(Edit::set(part, Light::light_type, id.to_owned()));
            }
            let Some(entry) = registry.light(&light.light_type) else {
                ui.label("This light type is unknown; choose another one.");
                return;
            };
            equation(ui, entry);
            context.edits(brightness(ui, part, light, entry));
            context.edits(light_colour(ui, part, light));
            for p in entry.parameters {
                if let Value::File(file) = light.parameters.get(p)
                    && knob::file_knob(
                        ui,
                        p,
                        &file,
                        unused(entry.parameters, p, &light.parameters).as_deref(),
                    )
                {
                    context.act(Action::Do(Effect::Pick(Pick::File(
                        Selection::Light(i),
                        Key::Own(p.name),
                        p,
                    ))));
                }
                if let Some(v) = knob_of(ui, p.name, p, (entry.parameters, &light.parameters), None) {
                    let values = light.setting(entry, p, v);
                    context.edit(Edit::Set { part, values, what: None });
                }
            }
        })
    });
    if light.position.is_some() || light.direction.is_some() {
        section(ui, "Position", true, |ui| {
            let room = session.document.scene_size;
            for (field, value) in [(Light::position, light.position), (Light::direction, light.direction)] {
                context.edits(value.and_then(|value| vector(ui, part, field, value, room)));
            }
        });
    }
}

/// The summary of a type of light, and the equation of what it sends.
fn equation(ui: &mut Ui, entry: &LightEntry) {
    let d = entry.declaration;
    if !d.summary.is_empty() {
        theme::note(ui, d.summary);
    }
    maths::equation(ui, &[EquationPart::new(Term::Total, d.equation)], |symbol| match symbol {
        letter if letter == d.symbol() => Some(strength(d).to_owned()),
        "L_s" => Some("the luminance of its source, cd/m²".to_owned()),
        other => {
            let own = entry.parameters.iter().find(|p| maths::same_symbol(p.symbol, other));
            own.map(|p| p.label).or_else(|| maths::meaning(other)).map(str::to_owned)
        }
    });
}

/// The meaning of the letter of a light's intensity in its equations.
fn strength(d: &Declaration) -> &'static str {
    match d.unit {
        "cd/m²" => "the luminance of the light, the same from each of its points",
        "cd" => "the intensity of the light: what it sends into each direction",
        _ => "the intensity of the light",
    }
}

/// The brightness of a light: its intensity, or, for types that have one, its luminous flux.
fn brightness(ui: &mut Ui, part: Part, light: &Light, entry: &LightEntry) -> Option<Edit> {
    let d = entry.declaration;
    let intensity = f64::from(light.intensity_as(entry));
    let unit = entry.unit(&light.parameters);
    let help = unit_help(unit);
    let caption = Caption { symbol: d.symbol(), unit, help, ..Caption::of(&Light::intensity) };
    let default = f64::from(d.default_intensity);
    let limits = limits::intensity(d);
    let Some(solid_angle) = entry.solid_angle(&light.parameters) else {
        let new = knob::number_knob(ui, &caption, Amount::new(intensity, Some(default), &limits));
        return new.map(|v| Edit::set(part, Light::intensity, v as f32));
    };
    // Rounded where it is converted, to what can be told apart.
    let flux = light.luminous_flux.map_or_else(|| limits::significant(intensity * solid_angle, 6), f64::from);
    let as_flux = light.luminous_flux.is_some();
    let word = conversion(ui, d, as_flux, [solid_angle, intensity, flux]);
    let mut other_unit = None;
    let units = [[d.unit, word], ["lm", "lumen"]];
    let beside = |ui: &mut Ui| other_unit = knob::unit_choice(ui, usize::from(as_flux), &units);
    let (field, caption, value, default, limits) = if as_flux {
        let help = unit_help("lm");
        let caption = Caption { salt: "flux", symbol: "Φ", help, ..Caption::of(&Light::luminous_flux) };
        let default = limits::significant(default * solid_angle, 3);
        (Light::luminous_flux, caption, flux, default, limits::luminous_flux(d))
    } else {
        (Light::intensity, caption, intensity, default, limits)
    };
    let amount = Amount::new(value, Some(default), &limits);
    let out =
        knob::number_knob_beside(ui, &caption, amount, beside).map(|v| Edit::set(part, field, v as f32));
    match other_unit {
        Some(0) => Some(Edit::set(part, Light::intensity, limits::significant(intensity, 6) as f32)),
        Some(_) => Some(Edit::set(part, Light::luminous_flux, flux as f32)),
        None => out,
    }
}

/// How the other unit of a brightness follows, as high in both units, so that nothing below moves with the choice.
/// Returns the name of the unit of the intensity.
fn conversion(ui: &mut Ui, d: &Declaration, as_flux: bool, numbers: [f64; 3]) -> &'static str {
    let [solid_angle, intensity, flux] = numbers.map(|v| limits::number(limits::significant(v, 4)));
    let symbol = d.symbol();
    // A factor multiplies lumens, candelas spread over steradians, and a luminance over an area too.
    let (of, unit, word) = match d.unit {
        "cd" => ("sr", " cd", "candela"),
        "cd/m²" => ("sr m²", " cd/m²", "candela per square metre"),
        _ => ("lm", "", "factor"),
    };
    let lines = [
        format!("Φ = {symbol} · {solid_angle} {of} = {flux} lm"),
        format!("{symbol} = Φ / ({solid_angle} {of}) = {intensity}{unit}"),
    ];
    let (sizes, width) = (maths::Sizes::default(), ui.available_width());
    let heights = lines
        .each_ref()
        .map(|line| maths::measured(ui, &[(Term::Total, line.as_str())], sizes, width).height);
    let shown = usize::from(as_flux);
    maths::equation_of(ui, &[(Term::Total, lines[shown].as_str())], sizes, |letter| match letter {
        letter if letter == symbol => Some(strength(d).to_owned()),
        "Φ" => Some("the luminous flux: what it sends out in all directions together".to_owned()),
        _ => None,
    });
    ui.add_space((heights[1 - shown] - heights[shown]).max(0.0));
    word
}

/// The points that the colour of a temperature takes, with the room of a unit.
const SAMPLE: f32 = 44.0 + 22.0;

/// The colour of a light: sRGB, or the temperature of a black body.
fn light_colour(ui: &mut Ui, part: Part, light: &Light) -> Option<Edit> {
    let mut out = None;
    ui.horizontal(|ui| {
        ui.set_min_height(30.0);
        // Beside the choice, the colour of a temperature has its place.
        let choices = ["RGB", "temperature"];
        let buttons: f32 = choices.iter().map(|choice| segment_width(ui, choice)).sum();
        let room = ui.available_width() - buttons - SAMPLE - 2.0 * ui.spacing().item_spacing.x;
        let word = ["Colour from", "Colour"].into_iter().find(|word| theme::small_width(ui, word) < room);
        word.map(|word| ui.label(theme::small(ui, word)));
        let chosen = usize::from(light.colour_temperature.is_some());
        let tip = |ui: &mut Ui, i: usize| {
            ui.label(if i == 0 {
                "Red, green and blue, as on a display. Like a filter, a colour takes away from white light: a light with a \
                 temperature keeps the colour that it shows and becomes darker."
            } else {
                "The temperature of a black body that glows in this colour. It is as bright as white light."
            });
        };
        out = segmented(ui, "Colour by", &choices, Some(chosen), tip).map(|i| match i {
            0 => Edit::set(part, Light::colour, light.rgb8()),
            _ => {
                let nearest = temperature::nearest_temperature(light.colour);
                Edit::set(part, Light::colour_temperature, nearest)
            }
        });
        if light.colour_temperature.is_some() {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add_space(22.0);
                knob::colour_sample(ui, light.rgb8());
            });
        }
    });
    let field = match light.colour_temperature {
        Some(kelvin) => {
            let help = "The colour of a black body of this temperature: a candle has 1900 K, a light bulb 2700 K, the \
                        midday sun about 5500 K, a blue sky 10 000 K and more; 6500 K is white. The luminance stays \
                        that of a white light of this intensity.";
            let caption = Caption::of(&Light::colour_temperature);
            let caption = Caption { salt: "temperature", symbol: "T", help, ..caption };
            let default = Some(f64::from(temperature::WHITE_TEMPERATURE));
            let limits = Light::colour_temperature.limits();
            knob::number_knob(ui, &caption, Amount::new(kelvin.into(), default, &limits))
                .map(|v| Edit::set(part, Light::colour_temperature, v as f32))
        }
        None => {
            let help = "The colour of the light; white leaves the materials as they are. Other colours are a filter: blue \
                        alone has 7 % of the luminance of white.";
            let caption = Caption { help, ..Caption::of(&Light::colour) };
            knob::colour_knob(ui, &caption, light.colour, Some([255; 3]))
                .map(|rgb| Edit::set(part, Light::colour, rgb))
        }
    };
    out.or(field)
}

fn unit_help(unit: &str) -> &'static str {
    match unit {
        "cd" => "In candela: the light sent into each direction. At 1 m, 1 cd gives an illuminance of 1 lx.",
        "cd/m²" => {
            "In candela per square metre: the luminance, as bright as it looks from wherever it is seen."
        }
        "lm" => "In lumen: the light sent out in all directions together, as printed on light bulbs.",
        "×" => "A factor: 1 is the light as it is, 0.5 the light dimmed to half.",
        "lx" => "In lux: the light that arrives on a surface that faces it.",
        _ => "How strong the light is.",
    }
}
