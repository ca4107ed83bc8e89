//! What a device cannot do is an error, after which it can do the next thing.

use alhazen_gpu::{Buffer, Device, GpuError};

#[test]
fn faults_are_errors_of_one_call() {
    let Some(device) = crate::device() else { return };
    let broken = device.kernel("broken", "fn main() -> f32 { return 1u; }");
    assert!(matches!(broken, Err(GpuError::Invalid(_))));
    let source = "@group(0) @binding(0) var<storage, read_write> words: array<u32>;
        @compute @workgroup_size(1)
        fn main(@builtin(global_invocation_id) id: vec3u) { words[id.x] += id.x; }";
    let (kernel, words) =
        (device.kernel("sum", source).unwrap(), device.buffer("words", &[5u32, 6, 7]).unwrap());
    // Unlike the shader this has no binding.
    let none: [&Buffer; 0] = [];
    assert!(matches!(device.run(&kernel, &none, [3, 1, 1]), Err(GpuError::Invalid(_))));
    device.run(&kernel, &[&words], [3, 1, 1]).unwrap();
    assert_eq!(device.read::<u32>(&words).unwrap(), [5, 7, 9]);
}

#[test]
fn what_is_too_large_is_refused_before() {
    let Some(device) = crate::device() else { return };
    let limit = device.largest_buffer();
    if limit < 1 << 30 {
        let error = device.buffer("words", &vec![0u8; limit as usize + 4]).err();
        assert_eq!(error, Some(GpuError::TooLarge("words", limit + 4, limit)));
    }
}

#[test]
fn a_missing_gpu_is_named_with_those_that_there_are() {
    let Some(there) = crate::device() else { return };
    let missing = Device::open("no such name").err();
    assert!(
        matches!(&missing, Some(GpuError::NoDevice(found)) if found.iter().any(|name| name == there.name()))
    );
    assert!(missing.is_some_and(|error| error.to_string().contains(there.name())));
}
