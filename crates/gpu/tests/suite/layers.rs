//! Layers beside the colour by both engines.

use alhazen_gpu::Algorithm;
use description::{LightTracingDesc, PathDesc, Span, Spanned};
use film::Layer;
use image::PixelSource;

use crate::pictures::{Case, SAMPLES};
use crate::texts::MEDLEY;

fn named(layer: Layer) -> Spanned<String> {
    Spanned::new(layer.name().to_owned(), Span::NONE)
}

/// The first hits are found by the CPU in any case; variances are those of the kernel's light.
#[test]
fn layers_have_the_picture_of_the_cpu() {
    let mut case = Case::of_text(MEDLEY);
    let layers = Layer::ALL.into_iter().filter(|layer| !layer.is_part());
    case.desc.film.layers = layers.map(named).collect();
    let path = Algorithm::Path(PathDesc { max_depth: 4, regularize: true, ..PathDesc::default() });
    let Some(renderer) = case.renderer(&path) else { return };
    let (gpu, session) = (case.exposed(&renderer), case.session(&path, SAMPLES));
    let (gpu, cpu) = (gpu.development(), session.state().film.development());
    let names: Vec<String> = cpu.channels().into_iter().map(|channel| channel.name).collect();
    let mut rows = [vec![0.0; cpu.width() as usize * names.len()], Vec::new()];
    rows[1] = rows[0].clone();
    let mut apart = vec![0; names.len()];
    for y in 0..cpu.height() {
        gpu.row(y, &mut rows[0]);
        cpu.row(y, &mut rows[1]);
        for (i, (a, b)) in rows[0].iter().zip(&rows[1]).enumerate() {
            let is_same = a == b || (a - b).abs() <= 1e-3 * b.abs().max(0.01);
            apart[i % names.len()] += usize::from(!is_same);
        }
    }
    let most = (cpu.width() * cpu.height() / 100) as usize;
    let all: Vec<_> = names.iter().zip(&apart).collect();
    println!("{all:?}");
    let wrong: Vec<_> = all.iter().filter(|(_, apart)| **apart > most).collect();
    assert!(names.len() > 40 && wrong.is_empty(), "{wrong:?}");
}

#[test]
fn layers_that_kernels_do_not_have_are_refused() {
    let mut case = Case::of_text(MEDLEY);
    let light_tracing = Algorithm::LightTracing(LightTracingDesc::default());
    let path = Algorithm::Path(PathDesc::default());
    for (layer, algorithm, what) in [
        (Layer::Diffuse, path, "layers of parts of the light"),
        (Layer::Depth, light_tracing, "layers beside the colour with light paths"),
    ] {
        case.desc.film.layers = vec![named(layer)];
        let refusals = case.flatten(&algorithm).err().unwrap_or_default();
        assert!(refusals.iter().any(|refusal| refusal.what == what), "{refusals:?}");
    }
}
