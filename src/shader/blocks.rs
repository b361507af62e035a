//! Parts of functions: expressions by their handles, and the blocks of statements.

use naga::{Block, Expression, Handle, Statement, SwitchCase};

/// An expression of a function.
pub(super) type Expr = Handle<Expression>;

/// The blocks within a statement.
pub(super) fn blocks(statement: &Statement) -> impl Iterator<Item = &Block> {
    let (pair, cases): ([Option<&Block>; 2], &[SwitchCase]) = match statement {
        Statement::Block(inner) => ([Some(inner), None], &[]),
        Statement::If { accept, reject, .. } => ([Some(accept), Some(reject)], &[]),
        Statement::Loop { body, continuing, .. } => ([Some(body), Some(continuing)], &[]),
        Statement::Switch { cases, .. } => ([None, None], cases),
        _ => ([None, None], &[]),
    };
    pair.into_iter().flatten().chain(cases.iter().map(|case| &case.body))
}
