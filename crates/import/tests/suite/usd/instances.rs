//! Instances of prims and of prototypes.

use super::{QUAD, corners, error, scene};
use description::SceneDesc;
use math::DVec3;

/// The places of all instances, and the objects that they are of.
fn places(desc: &SceneDesc) -> Vec<(usize, DVec3)> {
    let place = |instance: &description::InstanceDesc| {
        (instance.object.index(), instance.world_from_object.start.w_axis.truncate())
    };
    desc.instances.iter().map(|(_, instance)| place(instance)).collect()
}

fn at(x: f64) -> String {
    format!("double3 xformOp:translate = ({x}, 0, 0) uniform token[] xformOpOrder = [\"xformOp:translate\"]")
}

#[test]
fn instances_share_one_object() {
    let instance = |name: &str, x: f64| {
        format!("def Xform \"{name}\" (instanceable = true prepend references = </_chair>) {{ {} }}", at(x))
    };
    let desc = scene(&format!(
        "class \"_chair\" {{ def Xform \"seat\" {{ {} def Mesh \"m\" {{ {QUAD} }} }} def SphereLight \"l\" {{ float inputs:radius = 0 bool inputs:normalize = 1 }} }}
         {} {}",
        at(100.0),
        instance("a", 1.0),
        instance("b", 2.0)
    ));
    assert_eq!(places(&desc), [(0, DVec3::X), (0, 2.0 * DVec3::X)]);
    let (_, object) = desc.objects.iter().next().unwrap();
    let (_, shape) = object.shapes.iter().next().unwrap();
    assert_eq!(corners(shape)[0], [99000, -1000, 0]);
    let lights: Vec<_> = desc.lights.iter().map(|(_, light)| light.world_from_light.start.w_axis.x).collect();
    assert_eq!(lights, [1.0, 2.0]);
}

#[test]
fn instances_may_hold_instances() {
    let desc = scene(&format!(
        "class \"_leaf\" {{ def Mesh \"m\" {{ {QUAD} }} }}
         class \"_tree\" {{
             def Xform \"a\" (instanceable = true prepend references = </_leaf>) {{ {} }}
             def Xform \"b\" (instanceable = true prepend references = </_leaf>) {{ {} }}
         }}
         def Xform \"t\" (instanceable = true prepend references = </_tree>) {{ {} }}",
        at(1.0),
        at(2.0),
        at(10.0)
    ));
    assert_eq!(desc.objects.len(), 2);
    assert_eq!(desc.instances.len(), 1);
    let nested: Vec<_> =
        desc.objects.iter().map(|(_, object)| (object.shapes.len(), object.instances.len())).collect();
    assert_eq!(nested, [(1, 0), (0, 2)]);
}

fn instancer(properties: &str) -> String {
    format!(
        "def PointInstancer \"p\" {{
            rel prototypes = [</p/big>, </p/small>]
            int[] protoIndices = [0, 1, 0]
            point3f[] positions = [(0, 0, 0), (1, 0, 0), (2, 0, 0)]
            {} {properties}
            def Mesh \"big\" {{ {QUAD} }}
            def Sphere \"small\" {{ double radius = 0.5 double3 xformOp:translate = (0, 7, 0)
                uniform token[] xformOpOrder = [\"xformOp:translate\"] }}
        }}",
        at(10.0)
    )
}

#[test]
fn an_instancer_places_its_prototypes() {
    let desc = scene(&instancer(""));
    let x = |x: f64| x * DVec3::X;
    assert_eq!(places(&desc), [(0, x(10.0)), (1, x(11.0)), (0, x(12.0))]);
    let (_, small) = desc.objects.iter().nth(1).unwrap();
    let (_, shape) = small.shapes.iter().next().unwrap();
    assert_eq!(shape.world_from_object.start.w_axis.y, 7.0, "the transform of a prototype counts");
    assert!(super::shapes(&desc).is_empty(), "prototypes are not drawn by themselves");
    let desc = scene(&instancer("int64[] invisibleIds = [1]"));
    assert_eq!(places(&desc).len(), 2);
    let desc = scene(&instancer("int64[] ids = [7, 8, 9] int64[] invisibleIds = [7, 9]"));
    assert_eq!(places(&desc), [(0, x(11.0))].map(|(_, place)| (1, place)));
    let turned = "quath[] orientations = [(0, 0, 0, 1), (1, 0, 0, 0), (1, 0, 0, 0)]
        float3[] scales = [(2, 3, 4), (1, 1, 1), (1, 1, 1)]";
    let desc = scene(&instancer(turned));
    let (_, first) = desc.instances.iter().next().unwrap();
    let point = first.world_from_object.start.transform_point3(DVec3::ONE);
    assert!((point - DVec3::new(8.0, -3.0, 4.0)).length() < 1e-6, "{point}");
}

#[test]
fn faults_of_instancers_have_a_place() {
    let wrong = |from: &str, to: &str| error(&instancer("").replace(from, to));
    assert_eq!(wrong("[0, 1, 0]", "[0, 2, 0]"), "/p.protoIndices: there is no prototype 2");
    assert_eq!(wrong("[0, 1, 0]", "[0, 1]"), "/p.positions: there must be 2 positions, not 3");
    assert_eq!(wrong("</p/big>", "</p/none>"), "/p.prototypes: there is no `/p/none`");
}
