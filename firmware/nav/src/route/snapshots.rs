//! The stack of snapshots, in no more bytes than its format takes.

use heapless::Vec;

use super::{RouteFull, StoredSnapshot};
use crate::snapshot::{SNAPSHOT_BYTES, SnapshotFormat, StoredView};
use crate::spectrum::Spectrum;

/// Bytes of the stack: 1 km at the paper's spacing of 2 m, 9 kB of the microcontroller's 192 kB.
pub const SNAPSHOT_STACK_BYTES: usize = 512 * (SNAPSHOT_BYTES + HEIGHT_BYTES);

/// Bytes of the number of odometry vectors below a snapshot.
pub(super) const HEIGHT_BYTES: usize = size_of::<u16>();

/// Snapshots of one format.
#[derive(Clone, Debug)]
pub struct SnapshotStack {
    format: SnapshotFormat,
    bytes: Vec<u8, SNAPSHOT_STACK_BYTES>,
}

impl SnapshotStack {
    /// An empty stack.
    pub(super) const fn new(format: SnapshotFormat) -> Self {
        Self {
            format,
            bytes: Vec::new(),
        }
    }

    /// The form of its views.
    pub const fn format(&self) -> SnapshotFormat {
        self.format
    }

    /// Lets an empty stack hold views of another form.
    pub(super) fn adopt(&mut self, format: SnapshotFormat) {
        if self.is_empty() {
            self.format = format;
        }
    }

    /// Bytes of one snapshot with its height.
    pub const fn stride(&self) -> usize {
        self.format.bytes() + HEIGHT_BYTES
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.bytes.len() / self.stride()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Whether there is no room for another.
    pub fn is_full(&self) -> bool {
        self.bytes.capacity() - self.bytes.len() < self.stride()
    }

    /// The snapshots, oldest first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = StoredSnapshot> + ExactSizeIterator {
        self.bytes
            .chunks_exact(self.stride())
            .map(|stored| self.read(stored))
    }

    /// The last.
    pub fn last(&self) -> Option<StoredSnapshot> {
        let below = self.bytes.len().checked_sub(self.stride())?;
        Some(self.read(self.bytes.get(below..)?))
    }

    /// Stores a view in the stack's format, and its height; what is left of the view.
    pub(super) fn push(&mut self, view: &Spectrum, height: u16) -> Result<StoredView, RouteFull> {
        if self.is_full() {
            return Err(RouteFull);
        }
        let view = StoredView::quantise(view, self.format);
        let mut put = |bytes: &[u8]| self.bytes.extend_from_slice(bytes).map_err(|_| RouteFull);
        put(&view.bytes())?;
        put(&height.to_le_bytes())?;
        Ok(view)
    }

    pub(super) fn pop(&mut self) -> Option<StoredSnapshot> {
        let last = self.last()?;
        self.bytes.truncate(self.bytes.len() - self.stride());
        Some(last)
    }

    /// Drops every second snapshot, as far as odometry leads to it and on from it, and never the first. Says
    /// whether that has made room.
    pub(super) fn thin_out(&mut self) -> bool {
        let (stride, count) = (self.stride(), self.len());
        let (mut written, mut keep) = (0, true);
        let mut below = None;
        for index in 0..count {
            let height = self.height(index);
            let is_on_the_way = below < height
                && self
                    .height(index + 1)
                    .is_none_or(|above| Some(above) > height);
            keep = !(keep && below.is_some() && is_on_the_way);
            below = height;
            if keep {
                let start = index * stride;
                self.bytes.copy_within(start..start + stride, written);
                written += stride;
            }
        }
        self.bytes.truncate(written);
        written < count * stride
    }

    /// Vectors below one of the snapshots, counted from the oldest.
    pub(super) fn height(&self, index: usize) -> Option<u16> {
        let end = (index + 1) * self.stride();
        let stored = self.bytes.get(..end)?.last_chunk()?;
        Some(u16::from_le_bytes(*stored))
    }

    /// Vectors below the last snapshot.
    pub(super) fn top_height(&self) -> Option<u16> {
        Some(u16::from_le_bytes(*self.bytes.last_chunk()?))
    }

    /// Drops the last snapshots, as far as more vectors lie below them than that.
    pub(super) fn drop_above(&mut self, height: usize) {
        while self
            .top_height()
            .is_some_and(|top| usize::from(top) > height)
        {
            self.bytes.truncate(self.bytes.len() - self.stride());
        }
    }

    pub(super) fn clear(&mut self) {
        self.bytes.clear();
    }

    /// Bytes in use.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn read(&self, stored: &[u8]) -> StoredSnapshot {
        let (view, height) = stored.split_at(self.format.bytes());
        StoredSnapshot {
            view: StoredView::from_bytes(self.format, view),
            height: height
                .first_chunk()
                .map_or(0, |height| u16::from_le_bytes(*height)),
        }
    }
}
