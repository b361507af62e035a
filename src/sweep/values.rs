//! The values of an axis, from text: lists such as `lambert,phong`, ranges such as `0.1..0.9:5` and `1..100:5:log`.

use std::collections::HashSet;

use super::MAX_PICTURES;
use crate::{
    parameter::Value,
    registry::Registry,
    scene::{at::Place, limits::significant, repeat::Scale},
    text::{items, numbers, quoted, shortened},
};

/// The form of a range, for messages.
const FORM: &str = "a range is FROM..TO:COUNT, as in 0.1..0.9:5, or 1..100:5:log";

/// The values in a text, in order. A way whose last point is its first has that point once.
pub(super) fn read(text: &str, place: &Place, registry: &Registry) -> Result<Vec<Value>, String> {
    let path = &place.path;
    let is_range = text.contains("..");
    let texts = if is_range {
        range(text, place, registry).map_err(|why| format!("{path}={}: {why}", shortened(text)))?
    } else {
        listed(text)
    };
    if texts.len() > MAX_PICTURES {
        return Err(format!(
            "{path} has {} values, but a sweep has at most {MAX_PICTURES} pictures",
            texts.len()
        ));
    }
    let values = texts.iter().map(|text| match text.trim() {
        "" => Err(format!("{path} has an empty value; separate values by single commas")),
        text => place.read(text, registry),
    });
    values.collect()
}

/// The values in a text, each once.
pub(super) fn read_distinct(text: &str, place: &Place, registry: &Registry) -> Result<Vec<Value>, String> {
    let (values, path) = (read(text, place, registry)?, &place.path);
    let mut known = HashSet::new();
    match values.iter().find(|value| !known.insert(value.to_string())) {
        Some(_) if text.contains("..") && place.is_whole() => Err(format!(
            "{path}={}: there are fewer whole numbers in this range than values",
            shortened(text)
        )),
        Some(value) => Err(format!("{path} is {value} twice; each value makes one picture")),
        None => Ok(values),
    }
}

/// The entries between commas outside of brackets.
fn listed(text: &str) -> Vec<String> {
    let (mut depth, mut all) = (0_i32, vec![String::new()]);
    for c in text.chars() {
        depth += i32::from(c == '[') - i32::from(c == ']');
        match all.last_mut() {
            Some(last) if c != ',' || depth > 0 => last.push(c),
            _ => all.push(String::new()),
        }
    }
    all
}

/// The values of a range, as text.
fn range(text: &str, place: &Place, registry: &Registry) -> Result<Vec<String>, String> {
    let (points, rest) =
        text.split_once(':').ok_or_else(|| format!("the number of values is missing; {FORM}"))?;
    let (count, scale) = match rest.split_once(':') {
        None => (rest, Scale::Linear),
        Some((count, "log")) => (count, Scale::Logarithmic),
        Some((_, other)) => return Err(format!("{} is not log; {FORM}", quoted(other))),
    };
    let count = super::count(count).map_err(|why| format!("{why}; {FORM}"))?;
    let points = points.split("..").map(|point| {
        let value = place.read(point, registry)?;
        if !matches!(value, Value::Number(_) | Value::Integer(_) | Value::Triple(_) | Value::Colour(_)) {
            return Err("only numbers have ranges; write words one by one, with commas".to_owned());
        }
        // In 64 bits, so that 0.3 is in the middle of 0.1 and 0.5.
        Ok(match numbers::<f64>(point).as_deref() {
            Some([v]) => [*v; 3],
            Some([x, y, z]) => [*x, *y, *z],
            _ => value.numbers(),
        })
    });
    let points = points.collect::<Result<Vec<_>, String>>()?;
    if points.iter().flatten().any(|v| !v.is_finite()) {
        return Err("the ends of a range must be finite".to_owned());
    }
    let is_single = |text: &str| items(text).len() == 1 && !text.trim().starts_with('#');
    let single = points.len() > 1 && text.split("..").next().is_some_and(is_single);
    let log = scale == Scale::Logarithmic;
    let all: Vec<[f64; 3]> = match points.as_slice() {
        [from, to] if single && (!log || from[0] > 0.0 && to[0] > 0.0) => {
            scale.between([from[0], to[0]], count).map(|v| [v; 3]).collect()
        }
        _ if log => return Err("a logarithmic range has two ends, both above 0".to_owned()),
        points => along(points, count),
    };
    let one = |v: f64| {
        // Nobody types the digits of an irrational factor.
        let v = if log { significant(v, 7) } else { v };
        if place.is_whole() { v.round().to_string() } else { (v as f32).to_string() }
    };
    Ok(all
        .into_iter()
        .map(|[x, y, z]| if single { one(x) } else { format!("[{}, {}, {}]", one(x), one(y), one(z)) })
        .collect())
}

/// Points at equal distances along a way through others: at its ends too, unless it is closed.
fn along(points: &[[f64; 3]], count: usize) -> Vec<[f64; 3]> {
    let length = |w: &[[f64; 3]]| (0..3).map(|c| (w[1][c] - w[0][c]).powi(2)).sum::<f64>().sqrt();
    let lengths: Vec<f64> = points.windows(2).map(length).collect();
    let whole: f64 = lengths.iter().sum();
    let is_closed = points.len() > 2 && points.first() == points.last();
    let steps = if is_closed { count } else { count - 1 };
    let at = |i: usize| {
        let mut left = whole * i as f64 / steps.max(1) as f64;
        for (k, length) in lengths.iter().enumerate() {
            if left <= *length || k + 1 == lengths.len() {
                let part = if *length > 0.0 { (left / length).min(1.0) } else { 0.0 };
                return std::array::from_fn(|c| points[k][c] * (1.0 - part) + points[k + 1][c] * part);
            }
            left -= length;
        }
        points[0]
    };
    (0..count).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn values(path: &str, text: &str) -> Result<Vec<String>, String> {
        let registry = Registry::builtin();
        let place = Place::find(path, &Scene::default(), &registry)?;
        Ok(read_distinct(text, &place, &registry)?.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn ranges_and_lists_are_the_numbers_that_a_person_would_write() {
        let of = |path: &str, text: &str| values(path, text).unwrap_or_else(|e| panic!("{e}"));
        let roughness = "objects[0].material.roughness";
        assert_eq!(of(roughness, "0.1..0.9:5"), ["0.1", "0.3", "0.5", "0.7", "0.9"]);
        assert_eq!(of(roughness, "1..0:3"), ["1", "0.5", "0"]);
        assert_eq!(of("lights[0].intensity", "1..1000:4:log"), ["1", "10", "100", "1000"]);
        assert_eq!(of("lights[0].intensity", "1..100:3:log"), ["1", "10", "100"]);
        assert_eq!(of("display.exposure", "-2..2:3"), ["-2", "0", "2"]);
        assert_eq!(of("objects[0].tessellation", "4..8:3"), ["4", "6", "8"]);
        assert_eq!(of("reflection_model", "lambert, phong"), ["lambert", "phong"]);
        assert_eq!(of("lights[0].colour", "#ff0000,[0, 9, 0]"), ["255,0,0", "0,9,0"]);
        assert_eq!(of("lights[0].position", "[1, 8, 9]..[9, 8, 9]:3"), ["1,8,9", "5,8,9", "9,8,9"]);
        // At equal distances along a way; a closed one has its first point once.
        let way = "[1, 1, 1]..[3, 1, 1]..[3, 5, 1]:4";
        assert_eq!(of("lights[0].position", way), ["1,1,1", "3,1,1", "3,3,1", "3,5,1"]);
        // Two points of this way coincide, which only something that moves may do.
        let way = "[1, 1, 1]..[3, 1, 1]..[1, 1, 1]:4";
        assert!(values("lights[0].position", way).is_err_and(|e| e.contains("twice")));
        let registry = Registry::builtin();
        let place = Place::find("lights[0].position", &Scene::default(), &registry).expect("there");
        assert_eq!(read(way, &place, &registry).map(|all| all.len()), Ok(4));
        let square = "[1, 1, 1]..[3, 1, 1]..[3, 1, 3]..[1, 1, 3]..[1, 1, 1]:4";
        assert_eq!(of("lights[0].position", square), ["1,1,1", "3,1,1", "3,1,3", "1,1,3"]);
    }

    #[test]
    fn what_is_wrong_with_values_is_said() {
        for (path, text, expected) in [
            ("lights[0].intensity", "1..9", "the number of values is missing; a range is FROM..TO:COUNT"),
            ("lights[0].intensity", "1..9:x", "a range is FROM..TO:COUNT"),
            ("lights[0].intensity", "1..9:1", "at least 2"),
            ("lights[0].intensity", "1..9:1000000", "at most 10000"),
            ("lights[0].intensity", "1..9:3:lin", "\"lin\" is not log"),
            ("lights[0].intensity", "0..9:3:log", "two ends, both above 0"),
            ("lights[0].intensity", "1,2,1.0", "lights[0].intensity is 1 twice"),
            ("lights[0].intensity", "1,,2", "an empty value"),
            ("lights[0].intensity", "", "an empty value"),
            ("objects[0].tessellation", "4..6:9", "fewer whole numbers"),
            ("reflection_model", "lambert..phong:3", "only numbers have ranges"),
            ("reflection_model", "lambrt", "did you mean"),
            (
                "objects[0].material.base_colour",
                "red,blue",
                "base_colour is red, but the base colour must be three whole numbers from 0 to 255: [red, green, blue], \
                 or hexadecimal: #ff8000",
            ),
            ("lights[0].colour", "#ff00", "[red, green, blue], or hexadecimal: #ff8000"),
        ] {
            let said = values(path, text).expect_err(text);
            assert!(said.contains(expected), "{text}: {said}");
        }
    }
}
