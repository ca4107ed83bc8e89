//! The parts of a sample's radiance: by groups of lights, and by what its paths do.

use spectrum::SampledSpectrum;

use crate::Layer;

/// The event by which a path leaves its first vertex, seen from the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FirstEvent {
    /// None: the camera sees the light itself.
    None,
    /// Reflection by a surface, of which a share is diffuse.
    Reflection {
        /// From 0 to 1.
        diffuse: SampledSpectrum,
    },
    /// Transmission by a surface.
    Transmission,
    /// Scattering by a participating medium.
    Volume,
}

/// The parts of the radiance of a sample. Those by the first event, those by the number of events,
/// and those by groups of lights each sum to the whole.
#[derive(Clone, Debug)]
pub struct Parts {
    paths: [SampledSpectrum; Layer::OF_PATHS.len()],
    groups: Vec<SampledSpectrum>,
}

impl Parts {
    /// No light, of scenes with this number of groups of lights.
    pub fn new(groups: usize) -> Self {
        Self { paths: Default::default(), groups: vec![SampledSpectrum::ZERO; groups] }
    }

    /// Takes all light away.
    pub fn clear(&mut self) {
        self.each().for_each(|l| *l = SampledSpectrum::ZERO);
    }

    /// Multiplies all light.
    pub fn scale(&mut self, factor: f32) {
        self.each().for_each(|l| *l *= factor);
    }

    fn each(&mut self) -> impl Iterator<Item = &mut SampledSpectrum> {
        self.paths.iter_mut().chain(&mut self.groups)
    }

    /// Adds the light of a path with this number of scattering events from a light of a group.
    pub fn add(&mut self, l: SampledSpectrum, group: usize, first: &FirstEvent, events: u32) {
        if let Some(sum) = self.groups.get_mut(group) {
            *sum += l;
        }
        let length = if events > 1 { Layer::Indirect } else { Layer::Direct };
        *self.path_mut(length) += l;
        match *first {
            FirstEvent::None => *self.path_mut(Layer::Emission) += l,
            FirstEvent::Reflection { diffuse } => {
                let diffuse = l * diffuse;
                *self.path_mut(Layer::Diffuse) += diffuse;
                *self.path_mut(Layer::Specular) += l - diffuse;
            }
            FirstEvent::Transmission => *self.path_mut(Layer::Transmission) += l,
            FirstEvent::Volume => *self.path_mut(Layer::Volume) += l,
        }
    }

    fn path_mut(&mut self, layer: Layer) -> &mut SampledSpectrum {
        &mut self.paths[layer as usize - Layer::OF_PATHS[0] as usize]
    }

    /// The light of each group, or of the one part of any other layer.
    pub(crate) fn of(&self, layer: Layer) -> &[SampledSpectrum] {
        match layer {
            Layer::LightGroups => &self.groups,
            _ => std::slice::from_ref(&self.paths[layer as usize - Layer::OF_PATHS[0] as usize]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_by_the_first_event_by_length_and_by_group_are_the_whole() {
        let mut parts = Parts::new(2);
        let diffuse = SampledSpectrum([0.75, 0.5, 1.0, 0.0]);
        let events = [
            (FirstEvent::None, 0),
            (FirstEvent::Reflection { diffuse }, 1),
            (FirstEvent::Transmission, 2),
            (FirstEvent::Volume, 3),
        ];
        for (i, (first, count)) in events.iter().enumerate() {
            parts.add(SampledSpectrum::splat(f32::from(1u8 << i)), i % 2, first, *count);
        }
        parts.scale(2.0);
        let value = |layer| parts.of(layer)[0].0;
        assert_eq!(value(Layer::Emission), [2.0; 4]);
        assert_eq!(value(Layer::Specular), [1.0, 2.0, 0.0, 4.0]);
        assert_eq!(value(Layer::Diffuse), [3.0, 2.0, 4.0, 0.0]);
        assert_eq!((value(Layer::Transmission), value(Layer::Volume)), ([8.0; 4], [16.0; 4]));
        assert_eq!((value(Layer::Direct), value(Layer::Indirect)), ([6.0; 4], [24.0; 4]));
        let groups: Vec<_> = parts.of(Layer::LightGroups).iter().map(|l| l.0).collect();
        assert_eq!(groups, [[10.0; 4], [20.0; 4]]);
        parts.clear();
        assert!(Layer::OF_PATHS.into_iter().all(|layer| parts.of(layer)[0].is_black()));
    }
}
