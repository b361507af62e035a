//! Small functions with known answers.

use naga::{
    front::wgsl,
    valid::{Capabilities, ValidationFlags, Validator},
};

use super::*;

mod random;

fn module(text: &str) -> Module {
    let module = wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
    Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
    module
}

/// True if a text is valid WGSL.
fn valid(text: &str) -> bool {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    wgsl::parse_str(text).is_ok_and(|module| validator.validate(&module).is_ok())
}

/// The program of `fn f`.
fn program(text: &str) -> Program {
    Program::new(&module(text), "f").unwrap_or_else(|e| panic!("{e}: {text}"))
}

fn run(text: &str, arguments: &[u32]) -> Vec<u32> {
    let program = program(text);
    assert_eq!(program.argument_words(), arguments.len(), "{text}");
    let mut results = vec![0; program.result_words()];
    program.run(arguments, &mut results).expect("it ends");
    results
}

fn floats(text: &str, arguments: &[f32]) -> Vec<f32> {
    let arguments: Vec<_> = arguments.iter().map(|a| a.to_bits()).collect();
    run(text, &arguments).into_iter().map(f32::from_bits).collect()
}

fn ints(text: &str, arguments: &[i32]) -> Vec<i32> {
    let arguments: Vec<_> = arguments.iter().map(|a| a.cast_unsigned()).collect();
    run(text, &arguments).into_iter().map(u32::cast_signed).collect()
}

/// Asserts the value of an expression of the floats `a` and `b`, also with literal arguments, which naga folds where it
/// can.
fn of_floats(expression: &str, [a, b]: [f32; 2], expected: &[f32]) {
    let kind = if expected.len() == 1 { "f32".to_owned() } else { format!("vec{}<f32>", expected.len()) };
    let text = format!("fn f(a: f32, b: f32) -> {kind} {{ return {expression}; }}");
    let got = floats(&text, &[a, b]);
    assert_eq!(got.len(), expected.len());
    for (g, e) in got.iter().zip(expected) {
        assert!(
            (g - e).abs() <= 2e-6 * e.abs().max(1e-3),
            "{expression} of {a}, {b}: {got:?}, not {expected:?}"
        );
    }
}

fn of_ints(expression: &str, [a, b]: [i32; 2], expected: i32) {
    let text = format!("fn f(a: i32, b: i32) -> i32 {{ return {expression}; }}");
    assert_eq!(ints(&text, &[a, b]), [expected], "{expression} of {a}, {b}");
}

fn of_words(expression: &str, [a, b]: [u32; 2], expected: u32) {
    let text = format!("fn f(a: u32, b: u32) -> u32 {{ return {expression}; }}");
    assert_eq!(run(&text, &[a, b]), [expected], "{expression} of {a}, {b}");
}

#[test]
fn arithmetic_of_floats() {
    of_floats("a + b * 2.0 - a / b", [3.0, 4.0], &[10.25]);
    of_floats("-a % b", [7.5, 2.0], &[-1.5]);
    of_floats("select(a, b, a < b) + select(0.0, 8.0, a >= b)", [3.0, 4.0], &[4.0]);
    of_floats(
        "select(0.0, 1.0, a > b) + select(0.0, 2.0, a <= b) + select(0.0, 4.0, a == b) + select(0.0, 8.0, a != b)",
        [3.0, 3.0],
        &[6.0],
    );
    of_floats("f32(!(a < b || a > b) && a == b)", [3.0, 3.0], &[1.0]);
    of_floats("fma(a, b, 1.0) + abs(-a) + sign(-b) + saturate(a)", [3.0, 4.0], &[16.0]);
    of_floats("min(a, b) + 10.0 * max(a, b) + clamp(9.0, a, b)", [3.0, 4.0], &[47.0]);
    of_floats("ceil(a) + 10.0 * floor(b) + 100.0 * trunc(-a)", [2.25, -2.25], &[3.0 - 30.0 - 200.0]);
    of_floats("vec4(round(a), round(b), fract(a), fract(-b))", [2.5, 3.5], &[2.0, 4.0, 0.5, 0.5]);
    of_floats("vec3(step(a, b), step(b, a), step(a, a))", [1.0, 2.0], &[1.0, 0.0, 1.0]);
    // Swapped bounds, and an edge without width.
    of_floats(
        "vec3(clamp(a, b, 1.5), smoothstep(a, a, a), smoothstep(a, a, b))",
        [1.0, 2.0],
        &[1.5, 0.0, 1.0],
    );
    of_floats("vec2(mix(a, b, 0.25), smoothstep(a, b, 2.5))", [2.0, 4.0], &[2.5, 0.15625]);
    of_floats("vec2(ldexp(a, 3), ldexp(b, -2))", [1.5, 6.0], &[12.0, 1.5]);
    of_floats(
        "vec4(modf(a).fract, modf(a).whole, frexp(b).fract, f32(frexp(b).exp))",
        [-1.25, 10.0],
        &[-0.25, -1.0, 0.625, 4.0],
    );
}

#[test]
fn functions_of_floats() {
    let (a, b) = (0.4f32, 0.7f32);
    for (expression, expected) in [
        ("sin(a)", a.sin()),
        ("cos(a)", a.cos()),
        ("tan(a)", a.tan()),
        ("asin(a)", a.asin()),
        ("acos(a)", a.acos()),
        ("atan(a)", a.atan()),
        ("atan2(a, -b)", a.atan2(-b)),
        ("sinh(a)", a.sinh()),
        ("cosh(a)", a.cosh()),
        ("tanh(a)", a.tanh()),
        ("asinh(a)", a.asinh()),
        ("acosh(a + 1.0)", (a + 1.0).acosh()),
        ("atanh(a)", a.atanh()),
        ("exp(a)", a.exp()),
        ("exp2(a)", a.exp2()),
        ("log(a)", a.ln()),
        ("log2(a)", a.log2()),
        ("pow(a, b)", a.powf(b)),
        ("sqrt(a)", a.sqrt()),
        ("inverseSqrt(a)", 1.0 / a.sqrt()),
        ("radians(a)", a.to_radians()),
        ("degrees(a)", a.to_degrees()),
    ] {
        of_floats(expression, [a, b], &[expected]);
    }
}

#[test]
fn geometry() {
    of_floats("dot(vec3(a, b, 2.0), vec3(5.0, 6.0, 7.0))", [3.0, 4.0], &[53.0]);
    of_floats("cross(vec3(a, b, 2.0), vec3(5.0, 6.0, 7.0))", [3.0, 4.0], &[16.0, -11.0, -2.0]);
    of_floats(
        "vec3(length(vec2(a, b)), length(-a), distance(vec2(a, b), vec2(0.0, 8.0)))",
        [3.0, 4.0],
        &[5.0, 3.0, 5.0],
    );
    of_floats("normalize(vec2(a, b))", [3.0, 4.0], &[0.6, 0.8]);
    of_floats("reflect(vec2(a, b), vec2(0.0, 1.0))", [3.0, 4.0], &[3.0, -4.0]);
    of_floats("refract(vec2(a, -b), vec2(0.0, 1.0), 0.5)", [0.6, 0.8], &[0.3, -(1.0f32 - 0.09).sqrt()]);
    of_floats("refract(vec2(a, -b), vec2(0.0, 1.0), 2.0)", [0.6, 0.8], &[0.0, 0.0]);
    of_floats("faceForward(vec2(a, b), vec2(1.0, 0.0), vec2(a, b))", [3.0, 4.0], &[-3.0, -4.0]);
    of_floats("faceForward(vec2(a, b), vec2(-1.0, 0.0), vec2(a, b))", [3.0, 4.0], &[3.0, 4.0]);
}

#[test]
fn vectors_and_matrices() {
    of_floats("vec3(a, b, 2.0).zyx.xz", [3.0, 4.0], &[2.0, 3.0]);
    of_floats("vec3(a) * vec3(1.0, 2.0, 3.0) + b", [3.0, 4.0], &[7.0, 10.0, 13.0]);
    of_floats("a * vec2(1.0, b) / 2.0", [3.0, 4.0], &[1.5, 6.0]);
    of_floats("select(vec2(a), vec2(b), vec2(a, b) < vec2(3.5))", [3.0, 4.0], &[4.0, 3.0]);
    of_floats(
        "f32(all(vec2(a, b) > vec2(0.0))) + 2.0 * f32(any(vec2(a, b) > vec2(3.5)))",
        [3.0, 4.0],
        &[3.0],
    );
    // Columns (1, 2), (3, 4), (5, 6): three columns of two rows.
    let m = "mat3x2<f32>(1.0, 2.0, a, b, 5.0, 6.0)";
    of_floats(&format!("{m} * vec3(1.0, 10.0, 100.0)"), [3.0, 4.0], &[531.0, 642.0]);
    of_floats(&format!("vec2(1.0, 10.0) * {m}"), [3.0, 4.0], &[21.0, 43.0, 65.0]);
    of_floats(&format!("({m} * 2.0 + {m} - {m})[1]"), [3.0, 4.0], &[6.0, 8.0]);
    of_floats(&format!("transpose({m})[1]"), [3.0, 4.0], &[2.0, 4.0, 6.0]);
    of_floats(&format!("({m} * mat2x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 1.0))[1]"), [3.0, 4.0], &[8.0, 10.0]);
    of_floats("determinant(mat2x2<f32>(a, b, 1.0, 2.0))", [3.0, 4.0], &[2.0]);
    of_floats("determinant(mat3x3<f32>(a, 1.0, 2.0, 0.0, b, 5.0, 1.0, 0.0, 6.0))", [3.0, 4.0], &[69.0]);
    of_floats(
        "determinant(mat4x4<f32>(a, 0.0, 0.0, 1.0, 0.0, b, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 5.0, 0.0, 0.0, 2.0))",
        [3.0, 4.0],
        &[8.0],
    );
}

#[test]
fn whole_numbers_wrap_and_never_trap() {
    let (least, most) = (i32::MIN, i32::MAX);
    of_ints("a + b", [most, 1], least);
    of_ints("a - b", [least, 1], most);
    of_ints("a * b", [most, 2], -2);
    of_ints("-a", [least, 0], least);
    of_ints("abs(a)", [least, 0], least);
    of_ints("a / b", [7, 0], 7);
    of_ints("a % b", [7, 0], 0);
    of_ints("a / b", [least, -1], least);
    of_ints("a % b", [least, -1], 0);
    of_ints("a / b", [-7, 2], -3);
    of_ints("a % b", [-7, 2], -1);
    of_ints("a << u32(b)", [1, 33], 2);
    of_ints("a >> u32(b)", [-8, 1], -4);
    of_ints("min(a, b) * 10 + max(a, b)", [-2, 1], -19);
    of_ints("clamp(a, -1, b)", [-7, 2], -1);
    of_ints("sign(a) + 10 * sign(b)", [-7, 0], -1);
    of_ints("(a & b) + 100 * (a | b) + 10000 * (a ^ b)", [6, 3], 2 + 700 + 50000);
    of_ints("~a", [5, 0], -6);
    of_ints("dot(vec2(a, b), vec2(b, a))", [2, 3], 12);
    of_words("a / b", [7, 0], 7);
    of_words("a % b", [7, 0], 0);
    of_words("a >> b", [0x8000_0000, 31], 1);
    of_words("a - b", [0, 1], u32::MAX);
    of_words("min(a, b) + max(a, b) + abs(a)", [u32::MAX, 2], 0);
    // Words that would be NaN as floats.
    for word in [0x7f80_0001, 0xffff_ffff, 0x7fc0_1234] {
        of_words("select(b, a, a > 0u)", [word, 1], word);
        assert_eq!(
            run("var<private> p: u32; fn f(a: u32) -> u32 { p = a; let q = p; p = 1; return q; }", &[word]),
            [word]
        );
    }
    of_words("select(0u, 1u, a < b)", [0x8000_0000, 1], 0);
    of_ints("select(0, 1, a < b)", [least, 1], 1);
}

#[test]
fn bits() {
    of_words(
        "countOneBits(a) + 100u * countLeadingZeros(a) + 10000u * countTrailingZeros(a)",
        [0xf0, 0],
        42404,
    );
    of_words("firstLeadingBit(a) + 100u * firstTrailingBit(a)", [0xf0, 0], 407);
    of_words("firstLeadingBit(a) & firstTrailingBit(a)", [0, 0], u32::MAX);
    of_ints("firstLeadingBit(a)", [-1, 0], -1);
    of_ints("firstLeadingBit(a)", [-256, 0], 7);
    of_words("reverseBits(a)", [1, 0], 0x8000_0000);
    of_words("extractBits(a, 4u, 8u)", [0xabcd, 0], 0xbc);
    of_ints("extractBits(a, 4u, 8u)", [0xabcd, 0], 0xbc - 256);
    of_words("extractBits(a, b, 8u)", [0xabcd, 40], 0);
    of_words("extractBits(a, b, 40u)", [0xabcd, 0], 0xabcd);
    of_words("insertBits(a, b, 4u, 8u)", [0xffff, 0x1ab], 0xfabf);
    of_words("insertBits(a, b, 32u, 8u)", [0xffff, 0x1ab], 0xffff);
    of_words("insertBits(a, b, 0u, 32u)", [0xffff, 0x1ab], 0x1ab);
}

#[test]
fn casts() {
    of_ints("i32(f32(a) * 0.5)", [-7, 0], -3);
    of_ints("i32(f32(a) * 1e20)", [-7, 0], i32::MIN);
    of_words("u32(f32(a) - 5.0)", [3, 0], 0);
    of_words("u32(f32(a) * 1e20)", [3, 0], u32::MAX);
    of_words("u32(bool(a)) + 10u * u32(bool(b))", [7, 0], 1);
    of_words("bitcast<u32>(f32(a))", [1, 0], 0x3f80_0000);
    of_ints("bitcast<i32>(u32(a))", [-1, 0], -1);
    of_ints("i32(bool(f32(a) * 0.1))", [1, 0], 1);
    of_floats("f32(u32(a)) + f32(i32(-b)) + f32(a < b)", [3.7, 4.7], &[0.0]);
}

/// The sum of a loop's work, as a function of the number of iterations.
fn counted(body: &str, turns: i32) -> i32 {
    ints(&format!("fn f(n: i32) -> i32 {{ var sum = 0; {body} return sum; }}"), &[turns])[0]
}

#[test]
fn loops() {
    assert_eq!(counted("for (var i = 0; i < n; i++) { sum += i; }", 5), 10);
    assert_eq!(counted("for (var i = 0; i < n; i++) { sum += i; }", 0), 0);
    assert_eq!(counted("var i = 0; while i < n { i += 2; sum += i; }", 5), 12);
    // Continue leads to the continuing block, break past it.
    let text = "var i = 0; loop { if i == 2 { continue; } if i > 4 { break; } sum += i; continuing { i++; sum += 100; } }";
    assert_eq!(counted(text, 0), 508);
    assert_eq!(counted("var i = 0; loop { sum += i; continuing { i++; break if i >= n; } }", 4), 6);
    assert_eq!(counted("var i = 0; loop { sum += i; continuing { i++; break if i >= n; } }", -4), 0);
    // A break in an inner loop or switch leaves only that; a continue in a switch continues the loop.
    let text = "for (var i = 0; i < n; i++) { for (var j = 0; j < n; j++) { if j > i { break; } if j == 1 { continue; } sum += 10 * i + j; } sum += 1000; }";
    let mut expected = 0;
    for i in 0..4 {
        for j in 0..=i {
            expected += if j == 1 { 0 } else { 10 * i + j };
        }
        expected += 1000;
    }
    assert_eq!(counted(text, 4), expected);
    let text = "for (var i = 0; i < n; i++) { switch i { case 1: { continue; } case 2: { break; } default: { sum += 1; } } sum += 100; }";
    assert_eq!(counted(text, 4), 302);
    // A variable declared with a value in a loop gets it in every iteration.
    assert_eq!(counted("for (var i = 0; i < n; i++) { var x = 1; x += i; sum += x; }", 3), 6);
    // A function that returns from within a loop.
    let text =
        "fn find(n: i32) -> i32 { for (var i = 0; i < 10; i++) { if i * i >= n { return i; } } return -1; }
        fn f(a: i32, b: i32) -> i32 { return 100 * find(a) + find(b); }";
    assert_eq!(ints(text, &[10, 1000]), [399]);
}

#[test]
fn values_last_while_variables_change() {
    // A swap through values that were read before.
    assert_eq!(
        floats("fn f(a: f32, b: f32) -> vec2<f32> { var v = vec2(a, b); v = v.yx; return v; }", &[1.0, 2.0]),
        [2.0, 1.0]
    );
    assert_eq!(
        floats("fn f(a: f32) -> f32 { var x = a; let y = x; x = 5.0; return 10.0 * y + x; }", &[1.0]),
        [15.0]
    );
    // Read before a loop, used in and after it.
    let text =
        "var x = n; let y = x; for (var i = 0; i < 3; i++) { x += 1; sum += y; } sum += 10 * y + 100 * x;";
    assert_eq!(counted(text, 1), 3 + 10 + 400);
    let text = "var x = n; for (var i = 0; i < 3; i++) { let y = x; x = x * 2; sum += y; }";
    assert_eq!(counted(text, 1), 7);
    // Read before a loop, and used only in it, before the variable changes there.
    let text = "var x = n; let y = x; for (var i = 0; i < 3; i++) { sum += y * 2; x += 1; }";
    assert_eq!(counted(text, 1), 6);
    // Assigned in every iteration to a variable that changes there.
    let text = "var x = 0; let y = n * 3; var i = 0; loop { x = y; sum += x; x += 1; sum += x; continuing { i++; break if i >= 3; } }";
    assert_eq!(counted(text, 2), 39);
    assert_eq!(counted(&text.replace("loop {", "loop { sum += 1;"), 2), 42);
    // Adjacent words, one of them in a branch.
    let text = "fn f(v: vec3<i32>) -> vec3<i32> { var w: vec3<i32>; if v.x > 0 { w.x = v.x; } w.y = v.y; w.z = v.z; return w; }";
    assert_eq!(ints(text, &[-1, 2, 3]), [0, 2, 3]);
    assert_eq!(ints(text, &[1, 2, 3]), [1, 2, 3]);
    // Through a function that returns its argument, and by a pointer.
    let text = "fn same(x: i32) -> i32 { return x; }
        fn f(n: i32) -> i32 { var x = n; let y = same(x); x = 7; return 10 * y + x; }";
    assert_eq!(ints(text, &[1]), [17]);
    let text = "fn add(x: ptr<function, i32>, y: i32) -> i32 { *x += y; return y; }
        fn f(n: i32) -> i32 { var x = n; let y = x; let z = add(&x, x); return 100 * y + 10 * z + x; }";
    assert_eq!(ints(text, &[3]), [336]);
}

#[test]
fn branches_and_switches() {
    let text = "fn f(a: i32) -> i32 {
        switch a { case 1, 2: { return 10; } case -1: { if a < 0 { break; } return 5; } case 3: {} default: { return 20; } }
        return 30; }";
    for (a, expected) in [(1, 10), (2, 10), (-1, 30), (3, 30), (4, 20), (-2, 20)] {
        assert_eq!(ints(text, &[a]), [expected], "{a}");
    }
    let text =
        "fn f(a: u32) -> u32 { switch a { default: { return 1u; } case 4294967295u: { return 2u; } } }";
    assert_eq!((run(text, &[0]), run(text, &[u32::MAX])), (vec![1], vec![2]));
    let text = "fn f(a: i32) -> i32 { var x = 0; if a > 0 { x = 1; if a > 5 { x += 10; } else if a > 3 { x += 20; } } else { x = 2; } return x; }";
    for (a, expected) in [(9, 11), (4, 21), (1, 1), (0, 2)] {
        assert_eq!(ints(text, &[a]), [expected], "{a}");
    }
    // Results of one branch are unknown in another.
    let text = "fn f(a: f32, b: f32) -> f32 { var x = 0.0; if a > 0.0 { x = a * b; } else { x = 1.0 + a * b; } return x + a * b; }";
    assert_eq!(floats(text, &[2.0, 3.0]), [12.0]);
    assert_eq!(floats(text, &[-2.0, 3.0]), [-11.0]);
    // The second operand is not evaluated if the first decides.
    let text = "var<private> n: i32;
        fn count() -> bool { n++; return true; }
        fn f(a: bool) -> i32 { let x = a && count(); let y = a || count(); return n; }";
    assert_eq!((run(text, &[0]), run(text, &[1])), (vec![1], vec![1]));
}

#[test]
fn shadowing_and_scopes() {
    let text = "fn f(a: i32) -> i32 { let x = a; var y = x; { let x = 2 * a; y += x; { var y = 7; y = x; } } return 100 * x + y; }";
    assert_eq!(ints(text, &[3]), [309]);
}

#[test]
fn structs_and_arrays() {
    let text = "struct Inner { a: vec3<f32>, b: f32 } struct Outer { x: f32, inner: array<Inner, 2>, ok: bool }
        fn make(x: f32) -> Outer { return Outer(x, array(Inner(vec3(x, 2.0, 3.0), 4.0), Inner(vec3(5.0), 6.0)), true); }
        fn f(o: Outer, i: i32) -> Outer { var p = make(o.x); p.inner[i].a.y = o.inner[1].b; p.inner[1 - i] = o.inner[i]; p.ok = !o.ok; return p; }";
    let mut arguments: Vec<u32> = (0..9).map(|i| (10.0 + i as f32).to_bits()).collect();
    arguments.extend([1, 1]);
    let results = run(text, &arguments);
    let floats: Vec<_> = results[..9].iter().map(|w| f32::from_bits(*w)).collect();
    assert_eq!(floats, [10.0, 15.0, 16.0, 17.0, 18.0, 5.0, 18.0, 5.0, 6.0]);
    assert_eq!(results[9], 0);
    assert_eq!(
        ints(
            "fn f(a: i32) -> i32 { var x: array<array<i32, 3>, 2>; x[1][a] = 5; x[a - 1][1] += 3; return x[0][1] + 10 * x[1][2] + 100 * x[1][1]; }",
            &[2]
        ),
        [350]
    );
}

#[test]
fn indices_out_of_range_mean_the_last_element() {
    let text = "const TABLE = array<i32, 4>(2, 3, 5, 7); fn f(i: i32) -> i32 { return TABLE[i]; }";
    for (i, expected) in [(0, 2), (2, 5), (3, 7), (4, 7), (i32::MAX, 7), (-1, 7)] {
        assert_eq!(ints(text, &[i]), [expected], "{i}");
    }
    let text = "fn f(i: i32) -> vec4<i32> { var v = vec4(0); v[i] = 1; v[1] += 10; return v; }";
    assert_eq!(ints(text, &[0]), [1, 10, 0, 0]);
    assert_eq!(ints(text, &[99]), [0, 10, 0, 1]);
    assert_eq!(ints("fn f(v: vec3<i32>, i: u32) -> i32 { return v[i]; }", &[4, 5, 6, 1]), [5]);
    let text = "fn f(i: u32) -> vec2<f32> { var m = mat3x2<f32>(1.0, 2.0, 3.0, 4.0, 5.0, 6.0); m[i][1] = 9.0; return m[i]; }";
    assert_eq!(run(text, &[1]), [3.0f32.to_bits(), 9.0f32.to_bits()]);
    assert_eq!(run(text, &[7]), [5.0f32.to_bits(), 9.0f32.to_bits()]);
}

#[test]
fn pointers() {
    let text = "fn swap(a: ptr<function, vec2<i32>>, b: ptr<function, i32>) { let t = (*a).x; (*a).x = *b; *b = t; }
        fn twice(a: ptr<function, vec2<i32>>, b: ptr<function, i32>) { swap(a, b); swap(a, b); (*a).y *= 2; }
        fn f(x: i32, y: i32) -> vec3<i32> { var v = vec2(x, y); var w = 5; swap(&v, &w); twice(&v, &w); let p = &v; *p += 1; return vec3(v, w); }";
    assert_eq!(ints(text, &[1, 2]), [6, 5, 1]);
}

#[test]
fn private_variables_are_fresh_in_every_run() {
    let text = "var<private> n: i32 = 40; var<private> zero: vec2<i32>;
        fn next() -> i32 { n += 1; zero.y += n; return n; }
        fn f() -> vec3<i32> { let a = next(); let b = next(); return vec3(a, b, zero.x + zero.y); }";
    let program = program(text);
    let mut results = [0; 3];
    for _ in 0..3 {
        program.run(&[], &mut results).expect("it ends");
        assert_eq!(results, [41, 42, 83]);
    }
}

#[test]
fn programs_do_not_disturb_each_other() {
    let [a, b] = ["1.5", "2.5"].map(|c| program(&format!("fn f(x: f32) -> f32 {{ return x * {c}; }}")));
    let mut result = [0];
    for _ in 0..3 {
        a.run(&[2.0f32.to_bits()], &mut result).expect("it ends");
        assert_eq!(f32::from_bits(result[0]), 3.0);
        b.run(&[2.0f32.to_bits()], &mut result).expect("it ends");
        assert_eq!(f32::from_bits(result[0]), 5.0);
    }
    // From several threads at once.
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let mut result = [0];
                a.run(&[2.0f32.to_bits()], &mut result).expect("it ends");
                assert_eq!(f32::from_bits(result[0]), 3.0);
            });
        }
    });
}

#[test]
fn constants_of_the_module() {
    let text = "const A = 2.0; const B: f32 = A * 3.0; const V = vec3(B); struct S { v: vec3<f32>, n: i32 }
        const C = S(V, 7); const D = array<S, 2>(C, S());
        fn f(i: i32) -> f32 { const LOCAL = B + 1.0; return C.v.y + LOCAL + f32(D[i].n); }";
    assert_eq!(run(text, &[0]), [20.0f32.to_bits()]);
    assert_eq!(run(text, &[1]), [13.0f32.to_bits()]);
}

#[test]
fn missing_arguments_are_zero_and_results_written_as_far_as_there_is_room() {
    let program = program("fn f(a: i32, b: i32) -> vec2<i32> { return vec2(a + 1, b + 2); }");
    let mut results = [9];
    program.run(&[5], &mut results).expect("it ends");
    assert_eq!(results, [6]);
    let mut results = [9; 3];
    program.run(&[5, 6, 7], &mut results).expect("it ends");
    assert_eq!(results, [6, 8, 9]);
}

#[test]
fn endless_loops_are_stopped() {
    for text in [
        "fn f() { loop { if false { break; } } }",
        "fn f() -> i32 { var i = 0; while i >= 0 { i = (i + 1) % 7; } return i; }",
        "fn f() { var i = 1; loop { i += 2; continuing { break if i == 0; } } }",
    ] {
        let program = program(text);
        assert_eq!(program.run(&[], &mut []), Err(StepLimit), "{text}");
    }
    let said = StepLimit.to_string();
    assert!(
        said.contains("more than 131072 instructions in its loops") && said.contains("may be endless"),
        "{said}"
    );
    // A long loop that terminates is not endless.
    assert_eq!(counted("for (var i = 0; i < n; i++) { sum += 1; }", 10_000), 10_000);
}

#[test]
fn what_only_a_graphics_card_has_is_refused_where_it_is_reached() {
    let globals = "@group(0) @binding(0) var picture: texture_2d<f32>; @group(0) @binding(1) var how: sampler;
        @group(0) @binding(2) var<storage, read> table: array<vec4<f32>>; @group(0) @binding(3) var<uniform> settings: vec4<f32>;
        @group(0) @binding(4) var<storage, read_write> counter: atomic<u32>; var<workgroup> shared_sum: f32; override STEP: f32 = 1.0;";
    for (body, what) in [
        ("return textureSample(picture, how, vec2(x)).x;", "it samples a texture"),
        ("return textureLoad(picture, vec2(0), 0).x;", "it reads a texture"),
        ("return table[0].x;", "it uses the buffer table"),
        ("return settings.x;", "it uses the buffer settings"),
        ("return f32(atomicAdd(&counter, 1u));", "it uses atomics"),
        ("return shared_sum;", "it uses the variable shared_sum, which belongs to a stage of the pipeline"),
        ("return STEP * x;", "it uses the override STEP"),
        ("return dpdx(x);", "it takes a derivative"),
        ("return f32(f64(x));", "it uses numbers that are not 32 bits wide"),
        ("workgroupBarrier(); return x;", "it waits at a barrier"),
        ("if x < 0.0 { discard; } return x;", "it discards a fragment"),
        ("return f32(pack2x16float(vec2(x)));", "it calls pack2x16float"),
        ("return quantizeToF16(x);", "it calls quantizeToF16"),
    ] {
        let text = format!(
            "{globals} fn f(x: f32) -> f32 {{ return inner(x); }} fn inner(x: f32) -> f32 {{ {body} }} fn g(x: f32) -> f32 {{ return x; }}"
        );
        let module = module(&text);
        let error = Program::new(&module, "f").expect_err(body);
        assert_eq!(error.what, what, "{body}");
        assert!(Program::new(&module, "g").is_ok(), "{body}");
    }
    let module = module("fn f() {}");
    assert_eq!(Program::new(&module, "g").expect_err("missing").to_string(), "there is no function g");
}

#[test]
fn functions_that_grow_beyond_all_bounds_are_refused() {
    let mut text = "fn g0(x: f32) -> f32 { return x * 1.5 + 2.0; }\n".to_owned();
    for i in 1..40 {
        text += &format!("fn g{i}(x: f32) -> f32 {{ return g{0}(x) * g{0}(x + 1.0); }}\n", i - 1);
    }
    text += "fn f(x: f32) -> f32 { return g39(x); }";
    let error = Program::new(&module(&text), "f").expect_err("too large");
    assert!(error.what.contains("too large"), "{error}");
    let text = "fn f(i: i32) -> f32 { var x: array<f32, 100000>; return x[i]; }";
    assert!(Program::new(&module(text), "f").expect_err("too large").what.contains("too large"));
    let mut text = "fn g0(x: f32) -> f32 { return x + 1.0; }\n".to_owned();
    for i in 1..2000 {
        text += &format!("fn g{i}(x: f32) -> f32 {{ return g{}(x); }}\n", i - 1);
    }
    text += "fn f(x: f32) -> f32 { return g1999(x); }";
    assert!(Program::new(&module(&text), "f").expect_err("too deep").what.contains("nested too deeply"));
    // Types that grow without calls.
    let mut text = "struct S0 { a: f32, b: f32 }\n".to_owned();
    for i in 1..25 {
        text += &format!("struct S{i} {{ a: S{0}, b: S{0} }}\n", i - 1);
    }
    text += "fn f() -> f32 { var x: S24; return x.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a; }";
    assert!(Program::new(&module(&text), "f").expect_err("too large").what.contains("too large"));
}

#[test]
fn a_row_of_a_table_is_read_where_the_layout_has_it() {
    let text = "struct Inner { n: vec3<f32>, k: f32 } struct Row { inner: Inner, curve: array<vec2<f32>, 3>, m: mat2x3<f32> }
        @group(0) @binding(0) var<storage, read> table: array<Row>;
        fn curve(i: u32) -> vec2<f32> { return table[3].curve[i]; }
        fn f(i: u32) -> vec4<f32> { let m = table[i].m; let inner = table[0].inner; return vec4(curve(i), inner.k, m[1].y + table[0].m[i].x); }";
    let program = Program::with_table(&module(text), "f", "table").expect("supported");
    assert_eq!(program.row_words, 20);
    let row: Vec<u32> = (0..20u8).map(|i| f32::from(i).to_bits()).collect();
    let mut results = [0; 4];
    program.run_with(&row, &[1], &mut results).expect("it ends");
    assert_eq!(results.map(f32::from_bits), [6.0, 7.0, 3.0, 17.0 + 16.0]);
}
