//! Values of attributes as numbers, whatever their precision.

use half::f16;
use openusd::sdf::Value;

/// Numbers of a value, one after another, and how many an element of it has.
pub(super) struct Numbers {
    pub values: Vec<f64>,
    pub width: usize,
}

/// The numbers of a value; `None` if it has none.
pub(super) fn numbers(value: Value) -> Option<Numbers> {
    /// One element.
    fn one<const N: usize>(values: [f64; N]) -> Option<Numbers> {
        Some(Numbers { values: values.to_vec(), width: N })
    }
    /// An array of elements, each as an array of any numbers.
    fn all<T, const N: usize>(elements: Vec<T>, element: impl Fn(T) -> [f64; N]) -> Option<Numbers> {
        Some(Numbers { values: elements.into_iter().flat_map(element).collect(), width: N })
    }
    macro_rules! vectors {
        ($($one:ident $many:ident $number:ident $count:literal),* $(,)?) => {
            match value {
                $(
                    Value::$one(v) => one(<[$number; $count]>::from(v).map(f64::from)),
                    Value::$many(v) => all(v, |v| <[$number; $count]>::from(v).map(f64::from)),
                )*
                Value::Bool(v) => one([f64::from(u8::from(v))]),
                Value::BoolVec(v) => all(v, |v| [f64::from(u8::from(v))]),
                Value::Uchar(v) => one([v.into()]),
                Value::UcharVec(v) => all(v, |v| [v.into()]),
                Value::Int(v) => one([v.into()]),
                Value::IntVec(v) => all(v, |v| [v.into()]),
                Value::Uint(v) => one([v.into()]),
                Value::UintVec(v) => all(v, |v| [v.into()]),
                Value::Int64(v) => one([v as f64]),
                Value::Int64Vec(v) => all(v, |v| [v as f64]),
                Value::Uint64(v) => one([v as f64]),
                Value::Uint64Vec(v) => all(v, |v| [v as f64]),
                Value::Half(v) => one([v.into()]),
                Value::HalfVec(v) => all(v, |v| [v.into()]),
                Value::Float(v) => one([v.into()]),
                Value::FloatVec(v) => all(v, |v| [v.into()]),
                Value::Double(v) => one([v]),
                Value::DoubleVec(v) => all(v, |v| [v]),
                Value::TimeCode(v) => one([v.0]),
                Value::Matrix2d(v) => one(v.0),
                Value::Matrix3d(v) => one(v.0),
                Value::Matrix4d(v) => one(v.0),
                Value::Matrix4dVec(v) => all(v, |v| v.0),
                _ => None,
            }
        };
    }
    vectors! {
        Vec2h Vec2hVec f16 2, Vec2f Vec2fVec f32 2, Vec2d Vec2dVec f64 2, Vec2i Vec2iVec i32 2,
        Vec3h Vec3hVec f16 3, Vec3f Vec3fVec f32 3, Vec3d Vec3dVec f64 3, Vec3i Vec3iVec i32 3,
        Vec4h Vec4hVec f16 4, Vec4f Vec4fVec f32 4, Vec4d Vec4dVec f64 4, Vec4i Vec4iVec i32 4,
        Quath QuathVec f16 4, Quatf QuatfVec f32 4, Quatd QuatdVec f64 4,
    }
}

/// The words of a value: tokens or strings; `None` if it has none.
pub(super) fn words(value: Value) -> Option<Vec<String>> {
    Some(match value {
        Value::Token(word) => vec![word.into()],
        Value::String(word) => vec![word],
        Value::TokenVec(words) => words.into_iter().map(Into::into).collect(),
        Value::StringVec(words) => words,
        _ => return None,
    })
}
