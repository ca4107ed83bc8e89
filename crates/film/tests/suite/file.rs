//! Film files: round trips, merging, and files that are damaged, cut short or of other renders.

use alhazen_film::{
    Film, FilmFile, FilmFileError, FilmHeader, FilmWriter, PassSet, ReadLimits, State, compile,
};
use description::{FilterDesc, SceneDesc};
use math::Vec2;
use spectrum::{SampledSpectrum, SampledWavelengths};
use testkit::Random;

const RESOLUTION: [i32; 2] = [21, 18];

fn blank() -> Film {
    let mut desc = SceneDesc::default();
    desc.film.resolution = RESOLUTION;
    desc.film.pixel_bounds = Some([3, 21, 0, 17]);
    desc.film.save_fp16 = false;
    desc.filter.value = FilterDesc::Triangle { radius: [1.5, 1.0] };
    compile(&desc).expect("a film").film
}

/// Adds samples and splats of this pass, some of which are refused.
fn add_pass(film: &mut Film, pass: u32) {
    let mut random = Random::new(u64::from(pass));
    let bounds = film.pixel_bounds();
    for _ in 0..100 {
        let size = [bounds.width(), bounds.height()];
        let pixel = [0, 1].map(|i: usize| bounds.min[i] + (size[i] as f32 * random.get_1d()) as i32);
        let magnitude = 2f32.powf(50.0 * random.get_1d() - 25.0);
        let l = SampledSpectrum::new([(); 4].map(|()| magnitude * (random.get_1d() - 0.2)));
        let l = if random.get_1d() < 0.02 { SampledSpectrum::splat(f32::NAN) } else { l };
        let lambda = SampledWavelengths::sample_visible(random.get_1d());
        film.add_sample(pixel, &l, &lambda, 2.0 * random.get_1d() - 0.5);
        let at = Vec2::new(pixel[0] as f32 + random.get_1d(), pixel[1] as f32 + random.get_1d());
        film.tiles_and_splatter().expect("memory").1.add(at, &l, &lambda);
    }
    film.tiles_and_splatter().expect("memory").1.add_paths(100);
}

fn film(passes: &PassSet) -> Film {
    let mut film = blank();
    let passes = passes.ranges().iter().cloned().flatten();
    passes.for_each(|pass| add_pass(&mut film, pass));
    film
}

fn header(done: &PassSet) -> FilmHeader {
    let scene_hash = std::array::from_fn(|i| 7 * i as u8);
    FilmHeader { scene_hash, settings: "spp = 8\nµ = 1".into(), seed: 3, planned: 8, done: done.clone() }
}

/// A file of these passes: picture, a film of splats beside it, a state.
fn bytes(passes: &PassSet) -> Vec<u8> {
    let picture = film(passes);
    let mut beside = picture.for_splats().expect("memory");
    let lambda = SampledWavelengths::sample_visible(0.4);
    beside.tiles_and_splatter().expect("memory").1.add(
        Vec2::new(12.0, 10.0),
        &SampledSpectrum::splat(3.0),
        &lambda,
    );
    let mut writer = FilmWriter::new(Vec::new(), &header(passes), &picture).expect("a file");
    writer.film("s1-t2", &beside).expect("a file");
    writer.state("chains", passes, b"anything").expect("a file");
    writer.finish().expect("a file")
}

fn read(bytes: &[u8]) -> Result<FilmFile, FilmFileError> {
    FilmFile::read(bytes, &ReadLimits::for_file(bytes.len() as u64))
}

fn passes(ranges: &[std::ops::Range<u32>]) -> PassSet {
    ranges.iter().fold(PassSet::new(), |set, range| set.union(&range.clone().into()))
}

fn floats(film: &Film) -> Vec<u32> {
    film.develop().expect("memory").values().map(f32::to_bits).collect()
}

#[test]
fn files_round_trip() {
    let passes = passes(&[0..2, 5..6]);
    let written = bytes(&passes);
    let file = read(&written).unwrap();
    let original = film(&passes);
    assert_eq!(file.header, header(&passes));
    assert_eq!(FilmFile::read_header(&written[..]).unwrap(), file.header);
    assert_eq!(floats(&file.picture), floats(&original));
    assert_eq!(file.picture.develop().unwrap().metadata, original.develop().unwrap().metadata);
    assert_eq!(file.picture.sample_count(), original.sample_count());
    assert!(original.rejected().count > 0);
    assert_eq!(file.picture.rejected(), original.rejected());
    assert_eq!(file.films.len(), 1);
    assert_eq!(file.films[0].0, "s1-t2");
    assert_eq!(file.states, [State { name: "chains".into(), passes, bytes: b"anything".into() }]);
    assert!(file.write(Vec::new()).unwrap() == written, "the same bytes when it is written again");
}

#[test]
fn a_film_that_was_read_continues_like_the_original() {
    let mut file = read(&bytes(&PassSet::from(0..3))).unwrap();
    add_pass(&mut file.picture, 3);
    assert_eq!(floats(&file.picture), floats(&film(&PassSet::from(0..4))));
}

#[test]
fn every_filter_is_read_as_it_was_written() {
    let radius = [1.75, 1.25];
    for filter in [
        FilterDesc::Box { radius },
        FilterDesc::Triangle { radius },
        FilterDesc::Gaussian { radius, sigma: 0.4 },
        FilterDesc::Mitchell { radius, b: 0.3, c: 0.35 },
        FilterDesc::LanczosSinc { radius, tau: 2.5 },
    ] {
        let mut desc = SceneDesc::default();
        desc.film.resolution = [4, 4];
        desc.filter.value = filter;
        let film = compile(&desc).unwrap().film;
        let written = FilmWriter::new(Vec::new(), &header(&PassSet::new()), &film).unwrap().finish().unwrap();
        let again = read(&written).unwrap().picture;
        let mut random = Random::new(7);
        for _ in 0..100 {
            let u = Vec2::new(random.get_1d(), random.get_1d());
            assert_eq!(again.filter().sample(u), film.filter().sample(u));
            let p = 4.0 * u - 2.0;
            assert_eq!(again.filter().evaluate(p), film.filter().evaluate(p));
        }
    }
}

#[test]
fn parts_merge_to_the_bits_of_the_whole_in_any_order() {
    let all = PassSet::from(0..8);
    let whole = film(&all);
    let parts = [passes(&[0..1, 6..8]), PassSet::from(1..4), PassSet::from(4..6)].map(|part| bytes(&part));
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
        let mut file = read(&parts[order[0]]).unwrap();
        for &part in &order[1..] {
            file.merge(&parts[part][..], &ReadLimits::default()).unwrap();
        }
        assert_eq!(file.header, header(&all));
        assert_eq!(file.header.done.missing(8), PassSet::new());
        assert_eq!(floats(&file.picture), floats(&whole));
        assert_eq!(file.picture.rejected(), whole.rejected());
        assert_eq!(file.states.len(), 3);
        let mut again = file.write(Vec::new()).unwrap();
        let same = read(&again).unwrap();
        assert_eq!(same.states, file.states);
        again.push(0);
        assert!(matches!(read(&again), Err(FilmFileError::Damaged { .. })), "bytes after the end");
    }
}

#[test]
fn files_of_other_renders_and_doubled_passes_are_refused() {
    let file = || read(&bytes(&PassSet::from(0..3))).unwrap();
    let refusal = |change: &dyn Fn(&mut FilmFile)| {
        let mut other = read(&bytes(&PassSet::from(3..4))).unwrap();
        change(&mut other);
        let limits = ReadLimits::default();
        file().merge(&other.write(Vec::new()).unwrap()[..], &limits).unwrap_err().to_string()
    };
    type Change<'a> = &'a dyn Fn(&mut FilmFile);
    let cases: [(Change, &str); 8] = [
        (&|file| file.header.scene_hash[3] ^= 1, "the scenes differ"),
        (&|file| file.header.settings.push(' '), "the settings differ"),
        (&|file| file.header.seed = 4, "the seeds differ"),
        (&|file| file.header.planned = 16, "the numbers of planned passes differ"),
        (&|file| file.header.done = PassSet::from(2..4), "both films hold passes 2"),
        (&|file| file.films.clear(), "only one has a film `s1-t2`"),
        (&|file| file.films[0].0 = "s2-t1".into(), "only one has a film `s2-t1`"),
        (&|file| file.picture = blank(), "the settings of the films differ"),
    ];
    for (change, message) in cases {
        let refusal = refusal(change);
        assert!(refusal.contains(message), "{refusal:?} lacks `{message}`");
    }
}

#[test]
fn files_of_any_shorter_length_are_refused() {
    let bytes = bytes(&PassSet::from(0..1));
    for length in 0..bytes.len() {
        match read(&bytes[..length]) {
            Err(FilmFileError::Foreign) if length < 8 => (),
            // The limit is for the length that is left.
            Err(FilmFileError::Damaged { .. } | FilmFileError::Limits(_)) => (),
            other => panic!("{length} of {} bytes: {other:?}", bytes.len()),
        }
    }
    assert!(matches!(FilmFile::read_header(&bytes[..100]), Ok(_) | Err(FilmFileError::Damaged { .. })));
}

#[test]
fn every_flipped_bit_is_detected() {
    let bytes = bytes(&PassSet::from(0..1));
    let mut random = Random::new(8);
    for byte in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[byte] ^= 1 << (8.0 * random.get_1d()) as u32;
        match (byte, read(&damaged).unwrap_err()) {
            (0..8, FilmFileError::Foreign) | (8..12, FilmFileError::Version(_)) => (),
            (12.., FilmFileError::Damaged { .. }) => (),
            (_, other) => panic!("byte {byte}: {other}"),
        }
    }
}

#[test]
fn errors_name_the_section_and_the_problem() {
    let bytes = bytes(&PassSet::from(0..1));
    let message = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
    assert_eq!(message(b"PNG"), "not a film file");
    let mut newer = bytes.clone();
    newer[8] = 3;
    assert_eq!(message(&newer), "a film file of version 3; this program reads version 2");
    let mut damaged = bytes.clone();
    damaged[40] ^= 1;
    let text = message(&damaged);
    assert!(text.starts_with("damaged film file: section HEAD: its checksum is "), "{text}");
    let text = message(&bytes[..bytes.len() - 1]);
    assert_eq!(text, "damaged film file: section END: the file ends early");
    // A length that the file could not have; nothing of that size is allocated.
    let mut long = bytes;
    long[16..24].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(message(&long).contains("section HEAD: its length is 18446744073709551615 bytes"));
}

/// A file whose film claims to have this many pixels, with right checksums.
fn claiming(resolution: [i32; 2]) -> Vec<u8> {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [8, 8];
    let film = compile(&desc).expect("a film file").film;
    let bytes = FilmWriter::new(Vec::new(), &header(&PassSet::new()), &film)
        .expect("a film file")
        .finish()
        .expect("a film file");
    // The FILM section follows the header: tag, length, the empty name, then sizes.
    let start = bytes.windows(4).position(|tag| tag == b"FILM").expect("a film file");
    let length = u64::from_le_bytes(bytes[start + 4..start + 12].try_into().expect("a film file")) as usize;
    let (payload, rest) = (start + 12..start + 12 + length, start + 12 + length + 4);
    let mut file = bytes[..payload.end].to_vec();
    for (offset, values) in [(4, resolution), (20, resolution)] {
        let at = payload.start + offset;
        file[at..at + 8].copy_from_slice(&values.map(i32::to_le_bytes).concat());
    }
    let checksum = crc32fast::hash(&file[start..]);
    file.extend(checksum.to_le_bytes());
    file.extend(&bytes[rest..]);
    file
}

#[test]
fn a_short_file_of_a_huge_film_is_refused_before_memory_is_taken() {
    assert!(read(&claiming([8, 8])).is_ok());
    for resolution in [[100_000, 100_000], [i32::MAX, i32::MAX]] {
        let error = read(&claiming(resolution)).unwrap_err();
        assert!(matches!(error, FilmFileError::Limits(_)), "{error}");
    }
    for resolution in [[0, 8], [-8, 8], [i32::MIN, i32::MAX]] {
        let error = read(&claiming(resolution)).unwrap_err();
        assert!(matches!(error, FilmFileError::Damaged { .. }), "{error}");
    }
}

#[test]
fn errors_of_reading_and_writing_are_passed_on() {
    #[derive(Debug)]
    struct Broken;
    impl std::io::Write for Broken {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::PermissionDenied.into())
        }
    }
    let error = FilmWriter::new(Broken, &header(&PassSet::new()), &blank()).unwrap_err();
    assert_eq!(error.to_string(), "the disk is full");
    let error = FilmFile::read(Broken, &ReadLimits::default()).unwrap_err();
    assert!(matches!(error, FilmFileError::Io(_)), "{error}");
}

#[test]
fn arbitrary_bytes_after_the_version_do_not_panic() {
    let start = bytes(&PassSet::from(0..1))[..12].to_vec();
    let mut random = Random::new(2);
    for length in 0..300 {
        let noise = (0..length).map(|_| (256.0 * random.get_1d()) as u8);
        let bytes: Vec<u8> = start.iter().copied().chain(noise).collect();
        assert!(read(&bytes).is_err());
    }
}
