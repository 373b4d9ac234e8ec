//! Vectors in space, of plain numbers or of [`Lanes`].

use crate::lanes::{Lanes, Register, Simd, Wide};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A vector with components along x (the mean flow and gravity), y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vec3<T> {
    /// Along the mean flow and gravity.
    pub x: T,
    /// Across.
    pub y: T,
    /// Across.
    pub z: T,
}

impl<T> Vec3<T> {
    /// The vector of the three components.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }
}

impl Vec3<f64> {
    /// Length.
    #[inline]
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }
}

impl Vec3<Lanes> {
    /// The zero vector in every lane.
    pub const ZERO: Self = Self::new(Lanes::ZERO, Lanes::ZERO, Lanes::ZERO);

    /// The same vector in every lane.
    #[inline]
    pub const fn splat(v: Vec3<f64>) -> Self {
        Self::new(Lanes::splat(v.x), Lanes::splat(v.y), Lanes::splat(v.z))
    }

    /// The vector of one lane.
    #[inline]
    pub fn lane(&self, i: usize) -> Vec3<f64> {
        Vec3::new(self.x.0[i], self.y.0[i], self.z.0[i])
    }

    /// Puts a vector into one lane.
    #[inline]
    pub fn set_lane(&mut self, i: usize, v: Vec3<f64>) {
        (self.x.0[i], self.y.0[i], self.z.0[i]) = (v.x, v.y, v.z);
    }
}

impl<S: Simd> Vec3<Wide<S>> {
    /// Zero everywhere.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(Wide::zero(), Wide::zero(), Wide::zero())
    }

    /// From memory.
    #[inline(always)]
    pub fn load(v: &Vec3<Lanes>) -> Self {
        Self::new(Wide::load(&v.x), Wide::load(&v.y), Wide::load(&v.z))
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> Wide<S> {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross_wide(self, other: Self) -> Self {
        Self::new(
            self.z.neg_mul_add(other.y, self.y * other.z),
            self.x.neg_mul_add(other.z, self.z * other.x),
            self.y.neg_mul_add(other.x, self.x * other.y),
        )
    }

    /// The vector with another y, less by `y`.
    #[inline(always)]
    pub fn less_y(self, y: Wide<S>) -> Self {
        Self::new(self.x, self.y - y, self.z)
    }

    /// Scalar product plus `sum`.
    #[inline(always)]
    pub fn dot_add(self, other: Self, sum: Wide<S>) -> Wide<S> {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z.mul_add(other.z, sum)))
    }

    /// `self · factor + addend`, each component rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: Wide<S>, addend: Self) -> Self {
        Self::new(
            self.x.mul_add(factor, addend.x),
            self.y.mul_add(factor, addend.y),
            self.z.mul_add(factor, addend.z),
        )
    }

    /// `addend − self · factor`, each component rounded once.
    #[inline(always)]
    pub fn neg_mul_add(self, factor: Wide<S>, addend: Self) -> Self {
        Self::new(
            self.x.neg_mul_add(factor, addend.x),
            self.y.neg_mul_add(factor, addend.y),
            self.z.neg_mul_add(factor, addend.z),
        )
    }
}

impl<S: Register> Vec3<Wide<S>> {
    /// Into memory.
    #[inline(always)]
    pub fn store(self) -> Vec3<Lanes> {
        Vec3::new(self.x.store(), self.y.store(), self.z.store())
    }
}

impl<T: Add<Output = T>> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<T: Sub<Output = T>> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<T: Copy + Mul<Output = T>> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<T: Neg<Output = T>> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<T: Copy + Add<Output = T>> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Copy + Sub<Output = T>> SubAssign for Vec3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
