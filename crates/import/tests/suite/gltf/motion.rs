//! Skins, morph targets and animations.

use super::{File, mesh};
use description::SceneDesc;
use math::{DVec3, Vec3};
use serde_json::json;

fn points(desc: &SceneDesc) -> Vec<Vec3> {
    mesh(desc.shapes.iter().next().expect("a shape").1).positions.to_vec()
}

#[test]
fn morph_targets_are_added_by_their_weights() {
    let mut file = File::quad(json!({}));
    let targets = [[0., 0., 2.].repeat(4), [4., 0., 0.].repeat(4)].map(|values| file.floats("VEC3", &values));
    file.json["meshes"][0]["primitives"][0]["targets"] =
        json!([{"POSITION": targets[0]}, {"POSITION": targets[1]}]);
    file.json["meshes"][0]["weights"] = json!([0.5, 0]);
    assert_eq!(points(&file.scene())[0], Vec3::new(-1.0, -1.0, 1.0));
    file.json["nodes"][0]["weights"] = json!([0, 0.25]);
    assert_eq!(points(&file.scene())[0], Vec3::new(0.0, -1.0, 0.0));
    // Weights of an animation; vertices move while the shutter is open.
    let (times, weights) = (file.floats("SCALAR", &[0., 1.]), file.floats("SCALAR", &[0., 0., 1., 0.]));
    file.json["animations"] = json!([{
        "samplers": [{"input": times, "output": weights}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
    }]);
    let desc = file.scene_of("a.glb#time=0.5,shutter=0.25");
    let (_, shape) = desc.shapes.iter().next().expect("a shape");
    assert_eq!(mesh(shape).positions[0].z, 1.0);
    assert_eq!(mesh(shape).later.iter().map(|key| key.positions[0].z).collect::<Vec<_>>(), [1.5]);
}

#[test]
fn skins_follow_their_joints() {
    let mut file = File::quad(json!({}));
    let inverse = [[1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.]; 2];
    let matrices = file.floats("MAT4", inverse.as_flattened());
    let weights = file
        .floats("VEC4", &[[1., 0., 0., 0.], [0., 1., 0., 0.], [0.5, 0.5, 0., 0.], [1., 0., 0., 0.]].concat());
    let view = file.view(&[[0, 1, 0, 0]; 4].concat());
    file.json["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"bufferView": view, "componentType": 5121, "count": 4, "type": "VEC4"}));
    let joints = file.json["accessors"].as_array().unwrap().len() - 1;
    let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    file.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": matrices}]);
    // The place of the node with the mesh does not matter.
    file.json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
        {"translation": [0, 0, 1], "children": [2]},
        {"translation": [0, 0, 2]},
    ]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let desc = file.scene();
    assert_eq!(points(&desc).iter().map(|p| p.z).collect::<Vec<_>>(), [1.0, 3.0, 2.0, 1.0]);
    assert_eq!(points(&desc)[0].x, -1.0);
    assert!(!desc.shapes.iter().next().expect("a shape").1.world_from_object.is_animated());
    file.json["skins"][0]["joints"] = json!([1]);
    let errors = file.messages(description::Severity::Error);
    assert!(errors[0].contains("joints that the skin does not have"), "{errors:?}");
}

/// Where a node is at a time of an animation of its translation along x.
fn at(interpolation: &str, values: &[f32], time: f32) -> f64 {
    let mut file = File::quad(json!({}));
    let (times, values) = (file.floats("SCALAR", &[1., 3.]), file.floats("VEC3", values));
    file.json["animations"] = json!([{
        "name": "slide",
        "samplers": [{"input": times, "output": values, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
    }]);
    let desc = file.scene_of(&format!("a.glb#animation=slide,time={time}"));
    desc.shapes.iter().next().expect("a shape").1.world_from_object.start.w_axis.x
}

#[test]
fn keys_are_interpolated_as_they_say() {
    let values = [2., 0., 0., 6., 0., 0.];
    for (time, linear, step) in
        [(0.0, 2.0, 2.0), (1.0, 2.0, 2.0), (2.5, 5.0, 2.0), (3.0, 6.0, 6.0), (9.0, 6.0, 6.0)]
    {
        assert_eq!(at("LINEAR", &values, time), linear, "{time}");
        assert_eq!(at("STEP", &values, time), step, "{time}");
    }
    // x = t³ from its values and derivatives at 1 and 3, which a cubic has exactly.
    let cubic = [0., 0., 0., 1., 0., 0., 3., 0., 0., 27., 0., 0., 27., 0., 0., 0., 0., 0.];
    for time in [1.0_f32, 1.5, 2.0, 2.75, 3.0] {
        let found = at("CUBICSPLINE", &cubic, time);
        assert!((found - f64::from(time).powi(3)).abs() < 1e-5, "{time}: {found}");
    }
}

#[test]
fn nodes_rest_unless_a_time_is_chosen_and_move_with_the_shutter() {
    let mut file = File::quad(json!({}));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let (times, turns) =
        (file.floats("SCALAR", &[0., 1.]), file.floats("VEC4", &[0., 0., 0., 1., 0., 0., half, half]));
    file.json["animations"] = json!([{
        "samplers": [{"input": times, "output": turns}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
    }]);
    file.json["nodes"][0]["translation"] = json!([0, 0, 3]);
    let place = |path: &str| file.scene_of(path).shapes.iter().next().expect("a shape").1.world_from_object;
    assert!(!place("a.glb").is_animated());
    let moving = place("a.glb#time=0,shutter=1");
    let turned = moving.end.transform_vector3(DVec3::X);
    assert!((turned - DVec3::Y).length() < 1e-6, "{turned}");
    assert_eq!(moving.start.transform_vector3(DVec3::X), DVec3::X);
    let angle = place("a.glb#time=0.5").start.transform_vector3(DVec3::X);
    assert!((angle.x - angle.y).abs() < 1e-6, "{angle}");
}
