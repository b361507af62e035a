//! Changes of the document: history, cost, places of new parts.

mod cost;
mod history;
mod placing;
mod random;
mod rows;
mod several;
