//! What becomes of each algorithm and sampler that can be described.

use alhazen_integrators::build;
use description::{
    Diagnostic, Handle, InstanceDesc, IntegratorDesc, LightSamplerDesc, MltDesc, ObjectDesc, Origin,
    PhotonMappingDesc, RadiosityDesc, SamplerDesc, SamplerKind, SceneDesc, ShapeDesc, ShapeKind,
    SolidOperation, Span, Spanned, SppmDesc, Stated, TransformDesc, VcmDesc,
};

use crate::support::{diffuse, glass, mirror, sphere, white_sky};

fn messages(diagnostics: &[Diagnostic]) -> Vec<&str> {
    diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect()
}

fn warnings(integrator: IntegratorDesc) -> Vec<Diagnostic> {
    let desc = SceneDesc { integrator: integrator.into(), ..SceneDesc::default() };
    build(&desc).ok().unwrap().warnings
}

#[test]
fn what_is_drawn_is_drawn_without_a_word() {
    let light_sampler = LightSamplerDesc::Power;
    for integrator in [
        IntegratorDesc::RayCasting,
        IntegratorDesc::Whitted { max_depth: 0 },
        IntegratorDesc::AmbientOcclusion { cos_sample: false, max_distance: 1.0 },
        IntegratorDesc::RandomWalk { max_depth: 5 },
        IntegratorDesc::SimplePath { max_depth: 5, sample_lights: true, sample_bsdf: true },
        IntegratorDesc::Path { max_depth: 5, regularize: true, light_sampler },
        IntegratorDesc::VolPath { max_depth: 5, regularize: true, light_sampler },
        IntegratorDesc::Mlt(MltDesc::default()),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc::default()),
        IntegratorDesc::Sppm(SppmDesc::default()),
        IntegratorDesc::Vcm(VcmDesc::default()),
    ] {
        assert_eq!(warnings(integrator), []);
    }
}

#[test]
fn what_is_not_drawn_yet_is_drawn_as_path_and_named() {
    let found = warnings(IntegratorDesc::SimpleVolPath { max_depth: 5 });
    assert_eq!(messages(&found), ["integrator `simplevolpath` is not drawn yet; drawn as `path`"]);
    let light_sampler = LightSamplerDesc::Exhaustive;
    let found = warnings(IntegratorDesc::Path { max_depth: 5, regularize: false, light_sampler });
    assert_eq!(messages(&found), ["light sampler `exhaustive` is not drawn yet; drawn with `bvh`"]);
}

#[test]
fn radiosity_tells_what_it_draws_otherwise() {
    let mut desc = SceneDesc::default();
    desc.integrator.value = IntegratorDesc::Radiosity(RadiosityDesc::default());
    let (metal, paper, unused) = (mirror(&mut desc, 0.1), diffuse(&mut desc, 0.5), glass(&mut desc));
    for material in [metal, paper, metal] {
        desc.shapes.push(ShapeDesc { material, ..sphere(1.0).into() });
    }
    assert!(unused.is_some());
    desc.shapes.push(ShapeKind::Plane.into());
    let told = build(&desc).ok().unwrap().warnings;
    assert_eq!(
        messages(&told),
        [
            "this material is not diffuse; radiosity draws it by its albedo",
            "a plane without end cannot be cut into patches; radiosity lights it, but it passes no light on",
        ]
    );
}

#[test]
fn light_from_infinity_tells_where_it_does_not_reach() {
    let mut desc = SceneDesc::default();
    let object = |shape: ShapeDesc| {
        let mut object = ObjectDesc::default();
        object.shapes.push(shape);
        object
    };
    let solid = |operation, operands: &[Handle<ObjectDesc>]| {
        let operands = operands.iter().map(|&operand| Spanned { value: operand, span: Span::NONE }).collect();
        ShapeDesc::from(ShapeKind::Solid { operation, operands })
    };
    let below = desc.objects.push(object(ShapeKind::Plane.into()));
    let ball = desc.objects.push(object(sphere(1.0).into()));
    let dome = solid(SolidOperation::Intersection, &[ball, below]);
    let pit = desc.objects.push(object(solid(SolidOperation::Difference, &[below, ball])));
    let bump = solid(SolidOperation::Union, &[pit, ball]);
    let drawn = desc.objects.push(object(ShapeKind::Plane.into()));
    desc.instances.push(InstanceDesc { object: drawn, world_from_object: TransformDesc::default() });
    for (shape, start) in [(dome, 1), (bump, 2), (ShapeKind::Plane.into(), 3), (sphere(1.0).into(), 4)] {
        desc.shapes.push_stated(Stated::new(shape, Origin::new(Span { start, ..Span::NONE })));
    }
    let algorithms = [
        ("light-tracing", IntegratorDesc::LightTracing { max_depth: 5 }),
        ("photon-mapping", IntegratorDesc::PhotonMapping(PhotonMappingDesc::default())),
        ("sppm", IntegratorDesc::Sppm(SppmDesc::default())),
    ];
    let told = |desc: &SceneDesc, integrator: &IntegratorDesc| {
        build(&SceneDesc { integrator: integrator.clone().into(), ..desc.clone() }).ok().unwrap().warnings
    };
    assert!(algorithms.iter().all(|(_, integrator)| told(&desc, integrator).is_empty()));
    white_sky(&mut desc);
    for (name, integrator) in &algorithms {
        let found = told(&desc, integrator);
        let message = |what: &str| {
            format!(
                "light from infinity does not reach {what} without end beyond the scene's bounds; {name} draws it too dark there"
            )
        };
        assert_eq!(messages(&found), [message("a solid"), message("a plane"), message("a plane")]);
        assert_eq!(found.iter().map(|warning| warning.span().start).collect::<Vec<_>>(), [2, 3, 0]);
    }
    let from_both_ends = IntegratorDesc::Vcm(VcmDesc::default());
    assert!(told(&desc, &from_both_ends).is_empty());
}

#[test]
fn radiosity_refuses_settings_without_sense() {
    let settings = RadiosityDesc {
        max_depth: -1,
        patch_size: Some(0.0),
        tolerance: 1.0,
        steps: 0,
        hemicube_resolution: 2_000_000_000,
        max_patches: i32::MAX,
        mesh_out: Some("room.obj".into()),
        ..RadiosityDesc::default()
    };
    let integrator = IntegratorDesc::Radiosity(settings).into();
    let errors = build(&SceneDesc { integrator, ..SceneDesc::default() }).err().unwrap();
    assert_eq!(
        messages(&errors),
        [
            "`hemicuberesolution` is from 2 to 1024, not 2000000000",
            "`maxdepth` is from 0 to 100, not -1",
            "`maxpatches` is from 1 to 1000000, not 2147483647",
            "`steps` is 1 or more, not 0",
            "`patchsize` is a number above 0, not 0",
            "`tolerance` is between 0 and 1, not 1",
            "the name of `mesh-out` ends in .ply, not as `room.obj`",
        ]
    );
}

fn with_sampler(kind: SamplerKind, pixel_samples: i32) -> SceneDesc {
    let sampler = SamplerDesc { kind, pixel_samples, seed: None }.into();
    SceneDesc { sampler, ..SceneDesc::default() }
}

#[test]
fn samplers_decide_the_number_of_passes() {
    let randomization = description::Randomization::FastOwen;
    for (kind, passes) in [
        (SamplerKind::Independent, 6),
        (SamplerKind::Stratified { strata: [3, 2], jitter: true }, 6),
        (SamplerKind::Halton { randomization: description::Randomization::Owen }, 6),
        (SamplerKind::PaddedSobol { randomization }, 6),
        (SamplerKind::Sobol { randomization }, 8),
        (SamplerKind::ZSobol { randomization }, 8),
        (SamplerKind::Pmj02Bn, 8),
    ] {
        let built = build(&with_sampler(kind.clone(), 6)).ok().unwrap();
        assert_eq!(built.integrator.passes(), passes, "{kind:?}");
        assert_eq!(built.warnings.len(), usize::from(kind == SamplerKind::Pmj02Bn));
    }
}

#[test]
fn settings_without_sense_are_errors_at_their_place() {
    let span = Span { start: 7, ..Span::NONE };
    let origin = Origin { span: Span::NONE, parameters: vec![("maxdepth", span), ("pixelsamples", span)] };
    let mut desc = with_sampler(SamplerKind::Independent, 0);
    desc.sampler.origin = origin.clone();
    desc.integrator = Stated::new(IntegratorDesc::Whitted { max_depth: -1 }, origin);
    let errors = build(&desc).err().unwrap();
    assert_eq!(
        messages(&errors),
        ["`pixelsamples` is a number above 0, not 0", "`maxdepth` is 0 or more, not -1"]
    );
    assert!(errors.iter().all(|error| error.is_error() && error.span() == span));
}

#[test]
fn photons_without_sense_are_errors_at_their_place() {
    let names = ["photons", "causticphotons", "nearest", "radius", "gather"];
    let spans = names.map(|name| (name, Span { start: name.len() as u32, ..Span::NONE }));
    let origin = Origin { span: Span::NONE, parameters: spans.to_vec() };
    let photons = PhotonMappingDesc {
        photons: -1,
        caustic_photons: -2,
        nearest: 0,
        radius: Some(f32::NAN),
        gather: -3,
        ..PhotonMappingDesc::default()
    };
    let integrator = Stated::new(IntegratorDesc::PhotonMapping(photons), origin);
    let errors = build(&SceneDesc { integrator, ..SceneDesc::default() }).err().unwrap();
    assert_eq!(
        messages(&errors),
        [
            "`photons` is 0 or more, not -1",
            "`causticphotons` is 0 or more, not -2",
            "`nearest` is 1 or more, not 0",
            "`radius` is a distance above 0, not NaN",
            "`gather` is 0 or more, not -3",
        ]
    );
    assert!(errors.iter().zip(spans).all(|(error, (_, span))| error.is_error() && error.span() == span));
}

#[test]
fn merging_needs_a_radius_a_rate_and_photons() {
    let span = Span { start: 7, ..Span::NONE };
    let parameters = ["radius", "alpha", "photonsperiteration"].map(|name| (name, span)).to_vec();
    let errors = |integrator: IntegratorDesc| {
        let origin = Origin { span: Span::NONE, parameters: parameters.clone() };
        let integrator = Stated::new(integrator, origin);
        let errors = build(&SceneDesc { integrator, ..SceneDesc::default() }).err().unwrap();
        assert!(errors.iter().all(|error| error.is_error() && error.span() == span));
        messages(&errors).join("; ")
    };
    for (radius, alpha) in [(0.0, 0.0), (-1.0, 1.5), (f32::INFINITY, f32::NAN)] {
        let vcm = VcmDesc { radius: Some(radius), alpha, ..VcmDesc::default() };
        let expected = format!(
            "`alpha` is above 0 and at most 1, not {alpha}; `radius` is a distance above 0, not {radius}"
        );
        assert_eq!(errors(IntegratorDesc::Vcm(vcm)), expected);
    }
    let sppm = SppmDesc { photons_per_iteration: Some(0), radius: Some(f32::NAN), ..SppmDesc::default() };
    assert_eq!(
        errors(IntegratorDesc::Sppm(sppm)),
        "the photons of a pass are a number above 0, not 0; `radius` is a distance above 0, not NaN"
    );
}
