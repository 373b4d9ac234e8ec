//! A picture that can be drawn at any width: it is laid out for it, and its text keeps its size.

use crate::picture::Picture;
use std::fmt;
use std::sync::Arc;

/// A pixel in print [mm]: the labels of the axes, of 14 pixels, are 8 points high, as journals ask for.
pub const PRINTED_PIXEL: f64 = 8.0 / 14.0 * 25.4 / 72.0;

/// How a figure is drawn.
#[derive(Clone)]
pub struct Drawing {
    /// On the screen [px].
    pub(crate) width: f64,
    draw: Arc<dyn Fn(f64) -> Picture + Send + Sync>,
}

impl Drawing {
    /// The drawing whose picture a function makes for each width [px].
    ///
    /// * `width` – on the screen [px]
    pub fn new(width: f64, draw: impl Fn(f64) -> Picture + Send + Sync + 'static) -> Self {
        Self { width, draw: Arc::new(draw) }
    }

    /// The picture, so many pixels wide.
    pub(crate) fn at(&self, width: f64) -> Picture {
        (self.draw)(width)
    }
}

impl fmt::Debug for Drawing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Drawing").field("width", &self.width).finish_non_exhaustive()
    }
}
