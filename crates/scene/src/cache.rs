//! What algorithms have computed of a scene, for later renders of it: of other views, as in a
//! window, or of a draft and the picture itself.

use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// One value of each type that is asked for. Copies of a scene share them, until one is changed.
#[derive(Clone, Debug, Default)]
pub struct SceneCache(Arc<Mutex<HashMap<TypeId, Arc<dyn Any + Send + Sync>>>>);

impl SceneCache {
    /// The value of a type, which is its default at first.
    pub fn of<T: Any + Default + Send + Sync>(&self) -> Arc<T> {
        let mut values = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let value = values.entry(TypeId::of::<T>()).or_insert_with(|| Arc::new(T::default()));
        Arc::clone(value).downcast().unwrap_or_default()
    }
}
