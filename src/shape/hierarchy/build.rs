//! Building: splits by the surface-area heuristic (J. Goldsmith, J. Salmon 1987, *Automatic Creation of Object
//! Hierarchies for Ray Tracing*) in bins (I. Wald 2007, *On fast Construction of SAH-based Bounding Volume Hierarchies*);
//! two splits make the four children of a node (H. Dammertz, J. Hanika, A. Keller 2008, *Shallow Bounding Volume
//! Hierarchies for Fast SIMD Ray Tracing of Incoherent Rays*).

use arrayvec::ArrayVec;
use glam::Vec3A;

use super::{CHILDREN, COUNT_SHIFT, LEAF, LEVELS, NO_CHILD, NODE_ROWS, Row};
use crate::shape::PolygonMesh;

/// Maximum number of triangles of a leaf.
const MOST: usize = 4;
/// Maximum number of splits from the root to a leaf.
const SPLITS: u32 = 2 * LEVELS as u32;
/// Number of bins along an axis.
const BINS: usize = 16;
/// Cost of a split relative to that of a triangle.
const SPLIT_COST: f32 = 2.0;
/// Fraction of the mesh's size by which boxes are larger than their triangles: more than what rounding moves rays that begin
/// within twice its size.
const MARGIN: f32 = 4e-6;

/// The rows of a node.
pub(super) type Node = [Row; NODE_ROWS];
/// A polygon, and the vertices of one of its triangles.
pub(super) type Triangle = (u32, [u32; 3]);

/// A box; empty by default.
#[derive(Clone, Copy, Debug)]
struct Box3 {
    low: Vec3A,
    high: Vec3A,
}

impl Box3 {
    const EMPTY: Self = Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn point(at: Vec3A) -> Self {
        Self { low: at, high: at }
    }

    fn of(items: &[Item]) -> Self {
        items.iter().fold(Self::EMPTY, |all, item| all.with(item.bounds))
    }

    /// Half the area; 0 if empty.
    fn area(self) -> f32 {
        let size = (self.high - self.low).max(Vec3A::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// A triangle to be sorted: its box, and its number.
#[derive(Clone, Copy)]
struct Item {
    bounds: Box3,
    index: u32,
}

impl Item {
    /// Twice the centre of its box.
    fn centre(&self) -> Vec3A {
        self.bounds.low + self.bounds.high
    }
}

/// The nodes of a mesh's hierarchy, and its triangles in the order of their leaves.
pub(super) fn build(mesh: &PolygonMesh) -> (Vec<Node>, Vec<Triangle>) {
    let place = |i: u32| Vec3A::from(mesh.positions[i as usize]);
    let mut triangles: Vec<Triangle> = Vec::new();
    let mut items: Vec<Item> = Vec::new();
    for (polygon, corners) in mesh.triangles().take(MOST << SPLITS) {
        let [a, b, c] = corners.map(place);
        if a != b && b != c && c != a {
            let bounds = Box3 { low: a.min(b).min(c), high: a.max(b).max(c) };
            items.push(Item { bounds, index: triangles.len() as u32 });
            triangles.push((polygon as u32, corners));
        }
    }
    let all = Box3::of(&items);
    let size = all.high.abs().max(all.low.abs()).max_element();
    let mut nodes = Nodes { nodes: Vec::new(), margin: Vec3A::splat(MARGIN * size) };
    nodes.add(Part::new(&mut items, 0, SPLITS), SPLITS);
    let order = items.iter().map(|item| triangles[item.index as usize]).collect();
    (nodes.nodes, order)
}

/// Triangles that belong together.
struct Part<'a> {
    items: &'a mut [Item],
    /// The number of the first.
    first: usize,
    /// Number of triangles before the division; `None` for a leaf.
    middle: Option<usize>,
}

impl<'a> Part<'a> {
    /// Sorts the triangles for division, if it is worth it; so many splits are left.
    fn new(items: &'a mut [Item], first: usize, splits: u32) -> Self {
        let middle = split(items, splits);
        Self { items, first, middle }
    }

    /// Both sides, each with so many splits left, or the part itself if it is a leaf.
    fn halves(self, splits: u32) -> ArrayVec<Self, 2> {
        let Some(middle) = self.middle else { return ArrayVec::from_iter([self]) };
        let (left, right) = self.items.split_at_mut(middle);
        ArrayVec::from([Part::new(left, self.first, splits), Part::new(right, self.first + middle, splits)])
    }
}

/// The nodes so far.
struct Nodes {
    nodes: Vec<Node>,
    margin: Vec3A,
}

impl Nodes {
    /// Adds a node with everything below it; so many splits are left. Returns its number.
    fn add(&mut self, part: Part, splits: u32) -> u32 {
        let number = self.nodes.len();
        self.nodes.push([[0; 4]; NODE_ROWS]);
        let mut node = [[0; 4]; NODE_ROWS];
        node[CHILDREN] = [NO_CHILD; 4];
        let halves = part.halves(splits.saturating_sub(1));
        let parts = halves.into_iter().flat_map(|half| half.halves(splits.saturating_sub(2)));
        for (i, part) in parts.filter(|part| !part.items.is_empty()).enumerate() {
            let bounds = Box3::of(part.items);
            let (low, high) = (bounds.low - self.margin, bounds.high + self.margin);
            for axis in 0..3 {
                node[axis][i] = low[axis].to_bits();
                node[3 + axis][i] = high[axis].to_bits();
            }
            node[CHILDREN][i] = match part.middle {
                Some(_) => self.add(part, splits - 2),
                None => LEAF | (part.items.len() as u32 - 1) << COUNT_SHIFT | part.first as u32,
            };
        }
        self.nodes[number] = node;
        number as u32
    }
}

/// Sorts triangles into two sides and returns the number of the first side; `None` if they are better off as one leaf.
fn split(items: &mut [Item], splits: u32) -> Option<usize> {
    if items.len() < 2 || splits == 0 {
        return None;
    }
    let bounds = Box3::of(items);
    // At most so many on each side leave splits enough for all.
    let room = MOST << (splits - 1);
    match Bins::new(items).best() {
        Some(best) if items.len() > MOST || best.cost < (items.len() as f32 - SPLIT_COST) * bounds.area() => {
            let middle = best.divide(items);
            let fits = (items.len().saturating_sub(room)..=room).contains(&middle);
            Some(if fits { middle } else { in_the_middle(items) })
        }
        None if items.len() > MOST => Some(in_the_middle(items)),
        _ => None,
    }
}

/// Sorts triangles into two halves along the longest axis.
fn in_the_middle(items: &mut [Item]) -> usize {
    let centres = items.iter().fold(Box3::EMPTY, |all, item| all.with(Box3::point(item.centre())));
    let axis = (centres.high - centres.low).max_position();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.centre()[axis].total_cmp(&b.centre()[axis]));
    middle
}

/// A bin: the box around its triangles, and their number.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Box3,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Box3::EMPTY, count: 0 };

    fn with(self, other: Self) -> Self {
        Self { bounds: self.bounds.with(other.bounds), count: self.count + other.count }
    }

    fn cost(self) -> f32 {
        self.count as f32 * self.bounds.area()
    }
}

/// The assignment of centres to bins.
#[derive(Clone, Copy)]
struct Grid {
    low: Vec3A,
    /// Bins per length; 0 along axes on which all centres are in one place.
    scale: Vec3A,
}

impl Grid {
    fn place(&self, item: &Item) -> [usize; 3] {
        let at = (item.centre() - self.low) * self.scale;
        // The conversion takes anything that is no number as 0.
        [at.x, at.y, at.z].map(|at| (at as usize).min(BINS - 1))
    }
}

/// Triangles in bins along each axis.
struct Bins {
    grid: Grid,
    bins: [[Bin; BINS]; 3],
}

/// A place to divide.
struct Best {
    grid: Grid,
    axis: usize,
    /// The first bin of the second side.
    bin: usize,
    /// Sum over both sides of number times area.
    cost: f32,
}

impl Bins {
    fn new(items: &[Item]) -> Self {
        let centres = items.iter().fold(Box3::EMPTY, |all, item| all.with(Box3::point(item.centre())));
        let size = centres.high - centres.low;
        let scale = Vec3A::select(size.cmpgt(Vec3A::ZERO), BINS as f32 / size, Vec3A::ZERO);
        let grid = Grid { low: centres.low, scale };
        let mut bins = [[Bin::EMPTY; BINS]; 3];
        for item in items {
            for (bins, at) in bins.iter_mut().zip(grid.place(item)) {
                bins[at] = bins[at].with(Bin { bounds: item.bounds, count: 1 });
            }
        }
        Self { grid, bins }
    }

    /// The best place to divide with triangles on both sides, if any.
    fn best(&self) -> Option<Best> {
        let mut best: Option<Best> = None;
        for (axis, bins) in self.bins.iter().enumerate() {
            let mut before = [Bin::EMPTY; BINS];
            for i in 1..BINS {
                before[i] = before[i - 1].with(bins[i - 1]);
            }
            let mut after = Bin::EMPTY;
            for bin in (1..BINS).rev() {
                after = after.with(bins[bin]);
                let cost = before[bin].cost() + after.cost();
                let on_both = before[bin].count > 0 && after.count > 0;
                if on_both && best.as_ref().is_none_or(|best| cost < best.cost) {
                    best = Some(Best { grid: self.grid, axis, bin, cost });
                }
            }
        }
        best
    }
}

impl Best {
    /// Sorts the triangles before the bin to the front, and returns their number.
    fn divide(&self, items: &mut [Item]) -> usize {
        let mut middle = 0;
        for i in 0..items.len() {
            if self.grid.place(&items[i])[self.axis] < self.bin {
                items.swap(i, middle);
                middle += 1;
            }
        }
        middle
    }
}
