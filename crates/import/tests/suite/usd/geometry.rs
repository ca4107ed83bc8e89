//! Transforms, meshes, shapes with a formula, curves and points.

use super::{QUAD, corners, error, mesh, read_as, scene, shape, shapes, text, warnings, without_errors};
use alhazen_import::import;
use assets::MemoryAssets;
use description::{CurveBasis, MaterialKind, ShapeKind, SpectrumDesc, SpectrumParameter};
use math::{DVec3, Vec3};

/// The corners of [`QUAD`] after a transform.
fn moved(operations: &str) -> Vec<[i64; 3]> {
    corners(shape(&scene(&format!("def Xform \"a\" {{ {operations} def Mesh \"m\" {{ {QUAD} }} }}"))))
}

/// Corners in thousandths.
fn thousandths<const N: usize>(corners: [[i64; 3]; N]) -> Vec<[i64; 3]> {
    let mut corners = corners.map(|corner| corner.map(|v| 1000 * v)).to_vec();
    corners.sort_unstable();
    corners
}

#[test]
fn operations_apply_from_the_last_to_the_first() {
    let found = moved(
        "double3 xformOp:translate = (10, 0, 0) float3 xformOp:scale:big = (2, 3, 4)
         uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:scale:big\"]",
    );
    assert_eq!(found, thousandths([[8, -3, 0], [12, -3, 0], [8, 3, 0], [12, 3, 0]]));
    // x first: (1, 1, 0) turns to (1, 0, 1), and then about z to (0, 1, 1).
    let found = moved(
        "float3 xformOp:rotateXYZ = (90, 0, 90) uniform token[] xformOpOrder = [\"xformOp:rotateXYZ\"]",
    );
    assert_eq!(found, thousandths([[0, 1, 1], [0, 1, -1], [0, -1, 1], [0, -1, -1]]));
    let found = moved(
        "matrix4d xformOp:transform = ( (0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 1, 0), (5, 6, 7, 1) )
         uniform token[] xformOpOrder = [\"xformOp:transform\"]",
    );
    assert_eq!(found, thousandths([[4, 5, 7], [6, 5, 7], [4, 7, 7], [6, 7, 7]]));
    let found = moved(
        "double3 xformOp:translate:pivot = (1, 0, 0) quatf xformOp:orient = (0, 0, 0, 1)
         uniform token[] xformOpOrder = [\"xformOp:translate:pivot\", \"xformOp:orient\",
             \"!invert!xformOp:translate:pivot\"]",
    );
    assert_eq!(found, thousandths([[1, -1, 0], [3, -1, 0], [1, 1, 0], [3, 1, 0]]));
}

#[test]
fn a_reset_forgets_what_is_above() {
    let found = scene(&format!(
        "def Xform \"a\" {{
            double3 xformOp:translate = (10, 0, 0)
            uniform token[] xformOpOrder = [\"xformOp:translate\"]
            def Mesh \"m\" {{
                double3 xformOp:translate = (0, 5, 0)
                uniform token[] xformOpOrder = [\"!resetXformStack!\", \"xformOp:translate\"] {QUAD}
            }}
        }}"
    ));
    assert_eq!(corners(shape(&found)), thousandths([[-1, 4, 0], [1, 4, 0], [-1, 6, 0], [1, 6, 0]]));
}

#[test]
fn wrong_operations_have_a_place() {
    let of = |operations: &str| error(&format!("def Xform \"a\" {{ {operations} }}"));
    assert_eq!(
        of("uniform token[] xformOpOrder = [\"xformOp:translate\"]"),
        "/a.xformOp:translate: this has no value"
    );
    assert!(of("uniform token[] xformOpOrder = [\"xformOp:shear\"]").contains("`xformOp:shear` is not"));
    let scale = "float3 xformOp:scale = (0, 1, 1) uniform token[] xformOpOrder = [\"!invert!xformOp:scale\"]";
    assert!(of(scale).contains("has no inverse"));
    let typed = "float xformOp:translate = 1 uniform token[] xformOpOrder = [\"xformOp:translate\"]";
    assert!(of(typed).contains("/a.xformOp:translate: this must be elements of 3 numbers"), "{}", of(typed));
}

#[test]
fn z_may_be_up() {
    let desc = scene("");
    assert!(shapes(&desc).is_empty());
    let prims = format!("def Mesh \"m\" {{ {QUAD} }}");
    let text = text(&prims).replace("\"Y\"", "\"Z\"");
    let desc = without_errors(import("a.usda", &MemoryAssets::default().with("a.usda", text)));
    assert_eq!(corners(shape(&desc)), thousandths([[-1, 0, -1], [1, 0, -1], [-1, 0, 1], [1, 0, 1]]));
}

#[test]
fn values_may_vary_in_time() {
    let prims = format!(
        "def Xform \"a\" {{
            double3 xformOp:translate.timeSamples = {{ 0: (0, 0, 0), 10: (10, 0, 0) }}
            uniform token[] xformOpOrder = [\"xformOp:translate\"]
            def Mesh \"m\" {{ {QUAD} }}
        }}"
    );
    let at = |path: &str| {
        let desc = without_errors(read_as(path, &prims));
        let place = shape(&desc).world_from_object;
        [place.start, place.end].map(|matrix| matrix.w_axis.x)
    };
    assert_eq!(at("a.usda"), [0.0, 0.0]);
    assert_eq!(at("a.usda#time=0.5"), [5.0, 5.0], "ten time codes a second");
    assert_eq!(at("a.usda#time=0.5,shutter=0.125"), [5.0, 6.25]);
    assert!(read_as("a.usda#variant=red", &prims).has_errors());
}

#[test]
fn points_may_move() {
    let points = "point3f[] points.timeSamples = { 0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
                                                   10: [(0, 0, 1), (1, 0, 1), (0, 1, 1)] }";
    let prims = format!(
        "def Mesh \"m\" {{ int[] faceVertexCounts = [3] int[] faceVertexIndices = [0, 1, 2] {points}
            uniform token subdivisionScheme = \"none\" }}"
    );
    let desc = without_errors(read_as("a.usda#time=0,shutter=0.5", &prims));
    let mesh = mesh(shape(&desc));
    assert_eq!(mesh.positions[1], Vec3::new(1.0, 0.0, 0.0));
    assert_eq!(mesh.later.len(), 1);
    assert_eq!(mesh.later[0].positions[1], Vec3::new(1.0, 0.0, 0.5));
}

#[test]
fn polygons_become_triangles() {
    let arrow = "int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 0, 3, 1]
        point3f[] points = [(0, 0, 0), (2, -1, 0), (0.5, 0, 0), (2, 1, 0)]
        uniform token subdivisionScheme = \"none\"";
    let desc = scene(&format!("def Mesh \"m\" {{ {arrow} }}"));
    let found = mesh(shape(&desc));
    assert_eq!(found.indices.len(), 3);
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| found.positions[vertex as usize]);
        (b - a).cross(c - a).z / 2.0
    };
    let areas: f32 = found.indices[..2].iter().map(area).sum();
    assert!((areas - 0.5).abs() < 1e-6, "{areas}");
    let left = scene(&format!("def Mesh \"m\" {{ {arrow} uniform token orientation = \"leftHanded\" }}"));
    let [a, b, c] = found.indices[0];
    assert_eq!(mesh(shape(&left)).indices[0], [a, c, b]);
    let holes = scene(&format!("def Mesh \"m\" {{ {arrow} int[] holeIndices = [0] }}"));
    assert_eq!(mesh(shape(&holes)).indices.len(), 1);
}

#[test]
fn values_have_all_interpolations() {
    let two = "int[] faceVertexCounts = [3, 3] int[] faceVertexIndices = [0, 1, 2, 0, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        uniform token subdivisionScheme = \"none\"";
    let uvs = |values: &str| {
        let desc = scene(&format!("def Mesh \"m\" {{ {two} texCoord2f[] primvars:st = {values} }}"));
        let mesh = mesh(shape(&desc));
        let of =
            |triangle: &[u32; 3]| triangle.map(|vertex| mesh.uvs[vertex as usize]).map(|uv| [uv.x, uv.y]);
        (mesh.positions.len(), mesh.indices.iter().map(of).collect::<Vec<_>>())
    };
    let (a, b, c, d) = ([0.0, 0.0], [0.25, 0.0], [0.25, 0.5], [0.0, 0.5]);
    let four = "[(0, 0), (0.25, 0), (0.25, 0.5), (0, 0.5)]";
    for kind in ["vertex", "varying"] {
        let found = uvs(&format!("{four} (interpolation = \"{kind}\")"));
        assert_eq!(found, (4, vec![[a, b, c], [a, c, d]]));
    }
    assert_eq!(uvs("[(0.25, 0.5)] (interpolation = \"constant\")"), (4, vec![[c; 3]; 2]));
    assert_eq!(uvs("[(0, 0), (0.25, 0)] (interpolation = \"uniform\")"), (6, vec![[a; 3], [b; 3]]));
    let indexed =
        format!("{four} (interpolation = \"faceVarying\") int[] primvars:st:indices = [0, 1, 2, 0, 3, 3]");
    assert_eq!(uvs(&indexed), (5, vec![[a, b, c], [a, d, d]]));
    for (wrong, what) in [
        ("[(0, 0)] (interpolation = \"vertex\")", "/m.primvars:st: there must be 4 values, not 1"),
        ("[(0, 0)] (interpolation = \"edge\")", "`edge` is not an interpolation"),
        (
            "[(0, 0)] (interpolation = \"vertex\") int[] primvars:st:indices = [0, 0, 1, 0]",
            "there is an index",
        ),
    ] {
        let found = error(&format!("def Mesh \"m\" {{ {two} texCoord2f[] primvars:st = {wrong} }}"));
        assert!(found.contains(what), "{found}");
    }
}

#[test]
fn faults_of_meshes_have_a_place() {
    let of = |counts: &str, indices: &str| {
        error(&format!(
            "def Mesh \"m\" {{ int[] faceVertexCounts = {counts} int[] faceVertexIndices = {indices}
                point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)] }}"
        ))
    };
    assert!(of("[3]", "[0, 1, 3]").starts_with("/m.faceVertexIndices: there is an index that none of the 3"));
    assert!(of("[3]", "[0, 1, -1]").starts_with("/m.faceVertexIndices:"));
    assert!(of("[4]", "[0, 1, 2]").starts_with("/m.faceVertexCounts:"));
    assert!(of("[-3, 6]", "[0, 1, 2]").starts_with("/m.faceVertexCounts:"));
}

#[test]
fn surfaces_are_subdivided_unless_they_say_otherwise() {
    let cube = "int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
        int[] faceVertexIndices = [0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6]
        point3f[] points = [(-1, -1, -1), (1, -1, -1), (-1, 1, -1), (1, 1, -1),
            (-1, -1, 1), (1, -1, 1), (-1, 1, 1), (1, 1, 1)]";
    let desc = scene(&format!("def Mesh \"m\" {{ {cube} }}"));
    let round = mesh(shape(&desc));
    assert_eq!(round.indices.len(), 6 * 64 * 2);
    assert_eq!(round.normals.len(), round.positions.len());
    let radii: Vec<f32> = round.positions.iter().map(|point| point.length()).collect();
    assert!(radii.iter().all(|radius| (0.8..1.1).contains(radius)));
    let sharp = format!("{cube} int[] cornerIndices = [0] float[] cornerSharpnesses = [10]");
    let desc = scene(&format!("def Mesh \"m\" {{ {sharp} }}"));
    let farthest = mesh(shape(&desc)).positions.iter().map(|point| point.length()).fold(0.0, f32::max);
    assert!((farthest - 3.0_f32.sqrt()).abs() < 1e-6);
    let desc = scene(&format!("def Mesh \"m\" {{ {cube} uniform token subdivisionScheme = \"bilinear\" }}"));
    assert_eq!(mesh(shape(&desc)).indices.len(), 12);
    let desc = scene(&format!("def Mesh \"m\" {{ {cube} uniform token subdivisionScheme = \"loop\" }}"));
    assert!(
        matches!(&shape(&desc).kind, ShapeKind::LoopSubdivision { mesh, levels: 3 } if mesh.indices.len() == 12)
    );
}

#[test]
fn hidden_prims_are_not_drawn() {
    for hidden in [
        "token visibility = \"invisible\"",
        "uniform token purpose = \"guide\"",
        "uniform token purpose = \"proxy\"",
    ] {
        let desc = scene(&format!("def Xform \"a\" {{ {hidden} def Mesh \"m\" {{ {QUAD} }} }}"));
        assert!(shapes(&desc).is_empty(), "{hidden}");
    }
    let desc = scene(&format!(
        "def Xform \"a\" {{ uniform token purpose = \"render\" def Mesh \"m\" {{ {QUAD} }} }}"
    ));
    assert_eq!(shapes(&desc).len(), 1);
    for kind in ["over", "class Mesh"] {
        assert!(shapes(&scene(&format!("{kind} \"m\" {{ {QUAD} }}"))).is_empty(), "{kind}");
    }
    assert!(shapes(&scene(&format!("def Mesh \"m\" (active = false) {{ {QUAD} }}"))).is_empty());
}

/// The boxes around the shapes of a prim.
fn ends(prim: &str) -> Vec<(DVec3, DVec3)> {
    let desc = scene(prim);
    let corners = |shape: &description::ShapeDesc| {
        let (low, high) = match &shape.kind {
            ShapeKind::Cylinder { radius, z_min, z_max, .. }
            | ShapeKind::Sphere { radius, z_min, z_max, .. } => {
                (Vec3::new(-radius, -radius, *z_min), Vec3::new(*radius, *radius, *z_max))
            }
            ShapeKind::Cone { radius, height, .. } => {
                (Vec3::new(-radius, -radius, 0.0), Vec3::new(*radius, *radius, *height))
            }
            ShapeKind::Disk { radius, height, .. } => {
                (Vec3::new(-radius, -radius, *height), Vec3::new(*radius, *radius, *height))
            }
            ShapeKind::Triangles(mesh) => (
                mesh.positions.iter().copied().reduce(Vec3::min).unwrap(),
                mesh.positions.iter().copied().reduce(Vec3::max).unwrap(),
            ),
            kind => panic!("{kind:?}"),
        };
        let [a, b] =
            [low, high].map(|corner| shape.world_from_object.start.transform_point3(corner.as_dvec3()));
        (a.min(b).round(), a.max(b).round())
    };
    shapes(&desc).into_iter().map(corners).collect()
}

#[test]
fn shapes_with_a_formula_are_about_their_axis() {
    let v = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    assert_eq!(ends("def Sphere \"s\" { double radius = 3 }"), [(DVec3::splat(-3.0), DVec3::splat(3.0))]);
    assert_eq!(ends("def Cube \"s\" { double size = 4 }"), [(DVec3::splat(-2.0), DVec3::splat(2.0))]);
    let tube = "double height = 4 double radius = 1";
    assert_eq!(
        ends(&format!("def Cylinder \"s\" {{ {tube} uniform token axis = \"X\" }}")),
        [
            (v(-2., -1., -1.), v(2., 1., 1.)),
            (v(-2., -1., -1.), v(-2., 1., 1.)),
            (v(2., -1., -1.), v(2., 1., 1.))
        ]
    );
    assert_eq!(
        ends(&format!("def Cone \"s\" {{ {tube} uniform token axis = \"Y\" }}")),
        [(v(-1., -2., -1.), v(1., 2., 1.)), (v(-1., -2., -1.), v(1., -2., 1.))]
    );
    assert_eq!(
        ends(&format!("def Capsule \"s\" {{ {tube} }}")),
        [
            (v(-1., -1., -2.), v(1., 1., 2.)),
            (v(-1., -1., 2.), v(1., 1., 3.)),
            (v(-1., -1., -3.), v(1., 1., -2.))
        ]
    );
    assert_eq!(
        ends("def Plane \"s\" { double width = 2 double length = 4 uniform token axis = \"X\" }"),
        [(v(0., -2., -1.), v(0., 2., 1.))]
    );
    assert_eq!(error("def Sphere \"s\" { double radius = -1 }"), "/s.radius: this must be above 0, not -1");
    assert!(error("def Cone \"s\" { uniform token axis = \"W\" }").contains("`W` is not an axis"));
}

/// The control points and widths of the curves of a prim.
fn curves(properties: &str) -> Vec<(Vec<Vec3>, [f32; 2])> {
    let desc = scene(&format!("def BasisCurves \"c\" {{ {properties} }}"));
    let curve = |shape: &description::ShapeDesc| match &shape.kind {
        ShapeKind::Curve(curve) => {
            assert_eq!((curve.degree, curve.basis), (3, CurveBasis::Bezier));
            (curve.control_points.to_vec(), curve.width)
        }
        kind => panic!("{kind:?}"),
    };
    shapes(&desc).into_iter().map(curve).collect()
}

#[test]
fn curves_of_every_basis_are_bezier_curves() {
    let points =
        "int[] curveVertexCounts = [4] point3f[] points = [(0, 0, 0), (6, 0, 0), (12, 6, 0), (18, 6, 0)]";
    let constant = "float[] widths = [0.5] (interpolation = \"constant\")";
    let found = curves(&format!("{points} {constant} uniform token type = \"linear\""));
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].0.len(), found[0].0[3], found[0].1), (10, Vec3::new(6.0, 0.0, 0.0), [0.5; 2]));
    let found = curves(&format!("{points} {constant}"));
    assert_eq!(found[0].0[1], Vec3::new(6.0, 0.0, 0.0));
    // (P₀ + 4P₁ + P₂)/6 and so on.
    let found = curves(&format!("{points} {constant} uniform token basis = \"bspline\""));
    let expected = [(6.0, 1.0), (8.0, 2.0), (10.0, 4.0), (12.0, 5.0)];
    assert_eq!(found[0].0, expected.map(|(x, y)| Vec3::new(x, y, 0.0)));
    let found = curves(&format!("{points} {constant} uniform token basis = \"catmullRom\""));
    let expected = [(6.0, 0.0), (8.0, 1.0), (10.0, 5.0), (12.0, 6.0)];
    assert_eq!(found[0].0, expected.map(|(x, y)| Vec3::new(x, y, 0.0)));
    let pinned =
        format!("{points} {constant} uniform token basis = \"bspline\" uniform token wrap = \"pinned\"");
    let found = curves(&pinned);
    assert_eq!((found[0].0.len(), found[0].0[0], found[0].0[9]), (10, Vec3::ZERO, Vec3::new(18.0, 6.0, 0.0)));
    let periodic =
        format!("{points} {constant} uniform token type = \"linear\" uniform token wrap = \"periodic\"");
    assert_eq!(curves(&periodic)[0].0[12], Vec3::ZERO);
    // Widths that are not linear along a curve divide it.
    let widths = "float[] widths = [1, 2, 3, 4] (interpolation = \"vertex\")";
    assert_eq!(curves(&format!("{points} {widths} uniform token type = \"linear\""))[0].1, [1.0, 4.0]);
    let widths = "float[] widths = [1, 2, 1, 4] (interpolation = \"vertex\")";
    let found = curves(&format!("{points} {widths} uniform token type = \"linear\""));
    assert_eq!(
        found.iter().map(|(_, width)| *width).collect::<Vec<_>>(),
        [[1.0, 2.0], [2.0, 1.0], [1.0, 4.0]]
    );
    let wrong = error(&format!("def BasisCurves \"c\" {{ {} }}", points.replace("[4]", "[5]")));
    assert!(wrong.starts_with("/c.curveVertexCounts:"), "{wrong}");
    assert_eq!(
        warnings(&format!("def BasisCurves \"c\" {{ {points} }}")),
        ["/c: curves and points without widths are drawn as thin ones"]
    );
}

#[test]
fn points_are_spheres_of_their_colours() {
    let desc = scene(
        "def Points \"p\" {
            point3f[] points = [(0, 0, 0), (1, 0, 0), (2, 0, 0)]
            float[] widths = [1, 2, 4] (interpolation = \"vertex\")
            color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (1, 0, 0)] (interpolation = \"vertex\")
        }",
    );
    let found = shapes(&desc).into_iter().map(|shape| {
        let ShapeKind::Spheres(spheres) = &shape.kind else { panic!("{shape:?}") };
        let MaterialKind::Diffuse { reflectance } = &desc.materials[shape.material.unwrap()].kind else {
            panic!("not diffuse")
        };
        let SpectrumParameter::Value(SpectrumDesc::Rgb { rgb, .. }) = reflectance else {
            panic!("no colour")
        };
        (spheres.radii.to_vec(), *rgb)
    });
    assert_eq!(found.collect::<Vec<_>>(), [(vec![0.5, 2.0], [1.0, 0.0, 0.0]), (vec![1.0], [0.0, 1.0, 0.0])]);
}
