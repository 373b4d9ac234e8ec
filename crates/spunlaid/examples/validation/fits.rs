//! Fits: webs of known values are laid, scanned and fitted.

use super::closed_loops::{closed_loops, coverage};
use super::title;

/// How many of the 95 % intervals of 100 webs hold the values of their web.
pub(crate) fn intervals() {
    title("fits of two keys that make up for each other to scans of 100 webs of 200 mm square");
    let truth = [16.0, 350.0];
    for spectrum in [false, true] {
        let fits = closed_loops(&["laydown.noise", "line.filaments_per_metre"], &truth, spectrum, 100, 20);
        let mean = |of: &dyn Fn(&spunlaid::experiment::Fit) -> f64| fits.iter().map(of).sum::<f64>() / 100.0;
        let with = if spectrum { "patches and spectrum" } else { "patches" };
        let trials = mean(&|fit| fit.trials.len() as f64);
        let strange = fits.iter().filter(|fit| fit.worse == 0).count();
        println!("{with}: {trials:.0} trials of 20 webs; {strange} scans beyond all simulated webs");
        for (key, [below, within, above]) in ["noise", "number"].iter().zip(coverage(&fits, &truth)) {
            let index = usize::from(*key == "number");
            let ratio = mean(&|fit| {
                fit.keys[index].interval.as_ref().map_or(f64::NAN, |[low, high]| (high / low).ln())
            });
            println!(
                "  {key}: {within} of 100 hold it, {below} lie below, {above} above; upper end over lower end {:.2}",
                ratio.exp()
            );
        }
    }
}
