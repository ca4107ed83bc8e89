//! Programs in lanes.

use super::*;
use ::lanes::Real;
use testkit::{LaneFunction, lanes_agree};

/// All textures of a scene.
struct All<'a>(&'a Compiled);

impl LaneFunction for All<'_> {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let [half, four] = [0.5, 4.0].map(R::splat);
        let size = u[4] * u[4] * u[4];
        let along = |i: usize| Vec3::new(u[i] - half, u[(i + 1) % 4] - half, u[(i + 2) % 4]);
        let footprint = Footprint {
            dpdx: along(1) * size,
            dpdy: along(2) * size,
            dudx: (u[0] - half) * size,
            dudy: u[1] * size,
            dvdx: u[2] * size,
            dvdy: (u[3] - half) * size,
        };
        let uv = Vec2::new((u[0] - half) * four, (u[1] - half) * four);
        let ctx = TextureContext { p: along(0) * four, n: along(3), uv, footprint };
        let lambda = SampledWavelengths::sample_visible(u[5]);
        let mut results = Vec::new();
        for &id in &self.0.floats {
            results.push(self.0.textures.float(id, &ctx));
        }
        for &id in self.0.spectra.as_flattened() {
            results.extend(self.0.textures.spectrum(id, &ctx, &lambda).0);
        }
        results
    }
}

#[test]
fn textures_do_not_depend_on_the_number_of_lanes() {
    let mut scene = SceneDesc::default();
    let image = Image::from_fn(16, 8, ["R", "G", "B"], |x, y| {
        [x as f32 / 15.0, y as f32 / 7.0, (x * y % 5) as f32 / 4.0]
    });
    let image = push_image(&mut scene, image.to_u8(ColorEncoding::Srgb));
    let turned = MappingDesc::Affine { columns: [[0.8, -0.6], [1.2, 1.6], [0.1, 0.2]] };
    let mappings = [MappingDesc::default(), MappingDesc::Spherical, turned];
    for (filter, mapping) in FILTERS.into_iter().flat_map(|f| mappings.map(|m| (f, m))) {
        let mut desc = ImageTextureDesc::new(image);
        (desc.filter, desc.mapping, desc.scale) = (filter, mapping, 0.9);
        desc.invert = filter == TextureFilter::Bilinear;
        scene.float_textures.push(FloatTextureDesc::new(TextureKind::Image(desc.clone())));
        scene.spectrum_textures.push(SpectrumTextureDesc::new(TextureKind::Image(desc)));
    }
    let (octaves, roughness) = (6, 0.7);
    for kind in [
        TextureKind::Fbm { octaves, roughness },
        TextureKind::Wrinkled { octaves, roughness },
        TextureKind::Windy,
        TextureKind::Step { texture: Handle::new(0).into(), edge: 0.5 },
    ] {
        let mut desc = FloatTextureDesc::new(kind);
        desc.world_from_texture = DMat4::from_rotation_x(0.4) * DMat4::from_scale(DVec3::new(0.3, 0.7, 0.2));
        scene.float_textures.push(desc);
    }
    let number: Parameter<f32> = Handle::new(2).into();
    let image: Parameter<SpectrumDesc> = Handle::new(4).into();
    let [red, grey] = [SpectrumDesc::rgb(0.9, 0.1, 0.1), SpectrumDesc::Constant(0.3)];
    let [first, second]: [Parameter<SpectrumDesc>; 2] = [red.clone().into(), grey.clone().into()];
    for kind in [
        TextureKind::Constant { value: grey.clone() },
        TextureKind::Scale { texture: image.clone(), scale: number.clone() },
        TextureKind::Mix { textures: [image, first.clone()], amount: number },
        TextureKind::Checkerboard {
            textures: [first.clone(), second.clone()],
            mapping: Some(MappingDesc::default()),
        },
        TextureKind::Checkerboard { textures: [first.clone(), second.clone()], mapping: None },
        TextureKind::DirectionMix {
            textures: [first.clone(), second.clone()],
            direction: Vec3::new(1.0, 2.0, -0.5),
        },
        TextureKind::Dots { inside: first, outside: second, mapping: MappingDesc::Spherical },
        TextureKind::Marble { octaves, roughness, scale: 3.0, variation: 0.8 },
        TextureKind::Bilerp {
            corners: [red.clone(), grey.clone(), grey, red],
            mapping: MappingDesc::default(),
        },
    ] {
        scene.spectrum_textures.push(SpectrumTextureDesc::new(kind));
    }
    lanes_agree(&All(&sound(&scene)), 6, 100);
}
