//! `spunlaid web`: lays a web of many filaments.

mod fibres;
mod laid;

use super::interrupt::stop_on_ctrl_c;
use super::{stem, threads};
use crate::args::Web;
use crate::failure::Failure;
use crate::output::folder::{ENTRIES, Staging};
use crate::say;
use fibres::{Flyer, OfLayer};
use spunlaid::input::{Overrides, read_web};

pub(crate) fn web(web: &Web) -> Result<(), Failure> {
    let file = read_web(&web.file, Overrides { values: &web.set, word: "--set" })?;
    file.notes.iter().for_each(say::note);
    let name = stem(&web.file, "web");
    let folder = (web.out.is_some() || !web.json).then(|| super::folder(web.out.as_ref(), name));
    let stop = stop_on_ctrl_c();
    let staging = folder.as_ref().map(|folder| Staging::new(folder, ENTRIES, web.force, stop)).transpose()?;

    let mut flyer = Flyer::new(threads(web.threads), stop, web.quiet);
    let layers = file.spec.layers.iter().map(|layer| flyer.fibres(&file.spec, layer));
    let layers: Vec<OfLayer> = layers.collect::<Result<_, _>>()?;
    let web_to_lay = file.spec.web(layers.iter().map(|layer| layer.fibres.clone()));

    // UNFINISHED: `spunlaid::web::lay` is called here with `web_to_lay`, and its results are written to `staging`. `layers`
    // says of each flown layer how certain its surrogate is, and has the curves to judge it by.
    let _ = (web_to_lay, staging, layers.iter().map(|layer| &layer.flown));
    Ok(())
}
