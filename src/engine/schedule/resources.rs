//! Shared data that is not particle state: neighbour lists, packed rows, tables. One value per type, or per type and phase.

use std::any::{Any, TypeId, type_name};
use std::cell::{Ref, RefCell, RefMut};
use std::collections::BTreeMap;

use crate::world::PhaseId;

/// Values by their type, or by their type and a phase. Everything in here is derived from the scene and the columns, so no checkpoint holds it.
#[derive(Default)]
pub struct Resources(BTreeMap<(TypeId, Option<PhaseId>), RefCell<Box<dyn Any + Send>>>);

impl Resources {
    /// Puts a value in place of the one of its type.
    pub fn insert<T: Send + 'static>(&mut self, value: T) {
        self.0.insert((TypeId::of::<T>(), None), RefCell::new(Box::new(value)));
    }

    /// Puts a value in place of the one that a phase has of its type.
    pub fn insert_of<T: Send + 'static>(&mut self, phase: PhaseId, value: T) {
        self.0.insert((TypeId::of::<T>(), Some(phase)), RefCell::new(Box::new(value)));
    }

    /// The value of type `T` for reading. Panics where the plugin that owns it was not built.
    pub fn get<T: Send + 'static>(&self) -> Ref<'_, T> {
        self.try_get().unwrap_or_else(|| panic!("no resource of type {}", type_name::<T>()))
    }

    /// The value of type `T` for reading, if there is one.
    pub fn try_get<T: Send + 'static>(&self) -> Option<Ref<'_, T>> {
        self.read(None)
    }

    /// The value of type `T` for writing. Panics where the plugin that owns it was not built.
    pub fn get_mut<T: Send + 'static>(&self) -> RefMut<'_, T> {
        self.write(None).unwrap_or_else(|| panic!("no resource of type {}", type_name::<T>()))
    }

    /// The value of type `T` that a phase has, for reading, if there is one.
    pub fn try_get_of<T: Send + 'static>(&self, phase: PhaseId) -> Option<Ref<'_, T>> {
        self.read(Some(phase))
    }

    /// The value of type `T` that a phase has, for writing, if there is one.
    pub fn try_get_mut_of<T: Send + 'static>(&self, phase: PhaseId) -> Option<RefMut<'_, T>> {
        self.write(Some(phase))
    }

    fn read<T: Send + 'static>(&self, phase: Option<PhaseId>) -> Option<Ref<'_, T>> {
        let cell = self.0.get(&(TypeId::of::<T>(), phase))?;
        Ref::filter_map(cell.borrow(), |value| value.downcast_ref()).ok()
    }

    fn write<T: Send + 'static>(&self, phase: Option<PhaseId>) -> Option<RefMut<'_, T>> {
        let cell = self.0.get(&(TypeId::of::<T>(), phase))?;
        RefMut::filter_map(cell.borrow_mut(), |value| value.downcast_mut()).ok()
    }
}
