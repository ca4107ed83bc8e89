//! `alhazen render` of a bare mesh.

use crate::common::Folder;

#[test]
fn a_bare_mesh_is_shown_in_a_neutral_studio_and_casts_a_shadow() {
    let folder = Folder::new("studio");
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    folder.write("cube.obj", cube);
    let arguments = ["render", "cube.obj", "-o", "a.exr", "--resolution", "96x72", "--spp", "64"];
    let finished = folder.alhazen(&arguments).expect(0);
    assert!(!finished.err.contains("warning"), "{finished:?}");
    let picture = folder.image("a.exr");
    let mean = |x0: u32, y0: u32| {
        let pixels = (0..8).flat_map(|y| (0..8).map(move |x| (x0 + x, y0 + y)));
        let sum = pixels.fold([0.0; 3], |sum: [f32; 3], (x, y)| {
            let rgb = picture.rgb(x, y);
            std::array::from_fn(|c| sum[c] + rgb[c])
        });
        sum.map(|value| value / 64.0)
    };
    // Background and lit ground have the same neutral grey; the cube stands out, and its shadow.
    let sky = mean(2, 0);
    for [r, g, b] in [sky, mean(2, 30), mean(2, 62), mean(86, 12), mean(44, 62)] {
        assert!((r - g).abs() < 0.03 * g && (b - g).abs() < 0.03 * g, "{r} {g} {b}");
        assert!((g - sky[1]).abs() < 0.06 * g, "{g} {sky:?}");
    }
    let all: Vec<f32> =
        (0..72).flat_map(|y| (0..96).map(move |x| (x, y))).map(|(x, y)| picture.rgb(x, y)[1]).collect();
    let share =
        |wanted: &dyn Fn(f32) -> bool| all.iter().filter(|&&g| wanted(g)).count() as f32 / all.len() as f32;
    assert!(share(&|g| g > 1.3 * sky[1]) > 0.02, "no lit side");
    assert!(share(&|g| g < 0.6 * sky[1]) > 0.02, "no shadow");
}
