//! The least-squares fits of a study: their terms and their points.

use super::{Contrast, Refusal};
use crate::study::{Design, Study};
use spunlaid_ground::statistics::{add, dot, inverse};

/// Largest variance inflation of an effect by the correlation of factors; 10 is a correlation of 0.95 between two.
const MOST_INFLATION: f64 = 10.0;

/// A term of a fit; `x_j` is the place of factor j, −1 … +1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// `x_j`.
    Line(usize),
    /// `x_j² − 1/3`, whose mean over the range is zero.
    Square(usize),
    /// `x_j x_k`.
    Product(usize, usize),
    /// 1 where a factor of words has the first word, −1 where it has the second, the word of reference; otherwise 0.
    Word(usize, f64, f64),
}

impl Term {
    pub(super) fn at(self, place: &dyn Fn(usize) -> f64, values: &[f64]) -> f64 {
        match self {
            Self::Line(j) => place(j),
            Self::Square(j) => place(j) * place(j) - 1.0 / 3.0,
            Self::Product(j, k) => place(j) * place(k),
            Self::Word(j, this, reference) => {
                f64::from(values[j] == this) - f64::from(values[j] == reference)
            }
        }
    }

    /// Whether it belongs to this factor alone.
    pub(super) fn is_of(self, factor: usize) -> bool {
        matches!(self, Self::Line(j) | Self::Square(j) | Self::Word(j, ..) if j == factor)
    }

    /// Whether it is part of the main effects.
    pub(super) fn is_main(self) -> bool {
        matches!(self, Self::Line(_) | Self::Word(..))
    }
}

/// A least-squares fit over some points.
pub(super) struct EffectsFit<'a> {
    pub(super) study: &'a Study,
    pub(super) points: Vec<usize>,
    /// Factors whose effects it reports, with their least and greatest values; words are in no order.
    factors: Vec<(usize, (f64, f64))>,
    pub(super) terms: Vec<Term>,
    /// `(XᵀX)⁻¹`; the first row and column belong to the constant.
    inverse: Vec<Vec<f64>>,
}

/// A change of a factor.
pub(super) struct WeightedContrast {
    pub(super) contrast: Contrast,
    /// Weights of the coefficients that give the change of a result by it.
    pub(super) weights: Vec<f64>,
}

/// The fits of a study: one of all points, or one for each factor of a one-at-a-time design.
pub(super) fn fits(study: &Study) -> Result<Vec<EffectsFit<'_>>, Refusal> {
    let count = study.factors.len();
    if study.design == Design::OneAtATime {
        let base = &study.points[0].values;
        return (0..count)
            .map(|factor| {
                let is_alone = |point: &usize| {
                    let values = &study.points[*point].values;
                    (0..count).all(|other| other == factor || values[other] == base[other])
                };
                let points: Vec<usize> = (0..study.points.len()).filter(is_alone).collect();
                EffectsFit::new(study, points, &[factor])
            })
            .collect();
    }
    let (all, factors): (Vec<usize>, Vec<usize>) = ((0..study.points.len()).collect(), (0..count).collect());
    let fit = EffectsFit::new(study, all, &factors)?;
    let (points, keys) = (fit.points.len(), count);
    let needed = fit.terms.len() + 2;
    if points < needed {
        return Err(Refusal::TooFewPoints { points, keys, needed });
    }
    fit.check_inflation()?;
    Ok(vec![if study.design.draws() { fit.with_curvature() } else { fit }])
}

impl<'a> EffectsFit<'a> {
    fn new(study: &'a Study, points: Vec<usize>, factors: &[usize]) -> Result<Self, Refusal> {
        let (mut terms, mut spans) = (Vec::new(), Vec::new());
        for &factor in factors {
            let mut levels: Vec<f64> =
                points.iter().map(|point| study.points[*point].values[factor]).collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup();
            let (Some(&least), Some(&last)) = (levels.first(), levels.last()) else {
                continue;
            };
            if least == last {
                return Err(Refusal::OneValue { key: study.factors[factor].key.name.clone() });
            }
            let alone = study.design == Design::OneAtATime;
            if study.factors[factor].key.words().is_empty() {
                terms.push(Term::Line(factor));
                spans.push((factor, if alone { (least, last) } else { study.factors[factor].ends() }));
            } else {
                // The order of the list. A word of the base case that the list does not name comes first.
                let mut words = study.factors[factor].levels();
                if alone {
                    let base = study.points[0].values[factor];
                    words.retain(|word| *word != base);
                    words.insert(0, base);
                }
                words.retain(|word| levels.contains(word));
                terms.extend(words[1..].iter().map(|&word| Term::Word(factor, word, words[0])));
                spans.push((factor, (least, last)));
            }
        }
        let mut fit = Self { study, points, factors: spans, terms, inverse: Vec::new() };
        if fit.points.len() <= fit.terms.len() {
            let points = fit.points.len();
            let keys = factors.len();
            let needed = fit.terms.len() + 2;
            return Err(Refusal::TooFewPoints { points, keys, needed });
        }
        fit.inverse = match inverse(fit.gram()) {
            Ok(inverse) => inverse,
            Err(column) => return Err(fit.dependent(column)),
        };
        Ok(fit)
    }

    /// The same fit with squares and products, as far as there are enough points: two for each unknown.
    fn with_curvature(self) -> Self {
        let lines: Vec<usize> = self
            .terms
            .iter()
            .filter_map(|term| if let Term::Line(j) = term { Some(*j) } else { None })
            .collect();
        let squares = lines.iter().map(|&j| Term::Square(j));
        let products = lines.iter().enumerate().flat_map(|(i, &j)| {
            lines.iter().skip(i + 1).map(move |&k| Term::Product(j, k)).collect::<Vec<_>>()
        });
        let squared: Vec<Term> = self.terms.iter().copied().chain(squares).collect();
        let full: Vec<Term> = squared.iter().copied().chain(products).collect();
        for terms in [full, squared] {
            if self.points.len() >= 2 * (terms.len() + 1) {
                let (points, factors) = (self.points.clone(), self.factors.clone());
                let mut fit = Self { study: self.study, points, factors, terms, inverse: Vec::new() };
                if let Ok(inverse) = inverse(fit.gram()) {
                    fit.inverse = inverse;
                    return fit;
                }
            }
        }
        self
    }

    pub(super) fn size(&self) -> usize {
        self.terms.len() + 1
    }

    pub(super) fn row(&self, point: usize) -> Vec<f64> {
        let values = &self.study.points[point].values;
        let place = |factor: usize| {
            let ends = self.factors.iter().find(|(j, _)| *j == factor).map_or((0.0, 0.0), |(_, ends)| *ends);
            self.study.factors[factor].place_between(values[factor], ends)
        };
        std::iter::once(1.0).chain(self.terms.iter().map(|term| term.at(&place, values))).collect()
    }

    /// `XᵀX`.
    fn gram(&self) -> Vec<Vec<f64>> {
        let size = self.size();
        let mut gram = vec![vec![0.0; size]; size];
        for &point in &self.points {
            let row = self.row(point);
            for (sums, x) in gram.iter_mut().zip(&row) {
                add(sums, *x, &row);
            }
        }
        gram
    }

    /// Refuses factors that almost follow from others.
    fn check_inflation(&self) -> Result<(), Refusal> {
        let (gram, n) = (self.gram(), self.points.len() as f64);
        let inflated = (1..self.size()).find(|&j| {
            let spread = gram[j][j] - gram[0][j] * gram[0][j] / n;
            matches!(self.terms[j - 1], Term::Line(_)) && spread * self.inverse[j][j] > MOST_INFLATION
        });
        inflated.map_or(Ok(()), |column| Err(self.dependent(column)))
    }

    /// The refusal of a column that follows from the others: names the other factor if there is a single one.
    fn dependent(&self, column: usize) -> Refusal {
        let (gram, n) = (self.gram(), self.points.len() as f64);
        let cross = |j: usize, k: usize| gram[j][k] - gram[0][j] * gram[0][k] / n;
        let correlation = |k: usize| cross(column, k) / (cross(column, column) * cross(k, k)).sqrt();
        let others = (1..self.size()).filter(|k| *k != column);
        let nearest = others.max_by(|a, b| correlation(*a).abs().total_cmp(&correlation(*b).abs()));
        let key = |column: usize| match self.terms[column.max(1) - 1] {
            Term::Line(j) | Term::Square(j) | Term::Product(j, _) | Term::Word(j, ..) => {
                self.study.factors[j].key.name.clone()
            }
        };
        match nearest.filter(|k| correlation(*k).abs() > 0.9) {
            Some(other) => {
                let (first, second) = (key(other.min(column)), key(other.max(column)));
                Refusal::Together { first, second, correlation: correlation(other) }
            }
            None => Refusal::Dependent { key: key(column) },
        }
    }

    pub(super) fn solve(&self, xy: &[f64]) -> Vec<f64> {
        self.inverse.iter().map(|row| dot(row, xy)).collect()
    }

    /// Contrasts of the coefficients that are the main effects.
    pub(super) fn contrasts(&self) -> Vec<WeightedContrast> {
        let contrast = |(column, term): (usize, &Term)| {
            let mut weights = vec![0.0; self.size()];
            weights[column] = 2.0;
            match *term {
                Term::Line(j) => {
                    let (least, greatest) = self.factors.iter().find(|span| span.0 == j)?.1;
                    let contrast = Contrast { factor: j, from: least, to: greatest };
                    Some(WeightedContrast { contrast, weights })
                }
                Term::Word(j, this, reference) => {
                    // The result with the word of reference is the mean over the words minus all their coefficients.
                    let same = |other: &Term| matches!(other, Term::Word(k, ..) if *k == j);
                    let others = (1..).zip(&self.terms).filter(|(at, other)| *at != column && same(other));
                    others.for_each(|(at, _)| weights[at] = 1.0);
                    let contrast = Contrast { factor: j, from: reference, to: this };
                    Some(WeightedContrast { contrast, weights })
                }
                Term::Square(_) | Term::Product(..) => None,
            }
        };
        (1..).zip(&self.terms).filter_map(contrast).collect()
    }
}
