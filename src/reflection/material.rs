//! Placeholder.
use super::ReflectionModel;
use bevy::app::App;
/// Placeholder.
pub trait MaterialApp {
    /// Placeholder.
    fn add_model_material<M: ReflectionModel>(&mut self) -> &mut Self;
}
impl MaterialApp for App {
    fn add_model_material<M: ReflectionModel>(&mut self) -> &mut Self {
        self
    }
}
