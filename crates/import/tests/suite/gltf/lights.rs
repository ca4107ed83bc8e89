//! Lights, emission, cameras, and what scenes without them get.

use super::{File, mesh};
use description::{
    CameraKind, EdgeMode, IntegratorDesc, LightKind, MaterialKind, SceneDesc, Severity, SpectrumDesc,
    UvImageDesc, WrapMode,
};
use math::{DVec3, Point2};
use serde_json::{Value, json};

/// A quadrilateral in a light at a distance of 2 before it.
fn lit(light: Value) -> File {
    let mut file = File::quad(json!({}));
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    file.json["nodes"] =
        json!([{"mesh": 0}, {"translation": [0, 0, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    file
}

fn only_light(desc: &SceneDesc) -> &description::LightDesc {
    assert_eq!(desc.lights.len(), 1);
    desc.lights.iter().next().expect("a light").1
}

#[test]
fn lights_have_their_place_direction_and_brightness() {
    let desc = lit(json!({"type": "point", "intensity": 3, "color": [0.5, 0.25, 0]})).scene();
    let light = only_light(&desc);
    let LightKind::Point { intensity: SpectrumDesc::Rgb { rgb, .. }, .. } = &light.kind else {
        panic!("{light:?}")
    };
    assert_eq!((light.scale, *rgb), (1.5, [1.0, 0.5, 0.0]));
    assert_eq!(light.world_from_light.start.w_axis.truncate(), DVec3::new(0.0, 0.0, 2.0));
    let spot = json!({"innerConeAngle": 0.5, "outerConeAngle": 0.75});
    let desc = lit(json!({"type": "spot", "spot": spot})).scene();
    let LightKind::Spot { to, cone_angle, cone_delta_angle, .. } = only_light(&desc).kind else {
        panic!("no spot")
    };
    assert_eq!(to.z, -1.0);
    assert!((cone_angle - 0.75_f32.to_degrees()).abs() < 1e-4);
    assert!((cone_delta_angle - 0.25_f32.to_degrees()).abs() < 1e-4);
    let desc = lit(json!({"type": "directional", "intensity": 10})).scene();
    let light = only_light(&desc);
    assert!(matches!(light.kind, LightKind::Distant { illuminance: None, .. }));
    assert_eq!(light.scale, 10.0);
}

#[test]
fn bright_lights_are_exposed() {
    // 10⁵ lx, as in the sun: white is shown as 0.8.
    let desc = lit(json!({"type": "directional", "intensity": 1e5})).scene();
    let shown = 1e5 / std::f32::consts::PI * desc.film.sensor.iso / 100.0;
    assert!((shown - 0.8).abs() < 1e-3, "{shown}");
    let desc = lit(json!({"type": "directional", "intensity": 3})).scene();
    assert_eq!(desc.film.sensor.iso, 100.0);
}

#[test]
fn emission_is_a_light_on_the_front() {
    let mut material = json!({
        "emissiveFactor": [1, 0.5, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}},
    });
    let desc = File::quad(material.clone()).scene();
    let (_, light) = desc.area_lights.iter().next().expect("a light");
    assert_eq!(
        (light.scale, light.two_sided, &light.radiance),
        (4.0, false, &SpectrumDesc::rgb(1.0, 0.5, 0.0))
    );
    assert!(desc.lights.is_empty(), "no studio");
    material["doubleSided"] = json!(true);
    let desc = File::quad(material).scene();
    assert!(desc.area_lights.iter().next().expect("a light").1.two_sided);
}

#[test]
fn only_triangles_on_bright_texels_emit() {
    // The left half of the picture is black; one triangle lies in it.
    let mut file = File::quad(json!({
        "emissiveFactor": [1, 1, 1],
        "emissiveTexture": {"index": 0},
    }))
    .textured(&[[0, 0, 0, 255]; 32].into_iter().chain([[255; 4]; 32]).collect::<Vec<_>>());
    let uvs = file.floats("VEC2", &[0.1, 0.1, 0.4, 0.1, 0.4, 0.4, 0.9, 0.9]);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    let desc = file.scene();
    let emits: Vec<_> = desc
        .shapes
        .iter()
        .filter(|(_, shape)| {
            desc.objects.is_empty() && matches!(shape.kind, description::ShapeKind::Triangles(_))
        })
        .map(|(_, shape)| (shape.area_light.is_some(), mesh(shape).indices.to_vec()))
        .collect();
    assert_eq!(emits, [(true, vec![[0, 2, 3]]), (false, vec![[0, 1, 2]])]);
}

/// Emission and unlit colours by samplers and transforms, as those of other textures.
#[test]
fn emission_has_samplers_and_transforms() {
    let emissive = json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}});
    let unlit = json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "extensions": {"KHR_materials_unlit": {}},
    });
    for material in [emissive, unlit] {
        let mut file = File::quad(material).textured(&[[255; 4], [0, 0, 0, 255]]);
        let light = |file: &File| {
            let desc = file.scene();
            let map = desc.area_lights.iter().next().expect("a light").1.image.expect("an image");
            (map, desc.images[map.image].image.width(), mesh(desc.shapes.iter().next().unwrap().1).uvs[2])
        };
        // A sampler that says nothing repeats.
        assert_eq!(light(&file).0.wrap, WrapMode::Repeat);
        file.json["textures"][0]["sampler"] = json!(0);
        for (sampler, wrap, is_nearest, width) in [
            (json!({}), WrapMode::Repeat, false, 2),
            (json!({"magFilter": 9728}), WrapMode::Repeat, true, 2),
            (json!({"wrapS": 33071, "wrapT": 33071}), WrapMode::Clamp, false, 2),
            (json!({"wrapS": 33071}), WrapMode::Axes([EdgeMode::Clamp, EdgeMode::Repeat]), false, 2),
            (
                json!({"wrapS": 33648, "wrapT": 33071}),
                WrapMode::Axes([EdgeMode::Repeat, EdgeMode::Clamp]),
                false,
                4,
            ),
        ] {
            file.json["samplers"] = json!([sampler]);
            let (map, found, _) = light(&file);
            assert_eq!((map.wrap, map.is_nearest, found), (wrap, is_nearest, width), "{sampler}");
        }
        // The transform is of the mesh, if there is no normal map.
        file.json["samplers"] = json!([{}]);
        let moved = json!({"KHR_texture_transform": {"scale": [2, 2]}});
        let material = &mut file.json["materials"][0];
        let info = match material.get_mut("emissiveTexture") {
            Some(info) => info,
            None => &mut material["pbrMetallicRoughness"]["baseColorTexture"],
        };
        info["extensions"] = moved;
        let (map, _, uv) = light(&file);
        assert_eq!((map.columns, uv), (UvImageDesc::IDENTITY, Point2::new(2.0, 1.0)));
        // Beside one it is that of the emission alone.
        file.json["materials"][0]["normalTexture"] = json!({"index": 0});
        let (map, _, uv) = light(&file);
        assert_eq!((map.columns, uv), ([[2.0, 0.0], [0.0, 2.0], [0.0, -1.0]], Point2::new(1.0, 1.0)));
        assert!(file.messages(Severity::Warning).iter().all(|message| !message.contains("emission")));
    }
}

#[test]
fn triangles_on_other_tiles_of_a_bright_image_emit() {
    let file = |sampler: Value| {
        let mut file = File::quad(json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}))
            .textured(&[[0, 0, 0, 255]; 32].into_iter().chain([[255; 4]; 32]).collect::<Vec<_>>());
        file.json["textures"][0]["sampler"] = json!(0);
        file.json["samplers"] = json!([sampler]);
        // In the black half of the image two tiles away, and in the bright one.
        let uvs = file.floats("VEC2", &[-1.9, 0.1, -1.6, 0.1, -1.6, 0.4, -1.1, 0.9]);
        file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
        let desc = file.scene();
        desc.shapes.iter().filter(|(_, shape)| shape.area_light.is_some()).count()
    };
    assert_eq!(file(json!({})), 1);
    assert_eq!(file(json!({"wrapS": 33071})), 0, "the column at the left is black");
}

#[test]
fn unlit_surfaces_emit_their_color() {
    let desc = File::quad(json!({
        "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.8, 1]},
        "extensions": {"KHR_materials_unlit": {}},
    }))
    .scene();
    let (_, shape) = desc.shapes.iter().next().expect("a shape");
    let light = &desc.area_lights[shape.area_light.expect("a light")];
    assert_eq!((light.scale, &light.radiance), (0.8, &SpectrumDesc::rgb(0.25, 0.5, 1.0)));
    let material = &desc.materials[shape.material.expect("a material")].kind;
    assert!(matches!(material, MaterialKind::Diffuse { reflectance } if *reflectance == 0.0.into()));
}

/// Angles as exporters write them: in single precision, and equal ones for a sharp edge.
#[test]
fn cones_of_spots_are_taken_as_they_are_rounded() {
    let cone = |spot: Value| {
        let file = lit(json!({"type": "spot", "spot": spot}));
        let desc = file.scene();
        match only_light(&desc).kind {
            LightKind::Spot { cone_angle, cone_delta_angle, .. } => (cone_angle, cone_delta_angle),
            _ => panic!("no spot"),
        }
    };
    for outer in [std::f64::consts::FRAC_PI_2, 1.570_796_370_506_286_6, 1.570_796_4] {
        assert_eq!(cone(json!({"outerConeAngle": outer})), (90.0, 90.0));
    }
    for inner in [0.5, 0.500_000_05] {
        assert_eq!(cone(json!({"innerConeAngle": inner, "outerConeAngle": 0.5})).1, 0.0);
    }
    for (spot, message) in [
        (
            json!({"innerConeAngle": 0.6, "outerConeAngle": 0.5}),
            "/innerConeAngle: the inner angle of a cone is",
        ),
        (json!({"outerConeAngle": 1.6}), "/outerConeAngle: this must be between 0 and 1.57"),
        (json!({"outerConeAngle": 0}), "/outerConeAngle: the angle of a cone is above 0"),
    ] {
        let errors = lit(json!({"type": "spot", "spot": spot})).messages(Severity::Error);
        let place = format!("/extensions/KHR_lights_punctual/lights/0/spot{message}");
        assert!(errors.len() == 1 && errors[0].starts_with(&place), "{errors:?}");
    }
}

/// A quadrilateral seen by a camera 5 units before it.
fn seen(camera: Value) -> File {
    let mut file = File::quad(json!({}));
    file.json["cameras"] = json!([camera]);
    file.json["nodes"] = json!([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5], "scale": [2, 2, 2]}]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    file
}

#[test]
fn cameras_look_along_minus_z() {
    let desc = seen(json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}})).scene();
    let CameraKind::Perspective { fov, .. } = desc.camera.kind else { panic!("no perspective") };
    assert!((fov - 1.0_f32.to_degrees()).abs() < 1e-4);
    assert_eq!(desc.film.resolution, [1280, 720]);
    let seen_at = |x, y| desc.camera.camera_from_world.start.transform_point3(DVec3::new(x, y, 0.0));
    for (found, expected) in [(seen_at(0.0, 0.0), [0.0, 0.0, 5.0]), (seen_at(1.0, 2.0), [1.0, 2.0, 5.0])] {
        assert!((found - DVec3::from(expected)).length() < 1e-9, "{found}");
    }
    // The field of view of a high picture is over its width.
    let desc = seen(json!({"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 0.5}})).scene();
    let CameraKind::Perspective { fov, .. } = desc.camera.kind else { panic!("no perspective") };
    assert!(((fov.to_radians() / 2.0).tan() - 0.5 * 0.5_f32.tan()).abs() < 1e-5, "{fov}");
    assert_eq!(desc.film.resolution, [360, 720]);
    let desc = seen(json!({"type": "orthographic", "orthographic": {"xmag": 4, "ymag": 2}})).scene();
    let CameraKind::Orthographic { screen, .. } = desc.camera.kind else { panic!("no orthographic") };
    assert_eq!((screen.window, desc.film.resolution), (Some([-4.0, 4.0, -2.0, 2.0]), [1280, 640]));
}

#[test]
fn a_scene_without_light_or_camera_is_shown_in_a_studio() {
    let bare = File::quad(json!({}));
    let desc = bare.scene();
    assert_eq!((desc.lights.len(), desc.shapes.len()), (1, 2), "light, and a ground beside the surface");
    assert!(bare.messages(Severity::Warning)[0].contains("no light"));
    let desc = seen(json!({"type": "perspective", "perspective": {"yfov": 1.0}})).scene();
    assert_eq!((desc.lights.len(), desc.shapes.len()), (1, 1), "light only");
    let desc = lit(json!({"type": "point"})).scene();
    assert_eq!((desc.lights.len(), desc.shapes.len()), (1, 1), "neither");
    assert!(matches!(desc.integrator.value, IntegratorDesc::Path(_)));
}
