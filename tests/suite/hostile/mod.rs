//! Input that is made to do harm.

mod models;
mod text;
