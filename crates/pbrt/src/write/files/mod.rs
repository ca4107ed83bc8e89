//! The files beside the text of a scene. The same data are written once.

mod measured;
mod picture;
mod ply;
mod volume;

use std::collections::HashMap;
use std::io;
use std::sync::Arc;

use description::{MeshDesc, PatchMeshDesc, VoxelsDesc};
use image::{ColorEncoding, Image};
use scattering::MeasuredTable;

/// What receives a file: its name in the folder, and its bytes.
pub(crate) type Sink<'f> = &'f mut dyn FnMut(&str, &[u8]) -> io::Result<()>;

/// The files that are written.
pub(crate) struct Files<'f> {
    folder: String,
    sink: Sink<'f>,
    /// How many there are of each kind.
    counts: HashMap<&'static str, usize>,
    /// Those of shared data, by kind and what tells them apart.
    written: HashMap<(&'static str, Vec<u64>), String>,
    /// The file that could not be written, and why.
    failure: Option<(String, io::Error)>,
}

impl<'f> Files<'f> {
    /// Files in a folder, which is named by its path from the scene.
    pub(crate) fn new(folder: &str, sink: Sink<'f>) -> Self {
        let (counts, written) = (HashMap::new(), HashMap::new());
        Self { folder: folder.to_owned(), sink, counts, written, failure: None }
    }

    /// The file that could not be written, and why.
    pub(crate) fn finish(self) -> Result<(), (String, io::Error)> {
        self.failure.map_or(Ok(()), Err)
    }

    /// Writes a file of a kind; returns its path from the scene. After a failure nothing is
    /// written.
    pub(crate) fn add(&mut self, kind: &'static str, extension: &str, bytes: &[u8]) -> String {
        let count = self.counts.entry(kind).or_default();
        *count += 1;
        let name = format!("{kind}-{count}.{extension}");
        if self.failure.is_none()
            && let Err(error) = (self.sink)(&name, bytes)
        {
            self.failure = Some((name.clone(), error));
        }
        format!("{}/{name}", self.folder)
    }

    /// The file of some shared data, written by `make` unless it is there already.
    fn shared(
        &mut self,
        kind: &'static str,
        key: Vec<u64>,
        make: impl FnOnce(&mut Self) -> String,
    ) -> String {
        let key = (kind, key);
        if let Some(name) = self.written.get(&key) {
            return name.clone();
        }
        let name = make(self);
        self.written.insert(key, name.clone());
        name
    }

    /// The file of a picture that is read with an encoding of integer codes.
    pub(crate) fn image(&mut self, image: &Arc<Image>, encoding: ColorEncoding) -> String {
        let keeps_codes = picture::keeps_codes(image, encoding);
        let (kind, extension) = if keeps_codes { ("code", "png") } else { ("float", "exr") };
        self.shared(kind, vec![address(image)], |files| match picture::bytes(image, keeps_codes) {
            Ok(bytes) => files.add("image", extension, &bytes),
            Err(error) => {
                files.failure.get_or_insert(("an image".into(), io::Error::other(error)));
                String::new()
            }
        })
    }

    /// The file of a mesh; an error if its parts do not share their vertices.
    pub(crate) fn mesh(
        &mut self,
        triangles: &MeshDesc,
        patches: Option<&PatchMeshDesc>,
    ) -> Result<String, &'static str> {
        let no_patches = PatchMeshDesc::default();
        let patches = patches.unwrap_or(&no_patches);
        let key = vec![
            address(&triangles.indices),
            address(&triangles.positions),
            address(&triangles.normals),
            address(&triangles.uvs),
            address(&triangles.face_indices),
            address(&patches.indices),
            address(&patches.positions),
            address(&patches.normals),
            address(&patches.uvs),
            address(&patches.face_indices),
        ];
        if let Some(name) = self.written.get(&("mesh", key.clone())) {
            return Ok(name.clone());
        }
        let bytes = ply::bytes(triangles, patches)?;
        Ok(self.shared("mesh", key, |files| files.add("mesh", "ply", &bytes)))
    }

    /// The file of the grids of a volume.
    pub(crate) fn volume(&mut self, density: &VoxelsDesc, temperature: Option<&VoxelsDesc>) -> String {
        let grids = [Some(("density", density)), temperature.map(|grid| ("temperature", grid))];
        let grids: Vec<_> = grids.into_iter().flatten().collect();
        let place = |grid: &VoxelsDesc| grid.world_from_index.map(|row| row.map(f64::to_bits));
        let key = grids.iter().flat_map(|(_, grid)| {
            let place = place(grid);
            [address(&grid.values), address(&grid.table)].into_iter().chain(place.into_iter().flatten())
        });
        self.shared("volume", key.collect(), |files| files.add("volume", "nvdb", &volume::bytes(&grids)))
    }

    /// The file of a measured material.
    pub(crate) fn measured(&mut self, table: &Arc<MeasuredTable>) -> String {
        let key = vec![address(table)];
        self.shared("material", key, |files| files.add("material", "bsdf", &measured::bytes(table.data())))
    }
}

/// Where shared data are; the same for the same data.
fn address<T: ?Sized>(data: &Arc<T>) -> u64 {
    Arc::as_ptr(data).addr() as u64
}
