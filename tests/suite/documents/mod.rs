//! The documents: tables, links, and the manual in the program.

mod links;
mod manual;
mod tables;
