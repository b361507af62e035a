//! Tables of object parameters, read by shaders.

use std::{collections::HashMap, ops::Range};

use bevy::{
    asset::RenderAssetUsages,
    ecs::{lifecycle::HookContext, world::DeferredWorld},
    prelude::*,
    render::{
        MainWorld, Render, RenderApp, RenderSystems,
        render_asset::RenderAssets,
        renderer::RenderQueue,
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
};

use crate::{
    optics::{colour::Encoding, interior::Interior, lobes::MAX_LOBES},
    parameter::Values,
    reflection::{ModelEntry, Passage},
    scene::MAX_OBJECTS,
    shading::ShadingEntry,
};

/// The parameters of an object as bytes of its row: those of its model, those of its shading model, and the
/// lobes of its model, which are zero unless there is light with `extent`; of a solid body also its inside.
pub(super) fn row(
    (model, passage): (&ModelEntry, Passage),
    shading: &ShadingEntry,
    values: &Values,
    encoding: Encoding,
    everywhere: bool,
    extent: bool,
) -> Vec<u8> {
    let mut row = model.row(values, encoding, everywhere);
    row.resize(row.len().next_multiple_of(16), 0);
    row.extend(shading.row(values, encoding));
    let end = row.len() + size_of::<[Vec4; MAX_LOBES]>();
    if extent {
        row.extend(model.instantiate(values, encoding).lobes().bytes());
    }
    row.resize(end, 0);
    if passage.solid {
        let inside = model.instantiate(values, encoding).interior().unwrap_or(Interior::AIR);
        let rows = inside.rows(shading.declaration.faceted);
        row.extend(rows.into_iter().flat_map(|row| row.to_array()).flat_map(f32::to_le_bytes));
    }
    row
}

/// The row of an object, the same in every table, for the lifetime of the object. Later another object may
/// use it.
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

/// The model of a table, its [declaration](ModelEntry::declared), and whether its objects are solid, which determine the
/// layout.
type TableKey = (&'static str, u64, bool);

/// The parameters of all objects, one table for each model in use, and for each view with overrides. Changed
/// rows are written into the buffer without affecting materials. The capacity is the next power of two above
/// the number of objects; when a scene outgrows it, all tables are rebuilt, and every object gets its
/// material again.
#[derive(Default, Resource)]
pub struct ParameterTables {
    /// By model, and by view for views with overrides.
    tables: HashMap<(Option<Entity>, TableKey), Table>,
    rows: usize,
    /// Index of the first row that has never been used.
    next: usize,
    /// Rows of removed objects.
    free: Vec<Row>,
    /// Data to pass to the renderer in this frame.
    uploads: Vec<Upload>,
    /// Number of bytes uploaded since the start.
    uploaded: u64,
}

struct Table {
    buffer: Handle<ShaderBuffer>,
    row_bytes: usize,
    /// True if created in this frame: the renderer receives it as a whole.
    new: bool,
    /// Rows to be uploaded.
    changed: Vec<u32>,
}

impl Table {
    /// The byte ranges of the changed rows. Short gaps are bridged: copying a few rows is faster than
    /// starting another copy.
    fn stretches(&mut self) -> Vec<Range<usize>> {
        const GAP: u32 = 16;
        self.changed.sort_unstable();
        let near = |a: &u32, b: &u32| b - a <= GAP;
        let bytes = |rows: &[u32]| {
            rows[0] as usize * self.row_bytes..(rows[rows.len() - 1] as usize + 1) * self.row_bytes
        };
        self.changed.chunk_by(near).map(bytes).collect()
    }
}

/// Bytes for a part of a buffer.
struct Upload {
    buffer: AssetId<ShaderBuffer>,
    at: usize,
    bytes: Vec<u8>,
}

/// Uploads tables to the renderer: as a whole when they are new, row by row after that.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<ParameterTables>();
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .init_resource::<Uploads>()
        .add_systems(ExtractSchedule, extract)
        .add_systems(Render, write.in_set(RenderSystems::PrepareResources));
}

/// The uploads in the render world.
#[derive(Default, Resource)]
struct Uploads(Vec<Upload>);

fn extract(mut main: ResMut<MainWorld>, mut uploads: ResMut<Uploads>) {
    if let Some(mut tables) = main.get_resource_mut::<ParameterTables>() {
        uploads.0.append(&mut tables.bypass_change_detection().uploads);
    }
}

fn write(mut uploads: ResMut<Uploads>, buffers: Res<RenderAssets<GpuShaderBuffer>>, queue: Res<RenderQueue>) {
    for Upload { buffer, at, bytes } in uploads.0.drain(..) {
        // A buffer that is not there yet is uploaded as a whole, in its state then.
        if let Some(gpu) = buffers.get(buffer) {
            queue.write_buffer(&gpu.buffer, at as u64, &bytes);
        }
    }
}

impl ParameterTables {
    /// Ensures capacity for this many objects. True if all rows must be written again.
    pub(super) fn hold(&mut self, objects: usize) -> bool {
        /// Number of rows in the smallest table.
        const ROWS: usize = 64;
        if objects <= self.rows {
            return false;
        }
        self.rows = objects.next_power_of_two().clamp(ROWS, MAX_OBJECTS);
        self.tables.clear();
        true
    }

    /// An unused row, if there is one.
    pub(super) fn take(&mut self) -> Option<Row> {
        self.free.pop().or_else(|| {
            let row = Row(self.next as u32);
            (self.next < self.rows).then(|| {
                self.next += 1;
                row
            })
        })
    }

    /// Writes the parameters of an object, as shown by all views or by one with overrides; returns the buffer
    /// of the table.
    pub(super) fn set(
        &mut self,
        view: Option<Entity>,
        (model, passage): (&ModelEntry, Passage),
        row: Row,
        parameters: &[u8],
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Handle<ShaderBuffer> {
        let (id, declared) = (model.declaration.id, model.declared());
        self.tables.retain(|(_, known), _| known.0 != id || known.1 == declared);
        let table = self.tables.entry((view, (id, declared, passage.solid))).or_insert_with(|| {
            let bytes = vec![0; parameters.len() * self.rows];
            let buffer = buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::default()));
            Table { buffer, row_bytes: parameters.len(), new: true, changed: Vec::new() }
        });
        let start = row.0 as usize * parameters.len();
        // Without an event, which would make the renderer upload the whole buffer.
        let bytes = buffers.get_mut_untracked(&table.buffer).and_then(|buffer| buffer.data.as_mut());
        if let Some(place) = bytes.and_then(|bytes| bytes.get_mut(start..start + parameters.len()))
            && place != parameters
        {
            place.copy_from_slice(parameters);
            table.changed.push(row.0);
        }
        table.buffer.clone()
    }

    /// Passes the changed rows to the renderer.
    pub(super) fn upload(&mut self, buffers: &Assets<ShaderBuffer>) {
        for table in self.tables.values_mut() {
            if !table.new
                && let Some(data) = buffers.get(&table.buffer).and_then(|buffer| buffer.data.as_ref())
            {
                for stretch in table.stretches() {
                    let (buffer, at, bytes) = (table.buffer.id(), stretch.start, data[stretch].to_vec());
                    self.uploaded += bytes.len() as u64;
                    self.uploads.push(Upload { buffer, at, bytes });
                }
            }
            table.new = false;
            table.changed.clear();
        }
    }

    /// The number of bytes in uploaded rows since the start; tables uploaded as a whole are not counted.
    #[must_use]
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// Drops the tables of a view that no longer has overrides.
    pub(super) fn forget(&mut self, view: Entity) {
        self.tables.retain(|(of, _), _| *of != Some(view));
    }

    /// The view with overrides to which a buffer belongs, `Some(None)` for all other views; `None` if it is
    /// not a table.
    pub(super) fn view_of(&self, buffer: AssetId<ShaderBuffer>) -> Option<Option<Entity>> {
        self.tables.iter().find(|(_, table)| table.buffer.id() == buffer).map(|((view, _), _)| *view)
    }
}
