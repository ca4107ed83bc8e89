//! Building each algorithm and sampler that can be described.

use alhazen_integrators::build;
use description::schema::Settings;
use description::{
    AmbientOcclusionDesc, BdptDesc, CameraKind, Diagnostic, FunctionDesc, Handle, InstanceDesc,
    IntegratorDesc, LightSamplerDesc, LightTracingDesc, MltDesc, MltTechnique, ObjectDesc, Origin, PathDesc,
    PhotonMappingDesc, RadiosityDesc, RandomWalkDesc, RealisticCameraDesc, SamplerDesc, SamplerKind,
    SceneDesc, ShapeDesc, ShapeKind, SimplePathDesc, SolidOperation, Span, Spanned, SppmDesc, Stated,
    TransformDesc, VcmDesc, WhittedDesc,
};

use crate::support::{compile, diffuse, glass, mirror, sphere, white_sky};

fn messages(diagnostics: &[Diagnostic]) -> Vec<&str> {
    diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect()
}

fn warnings(integrator: IntegratorDesc) -> Vec<Diagnostic> {
    let desc = SceneDesc { integrator: integrator.into(), ..SceneDesc::default() };
    build(&desc).ok().unwrap().warnings
}

#[test]
fn supported_algorithms_build_without_warnings() {
    let light_sampler = LightSamplerDesc::Exhaustive;
    for integrator in [
        IntegratorDesc::RayCasting,
        IntegratorDesc::Whitted(WhittedDesc { max_depth: 0, ..Default::default() }),
        IntegratorDesc::AmbientOcclusion(AmbientOcclusionDesc { cos_sample: false, max_distance: 1.0 }),
        IntegratorDesc::RandomWalk(RandomWalkDesc { max_depth: 5 }),
        IntegratorDesc::SimplePath(SimplePathDesc { max_depth: 5, sample_lights: true, sample_bsdf: true }),
        IntegratorDesc::Path(PathDesc { max_depth: 5, regularize: true, light_sampler }),
        IntegratorDesc::VolPath(PathDesc { max_depth: 5, regularize: true, light_sampler }),
        IntegratorDesc::Mlt(MltDesc::default()),
        IntegratorDesc::PhotonMapping(PhotonMappingDesc::default()),
        IntegratorDesc::Sppm(SppmDesc::default()),
        IntegratorDesc::Vcm(VcmDesc::default()),
        IntegratorDesc::Function(FunctionDesc::default()),
    ] {
        assert_eq!(warnings(integrator), []);
    }
}

#[test]
fn light_paths_do_not_reach_a_camera_with_lenses() {
    let span = Span { start: 7, ..Span::NONE };
    let built = |integrator: IntegratorDesc| {
        let origin = Origin { span, parameters: Vec::new() };
        let mut desc = SceneDesc { integrator: Stated::new(integrator, origin), ..SceneDesc::default() };
        desc.camera.kind = CameraKind::Realistic(RealisticCameraDesc::default());
        build(&desc).map(|built| built.warnings)
    };
    let over_paths = MltDesc { technique: MltTechnique::Path, ..MltDesc::default() };
    for integrator in [IntegratorDesc::Path(PathDesc::default()), IntegratorDesc::Mlt(over_paths)] {
        assert_eq!(built(integrator).ok().unwrap(), []);
    }
    for (integrator, name, instead) in [
        (IntegratorDesc::Bdpt(BdptDesc::default()), "bdpt", "caustics of point"),
        (IntegratorDesc::Mlt(MltDesc::default()), "mlt", "caustics of point"),
        (IntegratorDesc::Vcm(VcmDesc::default()), "vcm", "photons take their place"),
    ] {
        let [warning] = &built(integrator).ok().unwrap()[..] else { panic!("one warning for `{name}`") };
        let start = format!("`{name}` cannot connect light paths to a `realistic` camera; {instead}");
        assert!(warning.message.starts_with(&start), "{}", warning.message);
        assert!(!warning.is_error() && warning.span() == span);
    }
    let errors = built(IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 5 })).err().unwrap();
    assert_eq!(messages(&errors), ["`light-tracing` cannot connect light paths to a `realistic` camera"]);
    assert!(errors[0].is_error() && errors[0].span() == span);
}

#[test]
fn radiosity_warns_of_unsupported_materials_and_shapes() {
    let mut desc = SceneDesc::default();
    desc.integrator.value = IntegratorDesc::Radiosity(RadiosityDesc::default());
    let (metal, paper, unused) = (mirror(&mut desc, 0.1), diffuse(&mut desc, 0.5), glass(&mut desc));
    for material in [metal, paper, metal] {
        desc.shapes.push(ShapeDesc { material, ..sphere(1.0).into() });
    }
    assert!(unused.is_some());
    desc.shapes.push(ShapeKind::Plane.into());
    let told = build(&desc).ok().unwrap().integrator.warnings(&compile(&desc));
    assert_eq!(
        messages(&told),
        [
            "this material is not diffuse; radiosity draws it by its albedo",
            "shape `plane` cannot be cut into patches; in radiosity it receives light, but does not reflect it to others",
        ]
    );
}

#[test]
fn light_from_infinity_on_unbounded_shapes_gives_a_warning() {
    let mut desc = SceneDesc::default();
    let object = |shape: ShapeDesc| {
        let mut object = ObjectDesc::default();
        object.shapes.push_stated(Stated::new(shape, Origin::new(Span { start: 5, ..Span::NONE })));
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
    for _ in 0..2 {
        desc.instances.push(InstanceDesc { object: drawn, world_from_object: TransformDesc::default() });
    }
    for (shape, start) in [(dome, 1), (bump, 2), (ShapeKind::Plane.into(), 3), (sphere(1.0).into(), 4)] {
        desc.shapes.push_stated(Stated::new(shape, Origin::new(Span { start, ..Span::NONE })));
    }
    let algorithms = [
        ("light-tracing", IntegratorDesc::LightTracing(LightTracingDesc { max_depth: 5 })),
        ("photon-mapping", IntegratorDesc::PhotonMapping(PhotonMappingDesc::default())),
        ("sppm", IntegratorDesc::Sppm(SppmDesc::default())),
    ];
    let told = |desc: &SceneDesc, integrator: &IntegratorDesc| {
        let desc = SceneDesc { integrator: integrator.clone().into(), ..desc.clone() };
        build(&desc).ok().unwrap().integrator.warnings(&compile(&desc))
    };
    assert!(algorithms.iter().all(|(_, integrator)| told(&desc, integrator).is_empty()));
    white_sky(&mut desc);
    for (name, integrator) in &algorithms {
        let found = told(&desc, integrator);
        let message = |what: &str| {
            format!(
                "light from infinity does not reach {what} beyond the scene's bounds; {name} renders it too dark there"
            )
        };
        let found: Vec<_> =
            found.iter().map(|warning| (&*warning.message, warning.count, warning.span().start)).collect();
        assert_eq!(found, [(&*message("an unbounded solid"), 1, 2), (&*message("an infinite plane"), 2, 3)]);
    }
    let from_both_ends = IntegratorDesc::Vcm(VcmDesc::default());
    assert!(told(&desc, &from_both_ends).is_empty());
}

#[test]
fn invalid_radiosity_settings_are_errors() {
    let settings = RadiosityDesc {
        max_depth: 101,
        patch_size: Some(0.0),
        tolerance: 1.0,
        steps: 0,
        hemicube_resolution: 2_000_000_000,
        max_patches: 2_000_000,
        mesh_out: Some("room.obj".into()),
        ..RadiosityDesc::default()
    };
    let integrator = IntegratorDesc::Radiosity(settings).into();
    let errors = build(&SceneDesc { integrator, ..SceneDesc::default() }).err().unwrap();
    assert_eq!(
        messages(&errors),
        [
            "`maxdepth` is a whole number from 0 to 100, not 101",
            "`hemicuberesolution` is a whole number from 2 to 1024, not 2000000000",
            "`patchsize` is a number above 0, not 0",
            "`maxpatches` is a whole number from 1 to 1000000, not 2000000",
            "`tolerance` is a number between 0 and 1, not 1",
            "`steps` is a whole number of 1 or more, not 0",
            "`mesh-out` is a name that ends in .ply, not room.obj",
        ]
    );
}

fn with_sampler(kind: SamplerKind) -> SceneDesc {
    SceneDesc { sampler: SamplerDesc { kind, seed: None }.into(), ..SceneDesc::default() }
}

#[test]
fn the_sampler_determines_the_number_of_passes() {
    for mut kind in SamplerKind::members() {
        kind.set_samples_per_pixel(6);
        let built = build(&with_sampler(kind.clone())).ok().unwrap();
        assert_eq!(built.integrator.passes(), 6, "{kind:?}");
        assert_eq!(built.warnings, [], "{kind:?}");
    }
}

#[test]
fn invalid_settings_are_errors_at_their_parameter() {
    let span = Span { start: 7, ..Span::NONE };
    let origin = Origin { span: Span::NONE, parameters: vec![("alpha", span), ("pixelsamples", span)] };
    let mut desc = with_sampler(SamplerKind::Independent { pixel_samples: 0 });
    desc.sampler.origin = origin.clone();
    let vcm = VcmDesc { alpha: f32::NAN, ..VcmDesc::default() };
    desc.integrator = Stated::new(IntegratorDesc::Vcm(vcm), origin);
    let errors = build(&desc).err().unwrap();
    assert_eq!(
        messages(&errors),
        [
            "`pixelsamples` is a whole number of 1 or more, not 0",
            "`alpha` is a number above 0 and at most 1, not NaN"
        ]
    );
    assert!(errors.iter().all(|error| error.is_error() && error.span() == span));
}

#[test]
fn invalid_photon_settings_are_errors_at_their_parameter() {
    let names = ["nearest", "radius"];
    let spans = names.map(|name| (name, Span { start: name.len() as u32, ..Span::NONE }));
    let origin = Origin { span: Span::NONE, parameters: spans.to_vec() };
    let photons = PhotonMappingDesc { nearest: 0, radius: Some(f32::NAN), ..PhotonMappingDesc::default() };
    let integrator = Stated::new(IntegratorDesc::PhotonMapping(photons), origin);
    let errors = build(&SceneDesc { integrator, ..SceneDesc::default() }).err().unwrap();
    assert_eq!(
        messages(&errors),
        ["`nearest` is a whole number of 1 or more, not 0", "`radius` is a number above 0, not NaN"]
    );
    assert!(errors.iter().zip(spans).all(|(error, (_, span))| error.is_error() && error.span() == span));
}

#[test]
fn invalid_merging_settings_are_errors() {
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
            "`radius` is a number above 0, not {radius}; `alpha` is a number above 0 and at most 1, not {alpha}"
        );
        assert_eq!(errors(IntegratorDesc::Vcm(vcm)), expected);
    }
    let sppm = SppmDesc { photons_per_iteration: Some(0), radius: Some(f32::NAN), ..SppmDesc::default() };
    assert_eq!(
        errors(IntegratorDesc::Sppm(sppm)),
        "`photonsperiteration` is a whole number of 1 or more, not 0; `radius` is a number above 0, not NaN"
    );
}
