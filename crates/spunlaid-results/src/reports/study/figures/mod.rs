//! The figures of a study: curves over one factor, families of curves over two factors, main effects over more.

mod curves;
mod heat;
mod main_effects;
pub(crate) mod quantity;
mod ranking;
#[cfg(test)]
mod tests;

use quantity::QuantityGroup;
use spunlaid_charts::Figure;
use spunlaid_experiment::{Design, PointResults, Ranking, Study};

/// Largest number of values of a factor that are drawn as curves; more are drawn as a map.
const FAMILY: usize = 6;

/// The figures of a study, the most important first.
pub fn study_figures(study: &Study, results: &[PointResults], rankings: &[Ranking]) -> Vec<Figure> {
    let groups = quantity::groups(study).into_iter().filter_map(|group| group.applying(results));
    let groups: Vec<_> = match (study.design, study.factors.len()) {
        (_, 0 | 1) | (Design::Paired, _) => groups.collect(),
        _ => groups.map(quantity::QuantityGroup::with_few_series).collect(),
    };
    let mut figures = Vec::new();
    match (study.design, study.factors.len()) {
        (_, 0) => {}
        (Design::Grid | Design::OneAtATime | Design::Paired, 1) | (Design::Paired, _) => {
            figures.extend(groups.iter().map(|group| curves::one(study, results, group)));
        }
        (Design::Grid, 2) => {
            let counts = [0, 1].map(|i| study.factors[i].values().len());
            // Numbers are on the axis rather than words, and the factor with more values rather than the other.
            let rank = |i: usize| (study.factors[i].key.words().is_empty(), counts[i]);
            let (along, family) = if rank(0) > rank(1) { (0, 1) } else { (1, 0) };
            for group in &groups {
                if counts[family] <= FAMILY {
                    figures.push(curves::family(study, results, group, along, family));
                } else {
                    figures.extend(heat::maps(study, results, group));
                }
            }
        }
        (Design::OneAtATime, _) => {
            for group in groups.iter().filter(|group| group.is_main()) {
                let alone = |factor| curves::alone(study, results, group, factor);
                figures.extend((0..study.factors.len()).map(alone));
            }
        }
        _ => {
            for group in groups.iter().filter(|group| group.is_main()) {
                let drawn = |factor| main_effects::figure(study, results, rankings, group, factor);
                figures.extend((0..study.factors.len()).map(drawn));
            }
        }
    }
    if study.factors.len() > 1 && !rankings.is_empty() {
        let main = groups.iter().filter(|group| group.is_main());
        let ranks: Vec<Figure> = main.map(|group| ranking::figure(study, rankings, group)).collect();
        figures.splice(0..0, ranks);
    }
    figures
}

/// Part of a file name: `air.velocity` to `air_velocity`.
fn file_name(group: &QuantityGroup, key: &str) -> String {
    format!("{}_over_{}", group.figure.name, key.replace('.', "_"))
}
