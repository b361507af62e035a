//! The explanation of a point's colour on the page: a sentence, and the equation with its numbers, light by
//! light.

use glam::Vec3;
use serde_json::{Map, Value as Json, json};

use super::{
    equation::{equation, escaped},
    packed,
};
use crate::{
    document::{Document, Selection},
    explain::{self, Explanation, Line, Lit, Place, Seen, Spot, of_value, told, triple, triple_within},
    export::{ExportError, Request},
    optics::{TermSelection, colour::srgb_encode8},
    reference::{Settings, ignored_edits},
    scene::observer::line_of_sight,
    text::{listed, plural},
};

/// Maximum number of lights listed; the others are summed up.
const MOST: usize = 8;
/// Digits of values; equations have as many as needed.
const DIGITS: usize = 3;
/// Digits of the values under the pointer: as many as the command prints.
const ALL: usize = 4;

/// The additional parts of a page with an explained point.
#[derive(Debug, Default)]
pub struct Parts {
    /// HTML of the section in the panel.
    pub section: &'static str,
    /// The style sheet of the section.
    pub style: &'static str,
    /// The script of the section.
    pub script: &'static str,
    /// The element with the texts.
    pub data: String,
}

/// The additional parts; all empty without a point.
///
/// # Errors
/// Returns an error if the texts cannot be compressed.
pub fn parts(points: &Map<String, Json>) -> Result<Parts, ExportError> {
    if points.is_empty() {
        return Ok(Parts::default());
    }
    let data = packed(Json::Object(points.clone()).to_string().as_bytes())?;
    Ok(Parts {
        section: include_str!("explained.html"),
        style: include_str!("explained.css"),
        script: include_str!("js/explained.js"),
        data: format!("\n<script type=\"application/octet-stream\" id=\"explained-data\">{data}</script>"),
    })
}

/// The explanation of a pixel's colour: its position, as tangents of the angles to the right of and above the
/// viewing direction, and the text; and the reason why this does not explain the picture, if any.
///
/// # Errors
/// Returns an error if the pixel is not in the picture.
pub fn point(request: &Request, pixel: [u32; 2]) -> Result<(Json, Option<String>), ExportError> {
    let Request { scene, registry, size: (width, height), .. } = *request;
    // The page shows all terms.
    let settings = Settings { width, height, samples: 1, terms: TermSelection::All };
    let explanation = explain::pixel(scene, registry, &settings, pixel)
        .map_err(|error| ExportError::refused(error.to_string()))?;
    let at = line_of_sight(pixel, [width, height], scene.observer.field_of_view.to_radians());
    let document = Document::new(scene.clone());
    let name = |part: Selection| document.name_of(part, registry);
    let doubt = doubt(request, &explanation);
    let html = text(&explanation, &name, doubt.as_deref());
    Ok((json!({ "at": at, "html": html }), doubt))
}

/// The reason why an explanation does not match the picture, if any.
fn doubt(request: &Request, explanation: &Explanation) -> Option<String> {
    let trouble = explanation.seen.as_ref().and_then(|seen| seen.model.trouble.as_ref());
    let ignored: Vec<_> = ignored_edits(request.registry, request.scene).into_iter().collect();
    let why = match trouble {
        Some(trouble) => format!(", since the CPU cannot run this model: {trouble}"),
        None if ignored.is_empty() => return None,
        None => {
            let ignored = listed(&ignored, "and");
            format!(": explanations follow the CPU renderer, which ignores the edited {ignored}")
        }
    };
    Some(format!("The explanation is not that of the picture{why}"))
}

/// A paragraph of plain text.
fn paragraph(class: &str, text: &str) -> String {
    format!("<p class=\"{class}\">{}</p>", escaped(text))
}

/// A paragraph that ends with a colour.
fn ending(class: &str, text: &str, light: Vec3, error: Option<Vec3>) -> String {
    format!("<p class=\"{class}\"><span>{}</span> {}</p>", escaped(text), estimate(light, error))
}

/// Mathematics in which no line breaks within the three numbers of a colour, unless they are longer than a
/// line.
fn numbers(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((triple, end)) = triple_in(rest) {
        // The sign of a product or a sum moves to the new line.
        let sign = ["× ", "+ ", "− "].into_iter().find(|sign| rest[..triple].ends_with(sign));
        let at = triple - sign.map_or(0, str::len);
        out += &equation(&rest[..at]);
        out += &format!("<span class=\"triple\">{}</span>", equation(&rest[at..end]));
        rest = &rest[end..];
    }
    out + &equation(rest)
}

/// The range of the first three numbers in brackets that have no subscript or power.
fn triple_in(text: &str) -> Option<(usize, usize)> {
    let mut begin = None;
    for (i, c) in text.char_indices() {
        match c {
            '(' => begin = Some(i),
            ')' => {
                let end = i + c.len_utf8();
                let three = begin.is_some_and(|begin| text[begin..end].matches(", ").count() == 2);
                let alone = !text[end..].starts_with(['^', '_']);
                if let Some(begin) = begin.take().filter(|_| three && alone) {
                    return Some((begin, end));
                }
            }
            c if c.is_ascii_digit() || ".,−·^∞NaN ".contains(c) => {}
            _ => begin = None,
        }
    }
    None
}

/// A sample of a colour as the display shows these codes.
fn chip([r, g, b]: [u8; 3]) -> String {
    format!("<span class=\"chip\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span>")
}

/// A sample of linear light, clamped to the display's range, with its numbers; crossed out if not finite.
fn colour(light: Vec3) -> String {
    estimate(light, None)
}

/// A sample of linear light, with the digits that its standard error, if any, allows.
fn estimate(light: Vec3, error: Option<Vec3>) -> String {
    let chip = if light.is_finite() {
        chip(light.clamp(Vec3::ZERO, Vec3::ONE).to_array().map(srgb_encode8))
    } else {
        "<span class=\"chip none\"></span>".to_owned()
    };
    let shown = triple_within(light, error, DIGITS);
    let all = told(light, error, ALL);
    format!("<span class=\"colour\" title=\"{}\">{chip}{}</span>", escaped(&all), equation(&shown))
}

fn text(explanation: &Explanation, name: &dyn Fn(Selection) -> String, doubt: Option<&str>) -> String {
    let sentence = explain::sentence(explanation, "This pixel is", &|light| name(Selection::Light(light)));
    let mut out = format!("<p class=\"said\">{}{}</p>", chip(explanation.code()), escaped(&sentence));
    if let Some(doubt) = doubt {
        out += &paragraph("summary", &format!("{doubt}."));
    }
    let Explanation { pixel: [x, y], size: [width, height], .. } = explanation;
    let at = format!("Pixel {x}, {y} of {width}×{height}");
    match &explanation.seen {
        Some(seen) => {
            let object = name(Selection::Object(seen.object.index));
            let (model, shading) = (seen.model.declaration.name, seen.shading.name);
            let models = format!("reflection model {model}, shading model {shading}");
            out += &paragraph("summary", &format!("{at}: {object}, {models}."));
            if let Some(spot) = seen.main_spot().map(|i| &seen.spots[i]) {
                lights(&mut out, seen, spot, &|light| name(Selection::Light(light)));
            }
        }
        None if explanation.lamp.is_some() => out += &paragraph("summary", &format!("{at}: a light.")),
        None => out += &paragraph("summary", &format!("{at}: background.")),
    }
    out
}

/// Writes the lights at a point, the brightest first.
fn lights(out: &mut String, seen: &Seen, spot: &Spot, name: &dyn Fn(usize) -> String) {
    match spot.place {
        Place::Pixel => {}
        Place::Polygon => {
            *out += &paragraph("summary", "The equation is evaluated once for the polygon, at its centre.");
        }
        Place::Vertex { vertex, weight } => {
            let weight = explain::rounded(weight, DIGITS);
            let said = format!(
                "The equation is evaluated at the vertices, and their colours are mixed. These are the numbers of \
                 vertex {vertex}, which counts most here, with the weight {weight}."
            );
            *out += &paragraph("summary", &said);
        }
    }
    if spot.is_mirrored() {
        let said = "The normal faces away from the observer, so V is mirrored in the surface.";
        *out += &paragraph("summary", said);
    }
    let all = spot.brightest();
    for (i, lit) in all.iter().take(MOST).enumerate() {
        let open = if i == 0 { " open" } else { "" };
        let (name, sum) = (escaped(&name(lit.light.index)), estimate(lit.contribution, lit.error()));
        *out += &format!("<details{open}><summary><b>{name}</b>{sum}</summary><div class=\"equation\">");
        light(out, seen, lit);
        *out += "</div></details>";
    }
    if all.len() > MOST {
        let rest: Vec3 = all[MOST..].iter().map(|lit| lit.contribution).sum();
        let count = plural(all.len() - MOST, "more light");
        *out += &ending("rest", &format!("{count}, none brighter:"), rest, spot.error());
    }
    if all.len() > 1 {
        *out += &ending("rest", &format!("Sum over {}:", plural(all.len(), "light")), spot.sum, spot.error());
    }
    if spot.is_replaced() {
        let rule = "What is no number counts as 0, and nothing beyond ±10³⁰:";
        *out += &ending("rest", rule, spot.colour, spot.error());
    }
    if matches!(spot.place, Place::Vertex { .. }) {
        *out += &ending("rest", "Mixed from the vertices:", seen.light, seen.error());
    }
}

/// Writes the equation for one light: as written, with numbers, and its value; then the light to the
/// observer.
fn light(out: &mut String, seen: &Seen, lit: &Lit) {
    if let Some(remark) = lit.remark() {
        *out += &paragraph("summary", remark);
    }
    if lit.is_dark() {
        return;
    }
    for line in lit.lines(&seen.model).iter().filter(|line| line.is_equation()) {
        *out += &worked(line);
    }
    if let Some(integral) = &lit.integral {
        *out += &paragraph("summary", &integral.basis());
        *out += &paragraph("summary", &format!("Light to the observer: {}", lit.outcome(DIGITS)));
        return;
    }
    let sum = numbers(&format!("{} × {}", lit.sum(TermSelection::All), triple(lit.arriving)));
    *out += &paragraph("summary", "Light to the observer:");
    *out +=
        &format!("<div class=\"part\">{sum}</div><div class=\"put\">= {}</div>", colour(lit.contribution));
    if !lit.is_finite() {
        *out += &paragraph("summary", "Some of these are not finite numbers.");
    }
}

/// A line of the equation: as written, with numbers, and its value.
fn worked(line: &Line) -> String {
    let mut out = String::new();
    let class = line.term.id();
    let written = line.text.contains('=');
    let head = if written { line.text.clone() } else { format!("{} =", line.defines()) };
    let value = line.value.as_ref().map(|value| match line.rgb() {
        Some(_) if line.error.is_some() => numbers(&line.outcome(DIGITS).unwrap_or_default()),
        Some(light) if value.is_colour => colour(light),
        _ => {
            let (shown, all) = (of_value(value, DIGITS), of_value(value, 2 * DIGITS));
            format!("<span title=\"{}\">{}</span>", escaped(&all), equation(&shown))
        }
    });
    match value.as_ref().filter(|_| !written) {
        Some(value) => out += &format!("<div class=\"part {class}\">{} {value}</div>", equation(&head)),
        None => out += &format!("<div class=\"part {class}\">{}</div>", equation(&head)),
    }
    if let Some(right) = line.right() {
        out += &format!("<div class=\"put\">= {}</div>", numbers(right));
    }
    if let Some(value) = value.filter(|_| written) {
        out += &format!("<div class=\"put\">= {value}</div>");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_kept_together() {
        for (text, expected) in [
            ("0.5 × max(0, 0.9)^2 × (1, 0.5, 0)", Some("(1, 0.5, 0)")),
            ("(2 + (−1, 3.87·10^−5, NaN)) × 2", Some("(−1, 3.87·10^−5, NaN)")),
            ("(1, 2) + max(0, 1, x) (1, 2, 3)^2", None),
            (")(", None),
            ("", None),
        ] {
            let found = triple_in(text).map(|(at, end)| &text[at..end]);
            assert_eq!(found, expected, "{text}");
        }
        assert_eq!(numbers("α × (1, 2, 3)"), "<i>α</i> <span class=\"triple\">× (1, 2, 3)</span>");
    }

    #[test]
    fn what_is_no_number_is_crossed_out() {
        let html = colour(Vec3::new(f32::NAN, 1.0, f32::INFINITY));
        assert!(html.contains("chip none") && html.contains("(NaN, 1, ∞)"), "{html}");
        assert!(colour(Vec3::splat(9.0)).contains("background:#ffffff"));
    }
}
