//! Objects of JSON files whose entries keep their order.

use serde::{Serialize, Serializer};

/// An object whose entries keep their order.
#[derive(Clone, Debug)]
pub struct OrderedObject<T>(pub Vec<(String, T)>);

impl<T: Serialize> Serialize for OrderedObject<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}
