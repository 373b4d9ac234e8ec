//! No code: `Cargo.toml` says which features of other crates the packages of spunlaid share, and why.
