//! The parameters of objects, in tables that shaders read.

use std::collections::HashMap;

use bevy::{
    asset::{AssetId, Assets, Handle, RenderAssetUsages},
    ecs::{lifecycle::HookContext, prelude::*, world::DeferredWorld},
    render::storage::ShaderBuffer,
};

use crate::{reflection::ModelEntry, scene::MAX_OBJECTS};

/// The row of an object, the same in every table, as long as the object exists. Then another object may have it.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(immutable, on_remove = free)]
pub struct Row(pub(super) u32);

fn free(mut world: DeferredWorld, context: HookContext) {
    if let Some(row) = world.get::<Row>(context.entity).copied()
        && let Some(mut tables) = world.get_resource_mut::<ParameterTables>()
    {
        tables.free.push(row);
    }
}

/// The model of a table, and [what it declares](ModelEntry::declared), from which the layout follows.
type TableKey = (&'static str, u64);

/// The parameters of all objects, one table for each model in use, and for each view with overrides. A table
/// that changed is uploaded whole: a buffer that never grows is replaced without touching any material. So that
/// a slider moves no megabytes in a room of few objects, there is room for the next power of two above their
/// number; when a scene outgrows that, all tables are made anew, and every object takes its material again.
#[derive(Default, Resource)]
pub struct ParameterTables {
    /// By the view with overrides, if it is one's own.
    tables: HashMap<(Option<Entity>, TableKey), Table>,
    rows: usize,
    /// Rows from here on have never been used.
    next: usize,
    /// Rows of objects that are gone.
    free: Vec<Row>,
}

struct Table {
    bytes: Vec<u8>,
    buffer: Handle<ShaderBuffer>,
    changed: bool,
}

impl ParameterTables {
    /// Makes room for so many objects. True if all rows have to be written anew.
    pub(super) fn hold(&mut self, objects: usize) -> bool {
        /// Of the smallest table.
        const ROWS: usize = 64;
        if objects <= self.rows {
            return false;
        }
        self.rows = objects.next_power_of_two().clamp(ROWS, MAX_OBJECTS);
        self.tables.clear();
        true
    }

    /// A row that no object has, if there is room.
    pub(super) fn take(&mut self) -> Option<Row> {
        self.free.pop().or_else(|| {
            let row = Row(self.next as u32);
            (self.next < self.rows).then(|| {
                self.next += 1;
                row
            })
        })
    }

    /// Writes the parameters of an object, as all views or one with overrides show it; the buffer of the table.
    pub(super) fn set(
        &mut self,
        view: Option<Entity>,
        model: &ModelEntry,
        row: Row,
        parameters: &[u8],
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Handle<ShaderBuffer> {
        let (id, declared) = (model.declaration.id, model.declared());
        self.tables.retain(|(_, known), _| known.0 != id || known.1 == declared);
        let table = self.tables.entry((view, (id, declared))).or_insert_with(|| {
            let bytes = vec![0; parameters.len() * self.rows];
            let buffer = buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::default()));
            Table { bytes, buffer, changed: true }
        });
        let start = row.0 as usize * parameters.len();
        let place = &mut table.bytes[start..start + parameters.len()];
        if place != parameters {
            place.copy_from_slice(parameters);
            table.changed = true;
        }
        table.buffer.clone()
    }

    /// Hands what changed to the renderer.
    pub(super) fn upload(&mut self, buffers: &mut Assets<ShaderBuffer>) {
        for table in self.tables.values_mut().filter(|t| t.changed) {
            table.changed = false;
            if let Some(mut buffer) = buffers.get_mut(&table.buffer) {
                buffer.data = Some(table.bytes.clone());
            }
        }
    }

    /// Lets go of the tables of a view that has no overrides any more.
    pub(super) fn forget(&mut self, view: Entity) {
        self.tables.retain(|(of, _), _| *of != Some(view));
    }

    /// The view with overrides to which a buffer belongs, `Some(None)` if it belongs to all others; `None` if
    /// it is no table.
    pub(super) fn view_of(&self, buffer: AssetId<ShaderBuffer>) -> Option<Option<Entity>> {
        self.tables.iter().find(|(_, table)| table.buffer.id() == buffer).map(|((view, _), _)| *view)
    }
}
