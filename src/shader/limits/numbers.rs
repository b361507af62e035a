//! The numbers.

macro_rules! limits {
    ($($(#[$doc:meta])* $name:ident: $Type:ty = $most:expr,)*) => {
        /// Limits on a shader.
        #[derive(Clone, Copy, Debug)]
        pub struct Limits {
            $($(#[$doc])* pub $name: $Type,)*
        }

        /// The limits for models and other shaders of the laboratory.
        pub const LIMITS: Limits = Limits { $($name: $most,)* };
    };
}

limits! {
    /// The longest composed text, bytes. The preprocessor has 21 bits for a place in it.
    bytes: usize = 1 << 20,
    /// The most tokens of a composed text.
    tokens: usize = 150_000,
    /// The most statements of a composed text.
    statements: usize = 10_240,
    /// The most declarations of a composed text: functions, constants, types, variables.
    declarations: usize = 2_048,
    /// The deepest nesting of brackets, including template lists.
    nesting: usize = 100,
    /// The most operators, calls and brackets on one path through an expression.
    depth: usize = 256,
    /// The deepest nesting of blocks; each `else if` counts as nested in the one before.
    blocks: usize = 64,
    /// The most values of `case` in a switch.
    cases: usize = 256,
    /// The longest chain of declarations that use each other.
    chain: usize = 80,
    /// The most elements of an array.
    elements: u64 = 4_096,
    /// The most words of a constant or a type when everything in it is expanded. Shipped shaders stay five
    /// times below: OpenPBR's surface filled that part of 65 536, and its bodies need more. Parsers take memory in proportion.
    expansion: u64 = 98_304,
    /// The largest value or variable, bytes. Software Vulkan takes quadratic time: ten seconds for this much.
    value_bytes: u32 = 4 << 10,
    /// The most bytes of variables of a function, including the functions it calls, and of a module; and the same for
    /// constants.
    variable_bytes: u64 = 32 << 10,
    /// The most expressions of a function.
    expressions: usize = 32_768,
    /// The longest chain of expressions that use each other, through `let` as well.
    values: usize = 1_024,
    /// The most steps of a function with all calls inlined, as drivers do.
    steps: u64 = 393_216,
    /// The deepest nesting of loops.
    loops: usize = 16,
}
