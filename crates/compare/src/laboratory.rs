//! Carries out a plan: checks it, renders, measures.

use std::sync::Arc;

use alhazen::description::{Diagnostic, SceneDesc};
use alhazen::image::flip::{PIXELS_PER_DEGREE, hdr_flip};
use alhazen::image::{Image, Window};
use alhazen::integrators::{Control, PassError, Progress};
use alhazen::scene::{self, View};
use alhazen::{Overrides, film};

use super::measure::{measure, reference_noise};
use super::paired_renders::{PairedRenders, Subject};
use super::{
    Budget, Checkpoint, Comparison, Contender, Plan, PlanError, Reference, ReferenceSource, Run, Setup,
    settings,
};

/// The default budget of a reference, in budgets of a contender: its variance is then a sixteenth
/// of that of the same contender.
const REFERENCE_FACTOR: u32 = 16;

/// A valid plan, with its scene compiled.
pub struct Laboratory {
    setup: Setup,
    subject: Subject,
    contenders: Vec<Entry>,
    reference: ReferencePlan,
    /// Warnings about what is rendered differently than described.
    warnings: Vec<String>,
}

/// A contender with the description that it renders.
struct Entry {
    name: String,
    desc: SceneDesc,
    /// The overrides in `desc`.
    overrides: Overrides,
}

impl Entry {
    /// The error of a description that does not compile: of an override, or of the scene itself.
    fn error(&self, errors: Vec<Diagnostic>) -> PlanError {
        match self.overrides.blamed(&errors) {
            Some(error) => PlanError::Plan(format!("{}: {error}", self.name)),
            None => PlanError::Scene(errors),
        }
    }
}

enum ReferencePlan {
    Picture(Box<Reference>),
    /// To be rendered as two halves, each with this budget.
    Render(Box<Entry>, Budget),
}

impl Laboratory {
    /// Checks a plan for a scene and compiles it. Also returns warnings of what will be rendered
    /// differently than described.
    pub fn new(scene: &SceneDesc, plan: Plan) -> Result<(Self, Vec<Diagnostic>), PlanError> {
        let entry = |contender: &Contender, budget| entry(scene, &plan.overrides, contender, budget);
        let contenders: Vec<Entry> = plan
            .contenders
            .iter()
            .map(|contender| entry(contender, plan.budget))
            .collect::<Result<_, _>>()?;
        let first =
            contenders.first().ok_or_else(|| PlanError::Plan("there is no integrator to compare".into()))?;

        for (index, entry) in contenders.iter().enumerate() {
            if contenders[..index].iter().any(|before| before.name == entry.name) {
                return Err(PlanError::Plan(format!("{} is listed twice", entry.name)));
            }
        }

        let mut warnings = Vec::new();
        // One view for all, so that textures are filtered alike. With a budget of time it is made
        // for the scene's number of samples, as in a render.
        let view = View::compile(&first.desc, scene::world_from_render(&first.desc));
        let view = view.map_err(|errors| first.error(errors))?;
        warnings.extend(view.warnings);
        let compiled = scene::compile(first.desc.clone()).map_err(|errors| first.error(errors))?;
        warnings.extend(compiled.warnings);
        let film = film::compile(&first.desc).map_err(|errors| first.error(errors))?.film;
        let (bounds, desc) = (film.pixel_bounds(), &first.desc);
        let setup = Setup {
            title: plan.title,
            resolution: film.full_resolution(),
            pixel_bounds: [bounds.min[0], bounds.max[0], bounds.min[1], bounds.max[1]],
            budget: plan.budget,
            seed: desc.sampler.seed.unwrap_or(desc.options.seed),
            threads: plan.threads,
            filter: settings::listed(&desc.filter.value),
            changes: changes(&plan.overrides),
        };
        let reference = match plan.reference {
            ReferenceSource::Picture { name, picture } => {
                let picture = cropped_reference(&name, &picture, &setup).map_err(PlanError::Reference)?;
                ReferencePlan::Picture(Box::new(Reference { source: name, by: None, picture, noise: None }))
            }
            ReferenceSource::Render { by, samples_per_pixel } => {
                let half = match samples_per_pixel {
                    Some(samples) => Budget::Samples(samples.div_ceil(2)),
                    None => plan.budget.times(REFERENCE_FACTOR / 2),
                };
                ReferencePlan::Render(
                    Box::new(entry(by.as_ref().unwrap_or(&plan.contenders[0]), half)?),
                    half,
                )
            }
        };
        let warned = Vec::new();
        let subject = Subject {
            scene: Arc::new(compiled.scene),
            view: view.view,
            #[cfg(feature = "gpu")]
            kernels: plan.kernels,
        };
        let mut laboratory = Self { setup, subject, contenders, reference, warnings: warned };
        for (name, value) in &plan.overrides.settings {
            let takes = |entry: &Entry| entry.overrides.settings.iter().any(|(taken, _)| taken == name);
            if !laboratory.entries().any(takes) {
                let message = format!("cannot set {name} to `{value}`: no algorithm here has such a setting");
                return Err(PlanError::Plan(message));
            }
        }
        for entry in laboratory.entries() {
            let pair = PairedRenders::new(&entry.desc, &laboratory.subject, laboratory.setup.seed);
            let (_, more) = pair.map_err(|errors| entry.error(errors))?;
            warnings.extend(more.into_iter().filter(|more| !warnings.contains(more)).collect::<Vec<_>>());
        }
        laboratory.warnings = warnings.iter().map(|warning| warning.message.clone()).collect();
        Ok((laboratory, warnings))
    }

    fn entries(&self) -> impl Iterator<Item = &Entry> {
        let reference = match &self.reference {
            ReferencePlan::Picture(_) => None,
            ReferencePlan::Render(entry, _) => Some(&**entry),
        };
        self.contenders.iter().chain(reference)
    }

    /// Renders the reference, then all contenders in turn, on the threads of rayon's current pool,
    /// and measures them. `progress` is called with the name of what is rendered, at its start and
    /// after each pass of both pictures.
    ///
    /// After a cancellation the comparison covers what has been done. `Err` means that there is
    /// nothing to compare: no contender has completed a pass, or memory ran out.
    pub fn compare(
        self,
        control: &Control,
        progress: &mut dyn FnMut(&str, &Progress),
    ) -> Result<Comparison, PassError> {
        let Self { setup, subject, contenders, reference, warnings } = self;
        let reference = match reference {
            ReferencePlan::Picture(reference) => *reference,
            ReferencePlan::Render(entry, half) => {
                // Different seeds: errors against a reference with the same samples would be too
                // small.
                let pair = paired_renders(&entry, &subject, setup.seed.wrapping_add(2))?;
                render_reference(&entry, half, pair, control, progress)?
            }
        };
        let (mut runs, mut missing) = (Vec::new(), Vec::new());
        let mut interrupted = false;
        for entry in &contenders {
            let mut run = || {
                let pair = paired_renders(entry, &subject, setup.seed)?;
                run(entry, &setup, pair, &reference, control, progress)
            };
            let run = if interrupted { None } else { run()? };
            interrupted |= run.as_ref().is_none_or(|run| run.interrupted);
            match run {
                Some(run) => runs.push(run),
                None => missing.push(entry.name.clone()),
            }
        }
        if runs.is_empty() {
            return Err(PassError::Cancelled);
        }
        Ok(Comparison { setup, reference, runs, missing, warnings })
    }
}

/// A contender with its description. Pictures are measured in single precision, and the laboratory
/// sets the seeds.
fn entry(
    scene: &SceneDesc,
    overrides: &Overrides,
    contender: &Contender,
    budget: Budget,
) -> Result<Entry, PlanError> {
    let samples_per_pixel = match budget {
        Budget::Time(_) => overrides.samples_per_pixel,
        Budget::Samples(samples) => Some(samples),
    };
    let shared = Overrides { samples_per_pixel, ..overrides.clone() };
    let overrides = contender.overrides(scene, &shared);
    let mut desc = contender.scene(scene, &overrides).map_err(PlanError::Plan)?;
    desc.film.save_fp16 = false;
    Ok(Entry { name: contender.title(&desc), desc, overrides })
}

/// The overrides of all contenders, as `key=value`.
fn changes(overrides: &Overrides) -> Vec<String> {
    let accelerator = overrides.accelerator.iter().map(|name| format!("accelerator={name}"));
    accelerator.chain(overrides.settings.iter().map(|(key, value)| format!("{key}={value}"))).collect()
}

/// The part of a given reference that corresponds to the pixels rendered.
fn cropped_reference(name: &str, picture: &Image, setup: &Setup) -> Result<Image, String> {
    let [x0, x1, y0, y1] = setup.pixel_bounds;
    let [width, height] = setup.resolution;
    let size = [picture.width() as i32, picture.height() as i32];
    if size == [x1 - x0, y1 - y0] {
        return Ok(picture.clone());
    }
    if size == [width, height] {
        return picture.crop(Window { min: [x0, y0], max: [x1, y1] }).map_err(|error| error.to_string());
    }
    Err(format!(
        "the reference {name} has {} × {} pixels, not the scene's {} × {}",
        size[0],
        size[1],
        x1 - x0,
        y1 - y0
    ))
}

fn render_reference(
    entry: &Entry,
    half: Budget,
    mut pair: PairedRenders,
    control: &Control,
    progress: &mut dyn FnMut(&str, &Progress),
) -> Result<Reference, PassError> {
    let name = format!("reference by {}", entry.name);
    pair.render(half, control, &mut |now| progress(&name, now), |_| Ok(()))?;
    let halves = pair.pictures()?;
    let picture = Image::try_from_fn(halves[0].width(), halves[0].height(), ["R", "G", "B"], |x, y| {
        let [a, b] = [0, 1].map(|half: usize| halves[half].rgb(x, y));
        std::array::from_fn(|c| (a[c] + b[c]) / 2.0)
    })?;
    let mut reference = Reference {
        source: format!(
            "{}, twice {} passes in {:.1} s",
            entry.name,
            pair.effort().passes,
            2.0 * pair.effort().seconds
        ),
        by: Some(entry.name.clone()),
        noise: Some(reference_noise(&halves, &picture)),
        picture,
    };
    reference.picture.metadata = halves[0].metadata.clone();
    Ok(reference)
}

/// Renders and measures one contender; `None` if it was cancelled before its first pass was done,
/// and an error if memory ran out.
fn run(
    entry: &Entry,
    setup: &Setup,
    mut pair: PairedRenders,
    reference: &Reference,
    control: &Control,
    progress: &mut dyn FnMut(&str, &Progress),
) -> Result<Option<Run>, PassError> {
    let mut checkpoints = Vec::new();
    let outcome = pair.render(setup.budget, control, &mut |now| progress(&entry.name, now), |pair| {
        let effort = pair.effort();
        checkpoints.push(Checkpoint {
            passes: effort.passes,
            seconds: effort.seconds,
            rays: effort.rays,
            measure: measure(&pair.pictures()?, &reference.picture, reference.noise),
        });
        Ok(())
    });
    if let Err(error @ PassError::OutOfMemory(_)) = outcome {
        return Err(error);
    }
    if checkpoints.is_empty() {
        return Ok(None);
    }
    let pictures = pair.pictures()?;
    let flip = hdr_flip(&reference.picture, &pictures[0], PIXELS_PER_DEGREE).ok().map(|flip| flip.mean);
    Ok(Some(Run {
        name: entry.name.clone(),
        settings: settings::listed(&entry.desc.integrator.value).split_off(1),
        sampler: settings::of_sampler(&entry.desc.sampler.kind),
        notes: pair.notes(),
        checkpoints,
        pictures,
        flip,
        interrupted: outcome.is_err(),
    }))
}

/// Pairs that were built before with another seed: only memory can be lacking now.
fn paired_renders(entry: &Entry, subject: &Subject, seed: i32) -> Result<PairedRenders, PassError> {
    let pair = PairedRenders::new(&entry.desc, subject, seed);
    pair.map(|(pair, _)| pair).map_err(|errors| {
        let problems: Vec<String> = errors.into_iter().map(|error| error.message).collect();
        PassError::OutOfMemory(problems.join("; "))
    })
}
