//! `spunlaid live` and its page.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "../served/mod.rs"]
mod served;

mod line;
mod live;
mod live_addresses;
mod live_socket;
