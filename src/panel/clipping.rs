//! The warning that the picture clips, and the marks on clipped pixels: a channel exceeds what the display can show.

use bevy_egui::egui::{Mesh, Painter};

use super::{
    prelude::*,
    state::{Badge, Clipping},
};
use crate::scene::limits;

/// Formats a share as a percentage: "3 %", "under 0.1 %".
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        p if p < 0.1 => "under 0.1 %".to_owned(),
        p if p < 10.0 => format!("{} %", limits::number((10.0 * p).round() / 10.0)),
        p => format!("{} %", limits::number(p.round())),
    }
}

/// The warning in the corner of a view's picture of `pixels` pixels. A small share is reported only while clipped
/// pixels are shown.
#[must_use]
pub fn badge(session: &Session, view: usize, pixels: f64) -> Option<Badge> {
    let clipping = session.facts.clipping.get(view)?.as_ref()?;
    let share = clipping.pixels() as f64 / pixels.max(1.0);
    if share < Clipping::TOLERATED && !session.view.show_clipping {
        return None;
    }
    let share = percent(share);
    Some(Badge {
        severity: Severity::Warning,
        text: format!("Clipped: {share} of the picture"),
        // A share alone would say nothing.
        shorter: vec![format!("Clipped: {share}"), "Clipped".to_owned()],
        help: "Some pixels ask for more light than the display can show. They are cut off: highlights lose their \
               shape, and colours shift. Lights in sight do not count. A lower exposure, a weaker light or tone mapping brings them back."
            .to_owned(),
    })
}

/// Marks the clipped parts of a view's picture.
pub fn paint(painter: &Painter, rect: Rect, view: usize, session: &Session, pixels_per_point: f32) {
    let known = session.facts.clipping.get(view).and_then(Option::as_ref);
    let Some(clipping) = known.filter(|_| session.view.show_clipping) else {
        return;
    };
    let mut mesh = Mesh::default();
    let [across, down] = Clipping::GRID;
    let edge = |low: f32, extent: f32, k: usize, of: usize| {
        // Aligned to whole pixels, to avoid seams.
        ((low + extent * k as f32 / of as f32) * pixels_per_point).round() / pixels_per_point
    };
    for (i, count) in clipping.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let (x, y) = (i % across, i / across);
        let column = |k| edge(rect.left(), rect.width(), k, across);
        let row = |k| edge(rect.top(), rect.height(), k, down);
        let field = Rect::from_min_max(pos2(column(x), row(y)), pos2(column(x + 1), row(y + 1)));
        let all = field.area() * pixels_per_point * pixels_per_point;
        let share = (*count as f32 / all.max(1.0)).min(1.0);
        // A chequered pattern stands out from any surface, even without its colours.
        let colour = if (x + y) % 2 == 0 { Color32::from_rgb(0xff, 0x00, 0xc8) } else { Color32::BLACK };
        mesh.add_colored_rect(field, colour.gamma_multiply(0.45 + 0.55 * share));
    }
    painter.add(Shape::mesh(mesh));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_read_as_people_say_them() {
        assert_eq!(percent(0.0004), "under 0.1 %");
        assert_eq!(percent(0.0234), "2.3 %");
        assert_eq!(percent(0.02), "2 %");
        assert_eq!(percent(0.456), "46 %");
    }

    #[test]
    fn there_is_no_sign_where_nothing_clips() {
        let fields = Clipping::GRID[0] * Clipping::GRID[1];
        assert_eq!(Clipping::new(vec![0; fields]), None);
        assert_eq!(Clipping::new(vec![1; 3]), None);
        let mut counts = vec![0; fields];
        (counts[0], counts[fields - 1]) = (2, 3);
        let mut session = Session::default();
        assert_eq!(badge(&session, 0, 100.0), None);
        session.facts.clipping[0] = Clipping::new(counts);
        assert_eq!(badge(&session, 1, 100.0), None, "of another view nothing is known");
        assert_eq!(badge(&session, 0, 100.0).map(|b| b.text).as_deref(), Some("Clipped: 5 % of the picture"));
        let shorter = badge(&session, 0, 100.0).map(|b| b.shorter).unwrap_or_default();
        assert!(shorter.len() > 1 && shorter.iter().all(|text| text.starts_with("Clipped")), "{shorter:?}");
        assert_eq!(badge(&session, 0, 10_000.0), None, "new lights may clip as much");
        session.view.show_clipping = true;
        assert!(badge(&session, 0, 10_000.0).is_some(), "where they are shown, that can be ended");
    }
}
