//! The surrogate
