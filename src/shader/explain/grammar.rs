//! The compiler's plain messages, and unexpected words and symbols: habits from GLSL, HLSL and C.

use super::{Explained, between, scan::Scan, words::wgsl_type};
use crate::{shader::token::Kind, text::shortened};

/// Patterns of messages, the number of the label at the author's position, and an explanation with the
/// remedy. `{0}` and `{1}` are the texts matched by `{}`, `{}` is the text at the first label.
const PLAIN: &[(&str, usize, &str)] = &[
    ("name `{}` is a reserved keyword", 0, "`{0}` is a reserved word of WGSL; choose another name"),
    (
        "Identifier starts with a reserved prefix: `{}`",
        0,
        "`{0}` begins with two underscores, which are reserved; choose another name",
    ),
    (
        "declaration of `{}` needs a type specifier or initializer",
        0,
        "`{0}` needs a value or a type: `var {0} = 0.0;` or `var {0}: f32;`",
    ),
    ("declaration of `{}` is recursive", 1, "`{0}` uses itself; WGSL has no recursion, so write a loop"),
    (
        "declaration of `{}` is cyclic",
        1,
        "`{0}` uses itself through others; WGSL has no recursion, so write a loop",
    ),
    (
        "increment/decrement operation requires reference type to be one of i32 or u32",
        0,
        "++ and -- work only on whole numbers declared with var; otherwise write `{} += 1.0`",
    ),
    (
        "this operation is not supported in a const context",
        0,
        "a const may not depend on parameters or variables; declare it with let",
    ),
    (
        "function does not return any value",
        0,
        "this function has no result; declare one with `-> TYPE` before its {",
    ),
    (
        "unused return value from function annotated with @must_use",
        0,
        "the result of this call is not used; give it a name: `let x = …;`",
    ),
    ("invalid `switch` selector", 0, "a switch needs a whole number; write `i32(…)`, or if and else"),
    (
        "invalid `switch` case selector value",
        0,
        "a case must be a constant whole number of the type of the switch, such as `0u` for a choice",
    ),
    (
        "type mismatch for reject and accept values in `select` call",
        0,
        "the condition of select comes last: `select(if_false, if_true, condition)`, and both values have one type",
    ),
    (
        "unexpected argument type for `select` call",
        0,
        "the condition of select comes last: `select(if_false, if_true, condition)`",
    ),
    (
        "the operand of the `*` operator must be a pointer",
        0,
        "a value is missing before this *; a power is `pow(x, y)`",
    ),
    (
        "`{}` needs a template argument specified: {}",
        0,
        "the type `{0}` needs the type of its numbers: `{0}<f32>`",
    ),
    (
        "type `{}` is not constructible",
        0,
        "a {0} cannot be made of these values; a matrix is made of its columns",
    ),
    (
        "Constructor expects {} components, found {}",
        0,
        "this needs {0} numbers, or one for all, but {1} are given",
    ),
    ("numeric literal not representable by target type: `{}`", 0, "{0} is too large"),
    ("invalid numeric literal format: `{}`", 0, "{0} is not a number"),
    (
        "cannot cast a {} to a {}",
        0,
        "a value of type {0} cannot become {1}; use a component such as `.x`, or `dot`, or `length`",
    ),
    ("Division by zero", 0, "this divides by zero"),
    ("Remainder by zero", 0, "this divides by zero"),
    ("Incompatible operands: LogicalAnd({}, {}", 0, "&& needs a comparison on both sides, such as `x > 0.0`"),
    ("Incompatible operands: LogicalOr({}, {}", 0, "|| needs a comparison on both sides, such as `x > 0.0`"),
    (
        "Index {} is out of bounds for expression {}",
        0,
        "the index {0} is too large; the first component is 0",
    ),
    ("Invalid access into expression {}", 0, "this is indexed with [ ], but has no components"),
];

/// Types of WGSL, GLSL, HLSL and C.
const TYPES: &[&str] = &[
    "f32", "i32", "u32", "float", "double", "half", "int", "uint", "bool", "vec2", "vec3", "vec4", "float2",
    "float3", "float4", "ivec2", "ivec3", "mat2", "mat3", "mat4", "void",
];

/// The expected word, the word before, the one found, and the message. An empty text matches anything, `TYPE`
/// a type, `WORD` a name; `|` separates alternatives. In the message, `{before}` and `{found}` are these
/// words, `{earlier}` is the one before both, `{next}` the one after, `{type}` the type as written here.
const UNEXPECTED: &[(&str, &str, &str, &str)] = &[
    (
        "",
        "",
        "#include|#import",
        "a file is included by its name in quotation marks: `#import \"file.wgsl\"`",
    ),
    ("", "", "#define", "WGSL has no macros; write `const NAME = …;` or a function"),
    ("", "", "#", "WGSL has no `{found}`; remove this line"),
    (
        "assignment or",
        "TYPE",
        "WORD",
        "a variable is declared with let, or with var if it changes: `let {found} = …;`",
    ),
    ("assignment or", "fn", "", "a function cannot be defined within another one"),
    ("assignment or", "", "", "this is not a statement: a statement sets a var or calls a function"),
    ("`(`", ">", "WORD", "a variable is declared with let, or with var if it changes: `let {found} = …;`"),
    ("`;`", "if", "", "if has no value in WGSL; write `select(if_false, if_true, condition)`"),
    ("`;`", "not", "", "not is written !"),
    ("`;`", "WORD", "(", "WGSL has no methods; write `{before}(…)` with the value in the brackets"),
    ("`;`", "WORD", "{", "a struct is made with round brackets: `{before}(…)`"),
    ("`;`", "", "as", "a value changes its type by the name of the type: `f32(x)`"),
    ("`;`", ")", ",", "a comma cannot stand here; is there one `)` too many before it?"),
    ("`;`", "", ",", "a comma cannot stand here; decimals have a point, as in `1.5`"),
    ("`;`", "TYPE", "WORD", "the type comes after the name: `{earlier} {found}: {type} = …;`"),
    ("operation (`=`)", "TYPE", "WORD", "the type comes after the name: `{earlier} {found}: {type} = …;`"),
    ("operation (`=`)", "", ",", "each let declares one name"),
    ("operation (`=`)", "", "==", "a value is set with a single ="),
    ("operation (`=`)", "", ";", "a let needs its value here; what gets one later is declared with var"),
    ("`:`", "TYPE", "WORD", "the type comes after the name: `{found}: {type}`"),
    (
        "`:`",
        "in|out|inout|const",
        "WORD",
        "parameters have no `{before}` in WGSL: they are read-only, and results are returned",
    ),
    (
        "`,`",
        "in|out|inout|const",
        "WORD",
        "parameters have no `{before}` in WGSL: they are read-only, and results are returned",
    ),
    ("`:`", "WORD", "", "`{before}` needs a type: `{before}: f32`"),
    ("`,`", "", ";", "a comma belongs here"),
    ("`{`", ")", "TYPE", "the type of a result comes after ->: `-> {found}`"),
    ("`{`", "", ":", "the type of a result comes after ->: `-> f32`"),
    ("`{`|`;`|`)`", "", "and", "and is written &&"),
    ("`{`|`;`|`)`", "", "or", "or is written ||"),
    ("`{`", "", "", "a { is missing here: the bodies of functions, if, else and loops have braces"),
    ("`;`", "", "?", "WGSL has no ?: operator; write `select(if_false, if_true, condition)`"),
    ("`)`|`,`", "", "?", "WGSL has no ?: operator; write `select(if_false, if_true, condition)`"),
    ("`;`", "", ")|]", "this {found} closes nothing"),
    ("global item", "", ")|]|}", "this {found} closes nothing"),
    ("`)`", "WORD", "=", "= sets a variable; to compare, write =="),
    (
        "`)`",
        "",
        ",",
        "these brackets hold several values; put what they make before them, such as `Terms` or `vec3`",
    ),
    ("`)`", "", "", "an operator, a comma or a ) is missing after `{before}`"),
    ("statement", "", "++|--", "write `{next} += 1`, or `{next}++` for a whole number"),
    ("expression", "", "[", "a list is written `array(…)`"),
    ("expression", "", "", "a value is missing before `{found}`"),
    ("identifier", "->", "", "the type of the result is missing after ->"),
    ("identifier", ":", "=", "write = instead of :="),
    ("identifier", "", "", "a name is needed here, not `{found}`"),
    (
        "global item",
        "",
        "uniform|in|out|varying|attribute|precision|layout",
        "the only inputs of a model are its parameters: declare them in the comment at the top, and read them as `m.NAME`",
    ),
    (
        "global item",
        "",
        "TYPE",
        "a function begins with fn and a constant with const: `fn {next}(x: f32) -> {type} { … }`",
    ),
    ("global item", "", "func|def|function", "a function begins with fn: `fn {next}(x: f32) -> f32 { … }`"),
    ("global item", "", "let", "outside functions, a value is declared with const"),
    ("global item", "", "import|include|using", "a file is included by `#import \"file.wgsl\"`"),
    (
        "global item",
        "",
        "",
        "`{found}` does not begin a declaration; outside functions, there are only fn, const, var, struct and alias",
    ),
    ("variable access", "", "", "`{found}` is a type or a function, not a value"),
];

/// The explanation of a plain message: the label, and the text.
pub(super) fn plain(message: &str, source: &str) -> Option<(usize, String)> {
    PLAIN.iter().find_map(|(pattern, label, says)| {
        let parts = match pattern.matches("{}").count() {
            0 => (message == *pattern).then_some(["", ""])?,
            1 => between(message, pattern).map(|[one]| [one, ""])?,
            _ => between(message, pattern)?,
        };
        Some((*label, says.replace("{0}", parts[0]).replace("{1}", parts[1]).replace("{}", source)))
    })
}

/// The explanation of an unexpected token at a byte.
pub(super) fn unexpected(scan: &Scan, start: usize, expected: &str, found: &str) -> Option<Explained> {
    let i = scan.at(start);
    let directive = scan.tokens.get(i).filter(|token| token.kind == Kind::Directive);
    let found =
        directive.map_or_else(|| found.trim_matches('"').to_owned(), |token| format!("#{}", token.text));
    let (before, earlier) = (scan.before(i, 1), scan.before(i, 2));
    let is_word = |i: usize| scan.tokens.get(i).is_some_and(|token| token.kind == Kind::Word);
    let fits = |pattern: &str, word: &str, i: Option<usize>| match pattern {
        "" => true,
        "#" => word.starts_with('#'),
        "TYPE" => TYPES.contains(&word),
        "WORD" => i.is_some_and(is_word),
        words => words.split('|').any(|other| other == word),
    };
    let row = UNEXPECTED.iter().find(|(wanted, behind, other, _)| {
        wanted.split('|').any(|wanted| expected.starts_with(wanted))
            && fits(behind, before, i.checked_sub(1))
            && fits(other, &found, Some(i))
    });
    let Some((_, behind, _, says)) = row else {
        return (expected == "`;`").then(|| no_semicolon(scan, start));
    };
    let of = if TYPES.contains(&&*found) { &found } else { before };
    let message = says
        .replace("{before}", &shortened(before))
        .replace("{earlier}", earlier)
        .replace("{next}", scan.word(i + 1))
        .replace("{type}", &wgsl_type(of))
        .replace("{found}", &shortened(&found));
    let wrong = if *behind == "TYPE" { i.saturating_sub(1) } else { i };
    Some((Some(scan.tokens.get(wrong).map_or(start, |token| token.at)), message))
}

/// A statement that does not end before a byte.
fn no_semicolon(scan: &Scan, start: usize) -> Explained {
    let Some(last) = scan.at(start).checked_sub(1).and_then(|i| scan.tokens.get(i)) else {
        return (Some(start), "a ; is missing".to_owned());
    };
    let before = scan.text.get(last.at..start).unwrap_or_default();
    let word = before.trim_end();
    // On another line, or before a word that begins a statement or ends a block.
    let ends = before.contains('\n')
        || matches!(scan.word(scan.at(start)), "return" | "let" | "var" | "if" | "for" | "}");
    let missing = if ends { "a ;" } else { "an operator or a ;" };
    (
        Some(last.at),
        format!("{missing} is missing after `{}`", shortened(word.lines().next().unwrap_or_default())),
    )
}
