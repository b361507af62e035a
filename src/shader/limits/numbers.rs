//! The numbers.

/// Limits on a shader.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The longest composed text, bytes. The preprocessor has 21 bits for a place in it.
    pub bytes: usize,
    /// The most tokens of a composed text.
    pub tokens: usize,
    /// The most statements of a composed text.
    pub statements: usize,
    /// The most declarations of a composed text: functions, constants, types, variables.
    pub declarations: usize,
    /// The deepest nesting of brackets, including template lists.
    pub nesting: usize,
    /// The most operators, calls and brackets on one path through an expression.
    pub depth: usize,
    /// The deepest nesting of blocks; each `else if` counts as nested in the one before.
    pub blocks: usize,
    /// The most values of `case` in a switch.
    pub cases: usize,
    /// The longest chain of declarations that use each other.
    pub chain: usize,
    /// The most elements of an array.
    pub elements: u64,
    /// The most words of a constant or a type when everything in it is expanded.
    pub expansion: u64,
    /// The largest value or variable, bytes. Software Vulkan takes quadratic time: ten seconds for this much.
    pub value_bytes: u32,
    /// The most bytes of variables of a function, including the functions it calls, and of a module; and the same for
    /// constants.
    pub variable_bytes: u64,
    /// The most expressions of a function.
    pub expressions: usize,
    /// The longest chain of expressions that use each other, through `let` as well.
    pub values: usize,
    /// The most steps of a function with all calls inlined, as drivers do.
    pub steps: u64,
    /// The deepest nesting of loops.
    pub loops: usize,
}

/// The limits for models and other shaders of the laboratory.
pub const LIMITS: Limits = Limits {
    bytes: 1 << 20,
    tokens: 100_000,
    statements: 8_192,
    declarations: 2_048,
    nesting: 100,
    depth: 256,
    blocks: 64,
    cases: 256,
    chain: 64,
    elements: 4_096,
    expansion: 65_536,
    value_bytes: 4 << 10,
    variable_bytes: 16 << 10,
    expressions: 32_768,
    values: 1_024,
    steps: 196_608,
    loops: 16,
};
