//! The files of a results folder.

pub(crate) mod analysis;
pub(crate) mod beside;
pub(crate) mod comparison;
pub(crate) mod folder;
pub(crate) mod leftovers;
pub(crate) mod paraview;
mod parquet;
pub(crate) mod pictures;
pub(crate) mod study;
pub(crate) mod summary;
pub(crate) mod table;
pub(crate) mod tables;
