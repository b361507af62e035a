//! The structure of an equation: brackets, roots, fractions, and possible line breaks.

use super::maths::{Atom, parse};
use crate::text::mathematics::MAX_DEPTH;

/// A piece of an equation.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A symbol, word, number or operator.
    Atom(Atom),
    /// Brackets with their content; the closing one may have a power.
    Group(Atom, Vec<Node>, Atom),
    /// The content of a root.
    Root(Vec<Node>),
    /// Numerator and denominator.
    Fraction(Vec<Node>, Vec<Node>),
}

/// True if a node is one of these signs.
pub(super) fn is_sign(node: &Node, signs: &str) -> bool {
    matches!(node, Node::Atom(Atom::Upright { base, .. }) if signs.contains(base.as_str()))
}

/// Words between formulas.
const PROSE: [&str; 6] = ["or", "where", "else", "if", "for", "with"];

fn word(node: &Node) -> Option<&str> {
    let Node::Atom(Atom::Upright { base, .. }) = node else { return None };
    (base.len() > 1 && base.chars().all(char::is_alphabetic)).then_some(base.as_str())
}

fn is_prose(node: &Node) -> bool {
    word(node).is_some_and(|w| PROSE.contains(&w))
}

/// True if two adjacent pieces are multiplied without a sign between them.
pub(super) fn multiplied(before: &[Node], after: &[Node]) -> bool {
    let factor = |node: Option<&Node>| node.is_some_and(|n| !is_sign(n, "=≈≤≥<>+−×·,;") && !is_prose(n));
    factor(before.iter().rfind(|n| !is_space(n))) && factor(after.iter().find(|n| !is_space(n)))
}

pub(super) fn is_space(node: &Node) -> bool {
    matches!(node, Node::Atom(Atom::Space))
}

/// Parses an equation into a tree at most [`MAX_DEPTH`] deep; deeper brackets are treated as ordinary signs.
#[must_use]
pub fn tree(text: &str) -> Vec<Node> {
    let mut stack: Vec<(Atom, Vec<Node>)> = Vec::new();
    let mut here: Vec<Node> = Vec::new();
    let bracket = |atom: &Atom, any: &str| !atom.base().is_empty() && any.contains(atom.base());
    for atom in parse(text) {
        // The second of two bars closes, and a bar inside other brackets closes before they do.
        let bar = |stack: &[(Atom, Vec<Node>)]| stack.last().is_some_and(|(open, _)| open.base() == "|");
        while bracket(&atom, ")]⟩") && bar(&stack) {
            unopen(&mut stack, &mut here);
        }
        let closes = bracket(&atom, ")]⟩") || atom.base() == "|" && bar(&stack);
        if bracket(&atom, "([⟨|") && !closes && stack.len() < MAX_DEPTH {
            stack.push((atom, std::mem::take(&mut here)));
        } else if closes && let Some((open, before)) = stack.pop() {
            let body = fractions(std::mem::replace(&mut here, before));
            let root = here.last() == Some(&Node::Atom(Atom::upright("√")));
            let plain =
                atom.sub().is_empty() && atom.sup().is_empty() && matches!(atom, Atom::Upright { .. });
            if root && plain {
                here.pop();
                here.push(Node::Root(body));
            } else {
                here.push(Node::Group(open, body, atom));
            }
        } else {
            here.push(Node::Atom(atom));
        }
    }
    while !stack.is_empty() {
        unopen(&mut stack, &mut here);
    }
    fractions(here)
}

/// Turns the last bracket, which is never closed, into an ordinary sign.
fn unopen(stack: &mut Vec<(Atom, Vec<Node>)>, here: &mut Vec<Node>) {
    if let Some((open, mut before)) = stack.pop() {
        before.push(Node::Atom(open));
        before.append(here);
        *here = before;
    }
}

/// Replaces slashes by fractions. Without spaces, `a b/c` is a times b over c; with spaces, `a b / c` is the whole
/// product over c.
fn fractions(nodes: Vec<Node>) -> Vec<Node> {
    let mut out: Vec<Node> = Vec::new();
    let mut rest = nodes.into_iter().peekable();
    while let Some(node) = rest.next() {
        if !is_sign(&node, "/") {
            out.push(node);
            continue;
        }
        let spaced = out.last().is_some_and(is_space);
        if spaced {
            out.pop();
        }
        let ends = |n: &Node| {
            matches!(n, Node::Fraction(..)) || is_sign(n, "=≈≤≥<>+−×,;∫∈") || !spaced && is_space(n)
        };
        let start = out.iter().rposition(ends).map_or(0, |i| i + 1);
        let mut over = out.split_off(start);
        // The space in front of the fraction stays outside.
        let lead = over.iter().take_while(|n| is_space(n)).count();
        out.extend(over.drain(..lead));
        while rest.peek().is_some_and(is_space) {
            rest.next();
        }
        let mut under = Vec::new();
        while let Some(next) = rest
            .next_if(|n| !is_space(n) && !is_sign(n, "=≈≤≥<>+×,;/") && (!is_sign(n, "−") || under.is_empty()))
        {
            under.push(next);
        }
        if over.is_empty() || under.is_empty() {
            // Nothing to stack: keep the slash.
            out.extend(over);
            out.push(node);
            out.extend(under);
        } else {
            out.push(Node::Fraction(over, under));
        }
    }
    out
}

/// Removes the outer brackets, which are redundant above and below a fraction bar.
pub(super) fn bare(nodes: &[Node]) -> &[Node] {
    match nodes {
        [Node::Group(open, body, close)]
            if open.base() == "(" && close.sup().is_empty() && close.sub().is_empty() =>
        {
            body
        }
        nodes => nodes,
    }
}

/// Splits an equation at the best line breaks: before + and − with spaces around them, before words, and after commas.
pub(super) fn terms(nodes: &[Node]) -> Vec<&[Node]> {
    split(nodes, |i| {
        let before = i.checked_sub(1).map(|k| &nodes[k]);
        let sign = nodes.get(i + 1).is_some_and(|n| is_sign(n, "+−"));
        let behind_sign = before.is_some_and(|n| is_sign(n, "=≈≤≥<>+−×·,"));
        let words = nodes.get(i + 1).is_some_and(is_prose);
        is_space(&nodes[i]) && (sign && !behind_sign || words || before.is_some_and(|n| is_sign(n, ",")))
    })
}

/// Splits an equation between factors, which are separated by a space or only by brackets. A function stays with its
/// argument.
pub(super) fn factors(nodes: &[Node]) -> Vec<&[Node]> {
    split(nodes, |i| {
        let after = nodes.get(i + 1).is_some_and(|n| is_sign(n, "=≈≤≥<>×·,"));
        let before = i.checked_sub(1).map(|k| &nodes[k]);
        let function = |n: &Node| word(n).is_some() && !is_prose(n);
        let behind_sign = before.is_some_and(|n| is_sign(n, "=≈≤≥<>+−×·") || function(n));
        let group = |n: &Node| matches!(n, Node::Group(..));
        is_space(&nodes[i]) && !behind_sign && !after || group(&nodes[i]) && before.is_some_and(group)
    })
}

fn split(nodes: &[Node], at: impl Fn(usize) -> bool) -> Vec<&[Node]> {
    let mut pieces = Vec::new();
    let mut start = 0;
    for i in 1..nodes.len() {
        if at(i) {
            pieces.push(&nodes[start..i]);
            start = i;
        }
    }
    pieces.push(&nodes[start..]);
    pieces
}

/// Flattens the tree into single signs, for pieces that are too wide for a line.
pub(super) fn flattened(nodes: &[Node]) -> Vec<Node> {
    let upright = |base: &str| Node::Atom(Atom::upright(base));
    let mut out = Vec::new();
    for node in nodes {
        match node {
            Node::Atom(_) => out.push(node.clone()),
            Node::Group(open, body, close) => {
                out.push(Node::Atom(open.clone()));
                out.extend(flattened(body));
                out.push(Node::Atom(close.clone()));
            }
            Node::Root(body) => {
                out.extend([upright("√"), upright("(")]);
                out.extend(flattened(body));
                out.push(upright(")"));
            }
            Node::Fraction(over, under) => {
                out.extend(flattened(over));
                out.push(upright("/"));
                out.extend(flattened(under));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_has_a_deepest_branch() {
        fn depth(nodes: &[Node]) -> usize {
            let inner = |node: &Node| match node {
                Node::Atom(_) => 0,
                Node::Group(_, body, _) | Node::Root(body) => 1 + depth(body),
                Node::Fraction(over, under) => depth(over).max(depth(under)),
            };
            nodes.iter().map(inner).max().unwrap_or_default()
        }
        assert_eq!(depth(&tree("((x))")), 2);
        for open in ["(", "√(", "|(", "["] {
            let close = if open == "[" { "]" } else { ")" };
            let text = format!("{}x{}", open.repeat(20_000), close.repeat(20_000));
            assert!(depth(&tree(&text)) <= MAX_DEPTH, "{open}");
        }
    }

    #[test]
    fn fractions_take_the_operands_that_are_meant() {
        let parts = |text: &str| -> Vec<(String, String)> {
            fn plain(nodes: &[Node]) -> String {
                flattened(nodes)
                    .iter()
                    .map(|n| match n {
                        Node::Atom(Atom::Space) => " ".to_owned(),
                        Node::Atom(a) => [a.base(), a.sub(), a.sup()].concat(),
                        _ => String::new(),
                    })
                    .collect()
            }
            fn all(nodes: &[Node], out: &mut Vec<(String, String)>) {
                for node in nodes {
                    match node {
                        Node::Fraction(over, under) => out.push((plain(bare(over)), plain(bare(under)))),
                        Node::Group(_, body, _) | Node::Root(body) => all(body, out),
                        Node::Atom(_) => {}
                    }
                }
            }
            let mut out = Vec::new();
            all(&tree(text), &mut out);
            out
        };
        let one = |over: &str, under: &str| vec![(over.to_owned(), under.to_owned())];
        assert_eq!(parts("I_s = s π D F G / (4 (N·V))"), one("s π D F G", "4 (N·V)"));
        assert_eq!(parts("I_d = C_b/2 + x"), one("Cb", "2"));
        assert_eq!(parts("1 − a b/c d"), one("b", "c"));
        assert_eq!(parts("√(N·L / N·V)"), one("N·L", "N·V"));
        assert_eq!(parts("exp(−x^2 / m^2)"), one("x2", "m2"));
        assert_eq!(parts("a |L + V|^2 / b^4"), one("a |L + V|2", "b4"));
        assert_eq!(parts("a / b, c = 2"), one("a", "b"));
        assert_eq!(parts("tan((α + β)/2)"), one("α + β", "2"));
        assert_eq!(parts("2^{−α/2}"), []);
        assert_eq!(parts("/ a"), []);
        for text in ["", "(", ")", "((a / b", "|a (b| c)", "√", "√(", "a /", "a // b", "/"] {
            let _ = tree(text);
        }
    }
}
