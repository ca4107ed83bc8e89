//! Film files of renders, by which renders are resumed and their shards merged.
//!
//! The film format leaves two texts to the caller. The *settings* are what all parts of a render
//! have in common: the version of alhazen, the [`Overrides`], and the header of the picture. The
//! state `session` is what the parts may differ in: where the scene is, the limits, the shard, and
//! the time taken.

use std::io::{Read, Write};
use std::path::PathBuf;
use std::time::Duration;

use film::{Development, Film, FilmFile, FilmFileError, FilmHeader, FilmWriter, PassSet, ReadLimits};
use integrators::{Limits, Session, SessionState, noise};
use serde_json::{Value, json};

use crate::{Header, Overrides};

/// The name of the film that alternates with the picture's where noise is estimated.
const SECOND: &str = "second";

/// The name of the state that holds what parts of a render may differ in.
const SESSION: &str = "session";

/// Other versions may have other samples.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// One of the equal parts that the passes of a render are split into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// The index of the part, from 1 to `count`.
    pub index: u32,
    /// The number of parts.
    pub count: u32,
}

impl Shard {
    /// The whole render.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// Its passes, of `all` in the whole render.
    pub fn passes(self, all: u32) -> std::ops::Range<u32> {
        let end = |index: u32| (u64::from(all) * u64::from(index) / u64::from(self.count)) as u32;
        end(self.index - 1)..end(self.index)
    }
}

/// The order of a render: all that is needed to resume it.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOrder {
    /// The scene file.
    pub scene: PathBuf,
    /// The hash of its content.
    pub scene_hash: [u8; 32],
    /// Changes to the scene.
    pub overrides: Overrides,
    /// Samples per pixel of the whole render; `u32::MAX` where only time or noise end it.
    pub passes: u32,
    /// The part of the passes that is rendered.
    pub shard: Shard,
    /// Further limits that end it.
    pub limits: Limits,
}

impl RenderOrder {
    /// Writes a film file of a render between two passes, with the header of its pictures.
    pub fn write<W: Write>(&self, session: &Session, header: &Header, output: W) -> Result<W, FilmFileError> {
        let state = session.state();
        let film_header = FilmHeader {
            scene_hash: self.scene_hash,
            settings: self.settings(header).to_string(),
            seed: self.overrides.seed.map_or(0, |seed| seed as u64),
            planned: self.passes,
            done: state.done.clone(),
        };
        // Drafts left on the film are no part of the picture.
        let blank = state.done.is_empty().then(|| state.film.blank()).transpose()?;
        let mut writer = FilmWriter::new(output, &film_header, blank.as_ref().unwrap_or(&state.film))?;
        if let Some(second) = &state.second {
            writer.film(SECOND, second)?;
        }
        for (name, film) in session.integrator().films() {
            writer.film(&name, film)?;
        }
        writer.state(SESSION, &state.done, self.session(state).to_string().as_bytes())?;
        writer.finish()
    }

    /// What all parts of a render have in common.
    fn settings(&self, header: &Header) -> Value {
        let Overrides {
            integrator,
            settings,
            accelerator,
            samples_per_pixel,
            resolution,
            crop,
            pixel,
            seed,
            layers,
        } = &self.overrides;
        json!({
            "alhazen": VERSION,
            "integrator": integrator,
            "settings": settings,
            "accelerator": accelerator,
            "spp": samples_per_pixel,
            "resolution": resolution,
            "crop": crop,
            "pixel": pixel,
            "seed": seed,
            "layers": layers,
            "header": header.to_json(),
        })
    }

    /// What the parts of a render may differ in.
    fn session(&self, state: &SessionState) -> Value {
        json!({
            "scene": self.scene.to_string_lossy(),
            "shard": [self.shard.index, self.shard.count],
            "time": self.limits.time.map(|time| time.as_secs_f64()),
            "noise": self.limits.noise,
            "elapsed": state.elapsed.as_secs_f64(),
            "second": state.counts[1],
        })
    }
}

/// A render that was saved, or several shards of one.
#[derive(Debug)]
pub struct SavedRender {
    file: FilmFile,
    overrides: Overrides,
    header: Header,
    parts: Vec<Part>,
}

/// What the parts of a render may differ in.
#[derive(Clone, Debug)]
struct Part {
    scene: PathBuf,
    shard: Shard,
    limits: Limits,
    elapsed: Duration,
    on_second: u32,
}

impl SavedRender {
    /// Reads a film file.
    pub fn read(input: impl Read, limits: &ReadLimits) -> Result<Self, FilmFileError> {
        let file = FilmFile::read(input, limits)?;
        let size = |film: &Film| (film.full_resolution(), film.pixel_bounds());
        if file.films.iter().any(|(_, film)| size(film) != size(&file.picture)) {
            return Err(FilmFileError::Mismatch("its films have different pixel bounds".into()));
        }
        let settings: Value = serde_json::from_str(&file.header.settings).unwrap_or_default();
        if let Some(version) = settings["alhazen"].as_str().filter(|&version| version != VERSION) {
            let problem = format!("it was rendered by alhazen {version}; this is {VERSION}");
            return Err(FilmFileError::Mismatch(problem));
        }
        let (overrides, header) = overrides(&settings)
            .zip(Header::from_json(&settings["header"]))
            .ok_or_else(|| FilmFileError::Mismatch("its settings are not those of a render".into()))?;
        let mut saved = Self { file, overrides, header, parts: Vec::new() };
        saved.read_parts()?;
        Ok(saved)
    }

    /// Adds another part of the same render.
    pub fn merge(&mut self, input: impl Read, limits: &ReadLimits) -> Result<(), FilmFileError> {
        self.file.merge(input, limits)?;
        self.read_parts()
    }

    fn read_parts(&mut self) -> Result<(), FilmFileError> {
        let sessions = self.file.states.iter().filter(|state| state.name == SESSION);
        let parts = sessions.map(|state| part(&serde_json::from_slice(&state.bytes).ok()?));
        let parts: Option<Vec<Part>> = parts.collect();
        self.parts = parts
            .filter(|parts| !parts.is_empty())
            .ok_or_else(|| FilmFileError::Mismatch("it does not say what was rendered".into()))?;
        Ok(())
    }

    /// The order of the render; of several parts, that of the first.
    pub fn order(&self) -> RenderOrder {
        let first = &self.parts[0];
        RenderOrder {
            scene: first.scene.clone(),
            scene_hash: self.file.header.scene_hash,
            overrides: self.overrides.clone(),
            passes: self.file.header.planned,
            shard: first.shard,
            limits: first.limits,
        }
    }

    /// The shards of the merged files, in their order.
    pub fn shards(&self) -> Vec<Shard> {
        self.parts.iter().map(|part| part.shard).collect()
    }

    /// Writes a film file of all parts.
    pub fn write<W: Write>(&self, output: W) -> Result<W, FilmFileError> {
        self.file.write(output)
    }

    /// The passes that it holds.
    pub fn done(&self) -> &PassSet {
        &self.file.header.done
    }

    /// The picture of all parts with its layers.
    pub fn development(&self) -> Development<'_> {
        let development = Development::of_all(&self.file.picture, self.second());
        self.header.named(development, self.file.header.done.count())
    }

    /// The film that alternates with the first one.
    fn second(&self) -> Option<&Film> {
        self.file.films.iter().find(|(name, _)| name == SECOND).map(|(_, film)| film)
    }

    /// The numbers of passes of the first film and of the one that alternates with it.
    fn counts(&self) -> [u32; 2] {
        let done = self.file.header.done.count();
        let on_second = self.parts.iter().fold(0, |sum: u32, part| sum.saturating_add(part.on_second));
        let on_second = if self.second().is_some() { on_second.min(done) } else { 0 };
        [done - on_second, on_second]
    }

    /// The estimated relative standard error of the picture, as [`SessionState::noise`].
    pub fn noise(&self) -> Option<f64> {
        noise([&self.file.picture, self.second()?], self.counts())
    }

    /// The header of its pictures.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The shards and passes that the picture lacks, by name.
    pub fn missing(&self) -> Vec<String> {
        let planned = self.file.header.planned;
        if planned == u32::MAX {
            return Vec::new();
        }
        let missing = self.file.header.done.missing(planned);
        let count = self.parts[0].shard.count;
        if self.parts.iter().any(|part| part.shard.count != count) {
            return if missing.is_empty() { Vec::new() } else { vec![format!("passes {missing}")] };
        }
        let lacking = (1..=count).map(|index| {
            let passes = Shard { index, count }.passes(planned);
            (index, missing.intersection(&passes.into()))
        });
        let name = |(index, passes): (u32, PassSet)| match self.parts.iter().any(|p| p.shard.index == index) {
            true => format!("passes {passes} of shard {index}/{count}"),
            false => format!("shard {index}/{count} (passes {passes})"),
        };
        lacking.filter(|(_, passes)| !passes.is_empty()).map(name).collect()
    }

    /// The film and the rest of the state that a session resumes from; and the films that the
    /// algorithm has filled beside it, with their names.
    pub fn into_state(self) -> (SessionState, Vec<(String, Film)>) {
        let counts = self.counts();
        let Self { mut file, parts, .. } = self;
        let second = file.films.iter().position(|(name, _)| name == SECOND);
        let second = second.map(|index| file.films.remove(index).1);
        let state = SessionState {
            counts,
            done: file.header.done,
            film: file.picture,
            second,
            elapsed: parts.iter().fold(Duration::ZERO, |sum, part| sum.saturating_add(part.elapsed)),
        };
        (state, file.films)
    }
}

fn overrides(json: &Value) -> Option<Overrides> {
    let text = |name: &str| json[name].as_str().map(str::to_owned);
    let integer = |json: &Value| i32::try_from(json.as_i64()?).ok();
    let setting = |pair: &Value| Some((pair[0].as_str()?.to_owned(), pair[1].as_str()?.to_owned()));
    Some(Overrides {
        integrator: text("integrator"),
        settings: json["settings"].as_array()?.iter().map(setting).collect::<Option<_>>()?,
        accelerator: text("accelerator"),
        samples_per_pixel: json["spp"].as_u64().and_then(|samples| u32::try_from(samples).ok()),
        resolution: array(&json["resolution"], integer),
        crop: array(&json["crop"], |side| side.as_f64().map(|side| side as f32)),
        pixel: array(&json["pixel"], integer),
        seed: integer(&json["seed"]),
        layers: json["layers"]
            .as_array()?
            .iter()
            .map(|name| Some(name.as_str()?.to_owned()))
            .collect::<Option<_>>()?,
    })
}

fn array<T, const N: usize>(json: &Value, item: impl Fn(&Value) -> Option<T>) -> Option<[T; N]> {
    let items: Option<Vec<T>> = json.as_array()?.iter().map(item).collect();
    items?.try_into().ok()
}

fn part(json: &Value) -> Option<Part> {
    let time = |json: &Value| Duration::try_from_secs_f64(json.as_f64()?).ok();
    let number = |json: &Value| u32::try_from(json.as_u64()?).ok();
    let [index, count] = array(&json["shard"], number)?;
    (1..=count).contains(&index).then_some(())?;
    Some(Part {
        scene: PathBuf::from(json["scene"].as_str()?),
        shard: Shard { index, count },
        limits: Limits { time: time(&json["time"]), noise: json["noise"].as_f64() },
        elapsed: time(&json["elapsed"])?,
        on_second: number(&json["second"])?,
    })
}
