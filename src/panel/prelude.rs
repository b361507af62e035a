//! The names that most panels need.

pub(super) use std::sync::Arc;

pub(super) use bevy_egui::egui::{
    self, Align, Align2, Button, Color32, Context, CursorIcon, FontId, Galley, Id, Key, Label, Layout, Popup,
    Pos2, Rect, Response, RichText, ScrollArea, Sense, Shape, Stroke, StrokeKind, TextStyle, Ui, UiBuilder,
    Vec2, WidgetInfo, WidgetType, pos2, vec2,
};
pub(super) use glam::Vec3;

pub(super) use super::{
    context::PanelContext,
    icon::{self, Icon},
    kept,
    state::{
        Action, CompareCommand, LessonCommand, ModelCommand, PictureArea, Place, PlotCommand, Session,
        Severity, TakeCommand, ViewChange,
    },
    theme::{self, Palette},
};
pub(super) use crate::{
    document::{Edit, Selection},
    files::Shown as _,
    registry::Registry,
    scene::{
        Part, Scene,
        variant::{LETTERS, MAX_VARIANTS},
    },
    text::plural,
};
