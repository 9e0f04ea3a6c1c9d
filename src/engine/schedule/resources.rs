//! Shared data that is not particle state: neighbour lists, packed rows, tables. One value per type, or per
//! type and phase.

use std::any::{Any, TypeId, type_name};
use std::cell::{Ref, RefCell, RefMut};
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use crate::world::{Mode, PhaseId, Watch};

/// A type of values that systems find by their type. What its rows hold has names, and a system that borrows
/// such a value has declared access to one of these: reading for reading, writing or adding for writing.
/// Otherwise the run ends with an error that says what to declare.
pub trait Shareable: Send + 'static {
    /// Names of its rows in the access of systems.
    const ROWS: &'static [&'static str];
}

/// The place of a value that the systems of one owner share: a plugin that a scene has twice has two of them.
pub struct Shared<T> {
    number: usize,
    of: PhantomData<fn() -> T>,
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Shared<T> {}

impl<T> fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "shared value {} of type {}", self.number, type_name::<T>())
    }
}

/// Values that systems share by their places.
#[derive(Default)]
pub struct SharedValues(Vec<Box<dyn Any + Send>>);

impl SharedValues {
    /// Adds a value, and gives its place.
    pub fn add<T: Send + 'static>(&mut self, value: T) -> Shared<T> {
        self.0.push(Box::new(value));
        Shared { number: self.0.len() - 1, of: PhantomData }
    }

    /// The value in its place. Panics where the place is that of another simulation.
    pub fn of_mut<T: Send + 'static>(&mut self, place: Shared<T>) -> &mut T {
        self.0[place.number].downcast_mut().unwrap_or_else(|| panic!("no {place:?}"))
    }
}

/// Values by their type, or by their type and a phase, and values by their place, which only those can borrow
/// that have been given the place. What is not derived from the scene and the columns is kept by the system
/// that owns it ([`Run::save_with`](super::Run::save_with)).
#[derive(Default)]
pub struct Resources {
    by_type: BTreeMap<(TypeId, Option<PhaseId>), RefCell<Box<dyn Any + Send>>>,
    shared: Vec<RefCell<Box<dyn Any + Send>>>,
    /// Exchanges of packed rows among ranks.
    completed_by: Vec<fn(&Resources)>,
    /// The check of accesses against declarations.
    watch: Option<Arc<Watch>>,
}

impl Resources {
    /// Resources with values that have a place.
    pub fn with_shared(values: SharedValues) -> Self {
        Self {
            by_type: BTreeMap::new(),
            shared: values.0.into_iter().map(RefCell::new).collect(),
            completed_by: Vec::new(),
            watch: None,
        }
    }

    /// Has `complete` called before a system reads packed rows of all ranks.
    pub fn complete_packed_by(&mut self, complete: fn(&Self)) {
        self.completed_by.push(complete);
    }

    /// Exchanges packed rows of which ranks have some alone.
    pub(super) fn complete_packed(&self) {
        self.completed_by.iter().for_each(|complete| complete(self));
    }

    /// From now on the accesses of systems are checked against their declarations.
    pub(crate) fn watch_by(&mut self, watch: Arc<Watch>) {
        self.watch = Some(watch);
    }

    fn touches<T: Shareable>(&self, mode: Mode) {
        if let Some(watch) = &self.watch {
            watch.touches_shared(T::ROWS, mode);
        }
    }

    /// The value in its place, for reading. Panics where the place is that of another simulation.
    pub fn of<T: Send + 'static>(&self, place: Shared<T>) -> Ref<'_, T> {
        Ref::filter_map(self.shared[place.number].borrow(), |value| value.downcast_ref())
            .unwrap_or_else(|_| panic!("no {place:?}"))
    }

    /// The value in its place, for writing. Panics where the place is that of another simulation.
    pub fn of_mut<T: Send + 'static>(&self, place: Shared<T>) -> RefMut<'_, T> {
        RefMut::filter_map(self.shared[place.number].borrow_mut(), |value| value.downcast_mut())
            .unwrap_or_else(|_| panic!("no {place:?}"))
    }

    /// Puts a value in place of the one of its type.
    pub fn insert<T: Shareable>(&mut self, value: T) {
        self.by_type.insert((TypeId::of::<T>(), None), RefCell::new(Box::new(value)));
    }

    /// Puts a value in place of the one that a phase has of its type.
    pub fn insert_of<T: Shareable>(&mut self, phase: PhaseId, value: T) {
        self.by_type.insert((TypeId::of::<T>(), Some(phase)), RefCell::new(Box::new(value)));
    }

    /// The value of type `T` for reading. Panics where the plugin that owns it was not built.
    pub fn get<T: Shareable>(&self) -> Ref<'_, T> {
        self.try_get().unwrap_or_else(|| panic!("no resource of type {}", type_name::<T>()))
    }

    /// The value of type `T` for reading, if there is one.
    pub fn try_get<T: Shareable>(&self) -> Option<Ref<'_, T>> {
        self.read(None)
    }

    /// The value of type `T` for writing. Panics where the plugin that owns it was not built.
    pub fn get_mut<T: Shareable>(&self) -> RefMut<'_, T> {
        self.write(None).unwrap_or_else(|| panic!("no resource of type {}", type_name::<T>()))
    }

    /// The value of type `T` for writing, if there is one.
    pub fn try_get_mut<T: Shareable>(&self) -> Option<RefMut<'_, T>> {
        self.write(None)
    }

    /// The value of type `T`, if there is one, to be completed by what other ranks have of it. It is no
    /// access of the system in which this happens: that writes nothing.
    pub(crate) fn to_complete<T: Shareable>(&self) -> Option<RefMut<'_, T>> {
        let cell = self.by_type.get(&(TypeId::of::<T>(), None))?;
        RefMut::filter_map(cell.borrow_mut(), |value| value.downcast_mut()).ok()
    }

    /// The value of type `T` that a phase has, for reading, if there is one.
    pub fn try_get_of<T: Shareable>(&self, phase: PhaseId) -> Option<Ref<'_, T>> {
        self.read(Some(phase))
    }

    /// The value of type `T` that a phase has, for writing, if there is one.
    pub fn try_get_mut_of<T: Shareable>(&self, phase: PhaseId) -> Option<RefMut<'_, T>> {
        self.write(Some(phase))
    }

    fn read<T: Shareable>(&self, phase: Option<PhaseId>) -> Option<Ref<'_, T>> {
        let cell = self.by_type.get(&(TypeId::of::<T>(), phase))?;
        self.touches::<T>(Mode::Reads);
        Ref::filter_map(cell.borrow(), |value| value.downcast_ref()).ok()
    }

    fn write<T: Shareable>(&self, phase: Option<PhaseId>) -> Option<RefMut<'_, T>> {
        let cell = self.by_type.get(&(TypeId::of::<T>(), phase))?;
        self.touches::<T>(Mode::Writes);
        RefMut::filter_map(cell.borrow_mut(), |value| value.downcast_mut()).ok()
    }
}
