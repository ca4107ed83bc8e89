//! Layers beside the colour: means, identifiers, variance, and how they are written.

use std::collections::BTreeSet;

use alhazen_film::{
    Development, Film, FilmFile, FilmHeader, FilmSettings, FilmWriter, FirstEvent, FirstHit, Layer, LayerSet,
    PIXEL_BYTES, Parts, PassSet, ReadLimits, SPLAT_BYTES, Sample, compile, id_of_name,
};
use description::{FilmKind, GBufferSpace, SceneDesc, Span, Spanned};
use image::{Attribute, Format, Image, PixelSource, ReadOptions, WriteOptions, encode, read};
use math::Vec2;
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::Random;

const RESOLUTION: [i32; 2] = [21, 18];

fn settings() -> FilmSettings {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.save_fp16 = false;
    compile(&desc).unwrap().film.settings()
}

fn film(layers: impl IntoIterator<Item = Layer>) -> Film {
    let layers: LayerSet = layers.into_iter().collect();
    let groups = if layers.has(Layer::LightGroups) { &["default", "sun"][..] } else { &[] };
    let light_groups = groups.iter().map(|name| (*name).into()).collect();
    Film::new(FilmSettings { layers, light_groups, ..settings() }).unwrap()
}

fn hit(depth: f32, object: &str) -> FirstHit {
    FirstHit {
        depth: [depth],
        position: [depth, 2.0, -3.0],
        normal: [0.0, 0.6, 0.8],
        camera_position: [5.0, -6.0, depth],
        camera_normal: [0.0, 0.8, -0.6],
        geometric_normal: [0.6, 0.0, 0.8],
        camera_geometric_normal: [0.8, 0.0, -0.6],
        slope: [-0.25, 0.5],
        camera_slope: [0.125, -2.0],
        albedo: SampledSpectrum::splat(0.5),
        uv: [0.25, 0.75],
        motion: [-2.0, 4.0],
        ids: [object, "gold", "toys"].map(id_of_name),
    }
}

fn add(film: &mut Film, pixel: [i32; 2], weight: f32, first_hit: Option<FirstHit>) {
    add_light(film, pixel, weight, first_hit, 1.0, 0.5);
}

fn add_light(film: &mut Film, pixel: [i32; 2], weight: f32, first_hit: Option<FirstHit>, l: f32, u: f32) {
    let (l, lambda) = (SampledSpectrum::splat(l), SampledWavelengths::sample_visible(u));
    let alpha = if first_hit.is_some() { 1.0 } else { 0.0 };
    let mut parts = Parts::new(2);
    add_parts(&mut parts, l);
    let parts = Some(&parts);
    film.add(pixel, &Sample { alpha, first_hit, parts, ..Sample::new(&l, &lambda, weight) });
}

/// A quarter of the light is transmitted twice, the rest is reflected once.
fn add_parts(parts: &mut Parts, l: SampledSpectrum) {
    let diffuse = SampledSpectrum([0.0, 0.25, 0.5, 1.0]);
    parts.add(l * 0.25, 0, &FirstEvent::Transmission, 2);
    parts.add(l * 0.75, 1, &FirstEvent::Reflection { diffuse }, 1);
}

/// The picture with all layers, as a reader of its file sees it.
fn written(film: &Film) -> Image {
    through_file(&film.development())
}

fn through_file(picture: &Development) -> Image {
    let bytes = encode(picture, Format::Exr, &WriteOptions::default()).unwrap();
    read(&bytes, "", &ReadOptions::default()).unwrap()
}

fn at(image: &Image, channel: &str, [x, y]: [u32; 2]) -> f32 {
    let index = image.channel_index(channel).unwrap_or_else(|| panic!("{channel} of {:?}", image.channels()));
    image.channel(x, y, index)
}

#[test]
fn layers_of_a_set_come_in_their_order() {
    for layer in Layer::ALL {
        assert_eq!(LayerSet::NONE.with(layer).iter().collect::<Vec<_>>(), [layer]);
    }
    assert_eq!(LayerSet::from_iter(Layer::ALL).iter().collect::<Vec<_>>(), Layer::ALL);
    assert_eq!(LayerSet::NONE.iter().count(), 0);
}

#[test]
fn means_of_first_hits_are_over_the_samples_that_hit() {
    let mut film = film(Layer::ALL);
    add(&mut film, [17, 16], 1.0, Some(hit(2.0, "cube")));
    add(&mut film, [17, 16], 3.0, Some(hit(4.0, "ball")));
    add(&mut film, [17, 16], 4.0, None);
    add(&mut film, [17, 16], -0.5, Some(hit(1000.0, "ball")));
    let image = written(&film);
    let at = |channel| at(&image, channel, [17, 16]);
    assert_eq!(at("Z"), 3.5, "a negative weight does not count");
    assert_eq!(["P.X", "P.Y", "P.Z"].map(at), [3.5, 2.0, -3.0]);
    assert_eq!(["N.X", "N.Y", "N.Z"].map(at), [0.0, 0.6, 0.8]);
    assert_eq!(["Pcam.X", "Pcam.Y", "Pcam.Z"].map(at), [5.0, -6.0, 3.5]);
    assert_eq!(["Ncam.X", "Ncam.Y", "Ncam.Z"].map(at), [0.0, 0.8, -0.6]);
    assert_eq!(["Ng.X", "Ng.Y", "Ng.Z"].map(at), [0.6, 0.0, 0.8]);
    assert_eq!(["Ngcam.X", "Ngcam.Y", "Ngcam.Z"].map(at), [0.8, 0.0, -0.6]);
    assert_eq!(["slope.X", "slope.Y", "slopecam.X", "slopecam.Y"].map(at), [0.25, 0.5, 0.125, 2.0]);
    assert_eq!(["uv.U", "uv.V"].map(at), [0.25, 0.75]);
    assert_eq!(["motion.X", "motion.Y"].map(at), [-2.0, 4.0]);
    assert_eq!(at("samples"), 4.0);
    assert!((at("A") - 3.5 / 7.5).abs() < 1e-6, "weighted as colours are: {}", at("A"));
}

#[test]
fn a_geometry_buffer_has_the_channels_of_the_format() {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    for space in [GBufferSpace::Camera, GBufferSpace::World] {
        desc.film.kind = FilmKind::GBuffer { space };
        desc.film.layers = Vec::new();
        let mut film = compile(&desc).unwrap().film;
        add(&mut film, [1, 2], 1.0, Some(hit(2.0, "cube")));
        let tilted =
            FirstHit { normal: [0.0, -0.6, 0.8], camera_normal: [0.0, 0.8, 0.6], ..hit(4.0, "cube") };
        add(&mut film, [1, 2], 1.0, Some(tilted));
        let image = written(&film);
        let mut names: Vec<&str> = image.channels().iter().map(String::as_str).collect();
        names.sort_unstable();
        let expected = "Albedo.B Albedo.G Albedo.R B G N.X N.Y N.Z Ns.X Ns.Y Ns.Z P.X P.Y P.Z R \
             RelativeVariance.B RelativeVariance.G RelativeVariance.R Variance.B Variance.G Variance.R \
             dzdx dzdy u v";
        assert_eq!(names, expected.split_whitespace().collect::<Vec<_>>());
        let at = |channel| at(&image, channel, [1, 2]);
        let is_world = space == GBufferSpace::World;
        let (p, n) =
            if is_world { ([3.0, 2.0, -3.0], [0.6, 0.0, 0.8]) } else { ([5.0, -6.0, 3.0], [0.8, 0.0, -0.6]) };
        assert_eq!(["P.X", "P.Y", "P.Z"].map(at), p);
        assert_eq!(["N.X", "N.Y", "N.Z"].map(at), n);
        // A mean of normals has unit length, too.
        assert_eq!(
            ["Ns.X", "Ns.Y", "Ns.Z"].map(at),
            if is_world { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] }
        );
        assert_eq!(["dzdx", "dzdy"].map(at), if is_world { [0.25, 0.5] } else { [0.125, 2.0] });
        assert_eq!(["u", "v"].map(at), [0.25, 0.75]);
        // No other layer has the name of one of these.
        desc.film.layers = Layer::ALL.map(|layer| Spanned::new(layer.name().into(), Span::NONE)).into();
        let all = compile(&desc).unwrap().film.development().channels();
        let names: BTreeSet<_> = all.iter().map(|channel| &channel.name).collect();
        assert_eq!(names.len(), all.len());
    }
}

#[test]
fn the_variance_of_colours_is_that_of_samples_that_hit() {
    let mut film = film([Layer::ColorVariance]);
    let lights = [1.0, 4.0, 7.0];
    for l in lights {
        add_light(&mut film, [0, 0], 0.5, Some(hit(1.0, "cube")), l, 0.5);
    }
    add_light(&mut film, [0, 0], 1.0, None, 100.0, 0.5);
    add_light(&mut film, [1, 0], 1.0, Some(hit(1.0, "cube")), 1.0, 0.5);
    let image = written(&film);
    let at = |channel: &str, pixel| at(&image, channel, pixel);
    // The responses are 1, 4 and 7 times that to light of strength 1: their variance is 9 times its
    // square, their mean 4 times it.
    let l = SampledSpectrum::splat(1.0);
    let unit = film.settings().sensor.response(&l, &SampledWavelengths::sample_visible(0.5));
    for (channel, unit) in ["R", "G", "B"].into_iter().zip(unit) {
        let variance = at(&format!("variance.{channel}"), [0, 0]);
        let relative = at(&format!("relativeVariance.{channel}"), [0, 0]);
        assert!((variance / (9.0 * unit * unit) - 1.0).abs() < 1e-5, "{channel}: {variance}");
        assert!((relative / (9.0 / 4.0 * unit) - 1.0).abs() < 1e-5, "{channel}: {relative}");
    }
    assert_eq!(at("variance.R", [1, 0]), 0.0, "one sample has none");
}

#[test]
fn pixels_without_hits_are_far_and_black() {
    let mut film = film(Layer::ALL.into_iter().filter(|layer| !layer.is_part()));
    add(&mut film, [0, 0], 1.0, None);
    let image = written(&film);
    for pixel in [[0, 0], [20, 17]] {
        for channel in image.channels() {
            let value = at(&image, channel, pixel);
            match channel.as_str() {
                "Z" => assert_eq!(value, 1e10),
                "samples" => assert_eq!(value, if pixel == [0, 0] { 1.0 } else { 0.0 }),
                "R" | "G" | "B" => (),
                _ => assert_eq!(value, 0.0, "{channel}"),
            }
        }
    }
}

#[test]
fn the_albedo_of_a_grey_surface_is_grey() {
    let mut film = film([Layer::Albedo]);
    const COUNT: u32 = 4096;
    for i in 0..COUNT {
        let u = (i as f32 + 0.5) / COUNT as f32;
        add_light(&mut film, [0, 0], 1.0, Some(hit(1.0, "cube")), 7.0, u);
    }
    let image = written(&film);
    for channel in ["albedo.R", "albedo.G", "albedo.B"] {
        let value = at(&image, channel, [0, 0]);
        assert!((value - 0.5).abs() < 0.005, "{channel}: {value}");
    }
}

#[test]
fn identifiers_are_listed_by_coverage_as_cryptomatte_has_them() {
    let mut film = film([Layer::ObjectId, Layer::MaterialId]);
    for (object, count) in [("cube", 1), ("ball", 4), ("floor", 2)] {
        (0..count).for_each(|_| add(&mut film, [4, 3], 1.0, Some(hit(1.0, object))));
    }
    add(&mut film, [4, 3], 1.0, None);
    let image = written(&film);
    let at = |channel: &str| at(&image, channel, [4, 3]);
    let ids = ["00.r", "00.b", "01.r"].map(|c| at(&format!("CryptoObject{c}")).to_bits());
    assert_eq!(ids, ["ball", "floor", "cube"].map(id_of_name));
    let coverage = ["00.g", "00.a", "01.g", "01.a"].map(|c| at(&format!("CryptoObject{c}")));
    assert_eq!(coverage, [0.5, 0.25, 0.125, 0.0]);
    assert_eq!(at("CryptoMaterial00.g"), 0.875);
    let key = format!("cryptomatte/{}/", &format!("{:08x}", id_of_name("CryptoObject"))[..7]);
    for (name, value) in
        [("name", "CryptoObject"), ("hash", "MurmurHash3_32"), ("conversion", "uint32_to_float32")]
    {
        let attribute = image.metadata.get(&format!("{key}{name}"));
        assert_eq!(attribute, Some(&Attribute::Text(value.into())));
    }
}

#[test]
fn the_manifest_names_the_identifiers_of_the_picture() {
    let mut film = film([Layer::ObjectId]);
    for object in ["cube", "the \"ball\""] {
        add(&mut film, [4, 3], 1.0, Some(hit(1.0, object)));
    }
    let mut development = film.development();
    development.set_names(Layer::ObjectId, ["the \"ball\"", "elsewhere", "cube"]);
    development.set_names(Layer::MaterialId, ["gold"]);
    let manifest = |layer: &str| {
        let key = format!("cryptomatte/{}/manifest", &format!("{:08x}", id_of_name(layer))[..7]);
        development.metadata.get(&key).cloned()
    };
    let [cube, ball] = ["cube", "the \"ball\""].map(id_of_name);
    let expected = format!(r#"{{"cube":"{cube:08x}","the \"ball\"":"{ball:08x}"}}"#);
    assert_eq!(manifest("CryptoObject"), Some(Attribute::Text(expected)));
    assert_eq!(manifest("CryptoMaterial"), None);
}

#[test]
fn the_variance_is_that_of_the_mean() {
    // Independent pixels of equally distributed samples: the variance of their means is what each
    // of them estimates.
    let mut film = film([Layer::Variance]);
    let mut random = Random::new(12);
    let bounds = film.pixel_bounds();
    for y in bounds.min[1]..bounds.max[1] {
        for x in bounds.min[0]..bounds.max[0] {
            for _ in 0..64 {
                let weight = if random.get_1d() < 0.1 { -1.0 } else { 1.0 };
                add_light(&mut film, [x, y], weight, None, random.get_1d(), 0.5);
            }
        }
    }
    let image = written(&film);
    let pixels = || (0..18).flat_map(|y| (0..21).map(move |x| [x, y]));
    let space = film.color_space();
    let luminance = |pixel: [u32; 2]| {
        let rgb = ["R", "G", "B"].map(|c| at(&image, c, pixel));
        f64::from(space.to_xyz(rgb.into()).y)
    };
    let count = pixels().count() as f64;
    let mean = pixels().map(luminance).sum::<f64>() / count;
    let spread = pixels().map(|p| (luminance(p) - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let estimate = pixels().map(|p| f64::from(at(&image, "variance", p))).sum::<f64>() / count;
    // The sample variance of `count` values is off by √(2/count), a sigma.
    assert!((estimate / spread - 1.0).abs() < 4.0 * (2.0 / count).sqrt(), "{estimate} {spread}");
}

/// Adds samples and splats that depend on the pass.
fn add_pass(film: &mut Film, pass: u32) {
    let mut random = Random::new(pass.into());
    for _ in 0..200 {
        let pixel = RESOLUTION.map(|size| (random.get_1d() * size as f32) as i32);
        let object = format!("object-{}", (3.0 * random.get_1d()) as u32);
        let first_hit = (random.get_1d() < 0.7).then(|| hit(100.0 * random.get_1d(), &object));
        add_light(film, pixel, 1.5 * random.get_1d() - 0.25, first_hit, random.get_1d(), random.get_1d());
    }
    let (_, splatter) = film.tiles_and_splatter().unwrap();
    for _ in 0..50 {
        let at = Vec2::from_array(RESOLUTION.map(|size| random.get_1d() * size as f32));
        let l = SampledSpectrum::splat(300.0 * random.get_1d());
        let lambda = SampledWavelengths::sample_visible(random.get_1d());
        let mut parts = splatter.new_parts();
        parts.iter_mut().for_each(|parts| add_parts(parts, l));
        splatter.add_with(at, &l, &lambda, parts.as_ref());
    }
    splatter.add_paths(50);
}

fn bits(film: &Film) -> Vec<u32> {
    written(film).values().map(f32::to_bits).collect()
}

#[test]
fn order_merging_and_files_do_not_change_a_bit() {
    let whole = (0..6).fold(film(Layer::ALL), |mut film, pass| {
        add_pass(&mut film, pass);
        film
    });
    let parts = [[4, 1, 5], [3, 0, 2]].map(|passes| {
        passes.into_iter().fold(film(Layer::ALL), |mut film, pass| {
            add_pass(&mut film, pass);
            film
        })
    });
    let mut merged = whole.blank().unwrap();
    parts.iter().for_each(|part| merged.merge(part).unwrap());
    assert!(bits(&merged) == bits(&whole));
    let both = Development::of_all(&parts[0], Some(&parts[1]));
    assert!(through_file(&both).values().map(f32::to_bits).eq(bits(&whole)), "without merging");

    let files = [0, 1].map(|part| {
        let done = PassSet::from(3 * part..3 * part + 3);
        let header = FilmHeader { scene_hash: [0; 32], settings: String::new(), seed: 0, planned: 6, done };
        FilmWriter::new(Vec::new(), &header, &parts[part as usize]).unwrap().finish().unwrap()
    });
    let limits = ReadLimits::default();
    let mut file = FilmFile::read(&files[1][..], &limits).unwrap();
    file.merge(&files[0][..], &limits).unwrap();
    assert!(bits(&file.picture) == bits(&whole));
    let mut other = FilmFile::read(&files[0][..], &limits).unwrap();
    other.picture = film([Layer::Depth]);
    let error = other.merge(&files[1][..], &limits).unwrap_err();
    assert!(error.to_string().contains("the settings of the films differ"), "{error}");
}

#[test]
fn parts_of_the_light_sum_to_the_colours() {
    // Sums are limited, and parts with them.
    let limited = FilmSettings { max_component_value: 0.5, ..film(Layer::ALL).settings() };
    for mut film in [film(Layer::ALL), Film::new(limited).unwrap()] {
        (0..6).for_each(|pass| add_pass(&mut film, pass));
        let image = written(&film);
        let pixels = (0..RESOLUTION[1]).flat_map(|y| (0..RESOLUTION[0]).map(move |x| [x as u32, y as u32]));
        for (pixel, c) in pixels.flat_map(|pixel| ["R", "G", "B"].map(|c| (pixel, c))) {
            let sum =
                |parts: &[&str]| parts.iter().map(|p| at(&image, &format!("{p}.{c}"), pixel)).sum::<f32>();
            let color = at(&image, c, pixel);
            for parts in [
                &["diffuse", "specular", "transmission", "volume", "emission"][..],
                &["direct", "indirect"],
                &["lights.default", "lights.sun"],
            ] {
                let error = (sum(parts) - color).abs();
                assert!(error <= 1e-5 * color.abs().max(1.0), "{parts:?} at {pixel:?}: {error} of {color}");
            }
            assert!((sum(&["indirect"]) - 0.25 * color).abs() <= 1e-5 * color.abs().max(1.0));
        }
    }
}

#[test]
fn layers_do_not_change_the_colours() {
    let (mut plain, mut layered) = (film([]), film(Layer::ALL));
    (0..3).for_each(|pass| {
        add_pass(&mut plain, pass);
        add_pass(&mut layered, pass);
    });
    let colors = |film: &Film| film.develop().unwrap().values().map(f32::to_bits).collect::<Vec<_>>();
    assert!(colors(&plain) == colors(&layered));
    assert!(plain.development().channels().len() == 3);
}

#[test]
fn a_pixel_has_the_documented_size() {
    assert_eq!((PIXEL_BYTES, SPLAT_BYTES), (52, 36));
}

#[test]
fn layers_are_found_by_their_names() {
    for layer in Layer::ALL {
        assert_eq!(Layer::from_name(layer.name()), Some(layer));
        assert_eq!(LayerSet::NONE.with(layer).iter().collect::<Vec<_>>(), [layer]);
    }
    assert_eq!(Layer::from_name("colour"), None);
}
