//! Typed tables, whose items have source locations.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

use crate::Span;

/// The source location of a statement and of its parameters.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// The whole statement; [`Span::NONE`] for items built by a program.
    pub span: Span,
    /// Spans of the given parameters, by their names in the format.
    pub parameters: Vec<(&'static str, Span)>,
}

impl Origin {
    /// The origin of a statement without the spans of its parameters.
    pub fn new(span: Span) -> Self {
        Self { span, parameters: Vec::new() }
    }

    /// Sets the span of a parameter, and replaces an earlier one.
    pub fn set_parameter(&mut self, name: &'static str, span: Span) {
        self.parameters.retain(|(given, _)| *given != name);
        self.parameters.push((name, span));
    }

    /// Whether a parameter was given.
    pub fn states(&self, name: &str) -> bool {
        self.parameters.iter().any(|(given, _)| *given == name)
    }

    /// The span for diagnostics of a parameter: its own, or that of the whole statement if it was
    /// not given.
    pub fn parameter(&self, name: &str) -> Span {
        self.parameters.iter().find(|(given, _)| *given == name).map_or(self.span, |&(_, span)| span)
    }
}

/// A value with its source location. Dereferences to the value.
#[derive(Clone, Debug, Default)]
pub struct Stated<T> {
    /// The value.
    pub value: T,
    /// Its source location.
    pub origin: Origin,
}

impl<T> Stated<T> {
    /// A value with its origin.
    pub fn new(value: T, origin: Origin) -> Self {
        Self { value, origin }
    }
}

impl<T> From<T> for Stated<T> {
    fn from(value: T) -> Self {
        Self { value, origin: Origin::default() }
    }
}

impl<T> Deref for Stated<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> DerefMut for Stated<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.value
    }
}

/// An append-only table. Its items have [`Handle`]s and an [`Origin`].
#[derive(Clone, Debug)]
pub struct Arena<T> {
    items: Vec<Stated<T>>,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { items: Vec::new() }
    }
}

impl<T> Arena<T> {
    /// Adds an item without an origin: one built by a program.
    pub fn push(&mut self, item: T) -> Handle<T> {
        self.push_stated(item.into())
    }

    /// Adds an item with its origin.
    pub fn push_stated(&mut self, item: Stated<T>) -> Handle<T> {
        let index = u32::try_from(self.items.len()).expect("invariant: an arena holds fewer than 2^32 items");
        self.items.push(item);
        Handle::new(index)
    }

    /// The source location of an item.
    pub fn origin(&self, handle: Handle<T>) -> &Origin {
        &self.items[handle.index()].origin
    }

    /// The number of items.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there is no item.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// All items in the order in which they were added.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (Handle<T>, &Stated<T>)> {
        self.items.iter().enumerate().map(|(index, item)| (Handle::new(index as u32), item))
    }

    /// All items, to be changed in place.
    pub fn iter_mut(&mut self) -> impl ExactSizeIterator<Item = (Handle<T>, &mut Stated<T>)> {
        self.items.iter_mut().enumerate().map(|(index, item)| (Handle::new(index as u32), item))
    }
}

impl<T> Index<Handle<T>> for Arena<T> {
    type Output = T;
    fn index(&self, handle: Handle<T>) -> &T {
        &self.items[handle.index()].value
    }
}

impl<T> IndexMut<Handle<T>> for Arena<T> {
    fn index_mut(&mut self, handle: Handle<T>) -> &mut T {
        &mut self.items[handle.index()].value
    }
}

impl<T> FromIterator<Stated<T>> for Arena<T> {
    fn from_iter<I: IntoIterator<Item = Stated<T>>>(items: I) -> Self {
        Self { items: items.into_iter().collect() }
    }
}

/// The index of an item in an [`Arena`] of the same type.
pub struct Handle<T> {
    index: u32,
    item: PhantomData<fn() -> T>,
}

impl<T> Handle<T> {
    /// The handle of the item at `index`, counted in order of addition.
    pub fn new(index: u32) -> Self {
        Self { index, item: PhantomData }
    }

    /// The index of the item in order of addition.
    pub fn index(self) -> usize {
        self.index as usize
    }
}

impl<T> Handle<T> {
    /// The handle without the type of its item.
    pub fn untyped(self) -> Handle<()> {
        Handle::new(self.index)
    }
}

impl Handle<()> {
    /// The handle of an item of the type from which it was made.
    pub fn typed<T>(self) -> Handle<T> {
        Handle::new(self.index)
    }
}

impl<T> Copy for Handle<T> {}
impl<T> Clone for Handle<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Eq for Handle<T> {}
impl<T> PartialEq for Handle<T> {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}
impl<T> Hash for Handle<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.index.hash(state);
    }
}
impl<T> fmt::Debug for Handle<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FileId;

    #[test]
    fn handles_index_items_in_order() {
        let mut arena = Arena::default();
        let a = arena.push("a");
        let b = arena.push_stated(Stated::new("b", Origin::new(Span::new(FileId(0), 3, 4))));
        assert_eq!((arena[a], arena[b]), ("a", "b"));
        assert_eq!(arena.origin(a).span, Span::NONE);
        assert_eq!(arena.origin(b).span.start, 3);
        assert_eq!(
            arena.iter().map(|(handle, item)| (handle.index(), **item)).collect::<Vec<_>>(),
            [(0, "a"), (1, "b")]
        );
    }

    #[test]
    fn a_missing_parameter_has_the_span_of_the_statement() {
        let whole = Span::new(FileId(0), 0, 9);
        let part = Span::new(FileId(0), 4, 6);
        let origin = Origin { span: whole, parameters: vec![("radius", part)] };
        assert_eq!(origin.parameter("radius"), part);
        assert_eq!(origin.parameter("zmin"), whole);
    }
}
