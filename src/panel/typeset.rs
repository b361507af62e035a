//! Typesetting of equations: stacked fractions, roots, brackets as tall as their content, line breaks before + and −.
//! The typesetting is our own, since it lays out the text of egui itself: symbols and numbers keep their cells for
//! tooltips and links, and lines break to the width of the panel, which a picture of a formula could not do.

use bevy_egui::egui::epaint::{CubicBezierShape, PathShape};

use super::{
    formula::{Node, bare, factors, flattened, is_sign, is_space, multiplied, terms},
    maths::{Atom, Laid, lay_out},
    prelude::*,
};

/// A painted element, relative to the left end of the baseline.
#[derive(Clone)]
enum Ink {
    /// An atom.
    Atom(Laid, Option<String>, Option<String>),
    /// A horizontal rule of the given length, of a fraction or a root.
    Rule(f32),
    /// An opening or closing bracket, with its extent above and below the baseline.
    Bracket(char, f32, f32),
    /// A root sign, with its extent above and below the baseline.
    Root(f32, f32),
}

/// A typeset piece: painted elements, and extent above and below the baseline.
#[derive(Clone, Default)]
pub struct Set {
    ink: Vec<(Vec2, f32, Ink)>,
    /// Width of the piece.
    pub width: f32,
    /// Height above the baseline.
    pub ascent: f32,
    /// Depth below the baseline.
    pub descent: f32,
    /// The worst line break needed for the formula that the piece is a line of.
    pub broken: Break,
}

/// Kinds of line breaks in a formula, the best first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Break {
    /// None, or before + and −, before words, and after commas.
    #[default]
    Sign,
    /// Also between factors; the next line starts with ×.
    Product,
    /// Inside brackets and fractions, because every line was too narrow.
    Anywhere,
}

/// The cell of an element on the line: corner and size.
fn cell(place: Vec2, size: f32, width: f32) -> (Vec2, Vec2) {
    (place + vec2(-1.0, -0.86 * size), vec2(width + 2.0, 1.24 * size))
}

impl Set {
    fn put(&mut self, other: Set, at: Vec2) {
        self.ascent = self.ascent.max(other.ascent - at.y);
        self.descent = self.descent.max(other.descent + at.y);
        self.width = self.width.max(at.x + other.width);
        self.ink.extend(other.ink.into_iter().map(|(place, size, ink)| (place + at, size, ink)));
    }

    fn append(&mut self, other: Set) {
        self.put(other, vec2(self.width, 0.0));
    }

    /// The symbols and powers: names and cells.
    pub fn symbols(&self) -> impl Iterator<Item = (&str, Vec2, Vec2)> {
        self.ink.iter().flat_map(|(place, size, ink)| {
            let mut cells = Vec::new();
            if let Ink::Atom(laid, symbol, power) = ink {
                let raised = laid.pieces.last().filter(|_| power.is_some());
                let base = raised.map_or(laid.width, |piece| piece.offset.x);
                if let Some(symbol) = symbol {
                    let (corner, size) = cell(*place, *size, base);
                    cells.push((symbol.as_str(), corner, size));
                }
                if let (Some(power), Some(piece)) = (power, raised) {
                    let corner = *place + vec2(piece.offset.x - 1.0, -1.1 * size);
                    cells.push((power.as_str(), corner, vec2(piece.galley.size().x + 3.0, 0.86 * size)));
                }
            }
            cells
        })
    }

    /// The cells of the numbers, in the order of the text.
    pub fn numbers(&self) -> impl Iterator<Item = (Vec2, Vec2)> {
        self.ink.iter().filter_map(|(place, size, ink)| {
            let Ink::Atom(laid, None, _) = ink else { return None };
            let first = &laid.pieces.first()?.galley;
            let is_number = first.text().starts_with(|c: char| c.is_ascii_digit());
            is_number.then(|| cell(*place, *size, first.size().x))
        })
    }

    /// Paints the piece with the left end of the baseline at a position.
    pub fn paint(&self, ui: &Ui, at: Pos2, colour: Color32) {
        let painter = ui.painter();
        for (place, size, ink) in &self.ink {
            let at = at + *place;
            let stroke = Stroke::new(size / 15.0, colour);
            match ink {
                Ink::Atom(laid, ..) => {
                    for piece in &laid.pieces {
                        painter.galley(at + piece.offset, piece.galley.clone(), colour);
                    }
                }
                Ink::Rule(length) => {
                    painter.hline(at.x..=at.x + length, at.y, stroke);
                }
                Ink::Bracket(which, up, down) => bracket(ui, at, *which, *size, *up, *down, colour),
                Ink::Root(up, down) => {
                    let foot = at + vec2(0.36 * size, *down);
                    let hook = [vec2(0.02 * size, -0.2 * size), vec2(0.14 * size, -0.28 * size)];
                    let [start, top] = hook.map(|corner| at + corner);
                    let points = vec![start, top, foot, at + vec2(0.58 * size, -up)];
                    painter.add(Shape::Path(PathShape::line(points, stroke)));
                }
            }
        }
    }
}

/// Widths of a tall bracket and of a root sign, relative to the font size.
const BRACKET: f32 = 0.36;
const ROOT: f32 = 0.62;

fn bracket(ui: &Ui, at: Pos2, which: char, size: f32, up: f32, down: f32, colour: Color32) {
    let stroke = Stroke::new(size / 13.0, colour);
    let width = BRACKET * size;
    // Mirrored for a closing bracket.
    let x = |t: f32| if ")]⟩".contains(which) { at.x + (1.0 - t) * width } else { at.x + t * width };
    let (top, bottom) = (at.y - up, at.y + down);
    let line = |points: Vec<Pos2>| Shape::Path(PathShape::line(points, stroke));
    let p = |t: f32, y: f32| Pos2::new(x(t), y);
    ui.painter().add(match which {
        '|' => line(vec![p(0.5, top), p(0.5, bottom)]),
        '[' | ']' => line(vec![p(0.7, top), p(0.3, top), p(0.3, bottom), p(0.7, bottom)]),
        '⟨' | '⟩' => line(vec![p(0.75, top), p(0.2, (top + bottom) / 2.0), p(0.75, bottom)]),
        _ => {
            let bow = 0.3 * (bottom - top);
            let points = [p(0.85, top), p(0.12, top + bow), p(0.12, bottom - bow), p(0.85, bottom)];
            let (closed, fill) = (false, Color32::TRANSPARENT);
            Shape::CubicBezier(CubicBezierShape::from_points_stroke(points, closed, fill, stroke))
        }
    });
}

/// Typesets equations in one size and one colour.
#[derive(Clone, Copy)]
pub struct Setter<'a> {
    /// The panel, which provides the fonts.
    pub ui: &'a Ui,
    /// Font size, in points.
    pub size: f32,
    /// Colour of the text.
    pub colour: Color32,
    /// True to stack fractions; false to use a slash.
    pub stacked: bool,
    /// True to reduce the size of pieces that are too wide.
    pub shrinks: bool,
}

impl Setter<'_> {
    fn with_size(self, size: f32) -> Self {
        Self { size, ..self }
    }

    fn atom(self, atom: &Atom) -> Set {
        let laid = lay_out(self.ui, atom, self.size, self.colour);
        let scripts = |which: fn(&Atom) -> &str| !which(atom).is_empty();
        let up = if scripts(Atom::sup) { 1.0 } else { 0.78 };
        let down = if scripts(Atom::sub) { 0.42 } else { 0.24 };
        let width = laid.width;
        let ink = Ink::Atom(laid, atom.symbol(), atom.power());
        self.inked(ink, width, up * self.size, down * self.size)
    }

    fn inked(self, ink: Ink, width: f32, ascent: f32, descent: f32) -> Set {
        Set { ink: vec![(Vec2::ZERO, self.size, ink)], width, ascent, descent, broken: Break::default() }
    }

    /// Sets nodes side by side.
    #[must_use]
    pub fn row(self, nodes: &[Node]) -> Set {
        let mut set = Set { ascent: 0.78 * self.size, descent: 0.24 * self.size, ..Set::default() };
        for node in nodes {
            set.append(self.node(node));
        }
        set
    }

    fn node(self, node: &Node) -> Set {
        match node {
            Node::Atom(atom) => self.atom(atom),
            Node::Group(open, body, close) => self.group(open, body, close),
            Node::Root(body) => self.root(body),
            Node::Fraction(over, under) if self.stacked => self.fraction(over, under),
            Node::Fraction(over, under) => {
                let mut set = self.row(over);
                set.append(self.atom(&Atom::upright("/")));
                set.append(self.row(under));
                set
            }
        }
    }

    fn group(self, open: &Atom, body: &[Node], close: &Atom) -> Set {
        let inside = self.row(body);
        let (up, down) = (inside.ascent, inside.descent);
        if up < 1.1 * self.size && down < 0.5 * self.size {
            let mut set = self.atom(open);
            set.append(inside);
            set.append(self.atom(close));
            return set;
        }
        let sign = |atom: &Atom| atom.base().chars().next().unwrap_or('(');
        let tall = |which: char| self.inked(Ink::Bracket(which, up, down), BRACKET * self.size, up, down);
        let mut set = tall(sign(open));
        set.append(inside);
        set.append(tall(sign(close)));
        // The scripts are at the ends of the tall bracket.
        for (script, shift) in [(close.sup(), 0.62 * self.size - up), (close.sub(), down - 0.1 * self.size)] {
            if !script.is_empty() {
                let (sub, sup) = (String::new(), script.to_owned());
                let mut script = self.atom(&Atom::Upright { base: String::new(), sub, sup });
                script.ascent = self.size;
                set.put(script, vec2(set.width, shift));
            }
        }
        set
    }

    fn root(self, body: &[Node]) -> Set {
        let inside = self.row(body);
        let up = inside.ascent + 0.1 * self.size;
        let down = inside.descent;
        let length = inside.width + 0.08 * self.size;
        let ascent = up + 0.08 * self.size;
        let mut set = self.inked(Ink::Root(up, down), ROOT * self.size, ascent, down);
        set.ink.push((vec2(0.58 * self.size, -up), self.size, Ink::Rule(length)));
        set.append(inside);
        set.width += 0.08 * self.size;
        set
    }

    fn fraction(self, over: &[Node], under: &[Node]) -> Set {
        // Nested fractions have a slash: three levels would be hard to read.
        let size = if self.shrinks { (0.88 * self.size).max(10.0) } else { self.size };
        let inner = Self { stacked: false, ..self.with_size(size) };
        let (over, under) = (inner.row(bare(over)), inner.row(bare(under)));
        let width = over.width.max(under.width) + 0.2 * self.size;
        let axis = -0.27 * self.size;
        let gap = 0.12 * self.size;
        let middle = |set: &Set| (width - set.width) / 2.0;
        let mut set = Set {
            ink: vec![(vec2(0.05 * self.size, axis), self.size, Ink::Rule(width - 0.1 * self.size))],
            width,
            ..Set::default()
        };
        let at =
            [vec2(middle(&over), axis - gap - over.descent), vec2(middle(&under), axis + gap + under.ascent)];
        set.put(over, at[0]);
        set.put(under, at[1]);
        set.width = width;
        // The bars of adjacent fractions must not touch.
        set.width += 0.06 * self.size;
        set
    }

    /// Sets an equation in lines of at most this width; continuation lines are indented to the text after the equals
    /// sign. Lines break before + and − outside brackets, before a condition, and before a new definition. A line that
    /// is still too wide is set smaller, then broken between factors, with a ×, then anywhere.
    #[must_use]
    pub fn lines(self, nodes: &[Node], width: f32) -> Vec<Set> {
        const SIZES: [f32; 4] = [1.0, 0.94, 0.88, 0.82];
        let fits = |lines: &[Set]| lines.iter().all(|line| line.width <= width);
        let mut lines = Vec::new();
        for factor in SIZES.into_iter().take(if self.shrinks { SIZES.len() } else { 1 }) {
            lines = self.with_size(factor * self.size).broken(&terms(nodes), width);
            if fits(&lines) {
                return lines;
            }
        }
        let small = if self.shrinks { self.with_size(SIZES[SIZES.len() - 1] * self.size) } else { self };
        for flat in [false, true] {
            let setter = Self { stacked: !flat, ..small };
            let nodes = if flat { flattened(nodes) } else { nodes.to_vec() };
            let pieces = if flat { nodes.chunks(1).collect() } else { factors(&nodes) };
            lines = setter.broken(&pieces, width);
            // A line of single signs can end anywhere.
            let broken = if flat { Break::Anywhere } else { Break::Product };
            let many = lines.len() > 1;
            lines.iter_mut().filter(|_| many).for_each(|line| line.broken = broken);
            if fits(&lines) {
                break;
            }
        }
        lines
    }

    /// Distributes unbreakable pieces over lines.
    fn broken(self, pieces: &[&[Node]], width: f32) -> Vec<Set> {
        let mut lines: Vec<Set> = Vec::new();
        let mut hang = 1.4 * self.size;
        for (i, piece) in pieces.iter().enumerate() {
            let set = self.row(piece);
            match lines.last_mut() {
                Some(line) if line.width + set.width <= width || line.width <= hang => line.append(set),
                _ => {
                    // No space at the start of a line.
                    let start = piece.iter().take_while(|n| is_space(n)).count();
                    let indent = if i == 0 { 0.0 } else { hang };
                    let mut line = Set { width: indent, ..Set::default() };
                    // A single sign is not a factor.
                    if i > 0 && self.stacked && multiplied(pieces[i - 1], piece) {
                        line.append(self.row(&times()));
                    }
                    line.append(self.row(&piece[start..]));
                    lines.push(line);
                }
            }
            if i == 0
                && let Some(equals) = piece.iter().position(|n| is_sign(n, "="))
            {
                hang = hang.max((self.row(&piece[..equals]).width + 1.2 * self.size).min(0.3 * width));
            }
        }
        lines
    }
}

/// The sign at the start of a line that continues the product of the previous line.
fn times() -> [Node; 2] {
    [Node::Atom(Atom::upright("×")), Node::Atom(Atom::Space)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::{formula::tree, maths};
    use bevy_egui::egui;

    /// Sets all parts of all equations at this width, and passes the text and its lines to `see`.
    fn set_all(width: f32, shrinks: bool, mut see: impl FnMut(&str, f32, &[Set])) {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        let registry = crate::registry::Registry::builtin();
        let models = registry.models().iter().flat_map(|m| maths::definitions(m.declaration.equation));
        let parts = models.map(|(term, text)| (maths::size_of(term, text), text));
        let lights = registry.lights().iter().map(|l| (maths::SIZE, l.declaration.equation));
        let texts: Vec<_> = parts.chain(lights).collect();
        for pass in 0..2 {
            let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
                for (size, text) in texts.iter().filter(|_| pass == 1) {
                    let setter = Setter { ui, size: *size, colour: Color32::WHITE, stacked: true, shrinks };
                    see(text, *size, &setter.lines(&tree(text), width));
                }
            });
        }
    }

    /// The characters of a line from left to right, as set.
    fn words(line: &Set) -> String {
        let piece = |(_, _, ink): &(Vec2, f32, Ink)| match ink {
            Ink::Atom(laid, ..) if laid.pieces.is_empty() => " ".to_owned(),
            Ink::Atom(laid, ..) => laid.pieces.iter().map(|p| p.galley.text().to_owned()).collect(),
            Ink::Bracket(which, ..) => which.to_string(),
            Ink::Root(..) | Ink::Rule(_) => String::new(),
        };
        line.ink.iter().map(piece).collect()
    }

    #[test]
    fn definitions_have_a_line_each_broken_before_signs_and_conditions_outside_brackets() {
        // The initial and the minimum width of the panel.
        for width in [320.0, 276.0] {
            set_all(width, true, |text, size, lines| {
                // The initial panel is wide enough for almost full size.
                let least = if width > 300.0 { 0.9 } else { 0.8 };
                let largest = lines.iter().flat_map(|l| &l.ink).map(|(_, size, _)| *size).fold(0.0, f32::max);
                assert!(largest >= least * size, "{width}: {text} is set in {largest}, not {size}");
                for (i, line) in lines.iter().enumerate() {
                    let words = words(line);
                    let count = |any: &str| words.chars().filter(|c| any.contains(*c)).count();
                    assert_eq!(count("([⟨"), count(")]⟩"), "{width}: “{words}” of {text} breaks a bracket");
                    assert!(line.width <= width, "{width}: “{words}” of {text} is {} wide", line.width);
                    let start = words.trim_start();
                    let good = start.starts_with(['+', '−']) || start.starts_with("if ");
                    assert!(i == 0 || good, "{width}: a line of {text} begins with “{start}”");
                }
            });
        }
    }

    #[test]
    fn a_product_that_is_broken_goes_on_with_a_sign() {
        let mut products = 0;
        for width in [200.0, 240.0, 300.0] {
            set_all(width, false, |text, _, lines| {
                for pair in lines.windows(2).filter(|pair| pair[1].broken < Break::Anywhere) {
                    let [before, here] = [words(&pair[0]), words(&pair[1])];
                    let here = here.trim_start();
                    let signs = ["+", "−", "×", "where", "or ", "if ", "else"];
                    let good = signs.iter().any(|s| here.starts_with(s)) || before.ends_with([',', '=', '·']);
                    assert!(good, "{width}: a line of {text} begins with “{here}” after “{before}”");
                    products += usize::from(here.starts_with('×'));
                    let function = ["max", "min", "exp", "cos", "tan"].iter().any(|f| before.ends_with(f));
                    assert!(!function, "{width}: “{before}” of {text} has lost its argument");
                }
            });
        }
        assert!(products > 5, "{products}");
    }

    #[test]
    fn brackets_about_a_fraction_are_as_tall_as_it_is() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        for _ in 0..2 {
            let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
                let setter = Setter { ui, size: 17.0, colour: Color32::WHITE, stacked: true, shrinks: true };
                let tall = setter.row(&tree("(1 + a/b)"));
                let flat = setter.row(&tree("(1 + a b)"));
                let brackets =
                    |set: &Set| set.ink.iter().filter(|(.., i)| matches!(i, Ink::Bracket(..))).count();
                assert_eq!((brackets(&tall), brackets(&flat)), (2, 0));
                assert!(tall.ascent + tall.descent > 1.5 * (flat.ascent + flat.descent));
                assert!(tall.width < flat.width + 17.0);
            });
        }
    }

    #[test]
    fn the_exponent_of_an_exponent_stands_above_it_and_smaller() {
        let ctx = Context::default();
        ctx.set_fonts(crate::lettering::fonts());
        for _ in 0..2 {
            let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
                let setter = Setter { ui, size: 40.0, colour: Color32::WHITE, stacked: true, shrinks: true };
                let set = setter.row(&tree("e^{-x^2} y"));
                let Some((_, _, Ink::Atom(laid, ..))) = set.ink.first() else { panic!("no atom") };
                // The characters, and where each begins, stands and how large it is.
                let pieces: Vec<_> = laid
                    .pieces
                    .iter()
                    .map(|piece| {
                        let galley = &piece.galley;
                        let baseline = piece.offset.y + galley.rows[0].row.glyphs[0].pos.y;
                        (galley.text().to_owned(), piece.offset.x, baseline, galley.size().y)
                    })
                    .collect();
                let texts: Vec<_> = pieces.iter().map(|(text, ..)| &**text).collect();
                assert_eq!(texts, ["e", "−", "x", "2"]);
                assert!(
                    pieces.windows(2).all(|pair| pair[0].1 < pair[1].1),
                    "from left to right: {pieces:?}"
                );
                let [e, minus, x, two] = [0, 1, 2, 3].map(|i| pieces[i].2);
                assert!(e.abs() < 0.5 && (minus - x).abs() < 0.5, "{pieces:?}");
                assert!(x < e - 10.0 && two < x - 5.0, "each exponent is raised: {pieces:?}");
                assert!(pieces[0].3 > pieces[2].3 && pieces[2].3 > pieces[3].3, "{pieces:?}");
                // What follows is beside all of it.
                let next = set.ink.last().map_or(0.0, |(place, ..)| place.x);
                assert!(next > pieces[3].1 && set.ink.len() == 3, "{next}");
            });
        }
    }
}
