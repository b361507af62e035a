//! Parses expressions.

use super::{Expression, Operand, Sign, Term, Value, quantity};
use crate::{
    lesson::limits::{DEEPEST_CONDITION, LONGEST_CONDITION, MAX_COMPARISONS},
    text::quoted,
};

type Failure = (usize, String);

#[derive(Clone, Debug, PartialEq)]
enum Token<'a> {
    Word(&'a str),
    Number(f64),
    Text(&'a str),
    Sign(Sign),
    Open,
    Close,
    End,
}

struct Parser<'a> {
    text: &'a str,
    /// The byte after the token.
    next: usize,
    at: usize,
    token: Token<'a>,
    /// Number of comparisons so far.
    comparisons: usize,
}

/// Parses an expression, or returns the byte of the first mistake, and a sentence.
pub(super) fn expression(text: &str) -> Result<Expression, Failure> {
    let mut parser = Parser { text, next: 0, at: 0, token: Token::End, comparisons: 0 };
    parser.advance()?;
    let read = parser.any(0)?;
    match parser.token {
        Token::End => match text.char_indices().nth(LONGEST_CONDITION) {
            Some((at, _)) => Err((at, format!("the condition has more than {LONGEST_CONDITION} characters"))),
            None => Ok(read),
        },
        Token::Close => Err((parser.at, "there is no opening bracket for this one".to_owned())),
        _ => {
            let found = parser.shown();
            Err((parser.at, format!("expected “and”, “or” or the end of the condition, not {found}")))
        }
    }
}

/// The length of the word at the start of a text: a path, with an argument in brackets.
fn word(text: &str) -> usize {
    let mut inside = None;
    for (i, c) in text.char_indices() {
        match (inside, c) {
            (None, '[') => inside = Some(']'),
            (Some(end), c) if c == end => inside = None,
            (Some(_), '\n') => return i,
            (Some(_), _) => {}
            (None, c) if c.is_alphanumeric() || c == '_' || c == '.' => {}
            _ => return i,
        }
    }
    text.len()
}

impl<'a> Parser<'a> {
    /// The token as written, for messages.
    fn shown(&self) -> String {
        match self.token {
            Token::End => "the end".to_owned(),
            _ => quoted(self.text.get(self.at..self.next).unwrap_or_default().trim()),
        }
    }

    fn advance(&mut self) -> Result<(), Failure> {
        let rest = &self.text[self.next..];
        let trimmed = rest.trim_start();
        self.at = self.next + rest.len() - trimmed.len();
        let (token, length) = self.read(trimmed)?;
        self.token = token;
        self.next = self.at + length;
        Ok(())
    }

    fn read(&self, rest: &'a str) -> Result<(Token<'a>, usize), Failure> {
        let signs: [(&str, Sign); 10] = [
            ("<=", Sign::LessOrEqual),
            (">=", Sign::GreaterOrEqual),
            ("!=", Sign::NotEqual),
            ("==", Sign::Equal),
            ("≤", Sign::LessOrEqual),
            ("≥", Sign::GreaterOrEqual),
            ("≠", Sign::NotEqual),
            ("<", Sign::Less),
            (">", Sign::Greater),
            ("=", Sign::Equal),
        ];
        let Some(first) = rest.chars().next() else { return Ok((Token::End, 0)) };
        if let Some((written, sign)) = signs.into_iter().find(|(written, _)| rest.starts_with(written)) {
            return Ok((Token::Sign(sign), written.len()));
        }
        match first {
            '(' => Ok((Token::Open, 1)),
            ')' => Ok((Token::Close, 1)),
            '"' => match rest[1..].find(['"', '\n']) {
                Some(end) if rest[1 + end..].starts_with('"') => Ok((Token::Text(&rest[1..=end]), end + 2)),
                _ => Err((self.at, "this text is never closed; end it with \"".to_owned())),
            },
            '“' | '”' | '„' | '\'' | '‘' | '’' => {
                Err((self.at, "text needs straight double quotes, as in \"phong\"".to_owned()))
            }
            '0'..='9' | '-' | '+' | '.' | '−' => self.number(rest),
            c if c.is_alphabetic() => {
                let mut end = word(rest);
                // An argument belongs to its quantity: curve.albedo(30).
                if rest[..end].contains('.') && rest[end..].starts_with('(') {
                    match rest[end..].find(')') {
                        Some(close) => end += close + 1,
                        None => return Err((self.at + end, "this bracket is never closed".to_owned())),
                    }
                }
                Ok((Token::Word(&rest[..end]), end))
            }
            '&' => Err((self.at, "conditions are joined with the word “and”".to_owned())),
            '|' => Err((self.at, "conditions are joined with the word “or”".to_owned())),
            '!' => Err((self.at, "a condition is negated with the word “not”".to_owned())),
            c => Err((self.at, format!("{} has no meaning in a condition", quoted(&c.to_string())))),
        }
    }

    fn number(&self, rest: &'a str) -> Result<(Token<'a>, usize), Failure> {
        let negative = rest.starts_with(['-', '−']);
        let digits = rest.trim_start_matches(['-', '−', '+']);
        let start = rest.len() - digits.len();
        let mut length =
            digits.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.')).unwrap_or(digits.len());
        // The sign of an exponent is part of the number.
        if digits[..length].ends_with(['e', 'E']) && digits[length..].starts_with(['-', '+']) {
            let after = &digits[length + 1..];
            length += 1 + after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
        }
        let written = &digits[..length];
        self.unit(written, &digits[length..], start + length)?;
        let is_number = written.starts_with(|c: char| c.is_ascii_digit() || c == '.');
        let value = written.parse::<f64>().ok().filter(|value| is_number && value.is_finite());
        let Some(value) = value else {
            return Err((self.at, format!("{} is not a number", quoted(&rest[..start + length]))));
        };
        let value = if negative { -value } else { value };
        let unit = digits[length..].trim_start_matches(' ');
        let after_spaces = rest.len() - unit.len();
        Ok(match unit.chars().next() {
            Some('°') => (Token::Number(value), after_spaces + '°'.len_utf8()),
            Some('%') => (Token::Number(value / 100.0), after_spaces + 1),
            _ => (Token::Number(value), start + length),
        })
    }

    /// Refuses a unit given as a word or a symbol: `20 degrees`, `20deg`.
    fn unit(&self, written: &str, after: &str, length: usize) -> Result<(), Failure> {
        let joined = written.trim_start_matches(|c: char| !c.is_ascii_alphabetic());
        let spaced = after.trim_start_matches(' ');
        let end = spaced.find(|c: char| !c.is_alphabetic()).unwrap_or(spaced.len());
        let (word, at) = if joined.is_empty() {
            (&spaced[..end], length + after.len() - spaced.len())
        } else {
            (joined, length - joined.len())
        };
        let (sign, meant) = match word.to_lowercase().as_str() {
            "degrees" | "degree" | "deg" => ("°", "degrees"),
            "percent" | "per" => ("%", "per cent"),
            _ => return Ok(()),
        };
        let number = &written[..written.len() - joined.len()];
        Err((self.at + at, format!("{meant} are written {sign}: write {number}{sign}")))
    }

    fn is_word(&self, wanted: &str) -> bool {
        matches!(self.token, Token::Word(word) if word == wanted)
    }

    fn any(&mut self, depth: usize) -> Result<Expression, Failure> {
        let mut parts = vec![self.all(depth)?];
        while self.is_word("or") {
            self.advance()?;
            parts.push(self.all(depth)?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::Any(parts) })
    }

    fn all(&mut self, depth: usize) -> Result<Expression, Failure> {
        let mut parts = vec![self.single(depth)?];
        while self.is_word("and") {
            self.advance()?;
            parts.push(self.single(depth)?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expression::All(parts) })
    }

    fn single(&mut self, depth: usize) -> Result<Expression, Failure> {
        if depth > DEEPEST_CONDITION {
            let what = format!("the condition is nested more than {DEEPEST_CONDITION} levels deep");
            return Err((self.at, what));
        }
        if self.is_word("not") {
            self.advance()?;
            return Ok(Expression::Not(Box::new(self.single(depth + 1)?)));
        }
        if self.token == Token::Open {
            let open = self.at;
            self.advance()?;
            let inside = self.any(depth + 1)?;
            if self.token != Token::Close {
                return Err(match self.token {
                    Token::End => (open, "this bracket is never closed".to_owned()),
                    _ => {
                        (self.at, format!("expected “and”, “or” or a closing bracket, not {}", self.shown()))
                    }
                });
            }
            self.advance()?;
            return Ok(inside);
        }
        self.comparisons += 1;
        if self.comparisons > MAX_COMPARISONS {
            return Err((self.at, format!("a condition has at most {MAX_COMPARISONS} comparisons")));
        }
        let left = self.operand()?;
        let Token::Sign(sign) = self.token else { return Ok(Expression::Truth(left)) };
        self.advance()?;
        let right = self.operand()?;
        if let Token::Sign(_) = self.token {
            return Err((self.at, "a comparison has two sides; join two comparisons with “and”".to_owned()));
        }
        Ok(Expression::Comparison { left, sign, right })
    }

    fn operand(&mut self) -> Result<Operand, Failure> {
        let at = self.at;
        let what = match self.token {
            Token::Number(number) => Term::Value(Value::Number(number)),
            Token::Text(text) => Term::Value(Value::Text(text.to_owned())),
            Token::Word("true") => Term::Value(Value::Truth(true)),
            Token::Word("false") => Term::Value(Value::Truth(false)),
            Token::Word("and" | "or" | "not") | Token::Sign(_) | Token::Open | Token::Close | Token::End => {
                return Err((at, format!("expected a quantity or a value, not {}", self.shown())));
            }
            Token::Word(word) => {
                Term::Quantity(quantity::asked(word).map_err(|(inside, what)| (at + inside, what))?)
            }
        };
        self.advance()?;
        Ok(Operand { at, what })
    }
}
