//! What systems share that is not particle state: neighbour lists, packed rows, tables. One value per type.

use std::any::{Any, TypeId, type_name};
use std::cell::{Ref, RefCell, RefMut};
use std::collections::BTreeMap;

/// Values by their type. Everything in here is derived from the scene and the columns, so no checkpoint holds it.
#[derive(Default)]
pub struct Resources(BTreeMap<TypeId, RefCell<Box<dyn Any + Send>>>);

impl Resources {
    /// Puts a value in place of the one of its type.
    pub fn insert<T: Send + 'static>(&mut self, value: T) {
        self.0.insert(TypeId::of::<T>(), RefCell::new(Box::new(value)));
    }

    /// The value of type `T` for reading. Panics where the plugin that owns it was not built.
    pub fn get<T: Send + 'static>(&self) -> Ref<'_, T> {
        self.try_get().unwrap_or_else(|| panic!("no resource of type {}", type_name::<T>()))
    }

    /// The value of type `T` for reading, if there is one.
    pub fn try_get<T: Send + 'static>(&self) -> Option<Ref<'_, T>> {
        let cell = self.0.get(&TypeId::of::<T>())?;
        Ref::filter_map(cell.borrow(), |value| value.downcast_ref()).ok()
    }

    /// The value of type `T` for writing. Panics where the plugin that owns it was not built.
    pub fn get_mut<T: Send + 'static>(&self) -> RefMut<'_, T> {
        let value = self
            .0
            .get(&TypeId::of::<T>())
            .and_then(|cell| RefMut::filter_map(cell.borrow_mut(), |value| value.downcast_mut()).ok());
        value.unwrap_or_else(|| panic!("no resource of type {}", type_name::<T>()))
    }
}
