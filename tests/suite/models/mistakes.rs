//! Errors that students make in the WGSL of a model: each is reported at the author's line and column, in
//! words, with the remedy.

use std::path::Path;

use lights_camera_models::{custom, registry::Registry};

use crate::helpers::support::check_wording;

/// The messages of reading a file; one line per problem.
fn said(text: &str) -> String {
    match custom::read(Path::new("somewhere/mine.wgsl"), text, &Registry::builtin()) {
        Ok(_) => String::new(),
        Err(problems) => problems.iter().map(|p| format!("{p}\n")).collect(),
    }
}

#[test]
fn mistakes_are_reported_where_they_are() {
    let head = "/* lcm { \"parameters\": [\"k_s\"] } */\n";
    let body = "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n    return Terms(vec3(0.0), vec3(0.0), vec3(m.k_s));\n}\n";
    assert_eq!(said(&format!("{head}{body}")), "");
    for (text, expected) in [
        (
            head.to_owned(),
            "models/mine.wgsl:1:36: the function response is missing; define fn response(l: vec3<f32>",
        ),
        (format!("{head}{}", body.replace("m.k_s", "m.k_d")), "models/mine.wgsl:3:"),
        (
            format!(
                "{head}{}",
                body.replace("return Terms(vec3(0.0), vec3(0.0), vec3(m.k_s));", "let x = m.k_s;")
            ),
            "models/mine.wgsl:4:1: the function response ends without a return",
        ),
        (
            format!("{head}{}fn half(x: f32) -> f32 {{ if x > 0.0 {{ return 0.5; }} }}", body),
            "models/mine.wgsl:5:53: the function half ends without a return",
        ),
        (
            format!("{head}{}", body.replace("vec3(m.k_s)", "vec3(dot(frame.normal, l))")),
            "Frame has no field normal; did you mean n?",
        ),
        (
            format!("{head}{}", body.replace("fn response", "fn respons")),
            "models/mine.wgsl:2:4: the function response is missing; define fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms; did you name it respons?",
        ),
        (
            format!("{head}{body}@fragment\n"),
            "models/mine.wgsl:5:2: the file ends in the middle of a declaration, after `fragment`; what the attribute belongs to is missing",
        ),
        (
            format!("{head}{}", body.replace("return", "/* ä */ return")).replace("m.k_s", "m.k_d"),
            "models/mine.wgsl:3:",
        ),
        (
            format!("{head}fn response(l: vec3<f32>) -> f32 {{ return 1.0; }}"),
            "models/mine.wgsl:2:4: response must be fn response(l: vec3<f32>, v: vec3<f32>",
        ),
        (
            format!("{head}{body}fn schlick(x: f32) -> f32 {{ return x; }}"),
            "models/mine.wgsl:5:4: optics/fresnel.wgsl defines schlick too; choose another name",
        ),
        (
            format!("{head}{body}fn illuminate(x: f32) -> f32 {{ return x; }}"),
            "models/mine.wgsl:5:4: loop.wgsl defines illuminate too; choose another name",
        ),
        (
            format!("{head}{body}struct Stages {{ x: f32 }}"),
            "models/mine.wgsl:5:8: wrapper.wgsl defines Stages too",
        ),
        (
            format!("{head}{body}fn ambient_response(v: vec3<f32>) -> vec3<f32> {{ return v; }}"),
            "models/mine.wgsl:5:4: ambient_response must be fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters)",
        ),
        (
            format!("{head}#import \"none.wgsl\"\n{body}"),
            "models/mine.wgsl:2:1: there is no file `none.wgsl` to import",
        ),
    ] {
        check_wording(&said(&text));
        assert!(said(&text).contains(expected), "{text}\n{}is not\n{expected}", said(&text));
    }
}

const SHADE: &str = "return Terms(vec3(0.0), m.base_colour * cos_l, vec3(0.0));";

fn model(before: &str, body: &str) -> String {
    let rest = if body.contains("return") { "" } else { SHADE };
    format!(
        "/* lcm {{ \"parameters\": [\"base_colour\", \"k_s\", {{ \"name\": \"steps\", \"type\": \"integer\", \"max\": 8 }}] }} */\n\
         {before}fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{\n    \
         let cos_l = max(dot(frame.n, l), 0.0);\n    let h = half_vector(l, v);\n    let cos_h = max(dot(frame.n, h), 0.0);\n    \
         {body}\n    {rest}\n}}\n"
    )
}

#[test]
fn a_student_is_told_what_is_wrong_and_what_would_be_right() {
    assert_eq!(said(&model("", "")), "");
    for row in MISTAKES.trim().lines() {
        let row = row.replace('⏎', "\n");
        let [before, body, at, expected] = row.split('¦').collect::<Vec<_>>()[..] else { panic!("{row}") };
        let text = model(before, body);
        let said = said(&text);
        check_wording(&said);
        for word in ["Expression", "Function [", "Abstract", "identifier", "found \""] {
            assert!(!said.contains(word), "the compiler's own words: {said}");
        }
        assert_eq!(said.matches('`').count() % 2, 0, "{said}");
        let rest = said.strip_prefix("models/mine.wgsl:").unwrap_or_else(|| panic!("{text}\n{said}"));
        let mut parts = rest.splitn(3, ':');
        let mut number = || parts.next().and_then(|n| n.parse::<usize>().ok()).unwrap_or_default();
        let (line, column) = (number(), number());
        let line = text.lines().nth(line.wrapping_sub(1)).unwrap_or_default();
        let rest: String = line.chars().skip(column.wrapping_sub(1)).collect();
        assert!(rest.starts_with(at), "{text}\n{said}points at {rest:?}, not at {at:?}");
        assert_eq!(parts.next().map(str::trim), Some(expected), "{text}");
    }
}

#[test]
fn what_wgsl_allows_is_no_mistake() {
    for body in [
        "let x = 2 * cos_l;",
        "let x = 1 / m.steps;",
        "let c: vec3<f32> = vec3(1);",
        "if cos_l > 0 { }",
        "let x = power(cos_h, 2);",
        "let x = 1.0; if cos_l > 0.0 { let x = 2.0; }",
        "var c = vec3(0.0); c += cos_l;",
        "let c = vec3(1, 0, 0) * cos_l;",
    ] {
        assert_eq!(said(&model("", body)), "", "{body}");
    }
}

/// A student's lines before `response`, those in it, the text at the position of the message, and the
/// message.
const MISTAKES: &str = r##"
¦return Terms(0.0, m.base_colour * cos_l, vec3(0.0));¦0.0¦Terms(ambient, diffuse, specular) needs a vec3<f32> for ambient, but `0.0` is a number; write `vec3(0.0)`
¦return Terms(vec3(0.0), m.base_colour * cos_l, m.k_s);¦m.k_s¦Terms(ambient, diffuse, specular) needs a vec3<f32> for specular, but `m.k_s` is a number; write `vec3(m.k_s)`
¦return Terms(vec3(0.0), m.base_colour * cos_l);¦Terms¦Terms(ambient, diffuse, specular) takes 3 values, each a vec3<f32>, but 2 are given
¦return Terms(vec3(0.0), vec4(m.base_colour, 1.0), vec3(0.0));¦vec4¦Terms(ambient, diffuse, specular) needs a vec3<f32> for diffuse, but `vec4(m.base_colour, 1.0)` is a vec4<f32>; take its `.xyz`
¦return Terms(vec3(0), vec3(1, 2, 3), vec3(0u));¦vec3¦Terms(ambient, diffuse, specular) needs a vec3<f32> for specular, but `vec3(0u)` is a vec3<u32>; write `vec3<f32>(vec3(0u))`
¦return Terms(m.base_colour * cos_l);¦Terms¦Terms(ambient, diffuse, specular) takes 3 values, each a vec3<f32>, but 1 is given
¦let diffuse = m.base_colour * cos_l; let specular = vec3(m.k_s);⏎    return diffuse + specular;¦return¦response must return Terms(ambient, diffuse, specular), each a vec3<f32>, but `diffuse + specular` is a vec3<f32>; write `return Terms(vec3(0.0), diffuse + specular, vec3(0.0));`
¦return cos_l;¦return¦response must return Terms(ambient, diffuse, specular), each a vec3<f32>, but `cos_l` is a number; write `return Terms(vec3(0.0), vec3(cos_l), vec3(0.0));`
¦return;¦return¦response must return Terms(ambient, diffuse, specular), but this returns nothing
¦let s = power(cos_h);¦power¦power(x: f32, p: f32) takes 2 values, each a number, but 1 is given
¦let s = power(h, 2.0);¦h, 2.0);¦power(x: f32, p: f32) needs a number for x, but `h` is a vec3<f32>; to get a number from a vector, use a component such as `.x`, or `dot`, or `length`
¦let s = power(cos_h, 2u);¦2u);¦power(x: f32, p: f32) needs a number for p, but `2u` is a whole number (u32); write `f32(2u)`
¦let s = half_vector(cos_l, v);¦cos_l¦half_vector(l: vec3<f32>, v: vec3<f32>) needs a vec3<f32> for l, but `cos_l` is a number; write `vec3(cos_l)`
fn lobe(x: f32, c: vec3<f32>) -> vec3<f32> { return x * c; }⏎¦let s = lobe(m.base_colour, cos_l);¦m.base_colour¦lobe(x: f32, c: vec3<f32>) needs a number for x, but `m.base_colour` is a vec3<f32>; to get a number from a vector, use a component such as `.x`, or `dot`, or `length`
fn lobe(x: f32) { }⏎¦let s = lobe(1.0);¦lobe¦this function has no result; declare one with `-> TYPE` before its {
¦float x = 0.5;¦float¦a variable is declared with let, or with var if it changes: `let x = …;`
¦vec3<f32> c = m.base_colour;¦c = m.ba¦a variable is declared with let, or with var if it changes: `let c = …;`
¦var float x = 0.5;¦float¦the type comes after the name: `var x: f32 = …;`
¦let x = float(m.steps);¦float¦`float` is not defined; did you mean `f32`?
¦let c = vec3(m.base_colour, 1.0);¦vec3¦vec3 takes 3 numbers, or one for all, but 4 are given
¦let c = vec3(1.0, 2.0);¦vec3¦this needs 3 numbers, or one for all, but 2 are given
¦let c: vec3<f32> = vec3<i32>(1, 2, 3);¦c: vec3<¦`c` is declared as a vec3<f32>, but `vec3<i32>(1, 2, 3)` is a vec3<i32>; write `vec3<f32>(vec3<i32>(1, 2, 3))`
¦let i = 2i; let x: f32 = i;¦x: f32 =¦`x` is declared as a number, but `i` is a whole number (i32); write `f32(i)`
¦var c = vec3(0.0); c = cos_l;¦c = cos_¦`c` is a vec3<f32>, but `cos_l` is a number; write `vec3(cos_l)`
¦let c = mix(m.base_colour, 1.0, cos_l);¦1.0¦the arguments of mix(a, b, t) must have the same type, but `m.base_colour` is a vec3<f32> and `1.0` is a number; write `vec3(1.0)`
¦let c = mix(m.base_colour, vec3(1.0));¦mix¦mix(a, b, t) takes 3 values, but 2 are given
¦let c = max(m.base_colour, 0.0);¦0.0¦the arguments of max(a, b) must have the same type, but `m.base_colour` is a vec3<f32> and `0.0` is a number; write `vec3(0.0)`
¦let c = max(0.0, m.base_colour);¦m.base_colour¦the arguments of max(a, b) must have the same type, but `0.0` is a number and `m.base_colour` is a vec3<f32>; write `vec3(0.0)`
¦let c = dot(frame.n, cos_l);¦cos_l¦argument 2 of dot(a, b) is `cos_l`, a number; it must be a vector
¦let c = normalize(cos_l);¦cos_l¦argument 1 of normalize is `cos_l`, a number; it must be a vector
¦let c = pow(m.base_colour, 2.2);¦2.2¦the arguments of pow(base, exponent) must have the same type, but `m.base_colour` is a vec3<f32> and `2.2` is a number; write `vec3(2.2)`
¦let i = 2; let c = pow(i, 3);¦i, 3);¦argument 1 of pow(base, exponent) is `i`, a whole number (i32); write `f32(i)`
¦let c = saturate(frame);¦frame¦argument 1 of saturate is `frame`, a Frame; use one of its fields: `frame.n`, `frame.t` or `frame.b`
¦let c = sqrt(cos_l, 2.0);¦sqrt¦sqrt takes 1 value, but more are given
¦let x = 1.0¦1.0¦a ; is missing after `1.0`
¦return Terms(vec3(0.0), m.base_colour * cos_l, vec3(0.0))¦)¦a ; is missing after `)`
¦var x = 0.0; x++;¦x++;¦++ and -- work only on whole numbers declared with var; otherwise write `x += 1.0`
¦var x = 0; ++x;¦++x;¦write `x += 1`, or `x++` for a whole number
¦let x = cos_l > 0.0 ? 1.0 : 0.0;¦? 1.0 :¦WGSL has no ?: operator; write `select(if_false, if_true, condition)`
¦if (cos_l <= 0.0) return Terms(vec3(0.0), vec3(0.0), vec3(0.0));¦return¦a { is missing here: the bodies of functions, if, else and loops have braces
¦if cos_l { }¦if cos_l¦a condition must be true or false, but `cos_l` is a number; write `cos_l > 0`
¦var x = 1.0; if (x = 1.0) { }¦= 1.0) {¦= sets a variable; to compare, write ==
¦for (int i = 0; i < 4; i++) { }¦int¦a variable is declared with let, or with var if it changes: `let i = …;`
¦for (let i = 0; i < 4; i++) { }¦i++) { }¦++ and -- work only on whole numbers declared with var; otherwise write `i += 1.0`
¦for (var i = 0; i < m.steps; i++) { }¦i < m.st¦< cannot combine `i`, a whole number (i32), with `m.steps`, a number; write `f32(i)`
¦let x = h.xyw;¦xyw¦there is no `.xyw` here: a vec3 has the components x, y and z, or r, g and b, a number has none
¦let x = cos_l.x;¦x;¦there is no `.x` here: a vec3 has the components x, y and z, or r, g and b, a number has none
¦var x = vec3(0.0); x.xy = vec2(1.0);¦x.xy¦only one component can be set at a time, as in `x.x = …;`
¦let x = h[3];¦let¦the index 3 is too large; the first component is 0
¦let x = m.base_color;¦base_color¦no parameter base_color; did you mean base_colour?
¦let x = frame.n_dot_h;¦n_dot_h¦Frame has no field n_dot_h; a cosine is a dot product such as `dot(frame.n, l)`
¦let x = Frame.n;¦Frame.n¦`Frame` is a type or a function, not a value
¦var t: Terms; t.difuse = vec3(0.0); return t;¦difuse¦Terms has no field difuse; did you mean diffuse?
¦return Terms(vec3(0.0), base_colour * cos_l, vec3(0.0));¦base_colour¦`base_colour` is not defined; did you mean `m.base_colour`?
¦return Terms(vec3(0.0), m.base_colour * dot(N, L), vec3(0.0));¦N, L), v¦`N` is not defined; did you mean `frame.n`?
¦let x = Cos_l;¦Cos_l¦`Cos_l` is not defined; did you mean `cos_l`?
¦let x = inversesqrt(2.0);¦inversesqrt¦`inversesqrt` is not defined; did you mean `inverseSqrt`?
¦let x = mod(cos_l, 2.0);¦mod¦`mod` is not defined; did you mean `x % y`?
¦let x = atan(cos_l, 2.0);¦atan¦atan takes 1 value, but more are given; the angle of a point is atan2(y, x)
¦let x = M_PI * cos_l;¦M_PI¦`M_PI` is not defined; did you mean `PI`?
¦let self = 1.0;¦self¦`self` is a reserved word of WGSL; choose another name
¦let fn = 1.0;¦fn = 1.0¦`fn` is a reserved word of WGSL; choose another name
¦const x = cos_l * 2.0;¦cos_l¦a const may not depend on parameters or variables; declare it with let
¦const float x = 2.0;¦float¦the type comes after the name: `const x: f32 = …;`
const PI = 3.14;⏎¦¦PI = 3.1¦terms.wgsl defines PI too; choose another name
const X = fresnel(1.0);⏎¦¦fresnel¦`fresnel` is not defined; did you mean `schlick`?
¦let l = normalize(v);¦l = norm¦`l` is already defined in line 2; choose another name
¦let x = 1.0; let x = 2.0;¦x = 2.0;¦`x` is already defined in line 6; choose another name
¦let x = 1.0; x = 2.0;¦x = 2.0;¦`x` is declared with let and keeps its value; declare it with var to change it
¦l = normalize(l);¦l = norm¦`l` keeps its value, as all parameters of functions do; change a copy: `var copy = l;`
¦let i = 2; let x = i * cos_l;¦i * cos_¦* cannot combine `i`, a whole number (i32), with `cos_l`, a number; write `f32(i)`
¦let i = 3; let x = i / 2.0;¦i / 2.0;¦/ cannot combine `i`, a whole number (i32), with `2.0`, a number; write `f32(i)`
¦let x = m.base_colour + vec2(1.0);¦m.base_colour¦+ cannot combine `m.base_colour`, a vec3<f32>, with `vec2(1.0)`, a vec2<f32>
¦let x = frame + l;¦frame¦+ cannot combine `frame`, a Frame, with `l`, a vec3<f32>; use one of its fields: `frame.n`, `frame.t` or `frame.b`
¦let x = m * cos_l;¦m * cos_¦* cannot combine `m`, a Parameters, with `cos_l`, a number; use one of its fields: `m.base_colour`, `m.k_s` or `m.steps`
¦let a = mat3x3<f32>(frame.t, frame.b, frame.n); let x = a * vec4(l, 1.0);¦a * vec4¦* cannot combine `a`, a mat3x3<f32>, with `vec4(l, 1.0)`, a vec4<f32>; take its `.xyz`
¦let a = mat3(frame.t, frame.b, frame.n);¦mat3¦`mat3` is not defined; did you mean `mat3x3<f32>`?
¦let a = mat3x3<f32>(frame.t, frame.b);¦mat3x3¦a mat3x3<f32> cannot be made of these values; a matrix is made of its columns
¦if l == v { }¦if l ==¦a condition must be true or false, but `l == v` is a vec3<bool>; write `all(…)` or `any(…)` around the comparison
¦if m.base_colour > 0.5 { }¦m.base_colour¦> cannot combine `m.base_colour`, a vec3<f32>, with `0.5`, a number; compare a component or the length
¦if cos_l && cos_h { }¦if cos_l¦&& needs a comparison on both sides, such as `x > 0.0`
¦if cos_l > 0.0 & cos_h { }¦cos_l¦& cannot combine `cos_l > 0.0`, true or false, with `cos_h`, a number; write `cos_h > 0`
¦if !cos_l { }¦!cos_l¦! needs true or false, but `cos_l` is a number; write `cos_l > 0`
¦if cos_l > 0.0 and cos_h > 0.0 { }¦and¦and is written &&
¦if cos_l > 0.0 && cos_h > 0.0 && l { }¦cos_l¦&& and || need true or false, but `l` is a vec3<f32>
¦if 0.0 < cos_l < 1.0 { }¦0.0¦< cannot combine `0.0 < cos_l`, true or false, with `1.0`, a number; write `… && cos_l < 1.0`
#include "x.glsl"⏎¦¦#include¦a file is included by its name in quotation marks: `#import "file.wgsl"`
#define PI2 6.28⏎¦¦#define¦WGSL has no macros; write `const NAME = …;` or a function
#import common.wgsl⏎¦¦#import¦a file is included by its name in quotation marks: `#import "file.wgsl"`
uniform float foo;⏎¦¦uniform¦the only inputs of a model are its parameters: declare them in the comment at the top, and read them as `m.NAME`
float lobe(float x) { return x; }⏎¦¦float¦a function begins with fn and a constant with const: `fn lobe(x: f32) -> f32 { … }`
fn lobe(float x) -> f32 { return x; }⏎¦¦float¦the type comes after the name: `x: f32`
fn lobe(x) -> f32 { return x; }⏎¦¦) -> f32¦`x` needs a type: `x: f32`
fn lobe(x: f32) { return x; }⏎¦¦return¦lobe declares no result, but returns a number; write `-> TYPE` before its {
fn lobe(x: f32) -> vec3<f32> { return x; }⏎¦¦return¦lobe must return a vec3<f32>, but `x` is a number; write `vec3(x)`
fn lobe(x: f32): f32 { return x; }⏎¦¦: f32 {¦the type of a result comes after ->: `-> f32`
fn lobe(x: float) -> float { return x; }⏎¦¦float¦`float` is not defined; did you mean `f32`?
fn lobe(x: vec3) -> f32 { return x.x; }⏎¦¦vec3¦the type `vec3` needs the type of its numbers: `vec3<f32>`
fn lobe(x: f32) -> void { }⏎¦¦void¦WGSL has no void; a function without a result has no ->
fn lobe(x: f32) -> f32 { return lobe(x - 1.0); }⏎¦¦lobe¦`lobe` uses itself; WGSL has no recursion, so write a loop
fn f32(x: i32) -> f32 { return 1.0; }⏎¦¦f32(x¦`f32` is the name of a type of WGSL; choose another name
fn vec3f() -> vec3f { return vec3(1.0); }⏎¦¦vec3f()¦`vec3f` is the name of a type of WGSL; choose another name
fn aa(x: f32) -> f32 { return bb(x); }⏎fn bb(x: f32) -> f32 { return aa(x); }⏎¦¦bb(x); }¦`aa` uses itself through others; WGSL has no recursion, so write a loop
¦loop { }¦loop¦this loop has no end: nothing in it leaves it
¦var x = 1.0; while cos_l > 0.0 { x += 1.0; }¦while¦this loop ends in its first iteration or never: nothing in its condition changes
¦let x = cos_l / 0.0;¦cos_l¦this divides by zero
struct A { float x; };⏎¦¦float¦the type comes after the name: `x: f32`
struct A { x: f32; y: f32 }⏎¦¦; y: f32¦a comma belongs here
¦let a = [1.0, 2.0];¦[1.0,¦a list is written `array(…)`
¦var a = array<f32, 2>(1.0, 2.0); let x = a[m.steps];¦a[m.step¦an index is a whole number, but `m.steps` is a number; write `i32(m.steps)`
¦var x;¦x;¦`x` needs a value or a type: `var x = 0.0;` or `var x: f32;`
¦let x: f32;¦;¦a let needs its value here; what gets one later is declared with var
¦let θ = 1.0; let x = 2·θ;¦2·θ;¦an operator or a ; is missing after `2`
¦let x = cos_l ^ 2;¦cos_l¦^ cannot combine `cos_l`, a number, with `2`, a number; a power is `pow(cos_l, 2)`
¦let x = cos_l ** 2.0;¦* 2.0;¦a value is missing before this *; a power is `pow(x, y)`
¦max(cos_l, 0.0);¦max¦the result of this call is not used; give it a name: `let x = …;`
¦let x = max(cos_l, 0.0));¦);¦this ) closes nothing
¦let x = max(cos_l 0.0);¦0.0¦an operator, a comma or a ) is missing after `cos_l`
¦let x = max(cos_l, 0,0);¦max¦max(a, b) takes 2 values, but more are given
¦let x = -frame;¦-frame;¦- needs a number, but `frame` is a Frame; use one of its fields: `frame.n`, `frame.t` or `frame.b`
¦let x = 2cos_l;¦2cos_l¦an operator or a ; is missing after `2`
fn lobe(out x: f32) { }⏎¦¦x: f32)¦parameters have no `out` in WGSL: they are read-only, and results are returned
fn lobe(x: inout f32) { }⏎¦¦f32¦parameters have no `inout` in WGSL: they are read-only, and results are returned
fn lobe(x: ptr<function, f32>) { *x = 1.0; }⏎¦var y = 0.0; lobe(y);¦y);¦lobe(x: ptr<function, f32>) needs a ptr<function, f32> for x, but `y` is a number; write `&y`
fn lobe(x: f32) -> f32 { x = 1.0; return x; }⏎¦¦x = 1.0;¦`x` keeps its value, as all parameters of functions do; change a copy: `var copy = x;`
¦let x = select(cos_l > 0.0, 1.0, 0.0);¦cos_l¦the condition of select comes last: `select(if_false, if_true, condition)`, and both values have one type
¦switch m.steps { case 0: { } default: { } }¦m.steps¦a switch needs a whole number; write `i32(…)`, or if and else
¦break;¦break¦break can only stand in a loop or a switch
¦let x = fresnell(cos_l);¦fresnell¦`fresnell` is not defined; did you mean `schlick`?
¦let x = fresnel_schlick(cos_l, 0.04);¦fresnel_schlick¦`fresnel_schlick` is not defined; did you mean `schlick`?
¦let x = schlick(0.04, cos_l);¦0.04¦schlick(f0: vec3<f32>, cos_i: f32) needs a vec3<f32> for f0, but `0.04` is a number; write `vec3(0.04)`
¦let x = dpdx(cos_l);¦dpdx¦`dpdx` is not available to a model, which is evaluated without a picture too
¦let x = 1e400;¦1e400¦1e400 is too large
¦let r = reflect(-l, frame.n); let x = pow(max(dot(r, v), 0), m.shininess);¦shininess¦no parameter shininess; the model declares base_colour, k_s and steps
¦let __x = 1.0;¦__x¦`__x` begins with two underscores, which are reserved; choose another name
fn lobe(x: f32) -> f32 { return x * m.k_s; }⏎¦¦m.k_s¦lobe has no parameter m; declare it: `fn lobe(…, m: Parameters)`
¦let x = vec3(1.0) * 2.0 +;¦;¦a value is missing before `;`
¦return Terms { ambient: vec3(0.0) };¦{ ambien¦a struct is made with round brackets: `Terms(…)`
¦let x = frame.n.normalize();¦();¦WGSL has no methods; write `normalize(…)` with the value in the brackets
¦let x = l.dot(frame.n);¦(frame.n);¦WGSL has no methods; write `dot(…)` with the value in the brackets
¦x = 1.0;¦x = 1.0;¦`x` is not defined
¦let a, b = 1.0;¦, b = 1.¦each let declares one name
¦var x: f32 = vec3(1.0);¦x: f32 =¦`x` is declared as a number, but `vec3(1.0)` is a vec3<f32>; to get a number from a vector, use a component such as `.x`, or `dot`, or `length`
¦fn inner() { }¦inner¦a function cannot be defined within another one
¦let x = if cos_l > 0.0 { 1.0 } else { 0.0 };¦cos_l¦if has no value in WGSL; write `select(if_false, if_true, condition)`
¦let x = smoothstep(0, 1, l);¦l);¦the arguments of smoothstep(low, high, x) must have the same type, but `0` is a number and `l` is a vec3<f32>; write `vec3(0)`
¦let x = cos_l as f32;¦as f32;¦a value changes its type by the name of the type: `f32(x)`
¦let x = f32(l);¦l);¦a value of type vec3<f32> cannot become f32; use a component such as `.x`, or `dot`, or `length`
¦let x = vec3<f32>(l, v);¦vec3¦vec3 takes 3 numbers, or one for all, but 6 are given
¦for (var i = 0; i < 3; i += 1.0) { }¦1.0¦this must be a whole number (i32), but `1.0` is a number; a var that begins as `1.0` instead of `1` is a number
¦var a: array<f32>;¦var¦`a` cannot have this type; an array needs its length: `array<f32, 3>`
¦return (vec3(0.0), m.base_colour * cos_l, vec3(0.0));¦, m.base¦these brackets hold several values; put what they make before them, such as `Terms` or `vec3`
¦return vec4(m.base_colour, 1.0);¦return¦response must return Terms(ambient, diffuse, specular), each a vec3<f32>, but `vec4(m.base_colour, 1.0)` is a vec4<f32>; write `return Terms(vec3(0.0), …, vec3(0.0));`
¦let x = cos_l > 0.0 and true;¦and¦and is written &&
¦let x = not true;¦true¦not is written !
var<private> a: f32 = 1;⏎var b: f32;⏎¦¦var¦a variable outside functions is declared with `var<private> b`
fn lobe(x: f32, x: f32) -> f32 { return x; }⏎¦¦x: f32)¦`x` is already defined in line 2; choose another name
fn dot(x: f32) -> f32 { return x; }⏎¦¦dot¦`dot` is a function of WGSL; choose another name
struct Parameters { a: f32 }⏎¦¦Parameters¦Parameters is defined by the declaration of the model; choose another name
fn helper(x : f32) -> f32 {⏎  return x⏎}⏎¦¦x¦a ; is missing after `x`
fn helper(x : f32) -> {⏎  return x;⏎}⏎¦¦{¦the type of the result is missing after ->
fn helper(x : f32) f32 {⏎  return x;⏎}⏎¦¦f32¦the type of a result comes after ->: `-> f32`
func helper(x : f32) -> f32 {⏎  return x;⏎}⏎¦¦func¦a function begins with fn: `fn helper(x: f32) -> f32 { … }`
¦let x = 1,5;¦,5;¦a comma cannot stand here; decimals have a point, as in `1.5`
¦let x = vec2(1.0), 2.0);¦, 2.0);¦a comma cannot stand here; is there one `)` too many before it?
¦let x := 1.0;¦= 1.0;¦write = instead of :=
¦let x == 1.0;¦== 1.0;¦a value is set with a single =
¦cos_l == 1.0;¦== 1.0;¦this is not a statement: a statement sets a var or calls a function
¦cos_l;¦;¦this is not a statement: a statement sets a var or calls a function
¦let x = M.base_colour;¦M.base_colour¦`M` is not defined; did you mean `m`?
¦let x = mix(0.0, 1.0, true);¦true¦argument 3 of mix(a, b, t) is `true`, true or false; write `select(0.0, 1.0, true)`
¦let x = select(0.0, 1.0, cos_l);¦select¦the condition of select must be true or false, but `cos_l` is a number; write `cos_l > 0`
¦let x = i32(cos_l) + 0.5;¦i32¦+ cannot combine `i32(cos_l)`, a whole number (i32), with `0.5`, a number; write `f32(i32(cos_l))`
¦var x = 1; x = 0.5;¦0.5¦`x` is a whole number (i32), but `0.5` is a number; a var that begins as `1.0` instead of `1` is a number
¦var x = 1; x = cos_l;¦x = cos_¦`x` is a whole number (i32), but `cos_l` is a number; write `i32(cos_l)`
¦var x = 1; x += cos_l;¦x += cos¦`x` is a whole number (i32), but `cos_l` is a number; write `i32(cos_l)`
"##;
