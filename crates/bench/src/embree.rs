//! Embree 4, from a library that is found when the program runs; no headers are needed.
//!
//! Only what the benchmarks need: one mesh in one scene, single rays, the nearest hit and any hit.
//! The numbers of enumerators and the layout of structures are those of the interface of Embree 4
//! ([Embree 2025]).
#![allow(unsafe_code, reason = "a library written in C++ is called")]

use crate::mesh::BenchMesh;
use crate::rays::{Answer, BenchRay, Query, RaySet};
use libloading::{Library, Symbol};
use math::Vec3;
use std::ffi::{CString, OsStr, c_char, c_int, c_uint, c_void};
use std::ptr::{NonNull, null_mut};
use std::sync::atomic::{AtomicIsize, Ordering};

/// A device, a scene or a geometry of Embree's.
type Object = *mut c_void;

const TRIANGLE_GEOMETRY: c_int = 0;
const INDEX_BUFFER: c_int = 0;
const VERTEX_BUFFER: c_int = 1;
const UINT3: c_int = 0x5003;
const FLOAT3: c_int = 0x9003;
const VERSION: c_int = 0;
const ROBUST: c_int = 4;
const NOTHING: u32 = u32::MAX;

#[repr(C, align(16))]
struct RtcRay {
    o: [f32; 3],
    near: f32,
    d: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// With room at the end for what a build of the library may add for instances.
#[repr(C, align(16))]
struct RtcRayHit {
    ray: RtcRay,
    normal: [f32; 3],
    u: f32,
    v: f32,
    primitive: u32,
    geometry: u32,
    instances: [u32; 9],
}

impl RtcRayHit {
    #[inline]
    fn new(&BenchRay { ray, t_max }: &BenchRay) -> Self {
        let ray = RtcRay {
            o: ray.o.to_array(),
            near: 0.0,
            d: ray.d.to_array(),
            time: 0.0,
            far: t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        };
        let [normal, [u, v, _]] = [[0.0; 3]; 2];
        Self { ray, normal, u, v, primitive: NOTHING, geometry: NOTHING, instances: [NOTHING; 9] }
    }
}

macro_rules! functions {
    ($($name:ident = $symbol:literal ($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions that are called.
        #[derive(Clone, Copy)]
        struct Functions {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            fn find(library: &'static Library) -> Result<Self, libloading::Error> {
                // SAFETY: the signatures are those of the functions' declarations in Embree 4.
                unsafe { Ok(Self { $($name: *find(library, $symbol)?,)* }) }
            }
        }
    };
}

functions! {
    new_device = "rtcNewDevice" (*const c_char) -> Object;
    device_error = "rtcGetDeviceError" (Object) -> c_int;
    device_property = "rtcGetDeviceProperty" (Object, c_int) -> isize;
    watch_memory = "rtcSetDeviceMemoryMonitorFunction" (Object, MemoryMonitor, *mut c_void);
    release_device = "rtcReleaseDevice" (Object);
    new_scene = "rtcNewScene" (Object) -> Object;
    set_quality = "rtcSetSceneBuildQuality" (Object, c_int);
    set_flags = "rtcSetSceneFlags" (Object, c_int);
    commit_scene = "rtcCommitScene" (Object);
    release_scene = "rtcReleaseScene" (Object);
    new_geometry = "rtcNewGeometry" (Object, c_int) -> Object;
    new_buffer = "rtcSetNewGeometryBuffer" (Object, c_int, c_uint, c_int, usize, usize) -> *mut c_void;
    commit_geometry = "rtcCommitGeometry" (Object);
    attach_geometry = "rtcAttachGeometry" (Object, Object) -> c_uint;
    release_geometry = "rtcReleaseGeometry" (Object);
    intersect = "rtcIntersect1" (Object, *mut RtcRayHit, *mut c_void);
    occluded = "rtcOccluded1" (Object, *mut RtcRay, *mut c_void);
}

type MemoryMonitor = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// # Safety
/// `T` must be the type of the function that `name` names.
unsafe fn find<T>(library: &'static Library, name: &str) -> Result<Symbol<'static, T>, libloading::Error> {
    // SAFETY: the caller promises the type.
    unsafe { library.get(name) }
}

/// How a scene is built and traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneOptions {
    /// Build quality of the tree.
    pub quality: Quality,
    /// Whether traversal is watertight.
    pub robust: bool,
}

/// Embree's build qualities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Morton codes.
    Low = 0,
    /// Binned surface area heuristic.
    Medium = 1,
    /// The same with spatial splits.
    High = 2,
}

/// The library.
pub struct Embree {
    functions: Functions,
}

impl Embree {
    /// Loads the library at a path.
    pub fn load(path: &OsStr) -> Result<Self, libloading::Error> {
        // SAFETY: the user's path names Embree's library, whose initialisers have no
        // preconditions.
        let library = unsafe { Library::new(path)? };
        // Its threads may outlive all devices, so that it is never unloaded.
        Ok(Self { functions: Functions::find(Box::leak(Box::new(library)))? })
    }

    /// A device that builds with this number of threads.
    pub fn device(&self, threads: usize) -> Result<Device, &'static str> {
        let options = CString::new(format!("threads={threads}")).expect("invariant: no zero byte in it");
        // SAFETY: the string ends with a zero byte and outlives the call.
        let device = unsafe { (self.functions.new_device)(options.as_ptr()) };
        let device = NonNull::new(device).ok_or("Embree makes no device")?;
        let bytes = Box::new(AtomicIsize::new(0));
        let counter: *const AtomicIsize = &*bytes;
        // SAFETY: the counter lives on the heap until the device, which calls the function, is
        // released.
        unsafe { (self.functions.watch_memory)(device.as_ptr(), count_memory, counter.cast_mut().cast()) };
        Ok(Device { functions: self.functions, device, bytes })
    }
}

/// # Safety
/// `counter` must point to a living `AtomicIsize`.
unsafe extern "C" fn count_memory(counter: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: the caller promises what it points to; only shared references are made of it.
    let counter = unsafe { &*counter.cast::<AtomicIsize>().cast_const() };
    counter.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// A device: threads and memory.
pub struct Device {
    functions: Functions,
    device: NonNull<c_void>,
    bytes: Box<AtomicIsize>,
}

impl Device {
    /// Embree's version.
    pub fn version(&self) -> String {
        // SAFETY: the device is not released before `self` is dropped.
        let number = unsafe { (self.functions.device_property)(self.device.as_ptr(), VERSION) };
        format!("{}.{}.{}", number / 10_000, number / 100 % 100, number % 100)
    }

    /// Bytes that the device holds: vertices, indices and trees.
    pub fn bytes(&self) -> usize {
        self.bytes.load(Ordering::Relaxed).unsigned_abs()
    }

    /// The mesh in buffers of the device's, not yet built.
    pub fn prepare(&self, mesh: &BenchMesh, options: SceneOptions) -> Result<Prepared<'_>, &'static str> {
        self.fill(mesh, options).ok_or("Embree takes no mesh")
    }

    fn fill(&self, mesh: &BenchMesh, options: SceneOptions) -> Option<Prepared<'_>> {
        let f = &self.functions;
        let device = self.device.as_ptr();
        let (vertices, triangles) = (&*mesh.positions, &*mesh.indices);
        // SAFETY: the device is alive. A buffer of Embree's has room for the elements that it was
        // asked for.
        unsafe {
            let scene = Scene { functions: self.functions, scene: (f.new_scene)(device), _device: self };
            let prepared = Prepared { scene, geometry: (f.new_geometry)(device, TRIANGLE_GEOMETRY) };
            (f.set_quality)(prepared.scene.scene, options.quality as c_int);
            (f.set_flags)(prepared.scene.scene, if options.robust { ROBUST } else { 0 });
            let buffer = |kind, format, size, count| {
                NonNull::new((f.new_buffer)(prepared.geometry, kind, 0, format, size, count))
            };
            let filled = buffer(VERTEX_BUFFER, FLOAT3, size_of::<Vec3>(), vertices.len())?;
            filled.cast().copy_from_nonoverlapping(NonNull::from(vertices).cast::<Vec3>(), vertices.len());
            let filled = buffer(INDEX_BUFFER, UINT3, size_of::<[u32; 3]>(), triangles.len())?;
            filled
                .cast()
                .copy_from_nonoverlapping(NonNull::from(triangles).cast::<[u32; 3]>(), triangles.len());
            ((f.device_error)(device) == 0).then_some(prepared)
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: released once; scenes borrow the device, so that none is left.
        unsafe { (self.functions.release_device)(self.device.as_ptr()) }
    }
}

/// A scene that has its mesh, but no tree.
pub struct Prepared<'a> {
    scene: Scene<'a>,
    geometry: Object,
}

impl<'a> Prepared<'a> {
    /// Builds the tree.
    pub fn commit(self) -> Scene<'a> {
        let f = &self.scene.functions;
        // SAFETY: geometry and scene are alive; the scene keeps the geometry that is released here.
        unsafe {
            (f.commit_geometry)(self.geometry);
            (f.attach_geometry)(self.scene.scene, self.geometry);
            (f.release_geometry)(self.geometry);
            (f.commit_scene)(self.scene.scene);
        }
        self.scene
    }
}

/// A scene that rays can be traced in.
pub struct Scene<'a> {
    functions: Functions,
    scene: Object,
    _device: &'a Device,
}

impl Scene<'_> {
    /// Traces a set, ray by ray.
    pub fn trace(&self, set: &RaySet) -> Answer {
        let _denormals = DenormalsAreZero::begin();
        let mut answer = Answer::default();
        for ray in &*set.rays {
            let mut hit = RtcRayHit::new(ray);
            // SAFETY: the scene is committed and alive, and the structure is as large and as
            // aligned as Embree's.
            match set.query {
                Query::Closest => {
                    unsafe { (self.functions.intersect)(self.scene, &mut hit, null_mut()) };
                    if hit.geometry != NOTHING {
                        answer.add(hit.ray.far);
                    }
                }
                Query::Any => {
                    unsafe { (self.functions.occluded)(self.scene, &mut hit.ray, null_mut()) };
                    answer.hits += u64::from(hit.ray.far < 0.0);
                }
            }
        }
        answer
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: released once.
        unsafe { (self.functions.release_scene)(self.scene) }
    }
}

/// While it lives, this thread's processor takes denormal numbers for zero, as Embree advises for
/// speed. Nothing that is computed meanwhile on our side has such numbers.
struct DenormalsAreZero {
    #[cfg(target_arch = "x86_64")]
    before: u32,
}

impl DenormalsAreZero {
    #[cfg(target_arch = "x86_64")]
    fn begin() -> Self {
        const FLUSH_TO_ZERO: u32 = 0x8000;
        const DENORMALS_ARE_ZERO: u32 = 0x0040;
        let before = control();
        set_control(before | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
        Self { before }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn begin() -> Self {
        Self {}
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for DenormalsAreZero {
    fn drop(&mut self) {
        set_control(self.before);
    }
}

/// The register MXCSR.
#[cfg(target_arch = "x86_64")]
fn control() -> u32 {
    let mut control = 0u32;
    // SAFETY: stores four bytes into four bytes.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &mut control, options(nostack)) };
    control
}

#[cfg(target_arch = "x86_64")]
fn set_control(control: u32) {
    // SAFETY: loads four bytes, which came from the register but for bits that change how denormal
    // numbers are treated.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &control, options(nostack)) };
}
